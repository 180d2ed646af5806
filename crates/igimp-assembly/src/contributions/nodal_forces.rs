//! Forces at nodes beside those of particles: the one seam for ghost penalty, drag, contact
//! and reinforcement.

pub(crate) use igimp_rigid::AddBlock;

/// Force and stiffness at nodes beside those of particles.
pub(crate) trait NodalForces<const D: usize>: std::fmt::Debug + Send + Sync {
    /// Pairs of nodes of the grid that it couples, both ways.
    fn pairs(&self) -> Vec<(usize, usize)>;

    /// Whether its tangent is symmetric.
    fn is_symmetric(&self) -> bool;

    /// Adds the internal force at nodal step displacements `u` \[length\] to `f` \[force\], and hands its
    /// derivative on in blocks of nodes: row, column, ∂f/∂u \[force/length\].
    fn add(&self, u: &[[f64; D]], f: &mut [[f64; D]], blocks: Option<&mut AddBlock<'_, D>>);
}
