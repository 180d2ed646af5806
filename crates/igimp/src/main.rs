//! `igimp`: writes, checks, runs and compares case files. The commands are one file each; what
//! they do is in the library.

mod arguments;
mod cases;
mod clock;
mod error;
mod interrupt;
mod output;
mod pages;
mod progress;
mod report;
mod run;
mod scheduler;
mod sweep;
mod template;
mod validate;
mod view;

use std::borrow::Cow;
use std::process::ExitCode;

use clap::Parser;
use igimp_text::on_lines;

use crate::arguments::{Command, CommandLine};
use crate::error::{Exit, ProgramError};

fn main() -> ExitCode {
    let program = match CommandLine::try_parse() {
        Ok(program) => program,
        Err(error) => {
            // Words of the command line are shown again in errors; help that nobody reads any more is no
            // failure.
            let plain = error.render().to_string();
            if matches!(on_lines(&plain), Cow::Borrowed(_)) {
                let _ = error.print();
            } else {
                output::complain(&plain);
            }
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(Exit::BadInput as u8));
        }
    };
    let exit = obey(&program.command).unwrap_or_else(|error| {
        if !error.is_closed_pipe() {
            output::complain(&error.render());
        }
        error.exit()
    });
    ExitCode::from(exit as u8)
}

fn obey(command: &Command) -> Result<Exit, ProgramError> {
    match command {
        Command::New(arguments) => template::new(arguments),
        Command::Check(arguments) => cases::check(arguments),
        Command::Explain(arguments) => cases::explain(arguments),
        Command::Run(arguments) => run::run(arguments),
        Command::Report(arguments) => report::report(arguments),
        Command::View(arguments) => view::view(arguments),
        Command::Sweep(arguments) => sweep::sweep(arguments),
        Command::Collect(arguments) => sweep::collect(arguments),
        Command::Validate(arguments) => validate::validate(arguments),
        Command::Schema => pages::schema(),
        Command::Completions(arguments) => pages::completions(arguments),
        Command::Man(arguments) => pages::man(arguments),
    }
}
