//! Scripts and messages of `--to`.

use std::fs;

use crate::study::{Study, printed};

/// The numbers of threads, memory and time, and the places of this computer, as words.
fn like(text: &str, study: &Study) -> String {
    let here = study.folder.0.canonicalize().unwrap();
    let text = text.replace(&here.display().to_string(), "HERE");
    let text = text.replace(env!("CARGO_BIN_EXE_igimp"), "IGIMP");
    let parts = without_estimates(&text);
    parts.trim_end().to_owned()
}

/// Estimates depend on the computer: `45 s` and `2 min` become `TIME`.
fn without_estimates(text: &str) -> String {
    let mut out = String::new();
    for line in text.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        let mut shown: Vec<String> = Vec::new();
        let mut k = 0;
        while k < words.len() {
            let unit = words.get(k + 1).map_or("", |word| {
                word.trim_end_matches(|letter: char| !letter.is_alphanumeric())
            });
            let is_number = words[k].parse::<f64>().is_ok();
            if is_number && matches!(unit, "s" | "min" | "h") && words[k] != "5" {
                let rest = &words[k + 1][unit.len()..];
                shown.push(format!("TIME{rest}"));
                k += 2;
            } else if let Some(minutes) = words[k].strip_prefix("--time=") {
                assert!(minutes.parse::<u32>().unwrap() >= 6, "{minutes}");
                shown.push("--time=TIME".into());
                k += 1;
            } else {
                shown.push(words[k].to_owned());
                k += 1;
            }
        }
        out += &shown.join(" ");
        out.push('\n');
    }
    out
}

#[test]
fn a_script_of_slurm_holds_the_rest() {
    let study = Study::new("to slurm", [40, 40, 40, 40]);
    let output = study.igimp(&["run", "study.toml", "--task", "3", "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
    let mut command = study.command(&["sweep", "study.toml", "--to", "slurm"]);
    let output = command.env("PATH", "/none").output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
    insta::assert_snapshot!("slurm_said", like(&printed(&output), &study));
    let script = fs::read_to_string(study.path("out/slurm.sh")).unwrap();
    insta::assert_snapshot!("slurm_script", like(&script, &study));
}

/// GOAL: tasks of several ranks are started by Slurm with the program for them, and by nobody else.
#[test]
fn a_script_of_slurm_starts_several_ranks() {
    let study = Study::new("to-ranks", [40, 40, 40, 40]);
    let words = ["sweep", "study.toml", "--ranks", "4", "--to"];
    let output = study.igimp(&[&words[..], &["hyperqueue"]].concat());
    assert_eq!(output.status.code(), Some(2), "{}", printed(&output));
    assert!(printed(&output).contains("only Slurm starts tasks of several ranks"));
    let output = study.igimp(&[&words[..], &["slurm"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
    assert!(printed(&output).contains("each is given 4 ranks of 1 thread, 500 MiB and "));
    let script = fs::read_to_string(study.path("out/slurm.sh")).unwrap();
    for line in [
        "#SBATCH --ntasks=4 --cpus-per-task=1",
        "#SBATCH --mem=500M",
        "#SBATCH --signal=TERM@120",
        "exec srun --mpi=pmix --cpu-bind=none --kill-on-bad-exit=1 ",
        "igimp-mpi run study.toml --task ",
    ] {
        assert!(script.contains(line), "{line}\n{script}");
    }
}

#[test]
fn a_job_file_of_hyperqueue_holds_the_rest() {
    let study = Study::new("to-hq", [40, 40, 40, 40]);
    let words = [
        "sweep",
        "study.toml",
        "--to",
        "hyperqueue",
        "--threads",
        "2",
    ];
    let mut command = study.command(&words);
    let output = command.env("PATH", "/none").output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
    insta::assert_snapshot!("hyperqueue_said", like(&printed(&output), &study));
    let file = fs::read_to_string(study.path("out/hyperqueue.toml")).unwrap();
    let file = file
        .lines()
        .filter(|line| !line.starts_with("time_request"));
    let file = file.collect::<Vec<_>>().join("\n");
    insta::assert_snapshot!("hyperqueue_file", like(&file, &study));
}

#[test]
fn this_computer_needs_no_file() {
    let study = Study::new("to-local", [40, 40, 40, 40]);
    let output = study.igimp(&["sweep", "study.toml", "--to", "local"]);
    assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
    let text = printed(&output);
    assert!(
        text.contains("nothing is written; run them with\n  igimp sweep study.toml --jobs "),
        "{text}"
    );
    assert!(!study.path("out").exists());
    let line = text.lines().last().unwrap().trim();
    let words: Vec<&str> = line.split(' ').skip(1).collect();
    let output = study.igimp(&words);
    assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
    for to in ["slurm", "hyperqueue", "local"] {
        let output = study.igimp(&["sweep", "study.toml", "--to", to]);
        assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
        assert_eq!(
            printed(&output),
            "all 4 tasks are done; igimp collect study.toml gathers them\n"
        );
    }
    assert!(!study.path("out/slurm.sh").exists());
}
