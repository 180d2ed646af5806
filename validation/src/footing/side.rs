//! A push of the rigid footing after which the soil beside its shaft may let go.
//!
//! The edge of the footing lies mid-cell, so that the soil of one column of cells hangs between the
//! prescribed nodes of the shaft and the free ground. Here that soil can be given another law from
//! the moment on when it stands above the base: the place of a contact that separates.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::{Duration, Instant};

use igimp_assembly::{AssemblyError, ParticleFields, Particles, SharedLaw};
use igimp_cases::CaseError;
use igimp_cases::run::{Controls, Model, State};
use igimp_material::{Elasticity, MohrCoulomb};
use igimp_model::{Case, LoadKind, Strength};
use igimp_shape::Grid;
use igimp_solver::{Accepted, MarchReport, Outcome, Workspace, march};

/// Strength in tension and shear of soil that bears pressure only, over that of the soil \[-\].
const WEAK: f64 = 1e-3;

/// The behaviour of the soil beside the shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Beside {
    /// Everything: it sticks to the shaft, as in a run of the case.
    Sticks,
    /// Within so many cells of the shaft it bears pressure, and neither tension nor shear.
    BearsPressure(f64),
    /// Within so many cells of the shaft it bears nothing: it is taken out.
    BearsNothing(f64),
}

impl Beside {
    /// Cells from the shaft within which soil lets go \[-\].
    fn reach(self) -> f64 {
        match self {
            Self::Sticks => 0.0,
            Self::BearsPressure(cells) | Self::BearsNothing(cells) => cells,
        }
    }
}

/// The law of soil that bears pressure only, of a soil of stiffness `elasticity` and strength `cu`
/// \[Pa\].
fn pressure_only(elasticity: Elasticity, cu: f64) -> Result<SharedLaw, AssemblyError> {
    MohrCoulomb::new(elasticity, WEAK * cu, 0.0, 0.0)
        .and_then(|weak| weak.with_tension_cutoff(WEAK * cu))
        .map(|law| Arc::new(law) as SharedLaw)
        .map_err(|source| AssemblyError::Law { source })
}

/// The footing after a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moment {
    /// Settlement w \[m\].
    pub(crate) settlement: f64,
    /// Resistance, compression positive, times the reaction factor \[N/m\].
    pub(crate) resistance: f64,
    /// The part of it on the nodes of the shaft above the base \[N/m\].
    pub(crate) shaft: f64,
    /// Pull of one side on the soil, across the shaft, tension positive \[N/m\].
    pub(crate) pull: f64,
    /// Volume as seeded of the soil that let go so far, on one side \[m³/m\].
    pub(crate) released: f64,
}

/// A push to its end, or as far as it came.
#[derive(Debug)]
pub(crate) struct Pushed {
    /// All steps as one march.
    pub(crate) report: MarchReport,
    /// After every step.
    pub(crate) moments: Vec<Moment>,
    /// The particles at the end.
    pub(crate) particles: Particles<2>,
    /// Wall-clock time.
    pub(crate) elapsed: Duration,
}

/// The footing of a case that the grid follows, with one free side.
#[derive(Clone, Copy, Debug)]
struct Shaft {
    /// Edge of the base \[m\].
    edge: f64,
    /// Level of the base at the start \[m\].
    level: f64,
    /// Width of a cell \[m\].
    cell: f64,
    reaction_factor: f64,
}

impl Shaft {
    /// # Panics
    /// If the case has no footing.
    fn of(case: &Case<2>) -> Self {
        let found = case.loads.iter().find_map(|load| match load.kind {
            LoadKind::RigidFooting {
                from,
                to,
                reaction_factor,
                ..
            } => Some((from[0].max(to[0]), from[1], reaction_factor)),
            _ => None,
        });
        let (edge, level, reaction_factor) = found.expect("the case has a footing");
        Self {
            edge,
            level,
            cell: case.grid.smallest_cell()[0],
            reaction_factor,
        }
    }

    /// Whether a place is above the base and closer to the shaft than so many cells, counted from
    /// the nodes of the shaft, which stand half a cell inside the edge.
    fn is_beside(&self, [x, y]: [f64; 2], settlement: f64, cells: f64) -> bool {
        y > self.level - settlement && x < self.edge + (cells - 0.5) * self.cell
    }

    /// By particle, whether it is soil beside the shaft of a footing that has gone down so far \[m\].
    fn leaving(
        &self,
        fields: &ParticleFields<2>,
        soil: usize,
        settlement: f64,
        beside: Beside,
    ) -> Vec<bool> {
        std::iter::zip(&fields.law, &fields.x)
            .map(|(&law, &x)| law == soil && self.is_beside(x, settlement, beside.reach()))
            .collect()
    }

    /// The resistance on the nodes of the shaft above the base, and their pull \[N/m\].
    fn forces(&self, grid: &Grid<2>, settlement: f64, reactions: &[[f64; 2]]) -> [f64; 2] {
        let above = self.level - settlement + 1e-6 * self.cell;
        let column = self.edge - self.cell..self.edge;
        let (mut upward, mut pull) = (0.0, 0.0);
        for (node, reaction) in reactions.iter().enumerate() {
            let [x, y] = grid.node_position(node);
            if y > above && column.contains(&x) {
                upward -= self.reaction_factor * reaction[1];
                pull -= reaction[0];
            }
        }
        [upward, pull]
    }
}

/// Pushes the footing of a case down by `settlement` \[m\] in equal steps. The soil that is beside the
/// shaft after a step lets go for good. Cuts are those of the case, within each step.
///
/// # Errors
/// [`CaseError`] for a model that cannot be made. A step without equilibrium is part of the report.
pub(crate) fn push(
    case: &Case<2>,
    settlement: f64,
    steps: usize,
    beside: Beside,
) -> Result<Pushed, CaseError> {
    let clock = Instant::now();
    let (model, State { mut body, controls }) = Model::new(case)?;
    let shaft = Shaft::of(case);
    let soil = case.bodies[0].material;
    let weak = pressure_only(
        *model.laws[soil].stiffness_bound(),
        undrained_strength(case, soil),
    )?;
    let weak_law = model.laws.len();
    let settings = model.march_settings(1);
    let mut workspace = Workspace::new(model.solver());
    let (mut steps_made, mut failures, mut moments) = (Vec::new(), Vec::new(), Vec::new());
    let mut outcome = Outcome::Completed;
    let mut released = 0.0;
    for number in 0..steps {
        let reached = |t: f64| settlement * (number as f64 + t) / steps as f64;
        let at = |t: f64| Controls {
            settlement: reached(t),
            ..controls.clone()
        };
        let load_path = |from: f64, to: f64| {
            let mut conditions = model.conditions(&at(from), &at(to), 0.0)?;
            conditions.laws.push(Arc::clone(&weak));
            Ok(conditions)
        };
        let mut record = |accepted: &Accepted<'_, 2>| {
            let (grid, reactions) = (&accepted.conditions.grid, &accepted.forces.reactions);
            let [upward, pull] = shaft.forces(grid, reached(accepted.report.from), reactions);
            moments.push(Moment {
                settlement: reached(accepted.report.to),
                resistance: model.footing_resistance(grid, reactions),
                shaft: upward,
                pull,
                released,
            });
            ControlFlow::Continue(())
        };
        let part = march(
            &mut body,
            &case.method,
            &load_path,
            &settings,
            &mut workspace,
            &mut record,
        );
        steps_made.extend(part.steps);
        failures.extend(part.failures);
        if part.outcome != Outcome::Completed {
            outcome = part.outcome;
            break;
        }
        let fields = &*body.particles;
        let leaving = shaft.leaving(fields, soil, reached(1.0), beside);
        if beside != Beside::Sticks && leaving.contains(&true) {
            let volumes = fields.volume0.iter().zip(&leaving);
            released += volumes
                .filter(|(_, leaves)| **leaves)
                .map(|(volume, _)| volume)
                .sum::<f64>();
            body.particles = match beside {
                Beside::BearsNothing(_) => body.particles.keeping(|k| !leaving[k])?,
                _ => Particles::from_fields(with_law(fields, &leaving, weak_law))?,
            };
        }
    }
    Ok(Pushed {
        report: MarchReport {
            outcome,
            steps: steps_made,
            failures,
        },
        moments,
        particles: body.particles,
        elapsed: clock.elapsed(),
    })
}

/// The particles with another law where marked.
fn with_law(fields: &ParticleFields<2>, marked: &[bool], law: usize) -> ParticleFields<2> {
    let mut fields = fields.clone();
    for (current, marked) in fields.law.iter_mut().zip(marked) {
        if *marked {
            *current = law;
        }
    }
    fields
}

/// Undrained strength of a Tresca material \[Pa\].
///
/// # Panics
/// If the material is none: the cases are part of the program.
fn undrained_strength(case: &Case<2>, material: usize) -> f64 {
    match case.materials[material].strength {
        Strength::Tresca { undrained_strength } => undrained_strength,
        _ => panic!("the footing stands on Tresca soil"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runs::{Computed, mesh, shipped_case};

    /// A push by 0.2 m in four steps on three cells per width.
    fn coarse() -> Case<2> {
        let mut overrides = mesh(1.0 / 3.0, [5.0, 6.0]);
        let stage = "stages.push to one width";
        overrides.push(format!("{stage}.settlement=\"0.2 m\""));
        overrides.push(format!("{stage}.steps=4"));
        shipped_case("footing_bonded", overrides).unwrap()
    }

    /// GOAL: soil that sticks is pushed as in a run of the case. ORACLE: that run.
    #[test]
    fn soil_that_sticks_is_the_case_itself() {
        let case = coarse();
        let pushed = push(&case, 0.2, 4, Beside::Sticks).unwrap();
        let computed = Computed::new(case).unwrap();
        let curve = computed.curve("resistance").points(0, 1);
        let expected = curve.last().unwrap();
        let last = pushed.moments.last().unwrap();
        assert!((last.settlement - expected[0]).abs() < 1e-12);
        assert!((last.resistance - 1e3 * expected[1]).abs() < 1e-6 * last.resistance);
        assert!(last.released.total_cmp(&0.0).is_eq());
    }

    /// GOAL: soil is taken out beside the shaft and nowhere else, and counted. ORACLE: the volume that
    /// was seeded.
    #[test]
    fn soil_that_is_taken_out_is_counted() {
        let case = coarse();
        let pushed = push(&case, 0.2, 4, Beside::BearsNothing(1.0)).unwrap();
        let left: f64 = pushed.particles.volume0.iter().sum();
        // Particles that let go after the last step are in no moment.
        let next = push(&case, 0.15, 3, Beside::BearsNothing(1.0)).unwrap();
        let at_three = pushed.moments[3].released;
        assert!((next.particles.volume0.iter().sum::<f64>() + at_three - 25.0).abs() < 1e-9);
        assert!(at_three > 0.0 && left < 25.0 - at_three + 1e-9);
        let shaft = Shaft::of(&case);
        let beside = |x: &[f64; 2]| shaft.is_beside(*x, 0.2, 1.0);
        assert!(!pushed.particles.x.iter().any(beside));
    }
}
