//! The shares of a load point that fall to nodes which take no part, handed to nodes near by that do
//! (theory, eq. 27a).

use igimp_shape::{Grid, Support};

use crate::step::unknowns::Unknowns;

/// Pivots smaller than this count as none: the nodes at hand lie on a line or a plane \[-\].
const NO_PIVOT: f64 = 1e-9;

/// Shares by node of a point at `x`, whose linear shares on masters are `own`, without those on
/// dropped nodes. The sum stays one, and the moment stays where the nodes near by allow. `None` if no
/// node near by takes part.
pub(crate) fn shares_of_carried<const D: usize>(
    grid: &Grid<D>,
    unknowns: &Unknowns<D>,
    is_dropped: impl Fn(usize) -> bool,
    x: &[f64; D],
    supports: &[Support<D>],
) -> Option<Vec<(usize, f64)>> {
    let mut shares: Vec<(usize, f64)> = supports
        .iter()
        .map(|support| (support.node, support.value))
        .collect();
    if !shares
        .iter()
        .any(|&(node, value)| value > 0.0 && is_dropped(node))
    {
        return Some(shares);
    }
    let cell = grid.cell_at(x)?;
    let size = grid.cell_size(cell);
    let reduced = |node: usize| {
        let place = grid.node_position(node);
        let mut row = vec![1.0];
        row.extend((0..D).map(|axis| (place[axis] - x[axis]) / size[axis]));
        row
    };
    let mut missing = vec![0.0; D + 1];
    shares.retain(|&(node, value)| {
        let dropped = is_dropped(node);
        if dropped {
            for (sum, entry) in missing.iter_mut().zip(reduced(node)) {
                *sum += value * entry;
            }
        }
        !dropped
    });
    let carried: Vec<usize> = around(grid, cell)
        .into_iter()
        .filter(|&node| unknowns.is_active(node))
        .collect();
    // Both, or the sum alone where the nodes at hand cannot keep the moment.
    let added = [D + 1, 1]
        .into_iter()
        .find_map(|rows| least_shares(&carried, |node| reduced(node)[..rows].to_vec(), &missing))?;
    shares.extend(carried.into_iter().zip(added));
    Some(shares)
}

/// The nodes of a cell and of all cells around it.
fn around<const D: usize>(grid: &Grid<D>, cell: [usize; D]) -> Vec<usize> {
    (0..4_usize.pow(D as u32))
        .filter_map(|k| {
            let mut place = [0; D];
            let mut rest = k;
            for axis in 0..D {
                place[axis] = (cell[axis] + rest % 4).checked_sub(1)?;
                rest /= 4;
                if place[axis] >= grid.axes[axis].node_count() {
                    return None;
                }
            }
            Some(grid.node_index(place))
        })
        .collect()
}

/// The smallest shares of `nodes`, near ones first, whose sums with the rows a of the nodes are the
/// first entries of `sums`: `w = g aᵀ (Σ g a aᵀ)⁻¹ sums`.
fn least_shares(
    nodes: &[usize],
    row: impl Fn(usize) -> Vec<f64>,
    sums: &[f64],
) -> Option<Vec<f64>> {
    let rows: Vec<Vec<f64>> = nodes.iter().map(|&node| row(node)).collect();
    let weights: Vec<f64> = nodes
        .iter()
        .map(|&node| 1.0 / row(node).iter().map(|a| a * a).sum::<f64>().powi(2))
        .collect();
    let n = rows.first()?.len();
    // Elimination of a positive definite matrix beside its right-hand side.
    let mut system = vec![vec![0.0; n + 1]; n];
    for i in 0..n {
        for j in 0..n {
            let terms = rows.iter().zip(&weights);
            system[i][j] = terms.map(|(row, weight)| weight * row[i] * row[j]).sum();
        }
        system[i][n] = sums[i];
    }
    let size = system[0][0];
    for k in 0..n {
        if system[k][k] < NO_PIVOT * size {
            return None;
        }
        for i in (0..n).filter(|&i| i != k) {
            let factor = system[i][k] / system[k][k];
            for j in k..=n {
                system[i][j] -= factor * system[k][j];
            }
        }
    }
    let factors: Vec<f64> = (0..n).map(|k| system[k][n] / system[k][k]).collect();
    let share = |(row, weight): (&Vec<f64>, &f64)| {
        let sum: f64 = row.iter().zip(&factors).map(|(a, factor)| a * factor).sum();
        weight * sum
    };
    Some(rows.iter().zip(&weights).map(share).collect())
}
