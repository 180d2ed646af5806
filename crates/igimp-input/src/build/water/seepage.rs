//! Seepage as it is stated, steady or in time.

use std::sync::Arc;

use igimp_model::{InTime, PoreSource, SeepageCase};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::water::{Seepage, SeepageFace, SeepageRegion, SeepageSection, Water};
use igimp_schema::source::Place;
use igimp_schema::text::{clip, number};
use igimp_schema::tree::Wrong;
use igimp_schema::tree::read::{At, Either};
use igimp_seepage::{Conditions, Curve, Extent, History, InGround, Named, OnFaces, Soil};

use super::{Around, Form, source_of};
use crate::build::bodies::reach::meets_box;

const FACES: &str = "write one of head = \"8 m\", inflow = \"1e-7 m/s\", recharge = \"800 mm/a\", open = true, closed = true";
const REGIONS: &str =
    "write one of head = \"8 m\", drain = true, discharge = ..., permeability = \"1e-9 m/s\"";

/// How far beside a section soil may lie that it meets, over its length \[-\].
const BESIDE: f64 = 1e-6;

/// The source that a condition of computed seepage states.
pub(super) fn source<const D: usize>(
    around: &Around<'_, D>,
    (condition, index): (&At<Water>, usize),
    flow: &At<Seepage>,
    label: &str,
    problems: &mut Problems,
) -> Option<PoreSource> {
    let before = problems.errors();
    if *condition.carried {
        problems
            .error(
                condition.carried.place,
                format!("{label} is computed, and cannot be carried along by the soil"),
            )
            .help("remove carried: the pressure is that of the place");
    }
    let free_water = free_water(around, index, flow, label, problems);
    let mut soils = Vec::new();
    let (faces, histories) = (flow.faces.iter().flatten())
        .filter_map(|table| {
            let (named, history) = face::<D>(table, problems).ok()?;
            meets_ground(around, (table.place, "face"), &named, problems).ok()?;
            Some((named, history))
        })
        .unzip();
    let in_time = in_time(around, index, flow, (label, histories), problems);
    without_effect(around, flow, problems);
    let regions = (flow.regions.iter().flatten())
        .filter_map(|table| {
            let named = region::<D>(table, &mut soils, problems).ok()?;
            meets_ground(around, (table.place, "region"), &named, problems).ok()?;
            Some(named)
        })
        .collect();
    let sections = (flow.sections.iter().flatten())
        .filter_map(|table| section(around, table, problems).ok())
        .collect();
    let is_read = flow.faces.iter().all(Result::is_ok)
        && flow.regions.iter().all(Result::is_ok)
        && flow.sections.iter().all(Result::is_ok);
    if problems.errors() > before || !is_read {
        return None;
    }
    Some(PoreSource::Seepage(Arc::new(SeepageCase {
        conditions: Conditions {
            soils,
            faces,
            regions,
            sections,
            axisymmetric: false,
            confined: *flow.confined,
            width: flow.fall.as_ref().map(|fall| **fall),
            floor: *flow.floor,
        },
        free_water,
        in_time: in_time.ok()?,
    })))
}

/// Warns of keys of the fall of permeability that nothing asks for: in full pores it does not fall, and a measured curve says how it does.
fn without_effect<const D: usize>(around: &Around<'_, D>, flow: &Seepage, problems: &mut Problems) {
    let materials = around.materials.iter().flatten();
    let soils = { materials }.filter_map(|soil| Some((soil, soil.permeability.as_ref()?)));
    let curved: Vec<&str> = (soils.clone().filter(|(_, soil)| soil.curve != Curve::Ramp))
        .map(|(material, _)| material.name.as_str())
        .collect();
    let has_ramp = soils.clone().any(|(_, soil)| soil.curve == Curve::Ramp)
        || flow
            .regions
            .iter()
            .flatten()
            .any(|region| region.permeability.is_some());
    let is_known = around.materials.iter().all(Option::is_some);
    if let Some(fall) = &flow.fall {
        let why = if *flow.confined {
            Some("all pores are full (`confined`)")
        } else {
            (is_known && !has_ramp && !curved.is_empty())
                .then_some("every soil has a curve of its own, `gardner` or `van_genuchten`")
        };
        if let Some(why) = why {
            problems
                .warning(fall.place, format!("`fall` has no effect: {why}"))
                .help("remove it");
        }
    }
    if let (true, Some(first)) = (*flow.confined, curved.first()) {
        problems
            .warning(
                flow.confined.place,
                format!(
                    "the curve of `{}` has no effect: all pores are full (`confined`)",
                    clip(first, 40)
                ),
            )
            .help("remove `confined` for a free surface, or the curve");
    }
}

/// The moment that is stated; none of a steady flow.
fn in_time<const D: usize>(
    around: &Around<'_, D>,
    index: usize,
    flow: &At<Seepage>,
    (label, histories): (&str, Vec<Option<History>>),
    problems: &mut Problems,
) -> Result<Option<InTime>, Wrong> {
    let Some(start) = &flow.start_from else {
        let stated = [
            flow.times.as_ref().map(|at| ("times", at.place)),
            flow.time.as_ref().map(|at| ("time", at.place)),
            (histories.iter().any(Option::is_some)).then_some(("a value in time", flow.place)),
        ];
        if let Some((key, place)) = stated.into_iter().flatten().next() {
            problems
                .error(place, format!("{label} has {key}, but its flow is steady"))
                .help("write start_from = \"NAME\", a condition whose computed, steady flow is that at the time 0");
            return Err(Wrong);
        }
        return Ok(None);
    };
    let Some(time) = &flow.time else {
        problems
            .error(start.place, format!("{label} has a start and no times"))
            .help("write times = [\"1 d\", \"10 d\"]");
        return Err(Wrong);
    };
    let asks = format!("{label} starts from");
    let waters = &around.names.water;
    let other = waters.find(start, &asks, problems).ok_or(Wrong)?;
    let stated = around.stated[other].as_ref().ok_or(Wrong)?;
    let is_steady = |seepage: &At<Seepage>| seepage.start_from.is_none();
    if other == index || !stated.seepage.as_ref().is_some_and(is_steady) {
        let name = clip(start, 40);
        problems
            .error(
                start.place,
                format!("the water `{name}` is no steady seepage that a flow could start from"),
            )
            .help("name a condition with seepage = { ... } and without start_from");
        return Err(Wrong);
    }
    Ok(Some(InTime {
        start: other,
        histories,
        time: **time,
    }))
}

/// Numbers in a list, if there is one.
type Samples<'a> = Option<&'a At<Vec<At<f64>>>>;

/// Values in time.
fn history(
    (time, values): (Samples<'_>, Samples<'_>),
    (place, label): (Place, &str),
    problems: &mut Problems,
) -> Result<History, Wrong> {
    let (Some(time), Some(values)) = (time, values) else {
        problems
            .error(place, format!("{label} has no values in time"))
            .help("write file = \"pool.csv\", or time and values");
        return Err(Wrong);
    };
    if time.len() != values.len() {
        let message = format!("{} times and {} values", time.len(), values.len());
        problems
            .error(values.place, message)
            .help("every time has one value");
        return Err(Wrong);
    }
    if let Some(pair) = time.windows(2).find(|pair| *pair[1] <= *pair[0]) {
        problems
            .error(pair[1].place, "this time is not after the one before")
            .help("times ascend, each once");
        return Err(Wrong);
    }
    Ok(History {
        times: time.iter().map(|moment| **moment).collect(),
        values: values.iter().map(|value| **value).collect(),
    })
}

/// The table of the free water.
fn free_water<const D: usize>(
    around: &Around<'_, D>,
    index: usize,
    flow: &Seepage,
    label: &str,
    problems: &mut Problems,
) -> Option<PoreSource> {
    match (&flow.free_water, &flow.of_water) {
        (Some(_), Some(second)) => {
            problems
                .error(
                    second.place,
                    format!("{label} has both `free_water` and `of_water`"),
                )
                .help("keep one of them");
            None
        }
        (Some(line), None) => source_of(&Form::Line(line), label, problems),
        (None, None) => None,
        (None, Some(name)) => {
            let other = around
                .names
                .water
                .find(name, &format!("{label} names"), problems)?;
            let stated = around.stated[other].as_ref()?;
            let tables = &stated.tables;
            let form = match (&tables.level, &tables.line, &tables.surface) {
                (Some(level), ..) => Some(Form::Level(level)),
                (_, Some(line), _) => Some(Form::Line(line)),
                (.., Some(surface)) => Some(Form::Surface(surface)),
                _ => None,
            };
            let Some(form) = form.filter(|_| other != index) else {
                problems
                    .error(name.place, format!("the water `{}` has no table that free water could stand at", clip(name, 40)))
                    .help("name a condition with level, line or surface, or write free_water = [[\"0 m\", \"8 m\"]]");
                return None;
            };
            source_of(&form, label, problems)
        }
    }
}

/// A box with as many axes as the analysis has.
pub(crate) fn extent<const D: usize>(
    from: &At<Vec<At<f64>>>,
    to: &At<Vec<At<f64>>>,
    problems: &mut Problems,
) -> Result<Extent<3>, Wrong> {
    let mut within = Extent {
        lower: [0.0; 3],
        upper: [0.0; 3],
    };
    for corner in [from, to] {
        if corner.len() != D {
            problems
                .error(
                    corner.place,
                    format!(
                        "a corner has {D} coordinates here, and not {}",
                        corner.len()
                    ),
                )
                .help("in plane strain write x and y, in space x, y and z");
            return Err(Wrong);
        }
    }
    for axis in 0..D {
        let [a, b] = [*from[axis], *to[axis]];
        (within.lower[axis], within.upper[axis]) = (a.min(b), a.max(b));
    }
    Ok(within)
}

/// The only key that is stated of several.
fn only<T>(
    stated: Vec<(&str, Place, T)>,
    (place, label, forms): (Place, &str, &str),
    problems: &mut Problems,
) -> Result<T, Wrong> {
    let keys: Vec<&str> = stated.iter().map(|(key, ..)| *key).collect();
    if let [.., (_, last, _)] = stated[..]
        && stated.len() > 1
    {
        problems
            .error(
                last,
                format!("{label} says several things: {}", keys.join(", ")),
            )
            .help("keep one of them");
        return Err(Wrong);
    }
    if stated.is_empty() {
        problems
            .error(place, format!("{label} does not say what holds there"))
            .help(forms);
    }
    stated.into_iter().next().map(|key| key.2).ok_or(Wrong)
}

fn is_set<'a>(key: &'a str, flag: Option<&At<bool>>) -> Option<(&'a str, Place)> {
    flag.filter(|flag| flag.value).map(|flag| (key, flag.place))
}

fn face<const D: usize>(
    face: &At<SeepageFace>,
    problems: &mut Problems,
) -> Result<(Named<3, OnFaces>, Option<History>), Wrong> {
    let label = format!("the face `{}`", clip(&face.name, 40));
    let mut in_time = None;
    let [head, recharge] = [
        (face.head.as_ref()).map(|stated| match &**stated {
            Either::First(one) => Ok((stated.place, *one)),
            Either::Second(rows) => Err((stated.place, rows.time.as_ref(), rows.values.as_ref())),
        }),
        (face.recharge.as_ref()).map(|stated| match &**stated {
            Either::First(one) => Ok((stated.place, *one)),
            Either::Second(rows) => Err((stated.place, rows.time.as_ref(), rows.values.as_ref())),
        }),
    ]
    .map(|stated| match stated? {
        Ok(one) => Some(one),
        Err((place, time, values)) => {
            let course = history((time, values), (place, &label), problems).ok()?;
            let first = course.values[0];
            in_time = Some(course);
            Some((place, first))
        }
    });
    let value = |key: &'static str, stated: Option<(Place, f64)>, of: fn(f64) -> OnFaces| {
        stated.map(|(place, amount)| (key, place, of(amount)))
    };
    let inflow = face.inflow.as_ref().map(|at| (at.place, **at));
    let flag = |key, stated: &Option<At<bool>>, of: OnFaces| {
        is_set(key, stated.as_ref()).map(|(key, place)| (key, place, of))
    };
    let stated = [
        value("head", head, OnFaces::Head),
        value("inflow", inflow, OnFaces::Inflow),
        value("recharge", recharge, OnFaces::Recharge),
        flag("open", &face.open, OnFaces::Open),
        flag("closed", &face.closed, OnFaces::Closed),
    ];
    let stated = stated.into_iter().flatten().collect();
    let held = only(stated, (face.place, &label, FACES), problems);
    let named = Named {
        name: face.name.value.clone(),
        within: extent::<D>(&face.from, &face.to, problems)?,
        condition: held?,
    };
    Ok((named, in_time))
}

fn region<const D: usize>(
    region: &At<SeepageRegion>,
    soils: &mut Vec<Soil>,
    problems: &mut Problems,
) -> Result<Named<3, InGround>, Wrong> {
    let label = format!("the region `{}`", clip(&region.name, 40));
    let number = soils.len();
    let stated = [
        (region.head.as_ref()).map(|at| ("head", at.place, InGround::Head(**at))),
        is_set("drain", region.drain.as_ref()).map(|(key, place)| (key, place, InGround::Drain)),
        (region.discharge.as_ref()).map(|at| ("discharge", at.place, InGround::Inflow(-**at))),
        (region.permeability.as_ref()).map(|at| ("permeability", at.place, InGround::Soil(number))),
    ];
    let stated = stated.into_iter().flatten().collect();
    let held = only(stated, (region.place, &label, REGIONS), problems);
    let within = extent::<D>(&region.from, &region.to, problems)?;
    let held = held?;
    if let (InGround::Soil(_), Some(permeability)) = (held, &region.permeability) {
        soils.push(Soil::isotropic(**permeability));
    }
    Ok(Named {
        name: region.name.value.clone(),
        within,
        condition: held,
    })
}

/// Refuses a face or a region whose box meets no body.
fn meets_ground<const D: usize, T>(
    around: &Around<'_, D>,
    (place, kind): (Place, &str),
    named: &Named<3, T>,
    problems: &mut Problems,
) -> Result<(), Wrong> {
    let name = clip(&named.name, 40);
    if meets(around, &named.within) {
        return Ok(());
    }
    problems
        .error(place, format!("the {kind} `{name}` meets no body"))
        .help("let its box reach into the ground, or over a face of it");
    Err(Wrong)
}

/// Whether a box meets soil, hardly beside it too.
fn meets<const D: usize>(around: &Around<'_, D>, within: &Extent<3>) -> bool {
    let sizes = (0..D).map(|axis| within.upper[axis] - within.lower[axis]);
    let beside = BESIDE * sizes.fold(0.0, f64::max);
    let lower = std::array::from_fn(|axis| within.lower[axis] - beside);
    let upper = std::array::from_fn(|axis| within.upper[axis] + beside);
    meets_box::<D>(around.bodies, around.sequence, [lower, upper])
}

fn section<const D: usize>(
    around: &Around<'_, D>,
    section: &At<SeepageSection>,
    problems: &mut Problems,
) -> Result<(String, Extent<3>), Wrong> {
    let within = extent::<D>(&section.from, &section.to, problems)?;
    let flat = (0..D).filter(|&axis| within.upper[axis] <= within.lower[axis]);
    if flat.count() != 1 {
        let sizes = (0..D).map(|axis| number(within.upper[axis] - within.lower[axis]));
        let sizes: Vec<String> = sizes.collect();
        problems
            .error(
                section.place,
                format!("the section `{}` lies across no axis: it measures {} m", clip(&section.name, 40), sizes.join(" by ")),
            )
            .help("let its corners have one coordinate in common: from = [\"20 m\", \"0 m\"], to = [\"20 m\", \"8 m\"]");
        return Err(Wrong);
    }
    if !meets(around, &within) {
        problems
            .error(
                section.place,
                format!(
                    "the section `{}` meets no body: no water passes it",
                    clip(&section.name, 40)
                ),
            )
            .help("let it run through the ground");
        return Err(Wrong);
    }
    Ok((section.name.value.clone(), within))
}
