//! Consolidation: water that flows out of soil while a step takes time, with excess pore pressure among the unknowns (theory,
//! eqs. 97 to 104).
//!
//! Soil sees the mean of the pressure over cells, as its dilatation is that of cells (B-bar). Pressure that a cell mean does not see is
//! held by the projection of Dohrmann and Bochev (2004), in the form of White and Borja (2008): with 1/(2G) there is nothing
//! to choose. Terms of a particle go into the matrix with its tangent; those of an opening are nodal forces like others.

mod after;
mod faces;
mod gathering;

use igimp_shape::Support;

use crate::body::particles::Particles;
use crate::conditions::StepConditions;
use crate::contributions::nodal_forces::{AddBlock, NodalForces};
use crate::step::hoops::Hoop;
use crate::step::stencils::Stencils;
use after::Share;
pub use after::{PoresAfter, WaterMoved};
pub(crate) use gathering::least_side;
use igimp_shape::matrices::{determinant, identity, inverse, transpose_apply};

/// Marks a node of the grid without a pressure, and a particle that water does not flow through.
const NONE: u32 = u32::MAX;

/// Values of a pressure at a particle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PressureSupport<const D: usize> {
    /// Number of the pressure.
    place: u32,
    /// Its node of the grid.
    pub(crate) node: u32,
    /// Its mean over the cells of the particle, S̄ \[-\].
    mean: f64,
    /// By how much its value at the particle is more, S − S̄ \[-\].
    bulge: f64,
    /// Its gradient, ∇S \[1/length\].
    grad: [f64; D],
}

/// A particle that water flows through.
#[derive(Clone, Copy, Debug)]
struct Seeping<const D: usize> {
    particle: u32,
    /// First of its supports, and how many there are.
    first: u32,
    len: u32,
    /// Volume at the start of the step \[length^D\].
    volume: f64,
    /// Excess pore pressure at the start \[force/length²\].
    start: f64,
    /// Volume by softness of the water, V n/K_w \[length^D·length²/force\].
    stores: f64,
    /// Volume by softness of the soil, V/(2G) \[length^D·length²/force\].
    projects: f64,
    /// Water by gradient of pressure that flows during the step, V Δt k/γ_w by its weight \[length^(D+4)/force\].
    flows: [[f64; D]; D],
    /// Water at the start, and its growth at the rate of the step before \[length^D\].
    held: f64,
    /// By how much the pressure at the particle was more than its mean, by `projects` \[length^D\].
    held_within: f64,
}

/// How nodal values press on the water of a particle.
#[derive(Clone, Copy, Debug)]
struct Pressed<const D: usize> {
    /// Mean excess pressure \[force/length²\].
    mean: f64,
    /// By how much the pressure at the particle is more \[force/length²\].
    bulge: f64,
    /// Gradient of the pressure \[force/length³\].
    grad: [f64; D],
}

/// An opening, by the pressures that it sees.
#[derive(Clone, Debug)]
struct Leak {
    /// Numbers of pressures with their shares of the one at the opening.
    values: Vec<(u32, f64)>,
    /// Water that leaves during the step by pressure \[length^D·length²/force\].
    conductance: f64,
}

/// Excess pore pressure as an unknown; empty where no water flows.
#[derive(Debug, Default)]
pub(crate) struct Consolidation<const D: usize> {
    /// The node that stands for the first pressure.
    first: usize,
    /// Pressure over the unknown, which is a length \[force/length³\].
    scale: f64,
    seeping: Vec<Seeping<D>>,
    supports: Vec<PressureSupport<D>>,
    /// By particle: its place in `seeping`.
    place_of: Vec<u32>,
    /// By pressure: its soil.
    shares: Vec<Share>,
    /// By pressure: its node of the grid.
    nodes: Vec<usize>,
    leaks: Vec<Leak>,
    /// Weight of the rate of the step before \[-\].
    of_rate: f64,
    duration: f64,
    finite: bool,
}

/// The nodes of the grid that seeping particles touch; none where no water flows.
pub(crate) fn pressure_nodes<const D: usize>(
    particles: &Particles<D>,
    stencils: &Stencils<D>,
    conditions: &StepConditions<D>,
) -> Vec<bool> {
    let Some(flow) = &conditions.flow else {
        return Vec::new();
    };
    let mut has_scalar = vec![false; conditions.grid.node_count()];
    for particle in 0..particles.len() {
        if flow.permeable(particles.law[particle]).is_some() {
            for support in stencils.of(particle) {
                has_scalar[support.node] = true;
            }
        }
    }
    has_scalar
}

/// Water of a particle at some nodal values: the forces of its pressures, and the derivative.
pub(crate) struct WaterOfParticle<'c, const D: usize> {
    scale: f64,
    seeping: &'c Seeping<D>,
    supports: &'c [PressureSupport<D>],
    pressed: Pressed<D>,
    /// By how much it grows \[length^D\].
    grows: f64,
    /// Its volume then \[length^D\].
    volume: f64,
    /// The push-forward of gradients.
    push: [[f64; D]; D],
    /// How its supports stretch it around the axis, and the push-forward of that; none unless the section is axisymmetric.
    hoops: &'c [Hoop],
    push_around: f64,
}

/// How displacements change the volume of a particle.
struct Stretched<const D: usize> {
    /// By how much it grows \[length^D\].
    grows: f64,
    /// Its volume then \[length^D\].
    volume: f64,
    /// The push-forward of gradients, and of the strain around the axis.
    push: [[f64; D]; D],
    push_around: f64,
}

impl<const D: usize> Consolidation<D> {
    fn supports_of(&self, seeping: &Seeping<D>) -> &[PressureSupport<D>] {
        &self.supports[seeping.first as usize..][..seeping.len as usize]
    }

    #[inline]
    fn seeping_at(&self, particle: usize) -> Option<&Seeping<D>> {
        let place = self.place_of.get(particle).filter(|&&place| place != NONE);
        Some(&self.seeping[*place? as usize])
    }

    /// The mean excess pore pressure of a particle at nodal values `u`; none where water does not flow \[force/length²\].
    #[inline]
    pub(crate) fn pressure(&self, particle: usize, u: &[[f64; D]]) -> Option<f64> {
        let supports = self.supports_of(self.seeping_at(particle)?).iter();
        let sum: f64 = supports.map(|s| s.mean * self.value(s.place, u)).sum();
        Some(self.scale * sum)
    }

    #[inline]
    fn value(&self, place: u32, u: &[[f64; D]]) -> f64 {
        u[self.first + place as usize][0]
    }

    #[inline]
    fn pressed(&self, seeping: &Seeping<D>, u: &[[f64; D]]) -> Pressed<D> {
        let mut pressed = Pressed {
            mean: 0.0,
            bulge: 0.0,
            grad: [0.0; D],
        };
        for support in self.supports_of(seeping) {
            let pressure = self.scale * self.value(support.place, u);
            pressed.mean += support.mean * pressure;
            pressed.bulge += support.bulge * pressure;
            for (sum, grad) in pressed.grad.iter_mut().zip(support.grad) {
                *sum += grad * pressure;
            }
        }
        pressed
    }

    /// The pressure at an opening \[force/length²\].
    fn pressure_at(&self, leak: &Leak, u: &[[f64; D]]) -> f64 {
        let values = leak.values.iter();
        let sum: f64 = values
            .map(|&(place, value)| value * self.value(place, u))
            .sum();
        self.scale * sum
    }

    /// How nodal displacements `u` change the volume of a particle.
    #[inline]
    fn stretched(
        &self,
        volume: f64,
        (supports, hoops): (&[Support<D>], &[Hoop]),
        u: &[[f64; D]],
    ) -> Stretched<D> {
        let mut gradient = [[0.0; D]; D];
        for support in supports {
            for a in 0..D {
                for b in 0..D {
                    gradient[a][b] += u[support.node][a] * support.grad_bar[b];
                }
            }
        }
        let around = if hoops.is_empty() {
            0.0
        } else {
            Hoop::strain(supports, hoops, u).bar
        };
        if !self.finite {
            let trace: f64 = (0..D).map(|a| gradient[a][a]).sum();
            return Stretched {
                grows: volume * (trace + around),
                volume,
                push: identity(),
                push_around: 1.0,
            };
        }
        for (a, row) in gradient.iter_mut().enumerate() {
            row[a] += 1.0;
        }
        let det = determinant(&gradient);
        let ratio = det * (1.0 + around);
        Stretched {
            grows: volume * (ratio - 1.0),
            volume: volume * ratio,
            push: inverse(&gradient, det),
            push_around: (1.0 + around).recip(),
        }
    }

    /// The water of a particle with the `supports` of its displacement at nodal values `u`; none where water does not flow.
    #[inline]
    pub(crate) fn of_particle<'c>(
        &'c self,
        particle: usize,
        (supports, hoops): (&[Support<D>], &'c [Hoop]),
        u: &[[f64; D]],
    ) -> Option<WaterOfParticle<'c, D>> {
        let seeping = self.seeping_at(particle)?;
        let Stretched {
            grows,
            volume,
            push,
            push_around,
        } = self.stretched(seeping.volume, (supports, hoops), u);
        Some(WaterOfParticle {
            scale: self.scale,
            seeping,
            supports: self.supports_of(seeping),
            pressed: self.pressed(seeping, u),
            grows,
            volume,
            push,
            hoops,
            push_around,
        })
    }
}

impl<const D: usize> WaterOfParticle<'_, D> {
    /// Its pressures, in the order of the supports of displacement.
    #[inline]
    pub(crate) fn pressures(&self) -> &[PressureSupport<D>] {
        self.supports
    }

    /// The gradients of its dilatation by displacement of its supports, pushed forward (theory, eq. 130f) \[1/length\].
    #[inline]
    pub(crate) fn slopes<'s>(
        &'s self,
        supports: &'s [Support<D>],
    ) -> impl Iterator<Item = [f64; D]> + 's {
        supports.iter().enumerate().map(|(place, support)| {
            let mut slope = transpose_apply(&self.push, &support.grad_bar);
            if let Some(hoop) = self.hoops.get(place) {
                slope[0] += self.push_around * hoop.bar;
            }
            slope
        })
    }

    /// Adds the forces of its pressures to those of the pressures from the number `first` on.
    #[inline]
    pub(crate) fn add_forces(&self, first: usize, forces: &mut [[f64; D]]) {
        let (seeping, pressed) = (self.seeping, &self.pressed);
        let flows = flow(&seeping.flows, &pressed.grad);
        let mean = seeping.stores * pressed.mean - seeping.held + self.grows;
        let bulge = seeping.projects * pressed.bulge - seeping.held_within;
        for support in self.supports {
            let mut water = support.mean * mean + support.bulge * bulge;
            for a in 0..D {
                water += support.grad[a] * flows[a];
            }
            forces[support.place as usize - first][0] -= self.scale * water;
        }
    }

    /// Change of the water of pressure `row` with displacement of a node, ∂f/∂u over the pushed gradient of the node: the
    /// same the other way round.
    #[inline]
    pub(crate) fn coupling(&self, row: &PressureSupport<D>) -> f64 {
        -self.scale * self.volume * row.mean
    }

    /// The water that pressure `column` moves at pressure `row`, ∂f/∂p.
    #[inline]
    pub(crate) fn moves(&self, row: &PressureSupport<D>, column: &PressureSupport<D>) -> f64 {
        let flows = flow(&self.seeping.flows, &column.grad);
        let mut water = self.seeping.stores * row.mean * column.mean
            + self.seeping.projects * row.bulge * column.bulge;
        for a in 0..D {
            water += row.grad[a] * flows[a];
        }
        -self.scale * self.scale * water
    }

    /// Adds the forces K_fp u_p of its pressures that `moved`, by node and axis, causes, to forces by pressure.
    pub(crate) fn add_force_of_motion(
        &self,
        supports: &[Support<D>],
        moved: &dyn Fn(usize, usize) -> f64,
        add: &mut dyn FnMut(usize, f64),
    ) {
        for (support, slope) in supports.iter().zip(self.slopes(supports)) {
            let along: f64 = (0..D)
                .map(|axis| slope[axis] * moved(support.node, axis))
                .sum();
            for pressure in self.supports {
                add(pressure.place as usize, self.coupling(pressure) * along);
            }
        }
    }
}

/// The water that a gradient of pressure moves.
#[inline]
fn flow<const D: usize>(flows: &[[f64; D]; D], grad: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|a| (0..D).map(|b| flows[a][b] * grad[b]).sum())
}

impl<const D: usize> NodalForces<D> for Consolidation<D> {
    fn pairs(&self) -> Vec<(usize, usize)> {
        let node = |&(place, _): &(u32, f64)| self.nodes[place as usize];
        let of = |leak: &Leak| -> Vec<(usize, usize)> {
            let columns = leak.values.iter();
            columns
                .flat_map(|column| leak.values.iter().map(move |row| (node(column), node(row))))
                .collect()
        };
        self.leaks.iter().flat_map(of).collect()
    }

    fn is_symmetric(&self) -> bool {
        true
    }

    fn add(&self, u: &[[f64; D]], f: &mut [[f64; D]], mut blocks: Option<&mut AddBlock<'_, D>>) {
        for leak in &self.leaks {
            let water = leak.conductance * self.pressure_at(leak, u);
            for &(row, value) in &leak.values {
                let row = self.first + row as usize;
                f[row][0] -= self.scale * value * water;
                let Some(blocks) = &mut blocks else { continue };
                for &(column, other) in &leak.values {
                    let mut block = [[0.0; D]; D];
                    block[0][0] = -self.scale * self.scale * leak.conductance * value * other;
                    blocks(row, self.first + column as usize, &block);
                }
            }
        }
    }
}
