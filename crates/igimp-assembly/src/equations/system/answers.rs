//! Results of a step at equilibrium beside stress: reactions, works, and states of structures and water.

use super::System;
use crate::contributions::consolidation::PoresAfter;
use crate::contributions::inertia::{Inertia, Motion};
use crate::contributions::reinforcement::Reinforcement;
use crate::contributions::rigid::AcceptedContact;
use crate::contributions::walls::TieForce;
use crate::equations::kinematics::ParticleTrial;
use crate::equations::trial::Trial;
use igimp_rigid::{ContactChange, Penetration};

/// The force of acceleration below which a body is at rest, over the round-off of forces \[-\].
const AT_REST: f64 = 100.0;

impl<const D: usize> System<'_, D> {
    /// The reaction f_int − f_ext by node, zero at unknowns \[force\]; where motion is in equilibrium between start and end of a step,
    /// the one there (theory, eq. 61).
    pub fn reactions(&self, trial: &Trial<D>) -> Vec<[f64; D]> {
        // Forces of the step are over the weight of those at its end.
        let weight = (self.inertia.as_ref()).map_or(1.0, Inertia::weight_of_end);
        let mut reactions = vec![[0.0; D]; trial.f_int.len()];
        for (node, reaction) in reactions.iter_mut().enumerate() {
            for axis in 0..D {
                if self.unknowns.index(node, axis).is_none() {
                    let force = trial.f_int[node][axis] - self.loads.f_ext[node][axis];
                    reaction[axis] = weight * force;
                }
            }
        }
        reactions
    }

    /// Whether the grid took over means of the motion of the particles, as no motion that comes closest to it was found.
    pub fn moves_by_means(&self) -> bool {
        (self.inertia.as_ref()).is_some_and(Inertia::is_by_means)
    }

    /// The force f_int − f_ext by node of the grid that would keep a trial where it is, zero where nothing is unknown
    /// \[force\].
    pub fn holding_forces(&self, trial: &Trial<D>) -> Vec<[f64; D]> {
        (0..self.conditions.grid.node_count())
            .map(|node| {
                std::array::from_fn(|axis| match self.unknowns.index(node, axis) {
                    Some(_) => trial.f_int[node][axis] - self.loads.f_ext[node][axis],
                    None => 0.0,
                })
            })
            .collect()
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
        let external: f64 = self
            .loads
            .f_ext
            .as_flattened()
            .iter()
            .map(|f| f.abs())
            .sum();
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
        let external: f64 = self
            .loads
            .f_ext
            .iter()
            .flatten()
            .map(|force| force * force)
            .sum();
        if drag == 0.0 {
            0.0
        } else {
            (drag / external).sqrt()
        }
    }

    /// The work of the external force on nodal step displacements `u` where they are unknown \[force·length\].
    pub fn work_of_loads(&self, u: &[[f64; D]]) -> f64 {
        let (force, u) = (self.external_force_by_unknown(), self.by_unknown(u));
        force.iter().zip(u).map(|(force, u)| force * u).sum()
    }

    /// The gross work of the external force on nodal step displacements `u` \[force·length\]: the sum of the works of
    /// components, by magnitude. It is not zero where as much rises as falls.
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
        self.beside.reinforcement.work(u)
    }

    /// The forces that make the nodes of two walls move together over a step by nodal step displacements `u` \[length\].
    pub fn tie_forces(&self, u: &[[f64; D]]) -> Vec<TieForce<D>> {
        self.beside.walls.of_ties(u)
    }

    /// How the nodes move over a step by nodal step displacements `u` \[length\], for [`Particles::accelerate`](crate::Particles::accelerate); none in statics.
    pub fn motion(&self, u: &[[f64; D]]) -> Option<Motion<D>> {
        self.inertia.as_ref().map(|inertia| inertia.motion(u))
    }

    /// The error of the time integration over a step by nodal displacements `u` \[length\], as a share of its motion \[-\]; none in
    /// statics.
    pub fn time_error(&self, u: &[[f64; D]]) -> Option<f64> {
        let negligible = AT_REST * self.round_off;
        (self.inertia.as_ref()).map(|inertia| inertia.error(u, negligible))
    }

    /// How far soil came near to a rigid body in a step by nodal displacements `u` \[length\] where a gap closed, at most, in cells
    /// \[-\].
    pub fn closing(&self, u: &[[f64; D]]) -> f64 {
        self.beside.contact.closing(u)
    }

    /// By rigid body, changes of contact in a step by nodal displacements `u` \[length\]. Given motion counts as none; none in statics.
    pub fn changes_of_contact(&self, u: &[[f64; D]]) -> Vec<ContactChange> {
        let (Some(inertia), Some(free)) = (&self.inertia, self.predicted_motion()) else {
            return Vec::new();
        };
        let next = inertia.ways(&inertia.motion(u).after);
        self.beside.contact.changes(u, (&free, &next))
    }

    /// The error in time of a step with nodal values `u` in which water flows, as a share of its excess pore pressures \[-\]; none
    /// where none flows.
    pub fn flow_error(&self, trial: &Trial<D>, u: &[[f64; D]]) -> Option<f64> {
        let mean = |p: &ParticleTrial<D>| (p.tau[0][0] + p.tau[1][1] + p.tau[2][2]) / 3.0;
        let stress = trial.particles.iter().map(|p| mean(p).abs());
        self.beside
            .consolidation
            .time_error(u, stress.fold(0.0, f64::max))
    }

    /// State of contact after an accepted step with nodal step displacements `u` \[length\]: the
    /// bodies at their new places, and the way back of particles whose centres came closer to one than half
    /// of their seeded half-length, for [`Particles::push_out`](crate::Particles::push_out). All particles are looked at, with
    /// the way that they took. On a given geometry nothing moves, and none is put back.
    ///
    /// # Errors
    /// [`Penetration`] for a particle whose centre would be in a body deeper than its seeded
    /// half-length, or was so on its way, or would come up to it where the body saw no soil.
    pub fn bodies_at(&self, u: &[[f64; D]]) -> Result<AcceptedContact<D>, Penetration> {
        let Self {
            particles,
            stencils,
            method,
            ..
        } = self;
        let of_step = (*method, self.conditions.time.is_some());
        let contact = &self.beside.contact;
        let mut contact = contact.accepted(u, particles, stencils, of_step)?;
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

    /// The reinforcement as a step with nodal step displacements `u` \[length\] leaves it when it is
    /// accepted.
    pub fn reinforcement_at(&self, u: &[[f64; D]]) -> Vec<Reinforcement<D>> {
        self.beside.reinforcement.accepted(u)
    }

    /// State of the pores after an accepted step with nodal values `u`, for [`Particles::fill_pores`](crate::Particles::fill_pores).
    pub fn into_pores(self, u: &[[f64; D]]) -> PoresAfter {
        let given = self.loads.pores.pressure;
        self.beside.consolidation.accepted(self.stencils, u, given)
    }
}
