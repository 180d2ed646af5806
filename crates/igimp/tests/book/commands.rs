//! The commands of pages, run as a reader would.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::page::{Block, blocks, pages};

/// A new folder of the build.
pub(crate) fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("book")
        .join(name);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    path
}

/// Runs a line in a shell that finds the program.
pub(crate) fn shell(folder: &Path, line: &str) -> Output {
    let program = Path::new(env!("CARGO_BIN_EXE_igimp"));
    let mut path = program.parent().unwrap().as_os_str().to_owned();
    path.push(":");
    path.push(std::env::var_os("PATH").unwrap_or_default());
    Command::new("sh")
        .args(["-c", line])
        .env("PATH", path)
        .current_dir(folder)
        .output()
        .unwrap()
}

pub(crate) fn has_shell() -> bool {
    let found = Command::new("sh").args(["-c", "true"]).status();
    let found = cfg!(unix) && found.is_ok_and(|status| status.success());
    if !found {
        println!("skipped: there is no sh");
    }
    found
}

pub(crate) fn printed(output: &Output) -> String {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    text(&output.stdout) + &text(&output.stderr)
}

/// The commands of a block that run the program or make a folder for it, continued lines joined.
fn commands(block: &Block) -> Vec<String> {
    if block.language == "console" {
        let prompted = block
            .text
            .lines()
            .filter_map(|line| line.strip_prefix("$ "));
        return prompted
            .map(|line| line.replace("igimp run ", "igimp check "))
            .collect();
    }
    let joined = block.text.replace("\\\n", " ");
    let extra = block.mark("tried with:");
    joined
        .lines()
        .filter(|line| {
            ["igimp ", "mkdir "]
                .iter()
                .any(|start| line.starts_with(start))
        })
        .map(|line| match extra {
            Some(extra) => line.replace("igimp run ", &format!("igimp run {extra} ")),
            None => line.to_owned(),
        })
        .collect()
}

/// Whether a text is as a page shows it; `...` on a line stands for any lines.
fn is_shown(expected: &[String], found: &[String]) -> bool {
    match expected.split_first() {
        None => found.is_empty(),
        Some((line, rest)) if line.trim() == "..." => {
            (0..=found.len()).any(|skip| is_shown(rest, &found[skip..]))
        }
        Some((line, rest)) => found
            .split_first()
            .is_some_and(|(first, others)| first == line && is_shown(rest, others)),
    }
}

/// A line with its numbers replaced and without its alignment.
fn like(line: &str) -> String {
    let mut words: Vec<&str> = line
        .split_whitespace()
        .map(|word| {
            if word.contains(|c: char| c.is_ascii_digit()) {
                "#"
            } else {
                word
            }
        })
        .collect();
    words.dedup_by(|a, b| *a == "#" && *b == "#");
    words.join(" ")
}

/// The text of a block that is to be a file, with its change to be quick.
fn file_text(block: &Block) -> String {
    match block
        .mark("tried as:")
        .and_then(|mark| mark.split_once(" => "))
    {
        Some((from, to)) => {
            assert!(block.text.contains(from), "`{from}` is not in the block");
            block.text.replacen(from, to, 1)
        }
        None => block.text.clone(),
    }
}

/// Whether Python can import packages, separated by commas.
pub(crate) fn can_import(packages: &str) -> bool {
    let import = format!("import {packages}");
    let found = Command::new("python3").args(["-c", &import]).output();
    let found = found.is_ok_and(|output| output.status.success());
    if !found {
        println!("skipped: python3 cannot import {packages}");
    }
    found
}

/// Runs a block of Python; its fault.
fn try_python(folder: &Path, block: &Block) -> Option<String> {
    if !can_import(block.mark("needs:").unwrap_or("sys")) {
        return None;
    }
    fs::write(folder.join("block.py"), file_text(block)).unwrap();
    let output = shell(folder, "python3 block.py");
    (!output.status.success()).then(|| printed(&output))
}

/// Runs the commands of a page, one after the other in one folder; their number, and their
/// faults.
fn try_page(page: &Path) -> (usize, String) {
    let name = page.file_stem().unwrap().to_string_lossy().into_owned();
    let folder = folder(&name);
    let (mut tried, mut problems, mut last) = (0, String::new(), String::new());
    for block in blocks(&fs::read_to_string(page).unwrap()) {
        if let Some(file) = block.mark("file:") {
            fs::write(folder.join(file), file_text(&block)).unwrap();
        }
        if block.mark("gives").is_some() {
            let as_shown = |line: &str| match block.mark("gives") {
                Some("like") => like(line),
                _ => line.trim_end().to_owned(),
            };
            let expected: Vec<String> = block.text.lines().map(as_shown).collect();
            let found: Vec<String> = last.lines().map(as_shown).collect();
            if !is_shown(&expected, &found) {
                let _ = writeln!(problems, "{name}:{}: prints\n{last}", block.line);
            }
        }
        let marked = ["not tried:", "tried by:"]
            .iter()
            .any(|mark| block.mark(mark).is_some());
        if marked {
            continue;
        }
        for first in block
            .marks
            .iter()
            .filter_map(|mark| mark.strip_prefix("first: "))
        {
            let output = shell(&folder, first);
            let done = matches!(output.status.code(), Some(0 | 1));
            assert!(done, "{name}: `{first}`: {}", printed(&output));
        }
        if block.language == "python" {
            if let Some(problem) = try_python(&folder, &block) {
                let _ = writeln!(problems, "{name}:{}: {problem}", block.line);
            }
            tried += 1;
        }
        if block.language != "sh" && block.language != "console" {
            continue;
        }
        let lines = commands(&block);
        for (number, line) in lines.iter().enumerate() {
            let output = shell(&folder, line);
            tried += 1;
            last = printed(&output);
            let is_last = number + 1 == lines.len();
            let wanted = block.mark("exit:").filter(|_| is_last).unwrap_or("0");
            let code = output.status.code().map(|code| code.to_string());
            if code.as_deref() != Some(wanted) {
                let _ = writeln!(
                    problems,
                    "{name}:{}: `{line}` ends with {code:?} and not {wanted}\n{last}",
                    block.line
                );
            }
        }
    }
    (tried, problems)
}

#[test]
fn commands_on_the_pages_run() {
    if !has_shell() {
        return;
    }
    let pages = pages();
    let ends: Vec<(usize, String)> = std::thread::scope(|scope| {
        let running: Vec<_> = pages
            .iter()
            .map(|page| scope.spawn(|| try_page(page)))
            .collect();
        let ended = running.into_iter().map(|page| page.join().unwrap());
        ended.collect()
    });
    let problems: String = ends.iter().map(|(_, problems)| problems.as_str()).collect();
    let tried: usize = ends.iter().map(|(tried, _)| tried).sum();
    assert!(problems.is_empty(), "{problems}");
    assert!(tried > 20, "only {tried} commands were found");
}
