//! How runs and stages end, as data, and the only place that puts it into words.

use std::fmt;

use igimp_text::short;
use serde::{Deserialize, Serialize};

/// How a run ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ending {
    /// It began and has not ended yet, or was stopped hard.
    #[default]
    Running,
    /// Done, and references met.
    Done,
    /// Done, and a reference missed.
    Missed,
    /// A stage found no equilibrium.
    NotConverged,
    /// The user interrupted it.
    Interrupted,
    /// It could not be set up, or its results could not be written.
    Failed,
}

impl Ending {
    /// Whether running the task again would tell nothing new.
    pub fn is_verdict(self) -> bool {
        matches!(self, Self::Done | Self::Missed | Self::NotConverged)
    }
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Running => "running",
            Self::Done => "done",
            Self::Missed => "reference missed",
            Self::NotConverged => "not converged",
            Self::Interrupted => "interrupted",
            Self::Failed => "failed",
        })
    }
}

/// Why a path of equilibria ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PathEnd {
    /// The increment is a mechanism, and the factor changes no longer.
    Limit,
    /// The factor went back behind an earlier one.
    Fallen,
    /// The increment is a mechanism, has been one for two doublings of the work, and the factor still changes.
    StillRising,
    /// The displacement that the case states was exceeded.
    Displacement,
    /// No further equilibrium was found.
    #[default]
    Lost,
}

impl PathEnd {
    /// In words.
    pub fn sentence(self) -> &'static str {
        match self {
            Self::Limit => "the body moves as a mechanism, and the factor changes no longer",
            Self::Fallen => "the factor turns back from the furthest that it came to",
            Self::StillRising => {
                "the body has moved as a mechanism for long, and the factor still changes"
            }
            Self::Displacement => "the displacement of the case is exceeded",
            Self::Lost => "no further equilibrium was found",
        }
    }
}

/// Why a stage ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "code", rename_all = "kebab-case")]
pub enum EndReason {
    /// Everything that the stage asks for was done.
    ReachedItsEnd,
    /// The interval of a search is as narrow as the case wants it.
    IntervalIsNarrow,
    /// The body stands at no strength that a search can give it.
    NoStrengthHolds,
    /// Nothing fails at the greatest strength reduction factor that a search goes to.
    NothingFails,
    /// A path of equilibria came to an end.
    PathEnded {
        /// How.
        end: PathEnd,
        /// Share of the stage that was reached \[-\]; none for a search.
        reached: Option<f64>,
    },
    /// A path of equilibria took all its steps.
    StepsOfPathRanOut,
    /// A path of equilibria was lost.
    PathLost {
        /// Why the last step failed.
        cause: String,
    },
    /// A limit load lies beyond the load of the stage.
    LimitBeyondLoad,
    /// A displacement exceeds what the case states.
    DisplacementExceeded {
        /// The displacement that was exceeded, in words.
        whose: String,
        /// Its limit \[m\].
        limit: f64,
    },
    /// The resistance has all but stopped growing.
    ResistanceLevelsOff {
        /// The growth in a step below which it has \[-\].
        growth: f64,
    },
    /// A run-out came to rest.
    AtRest {
        /// After so many steps.
        steps: usize,
        /// Share of the load that drag carried \[-\].
        drag_share: f64,
        /// Whether equilibrium without drag was found; none before it was looked for.
        is_in_equilibrium: Option<bool>,
    },
    /// Kinetic energy has fallen to a share of its largest value.
    CameToRest {
        /// After so much time \[s\].
        time: f64,
        /// The share \[-\].
        share: f64,
    },
    /// A run-out still moves.
    StillMoving {
        /// After so many steps.
        steps: usize,
    },
    /// The factor of safety that a reduction refers to was not found.
    NoFactorOfSafety,
    /// The user interrupted it.
    Interrupted,
    /// A step found no equilibrium.
    NoEquilibrium {
        /// Share of the stage beyond which there is none, of a stage that expects it \[-\].
        beyond: Option<f64>,
        /// Why the step failed.
        cause: String,
    },
    /// A step failed for another reason than want of equilibrium.
    StepFailed {
        /// The reason.
        cause: String,
    },
}

impl EndReason {
    /// The code that stands for it in `summary.json`, such as `reached-its-end`.
    pub fn code(&self) -> &'static str {
        match self {
            Self::ReachedItsEnd => "reached-its-end",
            Self::IntervalIsNarrow => "interval-is-narrow",
            Self::NoStrengthHolds => "no-strength-holds",
            Self::NothingFails => "nothing-fails",
            Self::PathEnded { .. } => "path-ended",
            Self::StepsOfPathRanOut => "steps-of-path-ran-out",
            Self::PathLost { .. } => "path-lost",
            Self::LimitBeyondLoad => "limit-beyond-load",
            Self::DisplacementExceeded { .. } => "displacement-exceeded",
            Self::ResistanceLevelsOff { .. } => "resistance-levels-off",
            Self::AtRest { .. } => "at-rest",
            Self::CameToRest { .. } => "came-to-rest",
            Self::StillMoving { .. } => "still-moving",
            Self::NoFactorOfSafety => "no-factor-of-safety",
            Self::Interrupted => "interrupted",
            Self::NoEquilibrium { .. } => "no-equilibrium",
            Self::StepFailed { .. } => "step-failed",
        }
    }
}

impl fmt::Display for EndReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ReachedItsEnd => f.write_str("reached its end"),
            Self::IntervalIsNarrow => f.write_str("the interval is narrow enough"),
            Self::NoStrengthHolds => f.write_str("no strength holds the body"),
            Self::NothingFails => f.write_str("nothing fails, however little strength is left"),
            Self::PathEnded { end, reached: None } => f.write_str(end.sentence()),
            Self::PathEnded {
                end,
                reached: Some(reached),
            } => write!(f, "at {} of the stage {}", short(*reached), end.sentence()),
            Self::StepsOfPathRanOut => f.write_str("the steps of the path ran out"),
            Self::PathLost { cause } => write!(f, "the path was lost: {cause}"),
            Self::LimitBeyondLoad => f.write_str("the limit lies beyond the load of the stage"),
            Self::DisplacementExceeded { whose, limit } => {
                write!(f, "{whose} exceeds {} m", short(*limit))
            }
            Self::ResistanceLevelsOff { growth } => {
                let percent = short(100.0 * growth);
                write!(f, "the resistance grows by less than {percent} % in a step")
            }
            Self::AtRest {
                steps,
                drag_share,
                is_in_equilibrium,
            } => {
                let share = short(100.0 * drag_share);
                write!(
                    f,
                    "at rest after {steps} steps, when drag carried {share} % of the load"
                )?;
                f.write_str(match is_in_equilibrium {
                    None => "",
                    Some(true) => "; then in equilibrium without drag",
                    Some(false) => "; not in equilibrium without drag",
                })
            }
            Self::CameToRest { time, share } => write!(
                f,
                "at rest after {} s: kinetic energy is {} % of its largest value",
                short(*time),
                short(100.0 * share)
            ),
            Self::StillMoving { steps } => write!(f, "still moving after {steps} steps"),
            Self::NoFactorOfSafety => {
                f.write_str("the factor of safety that the reduction refers to was not found")
            }
            Self::Interrupted => f.write_str("interrupted by the user"),
            Self::NoEquilibrium {
                beyond: Some(reached),
                cause,
            } => write!(
                f,
                "no equilibrium beyond {} of the stage: {cause}",
                short(*reached)
            ),
            Self::NoEquilibrium {
                beyond: None,
                cause,
            } => write!(f, "no equilibrium: {cause}"),
            Self::StepFailed { cause } => f.write_str(cause),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: the code that is printed beside the words is the one that the data are stored under.
    #[test]
    fn codes_are_those_of_the_data() {
        let cause = || "the residual stagnates".to_owned();
        let reasons = [
            EndReason::ReachedItsEnd,
            EndReason::IntervalIsNarrow,
            EndReason::NoStrengthHolds,
            EndReason::NothingFails,
            EndReason::PathEnded {
                end: PathEnd::Limit,
                reached: Some(0.5),
            },
            EndReason::StepsOfPathRanOut,
            EndReason::PathLost { cause: cause() },
            EndReason::LimitBeyondLoad,
            EndReason::DisplacementExceeded {
                whose: "the displacement".to_owned(),
                limit: 0.1,
            },
            EndReason::ResistanceLevelsOff { growth: 0.01 },
            EndReason::AtRest {
                steps: 3,
                drag_share: 0.01,
                is_in_equilibrium: None,
            },
            EndReason::CameToRest {
                time: 2.0,
                share: 0.001,
            },
            EndReason::StillMoving { steps: 3 },
            EndReason::NoFactorOfSafety,
            EndReason::Interrupted,
            EndReason::NoEquilibrium {
                beyond: None,
                cause: cause(),
            },
            EndReason::StepFailed { cause: cause() },
        ];
        for reason in reasons {
            let stored = serde_json::to_value(&reason).unwrap();
            assert_eq!(stored["code"], reason.code());
            assert_eq!(serde_json::from_value::<EndReason>(stored).unwrap(), reason);
            assert!(!reason.to_string().is_empty());
        }
    }
}
