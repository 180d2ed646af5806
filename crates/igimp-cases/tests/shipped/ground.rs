//! Ground that settles, bends, is dug and filled.

use crate::resuming::{assert_done, assert_equal, everything, folder, run_into};
use crate::{between, file, ran};
use igimp_cases::run::Start;
use igimp_results::summary::StageOutcome::Completed;

#[test]
fn embankment_settles_more_with_every_lift() {
    let ran = ran(
        "embankment",
        &[
            "grid.cell=2 m",
            "grid.domain.y=[\"0 m\", \"26 m\"]",
            "stages.1.steps=2",
            "stages.2.steps=2",
            "stages.3.steps=2",
        ],
    );
    assert_eq!(ran.outcomes(), [Completed; 4]);
    let settlements: Vec<f64> = ran.curve("settlement").iter().map(|p| p[1]).collect();
    assert!(settlements.windows(2).all(|pair| pair[0] <= pair[1]));
    between(ran.end_of("settlement"), 70.0, 140.0);
    let stress = ran.measured("vertical stress in the clay below the axis");
    between(stress, 150.0, 200.0);
}

#[test]
fn k0_ground_is_exact() {
    let ran = ran("k0_ground", &["stages.0.steps=1"]);
    assert_eq!(ran.outcomes(), [Completed]);
    assert!(ran.meets_its_checks());
    between(ran.virtual_work(1.0), 1.0 - 1e-9, 1.0 + 1e-9);
}

/// The settlement of clay that remembers, over the share of a wide fill.
#[test]
fn soft_clay_settles_along_its_compression_line() {
    let ran = ran("soft_clay_fill", &["stages.1.steps=4"]);
    assert_eq!(ran.outcomes(), [Completed, Completed]);
    assert!(ran.meets_its_checks());
    // By half of the fill as by all of it: ln J = -λ*/(1 + λ*) ln(1 + q/σ₀), over 8 m below 18 kPa.
    let exact = |fill: f64| {
        let depths = (0..8000).map(|k| 18.0 + 6.0 * (f64::from(k) + 0.5) / 1000.0);
        let moved = depths.map(|sigma| 1.0 - (1.0 + fill / sigma).powf(-0.12 / 1.12));
        moved.sum::<f64>() / 1000.0
    };
    let curve = ran.curve("settlement");
    let loaded: Vec<_> = curve.iter().filter(|point| point[0] > 0.0).collect();
    assert_eq!(loaded.len(), 4);
    for point in loaded {
        let expected = exact(40.0 * point[0]) + 0.001 * point[0];
        println!("settlement {:.5} of exact {expected:.5}", point[1]);
        between(point[1] / expected, 0.99, 1.01);
    }
    // Preconsolidation went with the stress: 18 kPa and the weight of the clay, and the fill.
    let particles = &ran.run.body.particles;
    let clay = (0..particles.len()).filter(|&p| particles.law[p] == 1);
    for p in clay {
        let [p_c, ..] = particles.internal[p];
        let pressure = -(0..3).map(|a| particles.sigma[p][a][a]).sum::<f64>() / 3.0;
        // (1 + η²/M²) p of Kirchhoff stress along the line of K₀, η = 0.36205.
        assert!(
            p_c < 1.1311 * 1.02 * pressure && p_c > 0.85 * 1.1311 * pressure,
            "{p_c} {pressure}"
        );
    }
}

/// GOAL: undrained, clay between stiff sides bears a wide fill by its water: the share of K_w/n over what both are stiff together.
/// ORACLE: no more settlement than the fill over K_w/n, and excess pressure of the fill within 1 %.
#[test]
fn undrained_soft_clay_bears_a_wide_fill_by_its_water() {
    let ran = ran(
        "soft_clay_fill",
        &[
            "materials.clay.drainage=undrained",
            "materials.clay.pore_water=1 GPa",
            "stages.1.steps=2",
            "checks=[]",
        ],
    );
    assert_eq!(ran.outcomes(), [Completed, Completed]);
    let particles = &ran.run.body.particles;
    for p in (0..particles.len()).filter(|&p| particles.law[p] == 1) {
        between(particles.excess[p] / 40e3, 0.99, 1.001);
    }
    let settlement = ran.end_of("settlement");
    between(settlement, 0.0009, 0.001 + 8.0 * 40e3 / 1e9 * 1.05);
}

/// GOAL: what clay remembers is in checkpoints: a run that is taken up within a stage ends with the same files, and one on other
/// threads with the same bits.
#[test]
fn soft_clay_is_taken_up_with_what_it_remembers() {
    let settings = ["stages.1.steps=4", "output.figures=[]"];
    let file = file("soft_clay_fill", &settings);
    let whole = folder("soft-clay-whole");
    let run = run_into((&file, file.case()), &whole, Start::Afresh, None);
    assert_done(&run.summary);
    let expected = everything(&whole);
    let stopped = folder("soft-clay-stopped");
    let early = run_into((&file, file.case()), &stopped, Start::Afresh, Some(3));
    assert!(early.summary.interrupted);
    let end = run_into((&file, file.case()), &stopped, Start::Resume, None);
    assert_done(&end.summary);
    assert_equal(&expected, &everything(&stopped), "after 3 steps");
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let again = pool.unwrap().install(|| ran("soft_clay_fill", &settings));
        assert!(
            again.run.body.particles == run.body.particles,
            "{threads} threads"
        );
    }
}

#[test]
fn cantilever_bends_as_a_beam() {
    let ran = ran("cantilever", &["grid.cell=0.25 m", "stages.1.steps=5"]);
    assert_eq!(ran.outcomes(), [Completed, Completed]);
    between(ran.measured("small deflection in mm") / 33.53, 0.9, 1.1);
    between(ran.end_of("deflection") / 0.30172, 0.9, 1.1);
}

#[test]
fn block_slumps_until_it_rests() {
    let ran = ran(
        "block",
        &["grid.cell=0.5 m", "bodies.block.points_per_cell=4"],
    );
    assert_eq!(ran.outcomes(), [Completed, Completed]);
    between(ran.measured("height on the axis at rest"), 1.7, 2.6);
    between(ran.virtual_work(1.0), 0.98, 1.02);
}

#[test]
fn what_is_left_below_a_pit_is_its_buoyant_weight() {
    let ran = ran(
        "excavation",
        &["stages.4.tolerance=0.5", "output.figures=[]"],
    );
    assert_eq!(ran.outcomes(), [Completed; 5]);
    let at_rest = ran.measured("effective vertical stress at rest");
    assert!((at_rest / 71.4975 - 1.0).abs() < 1e-9, "{at_rest}");
    between(
        ran.measured("effective vertical stress below the pit"),
        30.0,
        31.5,
    );
}

#[test]
fn an_embankment_is_filled_in_lifts() {
    let ran = ran(
        "embankment_lifts",
        &["stages.5.tolerance=0.05", "output.figures=[]"],
    );
    assert_eq!(ran.outcomes(), [Completed; 6]);
    between(ran.measured("factor of safety"), 1.147, 1.22);
}
