//! Limits on the given geometry, by the control that the stage drives, whichever way that goes.

use igimp_cases::run::{Run, in_memory};
use igimp_input::CaseFile;
use igimp_results::summary::{PathPoint, PathSummary, StageOutcome};

/// A slope of clay, 3 m high, that falls to the right, or its mirror image.
fn slope(is_mirrored: bool, stages: &str) -> Run<2> {
    let corners = [[0, 0], [12, 0], [12, 1], [8, 1], [5, 4], [0, 4]];
    let place = |[x, y]: [i32; 2]| {
        format!(
            "[\"{} m\", \"{y} m\"]",
            [x, 12 - x][usize::from(is_mirrored)]
        )
    };
    let polygon = corners.map(place).join(", ");
    ran(&format!(
        r#"
igimp = 1
[case]
title = "slope"
[grid]
cell = "1 m"
domain = {{ x = ["0 m", "12 m"], y = ["0 m", "5 m"] }}
[materials.clay]
model = "tresca"
unit_weight = "20 kN/m3"
young = "60 MPa"
poisson = 0.45
cu = "20 kPa"
[[bodies]]
name = "slope"
material = "clay"
polygon = [{polygon}]
{stages}
"#
    ))
}

fn ran(text: &str) -> Run<2> {
    let file = CaseFile::parse("limit.toml", text, &[]).unwrap_or_else(|error| panic!("{error}"));
    in_memory(file.case()).unwrap()
}

/// The path of the last stage, and the equilibrium that tells its limit.
fn limit<const D: usize>(run: &Run<D>) -> (&PathSummary, PathPoint) {
    let stage = run.summary.stages.last().unwrap();
    assert_eq!(stage.outcome, StageOutcome::Stopped, "{}", stage.reason);
    let path = stage.path.as_ref().expect("a path");
    (
        path,
        path.limit.unwrap_or_else(|| panic!("{}", stage.reason)),
    )
}

const WEIGHT: &str =
    "[[stages]]\nname = \"weight\"\ntype = \"gravity\"\nsteps = 2\ngeometry = \"given\"\n";

/// A stage that drives `keys` to its limit.
fn to_the_limit(keys: &str) -> String {
    format!(
        "[[stages]]\nname = \"push\"\n{keys}\ngeometry = \"given\"\nstop_when = {{ no_equilibrium = true }}\n"
    )
}

fn gravity(keys: &str) -> String {
    to_the_limit(&format!("type = \"gravity\"\n{keys}"))
}

/// GOAL: a push to the left has its limit as one to the right has.
/// ORACLE: the mirror image, to the doubt that the tolerance leaves.
#[test]
fn a_push_to_the_left_is_the_mirror_image_of_one_to_the_right() {
    let right = slope(false, &(WEIGHT.to_owned() + &gravity("horizontal = 1")));
    let left = slope(true, &(WEIGHT.to_owned() + &gravity("horizontal = -1")));
    let ((a, at), (b, mirrored)) = (limit(&right), limit(&left));
    assert_eq!((a.end, a.points.len()), (b.end, b.points.len()));
    assert!(
        (at.factor + mirrored.factor).abs() < 1e-5 * at.factor,
        "{at:?} {mirrored:?}"
    );
    assert!(at.factor > 0.1 && a.points.len() > 2, "{at:?}");
}

/// GOAL: the limit is that of a control that the stage changes, whatever it states beside it.
/// ORACLE: the same body force by another control: gravity restated with no push, and a push downwards beside gravity.
#[test]
fn a_limit_is_that_of_the_control_that_changes() {
    let of = |keys: &str| {
        let run = slope(false, &(WEIGHT.to_owned() + &gravity(keys)));
        let (path, at) = limit(&run);
        (path.end, at.factor)
    };
    let (end, raised) = of("factor = 3");
    assert!(raised > 1.1 && raised < 2.9, "{raised}");
    let restated = of("factor = 3\nhorizontal = 0");
    assert!(
        restated.0 == end && (restated.1 - raised).abs() < 1e-12,
        "{restated:?}"
    );
    // Changes are shares of smaller factors here, so that the path is followed on a little.
    let (_, down) = of("vertical = -2");
    assert!(
        (1.0 - down - raised).abs() < 2e-3 * raised,
        "{down} {raised}"
    );
}

/// Weightless clay under two strips of pressure.
fn strips(pressure: f64, stages: &str) -> Run<2> {
    ran(&format!(
        r#"
igimp = 1
[case]
title = "strips"
gravity = "0 m/s2"
[grid]
cell = "0.5 m"
domain = {{ x = ["0 m", "6 m"], y = ["0 m", "4 m"] }}
[materials.clay]
model = "tresca"
unit_weight = "20 kN/m3"
young = "50 MPa"
poisson = 0.45
cu = "20 kPa"
[[bodies]]
name = "clay"
material = "clay"
polygon = [["0 m", "0 m"], ["6 m", "0 m"], ["6 m", "3 m"], ["0 m", "3 m"]]
[[loads]]
name = "beside"
type = "pressure"
from = ["4 m", "3 m"]
to = ["6 m", "3 m"]
pressure = "10 kPa"
[[loads]]
name = "strip"
type = "pressure"
from = ["0 m", "3 m"]
to = ["1 m", "3 m"]
pressure = "{pressure} kPa"
{stages}
"#
    ))
}

/// GOAL: a load that is there already does not tell the limit of one beside it, and a negative factor on a negative load is
/// the load.
/// ORACLE: the load alone, and the same force; Prandtl's (2 + π) c from above, on cells of half the strip.
#[test]
fn the_load_that_grows_tells_the_limit() {
    let first = "[[stages]]\nname = \"beside\"\ntype = \"load\"\nload = \"beside\"\nfactor = 2\nsteps = 1\n\
                 geometry = \"given\"\n";
    let of = |pressure: f64, keys: &str| {
        let load = to_the_limit(&format!("type = \"load\"\n{keys}"));
        let run = strips(pressure, &(first.to_owned() + &load));
        limit(&run).1.factor
    };
    let alone = of(200.0, "load = \"strip\"\nfactor = 2");
    assert!(alone * 200.0 > 5.1 * 20.0 && alone < 1.9, "{alone}");
    let beside = of(200.0, "loads = [\"beside\", \"strip\"]\nfactor = 2");
    assert!((beside - alone).abs() < 1e-12, "{beside} {alone}");
    let negative = of(-200.0, "load = \"strip\"\nfactor = -2");
    assert!(
        (negative + alone).abs() < 1e-5 * alone,
        "{negative} {alone}"
    );
}

/// GOAL: a push across has the limit of one to the right.
/// ORACLE: the body turned by a quarter about the vertical.
#[test]
fn a_push_across_is_a_push_to_the_right_turned() {
    let of = |across: bool| {
        let ([x, y], [wide, deep]) = if across {
            (["1", "3"], ["1", "2"])
        } else {
            (["3", "1"], ["2", "1"])
        };
        let key = if across { "across" } else { "horizontal" };
        let push = gravity(&format!("{key} = 2"));
        let text = format!(
            r#"
igimp = 1
[case]
title = "block"
analysis = "3d"
[grid]
cell = "0.5 m"
domain = {{ x = ["0 m", "{x} m"], y = ["0 m", "{y} m"], z = ["0 m", "2 m"] }}
[materials.clay]
model = "tresca"
unit_weight = "20 kN/m3"
young = "60 MPa"
poisson = 0.45
cu = "10 kPa"
[[bodies]]
name = "block"
material = "clay"
box = {{ from = ["0 m", "0 m", "0 m"], to = ["{wide} m", "{deep} m", "1.5 m"] }}
{WEIGHT}
{push}
"#
        );
        let file = CaseFile::parse("block.toml", &text, &[]);
        let file = file.unwrap_or_else(|error| panic!("{error}"));
        limit(&in_memory(file.case_in_space()).unwrap()).1.factor
    };
    let [right, back] = [false, true].map(of);
    assert!(
        (right - back).abs() < 1e-5 * right && right < 1.9,
        "{right} {back}"
    );
}

/// GOAL: Newmark's coefficient is the whole push at the end of its stage, and the block slides as long as that stage shakes.
/// ORACLE: the recorded push; the record cut by hand where the stage ends.
#[test]
fn newmarks_block_goes_by_the_whole_push_and_the_time_of_the_stage() {
    let shaken = |name: &str, record: &str| {
        format!(
            "[[stages]]\nname = \"{name}\"\ntype = \"dynamic\"\nstart_from = \"weight\"\nduration = \"0.25 s\"\n\
             steps = 2\nnewmark_from = \"push\"\nground_motion = {{ unit = \"g\", {record} }}\n"
        )
    };
    let stages = format!(
        "{WEIGHT}[[stages]]\nname = \"first\"\ntype = \"gravity\"\nhorizontal = 0.1\nsteps = 1\n\
         [[stages]]\nname = \"push\"\ntype = \"gravity\"\nhorizontal = 0.6\n\
         stop_when = {{ displacement = \"1 mm\" }}\n{}{}\
         [[curves]]\nname = \"k\"\nx = {{ of = \"step\" }}\ny = {{ of = \"horizontal_factor\" }}\nstage = \"push\"\n",
        shaken(
            "long",
            "time = [\"0 s\", \"0.1 s\", \"0.4 s\", \"0.6 s\"], values = [0, -2, -2, 0]"
        ),
        shaken(
            "cut",
            "time = [\"0 s\", \"0.1 s\", \"0.25 s\"], values = [0, -2, -2]"
        ),
    );
    let run = slope(false, &stages);
    let push = run.curves[0].points(0, 1).last().unwrap()[1];
    let blocks: Vec<_> = (run.summary.stages.iter())
        .filter_map(|stage| stage.newmark.as_ref())
        .collect();
    let [long, cut] = blocks[..] else {
        panic!("{:?}", run.summary.stages);
    };
    assert!(push > 0.1 && push < 0.6);
    assert!(
        (long.yield_coefficient - push).abs() < 1e-12,
        "{long:?} {push}"
    );
    assert!(cut.displacement > 0.01);
    assert!(
        (long.displacement / cut.displacement - 1.0).abs() < 1e-12,
        "{long:?} {cut:?}"
    );
}
