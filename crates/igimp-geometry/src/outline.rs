//! Plane geometry for the checks of bodies: inside, crossing, overlap, edges that face up.

use crate::polygon::{area_and_centroid, bounding_box, edges};

type Point = [f64; 2];

/// Corners without those that repeat their neighbour.
pub fn distinct(polygon: &[Point], round_off: f64) -> Vec<Point> {
    let near = |a: Point, b: Point| (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) <= round_off;
    let mut corners: Vec<Point> = Vec::with_capacity(polygon.len());
    for &corner in polygon {
        if corners.last().is_none_or(|&last| !near(last, corner)) {
            corners.push(corner);
        }
    }
    while corners.len() > 1 && near(corners[0], corners[corners.len() - 1]) {
        corners.pop();
    }
    corners
}

/// Whether a point lies within a distance of an edge.
pub fn near_edge(polygon: &[Point], point: Point, distance: f64) -> bool {
    edge_distance(polygon, point) <= distance
}

/// Where two segments cross, each well inside the other.
fn crossing(a: (Point, Point), b: (Point, Point), round_off: f64) -> Option<Point> {
    for axis in 0..2 {
        let (low, high) = (a.0[axis].min(a.1[axis]), a.0[axis].max(a.1[axis]));
        if b.0[axis].max(b.1[axis]) < low || b.0[axis].min(b.1[axis]) > high {
            return None;
        }
    }
    // Signed distance of a point from the line of a segment.
    let distance = |(p, q): (Point, Point), x: Point| {
        let along = [q[0] - p[0], q[1] - p[1]];
        let length = along[0].hypot(along[1]);
        (along[0] * (x[1] - p[1]) - along[1] * (x[0] - p[0])) / length
    };
    let apart =
        |x: f64, y: f64| x.abs() > round_off && y.abs() > round_off && (x > 0.0) != (y > 0.0);
    let (from, to) = (distance(a, b.0), distance(a, b.1));
    if !apart(from, to) || !apart(distance(b, a.0), distance(b, a.1)) {
        return None;
    }
    let t = from / (from - to);
    Some([
        b.0[0] + t * (b.1[0] - b.0[0]),
        b.0[1] + t * (b.1[1] - b.0[1]),
    ])
}

/// Where a polygon crosses itself.
pub fn self_crossing(polygon: &[Point], round_off: f64) -> Option<Point> {
    let edges: Vec<_> = edges(polygon).collect();
    for (k, &a) in edges.iter().enumerate() {
        for &b in &edges[k + 1..] {
            if let Some(point) = crossing(a, b, round_off) {
                return Some(point);
            }
        }
    }
    None
}

/// How far a point lies from the nearest edge.
pub fn edge_distance(polygon: &[Point], point: Point) -> f64 {
    let distances = edges(polygon).map(|(p, q)| {
        let along = [q[0] - p[0], q[1] - p[1]];
        let to = [point[0] - p[0], point[1] - p[1]];
        let length2 = along[0] * along[0] + along[1] * along[1];
        let t = if length2 > 0.0 {
            ((to[0] * along[0] + to[1] * along[1]) / length2).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (to[0] - t * along[0]).hypot(to[1] - t * along[1])
    });
    distances.fold(f64::INFINITY, f64::min)
}

/// A point in the overlap of two polygons, if they share more than an edge.
pub fn overlap(a: &[Point], b: &[Point], round_off: f64) -> Option<Point> {
    let ((a_low, a_high), (b_low, b_high)) = (bounding_box(a), bounding_box(b));
    let apart = |axis: usize| {
        a_high[axis] <= b_low[axis] + round_off || b_high[axis] <= a_low[axis] + round_off
    };
    if apart(0) || apart(1) {
        return None;
    }
    for edge in edges(a) {
        if let Some(point) = edges(b).find_map(|other| crossing(edge, other, round_off)) {
            return Some(point);
        }
    }
    // No edges cross: between two levels of corners the overlap is a row of trapezia, whose area
    // is the height times the length half-way up.
    let mut levels: Vec<f64> = a.iter().chain(b).map(|corner| corner[1]).collect();
    levels.sort_by(f64::total_cmp);
    let (mut area, mut widest, mut place) = (0.0, 0.0, None);
    for pair in levels.windows(2) {
        let height = pair[1] - pair[0];
        if height <= round_off {
            continue;
        }
        let y = 0.5 * (pair[0] + pair[1]);
        for [from, to] in shared(&intervals(a, y), &intervals(b, y)) {
            area += height * (to - from);
            if height * (to - from) > widest {
                widest = height * (to - from);
                place = Some([0.5 * (from + to), y]);
            }
        }
    }
    let smaller = area_and_centroid(a)
        .0
        .abs()
        .min(area_and_centroid(b).0.abs());
    place.filter(|_| area > 1e-6 * smaller)
}

/// Where a level line runs inside a polygon.
fn intervals(polygon: &[Point], y: f64) -> Vec<[f64; 2]> {
    let mut xs: Vec<f64> = edges(polygon)
        .filter(|(p, q)| (p[1] > y) != (q[1] > y))
        .map(|(p, q)| p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]))
        .collect();
    xs.sort_by(f64::total_cmp);
    xs.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect()
}

/// Common parts of two ordered rows of intervals.
fn shared(a: &[[f64; 2]], b: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let (mut i, mut j, mut out) = (0, 0, Vec::new());
    while i < a.len() && j < b.len() {
        let (from, to) = (a[i][0].max(b[j][0]), a[i][1].min(b[j][1]));
        if from < to {
            out.push([from, to]);
        }
        if a[i][1] < b[j][1] {
            i += 1;
        } else {
            j += 1;
        }
    }
    out
}

/// A stretch where two polygons face each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facing {
    /// Its ends on the edge of the first polygon.
    pub ends: [Point; 2],
    /// Half-way between the two.
    pub middle: Point,
    /// How far apart they are there; 0 for a shared edge.
    pub distance: f64,
}

/// The stretches where edges of two polygons run side by side, their insides on opposite sides, not
/// further apart than a distance.
pub fn facing(a: &[Point], b: &[Point], most: f64) -> Vec<Facing> {
    let ((a_low, a_high), (b_low, b_high)) = (bounding_box(a), bounding_box(b));
    let apart =
        |axis: usize| a_high[axis] + most < b_low[axis] || b_high[axis] + most < a_low[axis];
    if apart(0) || apart(1) {
        return Vec::new();
    }
    let turn = |polygon: &[Point]| area_and_centroid(polygon).0.signum();
    let is_same_way = turn(a) * turn(b) > 0.0;
    let outwards = turn(a);
    let mut out = Vec::new();
    for (p, q) in edges(a) {
        let along = [q[0] - p[0], q[1] - p[1]];
        let length = along[0].hypot(along[1]);
        let along = [along[0] / length, along[1] / length];
        // Along the edge, and outwards from the first polygon.
        let local = |x: Point| {
            let to = [x[0] - p[0], x[1] - p[1]];
            [
                to[0] * along[0] + to[1] * along[1],
                outwards * (to[0] * along[1] - to[1] * along[0]),
            ]
        };
        for (r, s) in edges(b) {
            let (mut r, mut s) = (local(r), local(s));
            if is_same_way {
                (r, s) = (s, r);
            }
            // Nearly parallel, and the other way round.
            let run = s[0] - r[0];
            if run <= 0.0 || (s[1] - r[1]).abs() > 0.1 * run {
                continue;
            }
            let (from, to) = (r[0].max(0.0), s[0].min(length));
            if to - from <= 1e-6 * length {
                continue;
            }
            let t = 0.5 * (from + to);
            let distance = r[1] + (t - r[0]) / run * (s[1] - r[1]);
            if distance.abs() > most {
                continue;
            }
            let at = |t: f64, off: f64| {
                [
                    p[0] + t * along[0] + off * outwards * along[1],
                    p[1] + t * along[1] - off * outwards * along[0],
                ]
            };
            out.push(Facing {
                ends: [at(from, 0.0), at(to, 0.0)],
                middle: at(t, 0.5 * distance),
                distance: distance.abs(),
            });
        }
    }
    out
}

/// The longest stretch of a polygon along an axis.
pub fn largest_run(polygon: &[Point], axis: usize) -> [f64; 2] {
    let turned: Vec<Point> = if axis == 0 {
        polygon.to_vec()
    } else {
        polygon.iter().map(|x| [x[1], x[0]]).collect()
    };
    let mut levels: Vec<f64> = turned.iter().map(|corner| corner[1]).collect();
    levels.sort_by(f64::total_cmp);
    // Lengths are linear between corners: they are longest beside one.
    let beside = levels.windows(2).flat_map(|pair| {
        let off = 1e-6 * (pair[1] - pair[0]);
        [pair[0] + off, pair[1] - off]
    });
    beside
        .flat_map(|y| intervals(&turned, y))
        .max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))
        .unwrap_or_else(|| {
            let (lower, upper) = bounding_box(polygon);
            [lower[axis], upper[axis]]
        })
}

/// Edges of a polygon that have its inside below them: left end, right end.
pub fn top_edges(polygon: &[Point]) -> Vec<[Point; 2]> {
    let is_counter_clockwise = area_and_centroid(polygon).0 > 0.0;
    edges(polygon)
        .filter_map(|(p, q)| {
            let (p, q) = if is_counter_clockwise { (q, p) } else { (p, q) };
            (p[0] < q[0]).then_some([p, q])
        })
        .collect()
}

/// Whether intervals together cover a range.
pub fn cover(intervals: &mut [[f64; 2]], from: f64, to: f64, round_off: f64) -> bool {
    intervals.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut reached = from;
    for interval in intervals.iter() {
        if interval[0] > reached + round_off {
            break;
        }
        reached = reached.max(interval[1]);
    }
    reached >= to - round_off
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [Point; 4] = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];

    fn moved(polygon: &[Point], by: Point) -> Vec<Point> {
        polygon
            .iter()
            .map(|p| [p[0] + by[0], p[1] + by[1]])
            .collect()
    }

    #[test]
    fn the_nearest_edge_counts() {
        assert!((edge_distance(&SQUARE, [0.5, 1.0]) - 0.5).abs() < 1e-12);
        assert!((edge_distance(&SQUARE, [5.0, 6.0]) - 5.0).abs() < 1e-12);
        assert!(near_edge(&SQUARE, [2.1, 1.0], 0.11) && !near_edge(&SQUARE, [2.1, 1.0], 0.09));
    }

    #[test]
    fn overlap_is_more_than_a_shared_edge() {
        assert_eq!(overlap(&SQUARE, &moved(&SQUARE, [2.0, 0.0]), 1e-9), None);
        assert_eq!(overlap(&SQUARE, &moved(&SQUARE, [2.0, 1.0]), 1e-9), None);
        assert_eq!(overlap(&SQUARE, &moved(&SQUARE, [5.0, 0.0]), 1e-9), None);
        assert!(overlap(&SQUARE, &SQUARE, 1e-9).is_some());
        assert!(overlap(&SQUARE, &moved(&SQUARE, [1.0, 1.0]), 1e-9).is_some());
        assert!(overlap(&SQUARE, &moved(&SQUARE, [1.0, 0.0]), 1e-9).is_some());
        let diamond = [[1.0, 0.0], [2.0, 1.0], [1.0, 2.0], [0.0, 1.0]];
        assert!(overlap(&SQUARE, &diamond, 1e-9).is_some());
    }

    #[test]
    fn a_slope_on_rock_does_not_overlap_it() {
        let third = 1.0 / 3.0;
        let soil = [[0.0, third], [6.0, third], [3.0, 1.0], [0.0, 2.0]];
        let rock = [
            [0.0, 0.0],
            [6.0, 0.0],
            [6.0, third],
            [2.0, 0.1 + (third - 0.1)],
            [0.0, third],
        ];
        assert_eq!(overlap(&soil, &rock, 1e-9), None);
    }

    #[test]
    fn polygons_face_each_other_across_a_gap_whichever_way_round_they_are() {
        let beside = moved(&SQUARE, [2.1, 0.5]);
        let mut reversed = beside.clone();
        reversed.reverse();
        for other in [beside, reversed] {
            let found = facing(&SQUARE, &other, 0.2);
            assert_eq!(found.len(), 1, "{found:?}");
            assert!((found[0].distance - 0.1).abs() < 1e-12);
            assert!((found[0].middle[0] - 2.05).abs() < 1e-12);
            assert!((found[0].middle[1] - 1.25).abs() < 1e-12);
        }
        assert!(facing(&SQUARE, &moved(&SQUARE, [2.0, 0.0]), 0.2)[0].distance < 1e-12);
        assert!(facing(&SQUARE, &moved(&SQUARE, [2.0, 2.0]), 0.2).is_empty());
        assert!(facing(&SQUARE, &moved(&SQUARE, [2.3, 0.0]), 0.2).is_empty());
    }

    #[test]
    fn a_wedge_is_as_thick_as_its_thick_end() {
        let wedge = [[0.0, 0.0], [6.0, 0.0], [0.0, 1.0]];
        let height = largest_run(&wedge, 1);
        assert!(height[0].abs() < 1e-5 && (height[1] - 1.0).abs() < 1e-5);
        let width = largest_run(&wedge, 0);
        assert!((width[1] - width[0] - 6.0).abs() < 1e-4);
    }

    #[test]
    fn a_bow_tie_crosses_itself() {
        let bow = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]];
        assert_eq!(self_crossing(&bow, 1e-9), Some([1.0, 1.0]));
        assert_eq!(self_crossing(&SQUARE, 1e-9), None);
    }

    #[test]
    fn top_edges_do_not_depend_on_the_direction() {
        let mut reversed = SQUARE;
        reversed.reverse();
        for polygon in [SQUARE, reversed] {
            assert_eq!(top_edges(&polygon), [[[0.0, 2.0], [2.0, 2.0]]]);
        }
        assert!(cover(&mut [[1.0, 2.0], [0.0, 1.0]], 0.0, 2.0, 1e-9));
        assert!(!cover(&mut [[1.5, 2.0], [0.0, 1.0]], 0.0, 2.0, 1e-9));
    }
}
