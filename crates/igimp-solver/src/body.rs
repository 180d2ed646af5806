//! The body that a step changes: the particles, the points that carry loads, rigid bodies and
//! reinforcement.

use igimp_assembly::{LoadPoint, Particles, Reinforcement, RigidBody, Structures};

use crate::free_field::FreeField;

/// The state that marches from one equilibrium to the next.
#[derive(Clone, Debug)]
pub struct Body<const D: usize> {
    /// The particles.
    pub particles: Particles<D>,
    /// Loaded points, carried along by the soil.
    pub load_points: Vec<LoadPoint<D>>,
    /// Rigid bodies that the soil may touch.
    pub rigid: Vec<RigidBody<D>>,
    /// Anchors, nails and geotextiles in the soil.
    pub reinforcement: Vec<Reinforcement<D>>,
    /// Columns in free field beside walls, while the body moves in time.
    pub free_fields: Vec<FreeField<D>>,
}

impl<const D: usize> Body<D> {
    /// A body that only its weight and its supports act on.
    pub fn new(particles: Particles<D>) -> Self {
        Self {
            particles,
            load_points: Vec::new(),
            rigid: Vec::new(),
            reinforcement: Vec::new(),
            free_fields: Vec::new(),
        }
    }

    /// The structures in its soil and on it.
    pub fn structures(&self) -> Structures<'_, D> {
        Structures {
            bodies: &self.rigid,
            members: &self.reinforcement,
            points: &self.load_points,
        }
    }

    /// Takes all motion from the body, as before a march in statics, and with it the free fields.
    pub fn rest(&mut self) {
        self.free_fields.clear();
        self.particles.rest();
        self.rigid.iter_mut().for_each(RigidBody::rest);
    }
}
