//! GOAL: the cases of a million particles are that, with half a million unknowns in the plane, four hundred thousand in
//! space, and an unsymmetric tangent.
//! ORACLE: the area of the slope, four particles and two unknowns for every cell of it; its volume, eight and three.

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

#[test]
fn the_million_in_space_is_a_million() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/slope_3d_million.toml");
    let file = CaseFile::read(&path, &[]).unwrap();
    let case = file.case_in_space();
    // Sections in front and at the back, straight between; planes that fall across rectangles of the ground differ by little.
    let front = 9.0 * 10.0 + 5.0 * 7.5 + 6.02 * 5.0;
    let back = 7.0 * 10.0 + 10.0 * 7.5 + 3.02 * 5.0;
    let cells = 0.5 * (front + back) * 15.08 / 0.26_f64.powi(3);
    let size = estimate(case).unwrap();
    // The surface cuts parts of cells, each a particle, by half; and it is one layer of nodes more.
    let surface = 20.02 * 15.08 / (0.26 * 0.26);
    let particles = 8.0 * cells + 0.5 * 4.0 * surface;
    assert!(
        (size.particles as f64 / particles - 1.0).abs() < 0.01,
        "{size:?}"
    );
    let unknowns = 3.0 * (cells + surface);
    assert!(
        (size.unknowns as f64 / unknowns - 1.0).abs() < 0.01,
        "{size:?}"
    );
    assert!(size.particles >= 1_000_000 && size.unknowns >= 400_000);
    assert!(!case.materials[0].law().unwrap().has_symmetric_tangent());
}
