//! GOAL: how contact closes: gaps that a given geometry keeps, gaps that are crossed in few steps, and the beginning of pressure.
//! CASE: a smooth plate above an elastic slab between smooth walls.
//! ORACLE: nothing touches across a gap; one-dimensional compression in series with eq. 46.

use igimp_cases::run::{Run, in_memory};
use igimp_input::CaseFile;

fn parsed(text: &str) -> CaseFile {
    let file = CaseFile::parse("case.toml", text, &[]);
    file.unwrap_or_else(|error| panic!("{error}"))
}

/// The last point of the curve of a run that reached its end, and its warnings.
fn end_of<const D: usize>(run: &Run<D>) -> (Vec<f64>, String) {
    assert!(run.failure.is_none(), "{:?}", run.failure);
    let end = run.curves[0].rows.last().unwrap().clone();
    (end, run.summary.warnings.join("\n"))
}

/// The same of a case in the plane.
fn ended(text: &str) -> (Vec<f64>, String) {
    end_of(&in_memory(parsed(text).case()).unwrap())
}

/// The force under a plate that starts a gap above a slab 2 m high and goes down by a way \[m\] in so many steps, per metre run \[N/m\],
/// and the warnings.
fn pressed([gap, way]: [f64; 2], geometry: &str, steps: usize) -> (f64, String) {
    let text = format!(
        r#"
igimp = 1
[case]
title = "a plate above a slab"
gravity = "0 m/s2"
[grid]
cell = "0.25 m"
domain = {{ x = ["0 m", "1 m"], y = ["0 m", "3.5 m"] }}
[materials.slab]
model = "elastic"
unit_weight = "18 kN/m3"
young = "10 MPa"
poisson = 0.3
[[bodies]]
name = "slab"
material = "slab"
polygon = [["0 m", "0 m"], ["1 m", "0 m"], ["1 m", "2 m"], ["0 m", "2 m"]]
[[rigid]]
name = "plate"
type = "rectangle"
from = ["-1 m", "{base} m"]
to = ["2 m", "3 m"]
interface = "smooth"
rounding = 0
[[stages]]
name = "press"
type = "rigid"
bodies = [{{ body = "plate", y = "-{way} m" }}]
steps = {steps}
geometry = "{geometry}"
[[curves]]
name = "resistance"
x = {{ of = "step" }}
y = {{ of = "rigid.plate.resistance" }}
[output]
report = false
figures = []
"#,
        base = 2.0 + gap,
    );
    let (end, warned) = ended(&text);
    (end[1], warned)
}

/// GOAL: a body that no soil is near on a geometry that stays as it is drawn is told of, with the gap; one that is near, or moves, is not.
#[test]
fn a_gap_that_never_closes_is_told() {
    let remark = "\"plate\" stands 0.2 m off all soil";
    let (force, warned) = pressed([0.2, 0.205], "given", 10);
    assert!(
        force.abs() < 1e-6 && warned.contains(remark),
        "{force} {warned}"
    );
    for (gap, geometry) in [(0.2, "moving"), (0.02, "given"), (0.0, "given")] {
        let (force, warned) = pressed([gap, gap + 0.005], geometry, 10);
        assert!(
            force > 1e4 && !warned.contains("off all soil"),
            "{gap} {geometry}: {force} {warned}"
        );
    }
}

/// GOAL: small settlements find the stiffness of the soil: what soil goes into a body by is small beside them.
/// ORACLE: with the modulus M of one-dimensional compression, p = M (way − w)/2 m, where w is h √(2 · 10⁻⁶ p/(30 E)) below a pressure of
/// 1.5 · 10⁻⁵ E, and h p/(30 E) + 0.5 · 10⁻⁶ h above: 0.6 % less than M way/2 m at 10 mm and at 1 mm, 0.7 % at 0.1 mm.
#[test]
fn small_settlements_find_the_stiffness_of_the_soil() {
    let (young, cell, closing) = (10e6_f64, 0.25, 1e-6);
    let modulus = young * 0.7 / (1.3 * 0.4);
    for (way, less) in [(0.01, 0.0056), (0.001, 0.0057), (1e-4, 0.0068)] {
        let stiff = modulus * way / 2.0;
        let into = |p: f64| {
            let share = p / (30.0 * young);
            if share > 0.5 * closing {
                cell * (share + 0.5 * closing)
            } else {
                cell * (2.0 * closing * share).sqrt()
            }
        };
        let soft = (0..200).fold(stiff, |p, _| 0.5 * (p + modulus * (way - into(p)) / 2.0));
        let (force, _) = pressed([0.0, way], "given", 10);
        println!("{way} m: {force} of {stiff} N/m");
        assert!((force / soft - 1.0).abs() < 1e-3, "{force} {soft}");
        assert!(
            (1.0 - force / stiff - less).abs() < 0.001,
            "{force} {stiff}"
        );
    }
}

/// GOAL: a plate that crosses a gap meets the soil at any number of steps.
/// CASE: 0.2 m, out of sight of the soil, in steps of a tenth, a half, and all of it.
/// ORACLE: the force of ten steps, and one-dimensional compression of a slab that has been pressed by 5 mm.
#[test]
fn a_gap_is_crossed_in_any_number_of_steps() {
    let stiff = 10e6 * 0.7 / (1.3 * 0.4) * 0.005 / 2.0;
    for steps in [10, 3, 2, 1] {
        let (force, _) = pressed([0.2, 0.205], "moving", steps);
        println!("{steps} steps: {force} of {stiff} N/m");
        assert!((force / stiff - 1.0).abs() < 0.02, "{steps}: {force}");
    }
}

/// GOAL: half of a body on its plane of symmetry carries half of what all of it does, wherever the knots of its surface lie.
/// CASE: smooth strips on soil that yields, of 3 and 4 intervals between knots.
/// ORACLE: the whole strip.
#[test]
fn half_of_a_body_carries_half() {
    let strip = |cell: f64, from: f64| {
        let text = format!(
            r#"
igimp = 1
[case]
title = "half a strip"
gravity = "0 m/s2"
[grid]
cell = "{cell} m"
fit = "none"
domain = {{ x = ["{from} m", "4 m"], y = ["0 m", "4 m"] }}
[materials.clay]
model = "tresca"
cu = "30 kPa"
unit_weight = "18 kN/m3"
young = "5 MPa"
poisson = 0.45
[[bodies]]
name = "clay"
material = "clay"
polygon = [["{from} m", "0 m"], ["4 m", "0 m"], ["4 m", "2 m"], ["{from} m", "2 m"]]
[[rigid]]
name = "strip"
type = "rectangle"
from = ["-1 m", "2 m"]
to = ["1 m", "3 m"]
interface = "smooth"
force_factor = {factor}
[[stages]]
name = "push"
type = "rigid"
bodies = [{{ body = "strip", y = "-0.05 m" }}]
steps = 5
geometry = "given"
[[curves]]
name = "resistance"
x = {{ of = "step" }}
y = {{ of = "rigid.strip.resistance" }}
[output]
report = false
figures = []
"#,
            factor = if from < 0.0 { 1 } else { 2 },
        );
        ended(&text).0[1]
    };
    for cell in [0.5, 0.4] {
        let (whole, half) = (strip(cell, -4.0), strip(cell, 0.0));
        println!("cells of {cell} m: {whole} and {half} N/m");
        assert!((half / whole - 1.0).abs() < 1e-6, "{cell}: {whole} {half}");
    }
}

/// GOAL: a quarter of a plate in space carries a quarter of what all of it does.
/// CASE: a smooth plate of four cells, three intervals between knots, on elastic soil.
/// ORACLE: the whole plate.
#[test]
fn a_quarter_of_a_plate_carries_a_quarter() {
    let plate = |from: f64| {
        let text = format!(
            r#"
igimp = 1
[case]
title = "a quarter of a plate"
analysis = "3d"
gravity = "0 m/s2"
[grid]
cell = "0.25 m"
domain = {{ x = ["{from} m", "1 m"], y = ["{from} m", "1 m"], z = ["0 m", "1.5 m"] }}
[materials.soil]
model = "elastic"
unit_weight = "18 kN/m3"
young = "10 MPa"
poisson = 0.3
[[bodies]]
name = "soil"
material = "soil"
box = {{ from = ["{from} m", "{from} m", "0 m"], to = ["1 m", "1 m", "1 m"] }}
[[rigid]]
name = "plate"
type = "box"
from = ["-0.5 m", "-0.5 m", "1 m"]
to = ["0.5 m", "0.5 m", "2 m"]
interface = "smooth"
force_factor = {factor}
[[stages]]
name = "push"
type = "rigid"
bodies = [{{ body = "plate", z = "-0.01 m" }}]
steps = 1
geometry = "given"
[[curves]]
name = "resistance"
x = {{ of = "step" }}
y = {{ of = "rigid.plate.resistance" }}
[output]
report = false
figures = []
"#,
            factor = if from < 0.0 { 1 } else { 4 },
        );
        end_of(&in_memory(parsed(&text).case_in_space()).unwrap()).0[1]
    };
    let (whole, quarter) = (plate(-1.0), plate(0.0));
    println!("{whole} and {quarter} N");
    assert!((quarter / whole - 1.0).abs() < 1e-6, "{whole} {quarter}");
}

/// The force of a wall that holds ground 2 m high after one stage, per metre run \[N/m\], with the origin `at` \[m\].
fn held(at: [f64; 2], interface: &str, young: f64, stage: &str) -> [f64; 2] {
    let [x, y] = at;
    let text = format!(
        r#"
igimp = 1
[case]
title = "ground beside a wall"
[grid]
cell = "0.25 m"
domain = {{ x = ["{x0} m", "{x4} m"], y = ["{y} m", "{y3} m"] }}
[materials.soil]
model = "elastic"
unit_weight = "20 kN/m3"
young = "{young} MPa"
poisson = 0.3
k0 = 0.5
[[bodies]]
name = "ground"
material = "soil"
polygon = [["{x} m", "{y} m"], ["{x4} m", "{y} m"], ["{x4} m", "{y2} m"], ["{x} m", "{y2} m"]]
[boundaries]
left = "free"
bottom = "roller"
[[rigid]]
name = "wall"
type = "wall"
from = ["{x} m", "{below} m"]
to = ["{x} m", "{y3} m"]
thickness = "0.6 m"
interface = "{interface}"
from_start = true
[[stages]]
name = "stage"
{stage}
[[curves]]
name = "thrust"
x = {{ of = "rigid.wall.force_x" }}
y = {{ of = "rigid.wall.force_y" }}
[output]
report = false
figures = []
"#,
        x0 = x - 1.0,
        x4 = x + 4.0,
        y2 = y + 2.0,
        y3 = y + 3.0,
        below = y - 0.5,
    );
    let end = ended(&text).0;
    [end[0], end[1]]
}

/// GOAL: a rough side sticks from its first step on, wherever the origin lies.
/// CASE: elastic ground that gets its weight in one step beside a rough wall.
/// ORACLE: equations do not know of the origin. By round-off of places the wall was smooth at some of them, with no force along it.
#[test]
fn a_rough_wall_holds_at_any_origin() {
    let weight = "type = \"gravity\"\nsteps = 1";
    let [across, along] = held([0.0, 0.0], "rough", 20.0, weight);
    println!("{across} and {along} N/m");
    assert!(along.abs() > 0.3 * across.abs(), "{across} {along}");
    for at in [[0.1, 0.3], [137.3, -41.7], [-3.7, 1e3]] {
        let found = held(at, "rough", 20.0, weight);
        assert!((found[0] / across - 1.0).abs() < 1e-6, "{at:?} {found:?}");
        assert!((found[1] / along - 1.0).abs() < 1e-6, "{at:?} {found:?}");
    }
}

/// GOAL: a smooth wall that holds ground at rest has its thrust, whatever the stiffness of the ground.
/// ORACLE: K₀ γ H²/2.
#[test]
fn a_wall_has_the_thrust_at_rest() {
    let exact = 0.5 * 20e3 * 2.0;
    for young in [5.0, 20.0, 200.0] {
        let [across, _] = held([0.0, 0.0], "smooth", young, "type = \"k0\"\nsteps = 2");
        println!("{young} MPa: {across} of {exact} N/m");
        assert!((across / exact - 1.0).abs() < 0.03, "{young}: {across}");
    }
}
