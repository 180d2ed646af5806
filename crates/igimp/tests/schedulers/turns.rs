//! A task that is begun by several, and tables of tasks that run.

use std::process::{Child, Stdio};

use crate::study::{Study, printed, wait};

/// The same task, begun by two schedulers.
const TASK: [&str; 8] = [
    "run",
    "study.toml",
    "--task",
    "2",
    "--resume",
    "--threads",
    "1",
    "--quiet",
];

fn begun(study: &Study) -> Child {
    let mut command = study.command(&TASK);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().unwrap()
}

/// One waits while the other runs; when that is killed, it goes on where the other was. A third finds all done.
#[test]
fn a_task_that_is_begun_twice_is_computed_once() {
    let steps = [40, 1500, 40, 40];
    let reference = Study::left_alone("turns-alone", steps);
    let study = Study::new("turns", steps);
    let mut first = begun(&study);
    study.wait_for_push(2);
    let second = begun(&study);
    std::thread::sleep(std::time::Duration::from_millis(300));
    let started = study.first_stage_of(2);
    first.kill().unwrap();
    first.wait().unwrap();
    let output = second.wait_with_output().unwrap();
    let text = printed(&output);
    assert_eq!(output.status.code(), Some(0), "{text}");
    let waits = "another igimp writes into out/task-0002; waiting until it has ended";
    assert!(text.contains(waits), "{text}");
    assert_eq!(study.first_stage_of(2), started, "it was computed again");
    let output = study.igimp(&TASK);
    assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
    assert!(printed(&output).contains("task 2 is done already: done"));
    // All that is left, at once: whose the folder is was never said before.
    let others: Vec<Child> = ["1", "3", "4", "1", "3", "4"]
        .map(|task| {
            let words = ["run", "study.toml", "--task", task, "--resume", "--quiet"];
            let mut command = study.command(&words);
            command.stdout(Stdio::piped()).stderr(Stdio::piped());
            command.spawn().unwrap()
        })
        .into();
    for child in others {
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
    }
    study.is_as(&reference);
}

/// A run that waits for another can be stopped, and so can the other: both end in good order.
#[test]
fn a_waiting_run_can_be_stopped() {
    let study = Study::new("turns-stopped", [40, 200_000, 40, 40]);
    let mut first = begun(&study);
    study.wait_for_push(2);
    let second = begun(&study);
    std::thread::sleep(std::time::Duration::from_secs(1));
    for (child, word) in [
        (&second, "interrupted while another igimp ran task 2"),
        (&first, ""),
    ] {
        let asked = std::process::Command::new("kill")
            .args(["-TERM", &child.id().to_string()])
            .status();
        assert!(asked.unwrap().success(), "{word}");
        if !word.is_empty() {
            std::thread::sleep(std::time::Duration::from_millis(800));
        }
    }
    let output = second.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(3), "{}", printed(&output));
    assert!(printed(&output).contains("interrupted while another igimp ran task 2"));
    assert_eq!(first.wait().unwrap().code(), Some(3));
}

/// A table can be made at any time, and says which tasks run; none is disturbed.
#[test]
fn a_table_is_made_while_tasks_run() {
    let study = Study::new("turns-table", [40, 2000, 40, 40]);
    let mut child = begun(&study);
    study.wait_for_push(2);
    let mut ended = None;
    let mut tables = 0;
    wait("end of the task", || {
        let output = study.igimp(&["collect", "study.toml"]);
        ended = child.try_wait().unwrap();
        if ended.is_none() {
            assert_eq!(output.status.code(), Some(4), "{}", printed(&output));
            let table = std::fs::read_to_string(study.path("out/results.csv")).unwrap();
            assert!(
                table.contains("2,11,2000,running,") || table.contains("2,11,2000,done,"),
                "{table}"
            );
            assert!(table.contains("1,10,40,missing,"), "{table}");
            tables += 1;
        }
        ended.is_some()
    });
    assert!(tables > 0);
    assert_eq!(ended.unwrap().code(), Some(0));
}
