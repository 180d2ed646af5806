//! GOAL: what yields first is not taken for a mechanism.
//! CASE: a slope of 20 m in weak rock, 1:2, by the criterion of Hoek and Brown, whose first particles yield far below its strength.
//! ORACLE: the search by trials, which asks for equilibrium and for no mechanism; and rock that is lighter is safer.

use igimp_cases::run::in_memory;
use igimp_input::CaseFile;

/// The factor of safety of a slope in rock of a unit weight \[kN/m³\], by a search.
fn factor(unit_weight: f64, search: &str) -> f64 {
    let text = format!(
        r#"
igimp = 1
[case]
title = "rock slope"
[grid]
cell = "2 m"
domain = {{ x = ["0 m", "80 m"], y = ["0 m", "32 m"] }}
[materials.rock]
model = "hoek-brown"
unit_weight = "{unit_weight} kN/m3"
young = "500 MPa"
poisson = 0.3
sci = "1 MPa"
gsi = 20
mi = 8
[[bodies]]
name = "slope"
material = "rock"
polygon = [["0 m","0 m"], ["80 m","0 m"], ["80 m","8 m"], ["60 m","8 m"], ["20 m","28 m"], ["0 m","28 m"]]
[[stages]]
name = "weight"
type = "gravity"
geometry = "given"
steps = 2
[[stages]]
name = "safety"
type = "strength-reduction"
search = "{search}"
[output]
report = false
figures = []
"#
    );
    let file = CaseFile::parse("rock.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let run = in_memory(file.case()).unwrap();
    assert!(run.failure.is_none(), "{:?}", run.failure);
    let found = run.summary.stages[1].safety.as_ref().unwrap();
    0.5 * (found.stable.unwrap() + found.failed.unwrap())
}

#[test]
fn rock_that_begins_to_yield_has_not_failed() {
    let by_trials = factor(12.0, "trials");
    let [light, own, heavy] = [11.0, 12.0, 13.0].map(|weight| factor(weight, "continuation"));
    assert!((own / by_trials - 1.0).abs() < 0.01, "{own} {by_trials}");
    assert!(light > own && own > heavy, "{light} {own} {heavy}");
    // The envelope is curved: its strength falls with less than the weight.
    let slope = (light / heavy).ln() / (13.0_f64 / 11.0).ln();
    assert!((0.3..1.0).contains(&slope), "{slope}");
}
