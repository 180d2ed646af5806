//! The meshes of a study, and the differences of their problems.

use igimp_text::short;

use crate::{Case, LoadKind, RigidPart, RigidShape};

/// Into how many parts each mesh cuts the cells of the case, in each direction.
const HALVES: [usize; 3] = [1, 2, 4];
/// The same where the edge of a footing or body lies in the middle of a cell: it stays there.
const ODD: [usize; 3] = [1, 3, 5];
/// Places closer than this share of a cell are the same \[-\].
const NEAR: f64 = 1e-6;

/// Into how many parts the meshes of a case's study cut its cells in each direction, from 1.
///
/// 1, 2, 4; but 1, 3, 5 with a rigid footing or body whose edge lies in the middle of a cell. The footing
/// holds the nodes below it, and acts about half a cell wider than they reach; a body ties the soil that
/// shares a cell with its side: only with edges at the same place within a cell are the meshes those of
/// one body.
pub fn refinements<const D: usize>(case: &Case<D>) -> Vec<usize> {
    let is_mid_cell = |end: &f64| (offset(case, *end) - 0.5).abs() < NEAR;
    let has_mid_cell = footing_ends(case).iter().any(is_mid_cell) || !mid_cell(case).is_empty();
    let parts = if has_mid_cell { ODD } else { HALVES };
    parts[..case.mesh_study.meshes.clamp(1, parts.len())].to_vec()
}

/// Upright sides of rigid bodies in the middle of a cell, ascending \[m\].
pub fn mid_cell<const D: usize>(case: &Case<D>) -> Vec<f64> {
    let sides = case.rigid.iter().flat_map(|part| upright_sides(case, part));
    let mut sides: Vec<f64> = sides
        .filter(|&end| (offset(case, end) - 0.5).abs() < NEAR)
        .collect();
    sides.sort_by(f64::total_cmp);
    sides.dedup();
    sides
}

/// The cases of a study, from coarse to fine.
pub fn meshes<const D: usize>(case: &Case<D>) -> Vec<Case<D>> {
    let mesh = |&parts: &usize| {
        let mut mesh = case.refined(parts);
        mesh.mesh_study.meshes = 1;
        mesh
    };
    refinements(case).iter().map(mesh).collect()
}

/// The size of the cells of a mesh that cuts them into so many parts, as in `h/2`.
pub fn label(parts: usize) -> String {
    match parts {
        1 => "h".to_owned(),
        parts => format!("h/{parts}"),
    }
}

/// Reasons why the meshes of a study are not meshes of one problem, in sentences.
pub fn differences<const D: usize>(case: &Case<D>) -> Vec<String> {
    let parts = refinements(case);
    let (Some(&first), Some(&last)) = (parts.first(), parts.last()) else {
        return Vec::new();
    };
    let mut remarks = Vec::new();
    let keeps_its_place = |end: f64| {
        let share = offset(case, end);
        parts.iter().all(|&parts| {
            let finer = (share * parts as f64).rem_euclid(1.0);
            (finer - share).abs() < NEAR || (finer - share).abs() > 1.0 - NEAR
        })
    };
    for end in footing_ends(case) {
        if !keeps_its_place(end) {
            remarks.push(format!(
                "the edge of the footing at x = {} m has another place in its cell on every mesh: the \
                 meshes are those of footings of different width",
                short(end)
            ));
        }
    }
    for part in &case.rigid {
        for end in upright_sides(case, part) {
            if !keeps_its_place(end) {
                remarks.push(format!(
                    "the side of the rigid body `{}` at x = {} m has another place in its cell on every \
                     mesh: it acts wider or narrower by another share of the cell on each",
                    part.name,
                    short(end)
                ));
            }
        }
    }
    for held in &case.boundaries.boxes {
        let moves = (0..2).any(|axis| {
            [(held.lower[axis], 1.0), (held.upper[axis], -1.0)]
                .into_iter()
                .any(|(end, inwards)| {
                    let [coarse, fine] =
                        [first, last].map(|parts| outermost(case, axis, end, inwards, parts));
                    (coarse - fine).abs() > NEAR
                })
        });
        if moves {
            remarks.push(format!(
                "box `{}` holds more nodes at its edges on the finer meshes: it is larger there",
                held.name
            ));
        }
    }
    remarks
}

/// The ends of rigid footings that do not lie at a side of the grid \[m\].
fn footing_ends<const D: usize>(case: &Case<D>) -> Vec<f64> {
    let mut ends = Vec::new();
    for load in &case.loads {
        if let LoadKind::RigidFooting { from, to, .. } = load.kind {
            ends.extend([from[0], to[0]]);
        }
    }
    ends.retain(|&end| is_within(case, end));
    ends
}

/// The upright sides of a rigid body that stand within the grid, and where a circle is widest \[m\].
fn upright_sides<const D: usize>(case: &Case<D>, part: &RigidPart<D>) -> Vec<f64> {
    let mut ends: Vec<f64> = match part.shape.in_plane() {
        Some(RigidShape::Polygon(corners)) => {
            let next = corners.iter().cycle().skip(1);
            let sides = std::iter::zip(corners, next);
            sides
                .filter(|(a, b)| (place(case, 0, a[0]) - place(case, 0, b[0])).abs() < NEAR)
                .map(|(a, _)| a[0])
                .collect()
        }
        Some(RigidShape::Circle { centre, radius }) => {
            vec![centre[0] - radius, centre[0] + radius]
        }
        None => return Vec::new(),
    };
    ends.retain(|&end| is_within(case, end));
    ends
}

/// Whether an x lies between the sides of the grid.
fn is_within<const D: usize>(case: &Case<D>, x: f64) -> bool {
    let columns = case.grid.cells()[0] as f64;
    let place = place(case, 0, x);
    place > NEAR && place < columns - NEAR
}

/// Where a coordinate lies, in cells from the lower side.
fn place<const D: usize>(case: &Case<D>, axis: usize, x: f64) -> f64 {
    case.grid.axes[axis].place(x)
}

/// Where in its cell an x lies, as a share of the cell from 0 to below 1 \[-\].
fn offset<const D: usize>(case: &Case<D>, x: f64) -> f64 {
    let share = place(case, 0, x).rem_euclid(1.0);
    if share > 1.0 - NEAR { 0.0 } else { share }
}

/// The node next to the end of a box on the side where the box lies, in cells of the case; on a mesh
/// that cuts them into so many parts. An end beyond the grid stands for its side.
fn outermost<const D: usize>(
    case: &Case<D>,
    axis: usize,
    end: f64,
    inwards: f64,
    parts: usize,
) -> f64 {
    let columns = case.grid.cells()[axis] as f64;
    let parts = parts as f64;
    let place = place(case, axis, end).clamp(0.0, columns) * parts;
    let node = if inwards > 0.0 {
        (place - NEAR).ceil()
    } else {
        (place + NEAR).floor()
    };
    node / parts
}
