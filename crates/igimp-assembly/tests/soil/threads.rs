//! GOAL: the bits of force and tangent do not depend on the number of threads.

use crate::common::{Random, conditions, displacements, grid, laws, methods, particles};
use igimp_assembly::{Stencils, System};
use igimp_material::TangentKind;

fn bits(threads: usize) -> Vec<u64> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    pool.install(|| {
        let mut bits = Vec::new();
        let grid = grid::<2>(24);
        let mut random = Random(17);
        let body = particles(&grid, 1.0, &mut random);
        let u = displacements(&grid, 0.02, &mut random);
        for (_, law) in laws() {
            for method in methods() {
                let conditions = conditions(&grid, &law);
                let stencils = Stencils::build(&body, &method, &conditions).unwrap();
                let system = System::new(&body, &stencils, &conditions, &method).unwrap();
                let (trial, matrix) = system.linearise(&u, TangentKind::Consistent).unwrap();
                bits.extend(trial.f_int.iter().flatten().map(|value| value.to_bits()));
                bits.extend(matrix.values.iter().map(|value| value.to_bits()));
                bits.extend(system.f_ext().iter().flatten().map(|value| value.to_bits()));
            }
        }
        bits
    })
}

#[test]
fn bits_are_equal_for_one_two_and_seven_threads() {
    let one = bits(1);
    assert!(one.len() > 100_000);
    assert_eq!(one, bits(2));
    assert_eq!(one, bits(7));
}
