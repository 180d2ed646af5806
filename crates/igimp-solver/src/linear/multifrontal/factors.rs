//! The factors of a matrix: computing them front by front, and solving with them.
//!
//! Every front adds up its contributions in the order of its children, and a subtree owns a
//! contiguous range of fronts, positions and factors: the bits of the result do not depend on when
//! a subtree is worked on.

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use igimp_assembly::TangentMatrix;

use super::super::LinearSolverError;
use super::dense::{PivotRecord, solve_lower, solve_upper};
use super::front::{BorderMap, Panels, pass_on};
use super::scaling::symmetric_scale;
use super::symbolic::Symbolic;

/// Factors of S K S in the order of elimination, and the memory to compute and use them.
#[derive(Default)]
pub(super) struct Factors {
    /// Panels of all fronts, one after the other.
    values: Vec<f64>,
    /// Row exchanges within the pivot block of each front, by position.
    exchanges: Vec<u32>,
    /// Diagonal of S, by unknown.
    scale: Vec<f64>,
    /// Contributions that wait for their parents.
    stacks: [Vec<f64>; 2],
    /// Row in the border of the current front, by position.
    local: Vec<usize>,
    /// The vector being solved for, by position.
    vector: Vec<f64>,
    /// Its part on the border of a front.
    border: Vec<f64>,
    pub(super) record: PivotRecord,
}

impl Factors {
    /// Computes the factors of a matrix with the analysed pattern and finite values.
    pub(super) fn compute(
        &mut self,
        symbolic: &Symbolic,
        matrix: &TangentMatrix,
    ) -> Result<(), LinearSolverError> {
        self.reserve(symbolic)?;
        self.scale = symmetric_scale(matrix);
        self.record = PivotRecord::default();
        let mut map = BorderMap::default();
        let mut values = &mut self.values[..];
        let mut exchanges = &mut self.exchanges[..];
        for front in &symbolic.fronts {
            let (own_values, later_values) = values.split_at_mut(front.factor_len());
            let (own_exchanges, later_exchanges) = exchanges.split_at_mut(front.pivots);
            (values, exchanges) = (later_values, later_exchanges);
            let [even, odd] = &mut self.stacks;
            let (own, below) = if front.stack == 0 {
                (even, &*odd)
            } else {
                (odd, &*even)
            };
            let contribution = &mut own[front.contribution.clone()];
            let children = front.children.iter().map(|&child| {
                let child = &symbolic.fronts[child];
                (
                    &symbolic.borders[child.border.clone()],
                    &below[child.contribution.clone()],
                )
            });

            for (row, &position) in symbolic.borders[front.border.clone()].iter().enumerate() {
                self.local[position] = row;
            }
            let mut panels = Panels::new(front, own_values);
            panels.load(front, symbolic, matrix, &self.scale, &self.local);
            for (border, child) in children.clone() {
                map.set(border, front, &self.local);
                panels.add(front, child, &map);
            }
            panels.eliminate(front, own_exchanges, contribution, &mut self.record);
            for (border, child) in children {
                map.set(border, front, &self.local);
                pass_on(front, child, &map, contribution);
            }
        }
        Ok(())
    }

    /// Allocates what the plan asks for, keeping what is there already.
    fn reserve(&mut self, symbolic: &Symbolic) -> Result<(), LinearSolverError> {
        let unknowns = symbolic.order.len();
        let largest_border = symbolic.fronts.iter().map(|front| front.border.len()).max();
        make_room(&mut self.values, symbolic.factor_len, "LU factors")?;
        for (stack, &len) in self.stacks.iter_mut().zip(&symbolic.stack_len) {
            make_room(stack, len, "LU contributions")?;
        }
        make_room(&mut self.vector, unknowns, "vector")?;
        make_room(&mut self.border, largest_border.unwrap_or(0), "vector")?;
        self.exchanges.resize(unknowns, 0);
        self.local.resize(unknowns, 0);
        Ok(())
    }

    /// Replaces a vector by (an approximation of) K⁻¹ times it.
    pub(super) fn solve(&mut self, symbolic: &Symbolic, vector: &mut [f64]) {
        for (entry, &unknown) in self.vector.iter_mut().zip(&symbolic.order) {
            *entry = vector[unknown] * self.scale[unknown];
        }
        self.forward(symbolic);
        self.backward(symbolic);
        for (&entry, &unknown) in self.vector.iter().zip(&symbolic.order) {
            vector[unknown] = entry * self.scale[unknown];
        }
    }

    /// y ← L⁻¹ P y, children before parents.
    fn forward(&mut self, symbolic: &Symbolic) {
        let mut values = &self.values[..];
        for front in &symbolic.fronts {
            let (w, r) = (front.pivots, front.border.len());
            let (own, later) = values.split_at(front.factor_len());
            values = later;
            let (head, tail) = self.vector.split_at_mut(front.first + w);
            let pivots = &mut head[front.first..];
            solve_lower(&own[..w * w], &self.exchanges[front.first..][..w], pivots);
            if r > 0 {
                let lower = MatRef::from_column_major_slice(&own[w * w..][..r * w], r, w);
                let border = &mut self.border[..r];
                let product = MatMut::from_column_major_slice_mut(border, r, 1);
                let pivots = MatRef::from_column_major_slice(&*pivots, w, 1);
                matmul(product, Accum::Replace, lower, pivots, 1.0, Par::Seq);
                for (&position, &value) in
                    symbolic.borders[front.border.clone()].iter().zip(&*border)
                {
                    tail[position - front.first - w] -= value;
                }
            }
        }
    }

    /// y ← U⁻¹ y, parents before children.
    fn backward(&mut self, symbolic: &Symbolic) {
        let mut values = &self.values[..symbolic.factor_len];
        for front in symbolic.fronts.iter().rev() {
            let (w, r) = (front.pivots, front.border.len());
            let (earlier, own) = values.split_at(values.len() - front.factor_len());
            values = earlier;
            let (head, tail) = self.vector.split_at_mut(front.first + w);
            let pivots = &mut head[front.first..];
            if r > 0 {
                let border = &mut self.border[..r];
                for (value, &position) in border
                    .iter_mut()
                    .zip(&symbolic.borders[front.border.clone()])
                {
                    *value = tail[position - front.first - w];
                }
                let upper = MatRef::from_column_major_slice(&own[w * (w + r)..], r, w);
                let border = MatRef::from_column_major_slice(&*border, r, 1);
                let target = MatMut::from_column_major_slice_mut(&mut *pivots, w, 1);
                matmul(
                    target,
                    Accum::Add,
                    upper.transpose(),
                    border,
                    -1.0,
                    Par::Seq,
                );
            }
            solve_upper(&own[..w * w], pivots);
        }
    }
}

/// Makes room for `len` entries; what was there before is of no interest.
///
/// Memory is kept while it suffices, and some is added to spare when it does not: a body that
/// spreads over the grid asks for a little more in every step. Fresh memory comes zeroed from the
/// system and is not touched before it is used.
fn make_room(
    values: &mut Vec<f64>,
    len: usize,
    what: &'static str,
) -> Result<(), LinearSolverError> {
    if values.len() < len {
        *values = Vec::new();
        let roomy = len + len / 16;
        values
            .try_reserve_exact(roomy)
            .map_err(|_| LinearSolverError::OutOfMemory { what })?;
        *values = Vec::new();
        *values = vec![0.0; roomy];
    }
    Ok(())
}
