//! A body in space: its surface, lit, in a parallel projection, coloured by a value.
//!
//! The surface is filled into pixels with a depth for each; axes, colour bar and texts are drawn over it as in
//! every other figure.

pub(crate) mod raster;
pub(crate) mod view;

use std::path::Path;

use super::colour::{Colour, ColourMap};
use super::drawing::{Anchor, Drawing, Stroke};
use super::frame::{self, GAP, LABEL, MARGIN, TICK, TITLE};
use super::geometry::Point;
use super::{FigureError, axis};
use crate::axis::ticks;
use crate::drawing::font::{self, CAP_HEIGHT};
use crate::field::colour_bar::{ColourBar, ColourScale};
use raster::Painter;
use view::Projection;

pub use view::View;

/// Width \[pt\] of the picture, and the greatest height of the body in it.
const WIDTH: f64 = 640.0;
const MOST_HEIGHT: f64 = 430.0;
/// Room \[pt\] for the axes around the body, and to its left.
const AROUND: f64 = 42.0;
const LEFT: f64 = 62.0;
/// Between the body and its axes \[pt\].
const APART: f64 = 5.0;
const TICK_LENGTH: f64 = 4.0;
/// Axes shorter than that \[pt\] are seen from their end.
const LEAST_AXIS: f64 = 30.0;
/// Of rigid bodies so much is in sight beside the soil, as a share of its largest side.
const BESIDE: f64 = 0.12;
/// Length \[pt\] of the colour bar.
const BAR: f64 = 260.0;

/// A face of the surface: two triangles, which meet along the line between its second and its last corner.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    /// Corners in turn \[m\].
    pub corners: [[f64; 3]; 4],
    /// Out of the body, of length 1; for the light.
    pub normal: [f64; 3],
    /// Share of the surroundings that is free, which hollows have little of: from 0 to 1.
    pub open: f64,
    /// The value that colours it.
    pub value: f64,
}

/// The surface of a body in space, with axes and a colour bar.
///
/// Faces without a value (NaN or infinite) are grey. The image lies in the SVG as pixels.
#[derive(Clone, Debug, Default)]
pub struct SpacePlot {
    /// Title above the plot; may be empty.
    pub title: String,
    /// The surface.
    pub faces: Vec<Face>,
    /// Triangles of rigid bodies, which are grey and let the rest shine through.
    pub bodies: Vec<[[f64; 3]; 3]>,
    /// Where it is looked at from.
    pub view: View,
    /// Name and unit of the value, written along the colour bar.
    pub label: String,
    /// Values at the ends of the colour bar; values beyond take the colour of the end. `None`: from the data.
    pub range: Option<(f64, f64)>,
    /// Colours of the values.
    pub map: ColourMap,
}

impl SpacePlot {
    /// Lays the plot out.
    ///
    /// # Errors
    /// If a given range cannot be drawn or the image is too large for the memory.
    pub fn draw(&self) -> Result<Drawing, FigureError> {
        if let Some((from, to)) = self
            .range
            .filter(|&(a, b)| a >= b || !axis::Scale::Linear.accepts((a, b)))
        {
            return Err(FigureError::InvalidRange {
                title: self.title.clone(),
                axis: "colour bar",
                from,
                to,
            });
        }
        let values: Vec<f64> = self.faces.iter().map(|face| face.value).collect();
        let scale = ColourScale::new(self.map, self.range, &values);
        let bar = values.iter().any(|&value| axis::drawable(value));
        let bar = bar.then_some(ColourBar {
            scale,
            label: &self.label,
            upright: true,
            length: BAR,
        });
        let mut drawing = Drawing::new(&self.title);
        drawing.width = WIDTH;
        let title = font::wrap(&self.title, TITLE, WIDTH - 2.0 * MARGIN);
        drawing.centred_lines([0.5 * WIDTH, MARGIN + CAP_HEIGHT * TITLE], TITLE, &title);
        let top = MARGIN + frame::title_height(&title, TITLE);
        let beside = bar.as_ref().map_or(0.0, |bar| bar.depth() + 2.0 * GAP);
        let room = WIDTH - 2.0 * MARGIN - beside;
        let extent = self.extent();
        let Some(extent) = extent else {
            drawing.height = top + 80.0;
            let at = [0.5 * WIDTH, top + 30.0];
            drawing.text(at, Anchor::Middle, LABEL, Colour::FAINT_INK, "no data");
            return Ok(drawing);
        };
        let projection = Projection::new(
            self.view,
            extent,
            [room - LEFT - AROUND, MOST_HEIGHT],
            // Whole points, so that the image meets the pixels of the picture.
            [MARGIN + LEFT, (top + 0.5 * AROUND).ceil()],
        );
        let area = projection.area;
        let painter = Painter::new(&projection, &scale);
        drawing.image(painter.paint(&self.faces, &self.bodies)?);
        draw_axes(&mut drawing, &projection);
        let bottom = area.bottom + AROUND;
        drawing.height = bottom.max(top + bar.as_ref().map_or(0.0, |bar| bar.length)) + MARGIN;
        if let Some(bar) = bar {
            let middle = 0.5 * (top + drawing.height - MARGIN - bar.length);
            bar.draw(&mut drawing, [MARGIN + room + 2.0 * GAP, middle.max(top)]);
        }
        Ok(drawing)
    }

    /// Writes `<path>.svg` and `<path>.png`; the folder must exist.
    ///
    /// # Errors
    /// If a given range cannot be drawn, or a file cannot be written.
    pub fn write(&self, path_without_extension: &Path) -> Result<(), FigureError> {
        self.draw()?.write(path_without_extension)
    }

    /// Least and largest corner of the faces; none where nothing has a place.
    fn extent(&self) -> Option<[[f64; 3]; 2]> {
        let mut ends = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        let corners = self.faces.iter().flat_map(|face| face.corners);
        for corner in corners.filter(|corner| corner.iter().all(|&x| axis::drawable(x))) {
            for k in 0..3 {
                ends[0][k] = ends[0][k].min(corner[k]);
                ends[1][k] = ends[1][k].max(corner[k]);
            }
        }
        if ends[0][0] > ends[1][0] {
            return None;
        }
        // Of rigid bodies the part close to the soil.
        let [low, high] = ends;
        let size = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
        for corner in self.bodies.iter().flatten() {
            for k in (0..3).filter(|&k| axis::drawable(corner[k])) {
                ends[0][k] = ends[0][k].min(corner[k].max(low[k] - BESIDE * size));
                ends[1][k] = ends[1][k].max(corner[k].min(high[k] + BESIDE * size));
            }
        }
        Some(ends)
    }
}

/// An edge of the box around a body, as it is seen.
struct Edge {
    /// Its lower end \[pt\].
    start: Point,
    /// From there to its upper end \[pt\].
    along: Point,
    length: f64,
    /// Direction away from the body, of length 1.
    out: Point,
    is_upright: bool,
}

impl Edge {
    /// The edge along an axis that lies outermost: of level axes below the body, of the upright one to its left. `None` for an
    /// axis that is seen from its end.
    fn outermost(projection: &Projection, axis: usize) -> Option<Self> {
        let [low, high] = projection.extent;
        let edge = |k: usize| {
            let mut ends = [low; 2];
            for end in &mut ends {
                end[(axis + 1) % 3] = [low, high][k % 2][(axis + 1) % 3];
                end[(axis + 2) % 3] = [low, high][k / 2][(axis + 2) % 3];
            }
            ends[1][axis] = high[axis];
            ends.map(|end| projection.place(&end))
        };
        let [start, end] = edge(0);
        let along = [end[0] - start[0], end[1] - start[1]];
        let length = along[0].hypot(along[1]);
        if length < LEAST_AXIS {
            return None;
        }
        let across = [along[1] / length, -along[0] / length];
        let is_upright = along[1].abs() > 2.0 * along[0].abs();
        let sense = if is_upright {
            -across[0].signum()
        } else {
            across[1].signum()
        };
        let out = across.map(|x| sense * x);
        let far =
            |[start, end]: &[Point; 2]| (0..2).map(|k| out[k] * (start[k] + end[k])).sum::<f64>();
        let edges = [edge(0), edge(1), edge(2), edge(3)];
        let [start, _] = edges.into_iter().reduce(|best, next| {
            if far(&next) > far(&best) + 1e-6 {
                next
            } else {
                best
            }
        })?;
        Some(Self {
            start,
            along,
            length,
            out,
            is_upright,
        })
    }
}

/// An axis along each edge of the surrounding box that lies outermost, with ticks, numbers and its name.
fn draw_axes(drawing: &mut Drawing, projection: &Projection) {
    let [low, high] = projection.extent;
    for axis in 0..3 {
        let Some(edge) = Edge::outermost(projection, axis) else {
            continue;
        };
        let Edge {
            start,
            along,
            length,
            out,
            is_upright,
        } = edge;
        let place = |value: f64| -> Point {
            let share = (value - low[axis]) / (high[axis] - low[axis]);
            [0, 1].map(|k| start[k] + share * along[k] + APART * out[k])
        };
        let moved = |at: Point, by: f64| [0, 1].map(|k| at[k] + by * out[k]);
        let anchor = match out[0] {
            x if x < -0.35 => Anchor::End,
            x if x > 0.35 => Anchor::Start,
            _ => Anchor::Middle,
        };
        let count = (length / 70.0).max(2.0) as usize;
        let ticks = ticks::linear(low[axis], high[axis], count);
        let mut lines = vec![vec![place(low[axis]), place(high[axis])]];
        let mut widest = 0.0_f64;
        for (value, text) in &ticks.major {
            let at = place(*value);
            lines.push(vec![at, moved(at, TICK_LENGTH)]);
            let [x, y] = moved(at, TICK_LENGTH + 7.0);
            let below = y + 0.5 * CAP_HEIGHT * TICK;
            drawing.text([x, below], anchor, TICK, Colour::INK, text);
            widest = widest.max(font::width(text, TICK));
        }
        drawing.stroke(lines, Stroke::solid(Colour::INK, 0.8));
        let factor = ticks
            .factor
            .map_or_else(String::new, |factor| format!("{factor} "));
        let name = format!("{} [{factor}m]", ["x", "y", "z"][axis]);
        // Between two ticks, beyond their labels.
        let major = &ticks.major;
        let half = major.len() / 2;
        let middle = match (major.get(half.wrapping_sub(1)), major.get(half)) {
            (Some(one), Some(two)) => 0.5 * (one.0 + two.0),
            _ => 0.5 * (low[axis] + high[axis]),
        };
        let away = if is_upright {
            widest + 10.0
        } else {
            0.3 * widest + 16.0
        };
        let [x, y] = moved(place(middle), TICK_LENGTH + away);
        let at = [x, y + 0.5 * CAP_HEIGHT * LABEL];
        let anchor = if is_upright { Anchor::End } else { anchor };
        drawing.text(at, anchor, LABEL, Colour::INK, &name);
    }
}
