//! The linear basis of a cell, its nodes and its points.

use igimp_shape::Grid;

/// Corners of a cell, at most.
pub(crate) const CORNERS: usize = 8;

/// A point of the ground with the volume that it stands for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point<const D: usize> {
    pub(crate) x: [f64; D],
    pub(crate) volume: f64,
    pub(crate) soil: usize,
    /// The soil of its body, whose pores store water whatever a region does to the permeability.
    pub(crate) body_soil: usize,
    /// The region that acts there.
    pub(crate) region: Option<usize>,
    /// Permeability over that of its soil \[-\].
    pub(crate) scale: f64,
}

/// The basis of a cell at a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Basis<const D: usize> {
    pub(crate) value: [f64; CORNERS],
    pub(crate) gradient: [[f64; D]; CORNERS],
}

impl<const D: usize> Basis<D> {
    pub(crate) fn at([lower, upper]: [[f64; D]; 2], x: &[f64; D]) -> Self {
        let mut value = [0.0; CORNERS];
        let mut gradient = [[0.0; D]; CORNERS];
        for corner in 0..1 << D {
            let factor = |axis: usize| {
                let size = upper[axis] - lower[axis];
                let t = (x[axis] - lower[axis]) / size;
                if corner >> axis & 1 == 1 {
                    [t, 1.0 / size]
                } else {
                    [1.0 - t, -1.0 / size]
                }
            };
            value[corner] = (0..D).map(|axis| factor(axis)[0]).product();
            for axis in 0..D {
                let others = (0..D).filter(|other| *other != axis);
                gradient[corner][axis] =
                    factor(axis)[1] * others.map(|other| factor(other)[0]).product::<f64>();
            }
        }
        Self { value, gradient }
    }

    pub(crate) fn head(&self, heads: &[f64; CORNERS]) -> f64 {
        (0..1 << D).map(|k| self.value[k] * heads[k]).sum()
    }

    pub(crate) fn slope(&self, heads: &[f64; CORNERS]) -> [f64; D] {
        std::array::from_fn(|axis| (0..1 << D).map(|k| self.gradient[k][axis] * heads[k]).sum())
    }
}

pub(crate) fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    (0..D).map(|axis| a[axis] * b[axis]).sum()
}

/// The upper one of two points of Gauss on 0 to 1.
pub(crate) const HIGH: f64 = 0.788_675_134_594_812_9;
/// Two points and weights of Gauss on 0 to 1.
pub(crate) const TWO: [(f64, f64); 2] = [(1.0 - HIGH, 0.5), (HIGH, 0.5)];
/// Four of them.
pub(crate) const FOUR: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// The points of Gauss of a box of one soil.
pub(crate) fn gauss<const D: usize>(
    [lower, upper]: [[f64; D]; 2],
    along: &[(f64, f64)],
    soil: usize,
) -> Vec<Point<D>> {
    let count = along.len().pow(D as u32);
    (0..count)
        .map(|number| {
            let mut rest = number;
            let (mut x, mut volume) = (lower, 1.0);
            for axis in 0..D {
                let (place, weight) = along[rest % along.len()];
                rest /= along.len();
                let size = upper[axis] - lower[axis];
                x[axis] += place * size;
                volume *= weight * size;
            }
            Point {
                x,
                volume,
                soil,
                body_soil: soil,
                region: None,
                scale: 1.0,
            }
        })
        .collect()
}

/// Nodes at the corners of a cell, the first axis fastest.
pub(crate) fn nodes_of<const D: usize>(
    grid: &Grid<D>,
    place: [usize; D],
) -> impl Iterator<Item = usize> + '_ {
    (0..1_usize << D).map(move |corner| {
        grid.node_index(std::array::from_fn(|axis| {
            place[axis] + (corner >> axis & 1)
        }))
    })
}
