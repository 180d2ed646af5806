//! GOAL: the tangent matrix is the derivative of the internal force, for every law, basis, B-bar
//! switch and kinematics, in two and three dimensions.
//! ORACLE: central differences of the internal force.

use std::sync::Arc;

use crate::common::{Random, conditions, displacements, grid, laws, methods, particles};
use igimp_assembly::{Kinematics, Method, Particles, Section, SharedLaw, Stencils, System};
use igimp_linear::TangentMatrix;
use igimp_material::{
    CamClayParameters, HardeningSoil, HardeningSoilParameters, ModifiedCamClay, ShearStiffness,
    TangentKind,
};
use igimp_shape::{Axis, Grid};

/// Largest difference between tangent and differences, relative to the largest entry, and the
/// asymmetry of the tangent.
fn tangent_error<const D: usize>(
    grid: &Grid<D>,
    body: &Particles<D>,
    law: &SharedLaw,
    method: &Method,
    columns: usize,
    random: &mut Random,
) -> (f64, f64) {
    let conditions = conditions(grid, law);
    let stencils = Stencils::build(body, method, &conditions).unwrap();
    let system = System::new(body, &stencils, &conditions, method).unwrap();
    let u = displacements(grid, 0.02, random);
    let (trial, matrix) = system.linearise(&u, TangentKind::Consistent).unwrap();
    let alone = system.evaluate(&u, TangentKind::Consistent).unwrap();
    assert_eq!(trial.f_int, alone.f_int, "with and without the tangent");
    assert_eq!(trial.particles, alone.particles);
    let unknowns = system.unknowns();
    let dofs: Vec<(usize, usize)> = (0..grid.node_count())
        .flat_map(|node| (0..D).map(move |axis| (node, axis)))
        .filter(|&(node, axis)| unknowns.index(node, axis).is_some())
        .collect();
    let mut unit = vec![0.0; unknowns.len()];
    let mut column_of_k = vec![0.0; unknowns.len()];
    let (mut largest, mut error) = (0.0_f64, 0.0_f64);
    let mut compared = 0;
    for k in 0..columns {
        let (node, axis) = dofs[k * dofs.len() / columns];
        let column = unknowns.index(node, axis).unwrap();
        unit[column] = 1.0;
        matrix.multiply(&unit, &mut column_of_k);
        unit[column] = 0.0;
        let d = 1e-6;
        let moved = |sign: f64| {
            let mut u = u.clone();
            u[node][axis] += sign * d;
            let trial = system.evaluate(&u, TangentKind::Consistent).unwrap();
            let regimes: Vec<_> = trial.particles.iter().map(|p| p.regime).collect();
            (trial.f_int, regimes)
        };
        let ((plus, regimes_plus), (minus, regimes_minus)) = (moved(1.0), moved(-1.0));
        if regimes_plus != regimes_minus {
            continue; // the force has a kink here, and differences have no meaning
        }
        compared += 1;
        for &(row_node, row_axis) in &dofs {
            let row = unknowns.index(row_node, row_axis).unwrap();
            let difference = (plus[row_node][row_axis] - minus[row_node][row_axis]) / (2.0 * d);
            largest = largest.max(difference.abs());
            error = error.max((difference - column_of_k[row]).abs());
        }
    }
    assert!(
        compared > columns * 3 / 4,
        "{compared} of {columns} columns compared"
    );
    (error / largest, asymmetry(&matrix) / largest)
}

/// Largest difference of an entry and its mirror image.
fn asymmetry(matrix: &TangentMatrix) -> f64 {
    let dense = nalgebra_sparse::CooMatrix::from(&matrix.to_csc());
    let transposed = matrix.to_csc().transpose();
    dense
        .triplet_iter()
        .map(|(i, j, value)| {
            let other = transposed
                .get_entry(i, j)
                .map_or(0.0, nalgebra_sparse::SparseEntry::into_value);
            (value - other).abs()
        })
        .fold(0.0, f64::max)
}

/// A body with a strained and yielded past.
fn strained<const D: usize>(
    grid: &Grid<D>,
    law: &SharedLaw,
    method: &Method,
    random: &mut Random,
) -> Particles<D> {
    let mut body = particles(grid, 1.0, random)
        .with_initial_histories(std::slice::from_ref(law))
        .unwrap();
    let conditions = conditions(grid, law);
    let stencils = Stencils::build(&body, method, &conditions).unwrap();
    let system = System::new(&body, &stencils, &conditions, method).unwrap();
    let u = displacements(grid, 0.05, random);
    let trial = system.evaluate(&u, TangentKind::Consistent).unwrap();
    body.commit(&stencils, method, &trial, &u);
    body
}

#[test]
fn tangent_is_the_derivative_of_the_internal_force() {
    let grid = grid::<2>(6);
    let mut random = Random(7);
    for (name, law) in laws() {
        for method in methods() {
            let body = strained(&grid, &law, &method, &mut random);
            let yielded = body
                .regime
                .iter()
                .filter(|regime| regime.is_plastic())
                .count();
            if name != "elastic" {
                assert!(yielded > body.len() / 4, "{name}: {yielded} yielded");
            }
            let (error, asymmetry) = tangent_error(&grid, &body, &law, &method, 40, &mut random);
            let label = format!("{name}, {}, {:?}", method.label(), method.kinematics);
            assert!(error < 1e-7, "{label}: {error:e}");
            if law.has_symmetric_tangent() {
                assert!(asymmetry < 1e-12, "{label}: asymmetry {asymmetry:e}");
            } else {
                assert!(asymmetry > 1e-3, "{label}: asymmetry {asymmetry:e}");
            }
        }
    }
}

/// GOAL: the same of a law that remembers and whose elasticity is not linear. Its stress is exponential in strain, so that differences
/// have a digit less.
#[test]
fn tangent_of_clay_that_remembers() {
    let grid = grid::<2>(6);
    let mut random = Random(17);
    let clay = ModifiedCamClay::new(CamClayParameters {
        compression: 0.2,
        swelling: 0.1,
        critical_ratio: 1.0,
        shear: ShearStiffness::Poisson(0.3),
        overconsolidation: 1.2,
        reference_pressure: 10.0,
    });
    let law: SharedLaw = Arc::new(clay.unwrap());
    for method in methods() {
        let body = strained(&grid, &law, &method, &mut random);
        let yielded = body.regime.iter().filter(|regime| regime.is_plastic());
        assert!(yielded.count() > body.len() / 5);
        let (error, asymmetry) = tangent_error(&grid, &body, &law, &method, 40, &mut random);
        let label = format!("{}, {:?}", method.label(), method.kinematics);
        assert!(error < 1e-6, "{label}: {error:e}");
        assert!(asymmetry > 1e-4, "{label}: asymmetry {asymmetry:e}");
    }
}

/// GOAL: the same of soil that hardens in shear and by its cap, in the plane and in space.
#[test]
fn tangent_of_soil_on_a_hyperbola() {
    let soil = HardeningSoil::new(HardeningSoilParameters {
        cohesion: 1.0,
        friction_angle: 25_f64.to_radians(),
        dilation_angle: 5_f64.to_radians(),
        secant: 60.0,
        unloading: 180.0,
        oedometer: 50.0,
        reference_pressure: 10.0,
        k0_normal: 0.58,
        ..HardeningSoilParameters::dense_hostun_sand()
    });
    let law: SharedLaw = Arc::new(soil.unwrap());
    held::<2>(6, 40, &law);
    held::<3>(4, 8, &law);
}

fn held<const D: usize>(cells: usize, columns: usize, law: &SharedLaw) {
    let grid = grid::<D>(cells);
    let mut random = Random(19);
    for method in methods() {
        let body = strained(&grid, law, &method, &mut random);
        let yielded = body.regime.iter().filter(|regime| regime.is_plastic());
        assert!(yielded.count() > body.len() / 2);
        let (error, asymmetry) = tangent_error(&grid, &body, law, &method, columns, &mut random);
        let label = format!("{}, {:?}", method.label(), method.kinematics);
        println!("{label}: {error:e}, asymmetry {asymmetry:e}");
        assert!(error < 1e-6, "{label}: {error:e}");
        assert!(asymmetry > 1e-4, "{label}: asymmetry {asymmetry:e}");
    }
}

/// GOAL: the same of a body of revolution, whose strain goes around the axis too.
#[test]
fn tangent_of_a_body_of_revolution() {
    let grid = grid::<2>(6);
    let mut random = Random(23);
    for (name, law) in laws() {
        for method in methods() {
            let method = Method {
                section: Section::Axisymmetric,
                ..method
            };
            let body = strained(&grid, &law, &method, &mut random);
            let (error, asymmetry) = tangent_error(&grid, &body, &law, &method, 40, &mut random);
            let label = format!("{name}, {}, {:?}", method.label(), method.kinematics);
            assert!(error < 1e-7, "{label}: {error:e}");
            if law.has_symmetric_tangent() {
                assert!(asymmetry < 1e-12, "{label}: asymmetry {asymmetry:e}");
            }
        }
    }
}

#[test]
fn tangent_in_three_dimensions() {
    let grid = grid::<3>(4);
    let mut random = Random(11);
    for (name, law) in laws() {
        for method in methods() {
            let body = strained(&grid, &law, &method, &mut random);
            let (error, _) = tangent_error(&grid, &body, &law, &method, 8, &mut random);
            let label = format!("{name}, {}, {:?}", method.label(), method.kinematics);
            assert!(error < 1e-7, "{label}: {error:e}");
        }
    }
}

/// The finite-strain tangent tends to the small-strain one as displacements and stresses vanish.
#[test]
fn small_strain_is_the_limit() {
    let grid = grid::<2>(5);
    let (_, law) = laws().remove(0);
    let body = particles(&grid, 1.0, &mut Random(3));
    let tangent = |kinematics| {
        let method = Method {
            kinematics,
            ..Method::igimp_bbar()
        };
        let conditions = conditions(&grid, &law);
        let stencils = Stencils::build(&body, &method, &conditions).unwrap();
        let system = System::new(&body, &stencils, &conditions, &method).unwrap();
        let still = vec![[0.0; 2]; grid.node_count()];
        let (_, matrix) = system.linearise(&still, TangentKind::Consistent).unwrap();
        matrix.values
    };
    let (finite, small) = (
        tangent(Kinematics::FiniteStrain),
        tangent(Kinematics::SmallStrain),
    );
    let scale = finite.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    for (a, b) in finite.iter().zip(&small) {
        assert!((a - b).abs() < 1e-13 * scale);
    }
}

/// The known part of the first correction is K times the prescribed motion.
#[test]
fn force_of_prescribed_motion_is_the_derivative_along_it() {
    let grid = grid::<2>(6);
    let mut random = Random(23);
    for (name, law) in laws() {
        let method = Method::igimp_bbar();
        let body = strained(&grid, &law, &method, &mut random);
        let conditions = conditions(&grid, &law);
        let stencils = Stencils::build(&body, &method, &conditions).unwrap();
        let system = System::new(&body, &stencils, &conditions, &method).unwrap();
        let u = displacements(&grid, 0.02, &mut random);
        let known = system
            .force_of_prescribed_motion(&u, TangentKind::Consistent)
            .unwrap();
        let direction = system.prescribed_motion();
        let d = 1e-4;
        let force = |sign: f64| {
            let moved: Vec<[f64; 2]> = std::iter::zip(&u, &direction)
                .map(|(u, v)| [u[0] + sign * d * v[0], u[1] + sign * d * v[1]])
                .collect();
            system
                .evaluate(&moved, TangentKind::Consistent)
                .unwrap()
                .f_int
        };
        let (plus, minus) = (force(1.0), force(-1.0));
        let scale = known.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        assert!(scale > 0.0);
        for node in 0..grid.node_count() {
            for axis in 0..2 {
                if let Some(unknown) = system.unknowns().index(node, axis) {
                    let difference = (plus[node][axis] - minus[node][axis]) / (2.0 * d);
                    assert!((difference - known[unknown]).abs() < 1e-6 * scale, "{name}");
                }
            }
        }
    }
}

/// A step that begins on a surface which has shrunk since: its elastic tangent is symmetric, as it
/// says of itself.
#[test]
fn elastic_tangent_is_symmetric_where_strength_fell() {
    let grid = grid::<2>(6);
    let mut random = Random(8);
    let still = vec![[0.0; 2]; grid.node_count()];
    for (name, law) in laws() {
        for method in methods() {
            let body = strained(&grid, &law, &method, &mut random);
            let conditions = conditions(&grid, &law.reduced(1.5).unwrap());
            let stencils = Stencils::build(&body, &method, &conditions).unwrap();
            let system = System::new(&body, &stencils, &conditions, &method).unwrap();
            let (trial, matrix) = system.linearise(&still, TangentKind::Elastic).unwrap();
            let plastic = trial.particles.iter().filter(|p| p.regime.is_plastic());
            assert!(
                name == "elastic" || plastic.count() > body.len() / 8,
                "{name}"
            );
            let largest = matrix.diagonal().fold(0.0, f64::max);
            let off = asymmetry(&matrix) / largest;
            assert!(off < 1e-12, "{name}, {}: {off:e}", method.label());
            assert_eq!(matrix.symmetric, law.has_symmetric_tangent());
        }
    }
}

/// A particle in a large cell that reaches over many small ones: its nodes are stored apart from all
/// others.
#[test]
fn a_wide_particle_has_the_tangent_of_its_force() {
    let nodes = std::iter::once(0.0).chain((0..14).map(|k| 8.0 + f64::from(k)));
    let axes = [
        Axis::from_nodes(nodes.collect()).unwrap(),
        Axis::uniform(0.0, 1.0, 40).unwrap(),
    ];
    let grid = Grid::new(axes);
    let mut random = Random(9);
    let mut fields = (*particles(&grid, 1.0, &mut random)).clone();
    fields.x[0] = [7.0, 20.3];
    fields.half_length[0] = [7.0, 0.3];
    let body = Particles::from_fields(fields).unwrap();
    for (_, law) in &laws()[..2] {
        for method in [Method::igimp(), Method::igimp_bbar()] {
            let (error, asymmetry) = tangent_error(&grid, &body, law, &method, 60, &mut random);
            assert!(error < 1e-7 && asymmetry < 1e-12, "{error:e} {asymmetry:e}");
        }
    }
}
