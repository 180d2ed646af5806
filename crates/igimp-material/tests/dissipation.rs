//! The dissipation of plastic flow by the normality rule.

use std::sync::Arc;

use igimp_material::{
    Cone, ConstitutiveModel, DruckerPrager, Elasticity, HenckyElastic, History, MohrCoulomb,
    PointContext, Ratios, ScaledLaw, Strength, Tresca, VonMises,
};

/// Trial strains to a side, an edge and in between, far beyond yield and under pressure, far from an apex \[-\].
const STRAINS: [[f64; 3]; 5] = [
    [0.03, 0.0, -0.03],
    [0.05, -0.01, -0.02],
    [0.02, 0.02, -0.05],
    [0.04, 0.005, -0.03],
    [-0.01, 0.03, 0.001],
];

fn elasticity() -> Elasticity {
    Elasticity::new(1e4, 0.3).unwrap()
}

/// Laws with associated flow.
fn laws() -> Vec<Arc<dyn ConstitutiveModel>> {
    let angle = 25_f64.to_radians();
    let von_mises = VonMises::from_undrained_strength(elasticity(), 10.0).unwrap();
    let ratios = Ratios {
        strength: 2.5,
        stiffness: 0.5,
        ..Ratios::ONE
    };
    let inner: Arc<dyn ConstitutiveModel> = Arc::new(von_mises);
    vec![
        Arc::new(von_mises),
        Arc::new(Tresca::new(elasticity(), 10.0).unwrap()),
        Arc::new(MohrCoulomb::new(elasticity(), 10.0, angle, angle).unwrap()),
        Arc::new(DruckerPrager::new(elasticity(), 10.0, angle, angle, Cone::PlaneStrain).unwrap()),
        Arc::new(ScaledLaw::new(inner, ratios).unwrap()),
    ]
}

// GOAL: the dissipation of flow by a law is the work of its stress on its plastic strain, and the volume of
// that flow is that of the plastic strain.
// ORACLE: τ : Δε_p of a return to the surface, with associated flow the stress that belongs to the flow.
#[test]
fn is_the_work_of_the_stress_on_plastic_strain() {
    for law in laws() {
        for strain in STRAINS {
            let strain = strain.map(|strain| strain - 0.01);
            let answer = law
                .return_map(&strain, &History::default(), &PointContext::STATIC)
                .unwrap();
            assert!(answer.regime.is_plastic());
            let flow = answer.delta_eps_p;
            let work: f64 = std::iter::zip(answer.tau, flow)
                .map(|(tau, eps)| tau * eps)
                .sum();
            let volume: f64 = flow.iter().sum();
            let rate = law.dissipation(&flow).unwrap();
            let size: f64 = flow.iter().map(|eps| eps.abs()).sum();
            assert!((rate.power - work).abs() < 1e-9 * work, "{}", law.name());
            assert!(
                (rate.dilation - volume).abs() < 1e-9 * size,
                "{}",
                law.name()
            );
        }
    }
}

// GOAL: a law without a limit has no dissipation.
// ORACLE: it has no strength.
#[test]
fn is_unknown_of_elastic_soil() {
    let law = HenckyElastic::new(elasticity());
    assert_eq!(law.dissipation(&STRAINS[0]), None);
}
