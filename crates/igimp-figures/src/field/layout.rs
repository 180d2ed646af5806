//! Layout of fields: the largest plot areas of equal scale in x and y that fit the page.

use super::FieldPlot;
use super::colour_bar::{ColourBar, ColourScale};
use crate::axis::ticks::Ticks;
use crate::axis::{Axis, Scale};
use crate::drawing::font::{self, LINE_HEIGHT};
use crate::frame::{self, Frame, GAP, LABEL, MARGIN, TICK, TITLE};
use crate::geometry::{Point, Rect};

/// Widest picture \[pt\] with one column of plots, and with several.
const WIDTHS: [f64; 2] = [640.0, 760.0];
/// Greatest height \[pt\] of all plot areas together.
const MOST_HEIGHT: f64 = 560.0;
/// Least width and height \[pt\] of a plot area; a slender body gets free space beside it.
const LEAST_AREA: [f64; 2] = [110.0, 64.0];
/// Greatest length \[pt\] of the colour bar.
const LONGEST_BAR: f64 = 400.0;
/// Least width \[pt\] of the picture.
const LEAST_WIDTH: f64 = 280.0;

/// The shown part of the ground: ranges of x and y.
pub(crate) type Window = [(f64, f64); 2];

/// The places of everything in the picture.
pub(crate) struct Layout<'a> {
    sheet: &'a Sheet<'a>,
    /// The ranges of the axes.
    pub(crate) window: Window,
    /// Width and height \[pt\] of one plot area.
    area: [f64; 2],
    /// Upper left corner of the first plot area.
    corner: Point,
    /// Height \[pt\] of the titles above each row.
    panel_title: f64,
    pub(crate) x_ticks: Ticks,
    pub(crate) y_ticks: Ticks,
    pub(crate) bar: Option<ColourBar<'a>>,
}

impl<'a> Layout<'a> {
    /// The largest plots that fit the page.
    pub(crate) fn fit(
        sheet: &'a Sheet<'a>,
        window: Window,
        scale: Option<ColourScale>,
        upright: bool,
    ) -> Self {
        let first = &sheet.plots[0];
        let bar = |length: f64| {
            let length = length.min(LONGEST_BAR);
            scale.map(|scale| ColourBar {
                scale,
                label: &first.label,
                upright,
                length,
            })
        };
        let mut layout = Self {
            sheet,
            window,
            area: [400.0, 300.0],
            corner: [MARGIN + 60.0, MARGIN],
            panel_title: 0.0,
            x_ticks: Ticks::default(),
            y_ticks: Ticks::default(),
            bar: bar(300.0),
        };
        // Ticks depend on the size and the size on the width of the tick labels: settled at once
        // in practice, and after three rounds in any case.
        for _ in 0..3 {
            layout.scale_to_page(window);
            let x = Axis {
                scale: Scale::Linear,
                range: layout.window[0],
                span: (0.0, layout.area[0]),
            };
            let y = Axis {
                scale: Scale::Linear,
                range: layout.window[1],
                span: (0.0, layout.area[1]),
            };
            layout.x_ticks = x.ticks_beside(TICK);
            layout.y_ticks = y.ticks_stacked(TICK);
            layout.panel_title = layout.panel_title_height();
            layout.bar = bar(if upright {
                layout.rows_height()
            } else {
                layout.columns_width()
            });
            layout.corner[0] = MARGIN
                + frame::lines_height(&layout.y_label_lines(), LABEL)
                + 0.5 * GAP
                + frame::tick_width(&layout.y_ticks);
        }
        let spare = 0.5 * (LEAST_WIDTH - layout.width()).max(0.0);
        layout.corner[0] += spare;
        let title = frame::title_height(&layout.title_lines(), TITLE);
        // The panel titles leave room for the factors at the ends of axes and bar.
        let above = layout.factor_height().max(layout.panel_title);
        let apart = if layout.panel_title > 0.0 {
            0.5 * GAP
        } else {
            0.0
        };
        layout.corner[1] = MARGIN + title + apart + above;
        layout
    }

    /// Chooses the size of the plot areas, and widens the window of a slender body.
    fn scale_to_page(&mut self, [x, y]: Window) {
        let (columns, rows) = (self.sheet.columns as f64, self.rows() as f64);
        let page = WIDTHS[usize::from(self.sheet.columns > 1)];
        let beside = self.beside();
        let gaps = (columns - 1.0) * 2.0 * GAP;
        let room = (page - self.corner[0] - MARGIN - beside - gaps) / columns;
        let extent = [x.1 - x.0, y.1 - y.0];
        let scale = (room / extent[0]).min(MOST_HEIGHT / rows / extent[1]);
        self.area = std::array::from_fn(|k| (scale * extent[k]).max(LEAST_AREA[k]));
        self.window = std::array::from_fn(|k| {
            let (low, high) = [x, y][k];
            let spare = 0.5 * (self.area[k] / scale - extent[k]);
            (low - spare, high + spare)
        });
    }

    /// The plot whose labels, bar or key hold for all.
    pub(crate) fn first(&self) -> &'a FieldPlot {
        &self.sheet.plots[0]
    }

    fn rows(&self) -> usize {
        self.sheet.plots.len().div_ceil(self.sheet.columns)
    }

    /// Height \[pt\] of the factors above the first row of plots and above an upright bar.
    fn factor_height(&self) -> f64 {
        let line = TICK * LINE_HEIGHT;
        let bar = self
            .bar
            .as_ref()
            .filter(|bar| bar.upright && bar.has_factor());
        let above = bar.map_or(0.0, |bar| line - 0.5 * (self.rows_height() - bar.length));
        frame::factor_height(&self.y_ticks).max(above)
    }

    fn panel_title_height(&self) -> f64 {
        if !self.sheet.panel_titles {
            return 0.0;
        }
        let height = |plot: &FieldPlot| {
            frame::title_height(&font::wrap(&plot.title, LABEL, self.area[0]), LABEL)
        };
        self.sheet.plots.iter().map(height).fold(0.0, f64::max)
    }

    /// Height \[pt\] from the top of the first plot area to the bottom of the last.
    pub(crate) fn rows_height(&self) -> f64 {
        let rows = self.rows() as f64;
        rows * self.area[1] + (rows - 1.0) * (self.panel_title + 1.5 * GAP)
    }

    /// Width \[pt\] from the left of the first plot area to the right of the last.
    fn columns_width(&self) -> f64 {
        let columns = self.sheet.columns as f64;
        columns * self.area[0] + (columns - 1.0) * 2.0 * GAP
    }

    /// Width \[pt\] of the picture.
    pub(crate) fn width(&self) -> f64 {
        (self.corner[0] + self.columns_width() + self.beside() + MARGIN).max(LEAST_WIDTH)
    }

    /// Space \[pt\] right of the plot areas.
    fn beside(&self) -> f64 {
        match &self.bar {
            Some(bar) if bar.upright => 2.0 * GAP + bar.depth(),
            _ => GAP,
        }
    }

    /// The plot area in a row and a column.
    fn area_of(&self, index: usize) -> Rect {
        let (row, column) = (index / self.sheet.columns, index % self.sheet.columns);
        let [width, height] = self.area;
        let left = self.corner[0] + column as f64 * (width + 2.0 * GAP);
        let top = self.corner[1] + row as f64 * (height + self.panel_title + 1.5 * GAP);
        Rect::new(left, top, width, height)
    }

    /// Plot area and axes of a plot.
    pub(crate) fn frame_of(&self, index: usize) -> Frame {
        let area = self.area_of(index);
        let axis = |range, span| Axis {
            scale: Scale::Linear,
            range,
            span,
        };
        Frame {
            area,
            x: axis(self.window[0], (area.left, area.right)),
            y: axis(self.window[1], (area.bottom, area.top)),
            x_ticks: self.x_ticks.clone(),
            y_ticks: self.y_ticks.clone(),
        }
    }

    /// All plot areas with the gaps between them.
    pub(crate) fn all_areas(&self) -> Rect {
        Rect::new(
            self.corner[0],
            self.corner[1],
            self.columns_width(),
            self.rows_height(),
        )
    }

    pub(crate) fn x_label_lines(&self) -> Vec<String> {
        let room = self.columns_width().max(200.0);
        font::wrap(&self.sheet.plots[0].x_label, LABEL, room)
    }

    pub(crate) fn y_label_lines(&self) -> Vec<String> {
        font::wrap(&self.sheet.plots[0].y_label, LABEL, 300.0)
    }

    pub(crate) fn title_lines(&self) -> Vec<String> {
        font::wrap(self.sheet.title, TITLE, self.width() - 2.0 * MARGIN)
    }

    /// Top \[pt\] of the label of the x axis.
    pub(crate) fn below_axis(&self) -> f64 {
        self.all_areas().bottom + frame::tick_height() + 0.5 * GAP
    }

    /// Top \[pt\] of a colour bar below the plots.
    pub(crate) fn bar_top(&self) -> f64 {
        self.below_axis() + frame::lines_height(&self.x_label_lines(), LABEL) + GAP
    }
}

/// The contents to lay out.
pub(crate) struct Sheet<'a> {
    pub(crate) title: &'a str,
    /// At least one plot.
    pub(crate) plots: &'a [FieldPlot],
    /// At least one column, and no more than plots.
    pub(crate) columns: usize,
    /// Whether each plot carries its own title.
    pub(crate) panel_titles: bool,
}
