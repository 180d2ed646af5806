//! The way into a results folder: locked, and asked whether its files may be replaced, before
//! anything is touched.

use std::path::Path;

use igimp_model::Case;
use igimp_results::checkpoint::{CheckpointError, difference};
use igimp_results::folder::lock::Lock;
use igimp_results::folder::overwrite_guard::{admit, refuse_links};
use igimp_results::folder::provenance::Owner;
use igimp_results::folder::{self, holds_checkpoints, owner, refuse_foreign};

use crate::error::CaseError;
use crate::run::resume::fingerprint;
use crate::run::{Start, Target};

/// Whether a folder holds a run of this very input that was stopped and can go on.
pub fn can_go_on<const D: usize>(case: &Case<D>, root: &Path) -> bool {
    let stopped = |owner: &Owner| !owner.finished && owner.input == fingerprint::of_case(case);
    owner(root).as_ref().is_some_and(stopped) && holds_checkpoints(root)
}

/// A results folder that a run may write into, and that of its linear systems, kept for it until this is
/// dropped.
#[derive(Debug)]
pub struct Entered {
    _locks: Vec<Lock>,
}

impl Entered {
    /// Enters the folder of a run.
    ///
    /// # Errors
    /// [`ResultsError::InUse`](igimp_results::ResultsError::InUse), [`ResultsError::ForeignFolder`](igimp_results::ResultsError::ForeignFolder), [`ResultsError::Link`](igimp_results::ResultsError::Link),
    /// [`ResultsError::OtherResults`](igimp_results::ResultsError::OtherResults), [`ResultsError::Unfinished`](igimp_results::ResultsError::Unfinished); [`CheckpointError::OtherCase`] for
    /// checkpoints of other input to go on from.
    pub fn new<const D: usize>(
        case: &Case<D>,
        target: &Target,
        start: Start,
    ) -> Result<Self, CaseError> {
        let root = &target.folder;
        refuse_foreign(root)?;
        refuse_links(root)?;
        let mut locks = vec![Lock::alone(root)?];
        let claim = target.claim(case);
        let goes_on = match start {
            Start::Afresh | Start::FromStage(0) => false,
            Start::Resume => holds_checkpoints(root),
            Start::FromStage(_) => true,
        };
        if !goes_on {
            admit(root, &claim, target.replace)?;
        } else if start == Start::Resume
            && owner(root).is_some_and(|owner| owner.input != claim.input)
        {
            let other = CheckpointError::OtherCase {
                path: root.clone(),
                differs: None,
            };
            let kept = root.join("case.completed.toml");
            return Err(difference::named(other, &kept, &target.completed).into());
        }
        if let Some(systems) = &target.systems {
            refuse_foreign(systems)?;
            // It may lie within the results folder, which is then no longer empty.
            folder::claim(root)?;
            if !is_same_folder(systems, root) {
                locks.push(Lock::alone(systems)?);
            }
        }
        Ok(Self { _locks: locks })
    }
}

fn is_same_folder(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}
