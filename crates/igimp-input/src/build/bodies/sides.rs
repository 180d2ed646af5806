//! Sides of the grid with supports that hold nothing, as the ground ends before them with an upright face, or that hold such a face
//! across a gap, as it stands less than a cell before them.

use igimp_model::{BodyPart, Boundaries, Load, LoadKind, Material, RigidPart, Side, Strength};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::grid as keys;
use igimp_schema::schema::stages::{Stage, StageForm};
use igimp_schema::text::number;
use igimp_schema::tree::Node;
use igimp_schema::tree::read::At;
use igimp_text::short;

use super::reach::ever;
use super::sequence::Sequence;
use crate::build::Thing;
use crate::build::grid::Frame;

/// Depth of the strip behind a face in which its height is measured, in cells \[-\].
const STRIP: f64 = 0.1;
/// Faces higher than this are looked at, in cells \[-\].
const HIGH: f64 = 1.0;
/// Parts of the cell at a side in which soil is looked for.
const PARTS: usize = 8;
/// Share of the height by which soil ends within one of these parts where its face is upright \[-\].
const UPRIGHT: f64 = 0.7;
/// Share of a face that has to be held \[-\].
const HELD: f64 = 0.5;

/// Data of the case that may hold a face, beside the supports of the grid.
pub(crate) struct Holds<'a, const D: usize> {
    boundaries: Option<&'a Boundaries<D>>,
    rigid: &'a [Option<RigidPart<D>>],
    loads: &'a [Option<Load<D>>],
    materials: &'a [Option<Material>],
}

impl<'a, const D: usize> Holds<'a, D> {
    pub(crate) fn new(
        boundaries: Option<&'a Boundaries<D>>,
        rigid: &'a [Option<RigidPart<D>>],
        (loads, materials): (&'a [Option<Load<D>>], &'a [Option<Material>]),
    ) -> Self {
        Self {
            boundaries,
            rigid,
            loads,
            materials,
        }
    }
}

/// A face that looks at a side of the grid.
struct Face {
    axis: usize,
    is_upper: bool,
    /// Where it stands on the axis \[m\].
    at: f64,
    /// Level of its foot \[m\].
    foot: f64,
    /// \[m\].
    height: f64,
}

/// Soil in a slice of the ground.
struct Slice {
    /// Its lowest level \[m\].
    foot: f64,
    /// Area over the width of the ground across \[m\].
    height: f64,
    /// Whether some of it may yield.
    yields: bool,
}

/// Warns of sides with a support that no soil meets in any stage, before which soil stands upright with nothing to hold it.
pub(crate) fn check<const D: usize>(
    (tree, frame): (&Node, Option<&Frame<D>>),
    stages: &[Thing<Stage>],
    (bodies, sequence): (&[Option<BodyPart<D>>], &Sequence),
    holds: &Holds<'_, D>,
    problems: &mut Problems,
) {
    let (Some(frame), Some(boundaries), 0) = (frame, holds.boundaries, problems.errors()) else {
        return;
    };
    let stated = Root::<D>::boundaries(tree).ok();
    let Some(sides) = stated.as_ref().and_then(|table| table.by_axis()) else {
        return;
    };
    // Where a stage lets bodies go, a free face may be meant.
    let lets_go = stages
        .iter()
        .flatten()
        .any(|stage| matches!(*stage.form, StageForm::Dynamic(_) | StageForm::RunOut(_)));
    let Some(parts) = ever(bodies, sequence).map(Iterator::collect::<Vec<_>>) else {
        return;
    };
    for (axis, [lower, upper]) in sides.into_iter().take(D - 1).enumerate() {
        for (stated, is_upper) in [(lower, false), (upper, true)] {
            let is_free = boundaries.sides[axis][usize::from(is_upper)] == Side::Free;
            let is_meant = lets_go && !stated.written;
            if is_free || is_meant {
                continue;
            }
            let ground = (&parts[..], frame, holds.materials);
            let is_bare = |face: &Face| !is_held(face, (tree, frame), holds);
            if let Some(face) = near_face(ground, (axis, is_upper)).filter(is_bare) {
                warn_across(stated, &face, frame, problems);
            } else if let Some(face) = face(ground, (axis, is_upper)).filter(is_bare) {
                warn(stated, &face, frame, problems);
            }
        }
    }
}

/// Bodies with the grid and their materials.
type Grounds<'a, const D: usize> = (&'a [&'a BodyPart<D>], &'a Frame<D>, &'a [Option<Material>]);

/// Soil between two places on an axis \[m\].
fn slice<const D: usize>(
    (parts, frame, materials): Grounds<'_, D>,
    axis: usize,
    [from, to]: [f64; 2],
) -> Slice {
    let (mut lower, mut upper) = (frame.lower, frame.upper);
    (lower[axis], upper[axis]) = (from, to);
    let (mut area, mut width) = (0.0, 0.0_f64);
    let (mut foot, mut yields) = (f64::INFINITY, false);
    for part in parts {
        let section = part.region.within(lower, upper).volume / (to - from);
        let (least, most) = part.region.bounds();
        let across = (0..D - 1).filter(|&other| other != axis);
        width = width.max(across.map(|other| most[other] - least[other]).product());
        if section <= 0.0 {
            continue;
        }
        area += section;
        foot = foot.min(least[D - 1]);
        let material = materials.get(part.material).and_then(Option::as_ref);
        yields |= material.is_some_and(|soil| soil.strength != Strength::Elastic);
    }
    Slice {
        foot,
        height: area / width,
        yields,
    }
}

/// The height from which on a face is looked at \[m\].
fn least_height<const D: usize>(frame: &Frame<D>) -> f64 {
    HIGH * frame.axes[D - 1].extremes()[0] * (1.0 + 1e-6)
}

/// The upright face less than a cell before a side, if soil that may yield ends so there.
fn near_face<const D: usize>(
    ground: Grounds<'_, D>,
    (axis, is_upper): (usize, bool),
) -> Option<Face> {
    let frame = ground.1;
    let (side, inwards) = if is_upper {
        (frame.upper[axis], -1.0)
    } else {
        (frame.lower[axis], 1.0)
    };
    let part = frame.axes[axis].cell_at(side) / PARTS as f64;
    let off = |parts: f64| side + inwards * parts * part;
    let soil = |k: usize| {
        let mut ends = [off(k as f64 + 0.45), off(k as f64 + 0.55)];
        ends.sort_by(f64::total_cmp);
        slice(ground, axis, ends)
    };
    // From the side inwards, the last of them a little less than a cell off.
    let soil: Vec<Slice> = (0..PARTS).map(soil).collect();
    let (nearest, farthest) = (soil.first()?, soil.last()?);
    let rise = farthest.height - nearest.height;
    let rises = soil.windows(2).map(|pair| pair[1].height - pair[0].height);
    let (step, most) = (rises.enumerate()).max_by(|a, b| a.1.total_cmp(&b.1))?;
    let is_face = rise > least_height(frame) && most > UPRIGHT * rise && farthest.yields;
    is_face.then(|| Face {
        axis,
        is_upper,
        at: off(step as f64 + 1.0),
        foot: farthest.foot + nearest.height,
        height: rise,
    })
}

/// The upright face at the end of the ground, if soil that may yield ends so a cell or more before a side.
fn face<const D: usize>(ground: Grounds<'_, D>, (axis, is_upper): (usize, bool)) -> Option<Face> {
    let (parts, frame, _) = ground;
    let end = |part: &&BodyPart<D>| {
        let (lower, upper) = part.region.bounds();
        if is_upper { upper[axis] } else { -lower[axis] }
    };
    let farthest = parts.iter().map(end).fold(f64::NEG_INFINITY, f64::max);
    let (at, side) = if is_upper {
        (farthest, frame.upper[axis])
    } else {
        (-farthest, frame.lower[axis])
    };
    let cell = frame.axes[axis].cell_at(at);
    if (side - at).abs() < cell * (1.0 - 0.5 / PARTS as f64) {
        return None;
    }
    let depth = STRIP * cell;
    let ends = if is_upper {
        [at - depth, at]
    } else {
        [at, at + depth]
    };
    let Slice {
        foot,
        height,
        yields,
    } = slice(ground, axis, ends);
    (yields && height > least_height(frame)).then_some(Face {
        axis,
        is_upper,
        at,
        foot,
        height,
    })
}

/// Whether a box, a rigid body, a pressure or reinforcement with its head there holds a face.
fn is_held<const D: usize>(
    face: &Face,
    (tree, frame): (&Node, &Frame<D>),
    holds: &Holds<'_, D>,
) -> bool {
    let (axis, at) = (face.axis, face.at);
    let cell = frame.axes[axis].cell_at(at);
    let boxes = holds.boundaries.map_or(&[][..], |sides| &sides.boxes);
    let mut rigid = holds.rigid.iter().flatten().map(RigidPart::bounds);
    let presses = |load: &Load<D>| match &load.kind {
        LoadKind::Pressure { from, to, .. } => {
            [from, to].iter().all(|end| (end[axis] - at).abs() <= cell)
        }
        _ => false,
    };
    // As high as half of the face: a body that stands on the soil beside it does not hold it.
    let is_as_high = |lower: &[f64; D], upper: &[f64; D]| {
        let [from, to] = [face.foot, face.foot + face.height];
        upper[D - 1].min(to) - lower[D - 1].max(from) > HELD * face.height
    };
    boxes.iter().any(|fixed| {
        fixed.fix[axis]
            && fixed.lower[axis] <= at + cell
            && fixed.upper[axis] >= at - cell
            && is_as_high(&fixed.lower, &fixed.upper)
    }) || rigid.any(|(lower, upper)| {
        let is_there = if face.is_upper {
            lower[axis] <= at + cell && upper[axis] > at
        } else {
            upper[axis] >= at - cell && lower[axis] < at
        };
        is_there && is_as_high(&lower, &upper)
    }) || holds.loads.iter().flatten().any(presses)
        || tree.items_at("reinforcement").iter().any(|member| {
            let head = member.items_at("head").get(axis).and_then(Node::number);
            head.is_some_and(|head| (head - at).abs() <= cell)
        })
}

/// The name of a side, that of its axis, and where it is \[m\].
fn named<const D: usize>(face: &Face, frame: &Frame<D>) -> (&'static str, &'static str, f64) {
    let names = [["left", "right"], ["front", "back"]][face.axis];
    let end = if face.is_upper {
        frame.upper[face.axis]
    } else {
        frame.lower[face.axis]
    };
    let side = names[usize::from(face.is_upper)];
    (side, ["x", "y"][face.axis], end)
}

fn warn_across<const D: usize>(
    stated: &At<keys::Side>,
    face: &Face,
    frame: &Frame<D>,
    problems: &mut Problems,
) {
    let (side, key, end) = named(face, frame);
    problems
        .warning(
            stated.place,
            format!(
                "{side} = \"{}\" holds an upright face of {} m across a gap narrower than a cell, some {} m wide",
                stated.name(),
                short(face.height),
                short((end - face.at).abs())
            ),
        )
        .help(format!(
            "soil in the cells at a side is held by it: let it reach {key} = {} m, or leave a cell between them",
            number(end)
        ))
        .help("cells as small as the gap leave it open");
}

fn warn<const D: usize>(
    stated: &At<keys::Side>,
    face: &Face,
    frame: &Frame<D>,
    problems: &mut Problems,
) {
    let (side, key, end) = named(face, frame);
    problems
        .warning(
            stated.place,
            format!(
                "{side} = \"{}\" touches no soil: the ground ends at {key} = {} m, {} m before this side",
                stated.name(),
                number(face.at),
                short((end - face.at).abs())
            ),
        )
        .help(format!(
            "its upright face of {} m stands free there: let [grid] domain end at {key} = {} m, or hold {key} there by [[boundaries.boxes]]",
            short(face.height),
            number(face.at)
        ))
        .help(format!("{side} = \"free\" if the face is meant to be free"));
}
