//! `igimp element`: a law on its own.

use igimp_input::MaterialsFile;
use igimp_model::Material;
use igimp_report::pictures::file_name;
use igimp_study::element::{Drive, Kinematics, Request, TestError, of_name, read_path, test};

use crate::arguments::ElementArguments;
use crate::error::{Exit, ProgramError};
use crate::output;

pub(crate) fn element(arguments: &ElementArguments) -> Result<Exit, ProgramError> {
    let file = MaterialsFile::read(&arguments.file, &arguments.set)?;
    output::warn(&file.warnings);
    let material = chosen(&file.materials, arguments.material.as_deref())?;
    let request = Request {
        drive: drive(arguments)?,
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
    };
    let tested = test(material, &request).map_err(|error| refused(&error))?;
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

/// The material that is meant.
fn chosen<'a>(materials: &'a [Material], name: Option<&str>) -> Result<&'a Material, ProgramError> {
    let all = || {
        let names = materials.iter().map(|own| own.name.as_str());
        format!("its materials are {}", names.collect::<Vec<_>>().join(", "))
    };
    match (materials, name) {
        ([only], None) => Ok(only),
        (_, None) => Err(ProgramError::usage(
            "the file has several materials",
            format!("choose one with --material; {}", all()),
        )),
        (_, Some(name)) => materials
            .iter()
            .find(|own| own.name == name)
            .ok_or_else(|| {
                ProgramError::usage(format!("the file has no material \"{name}\""), all())
            }),
    }
}

fn drive(arguments: &ElementArguments) -> Result<Drive, ProgramError> {
    if let Some(path) = &arguments.path {
        let read = read_path(path)
            .map_err(|error| ProgramError::usage(error.to_string(), error.help()))?;
        return Ok(Drive::Path(read));
    }
    let test = of_name(&arguments.test).ok_or_else(|| {
        ProgramError::usage(format!("there is no test {}", arguments.test), "see --help")
    })?;
    Ok(Drive::Standard(test, arguments.strain))
}

/// A test that cannot begin.
fn refused(error: &TestError) -> ProgramError {
    ProgramError::usage(
        igimp_cases::chain(error).trim_start_matches("error: "),
        "another initial stress: --stress \"100 kPa\" --side-stress \"60 kPa\", compression positive",
    )
}
