//! The strength of a law by a formula, where there is one.

use igimp_material::{CamClayParameters, Cone, ShearStiffness};
use igimp_model::{Flow, Material, Strength};
use igimp_solver::element::{ElementState, Kinematics, StandardTest};

use super::Request;

/// A strength, and where it is from.
#[derive(Clone, Debug)]
pub(super) struct ClosedForm {
    /// \[Pa\].
    pub(super) value: f64,
    pub(super) from: &'static str,
}

/// q, or τ_xy of tests in shear, at failure.
///
/// Laws speak of Kirchhoff stress: a stress in them is less by J in terms of the area that soil has then.
pub(super) fn strength(
    material: &Material,
    test: StandardTest,
    request: &Request,
    end: &ElementState,
) -> Option<ClosedForm> {
    let volume = match request.kinematics {
        Kinematics::Finite => (-end.volumetric_strain()).exp(),
        Kinematics::Small => 1.0,
    };
    if material.given.is_some() {
        // What the file says of strength is not what is driven.
        return None;
    }
    let effects = material.softening.unwrap_or_default();
    if effects.goes_with_strain() {
        // What it ends on depends on how far it was sheared, and how fast.
        return None;
    }
    let (value, from) = match test {
        StandardTest::TriaxialDrained => {
            triaxial_drained(material.strength, request.stress[1], volume)
        }
        StandardTest::TriaxialUndrained => {
            triaxial_undrained(material.strength, request.stress, volume)
        }
        StandardTest::SimpleShearDrained | StandardTest::SimpleShearUndrained => {
            let share = (effects.directions).map_or(1.0, |directions| directions.simple_shear);
            simple_shear(material.strength, share, volume)
        }
        StandardTest::Oedometer
        | StandardTest::PlaneStrainDrained
        | StandardTest::PlaneStrainUndrained => None,
    }?;
    Some(ClosedForm { value, from })
}

/// q of undrained strength, which is that of compression along the axis.
fn undrained_compression(strength: Strength, volume: f64) -> Option<(f64, &'static str)> {
    match strength {
        Strength::Tresca { undrained_strength } => {
            Some((2.0 * undrained_strength / volume, "2 c_u"))
        }
        Strength::VonMises { undrained_strength } => {
            Some((3.0_f64.sqrt() * undrained_strength / volume, "√3 c_u"))
        }
        _ => None,
    }
}

/// q under a constant stress at the sides \[Pa\].
fn triaxial_drained(strength: Strength, side: f64, volume: f64) -> Option<(f64, &'static str)> {
    match strength {
        Strength::MohrCoulomb {
            cohesion,
            friction_angle,
            flow: Flow::Dilation,
            ..
        }
        | Strength::DruckerPrager {
            cohesion,
            friction_angle,
            cone: Cone::Compression,
            rate: None,
            ..
        } => Some((passive(side, cohesion / volume, friction_angle), PASSIVE)),
        Strength::HardeningSoil(soil) => Some((
            passive(side, soil.cohesion / volume, soil.friction_angle),
            PASSIVE,
        )),
        Strength::HoekBrown(rock) => {
            let (sci, side) = (rock.intact_strength, side * volume);
            let base = rock.ratio() * side / sci + rock.cohesive_share();
            let value = sci * base.powf(rock.exponent()) / volume;
            Some((value, "σ_ci (m_b σ_3/σ_ci + s)^a"))
        }
        Strength::ModifiedCamClay(clay) => Some((
            3.0 * clay.critical_ratio * side / (3.0 - clay.critical_ratio),
            "M p with p = 3 σ_3/(3 - M)",
        )),
        _ => undrained_compression(strength, volume),
    }
}

/// q at constant volume from a stress along the axis and at the sides \[Pa\].
fn triaxial_undrained(
    strength: Strength,
    stress: [f64; 2],
    volume: f64,
) -> Option<(f64, &'static str)> {
    match strength {
        Strength::MohrCoulomb {
            cohesion,
            friction_angle,
            dilation_angle: 0.0,
            flow: Flow::Dilation,
            ..
        }
        | Strength::DruckerPrager {
            cohesion,
            friction_angle,
            dilation_angle: 0.0,
            cone: Cone::Compression,
            rate: None,
        } => {
            let [axial, side] = stress;
            let (sin, cos) = friction_angle.sin_cos();
            let p = (axial + 2.0 * side) / 3.0;
            let value = 6.0 * (p * sin + cohesion * cos) / (3.0 - sin);
            Some((value, "constant p, ψ = 0"))
        }
        Strength::ModifiedCamClay(clay) => Some((
            clay.critical_ratio * undrained_pressure(&clay, stress),
            "M p at constant volume",
        )),
        _ => undrained_compression(strength, volume),
    }
}

/// τ_xy of undrained strength, of which simple shear has a share \[-\].
fn simple_shear(strength: Strength, share: f64, volume: f64) -> Option<(f64, &'static str)> {
    match strength {
        Strength::Tresca { undrained_strength } | Strength::VonMises { undrained_strength } => {
            Some((share * undrained_strength / volume, "c_u of simple shear"))
        }
        _ => None,
    }
}

/// The formula of [`passive`].
const PASSIVE: &str = "σ_3 (K_p - 1) + 2 c √K_p";

/// q at failure of soil with cohesion and friction between sides under a stress \[Pa\].
fn passive(side: f64, cohesion: f64, friction_angle: f64) -> f64 {
    let root = (0.25 * std::f64::consts::PI + 0.5 * friction_angle).tan();
    side * (root * root - 1.0) + 2.0 * cohesion * root
}

/// p at the critical state of soil that keeps its volume (theory, eq. 92) \[Pa\].
fn undrained_pressure(clay: &CamClayParameters, [axial, side]: [f64; 2]) -> f64 {
    let (p, q) = ((axial + 2.0 * side) / 3.0, (axial - side).abs());
    let (m, plastic) = (clay.critical_ratio, clay.compression - clay.swelling);
    let tip = clay.overconsolidation * p * (1.0 + (q / (m * p)).powi(2));
    let shear = match clay.shear {
        ShearStiffness::Constant(_) => 0.0,
        ShearStiffness::Poisson(poisson) => {
            let per_pressure = 1.5 * (1.0 - 2.0 * poisson) / (1.0 + poisson) / clay.swelling;
            (m * m - (q / p).powi(2)) / (6.0 * per_pressure)
        }
    };
    ((clay.swelling * p.ln() + shear + plastic * (0.5 * tip).ln()) / clay.compression).exp()
}
