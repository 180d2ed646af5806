//! What a run leaves behind: fields, pictures and the report.

pub mod fields;
pub mod pictures;
pub mod report;
