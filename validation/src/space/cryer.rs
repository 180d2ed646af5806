//! Cryer's sphere: pressed on all sides at once, its pressure in the middle rises before it falls.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{
    Consolidating, Constraints, Method, ParticleSeed, Particles, Permeable, PoreFlow, PoreSite,
    PoreState, PoreWater, Section, SharedLaw, StepConditions, StepLoads,
};
use igimp_cases::CaseError;
use igimp_geometry::seed::{fill, fill_polygon};
use igimp_geometry::solid::{Solid, Sphere};
use igimp_material::{Elasticity, HenckyElastic};
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use igimp_shape::Grid;
use igimp_solver::{Accepted, Body, MarchSettings};

use super::Octant;
use crate::continuum::laboratory::{grid_of, run};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};

/// The book's description of the study.
const ABOUT: &str = "A sphere of elastic soil, an eighth of it, is pressed on all sides at once and drains at its surface. As the outer shell gives way first, the pressure in the middle rises above that of the load before it falls. In place of a load a suction of p₀ comes at once and everywhere: before water flows, all of it is excess pressure. The same sphere is computed as a body of revolution, by a quarter of its section.";
const CRYER: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Cryer 1963",
    locator: "u/p₀ = η Σ (sin x − x)/((η − 1) sin x + ½ η x cos x) exp(−x² T), (1 − ½ η x²) tan x = x, η = (1 − ν)/(1 − 2ν)",
};
/// Pressure over Young's modulus: small strain \[-\].
const LOAD: f64 = 1e-4;
/// Times c t/R² of the first step and of the second, and by how much later ones are longer \[-\].
const FIRST: f64 = 1e-9;
const SECOND: f64 = 1e-4;
const RATIO: f64 = 1.07;
/// Times at which the pressure is held against the series \[-\].
const TIMES: [f64; 5] = [0.01, 0.05, 0.1, 0.2, 0.5];
/// Corners of the polygon along a quarter of the circle.
const ARC: usize = 200;
/// Within this share of the radius particles tell the pressure in the middle \[-\].
const MIDDLE: f64 = 0.3;

/// Cells along the radius, how far pressures may be from the series over the load, and the lowest level \[-\].
const MESHES: [(usize, f64, Level); 4] = [
    (5, 0.07, Level::Quick),
    (8, 0.025, Level::Full),
    (12, 0.02, Level::Full),
    (16, 0.01, Level::Full),
];

/// The same for a body of revolution.
const TURNED: [(usize, f64, Level); 2] = [(8, 0.025, Level::Quick), (16, 0.01, Level::Default)];

/// A sphere of radius 1 and Young's modulus 1, its mobility 1.
#[derive(Clone, Copy, Debug)]
struct Ball {
    cells: usize,
    poisson: f64,
    form: Form,
}

/// The form in which it is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    /// An eighth of it, in space.
    Space,
    /// A quarter of its section, turned about an axis.
    Revolution,
}

/// The same pore pressure everywhere.
#[derive(Debug)]
struct Uniform(f64);

impl<const D: usize> PoreWater<D> for Uniform {
    fn at(&self, _: PoreSite<'_, D>) -> PoreState<D> {
        PoreState {
            pressure: self.0,
            ..PoreState::dry()
        }
    }
}

impl Ball {
    /// Constrained modulus, the coefficient of consolidation.
    fn modulus(&self) -> f64 {
        (1.0 - self.poisson) / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson))
    }

    /// Pressure in the middle over that of the load, at a time \[-\].
    fn exact(&self, time: f64) -> f64 {
        let eta = (1.0 - self.poisson) / (1.0 - 2.0 * self.poisson);
        let missed = |x: f64| (1.0 - 0.5 * eta * x * x) * x.sin() - x * x.cos();
        let terms = (1..400).map(|k| {
            let mut ends = [f64::from(k) * PI - FRAC_PI_2, f64::from(k) * PI];
            let begins_above = missed(ends[0]) > 0.0;
            for _ in 0..200 {
                let middle = 0.5 * (ends[0] + ends[1]);
                let end = usize::from((missed(middle) > 0.0) != begins_above);
                ends[end] = middle;
            }
            let x = ends[0];
            let weight = (x.sin() - x) / ((eta - 1.0) * x.sin() + 0.5 * eta * x * x.cos());
            weight * (-x * x * time).exp()
        });
        eta * terms.sum::<f64>()
    }

    /// Runs it; the table has time, pressure in the middle and exact pressure.
    fn run(&self) -> Result<(RunRecord, Table), CaseError> {
        let (cell, mut method) = (1.0 / self.cells as f64, Method::igimp_bbar());
        if self.form == Form::Space {
            let grid = grid_of(cell, [self.cells + 1; 3])?;
            let ball = Octant(Solid::Sphere(Sphere {
                centre: [0.0; 3],
                radius: 1.0,
            }));
            let seeds = fill(&grid, &ball, 2, 1.0, 0)?;
            return self.pressed(&grid, &seeds, &method);
        }
        method.section = Section::Axisymmetric;
        let grid = grid_of(cell, [self.cells + 1; 2])?;
        let arc = (0..=ARC).map(|k| (FRAC_PI_2 * k as f64 / ARC as f64).sin_cos());
        let mut quarter: Vec<[f64; 2]> = arc.map(|(y, x)| [x, y]).collect();
        quarter[ARC] = [0.0, 1.0];
        quarter.push([0.0, 0.0]);
        let mut seeds = fill_polygon(&grid, &quarter, 2, 1.0, 0)?;
        for seed in &mut seeds {
            let centroid = seed.x[0] + seed.centroid[0] * seed.half_length[0];
            seed.volume *= method.section.thickness(centroid);
        }
        self.pressed(&grid, &seeds, &method)
    }

    /// Presses the ball that particles fill.
    fn pressed<const D: usize>(
        &self,
        grid: &Grid<D>,
        seeds: &[ParticleSeed<D>],
        method: &Method,
    ) -> Result<(RunRecord, Table), CaseError> {
        let mut body = Body::new(Particles::new(seeds)?);
        let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(1.0, self.poisson)?));
        let mut constraints = Constraints::free(grid);
        for axis in 0..D {
            constraints.fix_wall(grid, axis, false, axis)?;
        }
        let last = *TIMES.last().expect("there are times");
        let later = ((last / SECOND).ln() / RATIO.ln()).ceil();
        let steps = 2 + later as usize;
        let time = |step: f64| match step {
            0.0 => 0.0,
            1.0 => FIRST,
            _ => SECOND * (last / SECOND).powf((step - 2.0) / later),
        };
        let load_path = |from: f64, to: f64| {
            let [from, to] = [from, to].map(|factor| (factor * steps as f64).round());
            let took = |from: f64, to: f64| (time(to) - time(from)) / self.modulus();
            let mut mobility = [[0.0; D]; D];
            for (axis, row) in mobility.iter_mut().enumerate() {
                row[axis] = 1.0;
            }
            let mut conditions = StepConditions::new(
                grid.clone(),
                constraints.clone(),
                StepLoads::gravity([0.0; D]),
                vec![Arc::clone(&law)],
            )?;
            conditions.water.given = Some(Arc::new(Uniform(-LOAD)));
            conditions.water.factor = 1.0;
            conditions.with_flow(Some(Consolidating {
                duration: took(from, to),
                before: if from < 2.0 {
                    0.0
                } else {
                    took(from - 1.0, from)
                },
                must_resolve: false,
                soils: vec![PoreFlow::Flows(Permeable {
                    mobility,
                    stiffness: f64::INFINITY.into(),
                    follows: None,
                })],
                open_sides: Vec::new(),
                open_faces: true,
                drains: Vec::new(),
            }))
        };
        let (turned, title) = match self.form {
            Form::Space => ("", ""),
            Form::Revolution => ("_turned", "of revolution, "),
        };
        let mut curve = Table::new(
            format!("pressure_nu{:.2}_{}{turned}", self.poisson, self.cells),
            &["time_[-]", "pressure_in_the_middle_[-]", "exact_[-]"],
        );
        let mut observe = |accepted: &Accepted<'_, D>| {
            let at = time((accepted.report.to * steps as f64).round());
            let found = in_the_middle(&accepted.body.particles) / LOAD;
            curve.push(vec![at, found, self.exact(at)]);
            ControlFlow::Continue(())
        };
        let variant = format!("{title}ν = {:.2}, R/h = {}", self.poisson, self.cells);
        let settings = MarchSettings::steps(steps);
        let (run, _) = run(
            variant,
            &mut body,
            method,
            &settings,
            &load_path,
            &mut observe,
        );
        Ok((run, curve))
    }
}

/// Pressure at the origin by the parabola in the distance that is nearest to the particles around it.
fn in_the_middle<const D: usize>(particles: &Particles<D>) -> f64 {
    let [mut n, mut s, mut ss, mut p, mut sp] = [0.0; 5];
    for (x, excess) in particles.x.iter().zip(&particles.excess) {
        let square: f64 = x.iter().map(|x| x * x).sum();
        if square < MIDDLE * MIDDLE {
            n += 1.0;
            s += square;
            ss += square * square;
            p += excess;
            sp += square * excess;
        }
    }
    (p * ss - sp * s) / (n * ss - s * s)
}

/// The step of the curve that ends nearest to a time.
fn nearest(curve: &Table, time: f64) -> [f64; 3] {
    let apart = |row: &&Vec<f64>| (row[0] / time).ln().abs();
    let rows = curve.rows.iter();
    let row = rows.min_by(|a, b| apart(a).total_cmp(&apart(b)));
    row.map_or([f64::NAN; 3], |row| [row[0], row[1], row[2]])
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("space-cryer", ABOUT, out)?;
    for (form, meshes) in [(Form::Space, &MESHES[..]), (Form::Revolution, &TURNED)] {
        for &(cells, band, _) in meshes.iter().filter(|(.., least)| *least <= level) {
            for poisson in [0.0, 1.0 / 3.0] {
                let ball = Ball {
                    cells,
                    poisson,
                    form,
                };
                hold(&mut study, ball, band)?;
            }
        }
    }
    Ok(study)
}

/// Runs a sphere and holds its pressures against the series, within a share of the load.
fn hold(study: &mut Study, ball: Ball, band: f64) -> Result<(), CaseError> {
    let (run, curve) = ball.run()?;
    let run = study.run_to_end(run);
    let mut check = |quantity: String, exact: f64, found: f64| {
        let around = Band::Between(exact - band, exact + band);
        study.check(run, quantity, CRYER.says(exact), around, found);
    };
    for time in TIMES {
        let [time, found, exact] = nearest(&curve, time);
        let quantity = format!("pressure in the middle / p₀ at c t/R² = {time:.3} [-]");
        check(quantity, exact, found);
    }
    let later = curve.rows.iter().filter(|row| row[0] > 10.0 * SECOND);
    let most = |of: usize| later.clone().map(|row| row[of]).fold(f64::MIN, f64::max);
    check(
        "largest pressure in the middle / p₀ [-]".to_owned(),
        most(2),
        most(1),
    );
    study.table(curve)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_is_that_of_the_tables() {
        // Computed apart from this program, to five digits.
        for (poisson, time, value) in [
            (0.0, 0.01, 1.24545),
            (0.0, 0.5, 0.27231),
            (1.0 / 3.0, 0.05, 1.20557),
        ] {
            let form = Form::Space;
            let ball = Ball {
                cells: 1,
                poisson,
                form,
            };
            assert!(
                (ball.exact(time) - value).abs() < 1e-5,
                "{}",
                ball.exact(time)
            );
        }
    }
}
