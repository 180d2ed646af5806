//! Equilibrium of an accepted step, computed again from what the step left behind: the stress that
//! the particles carry now, on the grid and with the displacements of the step.
//!
//! Nothing of the residual of the step is used: the nodal force is summed here from
//! $`\sigma \det F`$ of the accepted particles (theory, eq. 16), and so is the weight. Rigid bodies act by
//! the traction that the step left on them, and are in equilibrium themselves.

use igimp_assembly::{Drive, Particles, Stencils};
use igimp_model::Case;
use igimp_solver::{Accepted, Body};

use crate::bodies::forces::{Begun, carriers, forces};

/// Size of the round-off in the strain of a particle \[-\].
const STRAIN_ROUND_OFF: f64 = 8.0 * f64::EPSILON;

/// The result of the check.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Equilibrium {
    /// Out-of-balance force over external force and reactions \[-\].
    pub(crate) residual: f64,
    /// The share of it that strains of round-off would make \[-\].
    pub(crate) round_off: f64,
}

/// The forces of soil at the nodes of the grid.
struct NodalForces {
    internal: Vec<[f64; 2]>,
    external: Vec<[f64; 2]>,
    /// Square of the force that strains of round-off would make \[N²/m²\].
    round_off: f64,
}

/// Squares of forces: out of balance where nothing holds, where something does, and of the external ones \[N²/m²\].
#[derive(Default)]
struct Squares {
    free: f64,
    reaction: f64,
    external: f64,
}

/// Computes the equilibrium of a step again, from the body before it and the accepted one.
/// `None` if the particles have no place on the grid.
pub(crate) fn equilibrium(
    case: &Case<2>,
    body: &Body<2>,
    accepted: &Accepted<'_, 2>,
) -> Option<Equilibrium> {
    let conditions = &*accepted
        .conditions
        .without_rollers_at_tips(&body.rigid)
        .ok()?;
    let (grid, u) = (&conditions.grid, &accepted.forces.u);
    let stencils = Stencils::build(&body.particles, &case.method, conditions).ok()?;
    let soil = of_soil(&stencils, &body.particles, accepted);
    let begun = Begun {
        particles: &body.particles,
        rigid: &body.rigid,
        stencils: &stencils,
        conditions,
        below: case.method.small_cuts.below,
        is_carrier: carriers(&stencils, grid.node_count()),
    };
    let of_bodies = forces(&begun, &accepted.body.rigid, u);
    let [dx, dy] = case.grid.smallest_cell();
    let mut squares = Squares::default();
    for node in 0..grid.node_count() {
        // Nodes with hardly any soil that no neighbour takes along are held.
        let is_held = stencils.node_volume(node) < case.method.small_cuts.below * dx * dy
            && u[node].iter().all(|component| component.abs() == 0.0);
        for a in 0..2 {
            let external = soil.external[node][a];
            let difference: f64 = external - soil.internal[node][a] + of_bodies[node][a];
            squares.external += external * external;
            if is_held || conditions.constraints.of(node, a).is_some() {
                squares.reaction += difference * difference;
            } else {
                squares.free += difference * difference;
            }
        }
    }
    add_bodies(&mut squares, &begun, &of_bodies, u);
    let reference: f64 = f64::sqrt(squares.external) + f64::sqrt(squares.reaction);
    // Where nothing acts, nothing is out of balance.
    let share = |force: f64| if force == 0.0 { 0.0 } else { force / reference };
    Some(Equilibrium {
        residual: share(f64::sqrt(squares.free)),
        round_off: share(f64::sqrt(soil.round_off)),
    })
}

/// The forces of stress and weight, from particles before a step and what it made of them.
fn of_soil(
    stencils: &Stencils<2>,
    before: &Particles<2>,
    accepted: &Accepted<'_, 2>,
) -> NodalForces {
    let conditions = accepted.conditions;
    let (u, after) = (&accepted.forces.u, &accepted.body.particles);
    let nodes = conditions.grid.node_count();
    let mut out = NodalForces {
        internal: vec![[0.0; 2]; nodes],
        external: vec![[0.0; 2]; nodes],
        round_off: 0.0,
    };
    for particle in 0..before.len() {
        let mut delta = [[1.0, 0.0], [0.0, 1.0]];
        let mut delta_bar = delta;
        for support in stencils.of(particle) {
            for a in 0..2 {
                for b in 0..2 {
                    delta[a][b] += u[support.node][a] * support.grad[b];
                    delta_bar[a][b] += u[support.node][a] * support.grad_bar[b];
                }
            }
        }
        let f = after.def_grad[particle];
        let volume0 = before.volume0[particle];
        // V_0 τ = V_0 det F σ, with the volume and the stress after the step.
        let volume = (f[0][0] * f[1][1] - f[0][1] * f[1][0]) * volume0;
        let sigma = &after.sigma[particle];
        let mean = (sigma[0][0] + sigma[1][1] + sigma[2][2]) / 3.0;
        let law = &conditions.laws[before.law[particle]];
        let modulus = law.stiffness_bound().bulk() + 4.0 / 3.0 * law.stiffness_bound().shear();
        let mut slopes = 0.0;
        for support in stencils.of(particle) {
            let g = solved(&delta, support.grad);
            let g_bar = solved(&delta_bar, support.grad_bar);
            for a in 0..2 {
                let force = sigma[a][0] * g[0] + sigma[a][1] * g[1];
                out.internal[support.node][a] += volume * (force + mean * (g_bar[a] - g[a]));
                out.external[support.node][a] +=
                    before.mass[particle] * support.value * conditions.loads.gravity[a];
                slopes += support.grad[a] * support.grad[a];
            }
        }
        let noise = STRAIN_ROUND_OFF * modulus * before.volume(particle);
        out.round_off += noise * noise * slopes;
    }
    out
}

/// Adds the forces of rigid bodies, which are moved or loaded.
fn add_bodies(squares: &mut Squares, begun: &Begun<'_>, of_bodies: &[[f64; 2]], u: &[[f64; 2]]) {
    for (slot, rigid) in begun.rigid.iter().enumerate() {
        let motion = &begun.conditions.motions[slot];
        let [x, y] = motion.displacement;
        let first = begun.conditions.grid.node_count() + 2 * slot;
        let size = rigid.surface.size();
        let [across, up] = motion.weight;
        // The weight at the centre of mass, where the step leaves that.
        let moment = rigid.arm(true).map_or(0.0, |arm| {
            let arm = arm.after(&[u[first + 1][0], 0.0]);
            (arm[0] * up - arm[1] * across) / size
        });
        for (drive, unit, weight, force) in [
            (x, 1.0, across, of_bodies[first][0]),
            (y, 1.0, up, of_bodies[first][1]),
            (motion.rotation[0], size, moment, of_bodies[first + 1][0]),
        ] {
            match drive {
                Drive::Moved(_) => squares.reaction += (weight + force).powi(2),
                Drive::Loaded(load) => {
                    squares.free += (load / unit + weight + force).powi(2);
                    squares.external += (load / unit + weight).powi(2);
                }
            }
        }
    }
}

/// $`F^{-T} g`$.
fn solved(f: &[[f64; 2]; 2], g: [f64; 2]) -> [f64; 2] {
    let det = f[0][0] * f[1][1] - f[0][1] * f[1][0];
    [
        (f[1][1] * g[0] - f[1][0] * g[1]) / det,
        (f[0][0] * g[1] - f[0][1] * g[0]) / det,
    ]
}
