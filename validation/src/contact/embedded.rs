//! A strip whose base stands one width deep, with soil beside it.

use std::path::Path;

use igimp_assembly::{Geometry, Interface, Locking, Surface};
use igimp_cases::CaseError;

use super::buried::{Buried, Claim, Question, adhesive, answer};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, Study};

/// The book's description of the study.
const ABOUT: &str = "A rigid strip with a rough base stands one width deep in weightless Tresca soil with E/s_u = 1000, its side bare, smooth and bonded, or bonded with adhesion s_u, and is pushed down at small strain. The bare side is held against bounds of limit analysis, the others are told.";
const BOUNDS: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "finite-element limit analysis of a strip one width deep",
    locator: "lower and upper bound of V/(B s_u)",
};

/// A strip with this side.
fn strip(cells: usize, side: Interface, locking: Locking, rounding: f64) -> Buried {
    let h = 1.0 / cells as f64;
    let corners = [[-0.5, 0.0], [0.5, 0.0], [0.5, 2.0], [-0.5, 2.0]];
    let rough = Interface::rough();
    Buried {
        variant: String::new(),
        cells,
        surface: Surface::polygon(&corners, rounding * h, h).expect("the outline has corners"),
        interfaces: vec![rough.clone(), side.clone(), rough, side],
        inner: vec![[0.5, 1.0], [0.5, 0.0], [0.0, 0.0]],
        top: 1.0,
        fine: [1.0, -0.75, 1.0],
        reach: [4.0, 3.0],
        push: -0.1,
        locking,
        small_cut: 1e-4,
        geometry: Geometry::Given,
        per_direction: 2,
        steps: 20,
    }
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-embedded", ABOUT, out)?;
    let sides = [
        ("bare", Interface::smooth(), [6.27, 6.404]),
        (
            "smooth bonded",
            Interface::smooth().bonded(),
            [6.366, 6.486],
        ),
        ("adhesive bonded", adhesive(1.0).bonded(), [8.302, 8.396]),
        ("rough bonded", Interface::rough().bonded(), [8.302, 8.396]),
    ];
    let methods = [
        ("B-bar, rounding 0.5", Locking::BBar, 0.5),
        ("B-bar, rounding 0.3", Locking::BBar, 0.3),
        ("shared strain, rounding 0", Locking::SharedStrain, 0.0),
    ];
    let mut questions = Vec::new();
    for (name, side, bounds) in &sides {
        let is_bare = *name == "bare";
        for (method, locking, rounding) in methods {
            let is_usual = locking == Locking::BBar && rounding > 0.4;
            let meshes = match level {
                Level::Quick if is_bare && is_usual => vec![9],
                Level::Default if is_usual && *name == "adhesive bonded" => vec![9],
                Level::Default if is_usual => vec![9, 17],
                Level::Full if is_usual || *name != "adhesive bonded" => vec![9, 17],
                _ => continue,
            };
            questions.push(Question {
                name: format!("{name} side, {method}"),
                oracle: BOUNDS,
                bounds: *bounds,
                beyond: 0.02,
                claim: match (is_bare, is_usual) {
                    (true, true) => Claim::Every,
                    (true, false) => Claim::Extrapolated,
                    _ => Claim::None,
                },
                meshes,
                body: Box::new(move |cells| strip(cells, side.clone(), locking, rounding)),
            });
        }
    }
    answer(&mut study, &questions)?;
    Ok(study)
}
