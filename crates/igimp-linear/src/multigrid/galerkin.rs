//! The matrix of a coarser grid, Pᵀ A P.

use rayon::prelude::*;

use super::rows::Couplings;
use super::transfer::Transfer;

/// Marks a node that is not in the list at hand.
const NONE: u32 = u32::MAX;
/// Coarse nodes that one task works on.
const CHUNK: usize = 16;

/// Scratch memory of a task to find places in lists.
struct Scratch {
    /// Where a fine node stands in `columns`.
    fine: Vec<u32>,
    /// Where a coarse node stands in the list of the node at hand.
    coarse: Vec<u32>,
    /// The fine nodes that the children are coupled to.
    columns: Vec<u32>,
    /// Rows of Pᵀ A, B × B entries for each of them.
    product: Vec<f32>,
}

/// Sets `target` to the entries of Pᵀ A P.
pub(super) fn product<const B: usize>(
    transfer: &Transfer,
    fine: &Couplings,
    values: &[f32],
    coarse: &Couplings,
    target: &mut Vec<f32>,
) {
    target.clear();
    target.resize(coarse.entries::<B>(), 0.0);
    let mut parts = Vec::with_capacity(coarse.len().div_ceil(CHUNK));
    let mut rest = &mut target[..];
    for start in (0..coarse.len()).step_by(CHUNK) {
        let end = (start + CHUNK).min(coarse.len());
        let (part, later) = rest.split_at_mut(coarse.first::<B>(end) - coarse.first::<B>(start));
        rest = later;
        parts.push((start..end, part));
    }
    let scratch = || Scratch {
        fine: vec![NONE; fine.len()],
        coarse: vec![NONE; coarse.len()],
        columns: Vec::new(),
        product: Vec::new(),
    };
    parts
        .into_par_iter()
        .for_each_init(scratch, |scratch, (nodes, mut part)| {
            for node in nodes {
                let (out, later) = part.split_at_mut(B * B * coarse.of(node).len());
                part = later;
                row::<B>(transfer, fine, values, coarse.of(node), node, scratch, out);
            }
        });
}

/// The entries of one coarse node.
fn row<const B: usize>(
    transfer: &Transfer,
    fine: &Couplings,
    values: &[f32],
    list: &[u32],
    node: usize,
    scratch: &mut Scratch,
    target: &mut [f32],
) {
    scratch.columns.clear();
    scratch.product.clear();
    for &(child, weight) in transfer.children(node) {
        let child = child as usize;
        let others = fine.of(child);
        let width = B * others.len();
        let entries = &values[fine.first::<B>(child)..][..B * width];
        for (place, &other) in others.iter().enumerate() {
            let slot = &mut scratch.fine[other as usize];
            if *slot == NONE {
                *slot = scratch.columns.len() as u32;
                scratch.columns.push(other);
                scratch.product.resize(scratch.product.len() + B * B, 0.0);
            }
            let into = &mut scratch.product[B * B * *slot as usize..][..B * B];
            for (r, into) in into.chunks_exact_mut(B).enumerate() {
                for (into, entry) in into.iter_mut().zip(&entries[r * width + B * place..][..B]) {
                    *into += weight * entry;
                }
            }
        }
    }
    for (place, &other) in list.iter().enumerate() {
        scratch.coarse[other as usize] = place as u32;
    }
    let width = B * list.len();
    for (&column, product) in scratch
        .columns
        .iter()
        .zip(scratch.product.chunks_exact(B * B))
    {
        for &(parent, weight) in transfer.parents(column as usize) {
            let place = scratch.coarse[parent as usize] as usize;
            for (r, product) in product.chunks_exact(B).enumerate() {
                let into = &mut target[r * width + B * place..][..B];
                for (into, entry) in into.iter_mut().zip(product) {
                    *into += weight * entry;
                }
            }
        }
        scratch.fine[column as usize] = NONE;
    }
    for &other in list {
        scratch.coarse[other as usize] = NONE;
    }
}
