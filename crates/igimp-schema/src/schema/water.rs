//! Conditions of the water, and what stages of construction change.

use super::materials::in_plane;
use super::solids::TERRAIN;
use super::{A_LENGTH, CORNER, MANY, MOST_THINGS};
use crate::quantity::Dimension::Stress;
use crate::spec::{Field, Kind, Range, Struct, default, derived, in_space, optional, required};

const LEVEL: Field = optional(
    "level",
    A_LENGTH,
    "another key says it",
    "level of a table that is level everywhere",
);
const LINE: Field = optional(
    "line",
    Kind::List(&CORNER, 2, MANY),
    "another key says it",
    "points of the water table from left to right, x and height; it is level beyond its ends, and in space the same for every y",
);
const SURFACE: Field = in_space(optional(
    "surface",
    Kind::Table(&TERRAIN),
    "another key says it",
    "surface that is the water table",
));
const RATIO: Field = optional(
    "r_u",
    Kind::Number(Range::Any),
    "another key says it",
    "pore pressure as a share of the weight of the ground above, from 0 to 1",
);
const DRY: Field = optional("dry", Kind::Flag, "another key says it", "no pore pressure");

static A_PRESSURE: Kind = Kind::Quantity(Stress, Range::Any);
static PRESSURES: Kind = Kind::List(&A_PRESSURE, 1, MANY);

static IN_PLANE: Struct = Struct {
    doc: "Pore pressures by points in the plane, in space by x and height for every y: `raster`, or `x`, `y` and `rows`. Less than none counts as none.",
    fields: &in_plane(&PRESSURES),
};
const POINTS: Field = optional(
    "u",
    Kind::Table(&IN_PLANE),
    "another key says it",
    "pore pressure by points in the plane, as a seepage analysis gives it",
);

static OWN: Kind = Kind::Table(&Struct {
    doc: "A body with a pore pressure of its own: one of `level`, `line`, `r_u`, `u` and `dry`.",
    fields: &[
        required("body", Kind::Reference("body"), "\"clay\"", "the body"),
        LEVEL,
        LINE,
        SURFACE,
        RATIO,
        POINTS,
        DRY,
    ],
});

/// A condition of the water.
pub(super) static WATER: Kind = Kind::Table(&Struct {
    doc: "A condition of the water: one of `level`, `line`, in space `surface`, `inside` with `outside`, `r_u`, `u` and `dry`. The first holds from the \
          start, the others from the stages that name them.",
    fields: &[
        required("name", Kind::Name, "\"full\"", "name"),
        LEVEL,
        LINE,
        SURFACE,
        optional(
            "inside",
            A_LENGTH,
            "another key says it",
            "level of the table within the ground, with `outside`: drawdown; where the ground lies lower, the table follows it",
        ),
        optional(
            "outside",
            A_LENGTH,
            "another key says it",
            "level of the free water outside, with `inside`",
        ),
        RATIO,
        POINTS,
        DRY,
        derived(
            "pond",
            Kind::Flag,
            "true with `level` and `outside`, false otherwise",
            "whether water above the ground is meant: a pond that presses on it",
        ),
        default(
            "carried",
            Kind::Flag,
            "false",
            "whether soil carries the pressure of the place where it started along",
        ),
        default(
            "bodies",
            Kind::List(&OWN, 0, MOST_THINGS),
            "[]",
            "bodies with a pressure of their own",
        ),
    ],
});

static BODY_NAME: Kind = Kind::Reference("body");

static CHANGE: Kind = Kind::Table(&Struct {
    doc: "A body that consists of another material from now on.",
    fields: &[
        required("body", Kind::Reference("body"), "\"clay\"", "the body"),
        required(
            "material",
            Kind::Reference("material"),
            "\"treated\"",
            "what it becomes",
        ),
    ],
});

/// The keys of a construction stage, without its geometry.
pub(super) const CONSTRUCTION: [Field; 5] = [
    default(
        "place",
        Kind::List(&BODY_NAME, 0, MOST_THINGS),
        "[]",
        "bodies that are placed, free of stress where they are drawn; they are not there before",
    ),
    default(
        "remove",
        Kind::List(&BODY_NAME, 0, MOST_THINGS),
        "[]",
        "bodies that are taken away",
    ),
    default(
        "materials",
        Kind::List(&CHANGE, 0, MOST_THINGS),
        "[]",
        "bodies that consist of another material from now on",
    ),
    optional(
        "water",
        Kind::Reference("water condition"),
        "as before",
        "condition of the water from now on",
    ),
    default(
        "dissipate",
        Kind::Flag,
        "false",
        "whether excess pore pressure of undrained soil is gone at the end",
    ),
];
