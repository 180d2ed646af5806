//! More slices: water, stages of construction and reinforcement in space as they are in plane strain.

use igimp_cases::CaseError;
use rayon::prelude::*;

use super::{check_pair, computed, differences};
use crate::harness::study::Study;
use crate::runs::Computed;

/// A case of both: `(x, y)` stands for a point, `@across` for the thickness of a body, `@m` for the unit of a force per metre.
struct Pair {
    name: &'static str,
    /// The case file after grid, materials and supports.
    text: &'static str,
    /// Whether members of reinforcement are held against those of the plane.
    is_reinforced: bool,
}

const HEAD: &str = r#"igimp = 1
[case]
title = "slice"
analysis = "@analysis"
gravity = "10 m/s2"
water_unit_weight = "10 kN/m3"
[grid]
cell = "1 m"
domain = { x = ["0 m", "10 m"], @domain }
small_cuts = { below = 1e-4 }
[materials.sand]
model = "mohr-coulomb"
unit_weight = "18 kN/m3"
saturated_unit_weight = "20 kN/m3"
young = "20 MPa"
poisson = 0.3
cohesion = "8 kPa"
friction = "28 deg"
dilation = "5 deg"
k0 = 0.5
[materials.silt]
model = "mohr-coulomb"
unit_weight = "18 kN/m3"
saturated_unit_weight = "20 kN/m3"
young = "20 MPa"
poisson = 0.3
cohesion = "15 kPa"
friction = "25 deg"
drainage = "undrained"
[materials.treated]
model = "elastic"
unit_weight = "20 kN/m3"
young = "60 MPa"
poisson = 0.25
[boundaries]
left = "roller"
right = "roller"
bottom = "fixed"
@sides
[solver]
tolerance = 1e-11
"#;

const SLOPE: &str = r#"
[[bodies]]
name = "slope"
material = "sand"
points_per_cell = @points
polygon = [["0 m", "0 m"], ["10 m", "0 m"], ["10 m", "2 m"], ["7 m", "2 m"], ["3 m", "6 m"], ["0 m", "6 m"]]
@across
"#;

const PAIRS: [Pair; 6] = [
    Pair {
        name: "slope below a water table",
        text: r#"@slope
[[water]]
name = "table"
line = [["0 m", "5 m"], ["3.3 m", "4.4 m"], ["7 m", "2 m"], ["10 m", "2 m"]]
[[stages]]
name = "weight"
type = "gravity"
steps = 5
"#,
        is_reinforced: false,
    },
    Pair {
        name: "slope with r_u, carried along",
        text: r#"@slope
[[water]]
name = "ratio"
r_u = 0.2
carried = true
[[stages]]
name = "weight"
type = "gravity"
steps = 5
"#,
        is_reinforced: false,
    },
    Pair {
        name: "slope with given pressures",
        text: r#"@slope
[[water]]
name = "given"
u = { x = ["0 m", "5 m", "10 m"], y = ["0 m", "3 m", "6 m"], rows = [["40 kPa", "30 kPa", "20 kPa"], ["15 kPa", "10 kPa", "0 kPa"], ["0 kPa", "-10 kPa", "0 kPa"]] }
pond = true
[[stages]]
name = "weight"
type = "gravity"
steps = 5
"#,
        is_reinforced: false,
    },
    Pair {
        name: "rapid drawdown, undrained",
        text: r#"@silty
[[water]]
name = "full"
level = "5.5 m"
[[water]]
name = "drawn"
inside = "5 m"
outside = "3 m"
[[stages]]
name = "weight"
type = "gravity"
drained = true
steps = 5
[[stages]]
name = "drawdown"
type = "construction"
water = "drawn"
steps = 3
[[stages]]
name = "dissipate"
type = "construction"
dissipate = true
steps = 2
"#,
        is_reinforced: false,
    },
    Pair {
        name: "ground dug, filled and treated",
        text: r#"
[[bodies]]
name = "ground"
material = "sand"
points_per_cell = @points
polygon = [["0 m", "0 m"], ["10 m", "0 m"], ["10 m", "2 m"], ["8 m", "2 m"], ["5 m", "5 m"], ["0 m", "5 m"]]
@across
[[bodies]]
name = "pit"
material = "sand"
points_per_cell = @points
polygon = [["10 m", "2 m"], ["10 m", "5 m"], ["5 m", "5 m"], ["8 m", "2 m"]]
@across
[[bodies]]
name = "fill"
material = "sand"
points_per_cell = @points
polygon = [["0 m", "5 m"], ["3 m", "5 m"], ["2 m", "6 m"], ["0 m", "6 m"]]
@across
[[water]]
name = "high"
level = "4 m"
[[water]]
name = "low"
line = [["0 m", "4 m"], ["8 m", "2 m"]]
[[stages]]
name = "rest"
type = "k0"
steps = 1
[[stages]]
name = "dig"
type = "construction"
remove = ["pit"]
water = "low"
steps = 5
[[stages]]
name = "fill"
type = "construction"
place = ["fill"]
materials = [{ body = "ground", material = "treated" }]
steps = 3
"#,
        is_reinforced: false,
    },
    Pair {
        name: "face with an anchor and nails",
        text: r#"
[[bodies]]
name = "ground"
material = "sand"
points_per_cell = @points
polygon = [["0 m", "0 m"], ["10 m", "0 m"], ["10 m", "2 m"], ["6 m", "2 m"], ["5 m", "6 m"], ["0 m", "6 m"]]
@across
[[reinforcement]]
name = "anchor"
type = "anchor"
head = ("5.25 m", "5 m")
end = ("0.75 m", "3 m")
bonded_length = "2 m"
stiffness = "20 MN@m"
capacity = "100 kN@m"
bond = "@bond"
prestress = "15 kN@m"
[[reinforcement]]
name = "nail"
type = "nail"
head = ("5.6 m", "3.5 m")
end = ("2 m", "3 m")
stiffness = "10 MN@m"
capacity = "60 kN@m"
bond = "@bond"
[[stages]]
name = "weight"
type = "gravity"
steps = 5
[[stages]]
name = "lock"
type = "gravity"
install = ["anchor"]
steps = 2
[[stages]]
name = "shake"
type = "gravity"
horizontal = 0.05
steps = 2
"#,
        is_reinforced: true,
    },
];

impl Pair {
    fn text(&self, in_space: bool) -> String {
        let mut text = format!("{HEAD}{}", self.text).replace("@slope", SLOPE);
        text = text.replace("@silty", &SLOPE.replace("\"sand\"", "\"silt\""));
        let words = if in_space {
            [
                ("@analysis", "3d"),
                ("@domain", "y = [\"0 m\", \"1 m\"], z = [\"0 m\", \"7 m\"]"),
                ("@sides", "front = \"roller\"\nback = \"roller\""),
                ("@points", "8"),
                ("@across", "across = [\"0 m\", \"1 m\"]"),
                ("@bond", "30 kN/m"),
                ("@m", ""),
            ]
        } else {
            [
                ("@analysis", "plane-strain"),
                ("@domain", "y = [\"0 m\", \"7 m\"]"),
                ("@sides", ""),
                ("@points", "4"),
                ("@across", ""),
                ("@bond", "30 kPa"),
                ("@m", "/m"),
            ]
        };
        for (mark, by) in words {
            text = text.replace(mark, by);
        }
        let y = if in_space { ", \"0.5 m\", " } else { ", " };
        let lines = text.lines().map(|line| match line.split_once("(\"") {
            Some((key, point)) => {
                format!("{key}[\"{}", point.replace(')', "]").replace(", ", y))
            }
            None => line.to_owned(),
        });
        lines.collect::<Vec<_>>().join("\n")
    }

    /// Both runs.
    fn run(&self) -> Result<(Computed<2>, Computed<3>), CaseError> {
        computed(self.name, [self.text(false), self.text(true)])
    }
}

/// Largest difference of a number of particles over the largest value \[-\]; particles of space lie two deep, in the order of
/// columns.
fn of_sorted(mut plane: Vec<f64>, mut space: Vec<f64>) -> f64 {
    plane.sort_by(f64::total_cmp);
    space.sort_by(f64::total_cmp);
    if space.len() != 2 * plane.len() {
        return f64::INFINITY;
    }
    let largest = plane.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let apart = space
        .iter()
        .enumerate()
        .map(|(k, v)| (v - plane[k / 2]).abs());
    apart.fold(0.0, f64::max) / largest.max(f64::MIN_POSITIVE)
}

/// Adds the pairs to the study of slices.
pub(crate) fn add(study: &mut Study) -> Result<(), CaseError> {
    let done = PAIRS
        .par_iter()
        .map(Pair::run)
        .collect::<Result<Vec<_>, CaseError>>()?;
    for (pair, (plane, space)) in PAIRS.iter().zip(done) {
        let [displacement, stress] = differences(plane.particles(), space.particles());
        let mut found = vec![("displacement", displacement), ("stress", stress)];
        let (flat, deep) = (plane.particles(), space.particles());
        if flat.pore_pressure.iter().any(|p| *p != 0.0) {
            let sum = |given: &[f64], excess: &[f64]| {
                let both = std::iter::zip(given, excess);
                both.map(|(given, excess)| given + excess).collect()
            };
            let pressure = of_sorted(
                sum(&flat.pore_pressure, &flat.excess),
                sum(&deep.pore_pressure, &deep.excess),
            );
            found.push(("pore pressure", pressure));
        }
        if pair.is_reinforced {
            let members =
                std::iter::zip(&plane.run.body.reinforcement, &space.run.body.reinforcement);
            let bars = members.flat_map(|(a, b)| std::iter::zip(&a.segments, &b.segments));
            let forces = bars.map(|(a, b)| [a.state.force, b.state.force]);
            let [most, apart] = forces.fold([0.0_f64; 2], |[most, apart], [a, b]| {
                [most.max(a.abs()), apart.max((a - b).abs())]
            });
            found.push((
                "tension",
                if most > 0.0 {
                    apart / most
                } else {
                    f64::INFINITY
                },
            ));
        }
        check_pair(study, pair.name, &plane, &space, &found);
    }
    Ok(())
}
