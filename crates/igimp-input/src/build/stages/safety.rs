//! Stages that reduce strength: the search for the factor of safety, and the run-out.

use igimp_model::{
    Reduction, ReductionPath, RunOut, SearchMethod, Strength, StrengthReduction, search_of,
};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::stages::{self as keys, StageForm};
use igimp_schema::text::clip;
use igimp_schema::tree::Wrong;
use igimp_schema::tree::read::At;

use crate::build::bodies::surfaces::plain;
use crate::build::context::About;

/// Indices of the materials whose strength is reduced.
pub(super) fn materials<const D: usize>(
    about: &About<'_, D>,
    stated: &Result<Option<At<Vec<At<String>>>>, Wrong>,
    problems: &mut Problems,
) -> Option<Vec<usize>> {
    let (context, name) = (about.context, about.name);
    let Some(list) = stated.as_ref().ok()? else {
        if context.materials.iter().any(Option::is_none)
            || context.bodies.iter().any(Option::is_none)
        {
            return None;
        }
        problems
            .error(
                about.stage.form.place,
                format!("stage `{name}` has no strength to reduce: all materials are elastic"),
            )
            .help("give a material a strength, like model = \"mohr-coulomb\"");
        return None;
    };
    let mut indices = Vec::new();
    let mut is_right = true;
    for value in list.iter() {
        let subject = format!("stage `{name}` reduces");
        let Some(index) = context.names.materials.find(value, &subject, problems) else {
            is_right = false;
            continue;
        };
        if indices.contains(&index) {
            problems.error(value.place, "this material is named twice");
        }
        indices.push(index);
        let Some(material) = context.materials.get(index).and_then(Option::as_ref) else {
            continue;
        };
        let shown = clip(&material.name, 40);
        if let Some(reason) = material.strength.not_reduced() {
            let message = format!("the material `{shown}` {reason}");
            // A list that was not stated is that of all strengths: the stage asks for it.
            let place = if value.written {
                value.place
            } else {
                about.stage.form.place
            };
            problems
                .error(place, message)
                .help(match material.strength {
                    Strength::Elastic => "leave it out; it keeps its stiffness",
                    _ => "for a factor of safety, model = \"tresca\" with the undrained strength that it has",
                });
        } else if !context.is_used(index) {
            problems.warning(value.place, format!("no body uses the material `{shown}`"));
        }
    }
    is_right.then_some(indices)
}

/// A search for the factor of safety.
pub(crate) fn strength_reduction<const D: usize>(
    about: &About<'_, D>,
    table: &keys::StrengthReduction,
    problems: &mut Problems,
) -> Option<StrengthReduction> {
    let context = about.context;
    // Searches at several times were put in its place where these are known.
    if let Some(water) = &table.in_time {
        let message = format!("the water `{}` has no times to search at", clip(water, 40));
        problems.error(water.place, message).help(
            "name a condition of computed seepage with start_from and times = [\"1 d\", \"10 d\"]",
        );
        return None;
    }
    let materials = materials(about, &table.materials, problems);
    if let Some(found) = &materials {
        are_there(about, (table, found), problems);
    }
    let path = match *table.path {
        keys::ReductionPath::Gravity => ReductionPath::Gravity,
        keys::ReductionPath::Reduce => ReductionPath::Reduce,
    };
    if about.index == 0 && path == ReductionPath::Reduce {
        problems
            .error(
                about.stage.form.place,
                "a strength reduction needs a loaded body to start from",
            )
            .help("put a stage of type gravity before it, or write path = \"gravity\"");
    }
    let has_rigid = Root::<D>::rigid(context.tree).is_ok_and(|rigid| !rigid.is_empty());
    if path == ReductionPath::Gravity && has_rigid {
        problems
            .error(
                table.path.place,
                "gravity is raised on undeformed bodies, where rigid bodies stand elsewhere",
            )
            .help("write path = \"reduce\"");
    }
    let bracket = *table.bracket;
    if bracket[0] >= bracket[1] {
        problems
            .error(table.bracket.place, "the bracket is not in ascending order")
            .help("a factor thought stable first, like [1.0, 2.0]");
    }
    let (failure_displacement, monitor) = match &table.failure.also {
        None => (None, None),
        Some(also) => {
            let monitor = context.monitor(also.monitor.as_ref(), about.name, problems);
            (Some(*also.displacement), monitor.ok()?)
        }
    };
    let search = match **table.search.as_ref()? {
        keys::Search::Continuation => SearchMethod::Continuation,
        keys::Search::Trials => SearchMethod::Trials,
    };
    if search == SearchMethod::Continuation {
        on_given_geometry(table, problems);
    }
    Some(StrengthReduction {
        search,
        materials: materials?,
        factors: plain(&table.factors),
        bracket,
        tolerance: *table.tolerance,
        path,
        failure_displacement,
        monitor,
    })
}

/// Refuses to reduce the strength of materials of which no body is there: it decides nothing.
fn are_there<const D: usize>(
    about: &About<'_, D>,
    (table, found): (&keys::StrengthReduction, &[usize]),
    problems: &mut Problems,
) {
    let context = about.context;
    let scene = context.sequence.before(about.index);
    let bodies =
        || std::iter::zip(&scene.present, &scene.material).filter(|(present, _)| **present);
    if bodies().any(|(_, material)| material.is_none()) {
        return;
    }
    let is_there = |material: &usize| bodies().any(|(_, entry)| *entry == Some(*material));
    if found.iter().any(is_there) {
        return;
    }
    let Ok(Some(list)) = &table.materials else {
        return;
    };
    let place = if list.written {
        list.place
    } else {
        about.stage.form.place
    };
    let name = about.name;
    problems
        .error(
            place,
            format!("no body that is there in stage `{name}` has the strength that it reduces"),
        )
        .help("name materials of bodies that are there, or place the body before, in a stage of type construction");
}

/// Refuses keys that a path of equilibria does not take.
fn on_given_geometry(table: &keys::StrengthReduction, problems: &mut Problems) {
    if *table.geometry == keys::Geometry::Moving {
        problems
            .error(
                table.geometry.place,
                "a path of equilibria is followed on the given geometry",
            )
            .help("write geometry = \"given\", or search = \"trials\"");
    }
    if !table.factors.is_empty() {
        problems
            .error(
                table.factors.place,
                "a path of equilibria has factors of its own",
            )
            .help("leave `factors` out, or write search = \"trials\"");
    }
}

/// A run-out.
pub(crate) fn run_out<const D: usize>(
    about: &About<'_, D>,
    table: &keys::RunOut,
    problems: &mut Problems,
) -> Option<RunOut> {
    let materials = materials(about, &table.materials, problems);
    if about.index == 0 {
        problems
            .error(
                about.stage.form.place,
                "a run-out needs a loaded body to start from",
            )
            .help("put a stage of type gravity before it");
    }
    let reduction = table.reduction.as_ref().ok();
    let reduction = reduction.and_then(|key| reduction_of(about, key, problems));
    Some(RunOut {
        materials: materials?,
        reduction: reduction?,
        move_per_step: *table.move_per_step,
        at_rest: *table.at_rest,
    })
}

/// By how much strength is reduced.
pub(super) fn reduction_of<const D: usize>(
    about: &About<'_, D>,
    stated: &At<keys::Reduction>,
    problems: &mut Problems,
) -> Option<Reduction> {
    match (&stated.times_fos, &stated.factor) {
        (Some(times), None) => {
            let stages = about.context.stages;
            let is_search = |stage: usize| {
                let stage = stages[stage].as_ref();
                stage.is_some_and(|stage| matches!(*stage.form, StageForm::StrengthReduction(_)))
            };
            let from = |stage: usize| about.context.sequence.from(stage);
            let is_before = (0..about.index).any(is_search);
            // A stage that is found to start from nothing was reported.
            let is_known = !is_before || from(about.index).is_some();
            if is_known && search_of(about.index, &from, &is_search).is_none() {
                let help =
                    "put a stage of type strength-reduction before it, or write factor = 1.5";
                problems
                    .error(
                        times.place,
                        if is_before {
                            "no earlier stage finds the factor of safety of the state that this stage starts from"
                        } else {
                            "there is no earlier stage that finds a factor of safety"
                        },
                    )
                    .help(help);
            }
            Some(Reduction::TimesFos(**times))
        }
        (None, Some(factor)) => Some(Reduction::Factor(**factor)),
        (both, _) => {
            let message = if both.is_some() {
                "both `times_fos` and `factor` are given"
            } else {
                "the reduction has no value"
            };
            problems
                .error(stated.place, message)
                .help("write { times_fos = 1.05 } or { factor = 1.5 }");
            None
        }
    }
}
