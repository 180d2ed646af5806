//! A wall that holds soil, moved away from it and into it: smooth, with friction, and with adhesion.

use std::path::Path;

use igimp_cases::CaseError;
use igimp_model::check::Band;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};
use crate::runs::{Computed, shipped_case};

/// What the book says of the study.
const ABOUT: &str = "A smooth wall beside level ground, moved away from it and into it: sand of the template (φ = ψ = 30°, with its cohesion of 0.1 kPa) without tension, and clay (s_u = γH/8) bonded to the wall. The field of stress is uniform but for weight, and exact. Then sand along a wall with friction (δ = 15°), and clay along one with adhesion s_u, pushed into it. They are computed with B-bar, with which they reach their end. Their ground stands on a base that is rough but for the first cell beside the wall, which slides: a base held up to the toe carries part of the force, along a smooth wall as along a rough one. With friction the claim is that of eight cells over the height and no more: on sixteen the active force lies 5 % below its bounds.";
const RANKINE: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Rankine",
    locator: "K = tan²(45° ∓ φ/2) ∓ 4 c tan(45° ∓ φ/2)/(γ H); φ = 0: 1 ∓ 4 s_u/(γ H)",
};
const BOUNDS: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "Coulomb's wedge, from above for the strength, and Lancellotta (2002), from below",
    locator: "φ = 30°, δ = 15°, no cohesion: K_a 0.3014 to 0.3048, K_p 4.439 to 4.977; the middle is given",
};
const ADHESION: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Rankine's field, fan and state at the wall",
    locator: "1 + 2 K_c s_u/(γ H), K_c = 1 + Δ + cos Δ, sin Δ = a/s_u",
};
/// What is claimed where the answer is exact.
const CLOSE: Band = Band::Relative(0.04);
/// Bounds of the active and passive force with friction of 15° along the wall \[-\].
const WITH_FRICTION: [[f64; 2]; 2] = [[0.3014, 0.3048], [4.439, 4.977]];
/// Weight of the soil beside the wall, γ H \[kPa\].
const WEIGHT: f64 = 40.0;

/// Passive (`sign` 1) or active (−1) force over γ H²/2.
fn rankine(degrees: f64, cohesion: f64, sign: f64) -> f64 {
    let root = (45.0 + 0.5 * sign * degrees).to_radians().tan();
    root * root + sign * 4.0 * cohesion * root / WEIGHT
}

/// What stands beside the wall, and what holds it there.
#[derive(Clone, Copy, PartialEq)]
enum Soil {
    Sand,
    Clay,
    SandWithFriction,
    ClayWithAdhesion,
}

impl Soil {
    fn name(self) -> &'static str {
        match self {
            Self::Sand => "sand",
            Self::Clay => "clay",
            Self::SandWithFriction => "sand, δ = 15°",
            Self::ClayWithAdhesion => "clay, adhesion s_u",
        }
    }
}

/// Runs the template with a soil and two motions \[m\]; its forces over γ H²/2, active and passive.
fn push(cell: f64, soil: Soil) -> Result<(Computed<2>, [f64; 2]), CaseError> {
    let mut overrides = vec![format!("grid.cell=\"{cell} m\""), "checks=[]".to_owned()];
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
        Soil::SandWithFriction => Some("{ angle = \"15 deg\" }"),
        Soil::ClayWithAdhesion => Some("{ adhesion_share = 1.0 }"),
    };
    if let Some(interface) = interface {
        let rough_from = 1.5 * cell;
        overrides.extend([
            format!("rigid.wall.interface={interface}"),
            "grid.locking=b-bar".to_owned(),
            format!("boundaries={{ left = \"free\", bottom = \"roller\", boxes = [{{ name = \"base\", from = [\"{rough_from} m\", \"0 m\"], to = [\"8 m\", \"0 m\"], fix = [\"x\"] }}] }}"),
        ]);
    }
    let computed = Computed::new(shipped_case("wall", overrides)?)?;
    let forces = ["active", "passive"].map(|name| {
        let rows = &computed.curve(name).rows;
        rows.last().map_or(f64::NAN, |row| row[1])
    });
    Ok((computed, forces))
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-wall", ABOUT, out)?;
    let mut jobs = vec![(0.25, Soil::Sand)];
    if level != Level::Quick {
        jobs.push((0.25, Soil::SandWithFriction));
    }
    if level == Level::Full {
        jobs.extend([
            (0.25, Soil::Clay),
            (0.25, Soil::ClayWithAdhesion),
            (0.125, Soil::SandWithFriction),
        ]);
    }
    let done = jobs
        .par_iter()
        .map(|&(cell, soil)| push(cell, soil))
        .collect::<Result<Vec<_>, CaseError>>()?;
    for (&(cell, soil), (computed, forces)) in jobs.iter().zip(done) {
        let label = format!("{}, H/h = {}", soil.name(), 2.0 / cell);
        let record = RunRecord::new(&label, &computed.report, computed.elapsed);
        if soil == Soil::SandWithFriction && cell < 0.25 {
            study.run(record);
            study.notes.push(format!(
                "contact-wall, {label}: K_a = {:.4}, K_p = {:.3}; not claimed, the active force has fallen 5 % below its bounds",
                forces[0], forces[1]
            ));
            continue;
        }
        let run = study.run_to_end(record);
        for (way, name) in ["active", "passive"].into_iter().enumerate() {
            let sign = [-1.0, 1.0][way];
            let (expected, band) = match soil {
                Soil::Sand => (RANKINE.says(rankine(30.0, 0.1, sign)), CLOSE),
                Soil::Clay => (RANKINE.says(rankine(0.0, 5.0, sign)), CLOSE),
                Soil::SandWithFriction => {
                    let [low, high] = WITH_FRICTION[way];
                    let band = Band::Between(0.96 * low, 1.04 * high);
                    (BOUNDS.says(0.5 * (low + high)), band)
                }
                // Without a bond it does not follow a wall that moves away.
                Soil::ClayWithAdhesion if way == 0 => continue,
                Soil::ClayWithAdhesion => {
                    let own = 0.5 * std::f64::consts::PI;
                    let share = 2.0 * (1.0 + own) * 5.0 / WEIGHT;
                    (ADHESION.says(1.0 + share), CLOSE)
                }
            };
            let what = format!("{name}: E/(γ H²/2) [-]");
            study.check(run, what, expected, band, forces[way]);
        }
    }
    Ok(study)
}
