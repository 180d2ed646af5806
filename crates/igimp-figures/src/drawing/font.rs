//! The bundled font: text widths for the layout, glyph outlines for the PNG.
//!
//! `DejaVu` Sans is compiled in, so a PNG looks the same on a machine without fonts. It holds Greek,
//! superscript digits and the mathematical signs of the labels. Text runs left to right, one glyph
//! per character, with pair kerning, and `_{...}` and `^{...}` for indices and powers: all that labels
//! of figures need.
//!
//! The font is free to embed under the Bitstream Vera licence; its notice is part of the `dejavu` crate.

use std::sync::LazyLock;

use ttf_parser::{Face, GlyphId, OutlineBuilder};

use crate::geometry::Point;

static FACE: LazyLock<Face<'static>> = LazyLock::new(|| {
    Face::parse(dejavu::sans::regular(), 0).expect("invariant: the bundled font is well-formed")
});

/// Height of a capital letter over the font size.
pub(crate) const CAP_HEIGHT: f64 = 0.729;
/// Distance of two lines of text over the font size.
pub(crate) const LINE_HEIGHT: f64 = 1.25;

/// Part of a text on one level.
#[derive(Debug, PartialEq)]
pub(crate) struct TextRun<'a> {
    pub(crate) text: &'a str,
    /// Font size over that of the text.
    pub(crate) scale: f64,
    /// Height of its baseline over the font size of the text.
    pub(crate) rise: f64,
}

/// Splits a text at its markup: `_{...}` is written low, `^{...}` high, both small.
pub(crate) fn runs(text: &str) -> Vec<TextRun<'_>> {
    let mut runs = Vec::new();
    let mut level = |text, scale, rise| runs.push(TextRun { text, scale, rise });
    let mut rest = text;
    let next = |rest: &str| {
        let start = [rest.find("_{"), rest.find("^{")]
            .into_iter()
            .flatten()
            .min()?;
        Some((start, start + rest[start..].find('}')?))
    };
    while let Some((start, end)) = next(rest) {
        let rise = if rest[start..].starts_with('_') {
            -0.16
        } else {
            0.36
        };
        if start > 0 {
            level(&rest[..start], 1.0, 0.0);
        }
        level(&rest[start + 2..end], 0.7, rise);
        rest = &rest[end + 1..];
    }
    if !rest.is_empty() {
        level(rest, 1.0, 0.0);
    }
    runs
}

/// One letter of a text: glyph, place \[pt\] of its origin (y down), size \[pt\].
struct Letter {
    glyph: GlyphId,
    at: Point,
    size: f64,
}

/// The letters of a text from the origin to the right, and the total width \[pt\].
fn shape(text: &str, size: f64) -> (Vec<Letter>, f64) {
    let units = f64::from(FACE.units_per_em());
    let mut letters = Vec::new();
    let mut pen = 0.0;
    for run in runs(text) {
        let size = size * run.scale;
        let y = -run.rise * size / run.scale;
        let mut before = None;
        for letter in run.text.chars() {
            let glyph = FACE.glyph_index(letter).unwrap_or(GlyphId(0));
            pen += before.map_or(0.0, |before| kerning(before, glyph)) * size / units;
            letters.push(Letter {
                glyph,
                at: [pen, y],
                size,
            });
            pen += f64::from(FACE.glyph_hor_advance(glyph).unwrap_or(0)) * size / units;
            before = Some(glyph);
        }
    }
    (letters, pen)
}

/// Change of the distance of two neighbouring glyphs \[font unit\].
fn kerning(left: GlyphId, right: GlyphId) -> f64 {
    let tables = FACE
        .tables()
        .kern
        .into_iter()
        .flat_map(|kern| kern.subtables);
    let shift = tables
        .filter(|table| table.horizontal && !table.variable)
        .find_map(|table| table.glyphs_kerning(left, right));
    f64::from(shift.unwrap_or(0))
}

/// Width \[pt\] of one line of text.
pub(crate) fn width(text: &str, size: f64) -> f64 {
    shape(text, size).1
}

/// Breaks a text at spaces into lines no wider than `limit` \[pt\]; a longer word stays whole.
pub(crate) fn wrap(text: &str, size: f64, limit: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        if let Some(line) = lines.last_mut() {
            let longer = format!("{line} {word}");
            if width(&longer, size) <= limit {
                *line = longer;
                continue;
            }
        }
        lines.push(word.to_owned());
    }
    lines
}

/// A pen that receives glyph outlines in picture coordinates relative to the start of the text.
pub(crate) trait Pen {
    fn move_to(&mut self, to: Point);
    fn line_to(&mut self, to: Point);
    fn quad_to(&mut self, control: Point, to: Point);
    fn cubic_to(&mut self, first: Point, second: Point, to: Point);
    fn close(&mut self);
}

/// Draws one line of text with the given pen, baseline at y = 0, start at x = 0.
pub(crate) fn outline(text: &str, size: f64, pen: &mut impl Pen) {
    for letter in shape(text, size).0 {
        let scale = letter.size / f64::from(FACE.units_per_em());
        FACE.outline_glyph(
            letter.glyph,
            &mut Placed {
                pen,
                at: letter.at,
                scale,
            },
        );
    }
}

/// Moves an outline from font units (y up) to its place in the text (y down).
struct Placed<'a, P> {
    pen: &'a mut P,
    at: Point,
    scale: f64,
}

impl<P> Placed<'_, P> {
    fn place(&self, x: f32, y: f32) -> Point {
        [
            self.at[0] + self.scale * f64::from(x),
            self.at[1] - self.scale * f64::from(y),
        ]
    }
}

impl<P: Pen> OutlineBuilder for Placed<'_, P> {
    fn move_to(&mut self, x: f32, y: f32) {
        self.pen.move_to(self.place(x, y));
    }
    fn line_to(&mut self, x: f32, y: f32) {
        self.pen.line_to(self.place(x, y));
    }
    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.pen.quad_to(self.place(x1, y1), self.place(x, y));
    }
    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.pen
            .cubic_to(self.place(x1, y1), self.place(x2, y2), self.place(x, y));
    }
    fn close(&mut self) {
        self.pen.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sign_of_our_labels_is_in_the_font() {
        for letter in "σγδφτεψλνρκπΔΣ²³·×−⁻⁰¹⁴⁵≤≥°½±‖→ᵤ\u{2009}".chars()
        {
            assert!(FACE.glyph_index(letter).is_some(), "{letter} is missing");
        }
    }

    #[test]
    fn width_grows_with_text_and_size() {
        assert!(width("", 10.0).abs() < 1e-12);
        assert!(width("stress", 10.0) < width("stress σ", 10.0));
        assert!((width("stress", 20.0) - 2.0 * width("stress", 10.0)).abs() < 1e-9);
    }

    #[test]
    fn kerning_is_used() {
        assert!(width("AV", 10.0) < width("A", 10.0) + width("V", 10.0));
    }

    #[test]
    fn markup_makes_levels() {
        let levels = |text| {
            runs(text)
                .into_iter()
                .map(|r| (r.text, r.rise))
                .collect::<Vec<_>>()
        };
        assert_eq!(
            levels("σ_{yy} = 10^{−3}"),
            [("σ", 0.0), ("yy", -0.16), (" = 10", 0.0), ("−3", 0.36)]
        );
        assert_eq!(levels("a_b ^{c"), [("a_b ^{c", 0.0)]);
        assert!(levels("").is_empty());
        assert!(width("σ_{yy}", 10.0) < width("σyy", 10.0));
    }

    #[test]
    fn long_text_is_wrapped_at_spaces() {
        let lines = wrap("bearing pressure over the undrained strength", 12.0, 120.0);
        assert!(lines.len() > 1);
        assert_eq!(
            lines.join(" "),
            "bearing pressure over the undrained strength"
        );
        assert!(lines.iter().all(|line| width(line, 12.0) <= 120.0));
        assert!(wrap("  ", 12.0, 10.0).is_empty());
    }
}
