//! A rigid footing and the grid that follows it (theory, eq. 30).
//!
//! At the start of each step the rows at or below the initial surface are compressed to
//! `y₀ (D − w)/D` above the bottom of the grid, with D the depth of the base and w its settlement,
//! and the rows above are shifted by −w, so that the base is always a row of nodes.

use igimp_assembly::{AssemblyError, Constraints};
use igimp_model::{AxisSpec, Case, LoadKind};
use igimp_shape::{Axis, Grid, ShapeError};

use crate::error::CaseError;

/// The footing of a case, as columns and rows of its grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Footing {
    /// First and last column of nodes under the base.
    columns: [usize; 2],
    /// Row of nodes of the base.
    row: usize,
    rough: bool,
    reaction_factor: f64,
}

/// The rigid body of a case that the rows of the grid follow, and the row of nodes at its lowest place.
pub(crate) fn followed<const D: usize>(
    case: &Case<D>,
) -> Result<Option<(usize, usize)>, CaseError> {
    let mut followed = case.rigid.iter().enumerate();
    let Some((index, part)) = followed.find(|(_, part)| part.grid_follows) else {
        return Ok(None);
    };
    let level = part.bounds().0[D - 1];
    let row = case.grid.axes[D - 1].place(level);
    if (row - row.round()).abs() > 1e-6 || row.round() < 1.0 {
        return Err(CaseError::FootingOffGrid { level });
    }
    Ok(Some((index, row.round() as usize)))
}

/// The rows of the grid when a row of nodes has gone down by w \[m\], with rows added on top
/// for those that sank.
pub(crate) fn rows(spec: &AxisSpec, base: usize, w: f64) -> Result<Axis, ShapeError> {
    let lower = spec.lower();
    let depth = spec.rise(base);
    let rows = spec.cells() + (w / spec.last_cell()).ceil() as usize;
    let nodes = (0..=rows)
        .map(|row| {
            let y0 = spec.rise(row);
            lower
                + if row <= base {
                    y0 * (depth - w) / depth
                } else {
                    y0 - w
                }
        })
        .collect();
    Axis::from_nodes(nodes)
}

impl Footing {
    /// The footing of a case, if it has one.
    pub(crate) fn of<const D: usize>(case: &Case<D>) -> Result<Option<Self>, CaseError> {
        let mut footings = case.loads.iter().filter_map(|load| match load.kind {
            LoadKind::RigidFooting {
                from,
                to,
                rough,
                reaction_factor,
            } => Some((from, to, rough, reaction_factor)),
            _ => None,
        });
        let Some((from, to, rough, reaction_factor)) = footings.next() else {
            return Ok(None);
        };
        if footings.next().is_some() {
            return Err(CaseError::SeveralFootings);
        }
        let place = |x: f64, axis: usize| case.grid.axes[axis].place(x);
        let row = place(from[1], D - 1).round();
        if (place(from[1], D - 1) - row).abs() > 1e-6 || row < 1.0 {
            return Err(CaseError::FootingOffGrid { level: from[1] });
        }
        let first = (place(from[0].min(to[0]), 0) - 1e-6).ceil().max(0.0) as usize;
        let last = (place(from[0].max(to[0]), 0) + 1e-6).floor().max(0.0) as usize;
        Ok(Some(Self {
            columns: [first, last],
            row: row as usize,
            rough,
            reaction_factor,
        }))
    }

    /// Row of nodes of the base.
    pub(crate) fn row(&self) -> usize {
        self.row
    }

    /// Whether a node belongs to the footing; `Some(true)` on its base.
    fn part<const D: usize>(&self, node: [usize; D]) -> Option<bool> {
        let (column, row) = (node[0], node[D - 1]);
        let inside = (self.columns[0]..=self.columns[1]).contains(&column) && row >= self.row;
        inside.then_some(row == self.row)
    }

    /// Moves the footing by `step` upwards over the step (negative: down).
    pub(crate) fn push<const D: usize>(
        &self,
        grid: &Grid<D>,
        constraints: &mut Constraints<D>,
        step: f64,
    ) -> Result<(), AssemblyError> {
        for node in 0..grid.node_count() {
            let Some(base) = self.part(grid.node_place(node)) else {
                continue;
            };
            if self.rough || base {
                constraints.prescribe(node, D - 1, step)?;
            }
            if self.rough || !base {
                constraints.prescribe(node, 0, 0.0)?;
            }
        }
        Ok(())
    }

    /// Resistance, compression positive, times the reaction factor \[N/m\].
    pub(crate) fn resistance<const D: usize>(&self, grid: &Grid<D>, reactions: &[[f64; D]]) -> f64 {
        let force: f64 = (0..grid.node_count())
            .filter(|&node| self.part(grid.node_place(node)).is_some())
            .map(|node| reactions[node][D - 1])
            .sum();
        -force * self.reaction_factor
    }
}
