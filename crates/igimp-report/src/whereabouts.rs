//! Where a frame stands in its run: its stage, and the step or the trial of that stage.

use igimp_model::{Stage, StageKind};
use igimp_results::paraview::pvd::Frame;
use igimp_text::on_a_line;

/// Where a frame stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Whereabouts {
    /// The number of its stage, from 0, where that is known.
    pub stage: Option<usize>,
    /// The step of its stage, or the trial of a search; 0 before the first.
    pub step: usize,
    /// The step in words.
    pub when: String,
}

/// Where the frames of a run stand, in their order.
///
/// Times of frames count the steps and trials of the whole run, and not those that a stage took back. Every stage leaves a frame at
/// its end: the next one counts from there.
#[must_use]
pub fn whereabouts(frames: &[Frame], stages: &[Stage]) -> Vec<Whereabouts> {
    let (mut start, mut stage, mut before) = (0.0, None, None::<&Frame>);
    let mut all = Vec::new();
    for frame in frames {
        if let Some(end) = before.filter(|before| before.stage != frame.stage) {
            start = end.time;
        }
        before = Some(frame);
        stage = number(stages, &frame.stage, stage.unwrap_or(0)).or(stage);
        let step = (frame.time - start).max(0.0).floor() as usize;
        let kind = stage.map(|stage: usize| &stages[stage].kind);
        let when = match kind {
            Some(StageKind::StrengthReduction(_)) if step == 0 => "as it ends".to_owned(),
            Some(StageKind::StrengthReduction(_)) => format!("trial {step}"),
            _ => format!("step {step}"),
        };
        all.push(Whereabouts { stage, step, when });
    }
    all
}

/// The number of a stage by its name, at the one before it or later: names may come again.
fn number(stages: &[Stage], name: &str, before: usize) -> Option<usize> {
    let has_name = |&k: &usize| on_a_line(&stages[k].name) == name;
    let later = (before..stages.len()).find(has_name);
    later.or_else(|| (0..before).find(has_name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use igimp_input::shipped::find;

    /// GOAL: the step of a frame is that of its stage: after a search, after steps that a stage took back, and at the start of a motion.
    /// CASE: weight, a push of which five steps were taken back at its end, and an earthquake; a search by trials.
    /// ORACLE: counted by hand.
    #[test]
    fn steps_are_counted_within_the_stage() {
        let steps = |case: &str, frames: &[(f64, &str)]| -> Vec<String> {
            let case = find(case).unwrap().case_file([""; 0]).unwrap().into_case();
            let frame = |&(time, stage): &(f64, &str)| Frame {
                time,
                stage: stage.to_owned(),
                file: String::new(),
            };
            let frames: Vec<Frame> = frames.iter().map(frame).collect();
            let all = whereabouts(&frames, &case.stages).into_iter();
            let words = |place: Whereabouts| format!("{} {}", place.stage.unwrap() + 1, place.when);
            all.map(words).collect()
        };
        let frames = [
            (1.0, "weight"),
            (2.0, "weight"),
            (3.0, "push"),
            (8.0, "push"),
            (8.5, "earthquake"),
            (32.0, "earthquake"),
        ];
        assert_eq!(
            steps("earthquake_slope", &frames),
            [
                "1 step 1",
                "1 step 2",
                "2 step 1",
                "2 step 6",
                "3 step 0",
                "3 step 24"
            ]
        );
        let frames = [
            (10.0, "initial stresses"),
            (10.0, "factor of safety"),
            (13.0, "run-out"),
        ];
        assert_eq!(
            steps("slope", &frames),
            ["1 step 10", "2 as it ends", "3 step 3"]
        );
    }
}
