//! Values of a parameter as numbers: a column of a table that a spreadsheet can draw.

use std::collections::BTreeSet;

use igimp_results::tables::cells::cell;
use igimp_schema::quantity::{Quantity, split};
use igimp_text::on_a_line;

/// A parameter in a table: its header, and its cell in each row.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    pub(super) header: String,
    pub cells: Vec<String>,
    /// The numbers of the cells, if they are numbers.
    pub(super) numbers: Option<Vec<f64>>,
}

/// The column of a key, of its values as TOML: numbers in the unit that all of them have, or in SI units
/// where they have several; else the values as they are written.
pub(super) fn column(key: &str, values: &[&str]) -> Column {
    let texts: Vec<&str> = values.iter().map(|value| value.trim_matches('"')).collect();
    let parts: Option<Vec<(f64, &str)>> = texts.iter().map(|text| split(text.trim())).collect();
    let as_written = || {
        let parts = parts.as_ref()?;
        let units: BTreeSet<&str> = parts.iter().map(|(_, unit)| *unit).collect();
        let unit = units.first().filter(|_| units.len() == 1)?;
        let is_known = unit.is_empty() || texts.iter().all(|text| Quantity::parse(text).is_ok());
        let numbers = parts.iter().map(|(number, _)| *number).collect();
        is_known.then(|| (unit.to_string(), numbers))
    };
    let in_si = || {
        let quantities: Vec<Quantity> = texts
            .iter()
            .map(|text| Quantity::parse(text).ok())
            .collect::<Option<_>>()?;
        let dimension = quantities.first()?.dimension?;
        let all = quantities
            .iter()
            .all(|one| one.dimension == Some(dimension));
        let numbers: Vec<f64> = quantities.iter().map(|one| one.value).collect();
        all.then(|| (dimension.si_unit().to_owned(), numbers))
    };
    match as_written().or_else(in_si) {
        Some((unit, numbers)) => Column {
            header: match &unit[..] {
                "" => key.to_owned(),
                unit => format!("{key} [{unit}]"),
            },
            cells: numbers.iter().map(f64::to_string).collect(),
            numbers: Some(numbers),
        },
        None => Column {
            header: key.to_owned(),
            cells: texts
                .iter()
                .map(|text| cell(&on_a_line(text)).into_owned())
                .collect(),
            numbers: None,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_become_numbers() {
        let of = |values: &[&str]| {
            let found = column("key", values);
            (found.header, found.cells.join("|"))
        };
        let pair = |header: &str, cells: &str| (header.to_owned(), cells.to_owned());
        assert_eq!(
            of(&["\"8 kPa\"", "\"-10.5 kPa\""]),
            pair("key [kPa]", "8|-10.5")
        );
        assert_eq!(
            of(&["\"8 kPa\"", "\"1 MPa\""]),
            pair("key [Pa]", "8000|1000000")
        );
        assert_eq!(of(&["5", "0.25"]), pair("key", "5|0.25"));
        assert_eq!(of(&["\"8 kPa\"", "\"1 m\""]), pair("key", "8 kPa|1 m"));
        assert_eq!(of(&["\"-5 m\"", "\"=1\""]), pair("key", "'-5 m|'=1"));
        assert_eq!(of(&["\"b-bar\"", "true"]), pair("key", "b-bar|true"));
        assert_eq!(of(&["[1, 2]"]), pair("key", "[1, 2]"));
    }
}
