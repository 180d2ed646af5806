//! Reinforcement: its lines, whether soil holds them, and which stages install it.

pub(crate) mod space;

use igimp_model::{ReinforcementKind, ReinforcementPart, distance};
use igimp_schema::diagnostic::Problems;
use igimp_schema::text::{clip, number, point};
use igimp_schema::tree::Node;

use super::AllNames;
use super::bodies::site::{Site, Soil};
use crate::build::context::Context;

/// Places along a member at which soil is looked for.
const SAMPLES: u32 = 40;
/// A head this near to an edge of the soil lies on it, as a share of the cell \[-\].
const NEAR: f64 = 0.05;

/// The members in the plane.
pub(super) fn reinforcement(
    tree: &Node,
    site: &Site,
    problems: &mut Problems,
) -> Vec<Option<ReinforcementPart<2>>> {
    let nodes = tree.items_at("reinforcement").iter();
    let member = |node: &Node| {
        let mut own = part(tree, node, site, problems)?;
        let width = node.optional_number("plate").ok()?;
        if let Some(width) = width.filter(|&width| width > 0.0) {
            own.plate = Some(plate(&own, width, site).to_vec());
        }
        Some(own)
    };
    nodes.map(member).collect()
}

/// A member without its plate.
pub(super) fn part<const D: usize>(
    tree: &Node,
    node: &Node,
    soil: &dyn Soil<D>,
    problems: &mut Problems,
) -> Option<ReinforcementPart<D>> {
    let name = node.text_at("name")?;
    let shown = clip(name, 40);
    let kind = match node.text_at("type")? {
        "anchor" => ReinforcementKind::Anchor,
        "nail" => ReinforcementKind::Nail,
        _ => ReinforcementKind::Geotextile,
    };
    let (line, last) = if kind == ReinforcementKind::Geotextile {
        let points: Option<Vec<_>> = node.items_at("points").iter().map(Node::point).collect();
        (points?, "points")
    } else {
        (vec![node.point_at("head")?, node.point_at("end")?], "end")
    };
    let capacity = node.number_at("capacity")?;
    let at_head = node.optional_number("head_capacity").ok()?;
    let at_end = node.optional_number("end_capacity").ok()?;
    let mut part = ReinforcementPart {
        name: name.to_owned(),
        kind,
        line,
        stiffness: node.number_at("stiffness")?,
        capacity,
        bond: node.number_at("bond")?,
        fastened: [at_head.unwrap_or(capacity), at_end.unwrap_or(0.0)],
        free_length: 0.0,
        plate: None,
        prestress: node.optional_number("prestress").ok()?,
        reduces_bond: node.flag_at("reduce_bond")?,
        from_start: !installed(tree).any(|value| value.text() == Some(name)),
    };
    let short = part
        .line
        .windows(2)
        .any(|leg| distance(&leg[0], &leg[1]) <= soil.round_off());
    if short {
        problems.error(
            node.place_at(last),
            format!("a part of the {} `{shown}` has no length", kind.name()),
        );
        return None;
    }
    if let Some(bonded) = node.optional_number("bonded_length").ok()? {
        let length = part.length();
        if bonded > length {
            problems
                .error(
                    node.place_at("bonded_length"),
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
    let within = in_soil(node, &part, soil, problems);
    holds(node, &part, problems);
    within.then_some(part)
}

/// Everything that stages install.
fn installed(tree: &Node) -> impl Iterator<Item = &Node> {
    let stages = tree.items_at("stages").iter();
    stages.flat_map(|stage| stage.items_at("install"))
}

/// Refuses a member with a head, or a bonded part, where no soil is.
fn in_soil<const D: usize>(
    node: &Node,
    part: &ReinforcementPart<D>,
    soil: &dyn Soil<D>,
    problems: &mut Problems,
) -> bool {
    if !soil.is_known() {
        return true;
    }
    let length = part.length();
    let free = (0..=SAMPLES)
        .map(|k| f64::from(k) / f64::from(SAMPLES) * length)
        .filter(|&at| at == 0.0 || at >= part.free_length)
        .map(|at| place(&part.line, at))
        .find(|at| !soil.holds_point(at, 1e-2 * soil.cell()));
    let Some(at) = free else { return true };
    problems
        .error(
            node.place_at("name"),
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

/// Refuses what carries nothing, and a prestress that the member does not carry.
fn holds<const D: usize>(node: &Node, part: &ReinforcementPart<D>, problems: &mut Problems) {
    let (name, kind) = (clip(&part.name, 40), part.kind.name());
    let length = part.length();
    let most = (0..=SAMPLES)
        .map(|k| part.limit(f64::from(k) / f64::from(SAMPLES) * length))
        .fold(0.0, f64::max);
    if most <= 0.0 {
        problems
            .error(
                node.place_at("bond"),
                format!("nothing holds the {kind} `{name}`: it has no bond"),
            )
            .help("give it a bond, as bond = \"30 kPa\"");
        return;
    }
    let Some(prestress) = part.prestress else {
        return;
    };
    let limit = part.limit(0.0);
    if prestress > limit {
        problems
            .error(
                node.place_at("prestress"),
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
                node.place_at("prestress"),
                format!("no stage installs the anchor `{name}`, so nothing stresses it"),
            )
            .help(format!(
                "add install = [\"{name}\"] to the stage in which it is stressed"
            ));
    }
}

/// The members that a stage installs.
pub(super) fn installs<const D: usize>(
    context: &Context<'_, D>,
    index: usize,
    node: &Node,
    name: &str,
    problems: &mut Problems,
) -> Option<Vec<usize>> {
    let who = format!("stage `{name}` installs");
    let values = node.items_at("install");
    if let (Some(value), Some(kind @ ("strength-reduction" | "run-out"))) =
        (values.first(), node.text_at("type"))
    {
        problems
            .error(
                value.place,
                format!("a stage of type {kind} installs nothing"),
            )
            .help("install it in a stage of type gravity, load, rigid, construction or displacement before");
        return None;
    }
    let mut members = Vec::new();
    for value in values {
        let member = context.names.reinforcement.find(value, &who, problems)?;
        let earlier = context.before(index).any(|stage| {
            let named = stage.items_at("install").iter();
            named
                .filter_map(Node::text)
                .any(|own| Some(own) == value.text())
        });
        if earlier || members.contains(&member) {
            problems
                .error(
                    value.place,
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

/// Refuses a search that begins anew, with bodies in which a stage has installed nothing yet.
pub(super) fn check_searches(tree: &Node, names: &AllNames, problems: &mut Problems) {
    let mut named = installed(tree).filter_map(Node::text);
    let Some(first) = named.find(|name| names.reinforcement.position(name).is_some()) else {
        return;
    };
    for stage in tree.items_at("stages") {
        if stage.text_at("path") == Some("gravity") {
            problems
                .error(
                    stage.place_at("path"),
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
