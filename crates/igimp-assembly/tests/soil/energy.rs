//! GOAL: with finite strain the internal force of an elastic body is the derivative of the energy that
//! its law stores (theory, eq. 15a), B-bar included, in two and three dimensions.
//! ORACLE: central differences of the energy of Hencky's law, computed here from bulk and shear
//! modulus.

use crate::common::{Random, conditions, displacements, grid, laws, particles};
use igimp_assembly::{Method, Stencils, System};
use igimp_material::{Elasticity, TangentKind};

/// Energy per volume: K (tr ε)² / 2 + G e : e, with e the deviator.
fn stored(elasticity: &Elasticity, eps: &[f64; 3]) -> f64 {
    let trace: f64 = eps.iter().sum();
    let deviator = eps.map(|component| component - trace / 3.0);
    let distortion: f64 = deviator.iter().map(|component| component * component).sum();
    0.5 * elasticity.bulk() * trace * trace + elasticity.shear() * distortion
}

/// Largest difference between the force and the derivative of the energy, relative to the largest force.
fn error_of_force<const D: usize>(method: &Method, cells: usize, count: usize) -> f64 {
    let mut random = Random(31);
    let grid = grid::<D>(cells);
    let (_, law) = laws().remove(0);
    let mut body = particles(&grid, 1.0, &mut random);
    let conditions = conditions(&grid, &law);
    let build = |body: &_| Stencils::build(body, method, &conditions).unwrap();
    // Stress and deformation from an earlier step.
    let stencils = build(&body);
    let earlier = displacements(&grid, 0.05, &mut random);
    let trial = System::new(&body, &stencils, &conditions, method)
        .and_then(|system| system.evaluate(&earlier, TangentKind::Consistent))
        .unwrap();
    body.commit(&stencils, method, &trial, &earlier);

    let stencils = build(&body);
    let system = System::new(&body, &stencils, &conditions, method).unwrap();
    let evaluate = |u: &[[f64; D]]| system.evaluate(u, TangentKind::Consistent).unwrap();
    let energy = |u: &[[f64; D]]| -> f64 {
        let trial = evaluate(u);
        let slots = std::iter::zip(stencils.order(), &trial.particles);
        slots
            .map(|(&particle, point)| {
                body.volume0[particle as usize] * stored(law.stiffness_bound(), &point.eps_e)
            })
            .sum()
    };
    let u = displacements(&grid, 0.03, &mut random);
    let force = evaluate(&u).f_int;
    let largest = force.iter().flatten().fold(0.0, |m: f64, f| m.max(f.abs()));
    let touched: Vec<usize> = (0..force.len())
        .filter(|&node| force[node].iter().any(|f| f.abs() > 1e-3 * largest))
        .collect();
    let mut error = 0.0_f64;
    for k in 0..count {
        let node = touched[k * touched.len() / count];
        for axis in 0..D {
            let d = 1e-5;
            let moved = |sign: f64| {
                let mut u = u.clone();
                u[node][axis] += sign * d;
                energy(&u)
            };
            let slope = (moved(1.0) - moved(-1.0)) / (2.0 * d);
            error = error.max((slope - force[node][axis]).abs() / largest);
        }
    }
    error
}

#[test]
fn force_is_the_derivative_of_the_stored_energy() {
    for method in [
        Method::impm(),
        Method::impm_bbar(),
        Method::igimp(),
        Method::igimp_bbar(),
    ] {
        for error in [
            error_of_force::<2>(&method, 6, 20),
            error_of_force::<3>(&method, 4, 8),
        ] {
            assert!(error < 1e-7, "{}: {error:e}", method.label());
        }
    }
}
