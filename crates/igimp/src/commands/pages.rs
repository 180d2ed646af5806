//! `igimp schema`, `igimp completions` and `igimp man`: texts for other programs.

use clap::CommandFactory;

use crate::arguments::{CommandLine, Completions, Man};
use crate::error::{Exit, ProgramError};
use crate::output;

pub(crate) fn schema() -> Result<Exit, ProgramError> {
    output::print(&format!("{:#}", igimp_schema::json_schema()))?;
    Ok(Exit::Done)
}

pub(crate) fn completions(arguments: &Completions) -> Result<Exit, ProgramError> {
    let mut text = Vec::new();
    clap_complete::generate(
        arguments.shell,
        &mut CommandLine::command(),
        "igimp",
        &mut text,
    );
    output::print(&String::from_utf8_lossy(&text))?;
    Ok(Exit::Done)
}

pub(crate) fn man(arguments: &Man) -> Result<Exit, ProgramError> {
    if let Some(folder) = &arguments.out {
        let file = |source| ProgramError::File {
            path: folder.clone(),
            source,
        };
        std::fs::create_dir_all(folder).map_err(file)?;
        // `help` is a command without a page of its own.
        let command = CommandLine::command().disable_help_subcommand(true);
        clap_mangen::generate_to(command, folder).map_err(file)?;
        return Ok(Exit::Done);
    }
    let mut text = Vec::new();
    clap_mangen::Man::new(CommandLine::command())
        .render(&mut text)
        .map_err(ProgramError::Output)?;
    output::print(&String::from_utf8_lossy(&text))?;
    Ok(Exit::Done)
}
