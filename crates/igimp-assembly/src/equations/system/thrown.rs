//! Rigid bodies that a step in statics throws: no equilibrium goes on from where they stood (theory, eq. 48b).

use super::System;
use crate::error::AssemblyError;
use crate::method::Geometry;
use igimp_rigid::NODES_PER_BODY;
use igimp_surface::vectors::norm;

/// How far a body may be carried where it is free to go: the way of its reference point over its size \[-\], and its rotation \[rad\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach(f64, f64);

impl Reach {
    /// By corrections: some throw a body a little and take it back. A choice.
    pub const OF_CORRECTION: Self = Self(10.0, 1.0);

    /// By a step: directions of contact are those of its start, so that forces are wrong by as much as the body turns. A choice.
    pub const OF_STEP: Self = Self(1.0, 0.1);
}

impl<const D: usize> System<'_, D> {
    /// Refuses nodal step displacements `u` that carry a body beyond a reach, in statics on a moving geometry, by its free motion.
    /// Round bodies turn as they like.
    ///
    /// # Errors
    /// [`AssemblyError::Thrown`] for the first body.
    pub fn holds_bodies_within(&self, reach: Reach, u: &[[f64; D]]) -> Result<(), AssemblyError> {
        if self.conditions.time.is_some() || self.method.geometry == Geometry::Given {
            return Ok(());
        }
        let first = self.conditions.grid.node_count();
        for (index, body) in self.beside.contact.bodies().iter().enumerate() {
            let size = body.surface.size();
            let free = |node: usize| {
                let is_free = |axis| self.unknowns.index(node, axis).is_some();
                let value = |axis| if is_free(axis) { u[node][axis] } else { 0.0 };
                norm::<D>(&std::array::from_fn(value))
            };
            let node = first + NODES_PER_BODY * index;
            let (way, rotation) = (free(node), free(node + 1) / size);
            let turns_far = body.surface.radius().is_none() && rotation > reach.1;
            if way > reach.0 * size || turns_far {
                return Err(AssemblyError::Thrown {
                    body: body.name.clone(),
                    way,
                    rotation,
                });
            }
        }
        Ok(())
    }
}
