//! The strip with two deep notches: fully plastic flow that is constrained in all directions, the
//! problem with which locking was found.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{Constraints, Method, Particles, SharedLaw, StepConditions, StepLoads};
use igimp_cases::CaseError;
use igimp_cases::check::Band;
use igimp_cases::figures::{CurvePlot, ReferenceLine, ReferenceValue, Series};
use igimp_cases::table::Table;
use igimp_material::{Elasticity, VonMises};
use igimp_shape::{Axis, Grid, ShapeError};
use igimp_solver::{Accepted, Body, MarchSettings};
use rayon::prelude::*;

use crate::laboratory::{filled, run};
use crate::oracle::{Oracle, OracleKind};
use crate::study::{Level, Run, Study};

/// Half the net section \[length\].
const LIGAMENT: f64 = 1.0;
/// Half the width and half the length of the strip over half the net section \[-\].
const SIZE: f64 = 10.0;
/// Young's modulus over the yield stress \[-\].
const YOUNG: f64 = 1e4;
/// Elongation of half the strip at the end over half the net section \[-\].
const PULL: f64 = 0.006;

/// Pulls a quarter; the curve has elongation and net stress over σ_y. Cells along the ligament are a
/// whole number and a half, so that the tip of the notch is in the middle of a cell.
fn pull(
    cells: usize,
    method: &Method,
    points: usize,
    steps: usize,
) -> Result<(Run, Table), CaseError> {
    let h = LIGAMENT / (cells as f64 + 0.5);
    let axis = graded(h, SIZE * LIGAMENT)?;
    let strip = Grid::new([axis.clone(), axis.clone()]);
    let mut body = Body::new(Particles::new(&filled(&strip, points))?);
    let mut nodes = axis.nodes().to_vec();
    let count = axis.cell_count();
    nodes.push(axis.end() + axis.spacing(count - 1));
    let grid = Grid::new([axis, Axis::from_nodes(nodes)?]);
    let law: SharedLaw = Arc::new(VonMises::from_yield_stress(
        Elasticity::new(YOUNG, 0.3)?,
        1.0,
    )?);
    let program = |from: f64, to: f64| {
        let mut constraints = Constraints::free(&grid);
        constraints.fix_wall(&grid, 0, false, 0);
        for column in 0..=cells {
            constraints.prescribe(grid.node_index([column, 0]), 1, 0.0)?;
        }
        for column in 0..=count {
            for row in [count, count + 1] {
                let node = grid.node_index([column, row]);
                constraints.prescribe(node, 1, (to - from) * PULL)?;
            }
        }
        Ok(StepConditions {
            grid: grid.clone(),
            constraints,
            loads: StepLoads::gravity([0.0; 2]),
            laws: vec![Arc::clone(&law)],
        })
    };
    let mut curve = Table::new("net_stress", &["elongation_[-]", "net_stress_[σ_y]"]);
    curve.push(vec![0.0; 2]);
    let mut observe = |accepted: &Accepted<'_, 2>| {
        let force: f64 = (0..=cells)
            .map(|column| -accepted.forces.reactions[grid.node_index([column, 0])][1])
            .sum();
        curve.push(vec![PULL * accepted.report.to, force / LIGAMENT]);
        ControlFlow::Continue(())
    };
    let variant = format!("{}, c/h = {cells}.5", method.label());
    let settings = MarchSettings::steps(steps);
    let (run, _) = run(
        variant,
        &mut body,
        method,
        &settings,
        &program,
        &mut observe,
    );
    Ok((run, curve))
}

/// Nodes from 0 to `end`: equal cells up to 2.5 times the ligament, growing by 15 % beyond.
fn graded(h: f64, end: f64) -> Result<Axis, ShapeError> {
    let mut nodes = vec![0.0];
    let mut size = h;
    while let Some(&last) = nodes.last() {
        if last >= end {
            break;
        }
        if last > 2.5 * LIGAMENT {
            size *= 1.15;
        }
        nodes.push(last + size);
    }
    Axis::from_nodes(nodes)
}

pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("notched-strip", "", out)?;
    for method in [Method::igimp_bbar(), Method::igimp()] {
        for (cells, points) in [(2, 2), (4, 2), (4, 3), (8, 2)] {
            let (run, curve) = pull(cells, &method, points, 20)?;
            eprintln!(
                "{} points {points} {} cuts {} {:.2} s",
                run.variant, run.outcome, run.cuts, run.seconds
            );
            for row in curve.rows.iter().step_by(2) {
                eprintln!(
                    "   {:.4} {:.4} {:+.2} %",
                    row[0],
                    row[1],
                    100.0 * (row[1] / 2.9685 - 1.0)
                );
            }
        }
    }
    let _ = level;
    Ok(study)
}
