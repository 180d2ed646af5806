//! Loads, and whether there is soil where they act.

pub(crate) mod space;

use igimp_model::{AxisSpec, Load, LoadKind};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::loads::{
    self as keys, Footing, FootingInterface, LoadForm, Patch, PointLoad, Pressure,
    PressureDirection,
};
use igimp_schema::schema::stages::{Stage, StageForm};
use igimp_schema::source::Place;
use igimp_schema::text::{clip, number, point};
use igimp_schema::tree::read::At;
use igimp_schema::tree::{Node, Wrong};

use super::bodies::sequence::Sequence;
use super::bodies::site::{Site, Soil};
use super::grid::Frame;
use super::things;
use crate::build::Thing;
use igimp_geometry::outline::cover;

/// Soil that bears loads.
pub(super) trait Bearing<const D: usize>: Soil<D> {
    /// A rigid footing on it.
    fn footing(
        &self,
        table: &Result<Footing<D>, Wrong>,
        name: &str,
        problems: &mut Problems,
    ) -> Option<LoadKind<D>>;

    /// A pressure on its surface, by name, and the scenes in which it acts.
    fn pressure(
        &self,
        table: &Pressure<D>,
        about: (&str, &[&[bool]]),
        problems: &mut Problems,
    ) -> Option<LoadKind<D>>;

    /// A pressure on a part of its surface that is stated in plan; with the name of the load, its place, and that of its type,
    /// and the scenes in which it acts.
    fn patch(
        &self,
        table: &Result<Patch, Wrong>,
        about: (&str, Place, Place, &[&[bool]]),
        problems: &mut Problems,
    ) -> Option<LoadKind<D>>;
}

/// Which bodies are there, by index, in each stage that applies a load.
fn scenes_of<'a>(
    name: &str,
    (stages, sequence): (&[Thing<Stage>], &'a Sequence),
) -> Vec<&'a [bool]> {
    let applies = |stage: &At<Stage>| {
        let is_off = match &*stage.form {
            StageForm::Load(Ok(table)) => table.factor.as_ref().is_ok_and(|by| **by == 0.0),
            _ => false,
        };
        !is_off && stage.loads().iter().any(|load| load.value == name)
    };
    let applied = stages.iter().enumerate();
    let applied = applied.filter(|(_, stage)| stage.as_ref().is_some_and(applies));
    applied
        .map(|(stage, _)| &*sequence.before(stage).present)
        .collect()
}

/// The loads.
pub(super) fn loads<const D: usize>(
    tree: &Node,
    soil: &impl Bearing<D>,
    course: (&[Thing<Stage>], &Sequence),
    problems: &mut Problems,
) -> Vec<Option<Load<D>>> {
    let mut has_footing = false;
    let load = |load: Thing<keys::Load<D>>| {
        let load = load?;
        let name = load.name.as_str();
        let scenes = &scenes_of(name, course);
        let kind = match &*load.form {
            LoadForm::RigidFooting(footing) => soil.footing(footing, name, problems),
            LoadForm::Pressure(p) => soil.pressure(p.as_ref().ok()?, (name, scenes), problems),
            LoadForm::Patch(patch) => {
                soil.patch(patch, (name, load.place, load.form.place, scenes), problems)
            }
            LoadForm::Point(force) => Some(at_point(force.as_ref().ok()?, name, soil, problems)),
        }?;
        if let LoadKind::RigidFooting { .. } = kind
            && std::mem::replace(&mut has_footing, true)
        {
            problems
                .error(load.form.place, "this is a second rigid footing")
                .help("the grid follows the footing, and it can follow only one");
        }
        Some(Load {
            name: load.name.value.clone(),
            kind,
        })
    };
    let all = things(Root::<D>::loads(tree));
    all.into_iter().map(load).collect()
}

impl Bearing<2> for Site {
    fn footing(
        &self,
        table: &Result<Footing<2>, Wrong>,
        name: &str,
        problems: &mut Problems,
    ) -> Option<LoadKind<2>> {
        footing(table.as_ref().ok()?, name, self, problems)
    }

    fn pressure(
        &self,
        table: &Pressure<2>,
        about: (&str, &[&[bool]]),
        problems: &mut Problems,
    ) -> Option<LoadKind<2>> {
        pressure(table, about, self, problems)
    }

    fn patch(
        &self,
        _table: &Result<Patch, Wrong>,
        (_, _, form, _): (&str, Place, Place, &[&[bool]]),
        problems: &mut Problems,
    ) -> Option<LoadKind<2>> {
        problems
            .error(form, "a patch is a load in space")
            .help("in plane strain use a load of type pressure");
        None
    }
}

fn footing(
    footing: &Footing<2>,
    name: &str,
    site: &Site,
    problems: &mut Problems,
) -> Option<LoadKind<2>> {
    let (a, b) = (*footing.from, *footing.to);
    let (from, to) = if a[0] <= b[0] { (a, b) } else { (b, a) };
    let shown = clip(name, 40);
    if (from[1] - to[1]).abs() > site.round_off {
        problems
            .error(
                footing.to.place,
                format!("the base of the footing `{shown}` is not level"),
            )
            .help(format!(
                "give both ends the same y, like \"{} m\"",
                number(a[1])
            ));
        return None;
    }
    if to[0] - from[0] <= site.round_off {
        let message = format!("the footing `{shown}` has no width");
        problems.error(footing.to.place, message);
        return None;
    }
    if let Some(frame) = &site.frame {
        let is_outside = [from, to].iter().any(|end| {
            (0..2).any(|k| {
                end[k] < frame.lower[k] - site.round_off || end[k] > frame.upper[k] + site.round_off
            })
        });
        if is_outside {
            problems
                .error(
                    footing.from.place,
                    format!("the footing `{shown}` lies outside the grid domain"),
                )
                .help("extend [grid] domain");
            return None;
        }
        on_grid(footing, &shown, [from, to], site, problems);
    }
    if site.is_complete {
        on_ground(footing, &shown, [from, to], site, problems);
    }
    Some(LoadKind::RigidFooting {
        from,
        to,
        rough: *footing.interface == FootingInterface::Rough,
        reaction_factor: *footing.reaction_factor,
    })
}

/// Checks that a footing stands on the tops of bodies all along.
fn on_ground(
    footing: &Footing<2>,
    name: &str,
    [from, to]: [[f64; 2]; 2],
    site: &Site,
    problems: &mut Problems,
) {
    let mut tops: Vec<_> = site
        .surface()
        .iter()
        .filter(|edge| {
            edge.iter()
                .all(|end| (end[1] - from[1]).abs() <= site.round_off)
        })
        .map(|edge| [edge[0][0], edge[1][0]])
        .collect();
    if cover(&mut tops, from[0], to[0], site.round_off) {
        return;
    }
    let mut levels: Vec<_> = (site.surface().iter())
        .filter(|edge| (edge[0][1] - edge[1][1]).abs() <= site.round_off)
        .map(|edge| {
            format!(
                "y = {} m from x = {} m to {} m",
                number(edge[0][1]),
                number(edge[0][0]),
                number(edge[1][0])
            )
        })
        .collect();
    levels.truncate(4);
    let problem = problems.error(
        footing.from.place,
        format!("the footing `{name}` does not stand on top of a body all along"),
    );
    if levels.is_empty() {
        problem.help("no body has a level top");
    } else {
        problem.help(format!("level ground: {}", levels.join("; ")));
    }
}

/// Checks a footing against the lines of the grid.
fn on_grid(
    footing: &Footing<2>,
    name: &str,
    [from, to]: [[f64; 2]; 2],
    site: &Site,
    problems: &mut Problems,
) {
    let Some(frame) = &site.frame else { return };
    let Frame { lower, upper, axes } = frame;
    let place = footing.from.place;
    let row = axes[1].place(from[1]);
    if (row - row.round()).abs() > 1e-6 {
        let depth = from[1] - lower[1];
        let problem = problems.error(
            place,
            format!(
                "the base of the footing `{name}` is not on a line of the grid: \
                     it lies {} cells above the bottom",
                number(row)
            ),
        );
        if let AxisSpec::Equal { .. } = axes[1] {
            problem.help(format!(
                "a cell of height {} m has a line there",
                number(depth / row.round().max(1.0))
            ));
        }
        problem.help(format!(
            "lines = {{ y = [\"{} m\"] }} in [grid] puts one there",
            number(from[1])
        ));
    }
    for end in [&footing.from, &footing.to] {
        let [x, _] = **end;
        if x - lower[0] <= site.round_off || upper[0] - x <= site.round_off {
            continue;
        }
        let column = axes[0].place(x);
        if (column - column.floor() - 0.5).abs() > 1e-6 {
            let problem = problems.warning(
                end.place,
                format!(
                    "the edge of the footing `{name}` at x = {} m is not in the middle of a cell",
                    number(x)
                ),
            );
            problem.help("the footing then acts up to half a cell wider");
            if let Some(help) = better_cell(x - lower[0], [from[0], to[0]], frame) {
                problem.help(help);
            }
        }
    }
}

/// A width of cells that has the edges of a footing mid-cell and fills the domain.
fn better_cell(edge: f64, ends: [f64; 2], frame: &Frame<2>) -> Option<String> {
    let Frame { lower, upper, axes } = frame;
    let AxisSpec::Equal { cell, .. } = axes[0] else {
        return None;
    };
    let extent = upper[0] - lower[0];
    let fits = |halves: f64| {
        let width = 2.0 * edge / halves;
        let near = |x: f64, to: f64| (x - to).abs() < 1e-6;
        let columns = extent / width;
        near(columns, columns.round())
            && ends.iter().all(|end| {
                let column = (end - lower[0]) / width;
                let is_side = near(column, 0.0) || near(column, columns);
                is_side || near(column - column.floor(), 0.5)
            })
    };
    let now = 2.0 * edge / cell;
    let odd = 2.0 * (0.5 * now).floor() + 1.0;
    let mut candidates: Vec<f64> = (-20..=20)
        .map(|k| odd + 2.0 * f64::from(k))
        .filter(|&halves| halves >= 1.0 && fits(halves))
        .collect();
    let off = |halves: &f64| (2.0 * edge / halves - cell).abs();
    candidates.sort_by(|a, b| off(a).total_cmp(&off(b)));
    let halves = candidates.first()?;
    let width = format!("{}/{} m", number(2.0 * edge), number(*halves));
    Some(format!(
        "with cell = {{ x = \"{width}\", y = \"{} m\" }} it is",
        number(axes[1].extremes()[1])
    ))
}

fn pressure(
    load: &Pressure<2>,
    (name, scenes): (&str, &[&[bool]]),
    site: &Site,
    problems: &mut Problems,
) -> Option<LoadKind<2>> {
    let (from, to) = (*load.from, *load.to);
    let is_down = *load.direction == PressureDirection::Down;
    let along = [to[0] - from[0], to[1] - from[1]];
    let length = along[0].hypot(along[1]);
    let shown = clip(name, 40);
    if length <= site.round_off {
        problems.error(
            load.to.place,
            format!("the segment of the pressure `{shown}` has no length"),
        );
        return None;
    }
    let left = [-along[1] / length, along[0] / length];
    let mut inward = is_down.then_some([0.0, -1.0]);
    if site.is_complete {
        let normal = soil_side(load, (&shown, scenes), left, site, problems)?;
        inward = inward.or(Some(normal));
    }
    let inward = inward?;
    Some(LoadKind::Pressure {
        from,
        to,
        traction: inward.map(|component| component * *load.pressure + 0.0),
    })
}

/// Places along a segment at which soil is looked for.
const SAMPLES: u32 = 21;

/// How many places along a segment have soil on the left alone, on the right alone, and on both sides; of the bodies that are
/// there, if they are stated.
fn soil_beside(
    load: &Pressure<2>,
    left: [f64; 2],
    (site, present): (&Site, Option<&[bool]>),
) -> [u32; 3] {
    let (from, to) = (*load.from, *load.to);
    let length = (to[0] - from[0]).hypot(to[1] - from[1]);
    let step = 1e-2 * site.cell().min(length);
    let mut found = [0; 3];
    for k in 0..SAMPLES {
        let t = (f64::from(k) + 0.5) / f64::from(SAMPLES);
        let at = [
            from[0] + t * (to[0] - from[0]),
            from[1] + t * (to[1] - from[1]),
        ];
        let is_soil = |side: f64| {
            let beside = [at[0] + side * step * left[0], at[1] + side * step * left[1]];
            site.is_inside(present, beside)
        };
        match (is_soil(1.0), is_soil(-1.0)) {
            (true, true) => found[2] += 1,
            (true, false) => found[0] += 1,
            (false, true) => found[1] += 1,
            (false, false) => {}
        }
    }
    found
}

/// The normal of a segment that points into the soil of the stages in which it is loaded; reports a segment that is not on a
/// surface there.
fn soil_side(
    load: &Pressure<2>,
    (name, scenes): (&str, &[&[bool]]),
    left: [f64; 2],
    site: &Site,
    problems: &mut Problems,
) -> Option<[f64; 2]> {
    let found = scenes
        .iter()
        .map(|present| soil_beside(load, left, (site, Some(*present))));
    // A load on soil that is not there is refused where the stage applies it.
    let mut found: Vec<_> = found.filter(|counts| *counts != [0; 3]).collect();
    if found.is_empty() {
        found.push(soil_beside(load, left, (site, None)));
    }
    let is_on = |side: usize| found.iter().all(|counts| counts[side] == SAMPLES);
    if is_on(0) {
        return Some(left);
    }
    if is_on(1) {
        return Some(left.map(|component| -component));
    }
    let is_wrong = |counts: &&[u32; 3]| counts[0] < SAMPLES && counts[1] < SAMPLES;
    let message = match found.iter().find(is_wrong) {
        Some([0, 0, 0]) => format!("no body lies along the segment of the pressure `{name}`"),
        Some([_, _, buried]) if *buried > 0 => {
            format!("the segment of the pressure `{name}` lies inside the soil, not on its surface")
        }
        Some(_) => format!(
            "only a part of the segment of the pressure `{name}` lies on the surface of a body"
        ),
        None => format!(
            "soil lies on one side of the segment of the pressure `{name}` in one stage, and on the other in another"
        ),
    };
    problems
        .error(load.from.place, message)
        .help("the segment follows the edge of a body, from one point of it to another");
    None
}

/// A force at a point of a body.
fn at_point<const D: usize>(
    load: &PointLoad<D>,
    name: &str,
    soil: &impl Soil<D>,
    problems: &mut Problems,
) -> LoadKind<D> {
    let (at, force) = (*load.at, *load.force);
    if soil.is_known() && !soil.holds_point(&at, 1e-2 * soil.cell()) {
        problems
            .error(
                load.at.place,
                format!(
                    "there is no body at {}, where `{}` acts",
                    point(at),
                    clip(name, 40)
                ),
            )
            .help("move the load onto a body");
    }
    LoadKind::Point { at, force }
}
