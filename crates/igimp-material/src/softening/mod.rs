//! von Mises, Tresca and Mohr–Coulomb whose strength softens or hardens with plastic strain (theory, eqs. 105 to 109); that of von
//! Mises and Tresca also goes with the direction of stress and with the rate of strain (eqs. 120 to 125).
//!
//! A step is implicit: strength is that at the end of it. With strength held, each law has an exact return; the plastic strain
//! at which the return makes just this strain is found by Newton's method in one unknown.

mod curve;
mod held;
mod nonlocal;
pub(crate) mod rates;
mod undrained;

use std::sync::Arc;

use crate::error::{positive, required};
use crate::law::dilatancy;
use crate::spectral::principal::largest;
use crate::{
    ConstitutiveModel, Dissipation, Elasticity, History, InternalVariable, MaterialError,
    MohrCoulomb, Nonlocal, PointContext, Principal, Remembered, ReturnMap, Scaling, ShearStrength,
    Strength, Tensor, Tresca, VonMises,
};

pub use curve::{Curve, Decay};
use held::{Answer, Held, Kind, Strained};
pub use undrained::{Directions, RateEffect};
use undrained::{Moment, NO_DIRECTION, angle_of_compression};

/// The plastic strain κ that strength goes with, that of the soil: where strength and stiffness vary, curves are as stated.
const PLASTIC: InternalVariable = InternalVariable {
    name: "softening strain",
    unit: "-",
    scaling: Scaling::Constant,
    follows_stress: false,
};

/// The direction of stress.
const ANGLE: InternalVariable = InternalVariable {
    name: "angle of compression",
    unit: "rad",
    scaling: Scaling::Constant,
    follows_stress: false,
};

/// The plastic strain of the ground around.
const AROUND: InternalVariable = InternalVariable {
    name: "nonlocal strain",
    unit: "-",
    scaling: Scaling::Constant,
    follows_stress: false,
};

/// The internal variables of a law whose strength is that of a point, and of one that sees the ground around.
const VARIABLES: [InternalVariable; 2] = [PLASTIC, ANGLE];
const OF_GROUND_AROUND: [InternalVariable; 2] = [PLASTIC, AROUND];
const OF_ALL: [InternalVariable; 3] = [PLASTIC, ANGLE, AROUND];

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
/// use igimp_material::{ConstitutiveModel, Curve, Decay, Elasticity, PointContext, Softening};
///
/// let cu = Curve { initial: 2.0, residual: 0.5, strain: 0.1, decay: Decay::Linear };
/// let law = Softening::tresca(Elasticity::new(100.0, 0.3)?, cu)?;
/// let history = law.initial_history(&[0.0; 3]);
/// let answer = law.return_map(&[0.2, 0.0, -0.2], &history, &PointContext::STATIC)?;
/// assert!((answer.tau[0] - answer.tau[2] - 2.0 * 0.5).abs() < 1e-12); // sheared far
/// # Ok::<(), igimp_material::MaterialError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Softening {
    elasticity: Elasticity,
    kind: Kind,
    /// The law with the greater of initial and residual strength, without a change.
    strongest: Arc<dyn ConstitutiveModel>,
    /// r of eq. 8c as given, before any change of strength \[-\].
    dilatancy: f64,
    /// Strength by the direction of stress.
    directions: Option<Directions>,
    /// Strength by the rate of strain.
    rate: Option<RateEffect>,
    /// How strength sees plastic strain beside its own point.
    nonlocal: Option<Nonlocal>,
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
    /// [`MaterialError::InvalidParameter`] of a value that [`MohrCoulomb`] refuses, initial or residual, and of a curve along which
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
        Self::build(elasticity, kind, dilatancy(dilation, friction))?.without_snap_back()
    }

    /// The law with a strength that goes with the direction of stress: its curve is that of active loading. The direction is that at
    /// the start of a step, and an internal variable.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] of shares that are not positive, of soil with friction, and of a curve along which stress
    /// snaps back.
    pub fn with_directions(mut self, directions: Directions) -> Result<Self, MaterialError> {
        directions.check()?;
        self.without_friction()?;
        let greatest = |curve: Curve| curve.map(|cu| cu * directions.greatest());
        let strongest = Self::build(self.elasticity, self.kind.map(greatest), 1.0)?;
        self.strongest = strongest.strongest;
        self.directions = Some(directions);
        self.without_snap_back()
    }

    /// The law with a strength that grows with the rate of plastic shear strain in steps that take time.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] of numbers that are not positive, and of soil with friction.
    pub fn with_rate(mut self, rate: RateEffect) -> Result<Self, MaterialError> {
        rate.check()?;
        self.without_friction()?;
        self.rate = Some(rate);
        Ok(self)
    }

    fn without_friction(&self) -> Result<(), MaterialError> {
        let angle = self
            .strongest
            .shear_strength()
            .map_or(0.0, |strength| strength.friction_angle);
        let is_undrained = !matches!(self.kind, Kind::MohrCoulomb { .. });
        let requirement =
            "absent: strength goes with direction and rate in soil by undrained strength alone";
        required("friction_angle", angle, is_undrained, requirement)
    }

    /// Whether strength stays in a step.
    fn is_perfect(&self) -> bool {
        self.rate.is_none() && !self.softens()
    }

    /// Whether strength goes with plastic strain.
    fn softens(&self) -> bool {
        self.first_strain().is_finite()
    }

    /// Where the angle of compression stands among the internal variables, if the law has it.
    fn place_of_angle(&self) -> Option<usize> {
        self.directions.map(|_| usize::from(self.softens()))
    }

    /// The direction and rate that strength goes with, at a point and in a step.
    fn moment(&self, history: &History, context: &PointContext) -> Moment {
        let share = match (&self.directions, self.place_of_angle()) {
            (Some(directions), Some(place)) => directions.share(history.internal[place]),
            _ => 1.0,
        };
        Moment {
            share,
            rate: (self.rate).map(|rate| (rate, context.duration / context.strain_ratio)),
            step: 0.0,
            strain_ratio: context.strain_ratio,
        }
    }

    /// κ at which a law of a point would have the strength that is left.
    fn measure(&self, kappa: f64, history: &History) -> f64 {
        match (&self.nonlocal, self.place_of_nonlocal()) {
            (Some(nonlocal), Some(place)) => nonlocal.measure(kappa, history.internal[place]),
            _ => kappa,
        }
    }

    /// How much of its own plastic strain the strength of a point goes with \[-\]: below zero it hardens where the ground softens.
    fn local_share(&self) -> f64 {
        self.nonlocal.map_or(1.0, |nonlocal| nonlocal.local_share())
    }

    /// κ of a history.
    fn plastic_strain(&self, history: &History) -> f64 {
        if self.softens() {
            history.internal[0]
        } else {
            0.0
        }
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
            directions: None,
            rate: None,
            nonlocal: None,
        })
    }

    /// Refuses curves so steep that the stress of soil that was never sheared snaps back as it begins to yield, in shear and in
    /// triaxial paths.
    fn without_snap_back(self) -> Result<Self, MaterialError> {
        let moment = Moment {
            share: self.directions.map_or(1.0, |by| by.greatest()),
            ..Moment::AT_REST
        };
        let held = self.kind.held(self.elasticity, 0.0, &moment)?;
        for path in [[1.0, 0.0, -1.0], [1.0, 1.0, -2.0], [2.0, -1.0, -1.0]] {
            let answer = self.at_first_yield(&held, path)?;
            if self.margin(answer.by_kappa) > LEAST_MARGIN {
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

    /// The law at the strength that is left, at the reference rate.
    fn held(&self, history: &History) -> Result<Held, MaterialError> {
        let moment = self.moment(history, &PointContext::STATIC);
        let measure = self.measure(self.plastic_strain(history), history);
        self.kind.held(self.elasticity, measure, &moment)
    }

    /// The plastic strain at the end of a step, with the strength there: the zero of
    /// $`g(\kappa) = \kappa_n + \Delta\kappa(\kappa) - \kappa`$ (theory, eq. 106), by Newton's method between bounds.
    fn settled(
        &self,
        trial: (&Principal, &Principal),
        (history, mut moment): (&History, Moment),
        (mut held, mut strained): (Held, Strained),
    ) -> Result<(f64, Held), MaterialError> {
        let before = self.plastic_strain(history);
        // A rate goes with the step alone, which may be small beside that of earlier steps.
        let origin = if moment.rate.is_some() { before } else { 0.0 };
        let begin = before - origin;
        // It is a difference of strains, whose round-off is in it.
        let (noise, patience, threshold) = match &moment.rate {
            Some((rate, duration)) => {
                let noise = 4.0 * f64::EPSILON * largest(trial.0) / moment.strain_ratio;
                (noise, 16, rate.threshold(*duration))
            }
            None => (0.0, 4, f64::INFINITY),
        };
        let (mut low, mut high) = (begin, f64::INFINITY);
        let mut kappa = begin;
        let mut is_last = false;
        for correction in 1..=MOST_CORRECTIONS {
            let gap = begin + strained.strain - kappa;
            let margin = self.margin(strained.by_kappa);
            let mut next = kappa + gap / margin.max(LEAST_MARGIN);
            if correction == 1 && next > threshold {
                // From there, where strength begins to grow, Newton's method comes nearer and never past.
                next = threshold;
            }
            let is_closed = gap.abs() <= 4.0 * f64::EPSILON * (begin + strained.strain) + noise;
            if strained.is_plastic && (is_closed || is_last || next.to_bits() == kappa.to_bits()) {
                return if margin < LEAST_MARGIN {
                    Err(MaterialError::SnapBack { law: self.name() })
                } else {
                    Ok((origin + kappa, held))
                };
            }
            if gap > 0.0 {
                low = kappa;
            } else {
                high = kappa;
            }
            // Newton's steps may come slowly from one side: now and then one halves the rest.
            let halves = correction.is_multiple_of(patience) && high.is_finite();
            if !(next > low && next < high) || halves {
                next = 0.5 * (low + high);
            }
            if !(next > low && next < high) {
                // Neighbours among the numbers: the lower one is plastic.
                next = low;
                is_last = true;
            }
            kappa = next;
            moment.step = kappa - begin;
            let measure = self.measure(origin + kappa, history);
            held = (self.kind).held(self.elasticity, measure, &moment)?;
            strained = (held.strained(&self.elasticity, trial)?).of_soil(moment.strain_ratio);
        }
        Err(MaterialError::NotConverged { law: self.name() })
    }

    /// The law with other curves, at a factor on strength.
    fn with(&self, kind: Kind) -> Result<Self, MaterialError> {
        let mut law = Self::build(self.elasticity, kind, self.dilatancy)?;
        law.rate = self.rate;
        law.nonlocal = self.nonlocal;
        match self.directions {
            Some(directions) => law.with_directions(directions),
            None => Ok(law),
        }
    }
}

impl ConstitutiveModel for Softening {
    fn name(&self) -> &'static str {
        let effects = (
            self.softens(),
            self.directions.is_some(),
            self.rate.is_some(),
        );
        match (&self.kind, effects) {
            (Kind::MohrCoulomb { .. }, _) => "softening Mohr-Coulomb",
            (Kind::VonMises(_), (_, false, false)) => "softening von Mises",
            (Kind::Tresca(_), (_, false, false)) => "softening Tresca",
            (Kind::VonMises(_), (false, true, false)) => "anisotropic von Mises",
            (Kind::Tresca(_), (false, true, false)) => "anisotropic Tresca",
            (Kind::VonMises(_), (false, false, true)) => "rate-dependent von Mises",
            (Kind::Tresca(_), (false, false, true)) => "rate-dependent Tresca",
            (Kind::VonMises(_), _) => "von Mises of several effects",
            (Kind::Tresca(_), _) => "Tresca of several effects",
        }
    }

    fn stiffness_bound(&self) -> &Elasticity {
        &self.elasticity
    }

    fn internal_variables(&self) -> &'static [InternalVariable] {
        if self.nonlocal.is_some() {
            return match self.directions {
                Some(_) => &OF_ALL,
                None => &OF_GROUND_AROUND,
            };
        }
        let first = usize::from(!self.softens());
        let last = if self.directions.is_some() { 2 } else { 1 };
        &VARIABLES[first..last]
    }

    /// 45°, that of simple shear, where the stress has no direction yet.
    fn initial_history(&self, _sigma: &Principal) -> History {
        let mut history = History::default();
        if let Some(place) = self.place_of_angle() {
            history.internal[place] = NO_DIRECTION;
        }
        history
    }

    /// Soil whose law saw nothing around begins with its own plastic strain as that of the ground around: its strength stays.
    fn remembering(&self, begun: History, before: &Remembered<'_>) -> History {
        let mut history = begun.remembering(self.internal_variables(), before);
        if let (Some(place), None) = (self.place_of_nonlocal(), before.value_of(&AROUND)) {
            history.internal[place] = before.value_of(&PLASTIC).unwrap_or_default();
        }
        history
    }

    /// The angle between the vertical and the axis of the major compression; the last one where the stress has no direction.
    fn directed(
        &self,
        mut history: History,
        tau: &Principal,
        frame: &Tensor,
        (axes, vertical): (usize, usize),
    ) -> History {
        if let Some(place) = self.place_of_angle() {
            let scale = self.stress_scale(tau);
            if let Some(angle) = angle_of_compression(tau, frame, (axes, vertical), scale) {
                history.internal[place] = angle;
            }
        }
        history
    }

    /// The tangent is that at held strength, and that of the change of strength,
    /// $`\partial\tau/\partial\kappa \otimes \mathrm{d}\kappa/\mathrm{d}\varepsilon`$ (theory, eq. 108). Strength by the ground
    /// around is that of eq. 105 with $`\hat\kappa = m\bar\kappa + (1 - m)\kappa`$ (theory, eq. 110c); a step without duration is at
    /// the reference rate.
    fn return_map(
        &self,
        eps_e_trial: &Principal,
        history: &History,
        context: &PointContext,
    ) -> Result<ReturnMap, MaterialError> {
        let mut risen = *history;
        if let Some(place) = self.place_of_nonlocal() {
            risen.internal[place] += context.nonlocal_rise;
        }
        self.returned(eps_e_trial, &risen, context)
    }

    fn nonlocal(&self) -> Option<Nonlocal> {
        self.nonlocal
    }

    /// That of von Mises is, and that of Tresca with a strength that stays in a step; where strength goes with plastic strain, it is not
    /// along the edges of planes, with associated flow either.
    fn has_symmetric_tangent(&self) -> bool {
        match self.kind {
            Kind::VonMises(_) => true,
            Kind::Tresca(_) => self.is_perfect(),
            Kind::MohrCoulomb { .. } => false,
        }
    }

    /// r of eq. 8c of the initial angles as given.
    fn dilatancy(&self) -> f64 {
        self.dilatancy
    }
}

impl Strength for Softening {
    /// That of the law at the strength that is left.
    fn yield_function(&self, tau: &Principal, history: &History) -> f64 {
        match self.held(history) {
            Ok(Held::Cylinder(law, _)) => law.yield_function(tau, history),
            Ok(Held::Pyramid(changing)) => changing.strength.yield_function(tau),
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
            Ok(Held::Pyramid(changing)) => changing.strength.utilisation(tau),
            Err(_) => f64::NAN,
        }
    }

    /// The greater of initial and residual strength, of active loading and at the reference rate.
    fn shear_strength(&self) -> Option<ShearStrength> {
        let strength = self.strongest.shear_strength()?;
        Some(ShearStrength {
            cohesive: strength.cohesive / self.directions.map_or(1.0, |by| by.greatest()),
            ..strength
        })
    }

    /// That of its curves at the plastic strain of the history, in the direction of stress and at the reference rate.
    fn shear_strength_at(&self, history: &History) -> Option<ShearStrength> {
        let kappa = self.measure(self.plastic_strain(history), history);
        let share = self.moment(history, &PointContext::STATIC).share;
        let [cohesive, tangent] = match &self.kind {
            Kind::VonMises(curve) => [share * curve.at(kappa)[0] / 3.0_f64.sqrt(), 0.0],
            Kind::Tresca(curve) => [share * curve.at(kappa)[0], 0.0],
            Kind::MohrCoulomb {
                cohesion, friction, ..
            } => [cohesion.at(kappa)[0], friction.at(kappa)[0]],
        };
        Some(ShearStrength {
            cohesive,
            friction_angle: tangent.atan(),
        })
    }

    /// That of the greater of initial and residual strength, in the direction of the greatest: no less than the law dissipates at
    /// the reference rate.
    fn dissipation(&self, rate: &Principal) -> Option<Dissipation> {
        self.strongest.dissipation(rate)
    }

    /// tan φ times the ratio all along its curve; c, ψ and the cut-off stay, and ψ never exceeds φ.
    fn at_friction(&self, ratio: f64) -> Result<Option<Arc<dyn ConstitutiveModel>>, MaterialError> {
        let is_ratio = ratio >= 0.0;
        required("friction ratio", ratio, is_ratio, "finite and not negative")?;
        let mut kind = self.kind;
        let Kind::MohrCoulomb {
            cohesion, friction, ..
        } = &mut kind
        else {
            return Ok(None);
        };
        *friction = friction.map(|tangent| tangent * ratio);
        let (left, angle) = (cohesion.residual, friction.residual.atan());
        MohrCoulomb::new(self.elasticity, left, angle, 0.0)?;
        Ok(Some(Arc::new(self.with(kind)?)))
    }

    /// Divides the curves of c, c_u, tan φ and the cut-off by `srf`, all along and in every direction; ψ stays but never exceeds φ,
    /// and plastic strains and rates stay.
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
