//! Factors of safety by hand calculation: a second opinion on every slope that owes nothing to
//! particles, grids or return maps.
//!
//! [`rotation`] is the kinematic theorem for a block that turns on a logarithmic spiral (on a circle
//! in undrained soil): an upper bound for soil whose angle of dilation is that of friction. [`bishop`]
//! is the simplified method of slices of Bishop (1955) on circles, for layers of any friction.
//! [`directional`] has circles through undrained soil whose strength goes with direction.
//! [`sliding`] is the kinematic theorem for three blocks that slide along a thin undrained layer.

pub(crate) mod bishop;
pub(crate) mod directional;
pub(crate) mod rotation;
pub(crate) mod search;
pub(crate) mod section;
pub(crate) mod sliding;
