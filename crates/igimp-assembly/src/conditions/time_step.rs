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
    /// Whether motion begins with this step: accelerations follow from the forces at its start, and are not those that particles
    /// carry.
    pub is_first: bool,
    /// Whether the step is refused where motion changes by more than it resolves.
    pub must_resolve: bool,
}

/// A scheme of time integration: u = Δt \[θ v₁ + (1 − θ) v₀\], and v₁ − v₀ = Δt \[θ a₁ + (1 − θ) a₀\].
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

    /// The rate 1/(θ Δt) by which a displacement becomes a velocity \[1/time\].
    pub(crate) fn velocity_rate(&self) -> f64 {
        1.0 / (self.scheme.theta() * self.duration)
    }

    /// Whether the scheme asks for the acceleration at the start.
    pub(crate) fn asks_for_acceleration(&self) -> bool {
        self.scheme.theta() < 1.0
    }

    /// Velocity \[length/time\] and acceleration \[length/time²\] at the end of a step that begins with these and displaces by `u`
    /// \[length\].
    pub(crate) fn after<const D: usize>(
        &self,
        velocity: &[f64; D],
        acceleration: &[f64; D],
        u: &[f64; D],
    ) -> ([f64; D], [f64; D]) {
        let (theta, duration, rate) = (self.scheme.theta(), self.duration, self.rate());
        (
            std::array::from_fn(|a| (u[a] / duration - (1.0 - theta) * velocity[a]) / theta),
            std::array::from_fn(|a| {
                rate * (u[a] - duration * velocity[a]) - (1.0 - theta) / theta * acceleration[a]
            }),
        )
    }

    /// Whether the duration is a positive number.
    pub(crate) fn is_sound(&self) -> bool {
        self.duration > 0.0 && self.rate().is_finite()
    }
}
