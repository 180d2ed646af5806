//! Drawing of a [`FieldPlot`] and of a panel of them: shared axes, one colour bar.

use super::FieldPlot;
use super::colour_bar::ColourScale;
use super::domains::{Layer, Tally, has_place};
use super::key::Key;
use super::layout::Layout;
use crate::FigureError;
use crate::axis::{self, Scale};
use crate::colour::Colour;
use crate::drawing::font::{self, CAP_HEIGHT, LINE_HEIGHT};
use crate::drawing::{Anchor, Drawing};
use crate::field::Sheet;
use crate::frame::{self, GAP, LABEL, MARGIN, NOTE, TITLE};

/// Plots lower than this \[pt\] have their colour bar below.
const LEAST_BAR: f64 = 150.0;

/// Lays the whole picture out.
pub(crate) fn draw(sheet: &Sheet<'_>) -> Result<Drawing, FigureError> {
    for plot in sheet.plots {
        check(plot)?;
    }
    let first = &sheet.plots[0];
    let values: Vec<f64> = sheet
        .plots
        .iter()
        .flat_map(|plot| &plot.values)
        .copied()
        .collect();
    let given = union(sheet.plots.iter().map(|plot| plot.range));
    let scale = ColourScale::new(first.map, given, &values);
    let drawable = values.iter().any(|&value| axis::drawable(value));
    let bar = (drawable && first.key.is_empty()).then_some(scale);
    let tally = sheet
        .plots
        .iter()
        .map(Tally::of)
        .fold(Tally::default(), Tally::plus);

    let window = [window(sheet.plots, 0), window(sheet.plots, 1)];
    let mut layout = Layout::fit(sheet, window, bar, true);
    if bar.is_some() && layout.rows_height() < LEAST_BAR {
        layout = Layout::fit(sheet, window, bar, false);
    }
    let mut drawing = Drawing::new(sheet.title);
    draw_texts(&layout, &mut drawing, &tally);
    for index in 0..sheet.plots.len() {
        draw_plot(sheet, &layout, &mut drawing, index, &scale);
    }
    draw_bar(&layout, &mut drawing);
    Ok(drawing)
}

fn check(plot: &FieldPlot) -> Result<(), FigureError> {
    let title = plot.title.clone();
    let (domains, values) = (plot.domains.len(), plot.values.len());
    if domains != values {
        return Err(FigureError::LengthMismatch {
            title,
            domains,
            values,
        });
    }
    let ranges = [
        ("x axis", plot.x_range),
        ("y axis", plot.y_range),
        ("colour bar", plot.range),
    ];
    for (axis, range) in ranges {
        if let Some((from, to)) = range.filter(|&(a, b)| a >= b || !Scale::Linear.accepts((a, b))) {
            return Err(FigureError::InvalidRange {
                title,
                axis,
                from,
                to,
            });
        }
    }
    Ok(())
}

/// The least range that holds all the given ones.
fn union(ranges: impl Iterator<Item = Option<(f64, f64)>>) -> Option<(f64, f64)> {
    axis::extent(ranges.flatten().flat_map(|(low, high)| [low, high]))
}

/// The range of the plots along an axis: the given one, or that of all data with a margin.
fn window(plots: &[FieldPlot], axis: usize) -> (f64, f64) {
    let shown = plots.iter().map(|plot| {
        let given = if axis == 0 {
            plot.x_range
        } else {
            plot.y_range
        };
        given.or_else(|| {
            let lines = plot.outlines.iter().flat_map(|outline| &outline.points);
            let points = plot.domains.iter().flatten().chain(lines);
            let (low, high) = axis::extent(points.map(|point| point[axis]))?;
            let (low, high) = axis::widened(low, high);
            let air = 0.02 * (high - low);
            Some((low - air, high + air))
        })
    });
    union(shown).unwrap_or((0.0, 1.0))
}

/// Title, axis labels and notes; fixes the size of the picture.
fn draw_texts(layout: &Layout<'_>, drawing: &mut Drawing, tally: &Tally) {
    let areas = layout.all_areas();
    let [x, y] = areas.centre();
    drawing.width = layout.width();
    let title = layout.title_lines();
    let widest = title
        .iter()
        .map(|line| font::width(line, TITLE))
        .fold(0.0, f64::max);
    let half = 0.5 * widest + MARGIN;
    let fits = (half..=drawing.width - half).contains(&x);
    let title_x = if fits { x } else { 0.5 * drawing.width };
    drawing.centred_lines([title_x, MARGIN + CAP_HEIGHT * TITLE], TITLE, &title);

    let label = layout.y_label_lines();
    let label_x = areas.left
        - frame::tick_width(&layout.y_ticks)
        - 0.5 * GAP
        - frame::lines_height(&label, LABEL)
        + CAP_HEIGHT * LABEL;
    drawing.upward_lines([label_x, y], LABEL, &label);
    let label = layout.x_label_lines();
    let below = layout.below_axis();
    drawing.centred_lines([x, below + CAP_HEIGHT * LABEL], LABEL, &label);
    let mut bottom = below + frame::lines_height(&label, LABEL);
    if let Some(bar) = layout.bar.as_ref().filter(|bar| !bar.upright) {
        bottom = layout.bar_top() + bar.depth();
    }
    let key = Key::new(&layout.first().key, areas.width());
    if key.height() > 0.0 {
        key.draw(drawing, [areas.left, bottom + 0.5 * GAP]);
        bottom += 0.5 * GAP + key.height();
    }
    drawing.height = bottom + MARGIN - 2.0;
    if let Some(note) = tally.note() {
        drawing.height += NOTE * LINE_HEIGHT + 0.5 * GAP;
        frame::draw_note(drawing, drawing.height, &note);
    }
}

fn draw_plot(
    sheet: &Sheet<'_>,
    layout: &Layout<'_>,
    drawing: &mut Drawing,
    index: usize,
    scale: &ColourScale,
) {
    let plot = &sheet.plots[index];
    let frame = &layout.frame_of(index);
    Layer { frame, plot }.draw(drawing, scale);
    let lowest = index + sheet.columns >= sheet.plots.len();
    let leftmost = index.is_multiple_of(sheet.columns);
    frame.draw_border(drawing, lowest, leftmost);
    let centre = frame.area.centre();
    if sheet.panel_titles {
        let title = font::wrap(&plot.title, LABEL, frame.area.width());
        let first = frame.area.top - frame::title_height(&title, LABEL) + CAP_HEIGHT * LABEL;
        drawing.centred_lines([centre[0], first], LABEL, &title);
    }
    if !plot.domains.iter().any(|polygon| has_place(polygon)) {
        drawing.text(centre, Anchor::Middle, LABEL, Colour::FAINT_INK, "no data");
    }
}

fn draw_bar(layout: &Layout<'_>, drawing: &mut Drawing) {
    let Some(bar) = &layout.bar else { return };
    let areas = layout.all_areas();
    let [x, y] = areas.centre();
    let corner = if bar.upright {
        [areas.right + 2.0 * GAP, y - 0.5 * bar.length]
    } else {
        [x - 0.5 * bar.length, layout.bar_top()]
    };
    bar.draw(drawing, corner);
}
