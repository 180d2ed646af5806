//! Pictures one after another as an animated GIF, which browsers, documents and presentations play by themselves.
//!
//! All frames share a palette of the colours that they use most, and each holds the rectangle that differs from the one before.

use std::collections::HashMap;

use gif::{DisposalMethod, Encoder, Repeat};

use crate::FigureError;
use crate::drawing::Rgb;

/// Colours of the palette; one entry more says that a pixel stays as it was.
const COLOURS: usize = 255;
const UNCHANGED: u8 = 255;

/// Shortest time that players keep to, and longest that a frame can stay \[s\].
pub const STAYS: [f64; 2] = [0.02, 655.35];

/// The bytes of a film: frames of one size, each with the time that it stays \[s\]. It begins anew after its end.
///
/// # Errors
/// [`FigureError::MixedFilm`] without frames, or for frames of different sizes; [`FigureError::TooLarge`] beyond 65 535 pixels;
/// [`FigureError::EncodeFilm`].
pub fn film(frames: &[(Rgb, f64)]) -> Result<Vec<u8>, FigureError> {
    let size = |rgb: &Rgb| (rgb.width, rgb.height);
    let mixed = || FigureError::MixedFilm {
        frames: frames.len(),
    };
    let (width, height) = frames.first().map(|(rgb, _)| size(rgb)).ok_or_else(mixed)?;
    if frames.iter().any(|(rgb, _)| size(rgb) != (width, height)) {
        return Err(mixed());
    }
    let sides = u16::try_from(width).ok().zip(u16::try_from(height).ok());
    let (columns, rows) = sides.ok_or(FigureError::TooLarge { width, height })?;
    let palette = Palette::of(frames.iter().map(|(rgb, _)| rgb));
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, columns, rows, &palette.bytes())?;
    encoder.set_repeat(Repeat::Infinite)?;
    let mut nearest = HashMap::new();
    let mut before: Option<Vec<u8>> = None;
    let mut clock = Clock::default();
    for (rgb, stays) in frames {
        let pixels: Vec<u8> = (rgb.pixels.iter())
            .map(|pixel| {
                *nearest
                    .entry(*pixel)
                    .or_insert_with(|| palette.nearest(*pixel))
            })
            .collect();
        let mut frame = changed(before.as_deref(), &pixels, usize::from(columns));
        frame.delay = clock.delay(*stays);
        encoder.write_frame(&frame)?;
        before = Some(pixels);
    }
    drop(encoder);
    Ok(bytes)
}

/// Times in hundredths of a second whose sum does not drift from that of the times that are asked for.
#[derive(Default)]
struct Clock {
    wanted: f64,
    given: f64,
}

impl Clock {
    fn delay(&mut self, stays: f64) -> u16 {
        self.wanted += 100.0 * stays;
        let time = (self.wanted - self.given)
            .round()
            .clamp(100.0 * STAYS[0], f64::from(u16::MAX));
        self.given += time;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "it is clamped to the range"
        )]
        let delay = time as u16;
        delay
    }
}

/// The colours of a film.
struct Palette {
    colours: Vec<[u8; 3]>,
}

impl Palette {
    /// The colours that pictures use most, in an order that depends on them alone.
    fn of<'a>(pictures: impl Iterator<Item = &'a Rgb>) -> Self {
        let mut counts: HashMap<[u8; 3], usize> = HashMap::new();
        for pixel in pictures.flat_map(|rgb| &rgb.pixels) {
            *counts.entry(*pixel).or_default() += 1;
        }
        let mut counted: Vec<([u8; 3], usize)> = counts.into_iter().collect();
        counted.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
        counted.truncate(COLOURS);
        Self {
            colours: counted.into_iter().map(|(colour, _)| colour).collect(),
        }
    }

    fn nearest(&self, pixel: [u8; 3]) -> u8 {
        let distance = |rgb: &[u8; 3]| -> u32 {
            let apart = std::iter::zip(rgb, pixel).map(|(&a, b)| u32::from(a.abs_diff(b)).pow(2));
            apart.sum()
        };
        let all = (0..=u8::MAX).zip(&self.colours);
        let found = all.min_by_key(|(_, rgb)| distance(rgb));
        found.map_or(0, |(k, _)| k)
    }

    /// Red, green and blue of all entries, that of unchanged pixels among them.
    fn bytes(&self) -> Vec<u8> {
        let mut bytes = self.colours.concat();
        bytes.resize(3 * (COLOURS + 1), 0);
        bytes
    }
}

/// The rectangle that differs from the frame before, with pixels that stay as they were left out.
fn changed(before: Option<&[u8]>, pixels: &[u8], columns: usize) -> gif::Frame<'static> {
    let rows = pixels.len() / columns;
    let differs = |k: usize| before.is_none_or(|before| before[k] != pixels[k]);
    let is_other_row = |row: &usize| (0..columns).any(|column| differs(row * columns + column));
    let is_other_column = |column: &usize| (0..rows).any(|row| differs(row * columns + column));
    // A frame that is like the one before has one pixel, that it may stay its time.
    let top = (0..rows).find(is_other_row).unwrap_or(0);
    let bottom = (0..rows).rfind(is_other_row).unwrap_or(0);
    let left = (0..columns).find(is_other_column).unwrap_or(0);
    let right = (0..columns).rfind(is_other_column).unwrap_or(0);
    let places =
        (top..=bottom).flat_map(|row| (left..=right).map(move |column| row * columns + column));
    let buffer: Vec<u8> = places
        .map(|k| if differs(k) { pixels[k] } else { UNCHANGED })
        .collect();
    let side = |from: usize, to: usize| u16::try_from(to - from + 1).unwrap_or(u16::MAX);
    gif::Frame {
        left: u16::try_from(left).unwrap_or(u16::MAX),
        top: u16::try_from(top).unwrap_or(u16::MAX),
        width: side(left, right),
        height: side(top, bottom),
        dispose: DisposalMethod::Keep,
        transparent: Some(UNCHANGED),
        buffer: buffer.into(),
        ..gif::Frame::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(pixels: Vec<[u8; 3]>) -> Rgb {
        Rgb {
            width: 4,
            height: 3,
            pixels,
        }
    }

    /// The frames of a film as a player shows them, each with the time that it stays \[1/100 s\].
    fn played(bytes: &[u8]) -> Vec<(Vec<[u8; 3]>, u16)> {
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(bytes).unwrap();
        let columns = usize::from(decoder.width());
        let mut screen = vec![[0; 3]; columns * usize::from(decoder.height())];
        let mut all = Vec::new();
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            let width = usize::from(frame.width);
            for (k, rgba) in frame.buffer.as_chunks::<4>().0.iter().enumerate() {
                let row = usize::from(frame.top) + k / width;
                let column = usize::from(frame.left) + k % width;
                if rgba[3] > 0 {
                    screen[row * columns + column] = [rgba[0], rgba[1], rgba[2]];
                }
            }
            all.push((screen.clone(), frame.delay));
        }
        all
    }

    /// GOAL: a player shows the pictures as they were drawn, for as long as was asked.
    /// ORACLE: the reader of the `gif` crate, played by hand.
    #[test]
    fn a_film_plays_its_pictures() {
        let first: Vec<[u8; 3]> = (0..12).map(|k| [k, 10 * k, 255 - k]).collect();
        let mut second = first.clone();
        second[5] = [9, 9, 9];
        second[6] = [200, 0, 0];
        let frames = [
            (picture(first.clone()), 0.104),
            (picture(second.clone()), 0.104),
            (picture(second.clone()), 0.104),
            (picture(first.clone()), 2.0),
        ];
        let played = played(&film(&frames).unwrap());
        let expected = [&first, &second, &second, &first];
        for ((shown, _), wanted) in std::iter::zip(&played, expected) {
            assert_eq!(shown, wanted);
        }
        // The rest of a hundredth is not lost: 10.4, 20.8, 31.2, 231.2.
        let delays: Vec<u16> = played.iter().map(|(_, delay)| *delay).collect();
        assert_eq!(delays, [10, 11, 10, 200]);
    }

    #[test]
    fn many_colours_become_the_nearest_that_are_used_most() {
        let mut pixels: Vec<[u8; 3]> = (0..=255).map(|k| [k, k, k]).collect();
        pixels.extend((1..=255).map(|k| [k, k, k]));
        pixels.push([1, 0, 0]);
        let rgb = Rgb {
            width: 512,
            height: 1,
            pixels,
        };
        let palette = Palette::of(std::iter::once(&rgb));
        assert_eq!(palette.colours.len(), COLOURS);
        let shown = |pixel| palette.colours[usize::from(palette.nearest(pixel))];
        assert_eq!(shown([128; 3]), [128; 3]);
        assert_eq!(shown([0; 3]), [1; 3]);
    }

    #[test]
    fn frames_of_different_sizes_are_refused() {
        let small = Rgb {
            width: 1,
            height: 1,
            pixels: vec![[0; 3]],
        };
        let frames = [(picture(vec![[0; 3]; 12]), 0.1), (small, 0.1)];
        assert!(matches!(
            film(&frames),
            Err(FigureError::MixedFilm { frames: 2 })
        ));
        assert!(matches!(
            film(&[]),
            Err(FigureError::MixedFilm { frames: 0 })
        ));
    }
}
