//! Materials.

use super::{A_LENGTH, LENGTH, MANY};
use crate::quantity::Dimension::{
    self, Angle, Stress, StressGradient, UnitWeight, UnitWeightGradient,
};
use crate::spec::{
    Choice, Field, Kind, Range, Struct, Variant, Variants, choice, default, derived, optional,
    required,
};

/// What books call a field, and its keys here: of these the one that the material has is meant.
pub static SYMBOLS: [(&str, &[&str]); 22] = [
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

static FLOWS: [Choice; 2] = [
    choice(
        "dilation",
        "by the angle of dilation: not associated below the friction angle",
    ),
    choice(
        "davis",
        "associated, on the strengths of Davis (1968): a symmetric tangent, and a smaller factor of safety",
    ),
];

static A_STRESS: Kind = Kind::Quantity(Stress, Range::NotNegative);
static A_UNIT_WEIGHT: Kind = Kind::Quantity(UnitWeight, Range::NotNegative);
static STRESSES: Kind = Kind::List(&A_STRESS, 1, MANY);
static UNIT_WEIGHTS: Kind = Kind::List(&A_UNIT_WEIGHT, 1, MANY);

/// The keys of a property that varies with the level, with the depth or in the plane.
const fn profile(
    of: Dimension,
    gradient: Dimension,
    values: &'static Kind,
    lists: &'static Kind,
) -> [Field; 13] {
    let [levels, depths, values] = rows(values);
    let [raster, unit, length_unit, x, y, lists] = in_plane(lists);
    [
        optional(
            "at_surface",
            Kind::Quantity(of, Range::NotNegative),
            "another form is given",
            "value at the surface, the highest soil of the case on the same vertical line",
        ),
        optional(
            "at_top",
            Kind::Quantity(of, Range::NotNegative),
            "another form is given",
            "value at the level `from` and above",
        ),
        optional(
            "gradient",
            Kind::Quantity(gradient, Range::Any),
            "another form is given",
            "growth with depth below the surface, or below `from`",
        ),
        optional(
            "from",
            A_LENGTH,
            "the highest soil of the material",
            "level y where the growth begins, with `at_top`",
        ),
        levels,
        depths,
        values,
        raster,
        unit,
        length_unit,
        x,
        y,
        lists,
    ]
}

/// The keys of values by points in the plane.
pub(super) const fn in_plane(lists: &'static Kind) -> [Field; 6] {
    [
        optional(
            "raster",
            Kind::Text,
            "it does not come from a file",
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
            Kind::List(lists, 1, MANY),
            "no points in the plane",
            "values there, a list along x for every y; bilinear between the points",
        ),
    ]
}

/// The keys of a table of values over levels or depths.
const fn rows(values: &'static Kind) -> [Field; 3] {
    [
        optional(
            "levels",
            Kind::List(&LENGTH, 2, MANY),
            "another form is given",
            "levels y, all upwards or all downwards",
        ),
        optional(
            "depths",
            Kind::List(&LENGTH, 2, MANY),
            "another form is given",
            "depths below the surface, straight down",
        ),
        optional(
            "values",
            Kind::List(values, 2, MANY),
            "another form is given",
            "values at the levels or depths; linear between them, constant beyond",
        ),
    ]
}

static STRESS_PROFILE: Struct = Struct {
    doc: "A stress that varies with the level y or with the depth below the surface: `at_top` and `gradient`, \
          `at_surface` and `gradient`, or `values` at `levels` or `depths`; or in the plane: `raster`, or `x`, `y` and `rows`. Soil carries what it has where it starts. A \
          strength may be zero somewhere, and counts as a millionth of the greatest there.",
    fields: &STRESS_FORMS,
};

const STRESS_FORMS: [Field; 13] = profile(Stress, StressGradient, &A_STRESS, &STRESSES);

static STRENGTH_PROFILE: Struct = Struct {
    doc: "An undrained strength that varies: stated like any stress that varies, or as a share of the vertical \
          effective stress of level ground, `ratio` * stress * `ocr`^`exponent`, from the weight of the soil straight above.",
    fields: &{
        let [
            at_surface,
            at_top,
            gradient,
            from,
            levels,
            depths,
            values,
            raster,
            unit,
            lengths,
            x,
            y,
            lists,
        ] = STRESS_FORMS;
        [
            at_surface,
            at_top,
            gradient,
            from,
            levels,
            depths,
            values,
            raster,
            unit,
            lengths,
            x,
            y,
            lists,
            optional(
                "ratio",
                Kind::Number(Range::Positive),
                "another form is given",
                "strength of normally consolidated soil over the vertical effective stress",
            ),
            optional(
                "ocr",
                Kind::Either(&OCR),
                "1",
                "ratio of overconsolidation, with `ratio`",
            ),
            optional(
                "exponent",
                Kind::Number(Range::NotNegative),
                "0.8",
                "exponent of `ocr`, with `ratio`",
            ),
            optional(
                "at_least",
                Kind::Quantity(Stress, Range::NotNegative),
                "\"0 kPa\"",
                "no less strength than this, with `ratio`",
            ),
            optional(
                "water_level",
                A_LENGTH,
                "the first condition of the water, or none",
                "level y of water at rest when the ground consolidated, with `ratio`; 9.81 kN/m3",
            ),
        ]
    },
};

static OCR: [Kind; 2] = [
    Kind::Number(Range::Positive),
    Kind::Table(&Struct {
        doc: "A ratio of overconsolidation that varies with the level or with the depth.",
        fields: &rows(&Kind::Number(Range::Positive)),
    }),
];

static FRICTION: [Kind; 2] = [
    Kind::Quantity(Angle, Range::NotNegative),
    Kind::Table(&Struct {
        doc: "An angle of friction that varies with the level or with the depth; its tangent is linear in between.",
        fields: &rows(&Kind::Quantity(Angle, Range::NotNegative)),
    }),
];

static UNIT_WEIGHT_PROFILE: Struct = Struct {
    doc: "A unit weight that varies with the level or with the depth, stated alike.",
    fields: &profile(
        UnitWeight,
        UnitWeightGradient,
        &A_UNIT_WEIGHT,
        &UNIT_WEIGHTS,
    ),
};

static UNDRAINED_STRENGTH: [Kind; 2] = [
    Kind::Quantity(Stress, Range::Positive),
    Kind::Table(&STRENGTH_PROFILE),
];
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
    Kind::Either(&UNDRAINED_STRENGTH),
    "\"50 kPa\"",
    "undrained shear strength in plane strain",
);

/// A material, by model.
pub(super) static MATERIAL: Variants = Variants {
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
                    Kind::Either(&FRICTION),
                    "\"20 deg\"",
                    "friction angle, below 90 deg",
                ),
                default(
                    "dilation",
                    Kind::Quantity(Angle, Range::NotNegative),
                    "\"0 deg\"",
                    "dilation angle, nowhere above the friction angle",
                ),
                default(
                    "flow",
                    Kind::Choice(&FLOWS),
                    "\"dilation\"",
                    "how plastic flow follows from the angle of dilation",
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
