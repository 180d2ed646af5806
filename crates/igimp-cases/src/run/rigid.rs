//! Rigid bodies of a case as the solver has them: made, placed, moved, and what they did.

use igimp_assembly::{Drive, Interface, Particles, RigidBody, RigidMotion, Shear};
use igimp_solver::{Accepted, StepFailure};

use super::model::Model;
use super::records::Moment;
use super::state::{Controls, RigidTrack, State};
use crate::case::{
    Adhesion, Case, RigidDrive, RigidInterface, RigidMove, RigidPart, RigidQuantity, RigidShape,
    RigidShear,
};
use crate::check::short;
use crate::error::CaseError;
use crate::table::Table;

/// A body is not set down by less than this share of a cell \[-\].
const LEAST_SHIFT: f64 = 1e-9;

/// The smallest cell that a rigid body starts in \[m\].
pub(crate) fn cell_near(case: &Case, part: &RigidPart) -> f64 {
    let (lower, upper) = part.bounds();
    let [x, y] = &case.grid.axes;
    x.smallest_between(lower[0], upper[0])
        .min(y.smallest_between(lower[1], upper[1]))
}

/// A rigid body of a case where it starts, among so many laws: one for each material, again and again.
pub(crate) fn made(case: &Case, index: usize, laws: usize) -> Result<RigidBody<2>, CaseError> {
    let part = &case.rigid[index];
    let surface = part
        .surface(cell_near(case, part))
        .map_err(|source| CaseError::RigidBody {
            name: part.name.clone(),
            source,
        })?;
    let interfaces = part.interfaces.iter();
    let interfaces = interfaces.map(|own| interface(case, own, laws)).collect();
    let mut body = RigidBody::new(surface, interfaces, part.reference);
    body.name.clone_from(&part.name);
    body.penalty.stiffness = part.stiffness;
    Ok(body)
}

fn interface(case: &Case, of: &RigidInterface, laws: usize) -> Interface {
    let shear = match of.shear {
        RigidShear::Smooth => Shear::Smooth,
        RigidShear::Rough => Shear::Rough,
        RigidShear::Limited { friction, adhesion } => {
            let by_material = case.materials.iter().map(|material| match adhesion {
                Adhesion::Stress(stress) => stress,
                Adhesion::Share(share) => share * material.cohesive(),
            });
            let by_material: Vec<f64> = by_material.collect();
            Shear::Limited {
                adhesion: by_material.into_iter().cycle().take(laws).collect(),
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

/// Own weight, with what pseudo-static acceleration adds to it, along the axes \[N/m\].
fn weight(part: &RigidPart, controls: &Controls) -> [f64; 3] {
    let [x, y] = controls.body_force().map(|share| share * part.weight);
    [x, y, 0.0]
}

/// How the rigid bodies that are there move in a step between two controls.
pub(crate) fn motions(case: &Case, from: &Controls, to: &Controls) -> Vec<RigidMotion<2>> {
    to.placed()
        .map(|index| {
            let (part, own, before) = (&case.rigid[index], &to.rigid[index], &from.rigid[index]);
            let weight = weight(part, to);
            let drive = |k: usize| match own.loaded[k] {
                Some(force) => Drive::Loaded((force + weight[k]) / part.force_factor),
                None => Drive::Moved(own.moved[k] - before.moved[k]),
            };
            RigidMotion {
                displacement: [drive(0), drive(1)],
                rotation: [drive(2), Drive::Moved(0.0), Drive::Moved(0.0)],
            }
        })
        .collect()
}

/// What the rigid bodies did by the end of an accepted step, at whose end `controls` act; they tell what
/// was done before.
pub(crate) fn tracks(
    case: &Case,
    controls: &Controls,
    accepted: &Accepted<'_, 2>,
) -> Vec<RigidTrack> {
    let first = accepted.conditions.grid.node_count();
    let (u, reactions) = (&accepted.forces.u, &accepted.forces.reactions);
    let mut tracks = controls.tracks();
    for ((slot, index), body) in std::iter::zip(controls.placed().enumerate(), &accepted.body.rigid)
    {
        let (part, own) = (&case.rigid[index], &controls.rigid[index]);
        let node = first + 2 * slot;
        let size = body.surface.size();
        let by = [u[node][0], u[node][1], u[node + 1][0] / size];
        let reaction = [
            reactions[node][0],
            reactions[node][1],
            reactions[node + 1][0] * size,
        ];
        let weight = weight(part, controls);
        let track = &mut tracks[index];
        for k in 0..3 {
            track.displacement[k] += by[k];
            track.force[k] = own.loaded[k].unwrap_or(part.force_factor * reaction[k] - weight[k]);
        }
        track.lowered = part.reference[1] - body.pose.origin[1];
    }
    tracks
}

/// Prepares a state for a stage that moves rigid bodies: those that are not there are placed, and what
/// held a component hands over to the force that will drive it. Tells of bodies that were shifted.
pub(crate) fn begin(
    model: &Model<'_>,
    state: &mut State,
    moves: &[RigidMove],
) -> Result<Vec<String>, CaseError> {
    let mut told = Vec::new();
    for own in moves {
        if !state.controls.rigid[own.body].placed {
            told.extend(place(model, state, own.body)?);
        }
        let body = &mut state.controls.rigid[own.body];
        for (k, drive) in own.drives.iter().enumerate() {
            match drive {
                Some(RigidDrive::By(_)) => body.loaded[k] = None,
                Some(RigidDrive::Force(_)) => {
                    body.loaded[k] = body.loaded[k].or(Some(body.track.force[k]));
                }
                None => {}
            }
        }
    }
    Ok(told)
}

/// Puts a rigid body where it starts, or by as much lower as the soil beneath it settled.
fn place(model: &Model<'_>, state: &mut State, index: usize) -> Result<Option<String>, CaseError> {
    let case = model.case;
    let part = &case.rigid[index];
    let mut body = made(case, index, model.laws.len())?;
    let settled = gap_below(part, &state.body.particles) - model.gaps[index];
    let is_shifted = settled.is_finite() && settled.abs() > LEAST_SHIFT * cell_near(case, part);
    if is_shifted {
        body.pose.origin[1] -= settled;
        state.controls.rigid[index].track.lowered = settled;
    }
    let slot = state.controls.placed().take_while(|&k| k < index).count();
    state.body.rigid.insert(slot, body);
    state.controls.rigid[index].placed = true;
    state.body.particles.clear_of(&state.body.rigid);
    let way = if settled > 0.0 { "down" } else { "up" };
    Ok(is_shifted.then(|| {
        format!(
            "the rigid body \"{}\" was set {way} by {} m, as far as the soil beneath it went",
            part.name,
            short(settled.abs())
        )
    }))
}

/// The smallest vertical distance from soil up to a body where it starts \[m\]; infinite where no soil
/// lies beneath it.
pub(crate) fn gap_below(part: &RigidPart, particles: &Particles<2>) -> f64 {
    let (lower, upper) = part.bounds();
    let corners = part.outline(0);
    let mut least = f64::INFINITY;
    for (x, half) in std::iter::zip(&particles.x, &particles.half_length) {
        let (left, right) = (
            (x[0] - half[0]).max(lower[0]),
            (x[0] + half[0]).min(upper[0]),
        );
        if right - left <= 1e-6 * half[0] {
            continue;
        }
        let within = corners.iter().map(|corner| corner[0]);
        let within = within.filter(|at| left < *at && *at < right);
        let underside = [left, right].into_iter().chain(within);
        let lowest = underside
            .map(|at| underside_at(part, at))
            .fold(f64::INFINITY, f64::min);
        let lowest = match part.shape {
            RigidShape::Circle { centre, .. } => {
                lowest.min(underside_at(part, centre[0].clamp(left, right)))
            }
            RigidShape::Polygon(_) => lowest,
        };
        if x[1] < lowest {
            least = least.min(lowest - x[1] - half[1]);
        }
    }
    least
}

/// The lowest place of a body on an upright line \[m\].
fn underside_at(part: &RigidPart, x: f64) -> f64 {
    match &part.shape {
        RigidShape::Polygon(corners) => {
            let next = corners.iter().cycle().skip(1);
            let edges = std::iter::zip(corners, next);
            let crossed = edges.filter(|(p, q)| p[0].min(q[0]) <= x && x <= p[0].max(q[0]));
            crossed
                .map(|(p, q)| {
                    let run = q[0] - p[0];
                    if run == 0.0 {
                        p[1].min(q[1])
                    } else {
                        p[1] + (x - p[0]) / run * (q[1] - p[1])
                    }
                })
                .fold(f64::INFINITY, f64::min)
        }
        RigidShape::Circle { centre, radius } => {
            centre[1] - (radius * radius - (x - centre[0]).powi(2)).max(0.0).sqrt()
        }
    }
}

/// A number of a rigid body; zero for one that is not there.
pub(crate) fn quantity(
    case: &Case,
    controls: &Controls,
    bodies: &[RigidBody<2>],
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
        RigidQuantity::X => track.displacement[0],
        RigidQuantity::Y => track.displacement[1],
        RigidQuantity::Settlement => -track.displacement[1] + 0.0,
        RigidQuantity::Rotation => track.displacement[2],
        RigidQuantity::ForceX => track.force[0],
        RigidQuantity::ForceY => track.force[1],
        RigidQuantity::Resistance => -track.force[1] + 0.0,
        RigidQuantity::Moment => track.force[2],
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

/// What is recorded of a rigid body.
const RECORDED: [(&str, RigidQuantity); 11] = [
    ("displacement_x_[m]", RigidQuantity::X),
    ("displacement_y_[m]", RigidQuantity::Y),
    ("rotation_[rad]", RigidQuantity::Rotation),
    ("force_x_[N/m]", RigidQuantity::ForceX),
    ("force_y_[N/m]", RigidQuantity::ForceY),
    ("moment_[N m/m]", RigidQuantity::Moment),
    ("contact_width_[m]", RigidQuantity::ContactWidth),
    ("penetration_[cells]", RigidQuantity::Penetration),
    ("closed_[-]", RigidQuantity::Closed),
    ("slipping_[-]", RigidQuantity::Slipping),
    ("resistance_down_+_[N/m]", RigidQuantity::Resistance),
];

/// An empty history of a rigid body.
pub(crate) fn table(name: &str) -> Table {
    let place = ["stage", "step", "progress_[-]", "x_[m]", "y_[m]"];
    let header = place.into_iter().chain(RECORDED.map(|(label, _)| label));
    Table {
        name: name.to_owned(),
        header: header.map(str::to_owned).collect(),
        rows: Vec::new(),
    }
}

/// The row of a rigid body that is there.
pub(crate) fn row(case: &Case, moment: &Moment<'_>, index: usize) -> Vec<f64> {
    let (controls, bodies) = (moment.controls, moment.rigid);
    let slot = controls.placed().take_while(|&k| k < index).count();
    let [x, y] = bodies[slot].pose.origin;
    let place = [
        moment.stage as f64 + 1.0,
        moment.number as f64,
        moment.progress,
        x,
        y,
    ];
    let numbers = RECORDED.map(|(_, of)| quantity(case, controls, bodies, index, of));
    place.into_iter().chain(numbers).collect()
}

/// The failure of a step that left soil further in a body than the case allows.
pub(crate) fn too_deep(
    case: &Case,
    controls: &Controls,
    bodies: &[RigidBody<2>],
) -> Option<StepFailure> {
    std::iter::zip(controls.placed(), bodies).find_map(|(index, body)| {
        let part = &case.rigid[index];
        let share = quantity(case, controls, bodies, index, RigidQuantity::Penetration);
        let places = body.surface.knots();
        let closed = std::iter::zip(&body.contact.knots, places).filter(|(own, _)| own.is_closed);
        let (_, (deepest, _)) = closed.min_by(|(a, _), (b, _)| a.gap.total_cmp(&b.gap))?;
        let [x, y] = body.pose.into_space(&deepest);
        (share > part.most_penetration).then(|| StepFailure::TooDeep {
            body: part.name.clone(),
            share,
            position: [x, y, 0.0],
        })
    })
}

/// The outlines of the rigid bodies that are there, where they stand \[m\]; a circle as so many points.
pub fn outlines<'a>(
    case: &'a Case,
    state: &'a State,
    points_of_circle: usize,
) -> impl Iterator<Item = (&'a RigidPart, Vec<[f64; 2]>)> {
    let there = std::iter::zip(state.controls.placed(), &state.body.rigid);
    there.map(move |(index, body)| {
        let part = &case.rigid[index];
        let outline = part.outline(points_of_circle).into_iter().map(|at| {
            let own = [at[0] - part.reference[0], at[1] - part.reference[1]];
            body.pose.into_space(&own)
        });
        (part, outline.collect())
    })
}
