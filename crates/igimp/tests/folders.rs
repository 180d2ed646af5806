//! GOAL: two runs never share or clear a folder unasked, and nothing is written outside of it.
//! CASE: a coarse slope under gravity, its factor of safety, and its run-out.
//! ORACLE: every byte that was there before.

mod run_support;

use std::fs;
use std::path::PathBuf;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

use run_support::{Folder, differing};

const SWEEP: &str = "igimp_sweep = 1
case = \"slope.toml\"
[parameters]
materials.clay.cohesion = [\"14 kPa\", \"16 kPa\"]
grid.cell = [\"2 m\"]
stages.run-out.steps = [5]
output.report = [false]
[output]
folder = \"out\"
";

/// Starts a run and waits until it has computed something.
fn begun(folder: &Folder, out: &str) -> Child {
    let mut child = folder.run(out, &[]).spawn().unwrap();
    while child.try_wait().unwrap().is_none()
        && !folder.0.join(out).join("checkpoint/stage-01-end").exists()
    {
        std::thread::sleep(Duration::from_millis(1));
    }
    child
}

fn killed(mut child: Child) {
    child.kill().unwrap();
    child.wait().unwrap();
}

fn igimp(folder: &Folder, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_igimp"))
        .args(words)
        .current_dir(&folder.0)
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

fn printed(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_second_run_into_a_folder_ends_at_once() {
    let folder = Folder::new("second");
    let child = begun(&folder, "out");
    for more in [
        &[][..],
        &["--resume"],
        &["--overwrite"],
        &["--from-stage", "run-out"],
    ] {
        let (code, printed) = folder.end("out", more);
        assert_eq!(code, Some(4), "{printed}");
        assert_eq!(
            printed,
            "error: another igimp writes into out; wait until it has ended, or choose another folder \
             for the results\n"
        );
    }
    killed(child);
    // Of the run that was killed nothing stands in the way.
    let (code, printed) = folder.end("out", &["--resume"]);
    assert_eq!(code, Some(0), "{printed}");
}

#[test]
fn a_stopped_run_is_kept_until_asked_and_a_finished_one_is_run_again() {
    let folder = Folder::new("stopped");
    killed(begun(&folder, "out"));
    let before = folder.everything("out");
    let (code, printed) = folder.end("out", &[]);
    assert_eq!(code, Some(2), "{printed}");
    assert_eq!(
        printed,
        "error: out holds a run that was stopped and can go on: --resume goes on with it, --overwrite \
         begins afresh, --out chooses another folder\n"
    );
    let edited = ["--set", "materials.clay.cohesion=21 kPa"];
    let (code, printed) = folder.end("out", &edited);
    assert_eq!(code, Some(2), "{printed}");
    assert!(printed.contains("with the input that it had"), "{printed}");
    let after = folder.everything("out");
    assert_eq!(differing(&before, &after), Vec::<PathBuf>::new());
    let (code, printed) = folder.end("out", &["--overwrite"]);
    assert_eq!(code, Some(0), "{printed}");
    for more in [&[][..], &edited] {
        let (code, printed) = folder.end("out", more);
        assert_ne!(code, Some(2), "{printed}");
    }
}

#[test]
fn equal_names_from_different_places_do_not_collide() {
    let folder = Folder::new("namesakes");
    let (code, text) = folder.end("out", &[]);
    assert_eq!(code, Some(0), "{text}");
    let before = folder.everything("out");
    fs::create_dir(folder.0.join("b")).unwrap();
    let case = fs::read_to_string(folder.0.join("slope.toml")).unwrap();
    let other = case.replace("title = \"", "title = \"Another ");
    fs::write(folder.0.join("b/slope.toml"), other).unwrap();
    let output = igimp(&folder, &["run", "b/slope.toml", "--out", "out"]);
    assert_eq!(output.status.code(), Some(2), "{}", printed(&output));
    let text = printed(&output);
    let start = "error: out holds results of another input, ../slope.toml (\"";
    assert!(text.starts_with(start), "{text}");
    let end = "\"): --out chooses another folder, --overwrite replaces them\n";
    assert!(text.ends_with(end), "{text}");
    let after = folder.everything("out");
    assert_eq!(differing(&before, &after), Vec::<PathBuf>::new());
}

#[test]
fn sweeps_keep_apart_and_a_stopped_task_goes_on() {
    let folder = Folder::new("sweeps");
    fs::write(folder.0.join("a.toml"), SWEEP).unwrap();
    fs::write(folder.0.join("b.toml"), SWEEP).unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_igimp"))
        .args(["sweep", "a.toml"])
        .current_dir(&folder.0)
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let first_stage = folder.0.join("out/task-0002/checkpoint/stage-01-end");
    while child.try_wait().unwrap().is_none() && !first_stage.exists() {
        std::thread::sleep(Duration::from_millis(1));
    }
    for words in [&["sweep", "a.toml"][..], &["run", "--task", "1", "a.toml"]] {
        let output = igimp(&folder, words);
        assert_eq!(output.status.code(), Some(4), "{}", printed(&output));
        assert!(printed(&output).contains("another igimp writes into out"));
    }
    killed(child);
    let kept = fs::metadata(&first_stage).unwrap().modified().unwrap();
    let output = igimp(&folder, &["sweep", "b.toml"]);
    assert_eq!(output.status.code(), Some(2), "{}", printed(&output));
    assert!(printed(&output).contains("out holds results of another input, ../a.toml"));
    let advice = "`folder` in [output] of the sweep file chooses another folder";
    assert!(printed(&output).contains(advice), "{}", printed(&output));
    let output = igimp(&folder, &["sweep", "a.toml"]);
    assert!(
        matches!(output.status.code(), Some(0 | 1)),
        "{}",
        printed(&output)
    );
    let now = fs::metadata(&first_stage).unwrap().modified().unwrap();
    assert_eq!(
        now, kept,
        "the first stage of the stopped task was computed again"
    );
}

/// GOAL: results of a run and tasks of a sweep are never in one folder.
/// ORACLE: the exit code, the message, and a folder without tasks.
#[test]
fn a_sweep_is_refused_where_a_run_has_its_results() {
    let folder = Folder::new("sweep-over-run");
    let (code, text) = folder.end("out", &[]);
    assert_eq!(code, Some(0), "{text}");
    fs::write(folder.0.join("a.toml"), SWEEP).unwrap();
    for more in [&[][..], &["--overwrite"]] {
        let output = igimp(&folder, &[&["sweep", "a.toml"][..], more].concat());
        assert_eq!(output.status.code(), Some(2), "{}", printed(&output));
        let text = printed(&output);
        assert!(
            text.contains("out holds results of another input, ../slope.toml"),
            "{text}"
        );
        assert!(
            text.contains("`folder` in [output] of the sweep file"),
            "{text}"
        );
    }
    assert!(!folder.0.join("out/task-0001").exists());
}

/// Links in the places of files give way to files, and links in the places of folders are refused.
#[cfg(unix)]
#[test]
fn nothing_is_written_through_a_link() {
    use std::os::unix::fs::symlink;
    let folder = Folder::new("links");
    let (code, text) = folder.end("out", &["--set", "output.report=true"]);
    assert_eq!(code, Some(0), "{text}");
    let outside = folder.0.join("outside");
    let mut places: Vec<PathBuf> = folder.everything("out").into_keys().collect();
    places.retain(|place| !place.starts_with("checkpoint"));
    places.push(".igimp".into());
    assert!(places.len() > 20, "{places:?}");
    for place in &places {
        let path = folder.0.join("out").join(place);
        let mine = outside.join(place);
        fs::create_dir_all(mine.parent().unwrap()).unwrap();
        fs::write(&mine, "the user's").unwrap();
        fs::remove_file(&path).unwrap();
        symlink(&mine, &path).unwrap();
    }
    let (code, text) = folder.end("out", &["--overwrite", "--set", "output.report=true"]);
    assert_eq!(code, Some(0), "{text}");
    for place in &places {
        let path = folder.0.join("out").join(place);
        assert_eq!(
            fs::read(outside.join(place)).unwrap(),
            b"the user's",
            "{place:?}"
        );
        assert!(!path.is_symlink(), "{place:?}");
    }
    let checkpoints = folder.0.join("out/checkpoint");
    fs::rename(&checkpoints, outside.join("checkpoint")).unwrap();
    symlink(outside.join("checkpoint"), &checkpoints).unwrap();
    for more in [&[][..], &["--resume"], &["--overwrite"]] {
        let (code, text) = folder.end("out", more);
        assert_eq!(code, Some(2), "{text}");
        assert!(
            text.contains("out/checkpoint is a link that leads elsewhere"),
            "{text}"
        );
    }
}
