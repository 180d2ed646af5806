//! The program `igimp` as a library: writes, checks, runs and compares case files. The commands are one file each; their
//! work is done by the libraries below. Another program may hand in the linear solver here, and nothing else.

mod arguments;
mod clock;
mod commands;
mod error;
mod interrupt;
mod output;
mod progress;
mod scheduler;

use std::borrow::Cow;
use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser;
use igimp_model::GivenSolver;
use igimp_text::on_lines;

use crate::arguments::{Command, CommandLine};
use crate::error::{Exit, ProgramError};

/// Runs the words of a command line, the first being the name of the program; its exit code is that of the
/// program. Runs solve their linear systems with a given solver, if there is one.
pub fn program(words: impl IntoIterator<Item = OsString>, given: Option<&GivenSolver>) -> ExitCode {
    let program = match CommandLine::try_parse_from(words) {
        Ok(program) => program,
        Err(error) => {
            // Words of the command line are shown again in errors; help that nobody reads any more is no
            // failure.
            let plain = error.render().to_string();
            if matches!(on_lines(&plain), Cow::Borrowed(_)) {
                let _ = error.print();
            } else {
                output::print_message(&plain);
            }
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(Exit::BadInput as u8));
        }
    };
    let exit = dispatch(&program.command, given).unwrap_or_else(|error| {
        if !error.is_closed_pipe() {
            output::print_message(&error.render());
        }
        error.exit()
    });
    ExitCode::from(exit as u8)
}

fn dispatch(command: &Command, given: Option<&GivenSolver>) -> Result<Exit, ProgramError> {
    match command {
        Command::New(arguments) => commands::template::new(arguments),
        Command::Check(arguments) => commands::cases::check(arguments),
        Command::Explain(arguments) => commands::cases::explain(arguments),
        Command::Run(arguments) => commands::run::run(arguments, given),
        Command::Report(arguments) => commands::report::report(arguments),
        Command::Element(arguments) => commands::element::element(arguments),
        Command::Fit(arguments) => commands::fit::fit(arguments),
        Command::View(arguments) => commands::view::view(arguments),
        Command::Film(arguments) => commands::film::film(arguments),
        Command::Sweep(arguments) => commands::sweep::sweep(arguments),
        Command::Collect(arguments) => commands::sweep::collect(arguments),
        Command::Validate(arguments) => commands::validate::validate(arguments),
        Command::Schema => commands::pages::schema(),
        Command::Completions(arguments) => commands::pages::completions(arguments),
        Command::Man(arguments) => commands::pages::man(arguments),
    }
}
