//! Reinforcement in space: lines, and square plates on the surface of the soil.

use igimp_model::ReinforcementPart;
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::reinforcement::{Member, MemberForm};

use super::Holding;
use crate::build::bodies::site::{Soil as _, Solids};

/// How far beside a head the surface is looked for, as a share of the cell \[-\].
const BESIDE: f64 = 0.02;
/// A direction along an axis has no more of another than this \[-\].
const ALONG: f64 = 1e-9;
/// Halvings until the surface is found.
const HALVINGS: usize = 60;

impl Holding<3> for Solids {
    fn refuses(&self, member: &Member<3>, problems: &mut Problems) -> bool {
        let MemberForm::Geotextile(_) = *member.form else {
            return false;
        };
        problems
            .error(
                member.form.place,
                "a geotextile is a sheet, and in space reinforcement is a line",
            )
            .help("compute a slice with analysis = \"plane-strain\", or state strips as nails");
        true
    }

    fn plate(&self, part: &ReinforcementPart<3>, width: f64) -> Vec<[f64; 3]> {
        plate(part, width, self)
    }
}

/// Three corners of a square about the head: on the surface of the soil, else across the member. One of its sides is level. What lies
/// beyond a side of the grid along which a side of the square runs is cut off, as behind a plane of symmetry.
fn plate(part: &ReinforcementPart<3>, width: f64, soil: &Solids) -> Vec<[f64; 3]> {
    let (head, next) = (part.line[0], part.line[1]);
    let normal = surface_at(&head, soil, true).or_else(|| surface_at(&head, soil, false));
    let normal = normal.or_else(|| unit(less(head, next)));
    let normal = normal.unwrap_or([0.0, 0.0, 1.0]);
    let level = unit(cross([0.0, 0.0, 1.0], normal)).unwrap_or([1.0, 0.0, 0.0]);
    let up = cross(normal, level);
    let [along, upwards] = [(level, up), (up, level)].map(|axes| reach(&head, axes, width, soil));
    let corner = |along: f64, upwards: f64| {
        std::array::from_fn(|k| head[k] + along * level[k] + upwards * up[k])
    };
    vec![
        corner(along[0], upwards[0]),
        corner(along[1], upwards[0]),
        corner(along[0], upwards[1]),
    ]
}

/// How far a plate reaches to either side of its head along a direction, with its other sides along another \[m\].
fn reach(
    head: &[f64; 3],
    (along, other): ([f64; 3], [f64; 3]),
    width: f64,
    soil: &Solids,
) -> [f64; 2] {
    let mut reach = [-0.5 * width, 0.5 * width];
    let Some(ends) = soil.ends() else {
        return reach;
    };
    for axis in 0..3 {
        if along[axis].abs() > ALONG && other[axis].abs() <= ALONG {
            let [a, b] = ends.map(|end| (end[axis] - head[axis]) / along[axis]);
            reach = [reach[0].max(a.min(b)), reach[1].min(a.max(b))];
        }
    }
    reach
}

/// The outward normal of the surface of the soil near a place, where it is flat; with the soil going on beyond upright sides of the grid,
/// where that is asked for.
fn surface_at(at: &[f64; 3], soil: &Solids, goes_on: bool) -> Option<[f64; 3]> {
    let reach = BESIDE * soil.cell();
    let step = |along: [f64; 3], by: f64| [0, 1, 2].map(|k| at[k] + by * along[k]);
    let is_soil = |mut place: [f64; 3]| {
        for axis in (0..2).filter(|_| goes_on) {
            let [lower, upper] = [soil.lower[axis], soil.upper[axis]];
            let within = place[axis].clamp(lower, upper);
            place[axis] = 2.0 * within - place[axis];
        }
        soil.regions.iter().any(|region| region.encloses(place))
    };
    let mut outwards = [0.0; 3];
    for k in 0..27 {
        let along = [k % 3, k / 3 % 3, k / 9].map(|digit| f64::from(digit) - 1.0);
        let Some(along) = unit(along) else { continue };
        let side = if is_soil(step(along, reach)) {
            -1.0
        } else {
            1.0
        };
        outwards = [0, 1, 2].map(|k| outwards[k] + side * along[k]);
    }
    let outwards = unit(outwards)?;
    let axis = (0..3).min_by(|&a, &b| outwards[a].abs().total_cmp(&outwards[b].abs()))?;
    let mut other = [0.0; 3];
    other[axis] = 1.0;
    let beside = unit(cross(outwards, other))?;
    let across = cross(outwards, beside);
    let corners = [[1.0, 0.0], [-0.5, 0.75], [-0.5, -0.75]].map(|[a, b]| {
        let along = [0, 1, 2].map(|k| a * beside[k] + b * across[k]);
        let foot = step(along, reach);
        let on_line = |by: f64| [0, 1, 2].map(|k| foot[k] + by * outwards[k]);
        let (mut inside, mut outside) = (-2.0 * reach, 2.0 * reach);
        if !is_soil(on_line(inside)) || is_soil(on_line(outside)) {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            if is_soil(on_line(middle)) {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        Some(on_line(inside))
    });
    let [a, b, c] = [corners[0]?, corners[1]?, corners[2]?];
    let normal = unit(cross(less(b, a), less(c, a)))?;
    let side: f64 = (0..3).map(|k| normal[k] * outwards[k]).sum();
    Some(normal.map(|x| x * side.signum()))
}

fn less(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// A direction of length 1, if there is one.
fn unit(of: [f64; 3]) -> Option<[f64; 3]> {
    let length = of.iter().map(|x| x * x).sum::<f64>().sqrt();
    (length > 1e-12).then(|| of.map(|x| x / length))
}
