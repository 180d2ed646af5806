//! The ground as a case draws it: its surface, and what its weight is at a place.

use super::{BodyPart, Case, Material, PoreSource, Profile, table_level};

/// Unit weight of the water of a stated level \[N/m³\].
const WATER: f64 = 9.81e3;

/// The bodies that are there at the start, as they are drawn, with the unit weights of their materials.
#[derive(Clone, Debug, Default)]
pub struct Ground {
    layers: Vec<Layer>,
    /// The water at the start, and its unit weight \[N/m³\].
    water: Option<(PoreSource, f64)>,
}

/// A body.
#[derive(Clone, Debug, Default)]
struct Layer {
    polygon: Vec<[f64; 2]>,
    unit_weight: f64,
    /// Where the unit weight varies.
    profile: Option<Profile>,
    /// By how much soil is heavier below the water table \[N/m³\].
    added: f64,
}

impl Case {
    /// The ground of the case.
    pub fn ground(&self) -> Ground {
        let bodies = self.bodies.iter();
        let ground = Ground::new(bodies.map(|body| (body, &self.materials[body.material])));
        let first = self.water.first();
        Ground {
            water: first.map(|condition| (condition.source.clone(), self.water_unit_weight)),
            ..ground
        }
    }
}

impl Ground {
    /// The ground of those of some bodies that are there from the start, with their materials, without water.
    pub fn new<'a>(bodies: impl Iterator<Item = (&'a BodyPart, &'a Material)>) -> Self {
        let from_start = bodies.filter(|(body, _)| body.from_start);
        let layers = from_start.map(|(body, material)| Layer {
            polygon: body.polygon.clone(),
            unit_weight: material.unit_weight,
            profile: material.profiles.unit_weight.clone(),
            added: material.added_by_water(),
        });
        Self {
            layers: layers.collect(),
            water: None,
        }
    }

    /// The ground of polygons \[m\], each with its unit weight \[N/m³\] and how that varies, if it does.
    pub fn of_polygons<'a>(
        polygons: impl Iterator<Item = (&'a [[f64; 2]], f64, Option<&'a Profile>)>,
    ) -> Self {
        let layers = polygons.map(|(polygon, unit_weight, profile)| Layer {
            polygon: polygon.to_vec(),
            unit_weight,
            profile: profile.cloned(),
            added: 0.0,
        });
        Self {
            layers: layers.collect(),
            water: None,
        }
    }

    /// The level of the surface: the highest soil on a vertical line \[m\], if there is any.
    pub fn surface(&self, x: f64) -> Option<f64> {
        let tops = self.layers.iter().flat_map(|layer| {
            edges(&layer.polygon).filter_map(move |[p, q]| {
                let [left, right] = [p[0].min(q[0]), p[0].max(q[0])];
                if x < left || x > right {
                    return None;
                }
                if right > left {
                    let t = (x - p[0]) / (q[0] - p[0]);
                    Some(p[1] + t * (q[1] - p[1]))
                } else {
                    Some(p[1].max(q[1]))
                }
            })
        });
        tops.reduce(f64::max)
    }

    /// How far a place lies below the surface, straight down \[m\]; 0 above it.
    pub fn depth(&self, place: [f64; 2]) -> f64 {
        let surface = self.surface(place[0]).unwrap_or(place[1]);
        (surface - place[1]).max(0.0)
    }

    /// The weight of the soil above a place per area \[Pa\] (theory, eq. 36).
    pub fn weight_above(&self, place: [f64; 2]) -> f64 {
        let layers = self.layers.iter();
        layers
            .map(|layer| match &layer.profile {
                None => sum_above(&layer.polygon, place, |level| level) * layer.unit_weight,
                Some(own) => sum_above(&layer.polygon, place, |level| {
                    own.integral(place, level, self)
                }),
            })
            .sum()
    }

    /// What a water table at a level adds to the weight above a place \[Pa\].
    pub fn added_above(&self, place: [f64; 2], table: f64) -> f64 {
        let wet = |layer: &Layer| sum_above(&layer.polygon, place, |level| level.min(table));
        self.layers
            .iter()
            .map(|layer| wet(layer) * layer.added)
            .sum()
    }

    /// The vertical effective stress σ′_v0 of level ground at a place, compression positive \[Pa\] (theory, eq. 36a): the
    /// weight above less the pressure of water at rest, that of a level \[m\] or else of the water at the start. What
    /// stands on the surface presses on it as much as it adds to the pressure below. Not below zero.
    pub fn effective_stress(&self, place: [f64; 2], water_level: Option<f64>) -> f64 {
        let weight = self.weight_above(place);
        let surface = self.surface(place[0]).unwrap_or(place[1]);
        let below = |table: f64, unit_weight: f64| {
            let pressure = unit_weight * (table.min(surface) - place[1]).max(0.0);
            self.added_above(place, table) - pressure
        };
        let by_water = match (water_level, &self.water) {
            (Some(level), _) => below(level, WATER),
            (None, Some((PoreSource::Table(points), unit_weight))) => {
                below(table_level(points, place[0]), *unit_weight)
            }
            (None, Some((PoreSource::Points(raster), _))) => {
                let on_ground = raster.at([place[0], surface]).max(0.0);
                on_ground - raster.at(place).max(0.0)
            }
            (None, Some((PoreSource::Ratio(ratio), _))) => -ratio * weight,
            (None, Some((PoreSource::Dry, _)) | None) => 0.0,
        };
        (weight + by_water).max(0.0)
    }

    /// The least and the greatest depth of the soil of a polygon \[m\].
    pub fn depths(&self, polygon: &[[f64; 2]]) -> Option<[f64; 2]> {
        let of_place = |place: [f64; 2]| {
            let depth = self.depth(place);
            [depth, depth]
        };
        let depths = self.corners(polygon).into_iter().map(of_place);
        depths.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    /// Places within a polygon between which depths are linear: on its edges, hardly beside the corners of all
    /// polygons, as the surface may step there.
    pub fn corners(&self, polygon: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let all = self.layers.iter().flat_map(|layer| &layer.polygon);
        let mut sides: Vec<f64> = all.chain(polygon).map(|corner| corner[0]).collect();
        sides.sort_by(f64::total_cmp);
        let strips = sides.windows(2).filter(|pair| pair[0] < pair[1]);
        let beside = strips.flat_map(|pair| {
            let off = BESIDE * (pair[1] - pair[0]);
            [pair[0] + off, pair[1] - off]
        });
        beside
            .flat_map(|x| crossings(polygon, x).map(move |(level, _)| [x, level]))
            .collect()
    }
}

/// Share of the distance of two corners at which a place counts as beside them \[-\].
const BESIDE: f64 = 1e-9;

fn edges(polygon: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
    (0..polygon.len()).map(|k| [polygon[k], polygon[(k + 1) % polygon.len()]])
}

/// Where the upright line at x crosses the edges of a polygon, and whether the edge goes to the left.
fn crossings(polygon: &[[f64; 2]], x: f64) -> impl Iterator<Item = (f64, bool)> {
    edges(polygon).filter_map(move |[p, q]| {
        if (p[0] <= x) == (q[0] <= x) {
            return None;
        }
        let t = (x - p[0]) / (q[0] - p[0]);
        Some((p[1] + t * (q[1] - p[1]), q[0] < p[0]))
    })
}

/// The growth of a quantity that rises with the level along the part of the vertical ray upwards from a point that
/// lies within a polygon: with the level itself, the length \[m\].
fn sum_above(polygon: &[[f64; 2]], x: [f64; 2], quantity: impl Fn(f64) -> f64) -> f64 {
    let mut sum = 0.0;
    for (level, goes_left) in crossings(polygon, x[0]) {
        let crossing = quantity(level.max(x[1]));
        sum += if goes_left { crossing } else { -crossing };
    }
    sum.abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Variation;

    const RING: [[f64; 2]; 4] = [[0.0, 0.0], [4.0, 0.0], [4.0, 5.0], [0.0, 5.0]];

    #[test]
    fn the_ray_counts_what_lies_above() {
        let length_above = |ring: &[[f64; 2]], x: [f64; 2]| sum_above(ring, x, |level| level);
        assert!((length_above(&RING, [1.0, 2.0]) - 3.0).abs() < 1e-15);
        assert!((length_above(&RING, [1.0, -2.0]) - 5.0).abs() < 1e-15);
        assert!(length_above(&RING, [1.0, 6.0]).abs() < 1e-15);
        let clockwise: Vec<[f64; 2]> = RING.iter().rev().copied().collect();
        assert!((length_above(&clockwise, [1.0, 2.0]) - 3.0).abs() < 1e-15);
        let denser = Variation::Gradient {
            from: 4.0,
            at_top: 18.0,
            gradient: 0.5,
        };
        let by_level = Profile::Level(denser);
        let layer = (&RING[..], 0.0, Some(&by_level));
        let ground = Ground::of_polygons(std::iter::once(layer));
        assert!((ground.weight_above([1.0, 2.0]) - (18.0 + 2.0 * 18.5)).abs() < 1e-12);
    }

    /// GOAL: depth goes down from the highest body, weight through all of them, water no higher than the soil.
    #[test]
    fn the_surface_is_the_highest_soil() {
        let fill = [[2.0, 5.0], [4.0, 5.0], [4.0, 7.0]];
        let ground =
            Ground::of_polygons([(&RING[..], 10e3, None), (&fill[..], 20e3, None)].into_iter());
        assert_eq!(ground.surface(1.0), Some(5.0));
        assert_eq!(ground.surface(9.0), None);
        assert!((ground.depth([3.0, 4.0]) - 2.0).abs() < 1e-12);
        assert!((ground.weight_above([3.0, 4.0]) - 30e3).abs() < 1e-9);
        let stress = |level| ground.effective_stress([3.0, 4.0], Some(level));
        assert!((stress(4.5) - (30e3 - 0.5 * 9.81e3)).abs() < 1e-9);
        assert!((stress(100.0) - (30e3 - 2.0 * 9.81e3)).abs() < 1e-9);
        assert!((stress(0.0) - 30e3).abs() < 1e-9);
        let wet = |source| Ground {
            water: Some((source, 10e3)),
            ..ground.clone()
        };
        let table = wet(PoreSource::Table(vec![[0.0, 6.0], [6.0, 3.0]]));
        let stress = table.effective_stress([3.0, 4.0], None);
        assert!((stress - (30e3 - 0.5 * 10e3)).abs() < 1e-9);
        let share = wet(PoreSource::Ratio(0.4));
        assert!((share.effective_stress([3.0, 4.0], None) - 18e3).abs() < 1e-9);
        let [least, greatest] = ground.depths(&RING).unwrap();
        assert!(
            least.abs() < 1e-6 && (greatest - 7.0).abs() < 1e-6,
            "{least} {greatest}"
        );
    }
}
