//! Continuation: a body is followed along its path of equilibria, the load factor an unknown, by steps of work that
//! grow and shrink with the effort (theory, eqs. 33a and 33b; Sysala et al. 2023, arXiv 2312.12170).
//!
//! Near a limit the load factor changes little and the body moves much: steps of work go on where steps of the load
//! factor find no equilibrium.

use igimp_assembly::Method;

use crate::body::Body;
use crate::free_factor::Guess;
use crate::march::{Accepted, Driver, MarchState};
use crate::newton::{Target, step_on_path};
use crate::report::{MECHANISM, NodalForces, StepError, StepReport};
use crate::settings::NewtonSettings;
use crate::workspace::Workspace;

/// How a path is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContinuationSettings {
    /// First change of the load factor, as a share of it \[-\].
    pub first_change: f64,
    /// Changes of the load factor that begin a path, before steps of work: so many that do work, or fewer where one fails.
    pub direct_steps: usize,
    /// Most steps in all.
    pub most_steps: usize,
    /// How often a step may be halved in succession.
    pub halvings: u32,
    /// How often a step that was halved so often may then be doubled in succession, from the size that failed first: the next
    /// equilibrium lies on another branch.
    pub leaps: u32,
    /// Whether the largest factor of a path that falls is resolved: the path is followed again from the equilibrium before it, in
    /// short steps.
    pub resolves_peak: bool,
    /// The iteration of each step.
    pub newton: NewtonSettings,
}

impl ContinuationSettings {
    /// Settings with the iteration of each step.
    pub fn new(newton: NewtonSettings) -> Self {
        Self {
            first_change: 0.05,
            direct_steps: 2,
            most_steps: 200,
            halvings: 8,
            leaps: 4,
            resolves_peak: false,
            newton,
        }
    }
}

/// Where a continuation stands between two steps: with the body, all that it needs to go on.
#[derive(Clone, Debug, PartialEq)]
pub struct ContinuationState<const D: usize> {
    /// Load factor reached \[-\].
    pub factor: f64,
    /// Change of the load factor in the next step, while such steps are made, as a share of it \[-\].
    pub change: f64,
    /// Changes of the load factor that did work so far.
    pub working: usize,
    /// Whether steps are steps of work.
    pub is_by_work: bool,
    /// Steps so far.
    pub steps: usize,
    /// Gross work of the external force since the beginning \[force·length\].
    pub work: f64,
    /// Gross work of the next step \[force·length\].
    pub size: f64,
    /// The largest gross work of a step \[force·length\].
    pub most_size: f64,
    /// The last step that did work.
    pub last: Option<LastStep<D>>,
}

/// A step that did work.
#[derive(Clone, Debug, PartialEq)]
pub struct LastStep<const D: usize> {
    /// Nodal step displacements \[length\].
    pub u: Vec<[f64; D]>,
    /// Change of the load factor \[-\].
    pub change: f64,
    /// Gross work of the external force \[force·length\].
    pub work: f64,
    /// Share of that work that was not elastic \[-\].
    pub dissipated: f64,
}

impl<const D: usize> LastStep<D> {
    /// An accepted step, if it did work in soil that yields.
    pub fn of(step: &StepReport, forces: &NodalForces<D>) -> Option<Self> {
        does_work(step).then(|| Self::of_path(step, forces))
    }

    /// Whether it moved the body as a mechanism.
    fn is_mechanism(&self) -> bool {
        self.dissipated >= MECHANISM
    }

    /// An accepted step of a path.
    fn of_path(step: &StepReport, forces: &NodalForces<D>) -> Self {
        let work = step.gross_work;
        Self {
            u: forces.u.clone(),
            change: step.to - step.from,
            work,
            dissipated: (step.work.as_ref()).map_or(0.0, |report| report.dissipated_share(work)),
        }
    }
}

/// Whether a step did work in soil that yields.
fn does_work(step: &StepReport) -> bool {
    let of_stress = step.work.as_ref().map_or(0.0, |work| work.whole);
    step.external_work > 0.0 && of_stress > 0.0 && step.plastic_share > 0.0
}

impl<const D: usize> ContinuationState<D> {
    /// The beginning of a path at a load factor, after a step that came there.
    pub fn start(factor: f64, last: Option<LastStep<D>>, settings: &ContinuationSettings) -> Self {
        Self {
            factor,
            change: settings.first_change,
            working: 0,
            is_by_work: false,
            steps: 0,
            work: 0.0,
            size: last.as_ref().map_or(0.0, |last| last.work),
            most_size: f64::INFINITY,
            last,
        }
    }

    /// The target of the next step.
    fn target(&self, settings: &ContinuationSettings) -> Target<D> {
        match &self.last {
            Some(last) if self.is_by_work => {
                let by = self.size / last.work;
                let most = settings.first_change * self.factor.abs();
                let u = last.u.iter().map(|u| u.map(|u| by * u)).collect();
                Target::Work {
                    work: self.size,
                    guess: Guess {
                        u,
                        factor: self.factor + (by * last.change).clamp(-most, most),
                        is_mechanism: last.is_mechanism(),
                    },
                }
            }
            last => Target::Factor {
                to: self.factor * (1.0 + self.change),
                is_resolved: self.change > RESOLVED
                    && !last.as_ref().is_some_and(LastStep::is_mechanism),
            },
        }
    }

    /// Takes an accepted step in.
    fn take(
        &mut self,
        (step, forces): (&StepReport, &NodalForces<D>),
        target: &Target<D>,
        settings: &ContinuationSettings,
    ) {
        let work = step.gross_work;
        self.steps += 1;
        self.work += work;
        self.factor = step.to;
        match target {
            Target::Work { .. } => {
                self.size = (work * growth(step.iterations)).min(self.most_size);
            }
            Target::Factor { .. } if !does_work(step) => {
                self.change = (2.0 * self.change).min(LARGEST_CHANGE);
                return;
            }
            Target::Factor { .. } => {
                self.size = work;
                self.working += 1;
                self.is_by_work = self.working >= settings.direct_steps;
                let grown = self.change * growth(step.iterations);
                self.change = grown.min(settings.first_change);
            }
        }
        self.last = Some(LastStep::of_path(step, forces));
    }

    /// The next step after so many failures in succession, the first of them with `first` \[force·length\]: half of the one that
    /// failed, or where that was done often enough twice the first, and twice that.
    fn retry(&mut self, failures: u32, first: f64, settings: &ContinuationSettings) {
        self.change *= 0.5;
        self.size = match failures.checked_sub(settings.halvings) {
            None | Some(0) => 0.5 * self.size,
            Some(leaps) => first * 2.0_f64.powi(leaps as i32),
        };
        // A limit that is nearer than the first change is approached by steps of work at once.
        self.is_by_work |= self.last.is_some();
    }

    /// How often the next step may fail in succession.
    fn most_failures(&self, settings: &ContinuationSettings) -> u32 {
        let leaps = if self.last.is_some() {
            settings.leaps
        } else {
            0
        };
        settings.halvings + leaps
    }
}

/// Change of the load factor, as a share of it, by which a path may come to its mechanism at once \[-\]: a larger one hides
/// where the mechanism begins, and the factor of safety goes by that.
const RESOLVED: f64 = 1e-3;

/// Largest change of the load factor where nothing yields, as a share of it \[-\].
const LARGEST_CHANGE: f64 = 0.4;

/// Work of the next step over that of one that took so many corrections \[-\].
fn growth(corrections: usize) -> f64 {
    match corrections {
        0..=6 => 2.0,
        7..=10 => 1.5,
        11..=15 => 1.0,
        _ => 0.7,
    }
}

/// Failures in succession from which on a step is given more corrections, and how many times as many.
const PATIENCE: (u32, usize) = (3, 3);

/// The iteration of a step that failed so often: where no step is too small to fail, the next equilibrium lies on
/// another branch, and Newton's method finds it late.
fn patient(newton: NewtonSettings, failures: u32) -> NewtonSettings {
    let (from, times) = PATIENCE;
    NewtonSettings {
        max_iterations: newton.max_iterations * if failures < from { 1 } else { times },
        ..newton
    }
}

/// A factor that lies this share below the largest one has fallen \[-\].
const FALLEN: f64 = 1e-3;

/// Steps between the equilibria beside the largest factor, where it is resolved.
const STEPS_OF_PEAK: f64 = 16.0;

/// The largest factor of a path so far, and the data to follow the path there once more.
struct Peak<const D: usize> {
    largest: f64,
    /// The equilibrium before the last step.
    last: (ContinuationState<D>, Body<D>),
    /// That before the step to the largest factor; none where that was the first step that did work, and once it was resolved.
    before: Option<(ContinuationState<D>, Body<D>)>,
    is_resolved: bool,
}

impl<const D: usize> Peak<D> {
    fn of(state: &ContinuationState<D>, body: &Body<D>) -> Self {
        Self {
            largest: f64::NEG_INFINITY,
            last: (state.clone(), body.clone()),
            before: None,
            is_resolved: false,
        }
    }

    /// Takes a step to a state in: the equilibrium before the largest factor, to follow the path from there in short steps, where the
    /// factor has fallen for the first time. One that has fallen again grows its steps again.
    fn after(
        &mut self,
        state: &mut ContinuationState<D>,
        body: &Body<D>,
    ) -> Option<(ContinuationState<D>, Body<D>)> {
        let before = std::mem::replace(&mut self.last, (state.clone(), body.clone()));
        if state.factor > self.largest {
            self.largest = state.factor;
            let does_work = !self.is_resolved && before.0.last.is_some();
            self.before = does_work.then_some(before);
            return None;
        }
        if state.factor > (1.0 - FALLEN) * self.largest {
            return None;
        }
        state.most_size = f64::INFINITY;
        let (mut from, body) = self.before.take()?;
        from.size = (state.work - from.work) / STEPS_OF_PEAK;
        from.most_size = from.size;
        from.is_by_work = true;
        self.is_resolved = true;
        self.largest = from.factor;
        self.last = (from.clone(), body.clone());
        Some((from, body))
    }
}

/// Follows a body along its path from a state, until the driver ends it; the failure of the last step where no step
/// was found, however small.
///
/// The driver sees each accepted step with the [`ContinuationState`] after it. A failed step leaves the body at its last
/// equilibrium.
pub fn follow<const D: usize>(
    state: &mut ContinuationState<D>,
    body: &mut Body<D>,
    method: &Method,
    settings: &ContinuationSettings,
    workspace: &mut Workspace<D>,
    driver: &mut dyn Driver<D>,
) -> Option<StepError> {
    let mut failures = 0;
    let mut first = state.size;
    let mut peak = (settings.resolves_peak).then(|| Peak::of(state, body));
    while state.steps < settings.most_steps {
        let target = state.target(settings);
        let on_path = (state.factor, &target);
        let newton = patient(settings.newton, failures);
        match step_on_path(body, method, &*driver, on_path, &newton, workspace) {
            Ok((conditions, report, forces)) => {
                failures = 0;
                state.take((&report, &forces), &target, settings);
                if let Some((from, before)) = peak.as_mut().and_then(|peak| peak.after(state, body))
                {
                    driver.on_return(&before, state.steps - 1 - from.steps);
                    (*state, *body) = (from, before);
                    continue;
                }
                let march = MarchState {
                    at: state.factor,
                    size: state.size,
                    successes: 0,
                };
                let accepted = Accepted {
                    body,
                    conditions: &conditions,
                    report: &report,
                    forces: &forces,
                    state: &march,
                };
                if driver.on_step(&accepted).is_break() {
                    return None;
                }
            }
            Err(error) => {
                driver.on_cut(&error);
                if failures == 0 {
                    first = state.size;
                }
                failures += 1;
                let is_given_up = failures > state.most_failures(settings);
                if is_given_up || !error.failure.is_want_of_equilibrium() {
                    return Some(error);
                }
                state.retry(failures, first, settings);
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: a step that fails is halved until it is small, and then tried larger than at first.
    /// ORACLE: by hand.
    #[test]
    fn failed_steps_are_halved_and_then_leap() {
        let settings = ContinuationSettings {
            halvings: 2,
            leaps: 2,
            ..ContinuationSettings::new(NewtonSettings::default())
        };
        let mut state: ContinuationState<2> = ContinuationState::start(1.0, None, &settings);
        assert_eq!(state.most_failures(&settings), 2);
        state.size = 8.0;
        state.last = Some(LastStep {
            u: Vec::new(),
            change: 0.1,
            work: 8.0,
            dissipated: 0.5,
        });
        let sizes = [1, 2, 3, 4].map(|failures| {
            state.retry(failures, 8.0, &settings);
            state.size
        });
        assert_eq!(
            sizes.map(f64::to_bits),
            [4.0_f64, 2.0, 16.0, 32.0].map(f64::to_bits)
        );
        assert_eq!(state.most_failures(&settings), 4);
        assert!(state.is_by_work);
    }
}
