//! GOAL: a solid has the edges that a drawing of it shows, and no others.
//! ORACLE: lengths counted by hand.

use std::sync::Arc;

use super::*;
use crate::solid::{ClosedSurface, Sphere, Terrain};

fn length(lines: &[Vec<Point>]) -> f64 {
    let apart = |ends: &[Point]| (0..3).fold(0.0_f64, |sum, k| sum.hypot(ends[1][k] - ends[0][k]));
    lines
        .iter()
        .flat_map(|line| line.windows(2))
        .map(apart)
        .sum()
}

fn assert_length(solid: &Solid, wanted: f64, within: f64) {
    let found = length(&solid.edges());
    assert!(
        (found - wanted).abs() <= within * wanted,
        "{}: {found} for {wanted}",
        solid.words()
    );
}

fn cuboid(upper: Point) -> Solid {
    Solid::Cuboid([0.0; 3], upper)
}

#[test]
fn boxes_prisms_and_round_bodies() {
    assert_length(&cuboid([2.0, 3.0, 5.0]), 4.0 * 10.0, 1e-12);
    assert_eq!(cuboid([1.0; 3]).edges().len(), 6);
    let slope = Solid::slice(&[[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]], [0.0, 2.0]);
    assert_length(&slope, 2.0 * 12.0 + 3.0 * 2.0, 1e-12);
    // Two polygons of 48 sides; no line along the side.
    let pillar = Solid::Cylinder(Cylinder {
        axis: 2,
        centre: [1.0, -1.0],
        radius: 0.5,
        between: [0.0, 4.0],
    });
    assert_length(&pillar, 2.0 * 96.0 * 0.5 * (PI / 48.0).sin(), 1e-12);
    let ball = Solid::Sphere(Sphere {
        centre: [0.0; 3],
        radius: 1.0,
    });
    assert!(ball.edges().is_empty());
}

/// Triangles of a face count as one.
#[test]
fn closed_surfaces_have_their_creases() {
    let corner = |k: usize| [k & 1, k >> 1 & 1, k >> 2].map(|x| x as f64);
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles: Vec<[Point; 3]> = faces
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .map(|triangle| triangle.map(corner))
        .collect();
    let surface = Arc::new(ClosedSurface::new(&triangles).unwrap());
    assert_length(&Solid::Surface(surface), 12.0, 1e-12);
}

/// A layer on an inclined plane, z = x/2 over a square of 4: its rims follow the planes, its upright edges are its height.
#[test]
fn layers_have_rims_and_upright_edges() {
    let plan = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
    let lines = [-1.0, 1.0, 3.0, 5.0];
    let rows: Vec<Vec<Option<f64>>> = lines
        .iter()
        .map(|_| lines.iter().map(|x| Some(0.5 * x + 2.0)).collect())
        .collect();
    let top = Height::Terrain(Arc::new(Terrain::on_lines(&lines, &lines, &rows).unwrap()));
    let layer = Layer::new(&plan, Height::Level(0.0), top).unwrap();
    let inclined = 2.0 * 20.0_f64.sqrt();
    let wanted = 16.0 + (8.0 + inclined) + 2.0 * (2.0 + 4.0);
    assert_length(&Solid::Layer(Arc::new(layer)), wanted, 1e-9);
}

/// A cutting along a ridge has an edge along its toe and its crest, as far as the plan goes.
#[test]
fn a_surface_of_the_ground_shows_its_creases() {
    let (x, y) = ([0.0, 2.0, 4.0, 6.0], [-1.0, 1.0, 5.0]);
    let heights = [1.0, 1.0, 3.0, 3.0].map(Some);
    let rows = vec![heights.to_vec(); 3];
    let top = Height::Terrain(Arc::new(Terrain::on_lines(&x, &y, &rows).unwrap()));
    let plan = [[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [0.0, 4.0]];
    let layer = Layer::new(&plan, Height::Level(0.0), top).unwrap();
    let rim = 4.0 + 8.0_f64.sqrt();
    let wanted = 20.0 + (2.0 * rim + 8.0) + 2.0 * (1.0 + 3.0) + 2.0 * 4.0;
    assert_length(&Solid::Layer(Arc::new(layer)), wanted, 0.02);
}

/// A shaft that begins above the ground, a tunnel that goes on beyond it, and a step cut from a corner.
#[test]
fn a_cut_has_its_own_edges() {
    let difference = |minus: Solid| {
        Solid::Difference(Difference {
            of: Box::new(cuboid([10.0, 10.0, 10.0])),
            minus: vec![minus],
        })
    };
    let shaft = Solid::Cuboid([4.0, 4.0, 5.0], [6.0, 7.0, 12.0]);
    // 12 edges of the block; 4 upright ones, the bottom and the rim at the top of the shaft.
    let wanted = 120.0 + 4.0 * 5.0 + 2.0 * 10.0;
    assert_length(&difference(shaft), wanted, 0.03);
    let tunnel = Solid::Cylinder(Cylinder {
        axis: 1,
        centre: [5.0, 5.0],
        radius: 2.0,
        between: [-3.0, 20.0],
    });
    assert_length(&difference(tunnel), 120.0 + 2.0 * 4.0 * PI, 0.03);
    // An L moved along y.
    let step = Solid::Cuboid([6.0, -1.0, 6.0], [11.0, 11.0, 11.0]);
    assert_length(&difference(step), 2.0 * 40.0 + 6.0 * 10.0, 0.03);
}
