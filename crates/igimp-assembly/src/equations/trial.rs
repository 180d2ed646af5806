//! All particles at a trial displacement.

use crate::equations::kinematics::ParticleTrial;

/// All particles at a trial displacement. Its memory is used again from one trial to the next.
#[derive(Clone, Debug, Default)]
pub struct Trial<const D: usize> {
    /// The particles in the order of [`Stencils::order`](crate::Stencils::order).
    pub particles: Vec<ParticleTrial<D>>,
    /// Internal force by node, ghost penalty, drag and inertia included \[force\].
    pub f_int: Vec<[f64; D]>,
    /// Norm of the force of acceleration; zero in statics \[force\].
    pub inertia: f64,
}
