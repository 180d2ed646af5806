//! What a step with inertia costs over one of statics, correction by correction.

use igimp_benchmarks::steps::{PreparedStep, Setting};
use igimp_benchmarks::{BenchResult, threads};
use igimp_solver::Body;
use rayon::ThreadPool;

use super::rounds::{Rounds, timed};
use super::scope::Scope;

/// Duration of the steps in motion \[s\]: that of a slope which begins to slide.
const DURATION: f64 = 0.05;

/// Time of a step over its corrections, and of a correction alone \[ns\]; how many there were.
#[derive(Default)]
struct Measured {
    time: Rounds,
    alone: Rounds,
    corrections: usize,
}

impl Measured {
    /// One round: the step by a workspace that knows the pattern, as steps of a march do.
    fn measure(&mut self, step: &PreparedStep, pool: &ThreadPool) -> BenchResult {
        let mut workspace = PreparedStep::workspace();
        let mut bodies = [step.body.clone(), step.body.clone()];
        let mut reports = Vec::new();
        let time = pool.install(|| {
            let mut take = |body: &mut Body<2>| {
                step.take(body, &mut workspace)
                    .map(|report| reports.push(report))
                    .map_err(|error| error.to_string())
            };
            take(&mut bodies[0])?;
            timed(|| take(&mut bodies[1]))
        })?;
        let report = reports.pop().ok_or("the step reports nothing")?;
        let corrections = report.iterations as f64;
        let times = &report.times;
        // Assembly makes a pass more than there are corrections.
        let alone = times.assembly.as_secs_f64() / (corrections + 1.0)
            + (times.factor + times.solve).as_secs_f64() / corrections;
        self.time.push(time / corrections);
        self.alone.push(1e9 * alone);
        self.corrections = report.iterations;
        Ok(())
    }
}

pub(crate) fn run(scope: &mut Scope) -> BenchResult {
    let mut rows = Vec::new();
    let [_, von_mises, mohr_coulomb, _] = Setting::of_the_paper();
    for setting in [von_mises, mohr_coulomb] {
        let still = setting.prepare()?;
        let moving = still.clone().in_motion(DURATION)?;
        let rounds = scope.choose(5, 15);
        for pool in &scope.pools {
            let [mut of_statics, mut of_motion] = [Measured::default(), Measured::default()];
            for _ in 0..rounds {
                of_statics.measure(&still, pool)?;
                of_motion.measure(&moving, pool)?;
            }
            let count = pool.current_num_threads();
            let particles = still.body.particles.len();
            let ratios = [
                of_motion.time.over(&of_statics.time),
                of_motion.alone.over(&of_statics.alone),
            ];
            for (name, ratio) in ["step-over-statics", "correction-over-statics"]
                .iter()
                .zip(&ratios)
            {
                let name = format!("{}/{name}/{}", still.name, threads::name(count));
                scope.report.row("motion", &name, particles, "-", ratio);
            }
            let milliseconds = |rounds: &Rounds| format!("{:.2}", rounds.median() / 1e6);
            rows.push([
                still.name.to_owned(),
                particles.to_string(),
                count.to_string(),
                of_statics.corrections.to_string(),
                milliseconds(&of_statics.time),
                milliseconds(&of_statics.alone),
                of_motion.corrections.to_string(),
                milliseconds(&of_motion.time),
                milliseconds(&of_motion.alone),
                format!("{:.2}", ratios[0].median()),
                format!("{:.2}", ratios[1].median()),
            ]);
        }
    }
    let report = &mut scope.report;
    report.heading("Motion over statics");
    report.paragraph(
        "The last load step of both slopes of the paper, strength reduced by 1.2, in statics and over 50 ms with inertia (the \
         generalised-α method, a hundredth of the mass lumped). *Step*: its time over its corrections: set-up, assembly, factors, \
         solution and commit, and for motion the mass, the velocities that the grid takes over and the energy book. *Alone*: a pass \
         of assembly, factors and solution. The last columns are motion over statics.",
    );
    let header = [
        "case",
        "particles",
        "threads",
        "statics: corrections",
        "step [ms]",
        "alone [ms]",
        "motion: corrections",
        "step [ms]",
        "alone [ms]",
        "step",
        "alone",
    ];
    report.table(header, &rows);
    Ok(())
}
