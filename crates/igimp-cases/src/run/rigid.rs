//! Rigid bodies of a case as the solver has them: made, placed, moved, and their motion.

use igimp_assembly::{Drive, Interface, Particles, RigidBody, RigidMotion, Shear};
use igimp_model::{
    Adhesion, Case, RigidInterface, RigidPart, RigidQuantity, RigidShear, components, in_space,
    overlap_of_rigid,
};
use igimp_solver::{Accepted, StepFailure};
use igimp_text::short;

use super::state::{Controls, State};
use crate::error::CaseError;

/// The smallest cell that a rigid body starts in \[m\].
pub(crate) fn cell_near<const D: usize>(case: &Case<D>, part: &RigidPart<D>) -> f64 {
    let (lower, upper) = part.bounds();
    let cells = (case.grid.axes.iter().enumerate())
        .map(|(k, axis)| axis.smallest_between(lower[k], upper[k]));
    cells.fold(f64::INFINITY, f64::min)
}

/// A rigid body of a case where it starts, among so many laws.
pub(crate) fn made<const D: usize>(
    case: &Case<D>,
    index: usize,
    laws: usize,
) -> Result<RigidBody<D>, CaseError> {
    let part = &case.rigid[index];
    let surface = part
        .surface(cell_near(case, part))
        .map_err(|source| CaseError::RigidBody {
            name: part.name.clone(),
            source,
        })?;
    let interfaces = part.interfaces.iter();
    let interfaces = interfaces.map(|side| interface(case, side, laws)).collect();
    let mut body = RigidBody::new(surface, interfaces, part.reference);
    body.name.clone_from(&part.name);
    body.penalty.stiffness = part.stiffness;
    body.motion.mass = part.mass(case.gravity);
    body.motion.centre = part.arm();
    body.motion.moments = part.moments_of_inertia(case.gravity);
    Ok(body)
}

fn interface<const D: usize>(case: &Case<D>, of: &RigidInterface, laws: usize) -> Interface {
    let shear = match of.shear {
        RigidShear::Smooth => Shear::Smooth,
        RigidShear::Rough => Shear::Rough,
        RigidShear::Limited { friction, adhesion } => {
            let of_law = |law: usize| match adhesion {
                Adhesion::Stress(stress) => stress,
                Adhesion::Share(share) => share * case.material_of(law).cohesive(),
            };
            Shear::Limited {
                adhesion: (0..laws).map(of_law).collect(),
                varies: matches!(adhesion, Adhesion::Share(_)),
                friction,
            }
        }
    };
    Interface {
        shear,
        tension: of.tension,
    }
}

/// Own weight and the force of pseudo-static acceleration, by component \[N/m\], of whole bodies \[N\].
fn weight<const D: usize>(part: &RigidPart<D>, controls: &Controls) -> [f64; D] {
    controls.body_force::<D>().map(|share| share * part.weight)
}

/// How the rigid bodies that are there move in a step between two controls.
pub(crate) fn motions<const D: usize>(
    case: &Case<D>,
    from: &Controls,
    to: &Controls,
) -> Vec<RigidMotion<D>> {
    to.placed()
        .map(|index| {
            let (part, after, before) = (&case.rigid[index], &to.rigid[index], &from.rigid[index]);
            let drive = |k: usize| match after.loaded[k] {
                Some(force) => Drive::Loaded(force / part.force_factor),
                None => Drive::Moved(after.moved[k] - before.moved[k]),
            };
            RigidMotion {
                displacement: std::array::from_fn(drive),
                rotation: std::array::from_fn(|k| {
                    if D + k < components::<D>() {
                        drive(D + k)
                    } else {
                        Drive::Moved(0.0)
                    }
                }),
                weight: weight(part, to).map(|force| force / part.force_factor),
            }
        })
        .collect()
}

/// The controls that act at the end of an accepted step, with the motion of the rigid bodies in that step added to their
/// tracks.
pub(crate) fn moved<const D: usize>(
    case: &Case<D>,
    mut controls: Controls,
    accepted: &Accepted<'_, D>,
) -> Controls {
    let first = accepted.conditions.grid.node_count();
    let [u, reactions] =
        [&accepted.forces.u, &accepted.forces.reactions].map(|by_node| &by_node[first..]);
    let placed = controls.rigid.iter_mut().zip(&case.rigid);
    let placed = placed.filter(|(control, _)| control.placed);
    for ((slot, (control, part)), body) in std::iter::zip(placed.enumerate(), &accepted.body.rigid)
    {
        let (motion, resultant) = (body.motion_of(slot, u), body.resultant_of(slot, reactions));
        let track = &mut control.track;
        for k in 0..components::<D>() {
            let reaction = resultant[k / D][k % D];
            track.displacement[k] += motion[k / D][k % D];
            // Around an axis there is a resultant along it, and no other.
            if k != D - 1 && case.method.section.is_axisymmetric() {
                continue;
            }
            track.force[k] = control.loaded[k].unwrap_or(part.force_factor * reaction);
        }
        track.lowered = part.reference[D - 1] - body.pose.origin[D - 1];
    }
    controls
}

/// The smallest vertical distance from soil up to a body where it starts \[m\]; infinite where no soil
/// lies beneath it.
pub(crate) fn gap_below<const D: usize>(part: &RigidPart<D>, particles: &Particles<D>) -> f64 {
    let (lower, upper) = part.bounds();
    let up = D - 1;
    let mut least = f64::INFINITY;
    for (x, half) in std::iter::zip(&particles.x, &particles.half_length) {
        let from: [f64; D] = std::array::from_fn(|axis| (x[axis] - half[axis]).max(lower[axis]));
        let to: [f64; D] = std::array::from_fn(|axis| (x[axis] + half[axis]).min(upper[axis]));
        if (0..up).any(|axis| to[axis] - from[axis] <= 1e-6 * half[axis]) {
            continue;
        }
        let lowest = part.shape.underside(&from, &to);
        if x[up] < lowest {
            least = least.min(lowest - x[up] - half[up]);
        }
    }
    least
}

/// Whether a body stands on a level base: soil under it touches all of the base at once.
pub(crate) fn has_level_base<const D: usize>(part: &RigidPart<D>) -> bool {
    const SHARES: [f64; 5] = [0.2, 0.35, 0.5, 0.65, 0.8];
    let (lower, upper) = part.bounds();
    let off = |share: f64| {
        let at = std::array::from_fn(|axis| lower[axis] + share * (upper[axis] - lower[axis]));
        (part.shape.underside(&at, &at) - lower[D - 1]).abs()
    };
    let height = upper[D - 1] - lower[D - 1];
    SHARES.into_iter().all(|share| off(share) <= 1e-9 * height)
}

/// A number of a rigid body; zero for one that is not there.
pub(crate) fn quantity<const D: usize>(
    case: &Case<D>,
    controls: &Controls,
    bodies: &[RigidBody<D>],
    index: usize,
    of: RigidQuantity,
) -> f64 {
    let Some((_, body)) = std::iter::zip(controls.placed(), bodies).find(|(k, _)| *k == index)
    else {
        return 0.0;
    };
    let track = &controls.rigid[index].track;
    let knots = || body.contact.knots.iter();
    match of {
        RigidQuantity::Displacement(axis) => track.displacement[axis],
        RigidQuantity::Settlement => -track.displacement[D - 1] + 0.0,
        RigidQuantity::Rotation(axis) => track.displacement[D + axis],
        RigidQuantity::Force(axis) => track.force[axis],
        RigidQuantity::Resistance => -track.force[D - 1] + 0.0,
        RigidQuantity::Moment(axis) => track.force[D + axis],
        RigidQuantity::Velocity(axis) => body.motion.velocity[axis],
        RigidQuantity::Spin(axis) => body.motion.spin[axis],
        RigidQuantity::ContactWidth => {
            let closed = knots().filter(|knot| knot.is_closed);
            closed
                .map(|knot| knot.area)
                .fold(0.0, |sum, area| sum + area)
        }
        RigidQuantity::Penetration => {
            let closed = knots().filter(|knot| knot.is_closed);
            let deepest = closed.map(|knot| -knot.gap).fold(0.0, f64::max);
            deepest / cell_near(case, &case.rigid[index])
        }
        RigidQuantity::Closed => knots().filter(|knot| knot.is_closed).count() as f64,
        RigidQuantity::Slipping => knots().filter(|knot| knot.slips).count() as f64,
    }
}

/// Recorded quantities of a rigid body, with labels.
pub(crate) fn recorded<const D: usize>(case: &Case<D>) -> Vec<(String, RigidQuantity)> {
    let per_run = case.per_metre();
    let mut recorded = Vec::new();
    let mut add = |label: String, of| recorded.push((label, of));
    let axes = || ["x", "y", "z"].into_iter().take(D).enumerate();
    let turns: &[&str] = if D == 2 { &[""] } else { &["_x", "_y", "_z"] };
    for (axis, name) in axes() {
        let label = format!("displacement_{name}_[m]");
        add(label, RigidQuantity::Displacement(axis));
    }
    for (axis, about) in turns.iter().enumerate() {
        let label = format!("rotation{about}_[rad]");
        add(label, RigidQuantity::Rotation(axis));
    }
    for (axis, name) in axes() {
        let label = format!("force_{name}_[N{per_run}]");
        add(label, RigidQuantity::Force(axis));
    }
    for (axis, about) in turns.iter().enumerate() {
        let label = format!("moment{about}_[N m{per_run}]");
        add(label, RigidQuantity::Moment(axis));
    }
    if case.has_motion() {
        for (axis, name) in axes() {
            let label = format!("velocity_{name}_[m/s]");
            add(label, RigidQuantity::Velocity(axis));
        }
        for (axis, about) in turns.iter().enumerate() {
            let label = format!("spin{about}_[rad/s]");
            add(label, RigidQuantity::Spin(axis));
        }
    }
    let contact = if case.is_whole() {
        "contact_area_[m2]"
    } else {
        "contact_width_[m]"
    };
    add(contact.to_owned(), RigidQuantity::ContactWidth);
    add("penetration_[cells]".to_owned(), RigidQuantity::Penetration);
    add("closed_[-]".to_owned(), RigidQuantity::Closed);
    add("slipping_[-]".to_owned(), RigidQuantity::Slipping);
    let label = format!("resistance_down_+_[N{per_run}]");
    add(label, RigidQuantity::Resistance);
    recorded
}

/// The failure of a step that left soil further in a body than the case allows.
pub(crate) fn too_deep<const D: usize>(
    case: &Case<D>,
    controls: &Controls,
    bodies: &[RigidBody<D>],
) -> Option<StepFailure> {
    std::iter::zip(controls.placed(), bodies).find_map(|(index, body)| {
        let part = &case.rigid[index];
        let share = quantity(case, controls, bodies, index, RigidQuantity::Penetration);
        let places = body.surface.knots();
        let closed = std::iter::zip(&body.contact.knots, places).filter(|(knot, _)| knot.is_closed);
        let (_, (deepest, _)) = closed.min_by(|(a, _), (b, _)| a.gap.total_cmp(&b.gap))?;
        let deepest = body.pose.into_space(&deepest);
        (share > part.most_penetration).then(|| StepFailure::TooDeep {
            body: part.name.clone(),
            share,
            position: in_space(&deepest),
        })
    })
}

/// Rigid bodies that reach into each other by less than this share of a cell touch \[-\].
const TOUCH: f64 = 1e-3;

/// The warning of two rigid bodies that have come into each other: which they are, and how far. Nothing keeps them apart.
pub(crate) fn meet<const D: usize>(
    case: &Case<D>,
    controls: &Controls,
    bodies: &[RigidBody<D>],
) -> Option<(String, String)> {
    let there: Vec<_> = std::iter::zip(controls.placed(), bodies).collect();
    let pairs = (there.iter().enumerate())
        .flat_map(|(k, second)| there[..k].iter().map(move |first| (first, second)));
    let mut deep = pairs.filter_map(|(&(a, first), &(b, second))| {
        let depth = overlap_of_rigid(first, second);
        let cell = cell_near(case, &case.rigid[a]).min(cell_near(case, &case.rigid[b]));
        (depth > TOUCH * cell).then_some((a, b, depth))
    });
    let (a, b, depth) = deep.next()?;
    let [first, second] = [a, b].map(|index| &case.rigid[index].name);
    Some((
        format!(
            "the rigid bodies \"{first}\" and \"{second}\" have met, and nothing keeps them apart: "
        ),
        format!(
            "they overlap by {} m; what follows is that of bodies which pass through each other",
            short(depth)
        ),
    ))
}

/// The outlines of the rigid bodies that are there, where they stand \[m\]; a circle as so many points.
pub fn outlines<'a>(
    case: &'a Case<2>,
    state: &'a State<2>,
    points_of_circle: usize,
) -> impl Iterator<Item = (&'a RigidPart<2>, Vec<[f64; 2]>)> {
    let there = std::iter::zip(state.controls.placed(), &state.body.rigid);
    there.map(move |(index, body)| {
        let part = &case.rigid[index];
        let outline = part.outline(points_of_circle).into_iter().map(|at| {
            let local = [at[0] - part.reference[0], at[1] - part.reference[1]];
            body.pose.into_space(&local)
        });
        (part, outline.collect())
    })
}
