//! Measurements as a table: aligned text, Markdown and CSV.

use super::estimate::Measurement;

const HEADER: [&str; 6] = ["group", "bench", "size", "time", "interval", "cost"];

/// Columns from this one on hold numbers and are set flush right.
const FIRST_NUMBER: usize = 2;

/// The table for a terminal.
pub(crate) fn text(measurements: &[Measurement]) -> String {
    let rows = rows(measurements);
    let widths = widths(&rows);
    let lines: Vec<String> = rows
        .iter()
        .map(|row| format!("{}\n", cells(row, &widths).join("  ").trim_end()))
        .collect();
    lines.concat()
}

/// The table in Markdown, aligned in its source too.
pub(crate) fn markdown(measurements: &[Measurement]) -> String {
    let rows = rows(measurements);
    let widths = widths(&rows);
    let rule = widths.iter().enumerate().map(|(column, &width)| {
        let right = if column < FIRST_NUMBER { '-' } else { ':' };
        format!("|{}{right}", "-".repeat(width + 1))
    });
    let mut lines: Vec<String> = rows
        .iter()
        .map(|row| format!("| {} |\n", cells(row, &widths).join(" | ")))
        .collect();
    lines.insert(1, format!("{}|\n", rule.collect::<String>()));
    lines.concat()
}

/// The table for other programs: plain numbers, times in nanoseconds.
pub(crate) fn csv(measurements: &[Measurement]) -> String {
    let header = "group,bench,size,unit,time_[ns],low_[ns],high_[ns],cost_[ns/unit]\n";
    let rows = measurements.iter().map(|measurement| {
        let Measurement {
            group,
            bench,
            size,
            time,
            interval: [low, high],
        } = measurement;
        let (unit, cost) = (measurement.unit(), measurement.cost());
        format!("{group},{bench},{size},{unit},{time:.1},{low:.1},{high:.1},{cost:.3}\n")
    });
    std::iter::once(header.to_owned()).chain(rows).collect()
}

/// The cells, header first.
fn rows(measurements: &[Measurement]) -> Vec<[String; 6]> {
    let mut rows = vec![HEADER.map(str::to_owned)];
    for measurement in measurements {
        let [low, high] = measurement.interval.map(duration);
        rows.push([
            measurement.group.clone(),
            measurement.bench.clone(),
            measurement.size.to_string(),
            duration(measurement.time),
            format!("{low} .. {high}"),
            format!("{} ns/{}", digits(measurement.cost()), measurement.unit()),
        ]);
    }
    rows
}

fn widths(rows: &[[String; 6]]) -> [usize; 6] {
    std::array::from_fn(|column| {
        let widths = rows.iter().map(|row| row[column].chars().count());
        widths.max().unwrap_or(0)
    })
}

/// The cells of a row, filled up to the widths.
fn cells(row: &[String; 6], widths: &[usize; 6]) -> [String; 6] {
    std::array::from_fn(|column| {
        let (cell, width) = (&row[column], widths[column]);
        if column < FIRST_NUMBER {
            format!("{cell:<width$}")
        } else {
            format!("{cell:>width$}")
        }
    })
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

/// A positive number with three significant digits, or all those before the point.
fn digits(value: f64) -> String {
    let decimals = match value {
        value if value < 9.995 => 2,
        value if value < 99.95 => 1,
        _ => 0,
    };
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measurements() -> Vec<Measurement> {
        let measurement = |group: &str, bench: &str, size, time: f64| Measurement {
            group: group.to_owned(),
            bench: bench.to_owned(),
            size,
            time,
            interval: [0.9 * time, 1.1 * time],
        };
        vec![
            measurement("assembly", "von-mises/evaluate", 10_000, 3.214e6),
            measurement("factorisation", "lu/solve", 500, 999.4e3),
        ]
    }

    #[test]
    fn text_is_aligned() {
        let expected = "\
group          bench                size     time            interval             cost
assembly       von-mises/evaluate  10000  3.21 ms  2.89 ms .. 3.54 ms  321 ns/particle
factorisation  lu/solve              500   999 us   899 us .. 1.10 ms  1999 ns/unknown
";
        assert_eq!(text(&measurements()), expected);
    }

    #[test]
    fn markdown_has_a_rule_below_its_header() {
        let found = markdown(&measurements());
        let lines: Vec<&str> = found.lines().collect();
        assert_eq!(lines.len(), 4);
        assert!(lines[1].starts_with("|---") && lines[1].ends_with(":|"));
        assert!(lines.iter().all(|line| line.matches('|').count() == 7));
        assert!(lines.windows(2).all(|pair| pair[0].len() == pair[1].len()));
    }

    #[test]
    fn csv_holds_plain_numbers() {
        let found = csv(&measurements());
        let row = found.lines().nth(1).unwrap();
        let numbers = "10000,particle,3214000.0,2892600.0,3535400.0,321.400";
        assert_eq!(row, format!("assembly,von-mises/evaluate,{numbers}"));
    }

    #[test]
    fn numbers_keep_three_digits() {
        let found = [0.123, 9.994, 9.996, 99.94, 99.96, 1234.5].map(digits);
        assert_eq!(found, ["0.12", "9.99", "10.0", "99.9", "100", "1234"]);
        let times = [12.0, 1.5e3, 2e7, 3.21e9].map(duration);
        assert_eq!(times, ["12.0 ns", "1.50 us", "20.0 ms", "3.21 s"]);
    }
}
