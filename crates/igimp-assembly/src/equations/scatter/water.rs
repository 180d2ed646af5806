//! From the tangent of one particle with water that flows into the matrix: pressures stand among the displacements of their nodes.

use igimp_linear::Pattern;
use igimp_shape::Support;

use super::{Rows, add};
use crate::contributions::consolidation::{PressureSupport, WaterOfParticle};
use crate::equations::blocks::BlockTable;
use crate::equations::linearised::Linearised;

/// The tangent of a particle with water, column by column: a row more for each support than displacements have.
#[derive(Debug, Default)]
pub(crate) struct WaterColumns<const D: usize> {
    /// By support: what its pressure is to the particle, and its pushed gradient; no share where it has none.
    rows: Vec<(PressureSupport<D>, [f64; D])>,
    /// By support: ∂f/∂u of its pressure over the pushed gradient of a node.
    shares: Vec<f64>,
    /// The columns of one support, those of displacement first.
    columns: Vec<f64>,
    /// What the pressures of a pair of supports move, by column and row.
    moves: Vec<f64>,
}

impl<const D: usize> WaterColumns<D> {
    /// Sets those of a particle with the `supports` of its displacement.
    #[inline]
    pub(crate) fn set(&mut self, water: &WaterOfParticle<'_, D>, supports: &[Support<D>]) {
        let mut pressures = water.pressures().iter().peekable();
        self.rows.clear();
        self.rows.extend(supports.iter().map(|support| {
            let is_own = |own: &&PressureSupport<D>| own.node as usize == support.node;
            let pressure = pressures.next_if(is_own).copied();
            let slope = water.slope(support);
            (pressure.unwrap_or(PressureSupport::nothing()), slope)
        }));
        self.shares.clear();
        self.shares
            .extend(self.rows.iter().map(|(own, _)| water.coupling(own)));
        self.moves.clear();
        for (column, _) in &self.rows {
            self.moves
                .extend(self.rows.iter().map(|(row, _)| water.moves(row, column)));
        }
    }

    /// The columns of support `j` by component, the pressure behind those of displacement, which `own` has without pressures.
    #[allow(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    pub(crate) fn columns<'c>(
        &'c mut self,
        j: usize,
        own: [&[f64]; D],
    ) -> impl Fn(usize) -> &'c [f64] + use<'c, D> {
        let n = self.rows.len();
        let height = n * (D + 1);
        self.columns.resize((D + 1) * height, 0.0);
        let slope = self.rows[j].1;
        for (c, own) in own.into_iter().enumerate() {
            let into = self.columns[c * height..][..height].chunks_exact_mut(D + 1);
            let parts = into.zip(own.chunks_exact(D)).zip(&self.shares);
            for ((into, own), share) in parts {
                into[..D].copy_from_slice(own);
                into[D] = share * slope[c];
            }
        }
        let into = self.columns[D * height..].chunks_exact_mut(D + 1);
        let share = self.shares[j];
        let moves = &self.moves[j * n..][..n];
        for ((into, (_, slope)), water) in into.zip(&self.rows).zip(moves) {
            for a in 0..D {
                into[a] = share * slope[a];
            }
            into[D] = *water;
        }
        let columns = &self.columns;
        move |component| &columns[component * height..][..height]
    }
}

impl Rows {
    /// Adds the tangent of one particle with water, whose rows were listed with those of pressures, to the slice of values that
    /// begins at `start`.
    #[allow(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    pub(crate) fn scatter_with_water<const D: usize>(
        &self,
        supports: &[Support<D>],
        (table, pattern): (&BlockTable<D>, &Pattern),
        (linearised, water): (&mut Linearised<D>, &mut WaterColumns<D>),
        (start, slice): (usize, &mut [f64]),
    ) {
        for (j, support) in supports.iter().enumerate() {
            let column = &table.nodes[support.node];
            if column.len == 0 && !column.has_pressure {
                continue;
            }
            let columns = water.columns(j, linearised.columns(j));
            let stored = pattern.values_of(column.block as usize);
            let values = &mut slice[stored.start - start..stored.end - start];
            let offsets = table.offsets_of(support.node);
            let height = pattern.height(column.block as usize);
            for run in &self.runs {
                let offset = offsets(run.code, run.block) + run.rank as usize;
                let (first, len) = (run.first as usize, run.len as usize);
                for (rank, axis) in column.components().enumerate() {
                    let sums = &mut values[rank * height + offset..];
                    add(sums, &columns(axis)[first..], len);
                }
                if column.has_pressure {
                    let sums = &mut values[usize::from(column.len) * height + offset..];
                    add(sums, &columns(D)[first..], len);
                }
            }
        }
    }
}

/// Adds the derivative of the water of a particle to the values of the matrix from `start` on, block by block: in space, where
/// displacements go there by patches.
#[inline]
pub(crate) fn scatter_in_space<const D: usize>(
    water: &WaterOfParticle<'_, D>,
    supports: &[Support<D>],
    (table, pattern): (&BlockTable<D>, &Pattern),
    (start, values): (usize, &mut [f64]),
) {
    for support in supports {
        let column = &table.nodes[support.node];
        if column.len == 0 {
            continue;
        }
        let slope = water.slope(support);
        let block = column.block as usize;
        let (height, offsets) = (pattern.height(block), table.offsets_of(support.node));
        let values = &mut values[pattern.values_of(block).start - start..];
        for own in water.pressures() {
            let row = &table.nodes[own.node as usize];
            let offset = offsets(row.code, row.block) + usize::from(row.len);
            let share = water.coupling(own);
            for (rank, axis) in column.components().enumerate() {
                values[rank * height + offset] += share * slope[axis];
            }
        }
    }
    for column in water.pressures() {
        let node = column.node as usize;
        let block = table.nodes[node].block as usize;
        let (height, offsets) = (pattern.height(block), table.offsets_of(node));
        let before = pattern.values_of(block).start - start;
        let values = &mut values[before + usize::from(table.nodes[node].len) * height..];
        let share = water.coupling(column);
        for support in supports {
            let row = &table.nodes[support.node];
            if row.len == 0 {
                continue;
            }
            let slope = water.slope(support);
            let offset = offsets(row.code, row.block);
            for (rank, axis) in row.components().enumerate() {
                values[offset + rank] += share * slope[axis];
            }
        }
        for own in water.pressures() {
            let row = &table.nodes[own.node as usize];
            let offset = offsets(row.code, row.block) + usize::from(row.len);
            values[offset] += water.moves(own, column);
        }
    }
}
