//! The crates form a chain, and those below the cases neither read files nor print.

use crate::metadata::{Metadata, Package};

/// Crates of the project with those that they may depend on, for tests too.
const LAYERS: [(&str, &[&str]); 25] = [
    ("igimp-shape", &[]),
    ("igimp-material", &[]),
    ("igimp-linear", &[]),
    ("igimp-surface", &[]),
    ("igimp-rigid", BELOW_CASES.split_at(4).0),
    ("igimp-assembly", BELOW_CASES.split_at(5).0),
    ("igimp-solver", BELOW_CASES.split_at(6).0),
    ("igimp-figures", &[]),
    ("igimp-text", &[]),
    ("igimp-schema", &["igimp-text"]),
    ("igimp-geometry", LIBRARIES.split_at(10).0),
    ("igimp-files", LIBRARIES.split_at(11).0),
    ("igimp-seepage", LIBRARIES.split_at(12).0),
    ("igimp-model", LIBRARIES.split_at(13).0),
    ("igimp-results", LIBRARIES.split_at(14).0),
    ("igimp-input", LIBRARIES.split_at(15).0),
    ("igimp-estimate", LIBRARIES.split_at(16).0),
    ("igimp-report", LIBRARIES.split_at(17).0),
    ("igimp-cases", LIBRARIES.split_at(18).0),
    ("igimp-study", LIBRARIES.split_at(19).0),
    ("igimp", LIBRARIES),
    ("igimp-benchmarks", LIBRARIES),
    ("igimp-validation", LIBRARIES),
    (
        "igimp-fuzz",
        &["igimp-input", "igimp-results", "igimp-schema"],
    ),
    ("xtask", &[]),
];

/// The crates that hold the method, lowest first.
pub(super) const BELOW_CASES: &[&str] = &[
    "igimp-shape",
    "igimp-material",
    "igimp-linear",
    "igimp-surface",
    "igimp-rigid",
    "igimp-assembly",
    "igimp-solver",
];

/// All libraries, lowest first: none depends on one behind it.
const LIBRARIES: &[&str] = &[
    "igimp-shape",
    "igimp-material",
    "igimp-linear",
    "igimp-surface",
    "igimp-rigid",
    "igimp-assembly",
    "igimp-solver",
    "igimp-figures",
    "igimp-text",
    "igimp-schema",
    "igimp-geometry",
    "igimp-files",
    "igimp-seepage",
    "igimp-model",
    "igimp-results",
    "igimp-input",
    "igimp-estimate",
    "igimp-report",
    "igimp-cases",
    "igimp-study",
];

/// Packages for files, command lines and pictures, which the method must not need, not even
/// through others.
const NOT_BELOW_CASES: [&str; 11] = [
    "clap",
    "csv",
    "dejavu",
    "env_logger",
    "indicatif",
    "png",
    "serde",
    "serde_json",
    "tiny-skia",
    "toml",
    "ttf-parser",
];

/// Problems with the layers.
pub(super) fn check(metadata: &Metadata) -> Vec<String> {
    let names: Vec<&str> = metadata
        .members()
        .map(|member| member.name.as_str())
        .collect();
    let missing = LAYERS.iter().filter(|(name, _)| !names.contains(name));
    let mut problems: Vec<String> = missing
        .map(|(name, _)| format!("{name} is missing from the workspace"))
        .collect();
    for member in metadata.members() {
        problems.extend(check_member(member, &names));
    }
    for &from in BELOW_CASES {
        for to in NOT_BELOW_CASES {
            if let Some(chain) = metadata.chain(from, to) {
                let chain = chain.join(" -> ");
                problems.push(format!("{to} has no place below igimp-cases: {chain}"));
            }
        }
    }
    problems
}

/// The member asks only for members of lower layers.
fn check_member(member: &Package, members: &[&str]) -> Vec<String> {
    let layer = LAYERS.iter().find(|(name, _)| *name == member.name);
    let Some((_, allowed)) = layer else {
        return vec![format!(
            "{} has no layer: say in xtask/src/tidy/layers.rs what it may depend on",
            member.name
        )];
    };
    let of_project = |name: &&String| members.contains(&name.as_str());
    let asks = member.asks_for.iter().filter(of_project);
    asks.filter(|name| !allowed.contains(&name.as_str()))
        .map(|name| format!("{} must not depend on {name}", member.name))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metadata::tests::metadata;

    type Row<'a> = (&'a str, bool, Option<&'a str>, &'a [&'a str]);

    const SOUND: [Row<'_>; 26] = [
        ("igimp-shape", true, None, &["thiserror"]),
        ("igimp-material", true, None, &[]),
        ("igimp-linear", true, None, &[]),
        ("igimp-surface", true, None, &["thiserror"]),
        ("igimp-rigid", true, None, &[]),
        (
            "igimp-assembly",
            true,
            None,
            &["igimp-shape", "igimp-material"],
        ),
        ("igimp-solver", true, None, &["igimp-assembly"]),
        ("igimp-figures", true, None, &[]),
        ("igimp-text", true, None, &[]),
        ("igimp-schema", true, None, &["igimp-text"]),
        ("igimp-files", true, None, &["igimp-schema"]),
        ("igimp-geometry", true, None, &["igimp-text"]),
        ("igimp-seepage", true, None, &["igimp-geometry"]),
        ("igimp-model", true, None, &["igimp-seepage"]),
        ("igimp-results", true, None, &["igimp-model"]),
        ("igimp-input", true, None, &["igimp-results"]),
        ("igimp-estimate", true, None, &["igimp-model"]),
        ("igimp-report", true, None, &["igimp-figures"]),
        ("igimp-cases", true, None, &["igimp-solver", "igimp-report"]),
        ("igimp-study", true, None, &["igimp-cases"]),
        ("igimp", true, None, &["igimp-cases"]),
        ("igimp-benchmarks", true, None, &["igimp-cases"]),
        ("igimp-validation", true, None, &["igimp-cases"]),
        ("igimp-fuzz", true, None, &["igimp-input"]),
        ("xtask", true, None, &["serde"]),
        ("serde", false, None, &[]),
    ];

    fn problems(changed: Row<'_>) -> Vec<String> {
        let mut rows: Vec<Row<'_>> = SOUND.into_iter().filter(|row| row.0 != changed.0).collect();
        rows.extend([changed, ("thiserror", false, None, &[])]);
        check(&metadata(&rows))
    }

    #[test]
    fn the_chain_passes() {
        assert!(problems(SOUND[0]).is_empty());
    }

    #[test]
    fn a_link_upwards_or_sideways_is_found() {
        let found = problems(("igimp-shape", true, None, &["igimp-material"]));
        assert_eq!(found, ["igimp-shape must not depend on igimp-material"]);
        let found = problems(("igimp-figures", true, None, &["igimp-solver"]));
        assert_eq!(found, ["igimp-figures must not depend on igimp-solver"]);
        let found = problems(("igimp-cases", true, None, &["igimp"]));
        assert_eq!(found, ["igimp-cases must not depend on igimp"]);
        let found = problems(("xtask", true, None, &["igimp-shape"]));
        assert_eq!(found, ["xtask must not depend on igimp-shape"]);
    }

    #[test]
    fn input_and_output_are_found_through_others() {
        let found = problems(("thiserror", false, None, &["serde"]));
        assert_eq!(found.len(), 4, "{found:?}");
        let chain = "igimp-solver -> igimp-assembly -> igimp-shape -> thiserror -> serde";
        assert!(found[3].ends_with(chain), "{found:?}");
    }

    #[test]
    fn every_member_has_a_layer() {
        let found = problems(("igimp-plots", true, None, &[]));
        assert_eq!(found.len(), 1);
        assert!(found[0].starts_with("igimp-plots has no layer"));
    }
}
