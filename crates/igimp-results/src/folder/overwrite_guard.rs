//! Permission to write into a results folder: nothing that another program left, and nothing that a stopped run
//! could go on from, is cleared unasked.

use std::fs;
use std::path::Path;

use super::provenance::{Claim, Owner};
use super::{
    CHECKPOINT, FIGURES, LAST_CONVERGED, PARAVIEW, TABLES, holds_checkpoints, holds_results, owner,
    refuse_foreign, with_meshes,
};
use crate::error::ResultsError;

/// The results that a run may replace in its folder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Replace {
    /// Results of the same case whose run came to its end, or left nothing to go on from.
    #[default]
    Finished,
    /// Also those of a run of the same case that was stopped.
    Stopped,
    /// Also those of another case.
    Everything,
}

/// Asks whether a run may begin afresh in a folder; nothing is changed.
///
/// Results of a case may be replaced by another run of the same case file, also when it was edited.
///
/// # Errors
/// [`ResultsError::ForeignFolder`], [`ResultsError::OtherResults`], [`ResultsError::Unfinished`].
pub fn admit(root: &Path, claim: &Claim, replace: Replace) -> Result<(), ResultsError> {
    refuse_foreign(root)?;
    if replace == Replace::Everything || !holds_results(root) {
        return Ok(());
    }
    let other = |case: String, title: String| ResultsError::OtherResults {
        path: root.into(),
        case,
        title,
    };
    let Some(found) = owner(root) else {
        return Err(other(String::new(), String::new()));
    };
    if !found.is_same_case(&Owner::of(claim, root, false)) {
        return Err(other(found.case, found.title));
    }
    if replace == Replace::Finished && !found.finished && holds_checkpoints(root) {
        return Err(ResultsError::Unfinished {
            path: root.into(),
            same_input: found.input == claim.input,
        });
    }
    Ok(())
}

/// Refuses a results folder that has links in the places of its own folders: what is written or cleared
/// there would be elsewhere. The folder itself may be a link.
///
/// # Errors
/// [`ResultsError::Link`].
pub fn refuse_links(root: &Path) -> Result<(), ResultsError> {
    let names = TABLES
        .into_iter()
        .chain([FIGURES, PARAVIEW, CHECKPOINT, LAST_CONVERGED]);
    let names: Vec<&str> = names.collect();
    for (number, folder) in with_meshes(root).enumerate() {
        if number > 0 {
            refuse_link(&folder)?;
        }
        for name in &names {
            refuse_link(&folder.join(name))?;
        }
    }
    Ok(())
}

/// Refuses a link.
///
/// # Errors
/// [`ResultsError::Link`].
pub fn refuse_link(path: &Path) -> Result<(), ResultsError> {
    match fs::symlink_metadata(path) {
        Ok(about) if about.is_symlink() => Err(ResultsError::Link { path: path.into() }),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::folder::provenance::Origin;
    use crate::folder::tests::{claim_of, everything};
    use crate::folder::{Folder, mark, of_study};
    use crate::scratch::Scratch;

    /// GOAL: results are replaced by those of the same case, and by nothing else unasked.
    #[test]
    fn another_case_and_a_stopped_run_are_not_cleared_unasked() {
        let scratch = Scratch::new();
        let root = scratch.path().join("results");
        let original = claim_of("a.toml");
        let folder = Folder::afresh(&root, &original).unwrap();
        everything(&folder);
        let (other, edited) = (
            claim_of("b.toml"),
            Claim {
                input: "edited".into(),
                ..original.clone()
            },
        );
        let refused = |claim: &Claim, replace: Replace| {
            scratch.hide(&admit(&root, claim, replace).unwrap_err())
        };
        insta::assert_snapshot!(
            refused(&original, Replace::Finished),
            @"DIR/results holds a run that was stopped and can go on: --resume goes on with it, --overwrite begins afresh, --out chooses another folder"
        );
        insta::assert_snapshot!(
            refused(&edited, Replace::Finished),
            @"DIR/results holds a run that was stopped and can go on with the input that it had: --overwrite begins afresh, --out chooses another folder"
        );
        for replace in [Replace::Finished, Replace::Stopped] {
            insta::allow_duplicates! {
                insta::assert_snapshot!(
                    refused(&other, replace),
                    @r#"DIR/results holds results of another input, <a.toml> ("The case a.toml"): --out chooses another folder, --overwrite replaces them"#
                );
            }
        }
        admit(&root, &edited, Replace::Stopped).unwrap();
        admit(&root, &other, Replace::Everything).unwrap();
        mark(&root, &original, true).unwrap();
        admit(&root, &original, Replace::Finished).unwrap();
        admit(&root, &edited, Replace::Finished).unwrap();
        assert!(admit(&root, &other, Replace::Finished).is_err());
        let moved = Claim {
            origin: Origin::Text("moved.toml".into()),
            ..original.clone()
        };
        admit(&root, &moved, Replace::Finished).unwrap();
        // Its owner is not known.
        fs::remove_file(root.join(".igimp")).unwrap();
        insta::assert_snapshot!(
            refused(&original, Replace::Finished),
            @"DIR/results holds results of an input that is not known: --out chooses another folder, --overwrite replaces them"
        );
    }

    #[test]
    fn a_run_that_left_nothing_to_go_on_from_is_begun_again() {
        let scratch = Scratch::new();
        let claim = claim_of("a.toml");
        let folder = Folder::afresh(scratch.path(), &claim).unwrap();
        fs::write(folder.convergence(), "stage\n").unwrap();
        admit(scratch.path(), &claim, Replace::Finished).unwrap();
        assert!(admit(scratch.path(), &claim_of("b.toml"), Replace::Finished).is_err());
    }

    /// GOAL: nothing is written or cleared through a link in the place of a folder.
    #[cfg(unix)]
    #[test]
    fn folders_that_are_links_are_refused() {
        use std::os::unix::fs::symlink;
        let scratch = Scratch::new();
        let (root, outside) = (
            scratch.path().join("results"),
            scratch.path().join("outside"),
        );
        Folder::afresh(&root, &claim_of("a.toml")).unwrap();
        fs::create_dir(&outside).unwrap();
        fs::write(outside.join("mine.csv"), "the user's").unwrap();
        fs::remove_dir(root.join("curves")).unwrap();
        symlink(&outside, root.join("curves")).unwrap();
        let error = Folder::afresh(&root, &claim_of("a.toml")).unwrap_err();
        insta::assert_snapshot!(
            scratch.hide(&error),
            @"DIR/results/curves is a link that leads elsewhere; remove it, or choose another folder for the results"
        );
        assert!(Folder::open(&root).is_err());
        fs::remove_file(root.join("curves")).unwrap();
        symlink(&outside, root.join("mesh-2")).unwrap();
        assert!(of_study(&root, &claim_of("a.toml"), true).is_err());
        assert_eq!(scratch.names("outside"), ["mine.csv"]);
        fs::remove_file(root.join("mesh-2")).unwrap();
        // The folder itself may be somewhere else.
        symlink(&root, scratch.path().join("linked")).unwrap();
        Folder::afresh(&scratch.path().join("linked"), &claim_of("a.toml")).unwrap();
    }
}
