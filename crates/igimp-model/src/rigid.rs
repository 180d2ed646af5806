//! Rigid bodies that soil touches, and how stages move them.

pub(crate) mod space;

use std::fmt::Debug;
use std::sync::Arc;

use igimp_assembly::{RigidBody, Surface, SurfaceError, Tension};
use igimp_text::short;

/// A rigid body that soil touches, slides along and leaves.
#[derive(Clone, Debug)]
pub struct RigidPart<const D: usize> {
    /// Name.
    pub name: String,
    /// Where it starts, and its shape.
    pub shape: Arc<dyn RigidForm<D>>,
    /// The reference point of its displacement, forces and moment, as the body starts \[m\].
    pub reference: [f64; D],
    /// Its centre of mass, where its weight acts, as the body starts \[m\].
    pub centre_of_mass: [f64; D],
    /// The interfaces of its sides; one for each side of the shape.
    pub interfaces: Vec<RigidInterface>,
    /// Normal stiffness of contact in units of E/h \[-\].
    pub stiffness: f64,
    /// Radius of its corners as a share of the cell \[-\]; a rounding carries nothing.
    pub rounding: f64,
    /// Own weight of the whole body, which acts at its centre of mass with gravity \[N/m\], of whole bodies \[N\].
    pub weight: f64,
    /// The whole body over the part that is modelled, 2 for half a body \[-\]: forces that stages state
    /// and that are reported are those of the whole body.
    pub force_factor: f64,
    /// Whether the rows of the grid follow its vertical displacement.
    pub grid_follows: bool,
    /// Whether it is there from the start, rather than from the first stage that moves it.
    pub from_start: bool,
    /// Penetration that ends a run, as a share of the cell \[-\].
    pub most_penetration: f64,
}

/// Components of the motion of a rigid body in space: displacements along x, y and z, and rotations about x, y and z. In
/// the plane the first three are in use: x, y, rotation (anticlockwise).
pub const COMPONENTS: usize = 6;

/// The components of the motion of a rigid body in D dimensions.
pub const fn components<const D: usize>() -> usize {
    D * (D + 1) / 2
}

/// The shape of a rigid body where it starts.
pub trait RigidForm<const D: usize>: Debug + Send + Sync {
    /// Its surface about a point \[m\], its edges rounded by a radius \[m\], in cells of a size \[m\].
    ///
    /// # Errors
    /// [`SurfaceError`].
    fn surface(
        &self,
        about: [f64; D],
        rounding: f64,
        cell: f64,
    ) -> Result<Surface<D>, SurfaceError>;

    /// Corners of the lowest and of the highest coordinates of the box around it \[m\].
    fn bounds(&self) -> ([f64; D], [f64; D]);

    /// The shape, of a body in the plane.
    fn in_plane(&self) -> Option<&RigidShape> {
        None
    }

    /// The lowest level of the body above or below a box, given by the corners of its lowest and of its highest
    /// coordinates \[m\]; infinite beside the body.
    fn underside(&self, lower: &[f64; D], upper: &[f64; D]) -> f64;

    /// Its centroid: the centre of mass of a uniform body \[m\].
    fn centroid(&self) -> [f64; D];

    /// Moments of inertia over the mass of a uniform body, about axes through a point; in the plane the last one counts \[m²\].
    fn squared_gyration(&self, about: &[f64; D]) -> [[f64; 3]; 3];

    /// Its shape, place and size, in words.
    fn words(&self) -> [String; 2];

    /// Names of its sides, in their order; none where they are numbered.
    fn sides(&self) -> &'static [&'static str] {
        &[]
    }
}

impl<const D: usize> RigidPart<D> {
    /// Its surface about the reference point, in cells of a size \[m\].
    ///
    /// # Errors
    /// [`SurfaceError`].
    pub fn surface(&self, cell: f64) -> Result<Surface<D>, SurfaceError> {
        (self.shape).surface(self.reference, self.rounding * cell, cell)
    }

    /// The mass of the part that is modelled under a gravity \[m/s²\] \[kg/m, in space kg\]; none without gravity.
    pub fn mass(&self, gravity: f64) -> f64 {
        if gravity > 0.0 {
            self.weight / gravity / self.force_factor
        } else {
            0.0
        }
    }

    /// Its moments of inertia under a gravity \[m/s²\], about axes through its centre of mass: those of a uniform body about its
    /// centroid \[kg·m, in space kg·m²\].
    pub fn moments_of_inertia(&self, gravity: f64) -> [[f64; 3]; 3] {
        let mass = self.mass(gravity);
        let squared = self.shape.squared_gyration(&self.shape.centroid());
        squared.map(|row| row.map(|square| mass * square))
    }

    /// From its reference point to its centre of mass, as it starts \[m\]; none where they differ by round-off.
    pub fn arm(&self) -> [f64; D] {
        let (lower, upper) = self.bounds();
        let places = lower.iter().chain(&upper).chain(&self.reference);
        let largest = places.fold(0.0, |most: f64, x| most.max(x.abs()));
        std::array::from_fn(|axis| {
            let arm = self.centre_of_mass[axis] - self.reference[axis];
            if arm.abs() > 1e-12 * largest {
                arm
            } else {
                0.0
            }
        })
    }

    /// Its extent where it starts: corners of the lowest and of the highest coordinates \[m\].
    pub fn bounds(&self) -> ([f64; D], [f64; D]) {
        self.shape.bounds()
    }

    /// Its outline where it starts, as corners \[m\]; a circle as so many points, and nothing of a body in space.
    pub fn outline(&self, points_of_circle: usize) -> Vec<[f64; 2]> {
        match self.shape.in_plane() {
            Some(RigidShape::Polygon(corners)) => corners.clone(),
            Some(RigidShape::Circle { centre, radius }) => (0..points_of_circle)
                .map(|point| {
                    let angle = std::f64::consts::TAU * point as f64 / points_of_circle as f64;
                    let (sin, cos) = angle.sin_cos();
                    [centre[0] + radius * cos, centre[1] + radius * sin]
                })
                .collect(),
            None => Vec::new(),
        }
    }
}

/// How far two rigid bodies reach into each other where they stand: the greatest depth of a knot of one below the surface of the
/// other \[m\]; zero where none does.
pub fn overlap_of_rigid<const D: usize>(a: &RigidBody<D>, b: &RigidBody<D>) -> f64 {
    let knots = [a.knots(), b.knots()];
    let [of_a, of_b] = [&knots[0], &knots[1]].map(|knots| {
        let end = |axis: usize| {
            let places = knots.iter().map(move |knot| knot[axis]);
            places.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], x| {
                [least.min(x), most.max(x)]
            })
        };
        std::array::from_fn::<_, D, _>(end)
    });
    if (0..D).any(|axis| of_a[axis][1] <= of_b[axis][0] || of_b[axis][1] <= of_a[axis][0]) {
        return 0.0;
    }
    let deepest = |knots: &[[f64; D]], other: &RigidBody<D>| {
        let depths = knots.iter().map(|knot| -other.distance(knot));
        depths.fold(0.0, f64::max)
    };
    deepest(&knots[0], b).max(deepest(&knots[1], a))
}

/// The shape of a rigid body in the plane, where it starts.
#[derive(Clone, Debug, PartialEq)]
pub enum RigidShape {
    /// A polygon with corners in order, either way round \[m\]; side k runs from corner k to the next.
    Polygon(Vec<[f64; 2]>),
    /// A circle: one side.
    Circle {
        /// Centre \[m\].
        centre: [f64; 2],
        /// Radius \[m\].
        radius: f64,
    },
}

impl RigidForm<2> for RigidShape {
    fn surface(
        &self,
        about: [f64; 2],
        rounding: f64,
        cell: f64,
    ) -> Result<Surface<2>, SurfaceError> {
        match self {
            Self::Polygon(corners) => {
                let [x, y] = about;
                let shifted: Vec<_> = corners.iter().map(|at| [at[0] - x, at[1] - y]).collect();
                Surface::polygon(&shifted, rounding, cell)
            }
            Self::Circle { radius, .. } => Surface::circle(*radius, cell),
        }
    }

    fn bounds(&self) -> ([f64; 2], [f64; 2]) {
        match self {
            Self::Polygon(corners) => igimp_geometry::polygon::bounding_box(corners),
            Self::Circle { centre, radius } => {
                (centre.map(|x| x - radius), centre.map(|x| x + radius))
            }
        }
    }

    fn in_plane(&self) -> Option<&RigidShape> {
        Some(self)
    }

    fn underside(&self, lower: &[f64; 2], upper: &[f64; 2]) -> f64 {
        let (left, right) = (lower[0], upper[0]);
        let lowest = |places: &mut dyn Iterator<Item = f64>| {
            let levels = [left, right].into_iter().chain(places);
            levels
                .map(|x| self.underside_at(x))
                .fold(f64::INFINITY, f64::min)
        };
        match self {
            Self::Polygon(corners) => {
                let within = corners.iter().map(|corner| corner[0]);
                lowest(&mut within.filter(|at| left < *at && *at < right))
            }
            Self::Circle { centre, .. } => {
                lowest(&mut std::iter::once(centre[0].clamp(left, right)))
            }
        }
    }

    fn centroid(&self) -> [f64; 2] {
        match self {
            Self::Polygon(corners) => igimp_geometry::polygon::area_and_centroid(corners).1,
            Self::Circle { centre, .. } => *centre,
        }
    }

    fn squared_gyration(&self, about: &[f64; 2]) -> [[f64; 3]; 3] {
        let polar = match self {
            Self::Polygon(corners) => {
                let off = |at: &[f64; 2]| [at[0] - about[0], at[1] - about[1]];
                let next = corners.iter().cycle().skip(1);
                let (mut area, mut moment) = (0.0, 0.0);
                for (p, q) in std::iter::zip(corners, next) {
                    let (p, q) = (off(p), off(q));
                    let cross = p[0] * q[1] - p[1] * q[0];
                    let squares = p[0] * p[0] + p[1] * p[1] + q[0] * q[0] + q[1] * q[1];
                    area += 0.5 * cross;
                    moment += cross / 12.0 * (squares + p[0] * q[0] + p[1] * q[1]);
                }
                moment / area
            }
            Self::Circle { centre, radius } => {
                let off = (centre[0] - about[0]).hypot(centre[1] - about[1]);
                0.5 * radius * radius + off * off
            }
        };
        let mut moments = [[0.0; 3]; 3];
        moments[2][2] = polar;
        moments
    }

    fn words(&self) -> [String; 2] {
        let point = |[x, y]: [f64; 2]| format!("({}, {})", short(x), short(y));
        match self {
            Self::Polygon(points) => {
                let (lower, upper) = self.bounds();
                let [width, height] = [0, 1].map(|axis| short(upper[axis] - lower[axis]));
                let corners: Vec<String> = points.iter().copied().map(point).collect();
                [corners.join(" "), format!("{width} × {height}")]
            }
            Self::Circle { centre, radius } => [
                format!("circle about {}", point(*centre)),
                format!("radius {}", short(*radius)),
            ],
        }
    }
}

impl RigidShape {
    /// The lowest place on an upright line \[m\].
    fn underside_at(&self, x: f64) -> f64 {
        match self {
            Self::Polygon(corners) => {
                let next = corners.iter().cycle().skip(1);
                let edges = std::iter::zip(corners, next);
                let crossed = edges.filter(|(p, q)| p[0].min(q[0]) <= x && x <= p[0].max(q[0]));
                crossed
                    .map(|(p, q)| {
                        let run = q[0] - p[0];
                        if run == 0.0 {
                            p[1].min(q[1])
                        } else {
                            p[1] + (x - p[0]) / run * (q[1] - p[1])
                        }
                    })
                    .fold(f64::INFINITY, f64::min)
            }
            Self::Circle { centre, radius } => {
                centre[1] - (radius * radius - (x - centre[0]).powi(2)).max(0.0).sqrt()
            }
        }
    }
}

/// The interface of a side of a rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidInterface {
    /// Its resistance along the side.
    pub shear: RigidShear,
    /// Its resistance when soil is pulled off.
    pub tension: Tension,
}

/// The shear resistance of a side of a rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RigidShear {
    /// Nothing.
    Smooth,
    /// Whatever the soil can, while it touches.
    Rough,
    /// At most adhesion and friction.
    Limited {
        /// Coefficient of friction \[-\].
        friction: f64,
        /// Adhesion while soil touches.
        adhesion: Adhesion,
    },
}

/// Adhesion of a side of a rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Adhesion {
    /// A stress \[Pa\].
    Stress(f64),
    /// A share of the undrained strength, or of the cohesion, of the soil that touches \[-\].
    Share(f64),
}

/// How a stage moves a rigid body. All else goes on as before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidMove {
    /// Index of the body.
    pub body: usize,
    /// By component.
    pub drives: [Option<RigidDrive>; COMPONENTS],
}

impl RigidMove {
    /// Whether a component is displaced or rotated.
    pub fn is_moved(&self) -> bool {
        let mut drives = self.drives.iter().flatten();
        drives.any(|drive| matches!(drive, RigidDrive::By(by) if *by != 0.0))
    }

    /// Whether a force or a moment acts.
    pub fn is_loaded(&self) -> bool {
        let mut drives = self.drives.iter().flatten();
        drives.any(|drive| matches!(drive, RigidDrive::Force(force) if *force != 0.0))
    }
}

/// The drive of a component of a rigid body's motion in a stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RigidDrive {
    /// A further displacement \[m\] or rotation \[rad\] by the end of the stage.
    By(f64),
    /// A force \[N/m\] or moment about the reference point \[N\] at the end of the stage, on the whole
    /// body, raised evenly from the one before. It stays; zero leaves the body free.
    Force(f64),
}

/// A number that a rigid body has. In the plane its rotation and its moment are anticlockwise, components 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RigidQuantity {
    /// Displacement of the reference point along an axis \[m\].
    Displacement(usize),
    /// Downwards \[m\].
    Settlement,
    /// Rotation about an axis \[rad\].
    Rotation(usize),
    /// Force on the body from outside along an axis \[N/m\], of whole bodies \[N\].
    Force(usize),
    /// Downwards \[N/m\], of whole bodies \[N\].
    Resistance,
    /// Moment on the body from outside about the reference point, about an axis \[N\], in space \[N m\].
    Moment(usize),
    /// Velocity of the centre of mass along an axis, in motion \[m/s\].
    Velocity(usize),
    /// Angular velocity about an axis, in motion \[rad/s\].
    Spin(usize),
    /// Length of its sides that soil touches \[m\]; in space their area \[m²\].
    ContactWidth,
    /// Largest penetration as a share of the cell \[-\].
    Penetration,
    /// Number of points that soil touches.
    Closed,
    /// Number of points that soil slips along.
    Slipping,
}
