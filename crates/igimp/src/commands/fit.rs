//! `igimp fit`: parameters of a law from data of the laboratory.

use std::path::Path;

use igimp_input::MaterialsFile;
use igimp_model::Material;
use igimp_report::pictures::file_name;
use igimp_study::element::{Drive, Kinematics, Request, StandardTest, name_of, of_name};
use igimp_study::fit::{FileSource, FitError, FitRequest, fit as found};

use super::element::{chosen, data, path_of, refused};
use crate::arguments::FitArguments;
use crate::error::{Exit, ProgramError};
use crate::output;

pub(crate) fn fit(arguments: &FitArguments) -> Result<Exit, ProgramError> {
    let file = MaterialsFile::read(&arguments.file, &arguments.set)?;
    output::warn(&file.warnings);
    let material = chosen(&file.materials, arguments.material.as_deref())?;
    let request = FitRequest {
        vary: arguments.vary.clone(),
        tests: tests(arguments, material)?,
        scatter: arguments.scatter.clone(),
    };
    let name = material.name.clone();
    let source = FileSource {
        material: name.clone(),
        file,
    };
    let fitted = match found(&source, &request) {
        Ok(fitted) => fitted,
        Err(error @ FitError::NotConverged { .. }) => {
            output::print_message(&format!(
                "error: {error}\n  help: begin nearer with --set, or state bounds with --vary \"KEY=LOW..HIGH\""
            ));
            return Ok(Exit::NotConverged);
        }
        Err(error) => return Err(unfitted(error)),
    };
    let folder = arguments
        .out
        .clone()
        .unwrap_or_else(|| Path::new("results").join(format!("fit-{}", file_name(&name))));
    output::writable(&folder)?;
    let names = fitted.write(&folder)?;
    output::print(&format!(
        "{}\n{}: {}",
        fitted.text,
        folder.display(),
        names.join(", ")
    ))?;
    Ok(Exit::Done)
}

/// The tests, in the order of their data.
fn tests(arguments: &FitArguments, material: &Material) -> Result<Vec<Request>, ProgramError> {
    let count = arguments.data.len();
    let tests = each("--test", &arguments.test, count)?;
    let axial = each("--stress", &arguments.stress, count)?;
    let side = match arguments.side_stress[..] {
        [] => axial.clone(),
        _ => each("--side-stress", &arguments.side_stress, count)?,
    };
    let mut requests = Vec::new();
    for (place, path) in arguments.data.iter().enumerate() {
        let drive = drive(&tests[place])?;
        let data = data(material, &drive, path)?;
        let drive = drive.up_to(&data).ok_or_else(|| {
            ProgramError::usage(
                format!("{}: nothing was measured at any strain", data.name),
                "a test needs a row beyond its start",
            )
        })?;
        requests.push(Request {
            drive,
            stress: [axial[place], side[place]],
            steps: arguments.steps,
            kinematics: if arguments.small_strain {
                Kinematics::Small
            } else {
                Kinematics::Finite
            },
            duration: arguments.duration,
            data: Some(data),
        });
    }
    Ok(requests)
}

/// A value for each test.
fn each<T: Clone>(flag: &str, values: &[T], count: usize) -> Result<Vec<T>, ProgramError> {
    match values {
        [one] => Ok(vec![one.clone(); count]),
        all if all.len() == count => Ok(all.to_vec()),
        all => Err(ProgramError::usage(
            format!(
                "{flag} is given {} times, and --data {count} times",
                all.len()
            ),
            "give it once for all tests, or once for each --data in the same order",
        )),
    }
}

/// A test by its name, up to any strain, or a path by its file.
fn drive(text: &str) -> Result<Drive, ProgramError> {
    if let Some(test) = of_name(text) {
        return Ok(Drive::Standard(test, 1.0));
    }
    let path = Path::new(text);
    if path.extension().is_some_and(|kind| kind == "csv") {
        return path_of(path);
    }
    Err(ProgramError::usage(
        format!("there is no test {text}"),
        format!(
            "tests are {}, or a path by its CSV file",
            StandardTest::ALL.map(name_of).join(", ")
        ),
    ))
}

/// A fit that cannot begin.
fn unfitted(error: FitError) -> ProgramError {
    match error {
        FitError::Input(error) => error.into(),
        FitError::Test(error) => refused(&error),
        FitError::Parameter(error) => ProgramError::usage(error.to_string(), error.help()),
        FitError::Early { .. } => ProgramError::usage(
            error.to_string(),
            "begin with values that bear the path, with --set, or let the test drive strain",
        ),
        FitError::NothingSought => {
            ProgramError::usage(error.to_string(), "--vary friction names one")
        }
        FitError::TooFew { .. } => {
            ProgramError::usage(error.to_string(), "vary less, or add data of another test")
        }
        FitError::NotConverged { .. } => ProgramError::usage(error.to_string(), ""),
    }
}
