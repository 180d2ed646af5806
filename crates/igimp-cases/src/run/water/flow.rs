//! Water that flows out of coupled soil while a stage takes time.

use igimp_assembly::{Consolidating, Particles, Permeable, PoreFlow};
use igimp_model::{Case, Consolidation, Drainage, Material};
use igimp_results::summary::ConsolidationSummary;
use igimp_solver::{MarchSettings, Pace, StepReport};

/// The first step over the time in which pressure evens out across a cell \[-\].
const FIRST_STEP: f64 = 0.02;

/// How often a step may be cut in succession, at least: steps are chosen by their error.
const CUTS: u32 = 12;

/// The flow of a step of a duration after one of another \[s\], for so many laws of the case.
pub(crate) fn of_step<const D: usize>(
    (case, laws): (&Case<D>, usize),
    stage: &Consolidation,
    [duration, before]: [f64; 2],
) -> Consolidating<D> {
    let of_law = |law: usize| pore_flow(case, case.material_of(law));
    let corner = |point: &[f64; 3]| std::array::from_fn(|axis| point[axis]);
    Consolidating {
        duration,
        before,
        must_resolve: true,
        soils: (0..laws).map(of_law).collect(),
        open_sides: stage.open_sides.clone(),
        open_faces: stage.open_faces,
        drains: (stage.drains.iter())
            .map(|[lower, upper]| [corner(lower), corner(upper)])
            .collect(),
    }
}

/// Sizes of the steps of a stage in which water flows, from those of statics: they land on equal parts of its duration, as many as
/// the stage has steps. The smallest cell has that side \[m\].
pub(crate) fn steps<const D: usize>(
    case: &Case<D>,
    stage: &Consolidation,
    settings: MarchSettings,
    side: f64,
) -> MarchSettings {
    let share = |time: f64| time / stage.duration;
    let evens_out = side * side / fastest_consolidation(case);
    let longest = (stage.longest_step.map_or(1.0, share)).min(1.0 / settings.steps as f64);
    MarchSettings {
        cuts: settings.cuts.max(CUTS),
        pace: Some(Pace {
            first: share(FIRST_STEP * evens_out).min(longest),
            longest,
        }),
        ..settings
    }
}

/// The largest coefficient of consolidation c_v = k/(m_v γ_w) of the coupled soils \[m²/s\].
fn fastest_consolidation<const D: usize>(case: &Case<D>) -> f64 {
    let of = |material: &Material| match (material.drainage, material.permeability) {
        (Drainage::Undrained { flows: true, .. }, Some(soil)) => {
            soil.along.max(soil.across) / case.water_unit_weight * material.constrained_modulus()
        }
        _ => 0.0,
    };
    case.materials
        .iter()
        .map(of)
        .fold(f64::MIN_POSITIVE, f64::max)
}

/// Flow of the water in a material.
fn pore_flow<const D: usize>(case: &Case<D>, material: &Material) -> PoreFlow<D> {
    match (material.drainage, material.permeability) {
        (Drainage::Drained, _) => PoreFlow::Drained,
        (
            Drainage::Undrained {
                stiffness,
                flows: true,
            },
            Some(soil),
        ) => PoreFlow::Flows(Permeable {
            mobility: soil
                .tensor()
                .map(|row| row.map(|k| k / case.water_unit_weight)),
            stiffness,
            follows: material.void_law,
        }),
        _ => PoreFlow::Sealed,
    }
}

/// Adds an accepted step to the summary of consolidation of a stage.
pub(crate) fn tally<const D: usize>(
    summary: &mut ConsolidationSummary,
    case: &Case<D>,
    report: &StepReport,
    particles: &Particles<D>,
) {
    let Some(water) = &report.water else {
        return;
    };
    summary.time += report.duration;
    summary.outflow += water.outflow;
    summary.missing += water.missing().abs();
    let flows = |law: usize| {
        let drainage = case.material_of(law).drainage;
        matches!(drainage, Drainage::Undrained { flows: true, .. })
    };
    let (mut volume, mut excess) = (0.0, 0.0);
    for particle in (0..particles.len()).filter(|&particle| flows(particles.law[particle])) {
        volume += particles.volume(particle);
        excess += particles.volume(particle) * particles.excess[particle].abs();
    }
    summary.excess = if volume > 0.0 { excess / volume } else { 0.0 };
    summary.most_excess = summary.most_excess.max(summary.excess);
}
