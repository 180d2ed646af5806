//! Displacement against strength reduction factor, with the interval of the factor of safety.

use std::path::Path;

use igimp_figures::{Band, Colour, CurvePlot, LineStyle, Scale, Series, SeriesStyle};
use igimp_results::fields::{Dimension, Scale as Unit};
use igimp_results::summary::{FigureNote, PathPoint, PathSummary, SafetySummary};
use igimp_text::short;

use super::{file_name, titled, write};
use crate::error::ReportError;

/// Displacements that differ by more than this factor are drawn over a logarithmic axis.
const WIDE: f64 = 50.0;

/// The picture of a search for the factor of safety: the displacement of every trial over its
/// strength reduction factor, the interval of the factor of safety shaded.
///
/// # Errors
/// [`ResultsError::File`](igimp_results::ResultsError::File) and [`ReportError::Figure`].
pub fn safety_picture(
    folder: &Path,
    case_title: &str,
    stage: &str,
    safety: &SafetySummary,
) -> Result<FigureNote, ReportError> {
    let of_trials = safety.trials.iter().map(|trial| trial.displacement);
    let on_path = safety.path.iter().flat_map(|path| &path.points);
    let unit = Unit::of(
        Dimension::Displacement,
        of_trials.chain(on_path.map(|point| point.displacement)),
    );
    let of = |stable: bool| {
        let mut points: Vec<[f64; 2]> = safety
            .trials
            .iter()
            .filter(|trial| trial.stable == stable)
            .map(|trial| [trial.srf, trial.displacement / unit.divide_by])
            .filter(|point| point.iter().all(|value| value.is_finite()))
            .collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        points
    };
    let (stable, failed) = (of(true), of(false));
    let course = course(safety, unit.divide_by);
    let mark = |of: fn(&PathSummary) -> Option<PathPoint>| -> Vec<[f64; 2]> {
        let found = safety.path.as_ref().and_then(of);
        let place = |point: PathPoint| [point.factor, point.displacement / unit.divide_by];
        found.map(place).into_iter().collect()
    };
    let all = stable.iter().chain(&failed).chain(&course);
    let (y_scale, y_range) = ordinate(all.map(|point| point[1]));
    let interval = safety.stable.zip(safety.failed).zip(y_range);
    let bands = interval.map(|((from, to), (bottom, top))| Band {
        label: format!("{} ≤ FoS < {}", short(from), short(to)),
        lower: vec![[from, bottom], [to, bottom]],
        upper: vec![[from, top], [to, top]],
    });
    let style = SeriesStyle::LineAndMarkers(LineStyle::Solid);
    let stands = if course.is_empty() { stable } else { course };
    let mut series = vec![Series::new("stands", stands, style).in_colour(Colour::CURVE)];
    series.extend(if safety.path.is_some() {
        vec![
            Series::markers("moves as a mechanism", mark(|path| path.mechanism))
                .in_colour(Colour::FAILURE),
            Series::markers("knee", mark(|path| path.knee)).in_colour(Colour::NO_VALUE),
        ]
    } else {
        vec![Series::markers("fails, last equilibrium", failed).in_colour(Colour::FAILURE)]
    });
    let plot = CurvePlot {
        title: titled(case_title, stage),
        x_label: "strength reduction factor F [−]".into(),
        y_label: format!("displacement [{}]", unit.unit),
        y_scale,
        y_range,
        bands: bands.into_iter().collect(),
        series,
        ..CurvePlot::default()
    };
    let rest = match &safety.path {
        Some(path) => format!("The path ended because {}.", path.end.sentence()),
        None => "A trial that fails stands at the smallest factor at which \
                 it failed, with the displacement of its last equilibrium."
            .to_owned(),
    };
    let caption = format!(
        "Displacement over the strength reduction factor at every equilibrium of “{stage}”; shaded: the \
         interval of the factor of safety. {rest}"
    );
    let name = format!("safety-{}", file_name(stage));
    write(folder, &name, &plot.draw()?, caption)
}

/// Every equilibrium of every march, so that the knee is seen: strength reduction factor and displacement in a unit.
fn course(safety: &SafetySummary, unit: f64) -> Vec<[f64; 2]> {
    let mut course: Vec<[f64; 2]> = safety
        .trials
        .iter()
        .flat_map(|trial| &trial.course)
        .map(|[srf, displacement]| [*srf, displacement / unit])
        .filter(|[srf, _]| safety.stable.is_some_and(|stable| *srf <= stable))
        .collect();
    course.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let points = safety.path.iter().flat_map(|path| &path.points);
    course.extend(points.map(|point| [point.factor, point.displacement / unit]));
    course
}

/// Scale and range of the axis of displacements.
fn ordinate(displacements: impl Iterator<Item = f64> + Clone) -> (Scale, Option<(f64, f64)>) {
    let highest = displacements.clone().fold(0.0, f64::max);
    let lowest = displacements
        .filter(|&d| d > 0.0)
        .fold(f64::INFINITY, f64::min);
    if highest > WIDE * lowest {
        (Scale::Log, Some((0.6 * lowest, 1.8 * highest)))
    } else if highest > 0.0 {
        (Scale::Linear, Some((0.0, 1.08 * highest)))
    } else {
        (Scale::Linear, None)
    }
}
