//! Constants of a step: the particles that water flows through, their pressures, and the openings where it leaves.

use igimp_shape::{Grid, Support, cell_parts};
use rayon::prelude::*;

use crate::body::particles::Particles;
use crate::conditions::StepConditions;
use crate::conditions::pore_flow::{Consolidating, Permeable};
use crate::contributions::consolidation::faces::{Opening, openings};
use crate::contributions::consolidation::{
    Consolidation, Leak, NONE, PressureSupport, Seeping, Share,
};
use crate::contributions::pore_water::Pores;
use crate::error::AssemblyError;
use crate::method::{Kinematics, Method};
use crate::step::domain::{capped_half_length, off_grid};
use crate::step::hoops::{centroid_of_cell, weigh_by_radius};
use crate::step::stencils::Stencils;
use crate::step::unknowns::Unknowns;
use igimp_rigid::RigidBody;

/// By how much water leaves more easily where a face or a drain is open than it comes there across a cell \[-\].
const OPEN: f64 = 1e3;

/// Particles, neighbours as a rule, that one thread gathers.
const TOGETHER: usize = 256;

/// Gathers the particles of a step.
struct Gathering<'a, const D: usize> {
    flow: &'a Consolidating<D>,
    particles: &'a Particles<D>,
    stencils: &'a Stencils<D>,
    conditions: &'a StepConditions<D>,
    method: &'a Method,
    pores: &'a Pores,
    /// By node of the grid: the number of its pressure.
    numbers: Vec<u32>,
}

/// A particle that water flows through, and its soil.
struct Gathered<const D: usize> {
    seeping: Seeping<D>,
    /// Oedometric modulus \[force/length²\].
    modulus: f64,
    /// Growth of its water if that went on as in the step before \[length^D\].
    expected: f64,
}

impl<const D: usize> Consolidation<D> {
    /// The consolidation of a step, whose unknowns are numbered and whose given water is known.
    ///
    /// # Errors
    /// [`AssemblyError::Shape`] names a particle whose centre left the grid.
    pub(crate) fn find(
        particles: &Particles<D>,
        bodies: &[RigidBody<D>],
        stencils: &Stencils<D>,
        (conditions, method): (&StepConditions<D>, &Method),
        unknowns: &Unknowns<D>,
        pores: &Pores,
    ) -> Result<Self, AssemblyError> {
        let flow = conditions.flow.as_ref();
        let Some(flow) = flow.filter(|_| unknowns.scalar_count() > 0) else {
            return Ok(Self::default());
        };
        let grid = &conditions.grid;
        let nodes: Vec<usize> = unknowns.scalar_nodes().collect();
        let mut numbers = vec![NONE; grid.node_count()];
        for (number, &node) in nodes.iter().enumerate() {
            numbers[node] = number as u32;
        }
        let gathering = Gathering {
            flow,
            particles,
            stencils,
            conditions,
            method,
            pores,
            numbers,
        };
        let mut consolidation = Self {
            first: unknowns.first_scalar(),
            place_of: vec![NONE; particles.len()],
            shares: vec![Share::default(); nodes.len()],
            nodes,
            of_rate: flow.weights()[1],
            duration: flow.duration,
            finite: method.kinematics_of_step() == Kinematics::FiniteStrain,
            ..Self::default()
        };
        let parts = stencils.order().par_chunks(TOGETHER);
        let parts = parts.map(|particles| gathering.particles(particles));
        let side = least_side(grid);
        for part in parts.collect::<Result<Vec<_>, _>>()? {
            consolidation.append(part, side);
        }
        let near_body =
            |x: &[f64; D], reach: f64| bodies.iter().any(|body| body.distance(x) < reach);
        let openings = openings(particles, (conditions, method), flow, &near_body)?;
        let leaks = openings.iter().map(|opening| gathering.leak(opening));
        consolidation.leaks = leaks.filter(|leak| !leak.values.is_empty()).collect();
        Ok(consolidation)
    }

    /// Appends particles with their supports, on a grid whose shortest side of a cell is `side`.
    fn append(
        &mut self,
        (gathered, supports): (Vec<Gathered<D>>, Vec<PressureSupport<D>>),
        side: f64,
    ) {
        let before = self.supports.len() as u32;
        for entry in gathered {
            let Gathered {
                mut seeping,
                modulus,
                expected,
            } = entry;
            self.scale = self.scale.max(modulus / side);
            let volume = seeping.volume;
            for support in &supports[seeping.first as usize..][..seeping.len as usize] {
                let share = &mut self.shares[support.place as usize];
                share.volume += volume * support.mean;
                share.stiffness += volume * support.mean * modulus;
                share.expected += volume * support.mean * expected;
            }
            seeping.first += before;
            self.place_of[seeping.particle as usize] = self.seeping.len() as u32;
            self.seeping.push(seeping);
        }
        self.supports.extend(supports);
    }
}

impl<const D: usize> Gathering<'_, D> {
    /// Those of some particles that water flows through, with their supports.
    fn particles(
        &self,
        particles: &[u32],
    ) -> Result<(Vec<Gathered<D>>, Vec<PressureSupport<D>>), AssemblyError> {
        let (mut gathered, mut supports) = (Vec::new(), Vec::new());
        for &particle in particles {
            let law = self.particles.law[particle as usize];
            if let Some(soil) = self.flow.permeable(law) {
                gathered.push(self.particle(particle, soil, &mut supports)?);
            }
        }
        Ok((gathered, supports))
    }

    /// A particle of soil that water flows through; its supports go to the others.
    fn particle(
        &self,
        number: u32,
        soil: &Permeable<D>,
        supports: &mut Vec<PressureSupport<D>>,
    ) -> Result<Gathered<D>, AssemblyError> {
        let (particles, particle) = (self.particles, number as usize);
        let laws = &self.conditions.laws;
        let bound = laws[particles.law[particle]].stiffness_bound();
        let ratio = particles.ratios[particle].stiffness;
        let modulus = ratio * (bound.bulk() + 4.0 / 3.0 * bound.shear());
        let given = self.pores.pressure.get(particle).copied();
        let start = particles.excess[particle]
            + given.map_or(0.0, |given| particles.pore_pressure[particle] - given);
        let first = supports.len();
        self.pressures(particle, supports)?;
        let volume = particles.volume(particle);
        let follows = soil.follows;
        let share = follows.map_or(1.0, |law| law.share(particles.volume_ratio(particle)))
            * particles.ln_permeability_ratio[particle].exp();
        let [of_flow, of_rate] = self.flow.weights();
        let flows = of_flow * self.flow.duration * volume * share;
        let stores = volume / soil.stiffness.of(particles, particle, laws)?;
        let projects = volume * 0.5 / (ratio * bound.shear());
        let expected = self.flow.duration * particles.water_rate[particle];
        Ok(Gathered {
            seeping: Seeping {
                particle: number,
                first: first as u32,
                len: (supports.len() - first) as u32,
                volume,
                start,
                stores,
                projects,
                flows: soil.mobility.map(|row| row.map(|k| flows * k)),
                held: stores * start + of_rate * volume * expected,
                held_within: projects * particles.excess_within_cell[particle],
            },
            modulus,
            expected,
        })
    }

    /// Lists the pressures of a particle. The share of a dropped node falls to the one with the largest value: no water is
    /// lost with it.
    fn pressures(
        &self,
        particle: usize,
        listed: &mut Vec<PressureSupport<D>>,
    ) -> Result<(), AssemblyError> {
        let means = self.cell_means(particle)?;
        let first = listed.len();
        let mut dropped: Option<PressureSupport<D>> = None;
        let (mut largest, mut most) = (first, f64::NEG_INFINITY);
        for &Support {
            node, value, grad, ..
        } in self.stencils.of(particle)
        {
            let mean = mean_of(&means, node);
            let at_node = PressureSupport {
                place: self.numbers[node],
                node: node as u32,
                mean,
                bulge: value - mean,
                grad,
            };
            if at_node.place == NONE {
                let sum = dropped.get_or_insert(PressureSupport::nothing());
                sum.take(&at_node);
                continue;
            }
            if value >= most {
                (largest, most) = (listed.len(), value);
            }
            listed.push(at_node);
        }
        if let (Some(dropped), Some(largest)) = (dropped, listed.get_mut(largest)) {
            largest.take(&dropped);
        }
        Ok(())
    }

    /// An opening by the pressures that it sees.
    fn leak(&self, opening: &Opening) -> Leak {
        let carried = opening.values.iter().flat_map(|&(node, value)| {
            let carriers = self.stencils.carriers(node);
            carriers.map(move |carrier| (self.numbers[carrier.node], carrier.weight * value))
        });
        Leak {
            values: carried.filter(|&(place, _)| place != NONE).collect(),
            conductance: OPEN * self.flow.weights()[0] * opening.conductance,
        }
    }

    /// The mean of every node's value over the cells of a particle, S̄, carried by the nodes that nodes are tied to \[-\].
    fn cell_means(&self, particle: usize) -> Result<Vec<(usize, f64)>, AssemblyError> {
        let (grid, particles) = (&self.conditions.grid, self.particles);
        let x = particles.x[particle];
        let half_length = capped_half_length(grid, &x, particles.half_length[particle]);
        let mut parts = Vec::new();
        cell_parts(grid, &*self.method.basis, &x, &half_length, &mut parts)
            .map_err(|source| off_grid(particle, &x, source))?;
        let section = self.method.section;
        if section.is_axisymmetric() {
            weigh_by_radius(grid, &mut parts);
        }
        let mut means: Vec<(usize, f64)> = Vec::new();
        for part in &parts {
            for (node, value, _) in
                grid.tents(part.cell, centroid_of_cell(grid, part.cell, section))
            {
                for carrier in self.stencils.carriers(node) {
                    let share = part.share * value * carrier.weight;
                    match means.iter_mut().find(|(other, _)| *other == carrier.node) {
                        Some((_, sum)) => *sum += share,
                        None => means.push((carrier.node, share)),
                    }
                }
            }
        }
        Ok(means)
    }
}

impl<const D: usize> PressureSupport<D> {
    /// No share of any pressure.
    pub(crate) fn nothing() -> Self {
        Self {
            place: NONE,
            node: NONE,
            mean: 0.0,
            bulge: 0.0,
            grad: [0.0; D],
        }
    }

    /// Takes the share of another pressure over.
    fn take(&mut self, other: &Self) {
        self.mean += other.mean;
        self.bulge += other.bulge;
        for (sum, other) in self.grad.iter_mut().zip(other.grad) {
            *sum += other;
        }
    }
}

fn mean_of(means: &[(usize, f64)], node: usize) -> f64 {
    let entry = means.iter().find(|(other, _)| *other == node);
    entry.map_or(0.0, |(_, mean)| *mean)
}

/// The shortest side of a cell \[length\].
pub(crate) fn least_side<const D: usize>(grid: &Grid<D>) -> f64 {
    let steps = |axis: &igimp_shape::Axis| {
        let steps = axis.nodes().windows(2).map(|ends| ends[1] - ends[0]);
        steps.fold(f64::INFINITY, f64::min)
    };
    grid.axes.iter().map(steps).fold(f64::INFINITY, f64::min)
}
