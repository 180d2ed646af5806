//! One measured quantity, and its line in the CSV files of benches, survey and earlier runs.

/// First line of such a file.
const HEADER: &str = "group,bench,size,unit,value,low,high";

/// A quantity: of a bench the time over its size, of the survey whatever its unit says.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Row {
    /// Group, such as `assembly` or `survey/cost`.
    pub(crate) group: String,
    /// Bench within the group, such as `von-mises/tangent`.
    pub(crate) bench: String,
    /// Particles, trial states or unknowns.
    pub(crate) size: u64,
    /// Unit, such as `ns/particle`, `GFlop/s`, `%` or `-`.
    pub(crate) unit: String,
    /// Median.
    pub(crate) value: f64,
    /// Confidence interval of the median, or quartiles of the survey.
    pub(crate) range: [f64; 2],
}

impl Row {
    /// Whether two rows are of the same quantity.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        let key = |row: &Self| {
            (
                row.group.clone(),
                row.bench.clone(),
                row.size,
                row.unit.clone(),
            )
        };
        key(self) == key(other)
    }

    /// Whether less is better (time, memory), or more is (a rate); `None` for shares and ratios,
    /// which are not judged.
    pub(crate) fn less_is_better(&self) -> Option<bool> {
        if self.unit.starts_with("ns/") || self.unit.starts_with("B/") {
            Some(true)
        } else if self.unit.ends_with("/s") {
            Some(false)
        } else {
            None
        }
    }

    /// Time of one pass \[ns\], if the quantity is a time.
    pub(crate) fn time(&self) -> Option<f64> {
        let is_time = self.unit.starts_with("ns/");
        is_time.then_some(self.value * self.size as f64)
    }
}

/// Rows as CSV, with one more column where there is something to compare with.
pub(crate) fn csv(rows: &[Row], against: Option<&[Option<f64>]>) -> String {
    let extra = if against.is_some() { ",ratio" } else { "" };
    let line = |(number, row): (usize, &Row)| {
        let [low, high] = row.range;
        let Row {
            group,
            bench,
            size,
            unit,
            value,
            ..
        } = row;
        let ratio = against.map(|against| against.get(number).copied().flatten());
        let ratio = match ratio {
            Some(Some(ratio)) => format!(",{ratio:.4}"),
            Some(None) => ",".to_owned(),
            None => String::new(),
        };
        format!("{group},{bench},{size},{unit},{value:.4},{low:.4},{high:.4}{ratio}\n")
    };
    let lines: Vec<String> = rows.iter().enumerate().map(line).collect();
    format!("{HEADER}{extra}\n{}", lines.concat())
}

/// The rows of such a file; an error names the line that is none.
pub(crate) fn parse(text: &str) -> Result<Vec<Row>, String> {
    let mut lines = text.lines().enumerate();
    if !lines
        .next()
        .is_some_and(|(_, header)| header.starts_with(HEADER))
    {
        return Err(format!("line 1 is not `{HEADER}`"));
    }
    lines
        .map(|(number, line)| row(line).ok_or_else(|| format!("line {}: {line}", number + 1)))
        .collect()
}

fn row(line: &str) -> Option<Row> {
    let mut cells = line.split(',');
    Some(Row {
        group: cells.next()?.to_owned(),
        bench: cells.next()?.to_owned(),
        size: cells.next()?.parse().ok()?,
        unit: cells.next()?.to_owned(),
        value: cells.next()?.parse().ok()?,
        range: [cells.next()?.parse().ok()?, cells.next()?.parse().ok()?],
    })
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) fn example(group: &str, bench: &str, size: u64, unit: &str, value: f64) -> Row {
        Row {
            group: group.to_owned(),
            bench: bench.to_owned(),
            size,
            unit: unit.to_owned(),
            value,
            range: [value - 1.0, value + 1.0],
        }
    }

    #[test]
    fn written_rows_are_read() {
        let rows = vec![
            example(
                "assembly",
                "von-mises/evaluate",
                10_000,
                "ns/particle",
                321.5,
            ),
            example("survey/traffic", "copy", 1, "GB/s", 9.25),
        ];
        assert_eq!(parse(&csv(&rows, None)).unwrap(), rows);
        assert_eq!(parse(&csv(&rows, Some(&[Some(1.25), None]))).unwrap(), rows);
        let text = csv(&rows, Some(&[Some(1.25), None]));
        assert!(text.lines().nth(1).unwrap().ends_with(",1.2500"));
        assert!(text.lines().nth(2).unwrap().ends_with(','));
    }

    #[test]
    fn lines_that_are_no_rows_are_named() {
        assert!(parse("a,b\n").unwrap_err().contains("line 1"));
        assert!(
            parse(&format!("{HEADER}\nx,y,many\n"))
                .unwrap_err()
                .contains("line 2")
        );
    }

    #[test]
    fn units_decide_which_row_is_better() {
        let better = |unit| example("a", "b", 1, unit, 1.0).less_is_better();
        let units = ["ns/particle", "B/unknown", "GFlop/s", "%", "-"];
        let expected = [Some(true), Some(true), Some(false), None, None];
        assert_eq!(units.map(better), expected);
    }

    #[test]
    fn times_are_of_the_whole_pass() {
        assert_eq!(example("a", "b", 10, "ns/particle", 3.0).time(), Some(30.0));
        assert_eq!(example("a", "b", 10, "GB/s", 3.0).time(), None);
    }
}
