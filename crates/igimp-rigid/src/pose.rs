//! Where a rigid body stands.

use igimp_shape::matrices::{identity, multiply, transpose_apply};

/// Place and direction of a rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct Pose<const D: usize> {
    /// The reference point \[length\].
    pub origin: [f64; D],
    /// Rotation from the frame of the body into space.
    pub turn: [[f64; D]; D],
    /// Rotation since the start, summed over the steps \[rad\]: in the plane the first component; in space about the
    /// axes, which is where `turn` stands only as long as the axis stays.
    pub angle: [f64; 3],
}

impl<const D: usize> Pose<D> {
    /// Not turned, with the reference point at `origin` \[length\].
    pub fn at(origin: [f64; D]) -> Self {
        Self {
            origin,
            turn: identity(),
            angle: [0.0; 3],
        }
    }

    /// A point of space in the frame of the body.
    pub fn into_body(&self, x: &[f64; D]) -> [f64; D] {
        let arm = std::array::from_fn(|axis| x[axis] - self.origin[axis]);
        transpose_apply(&self.turn, &arm)
    }

    /// A direction of the body in space.
    pub fn direction(&self, v: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|a| (0..D).map(|b| self.turn[a][b] * v[b]).sum())
    }

    /// A point of the body in space.
    pub fn into_space(&self, x: &[f64; D]) -> [f64; D] {
        let arm = self.direction(x);
        std::array::from_fn(|axis| self.origin[axis] + arm[axis])
    }

    /// A direction of space in the frame of the body.
    pub fn direction_in_body(&self, v: &[f64; D]) -> [f64; D] {
        transpose_apply(&self.turn, v)
    }

    /// The pose after a displacement \[length\] and a rotation \[rad\].
    #[must_use]
    pub fn moved(&self, displacement: &[f64; D], rotation: &[f64; 3]) -> Self {
        Self {
            origin: std::array::from_fn(|axis| self.origin[axis] + displacement[axis]),
            turn: multiply(&turn_by(rotation), &self.turn),
            angle: std::array::from_fn(|k| self.angle[k] + rotation[k]),
        }
    }
}

/// The matrix of a rotation: by an angle in the plane, by a vector in space (theory, eq. 45d).
pub(crate) fn turn_by<const D: usize>(rotation: &[f64; 3]) -> [[f64; D]; D] {
    let mut out = identity::<D>();
    if D == 2 {
        let (sin, cos) = rotation[0].sin_cos();
        out[0][0] = cos;
        out[0][1] = -sin;
        out[1][0] = sin;
        out[1][1] = cos;
    } else if D == 3 {
        let angle = rotation.iter().map(|r| r * r).sum::<f64>().sqrt();
        if angle > 0.0 {
            let axis = rotation.map(|r| r / angle);
            let (sin, cos) = angle.sin_cos();
            for a in 0..3 {
                let (b, c) = ((a + 1) % 3, (a + 2) % 3);
                for (k, entry) in out[a].iter_mut().enumerate() {
                    *entry = (1.0 - cos) * axis[a] * axis[k] + if k == a { cos } else { 0.0 };
                }
                out[a][b] -= sin * axis[c];
                out[a][c] += sin * axis[b];
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn a_quarter_turn_takes_x_to_y() {
        let plane = Pose::<2>::at([1.0, 2.0]).moved(&[0.0; 2], &[FRAC_PI_2, 0.0, 0.0]);
        let [x, y] = plane.into_space(&[1.0, 0.0]);
        assert!((x - 1.0).abs() < 1e-15 && (y - 3.0).abs() < 1e-15);
        let space = Pose::<3>::at([0.0; 3]).moved(&[0.0; 3], &[0.0, 0.0, FRAC_PI_2]);
        let turned = space.into_space(&[1.0, 0.0, 0.5]);
        for (found, expected) in turned.iter().zip([0.0, 1.0, 0.5]) {
            assert!((found - expected).abs() < 1e-15);
        }
        let back = space.into_body(&turned);
        assert!((back[0] - 1.0).abs() < 1e-15 && (back[2] - 0.5).abs() < 1e-15);
    }
}
