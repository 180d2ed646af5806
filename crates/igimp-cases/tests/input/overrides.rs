//! Values given on the command line take the place of those in the file.

use std::fmt::Write as _;

use igimp_assembly::Locking;

use crate::messages::printed;
use crate::{SLOPE, overridden};

#[test]
fn overrides_change_values_of_any_type() {
    let file = overridden(
        SLOPE,
        &[
            "materials.clay.cohesion=12 kPa",
            "materials.clay.young = \"30 MPa\"",
            "materials.rock.poisson=0.2",
            "bodies.slope.points_per_cell=9",
            "stages.0.steps=5",
            "stages.run-out.steps=7",
            "stages.\"factor of safety\".bracket=[1.2, 1.6]",
            "grid.locking=none",
            "grid.small_cuts.remedy=drop",
            "solver.linear=multigrid",
            "output.folder=elsewhere",
        ],
    );
    let case = file.unwrap_or_else(|error| panic!("{error}")).into_case();
    assert_eq!(case.materials[0].young, 30e6);
    assert_eq!(case.materials[1].poisson, 0.2);
    assert_eq!(case.bodies[0].per_direction, 3);
    assert_eq!((case.stages[0].steps, case.stages[2].steps), (5, 7));
    assert_eq!(case.method.locking, Locking::None);
    let debug = format!("{case:?}");
    for part in [
        "cohesion: 12000.0",
        "remedy: Drop",
        "bracket: [1.2, 1.6]",
        "Multigrid",
        "elsewhere",
    ] {
        assert!(debug.contains(part), "{part}");
    }
}

#[test]
fn wrong_overrides_are_named() {
    let mut out = String::new();
    for text in [
        "materials.clay.cohesoin=12 kPa",
        "materials.clay.cohesion=12",
        "materials.clay.cohesion=12 kN/m3",
        "materials.caly.cohesion=12 kPa",
        "bodies.slop.points_per_cell=9",
        "stages.7.steps=5",
        "loads.footing.reaction_factor=2",
        "grid.cell.x=1 m",
        "solver.tolerance=\"1e-6",
        "solver.tolerance=",
        "solver..tolerance=1",
        "tolerance",
        "grid.domain.x=[\"0 m\", \"50 m\"]",
    ] {
        let _ = writeln!(
            out,
            "## --set {text}\n{}",
            printed(&overridden(SLOPE, &[text]))
        );
    }
    insta::assert_snapshot!(out);
}
