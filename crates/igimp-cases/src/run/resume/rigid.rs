//! Rigid bodies as checkpoints keep them: their place, and the state of contact. Their data
//! are in the case.

use igimp_assembly::{ContactNode, RigidBody};
use igimp_model::{Case, in_space};
use igimp_solver::Body;
use serde::{Deserialize, Serialize};

use crate::error::CaseError;
use crate::run::rigid;
use crate::run::state::Controls;

/// The state of a rigid body that steps change.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct SavedBody {
    origin: Vec<f64>,
    turn: Vec<Vec<f64>>,
    angle: [f64; 3],
    /// Velocity, angular velocity, acceleration and angular acceleration.
    #[serde(default)]
    motion: [[f64; 3]; 4],
    knots: Vec<SavedKnot>,
}

/// The state of a contact node of its surface that steps change.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct SavedKnot {
    pressure: f64,
    shear: [f64; 2],
    area: f64,
    gap: f64,
    way: f64,
    is_closed: bool,
    slips: bool,
    is_broken: bool,
}

/// The rigid bodies of a state.
pub(crate) fn all<const D: usize>(body: &Body<D>) -> Vec<SavedBody> {
    body.rigid.iter().map(SavedBody::of).collect()
}

impl SavedBody {
    fn of<const D: usize>(body: &RigidBody<D>) -> Self {
        let knots = body.contact.knots.iter();
        Self {
            origin: body.pose.origin.to_vec(),
            turn: body.pose.turn.iter().map(|row| row.to_vec()).collect(),
            angle: body.pose.angle,
            motion: [
                in_space(&body.motion.velocity),
                body.motion.spin,
                in_space(&body.motion.acceleration),
                body.motion.spin_rate,
            ],
            knots: knots
                .map(|knot| {
                    let &ContactNode {
                        pressure,
                        shear,
                        area,
                        gap,
                        way,
                        is_closed,
                        slips,
                        is_broken,
                    } = knot;
                    SavedKnot {
                        pressure,
                        shear,
                        area,
                        gap,
                        way,
                        is_closed,
                        slips,
                        is_broken,
                    }
                })
                .collect(),
        }
    }
}

/// The rigid bodies that are there under controls, as they were saved; or why they cannot be.
pub(crate) fn taken_up<const D: usize>(
    case: &Case<D>,
    laws: usize,
    controls: &Controls,
    saved: &[SavedBody],
) -> Result<Result<Vec<RigidBody<D>>, String>, CaseError> {
    if controls.rigid.len() != case.rigid.len() || controls.placed().count() != saved.len() {
        let (there, bodies) = (saved.len(), case.rigid.len());
        return Ok(Err(format!(
            "{there} rigid bodies were saved, which do not fit the {bodies} of the case"
        )));
    }
    let mut bodies = Vec::with_capacity(saved.len());
    for (index, entry) in std::iter::zip(controls.placed(), saved) {
        let mut body = rigid::made(case, index, laws)?;
        if entry.knots.len() != body.contact.knots.len() {
            let (found, knots) = (entry.knots.len(), body.contact.knots.len());
            return Ok(Err(format!(
                "rigid body {index} was saved with {found} knots, and has {knots}"
            )));
        }
        let rows: Option<Vec<[f64; D]>> = (entry.turn.iter())
            .map(|row| row.as_slice().try_into().ok())
            .collect();
        let turn = rows.and_then(|rows| rows.try_into().ok());
        let (Some(turn), Ok(origin)) = (turn, entry.origin.as_slice().try_into()) else {
            return Ok(Err(format!(
                "rigid body {index} was not saved in {D} dimensions"
            )));
        };
        (body.pose.origin, body.pose.turn) = (origin, turn);
        body.pose.angle = entry.angle;
        let [velocity, spin, acceleration, spin_rate] = entry.motion;
        body.motion.velocity.copy_from_slice(&velocity[..D]);
        body.motion.acceleration.copy_from_slice(&acceleration[..D]);
        (body.motion.spin, body.motion.spin_rate) = (spin, spin_rate);
        for (knot, node) in body.contact.knots.iter_mut().zip(&entry.knots) {
            *knot = ContactNode {
                pressure: node.pressure,
                shear: node.shear,
                area: node.area,
                gap: node.gap,
                way: node.way,
                is_closed: node.is_closed,
                slips: node.slips,
                is_broken: node.is_broken,
            };
        }
        bodies.push(body);
    }
    Ok(Ok(bodies))
}
