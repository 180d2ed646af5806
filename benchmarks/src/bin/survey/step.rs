//! Where the time of a whole load step goes.

use igimp_benchmarks::steps::{PHASES, PreparedStep, Setting, phases};
use igimp_benchmarks::{BenchResult, threads};
use rayon::ThreadPool;

use super::rounds::{Rounds, timed};
use super::scope::Scope;

/// Time of a step, and the shares of its phases and of what they leave.
#[derive(Clone, Default)]
struct Measured {
    /// Wall-clock time \[ns\].
    time: Rounds,
    /// In percent.
    shares: [Rounds; PHASES.len() + 1],
    corrections: usize,
    unknowns: usize,
}

impl Measured {
    /// One round: the step with nothing known beforehand, so that the analysis of the pattern counts.
    fn measure(&mut self, step: &PreparedStep, pool: &ThreadPool) -> BenchResult {
        let mut body = step.body.clone();
        let mut workspace = PreparedStep::workspace();
        let mut report = None;
        let time = pool.install(|| {
            timed(|| {
                let taken = step.take(&mut body, &mut workspace);
                taken
                    .map(|taken| report = Some(taken))
                    .map_err(|error| error.to_string())
            })
        })?;
        let report = report.ok_or("the step reports nothing")?;
        let mut rest = 100.0;
        for (share, phase) in std::iter::zip(&mut self.shares, phases(&report.times)) {
            let percent = 100.0 * phase.as_secs_f64() * 1e9 / time;
            share.push(percent);
            rest -= percent;
        }
        self.shares[PHASES.len()].push(rest);
        self.time.push(time);
        (self.corrections, self.unknowns) = (report.iterations, report.unknowns);
        Ok(())
    }
}

pub(crate) fn run(scope: &mut Scope) -> BenchResult {
    let mut settings = Setting::of_the_paper().to_vec();
    let of_the_paper = settings.len();
    if !scope.quick {
        settings.extend(Setting::large());
    }
    let mut rows = Vec::new();
    let mut corrections = Vec::new();
    for (number, setting) in settings.into_iter().enumerate() {
        let step = setting.prepare()?;
        let rounds = if number < of_the_paper {
            scope.choose(3, 9)
        } else {
            3
        };
        let mut taken = vec![Measured::default(); scope.pools.len()];
        for _ in 0..rounds {
            for (pool, taken) in std::iter::zip(&scope.pools, &mut taken) {
                taken.measure(&step, pool)?;
            }
        }
        if number < of_the_paper {
            corrections.push(taken[0].corrections);
        }
        note(scope, &step, &taken, &mut rows);
    }
    scope.note_corrections(&corrections);

    let report = &mut scope.report;
    report.heading("Whole steps by phase");
    report.paragraph(
        "One load step of each case of the paper: the last to full load of column and slopes \
         (strength reduced by 1.2), the fourth of the footing; of the fine slopes, with \
         whole strength, the tenth of twenty. Shares of the time of the step; \
         *rest* is what the phases leave. The analysis of the pattern is part of *linear*. *Gain*: \
         one thread over several. Files, pictures and checks are not part of a step.",
    );
    let header = [
        "case",
        "particles",
        "unknowns",
        "corrections",
        "threads",
        "step [ms]",
        PHASES[0],
        PHASES[1],
        PHASES[2],
        PHASES[3],
        PHASES[4],
        "rest",
        "gain",
    ];
    report.table(header, &rows);
    Ok(())
}

fn note(scope: &mut Scope, step: &PreparedStep, taken: &[Measured], rows: &mut Vec<[String; 13]>) {
    let particles = step.body.particles.len();
    let one = &taken[0].time;
    for (pool, taken) in std::iter::zip(&scope.pools, taken) {
        let count = pool.current_num_threads();
        let name = |part: &str| format!("{}/{part}/{}", step.name, threads::name(count));
        let cost = taken.time.map(|time| time / particles as f64);
        scope
            .report
            .row("step", &name("all"), particles, "ns/particle", &cost);
        let parts = PHASES.into_iter().chain(["rest"]);
        for (part, share) in parts.zip(&taken.shares) {
            scope.report.row("step", &name(part), particles, "%", share);
        }
        let share = |phase: usize| format!("{:.1} %", taken.shares[phase].median());
        rows.push([
            step.name.to_owned(),
            particles.to_string(),
            taken.unknowns.to_string(),
            taken.corrections.to_string(),
            count.to_string(),
            format!("{:.1}", taken.time.median() / 1e6),
            share(0),
            share(1),
            share(2),
            share(3),
            share(4),
            share(5),
            format!("{:.2}", one.over(&taken.time).median()),
        ]);
    }
}
