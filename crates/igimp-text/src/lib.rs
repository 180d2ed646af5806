//! Numbers and texts for people: in messages, logs, tables and reports.

mod memory;
mod number;
mod sanitize;

pub use memory::{MemoryLimit, NoAmount};
pub use number::{count, short, told_apart};
pub use sanitize::{is_odd, on_a_line, on_lines};
