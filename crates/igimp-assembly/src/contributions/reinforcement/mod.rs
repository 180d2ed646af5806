//! Reinforcement: anchors, nails and geotextiles, which pull and do not bend (theory, eqs. 56 to 59).
//!
//! A member is a chain of bars between stations that the soil carries along. A bar carries tension only,
//! up to the limit of the member and of its bond on either side.

mod members;
mod row;
mod soil_near;

use crate::error::AssemblyError;

pub(crate) use members::Members;

/// A member in the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Reinforcement<const D: usize> {
    /// Its name in messages.
    pub name: String,
    /// Axial stiffness EA \[force; per unit thickness in plane strain\].
    pub stiffness: f64,
    /// The points that it is made fast to, from its head on.
    pub stations: Vec<Station<D>>,
    /// The bars between them: one less.
    pub segments: Vec<Segment>,
}

/// A place of a member that moves with the soil: the mean of its points, on which its force spreads evenly.
#[derive(Clone, Debug, PartialEq)]
pub struct Station<const D: usize> {
    /// Positions \[length\]; one, or several beneath a plate.
    pub points: Vec<[f64; D]>,
}

/// A bar of a member.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Length of which its strain is a share \[length\].
    pub length: f64,
    /// Tension that the member carries at most \[force\].
    pub tensile: f64,
    /// Anchorage on either side of the bar: towards its head, towards its end.
    pub held: [Hold; 2],
    /// Its state after the steps so far.
    pub state: SegmentState,
}

/// Anchorage of a member on one side of a bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// Force of its plate, or of its fastening \[force\].
    pub fastened: f64,
    /// Force of its bond, which a strength reduction may divide \[force\].
    pub bonded: f64,
}

/// State of a bar; written when one is accepted, and nowhere else.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SegmentState {
    /// Elongation over length, since the member was placed \[-\].
    pub strain: f64,
    /// The strain without tension: that of yielding and slipping; negative after prestress \[-\].
    pub slack: f64,
    /// Tension \[force\].
    pub force: f64,
    /// Whether the tension is at its limit.
    pub is_at_limit: bool,
}

impl Segment {
    /// Most tension with the bond divided by `reduction` \[force\] (theory, eq. 58).
    pub fn limit(&self, reduction: f64) -> f64 {
        let [head, end] = self
            .held
            .map(|hold| hold.fastened + hold.bonded / reduction);
        self.tensile.min(head).min(end)
    }
}

impl<const D: usize> Station<D> {
    /// Where it is \[length\].
    pub fn position(&self) -> [f64; D] {
        let mut mean = [0.0; D];
        for point in &self.points {
            for axis in 0..D {
                mean[axis] += point[axis] / self.points.len() as f64;
            }
        }
        mean
    }
}

impl<const D: usize> Reinforcement<D> {
    /// The largest tension along it \[force\].
    pub fn largest_force(&self) -> f64 {
        let forces = self.segments.iter().map(|segment| segment.state.force);
        forces.fold(0.0, f64::max)
    }

    /// Refuses numbers that are not finite, named with the member's number.
    fn is_finite(&self, index: usize) -> Result<(), AssemblyError> {
        let points = self.stations.iter().flat_map(|station| &station.points);
        let numbers = self.segments.iter().flat_map(|bar| {
            let state = [bar.state.strain, bar.state.slack, bar.state.force];
            [bar.length, bar.tensile, bar.limit(1.0)]
                .into_iter()
                .chain(state)
        });
        let is_finite = self.stiffness.is_finite()
            && points.flatten().all(|x| x.is_finite())
            && numbers.into_iter().all(f64::is_finite);
        if is_finite {
            Ok(())
        } else {
            let quantity = "reinforcement";
            Err(AssemblyError::NonFinite { quantity, index })
        }
    }
}
