//! Statements of files: cases, completed files, files beside them, the reference of all keys.

use igimp_input::shipped::SHIPPED;
use igimp_input::{CaseFile, InputError};
use igimp_model::check::Band;
use igimp_schema::reference_markdown;

use crate::edits::edited;
use crate::messages::messages;
use crate::{FOOTING, SLOPE, overridden};

#[test]
fn the_models_state_their_cases() {
    insta::assert_snapshot!(messages(SLOPE, &[&[]]));
    insta::assert_snapshot!(messages(FOOTING, &[&[]]));
    for file in [SLOPE, FOOTING] {
        insta::assert_debug_snapshot!(CaseFile::parse(file.0, file.1, &[]).unwrap().case());
    }
}

#[test]
fn the_shipped_files_are_right_and_without_warning() {
    for case in SHIPPED {
        let (name, text) = (case.name, case.text);
        let file = CaseFile::parse(name, text, &[]).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(file.warnings(), "");
        assert_eq!(file.source(), text);
    }
}

/// GOAL: a check is printed in the unit of the file for its band, of several in that of the first, and its numbers
/// are in SI units. ORACLE: by hand: 1 cm is 0.01 m, 1 ft is 0.3048 m.
#[test]
fn a_check_keeps_the_unit_of_its_band() {
    for (keys, unit, band) in [
        ("at_most = \"3 cm\"", Some(("cm", 0.01)), Band::AtMost(0.03)),
        (
            "expected = \"2 m\"\nbetween = [\"1 ft\", \"50 cm\"]",
            Some(("ft", 0.3048)),
            Band::Between(0.3048, 0.5),
        ),
        (
            "expected = \"2 m\"\ntolerance = 0.1",
            Some(("m", 1.0)),
            Band::Relative(0.1),
        ),
        (
            "divide_by = [\"1 cm\"]\nat_least = 3",
            None,
            Band::AtLeast(3.0),
        ),
    ] {
        let check = format!(
            "[[checks]]\nname = \"c\"\nof = \"largest_displacement\"\nsource = \"s\"\n{keys}\n[output]"
        );
        let text = edited(SLOPE.1, &[("[output]", &check)]);
        let file = CaseFile::parse(SLOPE.0, &text, &[]).unwrap_or_else(|error| panic!("{error}"));
        let check = file.case().checks.last().unwrap();
        let found = check.unit.as_ref().map(|unit| (&unit.name[..], unit.in_si));
        assert_eq!((found, check.band), (unit, band), "{keys}");
    }
}

#[test]
fn an_explained_file_states_the_same_case() {
    let pressure = "[[loads]]\nname = \"strip\"\ntype = \"pressure\"\nfrom = [\"2 m\", \"5 m\"]\nto = [\"3 m\", \"5 m\"]\npressure = \"10 kPa\"\n[[stages]]\nname = \"press\"\ntype = \"load\"\nload = \"strip\"\n[[stages]]\nname = \"push";
    let more = edited(
        FOOTING.1,
        &[
            (
                "cell = \"0.125 m\"",
                "cell = { x = \"2/17 m\", y = \"0.125 m\" }",
            ),
            ("[[stages]]\nname = \"push", pressure),
            ("materials.clay", "materials.\"stiff clay\""),
            ("\"clay\"", "\"stiff clay\""),
            (", label = \"d / B [-]\"", ""),
            (
                "right = \"roller\"",
                "right = \"roller\"\nboxes = [{ name = \"wall\", to = [\"8 m\", \"0 m\"], from = [\"7 m\", \"5 m\"] }]",
            ),
            (
                "[output]",
                "[[checks]]\nname = \"Nc\"\nof = \"footing.reaction\"\ndivide_by = [\"2 m\", 50e3]\nbetween = [5, 5.5]\nsource = \"Prandtl \\\"1920\\\"\"\n[output]",
            ),
        ],
    );
    let files = [SLOPE, FOOTING, ("more.toml", more.as_str())];
    let shipped = SHIPPED.iter().map(|case| (case.name, case.text));
    for (name, text) in files.into_iter().chain(shipped) {
        let file = CaseFile::parse(name, text, &[]).unwrap_or_else(|error| panic!("{error}"));
        let explained = file.explain();
        let again = CaseFile::parse("other.toml", &explained, &[])
            .unwrap_or_else(|error| panic!("{error}\n{explained}"));
        assert_eq!(
            format!("{:?}", file.any_case()),
            format!("{:?}", again.any_case())
        );
        assert_eq!(
            again.explain().replace("default; ", ""),
            explained.replace("default; ", "")
        );
    }
    let file = overridden(SLOPE, &["materials.clay.cohesion=12 kPa"]).unwrap();
    insta::assert_snapshot!(file.explain());
    let file = CaseFile::parse("more.toml", &more, &[]).unwrap();
    insta::assert_snapshot!(file.explain());
}

#[test]
fn pressure_acts_into_the_soil_whichever_way_its_segment_runs() {
    let load = |from: &str, to: &str, more: &str| {
        let text = edited(
            FOOTING.1,
            &[
                (
                    "[[stages]]",
                    &format!(
                        "[[loads]]\nname = \"p\"\ntype = \"pressure\"\nfrom = {from}\nto = {to}\npressure = \"10 kPa\"\n{more}\n[[stages]]\nname = \"press\"\ntype = \"load\"\nload = \"p\"\n[[stages]]"
                    ),
                ),
                ("[\"8 m\",\"5 m\"], [\"0 m\"", "[\"7 m\",\"5 m\"], [\"0 m\""),
            ],
        );
        let file =
            CaseFile::parse("footing.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
        match file.case().loads[1].kind {
            igimp_model::LoadKind::Pressure { traction, .. } => traction,
            ref kind => panic!("{kind:?}"),
        }
    };
    let [left, right] = ["[\"2 m\", \"5 m\"]", "[\"4 m\", \"5 m\"]"];
    assert_eq!(load(left, right, ""), [0.0, -10e3]);
    assert_eq!(load(right, left, ""), [0.0, -10e3]);
    let [foot, crest] = ["[\"8 m\", \"0 m\"]", "[\"7 m\", \"5 m\"]"];
    let across = load(foot, crest, "");
    assert!((across[0] + 10e3 * 5.0 / 26_f64.sqrt()).abs() < 1e-6);
    assert!((across[1] + 10e3 / 26_f64.sqrt()).abs() < 1e-6);
    assert_eq!(load(foot, crest, "direction = \"down\""), [0.0, -10e3]);
}

#[test]
fn files_are_read_with_their_references() {
    let folder = std::env::temp_dir().join(format!("igimp-input-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("my case.toml");
    let text = edited(
        FOOTING.1,
        &[
            ("y = 5.1416", "file = \"measured.csv\""),
            ("folder = \"results/footing\"\n", ""),
        ],
    );
    std::fs::write(&path, &text).unwrap();
    std::fs::write(
        folder.join("measured.csv"),
        "# source\nd/B, N\n0, 0\n0.1, 5.2\n",
    )
    .unwrap();
    let case = CaseFile::read(&path, &[])
        .unwrap_or_else(|error| panic!("{error}"))
        .into_case();
    let debug = format!("{:?}", case.curves[0].reference);
    assert!(
        debug.contains("Points([[0.0, 0.0], [0.1, 5.2]])"),
        "{debug}"
    );
    assert_eq!(case.output.folder, std::path::Path::new("results/my case"));

    std::fs::write(folder.join("measured.csv"), "d/B, N\n0, zero\n").unwrap();
    let error = CaseFile::read(&path, &[]).unwrap_err().to_string();
    assert!(error.contains("row 2 does not hold two numbers"), "{error}");
    std::fs::write(&path, b"igimp = 1\n\xff\xfe = 2\n").unwrap();
    let error = CaseFile::read(&path, &[]).unwrap_err();
    assert!(matches!(error, InputError::Invalid { errors: 1, .. }));
    assert!(error.to_string().contains("my case.toml:2:1"), "{error}");
    assert!(matches!(
        CaseFile::read(&folder, &[]),
        Err(InputError::File { .. })
    ));
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(matches!(
        CaseFile::read(&path, &[]),
        Err(InputError::File { .. })
    ));
}

#[test]
fn the_reference_has_every_table() {
    insta::assert_snapshot!(reference_markdown());
}

/// GOAL: whom a case is for reaches the case, changes nothing that is computed, and is explained.
#[test]
fn a_title_block_is_read() {
    let block = "[case]\nproject = \"Bypass\"\nclient = \"Road authority\"\nauthor = \"A. Engineer\"\nrevision = \"B\"";
    let text = edited(SLOPE.1, &[("[case]", block)]);
    let file = CaseFile::parse(SLOPE.0, &text, &[]).unwrap();
    let block = &file.case().title_block;
    let read = [
        &block.project,
        &block.client,
        &block.author,
        &block.revision,
    ];
    let expected = ["Bypass", "Road authority", "A. Engineer", "B"];
    assert_eq!(read.map(|text| text.as_deref().unwrap()), expected);
    assert!(file.explain().contains("revision = \"B\""));
}
