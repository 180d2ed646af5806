//! Results of rigid bodies: contact along their sides, frames, pictures, the report.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use igimp_cases::run::Run;

use crate::with_report;

const TEXT: &str = include_str!("../data/two_bodies.toml");

/// The case of two bodies, run into a folder of the build with pictures and a report.
fn written() -> &'static (PathBuf, Run<2>) {
    static ONCE: OnceLock<(PathBuf, Run<2>)> = OnceLock::new();
    ONCE.get_or_init(|| with_report(("two_bodies.toml", TEXT), "rigid-results"))
}

/// Header and rows of a table.
fn table(path: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let header = reader.headers().unwrap().iter().map(str::to_owned);
    let header = header.collect();
    let row = |row: csv::StringRecord| row.iter().map(|cell| cell.parse().unwrap()).collect();
    (
        header,
        reader.records().map(|line| row(line.unwrap())).collect(),
    )
}

/// GOAL: pressure and shear along the sides balance the force on a body.
/// ORACLE: the force that its stage states, with its weight.
#[test]
fn contact_along_the_sides_balances_the_force() {
    let (folder, ..) = written();
    let (header, rows) = table(&folder.join("rigid/footing__3-load.csv"));
    assert_eq!(
        header.join(" "),
        "side distance_[m] x_[m] y_[m] pressure_[Pa]_compression_+ shear_on_soil_[Pa]_anticlockwise_+ \
         gap_[m] contact_[m] closed_[-] slips_[-]"
    );
    let (_, history) = table(&folder.join("rigid/footing.csv"));
    // Directions of contact are those of the beginning of a step.
    let rotation = history[history.len() - 2][7];
    let mut force = [0.0; 2];
    for row in &rows {
        // Sides of a rectangle: bottom, right, top, left.
        let normal = rotation + [-90.0_f64, 0.0, 90.0, 180.0][row[0] as usize - 1].to_radians();
        let (n, t) = ([normal.cos(), normal.sin()], [-normal.sin(), normal.cos()]);
        for axis in 0..2 {
            force[axis] -= (row[4] * n[axis] + row[5] * t[axis]) * row[7];
        }
    }
    // Forces of the stage, and the weight, hang on it.
    assert!(force[0].abs() < 1e-6 * 52e3, "{force:?}");
    assert!((force[1] / 52e3 - 1.0).abs() < 1e-6, "{force:?}");
    let base: Vec<_> = rows.iter().filter(|row| row[0] < 1.5).collect();
    assert!(base.iter().all(|row| row[8] > 0.5 && row[6].abs() < 0.01));
    assert!(base.windows(2).all(|pair| pair[0][1] < pair[1][1]));
    let top = rows.iter().filter(|row| (2.5..3.5).contains(&row[0]));
    for row in top {
        assert!(
            row[4] == 0.0 && row[6].is_nan(),
            "nothing is above: {row:?}"
        );
    }
    assert!(folder.join("rigid/footing__2-seat.csv").exists());
    assert!(!folder.join("rigid/footing__1-weight.csv").exists());
    // Around a circle, from the point at its right.
    let (_, pipe) = table(&folder.join("rigid/pipe__3-load.csv"));
    let around = std::f64::consts::TAU * 0.4;
    assert!(pipe.windows(2).all(|pair| pair[0][1] < pair[1][1]));
    assert!(pipe.last().unwrap()[1] < around);
    let deepest = pipe.iter().max_by(|a, b| a[4].total_cmp(&b[4])).unwrap();
    assert!((deepest[1] / around - 0.75).abs() < 0.1, "{deepest:?}");
}

/// A disc on ground around an axis, let go by its weight.
const DISC: &str = r#"igimp = 1
[case]
title = "a disc on ground around an axis"
analysis = "axisymmetric"
[grid]
cell = "0.5 m"
domain = { x = ["0 m", "3 m"], y = ["0 m", "4 m"] }
[materials.s]
model = "elastic"
unit_weight = "20 kN/m3"
young = "100 MPa"
poisson = 0.3
[[bodies]]
name = "ground"
material = "s"
polygon = [["0 m", "0 m"], ["3 m", "0 m"], ["3 m", "2 m"], ["0 m", "2 m"]]
[[rigid]]
name = "disc"
type = "rectangle"
from = ["0 m", "2 m"]
to = ["1 m", "3 m"]
interface = { friction = 0.4 }
rounding = 0
weight = "100 kN"
[[stages]]
name = "weight"
type = "gravity"
[[stages]]
name = "seat"
type = "rigid"
bodies = [{ body = "disc", free = ["y"] }]
[output]
figures = []
report = false
"#;

/// GOAL: around an axis contact is told by area, and the force on a body along the axis alone.
/// ORACLE: the weight of the body, which the pressure on its base carries; all that points away from the axis sums to nothing.
#[test]
fn a_body_of_revolution_has_no_force_across_its_axis() {
    let (folder, _) = with_report(("disc.toml", DISC), "rigid-of-revolution");
    let (header, rows) = table(&folder.join("rigid/disc__2-seat.csv"));
    assert_eq!(header[7], "contact_[m2]");
    let base = rows.iter().filter(|row| row[0] < 1.5);
    let carried: f64 = base.map(|row| row[4] * row[7]).sum();
    assert!((carried / 100e3 - 1.0).abs() < 1e-6, "{carried}");
    let (header, history) = table(&folder.join("rigid/disc.csv"));
    let last = |name: &str| {
        let column = header.iter().position(|entry| entry == name).unwrap();
        history.last().unwrap()[column]
    };
    let across = [last("force_x_[N]"), last("moment_[N m]")];
    assert!(across.iter().all(|x| x.abs() < 1e-15), "{across:?}");
    assert!(last("force_y_[N]").abs() < 1e-6 * 100e3);
}

/// GOAL: bodies have frames beside those of the soil, at the same times.
#[test]
fn frames_show_the_bodies() {
    let (folder, ..) = written();
    let read = |name: &str| fs::read_to_string(folder.join("paraview").join(name)).unwrap();
    let (soil, bodies) = (read("particles.pvd"), read("rigid.pvd"));
    assert_eq!(soil.replace("particles_", "rigid_"), bodies);
    let last = bodies.matches("<DataSet").count();
    assert!(last > 3, "a run is a film: {bodies}");
    let frame = read(&format!("rigid_{last:04}.vtu"));
    for name in [
        "contact pressure [Pa], compression +",
        "shear on soil [Pa], anticlockwise +",
        "traction on body [Pa]",
        "gap [m]",
    ] {
        assert!(frame.contains(&format!("Name=\"{name}\"")), "{name}");
    }
    // Nothing is there before it is placed.
    assert!(read("rigid_0001.vtu").contains("NumberOfPoints=\"0\""));
}

/// GOAL: every picture draws the bodies, the report tells of them.
#[test]
fn pictures_and_report_show_the_bodies() {
    let (folder, run) = written();
    let read = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    // The grey of blocks, once for each body.
    let blocks = |name: &str| read(name).matches("#cdcdcd").count();
    let counts = [
        "model",
        "field-1-weight-displacement",
        "field-3-load-displacement",
    ]
    .map(|name| blocks(&format!("figures/{name}.svg")));
    // The key of the model has a sample besides.
    assert_eq!(counts, [3, 0, 2]);
    let page = read("report.html");
    for text in [
        "Rigid bodies",
        "circle about (4.5, 2.4)",
        "footing__3-load.csv",
        "rigid.pvd",
        "class=\"held-bodies\"",
    ] {
        assert!(page.contains(text), "{text}");
    }
    assert_eq!(run.body.rigid.len(), 2);
}
