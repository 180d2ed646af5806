//! GOAL: the geometric nested dissection is an order of elimination, for bodies of any shape, that
//! fills the factors less than the minimum degree order of `faer`.

use crate::support::Body;
use faer::Side;
use faer::perm::PermRef;
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymmetricOrdering, factorize_symbolic_cholesky,
};
use igimp_linear::NestedDissection;
use igimp_linear::{NodeBlock, Pattern};
use proptest::prelude::*;

/// Fails unless every unknown appears once, those of a node together and in their order.
fn assert_is_an_order(pattern: &Pattern) {
    let order = NestedDissection::new(pattern);
    let mut nodes = order.nodes.clone();
    nodes.sort_unstable();
    assert!(nodes.iter().copied().eq(0..pattern.blocks.len()));
    assert!(order.parts.is_sorted_by(|a, b| a < b) && order.parts[0] == 0);
    assert_eq!(order.parts.last(), Some(&nodes.len()));
    let unknowns = order.unknowns(pattern);
    let mut start = 0;
    for &node in &order.nodes {
        let block = pattern.blocks[node];
        let together = &unknowns[start..start + block.len];
        assert!(
            together
                .iter()
                .copied()
                .eq(block.first..block.first + block.len)
        );
        start += block.len;
    }
    assert_eq!(start, unknowns.len());
}

#[test]
fn bodies_are_ordered() {
    let bodies = [
        Body::line(1),
        Body::line(40),
        Body::plane(2, 2),
        Body::plane(50, 3),
        Body::plane(25, 31).slope(),
        Body::solid([7, 4, 6]),
    ];
    for body in bodies {
        assert_is_an_order(&body.tangent().pattern);
    }
    let empty = Pattern::new(vec![], vec![0], vec![], 2);
    assert!(NestedDissection::new(&empty).nodes.is_empty());
}

proptest! {
    /// Nodes scattered at random, several on one place, far apart, with any reach.
    #[test]
    fn scattered_nodes_are_ordered(
        places in proptest::collection::vec((0_usize..12, 0_usize..5, 0_usize..3, 1_usize..4), 0..200),
        stretch in 1_usize..1000,
        reach in 0_usize..4,
    ) {
        let mut first = 0;
        let blocks = places.into_iter().map(|(x, y, z, len)| {
            first += len;
            NodeBlock { first: first - len, len, free: (1 << len) - 1, place: [x * stretch, y, z] }
        });
        let blocks: Vec<NodeBlock> = blocks.collect();
        let alone = (0..=blocks.len()).collect();
        let coupled = (0..blocks.len() as u32).collect();
        let pattern = Pattern::new(blocks, alone, coupled, reach);
        assert_is_an_order(&pattern);
    }
}

/// Entries of L, and the operations to compute it, in the given order or that of minimum degree.
fn fill(pattern: &Pattern, order: Option<&[usize]>) -> (usize, f64) {
    let n = pattern.unknowns();
    let columns = pattern.compressed_columns();
    let view = SymbolicSparseColMatRef::new_checked(n, n, &columns.col_ptr, None, &columns.row_idx);
    let mut position = vec![0; n];
    for (new, &old) in order.unwrap_or_default().iter().enumerate() {
        position[old] = new;
    }
    let ordering = match order {
        Some(order) => SymmetricOrdering::Custom(PermRef::new_checked(order, &position, n)),
        None => SymmetricOrdering::Amd,
    };
    let params = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
        ..CholeskySymbolicParams::default()
    };
    let symbolic = factorize_symbolic_cholesky(view, Side::Lower, ordering, params).unwrap();
    let faer::sparse::linalg::cholesky::SymbolicCholeskyRaw::Simplicial(factor) = symbolic.raw()
    else {
        panic!("asked for the simplicial factor");
    };
    let operations = factor
        .col_ptr()
        .windows(2)
        .map(|ends| ((ends[1] - ends[0]) as f64).powi(2));
    (symbolic.len_val(), operations.sum())
}

#[test]
fn dissection_fills_less_than_minimum_degree() {
    let bodies = [
        ("square", Body::plane(90, 90)),
        ("two to one", Body::plane(120, 60)),
        ("slope", Body::plane(110, 110).slope()),
        ("cube", Body::solid([12, 12, 12])),
    ];
    for (name, body) in bodies {
        let matrix = Body {
            particles: 1,
            ..body
        }
        .tangent();
        let order = NestedDissection::new(&matrix.pattern).unknowns(&matrix.pattern);
        let (entries, operations) = fill(&matrix.pattern, Some(&order));
        let (amd_entries, amd_operations) = fill(&matrix.pattern, None);
        assert!(
            entries < amd_entries,
            "{name}: {entries} against {amd_entries}"
        );
        assert!(
            operations < amd_operations,
            "{name}: {operations:e} against {amd_operations:e}"
        );
    }
}
