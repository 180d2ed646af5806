//! Data passed from stage to stage of a run: model, listener, records and results folder.

use std::collections::HashMap;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use igimp_assembly::{
    AssemblyError, Geometry, Method, Particles, StepConditions, StepEnergy, TimeScheme, TimeStep,
    UnbalancedForces,
};
use igimp_linear::LinearEffort;
use igimp_model::Consolidation;
use igimp_results::ending::EndReason;
use igimp_results::fields;
use igimp_results::summary::{StageSummary, Summary};
use igimp_solver::{
    Accepted, LoadPath, MarchSettings, MarchState, Observer, Outcome, StepError, StepReport,
    Workspace, march_from,
};
use igimp_text::short;

use super::model::Model;
use super::output::Output;
use super::output::export::Export;
use super::output::moment::{Moment, largest_displacement};
use super::output::records::Records;
use super::resume::Resumption;
use super::state::{Controls, State};
use super::water::flow;
use super::{Event, Listener, rigid};
use crate::error::CaseError;
use crate::run::output::moment::AcceptedStep;
use igimp_estimate::factor_memory::decides;

/// Share of the load from which on a false support at dropped nodes is worth a warning \[-\].
const FALSE_SUPPORT: f64 = 1e-3;

/// A run between its stages.
pub(crate) struct Session<'a, const D: usize> {
    pub(crate) model: &'a Model<'a, D>,
    pub(crate) listener: &'a mut dyn Listener<D>,
    pub(crate) interrupt: &'a AtomicBool,
    pub(crate) records: Records,
    pub(crate) output: Option<Output<D>>,
    /// Where linear systems are written, if they are wanted.
    pub(crate) export: Option<Export>,
    pub(crate) summary: Summary,
    /// Resistance of the footing after the last step \[N/m\].
    pub(crate) last_resistance: f64,
    /// Ends of stages that ran, by number.
    pub(crate) ends: HashMap<usize, State<D>>,
    /// Whether it was said that memory decided on the linear solver.
    pub(crate) warned_of_memory: bool,
}

impl<const D: usize> Session<'_, D> {
    /// Tells the listener.
    pub(crate) fn tell(&mut self, event: &Event<'_, D>) {
        self.listener.on_event(event);
    }

    /// Tells the listener once of something that the user should know, and keeps it for the summary.
    pub(crate) fn warn(&mut self, text: String) {
        if self.summary.warnings.contains(&text) {
            return;
        }
        self.tell(&Event::Warning { text: &text });
        self.summary.warnings.push(text);
    }

    /// The same of something that goes on: with how it was when it began.
    pub(crate) fn warn_once(&mut self, subject: &str, how: &str) {
        let mut warnings = self.summary.warnings.iter();
        if !warnings.any(|text| text.starts_with(subject)) {
            self.warn(format!("{subject}{how}"));
        }
    }

    /// The same of a stage, by its number.
    pub(crate) fn warn_of_stage(&mut self, number: usize, text: &str) {
        let name = &self.model.case.stages[number].name;
        self.warn(format!("stage \"{name}\": {text}"));
    }

    /// Memory of a march besides the body.
    pub(super) fn workspace(&self) -> Workspace<D> {
        let solver = self.model.solver();
        Workspace::new(match &self.export {
            Some(export) => export.watch(solver),
            None => solver,
        })
    }

    /// A step was accepted: its system is the one that is written if the stage ends now.
    pub(crate) fn keep_system(&mut self, conditions: &StepConditions<D>, stage: &StageSummary) {
        if let Some(export) = &mut self.export {
            export.accepted(conditions, &self.summary, stage);
        }
    }

    /// Solutions since the last accepted step belong to none.
    pub(crate) fn drop_system(&mut self) {
        if let Some(export) = &mut self.export {
            export.not_accepted();
        }
    }

    /// Whether the user wants the run to end.
    pub(crate) fn interrupted(&self) -> bool {
        self.interrupt.load(Ordering::Relaxed)
    }

    /// Records a moment in tables and files.
    pub(crate) fn record(&mut self, moment: &Moment<'_, D>) -> Result<(), CaseError> {
        let rows = self.records.record(self.model.case, moment);
        match &mut self.output {
            Some(output) => output.write_rows(&rows),
            None => Ok(()),
        }
    }

    /// The displacement that a condition looks at: of the particle nearest to a monitor, or the largest of all \[m\].
    pub(crate) fn displacement(&self, monitor: Option<usize>, particles: &Particles<D>) -> f64 {
        monitor.map_or_else(
            || largest_displacement(particles),
            |monitor| {
                let place = particles.place_of(self.records.watched[monitor].nearest);
                place.map_or(0.0, |particle| {
                    fields::length(&particles.displacement[particle])
                })
            },
        )
    }

    /// That displacement in words.
    pub(crate) fn whose_displacement(&self, monitor: Option<usize>) -> String {
        monitor.map_or_else(
            || "the largest displacement".to_owned(),
            |monitor| {
                let name = &self.model.case.monitors[monitor].name;
                format!("the displacement of `{name}`")
            },
        )
    }

    /// Adds an accepted step to the tally of its stage.
    pub(super) fn tally(
        &mut self,
        stage: &mut StageSummary,
        report: &StepReport,
    ) -> Result<(), CaseError> {
        stage.steps += 1;
        stage.iterations += report.iterations;
        stage.work += report.gross_work;
        if let Some(energy) = &report.energy {
            add_energy(stage, energy, report.duration);
        }
        stage.at_round_off += usize::from(report.at_round_off);
        stage.ghost_steps += usize::from(report.ghost_penalty > 0.0 || report.tied_below > 0.0);
        self.tally_means(stage, report);
        stage.plastic_share = report.plastic_share;
        let before = stage.false_support;
        stage.false_support = before.max(report.false_support);
        if before <= FALSE_SUPPORT && stage.false_support > FALSE_SUPPORT {
            self.warn(format!(
                "stage \"{}\": nodes that hardly touch soil and were dropped take {} % of the load, \
                 which no support gives; try small_cuts = {{ remedy = \"tie\" }} or \
                 small_cuts = {{ below = 0, ghost_penalty = 1e-3 }} in [grid]",
                stage.name,
                short(100.0 * stage.false_support)
            ));
        }
        let effort = &report.linear;
        let is_shown = D == 3 || self.model.case.given_solver.is_some();
        if is_shown && effort.solutions > 0 {
            self.warn_of_memory(&stage.name, effort);
            let linear = stage.linear.get_or_insert_default();
            effort.method.clone_into(&mut linear.method);
            linear.reason = self.model.factors.explain(&effort.reason);
            linear.solutions += effort.solutions;
            linear.iterations += effort.iterations;
            linear.most_iterations = linear.most_iterations.max(effort.most_iterations);
            linear.lost_iterations += effort.lost_iterations;
        }
        let times = &report.times;
        let phases = [
            times.set_up,
            times.assembly,
            times.factor,
            times.solve,
            times.commit,
        ];
        for (sum, time) in stage.phases.iter_mut().zip(phases) {
            *sum += time.as_secs_f64();
        }
        let unknowns = &mut self.summary.size.unknowns;
        *unknowns = report.unknowns.max(*unknowns);
        let course = (report.from, report.to, &report.residuals[..]);
        self.write_convergence(stage, course, true)
    }

    /// Counts a step whose motion began with means, and warns of it once.
    fn tally_means(&mut self, stage: &mut StageSummary, report: &StepReport) {
        if report.moves_by_means {
            stage.steps_by_means += 1;
            self.warn(format!(
                "stage \"{}\": the motion of the particles could not be given to the grid as it is, and means around nodes were \
                 taken, which lose energy: see what the map took in the energy of the stage",
                stage.name
            ));
        }
    }

    /// Says once that the memory of this machine decided how systems are solved: another one comes to other last digits.
    fn warn_of_memory(&mut self, stage: &str, effort: &LinearEffort) {
        let factors = &self.model.factors;
        if !(factors.is_of_machine && decides(&effort.reason)) || self.warned_of_memory {
            return;
        }
        let text = format!(
            "stage \"{stage}\": the memory for factors, {}, decides that systems are solved by {}; a machine with more comes to \
             other last digits, and memory = \"...\" in [solver] makes all alike",
            factors.words(),
            effort.method
        );
        self.warned_of_memory = true;
        self.warn(text);
    }

    /// Adds a step that was not accepted.
    pub(super) fn tally_cut(
        &mut self,
        stage: &mut StageSummary,
        error: &StepError,
    ) -> Result<(), CaseError> {
        stage.cuts += 1;
        self.tell(&Event::Cut { error });
        let course = (error.from, error.to, &error.residuals[..]);
        self.write_convergence(stage, course, false)
    }

    fn write_convergence(
        &mut self,
        stage: &StageSummary,
        course: (f64, f64, &[f64]),
        accepted: bool,
    ) -> Result<(), CaseError> {
        let step = stage.steps + usize::from(!accepted);
        match &mut self.output {
            Some(output) => output.write_convergence((&stage.name, step), course, accepted),
            None => Ok(()),
        }
    }
}

/// Adds the energy of an accepted step to that of its stage.
fn add_energy(stage: &mut StageSummary, step: &StepEnergy, duration: f64) {
    let energy = stage.energy.get_or_insert_default();
    energy.time += duration;
    energy.kinetic = step.kinetic;
    let before = step.kinetic - step.kinetic_gain;
    energy.most_kinetic = energy.most_kinetic.max(before).max(step.kinetic);
    energy.kinetic_gain += step.kinetic_gain;
    energy.elastic += step.elastic_gain;
    energy.plastic += step.plastic;
    energy.contact += step.contact;
    energy.reinforcement += step.reinforcement;
    energy.water += step.water;
    energy.damping += step.damping;
    energy.boundaries += step.boundaries;
    energy.loads += step.loads;
    energy.supports += step.supports;
    energy.scheme += step.scheme;
    energy.map += step.map;
    energy.integration += step.integration + step.unbalanced;
}

/// A march of the body between two controls.
pub(crate) struct StagePath<'a, const D: usize> {
    /// Controls at load factor 0.
    pub(crate) from: &'a Controls,
    /// Controls at load factor 1.
    pub(crate) to: &'a Controls,
    /// Drag of a step between two load factors, for overdamped motion \[1/s²\].
    pub(crate) drag: &'a dyn Fn(f64, f64) -> f64,
    /// The time integration, where the march takes time.
    pub(crate) time: Option<TimeIntegration<'a, D>>,
    /// How water flows, where it does while the march takes time.
    pub(crate) flow: Option<&'a Consolidation>,
    /// The method, with the geometry that its steps are computed on.
    pub(crate) method: Method,
    /// Sizes of steps.
    pub(crate) settings: MarchSettings,
    /// Forces that hold the body at first and are let go on the way, by node \[N/m\].
    pub(crate) held: Option<Arc<Vec<[f64; D]>>>,
    /// Where an earlier run left the march.
    pub(crate) left: Option<&'a Resumption>,
}

impl<'a, const D: usize> StagePath<'a, D> {
    /// A path through equilibria from its beginning, without drag.
    pub(crate) fn of_equilibria(
        (from, to): (&'a Controls, &'a Controls),
        method: Method,
        settings: MarchSettings,
    ) -> Self {
        Self {
            from,
            to,
            drag: &|_, _| 0.0,
            time: None,
            flow: None,
            method,
            settings,
            held: None,
            left: None,
        }
    }

    /// The controls at a load factor, with the motion of the last equilibrium.
    fn at(&self, factor: f64, last: &Controls) -> Controls {
        self.from.towards(self.to, factor).moved_as(last)
    }

    /// The conditions of a step between two load factors, with the controls there.
    fn conditions(
        &self,
        model: &Model<'_, D>,
        (from, to): (f64, f64),
        (before, after): (&Controls, &Controls),
    ) -> Result<StepConditions<D>, AssemblyError> {
        let grid = model.grid(model.lowered(match self.method.geometry {
            Geometry::Moving => before,
            Geometry::Given => self.from,
        }));
        let conditions = model.conditions_on(grid, (before, after), (self.drag)(from, to))?;
        let conditions = match self.time {
            Some(integration) => (integration.on_ground)(before, after, conditions)?,
            None => conditions,
        };
        let durations = [after.time - before.time, after.last_step];
        let flow = |stage| flow::of_step((model.case, model.laws.len()), stage, durations);
        conditions
            .with_flow(self.flow.map(flow))?
            .with_unbalanced(self.held.as_ref().map(|forces| UnbalancedForces {
                forces: Arc::clone(forces),
                share: 1.0 - to,
            }))?
            .with_time(self.time.map(|integration| TimeStep {
                duration: after.time - before.time,
                scheme: integration.scheme,
                lumped: integration.lumped,
                is_first: from == 0.0,
                must_resolve: true,
            }))
    }
}

/// Adds the motion of the ground to the conditions between two controls.
pub(crate) type OnGround<'a, const D: usize> = dyn Fn(&Controls, &Controls, StepConditions<D>) -> Result<StepConditions<D>, AssemblyError>
    + 'a;

/// How a march that takes time integrates motion.
#[derive(Clone, Copy)]
pub(crate) struct TimeIntegration<'a, const D: usize> {
    pub(crate) scheme: TimeScheme,
    pub(crate) lumped: f64,
    /// The longest step that may begin at a load factor \[-\].
    pub(crate) longest_step: &'a dyn Fn(f64) -> f64,
    /// The conditions of a step between two controls with walls, motion of the ground and damping.
    pub(crate) on_ground: &'a OnGround<'a, D>,
}

/// How a march ended.
#[derive(Debug)]
pub(crate) enum StageEnd {
    /// At its end.
    Completed(EndReason),
    /// By its stage.
    Stopped(EndReason),
    /// By the user.
    Interrupted,
    /// For want of equilibrium.
    NotConverged(StepError),
}

/// A stage's answer after a step: a reason to stop, if it has one.
pub(crate) type StopRequest = Result<Option<EndReason>, CaseError>;

/// Marches a state along a path. `each` is called after every accepted step. The state ends with
/// the controls of its last equilibrium; the summary is kept up.
pub(crate) fn march_path<const D: usize>(
    session: &mut Session<'_, D>,
    state: &mut State<D>,
    path: &StagePath<'_, D>,
    stage: &mut StageSummary,
    each: &mut dyn FnMut(&mut Session<'_, D>, &StageSummary, &AcceptedStep<'_, D>) -> StopRequest,
) -> Result<StageEnd, CaseError> {
    let mut march = MarchState::start(&path.settings);
    if let Some(left) = path.left {
        march = left.march;
        session.last_resistance = left.resistance;
    }
    state.controls = path.at(march.at, &state.controls);
    if let Some(end) = path.left.and_then(|left| left.end.clone()) {
        stage.reached = march.at;
        return Ok(StageEnd::Stopped(end));
    }
    let mut workspace = session.workspace();
    let mut watch = Watch {
        session,
        stage,
        path,
        each,
        controls: &mut state.controls,
        reached: march.at,
        stopped: Ok(None),
    };
    let report = march_from(
        march,
        &mut state.body,
        &path.method,
        &path.settings,
        &mut workspace,
        &mut watch,
    );
    let (reached, stopped) = (watch.reached, watch.stopped);
    stage.reached = reached;
    let reason = stopped?;
    Ok(match (report.outcome, reason) {
        (Outcome::StepTooSmall { cause, .. }, _) => StageEnd::NotConverged(cause),
        (_, Some(Stop::Failed(error))) => StageEnd::NotConverged(*error),
        (_, Some(Stop::Stage(reason))) => StageEnd::Stopped(reason),
        (Outcome::Stopped { .. }, Some(Stop::User) | None) => StageEnd::Interrupted,
        (Outcome::Completed, _) => StageEnd::Completed(EndReason::ReachedItsEnd),
    })
}

enum Stop {
    Stage(EndReason),
    Failed(Box<StepError>),
    User,
}

/// Follows a march for its stage.
struct Watch<'w, 's, const D: usize> {
    session: &'w mut Session<'s, D>,
    stage: &'w mut StageSummary,
    path: &'w StagePath<'w, D>,
    each:
        &'w mut dyn FnMut(&mut Session<'_, D>, &StageSummary, &AcceptedStep<'_, D>) -> StopRequest,
    /// The controls of the last equilibrium.
    controls: &'w mut Controls,
    reached: f64,
    stopped: Result<Option<Stop>, CaseError>,
}

impl<const D: usize> Watch<'_, '_, D> {
    fn step(&mut self, accepted: &Accepted<'_, D>) -> Result<Option<Stop>, CaseError> {
        let report = accepted.report;
        self.reached = report.to;
        let number = self.stage.steps + 1;
        self.session.tell(&Event::Equilibrium { number, accepted });
        self.session.tally(self.stage, report)?;
        self.session.keep_system(accepted.conditions, self.stage);
        let model = self.session.model;
        if self.path.flow.is_some() && report.water.is_some() {
            let summary = self.stage.consolidation.get_or_insert_default();
            flow::tally(summary, model.case, report, &accepted.body.particles);
        }
        let mut controls = self.path.at(report.to, self.controls);
        controls.last_step = report.duration;
        controls = rigid::moved(model.case, controls, accepted);
        controls.walls = controls.walls_after(&accepted.forces.u);
        self.controls.clone_from(&controls);
        let grid = &accepted.conditions.grid;
        let taken = AcceptedStep {
            accepted,
            controls: &controls,
            resistance: model.footing_resistance(grid, &accepted.forces.reactions),
            interrupted: self.session.interrupted(),
        };
        self.session.last_resistance = taken.resistance;
        if self.path.to.settlement > self.path.from.settlement {
            let before = self.stage.peak_resistance.unwrap_or(taken.resistance);
            self.stage.peak_resistance = Some(before.max(taken.resistance));
        }
        if let Some((pair, by)) = rigid::meet(model.case, &controls, &accepted.body.rigid) {
            self.session.warn_once(&pair, &by);
        }
        let reason = (self.each)(self.session, self.stage, &taken)?;
        self.session.tell(&Event::Step {
            number: self.stage.steps,
            progress: report.to,
            report,
        });
        if let Some(failure) = rigid::too_deep(model.case, &controls, &accepted.body.rigid) {
            return Ok(Some(Stop::Failed(Box::new(StepError {
                from: report.from,
                to: report.to,
                residuals: report.residuals.clone(),
                worst: None,
                failure: Box::new(failure),
            }))));
        }
        Ok(match reason {
            Some(reason) => Some(Stop::Stage(reason)),
            // What was not saved as the last step is not left.
            None if taken.interrupted && report.to < 1.0 => Some(Stop::User),
            None => None,
        })
    }
}

impl<const D: usize> LoadPath<D> for Watch<'_, '_, D> {
    fn conditions(&self, from: f64, to: f64) -> Result<StepConditions<D>, AssemblyError> {
        let [before, after] = [from, to].map(|factor| self.path.at(factor, self.controls));
        (self.path).conditions(self.session.model, (from, to), (&before, &after))
    }

    fn longest_step(&self, at: f64) -> f64 {
        let time = &self.path.time;
        (time.as_ref()).map_or(f64::INFINITY, |time| (time.longest_step)(at))
    }
}

impl<const D: usize> Observer<D> for Watch<'_, '_, D> {
    fn on_step(&mut self, accepted: &Accepted<'_, D>) -> ControlFlow<()> {
        // A file that could not be written after a cut ends the march here.
        if self.stopped.is_ok() {
            self.stopped = self.step(accepted);
        }
        match self.stopped {
            Ok(None) => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        }
    }

    fn on_cut(&mut self, error: &StepError) {
        self.session.drop_system();
        let tally = self.session.tally_cut(self.stage, error);
        if let (Ok(_), Err(error)) = (&self.stopped, tally) {
            self.stopped = Err(error);
        }
    }
}
