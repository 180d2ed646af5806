//! Sums at the knots of a rigid body (theory, eqs. 45 and 48a).

use std::collections::BTreeMap;

use igimp_rigid::Arms;

/// Sums at a knot.
#[derive(Default)]
pub(crate) struct Sums<const D: usize> {
    pub(crate) area: f64,
    /// The same over the thickness of the section.
    pub(crate) length: f64,
    /// Gap times area, of all faces, and of those that see the side with their area.
    pub(super) gap: f64,
    pub(super) seen_gap: f64,
    pub(super) seen_area: f64,
    /// The greatest component of the normal times area.
    pub(super) facing: f64,
    pub(crate) young: f64,
    pub(crate) adhesion: f64,
    pub(crate) cell: f64,
    pub(crate) opening: BTreeMap<usize, [f64; D]>,
    pub(crate) slip: [BTreeMap<usize, [f64; D]>; 2],
    /// Arms from the reference point of the body times the normal and times the tangents, times area.
    pub(crate) arms: Moments<D>,
}

/// Sums of arms times a direction, first the component of the arm; of the normal and of two tangents.
pub(crate) struct Moments<const D: usize>(pub(crate) [[[f64; D]; D]; 3]);

impl<const D: usize> Default for Moments<D> {
    fn default() -> Self {
        Self([[[0.0; D]; D]; 3])
    }
}

impl<const D: usize> Moments<D> {
    /// Adds an arm times directions that count by a weight.
    pub(super) fn add(&mut self, weight: f64, arm: &[f64; D], directions: [&[f64; D]; 3]) {
        for (sum, direction) in self.0.iter_mut().zip(directions) {
            for (row, arm) in sum.iter_mut().zip(arm) {
                for (entry, part) in row.iter_mut().zip(direction) {
                    *entry += weight * arm * part;
                }
            }
        }
    }
}

impl<const D: usize> Sums<D> {
    /// The mean gap of all soil around the knot \[length\].
    pub(crate) fn mean_gap(&self) -> f64 {
        self.gap / self.area
    }

    /// The mean arms of a body whose rotation is at a node, and that has a size \[length\].
    pub(crate) fn arms_of(&self, node: usize, size: f64) -> Arms<D> {
        let [opening, first, second] =
            (self.arms.0).map(|sum| sum.map(|row| row.map(|arm| arm / self.area)));
        Arms {
            node,
            size,
            opening,
            slip: [first, second],
        }
    }

    /// How much of an axis of the grid the normal has around the knot \[-\].
    pub(crate) fn facing(&self) -> f64 {
        self.facing / self.area
    }

    /// The mean gap of soil that sees the side, of all where none does \[length\].
    pub(crate) fn gap_in_front(&self) -> f64 {
        if self.seen_area > 0.0 {
            self.seen_gap / self.seen_area
        } else {
            self.mean_gap()
        }
    }
}
