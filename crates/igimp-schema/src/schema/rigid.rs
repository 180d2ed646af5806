//! Rigid bodies that soil touches, and how stages move them.

use super::{LENGTH, MANY, MOST_THINGS, POINT};
use crate::quantity::Dimension::{
    self, Angle, Force, ForcePerLength, Length, Moment, MomentPerLength, Stress,
};
use crate::spec::{
    Choice, Field, Kind, Range, Struct, Variant, Variants, choice, default, in_plane, in_space,
    optional, required,
};

static CORNER: Kind = Kind::List(&LENGTH, 2, 2);

const INTERFACE: Kind = Kind::Either(&[Kind::Choice(&INTERFACES), Kind::Table(&LIMITED)]);

static INTERFACES: [Choice; 2] = [
    choice("smooth", "soil slides along without shear"),
    choice("rough", "soil sticks while it touches"),
];

static LIMITED: Struct = Struct {
    doc: "Shear along an interface up to adhesion and friction.",
    fields: &[
        optional(
            "friction",
            Kind::Number(Range::NotNegative),
            "`angle` says it, or there is none",
            "coefficient of friction",
        ),
        optional(
            "angle",
            Kind::Quantity(Angle, Range::NotNegative),
            "`friction` says it, or there is none",
            "angle of friction",
        ),
        optional(
            "adhesion",
            Kind::Quantity(Stress, Range::NotNegative),
            "`adhesion_share` says it, or there is none",
            "shear that is carried without pressure, while soil touches",
        ),
        optional(
            "adhesion_share",
            Kind::Number(Range::NotNegative),
            "`adhesion` says it, or there is none",
            "the same as a share of the undrained strength, or the cohesion, of the soil that touches",
        ),
    ],
};

static TENSIONS: [Choice; 2] = [
    choice("none", "soil that is pulled lets go"),
    choice("bonded", "soil that touched never lets go"),
];

const TENSION: Kind = Kind::Choice(&TENSIONS);
const TENSION_DOC: &str = "when soil is pulled off";

/// The limit of tension of a body or a side, with what holds where none is given.
const fn tension_limit(without: &'static str) -> Field {
    optional(
        "tension_limit",
        Kind::Quantity(Stress, Range::Positive),
        without,
        "tension at which a side lets go for good",
    )
}

static SIDE_NAMES: [Choice; 11] = [
    choice("bottom", "lower side of a rectangle"),
    choice("right", "right side of a rectangle"),
    choice("top", "upper side of a rectangle"),
    choice("left", "left side of a rectangle"),
    choice("face", "the side of a wall from `from` to `to`"),
    choice("front", "front of a box"),
    choice("back", "back of a box"),
    choice("shaft", "shaft of a cylinder or a cone"),
    choice("tip", "face of the tip of a cone"),
    choice("start", "lower end of a level cylinder"),
    choice("end", "its other end"),
];

static SIDE: Kind = Kind::Table(&Struct {
    doc: "A side of a rigid body that is unlike the others.",
    fields: &[
        required(
            "side",
            Kind::Either(&[Kind::Integer(1, MANY as i64), Kind::Choice(&SIDE_NAMES)]),
            "\"bottom\"",
            "which: by name, or by the number of the corner that it begins with, from 1",
        ),
        optional("interface", INTERFACE, "that of the body", "along the side"),
        optional("tension", TENSION, "that of the body", TENSION_DOC),
        tension_limit("that of the body"),
    ],
});

const FROM_START: Field = default(
    "from_start",
    Kind::Flag,
    "false",
    "whether it is there from the start, held, rather than from the first stage that names it",
);

/// A length of a shape.
const fn a_length(key: &'static str, example: &'static str, doc: &'static str) -> Field {
    required(key, Kind::Quantity(Length, Range::Positive), example, doc)
}

/// A rigid body, by type of shape.
pub(super) static RIGID: Kind = Kind::Variants(&Variants {
    doc: "A rigid body that soil touches, slides along and leaves.",
    tag: "type",
    tag_doc: "shape",
    before: &[required("name", Kind::Name, "\"footing\"", "name")],
    cases: &[
        Variant {
            name: "rectangle",
            doc: "A level rectangle. Its sides are bottom, right, top, left.",
            fields: &[
                required("from", POINT, "[\"0 m\", \"5 m\"]", "one corner"),
                required("to", POINT, "[\"1 m\", \"6 m\"]", "the opposite corner"),
            ],
        },
        Variant {
            name: "polygon",
            doc: "A polygon. Its sides are numbered from 1 by the corners that they begin with.",
            fields: &[required(
                "corners",
                Kind::List(&CORNER, 3, MANY),
                "[[\"0 m\", \"5 m\"], [\"1 m\", \"7 m\"], [\"-1 m\", \"7 m\"]]",
                "corners in order, either way round",
            )],
        },
        Variant {
            name: "circle",
            doc: "A circle: a pipe, a bar, a pile in section. It has one side.",
            fields: &[
                required("centre", POINT, "[\"0 m\", \"5.5 m\"]", "centre"),
                a_length("radius", "\"0.5 m\"", "radius"),
            ],
        },
        Variant {
            name: "wall",
            doc: "A wall by its face. It lies to the left of the way from one end to the other.",
            fields: &[
                required("from", POINT, "[\"0 m\", \"0 m\"]", "one end of the face"),
                required("to", POINT, "[\"0 m\", \"5 m\"]", "the other end"),
                a_length("thickness", "\"1 m\"", "thickness"),
            ],
        },
        Variant {
            name: "box",
            doc: "In space: a box with its sides along the axes. Its sides are left, right, front, back, bottom, top.",
            fields: &[
                required("from", POINT, "[\"0 m\", \"0 m\", \"5 m\"]", "one corner"),
                required(
                    "to",
                    POINT,
                    "[\"1 m\", \"1 m\", \"6 m\"]",
                    "the opposite corner",
                ),
            ],
        },
        Variant {
            name: "cylinder",
            doc: "In space: a cylinder along an axis. Its sides are bottom, shaft, top; of a level one start, shaft, end.",
            fields: &[
                default(
                    "axis",
                    Kind::Choice(&DIRECTIONS),
                    "\"z\"",
                    "direction of its axis",
                ),
                required(
                    "middle",
                    POINT,
                    "[\"0 m\", \"0 m\", \"5.5 m\"]",
                    "its middle",
                ),
                a_length("radius", "\"0.5 m\"", "radius"),
                a_length("length", "\"1 m\"", "length along its axis"),
            ],
        },
        Variant {
            name: "sphere",
            doc: "In space: a sphere. It has one side.",
            fields: &[
                required("centre", POINT, "[\"0 m\", \"0 m\", \"5.5 m\"]", "centre"),
                a_length("radius", "\"0.5 m\"", "radius"),
            ],
        },
        Variant {
            name: "cone",
            doc: "In space: a cone with its tip down, and a shaft above it. Its sides are tip, shaft, top.",
            fields: &[
                required("tip", POINT, "[\"0 m\", \"0 m\", \"5 m\"]", "its tip"),
                a_length("radius", "\"0.25 m\"", "radius of its upper end"),
                a_length("height", "\"0.43 m\"", "height of the cone"),
                default(
                    "shaft",
                    Kind::Quantity(Length, Range::NotNegative),
                    "\"0 m\"",
                    "length of the shaft",
                ),
            ],
        },
        Variant {
            name: "surface",
            doc: "In space: a closed surface of triangles. It has one side.",
            fields: &[required(
                "surface",
                Kind::Table(&super::solids::SURFACE_TABLE),
                "{ file = \"pile.stl\", unit = \"m\" }",
                "the surface",
            )],
        },
    ],
    after: &[
        in_plane(optional(
            "reference",
            POINT,
            "the middle of the base of a rectangle, of the face of a wall, of the extent of others",
            "point that displacement and forces are told of; a circle has its centre",
        )),
        default("interface", INTERFACE, "\"rough\"", "along all its sides"),
        default("tension", TENSION, "\"none\"", TENSION_DOC),
        tension_limit("as `tension` says"),
        default(
            "sides",
            Kind::List(&SIDE, 0, MOST_THINGS),
            "[]",
            "sides that are unlike the others",
        ),
        in_plane(default(
            "weight",
            Kind::Quantity(ForcePerLength, Range::NotNegative),
            "\"0 kN/m\"",
            "own weight of the whole body, at its reference point; acts with gravity",
        )),
        in_space(default(
            "weight",
            Kind::Quantity(Force, Range::NotNegative),
            "\"0 kN\"",
            "own weight of the whole body, at its middle; acts with gravity",
        )),
        default(
            "force_factor",
            Kind::Number(Range::Positive),
            "1",
            "whole body over the part that is modelled, 2 for half a body: forces are those of the whole",
        ),
        FROM_START,
        default(
            "grid_follows",
            Kind::Flag,
            "false",
            "whether the rows of the grid go down with it; its lowest place lies on a row",
        ),
        default(
            "rounding",
            Kind::Number(Range::NotNegative),
            "0.5",
            "radius of its corners in cells; soil slips off a rounding, which carries nothing",
        ),
        default(
            "stiffness",
            Kind::Number(Range::Positive),
            "30",
            "stiffness of contact, in Young's moduli per cell",
        ),
        default(
            "most_penetration",
            Kind::Number(Range::Positive),
            "0.1",
            "penetration that ends the run, as a share of the cell",
        ),
    ],
});

static DIRECTIONS: [Choice; 3] = [
    choice("x", "to the right"),
    choice("y", "to the back"),
    choice("z", "up"),
];

static COMPONENTS: [Choice; 7] = [
    choice("x", "displacement in x"),
    choice("y", "displacement in y"),
    choice("rotation", "rotation, in plane strain"),
    choice("z", "displacement in z, in space"),
    choice("rotation_x", "rotation about x, in space"),
    choice("rotation_y", "rotation about y, in space"),
    choice("rotation_z", "rotation about z, in space"),
];
static COMPONENT: Kind = Kind::Choice(&COMPONENTS);

/// What a component of the motion goes on by.
const fn by(key: &'static str, dimension: Dimension, doc: &'static str) -> Field {
    optional(
        key,
        Kind::Quantity(dimension, Range::Any),
        "as before; held at first",
        doc,
    )
}

/// What loads a component of the motion.
const fn load(key: &'static str, dimension: Dimension, doc: &'static str) -> Field {
    optional(key, Kind::Quantity(dimension, Range::Any), "as before", doc)
}

/// How a stage moves a rigid body.
pub(super) static MOVE: Kind = Kind::Table(&Struct {
    doc: "How a rigid body moves in a stage. What is not mentioned goes on as before: held, or under its force.",
    fields: &[
        required(
            "body",
            Kind::Reference("rigid body"),
            "\"footing\"",
            "which",
        ),
        by("x", Length, "further displacement in x"),
        by(
            "y",
            Length,
            "further displacement in y, in plane strain negative downwards",
        ),
        in_space(by(
            "z",
            Length,
            "further displacement in z, negative downwards",
        )),
        in_plane(by("rotation", Angle, "further rotation, anticlockwise")),
        in_space(by("rotation_x", Angle, "further rotation about x")),
        in_space(by("rotation_y", Angle, "further rotation about y")),
        in_space(by("rotation_z", Angle, "further rotation about z")),
        in_plane(load(
            "force_x",
            ForcePerLength,
            "force on it in x at the end of the stage",
        )),
        in_plane(load(
            "force_y",
            ForcePerLength,
            "force on it in y at the end of the stage, negative downwards, beside its weight",
        )),
        in_plane(load(
            "moment",
            MomentPerLength,
            "moment on it about its reference point at the end of the stage, anticlockwise",
        )),
        in_space(load(
            "force_x",
            Force,
            "force on it in x at the end of the stage",
        )),
        in_space(load(
            "force_y",
            Force,
            "force on it in y at the end of the stage",
        )),
        in_space(load(
            "force_z",
            Force,
            "force on it in z at the end of the stage, negative downwards, beside its weight",
        )),
        in_space(load(
            "moment_x",
            Moment,
            "moment on it about x through its reference point at the end of the stage",
        )),
        in_space(load("moment_y", Moment, "moment on it about y")),
        in_space(load("moment_z", Moment, "moment on it about z")),
        default(
            "free",
            Kind::List(&COMPONENT, 0, 6),
            "[]",
            "components that no force and no moment holds by the end of the stage",
        ),
    ],
});
