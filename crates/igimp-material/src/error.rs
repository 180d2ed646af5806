//! Errors of a constitutive law, as data.

/// Why a law could not be made or evaluated.
#[derive(thiserror::Error, Debug, Clone, PartialEq)]
pub enum MaterialError {
    /// A parameter lies outside the range in which the law makes sense.
    #[error("`{field}` = {value} must be {requirement}")]
    InvalidParameter {
        /// Name of the parameter, as in the constructor.
        field: &'static str,
        /// Value given, in the caller's units (angles in radians).
        value: f64,
        /// The requirement on the value; reads on from "must be".
        requirement: &'static str,
    },
    /// A strain or stretch is infinite or not a number, or so large that the stress is.
    #[error("the {quantity} must be finite")]
    NonFinite {
        /// The quantity, in words.
        quantity: &'static str,
    },
    /// An elastic left Cauchy–Green tensor has an eigenvalue that is not positive.
    #[error(
        "the elastic left Cauchy-Green tensor must be positive definite, got an eigenvalue of {eigenvalue}"
    )]
    NotPositiveDefinite {
        /// Smallest eigenvalue found.
        eigenvalue: f64,
    },
    /// A law that searches for its stress did not find it.
    #[error("the return of {law} did not converge")]
    NotConverged {
        /// Name of the law.
        law: &'static str,
    },
    /// The strength of a law falls faster with strain than elastic stress does: no stress follows the strain.
    #[error(
        "the stress of {law} snaps back within the point: strength falls faster than elastic stress does (a larger softening strain, smaller cells or stiffer soil)"
    )]
    SnapBack {
        /// Name of the law.
        law: &'static str,
    },
    /// A law whose strength is not reduced by a factor.
    #[error("the strength of {law} is not reduced: {reason}")]
    NoReduction {
        /// Name of the law.
        law: &'static str,
        /// Why not.
        reason: &'static str,
    },
}

/// The error that names `field`, unless its value is finite and the requirement `holds`.
pub(crate) fn required(
    field: &'static str,
    value: f64,
    holds: bool,
    requirement: &'static str,
) -> Result<(), MaterialError> {
    if holds && value.is_finite() {
        Ok(())
    } else {
        Err(MaterialError::InvalidParameter {
            field,
            value,
            requirement,
        })
    }
}

/// The error that names `field`, unless its value is positive and finite.
pub(crate) fn positive(field: &'static str, value: f64) -> Result<(), MaterialError> {
    required(field, value, value > 0.0, "positive and finite")
}
