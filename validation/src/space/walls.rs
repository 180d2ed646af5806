//! Undrained slopes between rough end walls: half of the slope, from the plane of symmetry to a wall.

use std::path::Path;

use igimp_assembly::Locking;
use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use rayon::prelude::*;

use super::safety::{interval, middle};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};
use crate::limit_equilibrium::section::{Ends, Path as Way, Search, Section, Variant, YOUNG};
use crate::runs::Computed;

/// The book's description of the study.
const ABOUT: &str = "An undrained slope of 45°, on a rigid base at its toe (D = 1) or as deep again below it (D = 2), between two end walls L apart. With rough walls γH/c_u lies between the lower bound of plane strain and the least upper bound of circular cylinders with flat ends; with smooth walls it is the plane's on the same mesh. One half is computed, up to the plane of symmetry, on the given geometry with shared strain.";
const FLAT_ENDS: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "circular cylinders with flat ends at the walls, an upper bound; finite-element limit analysis of plane strain, a lower one",
    locator: "least over circles: γH/c_u = 9.830, 8.016, 6.875 for L/H = 1, 2, 5 and D = 1, 9.729, 7.877 for L/H = 1, 2 and D = 2; plane strain 5.966 and 5.379",
};
const PLANE: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "plane strain is a part of space",
    locator: "γH/c_u in plane strain on the same mesh",
};
/// γH of the section \[kPa\].
const WEIGHT: f64 = 200.0;

/// A slope between walls.
#[derive(Clone, Copy)]
struct Valley {
    /// Depth of the base below the crest over the height of the slope, D \[-\].
    depth: f64,
    /// Distance of the walls over the height of the slope \[-\].
    length: f64,
    /// Lower bound of γH/c_u in plane strain, and upper bound between the walls \[-\].
    bounds: [f64; 2],
    /// Cells over the height on the two meshes, and from the plane of symmetry to the wall.
    meshes: [[u32; 2]; 2],
    is_rough: bool,
    /// Lowest level at which each mesh is run.
    levels: [Level; 2],
}

static VALLEYS: [Valley; 6] = [
    Valley {
        depth: 1.0,
        length: 1.0,
        bounds: [5.966, 9.830],
        meshes: [[4, 2], [8, 4]],
        is_rough: true,
        levels: [Level::Quick, Level::Default],
    },
    Valley {
        depth: 1.0,
        length: 2.0,
        bounds: [5.966, 8.016],
        meshes: [[4, 4], [8, 8]],
        is_rough: true,
        levels: [Level::Default, Level::Full],
    },
    Valley {
        depth: 1.0,
        length: 5.0,
        bounds: [5.966, 6.875],
        meshes: [[4, 5], [8, 10]],
        is_rough: true,
        levels: [Level::Default, Level::Full],
    },
    Valley {
        depth: 1.0,
        length: 1.0,
        bounds: [5.966, 6.077],
        meshes: [[4, 2], [8, 4]],
        is_rough: false,
        levels: [Level::Quick, Level::Full],
    },
    Valley {
        depth: 2.0,
        length: 1.0,
        bounds: [5.379, 9.729],
        meshes: [[4, 2], [8, 4]],
        is_rough: true,
        levels: [Level::Full, Level::Full],
    },
    Valley {
        depth: 2.0,
        length: 2.0,
        bounds: [5.379, 7.877],
        meshes: [[4, 4], [8, 8]],
        is_rough: true,
        levels: [Level::Full, Level::Full],
    },
];

impl Valley {
    /// Its section, for a factor of safety of about 1.3.
    fn section(&self) -> Section {
        let cohesion = (1.3 * WEIGHT / self.bounds[1]).round();
        let beyond = 15.0 * (self.depth - 1.0);
        let margins = [15.0, beyond];
        Section::homogeneous(
            "undrained, 45°",
            (1.0, self.depth),
            (cohesion, 0.0),
            margins,
        )
    }

    fn name(&self, mesh: usize) -> String {
        let walls = if self.is_rough { "rough" } else { "smooth" };
        let [cells, across] = self.meshes[mesh];
        let base = if self.depth > 1.0 {
            format!("D = {}, ", self.depth)
        } else {
            String::new()
        };
        format!(
            "{walls} walls, {base}L/H = {}, h = H/{cells}, {across} cells across",
            self.length
        )
    }

    /// γH/c_u of a factor of safety \[-\].
    fn number(&self, factor: f64) -> f64 {
        factor * WEIGHT / self.section().layers[0].cohesion
    }

    /// γH/c_u, and that of plane strain on the same mesh \[-\].
    fn find(&self, mesh: usize) -> Result<(RunRecord, [f64; 2]), CaseError> {
        let [cells, across] = self.meshes[mesh];
        let variant = Variant {
            cells,
            locking: Locking::SharedStrain,
            associated: true,
        };
        let search = Search {
            bracket: [1.2, 1.6],
            path: Way::Reduce,
            steps: 8,
            young: YOUNG,
        };
        let section = self.section();
        let ends = Ends {
            length: 0.5 * self.length * section.height,
            cells: across,
            is_rough: self.is_rough,
        };
        let space = Computed::new(section.case_in_space(variant, search, ends, &[])?)?;
        let plane = if self.is_rough {
            f64::NAN
        } else {
            let plane = Computed::new(section.case(variant, search)?)?;
            self.number(middle(interval("", &plane).1))
        };
        let (record, found) = interval(&self.name(mesh), &space);
        Ok((record, [self.number(middle(found)), plane]))
    }
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("space-walls", ABOUT, out)?;
    let jobs: Vec<(&Valley, usize)> = VALLEYS
        .iter()
        .flat_map(|valley| [(valley, 0), (valley, 1)])
        .filter(|(valley, mesh)| valley.levels[*mesh] <= level)
        .collect();
    let done = jobs
        .par_iter()
        .map(|(valley, mesh)| valley.find(*mesh))
        .collect::<Result<Vec<_>, CaseError>>()?;
    let mut table = Table::new(
        "stability_numbers",
        &[
            "D_[-]",
            "L/H_[-]",
            "rough",
            "cells_over_H",
            "gamma_H/c_[-]",
            "upper_bound_[-]",
        ],
    );
    for ((valley, mesh), (record, [number, plane])) in jobs.into_iter().zip(done) {
        let run = study.run(record);
        let [lower, upper] = valley.bounds;
        table.push(vec![
            valley.depth,
            valley.length,
            f64::from(u8::from(valley.is_rough)),
            f64::from(valley.meshes[mesh][0]),
            number,
            upper,
        ]);
        if valley.is_rough {
            study.notes.push(format!(
                "{}: γH/c_u = {number:.3}, {:.3} of the upper bound",
                valley.name(mesh),
                number / upper
            ));
            if mesh == 1 {
                study.check(
                    run,
                    "γH/c_u [-]",
                    FLAT_ENDS.says(upper),
                    Band::Between(lower, 1.04 * upper),
                    number,
                );
            }
        } else {
            study.check(
                run,
                "γH/c_u [-]",
                PLANE.says(plane),
                Band::Relative(0.02),
                number,
            );
        }
    }
    table.write_csv(&study.folder)?;
    Ok(study)
}
