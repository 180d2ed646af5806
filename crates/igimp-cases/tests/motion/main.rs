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

/// What comes in less where it goes.
fn imbalance(own: &EnergySummary) -> f64 {
    let gone = [
        own.kinetic_gain,
        own.elastic,
        own.plastic,
        own.contact,
        own.reinforcement,
        own.water,
        own.damping,
        own.boundaries,
        own.scheme,
        own.map,
        own.integration,
    ];
    own.loads + own.supports - gone.iter().sum::<f64>()
}
