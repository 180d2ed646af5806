//! Charts of a study: each result over the first parameter that varies, a line for every setting of the
//! others.

use std::cmp::Ordering;
use std::path::{Path, PathBuf};

use igimp_figures::{CurvePlot, LineStyle, Scale, Series, SeriesStyle};
use igimp_report::ReportError;
use igimp_report::pictures::file_name;
use igimp_text::on_a_line;

use super::{Collected, SweepError};

/// Most charts, and most lines of one.
const MOST: [usize; 2] = [12, 12];

/// Positive values of which the largest is more than this times the smallest stand on a logarithmic axis \[-\].
const DECADES: f64 = 1e3;

/// The scale of an axis with these values.
fn scale_of(values: &[f64]) -> Scale {
    let smallest = values.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if smallest > 0.0 && largest > DECADES * smallest {
        Scale::Log
    } else {
        Scale::Linear
    }
}

/// A line of a chart.
struct Line {
    label: String,
    /// Where it stands in the legend, by each of the other parameters.
    place: Vec<f64>,
    points: Vec<[f64; 2]>,
}

impl Collected {
    /// Draws `results-NAME.svg` and `.png` into a folder, for each result that two tasks or more have;
    /// nothing when no parameter varies by numbers.
    ///
    /// # Errors
    /// [`SweepError::Case`].
    pub fn draw(&self, folder: &Path) -> Result<Vec<PathBuf>, SweepError> {
        let varies = |numbers: &Vec<f64>| numbers.iter().any(|x| x.total_cmp(&numbers[0]).is_ne());
        let mut along = self.numbers.iter().enumerate();
        let Some((axis, x)) = along.find_map(|(k, numbers)| {
            let numbers = numbers.as_ref().filter(|numbers| varies(numbers))?;
            Some((k, numbers))
        }) else {
            return Ok(Vec::new());
        };
        let first = self.numbers.len() + 2;
        let results = first..self.header.len() - 1;
        let is_end = |name: &str| name.ends_with(": stable") || name.ends_with(": failed");
        let mut drawn = Vec::new();
        for column in results.filter(|&column| !is_end(&self.header[column])) {
            let series = self.series(axis, x, column);
            if drawn.len() == MOST[0] || !series.iter().any(|line| line.points.len() > 1) {
                continue;
            }
            let plot = CurvePlot {
                title: "Parameter study".to_owned(),
                x_label: on_a_line(&self.header[1 + axis]).into_owned(),
                y_label: on_a_line(&self.header[column]).into_owned(),
                series,
                x_scale: scale_of(x),
                ..CurvePlot::default()
            };
            let path = folder.join(format!("results-{}", file_name(&self.header[column])));
            let drawing = plot.draw().map_err(ReportError::from)?;
            drawing.write(&path).map_err(ReportError::from)?;
            drawn.push(path);
        }
        Ok(drawn)
    }

    /// The points of a result, by the settings of the other parameters; in the order of their numbers, and of the tasks
    /// where a setting is none.
    fn series(&self, axis: usize, x: &[f64], column: usize) -> Vec<Series> {
        let others: Vec<usize> = (0..self.numbers.len())
            .filter(|&k| {
                k != axis
                    && self
                        .rows
                        .iter()
                        .any(|row| row[1 + k] != self.rows[0][1 + k])
            })
            .collect();
        let place = |task: usize, k: usize| {
            let first = |row: &Vec<String>| row[1 + k] == self.rows[task][1 + k];
            let by_task = || self.rows.iter().position(first).map(|task| task as f64);
            let numbers = self.numbers[k].as_ref();
            numbers.map_or_else(|| by_task().unwrap_or_default(), |numbers| numbers[task])
        };
        let mut lines: Vec<Line> = Vec::new();
        for (task, (row, &x)) in std::iter::zip(&self.rows, x).enumerate() {
            let Ok(y) = row[column].parse::<f64>() else {
                continue;
            };
            let settings = others
                .iter()
                .map(|&k| format!("{} = {}", on_a_line(&self.header[1 + k]), row[1 + k]));
            let label = settings.collect::<Vec<_>>().join(", ");
            match lines.iter_mut().find(|line| line.label == label) {
                Some(line) => line.points.push([x, y]),
                None => lines.push(Line {
                    place: others.iter().map(|&k| place(task, k)).collect(),
                    label,
                    points: vec![[x, y]],
                }),
            }
        }
        lines.truncate(MOST[1]);
        lines.sort_by(|a, b| {
            let orders = std::iter::zip(&a.place, &b.place).map(|(a, b)| a.total_cmp(b));
            orders.fold(Ordering::Equal, Ordering::then)
        });
        let style = SeriesStyle::LineAndMarkers(LineStyle::Solid);
        lines
            .into_iter()
            .map(|mut line| {
                line.points.sort_by(|a, b| a[0].total_cmp(&b[0]));
                Series::new(line.label, line.points, style)
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_over_more_than_three_decades_stand_on_a_logarithmic_axis() {
        assert_eq!(scale_of(&[60.0, 8.64e9, 3.0e5]), Scale::Log);
        assert_eq!(scale_of(&[60.0, 6e4]), Scale::Linear);
        assert_eq!(scale_of(&[0.0, 1.0, 1e6]), Scale::Linear);
    }

    /// GOAL: a legend counts up, however the tasks of a study are listed; settings that are no numbers stay as listed.
    #[test]
    fn legends_are_in_order() {
        let settings = [
            ("10 m", "rough"),
            ("2 m", "smooth"),
            ("10 m", "smooth"),
            ("2 m", "rough"),
        ];
        let rows = settings.iter().flat_map(|&(height, base)| {
            ["2", "1"].map(|x| {
                ["1", x, height, base, "done", "7", ""]
                    .map(str::to_owned)
                    .to_vec()
            })
        });
        let heights = settings
            .iter()
            .flat_map(|setting| [f64::from(u8::from(setting.0 == "10 m")); 2]);
        let collected = Collected {
            outdated: Vec::new(),
            unchecked: None,
            header: ["task", "x", "H", "base", "end", "q", "message"]
                .map(str::to_owned)
                .to_vec(),
            rows: rows.collect(),
            numbers: vec![Some([2.0, 1.0].repeat(4)), Some(heights.collect()), None],
            missing: Vec::new(),
            unknown: Vec::new(),
        };
        let x = collected.numbers[0].as_ref().unwrap();
        let series = collected.series(0, x, 5);
        let labels: Vec<&str> = series.iter().map(|line| line.label.as_str()).collect();
        let expected = [
            "H = 2 m, base = rough",
            "H = 2 m, base = smooth",
            "H = 10 m, base = rough",
            "H = 10 m, base = smooth",
        ];
        assert_eq!(labels, expected);
        assert!(
            series
                .iter()
                .all(|line| line.points == [[1.0, 7.0], [2.0, 7.0]])
        );
    }
}
