//! GOAL: a run that was killed at any moment, or interrupted, goes on where it was and ends with
//! the same tables to the byte.
//! CASE: a coarse slope under gravity, its factor of safety, and its run-out.
//! ORACLE: the tables of the same run left alone.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use igimp_cases::shipped::SHIPPED;

/// Kills in a test run; `IGIMP_KILLS` asks for more.
const KILLS: usize = 6;

/// Coarse, with a checkpoint after every other step.
const SETTINGS: [&str; 5] = [
    "grid.cell=2 m",
    "stages.run-out.steps=60",
    "output.checkpoint.every=2",
    "output.figures=[]",
    "output.report=false",
];

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("igimp-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        let slope = SHIPPED.iter().find(|case| case.name == "slope").unwrap();
        std::fs::write(path.join("slope.toml"), slope.text).unwrap();
        Self(path)
    }

    fn run(&self, out: &str, more: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_igimp"));
        command.args(["run", "slope.toml", "--out", out, "--quiet"]);
        for setting in SETTINGS {
            command.args(["--set", setting]);
        }
        command.args(more).current_dir(&self.0);
        command.stdout(Stdio::null()).stderr(Stdio::piped());
        command
    }

    /// Runs to the end and returns the exit code with what was said.
    fn end(&self, out: &str, more: &[&str]) -> (Option<i32>, String) {
        let output = self.run(out, more).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code(), said)
    }

    /// Every table of a results folder, by its path there.
    fn tables(&self, out: &str) -> BTreeMap<PathBuf, Vec<u8>> {
        let root = self.0.join(out);
        let mut tables = BTreeMap::new();
        for folder in ["", "curves", "monitors", "sections"] {
            let Ok(entries) = std::fs::read_dir(root.join(folder)) else {
                continue;
            };
            for path in entries.map(|entry| entry.unwrap().path()) {
                if path.extension().is_some_and(|extension| extension == "csv") {
                    let name = path.strip_prefix(&root).unwrap().to_path_buf();
                    tables.insert(name, std::fs::read(&path).unwrap());
                }
            }
        }
        tables
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// The names of tables that differ.
fn differing(a: &BTreeMap<PathBuf, Vec<u8>>, b: &BTreeMap<PathBuf, Vec<u8>>) -> Vec<PathBuf> {
    assert!(a.keys().eq(b.keys()), "{:?} {:?}", a.keys(), b.keys());
    let differ = a.iter().filter(|(name, bytes)| b[*name] != **bytes);
    differ.map(|(name, _)| name.clone()).collect()
}

fn frames(folder: &Path) -> usize {
    let pvd = std::fs::read_to_string(folder.join("paraview/particles.pvd")).unwrap();
    pvd.matches("<DataSet").count()
}

#[test]
fn a_run_killed_at_any_moment_ends_with_the_same_tables() {
    let folder = Folder::new("killed-run");
    let clock = Instant::now();
    let (code, said) = folder.end("whole", &[]);
    let whole = clock.elapsed();
    assert_eq!(code, Some(0), "{said}");
    let expected = folder.tables("whole");
    assert!(expected.len() >= 4, "{:?}", expected.keys());
    let kills = std::env::var("IGIMP_KILLS").map_or(KILLS, |kills| kills.parse().unwrap());
    for kill in 0..kills {
        let out = format!("killed-{kill}");
        // Killed twice on its way: the second time while it goes on.
        for more in [&[][..], &["--resume"]] {
            let mut child = folder.run(&out, more).spawn().unwrap();
            let share = (0.618_034 * (kill as f64 + 1.0)).fract() * 0.5;
            std::thread::sleep(Duration::from_secs_f64(share * whole.as_secs_f64()));
            child.kill().unwrap();
            child.wait().unwrap();
        }
        let (code, said) = folder.end(&out, &["--resume"]);
        assert_eq!(code, Some(0), "kill {kill}: {said}");
        assert_eq!(
            differing(&expected, &folder.tables(&out)),
            Vec::<PathBuf>::new()
        );
        let root = |out: &str| folder.0.join(out);
        assert_eq!(frames(&root("whole")), frames(&root(&out)));
    }
}

#[test]
fn a_stage_run_again_ends_with_the_same_tables() {
    let folder = Folder::new("from-stage");
    let (code, said) = folder.end("out", &[]);
    assert_eq!(code, Some(0), "{said}");
    let expected = folder.tables("out");
    for stage in ["run-out", "factor of safety"] {
        let (code, said) = folder.end("out", &["--from-stage", stage]);
        assert_eq!(code, Some(0), "{stage}: {said}");
        assert_eq!(
            differing(&expected, &folder.tables("out")),
            Vec::<PathBuf>::new()
        );
    }
}

#[test]
fn a_checkpoint_of_another_case_is_refused() {
    let folder = Folder::new("other-case");
    let (code, said) = folder.end("out", &[]);
    assert_eq!(code, Some(0), "{said}");
    let other = ["--resume", "--set", "materials.clay.cohesion=21 kPa"];
    let (code, said) = folder.end("out", &other);
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("belongs to another case or to other input"),
        "{said}"
    );
    let other = [
        "--from-stage",
        "run-out",
        "--set",
        "materials.clay.cohesion=21 kPa",
    ];
    let (code, said) = folder.end("out", &other);
    assert_eq!(code, Some(2), "{said}");
    // What does not concern the stages before may change.
    let other = [
        "--from-stage",
        "run-out",
        "--set",
        "stages.run-out.steps=50",
    ];
    let (code, said) = folder.end("out", &other);
    assert_eq!(code, Some(0), "{said}");
}
