//! The case in words and numbers, as tables for a reader who has no case file before him.

mod water;

use std::fmt::Write as _;

use igimp_assembly::{Geometry, Tension};

use crate::case::{
    Adhesion, AxisSpec, BodyPart, Boundaries, Case, Construction, Load, LoadKind, Material,
    Profile, Reduction, ReductionPath, ReinforcementPart, RigidDrive, RigidMove, RigidPart,
    RigidShear, Side, Stage, StageKind, StopWhen, Strength, StressShare, Variation,
};
use crate::check::short;
use crate::plane::in_plane;
use crate::summary::SetupTable;

/// Stands for what a row does not have.
const NONE: &str = "–";
/// Most corners of a body that are listed one by one.
const MOST_CORNERS: usize = 24;

/// Materials, bodies, water, rigid bodies, reinforcement, supports, loads, stages and grid of a case.
pub fn tables<const D: usize>(case: &Case<D>) -> Vec<SetupTable> {
    [
        materials(case),
        water::soils(case),
        bodies(case),
        water::conditions(case),
        rigid_bodies(case),
        reinforcement(case),
        supports(&case.boundaries),
        loads(case),
        stages(case),
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

fn materials<const D: usize>(case: &Case<D>) -> SetupTable {
    let header = [
        "Material",
        "Law",
        "Unit weight [kN/m³]",
        "E [MPa]",
        "ν [−]",
        "Strength",
        "K₀ [−]",
    ];
    table(
        "Materials",
        &header,
        case.materials.iter().map(material).collect(),
    )
}

fn material(material: &Material) -> Vec<String> {
    let own = &material.profiles;
    let cohesive = || match &own.strength {
        Some(profile) => in_words(profile, over(1e3), " kPa"),
        None => kilo(material.cohesive(), "Pa"),
    };
    let or_constant = |profile: &Option<Profile>, constant: f64, scale: f64| match profile {
        Some(profile) => in_words(profile, over(scale), ""),
        None => short(constant / scale),
    };
    let (law, strength) = match material.strength {
        Strength::Elastic => ("elastic", "no limit".to_owned()),
        Strength::VonMises { .. } => ("von Mises", format!("c_u = {}", cohesive())),
        Strength::Tresca { .. } => ("Tresca", format!("c_u = {}", cohesive())),
        Strength::MohrCoulomb {
            friction_angle,
            dilation_angle,
            tension_cutoff,
            ..
        } => {
            let degrees = |angle: f64| short(angle.to_degrees());
            let friction = own.friction.as_ref().map_or_else(
                || format!("{}°", degrees(friction_angle)),
                |profile| in_words(profile, |tangent| degrees(tangent.atan()), "°"),
            );
            let cutoff = tension_cutoff.map_or_else(String::new, |limit| {
                format!(", tension up to {}", kilo(limit, "Pa"))
            });
            let strength = format!(
                "c = {}, φ = {}, ψ = {}°{cutoff}",
                cohesive(),
                friction,
                degrees(dilation_angle)
            );
            ("Mohr–Coulomb", strength)
        }
    };
    vec![
        material.name.clone(),
        law.to_owned(),
        or_constant(&own.unit_weight, material.unit_weight, 1e3),
        or_constant(&own.young, material.young, 1e6),
        short(material.poisson),
        strength,
        material.k0.map_or_else(|| NONE.to_owned(), short),
    ]
}

/// Most rows of a profile that are told one by one.
const MOST_ROWS: usize = 6;

/// Prints a value divided by a scale.
fn over(scale: f64) -> impl Fn(f64) -> String {
    move |value| short(value / scale)
}

/// A profile in words, its values as they are `printed` before a unit.
fn in_words(profile: &Profile, printed: impl Fn(f64) -> String, unit: &str) -> String {
    let (variation, is_by_depth) = match profile {
        Profile::Level(variation) => (variation, false),
        Profile::Depth(variation) => (variation, true),
        Profile::StressShare(share) => return share_in_words(share),
        Profile::Raster(raster) => {
            let values = raster.values.iter().flatten().copied();
            let least = values.clone().fold(f64::INFINITY, f64::min);
            let greatest = values.fold(f64::NEG_INFINITY, f64::max);
            return format!(
                "{}{unit} to {}{unit} by a raster of {} by {} points",
                printed(least),
                printed(greatest),
                raster.x.len(),
                raster.y.len()
            );
        }
    };
    let place = |level: f64| {
        if is_by_depth {
            format!("at a depth of {} m", short(0.0 - level))
        } else {
            format!("at y = {} m", short(level))
        }
    };
    match variation {
        Variation::Gradient {
            from,
            at_top,
            gradient,
        } => {
            let place = if is_by_depth {
                "at the surface".to_owned()
            } else {
                format!("down to y = {} m", short(*from))
            };
            format!(
                "{}{unit} {place}, {}{unit} per metre {} below",
                printed(*at_top),
                printed(gradient.abs()),
                if *gradient < 0.0 { "less" } else { "more" }
            )
        }
        Variation::Table(rows) if rows.len() <= MOST_ROWS => {
            let row =
                |[level, value]: &[f64; 2]| format!("{}{unit} {}", printed(*value), place(*level));
            let rows: Vec<String> = rows.iter().rev().map(row).collect();
            rows.join(", ")
        }
        Variation::Table(rows) => {
            let ([low, deepest], [high, highest]) = (rows[0], rows[rows.len() - 1]);
            format!(
                "{}{unit} {} to {}{unit} {} by a table of {} {}",
                printed(highest),
                place(high),
                printed(deepest),
                place(low),
                rows.len(),
                if is_by_depth { "depths" } else { "levels" }
            )
        }
    }
}

/// A strength that follows the stress, in words.
fn share_in_words(share: &StressShare) -> String {
    let ocr = match &share.ocr_profile {
        Some(profile) => in_words(profile, short, ""),
        None => short(share.ocr),
    };
    let consolidated = if share.ocr_profile.is_none() && share.ocr.total_cmp(&1.0).is_eq() {
        String::new()
    } else {
        format!(" OCR^{}, OCR = {ocr}", short(share.exponent))
    };
    let least = if share.at_least > 0.0 {
        format!(", at least {}", kilo(share.at_least, "Pa"))
    } else {
        String::new()
    };
    let water = share.water_level.map_or_else(String::new, |level| {
        format!(", water at rest to y = {} m", short(level))
    });
    format!("{} σ′_v0{consolidated}{least}{water}", short(share.ratio))
}

fn bodies<const D: usize>(case: &Case<D>) -> SetupTable {
    let come_and_go = case.stages.iter().any(|stage| match &stage.kind {
        StageKind::Construction(own) => !(own.place.is_empty() && own.remove.is_empty()),
        _ => false,
    });
    let rows = case.bodies.iter().enumerate().map(|(index, body)| {
        let corners = match in_plane::<_, BodyPart>(body) {
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
        if let StageKind::Construction(own) = &stage.kind {
            if own.place.contains(&body) {
                words.push(format!("from stage {} on", stage.name));
            }
            if own.remove.contains(&body) {
                words.push(format!("until stage {}", stage.name));
            }
        }
    }
    words.join("; ")
}

/// Corners one by one, or how many there are.
fn corners(polygon: &[[f64; 2]]) -> String {
    if polygon.len() > MOST_CORNERS {
        return format!("{} corners", polygon.len());
    }
    let all: Vec<String> = polygon.iter().map(|&corner| point(corner)).collect();
    all.join(" ")
}

fn rigid_bodies<const D: usize>(case: &Case<D>) -> SetupTable {
    let header = [
        "Rigid body",
        "Shape [m]",
        "Size [m]",
        "Reference point [m]",
        "Interface",
        "Tension",
        if D == 2 {
            "Weight [kN/m]"
        } else {
            "Weight [kN]"
        },
        "Moved in stages",
    ];
    let rows = case.rigid.iter().enumerate();
    let rows = rows.map(|(index, part)| rigid_body(case, index, part));
    table("Rigid bodies", &header, rows.collect())
}

fn reinforcement<const D: usize>(case: &Case<D>) -> SetupTable {
    let header = [
        "Reinforcement",
        "Kind",
        "Line [m]",
        "Stiffness EA [MN/m]",
        "Capacity [kN/m]",
        "Bond [kPa]",
        "Held at head, end [kN/m]",
        "Installed",
    ];
    let rows = case.reinforcement.iter().enumerate();
    let rows = rows.map(|(index, part)| member(case, index, part));
    table("Reinforcement, per metre run", &header, rows.collect())
}

fn member<const D: usize>(case: &Case<D>, index: usize, part: &ReinforcementPart) -> Vec<String> {
    let mut kind = part.kind.name().to_owned();
    if part.free_length > 0.0 {
        let _ = write!(kind, ", {} m of it free", short(part.free_length));
    }
    let mut bond = short(part.bond / 1e3);
    if part.reduces_bond {
        bond.push_str(", reduced with the strength");
    }
    let [head, end] = part.fastened.map(|force| short(force / 1e3));
    let held = match part.plate {
        Some([from, to]) => {
            let width = short((to[0] - from[0]).hypot(to[1] - from[1]));
            format!("{head} on a plate of {width} m, {end}")
        }
        None => format!("{head}, {end}"),
    };
    let stages = case.stages.iter();
    let installed = stages.filter(|stage| stage.install.contains(&index));
    let installed: Vec<&str> = installed.map(|stage| stage.name.as_str()).collect();
    let mut when = if part.from_start {
        "from the start".to_owned()
    } else {
        format!("in {}", installed.join(", "))
    };
    if let Some(prestress) = part.prestress {
        let _ = write!(when, ", locked off at {} kN/m", short(prestress / 1e3));
    }
    vec![
        part.name.clone(),
        kind,
        corners(&part.line),
        short(part.stiffness / 1e6),
        short(part.capacity / 1e3),
        bond,
        held,
        when,
    ]
}

fn rigid_body<const D: usize>(case: &Case<D>, index: usize, part: &RigidPart<D>) -> Vec<String> {
    let [shape, size] = part.shape.words();
    let shear = |side: usize| shear(part.interfaces[side].shear);
    let tension = |side: usize| tension(part.interfaces[side].tension);
    let weight = if (part.force_factor - 1.0).abs() > 0.0 {
        let factor = short(part.force_factor);
        format!(
            "{}; forces are those modelled times {factor}",
            short(part.weight / 1e3)
        )
    } else {
        short(part.weight / 1e3)
    };
    let mut moved = Vec::new();
    if part.from_start {
        moved.push("there from the start".to_owned());
    }
    for stage in &case.stages {
        let StageKind::Rigid(moves) = &stage.kind else {
            continue;
        };
        for own in moves.iter().filter(|own| own.body == index) {
            moved.push(format!("{}: {}", stage.name, drives_in_words(own)));
        }
    }
    let sides = part.interfaces.len();
    vec![
        part.name.clone(),
        shape,
        size,
        point(part.reference),
        by_side(sides, shear),
        by_side(sides, tension),
        weight,
        moved.join("; "),
    ]
}

/// What all sides have in common, or what each has, numbered from 1.
fn by_side(sides: usize, of: impl Fn(usize) -> String) -> String {
    let each: Vec<String> = (0..sides).map(of).collect();
    match each.split_first() {
        Some((first, others)) if others.iter().all(|own| own == first) => first.clone(),
        _ => {
            let numbered = std::iter::zip(1.., &each);
            let numbered = numbered.map(|(side, own)| format!("side {side} {own}"));
            numbered.collect::<Vec<_>>().join(", ")
        }
    }
}

fn shear(of: RigidShear) -> String {
    match of {
        RigidShear::Smooth => "smooth".to_owned(),
        RigidShear::Rough => "rough".to_owned(),
        RigidShear::Limited { friction, adhesion } => {
            let friction = (friction > 0.0).then(|| format!("friction {}", short(friction)));
            let adhesion = match adhesion {
                Adhesion::Stress(stress) if stress > 0.0 => {
                    Some(format!("adhesion {}", kilo(stress, "Pa")))
                }
                Adhesion::Share(share) if share > 0.0 => Some(format!(
                    "adhesion {} of the strength of the soil",
                    short(share)
                )),
                _ => None,
            };
            let parts: Vec<String> = friction.into_iter().chain(adhesion).collect();
            if parts.is_empty() {
                "smooth".to_owned()
            } else {
                parts.join(" and ")
            }
        }
    }
}

fn tension(of: Tension) -> String {
    match of {
        Tension::None => "none".to_owned(),
        Tension::Bonded => "bonded".to_owned(),
        Tension::Limit(stress) => format!("up to {}", kilo(stress, "Pa")),
    }
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
        let (kind, place, size) = match load.kind {
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

fn stages<const D: usize>(case: &Case<D>) -> SetupTable {
    let rows = case.stages.iter().enumerate().map(|(number, stage)| {
        let from = stage.start_from.map_or_else(
            || "undeformed, free of stress".to_owned(),
            |from| case.stages[from].name.clone(),
        );
        let mut what = vec![happens(case, stage)];
        for &member in &stage.install {
            what.push(format!("{} installed", case.reinforcement[member].name));
        }
        if stage.geometry == Geometry::Given {
            what.push("on the geometry as it is".to_owned());
        }
        what.extend(ends(case, &stage.stop_when));
        if stage.drained {
            what.push("all soil drains".to_owned());
        }
        if stage.reset_displacements {
            what.push("displacements count from its end on".to_owned());
        }
        vec![
            (number + 1).to_string(),
            stage.name.clone(),
            what.join("; "),
            from,
            stage.steps.to_string(),
        ]
    });
    let header = ["", "Stage", "What happens", "Starts from", "Steps"];
    table("Stages as planned", &header, rows.collect())
}

fn happens<const D: usize>(case: &Case<D>, stage: &Stage) -> String {
    let materials = |which: &[usize]| {
        let names: Vec<&str> = which
            .iter()
            .map(|&k| case.materials[k].name.as_str())
            .collect();
        names.join(", ")
    };
    match &stage.kind {
        StageKind::Gravity {
            factor,
            horizontal,
            across,
            vertical,
        } => {
            let mut told = format!("gravity to {}", times(*factor, "value"));
            let shares = [
                (horizontal, "to the right"),
                (across, "backwards"),
                (vertical, "upwards"),
            ];
            for (share, whither) in shares {
                if let Some(share) = share {
                    let _ = write!(
                        told,
                        ", pseudo-static force of {} % of the weight {whither}",
                        short(100.0 * share)
                    );
                }
            }
            told
        }
        StageKind::K0 => "stresses of level ground at rest (K₀), then equilibrium".to_owned(),
        StageKind::Load { loads, factor } => {
            let name = |&k: &usize| case.loads[k].name.as_str();
            let names: Vec<&str> = loads.iter().map(name).collect();
            format!("{} to {}", names.join(", "), times(*factor, "size"))
        }
        StageKind::Displacement { load, settlement } => {
            let Load { name, .. } = &case.loads[*load];
            format!("{name} pushed down by {} m", short(*settlement))
        }
        StageKind::Construction(own) => construction_in_words(case, own),
        StageKind::Rigid(moves) => {
            let told: Vec<String> = moves.iter().map(|own| moves_in_words(case, own)).collect();
            told.join("; ")
        }
        StageKind::StrengthReduction(reduction) => {
            let path = match reduction.path {
                ReductionPath::Reduce => "step by step",
                ReductionPath::Gravity => "with gravity raised anew",
            };
            format!(
                "search for the factor of safety to within {}, strength of {} reduced {path}",
                short(reduction.tolerance),
                materials(&reduction.materials)
            )
        }
        StageKind::RunOut(run_out) => {
            let by = match run_out.reduction {
                Reduction::TimesFos(times) => {
                    format!("{} times the factor of safety", short(times))
                }
                Reduction::Factor(factor) => short(factor),
            };
            format!(
                "motion until rest, strength of {} divided by {by}",
                materials(&run_out.materials)
            )
        }
    }
}

/// What a construction stage changes, in words.
fn construction_in_words<const D: usize>(case: &Case<D>, own: &Construction) -> String {
    let names = |which: &[usize]| {
        let names: Vec<&str> = which.iter().map(|&k| &*case.bodies[k].name).collect();
        names.join(", ")
    };
    let mut parts = Vec::new();
    if !own.place.is_empty() {
        parts.push(format!("{} placed", names(&own.place)));
    }
    if !own.remove.is_empty() {
        parts.push(format!("{} taken away", names(&own.remove)));
    }
    for &(body, material) in &own.materials {
        let (body, material) = (&case.bodies[body].name, &case.materials[material].name);
        parts.push(format!("{body} becomes {material}"));
    }
    if let Some(water) = own.water {
        parts.push(format!("water: {}", case.water[water].name));
    }
    if own.dissipate {
        parts.push("excess pore pressure gone".to_owned());
    }
    parts.join("; ")
}

/// What a stage does to a rigid body, in words.
fn moves_in_words<const D: usize>(case: &Case<D>, own: &RigidMove) -> String {
    let name = &case.rigid[own.body].name;
    format!("{name}: {}", drives_in_words(own))
}

/// What drives the components of the motion of a rigid body in a stage, in words.
fn drives_in_words(own: &RigidMove) -> String {
    let parts: Vec<String> = std::iter::zip(["x", "y", "rotation"], own.drives)
        .filter_map(|(name, drive)| {
            let turns = name == "rotation";
            Some(match drive? {
                RigidDrive::By(by) if turns => format!("rotation by {} rad", short(by)),
                RigidDrive::By(by) => format!("{name} by {} m", short(by)),
                RigidDrive::Force(0.0) => format!("{name} free"),
                RigidDrive::Force(moment) if turns => {
                    format!("moment to {}", kilo(moment, "N m/m"))
                }
                RigidDrive::Force(force) => format!("force in {name} to {}", kilo(force, "N/m")),
            })
        })
        .collect();
    if parts.is_empty() {
        "held".to_owned()
    } else {
        parts.join(", ")
    }
}

/// A multiple in words.
fn times(factor: f64, of: &str) -> String {
    if (factor - 1.0).abs() < 1e-12 {
        format!("its full {of}")
    } else {
        format!("{} times its {of}", short(factor))
    }
}

/// The conditions that end a stage early.
fn ends<const D: usize>(case: &Case<D>, stop: &StopWhen) -> Vec<String> {
    let mut words = Vec::new();
    if let Some(limit) = stop.displacement {
        let whose = stop.monitor.map_or_else(
            || "the largest displacement".to_owned(),
            |monitor| format!("the displacement of {}", case.monitors[monitor].name),
        );
        words.push(format!("ends when {whose} is {} m", short(limit)));
    }
    if stop.no_equilibrium {
        words.push("ends for want of equilibrium".to_owned());
    }
    if let Some(share) = stop.load_grows_less_than {
        let share = short(100.0 * share);
        words.push(format!(
            "ends when the load grows by less than {share} % in a step"
        ));
    }
    words
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
    let printed = components.map(|own| short(own / 1e3));
    format!("{} k{unit}", printed.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::CaseFile;
    use crate::shipped::SHIPPED;

    fn of(name: &str) -> Vec<SetupTable> {
        let shipped = SHIPPED.iter().find(|case| case.name == name).unwrap();
        let file = CaseFile::parse("case.toml", shipped.text, &[]).unwrap();
        crate::in_any_dimension!(file.any_case(), case => tables(case))
    }

    fn row(tables: &[SetupTable], title: &str, number: usize) -> String {
        let table = tables.iter().find(|table| table.title == title).unwrap();
        table.rows[number].join(" | ")
    }

    #[test]
    fn a_slope_is_told_in_words() {
        let tables = of("slope");
        assert_eq!(
            row(&tables, "Materials", 0),
            "clay | Mohr–Coulomb | 20 | 20 | 0.3 | c = 20 kPa, φ = 20°, ψ = 0° | –"
        );
        assert_eq!(row(&tables, "Supports", 2), "bottom | fixed | the grid's");
        assert_eq!(
            row(&tables, "Stages as planned", 1),
            "2 | factor of safety | search for the factor of safety to within 0.02, strength of clay reduced \
             step by step; on the geometry as it is | initial stresses | 10"
        );
        assert_eq!(
            row(&tables, "Stages as planned", 0),
            "1 | initial stresses | gravity to its full value; displacements count from its end on | \
             undeformed, free of stress | 10"
        );
        assert!(!tables.iter().any(|table| table.title == "Loads"));
    }

    #[test]
    fn rigid_bodies_are_told_in_words() {
        let text = include_str!("../../tests/data/two_bodies.toml").replacen(
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
             side 1 smooth, side 2 rough, side 3 rough, side 4 rough | up to 3 kPa | \
             2; forces are those modelled times 2 | \
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
