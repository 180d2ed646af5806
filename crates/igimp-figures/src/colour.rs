//! Colours: maps for fields, a cycle for curves, greys for the furniture.
//!
//! The sequential map interpolates eleven samples of *viridis* (N. Smith and S. van der Walt, 2015,
//! CC0), the diverging one the eleven-class `RdBu` scheme of C. Brewer (`ColorBrewer`, Apache-2.0).
//! Curves use the colour-blind-safe set of M. Okabe and K. Ito (2008), without its yellow, which is
//! too pale for a line on white.

/// An opaque colour: red, green and blue, 0 to 255 (sRGB).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour(pub [u8; 3]);

impl Colour {
    /// Black, the usual colour of an exact solution.
    pub const BLACK: Self = Self([0, 0, 0]);
    /// White.
    pub const WHITE: Self = Self([255, 255, 255]);
    /// The colour of a computed curve.
    pub const CURVE: Self = Self([0, 114, 178]);
    /// The colour of failure.
    pub const FAILURE: Self = Self([213, 94, 0]);
    /// The grey of domains without a value.
    pub const NO_VALUE: Self = Self([168, 168, 168]);

    /// Text and axes.
    pub(super) const INK: Self = Self([38, 38, 38]);
    /// Notes, reference lines and section lines.
    pub(super) const FAINT_INK: Self = Self([96, 96, 96]);
    /// Grid lines behind curves and the frame of a legend.
    pub(super) const GRID: Self = Self([228, 228, 228]);
    /// Water.
    pub(super) const WATER: Self = Self([0, 92, 230]);
    /// Rigid blocks.
    pub(super) const BLOCK: Self = Self([205, 205, 205]);

    /// The `index`-th colour of the cycle for curves.
    pub(super) fn of_cycle(index: usize) -> Self {
        const CYCLE: [Colour; 7] = [
            Colour([0, 114, 178]),
            Colour([213, 94, 0]),
            Colour([0, 158, 115]),
            Colour([204, 121, 167]),
            Colour([230, 159, 0]),
            Colour([86, 180, 233]),
            Colour([64, 64, 64]),
        ];
        CYCLE[index % CYCLE.len()]
    }

    /// The `index`-th colour of the cycle for bands, chosen to look soft when translucent.
    pub(super) fn of_band(index: usize) -> Self {
        const CYCLE: [Colour; 3] = [
            Colour([130, 150, 170]),
            Colour([225, 170, 90]),
            Colour([110, 180, 150]),
        ];
        CYCLE[index % CYCLE.len()]
    }

    /// The `index`-th colour of the cycle for kinds of things: pale, so that lines over it are seen.
    pub(super) fn of_kind(index: usize) -> Self {
        const CYCLE: [Colour; 8] = [
            Colour([229, 206, 160]),
            Colour([176, 199, 220]),
            Colour([193, 213, 167]),
            Colour([224, 184, 178]),
            Colour([204, 190, 222]),
            Colour([236, 224, 143]),
            Colour([170, 212, 205]),
            Colour([198, 198, 198]),
        ];
        CYCLE[index % CYCLE.len()]
    }

    /// Mixture of two colours, `t` = 0 for `self`, 1 for `other`.
    fn mix(self, other: Self, t: f64) -> Self {
        Self(std::array::from_fn(|k| {
            let (a, b) = (f64::from(self.0[k]), f64::from(other.0[k]));
            channel(a + t * (b - a))
        }))
    }
}

/// Rounds to the nearest of 0 to 255.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to 0..=255 before"
)]
fn channel(value: f64) -> u8 {
    value.round().clamp(0.0, 255.0) as u8
}

/// How a value becomes a colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColourMap {
    /// Dark violet to yellow with evenly rising lightness (viridis).
    #[default]
    Sequential,
    /// Blue for negative over near-white to red for positive values; without a given range the
    /// colour bar is symmetric about zero.
    Diverging,
}

impl ColourMap {
    /// Colour at `t` between 0 (low end) and 1 (high end); `t` outside is clamped, NaN is grey.
    pub fn at(self, t: f64) -> Colour {
        if t.is_nan() {
            return Colour::NO_VALUE;
        }
        let anchors = self.anchors();
        let position = t.clamp(0.0, 1.0) * (anchors.len() - 1) as f64;
        let cell = (0..anchors.len() - 2)
            .take_while(|&k| (k + 1) as f64 <= position)
            .count();
        anchors[cell].mix(anchors[cell + 1], position - cell as f64)
    }

    fn anchors(self) -> &'static [Colour; 11] {
        match self {
            Self::Sequential => &[
                Colour([68, 1, 84]),
                Colour([72, 36, 117]),
                Colour([65, 68, 135]),
                Colour([53, 95, 141]),
                Colour([42, 120, 142]),
                Colour([33, 145, 140]),
                Colour([34, 168, 132]),
                Colour([68, 191, 112]),
                Colour([122, 209, 81]),
                Colour([189, 223, 38]),
                Colour([253, 231, 37]),
            ],
            Self::Diverging => &[
                Colour([5, 48, 97]),
                Colour([33, 102, 172]),
                Colour([67, 147, 195]),
                Colour([146, 197, 222]),
                Colour([209, 229, 240]),
                Colour([247, 247, 247]),
                Colour([253, 219, 199]),
                Colour([244, 165, 130]),
                Colour([214, 96, 77]),
                Colour([178, 24, 43]),
                Colour([103, 0, 31]),
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn luminance(Colour(rgb): Colour) -> f64 {
        let linear = rgb.map(|c| (f64::from(c) / 255.0).powf(2.2));
        0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    }

    #[test]
    fn maps_start_and_end_where_they_should() {
        assert_eq!(ColourMap::Sequential.at(0.0), Colour([68, 1, 84]));
        assert_eq!(ColourMap::Sequential.at(1.0), Colour([253, 231, 37]));
        assert_eq!(ColourMap::Diverging.at(0.0), Colour([5, 48, 97]));
        assert_eq!(ColourMap::Diverging.at(0.5), Colour([247, 247, 247]));
        assert_eq!(ColourMap::Diverging.at(1.0), Colour([103, 0, 31]));
    }

    #[test]
    fn values_outside_are_clamped_and_nan_is_grey() {
        assert_eq!(
            ColourMap::Sequential.at(-3.0),
            ColourMap::Sequential.at(0.0)
        );
        assert_eq!(
            ColourMap::Sequential.at(f64::INFINITY),
            ColourMap::Sequential.at(1.0)
        );
        assert_eq!(ColourMap::Sequential.at(f64::NAN), Colour::NO_VALUE);
    }

    #[test]
    fn luminance_rises_along_the_sequential_map() {
        let levels: Vec<f64> = (0..=100)
            .map(|k| luminance(ColourMap::Sequential.at(f64::from(k) / 100.0)))
            .collect();
        assert!(
            levels.windows(2).all(|pair| pair[1] >= pair[0]),
            "{levels:?}"
        );
    }

    #[test]
    fn luminance_of_the_diverging_map_peaks_in_the_middle() {
        let level = |k: i32| luminance(ColourMap::Diverging.at(f64::from(k) / 100.0));
        assert!((0..50).all(|k| level(k + 1) >= level(k)));
        assert!((50..100).all(|k| level(k + 1) <= level(k)));
    }
}
