//! Reinforcement in case files and runs: refusals with reasons, changes by stages, and
//! results.

use std::fs;
use std::path::PathBuf;
use std::sync::OnceLock;

use igimp_cases::run::{Run, in_memory};
use igimp_input::CaseFile;

use crate::edits::{Edits, edited};
use crate::{messages_of_each, with_report};

const TEXT: &str = include_str!("../data/tied_cut.toml");

fn parsed(edits: Edits<'_>) -> CaseFile {
    CaseFile::parse("tied_cut.toml", &edited(TEXT, edits), &[])
        .unwrap_or_else(|error| panic!("{error}"))
}

fn messages(edits: Edits<'_>) -> String {
    messages_of_each(("tied_cut.toml", TEXT), edits)
}

#[test]
fn members_that_make_no_sense() {
    insta::assert_snapshot!(messages(&[
        (
            "head = [\"6 m\", \"1.6 m\"]",
            "head = [\"6.6 m\", \"1.6 m\"]"
        ),
        ("end = [\"3 m\", \"1.2 m\"]", "end = [\"6 m\", \"1.6 m\"]"),
        ("bonded_length = \"2 m\"", "bonded_length = \"7 m\""),
        ("prestress = \"12 kN/m\"", "prestress = \"26 kN/m\""),
        ("bond = \"10 kPa\"", "bond = \"0 kPa\""),
        ("capacity = \"20 kN/m\"", "capacity = \"20 kN\""),
        ("[\"3 m\", \"3.3 m\"]", "[\"5.2 m\", \"3.6 m\"]"),
        ("name = \"nail\"", "name = \"mat\""),
        (
            "y = { of = \"reinforcement.anchor.head_force\" }",
            "y = { of = \"reinforcement.anchor.tension\" }"
        ),
    ]));
}

#[test]
fn stages_that_cannot_install() {
    insta::assert_snapshot!(messages(&[
        ("install = [\"anchor\"]\n", ""),
        ("install = [\"mat\"]", "install = [\"mat\", \"anchor\"]"),
        ("install = [\"mat\"]", "install = [\"matt\"]"),
        ("bracket = [1.0, 1.5]", "install = [\"nail\"]"),
        ("bracket = [1.0, 1.5]", "path = \"gravity\""),
    ]));
}

/// GOAL: a stage of gravity that is zero does nothing, unless it installs and stresses an anchor.
/// ORACLE: by hand: two stages of gravity, one of which installs.
#[test]
fn a_stage_that_stresses_an_anchor_does_something() {
    let weightless = ("title = ", "gravity = \"0 m/s2\"\ntitle = ");
    let warnings = parsed(&[weightless]).warnings();
    assert_eq!(
        warnings.matches("does nothing: gravity is 0").count(),
        1,
        "{warnings}"
    );
}

/// The case, run into a folder of the build with pictures and a report.
fn written() -> &'static (PathBuf, Run<2>) {
    static ONCE: OnceLock<(PathBuf, Run<2>)> = OnceLock::new();
    ONCE.get_or_init(|| with_report(("tied_cut.toml", TEXT), "reinforcement-results"))
}

/// GOAL: the jack raises the tension evenly whatever the ground does, and what is locked off stretches on.
#[test]
fn an_anchor_is_stressed_and_locked_off() {
    let (_, run) = written();
    let rows = &run.curves[0].rows;
    let forces: Vec<f64> = rows.iter().map(|row| row[1]).collect();
    // A row for the start, three steps of weight, three of stressing, four of loading.
    assert_eq!(forces[..4], [0.0; 4]);
    for (force, expected) in forces[4..7].iter().zip([4e3, 8e3, 12e3]) {
        assert!((force / expected - 1.0).abs() < 1e-12, "{forces:?}");
    }
    assert!(forces[10] > 12e3, "{forces:?}");
    let counts: Vec<usize> = run
        .summary
        .stages
        .iter()
        .map(|stage| stage.reinforcement.len())
        .collect();
    assert_eq!(counts, [1, 2, 3, 3]);
    let [.., loaded, _] = &run.summary.stages[..] else {
        panic!("there are four stages");
    };
    assert!((loaded.reinforcement[0].head_force / forces[10] - 1.0).abs() < 1e-12);
}

/// GOAL: no tension beyond what the bond on either side allows.
#[test]
fn tables_tell_tension_and_its_limit() {
    let (folder, _) = written();
    let read = |name: &str| -> Vec<Vec<f64>> {
        let mut reader = csv::Reader::from_path(folder.join("reinforcement").join(name)).unwrap();
        assert_eq!(
            reader
                .headers()
                .unwrap()
                .iter()
                .collect::<Vec<_>>()
                .join(" "),
            "distance_[m] x_[m] y_[m] force_[N/m]_tension_+ limit_[N/m] strain_[-] at_limit_[-]"
        );
        let rows = reader.records().map(|row| {
            let row = row.unwrap();
            row.iter().map(|cell| cell.parse().unwrap()).collect()
        });
        rows.collect()
    };
    let length = 3.0_f64.hypot(0.4);
    let nail = read("nail__3-load.csv");
    for row in &nail {
        let limit = (10e3 * row[0].min(length - row[0])).min(20e3);
        assert!((row[4] / limit - 1.0).abs() < 1e-6);
        assert!(row[3] <= row[4] * (1.0 + 1e-8));
    }
    assert!(nail.iter().any(|row| row[3] > 1e3));
    assert!(!folder.join("reinforcement/mat__2-stress.csv").exists());
    assert!((read("anchor__2-stress.csv")[0][3] / 12e3 - 1.0).abs() < 1e-9);
    // Its bond is reduced with the strength.
    let reduced = read("anchor__stage-04-last-stable.csv");
    let full = read("anchor__3-load.csv");
    assert!(reduced.last().unwrap()[4] < 0.99 * full.last().unwrap()[4]);
}

/// GOAL: members have frames beside those of the soil, and pictures and report tell of them.
#[test]
fn frames_pictures_and_report_show_the_members() {
    let (folder, _) = written();
    let read = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    let soil = read("paraview/particles.pvd");
    let frames = read("paraview/reinforcement.pvd");
    assert_eq!(soil.replace("particles_", "reinforcement_"), frames);
    let last = frames.matches("<DataSet").count();
    let frame = read(&format!("paraview/reinforcement_{last:04}.vtu"));
    for name in ["force [N/m], tension +", "limit [N/m]", "strain"] {
        assert!(frame.contains(&format!("Name=\"{name}\"")), "{name}");
    }
    let page = read("report.html");
    for text in [
        "Reinforcement, per metre run",
        "anchor, ",
        "locked off at 12 kN",
        "Tension per metre run",
        "nail__3-load.csv",
        "reinforcement.pvd",
    ] {
        assert!(page.contains(text), "{text}");
    }
    assert!(read("figures/model.svg").contains("reinforcement"));
    assert!(read("figures/field-3-load-displacement.svg").contains("mat "));
}

/// GOAL: the same bits on any number of threads.
#[test]
fn bits_do_not_depend_on_threads() {
    let forces = |threads: usize| -> Vec<u64> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let case = parsed(&[]).into_case();
        let run = pool.build().unwrap().install(|| in_memory(&case).unwrap());
        let members = run.body.reinforcement.iter();
        let bars = members.flat_map(|m| m.segments.iter().map(|bar| bar.state.force.to_bits()));
        let soil = run.body.particles.x.iter().flatten().map(|x| x.to_bits());
        bars.chain(soil).collect()
    };
    let one = forces(1);
    assert_eq!(one, forces(2));
    assert_eq!(one, forces(5));
}

/// GOAL: a member that a completed file states is the one of the file.
#[test]
fn explained_files_state_the_same() {
    let file = parsed(&[]);
    let again = CaseFile::parse("again.toml", &file.explain(), &[]).unwrap();
    assert_eq!(again.case().reinforcement, file.case().reinforcement);
    let [head, end] = file.case().reinforcement[0].fastened;
    assert!((head / 25e3 - 1.0).abs() < 1e-12 && end.abs() < 1e-12);
}

// GOAL: a prestress is locked off at its value, or the file is refused; where a stage ends early all the same the tension that was
// locked off is told.
// ORACLE: by hand: after one of three even steps the jack holds a third of 12 kN/m.
#[test]
fn a_prestress_is_not_locked_off_in_part_unsaid() {
    let stop = (
        "install = [\"anchor\"]",
        "install = [\"anchor\"]\nstop_when = { displacement = \"0.1 mm\" }",
    );
    let refused = messages_of_each(("tied_cut.toml", TEXT), &[stop]);
    assert!(
        refused.contains("would lock off `anchor` with a part of its prestress"),
        "{refused}"
    );
    let unstressed = edited(TEXT, &[stop, ("prestress = \"12 kN/m\"\n", "")]);
    assert!(CaseFile::parse("tied_cut.toml", &unstressed, &[]).is_ok());
    let mut case = parsed(&[]).case().clone();
    case.stages.truncate(2);
    case.checks.clear();
    case.stages[1].stop_when.displacement = Some(1e-9);
    let run = in_memory(&case).unwrap();
    let lines = run
        .summary
        .warnings
        .iter()
        .filter(|text| text.contains("locked off"));
    let lines: Vec<&String> = lines.collect();
    assert_eq!(lines.len(), 1, "{:?}", run.summary.warnings);
    assert!(lines[0].contains("\"anchor\" at 4 of 12 kN/m"), "{lines:?}");
}

// GOAL: members in soil that is dug, or that comes later, are refused as the file is read: the run would end there.
// ORACLE: by hand: the nail lies from x = 6 m to 3 m below y = 1.6 m.
#[test]
fn members_lie_in_soil_while_they_are_there() {
    let body = "polygon = [\n    [\"0 m\", \"0 m\"],\n    [\"8 m\", \"0 m\"],\n    [\"8 m\", \"1 m\"],\n    [\"6.2 m\", \"1 m\"],\n    [\"5.2 m\", \"4 m\"],\n    [\"0 m\", \"4 m\"],\n]";
    let upper = "polygon = [[\"0 m\", \"2.2 m\"], [\"5.8 m\", \"2.2 m\"], [\"5.2 m\", \"4 m\"], [\"0 m\", \"4 m\"]]\n\
                 [[bodies]]\nname = \"lower\"\nmaterial = \"clay\"\npolygon = [[\"0 m\", \"0 m\"], [\"8 m\", \"0 m\"], [\"8 m\", \"1 m\"], [\"6.2 m\", \"1 m\"], [\"5.8 m\", \"2.2 m\"], [\"0 m\", \"2.2 m\"]]";
    let later = "[[stages]]\nname = \"later\"\ntype = \"construction\"\nstart_from = \"weight\"\n";
    let safety = "[[stages]]\nname = \"safety\"";
    let with = |lines: &str| {
        let text = edited(
            TEXT,
            &[(body, upper), (safety, &format!("{later}{lines}{safety}"))],
        );
        CaseFile::parse("tied_cut.toml", &text, &[]).map(|file| file.warnings())
    };
    assert!(with("remove = [\"soil\"]\n").is_ok());
    let dug = with("remove = [\"lower\"]\n").unwrap_err().to_string();
    assert!(
        dug.contains("the nail `nail` is held at (")
            && dug.contains("where no soil is in stage `later`"),
        "{dug}"
    );
    let placed = with("place = [\"lower\"]\n").unwrap_err().to_string();
    assert!(
        placed.contains("where no soil is from the start"),
        "{placed}"
    );
}

/// The largest tension of a geotextile under a fill of 2 m on soft ground, in the whole section or in its right half.
fn tension_under_fill(is_half: bool, more: &str) -> f64 {
    let [left, fill, end] = if is_half {
        [0.0, 0.0, 0.0]
    } else {
        [-8.0, -4.0, -3.5]
    };
    let text = format!(
        r#"
igimp = 1
[case]
title = "a fill on a geotextile"
[grid]
cell = "0.5 m"
domain = {{ x = ["{left} m", "8 m"], y = ["0 m", "5 m"] }}
[materials.soft]
model = "elastic"
young = "2 MPa"
poisson = 0.45
unit_weight = "16 kN/m3"
[materials.fill]
model = "elastic"
young = "5 MPa"
poisson = 0.3
unit_weight = "20 kN/m3"
[[bodies]]
name = "ground"
material = "soft"
polygon = [["{left} m","0 m"],["8 m","0 m"],["8 m","3 m"],["{left} m","3 m"]]
[[bodies]]
name = "fill"
material = "fill"
polygon = [["{fill} m","3 m"],["4 m","3 m"],["4 m","4 m"],["{fill} m","4 m"]]
[[reinforcement]]
name = "mat"
type = "geotextile"
points = [["{end} m","3 m"],["3.5 m","3 m"]]
stiffness = "5 MN/m"
capacity = "100 kN/m"
bond = "30 kPa"
{more}
[[stages]]
name = "weight"
type = "gravity"
steps = 2
geometry = "given"
[output]
figures = []
report = false
"#
    );
    let file = CaseFile::parse("fill.toml", &text, &[]).unwrap();
    let run = in_memory(file.case()).unwrap();
    run.summary.stages[0].reinforcement[0].force
}

/// GOAL: a geotextile that ends on a plane of symmetry goes on beyond it.
/// ORACLE: the whole section, whose tension in the middle is that at the end of the half; an end that is free by its key is the control.
#[test]
fn half_a_geotextile_is_held_on_the_plane_of_symmetry() {
    let whole = tension_under_fill(false, "");
    let half = tension_under_fill(true, "");
    let free = tension_under_fill(true, "head_capacity = \"0 kN/m\"");
    println!("whole {whole}, half {half}, with a free end {free}");
    assert!(
        whole > 1e3 && (half / whole - 1.0).abs() < 1e-6,
        "{whole} {half}"
    );
    assert!((free / whole - 1.0).abs() > 0.05, "{free}");
}

/// A cut in space, 2 m wide with an anchor in its middle or 1 m wide with half of it on the plane of symmetry: tension at the head and the
/// displacement of the face at the anchor.
fn anchored_slice(width: f64, share: f64, plate: f64) -> Result<[f64; 2], String> {
    let text = format!(
        r#"
igimp = 1
[case]
title = "half an anchor"
analysis = "3d"
[grid]
cell = "0.5 m"
domain = {{ x = ["0 m","5 m"], y = ["0 m","{width} m"], z = ["0 m","3.5 m"] }}
[materials.soil]
model = "elastic"
unit_weight = "20 kN/m3"
young = "5 MPa"
poisson = 0.3
[[bodies]]
name = "ground"
material = "soil"
points_per_cell = 8
box = {{ from = ["0 m","0 m","0 m"], to = ["4 m","{width} m","3 m"] }}
[[reinforcement]]
name = "anchor"
type = "anchor"
head = ["4 m","1 m","1.5 m"]
end = ["1 m","1 m","1.25 m"]
bonded_length = "1.5 m"
plate = "{plate} m"
stiffness = "{} MN"
capacity = "{} kN"
bond = "{} kN/m"
prestress = "{} kN"
[[stages]]
name = "weight"
type = "gravity"
steps = 1
geometry = "given"
[[stages]]
name = "stress"
type = "gravity"
install = ["anchor"]
steps = 1
geometry = "given"
[[stages]]
name = "more"
type = "gravity"
factor = 1.2
steps = 1
geometry = "given"
[[monitors]]
name = "face"
point = ["4 m","0.75 m","1.75 m"]
record = ["displacement_x"]
[output]
figures = []
report = false
"#,
        60.0 * share,
        100.0 * share,
        60.0 * share,
        30.0 * share
    );
    let file = CaseFile::parse("slice.toml", &text, &[]).map_err(|error| error.to_string())?;
    let run = in_memory(file.case_in_space()).unwrap();
    assert!(run.failure.is_none(), "{:?}", run.failure);
    let force = run.summary.stages[2].reinforcement[0].head_force;
    let row = run.monitors[0].rows.last().unwrap();
    Ok([force, row[row.len() - 1]])
}

/// GOAL: the plate of an anchor on a plane of symmetry is cut there: half of the anchor on half of the ground is half of the whole.
/// ORACLE: the whole. A plate that reaches off the ground by more than a cell is refused.
#[test]
fn plates_are_cut_on_planes_of_symmetry() {
    let whole = anchored_slice(2.0, 1.0, 1.0).unwrap();
    let half = anchored_slice(1.0, 0.5, 1.0).unwrap();
    println!("whole {whole:?}, half {half:?}");
    assert!((2.0 * half[0] / whole[0] - 1.0).abs() < 1e-4);
    // The face moves by 6 % more in the half.
    assert!((half[1] / whole[1] - 1.0).abs() < 0.1);
    let refused = anchored_slice(2.0, 1.0, 5.0).unwrap_err();
    assert!(
        refused.contains("the plate of `anchor`") && refused.contains("where there is no body"),
        "{refused}"
    );
}
