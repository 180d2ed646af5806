//! What a case will cost before it runs: particles, cells, unknowns, memory ([`estimate`]) and time
//! ([`time`]).
//!
//! The memory model counts particles (state, trial and supports), stored entries of the tangent
//! matrix (proportional to the unknowns $`n`$), and fill of its factors ($`n \log_2 n`$, the law of
//! nested dissection in the plane). The bytes were fitted to the peak memory of slopes with 500 to
//! 110 000 unknowns and 4 to 9 particles per cell. Pictures are drawn when the matrix is gone, as
//! many at a time as there are threads: the larger of the two counts, and half of the smaller one,
//! since not all memory that is let go serves again. A search along the reduction of strength keeps
//! several states.

pub mod room;
pub mod speed;
pub mod time;
pub mod watch;

use igimp_shape::{Scratch, supports};
use igimp_solver::linear::SolverKind;

use crate::case::{Case, LoadKind, ReductionPath, Side, StageKind};
use crate::error::CaseError;
use crate::mesh_study::plan;
use crate::seed::fill;
use crate::summary::{Expected, StageSummary};
use speed::Speed;
use time::Time;

/// Program, tables and buffers \[bytes\].
const BASE: f64 = 2.2e7;
/// State, trial and supports of a particle \[bytes\].
const PER_PARTICLE: f64 = 2e3;
/// The states that a search along the reduction of strength keeps \[bytes per particle\].
const PER_SEARCHED: f64 = 2e3;
/// Matrix, its copies and its pattern \[bytes per unknown\].
const PER_UNKNOWN: f64 = 3e3;
/// Factors, for each unknown and each doubling of the unknowns \[bytes\].
const PER_FILL: f64 = 1.5e2;
/// The same in space, where a particle touches up to 27 nodes \[bytes\].
const PER_PARTICLE_IN_SPACE: f64 = 4e3;
/// Matrix, its copies and its pattern in space \[bytes per unknown\].
const PER_UNKNOWN_IN_SPACE: f64 = 7e3;
/// Factors of a symmetric matrix in space and what waits for them \[bytes\], times $`n^{4/3}`$.
const PER_FILL_IN_SPACE: f64 = 6.5e2;
/// The same of an unsymmetric one, over that \[-\].
const UNSYMMETRIC: f64 = 1.9;
/// Factors in single precision with the vectors of the iteration, over those in double \[-\].
const IN_SINGLE: f64 = 0.55;
/// What an iteration with multigrid holds instead of factors \[bytes per unknown\].
const PER_ITERATED: f64 = 4e3;
/// Unknowns in space from which on systems are solved by iteration: cubes go over at 24 000 where the tangent is not
/// symmetric and at 31 000 where it is.
pub(crate) const ITERATED: usize = 30_000;
/// A picture of 1920 x 1290 pixels of four bytes while it is drawn and packed \[bytes\].
const PER_PICTURE: f64 = 2.1 * 1920.0 * 1290.0 * 4.0;
/// The view in space of a report while it is packed \[bytes\]; slopes and footings of 5 000 to 9 000 particles took 42 to 89 MiB
/// beyond the rest.
const VIEW_IN_SPACE: f64 = 6.5e7;
/// Share of the smaller of the two parts, solving and drawing, that is not taken from what the
/// other has let go \[-\].
const AGAIN: f64 = 0.5;
/// Trials that a strength reduction is taken to make.
const TRIALS: f64 = 9.0;

/// The size of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Particles, the most that are there at once.
    pub particles: usize,
    /// Cells of the grid.
    pub cells: usize,
    /// Unknowns of a step with all bodies there.
    pub unknowns: usize,
    /// Memory on the threads of the current pool \[bytes\].
    pub bytes: f64,
    /// Steps of all stages, each trial of a strength reduction included, times unknowns \[-\].
    pub work: f64,
}

/// The size of a case.
///
/// # Errors
/// [`CaseError`] for a grid that cannot be made and bodies that do not lie on it.
pub fn estimate<const D: usize>(case: &Case<D>) -> Result<Estimate, CaseError> {
    let grid = case.grid.grid()?;
    let mut active = vec![false; grid.node_count()];
    let (mut scratch, mut list) = (Scratch::default(), Vec::new());
    let mut by_body = Vec::new();
    for body in &case.bodies {
        let seeds = fill(&grid, &*body.region, body.per_direction, 1.0, 0)?;
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
        by_body.push(seeds.len());
    }
    let count = |there: &[bool]| -> usize {
        let own = std::iter::zip(&by_body, there);
        own.map(|(count, &there)| if there { *count } else { 0 })
            .sum()
    };
    let at_start: Vec<bool> = case.bodies.iter().map(|body| body.from_start).collect();
    let stages = (0..case.stages.len()).map(|stage| count(&case.bodies_after(stage)));
    let particles = stages.fold(count(&at_start), usize::max);
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
        bytes: memory(case, particles, unknowns),
        work: steps(case) * unknowns as f64,
    })
}

/// Memory of runs that need so much each: of all when they go side by side, else of the largest
/// \[bytes\].
pub fn together(bytes: &[f64]) -> f64 {
    if watch::side_by_side(bytes) > 1 {
        bytes.iter().sum()
    } else {
        bytes.iter().copied().fold(0.0, f64::max)
    }
}

/// What a run is thought to cost on this computer; of a study of the mesh error, all its meshes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expectation {
    /// Time of the planned steps.
    pub time: Time,
    /// Memory \[bytes\].
    pub bytes: f64,
    /// The speed that the time was found for.
    pub speed: Speed,
}

impl Expectation {
    /// Measures the computer and estimates a case.
    ///
    /// # Errors
    /// As [`estimate`] and [`Speed::measured`].
    pub fn of<const D: usize>(case: &Case<D>) -> Result<Self, CaseError> {
        let speed = Speed::measured()?;
        let meshes = plan::meshes(case);
        let mut each = Vec::new();
        for mesh in &meshes {
            let size = estimate(mesh)?;
            each.push((time::time(mesh, &size, speed), size.bytes));
        }
        Ok(Self {
            time: Time {
                seconds: each.iter().map(|(time, _)| time.seconds).sum(),
                open_ended: each.iter().any(|(time, _)| time.open_ended),
                threads: rayon::current_num_threads(),
            },
            bytes: together(&each.iter().map(|(_, bytes)| *bytes).collect::<Vec<_>>()),
            speed,
        })
    }

    /// As it is told after a run with these stages.
    pub(crate) fn told<const D: usize>(&self, case: &Case<D>, stages: &[StageSummary]) -> Expected {
        Expected {
            seconds: self.time.seconds,
            open_ended: self.time.open_ended,
            threads: self.time.threads,
            bytes: self.bytes,
            seconds_of_steps_taken: time::time_of_steps_taken(case, self.speed, stages).ok(),
        }
    }
}

/// Memory of a run on the threads of the current pool \[bytes\].
fn memory<const D: usize>(case: &Case<D>, particles: usize, unknowns: usize) -> f64 {
    let [particle, unknown] = per_item(D, storage(case, unknowns), unknowns);
    let searches = case.stages.iter().any(|stage| {
        matches!(&stage.kind, StageKind::StrengthReduction(search)
            if search.path == ReductionPath::Reduce)
    });
    let kept = if searches { PER_SEARCHED } else { 0.0 };
    let solving = (particle + kept) * particles as f64 + unknown * unknowns as f64;
    let drawing = PER_PICTURE * rayon::current_num_threads() as f64 + kept * particles as f64;
    let view = if D == 3 && case.output.report {
        VIEW_IN_SPACE
    } else {
        0.0
    };
    BASE + view + solving.max(drawing) + AGAIN * solving.min(drawing)
}

/// Whether the systems of a case are expected to be solved by iteration.
pub fn is_iterated<const D: usize>(case: &Case<D>, unknowns: usize) -> bool {
    match case.solver.linear {
        SolverKind::Auto => D == 3 && unknowns > ITERATED,
        SolverKind::Multigrid => true,
        _ => false,
    }
}

/// What the linear solver is expected to keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Storage {
    /// Grids of an iteration.
    Grids,
    /// Factors, and how much they take over those of a symmetric matrix in double precision in space, and in the
    /// plane \[-\].
    Factors {
        /// In space.
        space: f64,
        /// In the plane, where both kinds were counted together.
        plane: f64,
    },
}

/// What the linear solver of a case is expected to keep.
pub fn storage<const D: usize>(case: &Case<D>, unknowns: usize) -> Storage {
    if is_iterated(case, unknowns) {
        return Storage::Grids;
    }
    let plane = if case.solver.linear == SolverKind::Single {
        IN_SINGLE
    } else {
        1.0
    };
    let space = if is_symmetric(case) {
        plane
    } else {
        UNSYMMETRIC * plane
    };
    Storage::Factors { space, plane }
}

/// Whether all tangents of a case are symmetric.
fn is_symmetric<const D: usize>(case: &Case<D>) -> bool {
    (case.materials.iter())
        .all(|material| material.law().is_ok_and(|law| law.has_symmetric_tangent()))
}

/// Which linear solver a case is expected to use, and why.
pub fn linear_solver<const D: usize>(case: &Case<D>, unknowns: usize) -> String {
    let symmetric = is_symmetric(case);
    let [direct, iteration] = if symmetric {
        ["Cholesky", "conjugate gradients with multigrid"]
    } else {
        ["LU", "GMRES with multigrid"]
    };
    match case.solver.linear {
        SolverKind::Auto if is_iterated(case, unknowns) => {
            format!("{iteration}: in space with so many unknowns a factorisation takes longer")
        }
        SolverKind::Auto => direct.to_owned(),
        SolverKind::Multigrid => format!("{iteration}, as asked for"),
        SolverKind::Single => {
            format!("{direct} in single precision and an iteration with it, as asked for")
        }
        SolverKind::FaerCholesky => "Cholesky of faer, as asked for".to_owned(),
        SolverKind::NalgebraCholesky => "Cholesky of nalgebra, as asked for".to_owned(),
        SolverKind::MultifrontalCholesky => "Cholesky, as asked for".to_owned(),
        SolverKind::Multifrontal => "LU, as asked for".to_owned(),
        SolverKind::SprsBiCgStab => "bi-conjugate gradients, as asked for".to_owned(),
    }
}

/// Memory of a particle, and of an unknown among so many with its share of the fill \[bytes\], in so many dimensions.
pub fn per_item(dimensions: usize, storage: Storage, unknowns: usize) -> [f64; 2] {
    if dimensions == 3 {
        let solver = match storage {
            Storage::Grids => PER_ITERATED,
            Storage::Factors { space, .. } => space * PER_FILL_IN_SPACE * (unknowns as f64).cbrt(),
        };
        return [PER_PARTICLE_IN_SPACE, PER_UNKNOWN_IN_SPACE + solver];
    }
    let doublings = (unknowns as f64).max(2.0).log2();
    let fill = match storage {
        Storage::Grids => 1.0,
        Storage::Factors { plane, .. } => plane,
    };
    [PER_PARTICLE, PER_UNKNOWN + fill * PER_FILL * doublings]
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
fn steps<const D: usize>(case: &Case<D>) -> f64 {
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
fn held<const D: usize>(case: &Case<D>, x: [f64; D]) -> [bool; D] {
    let (lower, upper) = (case.grid.lower(), case.grid.upper());
    let cell = case.grid.smallest_cell();
    let near = |a: f64, b: f64, axis: usize| (a - b).abs() < 1e-6 * cell[axis];
    let sides = &case.boundaries;
    let mut held = [false; D];
    for (axis, own) in sides.sides.iter().enumerate() {
        for (side, at) in std::iter::zip(own, [lower[axis], upper[axis]]) {
            if near(x[axis], at, axis) {
                held[axis] |= *side != Side::Free;
                for component in &mut held {
                    *component |= *side == Side::Fixed;
                }
            }
        }
    }
    for fixed in &sides.boxes {
        let inside = (0..D).all(|axis| {
            let slack = 1e-6 * cell[axis];
            fixed.lower[axis] - slack <= x[axis] && x[axis] <= fixed.upper[axis] + slack
        });
        if inside {
            for (own, fixed) in std::iter::zip(&mut held, fixed.fix) {
                *own |= fixed;
            }
        }
    }
    for load in &case.loads {
        if let LoadKind::RigidFooting {
            from, to, rough, ..
        } = load.kind
        {
            let slack = 1e-6 * cell[0];
            let below = from[0].min(to[0]) - slack <= x[0] && x[0] <= from[0].max(to[0]) + slack;
            if below && near(x[D - 1], from[1], D - 1) {
                held[0] |= rough;
                held[D - 1] = true;
            }
        }
    }
    held
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::case::FixedBox;
    use crate::input::CaseFile;

    const FACTORS: Storage = Storage::Factors {
        space: 1.0,
        plane: 1.0,
    };

    pub(crate) fn case() -> Case {
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
        let [particle, unknown] = per_item(2, FACTORS, 1 << 19);
        let sum = 1e6 * particle + f64::from(1 << 19) * unknown;
        let drawing = PER_PICTURE * rayon::current_num_threads() as f64;
        let expected = BASE + sum + AGAIN * drawing;
        assert!((memory(&case(), 1_000_000, 1 << 19) - expected).abs() < 1.0);
        assert!((unknown - PER_UNKNOWN - 19.0 * PER_FILL).abs() < 1e-9);
        // A small case is a program that draws pictures.
        let [particle, unknown] = per_item(2, FACTORS, 36);
        let expected = BASE + drawing + AGAIN * (64.0 * particle + 36.0 * unknown);
        assert!((memory(&case(), 64, 36) - expected).abs() < 1.0);
    }

    #[test]
    fn amounts_are_readable() {
        assert_eq!(readable(12e6), "15 MiB");
        assert_eq!(readable(512e6), "490 MiB");
        assert_eq!(readable(3.2e9), "3.0 GiB");
    }
}
