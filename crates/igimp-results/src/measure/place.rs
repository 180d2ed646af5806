//! Fields at a place that is no particle (theory, eqs. 40h and 40i). Motion: the nearest particle's value, and from there on along
//! the plane that fits it and the particles around it best. Functions of strain: the same of means over cells of the grid,
//! for they are nearly constant in a cell. Fields that are linear are exact either way.

use igimp_assembly::{Particles, SharedLaw};
use igimp_model::Field;
use igimp_shape::Grid;

use crate::fields::{length, value};

/// Particles are around another one as far as their domains reach, and by this share further \[-\].
const MARGIN: f64 = 0.25;

/// The farthest place from a particle at which its value is carried on, over the half-lengths of its domain \[-\].
const FARTHEST: f64 = 2.0;

/// Particles are as near to a place as another one up to this share of the half-lengths of its domain \[-\].
const TIED: f64 = 1e-9;

/// Least change of a field for a unit of length that the particles can tell, as a share of their spread \[-\].
const FLAT: f64 = 1e-12;

/// A place in a body: the particles nearest to it.
#[derive(Clone, Debug)]
pub struct Place {
    /// The number of the nearest particle.
    pub nearest: usize,
    /// That particle, and those of the same soil that are as near.
    anchors: Vec<Anchor>,
    /// How many soils there are, through which laws are numbered.
    soils: usize,
}

/// A particle whose value is carried on to a place, and those of the same soil around it. Directions that a plane problem does
/// not have are zero.
#[derive(Clone, Debug)]
struct Anchor {
    /// The number of the particle.
    number: usize,
    /// From that particle to the place \[m\].
    offset: [f64; 3],
    /// Numbers of those around it, and the way to them \[m\].
    around: Vec<(usize, [f64; 3])>,
}

impl Place {
    /// The place of a point \[m\] near a particle, where the particles stand now. Laws are numbered through the `soils`, once or several times.
    pub fn near<const D: usize>(
        particles: &Particles<D>,
        particle: usize,
        point: &[f64; D],
        soils: usize,
    ) -> Self {
        let distance = |other: usize| {
            let way = way(&particles.x[other], point);
            way.iter().map(|x| x * x).sum::<f64>().sqrt()
        };
        let least = distance(particle);
        let half_length = particles.half_length[particle].iter().copied();
        let apart = TIED * half_length.fold(0.0, f64::max);
        let is_tied = |&other: &usize| {
            particles.law[other] % soils == particles.law[particle] % soils
                && (distance(other) - least).abs() <= apart
        };
        Self {
            nearest: particles.number[particle],
            anchors: (0..particles.len())
                .filter(is_tied)
                .map(|tied| Anchor::of(particles, tied, point, soils))
                .collect(),
            soils,
        }
    }

    /// A field at the place, in SI units; stresses compression positive. `laws` are those that the particles refer to, and `grid` is
    /// that of their last step. The length of a vector is that of its components there.
    pub fn field<const D: usize>(
        &self,
        field: Field,
        particles: &Particles<D>,
        laws: &[SharedLaw],
        grid: &Grid<D>,
    ) -> f64 {
        let values = |p: usize| value(field, particles, p, laws);
        let vector = |vectors: &[[f64; D]]| {
            let component = |axis: usize| self.value(particles, |p| vectors[p][axis]);
            length::<D>(&std::array::from_fn(component))
        };
        let read = |field| self.field(field, particles, laws, grid);
        // The sum of the readings of each.
        let total = |effective| read(effective) + read(Field::U);
        match field {
            Field::Displacement => vector(&particles.displacement),
            Field::Speed => vector(&particles.velocity),
            Field::Acceleration => vector(&particles.acceleration),
            Field::DisplacementX
            | Field::DisplacementY
            | Field::DisplacementZ
            | Field::X
            | Field::Y
            | Field::Z
            | Field::VelocityX
            | Field::VelocityY
            | Field::VelocityZ
            | Field::AccelerationX
            | Field::AccelerationY
            | Field::AccelerationZ => self.value(particles, values),
            Field::SigmaXx => total(Field::SigmaEffXx),
            Field::SigmaYy => total(Field::SigmaEffYy),
            Field::SigmaZz => total(Field::SigmaEffZz),
            Field::P => total(Field::PEff),
            // Given pore pressure is known at every particle.
            Field::U => {
                let excess = self.by_cells(particles, grid, field, |p| particles.excess[p]);
                self.value(particles, |p| particles.pore_pressure[p]) + excess
            }
            _ => self.by_cells(particles, grid, field, values),
        }
    }

    /// The value at the place of a field that is nearly constant in a cell: the mean of the cells that the nearest particles lie
    /// in, each carried on along the plane through the means around, as far as the field can go.
    fn by_cells<const D: usize>(
        &self,
        particles: &Particles<D>,
        grid: &Grid<D>,
        field: Field,
        values: impl Fn(usize) -> f64,
    ) -> f64 {
        let read = |anchor: &Anchor| {
            let (value, range) = anchor.by_cells(particles, grid, self.soils, &values)?;
            Some(kept(field, value, range))
        };
        mean(self.anchors.iter().filter_map(read))
    }

    /// The value of a field of particles at the place, the mean of those that its nearest particles tell; not a number where none
    /// of them is there.
    pub fn value<const D: usize>(
        &self,
        particles: &Particles<D>,
        field: impl Fn(usize) -> f64,
    ) -> f64 {
        let values = self.anchors.iter();
        mean(values.filter_map(|anchor| anchor.value(particles, &field)))
    }
}

/// A value that was carried on, kept to the range of its field (theory, eq. 40i). Accumulated strain and shares of strength stay
/// in the range of the particles that they were read from. Deviatoric stress does where it would be negative: where it grows
/// with the depth a line is right.
fn kept(field: Field, value: f64, [least, most]: [f64; 2]) -> f64 {
    match field {
        Field::PlasticStrain | Field::Utilisation if least <= most => value.clamp(least, most),
        Field::Q if value < 0.0 => least,
        _ => value,
    }
}

/// The mean of values; not a number without any.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), x| (sum + x, count + 1.0));
    sum / count
}

impl Anchor {
    fn of<const D: usize>(
        particles: &Particles<D>,
        particle: usize,
        point: &[f64; D],
        soils: usize,
    ) -> Self {
        let (x, half_length) = (&particles.x, &particles.half_length);
        let is_around = |other: usize| {
            other != particle
                && particles.law[other] % soils == particles.law[particle] % soils
                && (0..D).all(|axis| {
                    let reach = half_length[particle][axis] + half_length[other][axis];
                    (x[other][axis] - x[particle][axis]).abs() <= (1.0 + MARGIN) * reach
                })
        };
        let mut offset = way(&x[particle], point);
        for axis in 0..D {
            let farthest = FARTHEST * half_length[particle][axis];
            offset[axis] = offset[axis].clamp(-farthest, farthest);
        }
        Self {
            number: particles.number[particle],
            offset,
            around: (0..particles.len())
                .filter(|&other| is_around(other))
                .map(|other| (particles.number[other], way(&x[particle], &x[other])))
                .collect(),
        }
    }

    /// The value that the particle tells of a field at the place; none where it is not there.
    fn value<const D: usize>(
        &self,
        particles: &Particles<D>,
        field: impl Fn(usize) -> f64,
    ) -> Option<f64> {
        let value = field(particles.place_of(self.number)?);
        if self.offset.iter().all(|&offset| offset == 0.0) {
            return Some(value);
        }
        let changes = self.around.iter().filter_map(|(number, way)| {
            let change = field(particles.place_of(*number)?) - value;
            change.is_finite().then_some((*way, change, 1.0))
        });
        Some(value + along_plane(&self.offset, 1.0, &changes.collect::<Vec<_>>()))
    }

    /// The value at the place by the means of the particle's cell and of those around it, and the range of the particles there;
    /// none where the particle is not there.
    fn by_cells<const D: usize>(
        &self,
        particles: &Particles<D>,
        grid: &Grid<D>,
        soils: usize,
        field: impl Fn(usize) -> f64,
    ) -> Option<(f64, [f64; 2])> {
        let particle = particles.place_of(self.number)?;
        let Some(centre) = grid.cell_at(&particles.x[particle]) else {
            let value = field(particle);
            return Some((value, [value; 2]));
        };
        let mut cells = means_around((particles, soils), grid, (particle, centre), field);
        let ranges = cells.iter().map(|(_, mean)| mean.range);
        let range = ranges.fold(NO_RANGE, |all, range| {
            [all[0].min(range[0]), all[1].max(range[1])]
        });
        let Some(index) = cells.iter().position(|(cell, _)| *cell == centre) else {
            return Some((f64::NAN, range));
        };
        let mean = cells.swap_remove(index).1.finished();
        let offset = std::array::from_fn(|axis| self.offset[axis] - mean.place[axis]);
        let changes = cells.into_iter().map(|(_, other)| {
            let other = other.finished();
            let way = std::array::from_fn(|axis| other.place[axis] - mean.place[axis]);
            (way, other.value - mean.value, other.volume)
        });
        let change = along_plane(&offset, mean.volume, &changes.collect::<Vec<_>>());
        Some((mean.value + change, range))
    }
}

/// Sums over the soil of a particle in its cell and in those around it, with places seen from the particle.
fn means_around<const D: usize>(
    (particles, soils): (&Particles<D>, usize),
    grid: &Grid<D>,
    (particle, centre): (usize, [usize; D]),
    field: impl Fn(usize) -> f64,
) -> Vec<([usize; D], CellMean)> {
    let is_around = |cell: &[usize; D]| (0..D).all(|axis| cell[axis].abs_diff(centre[axis]) <= 1);
    let mut cells: Vec<([usize; D], CellMean)> = Vec::new();
    for other in 0..particles.len() {
        if particles.law[other] % soils != particles.law[particle] % soils {
            continue;
        }
        let Some(cell) = grid.cell_at(&particles.x[other]).filter(is_around) else {
            continue;
        };
        let value = field(other);
        if !value.is_finite() {
            continue;
        }
        let found = cells.iter().position(|(known, _)| *known == cell);
        let found = found.unwrap_or_else(|| {
            cells.push((cell, CellMean::default()));
            cells.len() - 1
        });
        let place = way(&particles.x[particle], &particles.x[other]);
        cells[found].1.add(particles.volume(other), place, value);
    }
    cells
}

/// The range of no values.
const NO_RANGE: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// The mean of a field over the particles of a cell by their volume, its place seen from a particle \[m\], and its least and its
/// greatest value.
#[derive(Clone, Copy, Debug)]
struct CellMean {
    volume: f64,
    place: [f64; 3],
    value: f64,
    range: [f64; 2],
}

impl Default for CellMean {
    fn default() -> Self {
        Self {
            volume: 0.0,
            place: [0.0; 3],
            value: 0.0,
            range: NO_RANGE,
        }
    }
}

impl CellMean {
    fn add(&mut self, volume: f64, place: [f64; 3], value: f64) {
        self.volume += volume;
        self.value += volume * value;
        self.range = [self.range[0].min(value), self.range[1].max(value)];
        for axis in 0..3 {
            self.place[axis] += volume * place[axis];
        }
    }

    /// The sums over the volume.
    fn finished(self) -> Self {
        Self {
            volume: self.volume,
            place: self.place.map(|sum| sum / self.volume),
            value: self.value / self.volume,
            range: self.range,
        }
    }
}

/// The way from a point to another one \[m\].
fn way<const D: usize>(from: &[f64; D], to: &[f64; D]) -> [f64; 3] {
    let mut way = [0.0; 3];
    for axis in 0..D {
        way[axis] = to[axis] - from[axis];
    }
    way
}

/// How much a field changes on the way to an offset \[m\], from its changes on the ways to others, each with its weight: along the
/// plane with the least squares through all of them and the start, and by no more than on any of the ways. Directions that no way
/// has have no slope.
fn along_plane(offset: &[f64; 3], weight: f64, changes: &[([f64; 3], f64, f64)]) -> f64 {
    // The start is one of the points, without way and change.
    let weights = changes.iter().map(|(.., factor)| factor);
    let total = weights.fold(weight, |sum, factor| sum + factor);
    let (mut middle, mut mean) = ([0.0; 3], 0.0);
    for (way, change, factor) in changes {
        mean += factor * change / total;
        for axis in 0..3 {
            middle[axis] += factor * way[axis] / total;
        }
    }
    let (mut squares, mut products) = ([[0.0; 3]; 3], [0.0; 3]);
    for (way, change, factor) in changes.iter().chain(&[([0.0; 3], 0.0, weight)]) {
        let from_middle: [f64; 3] = std::array::from_fn(|axis| way[axis] - middle[axis]);
        for row in 0..3 {
            products[row] += factor * from_middle[row] * (change - mean);
            for column in 0..3 {
                squares[row][column] += factor * from_middle[row] * from_middle[column];
            }
        }
    }
    let spread: f64 = (0..3).map(|axis| squares[axis][axis]).sum();
    if spread <= 0.0 {
        return 0.0;
    }
    for axis in 0..3 {
        squares[axis][axis] += FLAT * spread;
    }
    let slope = solved(squares, products);
    let change: f64 = std::iter::zip(slope, offset).map(|(s, o)| s * o).sum();
    let largest = changes.iter().fold(0.0, |largest: f64, (_, change, _)| {
        largest.max(change.abs())
    });
    change.clamp(-largest, largest)
}

/// The solution of a symmetric positive system, by elimination.
fn solved(mut matrix: [[f64; 3]; 3], mut right: [f64; 3]) -> [f64; 3] {
    for pivot in 0..3 {
        for row in pivot + 1..3 {
            let factor = matrix[row][pivot] / matrix[pivot][pivot];
            for column in pivot..3 {
                matrix[row][column] -= factor * matrix[pivot][column];
            }
            right[row] -= factor * right[pivot];
        }
    }
    let mut solution = [0.0; 3];
    for row in (0..3).rev() {
        let known: f64 = (row + 1..3)
            .map(|column| matrix[row][column] * solution[column])
            .sum();
        solution[row] = (right[row] - known) / matrix[row][row];
    }
    solution
}

#[cfg(test)]
mod tests {
    use igimp_assembly::ParticleSeed;
    use igimp_shape::Axis;

    use super::*;

    /// Two by two points in each of six by four cells of 0.5 m.
    fn body() -> Particles<2> {
        let seed = |k: usize| ParticleSeed {
            x: [
                0.125 + 0.25 * (k % 12) as f64,
                0.125 + 0.25 * (k / 12) as f64,
            ],
            half_length: [0.125; 2],
            volume: 0.0625,
            density: 1.0,
            law: 0,
            centroid: [0.0; _],
        };
        Particles::new(&(0..96).map(seed).collect::<Vec<_>>()).unwrap()
    }

    fn place(particles: &Particles<2>, point: &[f64; 2]) -> Option<Place> {
        let nearest = crate::measure::nearest(particles, point, 1.0)?;
        Some(Place::near(particles, nearest, point, 1))
    }

    /// GOAL: a linear field is exact anywhere in the body: within, at its sides and in its corners.
    #[test]
    fn a_linear_field_is_exact() {
        let particles = body();
        let linear = |x: &[f64; 2]| 70.0 + 3.0 * x[0] - 18.0 * x[1];
        for point in [
            [1.3, 0.77],
            [0.0, 1.1],
            [3.0, 2.0],
            [0.0, 0.0],
            [1.125, 0.875],
        ] {
            let place = place(&particles, &point).unwrap();
            let value = place.value(&particles, |p| linear(&particles.x[p]));
            assert!((value - linear(&point)).abs() < 1e-9, "{point:?}: {value}");
        }
    }

    /// GOAL: at a particle the value is its own; between particles it stays between those around it.
    #[test]
    fn a_jump_is_not_overshot() {
        let particles = body();
        let jump = |p: usize| f64::from(u8::from(particles.x[p][0] > 1.5));
        let at = |x: f64| {
            let place = place(&particles, &[x, 0.9]).unwrap();
            place.value(&particles, jump)
        };
        for k in 0..60 {
            let value = at(0.05 * f64::from(k));
            assert!((-1.0..=2.0).contains(&value), "{value}");
        }
        let at_particle = place(&particles, &[1.375, 0.875]).unwrap();
        assert!(at_particle.value(&particles, jump).abs() < 1e-15);
        assert!(place(&particles, &[9.0, 0.9]).is_none());
    }

    /// GOAL: at walls, where particles have others on one side only, stress that is the same all over a cell is not tilted.
    /// ORACLE: a field of height alone is the same at every place of one height.
    #[test]
    fn neighbours_on_one_side_do_not_tilt_a_field() {
        let particles = body();
        let by_cell = |p: usize| -10.0 * (particles.x[p][1] / 0.5).floor();
        for y in [0.0, 0.3, 0.625, 0.9, 1.0, 2.0] {
            let values = [0.0, 0.1, 0.125, 0.5, 1.3, 2.9, 3.0].map(|x| {
                let place = place(&particles, &[x, y]).unwrap();
                place.value(&particles, by_cell)
            });
            let apart = values.map(|value| (value - values[4]).abs());
            assert!(apart.iter().all(|change| *change < 1e-9), "{y}: {values:?}");
        }
    }

    /// GOAL: a place that is as near to several particles takes no side. ORACLE: the mirror image of body and field.
    #[test]
    fn a_place_between_particles_takes_no_side() {
        let particles = body();
        let field = |p: usize| (3.0 * particles.x[p][0]).exp() * particles.x[p][1];
        let mirrored = |p: usize| (3.0 * (3.0 - particles.x[p][0])).exp() * particles.x[p][1];
        for point in [[0.75, 1.0], [1.5, 0.3], [1.0, 0.0], [0.1, 0.5]] {
            let value = |x: f64, field: &dyn Fn(usize) -> f64| {
                let place = place(&particles, &[x, point[1]]).unwrap();
                place.value(&particles, field)
            };
            let [original, image] = [value(point[0], &field), value(3.0 - point[0], &mirrored)];
            assert!(
                (original / image - 1.0).abs() < 1e-12,
                "{point:?}: {original} {image}"
            );
        }
    }

    /// GOAL: soil of another law across a line does not count, and a row of particles knows its own direction.
    #[test]
    fn what_is_not_known_is_flat() {
        let offset = [0.1, 0.2, 0.0];
        let row = [([0.5, 0.0, 0.0], 1.0, 1.0), ([-0.5, 0.0, 0.0], -1.0, 1.0)];
        assert!((along_plane(&offset, 1.0, &row) - 0.2).abs() < 1e-9);
        assert!(along_plane(&offset, 1.0, &[]).abs() < 1e-15);
    }

    /// GOAL: stress that is the same all over a cell is read as the linear field whose mean in the cell it is, within, at sides, at
    /// lines of the grid and in corners. A linear field is exact, too. ORACLE: the field, and no new extremes beside a jump.
    #[test]
    fn a_stair_of_a_linear_field_is_exact() {
        let particles = body();
        let axis = |cells: usize| Axis::uniform(0.0, 0.5, cells).unwrap();
        let grid = Grid {
            axes: [axis(6), axis(5)],
        };
        let linear = |x: [f64; 2]| 70.0 + 3.0 * x[0] - 18.0 * x[1];
        let middle = |p: usize| particles.x[p].map(|x| 0.5 * (x / 0.5).floor() + 0.25);
        for point in [
            [1.3, 0.77],
            [0.0, 1.1],
            [3.0, 2.0],
            [0.0, 0.0],
            [1.5, 1.0],
            [0.02, 1.99],
        ] {
            let place = place(&particles, &point).unwrap();
            let stair = place.by_cells(&particles, &grid, Field::SigmaEffYy, |p| linear(middle(p)));
            let exact = place.by_cells(&particles, &grid, Field::Q, |p| linear(particles.x[p]));
            assert!((stair - linear(point)).abs() < 1e-9, "{point:?}: {stair}");
            assert!((exact - linear(point)).abs() < 1e-9, "{point:?}: {exact}");
            let jump = |p: usize| f64::from(u8::from(particles.x[p][0] > 1.5));
            let jump = place.by_cells(&particles, &grid, Field::SigmaEffYy, jump);
            assert!((-1.0..=2.0).contains(&jump), "{point:?}: {jump}");
        }
    }

    /// GOAL: a band of plastic strain is read within the range of its particles everywhere, and stress that cannot be negative is
    /// not. ORACLE: the fields, 0 to 1 and from 0 on; the linear reading beside, which leaves both.
    #[test]
    fn no_strain_is_negative() {
        let particles = body();
        let axis = |cells: usize| Axis::uniform(0.0, 0.5, cells).unwrap();
        let grid = Grid {
            axes: [axis(6), axis(5)],
        };
        let band = |p: usize| f64::from(u8::from((1.5..2.0).contains(&particles.x[p][0])));
        let mut left = false;
        for k in 0..60 {
            let place = place(&particles, &[0.05 * f64::from(k), 0.9]).unwrap();
            let read = |field| place.by_cells(&particles, &grid, field, band);
            let linear = read(Field::SigmaEffYy);
            left |= !(-0.01..=1.01).contains(&linear);
            assert!((0.0..=1.0).contains(&read(Field::PlasticStrain)));
            assert!((0.0..=1.0).contains(&read(Field::Utilisation)));
            assert!(read(Field::Q) >= 0.0);
        }
        assert!(left);
    }
}
