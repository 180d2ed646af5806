//! Stages.

use super::MOST_THINGS;
use super::consolidation::{CONSOLIDATION, Consolidation};
use super::declare::{choices, table, variants};
use super::ground_motion::{GROUND_MOTION, GroundMotion, RAYLEIGH, Rayleigh, Wall};
use super::rigid::{MOVE, Move};
use crate::tree::Wrong;
use crate::tree::read::At;

/// Most load steps of a stage.
const MOST_STEPS: i64 = 1_000_000;

variants! {
    STAGE: Stage of StageForm, "One thing that happens.", "type", "kind of stage";
    named_apart "\"weight\"";
    "gravity" => Gravity(GRAVITY: Gravity),
    "k0" => K0(K0: LevelGround),
    "load" => Load(LOADING: Loading),
    "displacement" => Displacement(DISPLACEMENT: Displacement),
    "rigid" => Rigid(RIGID_MOTION: RigidMotion),
    "construction" => Construction(CONSTRUCTION: Construction),
    "wait" => Wait(WAIT: Wait),
    "strength-reduction" => StrengthReduction(STRENGTH_REDUCTION: StrengthReduction),
    "run-out" => RunOut(RUN_OUT: RunOut),
    "dynamic" => Dynamic(DYNAMIC: Dynamic),
    after STAGE_COMMON: StageCommon;
}

table! {
    GRAVITY: Gravity,
    "Raises gravity from where it is to a multiple of its value; changes pseudo-static acceleration.";
    factor: number(NotNegative), default "1", "the multiple";
    horizontal: number(Any), optional "it stays as it is, 0 at first",
        "pseudo-static force to the right, as a share of the weight";
    across: number(Any), optional "it stays as it is, 0 at first",
        "pseudo-static force backwards, along y, as a share of the weight", in_space;
    vertical: number(Any), optional "it stays as it is, 0 at first",
        "pseudo-static force upwards, as a share of the weight";
    geometry: choice(Geometry),
        derived "\"given\" where a search on the given geometry goes back to this stage, else \"moving\"",
        "the geometry that its steps are computed on";
}

table! {
    K0: LevelGround, "Stresses of level ground: the weight above, and K0 times that sideways.";

}

table! {
    LOADING: Loading, "Changes the factor of loads from where it is.";
    load: apart(reference("load")), optional "`loads` names them", "the load, if it is one";
    loads: apart(list(reference("load"), 1, MOST_THINGS)), optional "`load` names it",
        "the loads, if they are several";
    factor: apart(number(Any)), default "1", "their factor at the end of the stage";
    geometry: apart(choice(Geometry)), default "\"moving\"", "the geometry that its steps are computed on";
}

table! {
    DISPLACEMENT: Displacement, "Pushes a rigid footing down.";
    load: apart(reference("load")), required "\"footing\"", "the footing";
    settlement: apart(quantity(Length, Positive)), required "\"0.2 m\"", "further settlement";
    geometry: apart(choice(Geometry)), default "\"moving\"", "the geometry that its steps are computed on";
}

table! {
    RIGID_MOTION: RigidMotion, "Moves and loads rigid bodies; one that was not there yet is placed first.";
    bodies: apart(each(table(MOVE: Move), 1, MOST_THINGS)), required "[{ body = \"footing\", y = \"-0.2 m\" }]",
        "the bodies, and how they move";
    geometry: apart(choice(Geometry)), default "\"moving\"", "the geometry that its steps are computed on";
}

table! {
    CONSTRUCTION: Construction,
    "Places and removes bodies, changes materials and the water. What that leaves out of balance is let go over its steps.";
    place: apart(list(reference("body"), 0, MOST_THINGS)), default "[]",
        "bodies that are placed, free of stress where they are drawn; they are not there before";
    remove: apart(list(reference("body"), 0, MOST_THINGS)), default "[]", "bodies that are taken away";
    materials: apart(each(table(CHANGE: MaterialChange), 0, MOST_THINGS)), default "[]",
        "bodies that consist of another material from now on";
    water: apart(reference("water condition")), optional "as before", "condition of the water from now on";
    dissipate: apart(flag), default "false", "whether excess pore pressure of undrained soil is gone at the end";
    geometry: apart(choice(Geometry)), default "\"moving\"", "the geometry that its steps are computed on";
}

table! {
    WAIT: Wait, "Changes nothing: water flows, for the time that its `consolidation` says.";
    geometry: apart(choice(Geometry)), default "\"moving\"", "the geometry that its steps are computed on";
}

table! {
    STRENGTH_REDUCTION: StrengthReduction, "Searches for the factor of safety; the body is left as it was found.";
    materials: apart(list(reference("material"), 1, MOST_THINGS)),
        derived "all materials of bodies that have a strength",
        "materials whose strength is reduced; the others keep theirs";
    factors: list(number(Positive), 0, 1000), default "[]",
        "factors tried first, for the curve of displacement against factor";
    bracket: pair(number(Positive)), default "[1.0, 2.0]",
        "where trials begin: a factor thought stable and one thought unstable";
    tolerance: number(Positive), default "0.01", "width of the interval at which trials end";
    path: choice(ReductionPath), default "\"reduce\"", "how the reduced strength is reached";
    search: choice(Search), derived "\"continuation\" on the given geometry without `factors`, else \"trials\"",
        "how the factor is looked for";
    geometry: choice(Geometry), default "\"given\"", "the geometry that its steps are computed on";
    failure: table(FAILURE: Failure), default "{}", "what counts as failure";
    in_time: reference("water condition"), optional "one search is made",
        "water with `times`: a search at each of them, called by the name and the time, after a stage of type construction that brings its water";
}

table! {
    RUN_OUT: RunOut, "Lets the slope of reduced strength move until it rests.";
    reduction: apart(table(REDUCTION: Reduction)), required "{ times_fos = 1.05 }",
        "by how much strength is reduced";
    materials: apart(list(reference("material"), 1, MOST_THINGS)),
        derived "all materials of bodies that have a strength",
        "materials whose strength is reduced; the others keep theirs";
    move_per_step: number(Positive), default "0.1",
        "largest displacement aimed at in a step, as a share of the cell";
    at_rest: number(Share), default "1e-3",
        "the slope rests when drag carries less than this share of the external force";
}

table! {
    DYNAMIC: Dynamic, "Motion in time, with inertia.";
    duration: quantity(Time, Positive), required "\"5 s\"", "how long it lasts";
    scheme: choice(Scheme), default "\"generalised-alpha\"", "how motion is integrated in time";
    lumped_share: number(Fraction), default "0.01",
        "share of the mass that is lumped at the nodes: 0 consistent, 1 lumped";
    tied_below: number(NotNegative), default "0.2",
        "share of the volume that full soil leaves at a node below which its motion is extrapolated from full cells";
    longest_step: quantity(Time, Positive), optional "the error of the scheme and the way of the soil alone choose",
        "longest step of time";
    reduction: apart(table(REDUCTION: Reduction)), optional "strength stays",
        "by how much strength is reduced as it begins";
    materials: apart(list(reference("material"), 1, MOST_THINGS)),
        derived "all materials of bodies that have a strength",
        "materials whose strength is reduced; the others keep theirs";
    bodies: apart(each(table(MOVE: Move), 0, MOST_THINGS)), default "[]",
        "rigid bodies that it moves, loads or lets free";
    at_rest: number(Share), optional "it lasts its whole duration",
        "it ends when kinetic energy has fallen to this share of its largest value";
    absorbing: list(choice(Wall), 0, 6), default "[]",
        "sides of the grid with dashpots in place of supports; what the supports carried goes on";
    wall_springs: number(NotNegative), default "1",
        "stiffness of the springs beside dashpots, as a multiple of the soil's modulus over the length of the model";
    tied_sides: flag, default "false",
        "whether the left and the right side move together, as those of a laminar box, in place of their supports";
    free_field: list(choice(Wall), 0, 2), default "[]",
        "sides beside which a column of the soil there moves on its own, with dashpots between: left, right or both";
    ground_motion: table(GROUND_MOTION: GroundMotion), optional "the ground stands still",
        "motion of the ground below; displacement and velocity are then those against it";
    rayleigh: table(RAYLEIGH: Rayleigh), optional "soil is not damped beside its plastic work",
        "viscous damping of soil by mass and stiffness";
    newmark_from: reference("stage"), optional "no sliding block is computed",
        "stage of type gravity that tells the yield acceleration of Newmark's sliding block by its `horizontal`";
    geometry: apart(choice(Geometry)), default "\"moving\"", "the geometry that its steps are computed on";
}

table! {
    STAGE_COMMON: StageCommon, "Keys of every stage.";
    steps: apart(whole(1, MOST_STEPS)), default "10",
        "load steps when none is cut; in a strength reduction those by which gravity is raised, or by which trials \
         march from F = 1 to the upper end of the bracket";
    start_from: apart(reference("stage")), derived "the stage before", "stage whose end this one starts from";
    install: apart(list(reference("reinforcement"), 0, MOST_THINGS)), default "[]",
        "reinforcement that comes in as the stage begins; what no stage installs is there from the start";
    reset_displacements: apart(flag), default "false", "whether displacements count from the end of this stage on";
    drained: apart(flag), default "false",
        "whether all soil drains while it lasts: no excess pore pressure comes or goes";
    consolidation: apart(table(CONSOLIDATION: Consolidation)), optional "it takes no time, and coupled soil is undrained",
        "time in which water flows out of coupled soil";
    stop_when: apart(table(STOP_WHEN: StopWhen)), default "{}", "conditions that end the stage early";
}

choices! {
    /// The geometry that the steps of a stage are computed on.
    Geometry;
    Given "given", "positions and supports stay as the stage finds them; strain adds up as small strain";
    Moving "moving", "every step begins where the last one carried the particles";
}

choices! {
    /// How motion is integrated in time.
    Scheme;
    BackwardEuler "backward-euler", "first order; what steps do not resolve is damped out";
    Newmark "newmark", "second order, without damping (β = ¼, γ = ½)";
    GeneralisedAlpha "generalised-alpha", "second order; what steps do not resolve is damped";
}

choices! {
    /// How reduced strength is reached.
    ReductionPath;
    Reduce "reduce", "the strength of the loaded body is reduced step by step";
    Gravity "gravity", "gravity is raised on undeformed bodies of reduced strength";
}

choices! {
    /// How a factor of safety is looked for.
    Search;
    Continuation "continuation",
        "along the path of equilibria, the factor an unknown, until the body moves as a mechanism and the factor rises no longer";
    Trials "trials", "by trials at one factor after another, each of which finds equilibrium or not";
}

choices! {
    /// The criterion of failure.
    Criterion;
    NoEquilibrium "no-equilibrium", "no equilibrium is found";
}

table! {
    FAILURE: Failure, "What counts as failure in a strength reduction.";
    when: choice(Criterion), default "\"no-equilibrium\"", "criterion that always counts";
    also: table(ALSO: Also), optional "nothing else counts", "a displacement that counts too";
}

table! {
    ALSO: Also, "A displacement at which the slope counts as failed.";
    monitor: reference("monitor"), optional "the largest displacement of all particles",
        "monitor whose displacement counts";
    displacement: quantity(Length, Positive), required "\"0.5 m\"", "the displacement";
}

table! {
    REDUCTION: Reduction, "By how much strength is reduced: one of the two.";
    times_fos: number(Positive), optional "`factor` is given", "a multiple of the factor of safety found before";
    factor: number(Positive), optional "`times_fos` is given", "a factor";
}

table! {
    STOP_WHEN: StopWhen, "Conditions that end a stage early, and count as a planned end.";
    displacement: quantity(Length, Positive), optional "no limit", "a displacement is reached";
    monitor: reference("monitor"), optional "the largest displacement of all particles",
        "monitor whose displacement counts";
    load_grows_less_than: number(Positive), optional "no limit",
        "the footing's reaction grows by less than this share in a step";
    no_equilibrium: flag, default "false",
        "want of equilibrium is the planned end: what was reached is the collapse load";
}

table! {
    CHANGE: MaterialChange, "A body that consists of another material from now on.";
    body: reference("body"), required "\"clay\"", "the body";
    material: reference("material"), required "\"treated\"", "what it becomes";
}

impl Stage {
    /// The stage that it says it starts from.
    pub fn start_from(&self) -> Option<&At<String>> {
        let common = self.common.as_ref().ok()?;
        common.start_from.as_ref().ok()?.as_ref()
    }

    /// The members that it installs.
    pub fn installs(&self) -> &[At<String>] {
        let common = self.common.as_ref();
        common.map_or(&[], |common| listed(&common.install))
    }

    /// The keys of a stage of construction, if it is one.
    pub fn construction(&self) -> Option<&Construction> {
        match &*self.form {
            StageForm::Construction(keys) => keys.as_ref().ok(),
            _ => None,
        }
    }

    /// The loads that it applies or pushes.
    pub fn loads(&self) -> Vec<&At<String>> {
        match &*self.form {
            StageForm::Load(Ok(keys)) => {
                let one = keys.load.iter().flatten();
                let several = keys.loads.iter().flatten().flat_map(|loads| loads.iter());
                one.chain(several).collect()
            }
            StageForm::Displacement(Ok(keys)) => keys.load.iter().collect(),
            _ => Vec::new(),
        }
    }

    /// How it moves rigid bodies.
    pub fn moves(&self) -> &[Result<At<Move>, Wrong>] {
        match &*self.form {
            StageForm::Rigid(Ok(keys)) => keys.bodies.as_ref().map_or(&[], |list| list.as_slice()),
            StageForm::Dynamic(Ok(keys)) => {
                (keys.bodies.as_ref()).map_or(&[], |list| list.as_slice())
            }
            _ => &[],
        }
    }
}

impl Construction {
    /// The bodies that it places.
    pub fn placed(&self) -> &[At<String>] {
        listed(&self.place)
    }

    /// The bodies that it takes away.
    pub fn removed(&self) -> &[At<String>] {
        listed(&self.remove)
    }

    /// The bodies that consist of another material from now on.
    pub fn changes(&self) -> &[Result<At<MaterialChange>, Wrong>] {
        (self.materials.as_ref()).map_or(&[], |list| list.as_slice())
    }

    /// The condition of the water that it calls for.
    pub fn water_condition(&self) -> Option<&At<String>> {
        self.water.as_ref().ok()?.as_ref()
    }
}

/// The names in a list, if it was found right.
fn listed(list: &Result<At<Vec<At<String>>>, Wrong>) -> &[At<String>] {
    list.as_ref().map_or(&[], |list| list.as_slice())
}
