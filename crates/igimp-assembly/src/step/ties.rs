//! Nodes that move with others, and supports on those (theory, eqs. 27 and 63a).

use std::collections::BTreeMap;

use igimp_shape::Support;

/// A node that a small cut moves with, and by how much.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carrier {
    /// The node.
    pub node: usize,
    /// The weight of its displacement; the weights of a tie sum to one \[-\].
    pub weight: f64,
}

/// Tied nodes with the nodes that they move with.
pub(crate) type Ties = BTreeMap<usize, Vec<Carrier>>;

/// Supports on the nodes that tied ones move with, in their order; equal nodes are not added up.
pub(crate) fn carried<const D: usize>(supports: &[Support<D>], ties: &Ties) -> Vec<Support<D>> {
    let mut tied = Vec::with_capacity(supports.len());
    for support in supports {
        let Some(carriers) = ties.get(&support.node) else {
            tied.push(*support);
            continue;
        };
        for &Carrier { node, weight } in carriers {
            tied.push(Support {
                node,
                value: weight * support.value,
                grad: support.grad.map(|slope| weight * slope),
                grad_bar: support.grad_bar.map(|slope| weight * slope),
            });
        }
    }
    tied
}
