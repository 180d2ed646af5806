//! Water tables, and the surface of free water above the ground.

use igimp_figures::{Outline, OutlineStyle, Polygon};
use igimp_geometry::polygon::bounding_box;
use igimp_model::{Case, Cut, PoreSource, WaterCondition, table_level};

/// The water tables of a condition between two places along x \[m\]; bodies that are there and have a table of their own show
/// it over their width.
pub fn tables(
    case: &Case<2>,
    condition: &WaterCondition,
    there: impl Fn(usize) -> bool,
    ends: [f64; 2],
) -> Vec<Outline> {
    let local = condition.bodies.iter().filter(|(body, _)| there(*body));
    let local = local.map(|(body, source)| {
        let (lower, upper) = bounding_box(case.bodies[*body].polygon());
        (source, [lower[0].max(ends[0]), upper[0].min(ends[1])])
    });
    let all = std::iter::once((&condition.source, ends)).chain(local);
    all.filter_map(|(source, ends)| table(source, ends))
        .collect()
}

/// The water tables at the end of a stage between two places along x \[m\].
pub fn tables_after(case: &Case<2>, stage: usize, ends: [f64; 2]) -> Vec<Outline> {
    let condition = case.water_after(stage).and_then(|k| case.water.get(k));
    let there = case.bodies_after(stage);
    condition.map_or_else(Vec::new, |condition| {
        tables(case, condition, |body| there[body], ends)
    })
}

/// A water table between two places.
fn table(source: &PoreSource, [left, right]: [f64; 2]) -> Option<Outline> {
    let PoreSource::Table(line) = source else {
        return None;
    };
    if line.is_empty() || right <= left {
        return None;
    }
    let at = |x: f64| [x, table_level(line, x)];
    let between = line
        .iter()
        .filter(|point| left < point[0] && point[0] < right);
    let points = std::iter::once(at(left)).chain(between.copied());
    Some(Outline {
        points: points.chain([at(right)]).collect(),
        style: OutlineStyle::Water,
    })
}

/// Places along a cut at which the level of a water table is taken.
const ALONG: usize = 100;

/// Water tables over an upright cut through domains of soil in space.
pub(super) fn over_cut(tables: &[PoreSource], plane: Cut, domains: &[Polygon]) -> Vec<Outline> {
    let across = match plane.axis {
        0 => 1,
        1 => 0,
        _ => return Vec::new(),
    };
    let ends = domains.iter().flatten().map(|corner| corner[0]);
    let [from, to] = ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[from, to], x| {
        [from.min(x), to.max(x)]
    });
    if from >= to {
        return Vec::new();
    }
    let line = |table: &PoreSource| {
        let point = |k: usize| {
            let along = from + k as f64 / ALONG as f64 * (to - from);
            let mut place = [plane.at; 3];
            place[across] = along;
            let level = table.table(&place).filter(|level| level.is_finite())?;
            Some([along, level])
        };
        let points: Vec<[f64; 2]> = (0..=ALONG).filter_map(point).collect();
        (points.len() > 1).then_some(Outline {
            points,
            style: OutlineStyle::Water,
        })
    };
    tables.iter().filter_map(line).collect()
}

/// The words of a caption for the water tables in its picture.
pub(super) fn legend(outlines: &[Outline]) -> &'static str {
    let is_water = |outline: &Outline| outline.style == OutlineStyle::Water;
    if outlines.iter().any(is_water) {
        "; blue: the water table"
    } else {
        ""
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: a water table is level beyond its ends and cut where the picture ends.
    #[test]
    fn a_water_table_goes_from_end_to_end() {
        let line = vec![[2.0, 1.0], [4.0, 3.0], [9.0, 3.0]];
        let drawn = |ends| table(&PoreSource::Table(line.clone()), ends).map(|curve| curve.points);
        let whole = vec![[0.0, 1.0], [2.0, 1.0], [4.0, 3.0], [6.0, 3.0]];
        assert_eq!(drawn([0.0, 6.0]), Some(whole));
        assert_eq!(drawn([2.5, 3.5]), Some(vec![[2.5, 1.5], [3.5, 2.5]]));
        assert_eq!(drawn([3.0, 3.0]), None);
        let none = table(&PoreSource::Ratio(0.3), [0.0, 1.0]);
        assert!(none.is_none());
    }
}
