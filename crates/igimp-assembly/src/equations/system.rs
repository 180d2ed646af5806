//! The equilibrium of one step: residual and tangent at a trial displacement.

use std::borrow::Cow;
use std::sync::Arc;

use igimp_linear::{Border, Pattern, TangentMatrix};
use igimp_material::{MaterialError, TangentKind};

use crate::body::particles::Particles;
use crate::conditions::StepConditions;
use crate::conditions::loads::{LoadPoint, finite_points};
use crate::conditions::rigid_motion::{Drive, RigidMotion, rotations};
use crate::contributions::consolidation::{Consolidation, PoresAfter, pressure_nodes};
use crate::contributions::couplings::Couplings;
use crate::contributions::ghost::ghost_penalty;
use crate::contributions::inertia::{Inertia, Motion};
use crate::contributions::loads::{
    add_force_of_points, add_unbalanced_forces, add_variation_of_weight, nodal_drag, weight,
};
use crate::contributions::nodal_forces::NodalForces;
use crate::contributions::nonlocal::{NonlocalStrain, strain_nodes};
use crate::contributions::pore_water::Pores;
use crate::contributions::reinforcement::{Members, Reinforcement};
use crate::contributions::rigid::{
    AcceptedContact, Contact, NODES_PER_BODY, Penetration, RigidBody,
};
use crate::contributions::walls::{TieForce, WallForces};
use crate::equations::blocks::BlockTable;
use crate::equations::damping::StiffnessDamping;
use crate::equations::kinematics::{Linearisation, ParticleTrial};
use crate::equations::linearised::{Linearised, Moduli};
use crate::equations::residual::{OutOfBalance, force_of_round_off};
use crate::equations::trial::Trial;
use crate::error::AssemblyError;
use crate::method::{Kinematics, Method};
use crate::step::stencils::Stencils;
use crate::step::unknowns::Unknowns;

/// The force of acceleration below which a body is at rest, over the round-off of forces \[-\].
const AT_REST: f64 = 100.0;

/// One step's system of equations. Borrows the state at the step's start and never changes it.
#[derive(Debug)]
pub struct System<'a, const D: usize> {
    pub(crate) particles: &'a Particles<D>,
    pub(crate) stencils: &'a Stencils<D>,
    pub(crate) conditions: Cow<'a, StepConditions<D>>,
    pub(crate) method: &'a Method,
    pub(crate) unknowns: Unknowns<D>,
    pub(crate) f_ext: Vec<[f64; D]>,
    /// By node that stands for the motion of a rigid body.
    motions: Vec<[Drive; D]>,
    /// ‖f_int‖ of strains that are round-off \[force\].
    round_off: f64,
    /// Ghost penalty and drag.
    couplings: [Couplings; 2],
    contact: Contact<'a, D>,
    reinforcement: Members<'a, D>,
    /// Walls behind which the ground goes on.
    pub(crate) walls: WallForces<D>,
    /// Inertia of a step that takes time.
    pub(crate) inertia: Option<Inertia<D>>,
    /// Damping by the elastic stiffness, in a step that takes time.
    pub(crate) damping: Option<StiffnessDamping>,
    pub(crate) pores: Pores,
    /// Excess pore pressure as an unknown, in a step in which water flows.
    pub(crate) consolidation: Consolidation<D>,
    /// Nonlocal strain as an unknown, in a step whose soil softens over a length.
    pub(crate) nonlocal: NonlocalStrain<D>,
    pub(crate) table: BlockTable<D>,
    pub(crate) pattern: Arc<Pattern>,
    symmetric: bool,
    /// Whether the tangents of all particles are symmetric.
    pub(crate) symmetric_particles: bool,
}

impl<'a, const D: usize> System<'a, D> {
    /// Sets up the unknowns, the external force and the sparsity pattern of a step of a body that no
    /// loaded points act on.
    ///
    /// # Errors
    /// [`AssemblyError::NoUnknowns`], [`AssemblyError::OtherGrid`] for constraints that were made for
    /// another grid, [`AssemblyError::UnknownLaw`] of a particle whose law is not there, or
    /// [`AssemblyError::NonFinite`] for loads and a ghost penalty that are not finite.
    pub fn new(
        particles: &'a Particles<D>,
        stencils: &'a Stencils<D>,
        conditions: &'a StepConditions<D>,
        method: &'a Method,
    ) -> Result<Self, AssemblyError> {
        Self::with_rigid_bodies(particles, &[], stencils, conditions, method)
    }

    /// The same for a body that rigid bodies touch.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_rigid_bodies(
        particles: &'a Particles<D>,
        bodies: &'a [RigidBody<D>],
        stencils: &'a Stencils<D>,
        conditions: &'a StepConditions<D>,
        method: &'a Method,
    ) -> Result<Self, AssemblyError> {
        Self::with_structures(particles, (bodies, &[]), stencils, conditions, method)
    }

    /// The same for a body that rigid bodies touch and reinforcement goes through.
    ///
    /// # Errors
    /// As [`Self::new`], and [`AssemblyError::UnsupportedReinforcement`] for reinforcement without soil.
    pub fn with_structures(
        particles: &'a Particles<D>,
        (bodies, members): (&'a [RigidBody<D>], &'a [Reinforcement<D>]),
        stencils: &'a Stencils<D>,
        conditions: &'a StepConditions<D>,
        method: &'a Method,
    ) -> Result<Self, AssemblyError> {
        conditions.validate(particles)?;
        let symmetric_particles = are_symmetric(particles, conditions);
        let grid = &conditions.grid;
        let cuts = method.small_cuts;
        if !cuts.ghost_penalty.is_finite() {
            let (what, index) = ("ghost penalty", 0);
            return Err(AssemblyError::NonFinite { what, index });
        }
        let motions = nodal_motions(bodies, conditions);
        let free: Vec<[bool; D]> = motions
            .iter()
            .map(|motion| motion.map(|drive| matches!(drive, Drive::Loaded(_))))
            .collect();
        let constraints = &conditions.constraints;
        let mut has_scalar = strain_nodes(particles, stencils, conditions)?;
        if has_scalar.is_empty() {
            has_scalar = pressure_nodes(particles, stencils, conditions);
        }
        let below = cuts.below;
        let unknowns = Unknowns::number(grid, stencils, constraints, below, &free, &has_scalar)?;
        let young = |particle: usize| particles.young(particle, &conditions.laws);
        let couplings = [
            ghost_penalty(grid, particles, stencils, young, cuts.ghost_penalty),
            nodal_drag(grid, stencils, conditions.loads.drag),
        ];
        let contact = Contact::find(bodies, particles, stencils, conditions, &unknowns);
        let reinforcement = Members::find(members, stencils, conditions, method, &unknowns)?;
        let (mut f_ext, pores) = external_force(particles, stencils, conditions, method, &motions)?;
        f_ext.resize(f_ext.len() + unknowns.scalar_count(), [0.0; D]);
        let of_step = (conditions, method);
        let consolidation =
            Consolidation::find(particles, bodies, stencils, of_step, &unknowns, &pores)?;
        let mass_of = |particle: usize| particles.mass[particle] + pores.mass(particle);
        let walls = WallForces::find(particles, stencils, conditions, &unknowns, &mass_of);
        let forces = beside_particles(&couplings, &contact, &reinforcement, &walls, &consolidation);
        let pairs: Vec<_> = forces.iter().flat_map(|force| force.pairs()).collect();
        let symmetric = symmetric_particles && forces.iter().all(|force| force.is_symmetric());
        let (table, pattern) = BlockTable::build(grid, stencils, &unknowns, &pairs);
        Ok(Self {
            particles,
            stencils,
            conditions: Cow::Borrowed(conditions),
            method,
            f_ext,
            round_off: force_of_round_off(particles, stencils, conditions),
            couplings,
            contact,
            reinforcement,
            walls,
            inertia: None,
            damping: None,
            pores,
            consolidation,
            nonlocal: NonlocalStrain::find(conditions, &unknowns),
            unknowns,
            motions,
            table,
            pattern: Arc::new(pattern),
            symmetric,
            symmetric_particles,
        })
    }

    /// The same with the forces of loaded points.
    ///
    /// # Errors
    /// [`AssemblyError::LoadPoint`] or [`AssemblyError::UnsupportedLoad`] for a point off the body,
    /// [`AssemblyError::NonFinite`] for one that is not finite.
    pub fn with_load_points(mut self, points: &[LoadPoint<D>]) -> Result<Self, AssemblyError> {
        finite_points(points)?;
        add_force_of_points(
            &mut self.f_ext,
            points,
            &self.conditions,
            self.stencils,
            &self.unknowns,
        )?;
        Ok(self)
    }

    /// The same in motion, where the step takes time: with the inertia of particles and rigid bodies, and the forces that the
    /// step begins with. Loads act by now.
    ///
    /// # Errors
    /// [`AssemblyError::MotionNotFound`]; as [`Self::evaluate_into`].
    pub fn in_motion(mut self) -> Result<Self, AssemblyError> {
        let Some(time) = self.conditions.time else {
            return Ok(self);
        };
        let mass_of = |particle: usize| self.particles.mass[particle] + self.pores.mass(particle);
        let mut inertia = Inertia::of(
            time,
            self.particles,
            self.contact.bodies(),
            self.stencils,
            &self.unknowns,
            &mass_of,
        )?;
        self.act_by_ground(&mut inertia);
        let damping = self.stiffness_damping()?;
        let first = self.conditions.grid.node_count();
        for (index, body) in self.contact.bodies().iter().enumerate() {
            let gyroscopic = body.gyroscopic_force();
            for (axis, force) in gyroscopic.into_iter().enumerate() {
                self.f_ext[first + NODES_PER_BODY * index + 1][axis] += force;
            }
        }
        if time.asks_for_force_at_start() {
            let still = vec![[0.0; D]; self.node_count()];
            let mut force = self.evaluate(&still, TangentKind::Elastic)?.f_int;
            for (force, f_ext) in force.iter_mut().zip(&self.f_ext) {
                *force = std::array::from_fn(|axis| force[axis] - f_ext[axis]);
            }
            let of_start = self.forces_of_start(&inertia, damping.as_ref());
            for (force, of_start) in force.iter_mut().zip(&of_start) {
                *force = std::array::from_fn(|axis| force[axis] + of_start[axis]);
            }
            inertia.begin(force, &self.unknowns)?;
        }
        self.walls.set_in_motion(&inertia);
        self.damping = damping;
        self.round_off += inertia.round_off();
        self.inertia = Some(inertia);
        Ok(self)
    }

    /// Exchanges what acts on the body and its laws for those of other `conditions`, with the forces of the loaded
    /// `points`: grid, supports, prescribed motion and contact stay as the step began with them.
    ///
    /// # Errors
    /// As [`Self::new`] and [`Self::with_load_points`].
    pub fn exchange(
        &mut self,
        conditions: StepConditions<D>,
        points: &[LoadPoint<D>],
    ) -> Result<(), AssemblyError> {
        conditions.validate(self.particles)?;
        self.symmetric_particles = are_symmetric(self.particles, &conditions);
        let forces = beside_particles(
            &self.couplings,
            &self.contact,
            &self.reinforcement,
            &self.walls,
            &self.consolidation,
        );
        self.symmetric =
            self.symmetric_particles && forces.iter().all(|force| force.is_symmetric());
        self.reinforcement.control(&conditions.reinforcement);
        self.motions = nodal_motions(self.contact.bodies(), &conditions);
        let (mut f_ext, pores) = external_force(
            self.particles,
            self.stencils,
            &conditions,
            self.method,
            &self.motions,
        )?;
        f_ext.resize(self.f_ext.len(), [0.0; D]);
        add_force_of_points(
            &mut f_ext,
            points,
            &conditions,
            self.stencils,
            &self.unknowns,
        )?;
        (self.f_ext, self.pores) = (f_ext, pores);
        self.conditions = Cow::Owned(conditions);
        Ok(())
    }

    /// What holds during the step.
    pub fn conditions(&self) -> &StepConditions<D> {
        &self.conditions
    }

    /// External force by unknown \[force\].
    pub fn external_force_by_unknown(&self) -> Vec<f64> {
        self.by_unknown(&self.f_ext)
    }

    /// Values by node as values by unknown.
    pub fn by_unknown(&self, values: &[[f64; D]]) -> Vec<f64> {
        let mut out = vec![0.0; self.unknowns.len()];
        for (node, values) in values.iter().enumerate() {
            for (axis, value) in values.iter().enumerate() {
                if let Some(unknown) = self.unknowns.index(node, axis) {
                    out[unknown] = *value;
                }
            }
        }
        out
    }

    /// The same with an earlier pattern in place of its own, if they are equal: solvers keep their
    /// symbolic work while they see the same one.
    #[must_use]
    pub fn sharing(mut self, earlier: Option<&Arc<Pattern>>) -> Self {
        if let Some(earlier) = earlier.filter(|earlier| ***earlier == *self.pattern) {
            self.pattern = Arc::clone(earlier);
        }
        self
    }

    /// The unknowns.
    pub fn unknowns(&self) -> &Unknowns<D> {
        &self.unknowns
    }

    /// The sparsity pattern of the tangent matrix.
    pub fn pattern(&self) -> &Arc<Pattern> {
        &self.pattern
    }

    /// Whether soil resists alone and its flow is not associated: its tangents are not symmetric, and no rigid body
    /// takes hold of it or lets go.
    pub fn flows_without_potential(&self) -> bool {
        !self.symmetric_particles && self.motions.is_empty()
    }

    /// Whether soil moves whose flow is not associated.
    pub fn moves_without_potential(&self) -> bool {
        !self.symmetric_particles && self.inertia.is_some()
    }

    /// Whether strength softens with the plastic strain of the ground around, which is among the unknowns.
    pub fn softens_over_a_length(&self) -> bool {
        self.nonlocal.is_solved_for()
    }

    /// Whether soil may touch a rigid body in this step.
    pub fn touches_bodies(&self) -> bool {
        (0..self.contact.bodies().len()).any(|body| self.contact.may_touch(body))
    }

    /// External force by node \[force\].
    pub fn f_ext(&self) -> &[[f64; D]] {
        &self.f_ext
    }

    /// Stress and internal force at nodal step displacements `u` \[length\].
    ///
    /// # Errors
    /// As [`Self::evaluate_into`].
    pub fn evaluate(&self, u: &[[f64; D]], kind: TangentKind) -> Result<Trial<D>, AssemblyError> {
        let mut trial = Trial::default();
        self.evaluate_into(u, kind, &mut trial)?;
        Ok(trial)
    }

    /// Stress, internal force and the tangent matrix K = ∂f_int/∂u at nodal step displacements `u`
    /// \[length\].
    ///
    /// # Errors
    /// As [`Self::evaluate_into`].
    pub fn linearise(
        &self,
        u: &[[f64; D]],
        kind: TangentKind,
    ) -> Result<(Trial<D>, TangentMatrix), AssemblyError> {
        let mut trial = Trial::default();
        let mut matrix = self.matrix_from(None);
        self.linearise_into(u, kind, &mut trial, &mut matrix)?;
        Ok((trial, matrix))
    }

    /// Sets `trial` to nodal step displacements `u` \[length\]: stress and internal force.
    ///
    /// # Errors
    /// [`AssemblyError::Inverted`] or [`AssemblyError::Material`] of a particle that fails: of
    /// several always the same one. The trial is then of no use.
    pub fn evaluate_into(
        &self,
        u: &[[f64; D]],
        kind: TangentKind,
        trial: &mut Trial<D>,
    ) -> Result<(), AssemblyError> {
        self.pass(u, kind, trial, None)?;
        for force in self.forces() {
            force.add(u, &mut trial.f_int, None);
        }
        let inertia = self.inertia.as_ref();
        trial.inertia = inertia.map_or(0.0, |own| own.add(u, &mut trial.f_int, None));
        self.add_damping(u, &mut trial.f_int, None);
        Ok(())
    }

    /// Sets `trial` as [`Self::evaluate_into`] does and `matrix` to the tangent matrix, in the same
    /// pass over the particles.
    ///
    /// # Errors
    /// As [`Self::evaluate_into`].
    ///
    /// # Panics
    /// If the matrix has another pattern than this system.
    pub fn linearise_into(
        &self,
        u: &[[f64; D]],
        kind: TangentKind,
        trial: &mut Trial<D>,
        matrix: &mut TangentMatrix,
    ) -> Result<(), AssemblyError> {
        assert!(
            Arc::ptr_eq(&matrix.pattern, &self.pattern),
            "the matrix belongs to this step"
        );
        matrix.symmetric = self.symmetric;
        self.pass(u, kind, trial, Some(&mut matrix.values))?;
        let of_grid = self.unknowns.of_grid();
        matrix.border = Border::zeros(self.unknowns.len() - of_grid, of_grid);
        let TangentMatrix { values, border, .. } = matrix;
        let mut add_block = |row: usize, column: usize, block: &[[f64; D]; D]| {
            let [row_node, column_node] = [row, column].map(|node| self.unknowns.block_node(node));
            for (b, column_unknown) in self.unknowns.of(column) {
                for (a, row_unknown) in self.unknowns.of(row) {
                    if row_unknown < of_grid && column_unknown < of_grid {
                        let (row, column) = (row_node, column_node);
                        let component = column_unknown - self.unknowns.before(column);
                        let rank = row_unknown - self.unknowns.before(row);
                        let place = self.table.value(&self.pattern, column, component, row);
                        values[place + rank] += block[a][b];
                    } else {
                        border.add(of_grid, row_unknown, column_unknown, block[a][b]);
                    }
                }
            }
        };
        for force in self.forces() {
            force.add(u, &mut trial.f_int, Some(&mut add_block));
        }
        let inertia = self.inertia.as_ref();
        trial.inertia = inertia.map_or(0.0, |own| {
            own.add(u, &mut trial.f_int, Some(&mut add_block))
        });
        if let Some(inertia) = inertia {
            let place = |row, column, axis| self.place_of(row, column, axis);
            inertia.add_mass_of_soil(&mut matrix.values, &place);
        }
        self.add_damping(u, &mut trial.f_int, Some(&mut matrix.values));
        Ok(())
    }

    /// A matrix for [`Self::linearise_into`] in the memory of an earlier one: that one itself if its
    /// pattern still holds.
    pub fn matrix_from(&self, earlier: Option<TangentMatrix>) -> TangentMatrix {
        let mut values = earlier.map_or_else(Vec::new, |matrix| matrix.values);
        values.resize(self.pattern.stored(), 0.0);
        TangentMatrix {
            pattern: Arc::clone(&self.pattern),
            values,
            symmetric: self.symmetric,
            border: Border::default(),
        }
    }

    /// The out-of-balance force of a trial.
    ///
    /// # Errors
    /// [`AssemblyError::NonFinite`] when a nodal force is not finite.
    pub fn out_of_balance(&self, trial: &Trial<D>) -> Result<OutOfBalance, AssemblyError> {
        let mut residual = OutOfBalance::default();
        self.update_out_of_balance(&mut residual, trial)?;
        Ok(residual)
    }

    /// Rewrites the out-of-balance force with that of a trial.
    ///
    /// # Errors
    /// As [`Self::out_of_balance`].
    pub fn update_out_of_balance(
        &self,
        residual: &mut OutOfBalance,
        trial: &Trial<D>,
    ) -> Result<(), AssemblyError> {
        residual.update(&self.unknowns, &self.f_ext, trial, self.round_off)
    }

    /// The force f_int − f_ext by node of the grid that would keep a trial where it is, zero where nothing is unknown
    /// \[force\].
    pub fn holding_forces(&self, trial: &Trial<D>) -> Vec<[f64; D]> {
        (0..self.conditions.grid.node_count())
            .map(|node| {
                std::array::from_fn(|axis| match self.unknowns.index(node, axis) {
                    Some(_) => trial.f_int[node][axis] - self.f_ext[node][axis],
                    None => 0.0,
                })
            })
            .collect()
    }

    /// What a step with nodal values `u` leaves in the pores when it is accepted, for [`Particles::fill_pores`].
    pub fn into_pores(self, u: &[[f64; D]]) -> PoresAfter {
        let given = self.pores.pressure;
        self.consolidation.accepted(self.stencils, u, given)
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

    /// The force that dropped nodes take without a support, as a share of the load \[-\] (theory,
    /// eq. 27b): of [`Self::reactions`], those of components that nothing prescribes.
    pub fn false_support(&self, reactions: &[[f64; D]]) -> f64 {
        let (mut held, mut unheld) = (0.0, 0.0);
        for (node, reaction) in reactions.iter().enumerate() {
            for axis in 0..D {
                match self.prescribed(node, axis) {
                    Some(_) => held += reaction[axis].abs(),
                    None => unheld += reaction[axis].abs(),
                }
            }
        }
        let external: f64 = self.f_ext.as_flattened().iter().map(|f| f.abs()).sum();
        if unheld == 0.0 {
            0.0
        } else {
            unheld / external.max(held)
        }
    }

    /// The norm of the drag at nodal step displacements over that of the external force: the share
    /// of the load that motion carries \[-\].
    pub fn drag_share(&self, u: &[[f64; D]]) -> f64 {
        let mut drag = 0.0;
        for (node, u) in u.iter().enumerate().take(self.conditions.grid.node_count()) {
            let stiffness = self.conditions.loads.drag * self.stencils.node_mass(node);
            for component in u {
                drag += (stiffness * component).powi(2);
            }
        }
        let external: f64 = self.f_ext.iter().flatten().map(|force| force * force).sum();
        if drag == 0.0 {
            0.0
        } else {
            (drag / external).sqrt()
        }
    }

    /// The change of internal force K_fp u_p by unknown that the prescribed step displacements
    /// cause \[force\], with the tangent at nodal step displacements `u` \[length\]: the part of the first
    /// correction that is known (theory, eq. 25).
    ///
    /// # Errors
    /// As [`Self::evaluate_into`].
    pub fn force_of_prescribed_motion(
        &self,
        u: &[[f64; D]],
        kind: TangentKind,
    ) -> Result<Vec<f64>, AssemblyError> {
        let mut force = vec![0.0; self.unknowns.len()];
        let moves = |node: usize| {
            (0..D).any(|axis| {
                self.prescribed(node, axis)
                    .is_some_and(|value| value != 0.0)
            })
        };
        let mut trial = ParticleTrial::at_rest();
        let mut linearised = Linearised::default();
        for particle in 0..self.particles.len() {
            let supports = self.stencils.of(particle);
            if !supports.iter().any(|support| moves(support.node)) {
                continue;
            }
            let own = self.evaluate_particle(particle, u, kind, &mut trial)?;
            let volume = self.reference_volume(particle);
            linearised.push(supports, &own);
            self.add_scalars_of_motion(particle, (&own, &linearised), u, &mut force);
            let kinematics = self.method.kinematics_of_step();
            linearised.linearise(&Moduli::of(&own, volume, kinematics));
            for (j, column) in supports.iter().enumerate() {
                if !moves(column.node) {
                    continue;
                }
                let columns = linearised.columns(j);
                for (i, row) in supports.iter().enumerate() {
                    for (a, unknown) in self.unknowns.of(row.node) {
                        for c in 0..D {
                            let value = self.prescribed(column.node, c).unwrap_or(0.0);
                            force[unknown] += columns[c][i * D + a] * value;
                        }
                    }
                }
            }
        }
        let mut add_block = |row: usize, column: usize, block: &[[f64; D]; D]| {
            for (a, unknown) in self.unknowns.of(row) {
                for (b, entry) in block[a].iter().enumerate() {
                    force[unknown] += entry * self.prescribed(column, b).unwrap_or(0.0);
                }
            }
        };
        let mut unused = vec![[0.0; D]; u.len()];
        for own in self.forces() {
            own.add(u, &mut unused, Some(&mut add_block));
        }
        if let Some(inertia) = &self.inertia {
            inertia.add(u, &mut unused, Some(&mut add_block));
        }
        Ok(force)
    }

    /// Adds what the prescribed step displacements do to the scalars of a particle, by unknown \[force\].
    fn add_scalars_of_motion(
        &self,
        particle: usize,
        (own, linearised): (&Linearisation<D>, &Linearised<D>),
        u: &[[f64; D]],
        force: &mut [f64],
    ) {
        let supports = self.stencils.of(particle);
        let moved = |node: usize, axis: usize| self.prescribed(node, axis).unwrap_or(0.0);
        let first = self.unknowns.first_scalar();
        let mut add = |place: usize, by: f64| {
            if let Some(unknown) = self.unknowns.index(first + place, 0) {
                force[unknown] += by;
            }
        };
        if let Some(water) = self.consolidation.of_particle(particle, supports, u) {
            water.add_force_of_motion(supports, &moved, &mut add);
        }
        if let Some(strain) = self.strain_of_particle(particle, own, u) {
            let gradients = (linearised.g(), linearised.g_bar());
            strain.add_force_of_motion(supports, gradients, &moved, &mut add);
        }
    }

    /// The first particle whose law answers a tangent that is not finite at nodal step
    /// displacements `u` \[length\], as an error that names it. A pass over all particles, for when
    /// a matrix was found not to be finite.
    ///
    /// # Errors
    /// [`AssemblyError::Material`]; those of [`Self::evaluate_into`].
    pub fn finite_tangents(&self, u: &[[f64; D]], kind: TangentKind) -> Result<(), AssemblyError> {
        let mut trial = ParticleTrial::at_rest();
        for particle in 0..self.particles.len() {
            let own = self.evaluate_particle(particle, u, kind, &mut trial)?;
            if !own.lifted.tangent().is_finite() {
                let quantity = "tangent";
                let source = MaterialError::NonFinite { quantity };
                return Err(AssemblyError::Material { particle, source });
            }
        }
        Ok(())
    }

    /// Nodal step displacements that carry the prescribed motion and zeros elsewhere \[length\].
    pub fn prescribed_motion(&self) -> Vec<[f64; D]> {
        (0..self.node_count())
            .map(|node| std::array::from_fn(|axis| self.prescribed(node, axis).unwrap_or(0.0)))
            .collect()
    }

    /// Number of nodes: those of the grid, two behind them for the motion of each rigid body, and one for each scalar
    /// that is unknown: pore pressure or nonlocal strain.
    pub fn node_count(&self) -> usize {
        self.unknowns.first_scalar() + self.unknowns.scalar_count()
    }

    /// Where a node stands \[length\]; one that stands for a rigid body at its reference point, one for a scalar where its
    /// node of the grid is.
    pub fn node_position(&self, node: usize) -> [f64; D] {
        let node = self.unknowns.block_node(node);
        let of_grid = self.conditions.grid.node_count();
        match node.checked_sub(of_grid) {
            Some(beyond) => self.contact.body(beyond / NODES_PER_BODY).pose.origin,
            None => self.conditions.grid.node_position(node),
        }
    }

    /// Whether any node or body is made to move.
    pub fn prescribes_motion(&self) -> bool {
        let moves = |drive: &Drive| matches!(drive, Drive::Moved(by) if *by != 0.0);
        self.conditions.constraints.prescribe_motion() || self.motions.iter().flatten().any(moves)
    }

    /// The prescribed step displacement of a node along an axis \[length\], if any. The rotation of a body
    /// counts as the displacement at a distance of its size.
    fn prescribed(&self, node: usize, axis: usize) -> Option<f64> {
        let of_grid = self.conditions.grid.node_count();
        let Some(beyond) = node.checked_sub(of_grid) else {
            return self.conditions.constraints.of(node, axis);
        };
        match self.motions.get(beyond)?[axis] {
            Drive::Moved(by) => Some(by),
            Drive::Loaded(_) => None,
        }
    }

    /// The rigid body that a node stands for, with the component of its motion along an axis: displacements
    /// along the axes, then rotations; and whether any soil can touch it in this step.
    pub fn rigid_body_of(&self, node: usize, axis: usize) -> Option<(&RigidBody<D>, usize, bool)> {
        let beyond = node.checked_sub(self.conditions.grid.node_count())?;
        if beyond >= self.motions.len() {
            return None;
        }
        let index = beyond / NODES_PER_BODY;
        let component = axis + D * (beyond % NODES_PER_BODY);
        let touches = self.contact.may_touch(index);
        Some((self.contact.body(index), component, touches))
    }

    /// What a step with nodal step displacements `u` \[length\] leaves of contact when it is accepted: the
    /// bodies at their new places, and the way back of particles whose centres came closer to one than half
    /// of their seeded half-length, for [`Particles::push_out`]. All particles are looked at, with
    /// the way that they took. On a given geometry nothing moves, and none is put back.
    ///
    /// # Errors
    /// [`Penetration`] for a particle whose centre would be in a body deeper than its seeded
    /// half-length, or was so on its way.
    pub fn bodies_at(&self, u: &[[f64; D]]) -> Result<AcceptedContact<D>, Penetration> {
        let Self {
            particles,
            stencils,
            method,
            ..
        } = self;
        let mut contact = self
            .contact
            .accepted(u, particles, stencils, method.geometry)?;
        if let Some(motion) = self.motion(u) {
            let of_grid = self.conditions.grid.node_count();
            let velocities = motion.after[of_grid..].as_chunks().0;
            let accelerations = motion.acceleration[of_grid..].as_chunks().0;
            let nodes = std::iter::zip(velocities, accelerations);
            for (body, (velocity, acceleration)) in contact.bodies.iter_mut().zip(nodes) {
                body.accelerate(velocity, acceleration);
            }
        }
        Ok(contact)
    }

    /// Nodal step displacements of a motion that goes on as it is at the start, where they are unknown; none in statics \[length\].
    pub fn predicted_motion(&self) -> Option<Vec<[f64; D]>> {
        let predicted = self.inertia.as_ref()?.predicted();
        let mut u = vec![[0.0; D]; self.node_count()];
        self.add_correction(&mut u, &self.by_unknown(&predicted));
        Some(u)
    }

    /// The error of the time integration over a step by nodal displacements `u` \[length\], as a share of its motion \[-\]; none in
    /// statics.
    pub fn time_error(&self, u: &[[f64; D]]) -> Option<f64> {
        let negligible = AT_REST * self.round_off;
        (self.inertia.as_ref()).map(|inertia| inertia.error(u, negligible))
    }

    /// The error in time of a step with nodal values `u` in which water flows, as a share of its excess pore pressures \[-\]; none
    /// where none flows.
    pub fn flow_error(&self, trial: &Trial<D>, u: &[[f64; D]]) -> Option<f64> {
        let mean = |own: &ParticleTrial<D>| (own.tau[0][0] + own.tau[1][1] + own.tau[2][2]) / 3.0;
        let stress = trial.particles.iter().map(|own| mean(own).abs());
        self.consolidation.time_error(u, stress.fold(0.0, f64::max))
    }

    /// The forces that make the nodes of two walls move together over a step by nodal step displacements `u` \[length\].
    pub fn tie_forces(&self, u: &[[f64; D]]) -> Vec<TieForce<D>> {
        self.walls.of_ties(u)
    }

    /// How the nodes move over a step by nodal step displacements `u` \[length\], for [`Particles::accelerate`]; none in statics.
    pub fn motion(&self, u: &[[f64; D]]) -> Option<Motion<D>> {
        self.inertia.as_ref().map(|inertia| inertia.motion(u))
    }

    /// The reinforcement as a step with nodal step displacements `u` \[length\] leaves it when it is
    /// accepted.
    pub fn reinforcement_at(&self, u: &[[f64; D]]) -> Vec<Reinforcement<D>> {
        self.reinforcement.accepted(u)
    }

    /// The work of the external force on nodal step displacements `u` where they are unknown \[force·length\].
    pub fn work_of_loads(&self, u: &[[f64; D]]) -> f64 {
        let (force, u) = (self.external_force_by_unknown(), self.by_unknown(u));
        force.iter().zip(u).map(|(force, u)| force * u).sum()
    }

    /// The gross work of the external force on nodal step displacements `u` \[force·length\]: the sum of what its
    /// components do, by magnitude. It is not zero where as much rises as falls.
    pub fn gross_work_of_loads(&self, u: &[[f64; D]]) -> f64 {
        let (force, u) = (self.force_along(u), self.by_unknown(u));
        force.iter().zip(u).map(|(force, u)| force * u).sum()
    }

    /// The external force by unknown \[force\], each component with the sign of nodal displacements `u` \[length\]: its
    /// product with them is their gross work.
    pub fn force_along(&self, u: &[[f64; D]]) -> Vec<f64> {
        let mut force = self.external_force_by_unknown();
        for (force, u) in force.iter_mut().zip(self.by_unknown(u)) {
            *force = force.abs().copysign(u);
        }
        force
    }

    /// The work of reinforcement on the stretch of the step, and its elastic part \[force·length\].
    pub(crate) fn work_of_reinforcement(&self, u: &[[f64; D]]) -> [f64; 2] {
        self.reinforcement.work(u)
    }

    /// The forces beside those of particles and of acceleration.
    pub(crate) fn forces(&self) -> [&dyn NodalForces<D>; 6] {
        beside_particles(
            &self.couplings,
            &self.contact,
            &self.reinforcement,
            &self.walls,
            &self.consolidation,
        )
    }

    /// Adds a correction `du` by unknown to nodal displacements `u` \[length\]; tied nodes follow those
    /// that they move with.
    pub fn add_correction(&self, u: &mut [[f64; D]], du: &[f64]) {
        for (node, displacement) in u.iter_mut().enumerate() {
            for axis in 0..D {
                if let Some(unknown) = self.unknowns.index(node, axis) {
                    displacement[axis] += du[unknown];
                }
            }
        }
        for (&node, carriers) in self.stencils.ties() {
            u[node] = std::array::from_fn(|axis| {
                let moved = carriers.iter().map(|own| own.weight * u[own.node][axis]);
                moved.reduce(|sum, own| sum + own).unwrap_or(0.0)
            });
        }
    }

    /// The volume that a particle's stress is multiplied by: V_0 with Kirchhoff stress in finite
    /// strain, V at the step's start with Cauchy stress in small strain.
    pub(crate) fn reference_volume(&self, particle: usize) -> f64 {
        match self.method.kinematics {
            Kinematics::FiniteStrain => self.particles.volume0[particle],
            Kinematics::SmallStrain => self.particles.volume(particle),
        }
    }
}

/// Whether the tangents of all particles are symmetric.
fn are_symmetric<const D: usize>(particles: &Particles<D>, conditions: &StepConditions<D>) -> bool {
    let mut used = vec![false; conditions.laws.len()];
    for &law in &particles.law {
        used[law] = true;
    }
    std::iter::zip(&conditions.laws, &used).all(|(law, &used)| !used || law.has_symmetric_tangent())
}

/// External force by node without loaded points \[force\], and the water in the pores.
fn external_force<const D: usize>(
    particles: &Particles<D>,
    stencils: &Stencils<D>,
    conditions: &StepConditions<D>,
    method: &Method,
    motions: &[[Drive; D]],
) -> Result<(Vec<[f64; D]>, Pores), AssemblyError> {
    let mut f_ext = weight(&conditions.grid, stencils, &conditions.loads);
    let gravity = &conditions.loads.gravity;
    add_variation_of_weight(stencils, &conditions.laws, gravity, &mut f_ext);
    let pores = Pores::fill(particles, stencils, conditions, method, &mut f_ext)?;
    if let Some(held) = &conditions.held {
        add_unbalanced_forces(held, stencils, &mut f_ext);
    }
    f_ext.extend(motions.iter().map(|motion| {
        motion.map(|drive| match drive {
            Drive::Loaded(force) => force,
            Drive::Moved(_) => 0.0,
        })
    }));
    Ok((f_ext, pores))
}

/// Ghost penalty, drag, contact, reinforcement, walls and flow, in the order in which they are summed.
fn beside_particles<'s, const D: usize>(
    [ghost, drag]: &'s [Couplings; 2],
    contact: &'s Contact<'_, D>,
    reinforcement: &'s Members<'_, D>,
    walls: &'s WallForces<D>,
    consolidation: &'s Consolidation<D>,
) -> [&'s dyn NodalForces<D>; 6] {
    [ghost, drag, contact, reinforcement, walls, consolidation]
}

/// What drives the nodes that stand for rigid bodies: two for each, displacement and rotation, the
/// latter in lengths: times the size of the body, and moments divided by it.
fn nodal_motions<const D: usize>(
    bodies: &[RigidBody<D>],
    conditions: &StepConditions<D>,
) -> Vec<[Drive; D]> {
    let mut motions = Vec::with_capacity(NODES_PER_BODY * bodies.len());
    for (index, body) in bodies.iter().enumerate() {
        let held = RigidMotion::held();
        let motion = conditions.motions.get(index).unwrap_or(&held);
        let size = body.surface.size();
        motions.push(motion.displacement);
        motions.push(std::array::from_fn(|axis| match motion.rotation[axis] {
            _ if axis >= rotations(D) => Drive::Moved(0.0),
            Drive::Moved(angle) => Drive::Moved(angle * size),
            Drive::Loaded(moment) => Drive::Loaded(moment / size),
        }));
    }
    motions
}
