//! Figures of publication quality, as SVG and PNG from one description.
//!
//! | figure | for |
//! |---|---|
//! | [`CurvePlot`] | stress along a section, load-settlement, convergence, strength reduction |
//! | [`FieldPlot`] | a field on the particle domains of one state |
//! | [`SpacePlot`] | the surface of a body in space |
//! | [`film()`] | pictures one after another, as an animated GIF |
//! | [`FieldPanel`] | the same field for several variants or steps, with one colour bar |
//!
//! Each is a plain value with public fields: fill it in and call `write`, or `draw` to get a
//! [`Drawing`] whose SVG can be embedded in a page. In every text `_{...}` writes an index and
//! `^{...}` a power: `"σ_{yy} [kPa]"`.
//!
//! # Why our own drawing
//! A figure is laid out once as a list of shapes and texts, which is printed as SVG and filled by
//! `tiny-skia` as PNG; glyphs come from the font of the `dejavu` crate through `ttf-parser`. Ready
//! plotting libraries were tried first. `kuva` 0.6 has neither filled polygons with a colour bar nor
//! panels that share one, leaves hairlines between neighbouring cells, blurs upright text in the
//! PNG, and takes three times as long to compile; rendering our SVG through `resvg` gives the same
//! picture as `tiny-skia` alone for sixty more crates. The layout (ticks, legend, colour bar) would
//! be ours in either case.

mod axis;
mod colour;
mod curve;
mod drawing;
mod error;
mod field;
mod film;
mod frame;
mod geometry;
mod legend;
pub(crate) mod marker;
mod space;
#[cfg(test)]
mod tests;

pub use axis::Scale;
pub use colour::{Colour, ColourMap};
pub use curve::{
    Band, CurvePlot, LineStyle, ReferenceLine, ReferenceValue, Series, SeriesLabels, SeriesStyle,
};
pub use drawing::{Drawing, PIXELS_PER_POINT, Rgb};
pub use error::FigureError;
pub use field::{FieldPanel, FieldPlot, KeyEntry, KeySample, Outline, OutlineStyle, Polygon};
pub use film::{STAYS, film};
pub use space::{Face, SpacePlot, View};
