//! Shares in a factor of safety: those of materials in the dissipation of the last step of its path, the changes
//! of the factor with each strength, and the factor by the kinematic theorem (theory, eqs. 33g to 33i).

use igimp_assembly::{AssemblyError, Method, SharedLaw, StepConditions, StepWork};
use igimp_material::{ConstitutiveModel, MaterialError};
use igimp_results::summary::{Kinematic, MaterialShare, StrengthShares};
use igimp_solver::{Body, Increment, StepFailure, Workspace};

use crate::run::model::Model;

/// Relative change of a strength in a difference quotient \[-\].
const DIFFERENCE: f64 = 1e-6;

/// A step that dissipates less of its gross work than this dissipates nothing, as soil without cohesion at ψ = φ \[-\].
const LEAST_DISSIPATED: f64 = 1e-3;

/// A field that misses more of its work than this is no plastic flow by the normality rule, as where ψ < φ \[-\].
const LARGEST_MISSED: f64 = 0.1;

/// The last step of a path.
pub(super) struct LastStep<'a, const D: usize> {
    pub(super) model: &'a Model<'a, D>,
    pub(super) method: &'a Method,
    /// The body before it.
    pub(super) body: &'a Body<D>,
    /// Nodal step displacements \[length\].
    pub(super) u: &'a [[f64; D]],
    /// Work of the step.
    pub(super) work: &'a StepWork,
    /// Work of the external force on it \[force·length\].
    pub(super) external_work: f64,
    /// Gross work of the external force on it \[force·length\].
    pub(super) gross_work: f64,
    /// Strength reduction factors, by material.
    pub(super) srf: &'a [f64],
    /// Materials whose strength is reduced.
    pub(super) reduced: &'a [usize],
    /// The factor that it reached \[-\].
    pub(super) factor: f64,
    /// Conditions at a factor at its end.
    pub(super) at: &'a dyn Fn(f64) -> Result<StepConditions<D>, AssemblyError>,
}

/// A strength of a material.
#[derive(Clone, Copy, PartialEq)]
enum Parameter {
    /// All of it.
    Whole,
    /// tan φ.
    Friction,
}

/// The shares in the factor of safety of a last step.
pub(super) fn shares<const D: usize>(
    step: &LastStep<'_, D>,
    workspace: &mut Workspace<D>,
) -> Result<StrengthShares, StepFailure> {
    let materials = &step.model.case.materials;
    let conditions = (step.at)(step.factor)?;
    let mut asked = Vec::new();
    let mut beside = Vec::new();
    for material in 0..materials.len() {
        for parameter in [Parameter::Whole, Parameter::Friction] {
            if let Some(laws) = step.stronger(&conditions, material, parameter)? {
                asked.push((material, parameter));
                let mut stronger = conditions.clone();
                stronger.laws = laws;
                beside.push(stronger);
            }
        }
    }
    let increment = Increment {
        body: step.body,
        method: step.method,
        conditions: &conditions,
        u: step.u,
    };
    let by_factor = (step.at)(step.factor * (1.0 + DIFFERENCE))?;
    let changes = increment.sensitivity(&by_factor, &beside, workspace)?;
    let change = |material: usize, parameter: Parameter| {
        let place = asked.iter().position(|key| *key == (material, parameter))?;
        Some(changes[place])
    };
    let dissipated = step.dissipated();
    let whole: f64 = dissipated.iter().sum::<f64>() + step.work.in_reinforcement;
    let share = |dissipated: f64| {
        let is_known = whole > LEAST_DISSIPATED * step.gross_work;
        if is_known { dissipated / whole } else { 0.0 }
    };
    let of_material = |(number, dissipated): (usize, &f64)| {
        let strength = change(number, Parameter::Whole)?;
        let friction = change(number, Parameter::Friction);
        Some(MaterialShare {
            material: materials[number].name.clone(),
            is_reduced: step.reduced.contains(&number),
            dissipation: share(*dissipated),
            cohesion: strength - friction.unwrap_or(0.0),
            friction,
        })
    };
    let plastic = step.external_work - step.work.in_reinforcement;
    let kinematic = if step.body.rigid.is_empty() {
        increment.kinematic_factor(plastic, step.factor, step.at)?
    } else {
        None
    };
    Ok(StrengthShares {
        materials: (dissipated.iter().enumerate())
            .filter_map(of_material)
            .collect(),
        reinforcement: share(step.work.in_reinforcement),
        kinematic: kinematic
            .filter(|found| found.missed <= LARGEST_MISSED)
            .map(|found| Kinematic {
                factor: found.factor,
                missed: found.missed,
            }),
    })
}

impl<const D: usize> LastStep<'_, D> {
    /// Dissipation by material \[force·length\].
    fn dissipated(&self) -> Vec<f64> {
        let case = self.model.case;
        let mut dissipated = vec![0.0; case.materials.len()];
        for (law, energy) in self.work.dissipated.iter().enumerate() {
            dissipated[case.number_of_material(law)] += energy;
        }
        dissipated
    }

    /// The laws of the step with a strength of one material a little greater; none if it has no such strength.
    fn stronger(
        &self,
        conditions: &StepConditions<D>,
        material: usize,
        parameter: Parameter,
    ) -> Result<Option<Vec<SharedLaw>>, AssemblyError> {
        let case = self.model.case;
        let mut laws = conditions.laws.clone();
        let is_asked = |law: &usize| case.number_of_material(*law) == material;
        for number in (0..laws.len()).filter(is_asked) {
            let given: &dyn ConstitutiveModel = &*self.model.laws[number];
            let stronger = stronger(given, self.srf[material], parameter)
                .map_err(|source| AssemblyError::Law { source })?;
            let Some(law) = stronger else {
                return Ok(None);
            };
            laws[number] = law;
        }
        Ok(Some(laws))
    }
}

/// A law at a strength reduction factor with a strength a little greater than given; none if it has none.
fn stronger(
    law: &dyn ConstitutiveModel,
    srf: f64,
    parameter: Parameter,
) -> Result<Option<SharedLaw>, MaterialError> {
    if !law.yields() {
        return Ok(None);
    }
    match parameter {
        Parameter::Whole => match law.reduced(srf / (1.0 + DIFFERENCE)) {
            Err(MaterialError::NoReduction { .. }) => Ok(None),
            reduced => reduced.map(Some),
        },
        Parameter::Friction => match law.at_friction(1.0 + DIFFERENCE)? {
            Some(law) => law.reduced(srf).map(Some),
            None => Ok(None),
        },
    }
}

#[cfg(test)]
mod tests {
    use igimp_material::{CamClayParameters, ModifiedCamClay, ShearStiffness};

    use super::*;

    /// GOAL: soil whose strength is not reduced has no share, and does not end the search beside it.
    #[test]
    fn clay_whose_strength_is_not_reduced_has_no_share() {
        let clay = ModifiedCamClay::new(CamClayParameters {
            compression: 0.1,
            swelling: 0.02,
            critical_ratio: 1.0,
            shear: ShearStiffness::Poisson(0.2),
            overconsolidation: 1.0,
            reference_pressure: 1e5,
        });
        let clay = clay.unwrap();
        for parameter in [Parameter::Whole, Parameter::Friction] {
            assert!(stronger(&clay, 1.0, parameter).unwrap().is_none());
        }
    }
}
