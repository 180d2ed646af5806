//! Columns in free field beside walls as checkpoints keep them: their particles are separate states.

use std::sync::Arc;

use igimp_assembly::WallNode;
use igimp_solver::{Body, FreeField};
use serde::{Deserialize, Serialize};

/// A column of soil in free field, beside its particles.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct SavedFreeField {
    /// The axis across its wall.
    normal: usize,
    /// Whether that is the upper one.
    upper: bool,
    /// By node of its grid: the force that holds it, and displacement.
    nodes: Vec<[Vec<f64>; 2]>,
}

/// The columns of a body.
pub(crate) fn all<const D: usize>(body: &Body<D>) -> Vec<SavedFreeField> {
    let saved = |column: &FreeField<D>| SavedFreeField {
        normal: column.normal,
        upper: column.upper,
        nodes: (column.nodes.iter())
            .map(|node| [node.force.to_vec(), node.displacement.to_vec()])
            .collect(),
    };
    body.free_fields.iter().map(saved).collect()
}

/// The particles of the columns of a body, by the names of their states.
pub(crate) fn states<const D: usize>(body: &Body<D>) -> Vec<(String, Body<D>)> {
    (body.free_fields.iter().enumerate())
        .map(|(index, column)| (name(index), Body::new(column.particles.clone())))
        .collect()
}

fn name(index: usize) -> String {
    format!("free-field-{}", index + 1)
}

/// The columns that were saved, with the particles of their states; or why they cannot be.
pub(crate) fn taken_up<const D: usize>(
    saved: &[SavedFreeField],
    states: &[(String, Body<D>)],
) -> Result<Vec<FreeField<D>>, String> {
    let column = |(index, field): (usize, &SavedFreeField)| {
        let name = name(index);
        let state = states.iter().find(|(state, _)| *state == name);
        let (_, body) = state.ok_or_else(|| format!("the state {name} is missing"))?;
        let vector = |values: &Vec<f64>| <[f64; D]>::try_from(values.as_slice()).ok();
        let node = |(node, [force, displacement]): (usize, &[Vec<f64>; 2])| {
            Some(WallNode {
                node,
                force: vector(force)?,
                displacement: vector(displacement)?,
            })
        };
        let nodes: Option<Vec<_>> = field.nodes.iter().enumerate().map(node).collect();
        let nodes = nodes.filter(|_| field.normal < D);
        Ok(FreeField {
            normal: field.normal,
            upper: field.upper,
            particles: body.particles.clone(),
            nodes: Arc::new(nodes.ok_or_else(|| format!("{name} is of another dimension"))?),
        })
    };
    saved.iter().enumerate().map(column).collect()
}
