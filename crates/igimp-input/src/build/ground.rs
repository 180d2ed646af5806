//! The surface of the ground, straight from place to place, and how water tables lie to it.

pub(crate) mod gaps;
pub(crate) mod layers;
pub(crate) mod level;
pub(crate) mod space;

use igimp_geometry::polygon::contains;
use igimp_model::{BodyPart, PoreSource, Raster, table_level};
use igimp_schema::text::number;

use super::bodies::site::Site;

/// The ground as conditions of the water see it.
pub(super) trait Earth<const D: usize> {
    /// Whether bodies and grid are known.
    fn is_complete(&self) -> bool;

    /// The surface of the bodies that are there. With `fills_gaps` it lies at the bottom of the grid where there is no
    /// ground.
    fn surface(&self, present: &[bool], fills_gaps: bool) -> Box<dyn Surface>;

    /// Whether a water table, or pressures by points, reach into a body.
    fn wets(&self, source: &PoreSource, part: &BodyPart<D>) -> bool;

    /// The outline of a body, or of the box around it, as it is seen from the front.
    fn front_outline(&self, part: &BodyPart<D>) -> Vec<[f64; 2]>;
}

/// The surface of the ground.
pub(super) trait Surface {
    /// Where a water table stands above it: highest, and highest where it is not level.
    fn above(&self, table: &PoreSource) -> [Option<Above>; 2];

    /// A place with ground to which a table does not reach, in words.
    fn uncovered(&self, _table: &PoreSource) -> Option<String> {
        None
    }

    /// The table of ground that drains from `inside` to `outside`: `inside` within higher ground, the surface where it
    /// lies between the two, `outside` above lower ground.
    ///
    /// # Errors
    /// Where the surface drops upright between the levels.
    fn drained(&self, inside: f64, outside: f64) -> Result<PoreSource, UprightFace>;

    /// Where it drops upright.
    fn upright_face(&self) -> Option<UprightFace>;

    /// Where pressures by points are greatest on it, and the pressure there \[Pa\].
    fn most_on_ground(&self, raster: &Raster) -> Option<(String, f64)>;
}

/// Where and by how much a table stands above the ground.
#[derive(Clone, Debug)]
pub(super) struct Above {
    /// The place, in words.
    pub(super) at: String,
    /// \[m\].
    pub(super) by: f64,
}

/// Where the surface drops upright.
#[derive(Clone, Debug)]
pub(super) struct UprightFace {
    /// The place, in words.
    pub(super) at: String,
    /// Lower and upper level \[m\].
    pub(super) levels: [f64; 2],
}

impl UprightFace {
    fn new(x: f64, left: f64, right: f64) -> Self {
        Self {
            at: format!("x = {} m", number(x)),
            levels: [left.min(right), left.max(right)],
        }
    }
}

impl Earth<2> for Site {
    fn is_complete(&self) -> bool {
        self.is_complete && self.frame.is_some()
    }

    fn surface(&self, present: &[bool], fills_gaps: bool) -> Box<dyn Surface> {
        Box::new(Line::of(self, present, fills_gaps))
    }

    fn wets(&self, source: &PoreSource, part: &BodyPart<2>) -> bool {
        match source {
            PoreSource::Points(raster) => raster
                .places_in(part.polygon())
                .iter()
                .any(|at| raster.at(*at) > 0.0),
            PoreSource::Table(points) => {
                let is_below = |corner: &[f64; 2]| corner[1] < table_level(points, corner[0]);
                part.polygon().iter().any(is_below)
                    || (points.iter()).any(|&point| contains(part.polygon(), point))
            }
            _ => false,
        }
    }

    fn front_outline(&self, part: &BodyPart<2>) -> Vec<[f64; 2]> {
        part.polygon().to_vec()
    }
}

/// A stretch of the surface.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    /// Where it begins and ends \[m\].
    x: [f64; 2],
    /// Its levels there \[m\].
    y: [f64; 2],
}

/// The surface of bodies in the plane from left to right.
#[derive(Clone, Debug)]
struct Line {
    stretches: Vec<Stretch>,
    /// Water that stands higher than this above it counts \[m\].
    tolerance: f64,
}

impl Line {
    /// That of some of the bodies of a site. With `fills_gaps` it lies at the bottom of the grid where there is no ground.
    fn of(site: &Site, present: &[bool], fills_gaps: bool) -> Self {
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
}

impl Surface for Line {
    fn above(&self, table: &PoreSource) -> [Option<Above>; 2] {
        let PoreSource::Table(table) = table else {
            return [None, None];
        };
        let mut found: [Option<[f64; 2]>; 2] = [None; 2];
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
                        if counts && found.is_none_or(|[_, most]| by > most) {
                            *found = Some([x, by]);
                        }
                    }
                }
            }
        }
        found.map(|above| {
            above.map(|[x, by]| Above {
                at: format!("x = {} m", number(x)),
                by,
            })
        })
    }

    fn drained(&self, inside: f64, outside: f64) -> Result<PoreSource, UprightFace> {
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
                            return Err(UprightFace::new(x, last[1], y));
                        }
                    }
                    _ => points.push([x, y]),
                }
            }
        }
        // A point on the line between its neighbours adds nothing.
        let mut k = 1;
        while k + 1 < points.len() {
            let level = table_level(&[points[k - 1], points[k + 1]], points[k][0]);
            if (level - points[k][1]).abs() <= 1e-12 * inside.abs().max(outside.abs()) {
                points.remove(k);
            } else {
                k += 1;
            }
        }
        Ok(PoreSource::Table(points))
    }

    fn upright_face(&self) -> Option<UprightFace> {
        let pairs = self.stretches.windows(2);
        let beside = pairs.filter(|pair| pair[1].x[0] <= pair[0].x[1]);
        let mut drops = beside.map(|pair| [pair[0].x[1], pair[0].y[1], pair[1].y[0]]);
        let found = drops.find(|[_, left, right]| (left - right).abs() > self.tolerance);
        found.map(|[x, left, right]| UprightFace::new(x, left, right))
    }

    fn most_on_ground(&self, raster: &Raster) -> Option<(String, f64)> {
        let ends = self.stretches.iter().flat_map(|stretch| {
            let at = |share: f64| {
                let [x, y] = [stretch.x, stretch.y].map(|[from, to]| from + share * (to - from));
                [x, y]
            };
            [0.0, 0.25, 0.5, 0.75, 1.0].map(at)
        });
        let most = ends.max_by(|a, b| raster.at(*a).total_cmp(&raster.at(*b)))?;
        let at = format!("({}, {}) m", number(most[0]), number(most[1]));
        Some((at, raster.at(most)))
    }
}

impl Stretch {
    /// Its two ends.
    fn line(&self) -> [[f64; 2]; 2] {
        [[self.x[0], self.y[0]], [self.x[1], self.y[1]]]
    }
}
