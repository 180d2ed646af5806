//! The stages of a case, one after the other.

use std::collections::HashMap;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use igimp_model::{COMPONENTS, Case, StageKind};
use igimp_report::setup;
use igimp_results::checkpoint::sha256;
use igimp_results::ending::EndReason;
use igimp_results::folder::{clear_meshes, refuse_foreign};
use igimp_results::summary::{StageOutcome, StageSummary, Summary};
use igimp_results::tables::table::Table;
use igimp_solver::StepError;

use super::model::Model;
use super::output::export::Export;
use super::output::moment::{Moment, largest_displacement};
use super::output::records::Records;
use super::output::seepage;
use super::output::{Output, checks, sections};
use super::resume::{ResumePoint, Resumption, Search};
use super::session::{Session, StageEnd};
use super::stages::{construction, dynamic, fallen, initial, loading, run_out, safety, stilled};
use super::state::State;
use super::water::pores;
use super::{Event, Failure, Listener, Run, Start, Target, failure, reinforcement};
use crate::error::CaseError;
use igimp_estimate::Expectation;
use igimp_estimate::resources::memory::{self, Before};
use igimp_estimate::resources::processor;
use igimp_estimate::time::time_of_steps_taken;

/// Runs a case on its own grid.
pub(super) fn one_mesh<const D: usize>(
    case: &Case<D>,
    target: Option<&Target>,
    start: Start,
    listener: &mut dyn Listener<D>,
    interrupt: &AtomicBool,
) -> Result<Run<D>, CaseError> {
    let clock = Instant::now();
    let before = Before::now();
    if case.stages.is_empty() {
        return Err(CaseError::NoStages);
    }
    let (model, initial) = Model::new(case)?;
    let all = (model.later.as_ref()).map(|later| initial.body.particles.joined_by(later));
    let records = Records::new(
        case,
        &model.laws,
        all.as_ref().unwrap_or(&initial.body.particles),
    )?
    .with_discharges(seepage::by_condition(&model));
    let mut session = Session {
        model: &model,
        listener,
        interrupt,
        records,
        output: None,
        export: None,
        summary: Summary {
            program: format!("igimp {}", env!("CARGO_PKG_VERSION")),
            title: case.title.clone(),
            title_block: case.title_block.clone(),
            date: target.and_then(|target| target.date.clone()),
            input_sha256: target.map(|target| sha256(target.completed.as_bytes())),
            setup: [setup::tables(case), seepage::tables(&model)].concat(),
            method: case.method.label(),
            size: model.size(&initial.body),
            ..Summary::default()
        },
        last_resistance: 0.0,
        ends: HashMap::new(),
        warned_of_memory: false,
    };
    let mut stages = Stages::begin(&mut session, target, start, before)?;
    let size = session.summary.size;
    session.tell(&Event::Prepared { size: &size });
    stages.run(&mut session, &initial)?;
    stages.finish(session, initial, clock)
}

/// The stages of a run, one after another.
struct Stages<const D: usize> {
    before: Before,
    expectation: Option<Expectation>,
    first: usize,
    left: Option<ResumePoint<D>>,
    state: Option<State<D>>,
    sections: Vec<Table>,
    failure: Option<Failure>,
}

impl<const D: usize> Stages<D> {
    /// Opens the results folder and finds where the run begins.
    fn begin(
        session: &mut Session<'_, D>,
        target: Option<&Target>,
        start: Start,
        before: Before,
    ) -> Result<Self, CaseError> {
        let mut stages = Self {
            before,
            expectation: target.and_then(|target| target.expectation.clone()),
            first: 0,
            left: None,
            state: None,
            sections: Vec::new(),
            failure: None,
        };
        let case = session.model.case;
        let Some(target) = target else {
            for text in pores::dilatant(case) {
                session.warn(text);
            }
            return Ok(stages);
        };
        if let Some(systems) = &target.systems {
            refuse_foreign(systems)?;
        }
        let (mut output, left) = match start {
            Start::Afresh => {
                let output = Output::create(target, case, &session.records)?;
                clear_meshes(&target.folder)?;
                (output, None)
            }
            Start::Resume => Output::resume(target, case, &mut session.records)?,
            Start::FromStage(stage) => {
                Output::from_stage(target, case, &mut session.records, stage)?
            }
        };
        if let Some(left) = left {
            session.summary.stages.clone_from(&left.stages);
            session.summary.checks.clone_from(&left.checks);
            session.summary.warnings.clone_from(&left.warnings);
            session.summary.size.unknowns = left.unknowns;
            session.ends = output.ends(case, &session.records, left.stages.len())?;
            stages.first = left.stages.len();
            stages.state = Some(left.state.clone());
            stages.left = Some(left);
        } else {
            output.model_picture(case)?;
            output.seepage(session.model)?;
            for text in pores::dilatant(case) {
                session.warn(text);
            }
        }
        for text in &target.warnings {
            if !session.summary.warnings.contains(text) {
                session.summary.warnings.push(text.clone());
            }
        }
        for text in std::mem::take(&mut output.notes_for_user) {
            session.tell(&Event::Warning { text: &text });
        }
        for text in std::mem::take(&mut output.warnings) {
            session.warn(text);
        }
        session.output = Some(output);
        if let Some(systems) = &target.systems {
            session.export = Some(Export::open(systems, stages.first)?);
        }
        Ok(stages)
    }

    /// Runs the stages from the first that is not done.
    fn run(&mut self, session: &mut Session<'_, D>, initial: &State<D>) -> Result<(), CaseError> {
        let case = session.model.case;
        for number in self.first..case.stages.len() {
            if session.interrupted() {
                session.summary.interrupted = true;
                break;
            }
            let stage = &case.stages[number];
            if let Some(summary) = fallen::passed_over(session, number) {
                Self::pass_over(session, number, summary);
                continue;
            }
            let left = self.left.take().filter(|left| left.stage.is_some());
            let begun = || match stage.start_from {
                None => Ok(initial.clone()),
                Some(from) => {
                    let end = session.ends.get(&from).cloned();
                    end.ok_or_else(|| CaseError::NoStart {
                        stage: stage.name.clone(),
                        from: case.stages[from].name.clone(),
                    })
                }
            };
            let (start, mut state) = match &left {
                None => (None, begun()?),
                Some(left) => {
                    // What construction lets go follows from what it began with.
                    let is_built = matches!(stage.kind, StageKind::Construction(_));
                    let is_wanted = is_built && left.resumption.is_some();
                    let start = is_wanted.then(begun).transpose()?;
                    (start, left.state.clone())
                }
            };
            let ended = self.stage(session, number, (start.as_ref(), &mut state), left)?;
            self.state = Some(state);
            if !ended {
                break;
            }
        }
        Ok(())
    }

    /// Writes down a stage that is not run, and goes on with the body that it would have begun with.
    fn pass_over(session: &mut Session<'_, D>, number: usize, summary: StageSummary) {
        let case = session.model.case;
        let stage = &case.stages[number];
        session.tell(&Event::StageStarted {
            stage: number,
            of: case.stages.len(),
            name: &stage.name,
            kind: stage.kind.name(),
            steps: stage.steps,
        });
        session.tell(&Event::StageEnded { summary: &summary });
        let begun = stage.start_from.and_then(|from| session.ends.get(&from));
        if let Some(state) = begun.cloned() {
            session.ends.insert(number, state);
        }
        let rows = checks::beyond(case, &session.records, number);
        session.summary.checks.extend(rows);
        session.summary.stages.push(summary);
    }

    /// Runs one stage to its end; whether the next may follow.
    fn stage(
        &mut self,
        session: &mut Session<'_, D>,
        number: usize,
        (start, state): (Option<&State<D>>, &mut State<D>),
        left: Option<ResumePoint<D>>,
    ) -> Result<bool, CaseError> {
        let clock = Instant::now();
        let stage = &session.model.case.stages[number];
        session.tell(&Event::StageStarted {
            stage: number,
            of: session.model.case.stages.len(),
            name: &stage.name,
            kind: stage.kind.name(),
            steps: stage.steps,
        });
        let (mut summary, resumption, search) = match left {
            Some(left) => (left.stage.unwrap_or_default(), left.resumption, left.search),
            None => (new_summary(&stage.name, stage.kind.name()), None, None),
        };
        let seconds_before = summary.seconds;
        let ended = dispatch(
            session,
            number,
            (start, state),
            &mut summary,
            resumption.as_ref(),
            search,
        )?;
        if let Some(export) = &mut session.export {
            export.end_of_stage(number)?;
        }
        summary.seconds = seconds_before + clock.elapsed().as_secs_f64();
        summary.reinforcement = reinforcement::summaries(session.model.case, state);
        // A search leaves the body as it was found.
        let leaves_body = summary.safety.is_some();
        let largest = (!leaves_body).then(|| largest_displacement(&state.body.particles));
        summary.largest_displacement = largest.unwrap_or(f64::NAN);
        if let StageKind::Displacement { .. } = stage.kind {
            summary.settlement = Some(state.controls.settlement);
        }
        let (outcome, reason, step_error) = match ended {
            StageEnd::Completed(reason) => (StageOutcome::Completed, reason, None),
            StageEnd::Stopped(reason) => (StageOutcome::Stopped, reason, None),
            StageEnd::Interrupted => (StageOutcome::Interrupted, EndReason::Interrupted, None),
            StageEnd::NotConverged(error)
                if error.failure.is_want_of_equilibrium()
                    && !failure::is_without_hold(&error.failure, &summary)
                    && (stage.stop_when.no_equilibrium
                        || crate::fallen::is_answered(session.model.case, number)) =>
            {
                if crate::fallen::is_answered(session.model.case, number) {
                    session.warn_of_stage(number, &fallen::remark(&summary));
                }
                let failure = &error.failure;
                summary.lost = failure::tells_no_limit(&stage.kind, failure, &summary);
                let reason = EndReason::NoEquilibrium {
                    beyond: Some(summary.reached),
                    cause: failure.to_string(),
                };
                (StageOutcome::Stopped, reason, None)
            }
            StageEnd::NotConverged(error) => {
                let cause = error.failure.to_string();
                let reason = if error.failure.is_want_of_equilibrium() {
                    EndReason::NoEquilibrium {
                        beyond: None,
                        cause,
                    }
                } else {
                    EndReason::StepFailed { cause }
                };
                (StageOutcome::NotConverged, reason, Some(error))
            }
        };
        summary.outcome = outcome;
        summary.reason = reason.to_string();
        if let Some(strength) = run_out::remark(session, number) {
            summary.reason = format!("{}; {strength}", summary.reason);
        }
        reason.code().clone_into(&mut summary.code);
        self.close(session, number, state, summary, step_error)
    }

    /// Writes down how a stage ended; whether the next may follow.
    fn close(
        &mut self,
        session: &mut Session<'_, D>,
        number: usize,
        state: &mut State<D>,
        mut summary: StageSummary,
        step_error: Option<StepError>,
    ) -> Result<bool, CaseError> {
        let case = session.model.case;
        let stage = &case.stages[number];
        // A search leaves the body as it was found.
        if summary.safety.is_none() && summary.outcome != StageOutcome::Interrupted {
            summary.pore_water = pores::summary(case, &state.body.particles);
            let water = summary.pore_water.as_ref();
            if let Some(text) = water.and_then(|water| pores::remark(&stage.name, water)) {
                session.warn(text);
            }
        }
        if let Some(error) = step_error {
            let failure = failure::describe(session, number, state, &summary, error);
            if failure.is_collapse() {
                let cause = failure::COLLAPSE.to_owned();
                let beyond = None;
                summary.reason = EndReason::NoEquilibrium { beyond, cause }.to_string();
            }
            self.failure = Some(failure);
        }
        let goes_on = matches!(
            summary.outcome,
            StageOutcome::Completed | StageOutcome::Stopped
        );
        if summary.outcome == StageOutcome::Interrupted {
            session.summary.interrupted = true;
        } else {
            self.read(session, number, state, &summary)?;
        }
        if goes_on && let Some(text) = reinforcement::locked_early(case, state) {
            session.warn_of_stage(number, &text);
        }
        // What a jack held is locked off.
        for member in &mut state.controls.reinforcement {
            member.jack = None;
        }
        session.tell(&Event::StageEnded { summary: &summary });
        session.summary.stages.push(summary);
        if goes_on && stage.reset_displacements {
            state.body.particles.reset_displacements();
            for body in &mut state.controls.rigid {
                body.track.displacement = [0.0; COMPONENTS];
            }
        }
        if goes_on {
            session.ends.insert(number, state.clone());
            if let Some(output) = &mut session.output {
                output.after_stage(number, case, state, &session.summary)?;
            }
        } else if let (Some(output), Some(failure)) = (&mut session.output, &mut self.failure) {
            failure.saved = output.keep_last_converged(case, number, state, &session.summary)?;
        }
        Ok(goes_on)
    }

    /// Sections, checks, pictures and frames of the state at the end of a stage.
    fn read(
        &mut self,
        session: &mut Session<'_, D>,
        number: usize,
        state: &State<D>,
        summary: &StageSummary,
    ) -> Result<(), CaseError> {
        let case = session.model.case;
        // A search leaves the body as it was found: there is nothing new to see along sections.
        let tables = match case.stages[number].kind {
            StageKind::StrengthReduction(_) => Vec::new(),
            _ => sections::read(session.model, state, number)?,
        };
        let resistance = session.last_resistance;
        let model = session.model;
        let moment = Moment {
            stage: number,
            number: summary.steps,
            progress: summary.reached,
            grid: &model.grid(model.lowered(&state.controls))?,
            particles: &state.body.particles,
            rigid: &state.body.rigid,
            reinforcement: &state.body.reinforcement,
            controls: &state.controls,
            resistance,
            plastic_share: summary.plastic_share,
            energy: None,
        };
        let is_reached = checks::is_reached(summary);
        let rows = checks::at_end_of_stage(case, &session.records, &moment, is_reached);
        session.summary.checks.extend(rows);
        let rows = checks::of_sections(case, number, &tables, is_reached);
        if let Some(output) = &mut session.output {
            output.note_readings(case, &session.records, number, &rows);
        }
        let rows = rows.into_iter().map(|(_, row)| row);
        session.summary.checks.extend(rows);
        if let Some(output) = &mut session.output {
            output.end_of_stage(session.model, number, state, summary, &tables)?;
        }
        self.sections.extend(tables);
        Ok(())
    }

    /// Checks of curves, summary, pictures of curves, report.
    fn finish(
        self,
        mut session: Session<'_, D>,
        initial: State<D>,
        clock: Instant,
    ) -> Result<Run<D>, CaseError> {
        let case = session.model.case;
        if !session.summary.interrupted {
            let since = session.output.as_ref();
            let since = since.map_or_else(Vec::new, |output| output.curves_since(case));
            let (tables, stages) = (&session.records.curves, &session.summary.stages);
            let of_curves = checks::of_curves(case, tables, stages, &since);
            for stage in session.summary.stages.len()..case.stages.len() {
                let rows = checks::beyond(case, &session.records, stage);
                session.summary.checks.extend(rows);
            }
            session.summary.checks.extend(of_curves);
        }
        let peak = memory::peak_mib();
        session.summary.peak_memory_mib = peak;
        session.summary.cpu_seconds = processor::seconds();
        if let Some(expectation) = &self.expectation
            && let [size] = &expectation.sizes[..]
        {
            session.summary.memory = self.before.share(peak, size);
            let stages = &session.summary.stages;
            let taken = time_of_steps_taken(case, size, expectation.speed, stages);
            session.summary.estimate = Some(expectation.expected(Some(taken)));
        }
        let passed_over = || {
            let mut stages = session.summary.stages.iter();
            let stage = stages.find(|stage| stage.outcome == StageOutcome::NotConverged)?;
            Some(format!("stage \"{}\": {}", stage.name, stage.reason))
        };
        let failure = self.failure.as_ref().map(ToString::to_string);
        session.summary.failure = failure.or_else(passed_over);
        if let Some(output) = &mut session.output {
            output.finish(case, &session.records, &mut session.summary, clock)?;
        } else {
            session.summary.seconds = clock.elapsed().as_secs_f64();
        }
        Ok(Run {
            summary: session.summary,
            curves: session.records.curves,
            monitors: session.records.monitors,
            sections: self.sections,
            body: self.state.map_or_else(|| initial.body, |state| state.body),
            failure: self.failure,
            lost: Vec::new(),
        })
    }
}

/// Runs a stage by its kind.
fn dispatch<const D: usize>(
    session: &mut Session<'_, D>,
    number: usize,
    (start, state): (Option<&State<D>>, &mut State<D>),
    summary: &mut StageSummary,
    resumption: Option<&Resumption>,
    search: Option<Search<D>>,
) -> Result<StageEnd, CaseError> {
    let stage = &session.model.case.stages[number];
    if resumption.is_none() {
        stilled::still(session, number, state);
    }
    match &stage.kind {
        StageKind::K0 if resumption.is_none() => {
            initial::level_ground(session.model, state)?;
            loading::load(session, state, number, summary, None)
        }
        StageKind::Gravity { .. }
        | StageKind::K0
        | StageKind::Load { .. }
        | StageKind::Displacement { .. }
        | StageKind::Wait
        | StageKind::Rigid(_) => loading::load(session, state, number, summary, resumption),
        StageKind::StrengthReduction(reduction) => {
            match fallen::anew(session, number, reduction, state) {
                None => safety::reduce_strength(session, state, number, reduction, summary, search),
                Some((reduction, found)) => {
                    let ended = safety::reduce_strength(
                        session, &found, number, &reduction, summary, search,
                    );
                    let found = summary.safety.as_ref().and_then(fallen::stands_after_all);
                    if let Some(text) = found {
                        session.warn_of_stage(number, &text);
                    }
                    ended
                }
            }
        }
        StageKind::Construction(_) => {
            construction::build(session, (start, state), number, summary, resumption)
        }
        StageKind::RunOut(spec) => {
            run_out::run_out(session, state, number, spec, summary, resumption)
        }
        StageKind::Dynamic(spec) => {
            if let (Some(output), None) = (&mut session.output, resumption) {
                output.begin_motion(session.model, number, state)?;
            }
            dynamic::dynamic(session, state, number, spec, summary, resumption)
        }
    }
}

fn new_summary(name: &str, kind: &str) -> StageSummary {
    StageSummary {
        name: name.to_owned(),
        kind: kind.to_owned(),
        ..StageSummary::default()
    }
}
