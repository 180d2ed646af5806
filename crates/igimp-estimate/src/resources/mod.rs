//! What a run takes of the machine.

pub mod memory;
pub mod processor;
