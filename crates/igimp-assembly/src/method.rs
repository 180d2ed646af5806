//! The switches of the method: basis, locking control, geometry, kinematics, domain update, small cuts.

use std::f64::consts::TAU;
use std::sync::Arc;

use igimp_material::AxesLookedAt;
use igimp_shape::{Basis, Gimp, Linear};

/// Remedies against locking: which gradients the strain of a particle is made of (theory,
/// "locking").
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Locking {
    /// Nothing: every particle has the dilatation and the distortion of its own place.
    None,
    /// The paper's B-bar: the dilatation is that of the cells (theory, eq. 9). Cures nearly incompressible
    /// elasticity and plastic flow that keeps volume.
    BBar,
    /// Dilatation and most of the distortion are those of the soil of a cell, for particles whose law
    /// yields (theory, eqs. 8a to 8c). Cures plastic flow that changes volume too.
    SharedStrain,
}

/// The geometry that the steps of a march are computed on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Geometry {
    /// Every step begins where the last one carried the particles (the default).
    #[default]
    Moving,
    /// Positions, domains, F and supports stay as they are; strain adds up as small strain (theory,
    /// eq. 11b). Displacements are recorded and enter no equation.
    Given,
}

/// The body that a plane body is a section of; in space it says nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Section {
    /// A body without end, of which a slice of unit thickness is computed (the default).
    #[default]
    PlaneStrain,
    /// A body of revolution about x = 0 (theory, eqs. 130 to 130e): x is the radius, volumes, masses and forces are those of the
    /// whole circle.
    Axisymmetric,
}

impl Section {
    /// Whether strain goes around an axis.
    pub fn is_axisymmetric(self) -> bool {
        self == Self::Axisymmetric
    }

    /// The principal axes whose direction strength may go by: around an axis soil is strained as in the plane.
    pub fn axes_looked_at<const D: usize>(self) -> AxesLookedAt {
        match self {
            Self::PlaneStrain => AxesLookedAt::of_dimension::<D>(),
            Self::Axisymmetric => AxesLookedAt::with_hoop::<D>(),
        }
    }

    /// The thickness of the body at a radius, $`2πr`$ or the unit \[length\].
    pub fn thickness(self, radius: f64) -> f64 {
        match self {
            Self::PlaneStrain => 1.0,
            Self::Axisymmetric => TAU * radius,
        }
    }
}

/// How strain is measured over a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kinematics {
    /// Hencky strain from b_e, Kirchhoff stress, exact under rotation (theory, eq. 12–18).
    FiniteStrain,
    /// The small-strain B̄ matrix over a step; stress is rotated when the step is committed (theory,
    /// eqs. 9 to 11 and 11a).
    SmallStrain,
}

/// How a particle's domain follows the deformation gradient F = R U (theory, eq. 29).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DomainUpdate {
    /// The half-lengths stay as seeded.
    Fixed,
    /// `l_d = F_dd l_d0`.
    DiagonalF,
    /// `l_d = U_dd l_d0`: free of rotation (the default).
    DiagonalU,
    /// `l_d = (det F)^(1/D) l_d0`.
    RootJ,
    /// `l_d² = Σ_j (F_dj l_j0)²`: the second moments of the deformed domain along the axes.
    Moments,
    /// Those half-lengths, all of them times the factor that gives the box the volume of the deformed domain (theory, eq. 29a).
    ScaledMoments,
}

/// Treatment of nodes that a body only touches at a corner (theory, "small cuts").
///
/// A node is a small cut when Σ S V is below a fraction of its cell's volume, or of that of full soil there. Left alone, these
/// nodes make the system singular to working precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmallCuts {
    /// Fraction of a volume below which a node is a small cut \[-\]; 0 switches off. The default is 1e-4, which serves in
    /// the plane; in space take 1e-3, as case files do (theory, eq. 26).
    pub below: f64,
    /// The volume that it is a fraction of.
    pub of: CutVolume,
    /// The remedy for a small cut.
    pub remedy: Remedy,
    /// Ghost penalty γ on faces of boundary cells \[-\]; 0 switches it off.
    pub ghost_penalty: f64,
}

/// The volume that the volume of a node is held against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CutVolume {
    /// The mean of the cells around it (the default): on a side of the grid full soil leaves half of that, at a corner in space an
    /// eighth.
    Cell,
    /// The volume of full soil there. Large fractions ask for it, as those of motion are.
    FullSoil,
}

/// The remedy for a node that is a small cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// It moves with the nearest node that carries enough soil: a rigid translation causes no
    /// strain, whatever its size (the default).
    Tie,
    /// Its displacement goes on linearly from the nearest cell whose nodes carry enough soil, so that rotation causes no strain
    /// either; without such a cell within two cells it is tied.
    Extrapolate,
    /// Its displacement is zero. In stiff soil that moves far in a step, the sliver of soil
    /// beyond resists.
    Drop,
}

impl Default for SmallCuts {
    fn default() -> Self {
        Self {
            below: 1e-4,
            of: CutVolume::Cell,
            remedy: Remedy::Tie,
            ghost_penalty: 0.0,
        }
    }
}

/// The method: which of the paper's variants is computed, and how.
#[derive(Clone, Debug)]
pub struct Method {
    /// Grid basis as a particle sees it: [`Linear`] is the plain material point method (iMPM),
    /// [`Gimp`] the generalised interpolation one (iGIMP).
    pub basis: Arc<dyn Basis>,
    /// Remedy against locking.
    pub locking: Locking,
    /// The body that a plane body is a section of.
    pub section: Section,
    /// The geometry that steps are computed on.
    pub geometry: Geometry,
    /// Strain measure.
    pub kinematics: Kinematics,
    /// Update of the particle domains.
    pub domain_update: DomainUpdate,
    /// Treatment of small cuts.
    pub small_cuts: SmallCuts,
}

impl Method {
    fn with(basis: Arc<dyn Basis>, locking: Locking) -> Self {
        Self {
            basis,
            locking,
            section: Section::PlaneStrain,
            geometry: Geometry::Moving,
            kinematics: Kinematics::FiniteStrain,
            domain_update: DomainUpdate::DiagonalU,
            small_cuts: SmallCuts::default(),
        }
    }

    /// Plain implicit material point method.
    pub fn impm() -> Self {
        Self::with(Arc::new(Linear), Locking::None)
    }

    /// Implicit material point method with B-bar.
    pub fn impm_bbar() -> Self {
        Self::with(Arc::new(Linear), Locking::BBar)
    }

    /// Implicit generalised interpolation material point method.
    pub fn igimp() -> Self {
        Self::with(Arc::new(Gimp), Locking::None)
    }

    /// Implicit generalised interpolation material point method with B-bar (the default).
    pub fn igimp_bbar() -> Self {
        Self::with(Arc::new(Gimp), Locking::BBar)
    }

    /// iGIMP with the strain shared within cells, for soil that dilates.
    pub fn shared_strain() -> Self {
        Self::with(Arc::new(Gimp), Locking::SharedStrain)
    }

    /// Whether domains are those of soil that flows, as in run-outs and motion: contact closes softly then (theory, eq. 46).
    pub fn flows(&self) -> bool {
        self.domain_update == DomainUpdate::Moments
    }

    /// The variant's name as the paper writes it, such as `iGIMP + B-bar`; of a body of revolution that it is one.
    pub fn label(&self) -> String {
        let basis = if self.is_of_points() { "iMPM" } else { "iGIMP" };
        let section = match self.section {
            Section::PlaneStrain => "",
            Section::Axisymmetric => ", axisymmetric",
        };
        match self.locking {
            Locking::None => format!("{basis}{section}"),
            Locking::BBar => format!("{basis} + B-bar{section}"),
            Locking::SharedStrain => format!("{basis} + shared strain{section}"),
        }
    }

    /// Whether soil is concentrated in the middles of particles.
    pub(crate) fn is_of_points(&self) -> bool {
        self.basis.name() == "linear"
    }

    /// How strain is measured over a step of this geometry: increments on a given one are small.
    pub(crate) fn kinematics_of_step(&self) -> Kinematics {
        match self.geometry {
            Geometry::Moving => self.kinematics,
            Geometry::Given => Kinematics::SmallStrain,
        }
    }
}

impl Default for Method {
    fn default() -> Self {
        Self::igimp_bbar()
    }
}
