//! Reinforcement: anchors, nails and geotextiles.

use super::{MANY, POINT};
use crate::quantity::Dimension::{Force, ForcePerLength, Length, Stress};
use crate::spec::{
    Field, Kind, Range, Variant, Variants, default, derived, in_plane, in_space, optional, required,
};

const HEAD: Field = required("head", POINT, "[\"10 m\", \"6 m\"]", "where its head is");
const END: Field = required(
    "end",
    POINT,
    "[\"2 m\", \"4 m\"]",
    "where it ends in the ground",
);

/// A force that something carries at an end.
const fn fastening(key: &'static str, doc: &'static str) -> Field {
    in_plane(default(
        key,
        Kind::Quantity(ForcePerLength, Range::NotNegative),
        "\"0 kN/m\"",
        doc,
    ))
}

/// The same of a member in space.
const fn whole_fastening(key: &'static str, doc: &'static str) -> Field {
    in_space(default(
        key,
        Kind::Quantity(Force, Range::NotNegative),
        "\"0 kN\"",
        doc,
    ))
}

const PLATE: Field = default(
    "plate",
    Kind::Quantity(Length, Range::NotNegative),
    "\"0 m\"",
    "width of the plate or facing on which the force at its head spreads, along the edge of the soil there; in space the side of a square on the surface there",
);

/// A member, by type.
pub(super) static REINFORCEMENT: Kind = Kind::Variants(&Variants {
    doc: "A member that pulls and neither bends nor pushes. In plane strain all forces are per metre run: those of one, over the spacing. In space it is one anchor or nail.",
    tag: "type",
    tag_doc: "kind of reinforcement",
    before: &[required("name", Kind::Name, "\"nail 1\"", "name")],
    cases: &[
        Variant {
            name: "anchor",
            doc: "A ground anchor: a head, a free length without bond, and a bonded length at its end.",
            fields: &[
                HEAD,
                END,
                required(
                    "bonded_length",
                    Kind::Quantity(Length, Range::Positive),
                    "\"4 m\"",
                    "length at its end that is bonded to the soil",
                ),
                in_plane(derived(
                    "head_capacity",
                    Kind::Quantity(ForcePerLength, Range::NotNegative),
                    "its capacity",
                    "force that its head carries",
                )),
                in_space(derived(
                    "head_capacity",
                    Kind::Quantity(Force, Range::NotNegative),
                    "its capacity",
                    "force that its head carries",
                )),
                PLATE,
                in_plane(optional(
                    "prestress",
                    Kind::Quantity(ForcePerLength, Range::Positive),
                    "it begins without tension",
                    "tension at which it is locked off at the end of the stage that installs it",
                )),
                in_space(optional(
                    "prestress",
                    Kind::Quantity(Force, Range::Positive),
                    "it begins without tension",
                    "tension at which it is locked off at the end of the stage that installs it",
                )),
            ],
        },
        Variant {
            name: "nail",
            doc: "A soil nail, bonded over its whole length.",
            fields: &[
                HEAD,
                END,
                fastening("head_capacity", "force that the plate at its head carries"),
                whole_fastening("head_capacity", "force that the plate at its head carries"),
                PLATE,
            ],
        },
        Variant {
            name: "geotextile",
            doc: "In plane strain: a geotextile or geogrid, bonded over its whole length.",
            fields: &[
                required(
                    "points",
                    Kind::List(&POINT, 2, MANY),
                    "[[\"0 m\", \"3 m\"], [\"12 m\", \"3 m\"]]",
                    "its line, from one end to the other",
                ),
                fastening(
                    "head_capacity",
                    "force that holds it at its first point, as by a facing",
                ),
                fastening("end_capacity", "force that holds it at its last point"),
            ],
        },
    ],
    after: &[
        in_plane(required(
            "stiffness",
            Kind::Quantity(ForcePerLength, Range::Positive),
            "\"20 MN/m\"",
            "axial stiffness EA",
        )),
        in_space(required(
            "stiffness",
            Kind::Quantity(Force, Range::Positive),
            "\"40 MN\"",
            "axial stiffness EA",
        )),
        in_plane(required(
            "capacity",
            Kind::Quantity(ForcePerLength, Range::Positive),
            "\"100 kN/m\"",
            "tension that it carries at most",
        )),
        in_space(required(
            "capacity",
            Kind::Quantity(Force, Range::Positive),
            "\"200 kN\"",
            "tension that it carries at most",
        )),
        in_plane(required(
            "bond",
            Kind::Quantity(Stress, Range::NotNegative),
            "\"30 kPa\"",
            "pull-out resistance per metre of its length: of a geotextile, that of both faces",
        )),
        in_space(required(
            "bond",
            Kind::Quantity(ForcePerLength, Range::NotNegative),
            "\"60 kN/m\"",
            "pull-out resistance per metre of its length",
        )),
        default(
            "reduce_bond",
            Kind::Flag,
            "false",
            "whether a strength reduction divides the bond too; capacities are left alone",
        ),
    ],
});
