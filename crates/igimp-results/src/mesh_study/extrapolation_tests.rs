use proptest::prelude::*;

use super::extrapolation::{Computed, Estimate, estimate};
use super::order::{Convergence, Order};

const HALVED: [f64; 3] = [1.0, 0.5, 0.25];
const ODD: [f64; 3] = [1.0, 1.0 / 3.0, 0.2];
const ALL: [Convergence; 4] = [
    Convergence::SOIL,
    Convergence::VARIED_SOIL,
    Convergence::FOOTING,
    Convergence::CONTACT,
];

fn of_soil(values: &[Computed]) -> Estimate {
    estimate(values, Convergence::SOIL).unwrap()
}

/// GOAL: values `limit + slope h^p` on meshes of these sizes.
fn exact(limit: f64, slope: f64, p: f64, sizes: &[f64]) -> Vec<Computed> {
    let value = |&h: &f64| Computed {
        h,
        value: limit + slope * h.powf(p),
        half_width: 0.0,
    };
    sizes.iter().map(value).collect()
}

fn values(values: &[f64], half_width: f64) -> Vec<Computed> {
    std::iter::zip(HALVED, values)
        .map(|(h, &value)| Computed {
            h,
            value,
            half_width,
        })
        .collect()
}

/// GOAL: 2 F(h/2) − F(h), and what the orders that are thought possible make of the change: 2^(2/3) = 1.5874 and √2.
#[test]
fn two_meshes_of_first_order_give_the_limit() {
    for sizes in [&HALVED[..2], &ODD[..2]] {
        let found = of_soil(&exact(1.5, 0.2, 1.0, sizes));
        assert!((found.value - 1.5).abs() < 1e-14);
        let slowest = 2.0 / 3.0;
        assert_eq!(found.order, Order::Assumed { slowest });
    }
    let meshes = values(&[1.719, 1.6465], 0.0);
    for (known, factor) in [
        (Convergence::SOIL, 1.0 / (4_f64.cbrt() - 1.0) - 1.0),
        (Convergence::VARIED_SOIL, 2_f64.sqrt()),
        (Convergence::CONTACT, 1.0 / (2_f64.cbrt() - 1.0) - 1.0),
    ] {
        let found = estimate(&meshes, known).unwrap();
        assert!((found.value - 1.574).abs() < 1e-12);
        assert!((found.uncertainty - factor * 0.0725).abs() < 1e-12);
    }
}

/// GOAL: intervals of a search count by the order that lets them most: s = 1/(2^(2/3) − 1) on halved cells.
#[test]
fn intervals_of_searches_are_carried_on() {
    let mut meshes = values(&[1.7, 1.6], 0.0);
    let without = of_soil(&meshes).uncertainty;
    (meshes[0].half_width, meshes[1].half_width) = (0.01, 0.004);
    let share = 1.0 / (4_f64.cbrt() - 1.0);
    let expected = (1.0 + share) * 0.004 + share * 0.01;
    assert!((of_soil(&meshes).uncertainty - without - expected).abs() < 1e-12);
}

#[test]
fn three_meshes_find_order_and_limit() {
    for sizes in [HALVED, ODD] {
        for p in [0.7, 0.9, 1.0, 1.6, 2.0_f64.next_down()] {
            let found = of_soil(&exact(3.0, 0.4, p, &sizes));
            let used = found.order.used().unwrap();
            assert!((used - p).abs() < 1e-7, "{p}: {:?}", found.order);
            assert!((found.value - 3.0).abs() < 1e-7, "{p}: {}", found.value);
        }
    }
    let found = of_soil(&exact(1.5, 0.2, 1.0, &HALVED));
    assert!((found.uncertainty - 0.25 * 0.05).abs() < 1e-7);
}

/// GOAL: an order that is not thought possible is named and not used, and the limit is within the uncertainty where
/// the order is not below a third.
#[test]
fn orders_out_of_bounds_are_not_believed() {
    for (p, known, bound) in [
        (0.4, Convergence::SOIL, 2.0 / 3.0),
        (0.35, Convergence::VARIED_SOIL, 0.5),
        (3.0, Convergence::SOIL, 2.0),
    ] {
        let found = estimate(&exact(1.5, 0.2, p, &HALVED), known).unwrap();
        let Order::Limited { observed, used } = found.order else {
            panic!("{:?}", found.order);
        };
        assert!((observed - p).abs() < 1e-9 && (used - bound).abs() < 1e-15);
        assert!((found.value - 1.5).abs() <= found.uncertainty, "{found:?}");
        assert_eq!(found.order.remark().is_some(), p < 1.0);
    }
    // A last change that is none is no reason to be sure.
    let found = of_soil(&values(&[1.7, 1.6, 1.6], 0.0));
    assert!(found.uncertainty > 0.035, "{found:?}");
}

#[test]
fn what_follows_no_order_is_not_extrapolated() {
    let up_and_down = of_soil(&values(&[1.60, 1.50, 1.54], 0.0));
    assert_eq!(up_and_down.order, Order::Oscillating);
    assert!((up_and_down.value - 1.54).abs() < 1e-15);
    assert!((up_and_down.uncertainty - 0.3).abs() < 1e-12);
    let away = of_soil(&values(&[1.60, 1.55, 1.45], 0.0));
    assert_eq!(away.order, Order::Diverging);
    assert!((away.value - 1.45).abs() < 1e-15);
    assert!((away.uncertainty - 0.45).abs() < 1e-12);
    assert!(up_and_down.order.remark().is_some() && away.order.remark().is_some());
}

/// GOAL: a limit load of soil that rises with smaller cells is not extrapolated, and is as uncertain as one mesh; a
/// footing's is, whose width changes with the cells; and a rise within the search is none.
#[test]
fn a_rise_is_no_convergence_of_soil() {
    for meshes in [&[1.50, 1.51][..], &[1.50, 1.505, 1.51]] {
        let found = of_soil(&values(meshes, 0.001));
        assert_eq!(found.order, Order::Rising);
        assert!((found.value - 1.51).abs() < 1e-15);
        assert!((found.uncertainty - 0.03 * 1.51 - 0.001).abs() < 1e-12);
        assert!(found.order.remark().is_some());
    }
    let far = of_soil(&values(&[1.4, 1.5], 0.0));
    assert!((far.uncertainty - 0.3).abs() < 1e-12);
    let footing = estimate(&values(&[4.889, 4.976], 0.0), Convergence::FOOTING).unwrap();
    assert!((footing.value - 5.063).abs() < 1e-12);
    let within = of_soil(&values(&[1.50, 1.501], 0.001));
    assert!((within.value - 1.502).abs() < 1e-12);
}

/// GOAL: limit loads of either sign converge alike, and a load that is lowered may rise.
/// ORACLE: the other sign of the values; by hand, 2 F(h/2) − F(h).
#[test]
fn a_negative_limit_load_is_the_mirror_image_of_a_positive_one() {
    for meshes in [
        &[1.51, 1.50][..],
        &[1.50, 1.51],
        &[1.60, 1.55, 1.525],
        &[1.50, 1.505, 1.51],
    ] {
        let negative: Vec<f64> = meshes.iter().map(|value| -value).collect();
        let (positive, other) = (
            of_soil(&values(meshes, 0.001)),
            of_soil(&values(&negative, 0.001)),
        );
        assert_eq!(positive.order, other.order);
        assert!((positive.value + other.value).abs() < 1e-12);
        assert!((positive.uncertainty - other.uncertainty).abs() < 1e-12);
    }
    let lowered = Convergence::SOIL.of_lowered_load();
    let found = estimate(&values(&[0.50, 0.55], 0.0), lowered).unwrap();
    assert!((found.value - 0.60).abs() < 1e-12 && found.order.remark().is_none());
}

/// GOAL: where the intervals of the search admit order 1, no other is read out of their noise.
#[test]
fn noise_of_a_search_is_no_order() {
    let found = of_soil(&values(&[1.500, 1.504, 1.502], 0.005));
    assert!(
        matches!(found.order, Order::Admitted { .. }),
        "{:?}",
        found.order
    );
    assert!((found.value - 1.500).abs() < 1e-12);
    // Changes of 0.035 and 0.030, each to 0.01: ratios of 0.625 to 2.25, orders up to log2 of that.
    let slow = of_soil(&values(&[1.091, 1.056, 1.026], 0.005));
    let Order::Admitted { from, to } = slow.order else {
        panic!("{:?}", slow.order);
    };
    assert!((from - 2.0 / 3.0).abs() < 1e-9 && (to - 2.25_f64.log2()).abs() < 1e-9);
    assert!((slow.value - 0.996).abs() < 1e-9);
    let sharp = of_soil(&values(&[1.091, 1.056, 1.026], 0.0));
    assert!(matches!(sharp.order, Order::Limited { .. }), "{sharp:?}");
    let same = of_soil(&values(&[2.0, 2.0, 2.0], 0.0));
    assert_eq!((same.value, same.uncertainty), (2.0, 0.0));
}

/// GOAL: contact is as uncertain as a single mesh at least.
#[test]
fn contact_is_never_narrow() {
    let found = estimate(&values(&[6.04, 6.04], 0.0), Convergence::CONTACT).unwrap();
    assert!((found.uncertainty - 0.03 * 6.04).abs() < 1e-12);
}

#[test]
fn what_says_nothing_gives_nothing() {
    let soil = Convergence::SOIL;
    assert_eq!(estimate(&[], soil), None);
    assert_eq!(estimate(&values(&[1.0], 0.0), soil), None);
    assert_eq!(estimate(&values(&[1.0, f64::NAN], 0.0), soil), None);
    let mut meshes = values(&[1.0, 1.1], 0.0);
    meshes.reverse();
    assert_eq!(estimate(&meshes, soil), None);
    // A mesh that failed is left out, and the others go on with their own ratio.
    let mut meshes = exact(1.5, 0.2, 1.0, &HALVED);
    meshes[1].value = f64::NAN;
    let found = of_soil(&meshes);
    assert!((found.value - 1.5).abs() < 1e-12);
    assert!(matches!(found.order, Order::Assumed { .. }));
}

proptest! {
    /// GOAL: whatever order is thought possible and however a search left the values in their intervals, two meshes
    /// and three cover the limit.
    #[test]
    fn the_limit_is_covered(
        place in 0.0..1.0_f64,
        kind in 0..4_usize,
        slope in 0.0..0.5_f64,
        half_width in 0.0..0.01_f64,
        places in prop::array::uniform3(-1.0..1.0_f64),
        meshes in 2..=3_usize,
        odd in any::<bool>(),
    ) {
        let known = ALL[kind];
        let p = known.slowest + place * (2.0 - known.slowest);
        let sizes = if odd { ODD } else { HALVED };
        let mut values = exact(1.5, slope, p, &sizes[..meshes]);
        for (value, place) in values.iter_mut().zip(places) {
            value.value += place * half_width;
            value.half_width = half_width;
        }
        let found = estimate(&values, known).unwrap();
        prop_assert!((found.value - 1.5).abs() <= found.uncertainty + 1e-7, "{found:?}");
        prop_assert!(found.order.used().is_some(), "{found:?}");
    }

    /// GOAL: the estimate goes with the values: moved and stretched alike.
    #[test]
    fn units_do_not_matter(
        numbers in prop::array::uniform3(0.5..2.0_f64),
        scale in 0.1..1e6_f64,
    ) {
        let one = of_soil(&values(&numbers, 0.003));
        let scaled: Vec<Computed> = values(&numbers, 0.003)
            .into_iter()
            .map(|v| Computed { h: 7.0 * v.h, value: scale * v.value, half_width: scale * v.half_width })
            .collect();
        let other = of_soil(&scaled);
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-6 * scale;
        prop_assert!(near(other.value, scale * one.value));
        prop_assert!(near(other.uncertainty, scale * one.uncertainty));
    }
}
