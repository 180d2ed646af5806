//! GOAL: `igimp run --export-matrix` writes the systems that the run solved, in files that other
//! programs read.
//! ORACLE: the definition (K x = b, symmetry of associated laws, held components), and scipy, which
//! solves the systems anew where it is installed.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use igimp_results::linear_system::LinearSystem;
use igimp_results::npy::{Array, Values};

const VON_MISES: &str = "model = \"von-mises\"\ncu = \"12 kPa\"";
const MOHR_COULOMB: &str =
    "model = \"mohr-coulomb\"\ncohesion = \"8 kPa\"\nfriction = \"25 deg\"\ndilation = \"0 deg\"";

/// An upright face that yields at its foot, under gravity and then under a load.
fn case(law: &str) -> String {
    format!(
        "igimp = 1\n[case]\ntitle = \"face\"\ngravity = \"9.81 m/s2\"\n\
        [grid]\nlocking = \"b-bar\"\ncell = \"0.5 m\"\ndomain = {{ x = [\"0 m\", \"6 m\"], y = [\"0 m\", \"3 m\"] }}\n\
        [materials.soil]\nunit_weight = \"18 kN/m3\"\nyoung = \"10 MPa\"\npoisson = 0.3\n{law}\n\
        [[bodies]]\nname = \"face\"\nmaterial = \"soil\"\npoints_per_cell = 4\n\
        polygon = [[\"0 m\", \"0 m\"], [\"3 m\", \"0 m\"], [\"3 m\", \"2 m\"], [\"0 m\", \"2 m\"]]\n\
        [boundaries]\nleft = \"roller\"\nright = \"free\"\nbottom = \"fixed\"\n\
        [[loads]]\nname = \"fill\"\ntype = \"pressure\"\nfrom = [\"0 m\", \"2 m\"]\n\
        to = [\"2 m\", \"2 m\"]\npressure = \"1 kPa\"\n\
        [[stages]]\nname = \"own weight\"\ntype = \"gravity\"\nsteps = 2\n\
        [[stages]]\nname = \"fill\"\ntype = \"load\"\nloads = [\"fill\"]\nsteps = 2\n\
        [output]\nfolder = \"results\"\nreport = false\nfigures = []\n"
    )
}

/// An empty folder of the build with a case in it.
fn folder(name: &str, law: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("export-matrix")
        .join(name);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    fs::write(path.join("case.toml"), case(law)).unwrap();
    path
}

fn igimp(folder: &Path, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_igimp"))
        .args(words)
        .current_dir(folder)
        .output()
        .unwrap()
}

/// Runs the case of a folder with its systems written into `systems`.
fn export(folder: &Path, more: &[&str]) -> Output {
    let words = ["run", "case.toml", "--export-matrix", "systems"];
    igimp(folder, &[&words[..], more].concat())
}

fn succeeds(output: &Output) {
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{text}");
}

/// Largest entry.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| value.abs().max(most))
}

/// The entry in a row of a column, zero where none is stored.
fn entry(system: &LinearSystem, row: usize, column: usize) -> f64 {
    let [start, end] = [0, 1].map(|k| system.col_ptr[column + k] as usize);
    let found = system.row_idx[start..end].binary_search(&(row as i32));
    found.map_or(0.0, |at| system.values[start + at])
}

/// Largest difference of K and its transpose over the largest entry.
fn skew(system: &LinearSystem) -> f64 {
    let mut most: f64 = 0.0;
    for column in 0..system.places.len() {
        for row in 0..column {
            let difference = entry(system, row, column) - entry(system, column, row);
            most = most.max(difference.abs());
        }
    }
    most / largest(&system.values)
}

fn hold(system: &LinearSystem, symmetric: bool) {
    let matrix = system.matrix().unwrap();
    let n = system.about.unknowns;
    assert_eq!((matrix.pattern.unknowns(), system.places.len()), (n, n));
    assert_eq!(matrix.pattern.stored(), system.about.stored);
    let mut product = vec![0.0; n];
    matrix.multiply(&system.solution, &mut product);
    for (product, rhs) in product.iter_mut().zip(&system.rhs) {
        *product -= rhs;
    }
    assert!(largest(&product) < 1e-9 * largest(&system.rhs));
    assert_eq!(system.about.symmetric, symmetric);
    assert_eq!(skew(system) < 1e-12, symmetric, "{:e}", skew(system));
    // Held are the bottom, and x on the left.
    assert!(system.places.iter().all(|place| place[1] > 0));
    let left: Vec<&[i32; 4]> = system.places.iter().filter(|p| p[0] == 0).collect();
    assert_eq!(left.len(), 4, "rows 1 to 4 carry soil");
    assert!(left.iter().all(|place| place[3] == 1));
}

#[test]
fn systems_of_every_stage_are_those_that_were_solved() {
    let folders = [
        (folder("von-mises", VON_MISES), true),
        (folder("mohr-coulomb", MOHR_COULOMB), false),
    ];
    for (folder, symmetric) in &folders {
        let output = export(folder, &[]);
        succeeds(&output);
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(text.contains("\nlinear systems in systems\n"), "{text}");
        for (number, stage) in [(1, "own weight"), (2, "fill")] {
            let path = folder.join(format!("systems/stage-{number:02}"));
            let system = LinearSystem::read(&path).unwrap();
            let about = &system.about;
            assert_eq!((about.stage_number, about.stage.as_str()), (number, stage));
            assert_eq!((about.step, about.correction), (2, 2));
            hold(&system, *symmetric);
        }
    }
    let import = ["-c", "import numpy, scipy.sparse.linalg"];
    let found = Command::new("python3").args(import).output();
    if !found.is_ok_and(|output| output.status.success()) {
        println!("skipped: python3 cannot import numpy and scipy");
        return;
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/vtk/linear_systems.py");
    for (folder, _) in &folders {
        let output = Command::new("python3").arg(&script).arg(folder).output();
        let output = output.unwrap();
        succeeds(&output);
        assert_eq!(String::from_utf8_lossy(&output.stdout).lines().count(), 2);
    }
}

#[test]
fn results_do_not_change() {
    let folder = folder("same", VON_MISES);
    succeeds(&export(&folder, &[]));
    succeeds(&igimp(&folder, &["run", "case.toml", "--out", "plain"]));
    let read = |path: &str| fs::read_to_string(folder.join(path)).unwrap();
    assert_eq!(
        read("results/convergence.csv"),
        read("plain/convergence.csv")
    );
}

#[test]
fn a_later_run_replaces_its_stages_and_nothing_else() {
    let folder = folder("again", VON_MISES);
    let out = ["--out", "results"];
    // The systems may be within the results.
    let systems = ["--export-matrix", "results/systems"];
    let words = [&["run", "case.toml"][..], &out, &systems].concat();
    succeeds(&igimp(&folder, &words));
    let path = folder.join("results/systems");
    let first = path.join("stage-01/matrix.json");
    let second = path.join("stage-02/matrix.json");
    fs::write(path.join("stage-01/notes.txt"), "the user's").unwrap();
    fs::remove_file(path.join("stage-02/values.npy")).unwrap();
    fs::write(&first, "as it was").unwrap();
    succeeds(&igimp(
        &folder,
        &[&words[..], &["--from-stage", "fill"]].concat(),
    ));
    assert_eq!(fs::read_to_string(&first).unwrap(), "as it was");
    assert!(LinearSystem::read(second.parent().unwrap()).is_ok());
    // One stage: the system of the second must not stay.
    let text = fs::read_to_string(folder.join("case.toml")).unwrap();
    let (before, after) = text.split_once("[[stages]]\nname = \"fill\"").unwrap();
    let output = &after[after.find("[output]").unwrap()..];
    fs::write(folder.join("case.toml"), format!("{before}{output}")).unwrap();
    succeeds(&igimp(&folder, &words));
    assert!(LinearSystem::read(first.parent().unwrap()).is_ok());
    assert!(path.join("stage-01/notes.txt").exists());
    assert!(!path.join("stage-02").exists());
}

#[test]
fn folders_that_cannot_be_used_are_named_before_the_run() {
    let folder = folder("refused", VON_MISES);
    succeeds(&igimp(&folder, &["run", "case.toml"]));
    let summary = fs::read_to_string(folder.join("results/summary.json")).unwrap();
    fs::create_dir(folder.join("systems")).unwrap();
    fs::write(folder.join("systems/notes.txt"), "the user's").unwrap();
    let output = export(&folder, &[]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(
        String::from_utf8_lossy(&output.stderr),
        "error: systems is not empty and was not written by igimp; choose another folder for the \
         results\n"
    );
    let kept = fs::read_to_string(folder.join("results/summary.json")).unwrap();
    assert_eq!(kept, summary, "earlier results stay");
    fs::remove_dir_all(folder.join("systems")).unwrap();
    fs::write(folder.join("systems"), "a file").unwrap();
    let output = export(&folder, &[]);
    assert_eq!(output.status.code(), Some(4));
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(text.starts_with("error: cannot access systems"), "{text}");
}

#[test]
fn files_that_contradict_each_other_are_refused() {
    let folder = folder("contradiction", VON_MISES);
    succeeds(&export(&folder, &[]));
    let path = folder.join("systems/stage-01");
    let system = LinearSystem::read(&path).unwrap();
    let mut cut = system.clone();
    cut.values.pop();
    assert!(cut.matrix().is_err());
    let mut outside = system.clone();
    outside.row_idx[3] = i32::MAX;
    assert!(outside.matrix().is_err());
    let mut starts = system.clone();
    starts.col_ptr[1] = u64::MAX;
    assert!(starts.matrix().is_err());
    let values = Values::I32(vec![1; system.about.stored]);
    let array = Array::new(&[system.about.stored], values);
    array.write(&path.join("values.npy")).unwrap();
    let error = LinearSystem::read(&path).unwrap_err().to_string();
    assert!(
        error.ends_with("its numbers are of another type"),
        "{error}"
    );
    fs::write(path.join("matrix.json"), "{}").unwrap();
    let error = LinearSystem::read(&path).unwrap_err().to_string();
    assert!(error.contains("missing field"), "{error}");
}

/// GOAL: a search along the path of equilibria and a limit load have their systems written too.
/// ORACLE: K x = b of the system of each stage, whose step is the last of the path.
#[test]
fn paths_of_equilibria_have_their_systems_written() {
    let folder = folder("paths", MOHR_COULOMB);
    let path = folder.join("case.toml");
    let text = fs::read_to_string(&path).unwrap();
    let load = "name = \"fill\"\ntype = \"load\"\nloads = [\"fill\"]\nsteps = 2\n";
    let search = "name = \"safety\"\ntype = \"strength-reduction\"\n";
    assert!(text.contains(load));
    fs::write(&path, text.replace(load, search)).unwrap();
    succeeds(&export(&folder, &[]));
    let system = LinearSystem::read(&folder.join("systems/stage-02")).unwrap();
    assert_eq!(system.about.stage, "safety");
    assert!(system.about.step > 2, "{}", system.about.step);
    hold(&system, false);
}
