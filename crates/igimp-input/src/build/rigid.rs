//! Rigid bodies: what their sides are like, and whether the grid has a place for them.

pub(crate) mod plane;
pub(crate) mod space;
pub(crate) mod stage;

use std::sync::Arc;

use igimp_assembly::{SurfaceError, Tension};
use igimp_model::{Adhesion, Material, RigidForm, RigidInterface, RigidPart, RigidShear, Strength};
use igimp_schema::diagnostic::Problems;
use igimp_schema::text::{clip, number};
use igimp_schema::tree::Node;

use super::grid::Frame;

/// A body is at least so many cells thick.
const LEAST_CELLS: f64 = 2.0;

/// A shape, and what is told of it.
pub(super) struct Basis<const D: usize> {
    pub(super) shape: Arc<dyn RigidForm<D>>,
    /// The point that displacement and forces are told of \[m\].
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

/// The rigid body that a shape becomes.
pub(super) fn part_of<const D: usize>(
    node: &Node,
    basis: Option<Basis<D>>,
    (frame, materials): (Option<&Frame<D>>, &[Option<Material>]),
    problems: &mut Problems,
) -> Option<RigidPart<D>> {
    let whole = interface(node, None, materials, problems);
    let basis = basis?;
    let interfaces = all_sides(node, whole?, &basis.sides, materials, problems);
    let part = RigidPart {
        name: node.text_at("name")?.to_owned(),
        reference: basis.reference,
        shape: basis.shape,
        interfaces: interfaces?,
        stiffness: node.number_at("stiffness")?,
        rounding: node.number_at("rounding")?,
        weight: node.number_at("weight")?,
        force_factor: node.number_at("force_factor")?,
        grid_follows: node.flag_at("grid_follows")?,
        from_start: node.flag_at("from_start")?,
        most_penetration: node.number_at("most_penetration")?,
    };
    if let Some(frame) = frame {
        in_grid(node, (&part, basis.thickness), frame, problems);
    }
    Some(part)
}

/// What a table says of its interface; what it does not say is that of the whole body.
fn interface(
    node: &Node,
    whole: Option<RigidInterface>,
    materials: &[Option<Material>],
    problems: &mut Problems,
) -> Option<RigidInterface> {
    let shear = match node.get("interface") {
        Some(value) => shear(value, materials, problems)?,
        None => whole?.shear,
    };
    let limit = node.optional_number("tension_limit").ok()?;
    if let (Some(_), Some("bonded")) = (limit, node.text_at("tension")) {
        problems
            .error(
                node.place_at("tension_limit"),
                "soil that is bonded never lets go: there is no limit",
            )
            .help("keep one of tension and tension_limit");
    }
    let tension = match (limit, node.text_at("tension")) {
        (Some(limit), _) => Tension::Limit(limit),
        (None, Some("bonded")) => Tension::Bonded,
        (None, Some(_)) => Tension::None,
        (None, None) => whole?.tension,
    };
    Some(RigidInterface { shear, tension })
}

fn shear(
    value: &Node,
    materials: &[Option<Material>],
    problems: &mut Problems,
) -> Option<RigidShear> {
    match value.text() {
        Some("smooth") => return Some(RigidShear::Smooth),
        Some(_) => return Some(RigidShear::Rough),
        None if value.is_invalid() => return None,
        None => {}
    }
    let number = |key| value.optional_number(key).ok();
    let friction = match (number("friction")?, number("angle")?) {
        (Some(_), Some(_)) => {
            problems
                .error(
                    value.place_at("angle"),
                    "both `friction` and `angle` are given",
                )
                .help("keep one of them");
            return None;
        }
        (friction, angle) => friction.or(angle.map(f64::tan)).unwrap_or(0.0),
    };
    if !(0.0..=1e3).contains(&friction) {
        problems.error(
            value.place_at("angle"),
            "an angle of friction is less than 90 deg",
        );
        return None;
    }
    let adhesion = match (number("adhesion")?, number("adhesion_share")?) {
        (Some(_), Some(_)) => {
            problems
                .error(
                    value.place_at("adhesion_share"),
                    "both `adhesion` and `adhesion_share` are given",
                )
                .help("keep one of them");
            return None;
        }
        (None, Some(share)) => {
            for material in materials.iter().flatten() {
                if material.strength == Strength::Elastic {
                    problems.warning(
                        value.place_at("adhesion_share"),
                        format!(
                            "the material `{}` is elastic and has no strength to take a share of: no \
                             adhesion where it touches",
                            clip(&material.name, 40)
                        ),
                    );
                }
            }
            Adhesion::Share(share)
        }
        (stress, None) => Adhesion::Stress(stress.unwrap_or(0.0)),
    };
    Some(RigidShear::Limited { friction, adhesion })
}

/// The interface of each side.
fn all_sides(
    node: &Node,
    whole: RigidInterface,
    sides: &Sides,
    materials: &[Option<Material>],
    problems: &mut Problems,
) -> Option<Vec<RigidInterface>> {
    let Sides { count, names } = sides;
    let mut interfaces = vec![whole; *count];
    for own in node.items_at("sides") {
        let value = own.get("side")?;
        let side = match value.text() {
            Some(name) => names.iter().position(|known| *known == name),
            None => value.count()?.checked_sub(1),
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
            let kind = node.text_at("type")?;
            problems
                .error(value.place, format!("a {kind} has no such side"))
                .help(format!("sides here: {known}"));
            return None;
        };
        interfaces[side] = interface(own, Some(whole), materials, problems)?;
    }
    Some(interfaces)
}

/// Refuses a body that lies outside the grid, or is too thin for it.
fn in_grid<const D: usize>(
    node: &Node,
    (part, thickness): (&RigidPart<D>, f64),
    frame: &Frame<D>,
    problems: &mut Problems,
) {
    let name = clip(&part.name, 40);
    let (lower, upper) = part.bounds();
    if (0..D).any(|k| upper[k] <= frame.lower[k] || lower[k] >= frame.upper[k]) {
        problems
            .error(
                node.place_at("name"),
                format!("the rigid body `{name}` lies outside the grid domain"),
            )
            .help("soil is only within the domain: move the body, or extend [grid] domain");
        return;
    }
    let axes = frame.axes.iter().enumerate();
    let cell = axes
        .map(|(axis, own)| own.smallest_between(lower[axis], upper[axis]))
        .fold(f64::INFINITY, f64::min);
    if thickness < LEAST_CELLS * cell * (1.0 - 1e-9) {
        problems
            .error(
                node.place_at("name"),
                format!(
                    "the rigid body `{name}` is {} m thick, thinner than two cells of {} m",
                    number(thickness),
                    number(cell)
                ),
            )
            .help("soil on both sides of it would share nodes of the grid, and stick together through it")
            .help(format!(
                "make it {} m thick, or the cells there smaller",
                number(LEAST_CELLS * cell)
            ));
    }
    match part.surface(cell) {
        Ok(_) => {}
        Err(SurfaceError::RoundedAway { side, rounding }) => {
            problems
                .error(
                    node.place_at("rounding"),
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
                    node.place_at("name"),
                    format!("the rigid body `{name}` cannot be made: {error}"),
                )
                .help(if D == 2 {
                    "soil is only within the domain: the body need not reach far beyond it"
                } else {
                    "a smaller rounding, or smaller cells there, may help"
                });
        }
    }
    let level = lower[D - 1];
    if part.grid_follows {
        let place = frame.axes[D - 1].place(level);
        if (place - place.round()).abs() > 1e-6 || place.round() < 1.0 {
            let up = if D == 2 { "y" } else { "z" };
            problems
                .error(
                    node.place_at("grid_follows"),
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
}

/// Refuses a second thing that the grid would follow.
pub(super) fn follow_once(
    nodes: &[Node],
    (mut is_taken, help): (bool, &str),
    problems: &mut Problems,
) {
    for node in nodes {
        if node.flag_at("grid_follows") == Some(true) && std::mem::replace(&mut is_taken, true) {
            problems
                .error(
                    node.place_at("grid_follows"),
                    "the grid follows something else already",
                )
                .help(help);
        }
    }
}
