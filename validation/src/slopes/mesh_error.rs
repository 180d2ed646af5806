//! The mesh error of every slope with bounds: the factor extrapolated from two meshes.

use igimp_assembly::Locking;
use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_results::mesh_study::{Computed, Convergence, Estimate, estimate};
use igimp_results::tables::table::Table;

use super::problems::Problem;
use super::{Found, Slopes};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::coverage::Known;
use crate::harness::study::{RunRecord, Study};
use crate::limit_equilibrium::section::Variant;

/// The extrapolated quantity.
const EXTRAPOLATED: &str = "factor of safety, extrapolated from two meshes [-]";
/// How far the extrapolated factor may lie beyond the bounds \[-\].
const BEYOND: f64 = 0.015;
/// The promise of the stated uncertainty.
const UNCERTAINTY: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "lower and upper bounds of all slopes that have both",
    locator: "extrapolated value and uncertainty overlap the bounds in nine of ten",
};

/// The columns of each slope.
const HEADER: [&str; 9] = [
    "slope",
    "psi=phi",
    "known_from_[-]",
    "known_to_[-]",
    "coarse_[-]",
    "fine_[-]",
    "extrapolated_[-]",
    "uncertainty_[-]",
    "covers_the_bounds",
];

/// A slope with bounds that was run on both meshes.
struct Pair<'s> {
    place: usize,
    problem: &'s Problem,
    /// With ψ = φ; else with ψ = 0.
    associated: bool,
    bounds: [f64; 2],
    /// The results on the coarse mesh and on the fine one.
    on: [&'s Found; 2],
}

impl<'s> Pair<'s> {
    fn of(slopes: &'s Slopes, place: usize, associated: bool) -> Option<Self> {
        let problem = &slopes.problems[place];
        let on = |mesh: usize| {
            let variant = Variant {
                cells: problem.meshes[mesh],
                locking: Locking::SharedStrain,
                associated,
            };
            slopes.of(place, variant)
        };
        Some(Self {
            place,
            problem,
            associated,
            bounds: slopes.known[place].interval,
            on: [on(0)?, on(1)?],
        })
    }

    fn name(&self) -> String {
        let flow = if self.associated { "" } else { ", ψ = 0" };
        format!("{}{flow}, two meshes", self.problem.section.name)
    }

    /// The factor on cells of no size.
    fn extrapolated(&self, study: &mut Study) -> Option<Estimate> {
        let values = values(self.on, &self.problem.meshes);
        let known = Known {
            convergence: Convergence::SOIL,
            truth: self.bounds,
        };
        // ψ = 0 knows no bounds of its own.
        if self.associated {
            study.extrapolate(self.name(), known, &values)
        } else {
            estimate(&values, known.convergence)
        }
    }

    /// Whether the extrapolated factor reaches the bounds within its uncertainty.
    fn covers(&self, found: &Estimate) -> bool {
        let [lower, upper] = self.bounds;
        found.value - found.uncertainty <= upper && found.value + found.uncertainty >= lower
    }

    fn run(&self) -> RunRecord {
        let [coarse, fine] = self.on.map(|found| found.run(String::new()));
        RunRecord::sum(self.name(), &[&coarse, &fine])
    }

    fn row(&self, found: &Estimate) -> Vec<f64> {
        vec![
            self.place as f64 + 1.0,
            f64::from(u8::from(self.associated)),
            self.bounds[0],
            self.bounds[1],
            self.on[0].factor(),
            self.on[1].factor(),
            found.value,
            found.uncertainty,
            f64::from(u8::from(self.covers(found))),
        ]
    }

    fn line(&self, found: &Estimate) -> String {
        let [lower, upper] = self.bounds;
        format!(
            "  {:>2} {:<48} {lower:.3} … {upper:.3}; {:.4}, {:.4}; {:.4} ± {:.4}\n",
            self.place + 1,
            self.name(),
            self.on[0].factor(),
            self.on[1].factor(),
            found.value,
            found.uncertainty,
        )
    }
}

/// Extrapolates each slope that has bounds and was run on both meshes, with ψ = φ and ψ = 0.
pub(super) fn report(study: &mut Study, slopes: &Slopes) -> Result<(), CaseError> {
    let mut table = Table::new("mesh_error", &HEADER);
    let mut note = String::from("mesh error: known; coarse, fine; extrapolated\n");
    let mut runs = Vec::new();
    let mut covered = 0_usize;
    let with_bounds = (slopes.problems.iter().enumerate())
        .filter(|(_, p)| p.oracle.kind == OracleKind::LimitAnalysis && p.known.is_some());
    let pairs = with_bounds
        .flat_map(|(place, _)| [true, false].map(|associated| Pair::of(slopes, place, associated)));
    for pair in pairs.flatten() {
        let Some(found) = pair.extrapolated(study) else {
            continue;
        };
        let both = pair.run();
        let run = study.run(both.clone());
        if pair.associated {
            covered += usize::from(pair.covers(&found));
            runs.push(both);
            let [lower, upper] = pair.bounds;
            let expected = pair.problem.oracle.says(0.5 * (lower + upper));
            let band = Band::Between((1.0 - BEYOND) * lower, (1.0 + BEYOND) * upper);
            study.check(run, EXTRAPOLATED, expected, band, found.value);
        }
        table.push(pair.row(&found));
        note += &pair.line(&found);
    }
    if runs.is_empty() {
        return Ok(());
    }
    let counted = runs.len();
    let all = format!("all {counted} slopes with bounds");
    let run = study.run(RunRecord::sum(all, &runs.iter().collect::<Vec<_>>()));
    study.check(
        run,
        "share of slopes whose bounds the uncertainty reaches [-]",
        UNCERTAINTY.says(1.0),
        Band::AtLeast(0.9),
        covered as f64 / counted as f64,
    );
    study.notes.push(note);
    Ok(table.write_csv(&study.folder)?)
}

/// The factors on a coarse and a fine mesh.
fn values(found: [&Found; 2], meshes: &[u32]) -> [Computed; 2] {
    [0, 1].map(|mesh| Computed {
        h: f64::from(meshes[mesh]).recip(),
        value: found[mesh].factor(),
        half_width: found[mesh].half_width(),
    })
}
