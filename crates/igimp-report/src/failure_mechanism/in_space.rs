//! The surface in space over which soil begins to fail: below it soil stands, above it soil moves (theory, under eq. 44).

use std::collections::BTreeMap;

/// Columns count where the soil on top moves by at least this share of the most \[-\].
const MOVES: f64 = 0.2;
/// Soil stands where it moves by less than this share of the most above it, and moves as one from the other share on \[-\].
const STANDS: f64 = 0.25;
const GOES: f64 = 0.75;
/// Between the two lies no more than this share of the soil above the surface \[-\].
const SHARP: f64 = 0.8;
/// A surface has at least so many columns.
const FEWEST: usize = 16;

/// Two equilibria in space and the displacements of the particles between them.
#[derive(Clone, Copy, Debug)]
pub struct IncrementInSpace<'a> {
    /// Centres of the particles \[length\].
    pub x: &'a [[f64; 3]],
    /// Their half-lengths \[length\].
    pub half_length: &'a [[f64; 3]],
    /// Displacements from the first to the second \[length\].
    pub moved: &'a [[f64; 3]],
}

/// A particle of a column: its level, and how far it moved.
type Level = (f64, f64);

impl IncrementInSpace<'_> {
    /// Points of the surface, one for each column of particles in plan in which it stands out: where soil moves half as far as the
    /// soil above it. Empty where they are few.
    pub fn slip_surface(&self) -> Vec<[f64; 3]> {
        let length = |d: &[f64; 3]| d.iter().fold(0.0_f64, |sum, x| sum.hypot(*x));
        let most = self.moved.iter().map(length).fold(0.0, f64::max);
        let size: [f64; 2] = [0, 1].map(|axis| {
            let sides = self.half_length.iter().map(|half| 2.0 * half[axis]);
            sides.fold(f64::MIN_POSITIVE, f64::max)
        });
        let first: [f64; 2] = [0, 1].map(|axis| {
            let places = self.x.iter().map(|at| at[axis]);
            places.fold(f64::MAX, f64::min) - 0.5 * size[axis]
        });
        let mut columns: BTreeMap<[i64; 2], Vec<Level>> = BTreeMap::new();
        for (at, moved) in std::iter::zip(self.x, self.moved) {
            let column = [0, 1].map(|axis| ((at[axis] - first[axis]) / size[axis]).floor() as i64);
            let levels = columns.entry(column).or_default();
            levels.push((at[2], length(moved)));
        }
        let point = |(column, mut levels): ([i64; 2], Vec<Level>)| {
            levels.sort_by(|a, b| a.0.total_cmp(&b.0));
            let level = half_way(&levels, MOVES * most)?;
            let [x, y] = [0, 1].map(|axis| first[axis] + (column[axis] as f64 + 0.5) * size[axis]);
            Some([x, y, level])
        };
        let points: Vec<[f64; 3]> = columns.into_iter().filter_map(point).collect();
        if points.len() < FEWEST {
            return Vec::new();
        }
        points
    }
}

/// The highest level at which soil moves half as far as the most above it, if it moves by as much as `least` there and the
/// change is sharp.
fn half_way(levels: &[Level], least: f64) -> Option<f64> {
    let most = levels.iter().map(|at| at.1).fold(0.0, f64::max);
    let moves = most > 0.0 && most >= least;
    // From above: the highest level below which soil moves by less than a share of the most.
    let level = |share: f64| {
        let below = levels.iter().rposition(|at| at.1 < share * most)?;
        let [a, b] = levels.get(below..below + 2)?.try_into().ok()?;
        Some(a.0 + (b.0 - a.0) * (share * most - a.1) / (b.1 - a.1))
    };
    let [stands, half, goes] = [level(STANDS)?, level(0.5)?, level(GOES)?];
    let top = levels.last()?.0;
    (moves && goes - stands <= SHARP * (top - half)).then_some(half)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Particles on a lattice with their displacements.
    fn lattice(moves: impl Fn([f64; 3]) -> f64) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
        let n = 20;
        let places = (0..n * n * n).map(|k| [k % n, k / n % n, k / (n * n)]);
        let x: Vec<[f64; 3]> = places.map(|at| at.map(|i| f64::from(i) + 0.5)).collect();
        let moved = x.iter().map(|&at| [moves(at), 0.0, 0.0]).collect();
        (x, moved)
    }

    fn surface((x, moved): &(Vec<[f64; 3]>, Vec<[f64; 3]>)) -> Vec<[f64; 3]> {
        let half_length = vec![[0.5; 3]; x.len()];
        let increment = IncrementInSpace {
            x,
            half_length: &half_length,
            moved,
        };
        increment.slip_surface()
    }

    /// GOAL: the surface is that over which a block slides, within half a particle. ORACLE: a sphere in which soil moves.
    #[test]
    fn a_block_slides_on_its_surface() {
        let centre = [10.0, 10.0, 24.0];
        let off = |at: [f64; 3]| (0..3).fold(0.0_f64, |sum, k| sum.hypot(at[k] - centre[k]));
        // Over a band of two particles.
        let found = surface(&lattice(|at| {
            ((13.0 - off(at)) / 2.0 + 0.5).clamp(0.0, 1.0)
        }));
        assert!(found.len() > 250, "{}", found.len());
        for point in found {
            assert!((off(point) - 13.0).abs() < 0.5, "{point:?}");
        }
    }

    /// GOAL: soil that settles, stands or moves as a whole has no slip surface.
    #[test]
    fn soil_without_a_block_has_none() {
        for moves in [|at: [f64; 3]| at[2], |_| 1.0, |_| 0.0] {
            assert_eq!(surface(&lattice(moves)), Vec::<[f64; 3]>::new());
        }
        assert_eq!(surface(&(Vec::new(), Vec::new())), Vec::<[f64; 3]>::new());
    }
}
