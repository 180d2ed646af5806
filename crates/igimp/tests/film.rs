//! GOAL: `igimp film` makes a film of the frames of a results folder, and says why where it cannot.
//! ORACLE: the format of GIF; the frames of the case.

use std::path::PathBuf;
use std::process::{Command, Output};

/// A folder of its own for a test, gone when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("igimp-film-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn igimp(&self, words: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_igimp"));
        command.args(words).current_dir(&self.0).output().unwrap()
    }

    /// Runs a shipped case into `results`.
    fn run(&self, case: &str, settings: &[&str]) {
        let text = self.igimp(&["new", case]).stdout;
        std::fs::write(self.0.join("case.toml"), text).unwrap();
        let mut words = vec![
            "run",
            "case.toml",
            "--quiet",
            "--overwrite",
            "--out",
            "results",
        ];
        words.extend(settings.iter().flat_map(|setting| ["--set", setting]));
        let run = self.igimp(&words);
        let printed = String::from_utf8_lossy(&run.stderr).into_owned();
        assert!(run.status.success(), "{printed}");
    }

    /// The exit code and the message of a film.
    fn refusal(&self, more: &[&str]) -> (Option<i32>, String) {
        let output = self.igimp(&[&["film", "results"], more].concat());
        let printed = String::from_utf8(output.stderr).unwrap();
        (output.status.code(), printed)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Times that the frames of a GIF stay \[1/100 s\]: its blocks of graphic control.
fn stays(gif: &[u8]) -> Vec<u16> {
    let mut times = Vec::new();
    for block in gif.windows(8) {
        if block[..3] == [0x21, 0xf9, 0x04] && block[7] == 0 {
            times.push(u16::from_le_bytes([block[4], block[5]]));
        }
    }
    times
}

/// GOAL: a motion is shown from its first state on, at its pace.
/// ORACLE: five parts of 0.1 s, ten times slower: 0.2 s each, and the last frame stays two seconds.
#[test]
fn a_motion_makes_a_film() {
    let folder = Folder::new("motion");
    let short = [
        "grid.cell=2 cm",
        "stages.collapse.duration=0.1 s",
        "stages.collapse.steps=5",
    ];
    folder.run("column_collapse", &short);
    // Its effort was said before.
    let settings = short.iter().flat_map(|setting| ["--set", setting]);
    let check: Vec<&str> = ["check", "case.toml"].into_iter().chain(settings).collect();
    let printed = String::from_utf8(folder.igimp(&check).stdout).unwrap();
    assert!(
        printed.contains("up to 7, about 5 MiB in paraview/"),
        "{printed}"
    );
    let film = folder.igimp(&["film", "results", "--pace", "0.1", "--width", "320"]);
    let printed = String::from_utf8(film.stdout).unwrap();
    assert!(film.status.success(), "{printed}");
    assert!(
        printed.contains("film-speed.gif: 6 frames, 3 s, pace 0.1, "),
        "{printed}"
    );
    let gif = std::fs::read(folder.0.join("results/figures/film-speed.gif")).unwrap();
    assert!(gif.starts_with(b"GIF89a") && gif.ends_with(&[0x3b]));
    assert_eq!(gif[6..8], 320_u16.to_le_bytes());
    assert_eq!(stays(&gif), [20, 20, 20, 20, 20, 200]);
    // The same film again, elsewhere, of another field.
    let words = ["film", "results", "--field", "sigma_yy", "--out", "own.gif"];
    assert!(folder.igimp(&words).status.success());
    assert!(folder.0.join("own.gif").is_file());
    insta::assert_snapshot!(folder.refusal(&["--stage", "slide"]).1, @r#"
    error: the case has no stage "slide"
      help: its stages are "collapse"
    "#);
    let (code, printed) = folder.refusal(&["--field", "speeed"]);
    assert_eq!(code, Some(2));
    assert!(
        printed.contains("there is no field speeed") && printed.contains("velocity_y"),
        "{printed}"
    );
    assert!(!printed.contains("velocity_z"), "{printed}");
}

/// GOAL: a run without motion has a film of its frames, with no key for it, and no speed; a key keeps the ends of stages alone.
#[test]
fn a_run_at_rest_makes_a_film() {
    let folder = Folder::new("rest");
    folder.run("column", &[]);
    let film = folder.igimp(&["film", "results", "--width", "320"]);
    let printed = String::from_utf8(film.stdout).unwrap();
    assert!(printed.contains("film-displacement.gif: "), "{printed}");
    assert!(!printed.contains("pace"), "{printed}");
    let collection = folder.0.join("results/paraview/particles.pvd");
    let frames = std::fs::read_to_string(collection).unwrap();
    let count = frames.matches("<DataSet").count();
    assert!((10..=41).contains(&count), "{count}");
    assert!(printed.contains(&format!(" {count} frames")), "{printed}");
    assert!(!folder.0.join("results/paraview/stage-01.pvd").exists());
    let text = std::fs::read_to_string(folder.0.join("results/paraview/particles_0001.vtu"));
    assert!(!text.unwrap().contains("velocity"));
    insta::assert_snapshot!(folder.refusal(&["--field", "speed"]).1, @r"
    error: there is no film: its frames have no speed
    ");
    std::fs::remove_dir_all(folder.0.join("results/paraview")).unwrap();
    insta::assert_snapshot!(folder.refusal(&[]).1, @r#"
    error: there is no film: the folder has fewer than two frames of it; paraview = { every = "film" } in [output] writes some tens
    "#);
}

/// GOAL: fields of motion are refused where nothing moves in time.
#[test]
fn fields_of_motion_need_a_motion() {
    let folder = Folder::new("refused");
    let text = folder.igimp(&["new", "column"]).stdout;
    std::fs::write(folder.0.join("case.toml"), text).unwrap();
    let words = ["check", "case.toml", "--set", "output.figures=[\"speed\"]"];
    let output = folder.igimp(&words);
    assert_eq!(output.status.code(), Some(2));
    let printed = String::from_utf8(output.stderr).unwrap();
    assert!(
        printed.contains("nothing here has a field speed"),
        "{printed}"
    );
    assert!(printed.contains("a stage of type \"dynamic\""), "{printed}");
}
