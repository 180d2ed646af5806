//! GOAL: the page in a browser: its frames, values, curves and sections, those of motions, and two runs.
//! ORACLE: the tables of the run, and exact solutions.

use std::time::Duration;

use crate::support::{Folder, View, attribute, browser, dumped, looked_at, results_of};

/// GOAL: the page loads, the slider moves, and the value under the pointer is that of the table.
#[test]
fn the_page_works_in_a_browser() {
    let Some(browser) = browser() else {
        return;
    };
    let folder = Folder::with_results("browser", &[]);
    let table = std::fs::read_to_string(folder.0.join("results/monitors/top ü.csv")).unwrap();
    let number = |row: usize, column: usize| -> f64 {
        let line = table.lines().nth(row + 1).unwrap();
        line.split(',').nth(column).unwrap().parse().unwrap()
    };
    let view = View::of(&folder, "results");
    // The monitor stands in the middle of a particle, whose stress is that of its cell: of the weight above the middle of the
    // cell, a quarter of a metre down. Each look starts a browser: every frame once, and both fields.
    let displacement = "displacement%20[m],%20length";
    let stress = "sigma%20[Pa],%20tension%20%2B,%20yy";
    for (frame, field) in [
        (1, displacement),
        (2, stress),
        (3, displacement),
        (3, stress),
    ] {
        let wishes = format!("frame={frame}&field={field}&hover=0.9,1.85");
        let page = looked_at(browser, &folder, &view, &wishes);
        let value: f64 = attribute(&page, "found", "data-value").parse().unwrap();
        let (expected, off) = if field == stress {
            (-18e3 * 0.25 * frame as f64 / 3.0, 0.01)
        } else {
            (number(frame, 3), 1e-6)
        };
        assert!(
            (value - expected).abs() <= off * expected.abs(),
            "frame {frame}, {field}: {value} for {expected}"
        );
        let label = attribute(&page, "slider", "aria-valuetext");
        assert_eq!(
            label,
            format!("Frame {frame} of 4: stage 1 “own weight”, step {frame}")
        );
        assert!(
            page.contains("a &lt;b&gt;block&lt;/b&gt;"),
            "the title is text"
        );
        // The cursor of curve and monitor is on the row of the frame.
        assert_eq!(page.matches(&format!("data-row=\"{frame}\"")).count(), 3);
    }
    // Played from the first frame to the last, with the particle that was pointed at.
    let page = looked_at(browser, &folder, &view, "frame=1&hover=0.9,1.85&play=1");
    assert!(attribute(&page, "slider", "aria-valuetext").starts_with("Frame 4 of 4"));
    let value: f64 = attribute(&page, "found", "data-value").parse().unwrap();
    assert!((value - number(3, 3)).abs() <= 1e-6 * number(3, 3));
}

/// GOAL: rigid bodies are drawn as their frames have them, with their histories beside; tables of contact
/// along their sides are no histories.
#[test]
fn rigid_bodies_are_drawn_where_they_stand() {
    let Some(browser) = browser() else {
        return;
    };
    let folder = Folder::new("bodies");
    let case = include_str!("../../../igimp-cases/tests/data/two_bodies.toml");
    std::fs::write(folder.0.join("case.toml"), case).unwrap();
    let run = folder.igimp(&["run", "case.toml", "--quiet", "--out", "results"]);
    assert!(run.status.success());
    let view = View::of(&folder, "results");
    for frame in [1, 3] {
        let name = format!("results/paraview/rigid_{frame:04}.vtu");
        let text = std::fs::read_to_string(folder.0.join(name)).unwrap();
        let page = looked_at(browser, &folder, &view, &format!("frame={frame}"));
        let lines = attribute(&page, "canvas", "data-lines");
        assert!(
            text.contains(&format!("NumberOfCells=\"{lines}\"")),
            "{lines}"
        );
        assert_eq!(lines == "0", frame == 1);
        assert!(page.contains("footing: ") && !page.contains("__3-load"));
    }
}

/// GOAL: frames that come while the page is looked at are taken up.
#[test]
fn the_page_follows_a_run() {
    let Some(browser) = browser() else {
        return;
    };
    let folder = Folder::with_results("live", &[]);
    let view = View::of(&folder, "results");
    let frames = folder.0.join("results/paraview");
    let page = std::thread::scope(|scope| {
        // A thousand questions for new frames, which take longer than the pause below.
        let page = scope.spawn(|| dumped(browser, &folder, &view.address(), 2000));
        std::thread::sleep(Duration::from_millis(1500));
        std::fs::copy(
            frames.join("particles_0001.vtu"),
            frames.join("particles_0005.vtu"),
        )
        .unwrap();
        let collection = frames.join("particles.pvd");
        let text = std::fs::read_to_string(&collection).unwrap();
        let line = "<DataSet timestep=\"4\" group=\"\" part=\"0\" file=\"particles_0005.vtu\"/>\n";
        let text = text.replace("</Collection>", &format!("{line}</Collection>"));
        std::fs::write(collection, text).unwrap();
        page.join().unwrap()
    });
    let label = attribute(&page, "slider", "aria-valuetext");
    assert!(label.starts_with("Frame 5 of 5"), "{label}");
}

#[test]
fn the_page_says_how_to_get_frames() {
    let Some(browser) = browser() else {
        return;
    };
    let folder = Folder::with_results(
        "no-frames",
        &["--set", "output.paraview={ every = \"never\" }"],
    );
    let view = View::of(&folder, "results");
    let page = looked_at(browser, &folder, &view, "");
    assert!(page.contains("This run writes no frames"), "{page}");
    assert!(
        page.contains("class=\"curve\""),
        "the curves are there all the same"
    );
}

/// GOAL: a report holds its frames, unless the last cannot be read or its file is a link.
#[test]
fn a_report_holds_its_frames() {
    let folder = Folder::with_results("report", &[]);
    let results = folder.0.join("results");
    let report = || {
        assert!(folder.igimp(&["report", "results"]).status.success());
        std::fs::read_to_string(results.join("report.html")).unwrap()
    };
    let frame = results.join("paraview/particles_0004.vtu");
    let text = std::fs::read_to_string(&frame).unwrap();
    let page = report();
    assert_eq!(page.matches("class=\"held-frame\"").count(), 4);
    assert!(page.contains("data-label=\"Frame 4 of 4, stage “own weight”, step 3\""));
    if let Some(browser) = browser() {
        let address = format!("file://{}#soil", results.join("report.html").display());
        let page = dumped(browser, &folder, &address, 15);
        assert!(page.contains("<p id=\"bar-label\" class=\"soft\">displacement length [mm]</p>"));
        let (_, ticks) = page.split_once("id=\"ticks\">").unwrap();
        assert!(ticks.starts_with("<span"), "the scale was drawn");
    }
    // A name that would end the script is a text within it.
    let name = "Name=\"mass [kg/m]\"";
    let other = text.replace(
        name,
        "Name=\"&lt;/SCRIPT&gt;&lt;script&gt;alert(1)&lt;/script&gt;\"",
    );
    assert_ne!(text, other);
    std::fs::write(&frame, other).unwrap();
    let page = report();
    assert!(page.contains("\\u003c/SCRIPT>\\u003cscript>alert") && !page.contains("<script>alert"));
    std::fs::write(&frame, " ".repeat(3_100_000)).unwrap();
    assert!(!report().contains("A closer look"));
    std::fs::remove_file(&frame).unwrap();
    std::os::unix::fs::symlink(folder.0.join("case.toml"), &frame).unwrap();
    assert!(!report().contains("A closer look"));
}

/// Elastic soil that falls freely under 10 m/s², by Newmark's method, which is exact there; a frame every 0.1 s.
const FALL: &str = "igimp = 1\n[case]\ntitle = \"a fall\"\ngravity = \"10 m/s2\"\n\
    [grid]\ncell = \"1 m\"\ndomain = { x = [\"0 m\", \"4 m\"], y = [\"0 m\", \"8 m\"] }\n\
    [materials.clay]\nmodel = \"elastic\"\nunit_weight = \"20 kN/m3\"\nyoung = \"10 MPa\"\npoisson = 0.3\n\
    [[bodies]]\nname = \"block\"\nmaterial = \"clay\"\npoints_per_cell = 4\n\
    polygon = [[\"1 m\", \"4 m\"], [\"3 m\", \"4 m\"], [\"3 m\", \"6 m\"], [\"1 m\", \"6 m\"]]\n\
    [[stages]]\nname = \"fall\"\ntype = \"dynamic\"\nduration = \"0.4 s\"\nscheme = \"newmark\"\nsteps = 4\n\
    [output]\nfolder = \"results\"\nfigures = [\"speed\"]\n";

/// GOAL: frames of a motion say their times and have its fields, on the page and in the report; the report draws the energy.
/// ORACLE: a body that falls freely has the speed g t.
#[test]
fn a_motion_is_shown_with_its_times() {
    let folder = results_of("motion", FALL, &[]);
    let report = std::fs::read_to_string(folder.0.join("results/report.html")).unwrap();
    for (frame, time) in [(1, "0"), (3, "0.2"), (5, "0.4")] {
        let label = format!("data-label=\"Frame {frame} of 5, t = {time} s, stage “fall”\"");
        assert!(report.contains(&label), "{label}");
    }
    assert!(report.contains("data-seconds=\"0.4\""));
    assert!(report.contains("Energy of stage “fall” over time"));
    assert!(report.contains("Speed |v| at the end of stage “fall”, at t = 0.4 s."));
    let Some(browser) = browser() else {
        return;
    };
    let view = View::of(&folder, "results");
    for (frame, seconds) in [(1, 0.0), (3, 0.2), (5, 0.4)] {
        let wishes = format!(
            "frame={frame}&field=velocity%20[m/s],%20length&hover=2.1,{}&arrows=velocity%20[m/s]",
            5.1 - 5.0 * seconds * seconds
        );
        let page = looked_at(browser, &folder, &view, &wishes);
        let value: f64 = attribute(&page, "found", "data-value").parse().unwrap();
        assert!(
            (value - 10.0 * seconds).abs() < 1e-5,
            "{value} at {seconds} s"
        );
        let label = attribute(&page, "slider", "aria-valuetext");
        assert!(
            label.starts_with(&format!("Frame {frame} of 5: t = {seconds} s, ")),
            "{label}"
        );
        assert!(
            page.contains(">speed [m/s]<"),
            "the length of a velocity has its name"
        );
        assert_eq!(attribute(&page, "canvas", "data-pieces"), "16");
        if seconds > 0.0 {
            assert!(
                attribute(&page, "canvas", "data-arrows")
                    .parse::<usize>()
                    .unwrap()
                    > 10
            );
        }
    }
    // Four seconds or more at first: 0.4 s are shown ten times slower.
    let page = looked_at(browser, &folder, &view, "frame=1&play=1");
    assert!(!page.contains("id=\"pace-label\" hidden"));
    assert!(attribute(&page, "slider", "aria-valuetext").starts_with("Frame 5 of 5"));
}

/// GOAL: histories of a case that takes time are drawn over it, with a chart for every quantity and none for the time.
/// CASE: a fall with a monitor of the displacement. ORACLE: the header of its table.
#[test]
fn histories_are_drawn_over_time() {
    let monitor = "[[monitors]]\nname = \"middle\"\npoint = [\"2.2 m\", \"5.2 m\"]\nrecord = [\"displacement_y\"]\n[output]";
    let folder = results_of("history", &FALL.replace("[output]", monitor), &[]);
    let table = std::fs::read_to_string(folder.0.join("results/monitors/middle.csv")).unwrap();
    assert!(
        table.starts_with("stage,step,progress_[-],time_[s],displacement_y_[m]\n"),
        "{table}"
    );
    let Some(browser) = browser() else {
        return;
    };
    let view = View::of(&folder, "results");
    let page = looked_at(browser, &folder, &view, "frame=1");
    assert!(page.contains("middle: displacement y [m]") && page.contains("time [s]"));
    assert!(!page.contains("middle: time"));
}

/// GOAL: a section across a body has the stress of its weight; the edges of the body are drawn.
/// ORACLE: γ times the depth, within half a particle of 0.25 m.
#[test]
fn a_section_is_drawn_by_hand() {
    let Some(browser) = browser() else {
        return;
    };
    let folder = Folder::with_results("section", &[]);
    let view = View::of(&folder, "results");
    let field = "sigma%20[Pa],%20tension%20%2B,%20yy";
    let wishes = format!("frame=3&field={field}&section=1.1,1.7,1.1,0.3");
    let page = looked_at(browser, &folder, &view, &wishes);
    for (end, depth) in [("data-first", 0.3), ("data-last", 1.7)] {
        let value: f64 = attribute(&page, "section", end).parse().unwrap();
        assert!(
            (value + 18e3 * depth).abs() < 0.5 * 0.25 * 18e3,
            "{end}: {value}"
        );
    }
    assert_eq!(attribute(&page, "section", "data-places"), "201");
    assert_eq!(attribute(&page, "canvas", "data-edges"), "1");
    assert!(page.contains("sigma yy [kPa], tension + along A–B, from (1.1, 1.7) to (1.1, 0.3) m"));
}

/// GOAL: two runs stand side by side, each with its own files, and choices in the first count in the second.
/// ORACLE: the third of four frames, of both; the colours go as far as the softer run, which moves twice as much.
#[test]
fn two_runs_stand_side_by_side() {
    let folder = Folder::with_results("beside", &[]);
    let softer = ["--set", "materials.clay.young=5 MPa", "--out", "softer"];
    let run = folder.igimp(&[&["run", "case.toml", "--quiet"], &softer[..]].concat());
    assert!(run.status.success());
    let view = View::with(&folder, &["results", "--beside", "softer"]);
    let (status, head, page) = view.get("");
    assert_eq!(status, 200);
    assert!(head.contains("frame-src 'self'") && head.contains("frame-ancestors 'none'"));
    assert!(!page.contains("NONCE"));
    for (run, name) in [(1, "results"), (2, "softer")] {
        let (_, head, _) = view.get(&format!("{run}/"));
        assert!(head.contains("frame-ancestors 'self'"), "{head}");
        let index = view.get(&format!("{run}/index.json")).2;
        let index: serde_json::Value = serde_json::from_str(&index).unwrap();
        assert_eq!(index["folder"], name);
        assert_eq!(view.get(&format!("{run}/curves/settlement.csv")).0, 200);
    }
    for name in [
        "index.json",
        "3/index.json",
        "1/../2/index.json",
        "curves/settlement.csv",
    ] {
        assert_eq!(view.get(name).0, 404, "{name}");
    }
    let Some(browser) = browser() else {
        return;
    };
    let page = looked_at(browser, &folder, &view, "frame=3");
    for run in ["data-run1", "data-run2"] {
        let (_, label) = page.split_once(&format!("{run}=\"")).unwrap();
        assert!(label.starts_with("Frame 3 of 4"), "{label:.40}");
    }
    let scale = |run: u32| -> Vec<f64> {
        let (_, text) = page.split_once(&format!("data-scale{run}=\"")).unwrap();
        let (text, _) = text.split_once('"').unwrap();
        text.split(' ').map(|part| part.parse().unwrap()).collect()
    };
    assert_eq!(scale(1), scale(2));
    // The middle of the highest particle, of the four levels to a metre: γ (H z − z²/2) / E.
    let z = 1.875;
    let settled = 18e3 * (2.0 * z - 0.5 * z * z) / 5e6;
    let most = scale(1)[1];
    assert!(
        (most - settled).abs() < 0.02 * settled,
        "{most} for {settled}"
    );
}
