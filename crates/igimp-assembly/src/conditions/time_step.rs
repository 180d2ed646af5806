//! The time that a step takes, and the scheme by which motion is integrated over it.

/// The duration of a step and its time integration (theory, eqs. 60 to 62).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeStep {
    /// Duration Δt \[time\].
    pub duration: f64,
    /// Time integration.
    pub scheme: TimeScheme,
    /// Mass matrix.
    pub mass: MassMatrix,
}

/// A scheme of time integration: u = Δt \[θ v₁ + (1 − θ) v₀\], and forces weighted alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimeScheme {
    /// θ = 1: first order; motion that a step does not resolve is damped out.
    BackwardEuler,
    /// θ = ½, Newmark's method with β = ¼ and γ = ½: second order, without damping.
    Newmark,
}

impl TimeScheme {
    /// The weight θ of the end of the step \[-\].
    pub fn theta(self) -> f64 {
        match self {
            Self::BackwardEuler => 1.0,
            Self::Newmark => 0.5,
        }
    }
}

/// How the mass of the particles is given to the nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MassMatrix {
    /// M_ij = Σ_p m_p S_ip S_jp: what the map of velocities loses is what the grid cannot carry.
    Consistent,
    /// M_ii = Σ_p m_p S_ip: the map of velocities smooths them.
    Lumped,
}

impl TimeStep {
    /// The rate 1/(θ Δt)² by which a displacement becomes an acceleration \[1/time²\].
    pub(crate) fn rate(&self) -> f64 {
        (self.scheme.theta() * self.duration).powi(-2)
    }

    /// The velocity at the end of a step that begins with `before` \[length/time\] and displaces by `u` \[length\].
    pub(crate) fn velocity_after<const D: usize>(
        &self,
        before: &[f64; D],
        u: &[f64; D],
    ) -> [f64; D] {
        let theta = self.scheme.theta();
        std::array::from_fn(|a| (u[a] / self.duration - (1.0 - theta) * before[a]) / theta)
    }

    /// Whether the duration is a positive number.
    pub(crate) fn is_sound(&self) -> bool {
        self.duration > 0.0 && self.rate().is_finite()
    }
}
