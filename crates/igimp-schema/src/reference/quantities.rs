//! The quantities that curves and checks name, such as `footing.reaction`, as the reference lists them.

/// Quantities and what they mean, for the reference.
pub(crate) const QUANTITY_DOCS: [(&str, &str); 27] = [
    ("FOOTING.settlement", "settlement of a rigid footing [m]"),
    (
        "FOOTING.reaction",
        "resistance of a rigid footing times its reaction_factor [N/m]",
    ),
    (
        "rigid.BODY.x, rigid.BODY.y",
        "displacement of the reference point of a rigid body [m]",
    ),
    ("rigid.BODY.settlement", "the same downwards [m]"),
    ("rigid.BODY.rotation", "its rotation, anticlockwise [rad]"),
    (
        "rigid.BODY.force_x, rigid.BODY.force_y",
        "force on the whole body from outside, beside its weight [N/m]; resistance is -force_y",
    ),
    (
        "rigid.BODY.moment",
        "moment on it from outside about its reference point, anticlockwise [N m/m]",
    ),
    (
        "rigid.BODY.z, rigid.BODY.rotation_x, .rotation_y, .rotation_z",
        "in space: displacement in z, rotations about the axes [m, rad]",
    ),
    (
        "rigid.BODY.force_z, .moment_x, .moment_y, .moment_z, .contact_area",
        "in space: force in z, moments about the axes, area that soil touches [N, N m, m2]; forces are in N",
    ),
    (
        "rigid.BODY.velocity_x, .velocity_y, .spin",
        "velocity of its centre of mass [m/s] and angular velocity, anticlockwise [rad/s], in motion; in space .velocity_z, .spin_x, .spin_y, .spin_z",
    ),
    (
        "rigid.BODY.contact_width",
        "length of its sides that soil touches [m]",
    ),
    (
        "rigid.BODY.penetration, .closed, .slipping",
        "largest penetration as a share of the cell; points of its sides that soil touches, and slips along [-]",
    ),
    (
        "reinforcement.MEMBER.force, reinforcement.MEMBER.head_force",
        "largest tension along an anchor, a nail or a geotextile, and that at its head [N/m]",
    ),
    (
        "reinforcement.MEMBER.at_limit",
        "share of its length on which its tension is at its limit [-]",
    ),
    (
        "seepage.WATER.outflow, seepage.WATER.section.SECTION",
        "water that leaves the ground in the flow of a condition, and that passes a section of it towards the positive axis [m2/s, m3/s in space]",
    ),
    ("LOAD.factor", "factor on a pressure or point load [-]"),
    (
        "MONITOR.FIELD",
        "a field at a monitor, as in crest.displacement",
    ),
    (
        "largest_displacement",
        "largest displacement of all particles [m]",
    ),
    ("gravity_factor", "multiple of gravity [-]"),
    (
        "horizontal_factor",
        "pseudo-static horizontal force over the weight [-]",
    ),
    ("reduction_factor", "strength reduction factor [-]"),
    ("step", "number of the step in its stage [-]"),
    ("plastic_share", "share of particles that yield [-]"),
    ("top", "height of the highest particle's upper edge [m]"),
    ("time", "time since the first stage that takes some [s]"),
    (
        "kinetic_energy",
        "kinetic energy of particles and rigid bodies, in stages that take time [J/m, J in space]",
    ),
    (
        "factor_of_safety",
        "middle of the interval a strength reduction found, in checks only [-]",
    ),
];
