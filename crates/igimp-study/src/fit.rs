//! Parameters of a law from data of the laboratory, by nonlinear least squares, and how well each is known (theory, eqs. 116 to 119).

mod page;
#[cfg(test)]
mod page_tests;
mod parameter;
mod problem;
mod statistics;
#[cfg(test)]
mod tests;
mod text;
#[cfg(test)]
mod wall_tests;
mod walls;

use std::path::Path;

use igimp_input::{InputError, MaterialsFile};
use igimp_model::Material;
use igimp_report::ReportError;
use igimp_results::ResultsError;
use igimp_results::tables::rows::RowWriter;
use thiserror::Error;

use crate::element::{Measure, Request, TestError, Tested, test};
use parameter::{Parameter, START};
pub use parameter::{ParameterError, Vary};
use problem::{Lost, Problem, Solved};
pub use statistics::Known;
use statistics::{Statistics, statistics};

/// Correlations above are printed.
const CORRELATED: f64 = 0.9;

/// Where a material comes from: the source is asked again at every trial.
pub trait Source {
    /// The material with values of some of its keys, written as in the file.
    ///
    /// # Errors
    /// [`InputError`] of values that the file does not allow.
    fn material(&self, values: &[(String, String)]) -> Result<Material, InputError>;

    /// The value of a key as written in the file: a quantity as text, or a number.
    fn written(&self, key: &str) -> Option<String>;
}

/// A material of a file.
#[derive(Clone, Debug)]
pub struct FileSource {
    /// The file.
    pub file: MaterialsFile,
    /// The name of the material.
    pub material: String,
}

impl Source for FileSource {
    fn material(&self, values: &[(String, String)]) -> Result<Material, InputError> {
        let name = text::quoted(&self.material);
        let set = (values.iter())
            .map(|(key, value)| format!("materials.{name}.{key}={value}"))
            .collect();
        let file = self.file.with(set)?;
        let is_named = |material: &&Material| material.name == self.material;
        let found = file.materials.iter().find(is_named).cloned();
        Ok(found.expect("values of a material leave its name"))
    }

    fn written(&self, key: &str) -> Option<String> {
        self.file.written(&self.material, key)
    }
}

/// Parameters, and the data that they are fitted to.
#[derive(Clone, Debug, PartialEq)]
pub struct FitRequest {
    /// The parameters.
    pub vary: Vec<Vary>,
    /// Tests with their data.
    pub tests: Vec<Request>,
    /// Standard deviations of quantities that are stated, in SI. Of others it is in proportion to the largest value that was measured.
    pub scatter: Vec<(Measure, f64)>,
}

/// A parameter that was sought.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Its key within the material.
    pub key: String,
    /// The unit of its values, that of the file; empty of plain numbers.
    pub unit: String,
    /// Where the search began.
    pub start: f64,
    /// Where it ended.
    pub value: f64,
    /// How well it is known.
    pub known: Known,
}

/// Parameters that were found.
#[derive(Debug)]
pub struct Fitted {
    /// The material and its law, such as `sand: Mohr–Coulomb`.
    pub title: String,
    /// The parameters, in the order of the request.
    pub parameters: Vec<Found>,
    /// Correlation of each pair by their places \[-\]; not a number where one of the two has no error.
    pub correlation: Vec<Vec<f64>>,
    /// Standard deviation of a residual, with one degree of freedom less for each parameter \[-\].
    pub deviation: f64,
    /// Standard deviations that residuals are divided by, in SI: of each column of the data of each test. Those that were not stated are
    /// the largest values, of which only the ratios count.
    pub scales: Vec<Vec<f64>>,
    /// Values that were measured.
    pub values: usize,
    /// Iterations and evaluations of the search.
    pub effort: [usize; 2],
    /// Whether a measurement stands where soil begins to yield, so that errors are rough.
    pub has_kink: bool,
    /// Each test with the values that were found.
    pub tests: Vec<Tested>,
    /// Lines ready to print.
    pub text: String,
    /// The parameters as TOML.
    pub block: String,
}

/// Why there is no fit.
#[derive(Debug, Error)]
pub enum FitError {
    /// A parameter cannot be varied.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// No parameter is sought.
    #[error("no parameter is sought")]
    NothingSought,
    /// Too few data.
    #[error(
        "{values} values were measured, and {parameters} parameters are sought: nothing would say how well they are known"
    )]
    TooFew {
        /// Values in the data.
        values: usize,
        /// Parameters.
        parameters: usize,
    },
    /// The file does not allow the values at the start.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A test cannot begin.
    #[error(transparent)]
    Test(#[from] TestError),
    /// A test cannot be followed at the start.
    #[error("with the values of the file test {test} ends before its data do: {why}")]
    Early {
        /// Which, from 1.
        test: usize,
        /// Why.
        why: String,
    },
    /// The search did not converge.
    #[error("the search did not converge: {why}; it came to {at}")]
    NotConverged {
        /// Why.
        why: String,
        /// The values where it ended.
        at: String,
    },
}

impl From<Lost> for FitError {
    fn from(lost: Lost) -> Self {
        match lost {
            Lost::Input(error) => Self::Input(error),
            Lost::Test(error) => Self::Test(error),
            Lost::Early { test, why } => Self::Early { test, why },
        }
    }
}

/// Finds parameters.
///
/// # Errors
/// [`FitError`]; a search that did not converge is one.
pub fn fit(source: &dyn Source, request: &FitRequest) -> Result<Fitted, FitError> {
    if request.vary.is_empty() {
        return Err(FitError::NothingSought);
    }
    let parameters = parameters(&request.vary, source)?;
    let problem = Problem::new(source, &parameters, request);
    if problem.values() <= parameters.len() {
        return Err(FitError::TooFew {
            values: problem.values(),
            parameters: parameters.len(),
        });
    }
    let start = vec![START; parameters.len()];
    problem.residuals(&start)?;
    let not_converged = |at: &[f64], why: &str| not_converged(&parameters, at, why);
    let Solved {
        at,
        ranges,
        why,
        effort,
    } = problem.solved(start);
    if let Some(why) = why {
        return Err(not_converged(&at, &why));
    }
    let residuals = problem.residuals(&at)?;
    let Some(jacobian) = problem.jacobian(&at, &ranges) else {
        return Err(not_converged(
            &at,
            "the law refuses values beside those found",
        ));
    };
    let Statistics {
        known,
        correlation,
        deviation,
        step,
    } = statistics((&parameters, &ranges), &at, &residuals, &jacobian);
    let has_kink = problem
        .is_minimum(&at, &residuals, &jacobian, &step)
        .map_err(|why| not_converged(&at, why))?;
    let found: Vec<Found> = (parameters.iter().zip(&at).zip(known))
        .map(|((parameter, x), known)| Found {
            key: parameter.key.clone(),
            unit: parameter.unit.clone(),
            start: parameter.first,
            value: parameter.value(*x),
            known,
        })
        .collect();
    let material = problem.material(&at)?;
    let tests = (request.tests.iter())
        .map(|request| test(&material, request))
        .collect::<Result<Vec<_>, _>>()?;
    let mut fitted = Fitted {
        title: format!("{}: {}", material.name, material.strength.name()),
        block: text::block(&material.name, &found),
        parameters: found,
        correlation,
        deviation,
        scales: problem.scales().to_vec(),
        values: problem.values(),
        effort,
        has_kink,
        tests,
        text: String::new(),
    };
    fitted.text = text::of(&fitted);
    Ok(fitted)
}

/// A search that ended at a place without a minimum.
fn not_converged(parameters: &[Parameter], at: &[f64], why: &str) -> FitError {
    let values = parameters.iter().zip(at);
    FitError::NotConverged {
        why: why.to_owned(),
        at: values
            .map(|(p, x)| format!("{} = {}", p.key, p.text(p.value(*x))))
            .collect::<Vec<_>>()
            .join(", "),
    }
}

/// The parameters of a request, each of which stands there once.
fn parameters(vary: &[Vary], source: &dyn Source) -> Result<Vec<Parameter>, ParameterError> {
    for (place, one) in vary.iter().enumerate() {
        if vary[..place].iter().any(|other| other.key == one.key) {
            let key = one.key.clone();
            return Err(ParameterError::Twice { key });
        }
    }
    (vary.iter())
        .map(|vary| Parameter::new(vary, source))
        .collect()
}

impl Fitted {
    /// Pairs, by their places, whose correlation is above 0.9 by its size, and the correlation.
    pub fn correlated(&self) -> Vec<(usize, usize, f64)> {
        let mut pairs = Vec::new();
        for (one, row) in self.correlation.iter().enumerate() {
            let others = row.iter().enumerate().skip(one + 1);
            let strong = others.filter(|(_, value)| value.abs() > CORRELATED);
            pairs.extend(strong.map(|(other, value)| (one, other, *value)));
        }
        pairs
    }

    /// Writes `fit.csv`, `correlation.csv` and `fit.toml`, the table and pictures of every test with its residuals into a folder of
    /// its own, and all of it as `report.html`; their names.
    ///
    /// # Errors
    /// [`ReportError`] of a file that cannot be written.
    pub fn write(&self, folder: &Path) -> Result<Vec<String>, ReportError> {
        let header = [
            "parameter",
            "unit",
            "start",
            "value",
            "standard error",
            "lower end of 95 %",
            "upper end of 95 %",
            "known",
        ]
        .map(str::to_owned);
        let mut rows = RowWriter::create(&folder.join("fit.csv"), &header)?;
        for found in &self.parameters {
            rows.push_text(&text::row(found))?;
        }
        let keys = self.parameters.iter().map(|found| found.key.clone());
        let header: Vec<String> = ["parameter".to_owned()].into_iter().chain(keys).collect();
        let mut rows = RowWriter::create(&folder.join("correlation.csv"), &header)?;
        for (found, correlations) in self.parameters.iter().zip(&self.correlation) {
            let cells = correlations.iter().map(|r| text::correlation(*r, 9));
            rows.push_text(
                &[found.key.clone()]
                    .into_iter()
                    .chain(cells)
                    .collect::<Vec<_>>(),
            )?;
        }
        let block = folder.join("fit.toml");
        std::fs::write(&block, &self.block).map_err(|source| ResultsError::File {
            path: block,
            source,
        })?;
        let mut written = Vec::new();
        for ((tested, scales), at) in self.tests.iter().zip(&self.scales).zip(1..) {
            let name = format!("test-{at}");
            let subfolder = folder.join(&name);
            std::fs::create_dir_all(&subfolder).map_err(|source| ResultsError::File {
                path: subfolder.clone(),
                source,
            })?;
            let mut files = tested.write_parts(&subfolder)?;
            let scales: Vec<f64> = scales.iter().map(|scale| scale * self.deviation).collect();
            let plot = tested.residuals(&scales).filter(|_| self.deviation > 0.0);
            if let Some(plot) = plot {
                plot.write(&subfolder.join("residuals"))?;
                files.extend(["svg", "png"].map(|kind| format!("residuals.{kind}")));
            }
            written.push((name, files));
        }
        page::page(self, &written).write(folder)?;
        let names = ["report.html", "fit.csv", "correlation.csv", "fit.toml"].map(str::to_owned);
        let folders = written.iter().map(|(name, _)| format!("{name}/"));
        Ok(names.into_iter().chain(folders).collect())
    }
}
