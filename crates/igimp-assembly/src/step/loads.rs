//! What acts on a body in a step: gravity on every particle, forces on points that the soil carries
//! along, and drag against motion (theory, eqs. 2 and 38).

use igimp_material::ConstitutiveModel;
use igimp_shape::{Grid, Linear, Scratch, Support, supports};

use crate::contributions::couplings::{Coupling, Couplings};
use crate::equations::unknowns::Unknowns;
use crate::error::AssemblyError;
use crate::step::dropped::shares_of_carried;
use crate::step::stencils::Stencils;
use crate::step::step_conditions::{SharedLaw, StepConditions};
use crate::step::supports::padded;

/// A force on a point that moves with the soil. Its direction stays (dead load).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadPoint<const D: usize> {
    /// Position \[length\].
    pub x: [f64; D],
    /// Force at load factor 1 \[force; per unit thickness in plane strain\].
    pub force: [f64; D],
    /// Index of its factor in [`StepLoads::factors`]; points of one load share it.
    pub load: usize,
}

impl<const D: usize> LoadPoint<D> {
    /// A traction on a straight edge, as `count` equal points in the middle of equal parts; they
    /// follow factor `load`.
    ///
    /// `traction` is force per unit area \[force/length²\] on the edge from `from` to `to`
    /// (per unit thickness).
    pub fn along_edge(
        from: [f64; D],
        to: [f64; D],
        traction: [f64; D],
        count: usize,
        load: usize,
    ) -> Vec<Self> {
        let length = from
            .iter()
            .zip(&to)
            .map(|(a, b)| (b - a) * (b - a))
            .sum::<f64>()
            .sqrt();
        (0..count)
            .map(|k| {
                let t = (k as f64 + 0.5) / count as f64;
                Self {
                    x: std::array::from_fn(|axis| from[axis] + t * (to[axis] - from[axis])),
                    force: traction.map(|component| component * length / count as f64),
                    load,
                }
            })
            .collect()
    }

    /// A traction on a rectangle across one axis, as equal points in the middle of equal parts, so many along each
    /// axis; they follow factor `load`.
    ///
    /// `traction` is force per unit area \[force/length²\] on the rectangle between the corners `from` and `to`, which
    /// share one coordinate.
    pub fn on_rectangle(
        from: [f64; D],
        to: [f64; D],
        traction: [f64; D],
        counts: [usize; D],
        load: usize,
    ) -> Vec<Self> {
        let way: [f64; D] = std::array::from_fn(|axis| to[axis] - from[axis]);
        let sides = way.iter().filter(|side| side.abs() > 0.0);
        let area: f64 = sides.map(|side| side.abs()).product();
        let counts: [usize; D] = std::array::from_fn(|axis| {
            if way[axis].abs() > 0.0 {
                counts[axis]
            } else {
                1
            }
        });
        let count: usize = counts.iter().product();
        (0..count)
            .map(|k| {
                let mut rest = k;
                let x = std::array::from_fn(|axis| {
                    let part = rest % counts[axis];
                    rest /= counts[axis];
                    from[axis] + (part as f64 + 0.5) / counts[axis] as f64 * way[axis]
                });
                Self {
                    x,
                    force: traction.map(|component| component * area / count as f64),
                    load,
                }
            })
            .collect()
    }

    /// The nodes that take the force: linear shares, so that resultant and moment are kept.
    fn supports(&self, grid: &Grid<D>, point: usize) -> Result<Vec<Support<D>>, AssemblyError> {
        let mut own = Vec::new();
        supports(
            grid,
            &Linear,
            &self.x,
            &[0.0; D],
            &mut Scratch::default(),
            &mut own,
        )
        .map_err(|source| AssemblyError::LoadPoint {
            point,
            position: padded(&self.x),
            source,
        })?;
        Ok(own)
    }

    /// The point carried along by nodal step displacements `u` \[length\].
    ///
    /// # Errors
    /// [`AssemblyError::LoadPoint`] when it is not on the grid.
    pub fn carried(
        &self,
        grid: &Grid<D>,
        point: usize,
        u: &[[f64; D]],
    ) -> Result<Self, AssemblyError> {
        let mut carried = *self;
        for support in self.supports(grid, point)? {
            for axis in 0..D {
                carried.x[axis] += support.value * u[support.node][axis];
            }
        }
        Ok(carried)
    }
}

/// What acts on the body at the end of a step.
#[derive(Clone, Debug, PartialEq)]
pub struct StepLoads<const D: usize> {
    /// Acceleration of gravity \[length/time²\].
    pub gravity: [f64; D],
    /// Factors on the loaded points, by load; a load without a factor does not act \[-\].
    pub factors: Vec<f64>,
    /// Drag against motion: a force −drag · m · u on every node, with m its share of the mass and
    /// u its step displacement \[1/time²\]. Zero in a step that has to be in equilibrium.
    pub drag: f64,
}

impl<const D: usize> StepLoads<D> {
    /// Gravity alone \[length/time²\], with its direction.
    pub fn gravity(gravity: [f64; D]) -> Self {
        Self {
            gravity,
            factors: Vec::new(),
            drag: 0.0,
        }
    }

    /// Refuses loads that are not finite, named with the axis or the load.
    pub(crate) fn are_finite(&self) -> Result<(), AssemblyError> {
        for (axis, gravity) in self.gravity.iter().enumerate() {
            finite("gravity", axis, &[*gravity])?;
        }
        for (load, factor) in self.factors.iter().enumerate() {
            finite("load factor", load, &[*factor])?;
        }
        finite("drag", 0, &[self.drag])
    }
}

/// Refuses values that are not finite, named with what they are.
fn finite(what: &'static str, index: usize, values: &[f64]) -> Result<(), AssemblyError> {
    if values.iter().all(|value| value.is_finite()) {
        Ok(())
    } else {
        Err(AssemblyError::NonFinite { what, index })
    }
}

/// Refuses loaded points that are not finite, named with their number.
pub(crate) fn finite_points<const D: usize>(points: &[LoadPoint<D>]) -> Result<(), AssemblyError> {
    for (index, point) in points.iter().enumerate() {
        finite("position of a load point", index, &point.x)?;
        finite("force of a load point", index, &point.force)?;
    }
    Ok(())
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

/// Adds to the nodal external force f_ext what the variation of stress within cells carries of the weight and shared
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
            let force = &mut f_ext[stencils.master(node)];
            for a in 0..D {
                let along: f64 = (0..D).map(|b| moment[a][b] * gravity[b]).sum();
                force[a] += gain * along;
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

/// Adds the force of loaded points to the nodal external force f_ext, by node \[force\]. What falls to
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
        let mut own = point.supports(grid, index)?;
        for support in &mut own {
            support.node = stencils.master(support.node);
            if support.value > 0.0 && stencils.node_volume(support.node) == 0.0 {
                return Err(unsupported());
            }
        }
        let shares = shares_of_carried(grid, unknowns, is_dropped, &point.x, &own);
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
    let own = nodes.map(|node| Coupling {
        row: node,
        column: node,
        stiffness: drag * stencils.node_mass(node),
    });
    Couplings(own.filter(|own| own.stiffness > 0.0).collect())
}
