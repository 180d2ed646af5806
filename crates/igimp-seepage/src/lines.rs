//! Flow lines, equipotentials and the free surface as lines in the plane.

use igimp_shape::Grid;

use crate::basis::{Basis, nodes_of};
use crate::conditions::thickness;
use crate::field::Seepage;
use crate::ground::ends_of;

/// Steps of a flow line by the cell that it passes.
const BY_CELL: f64 = 4.0;

/// A line across a cell, and the flow through it.
type Pass = ([[f64; 2]; 2], f64);

impl<const D: usize> Seepage<D> {
    /// The flow in the upright plane across a level axis at a place \[m\], as one in the plane; without a `cut` a flow in the plane
    /// itself. Heads are those between nodes, and cells those that the plane crosses, with the parts of their velocities that lie in
    /// it. Discharges stay those of all the flow.
    ///
    /// # Panics
    /// If a flow in space is not cut, one in the plane is, or the axis is not level.
    pub fn upright(&self, cut: Option<(usize, f64)>) -> Seepage<2> {
        assert!(cut.is_some() == (D == 3), "flows in space are cut");
        let (axis, at) = cut.unwrap_or((D, 0.0));
        assert!(axis != D - 1, "cuts are upright");
        let along = usize::from(axis == 0);
        let (layer, share) = (self.grid.axes.get(axis)).map_or((0, 0.0), |axis| {
            let nodes = axis.nodes();
            let after = nodes.partition_point(|node| *node <= at);
            let layer = after.clamp(1, axis.cell_count()) - 1;
            let share = (at - nodes[layer]) / (nodes[layer + 1] - nodes[layer]);
            (layer, share.clamp(0.0, 1.0))
        });
        let grid = Grid::new([along, D - 1].map(|axis| self.grid.axes[axis].clone()));
        let in_ground = |[across, level]: [usize; 2], layer: usize| {
            let mut place = [layer; D];
            (place[along], place[D - 1]) = (across, level);
            place
        };
        let beyond = layer + usize::from(share > 0.0);
        let nodes = (0..grid.node_count()).map(|node| grid.node_place(node));
        let nodes: Vec<[usize; 2]> = nodes
            .map(|place| [layer, beyond].map(|layer| self.grid.node_index(in_ground(place, layer))))
            .collect();
        let cells = (0..grid.cell_count()).map(|cell| grid.cell_place(cell));
        let cells: Vec<usize> = cells
            .map(|place| self.grid.cell_index(in_ground(place, layer)))
            .collect();
        let head = |pair: &[usize; 2]| {
            let [lower, upper] = pair.map(|node| self.heads[node]);
            (1.0 - share) * lower + share * upper
        };
        let is_ground = |pair: &[usize; 2]| pair.iter().any(|&node| self.is_ground[node]);
        let in_plane = |&cell: &usize| [along, D - 1].map(|axis| self.velocities[cell][axis]);
        Seepage {
            heads: nodes.iter().map(head).collect(),
            is_ground: nodes.iter().map(is_ground).collect(),
            filled: cells.iter().map(|&cell| self.filled[cell]).collect(),
            velocities: cells.iter().map(in_plane).collect(),
            discharges: self.discharges.clone(),
            sections: self.sections.clone(),
            inflow: self.inflow,
            outflow: self.outflow,
            outflow_at_lower_floor: self.outflow_at_lower_floor,
            floor: self.floor,
            width: self.width,
            corrections: self.corrections,
            residual: self.residual,
            unknowns: self.unknowns,
            confined: self.confined,
            axisymmetric: self.axisymmetric,
            grid,
        }
    }
}

impl Seepage<2> {
    /// The free surface from left to right \[m\], in pieces where there is none between.
    pub fn free_surface_lines(&self) -> Vec<Vec<[f64; 2]>> {
        let mut lines = vec![Vec::new()];
        if self.confined {
            return Vec::new();
        }
        let columns = self.grid.axes[0].nodes();
        for (column, &x) in columns.iter().enumerate() {
            let level = self.free_surface(&[x, 0.0]);
            match level.filter(|level| self.has_soil_beside(column, *level)) {
                Some(level) => {
                    if let Some(line) = lines.last_mut() {
                        line.push([x, level]);
                    }
                }
                None => lines.push(Vec::new()),
            }
        }
        lines.retain(|line| line.len() > 1);
        lines
    }

    /// Whether a cell beside a line of nodes has soil at a level.
    fn has_soil_beside(&self, column: usize, level: f64) -> bool {
        let Some([_, row]) = self.grid.cell_at(&[self.grid.axes[0].start(), level]) else {
            return false;
        };
        let beside = [column.checked_sub(1), Some(column)].into_iter().flatten();
        let inside = beside.filter(|column| *column < self.grid.axes[0].cell_count());
        { inside }.any(|column| self.filled[self.grid.cell_index([column, row])] > 0.0)
    }

    /// Lines of equal head \[m\] at so many levels between the highest and the lowest, as pieces within cells.
    pub fn equipotentials(&self, count: usize) -> Vec<[[f64; 2]; 2]> {
        let heads = || std::iter::zip(&self.heads, &self.is_ground).filter(|(_, ground)| **ground);
        let lowest = heads().fold(f64::INFINITY, |least, (head, _)| head.min(least));
        let highest = heads().fold(f64::NEG_INFINITY, |most, (head, _)| head.max(most));
        let levels = (1..=count)
            .map(|k| lowest + (highest - lowest) * k as f64 / (count + 1) as f64)
            .collect::<Vec<f64>>();
        let mut pieces = Vec::new();
        for cell in (0..self.filled.len()).filter(|&cell| self.filled[cell] > 0.0) {
            let place = self.grid.cell_place(cell);
            let corners: Vec<usize> = nodes_of(&self.grid, place).collect();
            for &level in &levels {
                let crossings: Vec<[f64; 2]> = [[0, 1], [1, 3], [3, 2], [2, 0]]
                    .iter()
                    .filter_map(|side| self.crossing(side.map(|k| corners[k]), level))
                    .collect();
                for pair in crossings.as_chunks::<2>().0 {
                    pieces.push(*pair);
                }
            }
        }
        pieces
    }

    /// Where a head is met between two nodes.
    fn crossing(&self, nodes: [usize; 2], level: f64) -> Option<[f64; 2]> {
        let [a, b] = nodes.map(|node| self.heads[node]);
        if (a < level) == (b < level) {
            return None;
        }
        let share = (level - a) / (b - a);
        let [from, to] = nodes.map(|node| self.grid.node_position(node));
        Some(std::array::from_fn(|axis| {
            from[axis] + share * (to[axis] - from[axis])
        }))
    }

    /// So many lines along which water flows, with equal discharge between them where they pass the row or column of cells
    /// through which most water goes.
    pub fn flow_lines(&self, count: usize) -> Vec<Vec<[f64; 2]>> {
        let velocities = self.at_nodes();
        let starts = self.starts(count);
        let lines = starts.into_iter().map(|start| {
            let mut line = self.trace(start, -1.0, &velocities);
            line.reverse();
            line.push(start);
            line.extend(self.trace(start, 1.0, &velocities));
            line
        });
        lines.filter(|line| line.len() > 2).collect()
    }

    /// Velocities at nodes: means of the cells with soil about them.
    fn at_nodes(&self) -> Vec<[f64; 2]> {
        let mut sums = vec![[0.0; 2]; self.heads.len()];
        let mut counts = vec![0.0; self.heads.len()];
        for cell in (0..self.filled.len()).filter(|&cell| self.filled[cell] > 0.0) {
            for node in nodes_of(&self.grid, self.grid.cell_place(cell)) {
                counts[node] += 1.0;
                for axis in 0..2 {
                    sums[node][axis] += self.velocities[cell][axis];
                }
            }
        }
        let mean = |(sum, count): ([f64; 2], f64)| sum.map(|v| v / f64::max(count, 1.0));
        std::iter::zip(sums, counts).map(mean).collect()
    }

    /// Places of equal discharge across the row or column of cells that passes most water.
    fn starts(&self, count: usize) -> Vec<[f64; 2]> {
        let mut best: (f64, Vec<Pass>) = (0.0, Vec::new());
        for axis in 0..2 {
            let other = 1 - axis;
            for along in 0..self.grid.axes[axis].cell_count() {
                let passes: Vec<Pass> = (0..self.grid.axes[other].cell_count())
                    .map(|across| {
                        let mut place = [0; 2];
                        (place[axis], place[other]) = (along, across);
                        let [lower, upper] = ends_of(&self.grid, place);
                        let cell = self.grid.cell_index(place);
                        let mut ends = [[0, 1].map(|d| 0.5 * (lower[d] + upper[d])); 2];
                        (ends[0][other], ends[1][other]) = (lower[other], upper[other]);
                        let thick = thickness(self.axisymmetric, 0.5 * (lower[0] + upper[0]));
                        let width = self.filled[cell] * (upper[other] - lower[other]) * thick;
                        (ends, self.velocities[cell][axis].abs() * width)
                    })
                    .collect();
                let all: f64 = passes.iter().map(|(_, flow)| flow).sum();
                if all > best.0 {
                    best = (all, passes);
                }
            }
        }
        let (all, passes) = best;
        let mut starts = Vec::new();
        let mut passed = 0.0;
        for ([from, to], flow) in passes {
            while starts.len() < count {
                let share = (all * (starts.len() as f64 + 0.5) / count as f64 - passed) / flow;
                if share.is_nan() || share >= 1.0 {
                    break;
                }
                starts.push([0, 1].map(|d| from[d] + share * (to[d] - from[d])));
            }
            passed += flow;
        }
        starts
    }

    /// Follows the flow, or goes against it, until the ground ends or the water rests.
    fn trace(&self, start: [f64; 2], sense: f64, velocities: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let fastest = velocities
            .iter()
            .map(|v| v[0].hypot(v[1]))
            .fold(0.0, f64::max);
        let cells = self.grid.axes.iter().map(igimp_shape::Axis::cell_count);
        let most = (BY_CELL * 4.0) as usize * cells.sum::<usize>();
        let direction = |x: &[f64; 2]| {
            let place = self.grid.cell_at(x)?;
            let cell = self.grid.cell_index(place);
            let [lower, upper] = ends_of(&self.grid, place);
            let basis = Basis::<2>::at([lower, upper], x);
            let mut velocity = [0.0; 2];
            for (k, node) in nodes_of(&self.grid, place).enumerate() {
                for axis in 0..2 {
                    velocity[axis] += basis.value[k] * velocities[node][axis];
                }
            }
            let speed = velocity[0].hypot(velocity[1]);
            let size = (upper[0] - lower[0]).min(upper[1] - lower[1]) / BY_CELL;
            let moves = self.filled[cell] > 0.0 && speed > 1e-4 * fastest;
            moves.then(|| velocity.map(|v| sense * v / speed * size))
        };
        let mut line: Vec<[f64; 2]> = Vec::new();
        let mut x = start;
        for _ in 0..most {
            let Some(first) = direction(&x) else { break };
            let middle = [0, 1].map(|axis| x[axis] + 0.5 * first[axis]);
            let Some(step) = direction(&middle) else {
                break;
            };
            x = [0, 1].map(|axis| x[axis] + step[axis]);
            if direction(&x).is_none() {
                break;
            }
            line.push(x);
        }
        line
    }
}
