//! Builds a [`Case`] from a completed tree, with the checks that need more than one value.
//!
//! Every part is built as far as it can be, so that all problems are found at once.

mod assemble;
mod bodies;
mod context;
mod derive;
mod grid;
mod ground;
mod loads;
mod materials;
mod outputs;
mod reinforcement;
mod rigid;
mod space;
mod stages;
mod water;

use std::path::Path;

use igimp_model::{
    AnyCase, Case, Material, Quantity, ReinforcementPart, RigidPart, Stage, TitleBlock,
};
use igimp_schema::complete::plausible;
use igimp_schema::diagnostic::Problems;
use igimp_schema::names::Names;
use igimp_schema::schema::stages::StageForm;
use igimp_schema::schema::{Analysis, CaseHead, FORMAT, Root};
use igimp_schema::tree::read::{At, Found};
use igimp_schema::tree::{Node, Wrong};

use crate::build::grid::boundaries;
use crate::build::outputs::quantities;
use assemble::{GridAndBodies, Surroundings};
use bodies::Plane;
use bodies::sides::{self, Holds};
use bodies::site::Site;
use context::Context;
use ground::layers::{Layers, check_stiffness};
use stages::idle;

/// The names in a file, by their kinds.
struct AllNames {
    materials: Names,
    bodies: Names,
    loads: Names,
    rigid: Names,
    water: Names,
    reinforcement: Names,
    stages: Names,
    monitors: Names,
    /// Discharges that seepage has, by their names.
    discharges: Vec<(String, Quantity)>,
}

impl AllNames {
    fn new(tree: &Node, problems: &mut Problems) -> Self {
        let materials = tree.get("materials").map_or(&[][..], Node::entries);
        let materials = materials
            .iter()
            .map(|entry| (Some(entry.key.as_str()), entry.key_place));
        let boxes = tree.get("boundaries").and_then(|part| part.get("boxes"));
        Names::of_list("box", boxes, problems);
        for (of, key) in [
            ("section", "sections"),
            ("curve", "curves"),
            ("check", "checks"),
        ] {
            Names::of_list(of, tree.get(key), problems);
        }
        Self {
            materials: Names::new("material", materials, problems),
            bodies: Names::of_list("body", tree.get("bodies"), problems),
            loads: Names::of_list("load", tree.get("loads"), problems),
            rigid: Names::of_list("rigid body", tree.get("rigid"), problems),
            water: Names::of_list("water condition", tree.get("water"), problems),
            reinforcement: Names::of_list("reinforcement", tree.get("reinforcement"), problems),
            stages: Names::of_list("stage", tree.get("stages"), problems),
            monitors: Names::of_list("monitor", tree.get("monitors"), problems),
            discharges: quantities::discharges(tree),
        }
    }
}

/// The case that a completed tree states; values that follow from others are put into the tree.
///
/// `None` only when a problem was reported, here or before.
pub(super) fn build(tree: &mut Node, file: &Path, problems: &mut Problems) -> Option<AnyCase> {
    derive::derive(tree, file);
    let tree = &*tree;
    let names = AllNames::new(tree, problems);
    header(tree, problems);
    let case = case(tree, &names, file, problems);
    if problems.errors() == 0 {
        plausible::check(tree, problems);
    }
    case
}

/// The case by its analysis.
fn case(tree: &Node, names: &AllNames, file: &Path, problems: &mut Problems) -> Option<AnyCase> {
    let analysis = CaseHead::analysis(tree.get("case")?);
    match analysis.map_or(Analysis::PlaneStrain, |value| *value) {
        Analysis::Space => space::build(tree, names, file, problems).map(AnyCase::Space),
        Analysis::PlaneStrain => in_plane(tree, names, file, problems).map(AnyCase::Plane),
        Analysis::Axisymmetric => in_plane(tree, names, file, problems)
            .and_then(|case| grid::axisymmetric::section(tree, case, problems))
            .map(AnyCase::Plane),
    }
}

/// The materials of a completed tree that holds nothing else; none that a problem was reported of.
pub(super) fn materials_alone(tree: &mut Node, problems: &mut Problems) -> Option<Vec<Material>> {
    derive::derive_drainage(tree);
    header(tree, problems);
    let materials = all(materials::materials::<2>(tree, &[], problems));
    if problems.errors() == 0 {
        plausible::check(tree, problems);
    }
    materials
}

/// The same for a case in the plane.
fn in_plane(
    tree: &Node,
    names: &AllNames,
    file: &Path,
    problems: &mut Problems,
) -> Option<Case<2>> {
    let tables = things(Root::<2>::bodies(tree));
    let stages = things(Root::<2>::stages(tree));
    let parts = bodies::bodies::<Plane, _>(tree, (&tables, &stages), names, problems);
    let outlines = rigid::plane::outlines(tree);
    let parts = (parts, outlines.as_slice());
    let basics = GridAndBodies::new(tree, names, (&tables, &stages), parts, problems);
    let GridAndBodies {
        bodies,
        materials,
        sequence,
        ..
    } = &basics;
    let site = Site::new(basics.frame.clone(), bodies, sequence);
    let domain = (site.frame.as_ref(), site.round_off);
    bodies::check::<Plane, 2>((tree, &tables), names, (bodies, sequence), domain, problems);
    let boundaries = Root::boundaries(tree).ok();
    let boundaries = boundaries.and_then(|keys| boundaries::boundaries(&keys, domain.0, problems));
    let layers = Layers {
        tree,
        stated: &tables,
        bodies,
        materials,
        site: &site,
        sequence,
    };
    ground::layers::check(&layers, problems);
    let loads = loads::loads(tree, &site, (&stages, sequence), problems);
    let around = rigid::plane::Around {
        site: &site,
        loads: &loads,
        stages: &stages,
        sequence,
    };
    let rigid = rigid::rigid(tree, &around, materials, problems);
    let frame = site.frame.as_ref();
    rigid::apart::check((tree, frame), &rigid, (&stages, sequence), problems);
    let held_by = (boundaries.as_ref(), rigid.as_slice());
    bodies::check_support(&tables, bodies, held_by, &site, problems);
    let holds = Holds::new(boundaries.as_ref(), &rigid, (&loads, materials));
    let ground = (&bodies[..], sequence);
    sides::check((tree, frame), &stages, ground, &holds, problems);
    rigid::stage::check_use(&things(Root::<2>::rigid(tree)), &stages, names, problems);
    let around = water::Around {
        stated: &things(Root::<2>::water(tree)),
        has_rigid: !rigid.is_empty(),
        stages: &stages,
        tree,
        names,
        earth: &site,
        bodies,
        materials,
        sequence,
    };
    let water = water::conditions(&around, problems);
    water::checks::check(&around, &water, problems);
    let reinforcement = reinforcement::members(tree, &site, &stages, problems);
    let context = Context {
        tree,
        stages: &stages,
        names,
        materials,
        bodies,
        loads: &loads,
        soil: &site,
        site: Some(&site),
        sequence,
    };
    let built = stages_on(&context, &rigid, &reinforcement, problems);
    let upon = Surroundings {
        boundaries,
        rigid,
        water,
        reinforcement,
    };
    assemble::assemble((&context, file), &basics, upon, built, problems)
}

/// The stages on all other parts, with the checks of several of them.
fn stages_on<const D: usize>(
    context: &Context<'_, D>,
    rigid: &[Option<RigidPart<D>>],
    reinforcement: &[Option<ReinforcementPart<D>>],
    problems: &mut Problems,
) -> Vec<Option<Stage>> {
    reinforcement::check_searches(context.stages, context.names, problems);
    reinforcement::check_held(context, reinforcement, problems);
    let built = assemble::stages_of(context, problems);
    idle::check(context, rigid, &built, problems);
    let (tree, bodies, materials) = (context.tree, context.bodies, context.materials);
    check_stiffness((tree, bodies, materials), &built, gravity(tree), problems);
    built
}

/// The head of the report.
fn title_block(case: &CaseHead) -> TitleBlock {
    let words = |key: &Option<At<String>>| key.as_ref().map(|text| text.value.clone());
    TitleBlock {
        project: words(&case.project),
        client: words(&case.client),
        author: words(&case.author),
        revision: words(&case.revision),
    }
}

/// An item of a list, if it was found right.
type Thing<T> = Option<At<T>>;

/// The items of a list, as far as each was found right.
fn things<T>(list: Found<Vec<Found<T>>>) -> Vec<Thing<T>> {
    let items = list.map_or_else(|Wrong| Vec::new(), |list| list.value);
    items.into_iter().map(Result::ok).collect()
}

fn all<T>(parts: Vec<Option<T>>) -> Option<Vec<T>> {
    parts.into_iter().collect()
}

/// Acceleration of gravity \[m/s²\].
fn gravity(tree: &Node) -> Option<f64> {
    let gravity = tree.get("case").map(CaseHead::gravity)?.ok()?;
    Some(*gravity)
}

/// Warns of gravity that no stage raises, also where none is stated, as it is there by default.
fn acts(tree: &Node, problems: &mut Problems) {
    let stages = things(Root::<2>::stages(tree));
    let raises = |form: &StageForm| {
        matches!(
            form,
            StageForm::Gravity(_)
                | StageForm::K0(_)
                | StageForm::Dynamic(_)
                | StageForm::StrengthReduction(_)
                | StageForm::RunOut(_)
        )
    };
    let all = tree.get("stages").map_or(0, |list| list.items().len());
    if let Some(first) = stages.first().and_then(Option::as_ref)
        && stages.len() == all
        && gravity(tree).is_some_and(|value| value > 0.0)
        && stages
            .iter()
            .all(|stage| stage.as_ref().is_some_and(|stage| !raises(&stage.form)))
    {
        problems
            .warning(
                first.form.place,
                "gravity never acts: no stage is of type gravity, k0 or dynamic",
            )
            .help("begin with a stage of type gravity, or set gravity = \"0 m/s2\" in [case] if nothing is to weigh");
    }
}

/// Checks the version of the format, and that gravity is there where it is raised.
fn header(tree: &Node, problems: &mut Problems) {
    if let Ok(version) = Root::<2>::igimp(tree)
        && *version > FORMAT as usize
    {
        problems
            .error(
                version.place,
                format!(
                    "this file has input format {}, newer than this program's",
                    *version
                ),
            )
            .help(format!("this program reads igimp = {FORMAT}"));
    }
    if gravity(tree) == Some(0.0) {
        for stage in things(Root::<2>::stages(tree)).into_iter().flatten() {
            let common = stage.common.as_ref();
            let consolidates = common.is_ok_and(|table| !matches!(table.consolidation, Ok(None)));
            let does_more = consolidates || !stage.installs().is_empty();
            if let (StageForm::Gravity(_) | StageForm::K0(_), false) = (&*stage.form, does_more) {
                let kind = stage.form.name();
                problems
                    .warning(
                        stage.form.place,
                        format!("this stage of type {kind} does nothing: gravity is 0"),
                    )
                    .help("set gravity in [case], or remove the stage");
            }
        }
    }
    acts(tree, problems);
}
