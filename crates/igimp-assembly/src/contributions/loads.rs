//! Nodal forces of gravity, of loaded points and of drag (theory, eqs. 2, 8f and 38).

use igimp_material::ConstitutiveModel;
use igimp_shape::Grid;

use crate::conditions::StepConditions;
use crate::conditions::loads::{LoadPoint, StepLoads};
use crate::conditions::unbalanced::UnbalancedForces;
use crate::contributions::couplings::{Coupling, Couplings};
use crate::contributions::dropped::shares_of_carried;
use crate::error::{AssemblyError, padded};
use crate::laws::SharedLaw;
use crate::step::stencils::Stencils;
use crate::step::unknowns::Unknowns;

/// A loaded point acts on soil that is no further away, in cells \[-\].
const REACH: f64 = 0.25;

/// Loaded points and the soil that carries them.
impl<const D: usize> LoadPoint<D> {
    /// The point put back on soil, where it left the last cell that holds some by no more than [`REACH`] of a cell: on the
    /// nearest face of that cell. Particles and points drift apart by round-off and more, and a face that lies on a
    /// line of the grid is then beyond it.
    #[must_use]
    pub(crate) fn on_soil(&self, grid: &Grid<D>, stencils: &Stencils<D>) -> Self {
        let rests = |x: &[f64; D]| {
            let supports = Self { x: *x, ..*self }.supports(grid, 0);
            supports.is_ok_and(|supports| {
                let mut carried = stencils.carried(&supports).into_iter();
                carried.all(|s| s.value <= 0.0 || stencils.node_volume(s.node) > 0.0)
            })
        };
        let Some(cell) = grid.cell_at(&self.x).filter(|_| !rests(&self.x)) else {
            return *self;
        };
        // The nearest line of each axis, and how far off it is in cells.
        let lines: [(f64, f64); D] = std::array::from_fn(|axis| {
            let along = &grid.axes[axis];
            let place = (self.x[axis] - along.nodes()[cell[axis]]) / along.spacing(cell[axis]);
            let line = cell[axis] + usize::from(place > 0.5);
            (along.nodes()[line], place.min(1.0 - place))
        });
        let moved = (1..1_usize << D).map(|axes| {
            let goes = |axis: usize| axes >> axis & 1 == 1;
            let way = (0..D).filter(|&axis| goes(axis)).map(|axis| lines[axis].1);
            let x = std::array::from_fn(|axis| {
                if goes(axis) {
                    lines[axis].0
                } else {
                    self.x[axis]
                }
            });
            (way.fold(0.0, f64::max), x)
        });
        let near = moved.filter(|(way, x)| *way <= REACH && rests(x));
        let nearest = near.min_by(|(a, _), (b, _)| a.total_cmp(b));
        nearest.map_or(*self, |(_, x)| Self { x, ..*self })
    }

    /// The point carried along by nodal step displacements `u` \[length\].
    ///
    /// # Errors
    /// [`AssemblyError::LoadPoint`] when it is not on the grid.
    pub fn carried(
        &self,
        grid: &Grid<D>,
        stencils: &Stencils<D>,
        point: usize,
        u: &[[f64; D]],
    ) -> Result<Self, AssemblyError> {
        let mut carried = self.on_soil(grid, stencils);
        for support in carried.supports(grid, point)? {
            for axis in 0..D {
                carried.x[axis] += support.value * u[support.node][axis];
            }
        }
        Ok(carried)
    }
}

/// The weight of the body, by node \[force\].
pub(crate) fn weight<const D: usize>(
    grid: &Grid<D>,
    stencils: &Stencils<D>,
    loads: &StepLoads<D>,
) -> Vec<[f64; D]> {
    (0..grid.node_count())
        .map(|node| loads.gravity.map(|g| stencils.node_mass(node) * g))
        .collect()
}

/// Adds to the nodal external force f_ext the weight that the variation of stress within cells carries and shared
/// gradients do not see, by node \[force\] (theory, eq. 8f).
pub(crate) fn add_variation_of_weight<const D: usize>(
    stencils: &Stencils<D>,
    laws: &[SharedLaw],
    gravity: &[f64; D],
    f_ext: &mut [[f64; D]],
) {
    for (law, moments) in laws.iter().zip(stencils.moments()) {
        let weight = gravity.iter().map(|g| g * g).sum::<f64>().sqrt() * moments.layer;
        let gain = gain_at_failure(&**law, weight);
        if gain == 0.0 {
            continue;
        }
        for (node, moment) in moments.by_node.iter().enumerate() {
            for carrier in stencils.carriers(node) {
                let force = &mut f_ext[carrier.node];
                for a in 0..D {
                    let along: f64 = (0..D).map(|b| moment[a][b] * gravity[b]).sum();
                    force[a] += carrier.weight * (gain * along);
                }
            }
        }
    }
}

/// Cohesion over the weight of a layer of one cell from which on the variation of stress is none of the soil's
/// concern \[-\] (theory, eq. 8f).
const COHESIVE: f64 = 0.1;

/// How much of the unit weight the horizontal stress and the shear of a long slope gain across a cell where it fails along
/// its face, cos 2φ, and none where that is negative; less with cohesion against the weight of a layer of one cell
/// \[force/length²\], and none from a tenth of it on \[-\] (theory, eq. 8f).
fn gain_at_failure(law: &dyn ConstitutiveModel, weight: f64) -> f64 {
    let Some(strength) = law.shear_strength().filter(|_| weight > 0.0) else {
        return 0.0;
    };
    let without_cohesion = (1.0 - strength.cohesive / (COHESIVE * weight)).max(0.0);
    without_cohesion * (2.0 * strength.friction_angle).cos().max(0.0)
}

/// Adds the force of loaded points to the nodal external force f_ext, by node \[force\]. The share of
/// dropped nodes is handed on: no force is lost.
pub(crate) fn add_force_of_points<const D: usize>(
    f_ext: &mut [[f64; D]],
    points: &[LoadPoint<D>],
    conditions: &StepConditions<D>,
    stencils: &Stencils<D>,
    unknowns: &Unknowns<D>,
) -> Result<(), AssemblyError> {
    let StepConditions {
        grid,
        constraints,
        loads,
        ..
    } = conditions;
    let held = |node: usize| (0..D).all(|axis| constraints.of(node, axis).is_some());
    let is_dropped = |node: usize| !unknowns.is_active(node) && !held(node);
    for (index, point) in points.iter().enumerate() {
        let factor = loads.factors.get(point.load).copied().unwrap_or(0.0);
        if factor == 0.0 {
            continue;
        }
        let unsupported = || AssemblyError::UnsupportedLoad {
            point: index,
            position: padded(&point.x),
        };
        let point = point.on_soil(grid, stencils);
        let supports = stencils.carried(&point.supports(grid, index)?);
        for support in &supports {
            if support.value > 0.0 && stencils.node_volume(support.node) == 0.0 {
                return Err(unsupported());
            }
        }
        let shares = shares_of_carried(grid, unknowns, is_dropped, &point.x, &supports);
        for (node, share) in shares.ok_or_else(unsupported)? {
            for axis in 0..D {
                f_ext[node][axis] += share * factor * point.force[axis];
            }
        }
    }
    Ok(())
}

/// Drag by node: force per step displacement \[force/length\]. Nodes without mass have none.
pub(crate) fn nodal_drag<const D: usize>(
    grid: &Grid<D>,
    stencils: &Stencils<D>,
    drag: f64,
) -> Couplings {
    let nodes = 0..grid.node_count();
    let couplings = nodes.map(|node| Coupling {
        row: node,
        column: node,
        stiffness: drag * stencils.node_mass(node),
    });
    Couplings(couplings.filter(|c| c.stiffness > 0.0).collect())
}

/// Adds forces that hold the body to the nodal external force. The force of a node that touches no soil any more is let go.
pub(crate) fn add_unbalanced_forces<const D: usize>(
    held: &UnbalancedForces<D>,
    stencils: &Stencils<D>,
    f_ext: &mut [[f64; D]],
) {
    for (node, force) in held.forces.iter().enumerate() {
        for carrier in stencils.carriers(node) {
            if stencils.node_volume(carrier.node) > 0.0 {
                for axis in 0..D {
                    f_ext[carrier.node][axis] += carrier.weight * (held.share * force[axis]);
                }
            }
        }
    }
}
