//! The results of a run, as written to `summary.json`.

use std::fmt::Write as _;

use igimp_model::TitleBlock;
use igimp_model::check::{Check, or_not_a_number};
use igimp_text::short;
use serde::{Deserialize, Serialize};

use crate::ending::{EndReason, Ending, PathEnd};
use crate::mesh_study::StudySummary;
use crate::model_size::ModelSize;

/// The outcome of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// `igimp` and its version.
    pub program: String,
    /// Title of the case.
    pub title: String,
    /// Project, client, author and revision.
    #[serde(default)]
    pub title_block: TitleBlock,
    /// Date and time of the run, as given by the caller.
    #[serde(default)]
    pub date: Option<String>,
    /// SHA-256 of `case.completed.toml`, the case with every default.
    #[serde(default)]
    pub input_sha256: Option<String>,
    /// Variant of the method.
    pub method: String,
    /// Size of the model.
    pub size: ModelSize,
    /// The case in words: materials, bodies, supports, loads, stages.
    #[serde(default)]
    pub setup: Vec<SetupTable>,
    /// Stages in the order they ran.
    pub stages: Vec<StageSummary>,
    /// Checks of curves and results.
    pub checks: Vec<CheckRow>,
    /// Warnings, for the reader.
    pub warnings: Vec<String>,
    /// The message of the step that ended the run for want of equilibrium, if one did.
    pub failure: Option<String>,
    /// Pictures in the order in which a report shows them.
    pub figures: Vec<FigureNote>,
    /// Wall-clock time \[s\].
    pub seconds: f64,
    /// Of that, time spent writing results \[s\].
    pub output_seconds: f64,
    /// Time of all processors together \[s\], where the system tells.
    pub cpu_seconds: Option<f64>,
    /// Largest resident memory \[MiB\], where the system tells.
    pub peak_memory_mib: Option<f64>,
    /// Memory by particle and by unknown, where the system tells.
    pub memory: Option<MemoryShare>,
    /// The cost that was estimated before the run, to be compared with `seconds` and
    /// `peak_memory_mib`.
    pub estimate: Option<Expected>,
    /// Whether the run was interrupted and can be resumed.
    pub interrupted: bool,
    /// The results of a study of the mesh error on all its meshes; stages and pictures are then those of
    /// the finest mesh that came to its end.
    pub mesh_study: Option<StudySummary>,
}

impl Summary {
    /// How the run ended.
    pub fn ending(&self) -> Ending {
        let stage = |outcome| self.stages.iter().any(|stage| stage.outcome == outcome);
        let meshes = self.mesh_study.as_ref();
        let meshes = meshes.map_or(Ending::Done, StudySummary::ending);
        if meshes != Ending::Done {
            meshes
        } else if self.interrupted || stage(StageOutcome::Interrupted) {
            Ending::Interrupted
        } else if stage(StageOutcome::NotConverged) {
            Ending::NotConverged
        } else if self.checks.iter().any(|row| !row.pass) {
            Ending::Missed
        } else {
            Ending::Done
        }
    }
}

/// A table that describes a part of the case.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SetupTable {
    /// Its title.
    pub title: String,
    /// Names of its columns, with units.
    pub header: Vec<String>,
    /// Rows, as text.
    pub rows: Vec<Vec<String>>,
}

/// The estimate of a run before it began.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Expected {
    /// Time of all planned steps, pictures and files \[s\].
    pub seconds: f64,
    /// Whether a stage may end before its planned steps are used up: `seconds` is then an upper bound.
    pub open_ended: bool,
    /// Threads that it holds for.
    pub threads: usize,
    /// Memory \[bytes\].
    pub bytes: f64,
    /// The same where an iteration is given up for factors \[bytes\].
    #[serde(default)]
    pub most_bytes: f64,
    /// Time by the same model of the steps and corrections that were taken \[s\].
    pub seconds_of_steps_taken: Option<f64>,
}

/// A picture of a results folder.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FigureNote {
    /// Path within the results folder without extension, such as `figures/curve-load-settlement`;
    /// it exists as `.svg` and `.png`.
    pub file: String,
    /// Caption.
    pub caption: String,
}

/// Largest resident memory less that at the beginning of the run, split
/// in the proportions of the estimate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MemoryShare {
    /// State, trial and supports of a particle \[bytes\].
    pub bytes_per_particle: f64,
    /// Matrix and factors, fill included, for an unknown \[bytes\].
    pub bytes_per_unknown: f64,
}

/// How a stage went.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StageSummary {
    /// Name.
    pub name: String,
    /// Kind, such as `gravity`.
    pub kind: String,
    /// How it ended.
    pub outcome: StageOutcome,
    /// Why, in words.
    pub reason: String,
    /// Why, as a code ([`EndReason::code`](crate::ending::EndReason::code)); empty before it ended.
    #[serde(default)]
    pub code: String,
    /// Share of the stage that was reached \[-\].
    pub reached: f64,
    /// Whether it ended in a way that tells no limit, though its case expects one: its path was lost, a linear system
    /// could not be solved, or a motion that is driven found no equilibrium.
    #[serde(default)]
    pub lost: bool,
    /// Accepted steps.
    pub steps: usize,
    /// Newton corrections in accepted steps.
    pub iterations: usize,
    /// Steps that were tried and cut.
    pub cuts: usize,
    /// Steps accepted above the tolerance, at round-off.
    pub at_round_off: usize,
    /// Wall-clock time \[s\].
    pub seconds: f64,
    /// Time by phase \[s\]: set-up, assembly, factorisation, solution, commit.
    pub phases: [f64; 5],
    /// Largest particle displacement at the end \[m\]; not a number for a search, which leaves the body as it was found.
    #[serde(deserialize_with = "or_not_a_number")]
    pub largest_displacement: f64,
    /// Share of particles that yielded in the last step \[-\].
    #[serde(deserialize_with = "or_not_a_number")]
    pub plastic_share: f64,
    /// Largest share of the load, in any step, that dropped nodes took without a support \[-\].
    #[serde(default)]
    pub false_support: f64,
    /// Steps that a ghost penalty held at nodes which hardly touch soil.
    #[serde(default)]
    pub ghost_steps: usize,
    /// Steps in which the grid took over means of the motion of the particles.
    #[serde(default)]
    pub steps_by_means: usize,
    /// Largest resistance of a footing that the stage pushed \[N/m\].
    pub peak_resistance: Option<f64>,
    /// Settlement of that footing at the end \[m\].
    #[serde(default)]
    pub settlement: Option<f64>,
    /// Result of a strength reduction.
    pub safety: Option<SafetySummary>,
    /// Gross work of the external force in the accepted steps: of its components, by magnitude \[J/m; J in space\].
    #[serde(default)]
    pub work: f64,
    /// The path that was followed to a limit load.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub path: Option<PathSummary>,
    /// The reinforcement that was there at its end.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub reinforcement: Vec<MemberSummary>,
    /// Water in the pores at the end, where there is some.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pore_water: Option<PoreSummary>,
    /// Where the work of a stage that takes time went.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy: Option<EnergySummary>,
    /// The water that flowed out of soil, of a stage with consolidation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub consolidation: Option<ConsolidationSummary>,
    /// Slide of a block by the motion of the ground, where the stage asks for it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub newmark: Option<NewmarkSummary>,
    /// How its linear systems were solved, in space.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub linear: Option<LinearSummary>,
}

/// Water that flowed out of soil.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ConsolidationSummary {
    /// Time that passed \[s\].
    pub time: f64,
    /// Water that left at open faces, sides and drains \[m³/m; m³ in space\].
    pub outflow: f64,
    /// Error of the balance of water of all steps, by magnitude \[m³/m; m³ in space\].
    pub missing: f64,
    /// Mean excess pore pressure, by magnitude, of the soil that water flows out of, at the end \[Pa\].
    pub excess: f64,
    /// The largest of that after any step \[Pa\].
    pub most_excess: f64,
}

impl ConsolidationSummary {
    /// Share of the largest mean excess pore pressure that is gone at the end \[-\].
    pub fn dissipated(&self) -> f64 {
        if self.most_excess > 0.0 {
            1.0 - self.excess / self.most_excess
        } else {
            0.0
        }
    }
}

impl StageSummary {
    /// Whether the stage came to the goal of its case: its end, or a condition that ends it there. One that found no
    /// equilibrium on its way, that ran out of steps, or that tells no limit where one is sought, did not.
    pub fn came_to_its_end(&self) -> bool {
        let ran_short = [
            EndReason::StepsOfPathRanOut,
            EndReason::StillMoving { steps: self.steps },
            EndReason::NoFactorOfSafety,
        ];
        matches!(
            self.outcome,
            StageOutcome::Completed | StageOutcome::Stopped
        ) && !self.lost
            && !ran_short.iter().any(|reason| reason.code() == self.code)
    }
}

/// Where the work of a stage that takes time went \[J/m; J in space\]. Other than states, they add up over the stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EnergySummary {
    /// Time that it took \[s\].
    pub time: f64,
    /// Kinetic energy at the end.
    pub kinetic: f64,
    /// The largest kinetic energy.
    pub most_kinetic: f64,
    /// Increase of kinetic energy.
    pub kinetic_gain: f64,
    /// Increase of elastic energy.
    pub elastic: f64,
    /// Plastic work.
    pub plastic: f64,
    /// Friction on rigid bodies, and energy stored in contact.
    pub contact: f64,
    /// Work on reinforcement.
    pub reinforcement: f64,
    /// Work against given pore pressure.
    pub water: f64,
    /// Work against damping of soil and ghost penalty.
    pub damping: f64,
    /// Work against dashpots and springs of walls.
    #[serde(default)]
    pub boundaries: f64,
    /// Work of gravity, loads and forces on rigid bodies, and of −M a where the ground moves.
    pub loads: f64,
    /// Work of the supports.
    pub supports: f64,
    /// Loss to the time integration.
    pub scheme: f64,
    /// Loss to the map between particles and grid.
    pub map: f64,
    /// Loss to integration of stress along the steps, and to the out-of-balance force that was left.
    pub integration: f64,
}

/// A share of the energy beyond which there is none to have a share of: soil stands still but for round-off \[-\].
const OF_NOTHING: f64 = 10.0;

impl EnergySummary {
    /// Its parts, as `energy.csv` names them.
    pub fn parts(&self) -> [(&'static str, f64); 14] {
        [
            ("kinetic", self.kinetic),
            ("kinetic_gain", self.kinetic_gain),
            ("elastic_gain", self.elastic),
            ("plastic_work", self.plastic),
            ("contact", self.contact),
            ("reinforcement", self.reinforcement),
            ("pore_water", self.water),
            ("damping", self.damping),
            ("boundaries", self.boundaries),
            ("loads", self.loads),
            ("supports", self.supports),
            ("scheme", self.scheme),
            ("map", self.map),
            ("integration", self.integration),
        ]
    }

    /// In a sentence.
    pub fn sentence(&self) -> String {
        let mut text = format!(
            "energy over {} s: loads {}, kinetic {}, elastic {}, plastic work {}",
            short(self.time),
            short(self.loads),
            short(self.kinetic_gain),
            short(self.elastic),
            short(self.plastic)
        );
        let others = [
            (self.supports, "supports"),
            (self.contact, "contact"),
            (self.reinforcement, "reinforcement"),
            (self.water, "pore water"),
            (self.damping, "damping"),
            (self.boundaries, "boundaries"),
        ];
        for (value, name) in others.into_iter().filter(|(value, _)| *value != 0.0) {
            let _ = write!(text, ", {name} {}", short(value));
        }
        let share = self.numerical_share();
        let taken = if share.abs() > OF_NOTHING {
            format!("{} J", short(self.numerical()))
        } else {
            format!("{:.2} %", 100.0 * share)
        };
        let _ = write!(
            text,
            " J; the method took {taken} (time integration {}, map {}, integration of stress {} J)",
            short(self.scheme),
            short(self.map),
            short(self.integration)
        );
        text
    }

    /// Loss to the numerical method, over the greatest of loads, supports and kinetic energy \[-\].
    pub fn numerical_share(&self) -> f64 {
        let scale = self
            .most_kinetic
            .max(self.loads.abs())
            .max(self.supports.abs());
        if scale > 0.0 {
            self.numerical() / scale
        } else {
            0.0
        }
    }

    /// Loss to the numerical method.
    fn numerical(&self) -> f64 {
        self.scheme + self.map + self.integration
    }
}

/// Motion of a rigid block by Newmark's method on the ground that a stage moves.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NewmarkSummary {
    /// Yield coefficient k_c, as a force over the weight: positive to the right \[-\].
    pub yield_coefficient: f64,
    /// Whether it is that of a limit; else of the last equilibrium that was found.
    pub is_limit: bool,
    /// The stage that tells it.
    pub from: String,
    /// Largest acceleration of the ground \[m/s²\].
    pub peak_acceleration: f64,
    /// Displacement of the block \[m\].
    pub displacement: f64,
}

impl NewmarkSummary {
    /// In a sentence, beside the largest displacement that the stage found \[m\].
    pub fn sentence(&self, largest: f64) -> String {
        format!(
            "Newmark's block: {} m with k_c = {} of stage \"{}\"{}, ground at up to {} m/s²; the soil moved by up to {} m",
            short(self.displacement),
            short(self.yield_coefficient),
            self.from,
            if self.is_limit {
                ""
            } else {
                " (its last equilibrium, no limit)"
            },
            short(self.peak_acceleration),
            short(largest)
        )
    }
}

/// How the linear systems of a stage were solved.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct LinearSummary {
    /// The method of the last step.
    pub method: String,
    /// Why it was taken, in words.
    pub reason: String,
    /// Solutions found in accepted steps.
    pub solutions: usize,
    /// Iterations of all of them; of a direct method none.
    pub iterations: usize,
    /// Iterations of the one that took most.
    pub most_iterations: usize,
    /// Iterations that were given up for a factorisation.
    pub lost_iterations: usize,
}

impl LinearSummary {
    /// In a sentence.
    pub fn sentence(&self) -> String {
        let Self {
            method,
            reason,
            solutions,
            iterations,
            most_iterations,
            lost_iterations,
        } = self;
        let mut text = format!("linear systems by {method} ({reason})");
        if *iterations > 0 {
            let each = (*iterations as f64 / (*solutions).max(1) as f64).round();
            let _ = write!(
                text,
                ": {solutions} solutions, {each} iterations each, at most {most_iterations}"
            );
        }
        if *lost_iterations > 0 {
            let _ = write!(
                text,
                "; {lost_iterations} iterations given up for a factorisation"
            );
        }
        text
    }
}

/// The tension of a member of reinforcement at the end of a stage.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MemberSummary {
    /// Name.
    pub name: String,
    /// Largest tension along it \[N/m\].
    pub force: f64,
    /// Tension at its head \[N/m\].
    pub head_force: f64,
    /// Share of its length on which tension is at its limit \[-\].
    pub at_limit: f64,
}

/// Water in the pores at the end of a stage; pressure compression positive.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PoreSummary {
    /// Largest pore pressure of any particle, given and excess \[Pa\].
    pub largest: f64,
    /// Least and largest excess pore pressure, where soil made some \[Pa\].
    pub excess: Option<[f64; 2]>,
    /// Particles whose pore pressure exceeds the total vertical stress.
    pub floating: usize,
    /// All particles.
    pub particles: usize,
}

/// How a stage ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StageOutcome {
    /// It reached its end.
    #[default]
    Completed,
    /// A condition of the case ended it.
    Stopped,
    /// No equilibrium was found.
    NotConverged,
    /// The user interrupted it.
    Interrupted,
}

/// A factor of safety as an interval, and how it was found.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SafetySummary {
    /// Largest factor found stable \[-\].
    pub stable: Option<f64>,
    /// Smallest factor found failed \[-\].
    pub failed: Option<f64>,
    /// The failure criterion, in words.
    pub criterion: String,
    /// Materials that were reduced.
    pub materials: Vec<String>,
    /// Materials that kept their strength.
    pub excluded: Vec<String>,
    /// Share of the mass that moves by more than a tenth of the largest displacement in the first
    /// unstable state \[-\].
    pub moving_mass: Option<f64>,
    /// The trials in the order they were made.
    pub trials: Vec<TrialSummary>,
    /// The path that was followed, of a search by continuation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub path: Option<PathSummary>,
}

/// Factor of safety beyond which strength is not needed \[-\]: with a thousandth of it the ground stands.
pub const NEEDLESS: f64 = 1e3;

/// A share of the mass that moves below which a failure may be local \[-\].
const LOCAL: f64 = 0.02;

impl SafetySummary {
    /// Whether so little of the mass moves at failure that a part of the ground may fail alone.
    pub fn may_be_local(&self) -> bool {
        let fails = (self.path.as_ref()).is_none_or(|path| path.limit.is_some());
        fails && self.moving_mass.is_some_and(|share| share < LOCAL)
    }

    /// The factor that checks and tables take: the middle of the interval, and where nothing fails the largest that was tried.
    pub fn factor(&self) -> Option<f64> {
        match (self.stable, self.failed) {
            (Some(stable), Some(failed)) => Some(0.5 * (stable + failed)),
            (stable, None) => stable.filter(|_| self.needs_no_strength()),
            (None, Some(_)) => None,
        }
    }

    /// Whether the ground stands with hardly any strength, as level ground between rollers does: its factor is no number to state.
    pub fn needs_no_strength(&self) -> bool {
        self.stable.is_some_and(|factor| factor > NEEDLESS)
    }
}

/// A path of equilibria along which strength is reduced, and its limit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PathSummary {
    /// Why it ended.
    pub end: PathEnd,
    /// The factor at the beginning of the stage \[-\]; 0 of a search.
    #[serde(default)]
    pub from: f64,
    /// Where the body first moves as a mechanism: 99 % of the work of a step is dissipated.
    pub mechanism: Option<PathPoint>,
    /// The equilibrium that tells the factor.
    #[serde(default)]
    pub limit: Option<PathPoint>,
    /// Where the rise of the factor over doublings of the work falls most.
    pub knee: Option<PathPoint>,
    /// Rise of the factor in the doubling of the work up to the equilibrium that tells it, as a share of it; of a factor that
    /// the stage lowers, its fall \[-\].
    pub rise: Option<f64>,
    /// The displacement γH²/E that soil of this weight, height and stiffness is moved by before it fails \[m\].
    pub displacement_scale: Option<f64>,
    /// The shares that decide the factor, if the path reached a mechanism.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shares: Option<StrengthShares>,
    /// Its equilibria in order.
    pub points: Vec<PathPoint>,
}

/// The shares that decide a factor of safety, at the last equilibrium of its path.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StrengthShares {
    /// The shares of the materials that have a strength.
    pub materials: Vec<MaterialShare>,
    /// Share of the dissipation in reinforcement \[-\].
    pub reinforcement: f64,
    /// The factor by the kinematic theorem, where the displacements are nearly those of plastic flow by the normality rule.
    pub kinematic: Option<Kinematic>,
}

impl StrengthShares {
    /// Each strength, as the name of its material, its symbol, and the change of the factor with it \[-\].
    pub fn strengths(&self) -> impl Iterator<Item = (&str, &'static str, f64)> {
        self.materials.iter().flat_map(|entry| {
            let friction = entry.friction.map(|friction| ("tan φ", friction));
            std::iter::once(("c", entry.cohesion))
                .chain(friction)
                .map(|(symbol, share)| (entry.material.as_str(), symbol, share + 0.0))
        })
    }
}

/// The share of a material in a factor of safety.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MaterialShare {
    /// Its name.
    pub material: String,
    /// Whether its strength is reduced: changes with reduced strengths add up to 1 (theory, eq. 33h).
    pub is_reduced: bool,
    /// Share of the dissipation of the last step \[-\]; 0 where it dissipates nothing.
    pub dissipation: f64,
    /// Change of the factor with its cohesion, undrained strength or yield stress, with the tension cut-off:
    /// ∂ ln F/∂ ln c \[-\].
    pub cohesion: f64,
    /// Change of the factor with its friction, ∂ ln F/∂ ln tan φ \[-\]; none without friction.
    pub friction: Option<f64>,
}

/// A factor of safety by the kinematic theorem, of the displacements of the last step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Kinematic {
    /// The factor \[-\].
    pub factor: f64,
    /// Work of the mean stress on the volume by which the field misses that of plastic flow, over the work of the step
    /// \[-\].
    pub missed: f64,
}

/// An equilibrium of a path along which strength is reduced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PathPoint {
    /// Strength reduction factor \[-\].
    pub factor: f64,
    /// Gross work of the external force since the beginning of the path: of its components, by magnitude \[J/m; J in space\].
    pub work: f64,
    /// Displacement that the search looks at, since the beginning of the path \[m\].
    #[serde(deserialize_with = "or_not_a_number")]
    pub displacement: f64,
    /// Share of the gross work of the last step that is not elastic \[-\]: 1 of a mechanism.
    #[serde(deserialize_with = "or_not_a_number")]
    pub dissipated: f64,
    /// Share of particles that yielded in the last step \[-\].
    #[serde(deserialize_with = "or_not_a_number")]
    pub plastic_share: f64,
    /// Newton corrections of the last step.
    pub iterations: usize,
    /// By how much the residual of the last step puts the factor in doubt, as a share of it \[-\].
    #[serde(deserialize_with = "or_not_a_number")]
    pub in_doubt: f64,
}

/// One trial of a search.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TrialSummary {
    /// Strength reduction factor \[-\].
    pub srf: f64,
    /// Whether the body stands.
    pub stable: bool,
    /// Why.
    pub reason: String,
    /// Displacement that the criterion looks at \[m\].
    #[serde(deserialize_with = "or_not_a_number")]
    pub displacement: f64,
    /// Accepted steps.
    pub steps: usize,
    /// Newton corrections.
    pub iterations: usize,
    /// Steps that were cut.
    pub cuts: usize,
    /// Strength reduction factor \[-\] and that displacement \[m\] at every equilibrium of a trial that
    /// reduces strength step by step.
    #[serde(default)]
    pub course: Vec<[f64; 2]>,
}

/// A check and whether it passed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CheckRow {
    /// The check.
    pub check: Check,
    /// Whether the band is met.
    pub pass: bool,
    /// Standing of the value.
    #[serde(default)]
    pub standing: Standing,
}

impl CheckRow {
    /// A check that was held.
    pub fn held(check: Check) -> Self {
        let standing = Standing::Held;
        Self {
            pass: check.passes(),
            check,
            standing,
        }
    }

    /// A check whose stage did not come to its end, or was not reached: it is not met, whatever the value is on the way.
    pub fn not_reached(check: Check) -> Self {
        let standing = Standing::NotReached;
        Self {
            pass: false,
            check,
            standing,
        }
    }

    /// Whether the stage of the check was reached and came to its end.
    pub fn is_reached(&self) -> bool {
        self.standing != Standing::NotReached
    }

    /// The verdict in a word or two.
    pub fn verdict(&self) -> &'static str {
        match (self.standing, self.pass) {
            (Standing::NotReached, _) => "not reached",
            (_, true) => "met",
            (_, false) => "missed",
        }
    }

    /// The value as it is read.
    pub fn measured(&self) -> String {
        match self.standing {
            Standing::NothingFails => format!("> {NEEDLESS}"),
            _ => self.check.printed(self.check.measured),
        }
    }
}

/// Standing of the value of a check: held, or the reason why not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Standing {
    /// It is that of the end, or of the peak, of the stage.
    #[default]
    Held,
    /// The stage was not reached, or did not come to its end: the value is one on the way, or none.
    NotReached,
    /// A factor of safety of ground in which nothing fails: it is larger than any number to state.
    NothingFails,
}

#[cfg(test)]
mod tests {
    use super::EnergySummary;

    /// GOAL: of soil that stands still, the method takes no share of nothing.
    /// ORACLE: by hand: the loss in joule, and a hundredth of a motion.
    #[test]
    fn soil_at_rest_loses_no_share() {
        let energy = |most_kinetic: f64| EnergySummary {
            most_kinetic,
            scheme: -2e-9,
            ..EnergySummary::default()
        };
        let still = energy(1e-22).sentence();
        assert!(
            still.contains("the method took -2.000e-9 J (time"),
            "{still}"
        );
        let moved = energy(2e-7).sentence();
        assert!(moved.contains("the method took -1.00 % (time"), "{moved}");
    }
}
