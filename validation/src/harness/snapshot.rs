//! Yesterday's results: curves within a tolerance, effort counters to the digit.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use igimp_cases::CaseError;
use insta::Comparator;
use insta::internals::SnapshotContents;

use crate::harness::review::{self, Difference};
use crate::harness::study::Study;

/// Largest relative difference of two numbers that count as equal \[-\].
const RELATIVE: f64 = 1e-5;
/// Largest difference relative to the largest number of the snapshot \[-\].
const ABSOLUTE: f64 = 1e-8;
/// Tolerance of Newton's method in all studies \[-\].
const CONVERGED: f64 = 1e-9;
/// Most rows of a curve in a snapshot.
const ROWS: usize = 40;

/// Compares studies with the snapshots of a folder and returns the differences. New texts are left beside
/// the snapshots for review; pictures of every curve and residual history that changed are written anew.
///
/// # Errors
/// [`CaseError`] if a picture cannot be written.
pub(crate) fn compare(
    studies: &[Study],
    folder: &Path,
    pictures: &Path,
) -> Result<Vec<Difference>, CaseError> {
    review::clear(pictures)?;
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let compared = |study| compare_study(study, folder);
    let missed: Vec<_> = studies.iter().flat_map(compared).collect();
    std::panic::set_hook(hook);
    let diff = |(name, text): &(String, String)| review::difference(folder, name, text, pictures);
    missed.iter().map(diff).collect()
}

/// The names and texts that differ from the snapshots of a folder.
fn compare_study(study: &Study, folder: &Path) -> Vec<(String, String)> {
    let mut missed = Vec::new();
    let mut hold = |name: String, text: &str, comparator: Box<dyn Comparator>| {
        let mut settings = insta::Settings::clone_current();
        settings.set_snapshot_path(folder);
        settings.set_prepend_module_to_snapshot(false);
        settings.set_omit_expression(true);
        settings.set_comparator(comparator);
        let compared = settings.bind(|| {
            catch_unwind(AssertUnwindSafe(|| {
                insta::assert_snapshot!(name.clone(), text);
            }))
        });
        if compared.is_err() {
            missed.push((name, text.to_owned()));
        }
    };
    for table in &study.tables {
        let name = format!("{}__{}", study.case, table.name);
        hold(name, &table.to_text(ROWS), Box::new(Numeric));
    }
    for (name, history) in &study.histories {
        let name = format!("{}__residuals__{name}", study.case);
        hold(name, history, Box::new(Residuals));
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

/// Compares residual histories: as many residuals in every step, each of the same size.
struct Residuals;

impl Comparator for Residuals {
    fn matches(&self, reference: &insta::Snapshot, test: &insta::Snapshot) -> bool {
        match (reference.contents(), test.contents()) {
            (SnapshotContents::Text(reference), SnapshotContents::Text(test)) => {
                residuals_agree(&reference.to_string(), &test.to_string())
            }
            _ => false,
        }
    }

    fn dyn_clone(&self) -> Box<dyn Comparator> {
        Box::new(Self)
    }
}

/// Residuals agree within a factor of 2; converged ones are round-off and need only be converged.
fn residuals_agree(reference: &str, test: &str) -> bool {
    let tokens = |text: &str| {
        text.split_whitespace()
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let (a, b) = (tokens(reference), tokens(test));
    a.len() == b.len()
        && a.iter()
            .zip(&b)
            .all(|(a, b)| match (a.parse::<f64>(), b.parse::<f64>()) {
                (Ok(x), Ok(y)) => {
                    (x <= CONVERGED && y <= CONVERGED) || (x <= 2.0 * y && y <= 2.0 * x)
                }
                _ => a == b,
            })
}

fn numbers_agree(reference: &str, test: &str) -> bool {
    within(reference, test, RELATIVE)
}

/// Whether two texts agree: words to the letter, numbers within a relative difference, plus 1e-8 of
/// the largest one.
pub(crate) fn within(reference: &str, test: &str, relative: f64) -> bool {
    let (a, b): (Vec<&str>, Vec<&str>) = (
        reference.split_whitespace().collect(),
        test.split_whitespace().collect(),
    );
    let number = |token: &&str| token.parse::<f64>().ok();
    let largest = a
        .iter()
        .filter_map(number)
        .filter(|value| value.is_finite())
        .fold(0.0, |m: f64, v| m.max(v.abs()));
    a.len() == b.len()
        && a.iter().zip(&b).all(|(a, b)| match (number(a), number(b)) {
            (Some(x), Some(y)) => {
                a == b || (x - y).abs() <= relative * x.abs().max(y.abs()) + ABSOLUTE * largest
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
    fn a_lost_quadratic_rate_is_noticed() {
        let quadratic = "step 1: 1.0e0 1.0e-2 1.0e-4 3.0e-8 1.0e-15";
        assert!(residuals_agree(
            quadratic,
            "step 1: 1.1e0 0.9e-2 1.1e-4 2.0e-8 9.0e-11"
        ));
        assert!(!residuals_agree(
            quadratic,
            "step 1: 1.0e0 1.0e-2 1.0e-4 1.0e-6 1.0e-15"
        ));
        assert!(!residuals_agree(
            quadratic,
            "step 1: 1.0e0 1.0e-2 1.0e-4 3.0e-8 1.0e-8"
        ));
        assert!(!residuals_agree(
            quadratic,
            "step 1: 1.0e0 1.0e-2 1.0e-4 3.0e-8"
        ));
        assert!(!residuals_agree(
            quadratic,
            "step 1: 1.0e0 1.0e-2 1.0e-4 3.0e-8 NaN"
        ));
    }

    #[test]
    fn file_names_are_plain() {
        assert_eq!(
            file_name("iGIMP + B-bar, 64 cells, E = 10 kPa"),
            "igimp_b_bar_64_cells_e_10_kpa"
        );
    }
}
