//! GOAL: the case of a million particles is one, with half a million unknowns and an unsymmetric
//! tangent.
//! ORACLE: the area of the slope, four particles and two unknowns for every cell of it.

use std::path::Path;

use igimp_cases::estimate::estimate;
use igimp_cases::input::CaseFile;

#[test]
fn the_million_is_a_million() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/million.toml");
    let case = CaseFile::read(&path, &[]).unwrap().into_case();
    let cells = 0.5 * (12.0 + 32.0) * 10.0 * 34.0 * 34.0;
    let size = estimate(&case).unwrap();
    assert!(
        (size.particles as f64 / (4.0 * cells) - 1.0).abs() < 0.01,
        "{size:?}"
    );
    assert!(
        (size.unknowns as f64 / (2.0 * cells) - 1.0).abs() < 0.01,
        "{size:?}"
    );
    assert!(size.particles >= 1_000_000 && size.unknowns >= 500_000);
    assert!(!case.materials[0].law().unwrap().has_symmetric_tangent());
    assert_eq!(case.stages.len(), 1);
    assert_eq!(case.stages[0].steps, 10);
}
