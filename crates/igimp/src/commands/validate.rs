//! `igimp validate`: the cases that come with the program, held against their references.

use igimp_cases::run::{self, Nobody, Start, Target};
use igimp_estimate::estimate;
use igimp_input::CaseFile;
use igimp_input::shipped::{SHIPPED, Shipped, find, nearest};
use igimp_model::{AnyCase, in_any_dimension};
use igimp_results::ending::Ending;
use igimp_results::folder::overwrite_guard::Replace;
use igimp_study::narration::verdict;

use crate::arguments::Validate;
use crate::error::{Exit, ProgramError};
use crate::{clock, interrupt, output};

/// Steps times unknowns up to which a case counts as quick: seconds on any computer.
const QUICK: f64 = 2e5;

pub(crate) fn validate(arguments: &Validate) -> Result<Exit, ProgramError> {
    output::use_threads(arguments.threads);
    let chosen = choose(&arguments.names)?;
    let flag = interrupt::watch();
    let date = clock::now()?;
    let mut worst = Exit::Done;
    let (mut ran, mut met, mut missed) = (0, 0, 0);
    for shipped in chosen {
        let file = CaseFile::parse(&format!("{}.toml", shipped.name), shipped.text, &[])?;
        if arguments.quick
            && in_any_dimension!(file.any_case(), case => estimate(case))?.work > QUICK
        {
            continue;
        }
        ran += 1;
        let target = arguments.out.as_ref().map(|out| Target {
            replace: Replace::Stopped,
            date: date.clone(),
            ..Target::of(&file, out.join(shipped.name))
        });
        let mut case = file.any_case().clone();
        if let Some(target) = &target {
            case.output_mut().folder.clone_from(&target.folder);
        }
        let run = run::run_any(&case, target.as_ref(), Start::Afresh, &mut Nobody, &flag)?;
        let ending = run.summary.ending();
        output::say(&format!("{}: {ending}", shipped.name))?;
        output::say(&verdict::checks(&run.summary.checks))?;
        if let Some(failure) = &run.failure {
            output::print_message(&failure.to_string());
            worst = worst.max(Exit::NotConverged);
        }
        worst = worst.max(ending.into());
        let passed = run.summary.checks.iter().filter(|row| row.pass).count();
        met += passed;
        missed += run.summary.checks.len() - passed;
        if ending == Ending::Interrupted {
            break;
        }
    }
    output::say(&format!(
        "{ran} cases; references: {met} met, {missed} missed"
    ))?;
    Ok(worst)
}

/// The cases named, or all that declare references.
fn choose(names: &[String]) -> Result<Vec<&'static Shipped>, ProgramError> {
    if !names.is_empty() {
        return names.iter().map(|name| named(name)).collect();
    }
    let mut chosen = Vec::new();
    for shipped in SHIPPED {
        let file = CaseFile::parse(&format!("{}.toml", shipped.name), shipped.text, &[])?;
        if declares_references(file.any_case()) {
            chosen.push(shipped);
        }
    }
    Ok(chosen)
}

fn named(name: &str) -> Result<&'static Shipped, ProgramError> {
    find(name).ok_or_else(|| {
        let help = nearest(name).map_or_else(
            || "igimp new --list shows them".to_owned(),
            |near| format!("did you mean `{near}`?"),
        );
        ProgramError::usage(format!("there is no built-in case `{name}`"), help)
    })
}

/// Whether a case holds anything against an outside value.
fn declares_references(case: &AnyCase) -> bool {
    let curves = || {
        case.curves()
            .iter()
            .filter_map(|curve| curve.reference.as_ref())
    };
    !case.checks().is_empty() || curves().any(|reference| reference.tolerance.is_some())
}
