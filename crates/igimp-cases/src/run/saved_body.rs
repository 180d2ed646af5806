//! Rigid bodies as checkpoints keep them: where they stand, and what contact has left behind. What they
//! are is in the case.

use igimp_assembly::{ContactNode, RigidBody};
use igimp_solver::Body;
use serde::{Deserialize, Serialize};

use super::rigid;
use super::state::Controls;
use crate::case::Case;
use crate::error::CaseError;

/// What steps change of a rigid body.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct SavedBody {
    origin: [f64; 2],
    turn: [[f64; 2]; 2],
    angle: [f64; 3],
    knots: Vec<SavedKnot>,
}

/// What steps change of a knot of its surface.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct SavedKnot {
    pressure: f64,
    shear: [f64; 2],
    area: f64,
    gap: f64,
    is_closed: bool,
    slips: bool,
    is_broken: bool,
}

/// The rigid bodies of a state.
pub(crate) fn all(body: &Body<2>) -> Vec<SavedBody> {
    body.rigid.iter().map(SavedBody::of).collect()
}

impl SavedBody {
    fn of(body: &RigidBody<2>) -> Self {
        let knots = body.contact.knots.iter();
        Self {
            origin: body.pose.origin,
            turn: body.pose.turn,
            angle: body.pose.angle,
            knots: knots
                .map(|knot| {
                    let &ContactNode {
                        pressure,
                        shear,
                        area,
                        gap,
                        is_closed,
                        slips,
                        is_broken,
                    } = knot;
                    SavedKnot {
                        pressure,
                        shear,
                        area,
                        gap,
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
pub(crate) fn taken_up(
    case: &Case,
    laws: usize,
    controls: &Controls,
    saved: &[SavedBody],
) -> Result<Result<Vec<RigidBody<2>>, String>, CaseError> {
    if controls.rigid.len() != case.rigid.len() || controls.placed().count() != saved.len() {
        let (there, bodies) = (saved.len(), case.rigid.len());
        return Ok(Err(format!(
            "{there} rigid bodies were saved, which do not fit the {bodies} of the case"
        )));
    }
    let mut bodies = Vec::with_capacity(saved.len());
    for (index, own) in std::iter::zip(controls.placed(), saved) {
        let mut body = rigid::made(case, index, laws)?;
        if own.knots.len() != body.contact.knots.len() {
            let (found, knots) = (own.knots.len(), body.contact.knots.len());
            return Ok(Err(format!(
                "rigid body {index} was saved with {found} knots, and has {knots}"
            )));
        }
        body.pose.origin = own.origin;
        body.pose.turn = own.turn;
        body.pose.angle = own.angle;
        for (knot, own) in body.contact.knots.iter_mut().zip(&own.knots) {
            *knot = ContactNode {
                pressure: own.pressure,
                shear: own.shear,
                area: own.area,
                gap: own.gap,
                is_closed: own.is_closed,
                slips: own.slips,
                is_broken: own.is_broken,
            };
        }
        bodies.push(body);
    }
    Ok(Ok(bodies))
}
