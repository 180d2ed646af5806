//! The soil of cells.

use std::sync::Arc;

use igimp_material::{Elasticity, HenckyElastic, MohrCoulomb, Strength, VonMises};

use super::*;

const GEOMETRIES: [Geometry; 2] = [Geometry::Given, Geometry::Moving];

/// Soil with φ = 20° and an angle of dilation \[deg\].
fn soil(dilation: f64) -> MohrCoulomb {
    let angles = [20.0_f64, dilation].map(f64::to_radians);
    MohrCoulomb::new(elasticity(), 1e4, angles[0], angles[1]).unwrap()
}

fn elasticity() -> Elasticity {
    Elasticity::new(1e7, 0.3).unwrap()
}

// GOAL: the ends of eq. 8c and the laws that it does not concern have the shares of eq. 8c.
// ORACLE: the numbers of eq. 8c.
#[test]
fn ends_are_those_of_the_theory() {
    let von_mises = VonMises::from_undrained_strength(elasticity(), 1e4).unwrap();
    for (geometry, associated) in std::iter::zip(GEOMETRIES, [0.02, 0.1]) {
        let near = |law: &dyn ConstitutiveModel, share: f64| {
            assert!((share_of_law(law, geometry) - share).abs() < 1e-15);
        };
        near(&soil(0.0), 0.3);
        near(&soil(20.0), associated);
        near(&von_mises, associated);
        near(&HenckyElastic::new(elasticity()), 1.0);
    }
}

// GOAL: the layer by which soil without cohesion counts (theory, eq. 8g) is soil one cell high.
// CASE: cells 1 wide and 2 high, 0.5 and 3 in density.
// ORACLE: the mass of a cell over its width.
#[test]
fn a_layer_is_one_cell_high() {
    let axes = [1.0, 2.0].map(|size| igimp_shape::Axis::uniform(0.0, size, 2).unwrap());
    let grid = Grid::<2>::new(axes);
    let laws: Vec<crate::SharedLaw> = vec![Arc::new(soil(0.0)), Arc::new(soil(20.0))];
    let seeds: Vec<_> = (0..4)
        .map(|cell| crate::ParticleSeed {
            x: [0.5 + f64::from(cell % 2), 1.0 + 2.0 * f64::from(cell / 2)],
            half_length: [0.5, 1.0],
            volume: 2.0,
            density: [0.5, 3.0][cell as usize / 2],
            law: cell as usize / 2,
            centroid: [0.0; 2],
        })
        .collect();
    let particles = Particles::new(&seeds).unwrap();
    let constraints = crate::Constraints::free(&grid);
    let loads = crate::StepLoads::gravity([0.0, -10.0]);
    let conditions = StepConditions::new(grid, constraints, loads, laws).unwrap();
    let method = Method {
        geometry: Geometry::Given,
        ..Method::shared_strain()
    };
    let soil = CellSoil::where_it_counts(&particles, &method, &conditions, &[]).unwrap();
    let moments = soil.unwrap().moments(&conditions.grid, &particles, &method);
    let layers: Vec<f64> = moments.iter().map(|law| law.layer).collect();
    assert_eq!(layers, [1.0, 6.0]);
}

// GOAL: a point that loads a face is of the cells that it may press.
// ORACLE: a point within a cell is of that alone, one on a line of both beside it, one on the side of the grid of that within.
#[test]
fn points_on_lines_are_of_both_cells() {
    let axis = igimp_shape::Axis::uniform(0.0, 1.0, 3).unwrap();
    let grid = Grid::<2>::new([axis.clone(), axis]);
    for (x, expected) in [
        ([0.5, 1.5], vec![3]),
        ([1.0, 0.5], vec![0, 1]),
        ([2.0, 1.0], vec![1, 2, 4, 5]),
        ([0.0, 0.5], vec![0]),
    ] {
        let (force, load) = ([0.0; 2], 0);
        let is_loaded = loaded_cells(&grid, &[LoadPoint { x, force, load }]);
        let loaded: Vec<usize> = (0..9).filter(|&cell| is_loaded[cell]).collect();
        assert_eq!(loaded, expected, "{x:?}");
    }
}

// GOAL: the share falls with ψ and does not jump, up to associated flow.
// ORACLE: 1/β is linear in √(ψ/φ); between neighbours of a fine division of √(ψ/φ) β changes by no more
// than its steepest slope, β² (1/β₁ − 1/β₀) at β₀, allows.
#[test]
fn falls_with_dilation_without_a_jump() {
    for (geometry, associated) in std::iter::zip(GEOMETRIES, [0.02, 0.1]) {
        let shares: Vec<f64> = (0..=1000)
            .map(|step| share_of_law(&soil(20.0 * (f64::from(step) / 1000.0).powi(2)), geometry))
            .collect();
        let steepest = 0.3 * 0.3 * (1.0 / associated - 1.0 / 0.3) / 1000.0;
        for pair in shares.windows(2) {
            let fall = pair[0] - pair[1];
            assert!(fall > 0.0 && fall <= steepest * (1.0 + 1e-6), "{pair:?}");
        }
    }
}

// GOAL: a search does not change β: soil keeps its share while its strength is reduced, also beyond the
// factor at which the reduced φ reaches ψ and flow becomes associated.
// ORACLE: the law as it is given.
#[test]
fn is_that_of_the_law_as_given() {
    for law in [soil(0.0), soil(5.0), soil(15.0), soil(20.0)] {
        for srf in [0.5, 1.2, 1.4, 3.0] {
            let once: Arc<dyn ConstitutiveModel> = law.reduced(srf).unwrap();
            let twice = once.reduced(1.1).unwrap();
            for geometry in GEOMETRIES {
                let given = share_of_law(&law, geometry).to_bits();
                assert_eq!(share_of_law(&*once, geometry).to_bits(), given);
                assert_eq!(share_of_law(&*twice, geometry).to_bits(), given);
            }
        }
    }
}
