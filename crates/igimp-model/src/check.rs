//! A check: a computed quantity held against an outside value within a band.

use std::fmt;

use igimp_text::short;
use serde::{Deserialize, Deserializer, Serialize};

/// The band that a computed value must satisfy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Band {
    /// Within this share of the expected value \[-\].
    Relative(f64),
    /// Between two values.
    Between(f64, f64),
    /// Not above.
    AtMost(f64),
    /// Not below.
    AtLeast(f64),
}

impl Band {
    /// Whether a value lies in the band around `expected`; a value that is not a number does not.
    pub fn holds(&self, expected: f64, measured: f64) -> bool {
        match *self {
            Self::Relative(share) => (measured - expected).abs() <= share * expected.abs(),
            Self::Between(low, high) => low <= measured && measured <= high,
            Self::AtMost(limit) => measured <= limit,
            Self::AtLeast(limit) => measured >= limit,
        }
    }
}

impl fmt::Display for Band {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Relative(share) => write!(f, "± {} %", short(100.0 * share)),
            Self::Between(low, high) => write!(f, "{} … {}", short(low), short(high)),
            Self::AtMost(limit) => write!(f, "≤ {}", short(limit)),
            Self::AtLeast(limit) => write!(f, "≥ {}", short(limit)),
        }
    }
}

/// A computed quantity and the outside value it is held against.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Check {
    /// Case, such as `column`.
    pub case: String,
    /// Variant of method, mesh and parameters.
    pub variant: String,
    /// The measured quantity, with unit.
    pub quantity: String,
    /// The outside value, in the unit that `quantity` names.
    pub expected: f64,
    /// Where it comes from.
    pub source: String,
    /// The accepted band.
    pub band: Band,
    /// The computed value, in the same unit; NaN is `null` in JSON.
    #[serde(deserialize_with = "or_not_a_number")]
    pub measured: f64,
}

impl Check {
    /// Whether the band is met.
    pub fn passes(&self) -> bool {
        self.band.holds(self.expected, self.measured)
    }
}

/// A number; NaN for `null` in JSON.
///
/// # Errors
/// For anything but a number or `null`.
pub fn or_not_a_number<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NAN))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_that_is_not_a_number_never_passes() {
        for band in [
            Band::Relative(1.0),
            Band::Between(-1e9, 1e9),
            Band::AtMost(1e9),
            Band::AtLeast(-1e9),
        ] {
            assert!(!band.holds(1.0, f64::NAN), "{band}");
        }
    }
}
