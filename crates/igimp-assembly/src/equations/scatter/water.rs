//! From the tangent of one particle with water that flows into the matrix, in space, where displacements go there by patches.

use igimp_linear::Pattern;
use igimp_shape::Support;

use crate::contributions::consolidation::WaterOfParticle;
use crate::equations::blocks::BlockTable;

/// Adds the derivative of the water of a particle to the values of the matrix from `start` on, block by
/// block.
#[inline]
pub(crate) fn scatter_in_space<const D: usize>(
    water: &WaterOfParticle<'_, D>,
    supports: &[Support<D>],
    (table, pattern): (&BlockTable<D>, &Pattern),
    (start, values): (usize, &mut [f64]),
) {
    for (support, slope) in supports.iter().zip(water.slopes(supports)) {
        let column = &table.nodes[support.node];
        if column.len == 0 {
            continue;
        }
        let block = column.block as usize;
        let (height, offsets) = (pattern.height(block), table.offsets_of(support.node));
        let values = &mut values[pattern.values_of(block).start - start..];
        for pressure in water.pressures() {
            let row = &table.nodes[pressure.node as usize];
            let offset = offsets(row.code, row.block) + usize::from(row.len);
            let share = water.coupling(pressure);
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
        for (support, slope) in supports.iter().zip(water.slopes(supports)) {
            let row = &table.nodes[support.node];
            if row.len == 0 {
                continue;
            }
            let offset = offsets(row.code, row.block);
            for (rank, axis) in row.components().enumerate() {
                values[offset + rank] += share * slope[axis];
            }
        }
        for pressure in water.pressures() {
            let row = &table.nodes[pressure.node as usize];
            let offset = offsets(row.code, row.block) + usize::from(row.len);
            values[offset] += water.moves(pressure, column);
        }
    }
}
