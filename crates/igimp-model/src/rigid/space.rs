//! Shapes of rigid bodies in space.

use std::sync::Arc;

use igimp_assembly::{Surface, SurfaceError};
use igimp_geometry::region::Region;
use igimp_geometry::solid::ClosedSurface;
use igimp_text::short;

use crate::RigidForm;

/// The shape of a rigid body in space, where it starts. Its reference point is its middle, of a cone its tip.
#[derive(Clone, Debug, PartialEq)]
pub enum RigidSolid {
    /// A box, by the corners of its lowest and of its highest coordinates \[m\]. Its sides: left, right, front, back,
    /// bottom, top.
    Cuboid([f64; 3], [f64; 3]),
    /// A cylinder along an axis. Its sides: the lower end, the shaft, the upper end.
    Cylinder {
        /// The axis.
        axis: usize,
        /// Its middle \[m\].
        middle: [f64; 3],
        /// Radius \[m\].
        radius: f64,
        /// Half of its length \[m\].
        half_length: f64,
    },
    /// A sphere: one side.
    Sphere {
        /// Centre \[m\].
        centre: [f64; 3],
        /// Radius \[m\].
        radius: f64,
    },
    /// A cone with its tip down, and a shaft above it. Its sides: the face of the tip, the shaft if there is one, and
    /// the end.
    Cone {
        /// The tip \[m\].
        tip: [f64; 3],
        /// Radius at its upper end \[m\].
        radius: f64,
        /// Height of the cone \[m\].
        height: f64,
        /// Length of the shaft \[m\].
        shaft: f64,
    },
    /// A closed surface of triangles: one side. Its reference point is the middle of the box around it.
    Surface(Arc<ClosedSurface>),
}

impl RigidSolid {
    /// The reference point of its displacement, forces and moment \[m\].
    pub fn reference(&self) -> [f64; 3] {
        match self {
            Self::Cuboid(..) | Self::Surface(_) => {
                let (lower, upper) = self.bounds();
                std::array::from_fn(|axis| 0.5 * (lower[axis] + upper[axis]))
            }
            Self::Cylinder { middle, .. } => *middle,
            Self::Sphere { centre, .. } => *centre,
            Self::Cone { tip, .. } => *tip,
        }
    }
}

/// The nearest distance in plan of a box from a point \[m\].
fn distance_in_plan(at: &[f64; 3], lower: &[f64; 3], upper: &[f64; 3]) -> f64 {
    let off = |axis: usize| at[axis] - at[axis].clamp(lower[axis], upper[axis]);
    off(0).hypot(off(1))
}

impl RigidForm<3> for RigidSolid {
    fn sides(&self) -> &'static [&'static str] {
        match self {
            Self::Cuboid(..) => &["left", "right", "front", "back", "bottom", "top"],
            Self::Cylinder { axis: 2, .. } => &["bottom", "shaft", "top"],
            Self::Cylinder { .. } => &["start", "shaft", "end"],
            Self::Sphere { .. } | Self::Surface(_) => &["surface"],
            Self::Cone { shaft, .. } if *shaft > 0.0 => &["tip", "shaft", "top"],
            Self::Cone { .. } => &["tip", "top"],
        }
    }

    fn surface(
        &self,
        _about: [f64; 3],
        rounding: f64,
        cell: f64,
    ) -> Result<Surface<3>, SurfaceError> {
        match self {
            Self::Cuboid(lower, upper) => {
                let half = std::array::from_fn(|axis| 0.5 * (upper[axis] - lower[axis]));
                Surface::cuboid(half, rounding, cell)
            }
            Self::Cylinder {
                axis,
                radius,
                half_length,
                ..
            } => Surface::cylinder(*axis, *radius, *half_length, rounding, cell),
            Self::Sphere { radius, .. } => Surface::sphere(*radius, cell),
            Self::Cone {
                radius,
                height,
                shaft,
                ..
            } => Surface::cone(2, [*radius, *height, *shaft], rounding, cell),
            Self::Surface(own) => {
                let reference = self.reference();
                let corner = |at: [f64; 3]| std::array::from_fn(|axis| at[axis] - reference[axis]);
                let corners: Vec<[f64; 3]> = own.points().iter().copied().map(corner).collect();
                let triangles: Vec<_> = own.faces().iter().map(|face| (*face, 0)).collect();
                Surface::triangles(&corners, &triangles, cell)
            }
        }
    }

    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        match self {
            Self::Cuboid(lower, upper) => (*lower, *upper),
            Self::Cylinder {
                axis,
                middle,
                radius,
                half_length,
            } => {
                let mut half = [*radius; 3];
                half[*axis] = *half_length;
                (
                    std::array::from_fn(|k| middle[k] - half[k]),
                    std::array::from_fn(|k| middle[k] + half[k]),
                )
            }
            Self::Sphere { centre, radius } => {
                (centre.map(|x| x - radius), centre.map(|x| x + radius))
            }
            Self::Cone {
                tip: [x, y, z],
                radius,
                height,
                shaft,
            } => (
                [x - radius, y - radius, *z],
                [x + radius, y + radius, z + height + shaft],
            ),
            Self::Surface(own) => own.bounds(),
        }
    }

    fn underside(&self, lower: &[f64; 3], upper: &[f64; 3]) -> f64 {
        let chord = |level: f64, radius: f64, distance: f64| {
            if distance > radius {
                f64::INFINITY
            } else {
                level - (radius * radius - distance * distance).sqrt()
            }
        };
        match self {
            Self::Cuboid(from, _) => from[2],
            Self::Cylinder {
                axis: 2,
                middle,
                radius,
                half_length,
            } => {
                if distance_in_plan(middle, lower, upper) < *radius {
                    middle[2] - half_length
                } else {
                    f64::INFINITY
                }
            }
            Self::Cylinder {
                axis,
                middle,
                radius,
                ..
            } => {
                let across = 1 - axis;
                let nearest = middle[across].clamp(lower[across], upper[across]);
                chord(middle[2], *radius, (middle[across] - nearest).abs())
            }
            Self::Sphere { centre, radius } => {
                chord(centre[2], *radius, distance_in_plan(centre, lower, upper))
            }
            Self::Cone {
                tip,
                radius,
                height,
                ..
            } => {
                let distance = distance_in_plan(tip, lower, upper);
                if distance < *radius {
                    tip[2] + height * distance / radius
                } else {
                    f64::INFINITY
                }
            }
            Self::Surface(own) => {
                let middle = [0, 1].map(|axis| 0.5 * (lower[axis] + upper[axis]));
                let places = [
                    middle,
                    [lower[0], lower[1]],
                    [upper[0], lower[1]],
                    [lower[0], upper[1]],
                    [upper[0], upper[1]],
                ];
                let levels = places
                    .into_iter()
                    .flat_map(|[x, y]| own.crossings(&[x, y, 0.0]));
                levels
                    .map(|crossing| crossing.level)
                    .fold(f64::INFINITY, f64::min)
            }
        }
    }

    fn words(&self) -> [String; 2] {
        let place = |at: [f64; 3]| format!("({})", at.map(short).join(", "));
        let (lower, upper) = self.bounds();
        let size: [f64; 3] = std::array::from_fn(|axis| upper[axis] - lower[axis]);
        let size = size.map(short).join(" × ");
        match self {
            Self::Cuboid(lower, upper) => [
                format!("box from {} to {}", place(*lower), place(*upper)),
                size,
            ],
            Self::Cylinder {
                axis,
                middle,
                radius,
                ..
            } => {
                let name = ["x", "y", "z"][*axis];
                [
                    format!("cylinder along {name} about {}", place(*middle)),
                    format!("radius {}, {size}", short(*radius)),
                ]
            }
            Self::Sphere { centre, radius } => [
                format!("sphere about {}", place(*centre)),
                format!("radius {}", short(*radius)),
            ],
            Self::Cone { tip, radius, .. } => [
                format!("cone with its tip at {}", place(*tip)),
                format!("radius {}, {size}", short(*radius)),
            ],
            Self::Surface(own) => [
                format!("closed surface of {} triangles", own.triangle_count()),
                size,
            ],
        }
    }
}
