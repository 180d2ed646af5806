//! A scan of the source text: no leftovers anywhere, no printing and no files in the method.

use std::fs;
use std::path::{Path, PathBuf};

use super::layers::BELOW_CASES;
use crate::failure::Failure;
use crate::metadata::Metadata;

/// Marks of unfinished work, as whole words; in two parts so that this file passes.
const LEFTOVERS: [&str; 2] = [concat!("TO", "DO"), concat!("FIX", "ME")];

/// Names that are no nouns of the field, with what to write (`CONTRIBUTING.md`, "Words"); in two parts so that this file passes.
const RETIRED: [(&str, &str); 14] = [
    (concat!("Ta", "ken"), "AcceptedStep, or what was measured"),
    (concat!("Swal", "lowed"), "Penetration"),
    (concat!("Up", "on"), "Surroundings"),
    (concat!("Ba", "sics"), "GridAndBodies"),
    (concat!("Wi", "sh"), "WantedLines"),
    (concat!("put_", "back"), "push_out"),
    (concat!("clear_", "of"), "resolve_overlap"),
    (concat!("let_", "go"), "release"),
    (concat!("work", "shop"), "scratch"),
    (concat!("tell", "ing"), "narration"),
    (concat!("o", "wn"), "the noun of the value"),
    (concat!("to", "ld"), "text, warnings or what is printed"),
    (concat!("w", "ho"), "the noun of the subject"),
    (concat!("sa", "id"), "text, or the noun of the value"),
];

/// The mark of a test that is not run.
const IGNORED_TEST: &str = concat!("#[", "ignore");

/// Output that the crates below the cases leave to the cases.
const OUTPUT: [&str; 7] = [
    "println!", "print!", "dbg!", "std::fs", "std::io", "fs::", "io::",
];

/// Problems with the sources.
pub(super) fn check(metadata: &Metadata, root: &Path) -> Result<Vec<String>, Failure> {
    let mut problems = Vec::new();
    for member in metadata.members() {
        let mut files = Vec::new();
        rust_files(&member.folder, &mut files)?;
        files.sort();
        let is_method = BELOW_CASES.contains(&member.name.as_str());
        for file in files {
            let text = fs::read_to_string(&file).map_err(|error| {
                Failure::input_output(format!("cannot read {}", file.display()), error)
            })?;
            let silent = is_method && file.starts_with(member.folder.join("src"));
            let shown = file.strip_prefix(root).unwrap_or(&file).display();
            for (line, problem) in scan(&text, silent) {
                problems.push(format!("{shown}:{line}: {problem}"));
            }
        }
    }
    Ok(problems)
}

/// The one file that may hold `unsafe`.
const FOREIGN: &str = "mpi/src/foreign.rs";

/// `unsafe` outside the one file that calls foreign functions, and there without its reason.
pub(super) fn unsafe_blocks(root: &Path) -> Result<Vec<String>, Failure> {
    let mut files = Vec::new();
    for folder in [
        "crates",
        "mpi",
        "python",
        "validation",
        "benchmarks",
        "fuzz",
        "xtask",
    ] {
        rust_files(&root.join(folder), &mut files)?;
    }
    files.sort();
    let mut problems = Vec::new();
    for file in files {
        let text = fs::read_to_string(&file).map_err(|error| {
            Failure::input_output(format!("cannot read {}", file.display()), error)
        })?;
        let shown = file.strip_prefix(root).unwrap_or(&file);
        for (line, problem) in scan_unsafe(&text, shown == Path::new(FOREIGN)) {
            problems.push(format!("{}:{line}: {problem}", shown.display()));
        }
    }
    Ok(problems)
}

/// Lines that open an `unsafe` block where none may be, or without a comment that says why it is sound.
fn scan_unsafe(text: &str, is_allowed: bool) -> Vec<(usize, &'static str)> {
    let opens = concat!("un", "safe {");
    let lines: Vec<&str> = text.lines().collect();
    let mut problems = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        let code = line.split("//").next().unwrap_or(line);
        if !code.contains(opens) {
            continue;
        }
        let above = lines[index.saturating_sub(4)..index].iter();
        if !is_allowed {
            problems.push((
                index + 1,
                "unsafe has its place in mpi/src/foreign.rs alone",
            ));
        } else if !above.clone().any(|line| line.contains("// SAFETY:")) {
            problems.push((index + 1, "unsafe without its reason"));
        }
    }
    problems
}

/// Collects the `.rs` files below a folder, build output excepted.
pub(super) fn rust_files(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), Failure> {
    let failure = |error| Failure::input_output(format!("cannot read {}", folder.display()), error);
    for entry in fs::read_dir(folder).map_err(failure)? {
        let path = entry.map_err(failure)?.path();
        if path.is_dir() && !path.ends_with("target") {
            rust_files(&path, files)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    Ok(())
}

/// Line numbers and problems of a source text; a `silent` one neither prints nor touches files,
/// except in comments.
fn scan(text: &str, silent: bool) -> Vec<(usize, String)> {
    let mut problems = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let mut words = line.split(|c: char| !c.is_alphanumeric() && c != '_');
        if let Some(word) = words.find(|word| LEFTOVERS.contains(word)) {
            problems.push((index + 1, format!("`{word}`: finish it or file an issue")));
        }
        if line.contains(IGNORED_TEST) {
            problems.push((index + 1, "a test that is not run".to_owned()));
        }
        let is_comment = line.trim_start().starts_with("//");
        let code = line.split("//").next().unwrap_or(line);
        let mut names = code.split(|c: char| !c.is_alphanumeric() && c != '_');
        let retired = |name: &str| RETIRED.iter().find(|(retired, _)| *retired == name);
        // Texts in quotes may use the word.
        if let Some((name, instead)) = names.find_map(retired).filter(|_| !code.contains('"')) {
            problems.push((index + 1, format!("`{name}`: the name is `{instead}`")));
        }
        let output = OUTPUT.iter().find(|output| line.contains(**output));
        if let Some(output) = output.filter(|_| silent && !is_comment) {
            problems.push((
                index + 1,
                format!("`{output}` has no place below igimp-cases"),
            ));
        }
    }
    problems
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unsafe_has_its_place_and_its_reason() {
        let call = concat!("let a = un", "safe { f() };");
        assert_eq!(scan_unsafe(call, false).len(), 1);
        assert_eq!(scan_unsafe(call, true).len(), 1);
        assert!(scan_unsafe(&format!("// SAFETY: f does nothing.\n{call}"), true).is_empty());
    }

    #[test]
    fn leftovers_are_found_as_whole_words() {
        for leftover in LEFTOVERS {
            assert_eq!(
                scan(&format!("let a = 1; // {leftover}: more"), false).len(),
                1
            );
            assert!(scan(&format!("let {leftover}_LIST = 1;"), false).is_empty());
        }
        for rest in ["]", " = \"slow\"]"] {
            assert_eq!(scan(&format!("\n    {IGNORED_TEST}{rest}"), false)[0].0, 2);
        }
    }

    #[test]
    fn retired_names_are_found_in_code_alone() {
        for (name, instead) in RETIRED {
            let found = scan(&format!("    let {name} = 1;"), false);
            assert!(found[0].1.contains(instead), "{found:?}");
            assert!(scan(&format!("/// {name}"), false).is_empty());
            assert!(scan(&format!("    say(\"{name}\");"), false).is_empty());
            assert!(scan(&format!("let {name}s = 1;"), false).is_empty());
        }
    }

    #[test]
    fn output_is_found_outside_comments() {
        assert_eq!(scan("    println!(\"x\");", true).len(), 1);
        assert_eq!(scan("use std::fs;", true).len(), 1);
        assert_eq!(scan("eprint!(\"x\");", true).len(), 1);
        assert!(scan("    println!(\"x\");", false).is_empty());
        assert!(scan("/// println!(\"x\");", true).is_empty());
    }
}
