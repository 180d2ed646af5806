//! Earthquakes: walls, the motion of the ground, and a block that slides on it.

use igimp_assembly::Rayleigh;
use igimp_model::{Base, GroundMotion, StageWalls};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::grid::Side;
use igimp_schema::schema::ground_motion::{self as keys, BaseKind, MotionAxis, Wall};
use igimp_schema::schema::stages::{Dynamic, StageForm};
use igimp_schema::tree::read::At;
use igimp_text::short;

use super::consolidation::side;
use crate::build::bodies::reach::meets_side;
use crate::build::context::About;

/// A record of velocity whose first value is no larger share of its largest one begins at rest \[-\].
const AT_REST: f64 = 1e-2;

/// The ground beyond the walls.
pub(super) fn walls<const D: usize>(
    about: &About<'_, D>,
    table: &Dynamic,
    problems: &mut Problems,
) -> Option<StageWalls> {
    let mut absorbing = Vec::new();
    for wall in table.absorbing.iter() {
        let known = side::<D>(wall, problems).ok()?;
        if *table.tied_sides && known.0 == 0 {
            problems
                .error(
                    wall.place,
                    "this side has dashpots and moves with the other",
                )
                .help("keep one of absorbing and tied_sides for left and right");
            return None;
        }
        if !absorbing.contains(&known) {
            absorbing.push(known);
        }
    }
    let free_field = beside_free_field::<D>(table, &absorbing, problems)?;
    let motion = table.ground_motion.as_ref();
    let below = (D - 1, false);
    is_free_below::<D>(table, problems)?;
    reaches_sides(about, table, problems)?;
    if motion.is_some_and(|m| *m.base == BaseKind::Compliant) && !absorbing.contains(&below) {
        absorbing.push(below);
    }
    let mut sides = table.absorbing.iter().chain(table.free_field.iter());
    let first = sides.next().map(|wall| wall.place);
    let tied = table.tied_sides.then_some(table.tied_sides.place);
    if about.index == 0
        && let Some(place) = first.or(tied).or(motion.map(|motion| motion.place))
    {
        problems
            .error(
                place,
                "the first stage has no supports yet that walls could take the place of",
            )
            .help("begin with a stage of type gravity or k0, and let this one follow");
        return None;
    }
    // A file with every default written down states the usual ones.
    let are_usual = table.wall_springs.total_cmp(&1.0).is_eq();
    if !are_usual && absorbing.is_empty() && free_field.is_empty() {
        problems
            .error(
                table.wall_springs.place,
                "springs stand beside dashpots, and no side has any",
            )
            .help("name sides in absorbing or free_field, or remove wall_springs");
        return None;
    }
    let walls = StageWalls {
        absorbing,
        springs: *table.wall_springs,
        tied: *table.tied_sides,
        free_field,
    };
    warn_of_rigid_walls((about, table), &walls, problems);
    Some(walls)
}

/// Warns of sides across the motion of the ground that hold the soil: they go along with the base as rigid walls.
fn warn_of_rigid_walls<const D: usize>(
    (about, table): (&About<'_, D>, &Dynamic),
    walls: &StageWalls,
    problems: &mut Problems,
) {
    let (Some(motion), Ok(sides)) = (
        table.ground_motion.as_ref(),
        Root::<D>::boundaries(about.context.tree),
    ) else {
        return;
    };
    let front_and_back = (&sides.front, &sides.back);
    let (axis, names, stated) = match (*motion.axis, front_and_back) {
        (MotionAxis::X, _) => (0, ["left", "right"], [&sides.left, &sides.right]),
        (MotionAxis::Y, (Some(front), Some(back))) => (1, ["front", "back"], [front, back]),
        _ => return,
    };
    if walls.tied && axis == 0 {
        return;
    }
    let gives =
        |wall: (usize, bool)| walls.absorbing.contains(&wall) || walls.free_field.contains(&wall);
    let holds = |k: usize| **stated[k] != Side::Free && !gives((axis, k == 1));
    let held: Vec<&str> = (0..2).filter(|&k| holds(k)).map(|k| names[k]).collect();
    if held.is_empty() {
        return;
    }
    let remedy = if axis == 0 {
        "tied_sides for level ground, free_field or absorbing for these sides, or leave a rigid box as it is"
    } else {
        "free_field or absorbing for these sides, axis = \"x\" with tied_sides for level ground, or leave a rigid box as it is"
    };
    problems
        .warning(
            motion.place,
            format!(
                "{} {} with the base as rigid walls: soil beside them hardly shears",
                held.join(" and "),
                if held.len() == 1 { "goes" } else { "go" }
            ),
        )
        .help(remedy);
}

/// Refuses dashpots at a bottom that moves by a record, whatever the soil does.
fn is_free_below<const D: usize>(table: &Dynamic, problems: &mut Problems) -> Option<()> {
    let is_rigid = |motion: &At<keys::GroundMotion>| *motion.base == BaseKind::Rigid;
    if !table.ground_motion.as_ref().is_some_and(is_rigid) {
        return Some(());
    }
    let bottom = table.absorbing.iter().find(|wall| ***wall == Wall::Bottom);
    let Some(wall) = bottom else {
        return Some(());
    };
    problems
        .error(
            wall.place,
            "the bottom has dashpots, and a rigid base moves it by the record",
        )
        .help("write base = \"compliant\" in ground_motion for rock that takes waves, or remove bottom from absorbing");
    None
}

/// Refuses walls at sides of the grid that no body reaches.
fn reaches_sides<const D: usize>(
    about: &About<'_, D>,
    table: &Dynamic,
    problems: &mut Problems,
) -> Option<()> {
    let context = about.context;
    let Some(ends) = context.soil.ends() else {
        return Some(());
    };
    let is_reached = |side| meets_side(context.bodies, context.sequence, side, ends);
    for wall in table.absorbing.iter().chain(table.free_field.iter()) {
        if !is_reached(side::<D>(wall, problems).ok()?) {
            let message = format!(
                "no body reaches the side {}: nothing stands there",
                wall.name()
            );
            problems
                .error(wall.place, message)
                .help("name a side of the grid that the ground reaches, or let domain end where the ground does");
            return None;
        }
    }
    let missing = [(Wall::Left, false), (Wall::Right, true)];
    let missing = missing
        .into_iter()
        .find(|&(_, upper)| !is_reached((0, upper)));
    if let (true, Some((wall, _))) = (*table.tied_sides, missing) {
        let message = format!(
            "no body reaches the side {}: it moves with nothing",
            wall.name()
        );
        problems
            .error(table.tied_sides.place, message)
            .help("let domain end where the ground does on the left and on the right, or remove tied_sides");
        return None;
    }
    Some(())
}

/// The sides beside which soil moves in free field.
fn beside_free_field<const D: usize>(
    table: &Dynamic,
    absorbing: &[(usize, bool)],
    problems: &mut Problems,
) -> Option<Vec<(usize, bool)>> {
    let mut sides = Vec::new();
    for wall in table.free_field.iter() {
        let known = side::<D>(wall, problems).ok()?;
        let (message, help) = if D == 3 {
            (
                "soil moves in free field beside a model in plane strain alone",
                "write absorbing = [...] in space, with the sides far away",
            )
        } else if known.0 != 0 {
            (
                "soil in free field stands beside the left or the right side",
                "write base = \"compliant\" for rock below",
            )
        } else if *table.tied_sides {
            (
                "this side moves with the other, and is to have soil in free field beside it",
                "keep tied_sides for level ground, free_field for all other",
            )
        } else if absorbing.contains(&known) {
            (
                "this side has dashpots against still ground already",
                "name it in free_field alone: its dashpots come with it",
            )
        } else {
            if !sides.contains(&known) {
                sides.push(known);
            }
            continue;
        };
        problems.error(wall.place, message).help(help);
        return None;
    }
    Some(sides)
}

/// The motion of the ground.
pub(super) fn motion<const D: usize>(
    about: &About<'_, D>,
    record: &At<keys::GroundMotion>,
    problems: &mut Problems,
) -> Option<GroundMotion> {
    let (Some(time), Some(values), Some(unit)) = (&record.time, &record.values, &record.unit)
    else {
        problems
            .error(record.place, "the motion of the ground has no samples")
            .help("write file = \"record.csv\", or unit, time and values");
        return None;
    };
    if time.len() != values.len() {
        let message = format!("{} times and {} values", time.len(), values.len());
        problems
            .error(values.place, message)
            .help("every time has one value");
        return None;
    }
    let mut times = time.windows(2);
    if let Some(pair) = times.find(|pair| *pair[1] <= *pair[0]) {
        problems
            .error(pair[1].place, "this time is not after the one before")
            .help("times of a record ascend, each once");
        return None;
    }
    let axis = match *record.axis {
        MotionAxis::X => Some(0),
        MotionAxis::Y => Some(1),
        MotionAxis::Z => (D == 3).then_some(2),
    };
    let Some(axis) = axis else {
        problems
            .error(record.axis.place, "there is no axis z in plane strain")
            .help("write x or y");
        return None;
    };
    let base = match *record.base {
        BaseKind::Rigid => Base::Rigid,
        BaseKind::Compliant => Base::Compliant,
    };
    let sides = Root::<D>::boundaries(about.context.tree).ok();
    if base == Base::Rigid
        && let Some(sides) = sides
        && *sides.bottom != Side::Fixed
    {
        problems
            .error(
                record.place,
                "the bottom of the grid does not take the soil along",
            )
            .help("write bottom = \"fixed\" in [boundaries], or base = \"compliant\" here");
        return None;
    }
    let (size, is_velocity) = unit.in_si();
    Some(GroundMotion {
        times: time.iter().map(|t| **t).collect(),
        values: (values.iter())
            .map(|value| size * *record.scale * **value)
            .collect(),
        is_velocity,
        axis,
        base,
    })
}

/// Remarks on a record of velocity that does not begin at zero: acceleration is its slope, and knows no first value.
pub(super) fn begins_at_rest(
    record: &At<keys::GroundMotion>,
    motion: &GroundMotion,
    problems: &mut Problems,
) {
    let (Some(first), Some(values)) = (motion.values.first(), &record.values) else {
        return;
    };
    let largest = motion.values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    if !motion.is_velocity || first.abs() <= AT_REST * largest {
        return;
    }
    let first = short(*first);
    let message = format!(
        "the record begins with a velocity of {first} m/s, which is left out: the ground begins at rest, and ends with {first} m/s less than \
         the record"
    );
    problems
        .warning(values.place, message)
        .help("let the record begin with a sample of 0, so long before the first one as the ground took to reach it");
}

/// Damping of soil.
pub(super) fn rayleigh(damping: &keys::Rayleigh, problems: &mut Problems) -> Option<Rayleigh> {
    let periods = damping.periods.value;
    if (periods[0] - periods[1]).abs() < 1e-9 * periods[0] {
        problems
            .error(damping.periods.place, "the two periods are the same")
            .help("name two periods between which the motion has most of its energy");
        return None;
    }
    if *damping.ratio > 1.0 {
        let message = format!(
            "a damping ratio of {} is so many times the critical one: nothing swings",
            short(*damping.ratio)
        );
        problems
            .warning(damping.ratio.place, message)
            .help("it is a share: 0.05 are 5 %; soil has 0.01 to 0.05 beside its plastic work");
    }
    Some(Rayleigh::at(
        [*damping.ratio; 2],
        periods.map(|period| 1.0 / period),
    ))
}

/// The stage whose yield acceleration a sliding block goes by.
pub(super) fn newmark_from<const D: usize>(
    about: &About<'_, D>,
    table: &Dynamic,
    problems: &mut Problems,
) -> Result<Option<usize>, ()> {
    let Some(named) = &table.newmark_from else {
        return Ok(None);
    };
    let subject = format!("stage `{}` takes the yield acceleration from", about.name);
    let stages = &about.context.names.stages;
    let index = stages.find(named, &subject, problems).ok_or(())?;
    let Some(motion) = &table.ground_motion else {
        problems
            .error(named.place, "a block slides on ground that moves")
            .help("add ground_motion, or remove newmark_from");
        return Err(());
    };
    if *motion.axis != MotionAxis::X {
        problems
            .error(
                motion.axis.place,
                "a block slides along x, as `horizontal` pushes, and the ground does not move along it",
            )
            .help("write axis = \"x\", or remove newmark_from");
        return Err(());
    }
    let stage = about.context.stages.get(index).and_then(Option::as_ref);
    let pushes = stage.is_some_and(|stage| match &*stage.form {
        StageForm::Gravity(Ok(form)) => form.horizontal.as_ref().is_some_and(|k| **k != 0.0),
        _ => false,
    });
    if index >= about.index || !pushes {
        problems
            .error(named.place, "this stage tells no yield acceleration")
            .help(
                "name an earlier stage of type gravity with horizontal = ..., geometry = \"given\" and \
                 stop_when = { no_equilibrium = true }",
            );
        return Err(());
    }
    Ok(Some(index))
}
