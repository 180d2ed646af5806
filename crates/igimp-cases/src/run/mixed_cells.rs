//! One stiffness for the particles of a cell that several soils share (theory, eq. 37b).

use igimp_assembly::{ParticleSeed, SharedLaw};
use igimp_material::Ratios;
use igimp_model::{Case, Material};
use igimp_shape::Grid;

use crate::error::CaseError;

/// Volume and compliances of the soils in a cell.
#[derive(Clone, Copy, Debug)]
struct Share {
    /// Material of the first particle.
    material: usize,
    is_mixed: bool,
    volume: f64,
    /// Volume over bulk modulus and over shear modulus.
    compliance: [f64; 2],
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

/// Gives the particles of cells with several soils the inverse of the mean compliance of their cell, by
/// volume, in bulk and in shear. Strength stays that of their own soil. `ratios` are those of each particle to its
/// material; that of stiffness becomes 1 where the law is that of the cell.
///
/// Each such cell appends a law for every material, in their order ([`Case::number_of_material`]).
pub(super) fn share_stiffness<const D: usize>(
    case: &Case<D>,
    (grid, cell_height): (&Grid<D>, f64),
    (seeds, ratios): (&mut [ParticleSeed<D>], &mut [Ratios]),
    laws: &mut Vec<SharedLaw>,
) -> Result<(), CaseError> {
    let cell_of = |seed: &ParticleSeed<D>| grid.cell_at(&seed.x).map(|cell| grid.cell_index(cell));
    let mut shares: Vec<Option<Share>> = vec![None; grid.cell_count()];
    for (seed, ratios) in std::iter::zip(&*seeds, &*ratios) {
        let Some(cell) = cell_of(seed) else { continue };
        let share = shares[cell].get_or_insert(Share {
            material: seed.law,
            is_mixed: false,
            volume: 0.0,
            compliance: [0.0; 2],
        });
        share.is_mixed |= share.material != seed.law;
        share.volume += seed.volume;
        let moduli = moduli(&case.materials[seed.law], *ratios);
        for (sum, modulus) in share.compliance.iter_mut().zip(moduli) {
            *sum += seed.volume / modulus;
        }
    }
    let mut first_laws = vec![None; grid.cell_count()];
    for (cell, share) in shares.iter().enumerate() {
        let Some(share) = share.filter(|share| share.is_mixed) else {
            continue;
        };
        let [bulk, shear] = share.compliance.map(|sum| share.volume / sum);
        first_laws[cell] = Some(laws.len());
        for material in &case.materials {
            let shared = Material {
                young: 9.0 * bulk * shear / (3.0 * bulk + shear),
                poisson: (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear)),
                ..material.clone()
            };
            laws.push(shared.law_as_given(cell_height)?);
        }
    }
    for (seed, ratios) in std::iter::zip(seeds, ratios) {
        if let Some(first) = cell_of(seed).and_then(|cell| first_laws[cell]) {
            seed.law += first;
            ratios.stiffness = 1.0;
        }
    }
    Ok(())
}
