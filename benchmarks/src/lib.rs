//! What the benches and the survey share: bodies, trial states and the settings of the measurement.
//!
//! | module | what it makes | used by |
//! |---|---|---|
//! | [`block`] | a square or cubic block of soil at a trial displacement, of any size and law | `assembly`, `factorisation`, survey |
//! | [`pass`] | the system of a block: what a step sets up and a Newton iteration repeats | `assembly`, survey |
//! | [`equations`] | tangent and force of a block, with the solver for them | `factorisation`, survey |
//! | [`cube`] | what a factorisation in space would take | survey |
//! | [`steps`] | the four cases of the paper, one load step before the one to measure | `whole_step`, survey |
//! | [`states`] | elastic and plastic trial states of every law | `return_map` |
//! | [`threads`] | pools of one thread and of several | `assembly`, survey |
//! | [`random`] | a fixed stream of numbers | all |
//!
//! Every input is made from fixed numbers, so two runs measure the same work. `README.md` says
//! what is covered, what is not, and how to read the figures.

pub mod block;
pub mod cube;
pub mod equations;
pub mod pass;
pub mod random;
pub mod states;
pub mod steps;
pub mod threads;

use std::error::Error;
use std::fmt::Debug;
use std::time::Duration;

use criterion::{Criterion, Throughput};

/// What setting up or running a bench can come to.
pub type BenchResult<T = ()> = Result<T, Box<dyn Error>>;

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Set {
    /// The smallest size of everything: for `--test`, for continuous integration, and where the
    /// variable `IGIMP_BENCH_SET` is `short`.
    Short,
    /// All sizes.
    Full,
}

impl Set {
    /// The set that the command line and the environment ask for.
    pub fn asked() -> Self {
        let is_short = std::env::var("IGIMP_BENCH_SET").is_ok_and(|set| set == "short");
        if is_short || std::env::args().any(|argument| argument == "--test") {
            Self::Short
        } else {
            Self::Full
        }
    }
}

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

/// The input of a bench, made when its turn comes, so that a filter on names costs nothing.
///
/// # Panics
/// When the input cannot be made, which the tests of its module exclude.
pub fn made<T, E: Debug>(input: Result<T, E>) -> T {
    input.expect("inputs are made from fixed numbers, and tested")
}
