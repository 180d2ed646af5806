//! From the thread of a run to that of Python: what happened, and the word to go on.

use std::sync::mpsc::{Receiver, Sender};

use igimp_cases::run::{Event, Listener};
use igimp_study::narration::lines::Lines;
use igimp_study::narration::progress::Whole;
use serde_json::{Value, json};

use crate::arrays::Arrays;

/// Something that happened.
#[derive(Debug)]
pub(crate) struct Seen {
    /// Numbers and names, as JSON.
    pub(crate) text: String,
    /// The body, after a step whose body was asked for.
    pub(crate) body: Option<Arrays>,
}

/// Listens to a run in its thread. The run waits until Python has looked at what it was told.
#[derive(Debug)]
pub(crate) struct Relay {
    pub(crate) events: Sender<Seen>,
    pub(crate) go_on: Receiver<()>,
    pub(crate) lines: Lines,
    pub(crate) whole: Whole,
    /// Whether steps are told with their body.
    pub(crate) with_body: bool,
    pub(crate) stage: Stage,
    pub(crate) body: Option<Arrays>,
}

/// The stage that a run is in.
#[derive(Debug, Default)]
pub(crate) struct Stage {
    number: usize,
    of: usize,
    name: String,
    kind: &'static str,
    steps: usize,
    trial: usize,
}

impl<const D: usize> Listener<D> for Relay {
    fn on_event(&mut self, event: &Event<'_, D>) {
        let line = self.lines.line(event);
        let share = self.whole.after(event);
        let (kind, details) = match event {
            // Python sees a step before it is recorded: if it wants no more, the run ends at this very step.
            Event::Equilibrium { number, accepted } => {
                if self.with_body {
                    self.body = Some(Arrays::of((*accepted.body.particles).clone()));
                }
                let report = accepted.report;
                let step = json!({
                    "number": number,
                    "load_factor": report.to,
                    "iterations": report.iterations,
                    "residuals": report.residuals,
                    "plastic_share": report.plastic_share,
                    "unknowns": report.unknowns,
                    "at_round_off": report.at_round_off,
                });
                ("step", step)
            }
            Event::StageStarted {
                stage,
                of,
                name,
                kind,
                steps,
            } => {
                self.stage = Stage {
                    number: *stage,
                    of: *of,
                    name: (*name).to_owned(),
                    kind,
                    steps: *steps,
                    trial: 0,
                };
                ("stage", Value::Null)
            }
            Event::Step { .. } => ("recorded", Value::Null),
            Event::Cut { error } => ("cut", json!({ "from": error.from, "to": error.to })),
            Event::Trial { trial, .. } => {
                self.stage.trial += 1;
                ("trial", json!({ "srf": trial.srf, "stable": trial.stable }))
            }
            Event::Path { point } => ("path", json!(point)),
            Event::StageEnded { summary } => ("stage_end", json!(summary)),
            Event::Warning { text } => ("warning", json!({ "text": text })),
            Event::Prepared { .. } => ("prepared", Value::Null),
            Event::OfMesh { parts, .. } => ("mesh", json!({ "parts": parts })),
        };
        let Stage {
            number,
            of,
            name,
            kind: stage_kind,
            steps,
            trial,
        } = &self.stage;
        let text = json!({
            "event": kind,
            "line": line,
            "share": share,
            "stage": { "index": number, "of": of, "name": name, "kind": stage_kind, "steps": steps, "trial": trial },
            "details": details,
        });
        let seen = Seen {
            text: text.to_string(),
            body: self.body.take(),
        };
        // Nobody listens any more: the run goes on to where it may end.
        if self.events.send(seen).is_ok() {
            let _ = self.go_on.recv();
        }
    }
}
