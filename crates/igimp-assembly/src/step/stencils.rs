//! The supports of every particle, frozen for one step, with small cuts tied,
//! and their sums at the nodes.

use igimp_shape::{Grid, Support};

use crate::body::particles::Particles;
use crate::conditions::StepConditions;
use crate::conditions::loads::LoadPoint;
use crate::error::AssemblyError;
use crate::method::{CutVolume, Geometry, Method, Remedy};
use crate::step::cell_soil::{CellSoil, Moments};
use crate::step::domain::bounds;
use crate::step::hoops::Hoop;
use crate::step::node_shares::{NodeShare, node_shares};
use crate::step::small_cuts::{extrapolations, masters_of_cuts, small_cuts, volume_at};
use crate::step::strips::Strips;
use crate::step::supports::Supports;
use crate::step::ties::{Carrier, Ties, carried};

/// Basis values S, gradients ∇S and cell-averaged centre gradients ∇S̄ of all particles.
///
/// Without B-bar, ∇S̄ is replaced by ∇S, so that the four variants of the method run through the
/// same code.
#[derive(Clone, Debug)]
pub struct Stencils<const D: usize> {
    supports: Supports<D>,
    shares: Vec<NodeShare>,
    ties: Ties,
    /// Whether other nodes move with a node.
    is_carrier: Vec<bool>,
    strips: Strips,
    /// By law, moments of mass that shared gradients do not see (theory, eq. 8f).
    moments: Vec<Moments<D>>,
}

impl<const D: usize> Stencils<D> {
    /// Evaluates the basis of a method at all particles on the grid of a step, and ties nodes that are small cuts to
    /// their neighbours if the method says so.
    ///
    /// Half-lengths count up to one cell: a domain stretched further would couple ever more nodes
    /// without gain.
    ///
    /// # Errors
    /// [`AssemblyError::Shape`] names the first particle whose centre left the grid,
    /// [`AssemblyError::UnknownLaw`] one whose law is not there; [`AssemblyError::OtherGrid`] if the
    /// constraints were made for another grid.
    pub fn build(
        particles: &Particles<D>,
        method: &Method,
        conditions: &StepConditions<D>,
    ) -> Result<Self, AssemblyError> {
        Self::build_under(particles, method, conditions, &[])
    }

    /// The same where points load faces of the body, by factors that are not zero: soil of their cells balances their
    /// load (theory, eq. 8h).
    ///
    /// # Errors
    /// As [`Self::build`].
    pub fn build_under(
        particles: &Particles<D>,
        method: &Method,
        conditions: &StepConditions<D>,
        points: &[LoadPoint<D>],
    ) -> Result<Self, AssemblyError> {
        let grid = &conditions.grid;
        conditions.validate(particles)?;
        let is_loaded = |point: &&LoadPoint<D>| {
            let factor = conditions.loads.factors.get(point.load);
            factor.is_some_and(|factor| *factor != 0.0)
        };
        let loaded: Vec<LoadPoint<D>> = points.iter().filter(is_loaded).copied().collect();
        let mut soil = CellSoil::where_it_counts(particles, method, conditions, &loaded)?;
        let mut supports = Supports::build(grid, particles, method, soil.as_ref())?;
        let mut strips = Strips::build(grid, &supports);
        let mut shares = node_shares(grid, particles, &supports, &strips, method.section);
        let ties = ties(method, conditions, &supports, &shares);
        let mut is_carrier = vec![false; grid.node_count()];
        if !ties.is_empty() {
            let mut tied = vec![false; grid.node_count()];
            for (&node, carriers) in &ties {
                tied[node] = true;
                let share = std::mem::take(&mut shares[node]);
                for Carrier { node, weight } in carriers {
                    is_carrier[*node] = true;
                    shares[*node].volume += weight * share.volume;
                    shares[*node].mass += weight * share.mass;
                }
            }
            if let (Some(soil), Geometry::Given) = (&mut soil, method.geometry) {
                soil.follow(grid, &ties);
            }
            let (mut stencil, mut hoops) = (Vec::new(), Vec::new());
            for particle in supports.touching(&tied) {
                match &soil {
                    Some(soil) => soil.supports(
                        grid,
                        (particle, particles.law[particle]),
                        &mut stencil,
                        &mut hoops,
                    ),
                    None => stencil = supports.of(particle).to_vec(),
                }
                supports.tie(grid, particle, (&stencil, &hoops), &ties);
            }
            strips = Strips::build(grid, &supports);
        }
        Ok(Self {
            supports,
            shares,
            ties,
            is_carrier,
            strips,
            moments: soil.map_or(Vec::new(), |soil| soil.moments(grid, particles, method)),
        })
    }

    /// The supports of one particle, nodes ascending.
    #[inline]
    pub fn of(&self, particle: usize) -> &[Support<D>] {
        self.supports.of(particle)
    }

    /// The supports of a particle, and how each stretches it around the axis: none unless the section is axisymmetric.
    #[inline]
    pub(crate) fn with_hoops(&self, particle: usize) -> (&[Support<D>], &[Hoop]) {
        self.supports.with_hoops(particle)
    }

    /// The displacement of the middle of a particle by nodal displacements `u`: Σ_i S_i u_i, in a body of revolution the mean over the
    /// section of the particle (theory, eq. 130h) \[length\].
    pub(crate) fn displacement(&self, particle: usize, u: &[[f64; D]]) -> [f64; D] {
        let (supports, hoops) = self.with_hoops(particle);
        let mut displacement = [0.0; D];
        if hoops.is_empty() {
            for support in supports {
                for axis in 0..D {
                    displacement[axis] += support.value * u[support.node][axis];
                }
            }
            return displacement;
        }
        let whole: f64 = hoops.iter().map(|hoop| hoop.place).sum();
        for (support, hoop) in supports.iter().zip(hoops) {
            for axis in 0..D {
                displacement[axis] += hoop.place / whole * u[support.node][axis];
            }
        }
        displacement
    }

    /// The particles in the order in which sums run: by the first node of their supports.
    pub fn order(&self) -> &[u32] {
        self.strips.order()
    }

    /// The lowest place and the extent, in nodes along each axis, of a particle's supports.
    pub(crate) fn box_of(&self, grid: &Grid<D>, particle: usize) -> ([usize; D], [usize; D]) {
        bounds(grid, self.of(particle))
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.supports.len()
    }

    /// Whether there is no particle: never, by construction.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Largest distance, in nodes along one axis, between two nodes of one particle.
    pub fn reach(&self) -> usize {
        self.supports.reach()
    }

    /// Volume that a grid node represents, Σ_p S_i V_p, over the thickness of the section \[length^D\].
    pub fn node_volume(&self, node: usize) -> f64 {
        self.shares[node].volume
    }

    /// Mass that a grid node represents, Σ_p S_i m_p \[mass\].
    pub fn node_mass(&self, node: usize) -> f64 {
        self.shares[node].mass
    }

    /// Volume that a grid node represents over the mean volume of the cells around it \[-\]: 1 within a
    /// full body, and next to nothing at a small cut.
    pub fn node_fill(&self, grid: &Grid<D>, node: usize) -> f64 {
        self.shares[node].volume / volume_at(grid, CutVolume::Cell, node)
    }

    /// By law, moments of mass that shared gradients do not see (theory, eq. 8f).
    pub(crate) fn moments(&self) -> &[Moments<D>] {
        &self.moments
    }

    /// Tied nodes with the nodes that they move with.
    pub(crate) fn ties(&self) -> &Ties {
        &self.ties
    }

    /// Whether a node moves with others.
    pub fn is_tied(&self, node: usize) -> bool {
        self.ties.contains_key(&node)
    }

    /// Whether other nodes move with a node: it has enough soil, whatever extrapolation took from it.
    pub(crate) fn is_carrier(&self, node: usize) -> bool {
        self.is_carrier[node]
    }

    /// The nodes that a node moves with: itself alone unless it is tied.
    pub fn carriers(&self, node: usize) -> impl Iterator<Item = Carrier> + '_ {
        let tie = self.ties.get(&node);
        let single = tie.is_none().then_some(Carrier { node, weight: 1.0 });
        single.into_iter().chain(tie.into_iter().flatten().copied())
    }

    /// The supports of a point on the nodes that carry it, in their order.
    pub(crate) fn carried(&self, supports: &[Support<D>]) -> Vec<Support<D>> {
        carried(supports, &self.ties)
    }

    /// Particles grouped by strips of node rows, for sums that are the same for any thread count.
    pub(crate) fn strips(&self) -> &Strips {
        &self.strips
    }
}

/// The ties of small cuts that a method asks for.
fn ties<const D: usize>(
    method: &Method,
    conditions: &StepConditions<D>,
    supports: &Supports<D>,
    shares: &[NodeShare],
) -> Ties {
    let rules = &method.small_cuts;
    if rules.remedy == Remedy::Drop {
        return Ties::new();
    }
    let cuts = small_cuts(&conditions.grid, shares, rules);
    if !cuts.contains(&true) {
        return Ties::new();
    }
    let mut ties = match rules.remedy {
        Remedy::Extrapolate => extrapolations(conditions, shares, (&cuts, rules)),
        Remedy::Tie | Remedy::Drop => Ties::new(),
    };
    let masters = masters_of_cuts(conditions, supports, shares, &cuts);
    for (cut, node) in masters {
        let weight = 1.0;
        ties.entry(cut)
            .or_insert_with(|| vec![Carrier { node, weight }]);
    }
    ties
}
