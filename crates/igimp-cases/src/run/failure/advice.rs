//! Remedies for a step without equilibrium, in the words of the case file, most promising
//! first. Every rule looks at the failure and at the case, and says nothing when it is of no use.

use igimp_assembly::{AssemblyError, Geometry, Locking, Penetration};
use igimp_linear::LinearSolverError;
use igimp_model::{BodyPart, Case, Driven, Material, RigidMove, Side, Stage, StageKind, Strength};
use igimp_results::fields::length;
use igimp_solver::{Component, StepError, StepFailure};
use igimp_text::short;

use super::is_loss_of_strength;
use crate::run::NearWorst;

/// Most suggestions that a reader will try.
const MOST: usize = 4;
/// Share of particles at the worst node that return to an apex, from which on tension is the
/// likely cause \[-\].
const APEX_RICH: f64 = 0.02;
/// A worst node with fewer particles within a cell of it is hardly covered by soil.
const HARDLY_COVERED: usize = 4;
/// Share of its peak that the load of a push has lost, from which on it is past the limit load \[-\].
const PAST_PEAK: f64 = 0.02;
/// Greatest denominator of a length that is written as a fraction.
const DENOMINATORS: u32 = 1000;
/// Poisson's ratio from which on the bulk modulus dwarfs the shear modulus \[-\].
const NEARLY_INCOMPRESSIBLE: f64 = 0.49;

/// Observations of a stage beside the step that failed.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Seen {
    /// Particles within a cell of the worst node.
    pub(crate) near_worst: Option<NearWorst>,
    /// Share of its peak that the load of a push has lost \[-\].
    pub(crate) fallen: f64,
}

/// Remedies, most promising first.
pub(crate) fn advice<const D: usize>(
    case: &Case<D>,
    number: usize,
    error: &StepError,
    seen: Seen,
) -> Vec<String> {
    let Some(stage) = case.stages.get(number) else {
        return Vec::new();
    };
    let near_worst = seen.near_worst.as_ref();
    let yielding = near_worst.is_some_and(|near| 2 * near.yielding >= near.points.max(1));
    let mut try_this = match &*error.failure {
        _ if is_loss_of_strength(error, near_worst) && is_statics(stage) => {
            let mut out = collapse(case, number, stage, error.from);
            out.push(more_steps(stage));
            out
        }
        StepFailure::LeavesGrid { position, .. }
        | StepFailure::LoadPointLeavesGrid { position, .. }
        | StepFailure::ReinforcementLeavesGrid { position, .. } => off_grid(case, stage, *position),
        // Soil that flows away can also turn a particle inside out, or leave a singular matrix.
        StepFailure::Assembly(
            AssemblyError::Inverted { .. }
            | AssemblyError::Overstrained { .. }
            | AssemblyError::Material { .. },
        )
        | StepFailure::Linear(
            LinearSolverError::Singular { .. }
            | LinearSolverError::NotPositiveDefinite { .. }
            | LinearSolverError::Inaccurate { .. },
        )
        | StepFailure::Singular { .. }
            if yielding =>
        {
            no_equilibrium(case, (number, stage), error, seen)
        }
        StepFailure::Assembly(assembly) => unformed(case, stage, assembly),
        StepFailure::Linear(LinearSolverError::OutOfMemory { .. }) => {
            vec!["a coarser cell in [grid], or a computer with more memory".to_owned()]
        }
        StepFailure::Linear(_) | StepFailure::Singular { .. } => unsolved(case, stage),
        StepFailure::TooDeep { body, .. } => too_deep(case, stage, body),
        StepFailure::Penetration(Penetration { body, position, .. }) => {
            swallowed(case, stage, body, *position)
        }
        StepFailure::NotHeld {
            body,
            component,
            touches,
        } => not_held::<D>(stage, body, *component, *touches),
        StepFailure::Thrown { body, .. } => thrown::<D>(stage, body),
        StepFailure::TooLong { .. } if stage.consolidation.is_some() => vec![
            format!("a longer duration in stage \"{}\"", stage.name),
            finer_cell(case),
        ],
        StepFailure::TooLong { .. } => vec![
            format!(
                "scheme = \"backward-euler\" in stage \"{}\", which damps what steps do not resolve",
                stage.name
            ),
            finer_cell(case),
        ],
        StepFailure::FreeField(_) => vec![
            format!(
                "absorbing in place of free_field in stage \"{}\", where the soil at a side does not stand by itself",
                stage.name
            ),
            finer_cell(case),
        ],
        StepFailure::NotFinite { .. } => vec![more_steps(stage), finer_cell(case)],
        StepFailure::MaxIterations { .. }
        | StepFailure::Diverged
        | StepFailure::Stagnated
        | StepFailure::MechanismAtOnce => no_equilibrium(case, (number, stage), error, seen),
    };
    try_this.truncate(MOST);
    try_this
}

/// Whether a stage looks for equilibria without inertia.
fn is_statics(stage: &Stage) -> bool {
    !matches!(stage.kind, StageKind::Dynamic(_))
}

/// The iteration ended without equilibrium.
fn no_equilibrium<const D: usize>(
    case: &Case<D>,
    (number, stage): (usize, &Stage),
    error: &StepError,
    seen: Seen,
) -> Vec<String> {
    let near_worst = seen.near_worst;
    let near = near_worst.unwrap_or_default();
    let apex = near.apex as f64 / near.points.max(1) as f64;
    let worst = error.worst.map_or([f64::NAN; 3], |(x, _)| x);
    let material = material_at(case, std::array::from_fn(|axis| worst[axis]));
    let mut out = Vec::new();

    out.extend(round_off(case, error));
    out.extend(still_falling(case, error));
    let is_push = matches!(stage.kind, StageKind::Displacement { .. });
    if is_push && seen.fallen > PAST_PEAK {
        out.push(format!(
            "a smaller settlement in stage \"{}\": its load is {} % below its peak, the limit load, which it passed before",
            stage.name,
            short((100.0 * seen.fallen).round())
        ));
    } else if near.is_at_strength() {
        out.extend(collapse(case, number, stage, error.from));
    }
    out.push(more_steps(stage));
    if apex >= APEX_RICH {
        out.extend(material.and_then(tension));
    }
    if near_worst.is_some_and(|near| near.points < HARDLY_COVERED) {
        out.push(ghost_penalty());
    }
    out.extend(material.and_then(|material| incompressible(case, material)));
    out.push(finer_cell(case));
    out
}

fn off_grid<const D: usize>(case: &Case<D>, stage: &Stage, position: [f64; 3]) -> Vec<String> {
    let (lower, upper) = (case.grid.lower(), case.grid.upper());
    let mut out = Vec::new();
    for (axis, name) in ["x", "y"].into_iter().enumerate() {
        let at = position[axis];
        let spec = &case.grid.axes[axis];
        if !(lower[axis] + spec.rise(1)..=upper[axis] - spec.last_cell()).contains(&at) {
            let side = if at > 0.5 * (lower[axis] + upper[axis]) {
                format!("above {name} = {}", metres(upper[axis]))
            } else {
                format!("below {name} = {}", metres(lower[axis]))
            };
            out.push(format!("a larger domain in [grid]: extend it {side}"));
        }
    }
    if out.is_empty() {
        out.push("a larger domain in [grid]".to_owned());
    }
    out.push(format!(
        "stop_when = {{ displacement = \"…\" }} in stage \"{}\", to end it before the soil gets there",
        stage.name
    ));
    out
}

/// Soil went too far into a rigid body.
fn too_deep<const D: usize>(case: &Case<D>, stage: &Stage, body: &str) -> Vec<String> {
    let Some(part) = case.rigid.iter().find(|part| part.name == body) else {
        return vec![more_steps(stage)];
    };
    let (name, stiffness, most) = (&part.name, part.stiffness, part.most_penetration);
    vec![
        format!(
            "stiffness = {} of the rigid body \"{name}\" (now {})",
            short(2.0 * stiffness),
            short(stiffness)
        ),
        finer_cell(case),
        format!(
            "most_penetration = {} of the rigid body \"{name}\" (now {}), if so much is no matter",
            short(2.0 * most),
            short(most)
        ),
    ]
}

/// A particle would get into a rigid body, or through it.
fn swallowed<const D: usize>(
    case: &Case<D>,
    stage: &Stage,
    body: &str,
    [x, y, _]: [f64; 3],
) -> Vec<String> {
    vec![
        more_steps(stage),
        format!(
            "a finer cell near ({}, {}) m, where the rigid body \"{body}\" catches soil: {}",
            short(x),
            short(y),
            finer_cell(case)
        ),
        format!("a greater rounding of the rigid body \"{body}\", or corners that are less sharp"),
    ]
}

/// A rigid body that a step would carry far.
fn thrown<const D: usize>(stage: &Stage, body: &str) -> Vec<String> {
    let key = match D {
        2 => "rotation = \"0 deg\"",
        _ => "rotation_x = \"0 deg\", rotation_y = \"0 deg\"",
    };
    let name = &stage.name;
    vec![
        format!("{key} for the rigid body \"{body}\" in stage \"{name}\", in place of moment or free: that holds it"),
        "a stage of type dynamic: a body that falls over or slides away has no equilibrium to go on in".to_owned(),
    ]
}

/// A rigid body that is free, or has a force, where nothing holds it.
fn not_held<const D: usize>(
    stage: &Stage,
    body: &str,
    component: Component,
    touches: bool,
) -> Vec<String> {
    let name = &stage.name;
    let axis = |k: usize| ["x", "y", "z"][k];
    let (key, by, force) = match component {
        Component::Displacement(k) => (axis(k).to_owned(), "0 m", format!("force_{}", axis(k))),
        Component::Rotation(_) if D == 2 => ("rotation".to_owned(), "0 deg", "moment".to_owned()),
        Component::Rotation(k) => {
            let about = axis(k);
            (
                format!("rotation_{about}"),
                "0 deg",
                format!("moment_{about}"),
            )
        }
    };
    let hold = format!(
        "{key} = \"{by}\" for it in stage \"{name}\", in place of {force} or free: that holds it"
    );
    let down = format!(
        "bodies = [{{ body = \"{body}\", {} = \"-1 mm\" }}]",
        axis(D - 1)
    );
    if touches {
        if matches!(component, Component::Displacement(k) if k + 1 < D) {
            let less = "less that pushes it, or an interface with more friction or adhesion: it slides, as the push exceeds what its base carries";
            return vec![less.to_owned(), hold];
        }
        let press = format!("a stage before \"{name}\" that presses it on: {down}");
        return vec![hold, press];
    }
    vec![
        format!("a stage before \"{name}\" that moves it until soil touches it: {down}"),
        hold,
    ]
}

fn unformed<const D: usize>(case: &Case<D>, stage: &Stage, error: &AssemblyError) -> Vec<String> {
    match error {
        AssemblyError::Shape { position, .. } => off_grid(case, stage, *position),
        AssemblyError::LoadPoint { .. } => vec!["a larger domain in [grid]".to_owned()],
        AssemblyError::UnsupportedLoad { position, .. } => vec![format!(
            "moving the load that acts at ({}, {}) m onto soil",
            short(position[0]),
            short(position[1])
        )],
        AssemblyError::UnsupportedReinforcement { name, position } => vec![format!(
            "soil around ({}) m, where the reinforcement \"{name}\" is, in the stage that installs it and after",
            position[..D]
                .iter()
                .map(|x| short(*x))
                .collect::<Vec<_>>()
                .join(", ")
        )],
        AssemblyError::NoUnknowns => {
            vec!["a free or roller side in [boundaries]: every node is held".to_owned()]
        }
        AssemblyError::Inverted { .. }
        | AssemblyError::Overstrained { .. }
        | AssemblyError::Material { .. } => {
            vec![more_steps(stage), finer_cell(case)]
        }
        _ => vec![more_steps(stage)],
    }
}

fn unsolved<const D: usize>(case: &Case<D>, stage: &Stage) -> Vec<String> {
    let sides = &case.boundaries;
    let mut out = Vec::new();
    if let StageKind::Dynamic(dynamic) = &stage.kind
        && dynamic.lumped_share <= 0.0
    {
        // A particle alone in a cell gives its nodes a mass that moves as one.
        out.push(format!(
            "lumped_share = 0.01 in stage \"{}\", as nodes without a mass of their own move freely",
            stage.name
        ));
        if let Some(body) = case.bodies.iter().find(|body| body.per_direction < 2) {
            out.push(format!("points_per_cell = {} in \"{}\"", 1 << D, body.name));
        }
    }
    if sides.sides[D - 1][0] == Side::Free && sides.boxes.is_empty() {
        out.push("bottom = \"fixed\" in [boundaries]".to_owned());
    }
    out.push(ghost_penalty());
    out.push("supports in [boundaries] that hold every body".to_owned());
    out
}

/// The smallest residual is small, but above the tolerance.
fn round_off<const D: usize>(case: &Case<D>, error: &StepError) -> Option<String> {
    let best = error.residuals.iter().copied().fold(f64::NAN, f64::min);
    let stagnated = matches!(*error.failure, StepFailure::Stagnated);
    let (tolerance, limit) = (case.solver.tolerance, 1e-6);
    (stagnated && best > tolerance && best < limit).then(|| {
        let enough = 10_f64.powf(best.log10().ceil());
        format!("--set solver.tolerance={enough:e}, as the residual reaches {best:.0e}")
    })
}

/// The residual was still falling when the corrections ran out.
fn still_falling<const D: usize>(case: &Case<D>, error: &StepError) -> Option<String> {
    let falling = error.residuals.last_chunk::<4>().is_some_and(|last| {
        last.windows(2).all(|pair| pair[1] < pair[0]) && last[3] < 0.5 * last[0]
    });
    let ran_out = matches!(*error.failure, StepFailure::MaxIterations { .. });
    (ran_out && falling).then(|| {
        let more = 2 * case.solver.max_iterations;
        format!("--set solver.max_iterations={more}, as the residual still falls")
    })
}

/// Most soil at the worst node is at its strength: there may be no equilibrium to find. The stage `reached` a share of its way.
fn collapse<const D: usize>(
    case: &Case<D>,
    number: usize,
    stage: &Stage,
    reached: f64,
) -> Vec<String> {
    let driven = Driven::planned(case, number);
    let mut out = less_than_collapses(case, number, stage, driven);
    let is_load = match &stage.kind {
        StageKind::Gravity { .. } | StageKind::Load { .. } => driven.is_some(),
        StageKind::Rigid(moves) => !moves.iter().any(RigidMove::is_moved) && !out.is_empty(),
        _ => false,
    };
    if is_load && !stage.stop_when.no_equilibrium && stage.consolidation.is_none() {
        let geometry = match stage.geometry {
            Geometry::Given => "",
            Geometry::Moving => " and geometry = \"given\"",
        };
        out.push(format!(
            "stop_when = {{ no_equilibrium = true }}{geometry} in stage \"{}\", which came to {} of its way: it ends at the limit load",
            stage.name,
            percent(reached)
        ));
    }
    out
}

/// A share in percent.
fn percent(share: f64) -> String {
    format!("{} %", short(100.0 * share))
}

/// Less than the load of collapse.
fn less_than_collapses<const D: usize>(
    case: &Case<D>,
    number: usize,
    stage: &Stage,
    driven: Option<Driven>,
) -> Vec<String> {
    match &stage.kind {
        StageKind::Gravity {
            horizontal: Some(share),
            ..
        } if driven == Some(Driven::Acceleration(0)) => vec![format!(
            "horizontal = {} in stage \"{}\": this is probably collapse under the pseudo-static force",
            short(0.5 * share),
            stage.name
        )],
        StageKind::Gravity { factor, .. } => vec![
            format!(
                "factor = {} in stage \"{}\": this is probably collapse under gravity itself",
                short(0.5 * factor),
                stage.name
            ),
            "a strength-reduction stage with path = \"gravity\", to find the factor of safety"
                .to_owned(),
        ],
        StageKind::Load { .. } => driven
            .map(|driven| less_load(case, number, driven))
            .into_iter()
            .collect(),
        StageKind::K0 => {
            vec!["a k0 closer to 1: this is probably collapse of the initial state".to_owned()]
        }
        StageKind::Displacement { .. } => vec![format!(
            "stop_when = {{ load_grows_less_than = 0.001 }} in stage \"{}\": this is probably \
             collapse, with the limit load reached",
            stage.name
        )],
        StageKind::Construction(_) => vec![format!(
            "more steps in stage \"{}\", or less that is placed, removed or drawn down at once: this is \
             probably collapse of what was built",
            stage.name
        )],
        StageKind::StrengthReduction(_) => {
            vec!["a lower bracket: this is probably collapse at the first factor".to_owned()]
        }
        StageKind::Rigid(moves) => {
            let name = &stage.name;
            let instead = format!(
                "a displacement in place of a force in stage \"{name}\": this is probably collapse under it"
            );
            let is_loaded = moves.iter().any(RigidMove::is_loaded);
            is_loaded.then_some(instead).into_iter().collect()
        }
        StageKind::RunOut(_) => vec![format!(
            "type = \"dynamic\" with a duration and at_rest = 5e-3 for stage \"{}\": soil that gains speed needs no equilibrium",
            stage.name
        )],
        _ => Vec::new(),
    }
}

/// Less of a load under which soil fails; more of one that is lowered, such as a support.
fn less_load<const D: usize>(case: &Case<D>, number: usize, driven: Driven) -> String {
    let planned = |_: usize| 1.0;
    let from = driven.before(case, number, &planned);
    let to = driven.after(case, number, &planned);
    let instead = match to < from {
        false => "below",
        true if to < 0.0 => "nearer to zero than",
        true => "above",
    };
    let name = match driven {
        Driven::Load(load) => case.loads[load].name.as_str(),
        _ => "the load",
    };
    format!(
        "factor {instead} {} in stage \"{}\": this is probably collapse under \"{name}\"",
        short(to),
        case.stages[number].name
    )
}

fn more_steps(stage: &Stage) -> String {
    match &stage.kind {
        StageKind::RunOut(run_out) => format!(
            "move_per_step = {} in stage \"{}\" (now {})",
            short(0.5 * run_out.move_per_step),
            stage.name,
            short(run_out.move_per_step)
        ),
        StageKind::Dynamic(_) => format!("a shorter longest_step in stage \"{}\"", stage.name),
        _ if stage.consolidation.is_some() => {
            format!(
                "a shorter longest_step in the consolidation of stage \"{}\"",
                stage.name
            )
        }
        _ => format!("steps = {} for this stage", 2 * stage.steps.max(1)),
    }
}

/// A tension cut-off where soil comes apart.
fn tension(material: &Material) -> Option<String> {
    if let Strength::DruckerPrager { .. } = material.strength {
        return Some(format!(
            "more cohesion in \"{}\", which comes apart there",
            material.name
        ));
    }
    let Strength::MohrCoulomb {
        cohesion,
        friction_angle,
        tension_cutoff,
        ..
    } = material.strength
    else {
        return None;
    };
    let name = &material.name;
    let apex = cohesion / friction_angle.tan();
    match tension_cutoff {
        _ if material.profiles.strength.is_some() || material.profiles.friction.is_some() => {
            Some(match tension_cutoff {
                None => {
                    format!("tension_cutoff = \"0 kPa\" in \"{name}\", which comes apart there")
                }
                Some(_) => format!("more cohesion in \"{name}\", which comes apart there"),
            })
        }
        Some(0.0) => Some(format!("tension_cutoff > 0 in \"{name}\"")),
        Some(_) => Some(format!(
            "more cohesion in \"{name}\", which comes apart there"
        )),
        None if apex.is_finite() && apex > 0.0 => Some(format!(
            "tension_cutoff in \"{name}\", below its apex at {} kPa",
            short(1e-3 * apex)
        )),
        None => Some(format!(
            "a little cohesion in \"{name}\", which comes apart there"
        )),
    }
}

fn incompressible<const D: usize>(case: &Case<D>, material: &Material) -> Option<String> {
    if case.method.locking == Locking::None && material.poisson >= 0.4 {
        return Some("locking = \"b-bar\" in [grid], against volumetric locking".to_owned());
    }
    (material.poisson > NEARLY_INCOMPRESSIBLE)
        .then(|| format!("poisson = {NEARLY_INCOMPRESSIBLE} in \"{}\"", material.name))
}

fn ghost_penalty() -> String {
    "small_cuts = { ghost_penalty = 1e-3 } in [grid], for nodes that hardly touch soil".to_owned()
}

fn finer_cell<const D: usize>(case: &Case<D>) -> String {
    let cell = case.grid.largest_cell().map(|cell| 0.5 * cell);
    if cell
        .iter()
        .all(|side| (side - cell[0]).abs() < 1e-9 * cell[0])
    {
        return format!("cell = \"{}\"", metres(cell[0]));
    }
    let each = std::iter::zip(["x", "y", "z"], cell);
    let each: Vec<String> = each
        .map(|(axis, cell)| format!("{axis} = \"{}\"", metres(cell)))
        .collect();
    format!("cell = {{ {} }}", each.join(", "))
}

/// A length as it can be written in a case file: in few digits where that is exact, else as a fraction, so that cells divide what they
/// divided.
fn metres(length: f64) -> String {
    let is_length = |value: f64| (value - length).abs() <= 1e-12 * length.abs();
    let text = short(length);
    if text.parse().is_ok_and(is_length) {
        return format!("{text} m");
    }
    let fraction = (1..=DENOMINATORS).find_map(|denominator| {
        let count = (length * f64::from(denominator)).round();
        is_length(count / f64::from(denominator)).then(|| format!("{count}/{denominator} m"))
    });
    fraction.unwrap_or_else(|| format!("{length} m"))
}

/// The material at a place in the undeformed bodies; beside all bodies, that of the nearest body.
fn material_at<const D: usize>(case: &Case<D>, x: [f64; D]) -> Option<&Material> {
    let half = case.grid.cell_at(x).map(|cell| 0.5 * cell);
    let lower = std::array::from_fn(|axis| x[axis] - half[axis]);
    let upper = std::array::from_fn(|axis| x[axis] + half[axis]);
    let share = |body: &BodyPart<D>| body.region.within(lower, upper).volume;
    let distance = |body: &BodyPart<D>| {
        let corners = body.region.corners().into_iter();
        corners
            .map(|corner| {
                length(&std::array::from_fn::<_, D, _>(|axis| {
                    corner[axis] - x[axis]
                }))
            })
            .fold(f64::INFINITY, f64::min)
    };
    let bodies = || case.bodies.iter();
    let most = bodies().max_by(|a, b| share(a).total_cmp(&share(b)));
    let nearest = bodies().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let body = most.filter(|body| share(body) > 0.0).or(nearest)?;
    case.materials.get(body.material)
}

#[cfg(test)]
#[path = "advice_tests.rs"]
mod tests;
