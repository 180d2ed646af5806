//! Lines and symbols over a field: edges, grid lines, sections, blocks, supports, arrows, points.

use super::OutlineStyle;
use crate::colour::Colour;
use crate::drawing::{Contour, Drawing, Item, Shape, Stroke};
use crate::geometry::{Point, Rect};

/// Distance \[pt\] of the strokes of a hatch, and how far they reach along and across the line.
const HATCH: (f64, f64) = (6.5, 6.0);
/// Distance \[pt\] and radius \[pt\] of rollers.
const ROLLER: (f64, f64) = (11.0, 2.4);
/// Length and half-width \[pt\] of an arrow head.
const HEAD: (f64, f64) = (8.0, 3.2);

/// Half-width and height \[pt\] of the mark of a water table, and its place as a share of the line \[-\].
const MARK: (f64, f64) = (4.0, 6.5);
const MARK_AT: f64 = 0.12;

/// Length and half-width \[pt\] of the head of a small arrow.
const SMALL_HEAD: (f64, f64) = (4.5, 1.8);

/// Draws a line through `points` \[pt\] as far as it lies in `area`.
pub(crate) fn draw(drawing: &mut Drawing, area: &Rect, style: OutlineStyle, points: &[Point]) {
    let lines = || area.clip_polyline(points);
    match style {
        OutlineStyle::Edge => drawing.stroke(lines(), Stroke::solid(Colour::INK, 1.2)),
        OutlineStyle::Grid => drawing.stroke(lines(), Stroke::solid(Colour::FAINT_INK, 0.3)),
        OutlineStyle::Section => {
            // White below black stays visible on every colour.
            drawing.stroke(lines(), Stroke::solid(Colour::WHITE, 2.4));
            let dashed = Stroke::dashed(Colour::INK, 1.3, &[6.0, 3.5]);
            drawing.stroke(lines(), dashed);
        }
        OutlineStyle::Block => drawing.items.push(Item::Shape(Shape {
            contours: vec![Contour::Closed(area.clip_polygon(points))],
            fill: Some((Colour::BLOCK, 1.0)),
            stroke: Some(Stroke::solid(Colour::INK, 1.0)),
        })),
        OutlineStyle::Fixed => {
            hatch(drawing, area, points);
            drawing.stroke(lines(), Stroke::solid(Colour::INK, 1.8));
        }
        OutlineStyle::Roller => {
            rollers(drawing, area, points);
            drawing.stroke(lines(), Stroke::solid(Colour::INK, 1.2));
        }
        OutlineStyle::Arrow => {
            if let &[.., from, to] = points {
                arrow(drawing, area, from, to);
            }
        }
        OutlineStyle::Former => {
            let dashed = Stroke::dashed(Colour::FAINT_INK, 0.8, &[3.0, 2.5]);
            drawing.stroke(lines(), dashed);
        }
        OutlineStyle::Trace => {
            drawing.stroke(lines(), Stroke::solid(Colour::WHITE, 4.2));
            drawing.stroke(lines(), Stroke::solid(Colour::FAILURE, 2.2));
        }
        OutlineStyle::Water => {
            // White below blue stays visible on every colour.
            drawing.stroke(lines(), Stroke::solid(Colour::WHITE, 2.4));
            drawing.stroke(lines(), Stroke::solid(Colour::WATER, 1.1));
            water_mark(drawing, &lines());
        }
        OutlineStyle::Member => {
            drawing.stroke(lines(), Stroke::solid(Colour::INK, 3.0));
            drawing.stroke(lines(), Stroke::solid(Colour::WHITE, 1.0));
        }
        OutlineStyle::Diagram => drawing.items.push(Item::Shape(Shape {
            contours: vec![Contour::Closed(area.clip_polygon(points))],
            fill: Some((Colour::WHITE, 0.7)),
            stroke: Some(Stroke::solid(Colour::INK, 0.8)),
        })),
        OutlineStyle::Vectors => vectors(drawing, area, points),
        OutlineStyle::Point => {
            let centres = points.iter().filter(|&&point| area.contains(point));
            let radius = 3.4;
            let contours = centres.map(|&centre| Contour::Circle { centre, radius });
            drawing.items.push(Item::Shape(Shape {
                contours: contours.collect(),
                fill: Some((Colour::of_cycle(1), 1.0)),
                stroke: Some(Stroke::solid(Colour::WHITE, 0.9)),
            }));
        }
    }
}

/// Strokes on the far side of a line that is held.
fn hatch(drawing: &mut Drawing, area: &Rect, points: &[Point]) {
    let strokes = along(points, HATCH.0, |[x, y], [dx, dy]| {
        let across = [-dy, dx];
        let reach = |k: usize| HATCH.1 * (across[k] - [dx, dy][k]) * 0.75;
        vec![[x, y], [x + reach(0), y + reach(1)]]
    });
    let strokes = strokes.iter().flat_map(|line| area.clip_polyline(line));
    drawing.stroke(strokes.collect(), Stroke::solid(Colour::INK, 0.8));
}

/// Rollers along a line that may slide.
fn rollers(drawing: &mut Drawing, area: &Rect, points: &[Point]) {
    let (apart, radius) = ROLLER;
    let away = radius + 0.9;
    let centres = along(points, apart, |[x, y], [dx, dy]| {
        [x - away * dy, y + away * dx]
    });
    let contours = centres
        .into_iter()
        .filter(|&centre| area.contains(centre))
        .map(|centre| Contour::Circle { centre, radius })
        .collect();
    drawing.items.push(Item::Shape(Shape {
        contours,
        fill: Some((Colour::WHITE, 1.0)),
        stroke: Some(Stroke::solid(Colour::INK, 0.8)),
    }));
}

/// The mark of a water table: a triangle with its tip on the longest of the lines.
fn water_mark(drawing: &mut Drawing, lines: &[Vec<Point>]) {
    let length = |line: &[Point]| -> f64 {
        let parts = line.windows(2);
        parts
            .map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1]))
            .sum()
    };
    let longest = lines.iter().max_by(|a, b| length(a).total_cmp(&length(b)));
    let Some(line) = longest.filter(|line| length(line) > 0.0) else {
        return;
    };
    let mut left = MARK_AT * length(line);
    for pair in line.windows(2) {
        let span = length(pair);
        if left > span {
            left -= span;
            continue;
        }
        let t = left / span.max(f64::MIN_POSITIVE);
        let [x, y] = [0, 1].map(|k| pair[0][k] + t * (pair[1][k] - pair[0][k]));
        let (wide, high) = MARK;
        drawing.items.push(Item::Shape(Shape {
            contours: vec![Contour::Closed(vec![
                [x, y],
                [x - wide, y - high],
                [x + wide, y - high],
            ])],
            fill: Some((Colour::WATER, 1.0)),
            stroke: Some(Stroke::solid(Colour::WHITE, 0.6)),
        }));
        return;
    }
}

/// The results of `make` at equal distances along a line, given the place and the unit direction there.
fn along<T>(points: &[Point], apart: f64, make: impl Fn(Point, Point) -> T) -> Vec<T> {
    let mut made = Vec::new();
    for pair in points.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let count = (length / apart).round().max(1.0);
        if length > 0.0 && count < 1e5 {
            let direction = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
            made.extend((0..count as usize).map(|k| {
                let t = (k as f64 + 0.5) / count;
                let at = [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
                make(at, direction)
            }));
        }
    }
    made
}

fn arrow(drawing: &mut Drawing, area: &Rect, from: Point, to: Point) {
    let length = (to[0] - from[0]).hypot(to[1] - from[1]);
    if length <= 0.0 {
        return;
    }
    let [dx, dy] = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
    let back = [to[0] - HEAD.0 * dx, to[1] - HEAD.0 * dy];
    let colour = Colour::of_cycle(1);
    drawing.stroke(
        area.clip_polyline(&[from, back]),
        Stroke::solid(colour, 1.6),
    );
    let side = |sign: f64| [back[0] - sign * HEAD.1 * dy, back[1] + sign * HEAD.1 * dx];
    let head = area.clip_polygon(&[to, side(1.0), side(-1.0)]);
    drawing.fill(vec![Contour::Closed(head)], colour, 1.0);
}

/// Small arrows between pairs of points, as far as both lie in the area; heads grow with the arrows.
fn vectors(drawing: &mut Drawing, area: &Rect, points: &[Point]) {
    let (mut shafts, mut heads) = (Vec::new(), Vec::new());
    for pair in points.chunks_exact(2) {
        let (from, to) = (pair[0], pair[1]);
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        if !(length > 0.0 && area.contains(from) && area.contains(to)) {
            continue;
        }
        let [dx, dy] = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
        let (long, wide) = (
            length.min(SMALL_HEAD.0),
            SMALL_HEAD.1 * length.min(SMALL_HEAD.0) / SMALL_HEAD.0,
        );
        let back = [to[0] - long * dx, to[1] - long * dy];
        let side = |sign: f64| [back[0] - sign * wide * dy, back[1] + sign * wide * dx];
        shafts.push(vec![from, back]);
        heads.push(Contour::Closed(vec![to, side(1.0), side(-1.0)]));
    }
    if !heads.is_empty() {
        // White around black stays visible on every colour.
        drawing.stroke(shafts.clone(), Stroke::solid(Colour::WHITE, 2.0));
        drawing.items.push(Item::Shape(Shape {
            contours: heads,
            fill: Some((Colour::INK, 1.0)),
            stroke: Some(Stroke::solid(Colour::WHITE, 0.5)),
        }));
        drawing.stroke(shafts, Stroke::solid(Colour::INK, 0.8));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symbols_stand_at_equal_distances() {
        let line = [[0.0, 0.0], [30.0, 0.0], [30.0, 0.0], [30.0, 10.0]];
        let places = along(&line, 10.0, |at, _| at);
        let expected = [[5.0, 0.0], [15.0, 0.0], [25.0, 0.0], [30.0, 5.0]];
        assert_eq!(places.len(), 4);
        for (found, expected) in places.iter().zip(expected) {
            let distance = (found[0] - expected[0]).hypot(found[1] - expected[1]);
            assert!(distance < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn nothing_is_drawn_outside_the_area() {
        let area = Rect::new(0.0, 0.0, 10.0, 10.0);
        for style in [
            OutlineStyle::Fixed,
            OutlineStyle::Roller,
            OutlineStyle::Arrow,
            OutlineStyle::Point,
            OutlineStyle::Former,
            OutlineStyle::Trace,
            OutlineStyle::Water,
            OutlineStyle::Member,
            OutlineStyle::Diagram,
            OutlineStyle::Vectors,
        ] {
            let mut drawing = Drawing::new("");
            draw(&mut drawing, &area, style, &[[20.0, 20.0], [40.0, 20.0]]);
            let drawn = drawing.items.iter().any(|item| match item {
                Item::Shape(shape) => shape.contours.iter().any(|contour| match contour {
                    Contour::Open(points) | Contour::Closed(points) => !points.is_empty(),
                    Contour::Circle { .. } => true,
                }),
                Item::Text(_) | Item::Image(_) => true,
            });
            assert!(!drawn, "{style:?}");
        }
    }
}
