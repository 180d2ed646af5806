//! A block on a weak seam, held by a tie: the factor of safety of a sliding block.

use std::path::Path;

use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use rayon::prelude::*;

use super::case;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};
use crate::runs::Computed;

/// The book's description of the study.
const ABOUT: &str = "A stiff block without weight on a level seam of weak soil is pushed by P, and a nail or an anchor through the seam ties it to the ground. It slides at F = (S + T sin β tan φ) / (P − T cos β), with S the strength of the seam, found on the same mesh without a tie, so that the check knows nothing of how a mesh sees the ends of a seam.";
const SLIDING: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "statics of a block on a seam",
    locator: "F = (S + T sin β tan φ)/(P − T cos β)",
};
const SEAM: &str = include_str!("seam.toml");

/// Tension of the tie at failure \[kN/m\]: capacity of the nail; bond of 12 kPa over 2 m of the anchor.
const NAIL: f64 = 30.0;
const ANCHOR: f64 = 24.0;
/// Push without a tie, and with one \[kN/m\].
const PUSH: f64 = 70.0;

/// A tie.
#[derive(Clone, Copy, PartialEq)]
enum Tie {
    None,
    Nail,
    /// An anchor; whether the strength reduction divides its bond.
    Anchor(bool),
}

/// A block that is searched for its factor of safety.
struct Block {
    name: &'static str,
    tie: Tie,
    /// Angle of friction and dilation of the seam \[degree\].
    friction: f64,
    push: f64,
    moving: bool,
    level: Level,
    band: f64,
}

const fn block(name: &'static str, tie: Tie, friction: f64, level: Level) -> Block {
    Block {
        name,
        tie,
        friction,
        push: PUSH,
        moving: false,
        level,
        band: 0.005,
    }
}

/// The first of each friction has no tie.
fn blocks() -> Vec<Block> {
    vec![
        block("no tie", Tie::None, 0.0, Level::Quick),
        block("nail at its capacity", Tie::Nail, 0.0, Level::Quick),
        block("anchor at its bond", Tie::Anchor(false), 0.0, Level::Quick),
        block(
            "anchor, bond reduced too",
            Tie::Anchor(true),
            0.0,
            Level::Quick,
        ),
        Block {
            push: 95.0,
            ..block("nail, pushed harder", Tie::Nail, 0.0, Level::Default)
        },
        Block {
            moving: true,
            band: 0.01,
            ..block("nail, moving geometry", Tie::Nail, 0.0, Level::Default)
        },
        block("friction, no tie", Tie::None, 20.0, Level::Default),
        block("friction, nail", Tie::Nail, 20.0, Level::Default),
        block("friction, anchor", Tie::Anchor(false), 20.0, Level::Default),
    ]
}

impl Block {
    fn run(&self) -> Result<Computed<2>, CaseError> {
        let mut text = SEAM.to_owned();
        if let Tie::Anchor(_) = self.tie {
            text = text
                .replace("\"nail\"", "\"anchor\"\nbonded_length = \"2 m\"")
                .replace("bond = \"100 kPa\"", "bond = \"12 kPa\"");
        }
        if self.friction > 0.0 {
            let friction = self.friction;
            let law = format!(
                "model = \"mohr-coulomb\"\ncohesion = \"10 kPa\"\nfriction = \"{friction} deg\"\n\
                 dilation = \"{friction} deg\"\n"
            );
            text = text
                .replace("model = \"tresca\"\n", &law)
                .replace("cu = \"10 kPa\"\n", "");
        }
        // On half a metre of its left side.
        let mut overrides = vec![format!("loads.push.pressure=\"{} kPa\"", 2.0 * self.push)];
        if self.tie == Tie::None {
            overrides.push("reinforcement.tie.capacity=\"1e-6 kN/m\"".to_owned());
        }
        if self.tie == Tie::Anchor(true) {
            overrides.push("reinforcement.tie.reduce_bond=true".to_owned());
        }
        if self.moving {
            for stage in ["push", "factor of safety"] {
                overrides.push(format!("stages.{stage}.geometry=moving"));
            }
        }
        Computed::new(case("seam.toml", &text, &overrides)?)
    }

    /// The factor at which a seam of strength `s` \[kN/m\] lets the block slide.
    fn factor(&self, s: f64) -> f64 {
        // Nine along and three down.
        let (cos, sin) = (9.0 / 90.0_f64.sqrt(), 3.0 / 90.0_f64.sqrt());
        let tan = self.friction.to_radians().tan();
        match self.tie {
            Tie::None => s / self.push,
            Tie::Nail => (s + NAIL * sin * tan) / (self.push - NAIL * cos),
            Tie::Anchor(false) => (s + ANCHOR * sin * tan) / (self.push - ANCHOR * cos),
            // F P = S + T cos β, with T = 24 kN/m over F; no friction.
            Tie::Anchor(true) => (s + ANCHOR * cos) / self.push,
        }
    }
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("reinforcement-seam", ABOUT, out)?;
    let blocks: Vec<Block> = blocks()
        .into_iter()
        .filter(|block| block.level <= level)
        .collect();
    let results = blocks
        .par_iter()
        .map(Block::run)
        .collect::<Result<Vec<_>, _>>()?;
    let header = ["friction_[deg]", "P_[kN/m]", "F_[-]", "exact_[-]"];
    let mut table = Table::new("factors_of_safety", &header);
    let mut strength = f64::NAN;
    for (block, computed) in std::iter::zip(&blocks, &results) {
        let trials: Vec<RunRecord> = computed
            .trials
            .iter()
            .map(|trial| RunRecord::new("", &trial.report, trial.elapsed))
            .collect();
        let run = study.run(RunRecord::sum(
            block.name,
            &trials.iter().collect::<Vec<_>>(),
        ));
        let found = computed
            .safety()
            .and_then(|safety| Some((safety.stable?, safety.failed?)));
        let found = found.map_or(f64::NAN, |(stable, failed)| 0.5 * (stable + failed));
        if block.tie == Tie::None {
            strength = found * block.push;
        } else {
            study.check(
                run,
                "F [-]",
                SLIDING.says(block.factor(strength)),
                Band::Relative(block.band),
                found,
            );
        }
        table.push(vec![
            block.friction,
            block.push,
            found,
            block.factor(strength),
        ]);
    }
    table.write_csv(&study.folder)?;
    study.notes.push(
        "The seam of 8 m and 10 kPa has S = 90.6 kN/m on this mesh, and 80 kN/m where only its length shears: \
         on cells of 0.25 m the soil beside the block's ends is sheared too."
            .to_owned(),
    );
    Ok(study)
}
