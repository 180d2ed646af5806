//! When a frame of a film is due: where soil has moved far enough since the last one.
//!
//! A stage does not know how far its soil will move. By the pace so far, the way of the whole stage is the way up to now over the
//! share of the stage that is done. A frame is due after a part of that way: frames of a steady motion lie at equal distances,
//! and those of soil that begins to slide follow the slide. Spacings double where frames become many, so that a stage has
//! some tens at most. Where a frame is due follows from the steps alone: a resumed run has the frames of one that was not stopped.

use igimp_model::{Every, Stage, StageKind};
use igimp_solver::StepReport;
use serde::{Deserialize, Serialize};

/// Most frames of a film along a stage, beside that of its end.
pub const MOST: usize = 40;

/// Frames of a steady motion in very many steps, and those after which spacings double once more.
const STEADY: usize = 24;
const UNTIL_DOUBLED: usize = 4;

/// Share of a stage after which a frame is due however little has moved \[-\]: water may flow in soil at rest.
const AT_LATEST: f64 = 0.1;

/// Particles of which a whole film is kept: some 20 MB a frame. Of twice as many every second frame is.
const ROOMY: usize = 60_000;

/// Round-off of sums and shares \[-\].
const ROUND_OFF: f64 = 1e-6;

/// An accepted step.
#[derive(Clone, Copy, Debug)]
pub struct Step<'a, const D: usize> {
    /// Its number within the stage, from 1.
    pub number: usize,
    /// Particles of the body.
    pub particles: usize,
    /// How it went.
    pub report: &'a StepReport,
    /// Step displacement of the nodes of the grid \[m\].
    pub u: &'a [[f64; D]],
}

impl<const D: usize> Step<'_, D> {
    /// The root of the mean square of the displacement \[m\]; the largest one may be that of a node that hardly touches soil.
    fn moved(&self) -> f64 {
        let squares = self.u.iter().flatten().map(|u| u * u);
        (squares.sum::<f64>() / self.u.len() as f64).sqrt()
    }
}

/// The film of a stage so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Film {
    /// The way of the soil: the motions of the steps, added \[m\].
    way: f64,
    /// The same at the last frame \[m\].
    way_of_frame: f64,
    /// The share of the stage that was done at the last frame \[-\].
    share_of_frame: f64,
    /// Frames so far.
    frames: usize,
}

impl Film {
    /// Whether a step of a stage has a frame. Of stages that take time those steps are counted that land on a part of the duration.
    pub fn has_frame<const D: usize>(
        &mut self,
        every: Every,
        stage: &Stage,
        step: &Step<'_, D>,
    ) -> bool {
        let (report, is_motion) = (step.report, step.report.energy.is_some());
        let part = report.to * stage.steps as f64;
        let counted = if is_motion {
            let lands = (part - part.round()).abs() < ROUND_OFF;
            lands.then_some(part.round() as usize)
        } else {
            Some(step.number)
        };
        let is_every = |every: usize| counted.is_some_and(|n| n.is_multiple_of(every.max(1)));
        match every {
            Every::Never | Every::Stage => false,
            Every::Steps(every) => is_every(every),
            Every::Film if is_motion => {
                is_every(stage.steps.div_ceil(MOST) * one_in(step.particles))
            }
            Every::Film => {
                if step.number <= 1 {
                    *self = Self::default();
                }
                let share = match stage.kind {
                    StageKind::RunOut(_) => 1.0,
                    _ => report.to,
                };
                // The end of the stage has a frame anyway.
                self.is_due(step.moved(), share, one_in(step.particles))
                    && report.to < 1.0 - ROUND_OFF
            }
        }
    }

    /// Whether a frame is due after a step that moved the soil by some way \[m\], with a share of the stage done \[-\]; that is 1 all
    /// along a stage that ends when soil rests. One frame in so many is kept.
    fn is_due(&mut self, moved: f64, share: f64, one_in: usize) -> bool {
        self.way += moved;
        let doubled = (self.frames + UNTIL_DOUBLED).saturating_sub(STEADY) / UNTIL_DOUBLED;
        let thinned = one_in as f64;
        let spacing = (thinned * f64::from(1 << doubled) / STEADY as f64).min(0.5);
        let whole = self.way / share.max(ROUND_OFF);
        let since = self.way - self.way_of_frame;
        let has_moved = since > 0.0 && since >= spacing * whole * (1.0 - ROUND_OFF);
        let is_late = share - self.share_of_frame >= (thinned * AT_LATEST).min(0.5) - ROUND_OFF;
        let is_due = self.frames < MOST.div_ceil(one_in).max(2) && (has_moved || is_late);
        if is_due {
            self.way_of_frame = self.way;
            self.share_of_frame = share;
            self.frames += 1;
        }
        is_due
    }
}

/// One frame in so many is kept of so many particles.
pub fn one_in(particles: usize) -> usize {
    particles.div_ceil(ROOMY).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The steps that have a frame, from 1, of a motion by its steps: the way of each, and the share that is done.
    fn frames(steps: impl IntoIterator<Item = (f64, f64)>) -> Vec<usize> {
        let mut film = Film::default();
        let all = steps.into_iter().enumerate();
        let due = all.filter(|(_, (moved, share))| film.is_due(*moved, *share, 1));
        due.map(|(k, _)| k + 1).collect()
    }

    /// GOAL: frames of a steady motion lie at equal distances, whatever its size, and are some tens at most.
    /// ORACLE: by hand: the fewest steps that make a twenty-fourth of the stage.
    #[test]
    fn a_steady_motion_has_frames_at_equal_distances() {
        for (steps, every) in [(1, 1), (10, 1), (24, 1), (40, 2), (100, 5), (1000, 42)] {
            for size in [1e-9, 1.0, 1e6] {
                let steady = (1..=steps).map(|k| (size, f64::from(k) / f64::from(steps)));
                let expected: Vec<usize> =
                    (1..=steps as usize).filter(|k| k % every == 0).collect();
                assert_eq!(frames(steady), expected, "{steps} steps of {size}");
            }
        }
    }

    /// GOAL: soil that slides has frames where it slides, also where the share of the stage stands nearly still.
    /// CASE: nine tenths of a load in nine steps, then a slide ten thousand times as far in cut steps, each longer than the one before.
    #[test]
    fn a_slide_has_frames_where_soil_slides() {
        let slide = (0..100).map(|k| (1.1_f64.powi(k), 0.9 + 1e-4 * f64::from(k)));
        let steady = (1..=9).map(|k| (0.5, 0.1 * f64::from(k)));
        let due = frames(steady.chain(slide));
        assert_eq!(due[..9], [1, 2, 3, 4, 5, 6, 7, 8, 9]);
        assert!((20..=MOST).contains(&due.len()), "{due:?}");
        assert!(due.last() > Some(&80), "{due:?}");
    }

    /// GOAL: the bound holds for every motion, and soil at rest has frames too. CASE: each step moves three times as far as all before; none moves.
    #[test]
    fn frames_are_bounded() {
        let growing = (0..500).map(|k| (4.0_f64.powi(k), 1.0));
        assert_eq!(frames(growing), (1..=MOST).collect::<Vec<_>>());
        let at_rest = (1..=100).map(|k| (0.0, 0.01 * f64::from(k)));
        assert_eq!(
            frames(at_rest),
            (1..=10).map(|k| 10 * k).collect::<Vec<_>>()
        );
        assert_eq!(frames([(0.0, 1.0); 9]), [1]);
    }

    /// GOAL: frames of many particles are fewer, and two at least. ORACLE: by hand: 24 of a steady motion, over one in so many.
    #[test]
    fn large_bodies_have_fewer_frames() {
        for (particles, expected) in [(60_000, 24), (100_000, 12), (170_000, 8), (3_000_000, 2)] {
            let mut film = Film::default();
            let one_in = one_in(particles);
            let steps = (1..=240).map(|k| f64::from(k) / 240.0);
            let due = steps.filter(|share| film.is_due(1.0, *share, one_in));
            assert_eq!(due.count(), expected, "{particles}");
        }
    }

    /// GOAL: a resumed run has the frames of one that was not stopped.
    #[test]
    fn a_film_goes_on_from_its_checkpoint() {
        let steps: Vec<(f64, f64)> = (1..=60)
            .map(|k| (f64::from(k % 7) / 3.0, f64::from(k) / 60.0))
            .collect();
        let mut film = Film::default();
        for (k, &(moved, share)) in steps.iter().enumerate() {
            let text = serde_json::to_string(&film).unwrap();
            let mut resumed: Film = serde_json::from_str(&text).unwrap();
            let due = film.is_due(moved, share, 1);
            assert_eq!(resumed.is_due(moved, share, 1), due, "step {}", k + 1);
            assert_eq!(resumed, film);
        }
    }
}
