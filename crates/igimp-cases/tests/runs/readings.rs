//! GOAL: monitors and sections read the field and not the stair of the cells: stress that follows from strain is the same all over
//! a cell. CASE: level elastic ground under its weight, raised by steps or at rest, in the plane and in space.
//! ORACLE: the vertical stress of level ground, its unit weight times the depth.

use igimp_cases::run::{Run, in_memory};
use igimp_input::CaseFile;
use igimp_results::tables::table::Table;

const GAMMA: f64 = 18e3;
const HEIGHT: f64 = 1.5;
const HEIGHTS: [f64; 9] = [0.02, 0.26, 0.4, 0.5, 0.51, 0.98, 1.26, 1.4, 1.49];

fn ground(dimension: &str, stage: &str, points: usize, locking: &str) -> CaseFile {
    let is_plane = dimension == "plane";
    let (analysis, domain, body, up) = if is_plane {
        (
            "plane-strain",
            r#"x = ["0 m", "1 m"], y = ["0 m", "1.75 m"]"#,
            r#"polygon = [["0 m","0 m"], ["1 m","0 m"], ["1 m","1.5 m"], ["0 m","1.5 m"]]"#,
            "yy",
        )
    } else {
        (
            "3d",
            r#"x = ["0 m", "0.5 m"], y = ["0 m", "0.5 m"], z = ["0 m", "1.75 m"]"#,
            r#"box = { from = ["0 m", "0 m", "0 m"], to = ["0.5 m", "0.5 m", "1.5 m"] }"#,
            "zz",
        )
    };
    let point = |height: f64| {
        if is_plane {
            format!(r#"["0.7 m", "{height} m"]"#)
        } else {
            format!(r#"["0.3 m", "0.2 m", "{height} m"]"#)
        }
    };
    let monitors = HEIGHTS.iter().enumerate().map(|(k, &height)| {
        format!(
            "[[monitors]]\nname = \"m{k}\"\npoint = {}\nrecord = [\"sigma_{up}\"]\n",
            point(height)
        )
    });
    let monitors: String = monitors.collect();
    let text = format!(
        r#"
igimp = 1
[case]
title = "level ground"
analysis = "{analysis}"
[grid]
locking = "{locking}"
cell = "0.25 m"
domain = {{ {domain} }}
[materials.soil]
model = "elastic"
unit_weight = "18 kN/m3"
young = "5 GPa"
poisson = 0.3
k0 = 0.5
[[bodies]]
name = "soil"
material = "soil"
points_per_cell = {points}
{body}
[[stages]]
name = "weight"
{stage}
[[sections]]
name = "s"
from = {}
to = {}
points = 61
record = ["sigma_{up}"]
{monitors}
[output]
figures = []
"#,
        point(0.0),
        point(HEIGHT)
    );
    CaseFile::parse("ground.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// The largest error of monitors and section over the stress at the base.
fn error<const D: usize>(run: &Run<D>) -> f64 {
    let exact = |height: f64| GAMMA * (HEIGHT - height);
    let of_monitor = |(table, height): (&Table, &f64)| {
        let last = table.rows.last().unwrap();
        (last.last().unwrap() - exact(*height)).abs()
    };
    let monitors = std::iter::zip(&run.monitors, &HEIGHTS).map(of_monitor);
    let section = run.sections[0].rows.iter();
    let section = section.map(|row| (row[D + 1] - exact(row[D])).abs());
    let largest = monitors.chain(section).fold(0.0, f64::max);
    largest / exact(0.0)
}

#[test]
fn stress_of_level_ground_is_linear_at_any_height() {
    let weight = "type = \"gravity\"\nsteps = 2";
    let rest = "type = \"k0\"";
    for (stage, points, locking) in [
        (weight, 4, "none"),
        (weight, 9, "none"),
        (weight, 16, "shared-strain"),
        (weight, 9, "b-bar"),
        (rest, 4, "none"),
        (rest, 9, "none"),
    ] {
        let file = ground("plane", stage, points, locking);
        let error = error(&in_memory::<2>(file.case()).unwrap());
        assert!(error < 1e-2, "{stage}, {points}, {locking}: {error}");
    }
}

#[test]
fn stress_of_level_ground_is_linear_in_space() {
    for points in [8, 27] {
        let file = ground("space", "type = \"gravity\"", points, "none");
        let run = in_memory::<3>(file.case_in_space());
        let error = error(&run.unwrap());
        assert!(error < 1e-2, "{points}: {error}");
    }
}
