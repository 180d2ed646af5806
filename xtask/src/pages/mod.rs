//! Finishing built pages: the mathematics of the book and of rustdoc is set, and the links of the book are
//! checked. Those of rustdoc are checked by its lints, and its scripts make some of the anchors.

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

/// Built pages: their texts by their paths within a folder.
pub(crate) type Pages = BTreeMap<PathBuf, String>;

/// Sets the mathematics of all pages below a folder; the pages, and how many formulas they have.
///
/// # Errors
///
/// A file that cannot be read or written; formulas that cannot be set, all of them.
pub(crate) fn typeset(folder: &Path) -> Result<(Pages, usize), Failure> {
    let mut paths = Vec::new();
    html_files(folder, &mut paths)?;
    let (mut pages, mut problems, mut formulas) = (Pages::new(), Vec::new(), 0);
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
    refuse(&problems)?;
    Ok((pages, formulas))
}

/// Checks the links of all pages of a folder.
///
/// # Errors
///
/// Links that lead nowhere and files fetched from the network, all of them.
pub(crate) fn check_links(folder: &Path, pages: &Pages) -> Result<(), Failure> {
    refuse(&check::problems(pages, |path| folder.join(path).exists()))
}

fn refuse(problems: &[String]) -> Result<(), Failure> {
    if problems.is_empty() {
        return Ok(());
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

fn cannot(verb: &str, path: &Path, error: std::io::Error) -> Failure {
    Failure::input_output(format!("cannot {verb} {}", path.display()), error)
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
