//! GOAL: whatever pattern of steps fails, a march ends, stays within load factor 0 to 1, sizes its
//! steps by the rule, and its report tells of every attempt once.
//! BODY: a standing elastic block of 3 × 3 cells, whose steps all converge; failures are made by the
//! load path.
//! ORACLE: the rule of step sizes, written out anew over the attempts that the load path saw.

use std::cell::RefCell;
use std::ops::ControlFlow;

use crate::body_support::{bits, elastic, loaded, workspace};
use igimp_assembly::{AssemblyError, Method};
use igimp_solver::{Accepted, MarchReport, MarchSettings, Outcome, march};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// An attempt that the load path saw.
#[derive(Clone, Copy, Debug)]
struct Attempt {
    from: f64,
    to: f64,
    is_accepted: bool,
}

/// Which attempts fail.
#[derive(Clone, Debug)]
enum Pattern {
    /// By their numbers, over and over.
    Listed(Vec<bool>),
    /// Those larger than a size within a stretch of the way.
    Large { size: f64, from: f64, to: f64 },
    /// Those that go beyond a load factor.
    Beyond(f64),
    /// All, from a number of attempts on.
    After(usize),
}

impl Pattern {
    fn fails(&self, number: usize, from: f64, to: f64) -> bool {
        match self {
            Self::Listed(list) => list[number % list.len()],
            Self::Large {
                size,
                from: begin,
                to: end,
            } => to - from > *size && to > *begin && from < *end,
            Self::Beyond(limit) => to > *limit,
            Self::After(count) => number >= *count,
        }
    }
}

fn pattern() -> impl Strategy<Value = Pattern> {
    prop_oneof![
        4 => prop::collection::vec(prop::bool::weighted(0.4), 1..24).prop_map(Pattern::Listed),
        2 => (0.005..0.5, 0.0..1.0, 0.0..1.0)
            .prop_map(|(size, from, to)| Pattern::Large { size, from, to }),
        1 => (-0.1..1.1).prop_map(Pattern::Beyond),
        1 => (0_usize..12).prop_map(Pattern::After),
    ]
}

fn settings() -> impl Strategy<Value = MarchSettings> {
    let cut_factor = prop_oneof![3 => Just(0.5), 1 => 0.1..0.9];
    let growth = prop_oneof![3 => Just(1.5), 1 => 1.0..4.0];
    (1_usize..12, 0_u32..7, cut_factor, growth).prop_map(|(steps, cuts, cut_factor, growth)| {
        MarchSettings {
            cuts,
            cut_factor,
            growth,
            ..MarchSettings::steps(steps)
        }
    })
}

/// A march, its attempts, and the bits of the body at the start, after each accepted step and at
/// the end.
struct Run {
    report: MarchReport,
    attempts: Vec<Attempt>,
    states: Vec<String>,
    end: String,
}

fn run(pattern: &Pattern, settings: &MarchSettings) -> Run {
    let (mut body, full) = loaded(&elastic(), 0.05);
    let attempts = RefCell::new(Vec::<Attempt>::new());
    let load_path = |from: f64, to: f64| {
        let mut attempts = attempts.borrow_mut();
        let is_accepted = !pattern.fails(attempts.len(), from, to);
        attempts.push(Attempt {
            from,
            to,
            is_accepted,
        });
        // Far beyond what the rule allows: a march that does not end shows itself.
        assert!(attempts.len() < 10_000, "the march goes on and on");
        if is_accepted {
            let mut conditions = full.clone();
            conditions.loads.gravity[1] *= to;
            Ok(conditions)
        } else {
            Err(AssemblyError::NoUnknowns)
        }
    };
    let mut states = vec![bits(&body)];
    let report = march(
        &mut body,
        &Method::default(),
        &load_path,
        settings,
        &mut workspace(),
        &mut |accepted: &Accepted<'_, 2>| {
            states.push(bits(accepted.body));
            ControlFlow::Continue(())
        },
    );
    Run {
        report,
        attempts: attempts.into_inner(),
        states,
        end: bits(&body),
    }
}

/// Attempts follow one another by the rule, from 0 and never beyond 1.
fn obeys_the_rule(attempts: &[Attempt], settings: &MarchSettings) -> Result<(), TestCaseError> {
    let nominal = 1.0 / settings.steps as f64;
    let (mut at, mut size, mut successes, mut cuts) = (0.0_f64, nominal, 0, 0);
    for attempt in attempts {
        prop_assert_eq!(attempt.from.to_bits(), at.to_bits());
        prop_assert!(attempt.to > attempt.from && attempt.to <= 1.0);
        let expected = size.min(1.0 - at);
        // Ends are rounded to multiples of the nominal size.
        let miss = (attempt.to - attempt.from - expected).abs();
        prop_assert!(miss <= 2e-6 * nominal, "{attempt:?} instead of {expected}");
        if attempt.is_accepted {
            at = attempt.to;
            successes += 1;
            cuts = 0;
            if successes == 2 && size < nominal {
                size = f64::min(size * settings.growth, nominal);
                successes = 0;
            } else if successes == 2 {
                successes = 1;
            }
        } else {
            size = settings.cut_factor * size.min(1.0 - at);
            successes = 0;
            cuts += 1;
        }
    }
    prop_assert!(cuts <= settings.cuts + 1);
    Ok(())
}

/// The report tells of every attempt, in order, and of the end as it was.
fn reports_add_up(run: &Run, settings: &MarchSettings) -> Result<(), TestCaseError> {
    let Run {
        report, attempts, ..
    } = run;
    let part = |is_accepted: bool| -> Vec<(u64, u64)> {
        let kept = attempts.iter().filter(|a| a.is_accepted == is_accepted);
        kept.map(|a| (a.from.to_bits(), a.to.to_bits())).collect()
    };
    let steps: Vec<_> = report
        .steps
        .iter()
        .map(|s| (s.from.to_bits(), s.to.to_bits()))
        .collect();
    let failures = report
        .failures
        .iter()
        .map(|e| (e.from.to_bits(), e.to.to_bits()));
    prop_assert_eq!(&steps, &part(true));
    prop_assert_eq!(failures.collect::<Vec<_>>(), part(false));
    // Accepted steps join without a gap, from 0 to what was reached.
    let mut at = 0.0_f64;
    for step in &report.steps {
        prop_assert_eq!(step.from.to_bits(), at.to_bits());
        at = step.to;
    }
    prop_assert_eq!(report.reached().to_bits(), at.to_bits());
    let iterations: usize = report.steps.iter().map(|step| step.iterations).sum();
    prop_assert_eq!(report.iterations(), iterations);
    match &report.outcome {
        Outcome::Completed => prop_assert_eq!(at.to_bits(), 1.0_f64.to_bits()),
        Outcome::StepTooSmall {
            last_converged,
            cause,
        } => {
            prop_assert_eq!(last_converged.to_bits(), at.to_bits());
            prop_assert_eq!(Some(cause), report.failures.last());
            prop_assert!(!attempts[attempts.len() - 1].is_accepted);
            // Given up after that many failures in a row, or because the step became too small.
            let in_a_row = attempts.iter().rev().take_while(|a| !a.is_accepted).count();
            let nominal = 1.0 / settings.steps as f64;
            let smallest = nominal * settings.cut_factor.powf(f64::from(settings.cuts) + 0.5);
            let next = settings.cut_factor * (cause.to - cause.from);
            let is_too_small = next < smallest * (1.0 + 1e-6);
            prop_assert!(in_a_row == settings.cuts as usize + 1 || is_too_small);
        }
        Outcome::Stopped { .. } => prop_assert!(false, "nobody stopped it"),
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 150,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(20_261_121),
        ..ProptestConfig::default()
    })]

    #[test]
    fn marches_end_and_obey_the_rule(pattern in pattern(), settings in settings()) {
        let run = run(&pattern, &settings);
        obeys_the_rule(&run.attempts, &settings)?;
        reports_add_up(&run, &settings)?;
        // A failed attempt leaves no trace: the body is that of the last accepted step.
        prop_assert_eq!(run.states.len(), run.report.steps.len() + 1);
        prop_assert_eq!(run.states.last(), Some(&run.end));
    }
}
