//! Results of a study of one case: runs, checks and tables.

pub(crate) mod coverage;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

use igimp_cases::CaseError;
use igimp_model::check::{Band, Check};
use igimp_results::ResultsError;
use igimp_results::tables::table::Table;
use igimp_solver::{MarchReport, Outcome, PhaseTimes, StepError};
use serde::Serialize;

use crate::harness::oracle::{Expected, Oracle, OracleKind};
use coverage::Extrapolated;

/// Relative residuals below this are round-off and say nothing about the rate of convergence \[-\].
const ROUND_OFF: f64 = 1e-12;

/// Newton's method near a solution.
const NEWTON: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "Newton's method",
    locator: "r₊ = C r² with C of order 1; a linear tail of rate 0.1 scores above 10⁴",
};
/// Most steps of a run whose residuals are kept for its snapshot.
const STEPS_KEPT: usize = 6;

/// How much is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Level {
    /// Coarse: under a minute.
    Quick,
    /// Everything that the checks need: within five minutes.
    Default,
    /// Finer meshes and further variants.
    Full,
}

/// How one run went.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct RunRecord {
    /// Method, mesh and parameters.
    pub(crate) variant: String,
    /// How it ended.
    pub(crate) outcome: String,
    /// Accepted steps.
    pub(crate) steps: usize,
    /// Newton corrections in accepted steps.
    pub(crate) iterations: usize,
    /// Steps that were tried and cut.
    pub(crate) cuts: usize,
    /// Wall-clock time \[s\].
    pub(crate) seconds: f64,
    /// Steps accepted above the tolerance, at round-off.
    pub(crate) at_round_off: usize,
    /// Share of the time in accepted steps: set-up, assembly, factorisation, solution, commit \[-\].
    pub(crate) phases: [f64; 5],
    /// The last step that found no equilibrium, if that ended the run.
    #[serde(skip)]
    pub(crate) stopped_by: Option<StepError>,
    /// Relative out-of-balance norms of each accepted step.
    #[serde(skip)]
    pub(crate) residuals: Vec<Vec<f64>>,
}

impl RunRecord {
    /// Describes a march that took `elapsed`.
    pub(crate) fn new(variant: impl Into<String>, report: &MarchReport, elapsed: Duration) -> Self {
        let outcome = match &report.outcome {
            Outcome::Completed => "completed".to_owned(),
            Outcome::Stopped { at } => format!("stopped at {at:.4} by the case"),
            Outcome::StepTooSmall {
                last_converged,
                cause,
            } => {
                format!(
                    "no equilibrium beyond {last_converged:.4}: {}",
                    cause.failure
                )
            }
        };
        Self {
            variant: variant.into(),
            outcome,
            steps: report.steps.len(),
            iterations: report.iterations(),
            cuts: report.failures.len(),
            seconds: elapsed.as_secs_f64(),
            at_round_off: report.steps.iter().filter(|step| step.at_round_off).count(),
            phases: phase_shares(&report.times()),
            stopped_by: match &report.outcome {
                Outcome::StepTooSmall { cause, .. } => Some(cause.clone()),
                _ => None,
            },
            residuals: report
                .steps
                .iter()
                .map(|step| step.residuals.clone())
                .collect(),
        }
    }

    /// The sum of several runs under one name.
    pub(crate) fn sum(variant: impl Into<String>, runs: &[&Self]) -> Self {
        Self {
            variant: variant.into(),
            outcome: format!("{} runs", runs.len()),
            steps: runs.iter().map(|run| run.steps).sum(),
            iterations: runs.iter().map(|run| run.iterations).sum(),
            cuts: runs.iter().map(|run| run.cuts).sum(),
            seconds: runs.iter().map(|run| run.seconds).sum(),
            at_round_off: runs.iter().map(|run| run.at_round_off).sum(),
            phases: std::array::from_fn(|k| {
                runs.iter().map(|run| run.phases[k]).sum::<f64>() / runs.len() as f64
            }),
            stopped_by: None,
            residuals: runs.iter().flat_map(|run| run.residuals.clone()).collect(),
        }
    }

    /// Effort counters as text, for exact snapshots.
    pub(crate) fn effort(&self) -> String {
        format!(
            "steps: {}\niterations: {}\ncuts: {}\noutcome: {}\n",
            self.steps, self.iterations, self.cuts, self.outcome
        )
    }
}

/// The phases of a march as shares of their sum \[-\].
fn phase_shares(times: &PhaseTimes) -> [f64; 5] {
    let seconds = [
        times.set_up,
        times.assembly,
        times.factor,
        times.solve,
        times.commit,
    ]
    .map(|time| time.as_secs_f64());
    let total: f64 = seconds.iter().sum();
    seconds.map(|time| if total > 0.0 { time / total } else { 0.0 })
}

/// A check with the run that it looks at.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Row {
    /// The check.
    #[serde(flatten)]
    pub(crate) check: Check,
    /// The basis of the outside value.
    pub(crate) oracle: OracleKind,
    /// Where in the source it is found.
    pub(crate) locator: &'static str,
    /// Whether this is a negative control: a variant that must miss the band of the method.
    pub(crate) control: bool,
    /// Whether the band is met.
    pub(crate) pass: bool,
    /// Index of its run.
    #[serde(skip)]
    pub(crate) run: usize,
}

/// Everything that the study of one case found.
#[derive(Debug)]
pub(crate) struct Study {
    /// Name of the case; also of its folder.
    pub(crate) case: &'static str,
    /// The computation and its checks, in a sentence or two of Markdown for the book.
    pub(crate) about: &'static str,
    /// Where its files go.
    pub(crate) folder: PathBuf,
    /// The runs, and sums of runs.
    pub(crate) runs: Vec<RunRecord>,
    /// The checks.
    pub(crate) rows: Vec<Row>,
    /// Tables that are held against snapshots.
    pub(crate) tables: Vec<Table>,
    /// Residual histories that are held against snapshots: a name and its text.
    pub(crate) histories: Vec<(String, String)>,
    /// Results on several meshes whose answer is known.
    pub(crate) extrapolated: Vec<Extrapolated>,
    /// Paragraphs for the reader of the printed report.
    pub(crate) notes: Vec<String>,
    /// Runs that had to reach their end and did not: where and why.
    pub(crate) unfinished: Vec<String>,
}

impl Study {
    /// A study that writes into a folder of its own, which is made.
    pub(crate) fn new(
        case: &'static str,
        about: &'static str,
        out: &Path,
    ) -> Result<Self, CaseError> {
        let folder = out.join(case);
        std::fs::create_dir_all(&folder).map_err(|source| ResultsError::File {
            path: folder.clone(),
            source,
        })?;
        Ok(Self {
            case,
            about,
            folder,
            runs: Vec::new(),
            rows: Vec::new(),
            tables: Vec::new(),
            histories: Vec::new(),
            extrapolated: Vec::new(),
            notes: Vec::new(),
            unfinished: Vec::new(),
        })
    }

    /// Records a run and returns its index.
    pub(crate) fn run(&mut self, run: RunRecord) -> usize {
        self.runs.push(run);
        self.runs.len() - 1
    }

    /// Records a run that has to reach its end, and returns its index. When it did not, the report
    /// says where and why.
    pub(crate) fn run_to_end(&mut self, run: RunRecord) -> usize {
        if let Some(error) = &run.stopped_by {
            self.unfinished.push(not_converged(self.case, &run, error));
        }
        self.run(run)
    }

    /// Records a check on a run: the method must meet the band.
    pub(crate) fn check(
        &mut self,
        run: usize,
        quantity: impl Into<String>,
        expected: Expected,
        band: Band,
        measured: f64,
    ) {
        self.record(run, quantity.into(), expected, band, measured, false);
    }

    /// Records a negative control on a run: a variant without a part of the method, which must miss
    /// what the method meets. The band says by how much at least.
    pub(crate) fn control(
        &mut self,
        run: usize,
        quantity: impl Into<String>,
        expected: Expected,
        band: Band,
        measured: f64,
    ) {
        self.record(run, quantity.into(), expected, band, measured, true);
    }

    fn record(
        &mut self,
        run: usize,
        quantity: String,
        expected: Expected,
        band: Band,
        measured: f64,
        control: bool,
    ) {
        let check = Check {
            case: self.case.to_owned(),
            variant: self.runs[run].variant.clone(),
            quantity,
            expected: expected.value,
            source: expected.oracle.source.to_owned(),
            band,
            measured,
            unit: None,
        };
        self.rows.push(Row {
            oracle: expected.oracle.kind,
            locator: expected.oracle.locator,
            control,
            pass: check.passes(),
            check,
            run,
        });
    }

    /// Writes a table as CSV and keeps it for its snapshot.
    pub(crate) fn table(&mut self, table: Table) -> Result<(), CaseError> {
        table.write_csv(&self.folder)?;
        self.tables.push(table);
        Ok(())
    }

    /// The residual history of a run as a table: step, iteration, residual; the check that its tail
    /// is quadratic; and, for a run without a cut, some of its steps for a snapshot.
    pub(crate) fn newton(&mut self, name: &str, run: usize) -> Result<(), CaseError> {
        let mut table = Table::new(
            format!("newton_{name}"),
            &["step", "iteration", "relative_out_of_balance_[-]"],
        );
        for (step, residuals) in self.runs[run].residuals.iter().enumerate() {
            for (iteration, &residual) in residuals.iter().enumerate() {
                table.push(vec![step as f64 + 1.0, iteration as f64, residual]);
            }
        }
        table.write_csv(&self.folder)?;
        let constant = quadratic_constant(&self.runs[run].residuals);
        if self.runs[run].cuts == 0 {
            let history = history(&self.runs[run].residuals);
            self.histories.push((name.to_owned(), history));
        }
        self.check(
            run,
            "Newton's tail r₊/r², median over steps [-]",
            NEWTON.says(1.0),
            Band::AtMost(100.0),
            constant,
        );
        Ok(())
    }
}

/// The relative residuals of some steps spread over a run, the last among them, a line each.
fn history(residuals: &[Vec<f64>]) -> String {
    let kept = STEPS_KEPT.min(residuals.len());
    let mut text = String::new();
    for k in 1..=kept {
        let step = k * residuals.len() / kept;
        let _ = write!(text, "step {step}:");
        for residual in &residuals[step - 1] {
            let _ = write!(text, " {residual:.1e}");
        }
        text.push('\n');
    }
    text
}

/// The record of a run that found no equilibrium.
fn not_converged(case: &str, run: &RunRecord, error: &StepError) -> String {
    let residuals: Vec<String> = error.residuals.iter().map(|r| format!("{r:.1e}")).collect();
    let worst = error.worst.map_or_else(String::new, |([x, y, _], axis)| {
        let axis = ["x", "y", "z"][axis];
        format!("\n  worst node   ({x:.4}, {y:.4}) m, {axis}")
    });
    format!(
        "not converged: {case}, {}: step from {:.5} to {:.5} after {} cuts\n  \
           cause        {}\n  residual     {}{worst}\n  \
           kept         {} steps to load factor {:.5}, with their tables and pictures",
        run.variant,
        error.from,
        error.to,
        run.cuts,
        error.failure,
        residuals.join(" "),
        run.steps,
        error.from,
    )
}

/// The constant C in r₊ = C r² at the end of each step, from the last relative residual r whose
/// square is above round-off; the median over the steps that have one \[-\].
///
/// The first correction of a step uses the elastic tangent and does not count.
pub(crate) fn quadratic_constant(residuals: &[Vec<f64>]) -> f64 {
    let mut constants: Vec<f64> = residuals
        .iter()
        .filter_map(|step| last_constant(step))
        .collect();
    constants.sort_by(f64::total_cmp);
    if constants.is_empty() {
        f64::NAN
    } else {
        constants[constants.len() / 2]
    }
}

fn last_constant(residuals: &[f64]) -> Option<f64> {
    let corrected = residuals.get(1..)?;
    let last = corrected
        .windows(2)
        .rfind(|pair| pair[0] * pair[0] > ROUND_OFF)?;
    Some(last[1] / (last[0] * last[0]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quadratic_tail_scores_one_and_a_linear_one_does_not() {
        let quadratic = vec![vec![0.3, 1e-1, 1e-2, 1e-4, 1e-8, 1e-15]; 3];
        assert!((quadratic_constant(&quadratic) - 1.0).abs() < 1e-12);
        let linear = vec![(0..10).map(|k| 0.1_f64.powi(k)).collect()];
        assert!(quadratic_constant(&linear) > 1e4);
        assert!(quadratic_constant(&[vec![1e-1, 1e-9]]).is_nan());
    }

    #[test]
    fn a_history_keeps_steps_to_the_last() {
        let residuals: Vec<Vec<f64>> = (1..=20).map(|k| vec![f64::from(k), 1e-3]).collect();
        let text = history(&residuals);
        assert_eq!(text.lines().count(), STEPS_KEPT);
        assert!(text.starts_with("step 3: 3.0e0 1.0e-3\n"));
        assert!(text.ends_with("step 20: 2.0e1 1.0e-3\n"));
        assert_eq!(history(&residuals[..1]), "step 1: 1.0e0 1.0e-3\n");
    }
}
