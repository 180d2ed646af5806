//! A study whose tasks take seconds, and questions to it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::run_support::{Folder, differing};

const CASE: &str = r#"
igimp = 1
[case]
title = "block"
gravity = "9.81 m/s2"
[grid]
cell = "0.125 m"
domain = { x = ["0 m", "2 m"], y = ["0 m", "4 m"] }
[materials.clay]
model = "elastic"
unit_weight = "18 kN/m3"
young = "10 MPa"
poisson = 0.2
[[bodies]]
name = "block"
material = "clay"
points_per_cell = 4
polygon = [["0 m", "0 m"], ["1.5 m", "0 m"], ["1.5 m", "2 m"], ["0 m", "2 m"]]
[boundaries]
bottom = "fixed"
[[stages]]
name = "own weight"
type = "gravity"
steps = 3
[[stages]]
name = "push"
type = "gravity"
horizontal = 0.1
steps = 100
[[monitors]]
name = "top"
point = ["1 m", "2 m"]
record = ["displacement"]
[output]
folder = "results"
figures = []
report = false
checkpoint = { every = 50 }
"#;

/// Longest wait for anything \[s\].
const LONGEST: u64 = 600;

/// A folder with a case and a sweep of four tasks in it.
pub(crate) struct Study {
    pub(crate) folder: Folder,
}

impl Study {
    /// The numbers of steps say how long the tasks take.
    pub(crate) fn new(name: &str, steps: [usize; 4]) -> Self {
        let folder = Folder::new(name);
        fs::write(folder.0.join("case.toml"), CASE).unwrap();
        let sweep = format!(
            "igimp_sweep = 1\ncase = \"case.toml\"\ncombine = \"zip\"\n[parameters]\n\
             materials.clay.young = [\"10 MPa\", \"11 MPa\", \"12 MPa\", \"13 MPa\"]\n\
             stages.push.steps = {steps:?}\n[output]\nfolder = \"out\"\n"
        );
        fs::write(folder.0.join("study.toml"), sweep).unwrap();
        Self { folder }
    }

    /// The same study, run in one go.
    pub(crate) fn left_alone(name: &str, steps: [usize; 4]) -> Self {
        let study = Self::new(name, steps);
        let output = study.igimp(&["sweep", "study.toml", "--jobs", "2"]);
        assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
        study
    }

    pub(crate) fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_igimp"));
        command.args(words).current_dir(&self.folder.0);
        command.stdin(Stdio::null());
        command
    }

    pub(crate) fn igimp(&self, words: &[&str]) -> Output {
        self.command(words).output().unwrap()
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.0.join(name)
    }

    /// Waits until a task has saved its push at least once.
    pub(crate) fn wait_for_push(&self, task: usize) {
        let saved = self.path(&format!("out/task-{task:04}/checkpoint"));
        wait(&format!("a checkpoint of task {task}"), || {
            let entries = fs::read_dir(&saved).into_iter().flatten().flatten();
            entries
                .filter_map(|entry| entry.file_name().into_string().ok())
                .any(|name| name.starts_with("step-"))
        });
    }

    /// When a task computed its first stage.
    pub(crate) fn first_stage_of(&self, task: usize) -> std::time::SystemTime {
        let end = format!("out/task-{task:04}/checkpoint/stage-01-end");
        fs::metadata(self.path(&end)).unwrap().modified().unwrap()
    }

    /// Nothing is lost: every file of every task is that of a study left alone, and so is the table.
    pub(crate) fn is_as(&self, other: &Self) {
        let output = self.igimp(&["collect", "study.toml"]);
        assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
        for task in 1..=4 {
            let [found, others] = [self, other].map(|study| study.results(task));
            assert!(found.contains_key(Path::new("convergence.csv")));
            let differ = differing(&found, &others);
            assert_eq!(differ, Vec::<PathBuf>::new(), "task {task}");
        }
        let [table, expected] =
            [self, other].map(|study| fs::read(study.path("out/results.csv")).unwrap());
        assert_eq!(table, expected);
    }

    fn results(&self, task: usize) -> BTreeMap<PathBuf, Vec<u8>> {
        self.folder.everything(&format!("out/task-{task:04}"))
    }
}

/// Waits for something that comes within minutes.
pub(crate) fn wait(event: &str, mut come: impl FnMut() -> bool) {
    let clock = Instant::now();
    while !come() {
        assert!(clock.elapsed() < Duration::from_secs(LONGEST), "no {event}");
        std::thread::sleep(Duration::from_millis(50));
    }
}

pub(crate) fn printed(output: &Output) -> String {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    text(&output.stdout) + &text(&output.stderr)
}

/// Whether a program is there to be run.
pub(crate) fn is_there(program: &str) -> bool {
    Command::new(program)
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok()
}
