//! Small tensor algebra and numerical derivatives of a lift.

use igimp_material::{
    ConstitutiveModel, History, Lifted, Principal, Regime, TangentKind, Tensor, lift_finite,
    lift_small,
};

/// Which of the two lifts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Measure {
    Finite,
    Small,
}

pub(crate) const MEASURES: [Measure; 2] = [Measure::Finite, Measure::Small];

pub(crate) fn multiply(a: &Tensor, b: &Tensor) -> Tensor {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

pub(crate) fn transpose(a: &Tensor) -> Tensor {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

/// F a Fᵀ.
pub(crate) fn congruence(f: &Tensor, a: &Tensor) -> Tensor {
    multiply(&multiply(f, a), &transpose(f))
}

pub(crate) fn diagonal(values: Principal) -> Tensor {
    [
        [values[0], 0.0, 0.0],
        [0.0, values[1], 0.0],
        [0.0, 0.0, values[2]],
    ]
}

pub(crate) fn largest(a: &Tensor) -> f64 {
    a.iter()
        .flatten()
        .fold(0.0, |most: f64, value| most.max(value.abs()))
}

/// In-plane rotation by an angle \[radians\].
pub(crate) fn plane_rotation(angle: f64) -> Tensor {
    let (sine, cosine) = angle.sin_cos();
    [[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]]
}

impl Measure {
    /// The state with the given principal strains and axes (columns of `axes`): b = exp 2ε, or ε.
    pub(crate) fn state(self, strain: &Principal, axes: &Tensor) -> Tensor {
        let values = match self {
            Self::Finite => strain.map(|value| (2.0 * value).exp()),
            Self::Small => *strain,
        };
        congruence(axes, &diagonal(values))
    }

    pub(crate) fn lift<const D: usize>(
        self,
        law: &dyn ConstitutiveModel,
        state: &Tensor,
        kind: TangentKind,
    ) -> Lifted<D> {
        let history = History::default();
        match self {
            Self::Finite => lift_finite(law, state, &history, kind),
            Self::Small => lift_small(law, state, &history, kind),
        }
        .unwrap()
    }

    /// The state moved by the velocity gradient `l` over the step `h`.
    fn moved(self, state: &Tensor, l: &Tensor, h: f64) -> Tensor {
        let mut out = *state;
        match self {
            Self::Finite => {
                let mut f = l.map(|row| row.map(|value| h * value));
                for a in 0..3 {
                    f[a][a] += 1.0;
                }
                out = congruence(&f, state);
            }
            Self::Small => {
                for a in 0..3 {
                    for b in 0..3 {
                        out[a][b] += 0.5 * h * (l[a][b] + l[b][a]);
                    }
                }
            }
        }
        out
    }

    /// Rate of stress under the velocity gradient `l`, by fourth-order differences of step `h`;
    /// none if the regime changes on the way.
    pub(crate) fn rate<const D: usize>(
        self,
        law: &dyn ConstitutiveModel,
        state: &Tensor,
        l: &Tensor,
        h: f64,
    ) -> Option<Tensor> {
        let at = |step: f64| -> (Tensor, Regime) {
            let state = self.moved(state, l, step);
            let lifted: Lifted<D> = self.lift(law, &state, TangentKind::Consistent);
            (lifted.tau, lifted.regime)
        };
        let regime = at(0.0).1;
        let points = [-2.0, -1.0, 1.0, 2.0].map(|k| at(k * h));
        if points.iter().any(|(_, other)| *other != regime) {
            return None;
        }
        let [far_left, left, right, far_right] = points.map(|(tau, _)| tau);
        Some(std::array::from_fn(|a| {
            std::array::from_fn(|b| {
                (8.0 * (right[a][b] - left[a][b]) - (far_right[a][b] - far_left[a][b])) / (12.0 * h)
            })
        }))
    }
}

/// Largest difference between `rate` and the answer of the spatial tangent to `l`, all nine
/// components in 3D, the in-plane ones and the trace in plane strain.
///
/// `l` may have `l_zz` in plane strain only as part of an isotropic tensor: `l = l' + r I`.
pub(crate) fn tangent_error<const D: usize>(
    lifted: &Lifted<D>,
    rate: &Tensor,
    l_prime: &Tensor,
    r: f64,
) -> f64 {
    let tangent = &lifted.tangent();
    let mut most = 0.0_f64;
    let mut trace = r * tangent.trace;
    for a in 0..D {
        for b in 0..D {
            let mut predicted = r * tangent.trace_right[a][b];
            for c in 0..D {
                for d in 0..D {
                    predicted += tangent.modulus[a][b][c][d] * l_prime[c][d];
                }
            }
            trace += tangent.trace_left[a][b] * l_prime[a][b];
            most = most.max((predicted - rate[a][b]).abs());
        }
    }
    most.max((trace - (rate[0][0] + rate[1][1] + rate[2][2])).abs())
}

/// A velocity gradient l' + r I: l' has D×D components.
pub(crate) fn with_dilation<const D: usize>(l_prime: &mut Tensor, r: f64) -> Tensor {
    for a in 0..3 {
        for b in 0..3 {
            if a >= D || b >= D {
                l_prime[a][b] = 0.0;
            }
        }
    }
    let mut l = *l_prime;
    for a in 0..3 {
        l[a][a] += r;
    }
    l
}
