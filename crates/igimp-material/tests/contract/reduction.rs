//! Strength reduction, and laws that are limits of other laws.

use igimp_material::{
    Cone, ConstitutiveModel, DruckerPrager, Elasticity, History, MohrCoulomb, PointContext,
    Principal, Regime, ReturnMap, Strength, Tresca, VonMises,
};

use crate::catalogue::all;
use crate::random::Random;

fn elasticity() -> Elasticity {
    Elasticity::new(100.0, 0.3).unwrap()
}

fn answer(law: &dyn ConstitutiveModel, strain: &Principal) -> ReturnMap {
    law.return_map(strain, &History::default(), &PointContext::STATIC)
        .unwrap()
}

/// Largest difference of stress and tangent over random trial states, relative to 2G.
fn distance(one: &dyn ConstitutiveModel, other: &dyn ConstitutiveModel) -> f64 {
    let mut random = Random(30);
    let mut most = 0.0_f64;
    for _ in 0..5_000 {
        let strain = random.values(0.1);
        let (one, other) = (answer(one, &strain), answer(other, &strain));
        if one.regime == other.regime {
            for a in 0..3 {
                most = most.max((one.tau[a] - other.tau[a]).abs());
                for b in 0..3 {
                    most = most.max((one.tangent[a][b] - other.tangent[a][b]).abs());
                }
            }
        }
    }
    most / (2.0 * elasticity().shear())
}

#[test]
fn mohr_coulomb_without_friction_is_tresca_to_the_last_bit() {
    let tresca = Tresca::new(elasticity(), 1.5).unwrap();
    let frictionless = MohrCoulomb::new(elasticity(), 1.5, 0.0, 0.0).unwrap();
    let mut random = Random(31);
    for _ in 0..20_000 {
        let strain = random.values(0.1);
        assert_eq!(answer(&tresca, &strain), answer(&frictionless, &strain));
    }
}

#[test]
fn mohr_coulomb_tends_to_tresca_as_friction_vanishes() {
    let tresca = Tresca::new(elasticity(), 1.5).unwrap();
    for friction in [1e-4, 1e-8, 1e-12] {
        let law = MohrCoulomb::new(elasticity(), 1.5, friction, 0.0).unwrap();
        let distance = distance(&law, &tresca);
        assert!(distance < 10.0 * friction, "{friction:e}: {distance:e}");
    }
}

#[test]
fn a_cutoff_above_the_apex_never_acts() {
    let law = MohrCoulomb::new(elasticity(), 1.0, 0.5, 0.1).unwrap();
    let apex = 1.0 / 0.5_f64.tan();
    let cut = law.clone().with_tension_cutoff(1.001 * apex).unwrap();
    assert_eq!(cut.tension_cutoff(), Some(1.001 * apex));
    let mut random = Random(32);
    for _ in 0..5_000 {
        let strain = random.values(0.1);
        assert_eq!(answer(&law, &strain), answer(&cut, &strain));
    }
}

/// A cut-off that no state comes near changes nothing, however large: it does not blunt the planes
/// of shear.
#[test]
fn a_cutoff_far_away_never_acts() {
    let law = MohrCoulomb::new(elasticity(), 1.0, 0.0, 0.0).unwrap();
    for cutoff in [1e3, 1e9, 1e15, 1e200] {
        let cut = law.clone().with_tension_cutoff(cutoff).unwrap();
        let mut random = Random(34);
        let mut plastic = 0;
        for _ in 0..5_000 {
            let strain = random.values(0.1);
            let (plain, cut) = (answer(&law, &strain), answer(&cut, &strain));
            assert_eq!(plain, cut, "{cutoff:e} {strain:?}");
            plastic += usize::from(cut.regime.is_plastic());
        }
        assert!(plastic > 1_000);
    }
}

#[test]
fn reduction_divides_strength_and_keeps_elasticity() {
    let srf = 1.3;
    let (friction, dilation) = (0.6_f64, 0.1);
    let reduced = (friction.tan() / srf).atan();
    let cases: [(Box<dyn ConstitutiveModel>, Box<dyn ConstitutiveModel>); 5] = [
        (
            Box::new(VonMises::from_yield_stress(elasticity(), 2.0).unwrap()),
            Box::new(VonMises::from_yield_stress(elasticity(), 2.0 / srf).unwrap()),
        ),
        (
            Box::new(Tresca::new(elasticity(), 2.0).unwrap()),
            Box::new(Tresca::new(elasticity(), 2.0 / srf).unwrap()),
        ),
        (
            Box::new(MohrCoulomb::new(elasticity(), 2.0, friction, dilation).unwrap()),
            Box::new(MohrCoulomb::new(elasticity(), 2.0 / srf, reduced, dilation).unwrap()),
        ),
        // Dilation would exceed the reduced friction: flow becomes associated.
        (
            Box::new(MohrCoulomb::new(elasticity(), 2.0, friction, friction).unwrap()),
            Box::new(MohrCoulomb::new(elasticity(), 2.0 / srf, reduced, reduced).unwrap()),
        ),
        (
            Box::new(
                MohrCoulomb::new(elasticity(), 2.0, friction, dilation)
                    .and_then(|law| law.with_tension_cutoff(0.5))
                    .unwrap(),
            ),
            Box::new(
                MohrCoulomb::new(elasticity(), 2.0 / srf, reduced, dilation)
                    .and_then(|law| law.with_tension_cutoff(0.5 / srf))
                    .unwrap(),
            ),
        ),
    ];
    for (law, expected) in cases {
        let found = law.reduced(srf).unwrap();
        assert_eq!(found.name(), law.name());
        assert_eq!(found.stiffness_bound(), law.stiffness_bound());
        assert_eq!(
            found.has_symmetric_tangent(),
            expected.has_symmetric_tangent()
        );
        assert!(distance(&*found, &*expected) < 1e-15, "{}", law.name());
    }
}

/// GOAL: reduction divides c and tan φ before the cone is matched, for all cones; the apex stays.
#[test]
fn a_cone_is_matched_to_reduced_strength() {
    let (cohesion, friction, dilation, srf) = (2.0, 0.6_f64, 0.3, 2.5);
    let reduced = (friction.tan() / srf).atan();
    for cone in [Cone::Compression, Cone::Extension, Cone::PlaneStrain] {
        let law = |c, friction, dilation| {
            DruckerPrager::new(elasticity(), c, friction, dilation, cone).unwrap()
        };
        let found = law(cohesion, friction, dilation).reduced(srf).unwrap();
        // ψ would exceed the reduced φ: flow becomes associated.
        let expected = law(cohesion / srf, reduced, reduced);
        assert!(found.has_symmetric_tangent());
        assert!(distance(&*found, &expected) < 1e-15);
        let apex = answer(&*found, &[0.1; 3]).tau[0];
        assert!((apex * friction.tan() / cohesion - 1.0).abs() < 1e-14);
    }
}

/// GOAL: without friction the cone is a cylinder: that of plane strain is von Mises with c_u = c, and the others pass through
/// Tresca's uniaxial strength 2c.
#[test]
fn a_cone_without_friction_is_von_mises() {
    for (cone, yield_stress) in [
        (Cone::Compression, 3.0),
        (Cone::Extension, 3.0),
        (Cone::PlaneStrain, 1.5 * 3.0_f64.sqrt()),
    ] {
        let cone = DruckerPrager::new(elasticity(), 1.5, 0.0, 0.0, cone).unwrap();
        let cylinder = VonMises::from_yield_stress(elasticity(), yield_stress).unwrap();
        assert!(distance(&cone, &cylinder) < 1e-14);
    }
}

/// GOAL: the measure of how near flow is to associated flow does not jump as friction goes to none.
/// ORACLE: Tresca, whose flow is associated, is the limit of both laws; and ψ/φ where friction is not little.
#[test]
fn flow_without_dilation_becomes_associated_as_friction_ends() {
    let associated = Tresca::new(elasticity(), 2.0).unwrap().dilatancy();
    let of = |friction: f64, dilation: f64| {
        let [friction, dilation] = [friction, dilation].map(f64::to_radians);
        let plane = MohrCoulomb::new(elasticity(), 2.0, friction, dilation).unwrap();
        let cone = Cone::PlaneStrain;
        let cone = DruckerPrager::new(elasticity(), 2.0, friction, dilation, cone).unwrap();
        assert!((plane.dilatancy() - cone.dilatancy()).abs() < 1e-15);
        plane.dilatancy()
    };
    let mut before = associated;
    for step in 0..=3000 {
        let friction = 0.01 * f64::from(step);
        let found = of(friction, 0.0);
        assert!(
            (before - 0.00201..=before).contains(&found),
            "{friction}: {found}"
        );
        assert!((of(friction, friction) - associated).abs() < 1e-15);
        before = found;
    }
    for (dilation, friction) in [(0.0, 10.0), (4.0, 20.0), (30.0, 40.0)] {
        assert!((of(friction, dilation) - dilation / friction).abs() < 1e-15);
    }
}

/// GOAL: flow by Davis is associated flow on the strengths that eq. 21a makes of the reduced angle of friction.
/// ORACLE: tan φ* = sin φ cos ψ / (1 − sin φ sin ψ), Davis (1968), and c* that leaves the apex c cot φ where it was.
#[test]
fn flow_by_davis_is_associated_on_reduced_strengths() {
    let (cohesion, friction, dilation) = (2.0, 0.6, 0.2);
    let given = MohrCoulomb::new(elasticity(), cohesion, friction, dilation).unwrap();
    let davis = given.clone().with_davis_flow().unwrap();
    for srf in [0.8, 1.0, 1.5, 3.0, 5.0] {
        let reduced = (friction.tan() / srf).atan();
        let dilates = dilation.min(reduced);
        let tangent = reduced.sin() * dilates.cos() / (1.0 - reduced.sin() * dilates.sin());
        let least = cohesion / friction.tan() * tangent;
        let expected =
            MohrCoulomb::new(elasticity(), least, tangent.atan(), tangent.atan()).unwrap();
        let found = davis.reduced(srf).unwrap();
        assert!(distance(&*found, &expected) < 1e-13, "{srf}");
        assert!(found.has_symmetric_tangent());
        assert!((found.dilatancy() - 1.0).abs() < 1e-15);
        // Where the reduced angle is below that of dilation, flow was associated before.
        if dilates < dilation {
            assert!(distance(&*found, &*given.reduced(srf).unwrap()) < 1e-14);
        }
    }
}

#[test]
fn a_cutoff_that_reduction_lifts_above_the_apex_stops_acting() {
    // The apex c cot φ stays under reduction; the cut-off is divided.
    let law = MohrCoulomb::new(elasticity(), 1.0, 0.5, 0.0)
        .and_then(|law| law.with_tension_cutoff(1.5))
        .unwrap();
    let stronger = law.reduced(0.8).unwrap();
    assert_eq!(answer(&law, &[0.1; 3]).regime, Regime::TensionApex);
    assert_eq!(answer(&*stronger, &[0.1; 3]).regime, Regime::Apex);
}

/// GOAL: reduction by one changes nothing, by less than one strengthens, by more weakens.
#[test]
fn reduction_is_monotone() {
    let history = History::default();
    for entry in all() {
        let mut random = Random(33);
        let laws = [0.5, 1.0, 2.0].map(|srf| entry.law.reduced(srf).unwrap());
        for _ in 0..500 {
            let tau = answer(&*entry.law, &entry.general(&mut random)).tau;
            let [strong, same, weak] = laws
                .each_ref()
                .map(|law| law.yield_function(&tau, &history));
            let round_off = 1e-14 * entry.law.stress_scale(&tau);
            let f = entry.law.yield_function(&tau, &history);
            assert!(
                strong <= f + round_off && f <= weak + round_off,
                "{}",
                entry.label
            );
            assert!(
                f.is_infinite() || (same - f).abs() <= round_off,
                "{}",
                entry.label
            );
        }
    }
}
