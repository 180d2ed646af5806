//! Water that the ground stores, lumped at nodes (theory, eqs. 85a and 85b).

use std::collections::{BTreeMap, BTreeSet};

use igimp_linear::TangentMatrix;

use crate::basis::Basis;
use crate::curve::Relative;
use crate::ground::ends_of;
use crate::system::System;

/// Volumes of soil at nodes.
#[derive(Debug)]
pub(crate) struct Storage {
    /// By unknown and soil, in their order: the volume of the soil \[m^D\].
    shares: Vec<(usize, usize, f64)>,
    /// Elevation by unknown \[m\].
    levels: Vec<f64>,
}

/// Digits that heads and volumes of water do not have \[-\].
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

/// Pressure head at which a node is taken to be at the free surface, over the height in which permeability falls \[-\].
const NEAR: f64 = 1e-6;

/// Distance from such a node at which another counts as away from it, over that \[-\].
const AWAY: f64 = 2.0;

/// Flow into or out of storage \[m^D/s\].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Moved {
    /// At all nodes together.
    pub(crate) rate: f64,
    /// Largest round-off of it at a node.
    pub(crate) round_off: f64,
    /// Round-off at all nodes.
    pub(crate) all_round_off: f64,
}

/// A step by the method of Euler, from a volume of water at each node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Storing<'a> {
    pub(crate) storage: &'a Storage,
    /// Volume of water by unknown as it begins \[m^D\].
    pub(crate) before: &'a [f64],
    /// Its duration \[s\].
    pub(crate) duration: f64,
}

impl Storage {
    pub(crate) fn of<const D: usize>(system: &System<'_, D>) -> Self {
        let mut volumes = BTreeMap::new();
        for (index, cell) in system.cells.iter().enumerate() {
            let ends = ends_of(system.grid, cell.place);
            let corners = &system.corners[index][..1 << D];
            if let Some(soil) = cell.whole {
                let volume: f64 = system.grid.cell_size(cell.place).iter().product();
                for (k, &unknown) in corners.iter().enumerate() {
                    // A third into the cell from its corner the thickness is the mean of it by the values of the node.
                    let [near, far] = [ends[k & 1][0], ends[1 - (k & 1)][0]];
                    let thick = system.conditions.thickness((2.0 * near + far) / 3.0);
                    let part = volume / corners.len() as f64 * thick;
                    *volumes.entry((unknown, soil)).or_insert(0.0) += part;
                }
                continue;
            }
            for point in &cell.points {
                let basis = Basis::at(ends, &point.x);
                for (k, &unknown) in corners.iter().enumerate() {
                    *volumes.entry((unknown, point.body_soil)).or_insert(0.0) +=
                        point.volume * basis.value[k];
                }
            }
        }
        let level = |&node: &usize| system.grid.node_position(node)[D - 1];
        Self {
            shares: (volumes.into_iter())
                .map(|((unknown, soil), volume)| (unknown, soil, volume))
                .collect(),
            levels: system.nodes.iter().map(level).collect(),
        }
    }

    /// Volume of water by unknown \[m^D\] and its slope \[m^(D−1)\].
    pub(crate) fn water<const D: usize>(
        &self,
        system: &System<'_, D>,
        heads: &[f64],
        relative: &Relative,
    ) -> [Vec<f64>; 2] {
        let mut found = [vec![0.0; heads.len()], vec![0.0; heads.len()]];
        for &(unknown, soil, volume) in &self.shares {
            let psi = heads[unknown] - self.levels[unknown];
            let [content, slope] = relative.content(&system.conditions.soils[soil].pores(), psi);
            found[0][unknown] += volume * content;
            found[1][unknown] += volume * slope;
        }
        found
    }

    /// The soils that store water, by index.
    pub(crate) fn soils(&self) -> BTreeSet<usize> {
        self.shares.iter().map(|(_, soil, _)| *soil).collect()
    }

    /// The pressure head of an unknown \[m\].
    pub(crate) fn pressure_head(&self, unknown: usize, head: f64) -> f64 {
        head - self.levels[unknown]
    }

    /// Stops a correction at nodes that the free surface would pass, where water drains most by head: on either side of it
    /// hardly any does, and corrections would go to and fro. Under a sharp surface also where the last water drains.
    pub(crate) fn stop_at_surface(
        &self,
        before: &[f64],
        after: &mut [f64],
        (relative, is_sharp): (&Relative, bool),
    ) {
        let near = NEAR * relative.width;
        // A node that stands where it was stopped goes on: round-off does not hold it there.
        let off = AWAY * near;
        let passes = |from: f64, to: f64| (from > off && to < -near) || (from < -off && to > near);
        for (k, head) in after.iter_mut().enumerate() {
            let [from, to] = [before[k], *head].map(|head| self.pressure_head(k, head));
            let empty = -0.5 * relative.width;
            if is_sharp && from < empty && passes(from - empty, to - empty) {
                *head = self.levels[k] + empty;
            } else if passes(from, to) {
                *head = self.levels[k] - near;
            } else if is_sharp && passes(from - empty, to - empty) {
                *head = self.levels[k] + empty;
            }
        }
    }

    /// The slope of the water of an unknown where the last of it drains under a sharp surface, towards the side that an
    /// imbalance drives it to; none elsewhere.
    fn slope_at_end<const D: usize>(
        &self,
        system: &System<'_, D>,
        (unknown, head): (usize, f64),
        relative: &Relative,
        gathers: bool,
    ) -> Option<f64> {
        let psi = self.pressure_head(unknown, head);
        let near = AWAY * NEAR * relative.width;
        if relative.confined || (psi + 0.5 * relative.width).abs() > near {
            return None;
        }
        let beside = psi + if gathers { 2.0 * near } else { -2.0 * near };
        let first = self.shares.partition_point(|share| share.0 < unknown);
        let rest = self.shares[first..].iter();
        let of_soil = |&(_, soil, volume): &(usize, usize, f64)| {
            volume * relative.content(&system.conditions.soils[soil].pores(), beside)[1]
        };
        Some(rest.take_while(|s| s.0 == unknown).map(of_soil).sum())
    }

    /// Volume of soil by unknown, each soil times a share \[m^D\].
    pub(crate) fn volumes(&self, share: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut found = vec![0.0; self.levels.len()];
        for &(unknown, soil, volume) in &self.shares {
            found[unknown] += volume * share(soil);
        }
        found
    }
}

impl Storing<'_> {
    /// Adds the flow into storage to a residual \[m^D/s\], its slope to the tangent.
    pub(crate) fn add<const D: usize>(
        &self,
        system: &System<'_, D>,
        (heads, relative): (&[f64], &Relative),
        residual: &mut [f64],
        matrix: Option<&mut TangentMatrix>,
    ) -> Moved {
        let [water, slopes] = self.storage.water(system, heads, relative);
        let mut moved = Moved::default();
        for (unknown, stored) in water.iter().enumerate() {
            let rate = (stored - self.before[unknown]) / self.duration;
            residual[unknown] += rate;
            moved.rate += rate.abs();
            let size = stored.abs() + slopes[unknown] * heads[unknown].abs();
            let round_off = ROUND_OFF * size / self.duration;
            moved.round_off = moved.round_off.max(round_off);
            moved.all_round_off += round_off;
        }
        let Some(matrix) = matrix else { return moved };
        let TangentMatrix {
            pattern, values, ..
        } = matrix;
        for (unknown, slope) in slopes.iter().enumerate() {
            let at = (unknown, heads[unknown]);
            let gathers = residual[unknown] < 0.0;
            let at_end = (self.storage).slope_at_end(system, at, relative, gathers);
            let slope = at_end.unwrap_or(*slope);
            let rows = pattern.coupled_to(unknown);
            let place = rows.partition_point(|row| (*row as usize) < unknown);
            values[pattern.first_value[unknown] + place] += slope / self.duration;
        }
        moved
    }
}
