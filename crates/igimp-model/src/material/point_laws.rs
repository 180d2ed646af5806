//! Laws of soil by its place: parameters that vary beside strength, friction and stiffness (theory, eq. 19d), and cells that several
//! soils share, with one dilation, and one stiffness where that is asked for (theory, "two soils in one cell", eq. 37b).

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use igimp_assembly::{ParticleSeed, SharedLaw};
use igimp_material::{MaterialError, Ratios};
use igimp_shape::Grid;

use super::strength::ParameterValue;
use crate::{Case, Ground, Material, MixedCells, StageKind};

/// A law that cannot be made with the parameters of a place.
#[derive(Debug, thiserror::Error)]
#[error(
    "the law of `{material}` cannot be made with its parameters at ({})",
    position.iter().map(|x| igimp_text::short((1e6 * x).round() / 1e6)).collect::<Vec<_>>().join(", ")
)]
pub struct PointError {
    /// The material.
    pub material: String,
    /// The place \[m\].
    pub position: Vec<f64>,
    /// Why.
    pub source: MaterialError,
}

/// The materials of a case by place.
struct Places<'a, const D: usize> {
    case: &'a Case<D>,
    ground: Ground<D>,
    /// By body, the materials with laws by place that it may consist of.
    varied: Vec<Vec<usize>>,
}

/// A place of a body.
type Place<'a, const D: usize> = (&'a [f64; D], usize);

impl<'a, const D: usize> Places<'a, D> {
    fn new(case: &'a Case<D>) -> Self {
        let has_laws = |index: &usize| case.materials[*index].has_laws_by_place();
        let of_body = |body| case.materials_of(body).into_iter().filter(has_laws);
        Self {
            case,
            ground: case.ground(),
            varied: (0..case.bodies.len())
                .map(|body| of_body(body).collect())
                .collect(),
        }
    }

    /// A material as it is at a place of a body; that of its constants where the body never consists of it.
    fn soil(&self, material: usize, (place, body): Place<'_, D>) -> Cow<'a, Material> {
        let stated = &self.case.materials[material];
        if self.varied[body].contains(&material) {
            stated.at(place, &self.ground)
        } else {
            Cow::Borrowed(stated)
        }
    }

    /// The values that parameters have at a place of a body: places with the same ones share their laws.
    fn values(&self, (place, body): Place<'_, D>) -> Vec<u64> {
        let of_material = |&index: &usize| {
            let values = self.case.materials[index].values_at(place, &self.ground);
            std::iter::once(index as u64).chain(values.map(|value| value.1.to_bits()))
        };
        self.varied[body].iter().flat_map(of_material).collect()
    }
}

impl<const D: usize> Case<D> {
    /// The materials that a body consists of at any time, ascending.
    pub fn materials_of(&self, body: usize) -> BTreeSet<usize> {
        let changes = self.stages.iter().flat_map(|stage| match &stage.kind {
            StageKind::Construction(plan) => plan.materials.as_slice(),
            _ => &[],
        });
        let later = changes.filter(|(of, _)| *of == body).map(|change| change.1);
        later.chain([self.bodies[body].material]).collect()
    }
}

impl<const D: usize> Case<D> {
    /// The least of the stiffness of soil over its strength, beside that of its material \[-\]: there a curve over plastic strain is
    /// nearest to snap-back. 1 where neither varies, and of soil that is in no body.
    pub fn least_stiffness_over_strength(&self, material: usize) -> f64 {
        let ground = self.ground();
        let bodies = self.bodies.iter().filter(|body| body.material == material);
        let places = bodies.flat_map(|body| ground.places_within(&*body.region));
        let over = |place: [f64; D]| {
            let ratios = self.materials[material].ratios_at(&place, &ground);
            ratios.stiffness / ratios.strength
        };
        places.map(over).fold(1.0, f64::min)
    }

    /// Whether materials have laws on cells of a height \[m\] wherever a body may consist of them, by many places.
    ///
    /// # Errors
    /// [`PointError`] for the first place where one has none.
    pub fn check_laws(&self, cell_height: f64) -> Result<(), PointError> {
        let places = Places::new(self);
        for (body, part) in self.bodies.iter().enumerate() {
            if places.varied[body].is_empty() {
                continue;
            }
            let mut seen = BTreeSet::new();
            for place in places.ground.places_within(&*part.region) {
                for &material in &places.varied[body] {
                    let soil = places.soil(material, (&place, body));
                    let stated = &self.materials[material];
                    let ratios = stated.ratios_at(&place, &places.ground);
                    let values = stated.values_at(&place, &places.ground);
                    let values = values.map(|value| value.1).chain([ratios.friction]);
                    let bits: Vec<u64> = values.map(f64::to_bits).collect();
                    if seen.insert((material, bits)) {
                        (soil.law_on(cell_height).map(drop))
                            .and_then(|()| dilates_less_than_friction((stated, &soil), ratios))
                            .map_err(at(&soil, &place))?;
                    }
                }
            }
        }
        Ok(())
    }
}

/// The soil of a cell.
#[derive(Clone, Debug, Default)]
struct SharedCell {
    /// Bodies with soil there, and the smallest dilation of that \[rad\].
    bodies: BTreeMap<usize, f64>,
    volume: f64,
    /// Volume over bulk modulus and over shear modulus.
    compliance: [f64; 2],
}

/// The difference of laws from those of the materials.
#[derive(Clone, Copy, Debug)]
struct Change {
    /// Young's modulus \[Pa\] and Poisson's ratio of the cell.
    stiffness: Option<[f64; 2]>,
    /// The largest angle of dilation \[rad\].
    dilation: Option<f64>,
}

/// Bulk and shear modulus of a material at a ratio of stiffness \[Pa\].
fn moduli(material: &Material, ratios: Ratios) -> [f64; 2] {
    let Material { young, poisson, .. } = *material;
    let young = young * ratios.stiffness;
    [
        young / (3.0 * (1.0 - 2.0 * poisson)),
        young / (2.0 * (1.0 + poisson)),
    ]
}

impl SharedCell {
    /// Young's modulus and Poisson's ratio by the inverse of the mean compliance, in bulk and in shear.
    fn stiffness(&self) -> [f64; 2] {
        let [bulk, shear] = self.compliance.map(|sum| self.volume / sum);
        [
            9.0 * bulk * shear / (3.0 * bulk + shear),
            (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear)),
        ]
    }
}

/// Gives particles the laws of their places: with the parameters that vary, and in cells with several soils with the smallest dilation of
/// the soils that are there at the same time, for their change of volume is one. With `mixed_cells = "mean"` they have one stiffness there,
/// too, by the inverse of the mean compliance of the cell. `ratios` are those of each particle to its material; that of stiffness becomes 1
/// where the law is that of the cell. `body_of` are the bodies of the particles.
///
/// Every set of values, every dilation and every cell with a stiffness appends a law for every material, in their order
/// ([`Case::number_of_material`]). Where nothing asks for that, no law is appended.
///
/// # Errors
/// [`PointError`] where such a law cannot be made.
pub fn laws_at_points<const D: usize>(
    case: &Case<D>,
    (grid, cell_height): (&Grid<D>, f64),
    (seeds, body_of, ratios): (&mut [ParticleSeed<D>], &[usize], &mut [Ratios]),
    laws: &mut Vec<SharedLaw>,
) -> Result<(), PointError> {
    let places = Places::new(case);
    let vary = places.varied.iter().any(|materials| !materials.is_empty());
    let has_one_stiffness = case.grid.mixed_cells == MixedCells::Mean;
    let mut dilations = case.materials.iter().filter_map(Material::dilation);
    let first = dilations.next();
    if !vary && !has_one_stiffness && dilations.all(|dilation| Some(dilation) == first) {
        return Ok(());
    }
    let cell_of: Vec<Option<usize>> = (seeds.iter())
        .map(|seed| grid.cell_at(&seed.x).map(|cell| grid.cell_index(cell)))
        .collect();
    let cells = shared_cells(&places, &cell_of, (seeds, body_of, ratios));
    let stages = case.bodies_by_stage();
    let mut order: Vec<usize> = (0..seeds.len()).collect();
    order.sort_by_key(|&particle| (cell_of[particle], body_of[particle]));
    let mut points: BTreeMap<Vec<u64>, usize> = BTreeMap::new();
    let mut sets = BTreeMap::new();
    for particle in order {
        let (body, x) = (body_of[particle], seeds[particle].x);
        let place = (&x, body);
        let material = seeds[particle].law;
        let soil = places.soil(material, place);
        let both = (&case.materials[material], &*soil);
        dilates_less_than_friction(both, ratios[particle]).map_err(at(&soil, &x))?;
        let values = places.values(place);
        let next = points.len();
        let point = (!values.is_empty()).then(|| *points.entry(values).or_insert(next));
        let index = cell_of[particle].filter(|index| cells.contains_key(index));
        let cell = index.map(|index| &cells[&index]);
        let change = Change {
            stiffness: (cell.filter(|_| has_one_stiffness)).map(SharedCell::stiffness),
            dilation: cell.and_then(|cell| {
                let is_beside = |other: usize| stages.iter().any(|has| has[body] && has[other]);
                let others = cell.bodies.iter().filter(|other| is_beside(*other.0));
                let least = others.map(|other| *other.1).fold(f64::INFINITY, f64::min);
                soil.dilation().filter(|most| least < *most).map(|_| least)
            }),
        };
        let by_cell = index.filter(|_| has_one_stiffness);
        let key = (point, by_cell, change.dilation.map(f64::to_bits));
        if key == (None, None, None) {
            continue;
        }
        let set = match sets.get(&key) {
            Some(&set) => set,
            None => append(laws, (&places, place), change, cell_height)?,
        };
        sets.insert(key, set);
        seeds[particle].law += set;
        if by_cell.is_some() {
            ratios[particle].stiffness = 1.0;
        }
    }
    Ok(())
}

/// The cells with several materials, by their index.
fn shared_cells<const D: usize>(
    places: &Places<'_, D>,
    cell_of: &[Option<usize>],
    (seeds, body_of, ratios): (&[ParticleSeed<D>], &[usize], &[Ratios]),
) -> BTreeMap<usize, SharedCell> {
    let mut cells: BTreeMap<usize, SharedCell> = BTreeMap::new();
    for (particle, seed) in seeds.iter().enumerate() {
        let Some(cell) = cell_of[particle] else {
            continue;
        };
        let cell = cells.entry(cell).or_default();
        let body = body_of[particle];
        let soil = places.soil(seed.law, (&seed.x, body));
        let least = cell.bodies.entry(body).or_insert(f64::INFINITY);
        *least = soil.dilation().map_or(*least, |angle| angle.min(*least));
        cell.volume += seed.volume;
        let moduli = moduli(&soil, ratios[particle]);
        for (sum, modulus) in cell.compliance.iter_mut().zip(moduli) {
            *sum += seed.volume / modulus;
        }
    }
    let material = |body: &usize| places.case.bodies[*body].material;
    cells.retain(|_, cell| {
        let materials: BTreeSet<usize> = cell.bodies.keys().map(material).collect();
        materials.len() > 1
    });
    cells
}

/// Refuses a dilation that varies and is above the friction of its place; a constant one is cut off there.
fn dilates_less_than_friction(
    (material, soil): (&Material, &Material),
    ratios: Ratios,
) -> Result<(), MaterialError> {
    let varies = material.profiles.of_parameter("dilation").is_some();
    if !(varies && ratios.has_friction_of_its_own()) {
        return Ok(());
    }
    let mut parameters = soil.strength.parameters().into_iter();
    let dilation = parameters.find_map(|parameter| match parameter.value {
        ParameterValue::Angle(value) if parameter.key == "dilation" => Some(value),
        _ => None,
    });
    let friction = soil.strength.friction_angle();
    match (dilation, friction) {
        (Some(dilation), Some(friction))
            if dilation.tan() > friction.tan() * ratios.friction * (1.0 + 1e-12) =>
        {
            Err(MaterialError::InvalidParameter {
                field: "dilation",
                value: (1e3 * dilation.to_degrees()).round() / 1e3,
                requirement: "at most the friction angle of the place, in degrees",
            })
        }
        _ => Ok(()),
    }
}

/// An error of a law at a place.
fn at<'a>(
    material: &'a Material,
    place: &'a [f64],
) -> impl Fn(MaterialError) -> PointError + use<'a> {
    |source| PointError {
        material: material.name.clone(),
        position: place.to_vec(),
        source,
    }
}

/// Appends the laws of all materials as they are at a place, with a change; the number of the first.
fn append<const D: usize>(
    laws: &mut Vec<SharedLaw>,
    (places, place): (&Places<'_, D>, Place<'_, D>),
    change: Change,
    cell_height: f64,
) -> Result<usize, PointError> {
    let first = laws.len();
    for material in 0..places.case.materials.len() {
        let soil = places.soil(material, place);
        if let (Cow::Borrowed(_), None, None) = (&soil, change.stiffness, change.dilation) {
            laws.push(Arc::clone(&laws[material]));
            continue;
        }
        let mut soil = soil.into_owned();
        if let Some(stiffness) = change.stiffness {
            [soil.young, soil.poisson] = stiffness;
        }
        if let Some(most) = change.dilation {
            soil = soil.dilating_up_to(most);
        }
        let law = soil.law_on(cell_height).map_err(at(&soil, place.0))?;
        laws.push(law);
    }
    Ok(first)
}
