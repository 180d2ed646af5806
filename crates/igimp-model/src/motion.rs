//! Motion of soil in time, and when it has come to rest.

pub(crate) mod calm;
pub(crate) mod ground_motion;
