//! Nodal forces beside the stress of the soil: ghost penalty, inertia, water, nonlocal strain, reinforcement, rigid bodies.

pub(crate) mod beside;
pub(crate) mod consolidation;
pub(crate) mod couplings;
pub(crate) mod dropped;
pub(crate) mod ghost;
pub(crate) mod inertia;
pub(crate) mod loads;
pub(crate) mod nodal_forces;
pub(crate) mod nodal_mass;
pub(crate) mod nonlocal;
pub(crate) mod pore_water;
pub(crate) mod reinforcement;
pub(crate) mod rigid;
pub(crate) mod walls;
