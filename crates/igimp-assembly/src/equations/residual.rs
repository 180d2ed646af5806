//! How far a trial is from equilibrium (theory, eq. 24), and when that is round-off
//! (eq. 24a).

use rayon::prelude::*;

use crate::body::particles::{CHUNK, Particles};
use crate::conditions::StepConditions;
use crate::equations::trial::Trial;
use crate::error::AssemblyError;
use crate::step::stencils::Stencils;
use crate::step::unknowns::Unknowns;

/// Size of the round-off in the strain of a particle \[-\].
const STRAIN_ROUND_OFF: f64 = 8.0 * f64::EPSILON;

/// The out-of-balance force of a trial.
#[derive(Clone, Debug, Default)]
pub struct OutOfBalance {
    /// f_ext − f_int by unknown \[force\].
    pub force: Vec<f64>,
    /// ‖f_ext − f_int‖ over the unknowns, divided by ‖f_ext‖ + ‖f_react‖, and the norm of the force of acceleration where the step
    /// takes time \[-\].
    pub relative_norm: f64,
    /// Whether the norm cannot be distinguished from the round-off of the internal force: no smaller one
    /// can be reached.
    pub is_round_off: bool,
    /// Node and axis of the largest component.
    pub worst: (usize, usize),
}

impl OutOfBalance {
    /// Sets everything from the difference of nodal external and internal force; at most
    /// `round_off` counts as none.
    ///
    /// # Errors
    /// [`AssemblyError::NonFinite`] for a force, or a norm of them, that is not finite: an infinite
    /// reference would make any residual look small.
    pub(crate) fn update<const D: usize>(
        &mut self,
        unknowns: &Unknowns<D>,
        f_ext: &[[f64; D]],
        trial: &Trial<D>,
        round_off: f64,
    ) -> Result<(), AssemblyError> {
        let f_int = &trial.f_int;
        self.force.resize(unknowns.len(), 0.0);
        let (mut free, mut external, mut reaction, mut largest) = (0.0, 0.0, 0.0, 0.0);
        let mut worst = (0, 0);
        for node in 0..f_int.len() {
            for axis in 0..D {
                let difference = f_ext[node][axis] - f_int[node][axis];
                if !difference.is_finite() {
                    return Err(AssemblyError::NonFinite {
                        quantity: "nodal force",
                        index: node,
                    });
                }
                external += f_ext[node][axis] * f_ext[node][axis];
                if let Some(unknown) = unknowns.index(node, axis) {
                    self.force[unknown] = difference;
                    free += difference * difference;
                    if difference.abs() > largest {
                        largest = difference.abs();
                        worst = (node, axis);
                    }
                } else {
                    reaction += difference * difference;
                }
            }
        }
        let reference: f64 = external.sqrt() + reaction.sqrt() + trial.inertia;
        let norm: f64 = free.sqrt();
        if !(reference.is_finite() && norm.is_finite()) {
            return Err(AssemblyError::NonFinite {
                quantity: "norm of the nodal forces",
                index: worst.0,
            });
        }
        self.relative_norm = if norm == 0.0 { 0.0 } else { norm / reference };
        self.is_round_off = round_off.is_finite() && norm <= round_off;
        self.worst = worst;
        Ok(())
    }
}

/// The norm of the internal force of strains that are round-off, independent from particle to
/// particle (theory, eq. 24a): where a body is all but free of force, as after unloading or in rigid motion, no smaller residual can be reached \[force\].
pub(crate) fn force_of_round_off<const D: usize>(
    particles: &Particles<D>,
    stencils: &Stencils<D>,
    conditions: &StepConditions<D>,
) -> f64 {
    let moduli: Vec<f64> = conditions
        .laws
        .iter()
        .map(|law| law.stiffness_bound().bulk() + 4.0 / 3.0 * law.stiffness_bound().shear())
        .collect();
    let n = particles.len();
    let parts: Vec<f64> = (0..n.div_ceil(CHUNK))
        .into_par_iter()
        .map(|chunk| {
            let mut squared = 0.0;
            for particle in chunk * CHUNK..n.min((chunk + 1) * CHUNK) {
                let modulus = moduli[particles.law[particle]]
                    * particles.ratios[particle].stiffness
                    + conditions.water.stiffness_of(particles, particle);
                let stress = STRAIN_ROUND_OFF * modulus * particles.volume(particle);
                let mut slopes = 0.0;
                for support in stencils.of(particle) {
                    slopes += support.grad.iter().map(|slope| slope * slope).sum::<f64>();
                }
                squared += stress * stress * slopes;
            }
            squared
        })
        .collect();
    parts.iter().sum::<f64>().sqrt()
}
