//! Shapes of rigid bodies in space.

use std::sync::Arc;

use igimp_model::{Material, RigidForm as _, RigidPart, RigidSolid};
use igimp_schema::diagnostic::Problems;
use igimp_schema::text::clip;
use igimp_schema::tree::Node;

use super::{Basis, Sides, follow_once, part_of};
use crate::build::bodies::surfaces::closed_surface;
use crate::build::grid::Frame;

/// The rigid bodies.
pub(crate) fn rigid(
    tree: &Node,
    frame: Option<&Frame<3>>,
    materials: &[Option<Material>],
    problems: &mut Problems,
) -> Vec<Option<RigidPart<3>>> {
    let nodes = tree.items_at("rigid");
    let part = |node: &Node| {
        let shape = shape(node, &clip(node.text_at("name")?, 40), problems);
        part_of(node, shape.map(basis), (frame, materials), problems)
    };
    let parts = nodes.iter().map(part).collect();
    follow_once(nodes, (false, "it can follow one rigid body"), problems);
    parts
}

fn basis(shape: RigidSolid) -> Basis<3> {
    let (lower, upper) = shape.bounds();
    let names = shape.sides();
    Basis {
        reference: shape.reference(),
        sides: Sides {
            count: names.len(),
            names,
        },
        thickness: (0..3)
            .map(|axis| upper[axis] - lower[axis])
            .fold(f64::INFINITY, f64::min),
        shape: Arc::new(shape),
    }
}

fn shape(node: &Node, name: &str, problems: &mut Problems) -> Option<RigidSolid> {
    let kind = node.text_at("type")?;
    Some(match kind {
        "box" => {
            let (a, b) = (node.point_at::<3>("from")?, node.point_at::<3>("to")?);
            let lower: [f64; 3] = std::array::from_fn(|axis| a[axis].min(b[axis]));
            let upper: [f64; 3] = std::array::from_fn(|axis| a[axis].max(b[axis]));
            let largest = a
                .into_iter()
                .chain(b)
                .fold(0.0, |most: f64, x| most.max(x.abs()));
            if (0..3).any(|axis| upper[axis] - lower[axis] <= 1e-9 * largest) {
                problems.error(
                    node.place_at("to"),
                    format!("the rigid body `{name}` has no volume"),
                );
                return None;
            }
            RigidSolid::Cuboid(lower, upper)
        }
        "cylinder" => RigidSolid::Cylinder {
            axis: match node.text_at("axis")? {
                "x" => 0,
                "y" => 1,
                _ => 2,
            },
            middle: node.point_at("middle")?,
            radius: node.number_at("radius")?,
            half_length: 0.5 * node.number_at("length")?,
        },
        "sphere" => RigidSolid::Sphere {
            centre: node.point_at("centre")?,
            radius: node.number_at("radius")?,
        },
        "cone" => RigidSolid::Cone {
            tip: node.point_at("tip")?,
            radius: node.number_at("radius")?,
            height: node.number_at("height")?,
            shaft: node.number_at("shaft")?,
        },
        "surface" => {
            let who = format!("rigid body `{name}`");
            RigidSolid::Surface(closed_surface(node.get("surface")?, &who, problems)?)
        }
        _ => {
            problems
                .error(
                    node.place_at("type"),
                    format!("a {kind} is a shape of the plane"),
                )
                .help("shapes in space: box, cylinder, sphere, cone, surface");
            return None;
        }
    })
}
