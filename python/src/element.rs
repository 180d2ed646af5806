//! A law on its own: the tests of `igimp element`, of the laws of the engine and of those in Python.

use std::path::{Path, PathBuf};

use igimp_input::MaterialsFile;
use igimp_model::Material;
use igimp_schema::quantity::{Dimension, Quantity};
use igimp_study::element::{
    Data, Drive, Kinematics, Request, StandardTest, TestError, Tested, chosen, name_of, of_name,
    parse_data, read_data, read_path, test,
};
use pyo3::prelude::*;

use crate::arrays;
use crate::law::{Trouble, give_to};
use crate::raised::Raised;

/// A test of a law, as it was made.
#[pyclass(frozen, module = "igimp._igimp")]
#[derive(Debug)]
pub(crate) struct ElementTest(pub(crate) Tested);

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

    /// What was measured beside what is computed: name, header, array with a row a measurement; empty without data.
    fn data<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        arrays::tables(py, self.0.data_table().into_iter().collect())
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

/// Measurements: a CSV file, or its text.
#[derive(Debug, FromPyObject)]
pub(crate) enum Measured {
    /// A file.
    File(PathBuf),
    /// A name and a text.
    Text(String, String),
}

/// What is driven, and how.
#[derive(Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Asked {
    test: String,
    path: Option<PathBuf>,
    stress: Given,
    side_stress: Option<Given>,
    /// Natural strain at the end; none goes as far as the data.
    strain: Option<f64>,
    steps: usize,
    duration: Given,
    small_strain: bool,
    data: Option<Measured>,
}

/// A file of materials: its name, its text, settings, and the material that is meant.
pub(crate) type Source = (PathBuf, String, Vec<String>, Option<String>);

/// The file of a source, and the material that is meant.
pub(crate) fn material_of(
    py: Python<'_>,
    (name, text, settings, material): &Source,
) -> PyResult<(MaterialsFile, Material)> {
    let file = MaterialsFile::parse(&name.display().to_string(), text, settings)
        .map_err(|error| Raised::from(error).exception(py))?;
    let chosen = chosen(&file.materials, material.as_deref())
        .map_err(|error| refused(py, &error.problem, &error.names))?
        .clone();
    Ok((file, chosen))
}

/// Drives a material; `law` is one in Python.
#[pyfunction]
pub(crate) fn element(
    py: Python<'_>,
    source: Source,
    asked: Asked,
    law: Option<Py<PyAny>>,
) -> PyResult<ElementTest> {
    let (file, mut material) = material_of(py, &source)?;
    let trouble = Trouble::default();
    if let Some(law) = law {
        give_to(py, &mut material, law, &trouble)?;
    }
    let request = asked.request(py, &material, &source.0)?;
    let tested = py.detach(|| test(&material, &request));
    if let Some(raised) = trouble.take() {
        return Err(raised);
    }
    let mut tested = tested.map_err(|error| unmade(py, &error))?;
    file.warnings.trim_end().clone_into(&mut tested.warnings);
    Ok(ElementTest(tested))
}

/// A test that cannot begin.
pub(crate) fn unmade(py: Python<'_>, error: &TestError) -> PyErr {
    let help = match error {
        TestError::Value { .. } => {
            "`strain` is a number, 0.2 for 20 %; `stress` and `duration` have a unit, or are in Pa and s"
        }
        _ => "another initial stress, compression positive, or other steps",
    };
    refused(
        py,
        igimp_cases::chain(error).trim_start_matches("error: "),
        help,
    )
}

impl Asked {
    /// The test of a material whose file has a name.
    pub(crate) fn request(
        &self,
        py: Python<'_>,
        material: &Material,
        name: &Path,
    ) -> PyResult<Request> {
        let mut drive = drive(py, self, name)?;
        let data = match &self.data {
            None => None,
            Some(measured) => Some(measured.read(py, material, &drive, name)?),
        };
        if let (None, Some(data)) = (self.strain, &data) {
            drive = drive.up_to(data).ok_or_else(|| {
                let problem = format!("{}: nothing was measured at any strain", data.name);
                refused(py, &problem, "a test needs a row beyond its start")
            })?;
        }
        let stress = self.stress.read(py, "stress", Dimension::Stress)?;
        let side = self.side_stress.as_ref();
        let side = side.map(|side| side.read(py, "side_stress", Dimension::Stress));
        let request = Request {
            drive,
            stress: [stress, side.transpose()?.unwrap_or(stress)],
            steps: self.steps,
            kinematics: if self.small_strain {
                Kinematics::Small
            } else {
                Kinematics::Finite
            },
            duration: self.duration.read(py, "duration", Dimension::Time)?,
            data,
        };
        request.check().map_err(|error| unmade(py, &error))?;
        Ok(request)
    }
}

impl Measured {
    fn read(
        &self,
        py: Python<'_>,
        material: &Material,
        drive: &Drive,
        name: &Path,
    ) -> PyResult<Data> {
        let law = (material.law()).map_err(|error| refused(py, &error.to_string(), ""))?;
        let variables = law
            .internal_variables()
            .iter()
            .map(|variable| variable.name);
        let variables: Vec<_> = variables.collect();
        let read = match self {
            Self::File(path) => read_data(&beside(name, path), drive, &variables),
            Self::Text(name, text) => parse_data(name, text, drive, &variables),
        };
        read.map_err(|error| refused(py, &error.to_string(), error.help()))
    }
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
    Ok(Drive::Standard(standard, asked.strain.unwrap_or(1.0)))
}

/// A file that lies beside another, unless its path is whole.
fn beside(name: &Path, path: &Path) -> PathBuf {
    name.parent().unwrap_or(Path::new("")).join(path)
}

/// Input that makes no sense, with what helps.
pub(crate) fn refused(py: Python<'_>, problem: &str, help: &str) -> PyErr {
    let help = if help.is_empty() {
        String::new()
    } else {
        format!("\n  help: {help}")
    };
    Raised::bad_input(format!("error: {problem}{help}")).exception(py)
}
