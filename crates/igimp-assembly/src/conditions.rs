//! Conditions of one step, besides the particles.

pub(crate) mod constraints;
pub(crate) mod ground_motion;
pub(crate) mod loads;
pub(crate) mod pore_flow;
pub(crate) mod reinforcement;
pub(crate) mod rigid_motion;
pub(crate) mod time_step;
pub(crate) mod unbalanced;
pub(crate) mod walls;
pub(crate) mod water;

use igimp_shape::Grid;

use crate::body::particles::Particles;
use crate::conditions::reinforcement::ReinforcementControl;
use crate::conditions::rigid_motion::RigidMotion;
use crate::conditions::water::Water;
use crate::error::AssemblyError;
use crate::laws::SharedLaw;
use constraints::Constraints;
use ground_motion::{GroundMotion, Rayleigh};
use loads::StepLoads;
use pore_flow::Consolidating;
use time_step::TimeStep;
use unbalanced::UnbalancedForces;
use walls::Walls;

/// Conditions of one step, besides the particles.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct StepConditions<const D: usize> {
    /// The background grid of this step.
    pub grid: Grid<D>,
    /// Prescribed step displacements.
    pub constraints: Constraints<D>,
    /// External force at the end of the step.
    pub loads: StepLoads<D>,
    /// Laws at the end of the step, as the particles number them.
    pub laws: Vec<SharedLaw>,
    /// How rigid bodies move, in their order; one that is not listed is held.
    pub motions: Vec<RigidMotion<D>>,
    /// Controls of reinforcement, in its order; members not listed stretch with the ground, with their
    /// whole bond.
    pub reinforcement: Vec<ReinforcementControl>,
    /// Water in the pores at the end of the step.
    pub water: Water<D>,
    /// How water flows out of soil, in a step that takes time.
    pub flow: Option<Consolidating<D>>,
    /// Forces that hold the body where a change has put it out of balance.
    pub held: Option<UnbalancedForces<D>>,
    /// The time that the step takes; none in statics.
    pub time: Option<TimeStep>,
    /// Walls behind which the ground goes on, in a step that takes time.
    pub walls: Option<Walls<D>>,
    /// Motion of the ground in whose frame motion is given, in a step that takes time.
    pub ground: Option<GroundMotion<D>>,
    /// Viscous damping of soil, in a step that takes time.
    pub damping: Option<Rayleigh>,
    /// Whether rigid bodies at which soil stands without a gap are laid on it, as those are that a force pushes (theory, eq. 46).
    pub is_laid: bool,
}

impl<const D: usize> StepConditions<D> {
    /// Conditions that agree with one another.
    ///
    /// # Errors
    /// [`AssemblyError::OtherGrid`] for constraints that were made for another grid,
    /// [`AssemblyError::NonFinite`] for loads that are not finite.
    pub fn new(
        grid: Grid<D>,
        constraints: Constraints<D>,
        loads: StepLoads<D>,
        laws: Vec<SharedLaw>,
    ) -> Result<Self, AssemblyError> {
        let conditions = Self {
            grid,
            constraints,
            loads,
            laws,
            motions: Vec::new(),
            reinforcement: Vec::new(),
            water: Water::default(),
            flow: None,
            held: None,
            time: None,
            walls: None,
            ground: None,
            damping: None,
            is_laid: false,
        };
        conditions.validate_fields()?;
        Ok(conditions)
    }

    /// The same with rigid bodies that move, in their order.
    ///
    /// # Errors
    /// [`AssemblyError::NonFinite`] for a motion that is not finite.
    pub fn with_motions(mut self, motions: Vec<RigidMotion<D>>) -> Result<Self, AssemblyError> {
        self.motions = motions;
        self.validate_fields()?;
        Ok(self)
    }

    /// The same with rigid bodies laid on the soil that stands at them without a gap.
    #[must_use]
    pub fn with_bodies_laid(mut self) -> Self {
        self.is_laid = true;
        self
    }

    /// The same with controls of reinforcement, in its order.
    ///
    /// # Errors
    /// [`AssemblyError::NonFinite`] for a jack or a reduction that is none.
    pub fn with_reinforcement(
        mut self,
        controls: Vec<ReinforcementControl>,
    ) -> Result<Self, AssemblyError> {
        self.reinforcement = controls;
        self.validate_fields()?;
        Ok(self)
    }

    /// The same with water in the pores.
    ///
    /// # Errors
    /// [`AssemblyError::NonFinite`] for water that is not finite.
    pub fn with_water(mut self, water: Water<D>) -> Result<Self, AssemblyError> {
        self.water = water;
        self.validate_fields()?;
        Ok(self)
    }

    /// The time that the step takes, zero in statics \[time\].
    pub fn duration(&self) -> f64 {
        let of_motion = self.time.map(|time| time.duration);
        let of_flow = self.flow.as_ref().map(|flow| flow.duration);
        of_motion.or(of_flow).unwrap_or(0.0)
    }

    /// The same with water that flows out of soil while the step takes time.
    ///
    /// # Errors
    /// [`AssemblyError::NonFinite`] for a duration, a permeability or a stiffness of water that is none.
    pub fn with_flow(mut self, flow: Option<Consolidating<D>>) -> Result<Self, AssemblyError> {
        self.flow = flow;
        self.validate_fields()?;
        Ok(self)
    }

    /// The same with forces that hold the body; they belong to the nodes of its grid.
    ///
    /// # Errors
    /// [`AssemblyError::NonFinite`] for a force that is not finite, or forces of another number of nodes.
    pub fn with_unbalanced(
        mut self,
        held: Option<UnbalancedForces<D>>,
    ) -> Result<Self, AssemblyError> {
        self.held = held;
        self.validate_fields()?;
        Ok(self)
    }

    /// The same over a time, with inertia.
    ///
    /// # Errors
    /// [`AssemblyError::NonFinite`] for a duration that is not positive and finite.
    pub fn with_time(mut self, time: Option<TimeStep>) -> Result<Self, AssemblyError> {
        self.time = time;
        self.validate_fields()?;
        Ok(self)
    }

    /// The same with walls behind which the ground goes on.
    ///
    /// # Errors
    /// [`AssemblyError::NonFinite`] for a wall that is none.
    pub fn with_walls(mut self, walls: Option<Walls<D>>) -> Result<Self, AssemblyError> {
        self.walls = walls;
        self.validate_fields()?;
        Ok(self)
    }

    /// The same on ground that moves.
    ///
    /// # Errors
    /// [`AssemblyError::NonFinite`] for an acceleration that is not finite.
    pub fn with_ground(mut self, ground: Option<GroundMotion<D>>) -> Result<Self, AssemblyError> {
        self.ground = ground;
        self.validate_fields()?;
        Ok(self)
    }

    /// The same with viscous damping of soil.
    ///
    /// # Errors
    /// [`AssemblyError::NonFinite`] for damping that is negative or not finite.
    pub fn with_damping(mut self, damping: Option<Rayleigh>) -> Result<Self, AssemblyError> {
        self.damping = damping;
        self.validate_fields()?;
        Ok(self)
    }

    /// Refuses conditions that do not agree with one another.
    fn validate_fields(&self) -> Result<(), AssemblyError> {
        self.constraints.belong_to(&self.grid)?;
        if let Some(index) = self.motions.iter().position(|motion| !motion.is_finite()) {
            let quantity = "motion of a rigid body";
            return Err(AssemblyError::NonFinite { quantity, index });
        }
        let sound = |control: &ReinforcementControl| control.is_sound();
        if let Some(index) = (self.reinforcement.iter()).position(|control| !sound(control)) {
            let quantity = "jack or reduction of a reinforcement";
            return Err(AssemblyError::NonFinite { quantity, index });
        }
        if let Some(held) = &self.held {
            let bad = |force: &[f64; D]| !force.iter().all(|f| (f * held.share).is_finite());
            let nodes = self.grid.node_count();
            let other = (held.forces.len() != nodes).then_some(nodes);
            if let Some(index) = other.or_else(|| held.forces.iter().position(bad)) {
                let quantity = "force that holds the body at node";
                return Err(AssemblyError::NonFinite { quantity, index });
            }
        }
        if self.time.is_some_and(|time| !time.is_sound()) {
            let (quantity, index) = ("duration of a step", 0);
            return Err(AssemblyError::NonFinite { quantity, index });
        }
        let of_motion = [
            (
                "wall",
                self.walls.as_ref().is_some_and(|walls| !walls.are_sound()),
            ),
            (
                "acceleration of the ground",
                self.ground.is_some_and(|ground| !ground.is_finite()),
            ),
            (
                "damping of soil",
                self.damping.is_some_and(|damping| !damping.is_sound()),
            ),
        ];
        if let Some((quantity, _)) = of_motion.into_iter().find(|(_, is_wrong)| *is_wrong) {
            return Err(AssemblyError::NonFinite { quantity, index: 0 });
        }
        if let Some(flow) = &self.flow {
            flow.are_sound()?;
        }
        self.water.is_finite()?;
        self.loads.are_finite()
    }

    /// Refuses conditions that do not agree with one another, for a field may have been changed since they were made,
    /// and particles whose law is not among them.
    pub(crate) fn validate(&self, particles: &Particles<D>) -> Result<(), AssemblyError> {
        self.validate_fields()?;
        let laws = self.laws.len();
        match particles.law.iter().position(|&law| law >= laws) {
            Some(particle) => Err(AssemblyError::UnknownLaw {
                particle,
                law: particles.law[particle],
                laws,
            }),
            None => Ok(()),
        }
    }
}
