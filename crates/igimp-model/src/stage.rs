//! Stages of a case, in order.

pub(crate) mod driven;

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
            (StageKind::Dynamic(motion), _) => motion.duration,
            (_, flow) => flow.as_ref().map_or(0.0, |flow| flow.duration),
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
    /// Share of the volume that full soil leaves at a node below which its motion is extrapolated \[-\].
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
    /// The ground beyond the walls of the grid.
    pub walls: StageWalls,
    /// Motion of the ground that the body stands on; none: it stands still.
    pub ground_motion: Option<GroundMotion>,
    /// Damping of soil, if any.
    pub rayleigh: Option<Rayleigh>,
    /// The stage whose yield acceleration gives the displacement by Newmark's sliding block, by index.
    pub newmark_from: Option<usize>,
}

/// The ground beyond the walls of the grid during motion.
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
    /// A multiple of the factor of safety of the state that the stage starts from (middle of its interval).
    TimesFos(f64),
    /// A factor.
    Factor(f64),
}

/// The search that tells the factor of safety of the state which a stage starts from: the last one of that state in the file, or of
/// the nearest state before it that has one; by number, none where no state was searched. `from` is the stage that a stage starts
/// from. A search leaves its state as it was, so that a stage which starts from a search starts from that state.
pub fn search_of(
    number: usize,
    from: &dyn Fn(usize) -> Option<usize>,
    is_search: &dyn Fn(usize) -> bool,
) -> Option<usize> {
    let mut at = from(number);
    loop {
        if let Some(search) = at.filter(|&stage| is_search(stage)) {
            return Some(search);
        }
        let of_state = |&stage: &usize| {
            let mut state = from(stage);
            while let Some(search) = state.filter(|&before| is_search(before)) {
                state = from(search);
            }
            is_search(stage) && state == at
        };
        let found = (0..number).rev().find(of_state);
        if found.is_some() || at.is_none() {
            return found;
        }
        at = at.and_then(from);
    }
}

impl StageKind {
    /// Frames of a film of the stage in many steps, where soil moves steadily, beside that of its end; a search has none of its own.
    pub fn film_frames(&self) -> usize {
        match self {
            Self::Dynamic(_) => 40,
            Self::StrengthReduction(_) => 0,
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

#[cfg(test)]
mod tests {
    use super::search_of;

    // GOAL: the factor of safety that a run-out refers to is that of the state which it starts from, in whatever order the
    // searches stand in the file.
    // ORACLE: trees of stages by hand; a letter s marks a search.
    #[test]
    fn the_search_is_that_of_the_state() {
        let of = |stages: &[(&str, Option<usize>)], number: usize| {
            let from = |stage: usize| stages[stage].1;
            search_of(number, &from, &|stage| stages[stage].0 == "s")
        };
        // Weight, dry search, water, wet search, run-out of the dry slope: then the other order.
        let [w, s] = ["w", "s"];
        let dry_first = [
            (w, None),
            (s, Some(0)),
            (w, Some(0)),
            (s, Some(2)),
            (w, Some(0)),
        ];
        assert_eq!(of(&dry_first, 4), Some(1));
        let wet_first = [
            (w, None),
            (w, Some(0)),
            (s, Some(1)),
            (s, Some(0)),
            (w, Some(0)),
        ];
        assert_eq!(of(&wet_first, 4), Some(3));
        // Of two searches of one state the last; the one named, where the run-out starts from a search.
        let two = |start| [(w, None), (s, Some(0)), (s, Some(1)), (w, Some(start))];
        assert_eq!(of(&two(0), 3), Some(2));
        assert_eq!(of(&two(1), 3), Some(1));
        // A state that nobody searched has the factor of the state before it; a branch beside it has none to give.
        let before = [(w, None), (s, Some(0)), (w, Some(1)), (w, Some(2))];
        assert_eq!(of(&before, 3), Some(1));
        let beside = [(w, None), (w, Some(0)), (s, Some(1)), (w, Some(0))];
        assert_eq!(of(&beside, 3), None);
        // Gravity raised anew is a search of undeformed bodies, the root of all states.
        let root = [(s, None), (w, None), (w, Some(1))];
        assert_eq!(of(&root, 2), Some(0));
    }
}
