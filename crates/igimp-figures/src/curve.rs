//! Curves: results as lines or markers, bounds as shaded bands, reference values as straight lines.

mod ends;
pub(crate) mod frame;
pub(crate) mod sheet;

use std::path::Path;

use super::FigureError;
use super::axis::Scale;
use super::colour::Colour;
use super::drawing::Drawing;

/// Pattern of a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineStyle {
    /// Unbroken.
    #[default]
    Solid,
    /// Dashes.
    Dashed,
    /// Dots.
    Dotted,
}

/// How the points of a series are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeriesStyle {
    /// Points joined by a line.
    Line(LineStyle),
    /// A marker at each point; its shape follows the place of the series in the plot.
    Markers,
    /// Both.
    LineAndMarkers(LineStyle),
}

impl SeriesStyle {
    pub(super) fn line(self) -> Option<LineStyle> {
        match self {
            Self::Line(line) | Self::LineAndMarkers(line) => Some(line),
            Self::Markers => None,
        }
    }

    pub(super) fn has_markers(self) -> bool {
        !matches!(self, Self::Line(_))
    }
}

/// Where the labels of series stand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SeriesLabels {
    /// In a legend.
    #[default]
    Legend,
    /// To the right of the plot, each at the end of its series and in its colour.
    AtCurves,
}

/// One curve or cloud of points.
#[derive(Clone, Debug)]
pub struct Series {
    /// Text in the legend; empty to leave the series out of it.
    pub label: String,
    /// Points (x, y) in the units of the axes. A point that is not finite breaks the line, and is counted
    /// in a note unless neither of its coordinates is a number.
    pub points: Vec<[f64; 2]>,
    /// Line, markers, or both.
    pub style: SeriesStyle,
    /// Colour; `None` takes the next of a colour-blind-safe cycle.
    pub colour: Option<Colour>,
}

impl Series {
    /// A series in the next colour of the cycle.
    pub fn new(label: impl Into<String>, points: Vec<[f64; 2]>, style: SeriesStyle) -> Self {
        Self {
            label: label.into(),
            points,
            style,
            colour: None,
        }
    }

    /// A solid line.
    pub fn line(label: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self::new(label, points, SeriesStyle::Line(LineStyle::Solid))
    }

    /// Markers without a line.
    pub fn markers(label: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self::new(label, points, SeriesStyle::Markers)
    }

    /// The same series in a given colour.
    #[must_use]
    pub fn in_colour(self, colour: Colour) -> Self {
        Self {
            colour: Some(colour),
            ..self
        }
    }
}

/// A shaded region between two curves: an acceptance band or bounds from the literature.
#[derive(Clone, Debug)]
pub struct Band {
    /// Text in the legend; empty to leave the band out of it.
    pub label: String,
    /// Lower edge, points (x, y). On a logarithmic axis an edge that is not positive lies at the bottom.
    pub lower: Vec<[f64; 2]>,
    /// Upper edge, points (x, y), in the same direction as the lower one.
    pub upper: Vec<[f64; 2]>,
}

impl Band {
    /// The band `relative` times |y| to either side of a curve, for instance 0.05 for ±5 %.
    pub fn around(label: impl Into<String>, curve: &[[f64; 2]], relative: f64) -> Self {
        let moved = |sign: f64| {
            curve
                .iter()
                .map(move |&[x, y]| [x, y + sign * relative * y.abs()])
        };
        Self {
            label: label.into(),
            lower: moved(-1.0).collect(),
            upper: moved(1.0).collect(),
        }
    }
}

/// A straight line over the whole plot at a value of one axis.
#[derive(Clone, Debug)]
pub struct ReferenceLine {
    /// Text written along the line; may be empty.
    pub label: String,
    /// Which axis holds the value.
    pub at: ReferenceValue,
}

/// Place of a [`ReferenceLine`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReferenceValue {
    /// An upright line at this x.
    X(f64),
    /// A level line at this y.
    Y(f64),
}

/// Curves over a common pair of axes.
///
/// The legend stands where it covers no curve, or to the right of the plot if there is no such
/// place. Values that an axis cannot show (not finite, or not positive on a logarithmic axis) are
/// left out and counted in a note.
///
/// ```no_run
/// use igimp_figures::{Band, CurvePlot, Series};
/// let curve = vec![[0.0, 0.0], [5.0, 300.0], [20.0, 514.0]];
/// let plot = CurvePlot {
///     title: "Strip footing".into(),
///     x_label: "settlement δ [mm]".into(),
///     y_label: "bearing pressure p [kPa]".into(),
///     bands: vec![Band::around("reference ±5 %", &curve, 0.05)],
///     series: vec![Series::line("computed", curve)],
///     ..CurvePlot::default()
/// };
/// plot.write("results/footing/figures/load-settlement".as_ref())?;
/// # Ok::<(), igimp_figures::FigureError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct CurvePlot {
    /// Title above the plot; may be empty.
    pub title: String,
    /// Name and unit of the x axis, such as "settlement δ \[mm\]".
    pub x_label: String,
    /// Name and unit of the y axis.
    pub y_label: String,
    /// Spread of the x axis.
    pub x_scale: Scale,
    /// Spread of the y axis.
    pub y_scale: Scale,
    /// Values at the left and the right end; left > right turns the axis round. `None`: from the data.
    pub x_range: Option<(f64, f64)>,
    /// Values at the bottom and the top; bottom > top turns the axis round (depth, settlement).
    /// `None`: from the data.
    pub y_range: Option<(f64, f64)>,
    /// Shaded regions, drawn first.
    pub bands: Vec<Band>,
    /// Straight reference lines.
    pub lines: Vec<ReferenceLine>,
    /// Curves, drawn in this order.
    pub series: Vec<Series>,
    /// Where their labels stand; those of bands are in a legend always.
    pub labels: SeriesLabels,
}

impl CurvePlot {
    /// Lays the plot out.
    ///
    /// # Errors
    /// If a given range cannot be drawn on its axis.
    pub fn draw(&self) -> Result<Drawing, FigureError> {
        sheet::draw(self)
    }

    /// Writes `<path>.svg` and `<path>.png`; the folder must exist.
    ///
    /// # Errors
    /// If a given range cannot be drawn on its axis, or a file cannot be written.
    pub fn write(&self, path_without_extension: &Path) -> Result<(), FigureError> {
        self.draw()?.write(path_without_extension)
    }
}
