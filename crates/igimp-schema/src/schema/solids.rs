//! Bodies in space: boxes, prisms, cylinders, spheres, closed surfaces, layers of ground.

use super::{LENGTH, MANY, MOST_THINGS, OUTLINE, PAIR, POINT};
use crate::quantity::Dimension::Length;
use crate::spec::{Choice, Field, Kind, Range, Struct, choice, default, optional, required};

static CORNER: Kind = PAIR;
static VERTEX: Kind = POINT;
static INDEX: Kind = Kind::Integer(0, MANY as i64);
static TRIANGLE: Kind = Kind::List(&INDEX, 3, 3);
static HOLE: Kind = Kind::List(&INDEX, 2, 2);
static ROW: Kind = Kind::List(&LENGTH, 2, MANY);

const OTHER: &str = "another shape is stated";
pub(super) const POLYGON: Kind =
    Kind::Either(&[Kind::List(&CORNER, 3, MANY), Kind::Table(&OUTLINE)]);

pub(super) const BOX: Field = optional(
    "box",
    Kind::Table(&BOX_TABLE),
    OTHER,
    "box with its sides along the axes",
);
pub(super) const SECTION: Field = optional(
    "polygon",
    POLYGON,
    OTHER,
    "corners of a polygon in x and z, either way round, or where they come from; `across` makes it a slice",
);
pub(super) const ACROSS: Field = optional(
    "across",
    PAIR,
    "`polygon` is not stated",
    "from where to where on y the polygon reaches",
);
pub(super) const PLAN: Field = optional(
    "plan",
    POLYGON,
    OTHER,
    "corners of a polygon in plan, x and y, either way round, or where they come from; `between` says how high",
);
pub(super) const BETWEEN: Field = optional(
    "between",
    Kind::List(&HEIGHT, 2, 2),
    "`plan` is not stated",
    "bottom and top over the plan: levels z, or surfaces of the ground",
);
pub(super) const CYLINDER: Field = optional(
    "cylinder",
    Kind::Table(&CYLINDER_TABLE),
    OTHER,
    "circular cylinder along an axis",
);
pub(super) const SPHERE: Field = optional("sphere", Kind::Table(&SPHERE_TABLE), OTHER, "sphere");
pub(super) const SURFACE: Field = optional(
    "surface",
    Kind::Table(&SURFACE_TABLE),
    OTHER,
    "closed surface of triangles",
);

pub(super) const MINUS: Field = default(
    "minus",
    Kind::List(&TAKEN, 0, MOST_THINGS),
    "[]",
    "solids that are taken out of it, each with the keys of a shape",
);

static TAKEN: Kind = Kind::Table(&Struct {
    doc: "A solid that is taken out of a body.",
    fields: &[
        BOX, SECTION, ACROSS, PLAN, BETWEEN, CYLINDER, SPHERE, SURFACE,
    ],
});

static BOX_TABLE: Struct = Struct {
    doc: "A box with its sides along the axes.",
    fields: &[
        required("from", POINT, "[\"0 m\", \"0 m\", \"0 m\"]", "one corner"),
        required(
            "to",
            POINT,
            "[\"4 m\", \"2 m\", \"1 m\"]",
            "the opposite corner",
        ),
    ],
};

static AXES: [Choice; 3] = [
    choice("x", "to the right"),
    choice("y", "to the back"),
    choice("z", "up"),
];

static CYLINDER_TABLE: Struct = Struct {
    doc: "A circular cylinder along an axis.",
    fields: &[
        default(
            "axis",
            Kind::Choice(&AXES),
            "\"z\"",
            "direction of its axis",
        ),
        required(
            "centre",
            PAIR,
            "[\"2 m\", \"1 m\"]",
            "centre of its circle by the two other axes, in their order",
        ),
        required(
            "radius",
            Kind::Quantity(Length, Range::Positive),
            "\"0.5 m\"",
            "radius",
        ),
        required(
            "between",
            PAIR,
            "[\"0 m\", \"1 m\"]",
            "from where to where on its axis",
        ),
    ],
};

static SPHERE_TABLE: Struct = Struct {
    doc: "A sphere.",
    fields: &[
        required("centre", POINT, "[\"2 m\", \"1 m\", \"0.5 m\"]", "centre"),
        required(
            "radius",
            Kind::Quantity(Length, Range::Positive),
            "\"0.5 m\"",
            "radius",
        ),
    ],
};

pub(super) static SURFACE_TABLE: Struct = Struct {
    doc: "A closed surface: an STL file, or corners and the triangles between them.",
    fields: &[
        optional(
            "file",
            Kind::Text,
            "`vertices` and `triangles` say it",
            "an STL file, ASCII or binary; its path from the case file",
        ),
        optional(
            "unit",
            Kind::Text,
            "`vertices` have units of their own",
            "unit of length of the file",
        ),
        optional(
            "vertices",
            Kind::List(&VERTEX, 4, MANY),
            "`file` says it",
            "corners",
        ),
        optional(
            "triangles",
            Kind::List(&TRIANGLE, 4, MANY),
            "`file` says it",
            "three numbers of vertices each, from 0, counter-clockwise as seen from outside",
        ),
    ],
};

static HEIGHT: Kind = Kind::Either(&[Kind::Quantity(Length, Range::Any), Kind::Table(&TERRAIN)]);

pub(super) static TERRAIN: Struct = Struct {
    doc: "A surface of the ground: an ESRI ASCII grid, points from a CSV file, points, or heights on lines.",
    fields: &[
        optional(
            "raster",
            Kind::Text,
            "another key says it",
            "an ESRI ASCII grid; its path from the case file",
        ),
        optional(
            "points",
            Kind::Either(&[Kind::Text, Kind::List(&VERTEX, 3, MANY)]),
            "another key says it",
            "a CSV file with the columns x, y and z, or points; those that fill no rectangle are joined by Delaunay's triangles in plan",
        ),
        optional(
            "unit",
            Kind::Text,
            "the header says it, as in `x [ft]`",
            "unit of length of the file",
        ),
        optional(
            "x",
            Kind::List(&LENGTH, 2, MANY),
            "another key says it",
            "lines of heights, ascending",
        ),
        optional(
            "y",
            Kind::List(&LENGTH, 2, MANY),
            "another key says it",
            "lines of heights, ascending",
        ),
        optional(
            "rows",
            Kind::List(&ROW, 2, MANY),
            "another key says it",
            "heights by y, then by x",
        ),
        default(
            "holes",
            Kind::List(&HOLE, 0, MANY),
            "[]",
            "columns and rows, from 0, where no height is known",
        ),
    ],
};
