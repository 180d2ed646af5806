//! Measurements on a body of particles: oscillation of a field, values along a line, averages.

pub mod place;

use igimp_assembly::Particles;

use crate::fields::length;

/// Levels between which the soil of a particle lies along an axis \[length\], by its centroid in its domain: exact where a face
/// across the axis cuts the domain.
pub fn soil_ends<const D: usize>(
    particles: &Particles<D>,
    particle: usize,
    axis: usize,
) -> [f64; 2] {
    let (x, half) = (
        particles.x[particle][axis],
        particles.half_length[particle][axis],
    );
    let off = particles.centroid[particle][axis];
    [
        x - half * (1.0 - 2.0 * off.max(0.0)),
        x + half * (1.0 + 2.0 * off.min(0.0)),
    ]
}

/// Particles sorted into square buckets, for finding neighbours.
#[derive(Clone, Debug)]
pub struct Buckets {
    size: f64,
    lower: [f64; 2],
    columns: usize,
    rows: usize,
    members: Vec<Vec<usize>>,
}

impl Buckets {
    /// Buckets of a size \[length\] for positions.
    pub fn new(x: &[[f64; 2]], size: f64) -> Self {
        let (lower, upper) = igimp_geometry::polygon::bounding_box(x);
        let count = |axis: usize| ((upper[axis] - lower[axis]) / size) as usize + 1;
        let (columns, rows) = (count(0), count(1));
        let mut buckets = Self {
            size,
            lower,
            columns,
            rows,
            members: vec![Vec::new(); columns * rows],
        };
        for (particle, position) in x.iter().enumerate() {
            let [i, j] = buckets.place(position);
            buckets.members[j as usize * columns + i as usize].push(particle);
        }
        buckets
    }

    fn place(&self, position: &[f64; 2]) -> [i64; 2] {
        std::array::from_fn(|axis| ((position[axis] - self.lower[axis]) / self.size).floor() as i64)
    }

    /// Members of the bucket of a position and of the eight around it.
    pub fn near(&self, position: &[f64; 2]) -> impl Iterator<Item = usize> + '_ {
        let [i, j] = self.place(position);
        let (columns, rows) = (self.columns as i64, self.rows as i64);
        (j - 1..=j + 1)
            .flat_map(move |row| (i - 1..=i + 1).map(move |column| (column, row)))
            .filter(move |(column, row)| (0..columns).contains(column) && (0..rows).contains(row))
            .flat_map(move |(column, row)| {
                self.members[(row * columns + column) as usize]
                    .iter()
                    .copied()
            })
    }
}

impl Buckets {
    /// The nearest member among those near a position.
    pub fn nearest(&self, x: &[[f64; 2]], position: &[f64; 2]) -> Option<usize> {
        self.near(position)
            .map(|member| (distance(&x[member], position), member))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, member)| member)
    }
}

/// Oscillation of a particle field: root mean square, over all particles with at least six
/// neighbours, of the field's deviation from the plane fitted to the particles within `radius`.
///
/// A smooth field scores its curvature over the radius, a checkerboard its amplitude.
pub fn oscillation(x: &[[f64; 2]], field: &[f64], radius: f64) -> f64 {
    let buckets = Buckets::new(x, radius);
    let (mut sum, mut count) = (0.0, 0.0);
    for particle in 0..x.len() {
        let neighbours: Vec<usize> = buckets
            .near(&x[particle])
            .filter(|&other| distance(&x[other], &x[particle]) <= radius)
            .collect();
        if neighbours.len() < 6 {
            continue;
        }
        if let Some(fitted) = plane_at(x, field, &neighbours, &x[particle]) {
            sum += (field[particle] - fitted).powi(2);
            count += 1.0;
        }
    }
    (sum / count).sqrt()
}

/// The value at `at` of the plane fitted by least squares to the named particles, if they do not
/// lie on a line.
fn plane_at(x: &[[f64; 2]], field: &[f64], particles: &[usize], at: &[f64; 2]) -> Option<f64> {
    let slope = plane(particles, |p| x[p], |p| field[p])?;
    let n = particles.len() as f64;
    let mean = |of: &dyn Fn(usize) -> f64| particles.iter().map(|&p| of(p)).sum::<f64>() / n;
    let level = mean(&|p| field[p]);
    let centre = [mean(&|p| x[p][0]), mean(&|p| x[p][1])];
    Some(level + slope[0] * (at[0] - centre[0]) + slope[1] * (at[1] - centre[1]))
}

/// The slopes of the plane fitted by least squares to the values of the named particles at their
/// places, if these do not lie on a line.
pub fn plane(
    particles: &[usize],
    x: impl Fn(usize) -> [f64; 2],
    field: impl Fn(usize) -> f64,
) -> Option<[f64; 2]> {
    let n = particles.len() as f64;
    let mean = |of: &dyn Fn(usize) -> f64| particles.iter().map(|&p| of(p)).sum::<f64>() / n;
    let centre = [mean(&|p| x(p)[0]), mean(&|p| x(p)[1])];
    let dx = |p: usize| x(p)[0] - centre[0];
    let dy = |p: usize| x(p)[1] - centre[1];
    let (xx, xy, yy) = (
        mean(&|p| dx(p) * dx(p)),
        mean(&|p| dx(p) * dy(p)),
        mean(&|p| dy(p) * dy(p)),
    );
    let (xf, yf) = (mean(&|p| dx(p) * field(p)), mean(&|p| dy(p) * field(p)));
    let determinant = xx * yy - xy * xy;
    // Also false for no particles at all.
    (determinant > 1e-9 * xx * yy).then(|| {
        [
            (xf * yy - yf * xy) / determinant,
            (yf * xx - xf * xy) / determinant,
        ]
    })
}

/// The particle nearest to a position \[length\], within `reach` \[length\] of it.
pub fn nearest<const D: usize>(
    particles: &Particles<D>,
    position: &[f64; D],
    reach: f64,
) -> Option<usize> {
    (0..particles.len())
        .map(|particle| (distance(&particles.x[particle], position), particle))
        .filter(|(distance, _)| *distance <= reach)
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, particle)| particle)
}

/// Values of a particle field along a straight line: at `points` equally spaced positions the
/// value of the nearest particle; positions without a particle within `reach` are left out.
///
/// Returns distance along the line \[length\] and value.
pub fn along_line(
    particles: &Particles<2>,
    field: &[f64],
    from: [f64; 2],
    to: [f64; 2],
    points: usize,
    reach: f64,
) -> Vec<[f64; 2]> {
    let length = distance(&from, &to);
    (0..points)
        .filter_map(|k| {
            let t = (k as f64 + 0.5) / points as f64;
            let position = std::array::from_fn(|axis| from[axis] + t * (to[axis] - from[axis]));
            nearest(particles, &position, reach).map(|particle| [t * length, field[particle]])
        })
        .collect()
}

/// Length of each particle's displacement \[length\].
pub fn displacement_norm(particles: &Particles<2>) -> Vec<f64> {
    particles
        .displacement
        .iter()
        .map(|d| d[0].hypot(d[1]))
        .collect()
}

/// One component of Cauchy stress by particle, tension positive \[force/length²\].
pub fn sigma(particles: &Particles<2>, row: usize, column: usize) -> Vec<f64> {
    particles
        .sigma
        .iter()
        .map(|sigma| sigma[row][column])
        .collect()
}

/// Accumulated plastic strain invariant by particle \[-\].
pub fn eps_p_eq(particles: &Particles<2>) -> Vec<f64> {
    particles.eps_p_eq.clone()
}

/// The domains of the particles as rectangles, corners counter-clockwise \[length\].
pub fn domains(particles: &Particles<2>) -> Vec<Vec<[f64; 2]>> {
    (particles.x.iter().enumerate())
        .map(|(particle, x)| {
            let l = particles.drawn_half_length(particle);
            [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
                .iter()
                .map(|corner| [x[0] + corner[0] * l[0], x[1] + corner[1] * l[1]])
                .collect()
        })
        .collect()
}

fn distance<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    length(&std::array::from_fn::<_, D, _>(|axis| a[axis] - b[axis]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lattice() -> Vec<[f64; 2]> {
        (0..400)
            .map(|k| [f64::from(k % 20) * 0.5, f64::from(k / 20) * 0.5])
            .collect()
    }

    #[test]
    fn a_plane_does_not_oscillate() {
        let x = lattice();
        let field: Vec<f64> = x.iter().map(|x| 3.0 - 2.0 * x[0] + 0.7 * x[1]).collect();
        assert!(oscillation(&x, &field, 1.3) < 1e-12);
    }

    #[test]
    fn a_checkerboard_scores_about_its_amplitude() {
        let x = lattice();
        let field: Vec<f64> = (0..400)
            .map(|k| {
                if (k % 20 + k / 20) % 2 == 0 {
                    1.0
                } else {
                    -1.0
                }
            })
            .collect();
        let score = oscillation(&x, &field, 1.3);
        assert!((0.8..1.2).contains(&score), "{score}");
    }
}
