//! Results of a step in the pores: excess pressures, the water that moved, and the error of the step in time.

use crate::contributions::consolidation::{Consolidation, flow};
use crate::step::stencils::Stencils;

/// The share of effective stress below which excess pore pressure needs no digits \[-\].
const STRESS_SHARE: f64 = 0.05;

/// The soil of a pressure: sums over particles.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Share {
    /// Its volume \[length^D\].
    pub(super) volume: f64,
    /// Volume by oedometric modulus \[length^D·force/length²\].
    pub(super) stiffness: f64,
    /// Growth of its water if that went on as in the step before \[length^D\].
    pub(super) expected: f64,
}

/// The water that a step moved.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WaterMoved {
    /// Outflow at open faces and drains \[length^D\].
    pub outflow: f64,
    /// Growth of the volume of soil that water flows through \[length^D\].
    pub swelling: f64,
    /// Water stored by its compression \[length^D\].
    pub stored: f64,
}

impl WaterMoved {
    /// The error of the balance \[length^D\].
    pub fn missing(&self) -> f64 {
        self.outflow + self.swelling + self.stored
    }
}

/// State of the pores after an accepted step.
#[derive(Clone, Debug, Default)]
pub struct PoresAfter {
    /// Given pore pressure by particle, empty where there is none \[force/length²\].
    pub(crate) given: Vec<f64>,
    /// Of the particles that water flows through.
    pub(crate) excess: Vec<ExcessAfter>,
    /// The water that the step moved; none where no water flows.
    pub water_moved: Option<WaterMoved>,
}

/// Excess pore pressure of a particle after a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ExcessAfter {
    pub(crate) particle: usize,
    /// Its excess pore pressure, compression positive \[force/length²\].
    pub(crate) excess: f64,
    /// By how much the pressure at the particle differs from that mean of its cells \[force/length²\].
    pub(crate) within_cell: f64,
    /// Rate at which its water by volume grew \[1/time\].
    pub(crate) rate: f64,
}

impl Share {
    /// A sum over particles by volume; zero where extrapolation left no soil.
    fn by_volume(&self, sum: f64) -> f64 {
        if self.volume > 0.0 {
            sum / self.volume
        } else {
            0.0
        }
    }
}

impl<const D: usize> Consolidation<D> {
    /// The excess pore pressures of particles at nodal values `u`.
    fn excess_after(&self, u: &[[f64; D]]) -> Vec<ExcessAfter> {
        let grown = self.grown(u);
        let grown: Vec<f64> = (self.shares.iter().zip(grown))
            .map(|(share, grown)| share.by_volume(grown))
            .collect();
        let seeping = self.seeping.iter();
        seeping
            .map(|seeping| {
                let pressed = self.pressed(seeping, u);
                let supports = self.supports_of(seeping).iter();
                let grows: f64 = supports
                    .map(|support| support.mean * grown[support.place as usize])
                    .sum();
                ExcessAfter {
                    particle: seeping.particle as usize,
                    excess: pressed.mean,
                    within_cell: pressed.bulge,
                    rate: grows / self.duration,
                }
            })
            .collect()
    }

    /// The growth of the water of each pressure by flow at nodal values `u` \[length^D\].
    fn grown(&self, u: &[[f64; D]]) -> Vec<f64> {
        let shares = self.shares.iter();
        let mut grown: Vec<f64> = shares.map(|share| self.of_rate * share.expected).collect();
        for seeping in &self.seeping {
            let flows = flow(&seeping.flows, &self.pressed(seeping, u).grad);
            for support in self.supports_of(seeping) {
                let along = support.grad.iter().zip(&flows);
                let water: f64 = along.map(|(grad, flow)| grad * flow).sum();
                grown[support.place as usize] -= water;
            }
        }
        for leak in &self.leaks {
            let water = leak.conductance * self.pressure_at(leak, u);
            for &(place, value) in &leak.values {
                grown[place as usize] -= value * water;
            }
        }
        grown
    }

    /// The error of the step in time at nodal values `u`, the mean square of that of excess pore pressures over the largest of them,
    /// or over a part of the largest effective stress `stress` \[-\]; none where no water flows (theory, eq. 104).
    pub(crate) fn time_error(&self, u: &[[f64; D]], stress: f64) -> Option<f64> {
        let (mut volume, mut squared, mut largest) = (0.0, 0.0, STRESS_SHARE * stress);
        for (place, (share, grown)) in self.shares.iter().zip(self.grown(u)).enumerate() {
            let change = share.by_volume(grown - share.expected);
            volume += share.volume;
            squared += share.volume * (0.5 * share.by_volume(share.stiffness) * change).powi(2);
            largest = largest.max((self.scale * self.value(place as u32, u)).abs());
        }
        let starts = self.seeping.iter().map(|seeping| seeping.start.abs());
        largest = starts.fold(largest, f64::max);
        (volume > 0.0 && largest > 0.0).then(|| (squared / volume).sqrt() / largest)
    }

    /// The water that nodal values `u` move; none where no water flows.
    fn water_moved(&self, stencils: &Stencils<D>, u: &[[f64; D]]) -> Option<WaterMoved> {
        if self.seeping.is_empty() {
            return None;
        }
        let expected: f64 = self.shares.iter().map(|share| share.expected).sum();
        let mut moved = WaterMoved {
            outflow: -self.of_rate * expected,
            ..WaterMoved::default()
        };
        for leak in &self.leaks {
            let share: f64 = leak.values.iter().map(|(_, value)| value).sum();
            moved.outflow += leak.conductance * share * self.pressure_at(leak, u);
        }
        for seeping in &self.seeping {
            let reach = stencils.with_hoops(seeping.particle as usize);
            moved.swelling += self.stretched(seeping.volume, reach, u).grows;
            moved.stored += seeping.stores * (self.pressed(seeping, u).mean - seeping.start);
        }
        Some(moved)
    }

    /// State of the pores after a step with nodal values `u`, where `given` is the given pore pressure by particle.
    pub(crate) fn accepted(
        &self,
        stencils: &Stencils<D>,
        u: &[[f64; D]],
        given: Vec<f64>,
    ) -> PoresAfter {
        PoresAfter {
            given,
            excess: self.excess_after(u),
            water_moved: self.water_moved(stencils, u),
        }
    }
}
