//! The sources of tables, sections and checks of a run: a later stage may begin with others than those before it had.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Readings up to a checkpoint, and their sources.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Readings {
    /// By path of a table within the results folder.
    pub(crate) tables: BTreeMap<String, TableReading>,
    /// By section: the source of its tables.
    pub(crate) sections: BTreeMap<String, String>,
    /// By row of the checks so far: the source of its value.
    pub(crate) checks: Vec<String>,
}

/// The source of a table, and its rows at the end of a stage.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct TableReading {
    /// Fingerprint of the source of its columns.
    pub(crate) definition: String,
    /// Number of the first stage that it was read in, from 0.
    pub(crate) since: usize,
    /// How many rows it had.
    pub(crate) rows: usize,
    /// Fingerprint of header and rows; empty within a stage.
    pub(crate) digest: String,
}
