//! What a block of clay leaves that spreads over a floor, creeping against a drag: a layer that yields everywhere.

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
/// Places at which the height is told \[m\].
const PLACES: [f64; 8] = [0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0, 1.2];
/// How many of them are held: beyond them the layer is few cells high.
const HELD: usize = 4;
/// Share of the clay whose length is told \[-\].
const MOST: f64 = 0.95;

/// What the clay spreads over.
#[derive(Clone, Copy)]
enum Floor {
    /// Nodes that are held: soil touches them up to a cell above.
    Nodes,
    /// A rigid body, which soil touches where it is.
    Rigid,
}

/// A block of clay that stands, and then loses its strength: cells \[cm\], particles in each, the threshold of small cuts \[-\], and by
/// what share its Young's modulus is greater than 500 kPa \[-\].
#[derive(Clone, Copy)]
struct Block {
    floor: Floor,
    cell: f64,
    particles: usize,
    small_cuts: f64,
    stiffer: f64,
}

impl Block {
    fn case_file(&self) -> String {
        let Self {
            cell,
            particles,
            small_cuts,
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
"#,
            young = 500.0 * (1.0 + self.stiffer),
        )
    }

    /// Lets it spread, and prints what it leaves.
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
            "motion: slump on {floor}, cells of {} cm, {} particles each, small cuts of {}, 500 kPa and {} of it: heights {} m at \
             x = {PLACES:?} m, 95 % within {:.3} m; {}",
            self.cell,
            self.particles,
            self.small_cuts,
            self.stiffer,
            heights.join(", "),
            length(particles),
            computed.run.summary.stages[1].reason
        );
        Ok(computed)
    }
}

/// How far deposits are held to theory \[-\].
const WITHIN: f64 = 0.03;

/// Holds a block on coarse cells of held nodes in height, and one on fine cells on a rigid floor in length too. At the full level
/// it is held with other stiffnesses as well, by which these runs scatter, and others are printed beside it.
pub(super) fn hold(study: &mut Study, level: Level) -> Result<(), CaseError> {
    let block = |floor, cell, particles, small_cuts| Block {
        floor,
        cell,
        particles,
        small_cuts,
        stiffer: 0.0,
    };
    let computed = block(Floor::Nodes, 5.0, 9, 0.2).spread()?;
    hold_heights(study, "slump of clay, cells of 5 cm", &computed);
    let fine = block(Floor::Rigid, 2.5, 4, 0.05);
    hold_deposit(study, "2.5 cm", &fine)?;
    if level == Level::Full {
        for stiffer in [1e-8, 1e-6, 1e-4, 1e-3] {
            let variant = format!("2.5 cm, stiffer by {stiffer:e}");
            hold_deposit(study, &variant, &Block { stiffer, ..fine })?;
        }
        let finer = block(Floor::Rigid, 2.0, 4, 0.07).spread()?;
        let variant = "slump of clay on a rigid floor, cells of 2 cm";
        hold_heights(study, variant, &finer);
        block(Floor::Nodes, 2.5, 9, 0.2).spread()?;
        block(Floor::Rigid, 5.0, 9, 0.2).spread()?;
        for small_cuts in [0.03, 0.07, 0.1, 0.2, 0.3] {
            block(Floor::Rigid, 2.5, 4, small_cuts).spread()?;
        }
        block(Floor::Rigid, 2.5, 16, 0.2).spread()?;
        block(Floor::Rigid, 2.0, 4, 0.05).spread()?;
    }
    Ok(())
}

/// Holds the heights and the length of what a block leaves on a rigid floor.
fn hold_deposit(study: &mut Study, cells: &str, block: &Block) -> Result<(), CaseError> {
    let computed = block.spread()?;
    let variant = format!("slump of clay on a rigid floor, cells of {cells}");
    let run = hold_heights(study, &variant, &computed);
    study.check(
        run,
        "length with 95 % of the clay [m]",
        PLASTIC_LAYER.says(layer_length(MOST)),
        Band::Relative(WITHIN),
        length(computed.particles()),
    );
    Ok(())
}

/// Holds the heights that a block leaves to those of theory.
fn hold_heights(study: &mut Study, variant: &str, computed: &Computed<2>) -> usize {
    let run = study.run_to_end(RunRecord::new(variant, &computed.report, computed.elapsed));
    let end = layer_front();
    for place in &PLACES[..HELD] {
        study.check(
            run,
            format!("height at x = {place} m [m]"),
            PLASTIC_LAYER.says(layer_height(end, *place)),
            Band::Relative(WITHIN),
            height(computed.particles(), *place),
        );
    }
    run
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
