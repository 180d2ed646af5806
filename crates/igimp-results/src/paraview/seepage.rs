//! Flows that were computed, for ParaView.

use igimp_seepage::Seepage;

use super::particles::of_grid;
use crate::vtu::{CellKind, DataArray, UnstructuredGrid};

/// The cells with soil: head and pore pressure at their nodes, Darcy velocity within. The unit weight is that of water \[N/m³\].
pub fn seepage_grid<const D: usize>(flow: &Seepage<D>, unit_weight: f64) -> UnstructuredGrid {
    let mut grid = of_grid(&flow.grid, None);
    let corners = CellKind::of_dimension(D).corners().len();
    let all = grid.connectivity.chunks_exact(corners);
    let cells: Vec<usize> = (0..flow.filled.len())
        .filter(|&cell| flow.filled[cell] > 0.0)
        .collect();
    let soil = std::iter::zip(all, &flow.filled).filter(|(_, filled)| **filled > 0.0);
    grid.connectivity = soil.flat_map(|(nodes, _)| nodes.to_vec()).collect();
    let pressures = (0..flow.heads.len()).map(|node| {
        let level = flow.grid.node_position(node)[D - 1];
        unit_weight * (flow.heads[node] - level)
    });
    grid.point_data = vec![
        DataArray::scalars("head [m]", flow.heads.clone()),
        DataArray::scalars("pore pressure, suction negative [Pa]", pressures.collect()),
    ];
    let velocities: Vec<[f64; D]> = cells.iter().map(|&cell| flow.velocities[cell]).collect();
    grid.cell_data = vec![DataArray::vectors("Darcy velocity [m/s]", &velocities)];
    grid
}
