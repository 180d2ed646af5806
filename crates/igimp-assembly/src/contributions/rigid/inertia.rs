//! Mass and velocity of a rigid body (theory, eq. 67).

use super::{NODES_PER_BODY, RigidBody};
use crate::conditions::rigid_motion::rotations;
use crate::conditions::time_step::TimeStep;
use crate::small::congruence;

/// Mass of a rigid body, whose centre is its reference point, and its velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidInertia<const D: usize> {
    /// Mass; zero for a body without inertia \[mass; per unit thickness in plane strain\].
    pub mass: f64,
    /// Moments of inertia about the axes of the body; in the plane the last one counts \[mass·length²\].
    pub moments: [[f64; 3]; 3],
    /// Velocity of the reference point \[length/time\].
    pub velocity: [f64; D],
    /// Angular velocity: in the plane the first component, in space about the axes \[rad/time\].
    pub spin: [f64; 3],
}

impl<const D: usize> Default for RigidInertia<D> {
    fn default() -> Self {
        Self {
            mass: 0.0,
            moments: [[0.0; 3]; 3],
            velocity: [0.0; D],
            spin: [0.0; 3],
        }
    }
}

impl<const D: usize> RigidBody<D> {
    /// Moments of inertia about the axes of space, as the pose has turned them \[mass·length²\].
    fn moments_in_space(&self) -> [[f64; 3]; 3] {
        let mut turn = [[0.0; 3]; 3];
        for (a, row) in turn.iter_mut().enumerate() {
            row[a] = 1.0;
            if D == 3 {
                row.copy_from_slice(&self.pose.turn[a]);
            }
        }
        congruence(&turn, &self.motion.moments)
    }

    /// The mass on the nodes that stand for its motion: of its displacement, and of its rotation in lengths \[mass\].
    pub(crate) fn nodal_mass(&self) -> [[[f64; D]; D]; NODES_PER_BODY] {
        let mut displacement = [[0.0; D]; D];
        let mut rotation = [[0.0; D]; D];
        let moments = self.moments_in_space();
        let squared_size = self.surface.size().powi(2);
        for a in 0..D {
            displacement[a][a] = self.motion.mass;
            for b in 0..D {
                rotation[a][b] = match D {
                    2 if a + b == 0 => moments[2][2] / squared_size,
                    2 => 0.0,
                    _ => moments[a][b] / squared_size,
                };
            }
        }
        [displacement, rotation]
    }

    /// The velocity of these nodes \[length/time\].
    pub(crate) fn nodal_velocity(&self) -> [[f64; D]; NODES_PER_BODY] {
        let size = self.surface.size();
        let mut rotation = [0.0; D];
        for (k, own) in rotation.iter_mut().enumerate().take(rotations(D)) {
            *own = self.motion.spin[k] * size;
        }
        [self.motion.velocity, rotation]
    }

    /// The moment −ω × I ω of a turning body at the start of a step, as a force at the distance of its size \[force\]; none in the
    /// plane.
    pub(crate) fn gyroscopic_force(&self) -> [f64; D] {
        let mut force = [0.0; D];
        if D == 3 {
            let (spin, moments) = (self.motion.spin, self.moments_in_space());
            let momentum: [f64; 3] =
                std::array::from_fn(|a| (0..3).map(|b| moments[a][b] * spin[b]).sum());
            for (a, own) in force.iter_mut().enumerate() {
                let (b, c) = ((a + 1) % 3, (a + 2) % 3);
                *own = (spin[c] * momentum[b] - spin[b] * momentum[c]) / self.surface.size();
            }
        }
        force
    }

    /// Takes over the velocity that displacement and rotation of a step lead to: `u` are those of its nodes \[length\].
    pub(crate) fn accelerate(&mut self, time: &TimeStep, u: [&[f64; D]; NODES_PER_BODY]) {
        let [displaced, turned] = self.nodal_velocity();
        let size = self.surface.size();
        self.motion.velocity = time.velocity_after(&displaced, u[0]);
        let turned = time.velocity_after(&turned, u[1]);
        for k in 0..rotations(D) {
            self.motion.spin[k] = turned[k] / size;
        }
    }
}
