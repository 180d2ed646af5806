//! Flow in time: steps of two stages, as long as their error allows, that land on the times asked for (theory, eqs. 85a to 85d).

use std::f64::consts::FRAC_1_SQRT_2;

use igimp_shape::Grid;

use crate::boundary::{At, held};
use crate::conditions::{Conditions, FreeWater, OnFaces};
use crate::curve::Relative;
use crate::error::SeepageError;
use crate::field::Seepage;
use crate::ground::SeepageBody;
use crate::search::{Balanced, Search, TOLERANCE, relative_of};
use crate::storage::{Storage, Storing};

/// Share of a step that one of its stages lasts \[-\].
const STAGE: f64 = 1.0 - FRAC_1_SQRT_2;
/// Error of a step of first order that is allowed, in the mean of the ground over the span of the heads \[-\].
const ACCURACY: f64 = 2e-3;
/// Water that a node may lack, over all that drains from it \[-\]: round-off.
const EMPTY: f64 = 1e-9;
/// Share of the first stretch of time that is tried first \[-\].
const FIRST: f64 = 1e-3;
/// Share of a stretch of time below which a step is not cut for its error: faster changes count as sudden \[-\].
const SUDDEN: f64 = 1e-5;
/// The same for a step that finds no balance \[-\].
const SHORTEST: f64 = 1e-9;
/// Share of a stretch of time down to which its last step is halved where a node of it would owe water \[-\].
const OWING: f64 = 1e-3;
/// Least and largest change from step to step \[-\].
const CHANGES: [f64; 2] = [0.1, 4.0];
/// Steps aim at this share of the allowed error \[-\].
const SAFETY: f64 = 0.9;

/// A value in time on the faces of a condition, linear between its samples and constant beyond.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    /// Times \[s\], ascending.
    pub times: Vec<f64>,
    /// Heads \[m\], or rain by area in plan \[m/s\].
    pub values: Vec<f64>,
}

impl History {
    /// The value at a time.
    pub fn at(&self, time: f64) -> f64 {
        let after = self.times.partition_point(|t| *t <= time);
        let sample = |k: usize| Some((*self.times.get(k)?, *self.values.get(k)?));
        match (after.checked_sub(1).and_then(sample), sample(after)) {
            (Some((from, a)), Some((to, b))) => a + (b - a) * (time - from) / (to - from),
            (Some((_, only)), None) | (None, Some((_, only))) => only,
            (None, None) => f64::NAN,
        }
    }
}

/// The course of a flow in time beside its conditions.
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    /// By condition on faces: its head or its rain in time; none: it stays.
    pub histories: Vec<Option<History>>,
    /// Times whose states are wanted \[s\], ascending, after 0.
    pub times: Vec<f64>,
}

/// The balance of water after a step: volumes since the start \[m³\], in the plane by the metre run \[m²\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WaterBalance {
    /// Time \[s\].
    pub time: f64,
    /// Water that entered.
    pub entered: f64,
    /// Water that left.
    pub left: f64,
    /// Water that the ground holds beyond that at the start.
    pub stored: f64,
    /// Imbalance of the three, over all that moved \[-\].
    pub error: f64,
}

/// A flow in time.
#[derive(Clone, Debug)]
pub struct Transient<const D: usize> {
    /// The states at the times asked for.
    pub states: Vec<Seepage<D>>,
    /// The balance at the start and after each step.
    pub balance: Vec<WaterBalance>,
    /// Steps that were taken back, as their error was too large or no balance was found.
    pub cuts: usize,
}

/// Follows a flow in time from a steady one in the same ground.
///
/// # Errors
/// [`SeepageError`]: as for a steady flow; a start in other ground; soil that stores no water; no balance however short a step.
pub fn march<const D: usize>(
    grid: &Grid<D>,
    bodies: &[SeepageBody<'_, D>],
    (start, conditions): (&Seepage<D>, &Conditions<D>),
    free: FreeWater<'_, D>,
    course: &Course,
) -> Result<Transient<D>, SeepageError> {
    check_times(course)?;
    let mut search = Search::of(grid, bodies, conditions, free)?;
    let is_there = |&node: &usize| start.is_ground.get(node) == Some(&true);
    let nodes = &search.system.nodes;
    let count = start.is_ground.iter().filter(|there| **there).count();
    if nodes.len() != count || !nodes.iter().all(is_there) {
        return Err(SeepageError::OtherGround);
    }
    search.heads = nodes.iter().map(|&node| start.heads[node]).collect();
    let storage = Storage::of(&search.system);
    for soil in storage.soils() {
        check_soil(soil, conditions)?;
    }
    let relative = relative_of(grid, conditions);
    let water = storage.water(&search.system, &search.heads, &relative)[0].clone();
    let mut march = March {
        span: span(&search, course, relative.width),
        volumes: storage.volumes(|_| 1.0),
        drainable: storage.volumes(|soil| conditions.soils[soil].drainable),
        search,
        storage,
        relative,
        free,
        course,
        time: 0.0,
        water,
        moved: 0.0,
        found: Transient {
            states: Vec::new(),
            balance: vec![WaterBalance::default()],
            cuts: 0,
        },
    };
    march.run()?;
    Ok(march.found)
}

struct March<'a, 'f, const D: usize> {
    search: Search<'a, D>,
    storage: Storage,
    relative: Relative,
    free: FreeWater<'f, D>,
    course: &'a Course,
    /// Heads between which the flow moves \[m\].
    span: f64,
    /// Volume of soil, and of the water that drains from it, by unknown \[m^D\].
    volumes: Vec<f64>,
    drainable: Vec<f64>,
    time: f64,
    /// By unknown, beyond full pores at ψ = 0 \[m^D\].
    water: Vec<f64>,
    /// All that moved \[m^D\].
    moved: f64,
    found: Transient<D>,
}

/// A step that balances.
struct Step {
    /// Heads at its end.
    heads: Vec<f64>,
    water: Vec<f64>,
    /// Durations for which flows count \[s\], and the flows.
    stages: Vec<(f64, Balanced)>,
    /// Error of the step of first order over the span of the heads \[-\].
    error: f64,
    /// Whether its last stage began with less water than none at a node.
    owes: bool,
}

impl<const D: usize> March<'_, '_, D> {
    /// Goes to the last time, and keeps the states that are wanted.
    fn run(&mut self) -> Result<(), SeepageError> {
        let mut stops: Vec<f64> = self.course.times.clone();
        let last = stops.last().copied().unwrap_or(0.0);
        let changes = (self.course.histories.iter().flatten()).flat_map(|history| &history.times);
        stops.extend(changes.filter(|time| **time > 0.0 && **time < last));
        stops.sort_by(f64::total_cmp);
        stops.dedup();
        let mut duration = FIRST * stops.first().copied().unwrap_or(0.0);
        for stop in stops {
            let last = self.stretch(stop, &mut duration)?;
            if self.course.times.contains(&stop) {
                self.keep(&last);
            }
        }
        Ok(())
    }

    /// Goes to a time; the last stage of the last step.
    fn stretch(&mut self, stop: f64, duration: &mut f64) -> Result<Balanced, SeepageError> {
        let length = stop - self.time;
        loop {
            let left = stop - self.time;
            // No crumb is left for a last step.
            let (size, is_last) = match *duration {
                size if size >= left => (left, true),
                size if 2.0 * size > left => (0.5 * left, false),
                size => (size, false),
            };
            let kept = self.search.heads.clone();
            let step = self.step(size);
            let change = match &step {
                Ok(step) => SAFETY * (ACCURACY / step.error.max(f64::MIN_POSITIVE)).sqrt(),
                Err(SeepageError::NotFound { .. }) => 0.25,
                Err(_) => 1.0,
            };
            let [least, most] = CHANGES;
            // The heads of nodes that owe water are those of a pull that is none, and a state that is asked for is not one of them.
            let owes = is_last && size > OWING * length && matches!(&step, Ok(step) if step.owes);
            let next = match &step {
                Ok(_) if owes => 0.5 * size,
                Ok(_) => {
                    let least_next = (SUDDEN * length).min(most * size);
                    (size * change.clamp(least, most)).max(least_next)
                }
                Err(_) => size * change,
            };
            match step {
                Ok(step) if !owes && (step.error <= ACCURACY || size <= SUDDEN * length) => {
                    *duration = if is_last { next.max(*duration) } else { next };
                    let time = if is_last { stop } else { self.time + size };
                    let last = self.accept(step, time);
                    if let Some(last) = last.filter(|_| is_last) {
                        return Ok(last);
                    }
                }
                Err(error) if !matches!(error, SeepageError::NotFound { .. }) => return Err(error),
                _ if next < SHORTEST * length => {
                    return Err(SeepageError::Stuck { time: self.time });
                }
                _ => {
                    self.found.cuts += 1;
                    self.search.heads = kept;
                    *duration = next;
                }
            }
        }
    }

    /// A step of two stages, each by the method of Euler (eq. 85c). Where the second would begin with less water than none at a
    /// node and finds no balance, the step is by that method as a whole. The heads are those of its end.
    fn step(&mut self, duration: f64) -> Result<Step, SeepageError> {
        let (start, water) = (self.search.heads.clone(), self.water.clone());
        let first = self.stage((self.time + STAGE * duration, &water), STAGE * duration)?;
        let middle = self.search.heads.clone();
        let [half, _] = (self.storage).water(&self.search.system, &middle, &self.relative);
        let beyond = (1.0 - STAGE) / STAGE;
        let before: Vec<f64> = std::iter::zip(&water, &half)
            .map(|(start, middle)| start + beyond * (middle - start))
            .collect();
        let is_empty = |(volume, all): (&f64, &f64)| *volume < -*all * (1.0 + EMPTY);
        let end = self.time + duration;
        let lacks_water =
            !self.relative.confined && std::iter::zip(&before, &self.drainable).any(is_empty);
        let second = self.stage((end, &before), STAGE * duration);
        let stages = match second {
            Ok(second) => vec![
                ((1.0 - STAGE) * duration, first),
                (STAGE * duration, second),
            ],
            Err(SeepageError::NotFound { .. }) if lacks_water => {
                self.search.heads.clone_from(&middle);
                vec![(duration, self.stage((end, &water), duration)?)]
            }
            Err(error) => return Err(error),
        };
        let [after, _] =
            (self.storage).water(&self.search.system, &self.search.heads, &self.relative);
        let mut error: f64 = 0.0;
        for (k, &head) in self.search.heads.iter().enumerate() {
            // Soil that drains counts by the level that its water stands for.
            let gap = if self.relative.confined || self.storage.pressure_head(k, head) >= 0.0 {
                head - start[k] - (middle[k] - start[k]) / STAGE
            } else {
                let level = after[k] - water[k] - (half[k] - water[k]) / STAGE;
                level / self.drainable[k].max(f64::MIN_POSITIVE) * self.relative.width
            };
            error += self.volumes[k] * (gap / self.span).powi(2);
        }
        let volume: f64 = self.volumes.iter().sum();
        Ok(Step {
            heads: self.search.heads.clone(),
            water: after,
            owes: lacks_water && stages.len() == 2,
            stages,
            error: (error / volume).sqrt(),
        })
    }

    /// A stage that ends at a time, from water at nodes.
    fn stage(
        &mut self,
        (time, before): (f64, &[f64]),
        duration: f64,
    ) -> Result<Balanced, SeepageError> {
        let now = at_time(self.search.system.conditions, self.course, time);
        let system = &mut self.search.system;
        system.held = held(&system.cells, &now, self.free, system.grid);
        if !self.relative.confined {
            system.driven = system.driven_out(&self.search.heads, &self.relative);
        }
        let storing = Storing {
            storage: &self.storage,
            before,
            duration,
        };
        (self.search).balance(&self.relative, TOLERANCE, Some(&storing))
    }

    /// Takes a step, and writes down its balance.
    fn accept(&mut self, step: Step, time: f64) -> Option<Balanced> {
        let mut balance = (self.found.balance.last().copied()).unwrap_or_default();
        for (duration, stage) in &step.stages {
            balance.entered += duration * stage.flows.inwards.iter().sum::<f64>();
            balance.left += duration * stage.flows.outwards.iter().sum::<f64>();
            self.moved += duration * stage.scale;
        }
        let pairs = std::iter::zip(&step.water, &self.water);
        balance.stored += pairs.map(|(after, before)| after - before).sum::<f64>();
        balance.time = time;
        balance.error = (balance.stored - balance.entered + balance.left).abs() / self.moved;
        self.found.balance.push(balance);
        (self.time, self.water) = (time, step.water);
        self.search.heads = step.heads;
        step.stages.into_iter().next_back().map(|(_, last)| last)
    }

    /// Keeps the state that was come to.
    fn keep(&mut self, last: &Balanced) {
        let Search {
            system,
            heads,
            corrections,
            ..
        } = &self.search;
        let parts = (&last.residual[..], &last.flows, None);
        let state = Seepage::of(system, heads, self.relative, parts, *corrections);
        self.found.states.push(state);
    }
}

/// The conditions at a time.
fn at_time<const D: usize>(
    conditions: &Conditions<D>,
    course: &Course,
    time: f64,
) -> Conditions<D> {
    let mut now = conditions.clone();
    for (face, history) in std::iter::zip(&mut now.faces, &course.histories) {
        if let Some(history) = history {
            let value = history.at(time);
            face.condition = match face.condition {
                OnFaces::Recharge(_) => OnFaces::Recharge(value),
                OnFaces::Inflow(_) => OnFaces::Inflow(value),
                _ => OnFaces::Head(value),
            };
        }
    }
    now
}

/// The span of all heads that are given, at the start and in time, no less than the height of a cell \[m\].
fn span<const D: usize>(search: &Search<'_, D>, course: &Course, least: f64) -> f64 {
    let faces = std::iter::zip(&search.system.conditions.faces, &course.histories);
    let in_time = faces.filter(|(face, _)| matches!(face.condition, OnFaces::Head(_)));
    let in_time = in_time.filter_map(|(_, history)| history.as_ref());
    let given = search.system.held.iter().filter_map(|held| match held.at {
        At::Head(head) => Some(head),
        _ => None,
    });
    let heads = (search.heads.iter().copied())
        .chain(in_time.flat_map(|history| history.values.iter().copied()))
        .chain(given);
    let [low, high] = heads.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], head| {
        [head.min(low), head.max(high)]
    });
    (high - low).max(least)
}

/// Refuses soil that stores no water.
fn check_soil<const D: usize>(
    index: usize,
    conditions: &Conditions<D>,
) -> Result<(), SeepageError> {
    let soil = &conditions.soils[index];
    if !(soil.specific_storage > 0.0 && soil.specific_storage.is_finite()) {
        return Err(SeepageError::Value {
            quantity: format!("the specific storage of soil {index}"),
            value: soil.specific_storage,
            wanted: "positive",
        });
    }
    let drains = soil.drainable > 0.0 && soil.drainable < 1.0;
    if !conditions.confined && !drains {
        return Err(SeepageError::Value {
            quantity: format!("the drainable share of soil {index}"),
            value: soil.drainable,
            wanted: "between 0 and 1",
        });
    }
    Ok(())
}

/// Refuses times that do not ascend.
fn check_times(course: &Course) -> Result<(), SeepageError> {
    let histories = course.histories.iter().flatten();
    for times in histories.map(|h| &h.times).chain([&course.times]) {
        if let Some(pair) = times.windows(2).find(|pair| pair[1] <= pair[0]) {
            return Err(SeepageError::Value {
                quantity: "a time".to_owned(),
                value: pair[1],
                wanted: "after the one before",
            });
        }
    }
    match course.times.first() {
        Some(&first) if first <= 0.0 => Err(SeepageError::Value {
            quantity: "the first time".to_owned(),
            value: first,
            wanted: "positive",
        }),
        _ => Ok(()),
    }
}
