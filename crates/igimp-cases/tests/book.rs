//! GOAL: the guide says what the program does. Commands on its pages run and end with the code that
//! the page says; messages, tables and lists are those of the program; the recipe in Python works.
//! ORACLE: the program itself, and numpy and pandas where they are installed.
//!
//! A page says what is tried of it in comments that readers do not see, before a block:
//!
//! | comment | meaning |
//! |---|---|
//! | `tried with: OPTIONS` | options put behind every `igimp run` of the block, to be quick |
//! | `exit: CODE` | exit code of the block's last command, 0 when not said |
//! | `not tried: REASON` | the block is not run |
//! | `tried as: FROM => TO` | a change of a file, to be quick |
//! | `file: NAME` | the block is written to this file before the next commands run |
//! | `from: NAME.toml` | its lines are those of a shipped case, comments aside |
//! | `added to: NAME.toml` | behind a shipped case it makes a valid one |
//! | `gives` | what the commands before print; a line `...` stands for any lines |
//! | `gives like` | the same, whatever the numbers are: those on the page are of the full grid |
//! | `NAME.toml: FROM => TO` | the message for a shipped case with this change |
//! | `NAME.toml: --set SETTING` | the message for a shipped case with this setting |
//! | `of: FILE` | the lines stand in this file of the workspace |
//! | `generated: WHAT` to `generated: end` | made by the program |
//!
//! Messages and what is generated are written anew with `INSTA_UPDATE=always`, like snapshots.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

use igimp_cases::input::{CaseFile, reference_markdown};
use igimp_cases::results::checkpoint;
use igimp_cases::shipped::{SHIPPED, find};

/// The slope on cells so large that it runs in a second or two.
const COARSE: &str = "--set 'grid.cell={x=\"5 m\", y=\"2 m\"}' --set checks.0.between=[1,2]";

/// A block of code on a page.
#[derive(Debug)]
struct Block {
    /// Comments right before it.
    marks: Vec<String>,
    language: String,
    text: String,
    /// Number of its first line, from 1.
    line: usize,
}

impl Block {
    fn mark(&self, name: &str) -> Option<&str> {
        self.marks
            .iter()
            .find_map(|mark| mark.strip_prefix(name).map(str::trim))
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The pages that are tried, from the root of the workspace.
fn pages() -> Vec<PathBuf> {
    let mut pages: Vec<PathBuf> = fs::read_dir(root().join("docs/src/guide"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|end| end == "md"))
        .collect();
    pages.sort();
    pages.extend(["docs/src/tour.md", "README.md"].map(|name| root().join(name)));
    pages
}

/// The text between the marks of a comment on a line of its own.
fn comment(line: &str) -> Option<String> {
    let inner = line.trim().strip_prefix("<!--")?.strip_suffix("-->")?;
    Some(inner.trim().to_owned())
}

fn blocks(text: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut marks = Vec::new();
    let mut lines = text.lines().enumerate();
    while let Some((number, line)) = lines.next() {
        if let Some(mark) = comment(line) {
            marks.push(mark);
        } else if let Some(language) = line.strip_prefix("```") {
            let inner: Vec<&str> = lines
                .by_ref()
                .map(|(_, line)| line)
                .take_while(|line| *line != "```")
                .collect();
            blocks.push(Block {
                marks: std::mem::take(&mut marks),
                language: language.to_owned(),
                text: inner
                    .iter()
                    .fold(String::new(), |text, line| text + line + "\n"),
                line: number + 2,
            });
        } else if !line.trim().is_empty() {
            marks.clear();
        }
    }
    blocks
}

/// A new folder of the build.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("book")
        .join(name);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    path
}

/// Runs a line in a shell that finds the program.
fn shell(folder: &Path, line: &str) -> Output {
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

fn has_shell() -> bool {
    let found = Command::new("sh").args(["-c", "true"]).status();
    let found = cfg!(unix) && found.is_ok_and(|status| status.success());
    if !found {
        println!("skipped: there is no sh");
    }
    found
}

fn said(output: &Output) -> String {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    text(&output.stdout) + &text(&output.stderr)
}

/// The commands of a block that run the program or make a folder for it, continued lines joined.
fn commands(block: &Block) -> Vec<String> {
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

/// Runs the commands of a page, one after the other in one folder; how many there are, and what is
/// wrong.
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
        if block.language != "sh" || block.mark("not tried:").is_some() {
            continue;
        }
        let lines = commands(&block);
        for (number, line) in lines.iter().enumerate() {
            let output = shell(&folder, line);
            tried += 1;
            last = said(&output);
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

/// Holds a page against what it should be, or writes it anew.
fn hold(page: &Path, text: &str, should_be: &str) {
    if text == should_be {
        return;
    }
    if std::env::var_os("INSTA_UPDATE").is_some_and(|value| value == "always") {
        fs::write(page, should_be).unwrap();
        return;
    }
    let line = std::iter::zip(text.lines(), should_be.lines())
        .position(|(a, b)| a != b)
        .unwrap_or(0);
    panic!(
        "{}:{}: this is no longer what the program says, which is\n  {}\n\
         Write it anew with `INSTA_UPDATE=always cargo test -p igimp-cases --test book`.",
        page.strip_prefix(root()).unwrap_or(page).display(),
        line + 1,
        should_be.lines().nth(line).unwrap_or_default()
    );
}

/// What the program says of a shipped case with changes, if the marks ask for it.
fn message(marks: &[String]) -> Option<String> {
    let mut case: Option<(&str, String)> = None;
    let mut settings = Vec::new();
    for mark in marks {
        let Some((name, change)) = mark.split_once(".toml: ") else {
            continue;
        };
        let text = match &case {
            Some((_, text)) => text.clone(),
            None => find(name)
                .unwrap_or_else(|| panic!("no case {name}"))
                .text
                .to_owned(),
        };
        let text = if let Some(setting) = change.strip_prefix("--set ") {
            settings.push(setting.to_owned());
            text
        } else {
            let (from, to) = change.split_once(" => ").expect("FROM => TO");
            assert!(text.contains(from), "`{from}` is not in {name}.toml");
            text.replacen(from, to, 1)
        };
        case = Some((name, text));
    }
    let (name, text) = case?;
    Some(
        match CaseFile::parse(&format!("{name}.toml"), &text, &settings) {
            Ok(file) => file.warnings(),
            Err(error) => error.to_string(),
        },
    )
}

#[test]
fn messages_on_the_pages_are_those_of_the_program() {
    let mut count = 0;
    for page in pages() {
        let text = fs::read_to_string(&page).unwrap();
        let mut should_be = text.clone();
        for block in blocks(&text) {
            if let Some(message) = message(&block.marks) {
                let marks = block.marks.last().unwrap();
                let old = format!("<!-- {marks} -->\n```text\n{}```\n", block.text);
                let new = format!("<!-- {marks} -->\n```text\n{}\n```\n", message.trim_end());
                assert!(
                    should_be.contains(&old),
                    "{}: no blank lines after {marks}",
                    page.display()
                );
                should_be = should_be.replacen(&old, &new, 1);
                count += 1;
            }
            if let Some(file) = block.mark("of:") {
                let source = fs::read_to_string(root().join(file)).unwrap();
                let lines: Vec<&str> = source.lines().map(str::trim).collect();
                for line in block.text.lines() {
                    assert!(lines.contains(&line.trim()), "`{line}` is not in {file}");
                }
            }
        }
        hold(&page, &text, &should_be);
    }
    assert!(count >= 10, "only {count} messages were found");
}

/// A line without its comment and without the spaces that align it.
fn bare(line: &str) -> &str {
    line.split_once(" #").map_or(line, |(code, _)| code).trim()
}

#[test]
fn parts_of_case_files_are_right() {
    let shipped = |name: &str| {
        let found = find(name);
        found.unwrap_or_else(|| panic!("no case {name}")).text
    };
    let mut count = 0;
    for page in pages() {
        for block in blocks(&fs::read_to_string(&page).unwrap()) {
            let place = format!("{}:{}", page.display(), block.line);
            if let Some(name) = block.mark("from:") {
                let known: Vec<&str> = shipped(name).lines().map(bare).collect();
                for line in block.text.lines() {
                    assert!(
                        known.contains(&bare(line)),
                        "{place}: `{line}` is not in {name}"
                    );
                }
                count += 1;
            }
            if let Some(name) = block.mark("added to:") {
                let text = format!("{}\n{}", shipped(name), block.text);
                if let Err(error) = CaseFile::parse(name, &text, &[]) {
                    panic!("{place}: {error}");
                }
                count += 1;
            }
        }
    }
    assert!(count >= 10, "only {count} parts of case files were found");
}

fn templates() -> String {
    let rows = SHIPPED
        .iter()
        .map(|case| format!("| `{}` | {} |\n", case.name, case.summary));
    format!(
        "| name | what it is |\n|---|---|\n{}",
        rows.collect::<String>()
    )
}

#[test]
fn generated_parts_are_those_of_the_program() {
    for page in pages() {
        let text = fs::read_to_string(&page).unwrap();
        let mut should_be = String::new();
        let mut inside = false;
        for line in text.lines() {
            let mark = comment(line);
            let what = mark
                .as_deref()
                .and_then(|mark| mark.strip_prefix("generated: "));
            inside &= what != Some("end");
            if !inside {
                should_be += line;
                should_be.push('\n');
            }
            let part = match what {
                Some("reference") => reference_markdown(),
                Some("templates") => templates(),
                None | Some("end") => continue,
                Some(other) => panic!("{}: generated: {other}", page.display()),
            };
            let _ = write!(should_be, "\n{}\n\n", part.trim_end());
            inside = true;
        }
        assert!(!inside, "{}: generated without an end", page.display());
        hold(&page, &text, &should_be);
    }
}

/// The results of the coarse slope, run once for all tests.
fn slope_results() -> &'static Path {
    static RESULTS: OnceLock<PathBuf> = OnceLock::new();
    RESULTS.get_or_init(|| {
        let folder = folder("slope");
        let line = format!(
            "igimp new slope > slope.toml && igimp run slope.toml {COARSE} --out results/slope"
        );
        let output = shell(&folder, &line);
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        folder
    })
}

/// Every key of a value, and those within it.
fn keys(value: &serde_json::Value, out: &mut Vec<String>) {
    match value {
        serde_json::Value::Object(map) => {
            for (key, value) in map {
                out.push(key.clone());
                keys(value, out);
            }
        }
        serde_json::Value::Array(values) => values.iter().for_each(|value| keys(value, out)),
        _ => {}
    }
}

#[test]
fn the_page_on_results_names_every_file_and_field() {
    if !has_shell() {
        return;
    }
    let page = fs::read_to_string(root().join("docs/src/guide/results.md")).unwrap();
    let results = slope_results().join("results/slope");
    let mut names = Vec::new();
    let summary = fs::read(results.join("summary.json")).unwrap();
    keys(&serde_json::from_slice(&summary).unwrap(), &mut names);
    for entry in fs::read_dir(&results).unwrap() {
        names.push(entry.unwrap().file_name().into_string().unwrap());
    }
    let newest = checkpoint::newest(&results.join("checkpoint"))
        .unwrap()
        .unwrap();
    for entry in fs::read_dir(newest.join("current")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        names.push(name.trim_end_matches(".npy").to_owned());
    }
    let missing: Vec<&String> = names
        .iter()
        .filter(|name| {
            !["`", "/`"]
                .iter()
                .any(|end| page.contains(&format!("`{name}{end}")))
        })
        .collect();
    assert!(missing.is_empty(), "not on the page: {missing:?}");
}

#[test]
fn the_python_recipe_works() {
    if !has_shell() {
        return;
    }
    let import = Command::new("python3")
        .args(["-c", "import numpy, pandas"])
        .output();
    if !import.is_ok_and(|output| output.status.success()) {
        println!("skipped: python3 cannot import numpy and pandas");
        return;
    }
    let recipe = root().join("docs/src/guide/python_recipe.py");
    let folder = slope_results();
    let output = shell(
        folder,
        &format!("python3 '{}' results/slope", recipe.display()),
    );
    assert!(output.status.success(), "{}", said(&output));
    println!("{}", said(&output));
}
