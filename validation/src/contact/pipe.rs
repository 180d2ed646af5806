//! A bar deep in soil, and a pipe wished in place at shallow depth.

use std::f64::consts::PI;
use std::path::Path;

use igimp_assembly::{Geometry, Interface, Locking, Shear, Surface, Tension};
use igimp_cases::CaseError;

use super::buried::{Buried, Claim, Question, adhesive, answer};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, Study};

/// The book's description of the study.
const ABOUT: &str = "A circular bar deep in weightless Tresca soil with E/s_u = 1000, bonded, smooth or with adhesion, and a pipe wished in place at shallow depth without tension, are pushed down at small strain. The soil at a circle is a staircase of particles, so nodes with little of it are tied to others sooner than elsewhere. What lies within its band is claimed, all is told: of smooth pipes every mesh of seventeen cells and more, as their values go up and down from mesh to mesh.";
const DEEP: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Randolph and Houlsby 1984",
    locator: "N = π + 2 D + 2 cos D + 4 (cos D/2 + sin D/2), sin D = α",
};
const SHALLOW: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "finite-element limit analysis of a pipe wished in place, no tension, no heave",
    locator: "lower and upper bound of V/(D s_u)",
};
/// Share of a cell's volume below which a node is tied to another.
const SMALL_CUT: f64 = 0.05;
/// Parts of an arc that stands for the circle in the soil's outline.
const ARC: usize = 200;

/// Embedment over diameter; bounds smooth and rough.
const TABLE: [(f64, [f64; 2], [f64; 2]); 4] = [
    (0.1, [2.589, 2.731], [2.955, 3.096]),
    (0.3, [3.760, 3.833], [4.668, 4.758]),
    (0.5, [4.231, 4.334], [5.521, 5.629]),
    (1.0, [5.007, 5.099], [6.111, 6.218]),
];

/// The right half of a circle of unit diameter around the origin, from an angle \[rad\] down.
fn arc(from: f64) -> impl Iterator<Item = [f64; 2]> {
    (0..=ARC).map(move |k| {
        let angle = from - (from + 0.5 * PI) * k as f64 / ARC as f64;
        [0.5 * angle.cos(), 0.5 * angle.sin()]
    })
}

/// A circle with the soil's surface at `top` above its middle.
fn circle(cells: usize, top: f64, interface: Interface, reach: [f64; 2]) -> Buried {
    let surface = Surface::circle(0.5, 1.0 / cells as f64).expect("the circle has a radius");
    let mut inner = Vec::new();
    if top > 0.5 {
        inner.push([0.0, top]);
        inner.extend(arc(0.5 * PI));
    } else {
        // Above its widest point the walls of the trench stand upright.
        if top > 0.0 {
            inner.push([0.5, top]);
        }
        inner.extend(arc((2.0 * top.min(0.0)).asin()));
    }
    // Soil that sticks without a bond is carried along: one diameter deep it bears a sixth less on a given
    // geometry.
    let moves = interface.shear == Shear::Rough && interface.tension == Tension::None;
    Buried {
        variant: String::new(),
        cells,
        surface,
        interfaces: vec![interface],
        inner,
        top,
        fine: [0.75, -0.8, top.min(0.75)],
        reach,
        push: if moves { -0.03 } else { -0.05 },
        locking: Locking::BBar,
        small_cut: if moves { 1e-4 } else { SMALL_CUT },
        geometry: if moves {
            Geometry::Moving
        } else {
            Geometry::Given
        },
        per_direction: 3,
        steps: 12,
    }
}

/// The exact resistance of a deep bar with an adhesion of so much of the strength.
fn deep(adhesion: f64) -> f64 {
    let angle: f64 = adhesion.asin();
    let half = 0.5 * angle;
    PI + 2.0 * angle + 2.0 * angle.cos() + 4.0 * (half.cos() + half.sin())
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-pipe", ABOUT, out)?;
    let mut questions = Vec::new();
    for adhesion in [0.0, 0.5, 1.0] {
        let interface = if adhesion > 0.0 {
            adhesive(adhesion).bonded()
        } else {
            Interface::smooth().bonded()
        };
        let meshes = match level {
            Level::Quick => vec![9],
            Level::Default | Level::Full => vec![9, 17],
        };
        questions.push(Question {
            name: format!("deep bar, bonded, α = {adhesion}"),
            oracle: DEEP,
            bounds: [deep(adhesion); 2],
            beyond: 0.03,
            claim: if adhesion > 0.0 {
                Claim::Extrapolated
            } else {
                Claim::None
            },
            meshes,
            body: Box::new(move |cells| circle(cells, 3.5, interface.clone(), [3.0, 3.0])),
        });
    }
    for (embedment, smooth, rough) in TABLE {
        for (name, interface, bounds) in [
            ("smooth", Interface::smooth(), smooth),
            ("rough", Interface::rough(), rough),
        ] {
            // Cells over the chord of contact count.
            let fine = match embedment {
                _ if embedment < 0.2 => [25, 49],
                _ if embedment < 0.4 => [17, 33],
                _ => [9, 17],
            };
            let meshes = match level {
                // Rough and shallow, the finer mesh stops early.
                _ if embedment < 0.2 && name == "rough" => vec![fine[0]],
                Level::Quick => vec![fine[0]],
                Level::Default if embedment < 0.4 => vec![fine[0]],
                Level::Default | Level::Full => fine.to_vec(),
            };
            questions.push(Question {
                name: format!("pipe, {name}, w/D = {embedment}"),
                oracle: SHALLOW,
                bounds,
                beyond: 0.03,
                claim: match name {
                    "smooth" => Claim::Fine,
                    _ => Claim::None,
                },
                meshes,
                body: Box::new(move |cells| {
                    circle(cells, embedment - 0.5, interface.clone(), [2.0, 1.6])
                }),
            });
        }
    }
    answer(&mut study, &questions)?;
    Ok(study)
}
