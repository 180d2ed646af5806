//! von Mises, Tresca and Mohr–Coulomb whose strength softens or hardens with plastic strain (theory, eqs. 105 to 109).
//!
//! A step is implicit: strength is that at the end of it. With strength held, each law has an exact return; the plastic strain
//! at which the return makes just this strain is found by Newton's method in one unknown.

mod curve;
mod held;
pub(crate) mod rates;

use std::sync::Arc;

use crate::error::{positive, required};
use crate::law::trial_stress;
use crate::{
    ConstitutiveModel, Dissipation, Elasticity, History, InternalVariable, MaterialError,
    MohrCoulomb, Principal, ReturnMap, Scaling, ShearStrength, Tresca, VonMises,
};

pub use curve::{Curve, Decay};
use held::{Answer, Held, Kind};

/// The internal variable: the plastic strain κ that strength goes with.
const VARIABLES: [InternalVariable; 1] = [InternalVariable {
    name: "softening strain",
    unit: "-",
    scaling: Scaling::Strain,
}];

/// Least share of the elastic stiffness of the point that is left beside softening \[-\]: at zero its stress snaps back.
const LEAST_MARGIN: f64 = 0.01;

/// Halvings of the strain at which yield begins.
const FIRST_YIELD: usize = 30;

/// Most corrections of κ; a bisection to the last bit takes no more.
const MOST_CORRECTIONS: usize = 120;

/// The curves of soil with cohesion and friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionalCurves {
    /// Cohesion c \[stress\].
    pub cohesion: Curve,
    /// Friction angle φ \[rad\]; its tangent goes along the curve.
    pub friction_angle: Curve,
    /// Dilation angle ψ \[rad\]; its tangent goes along the curve, and nowhere above that of φ.
    pub dilation_angle: Curve,
}

/// A law whose strength goes with the accumulated plastic strain
/// $`\kappa = \sum\sqrt{\tfrac23\,\Delta e_p:\Delta e_p}`$ from initial to residual values.
///
/// ```
/// use igimp_material::{ConstitutiveModel, Curve, Decay, Elasticity, Softening};
///
/// let cu = Curve { initial: 2.0, residual: 0.5, strain: 0.1, decay: Decay::Linear };
/// let law = Softening::tresca(Elasticity::new(100.0, 0.3)?, cu)?;
/// let answer = law.return_map(&[0.2, 0.0, -0.2], &law.initial_history(&[0.0; 3]))?;
/// assert!((answer.tau[0] - answer.tau[2] - 2.0 * 0.5).abs() < 1e-12); // sheared far
/// # Ok::<(), igimp_material::MaterialError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Softening {
    elasticity: Elasticity,
    kind: Kind,
    /// The law with the greater of initial and residual strength, without a change.
    strongest: Arc<dyn ConstitutiveModel>,
    /// ψ/φ as given, before any change of strength \[-\].
    dilatancy: f64,
}

impl Softening {
    /// von Mises by the undrained strength c_u in plane strain \[stress\].
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] of strengths that are not positive, and of a curve along which stress snaps back.
    pub fn von_mises(elasticity: Elasticity, cu: Curve) -> Result<Self, MaterialError> {
        cu.check("undrained_strength")?;
        VonMises::from_undrained_strength(elasticity, cu.residual)?;
        let yield_stress = cu.map(|cu| 3.0_f64.sqrt() * cu);
        Self::build(elasticity, Kind::VonMises(yield_stress), 1.0)?.without_snap_back()
    }

    /// Tresca by the undrained strength c_u \[stress\].
    ///
    /// # Errors
    /// As [`von_mises`](Self::von_mises).
    pub fn tresca(elasticity: Elasticity, cu: Curve) -> Result<Self, MaterialError> {
        cu.check("undrained_strength")?;
        Tresca::new(elasticity, cu.residual)?;
        Self::build(elasticity, Kind::Tresca(cu), 1.0)?.without_snap_back()
    }

    /// Mohr–Coulomb, with a cut-off on tension \[stress\] that goes with the share of cohesion that is left.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] of what [`MohrCoulomb`] refuses, initial or residual, and of a curve along which
    /// stress snaps back.
    pub fn mohr_coulomb(
        elasticity: Elasticity,
        curves: FrictionalCurves,
        tension_cutoff: Option<f64>,
    ) -> Result<Self, MaterialError> {
        let FrictionalCurves {
            cohesion,
            friction_angle,
            dilation_angle,
        } = curves;
        cohesion.check("cohesion")?;
        friction_angle.check("friction_angle")?;
        dilation_angle.check("dilation_angle")?;
        let [friction, dilation] = [friction_angle.initial, dilation_angle.initial];
        MohrCoulomb::new(elasticity, cohesion.initial, friction, dilation)?;
        let most = dilation_angle.residual.min(friction_angle.residual);
        let residual =
            MohrCoulomb::new(elasticity, cohesion.residual, friction_angle.residual, most)?;
        if let Some(cutoff) = tension_cutoff {
            residual.with_tension_cutoff(cutoff)?;
        }
        let kind = Kind::MohrCoulomb {
            cohesion,
            friction: friction_angle.map(f64::tan),
            dilation: dilation_angle.map(f64::tan),
            tension_cutoff,
        };
        let dilatancy = if friction > 0.0 {
            dilation / friction
        } else {
            1.0
        };
        Self::build(elasticity, kind, dilatancy)?.without_snap_back()
    }

    fn build(elasticity: Elasticity, kind: Kind, dilatancy: f64) -> Result<Self, MaterialError> {
        let strongest: Arc<dyn ConstitutiveModel> = match kind {
            Kind::VonMises(curve) => {
                Arc::new(VonMises::from_yield_stress(elasticity, curve.greatest())?)
            }
            Kind::Tresca(curve) => Arc::new(Tresca::new(elasticity, curve.greatest())?),
            Kind::MohrCoulomb {
                cohesion, friction, ..
            } => {
                let (c, angle) = (cohesion.greatest(), friction.greatest().atan());
                Arc::new(MohrCoulomb::new(elasticity, c, angle, 0.0)?)
            }
        };
        Ok(Self {
            elasticity,
            kind,
            strongest,
            dilatancy,
        })
    }

    /// Refuses curves so steep that the stress of soil that was never sheared snaps back as it begins to yield, in shear and in
    /// triaxial paths.
    fn without_snap_back(self) -> Result<Self, MaterialError> {
        let held = self.kind.held(self.elasticity, 0.0)?;
        for path in [[1.0, 0.0, -1.0], [1.0, 1.0, -2.0], [2.0, -1.0, -1.0]] {
            let answer = self.at_first_yield(&held, path)?;
            if answer.by_kappa < 1.0 - LEAST_MARGIN {
                continue;
            }
            return Err(MaterialError::InvalidParameter {
                field: "softening strain",
                value: self.first_strain(),
                requirement: "larger: strength falls faster than elastic stress does, and stress snaps back within the point",
            });
        }
        Ok(self)
    }

    /// The answer to the strain along a path at which yield begins.
    fn at_first_yield(&self, held: &Held, path: Principal) -> Result<Answer, MaterialError> {
        let at = |size: f64| {
            let strain = path.map(|component| component * size);
            held.answer(&self.elasticity, &strain, &History::default())
        };
        let far = 10.0 * self.strongest.stress_scale(&[0.0; 3]) / self.elasticity.shear();
        let (mut within, mut beyond) = (0.0, far);
        for _ in 0..FIRST_YIELD {
            let middle = 0.5 * (within + beyond);
            if at(middle)?.map.regime.is_plastic() {
                beyond = middle;
            } else {
                within = middle;
            }
        }
        at(beyond)
    }

    /// The shortest strain of its curves that go anywhere.
    fn first_strain(&self) -> f64 {
        let strain = |curve: &Curve| {
            let goes = (curve.residual - curve.initial).abs() > 0.0;
            if goes { curve.strain } else { f64::INFINITY }
        };
        match &self.kind {
            Kind::VonMises(curve) | Kind::Tresca(curve) => strain(curve),
            Kind::MohrCoulomb {
                cohesion,
                friction,
                dilation,
                ..
            } => strain(cohesion).min(strain(friction)).min(strain(dilation)),
        }
    }

    fn held(&self, history: &History) -> Result<Held, MaterialError> {
        self.kind.held(self.elasticity, history.internal[0])
    }

    /// The plastic strain at the end of a step, with the answer there: the zero of
    /// $`g(\kappa) = \kappa_n + \Delta\kappa(\kappa) - \kappa`$ (theory, eq. 106), by Newton's method between bounds.
    fn settled(
        &self,
        trial: &Principal,
        history: &History,
        first: Answer,
    ) -> Result<(f64, Answer), MaterialError> {
        let begin = history.internal[0];
        let (mut low, mut high) = (begin, f64::INFINITY);
        let (mut kappa, mut answer) = (begin, first);
        let mut is_last = false;
        for correction in 1..=MOST_CORRECTIONS {
            let gap = begin + answer.strain - kappa;
            let margin = 1.0 - answer.by_kappa;
            let mut next = kappa + gap / margin.max(LEAST_MARGIN);
            let is_plastic = answer.map.regime.is_plastic();
            let is_closed = gap.abs() <= 4.0 * f64::EPSILON * (begin + answer.strain);
            if is_plastic && (is_closed || is_last || next.to_bits() == kappa.to_bits()) {
                return if margin < LEAST_MARGIN {
                    Err(MaterialError::SnapBack { law: self.name() })
                } else {
                    Ok((kappa, answer))
                };
            }
            if gap > 0.0 {
                low = kappa;
            } else {
                high = kappa;
            }
            // Newton's steps may come slowly from one side: every fourth halves what is left.
            if !(next > low && next < high) || (correction.is_multiple_of(4) && high.is_finite()) {
                next = 0.5 * (low + high);
            }
            if !(next > low && next < high) {
                // Neighbours among the numbers: the lower one is plastic.
                next = low;
                is_last = true;
            }
            kappa = next;
            let held = self.kind.held(self.elasticity, kappa)?;
            answer = held.answer(&self.elasticity, trial, history)?;
        }
        Err(MaterialError::NotConverged { law: self.name() })
    }

    /// The law with other curves, at a factor on strength.
    fn with(&self, kind: Kind) -> Result<Self, MaterialError> {
        Self::build(self.elasticity, kind, self.dilatancy)
    }
}

impl ConstitutiveModel for Softening {
    fn name(&self) -> &'static str {
        match self.kind {
            Kind::VonMises(_) => "softening von Mises",
            Kind::Tresca(_) => "softening Tresca",
            Kind::MohrCoulomb { .. } => "softening Mohr-Coulomb",
        }
    }

    fn stiffness_bound(&self) -> &Elasticity {
        &self.elasticity
    }

    fn internal_variables(&self) -> &'static [InternalVariable] {
        &VARIABLES
    }

    /// The tangent is that at held strength, and what the change of strength adds,
    /// $`\partial\tau/\partial\kappa \otimes \mathrm{d}\kappa/\mathrm{d}\varepsilon`$ (theory, eq. 108).
    fn return_map(
        &self,
        eps_e_trial: &Principal,
        history: &History,
    ) -> Result<ReturnMap, MaterialError> {
        trial_stress(&self.elasticity, eps_e_trial)?;
        let first = self
            .held(history)?
            .answer(&self.elasticity, eps_e_trial, history)?;
        if !first.map.regime.is_plastic() {
            return Ok(first.map);
        }
        let (kappa, answer) = self.settled(eps_e_trial, history, first)?;
        let mut map = answer.map;
        let margin = 1.0 - answer.by_kappa;
        for (row, rate) in map.tangent.iter_mut().zip(answer.stress_rate) {
            for (entry, along) in row.iter_mut().zip(answer.by_trial) {
                *entry += rate * along / margin;
            }
        }
        map.history.internal[0] = kappa;
        Ok(map)
    }

    /// That of the law at the strength that is left.
    fn yield_function(&self, tau: &Principal, history: &History) -> f64 {
        match self.held(history) {
            Ok(Held::Cylinder(law, _)) => law.yield_function(tau, history),
            Ok(Held::Pyramid(pyramid, _)) => pyramid.yield_function(tau),
            Err(_) => f64::NAN,
        }
    }

    /// That of the law with the greater of initial and residual strength.
    fn stress_scale(&self, tau: &Principal) -> f64 {
        self.strongest.stress_scale(tau)
    }

    /// That of the law at the strength that is left.
    fn utilisation(&self, tau: &Principal, history: &History) -> f64 {
        match self.held(history) {
            Ok(Held::Cylinder(law, _)) => law.utilisation(tau, history),
            Ok(Held::Pyramid(pyramid, _)) => pyramid.utilisation(tau),
            Err(_) => f64::NAN,
        }
    }

    /// The greater of initial and residual strength.
    fn shear_strength(&self) -> Option<ShearStrength> {
        self.strongest.shear_strength()
    }

    /// That of the greater of initial and residual strength: no less than the law dissipates.
    fn dissipation(&self, rate: &Principal) -> Option<Dissipation> {
        self.strongest.dissipation(rate)
    }

    /// That of von Mises is; along the edges of planes it is not, with associated flow either.
    fn has_symmetric_tangent(&self) -> bool {
        matches!(self.kind, Kind::VonMises(_))
    }

    /// Initial ψ/φ as given; 1 without friction.
    fn dilatancy(&self) -> f64 {
        self.dilatancy
    }

    /// tan φ times the ratio all along its curve; c, ψ and the cut-off stay, and ψ never exceeds φ.
    fn at_friction(&self, ratio: f64) -> Result<Option<Arc<dyn ConstitutiveModel>>, MaterialError> {
        let is_ratio = ratio >= 0.0;
        required("friction ratio", ratio, is_ratio, "finite and not negative")?;
        let mut kind = self.kind;
        let Kind::MohrCoulomb { friction, .. } = &mut kind else {
            return Ok(None);
        };
        *friction = friction.map(|tangent| tangent * ratio);
        Ok(Some(Arc::new(self.with(kind)?)))
    }

    /// Divides the curves of c, c_u, tan φ and the cut-off by `srf`, all along; ψ stays but never exceeds φ, and plastic strains
    /// stay.
    fn reduced(&self, srf: f64) -> Result<Arc<dyn ConstitutiveModel>, MaterialError> {
        positive("srf", srf)?;
        let weaker = |curve: Curve| curve.map(|value| value / srf);
        let kind = match self.kind {
            Kind::VonMises(curve) => Kind::VonMises(weaker(curve)),
            Kind::Tresca(curve) => Kind::Tresca(weaker(curve)),
            Kind::MohrCoulomb {
                cohesion,
                friction,
                dilation,
                tension_cutoff,
            } => Kind::MohrCoulomb {
                cohesion: weaker(cohesion),
                friction: weaker(friction),
                dilation,
                tension_cutoff: tension_cutoff.map(|cutoff| cutoff / srf),
            },
        };
        Ok(Arc::new(self.with(kind)?.without_snap_back()?))
    }
}
