//! Bodies, laws and random numbers that the tests share.
#![allow(dead_code, missing_docs, unreachable_pub)]

use std::sync::Arc;

use igimp_assembly::{
    Constraints, Kinematics, Method, ParticleSeed, ParticleTrial, Particles, SharedLaw, Stencils,
    StepConditions, StepLoads, Trial,
};
use igimp_material::{
    Curve, Decay, Elasticity, FrictionalCurves, HenckyElastic, HoekBrown, HoekBrownParameters,
    MohrCoulomb, Softening, Tresca, VonMises,
};
use igimp_shape::{Axis, Grid};

/// SplitMix64: a fixed stream of numbers.
pub struct Random(pub u64);

impl Random {
    /// Uniform in (-1, 1).
    pub fn symmetric(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// A grid with unequal cells, `cells` along each axis.
pub fn grid<const D: usize>(cells: usize) -> Grid<D> {
    Grid::new(std::array::from_fn(|axis| {
        let stretch = 0.02 * (axis + 1) as f64;
        let nodes = (0..=cells)
            .map(|k| k as f64 * (1.0 + stretch * k as f64))
            .collect();
        Axis::from_nodes(nodes).unwrap()
    }))
}

/// Two particles per direction in every cell but the outer ones, moved about at random.
pub fn particles<const D: usize>(grid: &Grid<D>, jitter: f64, random: &mut Random) -> Particles<D> {
    let mut seeds = Vec::new();
    for cell in 0..grid.cell_count() {
        let place = grid.cell_place(cell);
        if (0..D).any(|axis| place[axis] == 0 || place[axis] + 1 == grid.axes[axis].cell_count()) {
            continue;
        }
        let size = grid.cell_size(place);
        let lower = grid.node_position(grid.node_index(place));
        for part in 0..2_usize.pow(D as u32) {
            let x = std::array::from_fn(|axis| {
                let middle = if part >> axis & 1 == 0 { 0.25 } else { 0.75 };
                lower[axis] + size[axis] * (middle + 0.1 * jitter * random.symmetric())
            });
            let half_length = std::array::from_fn(|axis| {
                size[axis] * (0.25 + 0.05 * jitter * random.symmetric())
            });
            let volume = size.iter().map(|size| 0.5 * size).product();
            seeds.push(ParticleSeed {
                x,
                half_length,
                volume,
                density: 2.0,
                law: 0,
                centroid: [0.0; _],
            });
        }
    }
    Particles::new(&seeds).unwrap()
}

/// Random nodal displacements.
pub fn displacements<const D: usize>(
    grid: &Grid<D>,
    size: f64,
    random: &mut Random,
) -> Vec<[f64; D]> {
    (0..grid.node_count())
        .map(|_| std::array::from_fn(|_| size * random.symmetric()))
        .collect()
}

/// Every law, with strengths that strains of a few percent exceed.
pub fn laws() -> Vec<(&'static str, SharedLaw)> {
    let elasticity = Elasticity::new(100.0, 0.3).unwrap();
    let angle = f64::to_radians;
    let mut laws = perfectly_plastic(elasticity, angle);
    laws.extend(changing(elasticity, angle));
    laws
}

/// Laws whose strength goes with plastic strain, and the one whose surface is curved.
fn changing(elasticity: Elasticity, angle: fn(f64) -> f64) -> Vec<(&'static str, SharedLaw)> {
    let curve = |initial, residual, decay| Curve {
        initial,
        residual,
        strain: 0.1,
        decay,
    };
    let frictional = |residual: [f64; 3], cutoff| {
        let curves = FrictionalCurves {
            cohesion: curve(1.0, residual[0], Decay::Exponential),
            friction_angle: curve(angle(25.0), angle(residual[1]), Decay::Exponential),
            dilation_angle: curve(angle(5.0), angle(residual[2]), Decay::Exponential),
        };
        Arc::new(Softening::mohr_coulomb(elasticity, curves, cutoff).unwrap())
    };
    let rock = HoekBrownParameters {
        intact_strength: 10.0,
        gsi: 50.0,
        intact_ratio: 10.0,
        disturbance: 0.0,
        dilation_angle: angle(5.0),
    };
    let linear = |initial, residual| curve(initial, residual, Decay::Linear);
    let exponential = |initial, residual| curve(initial, residual, Decay::Exponential);
    let von_mises = |curve| Arc::new(Softening::von_mises(elasticity, curve).unwrap());
    let tresca = |curve| Arc::new(Softening::tresca(elasticity, curve).unwrap());
    vec![
        ("von Mises, softening", von_mises(exponential(1.0, 0.4))),
        ("von Mises, hardening", von_mises(linear(0.6, 1.2))),
        ("Tresca, softening", tresca(exponential(1.0, 0.4))),
        ("Tresca, hardening", tresca(linear(0.6, 1.2))),
        (
            "Mohr-Coulomb, softening",
            frictional([0.4, 20.0, 0.0], None),
        ),
        (
            "Mohr-Coulomb, hardening",
            frictional([1.5, 30.0, 10.0], None),
        ),
        (
            "Mohr-Coulomb, softening, tension cut-off",
            frictional([0.4, 20.0, 0.0], Some(0.5)),
        ),
        (
            "Hoek-Brown",
            Arc::new(HoekBrown::new(elasticity, rock).unwrap()),
        ),
    ]
}

fn perfectly_plastic(
    elasticity: Elasticity,
    angle: fn(f64) -> f64,
) -> Vec<(&'static str, SharedLaw)> {
    vec![
        ("elastic", Arc::new(HenckyElastic::new(elasticity))),
        (
            "von Mises",
            Arc::new(VonMises::from_undrained_strength(elasticity, 1.0).unwrap()),
        ),
        ("Tresca", Arc::new(Tresca::new(elasticity, 1.0).unwrap())),
        (
            "Mohr-Coulomb",
            Arc::new(MohrCoulomb::new(elasticity, 1.0, angle(25.0), angle(5.0)).unwrap()),
        ),
        (
            "Mohr-Coulomb, associated",
            Arc::new(MohrCoulomb::new(elasticity, 1.0, angle(25.0), angle(25.0)).unwrap()),
        ),
        (
            "Mohr-Coulomb, tension cut-off",
            Arc::new(
                MohrCoulomb::new(elasticity, 1.0, angle(25.0), angle(5.0))
                    .and_then(|law| law.with_tension_cutoff(0.5))
                    .unwrap(),
            ),
        ),
    ]
}

/// The variants in both kinematics, and one with the ghost penalty.
pub fn methods() -> Vec<Method> {
    let mut methods = Vec::new();
    for method in [
        Method::impm(),
        Method::impm_bbar(),
        Method::igimp(),
        Method::igimp_bbar(),
        Method::shared_strain(),
    ] {
        for kinematics in [Kinematics::FiniteStrain, Kinematics::SmallStrain] {
            methods.push(Method {
                kinematics,
                ..method.clone()
            });
        }
    }
    let mut ghost = Method::igimp_bbar();
    ghost.small_cuts.ghost_penalty = 1e-2;
    methods.push(ghost);
    methods
}

/// A grid held at its lower end along axis 0, under gravity along the last axis.
pub fn conditions<const D: usize>(grid: &Grid<D>, law: &SharedLaw) -> StepConditions<D> {
    let mut constraints = Constraints::free(grid);
    for node in 0..grid.node_count() {
        let place = grid.node_place(node);
        if place[0] <= 1 {
            constraints.prescribe(node, 0, 0.0).unwrap();
        }
        if place[D - 1] <= 1 {
            constraints.prescribe(node, D - 1, 0.01).unwrap();
        }
    }
    let mut gravity = [0.0; D];
    gravity[D - 1] = -1.0;
    StepConditions::new(
        grid.clone(),
        constraints,
        StepLoads {
            gravity,
            factors: Vec::new(),
            drag: 0.0,
        },
        vec![law.clone()],
    )
    .unwrap()
}

/// The particles of a trial as the body numbers them; `stencils` are those that it was made with.
pub fn by_particle<'a, const D: usize>(
    trial: &'a Trial<D>,
    stencils: &Stencils<D>,
) -> Vec<&'a ParticleTrial<D>> {
    let mut slots: Vec<(u32, &ParticleTrial<D>)> =
        std::iter::zip(stencils.order().iter().copied(), &trial.particles).collect();
    slots.sort_by_key(|&(particle, _)| particle);
    slots.into_iter().map(|(_, trial)| trial).collect()
}
