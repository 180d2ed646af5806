//! Residuals of all tests over the parameters, their derivative by differences, and the search for the least sum of squares.

use igimp_input::InputError;
use igimp_model::Material;
use rmpfit::{MPConfig, MPError, MPFitter, MPPar, MPResult, MPSide, MPSuccess};

use super::parameter::{Parameter, Range};
use super::{FitRequest, Source};
use crate::element::{Data, Measure, Request, TestError, driven};

/// Step of the differences, of parameters of order one: an error of 1e-8 by curvature, and as much by the tolerance of a step.
pub(super) const DIFFERENCE: f64 = 1e-4;

/// Residual of a trial that the law or a test refuses, far above any that is one: the search turns back.
const REFUSED: f64 = 1e8;

/// First step of the search, over the parameters: beyond it a law may be one of another kind.
const FIRST_STEP: f64 = 0.3;

/// Share of the sum of squares that a further correction may still take away.
const LEFT: f64 = 1e-6;

/// Most searches one after the other, each of which holds parameters at the walls that the one before met.
const MOST_SEARCHES: usize = 30;

/// A residual of round-off, over the largest value that was measured.
const ROUND_OFF: f64 = 1e-9;

/// Why a trial gives no residuals.
#[derive(Debug)]
pub(super) enum Lost {
    Input(InputError),
    Test(TestError),
    Early { test: usize, why: String },
}

/// The tests and the parameters.
pub(super) struct Problem<'a> {
    source: &'a dyn Source,
    parameters: &'a [Parameter],
    tests: &'a [Request],
    /// Divisors of the residuals: of each column of each test, in SI.
    scales: Vec<Vec<f64>>,
    values: usize,
    /// Root of the sum of squares of the data, over the scales.
    size: f64,
}

/// Where a search ended, and why it is none; iterations and evaluations.
pub(super) struct Solved {
    pub(super) at: Vec<f64>,
    /// The ranges of the parameters, with the walls that it ended beside.
    pub(super) ranges: Vec<Range>,
    pub(super) why: Option<String>,
    pub(super) effort: [usize; 2],
}

impl<'a> Problem<'a> {
    pub(super) fn new(
        source: &'a dyn Source,
        parameters: &'a [Parameter],
        request: &'a FitRequest,
    ) -> Self {
        let data = || request.tests.iter().filter_map(|test| test.data.as_ref());
        let scale = |measure: &Measure| {
            let stated = request.scatter.iter().find(|(of, _)| of == measure);
            stated.map_or_else(|| largest(data(), *measure), |(_, scatter)| *scatter)
        };
        let measured = |data: &Data| -> usize {
            let values = data.rows.iter().flat_map(|row| &row.values);
            values.filter(|value| value.is_finite()).count()
        };
        let over_scales = |data: &Data| -> f64 {
            let scales: Vec<f64> = data.columns.iter().map(scale).collect();
            let rows = data
                .rows
                .iter()
                .flat_map(|row| row.values.iter().zip(&scales));
            let shares = rows.filter(|(value, _)| value.is_finite());
            shares.map(|(value, scale)| (value / scale).powi(2)).sum()
        };
        Self {
            source,
            parameters,
            tests: &request.tests,
            scales: (request.tests.iter())
                .map(|test| {
                    let columns = test.data.iter().flat_map(|data| &data.columns);
                    columns.map(scale).collect()
                })
                .collect(),
            values: data().map(measured).sum(),
            size: data().map(over_scales).sum::<f64>().sqrt().max(1.0),
        }
    }

    /// Divisors of the residuals: of each column of each test, in SI.
    pub(super) fn scales(&self) -> &[Vec<f64>] {
        &self.scales
    }

    /// The parameters.
    pub(super) fn parameters(&self) -> &[Parameter] {
        self.parameters
    }

    /// How many values were measured.
    pub(super) fn values(&self) -> usize {
        self.values
    }

    /// The material of a place in the search.
    pub(super) fn material(&self, at: &[f64]) -> Result<Material, InputError> {
        let values: Vec<(String, String)> = (self.parameters.iter().zip(at))
            .map(|(p, x)| (p.key.clone(), p.text(p.value(*x))))
            .collect();
        self.source.material(&values)
    }

    /// Computed less measured, over the scale of the quantity (theory, eq. 116).
    pub(super) fn residuals(&self, at: &[f64]) -> Result<Vec<f64>, Lost> {
        let material = self.material(at).map_err(Lost::Input)?;
        let law_of = |material: &Material| material.law().map_err(|error| Lost::Test(error.into()));
        let law = law_of(&material)?;
        let mut residuals = Vec::with_capacity(self.values);
        for (place, (request, scales)) in self.tests.iter().zip(&self.scales).enumerate() {
            let by_stress = material.under(request.stress[0]);
            let by_stress = by_stress.as_ref().map(law_of).transpose()?;
            let law = by_stress.as_ref().unwrap_or(&law);
            let result = driven(&**law, request).map_err(Lost::Test)?;
            let before = residuals.len();
            let Some(compared) = result.compared else {
                continue;
            };
            for (column, scale) in scales.iter().enumerate() {
                let differences = compared.differences(column);
                residuals.extend(differences.map(|(_, difference)| difference / scale));
            }
            let values = compared.data.rows.iter().flat_map(|row| &row.values);
            let expected = values.filter(|value| value.is_finite()).count();
            if residuals.len() - before != expected {
                let why = result.run.failure.map(|lost| lost.to_string());
                return Err(Lost::Early {
                    test: place + 1,
                    why: why.unwrap_or_else(|| "its stress is not a number".to_owned()),
                });
            }
        }
        Ok(residuals)
    }

    /// The residuals a difference from a place; none where the law or a test is refused there, or where they leap by more than all that was
    /// measured: no soil is so sensitive, and a return has found another root.
    pub(super) fn beside(&self, moved: &[f64], here: &[f64]) -> Option<Vec<f64>> {
        let there = self.residuals(moved).ok()?;
        let changes = there.iter().zip(here).map(|(there, here)| there - here);
        let leap: f64 = changes.map(|change| change * change).sum();
        (leap.sqrt() <= self.size).then_some(there)
    }

    /// The derivative of the residuals, a column a parameter, by central differences; one-sided where one side is out of range or
    /// refused. None where both are.
    pub(super) fn jacobian(&self, at: &[f64], ranges: &[Range]) -> Option<Vec<Vec<f64>>> {
        let here = self.residuals(at).ok()?;
        let column = |(place, range): (usize, &Range)| {
            let [low, high] = range.ends;
            let beside = |by: f64| {
                let mut moved = at.to_vec();
                moved[place] += by;
                let is_within = (low..=high).contains(&moved[place]);
                is_within.then(|| self.beside(&moved, &here)).flatten()
            };
            let quotient = |plus: &[f64], minus: &[f64], by: f64| -> Vec<f64> {
                plus.iter().zip(minus).map(|(p, m)| (p - m) / by).collect()
            };
            match (beside(DIFFERENCE), beside(-DIFFERENCE)) {
                (Some(plus), Some(minus)) => Some(quotient(&plus, &minus, 2.0 * DIFFERENCE)),
                (Some(plus), None) => Some(quotient(&plus, &here, DIFFERENCE)),
                (None, Some(minus)) => Some(quotient(&here, &minus, DIFFERENCE)),
                (None, None) => None,
            }
        };
        ranges.iter().enumerate().map(column).collect()
    }

    /// The search, from a start at which all tests can be followed. Where it ends beside walls, it goes on with its parameters held there,
    /// and lets them go again where the sum of squares falls away from the wall.
    pub(super) fn solved(&self, start: Vec<f64>) -> Solved {
        let mut solved = Solved {
            at: start,
            ranges: self.parameters.iter().map(Range::stated).collect(),
            why: None,
            effort: [0; 2],
        };
        for _ in 0..MOST_SEARCHES {
            let found = self.searched(solved.at, &solved.ranges);
            solved.at = found.at;
            solved.why = found.why;
            for (sum, more) in solved.effort.iter_mut().zip(found.effort) {
                *sum += more;
            }
            let Ok(here) = self.residuals(&solved.at) else {
                return solved;
            };
            let ranges = self.ranges_beside((&solved.at, &here), &solved.ranges);
            let is_new = |(range, known): (&Range, &Range)| range.is_wall != known.is_wall;
            let mut pairs = ranges.iter().zip(&solved.ranges);
            let is_last = solved.why.is_some() || !pairs.any(is_new);
            solved.ranges = ranges;
            if is_last {
                return solved;
            }
        }
        let why = "it runs along values that the law or a test refuses";
        solved.why = Some(why.to_owned());
        solved
    }

    /// A search within ranges.
    fn searched(&self, start: Vec<f64>, ranges: &[Range]) -> Solved {
        let mut at = start;
        let limits = |range: &Range| {
            let mut par = MPPar::new();
            par.side = MPSide::User;
            let [low, high] = range.ends;
            if low.is_finite() {
                (par.limited_low, par.limit_low) = (true, low);
            }
            if high.is_finite() {
                (par.limited_up, par.limit_up) = (true, high);
            }
            par
        };
        let config = MPConfig {
            step_factor: FIRST_STEP,
            ..MPConfig::new()
        };
        let mut search = Search {
            problem: self,
            config,
            parameters: ranges.iter().map(limits).collect(),
            ranges,
        };
        let (why, effort) = match search.mpfit(&mut at) {
            Ok(status) => (
                unfinished(&status.success).map(str::to_owned),
                [status.n_iter, status.n_fev],
            ),
            Err(error) => (Some(refused(&error).to_owned()), [0; 2]),
        };
        Solved {
            at,
            ranges: ranges.to_vec(),
            why,
            effort,
        }
    }

    /// Whether a place is a minimum on a kink of the sum of squares; a smooth one is no kink.
    ///
    /// # Errors
    /// Why it is none: the correction that is left would make the sum less.
    pub(super) fn is_minimum(
        &self,
        at: &[f64],
        residuals: &[f64],
        jacobian: &[Vec<f64>],
        step: &[f64],
    ) -> Result<bool, &'static str> {
        let change = |row: usize| -> f64 {
            (jacobian.iter().zip(step))
                .map(|(column, by)| column[row] * by)
                .sum()
        };
        let gain: f64 = (0..residuals.len()).map(|row| change(row).powi(2)).sum();
        let sum: f64 = residuals.iter().map(|r| r * r).sum();
        let floor = residuals.len() as f64 * ROUND_OFF * ROUND_OFF;
        if gain <= LEFT * sum + floor {
            return Ok(false);
        }
        let mut is_accepted = false;
        for share in [1.0, 0.25, 0.0625, 0.015_625] {
            let moved: Vec<f64> = at.iter().zip(step).map(|(x, by)| x + share * by).collect();
            let Ok(trial) = self.residuals(&moved) else {
                continue;
            };
            is_accepted = true;
            let there: f64 = trial.iter().map(|r| r * r).sum();
            if there < (1.0 - LEFT) * sum - floor {
                return Err("the sum of squares still falls where it ended");
            }
        }
        if is_accepted {
            Ok(true)
        } else {
            Err("the law or a test refuses the correction that is left")
        }
    }
}

/// The largest value of a quantity by its size in any of the data, one where all are zero.
fn largest<'a>(data: impl Iterator<Item = &'a Data>, measure: Measure) -> f64 {
    let mut most = 0.0_f64;
    for data in data {
        let Some(column) = data.columns.iter().position(|of| *of == measure) else {
            continue;
        };
        let values = data.rows.iter().map(|row| row.values[column].abs());
        most = values
            .filter(|value| value.is_finite())
            .fold(most, f64::max);
    }
    if most > 0.0 { most } else { 1.0 }
}

/// The problem as the library takes it.
struct Search<'a> {
    problem: &'a Problem<'a>,
    config: MPConfig,
    parameters: Vec<MPPar>,
    ranges: &'a [Range],
}

impl MPFitter for Search<'_> {
    fn eval(&mut self, params: &[f64], deviates: &mut [f64]) -> MPResult<()> {
        match self.problem.residuals(params) {
            Ok(residuals) => deviates.copy_from_slice(&residuals),
            Err(_) => deviates.fill(REFUSED),
        }
        Ok(())
    }

    fn number_of_points(&self) -> usize {
        self.problem.values
    }

    fn config(&self) -> &MPConfig {
        &self.config
    }

    fn parameters(&self) -> &[MPPar] {
        &self.parameters
    }

    fn jacobian(
        &mut self,
        params: &[f64],
        deviates: &mut [f64],
        derivs: &mut [Option<Vec<f64>>],
    ) -> MPResult<()> {
        self.eval(params, deviates)?;
        let columns = (self.problem.jacobian(params, self.ranges)).ok_or(MPError::Eval)?;
        for (deriv, column) in derivs.iter_mut().zip(columns) {
            if let Some(deriv) = deriv {
                *deriv = column;
            }
        }
        Ok(())
    }
}

/// Why the search has not ended at a minimum.
fn unfinished(success: &MPSuccess) -> Option<&'static str> {
    match success {
        MPSuccess::Chi | MPSuccess::Par | MPSuccess::Both | MPSuccess::Dir => None,
        MPSuccess::MaxIter => Some("its iterations are used up"),
        MPSuccess::NotDone => Some("it was given up"),
        MPSuccess::Ftol | MPSuccess::Xtol | MPSuccess::Gtol => {
            Some("no step makes the sum of squares less, and no criterion is met")
        }
    }
}

/// Why the library gave up.
fn refused(error: &MPError) -> &'static str {
    match error {
        MPError::Nan => "a residual is not a number",
        MPError::Eval => "the law refuses values on either side",
        MPError::InitBounds | MPError::Bounds => "the start is out of bounds",
        MPError::DoF | MPError::Empty | MPError::NoFree | MPError::Input => {
            "there are no data or no parameters"
        }
    }
}
