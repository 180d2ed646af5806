//! The message of a step that found no equilibrium: place, cause, saved files, remedies.

use std::fmt::{self, Write as _};
use std::path::Path;

use igimp_solver::{StepError, StepFailure};
use igimp_text::{count, short};

use super::COLLAPSE;
use crate::error::chain;
use crate::run::Failure;

/// Residuals shown before the gap; the last one follows it.
const SHOWN: usize = 5;
/// Widest line of suggestions that stay side by side.
const WIDE: usize = 100;

impl fmt::Display for Failure {
    /// The complete message, several lines that begin with `error: `.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&render(self))
    }
}

/// Position and axis of the largest out-of-balance force, in words.
pub fn worst_node(worst: Option<([f64; 3], usize)>) -> Option<String> {
    let (x, axis) = worst?;
    let name = ["x", "y", "z"].get(axis)?;
    // In the plane the third coordinate is zero.
    let upright = if x[2] != 0.0 || axis == 2 {
        format!(", {}", short(x[2]))
    } else {
        String::new()
    };
    let (first, second) = (short(x[0]), short(x[1]));
    Some(format!("({first}, {second}{upright}) m, {name}"))
}

fn render(failure: &Failure) -> String {
    let error = &failure.error;
    let went_wrong = match &*error.failure {
        StepFailure::TooDeep { .. } => "is not to be trusted".to_owned(),
        _ => format!("did not converge ({})", cuts(failure)),
    };
    let mut text = format!(
        "error: stage \"{}\", step {} of {} {went_wrong}\n",
        failure.stage, failure.step, failure.steps,
    );
    let mut row = |name: &str, value: &str| {
        let _ = writeln!(text, "  {name:<17}  {value}");
    };
    let reason = match &*error.failure {
        StepFailure::MaxIterations { .. } => Some("runs out"),
        StepFailure::Diverged => Some("diverges"),
        StepFailure::Stagnated => Some("stagnates"),
        _ => None,
    };
    if reason.is_none() {
        let because = chain(&*error.failure);
        let because = because.trim_start_matches("error: ");
        row("because", &because.replace("\n  because: ", ": "));
    }
    if failure.is_collapse() {
        row("probably", &collapse(error));
    }
    if !error.residuals.is_empty() {
        row("residual |r|/|f|", &history(&error.residuals, reason));
    }
    if let Some(worst) = worst_node(error.worst) {
        row("worst node", &(worst + &near(failure)));
    }
    if !failure.saved.is_empty() {
        row("saved", &saved(failure));
    }
    let mut name = "try";
    for line in suggestions(&failure.suggestions) {
        row(std::mem::take(&mut name), &line);
    }
    text
}

/// The collapse of soil at its strength in a step, and where on the way of the stage.
fn collapse(error: &StepError) -> String {
    format!(
        "collapse: {COLLAPSE}, between load factors {} and {}",
        short(error.from),
        short(error.to)
    )
}

fn cuts(failure: &Failure) -> String {
    if failure.cuts == 0 {
        return "no step cuts".to_owned();
    }
    let plural = if failure.cuts == 1 { "" } else { "s" };
    let smallest = if failure.smallest > 0.0 && failure.smallest <= 1.0 {
        let share = 1.0 / failure.smallest;
        if (share - share.round()).abs() < 0.01 * share {
            format!("1/{share:.0}")
        } else {
            short(failure.smallest)
        }
    } else {
        short(failure.smallest)
    };
    format!(
        "{} step cut{plural}, smallest step {smallest}",
        failure.cuts
    )
}

/// Residuals after each correction, condensed.
fn history(residuals: &[f64], reason: Option<&str>) -> String {
    let digit = |value: &f64| {
        if value.is_finite() {
            format!("{value:.0e}")
        } else {
            "-".to_owned()
        }
    };
    let after = residuals.get(1..).unwrap_or_default();
    let mut text = match after {
        [] => format!(
            "it 0: {}",
            residuals.first().map_or_else(String::new, digit)
        ),
        [only] => format!("it 1: {}", digit(only)),
        [first @ .., last] => {
            let shown: Vec<String> = first.iter().take(SHOWN).map(digit).collect();
            let gap = if first.len() > SHOWN { " ..." } else { "" };
            let shown = shown.join(" ");
            format!("it 1..{}: {shown}{gap} {}", after.len(), digit(last))
        }
    };
    if let Some(reason) = reason {
        let _ = write!(text, "  ({reason})");
    }
    text
}

/// How the soil around the worst node is doing.
fn near(failure: &Failure) -> String {
    let Some(near) = failure.near_worst else {
        return String::new();
    };
    let soil = failure
        .material
        .as_ref()
        .map_or_else(String::new, |name| format!(" of \"{name}\""));
    let mut text = format!(
        ";  {} of {} points there{soil} yield",
        count(near.yielding),
        count(near.points)
    );
    if near.apex > 0 {
        let _ = write!(text, ", {} returned to the apex", count(near.apex));
    }
    if near.at_strength > near.yielding {
        let _ = write!(
            text,
            ", {} carry 90 % of their strength or more",
            count(near.at_strength)
        );
    }
    text
}

/// The first path in full, others beside it by name.
fn saved(failure: &Failure) -> String {
    let parent = failure.saved.first().and_then(|first| first.parent());
    let mut names = Vec::new();
    for (index, path) in failure.saved.iter().enumerate() {
        let is_state = path
            .file_name()
            .is_some_and(|name| name == "last-converged");
        let shown: &Path = match parent {
            Some(parent) if index > 0 => path.strip_prefix(parent).unwrap_or(path),
            _ => path,
        };
        names.push(if is_state {
            format!(
                "{}/ (step {})",
                shown.display(),
                failure.step.saturating_sub(1)
            )
        } else {
            shown.display().to_string()
        });
    }
    names.join(", ")
}

/// Numbered, side by side where that fits a line.
fn suggestions(texts: &[String]) -> Vec<String> {
    let numbered: Vec<String> = texts
        .iter()
        .enumerate()
        .map(|(index, text)| format!("{}. {text}", index + 1))
        .collect();
    let line = numbered.join("   ");
    if line.chars().count() <= WIDE && !line.is_empty() {
        vec![line]
    } else {
        numbered
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::NearWorst;

    fn failure() -> Failure {
        let mut residuals = vec![1.0, 0.4, 0.2, 0.09];
        residuals.resize(16, 0.08);
        Failure {
            stage: "run-out".into(),
            step: 57,
            steps: 200,
            cuts: 5,
            smallest: 1.0 / 32.0,
            max_iterations: 15,
            error: StepError {
                from: 0.28,
                to: 0.285,
                residuals,
                worst: Some(([31.5, 10.5, 0.0], 0)),
                failure: Box::new(StepFailure::Stagnated),
            },
            near_worst: Some(NearWorst {
                points: 1310,
                yielding: 97,
                apex: 42,
                at_strength: 90,
            }),
            material: Some("clay".into()),
            suggestions: vec![
                "steps = 400 for this stage".into(),
                "tension_cutoff > 0 in \"clay\"".into(),
                "cell = \"0.25 m\"".into(),
            ],
            saved: ["last-converged", "convergence.csv", "report.html"]
                .iter()
                .map(|name| Path::new("results/slope").join(name))
                .collect(),
        }
    }

    #[test]
    fn a_failure_names_its_place_and_remedies() {
        insta::assert_snapshot!(render(&failure()), @r#"
        error: stage "run-out", step 57 of 200 did not converge (5 step cuts, smallest step 1/32)
          residual |r|/|f|   it 1..15: 4e-1 2e-1 9e-2 8e-2 8e-2 ... 8e-2  (stagnates)
          worst node         (31.5, 10.5) m, x;  97 of 1 310 points there of "clay" yield, 42 returned to the apex
          saved              results/slope/last-converged/ (step 56), convergence.csv, report.html
          try                1. steps = 400 for this stage   2. tension_cutoff > 0 in "clay"   3. cell = "0.25 m"
        "#);
    }

    #[test]
    fn a_particle_off_the_grid_is_the_reason() {
        let mut failure = failure();
        failure.cuts = 1;
        failure.smallest = 0.5;
        failure.near_worst = None;
        failure.saved.clear();
        failure.error.residuals = vec![1.0, f64::NAN];
        *failure.error.failure = StepFailure::LeavesGrid {
            particle: 12,
            position: [60.1, 2.0, 0.0],
        };
        failure.suggestions =
            vec!["a larger domain in [grid], so that the soil can run out there".into(); 2];
        insta::assert_snapshot!(render(&failure), @r#"
        error: stage "run-out", step 57 of 200 did not converge (1 step cut, smallest step 1/2)
          because            particle 12 would leave the background grid at [60.1, 2.0, 0.0] m
          residual |r|/|f|   it 1: -
          worst node         (31.5, 10.5) m, x
          try                1. a larger domain in [grid], so that the soil can run out there
                             2. a larger domain in [grid], so that the soil can run out there
        "#);
    }
}
