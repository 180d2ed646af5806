//! Two soils that meet within a cell: level ground under its own weight, and a boundary that slopes.

mod level;
mod sloping;

use std::path::Path;

use igimp_cases::CaseError;
use igimp_cases::check::Band;
use igimp_cases::table::Table;
use rayon::prelude::*;

use crate::oracle::{Oracle, OracleKind};
use crate::study::{Level, Study};
use level::Ground;
use sloping::{Way, patch};

/// What the book says of the study.
const ABOUT: &str = "Two soils meet within a cell. Level ground under its own weight, the boundary at several heights of the cell, with the grid fitted to it and without: the vertical stress is the weight above. A block with an inclined boundary under pressure normal to it: the stress is known in both soils, and several ways to treat the cells that the boundary cuts are held against it.";
/// Vertical stress of level ground.
const OVERBURDEN: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "equilibrium of level ground",
    locator: "σ_v = Σ γ Δz",
};
/// Stress of particles in a cell that two soils share.
const ONE_STRAIN: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "one strain in the cell, the mean stress in equilibrium",
    locator: "theory, eq. (37a)",
};
/// Stress across an inclined boundary.
const LAMINATE: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "two elastic soils with a plane boundary, equal strain along it",
    locator: "traction continuous: σ_n = M ε_n, τ = G γ in each",
};
/// Places of the boundary within its cell \[-\].
const OFFSETS: [f64; 5] = [0.0, 0.1, 0.25, 0.5, 0.75];

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("layers", ABOUT, out)?;
    level_ground(&mut study)?;
    inclined(&mut study, level)?;
    Ok(study)
}

/// Level ground: fitted within 4 % at every particle, not fitted as eq. (37a) says.
fn level_ground(study: &mut Study) -> Result<(), CaseError> {
    let mut grounds = Vec::new();
    for stiffness in [1.0, 2.0, 10.0] {
        for offset in OFFSETS {
            grounds.extend([true, false].map(|fitted| Ground {
                offset,
                stiffness,
                fitted,
            }));
        }
    }
    let found: Result<Vec<_>, CaseError> = grounds.par_iter().map(Ground::settle).collect();
    let mut table = Table::new(
        "level_ground",
        &[
            "offset_[cells]",
            "E_lower/E_upper_[-]",
            "fitted",
            "error_above_[%]",
            "error_below_[%]",
            "stated_above_[%]",
            "stated_below_[%]",
        ],
    );
    for (ground, (run, error)) in grounds.iter().zip(found?) {
        let stated = ground.stated();
        let Ground {
            offset,
            stiffness,
            fitted,
        } = *ground;
        let percent = |share: f64| 100.0 * share;
        table.push(vec![
            offset,
            stiffness,
            f64::from(u8::from(fitted)),
            percent(error[1]),
            percent(error[0]),
            percent(stated[1]),
            percent(stated[0]),
        ]);
        let run = study.run_to_end(run);
        let worst = error[0].abs().max(error[1].abs());
        if fitted {
            study.check(
                run,
                "largest |σ_v error| over the weight above the boundary [-]",
                OVERBURDEN.says(0.0),
                Band::AtMost(0.04),
                worst,
            );
        } else if stiffness > 5.0 && offset > 0.3 {
            for (side, name) in [(1, "above"), (0, "below")] {
                study.check(
                    run,
                    format!("σ_v error just {name} the boundary [-]"),
                    ONE_STRAIN.says(stated[side]),
                    Band::Between(stated[side] - 0.05, stated[side] + 0.05),
                    error[side],
                );
            }
        }
    }
    study.table(table)
}

/// An inclined boundary, and the ways to treat the cells that it cuts.
fn inclined(study: &mut Study, level: Level) -> Result<(), CaseError> {
    let mut table = Table::new(
        "inclined_boundary",
        &[
            "slope_[degree]",
            "E_lower/E_upper_[-]",
            "cells",
            "way",
            "normal_stress_max_[%]",
            "normal_stress_rms_[%]",
            "beyond_cut_cells_max_[%]",
            "tangential_stress_rms_[%]",
        ],
    );
    let cells: &[usize] = if level == Level::Full {
        &[12, 24]
    } else {
        &[12]
    };
    let mut patches = Vec::new();
    for slope in [0.0, 15.0, 30.0, 45.0] {
        for stiffness in [2.0, 10.0] {
            for &cells in cells {
                patches.extend(Way::ALL.map(|way| (slope, stiffness, cells, way)));
            }
        }
    }
    let found: Result<Vec<_>, CaseError> = patches
        .par_iter()
        .map(|&(slope, stiffness, cells, way)| patch(slope, stiffness, cells, way))
        .collect();
    for (&(slope, stiffness, cells, way), (run, errors)) in patches.iter().zip(found?) {
        let mut row = vec![slope, stiffness, cells as f64, f64::from(way as u8)];
        row.extend(errors.map(|share| 100.0 * share));
        table.push(row);
        let _ = study.run_to_end(run);
    }
    study.table(table)
}
