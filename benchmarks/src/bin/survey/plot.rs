//! The plot of growth: time against size, both logarithmic, with the powers that theory knows.

use std::path::Path;

use igimp_benchmarks::BenchResult;
use igimp_figures::{CurvePlot, LineStyle, Scale, Series, SeriesStyle};

/// A quantity that grows with size.
#[derive(Clone, Debug)]
pub(crate) struct Curve {
    /// Text in the legend.
    pub(crate) label: String,
    /// Particles or unknowns, and time \[ns\].
    pub(crate) points: Vec<[f64; 2]>,
    /// The power that theory expects.
    pub(crate) power: f64,
}

/// Writes `growth.svg` and `growth.png`, if there is anything to draw.
pub(crate) fn write(curves: &[Curve], folder: &Path) -> BenchResult {
    if curves.is_empty() {
        return Ok(());
    }
    let mut series = Vec::new();
    let mut powers: Vec<f64> = Vec::new();
    for curve in curves {
        let points = curve.points.iter().map(|&[size, time]| [size, time / 1e9]);
        let style = SeriesStyle::LineAndMarkers(LineStyle::Solid);
        series.push(Series::new(&*curve.label, points.collect(), style));
        if !powers.contains(&curve.power) {
            powers.push(curve.power);
            series.extend(guide(curve));
        }
    }
    let plot = CurvePlot {
        title: "Growth with size, one thread".into(),
        x_label: "particles (assembly), unknowns (factorisation)".into(),
        y_label: "time of one pass [s]".into(),
        x_scale: Scale::Log,
        y_scale: Scale::Log,
        series,
        ..CurvePlot::default()
    };
    plot.write(&folder.join("growth"))?;
    Ok(())
}

/// The power that theory expects, through the first point of a curve and a little below.
fn guide(curve: &Curve) -> Option<Series> {
    let (first, last) = (curve.points.first()?, curve.points.last()?);
    let line = |size: f64| {
        [
            size,
            0.6e-9 * first[1] * (size / first[0]).powf(curve.power),
        ]
    };
    let label = format!("power {}", curve.power);
    let style = SeriesStyle::Line(LineStyle::Dashed);
    Some(Series::new(
        label,
        vec![line(first[0]), line(last[0])],
        style,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn guides_have_the_power_of_theory() {
        let points = vec![[1e4, 1e6], [1e6, 3e9]];
        let curve = Curve {
            label: String::new(),
            points,
            power: 1.5,
        };
        let guide = guide(&curve).unwrap();
        assert!((guide.points[1][1] / guide.points[0][1] - 1e3).abs() < 1e-6);
    }
}
