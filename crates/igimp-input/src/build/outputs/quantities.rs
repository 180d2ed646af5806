//! The quantities that curves and checks name, such as `footing.reaction`.

use igimp_model::{Field, Load, LoadKind, Quantity, ReinforcementQuantity, RigidQuantity};
use igimp_schema::diagnostic::Problems;
use igimp_schema::names::suggest::nearest;
use igimp_schema::schema::Measured;
use igimp_schema::text::{clip, row};
use igimp_schema::tree::Node;
use igimp_schema::tree::read::At;

use crate::build::AllNames;

/// Prefix of the names of quantities of rigid bodies.
const RIGID_PREFIX: &str = "rigid.";

/// Quantities of a rigid body, and in how many dimensions they are; none: in any.
const RIGID: [(&str, RigidQuantity, &str, Option<usize>); 28] = [
    ("x", RigidQuantity::Displacement(0), "m", None),
    ("y", RigidQuantity::Displacement(1), "m", None),
    ("z", RigidQuantity::Displacement(2), "m", Some(3)),
    ("settlement", RigidQuantity::Settlement, "m", None),
    ("rotation", RigidQuantity::Rotation(0), "rad", Some(2)),
    ("rotation_x", RigidQuantity::Rotation(0), "rad", Some(3)),
    ("rotation_y", RigidQuantity::Rotation(1), "rad", Some(3)),
    ("rotation_z", RigidQuantity::Rotation(2), "rad", Some(3)),
    ("force_x", RigidQuantity::Force(0), "N/m", None),
    ("force_y", RigidQuantity::Force(1), "N/m", None),
    ("force_z", RigidQuantity::Force(2), "N/m", Some(3)),
    ("resistance", RigidQuantity::Resistance, "N/m", None),
    ("moment", RigidQuantity::Moment(0), "N m/m", Some(2)),
    ("moment_x", RigidQuantity::Moment(0), "N m/m", Some(3)),
    ("moment_y", RigidQuantity::Moment(1), "N m/m", Some(3)),
    ("moment_z", RigidQuantity::Moment(2), "N m/m", Some(3)),
    ("velocity_x", RigidQuantity::Velocity(0), "m/s", None),
    ("velocity_y", RigidQuantity::Velocity(1), "m/s", None),
    ("velocity_z", RigidQuantity::Velocity(2), "m/s", Some(3)),
    ("spin", RigidQuantity::Spin(0), "rad/s", Some(2)),
    ("spin_x", RigidQuantity::Spin(0), "rad/s", Some(3)),
    ("spin_y", RigidQuantity::Spin(1), "rad/s", Some(3)),
    ("spin_z", RigidQuantity::Spin(2), "rad/s", Some(3)),
    ("contact_width", RigidQuantity::ContactWidth, "m", Some(2)),
    ("contact_area", RigidQuantity::ContactWidth, "m2", Some(3)),
    ("penetration", RigidQuantity::Penetration, "-", None),
    ("closed", RigidQuantity::Closed, "-", None),
    ("slipping", RigidQuantity::Slipping, "-", None),
];

/// The quantity of a rigid body under a name in so many dimensions, and its unit in plane strain.
fn of_rigid(dimensions: usize, name: &str) -> Option<(RigidQuantity, &'static str)> {
    let found = RIGID
        .iter()
        .find(|(known, _, _, only)| *known == name && only.is_none_or(|only| only == dimensions));
    found.map(|(_, quantity, unit, _)| (*quantity, *unit))
}

/// Prefix of the names of quantities of reinforcement.
const REINFORCEMENT_PREFIX: &str = "reinforcement.";

/// Quantities of a member of reinforcement.
const REINFORCEMENT: [(&str, ReinforcementQuantity, &str); 3] = [
    ("force", ReinforcementQuantity::Force, "N/m"),
    ("head_force", ReinforcementQuantity::HeadForce, "N/m"),
    ("at_limit", ReinforcementQuantity::AtLimit, "-"),
];

/// Prefix of the names of discharges.
const SEEPAGE_PREFIX: &str = "seepage.";

/// The discharges of a file: of each computed flow its outflow, and that through its sections.
pub(crate) fn discharges(tree: &Node) -> Vec<(String, Quantity)> {
    let mut found = Vec::new();
    for (water, table) in tree.items_at("water").iter().enumerate() {
        let (Some(name), Some(seepage)) = (table.text_at("name"), table.get("seepage")) else {
            continue;
        };
        found.push((
            format!("{SEEPAGE_PREFIX}{name}.outflow"),
            Quantity::Discharge(water, None),
        ));
        for (number, section) in seepage.items_at("sections").iter().enumerate() {
            if let Some(section) = section.text_at("name") {
                found.push((
                    format!("{SEEPAGE_PREFIX}{name}.section.{section}"),
                    Quantity::Discharge(water, Some(number)),
                ));
            }
        }
    }
    found
}

/// Quantities of the whole model.
const GLOBAL: [(&str, Quantity, &str); 10] = [
    ("largest_displacement", Quantity::LargestDisplacement, "m"),
    ("gravity_factor", Quantity::GravityFactor, "-"),
    ("horizontal_factor", Quantity::HorizontalFactor, "-"),
    ("reduction_factor", Quantity::ReductionFactor, "-"),
    ("step", Quantity::Step, "-"),
    ("plastic_share", Quantity::PlasticShare, "-"),
    ("top", Quantity::Top, "m"),
    ("time", Quantity::Time, "s"),
    ("kinetic_energy", Quantity::KineticEnergy, "J/m"),
    ("factor_of_safety", Quantity::FactorOfSafety, "-"),
];

/// The fields of a list, each once; reports those that there are in space only, and those of motion where no stage `moves`
/// soil in time.
pub(crate) fn fields<const D: usize>(
    named: &[At<Field>],
    moves: bool,
    problems: &mut Problems,
) -> Option<Vec<Field>> {
    let mut fields = Vec::with_capacity(named.len());
    for item in named {
        let field = **item;
        if !field.exists_in(D) {
            let message = format!("there is no {} in plane strain", field.name());
            problems
                .error(item.place, message)
                .help("it is a field of cases with analysis = \"3d\"");
            return None;
        }
        if field.is_of_motion() && !moves {
            let message = format!("nothing here has a field {}", field.name());
            problems.error(item.place, message).help(
                "it is a field of cases with a stage of type \"dynamic\", whose soil moves in time",
            );
            return None;
        }
        if !fields.contains(&field) {
            fields.push(field);
        }
    }
    Some(fields)
}

/// SI unit of a quantity by its name, per metre run or of a whole body.
pub(crate) fn unit_of(dimensions: usize, is_whole: bool, name: &str) -> &'static str {
    match (is_whole, unit_in_plane(dimensions, name)) {
        (true, "N/m") => "N",
        (true, "N m/m") => "N m",
        (true, "J/m") => "J",
        (true, "m") if name.ends_with(".contact_width") => "m2",
        (true, "m2/s") => "m3/s",
        (_, unit) => unit,
    }
}

fn unit_in_plane(dimensions: usize, name: &str) -> &'static str {
    if let Some((_, _, unit)) = GLOBAL.iter().find(|(known, ..)| *known == name) {
        return unit;
    }
    if name.starts_with(SEEPAGE_PREFIX) {
        return "m2/s";
    }
    match name.rsplit_once('.').map_or("", |(_, last)| last) {
        "settlement" => "m",
        "reaction" => "N/m",
        last if name.starts_with(RIGID_PREFIX) => {
            of_rigid(dimensions, last).map_or("-", |(_, unit)| unit)
        }
        last if name.starts_with(REINFORCEMENT_PREFIX) => REINFORCEMENT
            .iter()
            .find(|(known, ..)| *known == last)
            .map_or("-", |(_, _, unit)| unit),
        last => Field::of_name(last).map_or("-", |field| field.dimension().unit()),
    }
}

/// The quantity that a value names; reports when there is none.
pub(crate) fn quantity<const D: usize>(
    value: &At<String>,
    names: &AllNames,
    loads: &[Option<Load<D>>],
    problems: &mut Problems,
) -> Option<Quantity> {
    let name = value.as_str();
    if let Some((_, quantity, _)) = GLOBAL.iter().find(|(known, ..)| *known == name) {
        return Some(*quantity);
    }
    if let Some((_, discharge)) = names.discharges.iter().find(|(known, _)| known == name) {
        return Some(*discharge);
    }
    if let Some((owner, last)) = name.rsplit_once('.') {
        let body = owner.strip_prefix(RIGID_PREFIX);
        let body = body.and_then(|body| names.rigid.position(body));
        if let (Some(body), Some((quantity, _))) = (body, of_rigid(D, last)) {
            return Some(Quantity::Rigid(body, quantity));
        }
        let member = owner.strip_prefix(REINFORCEMENT_PREFIX);
        let member = member.and_then(|member| names.reinforcement.position(member));
        let of_member = REINFORCEMENT.iter().find(|(known, ..)| *known == last);
        if let (Some(member), Some((_, quantity, _))) = (member, of_member) {
            return Some(Quantity::Reinforcement(member, *quantity));
        }
        let monitor = names.monitors.position(owner);
        let there = |field: &Field| field.exists_in(D);
        if let (Some(monitor), Some(field)) = (monitor, Field::of_name(last).filter(there)) {
            return Some(Quantity::Monitor(monitor, field));
        }
        if let Some(load) = names.loads.position(owner) {
            let is_footing = loads
                .get(load)
                .and_then(Option::as_ref)
                .map(|load| matches!(load.kind, LoadKind::RigidFooting { .. }));
            match (last, is_footing) {
                ("factor", Some(false)) => return Some(Quantity::LoadFactor(load)),
                ("settlement", Some(true)) => return Some(Quantity::Settlement(load)),
                ("reaction", Some(true)) => return Some(Quantity::Reaction(load)),
                // The load itself was found wrong.
                (_, None) => return None,
                _ => {}
            }
        }
    }
    let message = format!("there is no quantity `{}`", clip(name, 60));
    if problems.are_many() {
        problems.error(value.place, message);
        return None;
    }
    let known = known(names, loads);
    let problem = problems.error(value.place, message);
    if let Some(near) = nearest(name, known.iter().map(String::as_str)) {
        problem.help(format!("did you mean `{near}`?"));
    }
    problem.help(format!(
        "quantities here: {}",
        row(known.iter().map(String::as_str))
    ));
    None
}

/// The quantities that a file has.
fn known<const D: usize>(names: &AllNames, loads: &[Option<Load<D>>]) -> Vec<String> {
    let mut known = Vec::new();
    for load in loads.iter().flatten() {
        match load.kind {
            LoadKind::RigidFooting { .. } => {
                known.push(format!("{}.settlement", load.name));
                known.push(format!("{}.reaction", load.name));
            }
            _ => known.push(format!("{}.factor", load.name)),
        }
    }
    for body in names.rigid.known() {
        let of_body = RIGID
            .iter()
            .filter(|(.., only)| only.is_none_or(|only| only == D));
        known.extend(of_body.map(|(name, ..)| format!("{RIGID_PREFIX}{body}.{name}")));
    }
    for member in names.reinforcement.known() {
        let of_member = REINFORCEMENT.iter();
        known.extend(of_member.map(|(name, ..)| format!("{REINFORCEMENT_PREFIX}{member}.{name}")));
    }
    known.extend(names.discharges.iter().map(|(name, _)| name.clone()));
    known.extend(GLOBAL.iter().map(|(name, ..)| (*name).to_owned()));
    for monitor in names.monitors.known() {
        known.extend(
            Field::ALL
                .iter()
                .filter(|field| field.exists_in(D))
                .map(|field| format!("{monitor}.{}", field.name())),
        );
    }
    known
}

/// The product of the divisors; reports one that is zero.
pub(crate) fn divisor(divisors: &At<Vec<At<Measured>>>, problems: &mut Problems) -> Option<f64> {
    let mut product = 1.0;
    for divisor in divisors.iter() {
        let value = divisor.value.value;
        if value == 0.0 {
            problems.error(divisor.place, "a divisor is zero");
            return None;
        }
        product *= value;
    }
    if f64::is_normal(product) {
        Some(product)
    } else {
        problems.error(
            divisors.place,
            "the product of the divisors is not a finite number",
        );
        None
    }
}
