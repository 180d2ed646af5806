//! `igimp element`: a law on its own.

use igimp_input::MaterialsFile;
use igimp_model::Material;
use igimp_report::pictures::file_name;
use igimp_study::element::{
    self, Data, DataError, Drive, Kinematics, Request, TestError, of_name, read_data, read_path,
    test,
};

use crate::arguments::ElementArguments;
use crate::error::{Exit, ProgramError};
use crate::output;

pub(crate) fn element(arguments: &ElementArguments) -> Result<Exit, ProgramError> {
    let file = MaterialsFile::read(&arguments.file, &arguments.set)?;
    output::warn(&file.warnings);
    let material = chosen(&file.materials, arguments.material.as_deref())?;
    let drive = drive(arguments)?;
    let data = match &arguments.data {
        Some(path) => Some(data(material, &drive, path)?),
        None => None,
    };
    let request = Request {
        drive,
        stress: [
            arguments.stress,
            arguments.side_stress.unwrap_or(arguments.stress),
        ],
        steps: arguments.steps,
        kinematics: if arguments.small_strain {
            Kinematics::Small
        } else {
            Kinematics::Finite
        },
        duration: arguments.duration,
        data,
    };
    let mut tested = test(material, &request).map_err(|error| refused(&error))?;
    file.warnings.trim_end().clone_into(&mut tested.warnings);
    let folder = arguments.out.clone().unwrap_or_else(|| {
        let test = if arguments.path.is_some() {
            "path"
        } else {
            &arguments.test
        };
        let name = format!("element-{}-{test}", file_name(&material.name));
        std::path::Path::new("results").join(name)
    });
    output::writable(&folder)?;
    let names = tested.write(&folder)?;
    output::print(&format!(
        "{}  {}: {}",
        tested.text,
        folder.display(),
        names.join(", ")
    ))?;
    Ok(if tested.run.failure.is_some() {
        Exit::NotConverged
    } else {
        Exit::Done
    })
}

/// Data of a test of a material.
pub(crate) fn data(
    material: &Material,
    drive: &Drive,
    path: &std::path::Path,
) -> Result<Data, ProgramError> {
    let law = (material.law()).map_err(|error| refused(&TestError::Material(error)))?;
    let variables: Vec<&str> = (law.internal_variables().iter())
        .map(|variable| variable.name)
        .collect();
    read_data(path, drive, &variables).map_err(|error| unread(&error))
}

fn unread(error: &DataError) -> ProgramError {
    ProgramError::usage(error.to_string(), error.help())
}

/// The material that is meant.
pub(crate) fn chosen<'a>(
    materials: &'a [Material],
    name: Option<&str>,
) -> Result<&'a Material, ProgramError> {
    element::chosen(materials, name).map_err(|error| {
        let help = match name {
            None => format!("choose one with --material; {}", error.names),
            Some(_) => error.names,
        };
        ProgramError::usage(error.problem, help)
    })
}

fn drive(arguments: &ElementArguments) -> Result<Drive, ProgramError> {
    if let Some(path) = &arguments.path {
        return path_of(path);
    }
    let test = of_name(&arguments.test).ok_or_else(|| {
        ProgramError::usage(format!("there is no test {}", arguments.test), "see --help")
    })?;
    Ok(Drive::Standard(test, arguments.strain))
}

/// A path from a file.
pub(crate) fn path_of(path: &std::path::Path) -> Result<Drive, ProgramError> {
    let read =
        read_path(path).map_err(|error| ProgramError::usage(error.to_string(), error.help()))?;
    Ok(Drive::Path(read))
}

/// A test that cannot begin.
pub(crate) fn refused(error: &TestError) -> ProgramError {
    if let TestError::Data(error) = error {
        return unread(error);
    }
    ProgramError::usage(
        igimp_cases::chain(error).trim_start_matches("error: "),
        "another initial stress: --stress \"100 kPa\" --side-stress \"60 kPa\", compression positive",
    )
}
