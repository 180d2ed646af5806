//! The guide's description of a results folder, held against one.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use igimp_results::checkpoint;

use crate::commands::{can_import, folder, has_shell, printed, shell};
use crate::page::root;

/// The slope on cells so large that it runs in a second or two.
const COARSE: &str = "--set 'grid.cell={x=\"5 m\", y=\"2 m\"}' --set checks.0.between=[1,2]";

/// The results of the coarse slope, run once for all tests.
fn slope_results() -> &'static Path {
    static RESULTS: OnceLock<PathBuf> = OnceLock::new();
    RESULTS.get_or_init(|| {
        let folder = folder("slope");
        let line = format!(
            "igimp new slope > slope.toml && igimp run slope.toml {COARSE} --out results/slope"
        );
        let output = shell(&folder, &line);
        assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
        folder
    })
}

/// Every key of a value, and those within it.
fn keys(value: &serde_json::Value, out: &mut Vec<String>) {
    match value {
        serde_json::Value::Object(map) => {
            for (key, value) in map {
                out.push(key.clone());
                keys(value, out);
            }
        }
        serde_json::Value::Array(values) => values.iter().for_each(|value| keys(value, out)),
        _ => {}
    }
}

#[test]
fn the_page_on_results_names_every_file_and_field() {
    if !has_shell() {
        return;
    }
    let page = fs::read_to_string(root().join("docs/src/guide/results.md")).unwrap();
    let results = slope_results().join("results/slope");
    let mut names = Vec::new();
    let summary = fs::read(results.join("summary.json")).unwrap();
    keys(&serde_json::from_slice(&summary).unwrap(), &mut names);
    for entry in fs::read_dir(&results).unwrap() {
        names.push(entry.unwrap().file_name().into_string().unwrap());
    }
    let newest = checkpoint::newest(&results.join("checkpoint"))
        .unwrap()
        .unwrap();
    for entry in fs::read_dir(newest.join("current")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        names.push(name.trim_end_matches(".npy").to_owned());
    }
    let missing: Vec<&String> = names
        .iter()
        .filter(|name| {
            !["`", "/`"]
                .iter()
                .any(|end| page.contains(&format!("`{name}{end}")))
        })
        .collect();
    assert!(missing.is_empty(), "not on the page: {missing:?}");
}

#[test]
fn the_python_recipe_works() {
    if !has_shell() || !can_import("numpy, pandas") {
        return;
    }
    let recipe = root().join("docs/src/guide/python_recipe.py");
    let folder = slope_results();
    let output = shell(
        folder,
        &format!("python3 '{}' results/slope", recipe.display()),
    );
    assert!(output.status.success(), "{}", printed(&output));
    println!("{}", printed(&output));
    let picture = folder.join("results/slope/python.png").exists();
    assert_eq!(
        picture,
        can_import("matplotlib"),
        "a picture where matplotlib is installed"
    );
}
