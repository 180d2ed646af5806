//! `igimp run`.

use std::path::Path;

use igimp_cases::run::{self as engine, Start, Target};
use igimp_estimate::Expectation;
use igimp_estimate::room::refuse_beyond;
use igimp_estimate::watch::{exceeded, lacks_memory};
use igimp_model::{GivenSolver, in_any_dimension};
use igimp_results::ending::Ending;
use igimp_results::folder::overwrite_guard::Replace;
use igimp_study::narration::verdict;
use igimp_study::sweep::{Sweep, TaskLock};

use crate::arguments::RunArguments;
use crate::commands::cases;
use crate::error::{Exit, ProgramError};
use crate::output::{self, quoted};
use crate::progress::Progress;
use crate::{clock, interrupt};

pub(crate) fn run(
    arguments: &RunArguments,
    given: Option<&GivenSolver>,
) -> Result<Exit, ProgramError> {
    output::use_threads(arguments.threads);
    if let Some(number) = arguments.task {
        return task(arguments, number, given);
    }
    let flag = interrupt::watch();
    let file = cases::read(&arguments.case, &arguments.settings())?;
    output::warn(&file.warnings());
    let mut case = file.any_case().clone();
    case.give_solver(given);
    if let Some(out) = &arguments.out {
        case.output_mut().folder.clone_from(out);
    }
    let start = match &arguments.from_stage {
        Some(name) => Start::FromStage(output::stage_named(&case, name)?),
        None => afresh_or_resume(arguments),
    };
    let folder = case.output().folder.clone();
    in_any_dimension!(&case, case => refuse_beyond(case))?;
    output::writable(&folder)?;
    // A run that goes on makes a part of the steps only, and nobody knows the needs of a given solver.
    let expectation = match start {
        Start::Afresh if given.is_none() => {
            in_any_dimension!(&case, case => Expectation::of(case)).ok()
        }
        Start::Afresh | Start::Resume | Start::FromStage(_) => None,
    };
    let need = expectation.as_ref();
    if let Some(lack) = need.and_then(|need| lacks_memory(need.bytes, need.most_bytes)) {
        output::print_message(&format!("warning: {lack}"));
    }
    let target = Target {
        systems: arguments.export_matrix.clone(),
        date: clock::now()?,
        expectation,
        replace: replace(arguments.overwrite),
        ..Target::of(&file, &folder)
    };
    let mut progress = Progress::new(arguments.quiet, &case);
    let run = engine::run_any(&case, Some(&target), start, &mut progress, &flag);
    progress.finish();
    match run {
        Ok(run) => tell(&run, &folder, arguments, &file.warning_sentences()),
        Err(error) => Ok(give_up(&error.into(), &folder, arguments)),
    }
}

/// Tells of a run that cannot go on, and how it can later if there is something to go on from.
fn give_up(error: &ProgramError, folder: &Path, arguments: &RunArguments) -> Exit {
    output::print_message(&error.render());
    let kept =
        std::fs::read_dir(folder.join("checkpoint")).is_ok_and(|mut saved| saved.next().is_some());
    let entered = !matches!(error, ProgramError::Case(error) if error.is_in_use());
    if error.exit() == Exit::InputOutput && kept && entered {
        output::print_message(&format!(
            "what was computed is kept; to go on later: {}",
            again(arguments)
        ));
    }
    error.exit()
}

/// One task of a sweep.
fn task(
    arguments: &RunArguments,
    number: usize,
    given: Option<&GivenSolver>,
) -> Result<Exit, ProgramError> {
    let flag = interrupt::watch();
    let sweep = Sweep {
        date: clock::now()?,
        given_solver: given.cloned(),
        ..Sweep::read_unchecked(&arguments.case)?
    };
    let task = sweep.task(number)?;
    if !arguments.quiet {
        output::say(&format!("task {number}: {}", task.label()))?;
    }
    let mut progress = Progress::new(arguments.quiet, sweep.case_of(task)?.any_case());
    if !arguments.resume {
        let replace = replace(arguments.overwrite);
        let _shared = sweep.enter(false, replace)?;
        let run = sweep.run_task(task, Start::Afresh, replace, &mut progress, &flag);
        progress.finish();
        let (run, _) = run?;
        return tell(&run, &task.folder, arguments, &[]);
    }
    let turn = sweep.take_up(task, &mut progress, &flag, |folder| {
        output::print_message(&format!(
            "another igimp writes into {}; waiting until it has ended",
            folder.display()
        ));
    });
    progress.finish();
    match turn? {
        TaskLock::Ran(run, _) => tell(&run, &task.folder, arguments, &[]),
        TaskLock::Done(ending) => {
            output::say(&format!("task {number} is done already: {ending}"))?;
            Ok(ending.into())
        }
        TaskLock::Elsewhere => {
            output::print_message(&format!(
                "interrupted while another igimp ran task {number}; to go on: {}",
                again(arguments)
            ));
            Ok(Exit::NotConverged)
        }
    }
}

/// The results that may be replaced.
pub(crate) fn replace(overwrite: bool) -> Replace {
    if overwrite {
        Replace::Everything
    } else {
        Replace::Finished
    }
}

fn afresh_or_resume(arguments: &RunArguments) -> Start {
    if arguments.resume {
        Start::Resume
    } else {
        Start::Afresh
    }
}

/// Says how a run ended; warnings of the case file that were printed are not said again.
fn tell(
    run: &engine::Account,
    folder: &Path,
    arguments: &RunArguments,
    printed: &[String],
) -> Result<Exit, ProgramError> {
    let summary = &run.summary;
    let ending = summary.ending();
    if arguments.quiet {
        let unsaid = |text: &&String| !printed.contains(*text);
        for warning in summary.warnings.iter().filter(unsaid) {
            output::print_message(&format!("warning: {warning}"));
        }
    }
    output::say(&verdict::stages_and_checks(summary))?;
    if let Some(failure) = &run.failure {
        output::print_message(&failure.to_string());
    }
    if ending == Ending::Interrupted {
        output::print_message(&format!("interrupted; to go on: {}", again(arguments)));
    }
    if let Some(systems) = &arguments.export_matrix {
        output::say(&format!("linear systems in {}", systems.display()))?;
    }
    output::say(&verdict::results(summary, folder))?;
    for more in exceeded(summary) {
        output::print_message(&format!("warning: {more}"));
    }
    let mut exit = match &run.failure {
        Some(failure) if failure.is_want_of_memory() => Exit::InputOutput,
        Some(_) => Exit::NotConverged,
        None => ending.into(),
    };
    // Of faults on several meshes the worst counts; refusals of the system are apart.
    for error in &run.lost {
        output::print_message(&igimp_cases::chain(error));
        exit = exit.max(crate::error::of_error(error));
    }
    Ok(exit)
}

/// The command that goes on with an interrupted run.
fn again(arguments: &RunArguments) -> String {
    let mut words = vec!["igimp".to_owned(), "run".to_owned()];
    words.push(quoted(&arguments.case.display().to_string()));
    if let Some(task) = arguments.task {
        words.push(format!("--task {task}"));
    }
    if let Some(out) = &arguments.out {
        words.push(format!("--out {}", quoted(&out.display().to_string())));
    }
    for set in &arguments.set {
        words.push(format!("--set {}", quoted(set)));
    }
    if let Some(meshes) = arguments.meshes {
        words.push(format!("--meshes {meshes}"));
    }
    if let Some(memory) = &arguments.memory {
        words.push(format!("--memory {}", quoted(memory)));
    }
    if let Some(systems) = &arguments.export_matrix {
        let systems = quoted(&systems.display().to_string());
        words.push(format!("--export-matrix {systems}"));
    }
    if let Some(threads) = arguments.threads {
        words.push(format!("--threads {threads}"));
    }
    words.push("--resume".to_owned());
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use crate::arguments::{Command, CommandLine};

    #[test]
    fn the_way_on_can_be_pasted() {
        let words = [
            "igimp",
            "run",
            "my slope.toml",
            "--set",
            "materials.clay.cohesion=12 kPa",
            "--out",
            "out/a",
            "--memory",
            "2 GiB",
            "--export-matrix",
            "my systems",
            "--quiet",
        ];
        let Command::Run(arguments) = CommandLine::parse_from(words).command else {
            panic!("a run");
        };
        assert_eq!(
            again(&arguments),
            "igimp run 'my slope.toml' --out out/a --set 'materials.clay.cohesion=12 kPa' \
             --memory '2 GiB' --export-matrix 'my systems' --resume"
        );
        assert_eq!(quoted("it's"), r"'it'\''s'");
    }
}
