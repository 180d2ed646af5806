//! A case in space from a completed tree: plane strain without the parts drawn in the plane.

use std::path::Path;

use igimp_geometry::region::Region;
use igimp_model::{BodyPart, Case, Ground, LoadKind, Material};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::grid::Fit;
use igimp_schema::schema::loads::LoadForm;
use igimp_schema::schema::stages::{Stage, StageForm};
use igimp_schema::text::number;
use igimp_schema::tree::Node;

use super::assemble::{self, GridAndBodies, Surroundings};
use super::bodies;
use super::bodies::sides::{self, Holds};
use super::bodies::site::Soil;
use super::grid::boundaries;
use super::ground::gaps::check_in_space;
use super::{AllNames, loads, reinforcement, rigid, stages_on, things, water};
use crate::build::Thing;
use crate::build::bodies::site::Solids;
use crate::build::context::Context;

impl Soil<3> for Solids {
    fn is_known(&self) -> bool {
        self.is_complete
    }

    fn holds_point(&self, point: &[f64; 3], margin: f64) -> bool {
        let margin = margin.max(self.round_off);
        self.regions
            .iter()
            .any(|region| near(&**region, point, margin))
    }

    fn is_held_by(&self, present: &[bool], point: &[f64; 3], margin: f64) -> bool {
        let bodies = std::iter::zip(present, &self.regions);
        let mut there = bodies.filter(|(present, _)| **present);
        there.any(|(_, region)| near(&**region, point, margin))
    }

    fn bears(&self, body: usize, load: &LoadKind<3>) -> bool {
        let Some(region) = self.regions.get(body).filter(|_| self.is_complete) else {
            return false;
        };
        let margin = (1e-2 * self.cell).max(self.round_off);
        let places = match load {
            LoadKind::RigidFooting { .. } => Vec::new(),
            LoadKind::Pressure { from, to, .. } => loads::space::samples(from, to),
            LoadKind::Patch { plan, level, .. } => loads::space::places(plan, *level, self),
            LoadKind::Point { at, .. } => vec![*at],
        };
        places.iter().any(|at| near(&**region, at, margin))
    }

    fn round_off(&self) -> f64 {
        self.round_off
    }

    fn cell(&self) -> f64 {
        self.cell
    }

    fn ends(&self) -> Option<[[f64; 3]; 2]> {
        self.is_complete.then_some([self.lower, self.upper])
    }

    fn is_off_lines(&self, axis: usize, at: f64) -> bool {
        (self.frame.as_ref()).is_some_and(|frame| frame.is_off_lines(axis, at))
    }
}

/// Whether a place lies in a region, or not further outside than a margin.
fn near(region: &dyn Region<3>, point: &[f64; 3], margin: f64) -> bool {
    let beside = (0..6).map(|side| {
        let mut at = *point;
        at[side / 2] += if side % 2 == 0 { margin } else { -margin };
        at
    });
    let mut places = std::iter::once(*point).chain(beside);
    places.any(|at| region.encloses(at))
}

/// The case; `None` only when a problem was reported, here or before.
pub(super) fn build(
    tree: &Node,
    names: &AllNames,
    file: &Path,
    problems: &mut Problems,
) -> Option<Case<3>> {
    refuse_plane_only(tree, problems);
    let tables = things(Root::<3>::bodies(tree));
    let stages = things(Root::<3>::stages(tree));
    let parts = bodies::bodies::<bodies::Space, _>(tree, (&tables, &stages), names, problems);
    let basics = GridAndBodies::new(tree, names, (&tables, &stages), (parts, &[]), problems);
    let GridAndBodies {
        frame,
        bodies,
        materials,
        sequence,
        ..
    } = &basics;
    let frame = frame.as_ref();
    let soil = Solids::new(bodies, frame);
    let domain = (frame, soil.round_off);
    let ground = (&bodies[..], sequence);
    bodies::check::<bodies::Space, _>((tree, &tables), names, ground, domain, problems);
    let boundaries = Root::boundaries(tree).ok();
    let boundaries = boundaries.and_then(|table| boundaries::boundaries(&table, frame, problems));
    let loads = loads::loads(tree, &soil, (&stages, sequence), problems);
    let rigid = rigid::rigid(tree, &rigid::space::Around(frame), materials, problems);
    rigid::apart::check((tree, frame), &rigid, (&stages, sequence), problems);
    let holds = Holds::new(boundaries.as_ref(), &rigid, (&loads, materials));
    sides::check((tree, frame), &stages, ground, &holds, problems);
    check_in_space(&tables, (bodies, sequence), &soil, problems);
    rigid::stage::check_use(&things(Root::<3>::rigid(tree)), &stages, names, problems);
    let around = water::Around {
        stated: &things(Root::<3>::water(tree)),
        has_rigid: !rigid.is_empty(),
        stages: &stages,
        tree,
        names,
        earth: &soil,
        bodies,
        materials,
        sequence,
    };
    let water = water::conditions(&around, problems);
    water::checks::check(&around, &water, problems);
    let reinforcement = reinforcement::members(tree, &soil, &stages, problems);
    let context = Context {
        tree,
        stages: &stages,
        names,
        materials,
        bodies,
        loads: &loads,
        soil: &soil,
        site: None,
        sequence,
    };
    let built = stages_on(&context, &rigid, &reinforcement, problems);
    check_level(&stages, (bodies, materials), &soil, problems);
    let upon = Surroundings {
        boundaries,
        rigid,
        water,
        reinforcement,
    };
    assemble::assemble((&context, file), &basics, upon, built, problems)
}

/// Reports keys that belong to the plane only.
fn refuse_plane_only(tree: &Node, problems: &mut Problems) {
    for load in things(Root::<3>::loads(tree)).into_iter().flatten() {
        if let LoadForm::RigidFooting(_) = *load.form {
            problems
                .error(
                    load.form.place,
                    "a rigid footing that the grid follows is one of plane strain",
                )
                .help("in space footings are [[rigid]] bodies, or pressures");
        }
    }
    if let Ok(grid) = Root::<3>::grid(tree)
        && let Ok(wishes) = &grid.wishes
        && let Some(fit) = &wishes.fit
        && **fit != Fit::None
    {
        problems
            .error(fit.place, "lines are fitted to bodies in the plane only")
            .help("write lines = { z = [...] }");
    }
}

/// Refuses stresses of level ground in ground that is not level.
fn check_level(
    stages: &[Thing<Stage>],
    (bodies, materials): (&[Option<BodyPart<3>>], &[Option<Material>]),
    soil: &Solids,
    problems: &mut Problems,
) {
    let Some(Some(stage)) = stages.first() else {
        return;
    };
    let StageForm::K0(_) = *stage.form else {
        return;
    };
    let parts: Option<Vec<_>> = (bodies.iter())
        .map(|body| {
            let body = body.as_ref()?;
            Some((body, materials.get(body.material)?.as_ref()?))
        })
        .collect();
    let Some(parts) = parts else { return };
    let ground = Ground::new(parts.iter().copied());
    let levels = parts
        .iter()
        .filter(|(body, _)| body.from_start)
        .flat_map(|(body, _)| {
            let places = ground.places(&*body.region);
            let levels = places
                .iter()
                .filter_map(|place| Some((ground.surface(place)?, *place)));
            levels.collect::<Vec<_>>()
        });
    let levels: Vec<(f64, [f64; 3])> = levels.collect();
    let by_level = |a: &&(f64, [f64; 3]), b: &&(f64, [f64; 3])| a.0.total_cmp(&b.0);
    let (Some(low), Some(high)) = (
        levels.iter().min_by(by_level),
        levels.iter().max_by(by_level),
    ) else {
        return;
    };
    if high.0 - low.0 > 1e-6 * soil.cell {
        // Places are taken a little beside edges.
        let near = |x: f64| number((1e6 * x).round() / 1e6);
        problems
            .error(stage.form.place, "a k0 stage needs level ground")
            .help(format!(
                "the surface is at z = {} m above ({} m, {} m) and at z = {} m above ({} m, {} m)",
                number(low.0),
                near(low.1[0]),
                near(low.1[1]),
                number(high.0),
                near(high.1[0]),
                near(high.1[1])
            ))
            .help("for a slope use a stage of type gravity");
    }
}
