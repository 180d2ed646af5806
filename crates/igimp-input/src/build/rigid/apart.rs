//! Whether rigid bodies that are there together leave each other room.

use igimp_assembly::{Interface, RigidBody, Shear, Tension};
use igimp_model::{RigidPart, overlap_of_rigid};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::stages::Stage;
use igimp_schema::text::{clip, number};
use igimp_schema::tree::Node;

use crate::build::bodies::sequence::Sequence;
use crate::build::grid::Frame;
use crate::build::{Thing, things};

/// Bodies that reach into each other by less than this share of a cell touch \[-\].
const TOUCH: f64 = 1e-6;

/// Refuses rigid bodies that overlap as they are drawn and are there in one stage: nothing keeps them apart.
pub(crate) fn check<const D: usize>(
    (tree, frame): (&Node, Option<&Frame<D>>),
    parts: &[Option<RigidPart<D>>],
    course: (&[Thing<Stage>], &Sequence),
    problems: &mut Problems,
) {
    let Some(frame) = frame.filter(|_| parts.len() > 1) else {
        return;
    };
    let axes = frame.axes.iter().map(|axis| axis.extremes()[0]);
    let cell = axes.fold(f64::INFINITY, f64::min);
    let bodies = parts.iter().map(|part| drawn(part.as_ref()?, cell));
    let bodies: Vec<_> = bodies.collect();
    let stated = things(Root::<D>::rigid(tree));
    for (k, second) in parts.iter().enumerate() {
        for (j, first) in parts[..k].iter().enumerate() {
            let (Some(first), Some(second)) = (first, second) else {
                continue;
            };
            let (Some(a), Some(b)) = (&bodies[j], &bodies[k]) else {
                continue;
            };
            let depth = overlap_of_rigid(a, b);
            if depth > TOUCH * cell && are_together([first, second], course) {
                problems
                    .error(
                        stated[k].as_ref().map(|body| body.name.place),
                        format!(
                            "the rigid bodies `{}` and `{}` overlap by {} m",
                            clip(&first.name, 40),
                            clip(&second.name, 40),
                            number(depth)
                        ),
                    )
                    .help("rigid bodies do not feel each other: draw them side by side, or as one body");
            }
        }
    }
}

/// A body where it is drawn.
fn drawn<const D: usize>(part: &RigidPart<D>, cell: f64) -> Option<RigidBody<D>> {
    let surface = part.surface(cell).ok()?;
    let side = Interface {
        shear: Shear::Smooth,
        tension: Tension::None,
    };
    let sides = vec![side; surface.side_count()];
    Some(RigidBody::new(surface, sides, part.reference))
}

/// Whether two bodies are there in one stage.
fn are_together<const D: usize>(
    parts: [&RigidPart<D>; 2],
    (stages, sequence): (&[Thing<Stage>], &Sequence),
) -> bool {
    let is_there = |part: &RigidPart<D>, stage: usize| {
        let moves = |&stage: &usize| {
            let mut moved = stages[stage].iter().flat_map(|at| at.moves()).flatten();
            moved.any(|motion| motion.body.value == part.name)
        };
        part.from_start
            || std::iter::successors(Some(stage), |&at| sequence.from(at)).any(|at| moves(&at))
    };
    (0..stages.len()).any(|stage| parts.iter().all(|part| is_there(part, stage)))
}
