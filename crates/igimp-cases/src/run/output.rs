//! The results folder of a run, and when it is written.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use igimp_model::{Case, Every, Stage, StageKind, in_plane};
use igimp_report::outlines::Outlines;
use igimp_report::patches::Pieces;
use igimp_report::pictures;
use igimp_report::report;
use igimp_report::viewer::Surroundings;
use igimp_results::atomic::write_whole;
use igimp_results::checkpoint;
use igimp_results::folder::provenance::Claim;
use igimp_results::folder::{self, Folder, write_summary};
use igimp_results::paraview::film::{self, Film};
use igimp_results::paraview::frames::{Frames, Scene};
use igimp_results::summary::{CheckRow, FigureNote, StageSummary, Summary};
use igimp_results::tables::rows::RowWriter;
use igimp_results::tables::table::Table;
use igimp_solver::Body;
use rayon::prelude::*;

use super::Target;
use super::model::Model;
use super::resume::readings::Readings;
use super::resume::{End, Notes, Resumption, Search};
use super::state::State;
use crate::error::CaseError;
use crate::run::output::moment::AcceptedStep;
use records::{Records, Rows};

pub(crate) mod checks;
mod drawn;
pub(crate) mod entry;
pub(crate) mod export;
mod in_time;
pub(crate) mod moment;
mod motion;
pub(crate) mod outlines;
mod readings;
pub(crate) mod records;
mod resume;
mod saved;
pub(crate) mod sections;
pub(crate) mod seepage;

/// The files of a run, open.
#[derive(Debug)]
pub(crate) struct Output<const D: usize> {
    folder: Folder,
    claim: Claim,
    /// Whether pictures are wanted.
    draws: bool,
    every: Every,
    report: bool,
    checkpoint_every: usize,
    checkpoint_keep: usize,
    curves: Vec<RowWriter>,
    monitors: Vec<RowWriter>,
    rigid: Vec<RowWriter>,
    /// Of a case with stages that take time.
    energy: Option<RowWriter>,
    convergence: RowWriter,
    frames: Frames,
    film: Film,
    figures: Vec<FigureNote>,
    /// Steps and trials of the whole run so far: the pseudo-time of frames and checkpoints.
    steps: usize,
    /// Factor of safety found last, if any.
    factor_of_safety: Option<f64>,
    /// By check: the peak of its quantity so far.
    peaks: Vec<f64>,
    /// States of a search that are kept beside the stages, by name.
    kept: Vec<(&'static str, End<D>)>,
    /// The bodies in pieces, once a picture wants them.
    pieces: Option<Arc<Pieces>>,
    /// The edges of the bodies in space, once a picture wants them.
    edges: Option<Arc<Outlines>>,
    seconds: f64,
    /// Warnings of a run that was taken up, to be printed and not kept: a resumed run leaves the files
    /// of one that was never stopped.
    pub(crate) notes_for_user: Vec<String>,
    /// Warnings of a run that began with a later stage, to be printed and kept.
    pub(crate) warnings: Vec<String>,
    /// The sources of tables, sections and checks.
    readings: Readings,
}

/// Names of the equilibria before those at the ends of a search, in a checkpoint.
const BEFORE: [&str; 2] = ["before-stable", "before-failed"];

/// Header of `convergence.csv`.
const CONVERGENCE: [&str; 7] = [
    "stage",
    "step",
    "from",
    "to",
    "iteration",
    "relative_out_of_balance",
    "accepted",
];

impl<const D: usize> Output<D> {
    /// A results folder for a run from the beginning.
    pub(crate) fn create(
        target: &Target,
        case: &Case<D>,
        records: &Records,
    ) -> Result<Self, CaseError> {
        let folder = Folder::afresh(&target.folder, &target.claim(case))?;
        write_whole(&folder.case(), &target.source)?;
        write_whole(&folder.completed_case(), &target.completed)?;
        Self::open(folder, target.claim(case), case, records, None)
    }

    /// Opens the files anew, or after the rows that a checkpoint tells of.
    fn open(
        folder: Folder,
        claim: Claim,
        case: &Case<D>,
        records: &Records,
        notes: Option<&Notes>,
    ) -> Result<Self, CaseError> {
        let [curves, monitors, rigid] = growing(&folder, records, notes);
        let [curves, monitors, rigid] = [open_all(curves)?, open_all(monitors)?, open_all(rigid)?];
        let moves = |stage: &Stage| matches!(stage.kind, StageKind::Dynamic(_));
        let energy = case.stages.iter().any(moves).then(|| {
            let rows = notes.map_or(0, |notes| notes.energy_rows);
            RowWriter::resume(&folder.energy(), &records.energy.header, rows)
        });
        let convergence = RowWriter::resume(
            &folder.convergence(),
            &CONVERGENCE.map(str::to_owned),
            notes.map_or(0, |notes| notes.convergence_rows),
        )?;
        let frames = Frames::open(
            &folder.paraview(),
            notes.map_or(0, |notes| notes.frames),
            case,
        )?;
        let mut readings = readings::of_case(case, records);
        if let Some(notes) = notes {
            readings.checks.clone_from(&notes.readings.checks);
            for (name, reading) in &mut readings.tables {
                let before = notes.readings.tables.get(name);
                reading.since = before.map_or(0, |before| before.since);
            }
        }
        Ok(Self {
            folder,
            claim,
            draws: !case.output.figures.is_empty(),
            every: case.output.paraview,
            report: case.output.report,
            checkpoint_every: case.output.checkpoint_every,
            checkpoint_keep: case.output.checkpoint_keep,
            curves,
            monitors,
            rigid,
            energy: energy.transpose()?,
            convergence,
            frames,
            film: notes.map_or_else(Film::default, |notes| notes.film),
            figures: notes.map_or_else(Vec::new, |notes| notes.figures.clone()),
            steps: notes.map_or(0, |notes| notes.steps),
            factor_of_safety: notes.and_then(|notes| notes.factor_of_safety),
            peaks: records.peaks.clone(),
            kept: Vec::new(),
            pieces: None,
            edges: None,
            seconds: 0.0,
            notes_for_user: Vec::new(),
            warnings: Vec::new(),
            readings,
        })
    }

    /// Notes the sources of the checks at the end of a stage.
    pub(crate) fn note_readings(
        &mut self,
        case: &Case<D>,
        records: &Records,
        stage: usize,
        of_sections: &[(usize, CheckRow)],
    ) {
        let rows = readings::of_rows(case, records, stage, of_sections);
        self.readings.checks.extend(rows);
    }

    /// By curve, the first stage whose rows it has.
    pub(crate) fn curves_since(&self, case: &Case<D>) -> Vec<usize> {
        readings::curves_since(case, &self.readings)
    }

    /// Appends the rows of a moment.
    pub(crate) fn write_rows(&mut self, rows: &Rows) -> Result<(), CaseError> {
        let clock = Instant::now();
        self.peaks.clone_from(&rows.peaks);
        for (writer, row) in self.curves.iter_mut().zip(&rows.curves) {
            if let Some(row) = row {
                writer.push(row)?;
            }
        }
        for (writer, row) in self.monitors.iter_mut().zip(&rows.monitors) {
            writer.push(row)?;
        }
        for (writer, row) in self.rigid.iter_mut().zip(&rows.rigid) {
            if let Some(row) = row {
                writer.push(row)?;
            }
        }
        if let (Some(writer), Some(row)) = (&mut self.energy, &rows.energy) {
            writer.push(row)?;
        }
        self.seconds += clock.elapsed().as_secs_f64();
        Ok(())
    }

    /// Appends the residuals of a step.
    pub(crate) fn write_convergence(
        &mut self,
        (stage, step): (&str, usize),
        (from, to, residuals): (f64, f64, &[f64]),
        accepted: bool,
    ) -> Result<(), CaseError> {
        let clock = Instant::now();
        for (iteration, residual) in residuals.iter().enumerate() {
            self.convergence.push_text(&[
                stage.to_owned(),
                step.to_string(),
                format!("{from:.9e}"),
                format!("{to:.9e}"),
                iteration.to_string(),
                format!("{residual:.9e}"),
                u8::from(accepted).to_string(),
            ])?;
        }
        self.seconds += clock.elapsed().as_secs_f64();
        Ok(())
    }

    /// After a step of a march: a frame and a checkpoint, when they are due; the checkpoint also
    /// when the user interrupts the run.
    pub(crate) fn after_step(
        &mut self,
        stage: usize,
        model: &Model<'_, D>,
        summary: &StageSummary,
        taken: &AcceptedStep<'_, D>,
        resumption: &Resumption,
        run: &Summary,
    ) -> Result<(), CaseError> {
        let clock = Instant::now();
        self.frame_of_step(stage, model, summary, taken)?;
        let body = taken.accepted.body;
        let due = self.checkpoint_every > 0 && summary.steps.is_multiple_of(self.checkpoint_every);
        if due || taken.interrupted {
            let notes = Notes {
                stage: Some(summary.clone()),
                resumption: Some(resumption.clone()),
                ..self.notes(model.case, stage, run, taken.controls)
            };
            self.save(&[("current", body)], &notes)?;
        }
        self.seconds += clock.elapsed().as_secs_f64();
        Ok(())
    }

    /// Counts a step, and writes a frame when one is due: all that there is to write after a step that no march goes on from.
    pub(crate) fn frame_of_step(
        &mut self,
        number: usize,
        model: &Model<'_, D>,
        summary: &StageSummary,
        taken: &AcceptedStep<'_, D>,
    ) -> Result<(), CaseError> {
        self.steps += 1;
        let stage = &model.case.stages[number];
        let (body, conditions) = (taken.accepted.body, &taken.accepted.conditions);
        let nodes = conditions.grid.node_count();
        let step = film::Step {
            number: summary.steps,
            particles: body.particles.len(),
            report: taken.accepted.report,
            u: &taken.accepted.forces.u[..nodes],
        };
        if self.film.has_frame(self.every, stage, &step) {
            let scene = Scene {
                particles: &body.particles,
                laws: &conditions.laws,
                structures: &outlines::structures(model.case, taken.controls, body),
            };
            let time = (self.steps as f64, taken.controls.time);
            self.frames
                .add(time, (number, &stage.name), &scene, &conditions.grid)?;
        }
        Ok(())
    }

    /// After a trial of a search that began with `found`: a checkpoint.
    pub(crate) fn after_trial(
        &mut self,
        stage: usize,
        case: &Case<D>,
        summary: &StageSummary,
        found: &State<D>,
        search: &Search<D>,
        run: &Summary,
    ) -> Result<(), CaseError> {
        let clock = Instant::now();
        self.steps += 1;
        let controls_of = |end: &Option<End<D>>| {
            end.as_ref()
                .map(|end| (end.srf, end.state.controls.clone()))
        };
        let notes = Notes {
            stage: Some(summary.clone()),
            trials: Some(search.trials.clone()),
            stable: controls_of(&search.stable),
            failed: controls_of(&search.failed),
            ..self.notes(case, stage, run, &found.controls)
        };
        let mut states: Vec<(&str, &Body<D>)> = vec![("current", &found.body)];
        for (name, before, end) in [
            ("stable", BEFORE[0], &search.stable),
            ("failed", BEFORE[1], &search.failed),
        ] {
            if let Some(end) = end {
                states.push((name, &end.state.body));
                states.extend(end.before.as_deref().map(|body| (before, body)));
            }
        }
        self.save(&states, &notes)?;
        self.seconds += clock.elapsed().as_secs_f64();
        Ok(())
    }

    /// Keeps the ends of a search, to be written at the end of its stage.
    pub(crate) fn keep_ends(&mut self, stable: Option<End<D>>, failed: Option<End<D>>) {
        let named = [("last-stable", stable), ("first-unstable", failed)];
        let there = named
            .into_iter()
            .filter_map(|(name, end)| Some((name, end?)));
        self.kept = there.collect();
    }

    /// Sections, pictures and a frame of the state at the end of a stage.
    pub(crate) fn end_of_stage(
        &mut self,
        model: &Model<'_, D>,
        number: usize,
        state: &State<D>,
        summary: &StageSummary,
        sections: &[Table],
    ) -> Result<(), CaseError> {
        let clock = Instant::now();
        let case = model.case;
        for table in sections {
            table.write_csv(&self.folder.sections())?;
        }
        let structures = outlines::structures(case, &state.controls, &state.body);
        if summary.safety.is_none() {
            for table in sections::planes(model, state, number)? {
                table.write_csv(&self.folder.sections())?;
            }
            let named = |name: &str| format!("{name}__{}", sections::stage_name(case, number));
            for body in &structures.rigid {
                let table = body.table(named(&body.part.name), case.is_whole());
                table.write_csv(&self.folder.rigid())?;
            }
            for member in &structures.reinforcement {
                let table = member.table(named(&member.part.name));
                table.write_csv(&self.folder.reinforcement())?;
            }
        }
        // The last step of a motion may have left the frame of its end.
        if self.every != Every::Never && !self.frames.is_at(number, state.controls.time) {
            let grid = model.grid(model.lowered(&state.controls))?;
            let scene = Scene {
                particles: &state.body.particles,
                laws: &model.laws_reduced_by(&state.controls.srf)?,
                structures: &structures,
            };
            // The time of a frame is the number of steps and trials so far.
            let time = (self.steps as f64, state.controls.time);
            self.frames
                .add(time, (number, &summary.name), &scene, &grid)?;
        }
        if let Some(safety) = &summary.safety {
            self.factor_of_safety = safety.factor();
            if self.draws {
                let (root, title) = (self.folder.root(), &case.title);
                let picture = pictures::safety_picture(root, title, &summary.name, safety)?;
                self.figures.push(picture);
            }
        }
        self.ends_of_search(model, number, summary)?;
        if summary.safety.is_none() {
            self.field_pictures(model, &motion::shown(case, number, state), state, &[])?;
        }
        let (root, title) = (self.folder.root(), &case.title);
        if self.draws {
            let drawn = case
                .sections
                .par_iter()
                .zip(sections)
                .map(|(section, table)| {
                    let references = section.references_at(case, number);
                    let stage = &summary.name;
                    let of = (title.as_str(), pictures::axes_of(case));
                    pictures::section_pictures(root, of, section, stage, &references, table)
                })
                .collect::<Result<Vec<_>, _>>()?;
            self.figures.extend(drawn.concat());
        }
        self.seconds += clock.elapsed().as_secs_f64();
        Ok(())
    }

    /// The checkpoint at the end of a stage, which stays.
    pub(crate) fn after_stage(
        &mut self,
        number: usize,
        case: &Case<D>,
        state: &State<D>,
        run: &Summary,
    ) -> Result<(), CaseError> {
        let clock = Instant::now();
        let notes = self.notes(case, number, run, &state.controls);
        self.save_end(number, &state.body, &notes)?;
        // Until its end a run is one that can be resumed: it may be killed.
        let so_far = Summary {
            interrupted: true,
            ..run.clone()
        };
        self.write_summary(&so_far)?;
        self.seconds += clock.elapsed().as_secs_f64();
        Ok(())
    }

    /// The last equilibrium of a stage that found no further one, for whoever wants to look.
    pub(crate) fn keep_last_converged(
        &mut self,
        case: &Case<D>,
        number: usize,
        state: &State<D>,
        run: &Summary,
    ) -> Result<Vec<PathBuf>, CaseError> {
        let clock = Instant::now();
        let notes = self.notes(case, number, run, &state.controls);
        let folder = self.folder.root().to_path_buf();
        let states = [("current", &state.body)];
        let meta = self.meta(&notes, &states)?;
        let saved = checkpoint::write(&folder, "last-converged", &states, &meta, 1)?;
        self.seconds += clock.elapsed().as_secs_f64();
        let mut saved = vec![saved, self.folder.convergence()];
        if self.report {
            saved.push(self.folder.report());
        }
        Ok(saved)
    }

    /// Pictures of curves, summary and report.
    pub(crate) fn finish(
        &mut self,
        case: &Case<D>,
        records: &Records,
        summary: &mut Summary,
        begun: Instant,
    ) -> Result<(), CaseError> {
        let clock = Instant::now();
        let mut figures = std::mem::take(&mut self.figures);
        let at = figures.len().min(1);
        let (root, title) = (self.folder.root(), &case.title);
        let tolerance = Some(case.solver.tolerance);
        if self.draws {
            let (histories, convergence) = rayon::join(
                || histories(root, case, records),
                || pictures::convergence_pictures(root, title, tolerance),
            );
            let energy = self.energy_pictures(case, records)?;
            figures.splice(at..at, histories?.into_iter().chain(energy));
            figures.extend(convergence?);
        }
        let in_time = self.safety_in_time(case, summary)?;
        figures.splice(at.min(figures.len())..at.min(figures.len()), in_time);
        summary.figures = figures;
        self.seconds += clock.elapsed().as_secs_f64();
        summary.seconds = begun.elapsed().as_secs_f64();
        summary.output_seconds = self.seconds;
        self.write_summary(summary)?;
        if self.report {
            let pieces = in_plane(case).and_then(|case| self.pieces(case).ok());
            let root = self.folder.root();
            report::write_report(root, &Surroundings::of(case, root, pieces))?;
        }
        if !summary.interrupted {
            folder::mark(self.folder.root(), &self.claim, true)?;
        }
        Ok(())
    }

    fn write_summary(&self, summary: &Summary) -> Result<(), CaseError> {
        Ok(write_summary(self.folder.root(), summary)?)
    }
}

/// A table that grows: its file, its header, and the rows that are kept of it.
type Growing<'r> = (PathBuf, &'r [String], usize);

/// The tables of curves, monitors and rigid bodies, with the rows that a checkpoint tells of.
fn growing<'r>(
    folder: &Folder,
    records: &'r Records,
    notes: Option<&Notes>,
) -> [Vec<Growing<'r>>; 3] {
    let none = Vec::new();
    let of = |of: fn(&Notes) -> &Vec<usize>| notes.map_or(&none, of);
    [
        (&records.curves, folder.curves(), of(|old| &old.curve_rows)),
        (
            &records.monitors,
            folder.monitors(),
            of(|old| &old.monitor_rows),
        ),
        (&records.rigid, folder.rigid(), of(|old| &old.rigid_rows)),
    ]
    .map(|(tables, folder, rows)| {
        let tables = tables.iter().enumerate();
        let table = |(k, table): (usize, &'r Table)| {
            let rows = rows.get(k).copied().unwrap_or(0);
            (folder.join(csv(&table.name)), &table.header[..], rows)
        };
        tables.map(table).collect()
    })
}

fn open_all(tables: Vec<Growing<'_>>) -> Result<Vec<RowWriter>, CaseError> {
    let opened = tables
        .into_iter()
        .map(|(path, header, rows)| Ok(RowWriter::resume(&path, header, rows)?));
    opened.collect()
}

/// The pictures of curves and monitors.
fn histories<const D: usize>(
    root: &Path,
    case: &Case<D>,
    records: &Records,
) -> Result<Vec<FigureNote>, CaseError> {
    let title = &case.title;
    let curves = (&case.curves, &records.curves)
        .into_par_iter()
        .map(|(curve, table)| {
            Ok(vec![pictures::curve_picture(
                root,
                title,
                curve,
                &table.as_written(),
            )?])
        });
    let monitors = (&case.monitors, &records.monitors)
        .into_par_iter()
        .map(|(monitor, table)| {
            pictures::monitor_pictures(root, case, monitor, &table.as_written())
        });
    let drawn = curves.chain(monitors).collect::<Result<Vec<_>, _>>()?;
    Ok(drawn.concat())
}

/// File of a table.
fn csv(name: &str) -> String {
    format!("{name}.csv")
}
