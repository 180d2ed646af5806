//! The state of a run between two steps: the body, and the controls that acted on it last.

use igimp_solver::Body;
use serde::{Deserialize, Serialize};

/// What acts on the body: everything that a stage can change.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Controls {
    /// Multiple of gravity \[-\].
    pub gravity: f64,
    /// Factor by load \[-\].
    pub factors: Vec<f64>,
    /// Settlement of the rigid footing \[m\].
    pub settlement: f64,
    /// Strength reduction factor by material \[-\].
    pub srf: Vec<f64>,
}

impl Controls {
    /// Nothing acts, and strength is whole.
    pub(crate) fn none(loads: usize, materials: usize) -> Self {
        Self {
            gravity: 0.0,
            factors: vec![0.0; loads],
            settlement: 0.0,
            srf: vec![1.0; materials],
        }
    }

    /// The controls a share `t` of the way to `end`.
    pub(crate) fn towards(&self, end: &Self, t: f64) -> Self {
        let between = |a: f64, b: f64| if t >= 1.0 { b } else { a + t * (b - a) };
        let all = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| between(*a, *b)).collect();
        Self {
            gravity: between(self.gravity, end.gravity),
            factors: all(&self.factors, &end.factors),
            settlement: between(self.settlement, end.settlement),
            srf: all(&self.srf, &end.srf),
        }
    }

    /// The largest strength reduction factor of any material \[-\].
    pub(crate) fn reduction(&self) -> f64 {
        self.srf.iter().copied().fold(1.0, |a: f64, b| {
            if (b - 1.0).abs() > (a - 1.0).abs() {
                b
            } else {
                a
            }
        })
    }
}

/// A body and what acted on it last.
#[derive(Clone, Debug)]
pub struct State {
    /// The body.
    pub body: Body<2>,
    /// What acts on it.
    pub controls: Controls,
}
