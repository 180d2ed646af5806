//! One load step: the Newton–Raphson iteration to equilibrium (theory, eqs. 24 and 25; Yuan et al.
//! 2021, section 2).

use std::time::Instant;

use igimp_assembly::{
    AcceptedContact, AssemblyError, CutVolume, Geometry, LoadPoint, Method, OutOfBalance,
    Particles, PoresAfter, Reach, Reinforcement, Remedy, SmallCuts, Stencils, StepConditions,
    StepWork, System, Trial, WaterMoved,
};
use igimp_linear::{LinearEffort, SolverKind};
use igimp_material::{Regime, TangentKind};
use igimp_shape::Grid;

use crate::body::Body;
use crate::corrector::Corrector;
use crate::free_factor::{FreeFactor, Guess};
use crate::free_field;
use crate::pace;
use crate::report::{
    MECHANISM, NodalForces, PhaseTimes, StepError, StepFailure, StepReport, padded,
};
use crate::residual_history::ResidualHistory;
use crate::settings::LoadPath;
use crate::{NewtonSettings, Workspace};

/// The ghost penalty of a step that is singular at a node which hardly touches soil \[-\].
const GHOST_PENALTY: f64 = 1e-3;

/// The fraction of a cell below which nodes are tied in a step on a given geometry that is singular at one which hardly touches soil \[-\].
const TIED_BELOW: f64 = 0.02;

/// Advances a body by one load step, from load factor `from` to `to`: the step displacements
/// that bring internal and external force into balance are found, and the particles are moved.
/// The body is untouched unless the step is accepted.
///
/// A step whose system is singular before any soil has touched a rigid body is tried once more with bodies laid on the soil that stands
/// at them (theory, eq. 46); one that is singular at a node that hardly touches soil with a ghost
/// penalty (theory, eq. 28), and the report says so. On a given geometry the penalty would be a support at a limit load: there such
/// nodes are tied (theory, eq. 63a), and where soil has no stiffness the step is tried once more with guarded corrections and regularised tangents (theory, eq. 25e),
/// which change no equilibrium. In a step that takes time the free fields beside walls go ahead.
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
    let stretch = Stretch {
        from,
        to,
        is_short_of_mechanism: false,
        guards_again: false,
    };
    step_of_march(body, method, conditions, stretch, settings, workspace)
}

/// The stretch of a step of a march.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stretch {
    /// Load factor at the start \[-\].
    pub(crate) from: f64,
    /// Load factor at the end \[-\].
    pub(crate) to: f64,
    /// Whether the step is refused where the body moves as a mechanism in it.
    pub(crate) is_short_of_mechanism: bool,
    /// Whether the step is tried once more with guarded corrections where it finds no equilibrium.
    pub(crate) guards_again: bool,
}

impl Stretch {
    /// That of a body of its own, loaded at once.
    const WHOLE: Self = Self {
        from: 0.0,
        to: 1.0,
        is_short_of_mechanism: false,
        guards_again: false,
    };
}

/// A step along a stretch, as [`step`] makes it.
pub(crate) fn step_of_march<const D: usize>(
    body: &mut Body<D>,
    method: &Method,
    conditions: &StepConditions<D>,
    stretch: Stretch,
    settings: &NewtonSettings,
    workspace: &mut Workspace<D>,
) -> Result<(StepReport, NodalForces<D>), StepError> {
    let factors = (stretch.from, stretch.to);
    let of_column = |particles: Particles<D>, conditions: &StepConditions<D>| {
        let mut column = Body::new(particles);
        let mut workspace = Workspace::new(SolverKind::Auto.build());
        step_of_body(
            &mut column,
            method,
            conditions,
            Stretch::WHOLE,
            settings,
            &mut workspace,
        )
        .map(|(_, forces)| (column.particles, forces))
        .map_err(|error| *error.failure)
    };
    match free_field::go_ahead(&body.free_fields, method, conditions, factors, &of_column)? {
        None => step_of_body(body, method, conditions, stretch, settings, workspace),
        Some((free_fields, conditions)) => {
            let done = step_of_body(body, method, &conditions, stretch, settings, workspace)?;
            body.free_fields = free_fields;
            Ok(done)
        }
    }
}

/// The same beside walls whose free fields have gone ahead.
fn step_of_body<const D: usize>(
    body: &mut Body<D>,
    method: &Method,
    conditions: &StepConditions<D>,
    stretch: Stretch,
    settings: &NewtonSettings,
    workspace: &mut Workspace<D>,
) -> Result<(StepReport, NodalForces<D>), StepError> {
    let Stretch {
        from,
        to,
        is_short_of_mechanism,
        guards_again,
    } = stretch;
    let attempt = Attempt {
        method,
        conditions,
        settings,
        from,
        to,
        again: None,
        on_path: None,
        measures_work: is_short_of_mechanism,
        is_short_of_mechanism,
    };
    let mut history = ResidualHistory::default();
    let failure = match equilibrium(&attempt, body, workspace, &mut history) {
        Ok(accepted) => return Ok(accepted),
        Err(failure) => failure,
    };
    let held = held_again(method, &history);
    let lies = failure.is_singular() && lies_on_nothing(body, conditions);
    let laid = lies.then(|| conditions.clone().with_bodies_laid());
    let on_bodies = laid.as_ref().map(|conditions| Attempt {
        conditions,
        ..attempt
    });
    let firmly = held.as_ref().map(|method| Attempt {
        method,
        again: Some(Again::Held),
        ..attempt
    });
    let guarded = if guards_again && failure.is_want_of_equilibrium()
        || method.geometry == Geometry::Given && has_no_stiffness(&failure, &workspace.trial)
    {
        Some(Attempt {
            again: Some(Again::Guarded),
            ..attempt
        })
    } else {
        None
    };
    for attempt in on_bodies.into_iter().chain(firmly).chain(guarded) {
        // A step that fails again fails for the first reason.
        let mut retry = ResidualHistory::default();
        if let Ok(accepted) = equilibrium(&attempt, body, workspace, &mut retry) {
            return Ok(accepted);
        }
    }
    Err(StepError {
        from,
        to,
        worst: history.worst(&conditions.grid),
        residuals: history.residuals,
        failure: Box::new(failure),
    })
}

/// The method with which a step is tried again that was singular at a node which hardly touches soil. On a given geometry nodes are
/// tied, if the tangent at the start of the step, which is elastic, was singular: soil that yields is no matter of its nodes.
fn held_again(method: &Method, history: &ResidualHistory) -> Option<Method> {
    let cuts = &method.small_cuts;
    let mut held = method.clone();
    match method.geometry {
        Geometry::Moving
            if cuts.ghost_penalty == 0.0
                && (history.is_weakly_held() || history.begins_weakly_held()) =>
        {
            held.small_cuts.ghost_penalty = GHOST_PENALTY;
        }
        Geometry::Given if cuts.below < TIED_BELOW && history.begins_weakly_held() => {
            held.small_cuts = SmallCuts {
                below: TIED_BELOW,
                of: CutVolume::Cell,
                remedy: Remedy::Extrapolate,
                ..*cuts
            };
        }
        Geometry::Moving | Geometry::Given => return None,
    }
    Some(held)
}

/// Whether a step in statics begins before any soil has touched a rigid body: at no gap and no pressure contact has no stiffness, and
/// holds no soil that lies on a body.
fn lies_on_nothing<const D: usize>(body: &Body<D>, conditions: &StepConditions<D>) -> bool {
    let mut knots = body.rigid.iter().flat_map(|rigid| &rigid.contact.knots);
    conditions.time.is_none() && !body.rigid.is_empty() && knots.all(|knot| knot.area == 0.0)
}

/// Whether a step failed for soil without stiffness: its system was singular, or soil was at the apex of its strength, where
/// it has none.
fn has_no_stiffness<const D: usize>(failure: &StepFailure, trial: &Trial<D>) -> bool {
    let at_apex = || trial.particles.iter().any(|p| p.regime == Regime::Apex);
    let finds_none = failure.is_want_of_equilibrium() && *failure != StepFailure::MechanismAtOnce;
    failure.is_singular() || finds_none && at_apex()
}

/// Advances a body by one step on its path, and measures the work of the step: to the load factor `to`, or by so much
/// work of the external force, with the load factor unknown.
pub(crate) fn step_on_path<const D: usize>(
    body: &mut Body<D>,
    method: &Method,
    load_path: &dyn LoadPath<D>,
    (from, target): (f64, &Target<D>),
    settings: &NewtonSettings,
    workspace: &mut Workspace<D>,
) -> Result<(StepConditions<D>, StepReport, NodalForces<D>), StepError> {
    let to = match target {
        Target::Factor { to, .. } => *to,
        Target::Work { guess, .. } => guess.factor,
    };
    let mut history = ResidualHistory::default();
    let found = load_path
        .conditions(from, to)
        .map_err(StepFailure::from)
        .and_then(|conditions| {
            let attempt = Attempt {
                method,
                conditions: &conditions,
                settings,
                from,
                to,
                again: None,
                on_path: match target {
                    Target::Factor { .. } => None,
                    Target::Work { work, guess } => Some((load_path, *work, guess)),
                },
                measures_work: true,
                is_short_of_mechanism: matches!(
                    target,
                    Target::Factor {
                        is_resolved: true,
                        ..
                    }
                ),
            };
            let found = equilibrium(&attempt, body, workspace, &mut history);
            let again = found
                .is_err()
                .then(|| held_again(method, &history))
                .flatten();
            let firmly = again.as_ref().map(|method| Attempt {
                method,
                again: Some(Again::Held),
                ..attempt
            });
            let mut retry = ResidualHistory::default();
            let held = firmly
                .filter(|attempt| attempt.method.geometry == Geometry::Given)
                .and_then(|attempt| equilibrium(&attempt, body, workspace, &mut retry).ok());
            let (report, forces) = held.map_or(found, Ok)?;
            let conditions = load_path.conditions(from, report.to)?;
            Ok((conditions, report, forces))
        });
    found.map_err(|failure| StepError {
        from,
        to,
        worst: None,
        residuals: history.residuals,
        failure: Box::new(failure),
    })
}

/// The target of a step on a path.
#[derive(Clone, Debug)]
pub(crate) enum Target<const D: usize> {
    /// A load factor.
    Factor {
        /// Where to \[-\].
        to: f64,
        /// Whether the step is refused where the body moves as a mechanism in it.
        is_resolved: bool,
    },
    /// Gross work of the external force on the step \[force·length\].
    Work {
        /// How much.
        work: f64,
        /// Where Newton's method begins.
        guess: Guess<D>,
    },
}

/// How a step is tried that failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Again {
    /// Nodes that hardly touch soil are held: by a ghost penalty, or tied.
    Held,
    /// Corrections are guarded, and tangents regularised.
    Guarded,
}

/// The input of one search for equilibrium.
struct Attempt<'a, const D: usize> {
    method: &'a Method,
    conditions: &'a StepConditions<D>,
    settings: &'a NewtonSettings,
    /// Load factors at the start and at the end \[-\].
    from: f64,
    to: f64,
    /// How a step is tried that failed.
    again: Option<Again>,
    /// Where the load factor at the end is unknown: its path, the work asked for \[force·length\], and a guess.
    on_path: Option<(&'a dyn LoadPath<D>, f64, &'a Guess<D>)>,
    /// Whether the work of the step is measured.
    measures_work: bool,
    /// Whether the step is refused where the body moves as a mechanism in it.
    is_short_of_mechanism: bool,
}

/// The Newton–Raphson loop. Corrections are made by the [`Corrector`].
fn equilibrium<const D: usize>(
    attempt: &Attempt<'_, D>,
    body: &mut Body<D>,
    workspace: &mut Workspace<D>,
    history: &mut ResidualHistory,
) -> Result<(StepReport, NodalForces<D>), StepFailure> {
    let &Attempt {
        method, settings, ..
    } = attempt;
    let clock = Instant::now();
    let conditions = &*attempt.conditions.without_rollers_at_tips(&body.rigid)?;
    let grid = &conditions.grid;
    let stencils = Stencils::build_under(&body.particles, method, conditions, &body.load_points)?;
    let structures = body.structures();
    let system =
        System::with_structures(&body.particles, &structures, &stencils, conditions, method)?
            .in_motion()?
            .sharing(workspace.pattern());
    let set_up = clock.elapsed();
    let mut u = vec![[0.0; D]; system.node_count()];
    let of_step = (system, &stencils);
    let mut corrector = Corrector::new(of_step, grid, settings, workspace, history, set_up)
        .guarded_if(attempt.again == Some(Again::Guarded));
    if let Some((load_path, work, guess)) = attempt.on_path {
        let points = &body.load_points;
        let asked = (attempt.from, work);
        let factor = FreeFactor::new(load_path, points, &corrector.system, asked, guess);
        corrector = corrector.on_path(factor);
        u.clone_from(&guess.u);
    }
    let mut residual = begin(&mut corrector, &mut u)?;
    while !corrector.is_found(&u, &residual) {
        corrector.correct(&mut u, &mut residual)?;
    }

    let linear = corrector.effort();
    let Corrector {
        system,
        factor,
        trial,
        iterations,
        times,
        ..
    } = corrector;
    let to = factor.as_ref().map_or(attempt.to, |factor| factor.at);
    let factor_in_doubt = factor.map_or(0.0, |factor| {
        factor.doubt(&system.by_unknown(&u), &residual)
    });
    let found = Found {
        reactions: system.reactions(trial),
        system,
        trial,
        u,
        iterations,
    };
    let load_points = carried(body, method, grid, &stencils, &found.u)?;
    let reinforcement = found.system.reinforcement_at(&found.u);
    on_grid(&reinforcement, grid)?;
    let clock = Instant::now();
    let report = StepReport {
        to,
        at_round_off: residual.relative_norm > settings.tolerance,
        factor_in_doubt,
        linear,
        times,
        ..found.report(attempt, body)?
    };
    let changes = found.changes()?;
    let (forces, water) = changes.accept(body, method, &stencils, trial);
    (body.load_points, body.reinforcement) = (load_points, reinforcement);
    let mut times = report.times;
    times.commit = clock.elapsed();
    let report = StepReport {
        worst: history.worst(grid),
        residuals: std::mem::take(&mut history.residuals),
        water,
        times,
        ..report
    };
    Ok((report, forces))
}

/// The equilibrium at the end of a step.
struct Found<'a, const D: usize> {
    system: System<'a, D>,
    trial: &'a Trial<D>,
    u: Vec<[f64; D]>,
    reactions: Vec<[f64; D]>,
    iterations: usize,
}

impl<const D: usize> Found<'_, D> {
    /// The report of the step before it is accepted.
    ///
    /// # Errors
    /// [`StepFailure::TooLong`], [`StepFailure::Thrown`], [`StepFailure::MechanismAtOnce`], and those of its energy and its work.
    fn report(&self, attempt: &Attempt<'_, D>, body: &Body<D>) -> Result<StepReport, StepFailure> {
        let Self {
            system, trial, u, ..
        } = self;
        system.holds_bodies_within(Reach::OF_STEP, u)?;
        let work = (attempt.measures_work)
            .then(|| system.work(trial, u))
            .transpose()?;
        let gross_work = system.gross_work_of_loads(u);
        let is_mechanism = |work: &StepWork| work.dissipated_share(gross_work) >= MECHANISM;
        if attempt.is_short_of_mechanism && work.as_ref().is_some_and(is_mechanism) {
            return Err(StepFailure::MechanismAtOnce);
        }
        let held = |by: f64, geometry: Geometry| {
            let is_held = attempt.again == Some(Again::Held) && attempt.method.geometry == geometry;
            if is_held { by } else { 0.0 }
        };
        Ok(StepReport {
            from: attempt.from,
            to: attempt.to,
            iterations: self.iterations,
            worst: None,
            residuals: Vec::new(),
            at_round_off: false,
            unknowns: system.unknowns().len(),
            plastic_share: plastic_share(trial),
            false_support: system.false_support(&self.reactions),
            ghost_penalty: held(GHOST_PENALTY, Geometry::Moving),
            tied_below: held(TIED_BELOW, Geometry::Given),
            moves_by_means: system.moves_by_means(),
            drag_share: system.drag_share(u),
            work,
            duration: attempt.conditions.duration(),
            pace: pace_after(system, (trial, u), body, self.iterations)?,
            energy: system.energy(trial, u)?,
            water: None,
            external_work: system.work_of_loads(u),
            gross_work,
            factor_in_doubt: 0.0,
            linear: LinearEffort::default(),
            times: PhaseTimes::default(),
        })
    }

    /// The changes of the step when it is accepted.
    ///
    /// # Errors
    /// Those of soil that would be in a rigid body.
    fn changes(self) -> Result<Changes<D>, StepFailure> {
        let Self { system, u, .. } = self;
        let (motion, ties) = (system.motion(&u), system.tie_forces(&u));
        Ok(Changes {
            contact: system.bodies_at(&u)?,
            pores: system.into_pores(&u),
            forces: NodalForces {
                reactions: self.reactions,
                u,
                motion,
                ties,
            },
        })
    }
}

/// The changes of an accepted step beside those that soil carries along.
struct Changes<const D: usize> {
    forces: NodalForces<D>,
    contact: AcceptedContact<D>,
    pores: PoresAfter,
}

impl<const D: usize> Changes<D> {
    /// Writes particles and rigid bodies; the forces at nodes, and the water that moved.
    fn accept(
        self,
        body: &mut Body<D>,
        method: &Method,
        stencils: &Stencils<D>,
        trial: &Trial<D>,
    ) -> (NodalForces<D>, Option<WaterMoved>) {
        let particles = &mut body.particles;
        particles.commit(stencils, method, trial, &self.forces.u);
        if let Some(motion) = &self.forces.motion {
            particles.accelerate(stencils, motion);
        }
        particles.fill_pores(&self.pores);
        particles.push_out(&self.contact.push_out);
        body.rigid = self.contact.bodies;
        (self.forces, self.pores.water_moved)
    }
}

/// The start of a step, and its prescribed motion carried through the body.
fn begin<const D: usize>(
    corrector: &mut Corrector<'_, '_, D>,
    u: &mut Vec<[f64; D]>,
) -> Result<OutOfBalance, StepFailure> {
    let mut residual = start(corrector, u)?;
    if corrector.system.prescribes_motion() {
        carry_prescribed_motion(&corrector.system, &mut residual, u)?;
    }
    Ok(residual)
}

/// The start of a step: nodal displacements `u` of motion that goes on as it is, or none, and the residual there.
fn start<const D: usize>(
    corrector: &mut Corrector<'_, '_, D>,
    u: &mut Vec<[f64; D]>,
) -> Result<OutOfBalance, StepFailure> {
    let Some(predicted) = corrector.system.predicted_motion() else {
        return corrector.start(u);
    };
    *u = predicted;
    match corrector.start(u) {
        Err(failure) if failure.is_want_of_equilibrium() => {
            u.fill([0.0; D]);
            corrector.start(u)
        }
        started => started,
    }
}

/// How many times as long the next step may be as one by nodal displacements `u` \[-\].
///
/// # Errors
/// [`StepFailure::TooLong`] for a step that has to resolve the change of motion and does not.
fn pace_after<const D: usize>(
    system: &System<'_, D>,
    (trial, u): (&Trial<D>, &[[f64; D]]),
    body: &Body<D>,
    iterations: usize,
) -> Result<f64, StepFailure> {
    let pace = pace::after(system, (trial, u), body, iterations);
    let conditions = system.conditions();
    let of_motion = conditions.time.is_some_and(|time| time.must_resolve);
    let of_flow = (conditions.flow.as_ref()).is_some_and(|flow| flow.must_resolve);
    let duration = conditions.duration();
    match pace.again {
        Some(share) if of_motion || of_flow => Err(StepFailure::TooLong { duration, share }),
        _ => Ok(pace.next),
    }
}

/// Share of particles that returned to the yield surface \[-\].
fn plastic_share<const D: usize>(trial: &Trial<D>) -> f64 {
    let particles = trial.particles.iter();
    let plastic = particles.filter(|state| state.regime.is_plastic()).count();
    plastic as f64 / trial.particles.len() as f64
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
        let carried = point.carried(grid, stencils, index, u)?;
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

/// Refuses reinforcement that would be carried off the grid.
fn on_grid<const D: usize>(
    reinforcement: &[Reinforcement<D>],
    grid: &Grid<D>,
) -> Result<(), StepFailure> {
    for member in reinforcement {
        let mut points = member.stations.iter().flat_map(|station| &station.points);
        if let Some(x) = points.find(|x| !grid.contains(x)) {
            return Err(StepFailure::ReinforcementLeavesGrid {
                name: member.name.clone(),
                position: padded(x),
            });
        }
    }
    Ok(())
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
