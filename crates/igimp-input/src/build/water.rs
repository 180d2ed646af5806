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

/// The parts of a case around its water.
pub(super) struct Around<'a, const D: usize> {
    pub(super) tree: &'a Node,
    pub(super) names: &'a AllNames,
    pub(super) earth: &'a dyn Earth<D>,
    pub(super) bodies: &'a [Option<BodyPart<D>>],
    pub(super) materials: &'a [Option<Material>],
    pub(super) sequence: &'a Sequence,
    /// The conditions as they are stated.
    pub(super) stated: &'a [Thing<Water>],
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
const BODY_FORMS: &str = "write one of level = \"24 m\", line = [[\"0 m\", \"24 m\"], [\"60 m\", \"20 m\"]], r_u = 0.25, \
                         u = { raster = \"u.csv\" }, dry = true";

/// The conditions.
pub(super) fn conditions<const D: usize>(
    around: &Around<'_, D>,
    problems: &mut Problems,
) -> Vec<Option<WaterCondition>> {
    let items = around.stated.iter().enumerate();
    let conditions: Vec<_> = items
        .map(|(index, water)| condition(around, index, water.as_ref()?, problems))
        .collect();
    let is_wet = |condition: &WaterCondition| {
        let mut sources = condition.bodies.iter().map(|(_, source)| source);
        condition.source != PoreSource::Dry || sources.any(|source| *source != PoreSource::Dry)
    };
    if let (Some(0.0), Some(index)) = (
        gravity(around.tree),
        (conditions.iter()).position(|condition| condition.as_ref().is_some_and(is_wet)),
    ) {
        problems
            .error(
                around.stated[index].as_ref().map(|water| water.place),
                "there is water, but gravity is 0: water presses by its weight",
            )
            .help("set gravity in [case], or write dry = true");
    }
    conditions
}

fn condition<const D: usize>(
    around: &Around<'_, D>,
    index: usize,
    water: &At<Water>,
    problems: &mut Problems,
) -> Option<WaterCondition> {
    let name = clip(&water.name, 40);
    let subject = format!("the water `{name}`");
    let levels = [water.inside.as_ref(), water.outside.as_ref()];
    let form = form(
        (&water.tables, &water.pressures, levels),
        water.seepage.as_ref(),
        (water.place, &subject, FORMS),
        problems,
    );
    let source = match form {
        Some(Form::Seepage(stated)) => {
            seepage::source(around, (water, index), stated, &subject, problems)
        }
        Some(Form::Drawdown) => drawdown(around, index, water, &subject, problems),
        Some(form) => source_of(&form, &subject, problems),
        None => None,
    };
    let mut bodies: Vec<(usize, PoreSource)> = Vec::new();
    let mut is_right = true;
    for entry in water.bodies.iter() {
        let Ok(entry) = entry else {
            is_right = false;
            continue;
        };
        let asks = format!("{subject} names");
        let body = around.names.bodies.find(&entry.body, &asks, problems);
        let form = self::form(
            (&entry.tables, &entry.pressures, [None; 2]),
            None,
            (entry.place, &subject, BODY_FORMS),
            problems,
        );
        let local = form.and_then(|form| source_of(&form, &subject, problems));
        let (Some(body), Some(local)) = (body, local) else {
            is_right = false;
            continue;
        };
        if bodies.iter().any(|(other, _)| *other == body) {
            problems.error(entry.body.place, "this body is named twice");
        }
        bodies.push((body, local));
    }
    is_right.then_some(())?;
    Some(WaterCondition {
        name: water.name.known()?,
        source: source?,
        bodies,
        carried: *water.carried,
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
    (place, subject, forms): (Place, &str, &str),
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
        (None, outside) => outside.map(|outside| ("outside", outside.place)),
    };
    let stated = [
        (level.as_ref()).map(|value| ("level", value.place, Form::Level(value))),
        (line.as_ref()).map(|value| ("line", value.place, Form::Line(value))),
        (surface.as_ref()).map(|value| ("surface", value.place, Form::Surface(value))),
        (r_u.as_ref()).map(|value| ("r_u", value.place, Form::Ratio(value))),
        (u.as_ref()).map(|value| ("u", value.place, Form::Points(value))),
        seepage.map(|value| ("seepage", value.place, Form::Seepage(value))),
        dry.map(|value| ("dry", value.place, Form::Dry)),
        drawn_down.map(|(key, place)| (key, place, Form::Drawdown)),
    ];
    let mut stated: Vec<_> = stated.into_iter().flatten().collect();
    if let [.., (_, last, _)] = stated[..]
        && stated.len() > 1
    {
        let keys: Vec<&str> = stated.iter().map(|(key, ..)| *key).collect();
        let keys = keys.join(", ");
        let message = format!("{subject} has several sources of pressure: {keys}");
        problems
            .error(last, message)
            .help("keep one of them; bodies = [{ body = \"clay\", level = \"20 m\" }] gives a body its own");
        return None;
    }
    if stated.is_empty() {
        let message = format!("{subject} does not say where its pressure comes from");
        problems.error(place, message).help(forms);
    }
    stated.pop().map(|(.., form)| form)
}

/// The source that is stated.
fn source_of(form: &Form<'_>, subject: &str, problems: &mut Problems) -> Option<PoreSource> {
    Some(match form {
        Form::Level(level) => PoreSource::Table(vec![[0.0, ***level]]),
        Form::Line(line) => {
            let points: Vec<_> = line.iter().map(|point| **point).collect();
            if let Some(k) = (1..points.len()).find(|&k| points[k][0] <= points[k - 1][0]) {
                problems
                    .error(
                        line[k].place,
                        format!(
                            "the line of {subject} does not go on to the right: x = {} m after {} m",
                            number(points[k][0]),
                            number(points[k - 1][0])
                        ),
                    )
                    .help("name its points from left to right, each x greater than the one before");
                return None;
            }
            PoreSource::Table(points)
        }
        Form::Surface(top) => PoreSource::Surface(terrain(top, top.place, &subject, problems)?),
        Form::Ratio(value) => {
            let ratio = ***value;
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
        Form::Points(field) => PoreSource::Points(points(field, field.place, "u", problems).ok()?),
        Form::Dry | Form::Drawdown | Form::Seepage(_) => PoreSource::Dry,
    })
}

/// The table of `inside` and `outside`.
fn drawdown<const D: usize>(
    around: &Around<'_, D>,
    index: usize,
    water: &At<Water>,
    subject: &str,
    problems: &mut Problems,
) -> Option<PoreSource> {
    let (Some(inside), Some(outside)) = (&water.inside, &water.outside) else {
        let (has, lacks, place) = match &water.inside {
            Some(inside) => ("inside", "outside", inside.place),
            None => ("outside", "inside", water.outside.as_ref()?.place),
        };
        problems
            .error(place, format!("{subject} has `{has}` without `{lacks}`"))
            .help("inside is the level within the ground, outside that of the free water beside it")
            .help("for one level everywhere write level = \"24 m\"");
        return None;
    };
    if **inside < **outside {
        problems
            .error(
                outside.place,
                format!("in {subject} the water stands higher outside than inside"),
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
                        "at {at} the ground drops upright, and the table of {subject} with it from {} m to {} m",
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
