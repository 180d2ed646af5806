//! Tables as CSV.

pub mod cells;
pub mod rows;
pub mod table;
