//! Structurally symmetric systems: a multifrontal elimination on the nested dissection, by LU or
//! by Cholesky.
//!
//! I. S. Duff & J. K. Reid (1983, 1984); J. W. H. Liu (1992). The tree of the dissection gives a plan
//! of dense eliminations ([`plan`]) that holds for all values and for all couplings within reach. With
//! associated flow the tangent is symmetric and, before collapse, positive definite: its fronts
//! are factorised by Cholesky. With non-associated flow it has a symmetric pattern and unsymmetric
//! values: the pivots of each front are then taken from its own diagonal block only, so that the
//! plan holds. Where that leaves no usable pivot, one is made up, and iterative refinement removes
//! the error.
//!
//! | module | what it does |
//! |---|---|
//! | [`neighbours`], [`supernodes`], [`plan`], [`tasks`] | analysis: fronts, their order, their memory, the shares of threads |
//! | [`scaling`], [`kernel`], [`lu`], [`cholesky`], [`extend_add`], [`factors`] | factorisation |
//! | [`dense_lu`], [`tiles`], [`panels`], [`layout`], [`scalar`], [`scratch`] | dense kernels, numbers, memory |
//! | [`substitution`] | solution |
//! | [`single`] | factors in single precision as a preconditioner |
//! | [`engine`], [`solvers`] | the whole, and the solvers to choose from |

mod cholesky;
mod dense;
mod engine;
mod extend_add;
mod factors;
pub(crate) mod kernel;
mod lu;
mod scaling;
pub(crate) mod scratch;
mod single;
mod solvers;
mod substitution;
mod tree;

pub(super) use engine::Engine;
pub use solvers::{MultifrontalCholesky, MultifrontalLu};
