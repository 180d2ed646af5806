//! A wall that holds soil, moved away from it and into it: smooth, with friction, and with adhesion.

use std::path::Path;

use igimp_cases::CaseError;
use igimp_model::check::Band;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};
use crate::runs::{Computed, corners, shipped_case};

/// The book's description of the study.
const ABOUT: &str = "A smooth wall beside level ground, moved away from it and into it: sand of the template (φ = ψ = 30°, with its cohesion of 0.1 kPa) without tension, and clay (s_u = γH/8) bonded to the wall. The field of stress is uniform but for weight, and exact. Then sand along a wall with friction δ, whose force normal to the wall is held against bounds of that component, and clay along one with adhesion s_u, pushed into it. Those on a line of the grid are computed with B-bar. Their ground stands on a base that is rough but for the first cell beside the wall, which slides: a base held up to the toe carries part of the force, along a smooth wall as along a rough one. In full the face stands at five places of its cell, by the method that case files have where they say nothing, moved away four times as far.";
const RANKINE: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Rankine",
    locator: "K = tan²(45° ∓ φ/2) ∓ 4 c tan(45° ∓ φ/2)/(γ H); φ = 0: 1 ∓ 4 s_u/(γ H)",
};
const BOUNDS: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "Coulomb's wedge with the cohesion, from above for the strength, and Lancellotta (2002) without, from below",
    locator: "force normal to the wall, φ = 30°; the middle is given",
};
const ADHESION: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Rankine's field, fan and state at the wall",
    locator: "1 + 2 K_c s_u/(γ H), K_c = 1 + Δ + cos Δ, sin Δ = a/s_u",
};
/// The band where the answer is exact.
const CLOSE: Band = Band::Relative(0.04);
/// Weight of the soil beside the wall, γ H \[kPa\].
const WEIGHT: f64 = 40.0;
/// Where the face stands in its cell \[cells\].
const PLACES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 0.9];

/// Passive (`sign` 1) or active (−1) force over γ H²/2.
fn rankine(degrees: f64, cohesion: f64, sign: f64) -> f64 {
    let root = (45.0 + 0.5 * sign * degrees).to_radians().tan();
    root * root + sign * 4.0 * cohesion * root / WEIGHT
}

/// Normal force over γ H²/2 by the best plane wedge of sand with φ = 30° and cohesion \[kPa\] along a wall with friction of so many
/// degrees, passive (`sign` 1) or active (−1): the least force that pushes a wedge up, or the greatest that one needs to stay.
fn wedge(friction: f64, cohesion: f64, sign: f64) -> f64 {
    let [phi, delta] = [30.0_f64, friction].map(f64::to_radians);
    let (weight, height) = (WEIGHT, 1.0);
    let forces = (1..9000).filter_map(|hundredths| {
        let slope = (0.01 * f64::from(hundredths)).to_radians();
        let (load, slip) = (
            0.5 * weight * height / slope.tan(),
            cohesion * height / slope.sin(),
        );
        let turned = slope + sign * phi;
        let lever = (turned + sign * delta).cos();
        let force = (load * turned.sin() + sign * slip * phi.cos()) / lever;
        (turned > 0.0 && lever > 0.0).then_some(force * delta.cos() / (0.5 * weight * height))
    });
    let best = |one: f64, other: f64| {
        if sign * one < sign * other {
            one
        } else {
            other
        }
    };
    forces.reduce(best).unwrap_or(f64::NAN)
}

/// Normal force over γ H²/2 of a field of stress in sand with φ = 30° that is discontinuous along a fan of lines (Lancellotta 2002).
fn lancellotta(friction: f64, sign: f64) -> f64 {
    let [phi, delta] = [30.0_f64, friction].map(f64::to_radians);
    let across = (phi.sin().powi(2) - delta.sin().powi(2)).max(0.0).sqrt();
    let turn = (delta.sin() / phi.sin()).min(1.0).asin() + sign * delta;
    delta.cos() * (delta.cos() + sign * across) / (1.0 - sign * phi.sin())
        * (sign * turn * phi.tan()).exp()
}

/// The soil beside the wall, and its supports.
#[derive(Clone, Copy, PartialEq)]
enum Soil {
    Sand,
    Clay,
    /// Sand along a wall with friction of so many degrees.
    SandWithFriction(u8),
    ClayWithAdhesion,
}

impl Soil {
    fn name(self) -> String {
        match self {
            Self::Sand => "sand".to_owned(),
            Self::Clay => "clay".to_owned(),
            Self::SandWithFriction(degrees) => format!("sand, δ = {degrees}°"),
            Self::ClayWithAdhesion => "clay, adhesion s_u".to_owned(),
        }
    }
}

/// A wall, and the grid that it stands in.
#[derive(Clone, Copy)]
struct Wall {
    soil: Soil,
    /// Size of a cell \[m\].
    cell: f64,
    /// Where the face stands in its cell \[cells\], with the method of case files; on a line of the grid if not said.
    place: Option<f64>,
}

impl Wall {
    fn name(self) -> String {
        let cells = 2.0 / self.cell;
        let place = self.place.map_or_else(String::new, |place| {
            format!(", face at {place} of its cell")
        });
        format!("{}, H/h = {cells}{place}", self.soil.name())
    }

    /// The ends of the grid along x \[m\].
    fn ends(self) -> [f64; 2] {
        let start = -(2.0 + self.place.unwrap_or(0.0)) * self.cell;
        let end = start + ((8.0 - start) / self.cell).round() * self.cell;
        [start, end]
    }

    /// The grid with the face at its place, the ground up to its end, and a wider way off.
    fn at_its_place(self) -> Vec<String> {
        if self.place.is_none() {
            return Vec::new();
        }
        let [start, end] = self.ends();
        let mut overrides = vec![
            format!("grid.domain={{ x = [\"{start} m\", \"{end} m\"], y = [\"0 m\", \"3 m\"] }}"),
            format!(
                "bodies.soil.polygon={}",
                corners(&[[0.0, 0.0], [end, 0.0], [end, 2.0], [0.0, 2.0]])
            ),
        ];
        if self.soil != Soil::Clay {
            overrides.extend([
                "stages.1.bodies=[{ body = \"wall\", x = \"-10 mm\" }]".to_owned(),
                "stages.1.steps=40".to_owned(),
            ]);
        }
        overrides
    }
}

/// Runs the template with a soil and two motions \[m\]; its forces over γ H²/2, active and passive.
fn push(wall: Wall) -> Result<(Computed<2>, [f64; 2]), CaseError> {
    let Wall { soil, cell, place } = wall;
    let mut overrides = vec![
        format!("grid.cell=\"{cell} m\""),
        "checks=[]".to_owned(),
        "grid.fit=none".to_owned(),
    ];
    overrides.extend(wall.at_its_place());
    if matches!(soil, Soil::Clay | Soil::ClayWithAdhesion) {
        overrides.push("materials={ sand = { model = \"tresca\", unit_weight = \"20 kN/m3\", young = \"5 MPa\", poisson = 0.49, cu = \"5 kPa\" } }".to_owned());
    }
    if soil == Soil::Clay {
        overrides.extend([
            "rigid.wall.tension=bonded".to_owned(),
            "stages.1.bodies=[{ body = \"wall\", x = \"-60 mm\" }]".to_owned(),
        ]);
    }
    let interface = match soil {
        Soil::Sand | Soil::Clay => None,
        Soil::SandWithFriction(degrees) => Some(format!("{{ angle = \"{degrees} deg\" }}")),
        Soil::ClayWithAdhesion => Some("{ adhesion_share = 1.0 }".to_owned()),
    };
    if let Some(interface) = interface {
        let (rough_from, [_, end]) = (1.5 * cell, wall.ends());
        if place.is_none() {
            overrides.push("grid.locking=b-bar".to_owned());
        }
        overrides.extend([
            format!("rigid.wall.interface={interface}"),
            format!("boundaries={{ left = \"free\", bottom = \"roller\", boxes = [{{ name = \"base\", from = [\"{rough_from} m\", \"0 m\"], to = [\"{end} m\", \"0 m\"], fix = [\"x\"] }}] }}"),
        ]);
    }
    let computed = Computed::new(shipped_case("wall", overrides)?)?;
    let forces = ["active", "passive"].map(|name| {
        let rows = &computed.curve(name).rows;
        rows.last().map_or(f64::NAN, |row| row[1])
    });
    Ok((computed, forces))
}

/// The walls of a level.
fn walls(level: Level) -> Vec<Wall> {
    let on_a_line = |soil, cell| Wall {
        soil,
        cell,
        place: None,
    };
    let mut walls = vec![on_a_line(Soil::Sand, 0.25)];
    if level != Level::Quick {
        walls.push(on_a_line(Soil::SandWithFriction(15), 0.25));
    }
    if level == Level::Full {
        walls.extend([
            on_a_line(Soil::Clay, 0.25),
            on_a_line(Soil::ClayWithAdhesion, 0.25),
            on_a_line(Soil::SandWithFriction(15), 0.125),
        ]);
        // Along a wall as rough as the sand eight cells leave the active force 5 % above its bounds.
        let soils = [
            (Soil::Sand, 0.25),
            (Soil::Clay, 0.25),
            (Soil::SandWithFriction(15), 0.25),
            (Soil::SandWithFriction(20), 0.25),
            (Soil::SandWithFriction(30), 0.125),
        ];
        walls.extend(soils.iter().flat_map(|&(soil, cell)| {
            PLACES.map(|place| Wall {
                place: Some(place),
                ..on_a_line(soil, cell)
            })
        }));
    }
    walls
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-wall", ABOUT, out)?;
    let walls = walls(level);
    let done = walls
        .par_iter()
        .map(|&wall| push(wall))
        .collect::<Result<Vec<_>, CaseError>>()?;
    for (wall, (computed, forces)) in walls.iter().zip(done) {
        let (soil, label) = (wall.soil, wall.name());
        let record = RunRecord::new(&label, &computed.report, computed.elapsed);
        let run = study.run_to_end(record);
        for (way, name) in ["active", "passive"].into_iter().enumerate() {
            let sign = [-1.0, 1.0][way];
            let (expected, band) = match soil {
                Soil::Sand => (RANKINE.says(rankine(30.0, 0.1, sign)), CLOSE),
                Soil::Clay => (RANKINE.says(rankine(0.0, 5.0, sign)), CLOSE),
                Soil::SandWithFriction(degrees) => {
                    let friction = f64::from(degrees);
                    let both = [wedge(friction, 0.1, sign), lancellotta(friction, sign)];
                    let [low, high] = [both[0].min(both[1]), both[0].max(both[1])];
                    let band = Band::Between(0.96 * low, 1.04 * high);
                    (BOUNDS.says(0.5 * (low + high)), band)
                }
                // Without a bond it does not follow a wall that moves away.
                Soil::ClayWithAdhesion if way == 0 => continue,
                Soil::ClayWithAdhesion => {
                    let fan = 0.5 * std::f64::consts::PI;
                    let share = 2.0 * (1.0 + fan) * 5.0 / WEIGHT;
                    (ADHESION.says(1.0 + share), CLOSE)
                }
            };
            let quantity = format!("{name}: E/(γ H²/2) [-]");
            study.check(run, quantity, expected, band, forces[way]);
        }
    }
    Ok(study)
}
