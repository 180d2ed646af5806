//! The surface of the ground in space, over a lattice of places in plan, and how water tables lie to it.

use std::sync::Arc;

use igimp_geometry::region::Region;
use igimp_model::{BodyPart, Drained, PoreSource, Raster};
use igimp_schema::text::number;

use super::{Above, Earth, Surface, UprightFace};
use crate::build::bodies::site::Solids;

/// Most places of the lattice along an axis.
const MOST: usize = 80;
/// Between places nearer than this share of their distance a drop is upright \[-\].
const NEAR: f64 = 1e-6;
/// Slopes of surfaces beyond which a drop between two places is looked at \[-\].
const STEEP: f64 = 2.0;

impl Earth<3> for Solids {
    fn is_complete(&self) -> bool {
        self.is_complete
    }

    fn surface(&self, present: &[bool], fills_gaps: bool) -> Box<dyn Surface> {
        let parts = std::iter::zip(&self.regions, present);
        let parts = parts.filter(|(_, present)| **present);
        let [x, y] = [0, 1].map(|axis| self.places(axis));
        Box::new(Relief {
            regions: parts.map(|(region, _)| Arc::clone(region)).collect(),
            bottom: fills_gaps.then_some(self.lower[2]),
            x,
            y,
            tolerance: self.round_off.max(1e-2 * self.cell),
        })
    }

    fn wets(&self, source: &PoreSource, part: &BodyPart<3>) -> bool {
        let [x, y] = [0, 1].map(|axis| self.places(axis));
        let mut places = y.iter().flat_map(|y| x.iter().map(move |x| [*x, *y, 0.0]));
        places.any(|place| {
            let levels = part.region.crossings(&place).into_iter();
            let mut levels = levels.map(|crossing| crossing.level);
            match source {
                PoreSource::Points(raster) => {
                    let [low, high] = levels.fold([f64::MAX, f64::MIN], |[low, high], level| {
                        [low.min(level), high.max(level)]
                    });
                    let lines = raster.y.iter().copied();
                    let within = lines.filter(|level| low < *level && *level < high);
                    let mut levels = within.chain([low, high].into_iter().filter(|_| low < high));
                    levels.any(|level| raster.at([place[0], level]) > 0.0)
                }
                _ => source
                    .table(&place)
                    .is_some_and(|table| levels.any(|level| level < table)),
            }
        })
    }

    fn front_outline(&self, part: &BodyPart<3>) -> Vec<[f64; 2]> {
        let (lower, upper) = part.region.bounds();
        let [left, right] = [lower[0], upper[0]];
        let [low, high] = [lower[2], upper[2]];
        vec![[left, low], [right, low], [right, high], [left, high]]
    }
}

impl Solids {
    /// Places of the lattice along an axis: two a cell, not on lines of the grid.
    fn places(&self, axis: usize) -> Vec<f64> {
        let (from, to) = (self.lower[axis], self.upper[axis]);
        let count = (2.0 * (to - from) / self.cell)
            .ceil()
            .clamp(2.0, MOST as f64);
        (0..count as usize)
            .map(|k| from + (k as f64 + 0.5) / count * (to - from))
            .collect()
    }
}

/// The surface of bodies in space.
struct Relief {
    regions: Vec<Arc<dyn Region<3>>>,
    /// Its level where there is no ground \[m\], if there is one.
    bottom: Option<f64>,
    x: Vec<f64>,
    y: Vec<f64>,
    /// Water that stands higher than this above it counts \[m\].
    tolerance: f64,
}

impl Relief {
    fn level(&self, place: &[f64; 3]) -> Option<f64> {
        let tops = self.regions.iter().filter_map(|region| region.top(place));
        tops.reduce(f64::max).or(self.bottom)
    }

    fn lattice(&self) -> impl Iterator<Item = [f64; 3]> {
        let row = |y: f64| self.x.iter().map(move |x| [*x, y, 0.0]);
        self.y.iter().flat_map(move |y| row(*y))
    }

    /// Where it drops upright between two levels.
    fn face_between(&self, low: f64, high: f64) -> Option<UprightFace> {
        let level = |place: &[f64; 3]| self.level(place).map(|height| height.clamp(low, high));
        let all: Vec<Option<f64>> = self.lattice().map(|place| level(&place)).collect();
        let width = self.x.len();
        let place = |k: usize| [self.x[k % width], self.y[k / width], 0.0];
        for k in 0..all.len() {
            let right = (k % width + 1 < width).then_some(k + 1);
            let behind = (k + width < all.len()).then_some(k + width);
            for other in [right, behind].into_iter().flatten() {
                let (Some(a), Some(b)) = (all[k], all[other]) else {
                    continue;
                };
                let (mut from, mut to) = (place(k), place(other));
                let apart = (to[0] - from[0]).abs().max((to[1] - from[1]).abs());
                if (a - b).abs() <= self.tolerance.max(STEEP * apart) {
                    continue;
                }
                let mut ends = [a, b];
                let near = NEAR * apart;
                while (to[0] - from[0]).abs().max((to[1] - from[1]).abs()) > near {
                    let middle = [0, 1, 2].map(|axis| 0.5 * (from[axis] + to[axis]));
                    let Some(height) = level(&middle) else { break };
                    if (height - ends[0]).abs() > (height - ends[1]).abs() {
                        (to, ends[1]) = (middle, height);
                    } else {
                        (from, ends[0]) = (middle, height);
                    }
                }
                if (ends[0] - ends[1]).abs() > self.tolerance {
                    return Some(UprightFace {
                        at: words(&from),
                        levels: [ends[0].min(ends[1]), ends[0].max(ends[1])],
                    });
                }
            }
        }
        None
    }
}

impl Surface for Relief {
    fn above(&self, table: &PoreSource) -> [Option<Above>; 2] {
        let step = 1e-3 * self.tolerance;
        let mut found: [Option<([f64; 3], f64)>; 2] = [None; 2];
        for place in self.lattice() {
            let (Some(ground), Some(level)) = (self.level(&place), table.table(&place)) else {
                continue;
            };
            let by = level - ground;
            if by <= self.tolerance {
                continue;
            }
            let slopes = [[step, 0.0], [0.0, step]].iter().any(|[x, y]| {
                let beside = table.table(&[place[0] + x, place[1] + y, 0.0]);
                beside.is_some_and(|near| (near - level).abs() > 1e-3 * step)
            });
            for (found, counts) in std::iter::zip(&mut found, [true, slopes]) {
                if counts && found.is_none_or(|(_, most)| by > most) {
                    *found = Some((place, by));
                }
            }
        }
        found.map(|most| {
            most.map(|(place, by)| Above {
                at: words(&place),
                by,
            })
        })
    }

    fn uncovered(&self, table: &PoreSource) -> Option<String> {
        let PoreSource::Surface(terrain) = table else {
            return None;
        };
        let mut grounds = self.lattice().filter(|place| {
            let mut tops = self.regions.iter().filter_map(|region| region.top(place));
            tops.next().is_some()
        });
        let bare = grounds.find(|place| terrain.height_at([place[0], place[1]]).is_none());
        bare.map(|place| words(&place))
    }

    fn drained(&self, inside: f64, outside: f64) -> Result<PoreSource, UprightFace> {
        match self.face_between(outside, inside) {
            Some(face) => Err(face),
            None => Ok(PoreSource::Drained(Drained::new(
                inside,
                outside,
                self.regions.clone(),
            ))),
        }
    }

    fn upright_face(&self) -> Option<UprightFace> {
        self.face_between(f64::NEG_INFINITY, f64::INFINITY)
    }

    fn most_on_ground(&self, raster: &Raster) -> Option<(String, f64)> {
        let pressures = self.lattice().filter_map(|place| {
            let level = self.level(&place)?;
            Some(([place[0], place[1], level], raster.at([place[0], level])))
        });
        let (at, most) = pressures.max_by(|a, b| a.1.total_cmp(&b.1))?;
        let [x, y, z] = at.map(rounded);
        Some((format!("({x}, {y}, {z}) m"), most))
    }
}

fn rounded(x: f64) -> String {
    number((1e4 * x).round() / 1e4)
}

/// A place in plan, in words; it lies near where it is said to be.
fn words(place: &[f64; 3]) -> String {
    format!(
        "x = {} m and y = {} m",
        rounded(place[0]),
        rounded(place[1])
    )
}
