//! The residuals of one step so far: when to give up, when a correction went too far, and
//! when factors serve once more.

use igimp_assembly::OutOfBalance;
use igimp_shape::Grid;

use crate::report::{StepFailure, padded};
use crate::settings::NewtonSettings;

/// A node hardly touches soil when less of the cells around it is full than this \[-\].
const HARDLY_FULL: f64 = 0.01;

/// The same of one of two nodes that the soil of a corner holds by one gradient: the other is less full \[-\].
const CORNER_FULL: f64 = 0.05;

/// Iterations without a new smallest residual after which a step is given up.
const STAGNATION: usize = 8;

/// The residuals of one step so far.
#[derive(Default)]
pub(crate) struct ResidualHistory {
    /// Relative out-of-balance norms \[-\].
    pub(crate) residuals: Vec<f64>,
    /// Node and axis of the largest out-of-balance force.
    worst: Option<(usize, usize)>,
    /// How full the cells are around the node at which a system was singular \[-\].
    pub(crate) fill_of_singular: Option<f64>,
    best: f64,
    best_iteration: usize,
}

impl ResidualHistory {
    /// Records a residual; an error when the iteration should not go on.
    pub(crate) fn record(
        &mut self,
        residual: &OutOfBalance,
        settings: &NewtonSettings,
    ) -> Result<(), StepFailure> {
        let iteration = self.residuals.len();
        let norm = residual.relative_norm;
        self.residuals.push(norm);
        self.worst = Some(residual.worst);
        if iteration <= 1 || norm < self.best {
            self.best = norm;
            self.best_iteration = iteration;
        }
        if residual.is_round_off {
            Ok(())
        } else if norm > settings.divergence * self.best {
            Err(StepFailure::Diverged)
        } else if iteration - self.best_iteration >= STAGNATION {
            Err(StepFailure::Stagnated)
        } else {
            Ok(())
        }
    }

    /// Leaves the correction at hand out of those that bring nothing: it was shortened to where the residual does no work along it,
    /// and the residual itself need not have become smaller.
    pub(crate) fn excuse(&mut self) {
        self.best_iteration += 1;
    }

    /// Position \[length\] and axis of the largest out-of-balance force.
    pub(crate) fn worst<const D: usize>(&self, grid: &Grid<D>) -> Option<([f64; 3], usize)> {
        // A node beyond those of the grid stands for a rigid body, which has no one place.
        self.worst
            .filter(|&(node, _)| node < grid.node_count())
            .map(|(node, axis)| (padded(&grid.node_position(node)), axis))
    }
}

/// When a system is singular for want of soil.
impl ResidualHistory {
    /// Whether a node that hardly touches soil left the system singular: the strains of one or two
    /// particles, seen by their gradients alone, cannot hold it.
    pub(crate) fn is_weakly_held(&self) -> bool {
        self.fill_of_singular.is_some_and(|fill| fill < HARDLY_FULL)
    }

    /// Whether the first system, of the elastic tangent, was singular at a node that touches little soil.
    pub(crate) fn begins_weakly_held(&self) -> bool {
        let is_first = self.residuals.len() <= 1;
        is_first && self.fill_of_singular.is_some_and(|fill| fill < CORNER_FULL)
    }
}

/// When a correction went too far.
impl ResidualHistory {
    /// Whether the residual after a correction is more than `growth` times that before it: the consistent
    /// tangent said little of the way there, as where many particles change their regime at once. The
    /// first correction, which the elastic tangent makes, may raise it.
    pub(crate) fn overshoots(&self, residual: &OutOfBalance, growth: f64) -> bool {
        match self.residuals[..] {
            [_, .., before] => !residual.is_round_off && residual.relative_norm > growth * before,
            _ => false,
        }
    }
}

/// The share that the residual has to fall to for a step to be worth its corrections \[-\].
const WORTHWHILE: f64 = 0.1;

/// Corrections that may bring a residual to the tolerance however it crept before: Newton's method arrives at once, or not.
const LAST_CORRECTIONS: usize = 2;

/// How much less the residual becomes.
impl ResidualHistory {
    /// Whether the residual creeps: at its pace over the last corrections it would come neither to the tolerance nor to a
    /// tenth of itself in those that are left. The last ones are always made.
    pub(crate) fn creeps(&self, settings: &NewtonSettings) -> bool {
        let made = self.residuals.len() - 1;
        let left = settings.max_iterations.saturating_sub(made);
        // The first correction may raise the residual.
        if made <= STAGNATION || left <= LAST_CORRECTIONS {
            return false;
        }
        let (now, before) = (self.residuals[made], self.residuals[made - STAGNATION]);
        let share = (now / before).powf(left as f64 / STAGNATION as f64);
        now * share > settings.tolerance.max(WORTHWHILE * now)
    }

    /// A residual over that recorded last \[-\].
    pub(crate) fn share_left(&self, residual: &OutOfBalance) -> f64 {
        let before = self.residuals.last().copied().unwrap_or(f64::INFINITY);
        residual.relative_norm / before
    }
}

/// Largest relative residual of the first linear system of a step, whose solution often is equilibrium \[-\].
const FIRST_FORCING: f64 = 1e-4;
/// The same of all others \[-\].
const LARGEST_FORCING: f64 = 1e-2;
/// Share of the residual after the next correction that the linear system may leave \[-\].
const SHARE: f64 = 0.1;

/// How well a linear system has to be solved.
impl ResidualHistory {
    /// The relative residual of the next linear system (theory, eq. 25a): a tenth of the factor by which Newton's method would
    /// reduce the residual with an exact solution, as far as the last two residuals tell, and no more than the
    /// tolerance asks for (S. C. Eisenstat & H. F. Walker, *Choosing the forcing terms in an inexact Newton method*, SIAM J.
    /// Sci. Comput. 17, 1996).
    pub(crate) fn forcing(&self, residual: &OutOfBalance, tolerance: f64) -> f64 {
        let now = residual.relative_norm;
        let (expected, largest) = match self.residuals[..] {
            [_, .., before, last] => ((last / before).powi(2), LARGEST_FORCING),
            [_, _] => (1.0, LARGEST_FORCING),
            _ => (1.0, FIRST_FORCING),
        };
        let needed = if now.is_finite() {
            tolerance / now
        } else {
            0.0
        };
        (SHARE * expected.max(needed)).min(largest)
    }
}

/// When the factors of the last tangent serve once more.
///
/// With quadratic convergence, r₊ = C r², the same factors used again leave about 2 C r r₊ (Kelley
/// 1995, section 5.4). Where that is well below the tolerance, a new tangent and its factorisation
/// would be wasted on digits that nobody asked for.
impl ResidualHistory {
    /// Whether they serve for the residual at hand.
    pub(crate) fn factors_suffice(&self, tolerance: f64) -> bool {
        match self.residuals[..] {
            [_, .., before, last] => 2.0 * last * last / before < 0.1 * tolerance,
            _ => false,
        }
    }

    /// Whether they will probably serve for the residual after the next correction.
    pub(crate) fn factors_will_suffice(&self, tolerance: f64) -> bool {
        match self.residuals[..] {
            [_, .., before, last] => {
                let next = last * (last / before).powi(2);
                2.0 * next * next / last < 0.1 * tolerance
            }
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether residuals creep that become `share` of themselves with every correction.
    fn creeps(corrections: usize, share: f64) -> bool {
        let residuals = (0..=corrections).map(|k| share.powi(k as i32)).collect();
        let history = ResidualHistory {
            residuals,
            ..ResidualHistory::default()
        };
        history.creeps(&NewtonSettings {
            tolerance: 1e-4,
            max_iterations: 25,
            divergence: 1e4,
        })
    }

    #[test]
    fn a_residual_creeps_that_would_not_arrive() {
        // A tenth in the sixteen that are left after nine.
        assert!(!creeps(9, 0.1_f64.powf(1.0 / 15.0)));
        assert!(creeps(9, 0.1_f64.powf(1.0 / 17.0)));
        // Nobody knows the pace before.
        assert!(!creeps(8, 0.99));
        // The tolerance is near.
        assert!(!creeps(20, 0.68));
        assert!(creeps(20, 0.72));
        // The last corrections are made.
        assert!(creeps(22, 0.99));
        assert!(!creeps(23, 0.99));
    }

    /// How well the next system is solved after these residuals, the last of them at hand.
    fn forcing(residuals: &[f64], tolerance: f64) -> f64 {
        let (&now, _) = residuals.split_last().unwrap();
        let history = ResidualHistory {
            residuals: residuals.to_vec(),
            ..ResidualHistory::default()
        };
        let at_hand = OutOfBalance {
            relative_norm: now,
            ..OutOfBalance::default()
        };
        history.forcing(&at_hand, tolerance)
    }

    // GOAL: a linear system is solved as well as the next residual deserves, no better and no worse.
    // ORACLE: eq. 25a by hand.
    #[test]
    fn a_system_is_solved_to_a_tenth_of_what_the_next_residual_will_be() {
        let near = |found: f64, expected: f64| {
            assert!(
                (found / expected - 1.0).abs() < 1e-12,
                "{found:e} {expected:e}"
            );
        };
        // Nothing is known of the pace yet.
        near(forcing(&[1.0], 1e-6), 1e-4);
        near(forcing(&[1.0, 0.5], 1e-6), 1e-2);
        // The ratio of the last two residuals, squared.
        near(forcing(&[1.0, 0.5, 0.05], 1e-6), 0.1 * 0.01);
        near(forcing(&[1.0, 0.1, 1e-3], 1e-12), 0.1 * 1e-4);
        // No more than the largest, and no less than what the tolerance asks for.
        near(forcing(&[1.0, 0.5, 0.45], 1e-6), 1e-2);
        near(forcing(&[1.0, 1e-2, 1e-5], 1e-7), 0.1 * 1e-2);
    }
}
