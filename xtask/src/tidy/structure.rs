//! Crates, folders and modules stay small, and modules side by side depend on each other one way only.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use super::imports::imports;
use super::sources::rust_files;
use crate::failure::Failure;
use crate::metadata::Metadata;

/// Most lines of source in a library; the studies of `validation` are many small ones side by side.
const LINES: usize = 15_000;

/// Most source files in a folder.
const FILES: usize = 15;

/// Path of a module within its crate; empty: the crate.
type Module = Vec<String>;

/// By module, the modules of the crate that it names.
type Graph = BTreeMap<Module, BTreeSet<Module>>;

/// Problems in the structure of all members.
pub(super) fn check(metadata: &Metadata, root: &Path) -> Result<Vec<String>, Failure> {
    let mut problems = Vec::new();
    for member in metadata.members() {
        let source = member.folder.join("src");
        let mut files = Vec::new();
        if source.is_dir() {
            rust_files(&source, &mut files)?;
        }
        files.sort();
        problems.extend(crowded(&files, root));
        let mut texts = BTreeMap::new();
        let mut lines = 0;
        for file in files {
            let text = fs::read_to_string(&file).map_err(|error| {
                Failure::input_output(format!("cannot read {}", file.display()), error)
            })?;
            lines += text.lines().count();
            let path = file.strip_prefix(&source).unwrap_or(&file);
            if let Some(module) = module(path) {
                texts.insert(module, text);
            }
        }
        let is_library = source.join("lib.rs").is_file();
        if is_library && lines > LINES {
            let name = &member.name;
            problems.push(format!("{name} has {lines} lines, more than {LINES}"));
        }
        for circle in circles(&graph(&texts)) {
            let circle = circle.join(", ");
            problems.push(format!("{}: circle of modules: {circle}", member.name));
        }
    }
    Ok(problems)
}

/// Folders with too many files.
fn crowded(files: &[PathBuf], root: &Path) -> Vec<String> {
    let mut count: BTreeMap<&Path, usize> = BTreeMap::new();
    for folder in files.iter().filter_map(|file| file.parent()) {
        *count.entry(folder).or_default() += 1;
    }
    let crowded = count.into_iter().filter(|&(_, count)| count > FILES);
    crowded
        .map(|(folder, count)| {
            let folder = folder.strip_prefix(root).unwrap_or(folder).display();
            format!("{folder} has {count} files, more than {FILES}")
        })
        .collect()
}

/// The module that a file holds; none for programs and tests, which nothing depends on.
fn module(path: &Path) -> Option<Module> {
    let path = path.with_extension("");
    let mut module: Module = (path.iter())
        .map(|part| part.to_string_lossy().into_owned())
        .collect();
    let last = module.last()?.clone();
    if module[0] == "bin" || last == "tests" || last.ends_with("_tests") {
        return None;
    }
    if last == "mod" || (module.len() == 1 && (last == "lib" || last == "main")) {
        module.pop();
    }
    Some(module)
}

/// Which module names which, from their texts.
fn graph(texts: &BTreeMap<Module, String>) -> Graph {
    let known = |path: &[String]| {
        let lengths = (0..=path.len()).rev();
        let mut modules = lengths.map(|length| path[..length].to_vec());
        modules.find(|module| texts.contains_key(module))
    };
    let named = |module: &Module, text: &str| {
        let absolute = imports(text)
            .into_iter()
            .filter_map(|path| absolute(module, &path, texts));
        let mut modules: BTreeSet<Module> = absolute.filter_map(|path| known(&path)).collect();
        modules.remove(module);
        modules
    };
    let nodes = texts.iter();
    nodes
        .map(|(module, text)| (module.clone(), named(module, text)))
        .collect()
}

/// A path from the root of the crate; none for one that leads to another crate.
fn absolute(
    module: &Module,
    path: &[String],
    texts: &BTreeMap<Module, String>,
) -> Option<Vec<String>> {
    let mut base = module.clone();
    let mut rest = path;
    match rest.first()?.as_str() {
        "crate" => {
            base.clear();
            rest = &rest[1..];
        }
        "self" => rest = &rest[1..],
        "super" => {
            while rest.first().is_some_and(|part| part == "super") {
                base.pop();
                rest = &rest[1..];
            }
        }
        child => {
            let mut module = base.clone();
            module.push(child.to_owned());
            if !texts.contains_key(&module) {
                return None;
            }
        }
    }
    base.extend_from_slice(rest);
    Some(base)
}

/// Modules side by side that depend on each other in a circle, with all that lies within them.
fn circles(graph: &Graph) -> Vec<Vec<String>> {
    let folders: BTreeSet<&[String]> = (graph.keys())
        .filter_map(|module| module.split_last().map(|(_, folder)| folder))
        .collect();
    let mut circles = Vec::new();
    for folder in folders {
        let depth = folder.len();
        let child = |module: &Module| {
            let within = module.len() > depth && module.starts_with(folder);
            within.then(|| module[..=depth].to_vec())
        };
        let mut between: Graph = BTreeMap::new();
        for (module, named) in graph {
            let Some(from) = child(module) else { continue };
            let targets = between.entry(from.clone()).or_default();
            targets.extend(named.iter().filter_map(child).filter(|to| *to != from));
        }
        while let Some(free) = between.keys().find(|module| between[*module].is_empty()) {
            let free = free.clone();
            between.remove(&free);
            for named in between.values_mut() {
                named.remove(&free);
            }
        }
        // Modules that only lead to a circle are none of it.
        let reaches = |from: &Module| {
            let mut seen = BTreeSet::new();
            let mut open: Vec<&Module> = between[from].iter().collect();
            while let Some(module) = open.pop() {
                if seen.insert(module) {
                    open.extend(&between[module]);
                }
            }
            seen.contains(from)
        };
        let circle: Vec<String> = (between.keys())
            .filter(|module| reaches(module))
            .map(|module| module.join("::"))
            .collect();
        if !circle.is_empty() {
            circles.push(circle);
        }
    }
    circles
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(texts: &[(&str, &str)]) -> Vec<Vec<String>> {
        let texts = texts.iter().map(|(path, text)| {
            let module = module(Path::new(path)).expect("a module");
            (module, (*text).to_owned())
        });
        circles(&graph(&texts.collect()))
    }

    #[test]
    fn circles_side_by_side_are_found() {
        let found = found(&[
            ("lib.rs", "mod a; mod b; mod c;"),
            ("a.rs", "use crate::b::B;"),
            ("b/mod.rs", "mod inner;"),
            ("b/inner.rs", "fn f() { super::super::a::g(); }"),
            ("c.rs", "use super::a;"),
        ]);
        assert_eq!(found, [["a", "b"]]);
    }

    #[test]
    fn a_parent_may_name_its_children_and_they_it() {
        let found = found(&[
            ("lib.rs", "mod a;"),
            ("a.rs", "mod inner; use inner::B;"),
            ("a/inner.rs", "use super::A;"),
        ]);
        assert!(found.is_empty(), "{found:?}");
    }

    #[test]
    fn full_folders_are_found() {
        let files: Vec<PathBuf> = (0..=FILES)
            .map(|k| PathBuf::from(format!("/house/a/{k}.rs")))
            .collect();
        assert_eq!(
            crowded(&files, Path::new("/house")),
            ["a has 16 files, more than 15"]
        );
        assert!(crowded(&files[1..], Path::new("/house")).is_empty());
    }
}
