//! Oracles: the sources of right values, their locators, and the values they give.
//!
//! An oracle is declared as a constant beside the check that uses it; the verification matrix of the
//! book is made of these declarations.

use std::fmt;

use serde::Serialize;

/// The kind of knowledge that an outside value rests on. The order is that of trust.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum OracleKind {
    /// A closed form, or a quadrature of one.
    Exact,
    /// Lower and upper bounds of limit analysis: they know nothing of the method.
    LimitAnalysis,
    /// A property that theory demands, such as an order of convergence.
    Theory,
    /// A printed table or number of another method.
    Published,
    /// Another program for the same equations, or another discretisation of them.
    IndependentProgram,
}

impl fmt::Display for OracleKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Exact => "exact",
            Self::LimitAnalysis => "limit analysis",
            Self::Theory => "theory",
            Self::Published => "published",
            Self::IndependentProgram => "independent program",
        })
    }
}

/// A source and its locator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Oracle {
    /// The basis of its knowledge.
    pub(crate) kind: OracleKind,
    /// Author and year, or the method with which it was computed.
    pub(crate) source: &'static str,
    /// Where in the source: table, figure, section, equation.
    pub(crate) locator: &'static str,
}

impl Oracle {
    /// The oracle with the value that it gives for one quantity.
    pub(crate) const fn says(self, value: f64) -> Expected {
        Expected {
            oracle: self,
            value,
        }
    }
}

/// An outside value with its oracle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Expected {
    /// The oracle of the value.
    pub(crate) oracle: Oracle,
    /// The value, in the unit of the quantity.
    pub(crate) value: f64,
}
