//! GOAL: a study of the mesh error is the runs of its meshes and nothing else: their bits, their
//! estimate, their folders; a fault on one takes nothing from the others.
//! CASE: a vertical cut and a slope on coarse grids.
//! ORACLE: the same meshes run by themselves, and $`2 F(h/2) - F(h)`$.

mod run_support;

use std::path::PathBuf;
use std::process::Command;

use igimp_cases::run::in_memory;
use igimp_input::CaseFile;
use igimp_input::shipped::find;
use igimp_model::Case;
use igimp_results::mesh_study::{Order, ResultKind, StudyResult};
use igimp_results::summary::Summary;
use run_support::{Folder, differing};

/// A shipped case with settings.
fn shipped(name: &str, settings: &[&str]) -> CaseFile {
    let text = find(name).unwrap().text;
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    CaseFile::parse(&format!("{name}.toml"), text, &settings).unwrap()
}

/// A cut of ten cells, driven to collapse.
const CUT: [&str; 6] = [
    "grid.cell=0.5 m",
    "stages.1.steps=40",
    "stages.1.factor=1.2",
    "stages.1.stop_when={ no_equilibrium = true, displacement = \"0.05 m\" }",
    "mesh_study.meshes=2",
    "checks=[{ name = \"stability number\", of = \"gravity_factor\", divide_by = [0.25], \
     value = \"extrapolated\", between = [3.6, 4.0], source = \"limit analysis, 3.76 to 3.80\" }]",
];

fn result(summary: &Summary, kind: ResultKind) -> &StudyResult {
    let study = summary.mesh_study.as_ref().unwrap();
    study
        .results
        .iter()
        .find(|result| result.kind == kind)
        .unwrap()
}

fn reached(case: &Case<2>) -> f64 {
    let run = in_memory(case).unwrap();
    let stage = &run.summary.stages[1];
    0.8 + stage.reached * (1.2 - 0.8)
}

#[test]
fn a_study_is_its_meshes() {
    let file = shipped("vertical_cut", &CUT);
    let case = file.case();
    let run = in_memory(case).unwrap();
    let mut alone = case.clone();
    alone.mesh_study.meshes = 1;
    let load = result(&run.summary, ResultKind::LimitLoad);
    let [Some(coarse), Some(fine)] = load.values[..] else {
        panic!("{load:?}");
    };
    assert_eq!(Some(reached(&alone)), load.values[0]);
    let found = load.estimate.unwrap();
    assert!((found.value - (2.0 * fine - coarse)).abs() < 1e-12);
    assert!(matches!(found.order, Order::Assumed { .. }));
    // A displacement may end the stage: a planned step.
    let width = (1.2 - 0.8) / 40.0;
    assert!(
        load.half_widths
            .iter()
            .all(|half| (half - width).abs() < 1e-15)
    );
    // With order 2/3 in place of 1.
    let share = 1.0 / (4_f64.cbrt() - 1.0);
    let expected = (share - 1.0) * (coarse - fine).abs() + (1.0 + 2.0 * share) * width;
    assert!((found.uncertainty - expected).abs() < 1e-12);

    // The bounds of limit analysis, 3.76 to 3.80 times 0.25.
    assert!((found.value - 0.945).abs() < found.uncertainty, "{found:?}");
    let check = &run.summary.checks[0];
    assert!(check.pass, "{check:?}");
    let of_check = result(&run.summary, ResultKind::Check);
    let extrapolated = of_check.estimate.unwrap();
    assert!((check.check.measured - extrapolated.value).abs() < 1e-12);
    assert!((extrapolated.value - 4.0 * found.value).abs() < 1e-12);
    assert!((extrapolated.uncertainty - 4.0 * found.uncertainty).abs() < 1e-12);
}

/// GOAL: a mesh's completed case states that mesh.
#[test]
fn the_completed_case_of_a_mesh_is_that_mesh() {
    let file = shipped("slope", &["mesh_study.meshes=3", "grid.cell=2 m"]);
    let texts = file.explain_meshes();
    assert_eq!(texts.len(), 3);
    for (text, parts) in texts.iter().zip([1, 2, 4]) {
        let mesh = CaseFile::parse("slope.toml", text, &[]).unwrap();
        let mut expected = file.case().refined(parts);
        expected.mesh_study.meshes = 1;
        assert_eq!(format!("{:?}", mesh.case()), format!("{expected:?}"));
    }
}

#[test]
fn the_program_tells_of_all_meshes() {
    let folder = Folder::new("meshes");
    let output = folder
        .run(
            "out",
            &[
                "--meshes",
                "2",
                "--set",
                "output.report=true",
                "--set",
                "output.figures=[\"displacement\"]",
            ],
        )
        .stdout(std::process::Stdio::piped())
        .output()
        .unwrap();
    let printed = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{printed}");
    for line in [
        "meshes",
        "mesh error",
        "extrapolated",
        "(order 1, assumed; 0.67 to 2 allowed for)",
    ] {
        assert!(printed.contains(line), "{line}: {printed}");
    }
    let root = folder.0.join("out");
    let text = std::fs::read_to_string(root.join("summary.json")).unwrap();
    let summary: Summary = serde_json::from_str(&text).unwrap();
    let safety = result(&summary, ResultKind::FactorOfSafety);
    let [Some(coarse), Some(fine)] = safety.values[..] else {
        panic!("{safety:?}");
    };
    let found = safety.estimate.unwrap();
    assert!((found.value - (2.0 * fine - coarse)).abs() < 1e-12);
    let page = std::fs::read_to_string(root.join("report.html")).unwrap();
    assert!(page.contains("Mesh error") && page.contains("mesh-2/report.html"));
    assert!(!page.contains("is missing"), "a picture is missing");
    let first = &summary
        .figures
        .iter()
        .find(|note| note.file.contains("mesh-study"))
        .unwrap()
        .file;
    assert!(root.join(format!("{first}.svg")).is_file());
    let table = std::fs::read_to_string(root.join("mesh_study.csv")).unwrap();
    assert!(table.starts_with("result,value (h),value (h/2)"), "{table}");
    // A run of one mesh into the folder takes the meshes away.
    let (code, printed) = folder.end("out", &[]);
    assert_eq!(code, Some(0), "{printed}");
    assert!(!root.join("mesh-1").exists() && !root.join("mesh_study.csv").exists());
}

/// GOAL: the same bits side by side and one after another; and a study that was stopped ends as one that
/// was not.
#[test]
fn a_study_taken_up_again_ends_the_same() {
    let folder = Folder::new("meshes-again");
    let study = ["--meshes", "2"];
    let (code, printed) = folder.end("whole", &[&study[..], &["--threads", "1"]].concat());
    assert_eq!(code, Some(0), "{printed}");
    let expected = folder.everything("whole");
    let (code, printed) = folder.end("out", &[&study[..], &["--threads", "2"]].concat());
    assert_eq!(code, Some(0), "{printed}");
    assert_eq!(
        differing(&expected, &folder.everything("out")),
        Vec::<PathBuf>::new()
    );

    // Killed as soon as the finer mesh has a checkpoint.
    let mut child: std::process::Child = folder.run("killed", &study).spawn().unwrap();
    let begun = folder.0.join("killed/mesh-2/checkpoint");
    for _ in 0..60_000 {
        let mut saved = std::fs::read_dir(&begun).into_iter().flatten();
        if saved.next().is_some() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(!folder.0.join("killed/summary.json").exists());
    let (code, printed) = folder.end("killed", &[&study[..], &["--resume"]].concat());
    assert_eq!(code, Some(0), "{printed}");
    assert_eq!(
        differing(&expected, &folder.everything("killed")),
        Vec::<PathBuf>::new()
    );
}

/// GOAL: a mesh that cannot be run is named, and the other one is there.
#[test]
fn a_mesh_that_fails_takes_nothing_from_the_others() {
    let folder = Folder::new("meshes-fail");
    let foreign = folder.0.join("out/mesh-2");
    std::fs::create_dir_all(&foreign).unwrap();
    std::fs::write(foreign.join("notes.txt"), "the user's").unwrap();
    std::fs::write(folder.0.join("out/.igimp"), "").unwrap();
    let (code, printed) = folder.end("out", &["--meshes", "2"]);
    assert_eq!(code, Some(2), "{printed}");
    assert!(printed.contains("was not written by igimp"), "{printed}");
    let text = std::fs::read_to_string(folder.0.join("out/summary.json")).unwrap();
    let summary: Summary = serde_json::from_str(&text).unwrap();
    let safety = result(&summary, ResultKind::FactorOfSafety);
    assert!(safety.values[0].is_some() && safety.values[1].is_none());
    assert_eq!(safety.estimate, None);
    assert!(summary.stages.len() == 3 && foreign.join("notes.txt").exists());

    // Want of equilibrium on the way to the weight, on both meshes.
    let weak = [
        "--meshes",
        "2",
        "--set",
        "materials.clay.cohesion=1 kPa",
        "--set",
    ];
    let weak = [&weak[..], &["materials.clay.friction=5 deg"]].concat();
    let (code, printed) = folder.end("weak", &weak);
    assert_eq!(code, Some(3), "{printed}");
    let text = std::fs::read_to_string(folder.0.join("weak/summary.json")).unwrap();
    assert!(text.contains("on the mesh h: "), "{text}");
}

/// GOAL: a march that ended on its way is named in verdict and report, extrapolates to nothing and meets no check.
/// CASE: a footing that is to be pushed by its width, with a solver that may correct three times only: some 2 % of the way.
#[test]
fn a_march_that_ended_early_is_refused() {
    let folder = Folder::new("meshes-early");
    let text = find("footing_bonded").unwrap().text;
    std::fs::write(folder.0.join("footing.toml"), text).unwrap();
    let check = "checks=[{ name = \"N\", of = \"footing.reaction\", divide_by = [\"1 m\", \"1 kPa\"], between = [0, 1e3], \
                 source = \"every value meets it\" }]";
    let mut command = Command::new(env!("CARGO_BIN_EXE_igimp"));
    command.args(["run", "footing.toml", "--out", "out", "--meshes", "2"]);
    for setting in [
        "grid.cell=1/3 m",
        "solver.max_iterations=3",
        "curves=[]",
        check,
    ] {
        command.args(["--set", setting]);
    }
    let output = command.current_dir(&folder.0).output().unwrap();
    let printed = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(3), "{output:?}");
    let refusal = "nothing is extrapolated: the runs on the meshes h and h/3 ended early";
    assert!(printed.contains(refusal), "{printed}");
    let text = std::fs::read_to_string(folder.0.join("out/summary.json")).unwrap();
    let summary: Summary = serde_json::from_str(&text).unwrap();
    let load = result(&summary, ResultKind::LimitLoad);
    assert!(load.ended_early(0) && load.ended_early(1), "{load:?}");
    assert_eq!(load.estimate, None);
    assert!(!summary.checks[0].pass && summary.checks[0].check.measured.is_nan());
    let page = std::fs::read_to_string(folder.0.join("out/report.html")).unwrap();
    // The template escapes slashes.
    assert!(page.contains(&refusal.replace('/', "&#x2f;")), "{refusal}");
    assert!(page.contains("is not held: no mesh came to its value"));
}

#[test]
fn a_study_that_makes_no_sense_is_refused() {
    let folder = Folder::new("meshes-told");
    let check = |settings: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_igimp"));
        command.args(["check", "slope.toml"]).current_dir(&folder.0);
        for setting in settings {
            command.args(["--set", setting]);
        }
        let output = command.output().unwrap();
        let printed = [output.stdout, output.stderr].concat();
        (
            output.status.code(),
            String::from_utf8_lossy(&printed).into_owned(),
        )
    };
    let (code, printed) = check(&["mesh_study.meshes=4"]);
    assert_eq!(code, Some(2));
    assert!(printed.contains("mesh_study.meshes=4"), "{printed}");
    let (code, printed) = check(&["mesh_study.meshes=3", "grid.cell=0.01 m"]);
    assert_eq!(code, Some(2));
    assert!(
        printed.contains("the finest mesh, h/4, would have too many"),
        "{printed}"
    );
    let (code, printed) = check(&["grid.refine=64", "grid.cell=0.1 m"]);
    assert_eq!(code, Some(2));
    assert!(
        printed.contains("the refined grid would have too many"),
        "{printed}"
    );
    let (code, printed) = check(&["checks.0.value=extrapolated"]);
    assert_eq!(code, Some(0));
    assert!(
        printed.contains("asks for an extrapolated value, and there is one mesh"),
        "{printed}"
    );
    assert!(printed.contains("--meshes 2"), "{printed}");
    let (code, printed) = check(&["mesh_study.meshes=2"]);
    assert_eq!(code, Some(0));
    assert!(
        printed.contains("side by side") || printed.contains("one after another"),
        "{printed}"
    );
}
