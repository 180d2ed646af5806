//! Solver, monitors, sections and output.

pub(crate) mod checks;
pub(crate) mod curves;
pub(crate) mod quantities;
pub(crate) mod study;

use std::path::{Path, PathBuf};

use igimp_linear::SolverKind;
use igimp_model::{
    Average, Cut, Every, Field, Monitor, Output, Section, SectionReference, SolverSettings, Stage,
    StageKind,
};
use igimp_results::fields::length;
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::outputs::{self as keys, Across, LinearSolver, OutputTime};
use igimp_schema::text::{number, point};
use igimp_schema::tree::read::{At, Either};

use super::AllNames;
use super::bodies::reach::meets_plane;
use super::bodies::site::Soil;
use crate::build::context::Context;
use igimp_text::{MemoryLimit, NoAmount};
use quantities::fields;

/// Most memory for factors, if the case states it.
fn memory(stated: Option<&At<String>>, problems: &mut Problems) -> Option<MemoryLimit> {
    let stated = stated?;
    match stated.value.parse() {
        Ok(limit) => Some(limit),
        Err(wrong) => {
            let wrong: NoAmount = wrong;
            problems.error(stated.place, wrong.to_string());
            None
        }
    }
}

/// Tolerance beyond which results are off \[-\].
const LOOSE: f64 = 1e-3;

/// Newton's method, step cutting, linear solver.
pub(super) fn solver(table: &keys::Solver, problems: &mut Problems) -> SolverSettings {
    let linear = match *table.linear {
        LinearSolver::Auto => SolverKind::Auto,
        LinearSolver::Multigrid => SolverKind::Multigrid,
        LinearSolver::Single => SolverKind::Single,
    };
    if *table.tolerance > LOOSE {
        problems
            .warning(
                table.tolerance.place,
                format!("tolerance = {} is loose", number(*table.tolerance)),
            )
            .help("forces out of balance carry a load that nothing stands for: 1e-6 to 1e-4 tells a factor of safety");
    }
    SolverSettings {
        tolerance: *table.tolerance,
        max_iterations: *table.max_iterations,
        cuts: *table.step_cutting.times as u32,
        cut_factor: *table.step_cutting.factor,
        linear,
        memory: memory(table.memory.as_ref(), problems),
    }
}

/// A monitor.
pub(super) fn monitor<const D: usize>(
    monitor: &keys::Monitor<D>,
    soil: &dyn Soil<D>,
    moves: bool,
    problems: &mut Problems,
) -> Option<Monitor<D>> {
    let place = *monitor.point;
    if soil.is_known() && !soil.holds_point(&place, soil.round_off()) {
        problems
            .warning(
                monitor.point.place,
                format!("the monitor at {} lies outside every body", point(place)),
            )
            .help("the material point nearest to it is watched");
    }
    Some(Monitor {
        name: monitor.name.value.clone(),
        point: place,
        record: fields::<D>(&monitor.record, moves, problems)?,
    })
}

/// A section.
pub(super) fn section<const D: usize>(
    section: &keys::Section<D>,
    about: &About<'_>,
    soil: &dyn Soil<D>,
    problems: &mut Problems,
) -> Option<Section<D>> {
    let (from, to) = (*section.from, *section.to);
    let way: [f64; D] = std::array::from_fn(|axis| to[axis] - from[axis]);
    let along = |t: f64| std::array::from_fn(|axis| from[axis] + t * way[axis]);
    let meets = (0..=50).any(|k| soil.holds_point(&along(f64::from(k) / 50.0), soil.round_off()));
    if length(&way) <= soil.round_off() {
        problems.error(section.to.place, "this section has no length");
    } else if soil.is_known() && !meets {
        problems
            .warning(section.from.place, "this section meets no body")
            .help("it will hold no values");
    }
    if about.has_cuts && section.name.starts_with("cut-") {
        problems
            .error(
                section.name.place,
                "tables of planes have names that begin with `cut-`",
            )
            .help("give the section another name");
    }
    let record = fields::<D>(&section.record, about.moves, problems);
    let references: Option<Vec<_>> = (section.references.iter())
        .map(|reference| {
            section_reference::<D>(reference.as_ref().ok()?, record.as_deref(), about, problems)
        })
        .collect();
    Some(Section {
        name: section.name.value.clone(),
        from,
        to,
        points: *section.points,
        record: record?,
        average: match *section.average {
            keys::Average::Cell => Average::Cell,
            keys::Average::None => Average::None,
        },
        references: references?,
    })
}

/// The data for references of sections.
pub(super) struct About<'a> {
    pub(super) names: &'a AllNames,
    pub(super) stages: &'a [Option<Stage>],
    pub(super) file: &'a Path,
    /// Whether a stage moves soil in time.
    pub(super) moves: bool,
    /// Whether planes are drawn.
    pub(super) has_cuts: bool,
}

/// A reference of a section that records these fields.
fn section_reference<const D: usize>(
    table: &At<keys::SectionReference>,
    record: Option<&[Field]>,
    about: &About<'_>,
    problems: &mut Problems,
) -> Option<SectionReference> {
    let of = fields::<D>(std::slice::from_ref(&table.of), about.moves, problems)?.pop()?;
    if record.is_some_and(|record| !record.contains(&of)) {
        let name = of.name();
        problems
            .error(
                table.of.place,
                format!("the section does not record `{name}`"),
            )
            .help(format!("add \"{name}\" to its `record`"));
        return None;
    }
    let subject = "this reference looks at";
    let stages = &about.names.stages;
    let stage = stages.find_optional(table.stage.as_ref(), subject, problems);
    let searches = |stage: &Stage| matches!(stage.kind, StageKind::StrengthReduction(_));
    if let (Ok(Some(number)), Some(named)) = (stage, &table.stage)
        && about.stages[number].as_ref().is_some_and(searches)
    {
        problems
            .error(
                named.place,
                "a strength reduction leaves the body as it found it, and no sections",
            )
            .help("name the stage before it");
        return None;
    }
    let stated = curves::ReferenceKeys {
        y: table.y.as_ref(),
        at: table.at.as_ref(),
        points: table.points.as_ref(),
        file: table.file.as_ref(),
        label: &table.label,
        tolerance: table.tolerance.as_ref(),
        place: table.place,
    };
    let reference = curves::reference(&stated, about.file, problems);
    Some(SectionReference {
        of,
        stage: stage.ok()?,
        reference: reference?,
    })
}

/// A plane in which fields are drawn.
fn cut<const D: usize>(cut: &keys::Cut, context: &Context<'_, D>, problems: &mut Problems) -> Cut {
    let axis = match *cut.across {
        Across::X => 0,
        Across::Y => 1,
        Across::Z => 2,
    };
    if axis < D && !meets_plane(context.bodies, context.sequence, (axis, *cut.at)) {
        problems
            .warning(cut.at.place, "this plane meets no body")
            .help("its table will be empty, and nothing is drawn there");
    }
    Cut { axis, at: *cut.at }
}

/// The files written, and where.
pub(super) fn output<const D: usize>(
    table: &keys::Output,
    context: &Context<'_, D>,
    moves: bool,
    problems: &mut Problems,
) -> Option<Output> {
    let folder = table.folder.as_ref()?;
    if folder.trim().is_empty() || folder.chars().any(char::is_control) {
        problems
            .error(folder.place, "this is not the name of a folder")
            .help("write folder = \"results/slope\", or leave it out");
        return None;
    }
    Some(Output {
        folder: PathBuf::from(&folder.value),
        paraview: match **table.paraview.every.as_ref()? {
            Either::First(OutputTime::Never) => Every::Never,
            Either::First(OutputTime::Stage) => Every::Stage,
            Either::First(OutputTime::Film) => Every::Film,
            Either::Second(steps) => Every::Steps(steps),
        },
        figures: fields::<D>(&table.figures, moves, problems)?,
        cuts: (table.cuts.iter())
            .flat_map(|cuts| cuts.iter())
            .map(|plane| cut(plane, context, problems))
            .collect(),
        report: *table.report,
        checkpoint_every: *table.checkpoint.every,
        checkpoint_keep: *table.checkpoint.keep,
    })
}
