//! Interfaces: shear and tension of the sides of a rigid body.

use igimp_material::Ratios;

/// An interface between a rigid body and soil.
#[derive(Clone, Debug, PartialEq)]
pub struct Interface {
    /// Its shear along the surface.
    pub shear: Shear,
    /// Its tension when soil is pulled off.
    pub tension: Tension,
}

impl Interface {
    /// No shear, no tension.
    pub fn smooth() -> Self {
        Self {
            shear: Shear::Smooth,
            tension: Tension::None,
        }
    }

    /// Soil that touches sticks, and leaves freely.
    pub fn rough() -> Self {
        Self {
            shear: Shear::Rough,
            tension: Tension::None,
        }
    }

    /// Friction with coefficient μ \[-\], no tension.
    pub fn friction(coefficient: f64) -> Self {
        Self {
            shear: Shear::Limited {
                adhesion: Vec::new(),
                varies: false,
                friction: coefficient,
            },
            tension: Tension::None,
        }
    }

    /// The same that soil cannot leave.
    #[must_use]
    pub fn bonded(self) -> Self {
        Self {
            tension: Tension::Bonded,
            ..self
        }
    }

    /// Adhesion where soil of a law touches, at the ratios of that soil to its law \[stress\].
    pub fn adhesion(&self, law: usize, ratios: Ratios) -> f64 {
        let Shear::Limited {
            adhesion, varies, ..
        } = &self.shear
        else {
            return 0.0;
        };
        let adhesion = adhesion.get(law).copied().unwrap_or(0.0);
        if *varies {
            adhesion * ratios.strength
        } else {
            adhesion
        }
    }

    /// Whether its tangent is symmetric: friction that slips follows the pressure and is followed by
    /// nothing.
    pub fn is_symmetric(&self) -> bool {
        !matches!(self.shear, Shear::Limited { friction, .. } if friction > 0.0)
    }
}

/// The shear of an interface along the surface.
#[derive(Clone, Debug, PartialEq)]
pub enum Shear {
    /// Nothing.
    Smooth,
    /// Whatever the soil can, while it touches.
    Rough,
    /// Adhesion a while the soil touches, and friction: |τ| ≤ a + μ p.
    Limited {
        /// Adhesion by law of the soil that touches \[stress\]; none for laws beyond the list.
        adhesion: Vec<f64>,
        /// Whether adhesion is a share of the strength of the soil, and varies with it from particle to particle.
        varies: bool,
        /// Coefficient of friction μ \[-\].
        friction: f64,
    },
}

/// The tension of an interface when soil is pulled off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tension {
    /// Nothing: it lets go.
    None,
    /// Anything: soil that touched never leaves.
    Bonded,
    /// So much \[stress\]; where it is reached the bond is broken for good.
    Limit(f64),
}

/// Stiffness of contact (theory, eq. 46).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penalty {
    /// Normal stiffness per area in units of E/h \[-\].
    pub stiffness: f64,
    /// Penetration over which contact closes, in cells \[-\].
    pub smoothing: f64,
    /// Tangential stiffness over normal stiffness \[-\]. 0.5 by default, a choice between G/E of soil, 1/3 to 1/2, and the normal one:
    /// it says how far soil creeps before it slips, not what the side carries.
    pub tangential: f64,
}

/// Penetration over which contact closes softly, in cells \[-\]: corrections converge where soil that flows comes and goes, and settlements
/// of some thousandths of a cell feel it.
const SOFT: f64 = 2e-2;

impl Penalty {
    /// The same, with contact that closes softly.
    #[must_use]
    pub fn softly(self) -> Self {
        Self {
            smoothing: self.smoothing.max(SOFT),
            ..self
        }
    }
}

impl Default for Penalty {
    fn default() -> Self {
        Self {
            stiffness: 10.0,
            smoothing: 1e-6,
            tangential: 0.5,
        }
    }
}
