//! The particle nearest to a point, among particles that were seeded cell by cell.
//!
//! Blocks of 2^D cells, of 2^D of these and so on know whether they hold a particle. The search goes
//! down from the largest into the nearest first, and leaves out what is further than what it has found.

use super::{Parts, TIE, place_of};

/// Blocks further than this much beyond the best are left out: round-off of their distance \[-\].
const ROUND_OFF: f64 = 1e-9;

/// The points that are searched.
#[derive(Debug)]
pub(super) struct Nearest<'a, const D: usize> {
    x: &'a [[f64; D]],
    /// By cell, its first particle; one more at the end.
    first: &'a [usize],
    /// By direction, the ends of the cells.
    lines: [Vec<f64>; D],
    /// Cells, blocks of cells, blocks of these, …, one block.
    levels: Vec<Level<D>>,
}

#[derive(Debug)]
struct Level<const D: usize> {
    counts: [usize; D],
    is_held: Vec<bool>,
}

impl<const D: usize> Level<D> {
    fn index(&self, place: [usize; D]) -> usize {
        let rows = |index, axis: usize| index * self.counts[axis] + place[axis];
        (0..D).rev().fold(0, rows)
    }

    /// The blocks that 2^D of these make.
    fn coarser(&self) -> Self {
        let counts = self.counts.map(|count| count.div_ceil(2));
        let mut coarser = Self {
            counts,
            is_held: vec![false; counts.iter().product()],
        };
        for (number, &is_held) in self.is_held.iter().enumerate() {
            if is_held {
                let block = coarser.index(place_of(number, self.counts).map(|place| place / 2));
                coarser.is_held[block] = true;
            }
        }
        coarser
    }
}

/// A block to look into.
#[derive(Clone, Copy, Debug)]
struct Block<const D: usize> {
    distance: f64,
    level: usize,
    place: [usize; D],
}

impl<'a, const D: usize> Nearest<'a, D> {
    /// Of particles at these places, one or more, in the order of the cells.
    pub(super) fn new(parts: &Parts<D>, x: &'a [[f64; D]], first: &'a [usize]) -> Self {
        let lines = std::array::from_fn(|axis| {
            let lower = parts.cells[axis].iter().map(|[lower, _]| *lower);
            lower.chain([parts.end[axis]]).collect()
        });
        let cells = Level {
            counts: std::array::from_fn(|axis| parts.cells[axis].len()),
            is_held: first.windows(2).map(|pair| pair[0] < pair[1]).collect(),
        };
        let mut levels = vec![cells];
        while let Some(finest) = levels.last()
            && finest.is_held.len() > 1
        {
            levels.push(finest.coarser());
        }
        Self {
            x,
            first,
            lines,
            levels,
        }
    }

    /// The particle nearest to a point; of several the first.
    pub(super) fn to(&self, point: [f64; D]) -> usize {
        let top = Block {
            distance: 0.0,
            level: self.levels.len() - 1,
            place: [0; D],
        };
        let mut open = vec![top];
        let (mut nearest, mut best) = (0, f64::INFINITY);
        while let Some(block) = open.pop() {
            if block.distance > best * (1.0 + ROUND_OFF) {
                continue;
            }
            let level = &self.levels[block.level];
            if block.level == 0 {
                let cell = level.index(block.place);
                for particle in self.first[cell]..self.first[cell + 1] {
                    let apart = self.x[particle];
                    let distance =
                        length::<D>(std::array::from_fn(|axis| apart[axis] - point[axis]));
                    let is_nearer = distance < (1.0 - TIE) * best;
                    if is_nearer || distance <= (1.0 + TIE) * best && particle < nearest {
                        (nearest, best) = (particle, distance);
                    }
                }
                continue;
            }
            let start = open.len();
            self.finer(block, &point, &mut open);
            open[start..].sort_by(|a, b| b.distance.total_cmp(&a.distance));
        }
        nearest
    }

    /// The blocks with particles that make up a block.
    fn finer(&self, block: Block<D>, point: &[f64; D], open: &mut Vec<Block<D>>) {
        let level = block.level - 1;
        let finer = &self.levels[level];
        for corner in 0..1 << D {
            let place: [usize; D] =
                std::array::from_fn(|axis| 2 * block.place[axis] + (corner >> axis & 1));
            let exists = (0..D).all(|axis| place[axis] < finer.counts[axis]);
            if exists && finer.is_held[finer.index(place)] {
                let gap = |axis: usize| {
                    let lines = &self.lines[axis];
                    let from = lines[place[axis] << level];
                    let to = lines[((place[axis] + 1) << level).min(lines.len() - 1)];
                    (from - point[axis]).max(point[axis] - to).max(0.0)
                };
                let distance = length::<D>(std::array::from_fn(gap));
                open.push(Block {
                    distance,
                    level,
                    place,
                });
            }
        }
    }
}

fn length<const D: usize>(vector: [f64; D]) -> f64 {
    vector.into_iter().fold(0.0, f64::hypot)
}
