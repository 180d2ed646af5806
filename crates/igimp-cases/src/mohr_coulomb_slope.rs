//! A slope in Mohr–Coulomb soil: largest displacement against strength reduction factor, and the
//! factor of safety (Yuan et al. 2021, third benchmark; Griffiths and Lane 1999, example 1).

use std::ops::ControlFlow;

use igimp_assembly::{Method, Particles, SharedLaw};
use igimp_material::{ConstitutiveModel, Elasticity, MohrCoulomb};
use igimp_solver::{
    Accepted, Body, MarchReport, MarchSettings, Outcome, Workspace, linear::SolverKind, march,
};

use crate::error::CaseError;
use crate::measure::displacement_norm;
use crate::parameter::{at_least_one, not_negative};
use crate::safety::Verdict;
use crate::seed::fill_polygon;
use crate::slope::{GRAVITY, SlopeGeometry, under_gravity};

/// E δ_max / (γ H²) above which a slope counts as failed \[-\].
pub const FAILURE_DISPLACEMENT: f64 = 1.0;

/// Parameters of the Mohr–Coulomb slope; SI units and radians.
#[derive(Clone, Debug)]
pub struct MohrCoulombSlope {
    /// Variant of the method.
    pub method: Method,
    /// Outline.
    pub geometry: SlopeGeometry,
    /// Cell size h \[m\].
    pub cell: f64,
    /// Young's modulus \[Pa\].
    pub young: f64,
    /// Poisson's ratio \[-\].
    pub poisson: f64,
    /// Cohesion c \[Pa\].
    pub cohesion: f64,
    /// Friction angle φ \[rad\].
    pub friction_angle: f64,
    /// Dilation angle ψ \[rad\].
    pub dilation_angle: f64,
    /// Unit weight γ \[N/m³\].
    pub unit_weight: f64,
    /// Particles per cell and direction.
    pub per_direction: usize,
    /// Load steps of each trial.
    pub steps: usize,
}

impl Default for MohrCoulombSlope {
    fn default() -> Self {
        Self {
            method: Method::default(),
            geometry: SlopeGeometry {
                height: 10.0,
                run: 20.0,
                crest: 12.0,
                toe: 0.0,
                foundation: 0.0,
            },
            cell: 0.5,
            young: 1e8,
            poisson: 0.3,
            cohesion: 10e3,
            friction_angle: 20.0_f64.to_radians(),
            dilation_angle: 0.0,
            unit_weight: 20e3,
            per_direction: 2,
            steps: 5,
        }
    }
}

/// The slope under full gravity at a reduced strength, or as far as it came.
#[derive(Clone, Debug)]
pub struct ReducedSlope {
    /// Strength reduction factor \[-\].
    pub srf: f64,
    /// The particles at the last equilibrium.
    pub particles: Particles<2>,
    /// E δ_max / (γ H²), δ_max over particles \[-\].
    pub displacement: f64,
    /// The steps.
    pub report: MarchReport,
}

impl ReducedSlope {
    /// Whether the slope stands, and why: it has failed when no equilibrium was found or when
    /// E δ_max/(γ H²) exceeds [`FAILURE_DISPLACEMENT`].
    pub fn verdict(&self) -> Verdict {
        let (stable, reason) = match &self.report.outcome {
            Outcome::StepTooSmall {
                last_converged,
                cause,
            } => {
                let at = crate::check::short(*last_converged);
                (
                    false,
                    format!("no equilibrium beyond {at} of gravity: {}", cause.failure),
                )
            }
            _ if self.displacement > FAILURE_DISPLACEMENT => (
                false,
                format!("E delta_max/(gamma H^2) exceeds {FAILURE_DISPLACEMENT}"),
            ),
            _ => (true, "in equilibrium".to_owned()),
        };
        Verdict {
            stable,
            reason,
            measure: self.displacement,
        }
    }
}

impl MohrCoulombSlope {
    /// Raises gravity to its full value on soil whose strength is divided by `srf`.
    ///
    /// # Errors
    /// [`CaseError`] for parameters that make no sense. Collapse is a result.
    pub fn run(&self, srf: f64) -> Result<ReducedSlope, CaseError> {
        self.geometry.validate()?;
        at_least_one("per_direction", self.per_direction)?;
        at_least_one("steps", self.steps)?;
        not_negative("unit_weight", self.unit_weight)?;
        let grid = self.geometry.grid(self.cell, 4.0)?;
        let density = self.unit_weight / GRAVITY;
        let polygon = self.geometry.polygon();
        let seeds = fill_polygon(&grid, &polygon, self.per_direction, density, 0)?;
        let mut body = Body::new(Particles::new(&seeds)?);
        let law = MohrCoulomb::new(
            Elasticity::new(self.young, self.poisson)?,
            self.cohesion,
            self.friction_angle,
            self.dilation_angle,
        )?;
        let laws: Vec<SharedLaw> = vec![law.reduced(srf)?];
        let constraints = self.geometry.walls(&grid);
        let report = march(
            &mut body,
            &self.method,
            &|_: f64, to: f64| Ok(under_gravity(&grid, &constraints, &laws, to)),
            &MarchSettings::steps(self.steps),
            &mut Workspace::new(SolverKind::Auto.build()),
            &mut |_: &Accepted<'_, 2>| ControlFlow::Continue(()),
        );
        let largest = displacement_norm(&body.particles)
            .into_iter()
            .fold(0.0, f64::max);
        let scale = self.unit_weight * self.geometry.height.powi(2) / self.young;
        Ok(ReducedSlope {
            srf,
            particles: body.particles,
            displacement: largest / scale,
            report,
        })
    }
}
