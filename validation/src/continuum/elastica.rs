//! The beam under an end load against the elastica.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{
    Constraints, LoadPoint, Locking, Method, Particles, SharedLaw, StepConditions, StepLoads,
};
use igimp_cases::CaseError;
use igimp_figures::{Colour, CurvePlot, LineStyle, Scale, Series, SeriesStyle};
use igimp_geometry::seed::fill_polygon;
use igimp_material::{Elasticity, HenckyElastic};
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use igimp_shape::{Axis, Grid};
use igimp_solver::{Accepted, Body, MarchSettings};
use rayon::prelude::*;

use crate::continuum::laboratory::run;
use crate::exact::elastica::Cantilever;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};

/// The book's description of the study.
const ABOUT: &str = "A slender elastic cantilever is bent by a dead load at its end, up to P L²/EI = 5. The deflection against the exact beam with extension and shear, and its dependence on mesh, particles and number of steps: B-bar softens the beam by a little in every step in which particles cross cells.";
/// The deflection of the end.
const REISSNER: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "elastica with extension and shear, Reissner 1972",
    locator: "shooting; without extension and shear the elliptic integrals of Mattiasson 1981",
};
/// Length of the beam over its depth \[-\].
const LENGTH: f64 = 10.0;
/// E I / (E A L²) of a depth of 1 \[-\].
const EXTENSION: f64 = 1.0 / (12.0 * LENGTH * LENGTH);
/// E I / (κ G A L²) with κ = 5/6 and G = E/2 \[-\].
const SHEAR: f64 = 2.4 * EXTENSION;

/// A beam of depth 1, clamped on the left, P = `load` and E I = L² at its end.
#[derive(Clone, Debug)]
struct Bending {
    load: f64,
    /// Cells over the depth.
    cells: usize,
    /// Particles in a cell along one direction.
    points: usize,
    steps: usize,
    method: Method,
}

/// The state of a beam at the end.
struct Bent {
    run: RunRecord,
    /// Load P L²/EI and deflection over length by step.
    curve: Vec<[f64; 2]>,
    /// How much of the change of volume that F shows is stored as elastic strain: the slope of the
    /// one over the other, over all particles \[-\].
    stored: f64,
}

impl Bent {
    /// Deflection at the end over length \[-\].
    fn end(&self) -> f64 {
        self.curve.last().map_or(f64::NAN, |point| point[1])
    }
}

impl Bending {
    fn run(&self) -> Result<Bent, CaseError> {
        let h = 1.0 / self.cells as f64;
        let grid = Grid::new([
            Axis::uniform(0.0, h, 11 * self.cells)?,
            Axis::uniform(-9.0, h, 11 * self.cells)?,
        ]);
        let polygon = [[0.0, 0.0], [10.25, 0.0], [10.25, 1.0], [0.0, 1.0]];
        let seeds = fill_polygon(&grid, &polygon, self.points, 1.0, 0)?;
        let mut body = Body {
            particles: Particles::new(&seeds)?,
            load_points: vec![LoadPoint {
                x: [LENGTH, 0.5],
                force: [0.0, -self.load],
                load: 0,
            }],
            rigid: Vec::new(),
            reinforcement: Vec::new(),
            free_fields: Vec::new(),
        };
        let elasticity = Elasticity::new(12.0 * LENGTH * LENGTH, 0.0)?;
        let law: SharedLaw = Arc::new(HenckyElastic::new(elasticity));
        let mut constraints = Constraints::free(&grid);
        constraints.fix_wall(&grid, 0, false, 0)?;
        constraints.fix_wall(&grid, 0, false, 1)?;
        let load_path = |_from: f64, to: f64| {
            StepConditions::new(
                grid.clone(),
                constraints.clone(),
                StepLoads {
                    factors: vec![to],
                    ..StepLoads::gravity([0.0; 2])
                },
                vec![Arc::clone(&law)],
            )
        };
        let mut curve = Vec::new();
        let mut observe = |accepted: &Accepted<'_, 2>| {
            let tip = accepted.body.load_points[0].x;
            curve.push([self.load * accepted.report.to, (0.5 - tip[1]) / LENGTH]);
            ControlFlow::Continue(())
        };
        let variant = format!(
            "{}, {} cells over the depth, {}² points, steps: {}, P L²/EI = {}",
            self.method.label(),
            self.cells,
            self.points,
            self.steps,
            self.load,
        );
        let settings = MarchSettings::steps(self.steps);
        let (run, _) = run(
            variant,
            &mut body,
            &self.method,
            &settings,
            &load_path,
            &mut observe,
        );
        let stored = stored_share(&body.particles);
        Ok(Bent { run, curve, stored })
    }
}

/// Deflection of the exact beam over its length \[-\].
fn deflection(load: f64) -> f64 {
    Cantilever {
        load,
        extension: EXTENSION,
        shear: SHEAR,
    }
    .end()[0]
}

/// Σ ln J_e ln J / Σ (ln J)² with J_e = √det b_e and J = det F \[-\].
fn stored_share(particles: &Particles<2>) -> f64 {
    let (mut product, mut square) = (0.0, 0.0);
    for particle in 0..particles.len() {
        let [x, y, z] = particles.b_e[particle];
        let det = x[0] * (y[1] * z[2] - y[2] * z[1]) - x[1] * (y[0] * z[2] - y[2] * z[0])
            + x[2] * (y[0] * z[1] - y[1] * z[0]);
        let volume = (particles.volume(particle) / particles.volume0[particle]).ln();
        product += 0.5 * det.ln() * volume;
        square += volume * volume;
    }
    product / square
}

/// The beams of a level, each with the error that is accepted \[-\].
fn beams(level: Level) -> Vec<(Bending, f64)> {
    let bar = |cells: usize, points: usize, steps: usize| Bending {
        load: 1.0,
        cells,
        points,
        steps,
        method: Method::igimp_bbar(),
    };
    let plain = |steps: usize| Bending {
        method: Method::igimp(),
        ..bar(8, 3, steps)
    };
    let mut beams = vec![
        (bar(8, 3, 1), 0.005),
        (plain(1), 0.005),
        (bar(8, 3, 10), 0.025),
        (plain(10), 0.005),
    ];
    if level > Level::Quick {
        for steps in [2, 5, 20, 40] {
            beams.push((bar(8, 3, steps), 0.03));
        }
        for load in [2.0, 5.0] {
            let beam = Bending {
                load,
                ..bar(8, 3, 20)
            };
            beams.push((beam, 0.03));
        }
        for (cells, points) in [(8, 2), (8, 4), (4, 3)] {
            beams.push((bar(cells, points, 10), 0.035));
        }
    }
    if level == Level::Full {
        beams.push((bar(16, 3, 1), 0.005));
        beams.push((bar(16, 3, 10), 0.015));
    }
    beams
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("elastica", ABOUT, out)?;
    let beams = beams(level);
    let done = beams
        .par_iter()
        .map(|(beam, _)| beam.run())
        .collect::<Result<Vec<_>, CaseError>>()?;
    let header = [
        "bbar",
        "load_[-]",
        "cells",
        "points",
        "steps",
        "deflection_[-]",
        "exact_[-]",
        "stored_share_of_volume_change_[-]",
    ];
    let mut table = Table::new(format!("deflection_{}_runs", beams.len()), &header);
    let mut drift = Vec::new();
    let mut longest = Vec::new();
    for ((beam, share), bent) in beams.iter().zip(done) {
        let (end, exact) = (bent.end(), deflection(beam.load));
        table.push(vec![
            f64::from(u8::from(beam.method.locking == Locking::BBar)),
            beam.load,
            beam.cells as f64,
            beam.points as f64,
            beam.steps as f64,
            end,
            exact,
            bent.stored,
        ]);
        if beam.method.locking == Locking::BBar
            && beam.cells == 8
            && beam.points == 3
            && beam.load <= 1.0
        {
            drift.push([beam.steps as f64, 100.0 * (end / exact - 1.0)]);
        }
        if beam.load > 2.0 {
            longest = bent.curve;
        }
        let run = study.run_to_end(bent.run);
        let quantity = "deflection of the end over the length [-]";
        let band = Band::Relative(*share);
        study.check(run, quantity, REISSNER.says(exact), band, end);
    }
    pictures(&study, drift, longest)?;
    study.table(table)?;
    Ok(study)
}

/// The drift with the number of steps, and the deflection under growing load.
fn pictures(
    study: &Study,
    mut drift: Vec<[f64; 2]>,
    curve: Vec<[f64; 2]>,
) -> Result<(), CaseError> {
    drift.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let style = SeriesStyle::LineAndMarkers(LineStyle::Solid);
    CurvePlot {
        title: "Beam, P L^{2}/EI = 1, 8 cells over the depth".into(),
        x_label: "steps".into(),
        y_label: "error of the deflection [%]".into(),
        x_scale: Scale::Log,
        series: vec![Series::new("iGIMP + B-bar", drift, style)],
        ..CurvePlot::default()
    }
    .write(&study.folder.join("drift"))?;
    if curve.is_empty() {
        return Ok(());
    }
    let exact = (1..=100)
        .map(|k| {
            let load = 0.05 * f64::from(k);
            [load, deflection(load)]
        })
        .collect();
    CurvePlot {
        title: "Beam under an end load".into(),
        x_label: "P L^{2}/EI".into(),
        y_label: "deflection / length".into(),
        series: vec![
            Series::line("exact", exact).in_colour(Colour::BLACK),
            Series::markers("iGIMP + B-bar, 20 steps", curve),
        ],
        ..CurvePlot::default()
    }
    .write(&study.folder.join("deflection"))?;
    Ok(())
}
