//! The equilibrium of one step: its unknowns, its loads, and the way to its residual and its tangent.

mod answers;
mod evaluation;
mod loads;
mod prescribed;
mod thrown;

pub use thrown::Reach;

use std::borrow::Cow;
use std::sync::Arc;

use igimp_linear::Pattern;
use igimp_material::TangentKind;

use crate::body::particles::Particles;
use crate::conditions::StepConditions;
use crate::conditions::loads::{LoadPoint, finite_points};
use crate::contributions::beside::BesideParticles;
use crate::contributions::consolidation::pressure_nodes;
use crate::contributions::inertia::Inertia;
use crate::contributions::loads::add_force_of_points;
use crate::contributions::nonlocal::{NonlocalStrain, strain_nodes};
use crate::contributions::reinforcement::Reinforcement;
use crate::contributions::rigid::TurningWeights;
use crate::equations::blocks::BlockTable;
use crate::equations::damping::StiffnessDamping;
use crate::equations::residual::force_of_round_off;
use crate::equations::system::loads::Loads;
use crate::error::AssemblyError;
use crate::method::Method;
use crate::step::stencils::Stencils;
use crate::step::unknowns::Unknowns;
use igimp_rigid::{NODES_PER_BODY, RigidBody};

/// Structures in the soil and on it as a step begins; by default none.
#[derive(Clone, Copy, Debug)]
pub struct Structures<'a, const D: usize> {
    /// Rigid bodies that touch it.
    pub bodies: &'a [RigidBody<D>],
    /// Reinforcement that goes through it.
    pub members: &'a [Reinforcement<D>],
    /// Points that carry loads.
    pub points: &'a [LoadPoint<D>],
}

impl<const D: usize> Default for Structures<'_, D> {
    fn default() -> Self {
        Self {
            bodies: &[],
            members: &[],
            points: &[],
        }
    }
}

/// One step's system of equations. Borrows the state at the step's start and never changes it.
#[derive(Debug)]
pub struct System<'a, const D: usize> {
    pub(crate) particles: &'a Particles<D>,
    pub(crate) stencils: &'a Stencils<D>,
    pub(crate) conditions: Cow<'a, StepConditions<D>>,
    pub(crate) method: &'a Method,
    pub(crate) unknowns: Unknowns<D>,
    pub(crate) loads: Loads<D>,
    pub(crate) beside: BesideParticles<'a, D>,
    /// Nonlocal strain as an unknown, in a step whose soil softens over a length.
    pub(crate) nonlocal: NonlocalStrain<D>,
    /// Inertia of a step that takes time.
    pub(crate) inertia: Option<Inertia<D>>,
    /// Damping by the elastic stiffness, in a step that takes time.
    pub(crate) damping: Option<StiffnessDamping>,
    pub(crate) table: BlockTable<D>,
    pub(crate) pattern: Arc<Pattern>,
    /// Whether the tangents of all particles are symmetric.
    pub(crate) symmetric_particles: bool,
    symmetric: bool,
    /// ‖f_int‖ of strains that are round-off \[force\].
    round_off: f64,
}

impl<'a, const D: usize> System<'a, D> {
    /// Sets up the unknowns, the external force and the sparsity pattern of a step of soil alone.
    ///
    /// # Errors
    /// [`AssemblyError::NoUnknowns`], [`AssemblyError::OtherGrid`] for constraints that were made for
    /// another grid, [`AssemblyError::UnknownLaw`] of a particle whose law is not there, or
    /// [`AssemblyError::NonFinite`] for loads and a ghost penalty that are not finite.
    pub fn new(
        particles: &'a Particles<D>,
        stencils: &'a Stencils<D>,
        conditions: &'a StepConditions<D>,
        method: &'a Method,
    ) -> Result<Self, AssemblyError> {
        let alone = Structures::default();
        Self::with_structures(particles, &alone, stencils, conditions, method)
    }

    /// The same for soil in which, and on which, structures stand.
    ///
    /// # Errors
    /// As [`Self::new`], [`AssemblyError::UnsupportedReinforcement`] for reinforcement without soil,
    /// [`AssemblyError::LoadPoint`] or [`AssemblyError::UnsupportedLoad`] for a loaded point off the body.
    pub fn with_structures(
        particles: &'a Particles<D>,
        structures: &Structures<'a, D>,
        stencils: &'a Stencils<D>,
        conditions: &'a StepConditions<D>,
        method: &'a Method,
    ) -> Result<Self, AssemblyError> {
        conditions.validate(particles)?;
        let (grid, cuts) = (&conditions.grid, method.small_cuts);
        if !cuts.ghost_penalty.is_finite() {
            let (quantity, index) = ("ghost penalty", 0);
            return Err(AssemblyError::NonFinite { quantity, index });
        }
        let bodies = structures.bodies;
        let mut loads = Loads::find(particles, bodies, stencils, conditions, (method, None))?;
        let mut has_scalar = strain_nodes(particles, stencils, conditions)?;
        if has_scalar.is_empty() {
            has_scalar = pressure_nodes(particles, stencils, conditions);
        }
        let (constraints, free) = (&conditions.constraints, loads.is_free());
        let unknowns = Unknowns::number(grid, stencils, constraints, &cuts, &free, &has_scalar)?;
        let nodes = loads.f_ext.len() + unknowns.scalar_count();
        loads.f_ext.resize(nodes, [0.0; D]);
        let beside = BesideParticles::find(
            particles,
            (bodies, structures.members),
            stencils,
            (conditions, method),
            &unknowns,
            &loads.pores,
        )?;
        let (table, pattern) = BlockTable::build(grid, stencils, &unknowns, &beside.pairs());
        finite_points(structures.points)?;
        let f_ext = &mut loads.f_ext;
        add_force_of_points(f_ext, structures.points, conditions, stencils, &unknowns)?;
        let symmetric_particles = are_symmetric(particles, conditions);
        Ok(Self {
            particles,
            stencils,
            conditions: Cow::Borrowed(conditions),
            method,
            loads,
            nonlocal: NonlocalStrain::find(conditions, &unknowns),
            inertia: None,
            damping: None,
            unknowns,
            table,
            pattern: Arc::new(pattern),
            symmetric_particles,
            symmetric: symmetric_particles && beside.are_symmetric(),
            beside,
            round_off: force_of_round_off(particles, stencils, conditions),
        })
    }

    /// The same in motion, where the step takes time: with the inertia of particles and rigid bodies, and the forces that the
    /// step begins with. Loads act by now.
    ///
    /// # Errors
    /// [`AssemblyError::MotionNotFound`]; as [`Self::evaluate_into`].
    pub fn in_motion(mut self) -> Result<Self, AssemblyError> {
        let Some(time) = self.conditions.time else {
            return Ok(self);
        };
        let mass_of =
            |particle: usize| self.particles.mass[particle] + self.loads.pores.mass(particle);
        let mut inertia = Inertia::of(
            (time, self.conditions.ground),
            self.particles,
            (self.beside.contact.bodies(), self.method.geometry),
            self.stencils,
            &self.unknowns,
            &mass_of,
        )?;
        self.act_by_ground(&mut inertia);
        let damping = self.stiffness_damping()?;
        if time.asks_for_force_at_start() {
            let still = vec![[0.0; D]; self.node_count()];
            let mut force = self.evaluate(&still, TangentKind::Elastic)?.f_int;
            for (force, f_ext) in force.iter_mut().zip(&self.loads.f_ext) {
                *force = std::array::from_fn(|axis| force[axis] - f_ext[axis]);
            }
            let of_start = self.forces_of_start(&inertia, damping.as_ref());
            for (force, of_start) in force.iter_mut().zip(&of_start) {
                *force = std::array::from_fn(|axis| force[axis] + of_start[axis]);
            }
            inertia.begin(force, &self.unknowns)?;
        }
        self.beside.walls.set_in_motion(&inertia);
        self.damping = damping;
        self.round_off += inertia.round_off();
        self.inertia = Some(inertia);
        Ok(self)
    }

    /// Exchanges the loads of the body and its laws for those of other `conditions`, with the forces of the loaded
    /// `points`: grid, supports, prescribed motion and contact stay as the step began with them.
    ///
    /// # Errors
    /// As [`Self::with_structures`].
    pub fn exchange(
        &mut self,
        conditions: StepConditions<D>,
        points: &[LoadPoint<D>],
    ) -> Result<(), AssemblyError> {
        conditions.validate(self.particles)?;
        self.symmetric_particles = are_symmetric(self.particles, &conditions);
        self.symmetric = self.symmetric_particles && self.beside.are_symmetric();
        self.beside.reinforcement.control(&conditions.reinforcement);
        let (particles, stencils) = (self.particles, self.stencils);
        let bodies = self.beside.contact.bodies();
        self.beside.weights = TurningWeights::find(bodies, &conditions, self.method);
        let of_step = (self.method, Some(&self.loads));
        let mut loads = Loads::find(particles, bodies, stencils, &conditions, of_step)?;
        loads.f_ext.resize(self.loads.f_ext.len(), [0.0; D]);
        let f_ext = &mut loads.f_ext;
        add_force_of_points(f_ext, points, &conditions, stencils, &self.unknowns)?;
        self.loads = loads;
        self.conditions = Cow::Owned(conditions);
        Ok(())
    }

    /// The same with an earlier pattern in place of its own, if they are equal: solvers keep their
    /// symbolic work while they see the same one.
    #[must_use]
    pub fn sharing(mut self, earlier: Option<&Arc<Pattern>>) -> Self {
        if let Some(earlier) = earlier.filter(|earlier| ***earlier == *self.pattern) {
            self.pattern = Arc::clone(earlier);
        }
        self
    }

    /// Conditions of the step.
    pub fn conditions(&self) -> &StepConditions<D> {
        &self.conditions
    }

    /// The unknowns.
    pub fn unknowns(&self) -> &Unknowns<D> {
        &self.unknowns
    }

    /// The sparsity pattern of the tangent matrix.
    pub fn pattern(&self) -> &Arc<Pattern> {
        &self.pattern
    }

    /// External force by node \[force\].
    pub fn f_ext(&self) -> &[[f64; D]] {
        &self.loads.f_ext
    }

    /// External force by unknown \[force\].
    pub fn external_force_by_unknown(&self) -> Vec<f64> {
        self.by_unknown(&self.loads.f_ext)
    }

    /// Values by node as values by unknown.
    pub fn by_unknown(&self, values: &[[f64; D]]) -> Vec<f64> {
        let mut out = vec![0.0; self.unknowns.len()];
        for (node, values) in values.iter().enumerate() {
            for (axis, value) in values.iter().enumerate() {
                if let Some(unknown) = self.unknowns.index(node, axis) {
                    out[unknown] = *value;
                }
            }
        }
        out
    }

    /// Adds a correction `du` by unknown to nodal displacements `u` \[length\]; tied nodes follow those
    /// that they move with.
    pub fn add_correction(&self, u: &mut [[f64; D]], du: &[f64]) {
        for (node, displacement) in u.iter_mut().enumerate() {
            for axis in 0..D {
                if let Some(unknown) = self.unknowns.index(node, axis) {
                    displacement[axis] += du[unknown];
                }
            }
        }
        for (&node, carriers) in self.stencils.ties() {
            u[node] = std::array::from_fn(|axis| {
                let moved = carriers.iter().map(|by| by.weight * u[by.node][axis]);
                moved.reduce(|sum, part| sum + part).unwrap_or(0.0)
            });
        }
    }

    /// Nodal step displacements of a motion that goes on as it is at the start, where they are unknown; none in statics \[length\].
    pub fn predicted_motion(&self) -> Option<Vec<[f64; D]>> {
        let predicted = self.inertia.as_ref()?.predicted();
        let mut u = vec![[0.0; D]; self.node_count()];
        self.add_correction(&mut u, &self.by_unknown(&predicted));
        Some(u)
    }

    /// Number of nodes: those of the grid, two behind them for the motion of each rigid body, and one for each scalar
    /// that is unknown: pore pressure or nonlocal strain.
    pub fn node_count(&self) -> usize {
        self.unknowns.first_scalar() + self.unknowns.scalar_count()
    }

    /// Where a node stands \[length\]; one that stands for a rigid body at its reference point, one for a scalar where its
    /// node of the grid is.
    pub fn node_position(&self, node: usize) -> [f64; D] {
        let node = self.unknowns.block_node(node);
        let of_grid = self.conditions.grid.node_count();
        match node.checked_sub(of_grid) {
            Some(beyond) => {
                self.beside
                    .contact
                    .body(beyond / NODES_PER_BODY)
                    .pose
                    .origin
            }
            None => self.conditions.grid.node_position(node),
        }
    }

    /// The rigid body that a node stands for, with the component of its motion along an axis: displacements
    /// along the axes, then rotations; and whether any soil can touch it in this step.
    pub fn rigid_body_of(&self, node: usize, axis: usize) -> Option<(&RigidBody<D>, usize, bool)> {
        let beyond = node.checked_sub(self.conditions.grid.node_count())?;
        if beyond >= self.loads.motions.len() {
            return None;
        }
        let index = beyond / NODES_PER_BODY;
        let component = axis + D * (beyond % NODES_PER_BODY);
        let touches = self.beside.contact.may_touch(index);
        Some((self.beside.contact.body(index), component, touches))
    }

    /// Whether soil resists alone and its flow is not associated: its tangents are not symmetric, and no rigid body
    /// takes hold of it or lets go.
    pub fn flows_without_potential(&self) -> bool {
        !self.symmetric_particles && self.loads.motions.is_empty()
    }

    /// Whether soil moves whose flow is not associated.
    pub fn moves_without_potential(&self) -> bool {
        !self.symmetric_particles && self.inertia.is_some()
    }

    /// Whether strength softens with the plastic strain of the ground around, which is among the unknowns.
    pub fn softens_over_a_length(&self) -> bool {
        self.nonlocal.is_solved_for()
    }

    /// Whether soil may touch a rigid body in this step.
    pub fn touches_bodies(&self) -> bool {
        (0..self.beside.contact.bodies().len()).any(|body| self.beside.contact.may_touch(body))
    }
}

/// Whether the tangents of all particles are symmetric.
fn are_symmetric<const D: usize>(particles: &Particles<D>, conditions: &StepConditions<D>) -> bool {
    let mut used = vec![false; conditions.laws.len()];
    for &law in &particles.law {
        used[law] = true;
    }
    std::iter::zip(&conditions.laws, &used).all(|(law, &used)| !used || law.has_symmetric_tangent())
}
