//! A run as lines of text. They hold no times, so that two runs of a case give equal logs.

use std::fmt::Write as _;

use igimp_cases::run::{Event, worst_node};
use igimp_model::meshes::label;
use igimp_results::ending::EndReason;
use igimp_results::summary::{
    Kinematic, NEEDLESS, PathPoint, SafetySummary, StageOutcome, StageSummary, StrengthShares,
    TrialSummary,
};
use igimp_solver::{StepError, StepReport};
use igimp_text::{count, short, told_apart};

const SEARCH: &str = "strength-reduction";

/// Turns events into lines.
#[derive(Debug, Default)]
pub struct Lines {
    /// Steps of the stage when none is cut.
    pub steps: usize,
    /// Whether the stage is a search, whose trials are lines instead of their steps.
    pub search: bool,
    /// Of a study of the mesh error: the lines of each mesh by its parts.
    meshes: Vec<(usize, Lines)>,
}

impl Lines {
    /// The line of an event, if it has one.
    pub fn line<const D: usize>(&mut self, event: &Event<'_, D>) -> Option<String> {
        match event {
            Event::Prepared { size } => {
                let mut line = format!(
                    "{} particles, {} cells",
                    count(size.particles),
                    count(size.cells)
                );
                if size.unknowns > 0 {
                    let _ = write!(line, ", {} unknowns", count(size.unknowns));
                }
                Some(line)
            }
            Event::StageStarted {
                stage,
                of,
                name,
                kind,
                steps,
            } => {
                self.steps = *steps;
                self.search = *kind == SEARCH;
                let planned = if self.search {
                    String::new()
                } else {
                    format!(", {steps} steps")
                };
                Some(format!(
                    "stage {}/{of} \"{name}\" ({kind}{planned})",
                    stage + 1
                ))
            }
            Event::Equilibrium { .. } => None,
            Event::Step { .. } | Event::Cut { .. } if self.search => None,
            Event::Step {
                number,
                progress,
                report,
            } => Some(format!(
                "  {}",
                step(*number, self.steps, *progress, report)
            )),
            Event::Cut { error } => Some(format!("  {}", cut(error))),
            Event::Trial { trial, .. } => Some(format!("  {}", self::trial(trial))),
            Event::Path { point } => Some(format!("  {}", path_point(point))),
            Event::StageEnded { summary } => Some(format!("  {}", end(summary))),
            Event::Warning { text } => Some(format!("warning: {text}")),
            Event::OfMesh { parts, event } => self.of_mesh(*parts, event),
        }
    }

    /// The line of an event on a mesh. Meshes run side by side: each line says of which it is, and
    /// steps are left out.
    fn of_mesh<const D: usize>(&mut self, parts: usize, event: &Event<'_, D>) -> Option<String> {
        let known = self.meshes.iter().position(|(mesh, _)| *mesh == parts);
        let place = known.unwrap_or_else(|| {
            self.meshes.push((parts, Lines::default()));
            self.meshes.len() - 1
        });
        let line = self.meshes[place].1.line(event)?;
        let is_step = matches!(event, Event::Step { .. } | Event::Cut { .. });
        let of_mesh = |line: &str| format!("{:<4} {line}", label(parts));
        (!is_step).then(|| line.lines().map(of_mesh).collect::<Vec<_>>().join("\n"))
    }
}

/// An accepted step.
pub fn step(number: usize, steps: usize, progress: f64, report: &StepReport) -> String {
    let width = steps.to_string().len();
    let place = if report.duration > 0.0 {
        let duration = report.duration;
        format!(
            "step {number:>5} of {duration:.2e} s  {:>5.1} % of the time",
            100.0 * progress
        )
    } else {
        format!("step {number:>width$}/{steps}  load factor {progress:.4}")
    };
    let mut line = format!(
        "{place}  {:>2} it  residual {}  plastic {:>5.1} %",
        report.iterations,
        residual(report.residuals.last().copied()),
        100.0 * report.plastic_share
    );
    if let Some(worst) = worst_node(report.worst) {
        let _ = write!(line, "  worst {worst}");
    }
    if report.at_round_off {
        line += "  (at round-off)";
    }
    if report.ghost_penalty > 0.0 {
        line += "  (with a ghost penalty)";
    }
    if report.tied_below > 0.0 {
        line += "  (with corners tied)";
    }
    if report.moves_by_means {
        line += "  (from means of the motion)";
    }
    line
}

/// A step that is tried again with a smaller one.
fn cut(error: &StepError) -> String {
    let mut line = format!(
        "cut  load factor {:.4} to {:.4}: {}",
        error.from, error.to, error.failure
    );
    if let Some(last) = error.residuals.last() {
        let _ = write!(line, ", residual {}", residual(Some(*last)));
    }
    if let Some(worst) = worst_node(error.worst) {
        let _ = write!(line, ", worst node {worst}");
    }
    line
}

/// A trial of a strength reduction.
fn trial(trial: &TrialSummary) -> String {
    let mut line = format!(
        "SRF {:<6}  {}  {} m  {} steps",
        short(trial.srf),
        if trial.stable { "stands" } else { "fails " },
        short(trial.displacement),
        trial.steps
    );
    if !trial.stable && !trial.reason.is_empty() {
        let _ = write!(line, "  ({})", trial.reason);
    }
    line
}

/// An equilibrium of a path along which strength is reduced.
fn path_point(point: &PathPoint) -> String {
    format!(
        "SRF {:.4}  {} m  {:.1} % of the work not elastic  {} it",
        point.factor,
        short(point.displacement),
        100.0 * point.dissipated,
        point.iterations
    )
}

/// The end of a stage.
fn end(summary: &StageSummary) -> String {
    let mut line = outcome(summary);
    let _ = write!(
        line,
        "; {} steps, {} iterations, {} cuts",
        summary.steps, summary.iterations, summary.cuts
    );
    // A search leaves the body as it was found: how far it moved is printed for every trial and equilibrium.
    if summary.safety.is_none() {
        let largest = short(summary.largest_displacement);
        let _ = write!(line, ", largest displacement {largest} m");
    }
    let path = summary
        .safety
        .as_ref()
        .and_then(|safety| safety.path.as_ref());
    if let Some(shares) = path.and_then(|path| path.shares.as_ref()) {
        let _ = write!(line, "\n  {}", self::shares(shares));
    }
    if let Some(energy) = &summary.energy {
        let _ = write!(line, "\n  {}", energy.sentence());
    }
    if let Some(newmark) = &summary.newmark {
        let text = newmark.sentence(summary.largest_displacement);
        let _ = write!(line, "\n  {text}");
    }
    if let Some(linear) = &summary.linear {
        let _ = write!(line, "\n  {}", linear.sentence());
    }
    line
}

/// The shares that decide a factor of safety.
fn shares(shares: &StrengthShares) -> String {
    let strengths: Vec<String> = (shares.strengths())
        .map(|(name, kind, share)| format!("{kind} of {name} {share:.3}"))
        .collect();
    let mut line = format!("∂ ln F/∂ ln of the strengths: {}", strengths.join(", "));
    if shares.reinforcement > 0.0 {
        let _ = write!(
            line,
            "; {:.1} % of the dissipation in reinforcement",
            100.0 * shares.reinforcement
        );
    }
    if let Some(Kinematic { factor, missed }) = shares.kinematic {
        let _ = write!(
            line,
            "; kinematic value {factor:.4}, in doubt by {:.1} % for the volume that the field misses",
            100.0 * missed
        );
    }
    line
}

/// How a stage ended, with the reason where that is news.
pub fn outcome(summary: &StageSummary) -> String {
    if let Some(safety) = &summary.safety
        && summary.outcome != StageOutcome::Interrupted
    {
        return interval(safety);
    }
    let word = match summary.outcome {
        StageOutcome::Completed => "completed",
        StageOutcome::Stopped => "stopped",
        StageOutcome::NotConverged => "not converged",
        StageOutcome::Interrupted => "interrupted",
    };
    let mut text = word.to_owned();
    let cut_short = [StageOutcome::NotConverged, StageOutcome::Interrupted];
    if cut_short.contains(&summary.outcome) {
        let _ = write!(text, " at {} %", short(100.0 * summary.reached));
    }
    if !summary.reason.is_empty() && summary.reason != EndReason::ReachedItsEnd.to_string() {
        let _ = write!(text, ": {}", summary.reason);
    }
    text
}

/// A factor of safety as an interval.
pub fn interval(safety: &SafetySummary) -> String {
    let three = |value: f64| format!("{value:.3}");
    match (safety.stable, safety.failed) {
        _ if safety.needs_no_strength() => {
            format!("F > {NEEDLESS}: nothing of this ground can fail, its strength is not needed")
        }
        (Some(stable), Some(failed)) => {
            let [stable, failed] = told_apart(stable, failed);
            format!("{stable} <= F < {failed}")
        }
        (Some(stable), None) => format!("F >= {}", three(stable)),
        (None, Some(failed)) => format!("F < {}", three(failed)),
        (None, None) => "no factor of safety was found".to_owned(),
    }
}

/// A relative norm with two digits.
pub fn residual(value: Option<f64>) -> String {
    match value {
        Some(value) if value.is_finite() => format!("{value:.1e}"),
        _ => "-".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use igimp_assembly::{ParticleSeed, Particles};
    use igimp_cases::run::{Controls, State};
    use igimp_linear::LinearEffort;
    use igimp_results::summary::PathSummary;
    use igimp_solver::{Body, PhaseTimes, StepFailure};

    use super::*;

    /// GOAL: a factor that no strength decides is no number to state, and others are. ORACLE: by hand.
    #[test]
    fn ground_that_needs_no_strength_has_no_number() {
        let text = |stable, failed| {
            interval(&SafetySummary {
                stable,
                failed,
                ..SafetySummary::default()
            })
        };
        assert_eq!(text(Some(1.25), Some(1.5)), "1.250 <= F < 1.500");
        assert_eq!(text(Some(900.0), None), "F >= 900.000");
        assert_eq!(text(Some(1.31792), Some(1.31826)), "1.3179 <= F < 1.3183");
        for failed in [None, Some(2e8)] {
            let text = text(Some(166_822_053.789), failed);
            assert!(
                text.starts_with("F > 1000: nothing of this ground can fail"),
                "{text}"
            );
        }
    }

    fn start(kind: &'static str) -> Event<'static, 2> {
        Event::StageStarted {
            stage: 0,
            of: 3,
            name: "initial stresses",
            kind,
            steps: 10,
        }
    }

    fn report() -> StepReport {
        StepReport {
            from: 0.0,
            to: 0.1,
            iterations: 3,
            residuals: vec![1.0, 1e-3, 4.24e-10],
            at_round_off: false,
            unknowns: 100,
            plastic_share: 0.031,
            false_support: 0.0,
            ghost_penalty: 0.0,
            tied_below: 0.0,
            moves_by_means: false,
            drag_share: 0.0,
            work: None,
            duration: 0.0,
            energy: None,
            water: None,
            pace: 1.0,
            external_work: 0.0,
            gross_work: 0.0,
            factor_in_doubt: 0.0,
            worst: Some(([31.5, 10.5, 0.0], 0)),
            linear: LinearEffort::default(),
            times: PhaseTimes::default(),
        }
    }

    fn error() -> StepError {
        StepError {
            from: 0.1,
            to: 0.2,
            residuals: vec![1.0, 0.082],
            worst: Some(([31.5, 10.5, 0.0], 0)),
            failure: Box::new(StepFailure::Stagnated),
        }
    }

    #[test]
    fn a_stage_is_lines() {
        let mut lines = Lines::default();
        let report = report();
        let ended = StageSummary {
            steps: 10,
            iterations: 31,
            cuts: 1,
            largest_displacement: 0.021_34,
            ..StageSummary::default()
        };
        let error = error();
        let events = [
            start("gravity"),
            Event::Step {
                number: 1,
                progress: 0.1,
                report: &report,
            },
            Event::Cut { error: &error },
            Event::StageEnded { summary: &ended },
            Event::Warning { text: "thin ice" },
        ];
        let text: Vec<String> = events
            .iter()
            .filter_map(|event| lines.line(event))
            .collect();
        insta::assert_snapshot!(text.join("\n"), @r#"
        stage 1/3 "initial stresses" (gravity, 10 steps)
          step  1/10  load factor 0.1000   3 it  residual 4.2e-10  plastic   3.1 %  worst (31.5, 10.5) m, x
          cut  load factor 0.1000 to 0.2000: the residual stagnates, residual 8.2e-2, worst node (31.5, 10.5) m, x
          completed; 10 steps, 31 iterations, 1 cuts, largest displacement 0.02134 m
        warning: thin ice
        "#);
    }

    /// One particle, at rest.
    fn state() -> State<2> {
        let seed = ParticleSeed {
            x: [0.5; 2],
            half_length: [0.25; 2],
            volume: 0.25,
            density: 0.0,
            law: 0,
            centroid: [0.0; _],
        };
        State {
            body: Body::new(Particles::new(&[seed]).unwrap()),
            controls: Controls {
                gravity: 1.0,
                acceleration: [0.0; 3],
                factors: Vec::new(),
                settlement: 0.0,
                srf: Vec::new(),
                rigid: Vec::new(),
                reinforcement: Vec::new(),
                water: None,
                drained: false,
                last_step: 0.0,
                time: 0.0,
                walls: Vec::new(),
            },
        }
    }

    #[test]
    fn a_search_is_its_trials() {
        let mut lines = Lines::default();
        let (report, error) = (report(), error());
        let stands = TrialSummary {
            srf: 1.375,
            stable: true,
            displacement: 0.0213,
            steps: 5,
            ..TrialSummary::default()
        };
        let fails = TrialSummary {
            srf: 1.5,
            reason: "no equilibrium".into(),
            ..stands.clone()
        };
        let fails = TrialSummary {
            stable: false,
            ..fails
        };
        let ended = StageSummary {
            safety: Some(SafetySummary {
                stable: Some(1.375),
                failed: Some(1.5),
                ..SafetySummary::default()
            }),
            ..StageSummary::default()
        };
        let state = state();
        let events = [
            start(SEARCH),
            Event::Step {
                number: 1,
                progress: 0.1,
                report: &report,
            },
            Event::Cut { error: &error },
            Event::Trial {
                trial: &stands,
                state: &state,
            },
            Event::Trial {
                trial: &fails,
                state: &state,
            },
            Event::StageEnded { summary: &ended },
        ];
        let text: Vec<String> = events
            .iter()
            .filter_map(|event| lines.line(event))
            .collect();
        insta::assert_snapshot!(text.join("\n"), @r#"
        stage 1/3 "initial stresses" (strength-reduction)
          SRF 1.375   stands  0.0213 m  5 steps
          SRF 1.5     fails   0.0213 m  5 steps  (no equilibrium)
          1.375 <= F < 1.500; 0 steps, 0 iterations, 0 cuts
        "#);
    }

    /// GOAL: every line of a mesh says of which it is, also the second one of a stage. ORACLE: by hand.
    #[test]
    fn all_lines_of_a_mesh_have_its_label() {
        let path = PathSummary {
            shares: Some(StrengthShares::default()),
            ..PathSummary::default()
        };
        let ended = StageSummary {
            safety: Some(SafetySummary {
                path: Some(path),
                ..SafetySummary::default()
            }),
            ..StageSummary::default()
        };
        let event: Event<'_, 2> = Event::OfMesh {
            parts: 2,
            event: &Event::StageEnded { summary: &ended },
        };
        let text = Lines::default().line(&event).unwrap();
        assert!(text.lines().count() == 2, "{text}");
        assert!(text.lines().all(|line| line.starts_with("h/2  ")), "{text}");
    }
}
