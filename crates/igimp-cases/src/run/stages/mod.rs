//! The stages of a case.

pub(crate) mod construction;
pub(crate) mod dynamic;
pub(crate) mod fallen;
pub(crate) mod initial;
pub(crate) mod limit_load;
pub(crate) mod loading;
pub(crate) mod rigid_begin;
pub(crate) mod run_out;
pub(crate) mod safety;
pub(crate) mod stilled;
pub(crate) mod walls;
