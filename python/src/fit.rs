//! Parameters of a law from data of the laboratory: the search of `igimp fit`.

use std::path::PathBuf;

use igimp_study::element::Measure;
use igimp_study::fit::{FileSource, FitError, FitRequest, Fitted, Known, Vary, fit as found};
use pyo3::prelude::*;

use crate::element::{Asked, ElementTest, Source, material_of, refused, unmade};
use crate::raised::Raised;

/// Parameters that were found.
#[pyclass(frozen, module = "igimp._igimp")]
#[derive(Debug)]
pub(crate) struct Fit(Fitted);

/// Key, unit, start, value, how well it is known in a word, standard error, ends of the interval, keys it is traded for.
type Row = (
    String,
    String,
    f64,
    f64,
    &'static str,
    Option<f64>,
    Option<(f64, f64)>,
    Vec<String>,
);

#[pymethods]
impl Fit {
    /// What the program prints of it.
    #[getter]
    fn text(&self) -> &str {
        &self.0.text
    }

    /// The values as TOML.
    #[getter]
    fn block(&self) -> &str {
        &self.0.block
    }

    /// Standard deviation of a residual.
    #[getter]
    fn deviation(&self) -> f64 {
        self.0.deviation
    }

    /// Whether errors are rough.
    #[getter]
    fn has_kink(&self) -> bool {
        self.0.has_kink
    }

    /// The parameters.
    fn parameters(&self) -> Vec<Row> {
        let key = |place: &usize| self.0.parameters[*place].key.clone();
        let rows = self.0.parameters.iter().map(|row| {
            let (known, error, interval, with) = match &row.known {
                Known::Well { error, interval } => (
                    "standard error",
                    Some(*error),
                    Some((interval[0], interval[1])),
                    Vec::new(),
                ),
                Known::AtBound { upper: true } => ("at its upper bound", None, None, Vec::new()),
                Known::AtBound { upper: false } => ("at its lower bound", None, None, Vec::new()),
                Known::AtWall { upper: true } => {
                    ("greatest that is accepted", None, None, Vec::new())
                }
                Known::AtWall { upper: false } => {
                    ("least that is accepted", None, None, Vec::new())
                }
                Known::NotDetermined { with } => {
                    let with = with.iter().map(key).collect();
                    ("not determined", None, None, with)
                }
            };
            let (key, unit) = (row.key.clone(), row.unit.clone());
            (
                key, unit, row.start, row.value, known, error, interval, with,
            )
        });
        rows.collect()
    }

    /// Correlations, a row a parameter.
    fn correlation(&self) -> Vec<Vec<f64>> {
        self.0.correlation.clone()
    }

    /// The tests with the values that were found.
    fn tests(&self) -> Vec<ElementTest> {
        self.0.tests.iter().cloned().map(ElementTest).collect()
    }

    /// Writes report, tables and pictures into a folder, which is made; their names.
    fn write(&self, py: Python<'_>, folder: PathBuf) -> PyResult<Vec<String>> {
        std::fs::create_dir_all(&folder)?;
        let written = self.0.write(&folder).map_err(igimp_cases::CaseError::from);
        written.map_err(|error| Raised::from(error).exception(py))
    }
}

/// Finds parameters of a material from tests with data; `scatter` has standard deviations by quantity.
#[pyfunction]
pub(crate) fn fit(
    py: Python<'_>,
    source: Source,
    vary: Vec<(String, Option<[String; 2]>)>,
    tests: Vec<Asked>,
    scatter: Vec<(String, String)>,
) -> PyResult<Fit> {
    let (file, material) = material_of(py, &source)?;
    let requests = tests.iter().zip(1..).map(|(asked, at)| {
        let request = asked.request(py, &material, &source.0);
        request.map_err(|error| of_test(py, error, at))
    });
    let request = FitRequest {
        vary: vary
            .into_iter()
            .map(|(key, bounds)| Vary { key, bounds })
            .collect(),
        tests: requests.collect::<PyResult<_>>()?,
        scatter: scatter
            .iter()
            .map(|(name, text)| deviation(py, name, text))
            .collect::<PyResult<_>>()?,
    };
    let source = FileSource {
        file,
        material: material.name,
    };
    let fitted = py.detach(|| found(&source, &request));
    fitted.map(Fit).map_err(|error| unfitted(py, error))
}

/// An error of a test, with its number.
fn of_test(py: Python<'_>, error: PyErr, at: usize) -> PyErr {
    let text = error.value(py).to_string();
    let text = text.trim_start_matches("error: ");
    Raised::bad_input(format!("error: test {at}: {text}")).exception(py)
}

/// A standard deviation that is stated.
fn deviation(py: Python<'_>, name: &str, text: &str) -> PyResult<(Measure, f64)> {
    let measure = Measure::of_name(name).ok_or_else(|| {
        let names = Measure::ALL.map(Measure::name).join(", ");
        let problem = format!("`scatter`: `{name}` is no quantity");
        refused(py, &problem, &format!("quantities: {names}"))
    })?;
    let value = measure
        .value(text)
        .filter(|value| *value > 0.0 && value.is_finite());
    let value = value.ok_or_else(|| {
        let problem = format!("`scatter`: `{text}` is no standard deviation of `{name}`");
        refused(
            py,
            &problem,
            "a positive value with its unit, such as \"2 kPa\" or \"0.1 %\"",
        )
    })?;
    Ok((measure, value))
}

/// Why there is no fit, as the program says it.
fn unfitted(py: Python<'_>, error: FitError) -> PyErr {
    let text = error.to_string();
    match error {
        FitError::Input(error) => Raised::from(error).exception(py),
        FitError::Test(error) => unmade(py, &error),
        FitError::Parameter(_) | FitError::NothingSought => refused(
            py,
            &text,
            "`vary` has keys of the material, or keys with bounds: {\"friction\": (\"20 deg\", \"40 deg\")}",
        ),
        FitError::Early { .. } => refused(
            py,
            &text,
            "begin with values that bear the path, or let the test drive strain",
        ),
        FitError::TooFew { .. } => refused(py, &text, "vary less, or add data of another test"),
        FitError::NotConverged { .. } => Raised::not_converged(format!(
            "error: {text}\n  help: begin nearer with `values`, or state bounds in `vary`"
        ))
        .exception(py),
    }
}
