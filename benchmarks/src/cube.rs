//! The plan of elimination of a body in space: the pattern that a cube of particles would have, and
//! what a factorisation of it would take. Only counted, never factorised.

use std::sync::Arc;

use igimp_linear::{LinearSolver, LinearSolverError, MultifrontalLu, NodeBlock, Pattern};

/// Distance along an axis up to which two nodes share a particle.
const REACH: usize = 2;

/// What an LU factorisation of a cube takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// Number of unknowns, three for each node.
    pub unknowns: usize,
    /// Number of entries of the matrix.
    pub stored: usize,
    /// Number of entries of both factors.
    pub factor_entries: usize,
    /// Number of floating-point operations.
    pub operations: f64,
}

/// The plan for a cube with so many nodes along a side, all of them free.
///
/// # Errors
/// [`LinearSolverError::Empty`] for a cube without nodes.
pub fn plan(side: usize) -> Result<Plan, LinearSolverError> {
    let pattern = Arc::new(pattern(side));
    let mut solver = MultifrontalLu::default();
    solver.analyse(&pattern)?;
    Ok(Plan {
        unknowns: pattern.unknowns(),
        stored: pattern.stored(),
        factor_entries: solver.factor_entries(),
        operations: solver.factor_operations(),
    })
}

fn pattern(side: usize) -> Pattern {
    let (mut blocks, mut starts, mut coupled) = (Vec::new(), vec![0], Vec::new());
    let near = |at: usize| at.saturating_sub(REACH)..side.min(at + REACH + 1);
    for node in 0..side.pow(3) {
        let place = [node % side, node / side % side, node / side / side];
        for z in near(place[2]) {
            for y in near(place[1]) {
                let row = side * (y + side * z);
                coupled.extend(near(place[0]).map(|x| (row + x) as u32));
            }
        }
        starts.push(coupled.len());
        blocks.push(NodeBlock {
            first: 3 * node,
            len: 3,
            free: 0b111,
            place,
        });
    }
    Pattern::new(blocks, starts, coupled, REACH)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_cube_is_a_dense_matrix() {
        // Every node couples with every other, so LU takes 2/3 n^3 operations and n^2 entries.
        let plan = plan(3).unwrap();
        let unknowns = 81.0_f64;
        assert_eq!((plan.unknowns, plan.stored), (81, 81 * 81));
        assert!(
            (plan.operations / (unknowns.powi(3) * 2.0 / 3.0) - 1.0).abs() < 0.05,
            "{plan:?}"
        );
        assert!(
            (plan.factor_entries as f64 / unknowns.powi(2) - 1.0).abs() < 0.05,
            "{plan:?}"
        );
    }

    #[test]
    fn inner_nodes_couple_with_a_hundred_and_twenty_five() {
        let pattern = pattern(5);
        let inner = 2 + 5 * (2 + 5 * 2);
        assert_eq!(pattern.coupled_to(inner).len(), 125);
    }
}
