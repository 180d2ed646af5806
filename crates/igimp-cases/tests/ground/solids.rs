//! GOAL: solids filled with particles have their exact volume and centroid, whatever the grid.
//! BODY: boxes, prisms, cylinders, spheres, closed surfaces of triangles, layers of ground, differences.
//! ORACLE: formulas of geometry; sums of tetrahedra for polyhedra.

use std::collections::HashMap;
use std::f64::consts::PI;
use std::sync::Arc;

use igimp_assembly::ParticleSeed;
use igimp_geometry::region::{Cover, Crossing, Part, Region};
use igimp_geometry::seed::fill;
use igimp_geometry::solid::{
    ClosedSurface, ClosedSurfaceError, Cylinder, Difference, Height, Layer, LayerError, Prism,
    Solid, Sphere, Terrain, TerrainError,
};
use igimp_shape::{Axis, Grid};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

type Point = [f64; 3];

/// A grid around the origin, graded along z.
fn grid() -> Grid<3> {
    let z = (0..=14).map(|k| -3.0 + 0.3 * f64::from(k) + 0.01 * f64::from(k * k));
    Grid::new([
        Axis::uniform(-3.0, 0.5, 12).unwrap(),
        Axis::uniform(-3.1, 0.4, 15).unwrap(),
        Axis::from_nodes(z.collect()).unwrap(),
    ])
}

/// The sum of the parts of a region in the cells of a grid; parts stated whole or empty are so.
fn sum(region: &dyn Region<3>, grid: &Grid<3>, round_off: f64) -> Part<3> {
    let (mut volume, mut moment) = (0.0, [0.0; 3]);
    for cell in 0..grid.cell_count() {
        let place = grid.cell_place(cell);
        let lower = grid.node_position(grid.node_index(place));
        let upper = grid.node_position(grid.node_index(place.map(|place| place + 1)));
        let part = region.within(lower, upper);
        let whole = Part::whole(lower, upper).volume;
        match region.cover(lower, upper) {
            Cover::Nothing => assert!(part.volume.abs() < round_off * whole, "{lower:?} {part:?}"),
            Cover::Whole => assert!(
                (part.volume - whole).abs() < round_off * whole,
                "{lower:?} {part:?} {whole}"
            ),
            Cover::Cut => assert!(part.volume < (1.0 + round_off) * whole),
        }
        if part.volume > round_off * whole {
            let slack = 1e-3 * round_off * whole / part.volume;
            for axis in 0..3 {
                let at = part.centroid[axis];
                assert!(
                    lower[axis] - slack <= at && at <= upper[axis] + slack,
                    "{part:?}"
                );
            }
        }
        volume += part.volume;
        for axis in 0..3 {
            moment[axis] += part.volume * part.centroid[axis];
        }
    }
    Part {
        volume,
        centroid: moment.map(|moment| moment / volume),
    }
}

#[track_caller]
fn assert_near(found: Part<3>, volume: f64, centroid: Point, band: f64) {
    assert!(
        (found.volume / volume - 1.0).abs() <= band,
        "{} for {volume}: {:e}",
        found.volume,
        found.volume / volume - 1.0
    );
    for axis in 0..3 {
        let off = found.centroid[axis] - centroid[axis];
        assert!(off.abs() <= band, "{found:?} for {centroid:?}: {off:e}");
    }
}

/// A region that is asked box by box, whether or not it stands in columns.
#[derive(Debug)]
struct BoxByBox<'a>(&'a dyn Region<3>);

impl Region<3> for BoxByBox<'_> {
    fn bounds(&self) -> (Point, Point) {
        self.0.bounds()
    }

    fn within(&self, lower: Point, upper: Point) -> Part<3> {
        self.0.within(lower, upper)
    }

    fn cover(&self, lower: Point, upper: Point) -> Cover {
        self.0.cover(lower, upper)
    }

    fn encloses(&self, point: Point) -> bool {
        self.0.encloses(point)
    }

    fn crossings(&self, place: &Point) -> Vec<Crossing> {
        self.0.crossings(place)
    }

    fn corners(&self) -> Vec<Point> {
        self.0.corners()
    }

    fn words(&self) -> String {
        self.0.words()
    }
}

/// Particles are the same whether columns of them are cut at once or one after the other, but for round-off in volumes: a part
/// that is a tenth of its whole to the last digit is a particle here and joins its neighbour there.
#[track_caller]
fn assert_columns_are_boxes(region: &dyn Region<3>, per_direction: usize) {
    let found = fill(&grid(), region, per_direction, 1.0, 0);
    let expected = fill(&grid(), &BoxByBox(region), per_direction, 1.0, 0);
    let (Ok(found), Ok(expected)) = (found, expected) else {
        panic!("{} is filled", region.words());
    };
    let place = |seed: &ParticleSeed<3>| seed.x.map(f64::to_bits);
    let by_place = |seeds: &[ParticleSeed<3>]| -> HashMap<[u64; 3], ParticleSeed<3>> {
        seeds.iter().map(|seed| (place(seed), *seed)).collect()
    };
    let (found, expected) = (by_place(&found), by_place(&expected));
    let alone = |of: &HashMap<_, ParticleSeed<3>>, other: &HashMap<_, ParticleSeed<3>>| {
        let alone = of.iter().filter(|(place, _)| !other.contains_key(*place));
        alone.map(|(_, seed)| *seed).collect::<Vec<_>>()
    };
    let mut tenths = alone(&found, &expected);
    tenths.extend(alone(&expected, &found));
    for seed in &tenths {
        let whole = 8.0 * seed.half_length.iter().product::<f64>();
        assert!((seed.volume / whole - 0.1).abs() < 1e-14, "{seed:?}");
    }
    for (place, found) in &found {
        let Some(expected) = expected.get(place) else {
            continue;
        };
        assert_eq!(
            found.half_length.map(f64::to_bits),
            expected.half_length.map(f64::to_bits)
        );
        let off = (found.volume - expected.volume).abs();
        let is_joined = |seed: &ParticleSeed<3>| (off - seed.volume).abs() < 1e-10 * seed.volume;
        let is_same = off < 1e-10 * expected.volume;
        assert!(
            is_same || tenths.iter().any(is_joined),
            "{found:?} {expected:?}"
        );
    }
}

/// Volume and centroid within triangles: tetrahedra from the origin.
fn enclosed(triangles: &[[Point; 3]]) -> Part<3> {
    let (mut volume, mut moment) = (0.0, [0.0; 3]);
    for [a, b, c] in triangles {
        let piece = (a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0]))
            / 6.0;
        volume += piece;
        for axis in 0..3 {
            moment[axis] += piece * (a[axis] + b[axis] + c[axis]) / 4.0;
        }
    }
    Part {
        volume,
        centroid: moment.map(|moment| moment / volume),
    }
}

fn cube() -> Vec<[Point; 3]> {
    let corner = |k: usize| [k & 1, k >> 1 & 1, k >> 2].map(|bit| 2.0 * bit as f64 - 1.0);
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let halves = |[a, b, c, d]: [usize; 4]| [[a, b, c], [a, c, d]];
    let triangles = faces.into_iter().flat_map(halves);
    triangles.map(|triangle| triangle.map(corner)).collect()
}

/// Turned about z, then about x, and moved.
fn turned(triangles: &[[Point; 3]], [about_z, about_x]: [f64; 2], by: Point) -> Vec<[Point; 3]> {
    let turn = |[x, y, z]: Point| {
        let (sine, cosine) = about_z.sin_cos();
        let (x, y) = (cosine * x - sine * y, sine * x + cosine * y);
        let (sine, cosine) = about_x.sin_cos();
        let (y, z) = (cosine * y - sine * z, sine * y + cosine * z);
        [x + by[0], y + by[1], z + by[2]]
    };
    triangles
        .iter()
        .map(|triangle| triangle.map(turn))
        .collect()
}

fn surface(triangles: &[[Point; 3]]) -> Solid {
    Solid::Surface(Arc::new(ClosedSurface::new(triangles).unwrap()))
}

#[test]
fn simple_solids_have_their_volume() {
    let grid = grid();
    let cuboid = Solid::Cuboid([-1.3, -0.7, -2.0], [2.1, 1.9, 0.35]);
    assert_near(
        sum(&cuboid, &grid, 1e-12),
        3.4 * 2.6 * 2.35,
        [0.4, 0.6, -0.825],
        1e-12,
    );
    // A trapezium in x and z, and in plan.
    let trapezium = vec![[-2.0, -2.0], [2.0, -2.0], [1.0, 0.0], [-2.0, 0.0]];
    let (area, [x, y]) = (7.0, [-2.0 + 37.0 / 21.0, -2.0 + 20.0 / 21.0]);
    let slice = Solid::slice(&trapezium, [-0.9, 2.3]);
    assert_near(sum(&slice, &grid, 1e-12), 3.2 * area, [x, 0.7, y], 1e-12);
    let prism = Solid::Prism(Prism::new(trapezium, 2, [-1.0, 1.5]));
    assert_near(sum(&prism, &grid, 1e-12), 2.5 * area, [x, y, 0.25], 1e-12);
    for axis in 0..3 {
        let cylinder = Cylinder {
            axis,
            centre: [0.3, -0.2],
            radius: 1.7,
            between: [-1.4, 0.9],
        };
        let centroid = [[-0.25, 0.3, -0.2], [0.3, -0.25, -0.2], [0.3, -0.2, -0.25]][axis];
        assert_near(
            sum(&cylinder, &grid, 1e-12),
            PI * 1.7 * 1.7 * 2.3,
            centroid,
            1e-12,
        );
    }
    let sphere = Sphere {
        centre: [0.1, -0.2, -0.4],
        radius: 1.9,
    };
    let volume = 4.0 / 3.0 * PI * 1.9_f64.powi(3);
    assert_near(sum(&sphere, &grid, 1e-9), volume, sphere.centre, 1e-11);
}

/// An octant of a ball has its centroid at 3/8 of the radius, and a cap its volume π h² (3 r − h) / 3.
#[test]
fn parts_of_balls_are_exact() {
    let ball = Sphere {
        centre: [0.0; 3],
        radius: 2.0,
    };
    let octant = ball.within([0.0; 3], [5.0; 3]);
    assert_near(octant, PI * 8.0 / 6.0, [0.75; 3], 1e-11);
    for axis in 0..3 {
        let (mut lower, upper) = ([-5.0; 3], [5.0; 3]);
        lower[axis] = 1.3;
        let cap = ball.within(lower, upper).volume;
        let exact = PI * 0.49 * (6.0 - 0.7) / 3.0;
        assert!(
            (cap / exact - 1.0).abs() < 1e-11,
            "{axis}: {:e}",
            cap / exact - 1.0
        );
    }
}

#[test]
fn turned_cubes_have_their_volume() {
    for (k, turns) in [
        [0.0, 0.0],
        [0.0, 0.5],
        [0.7, 0.0],
        [0.3, -1.1],
        [PI / 4.0, PI / 4.0],
    ]
    .into_iter()
    .enumerate()
    {
        let by = [0.1 * k as f64, -0.2, -0.5];
        let found = sum(&surface(&turned(&cube(), turns, by)), &grid(), 1e-11);
        assert_near(found, 8.0, by, 1e-12);
    }
}

#[test]
fn a_hollow_is_left_out() {
    let mut triangles = cube();
    let small = turned(&cube(), [0.4, 0.2], [0.0; 3]);
    let inside = small
        .iter()
        .map(|&[a, b, c]| [a, c, b].map(|x| x.map(|x| 0.3 * x)));
    triangles.extend(inside);
    let hollow = surface(&triangles);
    assert_near(
        sum(&hollow, &grid(), 1e-11),
        8.0 * (1.0 - 0.027),
        [0.0; 3],
        1e-12,
    );
    assert!(hollow.encloses([0.7, 0.7, 0.7]) && !hollow.encloses([0.0; 3]));
    assert!(!hollow.encloses([0.0, 0.0, 1.1]) && !hollow.encloses([0.0, 0.0, -1.1]));
}

#[test]
fn surfaces_that_enclose_nothing_say_where() {
    let refused = |triangles: &[[Point; 3]]| ClosedSurface::new(triangles).unwrap_err();
    let mut open = cube();
    open.remove(3);
    let message = refused(&open).to_string();
    assert_eq!(
        message,
        "it has a hole: 3 edges have a triangle on one side only, the first from (-1, -1, 1) m to (1, 1, 1) m"
    );
    let mut twisted = cube();
    twisted[5].swap(0, 1);
    assert!(matches!(
        refused(&twisted),
        ClosedSurfaceError::Twisted { count: 3, .. }
    ));
    let inward: Vec<_> = cube().iter().map(|&[a, b, c]| [a, c, b]).collect();
    assert!(matches!(refused(&inward), ClosedSurfaceError::Inverted { volume } if volume < -7.9));
    let mut flat = cube();
    flat.push([[1.0; 3], [0.0; 3], [-1.0; 3]]);
    assert!(matches!(
        refused(&flat),
        ClosedSurfaceError::Flat { count: 1, .. }
    ));
    let mut fin = cube();
    fin.push([[1.0, 1.0, 1.0], [1.0, 1.0, -1.0], [3.0, 3.0, 0.0]]);
    fin.push([[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [3.0, 3.0, 0.0]]);
    assert!(matches!(
        refused(&fin),
        ClosedSurfaceError::Branched { count: 1, .. }
    ));
    let mut wild = cube();
    wild[4][1][2] = f64::NAN;
    assert!(matches!(
        refused(&wild),
        ClosedSurfaceError::NotFinite { triangle: 5 }
    ));
    assert!(matches!(
        refused(&cube()[..3]),
        ClosedSurfaceError::TooFew(3)
    ));
}

/// Points of a plane on the lines of a rectangle, and the same in disorder with further ones.
fn planes([a, b, c]: [f64; 3]) -> [Height; 2] {
    let x: Vec<f64> = (0..=16).map(|k| -3.2 + 0.4 * f64::from(k)).collect();
    let y: Vec<f64> = (0..=9).map(|k| -3.15 + 0.7 * f64::from(k)).collect();
    let height = |x: f64, y: f64| a * x + b * y + c;
    let row = |&y: &f64| x.iter().map(|&x| Some(height(x, y))).collect();
    let rows: Vec<Vec<_>> = y.iter().map(row).collect();
    let corners = [[-4.0, -4.0], [4.0, -4.0], [4.0, 4.0], [-4.0, 4.0]];
    let more = (0..200).map(|k| {
        let k = f64::from(k);
        [3.9 * (1.7 * k).sin(), 3.9 * (2.9 * k + 0.3).cos()]
    });
    let points = corners
        .into_iter()
        .chain(more)
        .map(|[x, y]| [x, y, height(x, y)]);
    let points: Vec<Point> = points.collect();
    [
        Height::Terrain(Arc::new(Terrain::on_lines(&x, &y, &rows).unwrap())),
        Height::Terrain(Arc::new(Terrain::scattered(&points).unwrap())),
    ]
}

/// Between planes the volume is the area times the distance at the centroid of the area.
#[test]
fn layers_between_planes_are_exact() {
    let plan = [
        [-2.9, -2.0],
        [2.5, -2.6],
        [2.0, 2.4],
        [0.1, 0.3],
        [-2.2, 2.0],
    ];
    let (area, [x, y]) = igimp_geometry::polygon::area_and_centroid(&plan);
    for (which, top) in planes([0.12, -0.07, 0.4]).into_iter().enumerate() {
        let bottom = planes([-0.05, 0.02, -1.3])[1 - which].clone();
        let gap = 0.17 * x - 0.09 * y + 1.7;
        let layer = Layer::new(&plan, bottom.clone(), top.clone()).unwrap();
        let found = sum(&layer, &grid(), 1e-10);
        assert!((found.volume / (area * gap) - 1.0).abs() < 1e-12, "{which}");
        for per_direction in 1..=3 {
            assert_columns_are_boxes(&layer, per_direction);
        }
        let below = Layer::new(&plan, Height::Level(-2.5), bottom).unwrap();
        let both = Layer::new(&plan, Height::Level(-2.5), top).unwrap();
        let below_found = sum(&below, &grid(), 1e-10);
        let both_found = sum(&both, &grid(), 1e-10);
        assert!((below_found.volume + found.volume - both_found.volume).abs() < 1e-12 * area);
        for axis in 0..3 {
            let moment = |part: Part<3>| part.volume * part.centroid[axis];
            let left = moment(below_found) + moment(found) - moment(both_found);
            assert!(left.abs() < 1e-11 * area, "{axis} {left:e}");
        }
        assert!(layer.encloses([0.0, -1.0, -0.5]) && !layer.encloses([0.1, 1.0, -0.5]));
        assert!(!layer.encloses([0.0, -1.0, 0.6]) && !layer.encloses([0.0, -1.0, -1.6]));
    }
}

#[test]
fn a_layer_may_pinch_out_and_is_bounded_by_its_own_ground() {
    let [top, _] = planes([0.0, 0.0, 0.0]);
    let x = [-3.2, 0.0, 3.2];
    let rows = vec![vec![Some(-1.0), Some(0.0), Some(0.0)]; 2];
    let bottom = Terrain::on_lines(&x, &[-3.0, 3.0], &rows).unwrap();
    let bottom = Height::Terrain(Arc::new(bottom));
    let plan = [[-1.6, -1.0], [2.0, -1.0], [2.0, 1.0], [-1.6, 1.0]];
    let wedge = Layer::new(&plan, bottom, top).unwrap();
    assert_near(
        sum(&wedge, &grid(), 1e-10),
        0.5 * 1.6 * 0.5 * 2.0,
        [-1.6 / 1.5, 0.0, -0.5 / 3.0],
        1e-12,
    );
    let (lower, upper) = wedge.bounds();
    assert!(
        (lower[2] + 0.5).abs() < 1e-12 && upper[2].abs() < 1e-12,
        "{lower:?} {upper:?}"
    );
}

#[test]
fn layers_that_cannot_be_say_where() {
    let plan = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]];
    let [flat, _] = planes([0.0, 0.0, 0.0]);
    let [tilted, _] = planes([0.5, 0.0, -0.5]);
    let crossing = Layer::new(&plan, tilted, flat.clone()).unwrap_err();
    let LayerError::Crossing { at, by } = crossing else {
        panic!("{crossing}");
    };
    assert!(
        (at[0] - 2.0).abs() < 1e-12 && (by - 0.5).abs() < 1e-12,
        "{at:?} {by}"
    );
    let wide = [[-2.0, -2.0], [4.2, -2.0], [4.2, 2.0], [-2.0, 2.0]];
    let short = Layer::new(&wide, Height::Level(-1.0), flat.clone()).unwrap_err();
    let LayerError::NotCovered { which, at, share } = short else {
        panic!("{short}");
    };
    assert!(
        which == "top" && at[0] > 3.19 && (share - 1.0 / 6.2).abs() < 1e-9,
        "{at:?} {share}"
    );
    // One height is missing, and with it the ground around it.
    let x: Vec<f64> = (0..=8).map(|k| f64::from(k) - 4.0).collect();
    let mut rows = vec![vec![Some(0.0); 9]; 9];
    rows[5][3] = None;
    let holed = Height::Terrain(Arc::new(Terrain::on_lines(&x, &x, &rows).unwrap()));
    let hole = Layer::new(&plan, Height::Level(-1.0), holed).unwrap_err();
    let LayerError::NotCovered { at, share, .. } = hole else {
        panic!("{hole}");
    };
    assert!(
        (at[0] + 1.0).abs() < 1.0 && (at[1] - 1.0).abs() < 1.0 && (share - 2.0 / 16.0).abs() < 1e-9
    );
    let empty = Layer::new(&plan, flat.clone(), flat).unwrap_err();
    assert!(matches!(empty, LayerError::Empty), "{empty}");
    let line = Terrain::scattered(&[[0.0; 3], [1.0, 1.0, 2.0], [2.0, 2.0, 1.0]]).unwrap_err();
    assert!(matches!(line, TerrainError::Flat), "{line}");
    let twice = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.5]];
    let twice = Terrain::scattered(&twice).unwrap_err();
    assert_eq!(twice.to_string(), "(1, 0) m has two heights, 0 m and 0.5 m");
}

#[test]
fn differences_of_solids() {
    let block = Solid::Cuboid([-2.0, -2.0, -2.0], [2.0, 2.0, 0.9]);
    let hole = Cylinder {
        axis: 2,
        centre: [0.4, -0.3],
        radius: 1.1,
        between: [-1.0, 5.0],
    };
    let holed = Solid::Difference(Difference {
        of: Box::new(block.clone()),
        minus: vec![Solid::Cylinder(hole.clone())],
    });
    let volume = 16.0 * 2.9 - PI * 1.21 * 1.9;
    let found = sum(&holed, &grid(), 1e-12);
    assert!((found.volume / volume - 1.0).abs() < 1e-12);
    assert!(!holed.encloses([0.4, -0.3, 0.0]) && holed.encloses([0.4, -0.3, -1.5]));
    // A slope without a box is exact; without a cylinder across it, nearly so.
    let slope = Solid::slice(&[[-2.0, -2.0], [2.0, -2.0], [-2.0, 1.0]], [-1.0, 1.0]);
    let without = |solid: Solid| {
        Solid::Difference(Difference {
            of: Box::new(slope.clone()),
            minus: vec![solid],
        })
    };
    let cut = without(Solid::Cuboid([-5.0, -5.0, -1.3], [5.0, 5.0, 5.0]));
    let below = 0.7 * 0.5 * (4.0 + 4.0 * (1.0 - 0.7 / 3.0)) * 2.0;
    assert!((sum(&cut, &grid(), 1e-12).volume / below - 1.0).abs() < 1e-12);
    let pit = Cylinder {
        axis: 2,
        centre: [0.0, 0.0],
        radius: 0.7,
        between: [-3.0, 5.0],
    };
    let pit = sum(&without(Solid::Cylinder(pit)), &grid(), 1e-9).volume;
    // The cylinder is as high as its axis.
    let exact = 12.0 - PI * 0.49 * 1.5;
    assert!((pit / exact - 1.0).abs() < 2e-4, "{:e}", pit / exact - 1.0);
}

/// A convex polyhedron: the hull of points on a ball, by all triples with the others on one side.
fn hull(points: &[Point]) -> Vec<[Point; 3]> {
    let mut faces = Vec::new();
    let minus = |a: Point, b: Point| -> Point { std::array::from_fn(|k| a[k] - b[k]) };
    for (i, &a) in points.iter().enumerate() {
        for (j, &b) in points.iter().enumerate().skip(i + 1) {
            for (k, &c) in points.iter().enumerate().skip(j + 1) {
                let (u, v) = (minus(b, a), minus(c, a));
                let normal = [
                    u[1] * v[2] - u[2] * v[1],
                    u[2] * v[0] - u[0] * v[2],
                    u[0] * v[1] - u[1] * v[0],
                ];
                let side = |x: Point| -> f64 { (0..3).map(|d| normal[d] * (x[d] - a[d])).sum() };
                let others = || (0..points.len()).filter(|other| ![i, j, k].contains(other));
                if others().all(|other| side(points[other]) < 0.0) {
                    faces.push([a, b, c]);
                } else if others().all(|other| side(points[other]) > 0.0) {
                    faces.push([a, c, b]);
                }
            }
        }
    }
    faces
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 60,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(20_261_122),
        ..ProptestConfig::default()
    })]

    #[test]
    fn convex_polyhedra_are_filled(
        points in prop::collection::vec((0.0..6.25, -0.99..0.99), 5..=14),
        sizes in [0.3..2.4, 0.3..2.4, 0.3..1.4],
        per_direction in 1_usize..=3,
    ) {
        let on_ball = |(angle, z): (f64, f64)| {
            let (sine, cosine) = angle.sin_cos();
            let radius = (1.0 - z * z).sqrt();
            [sizes[0] * radius * cosine, sizes[1] * radius * sine, sizes[2] * z - 0.3]
        };
        let points: Vec<Point> = points.into_iter().map(on_ball).collect();
        let faces = hull(&points);
        let Ok(surface) = ClosedSurface::new(&faces) else {
            // Points that nearly coincide or lie on one line.
            return Ok(());
        };
        let exact = enclosed(&faces);
        let found = sum(&surface, &grid(), 1e-10);
        prop_assert!((found.volume - exact.volume).abs() < 1e-11, "{} {}", found.volume, exact.volume);
        for axis in 0..3 {
            let off = (found.centroid[axis] - exact.centroid[axis]) * exact.volume;
            prop_assert!(off.abs() < 1e-11, "{off:e}");
        }
        if let Ok(seeds) = fill(&grid(), &surface, per_direction, 1.0, 0) {
            let volume: f64 = seeds.iter().map(|seed| seed.volume).sum();
            prop_assert!((volume - exact.volume).abs() < 1e-11);
            assert_columns_are_boxes(&surface, per_direction);
        }
    }
}
