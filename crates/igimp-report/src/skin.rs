//! The skin of a body of boxes: which faces of the particles' domains no other domain covers, and how the
//! surface lies there, for pictures in space.
//!
//! The boxes tile the body when it is seeded, and overlap or gape a little when it has deformed. They are
//! sorted into bins once, so that the work grows with their number; each box is looked at by itself, so
//! that threads change nothing.

mod bins;
mod smooth;

use rayon::prelude::*;

use bins::Bins;
pub use smooth::Moves;

/// How far outside a face it is looked for another box, as a share of the half-length across the face:
/// gaps narrower than that are no surface.
const BEYOND: f64 = 0.2;
/// Where on a face it is looked beside its centre, as a share of the half-lengths along it.
const ASIDE: f64 = 0.8;
/// How far around a box the body is felt for the direction of its surface \[widths of the box\].
const AROUND: [f64; 3] = [1.0, 2.0, 3.0];

/// Boxes with sides along the axes, by their least and their largest corners \[m\].
#[derive(Clone, Copy, Debug)]
pub struct Boxes<'a> {
    /// Least corners.
    pub low: &'a [[f64; 3]],
    /// Largest corners.
    pub high: &'a [[f64; 3]],
}

impl Boxes<'_> {
    fn centre(&self, k: usize) -> [f64; 3] {
        [0, 1, 2].map(|axis| 0.5 * (self.low[k][axis] + self.high[k][axis]))
    }

    fn half(&self, k: usize) -> [f64; 3] {
        [0, 1, 2].map(|axis| 0.5 * (self.high[k][axis] - self.low[k][axis]))
    }

    fn is_finite(&self, k: usize) -> bool {
        let numbers = self.low[k].iter().chain(&self.high[k]);
        numbers.into_iter().all(|x| x.is_finite())
    }

    /// A corner of a box: bit k of its number for the upper end along axis k.
    fn corner(&self, k: usize, corner: u8) -> [f64; 3] {
        [0, 1, 2].map(|axis| [self.low, self.high][usize::from(corner >> axis & 1)][k][axis])
    }

    fn least_side(&self, k: usize) -> f64 {
        2.0 * self.half(k).into_iter().fold(f64::INFINITY, f64::min)
    }

    fn holds(&self, k: usize, point: &[f64; 3]) -> bool {
        (0..3).all(|axis| (self.low[k][axis]..=self.high[k][axis]).contains(&point[axis]))
    }
}

/// How the surface lies at a box.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lie {
    /// Out of the body, of length 1; zero where the body gives no direction.
    pub normal: [f64; 3],
    /// Share of the surroundings that is free: about a half on level ground, less in a hollow.
    pub open: f64,
}

/// The faces of every box that are visible from outside.
#[derive(Clone, Debug, Default)]
pub struct Skin {
    /// By box the faces that are seen: bit 2 k + s for the lower (s = 0) or upper (s = 1) face across axis k.
    pub faces: Vec<u8>,
    /// By box how the surface lies there; only where a face is seen.
    pub lie: Vec<Lie>,
    /// By box where its corners lie on the surface without stairs.
    pub moves: Vec<Moves>,
}

impl Skin {
    /// The faces that no other box covers: a face is hidden if the points just outside its centre and close to
    /// its corners lie in other boxes. Boxes that are nowhere have no faces.
    ///
    /// # Panics
    /// If there are not as many least as largest corners.
    pub fn of(boxes: Boxes<'_>, edges: &[Vec<[f64; 3]>]) -> Self {
        let bins = Bins::of(boxes);
        let count = boxes.low.len();
        let seen = |k: usize| {
            if !boxes.is_finite(k) {
                return (0, Lie::default());
            }
            let faces = faces(boxes, &bins, k);
            let lie = if faces == 0 {
                Lie::default()
            } else {
                lie(boxes, &bins, k)
            };
            (faces, lie)
        };
        let (faces, lie): (Vec<u8>, Vec<Lie>) = (0..count).into_par_iter().map(seen).unzip();
        let moves = smooth::moves(boxes, &faces, edges);
        Self { faces, lie, moves }
    }

    /// The corners of a face of a box in turn, on the surface without stairs \[m\].
    pub fn corners(&self, boxes: Boxes<'_>, k: usize, face: usize) -> [[f64; 3]; 4] {
        smooth::corners_of(face).map(|corner| self.corner(boxes, k, corner))
    }

    /// A corner of a box on the surface without stairs: bit k of its number for the upper end along axis k.
    pub fn corner(&self, boxes: Boxes<'_>, k: usize, corner: u8) -> [f64; 3] {
        let (at, moved) = (boxes.corner(k, corner), self.moves[k][usize::from(corner)]);
        let half = boxes.half(k);
        [0, 1, 2].map(|axis| at[axis] + f64::from(moved[axis]) / 127.0 * 2.0 * half[axis])
    }

    /// The corners in turn of the section of a box by a plane across an axis that crosses it.
    pub fn section(&self, boxes: Boxes<'_>, k: usize, axis: usize, at: f64) -> [[f64; 3]; 4] {
        let share = (at - boxes.low[k][axis]) / (2.0 * boxes.half(k)[axis]);
        smooth::corners_of(2 * axis).map(|corner| {
            let ends = [corner, corner | 1 << axis].map(|corner| self.corner(boxes, k, corner));
            let mut point = [0, 1, 2].map(|j| ends[0][j] + share * (ends[1][j] - ends[0][j]));
            point[axis] = at;
            point
        })
    }

    /// Number of faces that are seen.
    pub fn count(&self) -> usize {
        let counts = self.faces.iter().map(|faces| faces.count_ones() as usize);
        counts.sum()
    }
}

fn faces(boxes: Boxes<'_>, bins: &Bins<'_>, k: usize) -> u8 {
    let (centre, half) = (boxes.centre(k), boxes.half(k));
    let mut faces = 0;
    for face in 0..6 {
        let (axis, side) = (face / 2, [-1.0, 1.0][face % 2]);
        let mut middle = centre;
        middle[axis] += side * (1.0 + BEYOND) * half[axis];
        let moved = |aside: [f64; 2]| {
            let mut point = middle;
            for (j, share) in aside.iter().enumerate() {
                let along = (axis + 1 + j) % 3;
                point[along] += ASIDE * share * half[along];
            }
            point
        };
        let ends = [moved([-1.0, -1.0]), moved([1.0, 1.0])];
        let beside = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]];
        // Mostly there is one box that covers all of it.
        let is_hidden = bins.is_within_one(&ends, &middle, k)
            || bins.is_covered(&middle, k)
                && beside.iter().all(|&at| bins.is_covered(&moved(at), k));
        if !is_hidden {
            faces |= 1 << face;
        }
    }
    faces
}

fn lie(boxes: Boxes<'_>, bins: &Bins<'_>, k: usize) -> Lie {
    let (centre, half) = (boxes.centre(k), boxes.half(k));
    let mut outwards = [0.0; 3];
    let (mut free, mut all) = (0.0, 0.0);
    for towards in directions() {
        let length = towards.iter().map(|t| t * t).sum::<f64>().sqrt();
        for distance in AROUND {
            let weight = 1.0 / distance;
            let at = [0, 1, 2]
                .map(|axis| centre[axis] + 2.0 * distance * half[axis] * towards[axis] / length);
            all += weight;
            if !bins.is_covered(&at, k) {
                free += weight;
                for axis in 0..3 {
                    outwards[axis] += weight * towards[axis] / length;
                }
            }
        }
    }
    let length = outwards.iter().map(|n| n * n).sum::<f64>().sqrt();
    Lie {
        // The rest of sums that cancel has no direction.
        normal: outwards.map(|n| if length > 1e-3 * all { n / length } else { 0.0 }),
        open: free / all,
    }
}

/// From a box to the 26 around it.
fn directions() -> impl Iterator<Item = [f64; 3]> {
    let step = |k: usize| [-1.0, 0.0, 1.0][k % 3];
    (0..27)
        .filter(|&k| k != 13)
        .map(move |k| [step(k), step(k / 3), step(k / 9)])
}

#[cfg(test)]
mod tests;
