//! Fingerprints of cases: a saved state is taken up only for the input that it came from.

use igimp_model::{Case, Every, Monitor, Output, SolverSettings, StageKind, TitleBlock};
use igimp_results::checkpoint::sha256;

/// Of everything but the place and frequency of output, and the title block.
pub(crate) fn of_case<const D: usize>(case: &Case<D>) -> String {
    sha256(format!("{:?}", whole(case)).as_bytes())
}

/// Of everything that the first `stages` stages depend on.
pub(crate) fn of_history<const D: usize>(case: &Case<D>, stages: usize) -> String {
    let mut history = whole(case);
    history.stages.truncate(stages);
    history.title.clear();
    let named = history.stages.iter().flat_map(|stage| {
        let search = match &stage.kind {
            StageKind::StrengthReduction(search) => search.monitor,
            _ => None,
        };
        [stage.stop_when.monitor, search]
    });
    // What a stage ends by is part of it, whatever else is recorded there.
    let named = named.flatten().map(|monitor| Monitor {
        name: String::new(),
        record: Vec::new(),
        ..case.monitors[monitor].clone()
    });
    history.monitors = named.collect();
    history.sections.clear();
    history.curves.clear();
    history.checks.clear();
    sha256(format!("{history:?}").as_bytes())
}

/// A case without its output, the head of its report, the memory for factors and a given solver alone.
fn whole<const D: usize>(case: &Case<D>) -> Case<D> {
    Case {
        title_block: TitleBlock::default(),
        output: Output {
            folder: std::path::PathBuf::new(),
            paraview: Every::Never,
            figures: Vec::new(),
            cuts: Vec::new(),
            report: false,
            checkpoint_every: 0,
            checkpoint_keep: 0,
        },
        solver: SolverSettings {
            memory: None,
            ..case.solver
        },
        given_solver: None,
        ..case.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::case;

    /// GOAL: a run can be taken up after its report got another author, on a machine with other memory, and not after another
    /// cohesion.
    #[test]
    fn the_head_of_the_report_is_no_input() {
        let mut other = case();
        other.title_block.author = Some("A. Engineer".into());
        assert_eq!(of_case(&other), of_case(&case()));
        other.solver.memory = "2 GiB".parse().ok();
        assert_eq!(of_case(&other), of_case(&case()));
        other.materials[0].young *= 2.0;
        assert_ne!(of_case(&other), of_case(&case()));
    }
}
