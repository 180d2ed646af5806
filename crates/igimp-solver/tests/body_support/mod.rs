//! Small bodies, laws, supports and programs that the tests of steps and marches share.

#![allow(dead_code, reason = "each test target uses its part")]

use std::sync::{Arc, LazyLock};

use igimp_assembly::{
    Constraints, Kinematics, Method, ParticleSeed, Particles, SharedLaw, StepConditions, StepLoads,
};
use igimp_linear::SolverKind;
use igimp_material::{
    ConstitutiveModel, Elasticity, HenckyElastic, History, MaterialError, MohrCoulomb,
    PointContext, Principal, ReturnMap, Strength, Tresca, VonMises,
};
use igimp_shape::{Axis, Grid};
use igimp_solver::{Body, NewtonSettings, NodalForces, StepError, StepReport, Workspace, step};

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
                        let middle = 0.25 + 0.5 * f64::from(place[axis]);
                        lower[axis] + size[axis] * middle + shift[axis]
                    }),
                    half_length: size.map(|size| 0.25 * size),
                    volume: 0.25 * size[0] * size[1],
                    density: 1.0,
                    law: 0,
                    centroid: [0.0; _],
                });
            }
        }
    }
    Body::new(Particles::new(&seeds).unwrap())
}

/// A roller at the lower end of axis 0, everything held at the lower end of axis 1.
pub(crate) fn standing(grid: &Grid<2>) -> Constraints<2> {
    let mut constraints = Constraints::free(grid);
    constraints.fix_wall(grid, 0, false, 0).unwrap();
    constraints.fix_wall(grid, 1, false, 0).unwrap();
    constraints.fix_wall(grid, 1, false, 1).unwrap();
    constraints
}

/// Conditions with one law and gravity downwards.
pub(crate) fn conditions(
    grid: &Grid<2>,
    constraints: &Constraints<2>,
    law: &SharedLaw,
    gravity: f64,
) -> StepConditions<2> {
    StepConditions::new(
        grid.clone(),
        constraints.clone(),
        StepLoads {
            gravity: [0.0, -gravity],
            factors: Vec::new(),
            drag: 0.0,
        },
        vec![Arc::clone(law)],
    )
    .unwrap()
}

/// A block that stands off the lines of the grid, under a weight that makes part of it yield.
pub(crate) fn loaded(law: &SharedLaw, gravity: f64) -> (Body<2>, StepConditions<2>) {
    let grid = unit_grid([7, 5]);
    let body = shifted_block(&grid, [0, 0], [4, 3], [0.15, 0.1]);
    let conditions = conditions(&grid, &standing(&grid), law, gravity);
    (body, conditions)
}

/// A block of 3 × 4 unit cells that fills its walls, of the given law.
pub(crate) fn confined(law: &SharedLaw, travel: f64) -> (Body<2>, StepConditions<2>) {
    let body = block(&unit_grid([3, 5]), [0, 0], [3, 4]);
    (body, pressed(law, 4.0, travel))
}

/// Conditions that move the upper side of the confined block down by `travel`, from `height` on.
/// The grid follows the block: four rows of cells below its upper side, and room above.
pub(crate) fn pressed(law: &SharedLaw, height: f64, travel: f64) -> StepConditions<2> {
    let grid = Grid::new([
        Axis::uniform(0.0, 1.0, 3).unwrap(),
        Axis::uniform(0.0, 0.25 * height, 5).unwrap(),
    ]);
    let mut constraints = Constraints::free(&grid);
    constraints.fix_wall(&grid, 0, false, 0).unwrap();
    constraints.fix_wall(&grid, 0, true, 0).unwrap();
    constraints.fix_wall(&grid, 1, false, 1).unwrap();
    for column in 0..=3 {
        let node = grid.node_index([column, 4]);
        constraints.prescribe(node, 1, -travel).unwrap();
    }
    conditions(&grid, &constraints, law, 0.0)
}

/// A workspace around the default solver.
pub(crate) fn workspace<const D: usize>() -> Workspace<D> {
    Workspace::new(SolverKind::Auto.build())
}

/// One step from load factor 0 to 1 with the default solver.
pub(crate) fn solve(
    body: &mut Body<2>,
    method: &Method,
    conditions: &StepConditions<2>,
    settings: &NewtonSettings,
) -> Result<(StepReport, NodalForces<2>), StepError> {
    step(
        body,
        method,
        conditions,
        (0.0, 1.0),
        settings,
        &mut workspace(),
    )
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

/// An elastic law whose answer is not a number where a principal strain is larger than `above` in
/// magnitude: its stress, or its tangent alone.
#[derive(Debug)]
pub(crate) struct Poisoned {
    pub(crate) above: f64,
    pub(crate) tangent_alone: bool,
}

impl ConstitutiveModel for Poisoned {
    fn name(&self) -> &'static str {
        "poisoned"
    }

    fn stiffness_bound(&self) -> &Elasticity {
        &ELASTICITY
    }

    fn return_map(
        &self,
        eps_e_trial: &Principal,
        history: &History,
        context: &PointContext,
    ) -> Result<ReturnMap, MaterialError> {
        let mut answer =
            HenckyElastic::new(elasticity()).return_map(eps_e_trial, history, context)?;
        if eps_e_trial.iter().any(|strain| strain.abs() > self.above) {
            answer.tangent[1][1] = f64::NAN;
            if !self.tangent_alone {
                answer.tau[1] = f64::NAN;
            }
        }
        Ok(answer)
    }

    fn has_symmetric_tangent(&self) -> bool {
        true
    }
}

impl Strength for Poisoned {
    fn yield_function(&self, _tau: &Principal, _history: &History) -> f64 {
        f64::NEG_INFINITY
    }

    fn stress_scale(&self, _tau: &Principal) -> f64 {
        YOUNG
    }

    fn utilisation(&self, _tau: &Principal, _history: &History) -> f64 {
        0.0
    }

    fn reduced(&self, _srf: f64) -> Result<Arc<dyn ConstitutiveModel>, MaterialError> {
        Ok(Arc::new(Self { ..*self }))
    }
}

/// The elastic part, for those who lend it.
static ELASTICITY: LazyLock<Elasticity> = LazyLock::new(elasticity);
