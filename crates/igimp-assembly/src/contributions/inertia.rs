//! Inertia: the mass matrix of a step, the velocities that the grid takes over from the particles, and the force of
//! acceleration (theory, eqs. 60 to 63).
//!
//! ```math
//! M_{ij} = \sum_p m_p S_{ip} S_{jp},\qquad M\,v_0 = \sum_p m_p S_{ip} v_p,\qquad
//! f^{a}(u) = \frac{M\,(u - \Delta t\,v_0)}{(\theta\,\Delta t)^2}
//! ```
//!
//! The particles are the quadrature of the mass, as they are of stress: momentum and energy of the map are exact.

use igimp_shape::Support;
use rayon::prelude::*;

use crate::body::particles::Particles;
use crate::conditions::time_step::{MassMatrix, TimeScheme, TimeStep};
use crate::contributions::nodal_forces::AddBlock;
use crate::contributions::rigid::{NODES_PER_BODY, RigidBody};
use crate::step::stencils::Stencils;
use crate::step::strips::split;
use crate::step::unknowns::Unknowns;

/// The squared residual of the velocities of the grid over that of none at which they are found \[-\].
const FOUND: f64 = 1e-28;

/// Most iterations for the velocities of the grid: the scaled matrix is well conditioned, but for nodes that few particles reach.
const MOST_ITERATIONS: usize = 200;

/// Inertia of one step.
#[derive(Debug)]
pub(crate) struct Inertia<const D: usize> {
    step: TimeStep,
    mass: NodalMass,
    /// By node that stands for the motion of a rigid body: its mass, or its moment of inertia over its squared size \[mass\].
    of_bodies: Vec<[[f64; D]; D]>,
    /// Velocity at the start by node \[length/time\].
    velocity: Vec<[f64; D]>,
    /// The part of the mean force of the step that its start determines, (1 − θ)/θ (f_int − f_ext), by node \[force\].
    start: Vec<[f64; D]>,
}

impl<const D: usize> Inertia<D> {
    /// The mass of particles and rigid bodies on the nodes of a step, and their velocities.
    pub(crate) fn of(
        step: TimeStep,
        particles: &Particles<D>,
        bodies: &[RigidBody<D>],
        stencils: &Stencils<D>,
        unknowns: &Unknowns<D>,
        mass_of: &(dyn Fn(usize) -> f64 + Sync),
    ) -> Self {
        let nodes = unknowns.nodes_of_grid();
        let mass = NodalMass::of(step.mass, mass_of, stencils, nodes);
        let momentum = momentum(particles, mass_of, stencils, nodes);
        let mut velocity = grid_velocity(&mass, momentum, unknowns);
        let mut of_bodies = Vec::with_capacity(NODES_PER_BODY * bodies.len());
        for body in bodies {
            of_bodies.extend(body.nodal_mass());
            velocity.extend(body.nodal_velocity());
        }
        Self {
            start: vec![[0.0; D]; velocity.len()],
            step,
            mass,
            of_bodies,
            velocity,
        }
    }

    /// The time integration of the step.
    pub(crate) fn step(&self) -> &TimeStep {
        &self.step
    }

    /// The motion of the nodes over the step, by nodal step displacements `u` \[length\].
    pub(crate) fn motion(&self, u: &[[f64; D]]) -> Motion<D> {
        let nodes = std::iter::zip(&self.velocity, u);
        Motion {
            after: nodes
                .map(|(before, u)| self.step.velocity_after(before, u))
                .collect(),
            before: self.velocity.clone(),
            keeps_rest: self.step.scheme == TimeScheme::Newmark,
        }
    }

    /// Keeps what the start of the step determines of its mean force: the internal force less the external one there, by node
    /// \[force\].
    pub(crate) fn begin(&mut self, f_int: &[[f64; D]], f_ext: &[[f64; D]]) {
        let theta = self.step.scheme.theta();
        let share = (1.0 - theta) / theta;
        for (node, start) in self.start.iter_mut().enumerate() {
            *start = std::array::from_fn(|a| share * (f_int[node][a] - f_ext[node][a]));
        }
    }

    /// Adds inertia at nodal step displacements `u` \[length\] to the internal force `f` \[force\], with its derivative; the norm
    /// of the force of acceleration \[force\].
    pub(crate) fn add(
        &self,
        u: &[[f64; D]],
        f: &mut [[f64; D]],
        blocks: Option<&mut AddBlock<'_, D>>,
    ) -> f64 {
        let force = self.force(u);
        let mut squared = 0.0;
        for ((f, force), start) in f.iter_mut().zip(&force).zip(&self.start) {
            for a in 0..D {
                f[a] += force[a] + start[a];
                squared += force[a] * force[a];
            }
        }
        if let Some(blocks) = blocks {
            self.add_mass(blocks);
        }
        squared.sqrt()
    }

    /// The force of acceleration M (u − Δt v₀)/(θ Δt)² by node \[force\].
    pub(crate) fn force(&self, u: &[[f64; D]]) -> Vec<[f64; D]> {
        let (rate, duration) = (self.step.rate(), self.step.duration);
        let ahead: Vec<[f64; D]> = std::iter::zip(u, &self.velocity)
            .map(|(u, v)| std::array::from_fn(|a| rate * (u[a] - duration * v[a])))
            .collect();
        self.times(&ahead)
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

    /// Hands the mass over (θ Δt)² on in blocks of nodes.
    fn add_mass(&self, blocks: &mut AddBlock<'_, D>) {
        let rate = self.step.rate();
        let scaled = |mass: f64| {
            let mut block = [[0.0; D]; D];
            for (a, row) in block.iter_mut().enumerate() {
                row[a] = rate * mass;
            }
            block
        };
        let NodalMass { diagonal, beyond } = &self.mass;
        for (node, &own) in diagonal.iter().enumerate() {
            if own > 0.0 {
                blocks(node, node, &scaled(own));
            }
        }
        for (node, row) in beyond.iter().enumerate() {
            for &(other, mass) in row {
                let block = scaled(mass);
                blocks(node, other as usize, &block);
                blocks(other as usize, node, &block);
            }
        }
        for (node, mass) in self.of_bodies.iter().enumerate() {
            let node = diagonal.len() + node;
            blocks(node, node, &mass.map(|row| row.map(|own| rate * own)));
        }
    }
}

/// Velocities of the nodes at the ends of a step, and how particles take them over.
#[derive(Clone, Debug)]
pub struct Motion<const D: usize> {
    /// At the start, by node \[length/time\].
    pub before: Vec<[f64; D]>,
    /// At the end, by node \[length/time\].
    pub after: Vec<[f64; D]>,
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

/// The mass matrix of the grid: the same for every component.
#[derive(Debug)]
struct NodalMass {
    /// M_ii by node \[mass\].
    diagonal: Vec<f64>,
    /// By node, the nodes behind it that it shares particles with, and M_ij \[mass\].
    beyond: Vec<Vec<(u32, f64)>>,
}

impl NodalMass {
    /// Sums the mass matrix over the particles, strip by strip.
    fn of<const D: usize>(
        kind: MassMatrix,
        mass_of: &(dyn Fn(usize) -> f64 + Sync),
        stencils: &Stencils<D>,
        nodes: usize,
    ) -> Self {
        let mut mass = Self {
            diagonal: vec![0.0; nodes],
            beyond: vec![Vec::new(); nodes],
        };
        for parity in 0..2 {
            let strips = stencils.strips().of_parity(parity);
            let nodes = strips.clone().map(|(nodes, _)| nodes.clone());
            let diagonal = split(&mut mass.diagonal, nodes.clone());
            let beyond = split(&mut mass.beyond, nodes);
            let tasks: Vec<_> = strips.zip(diagonal).zip(beyond).collect();
            tasks
                .into_par_iter()
                .for_each(|(((nodes, slots), diagonal), beyond)| {
                    for &particle in &stencils.order()[slots.clone()] {
                        let own = stencils.of(particle as usize);
                        let m = mass_of(particle as usize);
                        for (k, row) in own.iter().enumerate() {
                            let share = m * row.value;
                            if kind == MassMatrix::Lumped {
                                diagonal[row.node - nodes.start] += share;
                                continue;
                            }
                            diagonal[row.node - nodes.start] += share * row.value;
                            let row = &mut beyond[row.node - nodes.start];
                            for other in &own[k + 1..] {
                                add_entry(row, other.node as u32, share * other.value);
                            }
                        }
                    }
                });
        }
        mass
    }

    /// The product with values by node.
    fn multiply<const D: usize>(&self, values: &[[f64; D]], product: &mut [[f64; D]]) {
        for (node, own) in self.diagonal.iter().enumerate() {
            product[node] = values[node].map(|value| own * value);
        }
        for (node, row) in self.beyond.iter().enumerate() {
            let mut sum = product[node];
            for &(other, mass) in row {
                for a in 0..D {
                    sum[a] += mass * values[other as usize][a];
                    product[other as usize][a] += mass * values[node][a];
                }
            }
            product[node] = sum;
        }
    }
}

/// Adds to the entry of a node in a row.
fn add_entry(row: &mut Vec<(u32, f64)>, node: u32, mass: f64) {
    match row.iter_mut().find(|(own, _)| *own == node) {
        Some((_, sum)) => *sum += mass,
        None => row.push((node, mass)),
    }
}

/// The momentum of the particles by node, Σ_p m_p S_ip v_p \[mass·length/time\].
fn momentum<const D: usize>(
    particles: &Particles<D>,
    mass_of: &(dyn Fn(usize) -> f64 + Sync),
    stencils: &Stencils<D>,
    nodes: usize,
) -> Vec<[f64; D]> {
    let mut momentum = vec![[0.0; D]; nodes];
    for &particle in stencils.order() {
        let particle = particle as usize;
        let (m, v) = (mass_of(particle), particles.velocity[particle]);
        for support in stencils.of(particle) {
            for a in 0..D {
                momentum[support.node][a] += m * support.value * v[a];
            }
        }
    }
    momentum
}

/// The velocities of the nodes of the grid that come closest to those of the particles, weighted by mass: M v₀ = Σ_p m_p S_ip v_p
/// where a component is unknown, zero where it is not \[length/time\]. Conjugate gradients, scaled by the diagonal.
fn grid_velocity<const D: usize>(
    mass: &NodalMass,
    mut momentum: Vec<[f64; D]>,
    unknowns: &Unknowns<D>,
) -> Vec<[f64; D]> {
    let nodes = mass.diagonal.len();
    let free = |node: usize, axis: usize| unknowns.index(node, axis).is_some();
    let masked = |values: &mut [[f64; D]]| {
        for (node, values) in values.iter_mut().enumerate() {
            for (a, value) in values.iter_mut().enumerate() {
                if !free(node, a) {
                    *value = 0.0;
                }
            }
        }
    };
    let scaled = |values: &[[f64; D]]| -> Vec<[f64; D]> {
        std::iter::zip(values, &mass.diagonal)
            .map(|(value, own)| value.map(|v| if *own > 0.0 { v / own } else { 0.0 }))
            .collect()
    };
    let product = |a: &[[f64; D]], b: &[[f64; D]]| -> f64 {
        std::iter::zip(a.as_flattened(), b.as_flattened())
            .map(|(a, b)| a * b)
            .sum()
    };
    masked(&mut momentum);
    let mut velocity = scaled(&momentum);
    let mut image = vec![[0.0; D]; nodes];
    let mut left = momentum.clone();
    let reference = product(&momentum, &velocity);
    if reference == 0.0 {
        return velocity;
    }
    mass.multiply(&velocity, &mut image);
    masked(&mut image);
    subtract(&mut left, 1.0, &image);
    let mut towards = scaled(&left);
    let mut way = towards.clone();
    let mut size = product(&left, &towards);
    for _ in 0..MOST_ITERATIONS {
        if size <= FOUND * reference {
            break;
        }
        mass.multiply(&way, &mut image);
        masked(&mut image);
        let curvature = product(&way, &image);
        if curvature <= 0.0 {
            break;
        }
        let length = size / curvature;
        subtract(&mut velocity, -length, &way);
        subtract(&mut left, length, &image);
        towards = scaled(&left);
        let next = product(&left, &towards);
        let turn = next / size;
        size = next;
        for (way, towards) in way.iter_mut().zip(&towards) {
            for a in 0..D {
                way[a] = towards[a] + turn * way[a];
            }
        }
    }
    velocity
}

/// Takes `factor` times `other` from values.
fn subtract<const D: usize>(values: &mut [[f64; D]], factor: f64, other: &[[f64; D]]) {
    for (value, other) in values.iter_mut().zip(other) {
        for a in 0..D {
            value[a] -= factor * other[a];
        }
    }
}
