//! A parameter: its key, its unit, its bounds, and its scale in the search.

use igimp_schema::quantity::{Quantity, QuantityError, split};
use thiserror::Error;

use super::Source;

/// A parameter that is sought.
#[derive(Clone, Debug, PartialEq)]
pub struct Vary {
    /// Its key within the material, such as `friction` or `softening.cu.residual`.
    pub key: String,
    /// Lower and upper bound, as texts with their units.
    pub bounds: Option<[String; 2]>,
}

/// Why something cannot be varied.
#[derive(Debug, Error)]
pub enum ParameterError {
    /// Neither a key nor a key with bounds.
    #[error("`{text}` is no parameter with bounds")]
    Form {
        /// The text as written.
        text: String,
    },
    /// The file has no such value.
    #[error("the material has no value of `{key}` to begin with")]
    NoValue {
        /// The key.
        key: String,
    },
    /// It is no number.
    #[error("`{key}` is {text}, and no quantity that could be varied")]
    NoNumber {
        /// The key.
        key: String,
        /// The text in the file.
        text: String,
    },
    /// A bound that is no quantity.
    #[error("a bound of `{key}`: {source}")]
    Bound {
        /// The key.
        key: String,
        /// Why.
        source: QuantityError,
    },
    /// Bounds of another kind than the value, or not one below the other, or the start is not between them.
    #[error("`{key}` begins at {start}, which is not between {low} and {high}")]
    Outside {
        /// The key.
        key: String,
        /// The start.
        start: String,
        /// The lower bound.
        low: String,
        /// The upper bound.
        high: String,
    },
    /// A bound has no unit, or one of another kind.
    #[error("the bound `{bound}` of `{key}` is not in a unit of the same kind as its {start}")]
    Kind {
        /// The key.
        key: String,
        /// The bound.
        bound: String,
        /// The start.
        start: String,
    },
    /// A start that is not positive has no scale without bounds.
    #[error("`{key}` begins at {start}, and nothing says how large it may be")]
    NoScale {
        /// The key.
        key: String,
        /// The start.
        start: String,
    },
    /// Twice the same.
    #[error("`{key}` is varied twice")]
    Twice {
        /// The key.
        key: String,
    },
}

impl ParameterError {
    /// The help.
    pub fn help(&self) -> &'static str {
        match self {
            Self::Form { .. } | Self::Bound { .. } | Self::Outside { .. } | Self::Kind { .. } => {
                "--vary friction, or with bounds --vary \"friction=20 deg..40 deg\", in units of the same kind"
            }
            Self::NoValue { .. } => {
                "keys are those of the material in the file; --set states a value to begin with"
            }
            Self::NoNumber { .. } => "a profile over depth or a word has no single value",
            Self::NoScale { .. } => {
                "state bounds: --vary \"cohesion=0 kPa..20 kPa\"; or begin at a positive value"
            }
            Self::Twice { .. } => "state a parameter once",
        }
    }
}

impl std::str::FromStr for Vary {
    type Err = ParameterError;

    fn from_str(text: &str) -> Result<Self, ParameterError> {
        let form = || ParameterError::Form {
            text: text.to_owned(),
        };
        let (key, bounds) = match text.split_once('=') {
            None => (text, None),
            Some((key, bounds)) => {
                let (low, high) = bounds.split_once("..").ok_or_else(form)?;
                (key, Some([low, high].map(|bound| bound.trim().to_owned())))
            }
        };
        let key = key.trim().to_owned();
        let is_key = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | '-');
        if key.is_empty() || !key.chars().all(is_key) {
            return Err(form());
        }
        Ok(Self { key, bounds })
    }
}

/// Where the search of every parameter begins.
pub(super) const START: f64 = 1.0;

/// A place in the search as near to an end is at it.
pub(super) const AT_END: f64 = 1e-9;

/// How a parameter is scaled in the search.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Scale {
    /// By its logarithm: x = 1 + ln(value/start).
    Logarithm,
    /// By the width of its bounds: x = 1 + (value - start)/width.
    Width(f64),
}

/// A parameter in the search.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Parameter {
    pub(super) key: String,
    pub(super) unit: String,
    /// The value of the file.
    pub(super) first: f64,
    bounds: Option<[f64; 2]>,
    scale: Scale,
}

impl Parameter {
    /// That of a key, beginning at the value of the file.
    pub(super) fn new(vary: &Vary, source: &dyn Source) -> Result<Self, ParameterError> {
        let key = vary.key.clone();
        let Some(text) = source.written(&key) else {
            return Err(ParameterError::NoValue { key });
        };
        let Some((first, unit)) = split(text.trim()).filter(|_| Quantity::parse(&text).is_ok())
        else {
            return Err(ParameterError::NoNumber { key, text });
        };
        let unit = unit.to_owned();
        let bounds = match &vary.bounds {
            None => None,
            Some(bounds) => Some(bounds_in(&key, bounds, (first, &unit))?),
        };
        let scale = match bounds {
            _ if first > 0.0 && bounds.is_none_or(|[low, _]| low > 0.0) => Scale::Logarithm,
            Some([low, high]) => Scale::Width(high - low),
            None => return Err(ParameterError::NoScale { key, start: text }),
        };
        Ok(Self {
            key,
            unit,
            first,
            bounds,
            scale,
        })
    }

    /// The value of a place in the search.
    pub(super) fn value(&self, x: f64) -> f64 {
        match self.scale {
            Scale::Logarithm => self.first * (x - START).exp(),
            Scale::Width(width) => self.first + (x - START) * width,
        }
    }

    /// Its derivative by the place.
    pub(super) fn slope(&self, x: f64) -> f64 {
        match self.scale {
            Scale::Logarithm => self.value(x),
            Scale::Width(width) => width,
        }
    }

    /// Bounds of the place.
    pub(super) fn limits(&self) -> Option<[f64; 2]> {
        let place = |value: f64| match self.scale {
            Scale::Logarithm => START + (value / self.first).ln(),
            Scale::Width(width) => START + (value - self.first) / width,
        };
        self.bounds.map(|bounds| bounds.map(place))
    }

    /// A value as it is written in a file.
    pub(super) fn text(&self, value: f64) -> String {
        written(value, &self.unit)
    }
}

/// Between which places a parameter is sought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    /// The lower and the upper end; infinite where there is none.
    pub(super) ends: [f64; 2],
    /// Which of the ends are walls that the search met; the others are bounds that were stated.
    pub(super) is_wall: [bool; 2],
}

impl Range {
    /// The bounds that were stated.
    pub(super) fn stated(parameter: &Parameter) -> Self {
        Self {
            ends: parameter
                .limits()
                .unwrap_or([f64::NEG_INFINITY, f64::INFINITY]),
            is_wall: [false; 2],
        }
    }

    /// The end that a place is at: 0 the lower one, 1 the upper one.
    pub(super) fn end_at(&self, x: f64) -> Option<usize> {
        let [low, high] = self.ends;
        if x <= low + AT_END {
            Some(0)
        } else if x >= high - AT_END {
            Some(1)
        } else {
            None
        }
    }
}

/// A value with its unit.
pub(super) fn written(value: f64, unit: &str) -> String {
    if unit.is_empty() {
        format!("{value:?}")
    } else {
        format!("{value} {unit}")
    }
}

/// Bounds in the unit of the value.
fn bounds_in(
    key: &str,
    bounds: &[String; 2],
    (first, unit): (f64, &str),
) -> Result<[f64; 2], ParameterError> {
    let one = Quantity::parse(&format!("1 {unit}")).map_or(1.0, |q| q.value);
    let kind = Quantity::parse(&format!("1 {unit}")).map_or(None, |q| q.dimension);
    let mut ends = [0.0; 2];
    for (value, text) in ends.iter_mut().zip(bounds) {
        let read = Quantity::parse(text).map_err(|source| ParameterError::Bound {
            key: key.to_owned(),
            source,
        })?;
        if read.dimension != kind {
            return Err(ParameterError::Kind {
                key: key.to_owned(),
                bound: text.clone(),
                start: written(first, unit),
            });
        }
        *value = read.value / one;
    }
    let [low, high] = ends;
    if low < high && (low..=high).contains(&first) {
        return Ok(ends);
    }
    let [low, high] = bounds.clone();
    Err(ParameterError::Outside {
        key: key.to_owned(),
        start: written(first, unit),
        low,
        high,
    })
}
