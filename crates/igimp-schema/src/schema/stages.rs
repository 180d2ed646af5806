//! Stages.

use super::{MOST_THINGS, reduced_materials, water};
use crate::quantity::Dimension::{Length, Time};
use crate::spec::{
    Choice, Field, Kind, Range, Struct, Variant, Variants, choice, default, derived, in_space,
    optional, required,
};

/// Most load steps of a stage.
const MOST_STEPS: i64 = 1_000_000;

const MONITOR: Field = optional(
    "monitor",
    Kind::Reference("monitor"),
    "the largest displacement of all particles",
    "monitor whose displacement counts",
);

/// A stage, by type.
pub(super) static STAGE: Kind = Kind::Variants(&Variants {
    doc: "One thing that happens.",
    tag: "type",
    tag_doc: "kind of stage",
    before: &[required("name", Kind::Name, "\"weight\"", "name")],
    cases: &[
        Variant {
            name: "gravity",
            doc: "Raises gravity from where it is to a multiple of its value; changes pseudo-static acceleration.",
            fields: &[
                default(
                    "factor",
                    Kind::Number(Range::NotNegative),
                    "1",
                    "the multiple",
                ),
                optional(
                    "horizontal",
                    Kind::Number(Range::Any),
                    "it stays as it is, 0 at first",
                    "pseudo-static force to the right, as a share of the weight",
                ),
                in_space(optional(
                    "across",
                    Kind::Number(Range::Any),
                    "it stays as it is, 0 at first",
                    "pseudo-static force backwards, along y, as a share of the weight",
                )),
                optional(
                    "vertical",
                    Kind::Number(Range::Any),
                    "it stays as it is, 0 at first",
                    "pseudo-static force upwards, as a share of the weight",
                ),
                derived(
                    "geometry",
                    Kind::Choice(&GEOMETRIES),
                    "\"given\" where a search on the given geometry goes back to this stage, else \"moving\"",
                    GEOMETRY,
                ),
            ],
        },
        Variant {
            name: "k0",
            doc: "Stresses of level ground: the weight above, and K0 times that sideways.",
            fields: &[],
        },
        Variant {
            name: "load",
            doc: "Changes the factor of loads from where it is.",
            fields: &[
                optional(
                    "load",
                    Kind::Reference("load"),
                    "`loads` names them",
                    "the load, if it is one",
                ),
                optional(
                    "loads",
                    Kind::List(&LOAD_NAME, 1, MOST_THINGS),
                    "`load` names it",
                    "the loads, if they are several",
                ),
                default(
                    "factor",
                    Kind::Number(Range::Any),
                    "1",
                    "their factor at the end of the stage",
                ),
                geometry("\"moving\""),
            ],
        },
        Variant {
            name: "displacement",
            doc: "Pushes a rigid footing down.",
            fields: &[
                required(
                    "load",
                    Kind::Reference("load"),
                    "\"footing\"",
                    "the footing",
                ),
                required(
                    "settlement",
                    Kind::Quantity(Length, Range::Positive),
                    "\"0.2 m\"",
                    "further settlement",
                ),
                geometry("\"moving\""),
            ],
        },
        Variant {
            name: "rigid",
            doc: "Moves and loads rigid bodies; one that was not there yet is placed first.",
            fields: &[
                required(
                    "bodies",
                    Kind::List(&super::rigid::MOVE, 1, MOST_THINGS),
                    "[{ body = \"footing\", y = \"-0.2 m\" }]",
                    "the bodies, and how they move",
                ),
                geometry("\"moving\""),
            ],
        },
        Variant {
            name: "construction",
            doc: "Places and removes bodies, changes materials and the water. What that leaves out of balance is let go over its steps.",
            fields: &CONSTRUCTION,
        },
        Variant {
            name: "strength-reduction",
            doc: "Searches for the factor of safety; the body is left as it was found.",
            fields: &[
                reduced_materials(),
                default(
                    "factors",
                    Kind::List(&FACTOR, 0, 1000),
                    "[]",
                    "factors tried first, for the curve of displacement against factor",
                ),
                default(
                    "bracket",
                    Kind::List(&FACTOR, 2, 2),
                    "[1.0, 2.0]",
                    "where trials begin: a factor thought stable and one thought unstable",
                ),
                default(
                    "tolerance",
                    Kind::Number(Range::Positive),
                    "0.01",
                    "width of the interval at which trials end",
                ),
                default(
                    "path",
                    Kind::Choice(&PATHS),
                    "\"reduce\"",
                    "how the reduced strength is reached",
                ),
                derived(
                    "search",
                    Kind::Choice(&SEARCHES),
                    "\"continuation\" on the given geometry without `factors`, else \"trials\"",
                    "how the factor is looked for",
                ),
                geometry("\"given\""),
                default(
                    "failure",
                    Kind::Table(&FAILURE),
                    "{}",
                    "what counts as failure",
                ),
            ],
        },
        Variant {
            name: "run-out",
            doc: "Lets the slope of reduced strength move until it rests.",
            fields: &[
                required(
                    "reduction",
                    Kind::Table(&REDUCTION),
                    "{ times_fos = 1.05 }",
                    "by how much strength is reduced",
                ),
                reduced_materials(),
                default(
                    "move_per_step",
                    Kind::Number(Range::Positive),
                    "0.1",
                    "largest displacement aimed at in a step, as a share of the cell",
                ),
                default(
                    "at_rest",
                    Kind::Number(Range::Share),
                    "1e-3",
                    "the slope rests when drag carries less than this share of the external force",
                ),
            ],
        },
        Variant {
            name: "dynamic",
            doc: "Motion in time, with inertia.",
            fields: &[
                required(
                    "duration",
                    Kind::Quantity(Time, Range::Positive),
                    "\"5 s\"",
                    "how long it lasts",
                ),
                default(
                    "scheme",
                    Kind::Choice(&SCHEMES),
                    "\"backward-euler\"",
                    "how motion is integrated in time",
                ),
                default(
                    "mass",
                    Kind::Choice(&MASSES),
                    "\"consistent\"",
                    "how mass is given to the nodes",
                ),
                default(
                    "tied_below",
                    Kind::Number(Range::NotNegative),
                    "0.2",
                    "share of a cell's volume below which a node is tied while the soil moves; less serves bodies that turn",
                ),
                optional(
                    "longest_step",
                    Kind::Quantity(Time, Range::Positive),
                    "the error of the scheme and the way of the soil alone choose",
                    "longest step of time",
                ),
                optional(
                    "reduction",
                    Kind::Table(&REDUCTION),
                    "strength stays",
                    "by how much strength is reduced as it begins",
                ),
                reduced_materials(),
                default(
                    "bodies",
                    Kind::List(&super::rigid::MOVE, 0, MOST_THINGS),
                    "[]",
                    "rigid bodies that it moves, loads or lets free",
                ),
                optional(
                    "at_rest",
                    Kind::Number(Range::Share),
                    "it lasts its whole duration",
                    "it ends when kinetic energy has fallen to this share of its largest value",
                ),
                geometry("\"moving\""),
            ],
        },
    ],
    after: &[
        default(
            "steps",
            Kind::Integer(1, MOST_STEPS),
            "10",
            "load steps when none is cut; in a strength reduction those by which gravity is raised, or by which trials march from F = 1 to the upper end of the bracket",
        ),
        derived(
            "start_from",
            Kind::Reference("stage"),
            "the stage before",
            "stage whose end this one starts from",
        ),
        default(
            "install",
            Kind::List(&MEMBER_NAME, 0, MOST_THINGS),
            "[]",
            "reinforcement that comes in as the stage begins; what no stage installs is there from the start",
        ),
        default(
            "reset_displacements",
            Kind::Flag,
            "false",
            "whether displacements count from the end of this stage on",
        ),
        default(
            "drained",
            Kind::Flag,
            "false",
            "whether all soil drains while it lasts: no excess pore pressure comes or goes",
        ),
        default(
            "stop_when",
            Kind::Table(&STOP_WHEN),
            "{}",
            "conditions that end the stage early",
        ),
    ],
});

static CONSTRUCTION: [Field; 6] = {
    let [place, remove, materials, water, dissipate] = water::CONSTRUCTION;
    [
        place,
        remove,
        materials,
        water,
        dissipate,
        geometry("\"moving\""),
    ]
};

static LOAD_NAME: Kind = Kind::Reference("load");
static FACTOR: Kind = Kind::Number(Range::Positive);

const GEOMETRY: &str = "the geometry that its steps are computed on";

/// The geometry that a stage is computed on.
const fn geometry(value: &'static str) -> Field {
    default("geometry", Kind::Choice(&GEOMETRIES), value, GEOMETRY)
}

static GEOMETRIES: [Choice; 2] = [
    choice(
        "given",
        "positions and supports stay as the stage finds them; strain adds up as small strain",
    ),
    choice(
        "moving",
        "every step begins where the last one carried the particles",
    ),
];

static SCHEMES: [Choice; 2] = [
    choice(
        "backward-euler",
        "first order; what steps do not resolve is damped out",
    ),
    choice("newmark", "second order, without damping (β = ¼, γ = ½)"),
];

static MASSES: [Choice; 2] = [
    choice(
        "consistent",
        "by products of the basis: exact in momentum and energy",
    ),
    choice("lumped", "to each node its share: smooths velocities"),
];

/// Names of reinforcement.
static MEMBER_NAME: Kind = Kind::Reference("reinforcement");

static PATHS: [Choice; 2] = [
    choice(
        "reduce",
        "the strength of the loaded body is reduced step by step",
    ),
    choice(
        "gravity",
        "gravity is raised on undeformed bodies of reduced strength",
    ),
];

static SEARCHES: [Choice; 2] = [
    choice(
        "continuation",
        "along the path of equilibria, the factor an unknown, until the body moves as a mechanism and the factor rises no longer",
    ),
    choice(
        "trials",
        "by trials at one factor after another, each of which finds equilibrium or not",
    ),
];

static CRITERIA: [Choice; 1] = [choice("no-equilibrium", "no equilibrium is found")];

static FAILURE: Struct = Struct {
    doc: "What counts as failure in a strength reduction.",
    fields: &[
        default(
            "when",
            Kind::Choice(&CRITERIA),
            "\"no-equilibrium\"",
            "criterion that always counts",
        ),
        optional(
            "also",
            Kind::Table(&ALSO),
            "nothing else counts",
            "a displacement that counts too",
        ),
    ],
};

static ALSO: Struct = Struct {
    doc: "A displacement at which the slope counts as failed.",
    fields: &[
        MONITOR,
        required(
            "displacement",
            Kind::Quantity(Length, Range::Positive),
            "\"0.5 m\"",
            "the displacement",
        ),
    ],
};

static REDUCTION: Struct = Struct {
    doc: "By how much strength is reduced: one of the two.",
    fields: &[
        optional(
            "times_fos",
            Kind::Number(Range::Positive),
            "`factor` is given",
            "a multiple of the factor of safety found before",
        ),
        optional(
            "factor",
            Kind::Number(Range::Positive),
            "`times_fos` is given",
            "a factor",
        ),
    ],
};

static STOP_WHEN: Struct = Struct {
    doc: "Conditions that end a stage early, and count as a planned end.",
    fields: &[
        optional(
            "displacement",
            Kind::Quantity(Length, Range::Positive),
            "no limit",
            "a displacement is reached",
        ),
        MONITOR,
        optional(
            "load_grows_less_than",
            Kind::Number(Range::Positive),
            "no limit",
            "the footing's reaction grows by less than this share in a step",
        ),
        default(
            "no_equilibrium",
            Kind::Flag,
            "false",
            "want of equilibrium is the planned end: what was reached is the collapse load",
        ),
    ],
};
