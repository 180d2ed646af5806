//! The filled domains of a field and the lines over them.

use super::colour_bar::{ColourScale, LEVELS};
use super::{FieldPlot, OutlineStyle, Polygon, outline};
use crate::axis;
use crate::axis::ticks::grouped;
use crate::colour::Colour;
use crate::drawing::{Anchor, Contour, Drawing, font};
use crate::frame::{Frame, TICK};
use crate::geometry::{Point, Rect};
use crate::legend::Occupancy;

/// By how much \[pt\] domains are drawn larger to every side, to hide seams between neighbours.
const OVERLAP: f64 = 0.3;

/// How many domains have nothing to show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Tally {
    pub(crate) domains: usize,
    pub(crate) without_value: usize,
    pub(crate) without_place: usize,
}

impl Tally {
    pub(crate) fn of(plot: &FieldPlot) -> Self {
        let placed = |polygon: &&Polygon| has_place(polygon);
        Self {
            domains: plot.domains.len(),
            without_value: plot
                .values
                .iter()
                .filter(|&&value| !axis::drawable(value))
                .count(),
            without_place: plot.domains.len() - plot.domains.iter().filter(placed).count(),
        }
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            domains: self.domains + other.domains,
            without_value: self.without_value + other.without_value,
            without_place: self.without_place + other.without_place,
        }
    }

    /// A note about missing domains.
    pub(crate) fn note(&self) -> Option<String> {
        let part = |count: usize, reason: &str| {
            let (count, all) = (grouped(count), grouped(self.domains));
            format!("{reason}: {count} of {all} domains")
        };
        let value = (self.without_value > 0).then(|| part(self.without_value, "no value (grey)"));
        let place =
            (self.without_place > 0).then(|| part(self.without_place, "no place (not drawn)"));
        let parts: Vec<String> = value.into_iter().chain(place).collect();
        (!parts.is_empty()).then(|| parts.join("; "))
    }
}

/// Whether a polygon has an inside and drawable corners.
pub(crate) fn has_place(polygon: &[[f64; 2]]) -> bool {
    polygon.len() > 2 && polygon.iter().flatten().all(|&c| axis::drawable(c))
}

/// The contents of one plot area.
pub(crate) struct Layer<'a> {
    pub(crate) frame: &'a Frame,
    pub(crate) plot: &'a FieldPlot,
}

impl Layer<'_> {
    pub(crate) fn draw(&self, drawing: &mut Drawing, scale: &ColourScale) {
        // One shape per colour keeps the files small; grey goes first.
        let mut shapes: Vec<Vec<Contour>> = Vec::new();
        shapes.resize_with(LEVELS + 1, Vec::new);
        let kinds = !self.plot.key.is_empty();
        for (polygon, &value) in self.plot.domains.iter().zip(&self.plot.values) {
            if has_place(polygon) {
                let level = if kinds {
                    (value >= 0.0).then_some(value as usize % LEVELS)
                } else {
                    scale.level(value)
                };
                let place = level.map_or(0, |level| level + 1);
                shapes[place].extend(self.contour(polygon));
            }
        }
        for (place, contours) in shapes
            .into_iter()
            .enumerate()
            .filter(|(_, c)| !c.is_empty())
        {
            let colour = match place.checked_sub(1) {
                None => Colour::NO_VALUE,
                Some(level) if kinds => Colour::of_kind(level),
                Some(level) => scale.colour(level),
            };
            drawing.fill(contours, colour, 1.0);
        }
        for outline in &self.plot.outlines {
            let points = self.places(&outline.points);
            outline::draw(drawing, &self.frame.area, outline.style, &points);
        }
        self.draw_labels(drawing);
    }

    /// The visible part of a domain, a little enlarged.
    fn contour(&self, polygon: &[[f64; 2]]) -> Option<Contour> {
        let mut points = self.places(polygon);
        // All the same way round, or overlapping domains in one shape would cancel.
        if signed_area(&points) < 0.0 {
            points.reverse();
        }
        let visible = self.frame.area.clip_polygon(&enlarged(&points));
        (visible.len() > 2).then_some(Contour::Closed(visible))
    }

    fn places(&self, points: &[[f64; 2]]) -> Vec<Point> {
        let place = |&[x, y]: &[f64; 2]| Some([self.frame.x.place(x)?, self.frame.y.place(y)?]);
        points.iter().filter_map(place).collect()
    }

    /// Labels beside their points, on pale grounds, where they cover fewest lines.
    fn draw_labels(&self, drawing: &mut Drawing) {
        let area = self.frame.area;
        let mut occupancy = Occupancy::default();
        let lines = self.plot.outlines.iter();
        for outline in lines.filter(|outline| outline.style != OutlineStyle::Grid) {
            occupancy.take_line(&self.places(&outline.points));
        }
        for (at, label) in &self.plot.labels {
            let Some(&[x, y]) = self.places(&[*at]).first() else {
                continue;
            };
            let (width, height) = (font::width(label, TICK) + 4.0, TICK + 2.0);
            let candidates = [[1.0, -1.0], [-1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|side| {
                let [left, top] = [
                    x + 4.0 * side[0] + 0.5 * width * (side[0] - 1.0),
                    y + 4.0 * side[1] + 0.5 * height * (side[1] - 1.0),
                ];
                Rect::new(left, top, width, height)
            });
            let inside = candidates.into_iter().filter(|place| {
                area.contains([place.left, place.top]) && area.contains([place.right, place.bottom])
            });
            let Some(place) = occupancy.freest(inside) else {
                continue;
            };
            occupancy.take_rect(place);
            drawing.fill(vec![Contour::Closed(place.corners())], Colour::WHITE, 0.7);
            let baseline = [place.left + 2.0, place.bottom - 0.25 * TICK];
            drawing.text(baseline, Anchor::Start, TICK, Colour::INK, label);
        }
    }
}

/// A polygon whose sides are moved outwards by [`OVERLAP`]; sharp corners by three times that at most.
fn enlarged(points: &[Point]) -> Vec<Point> {
    let count = points.len();
    // Outwards, seen along a side; no side, no direction.
    let outwards = |k: usize| {
        let (a, b) = (points[k % count], points[(k + 1) % count]);
        let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
        let length = dx.hypot(dy);
        (length > 0.0).then(|| [dy / length, -dx / length])
    };
    (0..count)
        .map(|k| {
            let before = (1..count).find_map(|back| outwards(k + count - back));
            let after = (0..count).find_map(|on| outwards(k + on));
            let (Some(m), Some(n)) = (before, after) else {
                return points[k];
            };
            let share = OVERLAP / (1.0 + m[0] * n[0] + m[1] * n[1]).max(0.22);
            [0, 1].map(|axis| points[k][axis] + share * (m[axis] + n[axis]))
        })
        .collect()
}

/// Area \[pt²\] of a polygon, positive for one way round and negative for the other.
fn signed_area(points: &[Point]) -> f64 {
    let following = points.iter().cycle().skip(1);
    points
        .iter()
        .zip(following)
        .map(|(a, b)| 0.5 * (a[0] * b[1] - b[0] * a[1]))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: neighbours overlap along every side, however thin and slanted they are.
    #[test]
    fn sides_move_outwards() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        let grown = enlarged(&square);
        assert!((signed_area(&grown).abs() - 2.6 * 2.6).abs() < 1e-12);
        let slanted = [[0.0, 0.0], [10.0, 10.0], [10.0, 11.0], [0.0, 1.0]];
        for (k, corner) in enlarged(&slanted).iter().enumerate() {
            // How far the corner lies from the line halfway between the long sides.
            let across = (corner[1] - corner[0] - 0.5) / 2.0_f64.sqrt();
            let half = 0.5 / 2.0_f64.sqrt() + OVERLAP;
            let side = if k < 2 { -half } else { half };
            assert!((across - side).abs() < 1e-9, "{k}: {across} for {side}");
        }
        assert_eq!(enlarged(&[[1.0, 1.0]; 4]), [[1.0, 1.0]; 4]);
    }

    #[test]
    fn missing_values_and_places_are_counted() {
        let square = |x: f64| vec![[x, 0.0], [x + 1.0, 0.0], [x + 1.0, 1.0], [x, 1.0]];
        let plot = FieldPlot {
            domains: vec![square(0.0), square(1.0), square(f64::NAN), Vec::new()],
            values: vec![1.0, f64::NAN, 2.0, 3.0],
            ..FieldPlot::default()
        };
        let tally = Tally::of(&plot);
        assert_eq!(
            tally,
            Tally {
                domains: 4,
                without_value: 1,
                without_place: 2
            }
        );
        assert_eq!(
            tally.note().unwrap(),
            "no value (grey): 1 of 4 domains; no place (not drawn): 2 of 4 domains"
        );
        assert_eq!(Tally::default().note(), None);
    }

    #[test]
    fn area_tells_the_way_round() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        assert!((signed_area(&square) - 4.0).abs() < 1e-12);
        let mut reversed = square;
        reversed.reverse();
        assert!((signed_area(&reversed) + 4.0).abs() < 1e-12);
    }
}
