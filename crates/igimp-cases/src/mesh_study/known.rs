//! Prior knowledge of how the results of a case converge: by their kind, and by the structures in the case.

use igimp_model::{Case, LoadKind, Material, Quantity, Stage, StageKind};
use igimp_results::mesh_study::{Convergence, ResultKind};

/// The result that a stage is made for, if it is made for one: its name, what it is, and how it converges.
pub(super) fn of_stage<const D: usize>(
    case: &Case<D>,
    number: usize,
) -> Option<(String, ResultKind, Convergence)> {
    let stage = &case.stages[number];
    let name = &stage.name;
    let searches = |stage: &&Stage| matches!(stage.kind, StageKind::StrengthReduction(_));
    let load = |name: String| Some((name, ResultKind::LimitLoad, of_loads(case)));
    match &stage.kind {
        StageKind::StrengthReduction(_) => {
            let only = case.stages.iter().filter(searches).count() == 1;
            let of = if only {
                String::new()
            } else {
                format!(", \"{name}\"")
            };
            let name = format!("factor of safety{of} [-]");
            Some((name, ResultKind::FactorOfSafety, of_loads(case)))
        }
        StageKind::Gravity { horizontal, .. } if stage.stop_when.no_equilibrium => {
            load(match horizontal {
                Some(_) => format!("horizontal acceleration at the end of \"{name}\" [-]"),
                None => format!("gravity at the end of \"{name}\" [-]"),
            })
        }
        StageKind::Load { .. } if stage.stop_when.no_equilibrium => {
            load(format!("load factor at the end of \"{name}\" [-]"))
        }
        StageKind::Displacement { .. } => Some((
            format!("largest resistance in \"{name}\" [N/m]"),
            ResultKind::LimitLoad,
            of_footings(case),
        )),
        _ => None,
    }
}

/// How a check converges.
pub(super) fn of_check<const D: usize>(case: &Case<D>, name: &str) -> Convergence {
    let check = case.checks.iter().find(|check| check.name == name);
    match check.map(|check| (check.of, check.stage)) {
        Some((Quantity::FactorOfSafety, _)) => of_loads(case),
        Some((
            Quantity::GravityFactor | Quantity::HorizontalFactor | Quantity::LoadFactor(_),
            stage,
        )) => {
            let number = stage.unwrap_or(case.stages.len().saturating_sub(1));
            let stage = case.stages.get(number);
            if stage.is_some_and(|stage| stage.stop_when.no_equilibrium) {
                of_loads(case)
            } else {
                Convergence::OTHER
            }
        }
        Some((Quantity::Reaction(_), _)) => of_footings(case),
        Some((Quantity::Discharge(..), _)) => Convergence::OTHER,
        _ if has_contact(case) => Convergence::CONTACT,
        _ => Convergence::OTHER,
    }
}

/// How factors of safety and limit loads of soil converge in a case.
fn of_loads<const D: usize>(case: &Case<D>) -> Convergence {
    let holds_nodes =
        |load: &igimp_model::Load<D>| matches!(load.kind, LoadKind::RigidFooting { .. });
    let varies =
        |own: &Material| own.profiles.strength.is_some() || own.profiles.friction.is_some();
    if has_contact(case) {
        Convergence::CONTACT
    } else if case.loads.iter().any(holds_nodes) {
        Convergence::FOOTING
    } else if case.materials.iter().any(varies) {
        Convergence::VARIED_SOIL
    } else {
        Convergence::SOIL
    }
}

/// How the resistance of footings that hold nodes converges.
fn of_footings<const D: usize>(case: &Case<D>) -> Convergence {
    if has_contact(case) {
        Convergence::CONTACT
    } else {
        Convergence::FOOTING
    }
}

/// Whether rigid bodies touch the soil, or reinforcement holds it.
fn has_contact<const D: usize>(case: &Case<D>) -> bool {
    !(case.rigid.is_empty() && case.reinforcement.is_empty())
}
