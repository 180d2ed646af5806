//! Solver, monitors, sections and output.

pub(crate) mod checks;
pub(crate) mod curves;
pub(crate) mod quantities;
pub(crate) mod study;

use std::path::{Path, PathBuf};

use igimp_linear::SolverKind;
use igimp_model::{
    Average, Cut, Every, Field, Flow, Material, Monitor, Output, Section, SectionReference,
    SolverSettings, Stage, StageKind, Strength,
};
use igimp_results::fields::length;
use igimp_schema::diagnostic::Problems;
use igimp_schema::text::{clip, point};
use igimp_schema::tree::Node;

use super::AllNames;
use super::bodies::site::Soil;
use igimp_text::{MemoryLimit, NoAmount};
use quantities::fields;

/// Most memory for factors, if the case states it.
fn memory(solver: &Node, problems: &mut Problems) -> Option<MemoryLimit> {
    let text = solver.text_at("memory")?;
    match text.parse() {
        Ok(limit) => Some(limit),
        Err(wrong) => {
            let wrong: NoAmount = wrong;
            problems.error(solver.place_at("memory"), wrong.to_string());
            None
        }
    }
}

/// Newton's method, step cutting, linear solver.
pub(super) fn solver(
    tree: &Node,
    materials: &[Option<Material>],
    problems: &mut Problems,
) -> Option<SolverSettings> {
    let node = tree.get("solver")?;
    let cutting = node.get("step_cutting")?;
    let linear = match node.text_at("linear")? {
        "cholesky" => SolverKind::MultifrontalCholesky,
        "multigrid" => SolverKind::Multigrid,
        "single" => SolverKind::Single,
        "lu" => SolverKind::Multifrontal,
        "faer-cholesky" => SolverKind::FaerCholesky,
        "nalgebra-cholesky" => SolverKind::NalgebraCholesky,
        "bicgstab" => SolverKind::SprsBiCgStab,
        _ => SolverKind::Auto,
    };
    let needs_symmetry = matches!(
        linear,
        SolverKind::MultifrontalCholesky | SolverKind::FaerCholesky | SolverKind::NalgebraCholesky
    );
    let unsymmetric = materials.iter().flatten().find(|material| {
        matches!(
            material.strength,
            Strength::MohrCoulomb { friction_angle, dilation_angle, flow: Flow::Dilation, .. }
                if dilation_angle < friction_angle
        )
    });
    if needs_symmetry && let Some(material) = unsymmetric {
        problems
            .warning(
                node.place_at("linear"),
                "Cholesky needs a symmetric matrix, but flow is not associated",
            )
            .help(format!(
                "`{}` has dilation below friction: linear = \"auto\" or \"lu\", or flow = \"davis\" in the material",
                clip(&material.name, 40)
            ));
    }
    Some(SolverSettings {
        tolerance: node.number_at("tolerance")?,
        max_iterations: node.count_at("max_iterations")?,
        cuts: u32::try_from(cutting.count_at("times")?).ok()?,
        cut_factor: cutting.number_at("factor")?,
        linear,
        memory: memory(node, problems),
    })
}

/// The monitors.
pub(super) fn monitors<const D: usize>(
    tree: &Node,
    soil: &dyn Soil<D>,
    problems: &mut Problems,
) -> Vec<Option<Monitor<D>>> {
    let items = tree.items_at("monitors").iter();
    items
        .map(|node| {
            let place = node.point_at("point")?;
            if soil.is_known() && !soil.holds_point(&place, soil.round_off()) {
                problems
                    .warning(
                        node.place_at("point"),
                        format!("the monitor at {} lies outside every body", point(place)),
                    )
                    .help("the material point nearest to it is watched");
            }
            Some(Monitor {
                name: node.text_at("name")?.to_owned(),
                point: place,
                record: fields::<D>(node.items_at("record"), problems)?,
            })
        })
        .collect()
}

/// The sections.
pub(super) fn sections<const D: usize>(
    tree: &Node,
    about: &About<'_>,
    soil: &dyn Soil<D>,
    problems: &mut Problems,
) -> Vec<Option<Section<D>>> {
    let items = tree.items_at("sections").iter();
    items
        .map(|node| {
            let (from, to): ([f64; D], [f64; D]) = (node.point_at("from")?, node.point_at("to")?);
            let way: [f64; D] = std::array::from_fn(|axis| to[axis] - from[axis]);
            if length(&way) <= soil.round_off() {
                problems.error(node.place_at("to"), "this section has no length");
            }
            let along = |t: f64| std::array::from_fn(|axis| from[axis] + t * way[axis]);
            let meets =
                (0..=50).any(|k| soil.holds_point(&along(f64::from(k) / 50.0), soil.round_off()));
            if soil.is_known() && !meets {
                problems
                    .warning(node.place_at("from"), "this section meets no body")
                    .help("it will hold no values");
            }
            let has_cuts = tree
                .get("output")
                .is_some_and(|own| !own.items_at("cuts").is_empty());
            if has_cuts && node.text_at("name")?.starts_with("cut-") {
                problems
                    .error(
                        node.place_at("name"),
                        "tables of planes have names that begin with `cut-`",
                    )
                    .help("give the section another name");
            }
            let record = fields::<D>(node.items_at("record"), problems);
            let references: Option<Vec<_>> = node
                .items_at("references")
                .iter()
                .map(|node| section_reference::<D>(node, record.as_deref(), about, problems))
                .collect();
            Some(Section {
                name: node.text_at("name")?.to_owned(),
                from,
                to,
                points: node.count_at("points")?,
                record: record?,
                average: match node.text_at("average")? {
                    "cell" => Average::Cell,
                    _ => Average::None,
                },
                references: references?,
            })
        })
        .collect()
}

/// What references of sections are read with.
pub(super) struct About<'a> {
    pub(super) names: &'a AllNames,
    pub(super) stages: &'a [Option<Stage>],
    pub(super) file: &'a Path,
}

/// A reference of a section that records these fields.
fn section_reference<const D: usize>(
    node: &Node,
    record: Option<&[Field]>,
    about: &About<'_>,
    problems: &mut Problems,
) -> Option<SectionReference> {
    let of = fields::<D>(std::slice::from_ref(node.get("of")?), problems)?.pop()?;
    if record.is_some_and(|record| !record.contains(&of)) {
        let name = node.text_at("of")?;
        problems
            .error(
                node.place_at("of"),
                format!("the section does not record `{name}`"),
            )
            .help(format!("add \"{name}\" to its `record`"));
        return None;
    }
    let who = "this reference looks at";
    let stage = about
        .names
        .stages
        .find_optional(node, "stage", who, problems);
    let searches = |stage: &Stage| matches!(stage.kind, StageKind::StrengthReduction(_));
    if let Ok(Some(number)) = stage
        && about.stages[number].as_ref().is_some_and(searches)
    {
        problems
            .error(
                node.place_at("stage"),
                "a strength reduction leaves the body as it found it, and no sections",
            )
            .help("name the stage before it");
        return None;
    }
    let reference = super::outputs::curves::reference(node, about.file, problems);
    Some(SectionReference {
        of,
        stage: stage.ok()?,
        reference: reference?,
    })
}

/// A plane in which fields are drawn.
fn cut(node: &Node) -> Option<Cut> {
    let across = node.text_at("across")?;
    let axis = ["x", "y", "z"].iter().position(|own| *own == across)?;
    let at = node.number_at("at")?;
    Some(Cut { axis, at })
}

/// What is written, and where.
pub(super) fn output<const D: usize>(tree: &Node, problems: &mut Problems) -> Option<Output> {
    let node = tree.get("output")?;
    let checkpoint = node.get("checkpoint")?;
    let every = node.get("paraview")?.get("every")?;
    let folder = node.get("folder")?;
    let path = folder.text()?;
    if path.trim().is_empty() || path.chars().any(char::is_control) {
        problems
            .error(folder.place, "this is not the name of a folder")
            .help("write folder = \"results/slope\", or leave it out");
        return None;
    }
    Some(Output {
        folder: PathBuf::from(path),
        paraview: match every.text() {
            Some("never") => Every::Never,
            Some(_) => Every::Stage,
            None => Every::Steps(every.count()?),
        },
        figures: fields::<D>(node.items_at("figures"), problems)?,
        cuts: node
            .items_at("cuts")
            .iter()
            .map(cut)
            .collect::<Option<_>>()?,
        report: node.flag_at("report")?,
        checkpoint_every: checkpoint.count_at("every")?,
        checkpoint_keep: checkpoint.count_at("keep")?,
    })
}
