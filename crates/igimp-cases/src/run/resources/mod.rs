//! What a run takes of the machine.

pub(crate) mod memory;
pub(crate) mod processor;
