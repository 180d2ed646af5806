//! The limit load of a rigid strip under a force, along its path, against its march by displacements.

use std::fmt::Write as _;

use igimp_cases::CaseError;
use igimp_model::check::Band;

use super::Found;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{RunRecord, Study};
use crate::runs::{Computed, shipped_case};

/// A displacement that is prescribed has an equilibrium whatever the load.
const DISPLACED: Oracle = Oracle {
    kind: OracleKind::IndependentProgram,
    source: "march of the same strip by displacements",
    locator: "its resistance at 0.3 B on the given geometry",
};
/// The rise of a path in its last doubling, and of the march from there to 0.3 B, as a share of the load \[-\].
const OFF: f64 = 5e-3;

/// A rough strip on undrained clay, pressed on level ground by a drive, and its resistance N \[-\].
fn resistance(drive: &str, others: &[&str]) -> Result<(f64, RunRecord), CaseError> {
    let mut overrides = [
        "rigid.footing.reference=[\"0 m\", \"14/9 m\"]",
        "stages.seat.geometry=given",
        "stages.load.geometry=given",
        "curves=[]",
    ]
    .map(str::to_owned)
    .to_vec();
    overrides.push(format!(
        "stages.load.bodies=[{{ body = \"footing\", {drive} }}]"
    ));
    overrides.extend(others.iter().map(|&text| text.to_owned()));
    let computed = Computed::new(shipped_case("eccentric_footing", overrides)?)?;
    let summary = &computed.run.summary;
    let measured = summary
        .checks
        .first()
        .map_or(f64::NAN, |row| row.check.measured);
    let record = Found::of(&computed).record(format!("rigid strip, {drive}"));
    Ok((measured, record))
}

/// Presses the strip both ways.
pub(super) fn carries_as_displaced(study: &mut Study) -> Result<(), CaseError> {
    let (displaced, _) = resistance("y = \"-0.3 m\"", &["stages.load.steps=100"])?;
    let stop = "stages.load.stop_when={ no_equilibrium = true }";
    let mut note =
        "rigid strip: N along the path of its force; N at 0.3 B by displacements\n".to_owned();
    for force in [7.0, 12.0] {
        let drive = format!("force_y = \"-{force} kN/m\"");
        let (loaded, record) = resistance(&drive, &[stop, "stages.load.steps=10"])?;
        let _ = writeln!(note, "  {drive}: {loaded:.4}; {displaced:.4}");
        let run = study.run(record);
        study.check(
            run,
            "limit load along the path over the resistance by displacements [-]",
            DISPLACED.says(1.0),
            Band::Between(1.0 - OFF, 1.0 + OFF),
            loaded / displaced,
        );
    }
    study.notes.push(note);
    Ok(())
}
