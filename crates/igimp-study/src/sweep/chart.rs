//! Charts of a study: each result over the first parameter that varies, a line for every setting of the
//! others.

use std::path::{Path, PathBuf};

use igimp_figures::{CurvePlot, LineStyle, Series, SeriesStyle};
use igimp_report::ReportError;
use igimp_report::pictures::file_name;
use igimp_text::on_a_line;

use super::{Collected, SweepError};

/// Most charts, and most lines of one.
const MOST: [usize; 2] = [12, 12];

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
                ..CurvePlot::default()
            };
            let path = folder.join(format!("results-{}", file_name(&self.header[column])));
            let drawing = plot.draw().map_err(ReportError::from)?;
            drawing.write(&path).map_err(ReportError::from)?;
            drawn.push(path);
        }
        Ok(drawn)
    }

    /// The points of a result, by the settings of the other parameters.
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
        let mut lines: Vec<(String, Vec<[f64; 2]>)> = Vec::new();
        for (row, &x) in std::iter::zip(&self.rows, x) {
            let Ok(y) = row[column].parse::<f64>() else {
                continue;
            };
            let settings = others
                .iter()
                .map(|&k| format!("{} = {}", on_a_line(&self.header[1 + k]), row[1 + k]));
            let label = settings.collect::<Vec<_>>().join(", ");
            match lines.iter_mut().find(|(own, _)| *own == label) {
                Some((_, points)) => points.push([x, y]),
                None => lines.push((label, vec![[x, y]])),
            }
        }
        lines.truncate(MOST[1]);
        let style = SeriesStyle::LineAndMarkers(LineStyle::Solid);
        lines
            .into_iter()
            .map(|(label, mut points)| {
                points.sort_by(|a, b| a[0].total_cmp(&b[0]));
                Series::new(label, points, style)
            })
            .collect()
    }
}
