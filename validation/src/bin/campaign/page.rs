//! The tables in the book, between their marks.

use std::path::Path;

use igimp_cases::CaseError;
use igimp_results::ResultsError;

/// Where the tables stand in the book.
pub(crate) const PAGE: &str = "docs/src/hard-numerics.md";

/// Writes a file.
pub(crate) fn write_file(path: &Path, text: &str) -> Result<(), CaseError> {
    std::fs::write(path, text).map_err(|source| file(path, source))
}

/// Puts a table between its marks in a page.
pub(crate) fn fill(path: &Path, name: &str, table: &str) -> Result<(), CaseError> {
    let page = std::fs::read_to_string(path).map_err(|source| file(path, source))?;
    let filled = between(&page, name, table).ok_or_else(|| {
        let text = format!("no marks <!-- {name}:begin --> and <!-- {name}:end -->");
        file(
            path,
            std::io::Error::new(std::io::ErrorKind::InvalidData, text),
        )
    })?;
    write_file(path, &filled)
}

fn file(path: &Path, source: std::io::Error) -> CaseError {
    let path = path.to_owned();
    ResultsError::File { path, source }.into()
}

/// The page with another text between the marks of a name.
fn between(page: &str, name: &str, text: &str) -> Option<String> {
    let begin = format!("<!-- {name}:begin -->");
    let (before, rest) = page.split_once(&begin)?;
    let end = format!("<!-- {name}:end -->");
    let (_, after) = rest.split_once(&end)?;
    Some(format!("{before}{begin}\n\n{text}\n{end}{after}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: only the text between the marks is replaced.
    /// ORACLE: the page by hand.
    #[test]
    fn the_rest_of_the_page_stays() {
        let page = "a\n<!-- x:begin -->old<!-- x:end -->\nb\n";
        let filled = between(page, "x", "new").unwrap();
        assert_eq!(filled, "a\n<!-- x:begin -->\n\nnew\n<!-- x:end -->\nb\n");
        assert_eq!(between(page, "y", "new"), None);
    }
}
