//! Contact with rigid bodies, below the case files: problems with exact answers and with bounds.

pub(crate) mod anchor;
pub(crate) mod buried;
pub(crate) mod column;
pub(crate) mod embedded;
pub(crate) mod footing;
pub(crate) mod hertz;
pub(crate) mod incline;
pub(crate) mod patch;
pub(crate) mod pipe;
pub(crate) mod places;
pub(crate) mod punch;
pub(crate) mod space;
pub(crate) mod strip;
pub(crate) mod wall;
pub(crate) mod wedge;

use igimp_assembly::{
    Constraints, ContactNode, Interface, ParticleSeed, RigidBody, RigidMotion, SharedLaw,
    StepConditions, StepLoads, Surface,
};
use igimp_cases::CaseError;
use igimp_shape::{Axis, Grid, ShapeError};
use igimp_solver::Accepted;

use crate::continuum::laboratory::filled;

/// Level ground with its surface at y = 0, and the grid around it.
pub(crate) struct Ground {
    pub(crate) seeds: Vec<ParticleSeed<2>>,
    pub(crate) grid: Grid<2>,
}

impl Ground {
    /// Ground between lines of a grid, with `per_direction`² particles in a cell and so many rows of
    /// cells above it.
    pub(crate) fn new(
        x: Vec<f64>,
        mut y: Vec<f64>,
        above: usize,
        per_direction: usize,
    ) -> Result<Self, ShapeError> {
        let soil = Grid::new([Axis::from_nodes(x.clone())?, Axis::from_nodes(y.clone())?]);
        let size = soil.axes[1].spacing(soil.axes[1].cell_count() - 1);
        let top = soil.axes[1].end();
        y.extend((1..=above).map(|row| top + size * row as f64));
        let grid = Grid::new([Axis::from_nodes(x)?, Axis::from_nodes(y)?]);
        let seeds = filled(&soil, per_direction);
        Ok(Self { seeds, grid })
    }

    /// Walls that hold the sides sideways and the bottom in both directions.
    pub(crate) fn held(&self) -> Result<Constraints<2>, CaseError> {
        held(&self.grid)
    }
}

/// Walls of a grid that hold the sides sideways and the bottom in both directions.
pub(crate) fn held(grid: &Grid<2>) -> Result<Constraints<2>, CaseError> {
    let mut constraints = Constraints::free(grid);
    constraints.fix_wall(grid, 0, false, 0)?;
    constraints.fix_wall(grid, 0, true, 0)?;
    constraints.fix_wall(grid, 1, false, 0)?;
    constraints.fix_wall(grid, 1, false, 1)?;
    Ok(constraints)
}

/// Lines of a grid `h` apart between `fine`, and from there to `ends` in cells that grow.
pub(crate) fn graded(h: f64, fine: [f64; 2], ends: [f64; 2], growth: f64) -> Vec<f64> {
    let cells = ((fine[1] - fine[0]) / h).round() as usize;
    let outward = |distance: f64| {
        let (mut lines, mut size, mut at) = (Vec::new(), h, 0.0);
        while at < distance - 0.5 * size {
            size *= growth;
            at += size;
            lines.push(at);
        }
        lines
    };
    let before = outward(fine[0] - ends[0]);
    let mut nodes: Vec<f64> = before.iter().rev().map(|at| fine[0] - at).collect();
    let size = (fine[1] - fine[0]) / cells as f64;
    nodes.extend((0..=cells).map(|k| fine[0] + size * k as f64));
    nodes.extend(outward(ends[1] - fine[1]).iter().map(|at| fine[1] + at));
    nodes
}

/// A body of this outline with the same interface on all sides, its contact nodes about `spacing` apart, with its
/// reference point at `origin`.
pub(crate) fn polygon(
    corners: &[[f64; 2]],
    spacing: f64,
    interface: &Interface,
    origin: [f64; 2],
) -> RigidBody<2> {
    let surface = Surface::polygon(corners, 0.0, spacing).expect("the outline has corners");
    let sides = vec![interface.clone(); surface.side_count()];
    RigidBody::new(surface, sides, origin)
}

/// Conditions of a step without weight.
pub(crate) fn weightless<const D: usize>(
    grid: &Grid<D>,
    constraints: &Constraints<D>,
    law: &SharedLaw,
    motion: RigidMotion<D>,
) -> Result<StepConditions<D>, igimp_assembly::AssemblyError> {
    let loads = StepLoads::gravity([0.0; D]);
    StepConditions::new(grid.clone(), constraints.clone(), loads, vec![law.clone()])?
        .with_motions(vec![motion])
}

/// The force that acts on the first body from outside along prescribed components \[force\].
pub(crate) fn force<const D: usize>(accepted: &Accepted<'_, D>) -> [f64; D] {
    accepted.forces.reactions[accepted.conditions.grid.node_count()]
}

/// The contact nodes of the first body that soil touches: place in space and contact state.
pub(crate) fn closed<const D: usize>(bodies: &[RigidBody<D>]) -> Vec<([f64; D], ContactNode)> {
    let body = &bodies[0];
    let nodes = body.surface.knots();
    let nodes = nodes.iter().zip(&body.contact.knots);
    nodes
        .filter(|(_, node)| node.is_closed)
        .map(|((place, _), node)| (body.pose.into_space(place), *node))
        .collect()
}

/// The largest penetration of the first body \[length\].
pub(crate) fn penetration(bodies: &[RigidBody<2>]) -> f64 {
    let nodes = closed(bodies).into_iter();
    nodes.map(|(_, node)| -node.gap).fold(0.0, f64::max)
}
