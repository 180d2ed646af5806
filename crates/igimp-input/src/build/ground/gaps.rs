//! Warnings about gaps narrower than a cell, which cells bridge as if there were soil: in an outline, between two bodies, and
//! where stages take a body away.

use igimp_geometry::gaps::narrow;
use igimp_geometry::outline::{Facing, facing};
use igimp_geometry::region::Region;
use igimp_model::BodyPart;
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::bodies::Body;
use igimp_schema::text::{clip, point};
use igimp_text::short;

use crate::build::Thing;
use crate::build::bodies::polygon_place;
use crate::build::bodies::sequence::Sequence;
use crate::build::bodies::site::{Site, Solids};
use crate::build::grid::Frame;

/// Gaps narrower than this share of the smallest cell are warned of: nodes see soil on both sides \[-\].
pub(super) const NARROW: f64 = 1.0;
/// Most lines of a grid in space along an axis that are looked at.
const MOST_LINES: usize = 100_000;
/// A gap is narrower than another length where it is by more than round-off \[-\].
const ROUND_OFF: f64 = 1e-6;

/// Warns of gaps in the plane, one for two bodies.
pub(super) fn check(
    tables: &[Thing<Body>],
    frame: &Frame<2>,
    (bodies, site, sequence): (&[&BodyPart<2>], &Site, &Sequence),
    problems: &mut Problems,
) {
    let [width, height] = frame.axes.each_ref().map(|axis| axis.extremes()[0]);
    let most = NARROW * width.min(height) * (1.0 - ROUND_OFF);
    for (second, b) in bodies.iter().enumerate() {
        for (first, a) in bodies[..=second].iter().enumerate() {
            // Steps in an outline that are lower than a cell are no slots.
            let least = if first == second { most } else { 0.0 };
            let is_gap = |piece: &Facing| {
                let [p, q] = piece.ends;
                piece.distance > site.round_off
                    && (p[0] - q[0]).hypot(p[1] - q[1]) > least
                    && is_bare((site, sequence), [first, second], piece.middle)
            };
            let pieces = facing(a.polygon(), b.polygon(), most);
            let Some(gap) = pieces.iter().find(|piece| is_gap(piece)) else {
                continue;
            };
            let place = tables[second].as_ref().map(polygon_place);
            let names = [&a.name, &b.name].map(|name| clip(name, 40));
            let to_millimetres = gap.middle.map(|x| (x * 1e3).round() / 1e3);
            let text = sentence(gap.distance, &names, &point(to_millimetres));
            problems.warning(place, text).help(remedy(&names));
        }
    }
}

/// Whether a place between two bodies, or in a notch of one, is bare at some time when both are there.
fn is_bare((site, sequence): (&Site, &Sequence), [a, b]: [usize; 2], place: [f64; 2]) -> bool {
    let mut scenes = (sequence.scenes()).filter(|scene| scene.present[a] && scene.present[b]);
    scenes.any(|scene| !site.is_inside(Some(&scene.present), place))
}

fn sentence(width: f64, [a, b]: &[String; 2], place: &str) -> String {
    let width = short(width);
    if a == b {
        format!("a gap of {width} m, narrower than a cell, cuts into body `{a}` at {place}")
    } else {
        format!("a gap of {width} m parts body `{b}` from body `{a}` at {place}")
    }
}

fn remedy([a, b]: &[String; 2]) -> &'static str {
    if a == b {
        "soil on both sides sticks together, and a factor of safety is too high: make it as wide as a cell, or cells as small as the gap"
    } else {
        "bodies closer than a cell stick together: let them share the edge, or leave a cell between them"
    }
}

/// Warns of a gap in space, of one at each time.
pub(crate) fn check_in_space(
    tables: &[Thing<Body>],
    (bodies, sequence): (&[Option<BodyPart<3>>], &Sequence),
    soil: &Solids,
    problems: &mut Problems,
) {
    let (Some(frame), true, 0) = (&soil.frame, soil.is_complete, problems.errors()) else {
        return;
    };
    if frame.axes.iter().any(|axis| axis.cells() > MOST_LINES) {
        return;
    }
    let lines = frame.axes.each_ref().map(|axis| axis.lines().collect());
    let mut seen: Vec<&[bool]> = Vec::new();
    for scene in sequence.scenes() {
        if seen.contains(&&scene.present[..]) {
            continue;
        }
        seen.push(&scene.present);
        let parts = std::iter::zip(&soil.regions, &scene.present);
        let regions: Vec<&dyn Region<3>> = (parts.filter(|(_, present)| **present))
            .map(|(region, _)| &**region)
            .collect();
        let Some(gap) = narrow(&regions, &lines) else {
            continue;
        };
        let width = gap.ends[1] - gap.ends[0];
        let beside = [
            gap.ends[0] - ROUND_OFF * width,
            gap.ends[1] + ROUND_OFF * width,
        ];
        let found = beside.map(|along| {
            let mut at = gap.at;
            at[gap.axis] = along;
            let mut all = soil.regions.iter().enumerate();
            all.position(|(body, region)| scene.present[body] && region.encloses(at))
        });
        let [Some(a), Some(b)] = found else { continue };
        let [first, second] = [a.min(b), a.max(b)];
        let name = |body: usize| bodies[body].as_ref().map_or("", |part| &part.name);
        let names = [first, second].map(|body| clip(name(body), 40));
        let place = tables[second].as_ref().map(|body| body.place);
        let rounded = gap.at.map(|x| (1e6 * x).round() / 1e6);
        problems
            .warning(
                place,
                sentence((1e6 * width).round() / 1e6, &names, &point(rounded)),
            )
            .help(remedy(&names));
    }
}
