//! From space to the picture: a parallel projection, so that lengths in a direction stay comparable.

use crate::geometry::{Point, Rect};

/// Where a body is looked at from; z is upright.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Angle \[°\] about the upright axis: from 0, along y, turned so that the eye goes from −y to +x.
    pub turn: f64,
    /// Height \[°\] of the eye above the level plane.
    pub raise: f64,
}

impl Default for View {
    /// The isometric view.
    fn default() -> Self {
        Self {
            turn: 45.0,
            raise: 35.264,
        }
    }
}

impl View {
    /// Unit vectors to the right, upwards and towards the eye.
    pub(crate) fn directions(&self) -> [[f64; 3]; 3] {
        let (turn, raise) = (self.turn.to_radians(), self.raise.to_radians());
        let right = [turn.cos(), turn.sin(), 0.0];
        let eye = [
            raise.cos() * turn.sin(),
            -raise.cos() * turn.cos(),
            raise.sin(),
        ];
        let up = [
            -raise.sin() * turn.sin(),
            raise.sin() * turn.cos(),
            raise.cos(),
        ];
        [right, up, eye]
    }
}

pub(crate) fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A view of a body that fills an area of the picture.
#[derive(Debug)]
pub(crate) struct Projection {
    pub(crate) right: [f64; 3],
    pub(crate) up: [f64; 3],
    pub(crate) eye: [f64; 3],
    /// Least and largest corner of the view.
    pub(crate) extent: [[f64; 3]; 2],
    centre: [f64; 3],
    /// Points by metre.
    pub(crate) scale: f64,
    /// The area that the body occupies; whole points.
    pub(crate) area: Rect,
}

impl Projection {
    /// The largest image within `room`, below and right of `corner`, in its middle from left to right.
    pub(crate) fn new(view: View, extent: [[f64; 3]; 2], room: [f64; 2], corner: Point) -> Self {
        let [right, up, eye] = view.directions();
        let [low, high] = extent;
        let across = |v: &[f64; 3]| -> f64 {
            let size: f64 = (0..3).map(|k| v[k].abs() * (high[k] - low[k])).sum();
            if size > 0.0 { size } else { 1.0 }
        };
        let size = [across(&right), across(&up)];
        let scale = (room[0] / size[0]).min(room[1] / size[1]);
        let [width, height] = size.map(|length| (scale * length).ceil() + 2.0);
        let left = (corner[0] + 0.5 * (room[0] - width).max(0.0)).floor();
        Self {
            right,
            up,
            eye,
            extent,
            centre: [0, 1, 2].map(|k| 0.5 * (low[k] + high[k])),
            scale,
            area: Rect::new(left, corner[1], width, height),
        }
    }

    /// The place of a point in the picture \[pt\].
    pub(crate) fn place(&self, point: &[f64; 3]) -> Point {
        let from = [0, 1, 2].map(|k| point[k] - self.centre[k]);
        let [x, y] = self.area.centre();
        [
            x + self.scale * dot(&self.right, &from),
            y - self.scale * dot(&self.up, &from),
        ]
    }

    /// How near a point is to the eye \[m\].
    pub(crate) fn depth(&self, point: &[f64; 3]) -> f64 {
        dot(&self.eye, &[0, 1, 2].map(|k| point[k] - self.centre[k]))
    }

    /// How light a surface is; the same as in the pages that turn the body.
    pub(crate) fn light(&self, normal: &[f64; 3], open: f64) -> f64 {
        let towards =
            [0, 1, 2].map(|k| -0.35 * self.right[k] + 0.6 * self.up[k] + 0.72 * self.eye[k]);
        let share = (dot(normal, &towards) / dot(&towards, &towards).sqrt()).max(0.0);
        let hollow = ((open - 0.12) / 0.3).clamp(0.0, 1.0);
        (0.5 + 0.52 * share) * (0.72 + 0.28 * hollow)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_those_of_a_draughtsman() {
        let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|k| (a[k] - b[k]).abs() < 1e-12);
        let of = |turn, raise| View { turn, raise }.directions();
        let [right, up, eye] = of(0.0, 0.0);
        assert!(near(right, [1.0, 0.0, 0.0]) && near(up, [0.0, 0.0, 1.0]));
        assert!(near(eye, [0.0, -1.0, 0.0]));
        // From above the plane is seen as plane cases are drawn.
        let [right, up, _] = of(0.0, 90.0);
        assert!(near(right, [1.0, 0.0, 0.0]) && near(up, [0.0, 1.0, 0.0]));
        // In the isometric view the axes are of one length.
        let [right, up, _] = View::default().directions();
        let length = |k: usize| right[k].hypot(up[k]);
        assert!((length(0) - length(2)).abs() < 1e-5 && (length(1) - length(2)).abs() < 1e-5);
    }

    #[test]
    fn the_body_fills_its_area() {
        let projection = Projection::new(
            View::default(),
            [[1.0, 2.0, 3.0], [5.0, 4.0, 6.0]],
            [300.0, 200.0],
            [10.0, 20.0],
        );
        for k in 0..8 {
            let corner = [0, 1, 2].map(|axis| projection.extent[k >> axis & 1][axis]);
            assert!(projection.area.contains(projection.place(&corner)));
        }
        let lit = |normal: [f64; 3]| projection.light(&normal, 0.5);
        assert!(lit([0.0, 0.0, 1.0]) > lit([0.0, -1.0, 0.0]));
        assert!(lit([0.0, -1.0, 0.0]) > lit([1.0, 0.0, 0.0]));
        assert!(projection.light(&[0.0, 0.0, 1.0], 0.1) < lit([0.0, 0.0, 1.0]));
    }
}
