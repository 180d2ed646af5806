//! Discharges of sections, in balance with the exchange of the cells beside them (theory, eqs. 84a and 84b).

use crate::basis::{CORNERS, Point};
use crate::boundary::reach;
use crate::conditions::Extent;
use crate::curve::Relative;
use crate::ground::{SUB, ends_of};
use crate::system::{Source, System};

use super::Discharge;

/// Faces whose normal has this component along an axis lie across it \[-\].
const ACROSS: f64 = 0.99;
/// Share of a cell within which a face lies on a section \[-\].
const ON: f64 = 1e-4;
/// Half-lengths below this share of a cell are none \[-\].
const NONE: f64 = 1e-9;

/// The flow through each section that is asked for, towards the positive axis.
pub(crate) fn sections<const D: usize>(
    system: &System<'_, D>,
    heads: &[f64],
    relative: &Relative,
) -> Vec<Discharge> {
    let passes = |(name, extent): &(String, Extent<D>)| {
        let axis = (0..D).find(|&axis| extent.upper[axis] <= extent.lower[axis]);
        let through = |axis| through(system, (extent, axis), heads, relative);
        Discharge {
            name: name.clone(),
            inflow: axis.map_or(0.0, through),
            outflow: 0.0,
        }
    };
    system.conditions.sections.iter().map(passes).collect()
}

/// The flow through a section across an axis \[m^D/s\]. On a line of the grid the cells on either side give half of it each.
fn through<const D: usize>(
    system: &System<'_, D>,
    (extent, axis): (&Extent<D>, usize),
    heads: &[f64],
    relative: &Relative,
) -> f64 {
    let (at, reach) = (extent.lower[axis], reach(system.grid));
    let mut sum = 0.0;
    for cell in 0..system.cells.len() {
        let [lower, upper] = ends_of(system.grid, system.cells[cell].place);
        if at < lower[axis] - reach || at > upper[axis] + reach {
            continue;
        }
        let cut = Cut {
            ends: [lower, upper],
            extent,
            axis,
            at,
        };
        let passing = cut.passes(system, cell, &system.heads(cell, heads), relative);
        let is_on_line = (at - lower[axis]).abs() <= reach || (at - upper[axis]).abs() <= reach;
        sum += if is_on_line {
            0.5 * (passing.inside + passing.at_face)
        } else {
            passing.inside
        };
    }
    sum
}

/// A cell that a section crosses.
struct Cut<'a, const D: usize> {
    ends: [[f64; D]; 2],
    extent: &'a Extent<D>,
    axis: usize,
    at: f64,
}

/// The flow through the part of a section in a cell \[m^D/s\].
struct Passing {
    inside: f64,
    /// Its share through faces of the ground that lie on the section.
    at_face: f64,
}

impl<const D: usize> Cut<'_, D> {
    /// The mean flow through the part of the cell, and its share of the other flow of the whole cell (eq. 84a).
    fn passes(
        &self,
        system: &System<'_, D>,
        cell: usize,
        heads: &[f64; CORNERS],
        relative: &Relative,
    ) -> Passing {
        let thick = self.ends[1][self.axis] - self.ends[0][self.axis];
        let flow = |point: &Point<D>| {
            let velocity = system.velocity(cell, point, heads, relative);
            point.volume * velocity[self.axis] / thick
        };
        let all = system.points(cell, heads, relative);
        let whole: [f64; 2] = all.iter().fold([0.0; 2], |[volume, mean], point| {
            [volume + point.volume, mean + flow(point)]
        });
        let mut part = [0.0; 2];
        if let Some(soil) = system.cells[cell].whole {
            if let Some(clipped) = self.clipped() {
                for point in system.points_of_part((self.ends, soil), clipped, heads, relative) {
                    part[0] += point.volume;
                    part[1] += flow(&point);
                }
            }
        } else {
            for point in &all {
                let share = self.covered(system, &point.x);
                part[0] += share * point.volume;
                part[1] += share * flow(point);
            }
        }
        if part[0] <= 0.0 {
            return Passing {
                inside: 0.0,
                at_face: 0.0,
            };
        }
        let share = part[0] / whole[0];
        let (leaves, sources) = system.exchange(cell, heads, relative);
        let lower = (0..1 << D).filter(|corner| corner >> self.axis & 1 == 0);
        let at_lower: f64 = lower.map(|corner| leaves[corner]).sum();
        let before: f64 = (sources.iter())
            .map(|source| source.inflow * self.before(source))
            .sum();
        let on = sources.iter().filter(|source| self.is_on(source));
        let at_face: f64 = on.map(|s| -s.normal[self.axis] * s.inflow).sum();
        Passing {
            inside: part[1] + share * (at_lower + before - whole[1]),
            at_face: share * at_face,
        }
    }

    /// The part of the cell that the section crosses.
    fn clipped(&self) -> Option<[[f64; D]; 2]> {
        let [mut lower, mut upper] = self.ends;
        for d in (0..D).filter(|d| *d != self.axis) {
            lower[d] = lower[d].max(self.extent.lower[d]);
            upper[d] = upper[d].min(self.extent.upper[d]);
        }
        { 0..D }
            .all(|d| lower[d] < upper[d])
            .then_some([lower, upper])
    }

    /// Half of the length along an axis of the soil around a place in its part of a cell.
    fn half(&self, x: &[f64; D], axis: usize) -> f64 {
        let count = SUB[D - 2] as f64;
        let [lower, upper] = [self.ends[0][axis], self.ends[1][axis]];
        let size = (upper - lower) / count;
        let from = lower + size * ((x[axis] - lower) / size).floor().clamp(0.0, count - 1.0);
        (x[axis] - from).min(from + size - x[axis]).max(0.0)
    }

    /// The share of the soil around a place that the section crosses.
    fn covered(&self, system: &System<'_, D>, x: &[f64; D]) -> f64 {
        let share = |d: usize| {
            let half = self.half(x, d);
            let [from, to] = [x[d] - half, x[d] + half];
            let (lower, upper) = (self.extent.lower[d], self.extent.upper[d]);
            if half <= NONE * (self.ends[1][d] - self.ends[0][d]) {
                return f64::from(lower <= x[d] && x[d] <= upper);
            }
            let [a, b] = [from.max(lower), to.min(upper)];
            let linear = (b - a).max(0.0) / (to - from);
            if d > 0 {
                return linear;
            }
            let thick = |x: f64| system.conditions.thickness(x);
            linear * thick(0.5 * (a + b)) / thick(x[0])
        };
        (0..D).filter(|d| *d != self.axis).map(share).product()
    }

    /// Whether water enters through a face on the section.
    fn is_on(&self, source: &Source<D>) -> bool {
        let size = self.ends[1][self.axis] - self.ends[0][self.axis];
        source.normal[self.axis].abs() > ACROSS
            && (source.x[self.axis] - self.at).abs() <= ON * size
    }

    /// The share of the water that enters the cell before it comes to the section.
    fn before(&self, source: &Source<D>) -> f64 {
        let (normal, x) = (source.normal[self.axis], source.x[self.axis]);
        if self.is_on(source) {
            return f64::from(normal < 0.0);
        }
        let along = (1.0 - normal * normal).max(0.0).sqrt();
        let half = along * self.half(&source.x, self.axis);
        if half <= NONE * (self.ends[1][self.axis] - self.ends[0][self.axis]) {
            return f64::from(x < self.at);
        }
        (0.5 + 0.5 * (self.at - x) / half).clamp(0.0, 1.0)
    }
}
