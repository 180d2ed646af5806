//! Errors of a linear solve, as data.

/// Why a linear system could not be analysed, factorised or solved.
#[derive(thiserror::Error, Clone, Debug, PartialEq)]
pub enum LinearSolverError {
    /// The system has no unknowns.
    #[error("the linear system has no unknowns")]
    Empty,

    /// A slice does not have one entry per unknown, or a matrix one value per stored entry.
    #[error("{array} has {found} entries, expected {expected}")]
    WrongLength {
        /// The offending slice.
        array: &'static str,
        /// Its required length.
        expected: usize,
        /// Its actual length.
        found: usize,
    },

    /// The pattern is not a valid, structurally symmetric pattern of coupled blocks.
    #[error("invalid sparsity pattern at block {block}: {reason}")]
    InvalidPattern {
        /// The reason.
        reason: &'static str,
        /// First block where it is wrong.
        block: usize,
    },

    /// `solve` was called before a successful `factor`.
    #[error("no factorised matrix to solve with")]
    NotFactored,

    /// An input or the solution holds a NaN or an infinity.
    #[error("{array} is not finite at index {index}")]
    NonFinite {
        /// `"matrix"` (index into the stored values), `"right-hand side"` or `"solution"` (index
        /// of the unknown).
        array: &'static str,
        /// First offending index.
        index: usize,
    },

    /// The matrix is singular to working precision.
    #[error("singular matrix{}", at_unknown(*.unknown))]
    Singular {
        /// An unknown whose pivot vanished, where one can be named.
        unknown: Option<usize>,
    },

    /// A solver for symmetric matrices was given one that is not marked as symmetric.
    #[error("the solver needs a symmetric matrix")]
    NotSymmetric,

    /// A Cholesky factorisation met a pivot that is not positive.
    #[error("matrix not positive definite{}", at_unknown(*.unknown))]
    NotPositiveDefinite {
        /// The unknown of the offending pivot, where it can be named.
        unknown: Option<usize>,
    },

    /// The solution does not satisfy the equations well enough.
    #[error("relative residual {relative_residual:.3e} above the tolerance {tolerance:e}")]
    Inaccurate {
        /// Best relative residual reached.
        relative_residual: f64,
        /// Largest acceptable one.
        tolerance: f64,
    },

    /// An iteration did not come to a solution, and there was no room for a factorisation.
    #[error(
        "no solution after {iterations} iterations: relative residual {relative_residual:.3e} above {tolerance:e}{}",
        would_need(*.factor_bytes)
    )]
    NotConverged {
        /// How many were made.
        iterations: usize,
        /// Relative residual reached, in the Euclidean norm.
        relative_residual: f64,
        /// Largest acceptable one.
        tolerance: f64,
        /// Memory that factors in double precision would take, if it was not available.
        factor_bytes: Option<usize>,
    },

    /// The factors do not fit into memory or into the index type.
    #[error("out of memory: {part}")]
    OutOfMemory {
        /// The part that could not be allocated.
        part: &'static str,
    },
}

impl LinearSolverError {
    /// Whether the matrix is singular, or as good as singular: its solutions have no digit that is right.
    pub fn is_singular(&self) -> bool {
        matches!(self, Self::Singular { .. } | Self::Inaccurate { .. })
    }
}

fn would_need(factor_bytes: Option<usize>) -> String {
    factor_bytes.map_or_else(String::new, |bytes| {
        let gibibytes = bytes as f64 / (1_u64 << 30) as f64;
        format!("; a factorisation would need {gibibytes:.1} GiB")
    })
}

fn at_unknown(unknown: Option<usize>) -> String {
    unknown.map_or_else(String::new, |unknown| format!(" at unknown {unknown}"))
}

#[cfg(test)]
mod tests {
    use super::LinearSolverError;

    /// GOAL: a residual is printed with four digits. ORACLE: by hand.
    #[test]
    fn residuals_have_four_digits() {
        let error = LinearSolverError::Inaccurate {
            relative_residual: 7.061_818_181_818_181,
            tolerance: 1e-6,
        };
        let text = "relative residual 7.062e0 above the tolerance 1e-6";
        assert_eq!(error.to_string(), text);
    }
}
