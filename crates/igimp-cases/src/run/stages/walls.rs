//! Walls of the grid behind which the ground goes on, and ground that moves, in a stage that takes time (theory, eqs. 69 to 74).

use std::collections::BTreeMap;
use std::sync::Arc;

use igimp_assembly::{
    AbsorbingWall, AssemblyError, Constraints, GroundMotion, Method, Stencils, StepConditions,
    System, TiedWalls, WallNode, Walls,
};
use igimp_material::TangentKind;
use igimp_model::{Base, Dynamic, StageWalls};
use igimp_shape::Grid;
use igimp_solver::FreeField;

use crate::error::CaseError;
use crate::run::model::Model;
use crate::run::state::{Controls, State, WallTrack};

/// The walls with dashpots, by axis and whether it is the upper end.
fn with_dashpots(dynamic: &Dynamic) -> Vec<(usize, bool)> {
    let StageWalls {
        absorbing,
        free_field,
        ..
    } = &dynamic.walls;
    absorbing.iter().chain(free_field).copied().collect()
}

/// The walls whose supports a stage lets go, by axis and whether it is the upper end.
fn released(dynamic: &Dynamic) -> Vec<(usize, bool)> {
    let mut walls = with_dashpots(dynamic);
    if dynamic.walls.tied {
        walls.extend([(0, false), (0, true)]);
    }
    walls
}

/// The components of displacement by node that the supports of these walls hold, and nothing else does.
fn held_by_walls<const D: usize>(
    model: &Model<'_, D>,
    grid: &Grid<D>,
    walls: &[(usize, bool)],
) -> Result<Vec<(usize, [bool; D])>, AssemblyError> {
    if walls.is_empty() {
        return Ok(Vec::new());
    }
    let (all, others) = (model.supports(grid, &[])?, model.supports(grid, walls)?);
    let is_at = |place: &[usize; D]| {
        walls.iter().any(|&(axis, upper)| {
            let last = grid.axes[axis].node_count() - 1;
            place[axis] == if upper { last } else { 0 }
        })
    };
    let of = |constraints: &Constraints<D>, node, axis| constraints.of(node, axis).is_some();
    Ok((0..grid.node_count())
        .filter(|&node| is_at(&grid.node_place(node)))
        .map(|node| {
            let is_held = |axis| of(&all, node, axis) && !of(&others, node, axis);
            (node, std::array::from_fn(is_held))
        })
        .collect())
}

/// The tracks of the nodes of the walls as a stage begins: the forces of the supports that it lets go. Components that the
/// motion before had already let go keep theirs.
pub(super) fn begin<const D: usize>(
    model: &Model<'_, D>,
    state: &State<D>,
    method: &Method,
    dynamic: &Dynamic,
) -> Result<Vec<WallTrack>, CaseError> {
    let controls = &state.controls;
    let conditions = model.conditions(controls, controls, 0.0)?;
    let nodes = held_by_walls(model, &conditions.grid, &released(dynamic))?;
    if nodes.is_empty() {
        return Ok(Vec::new());
    }
    let particles = &state.body.particles;
    let stencils = Stencils::build_under(particles, method, &conditions, &state.body.load_points)?;
    let structures = state.body.structures();
    let system = System::with_structures(particles, &structures, &stencils, &conditions, method)?;
    let still = vec![[0.0; D]; system.node_count()];
    let trial = system.evaluate(&still, TangentKind::Elastic)?;
    let reactions = system.reactions(&trial);
    let before: BTreeMap<usize, &WallTrack> =
        controls.walls.iter().map(|old| (old.node, old)).collect();
    Ok(nodes
        .into_iter()
        .map(|(node, is_held)| {
            let mut track = WallTrack {
                node,
                is_released: [false; 3],
                force: [0.0; 3],
                displacement: [0.0; 3],
            };
            for axis in (0..D).filter(|&axis| is_held[axis]) {
                track.is_released[axis] = true;
                match before.get(&node).filter(|old| old.is_released[axis]) {
                    Some(old) => {
                        track.force[axis] = old.force[axis];
                        track.displacement[axis] = old.displacement[axis];
                    }
                    None => track.force[axis] = reactions[node][axis],
                }
            }
            track
        })
        .collect())
}

/// Lets go components held by these walls alone.
fn release<const D: usize>(
    model: &Model<'_, D>,
    walls: &[(usize, bool)],
    conditions: &mut StepConditions<D>,
) -> Result<(), AssemblyError> {
    for (node, is_held) in held_by_walls(model, &conditions.grid, walls)? {
        for axis in (0..D).filter(|&axis| is_held[axis]) {
            conditions.constraints.release(node, axis)?;
        }
    }
    Ok(())
}

/// The columns in free field beside the walls of a stage as it begins: one that a motion before had goes on.
pub(super) fn free_fields<const D: usize>(
    model: &Model<'_, D>,
    state: &State<D>,
    method: &Method,
    dynamic: &Dynamic,
) -> Result<Vec<FreeField<D>>, CaseError> {
    let sides = &dynamic.walls.free_field;
    if sides.is_empty() {
        return Ok(Vec::new());
    }
    let controls = &state.controls;
    let mut conditions = model.conditions(controls, controls, 0.0)?;
    release(model, &released(dynamic), &mut conditions)?;
    let body = &state.body;
    let beside = |&side: &(usize, bool)| {
        let mut before = body.free_fields.iter();
        match before.find(|column| (column.normal, column.upper) == side) {
            Some(column) => Ok(column.clone()),
            None => Ok(FreeField::beside(
                &body.particles,
                method,
                &conditions,
                side,
            )?),
        }
    };
    sides.iter().map(beside).collect()
}

/// The conditions of a step with the walls, the motion of the ground and the damping of its stage.
pub(crate) fn shaken<const D: usize>(
    model: &Model<'_, D>,
    dynamic: &Dynamic,
    (began, before, after): (f64, &Controls, &Controls),
    mut conditions: StepConditions<D>,
) -> Result<StepConditions<D>, AssemblyError> {
    let walls = released(dynamic);
    release(model, &walls, &mut conditions)?;
    let walls = (!walls.is_empty()).then(|| walls_of(model, dynamic, before));
    let ground = dynamic.ground_motion.as_ref().map(|motion| {
        let mean = |from: f64, to: f64| {
            let mut all = [0.0; D];
            if to > from {
                all[motion.axis] = (motion.velocity(to) - motion.velocity(from)) / (to - from);
            }
            all
        };
        let [from, to] = [before.time - began, after.time - began];
        GroundMotion {
            acceleration: mean(from, to),
            earlier: mean(from - before.last_step, from),
        }
    });
    conditions
        .with_walls(walls)?
        .with_ground(ground)?
        .with_damping(dynamic.rayleigh)
}

/// The walls as a step begins.
fn walls_of<const D: usize>(
    model: &Model<'_, D>,
    dynamic: &Dynamic,
    controls: &Controls,
) -> Walls<D> {
    let (lower, upper) = (model.case.grid.lower(), model.case.grid.upper());
    let length = (0..D).map(|axis| upper[axis] - lower[axis]);
    let spring = dynamic.walls.springs / length.fold(0.0, f64::max);
    let compliant = (dynamic.ground_motion.as_ref())
        .filter(|motion| motion.base == Base::Compliant)
        .map(|motion| motion.axis);
    let wall = |&(normal, upper): &(usize, bool)| AbsorbingWall {
        normal,
        upper,
        spring: std::array::from_fn(|axis| {
            let moves = compliant == Some(axis) && (normal, upper) == (D - 1, false);
            if moves { 0.0 } else { spring }
        }),
    };
    let node = |track: &WallTrack| WallNode {
        node: track.node,
        force: std::array::from_fn(|axis| track.force[axis]),
        displacement: std::array::from_fn(|axis| track.displacement[axis]),
    };
    Walls {
        absorbing: with_dashpots(dynamic).iter().map(wall).collect(),
        tied: dynamic.walls.tied.then(|| TiedWalls::across(0)),
        nodes: Arc::new(controls.walls.iter().map(node).collect()),
        beside: Arc::default(),
    }
}
