//! The Python package `igimp`: the engine of the program, with the texts of the program.
//!
//! What is bound is what `igimp run`, `igimp check` and `igimp explain` do. A run goes on in a thread of its
//! own and tells Python of every step, so that Python may look, stop it, or be interrupted. What reads
//! better in Python is written in Python, in the folder `igimp` beside this one.

mod arrays;
mod case;
mod element;
mod fit;
mod law;
mod march;
mod raised;
mod relay;

use igimp_results::summary::Summary;
use igimp_study::narration;
use pyo3::prelude::*;

/// The engine; use the package `igimp`.
#[pymodule]
mod _igimp {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::case::{CaseFile, shipped, template};
    #[pymodule_export]
    use super::element::{ElementTest, element};
    #[pymodule_export]
    use super::fit::{Fit, fit};
    #[pymodule_export]
    use super::march::March;
    #[pymodule_export]
    use super::verdict;

    /// The version is that of the crate.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}

/// What is said of a run, from its `summary.json`: stages, mesh error and checks as the program prints them;
/// how it ended, in a word; the exit code of the program.
#[pyfunction]
fn verdict(summary: &str) -> PyResult<(String, String, u8)> {
    let summary: Summary = serde_json::from_str(summary)
        .map_err(|error| pyo3::exceptions::PyValueError::new_err(error.to_string()))?;
    let ending = summary.ending();
    let text = narration::verdict::stages_and_checks(&summary);
    Ok((text, ending.to_string(), raised::code(ending)))
}
