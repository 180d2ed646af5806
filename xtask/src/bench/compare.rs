//! This run against an earlier one whose rows were kept.

use super::row::Row;

/// Ratio beyond which a change is named.
const NOTABLE: f64 = 1.10;

/// Changes against an earlier run.
#[derive(Debug, PartialEq)]
pub(crate) struct Comparison {
    /// Name of the earlier run.
    pub(crate) name: String,
    /// This run over the earlier one, row by row; `None` where that has no such row.
    pub(crate) ratios: Vec<Option<f64>>,
}

impl Comparison {
    /// Compares rows with those of an earlier run.
    pub(crate) fn new(name: &str, rows: &[Row], earlier: &[Row]) -> Self {
        let ratio = |row: &Row| {
            let before = earlier.iter().find(|before| before.is_like(row))?;
            let ratio = row.value / before.value;
            ratio.is_finite().then_some(ratio)
        };
        Self {
            name: name.to_owned(),
            ratios: rows.iter().map(ratio).collect(),
        }
    }

    /// Names the rows that became worse, and states how much was compared.
    pub(crate) fn verdict(&self, rows: &[Row]) -> String {
        let compared = self.ratios.iter().flatten().count();
        let worse: Vec<String> = std::iter::zip(rows, &self.ratios)
            .filter_map(|(row, ratio)| {
                let ratio = (*ratio)?;
                let loss = if row.less_is_better()? {
                    ratio
                } else {
                    1.0 / ratio
                };
                let Row {
                    group, bench, size, ..
                } = row;
                (loss > NOTABLE).then(|| format!("- {group}/{bench}/{size}: {loss:.2} times\n"))
            })
            .collect();
        let name = &self.name;
        if worse.is_empty() {
            return format!(
                "Against `{name}`: nothing of {compared} quantities is worse by more than {:.0} %.\n",
                100.0 * (NOTABLE - 1.0)
            );
        }
        format!(
            "Against `{name}`: {} of {compared} quantities are worse by more than {:.0} %. Repeat both \
             runs before you believe it: the machine may have had other work.\n\n{}",
            worse.len(),
            100.0 * (NOTABLE - 1.0),
            worse.concat()
        )
    }
}

/// Whether a name can be that of a file: letters, digits, `-`, `_` and `.`, not in front.
pub(crate) fn is_name(name: &str) -> bool {
    let allowed = |c: char| c.is_alphanumeric() || "-_.".contains(c);
    !name.is_empty() && !name.starts_with('.') && name.chars().all(allowed)
}

#[cfg(test)]
mod tests {
    use super::super::row::tests::example;
    use super::*;

    #[test]
    fn worse_rows_are_named() {
        let earlier = [
            example("a", "slower", 1, "ns/particle", 100.0),
            example("a", "rate", 1, "GFlop/s", 40.0),
            example("a", "share", 1, "%", 10.0),
            example("a", "same", 1, "ns/particle", 100.0),
        ];
        let rows = [
            example("a", "slower", 1, "ns/particle", 120.0),
            example("a", "rate", 1, "GFlop/s", 20.0),
            example("a", "share", 1, "%", 90.0),
            example("a", "same", 1, "ns/particle", 109.0),
            example("a", "new", 1, "ns/particle", 1.0),
        ];
        let found = Comparison::new("before", &rows, &earlier);
        assert_eq!(found.ratios[1..3], [Some(0.5), Some(9.0)]);
        assert_eq!(found.ratios[4], None);
        let verdict = found.verdict(&rows);
        assert!(verdict.contains("2 of 4 quantities"), "{verdict}");
        assert!(verdict.contains("- a/slower/1: 1.20 times"), "{verdict}");
        assert!(verdict.contains("- a/rate/1: 2.00 times"), "{verdict}");
        assert!(!verdict.contains("share") && !verdict.contains("same"));
    }

    #[test]
    fn a_run_equals_itself() {
        let rows = [example("a", "b", 1, "ns/particle", 100.0)];
        let verdict = Comparison::new("itself", &rows, &rows).verdict(&rows);
        assert!(verdict.contains("nothing of 1 quantities"), "{verdict}");
    }

    #[test]
    fn names_are_those_of_files() {
        for name in ["before", "v0.1", "2025-06-01_a"] {
            assert!(is_name(name), "{name}");
        }
        for name in ["", ".hidden", "a/b", "..", "a b"] {
            assert!(!is_name(name), "{name}");
        }
    }
}
