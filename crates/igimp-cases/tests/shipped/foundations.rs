//! Footings and loads on level ground.

use crate::resuming::{assert_done, assert_equal, everything, folder, run_into};
use crate::{between, file, ran};
use igimp_cases::run::Start;
use igimp_input::CaseFile;
use igimp_input::shipped::find;
use igimp_results::summary::StageOutcome::Stopped;

#[test]
fn bearing_capacity_is_that_of_prandtl() {
    let ran = ran(
        "bearing_capacity",
        &["grid.cell=2/9 m", "stages.0.steps=40"],
    );
    assert!(ran.run.failure.is_none());
    between(ran.end_of("load-settlement"), 4.9, 5.9);
}

/// GOAL: a body of revolution is computed from its file: a rough circle carries what slip lines give, as the force on the whole circle.
/// ORACLE: N = 6.048 of Eason and Shield (1960).
#[test]
fn circular_footing_is_that_of_slip_lines() {
    let ran = ran("circular_footing", &["stages.0.steps=15"]);
    assert!(ran.run.failure.is_none());
    let n = ran.end_of("load-settlement");
    assert!((n / 6.048 - 1.0).abs() < 0.02, "{n}");
    let size = ran.run.summary.size;
    let volume = std::f64::consts::PI * 3.57_f64.powi(2) * 2.835;
    assert!(size.is_whole() && (size.volume / volume - 1.0).abs() < 1e-12);
}

/// GOAL: a force and a weight on a rigid body of revolution are those of the whole body.
/// ORACLE: the settlement at which the body, displaced, has that resistance. Soil that yields keeps the way in which it was loaded: they
/// part by 4e-4 of the settlement in 4 steps, 1.4e-4 in 16 and 4e-5 in 64, and by 5e-4 to 2e-3 where the weight acts whole in one step. A
/// weight that is held where its body is laid comes on evenly.
#[test]
fn a_circle_under_load_settles_as_far_as_one_that_is_displaced() {
    let curve = "curves=[{ name = \"w\", x = { of = \"rigid.footing.settlement\" }, y = { of = \"rigid.footing.resistance\" } }]";
    let end = |overrides: &[&str]| {
        let common = [
            "grid.cell=0.21 m",
            "grid.fit=none",
            "output.figures=[]",
            curve,
        ];
        let ran = ran("circular_footing", &[&common, overrides].concat());
        assert!(ran.run.failure.is_none());
        *ran.curve("w").last().unwrap()
    };
    let push = |motion: &str| format!("stages.0.bodies=[{{ body = \"footing\", {motion} }}]");
    let [settlement, resistance] = end(&["stages.0.steps=16", &push("y = \"-3 mm\"")]);
    assert!(resistance > 0.3 * 6.048 * 50e3 * std::f64::consts::PI);
    let force = push(&format!("force_y = \"-{resistance} N\""));
    let weight = format!("rigid.footing.weight={resistance} N");
    let pulled = [
        weight.as_str(),
        "case.gravity=9.81 m/s2",
        "materials.clay.unit_weight=0 kN/m3",
        "stages=[{ name = \"weight\", type = \"gravity\", geometry = \"given\", steps = 4 }, { name = \"held\", type = \"rigid\", geometry = \"given\", bodies = [{ body = \"footing\", y = \"0 m\" }], steps = 1 }, { name = \"free\", type = \"rigid\", geometry = \"given\", bodies = [{ body = \"footing\", free = [\"y\"] }], steps = 16 }]",
    ];
    for loaded in [end(&["stages.0.steps=16", &force]), end(&pulled)] {
        let ratio = loaded[0] / settlement;
        assert!((ratio - 1.0).abs() < 2e-4, "{ratio}");
    }
}

/// GOAL: a footing on clay whose strength goes with direction carries the share of the isotropic load that slip lines give, and with the
/// logarithm of the rate as much more as the strength grows; the angle of compression is resumed and printed.
/// ORACLE: N = 1 + s_p/s_a and half the girth of the ellipse of Davis and Christian (1971), by quadrature; 5.142 of one strength. A push
/// that is 100 times as fast adds two log cycles of strength everywhere, so that N grows by two cycles times that of one strength.
#[test]
fn anisotropic_footing_carries_what_slip_lines_give() {
    let coarse = ["grid.cell=2/7 m", "stages.0.steps=30"];
    let isotropic = [
        "materials.clay.anisotropy.simple_shear=1.0",
        "materials.clay.anisotropy.passive=1.0",
    ];
    let end = |more: &[&str]| {
        let ran = ran("anisotropic_footing", &[&coarse, more].concat());
        assert!(ran.run.failure.is_none());
        // Time alone is no consolidation.
        let stages = ran.run.summary.stages.iter();
        assert!({ stages }.all(|stage| stage.consolidation.is_none()));
        ran.end_of("load-settlement")
    };
    let [shipped, plain] = [end(&[]), end(&isotropic)];
    let exact = |shear: f64, passive: f64| {
        let level = 0.5 * (1.0 + passive);
        let upright = shear * level / passive.sqrt();
        let arcs = 10_000;
        let width = std::f64::consts::PI / f64::from(arcs);
        let arc = |k: i32| {
            let (sine, cosine) = ((f64::from(k) + 0.5) * width).sin_cos();
            (level * sine).hypot(upright * cosine) * width
        };
        1.0 + passive + (0..arcs).map(arc).fold(0.0, |sum, part| sum + part)
    };
    assert!((exact(1.0, 1.0) / (2.0 + std::f64::consts::PI) - 1.0).abs() < 1e-6);
    let share = exact(0.75, 0.5) / exact(1.0, 1.0);
    println!(
        "N {shipped:.4} of {plain:.4}: {:.4}, exact {share:.4}",
        shipped / plain
    );
    between(plain, 4.9, 5.7);
    between(shipped / plain / share, 0.96, 1.01);
    let fast = |duration: &str| {
        let rate = "materials.clay.rate={ per_log_cycle = 0.1, reference = \"1 %/h\" }";
        let time = format!("stages.0.consolidation={{ duration = \"{duration}\" }}");
        end(&[&isotropic[..], &[rate, &time, "output.figures=[]"]].concat())
    };
    let [hour, blow] = [fast("1 h"), fast("36 s")];
    let grown = (blow - hour) / (0.2 * plain);
    println!("N {hour:.4} in an hour, {blow:.4} in 36 s: {grown:.4} of two cycles");
    between(grown, 0.95, 1.05);
}

/// GOAL: a footing on sand that stiffens with its stress is stiffer as it is relieved, goes on where it was left, and is resumed to the bit.
/// ORACLE: where all stresses double, those of weight, cohesion, backfill and moduli with the pressure that they hold at, every strain is
/// the same. Soil that
/// was relieved carries in the end what soil carries that never was, and where it turned almost as much.
#[test]
fn dense_sand_footing_remembers_and_scales() {
    let coarse = ["grid.cell=2/5 m", "output.figures=[]"];
    let pressures = |more: &[&str]| {
        let ran = ran("dense_sand_footing", &[&coarse, more].concat());
        assert!(ran.run.failure.is_none());
        ran.curve("load-settlement")
    };
    let curve = pressures(&[]);
    let at = |settlement: f64, points: &[[f64; 2]]| {
        let pair = points.windows(2).find(|pair| {
            let [from, to] = [pair[0][0], pair[1][0]];
            (from - to).abs() > 0.0 && (from.min(to)..=from.max(to)).contains(&settlement)
        });
        let [from, to] = *pair.unwrap().as_array::<2>().unwrap();
        from[1] + (to[1] - from[1]) * (settlement - from[0]) / (to[0] - from[0])
    };
    let turned = curve
        .iter()
        .position(|point| (point[0] - 50.0).abs() < 1e-9)
        .unwrap();
    let (pushed, after) = curve.split_at(turned + 1);
    let lowest = after
        .iter()
        .position(|point| (point[0] - 45.0).abs() < 1e-9)
        .unwrap();
    let (relieved, again) = after.split_at(lowest + 1);
    let slope = |points: &[[f64; 2]], far: f64| (at(50.0, points) - at(far, points)) / (50.0 - far);
    let stiffer = slope(&[&pushed[turned..], relieved].concat(), 48.0) / slope(pushed, 46.0);
    let returned = at(50.0, again) / pushed[turned][1];
    let straight = pressures(&[
        "stages.3.bodies=[{ body = 'footing', y = '-1 mm' }]",
        "stages.4.bodies=[{ body = 'footing', y = '-49 mm' }]",
    ]);
    let same = curve.last().unwrap()[1] / straight.last().unwrap()[1];
    println!(
        "relieved {stiffer:.3} times as stiff, {returned:.4} of the load back, {same:.4} of it at the end"
    );
    between(stiffer, 3.0, 5.0);
    between(returned, 0.97, 1.01);
    between(same, 0.995, 1.005);
    let heavy = pressures(&[
        "materials.sand.unit_weight=34 kN/m3",
        "materials.sand.cohesion=2 kPa",
        "materials.sand.e50=60 MPa",
        "materials.sand.eur=180 MPa",
        "materials.sand.eoed=60 MPa",
        "materials.sand.reference_pressure=200 kPa",
        "loads.0.pressure=34 kPa",
    ]);
    for (heavy, point) in heavy.iter().zip(&curve) {
        assert_eq!(heavy[0].to_bits(), point[0].to_bits());
        assert!(
            (heavy[1] - 2.0 * point[1]).abs() <= 1e-6 * 2000.0,
            "{heavy:?} {point:?}"
        );
    }
}

/// GOAL: a body of revolution that moves far goes on where it was stopped, on other threads, to the bit; its strain around the axis is kept.
/// ORACLE: the run that was not stopped; volumes of nearly incompressible clay.
#[test]
fn circular_footing_resumes_on_other_threads() {
    let overrides = [
        "grid.cell=0.21 m",
        "stages.0.steps=12",
        "stages.0.geometry=moving",
        "stages.0.bodies=[{ body = \"footing\", y = \"-0.12 m\" }]",
        "curves=[]",
        "output.figures=[]",
    ];
    let case = file("circular_footing", &overrides);
    let (whole, stopped) = (folder("circle-whole"), folder("circle-stopped"));
    let run = run_into((&case, case.case()), &whole, Start::Afresh, None);
    assert_done(&run.summary);
    run_into((&case, case.case()), &stopped, Start::Afresh, Some(5));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build();
    let resume = || run_into((&case, case.case()), &stopped, Start::Resume, None);
    assert_done(&pool.unwrap().install(resume).summary);
    assert_equal(
        &everything(&whole),
        &everything(&stopped),
        "resumed on three threads",
    );
    let particles = &run.body.particles;
    let most = particles
        .hoop_strain
        .iter()
        .fold(0.0, |most: f64, strain| most.max(strain.abs()));
    assert!(most > 0.01, "{most}");
    let volume = |of: &dyn Fn(usize) -> f64| (0..particles.len()).map(of).sum::<f64>();
    let ratio = volume(&|k| particles.volume(k)) / volume(&|k| particles.volume0[k]);
    assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
}

/// GOAL: strengths by direction and rate are refused where they have no meaning, and go on where a run was stopped, to the bit.
#[test]
fn anisotropic_footing_resumes_and_refuses() {
    // Strength that grows with depth, with softening and anisotropy at once.
    let overrides = [
        "grid.cell=2/5 m",
        "stages.0.steps=8",
        "materials.clay.cu={ at_top = \"40 kPa\", gradient = \"5 kPa/m\" }",
        "materials.clay.softening={ cu = { residual = 0.5, strain = 0.5 } }",
        "output.figures=[]",
    ];
    let case = file("anisotropic_footing", &overrides);
    let (whole, stopped) = (folder("anisotropic-whole"), folder("anisotropic-stopped"));
    let run = run_into((&case, case.case()), &whole, Start::Afresh, None);
    assert_done(&run.summary);
    run_into((&case, case.case()), &stopped, Start::Afresh, Some(3));
    run_into((&case, case.case()), &stopped, Start::Resume, None);
    assert_equal(
        &everything(&whole),
        &everything(&stopped),
        "after it was taken up",
    );
    let angles = |particle: &[f64; 4]| (0.0..=std::f64::consts::FRAC_PI_2).contains(&particle[1]);
    assert!(run.body.particles.internal.iter().all(angles));
    let case = file("anisotropic_footing", &[]);
    let material = &case.case().materials[0];
    assert_eq!(material.law().unwrap().name(), "anisotropic Tresca");
    assert_eq!(
        material.law().unwrap().internal_variables()[0].name,
        "angle of compression"
    );
    let refused = |set: &str| {
        let text = find("anisotropic_footing").unwrap().text;
        CaseFile::parse("footing", text, &[set.to_owned()])
            .unwrap_err()
            .to_string()
    };
    let no_time = refused("materials.clay.rate={ per_log_cycle = 0.1, reference = \"1 %/h\" }");
    assert!(no_time.contains("no stage takes time"), "{no_time}");
    let nothing = refused("materials.clay.anisotropy.passive=0.0");
    assert!(nothing.contains("passive"), "{nothing}");
    let no_rate = refused("stages.0.consolidation={ duration = \"1 h\" }");
    assert!(no_rate.contains("no material is coupled"), "{no_rate}");
}

/// GOAL: sand on a hyperbola goes on where a run was stopped, to the bit; parameters that no sand has are refused at their key.
/// ORACLE: the run that was not stopped; the key and the words.
#[test]
fn dense_sand_footing_resumes_and_refuses() {
    let overrides = ["grid.cell=2/5 m", "stages.2.steps=6", "output.figures=[]"];
    let case = file("dense_sand_footing", &overrides);
    let (whole, stopped) = (folder("sand-whole"), folder("sand-stopped"));
    let run = run_into((&case, case.case()), &whole, Start::Afresh, None);
    assert_done(&run.summary);
    run_into((&case, case.case()), &stopped, Start::Afresh, Some(17));
    run_into((&case, case.case()), &stopped, Start::Resume, None);
    let folders = [&whole, &stopped].map(|folder| everything(folder));
    assert_equal(&folders[0], &folders[1], "after it was taken up");
    let refused = [
        (
            "friction",
            "\"0.5 deg\"",
            "the friction angle must be 1 deg to 80 deg, but is ",
        ),
        (
            "dilation",
            "\"43 deg\"",
            "no larger than the friction angle",
        ),
        ("poisson", "0.5", "must be below 0.5"),
        ("power", "1.2", "`power` must be at most 1, but is 1.2"),
        (
            "failure_ratio",
            "1.0",
            "`failure_ratio` must be below 1, but is 1",
        ),
        ("ocr", "0.9", "`ocr` must be 1 or more, but is 0.9"),
        ("k0_normal", "1.0", "`k0_normal` must be below 1, but is 1"),
        ("eoed", "\"300 MPa\"", "no cap gives an oedometer modulus"),
    ];
    for (key, value, words) in refused {
        let text = find("dense_sand_footing").unwrap().text;
        let set = format!("materials.sand.{key}={value}");
        let error = CaseFile::parse("footing", text, &[set]).unwrap_err();
        let error = error.to_string();
        assert!(
            error.contains(words) && error.contains(key),
            "{key}: {error}"
        );
    }
}

#[test]
fn two_layer_footing_lies_between_its_layers() {
    let ran = ran(
        "two_layer_footing",
        &[
            "grid.cell.x=0.4 m",
            "grid.cell.y=0.5 m",
            "stages.0.steps=20",
        ],
    );
    between(ran.end_of("load-settlement"), 2.571, 5.142);
}

#[test]
fn strip_load_collapses_near_prandtl() {
    let ran = ran("strip_load", &["grid.cell=0.25 m", "stages.0.steps=30"]);
    assert_eq!(ran.outcomes(), [Stopped]);
    between(ran.end_of("load-settlement"), 4.9, 6.0);
}
