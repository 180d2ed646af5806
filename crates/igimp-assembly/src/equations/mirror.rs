//! The upper half of a symmetric matrix from its lower one.

use std::ops::Range;

use igimp_linear::Pattern;
use rayon::prelude::*;

use crate::step::strips::split;

/// Columns of at least so many blocks are handled together.
const LEAST_BLOCKS: usize = 256;

/// Copies the entries below the diagonal, by blocks, to their places above it.
pub(crate) fn mirror(pattern: &Pattern, values: &mut [f64]) {
    let count = pattern.blocks.len();
    // Pieces so long that a block is coupled to earlier ones of its own piece and of the one before.
    let band = |block: usize| block - pattern.coupled_to(block)[0] as usize;
    let length = (0..count).map(band).fold(LEAST_BLOCKS, usize::max);
    let pieces: Vec<Range<usize>> = (0..count)
        .step_by(length)
        .map(|first| first..count.min(first + length))
        .collect();
    let stored =
        |piece: &Range<usize>| pattern.first_value[piece.start]..pattern.first_value[piece.end];
    let slices = split(values, pieces.iter().map(stored));
    let mut all: Vec<(Range<usize>, &mut [f64])> = pieces.into_iter().zip(slices).collect();
    let into_second = |pair: &mut [(Range<usize>, &mut [f64])]| {
        if let [(before, earlier), (piece, slice)] = pair {
            fill_upper(pattern, (before.clone(), earlier), (piece.clone(), slice));
        }
    };
    all.par_chunks_mut(2).for_each(into_second);
    if let Some(((piece, slice), rest)) = all.split_first_mut() {
        fill_upper(pattern, (0..0, &[]), (piece.clone(), slice));
        rest.par_chunks_mut(2).for_each(into_second);
    }
}

/// Fills the upper half of the columns of `piece`, from the lower half of these and of those before.
fn fill_upper(
    pattern: &Pattern,
    (before, earlier): (Range<usize>, &[f64]),
    (piece, slice): (Range<usize>, &mut [f64]),
) {
    let first_block = if before.is_empty() {
        piece.start
    } else {
        before.start
    };
    let first = |block: usize| pattern.first_value[block];
    // By column block: where the next row is that none of the columns of the piece has read yet.
    let mut next: Vec<usize> = (first_block..piece.end)
        .map(|block| {
            let reads = block.max(piece.start);
            let rows = pattern.coupled_to(block).iter();
            rows.take_while(|&&row| (row as usize) < reads)
                .map(|&row| pattern.blocks[row as usize].len)
                .sum()
        })
        .collect();
    for block in piece.clone() {
        let len = pattern.blocks[block].len;
        let height = pattern.height(block);
        let to = first(block) - first(piece.start);
        let mut row = 0;
        for &other in pattern.coupled_to(block) {
            let other = other as usize;
            let next = &mut next[other - first_block];
            if other == block {
                *next += len;
                break;
            }
            let other_len = pattern.blocks[other].len;
            let source = if other < piece.start {
                &earlier[first(other) - first(before.start)..]
            } else {
                &slice[first(other) - first(piece.start)..]
            };
            let (source, stride) = (&source[*next..], pattern.height(other));
            // Most nodes have three unknowns: known lengths leave nothing of the loops.
            if len == 3 && other_len == 3 {
                let block: [[f64; 3]; 3] = std::array::from_fn(|a| {
                    let column = source[a * stride..].first_chunk();
                    *column.expect("rows of a node follow one another")
                });
                for c in 0..3 {
                    let to = &mut slice[to + c * height + row..][..3];
                    for a in 0..3 {
                        to[a] = block[a][c];
                    }
                }
            } else {
                let mut block = [[0.0; 4]; 4];
                for a in 0..other_len {
                    block[a][..len].copy_from_slice(&source[a * stride..][..len]);
                }
                for a in 0..other_len {
                    for c in 0..len {
                        slice[to + c * height + row + a] = block[a][c];
                    }
                }
            }
            row += other_len;
            *next += len;
        }
    }
}
