//! `report.html` without a run: sections of words, tables and pictures on one page without outside parts.

use std::path::{Path, PathBuf};

use igimp_results::ResultsError;
use igimp_results::checkpoint::PROGRAM;
use igimp_results::summary::FigureNote;
use serde::Serialize;

use super::files::{Link, Picture, link, picture};
use super::template::filled;
use crate::error::ReportError;

/// The page; values are escaped as they are filled in.
const TEMPLATE: &str = include_str!("page.html");

/// A page.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Page {
    /// Subject of the page.
    pub title: String,
    /// Whether a reader should look twice.
    pub is_doubtful: bool,
    /// The outcome in a word or two.
    pub word: String,
    /// The outcome in sentences, below the title.
    pub sentences: Vec<String>,
    /// The sections in their order.
    #[serde(skip)]
    pub sections: Vec<Section>,
}

/// A section of a page; empty parts are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Its heading.
    pub title: String,
    /// Paragraphs.
    pub sentences: Vec<String>,
    /// Warnings for a reader before a number is used, as a list.
    pub warnings: Vec<String>,
    /// Tables.
    pub tables: Vec<PageTable>,
    /// A text as it stands in a file.
    pub text: String,
    /// Pictures of the folder, which are embedded.
    pub pictures: Vec<FigureNote>,
    /// Files of the folder, which are linked.
    pub files: Vec<String>,
}

/// A table.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct PageTable {
    /// Its text for those who hear the page.
    pub name: String,
    /// Its columns.
    pub columns: Vec<Column>,
    /// Its rows, a cell a column.
    pub rows: Vec<Vec<String>>,
}

/// A column of a table.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Column {
    /// Its heading.
    pub title: String,
    /// Whether it stands on the right.
    pub is_number: bool,
}

impl Column {
    /// A column of words.
    pub fn words(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            is_number: false,
        }
    }

    /// A column of numbers.
    pub fn numbers(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            is_number: true,
        }
    }
}

/// The values that the template fills in.
#[derive(Serialize)]
struct Filled<'a> {
    program: &'static str,
    class: &'static str,
    page: &'a Page,
    sections: Vec<FilledSection<'a>>,
}

#[derive(Serialize)]
struct FilledSection<'a> {
    id: String,
    title: &'a str,
    sentences: &'a [String],
    warnings: &'a [String],
    tables: &'a [PageTable],
    text: &'a str,
    pictures: Vec<Picture>,
    files: Vec<Link>,
}

impl Page {
    /// Writes `report.html` into a folder that has its pictures and files; its path.
    ///
    /// # Errors
    /// [`ResultsError::File`] if it cannot be written.
    pub fn write(&self, folder: &Path) -> Result<PathBuf, ReportError> {
        let path = folder.join("report.html");
        let failed = |source| ResultsError::File {
            path: path.clone(),
            source,
        };
        let sections = self.sections.iter().enumerate();
        let sections = sections.map(|(place, section)| FilledSection {
            id: format!("section-{}", place + 1),
            title: &section.title,
            sentences: &section.sentences,
            warnings: &section.warnings,
            tables: &section.tables,
            text: &section.text,
            pictures: (section.pictures.iter())
                .map(|note| picture(folder, note))
                .collect(),
            files: section.files.iter().map(|file| link(file, file)).collect(),
        });
        let filled = filled(
            "page.html",
            TEMPLATE,
            Filled {
                program: PROGRAM,
                class: if self.is_doubtful { "fair" } else { "good" },
                page: self,
                sections: sections.collect(),
            },
        );
        let page = filled.map_err(|source| failed(std::io::Error::other(source)))?;
        igimp_results::atomic::write_new(&path, page).map_err(failed)?;
        Ok(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: a page has the parts that it is given, signs of HTML as text, and no outside part. ORACLE: the text of the page.
    #[test]
    fn a_page_has_its_sections_as_text() {
        let folder = std::env::temp_dir().join(format!("igimp-page-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let page = Page {
            title: "c < φ & more".into(),
            is_doubtful: true,
            word: "Look twice".into(),
            sentences: vec!["<script>alert(1)</script>".into()],
            sections: vec![Section {
                title: "Numbers".into(),
                tables: vec![PageTable {
                    name: "numbers".into(),
                    columns: vec![Column::words("name"), Column::numbers("value")],
                    rows: vec![vec!["a".into(), "1.5".into()]],
                }],
                pictures: vec![FigureNote {
                    file: "none".into(),
                    caption: "A picture".into(),
                }],
                files: vec!["a b.csv".into()],
                ..Section::default()
            }],
        };
        let path = page.write(&folder).unwrap();
        let text = std::fs::read_to_string(path).unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
        for part in [
            "<h1>c &lt; φ &amp; more</h1>",
            "<span class=\"mark fair\">Look twice</span>",
            "<td>a</td><td class=\"n\">1.5</td>",
            "The picture none is missing.",
            "href=\"a%20b.csv\"",
            "<a href=\"#section-1\">Numbers</a>",
            "max-width: 78rem;",
        ] {
            assert!(text.contains(part), "{part}\n{text}");
        }
        for outside in ["<script>", "http://", "https://"] {
            assert!(!text.contains(outside), "{outside}");
        }
    }
}
