//! GOAL: walls behind which the ground goes on let waves out, ground that moves shakes what stands on it, and soil is damped as
//! it is told.
//! BODY: bars of two particles per cell, layers of 2 × 2 particles per cell.
//! ORACLE: wave equation in one dimension: harmonic motion of layers, pulses, energy.

use std::f64::consts::PI;
use std::sync::Arc;

use crate::body_support::{POISSON, YOUNG, block, elastic, unit_grid, workspace};
use igimp_assembly::{
    AbsorbingWall, Constraints, Geometry, GroundMotion, Kinematics, Method, ParticleSeed,
    Particles, Rayleigh, SharedLaw, StepConditions, StepLoads, TiedWalls, TimeScheme, TimeStep,
    WallNode, Walls,
};
use igimp_material::{Elasticity, HenckyElastic};
use igimp_shape::{Axis, Grid};
use igimp_solver::{Body, NewtonSettings, NodalForces, StepReport, step};

pub(crate) const TIGHT: NewtonSettings = NewtonSettings {
    tolerance: 1e-11,
    max_iterations: 50,
    divergence: 1e6,
};

/// Small strain about the places where particles are: the wave equation.
pub(crate) fn linear() -> Method {
    Method {
        geometry: Geometry::Given,
        kinematics: Kinematics::SmallStrain,
        ..Method::igimp()
    }
}

/// Speed of compression waves in laterally held bars \[length/time\]: unit density.
fn wave_speed() -> f64 {
    (YOUNG * (1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON))).sqrt()
}

/// A bar of two particles in each unit cell; the lowest `rock` cells have the second law, and four times the density.
fn bar(cells: usize, rock: usize) -> (Body<1>, StepConditions<1>) {
    let grid = Grid::new([Axis::uniform(0.0, 1.0, cells + 1).unwrap()]);
    let seeds: Vec<_> = (0..2 * cells)
        .map(|k| {
            let is_rock = k < 2 * rock;
            ParticleSeed {
                x: [0.25 + 0.5 * k as f64],
                half_length: [0.25],
                volume: 0.5,
                density: if is_rock { 4.0 } else { 1.0 },
                law: usize::from(is_rock),
                centroid: [0.0; _],
            }
        })
        .collect();
    let stiff: SharedLaw = Arc::new(HenckyElastic::new(
        Elasticity::new(4.0 * YOUNG, POISSON).unwrap(),
    ));
    let constraints = Constraints::free(&grid);
    let loads = StepLoads::gravity([0.0]);
    let laws = vec![elastic(), stiff];
    let conditions = StepConditions::new(grid, constraints, loads, laws).unwrap();
    (Body::new(Particles::new(&seeds).unwrap()), conditions)
}

/// A body that steps of equal time take further, with what stands at its walls.
pub(crate) struct Motion<const D: usize> {
    pub(crate) body: Body<D>,
    pub(crate) conditions: StepConditions<D>,
    pub(crate) walls: Walls<D>,
    pub(crate) method: Method,
    time: TimeStep,
    steps: usize,
}

impl<const D: usize> Motion<D> {
    pub(crate) fn new(
        body: Body<D>,
        conditions: StepConditions<D>,
        absorbing: Vec<AbsorbingWall<D>>,
        (duration, scheme): (f64, TimeScheme),
    ) -> Self {
        let time = TimeStep {
            duration,
            scheme,
            lumped: 0.0,
            is_first: true,
            must_resolve: false,
        };
        let walls = Walls {
            absorbing,
            ..Walls::default()
        };
        Self {
            body,
            conditions,
            walls,
            method: linear(),
            time,
            steps: 0,
        }
    }

    fn elapsed(&self) -> f64 {
        self.time.duration * self.steps as f64
    }

    /// One step on ground of this acceleration at a time along the first axis.
    pub(crate) fn step(&mut self, acceleration: impl Fn(f64) -> f64) -> StepReport {
        // The mean over a step, by Simpson's rule.
        let mean = |end: f64| {
            let start = end - self.time.duration;
            let mut all = [0.0; D];
            all[0] =
                (acceleration(start) + 4.0 * acceleration(0.5 * (start + end)) + acceleration(end))
                    / 6.0;
            all
        };
        let ground = GroundMotion {
            acceleration: mean(self.elapsed() + self.time.duration),
            earlier: mean(self.elapsed()),
        };
        let time = TimeStep {
            is_first: self.steps == 0,
            ..self.time
        };
        let conditions = self.conditions.clone().with_time(Some(time)).unwrap();
        let conditions = conditions.with_ground(Some(ground)).unwrap();
        let conditions = conditions.with_walls(Some(self.walls.clone())).unwrap();
        let (report, forces) = step(
            &mut self.body,
            &self.method,
            &conditions,
            (0.0, 1.0),
            &TIGHT,
            &mut workspace(),
        )
        .unwrap();
        self.remember(&forces);
        self.steps += 1;
        report
    }

    /// Adds the way of the nodes to what stands at them.
    fn remember(&mut self, forces: &NodalForces<D>) {
        let mut nodes = (*self.walls.nodes).clone();
        let known = nodes.len();
        for (node, u) in forces.u.iter().enumerate() {
            if node >= known {
                nodes.push(WallNode {
                    node,
                    force: [0.0; D],
                    displacement: [0.0; D],
                });
            }
            nodes[node].displacement = std::array::from_fn(|a| nodes[node].displacement[a] + u[a]);
        }
        self.walls.nodes = Arc::new(nodes);
    }
}

/// A lower wall with dashpots alone.
fn at_bottom<const D: usize>(spring: f64) -> AbsorbingWall<D> {
    AbsorbingWall {
        normal: D - 1,
        upper: false,
        spring: [spring; D],
    }
}

/// GOAL: a wall of dashpots lets a pulse out: less than a thousandth of it comes back from a matched base where a wave length
/// has fifty cells, and what comes back falls with the square of the cell.
/// CASE: pulses of three widths, half of each goes down, half comes down from the free surface.
/// ORACLE: a half-space reflects nothing; the root of the energy that is left is what came back. The wave that went is in the book.
#[test]
fn a_pulse_leaves_through_a_matched_base() {
    let mut found = Vec::new();
    for width in [2.0, 4.0, 8.0] {
        let (body, conditions) = bar(80, 0);
        let speed = |x: f64| 1e-3 * (-((x - 50.0) / width).powi(2)).exp();
        let velocities = body.particles.x.iter().map(|x| [speed(x[0])]).collect();
        let body = Body::new(body.particles.with_velocities(velocities).unwrap());
        let start: f64 = std::iter::zip(&body.particles.mass, &body.particles.velocity)
            .map(|(m, v)| 0.5 * m * v[0] * v[0])
            .sum();
        let duration = 0.25 / wave_speed();
        let walls = vec![at_bottom(0.0)];
        let mut motion = Motion::new(body, conditions, walls, (duration, TimeScheme::Newmark));
        let (mut gone, mut left) = (0.0, 0.0);
        for _ in 0..700 {
            let energy = motion.step(|_| 0.0).energy.unwrap();
            assert!(energy.imbalance().abs() < 1e-12 * start, "{energy:?}");
            assert!(energy.boundaries > -1e-12 * start, "{energy:?}");
            gone += energy.boundaries;
            left = energy.kinetic + energy.elastic;
        }
        assert!(
            (gone + left - start).abs() < 1e-4 * start,
            "{width} {gone} {left} {start}"
        );
        found.push((left / start).sqrt());
    }
    // Mean wave lengths of 13, 25 and 50 cells: what comes back falls with the square of the cell.
    assert!(found[2] < 1e-3, "{found:?}");
    assert!(
        found[0] / found[1] > 4.0 && found[1] / found[2] > 4.0,
        "{found:?}"
    );
}

/// GOAL: a body in equilibrium stays at rest when dashpots and springs take the place of its supports, to round-off.
/// ORACLE: equilibrium; the reaction is the weight of the bar.
#[test]
fn a_body_in_equilibrium_stays_at_rest_on_dashpots() {
    let (mut body, mut conditions) = bar(12, 0);
    conditions.loads = StepLoads::gravity([-0.1]);
    let mut held = conditions.clone();
    held.constraints.fix_wall(&held.grid, 0, false, 0).unwrap();
    let method = linear();
    let (_, forces) = step(
        &mut body,
        &method,
        &held,
        (0.0, 1.0),
        &TIGHT,
        &mut workspace(),
    )
    .unwrap();
    let settled = body.particles.x.len();
    let (mut force, sigma) = ([0.0], body.particles.sigma[settled - 1][0][0]);
    force[0] = forces.reactions[0][0];
    assert!(
        (force[0] - 1.2).abs() < 1e-9,
        "the weight of the bar: {force:?} {sigma}"
    );
    for scheme in [TimeScheme::BackwardEuler, TimeScheme::Newmark] {
        let mut motion = Motion::new(
            body.clone(),
            conditions.clone(),
            vec![at_bottom(1.0 / 12.0)],
            (0.5 / wave_speed(), scheme),
        );
        motion.walls.nodes = Arc::new(vec![WallNode {
            node: 0,
            force,
            displacement: [0.0],
        }]);
        for _ in 0..60 {
            motion.step(|_| 0.0);
        }
        let fastest =
            (motion.body.particles.velocity.iter()).fold(0.0, |m: f64, v| m.max(v[0].abs()));
        let moved = std::iter::zip(
            &motion.body.particles.displacement,
            &body.particles.displacement,
        )
        .fold(0.0, |m: f64, (a, b)| m.max((a[0] - b[0]).abs()));
        // The speed with which the bar would settle is ρ g L over the impedance.
        let scale = 1.2 / wave_speed();
        assert!(fastest < 1e-10 * scale, "{scheme:?} {fastest:e} of {scale}");
        assert!(moved < 1e-10, "{scheme:?} {moved:e}");
    }
}

/// Half the range of the surface displacement over that of the outcrop, between two numbers of steps; nothing holds a body on
/// dashpots at its place, so that it may stand beside the middle.
fn amplification<const D: usize>(
    motion: &mut Motion<D>,
    omega: f64,
    times: [usize; 2],
    top: usize,
) -> f64 {
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for k in 0..times[1] {
        motion.step(|t| -1e-3 * omega * omega * (omega * t).sin());
        if k >= times[0] {
            let ground = (omega * motion.elapsed()).sin();
            let total = motion.body.particles.displacement[top][0] / 1e-3 + ground;
            (least, most) = (least.min(total), most.max(total));
        }
    }
    0.5 * (most - least)
}

/// GOAL: the harmonic motion of a layer on a rigid base.
/// CASE: the standing wave of the exact solution is given at the start, by its velocities.
/// ORACLE: 1/|cos kH| off resonance, without damping, from the first moment on.
#[test]
fn a_layer_on_a_rigid_base_amplifies_as_a_standing_wave() {
    let height = 20.0;
    for kh in [0.63_f64, 2.64] {
        let (body, mut conditions) = bar(20, 0);
        conditions
            .constraints
            .fix_wall(&conditions.grid, 0, false, 0)
            .unwrap();
        let omega = kh * wave_speed() / height;
        let shape = |x: f64| (kh * (1.0 - x / height)).cos() / kh.cos() - 1.0;
        let velocities = (body.particles.x.iter())
            .map(|x| [1e-3 * omega * shape(x[0])])
            .collect();
        let body = Body::new(body.particles.with_velocities(velocities).unwrap());
        let top = body.particles.len() - 1;
        let period = 2.0 * PI / omega;
        let mut motion = Motion::new(
            body,
            conditions,
            Vec::new(),
            (period / 80.0, TimeScheme::Newmark),
        );
        let found = amplification(&mut motion, omega, [0, 320], top);
        let x = motion.body.particles.x[top][0];
        let expected = (shape(x) + 1.0).abs();
        assert!(
            (found / expected - 1.0).abs() < 0.02,
            "{kh}: {found} {expected}"
        );
    }
}

/// GOAL: the harmonic motion of a soft layer on rock with dashpots below: 1/√(cos² kH + α² sin² kH) of its outcrop, and 1/α at
/// resonance.
/// CASE: eight cells of rock of four times the density and stiffness below twenty of soil: α = ¼.
#[test]
fn a_layer_on_a_compliant_base_amplifies_by_its_impedance() {
    let (height, alpha) = (20.0, 0.25);
    for kh in [0.6, PI / 2.0, 2.2] {
        let (body, conditions) = bar(28, 8);
        let omega = kh * wave_speed() / height;
        let top = body.particles.len() - 1;
        let period = 2.0 * PI / omega;
        let mut motion = Motion::new(
            body,
            conditions,
            vec![at_bottom(0.0)],
            (period / 80.0, TimeScheme::Newmark),
        );
        let found = amplification(&mut motion, omega, [1200, 1280], top);
        let expected = 1.0 / f64::hypot(kh.cos(), alpha * kh.sin());
        assert!(
            (found / expected - 1.0).abs() < 0.02,
            "{kh}: {found} {expected}"
        );
    }
}

/// GOAL: springs beside dashpots send long waves back as their stiffness says (theory, eq. 71).
/// CASE: a layer on a half-space of itself, with springs of modulus over height.
/// ORACLE: the layer on the impedance ρ c + k/(i ω): 1/|cos kH + i sin kH/(1 − i c/(ω L))|; without springs it is 1.
#[test]
fn springs_send_long_waves_back() {
    let height = 20.0;
    for kh in [0.8_f64, 1.6] {
        let (body, conditions) = bar(20, 0);
        let omega = kh * wave_speed() / height;
        let top = body.particles.len() - 1;
        let period = 2.0 * PI / omega;
        let walls = vec![at_bottom(1.0 / height)];
        let times = (period / 80.0, TimeScheme::Newmark);
        let mut motion = Motion::new(body, conditions, walls, times);
        let found = amplification(&mut motion, omega, [1200, 1280], top);
        // sin kH i/(1 − i b) = sin kH (i − b)/(1 + b²), with b = c/(ω L).
        let b = 1.0 / kh;
        let share = kh.sin() / (1.0 + b * b);
        let expected = 1.0 / f64::hypot(kh.cos() - b * share, share);
        assert!(
            (found / expected - 1.0).abs() < 0.02,
            "{kh}: {found} {expected}"
        );
    }
}

/// GOAL: soil is damped as Rayleigh says: in proportion to stiffness, and to mass.
/// ORACLE: a layer of complex stiffness G (1 + i ω β) on a rigid base at its resonance, 1/√(cos² a + sinh² b) with
/// (a − i b) = k* H; with the complex density ρ (1 − i α/ω) by the same formula, its amplitude over its base by
/// |1/cos k*H − 1| as the base does not move against itself.
#[test]
fn a_damped_layer_amplifies_less() {
    let height = 20.0;
    let omega = PI / 2.0 * wave_speed() / height;
    let ratio = 0.05;
    for by_stiffness in [true, false] {
        let (body, mut conditions) = bar(20, 0);
        conditions
            .constraints
            .fix_wall(&conditions.grid, 0, false, 0)
            .unwrap();
        let damping = if by_stiffness {
            Rayleigh {
                mass: 0.0,
                stiffness: 2.0 * ratio / omega,
            }
        } else {
            Rayleigh {
                mass: 2.0 * ratio * omega,
                stiffness: 0.0,
            }
        };
        let conditions = conditions.with_damping(Some(damping)).unwrap();
        let top = body.particles.len() - 1;
        let period = 2.0 * PI / omega;
        let mut motion = Motion::new(
            body,
            conditions,
            Vec::new(),
            (period / 80.0, TimeScheme::Newmark),
        );
        let found = amplification(&mut motion, omega, [1600, 1680], top);
        // k* H = (π/2) (1 ± 2 i ξ)^(∓½): modulus and angle of 1 + 2 i ξ.
        let (modulus, angle) = (f64::hypot(1.0, 2.0 * ratio), (2.0 * ratio).atan());
        let size = PI / 2.0
            * if by_stiffness {
                modulus.powf(-0.5)
            } else {
                modulus.powf(0.5)
            };
        let (a, b) = (size * (0.5 * angle).cos(), size * (0.5 * angle).sin());
        let absolute = 1.0 / f64::hypot(a.cos(), b.sinh());
        // Mass damps motion against the base, not motion in space: u (1 − i α/ω) = u_g + ..., so that the relative motion is that of
        // the base without its imaginary part.
        let expected = if by_stiffness {
            absolute
        } else {
            let real = a.cos() * b.cosh();
            let imaginary = a.sin() * b.sinh();
            let squared = real * real + imaginary * imaginary;
            // 1/cos − 1, times ω²/(ω² (1 − 2 i ξ)), and the base again.
            let relative = [real / squared - 1.0, -imaginary / squared];
            let turn = 1.0 + 4.0 * ratio * ratio;
            let turned = [
                (relative[0] - 2.0 * ratio * relative[1]) / turn,
                (relative[1] + 2.0 * ratio * relative[0]) / turn,
            ];
            f64::hypot(turned[0] + 1.0, turned[1])
        };
        assert!(
            (found / expected - 1.0).abs() < 0.02,
            "{by_stiffness}: {found} {expected}"
        );
    }
}

/// GOAL: a level layer whose sides move together is a column: the same motion at every particle of a row.
/// CASE: 6 × 10 cells, shear by the motion of a rigid base; the standing wave of the exact solution.
/// ORACLE: 1/|cos kH|, within 1 %.
#[test]
fn a_layer_between_tied_sides_is_a_column() {
    let grid = unit_grid([6, 11]);
    let body = block(&grid, [0, 0], [6, 10]);
    let mut constraints = Constraints::free(&grid);
    for axis in 0..2 {
        constraints.fix_wall(&grid, 1, false, axis).unwrap();
    }
    let speed = (YOUNG / (2.0 * (1.0 + POISSON))).sqrt();
    let kh = 0.9;
    let omega = kh * speed / 10.0;
    let shape = |y: f64| (kh * (1.0 - y / 10.0)).cos() / kh.cos() - 1.0;
    let velocities = (body.particles.x.iter())
        .map(|x| [1e-3 * omega * shape(x[1]), 0.0])
        .collect();
    let body = Body::new(body.particles.with_velocities(velocities).unwrap());
    let loads = StepLoads::gravity([0.0; 2]);
    let conditions = StepConditions::new(grid, constraints, loads, vec![elastic()]).unwrap();
    let period = 2.0 * PI / omega;
    let mut motion = Motion::new(
        body,
        conditions,
        Vec::new(),
        (period / 60.0, TimeScheme::Newmark),
    );
    motion.walls.tied = Some(TiedWalls::across(0));
    let particles = &motion.body.particles;
    let highest = particles.x.iter().map(|x| x[1]).fold(0.0, f64::max);
    let row: Vec<usize> = (0..particles.len())
        .filter(|&p| particles.x[p][1] > highest - 0.1)
        .collect();
    let found = amplification(&mut motion, omega, [0, 120], row[5]);
    let expected = shape(highest) + 1.0;
    assert!((found / expected - 1.0).abs() < 0.01, "{found} {expected}");
    let ways: Vec<[f64; 2]> = row
        .iter()
        .map(|&p| motion.body.particles.displacement[p])
        .collect();
    let size = ways.iter().map(|u| u[0].abs()).fold(0.0, f64::max);
    for way in &ways {
        assert!(
            (way[0] - ways[5][0]).abs() < 0.01 * size.max(1e-4),
            "{ways:?}"
        );
    }
}
