//! The part of a solid above a rectangle in plan, cut once for all boxes that lie one above the other.
//!
//! Every face is clipped to the rectangle. A box asks the faces that pass its levels one by one; those above it fill
//! the height of the box with what they cover in plan (theory, eq. 44a), which is summed beforehand.

use super::facets::{Face, Moments};
use crate::region::{Column, Cover, Part};

/// A share of the rectangle that is round-off \[-\].
const ROUND_OFF: f64 = 1e-9;

/// Faces over a rectangle in plan.
#[derive(Clone, Debug)]
pub(super) struct Standing {
    /// The corner of the rectangle from which the faces are seen, with the level 0.
    origin: [f64; 3],
    size: [f64; 2],
    /// By ascending lowest corner.
    faces: Vec<Seen>,
    /// The area in plan that the faces from each one on cover, as a prism of height 1; empty at the end.
    above: Vec<Moments>,
}

/// A face with the sense in which it counts, and its lowest and highest level.
#[derive(Clone, Debug)]
struct Seen {
    face: Face,
    sign: f64,
    levels: [f64; 2],
}

impl Standing {
    /// Of what `each` calls with: faces within the rectangle, seen from its corner `origin`, and their sense.
    pub(super) fn new(
        origin: [f64; 3],
        size: [f64; 2],
        each: impl FnOnce(&mut dyn FnMut(&Face, f64)),
    ) -> Self {
        let mut faces = Vec::new();
        each(&mut |face, sign| {
            let levels = face.extent(2);
            faces.push(Seen {
                face: *face,
                sign,
                levels,
            });
        });
        faces.sort_by(|a, b| a.levels[0].total_cmp(&b.levels[0]));
        let mut above = vec![Moments::default(); faces.len() + 1];
        for (k, seen) in faces.iter().enumerate().rev() {
            above[k] = above[k + 1];
            above[k].add_prism(&seen.face, 1.0, seen.sign);
        }
        Self {
            origin,
            size,
            faces,
            above,
        }
    }

    /// The faces that pass between two levels, and how many are not above them.
    fn passing(&self, [from, to]: [f64; 2]) -> (impl Iterator<Item = &Seen>, usize) {
        let below = self.faces.partition_point(|seen| seen.levels[0] < to);
        let passing = self.faces[..below].iter();
        (passing.filter(move |seen| seen.levels[1] > from), below)
    }
}

impl Column<3> for Standing {
    fn within(&self, ends: [f64; 2]) -> Part<3> {
        let [from, to] = ends.map(|end| end - self.origin[2]);
        let height = to - from;
        let (passing, below) = self.passing([from, to]);
        let mut moments = self.above[below].of_height(height);
        for seen in passing {
            moments.add_under(&seen.face.lowered(from), height, seen.sign);
        }
        let [x, y, _] = self.origin;
        let upper = [x + self.size[0], y + self.size[1], ends[1]];
        moments.part([x, y, ends[0]], upper)
    }

    fn cover(&self, ends: [f64; 2]) -> Cover {
        let (mut passing, below) = self.passing(ends.map(|end| end - self.origin[2]));
        let share = self.above[below].volume / (self.size[0] * self.size[1]);
        if passing.next().is_some() {
            Cover::Cut
        } else if share.abs() < ROUND_OFF {
            Cover::Nothing
        } else if (share - 1.0).abs() < ROUND_OFF {
            Cover::Whole
        } else {
            Cover::Cut
        }
    }
}
