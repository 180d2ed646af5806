//! GOAL: the options of `cargo xtask validate` that pages of the project show are those that there are.
//! ORACLE: the help of the validation program.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn pages() -> Vec<PathBuf> {
    fn collect(folder: &Path, deep: bool, pages: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() && deep {
                collect(&path, deep, pages);
            } else if path.extension().is_some_and(|end| end == "md") {
                pages.push(path);
            }
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut pages = Vec::new();
    collect(&root, false, &mut pages);
    collect(&root.join("docs/src"), true, &mut pages);
    pages
}

#[test]
fn options_on_the_pages_are_in_the_help() {
    let output = Command::new(env!("CARGO_BIN_EXE_igimp-validation"))
        .arg("--help")
        .output()
        .unwrap();
    let help = String::from_utf8_lossy(&output.stdout).into_owned();
    let mut count = 0;
    for page in pages() {
        let text = fs::read_to_string(&page).unwrap();
        for (place, command) in text.match_indices("cargo xtask validate") {
            let rest = &text[place + command.len()..];
            let end = rest.find(['`', '\n', '#']).unwrap_or(rest.len());
            for option in rest[..end]
                .split_whitespace()
                .filter(|word| word.starts_with("--"))
            {
                let known = help
                    .split_whitespace()
                    .any(|word| word.trim_end_matches(',') == option);
                assert!(known, "{}: there is no `{option}`", page.display());
                count += 1;
            }
        }
    }
    assert!(count >= 5, "only {count} options were found");
}
