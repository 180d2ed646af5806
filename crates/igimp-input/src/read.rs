//! Reads a case file.

use std::io::Read;
use std::path::{Path, PathBuf};

use igimp_files::bytes;
use igimp_model::{AnyCase, Case, Every, meshes};
use igimp_results::folder::provenance::Origin;
use igimp_schema::complete::complete;
use igimp_schema::diagnostic::{Diagnostic, Problems};
use igimp_schema::explain::explain;
use igimp_schema::overrides::apply;
use igimp_schema::source::{Place, Source};
use igimp_schema::syntax::parse;
use igimp_schema::tree::{Node, Value};
use thiserror::Error;

use super::build::build;
use super::in_time;

/// Most bytes of a case file.
const LARGEST: usize = 8 << 20;

/// A case file that was found right.
#[derive(Clone, Debug)]
pub struct CaseFile {
    case: AnyCase,
    completed: Node,
    text: String,
    origin: Origin,
    warnings: String,
    diagnostics: Vec<Diagnostic>,
}

/// Why a case file cannot be used.
#[derive(Debug, Error)]
pub enum InputError {
    /// The file cannot be read.
    #[error("cannot read {}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        #[source]
        source: std::io::Error,
    },
    /// The file does not state a case.
    #[error("{text}")]
    Invalid {
        /// Every problem with its place, ready to print.
        text: String,
        /// Number of errors, without warnings.
        errors: usize,
        /// The first thousand problems as data.
        diagnostics: Vec<Diagnostic>,
    },
}

impl CaseFile {
    /// Reads a file, changed by overrides such as `materials.clay.cohesion=12 kPa`.
    ///
    /// # Errors
    /// [`InputError`].
    pub fn read(path: &Path, overrides: &[String]) -> Result<Self, InputError> {
        let bytes = bytes::of_file(path, LARGEST as u64).map_err(|source| InputError::File {
            path: path.to_owned(),
            source,
        })?;
        let file = Self::from_bytes(&path.display().to_string(), bytes, overrides)?;
        Ok(Self {
            origin: Origin::File(path.to_owned()),
            ..file
        })
    }

    /// Reads what comes from elsewhere, such as standard input, under a name.
    ///
    /// # Errors
    /// [`InputError`].
    pub fn read_from(
        name: &str,
        reader: impl Read,
        overrides: &[String],
    ) -> Result<Self, InputError> {
        let bytes = bytes::of(reader, LARGEST as u64).map_err(|source| InputError::File {
            path: name.into(),
            source,
        })?;
        let file = Self::from_bytes(name, bytes, overrides)?;
        // Its name is that of many cases; their titles tell them apart.
        let origin = Origin::Text(format!("{name}: {}", file.case.title()));
        Ok(Self { origin, ..file })
    }

    /// Parses the bytes of a file of this name.
    ///
    /// # Errors
    /// [`InputError::Invalid`], also for bytes that are no UTF-8 text.
    pub fn from_bytes(
        name: &str,
        bytes: Vec<u8>,
        overrides: &[String],
    ) -> Result<Self, InputError> {
        if bytes.len() > LARGEST {
            return Err(too_large(name));
        }
        match String::from_utf8(bytes) {
            Ok(text) => Self::parse(name, &text, overrides),
            Err(error) => {
                let at = error.utf8_error().valid_up_to();
                let text = String::from_utf8_lossy(error.as_bytes()).into_owned();
                let mut problems = Problems::default();
                let wrong = at..at + char::REPLACEMENT_CHARACTER.len_utf8();
                problems
                    .error(Place::new(0, &wrong), "this is not UTF-8 text")
                    .help("save the file as UTF-8");
                Err(invalid(&problems, &[Source::new(name, &text, false)]))
            }
        }
    }

    /// Parses the text of a file of this name.
    ///
    /// # Errors
    /// [`InputError::Invalid`].
    pub fn parse(name: &str, text: &str, overrides: &[String]) -> Result<Self, InputError> {
        let mut problems = Problems::default();
        if text.len() > LARGEST {
            return Err(too_large(name));
        }
        let mut sources = vec![Source::new(name, text, false)];
        let mut tree = parse(&sources[0], &mut problems);
        if problems.errors() > 0 {
            return Err(invalid(&problems, &sources));
        }
        for text in overrides {
            sources.push(Source::new("command line", text, true));
        }
        for index in 1..sources.len() {
            apply(&mut tree, &sources, index, &mut problems);
        }
        in_time::expand(&mut tree);
        let mut completed = complete(&tree, &sources, &mut problems);
        igimp_files::read(&mut completed, Path::new(name), &mut problems);
        let case = build(&mut completed, Path::new(name), &mut problems);
        match case {
            Some(case) if problems.errors() == 0 => Ok(Self {
                case,
                completed,
                text: text.to_owned(),
                origin: Origin::Text(name.to_owned()),
                warnings: problems.render(&sources),
                diagnostics: problems.diagnostics(),
            }),
            _ => {
                if problems.errors() == 0 {
                    problems.error(None, "this file does not state a case");
                }
                Err(invalid(&problems, &sources))
            }
        }
    }

    /// The case, in the dimension that the file states.
    pub fn any_case(&self) -> &AnyCase {
        &self.case
    }

    /// The case of a file in plane strain.
    ///
    /// # Panics
    /// For a case in space; [`CaseFile::any_case`] tells.
    pub fn case(&self) -> &Case<2> {
        match &self.case {
            AnyCase::Plane(case) => case,
            AnyCase::Space(_) => panic!("the case is one in space"),
        }
    }

    /// The case of a file in space.
    ///
    /// # Panics
    /// For a case in plane strain; [`CaseFile::any_case`] tells.
    pub fn case_in_space(&self) -> &Case<3> {
        match &self.case {
            AnyCase::Space(case) => case,
            AnyCase::Plane(_) => panic!("the case is one in plane strain"),
        }
    }

    /// The case of a file in plane strain.
    ///
    /// # Panics
    /// For a case in space; [`CaseFile::any_case`] tells.
    pub fn into_case(self) -> Case<2> {
        match self.case {
            AnyCase::Plane(case) => case,
            AnyCase::Space(_) => panic!("the case is one in space"),
        }
    }

    /// Warnings, ready to print; empty when there are none.
    pub fn warnings(&self) -> String {
        self.warnings.clone()
    }

    /// Warnings in a sentence each, as they stand in summaries and reports: what is wrong, and what to do about it.
    pub fn warning_sentences(&self) -> Vec<String> {
        let all = self.diagnostics.iter();
        all.map(|warning| {
            [std::slice::from_ref(&warning.message), &warning.help]
                .concat()
                .join("; ")
        })
        .collect()
    }

    /// Warnings as data.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    /// The file with overrides and every default written out, commented; it states the same case.
    pub fn explain(&self) -> String {
        explain(&self.completed)
    }

    /// The completed file of every mesh of a study of the mesh error; nothing without a study.
    pub fn explain_meshes(&self) -> Vec<String> {
        if self.case.mesh_study().meshes < 2 {
            return Vec::new();
        }
        let parts = igimp_model::in_any_dimension!(&self.case, case => meshes::refinements(case));
        parts
            .iter()
            .map(|&parts| self.explain_mesh(parts))
            .collect()
    }

    fn explain_mesh(&self, parts: usize) -> String {
        let mut mesh = self.completed.clone();
        let stated = mesh.get("grid").and_then(|grid| grid.count_at("refine"));
        let refine = stated.unwrap_or(1) * parts;
        for (table, key, count) in [("grid", "refine", refine), ("mesh_study", "meshes", 1)] {
            if let Some(node) = mesh.get_mut(table).and_then(|table| table.get_mut(key)) {
                node.value = Value::Integer(i64::try_from(count).unwrap_or(i64::MAX));
                node.written = true;
            }
        }
        explain(&mesh)
    }

    /// The case with frames of the ends of its stages alone, unless the file states when they are written: for many runs side by
    /// side.
    #[must_use]
    pub fn with_few_frames(mut self) -> Self {
        let output = self.completed.get_mut("output");
        let frames = output.and_then(|output| output.get_mut("paraview"));
        if let Some(every) = frames.and_then(|frames| frames.get_mut("every"))
            && !every.written
        {
            every.value = Value::Text("stage".to_owned());
            self.case.output_mut().paraview = Every::Stage;
        }
        self
    }

    /// Where it comes from.
    pub fn origin(&self) -> &Origin {
        &self.origin
    }

    /// The text of the file.
    pub fn source(&self) -> &str {
        &self.text
    }
}

/// The text of a file of materials; bytes that are no UTF-8 text are replaced, and found wrong where they stand.
pub(super) fn text_of(path: &Path) -> Result<String, InputError> {
    let bytes = bytes::of_file(path, LARGEST as u64).map_err(|source| InputError::File {
        path: path.to_owned(),
        source,
    })?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn too_large(name: &str) -> InputError {
    let mut problems = Problems::default();
    let message = format!("this file has more than {} MB", LARGEST >> 20);
    problems.error(None, message).help("is it a case file?");
    invalid(&problems, &[Source::new(name, "", false)])
}

pub(super) fn invalid(problems: &Problems, sources: &[Source]) -> InputError {
    InputError::Invalid {
        text: problems.render(sources),
        errors: problems.errors(),
        diagnostics: problems.diagnostics(),
    }
}
