//! Drawing of a [`CurvePlot`]: bands, reference lines, series, legend, in this order.

use super::ends::{End, draw_ends};
use super::frame::{
    HEIGHT, WIDTH, frame_of, hidden_points, shows, title_lines, x_label_lines, y_label_lines,
};
use super::{CurvePlot, LineStyle, ReferenceLine, ReferenceValue, Series, SeriesLabels};
use crate::FigureError;
use crate::axis::{Axis, Scale, ticks};
use crate::colour::Colour;
use crate::drawing::font::{self, CAP_HEIGHT};
use crate::drawing::{Anchor, Contour, Drawing, Item, Shape, Stroke, Text};
use crate::frame::{self, Frame, GAP, LABEL, MARGIN, TICK, TITLE};
use crate::geometry::{Point, Rect};
use crate::legend::{Legend, Occupancy, Sample};
use crate::marker::Marker;

const BAND_OPACITY: f64 = 0.35;

/// Lays the whole plot out.
pub(crate) fn draw(plot: &CurvePlot) -> Result<Drawing, FigureError> {
    let frame = frame_of(plot)?;
    let mut drawing = Drawing::new(&plot.title);
    (drawing.width, drawing.height) = (WIDTH, HEIGHT);
    let mut sheet = Sheet {
        plot,
        frame,
        drawing,
        occupancy: Occupancy::default(),
    };
    sheet.draw_texts();
    sheet.frame.draw_grid(&mut sheet.drawing);
    sheet.draw_bands();
    let lines = sheet.draw_reference_lines();
    // The border comes before the curves: it must not cut markers at the edge.
    sheet.frame.draw_border(&mut sheet.drawing, true, true);
    for (series, look) in plot.series.iter().zip(looks(plot)) {
        sheet.draw_series(series, &look);
    }
    for (line, ends) in lines {
        sheet.label_line(line, ends);
    }
    sheet.place_legend();
    Ok(sheet.drawing)
}

/// How one series looks.
struct Look {
    colour: Colour,
    stroke: Option<Stroke>,
    marker: Option<(Marker, f64)>,
}

fn looks(plot: &CurvePlot) -> Vec<Look> {
    let mut automatic = 0;
    let mut look = |(index, series): (usize, &Series)| {
        let colour = series.colour.unwrap_or_else(|| {
            automatic += 1;
            Colour::of_cycle(automatic - 1)
        });
        let stroke = series.style.line().map(|line| {
            let dash: &[f64] = match line {
                LineStyle::Solid => &[],
                LineStyle::Dashed => &[6.0, 3.5],
                LineStyle::Dotted => &[1.6, 2.6],
            };
            Stroke {
                colour,
                width: 1.7,
                dash,
            }
        });
        // Crowds of points want smaller markers.
        let radius = match series.points.len() {
            0..=60 => 3.6,
            61..=300 => 2.8,
            _ => 2.0,
        };
        let marker = series
            .style
            .has_markers()
            .then(|| (Marker::of_cycle(index), radius));
        Look {
            colour,
            stroke,
            marker,
        }
    };
    plot.series.iter().enumerate().map(&mut look).collect()
}

/// A plot while it is drawn.
struct Sheet<'a> {
    plot: &'a CurvePlot,
    frame: Frame,
    drawing: Drawing,
    occupancy: Occupancy,
}

impl<'a> Sheet<'a> {
    /// Title, axis labels and the notes.
    fn draw_texts(&mut self) {
        let area = self.frame.area;
        let [x, y] = area.centre();
        let first = MARGIN + CAP_HEIGHT * TITLE;
        self.drawing
            .centred_lines([x, first], TITLE, &title_lines(self.plot));
        let first = area.bottom + frame::tick_height() + 0.5 * GAP + CAP_HEIGHT * LABEL;
        self.drawing
            .centred_lines([x, first], LABEL, &x_label_lines(self.plot));
        let first = MARGIN + CAP_HEIGHT * LABEL;
        self.drawing
            .upward_lines([first, y], LABEL, &y_label_lines(self.plot));
        let hidden = hidden_points(self.plot);
        if hidden > 0 {
            let count = ticks::grouped(hidden);
            let note =
                format!("points not shown (not a number, or not positive on a log axis): {count}");
            frame::draw_note(&mut self.drawing, HEIGHT, &note);
        }
        let bands = self.plot.bands.iter().flat_map(|band| &band.upper);
        let mut points = self
            .plot
            .series
            .iter()
            .flat_map(|series| &series.points)
            .chain(bands);
        if !points.any(|point| shows(self.plot, point)) {
            self.drawing
                .text([x, y], Anchor::Middle, LABEL, Colour::FAINT_INK, "no data");
        }
    }

    /// The runs of points that the axes can show.
    fn runs(&self, points: &[Point]) -> Vec<Vec<Point>> {
        let mut runs = vec![Vec::new()];
        for &[x, y] in points {
            let placed = self.frame.x.place(x).zip(self.frame.y.place(y));
            match (placed, runs.last_mut()) {
                (Some((x, y)), Some(run)) => run.push([x, y]),
                _ => runs.push(Vec::new()),
            }
        }
        runs.retain(|run| !run.is_empty());
        runs
    }

    /// The points of an edge, raised to the end of a logarithmic axis where they are not positive.
    fn above_floor(&self, edge: &[Point]) -> Vec<Point> {
        let Axis { scale, range, .. } = self.frame.y;
        let floor = range.0.min(range.1);
        let raise = |y: f64| {
            if scale == Scale::Log && y <= 0.0 {
                floor
            } else {
                y
            }
        };
        edge.iter().map(|&[x, y]| [x, raise(y)]).collect()
    }

    fn draw_bands(&mut self) {
        for (index, band) in self.plot.bands.iter().enumerate() {
            let lower = self.runs(&self.above_floor(&band.lower)).concat();
            let upper = self.runs(&self.above_floor(&band.upper)).concat();
            self.occupancy.shade_line(&lower);
            self.occupancy.shade_line(&upper);
            let outline: Vec<Point> = lower.into_iter().chain(upper.into_iter().rev()).collect();
            let visible = self.frame.area.clip_polygon(&outline);
            let colour = Colour::of_band(index);
            self.drawing
                .fill(vec![Contour::Closed(visible)], colour, BAND_OPACITY);
        }
    }

    /// Draws the reference lines that lie inside; returns them with their ends.
    fn draw_reference_lines(&mut self) -> Vec<(&'a ReferenceLine, [Point; 2])> {
        let area = self.frame.area;
        let mut drawn = Vec::new();
        for line in &self.plot.lines {
            let ends = match line.at {
                ReferenceValue::X(x) => self
                    .frame
                    .x
                    .place(x)
                    .map(|x| [[x, area.bottom], [x, area.top]]),
                ReferenceValue::Y(y) => self
                    .frame
                    .y
                    .place(y)
                    .map(|y| [[area.left, y], [area.right, y]]),
            };
            let Some(ends) = ends.filter(|ends| area.contains(ends[0])) else {
                continue;
            };
            let stroke = Stroke {
                colour: Colour::FAINT_INK,
                width: 1.1,
                dash: &[5.0, 3.0],
            };
            self.drawing.stroke(vec![ends.to_vec()], stroke);
            self.occupancy.take_line(&ends);
            drawn.push((line, ends));
        }
        drawn
    }

    fn draw_series(&mut self, series: &Series, look: &Look) {
        let runs = self.runs(&series.points);
        if let Some(stroke) = look.stroke {
            let pieces: Vec<_> = runs
                .iter()
                .flat_map(|run| self.frame.area.clip_polyline(run))
                .collect();
            for piece in &pieces {
                self.occupancy.take_line(piece);
            }
            self.drawing.stroke(pieces, stroke);
        }
        // One point alone would be no line at all.
        let single = (runs.concat().len() == 1).then_some((Marker::Circle, 2.0));
        let Some((marker, radius)) = look.marker.or(single) else {
            return;
        };
        let room = self.frame.area.grown(0.5);
        let centres: Vec<Point> = runs
            .concat()
            .into_iter()
            .filter(|&p| room.contains(p))
            .collect();
        let contours = centres
            .iter()
            .map(|&centre| marker.contour(centre, radius))
            .collect();
        for centre in centres {
            self.occupancy.take_point(centre);
        }
        self.drawing.items.push(Item::Shape(Shape {
            contours,
            fill: Some((look.colour, 1.0)),
            stroke: Some(Stroke::solid(Colour::WHITE, 0.5)),
        }));
    }

    /// Writes the label of a reference line along it, where it covers least.
    fn label_line(&mut self, line: &ReferenceLine, [start, end]: [Point; 2]) {
        if line.label.is_empty() {
            return;
        }
        let (length, height) = (font::width(&line.label, TICK), TICK);
        let upward = matches!(line.at, ReferenceValue::X(_));
        let area = self.frame.area;
        let candidates = [1.0, 0.0, 0.5].into_iter().flat_map(|along| {
            [true, false].map(|before| {
                if upward {
                    let top = area.top + GAP + (1.0 - along) * (area.height() - length - 2.0 * GAP);
                    let left = if before {
                        start[0] - height - 3.0
                    } else {
                        start[0] + 3.0
                    };
                    Rect::new(left, top, height, length)
                } else {
                    let left = area.left + GAP + along * (area.width() - length - 2.0 * GAP);
                    let top = if before {
                        end[1] - height - 3.0
                    } else {
                        end[1] + 3.0
                    };
                    Rect::new(left, top, length, height)
                }
            })
        });
        let inside = candidates.filter(|rect| {
            area.contains([rect.left, rect.top]) && area.contains([rect.right, rect.bottom])
        });
        let Some(place) = self.occupancy.freest(inside) else {
            return;
        };
        // Where no place is free, the label stays legible on a pale ground.
        let ground = vec![Contour::Closed(place.corners())];
        self.drawing.fill(ground, Colour::WHITE, 0.75);
        self.occupancy.take_rect(place);
        let descent = 0.2 * TICK;
        let at = if upward {
            [place.right - descent, place.bottom]
        } else {
            [place.left, place.bottom - descent]
        };
        let content = line.label.clone();
        let (anchor, colour) = (Anchor::Start, Colour::FAINT_INK);
        self.drawing.push_text(Text {
            at,
            content,
            size: TICK,
            anchor,
            upward,
            colour,
        });
    }

    /// Writes the labels of series at their ends, to the right of the plot.
    fn label_ends(&mut self) {
        let ends = self.plot.series.iter().zip(looks(self.plot));
        let ends = ends.filter_map(|(series, look)| {
            let last = self.runs(&series.points).concat().pop()?;
            (!series.label.is_empty()).then(|| End {
                at: last,
                label: series.label.clone(),
                colour: look.colour,
            })
        });
        let ends = ends.collect();
        draw_ends(&mut self.drawing, self.frame.area, ends);
    }

    /// Draws the legend inside where there is room, at the right of the plot otherwise.
    fn place_legend(&mut self) {
        let at_curves = self.plot.labels == SeriesLabels::AtCurves;
        if at_curves {
            self.label_ends();
        }
        let mut legend = Legend::default();
        let in_legend = if at_curves {
            &[][..]
        } else {
            &self.plot.series
        };
        for (series, look) in in_legend.iter().zip(looks(self.plot)) {
            let marker = look
                .marker
                .map(|(marker, radius)| (marker, radius.max(2.8), look.colour));
            legend.add(
                Sample {
                    band: None,
                    line: look.stroke,
                    marker,
                },
                &series.label,
            );
        }
        for (index, band) in self.plot.bands.iter().enumerate() {
            let shade = Some((Colour::of_band(index), BAND_OPACITY));
            legend.add(
                Sample {
                    band: shade,
                    line: None,
                    marker: None,
                },
                &band.label,
            );
        }
        if legend.is_empty() {
            return;
        }
        let area = self.frame.area;
        let (width, height) = legend.size();
        let corner = self
            .occupancy
            .place_inside(area, width, height)
            .unwrap_or_else(|| {
                self.drawing.width += width;
                self.drawing.height = self.drawing.height.max(area.top + height + MARGIN);
                [area.right + GAP, area.top]
            });
        legend.draw(&mut self.drawing, corner);
    }
}
