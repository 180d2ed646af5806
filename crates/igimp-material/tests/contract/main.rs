//! The contract of a constitutive law, run on every law of the crate.
//!
//! | file | demands |
//! |---|---|
//! | `returns` | admissible, split of strain, dissipation, closest point, isotropy |
//! | `active_sets` | returns to planes against every set of planes |
//! | `every_regime` | every law on random states, by regime; a million a law in release mode |
//! | `flow_rule` | plastic strain in the cone of the active planes |
//! | `tangents` | consistent tangent against differences, symmetry |
//! | `lifts` | spatial tangent against differences, rotation, plane strain against 3D |
//! | `close_eigenvalues` | the same where principal values are equal or nearly so |
//! | `random_laws` | the same for laws with random parameters |
//! | `reduction` | strength reduction and limits between laws |
//! | `scaled` | laws at ratios of strength and stiffness |
//! | `hardening` | laws with memory |
//! | `memory` | the same as `returns` and `tangents` ask, of laws with memory and with elasticity that is not linear |
//! | `hardening_soil` | the same of Hardening Soil, whose elasticity goes with the stress of the last step |
//! | `hoek_brown` | the same of Hoek–Brown, with its envelope and its reduction |
//! | `softening` | the same, and closed forms, of laws whose strength goes with plastic strain |
//! | `undrained` | strength by the direction of stress and by the rate of strain: closed forms, the contract |
//! | `inertial` | friction that grows with the speed of shear: closed forms, the contract |
//! | `utilisation` | the share of the strength that a stress mobilises |
//! | `refusals` | values that are not accepted, and the words for them |
//!
//! A new law joins by its lines in `catalogue`.

mod active_sets;
mod catalogue;
mod close_eigenvalues;
mod every_regime;
mod flow_rule;
mod hardening;
mod hardening_soil;
mod hoek_brown;
mod inertial;
mod lifts;
mod memory;
mod random;
mod random_laws;
mod reduction;
mod refusals;
mod returns;
mod scaled;
mod softening;
mod tangents;
mod tensors;
mod undrained;
mod utilisation;
