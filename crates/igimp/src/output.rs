//! Writing to the terminal. A reader that goes away never makes the program panic, and the text of a file
//! never commands the terminal.

use std::io::{ErrorKind, Write};

use igimp_model::AnyCase;
use igimp_results::ResultsError;
use igimp_text::on_lines;

use crate::error::ProgramError;

/// Prints the result of a command; a text without line break at its end gets one.
pub(crate) fn print(text: &str) -> Result<(), ProgramError> {
    let mut out = std::io::stdout().lock();
    let end = if text.is_empty() || text.ends_with('\n') {
        ""
    } else {
        "\n"
    };
    write!(out, "{}{end}", on_lines(text))
        .and_then(|()| out.flush())
        .map_err(ProgramError::Output)
}

/// Prints a line of progress or of the end of a run. A reader that went away is not missed: the
/// run goes on.
pub(crate) fn say(text: &str) -> Result<(), ProgramError> {
    match print(text) {
        Err(ProgramError::Output(error)) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        other => other,
    }
}

/// Prints an error, a warning or a note.
pub(crate) fn print_message(text: &str) {
    // There is nowhere left to tell that standard error is closed.
    let _ = writeln!(std::io::stderr().lock(), "{}", on_lines(text.trim_end()));
}

/// Prints the warnings of a case file, if there are any.
pub(crate) fn warn(warnings: &str) {
    if !warnings.trim().is_empty() {
        print_message(warnings);
    }
}

/// Number of the stage with a name.
pub(crate) fn stage_named(case: &AnyCase, name: &str) -> Result<usize, ProgramError> {
    let names = || case.stages().iter().map(|stage| stage.name.as_str());
    names().position(|known| known == name).ok_or_else(|| {
        let help = igimp_input::shipped::closest(name, names()).map_or_else(
            || {
                let quoted: Vec<String> = names().map(|name| format!("\"{name}\"")).collect();
                format!("stages: {}", quoted.join(", "))
            },
            |near| format!("did you mean \"{near}\"?"),
        );
        ProgramError::usage(format!("there is no stage \"{name}\""), help)
    })
}

/// Makes the pool of threads of the size asked for.
pub(crate) fn use_threads(threads: Option<usize>) {
    if let Some(threads) = threads {
        // Fails only if the pool exists already, which it does not at the start.
        let _ = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build_global();
    }
}

/// A folder that can be written into, made now rather than after an hour of computing.
pub(crate) fn writable(folder: &std::path::Path) -> Result<(), ProgramError> {
    std::fs::create_dir_all(folder).map_err(|source| {
        ResultsError::File {
            path: folder.to_owned(),
            source,
        }
        .into()
    })
}

/// A word as a shell reads it back.
pub(crate) fn quoted(word: &str) -> String {
    let plain = |letter: char| letter.is_alphanumeric() || "_-./=:,+@%".contains(letter);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}
