//! A problem as data: the content of a case file, with names resolved and numbers in SI units.
//!
//! Lengths are in m, stresses in Pa, unit weights in N/m³, angles in rad, forces in N/m (plane
//! strain, per metre run). The second axis points up; gravity acts along its negative direction.

mod axes;
pub mod check;
mod grid;
mod ground;
mod load;
mod material;
pub mod meshes;
mod motion;
mod plane;
mod record;
mod reinforcement;
mod rigid;
mod stage;
mod water;

use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

use igimp_assembly::Method;
use igimp_linear::{LinearSolver, SolverKind};
use serde::{Deserialize, Serialize};

pub use axes::{front, in_space};
pub use grid::{AxisSpec, GridSpec, MixedCells, fitted, lines};
pub use ground::{Ground, Layer};
pub use igimp_schema::field::Field;
pub use load::{Load, LoadKind, Plan};
pub use material::point_laws::{PointError, laws_at_points};
pub use material::profile::{LEAST_STRENGTH, Profile, Profiles, StressShare, Variation};
pub use material::raster::Raster;
pub use material::softening::{BAND_CELLS, Softens, StrengthCurves};
pub use material::strength::{Flow, Parameter, ParameterValue, Strength, critical_ratio_of, jaky};
pub use material::{GivenLaw, Material};
pub use motion::calm::Calm;
pub use motion::ground_motion::{Base, GroundMotion, Piece};
pub use plane::in_plane;
pub use record::{
    Average, CaseCheck, CheckTime, CheckValue, Curve, CurveAxis, Monitor, Quantity, Reference,
    ReferenceValues, Section, SectionReference,
};
pub use reinforcement::{ReinforcementKind, ReinforcementPart, ReinforcementQuantity, distance};
pub use rigid::space::RigidSolid;
pub use rigid::{
    Adhesion, COMPONENTS, RigidDrive, RigidForm, RigidInterface, RigidMove, RigidPart,
    RigidQuantity, RigidShape, RigidShear, components, overlap_of_rigid,
};
pub use stage::driven::Driven;
pub use stage::{
    Consolidation, Dynamic, Reduction, ReductionPath, RunOut, SearchMethod, Stage, StageKind,
    StageWalls, StopWhen, StrengthReduction, search_of,
};
pub use water::seepage::{InTime, SeepageCase};
pub use water::{Construction, Drainage, Drained, PoreSource, WaterCondition, table_level};

use igimp_geometry::region::Region;
use igimp_text::MemoryLimit;

/// A problem in plane strain (D = 2) or in space (D = 3), and how it is solved.
#[derive(Clone, Debug)]
pub struct Case<const D: usize> {
    /// Title for reports and figures.
    pub title: String,
    /// Project, client, author and revision.
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
    pub reinforcement: Vec<ReinforcementPart<D>>,
    /// The stages, in order.
    pub stages: Vec<Stage>,
    /// Newton, step cutting, linear solver.
    pub solver: SolverSettings,
    /// A linear solver that takes the place of the one that `solver` names; case files know none.
    pub given_solver: Option<GivenSolver>,
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
    /// The output settings.
    pub output: Output,
}

/// The laws of a run are numbered through the materials in their order: first those of the constants, then one for each material for every
/// set of parameters that vary, and for every change that cells with several soils ask for.
impl<const D: usize> Case<D> {
    /// The number of the material that a law belongs to.
    pub fn number_of_material(&self, law: usize) -> usize {
        law % self.materials.len()
    }

    /// The material that a law belongs to.
    pub fn material_of(&self, law: usize) -> &Material {
        &self.materials[self.number_of_material(law)]
    }

    /// The law of another material at the same place, with the same change.
    pub fn law_beside(&self, law: usize, material: usize) -> usize {
        law - self.number_of_material(law) + material
    }
}

impl<const D: usize> Case<D> {
    /// Whether forces and volumes are those of the whole body, and not per metre run.
    pub fn is_whole(&self) -> bool {
        D == 3 || self.method.section.is_axisymmetric()
    }

    /// Behind units of forces and volumes: `/m` where they are per metre run.
    pub fn per_metre(&self) -> &'static str {
        if self.is_whole() { "" } else { "/m" }
    }

    /// The same problem on a grid whose cells are cut into `n` in each direction.
    ///
    /// Places, lengths and steps stay. Numbers that a file states by the cell (particles, small cuts, the stride
    /// of a run-out) goes by the small cells.
    #[must_use]
    pub fn refined(&self, n: usize) -> Self {
        Self {
            grid: self.grid.refined(n),
            ..self.clone()
        }
    }

    /// Whether a stage moves soil in time, with inertia: only then is there velocity.
    pub fn has_motion(&self) -> bool {
        let moves = |stage: &Stage| matches!(stage.kind, StageKind::Dynamic(_));
        self.stages.iter().any(moves)
    }

    /// Whether a stage of it takes time, to move or for water to flow.
    pub fn takes_time(&self) -> bool {
        self.stages.iter().any(Stage::takes_time)
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

/// Does the same with a case of any dimension: `in_any_dimension!(any, case => run(case))`.
#[macro_export]
macro_rules! in_any_dimension {
    ($any:expr, $case:ident => $body:expr) => {
        match $any {
            $crate::AnyCase::Plane($case) => $body,
            $crate::AnyCase::Space($case) => $body,
        }
    };
}

impl AnyCase {
    /// Title.
    pub fn title(&self) -> &str {
        in_any_dimension!(self, case => &case.title)
    }

    /// The stages, in order.
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

    /// The output settings.
    pub fn output(&self) -> &Output {
        in_any_dimension!(self, case => &case.output)
    }

    /// Gives a linear solver, or none, in place of the one that the file names.
    pub fn give_solver(&mut self, given: Option<&GivenSolver>) {
        in_any_dimension!(self, case => case.given_solver = given.cloned());
    }

    /// The output settings, to be changed.
    pub fn output_mut(&mut self) -> &mut Output {
        in_any_dimension!(self, case => &mut case.output)
    }
}

/// The head of a report beside its title. Nothing that is computed depends on it.
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

/// A study of the mesh error: the case on its grid and on finer ones ([`meshes`]).
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

/// A region of one material, filled with particles.
#[derive(Clone, Debug)]
pub struct BodyPart<const D: usize> {
    /// Name.
    pub name: String,
    /// Index of the material.
    pub material: usize,
    /// Particles per cell in each direction.
    pub per_direction: usize,
    /// The region that it fills.
    pub region: Arc<dyn Region<D>>,
    /// Whether it is there from the start, rather than from the stage that places it.
    pub from_start: bool,
}

impl BodyPart<2> {
    /// Corners of its polygon in order, either way round \[m\].
    pub fn polygon(&self) -> &[[f64; 2]] {
        self.region.polygon()
    }
}

/// The support of a side of the grid.
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
pub struct Boundaries<const D: usize> {
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
pub struct FixedBox<const D: usize> {
    /// Name.
    pub name: String,
    /// Corner of the lowest coordinates \[m\].
    pub lower: [f64; D],
    /// Corner of the highest coordinates \[m\].
    pub upper: [f64; D],
    /// Which components are held.
    pub fix: [bool; D],
}

/// A linear solver of a program's own: a run makes one wherever it needs one. Its solutions are checked as all are, so that
/// a run that was stopped may go on with any other.
#[derive(Clone)]
pub struct GivenSolver {
    /// Name.
    pub name: &'static str,
    /// Makes one.
    pub make: Arc<MakeSolver>,
}

/// Makes a solver for the systems of a case.
pub type MakeSolver = dyn Fn(&OfCase<'_>) -> Box<dyn LinearSolver> + Send + Sync;

/// The parts of a case that a given solver may go by.
#[derive(Clone, Debug)]
pub struct OfCase<'a> {
    /// The method that the file asks for.
    pub settings: &'a SolverSettings,
    /// Memory allowed for factors on this computer \[bytes\].
    pub factor_bytes: usize,
    /// Coordinates of the lines of the grid along each axis \[m\], by the places of nodes in a pattern.
    pub lines: Vec<Vec<f64>>,
}

impl fmt::Debug for GivenSolver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
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
    /// Memory for its factors; none: that of the environment, or else a share of the computer's.
    pub memory: Option<MemoryLimit>,
}

impl Default for SolverSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-9,
            max_iterations: 25,
            cuts: 5,
            cut_factor: 0.5,
            linear: SolverKind::Auto,
            memory: None,
        }
    }
}

/// The output settings.
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

impl Cut {
    /// The prefix of the names of its pictures and tables: `cut-y-3`.
    pub fn name(&self) -> String {
        let place = format!("{:.3}", self.at);
        let place = place.trim_end_matches('0').trim_end_matches('.');
        format!("cut-{}-{place}", ["x", "y", "z"][self.axis])
    }
}

/// How often.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Every {
    /// Never.
    Never,
    /// At the end of every stage.
    Stage,
    /// Some tens of times in every stage, and at its end.
    Film,
    /// Every so many steps, and at the end of every stage.
    Steps(usize),
}
