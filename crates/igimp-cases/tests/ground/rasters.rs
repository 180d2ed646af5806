//! Properties of materials by points in the plane: reading, values of particles, refusals.

use std::fmt::Write as _;

use igimp_cases::run::Model;
use igimp_input::CaseFile;
use igimp_model::{Case, Profile};
use igimp_report::setup;

use crate::folder::Folder;

const TEXT: &str = r#"
igimp = 1

[case]
title = "Ground from a raster"

[grid]
cell = "0.5 m"
domain = { x = ["0 m", "4 m"], y = ["0 m", "2 m"] }

[materials.clay]
model = "tresca"
cu = CU
unit_weight = "18 kN/m3"
young = "20 MPa"
poisson = 0.45

[[bodies]]
name = "clay"
material = "clay"
polygon = [["0 m", "0 m"], ["4 m", "0 m"], ["4 m", "2 m"], ["0 m", "2 m"]]

[[stages]]
name = "weight"
type = "gravity"
"#;

/// Strength over the plane \[kPa\]: bilinear.
fn exact([x, y]: [f64; 2]) -> f64 {
    20.0 + 3.0 * x - 4.0 * y + 2.0 * x * y
}

fn with(cu: &str) -> String {
    TEXT.replace("CU", cu)
}

/// The raster at some x and y, with a header, the values times a factor.
fn raster(header: &str, xs: &[f64], ys: &[f64], [length, value]: [f64; 2]) -> String {
    let mut text = format!("{header}\n");
    for &x in xs {
        for &y in ys {
            let value = exact([x, y]) * value;
            let _ = writeln!(text, "{},{},{value}", x * length, y * length);
        }
    }
    text
}

fn strengths(case: &Case<2>) -> Vec<([f64; 2], f64)> {
    let (model, state) = Model::new(case).unwrap();
    assert_eq!(model.laws.len(), 1);
    let particles = &state.body.particles;
    let greatest = case.materials[0].cohesive();
    std::iter::zip(&particles.x, &particles.ratios)
        .map(|(x, ratios)| (*x, ratios.strength * greatest))
        .collect()
}

/// GOAL: particles have what a bilinear function has at their centres, from points in any order and any units.
#[test]
fn particles_have_what_the_raster_has() {
    let (xs, ys) = ([0.0, 1.0, 4.0], [2.0, 0.0, 1.5]);
    let feet = 1.0 / 0.3048;
    let psf = 1e3 / 47.880_258_980_335_84;
    let folder = Folder::new(
        "raster",
        &[
            (
                "si.csv",
                &raster("x [m],y [m],cu [kPa]", &xs, &ys, [1.0; 2]),
            ),
            (
                "feet.csv",
                &raster("# borings\nx,y,cu", &xs, &ys, [feet, psf]),
            ),
        ],
    );
    for cu in [
        r#"{ raster = "si.csv" }"#,
        r#"{ raster = "si.csv", unit = "kPa", length_unit = "m" }"#,
        r#"{ raster = "feet.csv", unit = "psf", length_unit = "ft" }"#,
        r#"{ x = ["0 m", "4 m"], y = ["0 m", "2 m"], rows = [["20 kPa", "32 kPa"], ["12 kPa", "40 kPa"]] }"#,
    ] {
        let file = folder
            .read(&with(cu))
            .unwrap_or_else(|error| panic!("{error}"));
        let case = file.case();
        assert!((case.materials[0].cohesive() - 40e3).abs() < 1e-6);
        for (x, strength) in strengths(case) {
            assert!(
                (strength / 1e3 - exact(x)).abs() < 1e-9,
                "{x:?}: {strength}"
            );
        }
        let explained = file.explain();
        assert!(!explained.contains(".csv"), "{explained}");
        let again = CaseFile::parse("again.toml", &explained, &[]).unwrap();
        assert_eq!(again.case().materials, case.materials);
        let rows = format!("{:?}", setup::tables(case));
        assert!(rows.contains("12 kPa to 40 kPa by a raster of"), "{rows}");
    }
}

/// GOAL: soil may lie beyond the points by half their distance, and has there what the edge has.
#[test]
fn the_edge_of_a_raster_reaches_half_a_spacing() {
    let cu = r#"{ x = ["1 m", "3 m"], y = ["0 m", "2 m"], rows = [["20 kPa", "30 kPa"], ["20 kPa", "30 kPa"]] }"#;
    let folder = Folder::new("raster-edge", &[]);
    let file = folder
        .read(&with(cu))
        .unwrap_or_else(|error| panic!("{error}"));
    for (x, strength) in strengths(file.case()) {
        let inside = x[0].clamp(1.0, 3.0);
        assert!((strength - (20e3 + 5e3 * (inside - 1.0))).abs() < 1e-6);
    }
    let Some(Profile::Raster(raster)) = &file.case().materials[0].profiles.strength else {
        panic!("no raster");
    };
    assert_eq!([raster.x.len(), raster.y.len()], [2, 2]);
}

#[test]
fn what_makes_no_raster_is_named() {
    let folder = Folder::new(
        "raster-refused",
        &[
            ("plain.csv", "0,0,20\n4,0,20\n0,2,30\n4,2,30\n"),
            ("hole.csv", "0,0,20\n4,0,\n0,2,30\n4,2,30\n"),
            ("scattered.csv", "0,0,20\n4,0.1,20\n0,2,30\n4,2,30\n"),
            ("short.csv", "0,0,20\n4,0,20\n0,2,30\n"),
            ("twice.csv", "0,0,20\n4,0,20\n0,2,30\n4,2,30\n4,0,21\n"),
            ("narrow.csv", "0,0,20\n1,0,20\n0,2,30\n1,2,30\n"),
            ("zero.csv", "0,0,0\n4,0,0\n0,2,0\n4,2,0\n"),
            ("negative.csv", "0,0,20\n4,0,-20\n0,2,30\n4,2,30\n"),
        ],
    );
    let mut out = String::new();
    let mut tell = |cu: &str| {
        let _ = writeln!(out, "## {cu}\n{}", folder.printed(&with(cu)));
    };
    tell(r#"{ raster = "plain.csv", unit = "kPa" }"#);
    tell(r#"{ raster = "plain.csv", length_unit = "m" }"#);
    tell(r#"{ raster = "plain.csv", length_unit = "m", unit = "kN/m3" }"#);
    tell(r#"{ raster = "plain.csv", length_unit = "m", unit = "kPa", at_top = "1 kPa" }"#);
    for file in [
        "missing",
        "hole",
        "scattered",
        "short",
        "twice",
        "narrow",
        "zero",
        "negative",
    ] {
        tell(&format!(
            r#"{{ raster = "{file}.csv", length_unit = "m", unit = "kPa" }}"#
        ));
    }
    tell(r#"{ x = ["0 m", "4 m"], y = ["0 m", "2 m"] }"#);
    tell(
        r#"{ x = ["0 m", "4 m"], y = ["0 m"], rows = [["20 kPa", "32 kPa"], ["12 kPa", "40 kPa"]] }"#,
    );
    tell(r#"{ x = ["4 m", "0 m"], y = ["0 m"], rows = [["20 kPa", "32 kPa"]] }"#);
    tell(r#"{ x = ["0 m", "4 m"], y = ["0 m"], rows = [["20 kPa", "32 kPa"]], at_top = "1 kPa" }"#);
    insta::assert_snapshot!(out);
}

/// GOAL: numbers without a unit and angles come from rasters, too, and a unit of a number is refused.
#[test]
fn numbers_and_angles_come_from_rasters() {
    let points = "0,0,0.2\n4,0,0.3\n0,2,0.4\n4,2,0.45\n";
    let files = [
        ("bare.csv", format!("x [m],y [m],nu\n{points}")),
        ("dash.csv", format!("x [m],y [m],nu [-]\n{points}")),
        ("wrong.csv", format!("x [m],y [m],nu [kPa]\n{points}")),
        (
            "angle.csv",
            "x [m],y [m],psi [deg]\n0,0,2\n4,0,3\n0,2,4\n4,2,5\n".to_owned(),
        ),
    ];
    let folder = Folder::new(
        "raster-numbers",
        &files.each_ref().map(|file| (file.0, file.1.as_str())),
    );
    let soil = "model = \"mohr-coulomb\"\ncohesion = \"5 kPa\"\nfriction = \"30 deg\"\ndilation = DILATION";
    let text = TEXT.replace("model = \"tresca\"\ncu = CU", soil);
    let with = |poisson: &str, dilation: &str| {
        let text = text.replace("poisson = 0.45", &format!("poisson = {poisson}"));
        text.replace("DILATION", dilation)
    };
    let angle = "{ raster = \"angle.csv\" }";
    for poisson in ["{ raster = \"bare.csv\" }", "{ raster = \"dash.csv\" }"] {
        let file = folder
            .read(&with(poisson, angle))
            .unwrap_or_else(|error| panic!("{error}"));
        let case = file.case();
        let (model, state) = Model::new(case).unwrap();
        let particles = &state.body.particles;
        for (&[x, y], &law) in std::iter::zip(&particles.x, &particles.law) {
            let (s, t) = (x / 4.0, y / 2.0);
            let nu = (1.0 - t) * (0.2 + 0.1 * s) + t * (0.4 + 0.05 * s);
            let found = model.laws[law].stiffness_bound().poisson();
            assert!((found - nu).abs() < 1e-12, "{found} for {nu}");
        }
        let again = CaseFile::parse("again.toml", &file.explain(), &[]).unwrap();
        assert_eq!(again.case().materials, case.materials);
    }
    let printed = folder.printed(&with("{ raster = \"wrong.csv\" }", angle));
    assert!(printed.contains("is a number without a unit"), "{printed}");
}
