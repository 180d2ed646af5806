//! Conditions at the faces of the ground: that of a box, free water, or none that is stated.

use igimp_shape::Grid;

use crate::conditions::{Conditions, FreeWater, OnFaces};
use crate::ground::{Cell, Facet};

/// Faces that rise less than this are upright or hang over \[-\].
const UPRIGHT: f64 = 1e-6;

/// The condition at a facet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum At {
    /// This head \[m\].
    Head(f64),
    /// So much enters \[m/s\].
    Inflow(f64),
    /// So much rain \[m/s\], and water may come out.
    Open(f64),
    Closed,
}

/// A facet with its condition, and the owner of that.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Held<const D: usize> {
    pub(crate) cell: usize,
    pub(crate) facet: Facet<D>,
    pub(crate) at: At,
    /// By condition on faces; then free water, and faces of which nothing is said.
    pub(crate) owner: usize,
}

/// How far beyond a box a face still counts as within it \[m\]: round-off.
pub(crate) fn reach<const D: usize>(grid: &Grid<D>) -> f64 {
    let spans = grid.axes.iter().map(|axis| axis.end() - axis.start());
    1e-6 * spans.fold(f64::INFINITY, f64::min)
}

/// The conditions at the facets, in the order of cells.
pub(crate) fn held<const D: usize>(
    cells: &[Cell<D>],
    conditions: &Conditions<D>,
    free: FreeWater<'_, D>,
    grid: &Grid<D>,
) -> Vec<Held<D>> {
    let reach = reach(grid);
    let mut held = Vec::new();
    for (index, cell) in cells.iter().enumerate() {
        for facet in &cell.facets {
            let (at, owner) = at(facet, conditions, free, reach);
            held.push(Held {
                cell: index,
                facet: *facet,
                at,
                owner,
            });
        }
    }
    held
}

/// The condition at a facet, and its owner.
fn at<const D: usize>(
    facet: &Facet<D>,
    conditions: &Conditions<D>,
    free: FreeWater<'_, D>,
    reach: f64,
) -> (At, usize) {
    let rises = facet.normal[D - 1];
    let faces = conditions.faces.len();
    let is_below = |head: f64| conditions.confined || head >= facet.x[D - 1];
    let else_at = if rises > UPRIGHT && !conditions.confined {
        (At::Open(0.0), faces + 1)
    } else {
        (At::Closed, faces + 1)
    };
    let mut boxes = (conditions.faces.iter().enumerate().rev())
        .filter(|(_, face)| face.within.holds(&facet.x, reach))
        .peekable();
    let says_nothing = |kind: OnFaces| matches!(kind, OnFaces::Head(head) if !is_below(head));
    let is_above_level = boxes
        .peek()
        .is_some_and(|(_, top)| says_nothing(top.condition));
    // Above its level a head says nothing, and the box before it decides.
    let last = boxes.find(|(_, face)| !says_nothing(face.condition));
    match last.map(|(index, face)| (index, face.condition)) {
        None if is_above_level => return else_at,
        Some((index, OnFaces::Head(head))) => return (At::Head(head), index),
        Some((index, OnFaces::Inflow(inflow))) => return (At::Inflow(inflow), index),
        Some((index, OnFaces::Closed)) => return (At::Closed, index),
        _ => {}
    }
    let wets = |level: &f64| *level >= facet.x[D - 1] - reach && rises > UPRIGHT;
    if let Some(level) = free(&facet.x).filter(wets) {
        return (At::Head(level), faces);
    }
    match last.map(|(index, face)| (index, face.condition)) {
        // No rain falls on upright faces and undersides: they are as if nothing were said.
        Some((index, OnFaces::Recharge(rain))) if rises > UPRIGHT => {
            (At::Open(rain * rises), index)
        }
        Some((index, OnFaces::Open)) => (At::Open(0.0), index),
        _ => else_at,
    }
}
