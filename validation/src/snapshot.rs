//! Yesterday's results: curves within a tolerance, effort counters to the digit.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use insta::Comparator;
use insta::internals::SnapshotContents;

use crate::study::Study;

/// Largest relative difference of two numbers that count as equal \[-\].
const RELATIVE: f64 = 1e-5;
/// Largest difference relative to the largest number of the snapshot \[-\].
const ABSOLUTE: f64 = 1e-8;
/// Most rows of a curve in a snapshot.
const ROWS: usize = 40;

/// Compares studies with their snapshots; returns the names of those that differ. The differences
/// are printed, and left beside the snapshots for review.
pub(crate) fn compare(studies: &[Study]) -> Vec<String> {
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let missed = studies.iter().flat_map(compare_study).collect();
    std::panic::set_hook(hook);
    missed
}

fn compare_study(study: &Study) -> Vec<String> {
    let mut missed = Vec::new();
    let mut hold = |name: String, text: &str, comparator: Box<dyn Comparator>| {
        let mut settings = insta::Settings::clone_current();
        settings.set_snapshot_path(Path::new(env!("CARGO_MANIFEST_DIR")).join("snapshots"));
        settings.set_prepend_module_to_snapshot(false);
        settings.set_omit_expression(true);
        settings.set_comparator(comparator);
        let compared = settings.bind(|| {
            catch_unwind(AssertUnwindSafe(|| {
                insta::assert_snapshot!(name.clone(), text);
            }))
        });
        if compared.is_err() {
            missed.push(name);
        }
    };
    for table in &study.tables {
        let name = format!("{}__{}", study.case, table.name);
        hold(name, &table.to_text(ROWS), Box::new(Numeric));
    }
    for run in &study.runs {
        // Past failure the number of corrections hangs on round-off.
        if run.cuts == 0 && run.outcome == "completed" {
            let effort = format!("{}\n{}", run.variant, run.effort());
            let name = format!("{}__effort__{}", study.case, file_name(&run.variant));
            hold(name, &effort, Box::new(insta::DefaultComparator));
        }
    }
    missed
}

fn file_name(variant: &str) -> String {
    variant
        .chars()
        .map(|c| {
            if c.is_ascii_alphanumeric() || c == '.' {
                c.to_ascii_lowercase()
            } else {
                '_'
            }
        })
        .collect::<String>()
        .split('_')
        .filter(|part| !part.is_empty())
        .collect::<Vec<_>>()
        .join("_")
}

/// Compares token by token: numbers within a tolerance, everything else to the letter.
struct Numeric;

impl Comparator for Numeric {
    fn matches(&self, reference: &insta::Snapshot, test: &insta::Snapshot) -> bool {
        match (reference.contents(), test.contents()) {
            (SnapshotContents::Text(reference), SnapshotContents::Text(test)) => {
                numbers_agree(&reference.to_string(), &test.to_string())
            }
            _ => false,
        }
    }

    fn dyn_clone(&self) -> Box<dyn Comparator> {
        Box::new(Self)
    }
}

fn numbers_agree(reference: &str, test: &str) -> bool {
    let (a, b): (Vec<&str>, Vec<&str>) = (
        reference.split_whitespace().collect(),
        test.split_whitespace().collect(),
    );
    let number = |token: &&str| token.parse::<f64>().ok();
    let largest = a
        .iter()
        .filter_map(number)
        .fold(0.0, |m: f64, v| m.max(v.abs()));
    a.len() == b.len()
        && a.iter().zip(&b).all(|(a, b)| match (number(a), number(b)) {
            (Some(x), Some(y)) => {
                (x - y).abs() <= RELATIVE * x.abs().max(y.abs()) + ABSOLUTE * largest
            }
            _ => a == b,
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_compared_by_value_and_words_by_letter() {
        assert!(numbers_agree(
            "x [m]\n 1.000000e0 2.0",
            "x [m]\n1.0000001 2.000001"
        ));
        assert!(!numbers_agree("x 1.0", "x 1.001"));
        assert!(!numbers_agree("x 1.0", "y 1.0"));
        assert!(!numbers_agree("1.0 2.0", "1.0"));
        assert!(!numbers_agree("1.0", "NaN"));
    }

    #[test]
    fn file_names_are_plain() {
        assert_eq!(
            file_name("iGIMP + B-bar, 64 cells, E = 10 kPa"),
            "igimp_b_bar_64_cells_e_10_kpa"
        );
    }
}
