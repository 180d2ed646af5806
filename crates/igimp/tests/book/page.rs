//! Pages: blocks of code with the comments before them.

use std::fs;
use std::path::{Path, PathBuf};

/// A block of code on a page.
#[derive(Debug)]
pub(crate) struct Block {
    /// Comments right before it.
    pub(crate) marks: Vec<String>,
    pub(crate) language: String,
    pub(crate) text: String,
    /// Number of its first line, from 1.
    pub(crate) line: usize,
}

impl Block {
    pub(crate) fn mark(&self, name: &str) -> Option<&str> {
        self.marks
            .iter()
            .find_map(|mark| mark.strip_prefix(name).map(str::trim))
    }
}

pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The pages that are tried, from the root of the workspace.
pub(crate) fn pages() -> Vec<PathBuf> {
    let mut pages: Vec<PathBuf> = fs::read_dir(root().join("docs/src/guide"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|end| end == "md"))
        .collect();
    pages.sort();
    pages.extend(
        ["docs/src/tour.md", "docs/src/cases.md", "README.md"].map(|name| root().join(name)),
    );
    pages
}

/// The text between the marks of a comment on a line of its own.
pub(crate) fn comment(line: &str) -> Option<String> {
    let inner = line.trim().strip_prefix("<!--")?.strip_suffix("-->")?;
    Some(inner.trim().to_owned())
}

pub(crate) fn blocks(text: &str) -> Vec<Block> {
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

/// Holds a page against the text that it should be, or writes it anew.
pub(crate) fn hold(page: &Path, text: &str, should_be: &str) {
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
         Write it anew with `INSTA_UPDATE=always cargo test -p igimp --test book`.",
        page.strip_prefix(root()).unwrap_or(page).display(),
        line + 1,
        should_be.lines().nth(line).unwrap_or_default()
    );
}
