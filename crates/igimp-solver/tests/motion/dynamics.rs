//! GOAL: steps that take time integrate motion as their scheme says, and their energy closes.
//! BODY: bars of two particles per cell; blocks of 2 × 2 particles per cell.
//! ORACLE: the solution of each scheme for one mode of vibration; free fall; a column that gravity is put on at once; sums
//! over particles.

use std::f64::consts::PI;

use crate::body_support::{YOUNG, block, elastic, laws, unit_grid, workspace};
use igimp_assembly::{
    Constraints, Drive, Geometry, Interface, Kinematics, Method, ParticleSeed, Particles, Remedy,
    RigidBody, RigidMotion, SharedLaw, StepConditions, StepEnergy, StepLoads, Surface, TimeScheme,
    TimeStep,
};
use igimp_shape::{Axis, Grid};
use igimp_solver::{Body, NewtonSettings, StepReport, step};

const TIGHT: NewtonSettings = NewtonSettings {
    tolerance: 1e-12,
    max_iterations: 50,
    divergence: 1e6,
};

const SCHEMES: [TimeScheme; 3] = [
    TimeScheme::BackwardEuler,
    TimeScheme::Newmark,
    TimeScheme::GeneralisedAlpha,
];

/// A step of consistent mass.
fn over(duration: f64, scheme: TimeScheme) -> TimeStep {
    TimeStep {
        duration,
        scheme,
        lumped: 0.0,
        is_first: false,
        must_resolve: false,
    }
}

/// Wave speed of laterally held bars \[length/time\]: unit density, ν = 0.3.
fn wave_speed() -> f64 {
    (YOUNG * 0.7 / (1.3 * 0.4)).sqrt()
}

/// A bar of two particles in each of `cells` unit cells, held at its lower end.
fn bar(cells: usize, gravity: f64) -> (Body<1>, StepConditions<1>) {
    let grid = Grid::new([Axis::uniform(0.0, 1.0, cells + 2).unwrap()]);
    let seeds: Vec<_> = (0..2 * cells)
        .map(|k| ParticleSeed {
            x: [0.25 + 0.5 * k as f64],
            half_length: [0.25],
            volume: 0.5,
            density: 1.0,
            law: 0,
            centroid: [0.0; _],
        })
        .collect();
    let mut constraints = Constraints::free(&grid);
    constraints.fix_wall(&grid, 0, false, 0).unwrap();
    let loads = StepLoads::gravity([-gravity]);
    let conditions = StepConditions::new(grid, constraints, loads, vec![elastic()]).unwrap();
    (Body::new(Particles::new(&seeds).unwrap()), conditions)
}

/// Marches by equal steps of time; what each reports.
fn run<const D: usize>(
    body: &mut Body<D>,
    method: &Method,
    conditions: &StepConditions<D>,
    time: TimeStep,
    steps: usize,
) -> Vec<StepReport> {
    run_to(&TIGHT, body, method, conditions, time, steps)
}

/// The same to a tolerance.
fn run_to<const D: usize>(
    settings: &NewtonSettings,
    body: &mut Body<D>,
    method: &Method,
    conditions: &StepConditions<D>,
    time: TimeStep,
    steps: usize,
) -> Vec<StepReport> {
    let mut workspace = workspace();
    (0..steps)
        .map(|k| {
            let is_first = k == 0
                && body
                    .particles
                    .acceleration
                    .as_flattened()
                    .iter()
                    .all(|a| *a == 0.0);
            let time = TimeStep { is_first, ..time };
            let conditions = conditions.clone().with_time(Some(time)).unwrap();
            let from_to = (0.0, 1.0);
            step(body, method, &conditions, from_to, settings, &mut workspace)
                .unwrap()
                .0
        })
        .collect()
}

fn moving(body: Body<2>, velocity: impl Fn(&[f64; 2]) -> [f64; 2]) -> Body<2> {
    let velocities = body.particles.x.iter().map(velocity).collect();
    Body::new(body.particles.with_velocities(velocities).unwrap())
}

/// The state of a bar in its lowest mode: kinetic and elastic energy, and the angle between displacement and velocity.
fn phase(body: &Body<1>, report: &StepReport) -> (f64, f64) {
    let energy = report.energy.unwrap();
    let displacement = energy
        .elastic
        .sqrt()
        .copysign(body.particles.sigma[0][0][0]);
    let velocity = energy
        .kinetic
        .sqrt()
        .copysign(body.particles.velocity[15][0]);
    (
        energy.kinetic + energy.elastic,
        displacement.atan2(velocity),
    )
}

/// GOAL: a mode of vibration loses amplitude and period as its scheme says, and by nothing else.
/// ORACLE: of a linear oscillator, energy 1/(1 + (ωΔt)²) and phase atan ωΔt a step by backward Euler; energy 1 and phase
/// 2 atan(ωΔt/2) by Newmark's method. The lowest mode is what many damped steps leave; its ω follows from the energy of one
/// step, all else from ω; that of the continuous bar is near.
#[test]
fn a_mode_of_a_bar_follows_its_scheme() {
    let method = Method {
        geometry: Geometry::Given,
        kinematics: Kinematics::SmallStrain,
        ..Method::igimp()
    };
    let (body, conditions) = bar(8, 0.0);
    let shape = |x: f64| (0.5 * PI * x / 8.0).sin();
    let velocities = (body.particles.x.iter())
        .map(|x| [20.0 * wave_speed() * shape(x[0])])
        .collect();
    let mut body = Body::new(body.particles.with_velocities(velocities).unwrap());
    let continuous = 0.5 * PI * wave_speed() / 8.0;
    let [damped, kept, _] = SCHEMES.map(|scheme| over(0.5 / continuous, scheme));
    let reports = run(&mut body, &method, &conditions, damped, 80);
    let (mut energy, mut angle) = phase(&body, &reports[79]);
    let mut omega = 0.0;
    for (time, steps) in [(damped, 10), (kept, 40), (damped, 10)] {
        for _ in 0..steps {
            let report = run(&mut body, &method, &conditions, time, 1);
            let (energy_after, angle_after) = phase(&body, &report[0]);
            let turned = (angle_after - angle).rem_euclid(2.0 * PI);
            let left = energy_after / energy;
            (energy, angle) = (energy_after, angle_after);
            if omega == 0.0 {
                omega = (1.0 / left - 1.0).sqrt();
            }
            let (expected, advance) = match time.scheme {
                TimeScheme::BackwardEuler => (1.0 / (1.0 + omega * omega), omega.atan()),
                _ => (1.0, 2.0 * (0.5 * omega).atan()),
            };
            assert!(
                (left - expected).abs() < 1e-10,
                "{time:?} {left} {expected}"
            );
            assert!(
                (turned - advance).abs() < 1e-10,
                "{time:?} {turned} {advance}"
            );
        }
    }
    assert!((omega / 0.5 - 1.0).abs() < 0.01, "{omega}");
}

/// GOAL: by Newmark's method a bar that is let go keeps its energy over a thousand steps, all of its modes together.
/// ORACLE: conservation, in the linear range.
#[test]
fn a_bar_keeps_its_energy_over_a_thousand_steps() {
    let method = Method {
        geometry: Geometry::Given,
        kinematics: Kinematics::SmallStrain,
        ..Method::igimp()
    };
    let (body, conditions) = bar(8, 0.0);
    let velocities = (0..16).map(|k| [f64::from((k * 7) % 5) - 2.0]).collect();
    let mut body = Body::new(body.particles.with_velocities(velocities).unwrap());
    let time = over(0.5 / wave_speed(), TimeScheme::Newmark);
    let reports = run(&mut body, &method, &conditions, time, 1000);
    let held = |report: &StepReport| {
        let energy = report.energy.unwrap();
        energy.kinetic + energy.elastic
    };
    // No work is left over for its book either: its last term closes the sum, and has nothing to close here.
    let left = reports
        .iter()
        .map(|report| report.energy.unwrap().integration.abs());
    assert!(left.sum::<f64>() < 1e-8 * held(&reports[0]));
    let drift = held(&reports[999]) / held(&reports[0]) - 1.0;
    assert!(drift.abs() < 1e-8, "{drift}");
}

/// GOAL: by the generalised-α method too a mode of a bar follows the scheme, and by nothing else.
/// ORACLE: the scheme written out for one oscillator: three stresses in a row obey its recurrence σ₂ = c₁ σ₁ + c₀ σ₀ when its third
/// solution has gone, and so do those of the bar.
#[test]
fn a_mode_of_a_bar_follows_the_generalised_alpha_method() {
    let method = Method {
        geometry: Geometry::Given,
        kinematics: Kinematics::SmallStrain,
        ..Method::igimp()
    };
    let (body, conditions) = bar(8, 0.0);
    let velocities = (body.particles.x.iter())
        .map(|x| [20.0 * wave_speed() * (0.5 * PI * x[0] / 8.0).sin()])
        .collect();
    let mut body = Body::new(body.particles.with_velocities(velocities).unwrap());
    let duration = 0.5 / (0.5 * PI * wave_speed() / 8.0);
    let damped = over(duration, TimeScheme::BackwardEuler);
    let reports = run(&mut body, &method, &conditions, damped, 80);
    let (before, _) = phase(&body, &reports[79]);
    let reports = run(&mut body, &method, &conditions, damped, 1);
    let omega = (before / phase(&body, &reports[0]).0 - 1.0).sqrt();
    body.rest();
    let time = over(duration, TimeScheme::GeneralisedAlpha);
    let stresses: Vec<f64> = (0..66)
        .map(|_| {
            run(&mut body, &method, &conditions, time, 1);
            body.particles.sigma[0][0][0]
        })
        .collect();
    let rho: f64 = 0.8;
    let [of_mass, of_force] = [(2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0)];
    let gamma = 0.5 - of_mass + of_force;
    let beta = 0.25 * (gamma + 0.5).powi(2);
    // In units of the step: ω² u is the force.
    let (mut u, mut v, mut a) = (1.0, 0.0, -omega * omega);
    let oscillator: Vec<f64> = (0..66)
        .map(|_| {
            let free = u + v + (0.5 - beta) * a;
            let stiffness = (1.0 - of_force) * omega * omega;
            let after = -(of_mass * a + of_force * omega * omega * u + stiffness * free)
                / (1.0 - of_mass + stiffness * beta);
            u = free + beta * after;
            v += (1.0 - gamma) * a + gamma * after;
            a = after;
            u
        })
        .collect();
    let recurrence = |x: &[f64]| {
        let (a, b) = ([x[1], x[2]], [x[0], x[1]]);
        let det = a[0] * b[1] - a[1] * b[0];
        [
            (x[2] * b[1] - x[3] * b[0]) / det,
            (a[0] * x[3] - a[1] * x[2]) / det,
        ]
    };
    for k in 50..62 {
        let (of_bar, expected) = (recurrence(&stresses[k..]), recurrence(&oscillator[k..]));
        for (found, expected) in of_bar.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-10, "{of_bar:?} {expected}");
        }
    }
}

/// GOAL: without support a body falls freely: its velocity is exact, its way too by the scheme of second order.
#[test]
fn a_block_falls_freely() {
    let grid = unit_grid([4, 12]);
    let block = block(&grid, [1, 8], [3, 11]);
    let start = block.particles.x.clone();
    let loads = StepLoads::gravity([0.0, -0.3]);
    let constraints = Constraints::free(&grid);
    let conditions = StepConditions::new(grid, constraints, loads, vec![elastic()]).unwrap();
    for scheme in SCHEMES {
        for lumped in [0.0, 0.01, 1.0] {
            let mut body = moving(block.clone(), |_| [0.05, 0.2]);
            let time = TimeStep {
                lumped,
                ..over(0.25, scheme)
            };
            let mut method = Method::default();
            if lumped > 0.0 && lumped < 1.0 {
                // As stages that take time have it, with nodes at corners that are small cuts.
                method.small_cuts.below = 0.3;
                method.small_cuts.remedy = Remedy::Extrapolate;
            }
            let reports = run(&mut body, &method, &conditions, time, 20);
            let fallen = match scheme {
                TimeScheme::BackwardEuler => 0.3 * 0.25 * 0.25 * 210.0,
                _ => 0.5 * 0.3 * 25.0,
            };
            for (particle, start) in start.iter().enumerate() {
                let (x, v) = (
                    body.particles.x[particle],
                    body.particles.velocity[particle],
                );
                assert!(
                    (v[0] - 0.05).abs() < 1e-11 && (v[1] - 0.2 + 1.5).abs() < 1e-11,
                    "{v:?}"
                );
                assert!((x[0] - start[0] - 0.25).abs() < 1e-10);
                assert!(
                    (x[1] - start[1] - 1.0 + fallen).abs() < 1e-9,
                    "{scheme:?} {x:?}"
                );
            }
            assert!(reports.iter().all(|report| report.iterations <= 2));
            body.rest();
            let mut still = body.particles.velocity.as_flattened().iter();
            assert!(still.all(|v| *v == 0.0));
        }
    }
}

/// GOAL: gravity that is put on at once stretches a column to twice what it does slowly, and back.
/// ORACLE: the tip swings between 0 and 2 u, u = ρ g L²/(2 M), with the period 4 L/c (d'Alembert).
#[test]
fn a_column_swings_between_nothing_and_twice_its_settlement() {
    let (mut body, conditions) = bar(16, 1e-3);
    let period = 4.0 * 16.0 / wave_speed();
    let steps = 400;
    let time = over(period / f64::from(steps), TimeScheme::Newmark);
    let method = Method::igimp();
    let still = 1e-3 * 16.0 * 16.0 / (2.0 * wave_speed().powi(2));
    let top = body.particles.len() - 1;
    let mut lowest = 0.0_f64;
    for _ in 0..steps / 2 {
        run(&mut body, &method, &conditions, time, 1);
        lowest = lowest.min(body.particles.displacement[top][0]);
    }
    assert!((lowest / still + 2.0).abs() < 0.02, "{}", lowest / still);
    run(&mut body, &method, &conditions, time, steps as usize / 2);
    let back = body.particles.displacement[top][0] / still;
    assert!(back.abs() < 0.02, "{back}");
}

/// GOAL: the energy of a step closes, whatever law, scheme, mass and kinematics, and soil takes plastic work only.
#[test]
fn energy_closes_and_plastic_work_is_taken() {
    let grid = unit_grid([8, 6]);
    let mut constraints = Constraints::free(&grid);
    constraints.fix_wall(&grid, 0, false, 0).unwrap();
    constraints.fix_wall(&grid, 1, false, 0).unwrap();
    constraints.fix_wall(&grid, 1, false, 1).unwrap();
    for (name, law) in laws() {
        for kinematics in [Kinematics::FiniteStrain, Kinematics::SmallStrain] {
            for scheme in SCHEMES {
                for lumped in [0.0, 0.01, 1.0] {
                    let mut method = Method {
                        kinematics,
                        ..Method::default()
                    };
                    method.small_cuts.below = 0.2;
                    let loads = StepLoads::gravity([0.0, -2.0]);
                    let laws: Vec<SharedLaw> = vec![law.clone()];
                    let conditions =
                        StepConditions::new(grid.clone(), constraints.clone(), loads, laws)
                            .unwrap();
                    let mut body = moving(block(&grid, [0, 0], [3, 5]), |x| [0.3 * x[1], 0.0]);
                    let time = TimeStep {
                        lumped,
                        ..over(0.05, scheme)
                    };
                    let reports = run(&mut body, &method, &conditions, time, 12);
                    let mut plastic = 0.0;
                    for report in &reports {
                        let energy = report.energy.unwrap();
                        let size = energy.kinetic + energy.elastic + energy.loads.abs();
                        assert!(energy.imbalance().abs() < 1e-12 * size, "{name} {energy:?}");
                        assert!(energy.plastic > -1e-12 * size, "{name} {energy:?}");
                        assert!(energy.unbalanced.abs() < 1e-9 * size, "{name} {energy:?}");
                        plastic += energy.plastic;
                    }
                    assert_eq!(plastic > 0.0, name != "elastic", "{name}");
                    let last: StepEnergy = reports[11].energy.unwrap();
                    let kinetic: f64 =
                        std::iter::zip(&body.particles.mass, &body.particles.velocity)
                            .map(|(m, v)| 0.5 * m * (v[0] * v[0] + v[1] * v[1]))
                            .sum();
                    assert!((last.kinetic - kinetic).abs() < 1e-12 * kinetic);
                }
            }
        }
    }
}

/// A disc of particles that turns about its middle, on a grid of cells of size `h`.
fn disc(h: f64) -> (Body<2>, StepConditions<2>) {
    let cells = (4.0 / h).round() as usize;
    let axis = || Axis::uniform(0.0, h, cells).unwrap();
    let grid = Grid::new([axis(), axis()]);
    let mut seeds = Vec::new();
    for k in 0..4 * cells * cells {
        let place = [k % (2 * cells), k / (2 * cells)];
        let x = place.map(|k| (0.5 * k as f64 + 0.25) * h);
        if (x[0] - 2.0).hypot(x[1] - 2.0) < 1.0 {
            seeds.push(ParticleSeed {
                x,
                half_length: [0.25 * h; 2],
                volume: 0.25 * h * h,
                density: 1.0,
                law: 0,
                centroid: [0.0; _],
            });
        }
    }
    let body = moving(Body::new(Particles::new(&seeds).unwrap()), |x| {
        [-(x[1] - 2.0), x[0] - 2.0]
    });
    let constraints = Constraints::free(&grid);
    let loads = StepLoads::gravity([0.0; 2]);
    let conditions = StepConditions::new(grid, constraints, loads, vec![elastic()]).unwrap();
    (body, conditions)
}

fn angular_momentum(body: &Body<2>) -> f64 {
    let pairs = std::iter::zip(&body.particles.x, &body.particles.velocity);
    pairs
        .zip(&body.particles.mass)
        .map(|((x, v), m)| m * ((x[0] - 2.0) * v[1] - (x[1] - 2.0) * v[0]))
        .sum()
}

/// GOAL: what a disc that turns once loses of its angular momentum goes down with the square of cell and step, by the generalised-α
/// method with the motion of small cuts extrapolated; with the first order by backward Euler; with a lumped mass nearly all is lost.
/// By Newmark's method angular momentum stays, but the disc gains energy: it is not stable where bodies turn.
/// ORACLE: conservation.
#[test]
fn a_disc_keeps_its_angular_momentum_to_second_order() {
    let mut method = Method::igimp();
    method.small_cuts.below = 0.2;
    method.small_cuts.remedy = Remedy::Extrapolate;
    let turn = |h: f64, lumped: f64, scheme: TimeScheme| {
        let (mut body, conditions) = disc(h);
        let before = angular_momentum(&body);
        let steps = (24.0 / h).round() as usize;
        let time = TimeStep {
            lumped,
            ..over(2.0 * PI / steps as f64, scheme)
        };
        let settings = NewtonSettings::default();
        let reports = run_to(&settings, &mut body, &method, &conditions, time, steps);
        let energy = |k: usize| reports[k].energy.unwrap();
        let gained = energy(steps - 1).kinetic / energy(0).kinetic - 1.0;
        (1.0 - angular_momentum(&body) / before, gained)
    };
    let alpha = TimeScheme::GeneralisedAlpha;
    let [(coarse, _), (fine, gained)] = [0.25, 0.125].map(|h| turn(h, 0.0, alpha));
    let order = (coarse / fine).log2();
    assert!(order >= 1.8 && fine < 5e-4, "{coarse} {fine}");
    assert!(gained < 0.0, "{gained}");
    // A share of lumped mass costs angular momentum at the rim, of first order: the page on limits states it.
    let [coarse, fine] = [0.25, 0.125].map(|h| turn(h, 0.01, alpha).0);
    assert!(
        (coarse - 0.038).abs() < 0.001 && (fine - 0.021).abs() < 0.001,
        "{coarse} {fine}"
    );
    let [coarse, fine] = [0.25, 0.125].map(|h| turn(h, 0.0, TimeScheme::BackwardEuler).0);
    let order = (coarse / fine).log2();
    assert!((0.5..1.2).contains(&order), "{coarse} {fine}");
    assert!(turn(0.125, 1.0, alpha).0 > 0.8);
    assert!(turn(0.125, 0.0, TimeScheme::Newmark).1 > 0.5);
}

/// GOAL: a rigid body with mass that nothing touches moves as its force and its moment say.
/// ORACLE: constant acceleration, which Newmark's method integrates exactly.
#[test]
fn a_rigid_body_with_mass_moves_freely() {
    let grid = unit_grid([12, 12]);
    let particles = block(&grid, [0, 0], [2, 2]).particles;
    let surface = Surface::circle(0.5, 0.1).unwrap();
    let mut rigid = RigidBody::new(surface, vec![Interface::smooth()], [8.0, 8.0]);
    rigid.motion.mass = 2.0;
    rigid.motion.moments[2][2] = 0.25;
    rigid.motion.velocity = [-0.5, 0.0];
    let mut body = Body::new(particles);
    body.rigid = vec![rigid];
    let free = RigidMotion {
        displacement: [Drive::Loaded(0.0), Drive::Loaded(-2.0)],
        rotation: [Drive::Loaded(0.05), Drive::Moved(0.0), Drive::Moved(0.0)],
        ..RigidMotion::held()
    };
    let loads = StepLoads::gravity([0.0; 2]);
    let mut constraints = Constraints::free(&grid);
    constraints.fix_wall(&grid, 0, false, 0).unwrap();
    constraints.fix_wall(&grid, 1, false, 1).unwrap();
    let conditions = StepConditions::new(grid, constraints, loads, vec![elastic()])
        .unwrap()
        .with_motions(vec![free])
        .unwrap();
    let time = over(0.125, TimeScheme::Newmark);
    let reports = run(&mut body, &Method::default(), &conditions, time, 16);
    let moved = &body.rigid[0];
    let [x, y] = moved.pose.origin;
    assert!(
        (x - 7.0).abs() < 1e-10 && (y - 6.0).abs() < 1e-10,
        "{x} {y}"
    );
    assert!((moved.motion.velocity[1] + 2.0).abs() < 1e-10);
    assert!((moved.pose.angle[0] - 0.4).abs() < 1e-10);
    assert!((moved.motion.spin[0] - 0.4).abs() < 1e-10);
    let energy = reports[15].energy.unwrap();
    let kinetic = 0.5 * 2.0 * (0.25 + 4.0) + 0.5 * 0.25 * 0.16;
    assert!((energy.kinetic - kinetic).abs() < 1e-9, "{energy:?}");
}

/// GOAL: a motion for which the grid finds none that comes closest goes on, by means around its nodes, and says so.
/// ORACLE: means lie between the velocities that they are of. Of the tip of a bar, ten thousand times as dense and a tenth of a cell
/// beyond the full ones, a share of 0.045 is lumped to the node behind with a weight of −0.05, and the mass is not positive definite;
/// with a light tip there is a closest motion.
#[test]
fn a_motion_without_a_closest_one_goes_on_by_means() {
    let mut method = Method::igimp();
    method.small_cuts.below = 0.2;
    method.small_cuts.remedy = Remedy::Extrapolate;
    let time = TimeStep {
        lumped: 0.045,
        ..over(1e-4, TimeScheme::GeneralisedAlpha)
    };
    for (density, is_by_means) in [(1.0, false), (1e4, true)] {
        let grid = Grid::new([Axis::uniform(0.0, 1.0, 8).unwrap()]);
        let part = |x: f64, half: f64, density: f64| ParticleSeed {
            x: [x],
            half_length: [half],
            volume: 2.0 * half,
            density,
            law: 0,
            centroid: [0.0; _],
        };
        let mut seeds: Vec<_> = (0..6)
            .map(|k| part(1.25 + 0.5 * f64::from(k), 0.25, 1.0))
            .collect();
        seeds.push(part(4.05, 0.05, density));
        let constraints = Constraints::free(&grid);
        let loads = StepLoads::gravity([0.0]);
        let conditions = StepConditions::new(grid, constraints, loads, vec![elastic()]).unwrap();
        let particles = Particles::new(&seeds).unwrap();
        let velocities: Vec<[f64; 1]> = (particles.x.iter())
            .map(|x| [0.3 + 0.02 * (3.0 * x[0]).sin()])
            .collect();
        let mut body = Body::new(particles.with_velocities(velocities).unwrap());
        let report = &run(&mut body, &method, &conditions, time, 1)[0];
        assert_eq!(report.moves_by_means, is_by_means, "density {density}");
        // The tip is carried by weights of −0.05 and 1.05.
        let mut velocities = body.particles.velocity.iter();
        let lie_between = velocities.all(|v| (0.278..=0.322).contains(&v[0]));
        assert!(lie_between || !is_by_means, "{velocities:?}");
    }
}
