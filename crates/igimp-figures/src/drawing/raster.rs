//! A drawing as pixels, and as a PNG.

use tiny_skia::{
    FillRule, LineJoin, Mask, Paint, Path, PathBuilder, Pixmap, Stroke as SkiaStroke, StrokeDash,
    Transform,
};

use super::font::{self, Pen};
use super::{Anchor, Contour, Drawing, Item, PIXELS_PER_POINT, Shape, Text};
use crate::FigureError;
use crate::colour::Colour;
use crate::drawing::{Image, Rgb};
use crate::geometry::Point;

const NO_CLIP: Option<&Mask> = None;

/// Length in whole pixels of a length \[pt\], rounded up.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast saturates; a picture too large is refused when its pixels are allocated"
)]
pub(crate) fn pixels(length: f64) -> u32 {
    (length * f64::from(PIXELS_PER_POINT)).ceil() as u32
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "pixels need no more than single precision"
)]
fn single(value: f64) -> f32 {
    value as f32
}

/// The bytes of the PNG file.
pub(crate) fn png(drawing: &Drawing) -> Result<Vec<u8>, FigureError> {
    let pixmap = painted(drawing, drawing.pixel_size(), f64::from(PIXELS_PER_POINT))?;
    let is_flat = !drawing
        .items
        .iter()
        .any(|item| matches!(item, Item::Image(_)));
    encode(&pixmap, is_flat)
}

/// The pixels of a drawing that is as many of them wide, by red, green and blue: a frame of a film.
pub(crate) fn rgb(drawing: &Drawing, width: u32) -> Result<Rgb, FigureError> {
    let scale = f64::from(width) / drawing.width.max(1.0);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the cast saturates; a picture too large is refused when its pixels are allocated"
    )]
    let height = (drawing.height * scale).ceil() as u32;
    let pixmap = painted(drawing, (width, height), scale)?;
    let rgba = pixmap.data().as_chunks::<4>().0;
    let rgb = rgba.iter().map(|&[r, g, b, _]| [r, g, b]).collect();
    Ok(Rgb {
        width,
        height,
        pixels: rgb,
    })
}

/// A drawing on a white ground, in so many pixels by point.
fn painted(
    drawing: &Drawing,
    (width, height): (u32, u32),
    scale: f64,
) -> Result<Pixmap, FigureError> {
    let mut pixmap = Pixmap::new(width, height).ok_or(FigureError::TooLarge { width, height })?;
    pixmap.fill(tiny_skia::Color::WHITE);
    let to_pixels = Transform::from_scale(single(scale), single(scale));
    for item in &drawing.items {
        match item {
            Item::Shape(shape) => draw_shape(&mut pixmap, shape, to_pixels),
            Item::Text(text) => draw_text(&mut pixmap, text, to_pixels),
            Item::Image(image) => draw_image(&mut pixmap, image, scale),
        }
    }
    Ok(pixmap)
}

/// An image whose area begins at a whole point, over the image there.
fn draw_image(pixmap: &mut Pixmap, image: &Image, scale: f64) {
    let (left, top) = (pixels(image.area.left), pixels(image.area.top));
    let Some(mut shown) = Pixmap::new(image.width, image.height) else {
        return;
    };
    for (pixel, rgba) in std::iter::zip(shown.pixels_mut(), image.rgba.as_chunks::<4>().0) {
        let [r, g, b, a] = *rgba;
        *pixel = tiny_skia::ColorU8::from_rgba(r, g, b, a).premultiply();
    }
    let share = single(scale / f64::from(PIXELS_PER_POINT));
    let (how, shrunk) = if (share - 1.0).abs() < 1e-6 {
        (tiny_skia::PixmapPaint::default(), Transform::identity())
    } else {
        let how = tiny_skia::PixmapPaint {
            quality: tiny_skia::FilterQuality::Bilinear,
            ..tiny_skia::PixmapPaint::default()
        };
        (how, Transform::from_scale(share, share))
    };
    let (left, top) = (left.cast_signed(), top.cast_signed());
    pixmap.draw_pixmap(left, top, shown.as_ref(), &how, shrunk, NO_CLIP);
}

/// An image as a PNG file with opacity.
pub(crate) fn image_png(image: &Image) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, image.width, image.height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    let mut writer = encoder.write_header().ok()?;
    writer.write_image_data(&image.rgba).ok()?;
    writer.finish().ok()?;
    Some(bytes)
}

fn encode(pixmap: &Pixmap, is_flat: bool) -> Result<Vec<u8>, FigureError> {
    // The white ground makes every pixel opaque, so three channels hold all of it.
    let mut rgb = Vec::with_capacity(3 * pixmap.pixels().len());
    for rgba in pixmap.data().as_chunks::<4>().0 {
        rgb.extend_from_slice(&rgba[..3]);
    }
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, pixmap.width(), pixmap.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    // Pictures of flat colours: little larger, and written in a tenth of the time.
    encoder.set_compression(if is_flat {
        png::Compression::Fast
    } else {
        png::Compression::Balanced
    });
    // 96 points per inch, 39.37 inches per metre.
    let per_metre = PIXELS_PER_POINT * 3780;
    encoder.set_pixel_dims(Some(png::PixelDimensions {
        xppu: per_metre,
        yppu: per_metre,
        unit: png::Unit::Meter,
    }));
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&rgb)?;
    writer.finish()?;
    Ok(bytes)
}

fn paint(Colour([r, g, b]): Colour, opacity: f64) -> Paint<'static> {
    let mut paint = Paint {
        anti_alias: true,
        ..Paint::default()
    };
    let alpha = single(opacity.clamp(0.0, 1.0));
    let channel = |c: u8| f32::from(c) / 255.0;
    if let Some(colour) = tiny_skia::Color::from_rgba(channel(r), channel(g), channel(b), alpha) {
        paint.set_color(colour);
    }
    paint
}

fn draw_shape(pixmap: &mut Pixmap, shape: &Shape, to_pixels: Transform) {
    // A path that is empty or has a coordinate that is not finite has nothing to show.
    let Some(path) = path_of(&shape.contours) else {
        return;
    };
    if let Some((colour, opacity)) = shape.fill {
        pixmap.fill_path(
            &path,
            &paint(colour, opacity),
            FillRule::Winding,
            to_pixels,
            NO_CLIP,
        );
    }
    if let Some(stroke) = shape.stroke {
        let line = SkiaStroke {
            width: single(stroke.width),
            line_join: LineJoin::Round,
            dash: StrokeDash::new(stroke.dash.iter().map(|&d| single(d)).collect(), 0.0),
            ..SkiaStroke::default()
        };
        pixmap.stroke_path(&path, &paint(stroke.colour, 1.0), &line, to_pixels, NO_CLIP);
    }
}

fn path_of(contours: &[Contour]) -> Option<Path> {
    let mut path = PathBuilder::new();
    for contour in contours {
        match contour {
            Contour::Open(points) => push_points(&mut path, points),
            Contour::Closed(points) => {
                push_points(&mut path, points);
                path.close();
            }
            Contour::Circle {
                centre: [x, y],
                radius,
            } => {
                path.push_circle(single(*x), single(*y), single(*radius));
            }
        }
    }
    path.finish()
}

fn push_points(path: &mut PathBuilder, points: &[Point]) {
    for (index, &[x, y]) in points.iter().enumerate() {
        if index == 0 {
            path.move_to(single(x), single(y));
        } else {
            path.line_to(single(x), single(y));
        }
    }
}

fn draw_text(pixmap: &mut Pixmap, text: &Text, to_pixels: Transform) {
    let mut pen = PathPen(PathBuilder::new());
    font::outline(&text.content, text.size, &mut pen);
    // Blank text has no outline.
    let Some(path) = pen.0.finish() else { return };
    let shift = match text.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => -0.5 * font::width(&text.content, text.size),
        Anchor::End => -font::width(&text.content, text.size),
    };
    let turn = if text.upward { -90.0 } else { 0.0 };
    let place = Transform::from_translate(single(shift), 0.0)
        .post_rotate(turn)
        .post_translate(single(text.at[0]), single(text.at[1]))
        .post_concat(to_pixels);
    pixmap.fill_path(
        &path,
        &paint(text.colour, 1.0),
        FillRule::Winding,
        place,
        NO_CLIP,
    );
}

/// Collects glyph outlines in a path.
struct PathPen(PathBuilder);

impl Pen for PathPen {
    fn move_to(&mut self, [x, y]: Point) {
        self.0.move_to(single(x), single(y));
    }
    fn line_to(&mut self, [x, y]: Point) {
        self.0.line_to(single(x), single(y));
    }
    fn quad_to(&mut self, [x1, y1]: Point, [x, y]: Point) {
        self.0.quad_to(single(x1), single(y1), single(x), single(y));
    }
    fn cubic_to(&mut self, [x1, y1]: Point, [x2, y2]: Point, [x, y]: Point) {
        self.0.cubic_to(
            single(x1),
            single(y1),
            single(x2),
            single(y2),
            single(x),
            single(y),
        );
    }
    fn close(&mut self) {
        self.0.close();
    }
}
