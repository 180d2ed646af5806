//! Rigid bodies: the interfaces of their sides, and their place in the grid.

pub(crate) mod apart;
mod narrow;
pub(crate) mod plane;
pub(crate) mod space;
pub(crate) mod stage;

use std::sync::Arc;

use igimp_assembly::{SurfaceError, Tension};
use igimp_model::{Adhesion, Material, RigidForm, RigidInterface, RigidPart, RigidShear, Strength};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::rigid::{self as keys, Interface, Limited, RigidBody, RigidCommon};
use igimp_schema::source::Place;
use igimp_schema::text::{clip, number};
use igimp_schema::tree::Node;
use igimp_schema::tree::read::{At, Either};
use igimp_text::short;

use super::grid::Frame;
use super::things;
use crate::build::Thing;

/// A body is at least so many cells thick.
const LEAST_CELLS: f64 = 2.0;

/// A shape, its sides and thickness.
pub(super) struct Basis<const D: usize> {
    pub(super) shape: Arc<dyn RigidForm<D>>,
    /// The point of the printed displacement and forces \[m\].
    pub(super) reference: [f64; D],
    pub(super) sides: Sides,
    /// \[m\].
    pub(super) thickness: f64,
}

/// The sides of a shape.
pub(super) struct Sides {
    pub count: usize,
    /// Names of the first ones, in their order.
    pub(super) names: &'static [&'static str],
}

/// The surroundings of rigid bodies.
pub(super) trait Room<const D: usize> {
    /// The grid.
    fn frame(&self) -> Option<&Frame<D>>;

    /// The shape of a body.
    fn basis(&self, body: &At<RigidBody<D>>, problems: &mut Problems) -> Option<Basis<D>>;

    /// Refuses a body that has no place beside the soil.
    fn check(&self, body: &RigidBody<D>, part: &RigidPart<D>, problems: &mut Problems);

    /// Whether the grid follows something else, and the help where it cannot follow two.
    fn followed(&self) -> (bool, &'static str);
}

/// The rigid bodies.
pub(super) fn rigid<const D: usize>(
    tree: &Node,
    room: &impl Room<D>,
    materials: &[Option<Material>],
    problems: &mut Problems,
) -> Vec<Option<RigidPart<D>>> {
    let all = things(Root::<D>::rigid(tree));
    let part = |body: &Thing<RigidBody<D>>| {
        let body = body.as_ref()?;
        let basis = room.basis(body, problems);
        let part = part_of(body, basis, (room.frame(), materials), problems)?;
        room.check(body, &part, problems);
        Some(part)
    };
    let parts = all.iter().map(part).collect();
    follow_once(&all, room.followed(), problems);
    parts
}

/// The rigid body that a shape becomes.
fn part_of<const D: usize>(
    body: &RigidBody<D>,
    basis: Option<Basis<D>>,
    (frame, materials): (Option<&Frame<D>>, &[Option<Material>]),
    problems: &mut Problems,
) -> Option<RigidPart<D>> {
    let common = body.common.as_ref().ok()?;
    let whole = RigidInterface {
        shear: shear(&common.interface, materials, problems)?,
        tension: tension(
            Some(&common.tension),
            common.tension_limit.as_ref(),
            problems,
        )?,
    };
    if let (Some(stated), 0.0) = (&common.centre_of_mass, *common.weight) {
        problems
            .error(stated.place, "there is no weight that acts there")
            .help("add weight = \"10 kN/m\", in space \"10 kN\"");
    }
    let basis = basis?;
    let interfaces = all_sides(body, whole, &basis.sides, materials, problems);
    let part = RigidPart {
        name: body.name.value.clone(),
        reference: basis.reference,
        centre_of_mass: (common.centre_of_mass.as_ref())
            .map_or_else(|| basis.shape.centroid(), |point| **point),
        shape: basis.shape,
        interfaces: interfaces?,
        stiffness: *common.stiffness,
        rounding: *common.rounding,
        weight: *common.weight,
        force_factor: *common.force_factor,
        grid_follows: *common.grid_follows,
        from_start: *common.from_start,
        most_penetration: *common.most_penetration,
    };
    if let Some(frame) = frame {
        in_grid(body, common, (&part, basis.thickness), frame, problems);
    }
    Some(part)
}

/// When soil is pulled off, if that is said.
fn tension(
    stated: Option<&At<keys::Tension>>,
    limit: Option<&At<f64>>,
    problems: &mut Problems,
) -> Option<Tension> {
    let stated = stated.map(|value| **value);
    if let (Some(limit), Some(keys::Tension::Bonded)) = (limit, stated) {
        problems
            .error(
                limit.place,
                "soil that is bonded never lets go: there is no limit",
            )
            .help("keep one of tension and tension_limit");
    }
    match (limit, stated) {
        (Some(limit), _) => Some(Tension::Limit(**limit)),
        (None, Some(keys::Tension::Bonded)) => Some(Tension::Bonded),
        (None, Some(keys::Tension::None)) => Some(Tension::None),
        (None, None) => None,
    }
}

fn shear(
    stated: &At<Either<Interface, Limited>>,
    materials: &[Option<Material>],
    problems: &mut Problems,
) -> Option<RigidShear> {
    let limited = match &**stated {
        Either::First(Interface::Smooth) => return Some(RigidShear::Smooth),
        Either::First(Interface::Rough) => return Some(RigidShear::Rough),
        Either::Second(limited) => limited,
    };
    let friction = match (&limited.friction, &limited.angle) {
        (Some(_), Some(angle)) => {
            problems
                .error(angle.place, "both `friction` and `angle` are given")
                .help("keep one of them");
            return None;
        }
        (Some(friction), None) => {
            check_coefficient(friction, problems);
            **friction
        }
        (None, angle) => angle.as_ref().map_or(0.0, |angle| angle.tan()),
    };
    if !(0.0..=1e3).contains(&friction) {
        let place = limited.angle.as_ref().map_or(stated.place, |key| key.place);
        problems.error(place, "an angle of friction is less than 90 deg");
        return None;
    }
    let adhesion = match (&limited.adhesion, &limited.adhesion_share) {
        (Some(_), Some(share)) => {
            problems
                .error(
                    share.place,
                    "both `adhesion` and `adhesion_share` are given",
                )
                .help("keep one of them");
            return None;
        }
        (None, Some(share)) => {
            if **share > 1.0 {
                let message = format!(
                    "adhesion_share = {} is more than the strength of the soil, which yields first",
                    number(**share)
                );
                problems
                    .warning(share.place, message)
                    .help("it is a share: 1 is all of the strength, 0.5 half of it");
            }
            for material in materials.iter().flatten() {
                let lack = match material.strength {
                    Strength::Elastic => "is elastic and has no strength",
                    Strength::HoekBrown(_) => "is rock by Hoek and Brown and has no cohesion",
                    Strength::ModifiedCamClay(_) => "is modified Cam-clay and has no cohesion",
                    _ if material.profiles.of_parameter("cohesion").is_some() => {
                        let message = format!(
                            "`adhesion_share` is of one cohesion, and that of `{}` varies",
                            clip(&material.name, 40)
                        );
                        problems
                            .error(share.place, message)
                            .help("state an `adhesion`, or layers with a material each");
                        return None;
                    }
                    _ => continue,
                };
                let name = clip(&material.name, 40);
                problems.warning(
                    share.place,
                    format!("the material `{name}` {lack} to take a share of: no adhesion where it touches"),
                );
            }
            Adhesion::Share(**share)
        }
        (stress, None) => Adhesion::Stress(stress.as_ref().map_or(0.0, |value| **value)),
    };
    Some(RigidShear::Limited { friction, adhesion })
}

/// Coefficients of friction above this are reported \[-\]: 56 deg.
const MOST_FRICTION: f64 = 1.5;

/// Warns of a coefficient of friction that may be meant to be an angle.
fn check_coefficient(friction: &At<f64>, problems: &mut Problems) {
    let value = **friction;
    if value <= MOST_FRICTION {
        return;
    }
    let message = format!(
        "friction = {} is a coefficient, that of an angle of {} deg",
        number(value),
        number(value.atan().to_degrees())
    );
    let help = if (5.0..80.0).contains(&value) {
        format!(
            "it is the tangent of the angle: {0} deg are friction = {1}; or write angle = \"{0} deg\"",
            number(value),
            number(value.to_radians().tan())
        )
    } else {
        "it is the tangent of the angle: 20 deg are friction = 0.364".to_owned()
    };
    problems.warning(friction.place, message).help(help);
}

/// The interface of each side.
fn all_sides<const D: usize>(
    body: &RigidBody<D>,
    whole: RigidInterface,
    sides: &Sides,
    materials: &[Option<Material>],
    problems: &mut Problems,
) -> Option<Vec<RigidInterface>> {
    let Sides { count, names } = sides;
    let mut interfaces = vec![whole; *count];
    for table in body.common.as_ref().ok()?.sides.iter() {
        let table = table.as_ref().ok()?;
        let side = match *table.side {
            Either::First(number) => number.checked_sub(1),
            Either::Second(name) => names.iter().position(|known| *known == name.name()),
        };
        let Some(side) = side.filter(|side| side < count) else {
            let numbers = match count {
                1 => "1".to_owned(),
                _ => format!("1 to {count}"),
            };
            let known = match names {
                [] => numbers,
                _ => format!("{}, or {numbers}", names.join(", ")),
            };
            let kind = body.form.name();
            problems
                .error(table.side.place, format!("a {kind} has no such side"))
                .help(format!("sides here: {known}"));
            return None;
        };
        let limit = table.tension_limit.as_ref();
        interfaces[side] = RigidInterface {
            shear: match &table.interface {
                Some(stated) => shear(stated, materials, problems)?,
                None => whole.shear,
            },
            tension: tension(table.tension.as_ref(), limit, problems).unwrap_or(whole.tension),
        };
    }
    Some(interfaces)
}

/// Refuses a body that lies outside the grid, or is too thin for it.
fn in_grid<const D: usize>(
    body: &RigidBody<D>,
    common: &RigidCommon<D>,
    (part, thickness): (&RigidPart<D>, f64),
    frame: &Frame<D>,
    problems: &mut Problems,
) {
    let name = clip(&part.name, 40);
    let (lower, upper) = part.bounds();
    if (0..D).any(|k| upper[k] <= frame.lower[k] || lower[k] >= frame.upper[k]) {
        problems
            .error(
                body.name.place,
                format!("the rigid body `{name}` lies outside the grid domain"),
            )
            .help("soil is only within the domain: move the body, or extend [grid] domain");
        return;
    }
    let axes = frame.axes.iter().enumerate();
    let cell = axes
        .map(|(axis, spec)| spec.smallest_between(lower[axis], upper[axis]))
        .fold(f64::INFINITY, f64::min);
    if thickness < LEAST_CELLS * cell * (1.0 - 1e-9) {
        problems
            .error(
                body.name.place,
                format!(
                    "the rigid body `{name}` is {} m thick, thinner than two cells of {} m",
                    number(thickness),
                    short(cell)
                ),
            )
            .help("soil on both sides of it would share nodes of the grid, and stick together through it")
            .help(format!(
                "make it {} m thick, or the cells there smaller",
                number((1e3 * LEAST_CELLS * cell - 1e-6).ceil() / 1e3)
            ));
    }
    match part.surface(cell) {
        Ok(_) => {}
        Err(SurfaceError::RoundedAway { side, rounding }) => {
            problems
                .error(
                    common.rounding.place,
                    format!(
                        "with corners rounded by {} m nothing is left of side {} of the rigid body `{name}`",
                        number(rounding),
                        side + 1
                    ),
                )
                .help("a smaller rounding, smaller cells there, or a longer side");
        }
        Err(error) => {
            problems
                .error(
                    body.name.place,
                    format!("the rigid body `{name}` cannot be made: {error}"),
                )
                .help(if D == 2 {
                    "soil is only within the domain: the body need not reach far beyond it"
                } else {
                    "a smaller rounding, or smaller cells there, may help"
                });
        }
    }
    if part.grid_follows {
        on_row(lower[D - 1], common.grid_follows.place, frame, problems);
    }
}

/// Refuses a body that the grid follows and whose lowest place is on no row of it.
fn on_row<const D: usize>(level: f64, at: Place, frame: &Frame<D>, problems: &mut Problems) {
    let row = frame.axes[D - 1].place(level);
    if (row - row.round()).abs() > 1e-6 || row.round() < 1.0 {
        let up = if D == 2 { "y" } else { "z" };
        problems
            .error(
                at,
                format!(
                    "no row of the grid lies at {up} = {} m, its lowest place",
                    number(level)
                ),
            )
            .help(format!(
                "add lines = {{ {up} = [\"{} m\"] }} to [grid]",
                number(level)
            ));
    }
}

/// Refuses a second thing that the grid would follow.
fn follow_once<const D: usize>(
    bodies: &[Thing<RigidBody<D>>],
    (mut is_taken, help): (bool, &str),
    problems: &mut Problems,
) {
    let common = bodies.iter().flatten().flat_map(|body| &body.common);
    for table in common {
        if *table.grid_follows && std::mem::replace(&mut is_taken, true) {
            problems
                .error(
                    table.grid_follows.place,
                    "the grid follows something else already",
                )
                .help(help);
        }
    }
}
