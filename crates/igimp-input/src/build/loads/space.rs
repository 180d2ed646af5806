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
use crate::geometry::{distinct, self_crossing};

/// Places along each side of a loaded rectangle at which soil is looked for.
const SAMPLES: usize = 7;

impl Bearing<3> for Solids {
    /// It was refused before.
    fn footing(
        &self,
        _own: &Result<Footing<3>, Wrong>,
        _name: &str,
        _problems: &mut Problems,
    ) -> Option<LoadKind<3>> {
        None
    }

    fn pressure(
        &self,
        own: &Pressure<3>,
        name: &str,
        problems: &mut Problems,
    ) -> Option<LoadKind<3>> {
        pressure(own, name, self, problems)
    }

    fn patch(
        &self,
        own: &Result<Patch, Wrong>,
        (name, place, _): (&str, Place, Place),
        problems: &mut Problems,
    ) -> Option<LoadKind<3>> {
        patch(own.as_ref().ok()?, (name, place), self, problems)
    }
}

fn pressure(
    own: &Pressure<3>,
    name: &str,
    soil: &Solids,
    problems: &mut Problems,
) -> Option<LoadKind<3>> {
    let (from, to) = (*own.from, *own.to);
    let shown = clip(name, 40);
    let flat: Vec<usize> = (0..3)
        .filter(|&axis| (to[axis] - from[axis]).abs() <= soil.round_off)
        .collect();
    let &[normal] = &flat[..] else {
        problems
            .error(
                own.to.place,
                format!("the corners of the pressure `{shown}` span no rectangle across an axis"),
            )
            .help("two corners that lie across from each other have one coordinate in common");
        return None;
    };
    let step = 1e-2 * soil.cell;
    let is_soil = |share: [f64; 3], side: f64| {
        let mut at: [f64; 3] =
            std::array::from_fn(|axis| from[axis] + share[axis] * (to[axis] - from[axis]));
        at[normal] += side * step;
        soil.regions.iter().any(|region| region.encloses(at))
    };
    let mut sides = [0_usize; 2];
    let mut buried = 0;
    for k in 0..SAMPLES * SAMPLES {
        let mut share = [0.0; 3];
        let places = [k % SAMPLES, k / SAMPLES].map(|place| (place as f64 + 0.5) / SAMPLES as f64);
        let along = (0..3).filter(|&axis| axis != normal);
        for (axis, place) in along.zip(places) {
            share[axis] = place;
        }
        match (is_soil(share, 1.0), is_soil(share, -1.0)) {
            (true, true) => buried += 1,
            (true, false) => sides[0] += 1,
            (false, true) => sides[1] += 1,
            (false, false) => {}
        }
    }
    let mut inward = [0.0; 3];
    if soil.is_complete && sides.iter().all(|&side| side < SAMPLES * SAMPLES) {
        let message = if buried > 0 {
            format!(
                "the rectangle of the pressure `{shown}` lies inside the soil, not on its surface"
            )
        } else if sides == [0, 0] {
            format!("no body lies along the rectangle of the pressure `{shown}`")
        } else {
            format!(
                "only a part of the rectangle of the pressure `{shown}` lies on the surface of a body"
            )
        };
        problems
            .error(own.from.place, message)
            .help("the rectangle lies on a level or upright face of a body");
        return None;
    }
    inward[normal] = if sides[0] > 0 { 1.0 } else { -1.0 };
    if *own.direction == PressureDirection::Down {
        inward = [0.0, 0.0, -1.0];
    }
    Some(LoadKind::Pressure {
        from,
        to,
        traction: inward.map(|component| component * *own.pressure + 0.0),
    })
}

/// A pressure on a circle or polygon in plan.
fn patch(
    own: &Patch,
    (name, place): (&str, Place),
    soil: &Solids,
    problems: &mut Problems,
) -> Option<LoadKind<3>> {
    let shown = clip(name, 40);
    let plan = match (&own.circle, &own.plan) {
        (Some(circle), None) => Plan::Circle {
            centre: *circle.centre,
            radius: *circle.radius,
        },
        (None, Some(plan)) => {
            let Either::First(corners) = &plan.value else {
                return None;
            };
            let corners: Vec<_> = corners.iter().map(|own| **own).collect();
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
    let (level, pressure) = (*own.level, *own.pressure);
    let step = 1e-2 * soil.cell;
    let is_soil = |at: &[f64; 3], by: f64| {
        let at = [at[0], at[1], at[2] + by];
        soil.regions.iter().any(|region| region.encloses(at))
    };
    let places = places(&plan, level, soil);
    let lies_on = |at: &&[f64; 3]| is_soil(at, -step) && !is_soil(at, step);
    if let Some(at) = places.iter().find(|at| soil.is_complete && !lies_on(at)) {
        let what = if is_soil(at, step) {
            "lies inside the soil, not on its surface,"
        } else {
            "does not lie on the surface of a body"
        };
        let near = at.map(|x| (1e4 * x).round() / 1e4);
        problems
            .error(
                own.level.place,
                format!("the patch `{shown}` {what} at {}", point(near)),
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
