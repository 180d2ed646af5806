//! The factor of safety of a slope from Rust: a case file, changed here and there, is run, and its
//! results are written into a folder, as `igimp run` does it.

use std::error::Error;
use std::sync::atomic::AtomicBool;

use igimp_cases::run::{Event, Start, Target, run};
use igimp_input::shipped::find;
use igimp_results::folder::overwrite_guard::Replace;

fn main() -> Result<(), Box<dyn Error>> {
    // `CaseFile::read(path, &overrides)` takes a file of your own in the same way.
    let shipped = find("slope").ok_or("there is no such case")?;
    let file = shipped.case_file(["grid.cell = 2 m", "stages.run-out.steps = 50"])?;
    let target = Target {
        // Results of another case, and of a run that was stopped, are otherwise refused.
        replace: Replace::Everything,
        ..Target::of(&file, std::env::temp_dir().join("igimp-slope"))
    };
    let mut listener = |event: &Event<'_, 2>| {
        if let Event::Path { point } = event {
            println!("SRF {:.4}: {:.4} m", point.factor, point.displacement);
        }
    };
    let (start, never) = (Start::Afresh, AtomicBool::new(false));
    let found = run(file.case(), Some(&target), start, &mut listener, &never)?;
    for safety in found
        .summary
        .stages
        .iter()
        .filter_map(|s| s.safety.as_ref())
    {
        println!("{:?} <= F < {:?}", safety.stable, safety.failed);
    }
    println!("the report is in {}", target.folder.display());
    Ok(())
}
