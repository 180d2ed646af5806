//! GOAL: the readers stand every input of the corpus, and some thousands of damaged ones.
//! ORACLE: what the targets state of every input; a panic, a hang and memory without bounds fail.

use std::path::Path;

use igimp_fuzz::input::Input;
use igimp_fuzz::run::{Plan, run};
use igimp_fuzz::targets::Target;

/// The corpus, and damaged entries up to so many executions.
fn stands(target: Target, executions: u64) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let material = target.material(&root.join("corpus")).unwrap();
    assert!(material.corpus.len() as u64 * 2 < executions);
    let plan = Plan {
        target,
        seed: 20_261_121,
        first: 0,
        executions,
        threads: 2,
    };
    let report = run(&plan, &material, &root.join("found"));
    assert!(report.findings.is_empty(), "{:#?}", report.findings);
    assert_eq!(report.executions, executions);
    // Both must happen, or the damage is of no use.
    assert!(report.accepted > executions / 200, "{report:?}");
    assert!(
        report.accepted < executions - executions / 200,
        "{report:?}"
    );
}

#[test]
fn case_files() {
    stands(Target::Case, 2_000);
}

#[test]
fn checkpoints() {
    stands(Target::Checkpoint, 5_000);
}

#[test]
fn quantities() {
    stands(Target::Quantity, 50_000);
}

#[test]
fn inputs_follow_from_seed_and_number() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    for target in Target::ALL {
        let material = target.material(&corpus).unwrap();
        let inputs = |seed| -> Vec<Input> {
            (500..600)
                .map(|execution| target.input(&material, seed, execution))
                .collect()
        };
        assert_eq!(inputs(1), inputs(1));
        assert_ne!(inputs(1), inputs(2));
    }
}
