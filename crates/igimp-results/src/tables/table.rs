//! Curves as tables of numbers with units in the header, written as CSV.

use std::fmt::Write as _;
use std::path::Path;

use crate::atomic::create;
use crate::error::ResultsError;
use crate::tables::cells::{cell, number};

/// A named table of numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// File name without extension, such as `sigma_yy_along_column`.
    pub name: String,
    /// Column headers with unit and sign convention.
    pub header: Vec<String>,
    /// Rows, each as long as the header.
    pub rows: Vec<Vec<f64>>,
}

impl Table {
    /// An empty table.
    pub fn new(name: impl Into<String>, header: &[&str]) -> Self {
        let header = header.iter().map(|&column| column.to_owned()).collect();
        Self {
            name: name.into(),
            header,
            rows: Vec::new(),
        }
    }

    /// Appends a row.
    ///
    /// # Panics
    /// If the row is not as long as the header.
    pub fn push(&mut self, row: Vec<f64>) {
        assert_eq!(
            row.len(),
            self.header.len(),
            "a row of {} has one entry a column",
            self.name
        );
        self.rows.push(row);
    }

    /// The table with the digits that its file holds. Pictures are drawn from it: a run that is taken up reads the rows before, and
    /// draws the same.
    #[must_use]
    pub fn as_written(&self) -> Self {
        let digits =
            |(column, value): (&String, &f64)| number(column, *value).parse().unwrap_or(*value);
        let rows = self.rows.iter();
        Self {
            name: self.name.clone(),
            header: self.header.clone(),
            rows: rows
                .map(|row| std::iter::zip(&self.header, row).map(digits).collect())
                .collect(),
        }
    }

    /// Two columns as points of a curve.
    pub fn points(&self, x: usize, y: usize) -> Vec<[f64; 2]> {
        self.rows.iter().map(|row| [row[x], row[y]]).collect()
    }

    /// Writes `NAME.csv` into a folder that exists.
    ///
    /// # Errors
    /// [`ResultsError::Table`].
    pub fn write_csv(&self, folder: &Path) -> Result<(), ResultsError> {
        let path = folder.join(format!("{}.csv", self.name));
        let write = || -> Result<(), csv::Error> {
            let mut writer = csv::Writer::from_writer(create(&path)?);
            writer.write_record(self.header.iter().map(|column| cell(column).into_owned()))?;
            for row in &self.rows {
                let entries = std::iter::zip(&self.header, row);
                writer.write_record(entries.map(|(column, value)| number(column, *value)))?;
            }
            Ok(writer.flush()?)
        };
        write().map_err(|source| ResultsError::Table {
            path: path.clone(),
            source,
        })
    }

    /// The table as aligned text with at most `most` rows, evenly picked, first and last included.
    pub fn to_text(&self, most: usize) -> String {
        let mut text = String::new();
        let widths: Vec<usize> = self
            .header
            .iter()
            .map(|column| column.chars().count().max(13))
            .collect();
        for (column, width) in self.header.iter().zip(&widths) {
            let _ = write!(text, "{column:>width$}  ");
        }
        let picked = self.rows.len().min(most);
        for k in 0..picked {
            text.truncate(text.trim_end().len());
            text.push('\n');
            let row = if picked < 2 {
                0
            } else {
                k * (self.rows.len() - 1) / (picked - 1)
            };
            for (value, width) in self.rows[row].iter().zip(&widths) {
                let _ = write!(text, "{value:>width$.6e}  ");
            }
        }
        text.truncate(text.trim_end().len());
        text.push('\n');
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_thinned_to_first_and_last() {
        let mut table = Table::new("curve", &["x [m]", "sigma_yy [kPa]"]);
        for k in 0..101 {
            table.push(vec![f64::from(k), -2.0 * f64::from(k)]);
        }
        let text = table.to_text(3);
        let lines: Vec<Vec<&str>> = text
            .lines()
            .map(|line| line.split_whitespace().collect())
            .collect();
        assert_eq!(lines[0], ["x", "[m]", "sigma_yy", "[kPa]"]);
        assert_eq!(lines[1], ["0.000000e0", "-0.000000e0"]);
        assert_eq!(lines[2], ["5.000000e1", "-1.000000e2"]);
        assert_eq!(lines[3], ["1.000000e2", "-2.000000e2"]);
        assert_eq!(lines.len(), 4);
        assert!(
            text.lines()
                .all(|line| line.len() == text.lines().next().map_or(0, str::len))
        );
    }
}
