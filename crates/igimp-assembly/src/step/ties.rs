//! Supports on the nodes that others move with (theory, eqs. 27 and 63a).

use igimp_shape::Support;
use igimp_shape::continuation::{Carrier, Ties};

/// Supports on the nodes that tied ones move with, in their order; equal nodes are not added up.
pub(crate) fn carried<const D: usize>(supports: &[Support<D>], ties: &Ties) -> Vec<Support<D>> {
    let mut own = Vec::with_capacity(supports.len());
    for support in supports {
        let Some(carriers) = ties.get(&support.node) else {
            own.push(*support);
            continue;
        };
        for &Carrier { node, weight } in carriers {
            own.push(Support {
                node,
                value: weight * support.value,
                grad: support.grad.map(|own| weight * own),
                grad_bar: support.grad_bar.map(|own| weight * own),
            });
        }
    }
    own
}
