//! Forces beside inertia in a step that takes time: the motion of the ground, walls, and damping of soil
//! (theory, eqs. 69 to 75).

use igimp_material::TangentKind;

use crate::contributions::inertia::Inertia;
use crate::contributions::nodal_forces::NodalForces as _;
use crate::contributions::nodal_mass::product;
use crate::equations::damping::StiffnessDamping;
use crate::equations::system::System;
use crate::equations::trial::Trial;
use crate::error::AssemblyError;

/// The work of walls and of damping in a step \[force·length\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct WorkOfGround {
    /// Against dashpots and springs of walls, less that of the forces that they carry.
    pub(crate) boundaries: f64,
    /// Of the forces that walls carry: part of the work of the external force.
    pub(crate) carried: f64,
    /// Against damping of soil.
    pub(crate) damping: f64,
}

impl<const D: usize> System<'_, D> {
    /// Adds the motion of the ground and the forces that walls carry to the external force, and lets soil be damped by
    /// its mass.
    pub(crate) fn act_by_ground(&mut self, inertia: &mut Inertia<D>) {
        let conditions = &self.conditions;
        for wall in conditions.walls.iter().flat_map(|walls| walls.nodes.iter()) {
            for carrier in self.stencils.carriers(wall.node) {
                if self.stencils.node_volume(carrier.node) > 0.0 {
                    for a in 0..D {
                        self.loads.f_ext[carrier.node][a] += carrier.weight * wall.force[a];
                    }
                }
            }
        }
        if let Some(ground) = conditions.ground {
            let force = inertia.force_of(&self.uniform(&ground.acceleration));
            for (f_ext, force) in self.loads.f_ext.iter_mut().zip(force) {
                *f_ext = std::array::from_fn(|a| f_ext[a] - force[a]);
            }
        }
        inertia.damp(conditions.damping.map_or(0.0, |damping| damping.mass));
    }

    /// A motion of all nodes of the grid and of the centres of mass of rigid bodies, by node.
    fn uniform(&self, of_all: &[f64; D]) -> Vec<[f64; D]> {
        let of_grid = self.conditions.grid.node_count();
        (0..self.node_count())
            .map(|node| match node.checked_sub(of_grid) {
                Some(beyond) if beyond % 2 == 1 => [0.0; D],
                _ => *of_all,
            })
            .collect()
    }

    /// The internal forces by node as the step begins that differ from those as it ends: of dashpots and of damping
    /// \[force\].
    pub(crate) fn forces_of_start(
        &self,
        inertia: &Inertia<D>,
        damping: Option<&StiffnessDamping>,
    ) -> Vec<[f64; D]> {
        let mut force = vec![[0.0; D]; self.node_count()];
        self.beside
            .walls
            .add_at_start(inertia.velocity(), true, &mut force);
        let others = [
            inertia.damping_force(inertia.velocity()),
            self.force_of(damping, inertia.velocity()),
        ];
        for other in &others {
            for (force, other) in force.iter_mut().zip(other) {
                *force = std::array::from_fn(|a| force[a] + other[a]);
            }
        }
        force
    }

    /// Damping by the elastic stiffness of soil as it is now, if the conditions have some.
    ///
    /// # Errors
    /// As [`Self::evaluate_into`].
    pub(crate) fn stiffness_damping(&self) -> Result<Option<StiffnessDamping>, AssemblyError> {
        let (Some(damping), Some(time)) = (self.conditions.damping, self.conditions.time) else {
            return Ok(None);
        };
        if damping.stiffness == 0.0 {
            return Ok(None);
        }
        let mut stiffness = self.matrix_from(None);
        let still = vec![[0.0; D]; self.node_count()];
        let values = Some(&mut stiffness.values[..]);
        self.pass(&still, TangentKind::Elastic, &mut Trial::default(), values)?;
        Ok(Some(StiffnessDamping {
            factor: damping.stiffness,
            rate: time.velocity_rate(),
            stiffness,
        }))
    }

    /// The force β K_e v of velocities by node \[force\].
    fn force_of(&self, damping: Option<&StiffnessDamping>, velocity: &[[f64; D]]) -> Vec<[f64; D]> {
        let mut force = vec![[0.0; D]; velocity.len()];
        let Some(damping) = damping else {
            return force;
        };
        let of_grid = self.unknowns.of_grid();
        let velocity = self.by_unknown(velocity);
        let mut product = vec![0.0; of_grid];
        damping
            .stiffness
            .multiply(&velocity[..of_grid], &mut product);
        for (node, force) in (force.iter_mut())
            .enumerate()
            .take(self.unknowns.nodes_of_grid())
        {
            for (axis, unknown) in self.unknowns.of(node) {
                force[axis] = damping.factor * product[unknown];
            }
        }
        force
    }

    /// Adds damping by the elastic stiffness at nodal step displacements `u` \[length\] to the internal force `f` \[force\], with
    /// its derivative to the values of the tangent matrix.
    pub(crate) fn add_damping(
        &self,
        u: &[[f64; D]],
        f: &mut [[f64; D]],
        values: Option<&mut [f64]>,
    ) {
        let (Some(damping), Some(inertia)) = (&self.damping, &self.inertia) else {
            return;
        };
        let force = self.force_of(Some(damping), &inertia.motion(u).after);
        for (f, force) in f.iter_mut().zip(force) {
            *f = std::array::from_fn(|a| f[a] + force[a]);
        }
        let rate = damping.factor * damping.rate;
        for (value, entry) in values.into_iter().flatten().zip(&damping.stiffness.values) {
            *value += rate * entry;
        }
    }

    /// The work of walls and of damping over a step by nodal displacements `u` \[length\].
    pub(crate) fn work_of_ground(&self, inertia: &Inertia<D>, u: &[[f64; D]]) -> WorkOfGround {
        let theta = inertia.step().scheme.weights().sum;
        let over = |after: f64, before: f64| theta * after + (1.0 - theta) * before;
        let mut at_end = vec![[0.0; D]; u.len()];
        self.beside.walls.add(u, &mut at_end, None);
        let mut at_start = vec![[0.0; D]; u.len()];
        self.beside
            .walls
            .add_at_start(inertia.velocity(), false, &mut at_start);
        let carried = (self.conditions.walls.iter())
            .flat_map(|walls| walls.nodes.iter())
            .map(|wall| {
                // Where it is tied it moves with others.
                let carried = |a: usize| {
                    let carriers = self.stencils.carriers(wall.node);
                    carriers.map(|by| by.weight * u[by.node][a]).sum::<f64>()
                };
                (0..D).map(|a| wall.force[a] * carried(a)).sum::<f64>()
            })
            .sum();
        let damped = |velocity: &[[f64; D]]| {
            let by_stiffness = self.force_of(self.damping.as_ref(), velocity);
            product(&inertia.damping_force(velocity), u) + product(&by_stiffness, u)
        };
        let after = inertia.motion(u).after;
        WorkOfGround {
            boundaries: over(product(&at_end, u), product(&at_start, u)) - carried,
            carried,
            damping: over(damped(&after), damped(inertia.velocity())),
        }
    }
}
