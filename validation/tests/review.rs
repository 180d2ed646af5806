//! GOAL: the way from a changed number to an accepted snapshot, as the page "Reviewing a change of numbers" says it:
//! a changed curve, count and residual end with exit code 1, a line each, pictures of old against new, and files
//! that each of the ways of accepting takes; the next run is clean.
//! ORACLE: the snapshots before they were changed, and cargo-insta itself. `IGIMP_CARGO_INSTA` names the folder where
//! it was installed; its test says so and is done where that is not set.
//!
//! The program runs as a user starts it, on a copy of the snapshots, with a folder for results that is not there.

use std::collections::BTreeMap;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The changed snapshots: a curve, a count, a residual, and a snapshot that is not there yet.
const CURVE: &str = "column__convergence_1MPa";
const COUNT: &str = "column__effort__igimp_16_cells_e_1_mpa";
const RESIDUALS: &str = "column__residuals__256_cells_1MPa";
const NEW: &str = "column__effort__impm_16_cells_e_1_mpa";
const ALL: [&str; 4] = [CURVE, COUNT, NEW, RESIDUALS];

/// A folder of its own for a walk, gone when dropped.
struct Walk {
    folder: PathBuf,
    snapshots: PathBuf,
}

impl Walk {
    /// Snapshots of the column in a folder of their own.
    fn new(name: &str) -> Self {
        let folder =
            Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        let snapshots = folder.join("snapshots");
        fs::create_dir_all(&snapshots).unwrap();
        let walk = Self { folder, snapshots };
        walk.take_snapshots();
        walk
    }

    /// A clone of the workspace, with the snapshots as they are in the work tree.
    fn clone_of_the_workspace(name: &str) -> Self {
        let mut walk = Self::new(name);
        let clone = walk.folder.join("clone");
        let mut git = Command::new("git");
        git.args(["clone", "--quiet"]).arg(root()).arg(&clone);
        assert!(git.status().unwrap().success());
        walk.snapshots = clone.join("validation/snapshots");
        walk.take_snapshots();
        walk
    }

    fn take_snapshots(&self) {
        for entry in fs::read_dir(root().join("validation/snapshots")).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap();
            if name
                .strip_suffix(".snap")
                .is_some_and(|name| name.starts_with("column__"))
            {
                fs::copy(&path, self.snapshots.join(name)).unwrap();
            }
        }
    }

    /// The program, whatever the surroundings say of snapshots.
    fn validate(&self, words: &[&str]) -> Output {
        let mut program = Command::new(env!("CARGO_BIN_EXE_igimp-validation"));
        program.args(words).arg("--snapshots").arg(&self.snapshots);
        program.current_dir(root());
        for name in [
            "CI",
            "TF_BUILD",
            "INSTA_UPDATE",
            "INSTA_FORCE_PASS",
            "INSTA_OUTPUT",
        ] {
            program.env_remove(name);
        }
        program.output().unwrap()
    }

    /// A run of the column.
    fn run(&self, words: &[&str]) -> Output {
        let out = self.folder.join("results/validation");
        let mut all = vec![
            "--case",
            "column",
            "--quick",
            "--out",
            out.to_str().unwrap(),
        ];
        all.extend(words);
        self.validate(&all)
    }

    /// Changes the last number of a curve, a count and the first residual, and takes a snapshot away.
    fn change(&self) {
        self.edit(CURVE, |text| with_last_word(text.trim_end(), "1.0e-1"));
        self.edit(COUNT, |text| {
            let place = text.find("iterations: ").unwrap() + "iterations: ".len();
            format!("{}1{}", &text[..place], &text[place..])
        });
        self.edit(RESIDUALS, |text| {
            let place = text.find("\nstep ").unwrap();
            let end = place + 1 + text[place + 1..].find('\n').unwrap();
            format!("{}{}", with_last_word(&text[..end], "1.0e-5"), &text[end..])
        });
        fs::remove_file(self.snap(NEW)).unwrap();
    }

    fn snap(&self, name: &str) -> PathBuf {
        self.snapshots.join(format!("{name}.snap"))
    }

    fn edit(&self, name: &str, change: impl Fn(&str) -> String) {
        let text = fs::read_to_string(self.snap(name)).unwrap();
        fs::write(self.snap(name), change(&text) + "\n").unwrap();
    }

    /// Names of the files beside the snapshots.
    fn left(&self) -> Vec<String> {
        let names = fs::read_dir(&self.snapshots).unwrap();
        let names = names.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut left: Vec<String> = names
            .filter_map(|name| name.strip_suffix(".snap.new").map(str::to_owned))
            .collect();
        left.sort();
        left
    }

    /// The words of the accepted snapshots, by name.
    fn accepted(&self) -> BTreeMap<&'static str, Vec<String>> {
        let words = |name: &str| {
            let text = fs::read_to_string(self.snap(name)).unwrap();
            text.split_whitespace().map(str::to_owned).collect()
        };
        ALL.into_iter().map(|name| (name, words(name))).collect()
    }

    /// The last run was clean: nothing printed, nothing left, no picture.
    fn is_clean(&self, run: &Output) {
        assert_eq!(run.status.code(), Some(0), "{}", printed(run));
        assert!(
            printed(run).contains("snapshots and matrix: 0 differ"),
            "{}",
            printed(run)
        );
        assert_eq!(differences(run), Vec::<String>::new());
        assert!(self.left().is_empty() && !self.pictures().exists());
    }

    fn pictures(&self) -> PathBuf {
        self.folder.join("results/validation/review")
    }
}

impl Drop for Walk {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// The root of the workspace, where `cargo xtask validate` starts the program.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// A text with another last word.
fn with_last_word(text: &str, word: &str) -> String {
    let place = text.rfind(' ').unwrap();
    format!("{} {word}", &text[..place])
}

fn printed(output: &Output) -> String {
    [&output.stdout, &output.stderr]
        .map(|text| String::from_utf8_lossy(text))
        .concat()
}

/// The lines of a run that tell a difference, without their beginning.
fn differences(output: &Output) -> Vec<String> {
    let text = String::from_utf8_lossy(&output.stdout);
    let lines = text
        .lines()
        .filter_map(|line| line.strip_prefix("differs: "));
    lines.map(str::to_owned).collect()
}

/// A run after the change: exit code, lines, pictures and files.
fn reported_and_drawn(walk: &Walk) {
    assert!(!walk.folder.join("results").exists());
    let run = walk.run(&[]);
    assert_eq!(run.status.code(), Some(1), "{}", printed(&run));
    let mut lines = differences(&run);
    lines.sort();
    assert_eq!(lines.len(), 4, "{}", printed(&run));
    for (line, name) in lines.iter().zip(ALL) {
        assert!(line.starts_with(&format!("{name}: ")), "{line}");
    }
    assert!(
        lines[0].contains("for 0.1 at cells = 256, "),
        "{}",
        lines[0]
    );
    assert!(lines[1].contains("line 3: \"iterations: "), "{}", lines[1]);
    assert!(
        lines[2].ends_with("there is no snapshot of that name"),
        "{}",
        lines[2]
    );
    assert!(
        lines[3].contains("line 1: \"step ") && lines[3].ends_with(" 1.0e-5\""),
        "{}",
        lines[3]
    );
    assert!(printed(&run).contains(&format!("old against new: {}", walk.pictures().display())));
    for name in [CURVE, RESIDUALS] {
        let svg = fs::read_to_string(walk.pictures().join(format!("{name}.svg"))).unwrap();
        for part in [">now<", ">accepted<", "stroke-dasharray"] {
            assert!(svg.contains(part), "{name}: no {part}");
        }
        assert!(walk.pictures().join(format!("{name}.png")).exists());
    }
    assert_eq!(walk.left(), ALL);
}

#[test]
fn a_changed_number_is_reported_drawn_and_accepted() {
    let walk = Walk::new("review");
    let before = walk.accepted();
    walk.is_clean(&walk.run(&[]));
    fs::remove_dir_all(walk.folder.join("results")).unwrap();
    walk.change();
    reported_and_drawn(&walk);

    let accepting = walk.validate(&["--accept-left"]);
    assert_eq!(accepting.status.code(), Some(0));
    for name in ALL {
        assert!(
            printed(&accepting).contains(&format!("accepted: {name}\n")),
            "{}",
            printed(&accepting)
        );
    }
    walk.is_clean(&walk.run(&[]));
    agree(&walk.accepted(), &before);

    walk.change();
    walk.is_clean(&walk.run(&["--accept"]));
    walk.is_clean(&walk.run(&[]));
    agree(&walk.accepted(), &before);
}

/// The accepted snapshots are those of before the change: curves within the tolerance of snapshots, words to the
/// letter. Residuals may be round-off, and their number stays.
fn agree(now: &BTreeMap<&str, Vec<String>>, before: &BTreeMap<&str, Vec<String>>) {
    let number = |word: &String| word.parse::<f64>().ok();
    for (name, words) in now {
        let same = |(a, b): (&String, &String)| match (number(a), number(b)) {
            (Some(a), Some(b)) => name == &RESIDUALS || (a - b).abs() <= 1e-5 * b.abs(),
            _ => a == b,
        };
        assert_eq!(words.len(), before[name].len(), "{name}");
        assert!(
            words.iter().zip(&before[name]).all(same),
            "{name}: {words:?}"
        );
    }
}

#[test]
fn cargo_insta_takes_pending_snapshots_in_a_clone() {
    let Some(programs) = std::env::var_os("IGIMP_CARGO_INSTA") else {
        println!(
            "skipped: IGIMP_CARGO_INSTA names no folder (cargo install cargo-insta --root FOLDER, and FOLDER/bin)"
        );
        return;
    };
    let walk = Walk::clone_of_the_workspace("insta");
    let before = walk.accepted();
    let insta = |command: &str| Insta::new(&programs, &walk, command);
    walk.change();
    reported_and_drawn(&walk);
    let pending = printed(&insta("pending-snapshots").output());
    for name in ALL {
        assert!(
            pending.contains(&format!("validation/snapshots/{name}.snap\n")),
            "{pending}"
        );
    }
    let accepting = insta("accept").output();
    assert!(accepting.status.success(), "{}", printed(&accepting));
    walk.is_clean(&walk.run(&[]));
    agree(&walk.accepted(), &before);

    if !cfg!(target_os = "linux") {
        println!("skipped: a terminal for `cargo insta review`, which `script` of Linux makes");
        return;
    }
    fs::remove_dir_all(walk.folder.join("results")).unwrap();
    walk.change();
    reported_and_drawn(&walk);
    insta("review").answered("A");
    walk.is_clean(&walk.run(&[]));
    agree(&walk.accepted(), &before);
}

/// `cargo insta` in a clone of the workspace.
struct Insta(Command, String);

impl Insta {
    fn new(programs: &std::ffi::OsStr, walk: &Walk, command: &str) -> Self {
        let line = format!("cargo insta {command}");
        let mut words = line.split(' ');
        let mut insta = Command::new(words.next().unwrap());
        let path = std::env::var_os("PATH").unwrap();
        let folders = [PathBuf::from(programs)]
            .into_iter()
            .chain(std::env::split_paths(&path));
        insta.env("PATH", std::env::join_paths(folders).unwrap());
        insta.args(words).current_dir(walk.folder.join("clone"));
        Self(insta, line)
    }

    fn output(mut self) -> Output {
        self.0.output().unwrap()
    }

    /// Runs it on a terminal and presses a key until it ends.
    fn answered(self, key: &str) {
        let Self(insta, line) = self;
        let mut terminal = Command::new("script");
        terminal.args(["--quiet", "--return", "--command", &line, "/dev/null"]);
        terminal.current_dir(insta.get_current_dir().unwrap());
        terminal.envs(
            insta
                .get_envs()
                .filter_map(|(name, value)| Some((name, value?))),
        );
        terminal.stdin(Stdio::piped()).stdout(Stdio::null());
        let mut child = terminal.spawn().unwrap();
        let began = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait().unwrap() {
                break status;
            }
            assert!(
                began.elapsed() < Duration::from_secs(60),
                "`{line}` does not end"
            );
            // It may end at this moment, and then nobody reads.
            let _ = child.stdin.as_mut().unwrap().write_all(key.as_bytes());
            sleep(Duration::from_millis(200));
        };
        assert!(status.success(), "`{line}`: {status}");
    }
}
