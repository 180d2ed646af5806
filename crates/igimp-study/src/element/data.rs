//! Data of the laboratory: CSV, a column a quantity with its unit in the header, a row a measurement.

use std::path::Path;

use thiserror::Error;

use super::Drive;
use super::measure::{Measure, factor};
use super::table::driven;

/// Columns of the program's own table that nobody measures.
const NOT_MEASURED: [&str; 2] = ["plastic strain", "regime"];

/// Measurements of a test.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    /// The file.
    pub name: String,
    /// The measured quantities, beside the place on the way.
    pub columns: Vec<Measure>,
    /// The measurements.
    pub rows: Vec<Row>,
}

/// A measurement.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Its line in the file.
    pub line: u64,
    /// The strain that the test drives \[-\], or the legs of the path that were followed.
    pub at: f64,
    /// A value for every column in SI, signs as printed; not a number where nothing was measured.
    pub values: Vec<f64>,
}

/// Why a file holds no data.
#[derive(Debug, Error)]
pub enum DataError {
    /// It cannot be read.
    #[error("cannot access {name}: {source}")]
    File {
        /// The file.
        name: String,
        /// Why.
        source: std::io::Error,
    },
    /// A problem and its place.
    #[error("{name}, {place}: {problem}")]
    At {
        /// The file.
        name: String,
        /// Line and column.
        place: String,
        /// The problem.
        problem: String,
        /// The help.
        help: String,
    },
}

impl DataError {
    /// The help.
    pub fn help(&self) -> &str {
        match self {
            Self::File { .. } => "the data of a test are a CSV file",
            Self::At { help, .. } => help,
        }
    }

    pub(super) fn at(
        name: &str,
        (line, column): (u64, &str),
        problem: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        let place = if column.is_empty() {
            format!("line {line}")
        } else {
            format!("line {line}, column `{column}`")
        };
        Self::At {
            name: name.to_owned(),
            place,
            problem: problem.into(),
            help: help.into(),
        }
    }
}

/// The content of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Column {
    /// The place on the way, times a factor.
    Way(f64),
    /// Something measured, by its place among the columns, times a factor.
    Of(usize, f64),
    /// Nothing that is used.
    Unused,
}

/// Reads the data of a test. Columns are those of its own table, in any unit of their kind and any order; a line that begins with `#`
/// is a comment, and an empty cell was not measured. `variables` are internal variables of the law, which are passed over.
///
/// # Errors
/// [`DataError`], with file, line and column.
pub fn read_data(path: &Path, drive: &Drive, variables: &[&str]) -> Result<Data, DataError> {
    let name = path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|source| DataError::File {
        name: name.clone(),
        source,
    })?;
    parse_data(&name, &text, drive, variables)
}

/// Parses the data of a test from a text of a name, as [`read_data`] does.
///
/// # Errors
/// [`DataError::At`], with name, line and column.
pub fn parse_data(
    name: &str,
    text: &str,
    drive: &Drive,
    variables: &[&str],
) -> Result<Data, DataError> {
    let mut data = Data {
        name: name.to_owned(),
        columns: Vec::new(),
        rows: Vec::new(),
    };
    let mut header: Option<(Vec<String>, Vec<Column>)> = None;
    for (text, line) in text.lines().zip(1..) {
        if text.trim().is_empty() || text.trim_start().starts_with('#') {
            continue;
        }
        let record = record(text).map_err(|error| {
            DataError::at(name, (line, ""), error.to_string(), "the file is CSV")
        })?;
        let cells: Vec<&str> = record.iter().collect();
        match &header {
            None => {
                let columns = columns((name, line), &cells, drive, variables, &mut data.columns)?;
                header = Some((cells.iter().map(|&cell| cell.to_owned()).collect(), columns));
            }
            Some((names, columns)) => {
                let row = row((name, line), &cells, (names, columns), data.columns.len())?;
                data.rows.push(row);
            }
        }
    }
    let measured = |row: &Row| row.values.iter().any(|value| value.is_finite());
    if data.rows.iter().any(measured) {
        Ok(data)
    } else {
        let problem = "nothing is measured in this file";
        Err(DataError::at(name, (1, ""), problem, columns_help(drive)))
    }
}

/// The cells of a line.
fn record(line: &str) -> Result<csv::StringRecord, csv::Error> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .trim(csv::Trim::All)
        .from_reader(line.as_bytes());
    let mut record = csv::StringRecord::new();
    reader.read_record(&mut record)?;
    Ok(record)
}

/// The columns of a header.
fn columns(
    (name, line): (&str, u64),
    cells: &[&str],
    drive: &Drive,
    variables: &[&str],
    measured: &mut Vec<Measure>,
) -> Result<Vec<Column>, DataError> {
    let way = driven(drive);
    let mut columns = Vec::new();
    for &cell in cells {
        let refused = |text: String| DataError::at(name, (line, cell), text, columns_help(drive));
        let (words, unit) = match cell.split_once(['[', '(']) {
            Some((words, unit)) => (words, Some(unit.trim_end_matches([']', ')']).trim())),
            None => (cell, None),
        };
        let label = plain(words);
        if NOT_MEASURED.contains(&label.as_str()) || variables.contains(&label.as_str()) {
            columns.push(Column::Unused);
            continue;
        }
        if label == "leg" && way.is_none() {
            columns.push(Column::Way(1.0));
            continue;
        }
        let Some(measure) = Measure::of_test(drive).find(|of| of.name() == label) else {
            return Err(refused(format!("`{label}` is no quantity of this test")));
        };
        let Some(unit) = unit else {
            return Err(refused("the header says no unit".to_owned()));
        };
        let Some(scale) = factor(measure.is_stress(), unit) else {
            let kind = if measure.is_stress() {
                "stress"
            } else {
                "strain"
            };
            return Err(refused(format!("`{unit}` is no unit of a {kind}")));
        };
        if way == Some(measure) {
            columns.push(Column::Way(scale));
        } else if measured.contains(&measure) {
            return Err(refused(format!("`{label}` stands in two columns")));
        } else {
            columns.push(Column::Of(measured.len(), scale));
            measured.push(measure);
        }
    }
    let ways = columns
        .iter()
        .filter(|column| matches!(column, Column::Way(_)));
    if ways.count() == 1 {
        Ok(columns)
    } else {
        let problem = format!("one column is `{}`", way_header(drive));
        Err(DataError::at(
            name,
            (line, ""),
            problem,
            columns_help(drive),
        ))
    }
}

/// A row of numbers.
fn row(
    (name, line): (&str, u64),
    cells: &[&str],
    (names, columns): (&[String], &[Column]),
    measured: usize,
) -> Result<Row, DataError> {
    if cells.len() != columns.len() {
        let problem = format!("{} cells under {} headers", cells.len(), columns.len());
        let help =
            "a row has a cell for each header; leave a cell empty where nothing was measured";
        return Err(DataError::at(name, (line, ""), problem, help));
    }
    let mut row = Row {
        line,
        at: f64::NAN,
        values: vec![f64::NAN; measured],
    };
    for ((&cell, header), column) in cells.iter().zip(names).zip(columns) {
        if *column == Column::Unused || (cell.is_empty() && matches!(column, Column::Of(..))) {
            continue;
        }
        let number = cell.parse().ok().filter(|value: &f64| value.is_finite());
        let Some(number) = number else {
            let problem = if cell.is_empty() {
                "nothing says where on the way this was measured".to_owned()
            } else {
                format!("`{}` is no number", igimp_text::on_a_line(cell))
            };
            let help = "numbers with a decimal point, separated by commas";
            return Err(DataError::at(name, (line, header), problem, help));
        };
        match column {
            Column::Way(scale) => row.at = scale * number,
            Column::Of(place, scale) => row.values[*place] = scale * number,
            Column::Unused => {}
        }
    }
    Ok(row)
}

/// The words of a header without those on its sign.
fn plain(words: &str) -> String {
    let first = words
        .split(',')
        .next()
        .unwrap_or(words)
        .trim()
        .to_lowercase();
    let first = first.strip_prefix("shear ").unwrap_or(&first);
    let first = first.strip_suffix("effective").unwrap_or(first);
    first.trim().to_owned()
}

/// The header of the column that says where on the way something was measured.
fn way_header(drive: &Drive) -> String {
    driven(drive).map_or("leg".to_owned(), |strain| format!("{} [%]", strain.name()))
}

fn columns_help(drive: &Drive) -> String {
    let others = Measure::of_test(drive).filter(|measure| Some(*measure) != driven(drive));
    let others: Vec<&str> = others.map(Measure::name).collect();
    format!(
        "columns are {} and, with a unit such as [kPa] or [%], some of {}; compression is positive",
        way_header(drive),
        others.join(", ")
    )
}

impl Data {
    /// The place that lies furthest from the start, with its sign.
    pub fn furthest(&self) -> f64 {
        let further = |most: f64, row: &Row| {
            if row.at.abs() > most.abs() {
                row.at
            } else {
                most
            }
        };
        self.rows.iter().fold(0.0, further)
    }

    /// The ways of the rows on a test.
    ///
    /// # Errors
    /// [`DataError::At`] of a row that lies beyond its end, or on the other side of its start.
    pub(super) fn ways(&self, drive: &Drive) -> Result<Vec<f64>, DataError> {
        let (unit, legs) = match drive {
            Drive::Standard(_, end) => (*end, 1.0),
            Drive::Path(path) => (1.0, path.legs.len() as f64),
        };
        let way = |row: &Row| {
            let way = row.at / unit;
            if (-1e-9..=legs + 1e-9).contains(&way) {
                return Ok(way.clamp(0.0, legs));
            }
            let (problem, help) = match drive {
                Drive::Standard(..) => (
                    format!(
                        "the test goes from 0 to {} %, and this is {} %",
                        igimp_text::short(100.0 * unit),
                        igimp_text::short(100.0 * row.at)
                    ),
                    "--strain says how far a test goes; a path goes there and back",
                ),
                Drive::Path(_) => (
                    format!("the path has {legs} legs, and this is {}", row.at),
                    "`leg` counts the legs that were followed: 1.5 is half of the second",
                ),
            };
            Err(DataError::at(
                &self.name,
                (row.line, &way_header(drive)),
                problem,
                help,
            ))
        };
        self.rows.iter().map(way).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use igimp_solver::element::StandardTest;

    const TRIAXIAL: Drive = Drive::Standard(StandardTest::TriaxialDrained, 0.2);

    fn refused(text: &str) -> String {
        let error = parse_data("a.csv", text, &TRIAXIAL, &[]).unwrap_err();
        error.to_string()
    }

    /// GOAL: columns come in any order and unit, in the words of the program's own table too; holes are no measurements.
    #[test]
    fn columns_are_those_of_the_table_in_any_unit() {
        let headers =
            "# specimen 3\n\"q [MPa]\",\"strain_yy, compression positive [-]\",(ignored)\n";
        assert_eq!(
            refused(headers),
            "a.csv, line 2, column `(ignored)`: `` is no quantity of this test"
        );
        let text = "# specimen 3\nq (MPa),\"strain_yy, compression positive [-]\",\
                    \"p effective, compression positive [kPa]\",regime\n0.1,0.02,,0\n\n0.2,0.04,150,2\n";
        let data = parse_data("a.csv", text, &TRIAXIAL, &[]).unwrap();
        assert_eq!(data.columns, [Measure::Q, Measure::P]);
        assert_eq!((data.rows[0].line, data.rows[1].line), (3, 5));
        assert!(data.rows[0].values[1].is_nan() && (data.rows[0].at - 0.02).abs() < 1e-15);
        assert_eq!(data.rows[1].values, [200e3, 150e3]);
        let variables = ["softening strain"];
        let text = "strain_yy [%],q [kPa],softening strain [-]\n1,2,x\n";
        assert!(parse_data("a.csv", text, &TRIAXIAL, &variables).is_ok());
    }

    /// GOAL: what is no data is refused at its line and column.
    #[test]
    fn slips_are_refused_with_line_and_column() {
        for (text, words) in [
            (
                "strain_yy [%],q [kPa]\n1,2\n2,abc\n",
                "a.csv, line 3, column `q [kPa]`: `abc` is no number",
            ),
            (
                "strain_yy [%],q [kPa]\n,2\n",
                "a.csv, line 2, column `strain_yy [%]`: nothing says where on the way this was measured",
            ),
            (
                "strain_yy [%],q\n1,2\n",
                "a.csv, line 1, column `q`: the header says no unit",
            ),
            (
                "strain_yy [%],q [%]\n1,2\n",
                "a.csv, line 1, column `q [%]`: `%` is no unit of a stress",
            ),
            (
                "strain_yy [%],pore pressure [kPa]\n1,2\n",
                "a.csv, line 1, column `pore pressure [kPa]`: `pore pressure` is no quantity of this test",
            ),
            (
                "q [kPa]\n2\n",
                "a.csv, line 1: one column is `strain_yy [%]`",
            ),
            (
                "strain_yy [%],q [kPa],q [MPa]\n1,2,3\n",
                "a.csv, line 1, column `q [MPa]`: `q` stands in two columns",
            ),
            (
                "strain_yy [%],q [kPa]\n1\n",
                "a.csv, line 2: 1 cells under 2 headers",
            ),
            (
                "strain_yy [%],q [kPa]\n",
                "a.csv, line 1: nothing is measured in this file",
            ),
        ] {
            assert_eq!(refused(text), words);
        }
        let far = "strain_yy [%],q [kPa]\n25,2\n";
        let far = parse_data("a.csv", far, &TRIAXIAL, &[]).unwrap();
        assert_eq!(
            far.ways(&TRIAXIAL).unwrap_err().to_string(),
            "a.csv, line 2, column `strain_yy [%]`: the test goes from 0 to 20 %, and this is 25 %"
        );
    }
}
