//! Mass and velocity of a rigid body (theory, eqs. 67 and 67b).

use crate::{NODES_PER_BODY, RigidBody, rotations};
use igimp_shape::matrices::congruence;

/// Mass of a rigid body, and its velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidInertia<const D: usize> {
    /// Mass; zero for a body without inertia \[mass; per unit thickness in plane strain\].
    pub mass: f64,
    /// The centre of mass in the frame of the body, from its reference point \[length\].
    pub centre: [f64; D],
    /// Moments of inertia about the axes of the body through the centre of mass; in the plane the last one counts \[mass·length²\].
    pub moments: [[f64; 3]; 3],
    /// Velocity of the centre of mass \[length/time\].
    pub velocity: [f64; D],
    /// Angular velocity: in the plane the first component, in space about the axes \[rad/time\].
    pub spin: [f64; 3],
    /// Acceleration of the centre of mass \[length/time²\].
    pub acceleration: [f64; D],
    /// Angular acceleration \[rad/time²\].
    pub spin_rate: [f64; 3],
}

impl<const D: usize> Default for RigidInertia<D> {
    fn default() -> Self {
        Self {
            mass: 0.0,
            centre: [0.0; D],
            moments: [[0.0; 3]; 3],
            velocity: [0.0; D],
            spin: [0.0; 3],
            acceleration: [0.0; D],
            spin_rate: [0.0; 3],
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

    /// The mass on the nodes that stand for its motion: of the displacement of its centre of mass, and of its rotation in lengths \[mass\].
    pub fn nodal_mass(&self) -> [[[f64; D]; D]; NODES_PER_BODY] {
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

    /// Kinetic energy of its motion \[mass·length²/time²\].
    pub fn kinetic_energy(&self) -> f64 {
        let velocities = self.nodal(&self.motion.velocity, &self.motion.spin);
        let mut energy = 0.0;
        for (mass, velocity) in self.nodal_mass().iter().zip(&velocities) {
            for (row, one) in mass.iter().zip(velocity) {
                for (mass, other) in row.iter().zip(velocity) {
                    energy += 0.5 * one * mass * other;
                }
            }
        }
        energy
    }

    /// A vector and a rotation vector of the body on these nodes, the latter times its size.
    pub fn nodal(&self, vector: &[f64; D], rotation: &[f64; 3]) -> [[f64; D]; NODES_PER_BODY] {
        let mut turned = [0.0; D];
        for (k, x) in turned.iter_mut().enumerate().take(rotations(D)) {
            *x = rotation[k] * self.surface.size();
        }
        [*vector, turned]
    }

    /// Takes all motion from the body, as before a step in statics.
    pub fn rest(&mut self) {
        self.motion = RigidInertia {
            mass: self.motion.mass,
            centre: self.motion.centre,
            moments: self.motion.moments,
            ..RigidInertia::default()
        };
    }

    /// Takes over how its nodes move at the end of a step: velocities \[length/time\] and accelerations \[length/time²\].
    pub fn accelerate(
        &mut self,
        velocity: &[[f64; D]; NODES_PER_BODY],
        acceleration: &[[f64; D]; NODES_PER_BODY],
    ) {
        let size = self.surface.size();
        self.motion.velocity = velocity[0];
        self.motion.acceleration = acceleration[0];
        for k in 0..rotations(D) {
            self.motion.spin[k] = velocity[1][k] / size;
            self.motion.spin_rate[k] = acceleration[1][k] / size;
        }
    }
}
