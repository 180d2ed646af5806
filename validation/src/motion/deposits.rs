//! What clay and sand leave when they have spread and rest.

use igimp_assembly::Particles;
use igimp_cases::CaseError;
use igimp_input::CaseFile;
use igimp_model::check::Band;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{RunRecord, Study};
use crate::runs::{Computed, shipped_case};

const PARABOLA: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "yield-stress fluid at rest on a rough floor, long wave",
    locator: "h² = 2 c_u (x_f − x)/γ, x_f = (9 V² γ/(8 c_u))^⅓",
};
const COLUMNS: Oracle = Oracle {
    kind: OracleKind::Published,
    source: "Lube et al. 2005; Lajeunesse et al. 2005; arXiv 1512.05180",
    locator: "run-out over half width: 1.2 a, a, 3.25 a^0.96 for short columns, 1.9 a^⅔, a^⅔, 3.80 a^0.73 for tall ones; the band is their range",
};
const EXPONENT: Oracle = Oracle {
    kind: OracleKind::Published,
    source: "Lube et al. 2005; Lajeunesse et al. 2005",
    locator: "run-out of columns lower than twice their half width in proportion to height",
};
/// Strength of the clay that spreads \[Pa\], unit weight \[N/m³\], volume of the half that is modelled \[m³/m\].
const STRENGTH: f64 = 309.0;
const WEIGHT: f64 = 18e3;
const VOLUME: f64 = 0.25;
/// A block of clay that stands, and then loses its strength.
const SLUMP: &str = r#"
igimp = 1
[case]
title = "a block of clay that spreads"
[grid]
cell = "5 cm"
domain = { x = ["0 m", "2.5 m"], y = ["-5 cm", "60 cm"] }
small_cuts = { below = 0.2 }
[materials.clay]
model = "von-mises"
unit_weight = "18 kN/m3"
young = "500 kPa"
poisson = 0.45
cu = "4 kPa"
[[bodies]]
name = "block"
material = "clay"
points_per_cell = 4
polygon = [["0 m", "0 m"], ["0.5 m", "0 m"], ["0.5 m", "0.5 m"], ["0 m", "0.5 m"]]
[boundaries]
left = "roller"
bottom = "fixed"
[[boundaries.boxes]]
name = "floor"
from = ["0 m", "-5 cm"]
to = ["2.5 m", "0 m"]
[[stages]]
name = "weight"
type = "gravity"
steps = 3
[[stages]]
name = "slump"
type = "run-out"
reduction = { factor = 12.945 }
materials = ["clay"]
steps = 400
"#;

/// Where the domains of all but a share of the particles end along the first axis \[m\].
fn front(particles: &Particles<2>, beyond: f64) -> f64 {
    let mut ends: Vec<f64> = std::iter::zip(&particles.x, &particles.half_length)
        .map(|(x, half)| x[0] + half[0])
        .collect();
    ends.sort_by(f64::total_cmp);
    let last = ((1.0 - beyond) * ends.len() as f64).floor() as usize;
    ends[last.clamp(1, ends.len()) - 1]
}

/// Holds the slump and the columns.
pub(super) fn hold(study: &mut Study) -> Result<(), CaseError> {
    slump(study)?;
    columns(study)
}

fn slump(study: &mut Study) -> Result<(), CaseError> {
    let case = CaseFile::parse("slump.toml", SLUMP, &[])?.into_case();
    let computed = Computed::<2>::new(case)?;
    let variant = "slump of clay, cells of 5 cm";
    let run = study.run_to_end(RunRecord::new(variant, &computed.report, computed.elapsed));
    let particles = computed.particles();
    let exact = (9.0 * VOLUME * VOLUME * WEIGHT / (8.0 * STRENGTH)).cbrt();
    let quantity = "front at rest [m]";
    study.check(
        run,
        quantity,
        PARABOLA.says(exact),
        Band::Relative(0.06),
        front(particles, 0.0),
    );
    for place in [0.1, 0.2, 0.3, 0.4] {
        let corners = std::iter::zip(&particles.x, &particles.half_length);
        let above = corners.filter(|(x, _)| (x[0] - place).abs() < 0.05);
        let found = above.map(|(x, half)| x[1] + half[1]).fold(0.0, f64::max);
        let height = (2.0 * STRENGTH * (exact - place) / WEIGHT).sqrt();
        let quantity = format!("height at x = {place} m [m]");
        let band = Band::Relative(0.03);
        study.check(run, quantity, PARABOLA.says(height), band, found);
    }
    Ok(())
}

fn columns(study: &mut Study) -> Result<(), CaseError> {
    let mut found = Vec::new();
    let mut last = 0;
    for aspect in [1_usize, 2, 3] {
        let height = 10 * aspect;
        let changes = vec![
            "grid.cell = 2 cm".to_owned(),
            format!(
                "grid.domain = {{ x = [\"0 m\", \"{} cm\"], y = [\"-2 cm\", \"{} cm\"] }}",
                20 + 32 * aspect,
                height + 4
            ),
            format!(
                "bodies.column.polygon = [[\"0 cm\", \"0 cm\"], [\"10 cm\", \"0 cm\"], [\"10 cm\", \"{height} cm\"], [\"0 cm\", \"{height} cm\"]]"
            ),
            format!(
                "boundaries.boxes.0.to = [\"{} cm\", \"0 cm\"]",
                20 + 32 * aspect
            ),
            format!("monitors.corner.point = [\"10 cm\", \"{height} cm\"]"),
            "stages.0.duration = 1.2 s".to_owned(),
        ];
        let computed = Computed::<2>::new(shipped_case("column_collapse", changes)?)?;
        let variant = format!("column of sand, a = {aspect}, cells of 2 cm");
        let run = RunRecord::new(variant, &computed.report, computed.elapsed);
        last = study.run_to_end(run);
        let run_out = (front(computed.particles(), 0.01) - 0.1) / 0.1;
        let a = aspect as f64;
        let (least, most) = (a.min(1.9 * a.powf(2.0 / 3.0)), 3.8 * a.powf(0.73));
        let lube = if a < 2.3 {
            1.2 * a
        } else {
            1.9 * a.powf(2.0 / 3.0)
        };
        let quantity = "run-out over half the width [-]";
        let band = Band::Between(least, most);
        study.check(last, quantity, COLUMNS.says(lube), band, run_out);
        found.push(run_out);
    }
    let slope = (found[1] / found[0]).log2();
    let quantity = "exponent of the run-out from a = 1 to 2 [-]";
    let band = Band::Between(0.85, 1.15);
    study.check(last - 1, quantity, EXPONENT.says(1.0), band, slope);
    Ok(())
}
