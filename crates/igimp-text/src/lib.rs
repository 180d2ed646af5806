//! Numbers and texts for people: in messages, logs, tables and reports.

mod number;
mod printable;

pub use number::{count, short};
pub use printable::{is_odd, on_a_line, on_lines};
