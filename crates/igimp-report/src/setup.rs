//! The case in words and numbers, as tables for a reader without the case file.

mod materials;
mod stages;
mod structures;
mod water;

use igimp_model::{AxisSpec, BodyPart, Boundaries, Case, LoadKind, Side, StageKind, in_plane};
use igimp_results::summary::SetupTable;
use igimp_text::short;

pub use materials::{given_in_words, law_name, of_material};

/// Stands for an entry that a row does not have.
const NONE: &str = "–";
/// Most corners of a body that are listed one by one.
const MOST_CORNERS: usize = 24;

/// Materials, bodies, water, rigid bodies, reinforcement, supports, loads, stages and grid of a case.
pub fn tables<const D: usize>(case: &Case<D>) -> Vec<SetupTable> {
    [
        materials::materials(case),
        water::soils(case),
        bodies(case),
        water::conditions(case),
        structures::rigid_bodies(case),
        structures::reinforcement(case),
        supports(&case.boundaries),
        loads(case),
        stages::stages(case),
        grid(case),
    ]
    .into_iter()
    .filter(|table| !table.rows.is_empty())
    .collect()
}

fn table(title: &str, header: &[&str], rows: Vec<Vec<String>>) -> SetupTable {
    SetupTable {
        title: title.to_owned(),
        header: header.iter().map(|&name| name.to_owned()).collect(),
        rows,
    }
}

fn bodies<const D: usize>(case: &Case<D>) -> SetupTable {
    let come_and_go = case.stages.iter().any(|stage| match &stage.kind {
        StageKind::Construction(works) => !(works.place.is_empty() && works.remove.is_empty()),
        _ => false,
    });
    let rows = case.bodies.iter().enumerate().map(|(index, body)| {
        let corners = match in_plane::<_, BodyPart<2>>(body) {
            Some(body) => corners(body.polygon()),
            None => body.region.words(),
        };
        let per_cell = body.per_direction.pow(D as u32);
        let mut row = vec![
            body.name.clone(),
            case.materials[body.material].name.clone(),
            corners,
            per_cell.to_string(),
        ];
        if come_and_go {
            row.push(while_there(case, index));
        }
        row
    });
    let mut header = vec!["Body", "Material", "Corners [m]", "Particles per cell"];
    if come_and_go {
        header.push("There");
    }
    table("Bodies", &header, rows.collect())
}

/// When a body is there, in words.
fn while_there<const D: usize>(case: &Case<D>, body: usize) -> String {
    let mut words = Vec::new();
    if case.bodies[body].from_start {
        words.push("from the start".to_owned());
    }
    for stage in &case.stages {
        if let StageKind::Construction(works) = &stage.kind {
            if works.place.contains(&body) {
                words.push(format!("from stage {} on", stage.name));
            }
            if works.remove.contains(&body) {
                words.push(format!("until stage {}", stage.name));
            }
        }
    }
    words.join("; ")
}

/// Corners one by one, or how many there are.
fn corners<const D: usize>(polygon: &[[f64; D]]) -> String {
    if polygon.len() > MOST_CORNERS {
        return format!("{} corners", polygon.len());
    }
    let all: Vec<String> = polygon.iter().map(|&corner| point(corner)).collect();
    all.join(" ")
}

fn supports<const D: usize>(boundaries: &Boundaries<D>) -> SetupTable {
    let sides = [
        ("left side", 0, 0, "held across"),
        ("right side", 0, 1, "held across"),
        ("front", 1, 0, "held across"),
        ("back", 1, 1, "held across"),
        ("bottom", D - 1, 0, "held upright"),
        ("top", D - 1, 1, "held upright"),
    ];
    let mut rows: Vec<Vec<String>> = sides
        .into_iter()
        .filter(|&(_, axis, _, roller)| axis == 0 || D == 3 || roller == "held upright")
        .map(|(name, axis, end, roller)| {
            let held = match boundaries.sides[axis][end] {
                Side::Free => "free",
                Side::Roller => roller,
                Side::Fixed => "fixed",
            };
            vec![name.to_owned(), held.to_owned(), "the grid's".to_owned()]
        })
        .collect();
    for held in &boundaries.boxes {
        let how = match held.fix[..] {
            [true, true] | [true, true, true] => "fixed".to_owned(),
            [true, false] => "held across".to_owned(),
            [false, true] | [false, false, true] => "held upright".to_owned(),
            _ => {
                let names = std::iter::zip(["x", "y", "z"], held.fix);
                let names: Vec<&str> = names
                    .filter_map(|(name, is_held)| is_held.then_some(name))
                    .collect();
                if names.is_empty() {
                    "free".to_owned()
                } else {
                    format!("held in {}", names.join(", "))
                }
            }
        };
        let place = format!("{} to {}", point(held.lower), point(held.upper));
        rows.push(vec![held.name.clone(), how, place]);
    }
    table("Supports", &["Support", "Held", "Place [m]"], rows)
}

fn loads<const D: usize>(case: &Case<D>) -> SetupTable {
    let rows = case.loads.iter().map(|load| {
        let (kind, place, size) = match load.kind.clone() {
            LoadKind::RigidFooting {
                from,
                to,
                rough,
                reaction_factor,
            } => {
                let kind = if rough {
                    "rigid footing, rough"
                } else {
                    "rigid footing, smooth"
                };
                let size = if (reaction_factor - 1.0).abs() > 0.0 {
                    format!("its reaction is told times {}", short(reaction_factor))
                } else {
                    NONE.to_owned()
                };
                (kind, line(from, to), size)
            }
            LoadKind::Pressure { from, to, traction } => {
                ("pressure", line(from, to), components(traction, "Pa"))
            }
            LoadKind::Patch {
                plan,
                level,
                traction,
            } => {
                let place = format!("{}, at z = {}", plan.words(), short(level));
                ("pressure", place, components(traction, "Pa"))
            }
            LoadKind::Point { at, force } => (
                "force",
                point(at),
                components(force, if D == 2 { "N/m" } else { "N" }),
            ),
        };
        vec![load.name.clone(), kind.to_owned(), place, size]
    });
    let header = [
        "Load",
        "Kind",
        "Place [m]",
        if D == 2 {
            "Size at factor 1 (x, y)"
        } else {
            "Size at factor 1 (x, y, z)"
        },
    ];
    table("Loads", &header, rows.collect())
}

fn grid<const D: usize>(case: &Case<D>) -> SetupTable {
    let cells = |axis: &AxisSpec| {
        let [smallest, largest] = axis.extremes();
        match axis {
            AxisSpec::Equal { cell, .. } => short(*cell),
            AxisSpec::Lines(_) => format!("{} to {}", short(smallest), short(largest)),
        }
    };
    let (lower, upper, count) = (case.grid.lower(), case.grid.upper(), case.grid.cells());
    let row = |axis: usize, name: &str| {
        vec![
            name.to_owned(),
            format!("{} to {}", short(lower[axis]), short(upper[axis])),
            cells(&case.grid.axes[axis]),
            count[axis].to_string(),
        ]
    };
    let header = ["Grid", "Extent [m]", "Cell [m]", "Cells"];
    table(
        "Background grid",
        &header,
        match D {
            2 => vec![row(0, "x, level"), row(1, "y, upright")],
            _ => vec![row(0, "x, level"), row(1, "y, level"), row(2, "z, upright")],
        },
    )
}

fn point<const D: usize>(point: [f64; D]) -> String {
    format!("({})", point.map(short).join(", "))
}

fn line<const D: usize>(from: [f64; D], to: [f64; D]) -> String {
    format!("{} to {}", point(from), point(to))
}

/// A size with k before its unit.
fn kilo(value: f64, unit: &str) -> String {
    format!("{} k{unit}", short(value / 1e3))
}

fn components<const D: usize>(components: [f64; D], unit: &str) -> String {
    let printed = components.map(|value| short(value / 1e3));
    format!("{} k{unit}", printed.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use igimp_input::CaseFile;
    use igimp_input::shipped::SHIPPED;

    fn of(name: &str) -> Vec<SetupTable> {
        let shipped = SHIPPED.iter().find(|case| case.name == name).unwrap();
        let file = CaseFile::parse("case.toml", shipped.text, &[]).unwrap();
        igimp_model::in_any_dimension!(file.any_case(), case => tables(case))
    }

    fn row(tables: &[SetupTable], title: &str, number: usize) -> String {
        let table = tables.iter().find(|table| table.title == title).unwrap();
        table.rows[number].join(" | ")
    }

    #[test]
    fn a_slope_in_words() {
        let tables = of("slope");
        assert_eq!(
            row(&tables, "Materials", 0),
            "clay | Mohr–Coulomb | 20 | 20 | 0.3 | c = 20 kPa, φ = 20°, ψ = 0° | –"
        );
        assert_eq!(row(&tables, "Supports", 2), "bottom | fixed | the grid's");
        assert_eq!(
            row(&tables, "Stages as planned", 1),
            "2 | factor of safety | search for the factor of safety along the path of equilibria, strength of \
             clay reduced step by step; on the geometry as it is | initial stresses | 10"
        );
        assert_eq!(
            row(&tables, "Stages as planned", 0),
            "1 | initial stresses | gravity to its full value; on the geometry as it is; displacements count from its end \
             on | undeformed, free of stress | 10"
        );
        assert!(!tables.iter().any(|table| table.title == "Loads"));
    }

    /// GOAL: a report tells of the law that ran, and not of that of the file. CASE: the slope with the law of the undrained one.
    /// ORACLE: the name and the words of the law that was given.
    #[test]
    fn a_given_law_in_words() {
        let case_of = |name: &str| {
            let shipped = SHIPPED.iter().find(|case| case.name == name).unwrap();
            CaseFile::parse("case.toml", shipped.text, &[])
                .unwrap()
                .into_case()
        };
        let law = case_of("undrained_slope").materials[0].law().unwrap();
        let mut slope = case_of("slope");
        slope.materials[0].given = Some(igimp_model::GivenLaw(law.clone()));
        let words = given_in_words(&slope.materials[0]).unwrap();
        let found = row(&super::tables(&slope), "Materials", 0);
        assert_eq!(
            found,
            format!("clay | {} | 20 | 20 | 0.3 | {words} | –", law.name())
        );
        assert!(
            !found.contains("φ = 20°")
                && format!("{law:?}").starts_with(words.trim_end_matches('…'))
        );
    }

    #[test]
    fn rigid_bodies_in_words() {
        let text = include_str!("../../igimp-cases/tests/data/two_bodies.toml").replacen(
            "weight = \"2 kN/m\"",
            "weight = \"2 kN/m\"\nforce_factor = 2\ntension_limit = \"3 kPa\"\nsides = [{ side = \"bottom\", interface = \"smooth\" }]",
            1,
        );
        let file = CaseFile::parse("case.toml", &text, &[]).unwrap();
        let tables = super::tables(file.case());
        assert_eq!(
            row(&tables, "Rigid bodies", 0),
            "pipe | circle about (4.5, 2.4) | radius 0.4 | (4.5, 2.4) | \
             friction 0.3 and adhesion 0.5 of the strength of the soil | none | 0 | load: y by -0.05 m"
        );
        assert_eq!(
            row(&tables, "Rigid bodies", 1),
            "footing | (0.9, 2) (2.1, 2) (2.1, 2.6) (0.9, 2.6) | 1.2 × 0.6 | (1.5, 2) | \
             side 1 smooth, others rough | up to 3 kPa | \
             2 at (1.5, 2.3); forces are those modelled times 2 | \
             seat: y by -2.000e-3 m; load: x free, force in y to -50 kN/m, moment to 5 kN m/m"
        );
    }

    #[test]
    fn every_shipped_case_makes_whole_tables() {
        for shipped in SHIPPED {
            for table in of(shipped.name) {
                for row in &table.rows {
                    assert_eq!(
                        row.len(),
                        table.header.len(),
                        "{} of {}",
                        table.title,
                        shipped.name
                    );
                }
            }
        }
    }
}
