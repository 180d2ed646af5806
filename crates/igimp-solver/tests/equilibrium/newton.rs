//! GOAL: one load step finds the equilibrium, as fast as Newton's method can, or says why not.
//! BODY: small blocks of 2 × 2 particles per unit cell, standing, confined or floating.
//! ORACLE: Newton's quadratic convergence, closed forms of uniaxial strain, balance of forces, and
//! the agreement of independent linear solvers.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use crate::body_support::{
    STRENGTH, YOUNG, block, conditions, confined, distance, elastic, elasticity, largest, laws,
    loaded, methods, pressed, shifted_block, solve, standing, unit_grid, von_mises,
};
use igimp_assembly::{
    Constraints, Kinematics, LoadPoint, Method, Remedy, SharedLaw, Stencils, System,
};
use igimp_linear::{LinearSolver, LinearSolverError, SolveReport, SolverKind};
use igimp_linear::{Pattern, TangentMatrix};
use igimp_material::{Elasticity, HenckyElastic, TangentKind};
use igimp_solver::{Body, NewtonSettings, NodalForces, StepFailure, Workspace, step};

/// Iterates to round-off.
const TIGHT: NewtonSettings = NewtonSettings {
    tolerance: 1e-12,
    max_iterations: 25,
    divergence: 1e4,
};

/// The weight at which a fair part of the loaded block yields, but does not collapse.
fn weight(law: &str) -> f64 {
    match law {
        "elastic" => 1.5,
        "von Mises" => 1.0,
        "Tresca" => 1.3,
        _ => 1.9,
    }
}

/// Newton's tail is quadratic: the last three residuals above round-off have an order of at least
/// 1.8 (it tends to 2 as the constant settles), and each of the last is at most C times the square
/// of the one before. A linear problem takes one correction.
#[test]
fn the_tail_is_quadratic() {
    const ROUND_OFF: f64 = 1e-13;
    const C: f64 = 50.0;
    for (name, law) in laws() {
        for (label, method) in methods() {
            let label = format!("{name}, {label}");
            let (mut body, conditions) = loaded(&law, weight(name));
            let (report, _) = solve(&mut body, &method, &conditions, &TIGHT).unwrap();
            let residuals = &report.residuals;
            assert_eq!(residuals.len(), report.iterations + 1, "{label}");
            if name == "elastic" && method.kinematics == Kinematics::SmallStrain {
                assert_eq!(report.iterations, 1, "{label}: {residuals:?}");
                assert!(residuals[1] < 1e-14, "{label}: {residuals:?}");
                continue;
            }
            if name != "elastic" {
                assert!(
                    report.plastic_share > 0.08,
                    "{label}: {}",
                    report.plastic_share
                );
            }
            let tail: Vec<f64> = residuals
                .iter()
                .copied()
                .filter(|&r| r > ROUND_OFF)
                .collect();
            let [.., before, last_but_one, last] = tail[..] else {
                panic!("{label}: {residuals:?}");
            };
            let order = (last / last_but_one).ln() / (last_but_one / before).ln();
            assert!(order > 1.8, "{label}: order {order}, {residuals:?}");
            assert!(
                last <= C * last_but_one * last_but_one,
                "{label}: {residuals:?}"
            );
            assert!(
                last_but_one <= C * before * before,
                "{label}: {residuals:?}"
            );
        }
    }
}

/// All linear solvers lead to the same equilibrium; those for symmetric matrices refuse others.
#[test]
fn the_solution_does_not_depend_on_the_linear_solver() {
    let method = Method::igimp_bbar();
    for (name, law) in laws() {
        let mut reference: Option<(Body<2>, Vec<[f64; 2]>)> = None;
        for kind in SolverKind::ALL {
            let label = format!("{name}, {kind:?}");
            let (mut body, conditions) = loaded(&law, weight(name));
            let mut workspace = Workspace::new(kind.build());
            let result = step(
                &mut body,
                &method,
                &conditions,
                (0.0, 1.0),
                &TIGHT,
                &mut workspace,
            );
            let for_symmetric = matches!(
                kind,
                SolverKind::FaerCholesky
                    | SolverKind::MultifrontalCholesky
                    | SolverKind::NalgebraCholesky
            );
            if for_symmetric && !law.has_symmetric_tangent() {
                let failure = *result.unwrap_err().failure;
                assert_eq!(
                    failure,
                    StepFailure::Linear(LinearSolverError::NotSymmetric)
                );
                continue;
            }
            let (report, forces) = result.unwrap();
            assert!(report.residuals[report.iterations] <= 1e-12, "{label}");
            let Some((first, u)) = &reference else {
                reference = Some((body, forces.u));
                continue;
            };
            let difference = distance(&forces.u, u) / largest(u);
            assert!(difference < 1e-8, "{label}: {difference:e}");
            for (a, b) in std::iter::zip(&body.particles.sigma, &first.particles.sigma) {
                for (a, b) in std::iter::zip(a.as_flattened(), b.as_flattened()) {
                    assert!((a - b).abs() < 1e-8 * STRENGTH, "{label}: {a} {b}");
                }
            }
        }
    }
}

/// The force on the upper side of the confined block.
fn force_on_top(forces: &NodalForces<2>) -> f64 {
    forces.reactions[4 * 4..5 * 4]
        .iter()
        .map(|force| force[1])
        .sum()
}

/// Uniaxial compression by 30 % in one step: τ_yy = M ln(1 − δ/H) and τ_xx = τ_zz = (K − 2G/3)
/// ln(1 − δ/H) in finite strain, the same with −δ/H in small strain.
#[test]
fn uniaxial_compression_agrees_with_the_closed_form() {
    let elasticity = elasticity();
    let modulus = elasticity.bulk() + 4.0 / 3.0 * elasticity.shear();
    let aside = elasticity.bulk() - 2.0 / 3.0 * elasticity.shear();
    for (label, method) in methods() {
        let (mut body, conditions) = confined(&elastic(), 1.2);
        let seeded = body.clone();
        let (report, forces) = solve(&mut body, &method, &conditions, &TIGHT).unwrap();
        assert_eq!(report.iterations, 1, "{label}: {:?}", report.residuals);
        let stretch = 0.7_f64;
        let (strain, volume_ratio) = match method.kinematics {
            Kinematics::FiniteStrain => (stretch.ln(), stretch),
            Kinematics::SmallStrain => (stretch - 1.0, 1.0),
        };
        let expected = [aside, modulus, aside].map(|modulus| modulus * strain / volume_ratio);
        for (particle, sigma) in body.particles.sigma.iter().enumerate() {
            for a in 0..3 {
                for b in 0..3 {
                    let expected = if a == b { expected[a] } else { 0.0 };
                    let difference = (sigma[a][b] - expected).abs();
                    assert!(difference < 1e-12 * modulus, "{label}: {difference:e}");
                }
            }
            let height = stretch * seeded.particles.x[particle][1];
            assert!(
                (body.particles.x[particle][1] - height).abs() < 1e-14,
                "{label}"
            );
            let half_length = body.particles.half_length[particle];
            assert!((half_length[1] - stretch * 0.25).abs() < 1e-15, "{label}");
        }
        let force = force_on_top(&forces);
        assert!(
            (force - 3.0 * expected[1]).abs() < 1e-12 * modulus,
            "{label}: {force}"
        );
    }
}

/// A confined von Mises block yields when 2G |ε| = q_y, at the stress M ε; beyond, pressure goes
/// on with K: τ_yy = K ε − 2/3 q_y.
#[test]
fn a_confined_block_yields_at_the_right_load() {
    let elasticity = elasticity();
    let yield_stress = 3.0_f64.sqrt() * STRENGTH;
    let yield_strain = yield_stress / (2.0 * elasticity.shear());
    let modulus = elasticity.bulk() + 4.0 / 3.0 * elasticity.shear();
    for (label, method) in methods() {
        for multiple in [0.999, 1.001, 4.0] {
            let strain = multiple * yield_strain;
            let (travel, volume_ratio) = match method.kinematics {
                Kinematics::FiniteStrain => (4.0 * (1.0 - (-strain).exp()), (-strain).exp()),
                Kinematics::SmallStrain => (4.0 * strain, 1.0),
            };
            let (mut body, conditions) = confined(&von_mises(), travel);
            let (report, forces) = solve(&mut body, &method, &conditions, &TIGHT).unwrap();
            let label = format!("{label}, {multiple}: {:?}", report.residuals);
            let (plastic, tau) = if multiple < 1.0 {
                (0.0, modulus * strain)
            } else {
                (1.0, elasticity.bulk() * strain + 2.0 / 3.0 * yield_stress)
            };
            assert!((report.plastic_share - plastic).abs() < 1e-15, "{label}");
            let force = -force_on_top(&forces);
            let expected = 3.0 * tau / volume_ratio;
            assert!(
                (force - expected).abs() < 1e-10 * expected,
                "{label}: {force} {expected}"
            );
        }
    }
}

/// Without weight or stress there is no residual at the start of a step, yet prescribed motion is
/// applied: the first correction carries it. A base that moves takes a free block along, rigidly
/// and without strain.
#[test]
fn motion_alone_is_applied() {
    let grid = unit_grid([9, 9]);
    let motion = [3.3, -2.2];
    for (name, law) in laws() {
        for (label, method) in methods() {
            let label = format!("{name}, {label}");
            let mut constraints = Constraints::free(&grid);
            for column in 0..=9 {
                for axis in 0..2 {
                    let node = grid.node_index([column, 4]);
                    constraints.prescribe(node, axis, motion[axis]).unwrap();
                }
            }
            let conditions = conditions(&grid, &constraints, &law, 0.0);
            let mut body = block(&grid, [1, 4], [4, 7]);
            let seeded = body.clone();
            let (report, forces) = solve(&mut body, &method, &conditions, &TIGHT)
                .unwrap_or_else(|error| panic!("{label}: {error:?}"));
            assert_eq!(report.iterations, 1, "{label}");
            assert!(report.residuals[0] == 0.0, "{label}");
            for column in 1..=4 {
                for row in 4..=7 {
                    let u = forces.u[grid.node_index([column, row])];
                    let miss = (u[0] - motion[0]).abs() + (u[1] - motion[1]).abs();
                    assert!(miss < 1e-13, "{label}: {miss:e}");
                }
            }
            for (particle, x) in body.particles.x.iter().enumerate() {
                for axis in 0..2 {
                    let moved = x[axis] - seeded.particles.x[particle][axis];
                    assert!((moved - motion[axis]).abs() < 1e-13, "{label}: {moved}");
                }
                let sigma = body.particles.sigma[particle];
                assert!(
                    sigma.as_flattened().iter().all(|s| s.abs() < 1e-11),
                    "{label}"
                );
            }
        }
    }
}

/// A step without any load or motion is accepted as it is, and leaves a body free of stress.
#[test]
fn a_body_at_rest_needs_no_correction() {
    let (mut body, conditions) = loaded(&von_mises(), 0.0);
    let (report, _) = solve(&mut body, &Method::default(), &conditions, &TIGHT).unwrap();
    assert_eq!((report.iterations, report.residuals), (0, vec![0.0]));
}

/// A load that is taken away leaves an elastic body free of stress: the step converges although
/// there is no force left to compare the residual with.
#[test]
fn unloading_to_nothing_converges() {
    for (label, method) in methods() {
        let (mut body, conditions) = confined(&elastic(), 0.4);
        solve(&mut body, &method, &conditions, &TIGHT).unwrap();
        let conditions = pressed(&elastic(), 3.6, -0.4);
        let (report, _) = solve(&mut body, &method, &conditions, &TIGHT)
            .unwrap_or_else(|error| panic!("{label}: {error:?}"));
        let left = body
            .particles
            .sigma
            .iter()
            .flatten()
            .flatten()
            .fold(0.0_f64, |left, sigma| left.max(sigma.abs()));
        let expected = match method.kinematics {
            Kinematics::FiniteStrain => 0.0,
            // +0.4 on 3.6 is more strain than −0.4 on 4: the price of small strain.
            Kinematics::SmallStrain => {
                let modulus = elasticity().bulk() + 4.0 / 3.0 * elasticity().shear();
                modulus * (0.4 / 3.6 - 0.1)
            }
        };
        assert!(
            (left - expected).abs() < 1e-11,
            "{label}: {left} {:?}",
            report.residuals
        );
    }
}

/// Reactions and external force are in balance, whatever the law and the method: gravity, loads on
/// points of the surface, a surface that ends a sliver beyond a face, dropped or tied.
#[test]
fn reactions_balance_the_external_force() {
    for (name, law) in laws() {
        for (label, method) in methods() {
            for (remedy, shift) in [
                (Remedy::Tie, 0.1),
                (Remedy::Tie, 0.002),
                (Remedy::Drop, 0.002),
            ] {
                let label = format!("{name}, {label}, {remedy:?}, {shift}");
                let mut method = method.clone();
                method.small_cuts.remedy = remedy;
                let grid = unit_grid([7, 5]);
                let mut body = shifted_block(&grid, [0, 0], [4, 3], [0.15, shift]);
                // The points of the linear basis reach no further than the cell of their centres.
                let surface = match method.basis.name() {
                    "gimp" => 3.0 + shift,
                    _ => 2.75,
                };
                body.load_points =
                    LoadPoint::along_edge([1.3, surface], [2.9, surface], [0.05, -0.3], 6, 0);
                let points = body.load_points.clone();
                let mut conditions = conditions(&grid, &standing(&grid), &law, 0.3);
                conditions.loads.factors = vec![1.0];
                let settings = NewtonSettings::default();
                let (_, forces) = solve(&mut body, &method, &conditions, &settings)
                    .unwrap_or_else(|error| panic!("{label}: {error:?}"));
                let weight: f64 = body.particles.mass.iter().sum();
                let applied = [0.05 * 1.6, -0.3 * 1.6 - 0.3 * weight];
                for axis in 0..2 {
                    let reaction: f64 = forces.reactions.iter().map(|force| force[axis]).sum();
                    let sum = reaction + applied[axis];
                    assert!(
                        sum.abs() < 1e-8 * weight,
                        "{label}: {reaction} {}",
                        applied[axis]
                    );
                }
                for (before, after) in std::iter::zip(&points, &body.load_points) {
                    assert!(after.x[1] < before.x[1], "{label}: the surface settles");
                }
            }
        }
    }
}

/// A solver whose work is watched: its analyses, and the matrices that it is asked to factorise.
struct Watched {
    inner: Box<dyn LinearSolver>,
    analyses: Arc<AtomicUsize>,
    matrices: Arc<Mutex<Vec<TangentMatrix>>>,
}

impl Watched {
    fn new(kind: SolverKind) -> Self {
        Self {
            inner: kind.build(),
            analyses: Arc::default(),
            matrices: Arc::default(),
        }
    }
}

impl LinearSolver for Watched {
    fn name(&self) -> &'static str {
        self.inner.name()
    }

    fn analyse(&mut self, pattern: &Arc<Pattern>) -> Result<(), LinearSolverError> {
        self.inner.analyse(pattern)
    }

    fn factor(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        self.matrices.lock().unwrap().push(matrix.clone());
        let result = self.inner.factor(matrix);
        self.analyses
            .store(self.inner.analyses(), Ordering::Relaxed);
        result
    }

    fn solve(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        self.inner.solve(matrix, rhs, solution)
    }

    fn analyses(&self) -> usize {
        self.inner.analyses()
    }
}

/// While particles keep to the nodes they touch, the pattern of the first step serves all others,
/// its symbolic work done once; when they reach new nodes it is done again.
#[test]
fn symbolic_work_is_reused_while_the_pattern_holds() {
    for kind in SolverKind::ALL {
        let solver = Watched::new(kind);
        let (analyses, matrices) = (Arc::clone(&solver.analyses), Arc::clone(&solver.matrices));
        let mut workspace = Workspace::new(Box::new(solver));
        let (mut body, light) = loaded(&elastic(), 0.1);
        let (_, heavy) = loaded(&elastic(), 4.0);
        let method = Method::igimp_bbar();
        let settings = NewtonSettings::default();
        let mut corrections = 0;
        for k in 1..=5 {
            let mut conditions = light.clone();
            conditions.loads.gravity[1] *= f64::from(k) / 5.0;
            let (from, to) = (f64::from(k - 1), f64::from(k));
            let result = step(
                &mut body,
                &method,
                &conditions,
                (from, to),
                &settings,
                &mut workspace,
            );
            corrections += result.unwrap().0.iterations;
        }
        assert!(corrections >= 10, "{kind:?}: {corrections}");
        let used = matrices.lock().unwrap().clone();
        assert_eq!(used.len(), corrections, "{kind:?}");
        let first = &used[0].pattern;
        assert!(
            used.iter()
                .all(|matrix| Arc::ptr_eq(&matrix.pattern, first))
        );
        assert_eq!(analyses.load(Ordering::Relaxed), 1, "{kind:?}");

        step(
            &mut body,
            &method,
            &heavy,
            (5.0, 6.0),
            &settings,
            &mut workspace,
        )
        .unwrap();
        assert_eq!(analyses.load(Ordering::Relaxed), 1, "{kind:?}");
        step(
            &mut body,
            &method,
            &light,
            (6.0, 7.0),
            &settings,
            &mut workspace,
        )
        .unwrap();
        assert_eq!(analyses.load(Ordering::Relaxed), 2, "{kind:?}");
    }
}

/// The first correction of a step uses the elastic tangent of the state at its start, also where a
/// law that lost strength returns that state to its yield surface; all others use the consistent
/// one.
#[test]
fn the_first_correction_uses_the_elastic_tangent() {
    let solver = Watched::new(SolverKind::Auto);
    let matrices = Arc::clone(&solver.matrices);
    let mut workspace = Workspace::new(Box::new(solver));
    let method = Method::igimp_bbar();
    let (mut body, full) = loaded(&von_mises(), 1.0);
    let (_, weaker) = loaded(&von_mises().reduced(1.1).unwrap(), 1.0);
    let settings = NewtonSettings::default();
    step(
        &mut body,
        &method,
        &full,
        (0.0, 1.0),
        &settings,
        &mut workspace,
    )
    .unwrap();
    let particles = body.particles.clone();
    matrices.lock().unwrap().clear();
    step(
        &mut body,
        &method,
        &weaker,
        (1.0, 2.0),
        &settings,
        &mut workspace,
    )
    .unwrap();

    let stencils = Stencils::build(&particles, &method, &weaker).unwrap();
    let system = System::new(&particles, &stencils, &weaker, &method).unwrap();
    let still = vec![[0.0; 2]; weaker.grid.node_count()];
    let tangent = |kind| system.linearise(&still, kind).unwrap().1.values;
    let used = matrices.lock().unwrap().clone();
    assert!(used.len() > 1);
    let off = |kind| {
        let pairs = std::iter::zip(&used[0].values, tangent(kind));
        pairs.fold(0.0, |off, (a, b)| f64::max(off, (a - b).abs()))
    };
    assert!(off(TangentKind::Elastic) < 1e-12 * YOUNG);
    assert!(off(TangentKind::Consistent) > 1e-2 * YOUNG);
}

/// A column that its own weight presses to half its height is loaded at once: whole corrections
/// turn its particles inside out, halved ones arrive. Its exact top is known (τ = E ln λ without
/// lateral strain: λ = W(s)/s with Lambert's function of the load s above, as in the exact solution
/// of the benchmark), and at ρ₀ g l₀ / E = 2 stands at (w + w²/2)/2 of the height, w = W(2).
#[test]
fn a_load_that_whole_corrections_overshoot_is_taken_in_one_step() {
    let cells = 16;
    let grid = unit_grid([1, cells]);
    let mut constraints = standing(&grid);
    constraints.fix_wall(&grid, 0, false, 0).unwrap();
    constraints.fix_wall(&grid, 0, true, 0).unwrap();
    let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(YOUNG, 0.0).unwrap()));
    let height = cells as f64;
    let conditions = conditions(&grid, &constraints, &law, 2.0 * YOUNG / height);
    for method in [Method::igimp(), Method::igimp_bbar()] {
        let mut body = block(&grid, [0, 0], [1, cells]);
        let (report, _) = solve(&mut body, &method, &conditions, &TIGHT).unwrap();
        let growth = report.residuals.windows(2).skip(1).map(|r| r[1] / r[0]);
        assert!(growth.fold(0.0, f64::max) < 20.0, "{:?}", report.residuals);
        // W(2) = 0.8526055020137254, at which w exp(w) = 2.
        let w: f64 = 0.852_605_502_013_725_4;
        assert!((w * w.exp() - 2.0).abs() < 1e-14);
        let top = 0.5 * height * (w + 0.5 * w * w);
        let particles = &body.particles;
        let highest = (0..particles.len())
            .map(|p| particles.x[p][1] + particles.half_length[p][1])
            .fold(0.0, f64::max);
        assert!((highest / top - 1.0).abs() < 0.01, "{highest} {top}");
    }
}

/// Dropped nodes take the force that the supports do not get: the report says how much. A tied node
/// takes nothing.
#[test]
fn the_report_tells_of_false_supports() {
    let grid = unit_grid([5, 5]);
    let law = elastic();
    let weight = conditions(&grid, &standing(&grid), &law, 0.5);
    for (remedy, takes) in [(Remedy::Drop, true), (Remedy::Tie, false)] {
        let mut method = Method::default();
        method.small_cuts.remedy = remedy;
        let mut body = shifted_block(&grid, [0, 0], [3, 3], [0.003, 0.003]);
        let (report, forces) = solve(&mut body, &method, &weight, &TIGHT).unwrap();
        let (mut held, mut unheld, mut upwards) = (0.0, 0.0, 0.0);
        for (node, reaction) in forces.reactions.iter().enumerate() {
            for axis in 0..2 {
                if weight.constraints.of(node, axis).is_some() {
                    held += reaction[axis].abs();
                    upwards += reaction[axis] * axis as f64;
                } else {
                    unheld += reaction[axis].abs();
                }
            }
        }
        let weight = 0.5 * 9.0;
        assert_eq!(unheld > 0.0, takes);
        assert!((report.false_support - unheld / f64::max(held, weight)).abs() < 1e-12);
        let missing = (weight - upwards).abs();
        assert!(missing <= unheld + 1e-9, "{missing} {unheld}");
        assert_eq!(missing > 1e-9, takes, "{missing}");
    }
}

/// A solver that answers four times the solution.
struct Fourfold(Box<dyn LinearSolver>);

impl LinearSolver for Fourfold {
    fn name(&self) -> &'static str {
        "fourfold"
    }

    fn analyse(&mut self, pattern: &Arc<Pattern>) -> Result<(), LinearSolverError> {
        self.0.analyse(pattern)
    }

    fn factor(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        self.0.factor(matrix)
    }

    fn solve(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        let report = self.0.solve(matrix, rhs, solution)?;
        for x in solution.iter_mut() {
            *x *= 4.0;
        }
        Ok(report)
    }

    fn analyses(&self) -> usize {
        self.0.analyses()
    }
}

// GOAL: a correction is halved again from where it was halved before.
// CASE: an elastic column in small strain whose base strains by more than a half, and corrections four times as long as they
// should be: the whole of one turns its base inside out, and half of it too.
// ORACLE: a quarter of it is the solution of a linear problem, which is found by one correction.
#[test]
fn two_halvings_leave_a_quarter_of_a_correction() {
    let cells = 16;
    let grid = unit_grid([1, cells]);
    let mut constraints = standing(&grid);
    constraints.fix_wall(&grid, 0, true, 0).unwrap();
    let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(YOUNG, 0.0).unwrap()));
    let conditions = conditions(&grid, &constraints, &law, 0.7 * YOUNG / cells as f64);
    let method = Method {
        kinematics: Kinematics::SmallStrain,
        ..Method::igimp()
    };
    let mut body = block(&grid, [0, 0], [1, cells]);
    let mut workspace = Workspace::new(Box::new(Fourfold(SolverKind::Auto.build())));
    let (from_to, settings) = ((0.0, 1.0), NewtonSettings::default());
    let done = step(
        &mut body,
        &method,
        &conditions,
        from_to,
        &settings,
        &mut workspace,
    );
    let (report, _) = done.unwrap();
    assert_eq!(report.iterations, 1, "{:?}", report.residuals);
    // From its middle height on the lowest particle carries what lies above: a strain of 0.7 less its own share.
    let strain = 1.0 - body.particles.def_grad[0][1][1];
    assert!((strain - 0.7).abs() < 0.05, "{strain}");
}
