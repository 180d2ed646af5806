//! Water that stands, seeps and leaves.

use crate::resuming::{assert_done, assert_equal, everything, folder, run_into};
use crate::{Ran, between, file, ran};
use igimp_cases::run::Start;
use igimp_input::CaseFile;
use igimp_input::shipped::find;
use igimp_results::summary::StageOutcome::Completed;

#[test]
fn a_full_pool_and_a_drawdown_weaken_a_dam() {
    let ran = ran(
        "dam_drawdown",
        &[
            "grid.cell={ x=\"7.656 m\", y=\"3.65 m\" }",
            "stages.1.tolerance=0.1",
            "stages.3.tolerance=0.1",
            "output.figures=[]",
        ],
    );
    assert_eq!(ran.outcomes(), [Completed; 6]);
    between(ran.measured("factor of safety dry"), 2.4, 2.8);
    between(ran.measured("factor of safety with a full pool"), 1.85, 2.2);
}

// GOAL: a pumped well, a body of revolution: its discharge, and ground that settles towards it.
// CASE: the shipped case `well`, its pictures left out.
// ORACLE: the discharge of Charny's integral around an axis, in the check of the case; settlement is there, below a hundredth of a
// cell, and stresses of the ground at rest are in equilibrium with the water before.
#[test]
fn a_well_is_pumped() {
    let ran = ran("well", &["output.figures=[]"]);
    assert_eq!(ran.outcomes(), [Completed; 2]);
    between(ran.measured("discharge"), 1.486e-2, 1.516e-2);
    assert!(ran.run.summary.stages[0].largest_displacement < 1e-9);
    between(ran.run.summary.stages[1].largest_displacement, 1e-3, 5e-3);
}

#[test]
fn water_seeps_through_a_dam() {
    let ran = ran(
        "dam_seepage",
        &["stages.1.tolerance=0.02", "output.figures=[]"],
    );
    assert_eq!(ran.outcomes(), [Completed; 2]);
    between(ran.measured("factor of safety"), 1.06, 1.13);
    let discharges = &ran.run.summary.setup;
    let title = "Seepage: discharges";
    let discharges = discharges.iter().find(|t| t.title == title).unwrap();
    let of = |place: &str| {
        let row = discharges.rows.iter().find(|row| row[1].starts_with(place));
        row.unwrap()[2].parse::<f64>().unwrap()
    };
    // All that enters passes the section in the axis of the dam.
    assert!((of("section axis") / of("all") - 1.0).abs() < 1e-3);
}

#[test]
fn a_dam_recovers_from_a_rapid_drawdown() {
    let ran = ran(
        "rapid_drawdown",
        &[
            "grid.cell=4 m",
            "water.1.seepage.times=['5 d', '60 d']",
            "output.figures=[]",
        ],
    );
    assert_eq!(ran.outcomes(), [Completed; 10]);
    let factor = |name: &str| {
        let mut stages = ran.run.summary.stages.iter();
        let stage = stages.find(|stage| stage.name == name).unwrap();
        let safety = stage.safety.as_ref().unwrap();
        0.5 * (safety.stable.unwrap() + safety.failed.unwrap())
    };
    let names = [
        "full pool",
        "without drainage",
        "safety at 5 d",
        "safety at 60 d",
        "drained in the end",
    ];
    let [full, sudden, early, late, end] = names.map(factor);
    println!(
        "{full:.3} full, {sudden:.3} without drainage, {early:.3}, {late:.3}, {end:.3} drained"
    );
    assert!(sudden < early && early < late && late < end && early < full);
}

/// GOAL: clay settles as its water leaves, and a run that was interrupted leaves the same files, on any number of threads.
/// ORACLE: Terzaghi's series, in the checks of the case; the run that was not interrupted.
#[test]
fn clay_consolidates_under_a_fill() {
    consolidates(
        "consolidation",
        &ran("consolidation", &["output.figures=[]"]),
    );
}

// GOAL: clay around a vertical drain, a body of revolution, settles in time, loses the water that it settles by, and goes on where
// it was interrupted, on any number of threads.
// CASE: the shipped case `vertical_drain`.
// ORACLE: Barron's series, in the checks of the case; the run that was not interrupted.
#[test]
fn clay_drains_to_a_vertical_drain() {
    consolidates(
        "vertical_drain",
        &ran("vertical_drain", &["output.figures=[]"]),
    );
}

/// Runs a shipped case, whole and interrupted, that ran `alone` before.
fn consolidates(name: &str, alone: &Ran<2>) {
    let file = file(name, &["output.figures=[]"]);
    let [whole, stopped] = ["whole", "stopped"].map(|part| folder(&format!("{name}-{part}")));
    let run = run_into((&file, file.case()), &whole, Start::Afresh, None);
    assert_done(&run.summary);
    assert_eq!(run.summary.checks.len(), 2);
    assert!(run.summary.checks.iter().all(|check| check.pass));
    let stages = run.summary.stages.iter();
    let flowed: Vec<_> = stages
        .filter_map(|stage| stage.consolidation.as_ref())
        .collect();
    assert_eq!(flowed.len(), 2);
    for flow in flowed {
        assert!(flow.missing < 1e-8 * flow.outflow, "{flow:?}");
    }
    run_into((&file, file.case()), &stopped, Start::Afresh, Some(20));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build();
    let resume = || run_into((&file, file.case()), &stopped, Start::Resume, None);
    assert_done(&pool.unwrap().install(resume).summary);
    assert_equal(
        &everything(&whole),
        &everything(&stopped),
        "resumed on three threads",
    );
    assert!(alone.run.body.particles == run.body.particles);
}

/// Settlement of a layer over that in the end, after a time as c_v t/H² with the c_v at the top, where permeability falls linearly with
/// the depth to the share `least` at the sealed base: by volumes in differences, implicit in time.
fn settled(time: f64, least: f64) -> f64 {
    let (cells, steps) = (400, 4000_u16);
    let size = 1.0 / cells as f64;
    // Conductance from each cell to the one above; the top is open, half a cell away.
    let between = |k: usize| {
        let height = (k + 1) as f64 * size;
        (least + (1.0 - least) * height) / size * if k + 1 == cells { 2.0 } else { 1.0 }
    };
    let mut excess = vec![1.0; cells];
    let by_step = time / f64::from(steps) / size;
    for _ in 0..steps {
        let (mut upper, mut reduced) = (vec![0.0; cells], vec![0.0; cells]);
        for k in 0..cells {
            let [below, above] = [if k == 0 { 0.0 } else { between(k - 1) }, between(k)];
            let [below, above] = [below, above].map(|rate| by_step * rate);
            let [before, value] = if k == 0 {
                [0.0; 2]
            } else {
                [upper[k - 1], reduced[k - 1]]
            };
            let pivot = 1.0 + below + above - below * before;
            upper[k] = above / pivot;
            reduced[k] = (excess[k] + below * value) / pivot;
        }
        for k in (0..cells).rev() {
            let above = if k + 1 == cells { 0.0 } else { excess[k + 1] };
            excess[k] = reduced[k] + upper[k] * above;
        }
    }
    1.0 - excess.iter().sum::<f64>() * size
}

/// GOAL: permeability of soil that consolidates varies with the depth.
/// ORACLE: Terzaghi's equation in differences, with the permeability of each depth; the series where it does not vary.
#[test]
fn clay_that_is_tighter_below_settles_later() {
    // T = 0.1540 after a year; 0.24 % of the load is on the grains at once.
    let series = settled(0.1540, 1.0);
    assert!((series - 0.4428).abs() < 2e-4, "{series}");
    let varied =
        "{ horizontal = { depths = [\"0 m\", \"5 m\"], values = [\"5e-11 m/s\", \"1e-11 m/s\"] } }";
    let varied = format!("materials.clay.permeability={varied}");
    let ran = ran("consolidation", &[&varied, "output.figures=[]"]);
    for (quantity, time) in [
        ("degree after one year", 0.1540),
        ("degree after ten years", 1.540),
    ] {
        let (found, exact) = (ran.measured(quantity), 0.0024 + 0.9976 * settled(time, 0.2));
        println!("{quantity}: {found:.4} of {exact:.4}");
        assert!(
            (found - exact).abs() < 0.003,
            "{quantity}: {found} of {exact}"
        );
    }
}

#[test]
fn an_embankment_on_soft_clay_gains_strength_with_time() {
    let ran = ran("embankment_time", &["grid.cell=1.5 m", "output.figures=[]"]);
    assert_eq!(ran.outcomes(), [Completed; 9]);
    let stages = ran.run.summary.stages.iter();
    let safety = stages.filter_map(|stage| stage.safety.as_ref());
    let factors: Vec<f64> = safety.map(|search| search.stable.unwrap()).collect();
    println!("factors of safety {factors:.3?}");
    assert!(factors[0] > 1.0 && factors[1] > 1.1 * factors[0] && factors[2] > factors[1]);
}

/// GOAL: what a footing carries grows with the time that water has.
/// ORACLE: the undrained and the drained answer without time.
#[test]
fn a_slower_push_carries_more() {
    let ran = ran("penetration_rate", &["output.figures=[]"]);
    assert_eq!(ran.outcomes(), [Completed; 6]);
    let stages = ran.run.summary.stages.iter();
    let peaks: Vec<f64> = stages.filter_map(|stage| stage.peak_resistance).collect();
    println!("undrained, a minute, half a year, fifty years, drained: {peaks:.0?} N/m");
    let [undrained, minute, half, years, drained] = peaks[..] else {
        panic!("five pushes");
    };
    assert!((minute / undrained - 1.0).abs() < 0.02 && (years / drained - 1.0).abs() < 0.02);
    assert!(minute < half && half < years);
}

/// GOAL: drains that drain nothing, and pressure that would go both at once and in time, are refused at their place.
/// ORACLE: the key and the words.
#[test]
fn drains_without_thickness_and_two_ways_of_water_are_refused() {
    let refused = |settings: &[&str]| {
        let text = find("consolidation").unwrap().text;
        let settings: Vec<String> = settings.iter().map(|&entry| entry.to_owned()).collect();
        CaseFile::parse("consolidation", text, &settings)
            .unwrap_err()
            .to_string()
    };
    let flat =
        "stages.2.consolidation.drains=[{ from = [\"0 m\", \"2 m\"], to = [\"0.5 m\", \"2 m\"] }]";
    let text = refused(&[flat]);
    assert!(text.contains("this drain is flat"), "{text}");
    for (setting, printed) in [
        (
            "drains=[{ from = [\"40 m\", \"2 m\"], to = [\"41 m\", \"3 m\"] }]",
            "this drain meets no body",
        ),
        (
            "drains=[{ from = [\"0 m\", \"90 m\"], to = [\"1 m\", \"91 m\"] }]",
            "this drain meets no body",
        ),
        ("open_sides=[\"top\"]", "no body reaches the side top"),
    ] {
        let text = refused(&[&format!("stages.2.consolidation.{setting}")]);
        assert!(text.contains(printed) && text.contains("help:"), "{text}");
    }
    let text = refused(&["stages.2.type=construction", "stages.2.dissipate=true"]);
    assert!(text.contains("a stage with `dissipate`"), "{text}");
}
