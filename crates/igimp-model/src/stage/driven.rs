//! The control that a stage of loads or gravity drives: the one whose factor tells how far it came.

use crate::{Case, Quantity, StageKind};

/// Factors that differ by less than this share of the larger one are the same \[-\].
const SAME: f64 = 1e-9;

/// A control that stages of loads or gravity change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driven {
    /// Factor on a load.
    Load(usize),
    /// Pseudo-static force over the weight, by component: to the right, backwards, upwards.
    Acceleration(usize),
    /// Multiple of gravity.
    Gravity,
}

impl Driven {
    /// The control that a quantity records, if it records one.
    pub fn recorded_by(of: Quantity) -> Option<Self> {
        match of {
            Quantity::LoadFactor(load) => Some(Self::Load(load)),
            Quantity::HorizontalFactor => Some(Self::Acceleration(0)),
            Quantity::GravityFactor => Some(Self::Gravity),
            _ => None,
        }
    }

    /// Where a stage takes the control, if it states it \[-\].
    pub fn aim(self, kind: &StageKind) -> Option<f64> {
        match (kind, self) {
            (StageKind::K0, Self::Gravity) => Some(1.0),
            (StageKind::Gravity { factor, .. }, Self::Gravity) => Some(*factor),
            (
                StageKind::Gravity {
                    horizontal,
                    across,
                    vertical,
                    ..
                },
                Self::Acceleration(component),
            ) => [*horizontal, *across, *vertical][component],
            (StageKind::Load { loads, factor }, Self::Load(load)) => {
                loads.contains(&load).then_some(*factor)
            }
            _ => None,
        }
    }

    /// The control that shows how far a stage came, with its value at the beginning: the first of those stated that the stage
    /// changes. Loads go in their order, accelerations before gravity. None of a stage that drives none of them.
    pub fn of(kind: &StageKind, before: impl Fn(Self) -> f64) -> Option<Self> {
        let stated: Vec<Self> = match kind {
            StageKind::Load { loads, .. } => loads.iter().map(|&load| Self::Load(load)).collect(),
            StageKind::Gravity { .. } => {
                let components = (0..3).map(Self::Acceleration);
                let stated = components.filter(|control| control.aim(kind).is_some());
                stated.chain([Self::Gravity]).collect()
            }
            _ => return None,
        };
        let changes = |control: &&Self| {
            let from = before(**control);
            control
                .aim(kind)
                .is_some_and(|to| (to - from).abs() > SAME * to.abs().max(from.abs()))
        };
        stated.iter().find(changes).or(stated.last()).copied()
    }

    /// The control that a stage drives where all before it came to their ends.
    pub fn planned<const D: usize>(case: &Case<D>, number: usize) -> Option<Self> {
        Self::of(&case.stages[number].kind, |control| {
            control.before(case, number, &|_| 1.0)
        })
    }

    /// The control at the beginning of a stage, from the shares of stages that were reached \[-\].
    pub fn before<const D: usize>(
        self,
        case: &Case<D>,
        number: usize,
        reached: &dyn Fn(usize) -> f64,
    ) -> f64 {
        let before = case.stages[number].start_from;
        before.map_or(0.0, |before| self.after(case, before, reached))
    }

    /// The control at the end of a stage, from the shares of stages that were reached \[-\].
    pub fn after<const D: usize>(
        self,
        case: &Case<D>,
        number: usize,
        reached: &dyn Fn(usize) -> f64,
    ) -> f64 {
        let from = self.before(case, number, reached);
        let to = self.aim(&case.stages[number].kind);
        to.map_or(from, |to| from + reached(number) * (to - from))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: the driven control is the first that the stage changes.
    /// ORACLE: by hand.
    #[test]
    fn a_control_that_stays_is_not_driven() {
        let gravity = |factor, horizontal, across, vertical| StageKind::Gravity {
            factor,
            horizontal,
            across,
            vertical,
        };
        let load = |loads: &[usize]| StageKind::Load {
            loads: loads.to_vec(),
            factor: 2.0,
        };
        let before = |control: Driven| match control {
            Driven::Gravity => 1.0,
            Driven::Acceleration(0) => 0.1,
            Driven::Load(0) => 2.0,
            _ => 0.0,
        };
        for (kind, driven) in [
            (gravity(3.0, None, None, None), Driven::Gravity),
            (gravity(3.0, Some(0.1), Some(0.0), None), Driven::Gravity),
            (gravity(3.0, Some(1.0), None, None), Driven::Acceleration(0)),
            (
                gravity(1.0, None, Some(1.0), Some(0.0)),
                Driven::Acceleration(1),
            ),
            (
                gravity(1.0, None, None, Some(-2.0)),
                Driven::Acceleration(2),
            ),
            (gravity(1.0, None, None, None), Driven::Gravity),
            (load(&[0, 1]), Driven::Load(1)),
            (load(&[1, 0]), Driven::Load(1)),
        ] {
            assert_eq!(Driven::of(&kind, before), Some(driven), "{kind:?}");
        }
        assert_eq!(Driven::of(&StageKind::K0, before), None);
    }
}
