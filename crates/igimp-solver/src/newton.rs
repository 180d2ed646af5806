//! One load step: the Newton–Raphson iteration to equilibrium (theory, eqs. 24 and 25; Yuan et al.
//! 2021, section 2).

use std::sync::Arc;
use std::time::{Duration, Instant};

use igimp_assembly::{
    AssemblyError, Geometry, LoadPoint, Method, OutOfBalance, Pattern, Stencils, StepConditions,
    System, TangentMatrix, Trial,
};
use igimp_material::TangentKind;
use igimp_shape::Grid;
use thiserror::Error;

use crate::body::Body;
use crate::course::Course;
use crate::linear::{LinearSolver, LinearSolverError};
use crate::named::{finite_correction, named};

/// The ghost penalty of a step that is singular at a node which hardly touches soil \[-\].
const GHOST_PENALTY: f64 = 1e-3;

/// How often a correction is halved.
const MOST_HALVINGS: u32 = 4;

/// When a step counts as converged, and when it is given up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonSettings {
    /// Accepted ‖f_ext − f_int‖ / (‖f_ext‖ + ‖f_react‖) \[-\].
    pub tolerance: f64,
    /// Largest number of corrections.
    pub max_iterations: usize,
    /// A residual this many times the smallest one so far counts as divergence \[-\].
    pub divergence: f64,
}

impl Default for NewtonSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-9,
            max_iterations: 25,
            divergence: 1e4,
        }
    }
}

/// Why a step found no equilibrium.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StepFailure {
    /// The corrections ran out.
    #[error("not converged after {iterations} corrections")]
    MaxIterations {
        /// How many were made.
        iterations: usize,
    },
    /// The residual grew far beyond its smallest value.
    #[error("the residual diverges")]
    Diverged,
    /// The residual found no new smallest value for many corrections.
    #[error("the residual stagnates")]
    Stagnated,
    /// Converged, but a particle would be carried off the background grid.
    #[error("particle {particle} would leave the background grid at {position:?} m")]
    LeavesGrid {
        /// Number of the particle, from 0.
        particle: usize,
        /// Where it would go \[length\], axes beyond the dimension 0.
        position: [f64; 3],
    },
    /// Converged, but a load point would be carried off the background grid.
    #[error("load point {point} would leave the background grid at {position:?} m")]
    LoadPointLeavesGrid {
        /// Number of the point, from 0.
        point: usize,
        /// Where it would go \[length\], axes beyond the dimension 0.
        position: [f64; 3],
    },
    /// A number of the linear system that must be finite is not.
    #[error("the {what} at {position:?} m, axis {axis}, is not finite")]
    NotFinite {
        /// `"right-hand side"` or `"correction"`.
        what: &'static str,
        /// Place of the node \[length\], axes beyond the dimension 0.
        position: [f64; 3],
        /// The component, from 0.
        axis: usize,
    },
    /// The equations could not be formed.
    #[error("the equations could not be formed")]
    Assembly(#[from] AssemblyError),
    /// The linear system could not be solved.
    #[error("the linear system could not be solved")]
    Linear(#[from] LinearSolverError),
}

impl StepFailure {
    /// Whether the failure speaks for want of equilibrium, as past a limit load: the equations were
    /// there and Newton's method found no solution near. A particle that leaves the grid, a law that
    /// cannot answer or memory that runs out tell nothing of the load that a body carries.
    pub fn is_want_of_equilibrium(&self) -> bool {
        match self {
            Self::MaxIterations { .. } | Self::Diverged | Self::Stagnated => true,
            Self::LeavesGrid { .. } | Self::LoadPointLeavesGrid { .. } | Self::NotFinite { .. } => {
                false
            }
            Self::Assembly(error) => error.is_too_far(),
            Self::Linear(error) => matches!(
                error,
                LinearSolverError::Singular { .. }
                    | LinearSolverError::NotPositiveDefinite { .. }
                    | LinearSolverError::Inaccurate { .. }
            ),
        }
    }

    /// Whether something was to be carried off the grid: a smaller step only puts that off.
    pub(crate) fn leaves_grid(&self) -> bool {
        matches!(
            self,
            Self::LeavesGrid { .. } | Self::LoadPointLeavesGrid { .. }
        )
    }
}

/// A step that was not accepted, with what is known of it.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("no equilibrium between load factors {from} and {to}")]
pub struct StepError {
    /// Load factor at the start \[-\].
    pub from: f64,
    /// Load factor tried \[-\].
    pub to: f64,
    /// Relative out-of-balance norm before each correction \[-\].
    pub residuals: Vec<f64>,
    /// Position \[length\] and axis of the largest out-of-balance force.
    pub worst: Option<([f64; 3], usize)>,
    /// Why.
    #[source]
    pub failure: Box<StepFailure>,
}

/// Time spent in the phases of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PhaseTimes {
    /// Stencils, unknowns, external force, pattern.
    pub set_up: Duration,
    /// Passes over the particles: stress, internal force, tangent matrix; residual.
    pub assembly: Duration,
    /// Factorisation of the tangent matrices, with the analysis of their patterns.
    pub factor: Duration,
    /// Solution of the linear systems.
    pub solve: Duration,
    /// Writing the accepted state.
    pub commit: Duration,
}

impl PhaseTimes {
    /// Adds another step's times.
    pub fn add(&mut self, other: &Self) {
        self.set_up += other.set_up;
        self.assembly += other.assembly;
        self.factor += other.factor;
        self.solve += other.solve;
        self.commit += other.commit;
    }
}

/// An accepted step.
#[derive(Clone, Debug, PartialEq)]
pub struct StepReport {
    /// Load factor at the start \[-\].
    pub from: f64,
    /// Load factor reached \[-\].
    pub to: f64,
    /// Number of corrections.
    pub iterations: usize,
    /// Relative out-of-balance norm before each correction and at the end \[-\].
    pub residuals: Vec<f64>,
    /// Whether the step was accepted above the tolerance because its residual is nothing but
    /// round-off of the internal force.
    pub at_round_off: bool,
    /// Number of unknowns.
    pub unknowns: usize,
    /// Share of particles that returned to the yield surface \[-\].
    pub plastic_share: f64,
    /// Share of the load that dropped nodes take without a support \[-\].
    pub false_support: f64,
    /// The ghost penalty that the step was given because a node that hardly touches soil left its
    /// system singular; zero in a step that did without \[-\].
    pub ghost_penalty: f64,
    /// Position \[length\] and axis of the largest out-of-balance force that was left.
    pub worst: Option<([f64; 3], usize)>,
    /// Share of the external force that drag against motion carries; zero in equilibrium \[-\].
    pub drag_share: f64,
    /// Time spent.
    pub times: PhaseTimes,
}

/// Forces of an accepted step, by node of its grid.
#[derive(Clone, Debug, PartialEq)]
pub struct NodalForces<const D: usize> {
    /// Reaction f_int − f_ext where displacement is prescribed, zero elsewhere \[force\].
    pub reactions: Vec<[f64; D]>,
    /// Step displacement \[length\].
    pub u: Vec<[f64; D]>,
}

/// What lasts from step to step besides the body: the solver with its symbolic work, and the memory
/// of the matrix and of the trial. It holds nothing that a result depends on.
pub struct Workspace<const D: usize> {
    solver: Box<dyn LinearSolver>,
    matrix: Option<TangentMatrix>,
    trial: Trial<D>,
    du: Vec<f64>,
}

impl<const D: usize> std::fmt::Debug for Workspace<D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Workspace")
            .field("solver", &self.solver.name())
            .finish_non_exhaustive()
    }
}

impl<const D: usize> Workspace<D> {
    /// A workspace around a linear solver.
    pub fn new(solver: Box<dyn LinearSolver>) -> Self {
        Self {
            solver,
            matrix: None,
            trial: Trial::default(),
            du: Vec::new(),
        }
    }

    fn pattern(&self) -> Option<&Arc<Pattern>> {
        self.matrix.as_ref().map(|matrix| &matrix.pattern)
    }
}

/// Advances a body by one load step, from load factor `from` to `to`: the step displacements
/// that bring internal and external force into balance are found, and the particles are moved.
/// The body is untouched unless the step is accepted.
///
/// A step whose system is singular at a node that hardly touches soil is tried once more with a ghost
/// penalty (theory, eq. 28), and the report says so. On a given geometry it is not: at a limit load the
/// penalty would be a support.
///
/// # Errors
/// [`StepError`] when no equilibrium was found, with the residuals so far.
pub fn step<const D: usize>(
    body: &mut Body<D>,
    method: &Method,
    conditions: &StepConditions<D>,
    (from, to): (f64, f64),
    settings: &NewtonSettings,
    workspace: &mut Workspace<D>,
) -> Result<(StepReport, NodalForces<D>), StepError> {
    let mut attempt = |body: &mut Body<D>, method: &Method| {
        let mut course = Course::default();
        let result = equilibrium(body, method, conditions, settings, workspace, &mut course);
        (result, course)
    };
    let (mut result, mut course) = attempt(body, method);
    let may_hold = method.geometry == Geometry::Moving && method.small_cuts.ghost_penalty == 0.0;
    if result.is_err() && may_hold && course.is_weakly_held() {
        let mut held = method.clone();
        held.small_cuts.ghost_penalty = GHOST_PENALTY;
        // What fails all the same fails for the first reason.
        if let (Ok((report, forces)), own) = attempt(body, &held) {
            let report = StepReport {
                ghost_penalty: GHOST_PENALTY,
                ..report
            };
            (result, course) = (Ok((report, forces)), own);
        }
    }
    let worst = course
        .worst
        .map(|(node, axis)| (padded(&conditions.grid.node_position(node)), axis));
    let residuals = course.residuals;
    match result {
        Ok((report, forces)) => {
            let report = StepReport {
                from,
                to,
                residuals,
                worst,
                ..report
            };
            Ok((report, forces))
        }
        Err(failure) => Err(StepError {
            from,
            to,
            residuals,
            worst,
            failure: Box::new(failure),
        }),
    }
}

/// The Newton–Raphson loop.
///
/// The first correction uses the elastic tangent and carries the prescribed motion; all others
/// use the consistent tangent; the last one may use that of the correction before. One that turns a
/// particle inside out, or raises the residual manyfold, is halved.
fn equilibrium<const D: usize>(
    body: &mut Body<D>,
    method: &Method,
    conditions: &StepConditions<D>,
    settings: &NewtonSettings,
    workspace: &mut Workspace<D>,
    course: &mut Course,
) -> Result<(StepReport, NodalForces<D>), StepFailure> {
    let mut times = PhaseTimes::default();
    let clock = Instant::now();
    let grid = &conditions.grid;
    let stencils = Stencils::build(&body.particles, method, conditions)?;
    let system = System::new(
        &body.particles,
        &stencils,
        conditions,
        method,
        &body.load_points,
        workspace.pattern(),
    )?;
    times.set_up = clock.elapsed();

    let Workspace {
        solver,
        matrix,
        trial,
        du,
    } = workspace;
    let earlier = matrix.take();
    let matrix = matrix.insert(system.matrix_from(earlier));
    let mut u = vec![[0.0; D]; grid.node_count()];
    timed(&mut times.assembly, || {
        system.linearise_into(&u, TangentKind::Elastic, trial, matrix)
    })?;
    let mut residual = system.out_of_balance(trial)?;
    course.record(&residual, settings)?;
    let mut iterations = 0;
    if conditions.constraints.prescribe_motion() {
        carry_prescribed_motion(&system, &mut residual, &mut u)?;
    }
    let kind = TangentKind::Consistent;
    // Whether the matrix is the tangent at u, or that before the last correction.
    let mut is_current = true;
    while !converged(&residual, settings.tolerance) {
        if iterations == settings.max_iterations {
            return Err(StepFailure::MaxIterations { iterations });
        }
        if !is_current && !course.factors_suffice(settings.tolerance) {
            timed(&mut times.assembly, || {
                system.linearise_into(&u, kind, trial, matrix)
            })?;
            is_current = true;
        }
        // What the matrix was made with: the elastic tangent belongs to the start of the step.
        let made_at = (iterations > 0).then_some(&u[..]);
        if is_current {
            timed(&mut times.factor, || solver.factor(matrix)).map_err(|error| {
                course.fill_of_singular = fill_of_singular(&error, &system, &stencils, grid);
                named(error, &system, grid, made_at)
            })?;
        }
        du.resize(residual.force.len(), 0.0);
        timed(&mut times.solve, || {
            solver.solve(matrix, &residual.force, du)
        })
        .map_err(|error| named(error, &system, grid, made_at))?;
        finite_correction(du, &system, grid)?;
        system.add_correction(&mut u, du);
        iterations += 1;
        is_current = !course.factors_will_suffice(settings.tolerance);
        let tangent = is_current.then_some(&mut *matrix);
        timed(&mut times.assembly, || {
            evaluate_within_reach(&system, course, (&mut u, du), trial, tangent, &mut residual)
        })?;
        course.record(&residual, settings)?;
    }
    let load_points = carried(body, method, grid, &stencils, &u)?;

    let clock = Instant::now();
    let reactions = system.reactions(trial);
    let plastic = trial
        .particles
        .iter()
        .filter(|own| own.regime.is_plastic())
        .count();
    let report = StepReport {
        from: 0.0,
        to: 0.0,
        iterations,
        residuals: Vec::new(),
        at_round_off: residual.relative_norm > settings.tolerance,
        unknowns: system.unknowns().len(),
        plastic_share: plastic as f64 / trial.particles.len() as f64,
        false_support: system.false_support(&reactions),
        ghost_penalty: 0.0,
        worst: None,
        drag_share: system.drag_share(&u),
        times,
    };
    body.load_points = load_points;
    body.particles.commit(&stencils, method, trial, &u);
    let mut report = report;
    report.times.commit = clock.elapsed();
    Ok((report, NodalForces { reactions, u }))
}

/// How full the cells are around the node that a singular system names \[-\].
fn fill_of_singular<const D: usize>(
    error: &LinearSolverError,
    system: &System<'_, D>,
    stencils: &Stencils<D>,
    grid: &Grid<D>,
) -> Option<f64> {
    let LinearSolverError::Singular {
        unknown: Some(unknown),
    } = error
    else {
        return None;
    };
    let (node, _) = system.unknowns().place(*unknown)?;
    Some(stencils.node_fill(grid, node))
}

/// The load points where nodal step displacements `u` carry them: all of them on the grid, and the
/// particles too. On a given geometry nothing moves.
fn carried<const D: usize>(
    body: &Body<D>,
    method: &Method,
    grid: &Grid<D>,
    stencils: &Stencils<D>,
    u: &[[f64; D]],
) -> Result<Vec<LoadPoint<D>>, StepFailure> {
    if method.geometry == Geometry::Given {
        return Ok(body.load_points.clone());
    }
    if let Some((particle, x)) = body.particles.leaving(grid, stencils, u) {
        return Err(StepFailure::LeavesGrid {
            particle,
            position: padded(&x),
        });
    }
    let carry = |(index, point): (usize, &LoadPoint<D>)| {
        let carried = point.carried(grid, index, u)?;
        if grid.contains(&carried.x) {
            Ok(carried)
        } else {
            Err(StepFailure::LoadPointLeavesGrid {
                point: index,
                position: padded(&carried.x),
            })
        }
    };
    body.load_points.iter().enumerate().map(carry).collect()
}

/// Evaluates the trial at `u`, to which the correction `du` was added, with its tangent where a matrix
/// is given. A correction that goes too far is halved: one that turns a particle inside out, or
/// raises the residual manyfold.
fn evaluate_within_reach<const D: usize>(
    system: &System<'_, D>,
    course: &Course,
    (u, du): (&mut [[f64; D]], &mut [f64]),
    trial: &mut Trial<D>,
    mut matrix: Option<&mut TangentMatrix>,
    residual: &mut OutOfBalance,
) -> Result<(), AssemblyError> {
    let kind = TangentKind::Consistent;
    let mut halvings = 0;
    loop {
        let evaluated = match &mut matrix {
            Some(matrix) => system.linearise_into(u, kind, trial, matrix),
            None => system.evaluate_into(u, kind, trial),
        }
        .and_then(|()| system.update_out_of_balance(residual, trial));
        let too_far = match &evaluated {
            Ok(()) => course.overshoots(residual),
            Err(error) => error.is_too_far(),
        };
        if !too_far || halvings == MOST_HALVINGS {
            return evaluated;
        }
        take_back_half(system, u, du, halvings);
        halvings += 1;
    }
}

/// Takes back half of what is left of a correction in `u`. `du` is the correction itself, or what was
/// taken back last.
fn take_back_half<const D: usize>(
    system: &System<'_, D>,
    u: &mut [[f64; D]],
    du: &mut [f64],
    halvings: u32,
) {
    let share = if halvings == 0 { -0.5 } else { 0.5 };
    for component in du.iter_mut() {
        *component *= share;
    }
    system.add_correction(u, du);
}

/// Lets the first correction carry the prescribed motion: sets `u` to it and takes the force that it
/// causes from the residual, which counts as unconverged whatever it was.
fn carry_prescribed_motion<const D: usize>(
    system: &System<'_, D>,
    residual: &mut OutOfBalance,
    u: &mut Vec<[f64; D]>,
) -> Result<(), AssemblyError> {
    let known = system.force_of_prescribed_motion(u, TangentKind::Elastic)?;
    for (force, known) in residual.force.iter_mut().zip(known) {
        *force -= known;
    }
    residual.relative_norm = f64::INFINITY;
    residual.is_round_off = false;
    *u = system.prescribed_motion();
    Ok(())
}

/// Whether a residual meets the tolerance, or is nothing but round-off; one that is not a number
/// does neither.
fn converged(residual: &OutOfBalance, tolerance: f64) -> bool {
    residual.relative_norm <= tolerance || residual.is_round_off
}

/// Runs a phase and adds its time.
fn timed<T>(total: &mut Duration, phase: impl FnOnce() -> T) -> T {
    let clock = Instant::now();
    let result = phase();
    *total += clock.elapsed();
    result
}

/// A position with zeros beyond the dimension, for messages.
pub(crate) fn padded<const D: usize>(x: &[f64; D]) -> [f64; 3] {
    let mut out = [0.0; 3];
    out[..D].copy_from_slice(x);
    out
}
