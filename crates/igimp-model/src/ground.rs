//! The ground as a case draws it: its surface, and its weight at a place.

use std::sync::Arc;

use igimp_geometry::region::{Crossing, Region};

use super::{BodyPart, Case, Material, PoreSource, Profile, front};

/// Unit weight of water where nothing else is said \[N/m³\].
const WATER: f64 = 9.81e3;

/// The bodies that are there at the start, as they are drawn, with the unit weights of their materials.
#[derive(Clone, Debug)]
pub struct Ground<const D: usize> {
    layers: Vec<Layer<D>>,
    /// The water at the start.
    water: Option<PoreSource>,
    /// Unit weight of water \[N/m³\].
    water_unit_weight: f64,
}

impl<const D: usize> Default for Ground<D> {
    fn default() -> Self {
        Self::of_layers(std::iter::empty())
    }
}

/// A region of soil with a unit weight.
#[derive(Clone, Debug)]
pub struct Layer<const D: usize> {
    /// The region.
    pub region: Arc<dyn Region<D>>,
    /// Unit weight \[N/m³\].
    pub unit_weight: f64,
    /// How it varies, if it does.
    pub profile: Option<Profile>,
    /// Unit weight below the water table, where it is another \[N/m³\].
    pub saturated: Option<f64>,
}

impl<const D: usize> Case<D> {
    /// The ground of the case.
    pub fn ground(&self) -> Ground<D> {
        let bodies = self.bodies.iter();
        let ground = Ground::new(bodies.map(|body| (body, &self.materials[body.material])));
        let first = self.water.first();
        Ground {
            water: first.map(|condition| condition.source.clone()),
            ..ground.with_water_of(self.water_unit_weight)
        }
    }
}

impl<const D: usize> Ground<D> {
    /// The ground of those of some bodies that are there from the start, with their materials, without water.
    pub fn new<'a>(bodies: impl Iterator<Item = (&'a BodyPart<D>, &'a Material)>) -> Self {
        let from_start = bodies.filter(|(body, _)| body.from_start);
        Self::of_layers(from_start.map(|(body, material)| Layer {
            region: Arc::clone(&body.region),
            unit_weight: material.unit_weight,
            profile: material.profiles.unit_weight.clone(),
            saturated: material.saturated,
        }))
    }

    /// The ground of layers, without water.
    pub fn of_layers(layers: impl Iterator<Item = Layer<D>>) -> Self {
        Self {
            layers: layers.collect(),
            water: None,
            water_unit_weight: WATER,
        }
    }

    /// The same with water of a unit weight \[N/m³\], in place of 9.81 kN/m³.
    #[must_use]
    pub fn with_water_of(self, unit_weight: f64) -> Self {
        Self {
            water_unit_weight: unit_weight,
            ..self
        }
    }

    /// The level of the surface above or below a place: the highest soil on its upright line \[m\], if there is any.
    pub fn surface(&self, place: &[f64; D]) -> Option<f64> {
        let place = self.within(place);
        let tops = self.layers.iter().filter_map(|l| l.region.top(&place));
        tops.reduce(f64::max)
    }

    /// A place on a side of the ground as one hardly within it: lines through it cross the soil on its right alone.
    fn within(&self, place: &[f64; D]) -> [f64; D] {
        let crossed = |layer: &Layer<D>| !layer.region.crossings(place).is_empty();
        let mut within = *place;
        for (axis, x) in within.iter_mut().enumerate().take(D - 1) {
            for layer in &self.layers {
                let (lower, upper) = layer.region.bounds();
                let off = BESIDE * (upper[axis] - lower[axis]);
                if (place[axis] - upper[axis]).abs() < off && !self.layers.iter().any(crossed) {
                    *x = upper[axis] - off;
                }
            }
        }
        within
    }

    /// How far a place lies below the surface, straight down \[m\]; 0 above it.
    pub fn depth(&self, place: &[f64; D]) -> f64 {
        let level = place[D - 1];
        let surface = self.surface(place).unwrap_or(level);
        (surface - level).max(0.0)
    }

    /// The weight of the soil above a place per area \[Pa\] (theory, eq. 36).
    pub fn weight_above(&self, place: &[f64; D]) -> f64 {
        let place = &self.within(place);
        let layers = self.layers.iter();
        layers
            .map(|layer| match &layer.profile {
                None => sum_above(&*layer.region, place, |level| level) * layer.unit_weight,
                Some(profile) => sum_above(&*layer.region, place, |level| {
                    profile.integral(place, level, self)
                }),
            })
            .sum()
    }

    /// The weight above a place that a water table at a level adds \[Pa\].
    pub fn added_above(&self, place: &[f64; D], table: f64) -> f64 {
        let place = &self.within(place);
        // A table that lies below adds nothing, however low it is.
        let table = table.max(place[D - 1]);
        let added = |layer: &Layer<D>| {
            let Some(saturated) = layer.saturated else {
                return 0.0;
            };
            sum_above(&*layer.region, place, |level| {
                let level = level.min(table);
                let dry = match &layer.profile {
                    None => layer.unit_weight * level,
                    Some(profile) => profile.integral(place, level, self),
                };
                saturated * level - dry
            })
        };
        self.layers.iter().map(added).sum()
    }

    /// The vertical effective stress σ′_v0 of level ground at a place, compression positive \[Pa\] (theory, eq. 36a): the
    /// weight above less the pressure of water at rest, that of a level \[m\] or else of the water at the start. Water
    /// that stands on the surface presses on it as much as it adds to the pressure below. Not below zero.
    pub fn effective_stress(&self, place: &[f64; D], water_level: Option<f64>) -> f64 {
        let weight = self.weight_above(place);
        let [x, level] = front(place);
        let surface = self.surface(place).unwrap_or(level);
        let below = |table: f64| {
            let pressure = self.water_unit_weight * (table.min(surface) - level).max(0.0);
            self.added_above(place, table) - pressure
        };
        let by_water = match (water_level, &self.water) {
            (Some(level), _) => below(level),
            (
                None,
                Some(
                    table
                    @ (PoreSource::Table(_) | PoreSource::Surface(_) | PoreSource::Drained(_)),
                ),
            ) => table.table(place).map_or(0.0, below),
            (None, Some(PoreSource::Points(raster))) => {
                let on_ground = raster.at([x, surface]).max(0.0);
                on_ground - raster.at([x, level]).max(0.0)
            }
            (None, Some(PoreSource::Ratio(ratio))) => -ratio * weight,
            (None, Some(PoreSource::Dry | PoreSource::Seepage(_)) | None) => 0.0,
        };
        (weight + by_water).max(0.0)
    }

    /// The least and the greatest depth of the soil of a region \[m\].
    pub fn depths(&self, region: &dyn Region<D>) -> Option<[f64; 2]> {
        let of_place = |place: [f64; D]| {
            let depth = self.depth(&place);
            [depth, depth]
        };
        let depths = self.places(region).into_iter().map(of_place);
        depths.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    /// Places on the boundary of a region between which depths are linear, or nearly so: hardly beside the corners of
    /// all regions, as the surface may step there.
    pub fn places(&self, region: &dyn Region<D>) -> Vec<[f64; D]> {
        let all = self.layers.iter().flat_map(|layer| layer.region.corners());
        let corners: Vec<[f64; D]> = all.chain(region.corners()).collect();
        let mut lines = vec![[0.0; D]];
        for axis in 0..D - 1 {
            let beside = beside(corners.iter().map(|corner| corner[axis]).collect());
            let at = |line: &[f64; D], x: f64| {
                let mut line = *line;
                line[axis] = x;
                line
            };
            lines = (lines.iter())
                .flat_map(|line| beside.iter().map(move |&x| at(line, x)))
                .collect();
        }
        let on_boundary = |line: [f64; D]| {
            let crossings = region.crossings(&line).into_iter();
            crossings.map(move |crossing| {
                let mut place = line;
                place[D - 1] = crossing.level;
                place
            })
        };
        lines.into_iter().flat_map(on_boundary).collect()
    }
}

/// Parts of an upright line through soil at whose ends values are looked at.
const PARTS: u32 = 32;

impl<const D: usize> Ground<D> {
    /// Places all over a region: on its boundary, and along upright lines between them.
    pub fn places_within(&self, region: &dyn Region<D>) -> Vec<[f64; D]> {
        let mut places = self.places(region);
        let ends = places.clone();
        let is_upright = |pair: &&[[f64; D]]| {
            (0..D - 1).all(|axis| pair[0][axis].total_cmp(&pair[1][axis]).is_eq())
        };
        for pair in ends.windows(2).filter(is_upright) {
            places.extend((1..PARTS).map(|k| {
                let share = f64::from(k) / f64::from(PARTS);
                let mut place = pair[0];
                place[D - 1] += share * (pair[1][D - 1] - pair[0][D - 1]);
                place
            }));
        }
        places
    }
}

/// Share of the distance of two corners at which a place counts as beside them \[-\].
const BESIDE: f64 = 1e-9;
/// Most different coordinates of corners beside which places are looked at; of more some are left out.
const MOST_SIDES: usize = 400;

/// Coordinates hardly beside those of corners, on either side and within their ends.
fn beside(mut sides: Vec<f64>) -> Vec<f64> {
    sides.sort_by(f64::total_cmp);
    sides.dedup();
    let every = sides.len().div_ceil(MOST_SIDES).max(1);
    let last = sides.last().copied();
    let mut kept: Vec<f64> = sides.into_iter().step_by(every).collect();
    kept.extend(last.filter(|last| kept.last() != Some(last)));
    let strips = kept.windows(2);
    strips
        .flat_map(|pair| {
            let off = BESIDE * (pair[1] - pair[0]);
            [pair[0] + off, pair[1] - off]
        })
        .collect()
}

/// The growth of a quantity that rises with the level along the part of the upright ray from a place that lies within a
/// region: with the level itself, the length \[m\].
fn sum_above<const D: usize>(
    region: &dyn Region<D>,
    place: &[f64; D],
    quantity: impl Fn(f64) -> f64,
) -> f64 {
    let mut sum = 0.0;
    for Crossing { level, sense } in region.crossings(place) {
        let crossing = quantity(level.max(place[D - 1]));
        sum += if sense { crossing } else { -crossing };
    }
    sum.abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Variation;

    const RING: [[f64; 2]; 4] = [[0.0, 0.0], [4.0, 0.0], [4.0, 5.0], [0.0, 5.0]];

    fn layer(polygon: &[[f64; 2]], unit_weight: f64) -> Layer<2> {
        Layer {
            region: Arc::new(polygon.to_vec()),
            unit_weight,
            profile: None,
            saturated: None,
        }
    }

    #[test]
    fn the_ray_counts_what_lies_above() {
        let length_above = |ring: &[[f64; 2]], x: [f64; 2]| sum_above(&ring.to_vec(), &x, |y| y);
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
        let mut layer = layer(&RING, 0.0);
        layer.profile = Some(by_level);
        let ground = Ground::of_layers(std::iter::once(layer));
        assert!((ground.weight_above(&[1.0, 2.0]) - (18.0 + 2.0 * 18.5)).abs() < 1e-12);
    }

    /// GOAL: depth goes down from the highest body, weight through all of them, water no higher than the soil.
    #[test]
    fn the_surface_is_the_highest_soil() {
        let fill = [[2.0, 5.0], [4.0, 5.0], [4.0, 7.0]];
        let ground = Ground::of_layers([layer(&RING, 10e3), layer(&fill, 20e3)].into_iter());
        assert_eq!(ground.surface(&[1.0, 0.0]), Some(5.0));
        assert_eq!(ground.surface(&[9.0, 0.0]), None);
        assert!((ground.depth(&[3.0, 4.0]) - 2.0).abs() < 1e-12);
        assert!((ground.weight_above(&[3.0, 4.0]) - 30e3).abs() < 1e-9);
        let stress = |level| ground.effective_stress(&[3.0, 4.0], Some(level));
        assert!((stress(4.5) - (30e3 - 0.5 * 9.81e3)).abs() < 1e-9);
        assert!((stress(100.0) - (30e3 - 2.0 * 9.81e3)).abs() < 1e-9);
        assert!((stress(0.0) - 30e3).abs() < 1e-9);
        let wet = |source| Ground {
            water: Some(source),
            ..ground.clone().with_water_of(10e3)
        };
        let table = wet(PoreSource::Table(vec![[0.0, 6.0], [6.0, 3.0]]));
        let stress = table.effective_stress(&[3.0, 4.0], None);
        assert!((stress - (30e3 - 0.5 * 10e3)).abs() < 1e-9);
        let stress = table.effective_stress(&[3.0, 4.0], Some(4.5));
        assert!((stress - (30e3 - 0.5 * 10e3)).abs() < 1e-9);
        let share = wet(PoreSource::Ratio(0.4));
        assert!((share.effective_stress(&[3.0, 4.0], None) - 18e3).abs() < 1e-9);
        let [least, greatest] = ground.depths(&RING.to_vec()).unwrap();
        assert!(
            least.abs() < 1e-6 && (greatest - 7.0).abs() < 1e-6,
            "{least} {greatest}"
        );
    }
}
