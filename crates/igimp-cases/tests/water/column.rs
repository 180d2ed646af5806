//! GOAL: the weight and the stiffness of water in ground whose properties vary, and ground that is level without any.
//! CASE: columns in one dimension.
//! ORACLE: sums over their depth by hand.

use igimp_cases::run::{Run, in_memory};
use igimp_input::CaseFile;

/// A column 6 m high of one soil, with the rest of a case.
fn column(soil: &str, rest: &str) -> String {
    format!(
        r#"
igimp = 1
[case]
title = "a column"
[grid]
cell = "0.25 m"
domain = {{ x = ["0 m", "0.75 m"], y = ["0 m", "7 m"] }}
[materials.soil]
model = "elastic"
poisson = 0.25
{soil}
[[bodies]]
name = "column"
material = "soil"
points_per_cell = 4
polygon = [["0 m", "0 m"], ["0.75 m", "0 m"], ["0.75 m", "6 m"], ["0 m", "6 m"]]
{rest}
[[monitors]]
name = "left"
point = ["0.0625 m", "0.375 m"]
record = ["sigma_yy", "sigma_eff_yy", "sigma_eff_xx"]
[[monitors]]
name = "right"
point = ["0.6875 m", "0.375 m"]
record = ["sigma_yy", "sigma_eff_yy", "sigma_eff_xx"]
[[monitors]]
name = "top"
point = ["0.375 m", "6 m"]
record = ["displacement_y"]
[output]
report = false
figures = []
"#
    )
}

fn ran(soil: &str, rest: &str) -> Run<2> {
    let file = CaseFile::parse("column.toml", &column(soil, rest), &[]);
    let run = in_memory(file.unwrap_or_else(|error| panic!("{error}")).case()).unwrap();
    assert!(run.failure.is_none(), "{:?}", run.failure);
    run
}

/// The last row of a monitor, without stage, step, progress and time; stresses with compression positive.
fn last(run: &Run<2>, monitor: &str) -> Vec<f64> {
    let table = run
        .monitors
        .iter()
        .find(|table| table.name == monitor)
        .unwrap();
    let moment = ["stage", "step", "progress_[-]", "time_[s]"];
    let is_moment = |name: &&String| moment.contains(&name.as_str());
    let before = table.header.iter().take_while(is_moment).count();
    table.rows.last().unwrap()[before..].to_vec()
}

const K0: &str = "[[stages]]\nname = \"rest\"\ntype = \"k0\"\nsteps = 1\n";

/// GOAL: soil under a table has its saturated weight, also where its unit weight varies above; on either side of the ground alike.
/// ORACLE: 20 kN/m³ over 5.625 m, less 9.81 kN/m³ of water.
#[test]
fn saturated_soil_of_varied_weight_weighs_one() {
    let soil = "unit_weight = { levels = [\"0 m\", \"6 m\"], values = [\"20 kN/m3\", \"14 kN/m3\"] }\nsaturated_unit_weight = \"20 kN/m3\"\nyoung = \"20 MPa\"\nk0 = 0.5";
    let water = "[[water]]\nname = \"full\"\nlevel = \"6 m\"\n";
    // Raised by gravity, stress is the mean of a cell, whose middle lies a quarter of it off the particle.
    for (stage, band) in [
        (K0, 1e-4),
        (
            "[[stages]]\nname = \"weight\"\ntype = \"gravity\"\nsteps = 1\n",
            0.012,
        ),
    ] {
        let run = ran(soil, &format!("{water}{stage}"));
        for side in ["left", "right"] {
            let row = last(&run, side);
            assert!(
                (row[0] / 112.5e3 - 1.0).abs() < band,
                "{stage} {side}: {row:?}"
            );
            assert!(
                (row[1] / 57_318.75 - 1.0).abs() < band,
                "{stage} {side}: {row:?}"
            );
        }
    }
}

/// GOAL: pressures that are a share of the weight are the same on both sides of the ground, and level ground without a table begins at rest.
/// ORACLE: 18 kN/m³ over 5.625 m, effective stress 0.7 and 1 of it, half of that sideways.
#[test]
fn level_ground_without_a_table_is_at_rest() {
    let soil = "unit_weight = \"18 kN/m3\"\nyoung = \"20 MPa\"\nk0 = 0.5";
    for (water, share) in [("r_u = 0.3", 0.7), ("dry = true", 1.0)] {
        let run = ran(soil, &format!("[[water]]\nname = \"water\"\n{water}\n{K0}"));
        for side in ["left", "right"] {
            let row = last(&run, side);
            let exact = [101.25e3, share * 101.25e3, 0.5 * share * 101.25e3];
            for (value, exact) in row.iter().zip(exact) {
                assert!(
                    (value / exact - 1.0).abs() < 1e-6,
                    "{water} {side}: {value} {exact}"
                );
            }
        }
    }
}

/// GOAL: water of a stiffness that is stated has it wherever the soil is stiff or soft, in stages that take time too; one that follows from
/// Poisson's ratio goes with the soil.
/// ORACLE: Σ q dz / (M + K_w/n) over particles, M and, if it follows, K_w in proportion to E.
#[test]
fn stated_water_does_not_vary_with_the_soil() {
    let soil = |water: &str, drainage: &str| {
        format!(
            "unit_weight = \"17 kN/m3\"\nyoung = {{ levels = [\"0 m\", \"6 m\"], values = [\"40 MPa\", \"4 MPa\"] }}\ndrainage = \"{drainage}\"\npermeability = \"1e-14 m/s\"\n{water}"
        )
    };
    let load = |more: &str| {
        format!(
            "[[loads]]\nname = \"fill\"\ntype = \"pressure\"\nfrom = [\"0 m\", \"6 m\"]\nto = [\"0.75 m\", \"6 m\"]\npressure = \"10 kPa\"\n[[stages]]\nname = \"fill\"\ntype = \"load\"\nload = \"fill\"\nsteps = 1\n{more}"
        )
    };
    let in_time = "consolidation = { duration = \"1 s\" }\n";
    // M over E, and K_w/n over E that makes a Poisson's ratio of 0.45 of one of 0.25.
    let confined = 0.75 / (1.25 * 0.5);
    let shear = 1.0 / 2.5;
    let follows = 2.0 * shear * 1.45 / (3.0 * 0.1) - 1.0 / 1.5;
    let exact = |water: &dyn Fn(f64) -> f64| -> f64 {
        let parts = (0..48).map(|k| {
            let young = 40e6 - 6e6 * (0.0625 + 0.125 * f64::from(k));
            1e4 * 0.125 / (confined * young + water(young))
        });
        parts.sum()
    };
    let stated = exact(&|_| 30e6);
    let derived = exact(&|young| follows * young);
    for (water, expected) in [
        ("pore_water = \"30 MPa\"", stated),
        ("undrained_poisson = 0.45", derived),
    ] {
        for (drainage, time) in [("undrained", ""), ("coupled", ""), ("coupled", in_time)] {
            let run = ran(&soil(water, drainage), &load(time));
            let found = -last(&run, "top")[0];
            assert!(
                (found / expected - 1.0).abs() < 0.01,
                "{water} {drainage} {time}: {found} {expected}"
            );
        }
    }
}

/// GOAL: a strength by the effective stress at rest asks for a level where the water of the case flows.
#[test]
fn strength_by_stress_in_flowing_water_asks_for_a_level() {
    let soil = "unit_weight = \"18 kN/m3\"\nyoung = \"20 MPa\"\ncu = { ratio = 0.25 }\nk0 = 0.5\npermeability = \"1e-8 m/s\"";
    let text = column(soil, &format!("[[water]]\nname = \"flow\"\n[water.seepage]\nfree_water = [[\"0 m\", \"6 m\"], [\"0.75 m\", \"6 m\"]]\n{K0}")).replace("elastic", "tresca");
    let error = CaseFile::parse("column.toml", &text, &[])
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("goes with the effective stress") && error.contains("add water_level"),
        "{error}"
    );
    let stated = text.replace("ratio = 0.25", "ratio = 0.25, water_level = \"6 m\"");
    CaseFile::parse("column.toml", &stated, &[]).unwrap_or_else(|error| panic!("{error}"));
}

/// GOAL: a cylinder of ground at rest has the pore pressure of its depth at any radius, in particles that the table cuts too.
#[test]
fn a_cylinder_of_ground_has_the_pressure_of_its_depth() {
    let stage = "[[water]]\nname = \"table\"\nlevel = \"0.51 m\"\n[[stages]]\nname = \"rest\"\ntype = \"k0\"\nsteps = 1\n";
    for inner in [0.0, 0.3, 40.0] {
        let text = format!(
            r#"
igimp = 1
[case]
title = "a cylinder"
analysis = "axisymmetric"
[grid]
cell = "0.1 m"
domain = {{ x = ["{inner} m", "{outer} m"], y = ["0 m", "1.1 m"] }}
[materials.soil]
model = "elastic"
unit_weight = "20 kN/m3"
young = "10 MPa"
poisson = 0.3
k0 = 0.5
[[bodies]]
name = "cylinder"
material = "soil"
polygon = [["{inner} m", "0 m"], ["{outer} m", "0 m"], ["{outer} m", "1 m"], ["{inner} m", "1 m"]]
{stage}
[output]
report = false
figures = []
"#,
            outer = inner + 0.6
        );
        let file = CaseFile::parse("cylinder.toml", &text, &[]).unwrap();
        let run = in_memory(file.case()).unwrap();
        assert!(run.failure.is_none(), "{:?}", run.failure);
        let particles = &run.body.particles;
        let cut = |&p: &usize| (particles.x[p][1] - 0.525).abs() < 1e-3;
        let cut: Vec<usize> = (0..particles.len()).filter(cut).collect();
        assert_eq!(cut.len(), 12);
        for p in cut {
            let (u, r) = (particles.pore_pressure[p], particles.x[p][0]);
            assert!((u - 9.81).abs() < 1e-6, "{u} at r = {r}");
        }
    }
}

/// GOAL: a wait from which no water leaves is told. ORACLE: the keys that let it out, one by one.
#[test]
fn a_wait_without_an_outlet_is_named() {
    let warns = |keys: &str| {
        let text = format!(
            r#"
igimp = 1
[case]
title = "wait"
[grid]
cell = "1 m"
domain = {{ x = ["0 m", "2 m"], y = ["0 m", "5 m"] }}
[materials.clay]
model = "elastic"
unit_weight = "17 kN/m3"
young = "20 MPa"
poisson = 0.25
drainage = "coupled"
permeability = "1e-9 m/s"
[[bodies]]
name = "layer"
material = "clay"
polygon = [["0 m", "0 m"], ["2 m", "0 m"], ["2 m", "4 m"], ["0 m", "4 m"]]
[[stages]]
name = "weight"
type = "gravity"
[[stages]]
name = "wait"
type = "wait"
consolidation = {{ duration = "1 d"{keys} }}
"#
        );
        let file = CaseFile::parse("wait.toml", &text, &[]).unwrap();
        file.warnings()
            .contains("water leaves nowhere in this stage")
    };
    assert!(warns(", open_faces = false"));
    assert!(!warns(""));
    assert!(!warns(", open_faces = false, open_sides = [\"bottom\"]"));
}

/// GOAL: a stage that takes time goes at once to its end where no water is left to flow.
/// CASE: clay that is loaded, waits, is made drained, undrained or of total stress by construction, and waits for a century.
/// ORACLE: nothing flows: its two steps, and one that comes before them.
#[test]
fn a_wait_in_which_nothing_flows_is_short() {
    let soil = "unit_weight = \"17 kN/m3\"\nyoung = \"20 MPa\"\ndrainage = \"coupled\"\npermeability = \"5e-11 m/s\"\npore_water = \"10 GPa\"";
    for drainage in ["drained", "undrained", "total"] {
        let rest = format!(
            r#"
[materials.other]
model = "elastic"
poisson = 0.25
unit_weight = "17 kN/m3"
young = "20 MPa"
drainage = "{drainage}"
[[loads]]
name = "fill"
type = "pressure"
from = ["0 m", "6 m"]
to = ["0.75 m", "6 m"]
pressure = "10 kPa"
[[stages]]
name = "rest"
type = "k0"
drained = true
steps = 1
[[stages]]
name = "fill"
type = "load"
load = "fill"
steps = 1
[[stages]]
name = "other"
type = "construction"
materials = [{{ body = "column", material = "other" }}]
steps = 1
[[stages]]
name = "wait"
type = "wait"
steps = 2
consolidation = {{ duration = "36525 d" }}
"#
        );
        let run = ran(soil, &rest);
        let [.., wait] = &run.summary.stages[..] else {
            panic!("there are four stages");
        };
        println!("{drainage}: {} steps", wait.steps);
        assert!(wait.steps <= 3, "{drainage}: {} steps", wait.steps);
    }
}

/// GOAL: a drain acts as wide as it is drawn, to half a cell, wherever its side lies in a cell.
/// CASE: clay 4 m wide under a smooth plate, drained by a box at its left end, cells of 0.25 m.
/// ORACLE: equal strain: U = 1 − exp(−3 c_v t L / (L − w)³) for a drain of width w; a width of 0.26 m acted as 0.44 m.
#[test]
fn a_drain_acts_as_wide_as_it_is_drawn() {
    let (length, young, permeability): (f64, f64, f64) = (4.0, 20e6, 1e-9);
    let duration = 0.3 * length * length * 9810.0 / (permeability * young);
    for width in [0.25, 0.26, 0.3, 0.375] {
        let text = format!(
            r#"
igimp = 1
[case]
title = "a strip with a drain"
gravity = "0 m/s2"
[grid]
cell = "0.25 m"
domain = {{ x = ["0 m", "4 m"], y = ["0 m", "2 m"] }}
[materials.clay]
model = "elastic"
unit_weight = "17 kN/m3"
young = "20 MPa"
poisson = 0.0
drainage = "coupled"
permeability = "1e-9 m/s"
pore_water = "10 GPa"
[[bodies]]
name = "layer"
material = "clay"
polygon = [["0 m","0 m"],["4 m","0 m"],["4 m","1 m"],["0 m","1 m"]]
[[rigid]]
name = "cap"
type = "rectangle"
from = ["-1 m","1 m"]
to = ["5 m","3 m"]
interface = "smooth"
force_factor = 1
[[stages]]
name = "press"
type = "rigid"
bodies = [{{ body = "cap", force_y = "-40 kN/m" }}]
steps = 1
[[stages]]
name = "wait"
type = "wait"
steps = 4
[stages.consolidation]
duration = "{duration} s"
open_faces = false
drains = [{{ from = ["0 m","0 m"], to = ["{width} m","2 m"] }}]
[[monitors]]
name = "far"
point = ["4 m","1 m"]
record = ["displacement_y"]
[output]
figures = []
report = false
"#
        );
        let file = CaseFile::parse("strip.toml", &text, &[]).unwrap();
        let is_named = file.warnings().contains("a side of this drain, x =");
        assert_eq!(is_named, width > 0.25, "{}", file.warnings());
        let run = in_memory(file.case()).unwrap();
        let rows = &run.monitors[0].rows;
        let column = rows[0].len() - 1;
        let first = rows.iter().rfind(|row| row[0] < 1.5).unwrap()[column];
        let degree = -(last(&run, "far")[0] - first) * young / 10e3;
        let drained = length - (-0.9 * length.powi(3) / (1.0 - degree).ln()).cbrt();
        println!("width {width}: U {degree:.4}, acts as {drained:.3} m");
        assert!((drained - width).abs() < 0.5 * 0.25, "{width}: {drained}");
    }
}
