//! The turn of a rigid body in a step, and its effect on arms about the reference point (theory, eqs. 48a, 48c and 67b).

use crate::rotations;

/// From this angle on closed forms keep their digits; below it series do \[rad\].
const SMALL: f64 = 1e-2;

/// The rotation R of a body over a step, from the rotation of its node in lengths.
///
/// Arms r of forces f are handed over as their sum Σ r fᵀ, first the component of the arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn<const D: usize> {
    /// R − 1 by columns.
    ways: [[f64; D]; D],
    /// R − 1 less the part linear in the rotation, by columns.
    beyond: [[f64; D]; D],
    /// T − 1 by columns: as the vector of rotation changes by dφ the body turns by T dφ. None in the plane.
    means: [[f64; D]; D],
    /// The factor by which rotations become lengths \[length\].
    size: f64,
}

impl<const D: usize> Turn<D> {
    /// That by a `rotation` in lengths of a body of a `size` \[length\].
    pub fn by(rotation: &[f64; D], size: f64) -> Self {
        let angle = angle(rotation, size);
        let axis = |k: usize| std::array::from_fn(|a| if a == k { 1.0 } else { 0.0 });
        let means: [[f64; D]; D] = std::array::from_fn(|k| mean_beyond(&angle, &axis(k)));
        let beyond = std::array::from_fn(|k| cross(&angle, &means[k]));
        let linear: [[f64; D]; D] = std::array::from_fn(|k| cross(&angle, &axis(k)));
        Self {
            ways: std::array::from_fn(|k| std::array::from_fn(|a| linear[k][a] + beyond[k][a])),
            beyond,
            means: if D == 3 { means } else { [[0.0; D]; D] },
            size,
        }
    }

    /// Σ f · (R − 1 − φ×) r of forces at arms: the work beyond that of the part linear in the rotation.
    pub fn work_beyond(&self, arms: &[[f64; D]; D]) -> f64 {
        let rows = std::iter::zip(&self.beyond, arms);
        rows.map(|(way, force)| std::iter::zip(way, force).map(|(w, f)| w * f).sum::<f64>())
            .sum()
    }

    /// Σ (R − 1) r × f of forces at arms, over the size of the body: the moment that the turn adds \[force\].
    pub fn moment_beyond(&self, arms: &[[f64; D]; D]) -> [f64; D] {
        moment(&turned(&self.ways, arms), self.size)
    }

    /// The derivative of [`Self::work_beyond`] by the rotation in lengths \[force\]: Tᵀ ( R r × f ) − r × f. In the plane that is
    /// [`Self::moment_beyond`]; in space the vector of rotation is no axis that the body turns about.
    pub fn slope_beyond(&self, arms: &[[f64; D]; D]) -> [f64; D] {
        let [beyond, start] = [self.moment_beyond(arms), moment(arms, self.size)];
        let whole: [f64; D] = std::array::from_fn(|k| beyond[k] + start[k]);
        let mean = |k: usize| -> f64 { (0..D).map(|a| self.means[k][a] * whole[a]).sum() };
        std::array::from_fn(|k| beyond[k] + mean(k))
    }

    /// The derivative of the moment R r × f of forces by the rotation, over the squared size of the body \[force/length\].
    pub fn slope_of_moment(&self, arms: &[[f64; D]; D]) -> [[f64; D]; D] {
        let mut now = turned(&self.ways, arms);
        for (now, arms) in now.iter_mut().zip(arms) {
            for (now, x) in now.iter_mut().zip(arms) {
                *now += x;
            }
        }
        self.by_vector(&by_turn(&now, self.size))
    }

    /// A derivative by the turn of the body as one by its vector of rotation: times T.
    pub(crate) fn by_vector(&self, by_turn: &[[f64; D]; D]) -> [[f64; D]; D] {
        let entry = |row: &[f64; D], k: usize| -> f64 {
            let pairs = std::iter::zip(row, &self.means[k]);
            row[k] + pairs.map(|(by_turn, mean)| by_turn * mean).sum::<f64>()
        };
        by_turn.map(|row| std::array::from_fn(|k| entry(&row, k)))
    }
}

/// The arms (R − 1) r of forces at arms r, R − 1 by columns.
fn turned<const D: usize>(ways: &[[f64; D]; D], arms: &[[f64; D]; D]) -> [[f64; D]; D] {
    let entry = |a: usize, b: usize| (0..D).map(|k| ways[k][a] * arms[k][b]).sum();
    std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b)))
}

/// The moment of forces at arms over the size of the body \[force\].
fn moment<const D: usize>(arms: &[[f64; D]; D], size: f64) -> [f64; D] {
    let mut moment = [0.0; D];
    for (k, entry) in moment.iter_mut().enumerate().take(rotations(D)) {
        let (a, b) = if D == 2 {
            (0, 1)
        } else {
            ((k + 1) % D, (k + 2) % D)
        };
        *entry = (arms[a][b] - arms[b][a]) / size;
    }
    moment
}

/// How the moment of forces at arms changes by a turn of the body, over its squared size \[force/length\]: ( dφ × r ) × f = r ( f · dφ ) − ( r · f ) dφ.
fn by_turn<const D: usize>(arms: &[[f64; D]; D], size: f64) -> [[f64; D]; D] {
    let along: f64 = (0..D).map(|a| arms[a][a]).sum();
    let mut block = [[0.0; D]; D];
    for (i, row) in block.iter_mut().enumerate().take(rotations(D)) {
        for (j, entry) in row.iter_mut().enumerate().take(rotations(D)) {
            let across = if D == 3 { arms[i][j] } else { 0.0 };
            *entry = (across - if i == j { along } else { 0.0 }) / size.powi(2);
        }
    }
    block
}

/// The rotation \[rad\] of one in lengths.
pub(crate) fn angle<const D: usize>(rotation: &[f64; D], size: f64) -> [f64; 3] {
    let mut angle = [0.0; 3];
    for (angle, x) in angle.iter_mut().zip(rotation).take(rotations(D)) {
        *angle = x / size;
    }
    angle
}

/// The mean of an arm over the turn, less the arm as the step begins: (R − 1) s = φ × (s + this).
pub(crate) fn mean_beyond<const D: usize>(angle: &[f64; 3], start: &[f64; D]) -> [f64; D] {
    let squared = angle.iter().map(|x| x * x).sum::<f64>();
    let whole = squared.sqrt();
    // (1 − cos φ) / φ² and (φ − sin φ) / φ³.
    let (once, twice) = if whole < SMALL {
        (
            0.5 - squared / 24.0 + squared * squared / 720.0,
            1.0 / 6.0 - squared / 120.0 + squared * squared / 5040.0,
        )
    } else {
        let half = (0.5 * whole).sin();
        (
            2.0 * half * half / squared,
            (whole - whole.sin()) / (squared * whole),
        )
    };
    let first = cross(angle, start);
    let second = cross(angle, &first);
    std::array::from_fn(|a| once * first[a] + twice * second[a])
}

/// The vector product of a rotation, whose first component counts in the plane, and a vector.
pub(crate) fn cross<const D: usize>(rotation: &[f64; 3], v: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|a| match D {
        2 if a == 0 => -rotation[0] * v[1],
        2 => rotation[0] * v[0],
        3 => {
            let (b, c) = ((a + 1) % 3, (a + 2) % 3);
            rotation[b] * v[c] - rotation[c] * v[b]
        }
        _ => 0.0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::turn_by;

    const SIZE: f64 = 1.25;
    const ARMS: [[f64; 3]; 2] = [[0.3, -0.5, 0.7], [-1.1, 0.2, 0.4]];
    const FORCES: [[f64; 3]; 2] = [[2.0, -1.0, 0.5], [0.3, 0.8, -0.6]];

    fn sums() -> [[f64; 3]; 3] {
        std::array::from_fn(|a| {
            std::array::from_fn(|b| (0..2).map(|k| ARMS[k][a] * FORCES[k][b]).sum())
        })
    }

    fn work(angle: [f64; 3]) -> f64 {
        let turn = turn_by::<3>(&angle);
        let of = |k: usize| -> f64 {
            let way = |a: usize| -> f64 {
                (0..3).map(|b| turn[a][b] * ARMS[k][b]).sum::<f64>() - ARMS[k][a]
            };
            (0..3).map(|a| FORCES[k][a] * way(a)).sum()
        };
        of(0) + of(1)
    }

    /// GOAL: forces whose arms turn do the work of the turn, and have its moments.
    /// CASE: two forces in space at small and large rotations.
    /// ORACLE: the rotation of a pose; the vector product of turned arms.
    #[test]
    fn arms_turn_with_the_body() {
        for by in [1e-6, 5e-3, 0.0099, 0.0101, 0.7, 3.0] {
            let rotation = [0.6 * by, -0.2 * by, 0.5 * by];
            let turn = Turn::by(&rotation.map(|x| SIZE * x), SIZE);
            let linear: f64 = (0..2)
                .map(|k| {
                    let way = cross(&rotation, &ARMS[k]);
                    (0..3).map(|a| FORCES[k][a] * way[a]).sum::<f64>()
                })
                .sum();
            assert!((linear + turn.work_beyond(&sums()) - work(rotation)).abs() < 1e-14);
            let matrix = turn_by::<3>(&rotation);
            let mut exact = [0.0; 3];
            for k in 0..2 {
                let way = |a: usize| -> f64 {
                    (0..3).map(|b| matrix[a][b] * ARMS[k][b]).sum::<f64>() - ARMS[k][a]
                };
                let moment = cross(&[way(0), way(1), way(2)], &FORCES[k]);
                exact = std::array::from_fn(|a| exact[a] + moment[a] / SIZE);
            }
            for (found, exact) in turn.moment_beyond(&sums()).iter().zip(exact) {
                assert!((found - exact).abs() < 1e-14, "{by}");
            }
        }
        let still = Turn::by(&[0.0; 3], SIZE).moment_beyond(&sums());
        assert!(still.iter().all(|x| x.abs() < 1e-300), "{still:?}");
    }

    /// GOAL: work and moment have the derivatives that Newton's method needs.
    /// CASE: two forces in space at small and large rotations.
    /// ORACLE: central differences.
    #[test]
    fn derivatives_are_those_of_the_vector_of_rotation() {
        let d = 1e-5;
        for by in [0.0, 5e-3, 0.0099, 0.0101, 0.7, 3.0] {
            let rotation = [0.6 * by, -0.2 * by, 0.5 * by].map(|x| SIZE * x);
            let turn = Turn::by(&rotation, SIZE);
            let (slope, of_moment) = (turn.slope_beyond(&sums()), turn.slope_of_moment(&sums()));
            for k in 0..3 {
                let at = |sign: f64| {
                    let mut rotation = rotation;
                    rotation[k] += sign * d;
                    Turn::by(&rotation, SIZE)
                };
                let [plus, minus] = [at(1.0), at(-1.0)];
                let [more, less] = [&plus, &minus].map(|turn| turn.work_beyond(&sums()));
                assert!((0.5 * (more - less) / d - slope[k]).abs() < 1e-8, "{by}");
                let [more, less] = [&plus, &minus].map(|turn| turn.moment_beyond(&sums()));
                for i in 0..3 {
                    let difference = 0.5 * (more[i] - less[i]) / d;
                    assert!((difference - of_moment[i][k]).abs() < 1e-8, "{by}");
                }
            }
        }
    }

    /// GOAL: in the plane too.
    /// ORACLE: a quarter turn takes a force along x at an arm along x to one at an arm along y, with the moment −1; its work is −1.
    #[test]
    fn arms_turn_in_the_plane() {
        let quarter = [std::f64::consts::FRAC_PI_2 * SIZE, 0.0];
        let turn = Turn::by(&quarter, SIZE);
        let arms = [[1.0, 0.0], [0.0, 0.0]];
        assert!((SIZE * turn.moment_beyond(&arms)[0] + 1.0).abs() < 1e-15);
        assert!((turn.work_beyond(&arms) + 1.0).abs() < 1e-15);
        assert!(turn.slope_of_moment(&arms)[0][0].abs() < 1e-15);
    }
}
