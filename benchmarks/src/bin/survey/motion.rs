//! What a step with inertia costs over one of statics, correction by correction.

use igimp_benchmarks::steps::{PreparedStep, Setting};
use igimp_benchmarks::{BenchResult, threads};
use igimp_solver::Body;
use rayon::ThreadPool;

use super::rounds::{Rounds, timed};
use super::scope::Scope;

/// Duration of the steps in motion \[s\]: that of a slope which begins to slide.
const DURATION: f64 = 0.05;

/// Time of a correction with all that its step does beside it \[ns\], and how many there were.
#[derive(Default)]
struct Measured {
    time: Rounds,
    corrections: usize,
}

impl Measured {
    /// One round: the step by a workspace that knows the pattern, as steps of a march do.
    fn measure(&mut self, step: &PreparedStep, pool: &ThreadPool) -> BenchResult {
        let mut workspace = PreparedStep::workspace();
        let mut bodies = [step.body.clone(), step.body.clone()];
        let mut corrections = 0;
        let time = pool.install(|| {
            let mut take = |body: &mut Body<2>| {
                step.take(body, &mut workspace)
                    .map(|report| corrections = report.iterations)
                    .map_err(|error| error.to_string())
            };
            take(&mut bodies[0])?;
            timed(|| take(&mut bodies[1]))
        })?;
        self.time.push(time / corrections as f64);
        self.corrections = corrections;
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
            let ratio = of_motion.time.over(&of_statics.time);
            let name = format!("{}/over-statics/{}", still.name, threads::name(count));
            scope.report.row("motion", &name, particles, "-", &ratio);
            let [low, high] = ratio.quartiles();
            let milliseconds = |measured: &Measured| format!("{:.2}", measured.time.median() / 1e6);
            rows.push([
                still.name.to_owned(),
                particles.to_string(),
                count.to_string(),
                of_statics.corrections.to_string(),
                milliseconds(&of_statics),
                of_motion.corrections.to_string(),
                milliseconds(&of_motion),
                format!("{:.2}", ratio.median()),
                format!("{low:.2} to {high:.2}"),
            ]);
        }
    }
    let report = &mut scope.report;
    report.heading("Motion over statics");
    report.paragraph(
        "The last load step of both slopes of the paper, strength reduced by 1.2, in statics and over 50 ms with inertia (the \
         generalised-α method, a hundredth of the mass lumped). Time of the step over its corrections: set-up, assembly, factors, \
         solution and commit, and for motion the mass, the velocities that the grid takes over and the energy book.",
    );
    let header = [
        "case",
        "particles",
        "threads",
        "corrections",
        "statics [ms]",
        "corrections",
        "motion [ms]",
        "ratio",
        "quartiles",
    ];
    report.table(header, &rows);
    Ok(())
}
