//! The skin of a body: nodes that carry little soil, solved for directly before and after each cycle of multigrid (theory,
//! eq. 25d).
//!
//! Where a surface cuts cells, few particles hold several nodes, and some motions of those nodes strain none of
//! them or hardly: next to nothing resists. No smoother sees such motions, and no coarse grid has them. They are local, so
//! that a factorisation of the rows of these nodes alone, in double precision, takes them out. F. de Prenter et al., *Multigrid solvers for
//! immersed finite element methods and immersed isogeometric analysis*, Comput. Mech. 65 (2020), smooth by patches of cells
//! for the same reason.

use std::sync::Arc;

use crate::multifrontal::Engine;
use crate::refine::Accuracy;
use crate::{NodeBlock, Pattern, TangentMatrix};

/// A node whose diagonal is less than this of the largest one that it is coupled to belongs to the skin \[-\]. A choice: a node of a
/// level surface has a half and stays outside, one of an edge a quarter and less.
const WEAK: f64 = 0.3;
/// Factors of a skin that are larger than this are not made \[bytes\]. A choice: a quarter of what factors of the whole are
/// allowed by default where nobody knows the machine, and the same on every machine, so that iterations are too.
const MOST_BYTES: usize = 2 << 30;
/// A solution is taken as the factors give it.
const ONCE: Accuracy = Accuracy {
    target: 1.0,
    tolerance: 1.0,
    max_refinements: 0,
};

/// The nodes of the skin and the factors of their rows.
#[derive(Default)]
pub(crate) struct BoundaryNodes {
    /// Blocks of the pattern, ascending.
    nodes: Vec<u32>,
    engine: Engine,
    /// Rows and columns of the skin, while they are factorised.
    matrix: Option<TangentMatrix>,
    /// Whether the rows of the skin of a symmetric matrix are not positive definite: then it is not, either.
    pub(crate) is_indefinite: bool,
    rhs: Vec<f64>,
    change: Vec<f64>,
}

impl BoundaryNodes {
    /// Finds the skin of a matrix and factorises its rows; where that fails, there is none.
    pub(crate) fn set(&mut self, matrix: &TangentMatrix, diagonal: &[f64]) {
        self.matrix = None;
        self.is_indefinite = false;
        self.find(&matrix.pattern, diagonal);
        if self.nodes.is_empty() {
            return;
        }
        let part = self.part(matrix);
        self.engine.accuracy = ONCE;
        let analysed = self.engine.analyse(&part.pattern);
        if analysed.is_err() || self.engine.cost(matrix.symmetric).0 > MOST_BYTES {
            return;
        }
        let definite = matrix.symmetric && self.engine.factor_cholesky(&part).is_ok();
        self.is_indefinite = matrix.symmetric && !definite;
        if definite || self.engine.factor_lu(&part).is_ok() {
            self.matrix = Some(part);
        }
    }

    /// Finds the nodes whose diagonal is small beside those of their neighbours.
    fn find(&mut self, pattern: &Pattern, diagonal: &[f64]) {
        let largest = |entries: &[f64]| entries.iter().fold(0.0, |most: f64, x| most.max(*x));
        let size = |block: &NodeBlock| largest(&diagonal[block.first..block.first + block.len]);
        let sizes: Vec<f64> = pattern.blocks.iter().map(size).collect();
        let is_weak = |&node: &u32| {
            let near = pattern.coupled_to(node as usize).iter();
            let most = near.fold(0.0, |most: f64, &other| most.max(sizes[other as usize]));
            sizes[node as usize] < WEAK * most
        };
        self.nodes.clear();
        self.nodes.extend((0..sizes.len() as u32).filter(is_weak));
    }

    /// Rows and columns of the skin.
    fn part(&self, matrix: &TangentMatrix) -> TangentMatrix {
        let pattern = &*matrix.pattern;
        let mut index = vec![u32::MAX; pattern.blocks.len()];
        let mut blocks = Vec::with_capacity(self.nodes.len());
        let mut first = 0;
        for (number, &node) in self.nodes.iter().enumerate() {
            index[node as usize] = number as u32;
            let block = pattern.blocks[node as usize];
            blocks.push(NodeBlock { first, ..block });
            first += block.len;
        }
        let (mut starts, mut coupled, mut values) = (vec![0], Vec::new(), Vec::new());
        for &node in &self.nodes {
            let list = pattern.coupled_to(node as usize);
            let known = list.iter().map(|&other| index[other as usize]);
            coupled.extend(known.filter(|&number| number != u32::MAX));
            starts.push(coupled.len());
            let columns = &matrix.values[pattern.values_of(node as usize)];
            for column in columns.chunks_exact(pattern.height(node as usize)) {
                let mut at = 0;
                for &other in list {
                    let len = pattern.blocks[other as usize].len;
                    if index[other as usize] != u32::MAX {
                        values.extend_from_slice(&column[at..at + len]);
                    }
                    at += len;
                }
            }
        }
        let pattern = Pattern::new(blocks, starts, coupled, pattern.reach);
        TangentMatrix {
            values,
            ..TangentMatrix::zeros(Arc::new(pattern), matrix.symmetric)
        }
    }

    /// Whether there is a skin.
    pub(crate) fn is_there(&self) -> bool {
        self.matrix.is_some()
    }

    /// Solves for the skin alone: `z` gets the solution for the rows of the skin of `r`, and `r` becomes r − K z.
    pub(crate) fn before(&mut self, matrix: &TangentMatrix, r: &mut [f64]) {
        self.rhs.clear();
        let pattern = &*matrix.pattern;
        for &node in &self.nodes {
            let block = pattern.blocks[node as usize];
            self.rhs
                .extend_from_slice(&r[block.first..block.first + block.len]);
        }
        self.solve();
        let mut row = 0;
        for &node in &self.nodes {
            let columns = &matrix.values[pattern.values_of(node as usize)];
            for column in columns.chunks_exact(pattern.height(node as usize)) {
                let value = self.change[row];
                row += 1;
                let mut left = column;
                for run in pattern.runs(node as usize) {
                    let (entries, later) = left.split_at(run.len());
                    left = later;
                    for (r, entry) in r[run].iter_mut().zip(entries) {
                        *r -= entry * value;
                    }
                }
            }
        }
    }

    /// z ← z + the change that was found.
    pub(crate) fn add(&self, matrix: &TangentMatrix, z: &mut [f64]) {
        let mut row = 0;
        for &node in &self.nodes {
            let block = matrix.pattern.blocks[node as usize];
            for z in &mut z[block.first..block.first + block.len] {
                *z += self.change[row];
                row += 1;
            }
        }
    }

    /// Solves for the skin with the residual of its rows; the matrix is symmetric.
    pub(crate) fn after(&mut self, matrix: &TangentMatrix, r: &[f64], z: &mut [f64]) {
        self.rhs.clear();
        let pattern = &*matrix.pattern;
        for &node in &self.nodes {
            let block = pattern.blocks[node as usize];
            let columns = &matrix.values[pattern.values_of(node as usize)];
            let height = pattern.height(node as usize);
            for (column, r) in columns.chunks_exact(height).zip(&r[block.first..]) {
                let mut left = column;
                let mut sum = *r;
                for run in pattern.runs(node as usize) {
                    let (entries, later) = left.split_at(run.len());
                    left = later;
                    for (z, entry) in z[run].iter().zip(entries) {
                        sum -= entry * z;
                    }
                }
                self.rhs.push(sum);
            }
        }
        self.solve();
        self.add(matrix, z);
    }

    fn solve(&mut self) {
        self.change.clear();
        self.change.resize(self.rhs.len(), 0.0);
        if let Some(matrix) = &self.matrix
            && self
                .engine
                .solve(matrix, &self.rhs, &mut self.change)
                .is_err()
        {
            self.change.fill(0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NODES: usize = 12;
    const WEAK_NODES: [usize; 3] = [0, 5, 11];

    /// Couplings of a chain whose ends and one node between carry little; by column and row.
    fn entry(column: usize, row: usize) -> f64 {
        let weight = |node: usize| if WEAK_NODES.contains(&node) { 0.1 } else { 1.0 };
        match column.abs_diff(row) {
            0 => 2.5 * weight(column),
            1 => -0.4 * weight(column) * weight(row),
            _ => 0.0,
        }
    }

    fn chain() -> TangentMatrix {
        let block = |first| NodeBlock {
            first,
            len: 1,
            free: 1,
            place: [first, 0, 0],
        };
        let (mut starts, mut coupled, mut values) = (vec![0], Vec::new(), Vec::new());
        for column in 0..NODES {
            for row in (0..NODES).filter(|row| row.abs_diff(column) <= 1) {
                coupled.push(row as u32);
                values.push(entry(column, row));
            }
            starts.push(coupled.len());
        }
        let pattern = Pattern::new((0..NODES).map(block).collect(), starts, coupled, 1);
        TangentMatrix {
            values,
            ..TangentMatrix::zeros(Arc::new(pattern), true)
        }
    }

    // GOAL: both solutions for the skin leave nothing of its rows: what comes between sees the rest alone.
    // CASE: a chain whose ends and one node between carry little; a residual of its own in every row.
    // ORACLE: eq. 25d with K by hand: r − K z, which is zero in the rows of the skin after S.
    #[test]
    fn solutions_for_the_skin_leave_nothing_of_its_rows() {
        let matrix = chain();
        let diagonal: Vec<f64> = (0..NODES).map(|k| entry(k, k)).collect();
        let mut skin = BoundaryNodes::default();
        skin.set(&matrix, &diagonal);
        assert!(skin.is_there() && !skin.is_indefinite);
        assert_eq!(skin.nodes, WEAK_NODES.map(|k| k as u32));
        let r: Vec<f64> = (0..NODES).map(|k| (k as f64 * 1.7).sin()).collect();
        let left_of = |z: &[f64]| -> Vec<f64> {
            let row = |i: usize| r[i] - (0..NODES).map(|j| entry(j, i) * z[j]).sum::<f64>();
            (0..NODES).map(row).collect()
        };
        let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-14);

        let (mut rest, mut z) = (r.clone(), vec![0.0; NODES]);
        skin.before(&matrix, &mut rest);
        skin.add(&matrix, &mut z);
        assert!(near(&rest, &left_of(&z)), "{rest:?}");
        assert!(
            WEAK_NODES.iter().all(|&k| rest[k].abs() < 1e-14),
            "{rest:?}"
        );

        // A cycle between the two changes z everywhere.
        z.iter_mut()
            .enumerate()
            .for_each(|(k, z)| *z += 0.1 * k as f64);
        skin.after(&matrix, &r, &mut z);
        let left = left_of(&z);
        assert!(
            WEAK_NODES.iter().all(|&k| left[k].abs() < 1e-14),
            "{left:?}"
        );
    }
}
