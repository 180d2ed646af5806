//! A prism between smooth platens, pressed to half its height.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{Constraints, Method, Particles, SharedLaw, StepConditions, StepLoads};
use igimp_cases::CaseError;
use igimp_geometry::seed::fill_polygon;
use igimp_material::{Elasticity, Tresca};
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use igimp_shape::{Axis, Grid};
use igimp_solver::{Accepted, Body, MarchSettings};

use crate::continuum::laboratory::run;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{RunRecord, Study};

/// The book's description of the study.
const ABOUT: &str = "A prism of nearly incompressible Tresca soil is pressed between smooth platens to half its height. The force is 2 s_u times the width that incompressibility gives, with every variant of the method: the state is uniform.";
/// The force.
const HOMOGENEOUS: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "uniform compression in plane strain",
    locator: "2 s_u times the current width w₀ h₀/h",
};
/// Steps of a run.
const STEPS: usize = 20;
/// Presses half a prism of unit height and half-width.
fn press(cells: usize, method: &Method) -> Result<(RunRecord, Table), CaseError> {
    let h = 1.0 / cells as f64;
    let height = |factor: f64| 1.0 - 0.5 * factor;
    let grid_at = |height: f64| -> Result<Grid<2>, igimp_shape::ShapeError> {
        Ok(Grid::new([
            Axis::uniform(0.0, h, 2 * cells + 2)?,
            Axis::uniform(0.0, height / cells as f64, cells)?,
        ]))
    };
    let polygon = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mut body = Body::new(Particles::new(&fill_polygon(
        &grid_at(1.0)?,
        &polygon,
        2,
        1.0,
        0,
    )?)?);
    let law: SharedLaw = Arc::new(Tresca::new(Elasticity::new(1000.0, 0.4999)?, 1.0)?);
    let load_path = |from: f64, to: f64| {
        let grid = grid_at(height(from)).expect("the prism has a height");
        let mut constraints = Constraints::free(&grid);
        constraints.fix_wall(&grid, 0, false, 0)?;
        constraints.fix_wall(&grid, 1, false, 1)?;
        for column in 0..grid.axes[0].node_count() {
            let node = grid.node_index([column, cells]);
            constraints.prescribe(node, 1, height(to) - height(from))?;
        }
        StepConditions::new(
            grid,
            constraints,
            StepLoads::gravity([0.0; 2]),
            vec![Arc::clone(&law)],
        )
    };
    let mut curve = Table::new("force", &["height_[-]", "force_[s_u]", "exact_[s_u]"]);
    let mut observe = |accepted: &Accepted<'_, 2>| {
        let grid = &accepted.conditions.grid;
        let force: f64 = (0..grid.axes[0].node_count())
            .map(|column| -accepted.forces.reactions[grid.node_index([column, cells])][1])
            .sum();
        let now = height(accepted.report.to);
        curve.push(vec![now, force, 2.0 / now]);
        ControlFlow::Continue(())
    };
    let variant = format!("{}, {cells} cells", method.label());
    let settings = MarchSettings::steps(STEPS);
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

/// Runs the study; it is short enough to be the same at every level.
pub(crate) fn study(out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("prism", ABOUT, out)?;
    for method in [
        Method::impm(),
        Method::impm_bbar(),
        Method::igimp(),
        Method::igimp_bbar(),
        Method::shared_strain(),
    ] {
        let (run, curve) = press(8, &method)?;
        let run = study.run_to_end(run);
        for height in [0.9, 0.7, 0.5] {
            let rows = curve.rows.iter();
            let found = rows.min_by(|a, b| (a[0] - height).abs().total_cmp(&(b[0] - height).abs()));
            let force = found.map_or(f64::NAN, |row| row[1]);
            study.check(
                run,
                format!("force on half the width / (s_u w₀) at {height} h₀ [-]"),
                HOMOGENEOUS.says(2.0 / height),
                Band::Relative(5e-4),
                force,
            );
        }
    }
    Ok(study)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_force_is_twice_the_strength_times_the_width() {
        let (run, curve) = press(2, &Method::igimp_bbar()).unwrap();
        assert_eq!(run.outcome, "completed");
        for row in &curve.rows {
            assert!((row[1] / row[2] - 1.0).abs() < 1e-4, "{row:?}");
        }
    }
}
