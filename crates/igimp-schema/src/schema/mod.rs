//! The schema of a case file, declared once.

mod loads;
mod materials;

pub use materials::SYMBOLS;
mod outputs;
mod reinforcement;
mod rigid;
mod solids;
mod stages;
mod water;

use super::quantity::Dimension::{Acceleration, Length, UnitWeight};
use super::spec::{
    Choice, Kind, Range, Struct, choice, default, derived, in_plane, in_space, optional, required,
};

/// Version of the input format that this program reads.
pub const FORMAT: i64 = 1;

/// Most items in a list of small things, such as corners and points.
const MANY: usize = 100_000;
/// Most things of one kind.
pub const MOST_THINGS: usize = 1000;
/// Most bodies.
const MOST_BODIES: usize = 5000;
/// Most curves.
const MOST_CURVES: usize = 200;

/// A length.
const A_LENGTH: Kind = Kind::Quantity(Length, Range::Any);
static LENGTH: Kind = A_LENGTH;
/// A point: a length along each axis.
const POINT: Kind = Kind::Vector(&LENGTH);
/// Two lengths: a corner of an outline, or the ends of a stretch.
const PAIR: Kind = Kind::List(&LENGTH, 2, 2);
static CORNER: Kind = PAIR;

/// The whole file.
pub static ROOT: Struct = Struct {
    doc: "A case: a problem in plane strain and how it is solved.",
    fields: &[
        required(
            "igimp",
            Kind::Integer(FORMAT, i64::MAX),
            "1",
            "version of the input format",
        ),
        required(
            "case",
            Kind::Table(&CASE),
            "{ title = \"My slope\" }",
            "what the case is",
        ),
        required(
            "grid",
            Kind::Table(&GRID),
            "{ cell = \"1 m\", domain = { x = [\"0 m\", \"60 m\"], y = [\"0 m\", \"22 m\"] } }",
            "background grid and variant of the method",
        ),
        required(
            "materials",
            Kind::Map("material", &materials::MATERIAL),
            "{ clay = { model = \"tresca\" } }",
            "materials by name",
        ),
        required(
            "bodies",
            Kind::List(&BODY, 1, MOST_BODIES),
            "[{ name = \"soil\" }]",
            "polygons of one material each",
        ),
        default(
            "water",
            Kind::List(&water::WATER, 0, MOST_THINGS),
            "[]",
            "conditions of the water; the first holds from the start",
        ),
        default(
            "boundaries",
            Kind::Table(&BOUNDARIES),
            "{}",
            "supports at the sides of the grid, and in boxes",
        ),
        default(
            "loads",
            Kind::List(&loads::LOAD, 0, MOST_THINGS),
            "[]",
            "loads that stages apply",
        ),
        default(
            "rigid",
            Kind::List(&rigid::RIGID, 0, MOST_THINGS),
            "[]",
            "rigid bodies that soil touches",
        ),
        default(
            "reinforcement",
            Kind::List(&reinforcement::REINFORCEMENT, 0, MOST_THINGS),
            "[]",
            "anchors, nails and geotextiles",
        ),
        required(
            "stages",
            Kind::List(&stages::STAGE, 1, MOST_THINGS),
            "[{ name = \"weight\", type = \"gravity\" }]",
            "what happens, in order",
        ),
        default(
            "solver",
            Kind::Table(&outputs::SOLVER),
            "{}",
            "Newton's method, step cutting, linear solver",
        ),
        default(
            "monitors",
            Kind::List(&outputs::MONITOR, 0, MOST_THINGS),
            "[]",
            "material points that are watched in every step",
        ),
        default(
            "sections",
            Kind::List(&outputs::SECTION, 0, MOST_THINGS),
            "[]",
            "lines along which results are written at the end of every stage",
        ),
        default(
            "curves",
            Kind::List(&outputs::CURVE, 0, MOST_CURVES),
            "[]",
            "one recorded quantity against another",
        ),
        default(
            "checks",
            Kind::List(&outputs::CHECK, 0, MOST_THINGS),
            "[]",
            "results that are held against outside values",
        ),
        default(
            "mesh_study",
            Kind::Table(&outputs::MESH_STUDY),
            "{}",
            "the case on finer meshes too, for the error of the mesh",
        ),
        default(
            "output",
            Kind::Table(&outputs::OUTPUT),
            "{}",
            "what is written, and where",
        ),
    ],
};

static CASE: Struct = Struct {
    doc: "What the case is.",
    fields: &[
        required(
            "title",
            Kind::Text,
            "\"My slope\"",
            "for reports and figures",
        ),
        optional(
            "project",
            Kind::Text,
            "not in the report",
            "project, for the head of the report",
        ),
        optional(
            "client",
            Kind::Text,
            "not in the report",
            "client, for the head of the report",
        ),
        optional(
            "author",
            Kind::Text,
            "not in the report",
            "author, for the head of the report",
        ),
        optional(
            "revision",
            Kind::Text,
            "not in the report",
            "revision, for the head of the report",
        ),
        default(
            "analysis",
            Kind::Choice(&ANALYSES),
            "\"plane-strain\"",
            "kind of analysis",
        ),
        default(
            "gravity",
            Kind::Quantity(Acceleration, Range::NotNegative),
            "\"9.81 m/s2\"",
            "acceleration of gravity, along -y",
        ),
        default(
            "water_unit_weight",
            Kind::Quantity(UnitWeight, Range::Positive),
            "\"9.81 kN/m3\"",
            "unit weight of water",
        ),
    ],
};

/// Name of the analysis in space.
pub const SPACE: &str = "3d";

static ANALYSES: [Choice; 2] = [
    choice("plane-strain", "per metre run; x points right, y up"),
    choice(SPACE, "in space; x points right, y backwards, z up"),
];

static GRID: Struct = Struct {
    doc: "Fixed background grid, and the variant of the method.",
    fields: &[
        required(
            "cell",
            Kind::Either(&[Kind::Quantity(Length, Range::Positive), Kind::Table(&CELL)]),
            "\"0.5 m\"",
            "size of a cell, one length or x and y",
        ),
        required(
            "domain",
            Kind::Table(&DOMAIN),
            "{ x = [\"0 m\", \"60 m\"], y = [\"0 m\", \"22 m\"] }",
            "extent of the grid; leave room for the motion",
        ),
        default(
            "lines",
            Kind::Table(&LINES),
            "{}",
            "places that grid lines go through",
        ),
        default(
            "fit",
            Kind::Choice(&FITS),
            "\"none\"",
            "whether grid lines go through layer boundaries",
        ),
        default(
            "zones",
            Kind::Table(&ZONES),
            "{}",
            "stretches of finer cells",
        ),
        default(
            "growth",
            Kind::Number(Range::Positive),
            "1.3",
            "ratio of neighbouring cells beside zones and thin layers; from 1.05 to 2",
        ),
        default(
            "mixed_cells",
            Kind::Choice(&MIXED_CELLS),
            "\"own\"",
            "stiffness of particles in cells that several soils share",
        ),
        default(
            "refine",
            Kind::Integer(1, 64),
            "1",
            "every cell is cut into so many in each direction",
        ),
        default(
            "basis",
            Kind::Choice(&BASES),
            "\"gimp\"",
            "how a particle sees the grid",
        ),
        default(
            "locking",
            Kind::Choice(&LOCKINGS),
            "\"shared-strain\"",
            "what is done against locking",
        ),
        default(
            "kinematics",
            Kind::Choice(&KINEMATICS),
            "\"finite\"",
            "measure of strain",
        ),
        default(
            "domain_update",
            Kind::Choice(&DOMAIN_UPDATES),
            "\"stretch\"",
            "how particle domains follow the deformation",
        ),
        default(
            "small_cuts",
            Kind::Table(&SMALL_CUTS),
            "{}",
            "nodes that a body only touches at a corner",
        ),
    ],
};

static CELL: Struct = Struct {
    doc: "Size of a cell by direction.",
    fields: &[
        required(
            "x",
            Kind::Quantity(Length, Range::Positive),
            "\"0.5 m\"",
            "width",
        ),
        required(
            "y",
            Kind::Quantity(Length, Range::Positive),
            "\"0.5 m\"",
            "height; in space depth",
        ),
        in_space(required(
            "z",
            Kind::Quantity(Length, Range::Positive),
            "\"0.5 m\"",
            "height",
        )),
    ],
};

static LINES: Struct = Struct {
    doc: "Places that grid lines go through. Between them the cells are as near to `cell` as equal division allows.",
    fields: &[
        default(
            "x",
            Kind::List(&LENGTH, 0, MOST_THINGS),
            "[]",
            "places of upright lines",
        ),
        default(
            "y",
            Kind::List(&LENGTH, 0, MOST_THINGS),
            "[]",
            "places of level lines, in space of upright ones",
        ),
        in_space(default(
            "z",
            Kind::List(&LENGTH, 0, MOST_THINGS),
            "[]",
            "places of level planes",
        )),
    ],
};

static FITS: [Choice; 2] = [
    choice("none", "lines are where cell, lines and zones put them"),
    choice(
        "layers",
        "level lines move onto the level edges of bodies: layer boundaries and surfaces",
    ),
];

static MIXED_CELLS: [Choice; 2] = [
    choice("own", "that of the particle's own soil"),
    choice(
        "mean",
        "the inverse of the mean compliance of the cell, as it is filled; strength stays the particle's own",
    ),
];

static ZONES: Struct = Struct {
    doc: "Stretches of finer cells; beside them cells grow by `growth` up to `cell`.",
    fields: &[
        default(
            "x",
            Kind::List(&ZONE, 0, MOST_THINGS),
            "[]",
            "stretches of narrower cells",
        ),
        default(
            "y",
            Kind::List(&ZONE, 0, MOST_THINGS),
            "[]",
            "stretches of lower cells, in space of cells that are less deep",
        ),
        in_space(default(
            "z",
            Kind::List(&ZONE, 0, MOST_THINGS),
            "[]",
            "stretches of lower cells",
        )),
    ],
};

static ZONE: Kind = Kind::Table(&Struct {
    doc: "A stretch of finer cells across the whole grid.",
    fields: &[
        required("from", A_LENGTH, "\"9 m\"", "where it begins"),
        required("to", A_LENGTH, "\"12 m\"", "where it ends"),
        required(
            "cell",
            Kind::Quantity(Length, Range::Positive),
            "\"0.25 m\"",
            "size of its cells, in its own direction",
        ),
    ],
});

static DOMAIN: Struct = Struct {
    doc: "Extent of the grid. Without lines, zones and fit it is a whole number of cells in each direction.",
    fields: &[
        required("x", PAIR, "[\"0 m\", \"60 m\"]", "from left to right"),
        in_plane(required(
            "y",
            PAIR,
            "[\"0 m\", \"22 m\"]",
            "from bottom to top",
        )),
        in_space(required(
            "y",
            PAIR,
            "[\"0 m\", \"30 m\"]",
            "from front to back",
        )),
        in_space(required(
            "z",
            PAIR,
            "[\"0 m\", \"22 m\"]",
            "from bottom to top",
        )),
    ],
};

static BASES: [Choice; 2] = [
    choice("gimp", "generalised interpolation (iGIMP)"),
    choice("linear", "plain material point method (iMPM)"),
];

static LOCKINGS: [Choice; 3] = [
    choice("none", "nothing"),
    choice(
        "b-bar",
        "the dilatation is that of the cells, as in the paper",
    ),
    choice(
        "shared-strain",
        "b-bar, and most of the distortion is that of the cells too where soil yields",
    ),
];

static KINEMATICS: [Choice; 2] = [
    choice("finite", "Hencky strain, exact under rotation"),
    choice("small", "small strain over a step"),
];

static DOMAIN_UPDATES: [Choice; 4] = [
    choice("fixed", "half-lengths stay as seeded"),
    choice("diagonal-f", "diagonal of the deformation gradient F"),
    choice("stretch", "diagonal of the stretch U, free of rotation"),
    choice("root-j", "square root of det F"),
];

static SMALL_CUTS: Struct = Struct {
    doc: "Treatment of nodes that carry next to no soil.",
    fields: &[
        in_plane(default(
            "below",
            Kind::Number(Range::NotNegative),
            "1e-4",
            "share of a cell's volume below which a node is a small cut; 0 switches off",
        )),
        in_space(default(
            "below",
            Kind::Number(Range::NotNegative),
            "1e-3",
            "share of a cell's volume below which a node is a small cut; 0 switches off",
        )),
        default(
            "remedy",
            Kind::Choice(&REMEDIES),
            "\"tie\"",
            "what happens to such a node",
        ),
        default(
            "ghost_penalty",
            Kind::Number(Range::NotNegative),
            "0",
            "penalty on jumps of the gradient across faces of boundary cells; 0 switches off",
        ),
    ],
};

static REMEDIES: [Choice; 2] = [
    choice("tie", "it moves with the nearest node that carries soil"),
    choice("drop", "its displacement is zero"),
];

static BODY: Kind = Kind::Table(&Struct {
    doc: "A polygon of one material, filled with particles.",
    fields: &[
        required("name", Kind::Name, "\"soil\"", "name"),
        required(
            "material",
            Kind::Reference("material"),
            "\"clay\"",
            "name of the material",
        ),
        in_plane(default(
            "points_per_cell",
            Kind::IntegerOf(&[1, 4, 9, 16, 25]),
            "4",
            "particles per cell, a square number",
        )),
        in_space(default(
            "points_per_cell",
            Kind::IntegerOf(&[1, 8, 27, 64]),
            "8",
            "particles per cell, a cube number",
        )),
        in_space(solids::BOX),
        in_space(solids::SECTION),
        in_space(solids::ACROSS),
        in_space(solids::PLAN),
        in_space(solids::BETWEEN),
        in_space(solids::CYLINDER),
        in_space(solids::SPHERE),
        in_space(solids::SURFACE),
        in_space(solids::MINUS),
        in_plane(required(
            "polygon",
            Kind::Either(&[Kind::List(&CORNER, 3, MANY), Kind::Table(&OUTLINE)]),
            "[[\"0 m\", \"0 m\"], [\"8 m\", \"0 m\"], [\"8 m\", \"5 m\"], [\"0 m\", \"5 m\"]]",
            "corners in order, either way round, or where they come from",
        )),
    ],
});

const FILE_DOC: &str =
    "a CSV file with the columns x and y, or an ASCII DXF file; its path from the case file";
const LAYER: super::spec::Field = optional(
    "layer",
    Kind::Text,
    "the file is no drawing",
    "layer of the drawing that the line is on, alone",
);
const FILE_UNIT: super::spec::Field = optional(
    "unit",
    Kind::Text,
    "the header says it, as in `x [ft]`",
    "unit of length of the file",
);

static LINE_FILE: Struct = Struct {
    doc: "A line in a file.",
    fields: &[
        required("file", Kind::Text, "\"rock.csv\"", FILE_DOC),
        LAYER,
        FILE_UNIT,
    ],
};

static LINE: [Kind; 2] = [Kind::List(&CORNER, 2, MANY), Kind::Table(&LINE_FILE)];

static OUTLINE: Struct = Struct {
    doc: "Where the corners come from: a file, or the lines above and below, which run from one side of the ground to the other.",
    fields: &[
        optional("file", Kind::Text, "`top` and `bottom` say it", FILE_DOC),
        LAYER,
        FILE_UNIT,
        optional(
            "top",
            Kind::Either(&LINE),
            "`file` says it",
            "line above the body",
        ),
        optional(
            "bottom",
            Kind::Either(&LINE),
            "`file` says it",
            "line below the body",
        ),
    ],
};

static SIDES: [Choice; 3] = [
    choice("roller", "no displacement across the side"),
    choice("fixed", "no displacement"),
    choice("free", "no support"),
];

static BOUNDARIES: Struct = Struct {
    doc: "Supports at the sides of the grid, and in boxes.",
    fields: &[
        default(
            "left",
            Kind::Choice(&SIDES),
            "\"roller\"",
            "side of the lowest x",
        ),
        default(
            "right",
            Kind::Choice(&SIDES),
            "\"roller\"",
            "side of the highest x",
        ),
        in_space(default(
            "front",
            Kind::Choice(&SIDES),
            "\"roller\"",
            "side of the lowest y",
        )),
        in_space(default(
            "back",
            Kind::Choice(&SIDES),
            "\"roller\"",
            "side of the highest y",
        )),
        default(
            "bottom",
            Kind::Choice(&SIDES),
            "\"fixed\"",
            "side of the lowest y, in space of the lowest z",
        ),
        default(
            "top",
            Kind::Choice(&SIDES),
            "\"free\"",
            "side of the highest y, in space of the highest z",
        ),
        default(
            "boxes",
            Kind::List(&BOX, 0, MOST_THINGS),
            "[]",
            "boxes in which nodes are held",
        ),
    ],
};

static AXES: [Choice; 3] = [
    choice("x", "displacement in x"),
    choice("y", "displacement in y"),
    choice("z", "displacement in z, in space"),
];
static AXIS: Kind = Kind::Choice(&AXES);

static BOX: Kind = Kind::Table(&Struct {
    doc: "A box whose nodes, edges included, are held.",
    fields: &[
        required("name", Kind::Name, "\"wall\"", "name"),
        required("from", POINT, "[\"0 m\", \"0 m\"]", "one corner"),
        required("to", POINT, "[\"1 m\", \"5 m\"]", "the opposite corner"),
        in_plane(default(
            "fix",
            Kind::List(&AXIS, 1, 2),
            "[\"x\", \"y\"]",
            "what is held",
        )),
        in_space(default(
            "fix",
            Kind::List(&AXIS, 1, 3),
            "[\"x\", \"y\", \"z\"]",
            "what is held",
        )),
    ],
});

/// A stage that a curve, a check or another stage names.
const fn stage(meaning: &'static str, doc: &'static str) -> super::spec::Field {
    optional("stage", Kind::Reference("stage"), meaning, doc)
}

/// Names of materials whose strength is reduced.
static MATERIAL_NAME: Kind = Kind::Reference("material");
const fn reduced_materials() -> super::spec::Field {
    derived(
        "materials",
        Kind::List(&MATERIAL_NAME, 1, MOST_THINGS),
        "all materials of bodies that have a strength",
        "materials whose strength is reduced; the others keep theirs",
    )
}
