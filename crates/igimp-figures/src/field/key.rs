//! The key below a field whose values stand for kinds of things: colours and symbols with names.

use super::{KeyEntry, KeySample, outline};
use crate::colour::Colour;
use crate::drawing::font::{self, CAP_HEIGHT, LINE_HEIGHT};
use crate::drawing::{Anchor, Drawing, Stroke};
use crate::frame::{GAP, TICK};
use crate::geometry::{Point, Rect};

const SAMPLE: [f64; 2] = [24.0, 11.0];
const ROW: f64 = 1.3 * TICK * LINE_HEIGHT;

/// Entries side by side, in as many rows as they need.
pub(crate) struct Key<'a> {
    /// Entries of a row, with their distance \[pt\] from its start.
    rows: Vec<Vec<(f64, &'a KeyEntry)>>,
}

impl<'a> Key<'a> {
    /// Lays entries out within a width \[pt\].
    pub(crate) fn new(entries: &'a [KeyEntry], width: f64) -> Self {
        let mut rows: Vec<Vec<_>> = Vec::new();
        let mut next = f64::INFINITY;
        for entry in entries {
            let length = SAMPLE[0] + 0.75 * GAP + font::width(&entry.label, TICK);
            match rows.last_mut() {
                Some(row) if next + length <= width => row.push((next, entry)),
                _ => {
                    rows.push(vec![(0.0, entry)]);
                    next = 0.0;
                }
            }
            next += length + 2.25 * GAP;
        }
        Self { rows }
    }

    /// Height \[pt\].
    pub(crate) fn height(&self) -> f64 {
        self.rows.len() as f64 * ROW
    }

    /// Draws the key with its upper left corner at `corner`.
    pub(crate) fn draw(&self, drawing: &mut Drawing, corner: Point) {
        for (number, row) in self.rows.iter().enumerate() {
            let middle = corner[1] + (number as f64 + 0.5) * ROW;
            for (along, entry) in row {
                let left = corner[0] + along;
                draw_sample(drawing, entry.sample, [left, middle]);
                let x = left + SAMPLE[0] + 0.75 * GAP;
                let y = middle + 0.5 * CAP_HEIGHT * TICK;
                drawing.text([x, y], Anchor::Start, TICK, Colour::INK, &entry.label);
            }
        }
    }
}

fn draw_sample(drawing: &mut Drawing, sample: KeySample, [left, middle]: Point) {
    let block = Rect::new(left, middle - 0.5 * SAMPLE[1], SAMPLE[0], SAMPLE[1]);
    match sample {
        KeySample::Value(index) => {
            let edge = Stroke::solid(Colour::INK, 0.6);
            drawing.rect(block, Some(Colour::of_kind(index)), Some(edge));
        }
        KeySample::Outline(style) => {
            let line = match style {
                crate::OutlineStyle::Point => vec![block.centre()],
                crate::OutlineStyle::Block => block.corners(),
                crate::OutlineStyle::Fixed | crate::OutlineStyle::Roller => {
                    vec![[left, middle - 2.5], [block.right, middle - 2.5]]
                }
                _ => vec![[left, middle], [block.right, middle]],
            };
            outline::draw(drawing, &block.grown(2.0), style, &line);
        }
    }
}
