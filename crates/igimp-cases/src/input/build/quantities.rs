//! The quantities that curves and checks name, such as `footing.reaction`.

use super::AllNames;
use crate::case::{Field, Load, LoadKind, Quantity, ReinforcementQuantity, RigidQuantity};
use crate::input::diagnostic::Problems;
use crate::input::suggest::nearest;
use crate::input::text::{clip, row};
use crate::input::tree::Node;

/// Fields by their names.
const FIELDS: [(&str, Field, &str); 22] = [
    ("displacement", Field::Displacement, "m"),
    ("displacement_x", Field::DisplacementX, "m"),
    ("displacement_y", Field::DisplacementY, "m"),
    ("x", Field::X, "m"),
    ("y", Field::Y, "m"),
    ("sigma_xx", Field::SigmaXx, "Pa"),
    ("sigma_yy", Field::SigmaYy, "Pa"),
    ("sigma_zz", Field::SigmaZz, "Pa"),
    ("tau_xy", Field::TauXy, "Pa"),
    ("p", Field::P, "Pa"),
    ("sigma_eff_xx", Field::SigmaEffXx, "Pa"),
    ("sigma_eff_yy", Field::SigmaEffYy, "Pa"),
    ("sigma_eff_zz", Field::SigmaEffZz, "Pa"),
    ("p_eff", Field::PEff, "Pa"),
    ("u", Field::U, "Pa"),
    ("u_excess", Field::UExcess, "Pa"),
    ("q", Field::Q, "Pa"),
    ("plastic_strain", Field::PlasticStrain, "-"),
    ("utilisation", Field::Utilisation, "-"),
    ("strength", Field::Strength, "Pa"),
    ("friction", Field::Friction, "rad"),
    ("young", Field::Young, "Pa"),
];

/// What the names of quantities of rigid bodies begin with.
const RIGID_PREFIX: &str = "rigid.";

/// Quantities of a rigid body.
const RIGID: [(&str, RigidQuantity, &str); 12] = [
    ("x", RigidQuantity::Displacement(0), "m"),
    ("y", RigidQuantity::Displacement(1), "m"),
    ("settlement", RigidQuantity::Settlement, "m"),
    ("rotation", RigidQuantity::Rotation(0), "rad"),
    ("force_x", RigidQuantity::Force(0), "N/m"),
    ("force_y", RigidQuantity::Force(1), "N/m"),
    ("resistance", RigidQuantity::Resistance, "N/m"),
    ("moment", RigidQuantity::Moment(0), "N m/m"),
    ("contact_width", RigidQuantity::ContactWidth, "m"),
    ("penetration", RigidQuantity::Penetration, "-"),
    ("closed", RigidQuantity::Closed, "-"),
    ("slipping", RigidQuantity::Slipping, "-"),
];

/// What the names of quantities of reinforcement begin with.
const REINFORCEMENT_PREFIX: &str = "reinforcement.";

/// Quantities of a member of reinforcement.
const REINFORCEMENT: [(&str, ReinforcementQuantity, &str); 3] = [
    ("force", ReinforcementQuantity::Force, "N/m"),
    ("head_force", ReinforcementQuantity::HeadForce, "N/m"),
    ("at_limit", ReinforcementQuantity::AtLimit, "-"),
];

/// Quantities of the whole model.
const GLOBAL: [(&str, Quantity, &str); 8] = [
    ("largest_displacement", Quantity::LargestDisplacement, "m"),
    ("gravity_factor", Quantity::GravityFactor, "-"),
    ("horizontal_factor", Quantity::HorizontalFactor, "-"),
    ("reduction_factor", Quantity::ReductionFactor, "-"),
    ("step", Quantity::Step, "-"),
    ("plastic_share", Quantity::PlasticShare, "-"),
    ("top", Quantity::Top, "m"),
    ("factor_of_safety", Quantity::FactorOfSafety, "-"),
];

/// The field of a name.
pub(super) fn field(name: &str) -> Option<Field> {
    let found = FIELDS.iter().find(|(known, ..)| *known == name)?;
    Some(found.1)
}

/// The fields of a list of names.
pub(super) fn fields(names: &[Node]) -> Option<Vec<Field>> {
    let mut fields = Vec::with_capacity(names.len());
    for name in names {
        let field = field(name.text()?)?;
        if !fields.contains(&field) {
            fields.push(field);
        }
    }
    Some(fields)
}

/// SI unit of a quantity by its name.
pub(super) fn unit_of(name: &str) -> &'static str {
    if let Some((_, _, unit)) = GLOBAL.iter().find(|(known, ..)| *known == name) {
        return unit;
    }
    match name.rsplit_once('.').map_or("", |(_, last)| last) {
        "settlement" => "m",
        "reaction" => "N/m",
        last if name.starts_with(RIGID_PREFIX) => RIGID
            .iter()
            .find(|(known, ..)| *known == last)
            .map_or("-", |(_, _, unit)| unit),
        last if name.starts_with(REINFORCEMENT_PREFIX) => REINFORCEMENT
            .iter()
            .find(|(known, ..)| *known == last)
            .map_or("-", |(_, _, unit)| unit),
        last => FIELDS
            .iter()
            .find(|(known, ..)| *known == last)
            .map_or("-", |(_, _, unit)| unit),
    }
}

/// The quantity that a value names; reports when there is none.
pub(super) fn quantity(
    value: &Node,
    names: &AllNames,
    loads: &[Option<Load>],
    problems: &mut Problems,
) -> Option<Quantity> {
    let name = value.text()?;
    if let Some((_, quantity, _)) = GLOBAL.iter().find(|(known, ..)| *known == name) {
        return Some(*quantity);
    }
    if let Some((owner, what)) = name.rsplit_once('.') {
        let body = owner.strip_prefix(RIGID_PREFIX);
        let body = body.and_then(|body| names.rigid.position(body));
        let of_body = RIGID.iter().find(|(known, ..)| *known == what);
        if let (Some(body), Some((_, quantity, _))) = (body, of_body) {
            return Some(Quantity::Rigid(body, *quantity));
        }
        let member = owner.strip_prefix(REINFORCEMENT_PREFIX);
        let member = member.and_then(|member| names.reinforcement.position(member));
        let of_member = REINFORCEMENT.iter().find(|(known, ..)| *known == what);
        if let (Some(member), Some((_, quantity, _))) = (member, of_member) {
            return Some(Quantity::Reinforcement(member, *quantity));
        }
        let monitor = names.monitors.position(owner);
        if let (Some(monitor), Some(field)) = (monitor, field(what)) {
            return Some(Quantity::Monitor(monitor, field));
        }
        if let Some(load) = names.loads.position(owner) {
            let is_footing = loads
                .get(load)
                .and_then(Option::as_ref)
                .map(|load| matches!(load.kind, LoadKind::RigidFooting { .. }));
            match (what, is_footing) {
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
fn known(names: &AllNames, loads: &[Option<Load>]) -> Vec<String> {
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
        let of_body = RIGID.iter();
        known.extend(of_body.map(|(what, ..)| format!("{RIGID_PREFIX}{body}.{what}")));
    }
    for member in names.reinforcement.known() {
        let of_member = REINFORCEMENT.iter();
        known.extend(of_member.map(|(what, ..)| format!("{REINFORCEMENT_PREFIX}{member}.{what}")));
    }
    known.extend(GLOBAL.iter().map(|(name, ..)| (*name).to_owned()));
    for monitor in names.monitors.known() {
        known.extend(
            FIELDS
                .iter()
                .map(|(field, ..)| format!("{monitor}.{field}")),
        );
    }
    known
}

/// The product of the divisors; reports one that is zero.
pub(super) fn divisor(table: &Node, problems: &mut Problems) -> Option<f64> {
    let mut product = 1.0;
    for divisor in table.items_at("divide_by") {
        let value = divisor.number()?;
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
            table.place_at("divide_by"),
            "the product of the divisors is not a finite number",
        );
        None
    }
}

/// Quantities and what they mean, for the reference.
pub(in crate::input) const QUANTITY_DOCS: [(&str, &str); 21] = [
    ("FOOTING.settlement", "settlement of a rigid footing [m]"),
    (
        "FOOTING.reaction",
        "resistance of a rigid footing times its reaction_factor [N/m]",
    ),
    (
        "rigid.BODY.x, rigid.BODY.y",
        "displacement of the reference point of a rigid body [m]",
    ),
    ("rigid.BODY.settlement", "the same downwards [m]"),
    ("rigid.BODY.rotation", "its rotation, anticlockwise [rad]"),
    (
        "rigid.BODY.force_x, rigid.BODY.force_y",
        "force on the whole body from outside, beside its weight [N/m]; resistance is -force_y",
    ),
    (
        "rigid.BODY.moment",
        "moment on it from outside about its reference point, anticlockwise [N m/m]",
    ),
    (
        "rigid.BODY.contact_width",
        "length of its sides that soil touches [m]",
    ),
    (
        "rigid.BODY.penetration, .closed, .slipping",
        "largest penetration as a share of the cell; points of its sides that soil touches, and slips along [-]",
    ),
    (
        "reinforcement.MEMBER.force, reinforcement.MEMBER.head_force",
        "largest tension along an anchor, a nail or a geotextile, and that at its head [N/m]",
    ),
    (
        "reinforcement.MEMBER.at_limit",
        "share of its length on which its tension is at its limit [-]",
    ),
    ("LOAD.factor", "factor on a pressure or point load [-]"),
    (
        "MONITOR.FIELD",
        "a field at a monitor, as in crest.displacement",
    ),
    (
        "largest_displacement",
        "largest displacement of all particles [m]",
    ),
    ("gravity_factor", "multiple of gravity [-]"),
    (
        "horizontal_factor",
        "pseudo-static horizontal force over the weight [-]",
    ),
    ("reduction_factor", "strength reduction factor [-]"),
    ("step", "number of the step in its stage [-]"),
    ("plastic_share", "share of particles that yield [-]"),
    ("top", "height of the highest particle's upper edge [m]"),
    (
        "factor_of_safety",
        "middle of the interval a strength reduction found, in checks only [-]",
    ),
];
