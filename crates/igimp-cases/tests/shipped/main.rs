//! GOAL: every case file that comes with the program runs to its planned end and makes physical
//! sense, on meshes so coarse that all of them take less than a minute. `page.rs` runs most of them whole, in another.

#[path = "../common/resuming.rs"]
mod resuming;

mod benchmarks;
mod contact;
mod foundations;
mod ground;
mod motion;
mod page;
mod slopes;
mod softening;
mod space;
mod water;

use std::sync::atomic::AtomicBool;

use igimp_cases::run::{Nobody, Run, Start, run};
use igimp_input::CaseFile;
use igimp_input::shipped::{SHIPPED, find};
use igimp_model::Case;
use igimp_results::summary::StageOutcome;

/// A shipped case after a run in memory.
struct Ran<const D: usize> {
    run: Run<D>,
    gravity: f64,
}

/// A shipped case with changed values.
fn file(name: &str, overrides: &[&str]) -> CaseFile {
    let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
    let text = find(name).unwrap().text;
    CaseFile::parse(name, text, &overrides).unwrap_or_else(|error| panic!("{error}"))
}

/// Runs a case.
fn ran_case<const D: usize>(case: &Case<D>) -> Ran<D> {
    let interrupt = AtomicBool::new(false);
    Ran {
        run: run(case, None, Start::Afresh, &mut Nobody, &interrupt).unwrap(),
        gravity: case.gravity,
    }
}

/// Runs a shipped case of plane strain with changed values.
fn ran(name: &str, overrides: &[&str]) -> Ran<2> {
    ran_case(file(name, overrides).case())
}

/// Runs a shipped case in space with changed values.
fn ran_in_space(name: &str, overrides: &[&str]) -> Ran<3> {
    ran_case(file(name, overrides).case_in_space())
}

impl<const D: usize> Ran<D> {
    /// Outcomes of the stages, in order.
    fn outcomes(&self) -> Vec<StageOutcome> {
        let stages = &self.run.summary.stages;
        stages.iter().map(|stage| stage.outcome).collect()
    }

    /// Points of a curve.
    fn curve(&self, name: &str) -> Vec<[f64; 2]> {
        let table = self.run.curves.iter().find(|table| table.name == name);
        table.unwrap().points(0, 1)
    }

    /// Ordinate at the end of a curve.
    fn end_of(&self, name: &str) -> f64 {
        self.curve(name).last().unwrap()[1]
    }

    /// The value that a check measured.
    fn measured(&self, quantity: &str) -> f64 {
        let rows = &self.run.summary.checks;
        let row = rows.iter().find(|row| row.check.quantity == quantity);
        row.unwrap_or_else(|| panic!("no check of {quantity}"))
            .check
            .measured
    }

    /// Whether every check of the case is met.
    fn meets_its_checks(&self) -> bool {
        let checks = &self.run.summary.checks;
        !checks.is_empty() && checks.iter().all(|row| row.pass)
    }

    /// The interval of the factor of safety that a stage found.
    fn factor_of_safety(&self, stage: usize) -> [f64; 2] {
        let safety = self.run.summary.stages[stage].safety.as_ref().unwrap();
        [safety.stable.unwrap(), safety.failed.unwrap()]
    }

    /// Work of the vertical stress over that of the weight, for a virtual displacement upwards that is
    /// the height: 1 in equilibrium on a base at height 0, whatever the law and however large the deformation.
    fn virtual_work(&self, gravity_factor: f64) -> f64 {
        let particles = &self.run.body.particles;
        let stress: f64 = (0..particles.len())
            .map(|particle| particles.sigma[particle][D - 1][D - 1] * particles.volume(particle))
            .sum();
        let weight: f64 = std::iter::zip(&particles.mass, &particles.x)
            .map(|(mass, x)| mass * self.gravity * gravity_factor * x[D - 1])
            .sum();
        -stress / weight
    }
}

#[track_caller]
fn between(value: f64, low: f64, high: f64) {
    assert!(low <= value && value <= high, "{value} in {low} .. {high}");
}

#[test]
fn every_case_has_a_test() {
    let source = [
        include_str!("benchmarks.rs"),
        include_str!("contact.rs"),
        include_str!("foundations.rs"),
        include_str!("ground.rs"),
        include_str!("motion.rs"),
        include_str!("slopes.rs"),
        include_str!("softening.rs"),
        include_str!("space.rs"),
        include_str!("water.rs"),
    ]
    .concat();
    for case in SHIPPED {
        let call = format!("ran(\"{}\"", case.name);
        let broken = format!("ran(\n        \"{}\"", case.name);
        let in_space = format!("ran_in_space(\"{}\"", case.name);
        assert!(
            [call, broken, in_space]
                .iter()
                .any(|call| source.contains(call)),
            "{}",
            case.name
        );
    }
}
