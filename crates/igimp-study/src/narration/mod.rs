//! Texts about a case and its run: before it, while it goes on, and at its end. The program and
//! the Python package say the same.

pub mod lines;
pub mod progress;
pub mod size;
pub mod verdict;

use std::fmt::Write as _;

use crate::sweep::aligned;

/// Rows as aligned columns, indented by two.
pub fn table(rows: &[Vec<String>]) -> String {
    let mut text = String::new();
    for line in aligned(rows).lines() {
        let _ = writeln!(text, "  {line}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned() {
        let rows = [["a", "bb"], ["ccc", "d"]].map(|row| row.map(str::to_owned).to_vec());
        assert_eq!(table(&rows), "  a    bb\n  ccc  d\n");
    }
}
