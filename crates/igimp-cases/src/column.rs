//! A column compressed by its own weight: stress along the column against the exact solution
//! (Yuan et al. 2021, first benchmark; set-up after Charlton et al. 2017).

use std::ops::ControlFlow;
use std::sync::Arc;

use igimp_assembly::{AssemblyError, Constraints, Method, Particles, StepConditions, StepLoads};
use igimp_material::{Elasticity, HenckyElastic};
use igimp_shape::{Axis, Grid};
use igimp_solver::{Body, MarchReport, MarchSettings, Workspace, linear::SolverKind, march};

use crate::error::CaseError;
use crate::exact::Column as ExactColumn;
use crate::parameter::{at_least_one, not_negative, positive};
use crate::seed::fill_polygon;
use crate::table::Table;

/// Parameters of the column; SI units.
#[derive(Clone, Debug)]
pub struct Column {
    /// Variant of the method.
    pub method: Method,
    /// Number of cells over the height; the column is one cell wide.
    pub cells: usize,
    /// Initial height l₀ \[m\].
    pub height: f64,
    /// Young's modulus \[Pa\].
    pub young: f64,
    /// Initial density \[kg/m³\].
    pub density: f64,
    /// Gravity \[m/s²\], positive downwards.
    pub gravity: f64,
    /// Particles per cell and direction.
    pub per_direction: usize,
    /// Load steps.
    pub steps: usize,
}

impl Default for Column {
    fn default() -> Self {
        Self {
            method: without_dropping(Method::default()),
            cells: 64,
            height: 50.0,
            young: 10e3,
            density: 80.0,
            gravity: 10.0,
            per_direction: 2,
            steps: 40,
        }
    }
}

/// A method that keeps every node however little soil it carries: in one dimension no small cut
/// is dangerous, and dropping nodes would cost accuracy (up to 15 % of the stress error).
pub fn without_dropping(mut method: Method) -> Method {
    method.small_cuts.below = 0.0;
    method
}

/// The column in equilibrium under its full weight, or as far as it came.
#[derive(Clone, Debug)]
pub struct ColumnResult {
    /// Σ|σ_yy − σ_exact| V_0 / (ρ₀ g l₀ ΣV_0) \[-\].
    pub stress_error: f64,
    /// Largest |σ_yy − σ_exact| / (ρ₀ g l₀) \[-\].
    pub largest_error: f64,
    /// Height of the column, to the top edge of the highest particle \[m\].
    pub top: f64,
    /// Exact height \[m\].
    pub exact_top: f64,
    /// Initial height, position, σ_yy and its exact value by particle, bottom to top.
    pub stress: Table,
    /// The steps.
    pub report: MarchReport,
}

impl Column {
    /// The exact solution of these parameters.
    pub fn exact(&self) -> ExactColumn {
        ExactColumn {
            height: self.height,
            density: self.density,
            gravity: self.gravity,
            young: self.young,
        }
    }

    /// Loads the column by its weight.
    ///
    /// # Errors
    /// [`CaseError`] for parameters that make no sense. A march that finds no equilibrium is a
    /// result: its report says so, and the measures are those of the last equilibrium.
    pub fn run(&self) -> Result<ColumnResult, CaseError> {
        self.validate()?;
        let h = self.height / self.cells as f64;
        let grid = Grid::new([
            Axis::uniform(0.0, h, 1)?,
            Axis::uniform(0.0, h, self.cells + 1)?,
        ]);
        let polygon = [[0.0, 0.0], [h, 0.0], [h, self.height], [0.0, self.height]];
        let seeds = fill_polygon(&grid, &polygon, self.per_direction, self.density, 0)?;
        let mut body = Body::new(Particles::new(&seeds)?);
        let initial_height: Vec<f64> = seeds.iter().map(|seed| seed.x[1]).collect();
        let law = Arc::new(HenckyElastic::new(Elasticity::new(self.young, 0.0)?));
        let mut constraints = Constraints::free(&grid);
        constraints.fix_wall(&grid, 1, false, 1);
        constraints.fix_wall(&grid, 0, false, 0);
        constraints.fix_wall(&grid, 0, true, 0);
        let program = |_from: f64, to: f64| -> Result<StepConditions<2>, AssemblyError> {
            Ok(StepConditions {
                grid: grid.clone(),
                constraints: constraints.clone(),
                loads: StepLoads {
                    gravity: [0.0, -to * self.gravity],
                    factors: Vec::new(),
                    drag: 0.0,
                },
                laws: vec![law.clone()],
            })
        };
        let report = march(
            &mut body,
            &self.method,
            &program,
            &MarchSettings::steps(self.steps),
            &mut Workspace::new(SolverKind::Auto.build()),
            &mut |_: &igimp_solver::Accepted<'_, 2>| ControlFlow::Continue(()),
        );
        Ok(self.measure(&body.particles, &initial_height, report))
    }

    fn validate(&self) -> Result<(), CaseError> {
        at_least_one("cells", self.cells)?;
        at_least_one("per_direction", self.per_direction)?;
        at_least_one("steps", self.steps)?;
        positive("height", self.height)?;
        positive("density", self.density)?;
        not_negative("gravity", self.gravity)
    }

    fn measure(
        &self,
        particles: &Particles<2>,
        initial_height: &[f64],
        report: MarchReport,
    ) -> ColumnResult {
        let exact = self.exact();
        let base = self.density * self.gravity * self.height;
        let mut order: Vec<usize> = (0..particles.len()).collect();
        order.sort_by(|&a, &b| initial_height[a].total_cmp(&initial_height[b]));
        let mut stress = Table::new(
            "stress",
            &[
                "initial_height_[m]",
                "height_[m]",
                "sigma_yy_[Pa]_tension_+",
                "exact_[Pa]_tension_+",
            ],
        );
        let (mut sum, mut volume, mut largest, mut top) = (0.0, 0.0, 0.0_f64, 0.0_f64);
        for particle in order {
            let y0 = initial_height[particle];
            let y = particles.x[particle][1];
            let sigma = particles.sigma[particle][1][1];
            let difference = (sigma - exact.sigma_yy(y0)).abs();
            sum += difference * particles.volume0[particle];
            volume += particles.volume0[particle];
            largest = largest.max(difference / base);
            top = top.max(y + particles.half_length[particle][1]);
            stress.push(vec![y0, y, sigma, exact.sigma_yy(y0)]);
        }
        ColumnResult {
            stress_error: sum / (base * volume),
            largest_error: largest,
            top,
            exact_top: exact.position(self.height),
            stress,
            report,
        }
    }
}
