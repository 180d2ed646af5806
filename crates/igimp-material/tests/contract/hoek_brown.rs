//! Hoek–Brown: the contract, its envelope, and its reduction by shear strength.

use igimp_material::{
    ConstitutiveModel, Elasticity, History, HoekBrown, HoekBrownParameters, PointContext,
    Principal, Regime, Strength,
};

use crate::random::Random;
use crate::returns::{dot, size};

/// σ_ci, GSI, m_i, D, ψ in degrees, and Young's modulus.
const ROCKS: [(f64, f64, f64, f64, f64, f64); 5] = [
    (30.0, 5.0, 2.0, 0.0, 0.0, 5e3),
    (50.0, 45.0, 10.0, 0.5, 10.0, 1e4),
    (100.0, 100.0, 25.0, 0.0, 30.0, 1e4),
    (20.0, 30.0, 7.0, 1.0, 0.0, 500.0),
    (5.0, 60.0, 15.0, 0.2, 60.0, 800.0),
];

fn parameters(row: usize) -> HoekBrownParameters {
    let (intact_strength, gsi, intact_ratio, disturbance, dilation, _) = ROCKS[row];
    HoekBrownParameters {
        intact_strength,
        gsi,
        intact_ratio,
        disturbance,
        dilation_angle: f64::to_radians(dilation),
    }
}

fn rock(row: usize) -> HoekBrown {
    HoekBrown::new(
        Elasticity::new(ROCKS[row].5, 0.25).unwrap(),
        parameters(row),
    )
    .unwrap()
}

/// The rocks, as they are and reduced.
pub(crate) fn laws() -> Vec<(usize, f64, std::sync::Arc<dyn ConstitutiveModel>)> {
    let factors = [1.0, 1.3, 0.7];
    let of = |row: usize| factors.map(|srf| (row, srf, rock(row).reduced(srf).unwrap()));
    (0..ROCKS.len()).flat_map(of).collect()
}

/// A trial strain from a hundredth of the strain of strength to a hundred times it, degenerate ones included.
pub(crate) fn trial(row: usize, random: &mut Random) -> Principal {
    let (intact, .., young) = ROCKS[row];
    let mass = intact * parameters(row).cohesive_share().sqrt();
    let size = (mass + 1e-3 * intact) / young * 10_f64.powf(random.between(-1.5, 2.0));
    let middle = size * random.symmetric() * 10_f64.powf(random.between(-2.0, 0.5));
    let mut strain = random.values::<3>(size).map(|value| value + middle);
    let [i, j] = [random.below(3), random.below(3)];
    match random.below(8) {
        0 => strain[i] = strain[j],
        1 => strain = [strain[i]; 3],
        _ => {}
    }
    strain
}

/// GOAL: of random states answers are finite, on the surface and dissipative; strain splits; a returned state is not returned again.
#[test]
fn returns_are_admissible_and_dissipate() {
    for (row, srf, law) in laws() {
        let mut random = Random(51);
        let mut seen = Vec::new();
        for _ in 0..STATES / 15 {
            let strain = trial(row, &mut random);
            let answer = law
                .return_map(&strain, &History::default(), &PointContext::STATIC)
                .unwrap_or_else(|error| panic!("{row} {srf} {strain:?} {error}"));
            let about = || format!("{row} {srf} {strain:?} {answer:?}");
            let scale = law.stress_scale(&answer.tau);
            let excess = law.yield_function(&answer.tau, &answer.history);
            assert!(excess <= 1e-12 * scale, "{} {:e}", about(), excess / scale);
            let numbers = answer.tangent.as_flattened().iter().chain(&answer.tau);
            assert!(numbers.copied().all(f64::is_finite), "{}", about());
            let work = dot(&answer.tau, &answer.delta_eps_p);
            let flow = size(&answer.delta_eps_p);
            assert!(work >= -1e-13 * size(&answer.tau) * flow, "{}", about());
            let elastic = law.stiffness_bound().strain(&answer.tau);
            for a in 0..3 {
                let error = strain[a] - elastic[a] - answer.delta_eps_p[a];
                assert!(error.abs() <= 1e-13 * (1.0 + size(&strain)), "{}", about());
            }
            let again = law
                .return_map(&elastic, &answer.history, &PointContext::STATIC)
                .unwrap();
            assert_eq!(again.regime, Regime::Elastic, "{}", about());
            if !seen.contains(&answer.regime) {
                seen.push(answer.regime);
            }
        }
        assert_eq!(seen.len(), 5, "{row} {srf}: {seen:?}");
    }
}

/// States of all laws.
const STATES: usize = 45_000;

/// GOAL: D = ∂τ/∂ε by fourth-order differences within a regime. BAND: 1e-6 of 2G.
#[test]
fn tangents_are_derivatives() {
    for (row, srf, law) in laws() {
        let mut random = Random(52);
        let mut seen = 0;
        for _ in 0..800 {
            let strain = trial(row, &mut random);
            let spread = strain.iter().fold(f64::MIN, |m, v| m.max(*v))
                - strain.iter().fold(f64::MAX, |m, v| m.min(*v));
            let answer = law
                .return_map(&strain, &History::default(), &PointContext::STATIC)
                .unwrap();
            let h = 2e-4 * spread;
            if h == 0.0 || !answer.regime.is_plastic() {
                continue;
            }
            for b in 0..3 {
                let at = |k: f64| {
                    let mut moved = strain;
                    moved[b] += k * h;
                    let other = law
                        .return_map(&moved, &History::default(), &PointContext::STATIC)
                        .unwrap();
                    (other.regime == answer.regime).then_some(other.tau)
                };
                let taus = [-2.0, -1.0, 1.0, 2.0].map(at);
                let [Some(far_left), Some(left), Some(right), Some(far_right)] = taus else {
                    continue;
                };
                let slope = |a: usize| {
                    let near = (right[a] - left[a]) / (2.0 * h);
                    let wide = (far_right[a] - far_left[a]) / (4.0 * h);
                    ((4.0 * near - wide) / 3.0, (near - wide).abs())
                };
                let shear = law.stiffness_bound().shear();
                // Close to the apex the surface bends within a step of the differences; ψ is capped at φ from a kink on.
                if (0..3).any(|a| slope(a).1 > 1e-4 * shear) {
                    continue;
                }
                seen += 1;
                for a in 0..3 {
                    let error = (slope(a).0 - answer.tangent[a][b]).abs() / (2.0 * shear);
                    assert!(error < 1e-6, "{row} {srf} {strain:?} {answer:?} {error:e}");
                }
            }
        }
        assert!(seen > 400, "{row} {srf}: {seen}");
    }
}

/// GOAL: triaxial compression fails on the envelope of 2002: 1e-9. ORACLE: its formula.
#[test]
fn triaxial_compression_fails_on_the_envelope() {
    for row in 0..ROCKS.len() {
        let (law, p) = (rock(row), parameters(row));
        let (sci, young) = (p.intact_strength, law.stiffness_bound().young());
        for confinement in [0.0, 0.01, 0.1, 1.0] {
            let confinement = confinement * sci;
            let expected =
                sci * (p.ratio() * confinement / sci + p.cohesive_share()).powf(p.exponent());
            // Stress control: the axial strain that is too much, and the sides that keep their stress.
            let mut elastic = law.stiffness_bound().strain(&[-confinement; 3]);
            for _ in 0..400 {
                let mut side = 0.0;
                for _ in 0..60 {
                    let trial = [
                        elastic[0] + side,
                        elastic[1] + side,
                        elastic[2] - 2e-2 * sci / young,
                    ];
                    let answer = law
                        .return_map(&trial, &History::default(), &PointContext::STATIC)
                        .unwrap();
                    let stiff = answer.tangent[0][0] + answer.tangent[0][1];
                    let off = answer.tau[0] + confinement;
                    side -= off
                        / if stiff.abs() > 1e-6 * young {
                            stiff
                        } else {
                            young
                        };
                    if off.abs() < 1e-13 * sci {
                        break;
                    }
                }
                let trial = [
                    elastic[0] + side,
                    elastic[1] + side,
                    elastic[2] - 2e-2 * sci / young,
                ];
                let answer = law
                    .return_map(&trial, &History::default(), &PointContext::STATIC)
                    .unwrap();
                elastic = law.stiffness_bound().strain(&answer.tau);
            }
            let tau = law.stiffness_bound().stress(&elastic);
            let q = tau[0] - tau[2];
            let on = sci * (p.cohesive_share() - p.ratio() * tau[0] / sci).powf(p.exponent());
            assert!((q - on).abs() < 1e-9 * sci, "{row} {confinement} {q} {on}");
            assert!(
                (tau[0] + confinement).abs() < 1e-6 * sci && (q / expected - 1.0).abs() < 1e-4,
                "{row} {confinement} {tau:?} {expected}"
            );
        }
    }
}

/// GOAL: reduced by F, every stress on the surface has a circle that touches the envelope of shear strength over F.
/// ORACLE: the envelope of shear strength over normal stress of Hoek and others (2002), over F. BAND: 1e-5, that of 2000 angles.
#[test]
fn a_reduction_divides_the_envelope_of_shear() {
    for (row, srf, law) in laws() {
        let p = parameters(row);
        let (ratio, share, exponent) = (p.ratio(), p.cohesive_share(), p.exponent());
        let sci = p.intact_strength;
        // Normal and shear stress of the envelope by the minor stress (Hoek, Carranza-Torres and Corkum 2002, eqs. 8 and 9).
        let point = |minor: f64| {
            let base = ratio * minor / sci + share;
            let (width, steep) = (
                sci * base.powf(exponent),
                1.0 + exponent * ratio * base.powf(exponent - 1.0),
            );
            let normal = minor + 0.5 * width * (1.0 - (steep - 1.0) / (steep + 1.0));
            (normal, width * steep.sqrt() / (steep + 1.0))
        };
        let envelope = |normal: f64| {
            let (mut low, mut high) = (-share * sci / ratio, normal.max(0.0) + sci);
            for _ in 0..100 {
                let middle = 0.5 * (low + high);
                if point(middle).0 < normal {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            point(high).1
        };
        let mut random = Random(53);
        let mut tried = 0;
        while tried < 20 {
            let strain = trial(row, &mut random);
            let answer = law
                .return_map(&strain, &History::default(), &PointContext::STATIC)
                .unwrap();
            let mut tau = answer.tau;
            tau.sort_by(|a, b| b.total_cmp(a));
            let (centre, radius) = (-0.5 * (tau[0] + tau[2]), 0.5 * (tau[0] - tau[2]));
            if !answer.regime.is_plastic()
                || answer.regime == Regime::Apex
                || radius < 0.01 * share.powf(exponent) * sci
            {
                continue;
            }
            tried += 1;
            // The circle stays below the envelope over F, and comes as near as none.
            let most = (1..2_000)
                .map(|k| {
                    let angle = std::f64::consts::FRAC_PI_2 * f64::from(k) / 2_000.0;
                    let normal = centre - radius * angle.cos();
                    (radius * angle.sin() - envelope(normal) / srf) / radius
                })
                .fold(f64::NEG_INFINITY, f64::max);
            assert!(most.abs() < 1e-5, "{row} {srf} {tau:?} {most:e}");
        }
    }
}

/// GOAL: the answer goes with the order of the principal values, and values that no rock has are refused by name.
#[test]
fn order_does_not_matter_and_refusals_have_names() {
    for (row, srf, law) in laws() {
        let mut random = Random(54);
        for _ in 0..300 {
            let strain = trial(row, &mut random);
            let answer = law
                .return_map(&strain, &History::default(), &PointContext::STATIC)
                .unwrap();
            let turned = [strain[2], strain[0], strain[1]];
            let other = law
                .return_map(&turned, &History::default(), &PointContext::STATIC)
                .unwrap();
            for a in 0..3 {
                let error = (other.tau[(a + 1) % 3] - answer.tau[a]).abs();
                assert!(
                    error <= 1e-11 * law.stress_scale(&answer.tau),
                    "{row} {srf} {strain:?}"
                );
            }
        }
    }
    let with = |change: &dyn Fn(&mut HoekBrownParameters)| {
        let mut p = parameters(1);
        change(&mut p);
        let elasticity = Elasticity::new(1.0, 0.3).unwrap();
        HoekBrown::new(elasticity, p).unwrap_err().to_string()
    };
    assert_eq!(
        with(&|p| p.gsi = 0.0),
        "`gsi` = 0 must be above 0 and at most 100"
    );
    assert!(with(&|p| p.disturbance = 1.1).contains("`disturbance`"));
    assert!(with(&|p| p.intact_ratio = f64::NAN).contains("`intact_ratio`"));
    assert!(with(&|p| p.intact_strength = 0.0).contains("`intact_strength`"));
    assert!(with(&|p| p.dilation_angle = -0.1).contains("`dilation_angle`"));
    assert!(rock(0).reduced(f64::NAN).is_err());
}
