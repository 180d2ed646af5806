//! Rigid bodies in space whose moments of inertia turn with them: the rate of their angular momentum, and their energy (theory,
//! eqs. 67d and 67e).

use igimp_rigid::{Gyration, NODES_PER_BODY};
use igimp_shape::matrices::apply;

use super::{Inertia, Motion};
use crate::conditions::time_step::Weights;

impl<const D: usize> Inertia<D> {
    /// Rigid bodies whose moments of inertia turn with them: the second of their nodes, and these moments.
    pub(super) fn with_gyrations(&self) -> impl Iterator<Item = (usize, &Gyration<D>)> {
        let first = self.mass.diagonal.len() + 1;
        let all = self.gyrations.iter().enumerate();
        all.filter_map(move |(body, g)| Some((first + NODES_PER_BODY * body, g.as_ref()?)))
    }

    /// Sets the force of acceleration of bodies that turn, by moments of inertia and spin where motion is in equilibrium (theory,
    /// eqs. 67d and 67e): accelerations `between` start and end are over the weight of forces at the end, and so is the force.
    pub(super) fn turn_moments(
        &self,
        u: &[[f64; D]],
        (motion, between): (&Motion<D>, &[[f64; D]]),
        force: &mut [[f64; D]],
    ) {
        for (node, gyration) in self.with_gyrations() {
            let (moments, spin) = self.turned_between(gyration, (node, u), motion);
            let rate = between[node].map(|rate| self.weight_of_end() * rate);
            let momentum = gyration.rate(&moments, [&spin, &rate]);
            force[node] = momentum.map(|value| value / self.weight_of_end());
        }
    }

    /// Moments of inertia \[mass\] and spin in lengths \[length/time\] where motion is in equilibrium, by the second node of a body.
    fn turned_between(
        &self,
        gyration: &Gyration<D>,
        (node, u): (usize, &[[f64; D]]),
        motion: &Motion<D>,
    ) -> ([[f64; D]; D], [f64; D]) {
        let of_end = self.weight_of_end();
        let moments = gyration.after(&u[node].map(|angle| of_end * angle));
        let (before, after) = (&self.velocity[node], &motion.after[node]);
        let spin = std::array::from_fn(|a| of_end * after[a] + (1.0 - of_end) * before[a]);
        (moments, spin)
    }

    /// The momentum that nodes gain by nodal step displacements `u` \[length\], moments of inertia turned \[mass·length/time\].
    pub(crate) fn gained(&self, motion: &Motion<D>, u: &[[f64; D]]) -> Vec<[f64; D]> {
        let gained: Vec<[f64; D]> = std::iter::zip(&motion.after, &motion.before)
            .map(|(after, before)| std::array::from_fn(|a| after[a] - before[a]))
            .collect();
        let mut gained = self.times(&gained);
        for (node, gyration) in self.with_gyrations() {
            let start = self.of_bodies[node - self.mass.diagonal.len()];
            let [before, after] = [
                (&start, &motion.before[node]),
                (&gyration.after(&u[node]), &motion.after[node]),
            ]
            .map(|(moments, spin)| apply(moments, spin));
            gained[node] = std::array::from_fn(|a| after[a] - before[a]);
        }
        gained
    }

    /// The sum over bodies of a (I₁ − I₀) b, by the moments of inertia at end and start of a step and velocities a and b by node
    /// \[force·length\].
    pub(crate) fn turned_product(&self, [a, b]: [&[[f64; D]]; 2], u: &[[f64; D]]) -> f64 {
        let of_body = |(node, gyration): (usize, &Gyration<D>)| -> f64 {
            let start = self.of_bodies[node - self.mass.diagonal.len()];
            let [after, before] =
                [&gyration.after(&u[node]), &start].map(|moments| apply(moments, &b[node]));
            (0..D).map(|k| a[node][k] * (after[k] - before[k])).sum()
        };
        self.with_gyrations().map(of_body).sum()
    }

    /// The derivative of the force that [`Self::turn_moments`] sets, by the second node of a body \[force/length\].
    pub(super) fn slope_of_moments(
        &self,
        gyration: &Gyration<D>,
        (node, u): (usize, &[[f64; D]]),
        motion: &Motion<D>,
    ) -> [[f64; D]; D] {
        let Weights {
            of_mass, of_force, ..
        } = self.step.scheme.weights();
        let of_end = self.weight_of_end();
        let (moments, spin) = self.turned_between(gyration, (node, u), motion);
        let (before, after) = (&self.acceleration[node], &motion.acceleration[node]);
        let rate = std::array::from_fn(|a| (1.0 - of_mass) * after[a] + of_mass * before[a]);
        let by = [
            (1.0 - of_mass) * self.step.rate(),
            (1.0 - of_force) * self.step.velocity_rate(),
            of_end,
        ];
        let slope = gyration.slope(&moments, [&spin, &rate], by);
        slope.map(|row| row.map(|entry| entry / of_end))
    }
}
