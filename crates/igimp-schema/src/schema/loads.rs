//! Loads.

use super::solids::POLYGON;
use super::{PAIR, POINT};
use crate::quantity::Dimension::{Force, ForcePerLength, Length, Stress};
use crate::spec::{
    Choice, Kind, Range, Struct, Variant, Variants, choice, default, in_plane, in_space, optional,
    required,
};

static FORCE: Kind = Kind::Quantity(ForcePerLength, Range::Any);
static WHOLE_FORCE: Kind = Kind::Quantity(Force, Range::Any);

static CIRCLE: Struct = Struct {
    doc: "A circle in plan.",
    fields: &[
        required("centre", PAIR, "[\"2 m\", \"2 m\"]", "centre, x and y"),
        required(
            "radius",
            Kind::Quantity(Length, Range::Positive),
            "\"1 m\"",
            "radius",
        ),
    ],
};

static INTERFACES: [Choice; 2] = [
    choice("rough", "soil sticks to base and shaft"),
    choice("smooth", "soil slides along base and shaft"),
];

static DIRECTIONS: [Choice; 2] = [
    choice("normal", "across the segment, into the soil"),
    choice("down", "along gravity"),
];

/// A load, by type.
pub(super) static LOAD: Kind = Kind::Variants(&Variants {
    doc: "A load that stages apply.",
    tag: "type",
    tag_doc: "kind of load",
    before: &[required("name", Kind::Name, "\"footing\"", "name")],
    cases: &[
        Variant {
            name: "rigid-footing",
            doc: "A level rigid footing, pushed down by displacement stages. The grid follows.",
            fields: &[
                required("from", POINT, "[\"0 m\", \"5 m\"]", "one end of the base"),
                required(
                    "to",
                    POINT,
                    "[\"1 m\", \"5 m\"]",
                    "the other end, at the same level",
                ),
                default(
                    "interface",
                    Kind::Choice(&INTERFACES),
                    "\"rough\"",
                    "between soil and footing",
                ),
                default(
                    "reaction_factor",
                    Kind::Number(Range::Positive),
                    "1",
                    "factor on the reported reaction, 2 for half a footing",
                ),
            ],
        },
        Variant {
            name: "pressure",
            doc: "A dead pressure on a segment of the surface, in space on a level or upright rectangle, raised by load stages.",
            fields: &[
                required(
                    "from",
                    POINT,
                    "[\"0 m\", \"5 m\"]",
                    "one end, in space one corner",
                ),
                required(
                    "to",
                    POINT,
                    "[\"2 m\", \"5 m\"]",
                    "the other end, in space the opposite corner",
                ),
                required(
                    "pressure",
                    Kind::Quantity(Stress, Range::Any),
                    "\"100 kPa\"",
                    "pressure at factor 1, positive into the soil",
                ),
                default(
                    "direction",
                    Kind::Choice(&DIRECTIONS),
                    "\"normal\"",
                    "which way it acts",
                ),
            ],
        },
        Variant {
            name: "patch",
            doc: "In space: a dead pressure down on a level circle or polygon, raised by load stages. What of it lies beyond the grid is left out, as behind a plane of symmetry.",
            fields: &[
                optional(
                    "circle",
                    Kind::Table(&CIRCLE),
                    "`plan` says it",
                    "the circle that it covers",
                ),
                optional(
                    "plan",
                    POLYGON,
                    "`circle` says it",
                    "corners of the polygon that it covers, x and y, either way round",
                ),
                required(
                    "level",
                    Kind::Quantity(Length, Range::Any),
                    "\"5 m\"",
                    "height z of the surface on which it lies",
                ),
                required(
                    "pressure",
                    Kind::Quantity(Stress, Range::Any),
                    "\"100 kPa\"",
                    "pressure at factor 1, positive downwards",
                ),
            ],
        },
        Variant {
            name: "point",
            doc: "A dead force at a point, raised by load stages.",
            fields: &[
                required("at", POINT, "[\"2 m\", \"5 m\"]", "where"),
                in_plane(required(
                    "force",
                    Kind::Vector(&FORCE),
                    "[\"0 kN/m\", \"-10 kN/m\"]",
                    "force at factor 1, x and y, per metre run",
                )),
                in_space(required(
                    "force",
                    Kind::Vector(&WHOLE_FORCE),
                    "[\"0 kN\", \"0 kN\", \"-10 kN\"]",
                    "force at factor 1, x, y and z",
                )),
            ],
        },
    ],
    after: &[],
});
