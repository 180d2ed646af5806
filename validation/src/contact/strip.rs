//! A strip on Tresca soil at small strain: edges anywhere in their cell, eccentric load that lets the base
//! lift off, and vertical with horizontal load.

mod push;

use std::f64::consts::PI;
use std::path::Path;

use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_results::mesh_study::{Convergence, estimate};
use rayon::prelude::*;

use self::push::{Load, Push, Scheme};
use crate::harness::oracle::{Expected, Oracle, OracleKind};
use crate::harness::study::coverage::{self, Known, on_cells};
use crate::harness::study::{Level, RunRecord, Study};

/// The book's description of the study.
const ABOUT: &str = "A rigid strip on weightless Tresca soil, on the given geometry: pushed down with its edges anywhere in their cell, under an eccentric load, free to tilt and to lift off, and at an angle. Shared strain with sharp edges is held against limit analysis mesh by mesh, B-bar with edges rounded by half a cell, as case files have it, by two meshes.";
const BOUNDS: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "finite-element limit analysis of a strip with eccentric load, no tension on its base",
    locator: "lower and upper bound of V/(B s_u)",
};
const PRANDTL: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Prandtl 1920",
    locator: "V/(B s_u) = 2 + π",
};
const GREEN: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Green 1954",
    locator: "V/(B s_u) = 1 + π/2 + arccos η + √(1 − η²), η = H/(B s_u) ≤ 1",
};

/// Where the edges stand in their cell \[-\].
const PLACES: [f64; 5] = [0.0, 0.2, 0.4, 0.6, 0.8];
/// Sideways motion over settlement \[-\].
const RATIOS: [f64; 3] = [1.5, 2.0, 3.0];
/// Cells over the width on two meshes that are extrapolated.
const MESHES: [usize; 2] = [9, 17];

/// Lower and upper bound of V/(B s_u) by eccentricity over width, rough and smooth.
const TABLE: [(f64, [f64; 2], [f64; 2]); 3] = [
    (0.1, [4.1771, 4.2443], [4.0542, 4.1311]),
    (0.2, [3.1353, 3.1975], [3.0242, 3.1026]),
    (0.4, [1.0382, 1.1019], [0.9749, 1.0447]),
];

/// V/(B s_u) of a rough strip under inclined load at H/(B s_u) (Green 1954).
fn green(eta: f64) -> f64 {
    let eta = eta.clamp(0.0, 1.0);
    1.0 + 0.5 * PI + eta.acos() + (1.0 - eta * eta).sqrt()
}

/// How much larger than Green's the load `[V, H]` is, along the ray from no load \[-\].
fn over_green([vertical, horizontal]: [f64; 2]) -> f64 {
    let lies_within = |share: f64| {
        let eta = horizontal / share;
        eta <= 1.0 && vertical / share <= green(eta)
    };
    let (mut low, mut high) = (1e-3, 1e3);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if lies_within(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

/// The pushes of a level; those of a lower one are among them.
fn pushes(level: Level) -> Vec<Push> {
    let mut pushes = Vec::new();
    let mut push = |scheme, load, rough, cells| {
        pushes.push(Push {
            scheme,
            load,
            rough,
            cells,
        });
    };
    let meshes: &[usize] = match level {
        Level::Quick | Level::Default => &MESHES[..1],
        Level::Full => &MESHES,
    };
    for rough in [false, true] {
        for place in PLACES {
            if level == Level::Quick && place != 0.0 {
                continue;
            }
            for &cells in meshes {
                push(Scheme::Sharp, Load::Centric { place }, rough, cells);
            }
            if level != Level::Quick {
                for cells in MESHES {
                    push(Scheme::Rounded, Load::Centric { place }, rough, cells);
                }
            }
        }
        for (e, ..) in TABLE {
            push(Scheme::Sharp, Load::Eccentric(e), rough, MESHES[0]);
            if level == Level::Full && e < 0.3 {
                for cells in MESHES {
                    push(Scheme::Rounded, Load::Eccentric(e), rough, cells);
                }
            }
        }
    }
    if level != Level::Quick {
        push(Scheme::Rounded, Load::Sideways, true, MESHES[0]);
    }
    if level == Level::Full {
        for ratio in RATIOS {
            for cells in MESHES {
                push(Scheme::Rounded, Load::Inclined(ratio), true, cells);
            }
        }
    }
    pushes
}

/// The known values of a push: the quantity, its value, the band on one mesh if it is claimed there, and that of
/// two meshes extrapolated.
fn known(push: &Push) -> (&'static str, Expected, Option<Band>, Band) {
    let is_sharp = push.scheme == Scheme::Sharp;
    match push.load {
        Load::Centric { .. } => {
            // Half a cell at each edge of a smooth strip is missed by more on nine cells.
            let is_claimed = is_sharp || push.rough || push.cells > MESHES[0];
            let band = is_claimed.then_some(Band::Relative(0.05));
            let expected = PRANDTL.says(2.0 + PI);
            ("V/(B s_u)", expected, band, Band::Relative(0.015))
        }
        Load::Eccentric(e) => {
            let row = TABLE.iter().find(|row| row.0.total_cmp(&e).is_eq());
            let row = row.expect("the eccentricity is in the table");
            let [lower, upper] = if push.rough { row.1 } else { row.2 };
            let band = Band::Between(0.98 * lower, 1.02 * upper);
            let is_claimed = is_sharp || push.cells > MESHES[0];
            let expected = BOUNDS.says(0.5 * (lower + upper));
            ("V/(B s_u)", expected, is_claimed.then_some(band), band)
        }
        Load::Inclined(_) => {
            let expected = GREEN.says(1.0);
            ("(V, H) over Green's", expected, None, Band::Relative(0.03))
        }
        Load::Sideways => {
            // It depends on how far the strip is pushed, and in which steps.
            let expected = GREEN.says(1.0);
            ("H/(B s_u)", expected, None, Band::Relative(0.03))
        }
    }
}

/// Least and greatest V/(B s_u) of a push that limit analysis knows.
fn bounds(push: &Push) -> Option<[f64; 2]> {
    match push.load {
        Load::Centric { .. } => Some([2.0 + PI; 2]),
        Load::Eccentric(e) => {
            let row = TABLE.iter().find(|row| row.0.total_cmp(&e).is_eq())?;
            Some(if push.rough { row.1 } else { row.2 })
        }
        Load::Inclined(_) | Load::Sideways => None,
    }
}

/// The number that is held against the known one, from V/(B s_u) and H/(B s_u).
fn measured(push: &Push, at_end: [f64; 2]) -> f64 {
    match push.load {
        Load::Centric { .. } | Load::Eccentric(_) => at_end[0],
        Load::Inclined(_) => over_green(at_end),
        Load::Sideways => at_end[1],
    }
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-strip", ABOUT, out)?;
    let pushes = pushes(level);
    let done = pushes
        .par_iter()
        .map(Push::run)
        .collect::<Result<Vec<_>, CaseError>>()?;
    let mut ends: Vec<[f64; 2]> = Vec::new();
    for (k, (push, (record, curve))) in pushes.iter().zip(done).enumerate() {
        curve.write_csv(&study.folder)?;
        let last = curve.rows.last();
        let end = last.map_or([f64::NAN; 2], |row| [row[1], row[2]]);
        ends.push(end);
        let (quantity, expected, band, extrapolated) = known(push);
        // A number that is only printed on its mesh is extrapolated, save for the push sideways.
        let run = match push.load {
            Load::Sideways => study.run(record),
            _ => study.run_to_end(record),
        };
        match band {
            Some(band) => study.check(
                run,
                format!("{quantity} at the end [-]"),
                expected,
                band,
                measured(push, end),
            ),
            None => tell(&mut study, run, push, end),
        }
        let Some(coarse) = k
            .checked_sub(1)
            .map(|coarse| (&pushes[coarse], ends[coarse]))
        else {
            continue;
        };
        let is_pair = Push {
            cells: push.cells,
            ..*coarse.0
        } == *push;
        if is_pair {
            let sizes = [coarse.0.cells, push.cells].map(|cells| 1.0 / cells as f64);
            let of = |k: usize| [on_cells(sizes[0], coarse.1[k]), on_cells(sizes[1], end[k])];
            let convergence = Convergence::CONTACT;
            let value = |k: usize| coverage::value(estimate(&of(k), convergence));
            let limit = match bounds(push) {
                None => [value(0), value(1)],
                Some(truth) => {
                    let known = Known { convergence, truth };
                    let name = format!("contact strip, {}", study.runs[run].variant);
                    let vertical = study.extrapolate(name, known, &of(0));
                    [coverage::value(vertical), value(1)]
                }
            };
            study.check(
                run,
                format!(
                    "{quantity} extrapolated from B/h = {} and {} [-]",
                    MESHES[0], MESHES[1]
                ),
                expected,
                extrapolated,
                measured(push, limit),
            );
        }
    }
    Ok(study)
}

/// Tells of a push that is not claimed on its mesh.
fn tell(study: &mut Study, run: usize, push: &Push, end: [f64; 2]) {
    let RunRecord {
        variant, outcome, ..
    } = &study.runs[run];
    let (quantity, expected, ..) = known(push);
    let share = measured(push, end) / expected.value - 1.0;
    let loads = match push.load {
        // V is given there.
        Load::Sideways => format!("H/(B s_u) = {:.3}", end[1]),
        _ => format!("V/(B s_u) = {:.3}, H/(B s_u) = {:.3}", end[0], end[1]),
    };
    let note = format!(
        "contact-strip, {variant}: {loads}, {quantity} off by {:+.1} %; {outcome}",
        100.0 * share
    );
    study.notes.push(note);
}
