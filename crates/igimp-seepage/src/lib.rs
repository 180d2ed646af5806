//! Seepage with a free surface on the background grid, steady and in time.
//!
//! One unknown head per node of the cells that hold soil, linear along each axis. Faces of the ground need not lie on lines of
//! the grid: heads on them are set weakly, and cells that soil fills in part are tied to their neighbours by a penalty that
//! lets no water through (theory, eqs. 78 to 84). In time the ground stores water (theory, eqs. 85a to 85d).
//! Nothing here knows of files, stress or stages.

mod basis;
mod boundary;
mod conditions;
mod curve;
mod error;
mod field;
mod ground;
mod layers;
mod lines;
mod search;
mod solve;
mod storage;
mod system;
mod transient;

pub use conditions::{Conditions, Extent, FreeWater, InGround, Named, OnFaces, Soil};
pub use curve::Curve;
pub use error::SeepageError;
pub use field::{Discharge, Seepage};
pub use ground::{Scale, SeepageBody};
pub use solve::solve;
pub use transient::{Course, History, Transient, WaterBalance, march};
