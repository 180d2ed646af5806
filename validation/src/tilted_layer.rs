//! Soil without cohesion, dry and with water in its pores: a long layer on a rough base is tilted until it slides.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use igimp_assembly::{
    Constraints, Method, ParticleSeed, Particles, PoreSite, PoreState, PoreWater, SharedLaw,
    StepConditions, StepLoads, Water,
};
use igimp_cases::CaseError;
use igimp_figures::{CurvePlot, LineStyle, ReferenceLine, ReferenceValue, Series, SeriesStyle};
use igimp_linear::SolverKind;
use igimp_material::{Elasticity, MohrCoulomb};
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use igimp_shape::{Axis, Grid};
use igimp_solver::{Accepted, Body, MarchReport, MarchSettings, Workspace, march};
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};

/// The book's description of the study.
const ABOUT: &str = "The infinite slope: a layer of dry soil without cohesion, φ = 30°, is tilted between two smooth ends until it slides. It does at tan β = tan φ, once the layer is long enough for its ends not to matter; with water that seeps along it, and with r_u, at tilts that are known as well.";
/// Sliding on planes parallel to the surface.
const INFINITE_SLOPE: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "infinite slope without cohesion",
    locator: "F = tan φ / tan β",
};
/// The same with water.
const WET_SLOPE: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "infinite slope without cohesion, with pore pressure",
    locator: "seepage along it up to m of its depth: tan β = (1 − m γ_w/γ) tan φ; r_u: tan β = (1 − r_u/cos² β) tan φ",
};
/// Unit weight of water \[N/m³\].
const WATER: f64 = 9810.0;
/// Angle of friction and of dilation \[degree\].
const FRICTION: f64 = 30.0;
/// The tilt at the end of the march \[degree\].
const STEEPEST: f64 = 45.0;
/// Depth d of the layer \[m\].
const DEPTH: f64 = 1.0;
/// Unit weight \[N/m³\], as a density of 2000 kg/m³ under 10 m/s².
const UNIT_WEIGHT: f64 = 2e4;
/// Displacement in the middle of the surface at which the layer slides \[m\]: thirty times that of
/// elastic soil.
const SLIDING: f64 = 0.01;
/// Share of the march that raises gravity on the level layer \[-\].
const LEVEL_SHARE: f64 = 0.05;

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("tilted-layer", ABOUT, out)?;
    let mut layers = vec![Layer::new(10, 4), Layer::new(20, 4)];
    if level >= Level::Default {
        layers.extend([Layer::new(40, 4), Layer::new(40, 2)]);
    }
    if level == Level::Full {
        layers.extend([Layer::new(80, 4), Layer::new(20, 8)]);
    }
    wet_layers(&mut study, level);
    let slides: Vec<Slide> = layers
        .par_iter()
        .map(|layer| layer.tilt(&sand(), Pores::Dry))
        .collect();
    let mut table = Table::new(
        "tilt_at_sliding",
        &["L/d_[-]", "cells_over_d", "tan(beta)/tan(phi)_[-]"],
    );
    for (layer, slide) in layers.iter().zip(&slides) {
        let Layer { length, cells } = *layer;
        let name = format!("iGIMP + B-bar, L/d = {length}, h = d/{cells}");
        let run = study.run(RunRecord::new(name, &slide.report, slide.elapsed));
        // Below that the lower end holds the layer.
        if length >= 20 {
            let band = Band::Relative(if length >= 40 { 0.01 } else { 0.02 });
            let exact = INFINITE_SLOPE.says(1.0);
            study.check(
                run,
                "tan β / tan φ at sliding [-]",
                exact,
                band,
                slide.strength,
            );
        }
        table.push(vec![length as f64, cells as f64, slide.strength]);
    }
    table.write_csv(&study.folder)?;
    figure(&study, &layers, &slides)?;
    Ok(study)
}

/// Layers with water that slide.
fn wet_layers(study: &mut Study, level: Level) {
    let mut wet = vec![(Layer::new(40, 4), Pores::Seepage(1.0))];
    if level >= Level::Default {
        wet.extend([0.1, 0.3].map(|ratio| (Layer::new(40, 4), Pores::Ratio(ratio))));
    }
    let slides: Vec<Slide> = wet
        .par_iter()
        .map(|(layer, pores)| layer.tilt(&sand(), *pores))
        .collect();
    for ((layer, pores), slide) in wet.iter().zip(&slides) {
        let Layer { length, cells } = *layer;
        let name = format!("{}, L/d = {length}, h = d/{cells}", pores.label());
        let run = study.run(RunRecord::new(name, &slide.report, slide.elapsed));
        let exact = WET_SLOPE.says(pores.tilt_at_sliding());
        let quantity = "tan β / tan φ at sliding, with water [-]";
        study.check(run, quantity, exact, Band::Relative(0.005), slide.strength);
    }
}

/// Water in the pores of a layer.
#[derive(Clone, Copy, Debug)]
enum Pores {
    Dry,
    /// Along the layer, up to a share of its depth.
    Seepage(f64),
    /// r_u.
    Ratio(f64),
}

impl Pores {
    fn label(self) -> String {
        match self {
            Self::Dry => "dry".to_owned(),
            Self::Seepage(share) => format!("seepage up to {share} d"),
            Self::Ratio(ratio) => format!("r_u = {ratio}"),
        }
    }

    /// tan β / tan φ at which the infinite slope slides \[-\].
    fn tilt_at_sliding(self) -> f64 {
        match self {
            Self::Dry => 1.0,
            Self::Seepage(share) => 1.0 - share * WATER / UNIT_WEIGHT,
            Self::Ratio(ratio) => {
                // 1/cos² β = 1 + t², t = tan β: r μ t² + t − (1 − r) μ = 0.
                let tan = FRICTION.to_radians().tan();
                let [a, c] = [ratio * tan, -(1.0 - ratio) * tan];
                (2.0 * -c / (1.0 + (1.0 - 4.0 * a * c).sqrt())) / tan
            }
        }
    }

    /// The water of a step, at a tilt and a multiple of gravity.
    fn at(self, tilt: f64, gravity: f64) -> Water<2> {
        let (slope, top, factor) = match self {
            Self::Dry => return Water::default(),
            Self::Seepage(share) => (WATER, share * DEPTH, tilt.cos()),
            Self::Ratio(ratio) => (ratio * UNIT_WEIGHT, DEPTH, tilt.cos().recip()),
        };
        Water {
            given: Some(Arc::new(Across { slope, top })),
            factor: factor * gravity,
            stiffness: Vec::new(),
        }
    }
}

/// Pressure that grows across the layer from a level on down.
#[derive(Debug)]
struct Across {
    slope: f64,
    top: f64,
}

impl PoreWater<2> for Across {
    fn at(&self, site: PoreSite<'_, 2>) -> PoreState<2> {
        let depth = self.top - site.x[1];
        if depth <= 0.0 {
            return PoreState::dry();
        }
        PoreState {
            pressure: self.slope * depth,
            reference: self.slope * depth,
            gradient: [0.0, -self.slope],
            ..PoreState::dry()
        }
    }
}

/// Dry soil without cohesion, φ = 30° and a dilation angle \[rad\].
pub(crate) fn dry_sand(dilation_angle: f64) -> MohrCoulomb {
    let elasticity = Elasticity::new(1e8, 0.3).expect("the soil is stiff");
    let phi = FRICTION.to_radians();
    MohrCoulomb::new(elasticity, 0.0, phi, dilation_angle).expect("the soil has friction")
}

/// That with associated flow.
fn sand() -> SharedLaw {
    Arc::new(dry_sand(FRICTION.to_radians()))
}

/// tan β at which a long layer of a law slides \[-\], and the steps to there.
pub(crate) fn slides_at(law: &SharedLaw) -> (f64, RunRecord) {
    let slide = Layer::new(40, 4).tilt(law, Pores::Dry);
    let record = RunRecord::new("tilted layer".to_owned(), &slide.report, slide.elapsed);
    (slide.strength * FRICTION.to_radians().tan(), record)
}

/// A layer of depth d on a grid.
struct Layer {
    /// L/d.
    length: usize,
    /// Cells over the depth.
    cells: usize,
}

/// How a layer slid.
struct Slide {
    /// tan β / tan φ \[-\].
    strength: f64,
    report: MarchReport,
    elapsed: Duration,
}

/// The tilt at a load factor \[rad\].
fn tilt(load_factor: f64) -> f64 {
    let share = ((load_factor - LEVEL_SHARE) / (1.0 - LEVEL_SHARE)).max(0.0);
    share * STEEPEST.to_radians()
}

impl Layer {
    const fn new(length: usize, cells: usize) -> Self {
        Self { length, cells }
    }

    /// Raises gravity on the level layer and tilts it until it slides.
    fn tilt(&self, law: &SharedLaw, pores: Pores) -> Slide {
        let clock = Instant::now();
        let h = DEPTH / self.cells as f64;
        let [columns, rows] = [self.length * self.cells, self.cells];
        let axis = |cells| Axis::uniform(0.0, h, cells).expect("the cells have a size");
        let grid = Grid::new([axis(columns), axis(rows + 1)]);
        let seeds: Vec<ParticleSeed<2>> = (0..4 * columns * rows)
            .map(|k| ParticleSeed {
                x: [k % (2 * columns), k / (2 * columns)].map(|n| (n as f64 + 0.5) * 0.5 * h),
                half_length: [0.25 * h; 2],
                volume: 0.25 * h * h,
                density: 1.0,
                law: 0,
                centroid: [0.0; _],
            })
            .collect();
        let mut body = Body::new(Particles::new(&seeds).expect("the particles have a volume"));
        let mut supports = Constraints::free(&grid);
        for (normal, upper, axis) in [(1, false, 0), (1, false, 1), (0, false, 0), (0, true, 0)] {
            supports
                .fix_wall(&grid, normal, upper, axis)
                .expect("the walls are those of the grid");
        }
        let load_path = |_: f64, to: f64| {
            let weight = UNIT_WEIGHT * (to / LEVEL_SHARE).min(1.0);
            let (sin, cos) = tilt(to).sin_cos();
            StepConditions::new(
                grid.clone(),
                supports.clone(),
                StepLoads::gravity([weight * sin, -weight * cos]),
                vec![law.clone()],
            )?
            .with_water(pores.at(tilt(to), (to / LEVEL_SHARE).min(1.0)))
        };
        let middle = 2 * columns * (2 * rows - 1) + columns;
        // Displacement in the middle and tilt before the last step and after it.
        let mut last = [[0.0; 2]; 2];
        let report = march(
            &mut body,
            &Method::igimp_bbar(),
            &load_path,
            &MarchSettings::steps(100),
            &mut Workspace::new(SolverKind::Auto.build()),
            &mut |accepted: &Accepted<'_, 2>| {
                let [x, y] = accepted.body.particles.displacement[middle];
                last = [last[1], [x.hypot(y), tilt(accepted.state.at)]];
                if last[1][0] > SLIDING {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            },
        );
        let [before, after] = last;
        // Linear in the step in which the displacement is passed; else the last equilibrium.
        let share = ((SLIDING - before[0]) / (after[0] - before[0])).clamp(0.0, 1.0);
        let beta = before[1] + share * (after[1] - before[1]);
        Slide {
            strength: beta.tan() / FRICTION.to_radians().tan(),
            report,
            elapsed: clock.elapsed(),
        }
    }
}

fn figure(study: &Study, layers: &[Layer], slides: &[Slide]) -> Result<(), CaseError> {
    let with = |cells: usize| {
        let pairs = layers.iter().zip(slides);
        let chosen = pairs.filter(|(layer, _)| layer.cells == cells);
        let points = chosen
            .map(|(layer, slide)| [1.0 / layer.length as f64, slide.strength])
            .collect();
        let style = SeriesStyle::LineAndMarkers(LineStyle::Solid);
        Series::new(format!("h = d/{cells}"), points, style)
    };
    CurvePlot {
        title: "Dry layer tilted until it slides".into(),
        x_label: "d / L".into(),
        y_label: "tan β / tan φ".into(),
        x_range: Some((0.0, 0.11)),
        lines: vec![ReferenceLine {
            label: "infinite slope".into(),
            at: ReferenceValue::Y(1.0),
        }],
        series: [4, 2, 8].into_iter().map(with).collect(),
        ..CurvePlot::default()
    }
    .write(&study.folder.join("tilt_at_sliding"))?;
    Ok(())
}
