//! Changes of the factor of safety with the strengths, from the last step of its path: they add up to 1, and are what
//! reruns with other strengths find.

use std::fmt::Write as _;

use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_results::summary::StrengthShares;

use super::{Found, Sought, VARIED};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{RunRecord, Study};
use crate::runs::{Computed, shipped_case};
use crate::slopes::problems::Problem;

/// Strength is divided by the factor.
const HOMOGENEITY: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "every reduced strength is divided by the factor",
    locator: "F is homogeneous of degree one in them: Euler's theorem",
};
/// The same answer without a derivative.
const RERUNS: Oracle = Oracle {
    kind: OracleKind::IndependentProgram,
    source: "searches with the strength at 0.97 and 1.03 of its value",
    locator: "central difference of ln F",
};
/// The theorem that needs a field of velocities only.
const KINEMATIC: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "kinematic theorem of limit analysis",
    locator: "with associated flow the mechanism at the limit dissipates the work of the weight",
};
/// A strength in reruns over its value \[-\].
const RATIOS: [f64; 2] = [0.97, 1.03];
/// Largest difference of a change from that of reruns, as a share of it \[-\].
const DIFFERENCE: f64 = 0.05;

/// A case whose strengths are varied: its material, with its strengths, and the names of both.
struct Varied<'a> {
    name: String,
    material: &'a str,
    /// Key of the file, value, unit; tan φ is varied for an angle.
    strengths: &'a [(&'a str, f64, &'a str)],
    run: &'a dyn Fn(&[String]) -> Result<Found, CaseError>,
    associated: bool,
}

/// Three slopes against reruns.
pub(super) fn against_reruns(study: &mut Study, problems: &[Problem]) -> Result<(), CaseError> {
    let mut note = "changes with strength: slope, material; ∂ ln F/∂ ln, by reruns\n".to_owned();
    if let Some(problem) = problems.iter().find(|p| p.section.name == VARIED) {
        for associated in [true, false] {
            let sought = Sought {
                problem,
                associated,
                cells: problem.meshes[0],
            };
            let layer = &problem.section.layers[0];
            let strengths = [
                ("cohesion", layer.cohesion, "kPa"),
                ("friction", layer.friction, "deg"),
            ];
            let varied = Varied {
                name: sought.name(),
                material: "soil-0",
                strengths: &strengths,
                run: &|overrides| sought.find(problem.search, true, overrides),
                associated,
            };
            check(study, &varied, &mut note)?;
        }
    }
    let layered = |overrides: &[String]| {
        let mut case = shipped_case("layered_slope", overrides.to_vec())?;
        case.stages.truncate(2);
        case.checks.clear();
        Ok(Found::of(&Computed::new(case)?))
    };
    for (material, strength) in [("firm", 45.0), ("soft", 25.0)] {
        let varied = Varied {
            name: format!("layered_slope, {material}"),
            material,
            strengths: &[("cu", strength, "kPa")],
            run: &layered,
            associated: true,
        };
        check(study, &varied, &mut note)?;
    }
    study.notes.push(note);
    Ok(())
}

/// The changes of one case against reruns.
fn check(study: &mut Study, varied: &Varied<'_>, note: &mut String) -> Result<(), CaseError> {
    let found = (varied.run)(&[])?;
    let nothing = StrengthShares::default();
    let shares = found.path().and_then(|path| path.shares.as_ref());
    let shares = shares.unwrap_or(&nothing);
    let run = study.run(found.record(varied.name.clone()));
    study.check(
        run,
        "sum of ∂ ln F/∂ ln of all strengths [-]",
        HOMOGENEITY.says(1.0),
        Band::Relative(1e-3),
        shares.strengths().map(|(_, _, share)| share).sum(),
    );
    if varied.associated {
        let kinematic = shares.kinematic.map_or(f64::NAN, |bound| bound.factor);
        study.check(
            run,
            "kinematic factor over the factor of safety [-]",
            KINEMATIC.says(1.0),
            Band::Relative(0.02),
            kinematic / found.factor,
        );
    }
    for &(key, value, unit) in varied.strengths {
        let mut reruns = Vec::new();
        for ratio in RATIOS {
            let angle = |degrees: f64| (degrees.to_radians().tan() * ratio).atan().to_degrees();
            let value = if unit == "deg" {
                angle(value)
            } else {
                value * ratio
            };
            let set = |key: &str| format!("materials.{}.{key}=\"{value} {unit}\"", varied.material);
            let mut overrides = vec![set(key)];
            if key == "friction" && varied.associated {
                overrides.push(set("dilation"));
            }
            reruns.push((varied.run)(&overrides)?);
        }
        let kind = if key == "friction" { "tan φ" } else { "c" };
        let by_reruns = (reruns[1].factor / reruns[0].factor).ln() / (RATIOS[1] / RATIOS[0]).ln();
        let rate = (shares.strengths())
            .find(|(material, name, _)| *material == varied.material && *name == kind)
            .map_or(f64::NAN, |(_, _, share)| share);
        let _ = writeln!(note, "  {}; {kind}; {rate:.4}, {by_reruns:.4}", varied.name);
        let records: Vec<RunRecord> = reruns
            .iter()
            .map(|found| found.record(String::new()))
            .collect();
        let name = format!("{}, {kind} at 0.97 and 1.03", varied.name);
        let run = study.run(RunRecord::sum(name, &records.iter().collect::<Vec<_>>()));
        study.check(
            run,
            "∂ ln F/∂ ln of the strength [-]",
            RERUNS.says(by_reruns),
            Band::Relative(DIFFERENCE),
            rate,
        );
    }
    Ok(())
}
