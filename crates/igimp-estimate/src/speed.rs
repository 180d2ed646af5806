//! How fast this computer is, measured in a few hundredths of a second.
//!
//! A small block of soil is assembled and its matrix factorised several times on one thread; the
//! quickest time of each counts, so that other programs disturb little. Both are given relative to
//! the reference computer that the constants of [`time`](super::time) were fitted on.

use std::sync::Arc;
use std::time::{Duration, Instant};

use igimp_assembly::{
    Constraints, Method, ParticleSeed, Particles, SharedLaw, Stencils, StepConditions, StepLoads,
    System, Trial,
};
use igimp_linear::{LinearSolver as _, MultifrontalCholesky};
use igimp_material::{Elasticity, TangentKind, VonMises};
use igimp_shape::{Axis, Grid};

use crate::error::EstimateError;

/// Cells of the block along each axis.
const CELLS: usize = 24;
/// Times that each kernel runs.
const REPEATS: usize = 12;
/// Times of the kernels on the reference computer, an AMD EPYC of 2026: a pass over the particles,
/// a factorisation \[s\].
const REFERENCE: [f64; 2] = [1.1e-3, 3.5e-4];

/// Times on this computer over those on the reference computer: 2 is half as fast \[-\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speed {
    /// A pass over the particles.
    pub assembly: f64,
    /// A factorisation.
    pub factor: f64,
}

impl Speed {
    /// The reference computer itself.
    pub const REFERENCE: Self = Self {
        assembly: 1.0,
        factor: 1.0,
    };

    /// Measures this computer.
    ///
    /// # Errors
    /// [`EstimateError`] if the block cannot be made or its equations not be solved: never on a sound
    /// computer.
    pub fn measured() -> Result<Self, EstimateError> {
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        let [assembly, factor] = match alone {
            Ok(pool) => pool.install(kernels)?,
            Err(_) => kernels()?,
        };
        Ok(Self {
            assembly: assembly.as_secs_f64() / REFERENCE[0],
            factor: factor.as_secs_f64() / REFERENCE[1],
        })
    }
}

/// The quickest pass over the particles of the block, and the quickest factorisation.
fn kernels() -> Result<[Duration; 2], EstimateError> {
    let axis = Axis::uniform(0.0, 1.0, CELLS)?;
    let grid = Grid::new([axis.clone(), axis]);
    let seeds: Vec<ParticleSeed<2>> = (0..4 * CELLS * CELLS)
        .map(|k| ParticleSeed {
            x: [k % (2 * CELLS), k / (2 * CELLS)].map(|half| 0.5 * half as f64 + 0.25),
            half_length: [0.25; 2],
            volume: 0.25,
            density: 1.0,
            law: 0,
            centroid: [0.0; _],
        })
        .collect();
    let particles = Particles::new(&seeds)?;
    let mut constraints = Constraints::free(&grid);
    for axis in 0..2 {
        constraints.fix_wall(&grid, 1, false, axis)?;
    }
    let law = VonMises::from_undrained_strength(Elasticity::new(1e4, 0.3)?, 1.0)?;
    let conditions = StepConditions::new(
        grid,
        constraints,
        StepLoads::gravity([0.0, -1.0]),
        vec![Arc::new(law) as SharedLaw],
    )?;
    let method = Method::default();
    let stencils = Stencils::build(&particles, &method, &conditions)?;
    let system = System::new(&particles, &stencils, &conditions, &method)?;
    // A shear beyond yield, so that the laws have their work.
    let u: Vec<[f64; 2]> = (0..conditions.grid.node_count())
        .map(|node| [1e-3 * conditions.grid.node_position(node)[1], 0.0])
        .collect();
    let mut matrix = system.matrix_from(None);
    let mut trial = Trial::default();
    let mut pass = Duration::MAX;
    for _ in 0..REPEATS {
        let clock = Instant::now();
        system.linearise_into(&u, TangentKind::Consistent, &mut trial, &mut matrix)?;
        pass = pass.min(clock.elapsed());
    }
    system.linearise_into(&u, TangentKind::Elastic, &mut trial, &mut matrix)?;
    let mut solver = MultifrontalCholesky::default();
    let mut factor = Duration::MAX;
    for _ in 0..REPEATS {
        let clock = Instant::now();
        // A matrix that cannot be factorised has no time: the pass alone then tells the speed.
        if solver.factor(&matrix).is_err() {
            break;
        }
        factor = factor.min(clock.elapsed());
    }
    if factor == Duration::MAX {
        factor = pass.mul_f64(REFERENCE[1] / REFERENCE[0]);
    }
    Ok([pass, factor])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: the measure is a positive number; how large it is never decides a test.
    #[test]
    fn a_computer_has_a_speed() {
        let speed = Speed::measured().unwrap();
        println!("{speed:?}");
        assert!(speed.assembly > 0.0 && speed.assembly.is_finite());
        assert!(speed.factor > 0.0 && speed.factor.is_finite());
    }
}
