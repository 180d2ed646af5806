//! Every node's share of the body: volume and mass.

use igimp_shape::Grid;
use rayon::prelude::*;

use crate::body::particles::Particles;
use crate::method::Section;
use crate::step::strips::{Strips, split};
use crate::step::supports::Supports;

/// A node's share of the body.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NodeShare {
    /// Σ S V, over the thickness of the section \[length^D\].
    pub(crate) volume: f64,
    /// Σ S m \[mass\].
    pub(crate) mass: f64,
    /// Whether any particle has it among its supports, if only by its gradient.
    pub(crate) is_touched: bool,
}

/// Sums volume and mass into the nodes.
pub(crate) fn node_shares<const D: usize>(
    grid: &Grid<D>,
    particles: &Particles<D>,
    supports: &Supports<D>,
    strips: &Strips,
    section: Section,
) -> Vec<NodeShare> {
    let mut shares = vec![NodeShare::default(); grid.node_count()];
    for parity in 0..2 {
        let half = strips.of_parity(parity);
        let slices = split(&mut shares, half.clone().map(|(nodes, _)| nodes.clone()));
        let tasks: Vec<_> = half.zip(slices).collect();
        tasks.into_par_iter().for_each(|((nodes, slots), slice)| {
            for &particle in &strips.order()[slots.clone()] {
                let particle = particle as usize;
                let thickness = section.thickness(particles.x[particle][0]);
                let volume = particles.volume(particle) / thickness;
                let mass = particles.mass[particle];
                for support in supports.of(particle) {
                    let share = &mut slice[support.node - nodes.start];
                    share.volume += support.value * volume;
                    share.mass += support.value * mass;
                    share.is_touched = true;
                }
            }
        });
    }
    shares
}
