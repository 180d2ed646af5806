//! The expected cost of a case before it runs: particles, cells, unknowns, memory ([`estimate`]) and time
//! ([`time`]).
//!
//! The memory model counts particles (state, trial and supports), stored entries of the tangent
//! matrix (proportional to the unknowns), and what the linear solver keeps ([`Systems`]). The bytes were
//! fitted to the peak memory of slopes with 500 to 110 000 unknowns and 4 to 9 particles per cell. Pictures
//! are drawn when the matrix is gone, as many at a time as there are threads: the larger of the two counts,
//! and half of the smaller one, since not all memory that is let go serves again. A search along the
//! reduction of strength keeps several states.

mod couplings;
mod error;
pub mod factor_memory;
mod flows;
pub mod resources;
pub mod room;
pub mod speed;
mod systems;
pub mod time;
pub mod watch;

use igimp_geometry::seed::fill;
use igimp_linear::SCALAR;
use igimp_model::{Case, Drainage, LoadKind, ReductionPath, Side, StageKind, meshes};
use igimp_results::summary::Expected;
use igimp_shape::{Grid, Scratch, supports};

use couplings::Couplings;
pub use error::EstimateError;
pub use flows::Flows;
use speed::Speed;
pub use systems::Systems;
use time::Time;

/// Program, tables and buffers \[bytes\].
const BASE: f64 = 3.2e7;
/// State, trial and supports of a particle \[bytes\].
const PER_PARTICLE: f64 = 2e3;
/// The states that a search along the reduction of strength keeps \[bytes per particle\].
const PER_SEARCHED: f64 = 2e3;
/// Matrix, its copies and its pattern \[bytes per unknown\].
const PER_UNKNOWN: f64 = 3e3;
/// The same in space, where a particle touches up to 27 nodes \[bytes\].
const PER_PARTICLE_IN_SPACE: f64 = 4e3;
/// Matrix, its copies and its pattern in space \[bytes per unknown\].
const PER_UNKNOWN_IN_SPACE: f64 = 7e3;
/// Supports of pressure of a particle whose water flows while they are gathered, in the plane and in space \[bytes\].
const PER_COUPLED: [f64; 2] = [1e3, 3e3];
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
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Particles, the most that are there at once.
    pub particles: usize,
    /// Cells of the grid.
    pub cells: usize,
    /// Unknowns of a step with all bodies there.
    pub unknowns: usize,
    /// How its linear systems will be solved.
    pub systems: Systems,
    /// The cost of computed flows of water.
    pub flows: Flows,
    /// Memory of a particle, and of an unknown with its share of what the linear solver keeps \[bytes\].
    pub per_item: [f64; 2],
    /// Memory on the threads of the current pool \[bytes\].
    pub bytes: f64,
    /// The same where an iteration is given up for factors \[bytes\]: no less.
    pub most_bytes: f64,
    /// Steps of all stages, each trial of a strength reduction included, times unknowns \[-\].
    pub work: f64,
}

/// Nodes that the bodies of a case touch, all of them there.
struct Survey<'g, const D: usize> {
    /// By node: whether soil touches it, and soil whose water flows.
    touched: Vec<bool>,
    pressed: Vec<bool>,
    /// Particles of each body, and of those whose water flows.
    particles: Vec<usize>,
    coupled: usize,
    /// Which nodes share particles, in space.
    couplings: Option<Couplings<'g, D>>,
}

impl<'g, const D: usize> Survey<'g, D> {
    fn of(case: &Case<D>, grid: &'g Grid<D>) -> Result<Self, EstimateError> {
        let mut survey = Self {
            touched: vec![false; grid.node_count()],
            pressed: vec![false; grid.node_count()],
            particles: Vec::new(),
            coupled: 0,
            couplings: (D == 3).then(|| Couplings::new(grid)),
        };
        let consolidates = case
            .stages
            .iter()
            .any(|stage| stage.consolidation.is_some());
        let (mut scratch, mut list) = (Scratch::default(), Vec::new());
        for body in &case.bodies {
            let drainage = &case.materials[body.material].drainage;
            let flows = consolidates && matches!(drainage, Drainage::Undrained { flows: true, .. });
            let seeds = fill(grid, &*body.region, body.per_direction, 1.0, 0);
            let seeds = seeds.map_err(|error| error.of_body(&body.name))?;
            for seed in &seeds {
                let (basis, domain) = (&*case.method.basis, (&seed.x, &seed.half_length));
                supports(grid, basis, domain.0, domain.1, &mut scratch, &mut list)?;
                for support in &list {
                    survey.touched[support.node] = true;
                    survey.pressed[support.node] |= flows;
                }
                if let Some(couplings) = &mut survey.couplings {
                    couplings.add(domain.0, domain.1);
                }
            }
            survey.particles.push(seeds.len());
            survey.coupled += if flows { seeds.len() } else { 0 };
        }
        Ok(survey)
    }

    /// The most particles that are there at once.
    fn most_particles(&self, case: &Case<D>) -> usize {
        let count = |there: &[bool]| -> usize {
            let bodies = std::iter::zip(&self.particles, there);
            bodies
                .map(|(count, &there)| if there { *count } else { 0 })
                .sum()
        };
        let at_start: Vec<bool> = case.bodies.iter().map(|body| body.from_start).collect();
        let stages = (0..case.stages.len()).map(|stage| count(&case.bodies_after(stage)));
        stages.fold(count(&at_start), usize::max)
    }

    /// By node, a bit for each unknown.
    fn free(&self, case: &Case<D>, grid: &Grid<D>) -> Vec<u8> {
        let nodes = std::iter::zip(0.., std::iter::zip(&self.touched, &self.pressed));
        nodes
            .map(|(node, (&touched, &pressed))| {
                let scalar = if pressed { SCALAR } else { 0 };
                if touched {
                    free(case, grid.node_position(node)) | scalar
                } else {
                    0
                }
            })
            .collect()
    }
}

/// The size of a case.
///
/// # Errors
/// [`EstimateError`] for a grid that cannot be made and bodies that do not lie on it.
pub fn estimate<const D: usize>(case: &Case<D>) -> Result<Estimate, EstimateError> {
    let grid = case.grid.grid()?;
    let survey = Survey::of(case, &grid)?;
    let particles = survey.most_particles(case);
    let free = survey.free(case, &grid);
    let unknowns = free.iter().map(|free| free.count_ones() as usize).sum();
    let systems = match survey.couplings {
        Some(couplings) if unknowns > 0 => Systems::in_space(case, &couplings.pattern(&free))?,
        _ => Systems::in_plane(case, unknowns),
    };
    let [particle, unknown] = if D == 3 {
        [PER_PARTICLE_IN_SPACE, PER_UNKNOWN_IN_SPACE]
    } else {
        [PER_PARTICLE, PER_UNKNOWN]
    };
    let nodes = survey.touched.iter().filter(|touched| **touched).count();
    let flows = Flows::of(case, nodes);
    let of_pressures = PER_COUPLED[usize::from(D == 3)] * survey.coupled as f64;
    let solving =
        particle * particles as f64 + of_pressures + unknown * unknowns as f64 + systems.bytes;
    // Flows are found before the first step, and their equations are gone then.
    let memory = |solving: f64| memory(case, particles, solving.max(flows.bytes));
    Ok(Estimate {
        flows,
        particles,
        cells: grid.cell_count(),
        unknowns,
        per_item: [
            particle + of_pressures / (particles as f64).max(1.0),
            unknown + systems.bytes / (unknowns as f64).max(1.0),
        ],
        bytes: memory(solving),
        most_bytes: memory(solving + systems.fallback_bytes),
        systems,
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

/// The expected cost of a run on this computer; for a study of the mesh error, of all its meshes.
#[derive(Clone, Debug, PartialEq)]
pub struct Expectation {
    /// Time of the planned steps.
    pub time: Time,
    /// Memory \[bytes\].
    pub bytes: f64,
    /// The same where iterations are given up for factors \[bytes\].
    pub most_bytes: f64,
    /// The size on every mesh, coarse ones first.
    pub sizes: Vec<Estimate>,
    /// The speed that the time was found for.
    pub speed: Speed,
}

impl Expectation {
    /// Measures the computer and estimates a case.
    ///
    /// # Errors
    /// As [`estimate`] and [`Speed::measured`].
    pub fn of<const D: usize>(case: &Case<D>) -> Result<Self, EstimateError> {
        let speed = Speed::measured()?;
        let meshes = meshes::meshes(case);
        let sizes = meshes.iter().map(estimate).collect::<Result<Vec<_>, _>>()?;
        let times: Vec<Time> = std::iter::zip(&meshes, &sizes)
            .map(|(mesh, size)| time::time(mesh, size, speed))
            .collect();
        let of_all =
            |bytes: fn(&Estimate) -> f64| together(&sizes.iter().map(bytes).collect::<Vec<_>>());
        Ok(Self {
            time: Time {
                seconds: times.iter().map(|time| time.seconds).sum(),
                open_ended: times.iter().any(|time| time.open_ended),
                threads: rayon::current_num_threads(),
            },
            bytes: of_all(|size| size.bytes),
            most_bytes: of_all(|size| size.most_bytes),
            sizes,
            speed,
        })
    }

    /// As reported after a run, with the time of the steps that it took if that is known.
    pub fn expected(&self, seconds_of_steps_taken: Option<f64>) -> Expected {
        Expected {
            seconds: self.time.seconds,
            open_ended: self.time.open_ended,
            threads: self.time.threads,
            bytes: self.bytes,
            most_bytes: self.most_bytes,
            seconds_of_steps_taken,
        }
    }
}

/// Memory of a run on the threads of the current pool, of which solving takes so much \[bytes\].
fn memory<const D: usize>(case: &Case<D>, particles: usize, solving: f64) -> f64 {
    let searches = case.stages.iter().any(|stage| {
        matches!(&stage.kind, StageKind::StrengthReduction(search)
            if search.path == ReductionPath::Reduce)
    });
    let kept = if searches {
        PER_SEARCHED * particles as f64
    } else {
        0.0
    };
    let solving = solving + kept;
    let drawing = PER_PICTURE * rayon::current_num_threads() as f64 + kept;
    let view = if D == 3 && case.output.report {
        VIEW_IN_SPACE
    } else {
        0.0
    };
    BASE + view + solving.max(drawing) + AGAIN * solving.min(drawing)
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

/// Which components of a node are not held by supports and footings, one bit each.
fn free<const D: usize>(case: &Case<D>, x: [f64; D]) -> u8 {
    let (lower, upper) = (case.grid.lower(), case.grid.upper());
    let cell = case.grid.smallest_cell();
    let near = |a: f64, b: f64, axis: usize| (a - b).abs() < 1e-6 * cell[axis];
    let sides = &case.boundaries;
    let mut held = [false; D];
    for (axis, ends) in sides.sides.iter().enumerate() {
        for (side, at) in std::iter::zip(ends, [lower[axis], upper[axis]]) {
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
            for (component, fixed) in std::iter::zip(&mut held, fixed.fix) {
                *component |= fixed;
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
    (0..D).fold(0, |free, axis| free | u8::from(!held[axis]) << axis)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use igimp_input::CaseFile;
    use igimp_model::FixedBox;

    pub(crate) fn case() -> Case<2> {
        let text = include_str!("../tests/data/block.toml");
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
    fn memory_is_the_larger_of_solving_and_drawing_and_half_of_the_other() {
        let drawing = PER_PICTURE * rayon::current_num_threads() as f64;
        let [small, large] = [0.1, 10.0].map(|share| memory(&case(), 64, share * drawing));
        assert!((small - BASE - 1.05 * drawing).abs() < 1.0);
        assert!((large - BASE - 10.5 * drawing).abs() < 1.0);
    }

    /// The cost of an item, times the number of items, is that of solving.
    #[test]
    fn items_add_up_to_what_solving_takes() {
        let size = estimate(&case()).unwrap();
        let [particle, unknown] = size.per_item;
        let solving = particle * size.particles as f64 + unknown * size.unknowns as f64;
        assert!((memory(&case(), size.particles, solving) - size.bytes).abs() < 1.0);
        assert!((size.most_bytes - size.bytes).abs() < 1.0);
    }

    #[test]
    fn amounts_are_readable() {
        assert_eq!(readable(12e6), "15 MiB");
        assert_eq!(readable(512e6), "490 MiB");
        assert_eq!(readable(3.2e9), "3.0 GiB");
    }
}
