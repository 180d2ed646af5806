//! GOAL: a march takes a body from load factor 0 to 1 in steps that are cut and grow as stated, or
//! stops at its last equilibrium and says why.
//! BODY: small blocks of 2 × 2 particles per unit cell, standing or confined.
//! ORACLE: the rule of step sizes, the same march on other numbers of threads, and the independence
//! of the path in elasticity.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::ops::ControlFlow;
use std::sync::Arc;

use crate::body_support::{
    Poisoned, STRENGTH, bits, block, conditions, confined, elastic, laws, loaded, methods, pressed,
    shifted_block, standing, unit_grid, von_mises, workspace,
};
use igimp_assembly::{AssemblyError, Constraints, Kinematics, Method, SharedLaw, StepConditions};
use igimp_material::MaterialError;
use igimp_solver::{
    Accepted, Body, MarchReport, MarchSettings, MarchState, Observed, Outcome, StepFailure, march,
    march_from,
};

/// A standing block and the load path that raises its weight to `gravity`.
fn standing_block(
    law: &SharedLaw,
    gravity: f64,
) -> (
    Body<2>,
    impl Fn(f64, f64) -> Result<StepConditions<2>, AssemblyError> + use<>,
) {
    let (body, full) = loaded(law, gravity);
    let load_path = move |_: f64, to: f64| {
        let mut conditions = full.clone();
        conditions.loads.gravity[1] *= to;
        Ok(conditions)
    };
    (body, load_path)
}

/// Marches to the end, or to where it stops.
fn run(
    body: &mut Body<2>,
    load_path: &impl Fn(f64, f64) -> Result<StepConditions<2>, AssemblyError>,
    settings: &MarchSettings,
) -> MarchReport {
    march(
        body,
        &Method::default(),
        load_path,
        settings,
        &mut workspace(),
        &mut |_: &Accepted<'_, 2>| ControlFlow::Continue(()),
    )
}

/// Whether two load factors are equal but for round-off.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-12
}

/// Steps that are never cut end on multiples of the nominal size, to the last bit, and on 1.
#[test]
fn uncut_steps_end_on_multiples_of_the_nominal_size() {
    for steps in [1, 3, 7, 10, 49] {
        let (mut body, load_path) = standing_block(&elastic(), 0.1);
        let mut seen = Vec::new();
        let report = march(
            &mut body,
            &Method::default(),
            &load_path,
            &MarchSettings::steps(steps),
            &mut workspace(),
            &mut |accepted: &Accepted<'_, 2>| {
                seen.push(accepted.report.to);
                ControlFlow::Continue(())
            },
        );
        assert_eq!(report.outcome, Outcome::Completed);
        assert!(report.failures.is_empty());
        assert_eq!(report.steps.len(), steps);
        let nominal = 1.0 / steps as f64;
        let mut from = 0.0_f64;
        for (k, step) in report.steps.iter().enumerate() {
            let to = if k + 1 == steps {
                1.0
            } else {
                (k + 1) as f64 * nominal
            };
            assert_eq!(step.from.to_bits(), from.to_bits());
            assert_eq!(step.to.to_bits(), to.to_bits());
            from = to;
        }
        assert_eq!(
            seen,
            report.steps.iter().map(|step| step.to).collect::<Vec<_>>()
        );
        assert!(same(report.reached(), 1.0));
        let iterations: usize = report.steps.iter().map(|step| step.iterations).sum();
        assert_eq!(report.iterations(), iterations);
    }
}

/// Every attempt of a march whose load path refuses steps that `fails` says: from, to, accepted.
fn attempts(steps: usize, cuts: u32, fails: impl Fn(f64, f64) -> bool) -> Vec<(f64, f64, bool)> {
    let (mut body, load_path) = standing_block(&elastic(), 0.1);
    let tried = RefCell::new(Vec::new());
    let refusing = |from: f64, to: f64| {
        let refused = fails(from, to);
        tried.borrow_mut().push((from, to, !refused));
        if refused {
            Err(AssemblyError::NoUnknowns)
        } else {
            load_path(from, to)
        }
    };
    let settings = MarchSettings {
        cuts,
        ..MarchSettings::steps(steps)
    };
    let report = run(&mut body, &refusing, &settings);
    let tried = tried.into_inner();
    let refused = tried.iter().filter(|attempt| !attempt.2).count();
    assert_eq!(report.failures.len(), refused);
    assert_eq!(report.steps.len(), tried.len() - refused);
    for (step, attempt) in std::iter::zip(&report.steps, tried.iter().filter(|a| a.2)) {
        assert_eq!((step.from, step.to), (attempt.0, attempt.1));
    }
    for (error, attempt) in std::iter::zip(&report.failures, tried.iter().filter(|a| !a.2)) {
        assert_eq!((error.from, error.to), (attempt.0, attempt.1));
        assert_eq!(
            *error.failure,
            StepFailure::Assembly(AssemblyError::NoUnknowns)
        );
    }
    tried
}

/// Checks attempts against the rule: after a failure half of what was tried, from the same load
/// factor; after two successes in a row half as much again, up to the nominal size and up to 1.
fn follow_the_rule(tried: &[(f64, f64, bool)], nominal: f64) {
    let mut size = nominal;
    let mut successes = 0;
    for pair in tried.windows(2) {
        let ((from, to, accepted), (next_from, next_to, _)) = (pair[0], pair[1]);
        if accepted {
            successes += 1;
            if successes == 2 {
                size = f64::min(1.5 * size, nominal);
                successes = 0;
            }
            assert_eq!(next_from.to_bits(), to.to_bits());
        } else {
            size = 0.5 * (to - from);
            successes = 0;
            assert_eq!(next_from.to_bits(), from.to_bits());
        }
        let expected = f64::min(size, 1.0 - next_from);
        assert!(same(next_to - next_from, expected), "{tried:?}");
    }
    let different: BTreeSet<_> = tried
        .iter()
        .map(|a| (a.0.to_bits(), a.1.to_bits()))
        .collect();
    assert_eq!(
        different.len(),
        tried.len(),
        "no attempt is made twice: {tried:?}"
    );
}

/// Steps above a size fail: they are halved, grow by half after two successes, and fail again.
#[test]
fn failed_steps_are_halved_and_grow_again() {
    for (steps, largest) in [(1, 0.3), (4, 0.1), (4, 0.2), (5, 0.11), (10, 0.05)] {
        let tried = attempts(steps, 5, |from, to| to - from > largest);
        follow_the_rule(&tried, 1.0 / steps as f64);
        assert!(same(tried[tried.len() - 1].1, 1.0));
    }
    let tried = attempts(4, 5, |from, to| to - from > 0.1);
    let begin = [
        (0.0, 0.25, false),
        (0.0, 0.125, false),
        (0.0, 0.0625, true),
        (0.0625, 0.125, true),
        (0.125, 0.21875, true),
        (0.21875, 0.3125, true),
        (0.3125, 0.453_125, false),
        (0.3125, 0.382_812_5, true),
    ];
    assert_eq!(tried[..begin.len()], begin);
}

/// However often a step may be cut, the march ends, and no attempt is made twice or has no size.
#[test]
fn a_march_with_many_cuts_ends() {
    for cuts in [19, 21, 25, 40, 60, 2000] {
        for limit in [0.5, 0.75, 0.8, 1.0 - 1e-7, 1.0 - 1e-12] {
            let count = RefCell::new(0);
            let tried = attempts(4, cuts, |_, to| {
                *count.borrow_mut() += 1;
                assert!(*count.borrow() < 2_000, "the march goes on and on");
                to > limit
            });
            let mut different = BTreeSet::new();
            for &(from, to, _) in &tried {
                assert!(from < to && to <= 1.0, "{cuts} {limit}: {from} {to}");
                assert!(different.insert((from.to_bits(), to.to_bits())));
            }
        }
    }
}

/// A failure in the middle of the march alone: afterwards steps grow back to the nominal size.
#[test]
fn steps_grow_back_to_the_nominal_size() {
    let tried = attempts(10, 5, |from, to| from < 0.2 && to > 0.2 && to - from > 0.02);
    follow_the_rule(&tried, 0.1);
    assert!(
        tried
            .windows(2)
            .any(|pair| same(pair[1].1 - pair[1].0, 0.1) && pair[0].0 > 0.2)
    );
}

/// A last step that is shortened to end on 1 is cut from its own length.
#[test]
fn a_shortened_last_step_is_halved_too() {
    let tried = attempts(4, 5, |from, to| {
        to - from > 0.2 && from < 0.1 || to > 0.97 && to - from > 0.03
    });
    follow_the_rule(&tried, 0.25);
    assert!(same(tried[tried.len() - 1].1, 1.0));
}

/// With `cuts` cuts a step is tried at `cuts + 1` sizes. Then the march stops where it is, and
/// keeps every failure and the smallest one as the cause.
#[test]
fn a_step_that_is_cut_too_often_stops_the_march() {
    for cuts in [0, 1, 3] {
        let (mut body, load_path) = standing_block(&elastic(), 0.1);
        let limit = 0.4;
        let refusing = |from: f64, to: f64| {
            if to > limit {
                Err(AssemblyError::NoUnknowns)
            } else {
                load_path(from, to)
            }
        };
        let settings = MarchSettings {
            cuts,
            ..MarchSettings::steps(3)
        };
        let mut last = bits(&body);
        let report = march(
            &mut body,
            &Method::default(),
            &refusing,
            &settings,
            &mut workspace(),
            &mut |accepted: &Accepted<'_, 2>| {
                last = bits(accepted.body);
                ControlFlow::Continue(())
            },
        );
        let Outcome::StepTooSmall {
            last_converged,
            cause,
        } = &report.outcome
        else {
            panic!("{:?}", report.outcome);
        };
        assert_eq!(last_converged.to_bits(), report.reached().to_bits());
        assert_eq!(Some(cause), report.failures.last());
        assert_eq!(
            *cause.failure,
            StepFailure::Assembly(AssemblyError::NoUnknowns)
        );
        assert!(cause.to - cause.from <= 1.001 / 3.0 * 0.5_f64.powi(cuts as i32));
        assert!(limit - last_converged < 1.0 / 3.0 * 0.5_f64.powi(cuts as i32));
        assert_eq!(bits(&body), last);
        // From 1/3 on nothing larger than 0.0667 works: 1/6 and 1/12 fail, 1/24 does not.
        if cuts == 1 {
            assert!(same(*last_converged, 1.0 / 3.0));
            assert_eq!(report.failures.len(), 2);
        }
    }
}

/// A law that fails beyond a strain stops the march below it, with the law's own error as cause.
#[test]
fn the_cause_of_a_law_that_fails_is_kept() {
    let law: SharedLaw = Arc::new(Poisoned {
        above: 0.02,
        tangent_alone: false,
    });
    let (mut body, load_path) = standing_block(&law, 2.0);
    let report = run(&mut body, &load_path, &MarchSettings::steps(4));
    let Outcome::StepTooSmall {
        last_converged,
        cause,
    } = &report.outcome
    else {
        panic!("{:?}", report.outcome);
    };
    assert!(
        *last_converged > 0.1 && *last_converged < 0.9,
        "{last_converged}"
    );
    assert!(matches!(
        *cause.failure,
        StepFailure::Assembly(AssemblyError::Material {
            source: MaterialError::NonFinite { quantity: "stress" },
            ..
        })
    ));
    assert!(report.failures.len() > 5);
    assert!(
        body.particles
            .sigma
            .iter()
            .flatten()
            .flatten()
            .all(|sigma| sigma.is_finite())
    );
}

/// A particle that leaves the grid ends the march at once: a smaller step would follow it out.
#[test]
fn leaving_the_grid_is_not_tried_again() {
    let grid = unit_grid([6, 6]);
    let mut body = block(&grid, [1, 1], [4, 4]);
    let load_path = |from: f64, to: f64| {
        let mut constraints = Constraints::free(&grid);
        for node in 0..grid.node_count() {
            if grid.node_place(node)[1] as f64 <= 1.0 + 4.0 * from {
                constraints.prescribe(node, 0, 0.0)?;
                constraints.prescribe(node, 1, 4.0 * (to - from))?;
            }
        }
        Ok(conditions(&grid, &constraints, &elastic(), 0.0))
    };
    let report = run(&mut body, &load_path, &MarchSettings::steps(4));
    assert!(
        matches!(&report.outcome, Outcome::StepTooSmall { last_converged, cause }
            if same(*last_converged, 0.5)
                && matches!(*cause.failure, StepFailure::LeavesGrid { .. })),
        "{:?}",
        report.outcome
    );
    assert_eq!(report.failures.len(), 1);
}

/// An observer that breaks ends the march after that step; the step stays accepted.
#[test]
fn an_observer_ends_the_march() {
    let (mut body, load_path) = standing_block(&elastic(), 0.1);
    let mut last = String::new();
    let report = march(
        &mut body,
        &Method::default(),
        &load_path,
        &MarchSettings::steps(10),
        &mut workspace(),
        &mut |accepted: &Accepted<'_, 2>| {
            last = bits(accepted.body);
            let nodes = accepted.conditions.grid.node_count();
            assert_eq!(accepted.forces.u.len(), nodes);
            assert_eq!(accepted.forces.reactions.len(), nodes);
            if accepted.report.to > 0.25 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        },
    );
    let at = 3.0 * 0.1;
    assert_eq!(report.outcome, Outcome::Stopped { at });
    assert_eq!(report.steps.len(), 3);
    assert_eq!(report.reached().to_bits(), f64::to_bits(at));
    assert_eq!(bits(&body), last);
}

/// A standing von Mises block under growing weight collapses: the march stops between the load
/// that cannot be carried and the last equilibrium, where the body is left.
///
/// It cannot stop before γH = 2 c_u, which σ_yy = −γ (H − y), σ_xx = 0 carries everywhere within
/// the strength; it stops later, as a block that slumps grows wider and lower.
#[test]
fn a_block_under_growing_weight_collapses() {
    let (mut body, load_path) = standing_block(&von_mises(), 3.0);
    let mut last = String::new();
    let report = march(
        &mut body,
        &Method::default(),
        &load_path,
        &MarchSettings::steps(10),
        &mut workspace(),
        &mut |accepted: &Accepted<'_, 2>| {
            last = bits(accepted.body);
            ControlFlow::Continue(())
        },
    );
    let Outcome::StepTooSmall {
        last_converged,
        cause,
    } = &report.outcome
    else {
        panic!("{:?}", report.outcome);
    };
    let height = 3.0;
    let weight = 3.0 * last_converged * height;
    assert!(weight > 2.0 * STRENGTH, "{weight}");
    assert_eq!(cause.from.to_bits(), last_converged.to_bits());
    assert!(cause.to - cause.from < 1.1 * 0.1 / 32.0, "{cause:?}");
    assert!(report.failures.len() > 5);
    assert_eq!(bits(&body), last);
    let plastic = report.steps[report.steps.len() - 1].plastic_share;
    assert!(plastic > 0.4, "{plastic}");
}

/// A march is the same to the last bit on 1, 2 and 7 threads.
#[test]
fn bits_do_not_depend_on_the_number_of_threads() {
    let grid = unit_grid([15, 12]);
    let constraints = standing(&grid);
    for (name, law) in laws() {
        let result = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| {
                let mut body = shifted_block(&grid, [0, 0], [12, 10], [0.15, 0.1]);
                let load_path =
                    |_: f64, to: f64| Ok(conditions(&grid, &constraints, &law, 0.3 * to));
                let mut forces = String::new();
                let report = march(
                    &mut body,
                    &Method::default(),
                    &load_path,
                    &MarchSettings::steps(3),
                    &mut workspace(),
                    &mut |accepted: &Accepted<'_, 2>| {
                        write!(forces, "{:?}", accepted.forces).unwrap();
                        ControlFlow::Continue(())
                    },
                );
                assert_eq!(report.outcome, Outcome::Completed, "{name}");
                let residuals: Vec<_> = report
                    .steps
                    .into_iter()
                    .map(|step| step.residuals)
                    .collect();
                (bits(&body), forces, residuals)
            })
        };
        let one = result(1);
        assert_eq!(one, result(2), "{name}");
        assert_eq!(one, result(7), "{name}");
    }
}

/// The vertical stress in a confined elastic block pressed to 60 % of its height in equal steps,
/// the grid following its upper side, and the stress that total strain asks for.
fn pressed_in(steps: usize, method: &Method) -> f64 {
    let height = |factor: f64| 4.0 * (1.0 - 0.4 * factor);
    let load_path =
        |from: f64, to: f64| Ok(pressed(&elastic(), height(from), height(from) - height(to)));
    let (mut body, _) = confined(&elastic(), 0.0);
    let report = march(
        &mut body,
        method,
        &load_path,
        &MarchSettings::steps(steps),
        &mut workspace(),
        &mut |_: &Accepted<'_, 2>| ControlFlow::Continue(()),
    );
    assert_eq!(report.outcome, Outcome::Completed);
    assert_eq!(report.steps.len(), steps);
    let sigma: Vec<f64> = body
        .particles
        .sigma
        .iter()
        .map(|sigma| sigma[1][1])
        .collect();
    for other in &sigma {
        assert!((other - sigma[0]).abs() < 1e-11, "the block stays uniform");
    }
    sigma[0]
}

/// In finite strain the stress of an elastic body depends on where it is, not on the steps that
/// led there: 1, 4 and 16 steps agree with M ln(0.6) / 0.6 to round-off. Small strain adds up
/// what each step makes of it, and does not.
#[test]
fn finite_strain_does_not_depend_on_the_path() {
    let elasticity = crate::body_support::elasticity();
    let modulus = elasticity.bulk() + 4.0 / 3.0 * elasticity.shear();
    for (label, method) in methods() {
        for steps in [1, 4, 16] {
            let sigma = pressed_in(steps, &method);
            let sum = |k: usize| {
                let height = |k: usize| 1.0 - 0.4 * k as f64 / steps as f64;
                height(k + 1) / height(k) - 1.0
            };
            let expected = match method.kinematics {
                Kinematics::FiniteStrain => modulus * 0.6_f64.ln() / 0.6,
                Kinematics::SmallStrain => modulus * (0..steps).map(sum).sum::<f64>(),
            };
            let difference = (sigma - expected).abs();
            assert!(
                difference < 1e-11 * modulus,
                "{label}, {steps}: {difference:e}"
            );
        }
    }
}

/// A march that was left after any step and taken up again ends with the same bits.
#[test]
fn a_march_taken_up_again_is_the_same_march() {
    let law = von_mises();
    let settings = MarchSettings::steps(6);
    let (start, load_path) = standing_block(&law, 1.2 * STRENGTH);
    let mut left: Vec<(MarchState, Body<2>)> = Vec::new();
    let mut whole = start.clone();
    let report = march(
        &mut whole,
        &Method::default(),
        &load_path,
        &settings,
        &mut workspace(),
        &mut |accepted: &Accepted<'_, 2>| {
            left.push((*accepted.state, accepted.body.clone()));
            ControlFlow::Continue(())
        },
    );
    assert!(left.len() > 2);
    for (taken, (state, body)) in left.iter().enumerate() {
        let mut body = body.clone();
        let rest = march_from(
            *state,
            &mut body,
            &Method::default(),
            &settings,
            &mut workspace(),
            &mut Observed {
                load_path: &load_path,
                observer: &mut |_: &Accepted<'_, 2>| ControlFlow::Continue(()),
            },
        );
        assert_eq!(rest.steps.len(), report.steps.len() - taken - 1);
        assert_eq!(rest.outcome, report.outcome);
        assert_eq!(bits(&body), bits(&whole));
    }
}
