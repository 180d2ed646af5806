//! A laid-out picture: shapes and texts with their places, ready for SVG and PNG.
//!
//! Every figure is first laid out as a [`Drawing`]; both files are written from it, so they agree.

pub(crate) mod font;
pub(crate) mod raster;
pub(crate) mod svg;

use std::path::{Path, PathBuf};

use super::FigureError;
use super::colour::Colour;
use super::geometry::{Point, Rect};

/// Pixels per point in the PNG: 288 dots per inch at the nominal size.
pub const PIXELS_PER_POINT: u32 = 3;

/// A picture laid out in points (96 per inch; 640 points are a 170 mm text width).
#[derive(Debug)]
pub struct Drawing {
    pub(super) title: String,
    pub(super) width: f64,
    pub(super) height: f64,
    pub(super) items: Vec<Item>,
}

/// One thing in the picture; later items cover earlier ones.
#[derive(Debug)]
pub(super) enum Item {
    Shape(Shape),
    Text(Text),
    Image(Image),
}

/// Contours that share a fill and a stroke.
#[derive(Debug, Default)]
pub(super) struct Shape {
    pub(super) contours: Vec<Contour>,
    pub(super) fill: Option<(Colour, f64)>,
    pub(super) stroke: Option<Stroke>,
}

/// One part of a shape.
#[derive(Debug)]
pub(super) enum Contour {
    Open(Vec<Point>),
    Closed(Vec<Point>),
    Circle { centre: Point, radius: f64 },
}

/// A line along contours.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stroke {
    pub(super) colour: Colour,
    pub(super) width: f64,
    /// Lengths \[pt\] of dash and gap; empty for a solid line.
    pub(super) dash: &'static [f64],
}

impl Stroke {
    pub(super) fn solid(colour: Colour, width: f64) -> Self {
        Self {
            colour,
            width,
            dash: &[],
        }
    }

    pub(super) fn dashed(colour: Colour, width: f64, dash: &'static [f64]) -> Self {
        Self {
            colour,
            width,
            dash,
        }
    }
}

/// Which point of a text its place means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// One line of text; `at` lies on the baseline.
#[derive(Debug)]
pub(super) struct Text {
    pub(super) at: Point,
    pub(super) content: String,
    pub(super) size: f64,
    pub(super) anchor: Anchor,
    /// Turned by a quarter to the left, to be read from the right.
    pub(super) upward: bool,
    pub(super) colour: Colour,
}

impl Drawing {
    pub(super) fn new(title: &str) -> Self {
        Self {
            title: title.to_owned(),
            width: 0.0,
            height: 0.0,
            items: Vec::new(),
        }
    }

    pub(super) fn fill(&mut self, contours: Vec<Contour>, colour: Colour, opacity: f64) {
        let fill = Some((colour, opacity));
        self.items.push(Item::Shape(Shape {
            contours,
            fill,
            stroke: None,
        }));
    }

    pub(super) fn rect(&mut self, rect: Rect, fill: Option<Colour>, stroke: Option<Stroke>) {
        let contours = vec![Contour::Closed(rect.corners())];
        let fill = fill.map(|colour| (colour, 1.0));
        self.items.push(Item::Shape(Shape {
            contours,
            fill,
            stroke,
        }));
    }

    pub(super) fn stroke(&mut self, lines: Vec<Vec<Point>>, stroke: Stroke) {
        let contours: Vec<_> = lines.into_iter().map(Contour::Open).collect();
        if !contours.is_empty() {
            self.items.push(Item::Shape(Shape {
                contours,
                fill: None,
                stroke: Some(stroke),
            }));
        }
    }

    /// A level line of text with its baseline at `at`.
    pub(super) fn text(
        &mut self,
        at: Point,
        anchor: Anchor,
        size: f64,
        colour: Colour,
        text: &str,
    ) {
        self.push_text(Text {
            at,
            content: text.to_owned(),
            size,
            anchor,
            upward: false,
            colour,
        });
    }

    /// Lines of text centred about `x`, first baseline at `y`.
    pub(super) fn centred_lines(&mut self, [x, y]: Point, size: f64, lines: &[String]) {
        for (index, line) in lines.iter().enumerate() {
            let at = [x, y + index as f64 * size * font::LINE_HEIGHT];
            self.text(at, Anchor::Middle, size, Colour::INK, line);
        }
    }

    /// Lines of text read upward and centred about `y`, first baseline at `x`.
    pub(super) fn upward_lines(&mut self, [x, y]: Point, size: f64, lines: &[String]) {
        for (index, line) in lines.iter().enumerate() {
            let at = [x + index as f64 * size * font::LINE_HEIGHT, y];
            let (anchor, colour) = (Anchor::Middle, Colour::INK);
            let content = line.clone();
            self.push_text(Text {
                at,
                content,
                size,
                anchor,
                upward: true,
                colour,
            });
        }
    }

    pub(super) fn image(&mut self, image: Image) {
        self.items.push(Item::Image(image));
    }

    pub(super) fn push_text(&mut self, text: Text) {
        if !text.content.is_empty() {
            self.items.push(Item::Text(text));
        }
    }

    /// Width and height of the PNG \[pixel\].
    pub fn pixel_size(&self) -> (u32, u32) {
        (raster::pixels(self.width), raster::pixels(self.height))
    }

    /// The picture as an SVG document, fit for a file or for embedding in a page.
    pub fn to_svg(&self) -> String {
        svg::document(self)
    }

    /// The picture as the bytes of a PNG file, [`PIXELS_PER_POINT`] pixels per point.
    ///
    /// # Errors
    /// If the picture is too large for the memory, or the encoder fails.
    pub fn to_png(&self) -> Result<Vec<u8>, FigureError> {
        raster::png(self)
    }

    /// The pixels of the picture, so many of them wide; its height follows.
    ///
    /// # Errors
    /// If the picture is too large for the memory.
    pub fn to_rgb(&self, width: u32) -> Result<Rgb, FigureError> {
        raster::rgb(self, width)
    }

    /// Writes `<path>.svg` and `<path>.png`; the folder must exist.
    ///
    /// # Errors
    /// If the PNG cannot be made or a file cannot be written.
    pub fn write(&self, path_without_extension: &Path) -> Result<(), FigureError> {
        let save = |extension: &str, bytes: &[u8]| {
            // Not `with_extension`: a name such as "srf-1.25" ends in a dot and digits.
            let mut path = path_without_extension.as_os_str().to_owned();
            path.push(extension);
            let path = PathBuf::from(path);
            write_new(&path, bytes).map_err(|source| FigureError::Write { path, source })
        };
        save(".svg", self.to_svg().as_bytes())?;
        save(".png", &self.to_png()?)
    }
}

/// Writes a new file. A link that has the name goes, and its target stays as it is.
fn write_new(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    std::io::Write::write_all(&mut std::fs::File::create_new(path)?, bytes)
}

/// A picture as pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rgb {
    /// Width \[pixel\].
    pub width: u32,
    /// Height \[pixel\].
    pub height: u32,
    /// Red, green and blue of the pixels, row by row from the top.
    pub pixels: Vec<[u8; 3]>,
}

/// Where the image of a surface lies in a drawing, and its pixels.
#[derive(Debug)]
pub(crate) struct Image {
    pub(crate) area: Rect,
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// Red, green, blue and opacity of the pixels, row by row; colours are not multiplied by opacity.
    pub(crate) rgba: Vec<u8>,
}
