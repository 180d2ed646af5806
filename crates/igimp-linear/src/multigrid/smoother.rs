//! Incomplete elimination without fill, by blocks: (D + L) D⁻¹ (D + U) ≈ A, as a smoother (theory, eq. 25b).
//!
//! J. A. Meijerink & H. A. van der Vorst, *An iterative solution method for linear systems of which the coefficient
//! matrix is a symmetric M-matrix*, Math. Comp. 31 (1977); Y. Saad, *Iterative Methods for Sparse Linear Systems*, 2nd ed.,
//! SIAM 2003, sections 10.3 and 10.4. With the off-diagonal blocks of A itself and its diagonal it is a symmetric
//! Gauss-Seidel sweep.

use faer::traits::pulp::{Arch, Simd, WithSimd};

use super::rows::{Couplings, row_products};
use super::slabs::{Parts, Slabs};

/// A pivot that has lost more of its diagonal entry than this is not sound.
const LEAST: f32 = 1e-2;

/// Marks a node that is not in the list at hand.
const NONE: u32 = u32::MAX;

/// How D, L and U are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Those of A: symmetric Gauss-Seidel by blocks.
    GaussSeidel,
    /// Incomplete factors on the pattern of A.
    Incomplete,
}

/// A smoother for one matrix.
#[derive(Clone, Debug, Default)]
pub(super) struct Smoother {
    /// L and U, in the places of A; empty where they are those of A.
    values: Vec<f32>,
    /// The inverse of D.
    inverse: Vec<f32>,
    /// Pivots that had to be replaced.
    pub(super) replaced: usize,
    /// The factor of its corrections \[-\].
    pub(super) omega: f32,
}

impl Smoother {
    /// Sets the smoother up for a matrix, whose diagonal is raised by a share of itself.
    pub(super) fn set<const B: usize>(
        &mut self,
        kind: Kind,
        shift: f32,
        couplings: &Couplings,
        slabs: &Slabs,
        matrix: &[f32],
    ) {
        let nodes = couplings.len();
        self.omega = 1.0;
        self.inverse.clear();
        self.inverse.resize(nodes * (B * B + 1), 0.0);
        match kind {
            Kind::GaussSeidel => {
                self.values = Vec::new();
                for (node, inverse) in self.inverse.chunks_exact_mut(B * B + 1).enumerate() {
                    let block = diagonal_block::<B>(couplings, node, matrix);
                    inverse[B * B] = f32::from(invert::<B>(&block, &block, inverse));
                }
            }
            Kind::Incomplete => {
                self.values.clear();
                self.values.extend_from_slice(matrix);
                // Values and inverses are worked on together.
                let job = Elimination::<B> {
                    couplings,
                    slabs,
                    matrix,
                    shift,
                };
                job.run(&mut self.values, &mut self.inverse);
            }
        }
        let flags = self.inverse.chunks_exact(B * B + 1).map(|x| x[B * B]);
        self.replaced = flags.filter(|&flag| flag != 0.0).count();
    }

    /// x ← (D + U)⁻¹ D (D + L)⁻¹ b.
    pub(super) fn apply<const B: usize>(
        &self,
        couplings: &Couplings,
        slabs: &Slabs,
        matrix: &[f32],
        rhs: &[f32],
        x: &mut [f32],
    ) {
        let values = if self.values.is_empty() {
            matrix
        } else {
            &self.values[..]
        };
        let sweep = Sweep::<B> {
            couplings,
            slabs,
            values,
            inverse: &self.inverse,
        };
        let first = |node| B * node;
        for odd in [false, true] {
            slabs.each(odd, x, first, |slab, parts| {
                Arch::new().dispatch(Forward {
                    sweep: &sweep,
                    slab,
                    rhs,
                    parts,
                });
            });
        }
        for odd in [true, false] {
            slabs.each(odd, x, first, |slab, parts| {
                Arch::new().dispatch(Backward {
                    sweep: &sweep,
                    slab,
                    parts,
                });
            });
        }
    }
}

struct Sweep<'a, const B: usize> {
    couplings: &'a Couplings,
    slabs: &'a Slabs,
    values: &'a [f32],
    inverse: &'a [f32],
}

impl<const B: usize> Sweep<'_, B> {
    /// x ← (D + L)⁻¹ b.
    #[expect(
        clippy::inline_always,
        reason = "it takes the vector instructions of its caller"
    )]
    #[inline(always)]
    fn forward(&self, slab: usize, rhs: &[f32], parts: &mut Parts<'_, f32>) {
        for node in self.slabs.nodes(slab) {
            let split = self.slabs.split(slab, node, self.couplings);
            let [before, after, within] = &split.lower;
            let mut left: [f32; B] = std::array::from_fn(|k| rhs[B * node + k]);
            self.subtract(node, before, parts.neighbours[0], &mut left);
            self.subtract(node, within, (parts.before, parts.slab), &mut left);
            self.subtract(node, after, parts.neighbours[1], &mut left);
            let found = self.divide(node, &left);
            parts.slab[B * node - parts.before..][..B].copy_from_slice(&found);
        }
    }

    /// x ← (D + U)⁻¹ D x.
    #[expect(
        clippy::inline_always,
        reason = "it takes the vector instructions of its caller"
    )]
    #[inline(always)]
    fn backward(&self, slab: usize, parts: &mut Parts<'_, f32>) {
        for node in self.slabs.nodes(slab).rev() {
            let split = self.slabs.split(slab, node, self.couplings);
            let [before, within, after] = &split.upper;
            let mut left = [0.0; B];
            self.subtract(node, before, parts.neighbours[0], &mut left);
            self.subtract(node, within, (parts.before, parts.slab), &mut left);
            self.subtract(node, after, parts.neighbours[1], &mut left);
            let found = self.divide(node, &left);
            for (x, found) in parts.slab[B * node - parts.before..][..B]
                .iter_mut()
                .zip(found)
            {
                *x += found;
            }
        }
    }

    #[expect(
        clippy::inline_always,
        reason = "it takes the vector instructions of its caller"
    )]
    #[inline(always)]
    fn subtract(
        &self,
        node: usize,
        range: &std::ops::Range<usize>,
        (before, x): (usize, &[f32]),
        left: &mut [f32; B],
    ) {
        if range.is_empty() {
            return;
        }
        let list = self.couplings.of(node);
        let entries = &self.values[self.couplings.first::<B>(node)..][..B * B * list.len()];
        let width = B * list.len();
        let sums = row_products::<B>(
            entries,
            width,
            B * range.start,
            &list[range.clone()],
            x,
            before,
        );
        for (left, sum) in left.iter_mut().zip(sums) {
            *left -= sum;
        }
    }

    #[expect(
        clippy::inline_always,
        reason = "it takes the vector instructions of its caller"
    )]
    #[inline(always)]
    fn divide(&self, node: usize, left: &[f32; B]) -> [f32; B] {
        let inverse = &self.inverse[node * (B * B + 1)..];
        std::array::from_fn(|r| (0..B).map(|c| inverse[B * r + c] * left[c]).sum())
    }
}

/// A sweep through a slab.
struct Forward<'a, 'p, const B: usize> {
    sweep: &'a Sweep<'a, B>,
    slab: usize,
    rhs: &'a [f32],
    parts: &'a mut Parts<'p, f32>,
}

impl<const B: usize> WithSimd for Forward<'_, '_, B> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.sweep.forward(self.slab, self.rhs, self.parts);
    }
}

/// A sweep back through a slab.
struct Backward<'a, 'p, const B: usize> {
    sweep: &'a Sweep<'a, B>,
    slab: usize,
    parts: &'a mut Parts<'p, f32>,
}

impl<const B: usize> WithSimd for Backward<'_, '_, B> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.sweep.backward(self.slab, self.parts);
    }
}

struct Elimination<'a, const B: usize> {
    couplings: &'a Couplings,
    slabs: &'a Slabs,
    matrix: &'a [f32],
    shift: f32,
}

impl<const B: usize> Elimination<'_, B> {
    fn run(&self, values: &mut [f32], inverse: &mut [f32]) {
        let first = |node| self.couplings.first::<B>(node);
        let mut stored: Vec<f32> = inverse.to_vec();
        for odd in [false, true] {
            // The inverses of one colour are worked on beside its values.
            let done = std::sync::Mutex::new(Vec::new());
            let known = &stored;
            self.slabs.each(odd, values, first, |slab, parts| {
                let nodes = self.slabs.nodes(slab);
                let size = B * B + 1;
                let mut inverses = vec![0.0; size * nodes.len()];
                let mut local = vec![NONE; self.couplings.len()];
                for node in nodes.clone() {
                    Arch::new().dispatch(Row {
                        elimination: self,
                        place: (slab, node),
                        parts,
                        inverses: (known, nodes.start, &mut inverses),
                        local: &mut local,
                    });
                }
                done.lock()
                    .unwrap_or_else(std::sync::PoisonError::into_inner)
                    .push((nodes.start, inverses));
            });
            for (start, inverses) in done
                .into_inner()
                .unwrap_or_else(std::sync::PoisonError::into_inner)
            {
                let first = start * (B * B + 1);
                stored[first..first + inverses.len()].copy_from_slice(&inverses);
            }
        }
        inverse.copy_from_slice(&stored);
    }

    #[expect(
        clippy::inline_always,
        reason = "it takes the vector instructions of its caller"
    )]
    #[inline(always)]
    fn row(
        &self,
        slab: usize,
        node: usize,
        parts: &mut Parts<'_, f32>,
        (known, start, inverses): (&[f32], usize, &mut [f32]),
        local: &mut [u32],
    ) {
        let size = B * B + 1;
        let list = self.couplings.of(node);
        let width = B * list.len();
        let split = self.slabs.split(slab, node, self.couplings);
        for (place, &other) in list.iter().enumerate() {
            local[other as usize] = place as u32;
        }
        let first = self.couplings.first::<B>(node) - parts.before;
        let (earlier, row) = parts.slab.split_at_mut(first);
        let row = &mut row[..B * width];
        if self.shift > 0.0 {
            let place = self.couplings.diagonal[node] as usize;
            for k in 0..B {
                row[k * width + B * place + k] *= 1.0 + self.shift;
            }
        }
        let sources = [
            parts.neighbours[0],
            parts.neighbours[1],
            (parts.before, &*earlier),
        ];
        for (which, (range, (before, source))) in split.lower.iter().zip(sources).enumerate() {
            let slab_of = match which {
                0 => slab.wrapping_sub(1),
                1 => slab + 1,
                _ => slab,
            };
            for place in range.clone() {
                let other = list[place] as usize;
                let others = self.couplings.of(other);
                let step = B * others.len();
                let entries = &source[self.couplings.first::<B>(other) - before..][..B * step];
                let inverse = if which == 2 {
                    &inverses[(other - start) * size..][..size]
                } else {
                    &known[other * size..][..size]
                };
                let factor = times_inverse::<B>(row, (width, place), inverse);
                for range in self.slabs.split(slab_of, other, self.couplings).upper {
                    let mut next = range.start;
                    while next < range.end {
                        let into = local[others[next] as usize];
                        if into == NONE {
                            next += 1;
                            continue;
                        }
                        let begin = next;
                        next += 1;
                        while next < range.end
                            && local[others[next] as usize] == into + (next - begin) as u32
                        {
                            next += 1;
                        }
                        let len = B * (next - begin);
                        for (r, factor) in factor.iter().enumerate() {
                            let target = &mut row[r * width + B * into as usize..][..len];
                            subtract_rows::<B>(target, factor, entries, step, B * begin);
                        }
                    }
                }
            }
        }
        for &other in list {
            local[other as usize] = NONE;
        }
        let mut block = [0.0; 9];
        let place = self.couplings.diagonal[node] as usize;
        for r in 0..B {
            block[B * r..][..B].copy_from_slice(&row[r * width + B * place..][..B]);
        }
        let original = diagonal_block::<B>(self.couplings, node, self.matrix);
        let into = &mut inverses[(node - start) * size..][..size];
        into[B * B] = f32::from(invert::<B>(&block, &original, into));
    }
}

/// The block at a place of rows of a width, times the inverse of a diagonal block.
#[expect(
    clippy::inline_always,
    reason = "it takes the vector instructions of its caller"
)]
#[inline(always)]
fn times_inverse<const B: usize>(
    rows: &[f32],
    (width, place): (usize, usize),
    inverse: &[f32],
) -> [[f32; B]; B] {
    std::array::from_fn(|r| {
        let entry = &rows[r * width + B * place..][..B];
        std::array::from_fn(|c| (0..B).map(|k| entry[k] * inverse[B * k + c]).sum())
    })
}

/// The elimination of the row of a node in a slab.
struct Row<'a, 'p, const B: usize> {
    elimination: &'a Elimination<'a, B>,
    place: (usize, usize),
    parts: &'a mut Parts<'p, f32>,
    inverses: (&'a [f32], usize, &'a mut [f32]),
    local: &'a mut [u32],
}

impl<const B: usize> WithSimd for Row<'_, '_, B> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (slab, node) = self.place;
        self.elimination
            .row(slab, node, self.parts, self.inverses, self.local);
    }
}

/// target ← target − Σ factor_k row_k.
#[expect(
    clippy::inline_always,
    reason = "it takes the vector instructions of its caller"
)]
#[inline(always)]
fn subtract_rows<const B: usize>(
    target: &mut [f32],
    factor: &[f32; B],
    entries: &[f32],
    step: usize,
    begin: usize,
) {
    let len = target.len();
    if B == 3 {
        let (a, b, c) = (
            &entries[begin..][..len],
            &entries[step + begin..][..len],
            &entries[2 * step + begin..][..len],
        );
        for (k, target) in target.iter_mut().enumerate() {
            *target -= factor[0] * a[k] + factor[1 % B] * b[k] + factor[2 % B] * c[k];
        }
    } else {
        for (k, factor) in factor.iter().enumerate() {
            for (target, entry) in target.iter_mut().zip(&entries[k * step + begin..][..len]) {
                *target -= factor * entry;
            }
        }
    }
}

/// The diagonal block of a node, by rows.
fn diagonal_block<const B: usize>(couplings: &Couplings, node: usize, values: &[f32]) -> [f32; 9] {
    let width = B * couplings.of(node).len();
    let entries = &values[couplings.first::<B>(node)..][..B * width];
    let place = couplings.diagonal[node] as usize;
    let mut block = [0.0; 9];
    for r in 0..B {
        block[B * r..][..B].copy_from_slice(&entries[r * width + B * place..][..B]);
    }
    block
}

/// The inverse of a block; that of the original one if its pivots have lost nearly everything of the original diagonal, and
/// true. A component without an entry is given one.
fn invert<const B: usize>(block: &[f32; 9], original: &[f32; 9], inverse: &mut [f32]) -> bool {
    if gauss::<B>(block, original, inverse) {
        return false;
    }
    if !gauss::<B>(original, original, inverse) {
        for r in 0..B {
            for c in 0..B {
                let entry = original[B * r + r];
                inverse[B * r + c] = if r == c && entry > 0.0 {
                    1.0 / entry
                } else {
                    0.0
                };
            }
        }
    }
    true
}

/// Inverts by elimination; false where a pivot is not sound.
fn gauss<const B: usize>(block: &[f32; 9], original: &[f32; 9], inverse: &mut [f32]) -> bool {
    let mut work = *block;
    inverse[..B * B].fill(0.0);
    for k in 0..B {
        inverse[B * k + k] = 1.0;
        if original[B * k + k] == 0.0 {
            work[B * k + k] = 1.0;
        }
    }
    for k in 0..B {
        let pivot = work[B * k + k];
        let least = LEAST * original[B * k + k];
        if pivot.is_nan() || pivot <= least {
            return false;
        }
        for c in 0..B {
            work[B * k + c] /= pivot;
            inverse[B * k + c] /= pivot;
        }
        for r in (0..B).filter(|&r| r != k) {
            let factor = work[B * r + k];
            for c in 0..B {
                work[B * r + c] -= factor * work[B * k + c];
                inverse[B * r + c] -= factor * inverse[B * k + c];
            }
        }
    }
    true
}
