//! The expected cost of a case in words, printed before it runs.

use std::fmt::Write as _;
use std::path::Path;

use igimp_cases::CaseError;
use igimp_estimate::speed::Speed;
use igimp_estimate::watch::side_by_side;
use igimp_estimate::{Estimate, estimate, readable, time, together};
use igimp_model::{Case, Every, Stage, StageKind, meshes};
use igimp_results::paraview::film;
use igimp_text::{count, on_a_line, short};

use super::table;

/// A particle in a frame, packed, in the plane and in space \[bytes\].
const FRAME: [f64; 2] = [250.0, 350.0];

/// The size of a case and its cost.
#[derive(Clone, Debug)]
pub struct Cost {
    /// Particles, cells, unknowns and memory.
    pub size: Estimate,
    /// Time of the case, for a study of the mesh error of all its meshes.
    pub time: time::Time,
    /// Memory of the case, for a study of the mesh error of its meshes as they run \[bytes\].
    pub bytes: f64,
    /// The same where an iteration is given up for factors \[bytes\].
    pub most_bytes: f64,
    /// All of it as it is printed.
    pub text: String,
}

/// Estimates a case; `name` is that of its file.
///
/// # Errors
/// [`CaseError`] for a case that cannot be set up.
pub fn size<const D: usize>(case: &Case<D>, name: &Path) -> Result<Cost, CaseError> {
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
    ];
    rows.extend(lines(case).map(|text| row("lines", text)));
    rows.extend([
        row("unknowns", format!("about {}", count(size.unknowns))),
        row("solver", size.systems.method.clone()),
    ]);
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
    rows.extend(frames(case, size.particles).map(|text| row("frames", text)));
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
    let mut cost = Cost {
        text: format!(
            "{} is fine\n  {}\n\n{}\nstages\n{}",
            name.display(),
            on_a_line(&case.title),
            table(&rows),
            table(&stages),
        ),
        bytes: size.bytes,
        most_bytes: size.most_bytes,
        size,
        time,
    };
    if case.mesh_study.meshes > 1 {
        add_study(&mut cost, case, speed)?;
    }
    Ok(cost)
}

/// Sides of rigid bodies that stand in the middle of a cell, if any do.
fn lines<const D: usize>(case: &Case<D>) -> Option<String> {
    let sides = meshes::mid_cell(case);
    let places: Vec<String> = sides.iter().map(|&x| short(x)).collect();
    let text = format!(
        "sides of rigid bodies mid-cell at x = {} m",
        places.join(", ")
    );
    (!sides.is_empty()).then_some(text)
}

/// How many frames a run writes along its stages, and their size; none where it writes those of their ends alone.
fn frames<const D: usize>(case: &Case<D>, particles: usize) -> Option<String> {
    let every = case.output.paraview;
    let one_in = film::one_in(particles);
    let of_stage = |stage: &Stage| {
        let along = match every {
            Every::Steps(every) => stage.steps / every.max(1),
            _ => stage.steps.min(stage.kind.film_frames().div_ceil(one_in)),
        };
        // That of the end, that of the beginning of a motion, and the states at the ends of a search.
        match stage.kind {
            StageKind::Dynamic(_) => (along + 2, along + 2),
            StageKind::StrengthReduction(_) => (3, 3),
            _ => (along + 1, film::MOST.div_ceil(one_in) + 1),
        }
    };
    let stages = case.stages.iter().map(of_stage);
    let (about, most) = stages.fold((0, 0), |sum, stage| (sum.0 + stage.0, sum.1 + stage.1));
    let size = |frames| readable((frames * particles) as f64 * FRAME[D - 2]);
    let how = match every {
        Every::Never | Every::Stage => return None,
        Every::Film if most == about => "up to",
        // Steps that are cut may have frames too.
        Every::Film | Every::Steps(_) => "about",
    };
    let mut text = format!("{how} {about}, about {} in paraview/", size(about));
    if every == Every::Film && most > about {
        let _ = write!(text, "; at most {most}, {}", size(most));
    }
    Some(text)
}

/// Adds the meshes of a study of the mesh error, each with its size, and the cost of all.
fn add_study<const D: usize>(
    cost: &mut Cost,
    case: &Case<D>,
    speed: Speed,
) -> Result<(), CaseError> {
    let mut rows = Vec::new();
    let (mut bytes, mut most_bytes, mut times) = (Vec::new(), Vec::new(), Vec::new());
    for (mesh, parts) in std::iter::zip(meshes::meshes(case), meshes::refinements(case)) {
        let size = estimate(&mesh)?;
        let time = time::time(&mesh, &size, speed);
        rows.push(vec![
            meshes::label(parts),
            format!("{} particles", count(size.particles)),
            format!("{} cells", count(size.cells)),
            format!("about {} unknowns", count(size.unknowns)),
            memory(size.bytes, size.most_bytes),
            format!("about {}", time::readable(time.seconds)),
        ]);
        bytes.push(size.bytes);
        most_bytes.push(size.most_bytes);
        times.push(time);
    }
    cost.time.seconds = times.iter().map(|time| time.seconds).sum();
    cost.time.open_ended = times.iter().any(|time| time.open_ended);
    (cost.bytes, cost.most_bytes) = (together(&bytes), together(&most_bytes));
    let how = if side_by_side(&bytes) > 1 {
        "side by side"
    } else {
        "one after another"
    };
    let _ = write!(
        cost.text,
        "\nmeshes\n{}  {how}: {} of memory, {}\n",
        table(&rows),
        memory(cost.bytes, cost.most_bytes),
        time::sentence(&cost.time)
    );
    Ok(())
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

    /// GOAL: the numbers of a study of the mesh error are those of its text, and not of its first mesh. CASE: the slope on three meshes.
    /// ORACLE: the sizes of its meshes, one by one.
    #[test]
    fn a_study_of_the_mesh_costs_all_its_meshes() {
        let cost = |setting: &str| {
            let slope = igimp_input::shipped::find("slope").unwrap();
            let case = slope.case_file([setting]).unwrap().into_case();
            (size(&case, Path::new("slope.toml")).unwrap(), case)
        };
        let (alone, _) = cost("mesh_study.meshes=1");
        let (all, case) = cost("mesh_study.meshes=3");
        let meshes: Vec<Estimate> = (meshes::meshes(&case).iter())
            .map(|mesh| estimate(mesh).unwrap())
            .collect();
        let bytes: Vec<f64> = meshes.iter().map(|mesh| mesh.bytes).collect();
        assert!((all.bytes / together(&bytes) - 1.0).abs() < 1e-12);
        assert!(all.bytes > 2.0 * alone.bytes && all.time.seconds > 2.0 * alone.time.seconds);
        assert!(
            all.text.contains(&time::sentence(&all.time)),
            "{}",
            all.text
        );
        assert!(
            all.text.contains(&memory(all.bytes, all.most_bytes)),
            "{}",
            all.text
        );
    }

    /// GOAL: frames are printed wherever a run writes them along its stages. CASE: the column with ten steps, a frame for every step and
    /// for every fifth, and those of its end alone. ORACLE: counted by hand.
    #[test]
    fn frames_along_a_stage_are_printed() {
        let text = |every: &str| {
            let column = igimp_input::shipped::find("column").unwrap();
            let settings = [
                format!("output.paraview={{ every = {every} }}"),
                "stages.0.steps=10".to_owned(),
            ];
            super::frames(&column.case_file(settings).unwrap().into_case(), 1000)
        };
        let frames = |every: &str| text(every).unwrap().split(',').next().unwrap().to_owned();
        assert_eq!(frames("1"), "about 11");
        assert_eq!(frames("5"), "about 3");
        assert_eq!(frames("\"film\""), "about 11");
        let film = text("\"film\"").unwrap();
        assert!(film.contains("; at most 41, "), "{film}");
        assert_eq!(text("\"stage\""), None);
    }

    #[test]
    fn memory_with_factors_is_printed_beside() {
        insta::assert_snapshot!(memory(1.7e9, 3.6e9), @"about 1.6 GiB, 3.4 GiB where an iteration is given up for factors");
        insta::assert_snapshot!(memory(5e7, 5e7), @"about 50 MiB");
    }
}
