//! GOAL: every `cargo xtask` command that a page of the project shows is one that there is.
//! ORACLE: the command line of this program; the validation program's options are tried by its own
//! tests.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Parser;

use crate::Arguments;
use crate::process::root;

/// The documents of the root and the pages of the book.
fn pages() -> Vec<PathBuf> {
    fn collect(folder: &Path, deep: bool, pages: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() && deep {
                collect(&path, deep, pages);
            } else if path.extension().is_some_and(|end| end == "md") {
                pages.push(path);
            }
        }
    }
    let mut pages = Vec::new();
    collect(&root(), false, &mut pages);
    collect(&root().join("docs/src"), true, &mut pages);
    pages.push(root().join("benchmarks/README.md"));
    pages
}

/// The words of the commands of a text that begin with `cargo xtask`, in blocks and in backquotes; up
/// to a comment or the end of the code.
fn commands(text: &str) -> Vec<Vec<String>> {
    text.match_indices("cargo xtask ")
        .map(|(place, start)| {
            let rest = &text[place + start.len()..];
            let end = rest.find(['`', '\n', '#', ';', '&', '|']);
            let words = rest[..end.unwrap_or(rest.len())].split_whitespace();
            words.map(str::to_owned).collect()
        })
        .collect()
}

#[test]
fn commands_are_found_in_blocks_and_in_text() {
    let text = "Run `cargo xtask bench --save a`, or\n```sh\ncargo xtask tidy   # checks\n```\n";
    assert_eq!(commands(text), [vec!["bench", "--save", "a"], vec!["tidy"]]);
}

#[test]
fn commands_on_the_pages_are_those_of_this_program() {
    let mut count = 0;
    for page in pages() {
        for words in commands(&fs::read_to_string(&page).unwrap()) {
            // A name in capitals stands for a number or a word of the reader's.
            let words = words.iter().map(|word| match word.as_str() {
                "N" => "2",
                "COMMAND" => "tidy",
                word => word,
            });
            let given: Vec<&str> = ["cargo xtask"].into_iter().chain(words).collect();
            if let Err(error) = Arguments::try_parse_from(&given) {
                panic!("{}: `{}`: {error}", page.display(), given.join(" "));
            }
            count += 1;
        }
    }
    assert!(count > 20, "only {count} commands were found");
}
