//! Whether a box or a side of the grid meets soil at any time.

use igimp_model::BodyPart;

use super::sequence::Sequence;

/// Share of a box that soil has to fill, to meet it \[-\].
const MET: f64 = 1e-9;

/// Bodies that are ever there, each by its own extent; none where one is not known.
pub(super) fn ever<'a, const D: usize>(
    bodies: &'a [Option<BodyPart<D>>],
    sequence: &'a Sequence,
) -> Option<impl Iterator<Item = &'a BodyPart<D>>> {
    let is_there = |body: usize| {
        (sequence.scenes()).any(|scene| scene.present.get(body).is_some_and(|there| *there))
    };
    (bodies.iter().all(Option::is_some)).then(|| {
        let all = bodies.iter().flatten().enumerate();
        all.filter(move |(body, _)| is_there(*body))
            .map(|(_, part)| part)
    })
}

/// Whether soil is ever within a box \[m\]; so it is where a body is not known.
pub(crate) fn meets_box<const D: usize>(
    bodies: &[Option<BodyPart<D>>],
    sequence: &Sequence,
    [lower, upper]: [[f64; D]; 2],
) -> bool {
    let sides = std::iter::zip(lower, upper).map(|(a, b)| b - a);
    let least = MET * sides.product::<f64>();
    ever(bodies, sequence)
        .is_none_or(|mut parts| parts.any(|part| part.region.within(lower, upper).volume > least))
}

/// Whether soil ever reaches the lower or the upper side of the grid along an axis; so it does where a body is not known.
pub(crate) fn meets_side<const D: usize>(
    bodies: &[Option<BodyPart<D>>],
    sequence: &Sequence,
    (axis, is_upper): (usize, bool),
    ends: [[f64; D]; 2],
) -> bool {
    let near = 1e-6 * (ends[1][axis] - ends[0][axis]);
    let reaches = |part: &BodyPart<D>| {
        let (lower, upper) = part.region.bounds();
        if is_upper {
            upper[axis] >= ends[1][axis] - near
        } else {
            lower[axis] <= ends[0][axis] + near
        }
    };
    ever(bodies, sequence).is_none_or(|mut parts| parts.any(reaches))
}

/// Whether soil is ever at a place on an axis; so it is where a body is not known.
pub(crate) fn meets_plane<const D: usize>(
    bodies: &[Option<BodyPart<D>>],
    sequence: &Sequence,
    (axis, at): (usize, f64),
) -> bool {
    let holds = |part: &BodyPart<D>| {
        let (lower, upper) = part.region.bounds();
        let near = 1e-6 * (upper[axis] - lower[axis]);
        lower[axis] - near <= at && at <= upper[axis] + near
    };
    ever(bodies, sequence).is_none_or(|mut parts| parts.any(holds))
}
