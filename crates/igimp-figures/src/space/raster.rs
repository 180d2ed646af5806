//! The surface of a body filled into pixels: of every face the part that no other one hides.

use super::Face;
use super::view::{Projection, dot};
use crate::FigureError;
use crate::colour::Colour;
use crate::drawing::{Image, PIXELS_PER_POINT};
use crate::field::colour_bar::ColourScale;

/// Samples by pixel in each direction.
const FINE: usize = 2;
/// Boxes with sides from so many samples on have lines along their edges, in full from twice as many.
const LEAST_SIDE: f64 = 12.0;
/// How much darker these are.
const LINE: f64 = 0.3;
/// Light on the insides of the far walls.
const BACK: f64 = 0.35;
/// Share of white in every colour: dark ones would hide the shape.
const LIFT: f64 = 0.07;
/// Opacity of rigid bodies.
const OPACITY: f64 = 0.62;
/// Their grey.
const GREY: Colour = Colour([120, 124, 130]);

/// Fills one image.
pub(crate) struct Painter<'a> {
    projection: &'a Projection,
    scale: &'a ColourScale,
    /// Samples.
    width: usize,
    height: usize,
    depth: Vec<f32>,
    rgb: Vec<[u8; 3]>,
}

/// A parallelogram among the samples: a corner, two sides, and its depth there and along these.
struct Placed {
    at: [f64; 2],
    sides: [[f64; 2]; 2],
    depth: [f64; 3],
}

impl<'a> Painter<'a> {
    pub(crate) fn new(projection: &'a Projection, scale: &'a ColourScale) -> Self {
        let samples = |length: f64| length as usize * PIXELS_PER_POINT as usize * FINE;
        let (width, height) = (
            samples(projection.area.width()),
            samples(projection.area.height()),
        );
        Self {
            projection,
            scale,
            width,
            height,
            depth: vec![f32::NEG_INFINITY; width * height],
            rgb: vec![[255; 3]; width * height],
        }
    }

    pub(crate) fn paint(
        mut self,
        faces: &[Face],
        bodies: &[[[f64; 3]; 3]],
    ) -> Result<Image, FigureError> {
        for face in faces {
            self.face(face);
        }
        for body in bodies {
            self.body(body);
        }
        self.image()
    }

    /// A place among the samples, and how near it is.
    fn sample(&self, point: &[f64; 3]) -> [f64; 3] {
        let by_point = f64::from(PIXELS_PER_POINT) * FINE as f64;
        let [x, y] = self.projection.place(point);
        let area = self.projection.area;
        [
            by_point * (x - area.left),
            by_point * (y - area.top),
            self.projection.depth(point),
        ]
    }

    fn placed(&self, [corner, one, two]: [&[f64; 3]; 3]) -> Option<Placed> {
        let [a, b, c] = [corner, one, two].map(|point| self.sample(point));
        let finite = [a, b, c].iter().flatten().all(|x| x.is_finite());
        finite.then(|| Placed {
            at: [a[0], a[1]],
            sides: [[b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]],
            depth: [a[2], b[2] - a[2], c[2] - a[2]],
        })
    }

    /// A face as two triangles, which meet along the line between its second and its last corner.
    fn face(&mut self, face: &Face) {
        let Colour(colour) = match self.scale.level(face.value) {
            Some(level) => self.scale.colour(level),
            None => Colour::NO_VALUE,
        };
        let colour = colour.map(|c| f64::from(c) + LIFT * (255.0 - f64::from(c)));
        let [first, second, third, fourth] = &face.corners;
        let way = |from: &[f64; 3], to: &[f64; 3]| [0, 1, 2].map(|k| to[k] - from[k]);
        let across = cross(&way(first, third), &way(second, fourth));
        // The insides of the far walls are seen through cracks.
        let is_back = dot(&across, &face.normal) * dot(&across, &self.projection.eye) < 0.0;
        let light = if is_back {
            BACK
        } else {
            self.projection.light(&face.normal, face.open)
        };
        for half in [[first, second, fourth], [third, fourth, second]] {
            if let Some(placed) = self.placed(half) {
                self.half(&placed, colour, light);
            }
        }
    }

    fn half(&mut self, placed: &Placed, colour: [f64; 3], light: f64) {
        let [length_a, length_b] = placed.heights();
        let room = ((length_a.min(length_b) - LEAST_SIDE) / LEAST_SIDE).clamp(0.0, 1.0);
        // Half a sample larger than it is, so that neighbours leave no seam.
        let (da, db) = (0.5 / length_a.max(1e-9), 0.5 / length_b.max(1e-9));
        placed.fill(
            self.width,
            self.height,
            [da, db],
            true,
            |place, a, b, depth| {
                if depth <= self.depth[place] {
                    return;
                }
                let edge = (a * length_a).min(b * length_b);
                let line = (1.0 - (edge - 0.6) / 2.0).clamp(0.0, 1.0);
                let light = light * (1.0 - LINE * line * room);
                self.depth[place] = depth;
                self.rgb[place] = colour.map(|c| (light * c).round().min(255.0) as u8);
            },
        );
    }

    fn body(&mut self, corners: &[[f64; 3]; 3]) {
        let [a, b, c] = corners;
        let Some(placed) = self.placed([a, b, c]) else {
            return;
        };
        let side = |to: &[f64; 3]| [0, 1, 2].map(|k| to[k] - a[k]);
        let (u, v) = (side(b), side(c));
        let normal = cross(&u, &v);
        let length = dot(&normal, &normal).sqrt().max(f64::MIN_POSITIVE);
        let sense = dot(&self.projection.eye, &normal).signum() / length;
        let light = self.projection.light(&normal.map(|n| sense * n), 0.5);
        let Colour(grey) = GREY;
        placed.fill(
            self.width,
            self.height,
            [0.0; 2],
            true,
            |place, _, _, depth| {
                if depth <= self.depth[place] {
                    return;
                }
                // Over the white ground a body is as dense as over the soil.
                if self.depth[place] == f32::NEG_INFINITY {
                    self.depth[place] = f32::MIN;
                }
                for (tone, grey) in self.rgb[place].iter_mut().zip(grey) {
                    let mixed =
                        OPACITY * light * f64::from(grey) + (1.0 - OPACITY) * f64::from(*tone);
                    *tone = mixed.round().min(255.0) as u8;
                }
            },
        );
    }

    /// The mean of the samples of every pixel.
    fn image(&self) -> Result<Image, FigureError> {
        let (width, height) = (self.width / FINE, self.height / FINE);
        let mut rgba = Vec::with_capacity(4 * width * height);
        for y in 0..height {
            for x in 0..width {
                let samples = (0..FINE * FINE)
                    .map(|k| (FINE * y + k / FINE) * self.width + FINE * x + k % FINE)
                    .filter(|&place| self.depth[place] > f32::NEG_INFINITY);
                let (mut sum, mut count) = ([0_usize; 3], 0);
                for place in samples {
                    count += 1;
                    for (sum, tone) in sum.iter_mut().zip(self.rgb[place]) {
                        *sum += usize::from(tone);
                    }
                }
                rgba.extend(sum.map(|sum| (sum / count.max(1)) as u8));
                rgba.push((255 * count / (FINE * FINE)) as u8);
            }
        }
        let size = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
        let (width, height) = (size(width), size(height));
        if width == 0 || height == 0 {
            return Err(FigureError::TooLarge { width, height });
        }
        Ok(Image {
            area: self.projection.area,
            width,
            height,
            rgba,
        })
    }
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

impl Placed {
    fn cross(&self) -> f64 {
        self.sides[0][0] * self.sides[1][1] - self.sides[0][1] * self.sides[1][0]
    }

    /// How far apart opposite sides are \[samples\]: those at the ends of the first, and of the second.
    fn heights(&self) -> [f64; 2] {
        let [one, two] = self.sides.map(|side| side[0].hypot(side[1]));
        let cross = self.cross().abs();
        [cross / two.max(1e-9), cross / one.max(1e-9)]
    }

    /// Calls for every sample within, with its place, its shares of both sides and its depth; of a triangle
    /// only up to the line between the ends of the sides. Sides are longer by the shares `more` at either end.
    fn fill(
        &self,
        width: usize,
        height: usize,
        more: [f64; 2],
        is_triangle: bool,
        mut call: impl FnMut(usize, f64, f64, f32),
    ) {
        let cross = self.cross();
        if cross.abs() < 1e-9 {
            return;
        }
        let [u, v] = self.sides;
        let range = |axis: usize, most: usize| {
            let ends = [0.0, u[axis], v[axis], u[axis] + v[axis]];
            let low = ends.iter().fold(f64::MAX, |a, &b| a.min(b)) + self.at[axis] - 1.0;
            let high = ends.iter().fold(f64::MIN, |a, &b| a.max(b)) + self.at[axis] + 1.0;
            // Casts take negative numbers to zero.
            (low.floor() as usize).min(most)..(high.ceil() as usize).min(most)
        };
        let inside = |share: f64, more: f64| share >= -more && share <= 1.0 + more;
        for y in range(1, height) {
            for x in range(0, width) {
                let [dx, dy] = [x as f64 + 0.5 - self.at[0], y as f64 + 0.5 - self.at[1]];
                let a = (dx * v[1] - dy * v[0]) / cross;
                let b = (u[0] * dy - u[1] * dx) / cross;
                if inside(a, more[0]) && inside(b, more[1]) && (!is_triangle || a + b <= 1.0 + 1e-9)
                {
                    let depth = self.depth[0] + a * self.depth[1] + b * self.depth[2];
                    call(y * width + x, a, b, depth as f32);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::ColourMap;
    use crate::space::view::View;

    fn level(z: f64, value: f64) -> Face {
        Face {
            corners: [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]],
            normal: [0.0, 0.0, 1.0],
            open: 0.5,
            value,
        }
    }

    fn image(faces: &[Face], bodies: &[[[f64; 3]; 3]]) -> Image {
        let view = View {
            turn: 0.0,
            raise: 90.0,
        };
        let extent = [[0.0; 3], [1.0; 3]];
        let projection = Projection::new(view, extent, [20.0, 20.0], [0.0, 0.0]);
        let scale = ColourScale::new(ColourMap::Sequential, Some((0.0, 1.0)), &[]);
        Painter::new(&projection, &scale)
            .paint(faces, bodies)
            .unwrap()
    }

    fn middle(image: &Image) -> [u8; 4] {
        let place = (image.height / 2 * image.width + image.width / 2) as usize;
        *image.rgba[4 * place..].first_chunk().unwrap()
    }

    /// GOAL: what is nearer hides what is farther, in whatever order they come.
    #[test]
    fn the_nearer_face_is_seen() {
        let (below, above) = (level(0.0, 0.0), level(1.0, 1.0));
        let only = middle(&image(&[above], &[]));
        assert!(only[0] > 200 && only[2] < 90 && only[3] == 255, "{only:?}");
        assert_eq!(middle(&image(&[below, above], &[])), only);
        assert_eq!(middle(&image(&[above, below], &[])), only);
        assert_eq!(middle(&image(&[], &[]))[3], 0);
    }

    #[test]
    fn hollows_and_insides_are_darker() {
        let red = |face: Face| middle(&image(&[face], &[]))[0];
        let hollow = Face {
            open: 0.1,
            ..level(0.0, 1.0)
        };
        let inside = Face {
            normal: [0.0, 0.0, -1.0],
            ..level(0.0, 1.0)
        };
        assert!(red(inside) < red(hollow) && red(hollow) < red(level(0.0, 1.0)));
        let none = middle(&image(&[level(0.0, f64::NAN)], &[]));
        assert!(none[0] == none[1] && none[1] == none[2], "{none:?}");
    }

    #[test]
    fn rigid_bodies_let_the_soil_shine_through() {
        let roof = |z: f64| [[-1.0, -1.0, z], [3.0, -1.0, z], [-1.0, 3.0, z]];
        let soil = level(0.5, 1.0);
        let bare = middle(&image(&[soil], &[]));
        let covered = middle(&image(&[soil], &[roof(1.0)]));
        assert!(covered[0] < bare[0] && covered[2] > bare[2], "{covered:?}");
        assert_eq!(middle(&image(&[soil], &[roof(0.0)])), bare);
    }
}
