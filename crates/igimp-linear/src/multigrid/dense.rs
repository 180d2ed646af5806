//! The coarsest matrix, factorised densely.

use super::rows::Couplings;

/// A pivot that has lost more of its diagonal than this is that of a motion without stiffness, which stays zero.
const LEAST: f64 = 1e-5;

/// L U of a small matrix, without exchanges.
#[derive(Clone, Debug, Default)]
pub(super) struct Dense {
    size: usize,
    /// By rows.
    entries: Vec<f64>,
}

impl Dense {
    /// Factorises.
    pub(super) fn set<const B: usize>(&mut self, couplings: &Couplings, values: &[f32]) {
        let n = B * couplings.len();
        self.size = n;
        self.entries.clear();
        self.entries.resize(n * n, 0.0);
        for node in 0..couplings.len() {
            let list = couplings.of(node);
            let width = B * list.len();
            let entries = &values[couplings.first::<B>(node)..][..B * width];
            for (r, row) in entries.chunks_exact(width).enumerate() {
                let target = &mut self.entries[n * (B * node + r)..][..n];
                for (&other, entries) in list.iter().zip(row.chunks_exact(B)) {
                    for (target, &entry) in target[B * other as usize..].iter_mut().zip(entries) {
                        *target = f64::from(entry);
                    }
                }
            }
        }
        let diagonal: Vec<f64> = (0..n).map(|k| self.entries[k * (n + 1)]).collect();
        for k in 0..n {
            let (above, below) = self.entries.split_at_mut(n * (k + 1));
            let row = &mut above[n * k..];
            let pivot = row[k];
            // Written so that what is not a number is no pivot.
            let sound = pivot > LEAST * diagonal[k] && pivot > 0.0;
            row[k] = if sound { 1.0 / pivot } else { 0.0 };
            for other in below.chunks_exact_mut(n) {
                let factor = other[k] * row[k];
                other[k] = factor;
                if factor != 0.0 {
                    for (other, entry) in other[k + 1..].iter_mut().zip(&row[k + 1..]) {
                        *other -= factor * entry;
                    }
                }
            }
        }
    }

    /// x ← A⁻¹ b.
    pub(super) fn solve(&self, rhs: &[f32], x: &mut [f32]) {
        let n = self.size;
        let mut work: Vec<f64> = rhs.iter().map(|&value| f64::from(value)).collect();
        for k in 0..n {
            let (known, rest) = work.split_at_mut(k);
            let row = &self.entries[n * k..][..k];
            let sum: f64 = row.iter().zip(&*known).map(|(a, b)| a * b).sum();
            rest[0] -= sum;
        }
        for k in (0..n).rev() {
            let (left, known) = work.split_at_mut(k + 1);
            let row = &self.entries[n * k..][..n];
            let sum: f64 = row[k + 1..].iter().zip(&*known).map(|(a, b)| a * b).sum();
            left[k] = (left[k] - sum) * row[k];
        }
        for (x, value) in x.iter_mut().zip(work) {
            *x = value as f32;
        }
    }
}
