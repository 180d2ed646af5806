//! Materials.

use super::{A_LENGTH, LENGTH, MANY};
use crate::input::quantity::Dimension::{
    Angle, Stress, StressGradient, UnitWeight, UnitWeightGradient,
};
use crate::input::spec::{
    Choice, Field, Kind, Range, Struct, Variant, Variants, choice, default, derived, optional,
    required,
};

/// What books call a field, and its keys here: of these the one that the material has is meant.
pub(in crate::input) static SYMBOLS: [(&str, &[&str]); 22] = [
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
    ("gamma_sat", &["saturated_unit_weight"]),
    ("nu_u", &["undrained_poisson"]),
];

static A_STRESS: Kind = Kind::Quantity(Stress, Range::NotNegative);
static A_UNIT_WEIGHT: Kind = Kind::Quantity(UnitWeight, Range::NotNegative);
static STRESSES: Kind = Kind::List(&A_STRESS, 1, MANY);
static UNIT_WEIGHTS: Kind = Kind::List(&A_UNIT_WEIGHT, 1, MANY);

/// The keys of a property that varies.
const fn profile(
    top: Kind,
    gradient: Kind,
    values: &'static Kind,
    rows: &'static Kind,
) -> [Field; 11] {
    [
        optional(
            "at_top",
            top,
            "`levels` and `values` say it",
            "value at the level `from` and above",
        ),
        optional(
            "gradient",
            gradient,
            "`levels` and `values` say it",
            "growth with depth below `from`",
        ),
        optional(
            "from",
            A_LENGTH,
            "the highest soil of the material",
            "level y where the growth begins",
        ),
        optional(
            "levels",
            Kind::List(&LENGTH, 2, MANY),
            "`at_top` and `gradient` say it",
            "levels y, all upwards or all downwards",
        ),
        optional(
            "values",
            Kind::List(values, 2, MANY),
            "`at_top` and `gradient` say it",
            "values there; linear between the levels, constant beyond",
        ),
        optional(
            "raster",
            Kind::Text,
            "the property does not come from a file",
            "a CSV file with the columns x, y and value on a rectangular grid of points; its path from the case file",
        ),
        optional(
            "unit",
            Kind::Text,
            "the header of the file says it, as in `cu [kPa]`",
            "unit of the values of the file",
        ),
        optional(
            "length_unit",
            Kind::Text,
            "the header of the file says it, as in `x [m]`",
            "unit of x and y of the file",
        ),
        optional(
            "x",
            Kind::List(&LENGTH, 1, MANY),
            "no points in the plane",
            "upright lines of points, ascending",
        ),
        optional(
            "y",
            Kind::List(&LENGTH, 1, MANY),
            "no points in the plane",
            "level lines of points, ascending",
        ),
        optional(
            "rows",
            Kind::List(rows, 1, MANY),
            "no points in the plane",
            "values there, a list along x for every y; bilinear between the points",
        ),
    ]
}

static STRESS_PROFILE: Struct = Struct {
    doc: "A stress that varies with the level: `at_top` and `gradient`, or `levels` and `values`; or in the plane: `raster`, or `x`, `y` and `rows`. Soil carries what it \
          has where it starts. A strength may be zero somewhere, and counts as a millionth of the greatest there.",
    fields: &profile(
        Kind::Quantity(Stress, Range::NotNegative),
        Kind::Quantity(StressGradient, Range::Any),
        &A_STRESS,
        &STRESSES,
    ),
};

static UNIT_WEIGHT_PROFILE: Struct = Struct {
    doc: "A unit weight that varies with the level, stated alike.",
    fields: &profile(
        Kind::Quantity(UnitWeight, Range::NotNegative),
        Kind::Quantity(UnitWeightGradient, Range::Any),
        &A_UNIT_WEIGHT,
        &UNIT_WEIGHTS,
    ),
};

static POSITIVE_STRESS: [Kind; 2] = [
    Kind::Quantity(Stress, Range::Positive),
    Kind::Table(&STRESS_PROFILE),
];
static COHESION: [Kind; 2] = [
    Kind::Quantity(Stress, Range::NotNegative),
    Kind::Table(&STRESS_PROFILE),
];
static WEIGHT: [Kind; 2] = [
    Kind::Quantity(UnitWeight, Range::NotNegative),
    Kind::Table(&UNIT_WEIGHT_PROFILE),
];

const CU: Field = required(
    "cu",
    Kind::Either(&POSITIVE_STRESS),
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
                    Kind::Either(&COHESION),
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
                    "largest tensile stress; zero or missing where cohesion varies",
                ),
            ],
        },
    ],
    after: &[
        required(
            "unit_weight",
            Kind::Either(&WEIGHT),
            "\"18 kN/m3\"",
            "unit weight",
        ),
        required(
            "young",
            Kind::Either(&POSITIVE_STRESS),
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
        optional(
            "saturated_unit_weight",
            Kind::Quantity(UnitWeight, Range::Positive),
            "as above the water table",
            "unit weight below a water table, water included",
        ),
        derived(
            "drainage",
            Kind::Choice(&DRAINAGES),
            "\"total\" with `cu`, \"drained\" otherwise",
            "what it does with the water in its pores",
        ),
        optional(
            "undrained_poisson",
            Kind::Number(Range::Share),
            "0.495 where `drainage` is undrained and `pore_water` is not given",
            "Poisson's ratio of undrained soil with its water, above `poisson`",
        ),
        optional(
            "pore_water",
            Kind::Quantity(Stress, Range::Positive),
            "`undrained_poisson` says it",
            "bulk modulus of the water over the porosity, K_w/n, of undrained soil",
        ),
    ],
};

static DRAINAGES: [Choice; 3] = [
    choice(
        "drained",
        "water comes and goes: strength and stiffness are those of effective stress",
    ),
    choice(
        "undrained",
        "the same, and changes of volume make excess pore pressure",
    ),
    choice(
        "total",
        "strength and stiffness are those of total stress: pore pressure does not matter",
    ),
];

static JAKY: [Choice; 1] = [choice("jaky", "1 - sin(friction)")];
