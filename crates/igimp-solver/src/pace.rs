//! How long the next step of a motion may be (theory, eqs. 68 and 68a): by the error of the time integration, by how far the body moves,
//! and by how hard equilibrium was to find; where water flows by the error of its pressures alone (eq. 104).

use igimp_assembly::{System, Trial};

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

/// The error that is aimed at where water flows, over its pressures \[-\].
const FLOW_ERROR: f64 = 2e-3;

/// Corrections from which on the next step is shorter.
const CORRECTIONS: usize = 10;

/// Bounds of the change of duration from step to step \[-\].
const CHANGE: [f64; 2] = [0.5, 1.5];

/// How many times as long the next step may be as one by nodal displacements `u` \[length\], and whether this one was too long;
/// 1 in statics.
pub(crate) fn after<const D: usize>(
    system: &System<'_, D>,
    trial: &Trial<D>,
    u: &[[f64; D]],
    iterations: usize,
) -> (f64, bool) {
    if let Some(error) = system.flow_error(trial, u) {
        let factor = (FLOW_ERROR / error).sqrt().min(effort(iterations));
        return (
            factor.clamp(CHANGE[0], CHANGE[1]),
            error > REFUSED * FLOW_ERROR,
        );
    }
    let Some(error) = system.time_error(u) else {
        return (1.0, false);
    };
    let grid = &system.conditions().grid;
    let cell = (0..D)
        .flat_map(|axis| (0..grid.axes[axis].cell_count()).map(move |k| grid.axes[axis].spacing(k)))
        .fold(f64::INFINITY, f64::min);
    let length = |u: &[f64; D]| u.iter().map(|u| u * u).sum::<f64>().sqrt();
    let way = u
        .iter()
        .take(grid.node_count())
        .map(length)
        .fold(0.0, f64::max)
        / cell;
    let closing = system.closing(u);
    let factor = ((ERROR / error).sqrt())
        .min(WAY / way)
        .min(CLOSING / closing);
    let refused =
        error > REFUSED * ERROR || way > REFUSED * WAY || closing > CLOSING_REFUSED * CLOSING;
    let factor = factor.min(effort(iterations));
    (factor.clamp(CHANGE[0], CHANGE[1]), refused)
}

/// How many times as long the next step may be after so many corrections \[-\].
fn effort(iterations: usize) -> f64 {
    if iterations > CORRECTIONS {
        0.7
    } else {
        CHANGE[1]
    }
}
