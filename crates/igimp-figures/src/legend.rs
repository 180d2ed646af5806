//! Where legends and the labels of reference lines stand, so that they cover no curve.

use super::colour::Colour;
use super::drawing::{Anchor, Contour, Drawing, Item, Shape, Stroke};
use super::frame::{GAP, TICK};
use super::geometry::{Point, Rect};
use crate::drawing::font::{self, CAP_HEIGHT, LINE_HEIGHT};
use crate::marker::Marker;

const SAMPLE_WIDTH: f64 = 26.0;
const INSET: f64 = 8.0;
const PADDING: f64 = 7.0;
const WIDEST_LABEL: f64 = 230.0;

/// The symbol before a label in a legend.
pub(super) struct Sample {
    pub(super) band: Option<(Colour, f64)>,
    pub(super) line: Option<Stroke>,
    pub(super) marker: Option<(Marker, f64, Colour)>,
}

/// The samples and labels of a plot.
#[derive(Default)]
pub(super) struct Legend {
    entries: Vec<(Sample, Vec<String>)>,
}

impl Legend {
    /// Adds an entry; an empty label adds nothing.
    pub(super) fn add(&mut self, sample: Sample, label: &str) {
        let lines = font::wrap(label, TICK, WIDEST_LABEL);
        if !lines.is_empty() {
            self.entries.push((sample, lines));
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Width and height \[pt\] of the box.
    pub(super) fn size(&self) -> (f64, f64) {
        let lines = || self.entries.iter().flat_map(|(_, lines)| lines);
        let widest = lines()
            .map(|line| font::width(line, TICK))
            .fold(0.0, f64::max);
        let rows = lines().count() as f64 * LINE_HEIGHT * TICK;
        let gaps = (self.entries.len().saturating_sub(1)) as f64 * 0.3 * TICK;
        (
            2.0 * PADDING + SAMPLE_WIDTH + GAP + widest,
            2.0 * PADDING + rows + gaps,
        )
    }

    pub(super) fn draw(&self, drawing: &mut Drawing, corner: Point) {
        let (width, height) = self.size();
        let area = Rect::new(corner[0], corner[1], width, height);
        drawing.rect(
            area,
            Some(Colour::WHITE),
            Some(Stroke::solid(Colour::GRID, 0.8)),
        );
        let left = area.left + PADDING;
        let mut top = area.top + PADDING;
        for (sample, lines) in &self.entries {
            let middle = top + 0.5 * LINE_HEIGHT * TICK;
            sample.draw(drawing, [left, middle]);
            for (row, line) in lines.iter().enumerate() {
                let y = middle + 0.5 * CAP_HEIGHT * TICK + row as f64 * LINE_HEIGHT * TICK;
                let at = [left + SAMPLE_WIDTH + GAP, y];
                drawing.text(at, Anchor::Start, TICK, Colour::INK, line);
            }
            top += (lines.len() as f64 * LINE_HEIGHT + 0.3) * TICK;
        }
    }
}

impl Sample {
    fn draw(&self, drawing: &mut Drawing, [left, middle]: Point) {
        if let Some((colour, opacity)) = self.band {
            let block = Rect::new(left, middle - 5.0, SAMPLE_WIDTH, 10.0);
            drawing.fill(vec![Contour::Closed(block.corners())], colour, opacity);
        }
        if let Some(stroke) = self.line {
            drawing.stroke(
                vec![vec![[left, middle], [left + SAMPLE_WIDTH, middle]]],
                stroke,
            );
        }
        if let Some((marker, radius, colour)) = self.marker {
            let contours = vec![marker.contour([left + 0.5 * SAMPLE_WIDTH, middle], radius)];
            drawing.items.push(Item::Shape(Shape {
                contours,
                fill: Some((colour, 1.0)),
                stroke: Some(Stroke::solid(Colour::WHITE, 0.5)),
            }));
        }
    }
}

/// Which places of the plot area are taken.
#[derive(Default)]
pub(super) struct Occupancy {
    /// Points on curves, markers and labels.
    taken: Vec<Point>,
    /// Points on the edges of bands: covered only if there is no better place.
    shaded: Vec<Point>,
}

impl Occupancy {
    pub(super) fn take_point(&mut self, point: Point) {
        self.taken.push(point);
    }

    pub(super) fn take_line(&mut self, points: &[Point]) {
        sample_line(points, &mut self.taken);
    }

    pub(super) fn shade_line(&mut self, points: &[Point]) {
        sample_line(points, &mut self.shaded);
    }

    pub(super) fn take_rect(&mut self, rect: Rect) {
        let mut y = rect.top;
        while y <= rect.bottom {
            sample_line(&[[rect.left, y], [rect.right, y]], &mut self.taken);
            y += 4.0;
        }
    }

    /// Points covered by a rectangle: on curves, and on bands.
    fn covered(&self, rect: Rect) -> (usize, usize) {
        let count = |points: &[Point]| points.iter().filter(|&&p| rect.contains(p)).count();
        (count(&self.taken), count(&self.shaded))
    }

    /// The first of the candidates that covers least.
    pub(super) fn freest(&self, candidates: impl IntoIterator<Item = Rect>) -> Option<Rect> {
        candidates
            .into_iter()
            .min_by_key(|&rect| self.covered(rect))
    }

    /// Upper left corner for a box of the given size inside `area`, or `None` if it would cover a
    /// curve wherever it stood.
    pub(super) fn place_inside(&self, area: Rect, width: f64, height: f64) -> Option<Point> {
        let room = area.grown(-INSET);
        let (right, bottom) = (room.right - width, room.bottom - height);
        if right < room.left || bottom < room.top {
            return None;
        }
        let [x, y] = area.centre();
        let (middle_x, middle_y) = (x - 0.5 * width, y - 0.5 * height);
        let corners = [
            [right, room.top],
            [room.left, room.top],
            [right, bottom],
            [room.left, bottom],
            [right, middle_y],
            [room.left, middle_y],
            [middle_x, bottom],
            [middle_x, room.top],
        ];
        let boxes = corners.map(|[left, top]| Rect::new(left, top, width, height));
        let best = self.freest(boxes)?;
        (self.covered(best.grown(5.0)).0 == 0).then_some([best.left, best.top])
    }
}

/// Points no further than 3 pt apart along a polyline.
fn sample_line(points: &[Point], into: &mut Vec<Point>) {
    for pair in points.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let mut along = 0.0;
        while along < length {
            into.push(std::array::from_fn(|k| {
                a[k] + along / length * (b[k] - a[k])
            }));
            along += 3.0;
        }
        into.push(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: Rect = Rect {
        left: 0.0,
        top: 0.0,
        right: 400.0,
        bottom: 300.0,
    };

    #[test]
    fn the_legend_avoids_the_curve() {
        let mut occupancy = Occupancy::default();
        occupancy.take_line(&[[0.0, 300.0], [400.0, 0.0]]);
        let corner = occupancy.place_inside(AREA, 100.0, 60.0);
        assert_eq!(corner, Some([INSET, INSET]));
    }

    #[test]
    fn a_full_plot_has_no_place_inside() {
        let mut occupancy = Occupancy::default();
        occupancy.take_rect(AREA);
        assert_eq!(occupancy.place_inside(AREA, 100.0, 60.0), None);
        assert_eq!(Occupancy::default().place_inside(AREA, 500.0, 60.0), None);
    }
}
