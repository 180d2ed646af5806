//! Bodies whose outlines come from CSV files and drawings: reading, refusals with reasons, and that the completed
//! file carries the points themselves.
//!
//! The drawings in `tests/data/drawings` were written by ezdxf 1.4 (R2000 and R12).

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use igimp_input::CaseFile;
use igimp_model::Case;

use crate::folder::Folder;

const TEXT: &str = r#"
igimp = 1

[case]
title = "Ground from files"

[grid]
cell = "1 m"
domain = { x = ["0 m", "60 m"], y = ["0 m", "22 m"] }

[materials.clay]
model = "tresca"
cu = "50 kPa"
unit_weight = "18 kN/m3"
young = "20 MPa"
poisson = 0.45

[[bodies]]
name = "clay"
material = "clay"
polygon = POLYGON

[[stages]]
name = "weight"
type = "gravity"
"#;

const SLOPE: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [60.0, 0.0],
    [60.0, 10.0],
    [25.0, 10.0],
    [15.0, 20.0],
    [0.0, 20.0],
];

fn with(polygon: &str) -> String {
    TEXT.replace("POLYGON", polygon)
}

fn outline(folder: &Folder, polygon: &str) -> Vec<[f64; 2]> {
    let file = folder.read(&with(polygon));
    let file = file.unwrap_or_else(|error| panic!("{error}"));
    file.case().bodies[0].polygon().to_vec()
}

fn drawings() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/drawings"))
}

fn drawing(name: &str) -> String {
    fs::read_to_string(drawings().join(name)).unwrap()
}

fn close(a: &[[f64; 2]], b: &[[f64; 2]]) {
    assert_eq!(a.len(), b.len(), "{a:?}");
    for (p, q) in a.iter().flatten().zip(b.iter().flatten()) {
        assert!((p - q).abs() < 1e-12, "{a:?} {b:?}");
    }
}

/// GOAL: one outline by points, from CSV by key and by header, in feet, and from two versions of DXF is one body.
#[test]
fn an_outline_is_the_same_whichever_file_it_comes_from() {
    let rows = |scale: f64| {
        SLOPE.iter().fold(String::new(), |text, [x, y]| {
            format!("{text}{}, {}\n", x * scale, y * scale)
        })
    };
    let folder = Folder::new(
        "outline",
        &[
            ("plain.csv", &rows(1.0)),
            (
                "header.csv",
                &format!("# survey of May\nx [cm], y [cm]\n{}0,0\n", rows(100.0)),
            ),
            ("feet.csv", &format!("x,y\n{}", rows(1.0 / 0.3048))),
            ("r2000.dxf", &drawing("r2000.dxf")),
            ("r12.dxf", &drawing("r12.dxf").replace('\n', "\r\n")),
        ],
    );
    for polygon in [
        r#"{ file = "plain.csv", unit = "m" }"#,
        r#"{ file = "header.csv" }"#,
        r#"{ file = "feet.csv", unit = "ft" }"#,
        r#"{ file = "r2000.dxf", layer = "clay", unit = "m" }"#,
        // Its header says that it is drawn in metres.
        r#"{ file = "r2000.dxf", layer = "clay" }"#,
        r#"{ file = "r12.dxf", layer = "CLAY", unit = "m" }"#,
    ] {
        close(&outline(&folder, polygon), &SLOPE);
    }
}

/// GOAL: a body lies between two lines, whichever way round they are drawn and in how many pieces.
#[test]
fn a_body_lies_between_two_lines() {
    let folder = Folder::new(
        "between",
        &[
            ("r2000.dxf", &drawing("r2000.dxf")),
            ("rock.csv", "x [m],y [m]\n60,0\n0,0\n"),
        ],
    );
    let sand = [
        [0.0, 0.0],
        [60.0, 0.0],
        [60.0, 6.0],
        [40.0, 5.0],
        [20.0, 4.0],
        [0.0, 3.5],
    ];
    let top = r#"top = { file = "r2000.dxf", layer = "sand", unit = "m" }"#;
    for bottom in [
        r#"{ file = "rock.csv" }"#,
        r#"{ file = "r2000.dxf", layer = "rock", unit = "m" }"#,
        r#"[["0 m", "0 m"], ["60 m", "0 m"]]"#,
    ] {
        close(
            &outline(&folder, &format!("{{ {top}, bottom = {bottom} }}")),
            &sand,
        );
    }
}

/// GOAL: the completed file needs no other file, and another point is another case.
#[test]
fn the_completed_file_carries_the_points() {
    let folder = Folder::new("carried", &[("outline.csv", "0,0\n60,0\n60,10\n0,20.1\n")]);
    let polygon = r#"{ file = "outline.csv", unit = "m" }"#;
    let file = folder.read(&with(polygon)).unwrap();
    let explained = file.explain();
    assert!(explained.contains(r#"["0 m", "20.1 m"]"#) && !explained.contains("outline.csv"));
    let again = CaseFile::parse("elsewhere.toml", &explained, &[]).unwrap();
    let text = |case: &Case<2>| format!("{case:?}").replace("results/elsewhere", "results/case");
    assert_eq!(text(again.case()), text(file.case()));
    folder.write("outline.csv", "0,0\n60,0\n60,10\n0,20.2\n");
    let other = folder.read(&with(polygon)).unwrap();
    assert_ne!(text(other.case()), text(file.case()));
    assert_ne!(other.explain(), explained);
}

#[test]
fn what_cannot_be_read_is_named() {
    let r12 = drawing("r12.dxf");
    let folder = Folder::new(
        "refused",
        &[
            ("plain.csv", "0,0\n60,0\n60,10\n"),
            ("metres.csv", "x [m],y [m]\n0,0\n60,0\n60,10\n"),
            ("swapped.csv", "y,x\n0,0\n60,0\n60,10\n"),
            ("words.csv", "x,y\n0,0\nsixty,0\n60,10\n"),
            ("decimal.csv", "0;0\n60;0\n"),
            ("kilograms.csv", "x [kg],y [kg]\n0,0\n60,0\n60,10\n"),
            ("two.csv", "0,0\n60,0\n"),
            ("short.csv", "0,5\n50,5\n"),
            ("r2000.dxf", &drawing("r2000.dxf")),
            ("r12.dxf", &r12),
            ("cut.dxf", "0\nSECTION\n2\nENTITIES\nnext\nLINE\n"),
            ("binary.dxf", "AutoCAD Binary DXF\r\n\u{1a}\0"),
            (
                "apart.dxf",
                &r12.replace("11\n20\n21\n4", "11\n20.5\n21\n4"),
            ),
        ],
    );
    let mut out = String::new();
    for polygon in [
        r#"{ file = "missing.csv", unit = "m" }"#,
        r#"{ file = ".", unit = "m" }"#,
        r#"{ file = "plain.csv" }"#,
        r#"{ file = "plain.csv", unit = "kPa" }"#,
        r#"{ file = "plain.csv", unit = "m", layer = "clay" }"#,
        r#"{ file = "metres.csv", unit = "ft" }"#,
        r#"{ file = "swapped.csv", unit = "m" }"#,
        r#"{ file = "words.csv", unit = "m" }"#,
        r#"{ file = "decimal.csv", unit = "m" }"#,
        r#"{ file = "kilograms.csv" }"#,
        r#"{ file = "two.csv", unit = "m" }"#,
        r#"{ unit = "m" }"#,
        r#"{ file = "plain.csv", top = { file = "plain.csv" } }"#,
        r#"{ top = { file = "short.csv", unit = "m" }, bottom = [["0 m", "0 m"], ["60 m", "0 m"]] }"#,
        r#"{ file = "r2000.dxf", unit = "m" }"#,
        r#"{ file = "r12.dxf", layer = "clay" }"#,
        r#"{ file = "r2000.dxf", layer = "gravel", unit = "m" }"#,
        r#"{ file = "r2000.dxf", layer = "arcs", unit = "m" }"#,
        r#"{ file = "r2000.dxf", layer = "notes", unit = "m" }"#,
        r#"{ file = "r2000.dxf", layer = "sand", unit = "m" }"#,
        r#"{ file = "r12.dxf", layer = "arcs", unit = "m" }"#,
        r#"{ file = "apart.dxf", layer = "sand", unit = "m" }"#,
        r#"{ file = "cut.dxf", layer = "sand", unit = "m" }"#,
        r#"{ file = "binary.dxf", layer = "sand", unit = "m" }"#,
        r#"{ top = { file = "r2000.dxf", layer = "clay", unit = "m" }, bottom = [["0 m", "0 m"], ["60 m", "0 m"]] }"#,
    ] {
        let _ = writeln!(out, "## {polygon}\n{}", folder.printed(&with(polygon)));
    }
    insta::assert_snapshot!(out);
}
