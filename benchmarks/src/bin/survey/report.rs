//! What a survey found: tables for readers, rows for comparisons.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use igimp_benchmarks::BenchResult;

use super::rounds::Rounds;

/// Tables in Markdown and rows in CSV.
#[derive(Debug, Default)]
pub(crate) struct Report {
    tables: String,
    rows: String,
}

/// Header of the rows, the same as that of the report of all benches.
const HEADER: &str = "group,bench,size,unit,value,low,high\n";

impl Report {
    /// Adds a row: the median and the quartiles of a quantity.
    pub(crate) fn row(&mut self, group: &str, bench: &str, size: usize, unit: &str, of: &Rounds) {
        let (value, [low, high]) = (of.median(), of.quartiles());
        // Writing to a string cannot fail.
        let _ = writeln!(
            self.rows,
            "survey/{group},{bench},{size},{unit},{value:.4},{low:.4},{high:.4}"
        );
    }

    /// Adds a heading.
    pub(crate) fn heading(&mut self, text: &str) {
        let _ = writeln!(self.tables, "## {text}\n");
    }

    /// Adds a paragraph.
    pub(crate) fn paragraph(&mut self, text: &str) {
        let _ = writeln!(self.tables, "{text}\n");
    }

    /// Adds a table; all columns but the first are set flush right.
    pub(crate) fn table<const N: usize>(&mut self, header: [&str; N], rows: &[[String; N]]) {
        let _ = writeln!(self.tables, "{}", table(header, rows));
    }

    /// Writes `tables.md` and `rows.csv`.
    pub(crate) fn write(&self, folder: &Path) -> BenchResult {
        fs::create_dir_all(folder)?;
        fs::write(folder.join("tables.md"), &self.tables)?;
        fs::write(folder.join("rows.csv"), format!("{HEADER}{}", self.rows))?;
        Ok(())
    }
}

fn table<const N: usize>(header: [&str; N], rows: &[[String; N]]) -> String {
    let width = |column: usize| {
        let cells = rows.iter().map(|row| row[column].chars().count());
        cells
            .chain([header[column].chars().count()])
            .max()
            .unwrap_or(0)
    };
    let widths: [usize; N] = std::array::from_fn(width);
    let line = |cells: [&str; N]| {
        let padded = std::iter::zip(cells, widths).enumerate();
        let cells: Vec<String> = padded
            .map(|(column, (cell, width))| match column {
                0 => format!("{cell:<width$}"),
                _ => format!("{cell:>width$}"),
            })
            .collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let rule = widths.iter().enumerate().map(|(column, &width)| {
        let end = if column == 0 { '-' } else { ':' };
        format!("|{}{end}", "-".repeat(width + 1))
    });
    let rule = format!("{}|\n", rule.collect::<String>());
    let lines = rows
        .iter()
        .map(|row| line(row.each_ref().map(String::as_str)));
    [line(header), rule].into_iter().chain(lines).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_aligned() {
        let rows = [
            ["von Mises".to_owned(), "7".to_owned()],
            ["τ".to_owned(), "12".to_owned()],
        ];
        let expected = "\
| law       | ns |
|-----------|---:|
| von Mises |  7 |
| τ         | 12 |
";
        assert_eq!(table(["law", "ns"], &rows), expected);
    }

    #[test]
    fn rows_hold_median_and_quartiles() {
        let mut report = Report::default();
        report.row(
            "cost",
            "lu/factor",
            20,
            "ns/unknown",
            &Rounds(vec![1.0, 2.0, 3.0]),
        );
        assert_eq!(
            report.rows,
            "survey/cost,lu/factor,20,ns/unknown,2.0000,1.5000,2.5000\n"
        );
    }
}
