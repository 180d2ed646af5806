//! GOAL: dry grains whose friction grows with the speed of shear flow down a rough incline as fast as Bagnold's profile says.
//! BODY: a layer of 2 × 2 particles per cell between sides that move together, its gravity tilted, on a base that holds it.
//! ORACLE: equilibrium of a layer in steady shear, integrated by hand (theory, eq. 129d), and its end below the angle of slow shear.

use std::sync::Arc;

use crate::body_support::block;
use crate::ground::{Motion, linear};
use igimp_assembly::{Constraints, SharedLaw, StepConditions, StepLoads, TiedWalls, TimeScheme};
use igimp_material::{Cone, DruckerPrager, Elasticity, InertialFriction};
use igimp_shape::{Axis, Grid};

/// Depth of the layer \[m\], gravity \[m/s²\], share of the volume that is grains \[-\].
const DEPTH: f64 = 0.02;
const GRAVITY: f64 = 9.81;
const SOLID: f64 = 0.6;
/// Glass beads of Jop et al. (2006): μ_s, μ_2, I_0, d \[m\]; masses are in units that give the layer a density of 1.
const SLOW: f64 = 0.38;
const FAST: f64 = 0.64;
const NUMBER: f64 = 0.279;
const DIAMETER: f64 = 0.5e-3;

fn beads() -> SharedLaw {
    let elasticity = Elasticity::new(10.0, 0.3).unwrap();
    // In the cone of plane strain μ is the sine of the angle.
    let law = DruckerPrager::new(elasticity, 0.0, SLOW.asin(), 0.0, Cone::PlaneStrain).unwrap();
    let rate = InertialFriction {
        friction_angle: FAST.asin(),
        inertial_number: NUMBER,
        grain_diameter: DIAMETER,
        grain_density: 1.0 / SOLID,
    };
    Arc::new(law.with_rate(rate).unwrap())
}

/// A layer of so many cells on an incline of a slope tan θ.
fn layer(cells: usize, slope: f64, duration: f64) -> Motion<2> {
    let cell = DEPTH / cells as f64;
    let grid = Grid::new([2, cells + 1].map(|count| Axis::uniform(0.0, cell, count).unwrap()));
    let body = block(&grid, [0, 0], [2, cells]);
    let mut constraints = Constraints::free(&grid);
    for axis in 0..2 {
        constraints.fix_wall(&grid, 1, false, axis).unwrap();
    }
    let (sine, cosine) = slope.atan().sin_cos();
    let loads = StepLoads::gravity([GRAVITY * sine, -GRAVITY * cosine]);
    let conditions = StepConditions::new(grid, constraints, loads, vec![beads()]).unwrap();
    let time = (duration, TimeScheme::BackwardEuler);
    let mut motion = Motion::new(body, conditions, Vec::new(), time);
    motion.method = linear();
    // Soft beside what is usual: the round-off of displacements times their stiffness is force.
    motion.walls.tied = Some(TiedWalls {
        axis: 0,
        stiffness: 2.0,
    });
    motion
}

/// Steps until no speed changes by more than a millionth of a scale a step.
fn steady(motion: &mut Motion<2>, scale: f64) {
    for _ in 0..800 {
        let before = motion.body.particles.velocity.clone();
        motion.step(|_| 0.0);
        let pairs = std::iter::zip(&before, &motion.body.particles.velocity);
        let change = pairs.fold(0.0, |m: f64, (a, b)| m.max((a[0] - b[0]).abs()));
        if change < 1e-6 * scale {
            return;
        }
    }
    panic!("the layer is still gaining speed");
}

/// Speed of Bagnold's profile at a height above the base \[m/s\].
fn bagnold(slope: f64, height: f64) -> f64 {
    let number = NUMBER * (slope - SLOW) / (FAST - slope);
    let cosine = slope.atan().cos();
    let depths = DEPTH.powf(1.5) - (DEPTH - height).powf(1.5);
    2.0 / 3.0 * number / DIAMETER * (SOLID * GRAVITY * cosine).sqrt() * depths
}

/// GOAL: the profile of steady flow, on two grids and two slopes; a slope below μ_s stands. BAND: 0.5 % of the speed at the surface on 8
/// cells, 0.2 % on 16.
#[test]
fn grains_flow_down_an_incline_as_bagnold_says() {
    for (cells, band) in [(8, 0.005), (16, 0.002)] {
        for slope in [0.45, 0.5] {
            let mut motion = layer(cells, slope, 0.1);
            let surface = bagnold(slope, DEPTH);
            steady(&mut motion, surface);
            let particles = &motion.body.particles;
            let mut off = [0.0_f64; 2];
            for (x, v) in std::iter::zip(&particles.x, &particles.velocity) {
                let error = (v[0] - bagnold(slope, x[1])) / surface;
                off[0] = off[0].max(error.abs());
                if x[1] > DEPTH * (1.0 - 0.5 / cells as f64) {
                    off[1] = error;
                }
            }
            println!("{cells} cells, slope {slope}: {surface:.4} m/s, off by {off:?}");
            assert!(off[0] < band, "{cells} cells, {slope}: {off:?}");
        }
    }
    let mut standing = layer(8, 0.36, 0.1);
    for _ in 0..20 {
        standing.step(|_| 0.0);
    }
    let fastest =
        (standing.body.particles.velocity.iter()).fold(0.0, |m: f64, v| m.max(v[0].abs()));
    assert!(fastest < 1e-6, "{fastest:e}");
}
