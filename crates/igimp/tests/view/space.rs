//! GOAL: runs in space in a browser.
//! ORACLE: counts and lengths of a cube, and exact solutions.

use crate::support::{CUBE, Folder, View, attribute, browser, dumped, looked_at, results_of};

/// GOAL: a run in space has its pictures, and its page shows the six sides of the body and cuts it.
/// ORACLE: 8³ particles have 6 · 8² faces outside; the level of a particle in the middle settles by γ (H z − z²/2) / E.
#[test]
fn a_run_in_space_is_shown() {
    let folder = Folder::new("space");
    std::fs::write(folder.0.join("case.toml"), CUBE).unwrap();
    let cuts =
        "output.cuts=[{ across = \"y\", at = \"0.6 m\" }, { across = \"z\", at = \"1.1 m\" }]";
    let run = folder.igimp(&["run", "case.toml", "--quiet", "--set", cuts]);
    let printed = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(run.status.success(), "{printed}");
    let figures = folder.0.join("results/figures");
    for field in ["displacement", "sigma_zz"] {
        for kind in ["space", "cut-y", "cut-z"] {
            let name = format!("{kind}-1-own-weight-{field}.png");
            assert!(figures.join(&name).is_file(), "{name}");
        }
    }
    let report = std::fs::read_to_string(folder.0.join("results/report.html")).unwrap();
    assert!(report.contains("in the plane z = 1.1 m: the domains that it crosses."));
    assert_eq!(report.matches("class=\"held-frame\"").count(), 3);
    let Some(browser) = browser() else {
        return;
    };
    let view = View::of(&folder, "results");
    let page = looked_at(
        browser,
        &folder,
        &view,
        "cut=1,0.55&view=front&hover=0.5,0.5",
    );
    assert_eq!(attribute(&page, "canvas", "data-faces"), "384");
    // The edges of a cube of 2 m, which settles by some tenths of a millimetre.
    let length: f64 = attribute(&page, "canvas", "data-edge-length")
        .parse()
        .unwrap();
    assert!((length - 24.0).abs() < 0.02, "{length}");
    // The cut is a square of 2 m.
    let seams: f64 = attribute(&page, "canvas", "data-seam-length")
        .parse()
        .unwrap();
    assert!((seams - 8.0).abs() < 0.01, "{seams}");
    // A plane that dips by 45° through the middle of the cube crosses it in a rectangle of 2 m by 2√2 m.
    let slanted = looked_at(browser, &folder, &view, "cut=3,0.5,1,0,45&view=front");
    if attribute(&slanted, "canvas", "data-by") == "webgl2" {
        let area = attribute(&slanted, "canvas", "data-cut-area");
        let area: f64 = area.parse().unwrap();
        assert!((area - 4.0 * 2.0_f64.sqrt()).abs() < 0.01 * area, "{area}");
        let seams: f64 = attribute(&slanted, "canvas", "data-seam-length")
            .parse()
            .unwrap();
        let wanted = 4.0 + 4.0 * 2.0_f64.sqrt();
        assert!((seams - wanted).abs() < 0.01 * wanted, "{seams}");
    }
    // From half of the scale on, which runs from the lowest layer's 1 − (15/16)² to the highest one's 1 − (1/16)²: z/H > 0.34, the upper
    // five of eight layers.
    let upper = looked_at(browser, &folder, &view, "least=50");
    assert_eq!(attribute(&upper, "canvas", "data-particles"), "320");
    assert_eq!(attribute(&upper, "canvas", "data-faces"), "3072");
    let value: f64 = attribute(&page, "found", "data-value").parse().unwrap();
    let (_, text) = page.split_once("m: displacement length ").unwrap();
    let z: f64 = page
        .split_once(") m: displacement")
        .unwrap()
        .0
        .rsplit(", ")
        .next()
        .unwrap()
        .parse()
        .unwrap();
    let settled = 18e3 * (2.0 * z - 0.5 * z * z) / 10e6;
    assert!(
        (value - settled).abs() < 0.02 * settled,
        "{value} for {settled}: {text:.20}"
    );
}

/// GOAL: a section is drawn by hand on the face of a cut. ORACLE: γ times the depth, within half a particle of 0.25 m.
#[test]
fn a_section_is_drawn_on_a_cut() {
    let Some(browser) = browser() else {
        return;
    };
    let more = ["--set", "output.figures=[]"];
    let folder = results_of("section-in-space", CUBE, &more);
    let view = View::of(&folder, "results");
    let field = "sigma%20[Pa],%20tension%20%2B,%20zz";
    let wishes = format!("cut=1,0.55&field={field}&section=1.1,1.1,1.7,1.1,1.1,0.3");
    let page = looked_at(browser, &folder, &view, &wishes);
    for (end, depth) in [("data-first", 0.3), ("data-last", 1.7)] {
        let value: f64 = attribute(&page, "section", end).parse().unwrap();
        assert!(
            (value + 18e3 * depth).abs() < 0.5 * 0.25 * 18e3,
            "{end}: {value}"
        );
    }
    assert_eq!(attribute(&page, "section", "data-places"), "201");
    assert!(page.contains("from (1.1, 1.1, 1.7) to (1.1, 1.1, 0.3) m"));
}

/// GOAL: a search in space has the surface over which the slope slides, as a table and on its page.
/// ORACLE: the surface lies in the ground, above the base on which soil stands; on the plane of symmetry it reaches from behind the
/// crest, at x = 7 m, to the face below.
#[test]
fn a_search_in_space_shows_where_soil_slips() {
    let shipped = include_str!("../../../igimp-input/cases/slope_3d.toml");
    let (before, _) = shipped
        .split_once("[[stages]]\nname = \"to collapse\"")
        .unwrap();
    let case = format!(
        "{before}[[stages]]\nname = \"safety\"\ntype = \"strength-reduction\"\n[output]\nfigures = []\n"
    );
    let folder = results_of("slip-in-space", &case, &[]);
    let table = std::fs::read_to_string(folder.0.join("results/slip_lines/2-safety.csv")).unwrap();
    let mut rows = table.lines();
    assert_eq!(rows.next(), Some("x_[m],y_[m],z_[m]"));
    let point = |row: &str| -> [f64; 3] {
        let numbers: Vec<f64> = row.split(',').map(|part| part.parse().unwrap()).collect();
        numbers.try_into().unwrap()
    };
    let points: Vec<[f64; 3]> = rows.map(point).collect();
    let ground = |x: f64| (17.0 - x).clamp(5.0, 10.0);
    for [x, _, z] in &points {
        assert!((1.0..ground(*x)).contains(z), "{x} {z}");
    }
    let middle = points.iter().filter(|[_, y, _]| *y < 0.5);
    let ends = middle.fold([f64::MAX, f64::MIN], |[a, b], [x, ..]| {
        [a.min(*x), b.max(*x)]
    });
    assert!(ends[0] < 7.0 && ends[1] > 9.0, "{ends:?}");
    let Some(browser) = browser() else {
        return;
    };
    let view = View::of(&folder, "results");
    let page = looked_at(browser, &folder, &view, "cut=1,0.4");
    let corners: usize = attribute(&page, "canvas", "data-slip-cut").parse().unwrap();
    assert!(corners > 2, "{corners}");
    assert!(page.contains("red: where soil shears most as it fails"));
}

/// GOAL: in space the free surface of a computed flow is drawn over its frames, and stands out where the cut meets it.
/// ORACLE: a pond over the cube stands at its level throughout.
#[test]
fn water_in_space_is_drawn() {
    let case = CUBE
        .replace("unit_weight = \"18 kN/m3\"", "unit_weight = \"18 kN/m3\"\nsaturated_unit_weight = \"20 kN/m3\"\npermeability = \"1e-6 m/s\"")
        .replace("[[stages]]", "[[water]]\nname = \"pool\"\n[water.seepage]\nfree_water = [[\"0 m\", \"2.5 m\"], [\"2 m\", \"2.5 m\"]]\n\n[[stages]]")
        .replace("figures = [\"displacement\", \"sigma_zz\"]", "figures = []");
    let folder = results_of("water-in-space", &case, &[]);
    let view = View::of(&folder, "results");
    let index: serde_json::Value = serde_json::from_str(&view.get("index.json").2).unwrap();
    let surface = &index["over"][0]["water"][0];
    let places = serde_json::json!([0.0, 0.5, 1.0, 1.5, 2.0]);
    assert_eq!((&surface["x"], &surface["y"]), (&places, &places));
    let levels: Vec<f64> = (surface["z"].as_array().unwrap().iter())
        .flat_map(|row| row.as_array().unwrap())
        .filter_map(serde_json::Value::as_f64)
        .collect();
    assert_eq!(levels.len(), 25);
    let off = |level: &f64| (level - 2.5).abs();
    assert!(levels.iter().all(|level| off(level) < 1e-6), "{levels:?}");
    let Some(browser) = browser() else {
        return;
    };
    let page = looked_at(browser, &folder, &view, "frame=2&cut=1,0.55");
    assert_eq!(attribute(&page, "canvas", "data-water"), "1");
    let met: usize = attribute(&page, "canvas", "data-water-cut")
        .parse()
        .unwrap();
    assert!(met >= 4, "{met}");
}

/// Two layers of the cube, the lower one of another material.
fn layered() -> String {
    let lower = "[materials.sand]\nmodel = \"elastic\"\nunit_weight = \"20 kN/m3\"\nyoung = \"20 MPa\"\npoisson = 0.0\n\
        [[bodies]]\nname = \"below\"\nmaterial = \"sand\"\npoints_per_cell = 8\n\
        box = { from = [\"0 m\", \"0 m\", \"0 m\"], to = [\"2 m\", \"2 m\", \"1 m\"] }\n[[stages]]";
    CUBE.replace(
        "from = [\"0 m\", \"0 m\", \"0 m\"]",
        "from = [\"0 m\", \"0 m\", \"1 m\"]",
    )
    .replace("[[stages]]", lower)
}

/// GOAL: each body in space has its outline, in the report as on the page; a cut shows where two soils meet; contours stand at the
/// ticks of the scale, with their values.
/// ORACLE: the edges of two boxes of 2 m by 2 m by 1 m, and of the square of 2 m with the line between them.
#[test]
fn bodies_in_space_have_their_outlines() {
    let Some(browser) = browser() else {
        return;
    };
    let more = ["--set", "output.figures=[]"];
    let folder = results_of("outlines-in-space", &layered(), &more);
    let view = View::of(&folder, "results");
    let wishes = "cut=1,0.55&view=front&contours=values";
    let page = looked_at(browser, &folder, &view, wishes);
    let report = format!(
        "file://{}#look&{wishes}",
        folder.0.join("results/report.html").display()
    );
    for page in [page, dumped(browser, &folder, &report, 15)] {
        let length = |name: &str| -> f64 { attribute(&page, "canvas", name).parse().unwrap() };
        assert!((length("data-edge-length") - 40.0).abs() < 0.05);
        assert!((length("data-seam-length") - 10.0).abs() < 0.02);
        let levels = attribute(&page, "canvas", "data-contour-levels");
        assert!(levels.split(' ').count() > 3, "{levels}");
        // An ordinary canvas has no contours in space.
        let labels = length("data-contour-labels");
        assert_eq!(
            labels > 1.0,
            page.contains("data-by=\"webgl2\""),
            "{labels}"
        );
    }
}
