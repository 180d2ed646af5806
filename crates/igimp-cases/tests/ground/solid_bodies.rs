//! Bodies in space from case files: shapes by key, files, and refusals with reasons.

use std::f64::consts::PI;
use std::fmt::Write as _;

use igimp_input::CaseFile;

use crate::folder::Folder;

const TEXT: &str = r#"
igimp = 1

[case]
title = "Bodies in space"
analysis = "3d"

[grid]
cell = "1 m"
domain = { x = ["0 m", "8 m"], y = ["0 m", "6 m"], z = ["0 m", "5 m"] }

[materials.clay]
model = "tresca"
cu = "50 kPa"
unit_weight = "18 kN/m3"
young = "20 MPa"
poisson = 0.45

[[stages]]
name = "weight"
type = "gravity"
"#;

fn with(bodies: &[&str]) -> String {
    let mut text = TEXT.to_owned();
    for (body, number) in bodies.iter().zip(1..) {
        let name = format!("body {number}");
        write!(
            text,
            "\n[[bodies]]\nname = \"{name}\"\nmaterial = \"clay\"\n{body}\n"
        )
        .unwrap();
    }
    text
}

/// The volume of the one body, whether it is read from the case or from the case that explains it.
#[track_caller]
fn volume(folder: &Folder, body: &str) -> f64 {
    let file = folder.read(&with(&[body])).unwrap();
    let volume = file.case_in_space().bodies[0].region.volume();
    let again = CaseFile::parse("explained.toml", &file.explain(), &[]).unwrap();
    let explained = again.case_in_space().bodies[0].region.volume();
    assert_eq!(volume.to_bits(), explained.to_bits(), "{}", file.explain());
    volume
}

#[track_caller]
fn assert_near(found: f64, exact: f64, band: f64) {
    assert!((found / exact - 1.0).abs() <= band, "{found} for {exact}");
}

/// A wedge, 4 ft long, 3 ft deep and 2 ft high; without its slope if it is open.
fn wedge(is_open: bool) -> String {
    let [a, b, c, d, e, f] = ["0 0 0", "4 0 0", "0 0 2", "0 3 0", "4 3 0", "0 3 2"];
    let mut triangles = vec![
        [a, b, c],
        [d, f, e],
        [a, d, e],
        [a, e, b],
        [a, c, f],
        [a, f, d],
    ];
    if !is_open {
        triangles.extend([[b, e, f], [b, f, c]]);
    }
    let mut text = "solid wedge\n".to_owned();
    for [p, q, r] in triangles {
        writeln!(
            text,
            "facet normal 0 0 0\nouter loop\nvertex {p}\nvertex {q}\nvertex {r}\nendloop\nendfacet"
        )
        .unwrap();
    }
    text + "endsolid wedge\n"
}

/// Heights 2 m + x/4 on points 2 m apart, the last row first; `hole` in place of one.
fn raster(hole: Option<&str>) -> String {
    let mut text =
        "ncols 5\nnrows 4\nxllcenter 0\nyllcenter 0\ncellsize 2\nNODATA_value -99\n".to_owned();
    for row in 0..4 {
        for column in 0..5 {
            let height = format!("{}", 2.0 + 0.5 * f64::from(column));
            let entry = hole.filter(|_| row == 1 && column == 3).unwrap_or(&height);
            write!(text, "{entry} ").unwrap();
        }
        text.push('\n');
    }
    text
}

#[test]
fn every_shape_has_its_volume() {
    let mut scattered = String::new();
    for k in 0..60 {
        let k = f64::from(k);
        let x = 13.0 + 14.0 * (1.3 * k).sin();
        let y = 10.0 + 11.0 * (2.1 * k + 0.4).cos();
        writeln!(scattered, "{x},{y},{}", 1.0 + 0.05 * x - 0.03 * y).unwrap();
    }
    let scattered = format!(
        "x [ft],y [ft],z [ft]\n-2,-2,0.96\n28,-2,2.46\n28,22,1.74\n-2,22,0.24\n{scattered}"
    );
    let folder = Folder::new(
        "solid-shapes",
        &[
            ("wedge.stl", &wedge(false)),
            ("ground.asc", &raster(None)),
            ("rock.csv", &scattered),
            ("plan.csv", "x [m],y [m]\n0,0\n8,0\n8,6\n0,6\n"),
        ],
    );
    let box_of = r#"box = { from = ["1 m", "5 m", "0 m"], to = ["4 m", "1 m", "2 m"] }"#;
    assert_near(volume(&folder, box_of), 24.0, 1e-15);
    let slice = r#"polygon = [["0 m", "0 m"], ["6 m", "0 m"], ["0 m", "4 m"]]
        across = ["1 m", "3 m"]"#;
    assert_near(volume(&folder, slice), 24.0, 1e-15);
    let column = r#"plan = [["0 m", "0 m"], ["6 m", "0 m"], ["0 m", "4 m"]]
        between = ["1 m", "3 m"]"#;
    assert_near(volume(&folder, column), 24.0, 1e-15);
    let cylinder = r#"cylinder = { axis = "y", centre = ["3 m", "2 m"], radius = "1.5 m", between = ["1 m", "3 m"] }"#;
    assert_near(volume(&folder, cylinder), PI * 4.5, 1e-12);
    let sphere = r#"sphere = { centre = ["3 m", "3 m", "2 m"], radius = "1.5 m" }"#;
    assert_near(volume(&folder, sphere), PI * 4.5, 1e-11);
    let foot = 0.3048_f64;
    let wedge = r#"surface = { file = "wedge.stl", unit = "ft" }"#;
    assert_near(volume(&folder, wedge), 12.0 * foot.powi(3), 1e-12);
    // Between points that are not level, and over a plan from a file.
    let plan = r#"plan = { file = "plan.csv" }"#;
    let rock = r#"{ points = "rock.csv" }"#;
    let ground = r#"{ raster = "ground.asc", unit = "m" }"#;
    let below = volume(&folder, &format!("{plan}\nbetween = [\"0 m\", {rock}]"));
    assert_near(below, 48.0 * (1.0 * foot + 0.05 * 4.0 - 0.03 * 3.0), 1e-12);
    let above = volume(&folder, &format!("{plan}\nbetween = [{rock}, {ground}]"));
    assert_near(above, 48.0 * 3.0 - below, 1e-12);
    let pit = format!(
        "{box_of}\nminus = [{{ cylinder = {{ centre = [\"2 m\", \"3 m\"], radius = \"0.5 m\", between = [\"1 m\", \"4 m\"] }} }}]"
    );
    assert_near(volume(&folder, &pit), 24.0 - 0.25 * PI, 1e-12);
}

#[test]
fn layers_of_one_survey_lie_on_each_other() {
    let folder = Folder::new("solid-layers", &[("ground.asc", &raster(None))]);
    let plan = r#"plan = [["0 m", "0 m"], ["8 m", "0 m"], ["8 m", "6 m"], ["0 m", "6 m"]]"#;
    let middle =
        r#"{ x = ["0 m", "8 m"], y = ["0 m", "6 m"], rows = [["1 m", "2 m"], ["1.5 m", "1 m"]] }"#;
    let ground = r#"{ raster = "ground.asc", unit = "m" }"#;
    let bodies = [
        format!("{plan}\nbetween = [\"0 m\", {middle}]"),
        format!("{plan}\nbetween = [{middle}, {ground}]"),
    ];
    let bodies = [bodies[0].as_str(), bodies[1].as_str()];
    assert_eq!(folder.printed(&with(&bodies)), "");
    let file = folder.read(&with(&bodies)).unwrap();
    let parts = &file.case_in_space().bodies;
    let volume: f64 = parts.iter().map(|part| part.region.volume()).sum();
    assert_near(volume, 48.0 * 3.0, 1e-12);
}

#[test]
fn what_is_wrong_has_its_place_and_remedy() {
    let folder = Folder::new(
        "solid-wrong",
        &[
            ("open.stl", &wedge(true)),
            (
                "inside_out.stl",
                &wedge(false).replace("vertex 0 0 0\nvertex 4 0 0", "vertex 4 0 0\nvertex 0 0 0"),
            ),
            ("none.stl", "no surface"),
            ("holed.asc", &raster(Some("-99"))),
            ("short.asc", &raster(Some(""))),
            ("ground.asc", &raster(None)),
        ],
    );
    let plan = r#"plan = [["0 m", "0 m"], ["8 m", "0 m"], ["8 m", "6 m"], ["0 m", "6 m"]]"#;
    let mut all = String::new();
    for bodies in [
        &[""][..],
        &[r#"box = { from = ["1 m", "1 m", "0 m"], to = ["4 m", "1 m", "2 m"] }"#],
        &[r#"box = { from = ["1 m", "1 m", "0 m"], to = ["4 m", "2 m", "9 m"] }"#],
        &[
            r#"box = { from = ["1 m", "1 m", "0 m"], to = ["4 m", "2 m", "1 m"] }
            sphere = { centre = ["3 m", "3 m", "2 m"], radius = "1 m" }"#,
        ],
        &[r#"polygon = [["0 m", "0 m"], ["6 m", "0 m"], ["0 m", "4 m"]]"#],
        &[r#"plan = [["0 m", "0 m"], ["6 m", "0 m"], ["0 m", "4 m"]]
            across = ["0 m", "1 m"]"#],
        &[r#"plan = [["0 m", "0 m"], ["6 m", "0 m"], ["0 m", "4 m"]]
            between = ["2 m", "1 m"]"#],
        &[r#"surface = { file = "open.stl", unit = "m" }"#],
        &[r#"surface = { file = "inside_out.stl", unit = "m" }"#],
        &[r#"surface = { file = "none.stl", unit = "m" }"#],
        &[r#"surface = { file = "open.stl" }"#],
        &[&format!(
            r#"{plan}
            between = ["0 m", {{ raster = "holed.asc", unit = "m" }}]"#
        )],
        &[&format!(
            r#"{plan}
            between = ["0 m", {{ raster = "short.asc", unit = "m" }}]"#
        )],
        &[&format!(
            r#"{plan}
            between = ["2.5 m", {{ raster = "ground.asc", unit = "m" }}]"#
        )],
        &[
            r#"sphere = { centre = ["3 m", "3 m", "2 m"], radius = "1 m" }"#,
            r#"cylinder = { centre = ["3 m", "3 m"], radius = "0.2 m", between = ["0 m", "4 m"] }"#,
        ],
        &[
            r#"sphere = { centre = ["3 m", "3 m", "2 m"], radius = "1 m" }
            minus = [{ box = { from = ["5 m", "0 m", "0 m"], to = ["8 m", "6 m", "5 m"] } }]"#,
        ],
    ] {
        let printed = folder.printed(&with(bodies));
        assert!(!printed.is_empty(), "{bodies:?}");
        writeln!(all, "{printed}\n").unwrap();
    }
    insta::assert_snapshot!(all);
}
