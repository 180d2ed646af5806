//! Conjugate gradients and generalised minimal residuals, with a preconditioner.
//!
//! Y. Saad, *Iterative Methods for Sparse Linear Systems*, 2nd ed., SIAM 2003, algorithms 9.1 and 9.6.

#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "what is not a number is neither small enough nor positive"
)]

use super::product::dot;

/// Conjugate gradients look after so many iterations whether they will come to their end.
const LOOK: usize = 100;

/// The outcome of an iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Iterated {
    pub(crate) iterations: usize,
    /// ‖b − K x‖ / ‖b‖, as the recurrences have it \[-\].
    pub(crate) residual: f64,
    /// Whether the method broke down: K or its preconditioner is not positive definite.
    pub(crate) broken: bool,
}

/// The matrix and its preconditioner.
pub(crate) trait Operators {
    fn multiply(&mut self, x: &[f64], y: &mut [f64]);
    fn precondition(&mut self, r: &[f64], z: &mut [f64]);
}

/// Conjugate gradients in the flexible form of Polak and Ribière, from x = 0.
pub(crate) fn conjugate_gradients(
    operators: &mut dyn Operators,
    rhs: &[f64],
    x: &mut [f64],
    goal: f64,
    most: usize,
) -> Iterated {
    let n = rhs.len();
    x.fill(0.0);
    let scale = norm(rhs);
    let mut r = rhs.to_vec();
    let (mut z, mut p, mut q, mut before) =
        (vec![0.0; n], vec![0.0; n], vec![0.0; n], rhs.to_vec());
    let mut done = Iterated {
        iterations: 0,
        residual: 1.0,
        broken: false,
    };
    let (mut last, mut looked) = (0.0, 1.0);
    while done.residual > goal && done.iterations < most {
        operators.precondition(&r, &mut z);
        let rz = dot(&r, &z);
        if rz.is_nan() || rz <= 0.0 {
            done.broken = true;
            break;
        }
        let beta = if last == 0.0 {
            0.0
        } else {
            (rz - dot(&before, &z)) / last
        };
        last = rz;
        for (p, z) in p.iter_mut().zip(&z) {
            *p = z + beta * *p;
        }
        operators.multiply(&p, &mut q);
        let pq = dot(&p, &q);
        if pq.is_nan() || pq <= 0.0 {
            done.broken = true;
            break;
        }
        // p·r, and not r·z: also where the preconditioner is not quite the same from time to time.
        let alpha = dot(&p, &r) / pq;
        before.copy_from_slice(&r);
        for (((x, r), p), q) in x.iter_mut().zip(&mut r).zip(&p).zip(&q) {
            *x += alpha * p;
            *r -= alpha * q;
        }
        done.iterations += 1;
        done.residual = norm(&r) / scale;
        if done.iterations.is_multiple_of(LOOK) {
            let left = most - done.iterations;
            if is_hopeless([looked, done.residual, goal], LOOK, left) {
                break;
            }
            looked = done.residual;
        }
    }
    done
}

/// A direction of search, in single precision: it is rounded before the matrix is applied to it, so that nothing is lost.
struct Direction {
    scale: f64,
    entries: Vec<f32>,
}

impl Direction {
    /// Takes a direction over and leaves its kept part.
    fn rounded(z: &mut [f64]) -> Self {
        let largest = z.iter().fold(0.0, |most: f64, entry| most.max(entry.abs()));
        let scale = if largest > 0.0 { largest } else { 1.0 };
        let entries = z.iter_mut().map(|z| {
            let kept = (*z / scale) as f32;
            *z = f64::from(kept) * scale;
            kept
        });
        Self {
            entries: entries.collect(),
            scale,
        }
    }

    /// x ← x + y z.
    fn add_to(&self, x: &mut [f64], y: f64) {
        let factor = y * self.scale;
        for (x, &entry) in x.iter_mut().zip(&self.entries) {
            *x += factor * f64::from(entry);
        }
    }
}

/// When generalised minimal residuals end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// The residual that is wanted, over that at x = 0 \[-\].
    pub(crate) goal: f64,
    /// Most iterations.
    pub(crate) most: usize,
    /// Iterations after which the search directions are forgotten.
    pub(crate) restart: usize,
}

/// Flexible generalised minimal residuals, restarted, from x = 0.
pub(crate) fn minimal_residuals(
    operators: &mut dyn Operators,
    rhs: &[f64],
    x: &mut [f64],
    Limits {
        goal,
        most,
        restart,
    }: Limits,
) -> Iterated {
    let n = rhs.len();
    x.fill(0.0);
    let scale = norm(rhs);
    let mut done = Iterated {
        iterations: 0,
        residual: 1.0,
        broken: false,
    };
    let (mut r, mut z) = (rhs.to_vec(), vec![0.0; n]);
    while done.residual > goal && done.iterations < most {
        let beta = norm(&r);
        let mut basis: Vec<Vec<f64>> = vec![r.iter().map(|r| r / beta).collect()];
        let mut directions: Vec<Direction> = Vec::new();
        let mut hessenberg: Vec<Vec<f64>> = Vec::new();
        let mut rotations: Vec<(f64, f64)> = Vec::new();
        let mut g = vec![beta];
        while directions.len() < restart && done.iterations < most && done.residual > goal {
            let k = directions.len();
            operators.precondition(&basis[k], &mut z);
            directions.push(Direction::rounded(&mut z));
            let mut w = vec![0.0; n];
            operators.multiply(&z, &mut w);
            let mut column = orthogonalise(&mut w, &basis);
            let left = norm(&w);
            for (i, &(c, s)) in rotations.iter().enumerate() {
                let (a, b) = (column[i], column[i + 1]);
                column[i] = c * a + s * b;
                column[i + 1] = c * b - s * a;
            }
            let (a, b) = (column[k], left);
            let length = a.hypot(b);
            if length.is_nan() || length == 0.0 {
                done.broken = true;
                directions.pop();
                break;
            }
            let (c, s) = (a / length, b / length);
            column[k] = length;
            rotations.push((c, s));
            hessenberg.push(column);
            let last = g[k];
            g[k] = c * last;
            g.push(-s * last);
            done.iterations += 1;
            done.residual = g[k + 1].abs() / scale;
            if left == 0.0 {
                break;
            }
            basis.push(w.iter().map(|w| w / left).collect());
        }
        for (direction, y) in directions.iter().zip(solved(&hessenberg, &g)) {
            direction.add_to(x, y);
        }
        operators.multiply(x, &mut r);
        for (r, b) in r.iter_mut().zip(rhs) {
            *r = b - *r;
        }
        let reached = norm(&r) / scale;
        done.residual = reached;
        let left = most - done.iterations;
        if done.broken || is_hopeless([beta / scale, reached, goal], restart, left) {
            break;
        }
    }
    done
}

/// Takes from w its parts along an orthonormal basis, and returns these.
fn orthogonalise(w: &mut [f64], basis: &[Vec<f64>]) -> Vec<f64> {
    let mut parts = vec![0.0; basis.len()];
    // Twice is enough.
    for _ in 0..2 {
        for (vector, part) in basis.iter().zip(&mut parts) {
            let share = dot(vector, w);
            *part += share;
            for (w, v) in w.iter_mut().zip(vector) {
                *w -= share * v;
            }
        }
    }
    parts
}

/// The solution y of R y = g, of an upper triangle by its columns.
fn solved(columns: &[Vec<f64>], g: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; columns.len()];
    for k in (0..y.len()).rev() {
        let known: f64 = (k + 1..y.len()).map(|j| columns[j][k] * y[j]).sum();
        y[k] = (g[k] - known) / columns[k][k];
    }
    y
}

/// Whether an iteration that went from the first residual to the second in so many iterations will not come to the third in those
/// that are left.
fn is_hopeless([before, now, goal]: [f64; 3], made: usize, left: usize) -> bool {
    let pace = (now / before).ln() / made as f64;
    // Written so that what is not a number is hopeless too.
    !(now <= goal || (pace < 0.0 && (goal / now).ln() / pace <= left as f64))
}

/// Euclidean norm.
pub(crate) fn norm(values: &[f64]) -> f64 {
    dot(values, values).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The Laplacian of a chain, with a preconditioner that is another one from time to time.
    struct Chain {
        /// Factors on the residual by parity of the unknown, one pair after the other.
        scales: Vec<[f64; 2]>,
        calls: usize,
        directions: Vec<Vec<f64>>,
    }

    fn times_chain(x: &[f64]) -> Vec<f64> {
        let at = |k: usize| x.get(k).copied().unwrap_or(0.0);
        let row = |k: usize| 2.1 * x[k] - at(k.wrapping_sub(1)) - at(k + 1);
        (0..x.len()).map(row).collect()
    }

    impl Operators for Chain {
        fn multiply(&mut self, x: &[f64], y: &mut [f64]) {
            self.directions.push(x.to_vec());
            y.copy_from_slice(&times_chain(x));
        }

        fn precondition(&mut self, r: &[f64], z: &mut [f64]) {
            let scale = self.scales[self.calls % self.scales.len()];
            self.calls += 1;
            for (k, (z, r)) in z.iter_mut().zip(r).enumerate() {
                *z = scale[k % 2] * r;
            }
        }
    }

    fn chain(scales: Vec<[f64; 2]>) -> Chain {
        Chain {
            scales,
            calls: 0,
            directions: Vec::new(),
        }
    }

    fn rhs() -> Vec<f64> {
        (0..40).map(|k| f64::from(k * 37 % 11) - 5.0).collect()
    }

    // GOAL: each direction of search is conjugate to the one before, also where the preconditioner changes from one to the
    // next, as a cycle in single precision does by its round-off.
    // CASE: a chain of 40, preconditioners that alternate, and one that stays.
    // ORACLE: p·K q = 0 of successive directions, with K applied by hand; the solution solves K x = b.
    #[test]
    fn directions_are_conjugate_though_the_preconditioner_changes() {
        for scales in [vec![[1.0, 0.3]], vec![[1.0, 0.3], [0.2, 1.0], [0.7, 0.7]]] {
            let mut operators = chain(scales);
            let (rhs, mut x) = (rhs(), vec![0.0; 40]);
            let done = conjugate_gradients(&mut operators, &rhs, &mut x, 1e-10, 400);
            assert!(!done.broken && done.residual <= 1e-10, "{done:?}");
            for pair in operators.directions.windows(2) {
                let of_both = dot(&pair[1], &times_chain(&pair[0])).abs();
                let sizes = norm(&pair[1]) * norm(&times_chain(&pair[0]));
                assert!(of_both < 1e-10 * sizes, "{of_both:e} of {sizes:e}");
            }
            let left = times_chain(&x)
                .iter()
                .zip(&rhs)
                .map(|(kx, b)| b - kx)
                .collect::<Vec<_>>();
            assert!(norm(&left) < 1e-9 * norm(&rhs));
        }
    }

    // GOAL: a preconditioner that is not positive definite is noticed at once.
    // CASE: one that turns all residuals round, one that turns every second unknown and more than balances the others.
    // ORACLE: r·M⁻¹r ≤ 0 is impossible for a positive definite M.
    #[test]
    fn a_preconditioner_that_is_not_positive_definite_ends_the_iteration() {
        for scale in [[-1.0, -1.0], [-10.0, 0.1], [0.0, 0.0]] {
            let mut operators = chain(vec![scale]);
            let done = conjugate_gradients(&mut operators, &rhs(), &mut [0.0; 40], 1e-10, 400);
            assert!(done.broken, "{scale:?}: {done:?}");
            assert_eq!(done.iterations, 0, "{scale:?}");
        }
    }
}
