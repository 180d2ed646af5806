//! A case on several meshes: their runs side by side, and their results together.
//!
//! A mesh is a run of its own with a folder of its own; events beside it change none of its bits.
//! A failure on a mesh takes nothing from the others.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

use igimp_model::{Case, meshes};
use igimp_report::viewer::Surroundings;
use igimp_report::{pictures, report};
use igimp_results::checkpoint::sha256;
use igimp_results::ending::Ending;
use igimp_results::folder::{self, mesh_name, write_atomically, write_summary};
use igimp_results::mesh_study::{MeshSummary, StudySummary};
use igimp_results::summary::Summary;

use super::engine::one_mesh;
use super::{Event, Listener, Run, Start, Target};
use crate::error::CaseError;
use crate::mesh_study::{check_rows, remarks, study};
use crate::on_one_line;
use igimp_estimate::resources::{memory, processor};
use igimp_estimate::time::time_of_steps_taken;
use igimp_estimate::watch::side_by_side;
use igimp_estimate::{Estimate, estimate};

/// Runs a case on all meshes of its study.
pub(super) fn run<const D: usize>(
    case: &Case<D>,
    target: Option<&Target>,
    start: Start,
    listener: &mut dyn Listener<D>,
    interrupt: &AtomicBool,
) -> Result<Run<D>, CaseError> {
    let clock = Instant::now();
    let meshes = meshes::meshes(case);
    if let Some(target) = target {
        folder::of_study(&target.folder, &target.claim(case), start == Start::Afresh)?;
        write_atomically(&target.folder.join("case.toml"), &target.source)?;
        write_atomically(
            &target.folder.join("case.completed.toml"),
            &target.completed,
        )?;
    }
    let targets: Vec<Option<Target>> = (0..meshes.len())
        .map(|number| target.map(|target| of_mesh(target, number)))
        .collect();
    let parts = meshes::refinements(case);
    let runs = all(&meshes, &targets, &parts, start, listener, interrupt);

    let summaries: Vec<Option<&Summary>> = runs
        .iter()
        .map(|run| run.as_ref().ok().map(|run| &run.summary))
        .collect();
    let found = StudySummary {
        meshes: std::iter::zip(&runs, &parts)
            .enumerate()
            .map(|(number, (run, &parts))| mesh_summary(number, parts, run))
            .collect(),
        results: study(case, &summaries),
    };
    let expectation = target.and_then(|target| target.expectation.as_ref());
    let expected = expectation.map(|expectation| {
        let of_mesh = |((mesh, size), run): ((&Case<D>, &Estimate), Option<&Summary>)| {
            Some(time_of_steps_taken(
                mesh,
                size,
                expectation.speed,
                &run?.stages,
            ))
        };
        let sized = std::iter::zip(&meshes, &expectation.sizes);
        let taken: Option<f64> = std::iter::zip(sized, summaries.iter().copied())
            .map(of_mesh)
            .sum();
        expectation.expected(taken)
    });
    let is_whole = !summaries.iter().flatten().any(|run| run.interrupted);
    let warnings = if is_whole {
        remarks(case, &found.results)
    } else {
        Vec::new()
    };
    let mut run = together(case, runs, found)?;
    let summary = &mut run.summary;
    for text in &warnings {
        listener.on_event(&Event::Warning { text });
    }
    summary.warnings.extend(warnings);
    summary.estimate = expected;
    summary.peak_memory_mib = memory::peak_mib();
    summary.memory = None;
    summary.cpu_seconds = processor::seconds();
    if let Some(target) = target {
        summary.input_sha256 = Some(sha256(target.completed.as_bytes()));
        let of_file = target.warnings.iter().cloned();
        summary.warnings.splice(0..0, of_file);
        write(case, &target.folder, summary, clock)?;
        if !summary.interrupted && run.lost.is_empty() {
            folder::mark(&target.folder, &target.claim(case), true)?;
        }
    } else {
        summary.figures.clear();
        summary.seconds = clock.elapsed().as_secs_f64();
    }
    Ok(run)
}

/// The results folder of a mesh.
fn of_mesh(target: &Target, number: usize) -> Target {
    let name = mesh_name(number + 1);
    Target {
        folder: target.folder.join(&name),
        source: target.source.clone(),
        completed: target
            .meshes
            .get(number)
            .unwrap_or(&target.completed)
            .clone(),
        systems: target.systems.as_ref().map(|systems| systems.join(&name)),
        date: target.date.clone(),
        expectation: None,
        meshes: Vec::new(),
        origin: target.origin.clone(),
        replace: target.replace,
        // They are those of the cells of the case, and stand in the summary of the study.
        warnings: Vec::new(),
    }
}

/// Runs the meshes, the coarsest first, as many at a time as processors and memory allow.
fn all<const D: usize>(
    meshes: &[Case<D>],
    targets: &[Option<Target>],
    parts: &[usize],
    start: Start,
    listener: &mut dyn Listener<D>,
    interrupt: &AtomicBool,
) -> Vec<Result<Run<D>, CaseError>> {
    let bytes: Vec<f64> = meshes
        .iter()
        .filter_map(|mesh| Some(estimate(mesh).ok()?.bytes))
        .collect();
    let listener = Mutex::new(listener);
    let run = |number: usize| {
        let mut relay = OfMesh {
            parts: parts[number],
            listener: &listener,
        };
        let target = targets[number].as_ref();
        one_mesh(&meshes[number], target, start, &mut relay, interrupt)
    };
    let jobs = side_by_side(&bytes).min(meshes.len());
    if jobs < 2 {
        return (0..meshes.len()).map(run).collect();
    }
    // Threads of their own that hand their work to the one pool: who is done leaves it to the others.
    let next = AtomicUsize::new(0);
    let done = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= meshes.len() {
                        break;
                    }
                    let ended = run(number);
                    if let Ok(mut done) = done.lock() {
                        done.push((number, ended));
                    }
                }
            });
        }
    });
    let mut done = done.into_inner().unwrap_or_default();
    done.sort_by_key(|(number, _)| *number);
    done.into_iter().map(|(_, run)| run).collect()
}

/// Passes events of a mesh on to the listener of the study.
struct OfMesh<'a, 'l, const D: usize> {
    parts: usize,
    listener: &'a Mutex<&'l mut dyn Listener<D>>,
}

impl<const D: usize> Listener<D> for OfMesh<'_, '_, D> {
    fn on_event(&mut self, event: &Event<'_, D>) {
        if let Ok(mut listener) = self.listener.lock() {
            listener.on_event(&Event::OfMesh {
                parts: self.parts,
                event,
            });
        }
    }
}

fn mesh_summary<const D: usize>(
    number: usize,
    parts: usize,
    run: &Result<Run<D>, CaseError>,
) -> MeshSummary {
    let folder = mesh_name(number + 1);
    match run {
        Ok(run) => {
            let summary = &run.summary;
            let ending = match summary.ending() {
                Ending::Missed => Ending::Done,
                other => other,
            };
            MeshSummary {
                parts,
                folder,
                size: summary.size,
                ending,
                message: summary.failure.clone(),
                steps: summary.stages.iter().map(|stage| stage.steps).sum(),
                seconds: summary.seconds,
            }
        }
        Err(error) => MeshSummary {
            parts,
            folder,
            ending: Ending::Failed,
            message: Some(on_one_line(error)),
            ..MeshSummary::default()
        },
    }
}

/// The run of the finest mesh that came to its end, or of the finest at all, with the study's results.
///
/// # Errors
/// The first error, if no mesh could be run.
fn together<const D: usize>(
    case: &Case<D>,
    runs: Vec<Result<Run<D>, CaseError>>,
    found: StudySummary,
) -> Result<Run<D>, CaseError> {
    let mut ran = Vec::new();
    let mut lost = Vec::new();
    for (run, mesh) in std::iter::zip(runs, &found.meshes) {
        match run {
            Ok(run) => ran.push((run, mesh)),
            Err(error) => lost.push(error),
        }
    }
    let mut warnings = Vec::new();
    let mut failure = None;
    let mut message = None;
    for (run, mesh) in &mut ran {
        let label = mesh.label();
        let lines = run.summary.warnings.iter();
        warnings.extend(lines.map(|warning| format!("{label}: {warning}")));
        if message.is_none() {
            let text = run.summary.failure.as_ref();
            message = text.map(|text| format!("on the mesh {label}: {text}"));
            failure = run.failure.take();
        }
    }
    let interrupted = ran.iter().any(|(run, _)| run.summary.interrupted);
    let good = ran
        .iter()
        .rposition(|(_, mesh)| mesh.ending == Ending::Done);
    let Some(base) = good.or_else(|| ran.len().checked_sub(1)) else {
        return Err(lost.swap_remove(0));
    };
    let (mut run, mesh) = ran.swap_remove(base);
    let (folder, label) = (mesh.folder.clone(), mesh.label());
    drop(ran);
    let summary = &mut run.summary;
    if !interrupted {
        summary.checks = check_rows(case, summary, &found.results);
    }
    summary.warnings = warnings;
    summary.failure = message;
    summary.interrupted = interrupted;
    for note in &mut summary.figures {
        note.file = format!("{folder}/{}", note.file);
        note.caption = format!("Mesh {label}. {}", note.caption);
    }
    summary.mesh_study = Some(found);
    run.failure = failure;
    run.lost = lost;
    Ok(run)
}

/// Writes table, pictures, summary and report of a study.
fn write<const D: usize>(
    case: &Case<D>,
    root: &Path,
    summary: &mut Summary,
    clock: Instant,
) -> Result<(), CaseError> {
    let begun = Instant::now();
    if let Some(found) = &summary.mesh_study {
        found.write_table(&root.join("mesh_study.csv"))?;
        if !case.output.figures.is_empty() {
            let drawn = pictures::mesh_pictures(root, summary)?;
            let at = summary.figures.len().min(1);
            summary.figures.splice(at..at, drawn);
        }
    }
    summary.output_seconds += begun.elapsed().as_secs_f64();
    summary.seconds = clock.elapsed().as_secs_f64();
    write_summary(root, summary)?;
    if case.output.report {
        report::write_report(root, &Surroundings::default())?;
    }
    Ok(())
}
