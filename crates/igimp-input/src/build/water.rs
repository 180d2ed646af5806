//! Conditions of the water.

pub(crate) mod checks;
pub(crate) mod seepage;

use igimp_model::{BodyPart, Material, PoreSource, WaterCondition};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::materials::Points;
use igimp_schema::schema::solids::Terrain;
use igimp_schema::schema::stages::Stage;
use igimp_schema::schema::water::{Seepage, Water, WaterPressures, WaterTables};
use igimp_schema::source::Place;
use igimp_schema::text::{clip, number};
use igimp_schema::tree::Node;
use igimp_schema::tree::read::At;

use super::bodies::sequence::{Scene, Sequence};
use super::bodies::surfaces::terrain;
use super::ground::{Earth, Surface, UprightFace};
use super::materials::profiles::points;
use super::{AllNames, gravity};
use crate::build::Thing;

/// What conditions of the water are held against.
pub(super) struct Around<'a, const D: usize> {
    pub(super) tree: &'a Node,
    pub(super) names: &'a AllNames,
    pub(super) earth: &'a dyn Earth<D>,
    pub(super) bodies: &'a [Option<BodyPart<D>>],
    pub(super) materials: &'a [Option<Material>],
    pub(super) sequence: &'a Sequence,
    /// The conditions as they are stated.
    pub(super) own: &'a [Thing<Water>],
    /// The stages as they are stated.
    pub(super) stages: &'a [Thing<Stage>],
    /// Whether there are rigid bodies.
    pub(super) has_rigid: bool,
}

impl<const D: usize> Around<'_, D> {
    pub(super) fn surface(&self, scene: &Scene) -> Box<dyn Surface> {
        let fills_gaps = !self.has_rigid;
        self.earth.surface(&scene.present, fills_gaps)
    }
}

const FORMS: &str = "write one of level = \"24 m\", line = [[\"0 m\", \"24 m\"], [\"60 m\", \"20 m\"]], inside and outside, \
                     r_u = 0.25, u = { raster = \"u.csv\" }, seepage = { ... }, dry = true";
const OWN_FORMS: &str = "write one of level = \"24 m\", line = [[\"0 m\", \"24 m\"], [\"60 m\", \"20 m\"]], r_u = 0.25, \
                         u = { raster = \"u.csv\" }, dry = true";

/// The conditions.
pub(super) fn conditions<const D: usize>(
    around: &Around<'_, D>,
    problems: &mut Problems,
) -> Vec<Option<WaterCondition>> {
    let items = around.own.iter().enumerate();
    let conditions: Vec<_> = items
        .map(|(index, own)| condition(around, index, own.as_ref()?, problems))
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
                around.own[index].as_ref().map(|own| own.place),
                "there is water, but gravity is 0: water presses by its weight",
            )
            .help("set gravity in [case], or write dry = true");
    }
    conditions
}

fn condition<const D: usize>(
    around: &Around<'_, D>,
    index: usize,
    own: &At<Water>,
    problems: &mut Problems,
) -> Option<WaterCondition> {
    let name = clip(&own.name, 40);
    let who = format!("the water `{name}`");
    let levels = [own.inside.as_ref(), own.outside.as_ref()];
    let form = form(
        (&own.tables, &own.pressures, levels),
        own.seepage.as_ref(),
        (own.place, &who, FORMS),
        problems,
    );
    let source = match form {
        Some(Form::Seepage(stated)) => {
            seepage::source(around, (own, index), stated, &who, problems)
        }
        Some(Form::Drawdown) => drawdown(around, index, own, &who, problems),
        Some(form) => source_of(&form, &who, problems),
        None => None,
    };
    let mut bodies: Vec<(usize, PoreSource)> = Vec::new();
    let mut is_right = true;
    for own in own.bodies.iter() {
        let Ok(own) = own else {
            is_right = false;
            continue;
        };
        let asks = format!("{who} names");
        let body = around.names.bodies.find(&own.body, &asks, problems);
        let form = self::form(
            (&own.tables, &own.pressures, [None; 2]),
            None,
            (own.place, &who, OWN_FORMS),
            problems,
        );
        let own_source = form.and_then(|form| source_of(&form, &who, problems));
        let (Some(body), Some(own_source)) = (body, own_source) else {
            is_right = false;
            continue;
        };
        if bodies.iter().any(|(other, _)| *other == body) {
            problems.error(own.body.place, "this body is named twice");
        }
        bodies.push((body, own_source));
    }
    is_right.then_some(())?;
    Some(WaterCondition {
        name: own.name.known()?,
        source: source?,
        bodies,
        carried: *own.carried,
    })
}

/// Where pressure comes from, as it is stated.
enum Form<'a> {
    Level(&'a At<f64>),
    Line(&'a At<Vec<At<[f64; 2]>>>),
    Surface(&'a At<Terrain>),
    Ratio(&'a At<f64>),
    Points(&'a At<Points>),
    Seepage(&'a At<Seepage>),
    Dry,
    Drawdown,
}

/// The key that says where the pressure comes from, with the levels `inside` and `outside`; reports none and several.
fn form<'a>(
    (tables, pressures, [inside, outside]): (
        &'a WaterTables,
        &'a WaterPressures,
        [Option<&At<f64>>; 2],
    ),
    seepage: Option<&'a At<Seepage>>,
    (place, who, forms): (Place, &str, &str),
    problems: &mut Problems,
) -> Option<Form<'a>> {
    let WaterTables {
        level,
        line,
        surface,
    } = tables;
    let WaterPressures { r_u, u, dry } = pressures;
    let dry = dry.as_ref().filter(|dry| dry.value);
    let drawn_down = match (inside, outside) {
        (Some(inside), _) => Some(("inside", inside.place)),
        (None, outside) => outside.map(|own| ("outside", own.place)),
    };
    let stated = [
        (level.as_ref()).map(|own| ("level", own.place, Form::Level(own))),
        (line.as_ref()).map(|own| ("line", own.place, Form::Line(own))),
        (surface.as_ref()).map(|own| ("surface", own.place, Form::Surface(own))),
        (r_u.as_ref()).map(|own| ("r_u", own.place, Form::Ratio(own))),
        (u.as_ref()).map(|own| ("u", own.place, Form::Points(own))),
        seepage.map(|own| ("seepage", own.place, Form::Seepage(own))),
        dry.map(|own| ("dry", own.place, Form::Dry)),
        drawn_down.map(|(key, place)| (key, place, Form::Drawdown)),
    ];
    let mut stated: Vec<_> = stated.into_iter().flatten().collect();
    if let [.., (_, last, _)] = stated[..]
        && stated.len() > 1
    {
        let keys: Vec<&str> = stated.iter().map(|(key, ..)| *key).collect();
        let message = format!("{who} has several sources of pressure: {}", keys.join(", "));
        problems
            .error(last, message)
            .help("keep one of them; bodies = [{ body = \"clay\", level = \"20 m\" }] gives a body its own");
        return None;
    }
    if stated.is_empty() {
        let message = format!("{who} does not say where its pressure comes from");
        problems.error(place, message).help(forms);
    }
    stated.pop().map(|(.., form)| form)
}

/// The source that is stated.
fn source_of(form: &Form<'_>, who: &str, problems: &mut Problems) -> Option<PoreSource> {
    Some(match form {
        Form::Level(level) => PoreSource::Table(vec![[0.0, ***level]]),
        Form::Line(line) => {
            let points: Vec<_> = line.iter().map(|own| **own).collect();
            if let Some(k) = (1..points.len()).find(|&k| points[k][0] <= points[k - 1][0]) {
                problems
                    .error(
                        line[k].place,
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
        Form::Surface(own) => PoreSource::Surface(terrain(own, own.place, &who, problems)?),
        Form::Ratio(own) => {
            let ratio = ***own;
            if !(0.0..=1.0).contains(&ratio) {
                problems
                    .error(
                        own.place,
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
        Form::Points(own) => PoreSource::Points(points(own, own.place, "u", problems).ok()?),
        Form::Dry | Form::Drawdown | Form::Seepage(_) => PoreSource::Dry,
    })
}

/// The table of `inside` and `outside`.
fn drawdown<const D: usize>(
    around: &Around<'_, D>,
    index: usize,
    own: &At<Water>,
    who: &str,
    problems: &mut Problems,
) -> Option<PoreSource> {
    let (Some(inside), Some(outside)) = (&own.inside, &own.outside) else {
        let (has, lacks, stated) = match &own.inside {
            Some(inside) => ("inside", "outside", inside),
            None => ("outside", "inside", own.outside.as_ref()?),
        };
        problems
            .error(stated.place, format!("{who} has `{has}` without `{lacks}`"))
            .help("inside is the level within the ground, outside that of the free water beside it")
            .help("for one level everywhere write level = \"24 m\"");
        return None;
    };
    if **inside < **outside {
        problems
            .error(
                outside.place,
                format!("in {who} the water stands higher outside than inside"),
            )
            .help("inside and outside are for water that was drawn down; draw what flows in as line = [...]");
        return None;
    }
    if !around.earth.is_complete() {
        return None;
    }
    let surface = around.surface(around.sequence.first_with(index));
    match surface.drained(**inside, **outside) {
        Ok(source) => Some(source),
        Err(UprightFace { at, levels }) => {
            let [low, high] = levels;
            problems
                .error(
                    inside.place,
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
