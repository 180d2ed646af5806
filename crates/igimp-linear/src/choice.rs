//! Which method solves the systems of a step, why, and what it took: data for reports.

use std::fmt;

/// How the linear systems of a step were solved.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinearEffort {
    /// The method that found the last solution, empty before the first.
    pub method: &'static str,
    /// Why it was taken.
    pub reason: Reason,
    /// Solutions found.
    pub solutions: usize,
    /// Iterations of all of them; of a direct method none.
    pub iterations: usize,
    /// Iterations of the one that took most.
    pub most_iterations: usize,
    /// Iterations of those that were given up for a factorisation.
    pub lost_iterations: usize,
}

/// How the systems of a pattern are going to be solved.
#[derive(Clone, Debug, PartialEq)]
pub struct Forecast {
    /// Whether by iteration.
    pub iterates: bool,
    /// Why.
    pub reason: Reason,
    /// Memory of factors in double precision and of the contributions to them \[bytes\].
    pub factor_bytes: usize,
    /// Memory of the factors that may replace an iteration \[bytes\]; zero where there is no room for any.
    pub fallback_bytes: usize,
    /// Operations of a factorisation in double precision.
    pub operations: f64,
}

/// Why a method was taken.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Reason {
    /// It was asked for by its name.
    #[default]
    Asked,
    /// The system is that of a plane, or of a line.
    Plane,
    /// Pore pressure is among the unknowns, for which a program that is given has no iteration.
    Coupled,
    /// There are too few nodes for a coarser grid.
    Small {
        /// Unknowns of the system.
        unknowns: usize,
    },
    /// Iteration is expected to take less time than a factorisation.
    IterationFaster {
        /// Unknowns of the system.
        unknowns: usize,
        /// Iterations that cost as much as a factorisation.
        iterations: usize,
    },
    /// A factorisation is expected to take no more time than iteration.
    FactorisationFaster {
        /// Unknowns of the system.
        unknowns: usize,
        /// Iterations that cost as much as a factorisation, beyond their set-up.
        iterations: usize,
    },
    /// The factors would not fit into the memory allowed for them.
    Memory {
        /// The memory that they would take \[bytes\].
        factors: usize,
        /// The limit \[bytes\].
        allowed: usize,
    },
    /// Factors in single precision did not serve.
    SingleFailed {
        /// Iterations that were made with them, zero where there are none: the matrix is not positive definite in
        /// single precision.
        iterations: usize,
    },
    /// An iteration did not converge, and factors fit into the memory allowed in single precision only.
    OnlySingle {
        /// Iterations that were made.
        iterations: usize,
        /// The memory that factors in double precision would take \[bytes\].
        factors: usize,
        /// The limit \[bytes\].
        allowed: usize,
    },
    /// An iteration did not converge within as many steps as a factorisation costs.
    NotConverged {
        /// How many were made.
        iterations: usize,
    },
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let gibibytes = |bytes: usize| bytes as f64 / (1_u64 << 30) as f64;
        match *self {
            Self::Asked => write!(f, "asked for"),
            Self::Plane => write!(f, "two dimensions"),
            Self::Coupled => write!(f, "pore pressures are among the unknowns"),
            Self::Small { unknowns } => write!(f, "{unknowns} unknowns are few"),
            Self::IterationFaster {
                unknowns,
                iterations,
            } => write!(
                f,
                "a factorisation for {unknowns} unknowns is expected to cost as much as {iterations} iterations"
            ),
            Self::FactorisationFaster {
                unknowns,
                iterations: 0,
            } => write!(
                f,
                "a factorisation for {unknowns} unknowns is expected to cost less than setting up an iteration"
            ),
            Self::FactorisationFaster {
                unknowns,
                iterations,
            } => write!(
                f,
                "a factorisation for {unknowns} unknowns is expected to cost no more than {iterations} iterations"
            ),
            Self::Memory { factors, allowed } => write!(
                f,
                "a factorisation would need {:.1} GiB, and {:.1} are allowed",
                gibibytes(factors),
                gibibytes(allowed)
            ),
            Self::SingleFailed { iterations: 0 } => {
                write!(f, "not positive definite in single precision")
            }
            Self::SingleFailed { iterations } => write!(
                f,
                "no convergence within {iterations} iterations with factors in single precision"
            ),
            Self::OnlySingle {
                iterations,
                factors,
                allowed,
            } => write!(
                f,
                "no convergence within {iterations} iterations, and factors in double precision would need {:.1} GiB, \
                 where {:.1} are allowed",
                gibibytes(factors),
                gibibytes(allowed)
            ),
            Self::NotConverged { iterations } => {
                write!(f, "no convergence within {iterations} iterations")
            }
        }
    }
}
