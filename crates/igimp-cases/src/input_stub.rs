//! Reads case files: stands in for the reader, with a fixed case behind every file.

use std::path::{Path, PathBuf};

use igimp_assembly::Method;
use thiserror::Error;

use crate::case::{
    BodyPart, Boundaries, Case, Every, GridSpec, Material, Output, Side, SolverSettings, Stage,
    StageKind, StopWhen, Strength,
};

/// A case file that was read.
#[derive(Clone, Debug)]
pub struct CaseFile {
    case: Case,
    source: String,
    sets: Vec<String>,
}

/// Why a case file cannot be used.
#[derive(Debug, Error)]
pub enum InputError {
    /// The file cannot be read.
    #[error("cannot read {}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        #[source]
        source: std::io::Error,
    },
    /// The file says something that makes no sense.
    #[error("{text}")]
    Invalid {
        /// The complete message.
        text: String,
        /// How many errors there are.
        errors: usize,
    },
}

impl CaseFile {
    /// Reads a file, with settings `KEY=VALUE` that replace what it says.
    ///
    /// # Errors
    /// [`InputError`].
    pub fn read(path: &Path, sets: &[String]) -> Result<Self, InputError> {
        let text = std::fs::read_to_string(path).map_err(|source| InputError::File {
            path: path.to_owned(),
            source,
        })?;
        Self::parse(&path.display().to_string(), &text, sets)
    }

    /// Reads a text.
    ///
    /// # Errors
    /// [`InputError::Invalid`].
    pub fn parse(name: &str, text: &str, sets: &[String]) -> Result<Self, InputError> {
        let invalid = |text: String| InputError::Invalid { text, errors: 1 };
        let table: toml::Table = toml::from_str(text)
            .map_err(|error| invalid(format!("error: {error}\n --> {name}")))?;
        if let Some(set) = sets.iter().find(|set| !set.contains('=')) {
            return Err(invalid(format!("error: `{set}` is not KEY=VALUE")));
        }
        if !table.contains_key("igimp") {
            return Err(invalid(format!(
                "error: `igimp = 1` is missing\n --> {name}"
            )));
        }
        let folder = table
            .get("output")
            .and_then(|output| output.get("folder")?.as_str())
            .unwrap_or("results");
        Ok(Self {
            case: fixed(folder.into()),
            source: text.to_owned(),
            sets: sets.to_vec(),
        })
    }

    /// The case.
    pub fn case(&self) -> &Case {
        &self.case
    }

    /// Warnings, rendered; empty when there are none.
    pub fn warnings(&self) -> String {
        String::new()
    }

    /// The file with every default.
    pub fn explain(&self) -> String {
        format!("{}# {:?}\n", self.source, self.sets)
    }

    /// The file as given.
    pub fn source(&self) -> &str {
        &self.source
    }
}

/// The JSON schema of case files.
pub fn json_schema() -> serde_json::Value {
    serde_json::json!({ "title": "igimp case file", "type": "object" })
}

fn fixed(folder: PathBuf) -> Case {
    Case {
        title: "block under its weight".into(),
        gravity: 9.81,
        grid: GridSpec {
            cell: [0.5, 0.5],
            lower: [0.0, 0.0],
            cells: [8, 8],
        },
        method: Method::default(),
        materials: vec![Material {
            name: "clay".into(),
            unit_weight: 18e3,
            young: 10e6,
            poisson: 0.3,
            strength: Strength::Elastic,
            k0: None,
        }],
        bodies: vec![BodyPart {
            name: "block".into(),
            material: 0,
            per_direction: 2,
            polygon: vec![[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]],
        }],
        boundaries: Boundaries {
            left: Side::Roller,
            right: Side::Roller,
            bottom: Side::Fixed,
            top: Side::Free,
            boxes: Vec::new(),
        },
        loads: Vec::new(),
        stages: vec![Stage {
            name: "own weight".into(),
            kind: StageKind::Gravity { factor: 1.0 },
            steps: 5,
            start_from: None,
            reset_displacements: false,
            stop_when: StopWhen::default(),
        }],
        solver: SolverSettings::default(),
        monitors: Vec::new(),
        sections: Vec::new(),
        curves: Vec::new(),
        checks: Vec::new(),
        output: Output {
            folder,
            paraview: Every::Never,
            figures: Vec::new(),
            report: false,
            checkpoint_every: 0,
            checkpoint_keep: 1,
        },
    }
}
