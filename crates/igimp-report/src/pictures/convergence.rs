//! Out-of-balance force over the iterations of a step, from `convergence.csv`.

use std::path::Path;

use igimp_figures::{
    Colour, ColourMap, CurvePlot, LineStyle, ReferenceLine, ReferenceValue, Scale, Series,
    SeriesStyle,
};
use igimp_results::ResultsError;
use igimp_results::summary::FigureNote;
use igimp_results::tables::cells::text_of;

use super::{file_name, titled, write};
use crate::error::ReportError;

/// Most steps of a kind that are drawn; of more, as many are picked evenly.
const MOST: usize = 40;

/// The iterations of one attempt at a step.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    /// Name of the stage.
    pub stage: String,
    /// Number of the step in its stage, from 1.
    pub step: usize,
    /// Whether the step was accepted.
    pub accepted: bool,
    /// Iteration, from 0, and relative out-of-balance norm before its correction.
    pub residuals: Vec<[f64; 2]>,
}

/// The histories in a `convergence.csv`, with the columns stage, step, from, to, iteration,
/// relative_out_of_balance, accepted. Rows that cannot be read are left out; a new attempt begins
/// where the iteration does not rise or another of the columns changes.
///
/// # Errors
/// [`ResultsError::Table`] if the file cannot be read.
pub fn histories(path: &Path) -> Result<Vec<History>, ReportError> {
    let table = |source| ResultsError::Table {
        path: path.to_owned(),
        source,
    };
    let mut reader = csv::ReaderBuilder::new()
        .flexible(true)
        .from_path(path)
        .map_err(table)?;
    let headers = reader.headers().map_err(table)?.clone();
    let column = |name: &str| headers.iter().position(|header| header.starts_with(name));
    let places = [
        "stage",
        "step",
        "from",
        "to",
        "iteration",
        "relative",
        "accepted",
    ]
    .map(column);
    let mut found: Vec<History> = Vec::new();
    let mut before: Option<[String; 4]> = None;
    for record in reader.records() {
        let record = record.map_err(table)?;
        let cell = |k: usize| {
            places[k]
                .and_then(|place| record.get(place))
                .unwrap_or("")
                .trim()
        };
        let Ok(residual) = cell(5).parse::<f64>() else {
            continue;
        };
        let accepted = matches!(cell(6), "true" | "1" | "yes");
        let attempt = [0, 1, 2, 3].map(|k| text_of(cell(k)).to_owned());
        let iteration = cell(4).parse::<f64>().ok();
        let goes_on = found.last().is_some_and(|history| {
            let last = history.residuals.last().map_or(-1.0, |point| point[0]);
            before.as_ref() == Some(&attempt) && iteration.is_none_or(|now| now > last)
        });
        if !goes_on {
            found.push(History {
                stage: attempt[0].clone(),
                step: attempt[1].parse().unwrap_or(0),
                accepted,
                residuals: Vec::new(),
            });
            before = Some(attempt);
        }
        if let Some(history) = found.last_mut() {
            let next = history.residuals.len() as f64;
            history.accepted = accepted;
            history
                .residuals
                .push([iteration.unwrap_or(next), residual]);
        }
    }
    Ok(found)
}

/// The plot of the histories of one stage: accepted steps from the first (dark) to the last (pale),
/// attempts that were cut or given up dashed. `tolerance` is the norm at which a step is accepted.
pub fn convergence_plot(title: &str, histories: &[&History], tolerance: Option<f64>) -> CurvePlot {
    let of = |accepted: bool| -> Vec<&History> {
        let all: Vec<_> = histories
            .iter()
            .filter(|h| h.accepted == accepted)
            .collect();
        let picked = all.len().min(MOST);
        let place = |k: usize| k * (all.len() - 1) / (picked - 1).max(1);
        (0..picked).map(|k| *all[place(k)]).collect()
    };
    let (accepted, cut) = (of(true), of(false));
    let last = accepted.len().saturating_sub(1);
    let mut series = Vec::new();
    for (k, history) in cut.iter().enumerate() {
        let label = if k == 0 { "not accepted" } else { "" };
        let style = SeriesStyle::Line(LineStyle::Dashed);
        series.push(line(label, history, style).in_colour(Colour::FAILURE));
    }
    for (k, history) in accepted.iter().enumerate() {
        let label = if k == 0 || k == last {
            format!("step {}", history.step)
        } else {
            String::new()
        };
        let style = SeriesStyle::Line(LineStyle::Solid);
        let colour = ColourMap::Sequential.at(0.85 * k as f64 / last.max(1) as f64);
        series.push(line(&label, history, style).in_colour(colour));
    }
    let lines = tolerance
        .filter(|limit| *limit > 0.0)
        .map(|limit| ReferenceLine {
            label: "tolerance".into(),
            at: ReferenceValue::Y(limit),
        });
    CurvePlot {
        title: title.to_owned(),
        x_label: "corrections made".into(),
        y_label: "relative out-of-balance force [−]".into(),
        y_scale: Scale::Log,
        lines: lines.into_iter().collect(),
        series,
        ..CurvePlot::default()
    }
}

/// A line through the values that a logarithmic axis can show.
fn line(label: &str, history: &History, style: SeriesStyle) -> Series {
    let shown = |point: &&[f64; 2]| point[1] > 0.0 && point[1].is_finite();
    let points = history.residuals.iter().filter(shown).copied().collect();
    Series::new(label, points, style)
}

/// The stages that histories belong to, in order.
pub(crate) fn stages_of(histories: &[History]) -> Vec<(&str, Vec<&History>)> {
    let mut stages: Vec<(&str, Vec<&History>)> = Vec::new();
    for history in histories {
        match stages.iter_mut().find(|(stage, _)| *stage == history.stage) {
            Some((_, members)) => members.push(history),
            None => stages.push((&history.stage, vec![history])),
        }
    }
    stages
}

/// The words below a plot of convergence.
pub(crate) fn convergence_caption(stage: &str, histories: &[&History]) -> String {
    let count = |accepted| histories.iter().filter(|h| h.accepted == accepted).count();
    let (accepted, cut) = (count(true), count(false));
    let picked = if accepted.max(cut) > MOST {
        format!("; at most {MOST} of each, evenly picked, are drawn")
    } else {
        String::new()
    };
    let plural = |count: usize, one: &str| match count {
        1 => format!("1 {one}"),
        _ => format!("{count} {one}s"),
    };
    let given_up = if cut > 0 {
        format!(
            ", {} that were not accepted (dashed)",
            plural(cut, "attempt")
        )
    } else {
        String::new()
    };
    format!(
        "Convergence in stage “{stage}”: {} from the first (dark) to the last (pale){given_up}{picked}.",
        plural(accepted, "accepted step"),
    )
}

/// The pictures of the convergence of every stage in the `convergence.csv` of a results folder.
///
/// # Errors
/// [`ResultsError::Table`], [`ResultsError::File`] and [`ReportError::Figure`].
pub fn convergence_pictures(
    folder: &Path,
    case_title: &str,
    tolerance: Option<f64>,
) -> Result<Vec<FigureNote>, ReportError> {
    let histories = histories(&folder.join("convergence.csv"))?;
    let mut notes = Vec::new();
    for (number, (stage, members)) in stages_of(&histories).into_iter().enumerate() {
        let title = titled(case_title, stage);
        let drawing = convergence_plot(&title, &members, tolerance).draw()?;
        let name = format!("convergence-{}-{}", number + 1, file_name(stage));
        notes.push(write(
            folder,
            &name,
            &drawing,
            convergence_caption(stage, &members),
        )?);
    }
    Ok(notes)
}
