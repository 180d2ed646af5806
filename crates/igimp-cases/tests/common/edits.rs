//! Case files after edits.

/// Passages of a file, and what stands in their places.
pub(crate) type Edits<'a> = &'a [(&'a str, &'a str)];

#[track_caller]
pub(crate) fn edited(text: &str, edits: Edits<'_>) -> String {
    edits.iter().fold(text.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "`{from}` is not in the file");
        text.replacen(from, to, 1)
    })
}
