//! Reinforcement: members against bars, sliding blocks and circles.

pub(crate) mod bar;
mod circle;
pub(crate) mod cut;
pub(crate) mod seam;

use igimp_cases::CaseError;
use igimp_input::CaseFile;
use igimp_model::Case;

/// A case file of these studies, changed by overrides.
fn case(name: &str, text: &str, overrides: &[String]) -> Result<Case<2>, CaseError> {
    Ok(CaseFile::parse(name, text, overrides)?.into_case())
}
