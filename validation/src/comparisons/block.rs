//! Blocks of particles on grids that no case file states: one that is turned rigidly, and one whose
//! sides reach any distance into the next cells.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::{Duration, Instant};

use igimp_assembly::{
    AssemblyError, Constraints, Method, ParticleSeed, Particles, SharedLaw, Stencils,
    StepConditions, StepLoads, System,
};
use igimp_cases::CaseError;
use igimp_linear::SolverKind;
use igimp_material::{Elasticity, HenckyElastic, TangentKind};
use igimp_shape::{Axis, Grid};
use igimp_solver::{Accepted, Body, MarchReport, MarchSettings, Workspace, march};
use nalgebra::DMatrix;

/// Young's modulus over the weight of a unit volume \[length\].
const YOUNG: f64 = 1e4;
/// Poisson's ratio \[-\].
pub(super) const POISSON: f64 = 0.3;

fn law(young: f64) -> Result<SharedLaw, CaseError> {
    Ok(Arc::new(HenckyElastic::new(Elasticity::new(
        young, POISSON,
    )?)))
}

/// `count` × `count` particles that fill the square from `lower` on.
fn square(lower: [f64; 2], side: f64, count: usize) -> Vec<ParticleSeed<2>> {
    let size = side / count as f64;
    (0..count * count)
        .map(|k| ParticleSeed {
            x: [
                lower[0] + size * ((k % count) as f64 + 0.5),
                lower[1] + size * ((k / count) as f64 + 0.5),
            ],
            half_length: [0.5 * size; 2],
            volume: size * size,
            density: 1.0,
            law: 0,
            centroid: [0.0; _],
        })
        .collect()
}

/// A march of a body with the default solver.
fn marched(
    body: &mut Body<2>,
    method: &Method,
    steps: usize,
    load_path: impl Fn(f64, f64) -> Result<StepConditions<2>, AssemblyError>,
    mut observer: impl FnMut(&Accepted<'_, 2>),
) -> (MarchReport, Duration) {
    let clock = Instant::now();
    let mut workspace = Workspace::new(SolverKind::Auto.build());
    let mut watch = |accepted: &Accepted<'_, 2>| {
        observer(accepted);
        ControlFlow::Continue(())
    };
    let settings = MarchSettings::steps(steps);
    let report = march(
        body,
        method,
        &load_path,
        &settings,
        &mut workspace,
        &mut watch,
    );
    (report, clock.elapsed())
}

/// A free elastic block that was turned rigidly.
pub(super) struct Turned {
    /// Largest component of stress over Young's modulus; exact: zero \[-\].
    pub(super) stress: f64,
    /// Area of the particle domains over that of the block; exact: one \[-\].
    pub(super) area: f64,
    /// Its steps.
    pub(super) report: MarchReport,
    /// Wall-clock time.
    pub(super) elapsed: Duration,
}

/// Turns a block of four by four cells by an angle \[rad\] in equal steps: every node of the grid is
/// moved rigidly, but one, which has to find its place.
pub(super) fn turn(method: &Method, angle: f64, steps: usize) -> Result<Turned, CaseError> {
    let centre = [5.0; 2];
    let grid = Grid::new([Axis::uniform(0.0, 1.0, 10)?, Axis::uniform(0.0, 1.0, 10)?]);
    let laws = vec![law(YOUNG)?];
    let mut body = Body::new(Particles::new(&square([3.0; 2], 4.0, 8))?);
    let free = grid.node_index([5, 5]);
    let load_path = |from: f64, to: f64| {
        let (sin, cos) = (angle * (to - from)).sin_cos();
        let mut constraints = Constraints::free(&grid);
        for node in (0..grid.node_count()).filter(|&node| node != free) {
            let x = grid.node_position(node);
            let r = [x[0] - centre[0], x[1] - centre[1]];
            let u = [
                (cos - 1.0) * r[0] - sin * r[1],
                sin * r[0] + (cos - 1.0) * r[1],
            ];
            constraints.prescribe(node, 0, u[0])?;
            constraints.prescribe(node, 1, u[1])?;
        }
        StepConditions::new(
            grid.clone(),
            constraints,
            StepLoads::gravity([0.0; 2]),
            laws.clone(),
        )
    };
    let (report, elapsed) = marched(&mut body, method, steps, load_path, |_| {});
    let particles = &body.particles;
    let stress = particles.sigma.iter().flatten().flatten();
    let domains = particles.half_length.iter().map(|l| 4.0 * l[0] * l[1]);
    Ok(Turned {
        stress: stress.fold(0.0, |most: f64, s| most.max(s.abs())) / YOUNG,
        area: domains.sum::<f64>() / 16.0,
        report,
        elapsed,
    })
}

/// The stress over Young's modulus that a rotation by `angle` in equal steps leaves in small strain:
/// each step strains the plane by cos(α/n) − 1 in all directions \[-\].
pub(super) fn small_strain_turned(angle: f64, steps: usize) -> f64 {
    let strain = 1.0 - (angle / steps as f64).cos();
    steps as f64 * strain / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON))
}

/// A quarter turn \[rad\].
pub(super) const QUARTER: f64 = 0.5 * PI;

/// The filling of the cells beside the block.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Beside {
    /// Nothing.
    Air,
    /// Weightless soil of a thousandth of the stiffness.
    SoftGround,
}

/// A block that settled under its own weight on a smooth base.
pub(super) struct Settled {
    /// Mean settlement over the exact one; not a number when a step failed \[-\].
    pub(super) settlement: f64,
    /// Condition number of the first tangent; round-off where it is beyond 1e10 or so \[-\].
    pub(super) condition: f64,
    /// Largest displacement of a node in the first step over that of a particle \[-\].
    pub(super) node_over_particle: f64,
}

/// Lets a block of 8 by 8 particles and 4 + offset cells settle under its own weight, on rollers on the
/// left and below. Its other sides reach by the offset into the next cells.
pub(super) fn settle(method: &Method, offset: f64, beside: Beside) -> Result<Settled, CaseError> {
    let side = 4.0 + offset;
    let grid = Grid::new([Axis::uniform(0.0, 1.0, 7)?, Axis::uniform(0.0, 1.0, 7)?]);
    let mut seeds = square([0.0; 2], side, 8);
    if beside == Beside::SoftGround {
        seeds.extend(ground_beside(side));
    }
    let laws = vec![law(YOUNG)?, law(1e-3 * YOUNG)?];
    let mut body = Body::new(Particles::new(&seeds)?);
    let load_path = |_: f64, to: f64| {
        let mut constraints = Constraints::free(&grid);
        constraints.fix_wall(&grid, 0, false, 0)?;
        constraints.fix_wall(&grid, 1, false, 1)?;
        StepConditions::new(
            grid.clone(),
            constraints,
            StepLoads::gravity([0.0, -to]),
            laws.clone(),
        )
    };
    let condition = condition(&body, method, &load_path(0.0, 1.0)?)?;
    let mut ratio = f64::NAN;
    let mut first = true;
    let (report, _) = marched(&mut body, method, 5, load_path, |accepted| {
        if std::mem::take(&mut first) {
            let nodes = largest(&accepted.forces.u);
            ratio = nodes / largest(&accepted.body.particles.displacement[..64]);
        }
    });
    let mean = body.particles.displacement[..64]
        .iter()
        .map(|u| -u[1])
        .sum::<f64>()
        / 64.0;
    // Mean over the height of γ/E' (H y − y²/2), E' = E/(1 − ν²).
    let exact = side * side * (1.0 - POISSON * POISSON) / (3.0 * YOUNG);
    let complete = report.reached() >= 1.0;
    Ok(Settled {
        settlement: if complete { mean / exact } else { f64::NAN },
        condition,
        node_over_particle: ratio,
    })
}

/// A stiff block whose base is let down by a quarter of a cell in five steps, with its own weight, its
/// upper and right sides reaching by an offset into the next cells.
///
/// Returns the force on its base over its weight, of which equilibrium asks that it is one, and the
/// steps. The force is not a number when a step failed.
pub(super) fn let_down(
    method: &Method,
    offset: f64,
) -> Result<(f64, MarchReport, Duration), CaseError> {
    let side = 4.0 + offset;
    let grid = Grid::new([Axis::uniform(0.0, 1.0, 7)?, Axis::uniform(0.0, 1.0, 7)?]);
    let laws = vec![law(YOUNG)?];
    let mut body = Body::new(Particles::new(&square([0.0, 1.0], side, 8))?);
    let base = |node: usize| grid.node_place(node)[1] <= 1;
    let load_path = |from: f64, to: f64| {
        let mut constraints = Constraints::free(&grid);
        constraints.fix_wall(&grid, 0, false, 0)?;
        for node in (0..grid.node_count()).filter(|&node| base(node)) {
            constraints.prescribe(node, 1, 0.25 * (from - to))?;
        }
        StepConditions::new(
            grid.clone(),
            constraints,
            StepLoads::gravity([0.0, -1.0]),
            laws.clone(),
        )
    };
    let mut force = f64::NAN;
    let (report, elapsed) = marched(&mut body, method, 5, load_path, |accepted| {
        let reactions = accepted.forces.reactions.iter().enumerate();
        force = reactions
            .filter(|(node, _)| base(*node))
            .map(|(_, reaction)| reaction[1])
            .sum();
    });
    let complete = report.reached() >= 1.0;
    let share = if complete {
        force / (side * side)
    } else {
        f64::NAN
    };
    Ok((share, report, elapsed))
}

/// Weightless particles that fill the grid's six by six lower cells outside a square.
fn ground_beside(side: f64) -> Vec<ParticleSeed<2>> {
    let mut seeds = Vec::new();
    let rest = 6.0 - side;
    let blocks = [
        ([side, 0.0], [rest, side]),
        ([0.0, side], [side, rest]),
        ([side, side], [rest, rest]),
    ];
    for (lower, size) in blocks {
        let counts = size.map(|length: f64| (2.0 * length).ceil());
        let part = [size[0] / counts[0], size[1] / counts[1]];
        for column in 0..counts[0] as usize {
            for row in 0..counts[1] as usize {
                seeds.push(ParticleSeed {
                    x: [
                        lower[0] + part[0] * (column as f64 + 0.5),
                        lower[1] + part[1] * (row as f64 + 0.5),
                    ],
                    half_length: part.map(|length| 0.5 * length),
                    volume: part[0] * part[1],
                    density: 1e-12,
                    law: 1,
                    centroid: [0.0; _],
                });
            }
        }
    }
    seeds
}

/// The condition number of the tangent at the start of a step, by singular values.
fn condition(
    body: &Body<2>,
    method: &Method,
    conditions: &StepConditions<2>,
) -> Result<f64, CaseError> {
    let stencils = Stencils::build(&body.particles, method, conditions)?;
    let system = System::new(&body.particles, &stencils, conditions, method)?;
    let still = vec![[0.0; 2]; conditions.grid.node_count()];
    let (_, matrix) = system.linearise(&still, TangentKind::Elastic)?;
    let n = matrix.pattern.unknowns();
    let mut dense = DMatrix::zeros(n, n);
    for (row, column, &value) in matrix.to_csc().triplet_iter() {
        dense[(row, column)] = value;
    }
    let singular = dense.singular_values();
    Ok(singular.max() / singular.min())
}

fn largest(displacements: &[[f64; 2]]) -> f64 {
    displacements
        .iter()
        .fold(0.0, |most, u| f64::max(most, u[0].hypot(u[1])))
}
