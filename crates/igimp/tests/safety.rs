//! GOAL: the text of a file never commands a terminal or a spreadsheet, input is bounded, and memory
//! that cannot be had is named in words.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

/// A block under its own weight; a title, a name of a check and a source as given.
fn block(title: &str, source: &str) -> String {
    format!(
        "igimp = 1\n[case]\ntitle = \"{title}\"\ngravity = \"9.81 m/s2\"\n\
        [grid]\ncell = \"0.5 m\"\ndomain = {{ x = [\"0 m\", \"2 m\"], y = [\"0 m\", \"4 m\"] }}\n\
        [materials.clay]\nmodel = \"elastic\"\nunit_weight = \"18 kN/m3\"\n\
        young = \"10 MPa\"\npoisson = 0.0\n\
        [[bodies]]\nname = \"block\"\nmaterial = \"clay\"\npoints_per_cell = 4\n\
        polygon = [[\"0 m\", \"0 m\"], [\"2 m\", \"0 m\"], [\"2 m\", \"2 m\"], \
        [\"0 m\", \"2 m\"]]\n\
        [boundaries]\nleft = \"roller\"\nright = \"roller\"\nbottom = \"fixed\"\n\
        [[stages]]\nname = \"+1 own weight\"\ntype = \"gravity\"\nsteps = 3\n\
        [[monitors]]\nname = \"top\"\npoint = [\"1 m\", \"2 m\"]\nrecord = [\"displacement\"]\n\
        [[checks]]\nname = \"settlement\"\nof = \"top.displacement\"\n\
        divide_by = [\"1 mm\"]\nexpected = 3.6\ntolerance = 0.2\nsource = \"{source}\"\n\
        [output]\nfolder = \"results\"\nfigures = []\nreport = false\n"
    )
}

/// A folder of its own for a test, gone when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str, case: &str) -> Self {
        let path = std::env::temp_dir().join(format!("igimp-safety-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        fs::write(path.join("case.toml"), case).unwrap();
        Self(path)
    }

    fn igimp(&self, words: &[&str]) -> Output {
        self.igimp_with(words, Stdio::null())
    }

    fn igimp_with(&self, words: &[&str], input: Stdio) -> Output {
        Command::new(env!("CARGO_BIN_EXE_igimp"))
            .args(words)
            .current_dir(&self.0)
            .stdin(input)
            .output()
            .unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// All that was said.
fn printed(output: &Output) -> String {
    let both = [&output.stdout[..], &output.stderr].concat();
    String::from_utf8(both).unwrap()
}

/// Escapes, control characters of both kinds, and characters that turn the direction of writing.
const ODD: &str = "a\\u001b[2J\\u0007\\u009b\\u202eb\\u2066\\u200f\\u2028c\\nerror: d";

#[test]
fn no_text_of_a_file_commands_the_terminal() {
    let folder = Folder::new("terminal", &block(ODD, ODD));
    let raw = "a\u{1b}[2J\u{7}\u{9b}\u{202e}b\u{2066}\u{200f}";
    // Unknown keys and comments with the characters themselves: the lines of errors show them.
    let wrong = block("x", "y").replace("poisson", &format!("\"{raw}\"")) + "# " + raw;
    fs::write(folder.0.join("wrong.toml"), wrong).unwrap();
    fs::write(folder.0.join("syntax.toml"), format!("igimp = {raw}\n")).unwrap();
    let sweep = format!(
        "igimp_sweep = 1\ncase = \"case.toml\"\n[parameters]\ncase.title = [\"{ODD}\", \"=x\"]\n\
         [output]\nfolder = \"sweep\"\n"
    );
    fs::write(folder.0.join("sweep.toml"), &sweep).unwrap();
    let bad_sweep = sweep
        .replace("combine", "c")
        .replace("[output]", &format!("[output] # {raw}\nx = 1"));
    fs::write(folder.0.join("bad-sweep.toml"), bad_sweep).unwrap();
    let odd_words = format!("--{raw}");
    let odd_out = format!("results-{raw}");
    let odd_set = format!("{raw}=1");
    for words in [
        &["explain", "case.toml"][..],
        &["check", "case.toml"],
        &["run", "case.toml"],
        &["run", "case.toml", "--quiet"],
        &["run", "case.toml", "--out", &odd_out],
        &[
            "run",
            "case.toml",
            "--out",
            &odd_out,
            "--set",
            "case.title=other",
        ],
        &["run", "case.toml", "--set", &odd_set],
        &["run", "case.toml", "--meshes", "2", "--out", "meshes"],
        &["check", "wrong.toml"],
        &["check", "syntax.toml"],
        &["check", raw],
        &["report", "results"],
        &["sweep", "sweep.toml", "--list"],
        &["sweep", "sweep.toml"],
        &["sweep", "bad-sweep.toml"],
        &["collect", "sweep.toml"],
        &["new", raw],
        &["run", &odd_words],
    ] {
        let output = folder.igimp(words);
        let printed = printed(&output);
        assert!(!printed.is_empty(), "{words:?}");
        let is_odd = |c: char| {
            (c.is_control() && c != '\n') || "\u{202e}\u{2066}\u{200f}\u{2028}".contains(c)
        };
        let odd: Vec<char> = printed.chars().filter(|&c| is_odd(c)).collect();
        assert!(odd.is_empty(), "{words:?}: {odd:?} in {printed}");
        assert!(!printed.contains("\nerror: d"), "{words:?}: {printed}");
    }
    // The output is a case file again, with the title that it has.
    let explained = printed(&folder.igimp(&["explain", "case.toml"]));
    assert!(
        explained.contains("\\u202Eb\\u2066\\u200F\\u2028c\\nerror: d"),
        "{explained}"
    );
}

#[test]
fn no_cell_of_a_table_is_a_formula() {
    let folder = Folder::new("cells", &block("block", "by hand"));
    let sweep = "igimp_sweep = 1\ncase = \"case.toml\"\n[parameters]\n\
        case.title = [\"=cmd()\", \"@x\"]\nmaterials.clay.poisson = [0.0, 0.1]\n\
        combine = \"zip\"\n[output]\nfolder = \"sweep\"\n"
        .replace("combine = \"zip\"\n", "")
        .replace("[parameters]", "combine = \"zip\"\n[parameters]");
    fs::write(folder.0.join("sweep.toml"), sweep).unwrap();
    let output = folder.igimp(&["sweep", "sweep.toml"]);
    assert!(
        matches!(output.status.code(), Some(0 | 1)),
        "{}",
        printed(&output)
    );
    let table = fs::read_to_string(folder.0.join("sweep/results.csv")).unwrap();
    let rows: Vec<&str> = table.lines().collect();
    assert!(
        rows[0].starts_with("task,case.title,materials.clay.poisson,end"),
        "{table}"
    );
    assert!(rows[1].starts_with("1,'=cmd(),0,"), "{table}");
    assert!(rows[2].starts_with("2,'@x,0.1,"), "{table}");
    let steps = fs::read_to_string(folder.0.join("sweep/task-0001/convergence.csv")).unwrap();
    assert!(
        steps
            .lines()
            .skip(1)
            .all(|line| line.starts_with("'+1 own weight,")),
        "{steps}"
    );
}

#[cfg(unix)]
#[test]
fn whatever_is_named_as_a_case_is_read_to_a_bound() {
    let folder = Folder::new("bounds", &block("block", "by hand"));
    let pipe = folder.0.join("pipe");
    assert!(
        Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    let large = fs::File::create(folder.0.join("large.toml")).unwrap();
    large.set_len(3 << 30).unwrap();
    let reference = block("block", "by hand")
        + "[[curves]]\nname = \"c\"\nx = \"top.displacement\"\ny = \"load_factor\"\n\
           reference = { points_file = \"pipe\", label = \"l\" }\n";
    fs::write(folder.0.join("reference.toml"), reference).unwrap();
    for (words, code, part) in [
        (&["check", "/dev/zero"][..], 4, "because: it is no file"),
        (&["check", "pipe"], 4, "because: it is no file"),
        (&["run", "."], 4, "because: it is a folder"),
        (&["check", "large.toml"], 2, "this file has more than 8 MB"),
        (&["sweep", "/dev/zero"], 4, "because: it is no file"),
        (
            &["sweep", "large.toml"],
            4,
            "because: it has more than 8 MB",
        ),
        (&["run", "--task", "1", "pipe"], 4, "because: it is no file"),
    ] {
        let output = folder.igimp(words);
        assert_eq!(
            output.status.code(),
            Some(code),
            "{words:?}: {}",
            printed(&output)
        );
        assert!(
            printed(&output).contains(part),
            "{words:?}: {}",
            printed(&output)
        );
    }
    let output = folder.igimp(&["check", "reference.toml"]);
    assert_eq!(output.status.code(), Some(2), "{}", printed(&output));
    let zeros = fs::File::open("/dev/zero").unwrap();
    let output = folder.igimp_with(&["check", "-"], zeros.into());
    assert_eq!(output.status.code(), Some(2), "{}", printed(&output));
    assert!(
        printed(&output).contains("more than 8 MB"),
        "{}",
        printed(&output)
    );
}

#[test]
fn a_case_comes_from_standard_input() {
    let folder = Folder::new("stdin", &block("block", "by hand"));
    let run = |title: &str| {
        fs::write(folder.0.join("piped.toml"), block(title, "by hand")).unwrap();
        let input = fs::File::open(folder.0.join("piped.toml")).unwrap();
        folder.igimp_with(&["run", "-", "--set", "output.folder=piped"], input.into())
    };
    for _ in 0..2 {
        let output = run("one");
        assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
        assert!(folder.0.join("piped/summary.json").exists());
    }
    let output = run("another");
    assert_eq!(output.status.code(), Some(2), "{}", printed(&output));
    assert!(
        printed(&output).contains("another input, <stdin: one>"),
        "{}",
        printed(&output)
    );
    fs::write(folder.0.join("piped.toml"), "igimp = 1\nx = ").unwrap();
    let input = fs::File::open(folder.0.join("piped.toml")).unwrap();
    let output = folder.igimp_with(&["check", "-"], input.into());
    assert!(
        printed(&output).contains("--> stdin:2:"),
        "{}",
        printed(&output)
    );
}

#[test]
fn symbols_of_books_are_known() {
    let folder = Folder::new("symbols", &block("block", "by hand"));
    let soil = "[materials.clay]\nmodel = \"mohr-coulomb\"\ngamma = \"18 kN/m3\"\nE = \"10 MPa\"\n\
        nu = 0.3\nc = \"5 kPa\"\nphi = \"20 deg\"\npsi = \"0 deg\"\n";
    let case = block("block", "by hand");
    let (start, end) = (
        case.find("[materials.clay]").unwrap(),
        case.find("[[bodies]]").unwrap(),
    );
    let case = format!("{}{soil}{}", &case[..start], &case[end..]);
    fs::write(folder.0.join("symbols.toml"), case).unwrap();
    let output = folder.igimp(&["check", "symbols.toml"]);
    assert_eq!(output.status.code(), Some(2));
    let printed = printed(&output);
    for (symbol, key) in [
        ("gamma", "unit_weight"),
        ("E", "young"),
        ("nu", "poisson"),
        ("c", "cohesion"),
        ("phi", "friction"),
        ("psi", "dilation"),
    ] {
        let (_, rest) = printed
            .split_once(&format!("unknown field `{symbol}`"))
            .unwrap();
        let help = rest.lines().find(|line| line.contains("help")).unwrap();
        assert!(
            help.ends_with(&format!("did you mean `{key}`?")),
            "{printed}"
        );
    }
    // A field that was meant is not missing as well.
    assert!(printed.ends_with("6 errors in symbols.toml\n"), "{printed}");
}

/// A limit of the address space that the run cannot keep is named before it begins.
#[cfg(target_os = "linux")]
#[test]
fn memory_that_cannot_be_had_is_named() {
    let folder = Folder::new("memory", &block("block", "by hand"));
    let script =
        "ulimit -v 1000000; exec \"$0\" run case.toml --threads 1 --set 'grid.cell=0.002 m'";
    let output = Command::new("sh")
        .args(["-c", script, env!("CARGO_BIN_EXE_igimp")])
        .current_dir(&folder.0)
        .output()
        .unwrap();
    let printed = printed(&output);
    assert_eq!(output.status.code(), Some(4), "{printed}");
    assert!(
        printed.starts_with("error: the run is thought to need "),
        "{printed}"
    );
    assert!(
        printed.contains("the limit of the address space (ulimit -v)"),
        "{printed}"
    );
    assert!(!folder.0.join("results").exists());
}

/// A checkpoint that is damaged is named, and the remedy.
#[test]
fn a_damaged_checkpoint_is_named() {
    let folder = Folder::new("damaged", &block("block", "by hand"));
    let words = [
        "run",
        "case.toml",
        "--quiet",
        "--set",
        "output.checkpoint={ every = 1, keep = 3 }",
    ];
    let output = folder.igimp(&words);
    assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
    let checkpoints = folder.0.join("results/checkpoint");
    let damage = |name: &str| fs::write(checkpoints.join(name).join("current/x.npy"), "x").unwrap();
    damage("stage-01-end");
    let resumed: Vec<&str> = words
        .iter()
        .copied()
        .filter(|word| *word != "--quiet")
        .collect();
    let output = folder.igimp(&[&resumed[..], &["--resume"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
    let text = printed(&output);
    let start =
        "warning: the checkpoint in results/checkpoint/stage-01-end is damaged: current/x.npy: ";
    assert!(text.contains(start), "{text}");
    assert!(text.contains("; the run goes on from step-"), "{text}");
    for entry in fs::read_dir(&checkpoints).unwrap() {
        damage(entry.unwrap().file_name().to_str().unwrap());
    }
    let output = folder.igimp(&[&words[..], &["--resume"]].concat());
    assert_eq!(output.status.code(), Some(2), "{}", printed(&output));
    let text = printed(&output);
    assert!(text.contains("is damaged: current/x.npy"), "{text}");
    let help = "help: without that folder, --resume goes on from the one before it; --overwrite begins afresh";
    assert!(text.contains(help), "{text}");
    let output = folder.igimp(&[&words[..], &["--overwrite"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
}

#[test]
fn without_figures_nothing_is_drawn() {
    let folder = Folder::new("figures", &block("block", "by hand"));
    let output = folder.igimp(&["run", "case.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
    assert_eq!(
        fs::read_dir(folder.0.join("results/figures"))
            .unwrap()
            .count(),
        0
    );
    let output = folder.igimp(&["run", "case.toml", "--meshes", "2", "--out", "meshes"]);
    assert!(
        matches!(output.status.code(), Some(0 | 1)),
        "{}",
        printed(&output)
    );
    for mesh in ["mesh-1", "mesh-2"] {
        let figures = folder.0.join("meshes").join(mesh).join("figures");
        assert_eq!(fs::read_dir(figures).unwrap().count(), 0);
    }
    assert!(!folder.0.join("meshes/figures").exists());
}
