//! Fingerprints of cases: a saved state is taken up only for the input that it came from.

use crate::case::{Case, Every, Output, TitleBlock};
use crate::results::checkpoint::sha256;

/// Of everything but where and how often results are written, and for whom.
pub(crate) fn of_case(case: &Case) -> String {
    sha256(format!("{:?}", whole(case)).as_bytes())
}

/// Of everything that the first `stages` stages depend on.
pub(crate) fn of_history(case: &Case, stages: usize) -> String {
    let mut history = whole(case);
    history.stages.truncate(stages);
    history.title.clear();
    history.monitors.clear();
    history.sections.clear();
    history.curves.clear();
    history.checks.clear();
    sha256(format!("{history:?}").as_bytes())
}

/// A case without what concerns its output and the head of its report alone.
fn whole(case: &Case) -> Case {
    Case {
        title_block: TitleBlock::default(),
        output: Output {
            folder: std::path::PathBuf::new(),
            paraview: Every::Never,
            figures: Vec::new(),
            report: false,
            checkpoint_every: 0,
            checkpoint_keep: 0,
        },
        ..case.clone()
    }
}
