//! A block of two elastic soils with an inclined plane boundary, under pressure normal to the boundary
//! and shear along it.
//!
//! With equal strain along the boundary the normal and the shear traction are the same everywhere and
//! the displacement is piecewise linear: it is prescribed on the outline of the block.

use std::sync::Arc;

use igimp_assembly::{
    Constraints, Kinematics, Locking, Method, ParticleSeed, Particles, SharedLaw, StepConditions,
    StepLoads,
};
use igimp_cases::CaseError;
use igimp_geometry::polygon::{area_and_centroid, bounding_box, clip_to_box};
use igimp_geometry::seed::fill_polygon;
use igimp_material::{Elasticity, HenckyElastic};
use igimp_shape::Grid;
use igimp_solver::{Body, MarchSettings};

use crate::continuum::laboratory::{grid_of, run, unobserved};
use crate::harness::study::RunRecord;

/// Side of the block \[m\].
const SIDE: f64 = 1.0;
/// A point of the boundary \[m\], on no line of a grid.
const THROUGH: [f64; 2] = [0.5, 0.487];
/// Young's modulus of the upper soil \[Pa\].
const YOUNG: f64 = 1.0;
/// Poisson's ratio of both \[-\].
const POISSON: f64 = 0.3;
/// Normal stress \[Pa\]: strains stay infinitesimal.
const NORMAL: f64 = -1e-6;
/// Shear stress along the boundary \[Pa\].
const SHEAR: f64 = 0.3e-6;
/// Particles per cell and direction.
const PER_DIRECTION: usize = 2;

/// Ways to treat the cells that the boundary cuts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// Every particle has the stiffness of its own soil.
    Own,
    /// Particles of cut cells have the mean stiffness of the cell, by volume.
    MeanStiffness,
    /// They have the inverse of the mean compliance of the cell.
    MeanCompliance,
    /// As `Own`; afterwards the particles of a cut cell take the mean stress of the cell.
    MeanStress,
    /// As `Own`, with particles whose domains end at the boundary.
    Split,
    /// As `Own`, without B-bar: every particle has its own volumetric strain.
    OwnDilatation,
}

impl Way {
    /// All of them.
    pub(super) const ALL: [Self; 6] = [
        Self::Own,
        Self::MeanStiffness,
        Self::MeanCompliance,
        Self::MeanStress,
        Self::Split,
        Self::OwnDilatation,
    ];

    /// As the table says it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Own => "own stiffness",
            Self::MeanStiffness => "mean stiffness of the cell",
            Self::MeanCompliance => "mean compliance of the cell",
            Self::MeanStress => "mean stress of the cell",
            Self::Split => "domains end at the boundary",
            Self::OwnDilatation => "own stiffness, no B-bar",
        }
    }

    /// As files are named.
    pub(super) fn key(self) -> &'static str {
        match self {
            Self::Own => "own",
            Self::MeanStiffness => "mean_stiffness",
            Self::MeanCompliance => "mean_compliance",
            Self::MeanStress => "mean_stress",
            Self::Split => "split",
            Self::OwnDilatation => "own_dilatation",
        }
    }
}

/// The exact solution: normal and tangent of the boundary, and strains of the two soils.
struct Exact {
    normal: [f64; 2],
    tangent: [f64; 2],
    /// Normal strain of the lower and the upper soil \[-\].
    normal_strain: [f64; 2],
    /// Shear strain γ of the lower and the upper soil \[-\].
    shear_strain: [f64; 2],
}

impl Exact {
    fn new(slope: f64, stiffness: f64) -> Self {
        let (sin, cos) = slope.to_radians().sin_cos();
        let constrained = (1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON));
        let shear = 0.5 / (1.0 + POISSON);
        let young = [stiffness * YOUNG, YOUNG];
        Self {
            normal: [-sin, cos],
            tangent: [cos, sin],
            normal_strain: young.map(|young| NORMAL / (young * constrained)),
            shear_strain: young.map(|young| SHEAR / (young * shear)),
        }
    }

    /// Distance above the boundary \[m\].
    fn above(&self, x: &[f64; 2]) -> f64 {
        (0..2).map(|a| (x[a] - THROUGH[a]) * self.normal[a]).sum()
    }

    fn displacement(&self, x: &[f64; 2]) -> [f64; 2] {
        let above = self.above(x);
        let soil = usize::from(above > 0.0);
        [0, 1].map(|a| {
            above
                * (self.normal_strain[soil] * self.normal[a]
                    + self.shear_strain[soil] * self.tangent[a])
        })
    }
}

/// Presses a block; returns the run and the errors over the normal stress: the largest and the root
/// mean square of the normal stress, the largest beyond the cut cells, and the root mean square of the
/// stress along the boundary \[-\].
pub(super) fn patch(
    slope: f64,
    stiffness: f64,
    cells: usize,
    way: Way,
) -> Result<(RunRecord, [f64; 4]), CaseError> {
    let exact = Exact::new(slope, stiffness);
    let grid = grid_of(SIDE / cells as f64, [cells; 2])?;
    let polygons = halves(slope);
    let shares = shares(&grid, &polygons[0]);
    let (mut seeds, mut laws): (Vec<ParticleSeed<2>>, Vec<SharedLaw>) = (Vec::new(), Vec::new());
    let mut soils = Vec::new();
    for (soil, polygon) in polygons.iter().enumerate() {
        let filled = match way {
            Way::Split => split(&grid, polygon),
            _ => fill_polygon(&grid, polygon, PER_DIRECTION, 1.0, 0)?,
        };
        soils.extend(vec![soil; filled.len()]);
        seeds.extend(filled);
    }
    let young = [stiffness * YOUNG, YOUNG];
    for (seed, &soil) in seeds.iter_mut().zip(&soils) {
        let share = shares[cell_of(&grid, &seed.x)];
        let e = match way {
            Way::MeanStiffness => share * young[0] + (1.0 - share) * young[1],
            Way::MeanCompliance => 1.0 / (share / young[0] + (1.0 - share) / young[1]),
            _ => young[soil],
        };
        seed.law = laws.len();
        laws.push(Arc::new(HenckyElastic::new(Elasticity::new(e, POISSON)?)));
    }
    let mut body = Body::new(Particles::new(&seeds)?);
    let last = cells;
    let load_path = |from: f64, to: f64| {
        let mut constraints = Constraints::free(&grid);
        for node in 0..grid.node_count() {
            let place = grid.node_place(node);
            if place.iter().any(|&k| k == 0 || k == last) {
                let u = exact.displacement(&grid.node_position(node));
                for (axis, u) in u.into_iter().enumerate() {
                    constraints.prescribe(node, axis, (to - from) * u)?;
                }
            }
        }
        StepConditions::new(
            grid.clone(),
            constraints,
            StepLoads::gravity([0.0; 2]),
            laws.clone(),
        )
    };
    let method = Method {
        kinematics: Kinematics::SmallStrain,
        locking: if way == Way::OwnDilatation {
            Locking::None
        } else {
            Locking::BBar
        },
        ..Method::igimp_bbar()
    };
    let name = format!("inclined by {slope}°, E ratio {stiffness}, 1/{cells}, {way:?}");
    let settings = MarchSettings::steps(1);
    let (run, _) = run(
        name,
        &mut body,
        &method,
        &settings,
        &load_path,
        &mut unobserved,
    );
    Ok((run, errors(&exact, &grid, &shares, &body, way)))
}

fn errors(exact: &Exact, grid: &Grid<2>, shares: &[f64], body: &Body<2>, way: Way) -> [f64; 4] {
    let particles = &body.particles;
    let last = grid.axes[0].cell_count() - 1;
    let project = |sigma: &[[f64; 3]; 3], a: [f64; 2], b: [f64; 2]| -> f64 {
        (0..2)
            .flat_map(|i| (0..2).map(move |j| (i, j)))
            .map(|(i, j)| a[i] * sigma[i][j] * b[j])
            .sum()
    };
    // Normal and tangential stress with the mean of each cell.
    let mut means = vec![[0.0; 3]; grid.cell_count()];
    let stresses: Vec<[f64; 2]> = (0..particles.len())
        .map(|k| {
            let sigma = &particles.sigma[k];
            let volume = particles.volume0[k];
            let cell = cell_of(grid, &particles.x[k]);
            let stress = [
                project(sigma, exact.normal, exact.normal),
                project(sigma, exact.tangent, exact.tangent),
            ];
            for axis in 0..2 {
                means[cell][axis] += volume * stress[axis];
            }
            means[cell][2] += volume;
            stress
        })
        .collect();
    let ratio = POISSON / (1.0 - POISSON);
    let (mut largest, mut beyond) = (0.0_f64, 0.0_f64);
    let (mut squares, mut along, mut count) = (0.0, 0.0, 0.0);
    for k in 0..particles.len() {
        let cell = cell_of(grid, &particles.x[k]);
        // The displacement along the outline has a kink that its cells cannot follow.
        let is_outer = grid.cell_place(cell).iter().any(|&k| k < 2 || k + 2 > last);
        if is_outer {
            continue;
        }
        let is_cut = shares[cell] > 0.0 && shares[cell] < 1.0;
        let mut stress = stresses[k];
        if is_cut && way == Way::MeanStress {
            stress = [0, 1].map(|axis| means[cell][axis] / means[cell][2]);
        }
        let error = (stress[0] / NORMAL - 1.0).abs();
        if !is_cut {
            beyond = beyond.max(error);
            continue;
        }
        largest = largest.max(error);
        squares += error * error;
        along += (stress[1] / NORMAL - ratio).powi(2);
        count += 1.0;
    }
    let root = |sum: f64| (sum / f64::max(count, 1.0)).sqrt();
    [largest, root(squares), beyond, root(along)]
}

/// The number of the cell that holds a place.
fn cell_of(grid: &Grid<2>, x: &[f64; 2]) -> usize {
    grid.cell_at(x).map_or(0, |place| grid.cell_index(place))
}

/// The block below and above the boundary.
fn halves(slope: f64) -> [Vec<[f64; 2]>; 2] {
    let tan = slope.to_radians().tan();
    let at = |x: f64| THROUGH[1] + tan * (x - THROUGH[0]);
    let (left, right) = (at(0.0), at(SIDE));
    [-SIDE, 2.0 * SIDE].map(|far| {
        let half = [[0.0, left], [SIDE, right], [SIDE, far], [0.0, far]];
        clip_to_box(&half, [0.0; 2], [SIDE; 2])
    })
}

/// The share of a polygon in every cell \[-\].
fn shares(grid: &Grid<2>, polygon: &[[f64; 2]]) -> Vec<f64> {
    (0..grid.cell_count())
        .map(|cell| {
            let place = grid.cell_place(cell);
            let lower = grid.node_position(grid.node_index(place));
            let size = grid.cell_size(place);
            let upper = [lower[0] + size[0], lower[1] + size[1]];
            let area = area_and_centroid(&clip_to_box(polygon, lower, upper))
                .0
                .abs();
            (area / (size[0] * size[1])).clamp(0.0, 1.0)
        })
        .map(|share| {
            if share < 1e-9 {
                0.0
            } else if share > 1.0 - 1e-9 {
                1.0
            } else {
                share
            }
        })
        .collect()
}

/// Particles whose domains are the boxes around the parts of the polygon, so that they end at the
/// boundary.
fn split(grid: &Grid<2>, polygon: &[[f64; 2]]) -> Vec<ParticleSeed<2>> {
    let mut seeds = Vec::new();
    for cell in 0..grid.cell_count() {
        let place = grid.cell_place(cell);
        let lower = grid.node_position(grid.node_index(place));
        let size = grid
            .cell_size(place)
            .map(|size| size / PER_DIRECTION as f64);
        for part in 0..PER_DIRECTION * PER_DIRECTION {
            let step = [part % PER_DIRECTION, part / PER_DIRECTION];
            let from: [f64; 2] =
                std::array::from_fn(|axis| lower[axis] + step[axis] as f64 * size[axis]);
            let to = std::array::from_fn(|axis| from[axis] + size[axis]);
            let clipped = clip_to_box(polygon, from, to);
            let volume = area_and_centroid(&clipped).0.abs();
            if volume < 1e-6 * size[0] * size[1] {
                continue;
            }
            let (low, high) = bounding_box(&clipped);
            seeds.push(ParticleSeed {
                x: [0, 1].map(|axis| 0.5 * (low[axis] + high[axis])),
                half_length: [0, 1].map(|axis| 0.5 * (high[axis] - low[axis])),
                volume,
                density: 1.0,
                law: 0,
                centroid: [0.0; _],
            });
        }
    }
    seeds
}
