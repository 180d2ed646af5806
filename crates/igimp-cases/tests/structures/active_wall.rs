//! Sand that a smooth wall moves away from, wherever the face of the wall lies in its cell.

use igimp_cases::run::in_memory;
use igimp_input::shipped::find;

/// Side of a cell \[m\].
const CELL: f64 = 0.25;

/// The template `wall` with the face so many cells off a line of the grid, on the way away from the sand.
fn overrides(place: f64) -> Vec<String> {
    let start = -(2.0 + place) * CELL;
    let end = start + ((8.0 - start) / CELL).round() * CELL;
    let corners = [[0.0, 0.0], [end, 0.0], [end, 2.0], [0.0, 2.0]];
    let corners = corners.map(|[x, y]| format!("[\"{x} m\", \"{y} m\"]"));
    vec![
        format!("grid.domain={{ x = [\"{start} m\", \"{end} m\"], y = [\"0 m\", \"3 m\"] }}"),
        format!("bodies.soil.polygon=[{}]", corners.join(", ")),
        "stages.1.bodies=[{ body = \"wall\", x = \"-10 mm\" }]".to_owned(),
        "stages.1.steps=20".to_owned(),
        "stages.2.steps=1".to_owned(),
        "stages.2.bodies=[{ body = \"wall\", x = \"0.1 mm\" }]".to_owned(),
        "checks=[]".to_owned(),
        "grid.fit=none".to_owned(),
    ]
}

/// GOAL: the active force on a wall does not hang on where the grid lies, and the soil beside it has the stress that the wall carries.
/// CASE: nine places of the face in its cell; from a twentieth of a cell on it cuts the first row of particles, some to less than half.
/// ORACLE: Rankine, with the cohesion of 0.1 kPa: K = 1/3 − 4 c √(1/3) / (γ H), and by equilibrium the same in every column of cells.
#[test]
fn sand_presses_on_a_wall_alike_wherever_its_face_is() {
    let rankine = 1.0 / 3.0 - 4.0 * 0.1 * (1.0_f64 / 3.0).sqrt() / 40.0;
    for place in [0.0, 0.05, 0.2, 0.25, 0.3, 0.4, 0.5, 0.75, 0.9] {
        let file = find("wall").unwrap().case_file(overrides(place)).unwrap();
        let run = in_memory(file.case()).unwrap();
        assert!(run.failure.is_none(), "{place}: {:?}", run.failure);
        let curve = |name: &str| run.curves.iter().find(|curve| curve.name == name).unwrap();
        let force = curve("active").points(0, 1).last().unwrap()[1];
        assert!((force / rankine - 1.0).abs() < 0.01, "{place}: {force}");
    }
}
