//! Errors while a figure is laid out or written.

use std::path::PathBuf;

/// A figure that cannot be drawn or written.
///
/// Missing data are no error: an empty plot says "no data" in its frame, and values that are not
/// numbers are drawn in grey and counted below the picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FigureError {
    /// A field has not exactly one value per domain.
    #[error("figure \"{title}\": {domains} domains but {values} values")]
    LengthMismatch {
        /// Title of the field plot.
        title: String,
        /// Number of domains.
        domains: usize,
        /// Number of values.
        values: usize,
    },
    /// A given range is not finite, has no width, or is not positive on a logarithmic axis.
    #[error("figure \"{title}\": the range {from} to {to} of the {axis} cannot be drawn")]
    InvalidRange {
        /// Title of the plot.
        title: String,
        /// The axis, in words.
        axis: &'static str,
        /// Start of the range.
        from: f64,
        /// End of the range.
        to: f64,
    },
    /// A panel needs at least one plot and at least one column.
    #[error("figure \"{title}\": a panel of {plots} plots in {columns} columns")]
    EmptyPanel {
        /// Title of the panel.
        title: String,
        /// Number of plots.
        plots: usize,
        /// Number of columns.
        columns: usize,
    },
    /// The plots of a panel share one colour bar, so they must agree on its label and colour map.
    #[error(
        "figure \"{title}\": the plots of a panel differ in their colour bar (\"{first}\", \"{other}\")"
    )]
    MixedPanel {
        /// Title of the panel.
        title: String,
        /// Colour-bar label of the first plot.
        first: String,
        /// Colour-bar label of the plot that differs.
        other: String,
    },
    /// The picture is too large for the pixel buffer.
    #[error("a picture of {width} x {height} pixels cannot be allocated")]
    TooLarge {
        /// Width \[pixel\].
        width: u32,
        /// Height \[pixel\].
        height: u32,
    },
    /// The PNG encoder failed.
    #[error("the PNG could not be encoded")]
    Encode(#[from] png::EncodingError),
    /// A film has no frames, or frames of different sizes.
    #[error("a film of {frames} frames whose sizes differ, or without frames")]
    MixedFilm {
        /// Number of frames.
        frames: usize,
    },
    /// The film encoder failed.
    #[error("the film could not be encoded")]
    EncodeFilm(#[from] gif::EncodingError),
    /// A file could not be written.
    #[error("cannot write {}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The cause.
        source: std::io::Error,
    },
}
