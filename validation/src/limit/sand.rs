//! Slopes of soil without cohesion against the infinite slope, at several places of the grid.

use std::fmt::Write as _;

use igimp_assembly::Locking;
use igimp_cases::CaseError;
use igimp_model::check::Band;
use rayon::prelude::*;

use super::Found;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, Study};
use crate::limit_equilibrium::section::{Path, Search, Section, Variant};
use crate::runs::Computed;

/// All depths slide together.
const INFINITE_SLOPE: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "infinite slope without cohesion",
    locator: "F = tan φ / tan β with ψ = φ",
};
/// The error of cells of a tenth of the height, as a share of the factor \[-\].
const OFF: f64 = 0.03;
/// Slopes: run for one down \[-\], φ \[degree\].
const SLOPES: [(f64, f64); 3] = [(2.0, 38.0), (1.5, 40.0), (3.0, 25.0)];
/// The same that no constant of eqs. 8f and 8g was chosen on: at one place by default.
const BESIDE: [(f64, f64); 3] = [(2.0, 30.0), (1.75, 35.0), (2.5, 32.0)];
/// Where crest and ground lie in their cells \[-\]: the first three by default.
const PLACES: [[f64; 2]; 5] = [
    [0.0, 0.0],
    [0.5, 0.0],
    [0.3, 0.4],
    [0.25, 0.0],
    [0.75, 0.25],
];
/// Ground before the crest, and at least beyond the toe, in cells of 1 m.
const MARGIN: f64 = 10.0;

/// A slope of 10 m on cells of 1 m, at a place in its cells.
#[derive(Clone, Copy, Debug)]
struct Sand {
    run: f64,
    friction: f64,
    place: [f64; 2],
    /// E \[kPa\].
    young: f64,
}

impl Sand {
    fn name(self) -> String {
        let Self {
            run,
            friction,
            place: [x, y],
            young,
        } = self;
        format!(
            "dry sand, 1:{run}, φ = {friction}°, crest at ({x}, {y}) of its cell, E = {young} kPa"
        )
    }

    fn find(self) -> Result<Found, CaseError> {
        let [x, y] = self.place;
        let before = MARGIN + x;
        let toe = before + 10.0 * self.run;
        let margins = [before, (toe + 0.5 * MARGIN).floor() - toe];
        let depth_factor = 1.0 + 0.1 * (2.0 + y);
        let strength = (0.0, self.friction);
        let section =
            Section::homogeneous(&self.name(), (self.run, depth_factor), strength, margins);
        let variant = Variant {
            cells: 10,
            locking: Locking::SharedStrain,
            associated: true,
        };
        let search = Search {
            bracket: [1.0, 2.0],
            path: Path::Reduce,
            steps: 10,
            young: self.young,
        };
        let overrides = [
            "stages.1.search=\"continuation\"",
            "bodies.0.points_per_cell=9",
            // As shipped.
            "solver.tolerance=1e-9",
            "solver.max_iterations=25",
            "grid.domain.y=[\"0 m\", \"14 m\"]",
        ];
        let case = section.case_with(variant, search, &overrides.map(str::to_owned))?;
        Ok(Found::of(&Computed::new(case)?))
    }

    fn exact(self) -> f64 {
        self.friction.to_radians().tan() * self.run
    }
}

/// Slopes of sand without cohesion, of several stiffnesses at the full level.
pub(super) fn slides_along_its_face(study: &mut Study, level: Level) -> Result<(), CaseError> {
    let is_full = level == Level::Full;
    let (of_chosen, of_beside) = if is_full {
        (&PLACES[..], &PLACES[..3])
    } else {
        (&PLACES[2..3], &PLACES[2..3])
    };
    let at = |(run, friction), place, young| Sand {
        run,
        friction,
        place,
        young,
    };
    let mut all = Vec::new();
    for slope in SLOPES {
        all.extend(of_chosen.iter().map(|&place| at(slope, place, 1e5)));
        if is_full {
            all.extend([1e4, 1e6].map(|young| at(slope, PLACES[2], young)));
        }
    }
    for slope in BESIDE {
        all.extend(of_beside.iter().map(|&place| at(slope, place, 1e5)));
    }
    let found = (all.par_iter().map(|sand| sand.find())).collect::<Result<Vec<_>, CaseError>>()?;
    let mut note =
        "sand without cohesion, cells of H/10: slope; F; F over tan φ / tan β\n".to_owned();
    for (sand, found) in all.iter().zip(&found) {
        let (name, exact) = (sand.name(), sand.exact());
        let _ = writeln!(
            note,
            "  {name}; {:.4}; {:.4}",
            found.factor,
            found.factor / exact
        );
        let run = study.run(found.record(name));
        let band = Band::Between((1.0 - OFF) * exact, (1.0 + OFF) * exact);
        study.check(
            run,
            super::QUANTITY,
            INFINITE_SLOPE.says(exact),
            band,
            found.factor,
        );
    }
    study.notes.push(note);
    Ok(())
}
