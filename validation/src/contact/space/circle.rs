//! Circular and square footings on weightless Tresca soil, on the given geometry, in a quarter.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{
    Geometry, Interface, Method, Particles, RigidBody, RigidMotion, SharedLaw, Surface,
};
use igimp_cases::CaseError;
use igimp_material::{Elasticity, Tresca};
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use igimp_solver::{Accepted, Body, MarchSettings};
use rayon::prelude::*;

use super::super::{force, graded, weightless};
use super::Quarter;
use crate::continuum::laboratory::run;
use crate::harness::oracle::{Expected, Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};

/// The book's description of the study.
const ABOUT: &str = "A circular footing on weightless Tresca soil, smooth and rough, and a rough square one, pushed down by contact in a quarter, on the given geometry, with shared strain and sharp edges: bearing capacity over s_u, mesh by mesh, and by two meshes.";
const SMOOTH: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Shield 1955; Eason and Shield 1960",
    locator: "smooth circular punch: N_c = 5.690",
};
const ROUGH: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Eason and Shield 1960; Cox, Eason and Hopkins 1961",
    locator: "rough circular punch: N_c = 6.048",
};
const SQUARE: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "Salgado et al. 2004; Gourvenec, Randolph and Kingsnorth 2006",
    locator: "rough square footing: lower bound 5.52, best upper bound 5.95",
};
/// Young's modulus over undrained strength \[-\].
const YOUNG: f64 = 1e4;
/// Settlement at the start and at the end over the width \[-\]; in between it grows by the same factor from
/// step to step.
const SETTLEMENT: [f64; 2] = [1e-5, 2e-3];
const STEPS: usize = 20;
/// Where the edge stands in its cell on the axes of the grid \[-\].
const PLACE: f64 = 0.75;
/// Other places, in full on a mesh of so many cells.
const OTHER_PLACES: [f64; 4] = [0.0, 0.25, 0.5, 0.9];
const CELLS_AT_PLACES: usize = 8;
/// By how much the loads of all places may differ over their mean \[-\].
const SPREAD: f64 = 0.03;
const INDIFFERENT: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "the soil and the footing, which know no grid",
    locator: "largest less smallest load over their mean: 0",
};

/// A footing of unit width.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Footing {
    Circle { rough: bool },
    RoughSquare,
}

impl Footing {
    fn says(self) -> (Expected, Band) {
        match self {
            Self::Circle { rough: false } => (SMOOTH.says(5.690), Band::Relative(0.04)),
            Self::Circle { rough: true } => (ROUGH.says(6.048), Band::Relative(0.04)),
            Self::RoughSquare => (SQUARE.says(5.9), Band::Between(5.5, 6.0)),
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Circle { rough: false } => "smooth circle",
            Self::Circle { rough: true } => "rough circle",
            Self::RoughSquare => "rough square",
        }
    }

    /// Area of its base \[length²\].
    fn area(self) -> f64 {
        match self {
            Self::Circle { .. } => std::f64::consts::FRAC_PI_4,
            Self::RoughSquare => 1.0,
        }
    }

    /// The footing as a body with smooth sides, its base at z = 0, with knots `h` apart.
    fn body(self, h: f64) -> RigidBody<3> {
        let (surface, base) = match self {
            Self::Circle { .. } => (Surface::cylinder(2, 0.5, 0.5, 0.0, h), 0),
            Self::RoughSquare => (Surface::cuboid([0.5; 3], 0.0, h), 4),
        };
        let surface = surface.expect("the footing has a volume");
        let mut sides = vec![Interface::smooth(); surface.side_count()];
        if self != (Self::Circle { rough: false }) {
            sides[base] = Interface::rough();
        }
        RigidBody::new(surface, sides, [0.0, 0.0, 0.5])
    }

    /// The push on so many cells per width with its edge at a place of its cell, and settlement and load by step.
    fn push(self, cells: usize, place: f64) -> Result<(RunRecord, Table), CaseError> {
        let h = 1.0 / cells as f64;
        // The cell at the axis is as wide as the rest, 0.6 to 1.6 times the others.
        let edge = 0.5 - place * h;
        let mut first = edge - (edge / h).floor() * h;
        if first < 0.6 * h {
            first += h;
        }
        let end = first + ((0.8 - first) / h).ceil() * h;
        let mut sideways = vec![0.0];
        sideways.extend(graded(h, [first, end], [first, 1.6], 1.2));
        let upward = graded(h, [-(0.5 / h).round() * h, 0.0], [-1.2, 0.0], 1.2);
        let quarter = Quarter::new(&sideways, upward)?;
        let mut body = Body::new(Particles::new(&quarter.seeds)?);
        body.rigid = vec![self.body(h)];
        let law: SharedLaw = Arc::new(Tresca::new(Elasticity::new(YOUNG, 0.49)?, 1.0)?);
        let constraints = quarter.held()?;
        let settlement = |at: f64| {
            let [first, last] = SETTLEMENT;
            if at > 0.0 {
                first * (last / first).powf(at)
            } else {
                0.0
            }
        };
        let load_path = |from: f64, to: f64| {
            let down = settlement(to) - settlement(from);
            let motion = RigidMotion::displaced([0.0, 0.0, -down]);
            weightless(&quarter.grid, &constraints, &law, motion)
        };
        let name = self.name().replace(' ', "_");
        let (of, label) = if place.total_cmp(&PLACE).is_eq() {
            (String::new(), String::new())
        } else {
            (
                format!("_{:.0}", 100.0 * place),
                format!(", edge at {place} of its cell"),
            )
        };
        let mut curve = Table::new(
            format!("{name}_{cells}{of}"),
            &["settlement_over_B_[-]", "V_over_A_[s_u]"],
        );
        let mut observe = |accepted: &Accepted<'_, 3>| {
            let load = -4.0 * force(accepted)[2] / self.area();
            curve.push(vec![settlement(accepted.report.to), load]);
            ControlFlow::Continue(())
        };
        let mut method = Method::shared_strain();
        method.geometry = Geometry::Given;
        let (run, _) = run(
            format!("{}, B/h = {cells}{label}", self.name()),
            &mut body,
            &method,
            &MarchSettings::steps(STEPS),
            &load_path,
            &mut observe,
        );
        Ok((run, curve))
    }
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-circle", ABOUT, out)?;
    let meshes: &[usize] = match level {
        Level::Quick => &[6],
        Level::Default => &[6, 8],
        Level::Full => &[6, 8, 12],
    };
    let footings = [
        Footing::Circle { rough: false },
        Footing::Circle { rough: true },
        Footing::RoughSquare,
    ];
    let pushes: Vec<(Footing, usize)> = footings
        .into_iter()
        .flat_map(|footing| meshes.iter().map(move |&cells| (footing, cells)))
        .filter(|(footing, cells)| *footing != Footing::RoughSquare || *cells < 12)
        .collect();
    let done = pushes
        .par_iter()
        .map(|(footing, cells)| footing.push(*cells, PLACE))
        .collect::<Result<Vec<_>, CaseError>>()?;
    let mut before: Option<(Footing, f64)> = None;
    for ((footing, _), (record, curve)) in pushes.iter().zip(done) {
        curve.write_csv(&study.folder)?;
        let end = curve.rows.last().map_or(f64::NAN, |row| row[1]);
        let run = study.run_to_end(record);
        let (expected, band) = footing.says();
        study.check(run, "V/(A s_u) at the end [-]", expected, band, end);
        // Limit loads fall with the cell, towards the exact one.
        if let Some((_, coarse)) = before.filter(|(other, _)| other == footing) {
            let quantity = "V/(A s_u) over that of the mesh before [-]";
            let band = Band::Between(0.97, 1.0);
            study.check(run, quantity, expected.oracle.says(1.0), band, end / coarse);
        }
        before = Some((*footing, end));
    }
    if level == Level::Full {
        places(&mut study)?;
    }
    Ok(study)
}

/// The rough circle with its edge at other places of its cell.
fn places(study: &mut Study) -> Result<(), CaseError> {
    let footing = Footing::Circle { rough: true };
    let done = OTHER_PLACES
        .par_iter()
        .chain([&PLACE])
        .map(|&place| footing.push(CELLS_AT_PLACES, place))
        .collect::<Result<Vec<_>, CaseError>>()?;
    let (expected, band) = footing.says();
    let (mut least, mut most, mut sum, mut last) = (f64::INFINITY, 0.0_f64, 0.0, 0);
    for (k, (record, curve)) in done.into_iter().enumerate() {
        let end = curve.rows.last().map_or(f64::NAN, |row| row[1]);
        (least, most, sum) = (least.min(end), most.max(end), sum + end);
        if k < OTHER_PLACES.len() {
            curve.write_csv(&study.folder)?;
            last = study.run_to_end(record);
            study.check(last, "V/(A s_u) at the end [-]", expected, band, end);
        }
    }
    let spread = (most - least) / (sum / 5.0);
    let quantity = "rough circle, B/h = 8: spread over the places of the grid [-]";
    let band = Band::Between(0.0, SPREAD);
    study.check(last, quantity, INDIFFERENT.says(0.0), band, spread);
    Ok(())
}
