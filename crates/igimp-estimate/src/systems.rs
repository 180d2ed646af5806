//! How the linear systems of a case will be solved, and what that takes.
//!
//! In the plane the factors follow the law of nested dissection, $`n \log_2 n`$ entries and $`n^{3/2}`$ operations for $`n`$
//! unknowns. In space shape decides as much as size: there the elimination is planned as the run itself plans it, on the nodes that
//! the soil will couple, and the run's own solver is asked what it would do.

use std::sync::Arc;

use igimp_linear::{AutoSolver, Forecast, Pattern, Reason, SolverKind};
use igimp_model::Case;

use super::factor_memory::{FactorMemory, decides};
use crate::error::EstimateError;

/// Factors in the plane, for each unknown and each doubling of the unknowns \[bytes\].
const PER_FILL: f64 = 1.5e2;
/// Factors in single precision with the vectors of the iteration, over those in double \[-\].
const IN_SINGLE: f64 = 0.55;
/// Memory of an iteration with multigrid in place of factors \[bytes per unknown\].
const PER_ITERATED: f64 = 4e3;
/// Factorisation of a symmetric matrix in the plane \[s\], times $`n^{3/2}`$.
const FACTOR: f64 = 1.8e-8;
/// Factor on that of an unsymmetric system, and on the cost of an iteration \[-\].
const UNSYMMETRIC: f64 = 1.5;
/// Solution in the plane \[s per unknown\].
const SOLVE: f64 = 3e-7;
/// An operation of a factorisation in space \[s\].
const PER_OPERATION: f64 = 2.5e-11;
/// A solution in space with factors \[s per byte of these\].
const PER_BYTE: f64 = 2e-10;
/// Memory of factors on several ranks (`igimp-mpi`) over that on one computer \[-\].
const OF_RANKS: f64 = 1.3;
/// Solution by iteration with multigrid, set-up included \[s per unknown\].
const ITERATED: f64 = 6e-5;

/// How the linear systems of a case will be solved, and what that takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Systems {
    /// The method, and why it will be taken.
    pub method: String,
    /// Memory allowed for factors, where it decides on the method.
    pub allowed: Option<FactorMemory>,
    /// Memory of the solver \[bytes\].
    pub bytes: f64,
    /// Additional memory where an iteration is abandoned for a factorisation \[bytes\]; zero where none is, or could be.
    pub fallback_bytes: f64,
    /// Where factors have no room on this computer: their memory on several \[bytes\], and how many computers have it.
    pub on_several: Option<(f64, usize)>,
    /// A factorisation and a solution on one thread of the reference computer \[s\].
    pub seconds: f64,
}

impl Systems {
    /// Those of a case with so many unknowns in the plane.
    pub(super) fn in_plane<const D: usize>(case: &Case<D>, unknowns: usize) -> Self {
        let symmetric = is_symmetric(case);
        let n = unknowns as f64;
        let iterated = case.solver.linear == SolverKind::Multigrid;
        let share = if case.solver.linear == SolverKind::Single {
            IN_SINGLE
        } else {
            1.0
        };
        let more = if symmetric { 1.0 } else { UNSYMMETRIC };
        Self {
            method: method(case.solver.linear, symmetric, iterated),
            allowed: None,
            bytes: share * PER_FILL * n * n.max(2.0).log2(),
            fallback_bytes: 0.0,
            on_several: None,
            seconds: if iterated {
                ITERATED * n * more
            } else {
                FACTOR * n.powf(1.5) * more + SOLVE * n
            },
        }
    }

    /// Those of a case in space whose nodes will be coupled like this.
    ///
    /// # Errors
    /// [`EstimateError`] where no elimination can be planned, or the environment allows no amount of memory.
    pub(super) fn in_space<const D: usize>(
        case: &Case<D>,
        pattern: &Arc<Pattern>,
    ) -> Result<Self, EstimateError> {
        let symmetric = is_symmetric(case);
        let kind = case.solver.linear;
        let mut solver = match kind {
            SolverKind::Multigrid => AutoSolver::by_iteration(),
            SolverKind::Single => AutoSolver::in_single(),
            _ => AutoSolver::default(),
        };
        let allowed = FactorMemory::of(case)?;
        solver = solver.with_factor_bytes(allowed.bytes);
        let Forecast {
            iterates,
            reason,
            factor_bytes,
            fallback_bytes,
            operations,
        } = solver.forecast(pattern, symmetric)?;
        let iterated = iterates && matches!(kind, SolverKind::Auto | SolverKind::Multigrid);
        let n = pattern.unknowns() as f64;
        let factors = factor_bytes as f64;
        let on_ranks = OF_RANKS * factors;
        let computers = (on_ranks / allowed.bytes.max(1) as f64).ceil() as usize;
        let mut words = method(kind, symmetric, iterated);
        if kind == SolverKind::Auto && reason != Reason::Asked {
            words = format!("{words}: {}", allowed.explain(&reason));
        }
        Ok(Self {
            method: words,
            allowed: matches!(kind, SolverKind::Auto | SolverKind::Multigrid).then_some(allowed),
            bytes: if iterated {
                PER_ITERATED * n
            } else if kind == SolverKind::Single {
                IN_SINGLE * factors
            } else {
                factors
            },
            fallback_bytes: if iterated { fallback_bytes as f64 } else { 0.0 },
            on_several: decides(&reason).then_some((on_ranks, computers)),
            seconds: if iterated {
                ITERATED * n * if symmetric { 1.0 } else { UNSYMMETRIC }
            } else {
                PER_OPERATION * operations + PER_BYTE * factors
            },
        })
    }
}

/// Whether all tangents of a case are symmetric.
fn is_symmetric<const D: usize>(case: &Case<D>) -> bool {
    let cell = case.grid.smallest_cell()[D - 1];
    (case.materials.iter()).all(|material| {
        // One that varies is below the greatest, and below friction, somewhere.
        let varies = material.profiles.of_parameter("dilation").is_some();
        let is_symmetric = (material.law_on(cell)).is_ok_and(|law| law.has_symmetric_tangent());
        is_symmetric && !varies
    })
}

/// A method by its name.
fn method(kind: SolverKind, symmetric: bool, iterated: bool) -> String {
    let [direct, iteration] = if symmetric {
        ["Cholesky", "conjugate gradients with multigrid"]
    } else {
        ["LU", "GMRES with multigrid"]
    };
    match kind {
        SolverKind::Auto => (if iterated { iteration } else { direct }).to_owned(),
        SolverKind::Multigrid if iterated => format!("{iteration}, as asked for"),
        SolverKind::Multigrid => direct.to_owned(),
        SolverKind::Single => {
            format!("{direct} in single precision and an iteration with it, as asked for")
        }
        other => format!("{}, as asked for", other.build().name()),
    }
}
