//! Pictures that several studies draw: contours on particle domains.

use igimp_assembly::Particles;
use igimp_figures::{ColourMap, FieldPlot, Outline};
use igimp_results::measure::domains;

/// Contours of a particle field, compression and sign as the label says.
pub(crate) fn contours(
    title: impl Into<String>,
    particles: &Particles<2>,
    values: Vec<f64>,
    label: &str,
    map: ColourMap,
    range: Option<(f64, f64)>,
) -> FieldPlot {
    FieldPlot {
        title: title.into(),
        domains: domains(particles),
        values,
        label: label.to_owned(),
        range,
        map,
        ..FieldPlot::default()
    }
}

/// The same picture with lines on it.
pub(crate) fn with_outlines(plot: FieldPlot, outlines: Vec<Outline>) -> FieldPlot {
    FieldPlot { outlines, ..plot }
}

/// A field in other units.
pub(crate) fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| factor * value).collect()
}
