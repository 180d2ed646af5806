//! Nonlocal strain: the plastic strain that softening goes with, spread over a length by an implicit gradient, with its rise over the
//! step among the unknowns (theory, eqs. 110a to 110d).
//!
//! ```math
//! \Delta\bar\kappa - l^2 \nabla^2 \Delta\bar\kappa = \Delta\kappa
//! ```
//!
//! in the ground as the step begins with it, and no flux at its faces. The unknown of a node is a length and its equation a force:
//! both are put to scale by a side of a cell and a shear modulus.

use igimp_material::{NonlocalRates, Tensor};
use igimp_shape::Support;

use crate::body::particles::Particles;
use crate::conditions::StepConditions;
use crate::contributions::consolidation::least_side;
use crate::error::AssemblyError;
use crate::step::stencils::Stencils;
use crate::step::unknowns::Unknowns;

/// Marks a node of the grid without nonlocal strain.
const NONE: u32 = u32::MAX;

/// The nonlocal strain of a step; empty where no strength sees it.
#[derive(Debug, Default)]
pub(crate) struct NonlocalStrain<const D: usize> {
    /// The node that stands for the first one.
    first: usize,
    /// By node of the grid: its number.
    numbers: Vec<u32>,
    /// By law: its length, if it has one \[length\].
    lengths: Vec<Option<f64>>,
    /// Strain over the unknown \[1/length\].
    scale: f64,
    /// Force by volume over the gradient of strain \[force/length²\].
    modulus: f64,
}

/// Plastic strain and its rates at a particle, in spatial axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpatialRates<const D: usize> {
    /// Plastic strain of the step Δκ, and its derivative by nonlocal strain \[-\].
    plastic: f64,
    plastic_by_nonlocal: f64,
    /// Its derivative by the trial strain \[-\].
    plastic_by_strain: InPlace<D>,
    /// The derivative of stress by nonlocal strain \[force/length²\].
    stress_by_nonlocal: InPlace<D>,
}

/// A symmetric tensor: its components along the axes, and a third of its trace in space.
#[derive(Clone, Copy, Debug)]
struct InPlace<const D: usize> {
    components: [[f64; D]; D],
    mean: f64,
}

impl<const D: usize> InPlace<D> {
    /// That of principal values with their axes in rows.
    fn of(values: &[f64; 3], frame: &Tensor) -> Self {
        let mut components = [[0.0; D]; D];
        for (value, axis) in values.iter().zip(frame) {
            for a in 0..D {
                for b in 0..D {
                    components[a][b] += value * axis[a] * axis[b];
                }
            }
        }
        Self {
            components,
            mean: values.iter().sum::<f64>() / 3.0,
        }
    }

    /// Its work on the strain that a node's unit displacement causes, with the dilatation of the cells (theory, eq. 16).
    #[inline]
    fn along(&self, g: &[f64; D], g_bar: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|a| {
            let local: f64 = (0..D).map(|b| self.components[a][b] * g[b]).sum();
            local + self.mean * (g_bar[a] - g[a])
        })
    }
}

impl<const D: usize> SpatialRates<D> {
    /// Those of principal values, of a tangent that leaves a share of plastic flow out \[-\].
    pub(crate) fn of(rates: &NonlocalRates, frame: &Tensor, elastic: f64) -> Self {
        let left = 1.0 - elastic;
        let spatial = |values: [f64; 3]| InPlace::of(&values.map(|value| left * value), frame);
        Self {
            plastic: rates.plastic,
            plastic_by_nonlocal: left * rates.plastic_by_nonlocal,
            plastic_by_strain: spatial(rates.plastic_by_strain),
            stress_by_nonlocal: spatial(rates.stress_by_nonlocal),
        }
    }
}

/// The nodes of the grid with nonlocal strain: those that particles touch whose strength sees it; none where there are none.
///
/// # Errors
/// [`AssemblyError::NonlocalStrain`] in space, and of a step with flow or inertia.
pub(crate) fn strain_nodes<const D: usize>(
    particles: &Particles<D>,
    stencils: &Stencils<D>,
    conditions: &StepConditions<D>,
) -> Result<Vec<bool>, AssemblyError> {
    let laws = conditions.laws.iter();
    let sees: Vec<bool> = laws.map(|law| law.nonlocal().is_some()).collect();
    if !particles.law.iter().any(|&law| sees[law]) {
        return Ok(Vec::new());
    }
    let refused = if D == 3 {
        Some("space")
    } else if conditions.flow.is_some() {
        Some("water that flows")
    } else {
        conditions.time.map(|_| "inertia")
    };
    if let Some(with) = refused {
        return Err(AssemblyError::NonlocalStrain { with });
    }
    let mut has_strain = vec![false; conditions.grid.node_count()];
    for particle in 0..particles.len() {
        if sees[particles.law[particle]] {
            for support in stencils.of(particle) {
                has_strain[support.node] = true;
            }
        }
    }
    Ok(has_strain)
}

impl<const D: usize> NonlocalStrain<D> {
    /// That of a step whose unknowns are numbered.
    pub(crate) fn find(conditions: &StepConditions<D>, unknowns: &Unknowns<D>) -> Self {
        let laws = conditions.laws.iter();
        let lengths: Vec<Option<f64>> = laws
            .map(|law| law.nonlocal().map(|nonlocal| nonlocal.length))
            .collect();
        if unknowns.scalar_count() == 0 || conditions.flow.is_some() {
            return Self::default();
        }
        let mut numbers = vec![NONE; conditions.grid.node_count()];
        for (number, node) in unknowns.scalar_nodes().enumerate() {
            numbers[node] = number as u32;
        }
        let seen = std::iter::zip(&conditions.laws, &lengths).filter(|(_, l)| l.is_some());
        let shear = seen.map(|(law, _)| law.stiffness_bound().shear());
        Self {
            first: unknowns.first_scalar(),
            numbers,
            scale: 1.0 / least_side(&conditions.grid),
            modulus: shear.fold(0.0, f64::max),
            lengths,
        }
    }

    /// Whether it is among the unknowns.
    pub(crate) fn is_solved_for(&self) -> bool {
        !self.numbers.is_empty()
    }

    /// The unknown of a node of the grid at nodal values `u` \[length\]; zero of a node that was dropped as a small cut.
    #[inline]
    fn value(&self, node: usize, u: &[[f64; D]]) -> f64 {
        match self.numbers[node] {
            NONE => 0.0,
            number => u[self.first + number as usize][0],
        }
    }

    /// By how much the nonlocal strain of a particle rises at nodal values `u` \[-\]; none where strength does not see it.
    #[inline]
    pub(crate) fn rise(&self, law: usize, supports: &[Support<D>], u: &[[f64; D]]) -> Option<f64> {
        (*self.lengths.get(law)?)?;
        let values = supports.iter();
        let sum: f64 = values.map(|s| s.value * self.value(s.node, u)).sum();
        Some(self.scale * sum)
    }

    /// The nonlocal strain of a particle with its `rates` at nodal values `u`, of a `volume` at the start of the step, and one that its
    /// stress is multiplied by \[length^D\].
    #[inline]
    pub(crate) fn of_particle<'c>(
        &'c self,
        law: usize,
        (supports, rates): (&[Support<D>], &'c SpatialRates<D>),
        u: &[[f64; D]],
        [volume, of_stress]: [f64; 2],
    ) -> Option<StrainOfParticle<'c, D>> {
        let length = (*self.lengths.get(law)?)?;
        let (mut rise, mut grad) = (0.0, [0.0; D]);
        for support in supports {
            let strain = self.scale * self.value(support.node, u);
            rise += support.value * strain;
            for (sum, slope) in grad.iter_mut().zip(support.grad) {
                *sum += slope * strain;
            }
        }
        Some(StrainOfParticle {
            numbers: &self.numbers,
            rates,
            rise,
            grad,
            squared_length: length * length,
            scale: self.scale,
            weight: self.modulus * self.scale * volume,
            of_stress: self.scale * of_stress,
        })
    }
}

/// Nonlocal strain of a particle at some nodal values: the forces of its nodes, and the derivative.
pub(crate) struct StrainOfParticle<'c, const D: usize> {
    numbers: &'c [u32],
    rates: &'c SpatialRates<D>,
    /// By how much nonlocal strain rises, and the gradient of that \[-, 1/length\].
    rise: f64,
    grad: [f64; D],
    squared_length: f64,
    /// Strain over the unknown \[1/length\].
    scale: f64,
    /// Force over strain \[force\].
    weight: f64,
    /// Volume that stress is multiplied by, over a unit of the unknown \[length^(D-1)\].
    of_stress: f64,
}

impl<const D: usize> StrainOfParticle<'_, D> {
    /// Adds the forces of its nodes to those of nonlocal strain from the number `first` on (theory, eq. 110d).
    #[inline]
    pub(crate) fn add_forces(
        &self,
        supports: &[Support<D>],
        first: usize,
        forces: &mut [[f64; D]],
    ) {
        let rise = self.rise - self.rates.plastic;
        for support in supports {
            let number = self.numbers[support.node];
            if number == NONE {
                continue;
            }
            let along = dot(&support.grad, &self.grad);
            let force = support.value * rise + self.squared_length * along;
            forces[number as usize - first][0] += self.weight * force;
        }
    }

    /// The shares of a node's nonlocal strain: that of the slopes of displacement in its force, and forces of the other way round.
    #[inline]
    pub(crate) fn shares(&self, support: &Support<D>) -> [f64; 2] {
        [-self.weight * support.value, self.of_stress * support.value]
    }

    /// The slopes of a node's displacement with its pushed gradients: of plastic strain by it, and of its force by nonlocal strain.
    #[inline]
    pub(crate) fn slopes(&self, (g, g_bar): (&[f64; D], &[f64; D])) -> [[f64; D]; 2] {
        let SpatialRates {
            plastic_by_strain,
            stress_by_nonlocal,
            ..
        } = self.rates;
        [plastic_by_strain, stress_by_nonlocal].map(|rate| rate.along(g, g_bar))
    }

    /// The force of node `row` by the nonlocal strain of node `column`.
    #[inline]
    pub(crate) fn moves(&self, row: &Support<D>, column: &Support<D>) -> f64 {
        let local = (1.0 - self.rates.plastic_by_nonlocal) * row.value * column.value;
        self.weight * self.scale * (local + self.squared_length * dot(&row.grad, &column.grad))
    }

    /// Adds the forces K_fp u_p of its nodes that `moved`, by node and axis, causes, to forces by number.
    pub(crate) fn add_force_of_motion(
        &self,
        supports: &[Support<D>],
        (g, g_bar): (&[[f64; D]], &[[f64; D]]),
        moved: &dyn Fn(usize, usize) -> f64,
        add: &mut dyn FnMut(usize, f64),
    ) {
        let gradients = std::iter::zip(g, g_bar);
        let plastic: f64 = std::iter::zip(supports, gradients)
            .map(|(column, gradients)| {
                let [slope, _] = self.slopes(gradients);
                (0..D)
                    .map(|axis| slope[axis] * moved(column.node, axis))
                    .sum::<f64>()
            })
            .sum();
        for support in supports {
            let number = self.numbers[support.node];
            if number != NONE {
                add(number as usize, self.shares(support)[0] * plastic);
            }
        }
    }
}

#[inline]
fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    (0..D).map(|axis| a[axis] * b[axis]).sum()
}
