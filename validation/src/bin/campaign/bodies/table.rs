//! One row a scene as CSV, and the distribution of ends and effort as Markdown.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::scene::{Law, Scene};
use crate::tables::{EFFORT, causes, effort, effort_csv, invariants};
use crate::watch::{End, Watched};

const LAWS: [Law; 4] = [Law::Tresca, Law::VonMises, Law::MohrCoulomb, Law::Elastic];

/// One row a scene.
pub(crate) fn csv(runs: &[(Scene, Watched)]) -> String {
    let mut text = format!(
        "number,bodies,law,e_over_c,has_weight,stage,has_forces,particles,nearest_half_lengths,soil_in_bodies,{EFFORT}\n"
    );
    for (scene, watched) in runs {
        let bodies = scene.parts.iter();
        let bodies: Vec<String> = bodies
            .map(|part| format!("{} {:?}", part.kind.label(), part.place).to_lowercase())
            .collect();
        let _ = writeln!(
            text,
            "{},{},{},{:.1},{},{},{},{},{:.4},{},{}",
            scene.number,
            bodies.join(" + "),
            scene.law.label(),
            scene.stiffness,
            scene.has_weight,
            watched.stage,
            is_loaded(scene, watched),
            watched.particles,
            watched.effort.nearest.unwrap_or(f64::NAN),
            watched.effort.contact.len(),
            effort_csv(watched),
        );
    }
    text
}

/// The distribution of ends and effort over the scenes.
pub(crate) fn markdown(runs: &[(Scene, Watched)], seed: u64) -> String {
    let watched: Vec<&Watched> = runs.iter().map(|(_, watched)| watched).collect();
    let bodies = || runs.iter().flat_map(|(scene, _)| &scene.parts);
    let mut kinds: BTreeMap<_, usize> = BTreeMap::new();
    for part in bodies() {
        *kinds.entry(part.kind).or_default() += 1;
    }
    let kinds: Vec<String> = kinds
        .iter()
        .map(|(kind, count)| format!("{}: {count}", kind.label()))
        .collect();
    let mut text = format!(
        "{} scenes with {} bodies, seed {seed} ({}).\n\n",
        runs.len(),
        bodies().count(),
        kinds.join(", ")
    );
    text.push_str(&ends(runs));
    let early = |(_, run): &&(Scene, Watched)| run.end == End::Early;
    let under = |(scene, run): &&(Scene, Watched)| is_loaded(scene, run);
    let _ = writeln!(
        text,
        "Of the {} runs without equilibrium before the planned end, {} ended in a stage in which a body has a force \
         or is free.\n",
        runs.iter().filter(early).count(),
        runs.iter().filter(early).filter(under).count(),
    );
    text.push_str(&causes(&watched));
    text.push_str(&effort(&watched));
    text.push_str(&invariants(&watched));
    let touched = watched.iter().filter_map(|run| run.effort.nearest);
    let nearest = touched.fold(f64::INFINITY, f64::min);
    let wrong: usize = watched.iter().map(|run| run.effort.contact.len()).sum();
    let runs_with = watched.iter().filter(|run| !run.effort.contact.is_empty());
    let _ = writeln!(
        text,
        "| lets no particle into or through a body, and no side carry more than it can | {} of {}, {wrong} times; \
         the nearest centre stands {nearest:.3} half-lengths off a body |",
        runs_with.count(),
        runs.len(),
    );
    text
}

/// Whether the last stage of a run gave a body a force, or left it free.
fn is_loaded(scene: &Scene, watched: &Watched) -> bool {
    scene.loaded.contains(&watched.stage.as_str())
}

fn ends(runs: &[(Scene, Watched)]) -> String {
    let mut counts: BTreeMap<End, [usize; LAWS.len()]> = BTreeMap::new();
    for (scene, watched) in runs {
        let by_law = counts.entry(watched.end).or_default();
        for (count, law) in by_law.iter_mut().zip(LAWS) {
            *count += usize::from(scene.law == law);
        }
    }
    let laws = LAWS.map(Law::label).join(" | ");
    let mut text = format!("| end of the run | {laws} | all |\n|---|---|---|---|---|---|\n");
    for (end, by_law) in counts {
        let all: usize = by_law.iter().sum();
        let by_law = by_law.map(|count| count.to_string()).join(" | ");
        let _ = writeln!(text, "| {} | {by_law} | {all} |", end.label());
    }
    text + "\n"
}
