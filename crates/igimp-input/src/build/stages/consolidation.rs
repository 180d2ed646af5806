//! Time in which water flows out of soil.

use igimp_model::{Consolidation, Drainage};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::consolidation as keys;
use igimp_schema::schema::ground_motion::Wall;
use igimp_schema::schema::stages::{StageCommon, StageForm};
use igimp_schema::text::number;
use igimp_schema::tree::Wrong;
use igimp_schema::tree::read::At;

use crate::build::bodies::reach::{meets_box, meets_side};
use crate::build::context::{About, Context};
use crate::build::water::seepage::extent;

/// Soil is looked for beyond the sides of drains as far as this share of a cell \[-\].
const WITHIN: f64 = 1e-2;

/// The time that a stage takes for water to flow, if it takes any.
pub(super) fn consolidation<const D: usize>(
    about: &About<'_, D>,
    common: &StageCommon,
    problems: &mut Problems,
) -> Result<Option<Consolidation>, Wrong> {
    let form = &about.stage.form;
    let Some(table) = common.consolidation.as_ref().map_err(|_| Wrong)? else {
        if let StageForm::Wait(_) = **form {
            let message = format!("stage `{}` waits and says not how long", about.name);
            problems
                .error(about.stage.place, message)
                .help("add consolidation = { duration = \"90 d\" }");
            return Err(Wrong);
        }
        return Ok(None);
    };
    let refused = match &**form {
        StageForm::StrengthReduction(_) | StageForm::RunOut(_) => {
            Some("water does not flow while strength is reduced")
        }
        StageForm::Dynamic(_) => Some("soil with inertia is drained or undrained"),
        StageForm::K0(_) => Some("ground at rest has had its time"),
        StageForm::Construction(Ok(changes))
            if changes.dissipate.as_ref().is_ok_and(|gone| gone.value) =>
        {
            Some("all excess pressure is gone at once in a stage with `dissipate`")
        }
        _ if common.drained.as_ref().is_ok_and(|drained| drained.value) => {
            Some("all soil drains at once in a stage with `drained`")
        }
        _ => None,
    };
    if let Some(why) = refused {
        problems
            .error(
                table.place,
                format!("stage `{}` cannot consolidate: {why}", about.name),
            )
            .help("let water flow in a stage of type wait before it or after it");
        return Err(Wrong);
    }
    let goes_with_time = |soil: &igimp_model::Material| {
        matches!(soil.drainage, Drainage::Undrained { flows: true, .. }) || soil.goes_with_rate()
    };
    let materials = &about.context.materials;
    if materials.iter().all(Option::is_some) && !materials.iter().flatten().any(goes_with_time) {
        problems
            .error(table.place, "no material is coupled: no water flows")
            .help("write drainage = \"coupled\" and a permeability in the soil that consolidates, or a `rate` in soil whose strength goes with it");
        return Err(Wrong);
    }
    let stated = Consolidation {
        duration: *table.duration,
        open_faces: *table.open_faces,
        open_sides: open_sides(about, table, problems)?,
        drains: drains(about, table, problems)?,
        longest_step: table.longest_step.as_ref().map(|step| **step),
    };
    if let StageForm::Wait(_) = **form
        && !has_outlet(about, &stated)
    {
        problems
            .warning(
                table.open_faces.place,
                "water leaves nowhere in this stage: excess pressure evens out and stays",
            )
            .help("name open_sides or drains, or let open_faces be true");
    }
    Ok(Some(stated))
}

/// Whether water that flows may leave, as far as that is known: drained soil takes it too.
fn has_outlet<const D: usize>(about: &About<'_, D>, flow: &Consolidation) -> bool {
    let mut used = (about.context.materials.iter().enumerate())
        .filter(|&(index, _)| about.context.is_used(index))
        .map(|(_, material)| material.as_ref().map(|soil| soil.drainage));
    let takes_or_is_still =
        |drainage: Option<Drainage>| drainage.is_none_or(|kind| kind == Drainage::Drained);
    flow.open_faces
        || !flow.open_sides.is_empty()
        || !flow.drains.is_empty()
        || used.any(takes_or_is_still)
}

/// The sides of the grid where water leaves.
fn open_sides<const D: usize>(
    about: &About<'_, D>,
    table: &keys::Consolidation,
    problems: &mut Problems,
) -> Result<Vec<(usize, bool)>, Wrong> {
    let context = about.context;
    let mut sides = Vec::new();
    for wall in table.open_sides.iter() {
        let side = side::<D>(wall, problems)?;
        let ends = context.soil.ends();
        if ends.is_some_and(|ends| !meets_side(context.bodies, context.sequence, side, ends)) {
            let message = format!(
                "no body reaches the side {}: no water leaves there",
                wall.name()
            );
            problems
                .error(wall.place, message)
                .help("name a side of the grid that the ground reaches; free faces within the grid are open_faces");
            return Err(Wrong);
        }
        if !sides.contains(&side) {
            sides.push(side);
        }
    }
    Ok(sides)
}

/// The boxes of the ground where water leaves.
fn drains<const D: usize>(
    about: &About<'_, D>,
    table: &keys::Consolidation,
    problems: &mut Problems,
) -> Result<Vec<[[f64; 3]; 2]>, Wrong> {
    let context = about.context;
    let mut drains = Vec::new();
    for drain in table.drains.iter() {
        let keys::Drain { from, to } = &drain.as_ref().map_err(|_| Wrong)?.value;
        let within = extent::<D>(from, to, problems)?;
        let is_flat = (0..D).any(|axis| within.lower[axis] >= within.upper[axis]);
        if is_flat {
            problems
                .error(from.place, "this drain is flat: it drains no soil")
                .help("water leaves from the soil within the box: give it the thickness of the drain, or a cell");
            return Err(Wrong);
        }
        let ends = [within.lower, within.upper].map(|end| std::array::from_fn(|axis| end[axis]));
        if !meets_box::<D>(context.bodies, context.sequence, ends) {
            problems
                .error(from.place, "this drain meets no body: it drains no soil")
                .help("water leaves from the soil within the box: let it reach into the ground");
            return Err(Wrong);
        }
        if let Some((axis, at)) = side_within_cells(context, ends) {
            let axis = ["x", "y", "z"][axis];
            problems
                .warning(
                    from.place,
                    format!(
                        "a side of this drain, {axis} = {} m, lies in soil off the lines of the grid: water leaves at the nodes of cells, and the \
                         drain acts up to a cell wider or narrower",
                        number(at)
                    ),
                )
                .help("lay its sides on lines of the grid, with `lines` in [grid] if need be");
        }
        drains.push([within.lower, within.upper]);
    }
    Ok(drains)
}

/// A side of a drain that lies in soil within a cell, with its axis \[m\].
fn side_within_cells<const D: usize>(
    context: &Context<'_, D>,
    [lower, upper]: [[f64; D]; 2],
) -> Option<(usize, f64)> {
    let thin = WITHIN * context.soil.cell();
    let sides = (0..D).flat_map(|axis| [(axis, false), (axis, true)]);
    let mut sides = sides.filter(|&(axis, is_upper)| {
        // The strip just beyond the side, along it: soil that does not drain.
        let mut beyond = [lower, upper];
        beyond[usize::from(!is_upper)][axis] = if is_upper {
            upper[axis]
        } else {
            lower[axis] - thin
        };
        beyond[usize::from(is_upper)][axis] = if is_upper {
            upper[axis] + thin
        } else {
            lower[axis]
        };
        let at = if is_upper { upper[axis] } else { lower[axis] };
        context.soil.is_off_lines(axis, at) && meets_box(context.bodies, context.sequence, beyond)
    });
    let (axis, is_upper) = sides.next()?;
    Some((axis, if is_upper { upper[axis] } else { lower[axis] }))
}

/// A side of the grid by its name: axis, and whether it is the upper end.
pub(super) fn side<const D: usize>(
    wall: &At<Wall>,
    problems: &mut Problems,
) -> Result<(usize, bool), Wrong> {
    let known = match **wall {
        Wall::Left => Some((0, false)),
        Wall::Right => Some((0, true)),
        Wall::Front => (D == 3).then_some((1, false)),
        Wall::Back => (D == 3).then_some((1, true)),
        Wall::Bottom => Some((D - 1, false)),
        Wall::Top => Some((D - 1, true)),
    };
    known.ok_or_else(|| {
        let message = format!("there is no side {} in plane strain", wall.name());
        problems
            .error(wall.place, message)
            .help("write left, right, bottom or top");
        Wrong
    })
}
