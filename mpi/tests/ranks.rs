//! Whole runs on 1, 2 and 4 ranks, against the serial program.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use igimp_input::shipped::find;
use serde_json::Value;

/// Differences of displacements and forces, over the largest of their kind \[-\].
const EQUAL: f64 = 1e-10;

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Writes a shipped case, without pictures.
fn write(name: &str, folder: &Path) -> PathBuf {
    let path = folder.join(format!("{name}.toml"));
    fs::write(&path, find(name).unwrap().text).unwrap();
    path
}

/// The words of a run of a case.
fn words(case: &Path, out: &Path, settings: &[&str]) -> Vec<OsString> {
    let mut words: Vec<OsString> = ["run".into(), case.into(), "--out".into(), out.into()].into();
    let usual = ["output.figures=[]", "output.report=false", "checks=[]"];
    for set in usual.iter().chain(settings) {
        words.extend(["--set".into(), set.into()]);
    }
    words.push("--quiet".into());
    words
}

fn on_ranks(ranks: usize, words: &[OsString]) -> Command {
    let mut command = Command::new("mpirun");
    command
        .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
        .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
        // Other tests are on the same cores.
        .env("OMPI_MCA_mpi_yield_when_idle", "1")
        .args(["--oversubscribe", "--bind-to", "none", "-n"])
        .arg(ranks.to_string())
        .arg(env!("CARGO_BIN_EXE_igimp-mpi"))
        .args(words);
    command
}

fn printed(output: &Output) -> String {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    text(&output.stdout) + &text(&output.stderr)
}

/// The newest checkpoint of a results folder.
fn checkpoint(out: &Path) -> (PathBuf, Value) {
    let entries = fs::read_dir(out.join("checkpoint")).unwrap();
    let saved = entries.map(|entry| {
        let path = entry.unwrap().path();
        let text = fs::read_to_string(path.join("meta.json")).unwrap();
        let meta: Value = serde_json::from_str(&text).unwrap();
        (path, meta)
    });
    saved
        .max_by_key(|(_, meta)| meta["sequence"].as_u64())
        .unwrap()
}

/// The numbers of an array of a checkpoint.
fn column(path: &Path, name: &str) -> Vec<f64> {
    let bytes = fs::read(path.join("current").join(name)).unwrap();
    let header = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let (numbers, []) = bytes[header..].as_chunks() else {
        panic!("{name} has no whole numbers");
    };
    numbers.iter().map(|&own| f64::from_le_bytes(own)).collect()
}

/// All numbers of a tree, by its branch.
fn numbers(value: &Value, found: &mut Vec<f64>) {
    match value {
        Value::Number(own) => found.extend(own.as_f64()),
        Value::Array(all) => all.iter().for_each(|own| numbers(own, found)),
        Value::Object(all) => all.values().for_each(|own| numbers(own, found)),
        _ => {}
    }
}

/// The largest difference of two lists over the largest number of the first.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let most = a
        .iter()
        .fold(f64::MIN_POSITIVE, |most, own| most.max(own.abs()));
    let pairs = a.iter().zip(b);
    pairs.fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs())) / most
}

/// Factors of safety of a run, with the displacements of their trials; empty where none was searched for.
fn safety(out: &Path) -> Vec<f64> {
    let text = fs::read_to_string(out.join("summary.json")).unwrap();
    let summary: Value = serde_json::from_str(&text).unwrap();
    let mut found = Vec::new();
    for stage in summary["stages"].as_array().unwrap() {
        let own = &stage["safety"];
        numbers(&own["stable"], &mut found);
        numbers(&own["failed"], &mut found);
        for trial in own["trials"].as_array().into_iter().flatten() {
            numbers(&trial["displacement"], &mut found);
        }
    }
    found
}

/// The largest differences of displacements, and of loads and forces on rigid bodies, of the newest checkpoints of two runs.
fn differences(a: &Path, b: &Path) -> [f64; 2] {
    let found = [a, b].map(safety);
    let (a, b) = (checkpoint(a), checkpoint(b));
    let moved = [&a.0, &b.0].map(|path| column(path, "displacement.npy"));
    let loads = [&a.1, &b.1].map(|meta| {
        let mut found = Vec::new();
        numbers(&meta["data"]["controls"], &mut found);
        found
    });
    let of_loads = difference(&loads[0], &loads[1]).max(difference(&found[0], &found[1]));
    [difference(&moved[0], &moved[1]), of_loads]
}

/// Shipped cases, what is set to shorten them, and the solver that takes their systems.
const CASES: [(&str, &[&str], &str); 8] = [
    ("column", &["stages.0.steps=4"], "petsc-mumps-llt"),
    ("von_mises_slope", &["stages.0.steps=3"], "petsc-mumps-llt"),
    (
        "mohr_coulomb_slope",
        &[
            "stages.0.bracket=[1.3, 1.5]",
            "stages.0.factors=[1]",
            "curves=[]",
            "stages.0.steps=2",
            "stages.0.tolerance=0.1",
        ],
        "petsc-mumps-lu",
    ),
    (
        "footing",
        &[
            "grid.cell=0.21 m",
            "stages.0.steps=2",
            "stages.0.bodies=[{body=\"footing\", y=\"-0.02 m\"}]",
        ],
        "petsc-mumps-llt",
    ),
    (
        "footing_3d",
        &[
            "grid.cell=0.4 m",
            "grid.domain={x=[\"0 m\", \"2.8 m\"], y=[\"0 m\", \"2.8 m\"], z=[\"0 m\", \"3.2 m\"]}",
            "rigid.0.to=[\"0.75 m\", \"0.75 m\", \"3 m\"]",
            "grid.zones={}",
            "stages.0.steps=2",
            "stages.0.bodies=[{body=\"footing\", z=\"-0.002 m\"}]",
        ],
        "petsc-mumps-llt",
    ),
    (
        "landslide_3d",
        &[
            "grid.cell={x=\"2 m\", y=\"2.5 m\", z=\"1 m\"}",
            "stages=[{name=\"weight\", type=\"gravity\", steps=2}]",
        ],
        "petsc-mumps-llt",
    ),
    (
        "consolidation",
        &[
            "stages.3.steps=1",
            "stages.3.consolidation.duration=\"365.25 d\"",
        ],
        "petsc-mumps-ldlt",
    ),
    (
        "penetration_rate",
        &[
            "curves=[]",
            "stages=[{name=\"at rest\", type=\"k0\", drained=true, steps=1}, \
             {name=\"push\", type=\"displacement\", load=\"footing\", settlement=\"2 mm\", \
             consolidation={duration=\"180 d\"}, steps=2}]",
        ],
        "petsc-mumps-lu",
    ),
];

/// GOAL: one rank, two and four give the answer of the serial program in displacement and load, in the plane and in space, with
/// symmetric tangents and others, rigid bodies in contact, a strength reduction, and soil that consolidates.
/// ORACLE: igimp's own factors, on one thread.
#[test]
fn ranks_give_the_answer_of_the_serial_program() {
    let folder = folder("ranks");
    for (name, settings, method) in CASES {
        let case = write(name, &folder);
        let serial = folder.join(format!("{name}-serial"));
        let mut own = words(&case, &serial, settings);
        own.insert(0, "igimp".into());
        own.extend(["--threads".into(), "1".into()]);
        igimp::program(own, None);
        for ranks in [1, 2, 4] {
            let out = folder.join(format!("{name}-{ranks}"));
            let run = on_ranks(ranks, &words(&case, &out, settings))
                .output()
                .unwrap();
            // With 1 it missed a reference of the case, which fewer steps do.
            let ended = matches!(run.status.code(), Some(0 | 1));
            assert!(ended, "{name}, {ranks}: {}", printed(&run));
            let [moved, loads] = differences(&serial, &out);
            println!("{name}, {ranks} ranks: displacement {moved:.1e}, load {loads:.1e}");
            assert!(
                moved < EQUAL && loads < EQUAL,
                "{name}, {ranks}: {moved:e} {loads:e}"
            );
            let summary = fs::read_to_string(out.join("summary.json")).unwrap();
            assert!(summary.contains(method), "{name}, {ranks}: {summary}");
        }
    }
}

/// GOAL: a rank that is killed ends the run with a word of it, the last checkpoint is whole, and the serial program goes on from it;
/// so do ranks from a run of the serial program.
/// ORACLE: the serial program left alone.
#[test]
fn a_killed_rank_costs_what_came_after_the_checkpoint() {
    let folder = folder("killed");
    let case = write("column", &folder);
    let settings = ["output.checkpoint={every=1}", "stages.0.steps=150"];
    let [alone, out] = ["alone", "out"].map(|name| folder.join(name));
    let own = |out: &Path, more: &[&str]| {
        let mut own = words(&case, out, &settings);
        own.insert(0, "igimp".into());
        own.extend(more.iter().map(OsString::from));
        own
    };
    igimp::program(own(&alone, &[]), None);
    let mut run = on_ranks(2, &words(&case, &out, &settings));
    let run = run
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped());
    let run = run.spawn().unwrap();
    let begin = Instant::now();
    let is_under_way = || {
        let saved = fs::read_dir(out.join("checkpoint"))
            .into_iter()
            .flatten()
            .flatten();
        let mut names = saved.map(|entry| entry.file_name().to_string_lossy().into_owned());
        names.any(|name| name.starts_with("step-0000") && name.as_str() >= "step-000005")
    };
    while !is_under_way() {
        assert!(begin.elapsed() < Duration::from_secs(60), "no checkpoint");
        std::thread::sleep(Duration::from_millis(2));
    }
    let rank = process_of_rank(1, &out).unwrap();
    let killed = Command::new("kill")
        .args(["-KILL", &rank])
        .status()
        .unwrap();
    assert!(killed.success());
    let run = run.wait_with_output().unwrap();
    assert!(
        !run.status.success() && printed(&run).contains("signal 9"),
        "{}",
        printed(&run)
    );
    // `mpirun` may end before the ranks that it stops, and one of them holds the folder.
    while process_of_rank(0, &out).is_some() {
        assert!(begin.elapsed() < Duration::from_secs(120), "rank 0 goes on");
        std::thread::sleep(Duration::from_millis(20));
    }
    let first = checkpoint(&out).1["sequence"].as_u64().unwrap();
    assert!((5..150).contains(&first), "{first}");
    igimp::program(own(&out, &["--resume"]), None);
    let [moved, loads] = differences(&alone, &out);
    assert!(moved < EQUAL && loads < EQUAL, "{moved:e} {loads:e}");
    // The other way round: ranks find that the run is complete, by a checkpoint of the serial program.
    let mut again = words(&case, &out, &settings);
    again.push("--resume".into());
    let run = on_ranks(2, &again).output().unwrap();
    assert!(run.status.success(), "{}", printed(&run));
}

/// The process of a rank of a run into a folder, while there is one.
fn process_of_rank(rank: usize, out: &Path) -> Option<String> {
    let variable = format!("OMPI_COMM_WORLD_RANK={rank}");
    let out = out.display().to_string();
    let holds = |path: PathBuf, word: &str| {
        let bytes = fs::read(path).unwrap_or_default();
        bytes
            .split(|&byte| byte == 0)
            .any(|own| own == word.as_bytes())
    };
    let mut all = fs::read_dir("/proc").unwrap().filter_map(Result::ok);
    let found = all.find(|entry| {
        holds(entry.path().join("environ"), &variable) && holds(entry.path().join("cmdline"), &out)
    });
    found.map(|entry| entry.file_name().to_string_lossy().into_owned())
}

/// GOAL: bad input ends all ranks with the code of igimp, and other commands are refused.
#[test]
fn all_ranks_end_after_bad_input() {
    for (given, code, text) in [
        (["run", "nowhere.toml"], 4, "cannot read nowhere.toml"),
        (["check", "nowhere.toml"], 2, "knows `run` alone"),
    ] {
        let given = given.map(OsString::from);
        let run = on_ranks(3, &given).output().unwrap();
        assert!(printed(&run).contains(text), "{}", printed(&run));
        assert_eq!(run.status.code(), Some(code));
    }
}

/// GOAL: smoothed aggregation by `solver.linear`, and a method by PETSc's options, come to the answer of the factors.
/// ORACLE: igimp's own factors; iterations are as inexact as Newton's method asks, so the tolerance of the case bounds the difference.
#[test]
fn iterations_come_to_the_same_answer() {
    let folder = folder("iterations");
    let case = write("landslide_3d", &folder);
    let stage = "stages=[{name=\"weight\", type=\"gravity\", steps=1}]";
    let settings = [
        "grid.cell={x=\"2 m\", y=\"2.5 m\", z=\"1 m\"}",
        stage,
        "solver.tolerance=1e-9",
    ];
    let direct = folder.join("direct");
    let mut own = words(&case, &direct, &settings);
    own.insert(0, "igimp".into());
    igimp::program(own, None);
    let by_options = "-pc_type redundant";
    for (method, linear, options) in [
        ("petsc-gamg-cg", "multigrid", ""),
        ("petsc-options", "auto", by_options),
    ] {
        let out = folder.join(method);
        let linear = format!("solver.linear=\"{linear}\"");
        let mut own = words(&case, &out, &settings);
        own.extend(["--set".into(), linear.into()]);
        let run = on_ranks(2, &own)
            .env("PETSC_OPTIONS", options)
            .output()
            .unwrap();
        assert!(run.status.success(), "{}", printed(&run));
        let summary = fs::read_to_string(out.join("summary.json")).unwrap();
        assert!(summary.contains(method), "{summary}");
        let [moved, _] = differences(&direct, &out);
        println!("{method}: displacement {moved:.1e}");
        assert!(moved < 1e-7, "{method}: {moved:e}");
    }
}
