//! Hoek–Brown plasticity, of 2002, with strength reduction by the envelope of shear strength (theory, eqs. 111 to 115).
//!
//! The surface is the envelope of the pyramids of Mohr–Coulomb that touch it. A return goes to the pyramid that touches where the
//! stress ends up, which is one equation in one unknown.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use crate::error::{positive, required};
use crate::law::{ON_SURFACE, mobilised, trial_stress};
use crate::pyramid::PlaneStrength;
use crate::softening::rates::Changing;
use crate::spectral::principal::{Principal, descending, largest, mean, sorted, unsorted};
use crate::{
    ConstitutiveModel, Elasticity, History, MaterialError, NonlocalRates, PointContext, Regime,
    ReturnMap, Strength,
};

/// Most corrections of a touching point.
const MOST_CORRECTIONS: usize = 200;

/// Least share of s at which a pyramid touches, of the base of the power, $`m_b\sigma_3/\sigma_{ci} + s`$ \[-\]: between it and the apex
/// all is the apex.
const LEAST_SHARE: f64 = 1e-9;

/// What the strength of a rock mass is made of (Hoek, Carranza-Torres and Corkum 2002).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoekBrownParameters {
    /// Uniaxial compressive strength of intact rock $`\sigma_{ci}`$ \[stress\].
    pub intact_strength: f64,
    /// Geological strength index GSI \[-\], above 0 and at most 100.
    pub gsi: f64,
    /// $`m_i`$ of intact rock \[-\].
    pub intact_ratio: f64,
    /// Factor of disturbance D \[-\], 0 to 1.
    pub disturbance: f64,
    /// Dilation angle ψ \[rad\], nowhere above the friction angle of the pyramid that touches.
    pub dilation_angle: f64,
}

impl HoekBrownParameters {
    /// $`m_b`$ \[-\].
    pub fn ratio(&self) -> f64 {
        self.intact_ratio * ((self.gsi - 100.0) / (28.0 - 14.0 * self.disturbance)).exp()
    }

    /// s \[-\].
    pub fn cohesive_share(&self) -> f64 {
        ((self.gsi - 100.0) / (9.0 - 3.0 * self.disturbance)).exp()
    }

    /// The exponent a \[-\].
    pub fn exponent(&self) -> f64 {
        0.5 + ((-self.gsi / 15.0).exp() - (-20.0_f64 / 3.0).exp()) / 6.0
    }

    fn check(&self) -> Result<(), MaterialError> {
        positive("intact_strength", self.intact_strength)?;
        positive("intact_ratio", self.intact_ratio)?;
        let is_index = self.gsi > 0.0 && self.gsi <= 100.0;
        required("gsi", self.gsi, is_index, "above 0 and at most 100")?;
        let is_share = (0.0..=1.0).contains(&self.disturbance);
        required("disturbance", self.disturbance, is_share, "from 0 to 1")?;
        let is_angle = (0.0..FRAC_PI_2).contains(&self.dilation_angle);
        required(
            "dilation_angle",
            self.dilation_angle,
            is_angle,
            "at least 0 and less than pi/2",
        )
    }
}

/// Elastic and perfectly plastic with the yield function, of compression positive,
///
/// ```math
/// f = \sigma_1 - \sigma_3 - \sigma_{ci} \Bigl( m_b \frac{\sigma_3}{\sigma_{ci}} + s \Bigr)^a
/// ```
///
/// and flow of the dilation angle ψ. At strength reduced by F, the envelope of shear strength over normal stress is that of f divided by F
/// (Hammah and others 2005).
///
/// ```
/// use igimp_material::{
///     ConstitutiveModel, Elasticity, HoekBrown, HoekBrownParameters, PointContext, Strength,
/// };
///
/// let rock = HoekBrownParameters {
///     intact_strength: 30e6, gsi: 45.0, intact_ratio: 10.0, disturbance: 0.0, dilation_angle: 0.0,
/// };
/// let law = HoekBrown::new(Elasticity::new(5e9, 0.3)?, rock)?;
/// let answer = law.return_map(&[0.0, 0.0, -0.01], &Default::default(), &PointContext::STATIC)?;
/// assert!(law.yield_function(&answer.tau, &answer.history).abs() < 1e-9 * 30e6);
/// # Ok::<(), igimp_material::MaterialError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoekBrown {
    elasticity: Elasticity,
    parameters: HoekBrownParameters,
    /// m_b, s and a.
    powers: [f64; 3],
    /// What the envelope of shear strength is divided by.
    srf: f64,
}

/// Where a pyramid touches the surface: a point, its principal stresses and the pyramid, each with its derivative by the point.
#[derive(Clone, Copy, Debug)]
struct Touching {
    /// Major and minor principal stress, compression positive \[stress\], and derivatives.
    stress: [[f64; 2]; 2],
    changing: Changing,
}

impl HoekBrown {
    /// From the parameters of a rock mass.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] of those that no rock has.
    pub fn new(
        elasticity: Elasticity,
        parameters: HoekBrownParameters,
    ) -> Result<Self, MaterialError> {
        parameters.check()?;
        let powers = [
            parameters.ratio(),
            parameters.cohesive_share(),
            parameters.exponent(),
        ];
        Ok(Self {
            elasticity,
            parameters,
            powers,
            srf: 1.0,
        })
    }

    /// The parameters.
    pub fn parameters(&self) -> &HoekBrownParameters {
        &self.parameters
    }

    /// Tensile strength all round $`s\,\sigma_{ci}/m_b`$ \[stress\].
    pub fn tensile_strength(&self) -> f64 {
        let [ratio, share, _] = self.powers;
        share * self.parameters.intact_strength / ratio
    }

    /// The least base at which a pyramid touches \[-\].
    fn least_base(&self) -> f64 {
        LEAST_SHARE * self.powers[1]
    }

    /// The pyramid that touches at the minor stress that the strength as given has there, by its base $`x = m_b\sigma_3/\sigma_{ci} + s`$.
    ///
    /// The circle that touches the envelope divided by F is the one of the angle tan φ/F at the same normal stress.
    fn touching(&self, base: f64) -> Touching {
        let [ratio, share, exponent] = self.powers;
        let intact = self.parameters.intact_strength;
        let minor = (base - share) * intact / ratio;
        let width = intact * base.powf(exponent);
        // All derivatives by the base.
        let minor_rate = intact / ratio;
        let width_rate = width * exponent / base;
        // N = dσ1/dσ3.
        let steep = 1.0 + width_rate / minor_rate;
        let steep_rate = width_rate * (exponent - 1.0) / (base * minor_rate);
        let sum = steep + 1.0;
        let normal = minor + width / sum;
        let normal_rate = minor_rate + (width_rate - width * steep_rate / sum) / sum;
        let root = steep.sqrt();
        let shear = width * root / (sum * self.srf);
        let tangent = (steep - 1.0) / (2.0 * root * self.srf);
        let tangent_rate = steep_rate * sum / (4.0 * steep * root * self.srf);
        // The envelope has the slope tan φ.
        let shear_rate = tangent * normal_rate;
        let secant = tangent.mul_add(tangent, 1.0).sqrt();
        let secant_rate = tangent * tangent_rate / secant;
        let centre = shear.mul_add(tangent, normal);
        let centre_rate = normal_rate + shear_rate * tangent + shear * tangent_rate;
        let radius = shear * secant;
        let radius_rate = shear_rate * secant + shear * secant_rate;
        let (sin, sin_rate) = (tangent / secant, tangent_rate / secant.powi(3));
        let dilation = self.parameters.dilation_angle.sin();
        let is_capped = dilation > sin;
        // 2 c cos φ = 2 (R − p sin φ), of compression positive p.
        let strength = PlaneStrength {
            sin_friction: sin,
            sin_dilation: if is_capped { sin } else { dilation },
            shear: 2.0 * (shear - normal * tangent) / secant,
            apex: shear / tangent - normal,
            tension_cutoff: None,
        };
        let offset = shear - normal * tangent;
        let rate = PlaneStrength {
            sin_friction: sin_rate,
            sin_dilation: if is_capped { sin_rate } else { 0.0 },
            shear: -2.0 * (normal * tangent_rate + offset * secant_rate / secant) / secant,
            apex: -shear * tangent_rate / (tangent * tangent),
            tension_cutoff: None,
        };
        Touching {
            stress: [
                [centre + radius, centre_rate + radius_rate],
                [centre - radius, centre_rate - radius_rate],
            ],
            changing: Changing { strength, rate },
        }
    }

    /// The base whose pyramid touches at a minor stress of the strength as it is reduced, compression positive; none beyond the apex.
    fn base_at(&self, minor: f64) -> Option<f64> {
        let [ratio, share, _] = self.powers;
        let given = share + ratio * minor / self.parameters.intact_strength;
        if given <= self.least_base() {
            return None;
        }
        if self.srf.to_bits() == 1.0_f64.to_bits() {
            return Some(given);
        }
        let mut search = Search::new(self.least_base(), given);
        for _ in 0..MOST_CORRECTIONS {
            let base = search.base;
            let [_, [found, rate]] = self.touching(base).stress;
            let gap = minor - found;
            let next = search.next(gap, base + gap / rate);
            if (next - base).abs() <= f64::EPSILON * base {
                break;
            }
            search.base = next;
        }
        Some(search.base)
    }

    /// Difference of major and minor stress that strength admits at a minor one, compression positive, and sin φ there.
    fn admitted(&self, minor: f64) -> Option<[f64; 2]> {
        let touching = self.touching(self.base_at(minor)?);
        let [[major, _], [minor, _]] = touching.stress;
        Some([major - minor, touching.changing.strength.sin_friction])
    }

    /// The base at which the pyramid touches that a trial strain returns to, with the return to it; none where that is the apex.
    ///
    /// # Errors
    /// [`MaterialError::NotConverged`].
    fn settled(
        &self,
        strain: &Principal,
        trial: &Principal,
        history: &History,
    ) -> Result<Option<(Touching, ReturnMap, Principal)>, MaterialError> {
        let first = self.base_at(-trial[0]);
        let mut search = Search::new(self.least_base(), first.unwrap_or(2.0 * self.least_base()));
        for _ in 0..MOST_CORRECTIONS {
            let base = search.base;
            let touching = self.touching(base);
            let pyramid = &touching.changing.strength;
            let map = pyramid.return_map(&self.elasticity, strain, *history)?;
            let (changing, regime) = (touching.changing, map.regime);
            let moves = changing.stress_rate(&self.elasticity, regime, trial, &map.tau);
            let [_, [minor, minor_rate]] = touching.stress;
            let gap = -map.tau[0] - minor;
            let slope = minor_rate + moves[0];
            let next = search.next(gap, base + gap / slope.max(0.01 * minor_rate));
            // Where a pyramid touches, an error of the point is one of its square on the surface.
            if (next - base).abs() <= 4.0 * f64::EPSILON * base {
                return Ok((base > 1.5 * self.least_base() && regime != Regime::Apex)
                    .then_some((touching, map, moves)));
            }
            search.base = next;
        }
        Err(MaterialError::NotConverged { law: self.name() })
    }

    /// The trial strain goes to the apex. Where the tip below the least base is cut off, a trial stress of less mean stress keeps that:
    /// the apex would take work out of the rock.
    fn at_apex(&self, strain: &Principal, history: &History) -> ReturnMap {
        let mean = mean(&self.elasticity.stress(strain));
        let (tau, slope) = if mean < self.tensile_strength() {
            (mean, self.elasticity.bulk())
        } else {
            (self.tensile_strength(), 0.0)
        };
        let tau = [tau; 3];
        let elastic = self.elasticity.strain(&tau);
        let delta_eps_p: Principal = std::array::from_fn(|a| strain[a] - elastic[a]);
        ReturnMap {
            tau,
            tangent: [[slope; 3]; 3],
            delta_eps_p,
            history: history.after(&delta_eps_p),
            regime: Regime::Apex,
            nonlocal: NonlocalRates::NONE,
        }
    }
}

/// Newton's method for a base, between bounds.
struct Search {
    low: f64,
    high: f64,
    base: f64,
    /// The last correction.
    step: f64,
}

impl Search {
    fn new(least: f64, base: f64) -> Self {
        Self {
            low: least,
            high: f64::INFINITY,
            base,
            step: f64::INFINITY,
        }
    }

    /// The next base where `gap` is left, which is positive below the one that is sought: that of Newton's method while its corrections
    /// at least halve, else the middle of the bounds in their logarithm.
    fn next(&mut self, gap: f64, newton: f64) -> f64 {
        if gap > 0.0 {
            self.low = self.base;
        } else {
            self.high = self.base;
        }
        let is_inside = newton > self.low && newton < self.high;
        let halves = 2.0 * (newton - self.base).abs() <= self.step.abs();
        let next = if is_inside && (halves || self.high.is_infinite()) {
            newton
        } else if self.high.is_infinite() {
            4.0 * self.low
        } else {
            (self.low * self.high).sqrt()
        };
        self.step = next - self.base;
        next
    }
}

impl ConstitutiveModel for HoekBrown {
    fn name(&self) -> &'static str {
        "Hoek-Brown"
    }

    fn stiffness_bound(&self) -> &Elasticity {
        &self.elasticity
    }

    /// The return to the pyramid that touches where the stress ends up; beyond all of them the apex, with a tangent of zero.
    fn return_map(
        &self,
        eps_e_trial: &Principal,
        history: &History,
        _: &PointContext,
    ) -> Result<ReturnMap, MaterialError> {
        let order = descending(eps_e_trial);
        let strain = sorted(eps_e_trial, &order);
        let trial = trial_stress(&self.elasticity, &strain)?;
        if self.yield_function(&trial, history) <= ON_SURFACE * self.stress_scale(&trial) {
            let tau = unsorted(&trial, &order);
            return Ok(ReturnMap::elastic(&self.elasticity, tau, *history));
        }
        let map =
            if let Some((touching, mut map, moves)) = self.settled(&strain, &trial, history)? {
                let [_, [_, minor_rate]] = touching.stress;
                let (first, slope) = (map.tangent[0], minor_rate + moves[0]);
                for (row, moves) in map.tangent.iter_mut().zip(moves) {
                    for (entry, first) in row.iter_mut().zip(first) {
                        *entry -= moves * first / slope;
                    }
                }
                map
            } else {
                self.at_apex(&strain, history)
            };
        let mut tangent = [[0.0; 3]; 3];
        for a in 0..3 {
            tangent[order[a]] = unsorted(&map.tangent[a], &order);
        }
        Ok(ReturnMap {
            tau: unsorted(&map.tau, &order),
            delta_eps_p: unsorted(&map.delta_eps_p, &order),
            tangent,
            ..map
        })
    }

    fn has_symmetric_tangent(&self) -> bool {
        false
    }

    /// ψ over the friction angle at no confinement; none without dilation.
    fn dilatancy(&self) -> f64 {
        let [_, share, _] = self.powers;
        let sine = self.touching(share).changing.strength.sin_friction;
        (self.parameters.dilation_angle / sine.asin()).min(1.0)
    }
}

impl Strength for HoekBrown {
    /// $`(1 - \sin\varphi)`$ times $`\sigma_1 - \sigma_3`$ less what strength admits at σ3, compression positive, with φ of the pyramid that
    /// touches there: what f of that pyramid is. Beyond the tensile strength t, $`-\sigma_3 - t`$.
    fn yield_function(&self, tau: &Principal, _history: &History) -> f64 {
        let [first, _, last] = sorted(tau, &descending(tau));
        match self.admitted(-first) {
            Some([admitted, sine]) => (1.0 - sine) * (first - last - admitted),
            None => first - self.tensile_strength(),
        }
    }

    /// σ_ci s^a plus twice the largest principal stress in magnitude, and the tensile strength.
    fn stress_scale(&self, tau: &Principal) -> f64 {
        let [_, share, exponent] = self.powers;
        let uniaxial = self.parameters.intact_strength * share.powf(exponent) / self.srf;
        uniaxial + self.tensile_strength() + 2.0 * largest(tau)
    }

    /// The difference of major and minor stress over what strength admits at the minor one; 1 at the apex and beyond.
    fn utilisation(&self, tau: &Principal, _history: &History) -> f64 {
        let [first, _, last] = sorted(tau, &descending(tau));
        let admitted = self.admitted(-first).map_or(0.0, |[admitted, _]| admitted);
        mobilised(first - last, admitted, self.stress_scale(tau))
    }

    /// Divides the envelope of shear strength over normal stress by `srf`; ψ stays but never exceeds φ.
    fn reduced(&self, srf: f64) -> Result<Arc<dyn ConstitutiveModel>, MaterialError> {
        positive("srf", srf)?;
        Ok(Arc::new(Self {
            srf: self.srf * srf,
            ..*self
        }))
    }
}
