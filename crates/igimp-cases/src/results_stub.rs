//! Results folders: stands in for what writes them.

/// Reports.
pub mod report {
    use std::path::{Path, PathBuf};

    use crate::error::CaseError;

    /// Makes a report of a results folder.
    ///
    /// # Errors
    /// [`CaseError::File`].
    pub fn write_report(folder: &Path) -> Result<PathBuf, CaseError> {
        let path = folder.join("summary.json");
        std::fs::read_to_string(&path).map_err(|source| CaseError::File { path, source })?;
        Ok(folder.join("report.html"))
    }
}
