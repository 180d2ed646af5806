//! Water in the ground as particles find it: the conditions of a case, averaged over domains (theory, eqs. 51 and 52).

pub(crate) mod flow;
pub(crate) mod pores;
pub(crate) mod seepage;

use std::sync::Arc;

use igimp_assembly::{PoreSite, PoreState, PoreWater};
use igimp_model::{Case, Drainage, Ground, Material, PoreSource, Raster};
use igimp_seepage::Seepage;

use crate::run::state::gravity_of_weights;

/// Points and weights of Gauss, three on −1 to 1.
const ALONG: [(f64, f64); 3] = [
    (-0.774_596_669_241_483_4, 5.0 / 18.0),
    (0.0, 8.0 / 18.0),
    (0.774_596_669_241_483_4, 5.0 / 18.0),
];

/// Halvings of a column in which the end of the pressure is looked for.
const HALVINGS: usize = 16;

/// The pieces of ground of the particles.
#[derive(Clone, Debug, Default)]
pub(crate) struct Seeded<const D: usize> {
    /// Body by number.
    pub(crate) body: Vec<usize>,
    /// Centre and half-lengths by number \[m\]; empty where no water is carried along.
    pub(crate) domain: Vec<[[f64; D]; 2]>,
}

/// A place at another level.
fn at_level<const D: usize>(place: &[f64; D], level: f64) -> [f64; D] {
    let mut place = *place;
    place[D - 1] = level;
    place
}

/// Upright lines through a domain, or through one of its faces across a horizontal axis, with their weights.
fn columns<const D: usize>(
    x: &[f64; D],
    half: &[f64; D],
    face: Option<(usize, f64)>,
) -> Vec<([f64; D], f64)> {
    let mut columns = vec![(*x, 1.0)];
    for axis in 0..D - 1 {
        let places = match face {
            Some((across, side)) if across == axis => vec![(side, 1.0)],
            _ => ALONG.to_vec(),
        };
        columns = (columns.into_iter())
            .flat_map(|(column, share)| {
                places.iter().map(move |&(place, weight)| {
                    let mut column = column;
                    column[axis] += place * half[axis];
                    (column, share * weight)
                })
            })
            .collect();
    }
    columns
}

/// A condition of the water in the ground.
#[derive(Debug)]
pub(crate) struct GroundWater<const D: usize> {
    reference: Source<D>,
    /// By body: a pressure of its own.
    by_body: Vec<Option<Source<D>>>,
    /// By material: density below the table, where it is stated \[kg/m³\].
    saturated: Vec<Option<f64>>,
    /// By material: whether its law speaks of total stress.
    is_total: Vec<bool>,
    /// Density of water \[kg/m³\].
    density: f64,
    carried: bool,
    seeded: Arc<Seeded<D>>,
}

/// Pressure below an upper end that varies along x; none above it.
#[derive(Debug)]
enum Source<const D: usize> {
    Dry,
    Table {
        table: PoreSource,
        unit_weight: f64,
    },
    Points(Raster),
    Seepage {
        flow: Arc<Seepage<D>>,
        unit_weight: f64,
    },
    Ratio {
        ratio: f64,
        ground: Ground<D>,
    },
}

/// Means over a domain.
#[derive(Clone, Copy, Debug)]
struct Over<const D: usize> {
    pressure: f64,
    gradient: [f64; D],
    /// Share that is wet.
    wet: f64,
}

impl<const D: usize> Source<D> {
    /// The source of a condition, whose flow was computed where it is one of seepage, or of a body in it.
    fn of(case: &Case<D>, flow: Option<&Arc<Seepage<D>>>, source: &PoreSource) -> Self {
        match source {
            PoreSource::Dry => Self::Dry,
            PoreSource::Table(_) | PoreSource::Surface(_) | PoreSource::Drained(_) => Self::Table {
                table: source.clone(),
                unit_weight: case.water_unit_weight,
            },
            PoreSource::Points(raster) => Self::Points(raster.clone()),
            PoreSource::Seepage(_) => match flow {
                Some(flow) => Self::Seepage {
                    flow: Arc::clone(flow),
                    unit_weight: case.water_unit_weight,
                },
                None => Self::Dry,
            },
            PoreSource::Ratio(ratio) => Self::Ratio {
                ratio: *ratio,
                ground: case.ground(),
            },
        }
    }

    /// The level above which there is no pressure \[m\].
    fn top(&self, place: &[f64; D]) -> f64 {
        match self {
            Self::Dry => f64::NEG_INFINITY,
            Self::Points(_) | Self::Seepage { .. } => f64::INFINITY,
            Self::Table { table, .. } => table.table(place).unwrap_or(f64::NEG_INFINITY),
            Self::Ratio { ground, .. } => ground.surface(place).unwrap_or(f64::NEG_INFINITY),
        }
    }

    /// The level above which there is no pressure between two levels \[m\]; the lower one where that is dry.
    fn top_within(&self, place: &[f64; D], [lower, upper]: [f64; 2]) -> f64 {
        let (Self::Points(_) | Self::Seepage { .. }) = self else {
            return self.top(place).min(upper);
        };
        if self.below(place, upper) > 0.0 {
            return upper;
        }
        if self.below(place, lower) <= 0.0 {
            return lower;
        }
        let (mut wet, mut dry) = (lower, upper);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (wet + dry);
            if self.below(place, middle) > 0.0 {
                wet = middle;
            } else {
                dry = middle;
            }
        }
        wet
    }

    /// The pressure at a level of the upright line through a place, not above the top \[Pa\].
    fn below(&self, place: &[f64; D], level: f64) -> f64 {
        match self {
            Self::Dry => 0.0,
            Self::Points(raster) => raster.at([place[0], level]).max(0.0),
            Self::Seepage { flow, unit_weight } => {
                unit_weight * flow.pressure_head(&at_level(place, level)).max(0.0)
            }
            Self::Table { unit_weight, .. } => unit_weight * (self.top(place) - level),
            Self::Ratio { ratio, ground } => ratio * ground.weight_above(&at_level(place, level)),
        }
    }

    /// The pressure at a point \[Pa\].
    fn at(&self, x: &[f64; D]) -> f64 {
        if x[D - 1] < self.top(x) {
            self.below(x, x[D - 1])
        } else {
            0.0
        }
    }

    /// Means of pressure and of its vertical slope along a vertical line from `bottom` on up, and the share of the line that is
    /// wet.
    fn on_column(&self, place: &[f64; D], bottom: f64, height: f64) -> [f64; 3] {
        let top = self.top_within(place, [bottom, bottom + height]);
        if top <= bottom {
            return [0.0; 3];
        }
        let wet = top - bottom;
        let mean: f64 = [-1.0, 1.0]
            .map(|side| 0.5 * self.below(place, bottom + 0.5 * wet * (1.0 + side / 3_f64.sqrt())))
            .iter()
            .sum();
        let slope = (self.below(place, top) - self.below(place, bottom)) / height;
        [mean * wet / height, slope, wet / height]
    }

    /// Means over a domain of which soil fills a share: where soil fills less, what is wet is taken to be soil first.
    fn over(&self, x: &[f64; D], half: &[f64; D], filled: f64) -> Over<D> {
        let up = D - 1;
        let mut over = Over {
            pressure: 0.0,
            gradient: [0.0; D],
            wet: 0.0,
        };
        if matches!(self, Self::Dry) {
            return over;
        }
        let (bottom, height) = (x[up] - half[up], 2.0 * half[up]);
        for (place, weight) in columns(x, half, None) {
            let [mean, slope, wet] = self.on_column(&place, bottom, height);
            over.pressure += weight * mean;
            over.gradient[up] += weight * slope;
            over.wet += weight * wet;
        }
        for axis in 0..up {
            let [right, left] = [1.0, -1.0].map(|side| -> f64 {
                columns(x, half, Some((axis, side)))
                    .into_iter()
                    .map(|(place, weight)| weight * self.on_column(&place, bottom, height)[0])
                    .sum()
            });
            over.gradient[axis] = (right - left) / (2.0 * half[axis]);
        }
        if over.wet > 0.0 && filled < 1.0 {
            let share = (over.wet / filled).min(1.0) / over.wet;
            over.pressure *= share;
            over.gradient = over.gradient.map(|slope| slope * share);
            over.wet *= share;
        }
        over
    }
}

impl<const D: usize> GroundWater<D> {
    /// The condition of a case of that index, with its flow where seepage was computed.
    pub(crate) fn of(
        case: &Case<D>,
        index: usize,
        flow: Option<&Arc<Seepage<D>>>,
        seeded: &Arc<Seeded<D>>,
    ) -> Self {
        let condition = &case.water[index];
        let mut by_body: Vec<Option<Source<D>>> = case.bodies.iter().map(|_| None).collect();
        for (body, source) in &condition.bodies {
            by_body[*body] = Some(Source::of(case, None, source));
        }
        let gravity = gravity_of_weights(case.gravity);
        let saturated = |material: &Material| material.saturated.map(|weight| weight / gravity);
        let is_total = |material: &Material| material.drainage == Drainage::Total;
        Self {
            reference: Source::of(case, flow, &condition.source),
            by_body,
            saturated: case.materials.iter().map(saturated).collect(),
            is_total: case.materials.iter().map(is_total).collect(),
            density: case.water_unit_weight / gravity,
            carried: condition.carried,
            seeded: Arc::clone(seeded),
        }
    }

    /// The flow that was computed, if one was.
    pub(crate) fn flow(&self) -> Option<&Arc<Seepage<D>>> {
        match &self.reference {
            Source::Seepage { flow, .. } => Some(flow),
            _ => None,
        }
    }

    /// The stress of the law of a particle under level ground, tension positive \[Pa\]: the vertical stress by the weight of the
    /// ground, and the pressure of a pond above it, which acts in all directions alike on soil of total stress (theory, eq. 36c).
    pub(crate) fn at_rest(
        &self,
        ground: &Ground<D>,
        number: usize,
        material: &Material,
        x: &[f64; D],
    ) -> [f64; 2] {
        let body = self.by_body[self.seeded.body[number]].as_ref();
        let table = match body.unwrap_or(&self.reference) {
            source @ Source::Table { .. } => source.top(x),
            Source::Seepage { flow, .. } => flow.free_surface(x).unwrap_or(f64::NEG_INFINITY),
            _ => f64::NEG_INFINITY,
        };
        let surface = ground.surface(x).unwrap_or(x[D - 1]);
        let pond = self.reference.at(&at_level(x, surface));
        let weight = ground.weight_above(x) + ground.added_above(x, table);
        match material.drainage {
            Drainage::Total => [-weight, -pond],
            _ => [body.unwrap_or(&self.reference).at(x) - (weight + pond), 0.0],
        }
    }
}

impl<const D: usize> PoreWater<D> for GroundWater<D> {
    fn at(&self, site: PoreSite<'_, D>) -> PoreState<D> {
        let (x, half) = if self.carried {
            let [x, half] = &self.seeded.domain[site.number];
            (x, half)
        } else {
            (site.x, site.half_length)
        };
        let material = site.law % self.is_total.len();
        let reference = self.reference.over(x, half, site.filled);
        let water = match &self.by_body[self.seeded.body[site.number]] {
            Some(source) => source.over(x, half, site.filled),
            None => reference,
        };
        let source = self.by_body[self.seeded.body[site.number]].as_ref();
        // Shares of soil that a table saturates, and of soil whose pores are known to be full.
        let [saturated, full] = match source.unwrap_or(&self.reference) {
            Source::Table { .. } | Source::Seepage { .. } => [water.wet, water.wet],
            Source::Points(_) => [0.0, water.wet],
            Source::Dry | Source::Ratio { .. } => [0.0, 0.0],
        };
        PoreState {
            pressure: if self.is_total[material] {
                0.0
            } else {
                water.pressure
            },
            reference: reference.pressure,
            gradient: reference.gradient,
            added_density: self.saturated[material]
                .map_or(0.0, |full| saturated * (full - site.density)),
            water_density: full * self.density,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::fixture::case;
    use crate::run::Model;
    use igimp_assembly::{PoreState, PoreWater as _};
    use igimp_model::{PoreSource, WaterCondition};

    /// GOAL: a case without gravity may say that it is dry.
    #[test]
    fn ground_without_weight_may_be_dry() {
        let mut case = case();
        case.gravity = 0.0;
        case.materials[0].saturated = Some(1.1 * case.materials[0].unit_weight);
        case.water = vec![WaterCondition {
            name: "none".to_owned(),
            source: PoreSource::Dry,
            bodies: Vec::new(),
            carried: false,
        }];
        let (model, state) = Model::new(&case).unwrap();
        let water = model.ground_water(0).unwrap();
        let found = water.at(state.body.particles.pore_site(0, case.method.section));
        assert_eq!(found, PoreState::dry());
    }
}
