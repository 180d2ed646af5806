//! The skin without stairs: corners of faces that meet are one place, and places move to the mean of those beside them.
//!
//! Edges stay edges. A place at the end of the body along an axis keeps to those there, and one near an edge of the bodies as
//! they are drawn moves onto it. No corner leaves its box by more than three quarters of a side.

use std::collections::{HashMap, HashSet};

use rayon::prelude::*;

use super::Boxes;

/// Corners of different boxes are one place within this share of the least side.
const SAME: f64 = 0.35;
/// A place this near to an edge lies on it, as a share of the least side.
const ON_EDGE: f64 = 0.6;
/// Places at an end of the body along an axis lie within this share of a side of it.
const AT_END: f64 = 0.1;
/// How often places move towards the mean of their neighbours, and by which share: stairs of 1:1 to 1:4 are gone.
const TIMES: usize = 8;
const SHARE: f64 = 0.5;
/// Boxes without a face have corners of the skin only where their centre is this near to one \[least sides\].
const CLOSE: f64 = 3.0;
/// A corner leaves its box by no more than this share of its sides.
const FURTHEST: f64 = 0.75;

type Point = [f64; 3];

/// Where the corners of a box lie from those of the box, as shares of its sides in steps of 1/127: by corner, whose number has
/// bit k for the upper end along axis k.
pub type Moves = [[i8; 3]; 8];

/// A corner of faces that meet.
struct Place {
    at: Point,
    /// How many corners it is the mean of.
    corners: f64,
    /// Least side of the first box there \[m\].
    side: f64,
    /// Bit 2 k + s: whether it lies at the lower (s = 0) or upper end of the body along axis k.
    ends: u8,
    /// Bits of the axes across the faces that meet there.
    across: u8,
    /// Whether it lies on an edge.
    is_held: bool,
}

/// The places of a skin, by bins for those near a point.
struct Places {
    all: Vec<Place>,
    width: f64,
    bins: HashMap<[i64; 3], Vec<u32>>,
    /// By box and corner the place, where a face is seen.
    of_corner: HashMap<(u32, u8), u32>,
    /// Places that share an edge of a face.
    pairs: Vec<[u32; 2]>,
}

/// The moves of the corners of all boxes at the skin; `edges` are lines along edges of the bodies.
pub(super) fn moves(boxes: Boxes<'_>, faces: &[u8], edges: &[Vec<Point>]) -> Vec<Moves> {
    let seen: Vec<usize> = (0..faces.len()).filter(|&k| faces[k] != 0).collect();
    if seen.is_empty() {
        return vec![Moves::default(); faces.len()];
    }
    let mut places = Places::of(boxes, faces, &seen);
    let before: Vec<Point> = places.all.iter().map(|place| place.at).collect();
    places.hold(edges);
    for _ in 0..TIMES {
        places.move_to_means();
    }
    let close = places.close();
    // A box behind the skin may have a corner on it, where its neighbours on either side have theirs.
    let of_box = |k: usize| -> Moves {
        if faces[k] == 0
            && !(boxes.is_finite(k) && close.contains(&places.wide_bin(&boxes.centre(k))))
        {
            return Moves::default();
        }
        std::array::from_fn(|corner| {
            let corner = corner as u8;
            let found = places.of_corner.get(&(k as u32, corner)).copied();
            let x = boxes.corner(k, corner);
            let place = found.or_else(|| places.nearest(&before, x, SAME * boxes.least_side(k)));
            let Some(place) = place else {
                return [0; 3];
            };
            let at = places.all[place as usize].at;
            [0, 1, 2].map(|axis| {
                let share = (at[axis] - x[axis]) / (boxes.high[k][axis] - boxes.low[k][axis]);
                (127.0 * share.clamp(-FURTHEST, FURTHEST)).round() as i8
            })
        })
    };
    (0..faces.len()).into_par_iter().map(of_box).collect()
}

/// The corners of a face in turn, by their numbers.
pub(super) fn corners_of(face: usize) -> [u8; 4] {
    let axis = face / 2;
    let [one, two] = [1, 2].map(|k| 1 << ((axis + k) % 3));
    let first = ((face % 2) as u8) << axis;
    [first, first | one, first | one | two, first | two]
}

impl Places {
    fn of(boxes: Boxes<'_>, faces: &[u8], seen: &[usize]) -> Self {
        let mut sides: Vec<f64> = seen.iter().map(|&k| boxes.least_side(k)).collect();
        let middle = sides.len() / 2;
        let width = *sides.select_nth_unstable_by(middle, f64::total_cmp).1;
        let mut places = Self {
            all: Vec::new(),
            width: width.max(f64::MIN_POSITIVE),
            bins: HashMap::new(),
            of_corner: HashMap::new(),
            pairs: Vec::new(),
        };
        for &k in seen {
            for face in (0..6).filter(|face| faces[k] & (1 << face) != 0) {
                let ring = corners_of(face).map(|corner| places.corner(boxes, k, corner));
                for (j, &place) in ring.iter().enumerate() {
                    places.all[place as usize].across |= 1 << (face / 2);
                    places.pairs.push([place, ring[(j + 1) % 4]]);
                }
            }
        }
        places.find_ends();
        places
    }

    fn bin(&self, at: &Point) -> [i64; 3] {
        at.map(|x| (x / self.width).floor() as i64)
    }

    /// Places in the bins that a box around a point reaches into.
    fn near(&self, low: &Point, high: &Point) -> Vec<u32> {
        let (low, high) = (self.bin(low), self.bin(high));
        let mut found = Vec::new();
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    found.extend(self.bins.get(&[x, y, z]).into_iter().flatten());
                }
            }
        }
        found
    }

    /// The place of a corner: one that is there, or a new one.
    fn corner(&mut self, boxes: Boxes<'_>, k: usize, corner: u8) -> u32 {
        if let Some(&place) = self.of_corner.get(&(k as u32, corner)) {
            return place;
        }
        let (at, side) = (boxes.corner(k, corner), boxes.least_side(k));
        let reach = SAME * side;
        let near = self.near(&at.map(|x| x - reach), &at.map(|x| x + reach));
        let off = |place: &u32| distance(self.all[*place as usize].at, at);
        let near = near.into_iter().filter(|place| off(place) <= reach);
        let nearest = near.min_by(|a, b| off(a).total_cmp(&off(b)));
        let place = nearest.unwrap_or_else(|| self.begin(at, side));
        let spot = &mut self.all[place as usize];
        spot.corners += 1.0;
        // It stays in its bin, or close to it.
        spot.at = [0, 1, 2].map(|axis| spot.at[axis] + (at[axis] - spot.at[axis]) / spot.corners);
        self.of_corner.insert((k as u32, corner), place);
        place
    }

    /// The place that was nearest to a point before places moved, within a reach.
    fn nearest(&self, before: &[Point], at: Point, reach: f64) -> Option<u32> {
        let near = self.near(&at.map(|x| x - reach), &at.map(|x| x + reach));
        let off = |place: &u32| distance(before[*place as usize], at);
        let near = near.into_iter().filter(|place| off(place) <= reach);
        near.min_by(|a, b| off(a).total_cmp(&off(b)))
    }

    fn wide_bin(&self, at: &Point) -> [i64; 3] {
        at.map(|x| (x / (2.0 * CLOSE * self.width)).floor() as i64)
    }

    /// The wide bins close to any place.
    fn close(&self) -> HashSet<[i64; 3]> {
        let beside = (0..8).map(|corner| [0, 1, 2].map(|k| [-1.0, 1.0][corner >> k & 1]));
        let around = |place: &Place| {
            let reach = CLOSE * self.width;
            let at = place.at;
            beside
                .clone()
                .map(move |side| [0, 1, 2].map(|k: usize| at[k] + reach * side[k]))
        };
        let points = self.all.iter().flat_map(around);
        points.map(|point| self.wide_bin(&point)).collect()
    }

    fn begin(&mut self, at: Point, side: f64) -> u32 {
        let number = self.all.len() as u32;
        self.bins.entry(self.bin(&at)).or_default().push(number);
        self.all.push(Place {
            at,
            corners: 0.0,
            side,
            ends: 0,
            across: 0,
            is_held: false,
        });
        number
    }

    fn find_ends(&mut self) {
        for axis in 0..3 {
            let ends = self.all.iter().fold([f64::MAX, f64::MIN], |[a, b], place| {
                [a.min(place.at[axis]), b.max(place.at[axis])]
            });
            for place in &mut self.all {
                for (s, end) in ends.into_iter().enumerate() {
                    let is_there = (place.at[axis] - end).abs() <= AT_END * place.side;
                    place.ends |= u8::from(is_there) << (2 * axis + s);
                }
            }
        }
    }

    /// Moves places near edges onto them, and holds them there.
    fn hold(&mut self, edges: &[Vec<Point>]) {
        let mut nearest: HashMap<u32, (f64, Point)> = HashMap::new();
        for ends in edges.iter().flat_map(|line| line.windows(2)) {
            let end = |pick: fn(f64, f64) -> f64, more: f64| {
                [0, 1, 2].map(|k| pick(ends[0][k], ends[1][k]) + more * ON_EDGE * self.width)
            };
            for place in self.near(&end(f64::min, -1.0), &end(f64::max, 1.0)) {
                let spot = &self.all[place as usize];
                let foot = foot(ends[0], ends[1], spot.at);
                let off = distance(foot, spot.at);
                let least = nearest
                    .get(&place)
                    .map_or(ON_EDGE * spot.side, |best| best.0);
                if off <= least {
                    nearest.insert(place, (off, foot));
                }
            }
        }
        for (place, (_, foot)) in nearest {
            let spot = &mut self.all[place as usize];
            (spot.at, spot.is_held) = (foot, true);
        }
    }

    /// Whether a place lies within a side of the body: at an end of it, and no face leads off.
    fn is_within_side(&self, place: u32) -> bool {
        let Place { ends, across, .. } = self.all[place as usize];
        ends != 0 && across.is_power_of_two()
    }

    fn move_to_means(&mut self) {
        let mut sums = vec![([0.0; 3], 0.0); self.all.len()];
        for &[a, b] in &self.pairs {
            for [one, other] in [[a, b], [b, a]] {
                let ends = self.all[one as usize].ends;
                let other_ends = self.all[other as usize].ends;
                if ends & !other_ends == 0 && (ends == 0 || !self.is_within_side(other)) {
                    let (sum, count) = &mut sums[one as usize];
                    for axis in 0..3 {
                        sum[axis] += self.all[other as usize].at[axis];
                    }
                    *count += 1.0;
                }
            }
        }
        for (number, (sum, count)) in sums.into_iter().enumerate() {
            let moves = count > 0.0 && !self.is_within_side(number as u32);
            let Place { at, is_held, .. } = &mut self.all[number];
            if moves && !*is_held {
                *at = [0, 1, 2].map(|axis| at[axis] + SHARE * (sum[axis] / count - at[axis]));
            }
        }
    }
}

/// The place of a segment that is nearest to a point.
fn foot(from: Point, to: Point, at: Point) -> Point {
    let way = [0, 1, 2].map(|k| to[k] - from[k]);
    let along: f64 = (0..3).map(|k| way[k] * (at[k] - from[k])).sum();
    let length: f64 = way.iter().map(|x| x * x).sum();
    let share = (along / length.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    [0, 1, 2].map(|k| from[k] + share * way[k])
}

fn distance(a: Point, b: Point) -> f64 {
    (0..3).fold(0.0_f64, |sum, k| sum.hypot(a[k] - b[k]))
}
