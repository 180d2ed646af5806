//! Loads in space, and whether there is soil where they act.

use igimp_model::{LoadKind, Plan};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::loads::{Footing, Patch, Pressure, PressureDirection};
use igimp_schema::source::Place;
use igimp_schema::text::{clip, point};
use igimp_schema::tree::Wrong;
use igimp_schema::tree::read::Either;

use super::Bearing;
use crate::build::bodies::site::Solids;
use igimp_geometry::outline::{distinct, self_crossing};

/// Places along each side of a loaded rectangle at which soil is looked for.
const SAMPLES: usize = 7;

impl Bearing<3> for Solids {
    /// It was refused before.
    fn footing(
        &self,
        _footing: &Result<Footing<3>, Wrong>,
        _name: &str,
        _problems: &mut Problems,
    ) -> Option<LoadKind<3>> {
        None
    }

    fn pressure(
        &self,
        load: &Pressure<3>,
        about: (&str, &[&[bool]]),
        problems: &mut Problems,
    ) -> Option<LoadKind<3>> {
        pressure(load, about, self, problems)
    }

    fn patch(
        &self,
        load: &Result<Patch, Wrong>,
        (name, place, _, scenes): (&str, Place, Place, &[&[bool]]),
        problems: &mut Problems,
    ) -> Option<LoadKind<3>> {
        patch(load.as_ref().ok()?, (name, place), (self, scenes), problems)
    }
}

/// Whether a place lies in soil; of the bodies that are there, if they are stated.
fn is_soil(soil: &Solids, present: Option<&[bool]>, at: [f64; 3]) -> bool {
    let mut bodies = soil.regions.iter().enumerate();
    bodies.any(|(body, region)| present.is_none_or(|present| present[body]) && region.encloses(at))
}

/// How many places of a rectangle across an axis have soil behind it alone, before it alone, and on both sides; of the bodies that
/// are there, if they are stated.
fn soil_beside(
    load: &Pressure<3>,
    normal: usize,
    (soil, present): (&Solids, Option<&[bool]>),
) -> [usize; 3] {
    let (from, to) = (*load.from, *load.to);
    let step = 1e-2 * soil.cell;
    let mut found = [0; 3];
    for k in 0..SAMPLES * SAMPLES {
        let mut share = [0.0; 3];
        let places = [k % SAMPLES, k / SAMPLES].map(|place| (place as f64 + 0.5) / SAMPLES as f64);
        let along = (0..3).filter(|&axis| axis != normal);
        for (axis, place) in along.zip(places) {
            share[axis] = place;
        }
        let is_soil = |side: f64| {
            let mut at: [f64; 3] =
                std::array::from_fn(|axis| from[axis] + share[axis] * (to[axis] - from[axis]));
            at[normal] += side * step;
            is_soil(soil, present, at)
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

fn pressure(
    load: &Pressure<3>,
    (name, scenes): (&str, &[&[bool]]),
    soil: &Solids,
    problems: &mut Problems,
) -> Option<LoadKind<3>> {
    const ALL: usize = SAMPLES * SAMPLES;
    let (from, to) = (*load.from, *load.to);
    let shown = clip(name, 40);
    let flat: Vec<usize> = (0..3)
        .filter(|&axis| (to[axis] - from[axis]).abs() <= soil.round_off)
        .collect();
    let &[normal] = &flat[..] else {
        problems
            .error(
                load.to.place,
                format!("the corners of the pressure `{shown}` span no rectangle across an axis"),
            )
            .help("two corners that lie across from each other have one coordinate in common");
        return None;
    };
    let scenes = scenes.iter().filter(|_| soil.is_complete);
    let found = scenes.map(|present| soil_beside(load, normal, (soil, Some(*present))));
    // A load on soil that is not there is refused where the stage applies it.
    let mut found: Vec<_> = found.filter(|counts| *counts != [0; 3]).collect();
    if found.is_empty() {
        found.push(soil_beside(load, normal, (soil, None)));
    }
    let is_on = |side: usize| found.iter().all(|counts| counts[side] == ALL);
    if soil.is_complete && !is_on(0) && !is_on(1) {
        let is_wrong = |counts: &&[usize; 3]| counts[0] < ALL && counts[1] < ALL;
        let message = match found.iter().find(is_wrong) {
            Some([0, 0, 0]) => {
                format!("no body lies along the rectangle of the pressure `{shown}`")
            }
            Some([_, _, buried]) if *buried > 0 => format!(
                "the rectangle of the pressure `{shown}` lies inside the soil, not on its surface"
            ),
            Some(_) => format!(
                "only a part of the rectangle of the pressure `{shown}` lies on the surface of a body"
            ),
            None => format!(
                "soil lies on one side of the rectangle of the pressure `{shown}` in one stage, and on the other in another"
            ),
        };
        problems
            .error(load.from.place, message)
            .help("the rectangle lies on a level or upright face of a body");
        return None;
    }
    let mut inward = [0.0; 3];
    inward[normal] = if found[0][0] > 0 { 1.0 } else { -1.0 };
    if *load.direction == PressureDirection::Down {
        inward = [0.0, 0.0, -1.0];
    }
    Some(LoadKind::Pressure {
        from,
        to,
        traction: inward.map(|component| component * *load.pressure + 0.0),
    })
}

/// A pressure on a circle or polygon in plan.
fn patch(
    load: &Patch,
    (name, place): (&str, Place),
    (soil, scenes): (&Solids, &[&[bool]]),
    problems: &mut Problems,
) -> Option<LoadKind<3>> {
    let shown = clip(name, 40);
    let plan = match (&load.circle, &load.plan) {
        (Some(circle), None) => Plan::Circle {
            centre: *circle.centre,
            radius: *circle.radius,
        },
        (None, Some(plan)) => {
            let Either::First(corners) = &plan.value else {
                return None;
            };
            let corners: Vec<_> = corners.iter().map(|corner| **corner).collect();
            let corners = distinct(&corners, soil.round_off);
            let crossing = self_crossing(&corners, soil.round_off);
            let polygon = Plan::Polygon(corners);
            if crossing.is_some() || polygon.area() <= soil.round_off * soil.cell {
                let message = format!("the corners of the patch `{shown}` enclose no area");
                problems
                    .error(plan.place, message)
                    .help("name them in order along the boundary, each once");
                return None;
            }
            polygon
        }
        (both, _) => {
            let message = match both {
                None => format!("the patch `{shown}` covers nothing"),
                Some(_) => format!("the patch `{shown}` has both `circle` and `plan`"),
            };
            problems.error(place, message).help(
                "write one of circle = { centre = [\"2 m\", \"2 m\"], radius = \"1 m\" } and plan = [[...], ...]",
            );
            return None;
        }
    };
    let (level, pressure) = (*load.level, *load.pressure);
    if let Some((at, is_buried)) = off_surface(&places(&plan, level, soil), soil, scenes) {
        let fault = if is_buried {
            "lies inside the soil, not on its surface,"
        } else {
            "does not lie on the surface of a body"
        };
        let near = at.map(|x| (1e4 * x).round() / 1e4);
        problems
            .error(
                load.level.place,
                format!("the patch `{shown}` {fault} at {}", point(near)),
            )
            .help("all of it lies on level surfaces of bodies at its level");
        return None;
    }
    Some(LoadKind::Patch {
        plan,
        level,
        traction: [0.0, 0.0, 0.0 - pressure],
    })
}

/// The first of some places that is on no surface in a scene, and whether soil is above it; where all bodies are known.
fn off_surface(places: &[[f64; 3]], soil: &Solids, scenes: &[&[bool]]) -> Option<([f64; 3], bool)> {
    let step = 1e-2 * soil.cell;
    let is_soil = |at: &[f64; 3], by: f64, present: Option<&[bool]>| {
        is_soil(soil, present, [at[0], at[1], at[2] + by])
    };
    // A load on soil that is not there is refused where the stage applies it.
    let bears = |present: Option<&[bool]>| {
        let mut at = places.iter();
        at.any(|at| is_soil(at, -step, present) || is_soil(at, step, present))
    };
    if !soil.is_complete {
        return None;
    }
    let scenes = scenes.iter().map(|scene| Some(*scene));
    let mut scenes: Vec<_> = scenes.filter(|scene| bears(*scene)).collect();
    if scenes.is_empty() {
        scenes.push(None);
    }
    scenes.into_iter().find_map(|scene| {
        let lies_on = |at: &&[f64; 3]| is_soil(at, -step, scene) && !is_soil(at, step, scene);
        let wrong = places.iter().find(|at| !lies_on(at))?;
        Some((*wrong, is_soil(wrong, step, scene)))
    })
}

/// Places all over a patch.
pub(crate) fn places(plan: &Plan, level: f64, soil: &Solids) -> Vec<[f64; 3]> {
    let around = plan.bounds((&soil.lower, &soil.upper));
    let parts = plan.parts(around, [SAMPLES; 2]).into_iter();
    parts.map(|(_, [x, y])| [x, y, level]).collect()
}

/// Places across a rectangle across an axis.
pub(crate) fn samples(from: &[f64; 3], to: &[f64; 3]) -> Vec<[f64; 3]> {
    let step = |k: usize| (k as f64 + 0.5) / SAMPLES as f64;
    let widths = [0, 1, 2].map(|axis| (to[axis] - from[axis]).abs());
    let normal = (0..3)
        .min_by(|&a, &b| widths[a].total_cmp(&widths[b]))
        .unwrap_or(2);
    let place = |k: usize| {
        let mut shares = [step(k % SAMPLES), step(k / SAMPLES)].into_iter();
        std::array::from_fn(|axis| {
            let share = if axis == normal {
                0.0
            } else {
                shares.next().unwrap_or(0.0)
            };
            from[axis] + share * (to[axis] - from[axis])
        })
    };
    (0..SAMPLES * SAMPLES).map(place).collect()
}
