//! The surface of the ground, straight from place to place, and how water tables lie to it.

use super::site::Site;
use crate::case::table_level;

/// A stretch of the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    /// Where it begins and ends \[m\].
    pub(super) x: [f64; 2],
    /// Its levels there \[m\].
    pub(super) y: [f64; 2],
}

/// The surface of bodies from left to right.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    pub(super) stretches: Vec<Stretch>,
    /// Water that stands higher than this above it counts \[m\].
    pub(super) tolerance: f64,
}

/// Where and by how much a table stands highest above the ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct Above {
    pub(super) x: f64,
    pub(super) by: f64,
}

impl Surface {
    /// That of some of the bodies of a site. With `fills_gaps` it lies at the bottom of the grid where there is no ground.
    pub(super) fn of(site: &Site, present: &[bool], fills_gaps: bool) -> Self {
        let polygons = std::iter::zip(&site.polygons, present);
        let polygons = polygons.filter(|(_, present)| **present);
        let edges: Vec<[[f64; 2]; 2]> = polygons
            .flat_map(|(polygon, _)| {
                (0..polygon.len()).map(|k| [polygon[k], polygon[(k + 1) % polygon.len()]])
            })
            .map(|[p, q]| if p[0] <= q[0] { [p, q] } else { [q, p] })
            .filter(|[p, q]| q[0] - p[0] > site.round_off)
            .collect();
        let mut places: Vec<f64> = edges.iter().flatten().map(|end| end[0]).collect();
        if let Some(frame) = &site.frame {
            places.extend([frame.lower[0], frame.upper[0]]);
        }
        places.sort_by(f64::total_cmp);
        places.dedup_by(|b, a| *b - *a <= site.round_off);
        let bottom = match &site.frame {
            Some(frame) => frame.lower[1],
            None => f64::NEG_INFINITY,
        };
        let count = places.len().saturating_sub(1);
        let mut tops: Vec<Option<(f64, usize)>> = vec![None; count];
        for (number, [p, q]) in edges.iter().enumerate() {
            let first = places.partition_point(|x| *x < p[0] - site.round_off);
            for k in first..count {
                let middle = 0.5 * (places[k] + places[k + 1]);
                if middle > q[0] {
                    break;
                }
                let level = table_level(&[*p, *q], middle);
                if tops[k].is_none_or(|(top, _)| level > top) {
                    tops[k] = Some((level, number));
                }
            }
        }
        let stretches = tops.iter().zip(places.windows(2)).filter_map(|(top, x)| {
            let x = [x[0], x[1]];
            let y = match top {
                Some((_, number)) => x.map(|x| table_level(&edges[*number], x)),
                None if fills_gaps => [bottom; 2],
                None => return None,
            };
            Some(Stretch { x, y })
        });
        Self {
            stretches: stretches.collect(),
            tolerance: site.round_off.max(1e-2 * site.cell()),
        }
    }

    /// Where a table stands above the ground: highest, and highest where it is not level.
    pub(super) fn below(&self, table: &[[f64; 2]]) -> [Option<Above>; 2] {
        let mut found = [None; 2];
        for stretch in &self.stretches {
            let inside = table.iter().map(|point| point[0]);
            let inside = inside.filter(|x| stretch.x[0] < *x && *x < stretch.x[1]);
            let mut places = vec![stretch.x[0]];
            places.extend(inside);
            places.push(stretch.x[1]);
            for ends in places.windows(2) {
                let levels = [ends[0], ends[1]].map(|x| table_level(table, x));
                let slopes = (levels[0] - levels[1]).abs() > 0.0;
                for (x, level) in std::iter::zip([ends[0], ends[1]], levels) {
                    let by = level - table_level(&stretch.line(), x);
                    if by <= self.tolerance {
                        continue;
                    }
                    for (kind, found) in found.iter_mut().enumerate() {
                        let counts = kind == 0 || slopes;
                        if counts && found.is_none_or(|other: Above| by > other.by) {
                            *found = Some(Above { x, by });
                        }
                    }
                }
            }
        }
        found
    }

    /// The table of ground that drains from `inside` to `outside`: `inside` within higher ground, the surface where it
    /// lies between the two, `outside` above lower ground.
    ///
    /// # Errors
    /// Where the surface drops upright between the levels: the place and the two levels there \[m\].
    pub(super) fn drained(&self, inside: f64, outside: f64) -> Result<Vec<[f64; 2]>, [f64; 3]> {
        let mut points: Vec<[f64; 2]> = Vec::new();
        for stretch in &self.stretches {
            let [[x0, x1], [y0, y1]] = [stretch.x, stretch.y];
            let cuts = [outside, inside].map(|level| (level - y0) / (y1 - y0));
            let mut cuts: Vec<f64> = cuts.into_iter().filter(|t| 0.0 < *t && *t < 1.0).collect();
            cuts.sort_by(f64::total_cmp);
            let places = [0.0].into_iter().chain(cuts).chain([1.0]);
            for t in places {
                let x = x0 + t * (x1 - x0);
                let y = (y0 + t * (y1 - y0)).clamp(outside, inside);
                match points.last() {
                    Some(last) if x - last[0] <= 1e-9 * (x1 - x0) => {
                        if (y - last[1]).abs() > self.tolerance {
                            return Err([x, last[1], y]);
                        }
                    }
                    _ => points.push([x, y]),
                }
            }
        }
        // What lies on the line between its neighbours says nothing.
        let mut k = 1;
        while k + 1 < points.len() {
            let level = table_level(&[points[k - 1], points[k + 1]], points[k][0]);
            if (level - points[k][1]).abs() <= 1e-12 * inside.abs().max(outside.abs()) {
                points.remove(k);
            } else {
                k += 1;
            }
        }
        Ok(points)
    }

    /// Where the surface drops upright: the place and the levels on the left and on the right \[m\].
    pub(super) fn drop(&self) -> Option<[f64; 3]> {
        let pairs = self.stretches.windows(2);
        let beside = pairs.filter(|pair| pair[1].x[0] <= pair[0].x[1]);
        let mut drops = beside.map(|pair| [pair[0].x[1], pair[0].y[1], pair[1].y[0]]);
        drops.find(|[_, left, right]| (left - right).abs() > self.tolerance)
    }
}

impl Stretch {
    /// Its two ends.
    fn line(&self) -> [[f64; 2]; 2] {
        [[self.x[0], self.y[0]], [self.x[1], self.y[1]]]
    }
}
