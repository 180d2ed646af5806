//! Controls of reinforcement in a step.

/// Controls of a member in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReinforcementControl {
    /// The bond is divided by this \[-\].
    pub reduction: f64,
    /// Tension at the end of the step that a jack holds whatever the ground does \[force\]; none: the member
    /// stretches with the ground.
    pub jack: Option<f64>,
}

impl Default for ReinforcementControl {
    fn default() -> Self {
        Self {
            reduction: 1.0,
            jack: None,
        }
    }
}

impl ReinforcementControl {
    /// Whether its numbers serve.
    pub(crate) fn is_sound(&self) -> bool {
        let jack = self.jack.unwrap_or(0.0);
        self.reduction.is_finite() && self.reduction > 0.0 && jack.is_finite() && jack >= 0.0
    }
}
