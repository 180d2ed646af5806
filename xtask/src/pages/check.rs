//! Links of built pages: every one within the folder leads to a file, every anchor to an element, every
//! picture is there, and nothing that a page needs is fetched from elsewhere.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};

use super::html::{Tag, tags, unescaped};

/// A page as the check sees it.
#[derive(Debug, Default)]
struct Page {
    anchors: BTreeSet<String>,
    /// Links and pictures as written, and whether the page needs them to be shown.
    targets: Vec<(String, bool)>,
}

impl Page {
    fn read(html: &str) -> Self {
        let mut page = Self::default();
        for tag in tags(html) {
            for name in ["id", "name"] {
                page.anchors.extend(tag.attribute(name).map(unescaped));
            }
            page.targets.extend(target(&tag));
        }
        page
    }
}

/// Where a tag leads, and whether the page needs it to be shown.
fn target(tag: &Tag<'_>) -> Option<(String, bool)> {
    let (attribute, needed) = match tag.name {
        "a" => ("href", false),
        "link" => ("href", tag.attribute("rel") == Some("stylesheet")),
        "img" | "script" | "source" | "iframe" => ("src", true),
        _ => return None,
    };
    Some((unescaped(tag.attribute(attribute)?), needed))
}

/// Problems with the links of the pages; pages by their path, files that are no pages by `exists`.
pub(super) fn problems(
    pages: &BTreeMap<PathBuf, String>,
    exists: impl Fn(&Path) -> bool,
) -> Vec<String> {
    let read: BTreeMap<&Path, Page> = pages
        .iter()
        .map(|(path, html)| (path.as_path(), Page::read(html)))
        .collect();
    let mut problems = Vec::new();
    for (path, page) in &read {
        for (target, needed) in &page.targets {
            let problem = if target.contains("://") || target.starts_with("//") {
                needed.then_some("is fetched from the network")
            } else if target.starts_with("mailto:") || target.starts_with("javascript:") {
                None
            } else {
                problem_of(target, path, &read, &exists)
            };
            if let Some(problem) = problem {
                problems.push(format!("{}: `{target}` {problem}", path.display()));
            }
        }
    }
    problems
}

fn problem_of(
    target: &str,
    from: &Path,
    pages: &BTreeMap<&Path, Page>,
    exists: &impl Fn(&Path) -> bool,
) -> Option<&'static str> {
    let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
    let file = decoded(file.split('?').next().unwrap_or(""));
    let to = if file.is_empty() {
        from.to_owned()
    } else {
        resolved(&from.parent().unwrap_or(Path::new("")).join(file))
    };
    match pages.get(to.as_path()) {
        Some(page) if anchor.is_empty() || page.anchors.contains(&decoded(anchor)) => None,
        Some(_) => Some("names an anchor that is not there"),
        None if exists(&to) => None,
        None => Some("leads nowhere"),
    }
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

/// A text with its `%XX` undone.
fn decoded(text: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        let code = after.get(..2).filter(|_| *first == b'%');
        let code = code.and_then(|code| std::str::from_utf8(code).ok());
        if let Some(byte) = code.and_then(|code| u8::from_str_radix(code, 16).ok()) {
            bytes.push(byte);
            rest = &after[2..];
        } else {
            bytes.push(*first);
            rest = after;
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(html: &str) -> Vec<String> {
        let pages = BTreeMap::from([
            (PathBuf::from("guide/a.html"), html.to_owned()),
            (
                PathBuf::from("b.html"),
                "<h1 id=\"größe\">B</h1>".to_owned(),
            ),
        ]);
        problems(&pages, |path| path == Path::new("c.png"))
    }

    #[test]
    fn links_that_lead_somewhere_are_fine() {
        let page = "<p id=x><a href=\"#x\"></a><a href=\"../b.html#gr%C3%B6%C3%9Fe\"></a>\
                    <img src=\"../c.png\"><a href=\"https://a.b\"></a><a href=\"../b.html?q=1\"></a>";
        assert_eq!(of(page), [""; 0]);
    }

    #[test]
    fn dead_links_are_reported() {
        for page in [
            "<a href=\"b.html\"></a>",
            "<a href=\"../b.html#none\"></a>",
            "<a href=\"#none\"></a>",
            "<img src=\"c.png\">",
            "<script src=\"https://a.b/c.js\"></script>",
            "<link rel=\"stylesheet\" href=\"https://a.b/c.css\">",
        ] {
            assert_eq!(of(page).len(), 1, "{page}");
        }
    }
}
