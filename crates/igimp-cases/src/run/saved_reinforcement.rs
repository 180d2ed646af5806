//! Reinforcement as checkpoints keep it: where it is, and what steps have made of it. What it is stands in
//! the case.

use igimp_assembly::{Reinforcement, SegmentState};
use igimp_solver::Body;
use serde::{Deserialize, Serialize};

use super::reinforcement;
use super::state::Controls;
use crate::case::Case;

/// What steps change of a member.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct SavedMember {
    /// By station, by point \[m\].
    points: Vec<Vec<[f64; 2]>>,
    /// By bar: strain, slack, tension, whether it is at its limit.
    bars: Vec<(f64, f64, f64, bool)>,
}

/// The members of a state.
pub(crate) fn all(body: &Body<2>) -> Vec<SavedMember> {
    body.reinforcement.iter().map(SavedMember::of).collect()
}

impl SavedMember {
    fn of(member: &Reinforcement<2>) -> Self {
        let stations = member.stations.iter();
        let bars = member.segments.iter().map(|own| {
            let SegmentState {
                strain,
                slack,
                force,
                is_at_limit,
            } = own.state;
            (strain, slack, force, is_at_limit)
        });
        Self {
            points: stations.map(|own| own.points.clone()).collect(),
            bars: bars.collect(),
        }
    }
}

/// The members that are there under controls, as they were saved; or why they cannot be.
pub(crate) fn taken_up(
    case: &Case,
    controls: &Controls,
    saved: &[SavedMember],
) -> Result<Vec<Reinforcement<2>>, String> {
    let members = case.reinforcement.len();
    if controls.reinforcement.len() != members || controls.installed().count() != saved.len() {
        let there = saved.len();
        return Err(format!(
            "{there} members of reinforcement were saved, which do not fit the {members} of the case"
        ));
    }
    let mut taken = Vec::with_capacity(saved.len());
    for (index, own) in std::iter::zip(controls.installed(), saved) {
        let mut member = reinforcement::made(case, &case.reinforcement[index]);
        let points = |of: &[Vec<[f64; 2]>]| of.iter().map(Vec::len).collect::<Vec<_>>();
        let places: Vec<_> = member
            .stations
            .iter()
            .map(|own| own.points.clone())
            .collect();
        if points(&own.points) != points(&places) || own.bars.len() != member.segments.len() {
            return Err(format!(
                "the reinforcement `{}` was saved with other stations than it has",
                member.name
            ));
        }
        for (station, points) in member.stations.iter_mut().zip(&own.points) {
            station.points.clone_from(points);
        }
        for (segment, &(strain, slack, force, is_at_limit)) in
            member.segments.iter_mut().zip(&own.bars)
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
