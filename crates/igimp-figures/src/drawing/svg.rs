//! A drawing as an SVG document.
//!
//! Shapes of one colour become one path element, coordinates carry two decimals, and nothing has an
//! `id`, so several figures can be embedded in one page. Text stays text: it can be searched and
//! edited. The font list names the font of the PNG first and Verdana, of nearly equal widths, next.

use std::fmt::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::{Anchor, Contour, Drawing, Item, Shape, Stroke, Text, font, raster};
use crate::colour::Colour;
use crate::drawing::Image;
use crate::geometry::{Point, Rect};

/// The whole document.
pub(crate) fn document(drawing: &Drawing) -> String {
    let mut out = String::with_capacity(4096);
    let (width, height) = (decimal(drawing.width), decimal(drawing.height));
    push(
        &mut out,
        format_args!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" role=\"img\" \
             font-family=\"'DejaVu Sans', Verdana, sans-serif\">\n<title>{}</title>\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n",
            font::runs(&drawing.title)
                .iter()
                .map(|run| escaped(run.text))
                .collect::<String>()
        ),
    );
    for item in &drawing.items {
        match item {
            Item::Shape(shape) => push_shape(&mut out, shape),
            Item::Text(text) => push_text(&mut out, text),
            Item::Image(image) => push_image(&mut out, image),
        }
    }
    out.push_str("</svg>\n");
    out
}

fn push(out: &mut String, arguments: std::fmt::Arguments<'_>) {
    out.write_fmt(arguments)
        .expect("invariant: writing to a String cannot fail");
}

fn push_shape(out: &mut String, shape: &Shape) {
    out.push_str("<path d=\"");
    for contour in &shape.contours {
        match contour {
            Contour::Open(points) => push_points(out, points),
            Contour::Closed(points) => {
                push_points(out, points);
                out.push('z');
            }
            Contour::Circle {
                centre: [x, y],
                radius,
            } => {
                let (start, r, d) = (decimal(x - radius), decimal(*radius), decimal(2.0 * radius));
                let y = decimal(*y);
                push(
                    out,
                    format_args!("M{start} {y}a{r} {r} 0 1 1 {d} 0a{r} {r} 0 1 1 -{d} 0z"),
                );
            }
        }
    }
    out.push('"');
    match shape.fill {
        Some((colour, opacity)) => {
            push(out, format_args!(" fill=\"{}\"", hex(colour)));
            if opacity < 1.0 {
                push(out, format_args!(" fill-opacity=\"{}\"", decimal(opacity)));
            }
        }
        None => out.push_str(" fill=\"none\""),
    }
    if let Some(stroke) = shape.stroke {
        push_stroke(out, stroke);
    }
    out.push_str("/>\n");
}

/// The first point absolute, the others relative, with `h` and `v` for level and upright sides.
fn push_points(out: &mut String, points: &[Point]) {
    // Steps are taken between rounded points, so rounding does not add up along a long line.
    let mut from = [0_i64; 2];
    for (index, point) in points.iter().enumerate() {
        let to = point.map(hundredths);
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        if index == 0 {
            push(
                out,
                format_args!("M{} {}", Hundredths(to[0]), Hundredths(to[1])),
            );
        } else if dx == 0 {
            push(out, format_args!("v{}", Hundredths(dy)));
        } else if dy == 0 {
            push(out, format_args!("h{}", Hundredths(dx)));
        } else {
            push(out, format_args!("l{} {}", Hundredths(dx), Hundredths(dy)));
        }
        from = to;
    }
}

fn push_stroke(out: &mut String, stroke: Stroke) {
    let (colour, width) = (hex(stroke.colour), decimal(stroke.width));
    push(
        out,
        format_args!(" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linejoin=\"round\""),
    );
    if !stroke.dash.is_empty() {
        let dash: Vec<_> = stroke
            .dash
            .iter()
            .map(|&length| decimal(length).to_string())
            .collect();
        push(
            out,
            format_args!(" stroke-dasharray=\"{}\"", dash.join(" ")),
        );
    }
}

fn push_text(out: &mut String, text: &Text) {
    let (x, y) = (decimal(text.at[0]), decimal(text.at[1]));
    let size = decimal(text.size);
    push(
        out,
        format_args!("<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\""),
    );
    match text.anchor {
        Anchor::Start => {}
        Anchor::Middle => out.push_str(" text-anchor=\"middle\""),
        Anchor::End => out.push_str(" text-anchor=\"end\""),
    }
    if text.upward {
        push(out, format_args!(" transform=\"rotate(-90 {x} {y})\""));
    }
    push(out, format_args!(" fill=\"{}\">", hex(text.colour)));
    let runs = font::runs(&text.content);
    if runs.len() == 1 && !text.content.ends_with('}') {
        out.push_str(&escaped(&text.content));
    } else {
        let mut rise = 0.0;
        for run in runs {
            // Each run says how far it lies below the one before it.
            let (down, size) = ((rise - run.rise) * text.size, run.scale * text.size);
            let (down, size, content) = (decimal(down), decimal(size), escaped(run.text));
            push(
                out,
                format_args!("<tspan dy=\"{down}\" font-size=\"{size}\">{content}</tspan>"),
            );
            rise = run.rise;
        }
    }
    out.push_str("</text>\n");
}

/// Pixels, as a PNG within the document.
fn push_image(out: &mut String, image: &Image) {
    let Some(png) = raster::image_png(image) else {
        return;
    };
    let Rect { left, top, .. } = image.area;
    let (x, y) = (decimal(left), decimal(top));
    let (width, height) = (decimal(image.area.width()), decimal(image.area.height()));
    let data = STANDARD.encode(png);
    push(
        out,
        format_args!(
            "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" \
             href=\"data:image/png;base64,{data}\"/>\n"
        ),
    );
}

fn hex(Colour([r, g, b]): Colour) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// The text with the signs that XML reserves replaced, and those it forbids marked as unknown.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            c if c.is_control() => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "coordinates are far below 2^63"
)]
fn hundredths(value: f64) -> i64 {
    (value * 100.0).round() as i64
}

fn decimal(value: f64) -> Hundredths {
    Hundredths(hundredths(value))
}

/// A number of hundredths, printed without needless zeros.
#[derive(Clone, Copy)]
struct Hundredths(i64);

impl std::fmt::Display for Hundredths {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let sign = if self.0 < 0 { "-" } else { "" };
        let (whole, part) = (self.0.abs() / 100, self.0.abs() % 100);
        match part {
            0 => write!(f, "{sign}{whole}"),
            _ if part % 10 == 0 => write!(f, "{sign}{whole}.{}", part / 10),
            _ => write!(f, "{sign}{whole}.{part:02}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let text = |v: f64| decimal(v).to_string();
        assert_eq!(
            [0.0, 1.0, -0.5, 12.345, 0.05, -3.0].map(text),
            ["0", "1", "-0.5", "12.35", "0.05", "-3"]
        );
    }

    #[test]
    fn paths_are_relative_and_do_not_drift() {
        let mut out = String::new();
        push_points(
            &mut out,
            &[[1.0, 1.0], [3.004, 1.0], [3.004, 4.0], [5.008, 6.0]],
        );
        assert_eq!(out, "M1 1h2v3l2.01 2");
    }

    #[test]
    fn reserved_signs_are_escaped() {
        assert_eq!(escaped("a < b & c\u{1}"), "a &lt; b &amp; c\u{fffd}");
    }
}
