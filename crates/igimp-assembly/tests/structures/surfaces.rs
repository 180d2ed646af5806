//! GOAL: surfaces know their distances, carry tents that cover them, and refuse what is none.
//! BODY: polygons and circles, boxes, prisms, cylinders, cones, spheres, and surfaces of triangles.
//! ORACLE: closed forms of distances and areas; rays and the sum over all triangles.

use crate::common::Random;
use igimp_assembly::{Interface, RigidBody, Surface, SurfaceError};

fn block(half: [f64; 3]) -> Surface<3> {
    Surface::cuboid(half, 0.0, 0.4).unwrap()
}

/// Distance of a point to a segment.
fn to_segment(x: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (along, arm) = ([b[0] - a[0], b[1] - a[1]], [x[0] - a[0], x[1] - a[1]]);
    let t = (arm[0] * along[0] + arm[1] * along[1]) / (along[0].powi(2) + along[1].powi(2));
    let t = t.clamp(0.0, 1.0);
    (arm[0] - t * along[0]).hypot(arm[1] - t * along[1])
}

/// The distance to a polygon that is not convex, either way round, is that to its nearest edge, with the
/// sign of the number of edges that a ray crosses.
#[test]
fn distance_to_a_polygon() {
    let ell = [
        [0.0, 0.0],
        [3.0, 0.0],
        [3.0, 1.0],
        [1.0, 1.0],
        [1.0, 2.5],
        [0.0, 2.5],
    ];
    let mut turned = ell;
    turned.reverse();
    let mut random = Random(3);
    for corners in [ell, turned] {
        let surface = Surface::polygon(&corners, 0.0, 0.4).unwrap();
        let sides = vec![Interface::smooth(); surface.side_count()];
        let mut body = RigidBody::new(surface, sides, [0.5, -0.7]);
        body.pose = body.pose.moved(&[0.1, 0.3], &[0.7, 0.0, 0.0]);
        for _ in 0..400 {
            let x = [
                1.5 + 3.0 * random.symmetric(),
                1.2 + 3.0 * random.symmetric(),
            ];
            let edges = || (0..6).map(|k| (corners[k], corners[(k + 1) % 6]));
            let least = edges()
                .map(|(a, b)| to_segment(x, a, b))
                .fold(f64::INFINITY, f64::min);
            let crossed = edges()
                .filter(|(a, b)| (a[1] > x[1]) != (b[1] > x[1]))
                .filter(|(a, b)| x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
                .count();
            let expected = if crossed % 2 == 1 { -least } else { least };
            let found = body.distance(&body.pose.into_space(&x));
            assert!(
                (found - expected).abs() < 1e-12,
                "{x:?}: {found} {expected}"
            );
        }
    }
}

/// The distance to a rectangle with rounded corners is that to its core, less the radius.
#[test]
fn distance_to_a_rounded_rectangle() {
    let corners = [[-1.0, -0.5], [1.0, -0.5], [1.0, 0.5], [-1.0, 0.5]];
    let surface = Surface::polygon(&corners, 0.2, 0.3).unwrap();
    let body = RigidBody::new(surface, vec![Interface::smooth(); 4], [0.0; 2]);
    let mut random = Random(9);
    for _ in 0..400 {
        let x = [1.6 * random.symmetric(), 1.1 * random.symmetric()];
        let beyond = [x[0].abs() - 0.8, x[1].abs() - 0.3];
        let outside = beyond[0].max(0.0).hypot(beyond[1].max(0.0));
        let expected = outside + beyond[0].max(beyond[1]).min(0.0) - 0.2;
        assert!((body.distance(&x) - expected).abs() < 1e-12, "{x:?}");
    }
}

/// A surface that would have knots without end is refused before any is made.
#[test]
fn endless_surfaces_are_refused() {
    for far in [1e9, 1e300, f64::MAX, f64::INFINITY] {
        let corners = [[0.0, 0.0], [far, 0.0], [0.0, 1.0]];
        let refused = Surface::polygon(&corners, 0.0, 0.1).unwrap_err();
        assert!(matches!(refused, SurfaceError::TooLong { .. }), "{refused}");
        assert!(Surface::circle(far, 0.1).is_err());
    }
    assert!(Surface::polygon(&[[0.0, 0.0], [1e3, 0.0], [0.0, 1.0]], 0.0, 0.1).is_ok());
}

#[test]
fn distance_to_a_circle() {
    let surface = Surface::circle(0.8, 0.1).unwrap();
    let body = RigidBody::new(surface, vec![Interface::smooth()], [0.3, -0.2]);
    let mut random = Random(4);
    for _ in 0..100 {
        let x = [2.0 * random.symmetric(), 2.0 * random.symmetric()];
        let expected = (x[0] - 0.3).hypot(x[1] + 0.2) - 0.8;
        assert!((body.distance(&x) - expected).abs() < 1e-12);
    }
}

/// The distance to a turned box: outside that to the box of its half-lengths, inside to the nearest side.
#[test]
fn distance_to_a_box() {
    let half = [1.0, 0.5, 0.75];
    let mut body = RigidBody::new(block(half), vec![Interface::smooth(); 6], [1.0, 2.0, 3.0]);
    body.pose = body.pose.moved(&[0.0; 3], &[0.3, -0.5, 0.9]);
    let mut random = Random(6);
    let mut within = 0;
    for _ in 0..400 {
        let x: [f64; 3] = std::array::from_fn(|_| 1.6 * random.symmetric());
        let beyond: [f64; 3] = std::array::from_fn(|a| x[a].abs() - half[a]);
        let outside = beyond
            .map(|b| b.max(0.0).powi(2))
            .iter()
            .sum::<f64>()
            .sqrt();
        let inside = beyond
            .into_iter()
            .fold(f64::NEG_INFINITY, f64::max)
            .min(0.0);
        within += usize::from(inside < 0.0);
        let found = body.distance(&body.pose.into_space(&x));
        assert!((found - outside - inside).abs() < 1e-12, "{x:?}: {found}");
    }
    assert!(within > 20);
}

/// The distance to a tetrahedron: inside the height above the nearest side; outside at least that, and
/// exactly that above the middle of a side and beyond a corner.
#[test]
fn distance_to_a_tetrahedron() {
    let corners = [
        [1.0, 1.0, 1.0],
        [1.0, -1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
    ];
    let sides = [
        ([0, 1, 2], 0),
        ([0, 3, 1], 1),
        ([0, 2, 3], 2),
        ([1, 3, 2], 3),
    ];
    let surface = Surface::triangles(&corners, &sides, 0.7).unwrap();
    let body = RigidBody::new(surface, vec![Interface::smooth(); 4], [0.0; 3]);
    let root = 3.0_f64.sqrt();
    // Its insphere has radius 1/√3, and the normals of its sides point away from its corners.
    let height = |x: &[f64; 3]| {
        let above =
            |corner: &[f64; 3]| -(0..3).map(|a| corner[a] * x[a]).sum::<f64>() / root - 1.0 / root;
        corners.iter().map(above).fold(f64::NEG_INFINITY, f64::max)
    };
    let mut random = Random(8);
    for _ in 0..400 {
        let x: [f64; 3] = std::array::from_fn(|_| 1.2 * random.symmetric());
        let (found, height) = (body.distance(&x), height(&x));
        if height < 0.0 {
            assert!((found - height).abs() < 1e-12, "{x:?}: {found} {height}");
        } else {
            assert!(found > height - 1e-12, "{x:?}: {found} {height}");
        }
    }
    for corner in corners {
        for far in [0.1, 1.0, 3.0] {
            let beyond = corner.map(|c| c * (1.0 + far));
            assert!((body.distance(&beyond) - far * root).abs() < 1e-12);
            let opposite = corner.map(|c| -c * (1.0 / 3.0 + far));
            assert!((body.distance(&opposite) - far * root).abs() < 1e-12);
        }
    }
}

fn body(surface: Surface<3>) -> RigidBody<3> {
    let sides = vec![Interface::smooth(); surface.side_count()];
    RigidBody::new(surface, sides, [0.0; 3])
}

/// Area by side, from the triangles that carry contact.
fn areas(surface: &Surface<3>) -> Vec<f64> {
    let mut areas = vec![0.0; surface.side_count()];
    for ([a, b, c], shares, side) in surface.facets() {
        let (u, v): ([f64; 3], [f64; 3]) = (
            std::array::from_fn(|k| b[k] - a[k]),
            std::array::from_fn(|k| c[k] - a[k]),
        );
        let n = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        areas[side] += 0.5 * n.iter().map(|n| n * n).sum::<f64>().sqrt();
        for corner in shares {
            let sum: f64 = corner.iter().map(|(_, share)| share).sum();
            assert!((sum - 1.0).abs() < 1e-15);
        }
    }
    areas
}

/// The distance to a box with rounded edges is that to its core, less the radius; its sides carry up to where they
/// are rounded.
#[test]
fn a_rounded_box() {
    let surface = Surface::cuboid([1.0, 0.6, 0.8], 0.2, 0.15).unwrap();
    let sides = areas(&surface);
    for (side, expected) in [(0, 0.8 * 1.2), (3, 1.6 * 1.2), (5, 1.6 * 0.8)] {
        assert!(
            (sides[side] - expected).abs() < 1e-12,
            "{side}: {}",
            sides[side]
        );
    }
    let body = body(surface);
    let mut random = Random(12);
    for _ in 0..400 {
        let x: [f64; 3] = std::array::from_fn(|_| 1.5 * random.symmetric());
        let beyond: [f64; 3] = std::array::from_fn(|a| x[a].abs() - [0.8, 0.4, 0.6][a]);
        let outside = beyond
            .map(|b| b.max(0.0).powi(2))
            .iter()
            .sum::<f64>()
            .sqrt();
        let inside = beyond
            .into_iter()
            .fold(f64::NEG_INFINITY, f64::max)
            .min(0.0);
        let found = body.distance(&x);
        assert!(
            (found - outside - inside + 0.2).abs() < 1e-12,
            "{x:?}: {found}"
        );
    }
}

/// Ends of a cylinder about any axis are as large as the circle, and distances are those of the cylinder but for the
/// polygon around it.
#[test]
fn cylinders() {
    use std::f64::consts::PI;
    for axis in 0..3 {
        let surface = Surface::cylinder(axis, 1.0, 0.7, 0.1, 0.2).unwrap();
        let sides = areas(&surface);
        let end = PI * 0.9_f64.powi(2);
        assert!((sides[0] - end).abs() < 1e-12 && (sides[2] - end).abs() < 1e-12);
        assert!(
            (sides[1] / (2.0 * PI * 1.2) - 1.0).abs() < 0.01,
            "{}",
            sides[1]
        );
        let body = body(surface);
        let mut random = Random(13);
        for _ in 0..300 {
            let x: [f64; 3] = std::array::from_fn(|_| 1.5 * random.symmetric());
            let radius = x[(axis + 1) % 3].hypot(x[(axis + 2) % 3]);
            let (r, z) = (radius - 0.9, x[axis].abs() - 0.6);
            let expected = r.max(0.0).hypot(z.max(0.0)) + r.max(z).min(0.0) - 0.1;
            let found = body.distance(&x);
            assert!((found - expected).abs() < 0.01, "{x:?}: {found} {expected}");
        }
    }
}

/// The face of a cone, and its distance: that to its generator in the half-plane of a point.
#[test]
fn cones() {
    use std::f64::consts::PI;
    let surface = Surface::cone(2, [1.0, 2.0, 1.5], 0.0, 0.15).unwrap();
    let sides = areas(&surface);
    let exact = [PI * 5.0_f64.sqrt(), 2.0 * PI * 1.5, PI];
    for (found, exact) in sides.iter().zip(exact) {
        assert!((found / exact - 1.0).abs() < 0.01, "{found} {exact}");
    }
    let body = body(surface);
    let profile = [[0.0, 0.0], [1.0, 2.0], [1.0, 3.5], [0.0, 3.5]];
    let mut random = Random(14);
    let mut within = 0;
    for _ in 0..400 {
        let mut x: [f64; 3] = std::array::from_fn(|_| 1.5 * random.symmetric());
        x[2] += 1.5;
        let point = [x[0].hypot(x[1]), x[2]];
        let least = profile
            .windows(2)
            .map(|ab| to_segment(point, ab[0], ab[1]))
            .fold(f64::INFINITY, f64::min);
        let is_inside = point[0] < (0.5 * point[1]).min(1.0) && point[1] < 3.5;
        within += usize::from(is_inside);
        let expected = if is_inside { -least } else { least };
        let found = body.distance(&x);
        assert!((found - expected).abs() < 0.02, "{x:?}: {found} {expected}");
    }
    assert!(within > 20);
    assert_eq!(
        Surface::cone(0, [1.0, 2.0, 0.0], 0.0, 0.3)
            .unwrap()
            .side_count(),
        2
    );
}

/// A surface that is shifted has the distances of one that was not, elsewhere.
#[test]
fn shifted_surfaces() {
    let surface = Surface::cylinder(1, 1.0, 0.7, 0.1, 0.3).unwrap();
    let (first, by) = (body(surface.clone()), [0.3, -2.0, 1.0]);
    let second = body(surface.shifted(by));
    let ([lower, upper], knots) = (
        [second.surface.bounds().0, second.surface.bounds().1],
        second.surface.knots(),
    );
    for (place, _) in knots {
        assert!((0..3).all(|a| lower[a] - 1e-12 < place[a] && place[a] < upper[a] + 1e-12));
    }
    let mut random = Random(18);
    for _ in 0..200 {
        let x: [f64; 3] = std::array::from_fn(|_| 1.5 * random.symmetric());
        let moved = std::array::from_fn(|a| x[a] + by[a]);
        assert!((first.distance(&x) - second.distance(&moved)).abs() < 1e-12);
    }
}

/// A sphere has its exact distance, and facets that nearly cover it.
#[test]
fn spheres() {
    let surface = Surface::sphere(2.0, 0.3).unwrap();
    let exact = 16.0 * std::f64::consts::PI;
    let found = areas(&surface)[0];
    assert!(found < exact && found > 0.99 * exact, "{found}");
    let body = body(surface);
    let mut random = Random(15);
    for _ in 0..100 {
        let x: [f64; 3] = std::array::from_fn(|_| 4.0 * random.symmetric());
        let expected = x.iter().map(|x| x * x).sum::<f64>().sqrt() - 2.0;
        assert!((body.distance(&x) - expected).abs() < 1e-12);
    }
}

/// An L that is extruded along each axis, whichever way round its corners run: distances are those to the
/// polygon and to its ends.
#[test]
fn prisms() {
    let ell = [
        [0.0, 0.0],
        [3.0, 0.0],
        [3.0, 1.0],
        [1.0, 1.0],
        [1.0, 2.5],
        [0.0, 2.5],
    ];
    let mut turned = ell;
    turned.reverse();
    let plane = Surface::polygon(&ell, 0.0, 0.4).unwrap();
    let plane = RigidBody::new(plane, vec![Interface::smooth(); 6], [0.0; 2]);
    for (axis, corners) in [(0, ell), (1, turned), (2, ell)] {
        let surface = Surface::prism(axis, &corners, [-0.5, 1.0], 0.0, 0.4).unwrap();
        let sides = areas(&surface);
        assert_eq!(sides.len(), 8);
        assert!((sides[6] - 4.5).abs() < 1e-12 && (sides[7] - 4.5).abs() < 1e-12);
        let around: f64 = sides[..6].iter().sum();
        assert!((around - 11.0 * 1.5).abs() < 1e-12);
        let body = body(surface);
        let mut random = Random(16);
        for _ in 0..200 {
            let point = [
                1.5 + 2.5 * random.symmetric(),
                1.2 + 2.0 * random.symmetric(),
            ];
            let along = 0.25 + 1.5 * random.symmetric();
            let mut x = [0.0; 3];
            x[axis] = along;
            x[(axis + 1) % 3] = point[0];
            x[(axis + 2) % 3] = point[1];
            let (r, z) = (plane.distance(&point), (along - 0.25).abs() - 0.75);
            let expected = r.max(0.0).hypot(z.max(0.0)) + r.max(z).min(0.0);
            let found = body.distance(&x);
            assert!(
                (found - expected).abs() < 1e-12,
                "{x:?}: {found} {expected}"
            );
        }
    }
}

/// A torus of thousands of triangles: knots are about as far apart as asked for, and the distance is that to
/// the nearest triangle.
#[test]
fn many_triangles() {
    use std::f64::consts::TAU;
    let (around, about) = (120, 60);
    let at = |i: usize, j: usize| {
        let (u, v) = (
            TAU * i as f64 / around as f64,
            TAU * j as f64 / about as f64,
        );
        let r = 3.0 + v.cos();
        [r * u.cos(), r * u.sin(), v.sin()]
    };
    let corners: Vec<[f64; 3]> = (0..around * about)
        .map(|k| at(k / about, k % about))
        .collect();
    let number = |i: usize, j: usize| i % around * about + j % about;
    let triangles: Vec<([usize; 3], usize)> = (0..around * about)
        .flat_map(|k| {
            let (i, j) = (k / about, k % about);
            let [a, b, c, d] =
                [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| number(i, j));
            [([a, b, c], 0), ([a, c, d], 0)]
        })
        .collect();
    let surface = Surface::triangles(&corners, &triangles, 0.5).unwrap();
    assert_eq!(surface.facets().count(), 14_400);
    let squares = TAU * TAU * 3.0 / 0.25;
    let knots = surface.knot_count() as f64;
    assert!(
        knots > 0.8 * squares && knots < 3.0 * squares,
        "{knots} {squares}"
    );
    let body = body(surface);
    let mut random = Random(17);
    for _ in 0..20_000 {
        let x: [f64; 3] = std::array::from_fn(|a| [4.5, 4.5, 1.5][a] * random.symmetric());
        let expected = (x[0].hypot(x[1]) - 3.0).hypot(x[2]) - 1.0;
        let found = body.distance(&x);
        assert!((found - expected).abs() < 0.01, "{x:?}: {found} {expected}");
    }
}

/// A surface that is not closed is refused, with the place.
#[test]
fn open_and_twisted_surfaces_are_refused() {
    let corners = [
        [1.0, 1.0, 1.0],
        [1.0, -1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
        [9.0, 9.0, 9.0],
    ];
    let whole = [
        ([0, 1, 2], 0),
        ([0, 3, 1], 0),
        ([0, 2, 3], 0),
        ([1, 3, 2], 0),
    ];
    let made = |triangles: &[([usize; 3], usize)]| Surface::triangles(&corners, triangles, 1.0);
    assert!(made(&whole).is_ok());
    assert_eq!(made(&whole[..3]).unwrap_err(), SurfaceError::TooFewCorners);
    let mut hole = whole.to_vec();
    hole.push(([1, 3, 4], 0));
    hole.remove(3);
    let refused = made(&hole).unwrap_err();
    assert!(matches!(refused, SurfaceError::Open { .. }), "{refused}");
    let mut twisted = whole;
    twisted[2].0.swap(0, 1);
    let refused = made(&twisted).unwrap_err();
    assert!(matches!(refused, SurfaceError::Twisted { .. }), "{refused}");
    assert!(refused.to_string().contains("the same way round"));
    let mut flat = whole;
    flat[1].0 = [0, 3, 3];
    let refused = made(&flat).unwrap_err();
    assert!(matches!(
        refused,
        SurfaceError::FlatTriangle { triangle: 1, .. }
    ));
    let mut unknown = whole;
    unknown[3].0[2] = 5;
    let refused = made(&unknown).unwrap_err();
    assert!(matches!(
        refused,
        SurfaceError::UnknownCorner {
            triangle: 3,
            corner: 5,
            count: 5
        }
    ));
    let mut gap = whole;
    gap[3].1 = 2;
    assert_eq!(
        made(&gap).unwrap_err(),
        SurfaceError::NoSuchSide { side: 1 }
    );
    // All of them the other way round is a surface too.
    let inside_out = whole.map(|([a, b, c], side)| ([a, c, b], side));
    assert!(
        (body(made(&inside_out).unwrap()).distance(&[0.0; 3]) + 1.0 / 3.0_f64.sqrt()).abs() < 1e-12
    );
}

/// Shapes that are too large, that cross themselves, and whose edges are rounded away are refused.
#[test]
fn shapes_that_make_no_surface_are_refused() {
    for far in [1e9, 1e300, f64::INFINITY] {
        assert!(Surface::sphere(far, 0.1).is_err());
        assert!(Surface::cuboid([far, 1.0, 1.0], 0.0, 1e-3).is_err());
        assert!(Surface::cylinder(2, 1.0, far, 0.0, 1e-3).is_err());
        assert!(
            Surface::prism(
                2,
                &[[0.0, 0.0], [far, 0.0], [0.0, 1.0]],
                [0.0, 1.0],
                0.0,
                1e-3
            )
            .is_err()
        );
    }
    let crossing = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.1]];
    assert!(Surface::prism(2, &crossing, [0.0, 1.0], 0.0, 0.5).is_err());
    let thin = Surface::cylinder(2, 1.0, 0.1, 0.2, 0.1).unwrap_err();
    assert!(
        matches!(thin, SurfaceError::RoundedAway { side: 1, .. }),
        "{thin}"
    );
    let off = Surface::revolved(2, &[[0.1, 0.0], [1.0, 0.0], [0.0, 1.0]], 0.0, 0.1).unwrap_err();
    assert!(
        matches!(off, SurfaceError::OffAxis { corner: 0, .. }),
        "{off}"
    );
}
