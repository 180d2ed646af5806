//! Reinforcement of a case as the solver has it: made, installed, loaded, and its results.

use igimp_assembly::{Hold, Reinforcement, ReinforcementControl, Segment, SegmentState, Station};
use igimp_model::{Case, ReinforcementPart, ReinforcementQuantity, Stage, distance};
use igimp_results::reinforcement::Installed;
use igimp_results::summary::MemberSummary;

use igimp_text::short;

use super::state::{Controls, ReinforcementControls, State};

/// Stations per cell along a bonded length.
const STATIONS_PER_CELL: f64 = 4.0;
/// A part of a station that round-off makes \[-\].
const ROUND_OFF: f64 = 1e-9;

/// A member of a case where it is installed, without tension.
pub(crate) fn made<const D: usize>(
    case: &Case<D>,
    part: &ReinforcementPart<D>,
) -> Reinforcement<D> {
    let mut stations = vec![Station {
        points: head_points(case, part),
    }];
    let mut segments = Vec::new();
    let mut so_far = 0.0;
    for (from, to, is_bonded) in legs(part) {
        let length = distance(&from, &to);
        let count = if is_bonded {
            stations_between(case, from, to).max(1.0)
        } else {
            1.0
        };
        for k in 0..count as usize {
            let t = (k + 1) as f64 / count;
            stations.push(Station {
                points: vec![between(from, to, t)],
            });
            let middle = so_far + (k as f64 + 0.5) / count * length;
            let bonded = part.bonded(middle);
            segments.push(Segment {
                length: length / count,
                tensile: part.capacity,
                held: [0, 1].map(|side| Hold {
                    fastened: part.fastened[side],
                    bonded: bonded[side],
                }),
                state: SegmentState::default(),
            });
        }
        so_far += length;
    }
    Reinforcement {
        name: part.name.clone(),
        stiffness: part.stiffness,
        stations,
        segments,
    }
}

/// The point at a share of the way between two others.
fn between<const D: usize>(a: [f64; D], b: [f64; D], t: f64) -> [f64; D] {
    std::array::from_fn(|axis| a[axis] + t * (b[axis] - a[axis]))
}

/// Stations along a way through the cells of the case, a whole number.
fn stations_between<const D: usize>(case: &Case<D>, a: [f64; D], b: [f64; D]) -> f64 {
    let axes = case.grid.axes.iter().enumerate();
    let cell = axes
        .map(|(k, axis)| axis.smallest_between(a[k].min(b[k]), a[k].max(b[k])))
        .fold(f64::INFINITY, f64::min);
    (STATIONS_PER_CELL * distance(&a, &b) / cell - ROUND_OFF).ceil()
}

/// The straight parts of a member, and whether they are bonded to the ground.
fn legs<const D: usize>(part: &ReinforcementPart<D>) -> Vec<([f64; D], [f64; D], bool)> {
    if part.free_length > 0.0 {
        let (head, end) = (part.line[0], part.line[1]);
        let t = part.free_length / part.length();
        let bond = between(head, end, t);
        let bonded = (t < 1.0).then_some((bond, end, true));
        [(head, bond, false)].into_iter().chain(bonded).collect()
    } else {
        let legs = part.line.windows(2);
        legs.map(|leg| (leg[0], leg[1], true)).collect()
    }
}

/// Where the head takes hold: at its place, or in the middle of equal parts of its plate.
fn head_points<const D: usize>(case: &Case<D>, part: &ReinforcementPart<D>) -> Vec<[f64; D]> {
    let Some(corners) = &part.plate else {
        return vec![part.line[0]];
    };
    let from = corners[0];
    let mut places = vec![from];
    for &to in &corners[1..] {
        let count = stations_between(case, from, to).max(2.0);
        let steps = (0..count as usize).map(|k| (k as f64 + 0.5) / count);
        let moved = |place: &[f64; D], t: f64| -> [f64; D] {
            std::array::from_fn(|axis| place[axis] + t * (to[axis] - from[axis]))
        };
        places = steps
            .flat_map(|t| places.iter().map(move |place| moved(place, t)))
            .collect();
    }
    places
}

/// Installs the members of a stage, in the ground as it stands. A jack takes hold of stressed ones.
pub(crate) fn begin<const D: usize>(case: &Case<D>, state: &mut State<D>, stage: &Stage) {
    for &index in &stage.install {
        let part = &case.reinforcement[index];
        let controls = &mut state.controls;
        let slot = controls.installed().take_while(|&k| k < index).count();
        controls.reinforcement[index] = ReinforcementControls {
            installed: true,
            jack: part.prestress.map(|_| 0.0),
        };
        state.body.reinforcement.insert(slot, made(case, part));
    }
}

/// Warning of a stage that ended before its jacks held all of the prestress: the tension that was locked off.
pub(crate) fn locked_early<const D: usize>(case: &Case<D>, state: &State<D>) -> Option<String> {
    let unit = format!("kN{}", case.per_metre());
    let parts = std::iter::zip(&case.reinforcement, &state.controls.reinforcement);
    let early = parts.filter_map(|(part, control)| {
        let (held, wanted) = (control.jack?, part.prestress?);
        (held < (1.0 - 1e-9) * wanted).then(|| {
            format!(
                "\"{}\" at {} of {} {unit}",
                part.name,
                short(1e-3 * held),
                short(1e-3 * wanted)
            )
        })
    });
    let early: Vec<String> = early.collect();
    (!early.is_empty()).then(|| {
        format!(
            "it ended early, and anchors were locked off with a part of their prestress: {}",
            early.join(", ")
        )
    })
}

/// Controls of the members that are there, at the end of a step with these controls.
pub(crate) fn controls<const D: usize>(case: &Case<D>, to: &Controls) -> Vec<ReinforcementControl> {
    to.installed()
        .map(|index| ReinforcementControl {
            reduction: if case.reinforcement[index].reduces_bond {
                to.reduction()
            } else {
                1.0
            },
            jack: to.reinforcement[index].jack,
        })
        .collect()
}

/// The members that are there under controls.
pub(crate) fn present<'a, const D: usize>(
    case: &'a Case<D>,
    controls: &Controls,
    members: &'a [Reinforcement<D>],
) -> Vec<Installed<'a, D>> {
    std::iter::zip(controls.installed(), members)
        .map(|(index, member)| Installed {
            index,
            part: &case.reinforcement[index],
            member,
            reduction: if case.reinforcement[index].reduces_bond {
                controls.reduction()
            } else {
                1.0
            },
        })
        .collect()
}

/// A number of a member; zero for one that is not there.
pub(crate) fn quantity<const D: usize>(
    controls: &Controls,
    members: &[Reinforcement<D>],
    index: usize,
    of: ReinforcementQuantity,
) -> f64 {
    let Some((_, member)) =
        std::iter::zip(controls.installed(), members).find(|(k, _)| *k == index)
    else {
        return 0.0;
    };
    match of {
        ReinforcementQuantity::Force => member.largest_force(),
        ReinforcementQuantity::HeadForce => {
            member.segments.first().map_or(0.0, |bar| bar.state.force)
        }
        ReinforcementQuantity::AtLimit => {
            let sum = |of: &dyn Fn(&Segment) -> bool| -> f64 {
                let bars = member.segments.iter().filter(|bar| of(bar));
                bars.map(|bar| bar.length)
                    .fold(0.0, |sum, length| sum + length)
            };
            sum(&|bar| bar.state.is_at_limit) / sum(&|_| true)
        }
    }
}

/// The tension of the members that are there, for the summary.
pub(crate) fn summaries<const D: usize>(case: &Case<D>, state: &State<D>) -> Vec<MemberSummary> {
    let of = |index: usize, of| quantity(&state.controls, &state.body.reinforcement, index, of);
    state
        .controls
        .installed()
        .map(|index| MemberSummary {
            name: case.reinforcement[index].name.clone(),
            force: of(index, ReinforcementQuantity::Force),
            head_force: of(index, ReinforcementQuantity::HeadForce),
            at_limit: of(index, ReinforcementQuantity::AtLimit),
        })
        .collect()
}
