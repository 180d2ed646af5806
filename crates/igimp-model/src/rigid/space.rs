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

/// Second moments of unit mass with its centre at `centre`, of which `second` are those about it along the axes \[m²\].
fn shifted(centre: [f64; 3], second: [f64; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|a| {
        std::array::from_fn(|b| centre[a] * centre[b] + if a == b { second[a] } else { 0.0 })
    })
}

/// The weighted mean of second moments of parts, with weights that need not sum to one.
fn mean(parts: &[(f64, [[f64; 3]; 3])]) -> [[f64; 3]; 3] {
    let whole: f64 = parts.iter().map(|(weight, _)| weight).sum();
    std::array::from_fn(|a| {
        std::array::from_fn(|b| {
            parts
                .iter()
                .map(|(weight, moments)| weight / whole * moments[a][b])
                .sum()
        })
    })
}

impl RigidSolid {
    /// Second moments ∫ x xᵀ over the volume of the body, about a point \[m²\].
    fn second_moments(&self, about: &[f64; 3]) -> [[f64; 3]; 3] {
        let off = |at: &[f64; 3]| std::array::from_fn(|axis| at[axis] - about[axis]);
        match self {
            Self::Cuboid(lower, upper) => {
                let side = |axis: usize| upper[axis] - lower[axis];
                let middle = std::array::from_fn(|axis| 0.5 * (lower[axis] + upper[axis]));
                shifted(
                    off(&middle),
                    std::array::from_fn(|axis| side(axis).powi(2) / 12.0),
                )
            }
            Self::Cylinder {
                axis,
                middle,
                radius,
                half_length,
            } => {
                let mut second = [0.25 * radius * radius; 3];
                second[*axis] = half_length * half_length / 3.0;
                shifted(off(middle), second)
            }
            Self::Sphere { centre, radius } => shifted(off(centre), [0.2 * radius * radius; 3]),
            Self::Cone {
                tip,
                radius,
                height,
                shaft,
            } => {
                let above = |z: f64| off(&[tip[0], tip[1], tip[2] + z]);
                let across = 3.0 / 20.0 * radius * radius;
                let cone = [across, across, 3.0 / 80.0 * height * height];
                let round = 0.25 * radius * radius;
                let cylinder = [round, round, shaft * shaft / 12.0];
                mean(&[
                    (height / 3.0, shifted(above(0.75 * height), cone)),
                    (*shaft, shifted(above(height + 0.5 * shaft), cylinder)),
                ])
            }
            Self::Surface(surface) => {
                let parts: Vec<_> = tetrahedra(surface, about)
                    .map(|(volume, [p, q, r])| {
                        let sum: [f64; 3] = std::array::from_fn(|a| p[a] + q[a] + r[a]);
                        let second = std::array::from_fn(|a| {
                            std::array::from_fn(|b| {
                                (sum[a] * sum[b] + p[a] * p[b] + q[a] * q[b] + r[a] * r[b]) / 20.0
                            })
                        });
                        (volume, second)
                    })
                    .collect();
                mean(&parts)
            }
        }
    }
}

/// The tetrahedra from a point to the triangles of a closed surface: six times their volume, of either sign \[m³\], and the corners of
/// the triangles from that point \[m\].
fn tetrahedra<'a>(
    surface: &'a ClosedSurface,
    about: &'a [f64; 3],
) -> impl Iterator<Item = (f64, [[f64; 3]; 3])> + 'a {
    surface.triangles().map(|triangle| {
        let corners = triangle.map(|at| std::array::from_fn(|axis| at[axis] - about[axis]));
        let [p, q, r]: [[f64; 3]; 3] = corners;
        let cross = |a: usize, b: usize| q[a] * r[b] - q[b] * r[a];
        let volume = p[0] * cross(1, 2) + p[1] * cross(2, 0) + p[2] * cross(0, 1);
        (volume, corners)
    })
}

/// The nearest distance in plan of a box from a point \[m\].
fn distance_in_plan(at: &[f64; 3], lower: &[f64; 3], upper: &[f64; 3]) -> f64 {
    let off = |axis: usize| at[axis] - at[axis].clamp(lower[axis], upper[axis]);
    off(0).hypot(off(1))
}

impl RigidForm<3> for RigidSolid {
    fn centroid(&self) -> [f64; 3] {
        match self {
            Self::Cuboid(..) | Self::Cylinder { .. } | Self::Sphere { .. } => self.reference(),
            Self::Cone {
                tip, height, shaft, ..
            } => {
                let (cone, whole) = (height / 3.0, height / 3.0 + shaft);
                let above = (cone * 0.75 * height + shaft * (height + 0.5 * shaft)) / whole;
                [tip[0], tip[1], tip[2] + above]
            }
            Self::Surface(surface) => {
                let about = self.reference();
                let (mut volume, mut moment) = (0.0, [0.0; 3]);
                for (part, corners) in tetrahedra(surface, &about) {
                    volume += part;
                    moment = std::array::from_fn(|axis| {
                        let sum: f64 = corners.iter().map(|corner| corner[axis]).sum();
                        moment[axis] + part * sum / 4.0
                    });
                }
                std::array::from_fn(|axis| about[axis] + moment[axis] / volume)
            }
        }
    }

    fn squared_gyration(&self, about: &[f64; 3]) -> [[f64; 3]; 3] {
        let second = self.second_moments(about);
        let trace = second[0][0] + second[1][1] + second[2][2];
        std::array::from_fn(|a| {
            std::array::from_fn(|b| {
                if a == b {
                    trace - second[a][b]
                } else {
                    -second[a][b]
                }
            })
        })
    }

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
            Self::Surface(surface) => {
                let reference = self.reference();
                let corner = |at: [f64; 3]| std::array::from_fn(|axis| at[axis] - reference[axis]);
                let corners: Vec<[f64; 3]> = surface.points().iter().copied().map(corner).collect();
                let triangles: Vec<_> = surface.faces().iter().map(|face| (*face, 0)).collect();
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
            Self::Surface(surface) => surface.bounds(),
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
            Self::Surface(surface) => {
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
                    .flat_map(|[x, y]| surface.crossings(&[x, y, 0.0]));
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
            Self::Surface(surface) => [
                format!("closed surface of {} triangles", surface.triangle_count()),
                size,
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: moments of inertia of solids are those of the tables, also about points beside them, and of a surface of triangles.
    /// ORACLE: sphere 2/5 r², cylinder ½ r² and r²/4 + L²/12, cone 3/10 r² about its axis and 3/20 r² + 3/5 h² about its tip; a cube of
    /// triangles as a cuboid.
    #[test]
    fn moments_of_inertia_of_solids() {
        let close =
            |got: f64, expected: f64| assert!((got - expected).abs() < 1e-12, "{got} {expected}");
        let (centre, radius) = ([1.0, 2.0, 3.0], 0.5);
        let sphere = RigidSolid::Sphere { centre, radius }.squared_gyration(&centre);
        close(sphere[0][0], 0.4 * 0.25);
        let beside = RigidSolid::Sphere { centre, radius }.squared_gyration(&[1.0, 0.0, 3.0]);
        close(beside[0][0], 0.1 + 4.0);
        close(beside[1][1], 0.1);
        let cylinder = RigidSolid::Cylinder {
            axis: 0,
            middle: centre,
            radius,
            half_length: 1.5,
        }
        .squared_gyration(&centre);
        close(cylinder[0][0], 0.125);
        close(cylinder[1][1], 0.0625 + 9.0 / 12.0);
        let [height, shaft] = [2.0, 0.0];
        let tip = centre;
        let cone = RigidSolid::Cone {
            tip,
            radius,
            height,
            shaft,
        }
        .squared_gyration(&tip);
        close(cone[2][2], 0.3 * 0.25);
        close(cone[0][0], 0.15 * 0.25 + 0.6 * 4.0);
        let points = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 2.0, 0.0],
            [0.0, 0.0, 3.0],
        ];
        // A corner of a box cut off: ∫ x² = a² / 10, ∫ xy = ab / 20.
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let triangles = faces.map(|face: [usize; 3]| face.map(|k| points[k]));
        let corner = RigidSolid::Surface(Arc::new(ClosedSurface::new(&triangles).unwrap()))
            .squared_gyration(&[0.0; 3]);
        close(corner[2][2], (1.0 + 4.0) / 10.0);
        close(corner[0][1], -2.0 / 20.0);
    }
}
