//! Water in the ground as particles find it: the conditions of a case, averaged over domains (theory, eqs. 51 and 52).

use std::sync::Arc;

use igimp_assembly::{PoreSite, PoreState, PoreWater};

use super::model::gravity_of_weights;
use crate::case::{
    Case, Drainage, Ground, Material, PoreSource, Raster, WaterCondition, table_level,
};

/// Points and weights of Gauss, three on −1 to 1.
const ALONG: [(f64, f64); 3] = [
    (-0.774_596_669_241_483_4, 5.0 / 18.0),
    (0.0, 8.0 / 18.0),
    (0.774_596_669_241_483_4, 5.0 / 18.0),
];

/// Halvings of a column in which the end of the pressure is looked for.
const HALVINGS: usize = 16;

/// What pieces of ground the particles were seeded in.
#[derive(Clone, Debug, Default)]
pub(crate) struct Seeded {
    /// Body by number.
    pub(crate) body: Vec<usize>,
    /// Centre and half-lengths by number \[m\]; empty where no water is carried along.
    pub(crate) domain: Vec<[[f64; 2]; 2]>,
}

/// A condition of the water in the ground.
#[derive(Debug)]
pub(crate) struct GroundWater {
    reference: Source,
    /// By body: a pressure of its own.
    own: Vec<Option<Source>>,
    /// By material: density that water adds below the table \[kg/m³\].
    added_density: Vec<f64>,
    /// By material: whether its law speaks of total stress.
    is_total: Vec<bool>,
    /// Density of water \[kg/m³\].
    density: f64,
    carried: bool,
    seeded: Arc<Seeded>,
}

/// Pressure below an upper end that varies along x; none above it.
#[derive(Debug)]
enum Source {
    Dry,
    Table {
        points: Vec<[f64; 2]>,
        unit_weight: f64,
    },
    Points(Raster),
    Ratio {
        ratio: f64,
        ground: Ground,
    },
}

/// Means over a domain.
#[derive(Clone, Copy, Debug, Default)]
struct Over {
    pressure: f64,
    gradient: [f64; 2],
    /// Share that is wet.
    wet: f64,
}

impl Source {
    fn of(case: &Case, source: &PoreSource) -> Self {
        match source {
            PoreSource::Dry => Self::Dry,
            PoreSource::Table(points) => Self::Table {
                points: points.clone(),
                unit_weight: case.water_unit_weight,
            },
            PoreSource::Points(raster) => Self::Points(raster.clone()),
            PoreSource::Ratio(ratio) => Self::Ratio {
                ratio: *ratio,
                ground: case.ground(),
            },
        }
    }

    /// The level above which there is no pressure \[m\].
    fn top(&self, x: f64) -> f64 {
        match self {
            Self::Dry => f64::NEG_INFINITY,
            Self::Points(_) => f64::INFINITY,
            Self::Table { points, .. } => table_level(points, x),
            Self::Ratio { ground, .. } => ground.surface(x).unwrap_or(f64::NEG_INFINITY),
        }
    }

    /// The level above which there is no pressure between two levels \[m\]; the lower one where there is none at all.
    fn top_within(&self, x: f64, [lower, upper]: [f64; 2]) -> f64 {
        let Self::Points(_) = self else {
            return self.top(x).min(upper);
        };
        if self.below(x, upper) > 0.0 {
            return upper;
        }
        let (mut wet, mut dry) = (lower, upper);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (wet + dry);
            if self.below(x, middle) > 0.0 {
                wet = middle;
            } else {
                dry = middle;
            }
        }
        if self.below(x, wet) > 0.0 { wet } else { lower }
    }

    /// The pressure at a point that is not above the top \[Pa\].
    fn below(&self, x: f64, y: f64) -> f64 {
        match self {
            Self::Dry => 0.0,
            Self::Points(raster) => raster.at([x, y]).max(0.0),
            Self::Table {
                points,
                unit_weight,
            } => unit_weight * (table_level(points, x) - y),
            Self::Ratio { ratio, ground } => ratio * ground.weight_above([x, y]),
        }
    }

    /// The pressure at a point \[Pa\].
    fn at(&self, x: &[f64; 2]) -> f64 {
        if x[1] < self.top(x[0]) {
            self.below(x[0], x[1])
        } else {
            0.0
        }
    }

    /// Means of pressure and of its vertical slope along a vertical line from `bottom` on up, and the share of the line that is
    /// wet.
    fn on_column(&self, x: f64, bottom: f64, height: f64) -> [f64; 3] {
        let top = self.top_within(x, [bottom, bottom + height]);
        if top <= bottom {
            return [0.0; 3];
        }
        let wet = top - bottom;
        let mean: f64 = [-1.0, 1.0]
            .map(|side| 0.5 * self.below(x, bottom + 0.5 * wet * (1.0 + side / 3_f64.sqrt())))
            .iter()
            .sum();
        let slope = (self.below(x, top) - self.below(x, bottom)) / height;
        [mean * wet / height, slope, wet / height]
    }

    /// Means over a domain of which soil fills a share: where soil fills less, what is wet is taken to be soil first.
    fn over(&self, x: &[f64; 2], half: &[f64; 2], filled: f64) -> Over {
        if matches!(self, Self::Dry) {
            return Over::default();
        }
        let (bottom, height) = (x[1] - half[1], 2.0 * half[1]);
        let mut over = Over::default();
        for (place, weight) in ALONG {
            let [mean, slope, wet] = self.on_column(x[0] + place * half[0], bottom, height);
            over.pressure += weight * mean;
            over.gradient[1] += weight * slope;
            over.wet += weight * wet;
        }
        let [right, left] =
            [1.0, -1.0].map(|side| self.on_column(x[0] + side * half[0], bottom, height)[0]);
        over.gradient[0] = (right - left) / (2.0 * half[0]);
        if over.wet > 0.0 && filled < 1.0 {
            let share = (over.wet / filled).min(1.0) / over.wet;
            over.pressure *= share;
            over.gradient = over.gradient.map(|slope| slope * share);
            over.wet *= share;
        }
        over
    }
}

impl GroundWater {
    /// A condition of a case.
    pub(crate) fn of(case: &Case, condition: &WaterCondition, seeded: &Arc<Seeded>) -> Self {
        let mut own: Vec<Option<Source>> = case.bodies.iter().map(|_| None).collect();
        for (body, source) in &condition.bodies {
            own[*body] = Some(Source::of(case, source));
        }
        let gravity = gravity_of_weights(case.gravity);
        let added = |material: &Material| material.added_by_water() / gravity;
        let is_total = |material: &Material| material.drainage == Drainage::Total;
        Self {
            reference: Source::of(case, &condition.source),
            own,
            added_density: case.materials.iter().map(added).collect(),
            is_total: case.materials.iter().map(is_total).collect(),
            density: case.water_unit_weight / gravity,
            carried: condition.carried,
            seeded: Arc::clone(seeded),
        }
    }

    /// Vertical stress that the law of a particle speaks of under level ground, tension positive \[Pa\].
    pub(crate) fn effective_weight(
        &self,
        ground: &Ground,
        number: usize,
        material: &Material,
        x: &[f64; 2],
    ) -> f64 {
        let own = self.own[self.seeded.body[number]].as_ref();
        let table = match own.unwrap_or(&self.reference) {
            source @ Source::Table { .. } => source.top(x[0]),
            _ => f64::NEG_INFINITY,
        };
        let surface = ground.surface(x[0]).unwrap_or(x[1]);
        let pond = self.reference.at(&[x[0], surface]);
        let total = ground.weight_above(*x) + ground.added_above(*x, table) + pond;
        let pores = match material.drainage {
            Drainage::Total => 0.0,
            _ => own.unwrap_or(&self.reference).at(x),
        };
        pores - total
    }
}

impl PoreWater<2> for GroundWater {
    fn at(&self, site: PoreSite<'_, 2>) -> PoreState<2> {
        let (x, half) = if self.carried {
            let [x, half] = &self.seeded.domain[site.number];
            (x, half)
        } else {
            (site.x, site.half_length)
        };
        let material = site.law % self.is_total.len();
        let reference = self.reference.over(x, half, site.filled);
        let own = match &self.own[self.seeded.body[site.number]] {
            Some(own) => own.over(x, half, site.filled),
            None => reference,
        };
        let source = self.own[self.seeded.body[site.number]].as_ref();
        // Shares of soil that a table saturates, and of soil whose pores are known to be full.
        let [saturated, full] = match source.unwrap_or(&self.reference) {
            Source::Table { .. } => [own.wet, own.wet],
            Source::Points(_) => [0.0, own.wet],
            Source::Dry | Source::Ratio { .. } => [0.0, 0.0],
        };
        PoreState {
            pressure: if self.is_total[material] {
                0.0
            } else {
                own.pressure
            },
            reference: reference.pressure,
            gradient: reference.gradient,
            added_density: saturated * self.added_density[material],
            water_density: full * self.density,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::case::{PoreSource, WaterCondition};
    use crate::estimate::tests::case;
    use crate::run::Model;
    use igimp_assembly::{PoreState, PoreWater as _};

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
        let found = water.at(state.body.particles.pore_site(0));
        assert_eq!(found, PoreState::dry());
    }
}
