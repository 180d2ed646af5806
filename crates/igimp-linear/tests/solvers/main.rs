//! GOAL: linear solvers find what is known, say what they cannot find, and give the same bits on any number of threads.

mod agreement;
mod failures;
mod ordering;
mod patterns;
mod record;
mod single;
mod support;
mod threads;
