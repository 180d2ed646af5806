//! A case of either analysis from its parts: what the analyses do alike.

use std::path::Path;

use igimp_assembly::Method;
use igimp_model::{
    BodyPart, Boundaries, Case, GridSpec, Material, ReinforcementPart, RigidPart, Stage,
    WaterCondition,
};
use igimp_schema::diagnostic::Problems;
use igimp_schema::tree::Node;

use super::bodies::sequence::Sequence;
use super::grid::{self, Frame};
use super::outputs::{self, checks, curves, study};
use super::stages::{self, construction};
use super::{AllNames, all, materials, title_block};
use crate::build::context::Context;

/// What everything else is held against.
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
        bodies: Vec<Option<BodyPart<D>>>,
        problems: &mut Problems,
    ) -> Self {
        let mut frame = grid::frame(tree, problems);
        let materials = materials::materials(tree, &bodies, problems);
        let grid = grid::grid(tree, frame.as_ref(), &bodies, problems);
        if let (Some(frame), Some(grid)) = (&mut frame, &grid) {
            frame.axes.clone_from(&grid.axes);
        }
        Self {
            frame,
            method: grid::method(tree),
            grid,
            materials,
            sequence: Sequence::new(tree, names, &bodies),
            bodies,
        }
    }
}

/// What stands in the ground and on it.
pub(super) struct Surroundings<const D: usize> {
    pub(super) boundaries: Option<Boundaries<D>>,
    pub(super) rigid: Vec<Option<RigidPart<D>>>,
    pub(super) water: Vec<Option<WaterCondition>>,
    pub(super) reinforcement: Vec<Option<ReinforcementPart<D>>>,
}

/// The stages, with the checks of what they use.
pub(super) fn stages_of<const D: usize>(
    context: &Context<'_, D>,
    problems: &mut Problems,
) -> Vec<Option<Stage>> {
    let stages = stages::stages(context, problems);
    stages::check_use(context, problems);
    construction::check(context, problems);
    stages
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
    let solver = outputs::solver(tree, &basics.materials, problems);
    let monitors = outputs::monitors(tree, soil, problems);
    let about = outputs::About {
        names,
        stages: &stages,
        file,
    };
    let sections = outputs::sections(tree, &about, soil, problems);
    let curves = curves::curves(tree, names, loads, file, problems);
    let checks = checks::checks(tree, names, loads, &stages, problems);
    let output = outputs::output::<D>(tree, problems);
    let mesh_study = study::mesh_study(tree);

    let case = tree.get("case")?;
    let case = Case {
        water_unit_weight: case.number_at("water_unit_weight")?,
        water: all(upon.water)?,
        title: case.text_at("title")?.to_owned(),
        title_block: title_block(case),
        gravity: case.number_at("gravity")?,
        grid: basics.grid.clone()?,
        method: basics.method.clone()?,
        materials: all(basics.materials.clone())?,
        bodies: all(basics.bodies.clone())?,
        boundaries: upon.boundaries?,
        loads: all(loads.to_vec())?,
        rigid: all(upon.rigid)?,
        reinforcement: all(upon.reinforcement)?,
        stages: all(stages)?,
        solver: solver?,
        given_solver: None,
        monitors: all(monitors)?,
        sections: all(sections)?,
        curves: all(curves)?,
        checks: all(checks)?,
        mesh_study: mesh_study?,
        output: output?,
    };
    let case = case.refined(tree.get("grid")?.count_at("refine")?);
    study::check(tree, &case, problems);
    Some(case)
}
