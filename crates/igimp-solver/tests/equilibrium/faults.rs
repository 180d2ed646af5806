//! GOAL: a number that is not finite, wherever it comes from, is caught within its step and named,
//! and no step that holds one is accepted.
//! BODY: the block on its base that yields under its weight; one particle of it has a law of its own
//! that answers wrongly once, or the linear solver hands out a wrong solution once.
//! ORACLE: the particle and the node that the fault was put into; the bits of the step without fault.

use std::error::Error;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::body_support::{bits, distance, elastic, loaded, von_mises};
use igimp_assembly::{AssemblyError, Method, ParticleFields, Particles, SharedLaw, StepConditions};
use igimp_linear::{LinearSolver, LinearSolverError, SolveReport, SolverKind};
use igimp_linear::{Pattern, TangentMatrix};
use igimp_material::{
    ConstitutiveModel, Elasticity, History, MaterialError, PointContext, Principal, ReturnMap,
    Strength,
};
use igimp_solver::{
    Body, MarchSettings, NewtonSettings, Outcome, StepError, StepFailure, Workspace, march, step,
};

/// The particle with the law of its own.
const PARTICLE: usize = 17;

const NOT_FINITE: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// The part of an answer that is spoilt.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Part {
    Tau,
    Tangent,
    History,
}

/// A law that is spoilt at one of its calls, or from there on.
#[derive(Debug)]
struct Spoilt {
    sound: SharedLaw,
    part: Part,
    value: f64,
    at_call: usize,
    calls: AtomicUsize,
}

impl ConstitutiveModel for Spoilt {
    fn name(&self) -> &'static str {
        "spoilt"
    }

    fn stiffness_bound(&self) -> &Elasticity {
        self.sound.stiffness_bound()
    }

    fn return_map(
        &self,
        eps_e_trial: &Principal,
        history: &History,
        context: &PointContext,
    ) -> Result<ReturnMap, MaterialError> {
        let mut answer = self.sound.return_map(eps_e_trial, history, context)?;
        let call = self.calls.fetch_add(1, Ordering::Relaxed) + 1;
        // Stress and history once; a tangent from then on, as the pass that looks for the culprit
        // asks for it again.
        if call == self.at_call || (self.part == Part::Tangent && call > self.at_call) {
            match self.part {
                Part::Tau => answer.tau[1] = self.value,
                Part::Tangent => answer.tangent[0][2] = self.value,
                Part::History => answer.history.eps_p_eq = self.value,
            }
        }
        Ok(answer)
    }

    fn has_symmetric_tangent(&self) -> bool {
        self.sound.has_symmetric_tangent()
    }
}

impl Strength for Spoilt {
    fn yield_function(&self, tau: &Principal, history: &History) -> f64 {
        self.sound.yield_function(tau, history)
    }

    fn stress_scale(&self, tau: &Principal) -> f64 {
        self.sound.stress_scale(tau)
    }

    fn utilisation(&self, tau: &Principal, history: &History) -> f64 {
        self.sound.utilisation(tau, history)
    }

    fn reduced(&self, srf: f64) -> Result<SharedLaw, MaterialError> {
        self.sound.reduced(srf)
    }
}

/// The yielding block with a law of its own for [`PARTICLE`].
fn with_law(law: &SharedLaw) -> (Body<2>, StepConditions<2>) {
    let (mut body, mut conditions) = loaded(&von_mises(), 1.0);
    let mut fields = (*body.particles).clone();
    fields.law[PARTICLE] = 1;
    body.particles = Particles::from_fields(fields).unwrap();
    conditions.laws.push(Arc::clone(law));
    (body, conditions)
}

fn spoilt(part: Part, value: f64, at_call: usize) -> SharedLaw {
    Arc::new(Spoilt {
        sound: von_mises(),
        part,
        value,
        at_call,
        calls: AtomicUsize::new(0),
    })
}

fn solve_with(
    body: &mut Body<2>,
    conditions: &StepConditions<2>,
    workspace: &mut Workspace<2>,
) -> Result<usize, StepError> {
    let (method, settings) = (Method::default(), NewtonSettings::default());
    let ends = (0.0, 1.0);
    let accepted = step(body, &method, conditions, ends, &settings, workspace)?;
    Ok(accepted.0.iterations)
}

fn default_workspace() -> Workspace<2> {
    Workspace::new(SolverKind::Auto.build())
}

/// The messages of an error and its causes.
fn chain(error: &StepError) -> String {
    let mut messages = vec![error.to_string()];
    let mut cause = error.source();
    while let Some(next) = cause {
        messages.push(next.to_string());
        cause = next.source();
    }
    messages.join(": ")
}

/// Stress and history are asked for in every pass: whichever pass the fault is in, the step is
/// refused. A tangent that no correction used is no fault of the step.
#[test]
fn a_fault_of_a_law_is_caught_in_its_pass_and_named() {
    let (sound_body, conditions) = with_law(&von_mises());
    let mut clean = sound_body.clone();
    let corrections = solve_with(&mut clean, &conditions, &mut default_workspace()).unwrap();
    assert!(corrections >= 4, "{corrections}");
    let mut unused = 0;
    for part in [Part::Tau, Part::Tangent, Part::History] {
        for value in NOT_FINITE {
            for at_call in 1..=corrections + 1 {
                let (before, conditions) = with_law(&spoilt(part, value, at_call));
                let mut body = before.clone();
                let place = format!("{part:?} {value} in pass {at_call}");
                match solve_with(&mut body, &conditions, &mut default_workspace()) {
                    Ok(_) => {
                        assert_eq!(part, Part::Tangent, "{place}");
                        assert_eq!(bits(&body), bits(&clean), "{place}");
                        unused += 1;
                    }
                    Err(error) => {
                        let message = chain(&error);
                        let quantity = match part {
                            Part::Tau => "stress",
                            Part::Tangent => "tangent",
                            Part::History => "accumulated plastic strain",
                        };
                        for word in [
                            format!("particle {PARTICLE}: the constitutive law failed"),
                            format!("the {quantity} must be finite"),
                        ] {
                            assert!(message.contains(&word), "{place}: {message}");
                        }
                        assert_eq!(bits(&body), bits(&before), "{place}");
                    }
                }
            }
        }
    }
    // The last pass, and with it one whose correction used the factors of the pass before.
    assert!((3..=6).contains(&unused), "{unused}");
}

/// A fault that happens once costs one cut, and the march ends where it would have ended.
#[test]
fn a_march_goes_on_after_a_fault_that_passes() {
    let run = |law: &SharedLaw| {
        let (mut body, conditions) = with_law(law);
        let load_path = |_: f64, to: f64| {
            let mut conditions = conditions.clone();
            conditions.loads.gravity[1] *= to;
            Ok(conditions)
        };
        let settings = MarchSettings::steps(4);
        let method = Method::default();
        let mut watch = |_: &igimp_solver::Accepted<'_, 2>| std::ops::ControlFlow::Continue(());
        let mut workspace = default_workspace();
        let report = march(
            &mut body,
            &method,
            &load_path,
            &settings,
            &mut workspace,
            &mut watch,
        );
        (body, report)
    };
    let (clean, _) = run(&von_mises());
    let (body, report) = run(&spoilt(Part::Tau, f64::NAN, 5));
    assert_eq!(report.outcome, Outcome::Completed);
    assert_eq!(report.failures.len(), 1);
    assert!(chain(&report.failures[0]).contains(&format!("particle {PARTICLE}")));
    let largest = crate::body_support::largest(&clean.particles.displacement);
    let off = distance(&clean.particles.displacement, &body.particles.displacement);
    assert!(off < 0.02 * largest, "{off} of {largest}");
}

/// A solver that hands out one wrong entry of one solution.
struct Corrupting {
    sound: Box<dyn LinearSolver>,
    at_solve: usize,
    entry: usize,
    spoil: fn(f64) -> f64,
    solves: usize,
}

impl Corrupting {
    fn workspace(at_solve: usize, entry: usize, spoil: fn(f64) -> f64) -> Workspace<2> {
        Workspace::new(Box::new(Self {
            sound: SolverKind::Auto.build(),
            at_solve,
            entry,
            spoil,
            solves: 0,
        }))
    }
}

impl LinearSolver for Corrupting {
    fn name(&self) -> &'static str {
        "corrupting"
    }

    fn analyse(&mut self, pattern: &Arc<Pattern>) -> Result<(), LinearSolverError> {
        self.sound.analyse(pattern)
    }

    fn factor(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        self.sound.factor(matrix)
    }

    fn solve(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        let report = self.sound.solve(matrix, rhs, solution)?;
        self.solves += 1;
        if self.solves == self.at_solve {
            solution[self.entry] = (self.spoil)(solution[self.entry]);
        }
        Ok(report)
    }

    fn analyses(&self) -> usize {
        self.sound.analyses()
    }
}

/// The place and axis of an unknown, found by counting as the numbering is defined: free components
/// of nodes with soil, nodes ascending.
fn place_of(body: &Body<2>, conditions: &StepConditions<2>, unknown: usize) -> ([f64; 2], usize) {
    let method = Method::default();
    let grid = &conditions.grid;
    let stencils = igimp_assembly::Stencils::build(&body.particles, &method, conditions).unwrap();
    let mut free = (0..grid.node_count())
        .filter(|&node| stencils.node_volume(node) > 0.0)
        .flat_map(|node| [(node, 0), (node, 1)])
        .filter(|&(node, axis)| conditions.constraints.of(node, axis).is_none());
    let (node, axis) = free.nth(unknown).unwrap();
    (grid.node_position(node), axis)
}

#[test]
fn a_correction_that_is_not_finite_names_its_node() {
    let (before, conditions) = loaded(&von_mises(), 1.0);
    for entry in [0, 11, 20] {
        let ([x, y], axis) = place_of(&before, &conditions, entry);
        for at_solve in 1..=3 {
            let spoils: [fn(f64) -> f64; 3] =
                [|_| f64::NAN, |_| f64::INFINITY, |_| f64::NEG_INFINITY];
            for spoil in spoils {
                let mut body = before.clone();
                let mut workspace = Corrupting::workspace(at_solve, entry, spoil);
                let error = solve_with(&mut body, &conditions, &mut workspace).unwrap_err();
                assert_eq!(
                    *error.failure,
                    StepFailure::NotFinite {
                        vector: "correction",
                        position: [x, y, 0.0],
                        axis,
                    }
                );
                assert_eq!(bits(&body), bits(&before));
            }
        }
    }
}

/// A wrong entry that is finite is for the out-of-balance force to judge: what is accepted is the
/// same equilibrium.
#[test]
fn a_wrong_finite_correction_is_corrected_or_refused() {
    let (before, conditions) = loaded(&elastic(), 1.0);
    let mut clean = before.clone();
    solve_with(&mut clean, &conditions, &mut default_workspace()).unwrap();
    let mut accepted = 0;
    for entry in [0, 11, 20] {
        let spoils: [fn(f64) -> f64; 5] = [|x| 1.5 * x, |x| -x, |x| x + 0.3, |_| 1e200, |_| -1e300];
        for spoil in spoils {
            let mut body = before.clone();
            let mut workspace = Corrupting::workspace(1, entry, spoil);
            match solve_with(&mut body, &conditions, &mut workspace) {
                Ok(_) => {
                    let off = distance(&clean.particles.x, &body.particles.x);
                    assert!(off < 1e-8, "{off:e}");
                    accepted += 1;
                }
                Err(error) => {
                    assert!(chain(&error).len() > 60, "{error:?}");
                    assert_eq!(bits(&body), bits(&before));
                }
            }
        }
    }
    assert!(accepted >= 6, "{accepted}");
}

/// Every field of every particle is held when a saved state is taken up, and named.
#[test]
fn a_saved_state_that_is_not_finite_is_refused_by_field_and_particle() {
    type Spoil = fn(&mut ParticleFields<2>, f64);
    let (body, _) = loaded(&von_mises(), 1.0);
    let places: [(&str, Spoil); 10] = [
        ("x", |fields, value| {
            fields.x[PARTICLE][1] = value;
        }),
        ("displacement", |fields, value| {
            fields.displacement[PARTICLE][0] = value;
        }),
        ("def_grad", |fields, value| {
            fields.def_grad[PARTICLE][0][1] = value;
        }),
        ("b_e", |fields, value| {
            fields.b_e[PARTICLE][2][2] = value;
        }),
        ("sigma", |fields, value| {
            fields.sigma[PARTICLE][0][1] = value;
        }),
        ("half_length", |fields, value| {
            fields.half_length[PARTICLE][1] = value;
        }),
        ("half_length0", |fields, value| {
            fields.half_length0[PARTICLE][0] = value;
        }),
        ("volume0", |fields, value| {
            fields.volume0[PARTICLE] = value;
        }),
        ("mass", |fields, value| {
            fields.mass[PARTICLE] = value;
        }),
        ("eps_p_eq", |fields, value| {
            fields.eps_p_eq[PARTICLE] = value;
        }),
    ];
    for (field, spoil) in places {
        for value in NOT_FINITE {
            let mut fields = (*body.particles).clone();
            spoil(&mut fields, value);
            let error = Particles::from_fields(fields).unwrap_err();
            assert!(
                error
                    .to_string()
                    .starts_with(&format!("particle {PARTICLE}: {field} is {value}")),
                "{error}"
            );
        }
    }
    let mut folded = (*body.particles).clone();
    folded.def_grad[PARTICLE] = [[1.0, 0.0], [0.0, -1.0]];
    assert_eq!(
        Particles::from_fields(folded).unwrap_err().to_string(),
        format!("particle {PARTICLE}: det def_grad is -1, but must be positive and finite")
    );
}

/// Conditions of a body are checked at the beginning of a step.
#[test]
fn conditions_that_are_not_finite_are_named() {
    type Spoil = fn(&mut Body<2>, &mut StepConditions<2>, f64);
    let point = |body: &mut Body<2>| {
        body.load_points =
            igimp_assembly::LoadPoint::along_edge([1.0, 3.0], [2.0, 3.0], [0.0, -1.0], 3, 0);
    };
    let places: [(&str, usize, Spoil); 5] = [
        ("gravity", 1, |_, conditions, value| {
            conditions.loads.gravity[1] = value;
        }),
        ("load factor", 0, |_, conditions, value| {
            conditions.loads.factors[0] = value;
        }),
        ("drag", 0, |_, conditions, value| {
            conditions.loads.drag = value;
        }),
        ("position of a load point", 2, |body, _, value| {
            body.load_points[2].x[0] = value;
        }),
        ("force of a load point", 2, |body, _, value| {
            body.load_points[2].force[1] = value;
        }),
    ];
    for (quantity, index, spoil) in places {
        for value in NOT_FINITE {
            let (mut body, mut conditions) = loaded(&von_mises(), 1.0);
            point(&mut body);
            conditions.loads.factors = vec![0.1];
            spoil(&mut body, &mut conditions, value);
            let error = solve_with(&mut body, &conditions, &mut default_workspace()).unwrap_err();
            assert_eq!(
                *error.failure,
                StepFailure::Assembly(AssemblyError::NonFinite { quantity, index })
            );
        }
    }
    for value in NOT_FINITE {
        let (mut body, conditions) = loaded(&von_mises(), 1.0);
        let mut method = Method::default();
        method.small_cuts.ghost_penalty = value;
        let settings = NewtonSettings::default();
        let mut workspace = default_workspace();
        let error = step(
            &mut body,
            &method,
            &conditions,
            (0.0, 1.0),
            &settings,
            &mut workspace,
        );
        assert_eq!(
            *error.unwrap_err().failure,
            StepFailure::Assembly(AssemblyError::NonFinite {
                quantity: "ghost penalty",
                index: 0
            })
        );
        let mut constraints = conditions.constraints.clone();
        let error = constraints.prescribe(5, 1, value).unwrap_err();
        let quantity = "prescribed displacement";
        let refused = AssemblyError::NonFinite { quantity, index: 5 };
        assert_eq!(error, refused);
        assert!(igimp_shape::Axis::uniform(value, 1.0, 3).is_err());
        assert!(igimp_shape::Axis::uniform(0.0, value, 3).is_err());
        assert!(igimp_shape::Axis::from_nodes(vec![0.0, value, 2.0]).is_err());
    }
}

/// Forces so large that their norm overflows would make any residual look small.
#[test]
fn forces_beyond_the_range_of_numbers_are_no_equilibrium() {
    let (before, mut conditions) = loaded(&von_mises(), 1.0);
    for gravity in [1e155, 1e200, 1e308] {
        conditions.loads.gravity[1] = -gravity;
        let mut body = before.clone();
        let error = solve_with(&mut body, &conditions, &mut default_workspace()).unwrap_err();
        assert!(
            matches!(
                *error.failure,
                StepFailure::Assembly(AssemblyError::NonFinite { .. })
            ),
            "{error:?}"
        );
        assert_eq!(bits(&body), bits(&before));
    }
}
