//! Factors of safety against time, beside those of states that do not change.

use std::path::Path;

use igimp_figures::{Colour, CurvePlot, LineStyle, Series, SeriesStyle};
use igimp_results::summary::FigureNote;

use super::{titled, write};
use crate::error::ReportError;

/// Units of time that an axis may have, and their seconds; the largest of which three pass is taken.
const UNITS: [(&str, f64); 4] = [
    ("a", 31_557_600.0),
    ("d", 86_400.0),
    ("h", 3600.0),
    ("s", 1.0),
];
/// How the lines of states that do not change are drawn, one after the other.
const LIMITS: [LineStyle; 3] = [LineStyle::Dashed, LineStyle::Dotted, LineStyle::Solid];

/// Factors of safety: by time \[s\], and of stages whose water does not change in time, by their names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SafetyInTime {
    /// Time and factor.
    pub points: Vec<[f64; 2]>,
    /// Stage and factor.
    pub limits: Vec<(String, f64)>,
}

/// The picture of factors of safety against time, under a name for files.
///
/// # Errors
/// [`ResultsError::File`](igimp_results::ResultsError::File) and [`ReportError::Figure`].
pub fn safety_in_time_picture(
    folder: &Path,
    case_title: &str,
    name: &str,
    found: &SafetyInTime,
) -> Result<FigureNote, ReportError> {
    let last = found.points.iter().map(|at| at[0]).fold(0.0, f64::max);
    let is_passed = |unit: &&(&str, f64)| last >= 3.0 * unit.1;
    let (unit, seconds) = UNITS.iter().find(is_passed).copied().unwrap_or(("s", 1.0));
    let points: Vec<[f64; 2]> = (found.points.iter())
        .map(|[time, factor]| [time / seconds, *factor])
        .collect();
    let style = SeriesStyle::LineAndMarkers(LineStyle::Solid);
    let curve = Series::new("in time", points, style).in_colour(Colour::CURVE);
    let limits = std::iter::zip(&found.limits, LIMITS.iter().cycle());
    let limits = limits.map(|((stage, factor), style)| {
        let line = vec![[0.0, *factor], [last / seconds, *factor]];
        Series::new(stage.clone(), line, SeriesStyle::Line(*style))
    });
    let plot = CurvePlot {
        title: titled(case_title, "factor of safety in time"),
        x_label: format!("time [{unit}]"),
        y_label: "factor of safety F [−]".into(),
        series: std::iter::once(curve).chain(limits).collect(),
        ..CurvePlot::default()
    };
    let caption = "Factor of safety against the time of the water, each from the state of its time on the given geometry; \
                   lines: stages whose water does not change in time."
        .to_owned();
    write(folder, name, &plot.draw()?, caption)
}
