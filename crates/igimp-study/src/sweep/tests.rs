//! GOAL: tasks are those of the file, problems are printed with their place, and a table is made of
//! the results that are there.

use igimp_model::check::{Band, Check, PrintedUnit};
use igimp_results::summary::{CheckRow, SafetySummary, StageSummary, Standing, Summary};

use super::*;

const GRID: &str = "igimp_sweep = 1
case = \"slope.toml\"
[parameters]
materials.clay.friction = [\"20 deg\", \"25 deg\"]
materials.clay.cohesion = [\"8 kPa\", \"10 kPa\", \"12 kPa\"]
[output]
folder = \"out\"
";

fn parse(text: &str) -> Result<Sweep, String> {
    file::parse("study.toml", text, Path::new("cases")).map_err(|error| error.to_string())
}

#[test]
fn a_grid_takes_every_combination() {
    let sweep = parse(GRID).unwrap();
    assert_eq!(sweep.case, Path::new("cases/slope.toml"));
    assert_eq!(
        sweep.keys,
        ["materials.clay.friction", "materials.clay.cohesion"]
    );
    assert_eq!(sweep.tasks.len(), 6);
    assert_eq!(
        sweep.tasks[1].label(),
        "materials.clay.friction=\"20 deg\", materials.clay.cohesion=\"10 kPa\""
    );
    assert_eq!(sweep.tasks[3].values, ["\"25 deg\"", "\"8 kPa\""]);
    assert_eq!(sweep.tasks[5].folder, Path::new("out/task-0006"));
    assert_eq!(sweep.task(6).unwrap().number, 6);
    assert_eq!(
        sweep.task(0).unwrap_err().to_string(),
        "there is no task 0; tasks are numbered 1 to 6"
    );
}

#[test]
fn a_zip_takes_first_with_first() {
    let text = "igimp_sweep = 1\ncase = \"a.toml\"\ncombine = \"zip\"\n\
        [parameters]\n\"grid.cell\" = [\"1 m\", \"0.5 m\"]\nstages.\"own weight\".steps = [5, 0x0A]\n\
        [output]\nfolder = \"out\"\n";
    let sweep = parse(text).unwrap();
    assert_eq!(sweep.tasks.len(), 2);
    assert_eq!(
        sweep.tasks[0].settings,
        ["grid.cell=\"1 m\"", "stages.\"own weight\".steps=5"]
    );
}

/// GOAL: a single value is that of all tasks in a zip, whichever parameter has it.
/// ORACLE: the value stated for every task.
#[test]
fn a_single_value_of_a_zip_is_that_of_all_tasks() {
    let settings = |cells: &str, steps: &str| {
        let text = format!(
            "igimp_sweep = 1\ncase = \"a.toml\"\ncombine = \"zip\"\n\
             [parameters]\ngrid.cell = {cells}\nstages.w.steps = {steps}\n[output]\nfolder = \"out\"\n"
        );
        let tasks = parse(&text).unwrap().tasks.into_iter();
        tasks.map(|task| task.settings).collect::<Vec<_>>()
    };
    let [cells, steps] = ["[\"1 m\", \"2 m\", \"4 m\"]", "[5, 6, 7]"];
    assert_eq!(
        settings("[\"1 m\"]", steps),
        settings("[\"1 m\", \"1 m\", \"1 m\"]", steps)
    );
    assert_eq!(settings(cells, "[5]"), settings(cells, "[5, 5, 5]"));
    assert_eq!(settings("[\"1 m\"]", "[5]").len(), 1);
}

#[test]
fn problems_are_printed_with_their_place() {
    insta::assert_snapshot!(
        parse(&GRID.replace("folder", "foldr")).unwrap_err(),
        @r#"
    error: unknown field `foldr`
      --> study.toml:7:1
      |
    7 | foldr = "out"
      | ^^^^^
      = help: did you mean `folder`?
    "#
    );
    insta::assert_snapshot!(
        parse(&GRID.replace("[parameters]", "combine = \"zip\"\n[parameters]")).unwrap_err(),
        @r#"
    error: `materials.clay.cohesion` has 3 values, but `materials.clay.friction` has 2
      --> study.toml:6:27
      |
    6 | materials.clay.cohesion = ["8 kPa", "10 kPa", "12 kPa"]
      |                           ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
      = help: with combine = "zip" all parameters have as many values, or one
    "#
    );
    insta::assert_snapshot!(
        parse(&GRID.replace("[\"20 deg\", \"25 deg\"]", "\"20 deg\"")).unwrap_err(),
        @r#"
    error: `materials.clay.friction` is not a list of values
      --> study.toml:4:27
      |
    4 | materials.clay.friction = "20 deg"
      |                           ^^^^^^^^
      = help: write a list, like ["8 kPa", "10 kPa"]
    "#
    );
    for (text, part) in [
        ("igimp_sweep = 1", "`case` is missing"),
        ("igimp_sweep = 2", "not known"),
        ("igimp_sweep = ", "study.toml:1:"),
        ("", "`igimp_sweep` is missing"),
    ] {
        let message = parse(text).unwrap_err();
        assert!(message.contains(part), "{message}");
    }
}

/// A folder of its own for a test, gone when dropped.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("igimp-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn summary(fos: f64) -> Summary {
    Summary {
        stages: vec![StageSummary {
            safety: Some(SafetySummary {
                stable: Some(fos - 0.005),
                failed: Some(fos + 0.005),
                ..SafetySummary::default()
            }),
            ..StageSummary::default()
        }],
        checks: vec![CheckRow {
            check: Check {
                case: "slope".into(),
                variant: "iGIMP".into(),
                quantity: "top".into(),
                expected: 20.0,
                source: "by hand".into(),
                band: Band::AtMost(21.0),
                measured: 19.5,
                unit: Some(PrintedUnit {
                    name: "cm".into(),
                    in_si: 0.01,
                }),
            },
            pass: true,
            standing: Standing::Held,
        }],
        ..Summary::default()
    }
}

#[test]
fn the_table_has_the_results_that_are_there() {
    let scratch = Scratch::new("collect");
    let text = GRID.replace("\"out\"", &format!("{:?}", scratch.0.display().to_string()));
    let mut sweep = parse(&text).unwrap();
    for (task, fos) in sweep.tasks.iter().zip([1.2, 1.3]) {
        let curves = task.folder.join("curves");
        std::fs::create_dir_all(&curves).unwrap();
        let text = serde_json::to_string(&summary(fos)).unwrap();
        std::fs::write(task.folder.join("summary.json"), text).unwrap();
        std::fs::write(
            curves.join("srf.csv"),
            "# note\nF [-],u [m]\n1,0.1\n1.2,0.5\n",
        )
        .unwrap();
    }
    let record = Record {
        ending: Ending::Done,
        ..Record::default()
    };
    record.write(&sweep.tasks[0].folder).unwrap();

    sweep.collect = vec!["factor_of_safety".into(), "srf".into(), "none".into()];
    let table = collect(&sweep);
    assert_eq!(
        table.header[3..],
        [
            "end",
            "factor_of_safety",
            "factor_of_safety: stable",
            "factor_of_safety: failed",
            "srf: u [m]",
            "message"
        ]
    );
    assert_eq!(
        table.header[1..3],
        [
            "materials.clay.friction [deg]",
            "materials.clay.cohesion [kPa]"
        ]
    );
    assert_eq!(table.rows[0][..4], ["1", "20", "8", "done"]);
    assert!((table.rows[1][4].parse::<f64>().unwrap() - 1.3).abs() < 1e-12);
    assert_eq!(table.rows[1][7], "0.5");
    assert_eq!(table.missing, [3, 4, 5, 6]);
    assert_eq!(table.unknown, ["none"]);
    let path = table.write(&scratch.0).unwrap();
    assert_eq!(std::fs::read_to_string(path).unwrap().lines().count(), 7);
    assert!(!table.to_text().contains("message"));
    // Both tasks have the first friction: the result varies with the cohesion alone.
    assert!(table.draw(&scratch.0).unwrap().is_empty());
    let third = &sweep.tasks[3].folder;
    std::fs::create_dir_all(third).unwrap();
    let text = serde_json::to_string(&summary(1.5)).unwrap();
    std::fs::write(third.join("summary.json"), text).unwrap();
    let failed = Record {
        ending: Ending::Failed,
        message: "=the disk is full".into(),
        ..Record::default()
    };
    failed.write(&sweep.tasks[1].folder).unwrap();
    let table = collect(&sweep);
    let path = table.write(&scratch.0).unwrap();
    assert!(
        std::fs::read_to_string(path)
            .unwrap()
            .contains("'=the disk is full")
    );
    assert!(table.to_text().contains("  =the disk is full"));
    let drawn = table.draw(&scratch.0).unwrap();
    assert_eq!(drawn, [scratch.0.join("results-factor_of_safety")]);
    assert!(scratch.0.join("results-factor_of_safety.svg").exists());

    sweep.collect.clear();
    assert!(collect(&sweep).header.contains(&"top [cm]".to_owned()));
    sweep.collect = vec!["top".into()];
    let table = collect(&sweep);
    assert!((table.rows[0][4].parse::<f64>().unwrap() - 1950.0).abs() < 1e-9);
    assert!(table.unknown.is_empty());
}

#[test]
fn an_unknown_case_names_the_task() {
    let scratch = Scratch::new("nocase");
    let path = scratch.0.join("study.toml");
    std::fs::write(&path, GRID).unwrap();
    let error = Sweep::read(&path).unwrap_err().to_string();
    assert!(error.starts_with("task 1 ("), "{error}");
}

/// GOAL: of many runs each keeps the frames of the ends of its stages, unless the case or the sweep states it otherwise.
/// CASE: a sweep, and a study of two meshes; a run alone is a film. ORACLE: the case and its completed file.
#[test]
fn many_runs_are_no_films() {
    use igimp_model::Every;

    let scratch = Scratch::new("films");
    let shipped = igimp_input::shipped::find("column").unwrap();
    let case = scratch.0.join("column.toml");
    let path = scratch.0.join("study.toml");
    let frames = |text: &str, more: &str| {
        std::fs::write(&case, text).unwrap();
        let sweep = format!(
            "igimp_sweep = 1\ncase = \"column.toml\"\n[parameters]\n{more}stages.0.steps = [5, 6]\n\
             [output]\nfolder = \"out\"\n"
        );
        std::fs::write(&path, sweep).unwrap();
        let sweep = Sweep::read(&path).unwrap();
        let file = sweep.case_of(&sweep.tasks[0]).unwrap();
        let every = file.any_case().output().paraview;
        let completed = file.explain();
        let name = if every == Every::Film {
            "film"
        } else {
            "stage"
        };
        assert!(
            completed.contains(&format!("every = \"{name}\"")),
            "{completed}"
        );
        every
    };
    assert_eq!(frames(shipped.text, ""), Every::Stage);
    let more = "output.paraview.every = [\"film\"]\n";
    assert_eq!(frames(shipped.text, more), Every::Film);
    let stated = shipped
        .text
        .replace("[output]\n", "[output]\nparaview = { every = \"film\" }\n");
    assert_eq!(frames(&stated, ""), Every::Film);
    let every = |settings: &[&str]| {
        let file = shipped.case_file(settings.iter().copied()).unwrap();
        file.any_case().output().paraview
    };
    assert_eq!(every(&[]), Every::Film);
    assert_eq!(every(&["mesh_study.meshes=2"]), Every::Stage);
}

#[test]
fn endings_follow_the_summary() {
    let mut summary = summary(1.0);
    assert_eq!(summary.ending(), Ending::Done);
    summary.checks[0].pass = false;
    assert_eq!(summary.ending(), Ending::Missed);
    summary.stages[0].outcome = igimp_results::summary::StageOutcome::NotConverged;
    assert_eq!(summary.ending(), Ending::NotConverged);
    summary.interrupted = true;
    assert_eq!(summary.ending(), Ending::Interrupted);
    assert!(!Ending::Interrupted.is_verdict());
}
