//! Searches that come to values beyond which a law is refused.

use igimp_solver::element::ElementState;

use super::tests::{request, soil};
use super::*;
use crate::element::{Data, Drive, Kinematics, Row, StandardTest};

const HARDENING: &str = "model = \"hardening-soil\"\ncohesion = \"5 kPa\"\ndilation = \"8 deg\"\neur = \"90 MPa\"\neoed = \"30 MPa\"\n\
    k0_normal = 0.4\n";
const CLAY: &str = "model = \"modified-cam-clay\"\ncritical_ratio = 1.0\nshear = \"5 MPa\"\n";

/// A triaxial test, the undrained one at natural strain, whose data are q of a law, at thirty strains.
fn measured(law: &str, of: StandardTest, stress: f64) -> Request {
    let source = soil(law);
    let mut request = Request {
        drive: Drive::Standard(of, 0.1),
        stress: [stress; 2],
        steps: 400,
        kinematics: if of == StandardTest::TriaxialUndrained {
            Kinematics::Finite
        } else {
            Kinematics::Small
        },
        duration: 0.0,
        data: None,
    };
    let tested = test(&source.material(&[]).unwrap(), &request).unwrap();
    let state = |k: usize| -> &ElementState { &tested.run.states[10 + 13 * k] };
    let rows = (0..30_usize).map(|k| Row {
        line: k as u64 + 2,
        at: -state(k).strain[1],
        values: vec![state(k).q()],
    });
    request.data = Some(Data {
        name: "data.csv".to_owned(),
        columns: vec![Measure::Q],
        rows: rows.collect(),
    });
    request
}

/// GOAL: a search that meets a wall on its way goes on, with its parameters held there, to the least sum of squares.
/// CASE: Hardening Soil, whose power is 1 at most, and Cam-clay, whose λ* is above κ*: searches ended at the walls, were said to have
/// converged, and had intervals that did not hold what the data were made of. ORACLE: the values of the data, without scatter. BAND: 1e-4.
#[test]
fn a_search_goes_on_from_a_wall() {
    let sand = |values: &str| format!("{HARDENING}{values}");
    let clay = |values: &str| format!("{CLAY}{values}");
    for (start, truth, of, vary, expected) in [
        (
            sand("e50 = \"30 MPa\"\nfriction = \"38 deg\"\npower = 0.55\n"),
            sand("e50 = \"45 MPa\"\nfriction = \"36 deg\"\npower = 0.7\n"),
            StandardTest::TriaxialDrained,
            ["e50", "friction", "power"],
            [45.0, 36.0, 0.7],
        ),
        (
            clay("lambda = 0.1\nkappa = 0.02\nocr = 3\n"),
            clay("lambda = 0.15\nkappa = 0.03\nocr = 5\n"),
            StandardTest::TriaxialUndrained,
            ["lambda", "kappa", "ocr"],
            [0.15, 0.03, 5.0],
        ),
    ] {
        let request = request(&vary, vec![measured(&truth, of, 100e3)]);
        match fit(&soil(&start), &request) {
            Ok(found) => {
                println!("{}", found.text);
                for (parameter, expected) in found.parameters.iter().zip(expected) {
                    let off = parameter.value / expected - 1.0;
                    assert!(off.abs() < 1e-4, "{}: {off:e}", parameter.key);
                }
            }
            Err(error) => panic!("{error}"),
        }
    }
}

/// GOAL: where data want a value that the law refuses, the parameter is held at the last one, is named, and has no interval; the others are
/// those with it held. CASE: Hardening Soil under three pressures with stiffness that grows with their power of 1.3. ORACLE: the same fit with
/// `power` = 1 in the file. BAND: 1e-6.
#[test]
fn a_parameter_at_a_wall_is_named_and_held() {
    let tests: Vec<Request> = [50e3, 100e3, 200e3_f64]
        .iter()
        .map(|&stress| {
            let e50 = 40.0 * (stress / 100e3).powf(0.3);
            let law = format!(
                "{HARDENING}ocr = 5\nfriction = \"36 deg\"\npower = 1.0\ne50 = \"{e50} MPa\"\n"
            );
            measured(&law, StandardTest::TriaxialDrained, stress)
        })
        .collect();
    let start = |power: f64| {
        let law = format!(
            "{HARDENING}ocr = 5\nfriction = \"36 deg\"\npower = {power}\ne50 = \"30 MPa\"\n"
        );
        soil(&law)
    };
    let found = fit(&start(0.6), &request(&["e50", "power"], tests.clone())).unwrap();
    let held = fit(&start(1.0), &request(&["e50"], tests)).unwrap();
    let [e50, power] = &found.parameters[..] else {
        panic!("{found:?}");
    };
    println!("{}\n{}", found.text, held.text);
    assert_eq!(power.known, Known::AtWall { upper: true });
    assert!((power.value - 1.0).abs() < 1e-8, "{}", power.value);
    assert!((e50.value / held.parameters[0].value - 1.0).abs() < 1e-6);
    let words = "power = 1: the greatest value that its law and the tests accept beside the others";
    assert!(found.text.contains(words), "{}", found.text);
    let error = |parameter: &Found| match parameter.known {
        Known::Well { error, .. } => error,
        _ => panic!("{parameter:?}"),
    };
    // One degree of freedom is the other's.
    let ratio = error(e50) / error(&held.parameters[0]);
    assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
}
