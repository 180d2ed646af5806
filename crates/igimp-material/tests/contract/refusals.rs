//! Values that are not accepted, and the words for them.

use igimp_material::{
    Cone, DruckerPrager, Elasticity, HenckyElastic, History, MaterialError, MohrCoulomb,
    PointContext, TangentKind, Tensor, Tresca, VonMises, lift_finite, lift_small,
    logarithmic_strain,
};

use crate::catalogue::all;
use crate::tensors::diagonal;

fn elasticity() -> Elasticity {
    Elasticity::new(100.0, 0.3).unwrap()
}

fn message<T: std::fmt::Debug>(result: Result<T, MaterialError>) -> String {
    result.unwrap_err().to_string()
}

fn cut(cutoff: f64) -> Result<MohrCoulomb, MaterialError> {
    MohrCoulomb::new(elasticity(), 1.0, 0.5, 0.1).and_then(|law| law.with_tension_cutoff(cutoff))
}

fn mohr_coulomb(c: f64, friction: f64, dilation: f64) -> Result<MohrCoulomb, MaterialError> {
    MohrCoulomb::new(elasticity(), c, friction, dilation)
}

#[test]
fn parameters_out_of_range_are_named() {
    let yield_stress = |value| VonMises::from_yield_stress(elasticity(), value);
    let undrained = |value| VonMises::from_undrained_strength(elasticity(), value);
    let cases = [
        (
            message(Elasticity::new(0.0, 0.3)),
            "`young` = 0 must be positive and finite",
        ),
        (
            message(Elasticity::new(f64::NAN, 0.3)),
            "`young` = NaN must be positive and finite",
        ),
        (
            message(Elasticity::new(f64::INFINITY, 0.3)),
            "`young` = inf must be positive and finite",
        ),
        (
            message(Elasticity::new(1.0, 0.5)),
            "`poisson` = 0.5 must be greater than -1 and less than 0.5",
        ),
        (
            message(Elasticity::new(1.0, -1.0)),
            "`poisson` = -1 must be greater than -1 and less than 0.5",
        ),
        (
            message(yield_stress(-1.0)),
            "`yield_stress` = -1 must be positive and finite",
        ),
        (
            message(undrained(0.0)),
            "`undrained_strength` = 0 must be positive and finite",
        ),
        (
            message(Tresca::new(elasticity(), f64::NAN)),
            "`undrained_strength` = NaN must be positive and finite",
        ),
    ];
    for (found, expected) in cases {
        assert_eq!(found, expected);
    }
}

#[test]
fn parameters_of_mohr_coulomb_out_of_range_are_named() {
    let quarter = std::f64::consts::FRAC_PI_2;
    let cases = [
        (
            message(mohr_coulomb(-1.0, 0.5, 0.1)),
            "`cohesion` = -1 must be finite and not negative",
        ),
        (
            message(mohr_coulomb(0.0, 0.0, 0.0)),
            "`cohesion` = 0 must be positive when `friction_angle` is 0",
        ),
        (
            message(mohr_coulomb(1.0, quarter, 0.1)),
            "`friction_angle` = 1.5707963267948966 must be at least 0 and less than pi/2",
        ),
        (
            message(mohr_coulomb(1.0, f64::NAN, 0.1)),
            "`friction_angle` = NaN must be at least 0 and less than pi/2",
        ),
        (
            message(mohr_coulomb(1.0, 30.0, 0.1)),
            "`friction_angle` = 30 must be at least 0 and less than pi/2",
        ),
        (
            message(mohr_coulomb(1.0, 0.5, 0.6)),
            "`dilation_angle` = 0.6 must be at least 0 and at most `friction_angle`",
        ),
        (
            message(mohr_coulomb(1.0, 0.5, -0.1)),
            "`dilation_angle` = -0.1 must be at least 0 and at most `friction_angle`",
        ),
        (
            message(cut(-1.0)),
            "`tension_cutoff` = -1 must be finite and not negative",
        ),
        (
            message(cut(f64::INFINITY)),
            "`tension_cutoff` = inf must be finite and not negative",
        ),
    ];
    for (found, expected) in cases {
        assert_eq!(found, expected);
    }
}

#[test]
fn parameters_of_a_cone_are_those_of_mohr_coulomb() {
    for (c, friction, dilation) in [
        (-1.0, 0.5, 0.1),
        (0.0, 0.0, 0.0),
        (1.0, f64::NAN, 0.1),
        (1.0, 1.6, 0.1),
        (1.0, 0.5, 0.6),
    ] {
        let cone = DruckerPrager::new(elasticity(), c, friction, dilation, Cone::Extension);
        let pyramid = mohr_coulomb(c, friction, dilation);
        assert_eq!(message(cone), message(pyramid));
    }
}

#[test]
fn reduction_factor_must_be_positive() {
    for entry in all() {
        for srf in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            match entry.law.reduced(srf) {
                Err(MaterialError::InvalidParameter { field: "srf", .. }) => {}
                other => panic!("{}: {srf} gave {other:?}", entry.label),
            }
        }
    }
}

#[test]
fn strains_that_are_not_finite_are_refused() {
    for entry in all() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308] {
            for place in 0..3 {
                let mut strain = [0.01; 3];
                strain[place] = bad;
                let result =
                    entry
                        .law
                        .return_map(&strain, &History::default(), &PointContext::STATIC);
                let expected = MaterialError::NonFinite {
                    quantity: "trial stress",
                };
                assert_eq!(result.unwrap_err(), expected, "{}: {strain:?}", entry.label);
            }
        }
    }
}

fn finite<const D: usize>(b: &Tensor) -> Result<(), MaterialError> {
    let law = HenckyElastic::new(elasticity());
    lift_finite::<D>(&law, b, &History::default(), TangentKind::Elastic).map(|_| ())
}

fn small<const D: usize>(strain: &Tensor) -> Result<(), MaterialError> {
    let law = HenckyElastic::new(elasticity());
    lift_small::<D>(&law, strain, &History::default(), TangentKind::Elastic).map(|_| ())
}

#[test]
fn tensors_that_are_not_finite_are_refused() {
    for bad in [f64::NAN, f64::INFINITY] {
        for (i, j) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)] {
            let mut tensor = diagonal([1.1, 0.9, 1.2]);
            tensor[i][j] = bad;
            tensor[j][i] = bad;
            let refused = |result: Result<(), MaterialError>| {
                matches!(result, Err(MaterialError::NonFinite { .. }))
            };
            assert!(
                refused(finite::<3>(&tensor)) && refused(small::<3>(&tensor)),
                "{tensor:?}"
            );
            let in_plane = i == j || j == 1;
            assert_eq!(refused(finite::<2>(&tensor)), in_plane, "{tensor:?}");
            assert_eq!(refused(small::<2>(&tensor)), in_plane, "{tensor:?}");
        }
    }
}

#[test]
fn stretches_that_are_not_positive_definite_are_refused() {
    let mut sheared = diagonal([1.0; 3]);
    sheared[0][1] = 1.5;
    sheared[1][0] = 1.5;
    let cases = [
        (diagonal([1.0, 1.0, -0.25]), -0.25),
        (diagonal([0.0, 1.0, 1.0]), 0.0),
        (sheared, -0.5),
    ];
    for (b, smallest) in cases {
        let found = [
            finite::<2>(&b),
            finite::<3>(&b),
            logarithmic_strain(&b).map(|_| ()),
        ];
        for result in found {
            match result {
                Err(MaterialError::NotPositiveDefinite { eigenvalue }) => {
                    assert!((eigenvalue - smallest).abs() < 1e-15);
                }
                other => panic!("{other:?}"),
            }
        }
    }
    assert_eq!(
        message(finite::<2>(&diagonal([1.0, 1.0, -0.25]))),
        "the elastic left Cauchy-Green tensor must be positive definite, got an eigenvalue of -0.25"
    );
    assert_eq!(
        message(small::<2>(&diagonal([f64::NAN; 3]))),
        "the trial elastic strain must be finite"
    );
}
