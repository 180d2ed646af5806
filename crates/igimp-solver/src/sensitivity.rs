//! The load factor at the last step of a path: how it changes with the conditions of the step, and what the step
//! dissipates as plastic flow (theory, eqs. 33g to 33i).

use std::sync::Arc;

use igimp_assembly::{
    AssemblyError, Method, OutOfBalance, Stencils, StepConditions, System, Trial,
};
use igimp_linear::{Bordered, LinearSolver, LinearSolverError, Pattern, TangentMatrix};
use igimp_material::TangentKind;

use crate::body::Body;
use crate::free_factor::product;
use crate::report::StepFailure;
use crate::workspace::Workspace;

/// Shares of the elastic tangent at which a singular tangent is tried again \[-\].
const REGULARISED: [f64; 5] = [1e-4, 1e-3, 1e-2, 0.1, 1.0];

/// Relative residual of their systems where they are iterated for \[-\].
const OF_ANSWERS: f64 = 1e-6;

/// Most factors that a kinematic one is looked for among, the change at which it is found, and the least share of the work
/// in plastic flow, and of the factor at the beginning, with which the search goes on \[-\].
const MOST_FACTORS: usize = 60;
const SAME_FACTOR: f64 = 1e-8;
const FEWEST: f64 = 0.05;

/// A strength reduction factor by the kinematic theorem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KinematicFactor {
    /// The factor \[-\].
    pub factor: f64,
    /// Work of the mean stress on the volume by which the field misses that of plastic flow, over the work of the step
    /// \[-\].
    pub missed: f64,
}

/// An accepted step, its body as it was before.
#[derive(Debug)]
pub struct Increment<'a, const D: usize> {
    /// The body at the start of the step.
    pub body: &'a Body<D>,
    /// How the step was computed.
    pub method: &'a Method,
    /// The conditions of the step.
    pub conditions: &'a StepConditions<D>,
    /// Nodal step displacements \[length\].
    pub u: &'a [[f64; D]],
}

impl<const D: usize> Increment<'_, D> {
    /// The ratio of changes of the load factor to those of conditions that keep equilibrium at the same gross work of the
    /// external force: of each of the conditions `beside` those of the step over that of the conditions at a load factor
    /// beside, `by_factor` (theory, eq. 33g). Where both differ by the same small share of their value,
    /// $`\partial\ln\lambda/\partial\ln p`$.
    ///
    /// # Errors
    /// [`StepFailure`] of the equations or of the linear solver.
    pub fn sensitivity(
        &self,
        by_factor: &StepConditions<D>,
        beside: &[StepConditions<D>],
        workspace: &mut Workspace<D>,
    ) -> Result<Vec<f64>, StepFailure> {
        let stencils = self.stencils()?;
        let mut system = self.system(&stencils, workspace.pattern())?;
        let force = system.force_along(self.u);
        let here = system.out_of_balance(&system.evaluate(self.u, TangentKind::Consistent)?)?;
        let mut changes = Vec::with_capacity(1 + beside.len());
        let mut trial = Trial::default();
        for conditions in std::iter::once(by_factor).chain(beside) {
            system.exchange(conditions.clone(), &self.body.load_points)?;
            system.evaluate_into(self.u, TangentKind::Consistent, &mut trial)?;
            changes.push(difference(&system.out_of_balance(&trial)?, &here));
        }
        system.exchange(self.conditions.clone(), &self.body.load_points)?;
        let (by_factor, changes) = (&changes[0], &changes[1..]);
        // Of the size of forces, and of forces over lengths, as the entries of the tangent.
        let size = product(&force, &force).sqrt();
        let of_column = size / product(by_factor, by_factor).sqrt();
        let of_row = size / product(&force, &system.by_unknown(self.u));
        let column: Vec<f64> = by_factor.iter().map(|x| -of_column * x).collect();
        let row: Vec<f64> = force.iter().map(|x| of_row * x).collect();
        let answers = self.answers(&system, (&column, &row), changes, workspace)?;
        Ok(answers.into_iter().map(|x| x * of_column).collect())
    }

    /// The strength reduction factor at which plastic flow by the normality rule dissipates the work that the step has for
    /// it, `work` \[force·length\]; none where no such flow has a factor (theory, eq. 33i). The search begins at `from`,
    /// and `at` states the conditions at a factor.
    ///
    /// # Errors
    /// [`StepFailure`] of the equations.
    pub fn kinematic_factor(
        &self,
        work: f64,
        from: f64,
        at: &dyn Fn(f64) -> Result<StepConditions<D>, AssemblyError>,
    ) -> Result<Option<KinematicFactor>, StepFailure> {
        let stencils = self.stencils()?;
        let mut system = self.system(&stencils, None)?;
        let trial = system.evaluate(self.u, TangentKind::Consistent)?;
        let mut factor = from;
        for _ in 0..MOST_FACTORS {
            system.exchange(at(factor)?, &self.body.load_points)?;
            let flow = system.plastic_flow(&trial, self.u)?;
            let ratio = flow.work / work;
            if !(FEWEST..1.0 / FEWEST).contains(&ratio) {
                return Ok(None);
            }
            factor *= ratio;
            // Soil that misses its volume at every factor is followed to none.
            if !(FEWEST..1.0 / FEWEST).contains(&(factor / from)) {
                return Ok(None);
            }
            if (ratio - 1.0).abs() <= SAME_FACTOR {
                let missed = flow.missed / work;
                return Ok(Some(KinematicFactor { factor, missed }));
            }
        }
        Ok(None)
    }

    /// The supports of the particles at the nodes.
    fn stencils(&self) -> Result<Stencils<D>, StepFailure> {
        let Body {
            particles,
            load_points,
            ..
        } = self.body;
        let stencils = Stencils::build_under(particles, self.method, self.conditions, load_points);
        Ok(stencils?)
    }

    /// The equations of the step.
    fn system<'s>(
        &'s self,
        stencils: &'s Stencils<D>,
        pattern: Option<&Arc<Pattern>>,
    ) -> Result<System<'s, D>, StepFailure> {
        let structures = self.body.structures();
        let system = System::with_structures(
            &self.body.particles,
            &structures,
            stencils,
            self.conditions,
            self.method,
        )?;
        Ok(system.sharing(pattern))
    }

    /// By how much the load factor answers each change of the out-of-balance force, at no work of the external force: with the
    /// column and the row that it has beside the tangent of the step; where that is singular with a
    /// share of the elastic tangent.
    fn answers(
        &self,
        system: &System<'_, D>,
        (column, row): (&[f64], &[f64]),
        changes: &[Vec<f64>],
        workspace: &mut Workspace<D>,
    ) -> Result<Vec<f64>, StepFailure> {
        let Workspace {
            solver,
            matrix,
            trial,
            ..
        } = workspace;
        let earlier = matrix.take();
        let matrix = matrix.insert(system.matrix_from(earlier));
        solver.start_step();
        let mut kind = TangentKind::Consistent;
        let mut shares = REGULARISED.into_iter();
        loop {
            system.linearise_into(self.u, kind, trial, matrix)?;
            matrix.border.append(column, row, 0.0);
            let error = match last_of_each(matrix, changes, &mut **solver) {
                Ok(answers) => return Ok(answers),
                Err(error) => error,
            };
            match shares.next() {
                Some(elastic) if error.is_singular() => {
                    kind = TangentKind::Regularised { elastic };
                }
                _ => return Err(error.into()),
            }
        }
    }
}

/// The last unknown of the solution for each right-hand side, whose own last entry is zero.
fn last_of_each(
    matrix: &TangentMatrix,
    sides: &[Vec<f64>],
    solver: &mut dyn LinearSolver,
) -> Result<Vec<f64>, LinearSolverError> {
    solver.factor(matrix)?;
    let mut bordered = Bordered::default();
    let last_of = |side: &Vec<f64>| {
        let mut rhs = side.clone();
        rhs.push(0.0);
        let mut solution = vec![0.0; rhs.len()];
        solver.ask_for(OF_ANSWERS);
        bordered.solve(solver, matrix, &rhs, &mut solution)?;
        Ok(solution[side.len()])
    };
    sides.iter().map(last_of).collect()
}

/// The change of the out-of-balance force, by unknown \[force\].
fn difference(then: &OutOfBalance, now: &OutOfBalance) -> Vec<f64> {
    let both = then.force.iter().zip(&now.force);
    both.map(|(then, now)| then - now).collect()
}
