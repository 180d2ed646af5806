//! A solid from which others are cut out.

use super::{Solid, common};
use crate::region::{Cover, Crossing, Part, Region};

/// Where boundaries of several solids run through one box, it is cut so many times into eight.
const DEPTH: u32 = 4;
/// The same for the volume of all that is left.
const FINEST: u32 = 6;
/// Less than this share of a box is round-off \[-\].
const ROUND_OFF: f64 = 1e-14;

/// A solid without others.
///
/// The remainder within a box is exact where one boundary runs through the box, and where all but one are those of
/// boxes. Elsewhere the box is cut into 16³, and the solids are taken to be spread evenly in those of
/// them that several boundaries still cross: the error is below a thousandth of the box.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The solid that is cut.
    pub of: Box<Solid>,
    /// The solids that are cut out of it.
    pub minus: Vec<Solid>,
}

impl Difference {
    fn left(&self, lower: [f64; 3], upper: [f64; 3], depth: u32) -> Part<3> {
        let (mut corners, mut cut) = ((lower, upper), Vec::new());
        let of = self.of.cover(lower, upper);
        if of == Cover::Nothing {
            return Part::NOTHING;
        }
        for solid in &self.minus {
            match solid.cover(lower, upper) {
                Cover::Nothing => {}
                Cover::Whole => return Part::NOTHING,
                Cover::Cut => cut.push(solid),
            }
        }
        let mut is_whole = of == Cover::Whole;
        if let Solid::Cuboid(from, to) = &*self.of {
            let Some(overlap) = common((*from, *to), corners) else {
                return Part::NOTHING;
            };
            (corners, is_whole) = (overlap, true);
        }
        let (lower, upper) = corners;
        let base = |lower, upper| {
            if is_whole {
                Part::whole(lower, upper)
            } else {
                self.of.within(lower, upper)
            }
        };
        match cut[..] {
            [] => base(lower, upper),
            [Solid::Cuboid(from, to)] => match common((*from, *to), corners) {
                Some((from, to)) => less(base(lower, upper), base(from, to)),
                None => base(lower, upper),
            },
            [solid] if is_whole => less(Part::whole(lower, upper), solid.within(lower, upper)),
            _ if depth > 0 => {
                sum(eighths(lower, upper).map(|(from, to)| self.left(from, to, depth - 1)))
            }
            _ => {
                let mut left = base(lower, upper);
                let whole = Part::whole(lower, upper).volume;
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

fn sum(parts: impl Iterator<Item = Part<3>>) -> Part<3> {
    let (mut volume, mut moment) = (0.0, [0.0; 3]);
    for part in parts {
        volume += part.volume;
        for axis in 0..3 {
            moment[axis] += part.volume * part.centroid[axis];
        }
    }
    if volume <= 0.0 {
        return Part::NOTHING;
    }
    Part {
        volume,
        centroid: moment.map(|moment| moment / volume),
    }
}

/// A part without a part of it.
fn less(whole: Part<3>, out: Part<3>) -> Part<3> {
    let volume = whole.volume - out.volume;
    if volume <= ROUND_OFF * whole.volume {
        return Part::NOTHING;
    }
    let moved = |axis: usize| out.volume / volume * (whole.centroid[axis] - out.centroid[axis]);
    Part {
        volume,
        centroid: std::array::from_fn(|axis| whole.centroid[axis] + moved(axis)),
    }
}

impl Region<3> for Difference {
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        self.of.bounds()
    }

    fn within(&self, lower: [f64; 3], upper: [f64; 3]) -> Part<3> {
        self.left(lower, upper, DEPTH)
    }

    fn volume(&self) -> f64 {
        let (lower, upper) = self.bounds();
        self.left(lower, upper, FINEST).volume
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

    fn encloses(&self, point: [f64; 3]) -> bool {
        self.of.encloses(point) && !self.minus.iter().any(|solid| solid.encloses(point))
    }

    fn crossings(&self, place: &[f64; 3]) -> Vec<Crossing> {
        let all = std::iter::once(&*self.of).chain(&self.minus);
        let mut levels: Vec<f64> = all
            .flat_map(|solid| solid.crossings(place))
            .map(|crossing| crossing.level)
            .collect();
        levels.sort_by(f64::total_cmp);
        let stretches = levels.windows(2).filter(|pair| {
            let middle = [place[0], place[1], 0.5 * (pair[0] + pair[1])];
            pair[0] < pair[1] && self.encloses(middle)
        });
        stretches
            .flat_map(|pair| Crossing::ends([pair[0], pair[1]]))
            .collect()
    }

    fn corners(&self) -> Vec<[f64; 3]> {
        let all = std::iter::once(&*self.of).chain(&self.minus);
        all.flat_map(Region::corners).collect()
    }

    fn words(&self) -> String {
        let minus: Vec<String> = self.minus.iter().map(Region::words).collect();
        format!("{} less {}", self.of.words(), minus.join(" less "))
    }
}
