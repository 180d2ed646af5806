//! Water that enters level ground from above: rain, ponds, free drainage, steady and in time.

use std::f64::consts::PI;

use crate::common::{faces, flow, grid, rectangle};
use igimp_geometry::solid::Prism;
use igimp_seepage::{Conditions, Course, Extent, Named, OnFaces, SeepageBody, Soil, march, solve};
use igimp_shape::{Axis, Grid};

/// Permeability of all columns \[m/s\].
const K: f64 = 1e-6;

/// Conditions of a column 4 m wide and 5 m high.
fn column(top: OnFaces, base: OnFaces) -> Conditions<2> {
    let soil = Soil {
        drainable: 0.2,
        specific_storage: 1e-4,
        ..Soil::isotropic(K)
    };
    let mut conditions = Conditions::of(vec![soil]);
    conditions.faces = vec![
        faces("top", [0.0, 5.0], [4.0, 5.0], top),
        faces("base", [0.0, 0.0], [4.0, 0.0], base),
    ];
    conditions
}

/// GOAL: level ground takes all it can, in the plane and around an axis, whatever its cells.
/// ORACLE: Darcy's law for a column of full pores, i = (h − h₀) / 5 m, and i = h / 5 m to the air; weaker rain enters whole.
#[test]
fn level_ground_takes_all_it_can() {
    let head = OnFaces::Head;
    let rain = |share: f64| OnFaces::Recharge(share * K);
    for (top, base, expected) in [
        (head(5.0), head(1.0), 0.8),
        (head(5.0), head(3.0), 0.4),
        (head(5.0), OnFaces::Open, 1.0),
        (head(5.05), OnFaces::Open, 1.01),
        (head(5.2), OnFaces::Open, 1.04),
        (rain(0.3), head(1.0), 0.3),
        (rain(0.6), head(1.0), 0.6),
        (rain(3.0), head(1.0), 0.8),
        (rain(0.9), OnFaces::Open, 0.9),
    ] {
        for (cell, cells) in [(0.5, [8, 10]), (0.25, [16, 20]), (0.125, [32, 40])] {
            for (axisymmetric, area) in [(false, 4.0), (true, 16.0 * PI)] {
                let mut conditions = column(top, base);
                conditions.axisymmetric = axisymmetric;
                let grid = grid([0.0, 0.0], cell, cells);
                let ground = rectangle([0.0, 0.0], [4.0, 5.0]);
                let found = flow(&grid, &[ground], &conditions).unwrap();
                let inflow = found.inflow / (K * area);
                println!("{top:?} {base:?} {cell} {axisymmetric}: {inflow:.5} of {expected}");
                assert!((inflow / expected - 1.0).abs() < 1e-6);
                assert!((found.inflow / found.outflow - 1.0).abs() < 1e-10);
            }
        }
    }
}

/// GOAL: the same in space. ORACLE: rain of 0.7 k enters whole, and of twice k the flow of full pores.
#[test]
fn level_ground_in_space_takes_all_it_can() {
    let axis = |count| Axis::uniform(0.0, 1.0, count).unwrap();
    let grid = Grid::new([axis(2), axis(1), axis(5)]);
    let ground = Prism::new(rectangle([0.0, 0.0], [2.0, 5.0]), 1, [0.0, 1.0]);
    for (rain, expected) in [(0.7, 0.7), (2.0, 0.8)] {
        let mut conditions = Conditions::of(vec![Soil::isotropic(K)]);
        let faces = [
            ("top", 5.0, OnFaces::Recharge(rain * K)),
            ("base", 0.0, OnFaces::Head(1.0)),
        ];
        conditions.faces = faces
            .map(|(name, level, condition)| Named {
                name: name.to_owned(),
                within: Extent {
                    lower: [0.0, 0.0, level],
                    upper: [2.0, 1.0, level],
                },
                condition,
            })
            .to_vec();
        let body = SeepageBody {
            region: &ground,
            soil: 0,
            scale: None,
        };
        let found = solve(&grid, &[body], &conditions, &|_| None).unwrap();
        assert!((found.inflow / (2.0 * K * expected) - 1.0).abs() < 1e-6);
    }
}

/// GOAL: rain enters drained soil whole until that is wet. ORACLE: rain of 0.3 k and 0.9 k for days; in the end the flow of full
/// pores, 0.8 k, and a head that falls straight.
#[test]
fn rain_enters_until_the_ground_is_wet() {
    let ground = rectangle([0.0, 0.0], [4.0, 5.0]);
    let body = SeepageBody {
        region: &ground,
        soil: 0,
        scale: None,
    };
    let day = 86_400.0;
    for (cell, cells) in [(0.5, [2, 10]), (0.25, [4, 20])] {
        for (share, in_the_end) in [(0.3, 0.3), (0.9, 0.8)] {
            let grid = grid([0.0, 0.0], cell, cells);
            let mut conditions = column(OnFaces::Recharge(0.0), OnFaces::Head(1.0));
            let start = solve(&grid, &[body], &conditions, &|_| None).unwrap();
            conditions.faces[0].condition = OnFaces::Recharge(share * K);
            let course = Course {
                histories: vec![None, None],
                times: vec![2.0 * day, 10.0 * day, 200.0 * day],
            };
            let found = march(&grid, &[body], (&start, &conditions), &|_| None, &course).unwrap();
            for time in &course.times[..2] {
                let row = found
                    .balance
                    .iter()
                    .find(|row| row.time.to_bits() == time.to_bits())
                    .unwrap();
                assert!((row.entered / (K * time * share) - 1.0).abs() < 1e-6);
                assert!(row.error < 1e-10);
            }
            let last = found.states.last().unwrap();
            println!("rain {share} on cells of {cell}: {:.5} k", last.outflow / K);
            assert!((last.outflow / (K * in_the_end) - 1.0).abs() < 1e-3);
        }
    }
}

/// GOAL: rain in a box round all of the ground falls on faces that rise, and opens no side and no base. ORACLE: all rain leaves
/// at the head; Dupuit, h² = h₁² + r (2 L x' − x'²) / k at the far side, ± 2 %.
#[test]
fn rain_opens_no_side_and_no_base() {
    let (rain, length, low) = (1e-7, 20.0_f64, 3.0_f64);
    let permeability = 1e-5;
    let mut conditions = Conditions::of(vec![Soil::isotropic(permeability)]);
    conditions.faces = vec![
        faces("rain", [-1.0, -1.0], [21.0, 9.0], OnFaces::Recharge(rain)),
        faces("side", [20.0, 0.0], [20.0, 3.0], OnFaces::Head(low)),
    ];
    let grid = grid([0.0, 0.0], 0.5, [40, 16]);
    let found = flow(&grid, &[rectangle([0.0, 0.0], [20.0, 8.0])], &conditions).unwrap();
    let level = found.free_surface(&[0.0, 0.0]).unwrap();
    let expected = (low * low + rain * length * length / permeability).sqrt();
    println!(
        "rain {:.4e}, level {level:.3} of {expected:.3}",
        found.outflow
    );
    assert!((found.outflow / (rain * length) - 1.0).abs() < 1e-6);
    assert!((level / expected - 1.0).abs() < 0.02);
}
