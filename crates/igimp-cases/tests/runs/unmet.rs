//! GOAL: a check is held at the end of its stage and nowhere else: one whose stage found no equilibrium on its way, or was never
//! reached, is named and not met, whatever its value is by then; a factor of safety beyond all numbers meets any lower bound.
//! CASE: an upright face of clay, loaded beyond what it carries; the same with next to no weight.
//! ORACLE: by hand: the bands hold any displacement, so that "met" would be the verdict on a value on the way.

use igimp_cases::run::{Run, in_memory};
use igimp_input::CaseFile;
use igimp_results::ending::Ending;
use igimp_results::summary::{CheckRow, Standing};

const FACE: &str = r#"
igimp = 1
[case]
title = "face"
[grid]
cell = "0.5 m"
domain = { x = ["0 m", "6 m"], y = ["0 m", "3 m"] }
[materials.clay]
model = "tresca"
unit_weight = "18 kN/m3"
young = "10 MPa"
poisson = 0.45
cu = "20 kPa"
[[bodies]]
name = "face"
material = "clay"
polygon = [["0 m", "0 m"], ["3 m", "0 m"], ["3 m", "2 m"], ["0 m", "2 m"]]
[boundaries]
left = "roller"
bottom = "fixed"
[[loads]]
name = "fill"
type = "pressure"
from = ["0 m", "2 m"]
to = ["2 m", "2 m"]
pressure = "400 kPa"
[[stages]]
name = "weight"
type = "gravity"
steps = 2
[[stages]]
name = "safety"
type = "strength-reduction"
[[stages]]
name = "load"
type = "load"
start_from = "weight"
loads = ["fill"]
steps = 10
[[stages]]
name = "more weight"
type = "gravity"
factor = 1.1
steps = 1
[[curves]]
name = "load"
stage = "load"
x = { of = "step", label = "step [-]" }
y = { of = "largest_displacement", label = "displacement [m]" }
reference = { label = "any", y = 1, tolerance = 1e9 }
[[checks]]
name = "at the end of the load"
of = "largest_displacement"
stage = "load"
at_most = "1e4 cm"
source = "by hand"
[[checks]]
name = "after it"
of = "largest_displacement"
at_most = "100 m"
source = "by hand"
[[checks]]
name = "stands"
of = "factor_of_safety"
at_least = 0.5
source = "by hand"
"#;

fn face(set: &[&str]) -> Run<2> {
    let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
    let file = CaseFile::parse("face.toml", FACE, &set).unwrap_or_else(|error| panic!("{error}"));
    in_memory(file.case()).unwrap()
}

fn row<'a>(run: &'a Run<2>, name: &str) -> &'a CheckRow {
    let mut rows = run.summary.checks.iter();
    rows.find(|row| row.check.quantity == name)
        .unwrap_or_else(|| panic!("no check {name}: {:?}", run.summary.checks))
}

#[test]
fn checks_of_stages_that_did_not_come_to_their_end_are_not_met() {
    let run = face(&[]);
    assert_eq!(run.summary.ending(), Ending::NotConverged);
    let reached = run.summary.stages[2].reached;
    assert!((0.05..0.95).contains(&reached), "{reached}");
    for (name, is_known) in [
        ("at the end of the load", true),
        ("after it", false),
        ("load, end", true),
    ] {
        let row = row(&run, name);
        assert_eq!(row.standing, Standing::NotReached, "{name}");
        assert!(!row.pass && row.verdict() == "not reached", "{name}");
        assert_eq!(row.check.measured.is_finite(), is_known, "{name}");
    }
    // Numbers are kept in SI units, and told in those of the file.
    let displaced = &row(&run, "at the end of the load").check;
    assert!((displaced.expected - 100.0).abs() < 1e-12);
    assert_eq!(displaced.printed_band(), "≤ 1.000e4 cm");
    let printed = displaced.printed(displaced.measured);
    let number: f64 = printed.strip_suffix(" cm").unwrap().parse().unwrap();
    assert!(
        (number / (100.0 * displaced.measured) - 1.0).abs() < 1e-3,
        "{printed}"
    );
    // The factor was found before.
    let factor = row(&run, "stands");
    assert!(factor.pass && factor.standing == Standing::Held);
}

#[test]
fn ground_in_which_nothing_fails_is_at_least_as_safe_as_is_asked() {
    let light = [
        "materials.clay.unit_weight=1 N/m3",
        "loads.fill.pressure=1 Pa",
    ];
    let run = face(&light);
    let factor = row(&run, "stands");
    assert!(factor.pass, "{factor:?}");
    assert_eq!(factor.standing, Standing::NothingFails);
    assert_eq!(factor.measured(), "> 1000");
    let run = face(&[&light[..], &["checks.stands.at_least=1.5"]].concat());
    assert_eq!(run.summary.ending(), Ending::Done);
}

/// A block that is confined by nothing and pressed from above: all of it comes to its strength at once.
const BLOCK: &str = r#"
igimp = 1
[case]
title = "block"
[grid]
cell = "0.5 m"
domain = { x = ["0 m", "4 m"], y = ["0 m", "4 m"] }
[materials.clay]
model = "mohr-coulomb"
unit_weight = "0 kN/m3"
young = "50 MPa"
poisson = 0.3
cohesion = "20 kPa"
friction = "5 deg"
dilation = "5 deg"
[[bodies]]
name = "block"
material = "clay"
polygon = [["0 m", "0 m"], ["2 m", "0 m"], ["2 m", "3 m"], ["0 m", "3 m"]]
[boundaries]
left = "roller"
bottom = "roller"
[[loads]]
name = "crest"
type = "pressure"
from = ["0 m", "3 m"]
to = ["2 m", "3 m"]
pressure = "50 kPa"
[[stages]]
name = "press"
type = "load"
loads = ["crest"]
steps = 2
geometry = "given"
"#;

/// GOAL: a uniform collapse is told as that, with where it lies, and the advice leads to the limit load.
/// ORACLE: the unconfined strength 2 c tan(45° + φ/2), 43.65 kPa: 0.873 of the load.
#[test]
fn a_uniform_collapse_is_named() {
    let run = |set: &[&str]| {
        let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
        let file = CaseFile::parse("block.toml", BLOCK, &set);
        in_memory(file.unwrap_or_else(|error| panic!("{error}")).case()).unwrap()
    };
    let exact = 40.0 * 47.5_f64.to_radians().tan() / 50.0;
    let pressed = run(&[]);
    let failure = pressed.failure.unwrap();
    assert!(failure.error.from < exact && exact < failure.error.to);
    let near = failure.near_worst.unwrap();
    assert!(
        near.points > 0 && near.at_strength == near.points,
        "{near:?}"
    );
    let reason = &pressed.summary.stages[0].reason;
    assert!(
        reason.ends_with("the soil comes to its strength all at once"),
        "{reason}"
    );
    let message = failure.to_string();
    assert!(
        message.contains(
            "probably           collapse: the soil comes to its strength all at once, between"
        ),
        "{message}"
    );
    assert!(
        !message.contains("small_cuts") && !message.contains("supports in"),
        "{message}"
    );
    let advised = "stop_when = { no_equilibrium = true } in stage \"press\"";
    assert!(failure.suggestions[1].starts_with(advised), "{message}");
    let followed = run(&["stages.press.stop_when={ no_equilibrium = true }"]);
    assert!(followed.failure.is_none());
    let reached = followed.summary.stages[0].reached;
    assert!((reached / exact - 1.0).abs() < 1e-3, "{reached} of {exact}");
}

/// GOAL: the peak of a quantity that is told with its sign turned is the largest as it is told.
/// CASE: elastic ground settles under its weight in four steps. ORACLE: its settlement at the end, which only grows.
#[test]
fn a_peak_is_that_of_printed_values() {
    let text = r#"
igimp = 1
[case]
title = "ground settles"
[grid]
cell = "0.5 m"
domain = { x = ["0 m", "1 m"], y = ["0 m", "2.5 m"] }
[materials.soil]
model = "elastic"
unit_weight = "20 kN/m3"
young = "1 MPa"
poisson = 0
[[bodies]]
name = "soil"
material = "soil"
polygon = [["0 m", "0 m"], ["1 m", "0 m"], ["1 m", "2 m"], ["0 m", "2 m"]]
[[monitors]]
name = "top"
point = ["0.6 m", "1.9 m"]
record = ["displacement_y"]
[[stages]]
name = "weight"
type = "gravity"
geometry = "given"
steps = 4
[[checks]]
name = "settlement"
of = "top.displacement_y"
at = "peak"
divide_by = ["-1 mm"]
at_least = 30
source = "by hand"
[output]
report = false
figures = []
"#;
    let file = CaseFile::parse("case.toml", text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let run = in_memory(file.case()).unwrap();
    let last = run.monitors[0].rows.last().unwrap();
    let expected = -1e3 * last.last().unwrap();
    let found = run.summary.checks[0].check.measured;
    assert!(
        expected > 30.0 && (found / expected - 1.0).abs() < 1e-12,
        "{found} {expected}"
    );
}
