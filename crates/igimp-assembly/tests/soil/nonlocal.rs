//! GOAL: equations with nonlocal strain among the unknowns: their tangent, the effect of prescribed motion, its bits on threads, and
//! their refusals.
//! ORACLE: central differences of the force; one thread; typed errors.

use std::sync::Arc;

use crate::common::{Random, conditions, displacements, grid, methods, particles};
use igimp_assembly::{
    AssemblyError, Geometry, Method, Particles, SharedLaw, Stencils, StepConditions, System,
    TimeScheme, TimeStep,
};
use igimp_linear::TangentMatrix;
use igimp_material::{
    Curve, Decay, Directions, Elasticity, FrictionalCurves, Nonlocal, Ratios, Softening,
    TangentKind,
};
use igimp_shape::Grid;

/// Softening laws that see the ground around.
fn laws() -> Vec<(&'static str, SharedLaw)> {
    let elasticity = Elasticity::new(100.0, 0.3).unwrap();
    let curve = |initial: f64, residual: f64| Curve {
        initial,
        residual,
        strain: 0.1,
        decay: Decay::Exponential,
    };
    let angle = |initial: f64, residual: f64| curve(initial.to_radians(), residual.to_radians());
    let curves = FrictionalCurves {
        cohesion: curve(1.0, 0.4),
        friction_angle: angle(25.0, 20.0),
        dilation_angle: angle(5.0, 0.0),
    };
    let around = |law: Softening| -> SharedLaw {
        let nonlocal = Nonlocal {
            length: 0.8,
            over_nonlocal: 2.0,
        };
        Arc::new(law.with_nonlocal(nonlocal).unwrap())
    };
    let directions = Directions {
        simple_shear: 0.75,
        passive: 0.5,
    };
    let tresca = Softening::tresca(elasticity, curve(1.0, 0.4)).unwrap();
    vec![
        (
            "von Mises",
            around(Softening::von_mises(elasticity, curve(1.0, 0.4)).unwrap()),
        ),
        ("Tresca", around(tresca.clone())),
        (
            "Tresca by direction",
            around(tresca.with_directions(directions).unwrap()),
        ),
        (
            "Mohr-Coulomb",
            around(Softening::mohr_coulomb(elasticity, curves, None).unwrap()),
        ),
        (
            "Mohr-Coulomb with a cut-off",
            around(Softening::mohr_coulomb(elasticity, curves, Some(0.5)).unwrap()),
        ),
    ]
}

/// Nodal values of a step: displacements, and rises of nonlocal strain behind them.
fn nodal_values(system: &System<'_, 2>, grid: &Grid<2>, random: &mut Random) -> Vec<[f64; 2]> {
    let mut u = displacements(grid, 0.02, random);
    u.resize_with(system.node_count(), || {
        [0.02 + 0.02 * random.symmetric(), 0.0]
    });
    u
}

/// A body that yielded before, with strength and stiffness that vary if asked for.
fn yielded(grid: &Grid<2>, law: &SharedLaw, method: &Method, varies: bool) -> Particles<2> {
    let mut random = Random(5);
    let mut body = particles(grid, 1.0, &mut random)
        .with_initial_histories(std::slice::from_ref(law))
        .unwrap();
    if varies {
        let ratios = (0..body.len()).map(|_| Ratios {
            strength: 0.8 + 0.1 * random.symmetric(),
            friction: 1.0,
            stiffness: 0.7 + 0.2 * random.symmetric(),
        });
        body = body.clone().with_ratios(ratios.collect()).unwrap();
    }
    let conditions = conditions(grid, law);
    let stencils = Stencils::build(&body, method, &conditions).unwrap();
    let system = System::new(&body, &stencils, &conditions, method).unwrap();
    let u = nodal_values(&system, grid, &mut random);
    let trial = system.evaluate(&u, TangentKind::Consistent).unwrap();
    body.commit(&stencils, method, &trial, &u);
    body
}

/// Largest difference of the tangent from differences over its largest entry, every so many unknowns.
fn tangent_error(
    system: &System<'_, 2>,
    matrix: &TangentMatrix,
    u: &[[f64; 2]],
    every: usize,
) -> f64 {
    let unknowns = system.unknowns();
    let places: Vec<(usize, usize)> = (0..unknowns.len())
        .map(|unknown| unknowns.place(unknown).unwrap())
        .collect();
    let (mut unit, mut column) = (vec![0.0; unknowns.len()], vec![0.0; unknowns.len()]);
    let (mut largest, mut error, mut compared) = (0.0_f64, 0.0_f64, 0);
    for k in (0..unknowns.len()).step_by(every) {
        let (node, axis) = places[k];
        unit[k] = 1.0;
        matrix.multiply(&unit, &mut column);
        unit[k] = 0.0;
        let d = 1e-6;
        let [plus, minus] = [d, -d].map(|by| {
            let mut u = u.to_vec();
            u[node][axis] += by;
            system.evaluate(&u, TangentKind::Consistent).unwrap()
        });
        let regimes = |of: &igimp_assembly::Trial<2>| -> Vec<_> {
            of.particles.iter().map(|p| p.regime).collect()
        };
        if regimes(&plus) != regimes(&minus) {
            continue; // the force has a kink here, and differences have no meaning
        }
        compared += 1;
        for (row, &(node, axis)) in places.iter().enumerate() {
            let difference = (plus.f_int[node][axis] - minus.f_int[node][axis]) / (2.0 * d);
            largest = largest.max(difference.abs());
            error = error.max((difference - column[row]).abs());
        }
    }
    assert!(compared * every * 2 > unknowns.len(), "{compared} compared");
    error / largest
}

#[test]
fn the_tangent_is_the_derivative() {
    let grid = grid::<2>(6);
    let mut random = Random(29);
    for (name, law) in laws() {
        for method in methods() {
            let given = Method {
                geometry: Geometry::Given,
                ..method.clone()
            };
            for (method, varies) in [(method, false), (given, true)] {
                let body = yielded(&grid, &law, &method, varies);
                let conditions = conditions(&grid, &law);
                let stencils = Stencils::build(&body, &method, &conditions).unwrap();
                let system = System::new(&body, &stencils, &conditions, &method).unwrap();
                let u = nodal_values(&system, &grid, &mut random);
                let (trial, matrix) = system.linearise(&u, TangentKind::Consistent).unwrap();
                let plastic = trial.particles.iter().filter(|p| p.regime.is_plastic());
                assert!(plastic.count() > body.len() / 4, "{name}");
                let error = tangent_error(&system, &matrix, &u, 7);
                let label = format!("{name}, {}, {:?}", method.label(), method.geometry);
                assert!(error < 1e-6, "{label}: {error:e}");
            }
        }
    }
}

/// The known part of the first correction is K times the prescribed motion.
#[test]
fn prescribed_motion_spreads_plastic_strain() {
    let grid = grid::<2>(6);
    let mut random = Random(31);
    let method = Method::igimp_bbar();
    for (name, law) in laws() {
        let body = yielded(&grid, &law, &method, false);
        let conditions = conditions(&grid, &law);
        let stencils = Stencils::build(&body, &method, &conditions).unwrap();
        let system = System::new(&body, &stencils, &conditions, &method).unwrap();
        let u = nodal_values(&system, &grid, &mut random);
        let kind = TangentKind::Consistent;
        let known = system.force_of_prescribed_motion(&u, kind).unwrap();
        let mut direction = system.prescribed_motion();
        direction.resize(u.len(), [0.0; 2]);
        let d = 1e-4;
        let [plus, minus] = [d, -d].map(|by| {
            let moved = std::iter::zip(&u, &direction);
            let moved: Vec<[f64; 2]> = moved
                .map(|(u, v)| [u[0] + by * v[0], u[1] + by * v[1]])
                .collect();
            system.evaluate(&moved, kind).unwrap().f_int
        });
        let scale = known.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
        let unknowns = system.unknowns();
        let mut of_strain = 0.0_f64;
        for (unknown, known) in known.iter().enumerate() {
            let (node, axis) = unknowns.place(unknown).unwrap();
            let difference = (plus[node][axis] - minus[node][axis]) / (2.0 * d);
            assert!((difference - known).abs() < 1e-6 * scale, "{name}");
            if node >= unknowns.first_scalar() {
                of_strain = of_strain.max(known.abs());
            }
        }
        assert!(of_strain > 1e-3 * scale, "{name}");
    }
}

#[test]
fn bits_are_equal_for_one_two_and_seven_threads() {
    let bits = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let grid = grid::<2>(20);
            let (_, law) = laws().remove(1);
            let method = Method::igimp_bbar();
            let body = yielded(&grid, &law, &method, false);
            let conditions = conditions(&grid, &law);
            let stencils = Stencils::build(&body, &method, &conditions).unwrap();
            let system = System::new(&body, &stencils, &conditions, &method).unwrap();
            let u = nodal_values(&system, &grid, &mut Random(3));
            let (trial, matrix) = system.linearise(&u, TangentKind::Consistent).unwrap();
            let force = trial.f_int.iter().flatten();
            let all = force
                .chain(&matrix.values)
                .chain(body.internal.as_flattened());
            all.map(|value| value.to_bits()).collect::<Vec<u64>>()
        })
    };
    let one = bits(1);
    assert!(one.len() > 10_000);
    assert_eq!(one, bits(2));
    assert_eq!(one, bits(7));
}

/// GOAL: a law that sees the ground around is refused in space and in a step with inertia. ORACLE: the error by its kind.
#[test]
fn space_and_inertia_are_refused() {
    fn refused<const D: usize>(cells: usize, time: Option<TimeStep>) -> Option<&'static str> {
        let (_, law) = laws().remove(0);
        let grid = grid::<D>(cells);
        let body = particles(&grid, 0.0, &mut Random(1));
        let conditions: StepConditions<D> = conditions(&grid, &law).with_time(time).unwrap();
        let method = Method::igimp_bbar();
        let stencils = Stencils::build(&body, &method, &conditions).unwrap();
        match System::new(&body, &stencils, &conditions, &method) {
            Err(AssemblyError::NonlocalStrain { with }) => Some(with),
            _ => None,
        }
    }
    assert_eq!(refused::<3>(4, None), Some("space"));
    let time = TimeStep {
        duration: 0.1,
        scheme: TimeScheme::BackwardEuler,
        lumped: 0.0,
        is_first: true,
        must_resolve: false,
    };
    assert_eq!(refused::<2>(4, Some(time)), Some("inertia"));
    assert_eq!(refused::<2>(4, None), None);
}
