//! The slope in von Mises soil: smoothness of stress in the four variants, and the limit load.

use std::path::Path;

use igimp_cases::CaseError;
use igimp_figures::{
    ColourMap, CurvePlot, FieldPanel, Outline, OutlineStyle, ReferenceLine, ReferenceValue, Series,
};
use igimp_model::check::Band;
use igimp_model::{Case, Strength};
use igimp_results::measure::{along_line, displacement_norm, oscillation, sigma};
use igimp_results::tables::table::Table;
use igimp_solver::Outcome;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::reference::slope_limit_load_bounds;
use crate::harness::study::{Level, RunRecord, Study};
use crate::pictures::{contours, scaled, with_outlines};
use crate::runs::{Computed, corners, mesh, method, shipped_case, unwatched};

/// The book's description of the study.
const ABOUT: &str = "A 45° slope in undrained soil: smoothness of stress in soft soil that crosses cells, and the collapse load of stiff soil, for the four variants of the method.";
/// How smooth the stresses of each variant are.
const PROGRAM: Oracle = Oracle {
    kind: OracleKind::IndependentProgram,
    source: "independent iGIMP + B-bar program",
    locator: "same slope, mesh and measure, h = 0.5 m, E = 1 MPa",
};
/// The limit load.
pub(crate) const BOUNDS: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "finite-element limit analysis, lower and upper bound",
    locator: "validation/reference/slope_limit_load_bounds.csv; band: bounds ± 2 %",
};
/// Height H of the slope \[m\].
const HEIGHT: f64 = 10.0;
/// Largest displacement at which the load of a stiff slope is read as its limit \[m\].
const LIMIT_DISPLACEMENT: f64 = 0.05;

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("von-mises-slope", ABOUT, out)?;
    smoothness(&mut study)?;
    limit_load(&mut study, level)?;
    Ok(study)
}

/// γ and c_u of the soil.
fn soil(case: &Case<2>) -> (f64, f64) {
    let material = &case.materials[0];
    match material.strength {
        Strength::VonMises { undrained_strength } => (material.unit_weight, undrained_strength),
        _ => (material.unit_weight, f64::NAN),
    }
}

/// Soft soil that moves by more than a cell: locking and cell crossing both show.
fn smoothness(study: &mut Study) -> Result<(), CaseError> {
    let shared = vec!["grid.locking=shared-strain".to_owned()];
    let results = [
        method("linear", false),
        method("linear", true),
        method("gimp", false),
        method("gimp", true),
        shared,
    ]
    .into_par_iter()
    .map(|overrides| Computed::new(shipped_case("von_mises_slope", overrides)?))
    .collect::<Result<Vec<_>, _>>()?;
    let mut runs = Vec::new();
    let mut scores = Vec::new();
    for result in &results {
        let variant = format!("{}, h = 0.5 m, E = 1 MPa", result.method());
        runs.push(study.run_to_end(RunRecord::new(variant, &result.report, result.elapsed)));
        scores.push(roughness(result));
    }
    let quantity = "oscillation of σ_yy / (γH) [-]";
    study.check(
        runs[3],
        quantity,
        PROGRAM.says(0.013),
        Band::AtMost(0.016),
        scores[3],
    );
    study.check(
        runs[4],
        quantity,
        PROGRAM.says(0.013),
        Band::AtMost(0.0095),
        scores[4],
    );
    for k in 0..3 {
        let expected = [0.135, 0.091, 0.062][k];
        // At least four times that of iGIMP + B-bar.
        let band = Band::AtLeast(4.0 * scores[3]);
        study.control(runs[k], quantity, PROGRAM.says(expected), band, scores[k]);
    }
    for (name, &run) in ["impm", "impm_bbar", "igimp", "igimp_bbar"]
        .iter()
        .zip(&runs)
    {
        study.newton(name, run)?;
    }
    smoothness_figures(study, &results[..4])
}

/// Root mean square of the deviation of σ_yy from local planes of radius 1.3 h, over γH \[-\].
fn roughness(result: &Computed<2>) -> f64 {
    let particles = result.particles();
    let radius = 1.3 * result.case.grid.smallest_cell()[0];
    let scale = soil(&result.case).0 * HEIGHT;
    oscillation(&particles.x, &sigma(particles, 1, 1), radius) / scale
}

fn smoothness_figures(study: &mut Study, results: &[Computed<2>]) -> Result<(), CaseError> {
    let compression = |result: &Computed<2>| scaled(&sigma(result.particles(), 1, 1), -1e-3);
    let sections = &results[0].case.sections;
    let outlines: Vec<Outline> = sections
        .iter()
        .map(|section| Outline {
            points: vec![section.from, section.to],
            style: OutlineStyle::Section,
        })
        .collect();
    let panel = |label: &str, map: ColourMap, range, values: &dyn Fn(&Computed<2>) -> Vec<f64>| {
        FieldPanel {
            title: "Slope in von Mises soil, c_{u} = 45 kPa, E = 1 MPa".into(),
            columns: 2,
            plots: results
                .iter()
                .map(|result| {
                    let (title, values) = (result.method(), values(result));
                    let plot = contours(title, result.particles(), values, label, map, range);
                    with_outlines(plot, outlines.clone())
                })
                .collect(),
        }
    };
    panel(
        "vertical stress −σ_{yy} [kPa], compression positive",
        ColourMap::Sequential,
        Some((0.0, 320.0)),
        &compression,
    )
    .write(&study.folder.join("sigma_yy"))?;
    panel("displacement [m]", ColourMap::Sequential, None, &|result| {
        displacement_norm(result.particles())
    })
    .write(&study.folder.join("displacement"))?;

    for section in sections {
        let label = match &*section.name {
            "A-A" => "x along A–A (y = 6 m) [m]",
            _ => "y along B–B (x = 18 m) [m]",
        };
        let name = format!("section_{}", section.name);
        let mut series = Vec::new();
        for result in results {
            let points = along_line(
                result.particles(),
                &compression(result),
                section.from,
                section.to,
                section.points,
                result.case.grid.smallest_cell()[0],
            );
            let mut table = Table::new(
                format!("{name}_{}", slug(&result.method())),
                &["distance_[m]", "-sigma_yy_[kPa]_compression_+"],
            );
            for point in &points {
                table.push(point.to_vec());
            }
            study.table(table)?;
            series.push(Series::line(result.method(), points));
        }
        CurvePlot {
            title: "Slope in von Mises soil".into(),
            x_label: label.into(),
            y_label: "−σ_{yy} [kPa], compression positive".into(),
            series,
            ..CurvePlot::default()
        }
        .write(&study.folder.join(&name))?;
    }
    Ok(())
}

/// One march to collapse.
pub(crate) struct Collapse {
    /// Depth of the base below the crest over the height \[-\].
    pub(crate) depth_factor: f64,
    /// Whether volumetric locking is controlled.
    pub(crate) bbar: bool,
    /// Size of the cells \[m\].
    pub(crate) cell: f64,
}

/// Stiff soil, gravity raised to collapse, with the base at toe level and at twice the height.
fn limit_load(study: &mut Study, level: Level) -> Result<(), CaseError> {
    let collapse = |depth_factor, bbar, cell| Collapse {
        depth_factor,
        bbar,
        cell,
    };
    let mut list = vec![
        collapse(1.0, false, 0.5),
        collapse(2.0, true, 1.0),
        collapse(2.0, false, 1.0),
    ];
    if level >= Level::Default {
        list.extend([collapse(1.0, true, 0.25), collapse(2.0, true, 0.5)]);
    }
    if level == Level::Full {
        list.extend([collapse(1.0, true, 0.5), collapse(2.0, true, 0.25)]);
    }
    let marches = list
        .par_iter()
        .map(|collapse| Computed::new(slope_to_collapse(collapse)?))
        .collect::<Result<Vec<_>, _>>()?;

    let mut series = Vec::new();
    for (collapse, result) in list.iter().zip(&marches) {
        let (depth, h) = (collapse.depth_factor, collapse.cell);
        let label = result.method();
        let variant = format!("{label}, D = {depth}, h = {h} m, E/c_u = 2222");
        let run = study.run(RunRecord::new(variant, &result.report, result.elapsed));
        let [lower, upper] = bounds(depth);
        let measured = limit(result).unwrap_or(f64::INFINITY);
        let middle = 0.5 * (lower + upper);
        let (quantity, expected) = ("γH/c_u at collapse [-]", BOUNDS.says(middle));
        if collapse.bbar {
            let band = Band::Between(0.98 * lower, 1.02 * upper);
            study.check(run, quantity, expected, band, measured);
        } else {
            let band = Band::AtLeast(1.02 * upper);
            study.control(run, quantity, expected, band, measured);
        }
        let mut table = Table::new(
            format!("limit_{}_D{depth}_h{h}", slug(&label)),
            &["gamma_H/c_u_[-]", "largest_displacement_[m]"],
        );
        for row in stability_numbers(result) {
            table.push(vec![row[1], row[0]]);
        }
        series.push(Series::line(
            format!("{label}, D = {depth}, h = {h} m"),
            stability_numbers(result),
        ));
        study.table(table)?;
    }
    CurvePlot {
        title: "Stiff slope in von Mises soil, gravity raised to collapse".into(),
        x_label: "largest displacement [m]".into(),
        y_label: "γH/c_{u}".into(),
        x_range: Some((0.0, 0.1)),
        lines: [1.0, 2.0]
            .iter()
            .map(|&depth| ReferenceLine {
                label: format!("upper bound, D = {depth}"),
                at: ReferenceValue::Y(bounds(depth)[1]),
            })
            .collect(),
        series,
        ..CurvePlot::default()
    }
    .write(&study.folder.join("limit_load"))?;
    Ok(())
}

/// Lower and upper bound of γH/c_u at collapse; not a number for a depth factor that has none \[-\].
pub(crate) fn bounds(depth_factor: f64) -> [f64; 2] {
    let bounds = slope_limit_load_bounds();
    ["lower", "upper"].map(|side| {
        let points = bounds.points("depth_factor", side);
        let found = points.iter().find(|p| (p[0] - depth_factor).abs() < 1e-9);
        found.map_or(f64::NAN, |p| p[1])
    })
}

/// The shipped slope of stiff soil on another foundation, with gravity raised until it flows.
pub(crate) fn slope_to_collapse(collapse: &Collapse) -> Result<Case<2>, CaseError> {
    let foundation = HEIGHT * (collapse.depth_factor - 1.0);
    let beyond = if foundation > 0.0 { 20.0 } else { 15.0 };
    let (crest, toe, width) = (beyond, beyond + HEIGHT, HEIGHT + 2.0 * beyond);
    let top = foundation + HEIGHT;
    let mut polygon = vec![[0.0, 0.0], [toe, foundation], [crest, top], [0.0, top]];
    if foundation > 0.0 {
        polygon.splice(1..1, [[width, 0.0], [width, foundation]]);
    }
    let mut overrides = mesh(collapse.cell, [width, top + collapse.cell]);
    overrides.extend(method("gimp", collapse.bbar));
    overrides.extend(unwatched());
    overrides.push(format!("bodies.slope.polygon={}", corners(&polygon)));
    overrides.push("materials.clay.young=\"100 MPa\"".to_owned());
    overrides.push("stages.own weight.factor=1.6".to_owned());
    overrides.push("stages.own weight.steps=64".to_owned());
    let stop = 2.0 * LIMIT_DISPLACEMENT;
    overrides.push(format!(
        "stages.own weight.stop_when={{ displacement = \"{stop} m\", no_equilibrium = true }}"
    ));
    shipped_case("von_mises_slope", overrides)
}

/// Largest displacement \[m\] and γH/c_u \[-\], step by step.
fn stability_numbers(result: &Computed<2>) -> Vec<[f64; 2]> {
    let (unit_weight, undrained_strength) = soil(&result.case);
    let curve = result.curve("load-displacement").points(0, 1);
    curve
        .into_iter()
        .map(|[displacement, factor]| {
            [
                displacement,
                factor * unit_weight * HEIGHT / undrained_strength,
            ]
        })
        .collect()
}

/// γH/c_u at which the largest displacement reaches [`LIMIT_DISPLACEMENT`], linear between steps
/// \[-\]. Where the march ended before that for want of equilibrium it is the last one reached;
/// `None` when the slope was still standing at the end of the march.
pub(crate) fn limit(result: &Computed<2>) -> Option<f64> {
    let points = stability_numbers(result);
    let mut pairs = points.windows(2);
    match (
        pairs.find(|pair| LIMIT_DISPLACEMENT <= pair[1][0]),
        &result.report.outcome,
    ) {
        (Some(pair), _) => {
            let t = (LIMIT_DISPLACEMENT - pair[0][0]) / (pair[1][0] - pair[0][0]);
            Some(pair[0][1] + t * (pair[1][1] - pair[0][1]))
        }
        (None, Outcome::StepTooSmall { .. }) => points.last().map(|point| point[1]),
        (None, _) => None,
    }
}

/// A method's label as part of a file name.
pub(crate) fn slug(label: &str) -> String {
    label.to_lowercase().replace(" + ", "_").replace('-', "")
}
