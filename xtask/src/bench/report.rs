//! The report: tables of the survey, its plot, the comparison with other libraries, and every
//! quantity in one table.

use super::compare::Comparison;
use super::row::Row;
use super::survey::Survey;
use super::table;

/// The contents of the report.
pub(crate) struct Report<'a> {
    /// Machine and date.
    pub(crate) machine: &'a str,
    /// Threads, length of the measurement, filter.
    pub(crate) note: &'a str,
    /// Tables and plot.
    pub(crate) survey: &'a Survey,
    /// Tables of the comparison with other libraries, if they were made.
    pub(crate) side_by_side: Option<&'a str>,
    /// All quantities.
    pub(crate) rows: &'a [Row],
    /// An earlier run.
    pub(crate) against: Option<&'a Comparison>,
}

impl Report<'_> {
    /// The report in Markdown.
    pub(crate) fn markdown(&self) -> String {
        let mut parts = vec![format!("# Benches\n\n{}\n\n{}\n", self.machine, self.note)];
        parts.extend(self.against.map(|comparison| comparison.verdict(self.rows)));
        if !self.survey.tables.is_empty() {
            parts.push(format!("{}\n", self.survey.tables.trim_end()));
        }
        if self.survey.has_plot {
            parts.push("![Growth with size](survey/growth.svg)\n".to_owned());
        }
        parts.push(match self.side_by_side {
            Some(tables) => format!("{}\n", tables.trim_end()),
            None => "## Side by side\n\nNot measured: `python3 benchmarks/compare/compare.py` \
                     compares the linear solvers with other libraries, and the next report holds \
                     its tables.\n"
                .to_owned(),
        });
        parts.push(format!(
            "## Every quantity\n\nMedians. *Range*: of a bench the 95 % confidence interval of its \
             median, of the survey the quartiles of its rounds. *Time*: of one pass.\n\n{}",
            table::markdown(self.rows, self.against)
        ));
        parts.join("\n")
    }
}

#[cfg(test)]
mod tests {
    use super::super::row::tests::example;
    use super::*;

    #[test]
    fn the_report_holds_all_parts() {
        let rows = [example("assembly", "evaluate", 1, "ns/particle", 300.0)];
        let survey = Survey {
            tables: "## Growth\n\ntext\n\n".to_owned(),
            rows: Vec::new(),
            has_plot: true,
        };
        let comparison = Comparison::new("before", &rows, &rows);
        let report = Report {
            machine: "A CPU, 2 cores",
            note: "Threads: 1 and 2.",
            survey: &survey,
            side_by_side: None,
            rows: &rows,
            against: Some(&comparison),
        };
        let found = report.markdown();
        let parts = [
            "# Benches",
            "A CPU",
            "Threads",
            "Against `before`",
            "## Growth",
            "growth.svg",
            "compare.py",
            "## Every quantity",
            "300 ns/particle",
        ];
        let places: Vec<usize> = parts.iter().map(|part| found.find(part).unwrap()).collect();
        assert!(places.is_sorted(), "{found}");

        let tables = "## PARDISO and others\n\n| a |\n";
        let report = Report {
            side_by_side: Some(tables),
            ..report
        };
        let found = report.markdown();
        assert!(
            found.contains(tables) && !found.contains("compare.py"),
            "{found}"
        );
    }
}
