//! The column: stress against the exact solution, and convergence under refinement.

use std::path::Path;

use igimp_assembly::Method;
use igimp_cases::CaseError;
use igimp_cases::check::Band;
use igimp_cases::column::{Column, ColumnResult, without_dropping};
use igimp_cases::figures::{Colour, CurvePlot, LineStyle, Scale, Series, SeriesStyle};
use igimp_cases::table::Table;
use rayon::prelude::*;

use crate::reference::column_stress_error;
use crate::study::{Run, Study, timed};

/// Source of the table of stress errors.
const TABLE: &str = "independent program, after Charlton et al. 2017";

/// Runs the study; it is short enough to be the same at every level.
pub(crate) fn study(out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("column", out)?;
    let meshes = [4, 8, 16, 32, 64, 128, 256];
    let soft = Series1D::run(&mut study, 10e3, "10 kPa", &meshes)?;
    let stiff = Series1D::run(&mut study, 1e6, "1 MPa", &meshes[2..])?;
    let reference = column_stress_error();

    for (series, name) in [(&soft, "gimp_10kPa"), (&stiff, "gimp_1MPa")] {
        let expected = reference.points("cells", name);
        for (cells, result, run) in series.of(2) {
            let Some(&[_, error]) = expected.iter().find(|p| p[0] as usize == *cells) else {
                continue;
            };
            let share = if series.label == "10 kPa" && *cells == 64 {
                0.02
            } else {
                0.03
            };
            let band = Band::Relative(share);
            study.check(
                *run,
                "stress error [-]",
                (error, TABLE),
                band,
                result.stress_error,
            );
        }
    }
    let mpm = reference.points("cells", "mpm_10kPa");
    for (cells, result, run) in soft.of(0) {
        let expected = mpm
            .iter()
            .find(|p| p[0] as usize == *cells)
            .map_or(f64::NAN, |p| p[1]);
        let band = Band::Between(0.05, 0.11);
        let quantity = "stress error, must not converge [-]";
        study.check(*run, quantity, (expected, TABLE), band, result.stress_error);
    }
    for (cells, result, run) in stiff.of(0) {
        if *cells >= 16 {
            let band = Band::Between(0.03, 0.045);
            let quantity = "stress error, must not converge [-]";
            study.check(*run, quantity, (0.04, TABLE), band, result.stress_error);
        }
    }
    for series in [&soft, &stiff] {
        let (_, finest, run) = series.of(2).last().expect("a series has meshes");
        let height = finest.exact_top;
        study.check(
            *run,
            "height of the column [m]",
            (height, "exact: Lambert's W"),
            Band::Relative(1e-3),
            finest.top,
        );
        let name = format!(
            "{}_cells_{}",
            series.of(2).last().map_or(0, |m| m.0),
            series.slug
        );
        study.newton(&name, *run)?;
    }
    tables_and_figures(&mut study, &[&soft, &stiff])?;
    Ok(study)
}

/// Results of one stiffness: by method, then by mesh, with the index of the run.
struct Series1D {
    label: &'static str,
    slug: String,
    methods: Vec<Vec<(usize, ColumnResult, usize)>>,
}

impl Series1D {
    fn run(
        study: &mut Study,
        young: f64,
        label: &'static str,
        meshes: &[usize],
    ) -> Result<Self, CaseError> {
        let methods = [Method::impm(), Method::igimp(), Method::igimp_bbar()].map(without_dropping);
        let jobs: Vec<(Method, usize)> = methods
            .iter()
            .flat_map(|method| meshes.iter().map(move |&cells| (method.clone(), cells)))
            .collect();
        let results = jobs
            .par_iter()
            .map(|(method, cells)| {
                let case = Column {
                    method: method.clone(),
                    cells: *cells,
                    young,
                    ..Column::default()
                };
                timed(|| case.run())
            })
            .collect::<Result<Vec<_>, _>>()?;
        let mut by_method = vec![Vec::new(), Vec::new(), Vec::new()];
        for (k, ((method, cells), (result, elapsed))) in jobs.into_iter().zip(results).enumerate() {
            let variant = format!("{}, {cells} cells, E = {label}", method.label());
            let run = study.run_to_end(Run::new(variant, &result.report, elapsed));
            by_method[k / meshes.len()].push((cells, result, run));
        }
        Ok(Self {
            label,
            slug: label.replace(' ', ""),
            methods: by_method,
        })
    }

    /// Results of a method: 0 iMPM, 1 iGIMP, 2 iGIMP + B-bar.
    fn of(&self, method: usize) -> &[(usize, ColumnResult, usize)] {
        &self.methods[method]
    }
}

fn tables_and_figures(study: &mut Study, all: &[&Series1D]) -> Result<(), CaseError> {
    for series in all {
        let mut convergence = Table::new(
            format!("convergence_{}", series.slug),
            &[
                "cells",
                "iMPM_error_[-]",
                "iGIMP_error_[-]",
                "iGIMP+B-bar_error_[-]",
            ],
        );
        for k in 0..series.of(0).len() {
            let error = |method: usize| series.of(method)[k].1.stress_error;
            convergence.push(vec![series.of(0)[k].0 as f64, error(0), error(1), error(2)]);
        }
        let curve = |method: usize| convergence.points(0, method + 1);
        let first = curve(2)[0];
        let slope = |order: i32| -> Vec<[f64; 2]> {
            [1.0, 16.0]
                .map(|k: f64| [first[0] * k, 0.6 * first[1] / k.powi(order)])
                .to_vec()
        };
        CurvePlot {
            title: format!("Column under self-weight, E = {}", series.label),
            x_label: "cells over the height".into(),
            y_label: "mean stress error / (ρ_{0} g l_{0})".into(),
            x_scale: Scale::Log,
            y_scale: Scale::Log,
            series: vec![
                with_markers("iMPM", curve(0)),
                with_markers("iGIMP", curve(1)),
                with_markers("iGIMP + B-bar", curve(2)),
                Series::new(
                    "second order",
                    slope(2),
                    SeriesStyle::Line(LineStyle::Dashed),
                )
                .in_colour(Colour::BLACK),
            ],
            ..CurvePlot::default()
        }
        .write(&study.folder.join(format!("convergence_{}", series.slug)))?;
        study.table(convergence)?;

        let shown = series
            .of(0)
            .iter()
            .position(|(cells, ..)| *cells == 64)
            .unwrap_or(0);
        let mut lines = vec![];
        for method in [0, 2] {
            let (cells, result, _) = &series.of(method)[shown];
            let label = ["iMPM", "iGIMP", "iGIMP + B-bar"][method];
            let mut table = result.stress.clone();
            table.name = format!(
                "stress_{}_{cells}_cells_{}",
                ["impm", "igimp", "igimp_bbar"][method],
                series.slug
            );
            let points = result
                .stress
                .rows
                .iter()
                .map(|row| [-row[2] / 1e3, row[0]])
                .collect();
            lines.push(Series::markers(format!("{label}, {cells} cells"), points));
            study.table(table)?;
        }
        let exact = series.of(2)[shown]
            .1
            .stress
            .rows
            .iter()
            .map(|row| [-row[3] / 1e3, row[0]])
            .collect();
        lines.push(Series::line("exact", exact).in_colour(Colour::BLACK));
        CurvePlot {
            title: format!("Stress along the column, E = {}", series.label),
            x_label: "vertical stress −σ_{yy} [kPa], compression positive".into(),
            y_label: "initial height Y [m]".into(),
            series: lines,
            ..CurvePlot::default()
        }
        .write(&study.folder.join(format!("stress_{}", series.slug)))?;
    }
    Ok(())
}

fn with_markers(label: &str, points: Vec<[f64; 2]>) -> Series {
    Series::new(label, points, SeriesStyle::LineAndMarkers(LineStyle::Solid))
}
