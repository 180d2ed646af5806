//! The pictures of a test, with the data over the computed curves.

use igimp_figures::{CurvePlot, ReferenceLine, ReferenceValue, Series};
use igimp_solver::element::ElementState;

use super::Drive;
use super::compared::Compared;
use super::measure::{Measure, undrained};
use super::table::{abscissa, driven, driven_name};

/// The states of a test and the data beside them.
struct Drawn<'a> {
    states: &'a [ElementState],
    drive: &'a Drive,
    title: &'a str,
    compared: Option<&'a Compared>,
}

/// Stress over strain, the path of stress, and volume or pore pressure over strain, by the names of their files; then one for every
/// quantity that was measured and stands in none of them.
pub(super) fn plots(
    states: &[ElementState],
    drive: &Drive,
    title: &str,
    compared: Option<&Compared>,
) -> Vec<(String, CurvePlot)> {
    let drawn = Drawn {
        states,
        drive,
        title,
        compared,
    };
    let strain = abscissa(drive);
    let x_label = format!("{} [%]", driven_name(drive));
    let is_shear = matches!(drive, Drive::Standard(test, _) if test.is_shear());
    let (stress, stress_label) = if is_shear {
        (Measure::TauXy, "shear stress τ_{xy} [kPa]")
    } else {
        (Measure::Q, "q [kPa]")
    };
    let (last, last_name, last_label) = match undrained(drive) {
        Some(_) => (
            Measure::PorePressure,
            "pore-pressure",
            "pore pressure [kPa]",
        ),
        None => (Measure::Volume, "volume", Measure::Volume.header()),
    };
    let path_label = "p', compression positive [kPa]";
    let mut plots = vec![
        (
            "stress-strain".to_owned(),
            drawn.plot((strain, &x_label), (stress, stress_label)),
        ),
        (
            "stress-path".to_owned(),
            drawn.plot((Measure::P, path_label), (Measure::Q, "q [kPa]")),
        ),
        (
            last_name.to_owned(),
            drawn.plot((strain, &x_label), (last, last_label)),
        ),
    ];
    let shown = if driven(drive).is_some() {
        [Some(stress), Some(last)]
    } else {
        [None, None]
    };
    let columns = compared.map_or(&[][..], |compared| &compared.data.columns);
    for measure in columns
        .iter()
        .filter(|measure| !shown.contains(&Some(**measure)))
    {
        let name = format!("measured-{}", measure.name().replace([' ', '_'], "-"));
        plots.push((name, drawn.measured(*measure)));
    }
    plots
}

/// Computed less measured over the scale of each column, by the place on the way.
pub(super) fn residuals(
    compared: &Compared,
    drive: &Drive,
    title: &str,
    scales: &[f64],
) -> CurvePlot {
    let at = |at: f64| driven(drive).map_or(at, |strain| strain.printed(at));
    let columns = compared.data.columns.iter().enumerate().zip(scales);
    let series = columns.map(|((column, measure), scale)| {
        let rows = compared.data.rows.iter().zip(&compared.computed);
        let points = rows.map(|(row, computed)| {
            let difference = computed[column] - row.values[column];
            [at(row.at), difference / scale]
        });
        let known = points.filter(|point| point[1].is_finite());
        let is_alone = compared.data.columns.len() == 1;
        let name = if is_alone { "" } else { measure.name() };
        Series::markers(name, known.collect())
    });
    let series: Vec<Series> = series.collect();
    let sizes = series.iter().flat_map(|marks| &marks.points);
    let most = sizes.fold(0.0_f64, |most, point| most.max(point[1].abs()));
    let end = (1.1 * most).max(3.0);
    let line = |value: f64| ReferenceLine {
        label: String::new(),
        at: ReferenceValue::Y(value),
    };
    CurvePlot {
        title: title.to_owned(),
        x_label: driven(drive)
            .map_or("legs of the path [-]", Measure::header)
            .to_owned(),
        y_label: "residual over its standard deviation [-]".to_owned(),
        lines: [-2.0, 0.0, 2.0].map(line).to_vec(),
        y_range: Some((-end, end)),
        series,
        ..CurvePlot::default()
    }
}

impl Drawn<'_> {
    /// A quantity over another one, and the measurements of both.
    fn plot(&self, (x, x_label): (Measure, &str), (y, y_label): (Measure, &str)) -> CurvePlot {
        let first = &self.states[0];
        let value = |measure: Measure, state| measure.printed(measure.of(state, first, self.drive));
        let curve = (self.states.iter())
            .map(|state| [value(x, state), value(y, state)])
            .collect();
        let points = match (self.measured_of(x), self.measured_of(y)) {
            (Some(of_x), Some(of_y)) => (of_x.into_iter().zip(of_y))
                .map(|(along, up)| [x.printed(along), y.printed(up)])
                .collect(),
            _ => Vec::new(),
        };
        self.over(x_label, y_label, curve, points)
    }

    /// A measured quantity over the place on the way; computed values at the same places.
    fn measured(&self, measure: Measure) -> CurvePlot {
        let Some(compared) = self.compared else {
            return CurvePlot::default();
        };
        let is_same = |of: &Measure| *of == measure;
        let column = compared.data.columns.iter().position(is_same).unwrap_or(0);
        let label = driven(self.drive).map_or("legs of the path [-]", Measure::header);
        let at = |at: f64| driven(self.drive).map_or(at, |strain| strain.printed(at));
        let rows = || compared.data.rows.iter().zip(&compared.computed);
        let mut curve: Vec<[f64; 2]> = rows()
            .map(|(row, computed)| [at(row.at), measure.printed(computed[column])])
            .collect();
        curve.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let points = rows()
            .map(|(row, _)| [at(row.at), measure.printed(row.values[column])])
            .collect();
        self.over(label, measure.header(), curve, points)
    }

    /// The measured values of a quantity, by rows.
    fn measured_of(&self, measure: Measure) -> Option<Vec<f64>> {
        let data = &self.compared?.data;
        if driven(self.drive) == Some(measure) {
            return Some(data.rows.iter().map(|row| row.at).collect());
        }
        let column = data.columns.iter().position(|of| *of == measure)?;
        Some(data.rows.iter().map(|row| row.values[column]).collect())
    }

    fn over(
        &self,
        x_label: &str,
        y_label: &str,
        curve: Vec<[f64; 2]>,
        mut points: Vec<[f64; 2]>,
    ) -> CurvePlot {
        points.retain(|point| point.iter().all(|value| value.is_finite()));
        let name = if points.is_empty() { "" } else { "computed" };
        let mut series = vec![Series::line(name, curve)];
        if !points.is_empty() {
            series.push(Series::markers("measured", points));
        }
        CurvePlot {
            title: self.title.to_owned(),
            x_label: x_label.to_owned(),
            y_label: y_label.to_owned(),
            series,
            ..CurvePlot::default()
        }
    }
}
