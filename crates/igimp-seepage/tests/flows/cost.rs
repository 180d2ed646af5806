//! The cost of a flow: printed, not judged.

/// GOAL: the time of a dam of many cells, printed; in an optimised build ask for 100 000 by `IGIMP_SEEPAGE_CELLS`.
#[test]
fn the_time_of_a_dam_is_printed() {
    let asked = std::env::var("IGIMP_SEEPAGE_CELLS").ok();
    let cells: f64 = asked.and_then(|text| text.parse().ok()).unwrap_or(1600.0);
    let start = std::time::Instant::now();
    let found = crate::common::dam(10.0, 10.0, 2.0, 10.0 / cells.sqrt().round(), 0.0);
    println!(
        "{} cells: {:.2} s, {} corrections",
        found.grid.cell_count(),
        start.elapsed().as_secs_f64(),
        found.corrections
    );
    assert!((found.outflow / 4.8 - 1.0).abs() < 5e-3);
}
