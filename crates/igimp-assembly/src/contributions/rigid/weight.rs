//! The moment of forces at the centre of mass of a rigid body: its weight, and −m a of ground that moves (theory, eq. 67c).

use crate::conditions::StepConditions;
use crate::contributions::nodal_forces::{AddBlock, NodalForces};
use crate::method::{Geometry, Method};
use igimp_rigid::{Arm, NODES_PER_BODY, RigidBody};

/// Adds forces at the centres of mass to the external force on the nodes of bodies \[force\]: their weight, by arms as the step begins.
pub(crate) fn add_weights<const D: usize>(
    bodies: &[RigidBody<D>],
    conditions: &StepConditions<D>,
    of_bodies: &mut [[f64; D]],
) {
    let nodes = of_bodies.chunks_exact_mut(NODES_PER_BODY);
    for ((body, motion), forces) in bodies.iter().zip(&conditions.motions).zip(nodes) {
        add_at(&mut forces[0], &motion.weight);
        if let Some(arm) = body.arm(true) {
            add_at(&mut forces[1], &arm.moment(&arm.at_start(), &motion.weight));
        }
    }
}

/// By how much moments at the centres of mass differ from those as the step begins, for bodies that turn in it.
#[derive(Debug)]
pub(crate) struct TurningWeights<const D: usize>(Vec<TurningWeight<D>>);

/// That of one body.
#[derive(Debug)]
struct TurningWeight<const D: usize> {
    /// The node of its rotation.
    node: usize,
    arm: Arm<D>,
    /// At its centre of mass \[force\].
    force: [f64; D],
}

impl<const D: usize> TurningWeights<D> {
    /// Of bodies in a step; none on a given geometry, where arms stay.
    pub(crate) fn find(
        bodies: &[RigidBody<D>],
        conditions: &StepConditions<D>,
        method: &Method,
    ) -> Self {
        let first = conditions.grid.node_count();
        let moving = method.geometry == Geometry::Moving;
        let ground = conditions.ground.filter(|_| conditions.time.is_some());
        let of_body = |(slot, body): (usize, &RigidBody<D>)| {
            let arm = body.arm(true)?;
            let weight = conditions
                .motions
                .get(slot)
                .map_or([0.0; D], |motion| motion.weight);
            let force = std::array::from_fn(|a| {
                weight[a] - ground.map_or(0.0, |ground| body.motion.mass * ground.acceleration[a])
            });
            let node = first + NODES_PER_BODY * slot + 1;
            force
                .iter()
                .any(|f| *f != 0.0)
                .then_some(TurningWeight { node, arm, force })
        };
        let all = bodies.iter().enumerate().filter(|_| moving);
        Self(all.filter_map(of_body).collect())
    }
}

impl<const D: usize> NodalForces<D> for TurningWeights<D> {
    fn pairs(&self) -> Vec<(usize, usize)> {
        Vec::new()
    }

    fn is_symmetric(&self) -> bool {
        true
    }

    fn add(&self, u: &[[f64; D]], f: &mut [[f64; D]], mut blocks: Option<&mut AddBlock<'_, D>>) {
        for weight in &self.0 {
            let arm = weight.arm.after(&u[weight.node]);
            let way = std::array::from_fn(|a| weight.arm.at_start()[a] - arm[a]);
            add_at(&mut f[weight.node], &weight.arm.moment(&way, &weight.force));
            if let Some(blocks) = &mut blocks {
                let turning = weight.arm.slope_of_moment(&u[weight.node], &weight.force);
                blocks(
                    weight.node,
                    weight.node,
                    &turning.map(|row| row.map(|entry| -entry)),
                );
            }
        }
    }
}

fn add_at<const D: usize>(sum: &mut [f64; D], force: &[f64; D]) {
    for (sum, force) in sum.iter_mut().zip(force) {
        *sum += force;
    }
}
