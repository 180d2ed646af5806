//! Laws on their own, along the paths of the laboratory.

use igimp_material::{
    CamClayParameters, Cone, ConstitutiveModel, DruckerPrager, Elasticity, HenckyElastic,
    ModifiedCamClay, MohrCoulomb, ShearStiffness, Tresca, VonMises,
};
use igimp_solver::element::{
    Control, ElementError, ElementPath, ElementState, ElementTest, Kinematics, StandardTest,
};

const P0: f64 = 100e3;

/// λ* = 0.1, κ* = 0.02, M = 1, as in the tables.
fn cam_clay(shear: ShearStiffness, overconsolidation: f64) -> ModifiedCamClay {
    ModifiedCamClay::new(CamClayParameters {
        compression: 0.1,
        swelling: 0.02,
        critical_ratio: 1.0,
        shear,
        overconsolidation,
        reference_pressure: P0,
    })
    .unwrap()
}

fn driven(
    law: &dyn ConstitutiveModel,
    test: StandardTest,
    strain: f64,
    steps: usize,
    kinematics: Kinematics,
) -> Vec<ElementState> {
    let test = ElementTest {
        sigma: [-P0; 3],
        path: test.path(strain),
        steps,
        kinematics,
        durations: Vec::new(),
    };
    let run = test.run(law).unwrap();
    assert_eq!(run.failure, None);
    run.states
}

fn close(value: f64, expected: f64, band: f64, label: &str) {
    println!("{label}: {value:.6} expected {expected:.6}");
    assert!(
        (value / expected - 1.0).abs() < band,
        "{label}: {value} not {expected}"
    );
}

/// The value over η, linear between states.
fn at_ratio(states: &[ElementState], eta: f64, value: impl Fn(&ElementState) -> f64) -> f64 {
    let ratio = |state: &ElementState| state.q() / state.p();
    let next = states.iter().position(|state| ratio(state) >= eta).unwrap();
    let (a, b) = (&states[next - 1], &states[next]);
    let share = (eta - ratio(a)) / (ratio(b) - ratio(a));
    value(a) + share * (value(b) - value(a))
}

/// GOAL: elastic soil that hardly changes its volume is driven along every path with stresses that are prescribed. ORACLE: ε = σ/E along the
/// axis. BAND: what the round-off of strain is in stress.
#[test]
fn nearly_incompressible_elastic_soil_is_driven() {
    for poisson in [0.3, 0.499, 0.4999, 0.49999] {
        let law = HenckyElastic::new(Elasticity::new(20e6, poisson).unwrap());
        for kinematics in [Kinematics::Small, Kinematics::Finite] {
            let states = driven(&law, StandardTest::TriaxialDrained, 0.01, 20, kinematics);
            let end = states.last().unwrap();
            let axial = 20e6 * 0.01;
            close(end.q(), axial, 0.02, "q");
            if kinematics == Kinematics::Small {
                close(end.q(), axial, 1e-6, "q");
            }
        }
        driven(
            &law,
            StandardTest::TriaxialUndrained,
            0.01,
            20,
            Kinematics::Finite,
        );
        driven(
            &law,
            StandardTest::SimpleShearDrained,
            0.01,
            20,
            Kinematics::Finite,
        );
    }
}

/// GOAL: the undrained path of normally consolidated clay, p over q/p.
/// ORACLE: p/p₀ = (M²/(M² + η²))^Λ, Λ = 1 − κ*/λ* (Roscoe & Burland 1968), at five ratios. BAND: 0.1 %.
#[test]
fn undrained_cam_clay_follows_the_closed_form() {
    let law = cam_clay(ShearStiffness::Constant(2e6), 1.0);
    let states = driven(
        &law,
        StandardTest::TriaxialUndrained,
        0.5,
        4000,
        Kinematics::Finite,
    );
    let table = [
        (0.2, 0.969_111),
        (0.4, 0.888_042),
        (0.6, 0.781_932),
        (0.8, 0.673_170),
    ];
    for (eta, expected) in table {
        let p = at_ratio(&states, eta, ElementState::p);
        close(p / P0, expected, 1e-3, "undrained p/p0");
    }
    let last = states.last().unwrap();
    close(last.p() / P0, 0.574_349, 1e-3, "undrained p/p0 at the end");
    close(last.q() / last.p(), 1.0, 1e-3, "undrained q/p at the end");
}

/// GOAL: undrained strength over p of isotropically overconsolidated clay. ORACLE: s_u/p = (M/2) (R/2)^Λ; the elastic part keeps p,
/// and yields at q = M p √(R − 1). BAND: 0.1 %.
#[test]
fn undrained_strength_grows_with_overconsolidation() {
    for (ratio, expected) in [(1.0, 0.28717), (1.5, 0.39721), (2.0, 0.5), (8.0, 1.51572)] {
        let law = cam_clay(ShearStiffness::Constant(2e6), ratio);
        let states = driven(
            &law,
            StandardTest::TriaxialUndrained,
            1.0,
            1000,
            Kinematics::Finite,
        );
        let last = states.last().unwrap();
        close(0.5 * last.q() / P0, expected, 1e-3, "s_u/p");
        let before = states.iter().take_while(|state| !state.regime.is_plastic());
        let yielding = before.last().unwrap();
        let at_yield = (ratio - 1.0_f64).sqrt();
        assert!(yielding.q() <= at_yield * P0 * (1.0 + 1e-9));
        assert!((yielding.p() / P0 - 1.0).abs() < 1e-12);
    }
}

/// GOAL: the drained test, volume and shear over q/p, and its end. ORACLE: the closed form q = 3 (p − p₀) with
/// ε_s integrated over q/p, p₀ = 100 kPa, G = 2 MPa. BAND: 0.1 % with steps of 0.002 %.
#[test]
fn drained_cam_clay_follows_the_table() {
    let law = cam_clay(ShearStiffness::Constant(2e6), 1.0);
    let states = driven(
        &law,
        StandardTest::TriaxialDrained,
        0.6,
        30_000,
        Kinematics::Small,
    );
    let shear = |state: &ElementState| 2.0 / 3.0 * (state.strain[0] - state.strain[1]);
    let table = [
        (0.4, 115.384_6, 0.026_184, 0.019_713),
        (0.6, 125.0, 0.046_913, 0.050_799),
        (0.8, 136.3636, 0.070_591, 0.120_014),
        (0.9, 142.8571, 0.083_134, 0.197_599),
    ];
    for (eta, p, volume, deviatoric) in table {
        close(
            at_ratio(&states, eta, ElementState::p) / 1e3,
            p,
            1e-3,
            "drained p",
        );
        let found = at_ratio(&states, eta, ElementState::volumetric_strain);
        close(found, volume, 1e-3, "drained eps_v");
        close(
            at_ratio(&states, eta, shear),
            deviatoric,
            1e-3,
            "drained eps_s",
        );
    }
    let found = at_ratio(&states, 0.95, shear);
    close(found, 0.278_320, 1e-3, "drained eps_s at 0.95");
    let more = driven(
        &law,
        StandardTest::TriaxialDrained,
        3.0,
        1500,
        Kinematics::Small,
    );
    let last = more.last().unwrap();
    close(last.p() / 1e3, 150.0, 1e-3, "drained p at the end");
    close(
        last.volumetric_strain(),
        0.095_998,
        1e-3,
        "drained eps_v at the end",
    );
}

/// GOAL: with G that grows with p the undrained path has one more term. ORACLE: constant volume by hand,
/// λ* ln(p/p₀) = η²/(6 g) − (λ* − κ*) ln(1 + η²/M²), g = G/p. BAND: 1e-9, any step.
#[test]
fn shear_of_clay_whose_stiffness_grows_with_pressure_presses_on_it() {
    let law = cam_clay(ShearStiffness::Poisson(0.2), 1.0);
    let g = 1.5 * 0.6 / 1.2 / 0.02;
    for state in &driven(
        &law,
        StandardTest::TriaxialUndrained,
        0.3,
        50,
        Kinematics::Finite,
    )[1..]
    {
        let square = (state.q() / state.p()).powi(2);
        let log = (square / (6.0 * g) - 0.08 * square.ln_1p()) / 0.1;
        close(state.p() / P0, log.exp(), 1e-9, "p/p0 with G = g p");
    }
}

/// GOAL: isotropic compression to four times the pressure and back. ORACLE: ε_v = λ* ln 4, then κ* ln 4 less. BAND: 1e-9.
#[test]
fn isotropic_compression_runs_along_its_lines() {
    let law = cam_clay(ShearStiffness::Poisson(0.2), 1.0);
    let level = |p: f64| [-p, -p, -p, 0.0];
    let test = ElementTest {
        sigma: [-P0; 3],
        path: ElementPath {
            controls: [
                Control::Stress,
                Control::Stress,
                Control::Stress,
                Control::Strain,
            ],
            legs: vec![level(4.0 * P0), level(P0)],
        },
        steps: 10,
        kinematics: Kinematics::Small,
        durations: Vec::new(),
    };
    let run = test.run(&law).unwrap();
    assert_eq!(run.failure, None);
    let log = 4.0_f64.ln();
    close(
        run.states[10].volumetric_strain(),
        0.1 * log,
        1e-9,
        "eps_v up",
    );
    close(
        run.states[20].volumetric_strain(),
        0.08 * log,
        1e-9,
        "eps_v down",
    );
}

/// GOAL: one-dimensional compression comes to a constant K₀ and to the slope λ*. ORACLE: ε_s/ε_v = 2/3 along a ray of η₀, of elastic
/// parts κ* dp/p in volume and η₀ dp/(3G) in shear; with G = g p the ray is exact. BAND: 0.1 %.
#[test]
fn one_dimensional_compression_comes_to_its_line() {
    let law = cam_clay(ShearStiffness::Poisson(0.2), 1.0);
    let states = driven(&law, StandardTest::Oedometer, 0.6, 3000, Kinematics::Small);
    let (a, b) = (&states[2500], &states[3000]);
    let slope = (b.volumetric_strain() - a.volumetric_strain()) / (b.p() / a.p()).ln();
    close(slope, 0.1, 1e-3, "oedometer slope");
    // Along the ray dε_v = λ* d ln p, dε_vp = (λ* − κ*) d ln p, and elastic shear does not change: ε_s = η/(3 g).
    let eta = b.q() / b.p();
    let plastic = 0.08 * 2.0 * eta / (1.0 - eta * eta);
    close(
        plastic,
        2.0 / 3.0 * 0.1,
        1e-3,
        "shear over volume of the K0 line",
    );
}

/// GOAL: what perfectly plastic soil bears in the laboratory. ORACLE: closed forms. BAND: 1e-6.
#[test]
fn perfectly_plastic_laws_bear_what_they_should() {
    let elasticity = Elasticity::new(20e6, 0.3).unwrap();
    let phi = 30_f64.to_radians();
    let passive = (1.0 + phi.sin()) / (1.0 - phi.sin());
    let sand: &dyn ConstitutiveModel =
        &MohrCoulomb::new(elasticity, 5e3, phi, 5_f64.to_radians()).unwrap();
    let clay: &dyn ConstitutiveModel = &Tresca::new(elasticity, 40e3).unwrap();
    let round: &dyn ConstitutiveModel =
        &VonMises::from_undrained_strength(elasticity, 40e3).unwrap();
    let failed = P0 * (passive - 1.0) + 2.0 * 5e3 * passive.sqrt();
    let strengths = [
        (sand, StandardTest::TriaxialDrained, failed),
        (clay, StandardTest::TriaxialUndrained, 80e3),
        (clay, StandardTest::TriaxialDrained, 80e3),
        (
            round,
            StandardTest::TriaxialUndrained,
            3.0_f64.sqrt() * 40e3,
        ),
    ];
    for (law, test, q) in strengths {
        let states = driven(law, test, 0.2, 50, Kinematics::Small);
        close(states[50].q(), q, 1e-6, law.name());
    }
    let plane = driven(
        sand,
        StandardTest::PlaneStrainDrained,
        0.2,
        50,
        Kinematics::Small,
    );
    let axial = plane[50].sigma[0][0] - plane[50].sigma[1][1];
    close(axial, failed, 1e-6, "plane strain");
    // ψ of plane flow: dε_v/dγ = sin ψ, from the last two steps.
    let (a, b) = (&plane[40].strain, &plane[50].strain);
    let (volume, shear) = (b[0] - a[0] + b[1] - a[1], b[0] - a[0] - b[1] + a[1]);
    close(
        volume / shear,
        5_f64.to_radians().sin(),
        1e-6,
        "sin of dilation",
    );
    for test in [
        StandardTest::SimpleShearUndrained,
        StandardTest::SimpleShearDrained,
    ] {
        let states = driven(clay, test, 0.3, 60, Kinematics::Small);
        close(states[60].sigma[0][1], 40e3, 1e-6, "simple shear");
    }
}

/// The difference of the stresses along and across at failure, and the rate of volume over that of the difference of strains.
fn bears(law: &dyn ConstitutiveModel, test: StandardTest, strain: f64) -> (f64, f64) {
    let states = driven(law, test, strain, 200, Kinematics::Small);
    let [before, last] = [160, 200].map(|state| &states[state]);
    let difference = |state: &ElementState| state.sigma[0][0] - state.sigma[1][1];
    let settled = (difference(last) / difference(before) - 1.0).abs();
    assert!(settled < 1e-10, "still moving: {settled:e}");
    let step = |a: usize| last.strain[a] - before.strain[a];
    let volume = (0..3).map(step).sum::<f64>();
    (difference(last).abs(), volume / (step(0) - step(1)).abs())
}

/// GOAL: a cone bears what Mohr–Coulomb bears where it was matched, and dilates alike there; between compression and extension
/// it does not, which the last lines show.
/// ORACLE: the closed form σ_1 = σ_3 K + 2 c √K, K = (1 + sin φ)/(1 − sin φ), by hand; in plane strain
/// dε_v/dγ = sin ψ; in triaxial tests the flow of the corner, dε_v/dε_1 = −2 sin ψ/(1 − sin ψ) in compression and
/// dε_v/dε_3 = 2 sin ψ/(1 + sin ψ) in extension. And the pyramid along the same path. BAND: 1e-9.
#[test]
fn a_cone_bears_what_mohr_coulomb_does_where_it_is_matched() {
    let elasticity = Elasticity::new(20e6, 0.3).unwrap();
    let c = 5e3;
    for (friction, dilation) in [
        (30.0_f64, 30.0_f64),
        (30.0, 10.0),
        (30.0, 0.0),
        (20.0, 20.0),
    ] {
        let (phi, psi) = (friction.to_radians(), dilation.to_radians());
        let passive = (1.0 + phi.sin()) / (1.0 - phi.sin());
        let failed = P0 * (passive - 1.0) + 2.0 * c * passive.sqrt();
        // σ_1 = P0 is kept, and σ_3 falls.
        let extended = P0 - (P0 - 2.0 * c * passive.sqrt()) / passive;
        let cone = |kind| DruckerPrager::new(elasticity, c, phi, psi, kind).unwrap();
        let pyramid = MohrCoulomb::new(elasticity, c, phi, psi).unwrap();
        let (compression, extension) = (
            4.0 * psi.sin() / (3.0 - psi.sin()),
            4.0 * psi.sin() / (3.0 + psi.sin()),
        );
        for (kind, test, strain, strength, flow) in [
            (
                Cone::PlaneStrain,
                StandardTest::PlaneStrainDrained,
                0.4,
                failed,
                psi.sin(),
            ),
            (
                Cone::Compression,
                StandardTest::TriaxialDrained,
                0.4,
                failed,
                compression,
            ),
            (
                Cone::Extension,
                StandardTest::TriaxialDrained,
                -0.4,
                extended,
                extension,
            ),
        ] {
            let label = format!("{kind:?} {friction} {dilation}");
            let (borne, dilates) = bears(&cone(kind), test, strain);
            close(borne, strength, 1e-9, &label);
            close(borne, bears(&pyramid, test, strain).0, 1e-9, &label);
            assert!((dilates - flow).abs() < 1e-9, "{label}: {dilates} {flow}");
        }
        let far = |kind, test| bears(&cone(kind), test, 4.0).0;
        let outer = far(Cone::Compression, StandardTest::PlaneStrainDrained);
        let inner = far(Cone::Extension, StandardTest::TriaxialDrained);
        assert!(outer > 1.05 * failed && inner < 0.95 * failed);
    }
}

/// GOAL: a stress that soil cannot bear ends the test there with words; what cannot begin is refused.
#[test]
fn what_cannot_be_is_refused() {
    let law = Tresca::new(Elasticity::new(20e6, 0.3).unwrap(), 40e3).unwrap();
    let mut test = ElementTest {
        sigma: [-P0; 3],
        path: ElementPath {
            controls: [
                Control::Stress,
                Control::Stress,
                Control::AsXx,
                Control::Strain,
            ],
            legs: vec![[-P0, -P0 - 110e3, 0.0, 0.0]],
        },
        steps: 10,
        kinematics: Kinematics::Small,
        durations: Vec::new(),
    };
    let run = test.run(&law).unwrap();
    let lost = run.failure.unwrap();
    assert!((lost.share - 80.0 / 110.0).abs() < 1e-3, "{lost:?}");
    assert!(
        lost.to_string()
            .starts_with("leg 1 of the path ends at 72.7"),
        "{lost}"
    );
    assert_eq!(run.states.len(), 8);
    test.sigma[1] = -4.0 * P0;
    assert!(matches!(
        test.run(&law),
        Err(ElementError::InitialStress { .. })
    ));
    test.sigma[1] = -P0;
    test.path.controls[0] = Control::AsXx;
    assert!(matches!(test.run(&law), Err(ElementError::Path(_))));
}
