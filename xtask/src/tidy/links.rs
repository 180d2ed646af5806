//! Links within the documents: every relative link leads to a file, every anchor to a heading, every
//! inclusion to a file, and every page of the book stands in its summary.

use std::fs;
use std::path::{Component, Path, PathBuf};

use crate::failure::Failure;

/// Documents beside the book.
const DOCUMENTS: [&str; 4] = [
    "README.md",
    "ARCHITECTURE.md",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
];
const BOOK: &str = "docs/src";
const SUMMARY: &str = "docs/src/SUMMARY.md";

/// A link as it is written, and where.
#[derive(Debug, PartialEq, Eq)]
struct Link {
    line: usize,
    target: String,
}

/// Problems with the links of the documents.
pub(super) fn check(root: &Path) -> Result<Vec<String>, Failure> {
    let [documents, pages] = documents(root)?;
    let mut problems = Vec::new();
    for page in documents.iter().chain(&pages) {
        let text = read(page)?;
        let folder = page.parent().unwrap_or(root);
        let shown = shown(page, root);
        for Link { line, target } in links(&text) {
            if let Some(problem) = problem_of(&target, page, folder, root)? {
                problems.push(format!("{shown}:{line}: `{target}` {problem}"));
            }
        }
    }
    let summary = read(&root.join(SUMMARY))?;
    let listed: Vec<String> = links(&summary)
        .into_iter()
        .map(|link| link.target)
        .collect();
    for page in &pages {
        let name = shown(page, &root.join(BOOK));
        if name != "SUMMARY.md" && !listed.contains(&name) {
            problems.push(format!("{SUMMARY}: `{name}` is not listed"));
        }
    }
    Ok(problems)
}

/// The documents beside the book, and the pages of the book.
pub(super) fn documents(root: &Path) -> Result<[Vec<PathBuf>; 2], Failure> {
    let mut pages = Vec::new();
    markdown_files(&root.join(BOOK), &mut pages)?;
    pages.sort();
    Ok([DOCUMENTS.map(|name| root.join(name)).to_vec(), pages])
}

/// The problem with a link of a page.
fn problem_of(
    target: &str,
    page: &Path,
    folder: &Path,
    root: &Path,
) -> Result<Option<String>, Failure> {
    let (path, anchor) = target.split_once('#').unwrap_or((target, ""));
    let file = if path.is_empty() {
        page.to_path_buf()
    } else {
        resolved(&folder.join(path))
    };
    if !file.exists() {
        return Ok(Some("leads nowhere".to_owned()));
    }
    let book = root.join(BOOK);
    if page.starts_with(&book) && !file.starts_with(&book) {
        return Ok(Some("leaves the book: give the address".to_owned()));
    }
    let is_page = file.extension().is_some_and(|extension| extension == "md");
    if anchor.is_empty() || !is_page {
        return Ok(None);
    }
    let known = anchors(&read(&file)?);
    Ok((!known.iter().any(|known| known == anchor))
        .then(|| "names a heading that is not there".to_owned()))
}

/// The relative links of a text outside code, with those of inclusions.
fn links(text: &str) -> Vec<Link> {
    let mut found = Vec::new();
    for (line, content) in outside_code(text) {
        let mut rest = content.as_str();
        while let Some(start) = rest.find("](") {
            rest = &rest[start + 2..];
            let end = rest.find(')').unwrap_or(rest.len());
            let target = rest[..end].split_whitespace().next().unwrap_or("");
            let is_address = target.contains("://") || target.starts_with("mailto:");
            if !is_address && !target.is_empty() {
                found.push(Link {
                    line,
                    target: target.to_owned(),
                });
            }
            rest = &rest[end..];
        }
    }
    for (index, content) in text.lines().enumerate() {
        let Some((_, rest)) = content.split_once("{{#include ") else {
            continue;
        };
        let target = rest.split(['}', ':', ' ']).next().unwrap_or("");
        found.push(Link {
            line: index + 1,
            target: target.to_owned(),
        });
    }
    found
}

/// Lines outside blocks of code, numbered from 1, without code in backquotes.
fn outside_code(text: &str) -> Vec<(usize, String)> {
    let mut fence: Option<String> = None;
    let mut lines = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let trimmed = line.trim_start();
        let ticks: String = trimmed.chars().take_while(|&c| c == '`').collect();
        match &fence {
            Some(open) if trimmed.trim_end() == open => fence = None,
            Some(_) => {}
            None if ticks.len() >= 3 => fence = Some(ticks),
            None => lines.push((index + 1, without_code(line))),
        }
    }
    lines
}

fn without_code(line: &str) -> String {
    let parts = line.split('`').enumerate();
    parts
        .filter(|(index, _)| index % 2 == 0)
        .map(|(_, part)| part)
        .collect()
}

/// The anchors of a text: those of its headings, as mdBook and GitHub make them, and `eq-N` for a
/// numbered equation, as the book makes it.
fn anchors(text: &str) -> Vec<String> {
    let mut fence: Option<String> = None;
    let mut slugs: Vec<String> = Vec::new();
    let mut anchors: Vec<String> = text
        .split("\\tag{")
        .skip(1)
        .filter_map(|rest| rest.split_once('}'))
        .map(|(number, _)| format!("eq-{number}"))
        .collect();
    for line in text.lines() {
        let ticks: String = line.chars().take_while(|&c| c == '`').collect();
        match &fence {
            Some(open) if line.trim_end() == open => fence = None,
            Some(_) => continue,
            None if ticks.len() >= 3 => fence = Some(ticks),
            None => {}
        }
        let Some(title) = line.strip_prefix('#') else {
            continue;
        };
        let anchor = slug(title.trim_start_matches('#').trim());
        anchors.push(
            match slugs.iter().filter(|known| **known == anchor).count() {
                0 => anchor.clone(),
                count => format!("{anchor}-{count}"),
            },
        );
        slugs.push(anchor);
    }
    anchors
}

fn slug(title: &str) -> String {
    title
        .chars()
        .filter_map(|c| match c {
            c if c.is_alphanumeric() || c == '_' || c == '-' => Some(c.to_ascii_lowercase()),
            c if c.is_whitespace() => Some('-'),
            _ => None,
        })
        .collect()
}

/// A path without `.` and `..`.
fn resolved(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => {
                out.pop();
            }
            Component::CurDir => {}
            part => out.push(part),
        }
    }
    out
}

pub(super) fn shown(path: &Path, root: &Path) -> String {
    let path = path.strip_prefix(root).unwrap_or(path);
    path.to_string_lossy().replace('\\', "/")
}

pub(super) fn read(path: &Path) -> Result<String, Failure> {
    fs::read_to_string(path)
        .map_err(|error| Failure::input_output(format!("cannot read {}", path.display()), error))
}

fn markdown_files(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), Failure> {
    let failure = |error| Failure::input_output(format!("cannot read {}", folder.display()), error);
    for entry in fs::read_dir(folder).map_err(failure)? {
        let path = entry.map_err(failure)?.path();
        if path.is_dir() {
            markdown_files(&path, files)?;
        } else if path.extension().is_some_and(|extension| extension == "md") {
            files.push(path);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_are_found_outside_code() {
        let text = "See [a](b.md#c) and `[x](y)`, [web](https://a.b).\n```sh\n[z](w)\n```\n\
                    ````text\n```\n[v](u)\n````\n![p](q.png)\n```python\n{{#include r.py}}\n```\n";
        let found: Vec<(usize, String)> = links(text)
            .into_iter()
            .map(|link| (link.line, link.target))
            .collect();
        let expected = [(1, "b.md#c"), (9, "q.png"), (11, "r.py")];
        assert_eq!(
            found,
            expected.map(|(line, target)| (line, target.to_owned()))
        );
    }

    #[test]
    fn headings_have_anchors() {
        let text = "# A tour\n## 4. Rigid footing, `x = 1`\n```sh\n# no heading\n```\n## Fields\n\
                    ## Fields\n";
        assert_eq!(
            anchors(text),
            ["a-tour", "4-rigid-footing-x--1", "fields", "fields-1"]
        );
        assert_eq!(anchors("```math\na = b\n\\tag{7a}\n```"), ["eq-7a"]);
    }

    #[test]
    fn paths_are_resolved() {
        assert_eq!(resolved(Path::new("/a/./b/../c.md")), Path::new("/a/c.md"));
    }
}
