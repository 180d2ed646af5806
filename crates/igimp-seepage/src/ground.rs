//! The ground on the grid: the soil in each cell, and the faces of the ground within it.
//!
//! Faces are found from the parts of bodies alone, by the theorem of Gauss: the open rest of the sides of a box is the face
//! within it. So it does not matter whether a face lies on a line of the grid, and bodies that touch leave none between them.

use igimp_geometry::region::Region;
use igimp_shape::Grid;

use crate::basis::{FOUR, Point, gauss};
use crate::conditions::{Conditions, InGround};

/// Sub-boxes of a cut cell along each axis, in the plane and in space.
pub(crate) const SUB: [usize; 2] = [4, 2];
/// Thickness of the slab that stands for a side, as a share of the box \[-\].
const SLAB: f64 = 1e-6;
/// Faces smaller than this share of a side are round-off \[-\].
const SMALL: f64 = 1e-4;
/// Cells filled to this share are whole \[-\].
const WHOLE: f64 = 1.0 - 1e-9;

/// A piece of a face of the ground.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facet<const D: usize> {
    pub(crate) x: [f64; D],
    /// Outward.
    pub(crate) normal: [f64; D],
    pub(crate) area: f64,
    pub(crate) soil: usize,
}

/// A cell with soil.
#[derive(Clone, Debug)]
pub(crate) struct Cell<const D: usize> {
    pub(crate) place: [usize; D],
    /// Share that soil fills \[-\].
    pub(crate) filled: f64,
    /// The soil that fills all of it; none: `points` say.
    pub(crate) whole: Option<usize>,
    pub(crate) points: Vec<Point<D>>,
    /// Where the permeability of a whole cell is taken that varies within it; none: it does not.
    pub(crate) samples: Vec<Point<D>>,
    pub(crate) facets: Vec<Facet<D>>,
}

/// Permeability at a place over that of its soil \[-\].
pub type Scale<'a, const D: usize> = &'a (dyn Fn(&[f64; D]) -> f64 + Sync);

/// A body as water sees it.
#[derive(Clone, Copy)]
pub struct SeepageBody<'a, const D: usize> {
    /// The region that it fills.
    pub region: &'a dyn Region<D>,
    /// Its soil, by index.
    pub soil: usize,
    /// How its permeability varies from place to place; none: it does not.
    pub scale: Option<Scale<'a, D>>,
}

impl<const D: usize> std::fmt::Debug for SeepageBody<'_, D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SeepageBody")
            .field("region", &self.region)
            .field("soil", &self.soil)
            .finish_non_exhaustive()
    }
}

impl<const D: usize> SeepageBody<'_, D> {
    fn scale_at(&self, x: &[f64; D]) -> f64 {
        self.scale.map_or(1.0, |scale| scale(x))
    }
}

/// The ground: the bodies that are there.
#[derive(Clone, Debug)]
pub(crate) struct Bodies<'a, const D: usize> {
    bodies: &'a [SeepageBody<'a, D>],
}

impl<'a, const D: usize> Bodies<'a, D> {
    pub(crate) fn new(bodies: &'a [SeepageBody<'a, D>]) -> Self {
        Self { bodies }
    }

    /// Volume and first moments of the soil in a box, and the body that has most of it.
    fn within(&self, lower: [f64; D], upper: [f64; D]) -> Filling<D> {
        let mut found = Filling {
            volume: 0.0,
            moment: [0.0; D],
            soil: 0,
            body: 0,
            bodies: 0,
        };
        let mut most = 0.0;
        for (index, body) in self.bodies.iter().enumerate() {
            let part = body.region.within(lower, upper);
            if part.volume > 0.0 {
                found.volume += part.volume;
                found.bodies += 1;
                for axis in 0..D {
                    found.moment[axis] += part.volume * part.centroid[axis];
                }
                if part.volume > most {
                    (most, found.soil, found.body) = (part.volume, body.soil, index);
                }
            }
        }
        found
    }

    /// Area of the soil at a side of a box, on its inner or outer hand, and its first moments.
    fn at_side(&self, [lower, upper]: [[f64; D]; 2], side: Side, inner: bool) -> ([f64; D], f64) {
        let Side { axis, is_upper } = side;
        let thick = SLAB * (upper[axis] - lower[axis]);
        let at = if is_upper { upper[axis] } else { lower[axis] };
        let (mut from, mut to) = (lower, upper);
        if inner == is_upper {
            (from[axis], to[axis]) = (at - thick, at);
        } else {
            (from[axis], to[axis]) = (at, at + thick);
        }
        let slab = self.within(from, to);
        let mut moment = slab.moment.map(|moment| moment / thick);
        let area = slab.volume / thick;
        moment[axis] = area * at;
        (moment, area)
    }

    /// The faces of the ground at the sides of a box, and with `inside` those within it.
    fn facets(&self, ends: [[f64; D]; 2], filling: &Filling<D>, inside: bool) -> Vec<Facet<D>> {
        let [lower, upper] = ends;
        let sizes: [f64; D] = std::array::from_fn(|axis| upper[axis] - lower[axis]);
        let volume: f64 = sizes.iter().product();
        let mut facets = Vec::new();
        let mut open = [0.0; D];
        let mut moments = [[0.0; D]; D];
        for axis in 0..D {
            moments[axis][axis] = filling.volume;
            for is_upper in [false, true] {
                let side = Side { axis, is_upper };
                let sign = if is_upper { 1.0 } else { -1.0 };
                let (moment, area) = self.at_side(ends, side, true);
                open[axis] -= sign * area;
                for other in 0..D {
                    moments[other][axis] -= sign * moment[other];
                }
                let (beyond, covered) = self.at_side(ends, side, false);
                let bare = area - covered;
                if bare > SMALL * volume / sizes[axis] {
                    let mut normal = [0.0; D];
                    normal[axis] = sign;
                    facets.push(Facet {
                        x: std::array::from_fn(|d| (moment[d] - beyond[d]) / bare),
                        normal,
                        area: bare,
                        soil: filling.soil,
                    });
                }
            }
        }
        let area = open.iter().map(|x| x * x).sum::<f64>().sqrt();
        let largest = sizes
            .iter()
            .fold(0.0, |most: f64, size| most.max(volume / size));
        if inside && area > SMALL * largest {
            let normal = open.map(|x| x / area);
            let centre = std::array::from_fn(|d| {
                let along: f64 = (0..D).map(|axis| moments[d][axis] * normal[axis]).sum();
                (along / area).clamp(lower[d], upper[d])
            });
            facets.push(Facet {
                x: centre,
                normal,
                area,
                soil: filling.soil,
            });
        }
        facets
    }
}

/// Soil in a box.
#[derive(Clone, Copy, Debug)]
struct Filling<const D: usize> {
    volume: f64,
    moment: [f64; D],
    /// The soil of the body that has most of it, and that body.
    soil: usize,
    body: usize,
    /// How many bodies have some.
    bodies: usize,
}

/// A side of a box.
#[derive(Clone, Copy, Debug)]
struct Side {
    axis: usize,
    is_upper: bool,
}

/// Lower and upper corner of the cell at a place.
pub(crate) fn ends_of<const D: usize>(grid: &Grid<D>, place: [usize; D]) -> [[f64; D]; 2] {
    [0, 1].map(|up| std::array::from_fn(|axis| grid.axes[axis].nodes()[place[axis] + up]))
}

/// The cells that hold soil, in their order.
pub(crate) fn cells<const D: usize>(
    grid: &Grid<D>,
    bodies: &Bodies<'_, D>,
    conditions: &Conditions<D>,
) -> Vec<Cell<D>> {
    let count = grid.cell_count();
    let fillings: Vec<Filling<D>> = (0..count)
        .map(|cell| {
            let [lower, upper] = ends_of(grid, grid.cell_place(cell));
            bodies.within(lower, upper)
        })
        .collect();
    let size = |place: [usize; D]| grid.cell_size(place).iter().product::<f64>();
    let is_full =
        |place: [usize; D]| fillings[grid.cell_index(place)].volume >= WHOLE * size(place);
    let mut cells = Vec::new();
    for cell in 0..count {
        let place = grid.cell_place(cell);
        let filling = &fillings[cell];
        let filled = filling.volume / size(place);
        if filled <= 1.0 - WHOLE {
            continue;
        }
        let is_inner = (0..D).all(|axis| {
            let mut beside = [place; 2];
            if place[axis] == 0 || place[axis] + 1 == grid.axes[axis].cell_count() {
                return false;
            }
            beside[0][axis] -= 1;
            beside[1][axis] += 1;
            beside.into_iter().all(is_full)
        });
        let [lower, upper] = ends_of(grid, place);
        let touched = conditions.regions.iter();
        let is_touched = { touched }.any(|region| region.within.meets(&lower, &upper));
        let is_whole = filled >= WHOLE && filling.bodies == 1 && !is_touched;
        let mut cell = Cell {
            place,
            filled: filled.min(1.0),
            whole: is_whole.then_some(filling.soil),
            points: Vec::new(),
            samples: Vec::new(),
            facets: Vec::new(),
        };
        let body = &bodies.bodies[filling.body];
        if is_whole && body.scale.is_some() {
            cell.samples = gauss([lower, upper], &FOUR, filling.soil);
            for point in &mut cell.samples {
                point.scale = body.scale_at(&point.x);
            }
        }
        if !is_whole || !is_inner {
            subdivide(bodies, conditions, [lower, upper], &mut cell, is_inner);
        }
        cells.push(cell);
    }
    cells
}

/// Points and faces of a cell, by its sub-boxes.
fn subdivide<const D: usize>(
    bodies: &Bodies<'_, D>,
    conditions: &Conditions<D>,
    [lower, upper]: [[f64; D]; 2],
    cell: &mut Cell<D>,
    is_inner: bool,
) {
    let sub = SUB[D - 2];
    let box_count = sub.pow(D as u32);
    for number in 0..box_count {
        let mut rest = number;
        let (mut from, mut to) = (lower, upper);
        for axis in 0..D {
            let k = rest % sub;
            rest /= sub;
            let at = |k: usize| lower[axis] + (upper[axis] - lower[axis]) * k as f64 / sub as f64;
            from[axis] = at(k);
            if k + 1 < sub {
                to[axis] = at(k + 1);
            }
        }
        let filled = bodies.within(from, to);
        let size: f64 = (0..D).map(|axis| to[axis] - from[axis]).product();
        if filled.volume <= 1e-12 * size {
            continue;
        }
        if cell.whole.is_none() {
            for body in bodies.bodies {
                let part = body.region.within(from, to);
                if part.volume > 1e-12 * size {
                    let (soil, region) = acting(conditions, &part.centroid, body.soil);
                    cell.points.push(Point {
                        x: part.centroid,
                        volume: part.volume * conditions.thickness(part.centroid[0]),
                        soil,
                        body_soil: body.soil,
                        region,
                        scale: if soil == body.soil {
                            body.scale_at(&part.centroid)
                        } else {
                            1.0
                        },
                    });
                }
            }
        }
        if !is_inner {
            let x = filled.moment.map(|moment| moment / filled.volume);
            let (soil, _) = acting(conditions, &x, filled.soil);
            let filling = Filling { soil, ..filled };
            let is_cut = filled.volume < WHOLE * size;
            let mut facets = bodies.facets([from, to], &filling, is_cut);
            for facet in &mut facets {
                facet.area *= conditions.thickness(facet.x[0]);
            }
            cell.facets.extend(facets);
        }
    }
}

/// The soil at a point, and the region that acts there.
fn acting<const D: usize>(
    conditions: &Conditions<D>,
    x: &[f64; D],
    soil: usize,
) -> (usize, Option<usize>) {
    let (mut soil, mut region) = (soil, None);
    for (index, named) in conditions.regions.iter().enumerate() {
        if named.within.holds(x, 0.0) {
            match named.condition {
                InGround::Soil(other) => soil = other,
                _ => region = Some(index),
            }
        }
    }
    (soil, region)
}
