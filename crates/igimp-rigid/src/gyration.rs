//! The moments of inertia of a rigid body in space, which turn with it, over a step (theory, eq. 67d).

use igimp_shape::matrices::{apply, congruence, multiply};

use crate::RigidBody;
use crate::pose::turn_by;
use crate::turn::cross;

/// Moments of inertia that differ by less count as equal, over the largest of them \[-\].
const EQUAL: f64 = 1e-12;

/// Moments of inertia of a body in space over its squared size, as a step begins and as the body turns in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gyration<const D: usize> {
    /// About the axes of space through the centre of mass, as the step begins \[mass\].
    start: [[f64; D]; D],
    /// The factor by which rotations become lengths \[length\].
    size: f64,
}

impl<const D: usize> RigidBody<D> {
    /// Its moments of inertia, where a turn changes them: in space, and where they are not equal about all axes.
    pub fn gyration(&self) -> Option<Gyration<D>> {
        let moments = &self.motion.moments;
        let largest = moments.as_flattened().iter().copied().fold(0.0, f64::max);
        let differs = |a: usize, b: usize| {
            let equal = if a == b { moments[0][0] } else { 0.0 };
            (moments[a][b] - equal).abs() > EQUAL * largest
        };
        let are_unequal = (0..3).any(|a| (0..3).any(|b| differs(a, b)));
        (D == 3 && are_unequal).then(|| Gyration {
            start: self.nodal_mass()[1],
            size: self.surface.size(),
        })
    }
}

impl<const D: usize> Gyration<D> {
    /// The moments of inertia once the body has turned by a rotation in lengths \[mass\].
    pub fn after(&self, rotation: &[f64; D]) -> [[f64; D]; D] {
        congruence(&turn_by(&self.angle(rotation)), &self.start)
    }

    /// The rate of angular momentum I ω̇ + ω × I ω over the size of the body \[force\]: by moments of inertia \[mass\], the spin and its rate
    /// in lengths.
    pub fn rate(&self, moments: &[[f64; D]; D], [spin, rate]: [&[f64; D]; 2]) -> [f64; D] {
        let [momentum, torque] = [spin, rate].map(|v| apply(moments, v));
        let turning = cross(&self.angle(spin), &momentum);
        std::array::from_fn(|a| torque[a] + turning[a])
    }

    /// The derivative of that rate \[mass/time²\] by the rotation of the step in lengths, which changes rate and spin by so much each
    /// \[1/time², 1/time\] and turns the moments of inertia by a share of it.
    pub fn slope(
        &self,
        moments: &[[f64; D]; D],
        [spin, rate]: [&[f64; D]; 2],
        [of_rate, of_spin, share]: [f64; 3],
    ) -> [[f64; D]; D] {
        let [momentum, torque] = [spin, rate].map(|v| self.across(&apply(moments, v)));
        let [by_spin, by_rate] = [spin, rate].map(|v| self.across(v));
        // As the body turns by dθ, I v changes by dθ × I v − I (dθ × v).
        let turned = |by: &[[f64; D]; D], matrix: &[[f64; D]; D]| {
            let within = multiply(moments, by);
            std::array::from_fn::<[f64; D], D, _>(|a| {
                std::array::from_fn(|b| share * (within[a][b] - matrix[a][b]))
            })
        };
        let of_momentum = turned(&by_spin, &momentum);
        let of_torque = turned(&by_rate, &torque);
        let carried = multiply(
            &by_spin,
            &std::array::from_fn(|a| {
                std::array::from_fn(|b| of_spin * moments[a][b] + of_momentum[a][b])
            }),
        );
        std::array::from_fn(|a| {
            std::array::from_fn(|b| {
                of_rate * moments[a][b] + of_torque[a][b] + carried[a][b] - of_spin * momentum[a][b]
            })
        })
    }

    /// The matrix of the vector product with a rotation in lengths.
    fn across(&self, rotation: &[f64; D]) -> [[f64; D]; D] {
        let angle = self.angle(rotation);
        let mut matrix = [[0.0; D]; D];
        for column in 0..D {
            let mut unit = [0.0; D];
            unit[column] = 1.0;
            for (row, entry) in matrix.iter_mut().zip(cross(&angle, &unit)) {
                row[column] = entry;
            }
        }
        matrix
    }

    /// The rotation \[rad\] of one in lengths.
    fn angle(&self, rotation: &[f64; D]) -> [f64; 3] {
        let mut angle = [0.0; 3];
        for (angle, x) in angle.iter_mut().zip(rotation) {
            *angle = x / self.size;
        }
        angle
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GYRATION: Gyration<3> = Gyration {
        start: [[3.0, 0.4, -0.2], [0.4, 2.0, 0.1], [-0.2, 0.1, 1.0]],
        size: 1.25,
    };

    /// GOAL: the slope of the rate of angular momentum is that which Newton's method needs.
    /// ORACLE: differences of the rate, of a step from rotations small enough that they add.
    #[test]
    fn the_rate_changes_as_the_body_turns() {
        let (of_rate, of_spin, share) = (40.0, 6.0, 0.7);
        let at = |by: &[f64; 3]| {
            let moments = GYRATION.after(&by.map(|x| share * x));
            let spin = std::array::from_fn(|a| [2.0, -1.0, 0.5][a] + of_spin * by[a]);
            let rate = std::array::from_fn(|a| [0.3, 4.0, -5.0][a] + of_rate * by[a]);
            (moments, spin, rate)
        };
        let (moments, spin, rate) = at(&[0.0; 3]);
        let slope = GYRATION.slope(&moments, [&spin, &rate], [of_rate, of_spin, share]);
        let step = 1e-5;
        for column in 0..3 {
            let [above, below] = [step, -step].map(|step| {
                let mut by = [0.0; 3];
                by[column] = step;
                let (moments, spin, rate) = at(&by);
                GYRATION.rate(&moments, [&spin, &rate])
            });
            for row in 0..3 {
                let difference = (above[row] - below[row]) / (2.0 * step);
                assert!(
                    (difference - slope[row][column]).abs() < 1e-7,
                    "{row} {column}: {difference} {}",
                    slope[row][column]
                );
            }
        }
    }
}
