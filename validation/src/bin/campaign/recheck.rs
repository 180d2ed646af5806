//! Equilibrium of an accepted step, computed again from what the step left behind: the stress that
//! the particles carry now, on the grid and with the displacements of the step.
//!
//! Nothing of the residual of the step is used: the nodal force is summed here from
//! $`\sigma \det F`$ of the accepted particles (theory, eq. 16), and so is the weight. Rigid bodies act by
//! the traction that the step left on them, and are in equilibrium themselves.

use igimp_assembly::{Drive, Stencils};
use igimp_model::Case;
use igimp_solver::{Accepted, Body};

use crate::bodies::forces::{Begun, forces};

/// Size of the round-off in the strain of a particle \[-\].
const STRAIN_ROUND_OFF: f64 = 8.0 * f64::EPSILON;

/// What was found.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Equilibrium {
    /// Out-of-balance force over external force and reactions \[-\].
    pub(crate) residual: f64,
    /// The share of it that strains of round-off would make \[-\].
    pub(crate) round_off: f64,
}

/// Computes the equilibrium of a step again, from the body before it and what it accepted.
/// `None` if the particles have no place on the grid.
pub(crate) fn equilibrium(
    case: &Case<2>,
    body: &Body<2>,
    accepted: &Accepted<'_, 2>,
) -> Option<Equilibrium> {
    let conditions = accepted.conditions;
    let (grid, u) = (&conditions.grid, &accepted.forces.u);
    let before = &body.particles;
    let after = &accepted.body.particles;
    let stencils = Stencils::build(before, &case.method, conditions).ok()?;
    let mut f_int = vec![[0.0; 2]; grid.node_count()];
    let mut f_ext = vec![[0.0; 2]; grid.node_count()];
    let mut round_off = 0.0;
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
                let own = sigma[a][0] * g[0] + sigma[a][1] * g[1];
                f_int[support.node][a] += volume * (own + mean * (g_bar[a] - g[a]));
                f_ext[support.node][a] +=
                    before.mass[particle] * support.value * conditions.loads.gravity[a];
                slopes += support.grad[a] * support.grad[a];
            }
        }
        let noise = STRAIN_ROUND_OFF * modulus * before.volume(particle);
        round_off += noise * noise * slopes;
    }
    let begun = Begun {
        particles: before,
        rigid: &body.rigid,
        stencils: &stencils,
        conditions,
        below: case.method.small_cuts.below,
    };
    let of_bodies = forces(&begun, &accepted.body.rigid, u);
    let [dx, dy] = case.grid.smallest_cell();
    let (mut free, mut reaction, mut external) = (0.0, 0.0, 0.0);
    for node in 0..grid.node_count() {
        // Nodes with hardly any soil that no neighbour takes along are held.
        let is_held = stencils.node_volume(node) < case.method.small_cuts.below * dx * dy
            && u[node].iter().all(|component| component.abs() == 0.0);
        for a in 0..2 {
            let difference: f64 = f_ext[node][a] - f_int[node][a] + of_bodies[node][a];
            external += f_ext[node][a] * f_ext[node][a];
            if is_held || conditions.constraints.of(node, a).is_some() {
                reaction += difference * difference;
            } else {
                free += difference * difference;
            }
        }
    }
    for (slot, rigid) in body.rigid.iter().enumerate() {
        let motion = &conditions.motions[slot];
        let [x, y] = motion.displacement;
        let first = grid.node_count() + 2 * slot;
        let size = rigid.surface.size();
        for (drive, unit, force) in [
            (x, 1.0, of_bodies[first][0]),
            (y, 1.0, of_bodies[first][1]),
            (motion.rotation[0], size, of_bodies[first + 1][0]),
        ] {
            match drive {
                Drive::Moved(_) => reaction += force * force,
                Drive::Loaded(load) => {
                    free += (load / unit + force).powi(2);
                    external += (load / unit).powi(2);
                }
            }
        }
    }
    let reference: f64 = f64::sqrt(external) + f64::sqrt(reaction);
    // Where nothing acts, nothing is out of balance.
    let share = |force: f64| if force == 0.0 { 0.0 } else { force / reference };
    Some(Equilibrium {
        residual: share(f64::sqrt(free)),
        round_off: share(f64::sqrt(round_off)),
    })
}

/// $`F^{-T} g`$.
fn solved(f: &[[f64; 2]; 2], g: [f64; 2]) -> [f64; 2] {
    let det = f[0][0] * f[1][1] - f[0][1] * f[1][0];
    [
        (f[1][1] * g[0] - f[1][0] * g[1]) / det,
        (f[0][0] * g[1] - f[0][1] * g[0]) / det,
    ]
}
