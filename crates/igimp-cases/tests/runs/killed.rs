//! GOAL: a program that is killed at any moment while it writes checkpoints leaves a whole one.
//! ORACLE: the checkpoint says how many particles it has, and every write has one more than the
//! one before.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use igimp_assembly::{ParticleSeed, Particles};
use igimp_cases::run::{Event, Start, Target, run};
use igimp_input::CaseFile;
use igimp_results::checkpoint::{self, Checkpoint, Meta};
use igimp_results::folder::write_atomically;
use igimp_results::summary::Summary;
use igimp_solver::Body;
use serde_json::json;

/// Tells the process that is to be killed where to write.
const FOLDER: &str = "IGIMP_TEST_KILLED_FOLDER";

fn body(particles: usize) -> Body<2> {
    let seed = ParticleSeed {
        x: [0.1, 0.2],
        half_length: [0.5, 0.5],
        volume: 1.0,
        density: 1.0,
        law: 0,
        centroid: [0.0; _],
    };
    Body::new(Particles::new(&vec![seed; particles]).unwrap())
}

/// Writes one checkpoint after the other, under a name that stays and one that counts; notes how
/// long the first took \[µs\].
fn write_many(folder: &Path) {
    let first = written(folder).unwrap_or(0) + 1;
    for particles in first..first + 1000 {
        let start = Instant::now();
        let meta = Meta::new("case", json!(particles));
        let body = body(particles);
        let states = [("current", &body), ("stable", &body)];
        let name = match particles % 2 {
            0 => "end".into(),
            _ => format!("load-{particles:05}"),
        };
        checkpoint::write(folder, &name, &states, &meta, 2).unwrap();
        if particles == first {
            let duration = start.elapsed().as_micros().to_string();
            write_atomically(&folder.with_extension("duration"), duration).unwrap();
        }
    }
}

/// Particles of the newest checkpoint, which must be whole and agree with itself.
fn written(folder: &Path) -> Option<usize> {
    let path = checkpoint::newest(folder).unwrap()?;
    let checkpoint: Checkpoint<2> = checkpoint::read(&path, Some("case")).unwrap();
    let particles = checkpoint.states[0].1.particles.len();
    assert_eq!(checkpoint.meta.data, json!(particles));
    assert_eq!(checkpoint.states[1].1.particles.len(), particles);
    Some(particles)
}

/// The content of a file as soon as it is there.
fn wait_for(path: &Path) -> String {
    for _ in 0..30_000 {
        if let Ok(text) = fs::read_to_string(path) {
            return text;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("no checkpoint within half a minute");
}

#[test]
fn whenever_it_is_killed_a_checkpoint_is_whole() {
    if let Some(folder) = std::env::var_os(FOLDER) {
        write_many(Path::new(&folder));
        return;
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("killed");
    let duration = folder.with_extension("duration");
    let _ = fs::remove_dir_all(&folder);
    let mut last = 0;
    for round in 0..30 {
        let _ = fs::remove_file(&duration);
        let mut child = Command::new(std::env::current_exe().unwrap())
            .arg("whenever_it_is_killed_a_checkpoint_is_whole")
            .env(FOLDER, &folder)
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        let micros: u64 = wait_for(&duration).parse().unwrap();
        std::thread::sleep(Duration::from_micros(micros * round / 12));
        child.kill().unwrap();
        child.wait().unwrap();
        let now = written(&folder).unwrap_or(0);
        assert!(now > last, "{now} after {last}");
        last = now;
    }
    println!("{last} checkpoints in 30 lives");
}

/// GOAL: a run that is killed between two stages leaves a summary that says that it can be resumed.
/// ORACLE: the summary as the second stage begins, and at the end of the run.
#[test]
fn a_summary_between_stages_is_of_a_run_that_can_be_resumed() {
    let text = igimp_input::shipped::find("slope").unwrap().text;
    let settings = ["grid.cell = 2 m".to_owned()];
    let file =
        CaseFile::parse("slope.toml", text, &settings).unwrap_or_else(|error| panic!("{error}"));
    let mut case = file.case().clone();
    case.stages.truncate(2);
    case.checks.clear();
    let root = crate::resuming::folder("killed-between");
    let is_left = || {
        let bytes = fs::read(root.join("summary.json")).unwrap();
        let summary: Summary = serde_json::from_slice(&bytes).unwrap();
        (summary.interrupted, summary.stages.len())
    };
    let mut between = None;
    let mut listener = |event: &Event<'_, 2>| {
        if matches!(event, Event::StageStarted { stage: 1, .. }) {
            between = Some(is_left());
        }
    };
    let interrupt = AtomicBool::new(false);
    let target = Target::of(&file, &root);
    run(
        &case,
        Some(&target),
        Start::Afresh,
        &mut listener,
        &interrupt,
    )
    .unwrap();
    assert_eq!(between, Some((true, 1)));
    assert_eq!(is_left(), (false, 2));
}
