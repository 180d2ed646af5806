//! GOAL: a multiple of a factor of safety is one of the state that a stage starts from, and a search that nothing bounds says so.
//! CASE: a slope of 3 m, dry and under water, on cells of half a metre; level ground.
//! ORACLE: the factor of each state is the same in whatever order the file asks for it; level ground fails at no strength.

use igimp_cases::run::{Run, Start, in_memory};
use igimp_input::CaseFile;

use crate::resuming::{assert_equal, everything, folder, run_into};

const SLOPE: &str = r#"
igimp = 1
[case]
title = "slope"
[grid]
cell = "0.5 m"
domain = { x = ["0 m", "10 m"], y = ["0 m", "5 m"] }
[materials.soil]
model = "mohr-coulomb"
cohesion = "6 kPa"
friction = "20 deg"
unit_weight = "19 kN/m3"
young = "5 MPa"
poisson = 0.3
[[bodies]]
name = "slope"
material = "soil"
polygon = [["0 m","0 m"], ["10 m","0 m"], ["10 m","1 m"], ["5 m","1 m"], ["3 m","4 m"], ["0 m","4 m"]]
[[water]]
name = "dry"
dry = true
[[water]]
name = "wet"
level = "2.6 m"
[[stages]]
name = "weight"
type = "gravity"
steps = 3
"#;
const DRY: &str =
    "[[stages]]\nname = \"dry\"\ntype = \"strength-reduction\"\nstart_from = \"weight\"\n";
const WET: &str = "[[stages]]\nname = \"rise\"\ntype = \"construction\"\nwater = \"wet\"\nstart_from = \"weight\"\ngeometry = \"given\"\n\
                   [[stages]]\nname = \"wet\"\ntype = \"strength-reduction\"\nstart_from = \"rise\"\n";
const END: &str = "[[stages]]\nname = \"run-out\"\ntype = \"run-out\"\nstart_from = \"weight\"\nreduction = { times_fos = 1.05 }\nsteps = 2\n\
                   [[curves]]\nname = \"reduction\"\nstage = \"run-out\"\nx = { of = \"step\" }\ny = { of = \"reduction_factor\" }\n\
                   [output]\nfigures = []\nreport = false\nparaview = { every = \"never\" }\n";

fn parsed(parts: &[&str]) -> CaseFile {
    let text = [&[SLOPE], parts, &[END]].concat().concat();
    CaseFile::parse("slope.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// By how much the run-out divides strength.
fn reduction(run: &Run<2>) -> f64 {
    run.curves[0].rows.last().unwrap()[1]
}

/// The middle of the interval of the search of that name.
fn factor(run: &Run<2>, stage: &str) -> f64 {
    let mut stages = run.summary.stages.iter();
    let summary = stages.find(|summary| summary.name == stage).unwrap();
    let found = summary.safety.as_ref().unwrap();
    0.5 * (found.stable.unwrap() + found.failed.unwrap())
}

#[test]
fn a_run_out_has_the_factor_of_its_own_state() {
    let orders = [&[DRY, WET][..], &[WET, DRY]];
    for parts in orders {
        let run = in_memory(parsed(parts).case()).unwrap();
        let [dry, wet] = ["dry", "wet"].map(|stage| factor(&run, stage));
        assert!(wet > 1.05 * dry, "{dry} {wet}");
        let found = reduction(&run);
        assert!(
            (found / (1.05 * dry) - 1.0).abs() < 1e-12,
            "{found} {dry} {wet}"
        );
        let reason = &run.summary.stages.last().unwrap().reason;
        assert!(reason.contains("1.05 times the"), "{reason}");
        assert!(reason.ends_with("of stage \"dry\""), "{reason}");
    }
    // The state that the run-out starts from was not searched, and another was.
    let text = [SLOPE, WET, END].concat();
    let error = CaseFile::parse("slope.toml", &text, &[])
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("no earlier stage finds the factor of safety of the state"),
        "{error}"
    );
}

// GOAL: the factor survives the end of a program: the run-out begun anew, and taken up within it, is the one that was never stopped.
#[test]
fn the_factor_survives_a_restart() {
    let file = parsed(&[DRY, WET]);
    let case = file.case();
    let [whole, anew, stopped] =
        ["whole", "anew", "stopped"].map(|name| folder(&format!("factors-{name}")));
    let run = run_into((&file, case), &whole, Start::Afresh, None);
    let expected = everything(&whole);
    run_into((&file, case), &anew, Start::Afresh, None);
    let again = run_into((&file, case), &anew, Start::FromStage(4), None);
    assert!((reduction(&again) / reduction(&run) - 1.0).abs() < 1e-15);
    assert_equal(&expected, &everything(&anew), "from the run-out on");
    let steps: usize = run.summary.stages.iter().map(|stage| stage.steps).sum();
    run_into((&file, case), &stopped, Start::Afresh, Some(steps - 1));
    run_into((&file, case), &stopped, Start::Resume, None);
    assert_equal(
        &expected,
        &everything(&stopped),
        "taken up within the run-out",
    );
}

const LEVEL: &str = r#"
igimp = 1
[case]
title = "level ground"
[grid]
cell = "0.5 m"
domain = { x = ["0 m", "3 m"], y = ["0 m", "3 m"] }
[materials.soil]
model = "mohr-coulomb"
cohesion = "6 kPa"
friction = "20 deg"
dilation = "20 deg"
unit_weight = "18 kN/m3"
young = "20 MPa"
poisson = 0.3
[materials.other]
model = "tresca"
cu = "90 kPa"
unit_weight = "18 kN/m3"
young = "20 MPa"
poisson = 0.3
[[bodies]]
name = "ground"
material = "soil"
polygon = [["0 m","0 m"], ["3 m","0 m"], ["3 m","2 m"], ["0 m","2 m"]]
[[stages]]
name = "weight"
type = "gravity"
steps = 1
[[stages]]
name = "safety"
type = "strength-reduction"
materials = ["soil"]
"#;

#[test]
fn a_search_that_nothing_bounds_ends_and_says_so() {
    let file = CaseFile::parse("level.toml", LEVEL, &[]).unwrap();
    let run = in_memory(file.case()).unwrap();
    let stage = &run.summary.stages[1];
    let found = stage.safety.as_ref().unwrap();
    assert_eq!(stage.code, "nothing-fails");
    assert_eq!(found.failed, None);
    let stable = found.stable.unwrap();
    assert!((1e3..1e5).contains(&stable), "{stable}");
    let is_remark = |text: &&String| text.contains("nothing fails");
    assert_eq!(run.summary.warnings.iter().filter(is_remark).count(), 1);
}

// GOAL: the strength of soil that is not there decides nothing, and a search for it is refused.
// ORACLE: by hand.
#[test]
fn a_search_of_absent_soil_is_refused() {
    let printed = |text: &str| {
        CaseFile::parse("level.toml", text, &[])
            .unwrap_err()
            .to_string()
    };
    let words = "no body that is there in stage `safety` has the strength that it reduces";
    let unused = printed(&LEVEL.replace("[\"soil\"]", "[\"other\"]"));
    assert!(unused.contains(words), "{unused}");
    let fill = "[[bodies]]\nname = \"fill\"\nmaterial = \"other\"\npolygon = [[\"0 m\",\"2 m\"], [\"3 m\",\"2 m\"], [\"3 m\",\"3 m\"], [\"0 m\",\"3 m\"]]\n";
    let place = "[[stages]]\nname = \"fill\"\ntype = \"construction\"\nplace = [\"fill\"]\nstart_from = \"weight\"\n";
    let later = LEVEL.replace(
        "[[stages]]\nname = \"weight\"",
        &format!("{fill}[[stages]]\nname = \"weight\""),
    ) + place;
    let absent = printed(&later.replace("[\"soil\"]", "[\"other\"]"));
    assert!(absent.contains(words), "{absent}");
    // One that is there is enough: the others come later.
    let both = later.replace("[\"soil\"]", "[\"soil\", \"other\"]");
    assert!(CaseFile::parse("level.toml", &both, &[]).is_ok());
}

/// GOAL: the curve of displacement against the factor of a search has one origin, whatever settled before it.
/// CASE: the slope after its weight, whose settlement stays in the displacements that go on. ORACLE: nothing has moved as the search
/// begins; the settlement, ten times what the first trial adds, is the control.
#[test]
fn a_curve_of_a_search_begins_with_nothing() {
    let search = "[[stages]]\nname = \"dry\"\ntype = \"strength-reduction\"\nsearch = \"trials\"\nfactors = [1.05, 1.1]\n\
                  [[curves]]\nname = \"cf\"\nstage = \"dry\"\nx = { of = \"reduction_factor\" }\ny = { of = \"largest_displacement\" }\n\
                  [output]\nfigures = []\nreport = false\nparaview = { every = \"never\" }\n";
    let text = [SLOPE, search].concat();
    let file = CaseFile::parse("slope.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let run = in_memory(file.case()).unwrap();
    let settled = run.body.particles.displacement.iter().flatten();
    let settled = settled.fold(0.0, |most: f64, value| most.max(value.abs()));
    let rows = &run.curves[0].rows;
    println!("{rows:?}, settled {settled}");
    assert!(rows.len() > 1 && rows[0][1].abs() < 1e-15);
    assert!(rows[1][1] > 0.0 && settled > 1e-3);
}
