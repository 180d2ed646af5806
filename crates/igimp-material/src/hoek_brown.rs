//! Hoek–Brown plasticity, of 2002, with strength reduction by the envelope of shear strength (theory, eqs. 111 to 115).
//!
//! The surface is the envelope of the pyramids of Mohr–Coulomb that touch it. A return goes to the pyramid that touches where the
//! stress ends up, which is one equation in one unknown.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use crate::circle::{Circle, Flow, Planes, mirrored, turned};
use crate::error::{positive, required};
use crate::law::{ON_SURFACE, dilatancy, mobilised, trial_stress};
use crate::spectral::principal::{Principal, descending, largest, mean, sorted, unsorted};
use crate::{
    ConstitutiveModel, Elasticity, History, MaterialError, NonlocalRates, PointContext, Regime,
    ReturnMap, Strength,
};

/// Most corrections of a touching point.
const MOST_CORRECTIONS: usize = 200;

/// Share of the base below which a correction is the last but one \[-\].
const CLOSE: f64 = 1e-9;

/// Least share of s at which a pyramid touches, of the base of the power, $`m_b\sigma_3/\sigma_{ci} + s`$ \[-\]: between it and the apex
/// all is the apex.
const LEAST_SHARE: f64 = 1e-9;

/// Parameters of the strength of a rock mass (Hoek, Carranza-Torres and Corkum 2002).
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
    /// Divisor of the envelope of shear strength.
    srf: f64,
}

/// Where a pyramid touches the surface, each value with its derivative by the base.
#[derive(Clone, Copy, Debug)]
struct Touching {
    /// Major and minor principal stress, compression positive \[stress\].
    stress: [[f64; 2]; 2],
    /// sin φ of the pyramid \[-\].
    sin_friction: f64,
    /// sin ψ of its flow \[-\].
    dilatancy: [f64; 2],
}

/// A return to some planes at a base.
#[derive(Clone, Copy, Debug)]
struct Found {
    circle: Circle,
    touching: Touching,
    /// Λ \[-\], and its derivative by the base.
    multiplier: [f64; 2],
    /// Excess of the circle beyond the strength \[stress\], and its derivative.
    excess: [f64; 2],
}

impl Found {
    /// The flow for the tangent.
    fn flow(&self) -> Flow {
        let [y, y_rate] = self.touching.dilatancy;
        let [g_u, g_w] = self.circle.paces(y);
        let ([multiplier, multiplier_rate], slope) = (self.multiplier, self.excess[1]);
        // The excess stays zero: dU + g_U/g_W dW and the slope times the change of the base.
        let unknown_by = [-1.0 / slope, -g_u / (g_w * slope)];
        Flow {
            multiplier,
            multiplier_by: [
                multiplier_rate * unknown_by[0],
                multiplier_rate * unknown_by[1] - 1.0 / g_w,
            ],
            dilatancy: [y, y_rate],
            unknown_by,
        }
    }
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
        let sin = tangent / secant;
        let dilation = self.parameters.dilation_angle.sin();
        Touching {
            stress: [
                [centre + radius, centre_rate + radius_rate],
                [centre - radius, centre_rate - radius_rate],
            ],
            sin_friction: sin,
            dilatancy: if dilation > sin {
                [sin, tangent_rate / secant.powi(3)]
            } else {
                [dilation, 0.0]
            },
        }
    }

    /// The pyramid that touches at a minor stress of the strength as it is reduced, compression positive; none beyond the apex.
    fn touching_at(&self, minor: f64) -> Option<Touching> {
        let [ratio, share, _] = self.powers;
        let given = share + ratio * minor / self.parameters.intact_strength;
        if given <= self.least_base() {
            return None;
        }
        if self.srf.to_bits() == 1.0_f64.to_bits() {
            return Some(self.touching(given));
        }
        let gap = |base: f64| {
            let touching = self.touching(base);
            let [_, [found, rate]] = touching.stress;
            (touching, [minor - found, -rate])
        };
        root(self.least_base(), given, gap)
    }

    /// Difference of major and minor stress that strength admits at a minor one, compression positive, and sin φ there.
    fn admitted(&self, minor: f64) -> Option<[f64; 2]> {
        let touching = self.touching_at(minor)?;
        let [[major, _], [minor, _]] = touching.stress;
        Some([major - minor, touching.sin_friction])
    }

    /// The return of a trial stress, positive in compression and in descending order, to some planes, by the base at which their pyramid
    /// touches (theory, eq. 115); none where all bases are beyond the apex.
    ///
    /// # Errors
    /// [`MaterialError::NotConverged`].
    fn on(&self, pressure: &Principal, planes: Planes) -> Result<Option<Found>, MaterialError> {
        let circle = Circle::new(&self.elasticity.moduli(), pressure, planes);
        let least = self.excess(&circle, self.least_base());
        if least.excess[0] <= 0.0 {
            return Ok(None);
        }
        let excess = |base: f64| {
            let found = self.excess(&circle, base);
            (found, found.excess)
        };
        root(self.least_base(), self.first_base(&circle), excess)
            .map(Some)
            .ok_or(MaterialError::NotConverged { law: self.name() })
    }

    /// By how much the circle is larger that flow leaves of a trial stress whose lower end becomes that of the pyramid of a base.
    fn excess(&self, circle: &Circle, base: f64) -> Found {
        let touching = self.touching(base);
        let [[major, major_rate], [minor, minor_rate]] = touching.stress;
        let ([up, low], [l_u, l_w]) = (circle.ends, circle.dilating);
        let [y, y_rate] = touching.dilatancy;
        let [g_u, g_w] = circle.paces(y);
        let multiplier = (minor - low) / g_w;
        let turned = multiplier * y_rate;
        let multiplier_rate = (minor_rate - turned * l_w) / g_w;
        Found {
            circle: *circle,
            multiplier: [multiplier, multiplier_rate],
            touching,
            excess: [
                up - multiplier * g_u - major,
                turned * l_u - multiplier_rate * g_u - major_rate,
            ],
        }
    }

    /// The base of a trial stress whose strength goes with the root, as it nearly does.
    fn first_base(&self, circle: &Circle) -> f64 {
        let [ratio, share, _] = self.powers;
        let intact = self.parameters.intact_strength;
        let [up, low] = circle.ends;
        let [g_u, g_w] = circle.paces(self.parameters.dilation_angle.sin());
        let pace = g_u / g_w;
        let straight = intact / ratio * (1.0 + pace);
        let far = up + pace * low + share * straight;
        let curved = intact / self.srf;
        let root = 2.0 * far / (curved + (curved * curved + 4.0 * straight * far.max(0.0)).sqrt());
        (root * root).max(2.0 * self.least_base())
    }

    /// The return of a trial strain outside the surface, with stresses in descending order.
    ///
    /// # Errors
    /// [`MaterialError::NotConverged`].
    fn returned(
        &self,
        strain: &Principal,
        trial: &Principal,
        history: &History,
    ) -> Result<ReturnMap, MaterialError> {
        let pressure = mirrored(trial);
        let mut is_beyond = true;
        for planes in Planes::ALL {
            let Some(found) = self.on(&pressure, planes)? else {
                continue;
            };
            let ([multiplier, _], [y, _]) = (found.multiplier, found.touching.dilatancy);
            let ends = found.touching.stress.map(|[end, _]| end);
            let stress = found.circle.stress(ends, multiplier, y);
            is_beyond &= planes == Planes::Main || multiplier < 0.0;
            if multiplier >= 0.0 && found.circle.holds(&stress, multiplier, y) {
                let delta_eps_p = mirrored(&found.circle.plastic_strain(multiplier, y));
                return Ok(ReturnMap {
                    tau: mirrored(&stress),
                    tangent: turned(&found.circle.tangent(&found.flow())),
                    delta_eps_p,
                    history: history.after(&delta_eps_p),
                    regime: planes.regime(),
                    nonlocal: NonlocalRates::NONE,
                });
            }
        }
        if is_beyond {
            Ok(self.at_apex(strain, history))
        } else {
            Err(MaterialError::NotConverged { law: self.name() })
        }
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

/// The result of `of` at its root, where `of` gives its gap, positive below the root, and the slope: by Newton's method
/// for the root of the base, along which it is nearly straight at the tip too, while its corrections at least halve, else between bounds.
fn root<T>(least: f64, first: f64, of: impl Fn(f64) -> (T, [f64; 2])) -> Option<T> {
    let (mut low, mut high) = (least, f64::INFINITY);
    let (mut base, mut step) = (first, f64::INFINITY);
    let mut is_last = false;
    for _ in 0..MOST_CORRECTIONS {
        let (result, [gap, slope]) = of(base);
        if is_last {
            return Some(result);
        }
        if gap > 0.0 {
            low = base;
        } else {
            high = base;
        }
        let side = base.sqrt();
        let newton = (side - gap / (2.0 * side * slope)).powi(2);
        let halves = 2.0 * (newton - base).abs() <= step;
        let is_newton = newton > low && newton < high && (halves || high.is_infinite());
        let next = if is_newton {
            newton
        } else if high.is_infinite() {
            4.0 * low
        } else {
            (low * high).sqrt()
        };
        step = (next - base).abs();
        // An error of the base is one of its square on the next.
        let close = if is_newton { CLOSE } else { 2.0 * f64::EPSILON };
        is_last = step <= close * base;
        base = next;
    }
    None
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
        let map = self.returned(&strain, &trial, history)?;
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

    /// r of eq. 8c with the friction angle at no confinement; none without dilation.
    fn dilatancy(&self) -> f64 {
        let [_, share, _] = self.powers;
        let sine = self.touching(share).sin_friction;
        dilatancy(self.parameters.dilation_angle, sine.asin()).min(1.0)
    }
}

impl Strength for HoekBrown {
    /// $`(1 - \sin\varphi)`$ times $`\sigma_1 - \sigma_3`$ less its limit at σ3, compression positive, with φ of the pyramid that
    /// touches there: f of that pyramid. Beyond the tensile strength t, $`-\sigma_3 - t`$.
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

    /// The difference of major and minor stress over its limit at the minor one; 1 at the apex and beyond.
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
