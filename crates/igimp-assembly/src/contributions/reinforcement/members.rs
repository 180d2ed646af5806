//! The members of a step: which nodes carry them, the forces that they make, and their state after
//! an accepted step.

use std::collections::BTreeMap;

use igimp_shape::{Linear, Scratch, supports};

use super::row::{Row, length};
use super::soil_near::SoilNear;
use super::{Reinforcement, Station};
use crate::body::particles::Particles;
use crate::conditions::StepConditions;
use crate::conditions::reinforcement::ReinforcementControl;
use crate::contributions::dropped::shares_of_carried;
use crate::contributions::nodal_forces::{AddBlock, NodalForces};
use crate::error::{AssemblyError, padded};
use crate::method::{Geometry, Kinematics, Method};
use crate::step::stencils::Stencils;
use crate::step::unknowns::Unknowns;

/// A node without soil that has a smaller share of a point has none: round-off on a line of the grid \[-\].
const LEAST_SHARE: f64 = 1e-9;

/// Shares of a point by node: they sum to one.
type Shares = Vec<(usize, f64)>;

/// The members of one step.
#[derive(Debug)]
pub(crate) struct Members<'a, const D: usize> {
    all: &'a [Reinforcement<D>],
    /// By member, by station, by point.
    points: Vec<Vec<Vec<Shares>>>,
    /// The bars, member by member.
    rows: Vec<Row<D>>,
    is_given: bool,
}

impl<'a, const D: usize> Members<'a, D> {
    /// Finds the nodes that carry the members at the start of a step.
    pub(crate) fn find(
        members: &'a [Reinforcement<D>],
        particles: &Particles<D>,
        stencils: &Stencils<D>,
        (conditions, method): (&StepConditions<D>, &Method),
        unknowns: &Unknowns<D>,
    ) -> Result<Self, AssemblyError> {
        let soil = (!members.is_empty()).then(|| SoilNear::new(particles, &conditions.grid));
        let is_small = method.kinematics_of_step() == Kinematics::SmallStrain;
        let mut points = Vec::with_capacity(members.len());
        let mut rows = Vec::new();
        for (index, member) in members.iter().enumerate() {
            member.is_finite(index)?;
            let unsupported = |x: &[f64; D]| AssemblyError::UnsupportedReinforcement {
                name: member.name.clone(),
                position: padded(x),
            };
            let of_station = |station: &Station<D>| -> Result<Vec<Shares>, AssemblyError> {
                let position = station.position();
                if !soil.as_ref().is_some_and(|soil| soil.reaches(&position)) {
                    return Err(unsupported(&position));
                }
                let points = station.points.iter();
                points
                    .map(|x| {
                        carried_by(x, stencils, conditions, unknowns).ok_or_else(|| unsupported(x))
                    })
                    .collect()
            };
            let stations = member.stations.iter().map(of_station);
            let stations = stations.collect::<Result<Vec<_>, _>>()?;
            let control = conditions.reinforcement.get(index).copied();
            for (k, &segment) in member.segments.iter().enumerate() {
                let (a, b) = (
                    member.stations[k].position(),
                    member.stations[k + 1].position(),
                );
                let along = std::array::from_fn(|axis| b[axis] - a[axis]);
                if length(&along) == 0.0 {
                    return Err(unsupported(&a));
                }
                rows.push(Row {
                    segment,
                    control: control.unwrap_or_default(),
                    stiffness: member.stiffness,
                    along,
                    relative: relative(&stations[k], &stations[k + 1]),
                    is_small,
                });
            }
            points.push(stations);
        }
        Ok(Self {
            all: members,
            points,
            rows,
            is_given: method.geometry == Geometry::Given,
        })
    }

    /// Exchanges the controls of the members, in their order.
    pub(crate) fn control(&mut self, controls: &[ReinforcementControl]) {
        let mut rows = self.rows.iter_mut();
        for (index, member) in self.all.iter().enumerate() {
            let control = controls.get(index).copied().unwrap_or_default();
            for row in rows.by_ref().take(member.segments.len()) {
                row.control = control;
            }
        }
    }

    /// The work of the tension at the end of a step with nodal displacements `u` on the stretch of the step, and
    /// its elastic part \[force·length\].
    pub(crate) fn work(&self, u: &[[f64; D]]) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for row in &self.rows {
            let [whole, elastic] = row.work(u);
            sum[0] += whole;
            sum[1] += elastic;
        }
        sum
    }

    /// The members as nodal step displacements `u` \[length\] leave them. On a given geometry they stay
    /// where they are.
    pub(crate) fn accepted(&self, u: &[[f64; D]]) -> Vec<Reinforcement<D>> {
        let mut members = self.all.to_vec();
        let mut rows = self.rows.iter();
        for (member, points) in members.iter_mut().zip(&self.points) {
            for (segment, row) in member.segments.iter_mut().zip(&mut rows) {
                segment.state = row.pull(u).state;
            }
            if self.is_given {
                continue;
            }
            for (station, points) in member.stations.iter_mut().zip(points) {
                for (x, shares) in station.points.iter_mut().zip(points) {
                    for &(node, share) in shares {
                        for axis in 0..D {
                            x[axis] += share * u[node][axis];
                        }
                    }
                }
            }
        }
        members
    }
}

impl<const D: usize> NodalForces<D> for Members<'_, D> {
    fn pairs(&self) -> Vec<(usize, usize)> {
        let mut pairs = Vec::new();
        for row in &self.rows {
            for &(a, _) in &row.relative {
                pairs.extend(row.relative.iter().map(|&(b, _)| (a, b)));
            }
        }
        pairs
    }

    fn is_symmetric(&self) -> bool {
        true
    }

    fn add(&self, u: &[[f64; D]], f: &mut [[f64; D]], mut blocks: Option<&mut AddBlock<'_, D>>) {
        for row in &self.rows {
            match &mut blocks {
                Some(blocks) => row.add(u, f, Some(&mut **blocks)),
                None => row.add(u, f, None),
            }
        }
    }
}

/// The nodes that carry a point, with their shares; none where no soil is near.
fn carried_by<const D: usize>(
    x: &[f64; D],
    stencils: &Stencils<D>,
    conditions: &StepConditions<D>,
    unknowns: &Unknowns<D>,
) -> Option<Shares> {
    let grid = &conditions.grid;
    let mut stencil = Vec::new();
    supports(
        grid,
        &Linear,
        x,
        &[0.0; D],
        &mut Scratch::default(),
        &mut stencil,
    )
    .ok()?;
    let mut stencil = stencils.carried(&stencil);
    let is_dropped = |node: usize| !unknowns.is_active(node);
    stencil.retain(|support| support.value > LEAST_SHARE || !is_dropped(support.node));
    shares_of_carried(grid, unknowns, is_dropped, x, &stencil)
}

/// The mean of one station less that of another, by node.
fn relative(from: &[Shares], to: &[Shares]) -> Shares {
    let mut sums: BTreeMap<usize, f64> = BTreeMap::new();
    for (station, sign) in [(from, -1.0), (to, 1.0)] {
        for &(node, share) in station.iter().flatten() {
            *sums.entry(node).or_default() += sign * share / station.len() as f64;
        }
    }
    sums.into_iter()
        .filter(|&(_, share)| share != 0.0)
        .collect()
}
