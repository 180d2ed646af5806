//! The tests of the laboratory as paths.

use super::{Control, ElementPath};

/// A test of the laboratory. Axial is y; sides are x and z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StandardTest {
    /// Axial strain under constant stress at the sides.
    TriaxialDrained,
    /// Axial strain at constant volume.
    TriaxialUndrained,
    /// Axial strain between stiff sides.
    Oedometer,
    /// Shear of x by y under constant axial stress between stiff sides.
    SimpleShearDrained,
    /// Shear of x by y at constant volume.
    SimpleShearUndrained,
    /// Axial strain under constant stress in x, no strain in z.
    PlaneStrainDrained,
    /// Axial strain at constant volume, no strain in z.
    PlaneStrainUndrained,
}

impl StandardTest {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::TriaxialDrained,
        Self::TriaxialUndrained,
        Self::Oedometer,
        Self::SimpleShearDrained,
        Self::SimpleShearUndrained,
        Self::PlaneStrainDrained,
        Self::PlaneStrainUndrained,
    ];

    /// Whether shear is driven, and no axial strain.
    pub fn is_shear(self) -> bool {
        matches!(self, Self::SimpleShearDrained | Self::SimpleShearUndrained)
    }

    /// Whether the volume is kept.
    pub fn is_undrained(self) -> bool {
        matches!(
            self,
            Self::TriaxialUndrained | Self::SimpleShearUndrained | Self::PlaneStrainUndrained
        )
    }

    /// The path up to an axial strain, natural and positive in compression, or to a shear strain \[-\].
    pub fn path(self, strain: f64) -> ElementPath {
        use Control::{AsXx, Strain, Stress};
        let (controls, end) = match self {
            Self::TriaxialDrained => (
                [Stress, Strain, AsXx, Strain],
                [f64::NAN, -strain, 0.0, 0.0],
            ),
            Self::TriaxialUndrained => (
                [Strain, Strain, AsXx, Strain],
                [0.5 * strain, -strain, 0.0, 0.0],
            ),
            Self::Oedometer => ([Strain; 4], [0.0, -strain, 0.0, 0.0]),
            Self::SimpleShearDrained => (
                [Strain, Stress, Strain, Strain],
                [0.0, f64::NAN, 0.0, strain],
            ),
            Self::SimpleShearUndrained => ([Strain; 4], [0.0, 0.0, 0.0, strain]),
            Self::PlaneStrainDrained => (
                [Stress, Strain, Strain, Strain],
                [f64::NAN, -strain, 0.0, 0.0],
            ),
            Self::PlaneStrainUndrained => ([Strain; 4], [strain, -strain, 0.0, 0.0]),
        };
        ElementPath {
            controls,
            legs: vec![end],
        }
    }
}
