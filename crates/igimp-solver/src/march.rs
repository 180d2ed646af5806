//! Load marching: from load factor 0 to 1 in steps that are cut when no equilibrium is found and
//! grow again after success. The only place that cuts a step.

use std::ops::ControlFlow;

use igimp_assembly::{AssemblyError, Method, StepConditions};

use crate::LoadPath;
use crate::body::Body;
use crate::newton::{Stretch, step_of_march};
use crate::report::{NodalForces, PhaseTimes, StepError, StepFailure, StepReport};
use crate::settings::NewtonSettings;
use crate::workspace::Workspace;

/// Successes in a row after which a cut step grows again.
const SUCCESSES_TO_GROW: usize = 2;

impl<const D: usize, F> LoadPath<D> for F
where
    F: Fn(f64, f64) -> Result<StepConditions<D>, AssemblyError>,
{
    fn conditions(&self, from: f64, to: f64) -> Result<StepConditions<D>, AssemblyError> {
        self(from, to)
    }
}

/// The view of an observer after each accepted step.
#[derive(Clone, Copy, Debug)]
pub struct Accepted<'a, const D: usize> {
    /// The body in its new state.
    pub body: &'a Body<D>,
    /// The conditions of the step.
    pub conditions: &'a StepConditions<D>,
    /// How the step went.
    pub report: &'a StepReport,
    /// Reactions and step displacements.
    pub forces: &'a NodalForces<D>,
    /// Where the march stands: with the body, all that [`march_from`] needs to go on.
    pub state: &'a MarchState,
}

/// Where a march stands between two steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarchState {
    /// Load factor reached \[-\].
    pub at: f64,
    /// Size of the next step, in load factor \[-\].
    pub size: f64,
    /// Accepted steps in a row since the last cut or growth.
    pub successes: usize,
}

impl MarchState {
    /// The beginning of a march.
    pub fn start(settings: &MarchSettings) -> Self {
        Self {
            at: 0.0,
            size: settings.pace.map_or(settings.nominal(), |pace| pace.first),
            successes: 0,
        }
    }
}

/// Watches a march, and may end it. Closures are observers.
pub trait Observer<const D: usize> {
    /// Called after each accepted step; `Break` ends the march there.
    fn on_step(&mut self, accepted: &Accepted<'_, D>) -> ControlFlow<()>;

    /// Called when a step was not accepted, before it is cut or given up.
    fn on_cut(&mut self, _error: &StepError) {}

    /// Called when a path is followed again from a body that lies so many steps back, to resolve its largest factor.
    fn on_return(&mut self, _body: &Body<D>, _steps: usize) {}
}

impl<const D: usize, F> Observer<D> for F
where
    F: FnMut(&Accepted<'_, D>) -> ControlFlow<()>,
{
    fn on_step(&mut self, accepted: &Accepted<'_, D>) -> ControlFlow<()> {
        self(accepted)
    }
}

/// A load path whose conditions go by what its accepted steps did: it observes the march along it.
pub trait Driver<const D: usize>: LoadPath<D> + Observer<D> {}

impl<const D: usize, T: LoadPath<D> + Observer<D>> Driver<D> for T {}

/// A load path of its load factor alone, with an observer beside it.
pub struct Observed<'a, const D: usize> {
    /// The load path.
    pub load_path: &'a dyn LoadPath<D>,
    /// The observer.
    pub observer: &'a mut dyn Observer<D>,
}

impl<const D: usize> LoadPath<D> for Observed<'_, D> {
    fn conditions(&self, from: f64, to: f64) -> Result<StepConditions<D>, AssemblyError> {
        self.load_path.conditions(from, to)
    }

    fn longest_step(&self, at: f64) -> f64 {
        self.load_path.longest_step(at)
    }
}

impl<const D: usize> Observer<D> for Observed<'_, D> {
    fn on_step(&mut self, accepted: &Accepted<'_, D>) -> ControlFlow<()> {
        self.observer.on_step(accepted)
    }

    fn on_cut(&mut self, error: &StepError) {
        self.observer.on_cut(error);
    }

    fn on_return(&mut self, body: &Body<D>, steps: usize) {
        self.observer.on_return(body, steps);
    }
}

/// Sizes of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarchSettings {
    /// Number of steps from load factor 0 to 1 when none is cut.
    pub steps: usize,
    /// How often a step may be cut in succession.
    pub cuts: u32,
    /// Factor on the size of a cut step \[-\].
    pub cut_factor: f64,
    /// Factor on the step size after two successes, up to the size first asked for \[-\].
    pub growth: f64,
    /// How steps that take time are chosen; none where their size is that of [`Self::steps`].
    pub pace: Option<Pace>,
    /// Whether a step is refused in which the body moves as a mechanism, so that it ends before one: a path of equilibria goes on.
    pub is_short_of_mechanism: bool,
    /// Whether a step that finds no equilibrium is tried once more with guarded corrections (theory, eq. 25e), before it is cut: for soil
    /// that flows.
    pub guards_again: bool,
    /// The iteration of each step.
    pub newton: NewtonSettings,
}

/// How the durations of steps are chosen: by the error of the scheme and by how far the body moves. Steps land on the
/// multiples of 1 over [`MarchSettings::steps`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// The first step, in load factor \[-\].
    pub first: f64,
    /// The longest step, in load factor \[-\].
    pub longest: f64,
}

impl MarchSettings {
    /// Equal steps with the default cutting: halved up to five times, grown by 1.5.
    pub fn steps(steps: usize) -> Self {
        Self {
            steps,
            cuts: 5,
            cut_factor: 0.5,
            growth: 1.5,
            pace: None,
            is_short_of_mechanism: false,
            guards_again: false,
            newton: NewtonSettings::default(),
        }
    }

    /// Size of a step that is not cut.
    fn nominal(&self) -> f64 {
        1.0 / self.steps.max(1) as f64
    }
}

/// How a march ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Load factor 1 was reached.
    Completed,
    /// The observer ended the march.
    Stopped {
        /// Load factor reached \[-\].
        at: f64,
    },
    /// No equilibrium was found, however small the step.
    StepTooSmall {
        /// Load factor of the last equilibrium \[-\].
        last_converged: f64,
        /// The smallest step that failed, and why.
        cause: StepError,
    },
}

/// A march from load factor 0.
#[derive(Clone, Debug, PartialEq)]
pub struct MarchReport {
    /// How it ended.
    pub outcome: Outcome,
    /// Accepted steps in order.
    pub steps: Vec<StepReport>,
    /// Steps that were tried and not accepted, in order.
    pub failures: Vec<StepError>,
}

impl MarchReport {
    /// Load factor of the last equilibrium \[-\].
    pub fn reached(&self) -> f64 {
        self.steps.last().map_or(0.0, |step| step.to)
    }

    /// Number of corrections in accepted steps.
    pub fn iterations(&self) -> usize {
        self.steps.iter().map(|step| step.iterations).sum()
    }

    /// Time spent in accepted steps.
    pub fn times(&self) -> PhaseTimes {
        let mut times = PhaseTimes::default();
        for step in &self.steps {
            times.add(&step.times);
        }
        times
    }
}

/// Marches a body from load factor 0 to 1.
///
/// A failed step leaves the body at its last equilibrium; the reason why a march stopped is part
/// of the report.
pub fn march<const D: usize>(
    body: &mut Body<D>,
    method: &Method,
    load_path: &dyn LoadPath<D>,
    settings: &MarchSettings,
    workspace: &mut Workspace<D>,
    observer: &mut dyn Observer<D>,
) -> MarchReport {
    let start = MarchState::start(settings);
    let mut driver = Observed {
        load_path,
        observer,
    };
    march_from(start, body, method, settings, workspace, &mut driver)
}

/// Goes on with a march that was left at `state`, with the body as it was then: the steps that
/// follow are the same to the bit. The report tells of these steps only.
pub fn march_from<const D: usize>(
    mut state: MarchState,
    body: &mut Body<D>,
    method: &Method,
    settings: &MarchSettings,
    workspace: &mut Workspace<D>,
    driver: &mut dyn Driver<D>,
) -> MarchReport {
    let mut report = MarchReport {
        outcome: Outcome::Completed,
        steps: Vec::new(),
        failures: Vec::new(),
    };
    let mut stride = Stride::new(settings, &state);
    while state.at < 1.0 {
        let at = state.at;
        stride.bound(&mut state, driver.longest_step(at));
        let to = stride.next(at, state.size);
        let result = conditions_at(driver, at, to).and_then(|conditions| {
            let stretch = Stretch {
                from: at,
                to,
                is_short_of_mechanism: settings.is_short_of_mechanism,
                guards_again: settings.guards_again,
            };
            let newton = &settings.newton;
            step_of_march(body, method, &conditions, stretch, newton, workspace)
                .map(|(step, forces)| (conditions, step, forces))
        });
        match result {
            Ok((conditions, step, forces)) => {
                stride.accept(&mut state, to, step.pace);
                let accepted = Accepted {
                    body,
                    conditions: &conditions,
                    report: &step,
                    forces: &forces,
                    state: &state,
                };
                let flow = driver.on_step(&accepted);
                report.steps.push(step);
                if flow.is_break() {
                    report.outcome = Outcome::Stopped { at: to };
                    return report;
                }
            }
            Err(error) => {
                driver.on_cut(&error);
                report.failures.push(error.clone());
                let share = error.failure.share_of_next();
                if !stride.cut(&mut state, to, share) || error.failure.leaves_grid() {
                    report.outcome = Outcome::StepTooSmall {
                        last_converged: at,
                        cause: error,
                    };
                    return report;
                }
            }
        }
    }
    report
}

/// The sizes of the steps of a march.
struct Stride<'a> {
    settings: &'a MarchSettings,
    nominal: f64,
    /// The smallest size over that of a step that is not cut \[-\].
    least: f64,
    smallest: f64,
    /// Cuts in succession.
    cuts: u32,
}

impl<'a> Stride<'a> {
    fn new(settings: &'a MarchSettings, state: &MarchState) -> Self {
        let nominal = settings.nominal();
        let least = settings.cut_factor.powf(f64::from(settings.cuts) + 0.5);
        Self {
            settings,
            nominal,
            least,
            // Where steps are chosen, the smallest goes by the one that is tried first.
            smallest: least * settings.pace.map_or(nominal, |_| state.size),
            cuts: 0,
        }
    }

    /// Holds a step that is chosen to a longest size.
    fn bound(&mut self, state: &mut MarchState, longest: f64) {
        if self.settings.pace.is_some() && longest < state.size {
            state.size = longest;
            self.smallest = self.least * longest;
        }
    }

    /// The load factor after a step of a size.
    fn next(&self, at: f64, size: f64) -> f64 {
        match self.settings.pace {
            None => next_factor(at, size, self.nominal),
            Some(_) => next_landing(at, size, self.nominal),
        }
    }

    /// A step to a load factor was accepted; it would have one follow that is `factor` times as long.
    fn accept(&mut self, state: &mut MarchState, to: f64, factor: f64) {
        let taken = to - state.at;
        state.at = to;
        state.successes += 1;
        self.cuts = 0;
        if let Some(pace) = &self.settings.pace {
            state.size = pace.next(state.size, taken, factor);
            self.smallest = self.least * state.size;
        } else if state.successes >= SUCCESSES_TO_GROW && state.size < self.nominal {
            state.size = (state.size * self.settings.growth).min(self.nominal);
            state.successes = 0;
        }
    }

    /// A step to a load factor failed: the next one is shorter, by a `share` where the failure tells it; whether there is one.
    fn cut(&mut self, state: &mut MarchState, to: f64, share: Option<f64>) -> bool {
        // The last step may have been shorter than its size, so as to end on 1.
        let tried = if self.settings.pace.is_some() {
            to - state.at
        } else {
            1.0 - state.at
        };
        let cut_factor = self.settings.cut_factor;
        let share = share.map_or(cut_factor, |share| share.min(cut_factor));
        state.size = share * state.size.min(tried);
        if share < cut_factor {
            // The resolution of a step is known: it is no sign of want of equilibrium.
            self.smallest = self.smallest.min(self.least * state.size);
        }
        state.successes = 0;
        self.cuts += 1;
        let next = self.next(state.at, state.size);
        let is_a_cut = state.at < next && next < to;
        self.cuts <= self.settings.cuts && state.size >= self.smallest && is_a_cut
    }
}

impl Pace {
    /// The size of the step after one of `size` that took `taken` of it and would have a `factor` times as long one follow: a
    /// step that was shortened to land says little of a longer one.
    fn next(&self, size: f64, taken: f64, factor: f64) -> f64 {
        let from = if factor < 1.0 { taken } else { size };
        (factor * from).min(self.longest)
    }
}

/// The load factor after a step that lands on multiples of the nominal size: what is left before the next of them is divided
/// into equal steps of at most this size.
fn next_landing(at: f64, size: f64, nominal: f64) -> f64 {
    let done = (at / nominal * (1.0 + 4.0 * f64::EPSILON)).floor();
    let landing = (nominal * (done + 1.0)).min(1.0);
    let landing = if 1.0 - landing < 1e-9 * nominal {
        1.0
    } else {
        landing
    };
    let left = ((landing - at) / (size * (1.0 + 1e-9))).ceil().max(1.0);
    if left < 2.0 {
        landing
    } else {
        at + (landing - at) / left
    }
}

/// The load factor after a step: uncut steps land on multiples of the nominal size, and no sliver
/// is left before 1. The step itself decides which distance is near: one that was cut often must
/// not end where it began.
fn next_factor(at: f64, size: f64, nominal: f64) -> f64 {
    let to = at + size;
    let nearest = (to / nominal).round() * nominal;
    let near = 1e-6 * size;
    if to > 1.0 - near {
        1.0
    } else if (to - nearest).abs() < near {
        nearest
    } else {
        to
    }
}

fn conditions_at<const D: usize>(
    load_path: &dyn LoadPath<D>,
    from: f64,
    to: f64,
) -> Result<StepConditions<D>, StepError> {
    load_path.conditions(from, to).map_err(|source| StepError {
        from,
        to,
        residuals: Vec::new(),
        worst: None,
        failure: Box::new(StepFailure::Assembly(source)),
    })
}

#[cfg(test)]
mod tests {
    use super::{next_factor, next_landing};

    // GOAL: steps of time land on every part of their duration, each is beyond its start, and none is longer than asked for.
    // CASE: parts of all numbers up to 200, steps of a third and of a millionth of a part.
    // ORACLE: the multiples of a part, and one half more steps at most.
    #[test]
    fn steps_of_time_land_on_every_part() {
        for parts in 1..=200_u32 {
            let nominal = 1.0 / f64::from(parts);
            for size in [0.3 * nominal, 0.7 * nominal, 5.0 * nominal] {
                let (mut at, mut landed, mut steps) = (0.0, 0, 0);
                while at < 1.0 {
                    let to = next_landing(at, size, nominal);
                    assert!(
                        to > at && to - at <= size * (1.0 + 1e-6),
                        "{parts} {at} {to}"
                    );
                    steps += 1;
                    let part = to / nominal;
                    landed += u32::from((part - part.round()).abs() < 1e-9);
                    at = to;
                }
                assert_eq!(landed, parts, "{parts} {size}");
                assert!(f64::from(steps) < 1.5 * (1.0 / size + f64::from(parts)));
            }
        }
        let to = next_landing(0.5, 1e-7, 0.1);
        assert!(to > 0.5 && to < 0.5 + 1.1e-7);
    }

    // GOAL: a step that was cut however often ends beyond where it began, and not on the multiple of the first size that it
    // stands at.
    // CASE: steps of a millionth of the first size and less, at such multiples and beside them.
    // ORACLE: the sum of place and size; whole steps end on multiples, and the last one on 1.
    #[test]
    fn a_step_that_was_cut_often_ends_beyond_its_start() {
        let nominal = 0.1;
        for at in [0.0, 0.1, 0.300_000_000_000_000_04, 0.35] {
            for size in [1e-7, 1e-8, 1e-10] {
                let to = next_factor(at, size, nominal);
                assert!(((to - at) / size - 1.0).abs() < 1e-4, "{at} {size:e}: {to}");
            }
        }
        assert_eq!(
            next_factor(0.2, nominal, nominal).to_bits(),
            0.300_000_000_000_000_04_f64.to_bits()
        );
        assert_eq!(
            next_factor(1.0 - 1e-9, 1e-9, nominal).to_bits(),
            1.0_f64.to_bits()
        );
    }
}
