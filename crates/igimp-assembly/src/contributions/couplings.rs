//! Forces that are proportional to step displacements and act on each component alike: ghost penalty
//! (theory, eq. 28) and drag.

use crate::contributions::nodal_forces::{AddBlock, NodalForces};

/// A coupling of two nodes, or of a node to its place, that acts on each displacement component
/// alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coupling {
    pub(crate) row: usize,
    pub(crate) column: usize,
    /// Stiffness \[force/length\].
    pub(crate) stiffness: f64,
}

/// Couplings of nodes.
#[derive(Clone, Debug)]
pub(crate) struct Couplings(pub(crate) Vec<Coupling>);

impl<const D: usize> NodalForces<D> for Couplings {
    fn pairs(&self) -> Vec<(usize, usize)> {
        let pairs = self.0.iter();
        pairs.map(|entry| (entry.column, entry.row)).collect()
    }

    fn is_symmetric(&self) -> bool {
        true
    }

    fn add(&self, u: &[[f64; D]], f: &mut [[f64; D]], blocks: Option<&mut AddBlock<'_, D>>) {
        for entry in &self.0 {
            for axis in 0..D {
                f[entry.row][axis] += entry.stiffness * u[entry.column][axis];
            }
        }
        let Some(blocks) = blocks else {
            return;
        };
        for entry in &self.0 {
            let mut block = [[0.0; D]; D];
            for (axis, row) in block.iter_mut().enumerate() {
                row[axis] = entry.stiffness;
            }
            blocks(entry.row, entry.column, &block);
        }
    }
}
