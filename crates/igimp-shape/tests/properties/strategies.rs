//! Random axes and random particles on them.

use std::ops::Range;

use igimp_shape::Axis;
use proptest::prelude::*;

/// Smallest cell of the random axes \[length\]; gradients are compared relative to its inverse.
pub(crate) const SMALLEST_CELL: f64 = 0.5;

/// A particle seen from one direction.
#[derive(Debug, Clone)]
pub(crate) struct Direction {
    pub(crate) axis: Axis,
    pub(crate) x: f64,
    pub(crate) half_length: f64,
}

impl Direction {
    /// The domain, cut at the walls.
    pub(crate) fn domain(&self) -> (f64, f64) {
        let (lower, upper) = (self.x - self.half_length, self.x + self.half_length);
        (lower.max(self.axis.start()), upper.min(self.axis.end()))
    }
}

/// Uniform axes and axes of random cell sizes, one to five cells.
pub(crate) fn axis() -> impl Strategy<Value = Axis> {
    let start = -2.0..2.0;
    let size = SMALLEST_CELL..2.0;
    let uniform = (start.clone(), size.clone(), 1_usize..=5)
        .prop_map(|(start, spacing, cells)| Axis::uniform(start, spacing, cells).unwrap());
    let graded = (start, prop::collection::vec(size, 1..=5)).prop_map(|(start, sizes)| {
        let mut nodes = vec![start];
        for (k, size) in sizes.iter().enumerate() {
            nodes.push(nodes[k] + size);
        }
        Axis::from_nodes(nodes).unwrap()
    });
    prop_oneof![uniform, graded]
}

/// Particles anywhere, on nodes and on walls, whose domain is longer than a hundredth of a cell:
/// inside a cell, across several, across the whole axis, or ending exactly on a node.
pub(crate) fn direction() -> impl Strategy<Value = Direction> {
    let particle = |axis: Axis| {
        let centre = centre(&axis);
        (
            Just(axis),
            centre,
            half_length(0.01..0.5, 0.5..8.0),
            any::<prop::sample::Index>(),
        )
    };
    axis()
        .prop_flat_map(particle)
        .prop_map(|(axis, x, half_length, face)| {
            let to_face = (x - axis.nodes()[face.index(axis.node_count())]).abs();
            let half_length = half_length.unwrap_or(if to_face < 0.01 { 0.25 } else { to_face });
            Direction {
                axis,
                x,
                half_length,
            }
        })
}

/// Particles anywhere, with domains down to nothing.
pub(crate) fn tiny_direction() -> impl Strategy<Value = Direction> {
    let half_length = prop_oneof![Just(0.0), (-17.0..-2.0).prop_map(|e| 10_f64.powf(e))];
    let particle = move |axis: Axis| {
        let centre = centre(&axis);
        (Just(axis), centre, half_length.clone())
    };
    axis()
        .prop_flat_map(particle)
        .prop_map(|(axis, x, half_length)| Direction {
            axis,
            x,
            half_length,
        })
}

/// Particles of either kind.
pub(crate) fn any_direction() -> impl Strategy<Value = Direction> {
    prop_oneof![2 => direction(), 1 => tiny_direction()]
}

/// A point of the axis, often on a node or a wall.
fn centre(axis: &Axis) -> impl Strategy<Value = f64> + use<> {
    prop_oneof![
        4 => axis.start()..axis.end(),
        1 => prop::sample::select(axis.nodes().to_vec()),
    ]
}

/// A small or a large half-length, or `None`: up to a node.
fn half_length(small: Range<f64>, large: Range<f64>) -> impl Strategy<Value = Option<f64>> {
    prop_oneof![
        3 => small.prop_map(Some),
        2 => large.prop_map(Some),
        1 => Just(None),
    ]
}
