//! Inertia: the mass matrix of a step, the velocities that the grid takes over from the particles, and the force of
//! acceleration (theory, eqs. 60 to 63).
//!
//! ```math
//! M_{ij} = \sum_p m_p S_{ip} S_{jp},\qquad M\,v_0 = \sum_p m_p S_{ip} v_p,\qquad
//! f^{a}(u) = M \left[(1 - \alpha_m)\,a_1 + \alpha_m\,a_0\right]
//! ```
//!
//! The particles are the quadrature of the mass, as they are of stress: momentum and energy of the map are exact. Terms of rigid bodies
//! are in [`bodies`], those of their moments of inertia in [`turning`].

mod bodies;
mod turning;

use std::sync::OnceLock;

use igimp_shape::Support;

use crate::body::particles::Particles;
use crate::conditions::ground_motion::GroundMotion;
use crate::conditions::time_step::{TimeScheme, TimeStep, Weights};
use crate::contributions::nodal_forces::AddBlock;
use crate::contributions::nodal_mass::{NodalMass, add_scaled, mask, product};
use crate::error::AssemblyError;
use crate::method::Geometry;
use crate::step::stencils::Stencils;
use crate::step::unknowns::Unknowns;
use igimp_rigid::{Arm, Gyration, NODES_PER_BODY, RigidBody};

/// Inertia of one step.
#[derive(Debug)]
pub(crate) struct Inertia<const D: usize> {
    step: TimeStep,
    mass: NodalMass,
    /// The entries of the mass of soil by their places in the matrix, once they are known \[mass\].
    entries: OnceLock<Vec<(u32, f64)>>,
    /// By node that stands for the motion of a rigid body: its mass, or its moment of inertia over its squared size \[mass\].
    of_bodies: Vec<[[f64; D]; D]>,
    /// By rigid body whose centre of mass is not its reference point: from that to the centre. The motion of its nodes here is that
    /// of the centre.
    arms: Vec<Option<Arm<D>>>,
    /// By rigid body: its moments of inertia, where they turn with it.
    gyrations: Vec<Option<Gyration<D>>>,
    /// By node that stands for the motion of a rigid body: whether a component is given, and moves evenly.
    is_given: Vec<[bool; D]>,
    /// At the start, by node \[length/time\].
    velocity: Vec<[f64; D]>,
    /// The mean of that of the particles around each node, and that of rigid bodies \[length/time\].
    mean_velocity: Vec<[f64; D]>,
    /// At the start, by node; zero where the scheme does not ask for it \[length/time²\].
    acceleration: Vec<[f64; D]>,
    /// Internal less external force at the start, by node; empty where the scheme does not ask for it \[force\].
    force_at_start: Vec<[f64; D]>,
    /// Damping of soil by its mass \[1/time\].
    damping: f64,
    /// Whether velocities or accelerations at the start are means around nodes, as none that come closest were found.
    by_means: bool,
}

impl<const D: usize> Inertia<D> {
    /// The mass of particles and rigid bodies on the nodes of a step, and their motion: the one that comes closest to that of the
    /// particles, and where none is found means around nodes, which lose energy. Accelerations are those against ground that is accelerated
    /// as in this step.
    ///
    /// # Errors
    /// Never for particles of positive mass.
    pub(crate) fn of(
        (step, ground): (TimeStep, Option<GroundMotion<D>>),
        particles: &Particles<D>,
        (bodies, geometry): (&[RigidBody<D>], Geometry),
        stencils: &Stencils<D>,
        unknowns: &Unknowns<D>,
        mass_of: &(dyn Fn(usize) -> f64 + Sync),
    ) -> Result<Self, AssemblyError> {
        let nodes = unknowns.nodes_of_grid();
        let mass = NodalMass::of(step.lumped, mass_of, stencils, nodes);
        let by_share = |particle: usize, share: f64| mass_of(particle) * share;
        let by_size = |particle: usize, share: f64| mass_of(particle) * share.abs();
        let ones = vec![[1.0; D]; particles.len()];
        let share = weighted(&ones, &by_share, stencils, nodes);
        let on_grid = |values: &[[f64; D]]| {
            let sums = weighted(values, &by_share, stencils, nodes);
            let mean = over(&sums, &share);
            match mass.solve(&sums, mean.clone(), unknowns) {
                Ok(found) => Ok((found, mean, false)),
                // Shares below zero count by their size, so that means lie between the values of the particles.
                Err(AssemblyError::MotionNotFound { left }) if left.is_finite() => {
                    let sums = weighted(values, &by_size, stencils, nodes);
                    let mut found = over(&sums, &weighted(&ones, &by_size, stencils, nodes));
                    mask(&mut found, unknowns);
                    Ok((found, mean, true))
                }
                Err(error) => Err(error),
            }
        };
        let carries = step.asks_for_acceleration() && !step.is_first;
        let change = ground.map_or([0.0; D], |ground| ground.change());
        let carried = || {
            let shifted = |a: &[f64; D]| std::array::from_fn(|axis| a[axis] - change[axis]);
            let all: Vec<_> = particles.acceleration.iter().map(shifted).collect();
            on_grid(&all)
        };
        let (of_velocity, of_acceleration) = rayon::join(
            || on_grid(&particles.velocity),
            || carries.then(carried).transpose(),
        );
        let (mut velocity, mut mean_velocity, mut by_means) = of_velocity?;
        let mut acceleration = vec![[0.0; D]; nodes];
        if let Some((found, _, also)) = of_acceleration? {
            acceleration = found;
            by_means |= also;
        }
        for body in bodies {
            let nodal = body.nodal(&body.motion.velocity, &body.motion.spin);
            velocity.extend(nodal);
            mean_velocity.extend(nodal);
            let node = acceleration.len();
            let is_free = |axis: usize| unknowns.index(node, axis).is_some();
            let [mut of_way, of_turn] =
                body.nodal(&body.motion.acceleration, &body.motion.spin_rate);
            for axis in (0..D).filter(|&axis| is_free(axis)) {
                of_way[axis] -= change[axis];
            }
            acceleration.extend(if carries {
                [of_way, of_turn]
            } else {
                [[0.0; D]; NODES_PER_BODY]
            });
        }
        let turns = geometry == Geometry::Moving;
        let arms: Vec<_> = bodies.iter().map(|body| body.arm(turns)).collect();
        Ok(Self {
            of_bodies: bodies.iter().flat_map(RigidBody::nodal_mass).collect(),
            is_given: (nodes..velocity.len())
                .map(|node| std::array::from_fn(|axis| unknowns.index(node, axis).is_none()))
                .collect(),
            gyrations: (bodies.iter())
                .map(|body| body.gyration().filter(|_| turns))
                .collect(),
            arms,
            step,
            mass,
            entries: OnceLock::new(),
            velocity,
            mean_velocity,
            acceleration,
            force_at_start: Vec::new(),
            damping: 0.0,
            by_means,
        })
    }

    /// The time integration of the step.
    pub(crate) fn step(&self) -> &TimeStep {
        &self.step
    }

    /// Whether the motion at the start is that of means around nodes.
    pub(crate) fn is_by_means(&self) -> bool {
        self.by_means
    }

    /// Damps soil by so much of its mass \[1/time\].
    pub(crate) fn damp(&mut self, damping: f64) {
        self.damping = damping;
    }

    /// The accelerations at the start, by node \[length/time²\].
    pub(crate) fn acceleration(&self) -> &[[f64; D]] {
        &self.acceleration
    }

    /// Velocities at the start, by node \[length/time\].
    pub(crate) fn velocity(&self) -> &[[f64; D]] {
        &self.velocity
    }

    /// The force α M v of velocities by node, on soil alone \[force\].
    pub(crate) fn damping_force(&self, velocity: &[[f64; D]]) -> Vec<[f64; D]> {
        let nodes = self.mass.diagonal.len();
        let mut force = vec![[0.0; D]; velocity.len()];
        if self.damping != 0.0 {
            let (of_soil, soil) = (&mut force[..nodes], &velocity[..nodes]);
            self.mass.multiply(soil, of_soil);
            for value in of_soil.as_flattened_mut() {
                *value *= self.damping;
            }
        }
        force
    }

    /// Step displacements of nodes that go on as the soil around them moves at the start \[length\]: by the mean of the velocities of
    /// their particles, for those of nodes that few particles reach are in doubt.
    pub(crate) fn predicted(&self) -> Vec<[f64; D]> {
        self.ways(&self.mean_velocity)
    }

    /// Displacements of nodes that go on for the duration of the step with these velocities of theirs and of centres of mass \[length\].
    pub(crate) fn ways(&self, velocity: &[[f64; D]]) -> Vec<[f64; D]> {
        let duration = self.step.duration;
        let mut u: Vec<_> = velocity.iter().map(|v| v.map(|v| duration * v)).collect();
        for (node, arm) in self.with_arms() {
            let way = arm.way(&u[node + 1]);
            u[node] = std::array::from_fn(|axis| u[node][axis] - way[axis]);
        }
        u
    }

    /// The motion of the nodes over the step, by nodal step displacements `u` \[length\]. Given components of a rigid body move
    /// evenly, as by backward Euler (theory, eq. 67a).
    pub(crate) fn motion(&self, u: &[[f64; D]]) -> Motion<D> {
        let centred = self.of_centres(u);
        let mut motion = Motion {
            after: Vec::with_capacity(u.len()),
            acceleration: Vec::with_capacity(u.len()),
            before: self.velocity.clone(),
            keeps_rest: self.step.scheme == TimeScheme::Newmark,
        };
        for (u, (before, acceleration)) in std::iter::zip(
            &*centred,
            std::iter::zip(&self.velocity, &self.acceleration),
        ) {
            let (after, acceleration) = self.step.after(before, acceleration, u);
            motion.after.push(after);
            motion.acceleration.push(acceleration);
        }
        self.move_bodies(u, &mut motion);
        motion
    }

    /// Takes over the internal less the external `force` at the start, by node \[force\]: where motion begins with this step, the
    /// accelerations at the start follow from it.
    ///
    /// # Errors
    /// [`AssemblyError::MotionNotFound`].
    pub(crate) fn begin(
        &mut self,
        force: Vec<[f64; D]>,
        unknowns: &Unknowns<D>,
    ) -> Result<(), AssemblyError> {
        if self.step.is_first {
            let nodes = self.mass.diagonal.len();
            let driving = |node: &[f64; D]| node.map(|f| -f);
            let on_grid: Vec<_> = force[..nodes].iter().map(driving).collect();
            let still = vec![[0.0; D]; nodes];
            self.acceleration = self.mass.solve(&on_grid, still, unknowns)?;
            for body in 0..self.arms.len() {
                let begun = self.begun(body, &force, unknowns);
                self.acceleration.extend(begun);
            }
        }
        if self.step.scheme.weights().of_force > 0.0 {
            self.force_at_start = force;
        }
        Ok(())
    }

    /// Adds inertia at nodal step displacements `u` \[length\] to the internal force `f` \[force\], with the derivative of that of
    /// rigid bodies; the norm of the force of acceleration \[force\].
    pub(crate) fn add(
        &self,
        u: &[[f64; D]],
        f: &mut [[f64; D]],
        blocks: Option<&mut AddBlock<'_, D>>,
    ) -> f64 {
        let motion = self.motion(u);
        let force = self.force(&motion, u);
        let mut squared = 0.0;
        for (f, force) in f.iter_mut().zip(&force) {
            for a in 0..D {
                f[a] += force[a];
                squared += force[a] * force[a];
            }
        }
        if self.damping != 0.0 {
            for (f, force) in f.iter_mut().zip(self.damping_force(&motion.after)) {
                *f = std::array::from_fn(|a| f[a] + force[a]);
            }
        }
        if let Some(blocks) = blocks {
            self.add_mass_of_bodies(u, (&motion, &force), blocks);
        }
        squared.sqrt()
    }

    /// The weight 1 − α_f of the forces at the end of the step in its equilibrium (theory, eq. 61) \[-\].
    pub(crate) fn weight_of_end(&self) -> f64 {
        1.0 - self.step.scheme.weights().of_force
    }

    /// The force of acceleration by node, with the share of forces at the start in equilibrium between start and end: over the weight
    /// of those at the end \[force\].
    fn force(&self, motion: &Motion<D>, u: &[[f64; D]]) -> Vec<[f64; D]> {
        let Weights {
            of_mass, of_force, ..
        } = self.step.scheme.weights();
        if of_mass == 0.0 && of_force == 0.0 {
            let mut force = self.times(&motion.acceleration);
            self.turn_moments(u, (motion, &motion.acceleration), &mut force);
            return self.about_reference(force, Some(u));
        }
        let mut between = motion.acceleration.clone();
        for (value, before) in between.iter_mut().zip(&self.acceleration) {
            *value = std::array::from_fn(|a| {
                ((1.0 - of_mass) * value[a] + of_mass * before[a]) / (1.0 - of_force)
            });
        }
        self.accelerate_given(u, motion, &mut between);
        let mut force = self.times(&between);
        self.turn_moments(u, (motion, &between), &mut force);
        let mut force = self.about_reference(force, Some(u));
        add_scaled(
            &mut force,
            of_force / (1.0 - of_force),
            &self.force_at_start,
        );
        force
    }

    /// The force of an acceleration of all nodes and centres of mass, about the reference points as the step begins \[force\].
    pub(crate) fn force_of(&self, acceleration: &[[f64; D]]) -> Vec<[f64; D]> {
        self.about_reference(self.times(acceleration), None)
    }

    /// The factor of the mass in the derivative of the force \[1/time²\].
    pub(crate) fn mass_rate(&self) -> f64 {
        let weights = self.step.scheme.weights();
        self.step.rate() * (1.0 - weights.of_mass) / (1.0 - weights.of_force)
    }

    /// The error of the time integration over a step by `u` \[length\], as a share of the motion ‖u‖ + Δt² ‖a₁‖ (theory, eq. 68)
    /// \[-\]; none where the force of acceleration is `negligible` \[force\], as at rest. Given motion is not integrated.
    pub(crate) fn error(&self, u: &[[f64; D]], negligible: f64) -> f64 {
        let accelerated = self.motion(u).acceleration;
        let force = self.times(&accelerated);
        if product(&force, &force).sqrt() <= negligible {
            return 0.0;
        }
        let change: Vec<[f64; D]> = std::iter::zip(&accelerated, &self.acceleration)
            .map(|(after, before)| std::array::from_fn(|a| after[a] - before[a]))
            .collect();
        let size = |values: &[[f64; D]]| self.size(&self.integrated(values));
        let squared = self.step.duration.powi(2);
        let motion = size(&self.of_centres(u)) + squared * size(&accelerated);
        if motion > 0.0 {
            squared / 12.0 * size(&change) / motion
        } else {
            0.0
        }
    }

    /// Values by node without those of given motion of rigid bodies.
    fn integrated(&self, values: &[[f64; D]]) -> Vec<[f64; D]> {
        let mut integrated = values.to_vec();
        let of_bodies = &mut integrated[self.mass.diagonal.len()..];
        for (values, is_given) in of_bodies.iter_mut().zip(&self.is_given) {
            *values = std::array::from_fn(|a| if is_given[a] { 0.0 } else { values[a] });
        }
        integrated
    }

    /// The norm √(x M x) of values by node.
    fn size(&self, values: &[[f64; D]]) -> f64 {
        product(&self.times(values), values).max(0.0).sqrt()
    }

    /// The product of the mass matrix with values by node.
    pub(crate) fn times(&self, values: &[[f64; D]]) -> Vec<[f64; D]> {
        let nodes = self.mass.diagonal.len();
        let mut product = vec![[0.0; D]; values.len()];
        self.mass.multiply(&values[..nodes], &mut product[..nodes]);
        let of_bodies = std::iter::zip(&mut product[nodes..], &values[nodes..]);
        for ((product, value), mass) in of_bodies.zip(&self.of_bodies) {
            *product = std::array::from_fn(|a| (0..D).map(|b| mass[a][b] * value[b]).sum());
        }
        product
    }

    /// The round-off of the force of acceleration \[force\]: that of displacement and velocity, whose difference it is.
    pub(crate) fn round_off(&self) -> f64 {
        let rate = self.step.rate() * self.step.duration;
        let momentum = self.times(&self.velocity);
        let squared: f64 = momentum.as_flattened().iter().map(|p| p * p).sum();
        4.0 * f64::EPSILON * rate * squared.sqrt()
    }

    /// Adds the derivative of the force of acceleration of soil to the values of the matrix; the place of an entry by its row and
    /// column node and its component, if both are unknown.
    pub(crate) fn add_mass_of_soil(
        &self,
        values: &mut [f64],
        place: &dyn Fn(usize, usize, usize) -> Option<usize>,
    ) {
        let rate = self.mass_rate() + self.damping * self.step.velocity_rate();
        let entries = self.entries.get_or_init(|| {
            let mut entries = Vec::new();
            let mut add = |row: usize, column: usize, mass: f64| {
                let places = (0..D).filter_map(|axis| place(row, column, axis));
                entries.extend(places.map(|place| (place as u32, mass)));
            };
            for (node, &mass) in self.mass.diagonal.iter().enumerate() {
                if mass > 0.0 {
                    add(node, node, mass);
                }
            }
            for (node, other, mass) in self.mass.beyond_diagonal() {
                add(node, other, mass);
                add(other, node, mass);
            }
            entries
        });
        for &(place, mass) in entries {
            values[place as usize] += rate * mass;
        }
    }
}

/// How the nodes move over a step, and how particles take that over.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion<const D: usize> {
    /// Velocities at the start, by node \[length/time\].
    pub before: Vec<[f64; D]>,
    /// Velocities at the end, by node \[length/time\].
    pub after: Vec<[f64; D]>,
    /// Accelerations at the end, by node \[length/time²\].
    pub acceleration: Vec<[f64; D]>,
    /// Whether a particle keeps the part of its velocity that the grid does not carry.
    pub keeps_rest: bool,
}

impl<const D: usize> Motion<D> {
    /// The velocity of a particle at the end of the step, from that at its start (theory, eq. 63) \[length/time\].
    pub(crate) fn of_particle(&self, velocity: &[f64; D], supports: &[Support<D>]) -> [f64; D] {
        let mut rest = *velocity;
        let mut after = [0.0; D];
        for support in supports {
            let (from, to) = (&self.before[support.node], &self.after[support.node]);
            for a in 0..D {
                rest[a] -= support.value * from[a];
                after[a] += support.value * to[a];
            }
        }
        if self.keeps_rest {
            for a in 0..D {
                after[a] += rest[a];
            }
        }
        after
    }
}

/// Values of particles by node, each times the weight of a particle and its share S_ip at the node \[mass\]: Σ_p w(p, S_ip) a_p.
fn weighted<const D: usize>(
    values: &[[f64; D]],
    weight: &dyn Fn(usize, f64) -> f64,
    stencils: &Stencils<D>,
    nodes: usize,
) -> Vec<[f64; D]> {
    let mut sums = vec![[0.0; D]; nodes];
    for &particle in stencils.order() {
        let particle = particle as usize;
        for support in stencils.of(particle) {
            let weight = weight(particle, support.value);
            for a in 0..D {
                sums[support.node][a] += weight * values[particle][a];
            }
        }
    }
    sums
}

/// Sums over their weights by node, zero where there is no weight.
fn over<const D: usize>(sums: &[[f64; D]], weights: &[[f64; D]]) -> Vec<[f64; D]> {
    let mean = |sum: f64, weight: f64| if weight > 0.0 { sum / weight } else { 0.0 };
    std::iter::zip(sums, weights)
        .map(|(sum, weight)| std::array::from_fn(|a| mean(sum[a], weight[a])))
        .collect()
}
