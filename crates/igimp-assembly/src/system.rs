//! The equilibrium of one step: residual and tangent at a trial displacement.

use std::ops::Range;
use std::sync::Arc;

use igimp_material::{ConstitutiveModel, TangentKind};
use igimp_shape::Grid;
use rayon::prelude::*;

use crate::constraints::Constraints;
use crate::error::AssemblyError;
use crate::ghost::{Coupling, ghost_entries};
use crate::kinematics::{ParticleTrial, evaluate};
use crate::linearised::{Linearised, internal_force};
use crate::loads::{LoadPoint, StepLoads, external_force, nodal_drag};
use crate::matrix::{Pattern, TangentMatrix};
use crate::method::{Kinematics, Method};
use crate::particles::Particles;
use crate::residual::{OutOfBalance, force_of_round_off};
use crate::stencils::Stencils;
use crate::unknowns::{BlockTable, Unknowns};

/// A constitutive law that several bodies and threads share.
pub type SharedLaw = Arc<dyn ConstitutiveModel>;

/// What holds during one step, besides the particles.
#[derive(Clone, Debug)]
pub struct StepConditions<const D: usize> {
    /// The background grid of this step.
    pub grid: Grid<D>,
    /// Prescribed step displacements.
    pub constraints: Constraints<D>,
    /// External force at the end of the step.
    pub loads: StepLoads<D>,
    /// Laws at the end of the step, as the particles number them.
    pub laws: Vec<SharedLaw>,
}

/// All particles at a trial displacement.
#[derive(Clone, Debug)]
pub struct Trial<const D: usize> {
    /// Particle by particle.
    pub particles: Vec<ParticleTrial<D>>,
    /// Internal force by node, ghost penalty and drag included \[force\].
    pub f_int: Vec<[f64; D]>,
}

/// One step's system of equations. Borrows the state at the step's start and never changes it.
#[derive(Debug)]
pub struct System<'a, const D: usize> {
    particles: &'a Particles<D>,
    stencils: &'a Stencils<D>,
    conditions: &'a StepConditions<D>,
    method: &'a Method,
    unknowns: Unknowns<D>,
    f_ext: Vec<[f64; D]>,
    /// ‖f_int‖ of strains that are round-off \[force\].
    round_off: f64,
    /// Ghost penalty and drag: forces proportional to step displacements.
    couplings: Vec<Coupling>,
    /// Where the drag begins among the couplings.
    first_drag: usize,
    table: BlockTable<D>,
    pattern: Arc<Pattern>,
    symmetric: bool,
}

impl<'a, const D: usize> System<'a, D> {
    /// Sets up the unknowns, the external force and the sparsity pattern of a step. A `previous`
    /// pattern is shared again when it still holds.
    ///
    /// # Errors
    /// [`AssemblyError::UnknownLaw`], [`AssemblyError::NoUnknowns`], or a load point off the body.
    pub fn new(
        particles: &'a Particles<D>,
        stencils: &'a Stencils<D>,
        conditions: &'a StepConditions<D>,
        method: &'a Method,
        points: &[LoadPoint<D>],
        previous: Option<&Arc<Pattern>>,
    ) -> Result<Self, AssemblyError> {
        let laws = conditions.laws.len();
        let mut used = vec![false; laws];
        for (particle, &law) in particles.law.iter().enumerate() {
            *used.get_mut(law).ok_or(AssemblyError::UnknownLaw {
                particle,
                law,
                laws,
            })? = true;
        }
        let symmetric = std::iter::zip(&conditions.laws, &used)
            .all(|(law, &used)| !used || law.has_symmetric_tangent());
        let grid = &conditions.grid;
        let cuts = method.small_cuts;
        let unknowns = Unknowns::number(grid, stencils, &conditions.constraints, cuts.below)?;
        let f_ext = external_force(grid, particles, stencils, points, &conditions.loads)?;
        let mut couplings = if cuts.ghost_penalty > 0.0 {
            let young = |p: usize| conditions.laws[particles.law[p]].elasticity().young();
            ghost_entries(grid, particles, stencils, young, cuts.ghost_penalty)
        } else {
            Vec::new()
        };
        let first_drag = couplings.len();
        if conditions.loads.drag > 0.0 {
            let drag = nodal_drag(grid, particles, stencils, conditions.loads.drag);
            couplings.extend(drag.into_iter().map(|(node, stiffness)| Coupling {
                row: node,
                column: node,
                stiffness,
            }));
        }
        let pairs: Vec<_> = couplings
            .iter()
            .map(|entry| (entry.column, entry.row))
            .collect();
        let (table, pattern) = BlockTable::build(grid, stencils, &unknowns, &pairs, previous);
        Ok(Self {
            particles,
            stencils,
            conditions,
            method,
            unknowns,
            f_ext,
            round_off: force_of_round_off(particles, stencils, conditions),
            couplings,
            first_drag,
            table,
            pattern,
            symmetric,
        })
    }

    /// The unknowns.
    pub fn unknowns(&self) -> &Unknowns<D> {
        &self.unknowns
    }

    /// The sparsity pattern of the tangent matrix.
    pub fn pattern(&self) -> &Arc<Pattern> {
        &self.pattern
    }

    /// External force by node \[force\].
    pub fn f_ext(&self) -> &[[f64; D]] {
        &self.f_ext
    }

    /// The state at the start of the step, stresses included.
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    pub fn start(&self, kind: TangentKind) -> Result<Trial<D>, AssemblyError> {
        self.evaluate(&vec![[0.0; D]; self.conditions.grid.node_count()], kind)
    }

    /// Stress, tangent and internal force at nodal step displacements `u` \[length\].
    ///
    /// # Errors
    /// [`AssemblyError::Inverted`] or [`AssemblyError::Material`] of the first particle that
    /// fails.
    pub fn evaluate(&self, u: &[[f64; D]], kind: TangentKind) -> Result<Trial<D>, AssemblyError> {
        let results: Vec<Result<ParticleTrial<D>, AssemblyError>> = (0..self.particles.len())
            .into_par_iter()
            .map(|particle| {
                evaluate(
                    particle,
                    self.stencils.of(particle),
                    u,
                    (
                        &self.particles.b_e[particle],
                        &self.particles.history[particle],
                    ),
                    &*self.conditions.laws[self.particles.law[particle]],
                    self.method.kinematics,
                    kind,
                )
            })
            .collect();
        let particles = results.into_iter().collect::<Result<Vec<_>, _>>()?;

        let mut f_int = vec![[0.0; D]; u.len()];
        self.stencils
            .strips()
            .sum(&mut f_int, Clone::clone, |members, nodes, slice| {
                for &particle in members {
                    let particle = particle as usize;
                    let volume = self.reference_volume(particle);
                    for support in self.stencils.of(particle) {
                        let force = internal_force(support, &particles[particle], volume);
                        for axis in 0..D {
                            slice[support.node - nodes.start][axis] += force[axis];
                        }
                    }
                }
            });
        for entry in &self.couplings {
            for axis in 0..D {
                f_int[entry.row][axis] += entry.stiffness * u[entry.column][axis];
            }
        }
        Ok(Trial { particles, f_int })
    }

    /// The out-of-balance force of a trial.
    ///
    /// # Errors
    /// [`AssemblyError::NonFinite`] when a nodal force is not finite.
    pub fn out_of_balance(&self, trial: &Trial<D>) -> Result<OutOfBalance, AssemblyError> {
        OutOfBalance::measure(&self.unknowns, &self.f_ext, &trial.f_int, self.round_off)
    }

    /// The reaction f_int − f_ext by node, zero at unknowns \[force\].
    pub fn reactions(&self, trial: &Trial<D>) -> Vec<[f64; D]> {
        let mut reactions = vec![[0.0; D]; trial.f_int.len()];
        for (node, reaction) in reactions.iter_mut().enumerate() {
            for axis in 0..D {
                if self.unknowns.index(node, axis).is_none() {
                    reaction[axis] = trial.f_int[node][axis] - self.f_ext[node][axis];
                }
            }
        }
        reactions
    }

    /// The norm of the drag at nodal step displacements over that of the external force: the share
    /// of the load that motion carries \[-\].
    pub fn drag_share(&self, u: &[[f64; D]]) -> f64 {
        let mut drag = 0.0;
        for coupling in &self.couplings[self.first_drag..] {
            for component in u[coupling.row] {
                drag += (coupling.stiffness * component).powi(2);
            }
        }
        let external: f64 = self.f_ext.iter().flatten().map(|force| force * force).sum();
        if drag == 0.0 {
            0.0
        } else {
            (drag / external).sqrt()
        }
    }

    /// The tangent matrix K = ∂f_int/∂u of a trial, summed straight into its pattern.
    pub fn tangent(&self, trial: &Trial<D>) -> TangentMatrix {
        let mut matrix = TangentMatrix::zeros(Arc::clone(&self.pattern), self.symmetric);
        self.assemble(trial, &mut matrix.values);
        matrix
    }

    /// Rewrites `matrix`, which must have this system's pattern, with the tangent of a trial.
    ///
    /// # Panics
    /// If the matrix has another pattern.
    pub fn tangent_into(&self, trial: &Trial<D>, matrix: &mut TangentMatrix) {
        assert!(
            Arc::ptr_eq(&matrix.pattern, &self.pattern),
            "the matrix belongs to this step"
        );
        matrix.symmetric = self.symmetric;
        matrix.values.fill(0.0);
        self.assemble(trial, &mut matrix.values);
    }

    fn assemble(&self, trial: &Trial<D>, values: &mut [f64]) {
        let range = |nodes: &Range<usize>| {
            self.first_value(self.unknowns.before(nodes.start))
                ..self.first_value(self.unknowns.before(nodes.end))
        };
        self.stencils
            .strips()
            .sum(values, range, |members, own, slice| {
                let mut linearised = Linearised::default();
                let mut codes = Vec::new();
                for &particle in members {
                    let particle = particle as usize;
                    self.add_particle(
                        particle,
                        trial,
                        &mut linearised,
                        &mut codes,
                        own.start,
                        slice,
                    );
                }
            });
        for entry in &self.couplings {
            for axis in 0..D {
                if let (Some(row), Some(column)) = (
                    self.unknowns.index(entry.row, axis),
                    self.unknowns.index(entry.column, axis),
                ) {
                    let start = self.first_value(column)
                        + self.table.offset(
                            entry.column,
                            self.code(entry.column),
                            self.code(entry.row),
                        );
                    values[start + row - self.unknowns.before(entry.row)] += entry.stiffness;
                }
            }
        }
    }

    /// First stored value of the column of an unknown, or the end of all values after the last.
    fn first_value(&self, unknown: usize) -> usize {
        let blocks = &self.pattern.blocks;
        let index = blocks.partition_point(|block| block.first + block.len <= unknown);
        let within = blocks.get(index).map_or(0, |block| {
            (unknown - block.first) * self.pattern.height(index)
        });
        self.pattern.first_value[index] + within
    }

    /// Adds the blocks of one particle to the slice of values that begins at `start`.
    fn add_particle(
        &self,
        particle: usize,
        trial: &Trial<D>,
        linearised: &mut Linearised<D>,
        codes: &mut Vec<usize>,
        start: usize,
        slice: &mut [f64],
    ) {
        let supports = self.stencils.of(particle);
        linearised.set(
            supports,
            &trial.particles[particle],
            self.reference_volume(particle),
            self.method.kinematics,
        );
        codes.clear();
        codes.extend(supports.iter().map(|support| self.code(support.node)));
        for (j, column) in supports.iter().enumerate() {
            if self.unknowns.of(column.node).next().is_none() {
                continue;
            }
            for (i, row) in supports.iter().enumerate() {
                if self.unknowns.of(row.node).next().is_none() {
                    continue;
                }
                let offset = self.table.offset(column.node, codes[j], codes[i]);
                let block = linearised.block(i, j);
                for (c, unknown) in self.unknowns.of(column.node) {
                    let first = self.first_value(unknown) + offset - start;
                    for (rank, (a, _)) in self.unknowns.of(row.node).enumerate() {
                        slice[first + rank] += block[a][c];
                    }
                }
            }
        }
    }

    /// The change of internal force K_fp u_p by unknown that the prescribed step displacements
    /// cause, with the tangent of a trial: the part of the first correction that is known.
    pub fn force_of_prescribed_motion(&self, trial: &Trial<D>) -> Vec<f64> {
        let mut force = vec![0.0; self.unknowns.len()];
        let constraints = &self.conditions.constraints;
        let mut linearised = Linearised::default();
        for particle in 0..self.particles.len() {
            let supports = self.stencils.of(particle);
            let moves = |node: usize| {
                (0..D).any(|axis| constraints.of(node, axis).is_some_and(|value| value != 0.0))
            };
            if !supports.iter().any(|support| moves(support.node)) {
                continue;
            }
            linearised.set(
                supports,
                &trial.particles[particle],
                self.reference_volume(particle),
                self.method.kinematics,
            );
            for (j, column) in supports.iter().enumerate() {
                for (i, row) in supports.iter().enumerate() {
                    let block = linearised.block(i, j);
                    for (a, unknown) in self.unknowns.of(row.node) {
                        for c in 0..D {
                            let value = constraints.of(column.node, c).unwrap_or(0.0);
                            force[unknown] += block[a][c] * value;
                        }
                    }
                }
            }
        }
        for entry in &self.couplings {
            for (axis, unknown) in self.unknowns.of(entry.row) {
                let value = constraints.of(entry.column, axis).unwrap_or(0.0);
                force[unknown] += entry.stiffness * value;
            }
        }
        force
    }

    /// Nodal step displacements that carry the prescribed motion and zeros elsewhere \[length\].
    pub fn prescribed_motion(&self) -> Vec<[f64; D]> {
        (0..self.conditions.grid.node_count())
            .map(|node| {
                std::array::from_fn(|axis| {
                    self.conditions.constraints.of(node, axis).unwrap_or(0.0)
                })
            })
            .collect()
    }

    /// Adds a correction by unknown to nodal displacements; tied nodes follow their masters.
    pub fn add_correction(&self, u: &mut [[f64; D]], du: &[f64]) {
        for (node, displacement) in u.iter_mut().enumerate() {
            for axis in 0..D {
                if let Some(unknown) = self.unknowns.index(node, axis) {
                    displacement[axis] += du[unknown];
                }
            }
        }
        for (&node, &master) in self.stencils.masters() {
            u[node] = u[master];
        }
    }

    /// The volume that a particle's stress is multiplied by: V_0 with Kirchhoff stress in finite
    /// strain, V at the step's start with Cauchy stress in small strain.
    fn reference_volume(&self, particle: usize) -> f64 {
        match self.method.kinematics {
            Kinematics::FiniteStrain => self.particles.volume0[particle],
            Kinematics::SmallStrain => self.particles.volume(particle),
        }
    }

    fn code(&self, node: usize) -> usize {
        self.table.code(&self.conditions.grid.node_place(node))
    }
}
