//! GOAL: the command line keeps its contract: exit codes, help, and texts for other programs.

use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

const SMALL: &str = "igimp = 1\n[case]\ntitle = \"block\"\ngravity = \"9.81 m/s2\"\n\
    [grid]\ncell = \"0.5 m\"\ndomain = { x = [\"0 m\", \"4 m\"], y = [\"0 m\", \"4 m\"] }\n\
    [materials.clay]\nmodel = \"elastic\"\nunit_weight = \"18 kN/m3\"\n\
    young = \"10 MPa\"\npoisson = 0.3\n\
    [[bodies]]\nname = \"block\"\nmaterial = \"clay\"\npoints_per_cell = 4\n\
    polygon = [[\"0 m\", \"0 m\"], [\"2 m\", \"0 m\"], [\"2 m\", \"2 m\"], [\"0 m\", \"2 m\"]]\n\
    [boundaries]\nleft = \"roller\"\nright = \"roller\"\nbottom = \"fixed\"\n\
    [[stages]]\nname = \"own weight\"\ntype = \"gravity\"\nsteps = 5\n\
    [output]\nfolder = \"results\"\n";

/// A folder of its own for a test, gone when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path =
            std::env::temp_dir().join(format!("igimp-program-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.0.join(name), text).unwrap();
    }

    fn igimp(&self, words: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_igimp"))
            .args(words)
            .current_dir(&self.0)
            .output()
            .unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

#[test]
fn help_is_as_agreed() {
    let folder = Folder::new("help");
    let main = folder.igimp(&["--help"]);
    assert_eq!(code(&main), 0);
    insta::assert_snapshot!("help", stdout(&main));
    for command in [
        "new",
        "check",
        "explain",
        "run",
        "report",
        "element",
        "fit",
        "view",
        "film",
        "sweep",
        "collect",
        "validate",
        "schema",
        "completions",
        "man",
    ] {
        let help = folder.igimp(&[command, "--help"]);
        assert_eq!(code(&help), 0);
        insta::assert_snapshot!(format!("help-{command}"), stdout(&help));
    }
}

#[test]
fn slips_on_the_command_line_are_bad_input() {
    let folder = Folder::new("usage");
    folder.write("a.toml", SMALL);
    for words in [
        &["fly"][..],
        &[],
        &["run"],
        &["run", "a.toml", "--threads", "0"],
        &["run", "a.toml", "--resume", "--from-stage", "own weight"],
        &["run", "a.toml", "--task", "1", "--out", "x"],
        &["completions", "cmd.com"],
        &["fit", "a.toml", "--vary", "young=3", "--data", "a.csv"],
        &["fit", "a.toml", "--vary", "young", "--data", "none.csv"],
        &["element", "a.toml", "--data", "none.csv"],
        &[
            "fit",
            "a.toml",
            "--vary",
            "young",
            "--data",
            "a.csv",
            "--scatter",
            "q=2 m",
        ],
    ] {
        let output = folder.igimp(words);
        assert_eq!(code(&output), 2, "{words:?}: {}", stderr(&output));
    }
}

#[test]
fn bad_files_are_bad_input() {
    let folder = Folder::new("bad");
    folder.write("bad.toml", "igimp = \n");
    folder.write("a.toml", SMALL);
    for command in ["check", "explain", "run"] {
        let output = folder.igimp(&[command, "bad.toml"]);
        assert_eq!(code(&output), 2);
        assert!(stderr(&output).contains("bad.toml"), "{}", stderr(&output));
        assert!(stdout(&output).is_empty());
    }
    let output = folder.igimp(&["run", "a.toml", "--from-stage", "own wieght"]);
    assert_eq!(code(&output), 2);
    assert_eq!(
        stderr(&output),
        "error: there is no stage \"own wieght\"\n  help: did you mean \"own weight\"?\n"
    );
}

#[test]
fn files_that_are_not_there_are_input_output() {
    let folder = Folder::new("missing");
    for words in [
        &["check", "none.toml"][..],
        &["explain", "none.toml"],
        &["run", "none.toml"],
        &["run", "none.toml", "--task", "1"],
        &["sweep", "none.toml"],
        &["collect", "none.toml"],
        &["report", "none"],
    ] {
        let output = folder.igimp(words);
        assert_eq!(code(&output), 4, "{words:?}: {}", stderr(&output));
        assert!(stderr(&output).contains("  because: "), "{words:?}");
    }
}

#[test]
fn folders_that_cannot_be_made_are_input_output() {
    let folder = Folder::new("unwritable");
    folder.write("a.toml", SMALL);
    folder.write("file", "");
    for words in [
        &["run", "a.toml", "--out", "file/out"][..],
        &["man", "--out", "file/out"],
    ] {
        let output = folder.igimp(words);
        assert_eq!(code(&output), 4, "{words:?}: {}", stderr(&output));
        assert!(stderr(&output).starts_with("error: cannot access"));
    }
}

#[test]
fn a_case_is_checked_and_explained() {
    let folder = Folder::new("check");
    folder.write("a.toml", SMALL);
    let check = folder.igimp(&["check", "a.toml"]);
    assert_eq!(code(&check), 0, "{}", stderr(&check));
    let text = stdout(&check);
    for part in [
        "a.toml is fine",
        "particles  64",
        "cells      64 (8 x 8)",
        "unknowns   about 36",
        "memory     about",
        "bytes for a particle, ",
        "time       about",
        "1. own weight  gravity  5 steps",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
    let explain = folder.igimp(&["explain", "a.toml"]);
    assert_eq!(code(&explain), 0);
    assert!(stdout(&explain).contains("unit_weight"));
}

#[test]
fn templates_are_listed_and_suggested() {
    let folder = Folder::new("new");
    for words in [&["new"][..], &["new", "--list"]] {
        let list = folder.igimp(words);
        assert_eq!(code(&list), 0);
        assert!(stdout(&list).contains("  slope"), "{}", stdout(&list));
    }
    let slip = folder.igimp(&["new", "slop"]);
    assert_eq!(code(&slip), 2);
    assert!(stderr(&slip).contains("did you mean `slope`?"));
    assert!(stderr(&slip).contains("templates:"));
    assert!(stdout(&slip).is_empty());

    let slope = folder.igimp(&["new", "slope"]);
    assert_eq!(code(&slope), 0);
    folder.write("slope.toml", &stdout(&slope));
    assert_eq!(code(&folder.igimp(&["check", "slope.toml"])), 0);
}

#[test]
fn other_programs_get_their_texts() {
    let folder = Folder::new("pages");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let output = folder.igimp(&["completions", shell]);
        assert_eq!(code(&output), 0);
        assert!(stdout(&output).contains("igimp"), "{shell}");
    }
    assert!(stdout(&folder.igimp(&["man"])).contains(".TH igimp 1"));
    assert_eq!(code(&folder.igimp(&["man", "--out", "man"])), 0);
    for page in ["igimp.1", "igimp-run.1", "igimp-collect.1"] {
        assert!(folder.0.join("man").join(page).exists(), "{page}");
    }
    let schema = folder.igimp(&["schema"]);
    assert_eq!(code(&schema), 0);
    let schema: serde_json::Value = serde_json::from_str(&stdout(&schema)).unwrap();
    assert!(schema.is_object());
}

#[test]
fn a_reader_may_go_away() {
    let folder = Folder::new("pipe");
    for words in [&["completions", "zsh"][..], &["schema"], &["man"], &["new"]] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_igimp"))
            .args(words)
            .current_dir(&folder.0)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(code(&output), 0, "{words:?}");
        assert_eq!(stderr(&output), "", "{words:?}");
    }
}

const SWEEP: &str = "igimp_sweep = 1\ncase = \"a.toml\"\ncombine = \"zip\"\n\
    [parameters]\nmaterials.clay.young = [\"10 MPa\", \"20 MPa\"]\n\
    [output]\nfolder = \"sweep\"\n";

#[test]
fn a_sweep_is_listed_and_collected() {
    let folder = Folder::new("sweep");
    folder.write("a.toml", SMALL);
    folder.write("study.toml", SWEEP);
    let list = folder.igimp(&["sweep", "study.toml", "--list"]);
    assert_eq!(code(&list), 0, "{}", stderr(&list));
    assert_eq!(
        stdout(&list),
        "task 1/2  materials.clay.young=\"10 MPa\"\ntask 2/2  materials.clay.young=\"20 MPa\"\n"
    );
    let collect = folder.igimp(&["collect", "study.toml"]);
    assert_eq!(code(&collect), 4);
    assert!(stderr(&collect).contains("no results of 2 of 2 tasks: 1, 2"));
    assert!(folder.0.join("sweep/results.csv").exists());

    let wrong = folder.igimp(&["run", "study.toml", "--task", "3"]);
    assert_eq!(code(&wrong), 2);
    assert!(stderr(&wrong).contains("there is no task 3; tasks are numbered 1 to 2"));
    let plain = folder.igimp(&["run", "study.toml"]);
    assert_eq!(code(&plain), 2);
    assert!(stderr(&plain).contains("is a sweep, not a case"));
}

#[test]
fn an_unknown_built_in_case_is_bad_input() {
    let folder = Folder::new("validate");
    let output = folder.igimp(&["validate", "slop"]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("did you mean `slope`?"));
}

/// A pipe in place of a table would be waited for without end.
#[cfg(unix)]
#[test]
fn a_pipe_is_no_table_of_a_reference() {
    let folder = Folder::new("pipe-table");
    let made = Command::new("mkfifo")
        .arg("points.csv")
        .current_dir(&folder.0)
        .status();
    if !made.is_ok_and(|status| status.success()) {
        println!("skipped: no pipe can be made here");
        return;
    }
    let curve = "[[curves]]\nname = \"load\"\n\
        x = { of = \"gravity_factor\", label = \"gravity [-]\" }\n\
        y = { of = \"largest_displacement\", label = \"displacement [m]\" }\n\
        reference = { file = \"points.csv\", label = \"a pipe\" }\n";
    folder.write("case.toml", &format!("{SMALL}{curve}"));
    let mut check = Command::new(env!("CARGO_BIN_EXE_igimp"))
        .args(["check", "case.toml"])
        .current_dir(&folder.0)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let ended = (0..600).any(|_| {
        std::thread::sleep(std::time::Duration::from_millis(50));
        check.try_wait().unwrap().is_some()
    });
    if !ended {
        check.kill().unwrap();
    }
    let output = check.wait_with_output().unwrap();
    assert!(ended, "the program waits for a pipe");
    assert_eq!(code(&output), 2);
    assert!(
        stderr(&output).contains("it is not a file"),
        "{}",
        stderr(&output)
    );
}
