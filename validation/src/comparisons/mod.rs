//! Comparisons that end in a recommendation: finite against small strain, updates of the particle
//! domains, particles per cell, and remedies for small cuts, on the benchmarks of the other studies.

mod benchmarks;
mod block;
mod domains;
mod kinematics;
mod points;
mod small_cuts;

use std::path::Path;

use igimp_cases::CaseError;

use crate::comparisons::benchmarks::Footings;
use crate::harness::study::{Level, Study};

/// The book's description of the study.
const ABOUT: &str = "Choices of the method side by side: finite and small strain, updates of the particle domains, particles per cell, remedies for small cuts. What the defaults choose must meet an outside value; what they reject must miss it.";

/// Runs the study: columns and blocks at every level, slopes, footings and the cantilever at the
/// full one.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("comparisons", ABOUT, out)?;
    let footings = if level == Level::Full {
        Some(Footings::push()?)
    } else {
        None
    };
    kinematics::compare(&mut study, footings.as_ref())?;
    domains::compare(&mut study, level, footings.as_ref())?;
    points::compare(&mut study, level, footings.as_ref())?;
    small_cuts::compare(&mut study, level)?;
    Ok(study)
}
