//! The factor of safety of a slope from Rust: a case file, changed here and there, is run, and its
//! results are written into a folder, as `igimp run` does it.

use std::error::Error;
use std::sync::atomic::AtomicBool;

use igimp_cases::run::{Event, Start, Target, run};
use igimp_cases::shipped::find;

fn main() -> Result<(), Box<dyn Error>> {
    // `CaseFile::read(path, &overrides)` takes a file of your own in the same way.
    let overrides = [
        "grid.cell = 2 m",
        "grid.domain.y = ['0 m', '12 m']",
        "stages.strength reduction.factors = []",
        "stages.strength reduction.tolerance = 0.05",
    ];
    let shipped = find("mohr_coulomb_slope").ok_or("there is no such case")?;
    let file = shipped.case_file(overrides)?;
    let target = Target {
        folder: std::env::temp_dir().join("igimp-slope"),
        source: file.source().to_owned(),
        completed: file.explain(),
    };
    let mut listener = |event: &Event<'_>| {
        if let Event::Trial { trial, .. } = event {
            println!("SRF {:.4}: {}", trial.srf, trial.reason);
        }
    };
    let never = AtomicBool::new(false);
    let result = run(
        file.case(),
        Some(&target),
        Start::Afresh,
        &mut listener,
        &never,
    )?;
    let safety = result.summary.stages[0]
        .safety
        .as_ref()
        .ok_or("no search")?;
    let (stable, failed) = (
        safety.stable.ok_or("fails")?,
        safety.failed.ok_or("stands")?,
    );
    println!(
        "{stable:.3} <= factor of safety < {failed:.3}; failed: {}",
        safety.criterion
    );
    println!("report, pictures and tables: {}", target.folder.display());
    Ok(())
}
