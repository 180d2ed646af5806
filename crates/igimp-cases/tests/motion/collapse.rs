//! GOAL: what soil leaves when it has spread and rests is what experiments and the theory of yield-stress fluids say.
//! CASE: the shipped column of sand at other heights; a block of clay that spreads over a rough floor.
//! ORACLE: run-outs of columns of grains; the parabola of a yield-stress fluid at rest on a rough floor.

use igimp_cases::run::in_memory;
use igimp_input::{CaseFile, shipped};
use igimp_results::summary::StageOutcome;

/// Half the width of the columns \[m\].
const HALF_WIDTH: f64 = 0.1;

/// The run-out of a column over half its width, to where the domains of all but a hundredth of its particles end \[-\].
fn run_out(aspect: usize) -> f64 {
    let height = 10 * aspect;
    let changes = [
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
    let shipped = shipped::find("column_collapse").unwrap();
    let file = shipped
        .case_file(changes.iter().map(String::as_str))
        .unwrap();
    let run = in_memory(file.case()).unwrap();
    let stage = &run.summary.stages[0];
    assert_eq!(stage.code, "came-to-rest", "{}", stage.reason);
    let particles = &run.body.particles;
    let mut ends: Vec<f64> = std::iter::zip(&particles.x, &particles.half_length)
        .map(|(x, half)| x[0] + half[0])
        .collect();
    ends.sort_by(f64::total_cmp);
    (ends[ends.len() * 99 / 100 - 1] - HALF_WIDTH) / HALF_WIDTH
}

/// GOAL: a column of dry sand runs out as columns of grains do.
/// ORACLE: run-outs over half the width of columns of aspect a in the plane. Lube et al. (2005): 1.2 a below 2.3 and 1.9 a^⅔ above;
/// Lajeunesse et al. (2005): a and a^⅔ with constants by the channel; rods of aluminium (arXiv 1512.05180): 3.25 a^0.96 and 3.80 a^0.73.
/// They spread by a factor of three, by grains and channel: from the least to the largest is the band. Slope 1 below two.
#[test]
fn columns_of_sand_run_out_as_experiments_do() {
    let [one, two, three] = [1, 2, 3].map(run_out);
    println!("run-outs {one} {two} {three}");
    for (aspect, found) in [(1.0_f64, one), (2.0, two), (3.0, three)] {
        let least = aspect.min(1.9 * aspect.powf(2.0 / 3.0));
        let most = 3.8 * aspect.powf(0.73);
        assert!((least..most).contains(&found), "{aspect}: {found}");
    }
    let slope = (two / one).log2();
    assert!((slope - 1.0).abs() < 0.15, "{slope}");
}

/// GOAL: clay that spreads over a rough floor, creeping against a drag, rests as a fluid of its strength does.
/// ORACLE: where the deposit is long, h² = 2 c_u (x_f − x) / γ, and its front x_f = (9 V² γ / 8 c_u)^⅓ follows from its volume V: half of it
/// stands behind a symmetry. Towards the front it is short of long, and stands higher.
#[test]
fn a_slump_rests_as_a_yield_stress_fluid() {
    let (strength, weight, volume) = (309.0, 18e3, 0.25_f64);
    let text = r#"
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
    let file = CaseFile::parse("slump.toml", text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let run = in_memory(file.case()).unwrap();
    let stage = &run.summary.stages[1];
    assert_eq!(stage.outcome, StageOutcome::Completed, "{}", stage.reason);
    let particles = &run.body.particles;
    let corners: Vec<[f64; 2]> = std::iter::zip(&particles.x, &particles.half_length)
        .map(|(x, half)| [x[0], x[1] + half[1]])
        .collect();
    let front = (9.0 * volume * volume * weight / (8.0 * strength)).cbrt();
    let found = corners.iter().map(|own| own[0]).fold(0.0, f64::max);
    println!("front {found} for {front}");
    assert!((found / front - 1.0).abs() < 0.06, "{found} {front}");
    for place in [0.1, 0.2, 0.3, 0.4] {
        let column = corners.iter().filter(|own| (own[0] - place).abs() < 0.05);
        let height = column.map(|own| own[1]).fold(0.0, f64::max);
        let expected = (2.0 * strength * (front - place) / weight).sqrt();
        println!("{place}: {height} for {expected}");
        assert!(
            (height / expected - 1.0).abs() < 0.03,
            "{place}: {height} {expected}"
        );
    }
}
