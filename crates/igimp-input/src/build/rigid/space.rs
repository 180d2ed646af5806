//! Shapes of rigid bodies in space.

use std::sync::Arc;

use igimp_model::{RigidForm as _, RigidPart, RigidSolid};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::rigid::{RigidBody, RigidShape as Form};
use igimp_schema::schema::solids::Axis;
use igimp_schema::text::clip;
use igimp_schema::tree::read::At;

use super::{Basis, Room, Sides};
use crate::build::bodies::surfaces::closed_surface;
use crate::build::grid::Frame;

/// The surroundings of rigid bodies.
pub(crate) struct Around<'a>(pub(crate) Option<&'a Frame<3>>);

impl Room<3> for Around<'_> {
    fn frame(&self) -> Option<&Frame<3>> {
        self.0
    }

    fn basis(&self, body: &At<RigidBody<3>>, problems: &mut Problems) -> Option<Basis<3>> {
        shape(body, &clip(&body.name, 40), problems).map(basis)
    }

    fn check(&self, _body: &RigidBody<3>, _part: &RigidPart<3>, _problems: &mut Problems) {}

    fn followed(&self) -> (bool, &'static str) {
        (false, "it can follow one rigid body")
    }
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

fn shape(body: &RigidBody<3>, name: &str, problems: &mut Problems) -> Option<RigidSolid> {
    Some(match &*body.form {
        Form::Box(block) => {
            let block = block.as_ref().ok()?;
            let (a, b) = (*block.from, *block.to);
            let lower: [f64; 3] = std::array::from_fn(|axis| a[axis].min(b[axis]));
            let upper: [f64; 3] = std::array::from_fn(|axis| a[axis].max(b[axis]));
            let largest = a
                .into_iter()
                .chain(b)
                .fold(0.0, |most: f64, x| most.max(x.abs()));
            if (0..3).any(|axis| upper[axis] - lower[axis] <= 1e-9 * largest) {
                problems.error(
                    block.to.place,
                    format!("the rigid body `{name}` has no volume"),
                );
                return None;
            }
            RigidSolid::Cuboid(lower, upper)
        }
        Form::Cylinder(cylinder) => {
            let cylinder = cylinder.as_ref().ok()?;
            RigidSolid::Cylinder {
                axis: match *cylinder.axis {
                    Axis::X => 0,
                    Axis::Y => 1,
                    Axis::Z => 2,
                },
                middle: *cylinder.middle,
                radius: *cylinder.radius,
                half_length: 0.5 * *cylinder.length,
            }
        }
        Form::Sphere(sphere) => {
            let sphere = sphere.as_ref().ok()?;
            RigidSolid::Sphere {
                centre: *sphere.centre,
                radius: *sphere.radius,
            }
        }
        Form::Cone(cone) => {
            let cone = cone.as_ref().ok()?;
            RigidSolid::Cone {
                tip: *cone.tip,
                radius: *cone.radius,
                height: *cone.height,
                shaft: *cone.shaft,
            }
        }
        Form::Surface(surface) => {
            let label = format!("rigid body `{name}`");
            let surface = &surface.as_ref().ok()?.surface;
            RigidSolid::Surface(closed_surface(surface, &label, problems)?)
        }
        Form::Rectangle(_) | Form::Polygon(_) | Form::Circle(_) | Form::Wall(_) => {
            let kind = body.form.name();
            problems
                .error(body.form.place, format!("a {kind} is a shape of the plane"))
                .help("shapes in space: box, cylinder, sphere, cone, surface");
            return None;
        }
    })
}
