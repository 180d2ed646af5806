//! A horizontal plate anchor that is pulled up.

use std::path::Path;

use igimp_assembly::{Geometry, Interface, Locking, Surface};
use igimp_cases::CaseError;

use super::buried::{Buried, Claim, Question, adhesive, answer};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, Study};

/// The book's description of the study.
const ABOUT: &str = "A horizontal plate, two cells thick, is pulled up at small strain through weightless Tresca soil with E/s_u = 1000 from depths of one, two and five widths: soil leaves its underside (breakaway), or is bonded with adhesion s_u. Limit loads, extrapolated to a thin plate, are held against bounds of limit analysis; bonded ones at one and two widths on every mesh. Plates that soil sticks to whatever its strength are told.";
const BOUNDS: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "finite-element limit analysis of a thin rough plate, weightless soil",
    locator: "lower and upper bound of Q/(B s_u)",
};
/// Bounds by depth over width: breakaway, bonded.
const TABLE: [(f64, [f64; 2], [f64; 2]); 3] = [
    (1.0, [1.911, 1.985], [8.895, 9.272]),
    (2.0, [3.557, 3.684], [11.190, 11.500]),
    (5.0, [5.753, 6.015], [11.023, 11.492]),
];

/// A plate whose upper face stands `depth` below the surface.
fn plate(cells: usize, depth: f64, interface: Interface) -> Buried {
    let h = 1.0 / cells as f64;
    let low = -2.0 * h;
    let corners = [[-0.5, low], [0.5, low], [0.5, 0.0], [-0.5, 0.0]];
    Buried {
        variant: String::new(),
        cells,
        surface: Surface::polygon(&corners, 0.5 * h, h).expect("the outline has corners"),
        interfaces: vec![interface; 4],
        inner: vec![[0.0, depth], [0.0, 0.0], [0.5, 0.0], [0.5, low], [0.0, low]],
        top: depth,
        fine: [0.8, -0.6, depth.min(0.6)],
        reach: [3.0 + depth, 3.0],
        push: if depth > 3.0 { 0.12 } else { 0.06 },
        locking: Locking::BBar,
        small_cut: 1e-4,
        geometry: Geometry::Given,
        per_direction: 2,
        steps: 15,
    }
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-anchor", ABOUT, out)?;
    let meshes: &[usize] = match level {
        Level::Quick => &[9],
        Level::Default | Level::Full => &[9, 17],
    };
    let mut questions = Vec::new();
    for (depth, breakaway, bonded) in TABLE {
        let kinds = [
            (
                "breakaway",
                Interface::rough(),
                breakaway,
                Claim::Extrapolated,
            ),
            (
                "bonded, adhesive",
                adhesive(1.0).bonded(),
                bonded,
                if depth > 3.0 {
                    Claim::Extrapolated
                } else {
                    Claim::Every
                },
            ),
            (
                "bonded, rough",
                Interface::rough().bonded(),
                bonded,
                Claim::None,
            ),
        ];
        for (name, interface, bounds, claim) in kinds {
            if claim == Claim::None && level != Level::Full {
                continue;
            }
            questions.push(Question {
                name: format!("{name}, H/B = {depth}"),
                oracle: BOUNDS,
                bounds,
                beyond: 0.04,
                claim,
                meshes: meshes.to_vec(),
                body: Box::new(move |cells| plate(cells, depth, interface.clone())),
            });
        }
    }
    answer(&mut study, &questions)?;
    Ok(study)
}
