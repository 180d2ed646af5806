//! Runs below the case files: bodies on grids of any dimension, driven by programs that prescribe
//! every node as they please.

use std::ops::ControlFlow;
use std::time::Instant;

use igimp_assembly::{Method, ParticleSeed};
use igimp_linear::SolverKind;
use igimp_shape::{Axis, Grid, ShapeError};
use igimp_solver::{
    Accepted, Body, LoadPath, MarchReport, MarchSettings, Observer, Workspace, march,
};

use crate::harness::study::RunRecord;

/// A grid of equal cells from the origin, `cells[d]` along axis d, of size `cell` \[length\].
pub(crate) fn grid_of<const D: usize>(cell: f64, cells: [usize; D]) -> Result<Grid<D>, ShapeError> {
    let mut axes = Vec::new();
    for count in cells {
        axes.push(Axis::uniform(0.0, cell, count)?);
    }
    let mut axes = axes.into_iter();
    Ok(Grid::new(std::array::from_fn(|_| {
        axes.next().expect("an axis for each direction")
    })))
}

/// `per_direction`^D particles of unit density in every cell of a grid, the middles of equal parts.
pub(crate) fn filled<const D: usize>(grid: &Grid<D>, per_direction: usize) -> Vec<ParticleSeed<D>> {
    let cells: [usize; D] = std::array::from_fn(|axis| grid.axes[axis].cell_count());
    let parts = per_direction.pow(D as u32);
    let mut seeds = Vec::new();
    for cell in 0..grid.cell_count() {
        let place: [usize; D] = digits(cell, cells);
        let lower = grid.node_position(grid.node_index(place));
        let size = grid
            .cell_size(place)
            .map(|size| size / per_direction as f64);
        for part in 0..parts {
            let step: [usize; D] = digits(part, [per_direction; D]);
            seeds.push(ParticleSeed {
                x: std::array::from_fn(|axis| lower[axis] + (step[axis] as f64 + 0.5) * size[axis]),
                half_length: size.map(|size| 0.5 * size),
                volume: size.iter().product(),
                density: 1.0,
                law: 0,
                centroid: [0.0; _],
            });
        }
    }
    seeds
}

/// The digits of a number to mixed bases, the first running fastest.
fn digits<const D: usize>(mut number: usize, bases: [usize; D]) -> [usize; D] {
    bases.map(|base| {
        let digit = number % base;
        number /= base;
        digit
    })
}

/// Marches a body from load factor 0 to 1 in so many steps and describes the run.
pub(crate) fn run<const D: usize>(
    variant: impl Into<String>,
    body: &mut Body<D>,
    method: &Method,
    settings: &MarchSettings,
    load_path: &dyn LoadPath<D>,
    observer: &mut dyn Observer<D>,
) -> (RunRecord, MarchReport) {
    let clock = Instant::now();
    let mut workspace = Workspace::new(SolverKind::Auto.build());
    let report = march(body, method, load_path, settings, &mut workspace, observer);
    (RunRecord::new(variant, &report, clock.elapsed()), report)
}

/// An observer that looks at nothing.
pub(crate) fn unobserved<const D: usize>(_: &Accepted<'_, D>) -> ControlFlow<()> {
    ControlFlow::Continue(())
}
