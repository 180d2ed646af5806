//! Cells whose mean strains do not hold their nodes: motion without those strains is a mechanism (theory, eq. 8i).

use std::collections::VecDeque;

use crate::Grid;

/// Which of the cells that hold soil are loose, by cell: they touch nodes whose free displacements, `free` of each \[-\], are more than
/// the components of mean strain of all cells that touch them, `strains` of each \[-\]. Of all sets of nodes it is the smallest that lacks
/// most. By Hall's theorem there is none where every free displacement can be given a component of strain of its own.
///
/// In the plane the cell of a ridge is one: both of its upper nodes are free in two directions, and touched by its three strains alone.
///
/// ```
/// use igimp_shape::{Axis, Grid, loose_cells};
///
/// let axis = Axis::uniform(0.0, 3.0, 3)?;
/// let grid = Grid::new([axis.clone(), axis]);
/// // A row of three cells on a floor, and a single cell upon it.
/// let holds_soil: Vec<bool> = (0..9).map(|cell| cell < 3 || cell == 4).collect();
/// let free = |node: usize| if node < 4 { 0 } else { 2 };
/// let loose = loose_cells(&grid, &holds_soil, free, 3);
/// assert_eq!(loose.iter().position(|own| *own), Some(4));
/// assert_eq!(loose.iter().filter(|own| **own).count(), 1);
/// # Ok::<(), igimp_shape::ShapeError>(())
/// ```
pub fn loose_cells<const D: usize>(
    grid: &Grid<D>,
    holds_soil: &[bool],
    free: impl Fn(usize) -> usize,
    strains: u8,
) -> Vec<bool> {
    let mut matching = Matching {
        grid,
        holds_soil,
        left: vec![strains; grid.cell_count()],
        given: vec![[0; 8]; grid.cell_count()],
        reached: vec![false; grid.cell_count()],
        from: vec![None; grid.cell_count()],
    };
    // Nodes that few cells touch have the least choice.
    let mut by_choice = vec![Vec::new(); (1 << D) + 1];
    for node in 0..grid.node_count() {
        by_choice[matching.cells_at(node).count()].push(node);
    }
    by_choice[0].clear();
    for &node in by_choice.iter().flatten() {
        let mut wanted = free(node);
        while wanted > 0 && matching.serve(node) {
            wanted -= 1;
        }
    }
    matching.reached
}

/// Components of strain given to displacements of nodes.
struct Matching<'a, const D: usize> {
    grid: &'a Grid<D>,
    holds_soil: &'a [bool],
    /// Strains that are not given away, by cell.
    left: Vec<u8>,
    /// Strains that are given to each corner, by cell.
    given: Vec<[u8; 8]>,
    /// Cells that are reached from nodes for which nothing is left.
    reached: Vec<bool>,
    /// In a search, the cell and its corner through which a cell was reached, or itself where the search began.
    from: Vec<Option<(u32, u8)>>,
}

impl<'a, const D: usize> Matching<'a, D> {
    /// The cells with soil that touch a node, with its corner in each: component k of a corner is bit k.
    fn cells_at(&self, node: usize) -> impl Iterator<Item = (usize, usize)> + use<'a, D> {
        let (grid, holds_soil) = (self.grid, self.holds_soil);
        let place = grid.node_place(node);
        (0..1_usize << D).filter_map(move |corner| {
            let mut cell = [0; D];
            for axis in 0..D {
                cell[axis] = place[axis].checked_sub(corner >> axis & 1)?;
                if cell[axis] == grid.axes[axis].cell_count() {
                    return None;
                }
            }
            let cell = grid.cell_index(cell);
            holds_soil[cell].then_some((cell, corner))
        })
    }

    /// The node at a corner of a cell.
    fn node_at(&self, cell: usize, corner: usize) -> usize {
        let place = self.grid.cell_place(cell);
        let node = std::array::from_fn(|axis| place[axis] + (corner >> axis & 1));
        self.grid.node_index(node)
    }

    /// Gives a node one strain, by the shortest chain of nodes that can do with another one; marks the nodes reached where there is
    /// none.
    fn serve(&mut self, node: usize) -> bool {
        let at_hand = self.cells_at(node).find(|(cell, _)| self.left[*cell] > 0);
        if let Some((cell, corner)) = at_hand {
            self.left[cell] -= 1;
            self.given[cell][corner] += 1;
            return true;
        }
        let mut queue = VecDeque::new();
        let mut seen = Vec::new();
        for (cell, corner) in self.cells_at(node) {
            self.from[cell] = Some((cell as u32, corner as u8));
            seen.push(cell);
            queue.push_back(cell);
        }
        let mut found = None;
        while let Some(cell) = queue.pop_front() {
            if self.reached[cell] {
                continue;
            }
            if self.left[cell] > 0 {
                found = Some(cell);
                break;
            }
            for corner in (0..1 << D).filter(|&corner| self.given[cell][corner] > 0) {
                for (next, _) in self.cells_at(self.node_at(cell, corner)) {
                    if self.from[next].is_none() {
                        self.from[next] = Some((cell as u32, corner as u8));
                        seen.push(next);
                        queue.push_back(next);
                    }
                }
            }
        }
        match found {
            Some(cell) => self.pass_on(cell),
            None => {
                for &cell in &seen {
                    self.reached[cell] = true;
                }
            }
        }
        for cell in seen {
            self.from[cell] = None;
        }
        found.is_some()
    }

    /// Gives a strain that is left in a cell along the chain through which it was reached.
    fn pass_on(&mut self, mut cell: usize) {
        self.left[cell] -= 1;
        while let Some((before, corner)) = self.from[cell] {
            let (before, corner) = (before as usize, usize::from(corner));
            if before == cell {
                self.given[cell][corner] += 1;
                return;
            }
            // The node at that corner takes a strain of this cell, and leaves that of the cell before.
            let node = self.node_at(before, corner);
            let found = self.cells_at(node).find(|(other, _)| *other == cell);
            if let Some((_, at)) = found {
                self.given[cell][at] += 1;
            }
            self.given[before][corner] -= 1;
            cell = before;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::loose_cells;
    use crate::{Axis, Grid};

    /// The cells at the smallest set of nodes that lacks most, of all sets.
    fn by_all_sets(grid: &Grid<2>, holds_soil: &[bool], free: &[usize], strains: u8) -> Vec<bool> {
        let touched: Vec<Vec<usize>> = (0..grid.node_count())
            .map(|node| {
                let at = grid.node_position(node);
                let cells = grid.cells_around(&at);
                cells.filter(|&cell| holds_soil[cell]).collect()
            })
            .collect();
        let cells_of = |set: usize| {
            let mut is_there = vec![false; grid.cell_count()];
            for (node, touched) in touched.iter().enumerate() {
                if set >> node & 1 == 1 {
                    for &cell in touched {
                        is_there[cell] = true;
                    }
                }
            }
            is_there
        };
        let lacks = |set: usize| -> i64 {
            let nodes = (0..grid.node_count()).filter(|node| set >> node & 1 == 1);
            let wanted: usize = nodes
                .filter(|&node| !touched[node].is_empty())
                .map(|node| free[node])
                .sum();
            let cells = cells_of(set).iter().filter(|there| **there).count();
            wanted as i64 - i64::from(strains) * cells as i64
        };
        let sets = 0..1_usize << grid.node_count();
        let smallest = sets.min_by_key(|&set| (-lacks(set), set.count_ones()));
        cells_of(smallest.unwrap())
    }

    // GOAL: what a matching reaches is the smallest set of nodes that lacks most.
    // CASE: soil in cells at random, sides that are held or not.
    // ORACLE: all sets of nodes.
    #[test]
    fn loose_cells_are_those_of_the_smallest_set_that_lacks_most() {
        let axes = [
            Axis::uniform(0.0, 3.0, 3).unwrap(),
            Axis::uniform(0.0, 2.0, 2).unwrap(),
        ];
        let grid = Grid::new(axes);
        let mut found = [0; 2];
        for soil in 1_usize..64 {
            let holds_soil: Vec<bool> = (0..6).map(|cell| soil >> cell & 1 == 1).collect();
            for floor in [0, 1, 2] {
                let free: Vec<usize> = (0..12)
                    .map(|node| if node < 4 { floor } else { 2 })
                    .collect();
                for strains in [3, 4] {
                    let loose = loose_cells(&grid, &holds_soil, |node| free[node], strains);
                    let expected = by_all_sets(&grid, &holds_soil, &free, strains);
                    assert_eq!(loose, expected, "{holds_soil:?} {free:?} {strains}");
                    found[usize::from(loose.contains(&true))] += 1;
                }
            }
        }
        assert!(found[0] > 50 && found[1] > 50, "{found:?}");
    }
}
