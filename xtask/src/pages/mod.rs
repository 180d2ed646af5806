//! Finishing built pages, those of the book and those of rustdoc: mathematics is set, links are checked.

mod check;
mod html;
mod mathematics;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::failure::{FOUND, Failure};
use crate::metadata::Metadata;

/// The package whose source holds the font for mathematics, and where.
const FONT: (&str, &str) = ("pulldown-latex", "font/latinmodern-math.woff2");

/// Style of formulas; `FONT` stands for the path to the font.
const STYLE: &str = include_str!("math.css");

/// How many pages and formulas there were.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Finished {
    pub(crate) pages: usize,
    pub(crate) formulas: usize,
}

/// Sets the mathematics of all pages below a folder, and checks their links.
///
/// # Errors
///
/// A file that cannot be read or written; formulas that cannot be set and links that lead nowhere, all
/// of them.
pub(crate) fn finish(folder: &Path) -> Result<Finished, Failure> {
    let mut paths = Vec::new();
    html_files(folder, &mut paths)?;
    let (mut pages, mut problems, mut formulas) = (BTreeMap::new(), Vec::new(), 0);
    let font = format!("fonts/{}", FONT.1.rsplit('/').next().unwrap_or_default());
    for path in paths {
        let shown = path.strip_prefix(folder).unwrap_or(&path).to_path_buf();
        let text = fs::read_to_string(&path).map_err(|error| cannot("read", &path, error))?;
        let set = mathematics::typeset(&text);
        let named = |problem| format!("{}: {problem}", shown.display());
        problems.extend(set.problems.into_iter().map(named));
        formulas += set.formulas;
        let text = if set.formulas == 0 {
            text
        } else {
            let up = "../".repeat(shown.components().count() - 1);
            let style = STYLE.replace("FONT", &format!("{up}{font}"));
            let page =
                set.html
                    .replacen("</head>", &format!("<style>\n{style}</style>\n</head>"), 1);
            fs::write(&path, &page).map_err(|error| cannot("write", &path, error))?;
            page
        };
        pages.insert(shown, text);
    }
    if formulas > 0 {
        copy_font(&folder.join(font))?;
    }
    problems.extend(check::problems(&pages, |path| folder.join(path).exists()));
    if problems.is_empty() {
        return Ok(Finished {
            pages: pages.len(),
            formulas,
        });
    }
    let message = format!("problems: {}\n  {}", problems.len(), problems.join("\n  "));
    Err(Failure::new(FOUND, message))
}

/// Puts the font for mathematics beside the pages.
fn copy_font(to: &Path) -> Result<(), Failure> {
    let metadata = Metadata::of_workspace()?;
    let package = metadata.packages().find(|package| package.name == FONT.0);
    let from = package
        .map(|package| package.folder.join(FONT.1))
        .unwrap_or_default();
    let made = fs::create_dir_all(to.parent().unwrap_or(to)).and_then(|()| fs::copy(&from, to));
    made.map(|_| ())
        .map_err(|error| cannot("copy", &from, error))
}

fn cannot(what: &str, path: &Path, error: std::io::Error) -> Failure {
    Failure::input_output(format!("cannot {what} {}", path.display()), error)
}

fn html_files(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), Failure> {
    for entry in fs::read_dir(folder).map_err(|error| cannot("read", folder, error))? {
        let path = entry.map_err(|error| cannot("read", folder, error))?.path();
        if path.is_dir() {
            html_files(&path, files)?;
        } else if path.extension().is_some_and(|end| end == "html") {
            files.push(path);
        }
    }
    Ok(())
}
