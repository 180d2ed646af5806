//! Fields: one filled domain per particle, coloured by a value.

pub(crate) mod colour_bar;
pub(crate) mod domains;
pub(crate) mod key;
pub(crate) mod layout;
pub(crate) mod outline;
pub(crate) mod sheet;

use std::path::Path;

use super::FigureError;
use super::colour::ColourMap;
use super::drawing::Drawing;
use crate::field::layout::Sheet;

/// Corners (x, y) of a domain in order, either way round; GIMP domains are rectangles.
pub type Polygon = Vec<[f64; 2]>;

/// How an [`Outline`] is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutlineStyle {
    /// A firm line: the edge of a body before it moved, the ground surface.
    Edge,
    /// A hairline: grid lines.
    Grid,
    /// A dashed line: a section along which results are plotted elsewhere.
    Section,
    /// A closed shape filled with grey: a rigid footing.
    Block,
    /// A firm line with a hatch to its right, seen along it: a side that is held in both directions.
    Fixed,
    /// A line with rollers to its right, seen along it: a side that is held across it.
    Roller,
    /// An arrow from the last point but one to the last: a load.
    Arrow,
    /// A dot at every point: a place that is watched.
    Point,
    /// A thin dashed grey line: an edge where it was before.
    Former,
    /// A heavy line on a white ground: a line that was found.
    Trace,
    /// A blue line: a water table.
    Water,
    /// A heavy line with a light core: a member of reinforcement.
    Member,
    /// A thin line around a pale ground: the tension along a member.
    Diagram,
    /// Small arrows, each from one point to the next, then from the third to the fourth, and so on:
    /// directions and sizes.
    Vectors,
}

/// A line over the field.
#[derive(Clone, Debug)]
pub struct Outline {
    /// Points (x, y).
    pub points: Vec<[f64; 2]>,
    /// The meaning of the line.
    pub style: OutlineStyle,
}

/// The symbol before a name in a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeySample {
    /// The colour of a value.
    Value(usize),
    /// A line or symbol.
    Outline(OutlineStyle),
}

/// An entry of a key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeyEntry {
    /// Colour or symbol.
    pub sample: KeySample,
    /// Name.
    pub label: String,
}

/// A field of values on particle domains, with equal scales in x and y and a colour bar.
///
/// Domains without a value (NaN or infinite) are grey, and counted in a note together with domains
/// that have no place. Each domain is drawn 0.3 points larger than it is, to every side, so that no
/// hairlines of the ground shine through between neighbours.
///
/// ```no_run
/// use igimp_figures::{ColourMap, FieldPlot};
/// let plot = FieldPlot {
///     title: "After the last step".into(),
///     domains: vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]],
///     values: vec![-12.5],
///     label: "mean stress p [kPa], tension positive".into(),
///     map: ColourMap::Diverging,
///     ..FieldPlot::default()
/// };
/// plot.write("results/slope/figures/mean-stress".as_ref())?;
/// # Ok::<(), igimp_figures::FigureError>(())
/// ```
#[derive(Clone, Debug)]
pub struct FieldPlot {
    /// Title above the plot; may be empty.
    pub title: String,
    /// Particle domains.
    pub domains: Vec<Polygon>,
    /// One value per domain.
    pub values: Vec<f64>,
    /// Name and unit of the value, written along the colour bar.
    pub label: String,
    /// Values at the ends of the colour bar; values beyond take the colour of the end, and the bar
    /// ends in a point there. `None`: from the data.
    pub range: Option<(f64, f64)>,
    /// Colours of the values.
    pub map: ColourMap,
    /// Lines over the field.
    pub outlines: Vec<Outline>,
    /// Words beside points (x, y) of the field.
    pub labels: Vec<([f64; 2], String)>,
    /// Names of colours and symbols. With a key the values 0, 1, 2 … stand for kinds of things, and
    /// the key below the plot takes the place of the colour bar.
    pub key: Vec<KeyEntry>,
    /// Name and unit of the x axis.
    pub x_label: String,
    /// Name and unit of the y axis.
    pub y_label: String,
    /// Part of the x axis that is shown, rising. `None`: everything.
    pub x_range: Option<(f64, f64)>,
    /// Part of the y axis that is shown, rising. `None`: everything.
    pub y_range: Option<(f64, f64)>,
}

impl Default for FieldPlot {
    /// Nothing to draw yet, on axes "x \[m\]" and "y \[m\]".
    fn default() -> Self {
        Self {
            title: String::new(),
            domains: Vec::new(),
            values: Vec::new(),
            label: String::new(),
            range: None,
            map: ColourMap::default(),
            outlines: Vec::new(),
            labels: Vec::new(),
            key: Vec::new(),
            x_label: "x [m]".to_owned(),
            y_label: "y [m]".to_owned(),
            x_range: None,
            y_range: None,
        }
    }
}

impl FieldPlot {
    /// Lays the plot out.
    ///
    /// # Errors
    /// If values and domains differ in number, or a given range cannot be drawn.
    pub fn draw(&self) -> Result<Drawing, FigureError> {
        let plots = std::slice::from_ref(self);
        sheet::draw(&Sheet {
            title: &self.title,
            plots,
            columns: 1,
            panel_titles: false,
        })
    }

    /// Writes `<path>.svg` and `<path>.png`; the folder must exist.
    ///
    /// # Errors
    /// If values and domains differ in number, a given range cannot be drawn, or a file cannot be
    /// written.
    pub fn write(&self, path_without_extension: &Path) -> Result<(), FigureError> {
        self.draw()?.write(path_without_extension)
    }
}

/// Several fields side by side over the same piece of ground, with one colour bar for all.
///
/// The plots keep their titles; they must agree on `label` and `map`. The axes show what the widest
/// plot shows, the colour bar spans the values (or the given ranges) of all of them.
#[derive(Clone, Debug)]
pub struct FieldPanel {
    /// Title above the panel; may be empty.
    pub title: String,
    /// Number of plots side by side.
    pub columns: usize,
    /// The plots, row by row.
    pub plots: Vec<FieldPlot>,
}

impl FieldPanel {
    /// Lays the panel out.
    ///
    /// # Errors
    /// As for [`FieldPlot::draw`], and if there are no plots or columns, or if the plots differ in
    /// their colour bars.
    pub fn draw(&self) -> Result<Drawing, FigureError> {
        let Self {
            title,
            columns,
            plots,
        } = self;
        if plots.is_empty() || *columns == 0 {
            let (title, plots, columns) = (title.clone(), plots.len(), *columns);
            return Err(FigureError::EmptyPanel {
                title,
                plots,
                columns,
            });
        }
        let first = &plots[0];
        if let Some(other) = plots
            .iter()
            .find(|p| p.label != first.label || p.map != first.map)
        {
            return Err(FigureError::MixedPanel {
                title: title.clone(),
                first: first.label.clone(),
                other: other.label.clone(),
            });
        }
        let columns = (*columns).min(plots.len());
        sheet::draw(&Sheet {
            title,
            plots,
            columns,
            panel_titles: true,
        })
    }

    /// Writes `<path>.svg` and `<path>.png`; the folder must exist.
    ///
    /// # Errors
    /// As for [`FieldPanel::draw`], and if a file cannot be written.
    pub fn write(&self, path_without_extension: &Path) -> Result<(), FigureError> {
        self.draw()?.write(path_without_extension)
    }
}
