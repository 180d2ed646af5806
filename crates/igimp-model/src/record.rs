//! Records and their references: monitors, sections, curves and checks.

use igimp_schema::field::Field;

use super::{Case, ReinforcementQuantity, RigidQuantity, Stage, StageKind};
use crate::check::{Band, PrintedUnit};

/// A material point that is watched: a point in the undeformed bodies. Fields there are interpolated from the particles around
/// it; the displacement that ends a stage or a search is that of the nearest particle.
#[derive(Clone, Debug, PartialEq)]
pub struct Monitor<const D: usize> {
    /// Name.
    pub name: String,
    /// Point \[m\].
    pub point: [f64; D],
    /// The recorded fields.
    pub record: Vec<Field>,
}

/// A line along which fields are read at the end of every stage.
#[derive(Clone, Debug, PartialEq)]
pub struct Section<const D: usize> {
    /// Name.
    pub name: String,
    /// One end \[m\].
    pub from: [f64; D],
    /// Other end \[m\].
    pub to: [f64; D],
    /// Number of equally spaced places.
    pub points: usize,
    /// The recorded fields.
    pub record: Vec<Field>,
    /// Of which particles.
    pub average: Average,
    /// The references of the values.
    pub references: Vec<SectionReference>,
}

impl<const D: usize> Section<D> {
    /// The references of the values at the end of a stage.
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
    /// Those around the place.
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
    /// Time since the first stage that takes some \[s\].
    Time,
    /// Water that leaves the ground in the flow of a condition of the water; or the flow through one of its sections towards
    /// the positive axis \[m²/s; m³/s in space\].
    Discharge(usize, Option<usize>),
    /// Kinetic energy, in stages that take time \[J/m; J in space\].
    KineticEnergy,
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
    /// Its reference.
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
    /// The measured quantity.
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
    /// The accepted band.
    pub band: Band,
    /// The unit in which the file states the band; none: plain numbers.
    pub unit: Option<PrintedUnit>,
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
