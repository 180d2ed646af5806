//! Cases of plane strain as slices in space with smooth sides: the same to round-off.

pub(crate) mod ground;

use std::collections::HashMap;
use std::path::Path;

use igimp_assembly::Particles;
use igimp_cases::CaseError;
use igimp_input::CaseFile;
use igimp_model::check::Band;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{RunRecord, Study};
use crate::runs::{Computed, corners};

/// The book's description of the study.
const ABOUT: &str = "Cases of plane strain are computed again as slices in space, one cell across, between smooth sides: a soft column, slopes of three soils that yield under their weight, a strip of pressure; slopes with water tables, ratios and given pressures, drained and undrained, with drawdown; ground that is dug, filled and treated; a face with an anchor and nails, one of each across the slice. Displacements and stresses, pore pressures and tensions are the plane's.";
const PLANE_STRAIN: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "plane strain is a part of space",
    locator: "the same fields, nothing of them across; largest difference over largest value",
};
/// Size of a cell, and across \[m\].
const CELL: f64 = 1.0;
/// Axes of space for those of plane strain: right, up, across.
const AXES: [usize; 3] = [0, 2, 1];

/// A case of the plane that is a slice as well.
struct Sheet {
    name: &'static str,
    gravity: &'static str,
    locking: &'static str,
    polygon: &'static [[f64; 2]],
    /// Width and height of the grid \[m\].
    domain: [f64; 2],
    material: &'static str,
    /// Ends of a strip of pressure \[m\] and its pressure \[kPa\].
    pressure: Option<([[f64; 2]; 2], f64)>,
    stage: &'static str,
}

const COLUMN: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 4.0], [0.0, 4.0]];
const SLOPE: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [10.0, 0.0],
    [10.0, 2.0],
    [7.0, 2.0],
    [3.0, 6.0],
    [0.0, 6.0],
];
const BLOCK: [[f64; 2]; 4] = [[0.0, 0.0], [6.0, 0.0], [6.0, 3.0], [0.0, 3.0]];
const SOFT: &str = "model = \"elastic\"\nyoung = \"200 kPa\"\npoisson = 0.3";
const FRICTIONAL: &str = "model = \"mohr-coulomb\"\nyoung = \"20 MPa\"\npoisson = 0.3\ncohesion = \"6 kPa\"\nfriction = \"25 deg\"\ndilation = \"10 deg\"";
const VON_MISES: &str =
    "model = \"von-mises\"\nyoung = \"20 MPa\"\npoisson = 0.45\ncu = \"17 kPa\"";
const TRESCA: &str = "model = \"tresca\"\nyoung = \"20 MPa\"\npoisson = 0.45\ncu = \"17 kPa\"";
const WEIGHT: &str = "type = \"gravity\"\nsteps = 10";
const LOAD: &str = "type = \"load\"\nload = \"strip\"\nsteps = 10";

const fn slope(name: &'static str, locking: &'static str, material: &'static str) -> Sheet {
    Sheet {
        name,
        gravity: "9.81 m/s2",
        locking,
        polygon: &SLOPE,
        domain: [10.0, 7.0],
        material,
        pressure: None,
        stage: WEIGHT,
    }
}

static SHEETS: [Sheet; 6] = [
    Sheet {
        name: "soft column",
        gravity: "9.81 m/s2",
        locking: "b-bar",
        polygon: &COLUMN,
        domain: [1.0, 4.0],
        material: SOFT,
        pressure: None,
        stage: WEIGHT,
    },
    slope("slope, Mohr–Coulomb, B-bar", "b-bar", FRICTIONAL),
    slope("slope, von Mises, B-bar", "b-bar", VON_MISES),
    slope("slope, Tresca, B-bar", "b-bar", TRESCA),
    slope(
        "slope, von Mises, shared strain",
        "shared-strain",
        VON_MISES,
    ),
    Sheet {
        name: "strip of pressure, Tresca, B-bar",
        gravity: "0 m/s2",
        locking: "b-bar",
        polygon: &BLOCK,
        domain: [6.0, 4.0],
        material: TRESCA,
        pressure: Some(([[0.0, 3.0], [2.0, 3.0]], 60.0)),
        stage: LOAD,
    },
];

impl Sheet {
    fn text(&self, in_space: bool) -> String {
        let [width, height] = self.domain;
        let (analysis, points, domain) = if in_space {
            (
                "3d",
                8,
                format!("y = [\"0 m\", \"{CELL} m\"], z = [\"0 m\", \"{height} m\"]"),
            )
        } else {
            ("plane-strain", 4, format!("y = [\"0 m\", \"{height} m\"]"))
        };
        let (across, sides) = if in_space {
            (
                format!("across = [\"0 m\", \"{CELL} m\"]"),
                "front = \"roller\"\nback = \"roller\"",
            )
        } else {
            (String::new(), "")
        };
        let load = self.pressure.map_or_else(String::new, |(ends, pressure)| {
            let [from, to] = std::array::from_fn(|end| {
                let [x, y] = ends[end];
                if in_space {
                    format!("[\"{x} m\", \"{} m\", \"{y} m\"]", CELL * end as f64)
                } else {
                    format!("[\"{x} m\", \"{y} m\"]")
                }
            });
            format!(
                "[[loads]]\nname = \"strip\"\ntype = \"pressure\"\nfrom = {from}\nto = {to}\npressure = \"{pressure} kPa\""
            )
        });
        let Self {
            name,
            gravity,
            locking,
            material,
            stage,
            polygon,
            ..
        } = self;
        let polygon = corners(polygon);
        format!(
            "igimp = 1
[case]
title = \"{name}\"
analysis = \"{analysis}\"
gravity = \"{gravity}\"
[grid]
cell = \"{CELL} m\"
domain = {{ x = [\"0 m\", \"{width} m\"], {domain} }}
locking = \"{locking}\"
small_cuts = {{ below = 1e-4 }}
[materials.soil]
unit_weight = \"20 kN/m3\"
{material}
[[bodies]]
name = \"soil\"
material = \"soil\"
points_per_cell = {points}
polygon = {polygon}
{across}
[boundaries]
left = \"roller\"
right = \"roller\"
bottom = \"fixed\"
{sides}
{load}
[[stages]]
name = \"stage\"
{stage}
[solver]
tolerance = 1e-11
"
        )
    }

    /// Both runs.
    fn run(&self) -> Result<(Computed<2>, Computed<3>), CaseError> {
        computed(self.name, [self.text(false), self.text(true)])
    }
}

/// Largest difference of displacement and of stress over the largest value \[-\]; infinite where a particle of space
/// has none of the plane beside it.
pub(super) fn differences(plane: &Particles<2>, space: &Particles<3>) -> [f64; 2] {
    let key = |x: f64, y: f64| [x, y].map(|x| (1e6 * x / CELL).round() as i64);
    let mut at = HashMap::new();
    let (mut largest, mut worst) = ([0.0_f64; 2], [0.0_f64; 2]);
    for particle in 0..plane.len() {
        let (x, u) = (plane.x[particle], plane.displacement[particle]);
        at.insert(key(x[0] - u[0], x[1] - u[1]), particle);
        let sigma = &plane.sigma[particle];
        for i in 0..2 {
            largest[0] = largest[0].max(u[i].abs());
        }
        for i in 0..3 {
            for j in 0..3 {
                largest[1] = largest[1].max(sigma[i][j].abs());
            }
        }
    }
    for particle in 0..space.len() {
        let (x, u) = (space.x[particle], space.displacement[particle]);
        let Some(&other) = at.get(&key(x[0] - u[0], x[2] - u[2])) else {
            return [f64::INFINITY; 2];
        };
        let flat = plane.displacement[other];
        let flat = [flat[0], flat[1], 0.0];
        for i in 0..3 {
            worst[0] = worst[0].max((u[AXES[i]] - flat[i]).abs());
            for j in 0..3 {
                let sigma = space.sigma[particle][AXES[i]][AXES[j]];
                worst[1] = worst[1].max((sigma - plane.sigma[other][i][j]).abs());
            }
        }
    }
    [worst[0] / largest[0], worst[1] / largest[1]]
}

/// Runs a case file of the plane, and that of its slice.
pub(super) fn computed(
    name: &str,
    [plane, space]: [String; 2],
) -> Result<(Computed<2>, Computed<3>), CaseError> {
    let plane = CaseFile::parse(name, &plane, &[])?;
    let space = CaseFile::parse(name, &space, &[])?;
    Ok((
        Computed::new(plane.into_case())?,
        Computed::new(space.case_in_space().clone())?,
    ))
}

/// Adds both runs to the study, and their differences.
pub(super) fn check_pair(
    study: &mut Study,
    name: &str,
    plane: &Computed<2>,
    space: &Computed<3>,
    found: &[(&str, f64)],
) {
    let record = RunRecord::new(format!("{name}, plane"), &plane.report, plane.elapsed);
    study.run_to_end(record);
    let run = study.run_to_end(RunRecord::new(name, &space.report, space.elapsed));
    for (field, found) in found {
        study.check(
            run,
            format!("difference of {field} from the plane [-]"),
            PLANE_STRAIN.says(0.0),
            Band::AtMost(1e-9),
            *found,
        );
    }
}

/// Runs the study; it is short enough to be the same at every level.
pub(crate) fn study(out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("space-slice", ABOUT, out)?;
    let done = SHEETS
        .par_iter()
        .map(Sheet::run)
        .collect::<Result<Vec<_>, CaseError>>()?;
    for (sheet, (plane, space)) in SHEETS.iter().zip(done) {
        let [displacement, stress] = differences(plane.particles(), space.particles());
        let found = [("displacement", displacement), ("stress", stress)];
        check_pair(&mut study, sheet.name, &plane, &space, &found);
    }
    super::slice::ground::add(&mut study)?;
    Ok(study)
}
