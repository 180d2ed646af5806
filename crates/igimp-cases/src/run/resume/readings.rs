//! What the tables, sections and checks of a run were read from: a later stage may begin with others than those before it had.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// What was read up to a checkpoint, and from what.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Readings {
    /// By path of a table within the results folder.
    pub(crate) tables: BTreeMap<String, TableReading>,
    /// By section: what its tables are read from.
    pub(crate) sections: BTreeMap<String, String>,
    /// By row of the checks so far: what its value was read from.
    pub(crate) checks: Vec<String>,
}

/// What a table is read from, and its rows at the end of a stage.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct TableReading {
    /// Fingerprint of what its columns are read from.
    pub(crate) definition: String,
    /// Number of the first stage that it was read in, from 0.
    pub(crate) since: usize,
    /// How many rows it had.
    pub(crate) rows: usize,
    /// Fingerprint of header and rows; empty within a stage.
    pub(crate) digest: String,
}
