//! Conditions of the water.

pub(crate) mod checks;

use igimp_model::{BodyPart, Material, PoreSource, WaterCondition};
use igimp_schema::diagnostic::Problems;
use igimp_schema::text::{clip, number};
use igimp_schema::tree::Node;

use super::bodies::sequence::{Scene, Sequence};
use super::bodies::surfaces::terrain;
use super::ground::{Earth, Surface, UprightFace};
use super::{AllNames, gravity};

/// What conditions of the water are held against.
pub(super) struct Around<'a, const D: usize> {
    pub(super) tree: &'a Node,
    pub(super) names: &'a AllNames,
    pub(super) earth: &'a dyn Earth<D>,
    pub(super) bodies: &'a [Option<BodyPart<D>>],
    pub(super) materials: &'a [Option<Material>],
    pub(super) sequence: &'a Sequence,
}

impl<const D: usize> Around<'_, D> {
    pub(super) fn surface(&self, scene: &Scene) -> Box<dyn Surface> {
        let fills_gaps = self.tree.items_at("rigid").is_empty();
        self.earth.surface(&scene.present, fills_gaps)
    }
}

const FORMS: &str = "write one of level = \"24 m\", line = [[\"0 m\", \"24 m\"], [\"60 m\", \"20 m\"]], inside and outside, \
                     r_u = 0.25, u = { raster = \"u.csv\" }, dry = true";
const OWN_FORMS: &str = "write one of level = \"24 m\", line = [[\"0 m\", \"24 m\"], [\"60 m\", \"20 m\"]], r_u = 0.25, \
                         u = { raster = \"u.csv\" }, dry = true";

/// The conditions.
pub(super) fn conditions<const D: usize>(
    around: &Around<'_, D>,
    problems: &mut Problems,
) -> Vec<Option<WaterCondition>> {
    let items = around.tree.items_at("water");
    let conditions: Vec<_> = items
        .iter()
        .enumerate()
        .map(|(index, node)| condition(around, index, node, problems))
        .collect();
    let is_wet = |condition: &WaterCondition| {
        let own = condition.bodies.iter().map(|(_, own)| own);
        own.chain([&condition.source])
            .any(|own| *own != PoreSource::Dry)
    };
    if let (Some(0.0), Some(index)) = (
        gravity(around.tree),
        (conditions.iter()).position(|condition| condition.as_ref().is_some_and(is_wet)),
    ) {
        problems
            .error(
                items[index].place,
                "there is water, but gravity is 0: water presses by its weight",
            )
            .help("set gravity in [case], or write dry = true");
    }
    conditions
}

fn condition<const D: usize>(
    around: &Around<'_, D>,
    index: usize,
    node: &Node,
    problems: &mut Problems,
) -> Option<WaterCondition> {
    let name = clip(node.text_at("name").unwrap_or("?"), 40);
    let who = format!("the water `{name}`");
    let source = match form(node, &who, &["inside", "outside"], FORMS, problems) {
        Some("inside" | "outside") => drawdown(around, index, node, &who, problems),
        Some(form) => source_of(node, form, &who, problems),
        None => None,
    };
    let mut bodies: Vec<(usize, PoreSource)> = Vec::new();
    let mut is_right = true;
    for own in node.items_at("bodies") {
        let asks = format!("{who} names");
        let body = own.get("body");
        let body = body.and_then(|body| around.names.bodies.find(body, &asks, problems));
        let form = form(own, &who, &[], OWN_FORMS, problems);
        let own_source = form.and_then(|form| source_of(own, form, &who, problems));
        let (Some(body), Some(own_source)) = (body, own_source) else {
            is_right = false;
            continue;
        };
        if bodies.iter().any(|(other, _)| *other == body) {
            problems.error(own.place_at("body"), "this body is named twice");
        }
        bodies.push((body, own_source));
    }
    is_right.then_some(())?;
    Some(WaterCondition {
        name: node.text_at("name")?.to_owned(),
        source: source?,
        bodies,
        carried: node.flag_at("carried")?,
    })
}

/// The key that says where the pressure comes from; reports none and several.
fn form(
    node: &Node,
    who: &str,
    more: &[&'static str],
    forms: &str,
    problems: &mut Problems,
) -> Option<&'static str> {
    let keys = ["level", "line", "surface", "r_u", "u", "dry"]
        .iter()
        .chain(more);
    let is_said = |key: &str| {
        node.get(key)
            .is_some_and(|value| value.flag() != Some(false))
    };
    let mut given: Vec<&'static str> = keys.copied().filter(|key| is_said(key)).collect();
    if given.ends_with(&["inside", "outside"]) {
        given.pop();
    }
    match given.as_slice() {
        [] => {
            let message = format!("{who} does not say where its pressure comes from");
            problems.error(node.place, message).help(forms);
            None
        }
        [one] => Some(one),
        [.., last] => {
            let message = format!(
                "{who} has several sources of pressure: {}",
                given.join(", ")
            );
            problems
                .error(node.place_at(last), message)
                .help("keep one of them; bodies = [{ body = \"clay\", level = \"20 m\" }] gives a body its own");
            None
        }
    }
}

/// The source that a key states.
fn source_of(node: &Node, form: &str, who: &str, problems: &mut Problems) -> Option<PoreSource> {
    let value = node.get(form)?;
    Some(match form {
        "level" => PoreSource::Table(vec![[0.0, value.number()?]]),
        "line" => {
            let points: Option<Vec<_>> = value.items().iter().map(Node::pair).collect();
            let points = points?;
            if let Some(k) = (1..points.len()).find(|&k| points[k][0] <= points[k - 1][0]) {
                problems
                    .error(
                        value.items()[k].place,
                        format!(
                            "the line of {who} does not go on to the right: x = {} m after {} m",
                            number(points[k][0]),
                            number(points[k - 1][0])
                        ),
                    )
                    .help("name its points from left to right, each x greater than the one before");
                return None;
            }
            PoreSource::Table(points)
        }
        "surface" => PoreSource::Surface(terrain(value, &who, problems)?),
        "r_u" => {
            let ratio = value.number()?;
            if !(0.0..=1.0).contains(&ratio) {
                problems
                    .error(
                        value.place,
                        format!(
                            "r_u is {}, but the pressure is a share of the weight above",
                            number(ratio)
                        ),
                    )
                    .help(
                        "r_u lies from 0, dry, to 1; half of it is about water up to the surface",
                    );
                return None;
            }
            PoreSource::Ratio(ratio)
        }
        "u" => PoreSource::Points(super::materials::profiles::points(value, "u", problems).ok()?),
        _ => PoreSource::Dry,
    })
}

/// The table of `inside` and `outside`.
fn drawdown<const D: usize>(
    around: &Around<'_, D>,
    index: usize,
    node: &Node,
    who: &str,
    problems: &mut Problems,
) -> Option<PoreSource> {
    let (inside, outside) = (
        node.optional_number("inside"),
        node.optional_number("outside"),
    );
    let (inside, outside) = (inside.ok()?, outside.ok()?);
    let (Some(inside), Some(outside)) = (inside, outside) else {
        let (has, lacks) = if inside.is_some() {
            ("inside", "outside")
        } else {
            ("outside", "inside")
        };
        problems
            .error(
                node.place_at(has),
                format!("{who} has `{has}` without `{lacks}`"),
            )
            .help("inside is the level within the ground, outside that of the free water beside it")
            .help("for one level everywhere write level = \"24 m\"");
        return None;
    };
    if inside < outside {
        problems
            .error(
                node.place_at("outside"),
                format!("in {who} the water stands higher outside than inside"),
            )
            .help("inside and outside are for water that was drawn down; draw what flows in as line = [...]");
        return None;
    }
    if !around.earth.is_complete() {
        return None;
    }
    let surface = around.surface(around.sequence.first_with(index));
    match surface.drained(inside, outside) {
        Ok(source) => Some(source),
        Err(UprightFace { at, levels }) => {
            let [low, high] = levels;
            problems
                .error(
                    node.place_at("inside"),
                    format!(
                        "at {at} the ground drops upright, and the table of {who} with it from {} m to {} m",
                        number(high),
                        number(low)
                    ),
                )
                .help(match D {
                    2 => "nothing would hold the water behind that face; draw the table as line = [...] through its foot",
                    _ => "nothing would hold the water behind that face; draw the table as line = [...] or surface = {...} through its foot",
                });
            None
        }
    }
}
