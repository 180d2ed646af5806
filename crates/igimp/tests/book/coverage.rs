//! Every block of code in the book is tried, made by the program, or says why it is not.

use std::fs;
use std::path::{Path, PathBuf};

use crate::page::{Block, blocks, pages, root};

/// Marks that hold a block against the program, or say why it is not.
const MARKS: [&str; 7] = [
    "not tried:",
    "gives",
    "of:",
    "file:",
    "from:",
    "added to:",
    "tried by:",
];

/// All pages of the book, and the documents beside it that show commands.
fn all_pages() -> Vec<PathBuf> {
    fn collect(folder: &Path, pages: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                collect(&path, pages);
            } else if path.extension().is_some_and(|end| end == "md") {
                pages.push(path);
            }
        }
    }
    let mut pages = Vec::new();
    collect(&root().join("docs/src"), &mut pages);
    pages.extend(["README.md", "CONTRIBUTING.md"].map(|name| root().join(name)));
    pages.sort();
    pages
}

/// Whether the documentation tests of the crate include a page.
fn is_doctested(page: &Path) -> bool {
    let source = include_str!("../../../igimp-study/src/lib.rs");
    let path = page.strip_prefix(root()).unwrap().display().to_string();
    source.contains(&format!("include_str!(\"../../../{path}\")"))
}

/// Whether every line is a command of cargo, whose words `xtask` and `cargo` themselves check.
fn is_of_cargo(block: &Block) -> bool {
    let commands = block.text.lines().filter(|line| !line.trim().is_empty());
    commands.into_iter().all(|line| {
        let is_setting = |word: &&str| word.contains('=') && !word.starts_with('-');
        let mut words = line.split_whitespace().skip_while(is_setting);
        words.next() == Some("cargo") && !line.contains(" run ")
    })
}

fn is_covered(page: &Path, block: &Block) -> bool {
    let is_run = pages().contains(&page.to_path_buf());
    let begins = |start: &str| block.text.lines().any(|line| line.starts_with(start));
    let is_marked = MARKS.iter().any(|mark| block.mark(mark).is_some());
    is_marked
        || match block.language.as_str() {
            "math" => true,
            "rust" => is_doctested(page),
            "sh" => (is_run && begins("igimp ")) || is_of_cargo(block),
            "console" => is_run && begins("$ igimp "),
            "python" => is_run,
            "text" => block.marks.iter().any(|mark| mark.contains(".toml: ")),
            _ => false,
        }
}

#[test]
fn every_block_is_tried_or_says_why_not() {
    let (mut count, mut idle) = (0, Vec::new());
    for page in all_pages() {
        for block in blocks(&fs::read_to_string(&page).unwrap()) {
            count += 1;
            if !is_covered(&page, &block) {
                let page = page.strip_prefix(root()).unwrap().display().to_string();
                idle.push(format!("{page}:{} ({})", block.line, block.language));
            }
        }
    }
    assert!(idle.is_empty(), "no test looks at\n{}", idle.join("\n"));
    assert!(count > 120, "only {count} blocks were found");
}

/// The files of the workspace that commands on the pages name.
#[test]
fn files_that_commands_name_are_there() {
    let folders = ["crates/", "benchmarks/", "docs/", "validation/"];
    let mut count = 0;
    for page in all_pages() {
        for block in blocks(&fs::read_to_string(&page).unwrap()) {
            let words = block.text.split_whitespace();
            let is_command = block.language == "sh";
            let named = words.filter(|word| folders.iter().any(|folder| word.starts_with(folder)));
            for name in named.filter(|_| is_command) {
                let place = format!("{}:{}", page.display(), block.line);
                assert!(root().join(name).exists(), "{place}: there is no {name}");
                count += 1;
            }
        }
    }
    assert!(count >= 3, "only {count} names were found");
}
