//! GOAL: soil that is pushed, shaken and let go moves and rests as mechanics and experiments say.

#[path = "../common/resuming.rs"]
mod resuming;

mod blows;
mod dynamic;
mod earthquake;
mod limits;
mod pseudo_static;
mod rigid;
mod turning;

use igimp_results::summary::EnergySummary;

/// Incoming less outgoing energy.
fn imbalance(energy: &EnergySummary) -> f64 {
    let gone = [
        energy.kinetic_gain,
        energy.elastic,
        energy.plastic,
        energy.contact,
        energy.reinforcement,
        energy.water,
        energy.damping,
        energy.boundaries,
        energy.scheme,
        energy.map,
        energy.integration,
    ];
    energy.loads + energy.supports - gone.iter().sum::<f64>()
}
