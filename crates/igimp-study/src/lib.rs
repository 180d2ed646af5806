//! Many runs, and the text on one: parameter studies, tests of laws, and the texts of the program and of Python.
//!
//! | module | contents |
//! |---|---|
//! | [`sweep`] | many cases that differ in a few values |
//! | [`element`] | a law on its own: test, table, pictures |
//! | [`fit`] | parameters of a law from data of the laboratory |
//! | [`narration`] | a case and its run as text |
//! | [`threads`] | how many threads may be asked for |

pub mod element;
pub mod fit;
pub mod narration;
pub mod sweep;
pub mod threads;

/// The examples of the book, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/src/tour.md")]
struct Tour;

/// The examples of the developer notes, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/src/developer.md")]
struct DeveloperNotes;

/// The example of the user guide, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/src/guide/library.md")]
struct UserGuide;
