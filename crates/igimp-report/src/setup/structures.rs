//! Rigid bodies and reinforcement in words.

use std::fmt::Write as _;

use igimp_assembly::Tension;
use igimp_model::{
    Adhesion, Case, Dynamic, ReinforcementPart, RigidPart, RigidShear, StageKind, distance,
};
use igimp_results::summary::SetupTable;
use igimp_text::short;

use super::stages::drives_in_words;
use super::{corners, kilo, point, table};

pub(super) fn rigid_bodies<const D: usize>(case: &Case<D>) -> SetupTable {
    let header = [
        "Rigid body",
        "Shape [m]",
        "Size [m]",
        "Reference point [m]",
        "Interface",
        "Tension",
        if case.is_whole() {
            "Weight [kN]"
        } else {
            "Weight [kN/m]"
        },
        "Moved in stages",
    ];
    let rows = case.rigid.iter().enumerate();
    let rows = rows.map(|(index, part)| rigid_body(case, index, part));
    table("Rigid bodies", &header, rows.collect())
}

fn rigid_body<const D: usize>(case: &Case<D>, index: usize, part: &RigidPart<D>) -> Vec<String> {
    let [shape, size] = part.shape.words();
    let shear = |side: usize| shear(part.interfaces[side].shear);
    let tension = |side: usize| tension(part.interfaces[side].tension);
    let mut weight = short(part.weight / 1e3);
    if part.weight > 0.0 && part.arm().iter().any(|offset| *offset != 0.0) {
        let _ = write!(weight, " at {}", point(part.centre_of_mass));
    }
    if (part.force_factor - 1.0).abs() > 0.0 {
        let factor = short(part.force_factor);
        let _ = write!(weight, "; forces are those modelled times {factor}");
    }
    let mut moved = Vec::new();
    if part.from_start {
        moved.push("there from the start".to_owned());
    }
    for stage in &case.stages {
        let (StageKind::Rigid(moves) | StageKind::Dynamic(Dynamic { bodies: moves, .. })) =
            &stage.kind
        else {
            continue;
        };
        for motion in moves.iter().filter(|motion| motion.body == index) {
            moved.push(format!("{}: {}", stage.name, drives_in_words(case, motion)));
        }
    }
    let names = match part.shape.sides() {
        [] => (1..=part.interfaces.len())
            .map(|side| format!("side {side}"))
            .collect(),
        named => named.iter().map(ToString::to_string).collect::<Vec<_>>(),
    };
    vec![
        part.name.clone(),
        shape,
        size,
        point(part.reference),
        by_side(&names, shear),
        by_side(&names, tension),
        weight,
        moved.join("; "),
    ]
}

/// The interface of all sides, or of each side; the most common one is stated once, last.
fn by_side(names: &[String], of: impl Fn(usize) -> String) -> String {
    let each: Vec<String> = (0..names.len()).map(of).collect();
    let count = |text: &String| each.iter().filter(|other| *other == text).count();
    let Some(most) = each.iter().rev().max_by_key(|text| count(text)) else {
        return String::new();
    };
    if count(most) == each.len() {
        return most.clone();
    }
    let sides = std::iter::zip(names, &each).filter(|(_, text)| *text != most || count(most) == 1);
    let mut sides: Vec<String> = sides.map(|(side, text)| format!("{side} {text}")).collect();
    if count(most) > 1 {
        sides.push(format!("others {most}"));
    }
    sides.join(", ")
}

fn shear(of: RigidShear) -> String {
    match of {
        RigidShear::Smooth => "smooth".to_owned(),
        RigidShear::Rough => "rough".to_owned(),
        RigidShear::Limited { friction, adhesion } => {
            let friction = (friction > 0.0).then(|| format!("friction {}", short(friction)));
            let adhesion = match adhesion {
                Adhesion::Stress(stress) if stress > 0.0 => {
                    Some(format!("adhesion {}", kilo(stress, "Pa")))
                }
                Adhesion::Share(share) if share > 0.0 => Some(format!(
                    "adhesion {} of the strength of the soil",
                    short(share)
                )),
                _ => None,
            };
            let parts: Vec<String> = friction.into_iter().chain(adhesion).collect();
            if parts.is_empty() {
                "smooth".to_owned()
            } else {
                parts.join(" and ")
            }
        }
    }
}

fn tension(of: Tension) -> String {
    match of {
        Tension::None => "none".to_owned(),
        Tension::Bonded => "bonded".to_owned(),
        Tension::Limit(stress) => format!("up to {}", kilo(stress, "Pa")),
    }
}

pub(super) fn reinforcement<const D: usize>(case: &Case<D>) -> SetupTable {
    let header = match D {
        2 => [
            "Reinforcement",
            "Kind",
            "Line [m]",
            "Stiffness EA [MN/m]",
            "Capacity [kN/m]",
            "Bond [kPa]",
            "Held at head, end [kN/m]",
            "Installed",
        ],
        _ => [
            "Reinforcement",
            "Kind",
            "Line [m]",
            "Stiffness EA [MN]",
            "Capacity [kN]",
            "Bond [kN/m]",
            "Held at head, end [kN]",
            "Installed",
        ],
    };
    let title = if D == 2 {
        "Reinforcement, per metre run"
    } else {
        "Reinforcement"
    };
    let rows = case.reinforcement.iter().enumerate();
    let rows = rows.map(|(index, part)| member(case, index, part));
    table(title, &header, rows.collect())
}

fn member<const D: usize>(
    case: &Case<D>,
    index: usize,
    part: &ReinforcementPart<D>,
) -> Vec<String> {
    let mut kind = part.kind.name().to_owned();
    if part.free_length > 0.0 {
        let _ = write!(kind, ", {} m of it free", short(part.free_length));
    }
    let mut bond = short(part.bond / 1e3);
    if part.reduces_bond {
        bond.push_str(", reduced with the strength");
    }
    let [head, end] = part.fastened.map(|force| short(force / 1e3));
    let held = match part.plate.as_deref() {
        Some([from, to, ..]) => {
            let width = short(distance(from, to));
            format!("{head} on a plate of {width} m, {end}")
        }
        _ => format!("{head}, {end}"),
    };
    let stages = case.stages.iter();
    let installed = stages.filter(|stage| stage.install.contains(&index));
    let installed: Vec<&str> = installed.map(|stage| stage.name.as_str()).collect();
    let mut when = if part.from_start {
        "from the start".to_owned()
    } else {
        format!("in {}", installed.join(", "))
    };
    if let Some(prestress) = part.prestress {
        let unit = if D == 2 { "kN/m" } else { "kN" };
        let _ = write!(when, ", locked off at {} {unit}", short(prestress / 1e3));
    }
    vec![
        part.name.clone(),
        kind,
        corners(&part.line),
        short(part.stiffness / 1e6),
        short(part.capacity / 1e3),
        bond,
        held,
        when,
    ]
}
