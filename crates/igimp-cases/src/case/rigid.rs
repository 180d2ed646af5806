//! Rigid bodies that soil touches, and how stages move them.

use igimp_assembly::{Surface, SurfaceError, Tension};

/// A rigid body that soil touches, slides along and leaves.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidPart {
    /// Name.
    pub name: String,
    /// Where it starts, and its shape.
    pub shape: RigidShape,
    /// The point that its displacement, its forces and its moment are told of, as the body starts \[m\].
    pub reference: [f64; 2],
    /// What its sides are like; one for each side of the shape.
    pub interfaces: Vec<RigidInterface>,
    /// Normal stiffness of contact in units of E/h \[-\].
    pub stiffness: f64,
    /// Radius of its corners as a share of the cell \[-\]; a rounding carries nothing.
    pub rounding: f64,
    /// Own weight of the whole body, which acts at the reference point with gravity \[N/m\].
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

impl RigidPart {
    /// Its outline where it starts, as corners \[m\]; a circle as so many points.
    pub fn outline(&self, points_of_circle: usize) -> Vec<[f64; 2]> {
        match &self.shape {
            RigidShape::Polygon(corners) => corners.clone(),
            RigidShape::Circle { centre, radius } => (0..points_of_circle)
                .map(|point| {
                    let angle = std::f64::consts::TAU * point as f64 / points_of_circle as f64;
                    let (sin, cos) = angle.sin_cos();
                    [centre[0] + radius * cos, centre[1] + radius * sin]
                })
                .collect(),
        }
    }

    /// Its surface about the reference point, in cells of a size \[m\].
    ///
    /// # Errors
    /// [`SurfaceError`].
    pub fn surface(&self, cell: f64) -> Result<Surface<2>, SurfaceError> {
        match &self.shape {
            RigidShape::Polygon(corners) => {
                let [x, y] = self.reference;
                let own: Vec<_> = corners.iter().map(|at| [at[0] - x, at[1] - y]).collect();
                Surface::polygon(&own, self.rounding * cell, cell)
            }
            RigidShape::Circle { radius, .. } => Surface::circle(*radius, cell),
        }
    }

    /// Its extent where it starts: lower and upper corner \[m\].
    pub fn bounds(&self) -> ([f64; 2], [f64; 2]) {
        match &self.shape {
            RigidShape::Polygon(corners) => crate::polygon::bounding_box(corners),
            RigidShape::Circle { centre, radius } => {
                (centre.map(|x| x - radius), centre.map(|x| x + radius))
            }
        }
    }
}

/// The shape of a rigid body where it starts.
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

/// What a side of a rigid body is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidInterface {
    /// What it carries along the side.
    pub shear: RigidShear,
    /// What it carries when soil is pulled off.
    pub tension: Tension,
}

/// What a side of a rigid body carries along itself.
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

/// How a stage moves a rigid body. What it does not mention goes on as before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidMove {
    /// Index of the body.
    pub body: usize,
    /// By component: displacement in x, in y, rotation (anticlockwise).
    pub drives: [Option<RigidDrive>; 3],
}

/// What drives a component of the motion of a rigid body in a stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RigidDrive {
    /// A further displacement \[m\] or rotation \[rad\] by the end of the stage.
    By(f64),
    /// A force \[N/m\] or moment about the reference point \[N\] at the end of the stage, on the whole
    /// body, raised evenly from what acted before. It stays; zero leaves the body free.
    Force(f64),
}

/// A number that a rigid body has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RigidQuantity {
    /// Displacement of the reference point in x \[m\].
    X,
    /// In y \[m\].
    Y,
    /// Downwards \[m\].
    Settlement,
    /// Rotation, anticlockwise \[rad\].
    Rotation,
    /// Force on the body from outside in x \[N/m\].
    ForceX,
    /// In y \[N/m\].
    ForceY,
    /// Downwards \[N/m\].
    Resistance,
    /// Moment on the body from outside about the reference point, anticlockwise \[N\].
    Moment,
    /// Length of its sides that soil touches \[m\].
    ContactWidth,
    /// Largest penetration as a share of the cell \[-\].
    Penetration,
    /// Number of points that soil touches.
    Closed,
    /// Number of points that soil slips along.
    Slipping,
}
