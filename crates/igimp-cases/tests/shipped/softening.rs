//! Slopes of soil that softens.

use crate::resuming::{assert_equal, everything, folder, run_into};
use crate::{between, file, ran, ran_case};
use igimp_cases::run::Start;
use igimp_results::summary::StageOutcome::Completed;

/// The shipped slope on coarse cells, whose cohesion, friction and dilation soften.
const SOFTENS: [&str; 6] = [
    "grid.cell=2 m",
    "stages.0.steps=4",
    "stages.1.tolerance=0.02",
    "materials.clay.dilation=5 deg",
    "materials.clay.softening={ cohesion = { residual = 0.5, strain = 0.1 }, \
     friction = { residual = \"16 deg\", strain = 0.1, curve = \"linear\" }, \
     dilation = { residual = \"0 deg\", strain = 0.05 }, band_width = \"1 m\" }",
    "checks=[]",
];

/// GOAL: a slope whose c, φ and ψ soften is less safe than one that keeps them, and safer than one that has the residual ones from the start.
#[test]
fn a_slope_that_softens_lies_between_peak_and_residual() {
    let factor = |more: &[&str]| {
        let file = file("slope", &[&SOFTENS, more].concat());
        let mut case = file.case().clone();
        case.stages.truncate(2);
        ran_case(&case).factor_of_safety(1)
    };
    let without = |more: &[&str]| {
        let keeps = [&SOFTENS[..4], &SOFTENS[5..], more].concat();
        let file = file("slope", &keeps);
        let mut case = file.case().clone();
        case.stages.truncate(2);
        ran_case(&case).factor_of_safety(1)
    };
    let residual = [
        "materials.clay.cohesion=10 kPa",
        "materials.clay.friction=16 deg",
        "materials.clay.dilation=0 deg",
    ];
    let (peak, softens, residual) = (without(&[]), factor(&[]), without(&residual));
    println!("F {peak:?} at the peak, {softens:?} softening, {residual:?} residual");
    assert!(softens[1] < 0.99 * peak[0] && softens[0] > 1.01 * residual[1]);
}

/// GOAL: the peak of a path of softening soil is resolved: it goes neither by the steps in which weight came nor by those of the path.
/// CASE: the shipped slope of sensitive clay on cells of half a metre, its weight in 10, 12 and 15 steps, which come past the peak in other places.
/// ORACLE: trials of strength, each of which marches to an equilibrium or finds none; and cells that see the weight alike.
#[test]
fn the_peak_of_a_path_is_that_of_trials() {
    let factor = |steps: usize, search: &[&str]| {
        let steps = format!("stages.0.steps={steps}");
        let usual = ["grid.cell=0.5 m", "checks=[]", &steps];
        let file = file("sensitive_slope", &[&usual, search].concat());
        ran_case(file.case()).factor_of_safety(1)
    };
    let trials = factor(10, &["stages.1.search=trials", "stages.1.tolerance=0.001"]);
    let paths = [10, 12, 15].map(|steps| factor(steps, &[]));
    println!("F {trials:?} by trials, {paths:?} along paths");
    for [from, to] in paths {
        assert!(from < to && to < 1.003 * from, "{from} {to}");
        let apart = (0.5 * (from + to) / (0.5 * (trials[0] + trials[1])) - 1.0).abs();
        assert!(apart < 2e-3, "{from} {to} {trials:?}");
    }
}

/// GOAL: what softening soil remembers is in checkpoints: a run-out that is taken up ends with the same files, and one on other threads with
/// the same bits.
#[test]
fn a_slope_that_softens_is_taken_up_with_what_it_remembers() {
    is_taken_up("softening", SOFTENS[4]);
}

/// GOAL: the same of nonlocal strain, with a length in place of a width; and the slope stands.
#[test]
fn a_slope_that_softens_over_a_length_is_taken_up_with_what_it_remembers() {
    let softening = SOFTENS[4].replace("band_width = \"1 m\"", "length = \"4 m\"");
    is_taken_up("nonlocal", &softening);
}

fn is_taken_up(name: &str, softening: &str) {
    let steps = [softening, "stages.2.steps=4", "output.figures=[]"];
    let file = file("slope", &[&SOFTENS[..4], &SOFTENS[5..], &steps].concat());
    let whole = folder(&format!("{name}-whole"));
    let run = run_into((&file, file.case()), &whole, Start::Afresh, None);
    let remembered = &run.body.particles.internal;
    assert!(!remembered.is_empty() && run.summary.stages.len() == 3);
    let expected = everything(&whole);
    let taken: usize = run.summary.stages[0].steps + 3;
    let stopped = folder(&format!("{name}-stopped"));
    let early = run_into((&file, file.case()), &stopped, Start::Afresh, Some(taken));
    assert!(early.summary.interrupted);
    run_into((&file, file.case()), &stopped, Start::Resume, None);
    assert_equal(&expected, &everything(&stopped), "after it was taken up");
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let again = pool.unwrap().install(|| ran_case(file.case()));
        assert!(
            again.run.body.particles == run.body.particles,
            "{threads} threads"
        );
    }
}

/// GOAL: a slope of clay that softens has one factor of safety on three meshes, 2 %, between those of residual and of intact strength;
/// without the width of the band it falls with the cell.
/// ORACLE: γH F/c_u of 5.379 to 5.412 by limit analysis; strains scaled by the width of the band (eq. 110).
#[test]
fn sensitive_slope_is_as_safe_on_three_meshes() {
    let height = "grid.domain.y=[\"0 m\", \"15 m\"]";
    let factor = |cell: &str, more: &[&str]| {
        let cell = format!("grid.cell={cell}");
        let ran = ran("sensitive_slope", &[&[&cell, height], more].concat());
        assert_eq!(ran.outcomes(), [Completed, Completed]);
        assert!(ran.meets_its_checks());
        let [stands, fails] = ran.factor_of_safety(1);
        0.5 * (stands + fails)
    };
    let factors = ["1 m", "0.625 m", "0.5 m"].map(|cell| factor(cell, &[]));
    // Strains that hold on cells of the width of the band are those of the case there, and twice those of cells of 1 m.
    let unscaled = factor("1 m", &["materials.clay.softening.band_width=1 m"]);
    println!("{factors:?}, on cells of 1 m without scaling {unscaled}");
    for factor in factors {
        between(factor, 0.451, 1.494);
        between(factor / factors[0], 0.98, 1.02);
    }
    assert!(unscaled > 1.03 * factors[2], "{unscaled}");
}

/// GOAL: with a length in place of a width a slope of clay that softens has one factor on three meshes, 0.2 %, between those of residual
/// and of intact strength; without either it falls with the cell by more than 2 %.
/// ORACLE: γH F/c_u of 5.379 to 5.412 by limit analysis; the length is a property of the clay, which no mesh changes.
#[test]
fn sensitive_slope_has_one_factor_with_a_length() {
    let factor = |cell: &str, length: &str| {
        let height = "grid.domain.y=[\"0 m\", \"12 m\"]";
        let strength = "cu = { residual = 0.3, strain = 0.05 }";
        let softening = format!("materials.clay.softening={{ {strength}{length} }}");
        let cell = format!("grid.cell={cell} m");
        let ran = ran("sensitive_slope", &[&cell, height, &softening]);
        assert_eq!(ran.outcomes(), [Completed, Completed]);
        let [stands, fails] = ran.factor_of_safety(1);
        let remembered = ran.run.body.particles.internal.iter();
        let spread = remembered.fold(0.0, |most: f64, state| most.max(state[1]));
        assert_eq!(spread > 0.0, !length.is_empty());
        0.5 * (stands + fails)
    };
    let factors = ["1", "2/3", "1/2"].map(|cell| factor(cell, ", length = \"1 m\""));
    let alone = ["1", "1/2"].map(|cell| factor(cell, ""));
    println!("{factors:?} with a length of 1 m, {alone:?} without");
    for factor in factors {
        between(factor, 0.451, 1.494);
        between(factor / factors[0], 0.998, 1.002);
    }
    between(alone[1] / alone[0], 0.9, 0.98);
}
