//! Stages in words.

use std::fmt::Write as _;

use igimp_assembly::{Geometry, TimeScheme};
use igimp_model::{
    Base, Case, Consolidation, Construction, Dynamic, Load, Reduction, ReductionPath, RigidDrive,
    RigidMove, SearchMethod, Stage, StageKind, StopWhen,
};
use igimp_results::summary::SetupTable;
use igimp_text::short;

use super::{kilo, table};

pub(super) fn stages<const D: usize>(case: &Case<D>) -> SetupTable {
    let rows = case.stages.iter().enumerate().map(|(number, stage)| {
        let from = stage.start_from.map_or_else(
            || "undeformed, free of stress".to_owned(),
            |from| case.stages[from].name.clone(),
        );
        let mut parts = vec![happens(case, stage)];
        for &member in &stage.install {
            parts.push(format!("{} installed", case.reinforcement[member].name));
        }
        if stage.geometry == Geometry::Given {
            parts.push("on the geometry as it is".to_owned());
        }
        parts.extend(ends(case, &stage.stop_when));
        if stage.drained {
            parts.push("all soil drains".to_owned());
        }
        parts.extend(stage.consolidation.as_ref().map(consolidation_in_words));
        if stage.reset_displacements {
            parts.push("displacements count from its end on".to_owned());
        }
        vec![
            (number + 1).to_string(),
            stage.name.clone(),
            parts.join("; "),
            from,
            stage.steps.to_string(),
        ]
    });
    let header = ["", "Stage", "What happens", "Starts from", "Steps"];
    table("Stages as planned", &header, rows.collect())
}

fn happens<const D: usize>(case: &Case<D>, stage: &Stage) -> String {
    match &stage.kind {
        StageKind::Gravity {
            factor,
            horizontal,
            across,
            vertical,
        } => {
            let shares = [*horizontal, *across, *vertical];
            gravity_in_words(*factor, shares)
        }
        StageKind::K0 => "stresses of level ground at rest (K₀), then equilibrium".to_owned(),
        StageKind::Load { loads, factor } => {
            let name = |&k: &usize| case.loads[k].name.as_str();
            let names: Vec<&str> = loads.iter().map(name).collect();
            format!("{} to {}", names.join(", "), times(*factor, "size"))
        }
        StageKind::Displacement { load, settlement } => {
            let Load { name, .. } = &case.loads[*load];
            format!("{name} pushed down by {} m", short(*settlement))
        }
        StageKind::Construction(works) => construction_in_words(case, works),
        StageKind::Wait => "nothing changes".to_owned(),
        StageKind::Rigid(moves) => {
            let parts: Vec<String> = moves.iter().map(|m| moves_in_words(case, m)).collect();
            parts.join("; ")
        }
        StageKind::StrengthReduction(reduction) => {
            let path = match reduction.path {
                ReductionPath::Reduce => "step by step",
                ReductionPath::Gravity => "with gravity raised anew",
            };
            let strength = names(case, &reduction.materials);
            match reduction.search {
                SearchMethod::Continuation => format!(
                    "search for the factor of safety along the path of equilibria, strength of {strength} reduced {path}"
                ),
                SearchMethod::Trials => format!(
                    "search for the factor of safety to within {}, strength of {strength} reduced {path}",
                    short(reduction.tolerance)
                ),
            }
        }
        StageKind::RunOut(run_out) => format!(
            "motion until rest, strength of {} divided by {}",
            names(case, &run_out.materials),
            reduction_in_words(&run_out.reduction)
        ),
        StageKind::Dynamic(dynamic) => motion_in_words(case, dynamic),
    }
}

/// Gravity to a multiple, with pseudo-static forces as shares of the weight to the right, backwards and upwards.
fn gravity_in_words(factor: f64, shares: [Option<f64>; 3]) -> String {
    let mut words = format!("gravity to {}", times(factor, "value"));
    let ways = ["to the right", "backwards", "upwards"];
    for (share, way) in std::iter::zip(shares, ways) {
        if let Some(share) = share {
            let _ = write!(
                words,
                ", pseudo-static force of {} % of the weight {way}",
                short(100.0 * share)
            );
        }
    }
    words
}

/// Names of materials in a row.
fn names<const D: usize>(case: &Case<D>, materials: &[usize]) -> String {
    let names: Vec<&str> = (materials.iter())
        .map(|&k| case.materials[k].name.as_str())
        .collect();
    names.join(", ")
}

/// Motion in time, in words.
fn motion_in_words<const D: usize>(case: &Case<D>, dynamic: &Dynamic) -> String {
    let scheme = match dynamic.scheme {
        TimeScheme::Newmark => "Newmark's method",
        TimeScheme::GeneralisedAlpha => "the generalised-α method",
        TimeScheme::BackwardEuler => "backward Euler",
    };
    let mut parts = vec![format!(
        "motion over {} s, {scheme}",
        short(dynamic.duration)
    )];
    if let Some((materials, reduction)) = &dynamic.reduction {
        let by = reduction_in_words(reduction);
        let strength = names(case, materials);
        parts.push(format!("strength of {strength} divided by {by}"));
    }
    parts.extend(ground_in_words(dynamic));
    parts.extend(dynamic.bodies.iter().map(|m| moves_in_words(case, m)));
    parts.join("; ")
}

/// The time in which water flows, in words.
fn consolidation_in_words(consolidation: &Consolidation) -> String {
    let mut text = format!(
        "over {}, in which water flows out of soil",
        duration(consolidation.duration)
    );
    if !consolidation.open_faces {
        text += ", faces sealed";
    }
    match consolidation.open_sides.len() {
        0 => {}
        1 => text += ", one side open",
        sides => {
            let _ = write!(text, ", {sides} sides open");
        }
    }
    match consolidation.drains.len() {
        0 => {}
        1 => text += ", one drain",
        drains => {
            let _ = write!(text, ", {drains} drains");
        }
    }
    text
}

/// A duration in the unit that suits it, given in seconds.
fn duration(seconds: f64) -> String {
    let day = 86_400.0;
    if seconds >= 730.0 * day {
        format!("{} years", short(seconds / (365.25 * day)))
    } else if seconds >= day {
        format!("{} d", short(seconds / day))
    } else {
        format!("{} s", short(seconds))
    }
}

/// Walls, ground and damping of motion in time, in words.
fn ground_in_words(dynamic: &Dynamic) -> Vec<String> {
    let mut parts = Vec::new();
    if let Some(motion) = &dynamic.ground_motion {
        let base = match motion.base {
            Base::Rigid => "rigid base",
            Base::Compliant => "compliant base",
        };
        let axis = ["x", "y", "z"][motion.axis.min(2)];
        let peak = short(motion.peak(f64::INFINITY));
        parts.push(format!("{base} moved along {axis} by up to {peak} m/s²"));
    }
    if !dynamic.walls.absorbing.is_empty() {
        let count = dynamic.walls.absorbing.len();
        let springs = short(dynamic.walls.springs);
        parts.push(format!(
            "dashpots at {count} side(s), springs of {springs} M/L"
        ));
    }
    if !dynamic.walls.free_field.is_empty() {
        let count = dynamic.walls.free_field.len();
        let springs = short(dynamic.walls.springs);
        parts.push(format!(
            "soil in free field beside {count} side(s), springs of {springs} M/L"
        ));
    }
    if dynamic.walls.tied {
        parts.push("left and right side tied".to_owned());
    }
    if let Some(damping) = &dynamic.rayleigh {
        let (mass, stiffness) = (short(damping.mass), short(damping.stiffness));
        parts.push(format!(
            "Rayleigh damping {mass} 1/s of mass, {stiffness} s of stiffness"
        ));
    }
    parts
}

/// The divisor of a reduction of strength, in words.
fn reduction_in_words(reduction: &Reduction) -> String {
    match reduction {
        Reduction::TimesFos(times) => format!("{} times the factor of safety", short(*times)),
        Reduction::Factor(factor) => short(*factor),
    }
}

/// The changes of a construction stage, in words.
fn construction_in_words<const D: usize>(case: &Case<D>, works: &Construction) -> String {
    let names = |which: &[usize]| {
        let names: Vec<&str> = which.iter().map(|&k| &*case.bodies[k].name).collect();
        names.join(", ")
    };
    let mut parts = Vec::new();
    if !works.place.is_empty() {
        parts.push(format!("{} placed", names(&works.place)));
    }
    if !works.remove.is_empty() {
        parts.push(format!("{} taken away", names(&works.remove)));
    }
    for &(body, material) in &works.materials {
        let (body, material) = (&case.bodies[body].name, &case.materials[material].name);
        parts.push(format!("{body} becomes {material}"));
    }
    if let Some(water) = works.water {
        parts.push(format!("water: {}", case.water[water].name));
    }
    if works.dissipate {
        parts.push("excess pore pressure gone".to_owned());
    }
    parts.join("; ")
}

/// The action of a stage on a rigid body, in words.
fn moves_in_words<const D: usize>(case: &Case<D>, motion: &RigidMove) -> String {
    let name = &case.rigid[motion.body].name;
    format!("{name}: {}", drives_in_words(case, motion))
}

/// The drives of the components of a rigid body's motion in a stage, in words.
pub(super) fn drives_in_words<const D: usize>(case: &Case<D>, motion: &RigidMove) -> String {
    let names: &[&str] = if D == 2 {
        &["x", "y", "rotation"]
    } else {
        &[
            "x",
            "y",
            "z",
            "rotation about x",
            "rotation about y",
            "rotation about z",
        ]
    };
    let [force, moment] = ["N", "N m"].map(|unit| format!("{unit}{}", case.per_metre()));
    let parts: Vec<String> = std::iter::zip(names, motion.drives)
        .filter_map(|(name, drive)| {
            let about = name.strip_prefix("rotation");
            Some(match (drive?, about) {
                (RigidDrive::By(by), Some(_)) => format!("{name} by {} rad", short(by)),
                (RigidDrive::By(by), None) => format!("{name} by {} m", short(by)),
                (RigidDrive::Force(0.0), _) => format!("{name} free"),
                (RigidDrive::Force(size), Some(about)) => {
                    format!("moment{about} to {}", kilo(size, &moment))
                }
                (RigidDrive::Force(size), None) => {
                    format!("force in {name} to {}", kilo(size, &force))
                }
            })
        })
        .collect();
    if parts.is_empty() {
        "held".to_owned()
    } else {
        parts.join(", ")
    }
}

/// A multiple in words.
fn times(factor: f64, of: &str) -> String {
    if (factor - 1.0).abs() < 1e-12 {
        format!("its full {of}")
    } else {
        format!("{} times its {of}", short(factor))
    }
}

/// The conditions that end a stage early.
fn ends<const D: usize>(case: &Case<D>, stop: &StopWhen) -> Vec<String> {
    let mut words = Vec::new();
    if let Some(limit) = stop.displacement {
        let whose = stop.monitor.map_or_else(
            || "the largest displacement".to_owned(),
            |monitor| format!("the displacement of {}", case.monitors[monitor].name),
        );
        words.push(format!("ends when {whose} is {} m", short(limit)));
    }
    if stop.no_equilibrium {
        words.push("ends for want of equilibrium".to_owned());
    }
    if let Some(share) = stop.load_grows_less_than {
        let share = short(100.0 * share);
        words.push(format!(
            "ends when the load grows by less than {share} % in a step"
        ));
    }
    words
}
