//! Rows as a table: aligned text for a terminal, and Markdown.

use super::compare::Comparison;
use super::row::Row;

/// Columns from this one on hold numbers and are set flush right.
const FIRST_NUMBER: usize = 2;

/// The table for a terminal.
pub(crate) fn text(rows: &[Row], against: Option<&Comparison>) -> String {
    let cells = cells(rows, against);
    let widths = widths(&cells);
    let lines: Vec<String> = cells
        .iter()
        .map(|row| format!("{}\n", padded(row, &widths).join("  ").trim_end()))
        .collect();
    lines.concat()
}

/// The table in Markdown, aligned in its source too.
pub(crate) fn markdown(rows: &[Row], against: Option<&Comparison>) -> String {
    let cells = cells(rows, against);
    let widths = widths(&cells);
    let rule = widths.iter().enumerate().map(|(column, &width)| {
        let right = if column < FIRST_NUMBER { '-' } else { ':' };
        format!("|{}{right}", "-".repeat(width + 1))
    });
    let mut lines: Vec<String> = cells
        .iter()
        .map(|row| format!("| {} |\n", padded(row, &widths).join(" | ")))
        .collect();
    lines.insert(1, format!("{}|\n", rule.collect::<String>()));
    lines.concat()
}

/// The cells, header first.
fn cells(rows: &[Row], against: Option<&Comparison>) -> Vec<Vec<String>> {
    let mut header = ["group", "bench", "size", "time", "value", "range"]
        .map(str::to_owned)
        .to_vec();
    header.extend(against.map(|comparison| format!("over {}", comparison.name)));
    let mut cells = vec![header];
    for (number, row) in rows.iter().enumerate() {
        let [low, high] = row.range.map(digits);
        let mut line = vec![
            row.group.clone(),
            row.bench.clone(),
            row.size.to_string(),
            row.time().map_or_else(String::new, duration),
            match row.unit.as_str() {
                "-" => digits(row.value),
                unit => format!("{} {unit}", digits(row.value)),
            },
            format!("{low} .. {high}"),
        ];
        if let Some(comparison) = against {
            let ratio = comparison.ratios.get(number).copied().flatten();
            line.push(ratio.map_or_else(String::new, |ratio| format!("{ratio:.2}")));
        }
        cells.push(line);
    }
    cells
}

fn widths(cells: &[Vec<String>]) -> Vec<usize> {
    let columns = cells.first().map_or(0, Vec::len);
    let width = |column: usize| {
        let widths = cells.iter().map(|row| row[column].chars().count());
        widths.max().unwrap_or(0)
    };
    (0..columns).map(width).collect()
}

/// The cells of a row, filled up to the widths.
fn padded(row: &[String], widths: &[usize]) -> Vec<String> {
    let cells = std::iter::zip(row, widths).enumerate();
    cells
        .map(|(column, (cell, &width))| {
            if column < FIRST_NUMBER {
                format!("{cell:<width$}")
            } else {
                format!("{cell:>width$}")
            }
        })
        .collect()
}

/// A time in the unit that suits it.
fn duration(nanoseconds: f64) -> String {
    let (divisor, unit) = match nanoseconds {
        time if time < 1e3 => (1.0, "ns"),
        time if time < 1e6 => (1e3, "us"),
        time if time < 1e9 => (1e6, "ms"),
        _ => (1e9, "s"),
    };
    format!("{} {unit}", digits(nanoseconds / divisor))
}

/// A number with three significant digits, or all those before the point.
fn digits(value: f64) -> String {
    let decimals = match value.abs() {
        value if value < 9.995 => 2,
        value if value < 99.95 => 1,
        _ => 0,
    };
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::super::row::tests::example;
    use super::*;

    fn rows() -> Vec<Row> {
        vec![
            example(
                "assembly",
                "von-mises/evaluate",
                10_000,
                "ns/particle",
                321.4,
            ),
            example("survey/traffic", "copy", 500, "GB/s", 9.5),
        ]
    }

    #[test]
    fn text_is_aligned() {
        let expected = "\
group           bench                size     time            value         range
assembly        von-mises/evaluate  10000  3.21 ms  321 ns/particle    320 .. 322
survey/traffic  copy                  500                 9.50 GB/s  8.50 .. 10.5
";
        assert_eq!(text(&rows(), None), expected);
    }

    #[test]
    fn markdown_has_a_rule_below_its_header() {
        let found = markdown(&rows(), None);
        let lines: Vec<&str> = found.lines().collect();
        assert_eq!(lines.len(), 4);
        assert!(lines[1].starts_with("|---") && lines[1].ends_with(":|"));
        assert!(lines.iter().all(|line| line.matches('|').count() == 7));
        assert!(lines.windows(2).all(|pair| pair[0].len() == pair[1].len()));
    }

    #[test]
    fn a_comparison_adds_a_column() {
        let comparison = Comparison {
            name: "before".to_owned(),
            ratios: vec![Some(1.234), None],
        };
        let found = markdown(&rows(), Some(&comparison));
        assert!(found.lines().next().unwrap().ends_with("| over before |"));
        assert!(found.lines().nth(2).unwrap().ends_with("|        1.23 |"));
        assert!(found.lines().nth(3).unwrap().ends_with("|             |"));
    }

    #[test]
    fn numbers_keep_three_digits() {
        let found = [0.123, 9.994, 9.996, 99.94, 99.96, 1234.5].map(digits);
        assert_eq!(found, ["0.12", "9.99", "10.0", "99.9", "100", "1234"]);
        let times = [12.0, 1.5e3, 2e7, 3.21e9].map(duration);
        assert_eq!(times, ["12.0 ns", "1.50 us", "20.0 ms", "3.21 s"]);
    }
}
