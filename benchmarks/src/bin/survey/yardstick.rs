//! What the machine itself can do: the rate of a large dense product, and of a large copy.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};
use rayon::ThreadPool;
use rayon::prelude::*;

use super::rounds::timed;

/// Rows of the dense matrices: their product takes a tenth of a second or less.
const ROWS: usize = 1024;
/// Numbers of an array to copy: 256 MiB, many times the caches.
const LENGTH: usize = 1 << 25;

/// Dense product on one thread, the fastest that floating-point numbers can be worked on.
pub(crate) struct DensePeak {
    a: Mat<f64>,
    b: Mat<f64>,
    product: Mat<f64>,
}

impl DensePeak {
    pub(crate) fn new() -> Self {
        let entry = |i: usize, j: usize| ((i * 7 + j * 3) % 11) as f64 - 5.0;
        Self {
            a: Mat::from_fn(ROWS, ROWS, entry),
            b: Mat::from_fn(ROWS, ROWS, entry),
            product: Mat::zeros(ROWS, ROWS),
        }
    }

    /// Operations per nanosecond, which are 1e9 per second \[GFlop/s\].
    pub(crate) fn measure(&mut self) -> f64 {
        let time = timed(|| {
            matmul(
                &mut self.product,
                Accum::Replace,
                &self.a,
                &self.b,
                1.0,
                Par::Seq,
            );
            Ok::<_, std::convert::Infallible>(())
        });
        let operations = 2.0 * (ROWS as f64).powi(3);
        time.map_or(f64::NAN, |time| operations / time)
    }
}

/// Copy of an array far larger than the caches.
pub(crate) struct Copy {
    from: Vec<f64>,
    to: Vec<f64>,
}

impl Copy {
    pub(crate) fn new() -> Self {
        Self {
            from: vec![1.0; LENGTH],
            to: vec![0.0; LENGTH],
        }
    }

    /// Bytes read plus bytes written per nanosecond, with the threads of a pool \[GB/s\].
    pub(crate) fn measure(&mut self, pool: &ThreadPool) -> f64 {
        let part = LENGTH.div_ceil(pool.current_num_threads());
        let time = timed(|| {
            pool.install(|| {
                let parts = self.to.par_chunks_mut(part).zip(self.from.par_chunks(part));
                parts.for_each(|(to, from)| to.copy_from_slice(from));
            });
            Ok::<_, std::convert::Infallible>(())
        });
        let bytes = 2 * LENGTH * size_of::<f64>();
        time.map_or(f64::NAN, |time| bytes as f64 / time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_product_is_one() {
        let mut peak = DensePeak::new();
        assert!(peak.measure() > 0.0);
        let expected: f64 = (0..ROWS).map(|k| peak.a[(3, k)] * peak.b[(k, 5)]).sum();
        assert!((peak.product[(3, 5)] - expected).abs() < 1e-6);
    }
}
