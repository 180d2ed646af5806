//! Correlations, and the report of a fit.

use std::path::PathBuf;

use super::tests::{SAND, STRAINS, frictional, request, sheared, soil};
use super::{Fitted, fit};

const KEYS: [&str; 3] = ["cohesion", "friction", "young"];
const SIDES: [f64; 3] = [50e3, 100e3, 200e3];

fn fitted(sides: &[f64]) -> Fitted {
    let tests = sides.iter().map(|side| sheared(*side)).collect();
    fit(&soil(SAND), &request(&KEYS, tests)).unwrap()
}

/// A folder of its own with the report, gone with it.
struct Written(PathBuf);

impl Written {
    fn of(fitted: &Fitted, name: &str) -> (Self, Vec<String>) {
        let folder = std::env::temp_dir().join(format!("igimp-fit-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let names = fitted.write(&folder).unwrap();
        (Self(folder), names)
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.0.join(name)).unwrap()
    }
}

impl Drop for Written {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// GOAL: the correlation of c and φ, none of E with either. ORACLE: q = σ_3 (K_p - 1) + 2 c √K_p at failure has the derivatives
/// 2 √K_p and (σ_3 + c/√K_p) dK_p/dφ; with their sums of products over what is measured at failure ρ = −S_cφ/√(S_cc S_φφ). E enters
/// before failure alone. BAND: 1e-6.
#[test]
fn correlations_are_those_of_the_closed_form() {
    let fitted = fitted(&SIDES);
    let (sin, cos) = 34_f64.to_radians().sin_cos();
    let passive = (1.0 + sin) / (1.0 - sin);
    let by_angle = 2.0 * cos / (1.0 - sin).powi(2);
    let mut sums = [0.0; 3];
    for side in SIDES {
        let at_failure = STRAINS
            .iter()
            .filter(|strain| 30e6 * **strain > frictional(side));
        let (by_c, by_phi) = (
            2.0 * passive.sqrt(),
            (side + 5e3 / passive.sqrt()) * by_angle,
        );
        let count = at_failure.count() as f64;
        let products = [by_c * by_c, by_c * by_phi, by_phi * by_phi];
        for (sum, product) in sums.iter_mut().zip(products) {
            *sum += count * product;
        }
    }
    let expected = -sums[1] / (sums[0] * sums[2]).sqrt();
    let table = [[1.0, expected, 0.0], [expected, 1.0, 0.0], [0.0, 0.0, 1.0]];
    println!("{expected:.6}: {:?}", fitted.correlation);
    for (row, expected) in fitted.correlation.iter().zip(table) {
        for (value, expected) in row.iter().zip(expected) {
            assert!((value - expected).abs() < 1e-6, "{value} {expected}");
        }
    }
    let high = fitted.correlated();
    assert!(high.len() == usize::from(expected.abs() > 0.9), "{high:?}");
}

/// GOAL: the report has every parameter, pair and test, with pictures and tables that are there. ORACLE: what the fit holds.
#[test]
fn the_report_tells_all_of_a_fit() {
    let fitted = fitted(&SIDES);
    let (folder, names) = Written::of(&fitted, "whole");
    for name in &names {
        assert!(folder.0.join(name).exists(), "{name}");
    }
    let page = folder.read("report.html");
    for key in KEYS {
        assert!(page.contains(&format!("<td>{key}</td>")), "{key}");
    }
    for part in [
        "<h1>soil: Mohr–Coulomb, parameters from data</h1>",
        "3 parameters from 3 tests, 21 values.",
        "<h2>Test 3: triaxial drained</h2>",
        "data.csv\">",
        "[materials.soil]\ncohesion",
    ] {
        assert!(page.contains(part), "{part}");
    }
    let pictures = page.matches("<img src=\"data:image/svg+xml").count();
    assert_eq!(pictures, 3 * 4, "three of the curves and the residuals");
    let table = folder.read("correlation.csv");
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines[0], "parameter,cohesion,friction,young");
    assert!(lines[1].starts_with("cohesion,1.000000000,-0."), "{table}");
}

/// GOAL: the report states which parameters the data do not determine. ORACLE: one cell pressure does not tell c from φ.
#[test]
fn the_report_holds_back_undetermined_parameters() {
    let fitted = fitted(&[100e3]);
    let (folder, _) = Written::of(&fitted, "held-back");
    let page = folder.read("report.html");
    for part in [
        "<span class=\"mark fair\">Found, with reservations</span>",
        "cohesion: not determined, cohesion and friction are not told apart by these data.",
        "<td>nothing: not determined</td>",
        "# cohesion is not determined",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(fitted.correlation[0].iter().all(|value| value.is_nan()));
    let table = folder.read("correlation.csv");
    assert!(table.contains("cohesion,,,\n"), "{table}");
}
