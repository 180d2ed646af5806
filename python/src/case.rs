//! Case files: read, changed by settings, checked, explained.

use std::path::{Path, PathBuf};

use igimp_input::shipped::{SHIPPED, find, nearest};
use igimp_model::in_any_dimension;
use igimp_study::narration::{size, table};
use igimp_study::sweep::is_sweep;
use pyo3::prelude::*;
use serde_json::json;

use crate::raised::{Raised, as_json};

/// A case file that was found right.
#[pyclass(frozen, module = "igimp._igimp")]
#[derive(Debug)]
pub(crate) struct CaseFile {
    pub(crate) file: igimp_input::CaseFile,
    pub(crate) name: PathBuf,
}

#[pymethods]
impl CaseFile {
    /// Reads a file, changed by settings `KEY=VALUE`.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf, settings: Vec<String>) -> PyResult<Self> {
        let read = py.detach(|| {
            let file = igimp_input::CaseFile::read(&path, &settings);
            if file.is_err() && is_sweep(&path) {
                return Err(Raised::bad_input(format!(
                    "error: {0} is a sweep, not a case\n  help: igimp sweep {0} runs it in a shell",
                    path.display()
                )));
            }
            Ok(file?)
        });
        Self::found(py, read, path)
    }

    /// Parses a text; files that it names lie beside the file of this name.
    #[staticmethod]
    fn parse(py: Python<'_>, name: PathBuf, text: String, settings: Vec<String>) -> PyResult<Self> {
        let read = py.detach(|| {
            let shown = name.display().to_string();
            Ok(igimp_input::CaseFile::read_from(
                &shown,
                text.as_bytes(),
                &settings,
            )?)
        });
        Self::found(py, read, name)
    }

    /// Title.
    #[getter]
    fn title(&self) -> &str {
        self.file.any_case().title()
    }

    /// 2 in plane strain, 3 in space.
    #[getter]
    fn dimensions(&self) -> usize {
        match self.file.any_case() {
            igimp_model::AnyCase::Plane(_) => 2,
            igimp_model::AnyCase::Space(_) => 3,
        }
    }

    /// Names of the materials.
    #[getter]
    fn materials(&self) -> Vec<String> {
        let materials = self.file.any_case().materials().iter();
        materials.map(|material| material.name.clone()).collect()
    }

    /// Name, kind and planned steps of every stage.
    #[getter]
    fn stages(&self) -> Vec<(String, &'static str, usize)> {
        let stages = self.file.any_case().stages().iter();
        stages
            .map(|stage| (stage.name.clone(), stage.kind.name(), stage.steps))
            .collect()
    }

    /// Results folder.
    #[getter]
    fn folder(&self) -> PathBuf {
        self.file.any_case().output().folder.clone()
    }

    /// Text of the file, without settings.
    #[getter]
    fn source(&self) -> &str {
        self.file.source()
    }

    /// The case with settings and every default, as TOML.
    #[getter]
    fn completed(&self) -> String {
        self.file.explain()
    }

    /// Warnings, ready to print; empty when there are none.
    #[getter]
    fn warnings(&self) -> String {
        self.file.warnings()
    }

    /// Warnings as JSON.
    #[getter]
    fn diagnostics(&self) -> String {
        as_json(self.file.diagnostics())
    }

    /// What the case will cost: its text, and its numbers as JSON.
    fn check(&self, py: Python<'_>) -> PyResult<(String, String)> {
        let cost = py.detach(|| {
            let case = self.file.any_case();
            in_any_dimension!(case, case => size::size(case, &self.name)).map_err(Raised::from)
        });
        let cost = cost.map_err(|raised| raised.exception(py))?;
        let numbers = json!({
            "particles": cost.size.particles,
            "cells": cost.size.cells,
            "unknowns": cost.size.unknowns,
            "bytes": cost.bytes,
            "most_bytes": cost.most_bytes,
            "seconds": cost.time.seconds,
            "open_ended": cost.time.open_ended,
            "threads": cost.time.threads,
            "solver": cost.size.systems.method,
        });
        Ok((cost.text, numbers.to_string()))
    }
}

impl CaseFile {
    fn found(
        py: Python<'_>,
        read: Result<igimp_input::CaseFile, Raised>,
        name: PathBuf,
    ) -> PyResult<Self> {
        let file = read.map_err(|raised| raised.exception(py))?;
        Ok(Self { file, name })
    }
}

/// Names and summaries of the case files that come with igimp.
#[pyfunction]
pub(crate) fn shipped() -> Vec<(&'static str, &'static str)> {
    SHIPPED
        .iter()
        .map(|case| (case.name, case.summary))
        .collect()
}

/// The text of a case file that comes with igimp.
#[pyfunction]
pub(crate) fn template(py: Python<'_>, name: &str) -> PyResult<(PathBuf, &'static str)> {
    if let Some(case) = find(name) {
        return Ok((Path::new(case.name).with_extension("toml"), case.text));
    }
    let rows: Vec<Vec<String>> = SHIPPED
        .iter()
        .map(|case| vec![case.name.to_owned(), case.summary.to_owned()])
        .collect();
    let near = nearest(name).map_or_else(String::new, |near| format!("did you mean `{near}`?\n"));
    let text = format!(
        "error: there is no template `{name}`\n  help: {near}templates:\n{}",
        table(&rows)
    );
    Err(Raised::bad_input(text.trim_end()).exception(py))
}
