//! Solver, monitors, sections, curves, checks and output.

use super::{A_LENGTH, MANY, POINT, stage};
use crate::field::CHOICES;
use crate::spec::{
    Choice, Kind, Range, Struct, choice, default, derived, in_space, optional, required,
};

pub(super) static SOLVER: Struct = Struct {
    doc: "Newton's method, step cutting, linear solver.",
    fields: &[
        default(
            "tolerance",
            Kind::Number(Range::Share),
            "1e-9",
            "out-of-balance force over external force and reactions",
        ),
        default(
            "max_iterations",
            Kind::Integer(1, 1000),
            "25",
            "most corrections per step",
        ),
        default(
            "step_cutting",
            Kind::Table(&STEP_CUTTING),
            "{}",
            "what happens to a step that does not converge",
        ),
        default(
            "linear",
            Kind::Choice(&LINEAR_SOLVERS),
            "\"auto\"",
            "linear solver",
        ),
        optional(
            "memory",
            Kind::Text,
            "that of --memory or IGIMP_MEMORY, or half of what the computer has",
            "most memory for its factors in space, as \"12 GiB\", or \"25 %\" of what the computer has",
        ),
    ],
};

static STEP_CUTTING: Struct = Struct {
    doc: "A step that does not converge is cut.",
    fields: &[
        default(
            "times",
            Kind::Integer(0, 30),
            "5",
            "how often in succession",
        ),
        default(
            "factor",
            Kind::Number(Range::Share),
            "0.5",
            "factor on its size",
        ),
    ],
};

static LINEAR_SOLVERS: [Choice; 9] = [
    choice(
        "auto",
        "Cholesky for symmetric matrices, LU for others; for large systems in space multigrid",
    ),
    choice(
        "multigrid",
        "conjugate gradients or GMRES with geometric multigrid on the grid",
    ),
    choice("direct", "the same as auto"),
    choice(
        "single",
        "factors in single precision, half the memory, and an iteration with them; in double where that does not converge",
    ),
    choice("cholesky", "multifrontal Cholesky"),
    choice("lu", "multifrontal LU"),
    choice("faer-cholesky", "an independent supernodal Cholesky"),
    choice("nalgebra-cholesky", "an independent Cholesky, slow"),
    choice("bicgstab", "stabilised bi-conjugate gradients, slow"),
];

/// Fields on particles.
static FIELD: Kind = Kind::Choice(&CHOICES);

pub(super) static MONITOR: Kind = Kind::Table(&Struct {
    doc: "The material point at a place, watched as it moves.",
    fields: &[
        required("name", Kind::Name, "\"crest\"", "name"),
        required(
            "point",
            POINT,
            "[\"15 m\", \"20 m\"]",
            "place in the undeformed bodies",
        ),
        default(
            "record",
            Kind::List(&FIELD, 1, 26),
            "[\"displacement\"]",
            "what is recorded",
        ),
    ],
});

pub(super) static SECTION: Kind = Kind::Table(&Struct {
    doc: "A line along which results are written at the end of every stage.",
    fields: &[
        required("name", Kind::Name, "\"A-A\"", "name"),
        required("from", POINT, "[\"20 m\", \"2 m\"]", "one end"),
        required("to", POINT, "[\"20 m\", \"15 m\"]", "the other end"),
        default(
            "points",
            Kind::Integer(2, 100_000),
            "100",
            "number of equally spaced places",
        ),
        default(
            "record",
            Kind::List(&FIELD, 1, 26),
            "[\"sigma_xx\", \"sigma_yy\", \"tau_xy\"]",
            "what is written",
        ),
        default(
            "average",
            Kind::Choice(&AVERAGES),
            "\"none\"",
            "of which particles values are read",
        ),
        default(
            "references",
            Kind::List(&SECTION_REFERENCE, 0, 100),
            "[]",
            "what the values are held against",
        ),
    ],
});

static AVERAGES: [Choice; 2] = [
    choice("none", "the particles around each place, interpolated"),
    choice(
        "cell",
        "all particles of each cell that the line goes through, by volume: smooths the sawtooth within cells",
    ),
];

static SECTION_REFERENCE: Kind = Kind::Table(&Struct {
    doc: "A reference for a section: `y`, `points` or `file`, over the distance along the section in m, in SI units.",
    fields: &[
        required(
            "of",
            FIELD_NAME,
            "\"sigma_yy\"",
            "the field, one of `record`",
        ),
        stage(
            "the last that is read along sections",
            "the stage at whose end it is read",
        ),
        optional(
            "y",
            NUMBER_OF_PLOT,
            "another form is given",
            "a value of the field",
        ),
        optional(
            "at",
            NUMBER_OF_PLOT,
            "the end of the section",
            "distance at which `y` is compared",
        ),
        optional(
            "points",
            Kind::List(&PAIR, 1, MANY),
            "another form is given",
            "points [distance, value]; the section is held against each that it spans",
        ),
        optional(
            "file",
            Kind::Text,
            "another form is given",
            "CSV file with a header and two columns, beside the case file",
        ),
        required(
            "label",
            Kind::Text,
            "\"weight of the soil above\"",
            "label with the source",
        ),
        optional(
            "tolerance",
            Kind::Number(Range::Positive),
            "drawn only, not checked",
            "accepted relative deviation",
        ),
    ],
});

const FIELD_NAME: Kind = Kind::Choice(&CHOICES);

static NUMBER: Kind = Kind::Number(Range::Any);
static PAIR: Kind = Kind::List(&NUMBER, 2, 2);
static DIVISOR: Kind = Kind::AnyQuantity;
static ANY_QUANTITY: Kind = Kind::AnyQuantity;
const DIVISORS: Kind = Kind::List(&DIVISOR, 0, 16);

pub(super) static CURVE: Kind = Kind::Table(&Struct {
    doc: "One recorded quantity against another, a point per step.",
    fields: &[
        required(
            "name",
            Kind::Name,
            "\"load-settlement\"",
            "name, also of its file",
        ),
        required(
            "x",
            Kind::Table(&AXIS),
            "{ of = \"footing.settlement\" }",
            "abscissa",
        ),
        required(
            "y",
            Kind::Table(&AXIS),
            "{ of = \"footing.reaction\" }",
            "ordinate",
        ),
        stage("all stages", "the stage that is recorded"),
        optional(
            "reference",
            Kind::Table(&REFERENCE),
            "no reference",
            "what the curve is held against",
        ),
    ],
});

static AXIS: Struct = Struct {
    doc: "A quantity as plotted.",
    fields: &[
        required(
            "of",
            Kind::Reference("quantity"),
            "\"footing.reaction\"",
            "the quantity",
        ),
        default(
            "divide_by",
            DIVISORS,
            "[]",
            "it is divided by each of these, in SI units",
        ),
        derived(
            "label",
            Kind::Text,
            "the quantity and its SI unit",
            "label with unit",
        ),
    ],
};

static REFERENCE: Struct = Struct {
    doc: "A reference for a curve: `y`, `points` or `file`, in the units of the plot.",
    fields: &[
        optional(
            "y",
            NUMBER_OF_PLOT,
            "another form is given",
            "a value of the ordinate",
        ),
        optional(
            "at",
            NUMBER_OF_PLOT,
            "the end of the curve",
            "abscissa at which `y` is compared",
        ),
        optional(
            "points",
            Kind::List(&PAIR, 1, MANY),
            "another form is given",
            "points [x, y]; the curve is held against each that it spans",
        ),
        optional(
            "file",
            Kind::Text,
            "another form is given",
            "CSV file with a header and two columns, beside the case file",
        ),
        required(
            "label",
            Kind::Text,
            "\"Prandtl, 2 + pi\"",
            "label with the source",
        ),
        optional(
            "tolerance",
            Kind::Number(Range::Positive),
            "drawn only, not checked",
            "accepted relative deviation",
        ),
    ],
};

const NUMBER_OF_PLOT: Kind = Kind::Number(Range::Any);

pub(super) static CHECK: Kind = Kind::Table(&Struct {
    doc: "A result held against an outside value.",
    fields: &[
        required("name", Kind::Name, "\"factor of safety\"", "name"),
        required(
            "of",
            Kind::Reference("quantity"),
            "\"factor_of_safety\"",
            "the quantity, of a stage",
        ),
        default(
            "divide_by",
            DIVISORS,
            "[]",
            "it is divided by each of these, in SI units",
        ),
        stage(
            "the last; for a factor of safety the last strength reduction",
            "the stage",
        ),
        default("at", Kind::Choice(&MOMENTS), "\"end\"", "when in the stage"),
        optional(
            "expected",
            Kind::AnyQuantity,
            "the middle of `between`, or the limit",
            "the outside value, after division",
        ),
        default(
            "value",
            Kind::Choice(&VALUES),
            "\"computed\"",
            "which value is held against it",
        ),
        optional(
            "tolerance",
            Kind::Number(Range::Positive),
            "another band is given",
            "accepted relative deviation from `expected`",
        ),
        optional(
            "between",
            Kind::List(&ANY_QUANTITY, 2, 2),
            "another band is given",
            "accepted values, from and to",
        ),
        optional(
            "at_most",
            Kind::AnyQuantity,
            "another band is given",
            "largest accepted value",
        ),
        optional(
            "at_least",
            Kind::AnyQuantity,
            "another band is given",
            "smallest accepted value",
        ),
        required(
            "source",
            Kind::Text,
            "\"Griffiths and Lane (1999)\"",
            "where it comes from",
        ),
    ],
});

static MOMENTS: [Choice; 2] = [
    choice("end", "at its end"),
    choice("peak", "when the quantity was largest"),
];

static VALUES: [Choice; 2] = [
    choice(
        "computed",
        "that of the mesh, of the finest in a mesh study",
    ),
    choice(
        "extrapolated",
        "the one that a mesh study extrapolates to cells of no size",
    ),
];

pub(super) static MESH_STUDY: Struct = Struct {
    doc: "The case on its grid and on finer ones: the error of the mesh.",
    fields: &[default(
        "meshes",
        Kind::Integer(1, 3),
        "1",
        "number of meshes; 1: no study, 2: cells of h and h/2, 3: h/4 too",
    )],
};

pub(super) static OUTPUT: Struct = Struct {
    doc: "What is written, and where.",
    fields: &[
        derived(
            "folder",
            Kind::Text,
            "results/ and the name of the case file",
            "results folder",
        ),
        default(
            "paraview",
            Kind::Table(&PARAVIEW),
            "{}",
            "particles and grid for ParaView",
        ),
        default(
            "figures",
            Kind::List(&FIELD, 0, 26),
            "[\"displacement\", \"plastic_strain\", \"sigma_yy\"]",
            "fields drawn at the end of every stage; with none no picture is drawn at all",
        ),
        in_space(default(
            "cuts",
            Kind::List(&CUT, 0, 20),
            "[]",
            "planes in which the fields are drawn as well; without any, upright ones through the middle of the bodies",
        )),
        default(
            "report",
            Kind::Flag,
            "true",
            "whether report.html is written",
        ),
        default(
            "checkpoint",
            Kind::Table(&CHECKPOINT),
            "{}",
            "states from which a run can be resumed",
        ),
    ],
};

static CUT: Kind = Kind::Table(&Struct {
    doc: "A plane across an axis.",
    fields: &[
        required("across", Kind::Choice(&ACROSS), "\"y\"", "the axis"),
        required("at", A_LENGTH, "\"5 m\"", "where it stands on the axis"),
    ],
});

static ACROSS: [Choice; 3] = [
    choice("x", "upright, along y"),
    choice("y", "upright, along x"),
    choice("z", "level"),
];

static PARAVIEW: Struct = Struct {
    doc: "When particles are written for ParaView.",
    fields: &[default(
        "every",
        Kind::Either(&[Kind::Choice(&TIMES), Kind::Integer(1, 1_000_000)]),
        "\"stage\"",
        "\"stage\", \"never\" or a number of steps",
    )],
};

static TIMES: [Choice; 2] = [
    choice("stage", "at the end of every stage"),
    choice("never", "not at all"),
];

static CHECKPOINT: Struct = Struct {
    doc: "States from which a run can be resumed.",
    fields: &[
        default(
            "every",
            Kind::Integer(0, 1_000_000),
            "10",
            "steps between checkpoints; 0: at the end of stages only",
        ),
        default(
            "keep",
            Kind::Integer(1, 1000),
            "2",
            "checkpoints kept within a stage",
        ),
    ],
};
