//! A law on its own: one piece of soil under uniform strain, driven along a path of strains and stresses (theory, eqs. 86 and
//! 87).
//!
//! ```
//! use igimp_material::{ConstitutiveModel, Elasticity, Tresca};
//! use igimp_solver::element::{ElementTest, Kinematics, StandardTest};
//!
//! let law = Tresca::new(Elasticity::new(10e6, 0.3)?, 50e3)?;
//! let path = StandardTest::TriaxialUndrained.path(0.05);
//! let test = ElementTest { sigma: [-100e3; 3], path, steps: 20, kinematics: Kinematics::Finite, durations: Vec::new() };
//! let run = test.run(&law)?;
//! let last = run.states.last().expect("the start is among them");
//! assert!(run.failure.is_none() && (last.q() - 100e3).abs() < 1.0); // q = 2 c_u
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod point;
mod standard;

use igimp_material::{ConstitutiveModel, History, MaterialError, Principal, Regime, Tensor};
use thiserror::Error;

use point::Point;
pub use standard::StandardTest;

/// Number of components that are driven: xx, yy and zz, and shear of x by y.
pub const COMPONENTS: usize = 4;

/// The axis that points upwards in the soil.
const VERTICAL: usize = 1;

/// Most halvings of a step.
const MOST_HALVINGS: i32 = 12;

/// The prescribed measure of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    /// Its strain: natural of xx, yy and zz, ∂u_x/∂Y of the shear \[-\].
    Strain,
    /// Its Cauchy stress \[stress\].
    Stress,
    /// Nothing of its own: the strain is that of xx, as in a triaxial cell. Of zz only.
    AsXx,
}

/// A path: the controls, and their values at the ends of legs. The first leg begins at the initial state.
#[derive(Clone, Debug, PartialEq)]
pub struct ElementPath {
    /// The control of xx, yy, zz and xy.
    pub controls: [Control; COMPONENTS],
    /// Values at the ends of the legs: strain \[-\] or stress \[stress\], extension and tension positive; that of
    /// [`Control::AsXx`] plays no part. A stress that is not a number is the initial one.
    pub legs: Vec<[f64; COMPONENTS]>,
}

/// How strain is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Kinematics {
    /// By the deformation gradient, with natural strain; stress is Cauchy's.
    #[default]
    Finite,
    /// Linear strain; stress per initial area.
    Small,
}

/// A test of a law.
#[derive(Clone, Debug, PartialEq)]
pub struct ElementTest {
    /// The initial stress in x, y and z \[stress\], tension positive.
    pub sigma: Principal,
    /// The path.
    pub path: ElementPath,
    /// Steps of a leg; a step that does not converge is halved.
    pub steps: usize,
    /// How strain is measured.
    pub kinematics: Kinematics,
    /// How long each leg takes \[time\], for laws whose strength goes with the rate of strain; of a leg without an entry it is
    /// zero, and strength that at the reference rate.
    pub durations: Vec<f64>,
}

/// The state of the soil after a step.
#[derive(Clone, Debug, PartialEq)]
pub struct ElementState {
    /// Natural strains xx, yy and zz, and ∂u_x/∂Y \[-\], extension positive.
    pub strain: [f64; COMPONENTS],
    /// Cauchy stress \[stress\], tension positive.
    pub sigma: Tensor,
    /// The internal variables of the law.
    pub history: History,
    /// Where on the yield surface the stress is.
    pub regime: Regime,
    /// Corrections that the step took.
    pub corrections: usize,
}

impl ElementState {
    /// Mean pressure p \[stress\], compression positive.
    pub fn p(&self) -> f64 {
        -(self.sigma[0][0] + self.sigma[1][1] + self.sigma[2][2]) / 3.0
    }

    /// q = √(3/2 s:s) \[stress\].
    pub fn q(&self) -> f64 {
        let s = &self.sigma;
        let normal = [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (s[a][a] - s[b][b]).powi(2));
        (0.5 * normal.iter().sum::<f64>() + 3.0 * s[0][1] * s[0][1]).sqrt()
    }

    /// Volumetric strain, ln of the volume over the initial one with its sign changed \[-\], compression positive.
    pub fn volumetric_strain(&self) -> f64 {
        0.0 - (self.strain[0] + self.strain[1] + self.strain[2])
    }

    /// Component c of the stress \[stress\].
    fn stress(&self, c: usize) -> f64 {
        if c < 3 {
            self.sigma[c][c]
        } else {
            self.sigma[0][1]
        }
    }
}

/// The states of a test, and why it ended early if it did.
#[derive(Clone, Debug)]
pub struct ElementRun {
    /// The initial state, and one after every step.
    pub states: Vec<ElementState>,
    /// None where the whole path was followed.
    pub failure: Option<StepLost>,
}

/// A step that did not converge, however short.
#[derive(Error, Clone, Debug, PartialEq)]
#[error(
    "leg {} of the path ends at {:.3} % of it: no equilibrium was found beyond (the stresses that are prescribed may not be possible)",
    leg + 1,
    100.0 * share
)]
pub struct StepLost {
    /// The leg, from 0.
    pub leg: usize,
    /// The share of it that was followed \[-\].
    pub share: f64,
    /// The error of the law, if it refused.
    pub law: Option<MaterialError>,
}

/// Why a test cannot begin.
#[derive(Error, Clone, Debug, PartialEq)]
pub enum ElementError {
    /// The initial stress is not admissible.
    #[error("the initial stress lies outside of the yield surface: f = {excess:.4} of {scale:.4}")]
    InitialStress {
        /// f \[stress\].
        excess: f64,
        /// The stresses that f is a difference of \[stress\].
        scale: f64,
    },
    /// [`Control::AsXx`] of another component than zz, or no steps.
    #[error("{0}")]
    Path(&'static str),
    /// The law refuses the initial stress.
    #[error("the law does not take the initial stress")]
    Law(#[from] MaterialError),
}

impl ElementTest {
    /// Drives a law along the path.
    ///
    /// # Errors
    /// [`ElementError`] of a test that cannot begin. A step that does not converge ends the run, which says so.
    pub fn run(&self, law: &dyn ConstitutiveModel) -> Result<ElementRun, ElementError> {
        let is_tied = |c: usize| self.path.controls[c] == Control::AsXx;
        if is_tied(0) || is_tied(1) || is_tied(3) {
            return Err(ElementError::Path("only zz can strain as xx does"));
        }
        if self.steps == 0 {
            return Err(ElementError::Path("a leg needs a step"));
        }
        let history = law.initial_history(&self.sigma);
        let axes = std::array::from_fn(|a| std::array::from_fn(|b| f64::from(u8::from(a == b))));
        let history = law.directed(history, &self.sigma, &axes, (3, VERTICAL));
        let (excess, scale) = (
            law.yield_function(&self.sigma, &history),
            law.stress_scale(&self.sigma),
        );
        if excess > 1e-9 * scale {
            return Err(ElementError::InitialStress { excess, scale });
        }
        let mut point = Point::new(law, &self.sigma, history, self.kinematics)?;
        let mut states = vec![point.state.clone()];
        let mut begin = self.begin(&point.state);
        for (leg, end) in self.path.legs.iter().enumerate() {
            let end = self.filled(end);
            let duration = self.durations.get(leg).copied().unwrap_or(0.0);
            let follows =
                |share: f64| std::array::from_fn(|c| begin[c] + share * (end[c] - begin[c]));
            for step in 0..self.steps {
                let share = |k: usize| k as f64 / self.steps as f64;
                let way = [share(step), share(step + 1)];
                if let Err((share, law)) = follow(
                    law,
                    (&mut point, self.path.controls),
                    (way, duration),
                    &follows,
                ) {
                    let failure = Some(StepLost { leg, share, law });
                    return Ok(ElementRun { states, failure });
                }
                states.push(point.state.clone());
            }
            begin = end;
        }
        Ok(ElementRun {
            states,
            failure: None,
        })
    }

    /// The prescribed values at the start.
    fn begin(&self, state: &ElementState) -> [f64; COMPONENTS] {
        std::array::from_fn(|c| match self.path.controls[c] {
            Control::Stress => state.stress(c),
            Control::Strain | Control::AsXx => 0.0,
        })
    }

    /// The end of a leg, with the initial stress where none is stated.
    fn filled(&self, end: &[f64; COMPONENTS]) -> [f64; COMPONENTS] {
        std::array::from_fn(|c| match self.path.controls[c] {
            Control::Stress if end[c].is_nan() => self.sigma.get(c).copied().unwrap_or(0.0),
            _ => end[c],
        })
    }
}

/// Takes a step in as many parts as it needs; else how far it came, and the error of the law.
fn follow(
    law: &dyn ConstitutiveModel,
    (point, controls): (&mut Point, [Control; COMPONENTS]),
    ([mut from, to], duration): ([f64; 2], f64),
    values: &dyn Fn(f64) -> [f64; COMPONENTS],
) -> Result<(), (f64, Option<MaterialError>)> {
    let whole = to - from;
    let least = whole * 0.5_f64.powi(MOST_HALVINGS);
    let mut part = whole;
    let mut corrections = 0;
    while to - from > 0.5 * least {
        part = part.min(to - from);
        match point.advanced(law, controls, &values(from + part), (part, part * duration)) {
            Ok(next) => {
                *point = next;
                corrections += point.state.corrections;
                from += part;
                part *= 2.0;
            }
            Err(_) if part > 1.5 * least => part *= 0.5,
            Err(error) => return Err((from, error)),
        }
    }
    point.state.corrections = corrections;
    Ok(())
}
