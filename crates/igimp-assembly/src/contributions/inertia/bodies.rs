//! Rigid bodies in motion: their centres of mass, and forces at the nodes that stand for bodies (theory, eqs. 67 to 67c).

use std::borrow::Cow;

use igimp_rigid::{Arm, NODES_PER_BODY};
use igimp_shape::matrices::{multiply, transpose};
use nalgebra::{DMatrix, DVector};

use super::{Inertia, Motion};
use crate::conditions::time_step::{TimeScheme, TimeStep, Weights};
use crate::contributions::nodal_forces::AddBlock;
use crate::step::unknowns::Unknowns;

impl<const D: usize> Inertia<D> {
    /// Rigid bodies whose centre of mass is not their reference point: the first of their nodes, and the arm.
    pub(super) fn with_arms(&self) -> impl Iterator<Item = (usize, &Arm<D>)> {
        let first = self.mass.diagonal.len();
        let arms = self.arms.iter().enumerate();
        arms.filter_map(move |(body, arm)| Some((first + NODES_PER_BODY * body, arm.as_ref()?)))
    }

    /// Nodal step displacements `u` \[length\] with those of the centres of mass in place of those of reference points.
    pub(crate) fn of_centres<'u>(&self, u: &'u [[f64; D]]) -> Cow<'u, [[f64; D]]> {
        let mut u = Cow::Borrowed(u);
        for (node, arm) in self.with_arms() {
            let way = arm.way(&u[node + 1]);
            let displacement = &mut u.to_mut()[node];
            *displacement = std::array::from_fn(|axis| displacement[axis] + way[axis]);
        }
        u
    }

    /// The nodes that stand for the motion of rigid bodies.
    fn of_rigid(&self) -> std::ops::Range<usize> {
        let first = self.mass.diagonal.len();
        first..first + self.is_given.len()
    }

    /// Sets the given motion of rigid bodies over a step by nodal step displacements `u` \[length\]: it moves evenly, and a
    /// centre of mass beside it as the body turns.
    pub(super) fn move_bodies(&self, u: &[[f64; D]], motion: &mut Motion<D>) {
        for node in self.of_rigid() {
            let (before, still) = (&self.velocity[node], [0.0; D]);
            let (after, acceleration) = self.evenly().after(before, &still, &u[node]);
            for axis in self.given_of(node) {
                motion.after[node][axis] = after[axis];
                motion.acceleration[node][axis] = acceleration[axis];
            }
        }
        for (node, arm) in self.with_arms() {
            let [of_reference, blow] = self.even(node, arm, u);
            let (spin, rate) = (motion.after[node + 1], motion.acceleration[node + 1]);
            let offset = arm.after(&u[node + 1]);
            let velocity = arm.carried(&offset, &spin);
            let acceleration = accelerated(arm, &offset, [&spin, &rate]);
            for axis in self.given_of(node) {
                motion.after[node][axis] = of_reference[axis] + velocity[axis];
                motion.acceleration[node][axis] = blow[axis] + acceleration[axis];
            }
        }
    }

    /// Sets accelerations of given motion of rigid bodies between start and end of a step, over the weight of forces at its end: the blow
    /// that takes it to its speed is that of the step.
    pub(super) fn accelerate_given(
        &self,
        u: &[[f64; D]],
        motion: &Motion<D>,
        between: &mut [[f64; D]],
    ) {
        let Weights {
            of_mass, of_force, ..
        } = self.step.scheme.weights();
        for node in self.of_rigid() {
            for axis in self.given_of(node) {
                between[node][axis] = motion.acceleration[node][axis] / (1.0 - of_force);
            }
        }
        for (node, arm) in self.with_arms() {
            let [_, blow] = self.even(node, arm, u);
            let offset = self.arm_between(arm, &u[node + 1]);
            let [spin, rate] = [
                (of_force, &motion.after, &self.velocity),
                (of_mass, &motion.acceleration, &self.acceleration),
            ]
            .map(|(of_start, after, before)| {
                let turn = node + 1;
                std::array::from_fn(|a| {
                    (1.0 - of_start) * after[turn][a] + of_start * before[turn][a]
                })
            });
            let turned = accelerated(arm, &offset, [&spin, &rate]);
            for axis in self.given_of(node) {
                between[node][axis] = (blow[axis] + turned[axis]) / (1.0 - of_force);
            }
        }
    }

    /// The given components of the body that a node stands for.
    pub(super) fn given_of(&self, node: usize) -> impl Iterator<Item = usize> + use<D> {
        let is_given = self.is_given[node - self.mass.diagonal.len()];
        (0..D).filter(move |&axis| is_given[axis])
    }

    /// Velocity and acceleration of a reference point beside the centre of mass that goes evenly, by the first node of its body.
    fn even(&self, node: usize, arm: &Arm<D>, u: &[[f64; D]]) -> [[f64; D]; 2] {
        let by_spin = arm.carried(&arm.at_start(), &self.velocity[node + 1]);
        let before = std::array::from_fn(|a| self.velocity[node][a] - by_spin[a]);
        let (after, blow) = self.evenly().after(&before, &[0.0; D], &u[node]);
        [after, blow]
    }

    /// The time integration of given motion.
    fn evenly(&self) -> TimeStep {
        TimeStep {
            scheme: TimeScheme::BackwardEuler,
            ..self.step
        }
    }

    /// The arm of a centre of mass where motion is in equilibrium, between start and end of a step that turns the body by a rotation in
    /// lengths \[length\].
    fn arm_between(&self, arm: &Arm<D>, rotation: &[f64; D]) -> [f64; D] {
        let (start, way) = (arm.at_start(), arm.after(rotation));
        let of_end = self.weight_of_end();
        std::array::from_fn(|a| of_end * way[a] + (1.0 - of_end) * start[a])
    }

    /// Forces by node with those at the centres of mass about the reference points \[force\]: in a step by `u` \[length\], or as it
    /// starts.
    pub(super) fn about_reference(
        &self,
        mut force: Vec<[f64; D]>,
        u: Option<&[[f64; D]]>,
    ) -> Vec<[f64; D]> {
        for (node, arm) in self.with_arms() {
            let offset = u.map_or(arm.at_start(), |u| self.arm_between(arm, &u[node + 1]));
            let moment = arm.moment(&offset, &force[node]);
            for (sum, moment) in force[node + 1].iter_mut().zip(moment) {
                *sum += moment;
            }
        }
        force
    }

    /// The accelerations of a rigid body as motion begins, by the internal less the external `force` on its nodes: of its centre of mass,
    /// and of its rotation in lengths \[length/time²\].
    pub(super) fn begun(
        &self,
        body: usize,
        force: &[[f64; D]],
        unknowns: &Unknowns<D>,
    ) -> [[f64; D]; NODES_PER_BODY] {
        let first = NODES_PER_BODY * body;
        let node = self.mass.diagonal.len() + first;
        let [of_way, of_turn] = [self.of_bodies[first], self.of_bodies[first + 1]];
        let arm = self.arms[body].as_ref();
        let lever = arm.map_or([[0.0; D]; D], |arm| arm.lever(&arm.at_start()));
        let is_free = |k: usize| {
            unknowns.index(node + k / D, k % D).is_some()
                && [of_way, of_turn][k / D][k % D][k % D] > 0.0
        };
        let free: Vec<usize> = (0..2 * D).filter(|&k| is_free(k)).collect();
        // Of the motion of reference point and rotation: the mass at the centre goes by the lever.
        let mass = |row: usize, column: usize| {
            let (a, b) = (row % D, column % D);
            let coupling = |row: usize, column: usize| {
                (0..D)
                    .map(|k| of_way[row][k] * lever[k][column])
                    .sum::<f64>()
            };
            match (row / D, column / D) {
                (0, 0) => of_way[a][b],
                (0, _) => coupling(a, b),
                (_, 0) => coupling(b, a),
                _ => of_turn[a][b] + (0..D).map(|k| lever[k][a] * coupling(k, b)).sum::<f64>(),
            }
        };
        let pulled = arm.map_or([0.0; D], |arm| {
            arm.pulled(&arm.at_start(), &self.velocity[node + 1])
        });
        let spinning = self.gyrations[body].as_ref().map_or([0.0; D], |gyration| {
            gyration.rate(&of_turn, [&self.velocity[node + 1], &[0.0; D]])
        });
        let driving = |row: usize| {
            let of_pull = |a: usize| mass(row, a) * pulled[a];
            let of_spin = if row < D { 0.0 } else { spinning[row - D] };
            -force[node + row / D][row % D] - of_spin - (0..D).map(of_pull).sum::<f64>()
        };
        let len = free.len();
        let masses = DMatrix::from_fn(len, len, |row, column| mass(free[row], free[column]));
        let forces = DVector::from_fn(len, |row, _| driving(free[row]));
        // Nothing of a body that is driven is free.
        let found = (len > 0).then(|| masses.lu().solve(&forces)).flatten();
        let mut begun = [[0.0; D]; NODES_PER_BODY];
        for (&row, value) in free.iter().zip(found.iter().flatten()) {
            begun[row / D][row % D] = *value;
        }
        let turn = begun[1];
        for (a, rate) in begun[0].iter_mut().enumerate() {
            *rate += pulled[a] + (0..D).map(|k| lever[a][k] * turn[k]).sum::<f64>();
        }
        begun
    }

    /// Hands the derivative of the force of acceleration of rigid bodies, which is `force` by node, on in blocks of nodes.
    pub(super) fn add_mass_of_bodies(
        &self,
        u: &[[f64; D]],
        (motion, force): (&Motion<D>, &[[f64; D]]),
        blocks: &mut AddBlock<'_, D>,
    ) {
        let rate = self.mass_rate();
        for (node, mass) in self.of_bodies.iter().enumerate() {
            let turning =
                (node % NODES_PER_BODY == 1).then(|| self.gyrations[node / NODES_PER_BODY]);
            let node = self.mass.diagonal.len() + node;
            let block = turning.flatten().map_or_else(
                || mass.map(|row| row.map(|m| rate * m)),
                |gyration| self.slope_of_moments(&gyration, (node, u), motion),
            );
            blocks(node, node, &block);
        }
        for (node, arm) in self.with_arms() {
            let mass = self.of_bodies[node - self.mass.diagonal.len()][0][0];
            let moved = arm.slope_of_way(&u[node + 1]);
            let lever = transpose(&arm.lever(&self.arm_between(arm, &u[node + 1])));
            let turning = arm.slope_of_moment(&u[node + 1], &force[node]);
            let by_mass = |block: &[[f64; D]; D]| block.map(|row| row.map(|v| rate * mass * v));
            blocks(node, node + 1, &by_mass(&moved));
            blocks(node + 1, node, &by_mass(&lever));
            let both = by_mass(&multiply(&lever, &moved));
            let entry = |a: usize, b: usize| both[a][b] + self.weight_of_end() * turning[a][b];
            blocks(
                node + 1,
                node + 1,
                &std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b))),
            );
        }
    }
}

/// The acceleration of a centre of mass against the reference point by an arm, from spin and rate of spin \[length/time²\].
fn accelerated<const D: usize>(
    arm: &Arm<D>,
    offset: &[f64; D],
    [spin, rate]: [&[f64; D]; 2],
) -> [f64; D] {
    let (along, towards) = (arm.carried(offset, rate), arm.pulled(offset, spin));
    std::array::from_fn(|a| along[a] + towards[a])
}
