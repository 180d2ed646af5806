//! Properties that hold to the last bit: change of the length unit, mirror image, search for a cell.

use igimp_shape::{Axis, Basis, Gimp, NodeWeight};
use proptest::prelude::*;

use crate::strategies::{Direction, any_direction, direction};

fn gimp(axis: &Axis, x: f64, half_length: f64) -> Vec<NodeWeight> {
    let mut weights = Vec::new();
    Gimp.axis_weights(axis, x, half_length, &mut weights)
        .unwrap();
    weights
}

proptest! {
    #[test]
    fn length_unit(particle in any_direction(), exponent in -40..40) {
        let unit = 2_f64.powi(exponent);
        let Direction { axis, x, half_length } = particle;
        let scaled_nodes = axis.nodes().iter().map(|node| node * unit).collect();
        let scaled = Axis::from_nodes(scaled_nodes).unwrap();
        let mut expected = gimp(&axis, x, half_length);
        for weight in &mut expected {
            weight.slope /= unit;
        }
        prop_assert_eq!(gimp(&scaled, x * unit, half_length * unit), expected);
    }

    #[test]
    fn mirror_image(particle in direction()) {
        let Direction { axis, x, half_length } = particle;
        let mirrored = Axis::from_nodes(axis.nodes().iter().rev().map(|x| -x).collect()).unwrap();
        let mut expected = gimp(&axis, x, half_length);
        expected.reverse();
        for weight in &mut expected {
            weight.node = axis.cell_count() - weight.node;
            weight.slope = -weight.slope;
        }
        prop_assert_eq!(gimp(&mirrored, -x, half_length), expected);
    }

    #[test]
    fn search(particle in direction(), outside in 1e-9..10.0) {
        let Direction { axis, x, .. } = particle;
        let expected = (0..axis.cell_count()).rev().find(|&cell| axis.nodes()[cell] <= x);
        prop_assert_eq!(axis.cell_at(x), expected);
        prop_assert_eq!(axis.cell_at(axis.start() - outside), None);
        prop_assert_eq!(axis.cell_at(axis.end() + outside), None);
    }
}
