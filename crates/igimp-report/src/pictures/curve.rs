//! A curve of a case with its references.

use std::path::Path;

use igimp_figures::{
    Band, Colour, CurvePlot, LineStyle, ReferenceLine, ReferenceValue, Series, SeriesStyle,
};
use igimp_model::{Curve, Reference, ReferenceValues};
use igimp_results::fields::plain;
use igimp_results::summary::FigureNote;
use igimp_results::tables::table::Table;
use igimp_text::short;

use super::{file_name, points, style, write};
use crate::error::ReportError;

/// The picture of a curve: the first two columns of its table over each other, with the reference
/// as a line or as points and its tolerance as a band.
///
/// # Errors
/// [`ResultsError::File`](igimp_results::ResultsError::File) and [`ReportError::Figure`].
pub fn curve_picture(
    folder: &Path,
    case_title: &str,
    curve: &Curve,
    table: &Table,
) -> Result<FigureNote, ReportError> {
    let computed = points(table, 0, 1);
    let mut plot = CurvePlot {
        title: case_title.to_owned(),
        x_label: curve.x.label.clone(),
        y_label: curve.y.label.clone(),
        ..CurvePlot::default()
    };
    let mut caption = format!(
        "Curve “{}”: {} over {}.",
        curve.name,
        plain(&curve.y.label),
        plain(&curve.x.label)
    );
    if let Some(reference) = &curve.reference {
        add_reference(&mut plot, reference, &computed);
        let band = reference.tolerance.map_or_else(String::new, |share| {
            format!(", ± {} %", short(100.0 * share))
        });
        caption = format!("{caption} Reference: {}{band}.", plain(&reference.label));
    }
    let style = style(computed.len());
    plot.series.push(Series {
        colour: Some(Colour::CURVE),
        ..Series::new("computed", computed, style)
    });
    let name = format!("curve-{}", file_name(&curve.name));
    write(folder, &name, &plot.draw()?, caption)
}

fn add_reference(plot: &mut CurvePlot, reference: &Reference, computed: &[[f64; 2]]) {
    let finite = computed
        .iter()
        .map(|point| point[0])
        .filter(|x| x.is_finite());
    let [from, to] = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
        [low.min(x), high.max(x)]
    });
    let extent = if from <= to { [from, to] } else { [0.0, 1.0] };
    let held = match &reference.values {
        ReferenceValues::Level { y, at: None } => {
            plot.lines.push(ReferenceLine {
                label: reference.label.clone(),
                at: ReferenceValue::Y(*y),
            });
            extent.map(|x| [x, *y]).to_vec()
        }
        ReferenceValues::Level { y, at: Some(x) } => {
            let marker = Series::markers(reference.label.clone(), vec![[*x, *y]]);
            plot.series.push(marker.in_colour(Colour::BLACK));
            let half = 0.02 * (extent[1].max(*x) - extent[0].min(*x));
            vec![[x - half, *y], [x + half, *y]]
        }
        ReferenceValues::Points(points) => {
            let style = if points.len() > 60 {
                SeriesStyle::Line(LineStyle::Dashed)
            } else {
                SeriesStyle::LineAndMarkers(LineStyle::Dashed)
            };
            let series = Series::new(reference.label.clone(), points.clone(), style);
            plot.series.push(series.in_colour(Colour::BLACK));
            points.clone()
        }
    };
    if let Some(tolerance) = reference.tolerance {
        let label = format!("±{} %", short(100.0 * tolerance));
        plot.bands.push(Band::around(label, &held, tolerance));
    }
}
