//! Resources of the machine that a run takes.

pub mod memory;
pub mod processor;
