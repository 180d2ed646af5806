//! GOAL: what yields first is not taken for a mechanism, and where one begins is seen.
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

/// A slope of 4 m, 1:1, that stands barely: its factor of safety is 1.02.
const BARELY: &str = r#"
igimp = 1
[case]
title = "slope that stands barely"
{analysis}
[grid]
cell = "0.5 m"
domain = { x = ["0 m", "14 m"], {height} }
[materials.soil]
model = "mohr-coulomb"
unit_weight = "20 kN/m3"
young = "50 MPa"
poisson = 0.3
cohesion = "5 kPa"
friction = "20 deg"
dilation = "0 deg"
[[bodies]]
name = "slope"
material = "soil"
polygon = [["0 m","0 m"], ["14 m","0 m"], ["14 m","2 m"], ["9 m","2 m"], ["5 m","6 m"], ["0 m","6 m"]]
{across}
[[stages]]
name = "weight"
type = "gravity"
steps = 5
[[stages]]
name = "safety"
type = "strength-reduction"
[solver]
max_iterations = {corrections}
[output]
report = false
figures = []
"#;

/// GOAL: the factor of safety does not hang on the size of the first step of its path, which comes to the mechanism at once.
/// ORACLE: the same slope with other limits of the effort, which cut that step or do not, and as a slice in space: the factor rises by
/// 0.4 % in each doubling of the work, so that one may lie between them.
#[test]
fn a_slope_that_stands_barely_has_one_factor() {
    let factor = |corrections: usize, is_slice: bool| {
        let [analysis, height, across] = if is_slice {
            [
                "analysis = \"3d\"",
                "y = [\"0 m\", \"0.5 m\"], z = [\"0 m\", \"6.5 m\"]",
                "across = [\"0 m\", \"0.5 m\"]",
            ]
        } else {
            ["", "y = [\"0 m\", \"6.5 m\"]", ""]
        };
        let text = BARELY
            .replace("{analysis}", analysis)
            .replace("{height}", height)
            .replace("{across}", across)
            .replace("{corrections}", &corrections.to_string());
        let file = CaseFile::parse("barely.toml", &text, &[]).unwrap_or_else(|e| panic!("{e}"));
        let (summary, failure) = if is_slice {
            let run = in_memory(file.case_in_space()).unwrap();
            (run.summary, run.failure)
        } else {
            let run = in_memory(file.case()).unwrap();
            (run.summary, run.failure)
        };
        assert!(failure.is_none(), "{failure:?}");
        let found = summary.stages[1].safety.as_ref().unwrap();
        (found.stable.unwrap(), found.failed.unwrap())
    };
    let found =
        [(8, false), (25, false), (40, false), (25, true)].map(|(n, slice)| factor(n, slice));
    println!("{found:?}");
    let least = found
        .iter()
        .fold(f64::INFINITY, |least, own| least.min(own.0));
    let most = found.iter().fold(0.0, |most: f64, own| most.max(own.0));
    assert!(most / least < 1.005, "{found:?}");
    // What the intervals tell overlaps.
    let highest = found
        .iter()
        .fold(f64::INFINITY, |highest, own| highest.min(own.1));
    assert!(most < 1.001 * highest, "{found:?}");
}
