//! All forces at nodes beside the stress of particles, in the order in which they are summed.

use crate::body::particles::Particles;
use crate::conditions::StepConditions;
use crate::contributions::consolidation::Consolidation;
use crate::contributions::couplings::Couplings;
use crate::contributions::ghost::ghost_penalty;
use crate::contributions::loads::nodal_drag;
use crate::contributions::nodal_forces::NodalForces;
use crate::contributions::pore_water::Pores;
use crate::contributions::reinforcement::{Members, Reinforcement};
use crate::contributions::rigid::{Contact, TurningWeights};
use crate::contributions::walls::WallForces;
use crate::error::AssemblyError;
use crate::method::Method;
use crate::step::stencils::Stencils;
use crate::step::unknowns::Unknowns;
use igimp_rigid::RigidBody;

/// The forces at nodes beside those of particles and of acceleration.
#[derive(Debug)]
pub(crate) struct BesideParticles<'a, const D: usize> {
    pub(crate) ghost: Couplings,
    pub(crate) drag: Couplings,
    pub(crate) contact: Contact<'a, D>,
    pub(crate) reinforcement: Members<'a, D>,
    /// Walls behind which the ground goes on.
    pub(crate) walls: WallForces<D>,
    /// Excess pore pressure as an unknown, in a step in which water flows.
    pub(crate) consolidation: Consolidation<D>,
    /// Forces at the centres of mass of rigid bodies that turn.
    pub(crate) weights: TurningWeights<D>,
}

impl<'a, const D: usize> BesideParticles<'a, D> {
    /// Contributions to the forces of a step.
    ///
    /// # Errors
    /// [`AssemblyError::UnsupportedReinforcement`] for reinforcement without soil, and those of water that flows.
    pub(crate) fn find(
        particles: &'a Particles<D>,
        (bodies, members): (&'a [RigidBody<D>], &'a [Reinforcement<D>]),
        stencils: &'a Stencils<D>,
        (conditions, method): (&'a StepConditions<D>, &'a Method),
        unknowns: &Unknowns<D>,
        pores: &Pores,
    ) -> Result<Self, AssemblyError> {
        let grid = &conditions.grid;
        let young = |particle: usize| particles.young(particle, &conditions.laws);
        let penalty = method.small_cuts.ghost_penalty;
        let mass_of = |particle: usize| particles.mass[particle] + pores.mass(particle);
        let of_step = (conditions, method);
        Ok(Self {
            ghost: ghost_penalty(grid, particles, stencils, young, penalty),
            drag: nodal_drag(grid, stencils, conditions.loads.drag),
            contact: Contact::find(bodies, particles, stencils, of_step, unknowns),
            reinforcement: Members::find(members, particles, stencils, of_step, unknowns)?,
            consolidation: Consolidation::find(
                particles, bodies, stencils, of_step, unknowns, pores,
            )?,
            walls: WallForces::find(particles, stencils, conditions, unknowns, &mass_of),
            weights: TurningWeights::find(bodies, conditions, method),
        })
    }

    /// The forces in the order in which they are summed.
    pub(crate) fn forces(&self) -> [&dyn NodalForces<D>; 7] {
        [
            &self.ghost,
            &self.drag,
            &self.contact,
            &self.reinforcement,
            &self.walls,
            &self.consolidation,
            &self.weights,
        ]
    }

    /// Pairs of nodes that they couple.
    pub(crate) fn pairs(&self) -> Vec<(usize, usize)> {
        self.forces()
            .iter()
            .flat_map(|force| force.pairs())
            .collect()
    }

    /// Whether all their tangents are symmetric.
    pub(crate) fn are_symmetric(&self) -> bool {
        self.forces().iter().all(|force| force.is_symmetric())
    }
}
