//! The load factor of a step as an unknown: the gross work of the external force on the step is prescribed in its place
//! (theory, eqs. 33a and 33b).

use igimp_assembly::{AssemblyError, LoadPoint, OutOfBalance, System, Trial};
use igimp_linear::TangentMatrix;
use igimp_material::TangentKind;

use crate::settings::LoadPath;

/// Relative change of the load factor in a difference quotient \[-\].
const DIFFERENCE: f64 = 1e-6;

/// Largest change of the load factor in one correction, as a share of it \[-\].
const LARGEST_CHANGE: f64 = 0.2;

/// Work that a converged step may miss, as a share of the work asked for \[-\].
const WORK_MISSED: f64 = 1e-6;

/// The doubt that a converged residual may leave in the load factor, as a share of it, in general and where corrections are
/// guarded in space: the last digits are the dear ones there \[-\].
const FACTOR_IN_DOUBT: f64 = 2e-5;
const FACTOR_IN_DOUBT_IN_SPACE: f64 = 1e-4;

/// A step that begins with a guess.
#[derive(Clone, Debug)]
pub(crate) struct Guess<const D: usize> {
    /// Nodal step displacements \[length\].
    pub(crate) u: Vec<[f64; D]>,
    /// Load factor at its end \[-\].
    pub(crate) factor: f64,
    /// Whether the body moved as a mechanism in the step before.
    pub(crate) is_mechanism: bool,
}

/// The load factor of a step, unknown.
pub(crate) struct FreeFactor<'p, const D: usize> {
    load_path: &'p dyn LoadPath<D>,
    points: &'p [LoadPoint<D>],
    /// Load factor at the start of the step \[-\].
    from: f64,
    /// Load factor at the trial \[-\].
    pub(crate) at: f64,
    /// Whether the body moved as a mechanism in the step before: its tangent without a border may then be singular.
    pub(crate) is_mechanism: bool,
    /// The doubt that the residual may leave in the load factor, as a share of it \[-\].
    in_doubt: f64,
    /// Gross work of the external force on the step that is asked for \[force·length\].
    work: f64,
    /// External force at the start of the step along the guess, by unknown \[force\].
    force: Vec<f64>,
    /// Derivative of the out-of-balance force by the load factor, by unknown \[force\].
    slope: Vec<f64>,
    /// For the difference quotient.
    beside: Trial<D>,
}

impl<'p, const D: usize> FreeFactor<'p, D> {
    /// That of a step from a load factor, which is to do so much gross `work` along the displacements of a guess.
    pub(crate) fn new(
        load_path: &'p dyn LoadPath<D>,
        points: &'p [LoadPoint<D>],
        system: &System<'_, D>,
        (from, work): (f64, f64),
        guess: &Guess<D>,
    ) -> Self {
        Self {
            load_path,
            points,
            from,
            at: guess.factor,
            is_mechanism: guess.is_mechanism,
            in_doubt: if D == 3 && system.flows_without_potential() {
                FACTOR_IN_DOUBT_IN_SPACE
            } else {
                FACTOR_IN_DOUBT
            },
            work,
            force: system.force_along(&guess.u),
            slope: Vec::new(),
            beside: Trial::default(),
        }
    }

    /// Puts the system at the load factor.
    pub(crate) fn put(&self, system: &mut System<'_, D>) -> Result<(), AssemblyError> {
        let conditions = self.load_path.conditions(self.from, self.at)?;
        system.exchange(conditions, self.points)
    }

    /// Appends row and column of the load factor to the tangent at nodal step displacements `u` \[length\], whose
    /// out-of-balance force is `residual`.
    pub(crate) fn border(
        &mut self,
        system: &mut System<'_, D>,
        u: &[[f64; D]],
        residual: &OutOfBalance,
        matrix: &mut TangentMatrix,
    ) -> Result<(), AssemblyError> {
        let by = DIFFERENCE * self.at.abs();
        let beside = self.load_path.conditions(self.from, self.at + by)?;
        system.exchange(beside, self.points)?;
        system.evaluate_into(u, TangentKind::Consistent, &mut self.beside)?;
        let changed = system.out_of_balance(&self.beside)?;
        self.put(system)?;
        self.slope.clear();
        let both = changed.force.iter().zip(&residual.force);
        self.slope.extend(both.map(|(then, now)| (then - now) / by));
        let column: Vec<f64> = self.slope.iter().map(|slope| -slope).collect();
        let scale = self.scale();
        let row: Vec<f64> = self.force.iter().map(|force| scale * force).collect();
        matrix.border.append(&column, &row, 0.0);
        Ok(())
    }

    /// The factor of the equation of the work, so that it weighs as much as a force \[1/length\].
    fn scale(&self) -> f64 {
        product(&self.force, &self.force).sqrt() / self.work
    }

    /// The work that is missing at displacements by unknown \[force\].
    pub(crate) fn missing(&self, u: &[f64]) -> f64 {
        self.scale() * (self.work - product(&self.force, u))
    }

    /// The share of a correction that keeps the change of the load factor within bounds \[-\].
    pub(crate) fn admitted(&self, correction: f64) -> f64 {
        let most = LARGEST_CHANGE * self.at.abs();
        if correction.abs() > most {
            most / correction.abs()
        } else {
            1.0
        }
    }

    /// Whether the work is done at displacements by unknown, and the residual leaves no doubt in the load factor
    /// (theory, eq. 33d).
    pub(crate) fn is_found(&self, u: &[f64], residual: &OutOfBalance) -> bool {
        let missed = (self.work - product(&self.force, u)).abs();
        let doubt = self.doubt(u, residual);
        missed <= WORK_MISSED * self.work && (residual.is_round_off || doubt <= self.in_doubt)
    }

    /// The share that a residual has to fall to at displacements by unknown, so that it leaves no doubt in the load factor \[-\].
    pub(crate) fn share_wanted(&self, u: &[f64], residual: &OutOfBalance) -> f64 {
        self.in_doubt / self.doubt(u, residual)
    }

    /// By how much the residual puts the load factor in doubt, as a share of it: its work on the step over that of
    /// the force that the load factor changes \[-\].
    pub(crate) fn doubt(&self, u: &[f64], residual: &OutOfBalance) -> f64 {
        let work: f64 = residual
            .force
            .iter()
            .zip(u)
            .map(|(r, u)| (r * u).abs())
            .sum();
        work / (product(&self.slope, u) * self.at).abs()
    }
}

/// The scalar product of two vectors by unknown.
pub(crate) fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
