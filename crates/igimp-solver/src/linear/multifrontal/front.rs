//! One front: assembling the rows and columns of its pivots and eliminating them.
//!
//! I. S. Duff & J. K. Reid, *The multifrontal solution of indefinite sparse symmetric linear
//! systems*, ACM Trans. Math. Softw. 9 (1983), and for unsymmetric values on a symmetric pattern,
//! SIAM J. Sci. Stat. Comput. 5 (1984). With w pivots and r border unknowns the front is
//!
//! ```text
//!         w     r
//!   w  [  A     Uᵀ ]    A → P A = L₁ U₁ within the block
//!   r  [  L     C  ]    U → (L₁⁻¹ P Uᵀ)ᵀ,  L → L U₁⁻¹,  C = contributions − L Uᵀ
//! ```
//!
//! All blocks are stored by columns, and U transposed, so that both border blocks are tall.

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_unit_lower_triangular_in_place,
};
use faer::{Accum, MatMut, MatRef, Par};
use igimp_assembly::TangentMatrix;

use super::dense::{PivotRecord, exchange_columns, factor_block};
use super::symbolic::{Front, Symbolic};

/// The factors of a front.
pub(super) struct Panels<'a> {
    /// w × w pivot block.
    pub(super) pivots: &'a mut [f64],
    /// r × w block below it.
    pub(super) lower: &'a mut [f64],
    /// r × w transpose of the block beside it.
    pub(super) upper: &'a mut [f64],
}

impl<'a> Panels<'a> {
    /// Divides the stored factors of a front.
    pub(super) fn new(front: &Front, factors: &'a mut [f64]) -> Self {
        let (pivots, borders) = factors.split_at_mut(front.pivots * front.pivots);
        let (lower, upper) = borders.split_at_mut(front.border.len() * front.pivots);
        Self {
            pivots,
            lower,
            upper,
        }
    }

    /// Sets the panels to the entries of the scaled matrix. `local` gives the row in the border of
    /// each position of the border.
    pub(super) fn load(
        &mut self,
        front: &Front,
        symbolic: &Symbolic,
        matrix: &TangentMatrix,
        scale: &[f64],
        local: &[usize],
    ) {
        let (w, r) = (front.pivots, front.border.len());
        self.pivots.fill(0.0);
        self.lower.fill(0.0);
        self.upper.fill(0.0);
        let pattern = &symbolic.pattern;
        for k in 0..w {
            let unknown = symbolic.order[front.first + k];
            for entry in pattern.col_ptr[unknown]..pattern.col_ptr[unknown + 1] {
                let other = pattern.row_idx[entry];
                let position = symbolic.position[other];
                if position < front.first {
                    continue;
                }
                let scale = scale[unknown] * scale[other];
                let value = matrix.values[entry] * scale;
                if position < front.first + w {
                    self.pivots[k * w + position - front.first] = value;
                } else {
                    let place = k * r + local[position];
                    let mirrored = symbolic.transposed[entry] as usize;
                    self.lower[place] = value;
                    self.upper[place] = matrix.values[mirrored] * scale;
                }
            }
        }
    }

    /// Adds what a child contributes to the rows and columns of the pivots.
    pub(super) fn add(&mut self, front: &Front, child: &[f64], map: &BorderMap) {
        let (w, r) = (front.pivots, front.border.len());
        let (into_pivots, into_border) = map.runs.split_at(map.pivot_runs);
        for columns in into_pivots {
            for k in 0..columns.len {
                let source = &child[(columns.source + k) * map.rows..][..map.rows];
                let column = columns.target + k;
                add_runs(&mut self.pivots[column * w..][..w], source, into_pivots);
                add_runs(&mut self.lower[column * r..][..r], source, into_border);
            }
        }
        for columns in into_border {
            for k in 0..columns.len {
                let source = &child[(columns.source + k) * map.rows..][..map.rows];
                for rows in into_pivots {
                    for j in 0..rows.len {
                        self.upper[(rows.target + j) * r + columns.target + k] +=
                            source[rows.source + j];
                    }
                }
            }
        }
    }

    /// Eliminates the pivots and sets `contribution` to − L Uᵀ.
    pub(super) fn eliminate(
        &mut self,
        front: &Front,
        exchanges: &mut [u32],
        contribution: &mut [f64],
        record: &mut PivotRecord,
    ) {
        let (w, r) = (front.pivots, front.border.len());
        factor_block(self.pivots, exchanges, front.first, record);
        if r == 0 {
            return;
        }
        exchange_columns(self.upper, r, exchanges);
        let factored = MatRef::from_column_major_slice(&*self.pivots, w, w);
        let mut upper = MatMut::from_column_major_slice_mut(self.upper, r, w);
        let mut lower = MatMut::from_column_major_slice_mut(self.lower, r, w);
        solve_unit_lower_triangular_in_place(factored, upper.as_mut().transpose_mut(), Par::Seq);
        solve_lower_triangular_in_place(
            factored.transpose(),
            lower.as_mut().transpose_mut(),
            Par::Seq,
        );
        let contribution = MatMut::from_column_major_slice_mut(contribution, r, r);
        let (lower, upper) = (lower.as_ref(), upper.as_ref().transpose());
        matmul(contribution, Accum::Replace, lower, upper, -1.0, Par::Seq);
    }
}

/// Adds the part of a child's contribution that the parent passes on.
pub(super) fn pass_on(front: &Front, child: &[f64], map: &BorderMap, contribution: &mut [f64]) {
    let r = front.border.len();
    let into_border = &map.runs[map.pivot_runs..];
    for columns in into_border {
        for k in 0..columns.len {
            let source = &child[(columns.source + k) * map.rows..][..map.rows];
            add_runs(
                &mut contribution[(columns.target + k) * r..][..r],
                source,
                into_border,
            );
        }
    }
}

/// Consecutive border unknowns of a child that are consecutive in the parent.
struct Run {
    /// First of them in the border of the child.
    source: usize,
    /// First of them among the pivots or in the border of the parent.
    target: usize,
    len: usize,
}

/// Where the border of a child lies in its parent: first runs among the pivots, then in the border.
#[derive(Default)]
pub(super) struct BorderMap {
    rows: usize,
    runs: Vec<Run>,
    pivot_runs: usize,
}

impl BorderMap {
    /// Maps the ascending positions of the border of a child, with `local` as in [`Panels::load`].
    pub(super) fn set(&mut self, child: &[usize], parent: &Front, local: &[usize]) {
        let end = parent.first + parent.pivots;
        self.rows = child.len();
        self.runs.clear();
        self.pivot_runs = 0;
        for (source, &position) in child.iter().enumerate() {
            let among_pivots = position < end;
            let target = if among_pivots {
                position - parent.first
            } else {
                local[position]
            };
            let begins = among_pivots || self.runs.len() > self.pivot_runs;
            match self.runs.last_mut() {
                Some(run) if begins && run.target + run.len == target => run.len += 1,
                _ => self.runs.push(Run {
                    source,
                    target,
                    len: 1,
                }),
            }
            if among_pivots {
                self.pivot_runs = self.runs.len();
            }
        }
    }
}

/// Adds runs of `source` where they belong in `target`.
fn add_runs(target: &mut [f64], source: &[f64], runs: &[Run]) {
    for run in runs {
        let into = &mut target[run.target..run.target + run.len];
        for (into, &value) in into
            .iter_mut()
            .zip(&source[run.source..run.source + run.len])
        {
            *into += value;
        }
    }
}
