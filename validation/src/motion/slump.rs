//! The deposit of a block of clay that spreads over a floor, creeping against a drag: a layer that yields everywhere.

use std::f64::consts::FRAC_PI_2;

use igimp_assembly::Particles;
use igimp_cases::CaseError;
use igimp_input::CaseFile;
use igimp_model::check::Band;

use super::deposits::length_with;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};
use crate::runs::Computed;

const PLASTIC_LAYER: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "yield-stress fluid at rest on a rough floor, second order in height over length (Dubash et al. 2009)",
    locator: "h = π a/2 + √(2 a (x_f − x)), a = c_u/γ, with x_f by the volume",
};
/// Strength of the clay that spreads \[Pa\], unit weight \[N/m³\], gravity \[m/s²\], volume of the half that is modelled \[m³/m\].
const STRENGTH: f64 = 309.0;
const WEIGHT: f64 = 18e3;
const GRAVITY: f64 = 9.81;
const VOLUME: f64 = 0.25;
/// Places at which the height is printed \[m\].
const PLACES: [f64; 8] = [0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0, 1.2];
/// How many of them are held: beyond them the layer is few cells high.
const HELD: usize = 4;
/// Share of the clay whose length is printed \[-\].
const MOST: f64 = 0.95;

/// The floor that the clay spreads over.
#[derive(Clone, Copy)]
enum Floor {
    /// Nodes that are held: soil touches them up to a cell above.
    Nodes,
    /// A rigid body, which soil touches where it is.
    Rigid,
}

/// A block of clay that stands, and then loses its strength: cells \[cm\], particles in each, the threshold of small cuts \[-\], Young's
/// modulus \[kPa\], and the motion aimed at in a step \[cells\].
#[derive(Clone, Copy)]
struct Block {
    floor: Floor,
    cell: f64,
    particles: usize,
    small_cuts: f64,
    young: f64,
    move_per_step: f64,
}

impl Block {
    fn case_file(&self) -> String {
        let Self {
            cell,
            particles,
            small_cuts,
            young,
            move_per_step,
            ..
        } = self;
        let (bottom, floor) = match self.floor {
            Floor::Nodes => (
                "bottom = \"fixed\"",
                r#"[[boundaries.boxes]]
name = "floor"
from = ["0 m", "-5 cm"]
to = ["2.5 m", "0 m"]"#,
            ),
            Floor::Rigid => (
                "",
                r#"[[rigid]]
name = "floor"
type = "rectangle"
from = ["-0.5 m", "-15 cm"]
to = ["3 m", "0 m"]
interface = { adhesion_share = 1.0 }
from_start = true
rounding = 0
most_penetration = 0.2"#,
            ),
        };
        let lowest = match self.floor {
            Floor::Nodes => "-5 cm",
            Floor::Rigid => "-10 cm",
        };
        format!(
            r#"
igimp = 1
[case]
title = "a block of clay that spreads"
[grid]
cell = "{cell} cm"
domain = {{ x = ["0 m", "2.5 m"], y = ["{lowest}", "60 cm"] }}
small_cuts = {{ below = {small_cuts} }}
[materials.clay]
model = "von-mises"
unit_weight = "18 kN/m3"
young = "{young} kPa"
poisson = 0.45
cu = "4 kPa"
[[bodies]]
name = "block"
material = "clay"
points_per_cell = {particles}
polygon = [["0 m", "0 m"], ["0.5 m", "0 m"], ["0.5 m", "0.5 m"], ["0 m", "0.5 m"]]
[boundaries]
left = "roller"
{bottom}
{floor}
[[stages]]
name = "weight"
type = "gravity"
steps = 3
[[stages]]
name = "slump"
type = "run-out"
reduction = {{ factor = 12.945 }}
materials = ["clay"]
steps = 4000
at_rest = 1e-4
move_per_step = {move_per_step}
"#
        )
    }

    /// Lets it spread, and prints its deposit.
    fn spread(&self) -> Result<Computed<2>, CaseError> {
        let case = CaseFile::parse("slump.toml", &self.case_file(), &[])?.into_case();
        let computed = Computed::<2>::new(case)?;
        let particles = computed.particles();
        let heights = PLACES.map(|x| format!("{:.4}", height(particles, x)));
        let floor = match self.floor {
            Floor::Nodes => "held nodes",
            Floor::Rigid => "a rigid floor",
        };
        println!(
            "motion: slump on {floor}, cells of {} cm, {} particles each, small cuts of {}, {} kPa, steps of {} of a cell: heights {} m at \
             x = {PLACES:?} m, 95 % within {:.3} m; {}",
            self.cell,
            self.particles,
            self.small_cuts,
            self.young,
            self.move_per_step,
            heights.join(", "),
            length(particles),
            computed.run.summary.stages[1].reason
        );
        Ok(computed)
    }
}

/// How far deposits are held to theory \[-\].
const WITHIN: f64 = 0.03;

/// Young's moduli of blocks whose mean is held \[kPa\]. Theory knows none, and one run differs from another by up to three cells in
/// length: which row of clay comes down last before the front decides.
const STIFFNESSES: [f64; 3] = [450.0, 550.0, 650.0];

/// Holds a block on coarse cells of held nodes in height, and the mean of blocks on fine cells of a rigid floor in length too. At the full
/// level their mean in short steps is held as well, and others are printed beside them.
pub(super) fn hold(study: &mut Study, level: Level) -> Result<(), CaseError> {
    let block = |floor, cell, particles, small_cuts| Block {
        floor,
        cell,
        particles,
        small_cuts,
        young: 500.0,
        move_per_step: 0.1,
    };
    let computed = block(Floor::Nodes, 5.0, 9, 0.2).spread()?;
    hold_one(study, "slump of clay, cells of 5 cm", &computed);
    let fine = block(Floor::Rigid, 2.0, 4, 0.07);
    let long = Block {
        move_per_step: 0.25,
        ..fine
    };
    hold_mean(study, "2 cm", &long)?;
    if level == Level::Full {
        hold_mean(study, "2 cm, short steps", &fine)?;
        block(Floor::Nodes, 2.5, 9, 0.2).spread()?;
        block(Floor::Rigid, 5.0, 9, 0.2).spread()?;
        for small_cuts in [0.03, 0.05, 0.07, 0.1, 0.2, 0.3] {
            block(Floor::Rigid, 2.5, 4, small_cuts).spread()?;
        }
        block(Floor::Rigid, 2.5, 16, 0.2).spread()?;
        block(Floor::Rigid, 2.0, 4, 0.05).spread()?;
    }
    Ok(())
}

/// Holds the mean heights and the mean length of the deposits of blocks of several stiffnesses on a rigid floor.
fn hold_mean(study: &mut Study, cells: &str, block: &Block) -> Result<(), CaseError> {
    let mut runs = Vec::new();
    let (mut heights, mut end) = ([0.0; HELD], 0.0);
    for young in STIFFNESSES {
        let computed = Block { young, ..*block }.spread()?;
        let variant = format!("slump of clay on a rigid floor, cells of {cells}, {young} kPa");
        runs.push(record(study, &variant, &computed));
        let (particles, share) = (computed.particles(), 1.0 / STIFFNESSES.len() as f64);
        for (mean, place) in std::iter::zip(&mut heights, PLACES) {
            *mean += share * height(particles, place);
        }
        end += share * length(particles);
    }
    let run = runs[0];
    hold_heights(study, run, "mean height of three stiffnesses", &heights);
    study.check(
        run,
        "mean length of three stiffnesses with 95 % of the clay [m]",
        PLASTIC_LAYER.says(layer_length(MOST)),
        Band::Relative(WITHIN),
        end,
    );
    Ok(())
}

/// Holds the heights that one block leaves.
fn hold_one(study: &mut Study, variant: &str, computed: &Computed<2>) {
    let run = record(study, variant, computed);
    let heights: Vec<f64> = PLACES[..HELD]
        .iter()
        .map(|place| height(computed.particles(), *place))
        .collect();
    hold_heights(study, run, "height", &heights);
}

/// A run that had to come to its end.
fn record(study: &mut Study, variant: &str, computed: &Computed<2>) -> usize {
    study.run_to_end(RunRecord::new(variant, &computed.report, computed.elapsed))
}

/// Holds heights to those of theory.
fn hold_heights(study: &mut Study, run: usize, quantity: &str, heights: &[f64]) {
    let front = layer_front();
    for (place, height) in std::iter::zip(PLACES, heights) {
        study.check(
            run,
            format!("{quantity} at x = {place} m [m]"),
            PLASTIC_LAYER.says(layer_height(front, place)),
            Band::Relative(WITHIN),
            *height,
        );
    }
}

/// The volume of soil within 5 cm of a place over the way across it \[m\].
fn height(particles: &Particles<2>, place: f64) -> f64 {
    let [from, to] = [place - 0.05, place + 0.05];
    let volume = |p: usize| {
        let (x, half) = (particles.x[p][0], particles.half_length[p][0]);
        let within = (x + half).min(to) - (x - half).max(from);
        particles.mass[p] * GRAVITY / WEIGHT * within.max(0.0) / (2.0 * half)
    };
    (0..particles.len()).map(volume).sum::<f64>() / (to - from)
}

/// The length within which most of the clay lies \[m\].
fn length(particles: &Particles<2>) -> f64 {
    let soil = std::iter::zip(&particles.x, &particles.mass).map(|(x, mass)| [x[0], *mass]);
    length_with(MOST, soil.collect())
}

/// The height of a layer at yield \[m\]: thrust, less by the difference of stresses over the height, changes by the shear on the floor.
fn layer_height(front: f64, x: f64) -> f64 {
    let scale = STRENGTH / WEIGHT;
    FRAC_PI_2 * scale + (2.0 * scale * (front - x)).sqrt()
}

/// The length within which a share of a layer at yield lies \[m\].
fn layer_length(share: f64) -> f64 {
    let end = layer_front();
    let volume = |length: f64| {
        let scale = STRENGTH / WEIGHT;
        let beyond = end - length;
        VOLUME - beyond * (FRAC_PI_2 * scale + 2.0 / 3.0 * (2.0 * scale * beyond).sqrt())
    };
    root(|length| volume(length) - share * VOLUME, end)
}

/// Where a function that rises from below zero at 0 to above it at `end` is zero.
fn root(function: impl Fn(f64) -> f64, end: f64) -> f64 {
    let (mut below, mut above) = (0.0, end);
    for _ in 0..100 {
        let middle = 0.5 * (below + above);
        if function(middle) < 0.0 {
            below = middle;
        } else {
            above = middle;
        }
    }
    above
}

/// Where a layer at yield of the volume ends \[m\].
fn layer_front() -> f64 {
    let scale = STRENGTH / WEIGHT;
    let volume =
        |front: f64| front * (FRAC_PI_2 * scale + 2.0 / 3.0 * (2.0 * scale * front).sqrt());
    root(|front| volume(front) - VOLUME, 10.0)
}
