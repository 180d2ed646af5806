//! Associated flow on the strengths of Davis (1968) in place of flow by the dilation angle: against the infinite slope, and
//! beside the answer of the other.

use std::fmt::Write as _;
use std::sync::Arc;

use igimp_assembly::SharedLaw;
use igimp_cases::CaseError;
use igimp_material::Strength;
use igimp_model::check::Band;
use rayon::prelude::*;

use super::Found;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};
use crate::runs::{Computed, shipped_case};
use crate::tilted_layer::{dry_sand, slides_at};

/// Shear along lines of no extension.
const DAVIS: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Davis (1968), theories of plasticity and the failure of soil masses",
    locator: "shear along lines of no extension, as in the infinite slope: tan β = sin φ cos ψ / (1 − sin φ sin ψ), φ reduced by F",
};
/// Davis's strengths are no larger than those given.
const LIMIT_THEOREMS: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "theorems of limit analysis",
    locator: "soil that is nowhere stronger carries no more; at ψ = φ it is the same soil",
};

/// The template `slope`, φ = 35°, c = 8 kPa.
const FRICTION: f64 = 35.0;
const COHESION: f64 = 8.0;

/// Flow by ψ, flow by Davis's strengths made anew at every factor (B), and made once (A).
#[derive(Clone, Copy, Debug)]
enum Flow {
    Dilation,
    Davis,
    DavisAtFirst,
}

impl Flow {
    fn factor(self, dilation: f64, cell: &str) -> Result<Found, CaseError> {
        let share = {
            let (phi, psi) = (FRICTION.to_radians(), dilation.to_radians());
            psi.cos() * phi.cos() / (1.0 - psi.sin() * phi.sin())
        };
        let weaker = (share * FRICTION.to_radians().tan()).atan().to_degrees();
        let [cohesion, friction, dilation] = match self {
            Self::DavisAtFirst => [share * COHESION, weaker, weaker],
            _ => [COHESION, FRICTION, dilation],
        };
        let flow = match self {
            Self::Davis => "davis",
            _ => "dilation",
        };
        let overrides = vec![
            format!("grid.cell=\"{cell}\""),
            format!("materials.clay.friction=\"{friction} deg\""),
            format!("materials.clay.cohesion=\"{cohesion} kPa\""),
            format!("materials.clay.dilation=\"{dilation} deg\""),
            format!("materials.clay.flow=\"{flow}\""),
        ];
        let mut case = shipped_case("slope", overrides)?;
        case.stages.truncate(2);
        case.curves.clear();
        case.checks.clear();
        Ok(Found::of(&Computed::new(case)?))
    }
}

/// Factors of a slope by either flow, and the infinite slope.
pub(super) fn beside_dilation(study: &mut Study, level: Level) -> Result<(), CaseError> {
    infinite_slope(study);
    let cells: &[&str] = match level {
        Level::Full => &["1 m", "0.5 m"],
        _ => &["1 m"],
    };
    let mut note = "template slope, φ = 35°, c = 8 kPa: cell, ψ [°]; F by dilation, Davis (φ at the factor), Davis (φ as given); \
                    corrections\n"
        .to_owned();
    for cell in cells {
        let dilations = [0.0, 10.0, 20.0, FRICTION];
        let flows = [Flow::Dilation, Flow::Davis, Flow::DavisAtFirst];
        let found = dilations
            .par_iter()
            .map(|&dilation| {
                let factors = flows.map(|flow| flow.factor(dilation, cell));
                factors.into_iter().collect::<Result<Vec<_>, _>>()
            })
            .collect::<Result<Vec<_>, CaseError>>()?;
        let associated = &found[dilations.len() - 1];
        for (dilation, row) in dilations.iter().zip(&found) {
            let each = |of: &dyn Fn(&Found) -> String| -> String {
                row.iter().map(of).collect::<Vec<_>>().join(", ")
            };
            let _ = writeln!(
                note,
                "  {cell}, {dilation}; {}; {}",
                each(&|found| format!("{:.4}", found.factor)),
                each(&|found| found.corrections.to_string()),
            );
            let run = study.run(row[1].record(format!(
                "slope, φ = 35°, ψ = {dilation}°, cells of {cell}, flow by Davis"
            )));
            let band = if *dilation < FRICTION {
                Band::AtMost(1.0)
            } else {
                Band::Relative(1e-9)
            };
            study.check(
                run,
                "factor of safety over that with ψ = φ [-]",
                LIMIT_THEOREMS.says(1.0),
                band,
                row[1].factor / associated[0].factor,
            );
        }
    }
    study.notes.push(note);
    Ok(())
}

/// Long layers that are tilted: dilation [°], F.
fn infinite_slope(study: &mut Study) {
    for (dilation, factor) in [(0.0_f64, 1.0), (10.0, 1.0), (10.0, 1.3)] {
        let psi = dilation.to_radians();
        let soil = dry_sand(psi).with_davis_flow();
        let soil = soil.expect("its strengths are those of the soil, and smaller");
        let law: SharedLaw = soil.reduced(factor).expect("the factor is positive");
        let phi = (30.0_f64.to_radians().tan() / factor).atan();
        let exact = phi.sin() * psi.cos() / (1.0 - phi.sin() * psi.sin());
        let (found, record) = slides_at(&law);
        let run = study.run(RunRecord {
            variant: format!(
                "infinite slope, φ = 30°, ψ = {dilation}°, F = {factor}, flow by Davis"
            ),
            ..record
        });
        study.check(
            run,
            "tan β at sliding [-]",
            DAVIS.says(exact),
            Band::Relative(0.01),
            found,
        );
        let other: SharedLaw = Arc::new(dry_sand(psi));
        let other = other.reduced(factor).expect("the factor is positive");
        let (by_dilation, _) = slides_at(&other);
        study.notes.push(format!(
            "infinite slope, φ = 30°, ψ = {dilation}°, F = {factor}: tan β = {found:.4} by Davis, {by_dilation:.4} by dilation, exact {exact:.4}\n"
        ));
    }
}
