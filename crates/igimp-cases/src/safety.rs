//! The factor of safety by strength reduction: an interval found by a search that always ends.

use crate::error::CaseError;
use crate::parameter::positive;

/// Most trials that a search makes before it reports the interval that it has.
const MOST_TRIALS: usize = 40;

/// What one trial at a reduced strength found.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// Whether the slope stands.
    pub stable: bool,
    /// Why it counts as standing or failed.
    pub reason: String,
    /// The measure that the criterion looks at \[-\].
    pub measure: f64,
}

/// One trial of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct SafetyTrial {
    /// Strength reduction factor \[-\].
    pub srf: f64,
    /// What was found.
    pub verdict: Verdict,
}

/// A factor of safety as an interval, with the trials that led to it.
#[derive(Clone, Debug, PartialEq)]
pub struct FactorOfSafety {
    /// Largest factor found stable; `None` when even the smallest factor tried fails.
    pub stable: Option<f64>,
    /// Smallest factor found failed; `None` when even the largest factor tried stands.
    pub failed: Option<f64>,
    /// All trials in the order they were made.
    pub trials: Vec<SafetyTrial>,
}

impl FactorOfSafety {
    /// The middle of the interval \[-\]; not a number when one end is open.
    pub fn middle(&self) -> f64 {
        match (self.stable, self.failed) {
            (Some(stable), Some(failed)) => 0.5 * (stable + failed),
            _ => f64::NAN,
        }
    }
}

/// Searches for the factor of safety in a bracket, widening it when the factor lies outside, then
/// halving it until it is not wider than `tolerance`.
///
/// # Errors
/// [`CaseError::InvalidParameter`] for a bracket or tolerance that makes no sense, and whatever a
/// trial returns.
pub fn search(
    (low, high): (f64, f64),
    tolerance: f64,
    mut trial: impl FnMut(f64) -> Result<Verdict, CaseError>,
) -> Result<FactorOfSafety, CaseError> {
    positive("bracket[0]", low)?;
    positive("bracket[1] - bracket[0]", high - low)?;
    positive("tolerance", tolerance)?;
    let mut found = FactorOfSafety {
        stable: None,
        failed: None,
        trials: Vec::new(),
    };
    let (mut next, width) = (low, high - low);
    while found.trials.len() < MOST_TRIALS {
        let verdict = trial(next)?;
        if verdict.stable {
            found.stable = Some(found.stable.map_or(next, |stable: f64| stable.max(next)));
        } else {
            found.failed = Some(found.failed.map_or(next, |failed: f64| failed.min(next)));
        }
        found.trials.push(SafetyTrial { srf: next, verdict });
        next = match (found.stable, found.failed) {
            (Some(stable), Some(failed)) if failed - stable <= tolerance * (1.0 + 1e-9) => break,
            (Some(stable), Some(failed)) => 0.5 * (stable + failed),
            (Some(stable), None) => high.max(stable + width),
            (None, Some(failed)) => 0.5 * failed,
            (None, None) => break,
        };
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn threshold(limit: f64) -> impl FnMut(f64) -> Result<Verdict, CaseError> {
        move |srf| {
            Ok(Verdict {
                stable: srf < limit,
                reason: String::new(),
                measure: srf / limit,
            })
        }
    }

    #[test]
    fn the_interval_holds_the_factor() {
        for limit in [0.2, 1.0, 1.38, 1.99, 5.0] {
            let found = search((1.0, 2.0), 0.01, threshold(limit)).unwrap();
            let (stable, failed) = (found.stable.unwrap(), found.failed.unwrap());
            assert!(stable < limit && limit <= failed && failed - stable <= 0.0101);
        }
    }

    #[test]
    fn a_search_without_an_end_ends() {
        let found = search((1.0, 2.0), 0.01, threshold(f64::INFINITY)).unwrap();
        assert_eq!(found.failed, None);
        assert_eq!(found.trials.len(), MOST_TRIALS);
        assert!(found.middle().is_nan());
    }

    #[test]
    fn a_bracket_upside_down_is_refused() {
        let error = search((2.0, 1.0), 0.01, threshold(1.0)).unwrap_err();
        assert_eq!(
            error.to_string(),
            "bracket[1] - bracket[0] is -1, but must be positive and finite"
        );
    }
}
