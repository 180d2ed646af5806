//! How long the next step of a motion may be (theory, eqs. 68 to 68d): by the error of the time integration, by how far the body moves,
//! by changes of contact, and by how hard equilibrium was to find; where water flows by the error of its pressures alone (eq. 104), and as
//! long as they may be where a stage takes time and no water is there to flow.

use igimp_assembly::{ContactChange, Drive, RigidMotion, System, Trial};
use igimp_shape::Grid;

use crate::body::Body;

/// The error of a step that is aimed at, over its motion \[-\].
const ERROR: f64 = 0.02;

/// The longest way of a node in a step that is aimed at, in cells \[-\].
const WAY: f64 = 0.2;

/// The longest way of soil to a rigid body in a step in which a gap closes that is aimed at, in cells (theory, eq. 68a) \[-\]. A choice:
/// with 0.05 the depth of an impact scatters by 7 % with the times that steps land on, with this by 5 %.
const CLOSING: f64 = 0.02;

/// How many times as long that way may be before the step is made again, shorter \[-\].
const CLOSING_REFUSED: f64 = 2.0;

/// How many times as large error or way may be before the step is made again, shorter \[-\].
const REFUSED: f64 = 4.0;

/// The share of the speed of approach that contact takes in a step which is made again, shorter (theory, eq. 68c) \[-\]. A choice: contact
/// takes some such share of the energy of a blow, and a shorter step is one of ten more.
const BLOW: f64 = 0.02;

/// How many times as large that share may be before the step is made again \[-\].
const BLOW_REFUSED: f64 = 2.0;

/// The way by which friction drives what it should hold back in a step that is aimed at, in cells (theory, eq. 68d) \[-\]. A choice: a
/// block that slides to and fro by a tenth of a cell drifts by a thirtieth with none, by a hundredth with this.
const PUSH: f64 = 5e-5;

/// Bodies that approach no faster than by falling this far, in cells, meet softly (theory, eq. 68c) \[-\].
const FALL: f64 = 1e-3;

/// The least share of a step that is made again, shorter \[-\].
const LEAST: f64 = 1.0 / 64.0;

/// The error that is aimed at where water flows, over its pressures \[-\].
const FLOW_ERROR: f64 = 2e-3;

/// Corrections from which on the next step is shorter.
const CORRECTIONS: usize = 10;

/// Bounds of the change of duration from step to step \[-\].
const CHANGE: [f64; 2] = [0.5, 1.5];

/// How long steps may be, by one that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pacing {
    /// How many times as long the next one may be \[-\].
    pub(crate) next: f64,
    /// How many times as long this one may be where it was too long \[-\].
    pub(crate) again: Option<f64>,
}

/// The pace after a step by nodal displacements `u` \[length\] of a body that was in this state before.
pub(crate) fn after<const D: usize>(
    system: &System<'_, D>,
    (trial, u): (&Trial<D>, &[[f64; D]]),
    body: &Body<D>,
    iterations: usize,
) -> Pacing {
    let again = |is_too_long: bool| is_too_long.then_some(CHANGE[0]);
    if let Some(error) = system.flow_error(trial, u) {
        let factor = (FLOW_ERROR / error).sqrt().min(effort(iterations));
        return Pacing {
            next: factor.clamp(CHANGE[0], CHANGE[1]),
            again: again(error > REFUSED * FLOW_ERROR),
        };
    }
    let Some(error) = system.time_error(u) else {
        // Where no water flows and nothing moves nothing asks for short steps.
        let next = (system.conditions().flow.as_ref()).map_or(1.0, |_| f64::INFINITY);
        return Pacing { next, again: None };
    };
    let grid = &system.conditions().grid;
    let cell = smallest_cell(grid);
    let length = |u: &[f64; D]| u.iter().map(|u| u * u).sum::<f64>().sqrt();
    let way = u
        .iter()
        .take(grid.node_count())
        .map(length)
        .fold(0.0, f64::max)
        / cell;
    let closing = system.closing(u);
    let [blow, push] = by_contact(system, u, body);
    let push = push / cell;
    let factor = ((ERROR / error).sqrt())
        .min(WAY / way)
        .min(CLOSING / closing)
        .min((PUSH / push).sqrt());
    let refused =
        error > REFUSED * ERROR || way > REFUSED * WAY || closing > CLOSING_REFUSED * CLOSING;
    let refused = refused || push > REFUSED * PUSH;
    let factor = factor.min(effort(iterations));
    let of_blow = (blow > BLOW_REFUSED * BLOW).then(|| (BLOW / blow).max(LEAST));
    Pacing {
        next: factor.clamp(CHANGE[0], CHANGE[1]),
        again: of_blow.or(again(refused)),
    }
}

/// The largest share of the speed with which soil and a rigid body approach that contact takes in a step by nodal displacements `u`
/// \[length\] (theory, eq. 68c) \[-\], and the longest way by which friction drives what it should hold back (eq. 68d) \[length\].
fn by_contact<const D: usize>(system: &System<'_, D>, u: &[[f64; D]], body: &Body<D>) -> [f64; 2] {
    let mut largest = [0.0_f64; 2];
    if body.rigid.is_empty() {
        return largest;
    }
    let conditions = system.conditions();
    let soft = FALL * smallest_cell(&conditions.grid);
    let squared = conditions.duration().powi(2);
    let mass_of_soil: f64 = body.particles.mass.iter().sum();
    let changes = system.changes_of_contact(u).into_iter();
    for (index, change) in changes.enumerate() {
        let ContactChange { force, work, .. } = change;
        if change.friction > 0.0 {
            largest[1] = largest[1].max(change.driven / change.friction);
        }
        if work <= 0.0 {
            continue;
        }
        let of_body = body.rigid[index].motion.mass;
        let (is_free, push) = (conditions.motions.get(index)).map_or((false, 0.0), pushed);
        let mass = if is_free && of_body > 0.0 {
            of_body * mass_of_soil / (of_body + mass_of_soil)
        } else {
            mass_of_soil
        };
        let way = work / force;
        if 0.5 * mass * way * way > squared * push * soft {
            largest[0] = largest[0].max(squared * force / (mass * way));
        }
    }
    largest
}

/// Whether forces move a body at all, and the magnitude of their sum \[force\].
fn pushed<const D: usize>(motion: &RigidMotion<D>) -> (bool, f64) {
    let forces = std::iter::zip(&motion.displacement, &motion.weight);
    let forces = forces.filter_map(|(drive, weight)| match drive {
        Drive::Loaded(force) => Some(force + weight),
        Drive::Moved(_) => None,
    });
    let is_free = forces.clone().next().is_some();
    (
        is_free,
        forces.map(|force| force * force).sum::<f64>().sqrt(),
    )
}

/// The smallest cell of a grid \[length\].
fn smallest_cell<const D: usize>(grid: &Grid<D>) -> f64 {
    (0..D)
        .flat_map(|axis| (0..grid.axes[axis].cell_count()).map(move |k| grid.axes[axis].spacing(k)))
        .fold(f64::INFINITY, f64::min)
}

/// How many times as long the next step may be after so many corrections \[-\].
fn effort(iterations: usize) -> f64 {
    if iterations > CORRECTIONS {
        0.7
    } else {
        CHANGE[1]
    }
}
