//! Fuzzing on stable Rust.
//!
//! Three [targets](targets::Target) read what may come from anywhere: case files, checkpoints,
//! quantities. A run takes every entry of the corpus, then damaged entries without end: bytes and
//! words edited, lines moved, texts spliced and cut, numbers driven to extremes. An input must not
//! make a reader panic or hang, and what a target states must hold of it.
//!
//! The input of an execution follows from seed and number of the execution alone, whatever the
//! number of threads. There is no feedback from coverage, which stable Rust does not give; the
//! corpus holds an input for each path worth starting from instead.

pub mod input;
pub mod minimise;
pub mod mutate;
pub mod random;
pub mod run;
pub mod targets;
pub mod words;

mod watch;
