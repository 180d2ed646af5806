//! The results folder of a run: what is written, and when.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use igimp_assembly::SharedLaw;
use igimp_solver::Body;
use rayon::prelude::*;

use super::Target;
use super::fingerprint;
use super::left::{End, Notes, Resumption, Search, end_of_stage};
use super::model::Model;
use super::outlines;
use super::records::{Records, Rows};
use super::saved_body;
use super::saved_reinforcement;
use super::sections;
use super::session::Taken;
use super::state::{Controls, State};
use crate::case::{Case, Every};
use crate::error::CaseError;
use crate::pieces::Pieces;
use crate::plane::in_plane;
use crate::results::atomic::write_whole;
use crate::results::checkpoint::{self, Meta};
use crate::results::folder::{self, Folder, write_summary};
use crate::results::frames::Frames;
use crate::results::owner::Claim;
use crate::results::pictures::{self, Canvas, Failing, Seen, Shown, mechanism};
use crate::results::report;
use crate::results::rigid;
use crate::results::rows::RowWriter;
use crate::summary::{FigureNote, StageSummary, Summary};
use crate::table::Table;

mod take_up;

/// The files of a run, open.
#[derive(Debug)]
pub(crate) struct Output<const D: usize = 2> {
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
    convergence: RowWriter,
    frames: Frames,
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
    seconds: f64,
    /// What was found when the run was taken up, to be told and not kept: a resumed run leaves the files
    /// of one that was never stopped.
    pub(crate) notes_for_user: Vec<String>,
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
        let open = |path: PathBuf, header: &[String], rows: usize| match rows {
            0 => RowWriter::create(&path, header),
            rows => RowWriter::resume(&path, header, rows),
        };
        let rows = |of: fn(&Notes) -> &Vec<usize>, k: usize| {
            notes
                .and_then(|notes| of(notes).get(k).copied())
                .unwrap_or(0)
        };
        let curves = std::iter::zip(&records.curves, 0..)
            .map(|(table, k)| {
                let path = folder.curves().join(csv(&table.name));
                open(path, &table.header, rows(|notes| &notes.curve_rows, k))
            })
            .collect::<Result<_, _>>()?;
        let monitors = std::iter::zip(&records.monitors, 0..)
            .map(|(table, k)| {
                let path = folder.monitors().join(csv(&table.name));
                open(path, &table.header, rows(|notes| &notes.monitor_rows, k))
            })
            .collect::<Result<_, _>>()?;
        let rigid = std::iter::zip(&records.rigid, 0..)
            .map(|(table, k)| {
                let path = folder.rigid().join(csv(&table.name));
                open(path, &table.header, rows(|notes| &notes.rigid_rows, k))
            })
            .collect::<Result<_, _>>()?;
        let convergence = open(
            folder.convergence(),
            &CONVERGENCE.map(str::to_owned),
            notes.map_or(0, |notes| notes.convergence_rows),
        )?;
        let frames = Frames::open(
            &folder.paraview(),
            notes.map_or(0, |notes| notes.frames),
            case,
        )?;
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
            convergence,
            frames,
            figures: notes.map_or_else(Vec::new, |notes| notes.figures.clone()),
            steps: notes.map_or(0, |notes| notes.steps),
            factor_of_safety: notes.and_then(|notes| notes.factor_of_safety),
            peaks: records.peaks.clone(),
            kept: Vec::new(),
            pieces: None,
            seconds: 0.0,
            notes_for_user: Vec::new(),
        })
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
        taken: &Taken<'_, D>,
        resumption: &Resumption,
        run: &Summary,
    ) -> Result<(), CaseError> {
        let clock = Instant::now();
        self.steps += 1;
        let body = taken.accepted.body;
        if let Every::Steps(every) = self.every
            && summary.steps.is_multiple_of(every.max(1))
        {
            let conditions = &taken.accepted.conditions;
            let own = (&body.particles, &conditions.laws[..]);
            let structures = outlines::structures(model.case, taken.controls, body);
            self.frames
                .add(self.steps as f64, own, &conditions.grid, &structures)?;
        }
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
            let named = |name: &str| format!("{name}__{}", sections::stage_name(case, number));
            for body in &structures.rigid {
                let table = body.table(named(&body.part.name));
                table.write_csv(&self.folder.rigid())?;
            }
            for own in &structures.reinforcement {
                let table = own.table(named(&own.part.name));
                table.write_csv(&self.folder.reinforcement())?;
            }
        }
        if self.every != Every::Never {
            let grid = model.grid(model.lowered(&state.controls))?;
            let laws = model.laws_reduced_by(&state.controls.srf)?;
            // The time of a frame is the number of steps and trials so far.
            let own = (&state.body.particles, &laws[..]);
            self.frames
                .add(self.steps as f64, own, &grid, &structures)?;
        }
        if let Some(safety) = &summary.safety {
            self.factor_of_safety = match (safety.stable, safety.failed) {
                (Some(stable), Some(failed)) => Some(0.5 * (stable + failed)),
                _ => None,
            };
            if self.draws {
                let (root, title) = (self.folder.root(), &case.title);
                let picture = pictures::safety_picture(root, title, &summary.name, safety)?;
                self.figures.push(picture);
            }
        }
        self.ends_of_search(model, number, summary)?;
        if summary.safety.is_none() {
            self.field_pictures(model, &Shown::end_of_stage(case, number), state, &[])?;
        }
        let (root, title) = (self.folder.root(), &case.title);
        if self.draws {
            let drawn = case
                .sections
                .par_iter()
                .zip(sections)
                .map(|(section, table)| {
                    let references = section.references_at(case, number);
                    let stage = (summary.name.as_str(), &references[..]);
                    pictures::section_pictures(root, title, section, stage, table)
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
        self.write_summary(run)?;
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

    /// Frames and pictures of the states at the ends of a search, and of the way in which the body fails.
    fn ends_of_search(
        &mut self,
        model: &Model<'_, D>,
        number: usize,
        summary: &StageSummary,
    ) -> Result<(), CaseError> {
        let kept = std::mem::take(&mut self.kept);
        for (what, End { srf, state, .. }) in &kept {
            let name = format!("stage-{:02}-{what}", number + 1);
            if self.every != Every::Never {
                let laws = model.laws_reduced_by(&state.controls.srf)?;
                let structures = outlines::structures(model.case, &state.controls, &state.body);
                for own in &structures.reinforcement {
                    let table = own.table(format!("{}__{name}", own.part.name));
                    table.write_csv(&self.folder.reinforcement())?;
                }
                self.frames
                    .beside(&name, (&state.body.particles, &laws), &structures)?;
            }
            let shown = Shown {
                title: format!("{}, SRF {srf:.4}", summary.name),
                when: format!("in the {} state, SRF {srf:.4}", what.replace('-', " ")),
                name,
            };
            let others = kept.iter().filter(|(other, _)| other != what);
            let others: Vec<&State<D>> = others.map(|(_, end)| &end.state).collect();
            self.field_pictures(model, &shown, state, &others)?;
        }
        let kept_in_plane =
            in_plane::<Vec<(&'static str, End<D>)>, Vec<(&'static str, End)>>(&kept);
        let (Some(case), Some(kept)) = (in_plane(model.case), kept_in_plane) else {
            return Ok(());
        };
        self.mechanism((case, &model.seeded.body), number, kept)
    }

    /// The way in which the body fails: the slip line as a table, and its picture.
    fn mechanism(
        &mut self,
        (case, body_of): (&Case, &[usize]),
        number: usize,
        kept: &[(&'static str, End)],
    ) -> Result<(), CaseError> {
        // The state that failed has moved most; where no step led to it, the stable one tells.
        for (what, end) in kept.iter().rev() {
            let Some(before) = &end.before else { continue };
            let failing = Failing {
                stage: number,
                srf: end.srf,
                what,
                before: &before.particles,
                last: &end.state.body.particles,
            };
            let Some(found) = mechanism(&failing) else {
                continue;
            };
            if let Some(table) = found.table(case, number) {
                table.write_csv(&self.folder.slip_lines())?;
            }
            if !case.output.figures.is_empty() {
                let pieces = self.pieces(case)?;
                let canvas = Canvas {
                    folder: self.folder.root(),
                    case,
                    pieces: &pieces,
                };
                let over = outlines::of_state((case, body_of), &end.state);
                let picture = pictures::mechanism_picture(&canvas, &failing, &found, &over)?;
                self.figures.push(picture);
            }
            break;
        }
        Ok(())
    }

    /// The bodies in pieces, cut once.
    fn pieces(&mut self, case: &Case) -> Result<Arc<Pieces>, CaseError> {
        let pieces = match &self.pieces {
            Some(pieces) => Arc::clone(pieces),
            None => Arc::new(Pieces::of(case)?),
        };
        self.pieces = Some(Arc::clone(&pieces));
        Ok(pieces)
    }

    /// The pictures of the fields that the case wants to see, with the units and colours that suit the
    /// state and the states that it is compared with.
    fn field_pictures(
        &mut self,
        model: &Model<'_, D>,
        shown: &Shown,
        state: &State<D>,
        compared: &[&State<D>],
    ) -> Result<(), CaseError> {
        let wanted = &model.case.output.figures;
        if wanted.is_empty() {
            return Ok(());
        }
        let laws = model.laws_reduced_by(&state.controls.srf)?;
        let reduced = compared
            .iter()
            .map(|state| model.laws_reduced_by(&state.controls.srf))
            .collect::<Result<Vec<_>, _>>()?;
        let reduced: Vec<&[SharedLaw]> = reduced.iter().map(|laws| &laws[..]).collect();
        if let Some(state) = in_plane::<_, State<3>>(state) {
            let compared = compared
                .iter()
                .filter_map(|own| in_plane::<_, State<3>>(*own));
            let compared: Vec<Seen<'_, 3>> = std::iter::zip(compared, &reduced)
                .map(|(state, laws)| (&state.body.particles, *laws))
                .collect();
            return self.pictures_in_space((model, shown), (state, &laws), &compared);
        }
        let (Some(case), Some(state)) = (in_plane(model.case), in_plane::<_, State>(state)) else {
            return Ok(());
        };
        let pieces = self.pieces(case)?;
        let canvas = Canvas {
            folder: self.folder.root(),
            case,
            pieces: &pieces,
        };
        let own = (&state.body.particles, &laws[..]);
        let compared: Vec<Seen<'_>> = std::iter::zip(compared, &reduced)
            .filter_map(|(state, laws)| {
                Some((&in_plane::<_, State>(*state)?.body.particles, *laws))
            })
            .collect();
        let over = outlines::of_state((case, &model.seeded.body), state);
        let drawn = wanted
            .par_iter()
            .map(|&field| pictures::field_picture(&canvas, shown, field, own, &compared, &over))
            .collect::<Result<Vec<_>, _>>()?;
        self.figures.extend(drawn);
        Ok(())
    }

    /// The same in space: the surface, and cuts through the middle.
    fn pictures_in_space(
        &mut self,
        (model, shown): (&Model<'_, D>, &Shown),
        (state, laws): (&State<3>, &[SharedLaw]),
        compared: &[Seen<'_, 3>],
    ) -> Result<(), CaseError> {
        let case = model.case;
        let standing = in_plane::<_, Case<3>>(case).map(|case| {
            let structures = outlines::structures(case, &state.controls, &state.body);
            rigid::cells(&structures.rigid)
        });
        let bodies = standing.map_or_else(Vec::new, |cells| {
            let corners = cells.connectivity.as_chunks::<3>().0.iter();
            corners
                .map(|corners| corners.map(|point| cells.points[point]))
                .collect()
        });
        let of_case = (self.folder.root(), &*case.title, case.has_pore_water());
        let drawn = pictures::InSpace::new(of_case, (&state.body.particles, laws), bodies);
        let planes = match &case.output.cuts[..] {
            [] => drawn.middle(),
            cuts => cuts.to_vec(),
        };
        let wanted = &case.output.figures;
        let notes = wanted
            .par_iter()
            .map(|&field| drawn.pictures(shown, field, compared, &planes))
            .collect::<Result<Vec<_>, _>>()?;
        self.figures.extend(notes.concat());
        Ok(())
    }

    /// The picture of the set-up.
    pub(crate) fn model_picture(&mut self, case: &Case<D>) -> Result<(), CaseError> {
        if !self.draws {
            return Ok(());
        }
        let clock = Instant::now();
        if let Some(case) = in_plane(case) {
            let picture = pictures::model_picture(self.folder.root(), case)?;
            self.figures.push(picture);
        }
        self.seconds += clock.elapsed().as_secs_f64();
        Ok(())
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
            figures.splice(at..at, histories?);
            figures.extend(convergence?);
        }
        summary.figures = figures;
        self.seconds += clock.elapsed().as_secs_f64();
        summary.seconds = begun.elapsed().as_secs_f64();
        summary.output_seconds = self.seconds;
        self.write_summary(summary)?;
        if self.report {
            report::write_report(self.folder.root())?;
        }
        if !summary.interrupted {
            folder::mark(self.folder.root(), &self.claim, true)?;
        }
        Ok(())
    }

    fn write_summary(&self, summary: &Summary) -> Result<(), CaseError> {
        write_summary(self.folder.root(), summary)
    }

    fn notes(&self, case: &Case<D>, stage: usize, run: &Summary, controls: &Controls) -> Notes {
        Notes {
            history: fingerprint::of_history(case, stage + 1),
            stages: run.stages.clone(),
            checks: run.checks.clone(),
            warnings: run.warnings.clone(),
            unknowns: run.size.unknowns,
            figures: self.figures.clone(),
            factor_of_safety: self.factor_of_safety,
            peaks: self
                .peaks
                .iter()
                .map(|&peak| Some(peak).filter(|peak| peak.is_finite()))
                .collect(),
            curve_rows: self.curves.iter().map(RowWriter::len).collect(),
            monitor_rows: self.monitors.iter().map(RowWriter::len).collect(),
            rigid_rows: self.rigid.iter().map(RowWriter::len).collect(),
            rigid: BTreeMap::new(),
            reinforcement: BTreeMap::new(),
            convergence_rows: self.convergence.len(),
            frames: self.frames.len(),
            steps: self.steps,
            stage: None,
            controls: controls.clone(),
            resumption: None,
            trials: None,
            stable: None,
            failed: None,
        }
    }

    fn meta(&self, notes: &Notes, states: &[(&str, &Body<D>)]) -> Result<Meta, CaseError> {
        let with_bodies = states.iter().filter(|(_, body)| !body.rigid.is_empty());
        let saved = with_bodies.map(|(name, body)| ((*name).to_owned(), saved_body::all(body)));
        let with_members = states
            .iter()
            .filter(|(_, body)| !body.reinforcement.is_empty());
        let members = with_members.map(|(name, body)| {
            let own = saved_reinforcement::all(body);
            ((*name).to_owned(), own)
        });
        let notes = Notes {
            rigid: saved.collect(),
            reinforcement: members.collect(),
            ..notes.clone()
        };
        let data = serde_json::to_value(notes).map_err(|source| CaseError::File {
            path: self.folder.checkpoint(),
            source: source.into(),
        })?;
        Ok(Meta::new(&self.claim.input, data))
    }

    /// Writes a checkpoint within a stage. It follows the rows that it counts on; what is in the
    /// hands of the system outlasts a kill.
    fn save(&self, states: &[(&str, &Body<D>)], notes: &Notes) -> Result<(), CaseError> {
        let name = format!("step-{:06}", self.steps);
        let (folder, meta) = (self.folder.checkpoint(), self.meta(notes, states)?);
        checkpoint::write_quickly(&folder, &name, states, &meta, self.checkpoint_keep)?;
        Ok(())
    }

    /// Writes the checkpoint at the end of a stage, after its rows, to outlast a loss of power.
    fn save_end(&mut self, stage: usize, body: &Body<D>, notes: &Notes) -> Result<(), CaseError> {
        let tables: Vec<&RowWriter> = self
            .curves
            .iter()
            .chain(&self.monitors)
            .chain(&self.rigid)
            .chain([&self.convergence])
            .collect();
        let (rows, frames) = rayon::join(
            || tables.par_iter().try_for_each(|table| table.sync()),
            || self.frames.sync(),
        );
        rows.and(frames)?;
        let states = [("current", body)];
        let (folder, meta) = (self.folder.checkpoint(), self.meta(notes, &states)?);
        checkpoint::write(&folder, &end_of_stage(stage), &states, &meta, 1)?;
        Ok(())
    }
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
        .map(|(curve, table)| Ok(vec![pictures::curve_picture(root, title, curve, table)?]));
    let monitors = (&case.monitors, &records.monitors)
        .into_par_iter()
        .map(|(monitor, table)| pictures::monitor_pictures(root, case, monitor, table));
    let drawn = curves.chain(monitors).collect::<Result<Vec<_>, _>>()?;
    Ok(drawn.concat())
}

/// File of a table.
fn csv(name: &str) -> String {
    format!("{name}.csv")
}
