//! Loads of a step from outside: external force, the drives of rigid bodies, given water.

use crate::body::particles::Particles;
use crate::conditions::StepConditions;
use crate::conditions::rigid_motion::{Drive, RigidMotion};
use crate::contributions::loads::{add_unbalanced_forces, add_variation_of_weight, weight};
use crate::contributions::pore_water::{Asked, Pores};
use crate::contributions::rigid::add_weights;
use crate::error::AssemblyError;
use crate::method::Method;
use crate::step::stencils::Stencils;
use igimp_rigid::{NODES_PER_BODY, RigidBody, rotations};

/// Loads of a step from outside.
#[derive(Debug)]
pub(crate) struct Loads<const D: usize> {
    /// External force by node \[force\].
    pub(crate) f_ext: Vec<[f64; D]>,
    /// By node that stands for the motion of a rigid body.
    pub(crate) motions: Vec<[Drive; D]>,
    /// The water in the pores.
    pub(crate) pores: Pores,
    /// The given field that it is of.
    water: Option<Asked<D>>,
}

impl<const D: usize> Loads<D> {
    /// The loads of a step but for those of loaded points; an `earlier` set of the same step has asked for its water.
    ///
    /// # Errors
    /// [`AssemblyError::NonFinite`] for a load that is not finite, and those of given water.
    pub(crate) fn find(
        particles: &Particles<D>,
        bodies: &[RigidBody<D>],
        stencils: &Stencils<D>,
        conditions: &StepConditions<D>,
        (method, earlier): (&Method, Option<&Self>),
    ) -> Result<Self, AssemblyError> {
        let motions = nodal_motions(bodies, conditions);
        let mut f_ext = weight(&conditions.grid, stencils, &conditions.loads);
        let gravity = &conditions.loads.gravity;
        add_variation_of_weight(stencils, &conditions.laws, gravity, &mut f_ext);
        let water = conditions.water.given.as_ref().map(|field| {
            let earlier = earlier.and_then(|loads| loads.water.as_ref());
            Asked::of(field, (particles, method.section), earlier)
        });
        let of_water = (method, water.as_ref());
        let pores = Pores::fill(particles, stencils, conditions, of_water, &mut f_ext)?;
        if let Some(held) = &conditions.held {
            add_unbalanced_forces(held, stencils, &mut f_ext);
        }
        let of_grid = f_ext.len();
        f_ext.extend(motions.iter().map(|motion| {
            motion.map(|drive| match drive {
                Drive::Loaded(force) => force,
                Drive::Moved(_) => 0.0,
            })
        }));
        add_weights(bodies, conditions, &mut f_ext[of_grid..]);
        Ok(Self {
            f_ext,
            motions,
            pores,
            water,
        })
    }

    /// By node that stands for the motion of a rigid body, whether its components are unknown.
    pub(crate) fn is_free(&self) -> Vec<[bool; D]> {
        self.motions
            .iter()
            .map(|motion| motion.map(|drive| matches!(drive, Drive::Loaded(_))))
            .collect()
    }
}

/// Drives of the nodes that stand for rigid bodies: two for each, displacement and rotation, the
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
