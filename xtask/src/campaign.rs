//! `cargo xtask campaign`: random slopes and footings under watch, in release mode.

use crate::failure::Failure;
use crate::process::status;
use crate::released::released;

/// Runs the campaign program and returns its exit code.
pub(crate) fn run(arguments: &[String]) -> Result<u8, Failure> {
    match released("release", "campaign")? {
        Ok(mut campaign) => status(campaign.args(arguments)),
        Err(code) => Ok(code),
    }
}
