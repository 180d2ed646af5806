//! A column in space under its own weight, held against a printed table of another program.

use std::path::Path;

use igimp_cases::CaseError;
use igimp_input::CaseFile;
use igimp_model::check::Band;
use igimp_results::tables::table::Table;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{RunRecord, Study};
use crate::runs::Computed;

/// The book's description of the study.
const ABOUT: &str = "A soft column of two cells in space settles under its own weight, as in the tutorial of another program for the method: the vertical stress at its particles, at all four heights.";
const TUTORIAL: Oracle = Oracle {
    kind: OracleKind::IndependentProgram,
    source: "AMPSSIE, tutorial 1: column of 0.4 m × 0.4 m × 0.8 m, h = 0.4 m, E = 1000 Pa, ν = 0, 20 steps",
    locator: "table of |σ_zz| over the initial heights 0.1, 0.3, 0.5, 0.7 m, at a residual below 1e-7",
};
/// The printed stresses \[Pa\].
const PRINTED: [f64; 4] = [309.684_676_5, 309.684_676_5, 110.435_444_4, 57.352_732_64];
/// The case.
const CASE: &str = r#"
igimp = 1
[case]
title = "A column in space"
analysis = "3d"
gravity = "9.81 m/s2"
[grid]
cell = "0.4 m"
domain = { x = ["0 m", "0.4 m"], y = ["0 m", "0.4 m"], z = ["0 m", "0.8 m"] }
[materials.rubber]
model = "elastic"
unit_weight = "490.5 N/m3"
young = "1000 Pa"
poisson = 0
[[bodies]]
name = "column"
material = "rubber"
box = { from = ["0 m", "0 m", "0 m"], to = ["0.4 m", "0.4 m", "0.8 m"] }
[boundaries]
left = "roller"
right = "roller"
front = "roller"
back = "roller"
bottom = "fixed"
[[stages]]
name = "weight"
type = "gravity"
steps = 20
"#;

/// Runs the study; it is short enough to be the same at every level.
pub(crate) fn study(out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("space-column", ABOUT, out)?;
    for locking in ["none", "b-bar"] {
        let file = CaseFile::parse("space-column", CASE, &[format!("grid.locking={locking}")])?;
        let computed = Computed::new(file.case_in_space().clone())?;
        let record = RunRecord::new(computed.method(), &computed.report, computed.elapsed);
        let run = study.run_to_end(record);
        let particles = computed.particles();
        let mut table = Table::new(
            format!("stress_{locking}"),
            &[
                "initial_height_[m]",
                "height_[m]",
                "sigma_zz_[Pa]_tension_+",
            ],
        );
        for particle in 0..particles.len() {
            let z = particles.x[particle][2];
            let z0 = z - particles.displacement[particle][2];
            table.push(vec![z0, z, particles.sigma[particle][2][2]]);
        }
        table.rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
        // Four particles at each height.
        for (printed, rows) in PRINTED.into_iter().zip(table.rows.chunks(4)) {
            let worst = |a: &&Vec<f64>, b: &&Vec<f64>| {
                (a[2] + printed).abs().total_cmp(&(b[2] + printed).abs())
            };
            let Some(row) = rows.iter().max_by(worst) else {
                continue;
            };
            study.check(
                run,
                format!("−σ_zz at a height of {:.1} m [Pa]", row[0]),
                TUTORIAL.says(printed),
                Band::Relative(1e-6),
                -row[2],
            );
        }
        table.write_csv(&study.folder)?;
    }
    Ok(study)
}
