//! One axis: its range, and the way from a value to a place in the picture.

pub(crate) mod ticks;

use crate::drawing::font;
use ticks::Ticks;

/// How values spread along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps for equal differences.
    #[default]
    Linear,
    /// Equal steps for equal ratios (base 10); values that are not positive are left out.
    Log,
}

impl Scale {
    /// The coordinate in which the axis is uniform; `None` for values it cannot show.
    fn uniform(self, value: f64) -> Option<f64> {
        match self {
            Self::Linear => drawable(value).then_some(value),
            Self::Log => (1e-100..1e100).contains(&value).then(|| value.log10()),
        }
    }

    /// Whether a value has a place on such an axis.
    pub(super) fn shows(self, value: f64) -> bool {
        self.uniform(value).is_some()
    }

    /// Whether both ends can be shown and differ.
    #[must_use]
    pub fn accepts(self, (from, to): (f64, f64)) -> bool {
        match (self.uniform(from), self.uniform(to)) {
            (Some(a), Some(b)) => visibly_apart(a, b),
            _ => false,
        }
    }

    /// A range that shows all the values with a little air; zero stays at the edge if it is close.
    /// `None` when no value can be shown.
    pub(super) fn range_of(self, values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
        let (low, high) = extent(values.filter_map(|v| self.uniform(v)))?;
        if self == Self::Log {
            let air = if high - low < 1e-9 {
                0.3
            } else {
                0.05 * (high - low)
            };
            return Some((10.0_f64.powf(low - air), 10.0_f64.powf(high + air)));
        }
        let (low, high) = widened(low, high);
        let air = 0.04 * (high - low);
        let near_zero = 0.2 * (high - low);
        let from = if (0.0..=near_zero).contains(&low) {
            0.0
        } else {
            low - air
        };
        let to = if (-near_zero..=0.0).contains(&high) {
            0.0
        } else {
            high + air
        };
        Some((from, to))
    }
}

/// Whether a value can take part in a picture: a number, and far from overflow.
pub(super) fn drawable(value: f64) -> bool {
    value.abs() < 1e100
}

/// Whether two values differ by more than rounding, and by enough to compute with.
fn visibly_apart(a: f64, b: f64) -> bool {
    (a - b).abs() > (1e-9 * a.abs().max(b.abs())).max(1e-100)
}

/// Smallest and largest of the drawable values.
pub(super) fn extent(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.filter(|&v| drawable(v)).fold(None, |range, v| {
        let (low, high) = range.unwrap_or((v, v));
        Some((low.min(v), high.max(v)))
    })
}

/// The same range, or one of visible width about it when the values are equal but for rounding.
pub(super) fn widened(low: f64, high: f64) -> (f64, f64) {
    if visibly_apart(low, high) {
        return (low, high);
    }
    let size = low.abs().max(high.abs());
    let half = if size > 1e-99 { 0.1 * size } else { 1.0 };
    (low - half, high + half)
}

/// An axis along a side of the plot area.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    /// Spread of the values.
    pub(super) scale: Scale,
    /// Values at the start (left, bottom) and the end (right, top).
    pub(super) range: (f64, f64),
    /// Places \[pt\] of the start and the end.
    pub(super) span: (f64, f64),
}

impl Axis {
    /// Place \[pt\] of a value; `None` if the axis cannot show it.
    pub(super) fn place(&self, value: f64) -> Option<f64> {
        let value = self.scale.uniform(value)?;
        let (from, to) = (
            self.scale.uniform(self.range.0)?,
            self.scale.uniform(self.range.1)?,
        );
        Some(self.span.0 + (value - from) / (to - from) * (self.span.1 - self.span.0))
    }

    /// As many ticks as fit without crowding when labels of the given font size stand side by side.
    pub(super) fn ticks_beside(&self, size: f64) -> Ticks {
        self.densest(10, |label| font::width(label, size) + 1.3 * size)
    }

    /// As many ticks as fit without crowding when the labels stand above each other.
    pub(super) fn ticks_stacked(&self, size: f64) -> Ticks {
        self.densest(10, |_| 1.8 * size)
    }

    fn densest(&self, most: usize, room: impl Fn(&str) -> f64) -> Ticks {
        let (low, high) = (
            self.range.0.min(self.range.1),
            self.range.0.max(self.range.1),
        );
        let fits = |ticks: &Ticks| {
            ticks.major.windows(2).all(|pair| {
                let gap = self
                    .place(pair[1].0)
                    .zip(self.place(pair[0].0))
                    .map(|(b, a)| (b - a).abs());
                gap.is_some_and(|gap| gap >= 0.5 * (room(&pair[0].1) + room(&pair[1].1)))
            })
        };
        let ticks_of = |count| match self.scale {
            Scale::Linear => ticks::linear(low, high, count),
            Scale::Log => ticks::logarithmic(low, high, count),
        };
        (1..=most)
            .rev()
            .map(ticks_of)
            .find(fits)
            .unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_land_between_the_ends() {
        let axis = Axis {
            scale: Scale::Linear,
            range: (0.0, 4.0),
            span: (10.0, 50.0),
        };
        assert_eq!(axis.place(1.0), Some(20.0));
        assert_eq!(axis.place(f64::NAN), None);
        let axis = Axis {
            scale: Scale::Log,
            range: (1.0, 100.0),
            span: (300.0, 100.0),
        };
        assert_eq!(axis.place(10.0), Some(200.0));
        assert_eq!(axis.place(0.0), None);
    }

    #[test]
    fn a_reversed_range_turns_the_axis_round() {
        let axis = Axis {
            scale: Scale::Linear,
            range: (10.0, 0.0),
            span: (0.0, 100.0),
        };
        assert_eq!(axis.place(10.0), Some(0.0));
        assert!(!axis.ticks_stacked(10.0).major.is_empty());
    }

    #[test]
    fn automatic_ranges_have_air_and_keep_zero() {
        assert_eq!(
            Scale::Linear.range_of([0.0, 5.0, 10.0].into_iter()),
            Some((0.0, 10.4))
        );
        assert_eq!(
            Scale::Linear.range_of([100.0, 110.0].into_iter()),
            Some((99.6, 110.4))
        );
        assert_eq!(Scale::Linear.range_of([f64::NAN].into_iter()), None);
        let (low, high) = Scale::Linear.range_of([3.0, 3.0].into_iter()).unwrap();
        assert!(low < 3.0 && high > 3.0);
        let (low, high) = Scale::Log.range_of([-1.0, 0.01, 1.0].into_iter()).unwrap();
        assert!(low < 0.01 && low > 0.005 && high > 1.0);
    }

    #[test]
    fn labels_never_crowd() {
        let axis = Axis {
            scale: Scale::Linear,
            range: (0.0, 1.0),
            span: (0.0, 60.0),
        };
        assert!(axis.ticks_beside(11.0).major.len() <= 3);
    }
}
