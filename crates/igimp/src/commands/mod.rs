//! The commands of the program.

pub(crate) mod cases;
pub(crate) mod element;
pub(crate) mod film;
pub(crate) mod fit;
pub(crate) mod pages;
pub(crate) mod report;
pub(crate) mod run;
pub(crate) mod sweep;
pub(crate) mod template;
pub(crate) mod validate;
pub(crate) mod view;
