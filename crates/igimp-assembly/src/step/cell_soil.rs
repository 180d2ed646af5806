//! The soil in every cell of the grid: how much there is, and where its centroid lies. From it come
//! gradients that the particles of a cell share, which cells hold slivers only, and the weight that shared
//! gradients do not see (theory, eqs. 8a to 8i).

use igimp_material::ConstitutiveModel;
use igimp_shape::{CellPart, Grid, Support, cell_parts, loose_cells};
use rayon::prelude::*;

use crate::body::particles::{CHUNK, Particles};
use crate::conditions::StepConditions;
use crate::conditions::loads::LoadPoint;
use crate::error::AssemblyError;
use crate::laws::SharedLaw;
use crate::method::{Geometry, Locking, Method, Section};
use crate::step::continuation::followers;
use crate::step::domain::{capped_half_length, merge_equal_nodes, off_grid};
use crate::step::hoops::{Hoop, RadialPart, centroid_of_cell, weigh_by_radius};
use crate::step::ties::Ties;

/// A cell that is filled to less than this share holds a sliver of soil that reached over its face
/// \[-\]. A choice: less leaves nodes with so little soil that they climb without end at a limit load, more takes weight
/// and strength off the body (docs/src/comparisons.md, offsets of a vertical cut).
const SLIVER: f64 = 0.02;

/// Share β of its own distortion that a particle keeps where plastic flow is associated, on a given
/// geometry \[-\].
const SHARE_GIVEN: f64 = 0.02;

/// The same on a moving one: strain that the mean does not see is held in every step \[-\].
const SHARE_MOVING: f64 = 0.1;

/// The same where plastic flow keeps volume although the law has friction, on both \[-\]: with less Newton's method loses its way
/// where equilibrium is not unique, with more factors of safety rise (docs/src/comparisons.md: slopes with ψ = 0 at 0.3 and 1).
const SHARE_ISOCHORIC: f64 = 0.3;

/// The least share in cells whose face is loaded, on both \[-\]: a load that ends within a cell pushes modes that the mean does not see.
const SHARE_LOADED: f64 = 0.3;

/// The soil of every cell, and the parts of every particle.
pub(crate) struct CellSoil<const D: usize> {
    /// The parts of `CHUNK` particles after `CHUNK` particles.
    parts: Vec<Parts<D>>,
    /// Whether a cell holds no more than a sliver, by cell.
    is_sliver: Vec<bool>,
    /// The least share β that soil keeps, by cell: more where a face is loaded or strains do not hold the nodes (theory, eq. 8i) \[-\].
    least_share: Vec<f64>,
    /// Where the tents of a cell give the gradients that its particles share, from 0 to 1 in each
    /// direction, by cell: the centre X = 1/2, or the centroid of the soil \[-\].
    shared_at: Vec<[f64; D]>,
    /// Radius at which the tents of a cell give the stretch around the axis that its particles share, by cell: its middle, or
    /// that of its soil by area \[length\]. Empty unless the section is axisymmetric.
    hoop_at: Vec<f64>,
    /// Share β of its own distortion that a particle keeps, by law \[-\].
    law_share: Vec<f64>,
    locking: Locking,
}

/// The parts of some particles.
#[derive(Default)]
struct Parts<const D: usize> {
    /// Where those of each particle begin, and where the last end.
    first: Vec<u32>,
    all: Vec<CellPart<D>>,
    /// Their extents along the radius; none unless the section is axisymmetric.
    radial: Vec<RadialPart>,
}

/// A part of a particle that counts.
struct Kept<'a, const D: usize> {
    part: &'a CellPart<D>,
    /// Centroid of the part in the cell, from 0 to 1 in each direction \[-\].
    centroid: [f64; D],
    /// Radius of the middle of the part \[length\]; 0 unless the section is axisymmetric.
    radius: f64,
    /// Its share of the parts kept \[-\].
    weight: f64,
}

impl<const D: usize> CellSoil<D> {
    /// Lays the particles over a grid; `points` load the faces of some cells.
    ///
    /// # Errors
    /// [`AssemblyError::Shape`] names the first particle whose centre left the grid.
    fn build(
        particles: &Particles<D>,
        method: &Method,
        conditions: &StepConditions<D>,
        points: &[LoadPoint<D>],
    ) -> Result<Self, AssemblyError> {
        let (grid, len) = (&conditions.grid, particles.len());
        let parts = (0..len.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let range = chunk * CHUNK..len.min((chunk + 1) * CHUNK);
                let mut parts = Parts {
                    first: Vec::with_capacity(range.len() + 1),
                    ..Parts::default()
                };
                parts.first.push(0);
                for particle in range {
                    let (x, half_length) = soil_of(particles, particle, method.geometry);
                    let half_length = capped_half_length(grid, &x, half_length);
                    cell_parts(grid, &*method.basis, &x, &half_length, &mut parts.all)
                        .map_err(|source| off_grid(particle, &x, source))?;
                    if method.section.is_axisymmetric() {
                        parts.weigh_by_radius(grid, method, x[0], half_length[0]);
                    }
                    parts.first.push(parts.all.len() as u32);
                }
                Ok(parts)
            })
            .collect::<Vec<Result<_, AssemblyError>>>();
        let parts = parts.into_iter().collect::<Result<Vec<_>, _>>()?;
        let of_law = |law: &SharedLaw| share_of_law(&**law, method.geometry);
        let mut soil = Self {
            parts,
            is_sliver: vec![false; grid.cell_count()],
            least_share: vec![0.0; grid.cell_count()],
            shared_at: vec![[0.5; D]; grid.cell_count()],
            hoop_at: Vec::new(),
            law_share: conditions.laws.iter().map(of_law).collect(),
            locking: method.locking,
        };
        if method.section.is_axisymmetric() {
            soil.share_by_radius(grid);
        }
        let shares = soil.locking == Locking::SharedStrain;
        if shares || method.geometry == Geometry::Given || !points.is_empty() {
            soil.find_soil(particles, method, conditions, &loaded_cells(grid, points));
        }
        Ok(soil)
    }

    /// The soil of the cells where gradients are made of it: strain is shared, the geometry given, the section axisymmetric or a
    /// face loaded.
    ///
    /// # Errors
    /// As [`Self::build`].
    pub(crate) fn where_it_counts(
        particles: &Particles<D>,
        method: &Method,
        conditions: &StepConditions<D>,
        points: &[LoadPoint<D>],
    ) -> Result<Option<Self>, AssemblyError> {
        let counts = method.locking == Locking::SharedStrain
            || method.geometry == Geometry::Given
            || method.section.is_axisymmetric()
            || !points.is_empty();
        counts
            .then(|| Self::build(particles, method, conditions, points))
            .transpose()
    }

    /// Lets cells that move with a neighbour share gradients at the place where that shares them (theory, eq. 63b).
    pub(crate) fn follow(&mut self, grid: &Grid<D>, ties: &Ties) {
        for (cell, leader) in followers(grid, ties) {
            let [index, other] = [cell, leader].map(|place| grid.cell_index(place));
            let (from, size) = (grid.cell_size(leader), grid.cell_size(cell));
            self.shared_at[index] = std::array::from_fn(|axis| {
                let nodes = grid.axes[axis].nodes();
                let beyond = nodes[leader[axis]] - nodes[cell[axis]];
                (beyond + self.shared_at[other][axis] * from[axis]) / size[axis]
            });
            if !self.hoop_at.is_empty() {
                self.hoop_at[index] = self.hoop_at[other];
            }
        }
    }

    /// Finds slivers, loose cells, and the centroid of the soil of the cells that share it: sums of volumes and first moments
    /// in the order of the particles.
    fn find_soil(
        &mut self,
        particles: &Particles<D>,
        method: &Method,
        conditions: &StepConditions<D>,
        is_loaded: &[bool],
    ) {
        let grid = &conditions.grid;
        let is_given = method.geometry == Geometry::Given;
        let all = is_given && self.locking == Locking::SharedStrain;
        let mut volume = vec![0.0; grid.cell_count()];
        let mut moment = vec![[0.0; D]; grid.cell_count()];
        let mut area = vec![0.0; self.hoop_at.len()];
        for particle in 0..particles.len() {
            for (part, centroid, radius) in self.parts_of(particle) {
                let cell = grid.cell_index(part.cell);
                let part_volume = part.share * particles.volume(particle);
                volume[cell] += part_volume;
                for axis in 0..D {
                    moment[cell][axis] += part_volume * centroid[axis];
                }
                if let Some(area) = area.get_mut(cell) {
                    *area += part_volume / radius;
                }
            }
        }
        let mut holds_soil = vec![false; grid.cell_count()];
        for (cell, (volume, moment)) in volume.into_iter().zip(moment).enumerate() {
            let size: f64 = grid.cell_size(grid.cell_place(cell)).iter().product();
            let thickness = (self.hoop_at.get(cell)).map_or(1.0, |&r| method.section.thickness(r));
            holds_soil[cell] = volume >= SLIVER * size * thickness;
            self.is_sliver[cell] = is_given && !holds_soil[cell];
            if volume > 0.0 && (all || is_loaded[cell]) {
                self.shared_at[cell] = moment.map(|moment| moment / volume);
                if let Some(area) = area.get(cell) {
                    self.hoop_at[cell] = volume / area;
                }
            }
        }
        if self.locking == Locking::SharedStrain && self.law_share.iter().any(|&beta| beta < 1.0) {
            let held = &conditions.constraints;
            let free = |node| (0..D).filter(|&axis| held.of(node, axis).is_none()).count();
            let strains = (D * (D + 1) / 2) as u8 + u8::from(!self.hoop_at.is_empty());
            let least = |(is_loose, is_loaded)| match (is_loose, is_loaded) {
                (true, _) => 1.0,
                (false, true) => SHARE_LOADED,
                (false, false) => 0.0,
            };
            let is_loose = loose_cells(grid, &holds_soil, free, strains);
            let both = std::iter::zip(is_loose, is_loaded.iter().copied());
            self.least_share = both.map(least).collect();
        }
    }

    /// The share β of its own distortion that soil of a law keeps in a cell \[-\].
    fn kept_share(&self, law: usize, cell: usize) -> f64 {
        match self.locking {
            Locking::SharedStrain => self.law_share[law].max(self.least_share[cell]),
            Locking::None | Locking::BBar => 1.0,
        }
    }

    /// Shares gradients of whole cells at their centroids by volume, and the stretch around the axis in their middles (theory,
    /// eq. 130b).
    fn share_by_radius(&mut self, grid: &Grid<D>) {
        for (cell, shared_at) in self.shared_at.iter_mut().enumerate() {
            let place = grid.cell_place(cell);
            *shared_at = centroid_of_cell(grid, place, Section::Axisymmetric);
            let [start, end] = radii(grid, place);
            self.hoop_at.push(0.5 * (start + end));
        }
    }

    /// The parts of one particle, with the centroids of their volumes in their cells, and the radii of their middles.
    fn parts_of(&self, particle: usize) -> impl Iterator<Item = (&CellPart<D>, [f64; D], f64)> {
        let (parts, place) = (&self.parts[particle / CHUNK], particle % CHUNK);
        let (first, last) = (parts.first[place] as usize, parts.first[place + 1] as usize);
        (first..last).map(|k| {
            let mut centroid = parts.all[k].middle;
            let radial = parts.radial.get(k);
            if let Some(radial) = radial {
                centroid[0] = radial.centroid;
            }
            let radius = radial.map_or(0.0, |radial| radial.middle);
            (&parts.all[k], centroid, radius)
        })
    }

    /// Replaces `out` with the supports of a particle of law number `law` (theory, eq. 8b), nodes
    /// ascending. On a given geometry slivers are cut off, unless there is nothing else.
    pub(crate) fn supports(
        &self,
        grid: &Grid<D>,
        (particle, law): (usize, usize),
        out: &mut Vec<Support<D>>,
        hoops: &mut Vec<Hoop>,
    ) {
        out.clear();
        for kept in self.kept(grid, particle) {
            let Kept { part, weight, .. } = kept;
            let cell = grid.cell_index(part.cell);
            let beta = self.kept_share(law, cell);
            let shared_at = match self.locking {
                Locking::None => kept.centroid,
                Locking::BBar | Locking::SharedStrain => self.shared_at[cell],
            };
            let tents = grid.tents(part.cell, kept.centroid);
            for (tent, shared) in tents.zip(grid.tents(part.cell, shared_at)) {
                let (node, value, grad) = tent;
                out.push(Support {
                    node,
                    value: weight * value,
                    grad: std::array::from_fn(|axis| {
                        weight * (beta * grad[axis] + (1.0 - beta) * shared.2[axis])
                    }),
                    grad_bar: shared.2.map(|slope| weight * slope),
                });
            }
        }
        out.sort_by_key(|support| support.node);
        let count = merge_equal_nodes(out);
        out.truncate(count);
        hoops.clear();
        if !self.hoop_at.is_empty() {
            self.add_hoops(grid, (particle, law), out, hoops);
        }
    }

    /// Sets `hoops` to the stretch of a particle of a law around the axis by its supports (theory, eqs. 130a and 130b).
    fn add_hoops(
        &self,
        grid: &Grid<D>,
        (particle, law): (usize, usize),
        supports: &[Support<D>],
        hoops: &mut Vec<Hoop>,
    ) {
        hoops.resize(supports.len(), Hoop::default());
        for Kept {
            part,
            centroid,
            radius,
            weight,
        } in self.kept(grid, particle)
        {
            let (cell, [start, end]) = (grid.cell_index(part.cell), radii(grid, part.cell));
            let beta = self.kept_share(law, cell);
            let at = |radius: f64, mut point: [f64; D]| {
                point[0] = (radius - start) / (end - start);
                grid.tents(part.cell, point)
                    .map(move |tent| tent.1 / radius)
            };
            let shared_at = match self.locking {
                Locking::None => (radius, centroid),
                Locking::BBar | Locking::SharedStrain => (self.hoop_at[cell], self.shared_at[cell]),
            };
            let both = at(radius, centroid).zip(at(shared_at.0, shared_at.1));
            let nodes = grid.tents(part.cell, centroid).map(|tent| tent.0);
            for (node, (at_part, shared)) in nodes.zip(both) {
                let Ok(place) = supports.binary_search_by_key(&node, |support| support.node) else {
                    continue;
                };
                let hoop = Hoop {
                    value: beta * at_part + (1.0 - beta) * shared,
                    bar: shared,
                    place: at_part,
                };
                hoops[place] = hoops[place].plus(weight, hoop);
            }
        }
    }

    /// The parts of a particle that are not in slivers, or all if most of it is there; each with its share of those
    /// kept (theory, eq. 8d).
    fn kept(&self, grid: &Grid<D>, particle: usize) -> impl Iterator<Item = Kept<'_, D>> {
        let kept = |part: &CellPart<D>| !self.is_sliver[grid.cell_index(part.cell)];
        let share: f64 = (self.parts_of(particle).filter(|(part, ..)| kept(part)))
            .map(|(part, ..)| part.share)
            .sum();
        // A choice: which half a particle lies in says whether it belongs to the body or stands beside it.
        let all = share <= 0.5;
        let whole = if all { 1.0 } else { share };
        (self
            .parts_of(particle)
            .filter(move |(part, ..)| all || kept(part)))
        .map(move |(part, centroid, radius)| Kept {
            part,
            centroid,
            radius,
            weight: part.share / whole,
        })
    }

    /// By law, the moments of mass about the centroids of the cells that shared gradients do not see (theory,
    /// eq. 8f). Empty where strain is not shared on a
    /// given geometry, and for laws whose particles keep all of their own distortion.
    pub(crate) fn moments(
        &self,
        grid: &Grid<D>,
        particles: &Particles<D>,
        method: &Method,
    ) -> Vec<Moments<D>> {
        if method.geometry != Geometry::Given || self.locking != Locking::SharedStrain {
            return Vec::new();
        }
        let shared = |beta: &f64| if *beta < 1.0 { grid.node_count() } else { 0 };
        let mut moments: Vec<Moments<D>> = (self.law_share.iter())
            .map(|beta| Moments {
                by_node: vec![[[0.0; D]; D]; shared(beta)],
                layer: 0.0,
            })
            .collect();
        for particle in 0..particles.len() {
            let law = particles.law[particle];
            let of_law = &mut moments[law];
            if of_law.by_node.is_empty() {
                continue;
            }
            let density = particles.mass[particle] / particles.volume(particle);
            for kept in self.kept(grid, particle) {
                let Kept { part, weight, .. } = kept;
                let size = grid.cell_size(part.cell);
                of_law.layer = of_law.layer.max(density * size[D - 1]);
                let cell = grid.cell_index(part.cell);
                let mass = (1.0 - self.kept_share(law, cell)) * particles.mass[particle];
                let shared_at = self.shared_at[cell];
                let arm: [f64; D] = std::array::from_fn(|axis| {
                    weight * mass * (kept.centroid[axis] - shared_at[axis]) * size[axis]
                });
                let tents = grid.tents(part.cell, kept.centroid);
                for (tent, shared) in tents.zip(grid.tents(part.cell, shared_at)) {
                    let moment = &mut of_law.by_node[tent.0];
                    for a in 0..D {
                        for b in 0..D {
                            moment[a][b] += (tent.2[a] - shared.2[a]) * arm[b];
                        }
                    }
                }
            }
        }
        moments
    }
}

/// Whether loaded points lie in a cell or on its sides, by cell (theory, eq. 8h).
fn loaded_cells<const D: usize>(grid: &Grid<D>, points: &[LoadPoint<D>]) -> Vec<bool> {
    let mut is_loaded = vec![false; grid.cell_count()];
    for cell in points.iter().flat_map(|point| grid.cells_around(&point.x)) {
        is_loaded[cell] = true;
    }
    is_loaded
}

/// The weight of the soil of a law that shared gradients do not see (theory, eq. 8f).
#[derive(Clone, Debug)]
pub(crate) struct Moments<const D: usize> {
    /// By node, component a of the gradient, component b of the arm \[mass\].
    pub(crate) by_node: Vec<[[f64; D]; D]>,
    /// Largest mass of a layer of one cell \[mass/length²\].
    pub(crate) layer: f64,
}

/// Where the soil of a particle is: its domain, and on a given geometry the largest box around the centroid of its soil
/// within that (theory, eq. 8e).
fn soil_of<const D: usize>(
    particles: &Particles<D>,
    particle: usize,
    geometry: Geometry,
) -> ([f64; D], [f64; D]) {
    let (x, half_length) = (particles.x[particle], particles.half_length[particle]);
    let centroid = particles.centroid[particle];
    match geometry {
        Geometry::Moving => (x, half_length),
        Geometry::Given => (
            std::array::from_fn(|axis| x[axis] + centroid[axis] * half_length[axis]),
            std::array::from_fn(|axis| (1.0 - centroid[axis].abs()) * half_length[axis]),
        ),
    }
}

/// Where a cell begins and ends along the radius \[length\].
fn radii<const D: usize>(grid: &Grid<D>, cell: [usize; D]) -> [f64; 2] {
    let nodes = grid.axes[0].nodes();
    [nodes[cell[0]], nodes[cell[0] + 1]]
}

impl<const D: usize> Parts<D> {
    /// Weighs the parts of the last particle by their radii, its domain being of half-length `half_length` around `x` along
    /// the radius.
    fn weigh_by_radius(&mut self, grid: &Grid<D>, method: &Method, x: f64, half_length: f64) {
        let half_length = if method.is_of_points() {
            0.0
        } else {
            half_length
        };
        let parts = &mut self.all[self.radial.len()..];
        let radial = parts
            .iter()
            .map(|part| RadialPart::of(grid, part, x, half_length));
        self.radial.extend(radial);
        weigh_by_radius(grid, parts);
    }
}

/// The share β of its own distortion that a particle of a law keeps (theory, eq. 8c), the same for a
/// law and for the law with reduced strength. Elastic soil keeps all of it: bending has to be
/// resisted. In soil that yields the rest is shared, and the kept part holds modes that the mean does not see;
/// they add up from step to step where the body moves. The less flow dilates the less has to be shared, and
/// sharing less keeps Newton's method on its way where equilibrium is not unique.
fn share_of_law(law: &dyn ConstitutiveModel, geometry: Geometry) -> f64 {
    if !law.yields() {
        return 1.0;
    }
    let associated = match geometry {
        Geometry::Given => SHARE_GIVEN,
        Geometry::Moving => SHARE_MOVING,
    };
    let dilates = law.dilatancy().sqrt();
    ((1.0 - dilates) / SHARE_ISOCHORIC + dilates / associated).recip()
}

#[cfg(test)]
#[path = "../../tests/units/cell_soil.rs"]
mod tests;
