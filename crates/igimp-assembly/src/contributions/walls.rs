//! Forces of walls behind which the ground goes on (theory, eqs. 69 to 71 and 77a): dashpots and springs at their nodes against the
//! ground or a free field, and springs that make the nodes of two walls move together.
//!
//! The soil that touches a wall is that of its particles at the nodes: with a first layer of cells of width h across the
//! wall that is full, 2 Σ_p V_p S_ip / h is the area of a node on it.

use std::collections::BTreeMap;

use igimp_shape::Grid;

use crate::body::particles::Particles;
use crate::conditions::StepConditions;
use crate::conditions::time_step::TimeStep;
use crate::conditions::walls::{AbsorbingWall, FreeMotion, TiedWalls};
use crate::contributions::inertia::Inertia;
use crate::contributions::nodal_forces::{AddBlock, NodalForces};
use crate::step::stencils::Stencils;
use crate::step::unknowns::Unknowns;

/// Forces of walls at their nodes.
#[derive(Debug)]
pub(crate) struct WallForces<const D: usize> {
    nodes: Vec<NodeAtWall<D>>,
    ties: Vec<Tie<D>>,
    /// The motion of the step; dashpots rest before it is known.
    step: Option<TimeStep>,
}

/// Dashpots and springs of a node.
#[derive(Clone, Debug)]
struct NodeAtWall<const D: usize> {
    node: usize,
    /// \[force·time/length\].
    dashpot: [f64; D],
    /// \[force/length\].
    spring: [f64; D],
    /// Parts of dashpots \[force·time/length\] and springs \[force/length\] that move against the free field, and not against the ground:
    /// that of its own wall.
    followed: [[f64; D]; 2],
    /// At the start of the step \[length\].
    displacement: [f64; D],
    /// At the start of the step \[length/time\].
    velocity: [f64; D],
    /// At the start of the step \[length/time²\].
    acceleration: [f64; D],
    /// Motion of the free field beside it.
    beside: FreeMotion<D>,
}

/// The force with which two nodes are tied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TieForce<const D: usize> {
    /// The nodes of the grid, the lower one first.
    pub nodes: [usize; 2],
    /// Internal force at the first of them at the start and at the end of the step, the opposite of that at the second
    /// \[force\].
    pub force: [[f64; D]; 2],
}

impl<const D: usize> NodeAtWall<D> {
    /// Adds the dashpots and springs of a wall, with the area that a unit of volume there has on it \[1/length\].
    fn join(&mut self, wall: &AbsorbingWall<D>, per_volume: f64, share: &Shares) {
        for a in 0..D {
            let wave = usize::from(a != wall.normal);
            let dashpot = per_volume * share.impedance[wave];
            let spring = per_volume * share.modulus[wave] * wall.spring[a];
            self.dashpot[a] += dashpot;
            self.spring[a] += spring;
            if wall.normal == self.beside.normal {
                self.followed[0][a] += dashpot;
                self.followed[1][a] += spring;
            }
        }
    }
}

/// Two nodes that move together.
#[derive(Clone, Debug)]
struct Tie<const D: usize> {
    nodes: [usize; 2],
    /// \[force/length\].
    stiffness: f64,
    /// Displacement of the first beyond that of the second at the start of the step \[length\].
    gap: [f64; D],
}

/// Shares of soil at a node: impedance and modulus, each for compression and shear.
#[derive(Clone, Copy, Debug, Default)]
struct Shares {
    /// Σ m S c \[mass·length/time\].
    impedance: [f64; 2],
    /// Σ V S times modulus \[force·length\].
    modulus: [f64; 2],
}

impl<const D: usize> WallForces<D> {
    /// The forces of the walls of a step, without velocities yet.
    pub(crate) fn find(
        particles: &Particles<D>,
        stencils: &Stencils<D>,
        conditions: &StepConditions<D>,
        unknowns: &Unknowns<D>,
        mass_of: &(dyn Fn(usize) -> f64 + Sync),
    ) -> Self {
        let Some(walls) = &conditions.walls else {
            return Self {
                nodes: Vec::new(),
                ties: Vec::new(),
                step: None,
            };
        };
        let grid = &conditions.grid;
        let mut shares = shares(particles, stencils, conditions, mass_of);
        shares.retain(|&node, _| unknowns.is_active(node) && !stencils.is_tied(node));
        let displaced: BTreeMap<usize, [f64; D]> = (walls.nodes.iter())
            .map(|n| (n.node, n.displacement))
            .collect();
        let beside: BTreeMap<usize, FreeMotion<D>> =
            walls.beside.iter().map(|free| (free.node, *free)).collect();
        let displacement = |node: usize| displaced.get(&node).copied().unwrap_or([0.0; D]);
        let mut nodes: BTreeMap<usize, NodeAtWall<D>> = BTreeMap::new();
        for wall in &walls.absorbing {
            let axis = &grid.axes[wall.normal];
            let last = axis.cell_count() - 1;
            let cell = if wall.upper { last } else { 0 };
            for (&node, share) in shares.iter().filter(|(node, _)| wall.holds(grid, **node)) {
                let at_wall = nodes.entry(node).or_insert_with(|| NodeAtWall {
                    node,
                    dashpot: [0.0; D],
                    spring: [0.0; D],
                    followed: [[0.0; D]; 2],
                    displacement: displacement(node),
                    velocity: [0.0; D],
                    acceleration: [0.0; D],
                    beside: (beside.get(&node).copied()).unwrap_or(FreeMotion::still(node)),
                });
                at_wall.join(wall, 2.0 / axis.spacing(cell), share);
            }
        }
        Self {
            nodes: nodes.into_values().collect(),
            ties: (walls.tied)
                .map_or_else(Vec::new, |tied| ties(grid, tied, &shares, displacement)),
            step: None,
        }
    }

    /// Lets dashpots act in a step that begins with this motion.
    pub(crate) fn set_in_motion(&mut self, inertia: &Inertia<D>) {
        self.step = Some(*inertia.step());
        for wall in &mut self.nodes {
            wall.velocity = inertia.velocity()[wall.node];
            wall.acceleration = inertia.acceleration()[wall.node];
        }
    }

    /// The forces at the start of a step that begins with these velocities, without those of springs and ties as the end of the
    /// step has them before anything moves if `is_difference`, added to `f` \[force\].
    pub(crate) fn add_at_start(
        &self,
        velocity: &[[f64; D]],
        is_difference: bool,
        f: &mut [[f64; D]],
    ) {
        for wall in &self.nodes {
            let free = &wall.beside;
            for a in 0..D {
                f[wall.node][a] += wall.dashpot[a] * velocity[wall.node][a]
                    - wall.followed[0][a] * free.velocity[0][a];
            }
        }
        if is_difference {
            for wall in &self.nodes {
                let FreeMotion {
                    displacement: [d0, d1],
                    force: [f0, f1],
                    ..
                } = &wall.beside;
                for a in 0..D {
                    f[wall.node][a] += wall.followed[1][a] * (d1[a] - d0[a]) + (f1[a] - f0[a]);
                }
            }
            return;
        }
        for wall in &self.nodes {
            let free = &wall.beside;
            for a in 0..D {
                f[wall.node][a] += wall.spring[a] * wall.displacement[a]
                    - wall.followed[1][a] * free.displacement[0][a]
                    - free.force[0][a];
            }
        }
        for tie in &self.ties {
            for a in 0..D {
                let force = tie.stiffness * tie.gap[a];
                f[tie.nodes[0]][a] += force;
                f[tie.nodes[1]][a] -= force;
            }
        }
    }

    /// The forces of ties over a step by nodal displacements `u` \[length\].
    pub(crate) fn of_ties(&self, u: &[[f64; D]]) -> Vec<TieForce<D>> {
        let force = |tie: &Tie<D>| {
            let [first, second] = tie.nodes.map(|node| &u[node]);
            TieForce {
                nodes: tie.nodes,
                force: [
                    tie.gap.map(|gap| tie.stiffness * gap),
                    std::array::from_fn(|a| tie.stiffness * (tie.gap[a] + first[a] - second[a])),
                ],
            }
        };
        self.ties.iter().map(force).collect()
    }
}

impl<const D: usize> NodalForces<D> for WallForces<D> {
    fn pairs(&self) -> Vec<(usize, usize)> {
        let ties = self.ties.iter().map(|tie| tie.nodes);
        ties.flat_map(|[a, b]| [(a, b), (b, a)]).collect()
    }

    fn is_symmetric(&self) -> bool {
        true
    }

    fn add(&self, u: &[[f64; D]], f: &mut [[f64; D]], blocks: Option<&mut AddBlock<'_, D>>) {
        let still = [0.0; D];
        for wall in &self.nodes {
            let by = &u[wall.node];
            let velocity = self.step.map_or(still, |step| {
                step.after(&wall.velocity, &wall.acceleration, by).0
            });
            let free = &wall.beside;
            let of_free = if self.step.is_some() {
                free.velocity[1]
            } else {
                still
            };
            for a in 0..D {
                f[wall.node][a] += wall.dashpot[a] * velocity[a] - wall.followed[0][a] * of_free[a]
                    + wall.spring[a] * (wall.displacement[a] + by[a])
                    - wall.followed[1][a] * free.displacement[1][a]
                    - free.force[1][a];
            }
        }
        for tie in &self.ties {
            let [first, second] = tie.nodes;
            for a in 0..D {
                let force = tie.stiffness * (tie.gap[a] + u[first][a] - u[second][a]);
                f[first][a] += force;
                f[second][a] -= force;
            }
        }
        let Some(blocks) = blocks else {
            return;
        };
        let rate = self.step.map_or(0.0, |step| step.velocity_rate());
        for wall in &self.nodes {
            let mut block = [[0.0; D]; D];
            for (a, row) in block.iter_mut().enumerate() {
                row[a] = rate * wall.dashpot[a] + wall.spring[a];
            }
            blocks(wall.node, wall.node, &block);
        }
        for tie in &self.ties {
            let [first, second] = tie.nodes;
            for (row, column, sign) in [
                (first, first, 1.0),
                (second, second, 1.0),
                (first, second, -1.0),
                (second, first, -1.0),
            ] {
                let mut block = [[0.0; D]; D];
                for (a, entries) in block.iter_mut().enumerate() {
                    entries[a] = sign * tie.stiffness;
                }
                blocks(row, column, &block);
            }
        }
    }
}

/// The pairs of nodes at the two ends of an axis, both with soil.
fn ties<const D: usize>(
    grid: &Grid<D>,
    TiedWalls { axis, stiffness }: TiedWalls,
    shares: &BTreeMap<usize, Shares>,
    displacement: impl Fn(usize) -> [f64; D],
) -> Vec<Tie<D>> {
    let cell = grid.axes[axis].spacing(0);
    let first = shares
        .iter()
        .filter(|(node, _)| grid.node_place(**node)[axis] == 0);
    first
        .filter_map(|(&node, share)| {
            let mut place = grid.node_place(node);
            place[axis] = grid.axes[axis].node_count() - 1;
            let other = grid.node_index(place);
            let modulus = share.modulus[0].max(shares.get(&other)?.modulus[0]);
            let (a, b) = (displacement(node), displacement(other));
            Some(Tie {
                nodes: [node, other],
                stiffness: stiffness * modulus / (cell * cell),
                gap: std::array::from_fn(|k| a[k] - b[k]),
            })
        })
        .collect()
}

/// Shares of soil at the nodes of the walls of a grid.
fn shares<const D: usize>(
    particles: &Particles<D>,
    stencils: &Stencils<D>,
    conditions: &StepConditions<D>,
    mass_of: &(dyn Fn(usize) -> f64 + Sync),
) -> BTreeMap<usize, Shares> {
    let grid = &conditions.grid;
    let at_wall = |node: usize| {
        let place = grid.node_place(node);
        (0..D).any(|axis| place[axis] == 0 || place[axis] + 1 == grid.axes[axis].node_count())
    };
    let mut shares: BTreeMap<usize, Shares> = BTreeMap::new();
    for &particle in stencils.order() {
        let particle = particle as usize;
        let supports = stencils.of(particle);
        if !supports.iter().any(|support| at_wall(support.node)) {
            continue;
        }
        let bound = conditions.laws[particles.law[particle]].stiffness_bound();
        let stiffness = particles.ratios[particle].stiffness;
        let water = conditions.water.stiffness_of(particles, particle);
        let shear = bound.shear() * stiffness;
        let compression = bound.bulk() * stiffness + 4.0 / 3.0 * shear + water;
        let (mass, volume) = (mass_of(particle), particles.volume(particle));
        for support in supports.iter().filter(|support| at_wall(support.node)) {
            let share = shares.entry(support.node).or_default();
            for (k, modulus) in [compression, shear].into_iter().enumerate() {
                share.impedance[k] += support.value * (mass * volume * modulus).sqrt();
                share.modulus[k] += support.value * volume * modulus;
            }
        }
    }
    shares
}
