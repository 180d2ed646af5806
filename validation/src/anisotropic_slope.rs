//! Slopes of clay whose undrained strength goes with the direction of loading, against circles.

use std::path::Path;

use igimp_assembly::Locking;
use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_results::mesh_study::{Computed as OnMesh, Convergence, estimate};
use igimp_results::tables::table::Table;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study, coverage};
use crate::limit_equilibrium::directional::{Circles, Shares, circles};
use crate::limit_equilibrium::section::{self, Search, Section, Variant, YOUNG};
use crate::runs::Computed;
use crate::slopes::Found;

/// The book's description of the study.
const ABOUT: &str = "Slopes of clay whose undrained strength is s_a, s_d and s_p in active loading, simple shear and passive loading, on the given geometry with shared strain: N = γHF/s_a on two meshes, extrapolated, against the least upper bound of circles (theory, eq. 123b). One strength has Taylor's numbers and is the control.";
const CIRCLES: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "least upper bound of circles that dissipate the support of the ellipse of Davis and Christian 1971",
    locator: "limit_equilibrium/directional.rs: N = γHF/s_a; with one strength Taylor's (1937)",
};
const SAME_CIRCLES: Oracle = Oracle {
    kind: OracleKind::IndependentProgram,
    source: "the same circles with these strengths and with one strength",
    locator: "limit_equilibrium/directional.rs: between flow along the stress and flow normal to the ellipse; what circles miss, they miss of both slopes",
};
const FROZEN: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "at failure the direction of stress stays",
    locator: "steps four times as many, whose directions are late by a quarter, have the same N",
};
/// How far below the circles N may lie \[-\]: with one strength limit analysis has 2 to 4 % below those that reach the base.
const BELOW: f64 = 0.05;
/// How far N over that of one strength may lie beyond that of circles \[-\].
const RATIO: f64 = 0.02;
/// How far above them on one mesh \[-\].
const MESH: f64 = 0.01;
/// By how much N may change with the steps \[-\].
const LATE: f64 = 0.005;
/// By how much one strength has to miss the bound of the weaker directions \[-\].
const MISSES: f64 = 1.1;
/// γ of the slopes times their height \[kPa\].
const GAMMA_H: f64 = 200.0;
/// ν of undrained soil \[-\].
const POISSON: f64 = 0.45;
/// Cells over the height.
const CELLS: [u32; 2] = [10, 20];
/// Steps through the bracket of a search.
const STEPS: u32 = 10;

/// Directions that are alike, weaker than active loading, and stronger; the first two at the default level.
const DIRECTIONS: [(&str, Shares); 3] = [
    (
        "one strength",
        Shares {
            simple_shear: 1.0,
            passive: 1.0,
        },
    ),
    (
        "s_d = 0.75 s_a, s_p = 0.5 s_a",
        Shares {
            simple_shear: 0.75,
            passive: 0.5,
        },
    ),
    (
        "s_d = 1.5 s_a, s_p = 2 s_a",
        Shares {
            simple_shear: 1.5,
            passive: 2.0,
        },
    ),
];

/// Slope angles: one down for so much across.
const ANGLES: [(f64, f64, Level); 2] = [(45.0, 1.0, Level::Default), (26.57, 2.0, Level::Full)];

/// A slope with its known values.
struct Slope {
    section: Section,
    shares: Shares,
    circles: Circles,
    /// Factor that turns a factor of safety into N \[-\].
    number: f64,
}

impl Slope {
    /// One whose factor of safety is some 1.3.
    fn new((angle, run): (f64, f64), (directions, shares): (&str, Shares)) -> Self {
        let name = format!("{angle}°, {directions}");
        // The right side lies on a line of the grid.
        let margins = [20.0, 20.0 + (10.0 * run).ceil() - 10.0 * run];
        let with = |cohesion| Section::homogeneous(&name, (run, 1.5), (cohesion, 0.0), margins);
        let unit = circles(&with(1.0), shares);
        let cohesion = (1.3 / unit.bound).round();
        let section = with(cohesion);
        Self {
            number: GAMMA_H / cohesion,
            circles: Circles {
                bound: GAMMA_H * unit.bound,
                along_stress: GAMMA_H * unit.along_stress,
            },
            section,
            shares,
        }
    }

    /// Searches for the factor of safety.
    fn find(&self, cells: u32, steps: u32) -> Result<Found, CaseError> {
        let variant = Variant {
            cells,
            locking: Locking::SharedStrain,
            associated: true,
        };
        let bound = self.circles.bound / self.number;
        let search = Search {
            bracket: [0.9 * bound, 1.05 * bound],
            path: section::Path::Reduce,
            steps,
            young: YOUNG,
        };
        let Shares {
            simple_shear,
            passive,
        } = self.shares;
        let overrides = [
            format!("materials.soil-0.poisson={POISSON}"),
            format!(
                "materials.soil-0.anisotropy={{ simple_shear = {simple_shear:?}, passive = {passive:?} }}"
            ),
        ];
        let case = self.section.case_with(variant, search, &overrides)?;
        Ok(Found::of(Computed::new(case)?))
    }

    /// N of a search.
    fn number_of(&self, found: &Found) -> f64 {
        self.number * found.factor()
    }
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("anisotropic-slope", ABOUT, out)?;
    let angles: Vec<(f64, f64)> = (ANGLES.iter())
        .filter(|(.., least)| *least <= level)
        .map(|&(angle, run, _)| (angle, run))
        .collect();
    let directions = if level == Level::Full { 3 } else { 2 };
    let problems: Vec<_> = (angles.iter())
        .flat_map(|&angle| {
            DIRECTIONS[..directions]
                .iter()
                .map(move |shares| (angle, *shares))
        })
        .collect();
    let slopes: Vec<Slope> = (problems.par_iter())
        .map(|&(angle, directions)| Slope::new(angle, directions))
        .collect();
    let searches: Vec<(&Slope, u32)> = (slopes.iter())
        .flat_map(|slope| CELLS.map(|cells| (slope, cells)))
        .collect();
    let found = (searches.par_iter())
        .map(|(slope, cells)| slope.find(*cells, STEPS))
        .collect::<Result<Vec<_>, _>>()?;
    let mut table = Table::new(
        "stability_numbers",
        &[
            "slope",
            "circles_[-]",
            "circles_along_stress_[-]",
            "coarse_[-]",
            "fine_[-]",
            "extrapolated_[-]",
        ],
    );
    let families = slopes.chunks(directions).zip(found.chunks(2 * directions));
    for (slopes, found) in families {
        family(&mut study, slopes, found, &mut table);
    }
    if level == Level::Full {
        late(&mut study, &slopes[1], &found[2])?;
    }
    table.write_csv(&study.folder)?;
    Ok(study)
}

/// Checks the slopes of one angle, the first of which has one strength.
fn family(study: &mut Study, slopes: &[Slope], found: &[Found], table: &mut Table) {
    let mut alike = f64::NAN;
    for (place, (slope, pair)) in slopes.iter().zip(found.chunks(2)).enumerate() {
        let (run, value) = report(study, slope, pair, table);
        if place == 0 {
            alike = value;
            let weaker = slopes[1].circles.bound;
            study.control(
                run,
                "N of one strength, against the circles of s_d = 0.75 s_a, s_p = 0.5 s_a [-]",
                CIRCLES.says(weaker),
                Band::AtLeast(MISSES * weaker),
                value,
            );
            continue;
        }
        let one = slopes[0].circles.bound;
        let ratios = [slope.circles.along_stress / one, slope.circles.bound / one];
        study.check(
            run,
            "N over that of one strength, both extrapolated [-]",
            SAME_CIRCLES.says(0.5 * (ratios[0] + ratios[1])),
            Band::Between((1.0 - RATIO) * ratios[0], (1.0 + RATIO) * ratios[1]),
            value / alike,
        );
    }
}

/// Checks a slope on both meshes; the run of its checks, and N.
fn report(study: &mut Study, slope: &Slope, pair: &[Found], table: &mut Table) -> (usize, f64) {
    let values = [0, 1].map(|mesh| OnMesh {
        h: f64::from(CELLS[mesh]).recip(),
        value: slope.number_of(&pair[mesh]),
        half_width: slope.number * pair[mesh].half_width(),
    });
    let value = coverage::value(estimate(&values, Convergence::SOIL));
    let both = [0, 1].map(|mesh| pair[mesh].run(String::new()));
    let label = format!(
        "{}, H/h = {} and {}",
        slope.section.name, CELLS[0], CELLS[1]
    );
    let run = study.run(RunRecord::sum(label, &[&both[0], &both[1]]));
    let Circles {
        bound,
        along_stress,
    } = slope.circles;
    study.check(
        run,
        "N, extrapolated from two meshes [-]",
        CIRCLES.says(bound),
        Band::Between((1.0 - BELOW) * bound, bound),
        value,
    );
    study.check(
        run,
        format!("N on H/h = {} [-]", CELLS[1]),
        CIRCLES.says(bound),
        Band::AtMost((1.0 + MESH) * bound),
        values[1].value,
    );
    study.notes.push(format!(
        "{}: circles {bound:.3}, along the stress {along_stress:.3}; {:.3}, {:.3}; extrapolated {value:.3}",
        slope.section.name, values[0].value, values[1].value,
    ));
    table.push(vec![
        table.rows.len() as f64 + 1.0,
        bound,
        along_stress,
        values[0].value,
        values[1].value,
        value,
    ]);
    (run, value)
}

/// Holds a search on the coarse mesh against one in steps that are a quarter.
fn late(study: &mut Study, slope: &Slope, before: &Found) -> Result<(), CaseError> {
    let finer = slope.find(CELLS[0], 4 * STEPS)?;
    let run = study.run(finer.run(format!(
        "{}, H/h = {}, {} steps",
        slope.section.name,
        CELLS[0],
        4 * STEPS
    )));
    let expected = slope.number_of(before);
    study.check(
        run,
        format!("N, by {STEPS} steps in place of {} [-]", 4 * STEPS),
        FROZEN.says(slope.number_of(&finer)),
        Band::Between((1.0 - LATE) * expected, (1.0 + LATE) * expected),
        slope.number_of(&finer),
    );
    Ok(())
}
