//! Materials.

use crate::input::quantity::Dimension::{Angle, Stress, UnitWeight};
use crate::input::spec::{
    Choice, Field, Kind, Range, Variant, Variants, choice, default, optional, required,
};

/// What books call a field, and its keys here: of these the one that the material has is meant.
pub(in crate::input) static SYMBOLS: [(&str, &[&str]); 20] = [
    ("gamma", &["unit_weight"]),
    ("γ", &["unit_weight"]),
    ("weight", &["unit_weight"]),
    ("e", &["young"]),
    ("modulus", &["young"]),
    ("youngs_modulus", &["young"]),
    ("nu", &["poisson"]),
    ("ν", &["poisson"]),
    ("c", &["cohesion", "cu"]),
    ("c'", &["cohesion"]),
    ("c_u", &["cu"]),
    ("su", &["cu"]),
    ("s_u", &["cu"]),
    ("phi", &["friction"]),
    ("phi'", &["friction"]),
    ("φ", &["friction"]),
    ("friction_angle", &["friction"]),
    ("psi", &["dilation"]),
    ("ψ", &["dilation"]),
    ("dilatancy", &["dilation"]),
];

const CU: Field = required(
    "cu",
    Kind::Quantity(Stress, Range::Positive),
    "\"50 kPa\"",
    "undrained shear strength in plane strain",
);

/// A material, by model.
pub(in crate::input) static MATERIAL: Variants = Variants {
    doc: "A material.",
    tag: "model",
    tag_doc: "constitutive law",
    before: &[],
    cases: &[
        Variant {
            name: "elastic",
            doc: "Hencky elasticity without a strength limit.",
            fields: &[],
        },
        Variant {
            name: "von-mises",
            doc: "Elastic and perfectly plastic, von Mises.",
            fields: &[CU],
        },
        Variant {
            name: "tresca",
            doc: "Elastic and perfectly plastic, Tresca.",
            fields: &[CU],
        },
        Variant {
            name: "mohr-coulomb",
            doc: "Elastic and perfectly plastic, Mohr-Coulomb with non-associated flow.",
            fields: &[
                required(
                    "cohesion",
                    Kind::Quantity(Stress, Range::NotNegative),
                    "\"10 kPa\"",
                    "cohesion c",
                ),
                required(
                    "friction",
                    Kind::Quantity(Angle, Range::NotNegative),
                    "\"20 deg\"",
                    "friction angle, below 90 deg",
                ),
                default(
                    "dilation",
                    Kind::Quantity(Angle, Range::NotNegative),
                    "\"0 deg\"",
                    "dilation angle, at most the friction angle",
                ),
                optional(
                    "tension_cutoff",
                    Kind::Quantity(Stress, Range::NotNegative),
                    "the apex of the cone limits tension",
                    "largest tensile stress",
                ),
            ],
        },
    ],
    after: &[
        required(
            "unit_weight",
            Kind::Quantity(UnitWeight, Range::NotNegative),
            "\"18 kN/m3\"",
            "unit weight",
        ),
        required(
            "young",
            Kind::Quantity(Stress, Range::Positive),
            "\"20 MPa\"",
            "Young's modulus",
        ),
        required(
            "poisson",
            Kind::Number(Range::NotNegative),
            "0.3",
            "Poisson's ratio, below 0.5",
        ),
        optional(
            "k0",
            Kind::Either(&[Kind::Number(Range::NotNegative), Kind::Choice(&JAKY)]),
            "an elastic material takes poisson / (1 - poisson)",
            "coefficient of earth pressure at rest, for stages of type k0",
        ),
    ],
};

static JAKY: [Choice; 1] = [choice("jaky", "1 - sin(friction)")];
