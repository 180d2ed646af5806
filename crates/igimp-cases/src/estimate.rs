//! The size of a case before it runs: particles, cells, unknowns, and about how much memory.
//!
//! The memory model has three parts, each a count times bytes: particles (state, trial and
//! supports), stored entries of the tangent matrix (proportional to the unknowns $`n`$), and fill of
//! its factors ($`n \log_2 n`$, the law of nested dissection in the plane). The bytes were fitted
//! to the peak memory of slopes with 500 to 110 000 unknowns and 4 to 9 particles per cell, and
//! reproduce it within a tenth from 7 000 unknowns on; small cases are estimated too high.

use igimp_shape::{Axis, Grid, Scratch, supports};

use crate::case::{Case, LoadKind, Side, StageKind};
use crate::error::CaseError;
use crate::seed::fill_polygon;

/// Program, tables and buffers \[bytes\].
const BASE: f64 = 2e7;
/// State, trial and supports of a particle \[bytes\].
const PER_PARTICLE: f64 = 2e3;
/// Matrix, its copies and its pattern \[bytes per unknown\].
const PER_UNKNOWN: f64 = 3e3;
/// Factors, for each unknown and each doubling of the unknowns \[bytes\].
const PER_FILL: f64 = 1.5e2;
/// Trials that a strength reduction is taken to make.
const TRIALS: f64 = 9.0;

/// The size of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Particles.
    pub particles: usize,
    /// Cells of the grid.
    pub cells: usize,
    /// Unknowns of the first step.
    pub unknowns: usize,
    /// Memory \[bytes\].
    pub bytes: f64,
    /// Steps of all stages, each trial of a strength reduction included, times unknowns \[-\].
    pub work: f64,
}

/// The size of a case.
///
/// # Errors
/// [`CaseError`] for a grid that cannot be made and bodies that do not lie on it.
pub fn estimate(case: &Case) -> Result<Estimate, CaseError> {
    let spec = &case.grid;
    let grid = Grid::new([
        Axis::uniform(spec.lower[0], spec.cell[0], spec.cells[0])?,
        Axis::uniform(spec.lower[1], spec.cell[1], spec.cells[1])?,
    ]);
    let mut active = vec![false; grid.node_count()];
    let (mut scratch, mut list) = (Scratch::default(), Vec::new());
    let mut particles = 0;
    for body in &case.bodies {
        let seeds = fill_polygon(&grid, &body.polygon, body.per_direction, 1.0, 0)?;
        for seed in &seeds {
            let basis = &*case.method.basis;
            supports(
                &grid,
                basis,
                &seed.x,
                &seed.half_length,
                &mut scratch,
                &mut list,
            )?;
            for support in &list {
                active[support.node] = true;
            }
        }
        particles += seeds.len();
    }
    let unknowns = (0..active.len())
        .filter(|&node| active[node])
        .map(|node| {
            let held = held(case, grid.node_position(node));
            held.iter().filter(|&&held| !held).count()
        })
        .sum();
    Ok(Estimate {
        particles,
        cells: grid.cell_count(),
        unknowns,
        bytes: memory(particles, unknowns),
        work: steps(case) * unknowns as f64,
    })
}

/// Memory of a run \[bytes\].
pub fn memory(particles: usize, unknowns: usize) -> f64 {
    let [particle, unknown] = per_item(unknowns);
    BASE + particle * particles as f64 + unknown * unknowns as f64
}

/// Memory of a particle, and of an unknown among so many with its share of the fill \[bytes\].
pub fn per_item(unknowns: usize) -> [f64; 2] {
    let doublings = (unknowns as f64).max(2.0).log2();
    [PER_PARTICLE, PER_UNKNOWN + PER_FILL * doublings]
}

/// A number of bytes as a reader likes it.
pub fn readable(bytes: f64) -> String {
    let mebibytes = bytes / 1_048_576.0;
    if mebibytes < 1000.0 {
        // Two significant digits are more than the model knows.
        let unit = if mebibytes < 100.0 { 5.0 } else { 10.0 };
        format!("{:.0} MiB", (mebibytes / unit).ceil() * unit)
    } else {
        format!("{:.1} GiB", mebibytes / 1024.0)
    }
}

/// Load steps of all stages when none is cut.
fn steps(case: &Case) -> f64 {
    case.stages
        .iter()
        .map(|stage| {
            let trials = match &stage.kind {
                StageKind::StrengthReduction(search) => TRIALS + search.factors.len() as f64,
                _ => 1.0,
            };
            trials * stage.steps as f64
        })
        .sum()
}

/// Which components of a node are held by supports and footings.
fn held(case: &Case, x: [f64; 2]) -> [bool; 2] {
    let (lower, upper) = (case.grid.lower, case.grid.upper());
    let near = |a: f64, b: f64, axis: usize| (a - b).abs() < 1e-6 * case.grid.cell[axis];
    let sides = &case.boundaries;
    let mut held = [false; 2];
    for (side, axis, at) in [
        (sides.left, 0, lower[0]),
        (sides.right, 0, upper[0]),
        (sides.bottom, 1, lower[1]),
        (sides.top, 1, upper[1]),
    ] {
        if near(x[axis], at, axis) {
            held[axis] |= side != Side::Free;
            held[1 - axis] |= side == Side::Fixed;
        }
    }
    for fixed in &sides.boxes {
        let inside = (0..2).all(|axis| {
            let slack = 1e-6 * case.grid.cell[axis];
            fixed.lower[axis] - slack <= x[axis] && x[axis] <= fixed.upper[axis] + slack
        });
        if inside {
            held = [held[0] || fixed.fix[0], held[1] || fixed.fix[1]];
        }
    }
    for load in &case.loads {
        if let LoadKind::RigidFooting {
            from, to, rough, ..
        } = load.kind
        {
            let slack = 1e-6 * case.grid.cell[0];
            let below = from[0].min(to[0]) - slack <= x[0] && x[0] <= from[0].max(to[0]) + slack;
            if below && near(x[1], from[1], 1) {
                held = [held[0] || rough, true];
            }
        }
    }
    held
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::FixedBox;
    use crate::input::CaseFile;

    fn case() -> Case {
        let text = "igimp = 1\n[case]\ntitle = \"block\"\ngravity = \"9.81 m/s2\"\n\
            [grid]\ncell = \"0.5 m\"\ndomain = { x = [\"0 m\", \"4 m\"], y = [\"0 m\", \"4 m\"] }\n\
            [materials.clay]\nmodel = \"elastic\"\nunit_weight = \"18 kN/m3\"\n\
            young = \"10 MPa\"\npoisson = 0.3\n\
            [[bodies]]\nname = \"block\"\nmaterial = \"clay\"\npoints_per_cell = 4\n\
            polygon = [[\"0 m\", \"0 m\"], [\"2 m\", \"0 m\"], [\"2 m\", \"2 m\"], \
            [\"0 m\", \"2 m\"]]\n\
            [boundaries]\nleft = \"roller\"\nright = \"roller\"\nbottom = \"fixed\"\n\
            [[stages]]\nname = \"own weight\"\ntype = \"gravity\"\nsteps = 5\n";
        CaseFile::parse("block.toml", text, &[])
            .unwrap()
            .case()
            .clone()
    }

    #[test]
    fn a_block_is_counted() {
        let size = estimate(&case()).unwrap();
        assert_eq!((size.particles, size.cells), (64, 64));
        // 5 x 5 nodes carry soil; 5 at the bottom are fixed, 4 at the left roll. GIMP domains end
        // on the cell's edge, so no node beyond is touched.
        assert_eq!(size.unknowns, 2 * 20 - 4);
        assert!((size.work - 5.0 * 36.0).abs() < 1e-9);
    }

    #[test]
    fn boxes_hold_what_they_say() {
        let mut case = case();
        case.boundaries.boxes.push(FixedBox {
            name: "wall".into(),
            lower: [2.0, 0.5],
            upper: [2.0, 2.0],
            fix: [true, false],
        });
        assert_eq!(estimate(&case).unwrap().unknowns, 36 - 4);
    }

    #[test]
    fn memory_is_that_of_particles_and_unknowns() {
        let [particle, unknown] = per_item(1 << 19);
        let sum = 1e6 * particle + f64::from(1 << 19) * unknown;
        assert!((memory(1_000_000, 1 << 19) - BASE - sum).abs() < 1.0);
        assert!((unknown - PER_UNKNOWN - 19.0 * PER_FILL).abs() < 1e-9);
    }

    #[test]
    fn amounts_are_readable() {
        assert_eq!(readable(12e6), "15 MiB");
        assert_eq!(readable(512e6), "490 MiB");
        assert_eq!(readable(3.2e9), "3.0 GiB");
    }
}
