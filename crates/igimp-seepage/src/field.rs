//! The result of a flow: heads, pressures, velocities, discharges and the free surface.

mod sections;

use igimp_shape::Grid;

use crate::basis::{Basis, CORNERS, nodes_of};
use crate::curve::Relative;
use crate::ground::ends_of;
use crate::system::{Flows, System, largest};

/// Water through a condition or a section \[m³/s\], in the plane by the metre run \[m²/s\].
#[derive(Clone, Debug, PartialEq)]
pub struct Discharge {
    /// Its name.
    pub name: String,
    /// Water that enters the ground there; of a section the flow towards the positive axis.
    pub inflow: f64,
    /// Water that leaves the ground there; of a section none.
    pub outflow: f64,
}

/// A steady flow.
#[derive(Clone, Debug)]
pub struct Seepage<const D: usize> {
    /// The grid that it was solved on.
    pub grid: Grid<D>,
    /// Head by node \[m\]; beyond the ground that of the nearest soil.
    pub heads: Vec<f64>,
    /// Whether a node is a corner of a cell with soil.
    pub is_ground: Vec<bool>,
    /// Share that soil fills by cell \[-\].
    pub filled: Vec<f64>,
    /// Darcy velocity by cell \[m/s\], the mean over its soil; zero without soil.
    pub velocities: Vec<[f64; D]>,
    /// By condition, then `free water`, `open faces`, and by region.
    pub discharges: Vec<Discharge>,
    /// By section.
    pub sections: Vec<Discharge>,
    /// All that enters.
    pub inflow: f64,
    /// All that leaves.
    pub outflow: f64,
    /// All that leaves where the floor is a tenth of that asked for; none without a free surface.
    pub outflow_at_lower_floor: Option<f64>,
    /// Share of permeability that dry soil keeps \[-\].
    pub floor: f64,
    /// Height over which permeability falls \[m\].
    pub width: f64,
    /// Corrections that it took.
    pub corrections: usize,
    /// Largest imbalance of a node over all that enters; at rest over a tenth of the flow that its heads would drive through a cell \[-\].
    pub residual: f64,
    /// Number of heads.
    pub unknowns: usize,
    /// Whether all pores were taken to be full.
    pub confined: bool,
    /// Whether x is the radius of a body of revolution.
    pub axisymmetric: bool,
}

impl<const D: usize> Seepage<D> {
    pub(crate) fn of(
        system: &System<'_, D>,
        heads: &[f64],
        relative: Relative,
        (residual, flows, dry): (&[f64], &Flows, Option<&Flows>),
        corrections: usize,
    ) -> Self {
        let grid = system.grid.clone();
        let mut is_ground = vec![false; grid.node_count()];
        for &node in &system.nodes {
            is_ground[node] = true;
        }
        let through = Through::of(system, heads, &relative);
        let sum = |values: &[f64]| values.iter().sum::<f64>();
        let (inflow, outflow) = (sum(&flows.inwards), sum(&flows.outwards));
        Self {
            heads: by_node(system, heads),
            is_ground,
            filled: through.filled,
            velocities: through.velocities,
            discharges: discharges(system, flows),
            sections: sections::sections(system, heads, &relative),
            inflow,
            outflow,
            outflow_at_lower_floor: dry.map(|dry| sum(&dry.outwards)),
            floor: relative.floor,
            width: relative.width,
            corrections,
            residual: largest(residual) / system.scale(heads, flows, 0.0),
            unknowns: heads.len(),
            confined: relative.confined,
            axisymmetric: system.conditions.axisymmetric,
            grid,
        }
    }

    /// The head at a point \[m\]; beyond the grid that of its nearest place.
    pub fn head(&self, x: &[f64; D]) -> f64 {
        interpolated(&self.grid, &self.heads, x)
    }

    /// The pressure head ψ = h − z at a point \[m\], negative above the free surface.
    pub fn pressure_head(&self, x: &[f64; D]) -> f64 {
        self.head(x) - x[D - 1]
    }

    /// The level of the free surface on the upright line through a place \[m\]: the highest at which ψ = 0 in the cells of the
    /// ground; none where all of the line is dry.
    pub fn free_surface(&self, x: &[f64; D]) -> Option<f64> {
        let levels = self.grid.axes[D - 1].nodes();
        let at = |level: f64| {
            let mut place = *x;
            place[D - 1] = level;
            place
        };
        let mut upper: Option<[f64; 2]> = None;
        for &level in levels.iter().rev() {
            let place = at(level);
            let psi = self.pressure_head(&place);
            if psi >= 0.0 {
                return Some(match upper {
                    Some([above, dry]) => level + (above - level) * psi / (psi - dry),
                    None => level,
                });
            }
            upper = Some([level, psi]);
        }
        None
    }
}

/// Heads by node of the grid \[m\]; beyond the ground those of the nearest soil.
pub(crate) fn by_node<const D: usize>(system: &System<'_, D>, heads: &[f64]) -> Vec<f64> {
    let mut all = vec![f64::NAN; system.grid.node_count()];
    for (&node, &head) in std::iter::zip(&system.nodes, heads) {
        all[node] = head;
    }
    extend(system.grid, &mut all);
    all
}

/// The head at a point from those of nodes \[m\]; beyond the grid that of its nearest place.
pub(crate) fn interpolated<const D: usize>(grid: &Grid<D>, heads: &[f64], x: &[f64; D]) -> f64 {
    let (lower, upper) = grid.bounds();
    let x = std::array::from_fn(|axis| x[axis].max(lower[axis]).min(upper[axis]));
    let Some(place) = grid.cell_at(&x) else {
        return f64::NAN;
    };
    let basis = Basis::at(ends_of(grid, place), &x);
    let mut corners = [0.0; CORNERS];
    for (k, node) in nodes_of(grid, place).enumerate() {
        corners[k] = heads[node];
    }
    basis.head(&corners)
}

/// The flow through cells.
struct Through<const D: usize> {
    filled: Vec<f64>,
    velocities: Vec<[f64; D]>,
}

impl<const D: usize> Through<D> {
    fn of(system: &System<'_, D>, heads: &[f64], relative: &Relative) -> Self {
        let grid = system.grid;
        let mut found = Self {
            filled: vec![0.0; grid.cell_count()],
            velocities: vec![[0.0; D]; grid.cell_count()],
        };
        for cell in 0..system.cells.len() {
            let place = system.cells[cell].place;
            let corners = system.heads(cell, heads);
            let (mut sum, mut volume) = ([0.0; D], 0.0);
            for point in system.points(cell, &corners, relative) {
                let velocity = system.velocity(cell, &point, &corners, relative);
                volume += point.volume;
                for axis in 0..D {
                    sum[axis] += point.volume * velocity[axis];
                }
            }
            found.filled[grid.cell_index(place)] = system.cells[cell].filled;
            found.velocities[grid.cell_index(place)] = sum.map(|sum| sum / volume);
        }
        found
    }
}

/// Flows with the names of the conditions that let them in.
fn discharges<const D: usize>(system: &System<'_, D>, flows: &Flows) -> Vec<Discharge> {
    let conditions = system.conditions;
    let names = (conditions.faces.iter().map(|face| face.name.as_str()))
        .chain(["free water", "open faces"])
        .chain(conditions.regions.iter().map(|region| region.name.as_str()));
    let of = |(k, name): (usize, &str)| Discharge {
        name: name.to_owned(),
        inflow: flows.inwards[k],
        outflow: flows.outwards[k],
    };
    names.enumerate().map(of).collect()
}

/// Gives nodes beyond the ground the mean of their neighbours, outwards from it.
fn extend<const D: usize>(grid: &Grid<D>, heads: &mut [f64]) {
    let mut open: Vec<usize> = (0..heads.len()).filter(|&k| heads[k].is_nan()).collect();
    while !open.is_empty() {
        let mut found = Vec::new();
        for &node in &open {
            let place = grid.node_place(node);
            let (mut sum, mut count) = (0.0, 0.0);
            for axis in 0..D {
                for step in [-1, 1] {
                    let mut beside = place;
                    let Some(next) = beside[axis].checked_add_signed(step) else {
                        continue;
                    };
                    if next >= grid.axes[axis].node_count() {
                        continue;
                    }
                    beside[axis] = next;
                    let head = heads[grid.node_index(beside)];
                    if !head.is_nan() {
                        sum += head;
                        count += 1.0;
                    }
                }
            }
            if count > 0.0 {
                found.push((node, sum / count));
            }
        }
        if found.is_empty() {
            return;
        }
        for &(node, head) in &found {
            heads[node] = head;
        }
        open.retain(|&node| heads[node].is_nan());
    }
}
