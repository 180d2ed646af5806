//! GOAL: the guide describes the program as it is. Commands on its pages run and end with the code that
//! the page says; messages, tables and lists are those of the program; the recipe in Python works.
//! ORACLE: the program itself, and numpy and pandas where they are installed.
//!
//! Comments that readers do not see say how a block is tried, before it:
//!
//! | comment | meaning |
//! |---|---|
//! | `tried with: OPTIONS` | options put behind every `igimp run` of the block, to be quick |
//! | `exit: CODE` | exit code of the block's last command, 0 when not said |
//! | `not tried: REASON` | the block is not run |
//! | `tried by: TEST` | a test of its own runs it |
//! | `first: COMMAND` | run before the block, and not shown; its exit code may be 0 or 1 |
//! | `needs: PACKAGES` | packages of Python without which the block is skipped |
//! | `tried as: FROM => TO` | a change of a file, to be quick |
//! | `file: NAME` | the block is written to this file before the next commands run |
//! | `from: NAME.toml` | its lines are those of a shipped case, comments aside |
//! | `added to: NAME.toml` | behind a shipped case it makes a valid one |
//! | `gives` | output of the commands before; a line `...` stands for any lines |
//! | `gives like` | the same, whatever the numbers are: those on the page are of the full grid |
//! | `NAME.toml: FROM => TO` | the message for a shipped case with this change |
//! | `NAME.toml: --set SETTING` | the message for a shipped case with this setting |
//! | `of: FILE` | the lines stand in this file of the workspace |
//! | `generated: WHAT` to `generated: end` | made by the program |
//!
//! In blocks of the language `console`, `igimp run` is tried as `igimp check`: the cases themselves are
//! run by `tests/shipped` of `igimp-cases`. A block of Python runs in the folder of its page. `coverage.rs` sees to it
//! that no block of any page is left out.
//!
//! Messages and generated parts are written anew with `INSTA_UPDATE=always`, like snapshots.

mod commands;
mod coverage;
mod page;
mod results;

use std::fmt::Write as _;
use std::fs;

use igimp_input::CaseFile;
use igimp_input::shipped::{SHIPPED, find};
use igimp_schema::reference_markdown;

use crate::page::{blocks, comment, hold, pages, root};

/// The message of the program on a shipped case with changes, if the marks ask for it.
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
            let name = mark
                .as_deref()
                .and_then(|mark| mark.strip_prefix("generated: "));
            inside &= name != Some("end");
            if !inside {
                should_be += line;
                should_be.push('\n');
            }
            let part = match name {
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
