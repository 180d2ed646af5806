//! GOAL: a residual counts as round-off where it is that, and a force that strain makes does not, however small the strain
//! (theory, eq. 24a).
//! BODY: a body without force that moves as a whole, and whose nodes move at random by 1e-13 of a cell.
//! ORACLE: rigid motion has no force; strains are known to some 1e-15, a fiftieth of those of the second case.

use crate::common::{Random, displacements, grid, laws, methods, particles};
use igimp_assembly::{Constraints, Stencils, StepConditions, StepLoads, System};
use igimp_material::TangentKind;

#[test]
fn round_off_differs_from_the_force_of_small_strain() {
    fn tell<const D: usize>() {
        let grid = grid::<D>(5);
        let mut random = Random(21);
        let body = particles(&grid, 1.0, &mut random);
        for (name, law) in laws() {
            let loads = StepLoads::gravity([0.0; D]);
            let free = Constraints::free(&grid);
            let conditions = StepConditions::new(grid.clone(), free, loads, vec![law]).unwrap();
            for method in methods() {
                let stencils = Stencils::build(&body, &method, &conditions).unwrap();
                let system = System::new(&body, &stencils, &conditions, &method).unwrap();
                let is_round_off = |u: &[[f64; D]]| {
                    let trial = system.evaluate(u, TangentKind::Consistent).unwrap();
                    system.out_of_balance(&trial).unwrap().is_round_off
                };
                let label = format!("{name}, {}, {:?}", method.label(), method.kinematics);
                assert!(is_round_off(&vec![[0.3; D]; grid.node_count()]), "{label}");
                let strained = displacements(&grid, 1e-13, &mut random);
                assert!(!is_round_off(&strained), "{label}");
            }
        }
    }
    tell::<2>();
    tell::<3>();
}
