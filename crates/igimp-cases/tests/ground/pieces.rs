//! GOAL: bodies are drawn in pieces that are theirs, at rest and after they moved.
//! ORACLE: areas of the bodies, and of what they were mapped to.

use std::sync::Arc;

use igimp_assembly::{ParticleFields, Particles};

use igimp_cases::run::Model;
use igimp_geometry::polygon::{Polygon, area_and_centroid};
use igimp_input::CaseFile;
use igimp_model::Case;
use igimp_report::patches::Pieces;

use crate::block;

fn slope() -> Case<2> {
    let mut case = block();
    case.bodies[0].region = Arc::new(vec![[0.0, 0.0], [3.0, 0.0], [1.3, 1.7], [0.0, 1.7]]);
    case
}

fn area(polygons: &[Polygon]) -> f64 {
    polygons
        .iter()
        .map(|polygon| area_and_centroid(polygon).0)
        .sum()
}

/// GOAL: a slope is drawn along its line: the pieces of bodies at rest are the bodies.
#[test]
fn bodies_at_rest_are_drawn_as_they_are() {
    let case = slope();
    let particles = Model::new(&case).unwrap().1.body.particles;
    let pieces = Pieces::of(&case).unwrap();
    let whole = area_and_centroid(case.bodies[0].polygon()).0;
    assert!((area(&pieces.now(&particles).0) - whole).abs() < 1e-12 * whole);
    let inside = |&[x, y]: &[f64; 2]| y <= 1.7 + 1e-12 && x + y <= 3.0 + 1e-12;
    assert!(pieces.now(&particles).0.iter().flatten().all(inside));
    let edges = pieces.edges(&particles);
    assert!((area(&edges) - whole).abs() < 1e-12 * whole);
}

/// GOAL: bodies that were taken away, or are not yet there, are not drawn, and the others by their own particles.
#[test]
fn only_what_is_there_is_drawn() {
    let mut case = slope();
    let mut hill = case.bodies[0].clone();
    hill.region = Arc::new(vec![[0.0, 1.7], [1.3, 1.7], [0.8, 2.4], [0.0, 2.4]]);
    let area_of_hill = area_and_centroid(hill.polygon()).0;
    case.bodies.push(hill);
    let all = Model::new(&case).unwrap().1.body.particles;
    let below = Model::new(&slope()).unwrap().1.body.particles.len();
    let of_hill = |particle: usize| all.number[particle] >= below;
    let pieces = Pieces::of(&case).unwrap();
    assert_eq!(pieces.there(&all), [true, true]);
    let left = all.keeping(of_hill).unwrap();
    assert_eq!(pieces.there(&left), [false, true]);
    let (polygons, whose) = pieces.now(&left);
    assert!(whose.iter().all(|&place| place < left.len()));
    assert!((area(&polygons) - area_of_hill).abs() < 1e-12 * area_of_hill);
    assert!((area(&pieces.edges(&left)) - area_of_hill).abs() < 1e-12 * area_of_hill);
    // The same particles in another order are the same picture.
    let below = all.keeping(|particle| !of_hill(particle)).unwrap();
    let turned = left.joined_by(&below);
    assert_eq!(pieces.edges(&turned), pieces.edges(&all));
    let drawn = |particles: &Particles<2>| {
        let (polygons, whose) = pieces.now(particles);
        std::iter::zip(polygons, whose)
            .map(|(piece, place)| (piece, particles.number[place]))
            .collect::<Vec<_>>()
    };
    assert_eq!(drawn(&turned), drawn(&all));
}

/// GOAL: neighbours that deform differently leave no gaps, soil that parts is not drawn as joined.
#[test]
fn neighbours_meet_and_parted_soil_does_not() {
    let case = slope();
    let start = Model::new(&case).unwrap().1.body.particles;
    let pieces = Pieces::of(&case).unwrap();
    let with = |moved: &dyn Fn([f64; 2]) -> [f64; 2]| {
        let mut fields: ParticleFields<2> = (*start).clone();
        for x in &mut fields.x {
            *x = moved(*x);
        }
        Particles::from_fields(fields).unwrap()
    };
    // Particles move apart by a fifth of their size and do not know of it.
    let spread = with(&|[x, y]| [1.2 * x, y]);
    let polygons = pieces.now(&spread).0;
    let edges = pieces.edges(&spread);
    assert_eq!(edges.len(), 1);
    assert!((area(&polygons) - area(&edges)).abs() < 1e-12 * area(&edges));
    let parted = with(&|[x, y]| [if x > 1.0 { x + 5.0 } else { x }, y]);
    let across = |polygon: &Polygon| {
        let [low, high] = polygon
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], p| {
                [a.min(p[0]), b.max(p[0])]
            });
        high - low
    };
    assert!(
        pieces
            .now(&parted)
            .0
            .iter()
            .all(|polygon| across(polygon) < 0.3)
    );
}

/// GOAL: soil in one motion has neither gaps nor combs: under simple shear and a turn the pieces
/// tile the moved body.
#[test]
fn one_motion_leaves_no_gaps() {
    let case = slope();
    let particles = Model::new(&case).unwrap().1.body.particles;
    let f = [[0.8, 1.1], [-0.5, 1.4]];
    let moved = |[x, y]: [f64; 2]| [0, 1].map(|a| 5.0 + f[a][0] * x + f[a][1] * y);
    let mut fields: ParticleFields<2> = (*particles).clone();
    for particle in 0..fields.x.len() {
        fields.x[particle] = moved(fields.x[particle]);
        fields.def_grad[particle] = f;
    }
    let particles = Particles::from_fields(fields).unwrap();
    let pieces = Pieces::of(&case).unwrap();
    let outline: Polygon = case.bodies[0].polygon().iter().map(|&x| moved(x)).collect();
    let whole = area_and_centroid(&outline).0;
    assert!((area(&pieces.now(&particles).0) - whole).abs() < 1e-12 * whole);
    assert!((area(&pieces.edges(&particles)) - whole).abs() < 1e-12 * whole);
}

/// GOAL: a side that round-off puts a hair beyond a line of the grid has no slivers: the edge of the body is one closed line.
/// ORACLE: the square, ten cells of 1 cm wide; 10 · 0.01 is not 0.1 in binary.
#[test]
fn round_off_makes_no_slivers() {
    let shipped = igimp_input::shipped::find("column_collapse").unwrap();
    let file = CaseFile::parse("column_collapse.toml", shipped.text, &[]).unwrap();
    let case = file.case().clone();
    let side = 0.1;
    let particles = Model::new(&case).unwrap().1.body.particles;
    let pieces = Pieces::of(&case).unwrap();
    let (polygons, _) = pieces.now(&particles);
    assert!(polygons.iter().all(|polygon| polygon.len() > 2));
    let edges = pieces.edges(&particles);
    assert_eq!(edges.len(), 1);
    assert_eq!(edges[0].first(), edges[0].last());
    assert!((area(&edges) - side * side).abs() < 1e-9 * side * side);
}
