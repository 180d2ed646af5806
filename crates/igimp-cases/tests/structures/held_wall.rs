//! Soil at rest beside a wall that is held, wherever the face of the wall lies in its cell.

use igimp_cases::run::in_memory;
use igimp_input::CaseFile;

/// ν / (1 − ν) of the soil below.
const AT_REST: f64 = 0.3 / 0.7;

/// Elastic soil, 2 m high and 3 m wide, beside a smooth wall that is held; the face of the wall is so many cells off a line of the grid. On the
/// right of the wall, or mirrored on its left.
fn text(place: f64, (points, steps): (usize, usize), is_mirrored: bool, further: &str) -> String {
    text_of(5.0, place, (points, steps), is_mirrored, further)
}

/// The same in soil of this Young's modulus \[MPa\].
fn text_of(
    young: f64,
    place: f64,
    (points, steps): (usize, usize),
    is_mirrored: bool,
    further: &str,
) -> String {
    let at = |x: f64| if is_mirrored { 5.0 - x } else { x };
    let span = |a: f64, b: f64| [at(a).min(at(b)), at(a).max(at(b))];
    let face = 1.0 + 0.25 * place;
    let ([grid0, grid1], [soil0, soil1], [wall0, wall1]) =
        (span(0.0, 4.0), span(face, 4.0), span(face - 0.75, face));
    let end = if further.is_empty() { "wait" } else { "slide" };
    format!(
        r#"
igimp = 1
[case]
title = "Soil at rest beside a wall"
[grid]
cell = "0.25 m"
fit = "none"
domain = {{ x = ["{grid0} m", "{grid1} m"], y = ["0 m", "3 m"] }}
[materials.soil]
model = "elastic"
unit_weight = "20 kN/m3"
young = "{young} MPa"
poisson = 0.3
[[bodies]]
name = "ground"
material = "soil"
points_per_cell = {points}
polygon = [["{soil0} m", "0 m"], ["{soil1} m", "0 m"], ["{soil1} m", "2 m"], ["{soil0} m", "2 m"]]
[boundaries]
bottom = "roller"
[[rigid]]
name = "wall"
type = "rectangle"
from = ["{wall0} m", "-1 m"]
to = ["{wall1} m", "4 m"]
interface = "smooth"
from_start = true
[[stages]]
name = "weight"
type = "gravity"
geometry = "moving"
steps = {steps}
[[stages]]
name = "wait"
type = "gravity"
factor = 1
geometry = "moving"
steps = {steps}
{further}
[[curves]]
name = "weight"
stage = "weight"
x = {{ of = "step" }}
y = {{ of = "rigid.wall.force_x" }}
[[curves]]
name = "end"
stage = "{end}"
x = {{ of = "step" }}
y = {{ of = "rigid.wall.force_x" }}
[output]
figures = []
"#
    )
}

/// Forces on the wall over the exact one, γ H² / 2 times that at rest: with the weight of the soil, and in the end.
fn forces(text: &str) -> [f64; 2] {
    let file = CaseFile::parse("wall.toml", text, &[]).unwrap();
    let run = in_memory(file.case()).unwrap();
    assert!(run.failure.is_none(), "{:?}", run.failure);
    let exact = AT_REST * 20e3 * 2.0;
    ["weight", "end"].map(|name| {
        let curve = run.curves.iter().find(|curve| curve.name == name).unwrap();
        curve.points(0, 1).last().unwrap()[1].abs() / exact
    })
}

/// GOAL: a held smooth wall carries soil at rest wherever its face lies in its cell, and goes on to carry it where nothing happens.
/// CASE: twelve places, two steps and ten, four and nine points, the soil on either side. A row of particles that the face cuts is thinner than
/// half of those behind at some of them, and soil that joined the row behind, which holds a gap open that is not there, lies at the face at others.
/// ORACLE: elastic soil between smooth sides has K = ν / (1 − ν) throughout. While the mean of all faces was taken over 6 to 24 % were lost, more with
/// every step, and all of it where soil had joined the row behind.
#[test]
fn soil_at_rest_presses_on_a_held_wall_wherever_its_face_is() {
    let places = [
        0.0, 0.05, 0.2, 0.24, 0.26, 0.31, 0.4, 0.47, 0.5, 0.76, 0.95, 0.98,
    ];
    for (k, place) in places.into_iter().enumerate() {
        for (points, steps) in [(4, 2), (4, 10), (9, 3)] {
            let found = forces(&text(place, (points, steps), k % 2 == 1, ""));
            let label = format!("{place}, {points} points, {steps} steps: {found:?}");
            assert!(found.iter().all(|x| (x - 1.0).abs() < 0.02), "{label}");
            assert!((found[1] / found[0] - 1.0).abs() < 1e-4, "{label}");
        }
    }
}

/// GOAL: soil beside a held smooth wall has the stress that the wall carries.
/// CASE: places at which the face cuts the first row of particles, some to less than half.
/// ORACLE: by equilibrium horizontal stress is the same along each level. While a row behind the rest of one that is cut carried a part of the
/// force of contact, the first column had 17 % less.
#[test]
fn stress_beside_a_held_wall_is_that_of_all_the_soil() {
    for place in [0.1, 0.25, 0.3, 0.4, 0.76] {
        let file = CaseFile::parse("wall.toml", &text(place, (4, 2), false, ""), &[]).unwrap();
        let run = in_memory(file.case()).unwrap();
        let particles = &run.body.particles;
        let face = 1.0 + 0.25 * place;
        let level = |particle: usize| (particles.x[particle][1] / 0.125) as usize;
        let stress = |from: f64, to: f64, at: usize| -> f64 {
            let row = (0..particles.len())
                .filter(|&k| (from..to).contains(&(particles.x[k][0] - face)) && level(k) == at);
            let stresses: Vec<f64> = row.map(|k| particles.sigma[k][0][0]).collect();
            stresses.iter().sum::<f64>() / stresses.len() as f64
        };
        // In the cell at the surface stress is a tenth of a kPa or two too small where the face cuts it, for a cause that is not known.
        for at in 1..14 {
            let [first, others] = [stress(0.0, 0.2, at), stress(0.7, 2.0, at)];
            assert!(
                (first / others - 1.0).abs() < 0.01,
                "{place}, {at}: {first} {others}"
            );
        }
    }
}

/// GOAL: a held smooth wall carries soil at rest however stiff the soil is.
/// CASE: four places, soil of loose sand to that of sound rock.
/// ORACLE: K = ν / (1 − ν) has no stiffness. Where contact closes over 1e-4 of a cell, and not over 1e-6 of one, 4 % is lost at 200 MPa and 10 % at 2000.
#[test]
fn stiff_soil_at_rest_presses_on_a_held_wall_as_soft_soil_does() {
    for young in [20.0, 200.0, 2000.0] {
        for place in [0.0, 0.26, 0.47, 0.95] {
            let [weight, end] = forces(&text_of(young, place, (4, 5), false, ""));
            let label = format!("{young} MPa, {place}: {weight} {end}");
            assert!((weight - 1.0).abs() < 0.015, "{label}");
            assert!((end / weight - 1.0).abs() < 1e-4, "{label}");
        }
    }
}

/// GOAL: soil that slides along a smooth wall takes its pressure neither along nor away.
/// CASE: the wall goes down by two cells beside soil at rest, its face on a line and where it cuts the particles.
/// ORACLE: nothing that is smooth moves the soil: the force stays. All of it was lost where the row at the wall is thin.
#[test]
fn a_wall_slides_along_soil_at_rest() {
    let slides = r#"
[[stages]]
name = "slide"
type = "rigid"
geometry = "moving"
bodies = [{ body = "wall", y = "-0.5 m" }]
steps = 20
"#;
    for place in [0.0, 0.26, 0.4] {
        let [held, slid] = forces(&text(place, (4, 4), false, slides));
        println!("{place}: {held} {slid}");
        assert!((slid / held - 1.0).abs() < 0.01, "{place}: {held} {slid}");
    }
}
