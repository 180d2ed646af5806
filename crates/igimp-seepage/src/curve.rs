//! How much of its permeability soil keeps where its pores are not full, and how much water (theory, eqs. 79 to 81 and 85a).

/// Relative permeability k_r by the pressure head ψ = u / γ_w \[m\], negative above the free surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Curve {
    /// Falls from 1 to the floor over one cell unless another width is given, along level lines about the free surface, upright above it
    /// (eqs. 79 and 79a).
    #[default]
    Ramp,
    /// Gardner: $`k_r = e^{\alpha \psi}`$ (eq. 80).
    Gardner {
        /// α \[1/m\], positive.
        alpha: f64,
    },
    /// van Genuchten and Mualem, with m = 1 − 1/n (eq. 81).
    VanGenuchten {
        /// α \[1/m\], positive.
        alpha: f64,
        /// n \[-\], above 1.
        n: f64,
    },
}

/// How pores give water back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pores {
    pub(crate) curve: Curve,
    /// Share of the volume of soil that drains \[-\].
    pub(crate) drainable: f64,
    /// Water by volume and head of pores that stay full \[1/m\].
    pub(crate) specific_storage: f64,
}

/// Settings that the curves of a solution share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Relative {
    /// Height over which a ramp falls \[m\].
    pub(crate) width: f64,
    /// No less than this share is kept \[-\].
    pub(crate) floor: f64,
    /// Exponent on curves that are no ramp, from 0, saturated everywhere, to 1 \[-\].
    pub(crate) exponent: f64,
    /// Whether all pores are full.
    pub(crate) confined: bool,
}

/// The pressure head at which the curve of van Genuchten is cut off by a straight line, as a share of 1/α \[-\]: its slope is
/// infinite at saturation.
const NEAR: f64 = 1e-3;

impl Relative {
    /// Shares of the permeability that are kept at a pressure head \[m\].
    pub(crate) fn shares(&self, curve: Curve, psi: f64) -> Shares {
        let share = 1.0 - self.floor;
        let kept = |raw: Slope| Slope(self.floor + share * raw.0, share * raw.1);
        let raw = match curve {
            _ if self.confined => Slope(1.0, 0.0),
            Curve::Ramp => {
                // Upright soil keeps all of it up to the surface, or water would enter level ground no faster than k / 2.
                let at = |t: f64, by: f64| kept(ramp(t).map_slope(by));
                let t = psi / self.width;
                return Shares {
                    level: at(0.5 + t, 1.0 / self.width),
                    upright: at(1.0 + 2.0 * t, 2.0 / self.width),
                };
            }
            Curve::Gardner { .. } | Curve::VanGenuchten { .. } if psi >= 0.0 => Slope(1.0, 0.0),
            Curve::Gardner { alpha } => {
                let value = (self.exponent * alpha * psi).exp();
                Slope(value, self.exponent * alpha * value)
            }
            Curve::VanGenuchten { alpha, n } => {
                let base = van_genuchten(-alpha * psi, n);
                let value = base.0.powf(self.exponent);
                Slope(
                    value,
                    -alpha * base.1 * self.exponent * value / base.0.max(f64::MIN_POSITIVE),
                )
            }
        };
        Shares {
            level: kept(raw),
            upright: kept(raw),
        }
    }

    /// Water that a volume of soil holds beyond that of full pores at ψ = 0, by volume \[-\], and its slope \[1/m\]: pores that
    /// are full yield by compression, others by drainage, and none by both (eq. 85a).
    pub(crate) fn content(&self, soil: &Pores, psi: f64) -> [f64; 2] {
        let full = match soil.curve {
            _ if self.confined => f64::NEG_INFINITY,
            Curve::Ramp => 0.5 * self.width,
            Curve::Gardner { .. } | Curve::VanGenuchten { .. } => 0.0,
        };
        if psi >= full {
            let from = if self.confined { 0.0 } else { full };
            return [soil.specific_storage * (psi - from), soil.specific_storage];
        }
        let saturation = match soil.curve {
            Curve::Ramp if psi <= -full => Slope(0.0, 0.0),
            // Straight, so that nodes one above the other yield as much at every level of the surface.
            Curve::Ramp => Slope(psi / self.width + 0.5, 1.0 / self.width),
            Curve::Gardner { alpha } => {
                let value = (alpha * psi).exp();
                Slope(value, alpha * value)
            }
            Curve::VanGenuchten { alpha, n } => retained(-alpha * psi, n).map_slope(-alpha),
        };
        [
            soil.drainable * (saturation.0 - 1.0),
            soil.drainable * saturation.1,
        ]
    }
}

/// A value and its slope by the pressure head.
#[derive(Clone, Copy, Debug)]
struct Slope(f64, f64);

/// Share of its permeability that soil keeps along level lines and along upright ones \[-\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shares {
    level: Slope,
    upright: Slope,
}

impl Shares {
    /// The part that is kept of a permeability, symmetric as that is, and its slope by the pressure head (eq. 79b).
    pub(crate) fn of<const D: usize>(&self, tensor: &[[f64; D]; D]) -> [[[f64; D]; D]; 2] {
        let Self { level, upright } = self;
        let between = (level.0 * upright.0).sqrt();
        let between_slope = 0.5 * (level.1 * upright.0 + level.0 * upright.1) / between;
        let mut found = [*tensor; 2];
        for row in 0..D {
            for column in 0..D {
                let [value, slope] = match (row == D - 1, column == D - 1) {
                    (false, false) => [level.0, level.1],
                    (true, true) => [upright.0, upright.1],
                    _ => [between, between_slope],
                };
                found[0][row][column] *= value;
                found[1][row][column] *= slope;
            }
        }
        found
    }
}

impl Slope {
    fn map_slope(self, by: f64) -> Self {
        Self(self.0, self.1 * by)
    }
}

/// From 0 at 0 to 1 at 1, smooth, odd about the middle.
fn ramp(t: f64) -> Slope {
    if t <= 0.0 {
        Slope(0.0, 0.0)
    } else if t >= 1.0 {
        Slope(1.0, 0.0)
    } else {
        Slope(t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t))
    }
}

/// Share by the suction s = −α ψ, and its slope; straight next to saturation.
fn van_genuchten(s: f64, n: f64) -> Slope {
    if s < NEAR {
        let end = curve_of(NEAR, n);
        let slope = (end.0 - 1.0) / NEAR;
        return Slope(1.0 + slope * s, slope);
    }
    curve_of(s, n)
}

/// Saturation of van Genuchten by the suction s = −α ψ, and its slope.
fn retained(s: f64, n: f64) -> Slope {
    let m = 1.0 - 1.0 / n;
    let power = s.powf(n);
    let full = (1.0 + power).powf(-m);
    Slope(full, -m * n * s.powf(n - 1.0) / (1.0 + power) * full)
}

fn curve_of(s: f64, n: f64) -> Slope {
    let m = 1.0 - 1.0 / n;
    let power = s.powf(n);
    let full = (1.0 + power).powf(-m);
    let full_slope = -m * n * power / s / (1.0 + power) * full;
    // 1 − S^{1/m} = s^n / (1 + s^n).
    let empty = power / (1.0 + power);
    let empty_slope = n * power / s / (1.0 + power).powi(2);
    let inner = 1.0 - empty.powf(m);
    let inner_slope = -m * empty.powf(m - 1.0) * empty_slope;
    let root = full.sqrt();
    Slope(
        root * inner * inner,
        0.5 / root * full_slope * inner * inner + 2.0 * root * inner * inner_slope,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: slopes are those of the values. ORACLE: differences.
    #[test]
    fn slopes_are_those_of_differences() {
        let relative = Relative {
            width: 0.5,
            floor: 1e-3,
            exponent: 0.7,
            confined: false,
        };
        for curve in [
            Curve::Ramp,
            Curve::Gardner { alpha: 2.0 },
            Curve::VanGenuchten { alpha: 1.5, n: 2.2 },
        ] {
            for psi in [-3.0, -0.4, -0.1, -2e-4, 0.1, 2.0] {
                let at = |psi: f64| relative.shares(curve, psi).of(&[[1.0; 2]; 2]);
                let [above, below] = [1e-6, -1e-6].map(|d| at(psi + d)[0]);
                let [value, slope] = at(psi);
                for (row, column) in [(0, 0), (0, 1), (1, 1)] {
                    let found = (above[row][column] - below[row][column]) / 2e-6;
                    let slope = slope[row][column];
                    assert!(
                        (found - slope).abs() < 1e-5 * (1.0 + slope.abs()),
                        "{curve:?} {psi}"
                    );
                    assert!((1e-3..=1.0).contains(&value[row][column]));
                }
            }
        }
    }

    /// GOAL: the slope of the content is that of its values, and full pores do not drain. ORACLE: differences; by hand.
    #[test]
    fn contents_are_by_compression_or_by_drainage() {
        let relative = Relative {
            width: 0.5,
            floor: 1e-3,
            exponent: 1.0,
            confined: false,
        };
        for (curve, full) in [
            (Curve::Ramp, 0.25),
            (Curve::Gardner { alpha: 2.0 }, 0.0),
            (Curve::VanGenuchten { alpha: 1.5, n: 2.2 }, 0.0),
        ] {
            let soil = Pores {
                curve,
                drainable: 0.2,
                specific_storage: 1e-3,
            };
            for psi in [-3.0, -0.4, -0.1, 0.1, 2.0] {
                let [above, below] = [1e-6, -1e-6].map(|d| relative.content(&soil, psi + d)[0]);
                let [_, slope] = relative.content(&soil, psi);
                assert!(
                    ((above - below) / 2e-6 - slope).abs() < 1e-7,
                    "{curve:?} {psi}"
                );
            }
            assert!((relative.content(&soil, full + 1.0)[0] - 1e-3).abs() < 1e-15);
            assert!((relative.content(&soil, -1e4)[0] + 0.2).abs() < 1e-4);
        }
    }

    /// GOAL: van Genuchten's curve. ORACLE: S = 2^-m at s = 1, k_r = √S (1 − (1 − S^{1/m})^m)², by hand for n = 2.
    #[test]
    fn van_genuchten_is_mualems() {
        let full: f64 = 0.5_f64.sqrt();
        let expected = full.sqrt() * (1.0 - 0.5_f64.sqrt()).powi(2);
        assert!((van_genuchten(1.0, 2.0).0 - expected).abs() < 1e-15);
    }
}
