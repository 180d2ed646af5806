//! A 45° slope in von Mises soil: how smooth the stress is in the four variants of the method, and
//! at which weight the slope collapses (Yuan et al. 2021, second benchmark).

use std::ops::ControlFlow;
use std::sync::Arc;

use igimp_assembly::{Method, Particles, SharedLaw};
use igimp_material::{Elasticity, VonMises};
use igimp_solver::{
    Accepted, Body, MarchReport, MarchSettings, Outcome, Workspace, linear::SolverKind, march,
};

use crate::error::CaseError;
use crate::measure::{displacement_norm, oscillation, sigma};
use crate::parameter::{at_least_one, not_negative, positive};
use crate::seed::fill_polygon;
use crate::slope::{GRAVITY, SlopeGeometry, under_gravity};
use crate::table::Table;

/// Parameters of the von Mises slope; SI units.
#[derive(Clone, Debug)]
pub struct VonMisesSlope {
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
    /// Undrained strength c_u in plane strain \[Pa\].
    pub undrained_strength: f64,
    /// Unit weight γ \[N/m³\].
    pub unit_weight: f64,
    /// Particles per cell and direction.
    pub per_direction: usize,
    /// Load steps.
    pub steps: usize,
    /// Gravity is raised to this multiple of the unit weight \[-\].
    pub load_factor: f64,
    /// The march ends when the largest particle displacement exceeds this \[m\].
    pub largest_displacement: f64,
}

impl Default for VonMisesSlope {
    fn default() -> Self {
        Self {
            method: Method::default(),
            geometry: SlopeGeometry {
                height: 10.0,
                run: 10.0,
                crest: 15.0,
                toe: 15.0,
                foundation: 5.0,
            },
            cell: 0.5,
            young: 1e6,
            poisson: 0.49,
            undrained_strength: 45e3,
            unit_weight: 20e3,
            per_direction: 2,
            steps: 10,
            load_factor: 1.0,
            largest_displacement: f64::INFINITY,
        }
    }
}

/// A slope after its march.
#[derive(Clone, Debug)]
pub struct SlopeResult {
    /// The particles at the last equilibrium.
    pub particles: Particles<2>,
    /// Multiple of the unit weight reached \[-\].
    pub load_factor: f64,
    /// Multiple of the unit weight against the largest particle displacement.
    pub displacement: Table,
    /// The steps.
    pub report: MarchReport,
}

impl VonMisesSlope {
    /// Raises gravity to the load factor, or to collapse.
    ///
    /// # Errors
    /// [`CaseError`] for parameters that make no sense. Collapse is a result.
    pub fn run(&self) -> Result<SlopeResult, CaseError> {
        self.geometry.validate()?;
        at_least_one("per_direction", self.per_direction)?;
        at_least_one("steps", self.steps)?;
        not_negative("unit_weight", self.unit_weight)?;
        positive("load_factor", self.load_factor)?;
        let grid = self.geometry.grid(self.cell, 4.0 * self.cell)?;
        let density = self.unit_weight / GRAVITY;
        let polygon = self.geometry.polygon();
        let seeds = fill_polygon(&grid, &polygon, self.per_direction, density, 0)?;
        let mut body = Body::new(Particles::new(&seeds)?);
        let elasticity = Elasticity::new(self.young, self.poisson)?;
        let law = VonMises::from_undrained_strength(elasticity, self.undrained_strength)?;
        let laws: Vec<SharedLaw> = vec![Arc::new(law)];
        let constraints = self.geometry.walls(&grid);
        let mut displacement = Table::new(
            "displacement",
            &["load_factor_[-]", "largest_displacement_[m]"],
        );
        displacement.push(vec![0.0, 0.0]);
        let report = march(
            &mut body,
            &self.method,
            &|_: f64, to: f64| {
                Ok(under_gravity(
                    &grid,
                    &constraints,
                    &laws,
                    to * self.load_factor,
                ))
            },
            &MarchSettings::steps(self.steps),
            &mut Workspace::new(SolverKind::Auto.build()),
            &mut |accepted: &Accepted<'_, 2>| {
                let norms = displacement_norm(&accepted.body.particles);
                let largest = norms.into_iter().fold(0.0, f64::max);
                displacement.push(vec![accepted.report.to * self.load_factor, largest]);
                if largest > self.largest_displacement {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            },
        );
        Ok(SlopeResult {
            particles: body.particles,
            load_factor: report.reached() * self.load_factor,
            displacement,
            report,
        })
    }

    /// γH/c_u at a multiple of the unit weight \[-\].
    pub fn stability_number(&self, load_factor: f64) -> f64 {
        load_factor * self.unit_weight * self.geometry.height / self.undrained_strength
    }

    /// Root mean square of the deviation of σ_yy from local planes of radius 1.3 h, over γH \[-\].
    pub fn oscillation(&self, particles: &Particles<2>) -> f64 {
        let scale = self.unit_weight * self.geometry.height;
        oscillation(&particles.x, &sigma(particles, 1, 1), 1.3 * self.cell) / scale
    }
}

impl SlopeResult {
    /// Multiple of the unit weight at which the largest displacement reaches a value, linear
    /// between steps \[-\]. Where the march ended before that for want of equilibrium it is the
    /// last multiple reached; `None` when the slope was still standing at the end of the march.
    pub fn load_factor_at(&self, displacement: f64) -> Option<f64> {
        let rows = &self.displacement.rows;
        let crossing = rows.windows(2).find(|pair| displacement <= pair[1][1]);
        match (crossing, &self.report.outcome) {
            (Some(pair), _) => {
                let t = (displacement - pair[0][1]) / (pair[1][1] - pair[0][1]);
                Some(pair[0][0] + t * (pair[1][0] - pair[0][0]))
            }
            (None, Outcome::StepTooSmall { .. }) => Some(self.load_factor),
            (None, _) => None,
        }
    }
}
