//! A problem as data: what a case file says, with names resolved and numbers in SI units.
//!
//! Lengths are in m, stresses in Pa, unit weights in N/m³, angles in rad, forces in N/m (plane
//! strain, per metre run). The second axis points up; gravity acts along its negative direction.

mod axes;
mod grid;
mod ground;
mod profile;
mod raster;
mod reinforcement;
mod rigid;
mod rigid_space;
mod water;

use std::path::PathBuf;
use std::sync::Arc;

use igimp_assembly::{Geometry, Method, SharedLaw};
use igimp_material::{Elasticity, HenckyElastic, MaterialError, MohrCoulomb, Tresca, VonMises};
use igimp_solver::linear::SolverKind;
use serde::{Deserialize, Serialize};

pub(crate) use axes::{from_front, front, in_space};
pub use grid::{AxisSpec, GridSpec, MixedCells};
pub use ground::{Ground, Layer};
pub use profile::{LEAST_STRENGTH, Profile, Profiles, StressShare, Variation};
pub use raster::Raster;
pub use reinforcement::{ReinforcementKind, ReinforcementPart, ReinforcementQuantity};
pub use rigid::{
    Adhesion, COMPONENTS, RigidDrive, RigidForm, RigidInterface, RigidMove, RigidPart,
    RigidQuantity, RigidShape, RigidShear, components,
};
pub use rigid_space::RigidSolid;
pub(crate) use water::table_level;
pub use water::{Construction, Drainage, PoreSource, WaterCondition};

use crate::check::Band;
use crate::region::Region;

/// A problem in plane strain (D = 2) or in space (D = 3), and how it is solved.
#[derive(Clone, Debug)]
pub struct Case<const D: usize = 2> {
    /// Title for reports and figures.
    pub title: String,
    /// Whom and what it is for.
    pub title_block: TitleBlock,
    /// Acceleration of gravity \[m/s²\], positive; it acts downwards.
    pub gravity: f64,
    /// Background grid.
    pub grid: GridSpec<D>,
    /// Variant of the method.
    pub method: Method,
    /// Unit weight of water \[N/m³\].
    pub water_unit_weight: f64,
    /// Conditions of the water; stages name them by index. The first holds from the start; without any all is dry.
    pub water: Vec<WaterCondition>,
    /// Materials; bodies name them by index.
    pub materials: Vec<Material>,
    /// Bodies.
    pub bodies: Vec<BodyPart<D>>,
    /// Supports.
    pub boundaries: Boundaries<D>,
    /// Loads; stages name them by index.
    pub loads: Vec<Load<D>>,
    /// Rigid bodies; stages name them by index.
    pub rigid: Vec<RigidPart<D>>,
    /// Reinforcement; stages name it by index.
    pub reinforcement: Vec<ReinforcementPart>,
    /// What happens, in order.
    pub stages: Vec<Stage>,
    /// Newton, step cutting, linear solver.
    pub solver: SolverSettings,
    /// Points whose history is recorded in every step.
    pub monitors: Vec<Monitor<D>>,
    /// Lines along which results are written at the end of every stage.
    pub sections: Vec<Section<D>>,
    /// One recorded quantity against another.
    pub curves: Vec<Curve>,
    /// Results that are held against outside values.
    pub checks: Vec<CaseCheck>,
    /// On how many meshes the case is computed, for the error of the mesh.
    pub mesh_study: MeshStudy,
    /// What is written, and where.
    pub output: Output,
}

impl<const D: usize> Case<D> {
    /// The same problem on a grid whose cells are cut into `n` in each direction.
    ///
    /// Places, lengths and steps stay. What a file states by the cell (particles, small cuts, the stride
    /// of a run-out) goes by the small cells.
    #[must_use]
    pub fn refined(&self, n: usize) -> Self {
        Self {
            grid: self.grid.refined(n),
            ..self.clone()
        }
    }
}

/// A case in the dimension that its file states.
#[derive(Clone, Debug)]
pub enum AnyCase {
    /// In plane strain.
    Plane(Case<2>),
    /// In space.
    Space(Case<3>),
}

/// Does the same with a case of any dimension: `in_any_dimension!(any, case => what(case))`.
#[macro_export]
macro_rules! in_any_dimension {
    ($any:expr, $case:ident => $what:expr) => {
        match $any {
            $crate::case::AnyCase::Plane($case) => $what,
            $crate::case::AnyCase::Space($case) => $what,
        }
    };
}

impl AnyCase {
    /// Title.
    pub fn title(&self) -> &str {
        in_any_dimension!(self, case => &case.title)
    }

    /// What happens, in order.
    pub fn stages(&self) -> &[Stage] {
        in_any_dimension!(self, case => &case.stages)
    }

    /// Materials.
    pub fn materials(&self) -> &[Material] {
        in_any_dimension!(self, case => &case.materials)
    }

    /// Curves.
    pub fn curves(&self) -> &[Curve] {
        in_any_dimension!(self, case => &case.curves)
    }

    /// Checks.
    pub fn checks(&self) -> &[CaseCheck] {
        in_any_dimension!(self, case => &case.checks)
    }

    /// On how many meshes it is computed.
    pub fn mesh_study(&self) -> MeshStudy {
        in_any_dimension!(self, case => case.mesh_study)
    }

    /// What is written, and where.
    pub fn output(&self) -> &Output {
        in_any_dimension!(self, case => &case.output)
    }

    /// What is written, and where, to be changed.
    pub fn output_mut(&mut self) -> &mut Output {
        in_any_dimension!(self, case => &mut case.output)
    }
}

/// What stands in the head of a report beside its title. Nothing that is computed depends on it.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct TitleBlock {
    /// Project.
    pub project: Option<String>,
    /// Client.
    pub client: Option<String>,
    /// Author.
    pub author: Option<String>,
    /// Revision.
    pub revision: Option<String>,
}

/// A study of the mesh error: the case on its grid and on finer ones ([`mesh_study`]).
///
/// [`mesh_study`]: mod@crate::mesh_study
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshStudy {
    /// Meshes, that of the case among them; 1: no study.
    pub meshes: usize,
}

impl Default for MeshStudy {
    fn default() -> Self {
        Self { meshes: 1 }
    }
}

/// A material. Where a property varies, its constant is the greatest value in the soil.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name.
    pub name: String,
    /// Unit weight γ \[N/m³\].
    pub unit_weight: f64,
    /// Young's modulus \[Pa\].
    pub young: f64,
    /// Poisson's ratio \[-\].
    pub poisson: f64,
    /// Strength.
    pub strength: Strength,
    /// Coefficient of earth pressure at rest K₀ \[-\], if the material states one.
    pub k0: Option<f64>,
    /// What varies from place to place.
    pub profiles: Profiles,
    /// Unit weight below the water table \[N/m³\]; none: that above.
    pub saturated: Option<f64>,
    /// What it does with water.
    pub drainage: Drainage,
}

/// The strength of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Strength {
    /// No limit.
    Elastic,
    /// von Mises with undrained strength c_u in plane strain \[Pa\].
    VonMises {
        /// c_u \[Pa\].
        undrained_strength: f64,
    },
    /// Tresca.
    Tresca {
        /// c_u \[Pa\].
        undrained_strength: f64,
    },
    /// Mohr–Coulomb.
    MohrCoulomb {
        /// c \[Pa\].
        cohesion: f64,
        /// φ \[rad\].
        friction_angle: f64,
        /// ψ \[rad\].
        dilation_angle: f64,
        /// Largest tensile stress \[Pa\]; none: the apex of the cone.
        tension_cutoff: Option<f64>,
    },
}

impl Material {
    /// The constitutive law; where strength, friction or stiffness vary, that of the greatest, of which particles have multiples.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`].
    pub fn law(&self) -> Result<SharedLaw, MaterialError> {
        let elasticity = Elasticity::new(self.young, self.poisson)?;
        Ok(match self.strength {
            Strength::Elastic => Arc::new(HenckyElastic::new(elasticity)),
            Strength::VonMises { undrained_strength } => Arc::new(
                VonMises::from_undrained_strength(elasticity, undrained_strength)?,
            ),
            Strength::Tresca { undrained_strength } => {
                Arc::new(Tresca::new(elasticity, undrained_strength)?)
            }
            Strength::MohrCoulomb {
                cohesion,
                friction_angle,
                dilation_angle,
                tension_cutoff,
            } => {
                let law = MohrCoulomb::new(elasticity, cohesion, friction_angle, dilation_angle)?;
                match tension_cutoff {
                    Some(limit) => Arc::new(law.with_tension_cutoff(limit)?),
                    None => Arc::new(law),
                }
            }
        })
    }
}

/// A region of one material, filled with particles.
#[derive(Clone, Debug)]
pub struct BodyPart<const D: usize = 2> {
    /// Name.
    pub name: String,
    /// Index of the material.
    pub material: usize,
    /// Particles per cell in each direction.
    pub per_direction: usize,
    /// What it fills.
    pub region: Arc<dyn Region<D>>,
    /// Whether it is there from the start, rather than from the stage that places it.
    pub from_start: bool,
}

impl BodyPart {
    /// Corners of its polygon in order, either way round \[m\].
    pub fn polygon(&self) -> &[[f64; 2]] {
        self.region.polygon()
    }
}

/// What a side of the grid does to the soil that reaches it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// Nothing.
    #[default]
    Free,
    /// Holds the displacement across the side.
    Roller,
    /// Holds all displacements.
    Fixed,
}

/// Supports: the sides of the grid, and boxes of fixed nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundaries<const D: usize = 2> {
    /// By axis: the side of its lowest and of its highest coordinate.
    pub sides: [[Side; 2]; D],
    /// Boxes of nodes.
    pub boxes: Vec<FixedBox<D>>,
}

impl<const D: usize> Default for Boundaries<D> {
    fn default() -> Self {
        Self {
            sides: [[Side::Free; 2]; D],
            boxes: Vec::new(),
        }
    }
}

/// Nodes in a box (edges included) that are held.
#[derive(Clone, Debug, PartialEq)]
pub struct FixedBox<const D: usize = 2> {
    /// Name.
    pub name: String,
    /// Corner of the lowest coordinates \[m\].
    pub lower: [f64; D],
    /// Corner of the highest coordinates \[m\].
    pub upper: [f64; D],
    /// Which components are held.
    pub fix: [bool; D],
}

/// A load that stages apply.
#[derive(Clone, Debug, PartialEq)]
pub struct Load<const D: usize = 2> {
    /// Name.
    pub name: String,
    /// Kind.
    pub kind: LoadKind<D>,
}

/// Kinds of loads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LoadKind<const D: usize = 2> {
    /// A level rigid footing on the surface, pushed down by displacement stages; in plane strain only. The grid
    /// follows.
    RigidFooting {
        /// Left end of the base \[m\].
        from: [f64; 2],
        /// Right end of the base, at the same level \[m\].
        to: [f64; 2],
        /// Whether the soil sticks to base and shaft.
        rough: bool,
        /// Factor on the reported reaction, 2 for half a footing \[-\].
        reaction_factor: f64,
    },
    /// A dead pressure on a segment of the surface, or in space on a rectangle, raised by load stages.
    Pressure {
        /// One end, or corner \[m\].
        from: [f64; D],
        /// The other end, or the corner across \[m\].
        to: [f64; D],
        /// Traction at factor 1 \[Pa\], its components.
        traction: [f64; D],
    },
    /// A dead force at a point, raised by load stages.
    Point {
        /// Where \[m\].
        at: [f64; D],
        /// Force at factor 1 \[N/m\], in space \[N\].
        force: [f64; D],
    },
}

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
    /// Searches for the factor of safety. The body is left as it was found.
    StrengthReduction(StrengthReduction),
    /// Lets the slope of reduced strength move until it rests.
    RunOut(RunOut),
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

/// By how much strength is reduced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reduction {
    /// A multiple of the factor of safety found before (middle of its interval).
    TimesFos(f64),
    /// A factor.
    Factor(f64),
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

/// Newton's method, step cutting and the linear solver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolverSettings {
    /// Accepted out-of-balance force over external force and reactions \[-\].
    pub tolerance: f64,
    /// Most corrections per step.
    pub max_iterations: usize,
    /// How often a step is cut in succession.
    pub cuts: u32,
    /// Factor on a cut step \[-\].
    pub cut_factor: f64,
    /// Linear solver.
    pub linear: SolverKind,
}

impl Default for SolverSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-9,
            max_iterations: 25,
            cuts: 5,
            cut_factor: 0.5,
            linear: SolverKind::Auto,
        }
    }
}

/// A particle that is watched: the one nearest to a point in the undeformed bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Monitor<const D: usize = 2> {
    /// Name.
    pub name: String,
    /// Point \[m\].
    pub point: [f64; D],
    /// What is recorded.
    pub record: Vec<Field>,
}

/// A line along which fields are read at the end of every stage.
#[derive(Clone, Debug, PartialEq)]
pub struct Section<const D: usize = 2> {
    /// Name.
    pub name: String,
    /// One end \[m\].
    pub from: [f64; D],
    /// Other end \[m\].
    pub to: [f64; D],
    /// Number of equally spaced places.
    pub points: usize,
    /// What is read.
    pub record: Vec<Field>,
    /// Of which particles.
    pub average: Average,
    /// What the values are held against.
    pub references: Vec<SectionReference>,
}

impl<const D: usize> Section<D> {
    /// What the values at the end of a stage are held against.
    pub fn references_at(&self, case: &Case<D>, stage: usize) -> Vec<&SectionReference> {
        let read = |stage: &Stage| !matches!(stage.kind, StageKind::StrengthReduction(_));
        let last = case.stages.iter().rposition(read);
        let wanted = |reference: &&SectionReference| reference.stage.or(last) == Some(stage);
        self.references.iter().filter(wanted).collect()
    }
}

/// Of which particles a section reads its values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Average {
    /// The particle nearest to each place.
    #[default]
    None,
    /// All particles of each cell that the line goes through, by volume.
    Cell,
}

/// A reference for a field along a section.
#[derive(Clone, Debug, PartialEq)]
pub struct SectionReference {
    /// The field.
    pub of: Field,
    /// The stage at whose end it is read; none: the last that is read along sections.
    pub stage: Option<usize>,
    /// Values over the distance along the section \[m\], in SI units.
    pub reference: Reference,
}

/// A field on particles, as it is printed: stress compression positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Field {
    /// Length of the displacement \[m\].
    Displacement,
    /// Displacement in x \[m\].
    DisplacementX,
    /// Displacement in y \[m\].
    DisplacementY,
    /// Displacement in z \[m\]; in space.
    DisplacementZ,
    /// Position x \[m\].
    X,
    /// Position y \[m\].
    Y,
    /// Position z \[m\]; in space.
    Z,
    /// −σ_xx of total stress \[Pa\].
    SigmaXx,
    /// −σ_yy of total stress \[Pa\].
    SigmaYy,
    /// −σ_zz of total stress \[Pa\].
    SigmaZz,
    /// −τ_xy \[Pa\].
    TauXy,
    /// −τ_yz \[Pa\]; in space.
    TauYz,
    /// −τ_xz \[Pa\]; in space.
    TauXz,
    /// Mean pressure p = −tr σ/3 of total stress \[Pa\].
    P,
    /// −σ′_xx of effective stress: the stress that the law speaks of \[Pa\].
    SigmaEffXx,
    /// −σ′_yy of effective stress \[Pa\].
    SigmaEffYy,
    /// −σ′_zz of effective stress \[Pa\].
    SigmaEffZz,
    /// Mean effective pressure p′ = −tr σ′/3 \[Pa\].
    PEff,
    /// Pore pressure u, given and excess \[Pa\].
    U,
    /// Excess pore pressure that undrained soil made itself \[Pa\].
    UExcess,
    /// Deviatoric stress q = √(3/2)‖s‖ \[Pa\].
    Q,
    /// Accumulated plastic strain invariant \[-\].
    PlasticStrain,
    /// Share of the strength that is mobilised \[-\].
    Utilisation,
    /// Undrained strength or cohesion \[Pa\]; none of soil without a strength limit.
    Strength,
    /// Angle of friction \[rad\]; none of soil without a strength limit.
    Friction,
    /// Young's modulus \[Pa\].
    Young,
}

/// A number that every step has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Quantity {
    /// Settlement of a rigid footing \[m\].
    Settlement(usize),
    /// Resistance of a rigid footing times its reaction factor, compression positive \[N/m\].
    Reaction(usize),
    /// A number of a rigid body.
    Rigid(usize, RigidQuantity),
    /// A number of a member of reinforcement.
    Reinforcement(usize, ReinforcementQuantity),
    /// Factor on a load \[-\].
    LoadFactor(usize),
    /// A field at a monitor.
    Monitor(usize, Field),
    /// Largest particle displacement \[m\].
    LargestDisplacement,
    /// Multiple of gravity \[-\].
    GravityFactor,
    /// Pseudo-static force to the right over the weight \[-\].
    HorizontalFactor,
    /// Strength reduction factor \[-\].
    ReductionFactor,
    /// Number of the step in its stage.
    Step,
    /// Share of particles that yield \[-\].
    PlasticShare,
    /// Middle of the interval of the factor of safety; known at the end of its stage \[-\].
    FactorOfSafety,
    /// Height of the highest particle's upper edge \[m\].
    Top,
}

/// One recorded quantity against another, one point per accepted step.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Name, also of its file.
    pub name: String,
    /// Abscissa.
    pub x: CurveAxis,
    /// Ordinate.
    pub y: CurveAxis,
    /// The stage that is recorded; none: all.
    pub stage: Option<usize>,
    /// What it is held against.
    pub reference: Option<Reference>,
}

/// A quantity as plotted.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveAxis {
    /// The quantity.
    pub of: Quantity,
    /// It is divided by this \[SI units\].
    pub divide_by: f64,
    /// Label with unit, as in `d / B [-]`.
    pub label: String,
}

/// A reference for a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Label, with the source.
    pub label: String,
    /// Values.
    pub values: ReferenceValues,
    /// Accepted relative deviation; none: drawn only \[-\].
    pub tolerance: Option<f64>,
}

/// Values of a reference, in the units of the plot.
#[derive(Clone, Debug, PartialEq)]
pub enum ReferenceValues {
    /// The ordinate at the end of the curve, or at an abscissa.
    Level {
        /// Ordinate.
        y: f64,
        /// Abscissa at which the curve is read; none: its end.
        at: Option<f64>,
    },
    /// Points; the curve is held against each that it spans.
    Points(Vec<[f64; 2]>),
}

/// A result held against an outside value.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseCheck {
    /// Name.
    pub name: String,
    /// What is measured.
    pub of: Quantity,
    /// It is divided by this \[SI units\].
    pub divide_by: f64,
    /// The stage; none: the last.
    pub stage: Option<usize>,
    /// When in the stage.
    pub at: CheckTime,
    /// Which value is held against it.
    pub value: CheckValue,
    /// Outside value \[SI units after division\].
    pub expected: f64,
    /// What is accepted.
    pub band: Band,
    /// Where the value comes from.
    pub source: String,
}

/// When in its stage a check looks at its quantity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CheckTime {
    /// At the end.
    #[default]
    End,
    /// When it was largest.
    Peak,
}

/// Which value a check looks at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CheckValue {
    /// That of the mesh; of the finest in a study of the mesh error.
    #[default]
    Computed,
    /// The one extrapolated from the meshes of a study; without a study that of the mesh.
    Extrapolated,
}

/// What is written, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Results folder.
    pub folder: PathBuf,
    /// When particles are written for ParaView.
    pub paraview: Every,
    /// Fields drawn at the end of every stage.
    pub figures: Vec<Field>,
    /// Planes in which they are drawn as well, in space; none: upright ones through the middle of the bodies.
    pub cuts: Vec<Cut>,
    /// Whether `report.html` is written.
    pub report: bool,
    /// Steps between checkpoints; 0: only at the end of stages.
    pub checkpoint_every: usize,
    /// Checkpoints kept within a stage.
    pub checkpoint_keep: usize,
}

/// A plane across an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// 0, 1 or 2.
    pub axis: usize,
    /// Where it stands \[m\].
    pub at: f64,
}

/// How often.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Every {
    /// Never.
    Never,
    /// At the end of every stage.
    Stage,
    /// Every so many steps, and at the end of every stage.
    Steps(usize),
}
