//! GOAL: the cases of a million particles are that, with half a million unknowns in the plane, four hundred thousand in
//! space, and an unsymmetric tangent.
//! A hillside that cuts the cells obliquely carries its own weight. All cases are read without a warning.
//! ORACLE: the area of the slope, four particles and two unknowns for every cell of it; its volume, eight and three; the
//! same hillside with small cuts as the plane has them.

use std::path::Path;

use igimp_cases::run::in_memory;
use igimp_estimate::estimate;
use igimp_input::CaseFile;
use igimp_results::summary::StageSummary;

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
    // The plane between the layers cuts a layer of cells, of which each part has its own particles: half a cell's more.
    let between = 0.5 * (14.0 + 17.0) * 15.08 / (0.26 * 0.26);
    let particles = 8.0 * cells + 0.5 * 4.0 * surface + 4.0 * between;
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

/// CONTROL: with fewer nodes tied, two of them move against each other in the soil of one cell, and steps are cut.
#[test]
fn a_hillside_across_the_grid_is_not_cut() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/hillside.toml");
    let weight = |settings: &[&str]| -> StageSummary {
        let settings: Vec<_> = settings.iter().map(|&text| text.to_owned()).collect();
        let file = CaseFile::read(&path, &settings).unwrap();
        in_memory(file.case_in_space()).unwrap().summary.stages[0].clone()
    };
    let space = weight(&[]);
    assert_eq!((space.steps, space.cuts), (3, 0), "{space:?}");
    let plane = weight(&["grid.small_cuts.below=1e-4"]);
    assert!(plane.cuts > 0, "{plane:?}");
    assert!(
        plane.largest_displacement > 1.2 * space.largest_displacement,
        "{plane:?}"
    );
}

#[test]
fn all_cases_are_read_without_warning() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let mut read = 0;
    for entry in folder.read_dir().unwrap() {
        let path = entry.unwrap().path();
        let file = CaseFile::read(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(file.warnings(), "", "{}", path.display());
        read += 1;
    }
    assert!(read >= 6);
}
