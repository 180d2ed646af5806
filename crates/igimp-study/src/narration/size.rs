//! The expected cost of a case in words, printed before it runs.

use std::path::Path;

use igimp_cases::CaseError;
use igimp_estimate::speed::Speed;
use igimp_estimate::watch::side_by_side;
use igimp_estimate::{Estimate, estimate, readable, time, together};
use igimp_model::{Case, Every, Stage, StageKind, meshes};
use igimp_text::{count, on_a_line};

use super::table;

/// A particle in a frame, packed, in the plane and in space \[bytes\].
const FRAME: [f64; 2] = [250.0, 450.0];
/// Most frames of a motion that makes a film, and those of another stage.
const FILM_OF_MOTION: usize = 40;
const FILM: usize = 20;

/// The size of a case and what it will cost.
#[derive(Clone, Debug)]
pub struct Told {
    /// Particles, cells, unknowns and memory.
    pub size: Estimate,
    /// Time of the case on its own grid.
    pub time: time::Time,
    /// All of it as it is printed.
    pub text: String,
}

/// Estimates a case; `name` is that of its file.
///
/// # Errors
/// [`CaseError`] for a case that cannot be set up.
pub fn size<const D: usize>(case: &Case<D>, name: &Path) -> Result<Told, CaseError> {
    for material in &case.materials {
        material.law()?;
    }
    let size = estimate(case)?;
    let speed = Speed::measured()?;
    let time = time::time(case, &size, speed);
    let cells = case.grid.cells().map(|count| count.to_string()).join(" x ");
    let [particle, unknown] = size.per_item.map(|bytes| count(round(bytes)));
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let allowed = size.systems.allowed.iter();
    let allowed = allowed.map(|allowed| row("factors", allowed.words()));
    let mut rows = vec![
        row("method", case.method.label()),
        row("particles", count(size.particles)),
        row("cells", format!("{} ({cells})", count(size.cells))),
        row("unknowns", format!("about {}", count(size.unknowns))),
        row("solver", size.systems.method.clone()),
    ];
    rows.extend(allowed);
    rows.extend(size.systems.on_several.map(|(bytes, computers)| {
        let text = format!(
            "where the iteration is slow: igimp-mpi on {computers} computers has room for {} of factors",
            readable(bytes)
        );
        row("ranks", text)
    }));
    rows.extend([
        row("memory", memory(size.bytes, size.most_bytes)),
        row(
            "",
            format!("about {particle} bytes for a particle, {unknown} for an unknown"),
        ),
        row("time", time::sentence(&time)),
        row("results", case.output.folder.display().to_string()),
    ]);
    rows.extend(film(case, size.particles).map(|text| row("frames", text)));
    let stages: Vec<Vec<String>> = case
        .stages
        .iter()
        .enumerate()
        .map(|(index, stage)| {
            vec![
                format!("{}. {}", index + 1, stage.name),
                stage.kind.name().to_owned(),
                format!("{} steps", stage.steps),
            ]
        })
        .collect();
    let text = format!(
        "{} is fine\n  {}\n\n{}\nstages\n{}{}",
        name.display(),
        on_a_line(&case.title),
        table(&rows),
        table(&stages),
        study(case, speed)?
    );
    Ok(Told { size, time, text })
}

/// How many frames make the film of a run, and what they take; none where a run is to make none.
fn film<const D: usize>(case: &Case<D>, particles: usize) -> Option<String> {
    if case.output.paraview != Every::Film {
        return None;
    }
    let of_stage = |stage: &Stage| match stage.kind {
        StageKind::Dynamic(_) => stage.steps.min(FILM_OF_MOTION) + 2,
        StageKind::StrengthReduction(_) => 3,
        _ => stage.steps.min(FILM) + 1,
    };
    let frames: usize = case.stages.iter().map(of_stage).sum();
    let bytes = (frames * particles) as f64 * FRAME[D - 2];
    Some(format!(
        "up to {frames}, about {} in paraview/",
        readable(bytes)
    ))
}

/// The meshes of a study of the mesh error, each with its size, and the cost of all; empty without one.
fn study<const D: usize>(case: &Case<D>, speed: Speed) -> Result<String, CaseError> {
    if case.mesh_study.meshes < 2 {
        return Ok(String::new());
    }
    let mut rows = Vec::new();
    let (mut bytes, mut most_bytes, mut all) = (Vec::new(), Vec::new(), None::<time::Time>);
    for (mesh, parts) in std::iter::zip(meshes::meshes(case), meshes::refinements(case)) {
        let size = estimate(&mesh)?;
        let own = time::time(&mesh, &size, speed);
        rows.push(vec![
            meshes::label(parts),
            format!("{} particles", count(size.particles)),
            format!("{} cells", count(size.cells)),
            format!("about {} unknowns", count(size.unknowns)),
            memory(size.bytes, size.most_bytes),
            format!("about {}", time::readable(own.seconds)),
        ]);
        bytes.push(size.bytes);
        most_bytes.push(size.most_bytes);
        all = Some(all.map_or(own, |all| time::Time {
            seconds: all.seconds + own.seconds,
            ..own
        }));
    }
    let how = if side_by_side(&bytes) > 1 {
        "side by side"
    } else {
        "one after another"
    };
    Ok(format!(
        "\nmeshes\n{}  {how}: {} of memory, {}\n",
        table(&rows),
        memory(together(&bytes), together(&most_bytes)),
        all.map_or_else(String::new, |all| time::sentence(&all))
    ))
}

/// Expected memory of a run \[bytes\], and that of a run whose iteration is abandoned for a factorisation.
fn memory(bytes: f64, most_bytes: f64) -> String {
    let about = format!("about {}", readable(bytes));
    if most_bytes > 1.1 * bytes {
        format!(
            "{about}, {} where an iteration is given up for factors",
            readable(most_bytes)
        )
    } else {
        about
    }
}

/// A number of bytes to two digits: more are not known.
fn round(bytes: f64) -> usize {
    let unit = 10.0_f64.powf(bytes.max(1.0).log10().floor() - 1.0).max(1.0);
    ((bytes / unit).round() * unit) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_with_factors_is_told_beside() {
        insta::assert_snapshot!(memory(1.7e9, 3.6e9), @"about 1.6 GiB, 3.4 GiB where an iteration is given up for factors");
        insta::assert_snapshot!(memory(5e7, 5e7), @"about 50 MiB");
    }
}
