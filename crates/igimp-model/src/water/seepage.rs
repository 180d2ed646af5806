//! Seepage as a case states it, steady or in time.

use igimp_geometry::region::Region;
use igimp_seepage::{Conditions, Extent, History, InGround, Named, Soil};

use super::PoreSource;
use crate::{Case, Material};

/// A flow in time, and one moment of it.
#[derive(Clone, Debug, PartialEq)]
pub struct InTime {
    /// The condition whose steady flow is that at the time 0, by index.
    pub start: usize,
    /// By condition on faces: its head \[m\] or its rain \[m/s\] in time; none: it stays.
    pub histories: Vec<Option<History>>,
    /// Time after the start \[s\].
    pub time: f64,
}

/// Seepage that is to be computed.
#[derive(Clone, Debug, PartialEq)]
pub struct SeepageCase {
    /// Conditions, with corners in space; in the plane their third entries say nothing. Of soils those of regions alone.
    pub conditions: Conditions<3>,
    /// The levels of free water, by a water table; none where boxes say it all.
    pub free_water: Option<PoreSource>,
    /// The moment of a flow in time; none: the flow is steady.
    pub in_time: Option<InTime>,
}

impl SeepageCase {
    /// The conditions with the soils of materials, by their index, and those of regions behind them; soil without a
    /// permeability of its own is not there. Storage of soil below the free surface follows from its stiffness and the unit
    /// weight of water \[N/m³\].
    pub fn with_soils<const D: usize>(
        &self,
        materials: &[Material],
        water_unit_weight: f64,
    ) -> Conditions<D> {
        let stated = &self.conditions;
        let soil = |material: &Material| Soil {
            specific_storage: water_unit_weight / material.constrained_modulus(),
            ..material.permeability.unwrap_or(Soil::isotropic(1.0))
        };
        let of_materials = materials.iter().map(soil);
        let behind = |condition: InGround| match condition {
            InGround::Soil(number) => InGround::Soil(materials.len() + number),
            other => other,
        };
        Conditions {
            soils: of_materials.chain(stated.soils.iter().copied()).collect(),
            faces: (stated.faces.iter())
                .map(|named| Named {
                    name: named.name.clone(),
                    within: extent(&named.within),
                    condition: named.condition,
                })
                .collect(),
            regions: (stated.regions.iter())
                .map(|named| Named {
                    name: named.name.clone(),
                    within: extent(&named.within),
                    condition: behind(named.condition),
                })
                .collect(),
            sections: (stated.sections.iter())
                .map(|(name, within)| (name.clone(), extent(within)))
                .collect(),
            axisymmetric: stated.axisymmetric,
            confined: stated.confined,
            width: stated.width,
            floor: stated.floor,
        }
    }
}

/// The first corners of an extent in space.
fn extent<const D: usize>(extent: &Extent<3>) -> Extent<D> {
    let first = |corner: [f64; 3]| std::array::from_fn(|axis| corner[axis]);
    Extent {
        lower: first(extent.lower),
        upper: first(extent.upper),
    }
}

impl<const D: usize> Case<D> {
    /// The time of the water at the end of a stage, where it is that of a flow in time \[s\].
    pub fn time_of_water_after(&self, stage: usize) -> Option<f64> {
        match &self.water[self.water_after(stage)?].source {
            PoreSource::Seepage(flow) => Some(flow.in_time.as_ref()?.time),
            _ => None,
        }
    }

    /// The bodies through which the water of a condition flows with their materials, both by index: those that are there at
    /// the end of the first stage in which it holds, or from the start.
    pub fn bodies_of_water(&self, condition: usize) -> Vec<(&dyn Region<D>, usize)> {
        let first =
            (0..self.stages.len()).find(|&stage| self.water_after(stage) == Some(condition));
        let there = match first {
            Some(stage) if condition > 0 => self.bodies_after(stage),
            _ => self.bodies.iter().map(|body| body.from_start).collect(),
        };
        let until = first.filter(|_| condition > 0);
        let bodies = self
            .bodies
            .iter()
            .enumerate()
            .filter(|(body, _)| there[*body]);
        bodies
            .map(|(body, part)| {
                (
                    &*part.region as &dyn Region<D>,
                    self.material_after(until, body),
                )
            })
            .collect()
    }
}
