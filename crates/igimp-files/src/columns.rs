//! Columns of numbers in CSV files: a header that may say units, `#` before comments.

use igimp_schema::text::clip;

use crate::named::Trouble;

/// The columns of a file.
#[derive(Debug)]
pub(crate) struct Columns {
    /// The unit of each column, if the header says one: `ft` in `x [ft]` and `x (ft)`.
    pub(crate) units: Vec<Option<String>>,
    /// The name of each column in lower case, if there is a header.
    pub(crate) names: Vec<Option<String>>,
    /// Rows of as many numbers as there are columns.
    pub(crate) rows: Vec<Vec<f64>>,
    /// The line of each row.
    pub(crate) lines: Vec<usize>,
}

/// Reads columns of these names; a header may be missing, and may not name them in another order.
pub(crate) fn columns(text: &str, names: &[&str]) -> Result<Columns, Trouble> {
    let mut found = Columns {
        units: vec![None; names.len()],
        names: vec![None; names.len()],
        rows: Vec::new(),
        lines: Vec::new(),
    };
    let written = text.lines().zip(1..).map(|(line, at)| (line.trim(), at));
    let mut written = written.filter(|(line, _)| !line.is_empty() && !line.starts_with('#'));
    if let Some((first, at)) = written.next() {
        let cells: Vec<&str> = first.split(',').map(bare).collect();
        let has_numbers = cells.iter().any(|cell| number(cell).is_some());
        if has_numbers || cells.len() != names.len() {
            row((first, at), names, &mut found)?;
        } else {
            header(&cells, names, &mut found)?;
        }
    }
    for line in written {
        row(line, names, &mut found)?;
    }
    if found.rows.is_empty() {
        return Err(Trouble::new(
            "it has no rows of numbers",
            format_args!("its columns are {}", names.join(", ")),
        ));
    }
    Ok(found)
}

/// Adds a row.
fn row((text, line): (&str, usize), names: &[&str], found: &mut Columns) -> Result<(), Trouble> {
    let cells = || text.split(',').map(bare);
    if cells().count() == names.len() && cells().any(str::is_empty) {
        return Err(Trouble::new(
            format_args!("line {line}, `{}`, has a hole", clip(text, 40)),
            format_args!("every row has all of {}", names.join(", ")),
        ));
    }
    let numbers: Option<Vec<f64>> = cells().map(number).collect();
    let numbers = numbers.filter(|numbers| numbers.len() == names.len());
    let Some(numbers) = numbers else {
        return Err(Trouble::new(
            format_args!(
                "line {line}, `{}`, does not hold {} numbers",
                clip(text, 40),
                names.len()
            ),
            format_args!(
                "its columns are {}, with commas between them and decimal points",
                names.join(", ")
            ),
        ));
    };
    found.rows.push(numbers);
    found.lines.push(line);
    Ok(())
}

/// A cell without spaces and quotes.
fn bare(cell: &str) -> &str {
    cell.trim().trim_matches('"').trim()
}

fn number(cell: &str) -> Option<f64> {
    cell.parse().ok().filter(|value: &f64| value.is_finite())
}

fn header(cells: &[&str], names: &[&str], found: &mut Columns) -> Result<(), Trouble> {
    for (column, cell) in cells.iter().enumerate() {
        let (name, unit) = match cell.split_once(['[', '(']) {
            Some((name, rest)) => (name, Some(rest.trim_end_matches([']', ')']).to_owned())),
            None => (*cell, None),
        };
        let name = name.trim().to_lowercase();
        let place = names.iter().position(|known| *known == name);
        if place.is_some_and(|place| place != column) {
            return Err(Trouble::new(
                format_args!("its column {} is `{name}`", column + 1),
                format_args!("its columns are {}, in this order", names.join(", ")),
            ));
        }
        found.units[column] = unit.filter(|unit| !unit.trim().is_empty());
        found.names[column] = Some(name);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::columns;

    #[test]
    fn headers_say_units_and_may_be_missing() {
        let read = |text: &str| columns(text, &["x", "y"]).map_err(|trouble| trouble.message);
        let found = read("# survey\nx [ft], y (ft)\n0, 1\n\n2.5,3e1\n").unwrap();
        assert_eq!(found.units, [Some("ft".to_owned()), Some("ft".to_owned())]);
        assert_eq!(found.rows, [[0.0, 1.0], [2.5, 30.0]]);
        assert_eq!(found.lines, [3, 5]);
        assert_eq!(read("0,1\n2,3").unwrap().units, [None, None]);
        assert_eq!(read("y,x\n2,3").unwrap_err(), "its column 1 is `y`");
        assert_eq!(
            read("x,y\n2;3").unwrap_err(),
            "line 2, `2;3`, does not hold 2 numbers"
        );
        assert_eq!(
            read("x,y\n2,nan").unwrap_err(),
            "line 2, `2,nan`, does not hold 2 numbers"
        );
        assert_eq!(read("x,y\n").unwrap_err(), "it has no rows of numbers");
    }
}
