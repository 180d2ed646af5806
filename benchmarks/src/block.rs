//! A square or cubic block of soil at a trial displacement: the input of the assembly and
//! factorisation benches.
//!
//! The block fills its grid, is held at its base and rolls at its sides. Two particles per cell and
//! direction lie a little off their regular places, so that their domains overlap one or two cells
//! along each axis, as in the midst of a march. The trial displacement is a smooth flow in the
//! plane, without change of volume, plus a compression that grows with depth; it scales with the
//! strain at yield, and about half of the particles are plastic at every size.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use igimp_assembly::{
    AssemblyError, Constraints, Method, ParticleSeed, Particles, SharedLaw, Stencils,
    StepConditions, StepLoads, System,
};
use igimp_material::{
    CamClayParameters, Curve, Decay, Elasticity, FrictionalCurves, HardeningSoil,
    HardeningSoilParameters, HenckyElastic, HoekBrown, HoekBrownParameters, MaterialError,
    ModifiedCamClay, MohrCoulomb, ShearStiffness, Softening, Tresca, VonMises,
    elastic_left_cauchy_green_of,
};
use igimp_shape::{Axis, Grid};

use crate::BenchResult;
use crate::random::Random;

/// Side of the block \[m\].
const SIDE: f64 = 10.0;
/// Cohesion and undrained strength \[Pa\].
const STRENGTH: f64 = 10e3;
/// Angle of friction \[rad\].
const FRICTION: f64 = PI / 9.0;
/// Size of the trial strains, in strains at yield.
const FLOW: f64 = 1.6;
/// Particles are moved at random by up to this share of a cell along each axis.
const JITTER: f64 = 0.1;

/// What a block is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Soil {
    /// Elastic without limit; a symmetric tangent.
    HenckyElastic,
    /// Nearly incompressible von Mises soil: a symmetric tangent.
    VonMises,
    /// Nearly incompressible Tresca soil: a symmetric tangent.
    Tresca,
    /// Mohr–Coulomb soil with ψ = 0: an unsymmetric tangent.
    MohrCoulomb,
    /// Tresca soil that softens.
    SofteningTresca,
    /// Mohr–Coulomb soil that softens, with ψ = 0.
    SofteningMohrCoulomb,
    /// Rock by Hoek and Brown, with ψ = 0.
    HoekBrown,
    /// Modified Cam-clay, lightly overconsolidated.
    ModifiedCamClay,
    /// Loose Hostun sand by Hardening Soil.
    HardeningSoil,
}

impl Soil {
    /// Soils whose return is in closed form.
    pub const ALL: [Self; 4] = [
        Self::HenckyElastic,
        Self::VonMises,
        Self::Tresca,
        Self::MohrCoulomb,
    ];

    /// Soils whose return is found by iteration.
    pub const ITERATED: [Self; 5] = [
        Self::SofteningTresca,
        Self::SofteningMohrCoulomb,
        Self::HoekBrown,
        Self::ModifiedCamClay,
        Self::HardeningSoil,
    ];

    /// Name in the bench's identifier.
    pub fn name(self) -> &'static str {
        match self {
            Self::HenckyElastic => "hencky-elastic",
            Self::VonMises => "von-mises",
            Self::Tresca => "tresca",
            Self::MohrCoulomb => "mohr-coulomb",
            Self::SofteningTresca => "softening-tresca",
            Self::SofteningMohrCoulomb => "softening-mohr-coulomb",
            Self::HoekBrown => "hoek-brown",
            Self::ModifiedCamClay => "modified-cam-clay",
            Self::HardeningSoil => "hardening-soil",
        }
    }

    /// Poisson's ratio of a block that says none.
    pub fn poisson(self) -> f64 {
        match self {
            Self::VonMises | Self::Tresca | Self::SofteningTresca => 0.49,
            _ => 0.3,
        }
    }

    fn law(self, poisson: f64) -> Result<SharedLaw, MaterialError> {
        let elasticity = Elasticity::new(1e7, poisson)?;
        Ok(match self {
            Self::HenckyElastic => Arc::new(HenckyElastic::new(elasticity)),
            Self::VonMises => Arc::new(VonMises::from_undrained_strength(elasticity, STRENGTH)?),
            Self::Tresca => Arc::new(Tresca::new(elasticity, STRENGTH)?),
            Self::MohrCoulomb => Arc::new(MohrCoulomb::new(elasticity, STRENGTH, FRICTION, 0.0)?),
            Self::SofteningTresca => Arc::new(Softening::tresca(
                elasticity,
                curve(STRENGTH, 0.3 * STRENGTH),
            )?),
            Self::SofteningMohrCoulomb => {
                let curves = FrictionalCurves {
                    cohesion: curve(STRENGTH, 0.3 * STRENGTH),
                    friction_angle: curve(FRICTION, FRICTION),
                    dilation_angle: curve(0.0, 0.0),
                };
                Arc::new(Softening::mohr_coulomb(elasticity, curves, None)?)
            }
            Self::HoekBrown => {
                let rock = HoekBrownParameters {
                    intact_strength: 30.0 * STRENGTH,
                    gsi: 50.0,
                    intact_ratio: 10.0,
                    disturbance: 0.0,
                    dilation_angle: 0.0,
                };
                Arc::new(HoekBrown::new(elasticity, rock)?)
            }
            Self::ModifiedCamClay => {
                let clay = CamClayParameters {
                    compression: 0.1,
                    swelling: 0.01,
                    critical_ratio: 1.0,
                    shear: ShearStiffness::Poisson(poisson),
                    overconsolidation: 1.05,
                    reference_pressure: self.confinement(),
                };
                Arc::new(ModifiedCamClay::new(clay)?)
            }
            Self::HardeningSoil => {
                let sand = HardeningSoilParameters::loose_hostun_sand();
                Arc::new(HardeningSoil::new(sand)?)
            }
        })
    }

    /// The pressure under which soil stands that has no stiffness without \[Pa\].
    fn confinement(self) -> f64 {
        match self {
            Self::ModifiedCamClay | Self::HardeningSoil => 100e3,
            _ => 0.0,
        }
    }

    /// Particles with the memory and the elastic strain of their confinement.
    fn confine<const D: usize>(
        self,
        law: &SharedLaw,
        particles: Particles<D>,
    ) -> BenchResult<Particles<D>> {
        let stress = -self.confinement();
        let history = law.initial_history(&[stress; 3]);
        let tau =
            std::array::from_fn(|a| std::array::from_fn(|b| if a == b { stress } else { 0.0 }));
        let b_e = elastic_left_cauchy_green_of::<D>(&**law, &tau, &history)?;
        let mut fields = particles.into_fields();
        fields.b_e.fill(b_e);
        fields.sigma.fill(tau);
        if !law.internal_variables().is_empty() {
            fields.internal = vec![history.internal; fields.b_e.len()];
        }
        Ok(Particles::from_fields(fields)?)
    }
}

/// A parameter that goes from one value to another over a plastic strain of a tenth.
fn curve(initial: f64, residual: f64) -> Curve {
    Curve {
        initial,
        residual,
        strain: 0.1,
        decay: Decay::Exponential,
    }
}

/// A block of soil and a trial displacement.
#[derive(Debug)]
pub struct Block<const D: usize> {
    particles: Particles<D>,
    conditions: StepConditions<D>,
    method: Method,
    /// Nodal trial displacement \[m\].
    pub u: Vec<[f64; D]>,
}

impl Block<2> {
    /// Number of unknowns of a square block with so many cells along a side.
    pub fn unknowns(cells: usize) -> usize {
        2 * cells * cells
    }
}

impl<const D: usize> Block<D> {
    /// A block with so many cells along a side.
    ///
    /// # Errors
    /// Only for a block without cells.
    pub fn new(soil: Soil, cells: usize) -> BenchResult<Self> {
        Self::with_poisson(soil, soil.poisson(), cells)
    }

    /// A block whose soil has another Poisson's ratio.
    ///
    /// # Errors
    /// Only for a block without cells, or a ratio that there is not.
    pub fn with_poisson(soil: Soil, poisson: f64, cells: usize) -> BenchResult<Self> {
        let law = soil.law(poisson)?;
        let h = SIDE / cells as f64;
        let axis = Axis::uniform(0.0, h, cells)?;
        let grid = Grid::new(std::array::from_fn(|_| axis.clone()));
        let upright = D - 1;
        let mut constraints = Constraints::free(&grid);
        for side in 0..upright {
            constraints.fix_wall(&grid, side, false, side)?;
            constraints.fix_wall(&grid, side, true, side)?;
        }
        for direction in 0..D {
            constraints.fix_wall(&grid, upright, false, direction)?;
        }
        let mut gravity = [0.0; D];
        gravity[upright] = -9.81;
        let strain_at_yield = STRENGTH / (2.0 * law.stiffness_bound().shear());
        let u = (0..grid.node_count())
            .map(|node| flow(grid.node_position(node), FLOW * strain_at_yield))
            .collect();
        Ok(Self {
            particles: soil.confine(&law, Particles::new(&seeds(cells, h))?)?,
            conditions: StepConditions::new(
                grid,
                constraints,
                StepLoads {
                    gravity,
                    factors: Vec::new(),
                    drag: 0.0,
                },
                vec![law],
            )?,
            method: Method::default(),
            u,
        })
    }

    /// Number of particles of a block with so many cells along a side.
    pub fn particles(cells: usize) -> usize {
        (2 * cells).pow(D as u32)
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.particles.len()
    }

    /// Whether there is no particle: never, by construction.
    pub fn is_empty(&self) -> bool {
        self.particles.is_empty()
    }

    /// The grid that it fills.
    pub fn grid(&self) -> &Grid<D> {
        &self.conditions.grid
    }

    /// How it is held.
    pub fn constraints(&self) -> &Constraints<D> {
        &self.conditions.constraints
    }

    /// The supports of every particle.
    ///
    /// # Errors
    /// Never: all particles are on the grid.
    pub fn stencils(&self) -> Result<Stencils<D>, AssemblyError> {
        Stencils::build(&self.particles, &self.method, &self.conditions)
    }

    /// The system of equations, with a pattern of its own.
    ///
    /// # Errors
    /// Never: the block has one law, and nodes that are free.
    pub fn system<'a>(&'a self, stencils: &'a Stencils<D>) -> Result<System<'a, D>, AssemblyError> {
        System::new(&self.particles, stencils, &self.conditions, &self.method)
    }
}

/// Two particles per cell and direction, off their regular places at random.
fn seeds<const D: usize>(cells: usize, h: f64) -> Vec<ParticleSeed<D>> {
    let mut random = Random::new(3);
    let per_side = 2 * cells;
    (0..per_side.pow(D as u32))
        .map(|mut part| {
            let place: [usize; D] = std::array::from_fn(|_| {
                let along = part % per_side;
                part /= per_side;
                along
            });
            ParticleSeed {
                x: place
                    .map(|k| 0.5 * h * (k as f64 + 0.5) + random.between(-JITTER * h, JITTER * h)),
                half_length: [0.25 * h; D],
                volume: (0.5 * h).powi(D as i32),
                density: 2000.0,
                law: 0,
                centroid: [0.0; _],
            }
        })
        .collect()
}

/// The trial displacement at a point for strains of about `strain`, in the plane of the first axis
/// and the upright one; zero where the block is held.
fn flow<const D: usize>(position: [f64; D], strain: f64) -> [f64; D] {
    let (x, y) = (position[0], position[D - 1]);
    let (sin_x, cos_x) = (PI * x / SIDE).sin_cos();
    let (sin_y, cos_y) = (FRAC_PI_2 * y / SIDE).sin_cos();
    let settlement = 0.5 * y * (1.0 - 0.5 * y / SIDE);
    let mut u = [0.0; D];
    u[0] = strain * SIDE / PI * sin_x * sin_y;
    u[D - 1] = strain * (SIDE / FRAC_PI_2 * cos_x * (cos_y - 1.0) - settlement);
    u
}

#[cfg(test)]
mod tests {
    use super::*;
    use igimp_material::TangentKind;

    #[test]
    fn about_half_of_the_particles_are_plastic() {
        for soil in Soil::ALL {
            let expected = match soil {
                Soil::HenckyElastic => 0.0..0.01,
                _ => 0.4..0.6,
            };
            let shares = [plastic_share::<2>(soil, 20), plastic_share::<3>(soil, 8)];
            for share in shares {
                assert!(expected.contains(&share), "{soil:?}: {share}");
            }
        }
    }

    #[test]
    fn returns_by_iteration_are_many() {
        for soil in Soil::ITERATED {
            let shares = [plastic_share::<2>(soil, 20), plastic_share::<3>(soil, 8)];
            println!("{soil:?}: {shares:?}");
            assert!(
                shares.iter().all(|share| (0.4..=1.0).contains(share)),
                "{soil:?}"
            );
        }
    }

    fn plastic_share<const D: usize>(soil: Soil, cells: usize) -> f64 {
        let block: Block<D> = Block::new(soil, cells).unwrap();
        let stencils = block.stencils().unwrap();
        let system = block.system(&stencils).unwrap();
        let trial = system.evaluate(&block.u, TangentKind::Consistent).unwrap();
        let plastic = trial
            .particles
            .iter()
            .filter(|particle| particle.regime.is_plastic())
            .count();
        plastic as f64 / block.len() as f64
    }

    #[test]
    fn the_flow_respects_the_supports() {
        let block: Block<3> = Block::new(Soil::VonMises, 4).unwrap();
        for (node, u) in block.u.iter().enumerate() {
            for axis in 0..3 {
                let held = block.conditions.constraints.of(node, axis).is_some();
                assert!(!held || u[axis].abs() < 1e-12, "node {node}: {u:?}");
            }
        }
    }

    #[test]
    fn domains_touch_about_six_nodes() {
        let block: Block<2> = Block::new(Soil::VonMises, 20).unwrap();
        let stencils = block.stencils().unwrap();
        let touched: usize = (0..block.len()).map(|p| stencils.of(p).len()).sum();
        let mean = touched as f64 / block.len() as f64;
        assert!((5.5..6.5).contains(&mean), "{mean}");
    }

    #[test]
    fn the_size_is_known_beforehand() {
        for cells in [4, 15] {
            let block: Block<2> = Block::new(Soil::VonMises, cells).unwrap();
            assert_eq!(block.len(), Block::<2>::particles(cells));
            let stencils = block.stencils().unwrap();
            let system = block.system(&stencils).unwrap();
            assert_eq!(system.unknowns().len(), Block::unknowns(cells));
        }
    }
}
