//! GOAL: overlays of the soil of the plane: water, mechanisms, contours, outlines.
//! ORACLE: the case, and the tables of the run.

use crate::support::{BLOCK, View, attribute, browser, dumped, looked_at, results_of};

/// GOAL: a run that ends with a search opens on the way in which the body fails, with the nails where they are and the slip line.
#[test]
fn a_search_opens_on_its_mechanism() {
    let Some(browser) = browser() else {
        return;
    };
    let case = include_str!("../../../igimp-input/cases/nailed_cut.toml");
    let folder = results_of(
        "mechanism",
        case,
        &[
            "--set",
            "grid.cell=0.5 m",
            "--set",
            "checks.0.between=[1, 2]",
        ],
    );
    let view = View::of(&folder, "results");
    let page = looked_at(browser, &folder, &view, "");
    let label = attribute(&page, "slider", "aria-valuetext");
    assert!(label.starts_with("factor of safety: "), "{label}");
    let bars: usize = attribute(&page, "canvas", "data-members").parse().unwrap();
    assert!(bars > 10, "{bars}");
    // The slip line has the points of its table, where there is one.
    let lines = std::fs::read_dir(folder.0.join("results/slip_lines"));
    let lines = lines.into_iter().flatten().flatten();
    let rows = |entry: std::fs::DirEntry| {
        let text = std::fs::read_to_string(entry.path()).unwrap();
        text.lines().count() - 1
    };
    let points: usize = lines.map(rows).sum();
    assert_eq!(attribute(&page, "canvas", "data-slip"), points.to_string());
    let page = looked_at(browser, &folder, &view, "frame=1");
    assert!(attribute(&page, "slider", "aria-valuetext").starts_with("Frame 1 of "));
}

/// GOAL: the water table of a stage is drawn over its frames, on the page and in the report.
#[test]
fn water_tables_are_drawn() {
    let water = "[[water]]\nname = \"table\"\nline = [[\"0 m\", \"1 m\"], [\"2 m\", \"1.5 m\"]]\n[boundaries]";
    let case = BLOCK.replace("[boundaries]", water);
    let folder = results_of("water", &case, &[]);
    let view = View::of(&folder, "results");
    let index: serde_json::Value = serde_json::from_str(&view.get("index.json").2).unwrap();
    assert_eq!(
        index["over"][0]["water"],
        serde_json::json!([[[0.0, 1.0], [2.0, 1.5]]])
    );
    let Some(browser) = browser() else {
        return;
    };
    let page = looked_at(browser, &folder, &view, "frame=2");
    assert_eq!(attribute(&page, "canvas", "data-water"), "1");
    let address = format!(
        "file://{}#look&contours=lines",
        folder.0.join("results/report.html").display()
    );
    let report = dumped(browser, &folder, &address, 15);
    assert_eq!(attribute(&report, "canvas", "data-water"), "1");
    assert_eq!(attribute(&report, "canvas", "data-edges"), "1");
}

/// GOAL: contours stand at the ticks of the scale; they and the outlines are there or not as is chosen.
/// ORACLE: vertical stress of soil under its weight goes with the depth: each level has one line from side to side.
#[test]
fn contours_and_outlines_are_chosen() {
    let Some(browser) = browser() else {
        return;
    };
    let folder = results_of("contours-of-weight", BLOCK, &[]);
    let view = View::of(&folder, "results");
    let field = "frame=3&field=sigma%20[Pa],%20tension%20%2B,%20yy";
    let look = |more: &str| looked_at(browser, &folder, &view, &format!("{field}{more}"));
    let page = look("&contours=values");
    let levels = attribute(&page, "canvas", "data-contour-levels");
    let levels: Vec<f64> = levels.split(' ').map(|v| v.parse().unwrap()).collect();
    assert!(levels.len() > 3, "{levels:?}");
    let lines: usize = attribute(&page, "canvas", "data-contours").parse().unwrap();
    assert_eq!(lines, levels.len());
    // Stress from 0 to γ times 2 m.
    assert!(
        levels
            .iter()
            .all(|level| (-36e3..0.0).contains(level) && level % 1e3 == 0.0)
    );
    let labels: usize = attribute(&page, "canvas", "data-contour-labels")
        .parse()
        .unwrap();
    assert!(labels > 0 && labels <= lines);
    assert_eq!(attribute(&page, "canvas", "data-outlined"), "true");
    let page = look("&outlines=0");
    assert_eq!(attribute(&page, "canvas", "data-contours"), "0");
    assert_eq!(attribute(&page, "canvas", "data-outlined"), "false");
}
