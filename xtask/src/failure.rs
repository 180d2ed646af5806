//! The one error type: a message for the reader and an exit code for the caller.

use std::fmt;

/// Something was found wrong.
pub(crate) const FOUND: u8 = 1;
/// The request makes no sense.
pub(crate) const BAD_INPUT: u8 = 2;
/// A program or file is missing or broken.
pub(crate) const INPUT_OUTPUT: u8 = 4;

/// Why a command could not do its work.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Failure {
    message: String,
    /// Exit code of `cargo xtask`.
    pub(crate) code: u8,
}

impl Failure {
    pub(crate) fn new(code: u8, message: impl Into<String>) -> Self {
        let message = message.into();
        Self { message, code }
    }

    /// A program or file failed: the action and its error.
    pub(crate) fn input_output(action: impl fmt::Display, cause: impl fmt::Display) -> Self {
        Self::new(INPUT_OUTPUT, format!("{action}: {cause}"))
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}
