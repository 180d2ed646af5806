//! Cost per particle and Newton iteration with all of the assembly in it, and the bytes that it
//! moves.

use igimp_assembly::Stencils;
use igimp_benchmarks::block::{Block, Soil};
use igimp_benchmarks::pass::Pass;
use igimp_benchmarks::{BenchResult, threads};
use rayon::ThreadPool;

use super::rounds::{Rounds, timed};
use super::scope::Scope;
use super::yardstick::Copy;

/// Cells along a side: 99 856 particles.
const CELLS: usize = 158;

/// Times by law and pool, per particle \[ns\].
#[derive(Clone, Default)]
struct Times {
    set_up: Rounds,
    evaluate: Rounds,
    linearise: Rounds,
}

impl Times {
    /// One round.
    fn measure(
        &mut self,
        block: &Block<2>,
        pass: &mut Pass<'_, 2>,
        pool: &ThreadPool,
    ) -> BenchResult {
        let particles = block.len() as f64;
        let set_up = pool.install(|| timed(|| Pass::set_up(block)))?;
        let evaluate = pool.install(|| timed(|| pass.evaluate()))?;
        let linearise = pool.install(|| timed(|| pass.linearise()))?;
        self.set_up.push(set_up / particles);
        self.evaluate.push(evaluate / particles);
        self.linearise.push(linearise / particles);
        Ok(())
    }

    /// An iteration of a step with so many of them: its share of the set-up, and of the evaluation
    /// at the end, which no correction follows.
    fn all_included(&self, corrections: f64) -> Rounds {
        let shared = self
            .set_up
            .with(&self.evaluate, |a, b| (a + b) / corrections);
        shared.with(&self.linearise, |a, b| a + b)
    }
}

/// A law with its block; times by pool.
struct Subject {
    soil: Soil,
    block: Block<2>,
    stencils: Stencils<2>,
    times: Vec<Times>,
    bytes: f64,
}

pub(crate) fn run(scope: &mut Scope) -> BenchResult {
    let corrections = scope.corrections()?;
    let mut subjects = Vec::new();
    for soil in Soil::ALL {
        let block = Block::new(soil, CELLS)?;
        let stencils = block.stencils()?;
        let times = vec![Times::default(); scope.pools.len()];
        subjects.push(Subject {
            soil,
            block,
            stencils,
            times,
            bytes: 0.0,
        });
    }
    let mut copy = Copy::new();
    let mut bandwidth = vec![Rounds::default(); scope.pools.len()];
    for round in 0..=scope.choose(3, 9) {
        for (pool, bandwidth) in std::iter::zip(&scope.pools, &mut bandwidth) {
            let rate = copy.measure(pool);
            if round > 0 {
                bandwidth.push(rate);
            }
        }
        for subject in &mut subjects {
            let mut pass = Pass::new(&subject.block, &subject.stencils)?;
            subject.bytes = pass.bytes() as f64 / subject.block.len() as f64;
            for (pool, times) in std::iter::zip(&scope.pools, &mut subject.times) {
                let kept = times.clone();
                times.measure(&subject.block, &mut pass, pool)?;
                if round == 0 {
                    *times = kept;
                }
            }
        }
    }
    print_cost(scope, &subjects, corrections);
    print_traffic(scope, &subjects, &bandwidth);
    Ok(())
}

fn print_cost(scope: &mut Scope, subjects: &[Subject], corrections: f64) {
    let particles = Block::<2>::particles(CELLS);
    let mut rows = Vec::new();
    for subject in subjects {
        let one = subject.times[0].all_included(corrections);
        for (pool, times) in std::iter::zip(&scope.pools, &subject.times) {
            let count = pool.current_num_threads();
            let all = times.all_included(corrections);
            let gain = one.over(&all);
            let name =
                |part: &str| format!("{}/{part}/{}", subject.soil.name(), threads::name(count));
            for (part, time) in [
                ("set-up", &times.set_up),
                ("evaluate", &times.evaluate),
                ("linearise", &times.linearise),
                ("all-included", &all),
            ] {
                scope
                    .report
                    .row("cost", &name(part), particles, "ns/particle", time);
            }
            if count > 1 {
                scope
                    .report
                    .row("cost", &name("gain"), particles, "-", &gain);
            }
            rows.push([
                subject.soil.name().to_owned(),
                count.to_string(),
                format!("{:.0}", times.set_up.median()),
                format!("{:.0}", times.evaluate.median()),
                format!("{:.0}", times.linearise.median()),
                format!("{:.0}", all.median()),
                format!("{:.2}", gain.median()),
            ]);
        }
    }
    let report = &mut scope.report;
    report.heading("Cost per particle and Newton iteration");
    report.paragraph(&format!(
        "Assembly of a block of {particles} particles, 2 × 2 per cell, finite strain with B-bar, \
         half of them plastic \\[ns per particle\\]. *Set-up* (stencils, unknowns, pattern) is paid \
         once per step, *linearise* (stress, internal force and tangent in one pass) for every \
         correction, *evaluate* (stress and internal force) after the last one. *All included*, with \
         n = {corrections:.2} corrections per step, the mean of the steps of the four cases: \
         (set-up + evaluate) / n + linearise. *Gain*: one thread over several."
    ));
    let header = [
        "law",
        "threads",
        "set-up",
        "evaluate",
        "linearise",
        "all included",
        "gain",
    ];
    report.table(header, &rows);
}

fn print_traffic(scope: &mut Scope, subjects: &[Subject], bandwidth: &[Rounds]) {
    let particles = Block::<2>::particles(CELLS);
    let mut rows = Vec::new();
    for subject in subjects {
        for ((pool, times), copied) in scope.pools.iter().zip(&subject.times).zip(bandwidth) {
            let count = pool.current_num_threads();
            let rate = times.linearise.map(|time| subject.bytes / time);
            let share = rate.over(copied).map(|share| 100.0 * share);
            let name = format!("{}/{}", subject.soil.name(), threads::name(count));
            scope.report.row("traffic", &name, particles, "GB/s", &rate);
            rows.push([
                subject.soil.name().to_owned(),
                count.to_string(),
                format!("{:.0}", subject.bytes),
                format!("{:.2}", rate.median()),
                format!("{:.2}", copied.median()),
                format!("{:.0} %", share.median()),
            ]);
        }
    }
    for (pool, copied) in std::iter::zip(&scope.pools, bandwidth) {
        let name = format!("copy/{}", threads::name(pool.current_num_threads()));
        scope
            .report
            .row("traffic", &name, particles, "GB/s", copied);
    }
    let report = &mut scope.report;
    report.heading("Bytes moved by assembly");
    report.paragraph(
        "*Bytes* per particle are what an iteration cannot do without, counted from the sizes of \
         the data: every support, state and trial of a particle once, every value of the matrix \
         read and written once. Nodal arrays stay in the caches and do not count. *Rate* is bytes \
         over the time of linearise; *copy* is what the machine reads and writes in \
         copying an array of 256 MiB, measured in turn with it. A small share says that assembly is \
         not bound by memory.",
    );
    let header = [
        "law",
        "threads",
        "bytes",
        "rate [GB/s]",
        "copy [GB/s]",
        "share",
    ];
    report.table(header, &rows);
}
