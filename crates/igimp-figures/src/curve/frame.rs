//! Frame of a [`CurvePlot`]: the ranges of its axes, the lines of its labels, the place of its area.

use super::{CurvePlot, ReferenceValue};
use crate::FigureError;
use crate::axis::{Axis, Scale};
use crate::drawing::font::{self, LINE_HEIGHT};
use crate::frame::{self, Frame, GAP, LABEL, MARGIN, NOTE, TICK, TITLE};
use crate::geometry::{Point, Rect};

/// Width \[pt\] of the picture, but for a legend beside it.
pub(crate) const WIDTH: f64 = 640.0;
/// Height \[pt\] of the picture.
pub(crate) const HEIGHT: f64 = 430.0;

/// The plot area and its axes.
pub(crate) fn frame_of(plot: &CurvePlot) -> Result<Frame, FigureError> {
    let x_range = range(plot, 0, "x axis", plot.x_scale, plot.x_range)?;
    let y_range = range(plot, 1, "y axis", plot.y_scale, plot.y_range)?;
    let title = frame::title_height(&title_lines(plot), TITLE);
    let x_label = frame::lines_height(&x_label_lines(plot), LABEL);
    let y_label = frame::lines_height(&y_label_lines(plot), LABEL);
    let note = if hidden_points(plot) > 0 {
        NOTE * LINE_HEIGHT + 0.5 * GAP
    } else {
        0.0
    };
    let bottom = HEIGHT - MARGIN - note - x_label - 0.5 * GAP - frame::tick_height();

    let mut y = Axis {
        scale: plot.y_scale,
        range: y_range,
        span: (bottom, MARGIN + title),
    };
    // The factor of the axis takes a line above the area, which does not change the ticks.
    let y_ticks = y.ticks_stacked(TICK);
    let top = MARGIN + title + frame::factor_height(&y_ticks);
    y.span.1 = top;
    let left = MARGIN + y_label + 0.5 * GAP + frame::tick_width(&y_ticks);
    let area = Rect {
        left,
        top,
        right: WIDTH - MARGIN - GAP,
        bottom,
    };
    let x = Axis {
        scale: plot.x_scale,
        range: x_range,
        span: (area.left, area.right),
    };
    let x_ticks = x.ticks_beside(TICK);
    Ok(Frame {
        area,
        x,
        y,
        x_ticks,
        y_ticks,
    })
}

pub(crate) fn title_lines(plot: &CurvePlot) -> Vec<String> {
    font::wrap(&plot.title, TITLE, WIDTH - 8.0 * MARGIN)
}

pub(crate) fn x_label_lines(plot: &CurvePlot) -> Vec<String> {
    font::wrap(&plot.x_label, LABEL, 0.7 * WIDTH)
}

pub(crate) fn y_label_lines(plot: &CurvePlot) -> Vec<String> {
    font::wrap(&plot.y_label, LABEL, 0.7 * HEIGHT)
}

/// The given range if it can be drawn, or one about everything that has coordinate `axis`.
fn range(
    plot: &CurvePlot,
    axis: usize,
    name: &'static str,
    scale: Scale,
    given: Option<(f64, f64)>,
) -> Result<(f64, f64), FigureError> {
    if let Some((from, to)) = given {
        let title = plot.title.clone();
        let refused = FigureError::InvalidRange {
            title,
            axis: name,
            from,
            to,
        };
        return if scale.accepts((from, to)) {
            Ok((from, to))
        } else {
            Err(refused)
        };
    }
    let bands = plot
        .bands
        .iter()
        .flat_map(|band| band.lower.iter().chain(&band.upper));
    let points = plot
        .series
        .iter()
        .flat_map(|series| &series.points)
        .chain(bands);
    let lines = plot.lines.iter().filter_map(|line| match line.at {
        ReferenceValue::X(x) => (axis == 0).then_some(x),
        ReferenceValue::Y(y) => (axis == 1).then_some(y),
    });
    let values = points.map(|point| point[axis]).chain(lines);
    let empty = if scale == Scale::Log {
        (1.0, 10.0)
    } else {
        (0.0, 1.0)
    };
    Ok(scale.range_of(values).unwrap_or(empty))
}

/// Number of points of the series that the axes cannot show; breaks that were asked for are none.
pub(crate) fn hidden_points(plot: &CurvePlot) -> usize {
    let points = plot.series.iter().flat_map(|series| &series.points);
    let points = points.filter(|[x, y]| !(x.is_nan() && y.is_nan()));
    points.filter(|point| !shows(plot, point)).count()
}

/// Whether the axes can show a point.
pub(crate) fn shows(plot: &CurvePlot, &[x, y]: &Point) -> bool {
    plot.x_scale.shows(x) && plot.y_scale.shows(y)
}
