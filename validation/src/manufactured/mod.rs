//! A manufactured solution at large strain: the body force that keeps a chosen displacement field in
//! equilibrium is applied, and the field has to come back, with a rate that theory knows.

mod field;
mod stress;

use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{
    Constraints, LoadPoint, Method, Particles, SharedLaw, StepConditions, StepLoads,
};
use igimp_cases::CaseError;
use igimp_figures::{CurvePlot, LineStyle, Scale, Series, SeriesStyle};
use igimp_material::{Elasticity, HenckyElastic};
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use igimp_shape::Grid;
use igimp_solver::{Body, MarchSettings};
use rayon::prelude::*;

use self::field::Field;
use self::stress::Moduli;
use crate::continuum::laboratory::{filled, grid_of, run, unobserved};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};

/// The book's description of the study.
const ABOUT: &str = "A smooth field with stretches from 0.7 to 1.3 is prescribed by its own body force on the unit square and cube. Errors of displacement and stress under refinement, in one step and in ten: second order in displacement and first in stress until particles cross cells, where iMPM stalls and iGIMP goes on.";
/// Linear interpolation, as long as every cell has the same particles.
const LINEAR_CELLS: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "interpolation by linear cells, Strang and Fix 1973",
    locator: "An Analysis of the Finite Element Method, chapter 3: second order in displacement, first in its gradient",
};
/// Particles that lie anywhere.
const CROSSING: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "Steffen, Kirby and Berzins 2008",
    locator: "IJNME 76:922-948: quadrature errors of particles that cross cells under linear basis functions do not vanish with h",
};
/// Young's modulus \[force/length²\].
const YOUNG: f64 = 1000.0;
/// Poisson's ratio \[-\].
const POISSON: f64 = 0.3;
/// Number of variants of the method.
const METHODS: usize = 4;
/// The first of those with the generalised basis.
const GIMP: usize = 2;

/// The variants of the method in the order of tables: iMPM, iMPM + B-bar, iGIMP, iGIMP + B-bar.
fn method(index: usize) -> Method {
    match index {
        0 => Method::impm(),
        1 => Method::impm_bbar(),
        2 => Method::igimp(),
        _ => Method::igimp_bbar(),
    }
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("manufactured", ABOUT, out)?;
    let (plane, solid): (&[usize], &[usize]) = match level {
        Level::Quick => (&[4, 8, 16], &[4, 8]),
        Level::Default => (&[4, 8, 16, 32], &[4, 8]),
        Level::Full => (&[4, 8, 16, 32, 64], &[4, 8, 16]),
    };
    convergence(&mut study, &Field::<2>::aligned(0.1), 1, plane)?;
    convergence(&mut study, &Field::<2>::swirls(0.05), 1, plane)?;
    convergence(&mut study, &Field::<2>::aligned(0.1), 10, plane)?;
    convergence(&mut study, &Field::<2>::swirls(0.05), 10, plane)?;
    convergence(&mut study, &Field::<3>::swirls(0.05), 1, solid)?;
    if level > Level::Quick {
        convergence(&mut study, &Field::<3>::aligned(0.1), 1, solid)?;
    }
    if level == Level::Full {
        convergence(&mut study, &Field::<3>::aligned(0.1), 10, &solid[..2])?;
        convergence(&mut study, &Field::<3>::swirls(0.05), 10, &solid[..2])?;
    }
    Ok(study)
}

/// Relative errors over the body, root of the mean of squares.
#[derive(Clone, Copy, Debug)]
struct Errors {
    /// ‖u − u_exact‖/‖u_exact‖ \[-\].
    displacement: f64,
    /// ‖σ − σ_exact‖/‖σ_exact‖ \[-\].
    stress: f64,
}

impl Errors {
    fn new<const D: usize>(particles: &Particles<D>, field: &Field<D>, moduli: Moduli) -> Self {
        let (mut u, mut sigma) = ([0.0; 2], [0.0; 2]);
        for particle in 0..particles.len() {
            let volume = particles.volume0[particle];
            let moved = particles.displacement[particle];
            let x0 = std::array::from_fn(|axis| particles.x[particle][axis] - moved[axis]);
            let exact = field.displacement(&x0);
            let stress = field.cauchy(&x0, moduli);
            for i in 0..D {
                u[0] += volume * (moved[i] - exact[i]).powi(2);
                u[1] += volume * exact[i].powi(2);
                for j in 0..D {
                    let difference = particles.sigma[particle][i][j] - stress[i][j];
                    sigma[0] += volume * difference.powi(2);
                    sigma[1] += volume * stress[i][j].powi(2);
                }
            }
        }
        Self {
            displacement: (u[0] / u[1]).sqrt(),
            stress: (sigma[0] / sigma[1]).sqrt(),
        }
    }
}

/// Brings the field about in so many equal steps of its amplitude.
fn solve<const D: usize>(
    field: &Field<D>,
    method: &Method,
    cells: usize,
    steps: usize,
) -> Result<(RunRecord, Errors), CaseError> {
    let grid = grid_of(1.0 / cells as f64, [cells; D])?;
    let elasticity = Elasticity::new(YOUNG, POISSON)?;
    let moduli = Moduli {
        bulk: elasticity.bulk(),
        shear: elasticity.shear(),
    };
    let law: SharedLaw = Arc::new(HenckyElastic::new(elasticity));
    let particles = Particles::new(&filled(&grid, 2))?;
    let x0 = particles.x.clone();
    let load_points = (0..particles.len() * D)
        .map(|load| {
            let mut force = [0.0; D];
            force[load % D] = particles.volume0[load / D];
            let x = x0[load / D];
            LoadPoint { x, force, load }
        })
        .collect();
    let mut body = Body {
        particles,
        load_points,
        rigid: Vec::new(),
        reinforcement: Vec::new(),
        free_fields: Vec::new(),
    };
    let constraints = walls(&grid, field.rollers);
    let load_path = |_from: f64, to: f64| {
        let now = field.scaled(to);
        let forces: Vec<[f64; D]> = x0.iter().map(|x| now.body_force(x, moduli)).collect();
        StepConditions::new(
            grid.clone(),
            constraints.clone(),
            StepLoads {
                gravity: [0.0; D],
                factors: forces.into_flattened(),
                drag: 0.0,
            },
            vec![Arc::clone(&law)],
        )
    };
    let label = method.label();
    let variant = format!(
        "{label}, {D}D, {}, {cells} cells, steps: {steps}",
        field.name
    );
    let settings = MarchSettings::steps(steps);
    let (run, _) = run(
        variant,
        &mut body,
        method,
        &settings,
        &load_path,
        &mut unobserved,
    );
    Ok((run, Errors::new(&body.particles, field, moduli)))
}

/// Walls that hold the normal component of displacement, or all of it.
fn walls<const D: usize>(grid: &Grid<D>, rollers: bool) -> Constraints<D> {
    let mut constraints = Constraints::free(grid);
    for normal in 0..D {
        for upper in [false, true] {
            for axis in (0..D).filter(|&axis| axis == normal || !rollers) {
                constraints
                    .fix_wall(grid, normal, upper, axis)
                    .expect("the walls are those of the grid");
            }
        }
    }
    constraints
}

/// Runs all methods on all meshes and holds the rates between the two finest against theory.
fn convergence<const D: usize>(
    study: &mut Study,
    field: &Field<D>,
    steps: usize,
    meshes: &[usize],
) -> Result<(), CaseError> {
    // In one step from a regular start the bases are one: a domain within a cell sees its middle.
    // Crossing particles leave iMPM no digits worth a fine mesh.
    let worth = |index: usize, cells: usize| {
        index >= GIMP
            || (if D == 3 {
                cells <= 8
            } else {
                steps == 1 || cells <= 32
            })
    };
    let jobs: Vec<(usize, usize)> = (0..METHODS)
        .flat_map(|index| meshes.iter().map(move |&cells| (index, cells)))
        .filter(|&(index, cells)| worth(index, cells))
        .collect();
    let solved = jobs
        .par_iter()
        .map(|&(index, cells)| solve(field, &method(index), cells, steps))
        .collect::<Result<Vec<_>, CaseError>>()?;
    let mut runs = vec![Vec::new(); METHODS];
    let mut curves = vec![Vec::new(); METHODS];
    for ((index, cells), (run, errors)) in jobs.into_iter().zip(solved) {
        runs[index].push(run);
        curves[index].push((cells, errors));
    }
    for index in 0..METHODS {
        let label = method(index).label();
        let sum = RunRecord::sum(
            format!("{label}, {D}D, {}, {}", field.name, in_steps(steps)),
            &runs[index].iter().collect::<Vec<_>>(),
        );
        let run = study.run(sum);
        for pair in curves[index].windows(2) {
            rates::<D>(study, run, index, field.rollers, steps, pair);
        }
    }
    write(study, field, steps, &curves)
}

/// Holds the orders between two meshes against theory, unless the coarser one is too coarse for it.
fn rates<const D: usize>(
    study: &mut Study,
    run: usize,
    index: usize,
    rollers: bool,
    steps: usize,
    pair: &[(usize, Errors)],
) {
    let [(from, coarse), (cells, fine)] = *pair else {
        return;
    };
    if D == 2 && from < 8 {
        return;
    }
    let meshes = format!("{from} to {cells} cells");
    let displacement = (coarse.displacement / fine.displacement).log2();
    let stress = (coarse.stress / fine.stress).log2();
    if index >= GIMP || steps == 1 {
        let band = if steps == 1 {
            Band::Between(1.85, 2.15)
        } else {
            Band::Between(1.6, 2.6)
        };
        let quantity = format!("order of displacement, {meshes} [-]");
        study.check(run, quantity, LINEAR_CELLS.says(2.0), band, displacement);
        let quantity = format!("order of stress, {meshes} [-]");
        study.check(
            run,
            quantity,
            LINEAR_CELLS.says(1.0),
            Band::AtLeast(0.9),
            stress,
        );
    } else if D == 2 && (rollers || cells >= 32) {
        study.control(
            run,
            format!("order of displacement, {meshes}, must not converge [-]"),
            CROSSING.says(0.0),
            Band::AtMost(0.5),
            displacement,
        );
    }
}

/// "one step" or "ten steps".
fn in_steps(steps: usize) -> &'static str {
    if steps == 1 { "one step" } else { "ten steps" }
}

/// Table and picture of the errors by mesh.
fn write<const D: usize>(
    study: &mut Study,
    field: &Field<D>,
    steps: usize,
    curves: &[Vec<(usize, Errors)>],
) -> Result<(), CaseError> {
    let name = format!("{D}d_{}_{steps}", field.name);
    let finest = curves[METHODS - 1].last().map_or(0, |(cells, _)| *cells);
    let mut table = Table::new(
        format!("errors_{name}_to_{finest}_cells"),
        &[
            "method",
            "cells",
            "displacement_error_[-]",
            "stress_error_[-]",
        ],
    );
    for (index, series) in curves.iter().enumerate() {
        for (cells, errors) in series {
            table.push(vec![
                index as f64,
                *cells as f64,
                errors.displacement,
                errors.stress,
            ]);
        }
    }
    let points = |series: &[(usize, Errors)], of: fn(&Errors) -> f64| {
        series
            .iter()
            .map(|(cells, errors)| [*cells as f64, of(errors)])
            .collect()
    };
    let markers = SeriesStyle::LineAndMarkers(LineStyle::Solid);
    let mut series: Vec<Series> = Vec::new();
    for (index, curve) in curves.iter().enumerate() {
        let label = format!("u, {}", method(index).label());
        series.push(Series::new(
            label,
            points(curve, |errors| errors.displacement),
            markers,
        ));
    }
    let stress = points(&curves[METHODS - 1], |errors| errors.stress);
    let dashed = SeriesStyle::LineAndMarkers(LineStyle::Dashed);
    series.push(Series::new("σ, iGIMP + B-bar", stress, dashed));
    CurvePlot {
        title: format!(
            "Manufactured solution, {D}D, {}, {}",
            field.name,
            in_steps(steps)
        ),
        x_label: "cells along a side".into(),
        y_label: "relative error".into(),
        x_scale: Scale::Log,
        y_scale: Scale::Log,
        series,
        ..CurvePlot::default()
    }
    .write(&study.folder.join(name))?;
    study.table(table)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Second order in one step, in the plane and in space, with both bases and with B-bar.
    fn second_order_in_one_step<const D: usize>(field: &Field<D>) {
        for index in 0..METHODS {
            let at = |cells| solve(field, &method(index), cells, 1).unwrap().1;
            let (coarse, fine) = (at(4), at(8));
            let order = (coarse.displacement / fine.displacement).log2();
            assert!((1.8..2.2).contains(&order), "{}, {D}D: {order}", field.name);
        }
    }

    #[test]
    fn one_step_is_of_second_order() {
        second_order_in_one_step(&Field::<2>::aligned(0.1));
        second_order_in_one_step(&Field::<2>::swirls(0.05));
        second_order_in_one_step(&Field::<3>::swirls(0.05));
    }

    /// Particles that cross cells: iGIMP gains with refinement, iMPM does not.
    #[test]
    fn crossing_particles() {
        let field = Field::<2>::aligned(0.1);
        let gain = |index: usize| {
            let at = |cells| solve(&field, &method(index), cells, 10).unwrap().1;
            at(4).displacement / at(8).displacement
        };
        assert!(gain(0) < 1.2 && gain(1) < 1.2, "iMPM");
        assert!(gain(2) > 3.0 && gain(3) > 3.0, "iGIMP");
    }
}
