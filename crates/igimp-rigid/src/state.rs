//! The state of contact from step to step.

/// The state of contact on a rigid body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactState {
    /// The knots of the surface, in its order.
    pub knots: Vec<ContactNode>,
}

impl ContactState {
    /// Nothing touches.
    pub fn none(knots: usize) -> Self {
        Self {
            knots: vec![ContactNode::default(); knots],
        }
    }
}

/// Contact at one knot of the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactNode {
    /// Contact pressure, positive when pressed \[stress\].
    pub pressure: f64,
    /// Shear on the soil along the tangents of the surface; one component in the plane \[stress\].
    pub shear: [f64; 2],
    /// Area of the knot that soil covers \[length^(D-1)\].
    pub area: f64,
    /// Mean gap, summed over the motion of the soil since it came near; negative in penetration
    /// \[length\].
    pub gap: f64,
    /// Way by which soil slid along it in the last step \[length\].
    pub way: f64,
    /// Whether soil touches.
    pub is_closed: bool,
    /// Whether soil slips.
    pub slips: bool,
    /// Whether a bond was broken.
    pub is_broken: bool,
}

/// The change of a body's contact by a step in motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactChange {
    /// By how much pressure grows at knots that the motion before the step brings nearer to soil (theory, eq. 68c) \[force\].
    pub force: f64,
    /// Its work along that motion, for the duration of the step \[force·length\].
    pub work: f64,
    /// Friction at knots that slip, by magnitude (theory, eq. 68d) \[force\].
    pub friction: f64,
    /// Its work where it drives what it should hold back, for the duration of the step \[force·length\].
    pub driven: f64,
}
