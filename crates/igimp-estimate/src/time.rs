//! How long a case will take.
//!
//! A step costs its set-up and commit (proportional to the particles) and corrections; a correction
//! is a pass over the particles, a factorisation and a solution, or an iteration
//! ([`Systems`](super::Systems)). Steps
//! are those that the case plans; corrections per step are what the shipped cases take, by kind of
//! stage. Pictures, checkpoints and rows come on top. The nanoseconds belong to the reference
//! computer of [`Speed`], on one thread.
//!
//! A stage that ends when something happens (`stop_when`, a run-out that comes to rest, a search that
//! closes in) may take fewer
//! steps than it plans: the time is then an upper bound, and [`Time::open_ended`] says so.

use igimp_model::{Case, Dynamic, Every, ReductionPath, SearchMethod, Stage, StageKind};
use igimp_results::summary::StageSummary;
use serde::{Deserialize, Serialize};

use super::speed::Speed;
use super::{Estimate, TRIALS};

/// Set-up and commit of a step \[s per particle\].
const STEP: f64 = 6e-7;
/// A pass over the particles \[s per particle\].
const PASS: f64 = 7.2e-7;
/// The same in space: set-up and commit, and a pass \[s per particle\].
const STEP_IN_SPACE: f64 = 6e-6;
const PASS_IN_SPACE: f64 = 4e-6;
/// Rows, progress and bookkeeping of a step \[s\].
const ROWS: f64 = 5e-4;
/// A picture \[s\], and its part by particle when it shows a field.
const PICTURE: [f64; 2] = [2e-2, 7e-6];
/// A checkpoint \[s\], and its part by particle; at the end of a stage with its frame.
const STATE: [f64; 2] = [4e-3, 1.5e-6];
/// A frame along a stage \[s\], and its part by particle.
const FRAME: [f64; 2] = [1e-3, 1.2e-6];
/// Start, model, report \[s\].
const BEGINNING: f64 = 6e-2;
/// Shares of the time that more threads divide: of marching, of output \[-\].
const PARALLEL: [f64; 2] = [0.8, 0.6];
/// Steps of a path of equilibria to its limit, and its corrections with those of steps that were halved.
const PATH_STEPS: f64 = 14.0;
const PATH_CORRECTIONS: f64 = 130.0;

/// Cells that the fastest wave crosses in a step of time: 2 to 7 in the shipped cases.
const CELLS_PER_STEP: f64 = 4.0;
/// Steps of soil that fails in motion over its height in cells, as a step takes it on by a fifth of a cell at most (theory, eq. 68), and
/// corrections of each: of soil that is let go, and of soil whose strength is lost in part. Columns of sand took 30 to 38 with 6.4 to 8.2
/// corrections, a slide of clay 7.4 with 4.2.
const COLLAPSE: [f64; 2] = [33.0, 7.0];
const SLIDE: [f64; 2] = [8.0, 4.5];

/// Corrections of a trial that fails, beside those of its accepted steps.
const FAILING: f64 = 15.0;

/// The time of a case.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Time {
    /// All planned steps, pictures and files \[s\].
    pub seconds: f64,
    /// Whether a stage may end before its planned steps are used up.
    pub open_ended: bool,
    /// Threads.
    pub threads: usize,
}

/// The time of a case of a size on a computer of a speed, with the threads of the current pool.
pub fn time<const D: usize>(case: &Case<D>, size: &Estimate, speed: Speed) -> Time {
    let stages: Vec<StepsTaken> = (case.stages.iter())
        .map(|stage| planned(case, stage))
        .collect();
    Time {
        seconds: of_stages(case, size, speed, &stages),
        open_ended: case.stages.iter().any(is_open_ended),
        threads: rayon::current_num_threads(),
    }
}

/// The share of each stage in the corrections that a case plans \[-\].
pub fn shares<const D: usize>(case: &Case<D>) -> Vec<f64> {
    let corrections: Vec<f64> = case
        .stages
        .iter()
        .map(|stage| planned(case, stage).corrections)
        .collect();
    let all: f64 = corrections.iter().sum();
    corrections.iter().map(|part| part / all).collect()
}

/// The time by the same model of the steps and corrections that a run took \[s\]: what tells a computer
/// that was slow from a case that took more steps than planned.
pub fn time_of_steps_taken<const D: usize>(
    case: &Case<D>,
    size: &Estimate,
    speed: Speed,
    stages: &[StageSummary],
) -> f64 {
    let taken: Vec<StepsTaken> = stages.iter().map(taken).collect();
    of_stages(case, size, speed, &taken)
}

/// The effort of a stage.
#[derive(Clone, Copy, Debug, PartialEq)]
struct StepsTaken {
    steps: f64,
    corrections: f64,
    trials: f64,
}

/// Steps of a stage in which water flows, which its error in time chooses.
const FLOW_STEPS: f64 = 60.0;

/// The steps of a stage in which water flows, none longer than its longest; none where no water flows.
fn steps_of_flow(stage: &Stage) -> f64 {
    stage.consolidation.as_ref().map_or(0.0, |flow| {
        let least = flow.longest_step.map_or(0.0, |step| flow.duration / step);
        least.max(FLOW_STEPS)
    })
}

/// The effort that the case plans for a stage.
fn planned<const D: usize>(case: &Case<D>, stage: &Stage) -> StepsTaken {
    let steps = stage.steps as f64;
    let (steps, trials) = match &stage.kind {
        StageKind::StrengthReduction(search) => {
            let [low, high] = search.bracket;
            let halvings = ((high - low) / search.tolerance).max(2.0).log2();
            let trials = search.factors.len() as f64 + halvings.min(TRIALS);
            if search.search == SearchMethod::Continuation {
                return StepsTaken {
                    steps: PATH_STEPS,
                    corrections: PATH_CORRECTIONS,
                    trials: 0.0,
                };
            }
            match search.path {
                ReductionPath::Gravity => (steps * trials, trials),
                // A march of the reduction ends within the bracket, at its upper end at the latest; small
                // strides follow.
                ReductionPath::Reduce => (steps + 3.0, 4.0),
            }
        }
        StageKind::Dynamic(motion) => (steps.max(steps_of_time(case, motion)), 0.0),
        _ => (steps.max(steps_of_flow(stage)), 0.0),
    };
    let to_collapse =
        stage.stop_when.no_equilibrium || stage.stop_when.load_grows_less_than.is_some();
    let by_step = match &stage.kind {
        StageKind::K0 => 0.5,
        StageKind::Gravity { .. } | StageKind::Load { .. } if to_collapse => 5.0,
        StageKind::Gravity { .. } | StageKind::Load { .. } => 3.7,
        StageKind::Displacement { .. } | StageKind::Rigid(_) => 6.5,
        StageKind::Dynamic(motion) => failing_in_motion(motion).map_or(4.0, |[_, by_step]| by_step),
        StageKind::Wait => 3.0,
        _ => 5.0,
    };
    let failing = if trials > 0.0 || to_collapse {
        FAILING
    } else {
        0.0
    };
    StepsTaken {
        steps,
        corrections: by_step * steps + failing * (1.0 + 0.25 * trials),
        trials,
    }
}

/// Steps over height in cells and corrections of soil that fails in motion, where a stage of motion is to see that.
fn failing_in_motion(motion: &Dynamic) -> Option<[f64; 2]> {
    match (motion.reduction.is_some(), motion.at_rest.is_some()) {
        (true, _) => Some(SLIDE),
        (_, true) => Some(COLLAPSE),
        _ => None,
    }
}

/// The height of soil, from the lowest place of its bodies to the highest \[m\].
fn height<const D: usize>(case: &Case<D>) -> f64 {
    let bounds = case.bodies.iter().map(|body| body.region.bounds());
    let (lowest, highest) = bounds.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), ends| {
        (low.min(ends.0[D - 1]), high.max(ends.1[D - 1]))
    });
    (highest - lowest).max(0.0)
}

/// The steps of a stage that takes time: by the cells that waves cross, or by the way of soil that fails; none longer than the intervals of its
/// record.
fn steps_of_time<const D: usize>(case: &Case<D>, motion: &Dynamic) -> f64 {
    let speeds = case
        .materials
        .iter()
        .map(|material| material.wave_speed(case.gravity));
    let fastest = speeds.fold(0.0, f64::max);
    let cell = (case.grid.smallest_cell().into_iter()).fold(f64::INFINITY, f64::min);
    let by_motion = failing_in_motion(motion).map_or(
        motion.duration * fastest / (CELLS_PER_STEP * cell),
        |[by_height, _]| by_height * height(case) / cell,
    );
    let record = motion.ground_motion.as_ref();
    let by_record = record.map_or(0.0, |record| record.steps(motion.duration));
    by_motion.max(by_record)
}

/// The effort that a stage took.
fn taken(stage: &StageSummary) -> StepsTaken {
    let trials = stage
        .safety
        .as_ref()
        .map_or(0, |safety| safety.trials.len());
    let failed = stage.cuts + usize::from(stage.cuts > 0);
    StepsTaken {
        steps: stage.steps as f64,
        corrections: stage.iterations as f64 + 0.5 * FAILING * failed as f64,
        trials: trials as f64,
    }
}

/// Whether a stage may end before its steps are used up.
fn is_open_ended(stage: &Stage) -> bool {
    let stop = &stage.stop_when;
    matches!(
        stage.kind,
        StageKind::RunOut(_) | StageKind::StrengthReduction(_)
    ) || matches!(&stage.kind, StageKind::Dynamic(motion) if motion.at_rest.is_some())
        || stop.displacement.is_some()
        || stop.no_equilibrium
        || stop.load_grows_less_than.is_some()
}

fn of_stages<const D: usize>(
    case: &Case<D>,
    size: &Estimate,
    speed: Speed,
    stages: &[StepsTaken],
) -> f64 {
    let particles = size.particles as f64;
    let [step, pass] = if D == 3 {
        [STEP_IN_SPACE, PASS_IN_SPACE]
    } else {
        [STEP, PASS]
    };
    let mut marching = 0.0;
    let (mut states, mut frames) = (stages.len() as f64, 0.0);
    for (stage, planned) in std::iter::zip(stages, &case.stages) {
        let passes = stage.corrections + stage.steps;
        let assembly = particles * (step * stage.steps + pass * passes);
        let solving = stage.corrections * size.systems.seconds;
        marching += speed.assembly * (assembly + ROWS * stage.steps) + speed.factor * solving;
        if case.output.checkpoint_every > 0 {
            states += stage.trials + stage.steps / case.output.checkpoint_every as f64;
        }
        frames += match case.output.paraview {
            Every::Never | Every::Stage => 0.0,
            Every::Steps(every) => stage.steps / every.max(1) as f64,
            Every::Film => stage.steps.min(planned.kind.film_frames() as f64),
        };
    }
    let [picture, field] = PICTURE;
    let (pictures, fields) = pictures(case);
    let each = |[base, part]: [f64; 2]| base + part * particles;
    let output = BEGINNING
        + picture * pictures
        + field * fields * particles
        + states * each(STATE)
        + frames * each(FRAME);
    let more = 1.0 / rayon::current_num_threads() as f64;
    let divided = |share: f64| 1.0 - share + share * more;
    speed.factor * size.flows.seconds
        + marching * divided(PARALLEL[0])
        + speed.assembly * output * divided(PARALLEL[1])
}

/// Pictures of a run, and how many of them show a field.
fn pictures<const D: usize>(case: &Case<D>) -> (f64, f64) {
    let stages = case.stages.len();
    let searches = case
        .stages
        .iter()
        .filter(|stage| matches!(stage.kind, StageKind::StrengthReduction(_)))
        .count();
    // A search shows its last stable and its first unstable state, and the trials.
    let fields = case.output.figures.len() * (stages + searches);
    let sections = case.sections.len() * (stages - searches);
    let histories: usize = case
        .monitors
        .iter()
        .map(|monitor| monitor.record.len())
        .sum();
    let others = 1 + sections + case.curves.len() + histories + stages + searches;
    ((fields + others) as f64, fields as f64)
}

/// A time in words.
pub fn sentence(time: &Time) -> String {
    let plural = if time.threads == 1 { "" } else { "s" };
    let about = readable(time.seconds);
    let threads = time.threads;
    if time.open_ended {
        format!(
            "up to {about} on {threads} thread{plural}, when every planned step is taken: a stage may \
             end earlier"
        )
    } else {
        format!("about {about} on {threads} thread{plural}")
    }
}

/// A time as a reader likes it: two digits are more than the model knows.
pub fn readable(seconds: f64) -> String {
    let rounded = |value: f64, unit: f64| (value / unit).ceil() * unit;
    if seconds < 10.0 {
        format!("{:.0} s", seconds.max(1.0).ceil())
    } else if seconds < 100.0 {
        format!("{:.0} s", rounded(seconds, 5.0))
    } else if seconds < 6000.0 {
        format!("{:.0} min", (seconds / 60.0).ceil())
    } else {
        format!("{:.1} h", seconds / 3600.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate;
    use crate::tests::case;

    fn seconds(case: &Case<2>) -> f64 {
        time(case, &estimate(case).unwrap(), Speed::REFERENCE).seconds
    }

    /// Pictures and files aside, twice the steps take twice the time, and a computer of half the speed
    /// takes twice the time for all of it.
    #[test]
    fn time_grows_with_steps_and_with_slowness() {
        let mut case = case();
        let one = seconds(&case);
        case.stages[0].steps *= 2;
        let two = seconds(&case);
        case.stages[0].steps *= 2;
        let four = seconds(&case);
        assert!((four - two - 2.0 * (two - one)).abs() < 1e-9 * four);
        let slow = Speed {
            assembly: 2.0,
            factor: 2.0,
        };
        let slower = time(&case, &estimate(&case).unwrap(), slow).seconds;
        assert!((slower - 2.0 * four).abs() < 1e-9 * four);
    }

    #[test]
    fn a_stage_that_may_end_early_is_open_ended() {
        let mut case = case();
        let size = estimate(&case).unwrap();
        assert!(!time(&case, &size, Speed::REFERENCE).open_ended);
        case.stages[0].stop_when.displacement = Some(0.1);
        assert!(time(&case, &size, Speed::REFERENCE).open_ended);
    }

    /// A run that takes exactly the planned steps costs the estimated time.
    #[test]
    fn steps_taken_as_planned_cost_what_was_estimated() {
        let case = case();
        let steps = case.stages[0].steps;
        let stage = StageSummary {
            steps,
            iterations: (3.7 * steps as f64) as usize,
            ..StageSummary::default()
        };
        let size = estimate(&case).unwrap();
        let taken = time_of_steps_taken(&case, &size, Speed::REFERENCE, &[stage]);
        assert!((taken / seconds(&case) - 1.0).abs() < 0.05);
    }

    /// GOAL: steps and corrections of soil that fails in motion are planned within a factor of two.
    /// ORACLE: what runs of the shipped cases took, and of the column on a grid of 4 mm.
    #[test]
    fn soil_that_fails_in_motion_takes_steps_by_its_height() {
        for (name, cell, steps, corrections) in [
            ("column_collapse", "1 cm", 345.0, 2187.0),
            ("column_collapse", "4 mm", 940.0, 6791.0),
            ("landslide_dynamic", "1 m", 119.0, 503.0),
        ] {
            let shipped = igimp_input::shipped::find(name).unwrap();
            let file = shipped
                .case_file([format!("grid.cell=\"{cell}\"")])
                .unwrap();
            let taken = planned(file.case(), file.case().stages.last().unwrap());
            for (found, expected) in [(taken.steps, steps), (taken.corrections, corrections)] {
                assert!(
                    (0.5..2.0).contains(&(found / expected)),
                    "{name} {cell}: {found}"
                );
            }
        }
    }

    /// GOAL: a stage in which water flows by steps of five days for 60 000 days is planned with all of them.
    /// ORACLE: 60 000 / 5.
    #[test]
    fn the_longest_step_of_flow_is_planned() {
        let shipped = igimp_input::shipped::find("consolidation").unwrap();
        let file = shipped.case_file(Vec::<String>::new()).unwrap();
        let mut case = file.case().clone();
        let stage = case
            .stages
            .iter_mut()
            .find(|stage| stage.consolidation.is_some());
        let stage = stage.unwrap();
        let flow = stage.consolidation.as_mut().unwrap();
        let day = 86_400.0;
        (flow.duration, flow.longest_step) = (60_000.0 * day, Some(5.0 * day));
        let stage = stage.clone();
        let taken = planned(&case, &stage);
        assert!((taken.steps - 12_000.0).abs() < 1e-6, "{}", taken.steps);
    }

    #[test]
    fn times_are_readable() {
        assert_eq!(readable(0.2), "1 s");
        assert_eq!(readable(4.1), "5 s");
        assert_eq!(readable(41.0), "45 s");
        assert_eq!(readable(130.0), "3 min");
        assert_eq!(readable(7200.0), "2.0 h");
    }
}
