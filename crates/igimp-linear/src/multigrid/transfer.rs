//! From one grid to the next coarser one, which has every second line: trilinear interpolation between nodes.
//!
//! U. Trottenberg, C. W. Oosterlee & A. Schüller, *Multigrid*, Academic Press 2001, sections 2.3 and 2.7. A coarse node is made
//! wherever a fine one asks for it, also beyond the rim of the body and on supports, so that every linear field is kept.

use super::rows::Couplings;

/// Interpolation from a coarse grid.
#[derive(Clone, Debug, Default)]
pub(super) struct Transfer {
    /// Start of the parents of each fine node, length fine nodes + 1.
    starts: Vec<u32>,
    /// Coarse nodes with their weights.
    parents: Vec<(u32, f32)>,
    /// Start of the children of each coarse node, length coarse nodes + 1.
    coarse_starts: Vec<u32>,
    /// Fine nodes with their weights, ascending.
    children: Vec<(u32, f32)>,
}

impl Transfer {
    /// Between the nodes at `places` and those of the next coarser grid, whose places are returned: sorted, the last
    /// axis first.
    pub(super) fn new(places: &[[usize; 3]]) -> (Self, Vec<[usize; 3]>) {
        let mut coarse: Vec<[usize; 3]> = places
            .iter()
            .flat_map(parents_of)
            .map(|(at, _)| at)
            .collect();
        let key = |place: &[usize; 3]| [place[2], place[1], place[0]];
        coarse.sort_unstable_by_key(key);
        coarse.dedup();
        let mut transfer = Self {
            starts: vec![0],
            parents: Vec::new(),
            coarse_starts: vec![0; coarse.len() + 1],
            children: Vec::new(),
        };
        for place in places {
            for (at, weight) in parents_of(place) {
                if let Ok(parent) = coarse.binary_search_by_key(&key(&at), key) {
                    transfer.parents.push((parent as u32, weight));
                    transfer.coarse_starts[parent + 1] += 1;
                }
            }
            transfer.starts.push(transfer.parents.len() as u32);
        }
        for parent in 0..coarse.len() {
            transfer.coarse_starts[parent + 1] += transfer.coarse_starts[parent];
        }
        let mut next = transfer.coarse_starts.clone();
        transfer.children = vec![(0, 0.0); transfer.parents.len()];
        for node in 0..places.len() {
            let range = transfer.starts[node] as usize..transfer.starts[node + 1] as usize;
            for &(parent, weight) in &transfer.parents[range] {
                let slot = &mut next[parent as usize];
                transfer.children[*slot as usize] = (node as u32, weight);
                *slot += 1;
            }
        }
        (transfer, coarse)
    }

    /// The coarse nodes that a fine node is interpolated from.
    pub(super) fn parents(&self, node: usize) -> &[(u32, f32)] {
        &self.parents[self.starts[node] as usize..self.starts[node + 1] as usize]
    }

    /// The fine nodes that a coarse node takes part in.
    pub(super) fn children(&self, node: usize) -> &[(u32, f32)] {
        &self.children[self.coarse_starts[node] as usize..self.coarse_starts[node + 1] as usize]
    }

    /// Number of coarse nodes.
    pub(super) fn coarse_nodes(&self) -> usize {
        self.coarse_starts.len() - 1
    }

    /// Which coarse nodes are coupled where the fine ones are so.
    pub(super) fn coarse_couplings(&self, fine: &Couplings) -> Couplings {
        let mut seen = vec![u32::MAX; self.coarse_nodes()];
        let mut seen_fine = vec![u32::MAX; fine.len()];
        let (mut starts, mut nodes) = (vec![0], Vec::new());
        for node in 0..self.coarse_nodes() {
            let start = nodes.len();
            for &(child, _) in self.children(node) {
                for &other in fine.of(child as usize) {
                    if std::mem::replace(&mut seen_fine[other as usize], node as u32) == node as u32
                    {
                        continue;
                    }
                    for &(parent, _) in self.parents(other as usize) {
                        if std::mem::replace(&mut seen[parent as usize], node as u32) != node as u32
                        {
                            nodes.push(parent);
                        }
                    }
                }
            }
            nodes[start..].sort_unstable();
            starts.push(nodes.len());
        }
        Couplings::new(starts, nodes)
    }

    /// b_c ← Pᵀ r.
    pub(super) fn restrict<const B: usize>(&self, fine: &[f32], coarse: &mut [f32]) {
        for (node, out) in coarse.chunks_exact_mut(B).enumerate() {
            let mut sum = [0.0; B];
            for &(child, weight) in self.children(node) {
                for (sum, value) in sum.iter_mut().zip(&fine[B * child as usize..][..B]) {
                    *sum += weight * value;
                }
            }
            out.copy_from_slice(&sum);
        }
    }

    /// x ← x + P e.
    pub(super) fn add_interpolated<const B: usize>(&self, coarse: &[f32], fine: &mut [f32]) {
        for (node, out) in fine.chunks_exact_mut(B).enumerate() {
            for &(parent, weight) in self.parents(node) {
                for (x, value) in out.iter_mut().zip(&coarse[B * parent as usize..][..B]) {
                    *x += weight * value;
                }
            }
        }
    }
}

/// Places on the coarser grid that a place lies between, with their weights.
fn parents_of(place: &[usize; 3]) -> impl Iterator<Item = ([usize; 3], f32)> + use<> {
    let place = *place;
    (0..8_usize).filter_map(move |corner| {
        let mut at = [0; 3];
        let mut weight = 1.0;
        for axis in 0..3 {
            let beyond = corner >> axis & 1;
            let between = place[axis] % 2;
            if beyond > between {
                return None;
            }
            at[axis] = place[axis] / 2 + beyond;
            if between == 1 {
                weight *= 0.5;
            }
        }
        Some((at, weight))
    })
}
