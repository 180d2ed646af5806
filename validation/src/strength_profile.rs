//! A strip on soil whose undrained strength grows with depth.

use std::path::Path;

use igimp_cases::CaseError;
use igimp_model::Case;
use igimp_model::check::Band;
use igimp_results::mesh_study::Convergence;
use igimp_results::tables::table::Table;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::coverage::{self, Known, on_cells};
use crate::harness::study::{Level, RunRecord, Study};
use crate::runs::{Computed, corners, mesh, shipped_case};

/// The book's description of the study.
const ABOUT: &str = "A rigid strip on weightless Tresca soil whose strength grows with depth from c_0, bonded, rough and smooth, on the given geometry with shared strain. Limit loads on two meshes are extrapolated to no width of the cell. Mechanisms grow thin as kB/c_0 grows: 6 and 10 take finer cells.";
const BOUNDS: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "finite-element limit analysis of a bonded strip on s_u = c_0 + k z; Davis and Booker 1973",
    locator: "lower and upper bound of V/(B c_0)",
};
const FLOW: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "limit theorems",
    locator: "at the limit load a rigid strip sinks without more load",
};
/// Pressure that is no longer rising grows by less than this share in a tenth of the push \[-\].
const FLAT: f64 = 1e-3;

/// Soil whose strength grows by so much, and how it is computed.
struct Ground {
    /// kB/c_0 \[-\].
    growth: f64,
    /// Cells over the width on the two meshes.
    cells: [u32; 2],
    /// Half the width and the depth of the soil over the width \[-\].
    extent: [f64; 2],
    /// Lower and upper bound, smooth and rough.
    bounds: [[f64; 2]; 2],
    level: Level,
}

static GROUNDS: [Ground; 4] = [
    Ground {
        growth: 1.0,
        cells: [9, 17],
        extent: [2.3, 1.1],
        bounds: [[5.9447, 6.0037], [6.5528, 6.6273]],
        level: Level::Default,
    },
    Ground {
        growth: 2.0,
        cells: [9, 17],
        extent: [2.0, 1.0],
        bounds: [[6.6171, 6.6881], [7.5232, 7.6182]],
        level: Level::Quick,
    },
    Ground {
        growth: 6.0,
        cells: [17, 33],
        extent: [1.5, 0.8],
        bounds: [[8.7667, 8.8783], [10.2858, 10.4407]],
        level: Level::Full,
    },
    Ground {
        growth: 10.0,
        cells: [17, 33],
        extent: [1.3, 0.7],
        bounds: [[10.5867, 10.6989], [12.5273, 12.6699]],
        level: Level::Full,
    },
];

/// A push on one mesh.
struct Push {
    ground: &'static Ground,
    is_rough: bool,
    /// Cells over the width.
    cells: u32,
}

impl Push {
    fn label(&self) -> String {
        let base = if self.is_rough { "rough" } else { "smooth" };
        let (growth, cells) = (self.ground.growth, self.cells);
        format!("kB/c_0 = {growth}, {base}, B/h = {cells}")
    }

    fn case(&self) -> Result<Case<2>, CaseError> {
        let n = f64::from(self.cells);
        let [width, depth] = self.ground.extent;
        let (width, depth) = ((width * n).ceil() / n, (depth * n).round() / n);
        let above = (0.3 * n).ceil() / n;
        let soil = [[0.0, 0.0], [width, 0.0], [width, depth], [0.0, depth]];
        let interface = if self.is_rough { "rough" } else { "smooth" };
        let mut overrides = mesh(1.0 / n, [width, depth + above]);
        overrides.extend([
            "grid.locking=shared-strain".to_owned(),
            "materials.clay.young=\"10 MPa\"".to_owned(),
            format!(
                "materials.clay.cu={{ at_top = \"1 kPa\", gradient = \"{} kPa/m\" }}",
                self.ground.growth
            ),
            "bodies.soil.points_per_cell=4".to_owned(),
            format!("bodies.soil.polygon={}", corners(&soil)),
            format!("loads.footing.from=[\"0 m\", \"{depth} m\"]"),
            format!("loads.footing.to=[\"0.5 m\", \"{depth} m\"]"),
            format!("loads.footing.interface=\"{interface}\""),
            "stages.push to one width.geometry=\"given\"".to_owned(),
            "stages.push to one width.settlement=\"0.004 m\"".to_owned(),
            "stages.push to one width.steps=30".to_owned(),
            "checks=[]".to_owned(),
        ]);
        shipped_case("footing_bonded", overrides)
    }
}

/// The limit load of a push on both meshes, extrapolated to cells of no size.
fn extrapolated(study: &mut Study, run: usize, push: &Push, [coarse, fine]: [f64; 2]) {
    let [lower, upper] = push.ground.bounds[usize::from(push.is_rough)];
    let [wide, narrow] = push.ground.cells.map(|cells| 1.0 / f64::from(cells));
    let known = Known {
        convergence: Convergence::FOOTING,
        truth: [lower, upper],
    };
    let values = [on_cells(wide, coarse), on_cells(narrow, fine)];
    let estimate = study.extrapolate(push.label(), known, &values);
    study.check(
        run,
        format!(
            "V/(B c_0), B/h = {} and {} extrapolated to h = 0 [-]",
            push.ground.cells[0], push.ground.cells[1]
        ),
        BOUNDS.says(0.5 * (lower + upper)),
        Band::Between(0.98 * lower, 1.02 * upper),
        coverage::value(estimate),
    );
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("strength-profile", ABOUT, out)?;
    let grounds = GROUNDS.iter().filter(|ground| ground.level <= level);
    let pushes: Vec<Push> = grounds
        .flat_map(|ground| {
            let bases = [false, true].into_iter();
            bases.flat_map(move |is_rough| {
                ground.cells.map(|cells| Push {
                    ground,
                    is_rough,
                    cells,
                })
            })
        })
        .collect();
    let results = pushes
        .par_iter()
        .map(|push| Computed::new(push.case()?))
        .collect::<Result<Vec<_>, _>>()?;
    let mut table = Table::new(
        "limit_loads",
        &[
            "kB/c0_[-]",
            "rough",
            "B/h",
            "V/(B_c0)_[-]",
            "lower_bound_[-]",
            "upper_bound_[-]",
        ],
    );
    for (pair, computed) in std::iter::zip(pushes.chunks(2), results.chunks(2)) {
        let mut coarse = f64::NAN;
        for (push, result) in std::iter::zip(pair, computed) {
            let record = RunRecord::new(push.label(), &result.report, result.elapsed);
            let run = study.run_to_end(record);
            let points = result.curve("resistance").points(0, 1);
            let end = points.last().map_or(f64::NAN, |point| point[1]);
            let before = points.iter().rev().nth(points.len() / 10);
            study.check(
                run,
                "growth of V in the last tenth of the push [-]",
                FLOW.says(0.0),
                Band::AtMost(FLAT),
                end / before.map_or(f64::NAN, |point| point[1]) - 1.0,
            );
            let [lower, upper] = push.ground.bounds[usize::from(push.is_rough)];
            table.push(vec![
                push.ground.growth,
                f64::from(u8::from(push.is_rough)),
                f64::from(push.cells),
                end,
                lower,
                upper,
            ]);
            if push.cells == push.ground.cells[1] {
                extrapolated(&mut study, run, push, [coarse, end]);
            }
            coarse = end;
        }
    }
    table.write_csv(&study.folder)?;
    Ok(study)
}
