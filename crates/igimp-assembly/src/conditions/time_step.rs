//! The time that a step takes, and the scheme by which motion is integrated over it.

/// The duration of a step and its time integration (theory, eqs. 60 to 62).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeStep {
    /// Duration Δt \[time\].
    pub duration: f64,
    /// Time integration.
    pub scheme: TimeScheme,
    /// Share of the mass that is lumped at the nodes, the rest being consistent (theory, eq. 62) \[-\].
    pub lumped: f64,
    /// Whether motion begins with this step: accelerations follow from the forces at its start, and are not those that particles
    /// carry.
    pub is_first: bool,
    /// Whether the step is refused where motion changes by more than it resolves.
    pub must_resolve: bool,
}

/// A scheme of time integration (theory, eqs. 60 and 61).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimeScheme {
    /// First order; motion that a step does not resolve is damped out.
    BackwardEuler,
    /// Newmark's method with β = ¼ and γ = ½: second order, without damping.
    Newmark,
    /// The generalised-α method of Chung and Hulbert (1993), with the spectral radius 0.8 at high frequencies: second order; motion that
    /// a step does not resolve is damped.
    GeneralisedAlpha,
}

/// Spectral radius ρ of the generalised-α method at high frequencies \[-\].
const SPECTRAL_RADIUS: f64 = 0.8;

/// A scheme's displacement, velocity and acceleration: v₁ − v₀ = Δt \[γ a₁ + (1 − γ) a₀\] and
/// u = Δt v₀ + Δt² \[β a₁ + (σ − β) a₀\], with equilibrium between start and end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Weights {
    /// Of a₁ in the displacement, β \[-\].
    beta: f64,
    /// Of a₁ in the velocity, γ \[-\].
    gamma: f64,
    /// Of both accelerations in the displacement, σ: ½, and 1 by backward Euler \[-\].
    pub(crate) sum: f64,
    /// Of the start in the force of acceleration, α_m \[-\].
    pub(crate) of_mass: f64,
    /// Of the start in all other forces, α_f \[-\].
    pub(crate) of_force: f64,
}

impl TimeScheme {
    /// The weights of the scheme.
    pub(crate) fn weights(self) -> Weights {
        let between = |of_mass: f64, of_force: f64| {
            let gamma = 0.5 - of_mass + of_force;
            Weights {
                beta: 0.25 * (gamma + 0.5).powi(2),
                gamma,
                sum: 0.5,
                of_mass,
                of_force,
            }
        };
        match self {
            Self::BackwardEuler => Weights {
                beta: 1.0,
                gamma: 1.0,
                sum: 1.0,
                of_mass: 0.0,
                of_force: 0.0,
            },
            Self::Newmark => between(0.0, 0.0),
            Self::GeneralisedAlpha => {
                let rho = SPECTRAL_RADIUS;
                between((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0))
            }
        }
    }
}

impl TimeStep {
    /// The rate 1/(β Δt²) by which a displacement becomes an acceleration \[1/time²\].
    pub(crate) fn rate(&self) -> f64 {
        1.0 / (self.scheme.weights().beta * self.duration.powi(2))
    }

    /// The rate γ/(β Δt) by which a displacement becomes a velocity \[1/time\].
    pub(crate) fn velocity_rate(&self) -> f64 {
        let Weights { beta, gamma, .. } = self.scheme.weights();
        gamma / (beta * self.duration)
    }

    /// Whether the scheme asks for the acceleration at the start.
    pub(crate) fn asks_for_acceleration(&self) -> bool {
        self.scheme != TimeScheme::BackwardEuler
    }

    /// Whether the scheme asks for the forces at the start.
    pub(crate) fn asks_for_force_at_start(&self) -> bool {
        self.scheme.weights().of_force > 0.0 || (self.is_first && self.asks_for_acceleration())
    }

    /// Velocity \[length/time\] and acceleration \[length/time²\] at the end of a step that begins with these and displaces by `u`
    /// \[length\].
    pub(crate) fn after<const D: usize>(
        &self,
        velocity: &[f64; D],
        acceleration: &[f64; D],
        u: &[f64; D],
    ) -> ([f64; D], [f64; D]) {
        let Weights {
            beta, gamma, sum, ..
        } = self.scheme.weights();
        let (duration, rate) = (self.duration, self.rate());
        let after: [f64; D] = std::array::from_fn(|a| {
            rate * (u[a] - duration * velocity[a]) - (sum / beta - 1.0) * acceleration[a]
        });
        let gained = |a: usize| duration * (gamma * after[a] + (1.0 - gamma) * acceleration[a]);
        (std::array::from_fn(|a| velocity[a] + gained(a)), after)
    }

    /// Whether the duration is a positive number, and the lumped share lies between 0 and 1.
    pub(crate) fn is_sound(&self) -> bool {
        self.duration > 0.0 && self.rate().is_finite() && (0.0..=1.0).contains(&self.lumped)
    }
}
