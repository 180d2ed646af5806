//! What a step changes: the particles, the points that carry loads, rigid bodies and
//! reinforcement.

use igimp_assembly::{LoadPoint, Particles, Reinforcement, RigidBody};

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
}

impl<const D: usize> Body<D> {
    /// A body that only its weight and its supports act on.
    pub fn new(particles: Particles<D>) -> Self {
        Self {
            particles,
            load_points: Vec::new(),
            rigid: Vec::new(),
            reinforcement: Vec::new(),
        }
    }

    /// Takes all motion from what moves, as before a march in statics.
    pub fn rest(&mut self) {
        self.particles.rest();
        self.rigid.iter_mut().for_each(RigidBody::rest);
    }
}
