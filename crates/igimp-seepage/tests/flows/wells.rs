//! Flow around an axis: to wells in full ground and with a free surface, and in time to a drain.

use std::f64::consts::PI;

use crate::common::{faces, flow, grid, rectangle};
use igimp_geometry::region::Region;
use igimp_seepage::{Conditions, Course, Extent, History, OnFaces, SeepageBody, Soil, march};

/// Ground around a well, between two radii \[m\], with heads at both.
fn around(radii: [f64; 2], height: f64, heads: [f64; 2]) -> (Vec<[f64; 2]>, Conditions<2>) {
    let [inner, outer] = radii;
    let mut conditions = Conditions::of(vec![Soil::isotropic(1e-5)]);
    conditions.axisymmetric = true;
    conditions.faces = vec![
        faces("well", [inner, 0.0], [inner, height], OnFaces::Open),
        faces(
            "in the well",
            [inner, 0.0],
            [inner, heads[0]],
            OnFaces::Head(heads[0]),
        ),
        faces(
            "far",
            [outer, 0.0],
            [outer, height],
            OnFaces::Head(heads[1]),
        ),
    ];
    (rectangle([inner, 0.0], [outer, height]), conditions)
}

/// GOAL: water that flows to a well in full ground, whose faces lie on lines of the grid and off them.
/// ORACLE: Thiem: h = h₁ + (h₂ − h₁) ln(r/r₁)/ln(r₂/r₁), Q = 2π k D (h₂ − h₁)/ln(r₂/r₁); a discharge between parallel faces is the
/// control.
#[test]
fn a_well_in_full_ground() {
    let (radii, heads, height): ([f64; 2], _, _) = ([0.5, 10.0], [5.0, 8.0], 3.0);
    let ratio = radii[1] / radii[0];
    let exact = 2.0 * PI * 1e-5 * height * (heads[1] - heads[0]) / ratio.ln();
    let mut errors = Vec::new();
    for (from, cell, count) in [
        (0.5, 0.25, 38),
        (0.37, 0.25, 39),
        (0.5, 0.125, 76),
        (0.0, 0.15, 67),
    ] {
        let grid = grid([from, 0.0], cell, [count, (height / cell).ceil() as usize]);
        let (ground, mut conditions) = around(radii, height, heads);
        conditions.confined = true;
        let found = flow(&grid, &[ground], &conditions).unwrap();
        let mut apart: f64 = 0.0;
        for k in 1..10 {
            let r = radii[0] + 0.1 * f64::from(k) * (radii[1] - radii[0]);
            let head = heads[0] + (heads[1] - heads[0]) * (r / radii[0]).ln() / ratio.ln();
            apart = apart.max((found.head(&[r, 1.1]) - head).abs());
        }
        let error = found.outflow / exact - 1.0;
        println!(
            "cells of {cell} from {from}: Q {:+.3} %, heads {apart:.4} m",
            100.0 * error
        );
        assert!(error.abs() < 0.02 && apart < 0.03, "{error} {apart}");
        assert!((found.inflow / found.outflow - 1.0).abs() < 1e-10);
        errors.push(error);
    }
    assert!(errors[2].abs() < 0.3 * errors[0].abs(), "{errors:?}");
    let parallel = 2.0 * PI * 1e-5 * height * (heads[1] - heads[0]) / (radii[1] - radii[0]);
    assert!(exact > 2.0 * parallel);
}

/// GOAL: a well in ground with a free surface.
/// ORACLE: Q = π k (h₂² − h₁²)/ln(r₂/r₁), exact whatever the face at the well, by the integral that gives Charny's discharge.
#[test]
fn a_well_with_a_free_surface() {
    let (radii, heads, height): ([f64; 2], [f64; 2], _) = ([1.0, 10.0], [2.0, 6.0], 6.0);
    let exact = PI * 1e-5 * (heads[1].powi(2) - heads[0].powi(2)) / (radii[1] / radii[0]).ln();
    for (from, cell, count, band) in [
        (1.0, 0.5, 18, 0.02),
        (0.8, 0.25, 37, 0.02),
        (1.0, 0.25, 36, 0.01),
    ] {
        let grid = grid([from, 0.0], cell, [count, (height / cell) as usize]);
        let (ground, conditions) = around(radii, height, heads);
        let found = flow(&grid, &[ground], &conditions).unwrap();
        let error = found.outflow / exact - 1.0;
        println!("cells of {cell} from {from}: Q {:+.3} %", 100.0 * error);
        assert!(error.abs() < band, "{error}");
        let levels = [2.0, 4.0, 8.0].map(|r| found.free_surface(&[r, 0.0]).unwrap());
        assert!(levels[0] < levels[1] && levels[1] < levels[2] && levels[2] < heads[1]);
    }
}

/// GOAL: ground around an axis in which water rests, or hardly flows, is solved however far out it is and whatever its cells: its
/// heads differ by little more than their round-off. ORACLE: at rest the head of both faces; else Q = π k (h₂² − h₁²)/ln(r₂/r₁).
#[test]
fn water_that_hardly_flows_far_from_the_axis() {
    let (width, height, level): (f64, f64, f64) = (8.0, 3.0, 2.1);
    for (inner, band) in [(0.5, 1e-2), (50.0, 1e-3), (2e3, 1e-3), (1e5, 1e-3)] {
        for (cell, count) in [(0.5, [16, 6]), (0.25, [32, 12]), (0.125, [64, 24])] {
            let grid = grid([inner, 0.0], cell, count);
            let at = |far: f64| {
                let (ground, conditions) =
                    around([inner, inner + width], height, [level, level + far]);
                flow(&grid, &[ground], &conditions).unwrap()
            };
            let rest = at(0.0);
            for k in 0..8 {
                let head = rest.head(&[inner + f64::from(k), 0.7]);
                assert!((head - level).abs() < 1e-12, "{head}");
            }
            for rise in [1e-4, 1e-8] {
                let exact = PI * 1e-5 * rise * (2.0 * level + rise) / (width / inner).ln_1p();
                let error = at(rise).outflow / exact - 1.0;
                println!("from {inner} m, cells of {cell} m, {rise:.0e} m: Q {error:+.2e}");
                assert!(error.abs() < band, "{error}");
            }
        }
    }
}

/// GOAL: water that the ground gives back to a drain in time.
/// ORACLE: the series of radial flow to a drain (Barron 1948) at r₂/r₁ = 10, computed apart from this program.
#[test]
fn a_drain_in_time() {
    let polygon = rectangle([0.1, 0.0], [1.0, 0.1]);
    let grid = grid([0.1, 0.0], 0.025, [36, 4]);
    let mut conditions = Conditions::of(vec![Soil {
        specific_storage: 1.0,
        ..Soil::isotropic(1.0)
    }]);
    (conditions.axisymmetric, conditions.confined) = (true, true);
    conditions.faces = vec![faces("drain", [0.1, 0.0], [0.1, 0.1], OnFaces::Head(2.0))];
    let start = flow(&grid, std::slice::from_ref(&polygon), &conditions).unwrap();
    let course = Course {
        histories: vec![Some(History {
            times: vec![0.0],
            values: vec![1.0],
        })],
        times: vec![0.338_202, 1.691_009],
    };
    let bodies = [SeepageBody {
        region: &polygon as &dyn Region<2>,
        soil: 0,
        scale: None,
    }];
    let found = march(&grid, &bodies, (&start, &conditions), &|_| None, &course).unwrap();
    let all = PI * (1.0 - 0.01) * 0.1;
    for (time, exact) in [(course.times[0], 0.364_780), (course.times[1], 0.877_386)] {
        let row = found
            .balance
            .iter()
            .find(|row| row.time.to_bits() == time.to_bits());
        let degree = -row.unwrap().stored / all;
        println!("t {time}: {degree:.4} of {exact:.4}");
        assert!((degree - exact).abs() < 5e-3, "{degree}");
    }
}

/// GOAL: a disc about the axis passes its area's share of an upright flow, and a sleeve about it nothing.
/// ORACLE: k i π R², by hand.
#[test]
fn discs_pass_their_area() {
    let grid = grid([0.0, 0.0], 0.5, [8, 8]);
    let mut conditions = Conditions {
        axisymmetric: true,
        confined: true,
        ..Conditions::of(vec![Soil::isotropic(1e-3)])
    };
    conditions.faces = vec![
        faces("below", [0.0, 0.0], [3.8, 0.0], OnFaces::Head(7.0)),
        faces("above", [0.0, 4.0], [3.8, 4.0], OnFaces::Head(5.0)),
    ];
    let discs = [
        (0.3, 1.0),
        (1.0, 1.0),
        (1.7, 2.3),
        (3.6, 3.0),
        (3.8, 0.0),
        (3.8, 4.0),
    ];
    conditions.sections = (discs.iter())
        .map(|&(radius, level)| {
            let extent = Extent {
                lower: [0.0, level],
                upper: [radius, level],
            };
            (format!("{radius}"), extent)
        })
        .collect();
    let sleeve = Extent {
        lower: [2.2, 0.0],
        upper: [2.2, 4.0],
    };
    conditions.sections.push(("sleeve".to_owned(), sleeve));
    let found = flow(&grid, &[rectangle([0.0, 0.0], [3.8, 4.0])], &conditions).unwrap();
    for ((radius, level), section) in std::iter::zip(discs, &found.sections) {
        let exact = 1e-3 * 0.5 * PI * radius * radius;
        println!("{radius} {level}: {} of {exact}", section.inflow);
        assert!(
            (section.inflow / exact - 1.0).abs() < 5e-4,
            "{radius} {level}"
        );
    }
    assert!(found.sections.last().unwrap().inflow.abs() < 1e-12);
}
