//! Pages of folders that are none of a run: the page of a test as a reader sees it, and how it is opened.

use std::process::Output;

use super::support::Folder;

const SAND: &str = "igimp = 1\n[materials.sand]\nmodel = \"mohr-coulomb\"\nunit_weight = \"18 kN/m3\"\nyoung = \"30 MPa\"\n\
    poisson = 0.3\ncohesion = \"5 kPa\"\nfriction = \"34 deg\"\n";

/// Eight measurements of a triaxial test.
const MEASURED: &str = "strain_yy [%],q [kPa]\n0.1,28.4\n0.2,57.7\n0.4,114.8\n0.8,239.9\n1.5,270.4\n2.5,272.1\n4,275.2\n6,271.5\n";

fn printed(output: &Output) -> (i32, String, String) {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let code = output.status.code().unwrap();
    (code, text(&output.stdout), text(&output.stderr))
}

/// A folder with the sand and its data, and the page of a test that ended with a code.
fn tested(name: &str, words: &[&str], expected: i32) -> (Folder, String) {
    let folder = Folder::new(name);
    std::fs::write(folder.0.join("sand.toml"), SAND).unwrap();
    std::fs::write(folder.0.join("data.csv"), MEASURED).unwrap();
    let path = "stress_xx [kPa],stress_yy [kPa]\n200,200\n200,2000\n";
    std::fs::write(folder.0.join("path.csv"), path).unwrap();
    let base = ["element", "sand.toml", "--out", "test"];
    let output = folder.igimp(&[&base, words].concat());
    assert_eq!(printed(&output).0, expected, "{:?}", printed(&output));
    let page = std::fs::read_to_string(folder.0.join("test/report.html")).unwrap();
    (folder, page)
}

/// The cells of the row of a table that begins with a name.
fn row(page: &str, name: &str) -> Vec<String> {
    let begin = format!("<tr><td>{name}</td>");
    let line = page.lines().find(|line| line.contains(&begin));
    let line = line.unwrap_or_else(|| panic!("no row {name}"));
    let cells = line.split("<td").skip(1);
    cells
        .map(|cell| {
            let text = cell.split_once('>').unwrap().1;
            text.split("</td>").next().unwrap().to_owned()
        })
        .collect()
}

/// GOAL: the page of a triaxial test tells the law with its parameters and units, the path, peak and end, and has the measurements in
/// its pictures, without a part from outside. ORACLE: σ_3 (K_p - 1) + 2 c √K_p by hand; the data as they were written.
#[test]
fn a_triaxial_test_has_a_page_with_its_data() {
    let words = ["--small-strain", "--strain", "6", "--data", "data.csv"];
    let (folder, page) = tested("element-page", &words, 0);
    let root = (45.0_f64 + 17.0).to_radians().tan();
    let strength = 100.0 * (root * root - 1.0) + 2.0 * 5.0 * root;
    for part in [
        "<h1>sand: Mohr–Coulomb, triaxial drained</h1>",
        "<span class=\"mark good\">Completed</span>",
        "Axial strain is driven from 0 to 6 %, while the stress at the sides stays.",
        "It begins at σ_y = 100 kPa and σ_x = σ_z = 100 kPa, effective.",
        "Computed less measured, of data.csv",
        "href=\"element.csv\"",
        "href=\"data.csv\"",
    ] {
        assert!(page.contains(part), "{part}");
    }
    for (name, value) in [
        ("Law", "Mohr–Coulomb"),
        ("E", "30 MPa"),
        ("ν", "0.3"),
        ("c", "5 kPa"),
        ("φ", "34°"),
        ("ψ", "0°"),
    ] {
        assert_eq!(row(&page, name)[1], value, "{name}");
    }
    let [start, peak, end] = [1, 2, 3].map(|k| row(&page, "q [kPa]")[k].parse::<f64>().unwrap());
    assert!(start.abs() < 1e-9, "{start}");
    for value in [peak, end] {
        assert!((value / strength - 1.0).abs() < 5e-4, "{value} {strength}");
    }
    assert_eq!(row(&page, "q")[1], "8", "values that were measured");
    assert_eq!(
        page.matches("<img src=\"data:image/svg+xml;base64,")
            .count(),
        3
    );
    let drawn = std::fs::read_to_string(folder.0.join("test/stress-strain.svg")).unwrap();
    let measured = drawn
        .split("<path")
        .find(|path| path.contains("fill=\"#d55e00\""));
    let squares = measured.unwrap().matches('M').count();
    assert_eq!(squares, 8, "points of the laboratory");
    for part in [
        "Stress over strain: computed, and measured",
        "<figcaption>The path of stress <a",
    ] {
        assert!(page.contains(part), "{part}");
    }
    for outside in ["<script", "http://", "https://", "<link"] {
        assert!(!page.contains(outside), "{outside}");
    }
}

/// GOAL: a path that soil cannot bear is named at the head of the page, with its legs. ORACLE: the path as it was written.
#[test]
fn a_path_that_ends_early_is_noted_on_its_page() {
    let (_folder, page) = tested("element-early", &["--path", "path.csv"], 3);
    for part in [
        "<span class=\"mark fair\">Ended early</span>",
        "Ended early: leg 2 of the path ends at",
        "A path of 2 legs is followed",
        "sigma_yy effective, compression positive [kPa]</th>",
    ] {
        assert!(page.contains(part), "{part}");
    }
    let legs: Vec<&str> = page.lines().filter(|line| line.contains("as xx")).collect();
    assert!(
        legs.len() == 2 && legs[1].contains(">2000</td>"),
        "{legs:?}"
    );
}

/// GOAL: the warnings of the terminal stand on the page. ORACLE: the same words.
#[test]
fn warnings_stand_on_the_page() {
    let words = ["--set", "materials.sand.cohesion=0 kPa"];
    let (_folder, page) = tested("element-warned", &words, 0);
    for part in [
        "<span class=\"mark fair\">Completed, with warnings</span>",
        "<h2>Warnings</h2>",
        "has no cohesion: without confinement it has no strength",
    ] {
        assert!(page.contains(part), "{part}");
    }
}

/// GOAL: data that are none leave no page, and are named with file, line and column. ORACLE: the file as it was written.
#[test]
fn data_that_are_none_make_no_page() {
    let folder = Folder::new("element-bad");
    std::fs::write(folder.0.join("sand.toml"), SAND).unwrap();
    std::fs::write(folder.0.join("data.csv"), "strain_yy [%],q [m]\n1,2\n").unwrap();
    let words = [
        "element",
        "sand.toml",
        "--data",
        "data.csv",
        "--out",
        "test",
    ];
    let (code, _, text) = printed(&folder.igimp(&words));
    assert_eq!(code, 2);
    assert!(text.contains("data.csv, line 1, column `q [m]`"), "{text}");
    assert!(!folder.0.join("test").exists());
}

/// GOAL: the view opens the page of a test, and none that igimp did not write. ORACLE: the path that it prints.
#[test]
fn the_view_opens_the_page_of_a_test() {
    let (folder, _) = tested("element-view", &["--steps", "5"], 0);
    let (code, text, _) = printed(&folder.igimp(&["view", "test", "--no-open"]));
    let page = std::fs::canonicalize(folder.0.join("test/report.html")).unwrap();
    assert_eq!((code, text.trim_end()), (0, &*page.display().to_string()));
    std::fs::write(folder.0.join("test/report.html"), "<html></html>").unwrap();
    let (code, _, text) = printed(&folder.igimp(&["view", "test", "--no-open"]));
    assert!(
        code == 2 && text.contains("there are no results of a run"),
        "{text}"
    );
}

/// GOAL: undrained soil whose friction softens ends on its residual. ORACLE: with ψ = 0 and the volume kept p stays at 100 kPa, and
/// q = 6 (p sin φ + c cos φ)/(3 − sin φ) with the residual φ of 24°. BAND: the four digits that are printed.
#[test]
fn undrained_soil_ends_on_the_friction_that_is_left() {
    let softening =
        "materials.sand.softening={ friction = { residual = \"24 deg\", strain = 0.05 } }";
    let words = [
        "--test",
        "triaxial-undrained",
        "--small-strain",
        "--strain",
        "60",
    ];
    let (_folder, page) = tested(
        "element-softens",
        &[&words[..], &["--set", softening]].concat(),
        0,
    );
    let (sin, cos) = 24.0_f64.to_radians().sin_cos();
    let left = 6.0 * (100.0 * sin + 5.0 * cos) / (3.0 - sin);
    let [peak, end] = [2, 3].map(|k| row(&page, "q [kPa]")[k].parse::<f64>().unwrap());
    assert!(
        (end - left).abs() < 0.06 && peak > 1.3 * left,
        "{peak} {end} {left}"
    );
    assert!(page.contains("φ to 24° exponentially over a plastic strain of 0.05"));
}
