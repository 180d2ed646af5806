//! The corrections of one step: the tangent matrix and its factors, used once more where that serves,
//! the time that they take, and names for what a linear solver knows by its index only.

use std::time::{Duration, Instant};

use igimp_assembly::{AssemblyError, OutOfBalance, Stencils, System, Trial};
use igimp_linear::{Bordered, LinearEffort, LinearSolver, LinearSolverError, TangentMatrix};
use igimp_material::TangentKind;
use igimp_shape::Grid;

use crate::free_factor::FreeFactor;
use crate::report::{Component, PhaseTimes, StepFailure, padded};
use crate::residual_history::ResidualHistory;
use crate::settings::{NewtonSettings, converged};
use crate::workspace::Workspace;

/// How often a correction is halved.
const MOST_HALVINGS: u32 = 4;

/// Growth of the residual in one correction above which half the correction is tried \[-\]: of the steps that find equilibrium
/// by whole corrections, one in a hundred goes beyond.
const OVERSHOOT: f64 = 20.0;

/// The same where corrections are guarded: in space for soil by itself whose flow is not associated, as whole corrections swing
/// near failure and one costs as much as twenty evaluations of the residual and more; and where the load factor is unknown.
const OVERSHOOT_GUARDED: f64 = 1.0;

/// How often a correction is shortened along itself.
const MOST_SHORTENINGS: u32 = 8;

/// The work of the residual along a correction that may be left with the other sign, over that before it \[-\]: a correction past
/// the place where it vanishes by nearly as much as it was short of it leads nowhere.
const WORK_LEFT: f64 = 0.8;

/// The same after so many corrections, which good steps do not need: what has swung for long is searched along closely.
const WORK_LEFT_LATE: f64 = 0.1;
const LATE: usize = 3;

/// The least and the greatest share of a stretch at which the residual is tried along a correction \[-\].
const WITHIN: [f64; 2] = [0.1, 0.9];

/// The share of the elastic tangent after a halving over that before, and after a correction that was taken whole \[-\].
const STIFFER: f64 = 2.0;
const SOFTER: f64 = 0.5;
/// A correction that leaves less than so much of the residual converges \[-\].
const CONVERGING: f64 = 0.1;
/// How often a singular tangent is regularised more.
const MOST_REGULARISED: usize = 10;

/// How closely corrections are guarded: none may raise the residual, and particles with plastic flow bring a share of the
/// elastic tangent (theory, eq. 25e).
#[derive(Clone, Copy, Debug)]
struct Guard {
    /// Share of the elastic tangent in the next correction \[-\].
    share: f64,
    /// Least share in corrections that do not converge yet \[-\].
    least: f64,
    /// A share after a halving is at least this \[-\].
    halved: f64,
    /// Whether a step is given up whose residual creeps.
    gives_up: bool,
}

impl Guard {
    /// In space, where flow is not associated: with less the tangent is all but singular, and its system takes many times
    /// the iterations.
    const IN_SPACE: Self = Self {
        share: 0.01,
        least: 0.005,
        halved: 0.005,
        gives_up: true,
    };

    /// Where the load factor is unknown, as on a plateau, and where soil softens over a length: none until a correction is halved.
    const ON_PATH: Self = Self {
        share: 0.0,
        least: 0.0,
        halved: 1e-3,
        gives_up: false,
    };

    /// A share that fades with corrections that are taken whole: where a system was singular, as soil at the apex has no stiffness;
    /// and where the load factor is unknown in space and flow is not associated.
    const FADING: Self = Self {
        share: 0.01,
        ..Self::ON_PATH
    };

    /// Chooses the share in the next correction: more after one that was halved, less after one that was taken whole, and
    /// as much less as the residual where corrections converge (`left` is the share that the last one left of it).
    fn adapt(&mut self, halvings: u32, left: f64) {
        self.share = if halvings == 0 && left < CONVERGING {
            self.share * left
        } else if halvings == 0 {
            (self.share * SOFTER).clamp(self.least, 1.0)
        } else {
            (self.share * STIFFER.powi(halvings as i32)).clamp(self.halved, 1.0)
        };
        if self.share < 0.5 * self.halved && self.least == 0.0 {
            self.share = 0.0;
        }
    }
}

/// The maker of the corrections of one step.
///
/// The first one uses the elastic tangent, all others the consistent tangent; the last one may use that
/// of the correction before. One that turns a particle inside out, or raises the residual manyfold, is
/// halved. In space, where flow is not associated, the residual may not be raised at all, and the consistent
/// tangent is regularised by a share of the elastic one that grows with the halvings.
pub(crate) struct Corrector<'s, 'w, const D: usize> {
    /// The equations of the step.
    pub(crate) system: System<'s, D>,
    stencils: &'s Stencils<D>,
    grid: &'s Grid<D>,
    settings: &'s NewtonSettings,
    solver: &'w mut dyn LinearSolver,
    matrix: &'w mut TangentMatrix,
    du: &'w mut Vec<f64>,
    history: &'w mut ResidualHistory,
    /// Solutions with the matrix factorised last.
    bordered: Bordered,
    /// Whether the matrix is the tangent at u, or that before the last correction.
    is_current: bool,
    /// How corrections are guarded, if they are.
    guard: Option<Guard>,
    /// The load factor, where it is unknown.
    pub(crate) factor: Option<FreeFactor<'s, D>>,
    /// The relative residual that corrections are to come to \[-\].
    goal: f64,
    /// Work of the residual along the last correction, before it was made \[force·length\].
    work: f64,
    /// The particles at u.
    pub(crate) trial: &'w mut Trial<D>,
    /// Number of corrections so far.
    pub(crate) iterations: usize,
    /// Time spent so far.
    pub(crate) times: PhaseTimes,
}

impl<'s, 'w, const D: usize> Corrector<'s, 'w, D> {
    /// One in the memory of a workspace. `set_up` is the time that system and stencils took.
    pub(crate) fn new(
        (system, stencils): (System<'s, D>, &'s Stencils<D>),
        grid: &'s Grid<D>,
        settings: &'s NewtonSettings,
        workspace: &'w mut Workspace<D>,
        history: &'w mut ResidualHistory,
        set_up: Duration,
    ) -> Self {
        let Workspace {
            solver,
            matrix,
            trial,
            du,
        } = workspace;
        let earlier = matrix.take();
        solver.start_step();
        let guard = if D == 3 && system.flows_without_potential() {
            Some(Guard::IN_SPACE)
        } else {
            // Where bands may form here or there, whole corrections go round in circles.
            (system.softens_over_a_length()).then_some(Guard::ON_PATH)
        };
        Self {
            stencils,
            grid,
            settings,
            solver: &mut **solver,
            matrix: matrix.insert(system.matrix_from(earlier)),
            system,
            du,
            history,
            bordered: Bordered::default(),
            is_current: true,
            guard,
            factor: None,
            goal: settings.tolerance,
            work: 0.0,
            trial,
            iterations: 0,
            times: PhaseTimes {
                set_up,
                ..PhaseTimes::default()
            },
        }
    }

    /// The same with guarded corrections and regularised tangents, where a system was singular, and where soil moves whose flow is
    /// not associated.
    pub(crate) fn guarded_if(mut self, was_singular: bool) -> Self {
        if was_singular || self.system.moves_without_potential() {
            self.guard = self.guard.or(Some(Guard::FADING));
        }
        self
    }

    /// The same with a load factor that is unknown.
    pub(crate) fn on_path(mut self, factor: FreeFactor<'s, D>) -> Self {
        self.guard = Some(match self.guard {
            Some(guard) if guard.gives_up => Guard::FADING,
            _ => Guard::ON_PATH,
        });
        self.factor = Some(factor);
        self
    }

    /// The start of the step: trial, tangent and residual at `u`, the elastic tangent where nothing moves yet.
    pub(crate) fn start(&mut self, u: &[[f64; D]]) -> Result<OutOfBalance, StepFailure> {
        let is_still = u.as_flattened().iter().all(|u| *u == 0.0);
        let kind = if is_still {
            TangentKind::Elastic
        } else {
            self.tangent()
        };
        let clock = Instant::now();
        let mut residual = OutOfBalance::default();
        let linearised = self.linearise_at(u, kind, &mut residual);
        self.times.assembly += clock.elapsed();
        linearised?;
        self.history.record(&residual, self.settings)?;
        Ok(residual)
    }

    /// Whether the residual at `u` is that of an equilibrium.
    pub(crate) fn is_found(&self, u: &[[f64; D]], residual: &OutOfBalance) -> bool {
        converged(residual, self.settings.tolerance)
            && (self.factor.as_ref())
                .is_none_or(|factor| factor.is_found(&self.system.by_unknown(u), residual))
    }

    /// Makes one correction of `u`, and of the load factor where it is unknown.
    pub(crate) fn correct(
        &mut self,
        u: &mut [[f64; D]],
        residual: &mut OutOfBalance,
    ) -> Result<(), StepFailure> {
        self.solve(residual, u)?;
        self.add_correction(u)?;
        self.linearise(u, residual)
    }

    /// The correction du by unknown \[length\] that the residual at `u` asks for.
    fn solve(&mut self, residual: &OutOfBalance, u: &[[f64; D]]) -> Result<(), StepFailure> {
        let iterations = self.iterations;
        if iterations == self.settings.max_iterations {
            return Err(StepFailure::MaxIterations { iterations });
        }
        self.goal = self.goal_at(u, residual);
        if !self.is_current && !self.history.factors_suffice(self.goal) {
            self.linearise_again(u)?;
        }
        self.solver
            .ask_for(self.history.forcing(residual, self.goal));
        let mut force = residual.force.clone();
        if let Some(factor) = &self.factor {
            force.push(factor.missing(&self.system.by_unknown(u)));
        }
        self.solve_regularised(&force, u)?;
        if let Some(unknown) = self.du.iter().position(|du| !du.is_finite()) {
            return Err(self.not_finite("correction", unknown));
        }
        if let (Some(factor), Some(&correction)) = (&self.factor, self.du.last()) {
            let share = factor.admitted(correction);
            self.du.iter_mut().for_each(|du| *du *= share);
        }
        self.work = work(self.du, residual);
        self.iterations += 1;
        Ok(())
    }

    /// The relative residual that corrections are to come to from `u`: the tolerance, and less where that leaves the load factor in
    /// doubt.
    fn goal_at(&self, u: &[[f64; D]], residual: &OutOfBalance) -> f64 {
        let tolerance = self.settings.tolerance;
        self.factor.as_ref().map_or(tolerance, |factor| {
            let share = factor.share_wanted(&self.system.by_unknown(u), residual);
            tolerance.min(share * residual.relative_norm)
        })
    }

    /// The tangent at `u` once more.
    fn linearise_again(&mut self, u: &[[f64; D]]) -> Result<(), StepFailure> {
        let clock = Instant::now();
        let kind = self.tangent();
        let linearised = self.linearise_at(u, kind, &mut OutOfBalance::default());
        self.times.assembly += clock.elapsed();
        self.is_current = true;
        Ok(linearised?)
    }

    /// Solves the system for a force by unknown \[force\]. Where it is singular the tangent at `u` is regularised, if corrections
    /// are guarded and no step is given up. So it is where the body moves as a mechanism and no digit is left: the tangent
    /// without its border is singular there.
    fn solve_regularised(&mut self, force: &[f64], u: &[[f64; D]]) -> Result<(), StepFailure> {
        for again in 0.. {
            let Err(error) = self.solve_system(force) else {
                break;
            };
            let moves_as_mechanism = self.factor.as_ref().is_some_and(|free| free.is_mechanism);
            let is_singular = match error {
                LinearSolverError::Inaccurate { .. } => moves_as_mechanism,
                _ => error.is_singular(),
            };
            if let (true, Some(guard)) = (is_singular, &mut self.guard)
                && !guard.gives_up
                && again < MOST_REGULARISED
            {
                guard.adapt(1, 1.0);
                self.linearise_again(u)?;
                continue;
            }
            self.history.fill_of_singular = self.fill_of_singular(&error);
            return Err(self.named(error, u));
        }
        Ok(())
    }

    /// Solves the system for a force by unknown \[force\]: with the factors of the matrix, or with those at hand.
    fn solve_system(&mut self, force: &[f64]) -> Result<(), LinearSolverError> {
        if self.is_current {
            timed(&mut self.times.factor, || self.solver.factor(self.matrix))?;
        }
        timed(&mut self.times.solve, || {
            if self.is_current {
                self.bordered = Bordered::default();
            }
            self.du.resize(force.len(), 0.0);
            self.bordered
                .solve(self.solver, self.matrix, force, self.du)
        })
    }

    /// Adds `du` to `u`, and to the load factor where it is unknown.
    fn add_correction(&mut self, u: &mut [[f64; D]]) -> Result<(), AssemblyError> {
        self.system.add_correction(u, self.du);
        if let (Some(factor), Some(by)) = (&mut self.factor, self.du.last()) {
            factor.at += by;
            factor.put(&mut self.system)?;
        }
        Ok(())
    }

    /// Trial, tangent and out-of-balance force at `u`; with row and column of the load factor where it is unknown.
    fn linearise_at(
        &mut self,
        u: &[[f64; D]],
        kind: TangentKind,
        residual: &mut OutOfBalance,
    ) -> Result<(), AssemblyError> {
        self.system
            .linearise_into(u, kind, self.trial, self.matrix)?;
        self.system.update_out_of_balance(residual, self.trial)?;
        match &mut self.factor {
            Some(factor) => factor.border(&mut self.system, u, residual, self.matrix),
            None => Ok(()),
        }
    }

    /// How the linear systems were solved so far.
    pub(crate) fn effort(&self) -> LinearEffort {
        self.solver.effort()
    }

    /// Trial and residual at `u`, to which the last correction was added, with the tangent unless the
    /// factors at hand will probably serve once more. A correction that goes too far is halved: one
    /// that turns a particle inside out, or raises the residual manyfold.
    fn linearise(
        &mut self,
        u: &mut [[f64; D]],
        residual: &mut OutOfBalance,
    ) -> Result<(), StepFailure> {
        let with_tangent = !self.history.factors_will_suffice(self.goal);
        self.is_current = with_tangent;
        let clock = Instant::now();
        let mut halvings = 0;
        let mut evaluated = self.evaluate(u, residual);
        if evaluated.is_ok() && self.guard.is_none() && self.system.touches_bodies() {
            evaluated = self.shorten(u, residual);
        }
        while halvings < MOST_HALVINGS && self.is_too_far(&evaluated, residual) {
            self.take_back_half(u, halvings)?;
            halvings += 1;
            // The tangent is of no use before it is known where to go.
            self.is_current = false;
            evaluated = self.evaluate(u, residual);
        }
        if let Some(guard) = self.guard.as_mut().filter(|_| self.iterations > 1) {
            guard.adapt(halvings, self.history.share_left(residual));
        }
        if with_tangent && !self.is_current && evaluated.is_ok() {
            self.is_current = true;
            evaluated = self.evaluate(u, residual);
        }
        self.times.assembly += clock.elapsed();
        evaluated?;
        self.history.record(residual, self.settings)?;
        let is_found = converged(residual, self.settings.tolerance);
        let gives_up = self.guard.is_some_and(|guard| guard.gives_up);
        if gives_up && !is_found && self.history.creeps(self.settings) {
            return Err(StepFailure::Stagnated);
        }
        Ok(())
    }

    /// Shortens the last correction of `u` while it goes far past the place along it where the residual does no work, to near
    /// that place (theory, eq. 25f): contact that sticks, slips or opens turns corrections that follow one of these tangents
    /// into long ways that the next one takes back.
    fn shorten(
        &mut self,
        u: &mut [[f64; D]],
        residual: &mut OutOfBalance,
    ) -> Result<(), AssemblyError> {
        // The first correction is elastic, and carries what moves.
        if self.iterations == 1 || self.work <= 0.0 {
            return Ok(());
        }
        let whole = self.du.clone();
        let (mut before, mut beyond) = ((0.0, self.work), (1.0, work(&whole, residual)));
        let mut last = beyond;
        let mut evaluated = Ok(());
        let left = if self.iterations > LATE {
            WORK_LEFT_LATE
        } else {
            WORK_LEFT
        };
        for _ in 0..MOST_SHORTENINGS {
            if residual.is_round_off || beyond.1 >= 0.0 || last.1.abs() <= left * self.work {
                break;
            }
            let share = (before.1 / (before.1 - beyond.1)).clamp(WITHIN[0], WITHIN[1]);
            let at = before.0 + share * (beyond.0 - before.0);
            set_to(self.du, at - last.0, &whole);
            self.add_correction(u)?;
            // The tangent is of no use before it is known where to go.
            self.is_current = false;
            evaluated = self.evaluate(u, residual);
            last = (at, work(&whole, residual));
            if evaluated.is_err() {
                break;
            } else if last.1 < 0.0 {
                beyond = last;
            } else {
                before = last;
            }
        }
        if last.0 < 1.0 {
            self.history.excuse();
        }
        set_to(self.du, last.0, &whole);
        evaluated
    }

    /// The tangent of the corrections after the first one.
    fn tangent(&self) -> TangentKind {
        match self.guard {
            Some(Guard { share, .. }) if share > 0.0 => TangentKind::Regularised { elastic: share },
            _ => TangentKind::Consistent,
        }
    }

    /// Whether a correction that came to this went too far.
    fn is_too_far(&self, evaluated: &Result<(), AssemblyError>, residual: &OutOfBalance) -> bool {
        let growth = if self.guard.is_some() {
            OVERSHOOT_GUARDED
        } else {
            OVERSHOOT
        };
        match evaluated {
            Ok(()) => self.history.overshoots(residual, growth),
            Err(error) => error.is_too_far(),
        }
    }

    /// Trial and residual at `u`, with the tangent if the matrix is to be that.
    fn evaluate(
        &mut self,
        u: &[[f64; D]],
        residual: &mut OutOfBalance,
    ) -> Result<(), AssemblyError> {
        let kind = self.tangent();
        if self.is_current {
            self.linearise_at(u, kind, residual)
        } else {
            self.system.evaluate_into(u, kind, self.trial)?;
            self.system.update_out_of_balance(residual, self.trial)
        }
    }

    /// Takes back half of what is left of a correction in `u`. `du` is the correction itself, or what
    /// was taken back last.
    fn take_back_half(&mut self, u: &mut [[f64; D]], halvings: u32) -> Result<(), AssemblyError> {
        let share = if halvings == 0 { -0.5 } else { 0.5 };
        for component in self.du.iter_mut() {
            *component *= share;
        }
        self.add_correction(u)
    }
}

/// Names of failures.
impl<const D: usize> Corrector<'_, '_, D> {
    /// The failure of the linear solver at `u` that names the particle whose tangent is not finite,
    /// or the node.
    fn named(&self, error: LinearSolverError, u: &[[f64; D]]) -> StepFailure {
        match error {
            LinearSolverError::NonFinite {
                array: "matrix", ..
            } => self
                .finite_tangents(u)
                .map_or_else(StepFailure::from, |()| error.into()),
            LinearSolverError::NonFinite { array, index } => {
                let vector = if array == "solution" {
                    "correction"
                } else {
                    array
                };
                self.not_finite(vector, index)
            }
            LinearSolverError::Singular {
                unknown: Some(unknown),
            } => self
                .not_held(Some(unknown))
                .or_else(|| self.singular_at(unknown))
                .unwrap_or_else(|| error.into()),
            LinearSolverError::Inaccurate { .. } => {
                self.not_held(None).unwrap_or_else(|| error.into())
            }
            other => other.into(),
        }
    }

    /// The failure that names the node of an unknown at which a system is singular, if it is that of one.
    fn singular_at(&self, unknown: usize) -> Option<StepFailure> {
        let (node, axis) = self.system.unknowns().place(unknown)?;
        (node < self.grid.node_count()).then(|| StepFailure::Singular {
            position: self.system.node_position(node).to_vec(),
            component: (axis < D).then_some(Component::Displacement(axis)),
        })
    }

    /// The failure that names a rigid body, if nothing holds one: with what goes farthest of the motion that meets no resistance,
    /// rotations by half the size of the body; or the body of an unknown.
    fn not_held(&self, unknown: Option<usize>) -> Option<StepFailure> {
        let unknowns = self.system.unknowns();
        let body_of = |unknown: usize| {
            let (node, axis) = unknowns.place(unknown)?;
            self.system.rigid_body_of(node, axis)
        };
        let by_unknown = match unknown {
            Some(unknown) => Some(body_of(unknown)?),
            None => None,
        };
        let direction = self.bordered.free_direction().unwrap_or_default();
        let first = unknowns.len() - direction.len();
        let ways = direction.iter().enumerate().filter_map(|(k, by)| {
            let moved = body_of(first + k)?;
            let is_displacement = moved.1 < D;
            let half = 0.5 * moved.0.surface.size();
            let arm = if is_displacement { 1.0 } else { half };
            Some((arm * by.abs(), moved))
        });
        let farthest = ways.max_by(|a, b| a.0.total_cmp(&b.0));
        let (body, component, touches) = farthest.map(|(_, moved)| moved).or(by_unknown)?;
        Some(StepFailure::NotHeld {
            body: body.name.clone(),
            component: match component.checked_sub(D) {
                None => Component::Displacement(component),
                Some(rotation) => Component::Rotation(rotation),
            },
            touches,
        })
    }

    /// Looks for a particle whose tangent is not finite: at `u`, or at the start of the step, to which
    /// the first matrix belongs.
    fn finite_tangents(&self, u: &[[f64; D]]) -> Result<(), AssemblyError> {
        if self.iterations == 0 {
            let still = vec![[0.0; D]; self.system.node_count()];
            self.system.finite_tangents(&still, TangentKind::Elastic)
        } else {
            self.system.finite_tangents(u, TangentKind::Consistent)
        }
    }

    /// The failure that names the node of an unknown.
    fn not_finite(&self, array: &'static str, unknown: usize) -> StepFailure {
        self.system.unknowns().place(unknown).map_or_else(
            || {
                let index = unknown;
                LinearSolverError::NonFinite { array, index }.into()
            },
            |(node, axis)| StepFailure::NotFinite {
                vector: array,
                position: padded(&self.system.node_position(node)),
                axis,
            },
        )
    }

    /// How full the cells are around the node that a singular system names \[-\].
    fn fill_of_singular(&self, error: &LinearSolverError) -> Option<f64> {
        let LinearSolverError::Singular {
            unknown: Some(unknown),
        } = error
        else {
            return None;
        };
        let (node, _) = self.system.unknowns().place(*unknown)?;
        let is_of_grid = node < self.grid.node_count();
        is_of_grid.then(|| self.stencils.node_fill(self.grid, node))
    }
}

/// The work of the out-of-balance force along a correction by unknown \[force·length\].
fn work(du: &[f64], residual: &OutOfBalance) -> f64 {
    let terms = std::iter::zip(du, &residual.force);
    terms.map(|(du, force)| du * force).sum()
}

/// Makes a correction so many times another.
fn set_to(du: &mut Vec<f64>, share: f64, whole: &[f64]) {
    du.clear();
    du.extend(whole.iter().map(|component| share * component));
}

/// Runs a phase and adds its time.
fn timed<T>(total: &mut Duration, phase: impl FnOnce() -> T) -> T {
    let clock = Instant::now();
    let result = phase();
    *total += clock.elapsed();
    result
}

#[cfg(test)]
mod tests {
    use super::Guard;

    // GOAL: a correction that was halved is followed by a stiffer tangent, one that was taken whole by a softer one.
    // ORACLE: eq. 25e by hand: twice with every halving, half after a whole correction, between bounds; where corrections
    // converge as much less as the residual.
    #[test]
    fn tangents_stiffen_where_corrections_are_halved() {
        let after = |mut guard: Guard, halvings: u32, left: f64| {
            guard.adapt(halvings, left);
            guard.share
        };
        let near = |found: f64, expected: f64| {
            assert!((found - expected).abs() < 1e-15, "{found} {expected}");
        };
        let at = |share| Guard {
            share,
            ..Guard::IN_SPACE
        };
        near(after(at(0.02), 1, 2.0), 0.04);
        near(after(at(0.02), 3, 2.0), 0.16);
        near(after(at(0.5), 4, 2.0), 1.0);
        near(after(at(0.02), 0, 0.8), 0.01);
        near(after(at(0.006), 0, 0.8), 0.005);
        near(after(at(0.02), 0, 0.05), 0.001);
        // On a path there is none until a correction is halved, and none again once it has faded.
        near(after(Guard::ON_PATH, 0, 0.8), 0.0);
        near(after(Guard::ON_PATH, 1, 2.0), 1e-3);
        let faded = Guard {
            share: 9e-4,
            ..Guard::ON_PATH
        };
        near(after(faded, 0, 0.8), 0.0);
    }
}
