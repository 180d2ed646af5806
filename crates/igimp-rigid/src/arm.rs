//! The arm of the centre of mass of a rigid body about its reference point, over a step (theory, eqs. 67b and 67c).

use crate::turn::{cross, mean_beyond};
use crate::{RigidBody, Turn, rotations, turn};

/// From the reference point of a body to its centre of mass, as a step begins and as the body turns in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arm<const D: usize> {
    start: [f64; D],
    /// The factor by which rotations become lengths \[length\].
    size: f64,
    /// Whether it turns with the body: not on a given geometry.
    turns: bool,
}

impl<const D: usize> RigidBody<D> {
    /// The arm of its centre of mass, unless that is its reference point; whether it `turns` in a step.
    pub fn arm(&self, turns: bool) -> Option<Arm<D>> {
        let is_off = self.motion.centre.iter().any(|x| *x != 0.0);
        is_off.then(|| Arm {
            start: self.pose.direction(&self.motion.centre),
            size: self.surface.size(),
            turns,
        })
    }
}

impl<const D: usize> Arm<D> {
    /// As the step begins \[length\].
    pub fn at_start(&self) -> [f64; D] {
        self.start
    }

    /// Once the body has turned by a rotation in lengths \[length\].
    pub fn after(&self, rotation: &[f64; D]) -> [f64; D] {
        let way = self.way(rotation);
        std::array::from_fn(|a| self.start[a] + if self.turns { way[a] } else { 0.0 })
    }

    /// The way of the centre of mass less that of the reference point, (R − 1) s = φ × m, by a rotation in lengths \[length\].
    pub fn way(&self, rotation: &[f64; D]) -> [f64; D] {
        cross(&self.angle(rotation), &self.mean(rotation))
    }

    /// The mean m of the arm over the turn \[length\].
    fn mean(&self, rotation: &[f64; D]) -> [f64; D] {
        if !self.turns {
            return self.start;
        }
        let beyond = mean_beyond(&self.angle(rotation), &self.start);
        std::array::from_fn(|a| self.start[a] + beyond[a])
    }

    /// The rotation \[rad\] of one in lengths.
    fn angle(&self, rotation: &[f64; D]) -> [f64; 3] {
        turn::angle(rotation, self.size)
    }

    /// The way of the centre of mass by a rotation in lengths, in the direction of an `arm` and no more: by component of the
    /// rotation \[-\].
    pub fn lever(&self, arm: &[f64; D]) -> [[f64; D]; D] {
        let mut lever = [[0.0; D]; D];
        for k in 0..rotations(D) {
            let mut unit = [0.0; 3];
            unit[k] = 1.0 / self.size;
            let way = cross(&unit, arm);
            for (row, way) in lever.iter_mut().zip(way) {
                row[k] = way;
            }
        }
        lever
    }

    /// The velocity of the centre of mass against the reference point by an `arm`, as the body turns with a `spin` in lengths; so too its
    /// acceleration by a rate of spin \[length/time, length/time²\].
    pub fn carried(&self, arm: &[f64; D], spin: &[f64; D]) -> [f64; D] {
        cross(&self.angle(spin), arm)
    }

    /// The acceleration of the centre of mass towards the axis by an `arm`, as the body turns with a `spin` in lengths \[length/time²\]; none
    /// where the arm does not turn.
    pub fn pulled(&self, arm: &[f64; D], spin: &[f64; D]) -> [f64; D] {
        if self.turns {
            self.carried(&self.carried(arm, spin), spin)
        } else {
            [0.0; D]
        }
    }

    /// The moment of a force at the centre of mass by an `arm`, over the size of the body \[force\].
    pub fn moment(&self, arm: &[f64; D], force: &[f64; D]) -> [f64; D] {
        let lever = self.lever(arm);
        std::array::from_fn(|k| (0..D).map(|a| lever[a][k] * force[a]).sum())
    }

    /// The derivative of [`Self::way`] by the rotation in lengths \[-\].
    pub fn slope_of_way(&self, rotation: &[f64; D]) -> [[f64; D]; D] {
        let lever = self.lever(&self.after(rotation));
        if self.turns {
            Turn::by(rotation, self.size).by_vector(&lever)
        } else {
            lever
        }
    }

    /// The derivative of the moment of a force at the centre of mass after a rotation in lengths, over the squared size of the body
    /// \[force/length\].
    pub fn slope_of_moment(&self, rotation: &[f64; D], force: &[f64; D]) -> [[f64; D]; D] {
        if self.turns {
            let arms = self.start.map(|x| force.map(|f| x * f));
            Turn::by(rotation, self.size).slope_of_moment(&arms)
        } else {
            [[0.0; D]; D]
        }
    }
}

#[cfg(test)]
mod tests {
    use igimp_shape::matrices::multiply;
    use igimp_surface::Surface;

    use super::*;
    use crate::Interface;
    use crate::pose::turn_by;

    fn arm() -> Arm<3> {
        Arm {
            start: [0.3, -0.5, 0.7],
            size: 1.25,
            turns: true,
        }
    }

    /// GOAL: the way of the centre of mass is that of the turned arm, by small and large angles.
    /// ORACLE: the rotation of a pose.
    #[test]
    fn the_centre_of_mass_goes_round() {
        for by in [1e-6, 5e-3, 0.0099, 0.0101, 0.7, 3.0] {
            let rotation = [0.6 * by, -0.2 * by, 0.5 * by];
            let turn = turn_by::<3>(&rotation.map(|x| x / 1.25));
            let start = [arm().start, [0.0; 3], [0.0; 3]];
            let columns = std::array::from_fn(|a| std::array::from_fn(|b| start[b][a]));
            let turned = multiply(&turn, &columns);
            for (row, moved) in turned.iter().zip(arm().after(&rotation)) {
                assert!((row[0] - moved).abs() < 1e-15, "{by}");
            }
        }
    }

    /// GOAL: way and moment have the derivatives that Newton's method needs.
    /// ORACLE: central differences.
    #[test]
    fn way_and_moment_change_as_the_body_turns() {
        let (force, d) = ([2.0, -1.0, 0.5], 1e-5);
        for by in [0.0, 0.2, 2.0] {
            let rotation = [0.6 * by, -0.2 * by, 0.5 * by];
            let of_way = arm().slope_of_way(&rotation);
            let of_moment = arm().slope_of_moment(&rotation, &force);
            for k in 0..3 {
                let at = |sign: f64| {
                    let mut rotation = rotation;
                    rotation[k] += sign * d;
                    rotation
                };
                let [plus, minus] = [at(1.0), at(-1.0)];
                let [more, less] = [&plus, &minus].map(|turn| arm().way(turn));
                let [strong, weak] =
                    [&plus, &minus].map(|turn| arm().moment(&arm().after(turn), &force));
                for i in 0..3 {
                    assert!((0.5 * (more[i] - less[i]) / d - of_way[i][k]).abs() < 1e-9);
                    assert!((0.5 * (strong[i] - weak[i]) / d - of_moment[i][k]).abs() < 1e-9);
                }
            }
        }
    }

    /// GOAL: a body whose centre of mass is its reference point has no arm; one in the plane turns it about the axis across.
    /// ORACLE: a quarter turn takes x to y.
    #[test]
    fn an_arm_in_the_plane() {
        let surface = Surface::circle(0.5, 0.1).unwrap();
        let mut body = RigidBody::new(surface, vec![Interface::smooth()], [0.0; 2]);
        assert_eq!(body.arm(true), None);
        body.motion.centre = [2.0, 0.0];
        let arm = body.arm(true).unwrap();
        let quarter = [std::f64::consts::FRAC_PI_2 * body.surface.size(), 0.0];
        let [x, y] = arm.after(&quarter);
        assert!(x.abs() < 1e-15 && (y - 2.0).abs() < 1e-15);
        let [moment, none] = arm.moment(&arm.at_start(), &[0.0, 3.0]);
        assert!((moment * body.surface.size() - 6.0).abs() < 1e-15 && none == 0.0);
    }
}
