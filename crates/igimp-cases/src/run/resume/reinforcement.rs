//! Reinforcement as checkpoints keep it: its place, and its state after steps. Its data stand in
//! the case.

use igimp_assembly::{Reinforcement, SegmentState};
use igimp_model::Case;
use igimp_solver::Body;
use serde::{Deserialize, Serialize};

use crate::run::reinforcement;
use crate::run::state::Controls;

/// The state of a member that steps change.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct SavedMember {
    /// By station, by point \[m\].
    points: Vec<Vec<Vec<f64>>>,
    /// By bar: strain, slack, tension, whether it is at its limit.
    bars: Vec<(f64, f64, f64, bool)>,
}

/// The members of a state.
pub(crate) fn all<const D: usize>(body: &Body<D>) -> Vec<SavedMember> {
    body.reinforcement.iter().map(SavedMember::of).collect()
}

impl SavedMember {
    fn of<const D: usize>(member: &Reinforcement<D>) -> Self {
        let stations = member.stations.iter();
        let bars = member.segments.iter().map(|bar| {
            let SegmentState {
                strain,
                slack,
                force,
                is_at_limit,
            } = bar.state;
            (strain, slack, force, is_at_limit)
        });
        Self {
            points: stations
                .map(|station| station.points.iter().map(|point| point.to_vec()).collect())
                .collect(),
            bars: bars.collect(),
        }
    }
}

/// The members that are there under controls, as they were saved; or why they cannot be.
pub(crate) fn taken_up<const D: usize>(
    case: &Case<D>,
    controls: &Controls,
    saved: &[SavedMember],
) -> Result<Vec<Reinforcement<D>>, String> {
    let members = case.reinforcement.len();
    if controls.reinforcement.len() != members || controls.installed().count() != saved.len() {
        let there = saved.len();
        return Err(format!(
            "{there} members of reinforcement were saved, which do not fit the {members} of the case"
        ));
    }
    let mut taken = Vec::with_capacity(saved.len());
    for (index, entry) in std::iter::zip(controls.installed(), saved) {
        let mut member = reinforcement::made(case, &case.reinforcement[index]);
        let saved: Option<Vec<Vec<[f64; D]>>> = (entry.points.iter())
            .map(|points| {
                let points = points.iter().map(|point| point.as_slice().try_into().ok());
                points.collect()
            })
            .collect();
        let counts = |of: &mut dyn Iterator<Item = usize>| of.collect::<Vec<_>>();
        let has = counts(&mut member.stations.iter().map(|station| station.points.len()));
        let fits = |saved: &Vec<Vec<[f64; D]>>| {
            counts(&mut saved.iter().map(Vec::len)) == has
                && entry.bars.len() == member.segments.len()
        };
        let Some(saved) = saved.filter(fits) else {
            return Err(format!(
                "the reinforcement `{}` was saved with other stations than it has",
                member.name
            ));
        };
        for (station, points) in member.stations.iter_mut().zip(saved) {
            station.points = points;
        }
        for (segment, &(strain, slack, force, is_at_limit)) in
            member.segments.iter_mut().zip(&entry.bars)
        {
            segment.state = SegmentState {
                strain,
                slack,
                force,
                is_at_limit,
            };
        }
        taken.push(member);
    }
    Ok(taken)
}
