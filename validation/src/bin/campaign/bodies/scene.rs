//! Random bodies in and on soil as case files: soil, shapes, poses, interfaces, and how they are moved.

use std::fmt::Write as _;

use super::shape::{Kind, Shape};
use super::site::{Site, corners_text};
use crate::random::Random;

/// Strength of the soil, and the unit of forces in elastic soil \[kPa\].
const STRENGTH: f64 = 10.0;

/// A law of the soil.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Law {
    /// Tresca.
    Tresca,
    /// von Mises.
    VonMises,
    /// Mohr–Coulomb.
    MohrCoulomb,
    /// No strength.
    Elastic,
}

impl Law {
    /// In tables.
    pub(crate) fn label(self) -> &'static str {
        match self {
            Self::Tresca => "Tresca",
            Self::VonMises => "von Mises",
            Self::MohrCoulomb => "Mohr-Coulomb",
            Self::Elastic => "elastic",
        }
    }
}

/// Where a body starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Place {
    /// On the surface, or above it.
    Top,
    /// In a pit that fits it.
    Pit,
    /// Below the surface.
    Buried,
    /// Beside the soil.
    Beside,
}

/// One body of a scene.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// Its kind.
    pub(crate) kind: Kind,
    /// Where it starts.
    pub(crate) place: Place,
    pub(super) shape: Shape,
    /// How far above the soil it starts \[m\].
    pub(super) gap: f64,
    /// Its table in the case file, from the interface on.
    text: String,
    pub(super) from_start: bool,
}

/// Random bodies on soil.
#[derive(Clone, Debug)]
pub(crate) struct Scene {
    /// Number within the campaign, from 1.
    pub(crate) number: u64,
    /// Law of the soil.
    pub(crate) law: Law,
    /// E/c \[-\].
    pub(crate) stiffness: f64,
    /// Whether soil is heavy.
    pub(crate) has_weight: bool,
    /// The bodies.
    pub(crate) parts: Vec<Part>,
    /// Names of the stages in which a body has a force or is free.
    pub(crate) loaded: Vec<&'static str>,
    text: String,
}

impl Scene {
    /// The scene of a number in the campaign of a seed.
    pub(crate) fn random(seed: u64, number: u64) -> Self {
        let random = &mut Random::new(seed, number);
        let cell = random.uniform(0.2, 0.5);
        let law =
            [Law::Tresca, Law::VonMises, Law::MohrCoulomb, Law::Elastic][random.integer(0, 3)];
        let stiffness = random.log_uniform(30.0, 1000.0);
        let has_weight = random.chance(0.5);
        let rounding = [0.5, 0.5, 0.3, 0.0][random.integer(0, 3)];
        let is_pair = random.chance(0.35);
        let mut site = Site::random(cell, is_pair, random);
        let mut parts = Vec::new();
        for slot in 0..=usize::from(is_pair) {
            let place = match random.unit() {
                chance if slot == 1 || chance < 0.45 => Place::Top,
                chance if chance < 0.6 => Place::Pit,
                chance if chance < 0.8 => Place::Buried,
                _ => Place::Beside,
            };
            parts.push(part(&mut site, slot, place, (rounding, has_weight), random));
        }
        let mut text = head(number, &site, law, stiffness, has_weight, random);
        for (slot, part) in parts.iter().enumerate() {
            text.push_str(&table(slot, part));
        }
        let (stages, loaded) = stages(&parts, cell, has_weight, random);
        text.push_str(&stages);
        Self {
            number,
            law,
            stiffness,
            has_weight,
            parts,
            loaded,
            text,
        }
    }

    /// The case file.
    pub(crate) fn case_file(&self) -> &str {
        &self.text
    }
}

/// A body in its place; the soil leaves room for it.
fn part(
    site: &mut Site,
    slot: usize,
    place: Place,
    (rounding, has_weight): (f64, bool),
    random: &mut Random,
) -> Part {
    let kind = match place {
        Place::Pit => Kind::Rectangle,
        Place::Beside => Kind::Wall,
        _ => [
            Kind::Rectangle,
            Kind::Turned,
            Kind::Circle,
            Kind::Convex,
            Kind::NonConvex,
            Kind::NonConvex,
        ][random.integer(0, 5)],
    };
    let gap = if place == Place::Top && random.chance(0.4) {
        site.cell * random.uniform(0.05, 0.8)
    } else {
        0.0
    };
    let shape = if kind == Kind::Wall {
        site.wall(random)
    } else {
        let shape = Shape::random(kind, site.cell, rounding, random);
        site.put(shape, slot, place, gap, random)
    };
    let from_start = place != Place::Top || (gap == 0.0 && has_weight && random.chance(0.3));
    let mut text = format!("rounding = {rounding}\n");
    let _ = writeln!(text, "interface = {}", interface(random));
    text.push_str(tension(random));
    let sides = match &shape {
        Shape::Corners(corners) => corners.len(),
        Shape::Circle { .. } => 1,
    };
    if random.chance(0.5) {
        let side = random.integer(1, sides);
        let keys = interface(random);
        let _ = writeln!(text, "sides = [{{ side = {side}, interface = {keys} }}]");
    }
    if random.chance(0.3) {
        let weight = STRENGTH * shape.width() * random.uniform(0.1, 0.5);
        let _ = writeln!(text, "weight = \"{weight} kN/m\"");
    }
    Part {
        kind,
        place,
        shape,
        gap,
        text,
        from_start,
    }
}

fn interface(random: &mut Random) -> String {
    let friction = random.uniform(0.1, 0.8);
    let share = random.uniform(0.1, 1.0);
    match random.integer(1, 6) {
        1 => "\"smooth\"".to_owned(),
        2 => "\"rough\"".to_owned(),
        3 => format!("{{ friction = {friction} }}"),
        4 => format!("{{ adhesion = \"{} kPa\" }}", share * STRENGTH),
        5 => format!("{{ adhesion_share = {share} }}"),
        _ => format!("{{ friction = {friction}, adhesion_share = {share} }}"),
    }
}

fn tension(random: &mut Random) -> &'static str {
    match random.unit() {
        chance if chance < 0.6 => "tension = \"none\"\n",
        chance if chance < 0.8 => "tension = \"bonded\"\n",
        _ => "tension_limit = \"3 kPa\"\n",
    }
}

fn head(
    number: u64,
    site: &Site,
    law: Law,
    stiffness: f64,
    has_weight: bool,
    random: &mut Random,
) -> String {
    let locking = if random.chance(0.5) {
        "b-bar"
    } else {
        "shared-strain"
    };
    let poisson = random.uniform(0.2, 0.49);
    let mut text = format!(
        "igimp = 1\n\n[case]\ntitle = \"Random bodies {number}\"\ngravity = \"{} m/s2\"\n\n\
         [grid]\nlocking = \"{locking}\"\ncell = \"{} m\"\n\
         domain = {{ x = [\"0 m\", \"{} m\"], y = [\"0 m\", \"{} m\"] }}\n\n\
         [materials.soil]\nunit_weight = \"{} kN/m3\"\nyoung = \"{} kPa\"\npoisson = {poisson}\n",
        if has_weight { 9.81 } else { 0.0 },
        site.cell,
        site.width(),
        site.height(),
        if has_weight { 18 } else { 0 },
        stiffness * STRENGTH,
    );
    let friction = random.uniform(10.0, 35.0);
    let dilation = if random.chance(0.5) { friction } else { 0.0 };
    let _ = match law {
        Law::Tresca => writeln!(text, "model = \"tresca\"\ncu = \"{STRENGTH} kPa\""),
        Law::VonMises => writeln!(text, "model = \"von-mises\"\ncu = \"{STRENGTH} kPa\""),
        Law::MohrCoulomb => writeln!(
            text,
            "model = \"mohr-coulomb\"\ncohesion = \"{} kPa\"\nfriction = \"{friction} deg\"\n\
             dilation = \"{dilation} deg\"",
            0.3 * STRENGTH
        ),
        Law::Elastic => writeln!(text, "model = \"elastic\""),
    };
    for (k, polygon) in site.polygons.iter().enumerate() {
        let _ = write!(
            text,
            "\n[[bodies]]\nname = \"soil {k}\"\nmaterial = \"soil\"\npolygon = {}\n",
            corners_text(polygon)
        );
    }
    let left = if site.has_wall { "free" } else { "roller" };
    let bottom = if random.chance(0.5) {
        "fixed"
    } else {
        "roller"
    };
    let _ = write!(
        text,
        "\n[boundaries]\nleft = \"{left}\"\nright = \"roller\"\nbottom = \"{bottom}\"\n"
    );
    text
}

fn table(slot: usize, part: &Part) -> String {
    let shape = match &part.shape {
        Shape::Circle { centre, radius } => format!(
            "type = \"circle\"\ncentre = [\"{} m\", \"{} m\"]\nradius = \"{radius} m\"",
            centre[0], centre[1]
        ),
        Shape::Corners(corners) => {
            format!("type = \"polygon\"\ncorners = {}", corners_text(corners))
        }
    };
    format!(
        "\n[[rigid]]\nname = \"body {slot}\"\n{shape}\nfrom_start = {}\n{}",
        part.from_start, part.text
    )
}

/// The stages, and those in which a body has a force or is free.
fn stages(
    parts: &[Part],
    cell: f64,
    has_weight: bool,
    random: &mut Random,
) -> (String, Vec<&'static str>) {
    let mut text = String::new();
    let mut with_forces = Vec::new();
    if has_weight {
        text.push_str("\n[[stages]]\nname = \"weight\"\ntype = \"gravity\"\nsteps = 5\n");
    }
    let seats: Vec<String> = parts
        .iter()
        .map(|part| {
            let by = cell * random.uniform(0.05, 0.4);
            match part.place {
                Place::Top => format!("y = \"{} m\"", -(part.gap + by)),
                Place::Pit => format!("y = \"{} m\"", -by),
                Place::Beside => format!(
                    "x = \"{} m\"",
                    if random.chance(0.5) { by } else { -0.3 * by }
                ),
                Place::Buried => {
                    let along = random.uniform(-1.0, 1.0);
                    format!(
                        "x = \"{} m\", y = \"{} m\"",
                        along * by,
                        (1.0 - along.abs()) * by
                    )
                }
            }
        })
        .collect();
    text.push_str(&stage("seat", 6, &seats, false));
    for name in ["second", "third"] {
        let mut is_loaded = false;
        let moves: Vec<String> = parts
            .iter()
            .map(|part| {
                let (text, loaded) = action(part, cell, random);
                is_loaded |= loaded;
                text
            })
            .collect();
        // What a stage does not mention keeps its force.
        if is_loaded || !with_forces.is_empty() {
            with_forces.push(name);
        }
        let goes_on = is_loaded && random.chance(0.5);
        text.push_str(&stage(name, random.integer(6, 12), &moves, goes_on));
    }
    (text, with_forces)
}

fn stage(name: &str, steps: usize, moves: &[String], goes_on: bool) -> String {
    let moves = moves.iter().enumerate();
    let moves: Vec<String> = moves
        .map(|(slot, how)| format!("{{ body = \"body {slot}\", {how} }}"))
        .collect();
    let mut text = format!(
        "\n[[stages]]\nname = \"{name}\"\ntype = \"rigid\"\nsteps = {steps}\nbodies = [{}]\n",
        moves.join(", ")
    );
    if goes_on {
        text.push_str("stop_when = { no_equilibrium = true }\n");
    }
    text
}

/// How a stage drives a body, and whether forces do.
fn action(part: &Part, cell: f64, random: &mut Random) -> (String, bool) {
    let width = part.shape.width();
    let force = STRENGTH * width * random.uniform(0.2, 4.0);
    let aside = force * random.uniform(-0.5, 0.5);
    let moment = force * width * random.uniform(-0.2, 0.2);
    let by = cell * random.uniform(0.1, 1.0);
    let along = by * random.uniform(-1.0, 1.0);
    let turn = random.uniform(-12.0, 12.0);
    match random.integer(1, 10) {
        1 => (format!("y = \"{} m\"", -by), false),
        2 => (format!("y = \"{} m\"", 1.5 * by), false),
        3 => (format!("x = \"{along} m\""), false),
        4 => (format!("rotation = \"{turn} deg\""), false),
        5 => (
            format!(
                "x = \"{along} m\", y = \"{} m\", rotation = \"{turn} deg\"",
                -0.5 * by
            ),
            false,
        ),
        6 => (format!("force_y = \"{} kN/m\"", -force), true),
        7 => (
            format!(
                "force_y = \"{} kN/m\", free = [\"x\", \"rotation\"]",
                -force
            ),
            true,
        ),
        8 => (
            format!("y = \"{} m\", free = [\"x\", \"rotation\"]", -0.5 * by),
            true,
        ),
        9 => (
            format!(
                "force_x = \"{aside} kN/m\", force_y = \"{} kN/m\", moment = \"{moment} kNm/m\"",
                -force
            ),
            true,
        ),
        _ => ("free = [\"x\", \"y\", \"rotation\"]".to_owned(), true),
    }
}
