//! The furniture of every plot: border, ticks, axis labels, title and notes.

use super::axis::Axis;
use super::colour::Colour;
use super::drawing::{Anchor, Drawing, Stroke};
use super::geometry::Rect;
use crate::axis::ticks::Ticks;
use crate::drawing::font::{self, CAP_HEIGHT, LINE_HEIGHT};

/// Font size \[pt\] of titles.
pub(super) const TITLE: f64 = 14.0;
/// Font size \[pt\] of axis labels and panel titles.
pub(super) const LABEL: f64 = 12.5;
/// Font size \[pt\] of tick labels and legends.
pub(super) const TICK: f64 = 11.0;
/// Font size \[pt\] of notes below the picture.
pub(super) const NOTE: f64 = 10.0;
/// Free space \[pt\] along the edge of the picture.
pub(super) const MARGIN: f64 = 12.0;
/// Space \[pt\] between neighbouring parts.
pub(super) const GAP: f64 = 8.0;

const TICK_LENGTH: f64 = 4.0;
const MINOR_TICK_LENGTH: f64 = 2.5;
const TICK_PAD: f64 = 4.0;

/// Height \[pt\] that lines of text take.
pub(super) fn lines_height(lines: &[String], size: f64) -> f64 {
    lines.len() as f64 * size * LINE_HEIGHT
}

/// Height \[pt\] of a title with the gap below it; zero without a title.
pub(super) fn title_height(lines: &[String], size: f64) -> f64 {
    if lines.is_empty() {
        0.0
    } else {
        lines_height(lines, size) + 0.5 * GAP
    }
}

/// Space \[pt\] above the plot area that the factor of the upright axis needs.
pub(super) fn factor_height(ticks: &Ticks) -> f64 {
    if ticks.factor.is_some() {
        TICK * LINE_HEIGHT
    } else {
        0.0
    }
}

/// Space \[pt\] that tick marks and tick labels need left of the plot area.
pub(super) fn tick_width(ticks: &Ticks) -> f64 {
    let widest = ticks
        .major
        .iter()
        .map(|(_, label)| font::width(label, TICK))
        .fold(0.0, f64::max);
    TICK_LENGTH + TICK_PAD + widest
}

/// Space \[pt\] that tick marks and tick labels need below the plot area.
pub(super) fn tick_height() -> f64 {
    TICK_LENGTH + TICK_PAD + TICK * LINE_HEIGHT
}

/// A plot area with its two axes.
pub(super) struct Frame {
    pub(super) area: Rect,
    pub(super) x: Axis,
    pub(super) y: Axis,
    pub(super) x_ticks: Ticks,
    pub(super) y_ticks: Ticks,
}

impl Frame {
    /// Pale lines behind curves, at the labelled ticks.
    pub(super) fn draw_grid(&self, drawing: &mut Drawing) {
        let upright = self
            .x_ticks
            .major
            .iter()
            .filter_map(|(value, _)| self.x.place(*value));
        let level = self
            .y_ticks
            .major
            .iter()
            .filter_map(|(value, _)| self.y.place(*value));
        let lines = upright
            .map(|x| vec![[x, self.area.top], [x, self.area.bottom]])
            .chain(level.map(|y| vec![[self.area.left, y], [self.area.right, y]]))
            .collect();
        drawing.stroke(lines, Stroke::solid(Colour::GRID, 0.7));
    }

    /// Border and tick marks; tick labels on the sides that want them.
    pub(super) fn draw_border(&self, drawing: &mut Drawing, x_labels: bool, y_labels: bool) {
        let line = Stroke::solid(Colour::INK, 0.8);
        drawing.rect(self.area, None, Some(line));
        let mut marks = Vec::new();
        let Rect { left, bottom, .. } = self.area;
        for (value, label) in &self.x_ticks.major {
            let Some(x) = self.x.place(*value) else {
                continue;
            };
            marks.push(vec![[x, bottom], [x, bottom + TICK_LENGTH]]);
            if x_labels {
                let y = bottom + TICK_LENGTH + TICK_PAD + CAP_HEIGHT * TICK;
                drawing.text([x, y], Anchor::Middle, TICK, Colour::INK, label);
            }
        }
        for (value, label) in &self.y_ticks.major {
            let Some(y) = self.y.place(*value) else {
                continue;
            };
            marks.push(vec![[left - TICK_LENGTH, y], [left, y]]);
            if y_labels {
                let at = [left - TICK_LENGTH - TICK_PAD, y + 0.5 * CAP_HEIGHT * TICK];
                drawing.text(at, Anchor::End, TICK, Colour::INK, label);
            }
        }
        for x in self
            .x_ticks
            .minor
            .iter()
            .filter_map(|&value| self.x.place(value))
        {
            marks.push(vec![[x, bottom], [x, bottom + MINOR_TICK_LENGTH]]);
        }
        for y in self
            .y_ticks
            .minor
            .iter()
            .filter_map(|&value| self.y.place(value))
        {
            marks.push(vec![[left - MINOR_TICK_LENGTH, y], [left, y]]);
        }
        drawing.stroke(marks, line);
        if let (true, Some(factor)) = (y_labels, &self.y_ticks.factor) {
            let at = [left, self.area.top - 0.6 * GAP];
            drawing.text(at, Anchor::Start, TICK, Colour::INK, factor);
        }
        if let (true, Some(factor)) = (x_labels, &self.x_ticks.factor) {
            let y = bottom + tick_height() + 0.5 * GAP + CAP_HEIGHT * LABEL;
            drawing.text([self.area.right, y], Anchor::End, TICK, Colour::INK, factor);
        }
    }
}

/// A note in the lower left corner.
pub(super) fn draw_note(drawing: &mut Drawing, bottom: f64, note: &str) {
    let at = [MARGIN, bottom - MARGIN];
    drawing.text(at, Anchor::Start, NOTE, Colour::FAINT_INK, note);
}
