//! One step of one piece of soil: Newton's method on the strains whose stresses are prescribed.

use igimp_material::{
    ConstitutiveModel, History, Lifted, MaterialError, PointContext, Principal, Regime,
    TangentKind, Tensor, TrialStrain, elastic_left_cauchy_green_of,
};

use super::{COMPONENTS, Control, ElementState, Kinematics, VERTICAL};

/// Most corrections of a step.
const MOST_CORRECTIONS: usize = 25;

/// Residual of a step that is found, over the stresses of it \[-\].
const TOLERANCE: f64 = 1e-11;
/// Strain that is round-off, beside that of which b_e is made \[-\].
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

/// A strain, a stress, or one direction of the driven components.
type Driven = [f64; COMPONENTS];

/// The soil between two steps.
#[derive(Clone, Debug)]
pub(super) struct Point {
    pub(super) state: ElementState,
    /// Elastic left Cauchy–Green tensor, or elastic strain where that is small.
    elastic: Tensor,
    kinematics: Kinematics,
    /// Strain of the last step over its length, from which the next one begins.
    pace: Driven,
}

impl Point {
    /// Soil at rest under a stress.
    pub(super) fn new(
        law: &dyn ConstitutiveModel,
        sigma: &Principal,
        history: History,
        kinematics: Kinematics,
    ) -> Result<Self, MaterialError> {
        let mut stress = [[0.0; 3]; 3];
        for a in 0..3 {
            stress[a][a] = sigma[a];
        }
        let elastic = match kinematics {
            Kinematics::Finite => elastic_left_cauchy_green_of::<3>(law, &stress, &history)?,
            Kinematics::Small => {
                let strain = law.elastic_strain(sigma, &history)?;
                let mut elastic = [[0.0; 3]; 3];
                for a in 0..3 {
                    elastic[a][a] = strain[a];
                }
                elastic
            }
        };
        Ok(Self {
            state: ElementState {
                strain: [0.0; COMPONENTS],
                sigma: stress,
                history,
                regime: Regime::Elastic,
                corrections: 0,
            },
            elastic,
            kinematics,
            pace: [0.0; COMPONENTS],
        })
    }

    /// The soil at the end of a step of this length and duration \[time\], with these prescribed values; nothing where no equilibrium was
    /// found, and the error of the law if it refused.
    pub(super) fn advanced(
        &self,
        law: &dyn ConstitutiveModel,
        controls: [Control; COMPONENTS],
        values: &Driven,
        (length, duration): (f64, f64),
    ) -> Result<Self, Option<MaterialError>> {
        let stressed: Vec<usize> = (0..COMPONENTS)
            .filter(|&c| controls[c] == Control::Stress)
            .collect();
        let is_tied = controls[2] == Control::AsXx;
        let mut strain: Driven = std::array::from_fn(|c| match controls[c] {
            Control::Strain => values[c],
            Control::Stress | Control::AsXx => self.state.strain[c] + length * self.pace[c],
        });
        if is_tied {
            strain[2] = strain[0];
        }
        let round_off = ROUND_OFF * law.stiffness_bound().bulk();
        let mut before = f64::INFINITY;
        for corrections in 1..=MOST_CORRECTIONS {
            let trial = self.at(law, &strain, duration).map_err(Some)?;
            let sigma = trial.sigma;
            let residual: Vec<f64> = (stressed.iter())
                .map(|&c| stress_of(&sigma, c, is_tied) - values[c])
                .collect();
            let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
            let scale = largest(&mut sigma.as_flattened().iter().map(|s| s.abs()))
                .max(largest(&mut values.iter().map(|v| v.abs())))
                .max(1e-9 * law.stiffness_bound().shear());
            let size = largest(&mut residual.iter().map(|r| r.abs()));
            // Where soil hardly changes its volume, the round-off of strain is more than that of stress.
            let falls_no_more = size <= round_off && size >= 0.5 * before;
            before = size;
            if size <= TOLERANCE * scale || falls_no_more {
                return Ok(self.accepted(&trial, &strain, corrections, length));
            }
            let matrix: Vec<Vec<f64>> = (stressed.iter())
                .map(|&row| {
                    let by = |&column: &usize| {
                        trial.slope(&strain, self.kinematics, row, column, is_tied)
                    };
                    stressed.iter().map(by).collect()
                })
                .collect();
            let correction = solved(matrix, residual).ok_or(None)?;
            for (&c, by) in stressed.iter().zip(&correction) {
                strain[c] -= by;
            }
            if is_tied {
                strain[2] = strain[0];
            }
        }
        Err(None)
    }

    fn accepted(&self, trial: &Trial, strain: &Driven, corrections: usize, length: f64) -> Self {
        let elastic = match self.kinematics {
            Kinematics::Finite => trial.lifted.b_e(),
            Kinematics::Small => trial.elastic_strain(),
        };
        Self {
            state: ElementState {
                strain: *strain,
                sigma: trial.sigma,
                history: trial.lifted.history,
                regime: trial.lifted.regime,
                corrections,
            },
            elastic,
            kinematics: self.kinematics,
            pace: std::array::from_fn(|c| (strain[c] - self.state.strain[c]) / length),
        }
    }

    /// The answer of the law at a strain.
    fn at(
        &self,
        law: &dyn ConstitutiveModel,
        strain: &Driven,
        duration: f64,
    ) -> Result<Trial, MaterialError> {
        let history = &self.state.history;
        let (trial, volume) = match self.kinematics {
            Kinematics::Finite => {
                let step = product(&gradient(strain), &inverse(&gradient(&self.state.strain)));
                let b_e = product(&product(&step, &self.elastic), &transposed(&step));
                let volume = (strain[0] + strain[1] + strain[2]).exp();
                (TrialStrain::finite::<3>(&b_e)?, volume)
            }
            Kinematics::Small => {
                let mut elastic = self.elastic;
                for a in 0..3 {
                    elastic[a][a] += strain[a] - self.state.strain[a];
                }
                let half = 0.5 * (strain[3] - self.state.strain[3]);
                elastic[0][1] += half;
                elastic[1][0] += half;
                (TrialStrain::small::<3>(&elastic)?, 1.0)
            }
        };
        let trial = trial.with_vertical(VERTICAL);
        let answer = law.return_map(trial.strain(), history, &PointContext::over(duration))?;
        let lifted = trial.lift::<3>(law, &answer, TangentKind::Consistent)?;
        let sigma = lifted.tau.map(|row| row.map(|tau| tau / volume));
        if sigma.as_flattened().iter().all(|stress| stress.is_finite()) {
            Ok(Trial {
                lifted,
                sigma,
                volume,
            })
        } else {
            Err(MaterialError::NonFinite { quantity: "stress" })
        }
    }
}

/// The answer of the law at a strain.
struct Trial {
    lifted: Lifted<3>,
    sigma: Tensor,
    /// J \[-\].
    volume: f64,
}

impl Trial {
    /// ∂σ/∂E of two components (theory, eq. 87) \[stress\]; strain in xx takes zz with it where that is tied.
    fn slope(
        &self,
        strain: &Driven,
        kinematics: Kinematics,
        row: usize,
        column: usize,
        is_tied: bool,
    ) -> f64 {
        let mut rate = rate(strain, kinematics, column);
        if is_tied && column == 0 {
            let tied = self::rate(strain, kinematics, 2);
            for a in 0..3 {
                for b in 0..3 {
                    rate[a][b] += tied[a][b];
                }
            }
        }
        let modulus = self.lifted.tangent().modulus;
        let growth = match kinematics {
            Kinematics::Finite => rate[0][0] + rate[1][1] + rate[2][2],
            Kinematics::Small => 0.0,
        };
        let mut slope = [[0.0; 3]; 3];
        for a in 0..3 {
            for b in 0..3 {
                let pairs = modulus[a][b].as_flattened().iter().zip(rate.as_flattened());
                let tau: f64 = pairs.map(|(modulus, rate)| modulus * rate).sum();
                slope[a][b] = tau / self.volume - self.sigma[a][b] * growth;
            }
        }
        stress_of(&slope, row, is_tied)
    }

    /// The elastic strain in spatial axes.
    fn elastic_strain(&self) -> Tensor {
        let (values, frame) = (&self.lifted.eps_e, &self.lifted.frame);
        std::array::from_fn(|i| {
            std::array::from_fn(|j| (0..3).map(|a| values[a] * frame[a][i] * frame[a][j]).sum())
        })
    }
}

/// Component c of a stress; that at the sides is the mean of both where they strain alike.
fn stress_of(sigma: &Tensor, c: usize, is_tied: bool) -> f64 {
    match c {
        0 if is_tied => 0.5 * (sigma[0][0] + sigma[2][2]),
        3 => sigma[0][1],
        _ => sigma[c][c],
    }
}

/// F of the strains (theory, eq. 86).
fn gradient(strain: &Driven) -> Tensor {
    let mut gradient = [[0.0; 3]; 3];
    for a in 0..3 {
        gradient[a][a] = strain[a].exp();
    }
    gradient[0][1] = strain[3];
    gradient
}

/// The inverse of an F of eq. 86.
fn inverse(gradient: &Tensor) -> Tensor {
    let mut inverse = [[0.0; 3]; 3];
    for a in 0..3 {
        inverse[a][a] = 1.0 / gradient[a][a];
    }
    inverse[0][1] = -gradient[0][1] / (gradient[0][0] * gradient[1][1]);
    inverse
}

/// The velocity gradient of a unit rate of a component of strain, ∂F/∂E F⁻¹.
fn rate(strain: &Driven, kinematics: Kinematics, component: usize) -> Tensor {
    let mut rate = [[0.0; 3]; 3];
    match kinematics {
        Kinematics::Small if component == 3 => rate[0][1] = 1.0,
        Kinematics::Small => rate[component][component] = 1.0,
        Kinematics::Finite => {
            let gradient = gradient(strain);
            let mut slope = [[0.0; 3]; 3];
            if component == 3 {
                slope[0][1] = 1.0;
            } else {
                slope[component][component] = gradient[component][component];
            }
            rate = product(&slope, &inverse(&gradient));
        }
    }
    rate
}

fn product(left: &Tensor, right: &Tensor) -> Tensor {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| left[i][k] * right[k][j]).sum()))
}

fn transposed(tensor: &Tensor) -> Tensor {
    std::array::from_fn(|i| std::array::from_fn(|j| tensor[j][i]))
}

/// The solution of a few equations by elimination with pivots; none of singular ones.
fn solved(mut matrix: Vec<Vec<f64>>, mut rhs: Vec<f64>) -> Option<Vec<f64>> {
    let n = rhs.len();
    for k in 0..n {
        let largest = (k..n).max_by(|&i, &j| matrix[i][k].abs().total_cmp(&matrix[j][k].abs()))?;
        matrix.swap(k, largest);
        rhs.swap(k, largest);
        for i in k + 1..n {
            let share = matrix[i][k] / matrix[k][k];
            for j in k..n {
                matrix[i][j] -= share * matrix[k][j];
            }
            rhs[i] -= share * rhs[k];
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| matrix[k][j] * rhs[j]).sum();
        rhs[k] = (rhs[k] - known) / matrix[k][k];
    }
    rhs.iter().all(|value| value.is_finite()).then_some(rhs)
}
