//! Flow with a free surface, rain and drains, in the plane and in space.

use crate::common::{faces, flow, grid, rectangle};
use igimp_geometry::region::Region;
use igimp_geometry::solid::Prism;
use igimp_seepage::{
    Conditions, Curve, Extent, InGround, Named, OnFaces, SeepageBody, Soil, solve,
};
use igimp_shape::{Axis, Grid};

/// GOAL: a mound under rain, with a free surface and with a capillary fringe.
/// ORACLE: the outflow on the right is P L / 2 + k (h₁² − h₂²) / (2 L), by the integral that gives Charny's discharge; programs
/// that carry water in a fringe, whose curve is not known, have a crest of 4.49 m to 4.61 m at 4.06 m. Gardner's 1/α of half a metre is
/// fitted to the crest; its place is not.
#[test]
fn a_mound_under_rain() {
    for curve in [
        Curve::Ramp,
        Curve::Gardner { alpha: 2.0 },
        Curve::VanGenuchten { alpha: 3.0, n: 3.0 },
    ] {
        let grid = grid([0.0, 0.0], 0.25, [40, 20]);
        let soil = Soil {
            curve,
            ..Soil::isotropic(1e-5)
        };
        let mut conditions = Conditions::of(vec![soil]);
        conditions.faces = vec![
            faces("rain", [0.0, 5.0], [10.0, 5.0], OnFaces::Recharge(2.5e-6)),
            faces("left", [0.0, 0.0], [0.0, 5.0], OnFaces::Head(3.75)),
            faces("right", [10.0, 0.0], [10.0, 5.0], OnFaces::Head(3.0)),
        ];
        let found = flow(&grid, &[rectangle([0.0, 0.0], [10.0, 5.0])], &conditions).unwrap();
        let level = |k: u32| found.free_surface(&[0.01 * f64::from(k), 0.0]).unwrap();
        let crest = (0..=1000).map(|k| (k, level(k)));
        let (at, crest) = crest.reduce(|a, b| if b.1 > a.1 { b } else { a }).unwrap();
        let at = 0.01 * f64::from(at);
        println!("mound {curve:?}: crest {crest:.3} at {at}");
        assert!((found.discharges[0].inflow / 2.5e-5 - 1.0).abs() < 1e-6);
        assert!((found.inflow / found.outflow - 1.0).abs() < 1e-10);
        assert!((at - 4.06).abs() < 0.25);
        if curve == Curve::Ramp {
            let right = 1.25e-5 + 1e-5 * (3.75_f64.powi(2) - 9.0) / 20.0;
            assert!((found.discharges[2].outflow / right - 1.0).abs() < 0.01);
        }
        if let Curve::Gardner { .. } = curve {
            assert!((4.49..=4.61).contains(&crest));
        }
    }
}

/// GOAL: a dam with a toe drain, faces off the lines of the grid.
/// ORACLE: the free surface of published programs, whose soil carries water in a fringe of a curve that is not known: one fitted
/// number, 1/α of an eighth of a metre, has to meet all three levels within 1 %. Without a fringe the surface lies higher.
#[test]
fn a_dam_with_a_toe_drain() {
    for curve in [Curve::Gardner { alpha: 8.0 }, Curve::Ramp] {
        let grid = grid([0.0, 0.0], 0.25, [96, 20]);
        let ground = vec![
            [0.0, 0.0],
            [21.9, 0.0],
            [23.4857, 1.5016],
            [12.5, 5.0],
            [10.0, 5.0],
        ];
        let soil = Soil {
            curve,
            ..Soil::isotropic(1e-5)
        };
        let mut conditions = Conditions::of(vec![soil]);
        conditions.faces = vec![
            faces("pond", [0.0, 0.0], [8.0, 4.0], OnFaces::Head(4.0)),
            faces("base", [0.0, 0.0], [21.9, 0.0], OnFaces::Closed),
            faces("drain", [21.9, 0.0], [23.4857, 1.5016], OnFaces::Open),
        ];
        let found = flow(&grid, &[ground], &conditions).unwrap();
        for (x, known) in [(14.0, 2.878), (18.0, 2.024), (20.0, 1.427)] {
            let level = found.free_surface(&[x, 0.0]).unwrap();
            println!("toe drain {curve:?} x {x}: {level:.4} of {known}");
            match curve {
                Curve::Ramp => assert!(level > known),
                _ => assert!((level / known - 1.0).abs() < 0.01),
            }
        }
        assert!((found.inflow / found.outflow - 1.0).abs() < 1e-10);
    }
}

/// GOAL: a drain in the ground draws the free surface down, and takes the inflow; ponds give heads by themselves.
/// ORACLE: the balance; the surface at the drain is no higher than the drain.
#[test]
fn a_drain_under_a_slope() {
    let grid = grid([0.0, 0.0], 0.5, [40, 16]);
    let ground = vec![
        [0.0, 0.0],
        [20.0, 0.0],
        [20.0, 1.0],
        [8.0, 7.0],
        [6.0, 7.0],
        [2.0, 3.0],
        [0.0, 3.0],
    ];
    let region: &dyn Region<2> = &ground;
    let body = SeepageBody {
        region,
        soil: 0,
        scale: None,
    };
    let mut conditions = Conditions::of(vec![Soil::isotropic(1e-6)]);
    let pond = |_: &[f64; 2]| Some(6.0);
    let level = |x: &[f64; 2]| if x[0] < 7.0 { pond(x) } else { None };
    let without = solve(&grid, &[body], &conditions, &level).unwrap();
    conditions.regions = vec![Named {
        name: "drain".to_owned(),
        within: Extent {
            lower: [12.0, 0.5],
            upper: [13.0, 1.5],
        },
        condition: InGround::Drain,
    }];
    let with = solve(&grid, &[body], &conditions, &level).unwrap();
    let at = |flow: &igimp_seepage::Seepage<2>| flow.free_surface(&[12.5, 0.0]).unwrap();
    assert!(
        at(&without) > 2.0 && at(&with) < 1.6,
        "{} {}",
        at(&without),
        at(&with)
    );
    assert!(with.discharges[2].outflow > 0.9 * with.inflow);
    assert!(with.inflow > without.inflow);
    assert!((with.inflow / with.outflow - 1.0).abs() < 1e-10);
}

/// GOAL: in space as in the plane. ORACLE: Charny's discharge times the width; the same surface at any place across.
#[test]
fn a_dam_in_space() {
    let axis = |size: f64, cells: usize| Axis::uniform(0.0, size / cells as f64, cells).unwrap();
    let grid = Grid::new([axis(10.0, 10), axis(3.0, 2), axis(10.0, 10)]);
    let dam = Prism::new(rectangle([0.0, 0.0], [10.0, 10.0]), 1, [0.0, 3.0]);
    let mut conditions = Conditions::of(vec![Soil::isotropic(1.0)]);
    let side = |name: &str, x: f64, top: f64, condition| Named {
        name: name.to_owned(),
        within: Extent {
            lower: [x, 0.0, 0.0],
            upper: [x, 3.0, top],
        },
        condition,
    };
    conditions.faces = vec![
        side("upstream", 0.0, 10.0, OnFaces::Head(10.0)),
        side("face", 10.0, 10.0, OnFaces::Open),
        side("downstream", 10.0, 2.0, OnFaces::Head(2.0)),
    ];
    let body = SeepageBody {
        region: &dam,
        soil: 0,
        scale: None,
    };
    let found = solve(&grid, &[body], &conditions, &|_| None).unwrap();
    assert!(
        (found.outflow / (4.8 * 3.0) - 1.0).abs() < 1e-2,
        "{}",
        found.outflow
    );
    assert!((found.inflow / found.outflow - 1.0).abs() < 1e-10);
    let levels = [0.2, 1.5, 2.9].map(|y| found.free_surface(&[5.0, y, 0.0]).unwrap());
    assert!((levels[0] - 8.025).abs() < 0.1, "{levels:?}");
    assert!((levels[0] - levels[1]).abs() < 1e-9 && (levels[0] - levels[2]).abs() < 1e-9);
}
