//! Case files as users write them: the messages, the overrides, the completed file, the schema.
//!
//! The two files in `tests/data` are models of the format; every message is what one or more
//! edits of them lead to.

// Values are read to the last digit.
#![allow(clippy::float_cmp)]

mod contradictions;
#[path = "../common/edits.rs"]
mod edits;
mod json_schema;
mod large_files;
#[path = "../common/messages.rs"]
mod messages;
mod mutations;
mod overrides;
mod slips;
mod statements;

use igimp_input::{CaseFile, InputError};

const SLOPE: (&str, &str) = ("slope.toml", include_str!("../data/slope.toml"));
const FOOTING: (&str, &str) = ("footing.toml", include_str!("../data/footing.toml"));

/// The footing of the model ends mid-cell, and nothing is warned about.
const MID_CELL: (&str, &str) = (
    "cell = \"0.125 m\"",
    "cell = { x = \"2/17 m\", y = \"0.125 m\" }",
);
const CREST: (&str, &str) = (
    "stop_when = { load_grows_less_than = 0.001 }",
    "stop_when = { load_grows_less_than = 0.001 }\n[[monitors]]\nname = \"edge\"\npoint = [\"1 m\", \"5 m\"]",
);

fn overridden(file: (&str, &str), overrides: &[&str]) -> Result<CaseFile, InputError> {
    let overrides: Vec<_> = overrides.iter().map(ToString::to_string).collect();
    CaseFile::parse(file.0, file.1, &overrides)
}
