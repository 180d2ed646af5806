//! Elasticity whose stiffness grows with pressure, with a stored energy (theory, eq. 88).

use crate::MaterialError;
use crate::spectral::principal::{Principal, deviator, dot, largest, mean};

/// $`\sqrt{2/3}`$.
const SQRT_2_3: f64 = 0.816_496_580_927_726;

/// Volume and shear of a strain (ε_v, ε_s) or of a stress (p, q), compression positive, with the direction of the deviator.
#[derive(Clone, Copy, Debug)]
pub(super) struct Invariants {
    pub(super) volume: f64,
    pub(super) shear: f64,
    /// The deviator over its norm, extension positive; zero where there is none.
    pub(super) direction: Principal,
}

impl Invariants {
    /// ε_v = -tr ε and ε_s = √(2/3 e:e) \[-\].
    pub(super) fn of_strain(strain: &Principal) -> Self {
        let (norm, direction) = directed(strain);
        Self {
            volume: -(strain[0] + strain[1] + strain[2]),
            shear: SQRT_2_3 * norm,
            direction,
        }
    }

    /// p and q = √(3/2 s:s) \[stress\].
    pub(super) fn of_stress(tau: &Principal) -> Self {
        let (norm, direction) = directed(tau);
        Self {
            volume: -mean(tau),
            shear: norm / SQRT_2_3,
            direction,
        }
    }

    /// The strain of these invariants, extension positive.
    fn strain(volume: f64, shear: f64, direction: &Principal) -> Principal {
        direction.map(|n| shear / SQRT_2_3 * n - volume / 3.0)
    }
}

/// The norm of the deviator, and the deviator over it; nothing where it is round-off, whose direction would have a trace.
fn directed(values: &Principal) -> (f64, Principal) {
    let dev = deviator(values);
    let norm = dot(&dev, &dev).sqrt();
    if norm <= 4.0 * f64::EPSILON * largest(values) {
        return (0.0, [0.0; 3]);
    }
    (norm, deviator(&dev.map(|value| value / norm)))
}

/// The constants of the energy
/// $`W = p_r\,\kappa^* \exp\bigl(\varepsilon_v/\kappa^* + \tfrac{3g}{2\kappa^*}\varepsilon_s^2\bigr) + \tfrac32 G_0\,\varepsilon_s^2`$.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PressureElasticity {
    /// κ* \[-\].
    pub(super) swelling: f64,
    /// g = G/p \[-\].
    pub(super) per_pressure: f64,
    /// $`G_0`$ \[stress\].
    pub(super) constant: f64,
    /// $`p_r`$ \[stress\].
    pub(super) reference_pressure: f64,
    /// $`\ln p_r`$.
    pub(super) log_reference: f64,
}

/// Stress by its invariants, and its derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stress {
    pub(super) p: f64,
    pub(super) q: f64,
    /// ∂(p, q)/∂(ε_v, ε_s), symmetric \[stress\].
    pub(super) stiffness: [[f64; 2]; 2],
}

/// Stress in terms that neither grow nor vanish beyond the numbers, far from any surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Relative {
    /// ln p, p in the unit of stress.
    pub(super) log_p: f64,
    /// η = q/p \[-\].
    pub(super) eta: f64,
    /// G/p \[-\].
    pub(super) shear: f64,
    /// ∂ ln p/∂(ε_v, ε_s) \[-\].
    pub(super) log_p_by: [f64; 2],
    /// ∂η/∂(ε_v, ε_s) \[-\].
    pub(super) eta_by: [f64; 2],
}

impl Stress {
    /// The principal stress, tension positive, in the axes of a strain.
    pub(super) fn principal(&self, strain: &Invariants) -> Principal {
        strain.direction.map(|n| SQRT_2_3 * self.q * n - self.p)
    }
}

impl PressureElasticity {
    /// G at a pressure \[stress\].
    pub(super) fn shear(&self, p: f64) -> f64 {
        self.per_pressure * p + self.constant
    }

    /// p and q of an elastic strain.
    pub(super) fn stress(&self, volume: f64, shear: f64) -> Stress {
        let bend = 3.0 * self.per_pressure * shear;
        let p = self.reference_pressure * ((volume + 0.5 * bend * shear) / self.swelling).exp();
        let modulus = p / self.swelling;
        let across = bend * modulus;
        Stress {
            p,
            q: 3.0 * self.shear(p) * shear,
            stiffness: [
                [modulus, across],
                [across, 3.0 * self.shear(p) + bend * across],
            ],
        }
    }

    /// ln p and q/p of an elastic strain.
    pub(super) fn relative(&self, volume: f64, shear: f64) -> Relative {
        let bend = 3.0 * self.per_pressure * shear;
        let exponent = (volume + 0.5 * bend * shear) / self.swelling;
        let constant = if self.constant > 0.0 {
            self.constant / self.reference_pressure * (-exponent).exp()
        } else {
            0.0
        };
        let ratio = self.per_pressure + constant;
        let log_p_by = [1.0 / self.swelling, bend / self.swelling];
        Relative {
            log_p: self.log_reference + exponent,
            eta: 3.0 * shear * ratio,
            shear: ratio,
            log_p_by,
            eta_by: [
                -3.0 * shear * constant * log_p_by[0],
                3.0 * ratio - 3.0 * shear * constant * log_p_by[1],
            ],
        }
    }

    /// The elastic strain of a principal stress, in closed form.
    pub(super) fn strain(&self, tau: &Principal) -> Result<Principal, MaterialError> {
        let stress = Invariants::of_stress(tau);
        let p = stress.volume;
        if !(p > 0.0 && p.is_finite() && stress.shear.is_finite()) {
            return Err(MaterialError::InvalidParameter {
                field: "mean pressure",
                value: p,
                requirement: "positive: soil whose stiffness grows with pressure has none without it",
            });
        }
        let shear = stress.shear / (3.0 * self.shear(p));
        let volume = self.swelling * (p / self.reference_pressure).ln()
            - 1.5 * self.per_pressure * shear * shear;
        Ok(Invariants::strain(volume, shear, &stress.direction))
    }
}

/// The principal tangent of ∂(p, q)/∂(ε_v, ε_s) and of the stiffness `turning` of a turn of the deviator \[stress\].
pub(super) fn assembled(
    [[pv, ps], [qv, qs]]: &[[f64; 2]; 2],
    turning: f64,
    strain: &Invariants,
) -> [[f64; 3]; 3] {
    let n = &strain.direction;
    std::array::from_fn(|a| {
        std::array::from_fn(|b| {
            let unit = f64::from(u8::from(a == b)) - 1.0 / 3.0;
            pv - SQRT_2_3 * (ps * n[b] + qv * n[a])
                + 2.0 / 3.0 * qs * n[a] * n[b]
                + turning * (unit - n[a] * n[b])
        })
    })
}
