//! The motion of a step: how far particles go, what an out-of-balance force does to it, and where mass is in the matrix.

use rayon::prelude::*;

use crate::body::particles::CHUNK;
use crate::equations::residual::OutOfBalance;
use crate::equations::system::System;

impl<const D: usize> System<'_, D> {
    /// The displacement that the out-of-balance force at `u` \[length\] would add to a step if inertia alone answered it, as a share
    /// of the motion of the step (theory, eq. 68a) \[-\]: with stiffness it is less. None in statics.
    pub fn unbalanced_motion(&self, u: &[[f64; D]], residual: &OutOfBalance) -> Option<f64> {
        let inertia = self.inertia.as_ref()?;
        let mut squared = 0.0;
        for node in 0..u.len() {
            for axis in 0..D {
                let Some(unknown) = self.unknowns.index(node, axis) else {
                    continue;
                };
                let force = residual.force[unknown];
                if force != 0.0 {
                    squared += force * force / inertia.carried(node, axis);
                }
            }
        }
        Some(squared.sqrt() / inertia.mass_rate() / inertia.size_of_motion(u))
    }

    /// The longest way of a particle over a step by nodal displacements `u` \[length\].
    pub fn longest_way(&self, u: &[[f64; D]]) -> f64 {
        let ways: Vec<f64> = (self.stencils.order())
            .par_chunks(CHUNK)
            .map(|chunk| {
                let mut longest: f64 = 0.0;
                for &particle in chunk {
                    let mut way = [0.0; D];
                    for support in self.stencils.of(particle as usize) {
                        for (way, u) in way.iter_mut().zip(&u[support.node]) {
                            *way += support.value * u;
                        }
                    }
                    longest = longest.max(way.iter().map(|way| way * way).sum());
                }
                longest
            })
            .collect();
        ways.into_iter().fold(0.0, f64::max).sqrt()
    }

    /// The place in the matrix of what a component of the displacement of the column node does along itself to the row node; both of
    /// the grid. None where one of them is held.
    pub(crate) fn place_of(&self, row: usize, column: usize, axis: usize) -> Option<usize> {
        let rank = self.unknowns.index(row, axis)? - self.unknowns.before(row);
        let component = self.unknowns.index(column, axis)? - self.unknowns.before(column);
        Some(self.table.value(&self.pattern, column, component, row) + rank)
    }
}
