//! Two soils that meet within a cell: level ground under its own weight, and a boundary that slopes.

mod level;
mod sloping;

use std::path::Path;

use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{RunRecord, Study};
use level::{Cells, Ground};
use sloping::{Way, patch};

/// The book's description of the study.
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
/// Cells along a side of the block with an inclined boundary.
const CELLS: usize = 12;
/// Places of the boundary within its cell \[-\].
const OFFSETS: [f64; 5] = [0.0, 0.1, 0.25, 0.5, 0.75];

/// Runs the study; it is short enough to be the same at every level.
pub(crate) fn study(out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("layers", ABOUT, out)?;
    level_ground(&mut study)?;
    inclined(&mut study)?;
    Ok(study)
}

/// Level ground of two stiffnesses, with the boundary anywhere in its cell.
fn grounds() -> Vec<Ground> {
    let mut grounds = Vec::new();
    for cells in Cells::ALL {
        for stiffness in [1.0, 2.0, 10.0] {
            grounds.extend(OFFSETS.map(|offset| Ground {
                offset,
                stiffness,
                cells,
            }));
        }
    }
    grounds
}

/// Level ground: fitted within 4 % at every particle, not fitted as eq. (37a) says.
fn level_ground(study: &mut Study) -> Result<(), CaseError> {
    let grounds = grounds();
    let found: Result<Vec<_>, CaseError> = grounds.par_iter().map(Ground::settle).collect();
    let found = found?;
    let percent = |share: f64| 100.0 * share;
    for cells in Cells::ALL {
        let of_cells = || {
            let pairs = grounds.iter().zip(&found);
            pairs.filter(move |(ground, _)| ground.cells == cells)
        };
        let runs: Vec<&RunRecord> = of_cells().map(|(_, (run, _))| run).collect();
        let run = study.run_to_end(RunRecord::sum(
            format!("level ground, {}", cells.name()),
            &runs,
        ));
        let mut table = Table::new(
            format!("level_ground_{}", cells.key()),
            &[
                "offset_[cells]",
                "E_lower/E_upper_[-]",
                "error_above_[%]",
                "error_below_[%]",
                "stated_above_[%]",
                "stated_below_[%]",
            ],
        );
        let (mut worst, mut beside_stated) = (0.0_f64, 0.0_f64);
        for (ground, (_, error)) in of_cells() {
            let stated = ground.stated();
            table.push(vec![
                ground.offset,
                ground.stiffness,
                percent(error[1]),
                percent(error[0]),
                percent(stated[1]),
                percent(stated[0]),
            ]);
            for side in 0..2 {
                worst = worst.max(error[side].abs());
                // Both the mean of the cell and the exact stress vary by the weight of a part of it.
                let size = 1.0 + (1.0 + stated[side]);
                beside_stated = beside_stated.max((error[side] - stated[side]).abs() / size);
            }
        }
        let largest = "largest |σ_v error| over the weight above the boundary [-]";
        match cells {
            Cells::Fitted => {
                let band = Band::AtMost(0.04);
                study.check(run, largest, OVERBURDEN.says(0.0), band, worst);
            }
            Cells::Mean => {
                let band = Band::AtMost(level::half_a_cell());
                study.check(run, largest, OVERBURDEN.says(0.0), band, worst);
            }
            Cells::Own => {
                let band = Band::AtLeast(0.25);
                study.control(run, largest, OVERBURDEN.says(0.0), band, worst);
                study.check(
                    run,
                    "largest |σ_v − stated| over the sum of stated and exact [-]",
                    ONE_STRAIN.says(0.0),
                    Band::AtMost(0.04),
                    beside_stated,
                );
            }
        }
        study.table(table)?;
    }
    Ok(())
}

/// An inclined boundary, and the ways to treat the cells that it cuts.
fn inclined(study: &mut Study) -> Result<(), CaseError> {
    let mut patches = Vec::new();
    for way in Way::ALL {
        for slope in [0.0, 15.0, 30.0, 45.0] {
            for stiffness in [2.0, 10.0] {
                patches.push((slope, stiffness, way));
            }
        }
    }
    let found: Result<Vec<_>, CaseError> = patches
        .par_iter()
        .map(|&(slope, stiffness, way)| patch(slope, stiffness, CELLS, way))
        .collect();
    let found = found?;
    for way in Way::ALL {
        let of_way = || {
            let pairs = patches.iter().zip(&found);
            pairs.filter(move |(patch, _)| patch.2 == way)
        };
        let runs: Vec<&RunRecord> = of_way().map(|(_, (run, _))| run).collect();
        let run = study.run_to_end(RunRecord::sum(format!("inclined, {}", way.name()), &runs));
        let mut table = Table::new(
            format!("inclined_{}", way.key()),
            &[
                "slope_[degree]",
                "E_lower/E_upper_[-]",
                "normal_stress_max_[%]",
                "normal_stress_rms_[%]",
                "beyond_cut_cells_max_[%]",
                "tangential_stress_rms_[%]",
            ],
        );
        let mut worst = [0.0_f64; 2];
        for (&(slope, stiffness, _), (_, errors)) in of_way() {
            let mut row = vec![slope, stiffness];
            row.extend(errors.map(|share| 100.0 * share));
            table.push(row);
            let side = usize::from(stiffness > 5.0);
            worst[side] = worst[side].max(errors[0]);
        }
        for (worst, (ratio, limits)) in worst.into_iter().zip([(2, [0.1, 0.25]), (10, [0.25, 0.5])])
        {
            let quantity = format!("largest error of σ_n in cut cells, E ratio {ratio} [-]");
            let expected = LAMINATE.says(0.0);
            match way {
                Way::MeanCompliance => {
                    study.check(run, quantity, expected, Band::AtMost(limits[0]), worst);
                }
                Way::Own => study.control(run, quantity, expected, Band::AtLeast(limits[1]), worst),
                _ => {}
            }
        }
        study.table(table)?;
    }
    Ok(())
}
