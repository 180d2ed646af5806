//! The workspace as the checks see it, from `cargo metadata`.

use std::collections::{BTreeMap, VecDeque};
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::failure::Failure;
use crate::process::{cargo, output};

/// A package of the dependency graph.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Package {
    pub(crate) name: String,
    pub(crate) version: String,
    /// SPDX expression, if the package states one.
    pub(crate) licence: Option<String>,
    /// Folder of its manifest.
    pub(crate) folder: PathBuf,
    /// Whether it belongs to the workspace.
    pub(crate) is_member: bool,
    /// Names of the packages it asks for, for tests and builds too.
    pub(crate) asks_for: Vec<String>,
    /// Identifiers of the packages that it links.
    links: Vec<String>,
}

/// The workspace and all it depends on, on any platform.
#[derive(Clone, Debug, Default)]
pub(crate) struct Metadata {
    /// Where cargo builds.
    pub(crate) target: PathBuf,
    packages: BTreeMap<String, Package>,
}

impl Metadata {
    /// Asks cargo.
    pub(crate) fn of_workspace() -> Result<Self, Failure> {
        Self::of_manifest("Cargo.toml")
    }

    /// Asks cargo about the workspace of a manifest, from the root.
    pub(crate) fn of_manifest(manifest: &str) -> Result<Self, Failure> {
        let command = [
            "metadata",
            "--format-version",
            "1",
            "--manifest-path",
            manifest,
        ];
        let text = output(cargo().args(command))?;
        Self::parse(&text).ok_or_else(|| Failure::input_output("cargo metadata", "not understood"))
    }

    /// Reads the output of `cargo metadata --format-version 1`; `None` when it has another form.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        let value: Value = serde_json::from_str(text).ok()?;
        let string = |value: &Value| value.as_str().map(str::to_owned);
        let members = value["workspace_members"].as_array()?;
        let mut packages = BTreeMap::new();
        for package in value["packages"].as_array()? {
            let manifest = Path::new(package["manifest_path"].as_str()?);
            let dependencies = package["dependencies"].as_array()?;
            let parsed = Package {
                name: string(&package["name"])?,
                version: string(&package["version"])?,
                licence: string(&package["license"]),
                folder: manifest.parent()?.to_owned(),
                is_member: members.contains(&package["id"]),
                asks_for: dependencies
                    .iter()
                    .map(|dependency| string(&dependency["name"]))
                    .collect::<Option<_>>()?,
                links: Vec::new(),
            };
            packages.insert(string(&package["id"])?, parsed);
        }
        for node in value["resolve"]["nodes"].as_array()? {
            let package = packages.get_mut(node["id"].as_str()?)?;
            for dependency in node["deps"].as_array()? {
                let kinds = dependency["dep_kinds"].as_array()?;
                if kinds.iter().any(|kind| kind["kind"].is_null()) {
                    package.links.push(string(&dependency["pkg"])?);
                }
            }
        }
        let target = PathBuf::from(value["target_directory"].as_str()?);
        Some(Self { target, packages })
    }

    /// All packages.
    pub(crate) fn packages(&self) -> impl Iterator<Item = &Package> {
        self.packages.values()
    }

    /// The packages of the workspace.
    pub(crate) fn members(&self) -> impl Iterator<Item = &Package> {
        self.packages().filter(|package| package.is_member)
    }

    /// The shortest chain of links from the member `from` to a package called `to`, both included.
    pub(crate) fn chain(&self, from: &str, to: &str) -> Option<Vec<&str>> {
        let start = self
            .packages
            .iter()
            .find(|(_, package)| package.is_member && package.name == from)?
            .0;
        let mut parents = BTreeMap::from([(start, start)]);
        let mut queue = VecDeque::from([start]);
        while let Some(id) = queue.pop_front() {
            let package = self.packages.get(id)?;
            if package.name == to {
                let mut chain = vec![package.name.as_str()];
                let mut id = id;
                while parents[id] != id {
                    id = parents[id];
                    chain.push(&self.packages[id].name);
                }
                chain.reverse();
                return Some(chain);
            }
            for next in &package.links {
                if !parents.contains_key(next) {
                    parents.insert(next, id);
                    queue.push_back(next);
                }
            }
        }
        None
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use serde_json::json;

    /// Metadata of members (`true`) and other packages, each with its licence and what it links.
    pub(crate) fn metadata(packages: &[(&str, bool, Option<&str>, &[&str])]) -> Metadata {
        let id = |name: &str| format!("{name} 1.0.0");
        let members: Vec<String> = packages
            .iter()
            .filter(|(_, is_member, ..)| *is_member)
            .map(|(name, ..)| id(name))
            .collect();
        let list: Vec<Value> = packages
            .iter()
            .map(|(name, _, licence, links)| {
                let asks: Vec<Value> = links.iter().map(|name| json!({"name": name})).collect();
                json!({"name": name, "version": "1.0.0", "id": id(name), "license": licence,
                    "manifest_path": format!("/w/{name}/Cargo.toml"), "dependencies": asks})
            })
            .collect();
        let nodes: Vec<Value> = packages
            .iter()
            .map(|(name, _, _, links)| {
                let deps: Vec<Value> = links
                    .iter()
                    .map(|name| json!({"pkg": id(name), "dep_kinds": [{"kind": null}]}))
                    .collect();
                json!({"id": id(name), "deps": deps})
            })
            .collect();
        let value = json!({"packages": list, "workspace_members": members,
            "resolve": {"nodes": nodes}, "target_directory": "target"});
        Metadata::parse(&value.to_string()).unwrap()
    }

    #[test]
    fn chains_are_found() {
        let metadata = metadata(&[
            ("a", true, None, &["b", "c"]),
            ("b", false, Some("MIT"), &["c", "d"]),
            ("c", false, None, &[]),
            ("d", false, None, &["a"]),
        ]);
        assert_eq!(metadata.chain("a", "d"), Some(vec!["a", "b", "d"]));
        assert_eq!(metadata.chain("a", "c"), Some(vec!["a", "c"]));
        assert_eq!(metadata.chain("a", "e"), None);
        assert_eq!(metadata.chain("b", "c"), None, "b is no member");
        assert_eq!(metadata.members().count(), 1);
    }

    #[test]
    fn other_forms_are_refused() {
        assert!(Metadata::parse("").is_none());
        assert!(Metadata::parse("{}").is_none());
    }
}
