//! Prior knowledge of how the results of a case converge: by their kind, and by the structures in the case.

use igimp_model::{Case, Driven, LoadKind, Material, Quantity, Stage, StageKind};

use super::ResultKind;
use super::order::Convergence;

/// The result that a stage is made for, if it is made for one: its name, kind and convergence.
pub fn of_stage<const D: usize>(
    case: &Case<D>,
    number: usize,
) -> Option<(String, ResultKind, Convergence)> {
    let stage = &case.stages[number];
    let name = &stage.name;
    let searches = |stage: &&Stage| matches!(stage.kind, StageKind::StrengthReduction(_));
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
        StageKind::Displacement { .. } => Some((
            format!("largest resistance in \"{name}\" [N/m]"),
            ResultKind::LimitLoad,
            of_footings(case),
        )),
        _ if stage.stop_when.no_equilibrium => {
            let driven = Driven::planned(case, number)?;
            let control = match driven {
                Driven::Load(_) => "load factor",
                Driven::Acceleration(0) => "horizontal acceleration",
                Driven::Acceleration(1) => "acceleration across",
                Driven::Acceleration(_) => "vertical acceleration",
                Driven::Gravity => "gravity",
            };
            let name = format!("{control} at the end of \"{name}\" [-]");
            Some((name, ResultKind::LimitLoad, of_limit(case, number, driven)))
        }
        _ => None,
    }
}

/// How the limit of a control that a stage drives converges.
fn of_limit<const D: usize>(case: &Case<D>, number: usize, driven: Driven) -> Convergence {
    let planned = |_: usize| 1.0;
    let from = driven.before(case, number, &planned);
    let to = driven.after(case, number, &planned);
    if from * (to - from) < 0.0 {
        of_loads(case).of_lowered_load()
    } else {
        of_loads(case)
    }
}

/// How a check converges.
pub fn of_check<const D: usize>(case: &Case<D>, name: &str) -> Convergence {
    let check = case.checks.iter().find(|check| check.name == name);
    match check.map(|check| (check.of, check.stage)) {
        Some((Quantity::FactorOfSafety, _)) => of_loads(case),
        Some((
            of @ (Quantity::GravityFactor | Quantity::HorizontalFactor | Quantity::LoadFactor(_)),
            stage,
        )) => {
            let number = stage.unwrap_or(case.stages.len().saturating_sub(1));
            let stage = case.stages.get(number);
            match Driven::recorded_by(of) {
                Some(driven) if stage.is_some_and(|stage| stage.stop_when.no_equilibrium) => {
                    of_limit(case, number, driven)
                }
                _ => Convergence::OTHER,
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
    let varies = |material: &Material| {
        material.profiles.strength.is_some()
            || material.profiles.friction.is_some()
            || material.has_laws_by_place()
    };
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
