//! The elimination tree: which front eliminates what, and when.

pub(crate) mod front;
pub(crate) mod neighbours;
pub(crate) mod plan;
pub(crate) mod supernodes;
pub(crate) mod tasks;
