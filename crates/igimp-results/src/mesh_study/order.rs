//! The order of convergence: which are possible beforehand, and which the values on three meshes leave.
//!
//! Pure functions of numbers; theory, eqs. (40b) to (40d).

use igimp_text::short;
use serde::{Deserialize, Serialize};

use super::Computed;

/// Order at which limit loads and factors of safety of perfect plasticity converge \[-\].
pub(super) const USUAL: f64 = 1.0;
/// The largest order that is thought possible \[-\].
pub(super) const FASTEST: f64 = 2.0;
/// Orders among which an observed one is looked for \[-\].
const SOUGHT: [f64; 2] = [1e-3, 16.0];

/// Prior knowledge of how a result converges (theory, eq. 40c).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Convergence {
    /// The least order that is thought possible \[-\].
    pub(super) slowest: f64,
    /// Whether the size of the value falls as cells become smaller.
    pub(super) falls: bool,
    /// The least uncertainty, as a share of the value \[-\].
    pub(super) least: f64,
}

impl Convergence {
    /// Factors of safety and limit loads of soil alone, of one strength in each of its parts.
    pub const SOIL: Self = Self {
        slowest: 2.0 / 3.0,
        falls: true,
        least: 0.0,
    };
    /// The same of soil whose strength varies from place to place: mechanisms are thin where it is weak.
    pub const VARIED_SOIL: Self = Self {
        slowest: 0.5,
        ..Self::SOIL
    };
    /// Resistance of a footing that holds nodes: its width on the grid changes with the cells too.
    pub const FOOTING: Self = Self {
        slowest: 0.5,
        falls: false,
        least: 0.0,
    };
    /// Results with contact or reinforcement, where no order was seen throughout.
    pub const CONTACT: Self = Self {
        slowest: 1.0 / 3.0,
        falls: false,
        least: 0.03,
    };
    /// Everything else, such as stress and displacement at a place.
    pub const OTHER: Self = Self::FOOTING;

    /// The same of a load that is lowered until soil fails, such as a support: finer cells fail at more of it.
    #[must_use]
    pub fn of_lowered_load(self) -> Self {
        Self {
            falls: false,
            ..self
        }
    }

    /// The same with another least order \[-\], and no least uncertainty.
    #[must_use]
    pub fn with_slowest(self, slowest: f64) -> Self {
        Self {
            slowest,
            least: 0.0,
            ..self
        }
    }
}

/// The order of convergence, as far as it is known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Order {
    /// Two meshes tell none: it was taken as 1.
    Assumed {
        /// The least order that the uncertainty allows for \[-\].
        slowest: f64,
    },
    /// Observed on three meshes, and used.
    Observed(f64),
    /// Observed outside the orders thought possible (0 and less would not be observed), and not believed.
    Limited {
        /// The observed order \[-\].
        observed: f64,
        /// The order used in its place \[-\].
        used: f64,
    },
    /// Three meshes on which the values, within the intervals in which they were found, may follow orders between
    /// two: the one nearest to 1 was taken.
    Admitted {
        /// The least of them \[-\].
        from: f64,
        /// The largest \[-\].
        to: f64,
    },
    /// The value rises with smaller cells where that of soil falls: nothing is extrapolated.
    Rising,
    /// The values go up and down: nothing is extrapolated.
    Oscillating,
    /// The values differ the more, the finer the mesh: nothing is extrapolated.
    Diverging,
}

impl Order {
    /// The order used in an extrapolation; none where none is made.
    pub(super) fn used(self) -> Option<f64> {
        match self {
            Self::Assumed { .. } => Some(USUAL),
            Self::Observed(p) => Some(p),
            Self::Limited { used, .. } => Some(used),
            Self::Admitted { from, to } => Some(USUAL.clamp(from, to)),
            Self::Rising | Self::Oscillating | Self::Diverging => None,
        }
    }

    /// In words for a table.
    pub fn sentence(self) -> String {
        let two = |value: f64| format!("{value:.2}");
        match self {
            Self::Assumed { slowest } => {
                format!(
                    "1, assumed; {} to {FASTEST} allowed for",
                    short(rounded(slowest))
                )
            }
            Self::Observed(p) => format!("{}, observed", two(p)),
            Self::Limited { observed, used } if observed < used => {
                format!("below {0}: {0} taken", short(rounded(used)))
            }
            Self::Limited { used, .. } => format!("above {used}: {used} taken"),
            Self::Admitted { from, to } => format!(
                "{}, within the search: {} to {}",
                short(rounded(USUAL.clamp(from, to))),
                two(from),
                two(to)
            ),
            Self::Rising => "none: rises with smaller cells".to_owned(),
            Self::Oscillating => "none: up and down".to_owned(),
            Self::Diverging => "none: no convergence seen".to_owned(),
        }
    }

    /// A warning for values that do not converge as expected.
    pub fn remark(self) -> Option<&'static str> {
        match self {
            Self::Rising => Some(
                "the value rises as the cells become smaller, where that of soil falls: two errors cancel, or the \
                 meshes fail in different ways. Nothing is extrapolated, and the uncertainty is that of a single mesh",
            ),
            Self::Oscillating => Some(
                "the value goes up and down as the cells become smaller: the meshes fail in different ways, or are \
                 too coarse. Nothing is extrapolated",
            ),
            Self::Diverging => Some(
                "the value changes the more, the smaller the cells: there is nothing that it converges to on these \
                 meshes. Nothing is extrapolated",
            ),
            Self::Limited { observed, used } if observed < used => Some(
                "the value hardly converges as the cells become smaller: all that is extrapolated is in doubt",
            ),
            _ => None,
        }
    }
}

/// An order with two digits.
fn rounded(p: f64) -> f64 {
    (100.0 * p).round() / 100.0
}

/// The remaining change of a value beyond the fine mesh, as a share of its change from the coarse one (theory,
/// eq. 40a).
pub(super) fn share(coarse: f64, fine: f64, p: f64) -> f64 {
    1.0 / ((coarse / fine).powf(p) - 1.0)
}

/// The order on two meshes: the usual one, if the size of the value does not rise where it falls.
pub(super) fn of_two(coarse: &Computed, fine: &Computed, known: Convergence) -> Order {
    let rise = (fine.value - coarse.value) * fine.value.signum();
    if known.falls && rise > coarse.half_width + fine.half_width {
        Order::Rising
    } else {
        Order::Assumed {
            slowest: known.slowest,
        }
    }
}

/// The order on three meshes (theory, eqs. 40b, 40d): those that the intervals of the values admit.
pub(super) fn of_three(meshes: [&Computed; 3], known: Convergence) -> Order {
    let [a, b, c] = meshes;
    let (first, second) = (a.value - b.value, b.value - c.value);
    // With cells of a constant ratio r this is r^p; it grows with p.
    let ratio = |p: f64| {
        let [a, b, c] = [a.h / c.h, b.h / c.h, 1.0].map(|h: f64| h.powf(p));
        (a - b) / (b - c)
    };
    if known.falls && of_two(a, b, known) == Order::Rising && of_two(b, c, known) == Order::Rising {
        return Order::Rising;
    }
    let in_doubt = [a.half_width + b.half_width, b.half_width + c.half_width];
    let order_of = |wanted: f64| {
        let [mut low, mut high] = SOUGHT;
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if ratio(middle) < wanted {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    };
    let possible = [ratio(known.slowest), ratio(FASTEST)];
    if let Some([low, high]) = admitted([first, second], in_doubt, possible) {
        let [from, to] = [low, high].map(order_of);
        return if to - from < 1e-6 {
            Order::Observed(from)
        } else {
            Order::Admitted { from, to }
        };
    }
    if first * second < 0.0 {
        return Order::Oscillating;
    }
    if first.abs() <= ratio(SOUGHT[0]) * second.abs() {
        return Order::Diverging;
    }
    let observed = if first.abs() >= ratio(SOUGHT[1]) * second.abs() {
        SOUGHT[1]
    } else {
        order_of(first / second)
    };
    Order::Limited {
        observed,
        used: observed.clamp(known.slowest, FASTEST),
    }
}

/// Ratios R of two changes within `possible` that the doubts in both admit: some change within `in_doubt[0]` of the
/// first is R times one within `in_doubt[1]` of the second.
fn admitted(
    [first, second]: [f64; 2],
    [of_first, of_second]: [f64; 2],
    [mut low, mut high]: [f64; 2],
) -> Option<[f64; 2]> {
    // R (second + of_second) ≥ first − of_first, and the same from the other side.
    for (factor, least) in [
        (second + of_second, first - of_first),
        (of_second - second, -first - of_first),
    ] {
        if factor > 0.0 {
            low = low.max(least / factor);
        } else if factor < 0.0 {
            high = high.min(least / factor);
        } else if least > 0.0 {
            return None;
        }
    }
    (low <= high * (1.0 + 1e-12)).then_some([low.min(high), high])
}
