//! What the sections share: how much to measure, pools of threads, and what was found so far.

use std::cell::OnceCell;

use igimp_benchmarks::steps::{PreparedStep, Setting};
use igimp_benchmarks::{BenchResult, threads};
use rayon::ThreadPool;

use super::plot::Curve;
use super::report::Report;

/// The state of a survey.
pub(crate) struct Scope {
    /// Whether a first impression is enough.
    pub(crate) quick: bool,
    /// A pool of one thread, and one of several where there are several.
    pub(crate) pools: Vec<ThreadPool>,
    /// Tables and rows.
    pub(crate) report: Report,
    /// Curves of growth.
    pub(crate) curves: Vec<Curve>,
    corrections: OnceCell<f64>,
}

impl Scope {
    pub(crate) fn new(quick: bool) -> BenchResult<Self> {
        let counts = threads::counts();
        let pools = counts.into_iter().map(threads::pool);
        Ok(Self {
            quick,
            pools: pools.collect::<BenchResult<_>>()?,
            report: Report::default(),
            curves: Vec::new(),
            corrections: OnceCell::new(),
        })
    }

    /// One of two numbers: for a first impression, or for the full survey.
    pub(crate) fn choose<T>(&self, quick: T, full: T) -> T {
        if self.quick { quick } else { full }
    }

    /// The mean number of corrections of the steps of the paper's cases.
    pub(crate) fn corrections(&self) -> BenchResult<f64> {
        if let Some(&known) = self.corrections.get() {
            return Ok(known);
        }
        let mut all = Vec::new();
        for setting in Setting::of_the_paper() {
            let step = setting.prepare()?;
            let mut workspace = PreparedStep::workspace();
            all.push(
                step.take(&mut step.body.clone(), &mut workspace)?
                    .iterations,
            );
        }
        Ok(self.note_corrections(&all))
    }

    /// Keeps the numbers of corrections that were met, and answers their mean.
    pub(crate) fn note_corrections(&self, all: &[usize]) -> f64 {
        let mean = all.iter().sum::<usize>() as f64 / all.len() as f64;
        *self.corrections.get_or_init(|| mean)
    }
}
