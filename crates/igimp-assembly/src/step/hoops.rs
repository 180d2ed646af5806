//! How nodes stretch a body of revolution around its axis, x = 0 (theory, eqs. 130 to 130b).

use igimp_shape::{CellPart, Grid, Support};

use crate::method::Section;

/// How much a support stretches a particle around the axis, for a radial displacement of one \[1/length\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Hoop {
    /// T_i, of the particle: the mean of N_i/r by volume, as far as it is not shared with the soil of its cells.
    pub(crate) value: f64,
    /// T̄_i, of the soil of its cells.
    pub(crate) bar: f64,
    /// T_i of the particle's place alone, by which it moves (theory, eq. 130h).
    pub(crate) place: f64,
}

impl Hoop {
    /// A stretch of nothing.
    pub(crate) const UNSTRETCHED: Self = Self {
        value: 1.0,
        bar: 1.0,
        place: 1.0,
    };

    /// Strain around the axis u_r/r of nodal displacements `u` \[-\].
    #[inline(never)]
    pub(crate) fn strain<const D: usize>(
        supports: &[Support<D>],
        hoops: &[Self],
        u: &[[f64; D]],
    ) -> Self {
        let around = supports.iter().zip(hoops);
        around.fold(Self::default(), |sum, (support, hoop)| {
            sum.plus(u[support.node][0], *hoop)
        })
    }

    /// This and `factor` times another.
    #[inline]
    pub(crate) fn plus(self, factor: f64, other: Self) -> Self {
        Self {
            value: self.value + factor * other.value,
            bar: self.bar + factor * other.bar,
            place: self.place + factor * other.place,
        }
    }

    /// This times another, each by each.
    pub(crate) fn times(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            bar: self.bar * other.bar,
            place: self.place * other.place,
        }
    }

    /// One over each.
    pub(crate) fn reciprocal(self) -> Self {
        Self {
            value: self.value.recip(),
            bar: self.bar.recip(),
            place: self.place.recip(),
        }
    }
}

/// How the supports of a particle stretch it around the axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Around<'a> {
    /// By support.
    pub(crate) hoops: &'a [Hoop],
    /// 1/ΔF_θθ, and that of the cell-averaged stretch; 1 in small strain.
    pub(crate) push: Hoop,
}

/// The extent of a particle's part in a cell along the radius.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RadialPart {
    /// Radius of its middle \[length\].
    pub(crate) middle: f64,
    /// Place in the cell, from 0 to 1, of its centroid by volume, which is further out \[-\].
    pub(crate) centroid: f64,
}

impl RadialPart {
    /// That of a part of a domain of half-length `half_length` around `x` along the radius.
    pub(crate) fn of<const D: usize>(
        grid: &Grid<D>,
        part: &CellPart<D>,
        x: f64,
        half_length: f64,
    ) -> Self {
        let (nodes, cell) = (grid.axes[0].nodes(), part.cell[0]);
        let (start, size) = (nodes[cell], nodes[cell + 1] - nodes[cell]);
        let lower = (x - half_length).max(start);
        let upper = (x + half_length).min(start + size);
        let middle = start + part.middle[0] * size;
        Self {
            middle,
            centroid: part.middle[0] + off_middle(middle, 0.5 * (upper - lower)) / size,
        }
    }
}

/// Weighs the parts of a particle by their radii: their shares are then those of its volume (theory, eq. 130).
pub(crate) fn weigh_by_radius<const D: usize>(grid: &Grid<D>, parts: &mut [CellPart<D>]) {
    let radius = |part: &CellPart<D>| {
        let (nodes, cell) = (grid.axes[0].nodes(), part.cell[0]);
        nodes[cell] + part.middle[0] * (nodes[cell + 1] - nodes[cell])
    };
    let whole: f64 = parts.iter().map(|part| part.share * radius(part)).sum();
    for part in parts {
        part.share *= radius(part) / whole;
    }
}

/// Centroid by volume of a cell in it, from 0 to 1 in each direction \[-\].
pub(crate) fn centroid_of_cell<const D: usize>(
    grid: &Grid<D>,
    cell: [usize; D],
    section: Section,
) -> [f64; D] {
    let mut centroid = [0.5; D];
    if section.is_axisymmetric() {
        let (start, size) = (grid.axes[0].nodes()[cell[0]], grid.cell_size(cell)[0]);
        centroid[0] += off_middle(start + 0.5 * size, 0.5 * size) / size;
    }
    centroid
}

/// How far the centroid by volume of a ring lies beyond its middle: a third of the square of half its width over its
/// radius \[length\].
pub(crate) fn off_middle(middle: f64, half_width: f64) -> f64 {
    if middle > 0.0 {
        half_width * half_width / (3.0 * middle)
    } else {
        0.0
    }
}
