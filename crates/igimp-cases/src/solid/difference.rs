//! What is left of a solid when others are taken out.

use super::{Shape, Solid, common, ends};
use crate::case::{Cover, Crossing, Region, Within};

/// Where boundaries of several solids run through one box, it is cut so many times into eight.
const DEPTH: u32 = 4;
/// The same for the volume of all of it.
const FINEST: u32 = 6;
/// Less than this share of a box is round-off \[-\].
const ROUND_OFF: f64 = 1e-14;

/// A solid without others.
#[derive(Clone, Debug)]
pub(super) struct Difference {
    /// What is cut.
    pub(super) of: Solid,
    /// What is taken out of it.
    pub(super) minus: Vec<Solid>,
}

impl Difference {
    fn left(&self, lower: [f64; 3], upper: [f64; 3], depth: u32) -> Within<3> {
        let (mut corners, mut cut) = ((lower, upper), Vec::new());
        let of = self.of.cover(lower, upper);
        if of == Cover::Nothing {
            return Within::NOTHING;
        }
        for solid in &self.minus {
            match solid.cover(lower, upper) {
                Cover::Nothing => {}
                Cover::Whole => return Within::NOTHING,
                Cover::Cut => cut.push(solid),
            }
        }
        let mut is_whole = of == Cover::Whole;
        if let Some(of) = self.of.shape.as_cuboid() {
            let Some(own) = common(of, corners) else {
                return Within::NOTHING;
            };
            (corners, is_whole) = (own, true);
        }
        let (lower, upper) = corners;
        let own = |lower, upper| {
            if is_whole {
                Within::whole(lower, upper)
            } else {
                self.of.within(lower, upper)
            }
        };
        match cut[..] {
            [] => own(lower, upper),
            [solid] if let Some(out) = solid.shape.as_cuboid() => match common(out, corners) {
                Some((from, to)) => less(own(lower, upper), own(from, to)),
                None => own(lower, upper),
            },
            [solid] if is_whole => less(Within::whole(lower, upper), solid.within(lower, upper)),
            _ if depth > 0 => {
                sum(eighths(lower, upper).map(|(from, to)| self.left(from, to, depth - 1)))
            }
            _ => {
                let mut left = own(lower, upper);
                let whole = Within::whole(lower, upper).volume;
                for solid in cut {
                    left.volume *= 1.0 - solid.within(lower, upper).volume / whole;
                }
                left
            }
        }
    }
}

/// The eighths of a box.
fn eighths(lower: [f64; 3], upper: [f64; 3]) -> impl Iterator<Item = ([f64; 3], [f64; 3])> {
    let middle: [f64; 3] = std::array::from_fn(|axis| 0.5 * (lower[axis] + upper[axis]));
    (0..8).map(move |eighth| {
        let is_upper = |axis: usize| eighth >> axis & 1 == 1;
        let end = |axis: usize, low: [f64; 3], high: [f64; 3]| {
            if is_upper(axis) {
                high[axis]
            } else {
                low[axis]
            }
        };
        (
            std::array::from_fn(|axis| end(axis, lower, middle)),
            std::array::from_fn(|axis| end(axis, middle, upper)),
        )
    })
}

fn sum(parts: impl Iterator<Item = Within<3>>) -> Within<3> {
    let (mut volume, mut moment) = (0.0, [0.0; 3]);
    for part in parts {
        volume += part.volume;
        for axis in 0..3 {
            moment[axis] += part.volume * part.centroid[axis];
        }
    }
    if volume <= 0.0 {
        return Within::NOTHING;
    }
    Within {
        volume,
        centroid: moment.map(|moment| moment / volume),
    }
}

/// A part without a part of it.
fn less(whole: Within<3>, out: Within<3>) -> Within<3> {
    let volume = whole.volume - out.volume;
    if volume <= ROUND_OFF * whole.volume {
        return Within::NOTHING;
    }
    let moved = |axis: usize| out.volume / volume * (whole.centroid[axis] - out.centroid[axis]);
    Within {
        volume,
        centroid: std::array::from_fn(|axis| whole.centroid[axis] + moved(axis)),
    }
}

impl Shape for Difference {
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        self.of.bounds()
    }

    fn within(&self, lower: [f64; 3], upper: [f64; 3]) -> Within<3> {
        self.left(lower, upper, DEPTH)
    }

    fn cover(&self, lower: [f64; 3], upper: [f64; 3]) -> Cover {
        let mut cover = self.of.cover(lower, upper);
        for solid in &self.minus {
            if cover == Cover::Nothing {
                return cover;
            }
            match solid.cover(lower, upper) {
                Cover::Nothing => {}
                Cover::Whole => return Cover::Nothing,
                Cover::Cut => cover = Cover::Cut,
            }
        }
        cover
    }

    fn volume(&self) -> f64 {
        let (lower, upper) = self.bounds();
        self.left(lower, upper, FINEST).volume
    }

    fn contains(&self, point: &[f64; 3]) -> bool {
        self.of.contains(point) && !self.minus.iter().any(|solid| solid.contains(point))
    }

    /// Of a solid those outside the others, and inside it those of the others that are outside the rest.
    fn crossings(&self, [x, y]: [f64; 2]) -> Vec<Crossing> {
        let place = [x, y, 0.0];
        let mut left = stretches(self.of.crossings(&place));
        for solid in &self.minus {
            for [bottom, top] in stretches(solid.crossings(&place)) {
                let without =
                    |own: [f64; 2]| [[own[0], own[1].min(bottom)], [own[0].max(top), own[1]]];
                let mut next: Vec<[f64; 2]> = left.into_iter().flat_map(without).collect();
                next.retain(|own| own[0] < own[1]);
                left = next;
            }
        }
        left.into_iter().flat_map(|own| ends(Some(own))).collect()
    }

    fn corners(&self) -> Vec<[f64; 3]> {
        let taken = self.minus.iter().flat_map(|solid| solid.corners());
        self.of.corners().iter().chain(taken).copied().collect()
    }

    fn words(&self) -> String {
        let without: Vec<String> = self.minus.iter().map(Region::words).collect();
        format!("{} without {}", self.of.words(), without.join(", "))
    }
}

/// Bottoms and tops, from crossings in any order.
fn stretches(crossings: Vec<Crossing>) -> Vec<[f64; 2]> {
    let mut levels: Vec<f64> = crossings.into_iter().map(|own| own.level).collect();
    levels.sort_by(f64::total_cmp);
    levels
        .chunks_exact(2)
        .map(|pair| [pair[0], pair[1]])
        .collect()
}
