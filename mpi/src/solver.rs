//! The linear solver that a run on rank 0 has: it looks at matrix and solution as the others do, and leaves the rest to the ranks.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use igimp_linear::{
    Accuracy, AutoSolver, Inspection, LinearEffort, LinearSolver, LinearSolverError, Pattern,
    Reason, Refinement, SolveReport, SolverKind, TangentMatrix,
};
use igimp_model::OfCase;

use crate::layout::Layout;
use crate::method::Method;
use crate::server::{Command, Part, Reply, Request};

/// Residual to which solutions with factors are refined at least \[-\], as the solvers of igimp do.
const REFINED: f64 = 1e-9;
/// Residual of a correction by iteration \[-\].
const OF_CORRECTIONS: f64 = 1e-3;
/// Most iterations of one solution.
const MOST: u64 = 800;
/// Workspace of MUMPS beyond its estimate \[%\], and where that did not do.
const WORKSPACES: [u64; 3] = [30, 100, 400];
/// Memory of MUMPS on all ranks that is counted, over that of igimp's own factors \[-\]: four ranks took 0.8, and more take more.
const OVER_OWN: f64 = 1.3;
/// `PC_FACTOR_OUTMEMORY`.
const OUT_OF_MEMORY: i32 = 3;
/// Codes of MUMPS (its users' guide, section 8): a singular matrix, and workspace that is too small.
const IS_SINGULAR: i32 = -10;
const TOO_SMALL: [i32; 5] = [-8, -9, -14, -15, -17];

/// The way to the ranks, shared by all solvers of a run: one command at a time.
#[derive(Debug)]
pub(crate) struct Ranks {
    pub(crate) count: usize,
    /// Computers that they are on.
    pub(crate) machines: usize,
    /// Whether the user chose a preconditioner by PETSc's options.
    pub(crate) by_options: bool,
    way: Mutex<(SyncSender<Request>, Receiver<Reply>)>,
    systems: AtomicU64,
}

impl Ranks {
    pub(crate) fn new(
        count: usize,
        machines: usize,
        by_options: bool,
        way: (SyncSender<Request>, Receiver<Reply>),
    ) -> Self {
        Self {
            count,
            machines,
            by_options,
            way: Mutex::new(way),
            systems: AtomicU64::new(0),
        }
    }

    /// A command with the part of each rank, made as it is sent.
    fn ask(&self, command: Command, part: impl Fn(usize) -> Option<Part>) -> Reply {
        // A command that a panic cut short has ended all ranks.
        let way: MutexGuard<'_, _> = self.way.lock().unwrap_or_else(PoisonError::into_inner);
        let (requests, replies) = &*way;
        let parts = (1..self.count).chain([0]).map_while(part);
        let all = [Request::Command(command)].into_iter();
        for request in all.chain(parts.map(Request::Part)) {
            if requests.send(request).is_err() {
                return gone();
            }
        }
        replies.recv().unwrap_or_else(|_| gone())
    }
}

/// The ranks are there as long as the run is: where they are not, the program is about to end.
fn gone() -> Reply {
    Reply {
        failure: i32::MAX,
        ..Reply::default()
    }
}

/// A linear solver on all ranks.
pub(crate) struct PetscSolver {
    ranks: Arc<Ranks>,
    system: u64,
    kind: SolverKind,
    lines: Vec<Vec<f64>>,
    allowed: usize,
    layout: Option<Layout>,
    /// Memory of igimp's own factors of the pattern \[bytes\], where it was asked for.
    own_factors: Option<usize>,
    inspection: Inspection,
    refinement: Refinement,
    asked: f64,
    analyses: usize,
    /// The method with its factors or grids.
    ready: Option<Method>,
    /// Methods that failed in this step.
    failed: Vec<Method>,
    effort: LinearEffort,
}

impl PetscSolver {
    pub(crate) fn new(ranks: &Arc<Ranks>, case: &OfCase<'_>) -> Self {
        Self {
            ranks: Arc::clone(ranks),
            system: ranks.systems.fetch_add(1, Ordering::Relaxed),
            kind: case.settings.linear,
            lines: case.lines.clone(),
            allowed: case.factor_bytes.saturating_mul(ranks.machines),
            layout: None,
            own_factors: None,
            inspection: Inspection::default(),
            refinement: Refinement::default(),
            asked: Accuracy::default().target,
            analyses: 0,
            ready: None,
            failed: Vec::new(),
            effort: LinearEffort::default(),
        }
    }

    /// The methods for a matrix, the one to begin with first, and the reason for it.
    fn methods(
        &mut self,
        matrix: &TangentMatrix,
    ) -> Result<(Vec<Method>, Reason), LinearSolverError> {
        let symmetric = matrix.symmetric;
        if self.ranks.by_options {
            let own = if symmetric {
                Method::OptionsSymmetric
            } else {
                Method::Options
            };
            return Ok((vec![own], Reason::Asked));
        }
        // Pore pressures make it quasi-definite.
        let coupled = matrix.pattern.has_scalars();
        let direct = match (symmetric, coupled) {
            (true, false) => vec![Method::Cholesky, Method::Ldlt],
            (true, true) => vec![Method::Ldlt, Method::Lu],
            (false, _) => vec![Method::Lu],
        };
        if coupled {
            return Ok((direct, Reason::Coupled));
        }
        let iteration = if symmetric {
            Method::GamgSymmetric
        } else {
            Method::Gamg
        };
        if self.kind == SolverKind::Multigrid {
            return Ok(([vec![iteration], direct].concat(), Reason::Asked));
        }
        let in_space = self.layout.as_ref().is_some_and(|layout| layout.dims == 3);
        if !in_space || self.kind != SolverKind::Auto {
            let reason = if in_space {
                Reason::Asked
            } else {
                Reason::Plane
            };
            return Ok((direct, reason));
        }
        let (factors, allowed) = (self.factors(matrix)?, self.allowed);
        if factors > allowed {
            return Ok((vec![iteration], Reason::Memory { factors, allowed }));
        }
        Ok(([direct, vec![iteration]].concat(), Reason::Asked))
    }

    /// Memory that factors are going to take on all ranks \[bytes\].
    fn factors(&mut self, matrix: &TangentMatrix) -> Result<usize, LinearSolverError> {
        let own = if let Some(own) = self.own_factors {
            own
        } else {
            let mut solver = AutoSolver::default();
            let forecast = solver.forecast(&matrix.pattern, matrix.symmetric)?;
            *self.own_factors.insert(forecast.factor_bytes)
        };
        Ok((OVER_OWN * own as f64) as usize)
    }

    /// Makes ready the first method that serves, of those that did not fail in this step.
    fn set_up(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        self.ready = None;
        let (methods, reason) = self.methods(matrix)?;
        if self.failed.is_empty() {
            self.effort.reason = reason;
        }
        let mut error = LinearSolverError::NotFactored;
        for method in methods {
            if self.failed.contains(&method) {
                continue;
            }
            match self.set_up_with(method) {
                Ok(()) => {
                    self.ready = Some(method);
                    return Ok(());
                }
                Err(own) => error = own,
            }
            self.failed.push(method);
        }
        Err(error)
    }

    fn set_up_with(&mut self, method: Method) -> Result<(), LinearSolverError> {
        let mut error = LinearSolverError::NotFactored;
        for workspace in WORKSPACES {
            let system = self.system;
            let command = Command::SetUp {
                system,
                method,
                workspace,
            };
            let reply = self.ranks.ask(command, |_| None);
            if reply.failure == 0 {
                return Ok(());
            }
            error = why(method, &reply);
            if !TOO_SMALL.contains(&reply.mumps) {
                break;
            }
        }
        Err(error)
    }

    /// Solves with the method that is ready.
    fn solve_with(
        &mut self,
        method: Method,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        let Some(layout) = &self.layout else {
            return Err(LinearSolverError::NotFactored);
        };
        let accuracy = accuracy(method, self.asked);
        let (ranks, system) = (&self.ranks, self.system);
        let (mut iterations, mut lost) = (0, None);
        let mut relative = 0.5 * accuracy.target;
        let refined = (self.refinement).solve(matrix, rhs, solution, &accuracy, |vector| {
            let command = Command::Solve {
                system,
                relative,
                most_iterations: MOST,
            };
            let part = |rank| Some(Part::Numbers(layout.part_of(rank, vector)));
            let reply = ranks.ask(command, part);
            iterations += reply.end.iterations;
            // What did not converge is no solution: it is refused below.
            if reply.end.reason <= 0 || reply.parts.len() != ranks.count {
                lost = Some(reply.end.iterations);
                vector.fill(f64::NAN);
                return;
            }
            for (rank, part) in reply.parts.iter().enumerate() {
                layout.put(rank, part, vector);
            }
            relative = OF_CORRECTIONS;
        });
        if let (Some(iterations), Err(_)) = (lost, &refined) {
            return Err(LinearSolverError::NotConverged {
                iterations,
                relative_residual: 1.0,
                tolerance: accuracy.tolerance,
                factor_bytes: None,
            });
        }
        let refined = refined?;
        let refinements = if method.is_direct() {
            refined.refinements
        } else {
            iterations
        };
        self.effort.method = method.name();
        self.effort.solutions += 1;
        if !method.is_direct() {
            self.effort.iterations += iterations;
            self.effort.most_iterations = self.effort.most_iterations.max(iterations);
        }
        Ok(SolveReport {
            method: method.name(),
            relative_residual: refined.relative_residual,
            refinements,
            perturbed_pivots: 0,
            pivot_growth: 1.0,
        })
    }
}

/// Why factors or grids were not made.
fn why(method: Method, reply: &Reply) -> LinearSolverError {
    if reply.mumps == IS_SINGULAR {
        LinearSolverError::Singular { unknown: None }
    } else if reply.mumps < 0 || reply.failure == OUT_OF_MEMORY {
        let part = "factors of MUMPS on a rank";
        LinearSolverError::OutOfMemory { part }
    } else if method.is_definite() {
        LinearSolverError::NotPositiveDefinite { unknown: None }
    } else {
        LinearSolverError::Singular { unknown: None }
    }
}

/// How well a solution has to hold: of factors as of igimp's own, of an iteration what was asked for.
fn accuracy(method: Method, asked: f64) -> Accuracy {
    let usual = Accuracy::default();
    let target = if method.is_direct() {
        asked.min(REFINED).max(usual.target)
    } else {
        asked.max(usual.target)
    };
    Accuracy {
        target,
        tolerance: usual.tolerance.max(target),
        ..usual
    }
}

impl LinearSolver for PetscSolver {
    fn name(&self) -> &'static str {
        "petsc"
    }

    fn analyse(&mut self, pattern: &Arc<Pattern>) -> Result<(), LinearSolverError> {
        if self.layout.as_ref().is_some_and(|own| own.is_of(pattern)) {
            return Ok(());
        }
        (self.ready, self.own_factors, self.layout) = (None, None, None);
        let layout = Layout::new(pattern, self.ranks.count)?;
        let command = Command::Pattern {
            system: self.system,
            unknowns: layout.unknowns(),
            dims: layout.dims,
            rows: layout.rows,
        };
        let part = |rank| Some(Part::Pattern(layout.of_rank(rank, &self.lines)));
        self.ranks.ask(command, part);
        self.layout = Some(layout);
        self.analyses += 1;
        Ok(())
    }

    fn factor(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        self.ready = None;
        self.analyse(&matrix.pattern)?;
        self.inspection.inspect(matrix)?;
        let diagonal = self.inspection.diagonal.iter();
        let held = diagonal.fold(0.0, |most: f64, own| most.max(own.abs()));
        let system = self.system;
        if let Some(layout) = &self.layout {
            let part = |rank| Some(Part::Numbers(layout.values_of(rank, matrix, held)));
            self.ranks.ask(Command::Values { system }, part);
        }
        self.set_up(matrix)
    }

    fn solve(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        loop {
            let Some(method) = self.ready else {
                return Err(LinearSolverError::NotFactored);
            };
            let error = match self.solve_with(method, matrix, rhs, solution) {
                Err(
                    error @ (LinearSolverError::NotConverged { .. }
                    | LinearSolverError::Inaccurate { .. }),
                ) => error,
                other => return other,
            };
            // The next method may serve; where there is none, the first error is the one to tell.
            self.failed.push(method);
            if self.set_up(matrix).is_err() {
                return Err(error);
            }
            if let LinearSolverError::NotConverged { iterations, .. } = error {
                self.effort.reason = Reason::NotConverged { iterations };
                self.effort.lost_iterations += iterations;
            }
        }
    }

    fn analyses(&self) -> usize {
        self.analyses
    }

    fn start_step(&mut self) {
        self.failed.clear();
        self.effort = LinearEffort::default();
    }

    fn ask_for(&mut self, relative_residual: f64) {
        self.asked = relative_residual;
    }

    fn effort(&self) -> LinearEffort {
        self.effort.clone()
    }
}

impl Drop for PetscSolver {
    fn drop(&mut self) {
        if self.layout.is_some() {
            let system = self.system;
            self.ranks.ask(Command::Drop { system }, |_| None);
        }
    }
}
