//! Ranges of parameters, checked before a case is run.

use crate::error::CaseError;

/// Accepts a number that is positive and finite.
pub(crate) fn positive(field: &'static str, value: f64) -> Result<(), CaseError> {
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        let requirement = "positive and finite";
        Err(CaseError::InvalidParameter {
            field,
            value,
            requirement,
        })
    }
}

/// Accepts a number that is zero or positive, and finite.
pub(crate) fn not_negative(field: &'static str, value: f64) -> Result<(), CaseError> {
    if value >= 0.0 && value.is_finite() {
        Ok(())
    } else {
        let requirement = "zero or positive, and finite";
        Err(CaseError::InvalidParameter {
            field,
            value,
            requirement,
        })
    }
}

/// Accepts a count of one or more.
pub(crate) fn at_least_one(field: &'static str, count: usize) -> Result<(), CaseError> {
    if count >= 1 {
        Ok(())
    } else {
        Err(CaseError::InvalidParameter {
            field,
            value: 0.0,
            requirement: "at least 1",
        })
    }
}
