//! The free field beside a wall: a column of the soil that stands there, as it moves with nothing beside it but itself (theory,
//! eq. 77a; Lysmer and Kuhlemeyer 1969).
//!
//! It is one cell wide, has the particles of the first cells of the body, and both its sides move together: waves go up and down
//! in it, and none along. In every step it goes first, by the scheme of the body and on the same ground. Its velocity is what
//! the dashpots of the wall move against, and the force between it and soil of its own kind acts on the wall: level ground does not
//! see that it ends. The body does not act on the column.

use std::collections::BTreeMap;
use std::sync::Arc;

use igimp_assembly::{
    AssemblyError, Constraints, FreeMotion, Geometry, Method, Particles, Stencils, StepConditions,
    System, TieForce, TiedWalls, WallNode, Walls,
};
use igimp_material::TangentKind;
use igimp_shape::{Axis, Grid};

use crate::report::{NodalForces, StepError, StepFailure};

/// A step of particles alone under conditions: the particles after it, and its nodal forces.
pub(crate) type StepOfColumn<'s, const D: usize> = dyn Fn(Particles<D>, &StepConditions<D>) -> Result<(Particles<D>, NodalForces<D>), StepFailure>
    + 's;

/// The stiffness of the ties of a column over that of its soil \[-\]: the shear of soil that is tied across a cell is softer by
/// about a third of its inverse.
const TIE: f64 = 1e6;

/// A column of soil beside a wall, with its own motion.
#[derive(Clone, Debug)]
pub struct FreeField<const D: usize> {
    /// The axis across the wall.
    pub normal: usize,
    /// Whether the wall is the upper end of that axis.
    pub upper: bool,
    /// The particles.
    pub particles: Particles<D>,
    /// The forces at the nodes of its own grid that hold it as it was at the start, and displacements since.
    pub nodes: Arc<Vec<WallNode<D>>>,
}

impl<const D: usize> FreeField<D> {
    /// The column beside a wall of a body, held as it stands by the forces that it has under these conditions; the supports that
    /// the wall replaces hold nothing any more.
    ///
    /// # Errors
    /// [`AssemblyError::NoFreeField`] where no soil touches the wall; as [`System::new`] and [`System::evaluate`].
    pub fn beside(
        particles: &Particles<D>,
        method: &Method,
        conditions: &StepConditions<D>,
        (normal, upper): (usize, bool),
    ) -> Result<Self, AssemblyError> {
        let axis = &conditions.grid.axes[normal];
        let cell = if upper { axis.cell_count() - 1 } else { 0 };
        let is_beside = |particle: usize| axis.cell_at(particles.x[particle][normal]) == Some(cell);
        if !(0..particles.len()).any(is_beside) {
            return Err(AssemblyError::NoFreeField {
                axis: normal,
                upper,
            });
        }
        let mut column = Self {
            normal,
            upper,
            particles: particles.keeping(is_beside)?,
            nodes: Arc::default(),
        };
        column.particles.rest();
        let mut still = column.conditions(conditions)?;
        still.time = None;
        still.walls = None;
        still.ground = None;
        still.damping = None;
        let stencils = Stencils::build(&column.particles, method, &still)?;
        let system = System::new(&column.particles, &stencils, &still, method)?;
        let unmoved = vec![[0.0; D]; system.node_count()];
        let trial = system.evaluate(&unmoved, TangentKind::Elastic)?;
        let held = std::iter::zip(&trial.f_int, system.f_ext()).enumerate();
        column.nodes = Arc::new(
            held.map(|(node, (f_int, f_ext))| WallNode {
                node,
                force: std::array::from_fn(|a| f_int[a] - f_ext[a]),
                displacement: [0.0; D],
            })
            .collect(),
        );
        Ok(column)
    }

    /// The conditions of a step of the body for the column: its grid, the supports of the wall on both sides, and ties.
    fn conditions(&self, body: &StepConditions<D>) -> Result<StepConditions<D>, AssemblyError> {
        let grid = self.grid(&body.grid);
        let mut constraints = Constraints::free(&grid);
        for node in 0..grid.node_count() {
            let at_wall = self.node_of_body(&body.grid, grid.node_place(node));
            for axis in 0..D {
                if let Some(value) = body.constraints.of(at_wall, axis) {
                    constraints.prescribe(node, axis, value)?;
                }
            }
        }
        let walls = body.walls.as_ref().map(|walls| Walls {
            absorbing: (walls.absorbing.iter().copied())
                .filter(|wall| wall.normal != self.normal)
                .collect(),
            tied: Some(TiedWalls {
                axis: self.normal,
                stiffness: TIE,
            }),
            nodes: Arc::clone(&self.nodes),
            beside: Arc::default(),
        });
        let mut column = body.clone();
        column.grid = grid;
        column.constraints = constraints;
        column.motions.clear();
        column.reinforcement.clear();
        column.flow = None;
        column.held = None;
        if let Some(time) = &mut column.time {
            time.must_resolve = false;
        }
        column.with_walls(walls)
    }

    /// The cells of the body's grid that stand beside the wall.
    fn grid(&self, body: &Grid<D>) -> Grid<D> {
        let mut axes = body.axes.clone();
        let nodes = body.axes[self.normal].nodes();
        let first = if self.upper { nodes.len() - 2 } else { 0 };
        let cell = nodes[first..first + 2].to_vec();
        axes[self.normal] = Axis::from_nodes(cell).expect("nodes of an axis ascend");
        Grid::new(axes)
    }

    /// The node of the wall that stands as high as one of the column.
    fn node_of_body(&self, body: &Grid<D>, mut place: [usize; D]) -> usize {
        let last = body.axes[self.normal].node_count() - 1;
        place[self.normal] = if self.upper { last } else { 0 };
        body.node_index(place)
    }

    /// The column after a step under the conditions of the body, and its motion beside the wall.
    fn advanced(
        &self,
        method: &Method,
        of_body: &StepConditions<D>,
        step: &StepOfColumn<'_, D>,
    ) -> Result<(Self, Vec<FreeMotion<D>>), StepFailure> {
        let conditions = self.conditions(of_body)?;
        let (particles, forces) = step(self.particles.clone(), &conditions)?;
        let nodes: Vec<_> = std::iter::zip(self.nodes.iter(), &forces.u)
            .map(|(node, u)| WallNode {
                displacement: std::array::from_fn(|a| node.displacement[a] + u[a]),
                ..*node
            })
            .collect();
        let beside = self.beside_wall((&conditions.grid, &of_body.grid), &nodes, &forces);
        let particles = match method.geometry {
            Geometry::Given => particles,
            Geometry::Moving => self.push_out(particles)?,
        };
        let after = Self {
            particles,
            nodes: Arc::new(nodes),
            ..*self
        };
        Ok((after, beside))
    }

    /// The particles at their places across the wall: the column is the same everywhere along that axis.
    fn push_out(&self, particles: Particles<D>) -> Result<Particles<D>, AssemblyError> {
        let mut fields = particles.into_fields();
        let normal = self.normal;
        for (x, before) in fields.x.iter_mut().zip(&self.particles.x) {
            x[normal] = before[normal];
        }
        Particles::from_fields(fields)
    }

    /// The motion of the column beside every node of the wall. Beside soil that lies higher than the column the ground moves as its top
    /// does, and presses on nothing.
    fn beside_wall(
        &self,
        (grid, of_body): (&Grid<D>, &Grid<D>),
        nodes: &[WallNode<D>],
        forces: &NodalForces<D>,
    ) -> Vec<FreeMotion<D>> {
        let Some(motion) = &forces.motion else {
            return Vec::new();
        };
        let side = usize::from(self.upper);
        let sign = if self.upper { 1.0 } else { -1.0 };
        let of_tie = |tie: &TieForce<D>| {
            let node = tie.nodes[side];
            let at_wall = self.node_of_body(of_body, grid.node_place(node));
            let free = FreeMotion {
                node: at_wall,
                normal: self.normal,
                displacement: [self.nodes[node].displacement, nodes[node].displacement],
                velocity: [motion.before[node], motion.after[node]],
                force: tie.force.map(|force| force.map(|x| sign * x)),
            };
            (at_wall, free)
        };
        let found: BTreeMap<usize, FreeMotion<D>> = forces.ties.iter().map(of_tie).collect();
        let beside = |node: usize| {
            let mut place = grid.node_place(node);
            let at_wall = self.node_of_body(of_body, place);
            if let Some(free) = found.get(&at_wall) {
                return Some(*free);
            }
            while place[D - 1] > 0 {
                place[D - 1] -= 1;
                if let Some(top) = found.get(&self.node_of_body(of_body, place)) {
                    let force = [[0.0; D]; 2];
                    return Some(FreeMotion {
                        node: at_wall,
                        force,
                        ..*top
                    });
                }
            }
            None
        };
        let at_side = |node: &usize| grid.node_place(*node)[self.normal] == side;
        (0..grid.node_count())
            .filter(at_side)
            .filter_map(beside)
            .collect()
    }
}

/// The free fields of a body after a step, and the conditions of that step with their motion there; none for a body
/// without free fields, and in statics.
///
/// # Errors
/// [`StepError`] of a column that finds no equilibrium.
pub(crate) fn go_ahead<const D: usize>(
    free_fields: &[FreeField<D>],
    method: &Method,
    conditions: &StepConditions<D>,
    (from, to): (f64, f64),
    step: &StepOfColumn<'_, D>,
) -> Result<Option<(Vec<FreeField<D>>, StepConditions<D>)>, StepError> {
    let Some(walls) = &conditions.walls else {
        return Ok(None);
    };
    if free_fields.is_empty() || conditions.time.is_none() {
        return Ok(None);
    }
    let (mut after, mut beside) = (Vec::new(), Vec::new());
    let mut advance = || {
        for column in free_fields {
            let (field, motion) = column.advanced(method, conditions, step)?;
            after.push(field);
            beside.extend(motion);
        }
        let walls = Walls {
            beside: Arc::new(std::mem::take(&mut beside)),
            ..walls.clone()
        };
        Ok(conditions.clone().with_walls(Some(walls))?)
    };
    match advance() {
        Ok(conditions) => Ok(Some((after, conditions))),
        Err(failure) => Err(StepError {
            from,
            to,
            residuals: Vec::new(),
            worst: None,
            failure: Box::new(StepFailure::FreeField(Box::new(failure))),
        }),
    }
}
