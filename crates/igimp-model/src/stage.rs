//! Stages: what happens, in order.

use igimp_assembly::{Geometry, Rayleigh, TimeScheme};

use super::{Construction, GroundMotion, RigidMove};

/// One thing that happens.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// Name.
    pub name: String,
    /// Kind.
    pub kind: StageKind,
    /// Load steps when none is cut; in a strength reduction those of each trial by gravity, or of a
    /// reduction from F = 1 to the upper end of the bracket.
    pub steps: usize,
    /// The geometry that its steps are computed on.
    pub geometry: Geometry,
    /// Stage whose end this one starts from; `None`: the undeformed, stress-free bodies for the
    /// first stage.
    pub start_from: Option<usize>,
    /// Whether displacements count from the end of this stage on.
    pub reset_displacements: bool,
    /// Indices of the reinforcement that is installed as it begins.
    pub install: Vec<usize>,
    /// Conditions that end the stage early.
    pub stop_when: StopWhen,
    /// Whether all soil drains while it lasts: no excess pore pressure comes or goes.
    pub drained: bool,
    /// Time in which water flows out of coupled soil; none: the stage takes no time.
    pub consolidation: Option<Consolidation>,
}

impl Stage {
    /// Whether it takes time.
    pub fn takes_time(&self) -> bool {
        self.duration() > 0.0
    }

    /// How long it lasts; zero in statics \[s\].
    pub fn duration(&self) -> f64 {
        match (&self.kind, &self.consolidation) {
            (StageKind::Dynamic(own), _) => own.duration,
            (_, own) => own.as_ref().map_or(0.0, |own| own.duration),
        }
    }
}

/// Time in which water flows out of soil.
#[derive(Clone, Debug, PartialEq)]
pub struct Consolidation {
    /// How long it lasts \[s\].
    pub duration: f64,
    /// Whether water leaves at the free faces of soil.
    pub open_faces: bool,
    /// Sides of the grid where water leaves, by axis and whether it is the upper end.
    pub open_sides: Vec<(usize, bool)>,
    /// Boxes where water leaves, lower and upper corner; coordinates beyond the dimension are zero \[m\].
    pub drains: Vec<[[f64; 3]; 2]>,
    /// Longest step \[s\]; none: the error in time alone chooses.
    pub longest_step: Option<f64>,
}

/// Kinds of stages.
#[derive(Clone, Debug, PartialEq)]
pub enum StageKind {
    /// Raises gravity from where it is to a multiple of its value, and changes pseudo-static acceleration.
    Gravity {
        /// The multiple \[-\].
        factor: f64,
        /// Pseudo-static force to the right over the weight \[-\]; none: as it is.
        horizontal: Option<f64>,
        /// The same backwards, along the second axis of space \[-\].
        across: Option<f64>,
        /// The same upwards \[-\].
        vertical: Option<f64>,
    },
    /// Stresses of level ground: the weight above, and K₀ times that sideways; then equilibrium.
    K0,
    /// Changes the factor of loads from where it is.
    Load {
        /// Indices of the loads.
        loads: Vec<usize>,
        /// Factor at the end \[-\].
        factor: f64,
    },
    /// Pushes a rigid footing down.
    Displacement {
        /// Index of the footing.
        load: usize,
        /// Further settlement \[m\].
        settlement: f64,
    },
    /// Moves and loads rigid bodies.
    Rigid(Vec<RigidMove>),
    /// Places and removes bodies, changes materials and water.
    Construction(Construction),
    /// Changes nothing: water flows.
    Wait,
    /// Searches for the factor of safety. The body is left as it was found.
    StrengthReduction(StrengthReduction),
    /// Lets the slope of reduced strength move until it rests.
    RunOut(RunOut),
    /// Motion in time, with inertia.
    Dynamic(Dynamic),
}

/// How the factor of safety is searched for.
#[derive(Clone, Debug, PartialEq)]
pub struct StrengthReduction {
    /// Indices of the materials whose strength is reduced.
    pub materials: Vec<usize>,
    /// Factors tried first, for the curve of displacement against factor \[-\]; may be empty.
    pub factors: Vec<f64>,
    /// Where the search begins: a factor thought stable and one thought unstable \[-\].
    pub bracket: [f64; 2],
    /// Width of the interval at which the search ends \[-\].
    pub tolerance: f64,
    /// How the reduced strength is reached.
    pub path: ReductionPath,
    /// A displacement at which the slope counts as failed \[m\]; lack of equilibrium always does.
    pub failure_displacement: Option<f64>,
    /// Monitor whose displacement counts; none: the largest of all particles.
    pub monitor: Option<usize>,
    /// How the factor is looked for.
    pub search: SearchMethod,
}

/// How a search looks for the factor of safety.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SearchMethod {
    /// Along the path of equilibria, the factor an unknown.
    Continuation,
    /// By trials, each of which stands or fails.
    Trials,
}

/// How a trial reaches its reduced strength.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReductionPath {
    /// The strength of the loaded body is reduced step by step.
    Reduce,
    /// Gravity is raised on undeformed bodies of reduced strength.
    Gravity,
}

/// A run-out of a slope with reduced strength: overdamped motion until it rests.
#[derive(Clone, Debug, PartialEq)]
pub struct RunOut {
    /// Indices of the materials whose strength is reduced.
    pub materials: Vec<usize>,
    /// The reduction.
    pub reduction: Reduction,
    /// Largest displacement aimed at in a step, as a share of the cell \[-\].
    pub move_per_step: f64,
    /// The slope rests when the drag carries less than this share of the external force \[-\].
    pub at_rest: f64,
}

/// Motion in time, with inertia.
#[derive(Clone, Debug, PartialEq)]
pub struct Dynamic {
    /// How long it lasts \[s\].
    pub duration: f64,
    /// Time integration.
    pub scheme: TimeScheme,
    /// Share of the mass that is lumped at the nodes \[-\].
    pub lumped_share: f64,
    /// Share of a cell's volume below which the motion of a node is extrapolated \[-\].
    pub tied_below: f64,
    /// Longest step \[s\]; none: error and way alone choose.
    pub longest_step: Option<f64>,
    /// Strength that is lost as it begins: materials by index, and by how much.
    pub reduction: Option<(Vec<usize>, Reduction)>,
    /// Rigid bodies that it moves, loads or lets free.
    pub bodies: Vec<RigidMove>,
    /// The share of its largest value to which kinetic energy has to fall for the stage to end \[-\]; none: it lasts its whole
    /// duration.
    pub at_rest: Option<f64>,
    /// What lies beyond the walls of the grid.
    pub walls: StageWalls,
    /// Motion of the ground that the body stands on; none: it stands still.
    pub ground_motion: Option<GroundMotion>,
    /// Damping of soil, if any.
    pub rayleigh: Option<Rayleigh>,
    /// The stage whose yield acceleration gives the displacement by Newmark's sliding block, by index.
    pub newmark_from: Option<usize>,
}

/// What lies beyond the walls of the grid during motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StageWalls {
    /// Walls with dashpots, by axis and whether it is the upper end.
    pub absorbing: Vec<(usize, bool)>,
    /// Stiffness of the springs beside dashpots over modulus and length of the model \[-\].
    pub springs: f64,
    /// Whether the two walls across the first axis move together.
    pub tied: bool,
    /// Walls with dashpots beside which a column of soil moves in free field, by axis and whether it is the upper end.
    pub free_field: Vec<(usize, bool)>,
}

/// By how much strength is reduced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reduction {
    /// A multiple of the factor of safety found before (middle of its interval).
    TimesFos(f64),
    /// A factor.
    Factor(f64),
}

impl StageKind {
    /// Most frames of a film of the stage: more where the soil moves in time.
    pub fn film_frames(&self) -> usize {
        match self {
            Self::Dynamic(_) => 40,
            _ => 20,
        }
    }

    /// Its name in a case file.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Gravity { .. } => "gravity",
            Self::K0 => "k0",
            Self::Load { .. } => "load",
            Self::Displacement { .. } => "displacement",
            Self::Rigid(_) => "rigid",
            Self::Construction(_) => "construction",
            Self::Wait => "wait",
            Self::StrengthReduction(_) => "strength-reduction",
            Self::RunOut(_) => "run-out",
            Self::Dynamic(_) => "dynamic",
        }
    }
}

/// Conditions that end a stage early, and count as a planned end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StopWhen {
    /// A displacement is reached \[m\].
    pub displacement: Option<f64>,
    /// Monitor whose displacement counts; none: the largest of all particles.
    pub monitor: Option<usize>,
    /// Want of equilibrium is the planned end: the load reached is the collapse load.
    pub no_equilibrium: bool,
    /// The reaction of the pushed footing grows by less than this share in a step \[-\].
    pub load_grows_less_than: Option<f64>,
}
