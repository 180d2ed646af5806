//! Values outside the range of soil, rock, water, steel and geotextiles: mostly a slip of the unit, of a thousand or of rad for
//! deg. One table of ranges by key serves constants, profiles and rasters.

use crate::diagnostic::Problems;
use crate::source::Place;
use crate::text::{clip, number};
use crate::tree::{Node, Value};

/// A key with the values that are found in the ground.
struct Plausible {
    /// The table of the file that it belongs to, at any depth.
    part: &'static str,
    key: &'static str,
    /// Smallest and largest, in SI units, without the sign.
    between: [f64; 2],
    /// The divisor of SI values in print, and the unit after that.
    unit: (f64, &'static str),
    help: &'static str,
}

const fn range(
    (part, key): (&'static str, &'static str),
    between: [f64; 2],
    unit: (f64, &'static str),
    help: &'static str,
) -> Plausible {
    Plausible {
        part,
        key,
        between,
        unit,
        help,
    }
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;
const KPA: (f64, &str) = (1e3, "kPa");
const MPA: (f64, &str) = (1e6, "MPa");
const KN_M3: (f64, &str) = (1e3, "kN/m3");
const DEG: (f64, &str) = (DEGREE, "deg");
const NONE: (f64, &str) = (1.0, "");
const MODULUS: &str = "soil has 1 to 500 MPa, rock up to 100 GPa, steel 210 GPa";

/// The ranges; bounds lie far off what is usual, so that a slip by a thousand is met and a rare soil is not.
const PLAUSIBLE: [Plausible; 33] = [
    range(
        ("materials", "unit_weight"),
        [0.2e3, 120e3],
        KN_M3,
        "soil has 14 to 24 kN/m3; the unit may be meant to be kN/m3",
    ),
    range(
        ("materials", "saturated_unit_weight"),
        [8e3, 120e3],
        KN_M3,
        "soil with its water has 15 to 24 kN/m3",
    ),
    range(("materials", "young"), [1e3, 500e9], MPA, MODULUS),
    range(("materials", "e50"), [1e3, 500e9], MPA, MODULUS),
    range(("materials", "eur"), [1e3, 500e9], MPA, MODULUS),
    range(("materials", "eoed"), [1e3, 500e9], MPA, MODULUS),
    range(("materials", "shear"), [1e3, 200e9], MPA, MODULUS),
    range(
        ("materials", "cohesion"),
        // A few Pa hold the surface of sand together.
        [1.0, 5e6],
        KPA,
        "soil has 0 to 100 kPa; the unit may be meant to be kPa",
    ),
    range(
        ("materials", "cu"),
        [30.0, 5e6],
        KPA,
        "clay has 5 to 500 kPa; the unit may be meant to be kPa",
    ),
    range(
        ("materials", "friction"),
        [DEGREE, 70.0 * DEGREE],
        DEG,
        "soil has 15 to 45 deg; 0.35 rad are 20 deg",
    ),
    range(
        ("materials", "permeability"),
        [1e-16, 0.1],
        (1.0, "m/s"),
        "clay has 1e-11 to 1e-8 m/s, sand 1e-6 to 1e-3, gravel up to 0.1",
    ),
    range(
        ("materials", "ratio"),
        [0.01, 5.0],
        NONE,
        "clay has 0.2 to 0.35 of the vertical effective stress: 0.22, not 22 %",
    ),
    range(
        ("materials", "strain"),
        [1e-5, 8.0],
        NONE,
        "a strain of 10 % is 0.1",
    ),
    range(
        ("materials", "simple_shear"),
        [0.1, 3.0],
        NONE,
        "a share of `cu`, mostly 0.6 to 0.9: 0.7, not 70 %",
    ),
    range(
        ("materials", "passive"),
        [0.1, 3.0],
        NONE,
        "a share of `cu`, mostly 0.4 to 0.8: 0.5, not 50 %",
    ),
    range(
        ("materials", "sci"),
        [0.1e6, 1e9],
        MPA,
        "rock has 1 to 300 MPa; the unit may be meant to be MPa",
    ),
    range(
        ("materials", "gsi"),
        [5.0, 100.0],
        NONE,
        "rock masses have 10 to 90: 30, not 0.3",
    ),
    range(("materials", "mi"), [1.0, 50.0], NONE, "rock has 4 to 33"),
    range(
        ("materials", "pore_water"),
        [1e6, 1e12],
        MPA,
        "water has 2200 MPa, over a porosity of 0.3 to 0.6",
    ),
    range(
        ("case", "gravity"),
        [0.1, 5e3],
        (1.0, "m/s2"),
        "on earth it is 9.81 m/s2, in a centrifuge up to some hundred times that",
    ),
    range(
        ("loads", "pressure"),
        [100.0, 10e6],
        KPA,
        "footings have 50 to 1000 kPa; the unit may be meant to be kPa",
    ),
    range(
        ("reinforcement", "capacity"),
        [500.0, 20e6],
        (1e3, "kN"),
        "nails and geotextiles carry 10 to 1000 kN, anchors up to some MN; in the plane per metre run",
    ),
    range(
        ("reinforcement", "head_capacity"),
        [500.0, 20e6],
        (1e3, "kN"),
        "heads carry 10 to 1000 kN; in the plane per metre run",
    ),
    range(
        ("reinforcement", "end_capacity"),
        [500.0, 20e6],
        (1e3, "kN"),
        "ends carry 10 to 1000 kN per metre run",
    ),
    range(
        ("reinforcement", "prestress"),
        [500.0, 20e6],
        (1e3, "kN"),
        "anchors have 50 to 2000 kN; in the plane per metre run",
    ),
    range(
        ("reinforcement", "stiffness"),
        [10e3, 10e9],
        (1e6, "MN"),
        "geotextiles have 0.2 to 10 MN/m, a nail of steel some 100 MN over its spacing",
    ),
    range(
        ("reinforcement", "bond"),
        [500.0, 10e6],
        (1e3, "kPa, in space kN/m"),
        "nails have 10 to 300 kN a metre; the unit may be meant to be kPa, in space kN/m",
    ),
    range(
        ("reinforcement", "plate"),
        [0.02, 20.0],
        (1.0, "m"),
        "plates are 0.1 to 1 m wide",
    ),
    range(
        ("rigid", "adhesion"),
        [30.0, 3e6],
        KPA,
        "clay on steel or concrete has 5 to 100 kPa; the unit may be meant to be kPa",
    ),
    range(
        ("rigid", "angle"),
        [DEGREE, 70.0 * DEGREE],
        DEG,
        "soil on steel or concrete has 10 to 40 deg; 0.35 rad are 20 deg",
    ),
    range(
        ("rigid", "force_factor"),
        [0.1, 100.0],
        NONE,
        "the whole body over the part that is modelled: 2 for half a body, 4 for a quarter",
    ),
    range(
        ("stages", "horizontal"),
        [1e-4, 3.0],
        NONE,
        "a share of the weight: 0.2, not 20 %",
    ),
    range(
        ("materials", "grain_diameter"),
        [1e-6, 10.0],
        (1e-3, "mm"),
        "sand has 0.06 to 2 mm, blocks up to some metres",
    ),
];

/// Keys in tables whose values are those of the key that has the table.
const OF_PROFILE: [&str; 6] = [
    "at_surface",
    "at_top",
    "values",
    "rows",
    "horizontal",
    "vertical",
];
/// Depth over which a gradient makes a value that is looked at \[m\].
const DEPTH: f64 = 10.0;
/// Density of water with what it carries, at least and at most \[kg/m³\].
const WATER: [f64; 2] = [700.0, 1600.0];
/// Gravity of unit weights where the case has none \[m/s²\].
const GRAVITY: f64 = 9.81;

/// Checks the values that are written in a completed file; zero is plausible for all of them.
pub fn check(tree: &Node, problems: &mut Problems) {
    for plausible in &PLAUSIBLE {
        let Some(part) = tree.get(plausible.part) else {
            continue;
        };
        let of_list = part.items().iter();
        let of_list = of_list.map(|item| (item.text_at("name"), item));
        let items: Vec<(Option<&str>, &Node)> = match plausible.part {
            "case" => vec![(None, part)],
            "materials" => {
                let named = part.entries().iter();
                named
                    .map(|item| (Some(&item.key[..]), &item.node))
                    .collect()
            }
            _ => of_list.collect(),
        };
        for (name, item) in items {
            let mut found = Vec::new();
            plausible.numbers(item, ("", item.place, false), &mut found);
            plausible.report(name, &found, problems);
        }
    }
    check_water(tree, problems);
    check_loads(tree, problems);
}

/// A number of a key.
struct Stated {
    value: f64,
    place: Place,
    /// Whether it is one of several.
    varies: bool,
}

impl Plausible {
    /// The numbers of the key in the value of a key: its own, those of a list, of a profile, and of tables within.
    fn numbers(
        &self,
        node: &Node,
        (key, place, varies): (&str, Place, bool),
        found: &mut Vec<Stated>,
    ) {
        let is_key = key == self.key;
        let mut add = |value: f64, place: Place, varies: bool| {
            found.push(Stated {
                value,
                place,
                varies,
            });
        };
        if let Some(value) = node.number().filter(|_| is_key) {
            add(value, place, varies);
        }
        let gradient = node.entry("gradient").filter(|_| is_key);
        if let Some((entry, value)) = gradient.and_then(|entry| Some((entry, entry.node.number()?)))
            && DEPTH * value > self.between[1]
        {
            add(DEPTH * value, entry.node.place, true);
        }
        for item in node.items() {
            self.numbers(item, (key, place, varies), found);
        }
        for entry in node.entries().iter().filter(|entry| entry.node.written) {
            let (inner, place) = (&entry.key[..], entry.node.place);
            let at = if is_key && OF_PROFILE.contains(&inner) {
                let is_list = matches!(entry.node.value, Value::List(_));
                (key, place, is_list || inner.starts_with("at_"))
            } else {
                (inner, place, false)
            };
            self.numbers(&entry.node, at, found);
        }
    }

    /// Warns of the greatest and the smallest number outside the range, once of each.
    fn report(&self, name: Option<&str>, found: &[Stated], problems: &mut Problems) {
        let [least, most] = self.between;
        let written = || found.iter().filter(|stated| stated.value != 0.0);
        let size = |stated: &&Stated| stated.value.abs();
        let by_size = |a: &&Stated, b: &&Stated| size(a).total_cmp(&size(b));
        let high = written().max_by(by_size).filter(|item| size(item) > most);
        let low = written().min_by(by_size).filter(|item| size(item) < least);
        for (stated, bound) in [(high, "up to "), (low, "down to ")] {
            let Some(stated) = stated else { continue };
            let subject =
                name.map_or_else(String::new, |name| format!("`{}` has ", clip(name, 40)));
            let (scale, unit) = self.unit;
            let printed = format!("{} {unit}", number(stated.value / scale));
            let equals = if stated.varies { bound } else { "= " };
            problems
                .warning(
                    stated.place,
                    format!(
                        "{subject}{} {equals}{}, outside the range of soil, rock and structures",
                        self.key,
                        printed.trim_end()
                    ),
                )
                .help(self.help);
        }
    }
}

/// Warns of water that is far lighter or heavier than water under the gravity of the case.
fn check_water(tree: &Node, problems: &mut Problems) {
    let Some(case) = tree.get("case") else { return };
    let node = case.get("water_unit_weight").filter(|node| node.written);
    let Some((node, weight)) = node.and_then(|node| Some((node, node.number()?))) else {
        return;
    };
    let gravity = case.get("gravity").and_then(Node::number);
    let gravity = gravity.filter(|value| *value > 0.0).unwrap_or(GRAVITY);
    let density = weight / gravity;
    if !(WATER[0]..=WATER[1]).contains(&density) {
        problems
            .warning(
                node.place,
                format!(
                    "water_unit_weight = {} kN/m3 is not that of water",
                    number(weight / 1e3)
                ),
            )
            .help(format!(
                "water has {} kN/m3 under a gravity of {} m/s2; uplift and pressures on the ground follow it",
                number((10.0 * gravity).round() / 10.0),
                number(gravity)
            ));
    }
}

/// Warns of pressures that pull, and of loads that are stated twice.
fn check_loads(tree: &Node, problems: &mut Problems) {
    let loads = tree.items_at("loads");
    for (index, load) in loads.iter().enumerate() {
        let Some(name) = load.text_at("name") else {
            continue;
        };
        let pressure = load.get("pressure");
        let pulls = pressure.filter(|node| node.number().is_some_and(|value| value < 0.0));
        if let Some(pressure) = pulls {
            problems
                .warning(
                    pressure.place,
                    format!(
                        "the pressure of load `{}` pulls at the soil",
                        clip(name, 40)
                    ),
                )
                .help("pressures are positive into the soil");
        }
        let same = loads[..index].iter().find(|other| is_same(load, other));
        if let Some(other) = same.and_then(|same| same.text_at("name")) {
            problems
                .warning(
                    load.place,
                    format!(
                        "load `{}` is load `{}` once more",
                        clip(name, 40),
                        clip(other, 40)
                    ),
                )
                .help("stages that apply both have twice the load there");
        }
    }
}

/// Whether two tables hold the same but for their names.
fn is_same(a: &Node, b: &Node) -> bool {
    let entries = |of: &Node| of.entries().iter().filter(|row| row.key != "name").count();
    let all = || a.entries().iter().filter(|row| row.key != "name");
    match (&a.value, &b.value) {
        (Value::Table(_), Value::Table(_)) => {
            entries(a) == entries(b)
                && all().all(|row| {
                    b.get(&row.key)
                        .is_some_and(|other| is_same(&row.node, other))
                })
        }
        (Value::List(a), Value::List(b)) => {
            a.len() == b.len() && std::iter::zip(a, b).all(|(a, b)| is_same(a, b))
        }
        (Value::Text(a), Value::Text(b)) => a == b,
        (Value::Flag(a), Value::Flag(b)) => a == b,
        _ => a
            .number()
            .zip(b.number())
            .is_some_and(|(a, b)| a.total_cmp(&b).is_eq()),
    }
}
