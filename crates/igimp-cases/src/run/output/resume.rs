//! How a run is taken up again from its results folder.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use igimp_model::Case;
use igimp_results::ResultsError;
use igimp_results::atomic::write_whole;
use igimp_results::checkpoint::{self, Checkpoint, CheckpointError, difference};
use igimp_results::folder::{self, Folder};
use igimp_results::tables::rows;
use igimp_solver::{Body, FreeField};

use super::readings::Beginning;
use super::{BEFORE, CONVERGENCE, Output, csv, growing};
use crate::error::CaseError;
use crate::run::Target;
use crate::run::output::records::Records;
use crate::run::resume::{
    End, Notes, ResumePoint, Resumption, Search, end_of_stage, fingerprint, free_field, notes_of,
    reinforcement, rigid,
};
use crate::run::state::{Controls, State};

impl<const D: usize> Output<D> {
    /// A results folder taken up at its newest checkpoint; without one the run begins afresh.
    pub(crate) fn resume(
        target: &Target,
        case: &Case<D>,
        records: &mut Records,
    ) -> Result<(Self, Option<ResumePoint<D>>), CaseError> {
        let folder = match Folder::open(&target.folder) {
            Ok(folder) => folder,
            Err(ResultsError::NoResults { .. }) => {
                return Ok((Self::create(target, case, records)?, None));
            }
            Err(error) => return Err(error.into()),
        };
        let Some(path) = checkpoint::newest(&folder.checkpoint())? else {
            return Ok((Self::create(target, case, records)?, None));
        };
        let found =
            checkpoint::read(&path, Some(&fingerprint::of_case(case))).map_err(|error| {
                difference::named(error, &folder.completed_case(), &target.completed)
            })?;
        let passed_over = checkpoint::passed_over(&path)?;
        let notes = notes_of(&path, &found.meta)?;
        let left = taken_up(&folder, case, records, &found, &notes)?;
        let mut output = Self::go_on(folder, target, &path, case, records, &notes)?;
        let taken = path.file_name().unwrap_or_default().to_string_lossy();
        let note = |error| format!("{error}; the run goes on from {taken}, the last whole one");
        output.notes_for_user = passed_over.into_iter().map(note).collect();
        Ok((output, Some(left)))
    }

    /// A results folder taken up at the beginning of a stage.
    pub(crate) fn from_stage(
        target: &Target,
        case: &Case<D>,
        records: &mut Records,
        stage: usize,
    ) -> Result<(Self, Option<ResumePoint<D>>), CaseError> {
        let Some(before) = stage.checked_sub(1) else {
            return Ok((Self::create(target, case, records)?, None));
        };
        let folder = Folder::open(&target.folder)?;
        let Some(path) = checkpoint::named(&folder.checkpoint(), &end_of_stage(before))? else {
            return Err(CaseError::NoStart {
                stage: case.stages[stage].name.clone(),
                from: case.stages[before].name.clone(),
            });
        };
        let found = checkpoint::read(&path, None)?;
        let notes: Notes = notes_of(&path, &found.meta)?;
        if notes.history != fingerprint::of_history(case, stage) {
            let other = CheckpointError::OtherCase {
                path,
                differs: None,
            };
            let kept = folder.completed_case();
            return Err(difference::named(other, &kept, &target.completed).into());
        }
        let beginning = Beginning {
            folder: &folder,
            case,
            records,
            stage,
        };
        let kept = beginning.kept(&notes)?;
        let left = taken_up(&folder, case, records, &found, &kept.notes)?;
        // Nothing was changed so far, and nothing is refused from here on.
        beginning.clear(&notes, &kept)?;
        let mut output = Self::go_on(folder, target, &path, case, records, &kept.notes)?;
        output.warnings = kept.warnings;
        Ok((output, Some(left)))
    }

    /// Opens a results folder after the rows of a checkpoint; later ones are gone.
    fn go_on(
        folder: Folder,
        target: &Target,
        path: &Path,
        case: &Case<D>,
        records: &mut Records,
        notes: &Notes,
    ) -> Result<Self, CaseError> {
        checkpoint::discard_after(path)?;
        write_whole(&folder.case(), &target.source)?;
        write_whole(&folder.completed_case(), &target.completed)?;
        // From a stage on, the checks may be others than they were.
        if notes.peaks.len() == records.peaks.len() {
            let peaks = notes.peaks.iter().map(|peak| peak.unwrap_or(f64::NAN));
            records.peaks = peaks.collect();
        }
        let claim = target.claim(case);
        folder::mark(folder.root(), &claim, false)?;
        let output = Self::open(folder, claim, case, records, Some(notes))?;
        records.factor_of_safety = notes.factor_of_safety.unwrap_or(f64::NAN);
        output.read_tables(records)?;
        Ok(output)
    }

    /// Reads the rows of the tables so far.
    fn read_tables(&self, records: &mut Records) -> Result<(), CaseError> {
        for (tables, folder) in [
            (&mut records.curves, self.folder.curves()),
            (&mut records.monitors, self.folder.monitors()),
            (&mut records.rigid, self.folder.rigid()),
        ] {
            for table in tables {
                table.rows = rows::read(&folder.join(csv(&table.name)))?.rows;
            }
        }
        if self.energy.is_some() {
            records.energy.rows = rows::read(&self.folder.energy())?.rows;
        }
        Ok(())
    }

    /// The saved ends of the first `stages` stages.
    pub(crate) fn ends(
        &self,
        case: &Case<D>,
        records: &Records,
        stages: usize,
    ) -> Result<HashMap<usize, State<D>>, CaseError> {
        let mut ends = HashMap::new();
        for number in 0..stages {
            let wanted = case.stages[stages.min(case.stages.len() - 1)..]
                .iter()
                .any(|stage| stage.start_from == Some(number));
            if !wanted {
                continue;
            }
            let Some(path) = checkpoint::named(&self.folder.checkpoint(), &end_of_stage(number))?
            else {
                continue;
            };
            let found = checkpoint::read::<D>(&path, None)?;
            let notes = notes_of(&path, &found.meta)?;
            let saved = SavedStates {
                case,
                path: &path,
                notes: &notes,
                found: &found,
                laws: records.law_count(),
            };
            if let Some((name, body)) = found.states.first() {
                saved.fits(records, name, body)?;
                let mut body = saved.body(name, &notes.controls)?;
                body.free_fields = saved.free_fields()?;
                let controls = notes.controls.clone();
                ends.insert(number, State { body, controls });
            }
        }
        Ok(ends)
    }
}

/// Where a checkpoint says that its run was left. The folder is read, held against the notes, and not changed.
fn taken_up<const D: usize>(
    folder: &Folder,
    case: &Case<D>,
    records: &Records,
    found: &Checkpoint<D>,
    notes: &Notes,
) -> Result<ResumePoint<D>, CaseError> {
    let path = folder.checkpoint();
    let saved = SavedStates {
        case,
        path: &path,
        notes,
        found,
        laws: records.law_count(),
    };
    let mut current = saved.body("current", &notes.controls)?;
    current.free_fields = saved.free_fields()?;
    for (name, body) in &found.states {
        saved.fits(records, name, body)?;
    }
    if let Some(why) = notes.resumption.as_ref().and_then(impossible_march) {
        return Err(saved.damaged(META, why).into());
    }
    let search = saved.search()?;
    let convergence = CONVERGENCE.map(str::to_owned);
    let mut tables = growing(folder, records, Some(notes)).concat();
    tables.push((folder.convergence(), &convergence, notes.convergence_rows));
    tables.push((folder.energy(), &records.energy.header, notes.energy_rows));
    for (path, header, rows) in tables {
        rows::holds(&path, header, rows)?;
    }
    Ok(ResumePoint {
        stages: notes.stages.clone(),
        checks: notes.checks.clone(),
        warnings: notes.warnings.clone(),
        unknowns: notes.unknowns,
        stage: notes.stage.clone(),
        state: State {
            body: current,
            controls: notes.controls.clone(),
        },
        resumption: notes.resumption.clone(),
        search,
    })
}

/// The file of a checkpoint with its notes.
const META: &str = "meta.json";

/// The states of a checkpoint, to be given the structures of their case.
struct SavedStates<'f, const D: usize> {
    case: &'f Case<D>,
    path: &'f Path,
    notes: &'f Notes,
    found: &'f Checkpoint<D>,
    laws: usize,
}

impl<const D: usize> SavedStates<'_, D> {
    fn damaged(&self, file: impl Into<String>, why: String) -> CheckpointError {
        CheckpointError::Damaged {
            path: self.path.to_owned(),
            file: file.into(),
            why,
        }
    }

    /// A state with the structures that its controls have, without columns beside its walls.
    fn body(&self, name: &str, controls: &Controls) -> Result<Body<D>, CaseError> {
        let found = self.found.states.iter().find(|(state, _)| state == name);
        let missing = || self.damaged(name, "the state is missing".to_owned());
        let mut body = found.map(|(_, body)| body.clone()).ok_or_else(missing)?;
        let in_notes = |why| self.damaged(META, why);
        let saved = self.notes.rigid.get(name).map_or(&[][..], Vec::as_slice);
        body.rigid = rigid::taken_up(self.case, self.laws, controls, saved)?.map_err(in_notes)?;
        let saved = self.notes.reinforcement.get(name);
        let saved = saved.map_or(&[][..], Vec::as_slice);
        body.reinforcement =
            reinforcement::taken_up(self.case, controls, saved).map_err(in_notes)?;
        Ok(body)
    }

    /// The columns in free field beside walls.
    fn free_fields(&self) -> Result<Vec<FreeField<D>>, CheckpointError> {
        free_field::taken_up(&self.notes.free_fields, &self.found.states)
            .map_err(|why| self.damaged(META, why))
    }

    /// Refuses a state with names that are not in the case.
    fn fits(&self, records: &Records, name: &str, body: &Body<D>) -> Result<(), CheckpointError> {
        match unfit(self.case, records, body) {
            Some((array, why)) => Err(self.damaged(format!("{name}/{array}.npy"), why)),
            None => Ok(()),
        }
    }

    /// The search for a factor of safety that was under way.
    fn search(&self) -> Result<Option<Search<D>>, CaseError> {
        let end = |name: &str, before: &str, of: &Option<(f64, Controls)>| match of {
            Some((srf, controls)) => {
                let controls = controls.clone();
                let before = self.body(before, &controls).ok().map(Arc::new);
                let body = self.body(name, &controls)?;
                let state = State { body, controls };
                Ok::<_, CaseError>(Some(End {
                    srf: *srf,
                    state,
                    before,
                }))
            }
            None => Ok(None),
        };
        let Some(trials) = &self.notes.trials else {
            return Ok(None);
        };
        Ok(Some(Search {
            trials: trials.clone(),
            stable: end("stable", BEFORE[0], &self.notes.stable)?,
            failed: end("failed", BEFORE[1], &self.notes.failed)?,
        }))
    }
}

/// Why a march cannot stand where a checkpoint says, if it cannot.
fn impossible_march(resumption: &Resumption) -> Option<String> {
    let march = &resumption.march;
    let is_possible = march.size > 0.0 && march.size.is_finite() && (0.0..=1.0).contains(&march.at);
    (!is_possible).then(|| {
        format!(
            "no march stands at {} with steps of {}",
            march.at, march.size
        )
    })
}

/// The array of a body that names a law, a particle or a load that is not in the case, and that
/// name.
fn unfit<const D: usize>(
    case: &Case<D>,
    records: &Records,
    body: &Body<D>,
) -> Option<(&'static str, String)> {
    let (laws, seeded, loads) = (records.law_count(), records.seeded(), case.loads.len());
    let law = &body.particles.law;
    if let Some(particle) = law.iter().position(|&law| law >= laws) {
        let law = law[particle];
        let why = format!("particle {particle} is of law {law}, and there are {laws}");
        return Some(("law", why));
    }
    let mut taken = vec![false; seeded];
    for (particle, &number) in body.particles.number.iter().enumerate() {
        let why = match taken.get_mut(number) {
            None => format!("particle {particle} has number {number}, and there are {seeded}"),
            Some(true) => format!("particle {particle} has number {number}, as another one has"),
            Some(taken) => {
                *taken = true;
                continue;
            }
        };
        return Some(("number", why));
    }
    let points = &body.load_points;
    let point = points.iter().position(|point| point.load >= loads)?;
    let load = points[point].load;
    let why = format!("load point {point} belongs to load {load}, and there are {loads}");
    Some(("load_point_load", why))
}

#[cfg(test)]
mod tests {
    use igimp_assembly::{LoadPoint, Particles};

    use super::*;
    use crate::fixture::case;
    use crate::run::Model;

    /// GOAL: a state with names that are not in the case is refused before a step looks for them.
    #[test]
    fn materials_and_loads_that_are_not_there_are_named() {
        let case = case();
        let (model, state) = Model::new(&case).unwrap();
        let mut body = state.body;
        let records = Records::new(&case, &model.laws, &body.particles).unwrap();
        let unfit = |body: &Body<2>| unfit(&case, &records, body);
        assert_eq!(unfit(&body), None);
        body.load_points = vec![LoadPoint {
            x: [1.0, 2.0],
            force: [0.0, -1.0],
            load: 4,
        }];
        let why = "load point 0 belongs to load 4, and there are 0".to_owned();
        assert_eq!(unfit(&body), Some(("load_point_load", why)));
        for (number, why) in [
            (64, "particle 5 has number 64, and there are 64"),
            (4, "particle 5 has number 4, as another one has"),
        ] {
            let mut fields = (*body.particles).clone();
            fields.number[5] = number;
            let mut other = body.clone();
            other.particles = Particles::from_fields(fields).unwrap();
            assert_eq!(unfit(&other), Some(("number", why.to_owned())));
        }
        let mut fields = (*body.particles).clone();
        fields.law[3] = 1;
        body.particles = Particles::from_fields(fields).unwrap();
        let why = "particle 3 is of law 1, and there are 1".to_owned();
        assert_eq!(unfit(&body), Some(("law", why)));
    }
}
