//! The slope in von Mises soil: smoothness of stress in the four variants, and the limit load.

use std::path::Path;

use igimp_assembly::Method;
use igimp_cases::CaseError;
use igimp_cases::check::Band;
use igimp_cases::figures::{
    ColourMap, CurvePlot, FieldPanel, Outline, OutlineStyle, ReferenceLine, ReferenceValue, Series,
};
use igimp_cases::measure::{along_line, displacement_norm, sigma};
use igimp_cases::slope::SlopeGeometry;
use igimp_cases::table::Table;
use igimp_cases::von_mises_slope::{SlopeResult, VonMisesSlope};
use rayon::prelude::*;

use crate::pictures::{contours, scaled, with_outlines};
use crate::reference::slope_limit_load_bounds;
use crate::study::{Level, Run, Study, timed};

/// Section A–A: a level line through the body of the slope \[m\].
const SECTION_LEVEL: ([f64; 2], [f64; 2]) = ([0.0, 6.0], [24.0, 6.0]);
/// Section B–B: an upright line below the middle of the slope \[m\].
const SECTION_UPRIGHT: ([f64; 2], [f64; 2]) = ([18.0, 0.0], [18.0, 12.0]);
/// Largest displacement at which the load of a stiff slope is read as its limit \[m\].
const LIMIT_DISPLACEMENT: f64 = 0.05;

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("von-mises-slope", out)?;
    smoothness(&mut study)?;
    limit_load(&mut study, level)?;
    Ok(study)
}

fn methods() -> [Method; 4] {
    [
        Method::impm(),
        Method::impm_bbar(),
        Method::igimp(),
        Method::igimp_bbar(),
    ]
}

/// Soft soil that moves by more than a cell: locking and cell crossing both show.
fn smoothness(study: &mut Study) -> Result<(), CaseError> {
    let cases = methods().map(|method| VonMisesSlope {
        method,
        ..VonMisesSlope::default()
    });
    let results = cases
        .par_iter()
        .map(|case| timed(|| case.run()))
        .collect::<Result<Vec<_>, _>>()?;
    let mut runs = Vec::new();
    let mut scores = Vec::new();
    for (case, (result, elapsed)) in cases.iter().zip(&results) {
        let variant = format!("{}, h = 0.5 m, E = 1 MPa", case.method.label());
        runs.push(study.run_to_end(Run::new(variant, &result.report, *elapsed)));
        scores.push(case.oscillation(&result.particles));
    }
    let quantity = "oscillation of σ_yy / (γH) [-]";
    let source = "independent program (0.013)";
    study.check(
        runs[3],
        quantity,
        (0.013, source),
        Band::AtMost(0.016),
        scores[3],
    );
    for k in 0..3 {
        let expected = [0.135, 0.091, 0.062][k];
        let source = "independent program; at least 4 × that of iGIMP + B-bar";
        let band = Band::AtLeast(4.0 * scores[3]);
        study.check(runs[k], quantity, (expected, source), band, scores[k]);
    }
    for (name, &run) in ["impm", "impm_bbar", "igimp", "igimp_bbar"]
        .iter()
        .zip(&runs)
    {
        study.newton(name, run)?;
    }
    smoothness_figures(
        study,
        &cases,
        &results.iter().map(|(result, _)| result).collect::<Vec<_>>(),
    )
}

fn smoothness_figures(
    study: &mut Study,
    cases: &[VonMisesSlope],
    results: &[&SlopeResult],
) -> Result<(), CaseError> {
    let compression = |result: &SlopeResult| scaled(&sigma(&result.particles, 1, 1), -1e-3);
    let section = |line: ([f64; 2], [f64; 2])| Outline {
        points: vec![line.0, line.1],
        style: OutlineStyle::Section,
    };
    let panel = |label: &str, map: ColourMap, range, values: &dyn Fn(&SlopeResult) -> Vec<f64>| {
        FieldPanel {
            title: "Slope in von Mises soil, c_{u} = 45 kPa, E = 1 MPa".into(),
            columns: 2,
            plots: cases
                .iter()
                .zip(results)
                .map(|(case, result)| {
                    let title = case.method.label();
                    let values = values(result);
                    let plot = contours(title, &result.particles, values, label, map, range);
                    with_outlines(plot, vec![section(SECTION_LEVEL), section(SECTION_UPRIGHT)])
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
        displacement_norm(&result.particles)
    })
    .write(&study.folder.join("displacement"))?;

    for (name, line, label) in [
        ("section_A-A", SECTION_LEVEL, "x along A–A (y = 6 m) [m]"),
        ("section_B-B", SECTION_UPRIGHT, "y along B–B (x = 18 m) [m]"),
    ] {
        let mut series = Vec::new();
        for (case, result) in cases.iter().zip(results) {
            let points = along_line(
                &result.particles,
                &compression(result),
                line,
                120,
                case.cell,
            );
            let mut table = Table::new(
                format!("{name}_{}", slug(&case.method.label())),
                &["distance_[m]", "-sigma_yy_[kPa]_compression_+"],
            );
            for point in &points {
                table.push(point.to_vec());
            }
            study.table(table)?;
            series.push(Series::line(case.method.label(), points));
        }
        CurvePlot {
            title: "Slope in von Mises soil".into(),
            x_label: label.into(),
            y_label: "−σ_{yy} [kPa], compression positive".into(),
            series,
            ..CurvePlot::default()
        }
        .write(&study.folder.join(name))?;
    }
    Ok(())
}

/// One march to collapse.
struct Collapse {
    depth_factor: f64,
    bbar: bool,
    cell: f64,
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
        .map(|collapse| {
            let case = slope_to_collapse(collapse);
            timed(|| case.run()).map(|(result, elapsed)| (case, result, elapsed))
        })
        .collect::<Result<Vec<_>, _>>()?;

    let bounds = slope_limit_load_bounds();
    let (lower, upper) = (
        bounds.points("depth_factor", "lower"),
        bounds.points("depth_factor", "upper"),
    );
    let bound = |points: &[[f64; 2]], depth_factor: f64| {
        points
            .iter()
            .find(|p| (p[0] - depth_factor).abs() < 1e-9)
            .map_or(f64::NAN, |p| p[1])
    };
    let mut series = Vec::new();
    for (collapse, (case, result, elapsed)) in list.iter().zip(&marches) {
        let (depth, h) = (collapse.depth_factor, collapse.cell);
        let variant = format!(
            "{}, D = {depth}, h = {h} m, E/c_u = 2222",
            case.method.label()
        );
        let run = study.run(Run::new(variant, &result.report, *elapsed));
        let (lower, upper) = (bound(&lower, depth), bound(&upper, depth));
        let measured = result
            .load_factor_at(LIMIT_DISPLACEMENT)
            .map_or(f64::INFINITY, |factor| case.stability_number(factor));
        let middle = 0.5 * (lower + upper);
        if collapse.bbar {
            let source = "limit analysis bounds, widened by 2 %";
            let band = Band::Between(0.98 * lower, 1.02 * upper);
            study.check(
                run,
                "γH/c_u at collapse [-]",
                (middle, source),
                band,
                measured,
            );
        } else {
            let source = "above the upper bound and 2 %: without B-bar it locks";
            let band = Band::AtLeast(1.02 * upper);
            study.check(
                run,
                "γH/c_u at collapse [-]",
                (middle, source),
                band,
                measured,
            );
        }
        let mut table = Table::new(
            format!("limit_{}_D{depth}_h{h}", slug(&case.method.label())),
            &["gamma_H/c_u_[-]", "largest_displacement_[m]"],
        );
        for row in &result.displacement.rows {
            table.push(vec![case.stability_number(row[0]), row[1]]);
        }
        let points = table.rows.iter().map(|row| [row[1], row[0]]).collect();
        series.push(Series::line(
            format!("{}, D = {depth}, h = {h} m", case.method.label()),
            points,
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
                at: ReferenceValue::Y(bound(&upper, depth)),
            })
            .collect(),
        series,
        ..CurvePlot::default()
    }
    .write(&study.folder.join("limit_load"))?;
    Ok(())
}

fn slope_to_collapse(collapse: &Collapse) -> VonMisesSlope {
    let foundation = 10.0 * (collapse.depth_factor - 1.0);
    let beyond = if foundation > 0.0 { 20.0 } else { 15.0 };
    VonMisesSlope {
        method: if collapse.bbar {
            Method::igimp_bbar()
        } else {
            Method::igimp()
        },
        geometry: SlopeGeometry {
            height: 10.0,
            run: 10.0,
            crest: beyond,
            toe: beyond,
            foundation,
        },
        cell: collapse.cell,
        young: 1e8,
        load_factor: 1.6,
        steps: 64,
        largest_displacement: 2.0 * LIMIT_DISPLACEMENT,
        ..VonMisesSlope::default()
    }
}

/// A method's label as part of a file name.
pub(crate) fn slug(label: &str) -> String {
    label.to_lowercase().replace(" + ", "_").replace('-', "")
}
