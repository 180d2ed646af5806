//! How much of a whole run is done, from its events.

use igimp_cases::run::Event;
use igimp_estimate::time::shares;
use igimp_model::{AnyCase, in_any_dimension, meshes};

/// Trials of a search that are shown as progress: how many it makes is not known before it ends, and each
/// takes this share of what is left \[-\].
const TRIAL: f64 = 0.3;

/// The share of a run that is done.
#[derive(Clone, Debug, Default)]
pub struct Whole {
    meshes: Vec<Mesh>,
}

/// A run on one mesh; of a run without a study of the mesh error, the run.
#[derive(Clone, Debug)]
struct Mesh {
    parts: usize,
    /// Its share of the work of all meshes.
    share: f64,
    /// The share of each of its stages in its work.
    stages: Vec<f64>,
    stage: usize,
    /// Share of the stage that trials have done.
    trials: f64,
    /// Share of the stage that is done.
    done: f64,
}

impl Whole {
    /// Of a case that is about to run.
    pub fn of(case: &AnyCase) -> Self {
        let parts = in_any_dimension!(case, case => meshes::refinements(case));
        let stages = in_any_dimension!(case, case => shares(case));
        // Half the cell: four times the unknowns, and a factorisation that takes eight times as long.
        let work = |parts: usize| (parts as f64).powi(3);
        let all: f64 = parts.iter().map(|&parts| work(parts)).sum();
        let mesh = |&parts: &usize| Mesh {
            parts,
            share: work(parts) / all,
            stages: stages.clone(),
            stage: 0,
            trials: 0.0,
            done: 0.0,
        };
        Self {
            meshes: parts.iter().map(mesh).collect(),
        }
    }

    /// Takes an event into account; the share of the run that is done \[-\].
    pub fn after<const D: usize>(&mut self, event: &Event<'_, D>) -> f64 {
        match event {
            Event::OfMesh { parts, event } => {
                let mut meshes = self.meshes.iter_mut();
                if let Some(mesh) = meshes.find(|mesh| mesh.parts == *parts) {
                    mesh.note(event);
                }
            }
            event => {
                if let Some(mesh) = self.meshes.first_mut() {
                    mesh.note(event);
                }
            }
        }
        let done = |mesh: &Mesh| mesh.share * mesh.done();
        self.meshes.iter().map(done).sum::<f64>().clamp(0.0, 1.0)
    }
}

/// Share of what is left of a search that an equilibrium of its path is thought to do \[-\].
const PATH: f64 = 0.15;

impl Mesh {
    fn note<const D: usize>(&mut self, event: &Event<'_, D>) {
        match event {
            Event::StageStarted { stage, .. } => {
                (self.stage, self.trials, self.done) = (*stage, 0.0, 0.0);
            }
            Event::Step { progress, .. } => {
                let left = 1.0 - self.trials;
                let is_search = self.trials > 0.0;
                let share = if is_search { TRIAL * left } else { left };
                self.done = self.done.max(self.trials + share * progress);
            }
            Event::Path { .. } => {
                self.trials += PATH * (1.0 - self.trials);
                self.done = self.done.max(self.trials);
            }
            Event::Trial { .. } => {
                self.trials += TRIAL * (1.0 - self.trials);
                self.done = self.done.max(self.trials);
            }
            Event::StageEnded { .. } => self.done = 1.0,
            _ => {}
        }
    }

    fn done(&self) -> f64 {
        let before: f64 = self.stages.iter().take(self.stage).sum();
        before + self.done * self.stages.get(self.stage).copied().unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use igimp_input::shipped::find;
    use igimp_results::summary::StageSummary;

    use super::*;

    fn case(set: &[&str]) -> AnyCase {
        let slope = find("slope").unwrap();
        slope.case_file(set.to_vec()).unwrap().any_case().clone()
    }

    fn end(summary: &StageSummary) -> Event<'_, 2> {
        Event::StageEnded { summary }
    }

    fn start(stage: usize) -> Event<'static, 2> {
        Event::StageStarted {
            stage,
            of: 3,
            name: "a stage",
            kind: "gravity",
            steps: 10,
        }
    }

    #[test]
    fn a_run_goes_from_nothing_to_all() {
        let mut whole = Whole::of(&case(&[]));
        let ended = StageSummary::default();
        let mut before = 0.0;
        for stage in 0..3 {
            let now = whole.after(&start(stage));
            assert!((now - before).abs() < 1e-12);
            before = whole.after(&end(&ended));
            assert!(before > now);
        }
        assert!((before - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_finest_mesh_is_most_of_a_study() {
        let mut whole = Whole::of(&case(&["mesh_study.meshes=2"]));
        let ended = StageSummary::default();
        let mut done = [0.0; 2];
        for (parts, done) in [1, 2].into_iter().zip(&mut done) {
            for stage in 0..3 {
                for event in [start(stage), Event::StageEnded { summary: &ended }] {
                    *done = whole.after(&Event::OfMesh {
                        parts,
                        event: &event,
                    });
                }
            }
        }
        assert!((done[0] - 1.0 / 9.0).abs() < 1e-12 && (done[1] - 1.0).abs() < 1e-12);
    }
}
