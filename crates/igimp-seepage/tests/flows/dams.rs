//! Dams with vertical faces on an impervious base.

use crate::common::{dam, faces, flow, grid, rectangle};
use igimp_seepage::{Conditions, OnFaces, Soil};

/// Length, water upstream and downstream \[m\], cells over the height, exit point and free surface at L/4, L/2 and 3 L/4 \[m\].
///
/// Free surfaces: Baiocchi's obstacle problem on 384 cells over the height, ± 0.01 of the height at the exit.
const KNOWN: [([f64; 3], f64, [f64; 4]); 4] = [
    ([16.0, 24.0, 4.0], 72.0, [12.71, 22.588, 20.429, 17.473]),
    ([10.0, 10.0, 2.0], 40.0, [3.94, 9.198, 8.025, 6.469]),
    ([0.5, 1.0, 0.0], 40.0, [0.632, 0.9548, 0.8848, 0.7878]),
    ([2.0, 1.0, 0.0], 40.0, [0.186, 0.8860, 0.7353, 0.5399]),
];

/// GOAL: discharge, exit point and free surface, and not the parabola of Dupuit.
/// ORACLE: k (h₁² − h₂²) / (2 L) is exact for any seepage face (Charny); Baiocchi's obstacle problem for the surface.
#[test]
fn discharge_and_free_surface_are_known() {
    for ([length, high, low], cells, [exit, surface @ ..]) in KNOWN {
        let found = dam(length, high, low, high / cells, 0.0);
        let exact = (high * high - low * low) / (2.0 * length);
        let level = |share: f64| found.free_surface(&[share * length, 0.0]).unwrap();
        println!(
            "L {length}, {high} to {low}: q/k {:.4} of {exact}, exit {:.4} of {exit}, surface {:.4} {:.4} {:.4} of {surface:?}",
            found.outflow,
            level(1.0),
            level(0.25),
            level(0.5),
            level(0.75)
        );
        assert!((found.outflow / exact - 1.0).abs() < 5e-3);
        let by_floor = found.outflow_at_lower_floor.unwrap() / found.outflow;
        assert!((by_floor - 1.0).abs() < 1e-3, "{by_floor}");
        assert!((level(1.0) - exit).abs() < 0.01 * high);
        for (share, known) in std::iter::zip([0.25, 0.5, 0.75], surface) {
            assert!((level(share) - known).abs() < 0.01 * high);
        }
        let dupuit = (0.5 * (high * high + low * low)).sqrt();
        assert!((level(0.5) - dupuit).abs() > 0.02 * high, "{dupuit}");
        assert!((found.inflow / found.outflow - 1.0).abs() < 1e-10);
    }
}

/// GOAL: it does not matter where the grid lies. ORACLE: the discharge; the surface of other places of the grid.
#[test]
fn the_place_of_the_grid_does_not_matter() {
    let found = [0.0, 0.25, 0.5, 0.75].map(|shift| dam(10.0, 10.0, 2.0, 0.25, shift));
    for flow in &found {
        assert!((flow.outflow / 4.8 - 1.0).abs() < 5e-3, "{}", flow.outflow);
        assert!((flow.inflow / flow.outflow - 1.0).abs() < 1e-10);
        for share in [2.5, 5.0, 7.5] {
            let [level, first] =
                [flow, &found[0]].map(|flow| flow.free_surface(&[share, 0.0]).unwrap());
            assert!((level - first).abs() < 0.001 * 10.0, "{level} {first}");
        }
    }
}

/// GOAL: a head that is drawn over a whole face leaves the face above its level to the box before it.
/// CASE: water at 1 m before a face that was called open, drawn up to the level and up to the crest.
/// ORACLE: Charny's discharge, exact for any seepage face; the box that ends at the level. Without the open box the face
/// is closed above it, and lets less through.
#[test]
fn above_its_level_a_head_says_nothing() {
    let (length, crest, high, low) = (2.0, 8.0, 6.0, 1.0);
    let grid = grid([0.0, 0.0], 0.125, [16, 64]);
    let of = |is_open: bool, top: f64| {
        let mut conditions = Conditions::of(vec![Soil::isotropic(1.0)]);
        let open = faces("seep", [length, 0.0], [length, crest], OnFaces::Open);
        conditions.faces.extend(is_open.then_some(open));
        conditions.faces.extend([
            faces("up", [0.0, 0.0], [0.0, crest], OnFaces::Head(high)),
            faces("down", [length, 0.0], [length, top], OnFaces::Head(low)),
        ]);
        let body = [rectangle([0.0, 0.0], [length, crest])];
        flow(&grid, &body, &conditions).unwrap()
    };
    let [whole, to_level, closed] =
        [(true, crest), (true, low), (false, crest)].map(|(is_open, top)| of(is_open, top));
    let exact = (high * high - low * low) / (2.0 * length);
    println!(
        "{} {} {}, exact {exact}",
        whole.outflow, to_level.outflow, closed.outflow
    );
    assert!(
        (whole.outflow / exact - 1.0).abs() < 5e-3,
        "{}",
        whole.outflow
    );
    assert_eq!(whole.outflow.to_bits(), to_level.outflow.to_bits());
    assert!(closed.outflow < 0.99 * exact, "{}", closed.outflow);
}
