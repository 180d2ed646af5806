//! `igimp view`: a results folder in the browser, by a small server on the loopback address.
//!
//! A folder that has a page and no run, as that of `igimp element`, needs no server: its page is opened.
//!
//! The address holds a random port and a random token. Nothing is ever written, nothing but the page
//! and the tables and frames of the folder is given away, and that only to clients that know the token and
//! ask this computer by its own name.

mod browser;
mod http;
mod results;
mod server;

use std::sync::mpsc;

use crate::arguments::View;
use crate::error::{Exit, ProgramError};
use crate::output;
use results::Results;
use server::Server;

pub(crate) fn view(arguments: &View) -> Result<Exit, ProgramError> {
    if arguments.beside.is_none()
        && let Some(page) = results::page_alone(&arguments.folder)
    {
        let page = page.display().to_string();
        output::say(&page)?;
        if !arguments.no_open {
            browser::open(&page);
        }
        return Ok(Exit::Done);
    }
    let results = Results::open(&arguments.folder)?;
    let beside = arguments.beside.as_deref().map(Results::open).transpose()?;
    let (interrupt, interrupted) = mpsc::channel();
    ctrlc::set_handler(move || {
        // The receiver is gone only when the program ends anyway.
        let _ = interrupt.send(());
    })
    .map_err(|error| ProgramError::usage(format!("cannot wait for Ctrl-C: {error}"), ""))?;
    let server = Server::bind(results, beside)?;
    let address = server.address();
    server.start()?;
    output::say(&format!("{address}\nCtrl-C ends the view"))?;
    if !arguments.no_open {
        browser::open(&address);
    }
    // The handler keeps its end for as long as the program lasts.
    let _ = interrupted.recv();
    Ok(Exit::Done)
}
