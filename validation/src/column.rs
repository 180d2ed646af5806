//! The column: stress against the exact solution, and convergence under refinement.

use std::path::Path;

use igimp_cases::{CaseError, exact};
use igimp_figures::{Colour, CurvePlot, LineStyle, Scale, Series, SeriesStyle};
use igimp_model::Case;
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::reference::column_stress_error;
use crate::harness::study::{RunRecord, Study};
use crate::runs::{Computed, corners, mesh, method, shipped_case, unwatched};

/// The book's description of the study.
const ABOUT: &str = "A column of soft soil one cell wide settles under its own weight. Mean stress error against the exact solution, under refinement: iGIMP converges with second order, iMPM does not.";
/// Initial height of the column \[m\].
pub(crate) const HEIGHT: f64 = 50.0;
/// The stress errors.
const TABLE: Oracle = Oracle {
    kind: OracleKind::IndependentProgram,
    source: "independent iGIMP program, set-up of Charlton et al. 2017",
    locator: "validation/reference/column_stress_error.csv",
};
/// The height.
pub(crate) const HENCKY_COLUMN: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Hencky column under its own weight",
    locator: "Lambert's W, `igimp_cases::exact::Column`",
};

/// Runs the study; it is short enough to be the same at every level.
pub(crate) fn study(out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("column", ABOUT, out)?;
    let meshes = [4, 8, 16, 32, 64, 128, 256];
    let soft = Series1D::run(&mut study, "10 kPa", &meshes)?;
    let stiff = Series1D::run(&mut study, "1 MPa", &meshes[2..])?;
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
                TABLE.says(error),
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
        study.control(
            *run,
            quantity,
            TABLE.says(expected),
            band,
            result.stress_error,
        );
    }
    for (cells, result, run) in stiff.of(0) {
        if *cells >= 16 {
            let band = Band::Between(0.03, 0.045);
            let quantity = "stress error, must not converge [-]";
            study.control(*run, quantity, TABLE.says(0.04), band, result.stress_error);
        }
    }
    for series in [&soft, &stiff] {
        let (_, finest, run) = series.of(2).last().expect("a series has meshes");
        study.check(
            *run,
            "height of the column [m]",
            HENCKY_COLUMN.says(finest.exact_top),
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

/// The column in equilibrium under its full weight, or as far as it came.
pub(crate) struct ColumnResult {
    /// Σ|σ_yy − σ_exact| V_0 / (ρ₀ g l₀ ΣV_0) \[-\].
    pub(crate) stress_error: f64,
    /// Height of the column, to the top edge of the highest particle \[m\].
    pub(crate) top: f64,
    /// Exact height \[m\].
    pub(crate) exact_top: f64,
    /// Initial height, position, σ_yy and its exact value by particle, bottom to top.
    stress: Table,
}

impl ColumnResult {
    /// Reads it off the end of a run.
    pub(crate) fn new(computed: &Computed<2>) -> Self {
        let exact = exact_solution(&computed.case);
        let particles = computed.particles();
        let header = [
            "initial_height_[m]",
            "height_[m]",
            "sigma_yy_[Pa]_tension_+",
            "exact_[Pa]_tension_+",
        ];
        let mut stress = Table::new("stress", &header);
        let mut top = 0.0_f64;
        // Particles are seeded row by row, from the bottom to the top.
        for particle in 0..particles.len() {
            let y = particles.x[particle][1];
            let y0 = y - particles.displacement[particle][1];
            let sigma = particles.sigma[particle][1][1];
            top = top.max(y + particles.half_length[particle][1]);
            stress.push(vec![y0, y, sigma, exact.sigma_yy(y0)]);
        }
        Self {
            stress_error: exact.stress_error(particles),
            top,
            exact_top: exact.position(HEIGHT),
            stress,
        }
    }
}

fn exact_solution(case: &Case<2>) -> exact::Column {
    let material = &case.materials[0];
    exact::Column {
        height: HEIGHT,
        density: material.unit_weight / case.gravity,
        gravity: case.gravity,
        young: material.young,
    }
}

/// The shipped column of so many cells, in a variant of the method.
pub(crate) fn case(
    cells: usize,
    young: &str,
    (basis, bbar): (&str, bool),
) -> Result<Case<2>, CaseError> {
    let h = HEIGHT / cells as f64;
    let mut overrides = mesh(h, [h, HEIGHT + h]);
    overrides.extend(method(basis, bbar));
    overrides.push(format!("materials.soft.young=\"{young}\""));
    let polygon = [[0.0, 0.0], [h, 0.0], [h, HEIGHT], [0.0, HEIGHT]];
    overrides.push(format!("bodies.column.polygon={}", corners(&polygon)));
    overrides.extend(unwatched());
    shipped_case("column", overrides)
}

/// Results of one stiffness: by method, then by mesh, with the index of the run.
struct Series1D {
    label: &'static str,
    slug: String,
    methods: Vec<Vec<(usize, ColumnResult, usize)>>,
}

impl Series1D {
    fn run(study: &mut Study, label: &'static str, meshes: &[usize]) -> Result<Self, CaseError> {
        let methods = [("linear", false), ("gimp", false), ("gimp", true)];
        let jobs: Vec<_> = methods
            .iter()
            .flat_map(|&method| meshes.iter().map(move |&cells| (method, cells)))
            .collect();
        let results = jobs
            .par_iter()
            .map(|&(method, cells)| {
                let computed = Computed::new(case(cells, label, method)?)?;
                let variant = format!("{}, {cells} cells, E = {label}", computed.method());
                let run = RunRecord::new(variant, &computed.report, computed.elapsed);
                Ok((ColumnResult::new(&computed), run))
            })
            .collect::<Result<Vec<_>, CaseError>>()?;
        let mut by_method = vec![Vec::new(), Vec::new(), Vec::new()];
        for (k, ((_, cells), (result, run))) in jobs.into_iter().zip(results).enumerate() {
            let run = study.run_to_end(run);
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
        convergence(study, series)?;
        stress(study, series)?;
    }
    Ok(())
}

/// Error of stress against cells over the height.
fn convergence(study: &mut Study, series: &Series1D) -> Result<(), CaseError> {
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
    study.table(convergence)
}

/// Stress along the column.
fn stress(study: &mut Study, series: &Series1D) -> Result<(), CaseError> {
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
    Ok(())
}

fn with_markers(label: &str, points: Vec<[f64; 2]>) -> Series {
    Series::new(label, points, SeriesStyle::LineAndMarkers(LineStyle::Solid))
}
