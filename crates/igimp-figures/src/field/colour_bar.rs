//! The colour scale of a field, and the bar that explains it.

use crate::axis::ticks::Ticks;
use crate::axis::{self, Axis, Scale};
use crate::colour::{Colour, ColourMap};
use crate::drawing::font::{self, CAP_HEIGHT, LINE_HEIGHT};
use crate::drawing::{Anchor, Contour, Drawing, Item, Shape, Stroke};
use crate::frame::{GAP, LABEL, TICK};
use crate::geometry::Rect;

/// Number of colours in a field: more are not distinguishable, and fewer make smaller files.
pub(crate) const LEVELS: usize = 128;
/// Width \[pt\] of the bar.
pub(crate) const THICKNESS: f64 = 15.0;

const TICK_LENGTH: f64 = 4.0;
const POINT: f64 = 11.0;

/// How values become colours.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ColourScale {
    pub(crate) map: ColourMap,
    pub(crate) range: (f64, f64),
    /// Whether some values lie below and above the range.
    pub(crate) beyond: (bool, bool),
}

impl ColourScale {
    /// A scale over the given range, or over the finite values.
    pub(crate) fn new(map: ColourMap, given: Option<(f64, f64)>, values: &[f64]) -> Self {
        let data = axis::extent(values.iter().copied());
        let range = given.unwrap_or_else(|| match (map, data) {
            (_, None) => (0.0, 1.0),
            (ColourMap::Sequential, Some((low, high))) => axis::widened(low, high),
            (ColourMap::Diverging, Some((low, high))) => {
                let reach = low.abs().max(high.abs());
                axis::widened(-reach, reach)
            }
        });
        let beyond = data.map_or((false, false), |(low, high)| {
            (low < range.0, high > range.1)
        });
        Self { map, range, beyond }
    }

    /// Level 0 to [`LEVELS`] − 1 of a value; `None` if it has no colour.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the levels before"
    )]
    pub(crate) fn level(&self, value: f64) -> Option<usize> {
        let part = (value - self.range.0) / (self.range.1 - self.range.0);
        let top = (LEVELS - 1) as f64;
        axis::drawable(value).then(|| (part * LEVELS as f64).floor().clamp(0.0, top) as usize)
    }

    /// Colour of a level.
    pub(crate) fn colour(&self, level: usize) -> Colour {
        self.map.at(level as f64 / (LEVELS - 1) as f64)
    }
}

/// A colour bar beside (`upright`) or below the plots.
pub(crate) struct ColourBar<'a> {
    pub(crate) scale: ColourScale,
    pub(crate) label: &'a str,
    pub(crate) upright: bool,
    /// Length \[pt\] including the pointed ends.
    pub(crate) length: f64,
}

impl ColourBar<'_> {
    /// The bar without its points, at the given place.
    fn body(&self, [left, top]: [f64; 2]) -> Rect {
        let low = if self.scale.beyond.0 { POINT } else { 0.0 };
        let high = if self.scale.beyond.1 { POINT } else { 0.0 };
        let length = self.length - low - high;
        if self.upright {
            Rect::new(left, top + high, THICKNESS, length)
        } else {
            Rect::new(left + low, top, length, THICKNESS)
        }
    }

    fn axis(&self, body: Rect) -> (Axis, Ticks) {
        let span = if self.upright {
            (body.bottom, body.top)
        } else {
            (body.left, body.right)
        };
        let axis = Axis {
            scale: Scale::Linear,
            range: self.scale.range,
            span,
        };
        let ticks = if self.upright {
            axis.ticks_stacked(TICK)
        } else {
            axis.ticks_beside(TICK)
        };
        (axis, ticks)
    }

    fn label_lines(&self) -> Vec<String> {
        // Beside the plots there is room above and below the bar: a title, and labels of an axis.
        let spare = if self.upright { 40.0 } else { 0.0 };
        font::wrap(self.label, LABEL, (self.length + spare).max(140.0))
    }

    /// Space \[pt\] across the bar for the bar, its ticks and its label.
    pub(crate) fn depth(&self) -> f64 {
        let (_, ticks) = self.axis(self.body([0.0, 0.0]));
        let label = self.label_lines().len() as f64 * LABEL * LINE_HEIGHT;
        THICKNESS + 2.0 * TICK_LENGTH + self.tick_depth(&ticks) + label
    }

    /// Whether the tick labels share a factor, written above an upright bar.
    pub(crate) fn has_factor(&self) -> bool {
        self.axis(self.body([0.0, 0.0])).1.factor.is_some()
    }

    fn tick_depth(&self, ticks: &Ticks) -> f64 {
        let widest = ticks
            .major
            .iter()
            .map(|(_, label)| font::width(label, TICK))
            .fold(0.0, f64::max);
        if self.upright {
            widest + GAP
        } else {
            TICK * LINE_HEIGHT + 0.5 * GAP
        }
    }

    /// Draws the bar with its upper left corner at the given place.
    pub(crate) fn draw(&self, drawing: &mut Drawing, corner: [f64; 2]) {
        let body = self.body(corner);
        let (axis, ticks) = self.axis(body);
        self.draw_colours(drawing, body);
        let line = Stroke::solid(Colour::INK, 0.8);
        let mut marks = Vec::new();
        for (value, label) in &ticks.major {
            let Some(place) = axis.place(*value) else {
                continue;
            };
            if self.upright {
                marks.push(vec![[body.right, place], [body.right + TICK_LENGTH, place]]);
                let at = [
                    body.right + 2.0 * TICK_LENGTH,
                    place + 0.5 * CAP_HEIGHT * TICK,
                ];
                drawing.text(at, Anchor::Start, TICK, Colour::INK, label);
            } else {
                marks.push(vec![
                    [place, body.bottom],
                    [place, body.bottom + TICK_LENGTH],
                ]);
                let at = [place, body.bottom + 2.0 * TICK_LENGTH + CAP_HEIGHT * TICK];
                drawing.text(at, Anchor::Middle, TICK, Colour::INK, label);
            }
        }
        drawing.stroke(marks, line);
        let far = 2.0 * TICK_LENGTH + self.tick_depth(&ticks) + CAP_HEIGHT * LABEL;
        let [x, y] = body.centre();
        if self.upright {
            drawing.upward_lines([body.right + far, y], LABEL, &self.label_lines());
        } else {
            drawing.centred_lines([x, body.bottom + far], LABEL, &self.label_lines());
        }
        if let Some(factor) = &ticks.factor {
            let (at, anchor) = if self.upright {
                ([body.left, corner[1] - 0.6 * GAP], Anchor::Start)
            } else {
                ([corner[0] + self.length, body.bottom + far], Anchor::End)
            };
            drawing.text(at, anchor, TICK, Colour::INK, factor);
        }
    }

    /// The colours from the low end to the high end, and a frame around them.
    fn draw_colours(&self, drawing: &mut Drawing, body: Rect) {
        let Rect {
            left,
            top,
            right,
            bottom,
        } = body;
        let [x, y] = body.centre();
        // Corners of the low end and of the high end, and the tips beyond them.
        let (low, low_tip, high, high_tip) = if self.upright {
            let (low, high) = (
                [[right, bottom], [left, bottom]],
                [[left, top], [right, top]],
            );
            (low, [x, bottom + POINT], high, [x, top - POINT])
        } else {
            let (low, high) = (
                [[left, bottom], [left, top]],
                [[right, top], [right, bottom]],
            );
            (low, [left - POINT, y], high, [right + POINT, y])
        };
        let ends = [
            (self.scale.beyond.0, 0, low, low_tip),
            (self.scale.beyond.1, LEVELS - 1, high, high_tip),
        ];
        let mut frame = Vec::new();
        for (pointed, level, [start, end], tip) in ends {
            frame.push(start);
            if pointed {
                frame.push(tip);
                // Reaching to the middle of the bar, whose colours come on top: no seam.
                let wedge = Contour::Closed(vec![start, tip, end, [x, y]]);
                drawing.fill(vec![wedge], self.scale.colour(level), 1.0);
            }
            frame.push(end);
        }
        for level in 0..LEVELS {
            let part = level as f64 / LEVELS as f64;
            // Each colour reaches to the high end and is covered by the next: no seams.
            let rest = if self.upright {
                Rect {
                    bottom: bottom - part * body.height(),
                    ..body
                }
            } else {
                Rect {
                    left: left + part * body.width(),
                    ..body
                }
            };
            drawing.rect(rest, Some(self.scale.colour(level)), None);
        }
        drawing.items.push(Item::Shape(Shape {
            contours: vec![Contour::Closed(frame)],
            fill: None,
            stroke: Some(Stroke::solid(Colour::INK, 0.8)),
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_fill_the_range_and_clamp_beyond() {
        let scale = ColourScale::new(ColourMap::Sequential, Some((0.0, 1.0)), &[-1.0, 0.5]);
        assert_eq!(scale.level(-1.0), Some(0));
        assert_eq!(scale.level(0.0), Some(0));
        assert_eq!(scale.level(1.0), Some(LEVELS - 1));
        assert_eq!(scale.level(f64::NAN), None);
        assert_eq!(scale.beyond, (true, false));
    }

    #[test]
    fn automatic_ranges_follow_the_data() {
        let values = [f64::NAN, -2.0, 6.0];
        assert_eq!(
            ColourScale::new(ColourMap::Sequential, None, &values).range,
            (-2.0, 6.0)
        );
        assert_eq!(
            ColourScale::new(ColourMap::Diverging, None, &values).range,
            (-6.0, 6.0)
        );
        assert_eq!(
            ColourScale::new(ColourMap::Sequential, None, &[]).range,
            (0.0, 1.0)
        );
        let (low, high) = ColourScale::new(ColourMap::Sequential, None, &[5.0, 5.0]).range;
        assert!(low < 5.0 && high > 5.0);
    }
}
