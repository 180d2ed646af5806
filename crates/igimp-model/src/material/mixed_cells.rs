//! Laws of soil in cells that several soils share: one dilation, and one stiffness where that is asked for (theory, "two soils in one
//! cell", eq. 37b).

use std::collections::BTreeMap;

use igimp_assembly::{ParticleSeed, SharedLaw};
use igimp_material::{MaterialError, Ratios};
use igimp_shape::Grid;

use crate::{Case, Material, MixedCells};

/// The soil of a cell.
#[derive(Clone, Debug, Default)]
struct SharedCell {
    /// Bodies with soil there.
    bodies: Vec<usize>,
    volume: f64,
    /// Volume over bulk modulus and over shear modulus.
    compliance: [f64; 2],
}

/// What the laws of soil in a cell differ by from those of its materials.
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

/// Gives particles of cells with several soils the smallest dilation of the soils that are there at the same time: their change of
/// volume is one. With `mixed_cells = "mean"` they have one stiffness, too, by the inverse of the mean compliance of the cell.
/// Strength stays that of their own soil. `ratios` are those of each particle to its material; that of stiffness becomes 1 where the
/// law is that of the cell. `body_of` are the bodies of the particles.
///
/// Every dilation, or every cell with a stiffness, appends a law for every material, in their order ([`Case::number_of_material`]).
///
/// # Errors
/// [`MaterialError`] where such a law cannot be made.
pub fn share_cells<const D: usize>(
    case: &Case<D>,
    (grid, cell_height): (&Grid<D>, f64),
    (seeds, body_of, ratios): (&mut [ParticleSeed<D>], &[usize], &mut [Ratios]),
    laws: &mut Vec<SharedLaw>,
) -> Result<(), MaterialError> {
    let has_one_stiffness = case.grid.mixed_cells == MixedCells::Mean;
    let mut dilations = case.materials.iter().filter_map(Material::dilation);
    let first = dilations.next();
    if !has_one_stiffness && dilations.all(|own| Some(own) == first) {
        return Ok(());
    }
    let cell_of = |seed: &ParticleSeed<D>| grid.cell_at(&seed.x).map(|cell| grid.cell_index(cell));
    let mut cells: BTreeMap<usize, SharedCell> = BTreeMap::new();
    for ((seed, ratios), body) in std::iter::zip(&*seeds, &*ratios).zip(body_of) {
        let Some(cell) = cell_of(seed) else { continue };
        let cell = cells.entry(cell).or_default();
        if !cell.bodies.contains(body) {
            cell.bodies.push(*body);
        }
        cell.volume += seed.volume;
        let moduli = moduli(&case.materials[seed.law], *ratios);
        for (sum, modulus) in cell.compliance.iter_mut().zip(moduli) {
            *sum += seed.volume / modulus;
        }
    }
    let material = |body: usize| case.bodies[body].material;
    cells.retain(|_, cell| {
        cell.bodies
            .iter()
            .any(|&own| material(own) != material(cell.bodies[0]))
    });
    let stages = case.bodies_by_stage();
    let mut sets: BTreeMap<(Option<usize>, Option<u64>), usize> = BTreeMap::new();
    let mut first_laws: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for (&index, cell) in &cells {
        for &body in &cell.bodies {
            let is_beside =
                |other: &&usize| stages.iter().any(|there| there[body] && there[**other]);
            let others = cell.bodies.iter().filter(is_beside);
            let dilation = others.filter_map(|&own| case.materials[material(own)].dilation());
            let least = dilation.fold(f64::INFINITY, f64::min);
            let own = case.materials[material(body)].dilation();
            let change = Change {
                stiffness: has_one_stiffness.then(|| cell.stiffness()),
                dilation: own.filter(|&own| least < own).map(|_| least),
            };
            if change.stiffness.is_none() && change.dilation.is_none() {
                continue;
            }
            let key = (
                has_one_stiffness.then_some(index),
                change.dilation.map(f64::to_bits),
            );
            let set = match sets.get(&key) {
                Some(&set) => set,
                None => append(laws, &case.materials, change, cell_height)?,
            };
            sets.insert(key, set);
            first_laws.insert((index, body), set);
        }
    }
    for ((seed, ratios), &body) in seeds.iter_mut().zip(ratios).zip(body_of) {
        if let Some(first) = cell_of(seed).and_then(|cell| first_laws.get(&(cell, body))) {
            seed.law += first;
            if has_one_stiffness {
                ratios.stiffness = 1.0;
            }
        }
    }
    Ok(())
}

/// Appends the laws of all materials with a change; the number of the first.
fn append(
    laws: &mut Vec<SharedLaw>,
    materials: &[Material],
    change: Change,
    cell_height: f64,
) -> Result<usize, MaterialError> {
    let first = laws.len();
    for material in materials {
        let mut own = material.clone();
        if let Some(stiffness) = change.stiffness {
            [own.young, own.poisson] = stiffness;
        }
        if let Some(most) = change.dilation {
            own = own.dilating_up_to(most);
        }
        laws.push(own.law_on(cell_height)?);
    }
    Ok(first)
}
