//! Data of the laboratory beside the test that was computed.

use std::fmt::Write as _;

use igimp_results::tables::table::Table;
use igimp_solver::element::ElementState;
use igimp_text::short;

use super::Drive;
use super::data::Data;
use super::measure::Measure;
use super::table::driven;

/// Data, and the values of the test at the same places.
#[derive(Clone, Debug)]
pub struct Compared {
    /// The data.
    pub data: Data,
    /// Values of each row by the columns of the data, in SI; not a number beyond the early end of a test.
    pub computed: Vec<Vec<f64>>,
}

/// How far off a column is, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Off {
    /// Values that were measured and computed.
    pub values: usize,
    /// Root mean square of computed less measured.
    pub mean: f64,
    /// The largest difference by its size, and its line.
    pub largest: (f64, u64),
}

impl Compared {
    /// Takes the states of the rows; none where the test ended before.
    pub(super) fn new(
        data: Data,
        states: &[Option<&ElementState>],
        first: &ElementState,
        drive: &Drive,
    ) -> Self {
        let computed = (states.iter())
            .map(|state| {
                let value = |m: &Measure| state.map_or(f64::NAN, |at| m.of(at, first, drive));
                data.columns.iter().map(value).collect()
            })
            .collect();
        Self { data, computed }
    }

    /// Computed less measured of a column by lines, where both are known.
    pub(crate) fn differences(&self, column: usize) -> impl Iterator<Item = (u64, f64)> {
        (self.data.rows.iter().zip(&self.computed))
            .map(move |(row, computed)| (row.line, computed[column] - row.values[column]))
            .filter(|(_, difference)| difference.is_finite())
    }

    /// How far off a column is, if anything of it was measured and computed.
    pub fn off(&self, column: usize) -> Option<Off> {
        let (mut values, mut squares, mut largest) = (0, 0.0, (0.0, 0));
        for (line, difference) in self.differences(column) {
            values += 1;
            squares += difference * difference;
            if largest.1 == 0 || difference.abs() > f64::abs(largest.0) {
                largest = (difference, line);
            }
        }
        (values > 0).then(|| Off {
            values,
            mean: (squares / values as f64).sqrt(),
            largest,
        })
    }

    /// The columns of which nothing was computed, as the test ended before.
    pub(super) fn beyond(&self) -> impl Iterator<Item = Measure> {
        let columns = self.data.columns.iter().enumerate();
        columns.filter_map(|(place, measure)| self.off(place).is_none().then_some(*measure))
    }

    /// How far off a column is in print: values, root mean square, the largest difference and its line; dashes where nothing is known.
    pub(crate) fn off_in_words(&self, column: usize) -> [String; 4] {
        let measure = self.data.columns[column];
        let printed = |value: f64| format!("{} {}", short(measure.printed(value)), measure.unit());
        match self.off(column) {
            Some(off) => [
                off.values.to_string(),
                printed(off.mean),
                printed(off.largest.0),
                off.largest.1.to_string(),
            ],
            None => [(); 4].map(|()| "–".to_owned()),
        }
    }

    /// A line for each column.
    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        for (column, measure) in self.data.columns.iter().enumerate() {
            let unit = measure.unit();
            match self.off(column) {
                Some(off) => {
                    let _ = writeln!(
                        text,
                        "  measured {}, {} values of {}: root mean square difference {} {unit}, largest {} {unit} in line {}",
                        measure.name(),
                        off.values,
                        self.data.name,
                        short(measure.printed(off.mean)),
                        short(measure.printed(off.largest.0)),
                        off.largest.1,
                    );
                }
                None => {
                    let _ = writeln!(text, "  measured {}: beyond the early end", measure.name());
                }
            }
        }
        text
    }

    /// A row a measurement: measured, computed, and their difference.
    pub(super) fn table(&self, drive: &Drive) -> Table {
        let mut header = vec![
            "line".to_owned(),
            driven(drive).map_or("leg [-]".to_owned(), |strain| strain.header().to_owned()),
        ];
        for measure in &self.data.columns {
            for kind in ["measured", "computed", "computed less measured"] {
                header.push(format!("{kind}: {}", measure.header()));
            }
        }
        let columns: Vec<&str> = header.iter().map(String::as_str).collect();
        let mut table = Table::new("data", &columns);
        for (row, computed) in self.data.rows.iter().zip(&self.computed) {
            let at = driven(drive).map_or(row.at, |strain| strain.printed(row.at));
            let mut cells = vec![row.line as f64, at];
            for ((measure, measured), computed) in
                self.data.columns.iter().zip(&row.values).zip(computed)
            {
                let values = [*measured, *computed, computed - measured];
                cells.extend(values.map(|value| measure.printed(value)));
            }
            table.push(cells);
        }
        table
    }
}
