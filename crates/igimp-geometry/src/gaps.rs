//! Gaps between regions of space that are narrower than the cells of a grid.

use crate::region::{Cover, Region};

/// A gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// A place within \[length\].
    pub at: [f64; 3],
    /// The axis across it.
    pub axis: usize,
    /// Where it begins and ends along that axis \[length\].
    pub ends: [f64; 2],
}

/// Places along a cell at which soil is looked for.
const PARTS: usize = 8;
/// Most cells at a surface, times regions, that are looked at.
const MOST: usize = 200_000;

/// A gap narrower than a cell that reaches over the next cells, too, in both directions along it: the foot of a valley does not.
/// None where there are too many cells to look.
pub fn narrow(regions: &[&dyn Region<3>], lines: &[Vec<f64>; 3]) -> Option<Gap> {
    let counts = lines.each_ref().map(|axis| axis.len().saturating_sub(1));
    let cell = |k: usize| {
        let (row, z) = (k % (counts[0] * counts[1]), k / (counts[0] * counts[1]));
        [row % counts[0], row / counts[0], z]
    };
    let ends = |at: [usize; 3], by: usize| std::array::from_fn(|axis| lines[axis][at[axis] + by]);
    let is_cut = |k: &usize| {
        let (lower, upper) = (ends(cell(*k), 0), ends(cell(*k), 1));
        let mut covers = regions.iter().map(|region| region.cover(lower, upper));
        covers.any(|cover| cover == Cover::Cut)
    };
    let all = counts
        .iter()
        .fold(1, |all: usize, count| all.saturating_mul(*count));
    if all.saturating_mul(regions.len()) > 50 * MOST {
        return None;
    }
    let cut: Vec<[usize; 3]> = (0..all).filter(is_cut).map(cell).collect();
    if cut.len() * regions.len() > MOST {
        return None;
    }
    (0..3).find_map(|axis| {
        let across = |at: &[usize; 3]| {
            let (lower, upper) = (ends(*at, 0), ends(*at, 1));
            Some((*at, gap_at(regions, axis, lower, upper)?))
        };
        let found: Vec<([usize; 3], Gap)> = cut.iter().filter_map(across).collect();
        let has = |at: [usize; 3]| {
            found
                .binary_search_by_key(&key(at), |gap| key(gap.0))
                .is_ok()
        };
        let goes_on = |at: &[usize; 3], along: usize| {
            let beside = |by: fn(usize) -> Option<usize>| {
                let mut other = *at;
                by(at[along]).is_some_and(|place| {
                    other[along] = place;
                    has(other)
                })
            };
            counts[along] == 1 || beside(|k| k.checked_sub(1)) || beside(|k| Some(k + 1))
        };
        let is_sheet =
            |gap: &&([usize; 3], Gap)| (0..3).all(|along| along == axis || goes_on(&gap.0, along));
        found.iter().find(is_sheet).map(|gap| gap.1)
    })
}

/// The order of cells.
fn key([x, y, z]: [usize; 3]) -> [usize; 3] {
    [z, y, x]
}

/// A gap on the line through the middle of a cell, from half a cell before it to half a cell behind.
fn gap_at(
    regions: &[&dyn Region<3>],
    axis: usize,
    lower: [f64; 3],
    upper: [f64; 3],
) -> Option<Gap> {
    let size = upper[axis] - lower[axis];
    let point = |along: f64| {
        let mut at: [f64; 3] = std::array::from_fn(|k| 0.5 * (lower[k] + upper[k]));
        at[axis] = along;
        at
    };
    let is_soil = |along: f64| regions.iter().any(|region| region.encloses(point(along)));
    let place = |k: usize| lower[axis] + size * ((k as f64 + 0.5) / PARTS as f64 - 0.5);
    let soil: Vec<bool> = (0..2 * PARTS).map(|k| is_soil(place(k))).collect();
    let begin = (1..2 * PARTS).find(|&k| soil[k - 1] && !soil[k])?;
    let end = (begin..2 * PARTS).find(|&k| soil[k])?;
    let border = |mut inside: f64, mut outside: f64| {
        for _ in 0..40 {
            let middle = 0.5 * (inside + outside);
            if is_soil(middle) {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        0.5 * (inside + outside)
    };
    let ends = [
        border(place(begin - 1), place(begin)),
        border(place(end), place(end - 1)),
    ];
    (ends[1] - ends[0] < size * (1.0 - 1e-6)).then(|| Gap {
        at: point(0.5 * (ends[0] + ends[1])),
        axis,
        ends,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::Polygon;
    use crate::solid::Prism;

    /// Grid lines of so many cells of 1 m.
    fn lines(counts: [usize; 3]) -> [Vec<f64>; 3] {
        counts.map(|count| (0..=count).map(|k| k as f64).collect())
    }

    fn prism(outline: &[[f64; 2]], across: [f64; 2]) -> Prism {
        let outline: Polygon = outline.to_vec();
        Prism::new(outline, 1, across)
    }

    fn gap(parts: &[Prism]) -> Option<Gap> {
        let regions: Vec<&dyn Region<3>> = parts.iter().map(|part| part as _).collect();
        narrow(&regions, &lines([12, 5, 8]))
    }

    /// GOAL: a slot narrower than a cell is found, in one region and between two, on lines of the grid and off them; one as wide
    /// as a cell is none. ORACLE: the slot.
    #[test]
    fn a_narrow_slot_is_found() {
        let slotted = |from: f64, to: f64| {
            let [foot, top] = [2.0, 8.0];
            let outline = [
                [0.0, 0.0],
                [12.0, 0.0],
                [12.0, top],
                [to, top],
                [to, foot],
                [from, foot],
                [from, top],
                [0.0, top],
            ];
            gap(&[prism(&outline, [0.0, 5.0])])
        };
        for ends in [[6.2, 6.5], [6.0, 6.3], [5.9, 6.2]] {
            let found = slotted(ends[0], ends[1]).unwrap();
            assert_eq!(found.axis, 0);
            let apart = std::iter::zip(found.ends, ends).map(|(a, b)| (a - b).abs());
            assert!(apart.fold(0.0, f64::max) < 1e-6, "{found:?}");
        }
        assert_eq!(slotted(6.0, 7.0), None);
        let whole = [[0.0, 0.0], [12.0, 0.0], [12.0, 8.0], [0.0, 8.0]];
        let two = |at: f64| [prism(&whole, [0.0, 2.4]), prism(&whole, [at, 5.0])];
        assert_eq!(gap(&two(2.4)), None);
        assert_eq!(gap(&two(2.7)).unwrap().axis, 1);
    }

    /// GOAL: the foot of a valley and a toe are no gaps, however narrow they are at their lowest.
    #[test]
    fn a_valley_is_no_gap() {
        let valley = [
            [0.0, 0.0],
            [12.0, 0.0],
            [12.0, 8.0],
            [6.3, 2.3],
            [0.6, 8.0],
            [0.0, 8.0],
        ];
        assert_eq!(gap(&[prism(&valley, [0.0, 5.0])]), None);
    }
}
