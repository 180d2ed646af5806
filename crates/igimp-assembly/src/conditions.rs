//! What holds during one step, besides the particles.

pub(crate) mod constraints;
pub(crate) mod loads;
pub(crate) mod reinforcement;
pub(crate) mod rigid_motion;
pub(crate) mod time_step;
pub(crate) mod unbalanced;
pub(crate) mod water;

use igimp_shape::Grid;

use crate::body::particles::Particles;
use crate::conditions::reinforcement::ReinforcementControl;
use crate::conditions::rigid_motion::RigidMotion;
use crate::conditions::water::Water;
use crate::error::AssemblyError;
use crate::laws::SharedLaw;
use constraints::Constraints;
use loads::StepLoads;
use time_step::TimeStep;
use unbalanced::UnbalancedForces;

/// What holds during one step, besides the particles.
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
    /// What acts on reinforcement, in its order; what is not listed stretches with the ground, with its
    /// whole bond.
    pub reinforcement: Vec<ReinforcementControl>,
    /// Water in the pores at the end of the step.
    pub water: Water<D>,
    /// What still holds the body where a change has put it out of balance.
    pub held: Option<UnbalancedForces<D>>,
    /// The time that the step takes; none in statics.
    pub time: Option<TimeStep>,
}

impl<const D: usize> StepConditions<D> {
    /// Conditions that validate_fields with one another.
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
            held: None,
            time: None,
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

    /// The same with what acts on reinforcement, in its order.
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

    /// Refuses conditions that do not validate_fields.
    fn validate_fields(&self) -> Result<(), AssemblyError> {
        self.constraints.belong_to(&self.grid)?;
        if let Some(index) = self.motions.iter().position(|motion| !motion.is_finite()) {
            let what = "motion of a rigid body";
            return Err(AssemblyError::NonFinite { what, index });
        }
        let sound = |control: &ReinforcementControl| control.is_sound();
        if let Some(index) = self.reinforcement.iter().position(|own| !sound(own)) {
            let what = "jack or reduction of a reinforcement";
            return Err(AssemblyError::NonFinite { what, index });
        }
        if let Some(held) = &self.held {
            let bad = |force: &[f64; D]| !force.iter().all(|own| (own * held.share).is_finite());
            let nodes = self.grid.node_count();
            let other = (held.forces.len() != nodes).then_some(nodes);
            if let Some(index) = other.or_else(|| held.forces.iter().position(bad)) {
                let what = "force that holds the body at node";
                return Err(AssemblyError::NonFinite { what, index });
            }
        }
        if self.time.is_some_and(|time| !time.is_sound()) {
            let (what, index) = ("duration of a step", 0);
            return Err(AssemblyError::NonFinite { what, index });
        }
        self.water.is_finite()?;
        self.loads.are_finite()
    }

    /// Refuses conditions that do not validate_fields, for a field may have been changed since they were made,
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
