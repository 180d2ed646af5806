//! A law on its own: the tests of `igimp element`, of the laws of the engine and of those in Python.

use std::path::{Path, PathBuf};

use igimp_input::MaterialsFile;
use igimp_schema::quantity::{Dimension, Quantity};
use igimp_study::element::{
    Drive, Kinematics, Request, StandardTest, Tested, chosen, name_of, of_name, read_data,
    read_path, test,
};
use pyo3::prelude::*;

use crate::arrays;
use crate::law::{Trouble, give_to};
use crate::raised::Raised;

/// A test of a law, as it was made.
#[pyclass(frozen, module = "igimp._igimp")]
#[derive(Debug)]
pub(crate) struct ElementTest(Tested);

#[pymethods]
impl ElementTest {
    /// What the program prints of it.
    #[getter]
    fn text(&self) -> &str {
        &self.0.text
    }

    /// Why it ended early; none where it did not.
    #[getter]
    fn failure(&self) -> Option<String> {
        self.0.run.failure.as_ref().map(ToString::to_string)
    }

    /// Its table: name, header, array with a row a step.
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        arrays::tables(py, vec![self.0.table.clone()])
    }

    /// Writes table and pictures into a folder, which is made; their names.
    fn write(&self, py: Python<'_>, folder: PathBuf) -> PyResult<Vec<String>> {
        std::fs::create_dir_all(&folder)?;
        let written = self.0.write(&folder).map_err(igimp_cases::CaseError::from);
        written.map_err(|error| Raised::from(error).exception(py))
    }
}

/// A quantity with its unit, or a number in SI units.
#[derive(Debug, FromPyObject)]
pub(crate) enum Given {
    /// In SI units.
    Number(f64),
    /// With its unit.
    Text(String),
}

impl Given {
    fn read(&self, py: Python<'_>, name: &str, dimension: Dimension) -> PyResult<f64> {
        match self {
            Self::Number(number) => Ok(*number),
            Self::Text(text) => Quantity::parse_as(text, dimension).map_err(|error| {
                let help = error.help(Some(dimension));
                refused(py, &format!("`{name}`: {error}"), &help)
            }),
        }
    }
}

/// What is driven, and how.
#[derive(Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Asked {
    material: Option<String>,
    test: String,
    path: Option<PathBuf>,
    stress: Given,
    side_stress: Option<Given>,
    strain: f64,
    steps: usize,
    duration: Given,
    small_strain: bool,
    data: Option<PathBuf>,
}

/// Drives a material of a file of this name and text, changed by settings; `law` is one in Python.
#[pyfunction]
pub(crate) fn element(
    py: Python<'_>,
    file: (PathBuf, String, Vec<String>),
    asked: Asked,
    law: Option<Py<PyAny>>,
) -> PyResult<ElementTest> {
    let (name, text, settings) = file;
    let file = MaterialsFile::parse(&name.display().to_string(), &text, &settings)
        .map_err(|error| Raised::from(error).exception(py))?;
    let mut material = chosen(&file.materials, asked.material.as_deref())
        .map_err(|error| refused(py, &error.problem, &error.names))?
        .clone();
    let trouble = Trouble::default();
    if let Some(law) = law {
        give_to(py, &mut material, law, &trouble)?;
    }
    let drive = drive(py, &asked, &name)?;
    let data = match &asked.data {
        None => None,
        Some(path) => {
            let made = material.law();
            let law = made.map_err(|error| refused(py, &error.to_string(), ""))?;
            let variables = law.internal_variables().iter().map(|own| own.name);
            let read = read_data(&beside(&name, path), &drive, &variables.collect::<Vec<_>>());
            Some(read.map_err(|error| refused(py, &error.to_string(), error.help()))?)
        }
    };
    let stress = asked.stress.read(py, "stress", Dimension::Stress)?;
    let side = asked.side_stress.as_ref();
    let side = side.map(|own| own.read(py, "side_stress", Dimension::Stress));
    let request = Request {
        drive,
        stress: [stress, side.transpose()?.unwrap_or(stress)],
        steps: asked.steps,
        kinematics: if asked.small_strain {
            Kinematics::Small
        } else {
            Kinematics::Finite
        },
        duration: asked.duration.read(py, "duration", Dimension::Time)?,
        data,
    };
    let tested = py.detach(|| test(&material, &request));
    if let Some(raised) = trouble.take() {
        return Err(raised);
    }
    let tested = tested.map_err(|error| {
        let help = "another initial stress, compression positive, or other steps";
        refused(
            py,
            igimp_cases::chain(&error).trim_start_matches("error: "),
            help,
        )
    })?;
    Ok(ElementTest(tested))
}

/// The path of a file, or a test of the laboratory.
fn drive(py: Python<'_>, asked: &Asked, name: &Path) -> PyResult<Drive> {
    if let Some(path) = &asked.path {
        let read = read_path(&beside(name, path));
        return read
            .map(Drive::Path)
            .map_err(|error| refused(py, &error.to_string(), error.help()));
    }
    let standard = of_name(&asked.test).ok_or_else(|| {
        let names = StandardTest::ALL.map(name_of).join(", ");
        refused(
            py,
            &format!("there is no test `{}`", asked.test),
            &format!("tests: {names}"),
        )
    })?;
    Ok(Drive::Standard(standard, asked.strain))
}

/// A file that lies beside another, unless its path is whole.
fn beside(name: &Path, path: &Path) -> PathBuf {
    name.parent().unwrap_or(Path::new("")).join(path)
}

/// Input that makes no sense, with what helps.
fn refused(py: Python<'_>, problem: &str, help: &str) -> PyErr {
    let help = if help.is_empty() {
        String::new()
    } else {
        format!("\n  help: {help}")
    };
    Raised::bad_input(format!("error: {problem}{help}")).exception(py)
}
