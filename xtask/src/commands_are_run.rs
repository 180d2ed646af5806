//! GOAL: every command of cargo, pip and the benches' `igimp` that README, tour, contributors' and developer page, the page
//! on reviewing and benchmarks/README print is run: as it is, or in a smaller scope that is said here.
//! ORACLE: the lines of `.ci/run`, of the weekly workflow and of tests, which this table quotes.

use std::fs;

use crate::process::root;

/// A printed command, the file that runs it, and the line there.
struct Printed {
    command: &'static str,
    run_by: &'static str,
    line: &'static str,
    /// The part that is smaller there, or other.
    scope: &'static str,
}

const fn printed(
    command: &'static str,
    run_by: &'static str,
    line: &'static str,
    scope: &'static str,
) -> Printed {
    Printed {
        command,
        run_by,
        line,
        scope,
    }
}

const CI: &str = ".ci/run";
const WEEKLY: &str = ".github/workflows/ci.yml";
const REVIEW: &str = "validation/tests/review.rs";
const FILM: &str = "crates/igimp/tests/film.rs";
const CASES: &str = "benchmarks/tests/cases.rs";

#[rustfmt::skip]
const PRINTED: [Printed; 41] = [
    printed("cargo fmt --all --check", CI, "phase cargo fmt --all --check", ""),
    printed("cargo clippy --workspace --all-targets -- -D warnings", CI, "phase cargo clippy --workspace --all-targets -- -D warnings", ""),
    printed("cargo test --workspace", CI, "phase cargo test --workspace", ""),
    printed("cargo install --locked --path crates/igimp", CI, "phase cargo install --locked --path crates/igimp --root target/installed --debug", "into a folder of its own, not in release mode"),
    printed("pip install ./python", CI, "phase cargo xtask python", "builds the package as a wheel and installs that with pip"),
    printed("cargo xtask doc", CI, "cargo xtask doc", ""),
    printed("cargo xtask doc --open", CI, "cargo xtask doc", "no browser"),
    printed("cargo xtask book", CI, "phase cargo xtask book", ""),
    printed("cargo xtask book --open", CI, "phase cargo xtask book", "no browser"),
    printed("cargo xtask tidy", CI, "phase cargo xtask tidy", ""),
    printed("cargo xtask python", CI, "phase cargo xtask python", ""),
    printed("cargo xtask mpi", CI, "phase cargo xtask mpi", "where PETSc and MPI are"),
    printed("cargo xtask film", FILM, "\"film\", \"results\", \"--pace\"", "the command that it draws with, on a coarse grid"),
    printed("cargo xtask fuzz", WEEKLY, "- run: cargo xtask fuzz", "once a week; on every change fuzz/tests/bounded.rs, with some ten thousand executions"),
    printed("cargo xtask campaign", CI, "phase cargo xtask campaign bodies --scenes 2", "two scenes for all parts"),
    printed("cargo xtask validate", WEEKLY, "- run: cargo xtask validate", "once a week; on every change with --quick"),
    printed("cargo xtask validate --quick", CI, "cargo xtask validate --quick", ""),
    printed("cargo xtask validate --case NAME", REVIEW, "\"--case\"", "the column"),
    printed("cargo xtask validate --accept", REVIEW, "&[\"--accept\"]", "the column, on a copy of the snapshots"),
    printed("cargo xtask validate --accept-left", REVIEW, "&[\"--accept-left\"]", "on a copy of the snapshots"),
    printed("cargo xtask validate --full --matrix", CI, "cargo xtask validate --quick", "holds its rows against the matrix; what is written is tried in matrix.rs"),
    printed("cargo install cargo-insta", CI, "cargo install --quiet --debug --locked cargo-insta", "into a folder of its own"),
    printed("cargo insta review", REVIEW, "insta(\"review\")", "in a clone of the workspace"),
    printed("cargo insta accept", REVIEW, "insta(\"accept\")", "in a clone of the workspace"),
    printed("cargo test -p igimp-cases -p igimp", CI, "phase cargo test --workspace", "the same tests, nothing accepted"),
    printed("cargo test -p igimp --test book", CI, "phase cargo test --workspace", "the same tests, nothing accepted"),
    printed("cargo test -p igimp-cases -p igimp --test input --test book", CI, "phase cargo test --workspace", "the same tests, nothing accepted"),
    printed("cargo xtask bench", CI, "phase cargo xtask bench --quick assembly", "one program short, the others with --test"),
    printed("cargo xtask bench --quick", CI, "phase cargo xtask bench --quick assembly", "one program, the others with --test"),
    printed("cargo xtask bench assembly", CI, "phase cargo xtask bench --quick assembly", "short"),
    printed("cargo xtask bench survey", CI, "phase cargo xtask bench --quick survey/cost", "one part, short"),
    printed("cargo xtask bench survey/cost", CI, "phase cargo xtask bench --quick survey/cost", "short"),
    printed("cargo xtask bench --threads 4", CI, "--threads 2", "the threads that are there"),
    printed("cargo xtask bench --save before", CI, "--save here", "short"),
    printed("cargo xtask bench --against before", CI, "--against here", "short"),
    printed("cargo bench -p igimp-benchmarks -- --test", CI, "-p igimp-benchmarks --bench '*' -- --test", "together with the programs, so that nothing is compiled twice"),
    printed("igimp run --export-matrix", "crates/igimp/tests/export_matrix.rs", "--export-matrix", ""),
    printed("igimp check", CASES, "estimate(&case)", "the estimate that it prints"),
    printed("igimp run benchmarks/cases/million.toml", CASES, "cases/million.toml", "read and estimated, not run"),
    printed("cargo xtask", "xtask/src/commands_on_pages.rs", "try_parse_from", "stands for all its commands"),
    printed("cargo xtask bench --quick assembly", CI, "phase cargo xtask bench --quick assembly", ""),
];

/// The pages that newcomers and developers follow.
const PAGES: [&str; 6] = [
    "README.md",
    "CONTRIBUTING.md",
    "docs/src/tour.md",
    "docs/src/developer.md",
    "docs/src/reviewing.md",
    "benchmarks/README.md",
];

/// The commands of a page in its blocks and in backquotes, without settings in front and comments behind.
fn commands(page: &str, text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut is_block = false;
    for line in text.lines() {
        if line.starts_with("```") {
            is_block = !is_block;
        } else if is_block {
            found.extend(command(page, line));
        } else {
            found.extend(
                line.split('`')
                    .skip(1)
                    .step_by(2)
                    .filter_map(|code| command(page, code)),
            );
        }
    }
    found
}

/// The command that a line of code is, if it is one of those that are looked at here.
fn command(page: &str, code: &str) -> Option<String> {
    let code = code.split(['#', ';', '&', '|']).next()?;
    let is_setting = |word: &&str| word.contains('=') && !word.starts_with('-');
    let words: Vec<&str> = code.split_whitespace().skip_while(is_setting).collect();
    let is_command = match words.first()? {
        &"cargo" | &"pip" => true,
        // On other pages the tests of the program try it.
        &"igimp" => page.starts_with("benchmarks/") && words.len() > 1,
        _ => false,
    };
    is_command.then(|| words.join(" "))
}

#[test]
fn every_command_that_is_printed_is_run() {
    let mut missing = Vec::new();
    let mut seen = [false; PRINTED.len()];
    for page in PAGES {
        let text = fs::read_to_string(root().join(page)).unwrap();
        for command in commands(page, &text) {
            match PRINTED.iter().position(|entry| entry.command == command) {
                Some(place) => seen[place] = true,
                None => missing.push(format!("{page}: `{command}`")),
            }
        }
    }
    assert!(
        missing.is_empty(),
        "not in the table of what is run:\n{}",
        missing.join("\n")
    );
    let idle = PRINTED.iter().zip(seen).filter(|(_, seen)| !seen);
    let idle: Vec<&str> = idle.map(|(entry, _)| entry.command).collect();
    assert!(idle.is_empty(), "in the table, and on no page: {idle:?}");
}

#[test]
fn the_stated_lines_run_their_commands() {
    for Printed {
        command,
        run_by,
        line,
        scope,
    } in &PRINTED
    {
        let text = fs::read_to_string(root().join(run_by)).unwrap();
        assert!(
            text.contains(line),
            "{run_by} has no `{line}`, which runs `{command}`"
        );
        let is_whole = line.contains(command) || *run_by != CI;
        assert!(
            is_whole || !scope.is_empty(),
            "`{command}`: say what is smaller in `{line}`"
        );
    }
}

#[test]
fn commands_are_found_in_blocks_and_in_text() {
    let text = "Run `A=1 cargo test`, `cargo-insta` or\n```sh\ncargo xtask tidy   # checks\nigimp run a.toml\n```\n";
    assert_eq!(
        commands("README.md", text),
        ["cargo test", "cargo xtask tidy"]
    );
    let of_benches = commands("benchmarks/README.md", text);
    assert_eq!(
        of_benches,
        ["cargo test", "cargo xtask tidy", "igimp run a.toml"]
    );
}
