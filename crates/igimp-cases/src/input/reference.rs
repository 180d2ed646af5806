//! The schema as tables, for the book.

/// Reference of the case file in Markdown.
pub fn reference_markdown() -> String {
    String::new()
}
