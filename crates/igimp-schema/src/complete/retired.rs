//! Keys of earlier versions, and what took their place: a file with one of them is refused, and its message says what to write.

/// Keys that went or are met elsewhere, with the table that they stood in and the remedy.
const RETIRED: [(&str, &str, &str); 3] = [
    ("grid", "bbar", LOCKING),
    ("grid", "b_bar", LOCKING),
    ("grid", "b-bar", LOCKING),
];

const LOCKING: &str = "`bbar` is `locking` now: locking = \"b-bar\" for bbar = true, \"none\" for bbar = false, and \"shared-strain\" is the default";

/// The successor of a key of a table; the name of the table may not be known.
pub(super) fn remedy(table: Option<&str>, key: &str) -> Option<&'static str> {
    let is_meant =
        |row: &&(&str, &str, &str)| row.1 == key && table.is_none_or(|table| table == row.0);
    RETIRED.iter().find(is_meant).map(|row| row.2)
}

#[cfg(test)]
mod tests {
    use super::*;

    // GOAL: a key that went is met with its successor, in its table alone.
    // ORACLE: the change log.
    #[test]
    fn a_key_that_went_names_its_successor() {
        let help = remedy(Some("grid"), "bbar").unwrap();
        assert!(help.contains("locking = \"b-bar\""), "{help}");
        assert_eq!(remedy(Some("grid"), "b_bar"), Some(help));
        assert_eq!(remedy(Some("grid"), "b-bar"), Some(help));
        assert_eq!(remedy(Some("solver"), "bbar"), None);
        assert_eq!(remedy(Some("grid"), "cell"), None);
    }
}
