//! What the benches share: bodies, trial states and the settings of the measurement.
//!
//! | module | what it makes | used by |
//! |---|---|---|
//! | [`block`] | a square block of soil at a trial displacement, in three sizes | `assembly`, `factorisation` |
//! | [`slopes`] | the two slopes of the paper, one load step before full gravity | `whole_step` |
//! | [`states`] | elastic and plastic trial states of every law | `return_map` |
//! | [`random`] | a fixed stream of numbers | all |
//!
//! Every input is made from fixed numbers, so two runs measure the same work. `README.md` says
//! what is covered, what is not, and how to read the figures.

pub mod block;
pub mod random;
pub mod slopes;
pub mod states;

use std::error::Error;
use std::time::Duration;

use criterion::{Criterion, Throughput};

/// What setting up or running a bench can come to.
pub type BenchResult<T = ()> = Result<T, Box<dyn Error>>;

/// Runs the benches of one target with the settings that all targets share: half a second of
/// warm-up, two seconds of measurement, 20 samples. Flags of the command line go before them.
///
/// # Errors
/// Whatever the benches return.
pub fn run(benches: impl FnOnce(&mut Criterion) -> BenchResult) -> BenchResult {
    let mut criterion = Criterion::default()
        .without_plots()
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2))
        .sample_size(20)
        .configure_from_args();
    benches(&mut criterion)?;
    criterion.final_summary();
    Ok(())
}

/// The throughput that `cargo xtask bench` divides by: particles, trial states or unknowns.
pub fn elements(count: usize) -> Throughput {
    Throughput::Elements(count as u64)
}
