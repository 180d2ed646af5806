//! Small bodies, laws, supports and programs that the tests of steps and marches share.

#![allow(dead_code, reason = "each test target uses its part")]

use std::sync::Arc;

use igimp_assembly::{
    Constraints, Kinematics, Method, ParticleSeed, Particles, SharedLaw, StepConditions, StepLoads,
};
use igimp_material::{Elasticity, HenckyElastic, MohrCoulomb, Tresca, VonMises};
use igimp_shape::{Axis, Grid};
use igimp_solver::linear::SolverKind;
use igimp_solver::{Body, Workspace};

/// Random numbers (Vigna's splitmix64), the same in every run.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// Uniform in [-1, 1).
    pub(crate) fn symmetric(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Young's modulus of all laws \[stress\].
pub(crate) const YOUNG: f64 = 100.0;

/// Poisson's ratio of all laws.
pub(crate) const POISSON: f64 = 0.3;

/// Undrained strength and cohesion \[stress\].
pub(crate) const STRENGTH: f64 = 1.0;

/// The elastic part of all laws.
pub(crate) fn elasticity() -> Elasticity {
    Elasticity::new(YOUNG, POISSON).unwrap()
}

/// Elastic.
pub(crate) fn elastic() -> SharedLaw {
    Arc::new(HenckyElastic::new(elasticity()))
}

/// Von Mises.
pub(crate) fn von_mises() -> SharedLaw {
    Arc::new(VonMises::from_undrained_strength(elasticity(), STRENGTH).unwrap())
}

/// Every law, by name.
pub(crate) fn laws() -> Vec<(&'static str, SharedLaw)> {
    let mohr_coulomb = |friction: f64, dilation: f64| {
        let (friction, dilation) = (friction.to_radians(), dilation.to_radians());
        MohrCoulomb::new(elasticity(), STRENGTH, friction, dilation).unwrap()
    };
    vec![
        ("elastic", elastic()),
        ("von Mises", von_mises()),
        (
            "Tresca",
            Arc::new(Tresca::new(elasticity(), STRENGTH).unwrap()),
        ),
        ("Mohr-Coulomb", Arc::new(mohr_coulomb(20.0, 5.0))),
        (
            "Mohr-Coulomb, associated",
            Arc::new(mohr_coulomb(20.0, 20.0)),
        ),
    ]
}

/// The four variants of the method in both kinematics, by name.
pub(crate) fn methods() -> Vec<(String, Method)> {
    let variants = [
        Method::impm(),
        Method::impm_bbar(),
        Method::igimp(),
        Method::igimp_bbar(),
    ];
    let kinematics = [Kinematics::FiniteStrain, Kinematics::SmallStrain];
    variants
        .iter()
        .flat_map(|method| kinematics.map(|kinematics| (method, kinematics)))
        .map(|(method, kinematics)| {
            let method = Method {
                kinematics,
                ..method.clone()
            };
            (format!("{}, {kinematics:?}", method.label()), method)
        })
        .collect()
}

/// A grid of unit cells from the origin.
pub(crate) fn unit_grid(cells: [usize; 2]) -> Grid<2> {
    Grid::new(cells.map(|cells| Axis::uniform(0.0, 1.0, cells).unwrap()))
}

/// 2 × 2 particles of unit density in each cell between two cell places, `from` included and `to`
/// not.
pub(crate) fn block(grid: &Grid<2>, from: [usize; 2], to: [usize; 2]) -> Body<2> {
    shifted_block(grid, from, to, [0.0; 2])
}

/// As [`block`], the whole body moved by `shift` \[length\]: domains then reach into neighbouring
/// cells.
pub(crate) fn shifted_block(
    grid: &Grid<2>,
    from: [usize; 2],
    to: [usize; 2],
    shift: [f64; 2],
) -> Body<2> {
    let mut seeds = Vec::new();
    for row in from[1]..to[1] {
        for column in from[0]..to[0] {
            let lower = grid.node_position(grid.node_index([column, row]));
            let size = grid.cell_size([column, row]);
            for part in 0..4 {
                let place = [part % 2, part / 2];
                seeds.push(ParticleSeed {
                    x: std::array::from_fn(|axis| {
                        let middle = 0.25 + 0.5 * place[axis] as f64;
                        lower[axis] + size[axis] * middle + shift[axis]
                    }),
                    half_length: size.map(|size| 0.25 * size),
                    volume: 0.25 * size[0] * size[1],
                    density: 1.0,
                    law: 0,
                });
            }
        }
    }
    Body::new(Particles::new(&seeds).unwrap())
}

/// A roller at the lower end of axis 0, everything held at the lower end of axis 1.
pub(crate) fn standing(grid: &Grid<2>) -> Constraints<2> {
    let mut constraints = Constraints::free(grid);
    constraints.fix_wall(grid, 0, false, 0);
    constraints.fix_wall(grid, 1, false, 0);
    constraints.fix_wall(grid, 1, false, 1);
    constraints
}

/// Conditions with one law and gravity downwards.
pub(crate) fn conditions(
    grid: &Grid<2>,
    constraints: &Constraints<2>,
    law: &SharedLaw,
    gravity: f64,
) -> StepConditions<2> {
    StepConditions {
        grid: grid.clone(),
        constraints: constraints.clone(),
        loads: StepLoads {
            gravity: [0.0, -gravity],
            point_factor: 0.0,
        },
        laws: vec![Arc::clone(law)],
    }
}

/// A workspace around the default solver.
pub(crate) fn workspace() -> Workspace {
    Workspace::new(SolverKind::Auto.build())
}

/// The exact bits of a body, as text: shortest decimal numbers tell all floating-point values
/// apart, signed zeros included.
pub(crate) fn bits(body: &Body<2>) -> String {
    format!("{body:?}")
}

/// Largest difference of two lists of vectors.
pub(crate) fn distance(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    assert_eq!(a.len(), b.len());
    std::iter::zip(a.as_flattened(), b.as_flattened())
        .fold(0.0, |largest, (a, b)| f64::max(largest, (a - b).abs()))
}

/// Largest magnitude in a list of vectors.
pub(crate) fn largest(values: &[[f64; 2]]) -> f64 {
    values
        .as_flattened()
        .iter()
        .fold(0.0, |largest, value| f64::max(largest, value.abs()))
}
