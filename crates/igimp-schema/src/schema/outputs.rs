//! Solver, monitors, sections, curves, checks and output.

use super::MANY;
use super::declare::{choices, table};
use crate::field::Field;

table! {
    SOLVER: Solver, "Newton's method, step cutting, linear solver.";
    tolerance: number(SmallShare), default "1e-9", "out-of-balance force over external force and reactions";
    max_iterations: whole(1, 1000), default "25", "most corrections per step";
    step_cutting: table(STEP_CUTTING: StepCutting), default "{}", "what happens to a step that does not converge";
    linear: choice(LinearSolver), default "\"auto\"", "linear solver";
    memory: text, optional "that of --memory or IGIMP_MEMORY, or half of what the computer has",
        "most memory for its factors in space, as \"12 GiB\", or \"25 %\" of what the computer has";
}

table! {
    STEP_CUTTING: StepCutting, "A step that does not converge is cut.";
    times: whole(0, 30), default "5", "how often in succession";
    factor: number(Share), default "0.5", "factor on its size";
}

choices! {
    /// Linear solvers.
    LinearSolver;
    Auto "auto", "Cholesky for symmetric matrices, LU for others; for large systems in space multigrid";
    Multigrid "multigrid", "conjugate gradients or GMRES with geometric multigrid on the grid";
    Single "single",
        "factors in single precision, half the memory, and an iteration with them; in double where that does not converge";
}

table! {
    MONITOR: Monitor<D>, "The material point at a place, watched as it moves.";
    name: name, required "\"crest\"", "name";
    point: point, required "[\"15 m\", \"20 m\"]", "place in the undeformed bodies";
    record: list(choice(Field), 1, 40), default "[\"displacement\"]", "what is recorded";
}

table! {
    SECTION: Section<D>, "A line along which results are written at the end of every stage.";
    name: name, required "\"A-A\"", "name";
    from: point, required "[\"20 m\", \"2 m\"]", "one end";
    to: point, required "[\"20 m\", \"15 m\"]", "the other end";
    points: whole(2, 100_000), default "100", "number of equally spaced places";
    record: list(choice(Field), 1, 40), default "[\"sigma_xx\", \"sigma_yy\", \"tau_xy\"]", "what is written";
    average: choice(Average), default "\"none\"", "of which particles values are read";
    references: each(table(SECTION_REFERENCE: SectionReference), 0, 100), default "[]",
        "what the values are held against";
}

choices! {
    /// Of which particles values along a section are read.
    Average;
    None "none", "the particles around each place, interpolated";
    Cell "cell",
        "all particles of each cell that the line goes through, by volume: smooths the sawtooth within cells";
}

table! {
    SECTION_REFERENCE: SectionReference,
    "A reference for a section: `y`, `points` or `file`, over the distance along the section in m, in SI units.";
    of: choice(Field), required "\"sigma_yy\"", "the field, one of `record`";
    stage: reference("stage"), optional "the last that is read along sections", "the stage at whose end it is read";
    y: number(Any), optional "another form is given", "a value of the field";
    at: number(Any), optional "the end of the section", "distance at which `y` is compared";
    points: list(pair(number(Any)), 1, MANY), optional "another form is given",
        "points [distance, value]; the section is held against each that it spans";
    file: text, optional "another form is given", "CSV file with a header and two columns, beside the case file";
    label: text, required "\"weight of the soil above\"", "label with the source";
    tolerance: number(Positive), optional "drawn only, not checked", "accepted relative deviation";
}

table! {
    CURVE: Curve, "One recorded quantity against another, a point per step.";
    name: name, required "\"load-settlement\"", "name, also of its file";
    x: apart(table(AXIS: CurveAxis)), required "{ of = \"footing.settlement\" }", "abscissa";
    y: apart(table(AXIS: CurveAxis)), required "{ of = \"footing.reaction\" }", "ordinate";
    stage: reference("stage"), optional "all stages", "the stage that is recorded";
    reference: apart(table(REFERENCE: Reference)), optional "no reference", "what the curve is held against";
}

table! {
    AXIS: CurveAxis, "A quantity as plotted.";
    of: reference("quantity"), required "\"footing.reaction\"", "the quantity";
    divide_by: list(any_quantity, 0, 16), default "[]", "it is divided by each of these, in SI units";
    label: text, derived "the quantity and its SI unit", "label with unit";
}

table! {
    REFERENCE: Reference, "A reference for a curve: `y`, `points` or `file`, in the units of the plot.";
    y: number(Any), optional "another form is given", "a value of the ordinate";
    at: number(Any), optional "the end of the curve", "abscissa at which `y` is compared";
    points: list(pair(number(Any)), 1, MANY), optional "another form is given",
        "points [x, y]; the curve is held against each that it spans";
    file: text, optional "another form is given", "CSV file with a header and two columns, beside the case file";
    label: text, required "\"Prandtl, 2 + pi\"", "label with the source";
    tolerance: number(Positive), optional "drawn only, not checked", "accepted relative deviation";
}

table! {
    CHECK: Check, "A result held against an outside value.";
    name: name, required "\"factor of safety\"", "name";
    of: reference("quantity"), required "\"factor_of_safety\"", "the quantity, of a stage";
    divide_by: list(any_quantity, 0, 16), default "[]", "it is divided by each of these, in SI units";
    stage: reference("stage"), optional "the last; for a factor of safety the last strength reduction", "the stage";
    at: choice(Moment), default "\"end\"", "when in the stage";
    expected: any_quantity, optional "the middle of `between`, or the limit", "the outside value, after division";
    value: choice(CheckedValue), default "\"computed\"", "which value is held against it";
    tolerance: number(Positive), optional "another band is given", "accepted relative deviation from `expected`";
    between: pair(any_quantity), optional "another band is given", "accepted values, from and to";
    at_most: any_quantity, optional "another band is given", "largest accepted value";
    at_least: any_quantity, optional "another band is given", "smallest accepted value";
    source: text, required "\"Griffiths and Lane (1999)\"", "where it comes from";
}

choices! {
    /// When in a stage a quantity is checked.
    Moment;
    End "end", "at its end";
    Peak "peak", "when the quantity was largest";
}

choices! {
    /// Which value a check looks at.
    CheckedValue;
    Computed "computed", "that of the mesh, of the finest in a mesh study";
    Extrapolated "extrapolated", "the one that a mesh study extrapolates to cells of no size";
}

table! {
    MESH_STUDY: MeshStudy, "The case on its grid and on finer ones: the error of the mesh.";
    meshes: whole(1, 3), default "1", "number of meshes; 1: no study, 2: cells of h and h/2, 3: h/4 too";
}

table! {
    OUTPUT: Output, "What is written, and where.";
    folder: text, derived "results/ and the name of the case file", "results folder";
    paraview: table(PARAVIEW: Paraview), default "{}", "particles and grid for ParaView";
    figures: list(choice(Field), 0, 40), default "[\"displacement\", \"plastic_strain\", \"sigma_yy\"]",
        "fields drawn at the end of every stage; with none no picture is drawn at all";
    cuts: list(table(CUT: Cut), 0, 20), default "[]",
        "planes in which the fields are drawn as well; without any, upright ones through the middle of the bodies", in_space;
    report: flag, default "true", "whether report.html is written";
    checkpoint: table(CHECKPOINT: Checkpoint), default "{}", "states from which a run can be resumed";
}

table! {
    CUT: Cut, "A plane across an axis.";
    across: choice(Across), required "\"y\"", "the axis";
    at: length, required "\"5 m\"", "where it stands on the axis";
}

choices! {
    /// Axes across which planes are drawn.
    Across;
    X "x", "upright, along y";
    Y "y", "upright, along x";
    Z "z", "level";
}

table! {
    PARAVIEW: Paraview, "When particles are written for ParaView.";
    every: either(choice(OutputTime), whole(1, 1_000_000)),
        derived "\"film\", in a study of meshes or a sweep \"stage\"",
        "\"film\", \"stage\", \"never\" or a number of steps";
}

choices! {
    /// When particles are written for ParaView.
    OutputTime;
    Film "film", "along every stage, up to 40 times, and at its end: in a motion at equal times, in others where soil has moved on, by about a twentieth of its way";
    Stage "stage", "at the end of every stage";
    Never "never", "not at all";
}

table! {
    CHECKPOINT: Checkpoint, "States from which a run can be resumed.";
    every: whole(0, 1_000_000), default "10", "steps between checkpoints; 0: at the end of stages only";
    keep: whole(1, 1000), default "2", "checkpoints kept within a stage";
}
