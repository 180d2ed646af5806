//! Quantities that are measured in a test and printed of it: names, headers, units and values.

use igimp_schema::quantity::{Dimension, Quantity};
use igimp_solver::element::{ElementState, StandardTest};

use super::Drive;

/// A quantity of a test, with the sign that it is printed with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Strain xx \[-\], compression positive.
    StrainXx,
    /// Strain yy \[-\], compression positive.
    StrainYy,
    /// Strain zz \[-\], compression positive.
    StrainZz,
    /// Shear strain of x by y \[-\].
    StrainXy,
    /// Volumetric strain \[-\], compression positive.
    Volume,
    /// Deviatoric strain \[-\].
    Deviatoric,
    /// Effective stress xx \[Pa\], compression positive.
    SigmaXx,
    /// Effective stress yy \[Pa\], compression positive.
    SigmaYy,
    /// Effective stress zz \[Pa\], compression positive.
    SigmaZz,
    /// Shear stress \[Pa\].
    TauXy,
    /// Mean effective pressure p \[Pa\], compression positive.
    P,
    /// q \[Pa\].
    Q,
    /// Pore pressure that an undrained test makes \[Pa\].
    PorePressure,
}

impl Measure {
    /// All of them, in the order of the table.
    pub const ALL: [Self; 13] = [
        Self::StrainXx,
        Self::StrainYy,
        Self::StrainZz,
        Self::StrainXy,
        Self::Volume,
        Self::Deviatoric,
        Self::SigmaXx,
        Self::SigmaYy,
        Self::SigmaZz,
        Self::TauXy,
        Self::P,
        Self::Q,
        Self::PorePressure,
    ];

    /// Those that a test has: all but the pore pressure, which is one of undrained tests.
    pub(super) fn of_test(drive: &Drive) -> impl Iterator<Item = Self> {
        let is_undrained = undrained(drive).is_some();
        (Self::ALL.into_iter())
            .filter(move |measure| is_undrained || *measure != Self::PorePressure)
    }

    /// The name in data: the header of the table without words on its sign, and without unit.
    pub fn name(self) -> &'static str {
        match self {
            Self::StrainXx => "strain_xx",
            Self::StrainYy => "strain_yy",
            Self::StrainZz => "strain_zz",
            Self::StrainXy => "strain_xy",
            Self::Volume => "volumetric strain",
            Self::Deviatoric => "deviatoric strain",
            Self::SigmaXx => "sigma_xx",
            Self::SigmaYy => "sigma_yy",
            Self::SigmaZz => "sigma_zz",
            Self::TauXy => "tau_xy",
            Self::P => "p",
            Self::Q => "q",
            Self::PorePressure => "pore pressure",
        }
    }

    /// The quantity of a name.
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|measure| measure.name() == name)
    }

    /// The value of a text such as `2 kPa` in SI, if it is one of its kind.
    pub fn value(self, text: &str) -> Option<f64> {
        let (number, unit) = igimp_schema::quantity::split(text.trim())?;
        Some(number * factor(self.is_stress(), unit)?)
    }

    /// Header of the table, and label of axes.
    pub(super) fn header(self) -> &'static str {
        match self {
            Self::StrainXx => "strain_xx, compression positive [%]",
            Self::StrainYy => "strain_yy, compression positive [%]",
            Self::StrainZz => "strain_zz, compression positive [%]",
            Self::StrainXy => "shear strain_xy [%]",
            Self::Volume => "volumetric strain, compression positive [%]",
            Self::Deviatoric => "deviatoric strain [%]",
            Self::SigmaXx => "sigma_xx effective, compression positive [kPa]",
            Self::SigmaYy => "sigma_yy effective, compression positive [kPa]",
            Self::SigmaZz => "sigma_zz effective, compression positive [kPa]",
            Self::TauXy => "tau_xy [kPa]",
            Self::P => "p effective, compression positive [kPa]",
            Self::Q => "q [kPa]",
            Self::PorePressure => "pore pressure [kPa]",
        }
    }

    /// Whether it is a stress; else it is a strain.
    pub(super) fn is_stress(self) -> bool {
        matches!(
            self,
            Self::SigmaXx
                | Self::SigmaYy
                | Self::SigmaZz
                | Self::TauXy
                | Self::P
                | Self::Q
                | Self::PorePressure
        )
    }

    /// A value as it is printed: in percent or kPa.
    pub(crate) fn printed(self, value: f64) -> f64 {
        if self.is_stress() {
            value / 1e3
        } else {
            100.0 * value
        }
    }

    /// The unit of printed values.
    pub(crate) fn unit(self) -> &'static str {
        if self.is_stress() { "kPa" } else { "%" }
    }

    /// Its value of a state, given the first one, in SI.
    pub(super) fn of(self, state: &ElementState, first: &ElementState, drive: &Drive) -> f64 {
        let [x, y, z, shear] = state.strain;
        let s = &state.sigma;
        match self {
            Self::StrainXx => 0.0 - x,
            Self::StrainYy => 0.0 - y,
            Self::StrainZz => 0.0 - z,
            Self::StrainXy => shear,
            Self::Volume => state.volumetric_strain(),
            Self::Deviatoric => deviatoric_strain(state),
            Self::SigmaXx => 0.0 - s[0][0],
            Self::SigmaYy => 0.0 - s[1][1],
            Self::SigmaZz => 0.0 - s[2][2],
            Self::TauXy => s[0][1],
            Self::P => state.p(),
            Self::Q => state.q(),
            Self::PorePressure => {
                undrained(drive).map_or(f64::NAN, |test| pore_pressure(state, first, test))
            }
        }
    }
}

/// The factor from a unit in a header to strain or pascal, if it is one of its kind.
pub(super) fn factor(is_stress: bool, unit: &str) -> Option<f64> {
    match (is_stress, unit.trim()) {
        (false, "%") => Some(0.01),
        (false, "-") => Some(1.0),
        (false, _) => None,
        (true, unit) => Quantity::parse_as(&format!("1 {unit}"), Dimension::Stress).ok(),
    }
}

/// The test of a drive, if it is an undrained one.
pub(super) fn undrained(drive: &Drive) -> Option<StandardTest> {
    match drive {
        Drive::Standard(test, _) if test.is_undrained() => Some(*test),
        _ => None,
    }
}

/// √(2/3 e:e) of the strain, with half of ∂u_x/∂Y as its shear \[-\].
fn deviatoric_strain(state: &ElementState) -> f64 {
    let [x, y, z, shear] = state.strain;
    let mean = (x + y + z) / 3.0;
    let normal: f64 = [x, y, z].map(|strain| (strain - mean).powi(2)).iter().sum();
    (2.0 / 3.0 * (normal + 0.5 * shear * shear)).sqrt()
}

/// Pore pressure that an undrained test makes, with total stress kept at the sides, or on top of a test in shear \[Pa\].
fn pore_pressure(state: &ElementState, first: &ElementState, test: StandardTest) -> f64 {
    let kept = usize::from(test.is_shear());
    state.sigma[kept][kept] - first.sigma[kept][kept]
}
