//! The schema of a case file, declared once.

pub mod bodies;
pub mod consolidation;
mod declare;
pub mod grid;
pub mod ground_motion;
pub mod loads;
pub mod materials;
pub mod outline;
pub mod outputs;
pub mod reinforcement;
pub mod rigid;
pub mod solids;
pub mod stages;
pub mod water;

use crate::spec::Bodies;
pub use crate::spec::Measured;
use crate::tree::Node;
use bodies::{BODY, Body};
use declare::{choices, table};
use grid::{BOUNDARIES, Boundaries, GRID, Grid};
use loads::{LOAD, Load};
pub use materials::SYMBOLS;
use materials::{MATERIAL, Material};
use outputs::{
    CHECK, CURVE, Check, Curve, MESH_STUDY, MONITOR, MeshStudy, Monitor, OUTPUT, Output, SECTION,
    SOLVER, Section, Solver,
};
use reinforcement::{Member, REINFORCEMENT};
use rigid::{RIGID, RigidBody};
use stages::{STAGE, Stage};
use water::{WATER, Water};

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

table! {
    ROOT: Root<D>, "A case: a problem in plane strain and how it is solved.";
    igimp: whole(FORMAT, i64::MAX), required "1", "version of the input format";
    case: table(CASE: CaseHead), required "{ title = \"My slope\" }", "what the case is";
    grid: table(GRID: Grid),
        required "{ cell = \"1 m\", domain = { x = [\"0 m\", \"60 m\"], y = [\"0 m\", \"22 m\"] } }",
        "background grid and variant of the method";
    materials: map("material", MATERIAL: Material), required "{ clay = { model = \"tresca\" } }",
        "materials by name";
    bodies: each(table(BODY: Body), 1, MOST_BODIES), required "[{ name = \"soil\" }]",
        "polygons of one material each";
    water: each(table(WATER: Water), 0, MOST_THINGS), default "[]",
        "conditions of the water; the first holds from the start";
    boundaries: table(BOUNDARIES: Boundaries<D>), default "{}", "supports at the sides of the grid, and in boxes";
    loads: each(variants(LOAD: Load<D>), 0, MOST_THINGS), default "[]", "loads that stages apply";
    rigid: each(variants(RIGID: RigidBody<D>), 0, MOST_THINGS), default "[]", "rigid bodies that soil touches";
    reinforcement: each(variants(REINFORCEMENT: Member<D>), 0, MOST_THINGS), default "[]",
        "anchors, nails and geotextiles";
    stages: each(variants(STAGE: Stage), 1, MOST_THINGS), required "[{ name = \"weight\", type = \"gravity\" }]",
        "what happens, in order";
    solver: table(SOLVER: Solver), default "{}", "Newton's method, step cutting, linear solver";
    monitors: each(table(MONITOR: Monitor<D>), 0, MOST_THINGS), default "[]",
        "material points that are watched in every step";
    sections: each(table(SECTION: Section<D>), 0, MOST_THINGS), default "[]",
        "lines along which results are written at the end of every stage";
    curves: each(table(CURVE: Curve), 0, MOST_CURVES), default "[]", "one recorded quantity against another";
    checks: each(table(CHECK: Check), 0, MOST_THINGS), default "[]", "results that are held against outside values";
    mesh_study: table(MESH_STUDY: MeshStudy), default "{}",
        "the case on finer meshes too, for the error of the mesh";
    output: table(OUTPUT: Output), default "{}", "what is written, and where";
}

table! {
    MATERIALS_ALONE: MaterialsAlone, "Materials without a case, for tests of their laws.";
    igimp: whole(FORMAT, i64::MAX), required "1", "version of the input format";
    materials: map("material", MATERIAL: Material), required "{ clay = { model = \"tresca\" } }",
        "materials by name";
}

table! {
    CASE: CaseHead, "What the case is.";
    title: text, required "\"My slope\"", "for reports and figures";
    project: text, optional "not in the report", "project, for the head of the report";
    client: text, optional "not in the report", "client, for the head of the report";
    author: text, optional "not in the report", "author, for the head of the report";
    revision: text, optional "not in the report", "revision, for the head of the report";
    analysis: choice(Analysis), default "\"plane-strain\"", "kind of analysis";
    gravity: quantity(Acceleration, NotNegative), default "\"9.81 m/s2\"", "acceleration of gravity, along -y";
    water_unit_weight: quantity(UnitWeight, Positive), default "\"9.81 kN/m3\"", "unit weight of water";
}

/// Name of the analysis in space.
pub const SPACE: &str = Analysis::Space.name();

/// The bodies of the analysis of a case file.
pub(crate) fn bodies_of(file: &Node) -> Bodies {
    let case = file.get("case");
    match case.and_then(|case| case.text_at("analysis")) {
        Some(SPACE) => Bodies::Space,
        Some(AXISYMMETRIC) => Bodies::Revolution,
        _ => Bodies::Plane,
    }
}

/// Whether the bodies of a case file are whole ones, in space or of revolution: forces are not per metre run.
pub fn is_whole(file: &Node) -> bool {
    !matches!(bodies_of(file), Bodies::Plane)
}

/// Name of the analysis of a body of revolution.
const AXISYMMETRIC: &str = Analysis::Axisymmetric.name();

choices! {
    /// Kinds of analysis.
    Analysis;
    PlaneStrain "plane-strain", "per metre run; x points right, y up";
    Axisymmetric "axisymmetric", "a body of revolution about x = 0; x is the radius, y points up, forces are those of the whole circle";
    Space "3d", "in space; x points right, y backwards, z up";
}
