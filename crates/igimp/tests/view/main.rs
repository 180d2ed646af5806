//! GOAL: `igimp view` shows a results folder to the browser of this computer, and nothing of it to
//! anybody else.
//! ORACLE: the tables of the run. The page itself is tried in a headless browser where there is one.
#![cfg(unix)]

mod alone;
mod drawing;
mod over;
mod page;
mod serving;
mod space;
mod support;
