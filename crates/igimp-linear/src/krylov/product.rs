//! The product of a tangent matrix with a vector, on several threads. The order of its sums depends on the matrix
//! alone.

use std::ops::Range;

use faer::traits::pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::TangentMatrix;

/// Nodes that one task works on in a symmetric matrix.
const CHUNK: usize = 256;
/// Parts that the columns of an unsymmetric matrix are cut into.
const PARTS: usize = 16;
/// Partial sums of a scalar product.
const LANES: usize = 8;

/// Memory for products.
#[derive(Default)]
pub(crate) struct Product {
    /// The contribution of each part of the columns to its rows, and the first of these.
    parts: Vec<(usize, Vec<f64>)>,
}

impl Product {
    /// y ← K x.
    pub(crate) fn multiply(&mut self, matrix: &TangentMatrix, x: &[f64], y: &mut [f64]) {
        if matrix.symmetric {
            by_rows(matrix, x, y);
        } else {
            self.by_columns(matrix, x, y);
        }
    }

    /// The products of parts of the columns, added up in their order.
    fn by_columns(&mut self, matrix: &TangentMatrix, x: &[f64], y: &mut [f64]) {
        let pattern = &*matrix.pattern;
        let nodes = pattern.blocks.len();
        self.parts.resize_with(PARTS, Default::default);
        self.parts
            .par_iter_mut()
            .enumerate()
            .for_each(|(part, (first, sums))| {
                let range = part * nodes / PARTS..(part + 1) * nodes / PARTS;
                let lists = range.clone().map(|node| pattern.coupled_to(node));
                let reach = lists.filter_map(|list| Some((*list.first()?, *list.last()?)));
                let (low, high) = reach.fold((u32::MAX, 0), |all, ends| {
                    (all.0.min(ends.0), all.1.max(ends.1))
                });
                sums.clear();
                if range.is_empty() {
                    return;
                }
                *first = pattern.blocks[low as usize].first;
                let end = pattern.blocks[high as usize];
                sums.resize(end.first + end.len - *first, 0.0);
                let first = *first;
                Arch::new().dispatch(Columns {
                    matrix,
                    range,
                    x,
                    first,
                    sums,
                });
            });
        y.fill(0.0);
        for (first, sums) in &self.parts {
            for (y, sum) in y[*first..].iter_mut().zip(sums) {
                *y += sum;
            }
        }
    }
}

/// The contribution of some columns to the rows from `first` on.
struct Columns<'a> {
    matrix: &'a TangentMatrix,
    range: Range<usize>,
    x: &'a [f64],
    first: usize,
    sums: &'a mut [f64],
}

impl WithSimd for Columns<'_> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self {
            matrix,
            range,
            x,
            first,
            sums,
        } = self;
        let pattern = &*matrix.pattern;
        for node in range {
            let block = pattern.blocks[node];
            let height = pattern.height(node);
            let columns = &matrix.values[pattern.values_of(node)];
            for (column, entries) in columns.chunks_exact(height).enumerate() {
                let value = x[block.first + column];
                let mut entries = entries;
                for run in pattern.runs(node) {
                    let (values, later) = entries.split_at(run.len());
                    entries = later;
                    let rows = &mut sums[run.start - first..run.end - first];
                    for (row, entry) in rows.iter_mut().zip(values) {
                        *row += entry * value;
                    }
                }
            }
        }
    }
}

/// The columns of a symmetric matrix are its rows.
fn by_rows(matrix: &TangentMatrix, x: &[f64], y: &mut [f64]) {
    let pattern = &*matrix.pattern;
    let nodes = pattern.blocks.len();
    let mut parts = Vec::with_capacity(nodes.div_ceil(CHUNK));
    let mut rest = y;
    for start in (0..nodes).step_by(CHUNK) {
        let end = (start + CHUNK).min(nodes);
        let last = pattern.blocks[end - 1];
        let len = last.first + last.len - pattern.blocks[start].first;
        let (part, later) = rest.split_at_mut(len);
        rest = later;
        parts.push((start..end, part));
    }
    parts.into_par_iter().for_each(|(range, part)| {
        Arch::new().dispatch(Rows {
            matrix,
            range,
            x,
            part,
        });
    });
}

/// The product of the columns of some nodes of a symmetric matrix, as rows.
struct Rows<'a> {
    matrix: &'a TangentMatrix,
    range: Range<usize>,
    x: &'a [f64],
    part: &'a mut [f64],
}

impl WithSimd for Rows<'_> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self {
            matrix,
            range,
            x,
            part,
        } = self;
        let pattern = &*matrix.pattern;
        let mut gathered = Vec::new();
        let mut part = part;
        for node in range {
            gathered.clear();
            for run in pattern.runs(node) {
                gathered.extend_from_slice(&x[run]);
            }
            let columns = &matrix.values[pattern.values_of(node)];
            let (rows, later) = std::mem::take(&mut part).split_at_mut(pattern.blocks[node].len);
            part = later;
            for (y, column) in rows.iter_mut().zip(columns.chunks_exact(gathered.len())) {
                *y = dot(column, &gathered);
            }
        }
    }
}

#[expect(
    clippy::inline_always,
    reason = "it takes the vector instructions of its caller"
)]
#[inline(always)]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut lanes = [0.0; LANES];
    let (mut a, mut b) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    for (a, b) in a.by_ref().zip(b.by_ref()) {
        for (lane, (a, b)) in lanes.iter_mut().zip(a.iter().zip(b)) {
            *lane += a * b;
        }
    }
    let mut sum = 0.0;
    for (a, b) in a.remainder().iter().zip(b.remainder()) {
        sum += a * b;
    }
    for lane in lanes {
        sum += lane;
    }
    sum
}
