//! Isotropic Hencky elasticity: Kirchhoff stress linear in the logarithmic strain (theory, eq. 19).

use crate::MaterialError;
use crate::error::{positive, required};
use crate::spectral::principal::{Principal, deviator, mean};

/// Isotropic linear relation between elastic Hencky strain and Kirchhoff stress,
///
/// ```math
/// \tau_a = \bigl(K - \tfrac23 G\bigr)(\varepsilon_1 + \varepsilon_2 + \varepsilon_3)
///        + 2G\,\varepsilon_a
/// ```
///
/// With small strains read Cauchy stress and linear strain. The stored energy is quadratic in
/// the logarithmic strain; see Hencky (1928) and de Souza Neto, Perić & Owen (2008), chapter 13.
///
/// ```
/// use igimp_material::Elasticity;
///
/// let elasticity = Elasticity::new(100.0, 0.25)?;
/// let tau = elasticity.stress(&[0.01, 0.0, 0.0]);
/// assert!((tau[0] - 1.2).abs() < 1e-14 && (tau[1] - 0.4).abs() < 1e-14);
/// assert!((elasticity.strain(&tau)[0] - 0.01).abs() < 1e-16);
/// # Ok::<(), igimp_material::MaterialError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elasticity {
    young: f64,
    poisson: f64,
    bulk: f64,
    shear: f64,
}

impl Elasticity {
    /// From Young's modulus E \[stress\] and Poisson's ratio ν.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] unless `young` is positive and `-1 < poisson < 0.5`.
    pub fn new(young: f64, poisson: f64) -> Result<Self, MaterialError> {
        positive("young", young)?;
        let in_range = -1.0 < poisson && poisson < 0.5;
        required(
            "poisson",
            poisson,
            in_range,
            "greater than -1 and less than 0.5",
        )?;
        Ok(Self {
            young,
            poisson,
            bulk: young / (3.0 * (1.0 - 2.0 * poisson)),
            shear: young / (2.0 * (1.0 + poisson)),
        })
    }

    /// The same Poisson's ratio with Young's modulus times `ratio` \[-\].
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] unless the product is positive and finite.
    pub fn scaled(&self, ratio: f64) -> Result<Self, MaterialError> {
        Self::new(self.young * ratio, self.poisson)
    }

    /// Young's modulus E \[stress\].
    pub fn young(&self) -> f64 {
        self.young
    }

    /// Poisson's ratio ν \[-\].
    pub fn poisson(&self) -> f64 {
        self.poisson
    }

    /// Bulk modulus K = E / (3 (1 − 2ν)) \[stress\].
    pub fn bulk(&self) -> f64 {
        self.bulk
    }

    /// Shear modulus G = E / (2 (1 + ν)) \[stress\].
    pub fn shear(&self) -> f64 {
        self.shear
    }

    /// D, the derivative of principal stress by principal strain \[stress\], 3×3 and symmetric.
    pub fn tangent(&self) -> [[f64; 3]; 3] {
        self.moduli().tangent()
    }

    /// Principal stress τ \[stress\] of the principal elastic strain `eps_e`.
    #[inline]
    pub fn stress(&self, eps_e: &Principal) -> Principal {
        self.moduli().stress(eps_e)
    }

    /// Principal elastic strain C⁻¹ τ of the principal stress `tau`.
    #[inline]
    pub fn strain(&self, tau: &Principal) -> Principal {
        self.moduli().strain(tau)
    }

    /// K and G.
    #[inline]
    pub(crate) fn moduli(&self) -> Moduli {
        Moduli {
            bulk: self.bulk,
            shear: self.shear,
        }
    }
}

/// The two moduli of a linear elasticity \[stress\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moduli {
    /// K.
    pub(crate) bulk: f64,
    /// G.
    pub(crate) shear: f64,
}

impl Moduli {
    /// Lamé's first constant K − 2G/3: the stress aside of a unit strain \[stress\].
    #[inline]
    pub(crate) fn aside(&self) -> f64 {
        self.bulk - 2.0 / 3.0 * self.shear
    }

    pub(crate) fn tangent(&self) -> [[f64; 3]; 3] {
        let mut tangent = [[self.aside(); 3]; 3];
        for a in 0..3 {
            tangent[a][a] += 2.0 * self.shear;
        }
        tangent
    }

    #[inline]
    pub(crate) fn stress(&self, strain: &Principal) -> Principal {
        let common = self.aside() * (strain[0] + strain[1] + strain[2]);
        strain.map(|component| common + 2.0 * self.shear * component)
    }

    #[inline]
    pub(crate) fn strain(&self, stress: &Principal) -> Principal {
        let mean_strain = mean(stress) / (3.0 * self.bulk);
        deviator(stress).map(|component| mean_strain + component / (2.0 * self.shear))
    }
}
