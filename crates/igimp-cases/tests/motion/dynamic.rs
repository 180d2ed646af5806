//! GOAL: stages that take time move soil with inertia, close their energy, end at rest, and leave the same bytes however they are
//! interrupted and whatever the number of threads.
//! CASE: the shipped collapse of a column, shortened; a block that falls, in space.
//! ORACLE: the sum of the energy; free fall; bytes of a run that was never stopped.

use crate::imbalance;
use crate::resuming::{assert_done, assert_equal, everything, folder, run_into};
use igimp_cases::run::{Start, in_memory};
use igimp_input::{CaseFile, shipped};
use igimp_model::Field;
use igimp_results::paraview::{pvd, read_back};
use igimp_results::summary::StageOutcome;
use igimp_results::vtu::read::Frame;

/// The shipped collapse with changes.
fn collapse(changes: &[&str]) -> CaseFile {
    let shipped = shipped::find("column_collapse").unwrap();
    shipped.case_file(changes.iter().copied()).unwrap()
}

/// GOAL: a column of sand collapses until it rests; nearly all of its energy is plastic work, and the method takes little.
#[test]
fn a_column_collapses_and_comes_to_rest() {
    let file = collapse(&["grid.cell = 2 cm", "grid.domain.y = [\"-2 cm\", \"14 cm\"]"]);
    let run = in_memory(file.case()).unwrap();
    let stage = &run.summary.stages[0];
    assert_eq!(stage.outcome, StageOutcome::Completed, "{}", stage.reason);
    assert_eq!(stage.code, "came-to-rest");
    let energy = stage.energy.as_ref().unwrap();
    assert!(imbalance(energy).abs() < 1e-9 * energy.loads, "{energy:?}");
    assert!(energy.plastic > 0.9 * energy.loads, "{energy:?}");
    assert!(energy.scheme > 0.0 && energy.map > 0.0);
    assert!(energy.numerical_share() < 0.1, "{energy:?}");
    let fallen = energy.loads / (16e3 * 0.01);
    let top = (run.body.particles.x.iter())
        .map(|x| x[1])
        .fold(0.0, f64::max);
    assert!(
        fallen > 0.01 && fallen < 0.04 && top < 0.1,
        "{fallen} {top}"
    );
}

/// Sand whose friction grows with the speed of shear.
const GRAINS: [&str; 3] = [
    "materials.sand.model = drucker-prager",
    "materials.sand.cone = plane-strain",
    "materials.sand.rate = { friction = \"50.8 deg\", inertial_number = 0.279, grain_diameter = \"5 mm\", grain_density = \"2650 kg/m3\" }",
];

/// GOAL: sand whose friction grows with the speed of shear falls and spreads less in a time, with less kinetic energy, and its energy
/// closes. ORACLE: the same cone without it; the sum of the energy.
#[test]
fn friction_by_speed_holds_a_collapse_back() {
    let ran = |changes: &[&str]| {
        let coarse = [
            "grid.cell = 2 cm",
            "grid.domain.y = [\"-2 cm\", \"14 cm\"]",
            "stages.collapse.duration = 0.25 s",
        ];
        let run = in_memory(collapse(&[&coarse, changes].concat()).case()).unwrap();
        let energy = run.summary.stages[0].energy.unwrap();
        assert!(imbalance(&energy).abs() < 1e-9 * energy.loads, "{energy:?}");
        energy
    };
    let [plain, grains] = [ran(&GRAINS[..2]), ran(&GRAINS)];
    println!("{plain:?}\n{grains:?}");
    assert!(grains.most_kinetic < 0.92 * plain.most_kinetic);
    assert!(grains.loads < 0.98 * plain.loads);
}

/// GOAL: a run in the middle of a motion goes on with the same bytes, by any scheme, with friction that goes with its speed, and with a
/// rigid body that falls and meets soil.
#[test]
fn a_resumed_motion_leaves_the_same_files() {
    let schemes = ["backward-euler", "newmark", "generalised-alpha"].map(|scheme| {
        let of_scheme = format!("stages.collapse.scheme = {scheme}");
        collapse(&[
            "stages.collapse.duration = 0.03 s",
            "stages.collapse.steps = 2",
            &of_scheme,
        ])
    });
    let impact = shipped::find("impact").unwrap();
    let impact = impact.case_file(["stages.fall.duration = 0.35 s", "stages.fall.steps = 5"]);
    let short = [
        "stages.collapse.duration = 0.03 s",
        "stages.collapse.steps = 2",
    ];
    let grains = collapse(&[&short[..], &GRAINS[..]].concat());
    let all = schemes.into_iter().zip(std::iter::repeat(6));
    for (file, taken) in all.chain([(grains, 6), (impact.unwrap(), 12)]) {
        let whole = folder("dynamic-whole");
        assert_done(&run_into((&file, file.case()), &whole, Start::Afresh, None).summary);
        let resumed = folder("dynamic-resumed");
        let stopped = run_into((&file, file.case()), &resumed, Start::Afresh, Some(taken));
        let title = &file.case().title;
        assert!(stopped.summary.interrupted, "{title}");
        assert_done(&run_into((&file, file.case()), &resumed, Start::Resume, None).summary);
        assert_equal(
            &everything(&whole),
            &everything(&resumed),
            &file.case().title,
        );
    }
}

/// GOAL: frames of a motion carry its velocity and its times in seconds, from the first moment on, stage by stage.
/// ORACLE: a block that falls freely from rest has v = −g t and a = −g.
#[test]
fn frames_of_a_motion_have_velocities_and_times() {
    let text = r#"
        igimp = 1
        [case]
        title = "a block that falls"
        gravity = "10 m/s2"
        [grid]
        cell = "1 m"
        domain = { x = ["0 m", "4 m"], y = ["0 m", "12 m"] }
        [materials.clay]
        model = "elastic"
        unit_weight = "20 kN/m3"
        young = "10 MPa"
        poisson = 0.3
        [[bodies]]
        name = "block"
        material = "clay"
        points_per_cell = 4
        polygon = [["1 m", "8 m"], ["3 m", "8 m"], ["3 m", "10 m"], ["1 m", "10 m"]]
        [[stages]]
        name = "fall"
        type = "dynamic"
        duration = "0.3 s"
        scheme = "newmark"
        steps = 3
        [[stages]]
        name = "fall on"
        type = "dynamic"
        duration = "0.2 s"
        scheme = "newmark"
        steps = 2
    "#;
    let file = CaseFile::parse("fall.toml", text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let root = folder("dynamic-frames");
    assert_done(&run_into((&file, file.case()), &root, Start::Afresh, None).summary);
    let paraview = root.join("paraview");
    let expected: [&[f64]; 2] = [&[0.0, 0.1, 0.2, 0.3], &[0.3, 0.4, 0.5]];
    for (stage, expected) in expected.into_iter().enumerate() {
        let frames = pvd::motion(&paraview, stage);
        assert_eq!(frames.len(), expected.len(), "{frames:?}");
        for (frame, time) in std::iter::zip(&frames, expected) {
            assert!((frame.time - time).abs() < 1e-12, "{frame:?}");
            let text = std::fs::read_to_string(paraview.join(&frame.file)).unwrap();
            let read = Frame::of(&text).unwrap();
            let holds = |field, value: f64| {
                let values = read_back::values(&read, field).unwrap();
                assert_eq!(values.len(), 16);
                for found in values {
                    assert!((found - value).abs() < 1e-8, "{field:?} at {time}: {found}");
                }
            };
            holds(Field::VelocityY, -10.0 * time);
            holds(Field::VelocityX, 0.0);
            holds(Field::Speed, 10.0 * time);
            if *time > 0.0 {
                holds(Field::AccelerationY, -10.0);
            }
        }
    }
    // The second stage begins with the frame that the first one ended with.
    let ends = [0, 1].map(|stage| pvd::motion(&paraview, stage));
    assert_eq!(ends[0][3].file, ends[1][0].file);
    let energy = std::fs::read_to_string(root.join("figures/energy-2-fall-on.svg")).unwrap();
    assert!(energy.contains("kinetic") && energy.contains("loads"));
}

/// GOAL: threads change no bit.
#[test]
fn threads_change_no_bit_of_a_motion() {
    let file = collapse(&[
        "stages.collapse.duration = 0.02 s",
        "stages.collapse.steps = 2",
    ]);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let run = pool.install(|| in_memory(file.case()).unwrap());
        let particles = &run.body.particles;
        (
            particles.x.clone(),
            particles.velocity.clone(),
            run.summary.stages[0].energy,
        )
    };
    let one = on(1);
    assert!(one.1.iter().any(|v| v[0] > 0.0));
    for threads in [2, 7] {
        assert!(on(threads) == one, "{threads} threads");
    }
}

/// GOAL: in space a block falls freely, either scheme has its acceleration, and time is a quantity.
#[test]
fn a_block_falls_in_space() {
    let text = r#"
        igimp = 1
        [case]
        title = "a block that falls"
        analysis = "3d"
        gravity = "10 m/s2"
        [grid]
        cell = "1 m"
        domain = { x = ["0 m", "4 m"], y = ["0 m", "4 m"], z = ["0 m", "8 m"] }
        [materials.clay]
        model = "elastic"
        unit_weight = "20 kN/m3"
        young = "10 MPa"
        poisson = 0.3
        [[bodies]]
        name = "block"
        material = "clay"
        points_per_cell = 8
        box = { from = ["1 m", "1 m", "4 m"], to = ["3 m", "3 m", "6 m"] }
        [[stages]]
        name = "fall"
        type = "dynamic"
        duration = "600 ms"
        scheme = "newmark"
        steps = 3
        [[checks]]
        name = "time"
        of = "time"
        expected = "0.6 s"
        tolerance = 1e-12
        source = "the duration of the stage"
    "#;
    let particles = |scheme: &str| {
        let text = text.replace("newmark", scheme);
        let file = CaseFile::parse("fall.toml", &text, &[]);
        let file = file.unwrap_or_else(|error| panic!("{error}"));
        in_memory(file.case_in_space()).unwrap().body.particles
    };
    let block = particles("newmark");
    for (displacement, velocity) in std::iter::zip(&block.displacement, &block.velocity) {
        assert!((displacement[2] + 1.8).abs() < 1e-9, "{displacement:?}");
        assert!((velocity[2] + 6.0).abs() < 1e-9, "{velocity:?}");
        assert!(displacement[0].abs() < 1e-9 && velocity[1].abs() < 1e-9);
    }
    for scheme in ["newmark", "backward-euler"] {
        let block = particles(scheme);
        let falls = |a: &[f64; 3]| (a[2] + 10.0).abs() < 1e-8;
        assert!(block.acceleration.iter().all(falls), "{scheme}");
    }
}

/// GOAL: a body that is let go without a mass is refused, where it is named.
#[test]
fn a_free_body_without_weight_is_refused() {
    let impact = shipped::find("impact").unwrap();
    let refused = impact
        .case_file(["rigid.boulder.weight = 0 kN/m"])
        .unwrap_err();
    let text = refused.to_string();
    assert!(
        text.contains("`boulder` is loaded or free in stage `fall`"),
        "{text}"
    );
    assert!(
        text.contains("has no mass") && text.contains("state its weight"),
        "{text}"
    );
}
