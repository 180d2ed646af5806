//! Numbers as a report prints them.

use igimp_results::summary::SafetySummary;
use igimp_text::{short, told_apart};

/// The factor of safety in words.
pub(crate) fn interval(safety: &SafetySummary) -> String {
    match (safety.stable, safety.failed) {
        (Some(stable), Some(failed)) => {
            let [stable, failed] = told_apart(stable, failed);
            format!("The factor of safety lies between {stable} and {failed}")
        }
        (Some(stable), None) => format!(
            "The factor of safety is at least {}; no factor was found that fails",
            short(stable)
        ),
        (None, Some(failed)) => format!(
            "The factor of safety is below {}; no factor was found that stands",
            short(failed)
        ),
        (None, None) => "No factor of safety was found".to_owned(),
    }
}

/// A share as a percentage.
pub(crate) fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if !percent.is_finite() {
        return UNKNOWN.to_owned();
    }
    if percent.abs() < 9.95 && percent.round().to_string() != format!("{percent}") {
        format!("{percent:.1} %")
    } else {
        format!("{percent:.0} %")
    }
}

/// Stands for a value that is not a number.
pub(crate) const UNKNOWN: &str = "–";
