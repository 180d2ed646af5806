//! Consolidation: water that flows out of soil while a step takes time, with excess pore pressure among the unknowns (theory,
//! eqs. 97 to 104).
//!
//! Soil sees the mean of the pressure over cells, as its dilatation is that of cells (B-bar). What a cell mean does not see is
//! held by the projection of Dohrmann and Bochev (2004), in the form of White and Borja (2008): with 1/(2G) there is nothing
//! to choose.

mod faces;

use igimp_shape::{Grid, Support, cell_parts};
use rayon::prelude::*;

use crate::body::particles::Particles;
use crate::conditions::StepConditions;
use crate::conditions::pore_flow::Consolidating;
use crate::contributions::nodal_forces::{AddBlock, NodalForces};
use crate::contributions::pore_water::Pores;
use crate::contributions::rigid::RigidBody;
use crate::error::AssemblyError;
use crate::method::{Kinematics, Method};
use crate::small::{determinant, identity, inverse, transpose_apply};
use crate::step::domain::{capped_half_length, off_grid};
use crate::step::stencils::Stencils;
use crate::step::unknowns::Unknowns;
use faces::{Opening, openings};

/// By how much water leaves more easily where a face or a drain is open than it comes there across a cell \[-\].
const OPEN: f64 = 1e3;

/// The share of effective stress below which excess pore pressure needs no digits \[-\].
const STRESS_SHARE: f64 = 0.05;

/// Particles, neighbours as a rule, whose couplings are summed by one thread: the order of the sums does not depend on threads.
const TOGETHER: usize = 256;

/// Marks a node of the grid without a pressure, and a particle that water does not flow through.
const NONE: u32 = u32::MAX;

/// What a pressure is to a particle.
#[derive(Clone, Copy, Debug)]
struct PressureSupport {
    /// Number of the pressure.
    place: u32,
    /// Its value at the particle, S \[-\].
    value: f64,
    /// Its mean over the cells of the particle, S̄ \[-\].
    mean: f64,
}

/// A particle that water flows through.
#[derive(Clone, Copy, Debug)]
struct Seeping {
    particle: u32,
    /// First of its supports, and how many there are.
    first: u32,
    len: u32,
    /// Volume at the start of the step \[length^D\].
    volume: f64,
    /// Excess pore pressure at the start \[force/length²\].
    start: f64,
    /// Softness of the water, n/K_w \[length²/force\].
    softness: f64,
}

/// What a pressure couples to another one, as the water that a unit of the other moves \[length^D·length²/force\].
#[derive(Clone, Copy, Debug)]
struct Move {
    column: u32,
    /// All of it.
    all: f64,
    /// What flows, and leaves at openings.
    flow: f64,
}

/// What some particles add to the forces of pressures and to their derivative.
struct Pushes<const D: usize> {
    /// By how much each particle grows \[length^D\].
    grows: Vec<f64>,
    /// The first pair of a pressure and a node that they touch, and by pair the force at the node that a unit of the pressure is.
    first: usize,
    coupling: Vec<[f64; D]>,
}

/// The soil of a pressure: sums over particles.
#[derive(Clone, Copy, Debug, Default)]
struct Share {
    /// Its volume \[length^D\].
    volume: f64,
    /// Volume by oedometric modulus \[length^D·force/length²\].
    stiffness: f64,
    /// Growth of its water if that went on as in the step before \[length^D\].
    expected: f64,
}

/// The water that a step moved.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WaterMoved {
    /// What left at open faces and drains \[length^D\].
    pub outflow: f64,
    /// Growth of the volume of soil that water flows through \[length^D\].
    pub swelling: f64,
    /// What compression of the water made room for \[length^D\].
    pub stored: f64,
}

impl WaterMoved {
    /// What does not close \[length^D\].
    pub fn missing(&self) -> f64 {
        self.outflow + self.swelling + self.stored
    }
}

/// What an accepted step leaves in the pores.
#[derive(Clone, Debug, Default)]
pub struct PoresAfter {
    /// Given pore pressure by particle, empty where there is none \[force/length²\].
    pub(crate) given: Vec<f64>,
    /// Of the particles that water flows through.
    pub(crate) excess: Vec<ExcessAfter>,
    /// The water that the step moved; none where no water flows.
    pub water_moved: Option<WaterMoved>,
}

/// Excess pore pressure of a particle after a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ExcessAfter {
    pub(crate) particle: usize,
    /// Its excess pore pressure, compression positive \[force/length²\].
    pub(crate) excess: f64,
    /// By how much the pressure at the particle differs from that mean of its cells \[force/length²\].
    pub(crate) within_cell: f64,
    /// Rate at which its water by volume grew \[1/time\].
    pub(crate) rate: f64,
}

impl Share {
    /// A sum over particles by volume; zero where extrapolation left no soil.
    fn by_volume(&self, sum: f64) -> f64 {
        if self.volume > 0.0 {
            sum / self.volume
        } else {
            0.0
        }
    }
}

/// Excess pore pressure as an unknown; empty where no water flows.
#[derive(Debug, Default)]
pub(crate) struct Consolidation<const D: usize> {
    /// The node that stands for the first pressure.
    first: usize,
    /// Pressure over the unknown, which is a length \[force/length³\].
    scale: f64,
    seeping: Vec<Seeping>,
    supports: Vec<PressureSupport>,
    /// By particle: its place in `seeping`.
    place_of: Vec<u32>,
    /// Supports of displacement of each seeping particle: node, ∇S̄.
    couples: Vec<Vec<(usize, [f64; D])>>,
    /// Pairs of a pressure and a node that it acts on.
    acts: Vec<(u32, u32)>,
    /// By seeping particle: the pairs of its supports, those of displacement first.
    pairs_of: Vec<Vec<u32>>,
    /// By pressure: what does not change during the step.
    moves: Vec<Vec<Move>>,
    /// By pressure: its soil.
    shares: Vec<Share>,
    /// What the rate of the step before weighs in this one \[-\].
    of_rate: f64,
    /// By pressure: the same of the pressures at the start \[length^D\].
    at_start: Vec<f64>,
    /// By pressure: water that leaves at openings \[length^D·length²/force\].
    leaves: Vec<f64>,
    /// Pairs of nodes of the grid that openings couple.
    pairs: Vec<(usize, usize)>,
    duration: f64,
    finite: bool,
}

/// The nodes of the grid that seeping particles touch; none where no water flows.
pub(crate) fn pressure_nodes<const D: usize>(
    particles: &Particles<D>,
    stencils: &Stencils<D>,
    conditions: &StepConditions<D>,
) -> Vec<bool> {
    let Some(flow) = &conditions.flow else {
        return Vec::new();
    };
    let mut has_pressure = vec![false; conditions.grid.node_count()];
    for particle in 0..particles.len() {
        if flow.permeable(particles.law[particle]).is_some() {
            for support in stencils.of(particle) {
                has_pressure[support.node] = true;
            }
        }
    }
    has_pressure
}

/// Gathers what does not change during a step.
struct Gathering<'a, const D: usize> {
    flow: &'a Consolidating<D>,
    /// By node of the grid: the number of its pressure.
    numbers: Vec<u32>,
    moves: Vec<Vec<Move>>,
    shares: Vec<Share>,
    acts: Vec<(u32, u32)>,
    /// By pressure: the nodes that it acts on, and their pairs.
    acts_on: Vec<Vec<(u32, u32)>>,
    at_start: Vec<f64>,
    leaves: Vec<f64>,
    pairs: Vec<(usize, usize)>,
}

impl<'a, const D: usize> Gathering<'a, D> {
    fn new(flow: &'a Consolidating<D>, grid: &Grid<D>, unknowns: &Unknowns<D>) -> Self {
        let mut numbers = vec![NONE; grid.node_count()];
        for (number, node) in unknowns.pressure_nodes().enumerate() {
            numbers[node] = number as u32;
        }
        let count = unknowns.pressure_count();
        Self {
            flow,
            numbers,
            moves: vec![Vec::new(); count],
            at_start: vec![0.0; count],
            leaves: vec![0.0; count],
            shares: vec![Share::default(); count],
            acts: Vec::new(),
            acts_on: vec![Vec::new(); count],
            pairs: Vec::new(),
        }
    }

    /// Adds the water that a unit of the pressure `column` moves at another: what flows, and what is stored.
    fn add(&mut self, row: u32, column: u32, flow: f64, stored: f64) {
        let row = &mut self.moves[row as usize];
        let all = flow + stored;
        match row.iter_mut().find(|own| own.column == column) {
            Some(own) => {
                own.all += all;
                own.flow += flow;
            }
            None => row.push(Move { column, all, flow }),
        }
    }

    /// The pair of a pressure and a node that it acts on.
    fn pair(&mut self, place: u32, node: u32) -> u32 {
        let known = &mut self.acts_on[place as usize];
        if let Some(&(_, pair)) = known.iter().find(|(other, _)| *other == node) {
            return pair;
        }
        let pair = self.acts.len() as u32;
        known.push((node, pair));
        self.acts.push((place, node));
        pair
    }

    /// The pressures of a particle: number, value, mean over cells and gradient. What falls to a node that was dropped falls to the
    /// one with the largest value: no water is lost with it.
    fn of_particle(
        &self,
        supports: &[Support<D>],
        means: &[(usize, f64)],
    ) -> Vec<(u32, f64, f64, [f64; D])> {
        let all = supports.iter().map(|support| {
            let mean = mean_of(means, support.node);
            let number = self.numbers[support.node];
            (number, support.value, mean, support.grad)
        });
        let (dropped, mut own): (Vec<_>, Vec<_>) = all.partition(|&(number, ..)| number == NONE);
        let largest = own.iter_mut().max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((_, value, mean, grad)) = largest {
            for other in dropped {
                *value += other.1;
                *mean += other.2;
                for (own, other) in grad.iter_mut().zip(other.3) {
                    *own += other;
                }
            }
        }
        own
    }

    /// Lets water leave where a function of pressure, given by nodes of the grid, would be zero.
    fn open(&mut self, values: &[(usize, f64)], conductance: f64) {
        let numbered: Vec<(usize, u32, f64)> = (values.iter())
            .map(|&(node, value)| (node, self.numbers[node], value))
            .filter(|&(_, number, _)| number != NONE)
            .collect();
        for &(row_node, row, row_value) in &numbered {
            for &(column_node, column, value) in &numbered {
                self.add(row, column, conductance * row_value * value, 0.0);
                self.leaves[column as usize] += conductance * row_value * value;
                self.pairs.push((column_node, row_node));
            }
        }
    }
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
        let Some(flow) = conditions
            .flow
            .as_ref()
            .filter(|_| unknowns.pressure_count() > 0)
        else {
            return Ok(Self::default());
        };
        let grid = &conditions.grid;
        let mut gathering = Gathering::new(flow, grid, unknowns);
        let mut own = Self {
            first: unknowns.first_pressure(),
            place_of: vec![NONE; particles.len()],
            duration: flow.duration,
            finite: method.kinematics_of_step() == Kinematics::FiniteStrain,
            ..Self::default()
        };
        let side = least_side(grid);
        for &particle in stencils.order() {
            let particle = particle as usize;
            let law = particles.law[particle];
            if flow.permeable(law).is_none() {
                continue;
            }
            let bound = conditions.laws[law].stiffness_bound();
            let ratio = particles.ratios[particle].stiffness;
            let modulus = ratio * (bound.bulk() + 4.0 / 3.0 * bound.shear());
            own.scale = own.scale.max(modulus / side);
            own.place_of[particle] = own.seeping.len() as u32;
            let softness = 0.5 / (ratio * bound.shear());
            let given = pores.pressure.get(particle).copied();
            let start = particles.excess[particle]
                + given.map_or(0.0, |given| particles.pore_pressure[particle] - given);
            own.seep(
                &mut gathering,
                (particles, particle, stencils),
                (grid, method),
                [softness, start, modulus],
            )?;
        }
        let near_body =
            |x: &[f64; D], reach: f64| bodies.iter().any(|body| body.distance(x) < reach);
        for opening in openings(particles, (conditions, method), flow, &near_body)? {
            let Opening {
                values,
                conductance,
            } = opening;
            let carried: Vec<(usize, f64)> = (values.iter())
                .flat_map(|&(node, value)| {
                    let carriers = stencils.carriers(node);
                    carriers.map(move |own| (own.node, own.weight * value))
                })
                .collect();
            gathering.open(&carried, OPEN * flow.weights()[0] * conductance);
        }
        own.moves = gathering.moves;
        own.at_start = gathering.at_start;
        own.leaves = gathering.leaves;
        own.shares = gathering.shares;
        own.of_rate = flow.weights()[1];
        own.pairs = gathering.pairs;
        own.acts = gathering.acts;
        Ok(own)
    }

    /// Adds a particle that water flows through, with the softness 1/(2G) of its soil \[length²/force\] and the mean pressure
    /// that it begins with \[force/length²\].
    fn seep(
        &mut self,
        gathering: &mut Gathering<'_, D>,
        (particles, particle, stencils): (&Particles<D>, usize, &Stencils<D>),
        (grid, method): (&Grid<D>, &Method),
        [softness, start, modulus]: [f64; 3],
    ) -> Result<(), AssemblyError> {
        let flow = gathering.flow;
        let Some(soil) = flow.permeable(particles.law[particle]) else {
            return Ok(());
        };
        let supports = stencils.of(particle);
        let means = cell_means(particles, particle, stencils, grid, method)?;
        let first = self.supports.len();
        let volume = particles.volume(particle);
        let follows = soil.follows;
        let share = follows.map_or(1.0, |law| law.share(particles.volume_ratio(particle)));
        let [of_flow, of_rate] = flow.weights();
        let flows = of_flow * flow.duration * volume * share;
        let stores = volume / soil.stiffness;
        let expected = flow.duration * particles.water_rate[particle];
        let projects = volume * softness;
        let own = gathering.of_particle(supports, &means);
        let within = particles.excess_within_cell[particle];
        for &(row, value, mean, grad) in &own {
            let bulge = value - mean;
            let towards: [f64; D] =
                std::array::from_fn(|a| (0..D).map(|b| soil.mobility[a][b] * grad[b]).sum());
            for &(column, other_value, other_mean, other_grad) in &own {
                let along: f64 = (0..D).map(|a| towards[a] * other_grad[a]).sum();
                let stored =
                    stores * mean * other_mean + projects * bulge * (other_value - other_mean);
                gathering.add(column, row, flows * along, stored);
            }
            gathering.at_start[row as usize] +=
                mean * (stores * start + of_rate * volume * expected) + projects * bulge * within;
            let share = &mut gathering.shares[row as usize];
            share.volume += volume * mean;
            share.stiffness += volume * mean * modulus;
            share.expected += volume * mean * expected;
            self.supports.push(PressureSupport {
                place: row,
                value,
                mean,
            });
        }
        self.pairs_of.push(
            (supports.iter())
                .flat_map(|support| own.iter().map(|&(place, ..)| (place, support.node as u32)))
                .map(|(place, node)| gathering.pair(place, node))
                .collect(),
        );
        self.couples.push(
            (supports.iter())
                .map(|support| (support.node, support.grad_bar))
                .collect(),
        );
        self.seeping.push(Seeping {
            particle: particle as u32,
            first: first as u32,
            len: own.len() as u32,
            volume,
            start,
            softness: 1.0 / soil.stiffness,
        });
        Ok(())
    }

    fn supports_of(&self, seeping: &Seeping) -> &[PressureSupport] {
        &self.supports[seeping.first as usize..][..seeping.len as usize]
    }

    /// The mean excess pore pressure of a particle at nodal values `u`; none where water does not flow \[force/length²\].
    #[inline]
    pub(crate) fn pressure(&self, particle: usize, u: &[[f64; D]]) -> Option<f64> {
        let place = *self
            .place_of
            .get(particle)
            .filter(|place| **place != NONE)?;
        let own = self.supports_of(&self.seeping[place as usize]).iter();
        let sum: f64 = own.map(|own| own.mean * self.value(own.place, u)).sum();
        Some(self.scale * sum)
    }

    #[inline]
    fn value(&self, place: u32, u: &[[f64; D]]) -> f64 {
        u[self.first + place as usize][0]
    }

    /// The excess pore pressures of particles at nodal values `u`.
    pub(crate) fn excess_after(&self, u: &[[f64; D]]) -> Vec<ExcessAfter> {
        let grown: Vec<f64> = (0..self.shares.len())
            .map(|place| self.shares[place].by_volume(self.grown(place, u)))
            .collect();
        let after = |seeping: &Seeping| {
            let within_cell = (self.supports_of(seeping).iter())
                .map(|own| (own.value - own.mean) * self.scale * self.value(own.place, u))
                .sum();
            let supports = self.supports_of(seeping).iter();
            let grows: f64 = supports
                .map(|own| own.mean * grown[own.place as usize])
                .sum();
            ExcessAfter {
                particle: seeping.particle as usize,
                excess: self.pressure(seeping.particle as usize, u).unwrap_or(0.0),
                within_cell,
                rate: grows / self.duration,
            }
        };
        self.seeping.iter().map(after).collect()
    }

    /// The growth of the water of a pressure by what flows at nodal values `u` \[length^D\].
    fn grown(&self, place: usize, u: &[[f64; D]]) -> f64 {
        let flows = self.moves[place].iter();
        let flows: f64 = flows.map(|own| own.flow * self.value(own.column, u)).sum();
        self.of_rate * self.shares[place].expected - self.scale * flows
    }

    /// The error of the step in time at nodal values `u`, the mean square of that of excess pore pressures over the largest of them,
    /// or over a part of the largest effective stress `stress` \[-\]; none where no water flows (theory, eq. 104).
    pub(crate) fn time_error(&self, u: &[[f64; D]], stress: f64) -> Option<f64> {
        let (mut volume, mut squared, mut largest) = (0.0, 0.0, STRESS_SHARE * stress);
        for (place, own) in self.shares.iter().enumerate() {
            let change = own.by_volume(self.grown(place, u) - own.expected);
            volume += own.volume;
            squared += own.volume * (0.5 * own.by_volume(own.stiffness) * change).powi(2);
            largest = largest.max((self.scale * self.value(place as u32, u)).abs());
        }
        let starts = self.seeping.iter().map(|own| own.start.abs());
        largest = starts.fold(largest, f64::max);
        (volume > 0.0 && largest > 0.0).then(|| (squared / volume).sqrt() / largest)
    }

    /// The water that nodal values `u` move; none where no water flows.
    pub(crate) fn water_moved(&self, u: &[[f64; D]]) -> Option<WaterMoved> {
        if self.seeping.is_empty() {
            return None;
        }
        let pressures = &u[self.first..];
        let of = |water: &[f64]| -> f64 {
            let all = water.iter().zip(pressures);
            all.map(|(water, pressure)| self.scale * water * pressure[0])
                .sum()
        };
        let mut moved = WaterMoved {
            outflow: of(&self.leaves)
                - self.of_rate * self.shares.iter().map(|own| own.expected).sum::<f64>(),
            ..WaterMoved::default()
        };
        for (seeping, couples) in self.seeping.iter().zip(&self.couples) {
            let excess = self.pressure(seeping.particle as usize, u).unwrap_or(0.0);
            moved.swelling += self.stretched(seeping, couples, u).0;
            moved.stored += seeping.volume * seeping.softness * (excess - seeping.start);
        }
        Some(moved)
    }

    /// What a part of the particles adds at nodal values `u`; of the derivative if asked for.
    fn pushes(&self, part: usize, u: &[[f64; D]], with_coupling: bool) -> Pushes<D> {
        let first = part * TOGETHER;
        let particles = first..self.seeping.len().min(first + TOGETHER);
        let pairs = self.pairs_of[particles.clone()].iter().flatten();
        let ends = pairs.fold([u32::MAX, 0], |[least, most], &pair| {
            [least.min(pair), most.max(pair + 1)]
        });
        let touched = ends[1].saturating_sub(ends[0]) as usize;
        let mut pushes = Pushes {
            grows: Vec::with_capacity(particles.len()),
            first: ends[0] as usize,
            coupling: vec![[0.0; D]; if with_coupling { touched } else { 0 }],
        };
        for place in particles {
            let (seeping, couples) = (&self.seeping[place], &self.couples[place]);
            let (grows, volume, push) = self.stretched(seeping, couples, u);
            pushes.grows.push(grows);
            if !with_coupling {
                continue;
            }
            let supports = self.supports_of(seeping);
            let mut pairs = self.pairs_of[place].iter();
            for (_, slope) in couples {
                let slope = transpose_apply(&push, slope);
                for (own, &pair) in supports.iter().zip(&mut pairs) {
                    let share = -self.scale * volume * own.mean;
                    let sum = &mut pushes.coupling[(pair - ends[0]) as usize];
                    for a in 0..D {
                        sum[a] += share * slope[a];
                    }
                }
            }
        }
        pushes
    }

    /// By how much nodal displacements `u` change the volume of a particle, and its volume then, with the gradient that pushes
    /// forward.
    #[inline]
    fn stretched(
        &self,
        seeping: &Seeping,
        couples: &[(usize, [f64; D])],
        u: &[[f64; D]],
    ) -> (f64, f64, [[f64; D]; D]) {
        let mut gradient = [[0.0; D]; D];
        for (node, slope) in couples {
            for a in 0..D {
                for b in 0..D {
                    gradient[a][b] += u[*node][a] * slope[b];
                }
            }
        }
        let volume = seeping.volume;
        if !self.finite {
            let trace: f64 = (0..D).map(|a| gradient[a][a]).sum();
            return (volume * trace, volume, identity());
        }
        for (a, row) in gradient.iter_mut().enumerate() {
            row[a] += 1.0;
        }
        let det = determinant(&gradient);
        (volume * (det - 1.0), volume * det, inverse(&gradient, det))
    }
}

impl<const D: usize> NodalForces<D> for Consolidation<D> {
    fn pairs(&self) -> Vec<(usize, usize)> {
        self.pairs.clone()
    }

    fn is_symmetric(&self) -> bool {
        true
    }

    fn add(&self, u: &[[f64; D]], f: &mut [[f64; D]], mut blocks: Option<&mut AddBlock<'_, D>>) {
        let scale = self.scale;
        for (row, columns) in self.moves.iter().enumerate() {
            let mut water = -self.at_start[row];
            for &Move { column, all, .. } in columns {
                water += all * scale * self.value(column, u);
                if let Some(blocks) = &mut blocks {
                    let mut block = [[0.0; D]; D];
                    block[0][0] = -scale * scale * all;
                    blocks(self.first + row, self.first + column as usize, &block);
                }
            }
            f[self.first + row][0] -= scale * water;
        }
        let parts = self.seeping.len().div_ceil(TOGETHER);
        let with_coupling = blocks.is_some();
        let parts: Vec<Pushes<D>> = (0..parts)
            .into_par_iter()
            .map(|part| self.pushes(part, u, with_coupling))
            .collect();
        let mut coupling = vec![[0.0; D]; if blocks.is_some() { self.acts.len() } else { 0 }];
        for (seeping, part) in self.seeping.chunks(TOGETHER).zip(&parts) {
            for (seeping, grows) in seeping.iter().zip(&part.grows) {
                for own in self.supports_of(seeping) {
                    f[self.first + own.place as usize][0] -= scale * own.mean * grows;
                }
            }
            for (sum, own) in coupling.iter_mut().skip(part.first).zip(&part.coupling) {
                for (sum, own) in sum.iter_mut().zip(own) {
                    *sum += own;
                }
            }
        }
        let Some(blocks) = &mut blocks else {
            return;
        };
        for (&(place, node), sum) in self.acts.iter().zip(&coupling) {
            let (pressure, node) = (self.first + place as usize, node as usize);
            let (mut of_water, mut of_soil) = ([[0.0; D]; D], [[0.0; D]; D]);
            of_water[0] = *sum;
            for a in 0..D {
                of_soil[a][0] = sum[a];
            }
            blocks(pressure, node, &of_water);
            blocks(node, pressure, &of_soil);
        }
    }
}

/// The mean of every node's value over the cells of a particle, S̄, carried by the nodes that nodes are tied to \[-\].
fn cell_means<const D: usize>(
    particles: &Particles<D>,
    particle: usize,
    stencils: &Stencils<D>,
    grid: &Grid<D>,
    method: &Method,
) -> Result<Vec<(usize, f64)>, AssemblyError> {
    let x = particles.x[particle];
    let half_length = capped_half_length(grid, &x, particles.half_length[particle]);
    let mut parts = Vec::new();
    cell_parts(grid, &*method.basis, &x, &half_length, &mut parts)
        .map_err(|source| off_grid(particle, &x, source))?;
    let mut means: Vec<(usize, f64)> = Vec::new();
    for part in &parts {
        for (node, value, _) in grid.tents(part.cell, [0.5; D]) {
            for carrier in stencils.carriers(node) {
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

fn mean_of(means: &[(usize, f64)], node: usize) -> f64 {
    let own = means.iter().find(|(other, _)| *other == node);
    own.map_or(0.0, |(_, mean)| *mean)
}

/// The shortest side of a cell \[length\].
fn least_side<const D: usize>(grid: &Grid<D>) -> f64 {
    let steps = |axis: &igimp_shape::Axis| {
        let steps = axis.nodes().windows(2).map(|ends| ends[1] - ends[0]);
        steps.fold(f64::INFINITY, f64::min)
    };
    grid.axes.iter().map(steps).fold(f64::INFINITY, f64::min)
}
