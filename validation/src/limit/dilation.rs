//! The factor of safety against the angle of dilation: it rises to that of associated flow, and not beyond.

use std::fmt::Write as _;

use igimp_cases::CaseError;
use igimp_model::check::Band;
use rayon::prelude::*;

use super::Found;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};
use crate::runs::{Computed, shipped_case};

/// Non-associated flow carries no more.
const RADENKOVIC: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "Radenković (1961), theorems of limit analysis for Coulomb materials with non-associated flow",
    locator: "no limit load is larger than that of the same strength with associated flow",
};
/// Largest factor with ψ < φ, over that with ψ = φ, less 1 \[-\].
const ABOVE: f64 = 5e-3;
/// Largest fall of the factor while ψ rises, as a share of it \[-\].
const FALL: f64 = 5e-3;

/// The template `slope` with two soils, on its cells and half of them.
pub(super) fn raises_to_associated(study: &mut Study, level: Level) -> Result<(), CaseError> {
    let soils = [
        (20, 20, &[0, 5, 10, 14, 15, 16, 18, 20][..]),
        (35, 8, &[0, 5, 10, 14, 16, 18, 20, 25, 30, 35][..]),
    ];
    let cells: &[&str] = match level {
        Level::Full => &["1 m", "0.5 m"],
        _ => &["1 m"],
    };
    let mut note = "template slope, along the path: φ [°], cell; F by ψ [°]\n".to_owned();
    for cell in cells {
        for (friction, cohesion, dilations) in soils {
            let found = dilations
                .par_iter()
                .map(|dilation| {
                    let overrides = vec![
                        format!("grid.cell=\"{cell}\""),
                        format!("materials.clay.friction=\"{friction} deg\""),
                        format!("materials.clay.cohesion=\"{cohesion} kPa\""),
                        format!("materials.clay.dilation=\"{dilation} deg\""),
                    ];
                    let mut case = shipped_case("slope", overrides)?;
                    case.stages.truncate(2);
                    case.curves.clear();
                    case.checks.clear();
                    Ok(Found::of(&Computed::new(case)?))
                })
                .collect::<Result<Vec<_>, CaseError>>()?;
            let factors: Vec<f64> = found.iter().map(|found| found.factor).collect();
            let by: Vec<String> = std::iter::zip(dilations, &factors)
                .map(|(dilation, factor)| format!("{dilation} {factor:.4}"))
                .collect();
            let _ = writeln!(note, "  {friction}, {cell}; {}", by.join(", "));
            let associated = factors.last().copied().unwrap_or(f64::NAN);
            let most = largest(factors.iter().copied());
            let falls = factors.windows(2).map(|pair| 1.0 - pair[1] / pair[0]);
            let records: Vec<RunRecord> = found
                .iter()
                .map(|found| found.record(String::new()))
                .collect();
            let name = format!("slope, φ = {friction}°, cells of {cell}");
            let run = study.run(RunRecord::sum(name, &records.iter().collect::<Vec<_>>()));
            study.check(
                run,
                "largest factor of safety over that with ψ = φ [-]",
                RADENKOVIC.says(1.0),
                Band::AtMost(1.0 + ABOVE),
                most / associated,
            );
            study.check(
                run,
                "largest fall of the factor of safety while ψ rises [-]",
                RADENKOVIC.says(0.0),
                Band::AtMost(FALL),
                largest(falls),
            );
        }
    }
    study.notes.push(note);
    Ok(())
}

/// The largest value; not a number if one is not.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NEG_INFINITY, |most, value| {
        if most.is_nan() || value.is_nan() {
            f64::NAN
        } else {
            most.max(value)
        }
    })
}
