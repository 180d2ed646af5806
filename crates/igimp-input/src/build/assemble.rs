//! A case of either analysis from its parts: the steps of all analyses.

use std::path::Path;

use igimp_assembly::Method;
use igimp_model::{
    BodyPart, Boundaries, Case, GridSpec, Material, MeshStudy, ReinforcementPart, RigidPart,
    RigidShape, Stage, StageKind, WaterCondition,
};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::bodies::Body;
use igimp_schema::schema::{Root, is_whole, stages as keys};
use igimp_schema::tree::Node;
use igimp_schema::tree::read::{At, Found};

use super::bodies::sequence::Sequence;
use super::grid::{self, Frame};
use super::outputs::{self, checks, curves, study};
use super::stages::{self, construction};
use super::{AllNames, all, materials, title_block};
use crate::build::Thing;
use crate::build::context::Context;

/// Grid, bodies and materials of a case.
pub(super) struct GridAndBodies<const D: usize> {
    pub(super) frame: Option<Frame<D>>,
    pub(super) bodies: Vec<Option<BodyPart<D>>>,
    pub(super) materials: Vec<Option<Material>>,
    pub(super) sequence: Sequence,
    method: Option<Method>,
    grid: Option<GridSpec<D>>,
}

impl<const D: usize> GridAndBodies<D> {
    pub(super) fn new(
        tree: &Node,
        names: &AllNames,
        (stated, stages): (&[Thing<Body>], &[Thing<keys::Stage>]),
        (bodies, rigid): (Vec<Option<BodyPart<D>>>, &[RigidShape]),
        problems: &mut Problems,
    ) -> Self {
        let table = Root::<D>::grid(tree).ok();
        let extent = table.as_ref().and_then(|table| table.extent.as_ref().ok());
        let mut frame = extent.and_then(|extent| grid::frame(extent, problems));
        let materials = materials::materials(tree, &bodies, problems);
        let outlines = (&bodies[..], rigid);
        let grid = (table.as_ref())
            .and_then(|table| grid::grid(table, frame.as_ref(), outlines, problems));
        if let (Some(frame), Some(grid)) = (&mut frame, &grid) {
            frame.axes.clone_from(&grid.axes);
        }
        let has_water = Root::<D>::water(tree).is_ok_and(|water| !water.is_empty());
        Self {
            frame,
            method: table.and_then(|table| grid::method(table.method.as_ref().ok()?)),
            grid,
            materials,
            sequence: Sequence::new((stated, stages), has_water, names, &bodies),
            bodies,
        }
    }
}

/// Supports, structures and water.
pub(super) struct Surroundings<const D: usize> {
    pub(super) boundaries: Option<Boundaries<D>>,
    pub(super) rigid: Vec<Option<RigidPart<D>>>,
    pub(super) water: Vec<Option<WaterCondition>>,
    pub(super) reinforcement: Vec<Option<ReinforcementPart<D>>>,
}

/// The stages, with the checks of their parts.
pub(super) fn stages_of<const D: usize>(
    context: &Context<'_, D>,
    problems: &mut Problems,
) -> Vec<Option<Stage>> {
    let stages = stages::stages(context, problems);
    stages::check_use(context, problems);
    construction::check(context, problems);
    stages
}

/// Every item of a list, as far as it was found right; nothing if one was not.
fn each<T, U>(
    list: Found<Vec<Found<T>>>,
    mut build: impl FnMut(&At<T>) -> Option<U>,
) -> Option<Vec<U>> {
    let list = list.ok()?.value;
    let built = list.iter().map(|item| build(item.as_ref().ok()?));
    all(built.collect())
}

/// The case; `None` only when a problem was reported, here or before.
pub(super) fn assemble<const D: usize>(
    (context, file): (&Context<'_, D>, &Path),
    basics: &GridAndBodies<D>,
    upon: Surroundings<D>,
    stages: Vec<Option<Stage>>,
    problems: &mut Problems,
) -> Option<Case<D>> {
    let Context {
        tree,
        names,
        loads,
        soil,
        ..
    } = *context;
    let solver = Root::<D>::solver(tree).map(|solver| outputs::solver(&solver, problems));
    let output = Root::<D>::output(tree);
    // A stage that was found wrong may be one.
    let is_motion = |stage: &Option<Stage>| {
        let kind = stage.as_ref().map(|stage| &stage.kind);
        matches!(kind, None | Some(StageKind::Dynamic(_)))
    };
    let moves = stages.iter().any(is_motion);
    let monitors = each(Root::<D>::monitors(tree), |monitor| {
        outputs::monitor(monitor, soil, moves, problems)
    });
    let about = outputs::About {
        names,
        stages: &stages,
        file,
        moves,
        has_cuts: (output.iter()).any(|output| output.cuts.iter().any(|cuts| !cuts.is_empty())),
    };
    let sections = each(Root::<D>::sections(tree), |section| {
        outputs::section(section, &about, soil, problems)
    });
    let curves = each(Root::<D>::curves(tree), |curve| {
        curves::curve(curve, names, loads, file, problems)
    });
    let is_whole = is_whole(tree);
    let checks = each(Root::<D>::checks(tree), |check| {
        checks::check(check, is_whole, names, loads, &stages, problems)
    });
    let output = output
        .ok()
        .and_then(|output| outputs::output(&output, context, moves, problems));
    let meshes = Root::<D>::mesh_study(tree).map(|study| study.value.meshes);

    let (case, meshes) = (Root::<D>::case(tree).ok()?, meshes.ok()?);
    let grid = Root::<D>::grid(tree).ok()?;
    let case = Case {
        water_unit_weight: *case.water_unit_weight,
        water: all(upon.water)?,
        title: case.title.value.clone(),
        title_block: title_block(&case),
        gravity: *case.gravity,
        grid: basics.grid.clone()?,
        method: basics.method.clone()?,
        materials: all(basics.materials.clone())?,
        bodies: all(basics.bodies.clone())?,
        boundaries: upon.boundaries?,
        loads: all(loads.to_vec())?,
        rigid: all(upon.rigid)?,
        reinforcement: all(upon.reinforcement)?,
        stages: all(stages)?,
        solver: solver.ok()?,
        given_solver: None,
        monitors: monitors?,
        sections: sections?,
        curves: curves?,
        checks: checks?,
        mesh_study: MeshStudy { meshes: *meshes },
        output: output?,
    };
    let case = case.refined(**grid.refine.as_ref().ok()?);
    study::check(tree, &meshes, &case, problems);
    materials::check_on_cells(&case, problems);
    materials::check_lengths(&case, problems);
    materials::check_rates(&case, problems);
    materials::check_unused(tree, &case, problems);
    stages::memory::check(tree, &case, problems);
    Some(case)
}
