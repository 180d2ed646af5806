//! Water and construction stages in case files: their statements and refusals.

// Values are read to the last digit.
#![allow(clippy::float_cmp)]

use std::fmt::Write;

use igimp_input::CaseFile;
use igimp_model::{Case, Drainage, PoreSource, StageKind};
use igimp_report::setup;

use crate::edits::{Edits, edited};

const TEXT: &str = r#"
igimp = 1

[case]
title = "Slope with water, dug and filled"

[grid]
cell = "0.5 m"
domain = { x = ["0 m", "30 m"], y = ["0 m", "12 m"] }

[materials.sand]
model = "mohr-coulomb"
unit_weight = "18 kN/m3"
saturated_unit_weight = "20 kN/m3"
young = "20 MPa"
poisson = 0.3
cohesion = "5 kPa"
friction = "30 deg"

[materials.clay]
model = "mohr-coulomb"
unit_weight = "17 kN/m3"
saturated_unit_weight = "17 kN/m3"
young = "20 MPa"
poisson = 0.3
cohesion = "5 kPa"
friction = "22 deg"
drainage = "undrained"

[materials.soft]
model = "tresca"
unit_weight = "16 kN/m3"
saturated_unit_weight = "16 kN/m3"
young = "20 MPa"
poisson = 0.3
cu = "40 kPa"

[[bodies]]
name = "ground"
material = "sand"
polygon = [["0 m", "0 m"], ["30 m", "0 m"], ["30 m", "4 m"], ["20 m", "4 m"], ["12 m", "8 m"], ["0 m", "8 m"]]

[[bodies]]
name = "top"
material = "soft"
polygon = [["0 m", "8 m"], ["12 m", "8 m"], ["8 m", "10 m"], ["0 m", "10 m"]]

[[bodies]]
name = "fill"
material = "clay"
polygon = [["20 m", "4 m"], ["30 m", "4 m"], ["30 m", "6 m"], ["16 m", "6 m"]]

[[water]]
name = "full"
level = "7 m"

[[water]]
name = "drawn"
inside = "7 m"
outside = "5 m"

[[water]]
name = "line"
line = [["0 m", "6 m"], ["20 m", "4 m"]]
bodies = [{ body = "fill", r_u = 0.25 }, { body = "top", dry = true }]

[[loads]]
name = "surcharge"
type = "pressure"
from = ["0 m", "10 m"]
to = ["6 m", "10 m"]
pressure = "10 kPa"

[[stages]]
name = "weight"
type = "gravity"
drained = true

[[stages]]
name = "surcharge"
type = "load"
load = "surcharge"

[[stages]]
name = "off"
type = "load"
load = "surcharge"
factor = 0

[[stages]]
name = "drawdown"
type = "construction"
water = "drawn"
steps = 4

[[stages]]
name = "filling"
type = "construction"
place = ["fill"]
water = "line"
geometry = "given"

[[stages]]
name = "digging"
type = "construction"
remove = ["top"]
materials = [{ body = "ground", material = "clay" }]
dissipate = true

[[stages]]
name = "safety"
type = "strength-reduction"
"#;

fn case(edits: Edits<'_>) -> Case<2> {
    CaseFile::parse("slope.toml", &edited(TEXT, edits), &[])
        .unwrap_or_else(|error| panic!("{error}"))
        .case()
        .clone()
}

fn messages(cases: &[Edits<'_>]) -> String {
    crate::messages::messages(("slope.toml", TEXT), cases)
}

/// GOAL: soil below the table without a weight of full pores is told, once a material; dry soil and soil that
/// states it are not.
#[test]
fn soil_that_weighs_the_same_below_the_table_is_named() {
    let count = |edits: Edits<'_>| {
        let file = CaseFile::parse("slope.toml", &edited(TEXT, edits), &[]).unwrap();
        file.warnings().matches("weighs below the table").count()
    };
    let sand = ("saturated_unit_weight = \"20 kN/m3\"\n", "");
    let clay = ("saturated_unit_weight = \"17 kN/m3\"\n", "");
    assert_eq!(count(&[]), 0);
    assert_eq!(count(&[clay]), 1);
    assert_eq!(count(&[sand, clay]), 2);
}

#[test]
fn a_file_states_water_and_stages() {
    insta::assert_snapshot!(messages(&[&[]]));
    let case = case(&[]);
    assert_eq!(case.water_unit_weight, 9810.0);
    assert_eq!(case.water[0].source, PoreSource::Table(vec![[0.0, 7.0]]));
    let there: Vec<bool> = case.bodies.iter().map(|body| body.from_start).collect();
    assert_eq!(there, [true, true, false]);
    assert_eq!(case.materials[0].saturated, Some(20e3));
    assert_eq!(case.materials[2].drainage, Drainage::Total);
    assert_eq!(
        case.water[2].bodies,
        [(2, PoreSource::Ratio(0.25)), (1, PoreSource::Dry)]
    );
    assert!(case.stages[0].drained && !case.stages[1].drained);
    let StageKind::Construction(works) = &case.stages[5].kind else {
        panic!("{:?}", case.stages[5]);
    };
    assert_eq!((&works.place[..], &works.remove[..]), (&[][..], &[1][..]));
    assert_eq!((&works.materials[..], works.water), (&[(0, 1)][..], None));
    assert!(works.dissipate);
}

/// GOAL: pressures by points act as the table does that they were taken from, with a pond, above the table and in
/// saturated soil; from a file as from the case.
/// ORACLE: the same case with a level.
/// BAND: ten times the tolerance of a step; a thousandth with a level on a line of points; between two lines the kink is lost.
#[test]
fn points_act_as_the_table_that_they_are_of() {
    let soil = ("saturated_unit_weight = \"20 kN/m3\"\n", "");
    let only_weight = |edits: Edits<'_>| {
        let mut case = case(edits);
        case.stages.truncate(1);
        let run = igimp_cases::run::in_memory(&case).unwrap();
        run.body.particles.displacement.clone()
    };
    let apart = |one: &[[f64; 2]], other: &[[f64; 2]]| {
        let size = |u: &[f64; 2]| u[0].hypot(u[1]);
        let most = one.iter().map(size).fold(0.0, f64::max);
        let pairs = std::iter::zip(one, other);
        pairs
            .map(|(a, b)| size(&[a[0] - b[0], a[1] - b[1]]))
            .fold(0.0, f64::max)
            / most
    };
    let level = |level: f64| format!("level = \"{level} m\"");
    let points = |level: f64, rows: &[f64]| {
        let of = |y: &f64| (9.81 * (level - y)).max(0.0);
        let row = |y| format!("[\"{0} kPa\", \"{0} kPa\"]", of(y));
        let y: Vec<String> = rows.iter().map(|y| format!("\"{y} m\"")).collect();
        let rows: Vec<String> = rows.iter().map(row).collect();
        let (y, rows) = (y.join(", "), rows.join(", "));
        format!("u = {{ x = [\"0 m\", \"30 m\"], y = [{y}], rows = [{rows}] }}\npond = true")
    };
    let table = |at: f64| only_weight(&[soil, ("level = \"7 m\"", &level(at))]);
    let raster =
        |at: f64, rows: &[f64]| only_weight(&[soil, ("level = \"7 m\"", &points(at, rows))]);
    let deep = apart(&table(14.0), &raster(14.0, &[0.0, 11.0]));
    assert!(deep < 1e-8, "{deep}");
    let kink = apart(&table(7.0), &raster(7.0, &[0.0, 3.0, 7.0, 11.0]));
    assert!(kink < 1e-3, "{kink}");
    let coarse = apart(&table(7.0), &raster(7.0, &[0.0, 6.5, 7.5, 11.0]));
    assert!(coarse > kink && coarse < 5e-2, "{coarse}");

    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("water");
    std::fs::create_dir_all(&folder).unwrap();
    let csv = "x [m],y [m],u [kPa]\n0,0,137.34\n30,0,137.34\n0,11,29.43\n30,11,29.43\n";
    std::fs::write(folder.join("seepage.csv"), csv).unwrap();
    let edit = (
        "level = \"7 m\"",
        "u = { raster = \"seepage.csv\" }\npond = true",
    );
    std::fs::write(folder.join("case.toml"), edited(TEXT, &[soil, edit])).unwrap();
    let file = CaseFile::read(&folder.join("case.toml"), &[]).unwrap();
    let PoreSource::Points(raster) = &file.case().water[0].source else {
        panic!("{:?}", file.case().water[0]);
    };
    assert!((raster.at([12.0, 5.5]) - 83.385e3).abs() < 1e-6);
}

#[test]
fn the_water_of_undrained_soil_follows_from_its_poisson_ratio() {
    let Drainage::Undrained { stiffness, .. } = case(&[]).materials[1].drainage else {
        panic!("clay is undrained");
    };
    let (shear, drained) = (20e6 / 2.6, 20e6 / 1.2);
    let undrained = 2.0 * shear * 1.495 / (3.0 * 0.01);
    assert!((stiffness.modulus / (undrained - drained) - 1.0).abs() < 1e-12);
    assert!(stiffness.goes_with_soil);
    let stated = case(&[(
        "drainage = \"undrained\"",
        "drainage = \"undrained\"\npore_water = \"500 MPa\"",
    )]);
    let drainage = stated.materials[1].drainage;
    assert_eq!(
        drainage,
        Drainage::Undrained {
            stiffness: 500e6.into(),
            flows: false
        }
    );
}

/// The ground lies at 10 m, falls to 4 m between x = 8 m and 20 m, and the pool outside at 5 m: the table is level within,
/// follows the slope from 7 m to 5 m, and is level outside.
#[test]
fn a_drawdown_follows_the_ground_between_its_levels() {
    let case = case(&[]);
    let PoreSource::Table(points) = &case.water[1].source else {
        panic!("a drawdown is a table");
    };
    let expected = [[0.0, 7.0], [14.0, 7.0], [18.0, 5.0], [30.0, 5.0]];
    assert_eq!(points.len(), expected.len(), "{points:?}");
    for (point, expected) in std::iter::zip(points, expected) {
        assert!(
            (0..2).all(|k| (point[k] - expected[k]).abs() < 1e-12),
            "{points:?}"
        );
    }
}

#[test]
fn tables_tell_of_water_and_stages() {
    let mut out = String::new();
    for table in setup::tables(&case(&[])) {
        if ["Soil and water", "Water", "Bodies", "Stages as planned"].contains(&&*table.title) {
            let _ = writeln!(out, "# {}\n{}", table.title, table.header.join(" | "));
            for row in &table.rows {
                let _ = writeln!(out, "{}", row.join(" | "));
            }
        }
    }
    insta::assert_snapshot!(out);
}

#[test]
fn an_explained_file_states_the_same_case() {
    let file = CaseFile::parse("slope.toml", TEXT, &[]).unwrap();
    let again = CaseFile::parse("slope.toml", &file.explain(), &[]).unwrap();
    assert_eq!(format!("{:?}", file.case()), format!("{:?}", again.case()));
}

#[test]
fn water_that_makes_no_sense() {
    insta::assert_snapshot!(messages(&[
        &[("level = \"7 m\"", "level = \"7 m\"\npond = false")],
        &[(
            "level = \"7 m\"",
            "line = [[\"0 m\", \"9 m\"], [\"30 m\", \"6 m\"]]"
        )],
        &[(
            "level = \"7 m\"",
            "line = [[\"0 m\", \"9 m\"], [\"30 m\", \"6 m\"]]\npond = true"
        )],
        &[(
            "level = \"7 m\"",
            "line = [[\"0 m\", \"6 m\"], [\"20 m\", \"4 m\"], [\"20 m\", \"3 m\"]]"
        )],
        &[("title =", "gravity = \"0 m/s2\"\ntitle =")],
        &[("\"20 kN/m3\"", "\"10 kN/m3\"")],
        &[(
            "friction = \"30 deg\"",
            "friction = \"30 deg\"\ndrainage = \"total\""
        )],
        &[(
            "body = \"top\", dry = true",
            "body = \"top\", level = \"9 m\""
        )],
        &[("level = \"7 m\"", "level = \"-1 m\"")],
        &[("level = \"7 m\"", "r_u = 1.5")],
        &[(
            "level = \"7 m\"",
            "u = { x = [\"0 m\", \"20 m\"], y = [\"0 m\", \"10 m\"], rows = [[\"90 kPa\", \"50 kPa\"], [\"0 kPa\", \"0 kPa\"]] }"
        )],
        &[(
            "level = \"7 m\"",
            "u = { x = [\"0 m\", \"30 m\"], y = [\"0 m\", \"10 m\"], rows = [[\"90 kPa\", \"50 kPa\"], [\"0 kPa\", \"0 kPa\"]] }"
        )],
        &[(
            "level = \"7 m\"",
            "u = { x = [\"0 m\", \"30 m\"], y = [\"0 m\", \"10 m\"] }"
        )],
        &[("level = \"7 m\"", "u = { raster = \"nowhere.csv\" }")],
        &[("r_u = 0.25", "r_u = -0.25")],
        &[("level = \"7 m\"", "level = \"7 m\"\nr_u = 0.2")],
        &[("level = \"7 m\"", "dry = false")],
        &[("outside = \"5 m\"", "")],
        &[("outside = \"5 m\"", "outside = \"8 m\"")],
        &[("level = \"7 m\"", "levle = \"7 m\"")],
        &[("water = \"drawn\"", "water = \"drown\"")],
        &[("body = \"fill\", r_u", "body = \"fil\", r_u")],
        &[("body = \"top\", dry", "body = \"fill\", dry")],
        &[("water = \"drawn\"\n", "dissipate = true\n")],
        &[
            (
                "[\"12 m\", \"8 m\"], [\"0 m\", \"8 m\"]]",
                "[\"20 m\", \"8 m\"], [\"0 m\", \"8 m\"]]"
            ),
            ("[\"16 m\", \"6 m\"]", "[\"20 m\", \"6 m\"]"),
        ],
        &[
            (
                "[\"12 m\", \"8 m\"], [\"0 m\", \"8 m\"]]",
                "[\"20 m\", \"8 m\"], [\"0 m\", \"8 m\"]]"
            ),
            ("[\"16 m\", \"6 m\"]", "[\"20 m\", \"6 m\"]"),
            ("inside = \"7 m\"\noutside = \"5 m\"", "r_u = 0.2"),
        ],
    ]));
}

#[test]
fn drainage_that_makes_no_sense() {
    let undrained = "drainage = \"undrained\"";
    let with = |more: &str| format!("{undrained}\n{more}");
    insta::assert_snapshot!(messages(&[
        &[(undrained, &with("undrained_poisson = 0.2"))],
        &[(undrained, &with("undrained_poisson = 0.5"))],
        &[(
            undrained,
            &with("undrained_poisson = 0.49\npore_water = \"1 GPa\"")
        )],
        &[(undrained, "undrained_poisson = 0.49")],
        &[(undrained, "drainage = \"undrianed\"")],
        &[(undrained, &with("dilation = \"5 deg\""))],
        &[(undrained, &with("flow = \"davis\""))],
        &[
            (
                "name = \"ground\"\nmaterial = \"sand\"",
                "name = \"ground\"\nmaterial = \"clay\""
            ),
            ("drained = true", "drained = false"),
            (
                "materials = [{ body = \"ground\", material = \"clay\" }]",
                ""
            )
        ],
    ]));
}

#[test]
fn construction_that_makes_no_sense() {
    let place = "place = [\"fill\"]";
    let remove = "remove = [\"top\"]";
    insta::assert_snapshot!(messages(&[
        &[(place, "place = [\"fil\"]")],
        &[(place, "place = [\"fill\", \"fill\"]")],
        &[(remove, "remove = [\"top\"]\nplace = [\"fill\"]")],
        &[(place, "place = [\"fill\"]\nremove = [\"fill\"]")],
        &[("water = \"drawn\"\n", "remove = [\"fill\"]\n")],
        &[(
            "water = \"drawn\"\n",
            "materials = [{ body = \"fill\", material = \"sand\" }]\n"
        )],
        &[
            (remove, "remove = [\"top\", \"ground\", \"fill\"]"),
            (
                "materials = [{ body = \"ground\", material = \"clay\" }]",
                ""
            )
        ],
        &[("material = \"clay\" }", "material = \"caly\" }")],
        &[("material = \"clay\" }", "material = \"sand\" }")],
        &[("water = \"drawn\"\n", "")],
        &[("dissipate = true", "stop_when = { displacement = \"1 m\" }")],
        &[("factor = 0", "factor = 0.5")],
        &[(
            "name = \"off\"\ntype = \"load\"",
            "name = \"off\"\nstart_from = \"weight\"\ntype = \"load\""
        )],
        &[(place, "place = [\"fill\", \"ground\", \"top\"]")],
        &[(
            "cell = \"0.5 m\"",
            "cell = \"0.5 m\"\nmixed_cells = \"mean\""
        )],
        &[(
            "from = [\"0 m\", \"10 m\"]\nto = [\"6 m\", \"10 m\"]",
            "from = [\"22 m\", \"6 m\"]\nto = [\"26 m\", \"6 m\"]"
        ),],
    ]));
}

const POND: &str = r#"
igimp = 1
[case]
title = "clay under a pond"
[grid]
cell = "1 m"
domain = { x = ["0 m", "3 m"], y = ["0 m", "10 m"] }
[materials.clay]
model = "tresca"
cu = "100 kPa"
unit_weight = "17 kN/m3"
saturated_unit_weight = "19 kN/m3"
young = "10 MPa"
poisson = 0.3
k0 = 0.8
drainage = "total"
[[water]]
name = "pond"
level = "15 m"
[[bodies]]
name = "bed"
material = "clay"
polygon = [["0 m","0 m"], ["3 m","0 m"], ["3 m","8 m"], ["0 m","8 m"]]
[[stages]]
name = "rest"
type = "k0"
"#;

/// GOAL: a pond loads level ground by the same in all directions, also soil of total stress, which `k0` is stated of; weak clay of a deep sea
/// bed begins. CASE: 8 m of clay under water up to 15 m and 108 m, and with c_u = 20 kPa. ORACLE: σ_v = γ z + γ_w h, σ_h = K_0 γ z + γ_w h (eq. 36c);
/// drained soil of the same, σ_h = u + K_0 (σ_v - u), whose deviator does not know h either. BAND: 1e-6 of γ z.
#[test]
fn a_pond_loads_soil_of_total_stress_in_all_directions_alike() {
    let deep = [
        ("level = \"15 m\"", "level = \"108 m\""),
        ("\"100 kPa\"", "\"20 kPa\""),
    ];
    for (edits, water) in [(&[][..], 7.0), (&deep[..], 100.0)] {
        let case = edited(POND, edits);
        let file =
            CaseFile::parse("pond.toml", &case, &[]).unwrap_or_else(|error| panic!("{error}"));
        let run = igimp_cases::run::in_memory(file.case()).unwrap();
        assert!(run.failure.is_none());
        let particles = &run.body.particles;
        for particle in 0..particles.len() {
            let soil = 19e3 * (8.0 - particles.x[particle][1]);
            let pond = 9.81e3 * water;
            let sigma = &particles.sigma[particle];
            assert!((sigma[1][1] + soil + pond).abs() < 1e-6 * soil, "{sigma:?}");
            for axis in [0, 2] {
                let off = sigma[axis][axis] + 0.8 * soil + pond;
                assert!(off.abs() < 1e-6 * soil, "{sigma:?} {soil} {pond}");
            }
        }
    }
}
