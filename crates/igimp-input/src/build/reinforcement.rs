//! Reinforcement: its lines, whether soil holds them, and which stages install it.

pub(crate) mod space;

use igimp_model::{ReinforcementKind, ReinforcementPart, distance};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::grid::Side;
use igimp_schema::schema::reinforcement::{Member, MemberForm};
use igimp_schema::schema::stages::{ReductionPath, Stage, StageForm, StopWhen};
use igimp_schema::source::Place;
use igimp_schema::text::{clip, number, point};
use igimp_schema::tree::Node;
use igimp_schema::tree::read::At;

use super::bodies::site::{Site, Soil};
use super::{AllNames, things};
use crate::build::Thing;
use crate::build::context::{About, Context};

/// Places along a member at which soil is looked for.
const SAMPLES: u32 = 40;
/// An end this near to a side of the grid lies on it, as a share of the cell \[-\].
const ON_SIDE: f64 = 1e-2;
/// Places by cell along a plate at which soil is looked for, as many as hold it, and their most.
const PER_CELL: f64 = 4.0;
const MOST_PLACES: f64 = 100.0;
/// A head this near to an edge of the soil lies on it, as a share of the cell \[-\].
const NEAR: f64 = 0.05;

/// Soil that holds members.
pub(super) trait Holding<const D: usize>: Soil<D> {
    /// Refuses a member that there is none of in this analysis.
    fn refuses(&self, member: &Member<D>, problems: &mut Problems) -> bool;

    /// Corners of the plate at the head of a member.
    fn plate(&self, part: &ReinforcementPart<D>, width: f64) -> Vec<[f64; D]>;
}

/// The members.
pub(super) fn members<const D: usize>(
    tree: &Node,
    soil: &impl Holding<D>,
    stages: &[Thing<Stage>],
    problems: &mut Problems,
) -> Vec<Option<ReinforcementPart<D>>> {
    let all = things(Root::<D>::reinforcement(tree));
    let member = |member: Thing<Member<D>>| {
        let member = member?;
        if soil.refuses(&member, problems) {
            return None;
        }
        let (mut part, width) = part(&member, soil, stages, problems)?;
        if let MemberForm::Geotextile(Ok(form)) = &*member.form {
            let stated = [&form.head_capacity, &form.end_capacity].map(Option::is_some);
            for (k, ends) in ends_of(&part.line).into_iter().enumerate() {
                if !stated[k] && goes_on(tree, ends, soil) {
                    part.fastened[k] = part.capacity;
                }
            }
        }
        if width > 0.0 {
            let plate = soil.plate(&part, width);
            if is_off_soil((&member, &part.line[0]), &plate, soil, problems) {
                return None;
            }
            part.plate = Some(plate);
        }
        Some(part)
    };
    all.into_iter().map(member).collect()
}

impl Holding<2> for Site {
    fn refuses(&self, _member: &Member<2>, _problems: &mut Problems) -> bool {
        false
    }

    fn plate(&self, part: &ReinforcementPart<2>, width: f64) -> Vec<[f64; 2]> {
        plate(part, width, self).to_vec()
    }
}

/// A member as it is stated by its type.
struct MemberKeys<'a, const D: usize> {
    kind: ReinforcementKind,
    line: Vec<[f64; D]>,
    /// Where the end of its line is said.
    last: Place,
    head_capacity: Option<&'a At<f64>>,
    end_capacity: Option<&'a At<f64>>,
    bonded_length: Option<&'a At<f64>>,
    prestress: Option<&'a At<f64>>,
    /// Width of its plate \[m\].
    plate: f64,
}

fn stated<const D: usize>(form: &MemberForm<D>) -> Option<MemberKeys<'_, D>> {
    Some(match form {
        MemberForm::Anchor(anchor) => {
            let anchor = anchor.as_ref().ok()?;
            MemberKeys {
                kind: ReinforcementKind::Anchor,
                line: vec![*anchor.ends.head, *anchor.ends.end],
                last: anchor.ends.end.place,
                head_capacity: anchor.head_capacity.as_ref(),
                end_capacity: None,
                bonded_length: Some(&anchor.bonded_length),
                prestress: anchor.prestress.as_ref(),
                plate: *anchor.plate.width,
            }
        }
        MemberForm::Nail(nail) => {
            let nail = nail.as_ref().ok()?;
            MemberKeys {
                kind: ReinforcementKind::Nail,
                line: vec![*nail.ends.head, *nail.ends.end],
                last: nail.ends.end.place,
                head_capacity: Some(&nail.head_capacity),
                end_capacity: None,
                bonded_length: None,
                prestress: None,
                plate: *nail.plate.width,
            }
        }
        MemberForm::Geotextile(textile) => {
            let textile = textile.as_ref().ok()?;
            MemberKeys {
                kind: ReinforcementKind::Geotextile,
                line: textile.points.iter().map(|point| **point).collect(),
                last: textile.points.place,
                head_capacity: textile.head_capacity.as_ref(),
                end_capacity: textile.end_capacity.as_ref(),
                bonded_length: None,
                prestress: None,
                plate: 0.0,
            }
        }
    })
}

/// A member without its plate, and the width of that.
fn part<const D: usize>(
    member: &Member<D>,
    soil: &impl Soil<D>,
    stages: &[Thing<Stage>],
    problems: &mut Problems,
) -> Option<(ReinforcementPart<D>, f64)> {
    let name = member.name.as_str();
    let shown = clip(name, 40);
    let (stated, common) = (stated(&member.form)?, member.common.as_ref().ok()?);
    let kind = stated.kind;
    let value = |key: Option<&At<f64>>| key.map(|x| **x);
    let at_head = match kind {
        ReinforcementKind::Geotextile => 0.0,
        ReinforcementKind::Anchor | ReinforcementKind::Nail => *common.capacity,
    };
    let mut part = ReinforcementPart {
        name: name.to_owned(),
        kind,
        line: stated.line,
        stiffness: *common.stiffness,
        capacity: *common.capacity,
        bond: *common.bond,
        fastened: [
            value(stated.head_capacity).unwrap_or(at_head),
            value(stated.end_capacity).unwrap_or(0.0),
        ],
        free_length: 0.0,
        plate: None,
        prestress: value(stated.prestress),
        reduces_bond: *common.reduce_bond,
        from_start: !all_installed(stages).any(|named| named.value == name),
    };
    let short = part
        .line
        .windows(2)
        .any(|leg| distance(&leg[0], &leg[1]) <= soil.round_off());
    if short {
        problems.error(
            stated.last,
            format!("a part of the {} `{shown}` has no length", kind.name()),
        );
        return None;
    }
    if let Some(stated) = stated.bonded_length {
        let (bonded, length) = (**stated, part.length());
        if bonded > length {
            problems
                .error(
                    stated.place,
                    format!("the anchor `{shown}` is bonded over more than its length"),
                )
                .help(format!("from head to end it is {} m long", number(length)));
            return None;
        }
        part.free_length = if length - bonded <= soil.round_off() {
            0.0
        } else {
            length - bonded
        };
    }
    let within = in_soil(member.name.place, &part, soil, problems);
    holds(&part, common.bond.place, stated.prestress, problems);
    within.then_some((part, stated.plate))
}

/// The ends of a line, each with the point of the line beside it.
fn ends_of<const D: usize>(line: &[[f64; D]]) -> [[[f64; D]; 2]; 2] {
    let last = line.len() - 1;
    [[line[0], line[1]], [line[last], line[last - 1]]]
}

/// Whether a line that leaves an end towards a place ends there on a side of the grid that is a roller: a plane of symmetry, on whose
/// other side it goes on.
fn goes_on<const D: usize>(tree: &Node, [end, next]: [[f64; D]; 2], soil: &impl Soil<D>) -> bool {
    let stated = Root::<D>::boundaries(tree).ok();
    let sides = stated.as_ref().and_then(|table| table.by_axis());
    let (Some(sides), Some(faces)) = (sides, soil.ends()) else {
        return false;
    };
    let near = ON_SIDE * soil.cell();
    let is_at =
        |x: &[f64; D], axis: usize, upper: usize| (x[axis] - faces[upper][axis]).abs() <= near;
    let ends_on = |axis: usize, upper: usize| {
        let is_roller = **sides[axis][upper] == Side::Roller;
        is_roller && is_at(&end, axis, upper) && !is_at(&next, axis, upper)
    };
    (0..D).any(|axis| [0, 1].into_iter().any(|upper| ends_on(axis, upper)))
}

/// Refuses a plate of which a part is farther off any soil than the cells that carry it.
fn is_off_soil<const D: usize>(
    (member, head): (&Member<D>, &[f64; D]),
    plate: &[[f64; D]],
    soil: &impl Soil<D>,
    problems: &mut Problems,
) -> bool {
    let from = plate[0];
    let mut places = vec![from];
    for to in &plate[1..] {
        let count = (PER_CELL * distance(&from, to) / soil.cell())
            .ceil()
            .clamp(2.0, MOST_PLACES);
        let moved = |place: &[f64; D], k: usize| -> [f64; D] {
            let t = (k as f64 + 0.5) / count;
            std::array::from_fn(|axis| place[axis] + t * (to[axis] - from[axis]))
        };
        places = (0..count as usize)
            .flat_map(|k| places.iter().map(move |place| moved(place, k)))
            .collect();
    }
    let is_off = |at: &&[f64; D]| {
        let margins = [0.25, 0.5, 0.75].map(|share| share * soil.cell());
        !margins
            .into_iter()
            .any(|margin| soil.holds_point(at, margin))
    };
    let Some(at) = places.iter().find(is_off).filter(|_| soil.is_known()) else {
        return false;
    };
    problems
        .error(
            member.name.place,
            format!(
                "the plate of `{}`, about its head at {}, reaches {}, where there is no body",
                clip(&member.name, 40),
                point(*head),
                point(*at)
            ),
        )
        .help("use a smaller plate, or lay its head further from the edge of the ground; what lies beyond an upright side of the grid is cut off");
    true
}

/// Everything that stages install.
fn all_installed(stages: &[Thing<Stage>]) -> impl Iterator<Item = &At<String>> {
    stages.iter().flatten().flat_map(|stage| stage.installs())
}

/// Refuses a member with a head, or a bonded part, where no soil is.
fn in_soil<const D: usize>(
    name: Place,
    part: &ReinforcementPart<D>,
    soil: &impl Soil<D>,
    problems: &mut Problems,
) -> bool {
    if !soil.is_known() {
        return true;
    }
    let free = held_places(part).find(|at| !soil.holds_point(at, 1e-2 * soil.cell()));
    let Some(at) = free else { return true };
    problems
        .error(
            name,
            format!(
                "there is no body at {}, where the {} `{}` is held",
                point(at),
                part.kind.name(),
                clip(&part.name, 40)
            ),
        )
        .help("its head and all of its bonded length lie in soil, as [[bodies]] have it");
    false
}

/// Places at which soil holds a member: its head, and along its bonded length.
fn held_places<const D: usize>(part: &ReinforcementPart<D>) -> impl Iterator<Item = [f64; D]> {
    let length = part.length();
    (0..=SAMPLES)
        .map(move |k| f64::from(k) / f64::from(SAMPLES) * length)
        .filter(|&at| at == 0.0 || at >= part.free_length)
        .map(|at| place(&part.line, at))
}

/// The point of a line at a distance from its beginning.
fn place<const D: usize>(line: &[[f64; D]], mut at: f64) -> [f64; D] {
    for leg in line.windows(2) {
        let length = distance(&leg[0], &leg[1]);
        if at <= length {
            return std::array::from_fn(|axis| {
                leg[0][axis] + at / length * (leg[1][axis] - leg[0][axis])
            });
        }
        at -= length;
    }
    line[line.len() - 1]
}

/// The ends of a plate: along the edge of the soil on which the head lies, no further than that edge goes
/// to either side; else across the member.
fn plate(part: &ReinforcementPart<2>, width: f64, site: &Site) -> [[f64; 2]; 2] {
    let (head, next) = (part.line[0], part.line[1]);
    let apart = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]).hypot(b[1] - a[1]);
    let edges = site.polygons.iter().flat_map(|polygon| {
        let next = polygon.iter().cycle().skip(1);
        std::iter::zip(polygon, next)
    });
    let length = apart(head, next);
    let mut half = 0.5 * width;
    let mut along = [0, 1].map(|axis| [next[1] - head[1], head[0] - next[0]][axis] / length);
    for (p, q) in edges {
        let (edge, a, b) = (apart(*p, *q), apart(*p, head), apart(head, *q));
        if edge > 0.0 && a + b - edge <= NEAR * site.cell() {
            along = [(q[0] - p[0]) / edge, (q[1] - p[1]) / edge];
            half = half.min(a).min(b);
            break;
        }
    }
    [-half, half].map(|by| [head[0] + by * along[0], head[1] + by * along[1]])
}

/// Refuses a member that carries nothing, and a prestress that it cannot carry.
fn holds<const D: usize>(
    part: &ReinforcementPart<D>,
    bond: Place,
    prestress: Option<&At<f64>>,
    problems: &mut Problems,
) {
    let (name, kind) = (clip(&part.name, 40), part.kind.name());
    let length = part.length();
    let most = (0..=SAMPLES)
        .map(|k| part.limit(f64::from(k) / f64::from(SAMPLES) * length))
        .fold(0.0, f64::max);
    if most <= 0.0 {
        problems
            .error(
                bond,
                format!("nothing holds the {kind} `{name}`: it has no bond"),
            )
            .help("give it a bond, as bond = \"30 kPa\"");
        return;
    }
    let Some(prestress) = prestress else {
        return;
    };
    let limit = part.limit(0.0);
    if **prestress > limit {
        problems
            .error(
                prestress.place,
                format!("the anchor `{name}` does not carry its prestress"),
            )
            .help(format!(
                "capacity, head_capacity and bond times bonded_length leave it {} {}",
                number(limit / 1e3),
                if D == 2 { "kN/m" } else { "kN" }
            ));
    }
    if part.from_start {
        problems
            .error(
                prestress.place,
                format!("no stage installs the anchor `{name}`, so nothing stresses it"),
            )
            .help(format!(
                "add install = [\"{name}\"] to the stage in which it is stressed"
            ));
    }
}

/// The members that a stage installs.
pub(super) fn installs<const D: usize>(
    about: &About<'_, D>,
    problems: &mut Problems,
) -> Option<Vec<usize>> {
    let context = about.context;
    let subject = format!("stage `{}` installs", about.name);
    let values = about.stage.installs();
    if let Some(value) = values.first()
        && let StageForm::StrengthReduction(_) | StageForm::RunOut(_) = *about.stage.form
    {
        let kind = about.stage.form.name();
        problems
            .error(
                value.place,
                format!("a stage of type {kind} installs nothing"),
            )
            .help("install it in a stage of type gravity, load, rigid, construction, displacement or dynamic before");
        return None;
    }
    let mut members = Vec::new();
    for name in values {
        let member = context.names.reinforcement.find(name, &subject, problems)?;
        let mut before = context.before(about.index).flat_map(|past| past.installs());
        let earlier = before.any(|other| other.value == name.value);
        if earlier || members.contains(&member) {
            problems
                .error(
                    name.place,
                    format!(
                        "the reinforcement `{}` is installed twice",
                        clip(context.names.reinforcement.name(member), 40)
                    ),
                )
                .help("a stage keeps what the stages before it have installed");
            return None;
        }
        members.push(member);
    }
    Some(members)
}

/// Refuses an early end of a stage that stresses an anchor: its jack would lock off a part of the prestress.
pub(super) fn check_stressed<const D: usize>(
    about: &About<'_, D>,
    members: &[usize],
    stop: &StopWhen,
    problems: &mut Problems,
) {
    let all = things(Root::<D>::reinforcement(about.context.tree));
    let is_stressed = |&&member: &&usize| match all.get(member) {
        Some(Some(table)) => {
            matches!(&*table.form, MemberForm::Anchor(Ok(anchor)) if anchor.prestress.is_some())
        }
        _ => false,
    };
    let early = (stop.displacement.as_ref().map(|key| key.key_place))
        .or(stop.load_grows_less_than.as_ref().map(|key| key.key_place));
    if let (Some(place), Some(&member)) = (early, members.iter().find(is_stressed)) {
        let name = clip(about.context.names.reinforcement.name(member), 40);
        problems
            .error(
                place,
                format!(
                    "an early end would lock off `{name}` with a part of its prestress, which comes on over the stage"
                ),
            )
            .help(format!(
                "install = [\"{name}\"] in a stage of its own before, such as one of type gravity, and stop_when in the next"
            ));
    }
}

/// Refuses members in soil that is dug, or that is placed later: the run would end there.
pub(super) fn check_held<const D: usize>(
    context: &Context<'_, D>,
    members: &[Option<ReinforcementPart<D>>],
    problems: &mut Problems,
) {
    let soil = context.soil;
    if !soil.is_known() {
        return;
    }
    let all = things(Root::<D>::reinforcement(context.tree));
    for (part, member) in std::iter::zip(members, &all) {
        let (Some(part), Some(member)) = (part, member) else {
            continue;
        };
        let installs =
            |stage: &At<Stage>| stage.installs().iter().any(|name| name.value == part.name);
        let is_there = |stage: usize| {
            let here = context.stages[stage].iter();
            part.from_start || here.chain(context.before(stage)).any(installs)
        };
        let start = part.from_start.then_some((None, &context.sequence.start));
        let ends = (context.sequence.ends.iter().enumerate())
            .filter(|(stage, _)| is_there(*stage))
            .map(|(stage, scene)| (Some(stage), scene));
        let lost = start.into_iter().chain(ends).find_map(|(stage, scene)| {
            let at =
                held_places(part).find(|at| !soil.is_held_by(&scene.present, at, soil.cell()))?;
            Some((stage, at))
        });
        let Some((stage, at)) = lost else { continue };
        let stage = stage.and_then(|stage| context.stages[stage].as_ref());
        let when = match stage {
            Some(stage) => format!("in stage `{}`", clip(&stage.name, 40)),
            None => "from the start".to_owned(),
        };
        problems
            .error(
                member.name.place,
                format!(
                    "the {} `{}` is held at {}, where no soil is {when}",
                    part.kind.name(),
                    clip(&part.name, 40),
                    point(at)
                ),
            )
            .help("install it once all of its soil is there, and let it end where soil is dug");
    }
}

/// Refuses a search that begins anew, with bodies in which a stage has installed nothing yet.
pub(super) fn check_searches(stages: &[Thing<Stage>], names: &AllNames, problems: &mut Problems) {
    let mut named = all_installed(stages);
    let Some(first) = named.find(|name| names.reinforcement.position(name).is_some()) else {
        return;
    };
    for stage in stages.iter().flatten() {
        if let StageForm::StrengthReduction(Ok(search)) = &*stage.form
            && *search.path == ReductionPath::Gravity
        {
            problems
                .error(
                    search.path.place,
                    format!(
                        "this search raises gravity on undeformed bodies, in which nothing is installed, as \
                         `{}`",
                        clip(first, 40)
                    ),
                )
                .help("use path = \"reduce\", or leave out `install`: what no stage installs is there from the start");
        }
    }
}
