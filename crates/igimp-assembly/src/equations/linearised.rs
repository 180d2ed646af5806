//! The equilibrium of one particle, linearised: its nodal force and the columns of its tangent. For an
//! elastic law the force is the derivative of the stored energy (theory, eqs. 15a and 16a).
//!
//! With gradients pushed to the trial state, `g_i = ΔF⁻ᵀ ∇S_i`, `ḡ_i = ΔF_c⁻ᵀ ∇S̄_i`,
//! `d_i = (ḡ_i − g_i)/3` and `p = tr τ / 3` (theory, eq. 16–18):
//!
//! ```math
//! f_i = V\,[\tau g_i + 3p\,d_i],\qquad
//! K_{(ia)(jc)} = V\,\{ (g_{ib} A_{abcd} + d_{ia} A_{ppcd})\,g_{jd}
//!   + (g_{ib} A_{abqq} + d_{ia} A_{ppqq})\,d_{jc}
//!   - (\tau g_j)_a g_{ic} + p\,[g_{ja} g_{ic} - \bar g_{ja} \bar g_{ic}] \}
//! ```
//!
//! The repeated pairs pp and qq run over all three directions. In small strain the gradients are
//! not pushed and the three terms of the changing geometry are absent (eqs. 11 and 11a).
//!
//! Sorted by the gradients of the column this is
//!
//! ```math
//! K_{(ia)(jc)} = \sum_d y^{d}_{iac}\,g_{jd} + \sum_d h^{d}_{iac}\,\bar g_{jd},
//! ```
//! ```math
//! z_{ia} = V\,(g_{ib} A_{abqq} + d_{ia} A_{ppqq}),\quad
//! y^{d}_{iac} = V\,\{g_{ib} (A_{abcd} + (p\,\delta_{ad} - \tau_{ad})\,\delta_{bc}) + d_{ia} A_{ppcd}\}
//!   - \tfrac13 z_{ia}\delta_{cd},\quad
//! h^{d}_{iac} = \tfrac13 z_{ia}\delta_{cd} - V p\,\bar g_{ic}\,\delta_{ad},
//! ```
//!
//! with factors y and h that are computed once for each row and serve all columns. They are kept as
//! vectors over the rows, so that a column is a sum of long products.

use igimp_shape::Support;

use crate::equations::kinematics::Linearisation;
use crate::method::Kinematics;
use crate::step::hoops::{Around, Hoop};
use igimp_shape::matrices::transpose_apply;

/// Numbers that are worked on together.
const LANES: usize = 4;

/// The tangent of stress of a particle, as the factors of the rows need it.
#[derive(Clone, Debug)]
pub(crate) struct Moduli<const D: usize> {
    /// V (A_abcd + (p δ_ad − τ_ad) δ_bc) by c, d, b, a \[energy\].
    pub(crate) modulus: [[[[f64; D]; D]; D]; D],
    /// V A_ppcd / 3 by c, d \[energy\].
    pub(crate) left: [[f64; D]; D],
    /// V A_abqq / 3 by b, a \[energy\].
    pub(crate) right: [[f64; D]; D],
    /// V A_ppqq / 9 \[energy\].
    pub(crate) trace: f64,
    /// V p, zero in small strain \[energy\].
    pub(crate) vp: f64,
}

impl<const D: usize> Moduli<D> {
    /// Those of a particle of volume `volume`.
    #[allow(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    pub(crate) fn of(point: &Linearisation<D>, volume: f64, kinematics: Kinematics) -> Self {
        let tangent = point.lifted.tangent();
        let tau = &point.lifted.tau;
        let p = (tau[0][0] + tau[1][1] + tau[2][2]) / 3.0;
        let geometric = match kinematics {
            Kinematics::FiniteStrain => volume,
            Kinematics::SmallStrain => 0.0,
        };
        let vp = geometric * p;
        let mut modulus = [[[[0.0; D]; D]; D]; D];
        let mut left = [[0.0; D]; D];
        let mut right = [[0.0; D]; D];
        let third = volume / 3.0;
        for a in 0..D {
            for b in 0..D {
                for c in 0..D {
                    for d in 0..D {
                        modulus[c][d][b][a] = volume * tangent.modulus[a][b][c][d];
                    }
                }
                for d in 0..D {
                    modulus[b][d][b][a] -= geometric * tau[a][d];
                }
                modulus[b][a][b][a] += vp;
                left[a][b] = third * tangent.trace_left[a][b];
                right[b][a] = third * tangent.trace_right[a][b];
            }
        }
        Self {
            modulus,
            left,
            right,
            trace: third * tangent.trace / 3.0,
            vp,
        }
    }
}

/// Moduli of a particle of a body of revolution in the direction around the axis, t (theory,
/// eq. 130e).
struct HoopModuli<const D: usize> {
    /// V A_ttcd by c, d \[energy\].
    row: [[f64; D]; D],
    /// V A_abtt by b, a \[energy\].
    column: [[f64; D]; D],
    /// V (A_tttt + p − τ_tt) \[energy\].
    both: f64,
    /// V A_pptt / 3 \[energy\].
    left: f64,
    /// V A_ttqq / 3 \[energy\].
    right: f64,
}

impl<const D: usize> HoopModuli<D> {
    /// Those of a particle of volume `volume`: sums over all directions less those over the plane.
    fn of(point: &Linearisation<D>, volume: f64, kinematics: Kinematics) -> Self {
        let (tangent, tau) = (point.lifted.tangent(), &point.lifted.tau);
        let (mut row, mut column) = ([[0.0; D]; D], [[0.0; D]; D]);
        for c in 0..D {
            for d in 0..D {
                let in_plane = (0..D).fold([0.0; 2], |[row, column], a| {
                    let modulus = &tangent.modulus;
                    [row + modulus[a][a][c][d], column + modulus[c][d][a][a]]
                });
                row[c][d] = volume * (tangent.trace_left[c][d] - in_plane[0]);
                column[d][c] = volume * (tangent.trace_right[c][d] - in_plane[1]);
            }
        }
        let (mut left, mut right, mut both) = (tangent.trace, tangent.trace, 0.0);
        for a in 0..D {
            left -= tangent.trace_left[a][a];
            right -= tangent.trace_right[a][a];
            both -= column[a][a];
        }
        let [left, right] = [left, right].map(|sum| volume * sum);
        let geometric = match kinematics {
            Kinematics::FiniteStrain => (tau[0][0] + tau[1][1] - 2.0 * tau[2][2]) / 3.0,
            Kinematics::SmallStrain => 0.0,
        };
        Self {
            row,
            column,
            both: left + both + volume * geometric,
            left: left / 3.0,
            right: right / 3.0,
        }
    }
}

/// One particle after another.
#[derive(Debug, Default)]
pub(crate) struct Linearised<const D: usize> {
    /// Pushed gradients g by support.
    g: Vec<[f64; D]>,
    /// Pushed cell-averaged gradients ḡ by support.
    g_bar: Vec<[f64; D]>,
    /// Pushed stretch around the axis by support, t_i and t̄_i; none unless the section is axisymmetric.
    hoops: Vec<Hoop>,
    /// The factors y by c, d and rows (i, a), the rows filled up to full lanes.
    y: Vec<[f64; LANES]>,
    /// The factors h, in the same way.
    h: Vec<[f64; LANES]>,
    /// The columns of one support by c and rows.
    columns: Vec<[f64; LANES]>,
    /// The factors of t_j and of t̄_j, by rows.
    around: [Vec<[f64; LANES]>; 2],
    /// Lanes of a vector.
    lanes: usize,
}

impl<const D: usize> Linearised<D> {
    /// Pushes the gradients of a particle forward.
    #[inline]
    pub(crate) fn push(
        &mut self,
        (supports, around): (&[Support<D>], Option<Around<'_>>),
        point: &Linearisation<D>,
    ) {
        self.g.clear();
        self.g_bar.clear();
        self.hoops.clear();
        if let Some(Around { hoops, push }) = around {
            self.hoops.extend(hoops.iter().map(|hoop| hoop.times(push)));
        }
        let g = |support: &Support<D>| transpose_apply(&point.push, &support.grad);
        let g_bar = |support: &Support<D>| transpose_apply(&point.push_bar, &support.grad_bar);
        self.g.extend(supports.iter().map(g));
        self.g_bar.extend(supports.iter().map(g_bar));
    }

    /// Pushed gradients g by support.
    pub(crate) fn g(&self) -> &[[f64; D]] {
        &self.g
    }

    /// Pushed cell-averaged gradients ḡ by support.
    pub(crate) fn g_bar(&self) -> &[[f64; D]] {
        &self.g_bar
    }

    /// The internal forces on the supports of a particle of volume `volume`.
    #[inline]
    pub(crate) fn forces(
        &self,
        point: &Linearisation<D>,
        volume: f64,
    ) -> impl Iterator<Item = [f64; D]> {
        let mut tau = point.lifted.tau;
        let p = (tau[0][0] + tau[1][1] + tau[2][2]) / 3.0;
        for a in 0..D {
            tau[a][a] -= p;
        }
        std::iter::zip(&self.g, &self.g_bar).map(move |(g, g_bar)| {
            std::array::from_fn(|a| {
                let mut force = p * g_bar[a];
                for b in 0..D {
                    force += tau[a][b] * g[b];
                }
                volume * force
            })
        })
    }

    /// The radial forces of the stress around the axis on the supports of a particle of volume `volume` (theory, eq. 130d); none
    /// unless the section is axisymmetric.
    #[inline]
    pub(crate) fn hoop_forces(
        &self,
        point: &Linearisation<D>,
        volume: f64,
    ) -> impl Iterator<Item = f64> {
        let tau = &point.lifted.tau;
        let p = (tau[0][0] + tau[1][1] + tau[2][2]) / 3.0;
        let deviator = tau[2][2] - p;
        (self.hoops.iter()).map(move |hoop| volume * (deviator * hoop.value + p * hoop.bar))
    }

    /// Computes the factors of the rows of a particle of volume `volume`.
    #[allow(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    pub(crate) fn linearise_particle(
        &mut self,
        point: &Linearisation<D>,
        volume: f64,
        kinematics: Kinematics,
    ) {
        let moduli = Moduli::of(point, volume, kinematics);
        self.linearise(&moduli);
        if !self.hoops.is_empty() {
            self.add_hoops(&moduli, &HoopModuli::of(point, volume, kinematics));
        }
    }

    /// Adds to the factors of the rows the terms of stretching around the axis, and sets those of its columns.
    #[inline(never)]
    fn add_hoops(&mut self, moduli: &Moduli<D>, hoop: &HoopModuli<D>) {
        for factors in &mut self.around {
            factors.clear();
            factors.resize(self.lanes, [0.0; LANES]);
        }
        let [around, around_bar] = &mut self.around;
        let (around, around_bar) = (around.as_flattened_mut(), around_bar.as_flattened_mut());
        let (y, h) = (self.y.as_flattened_mut(), self.h.as_flattened_mut());
        let stride = LANES * self.lanes;
        let pushed = std::iter::zip(&self.g, &self.g_bar).zip(&self.hoops);
        for (
            i,
            (
                (g, g_bar),
                &Hoop {
                    value: t,
                    bar: t_bar,
                    ..
                },
            ),
        ) in pushed.enumerate()
        {
            let added = moduli.trace * (t_bar - t) + hoop.right * t;
            for c in 0..D {
                for d in 0..D {
                    let place = (c * D + d) * stride + i * D;
                    y[place] += moduli.left[c][d] * (t_bar - t) + hoop.row[c][d] * t;
                    if c == d {
                        y[place] -= added;
                        h[place] += added;
                    }
                }
            }
            for a in 0..D {
                let radial = if a == 0 { 1.0 } else { 0.0 };
                let d_3 = g_bar[a] - g[a] + radial * (t_bar - t);
                let mut z = moduli.trace * d_3 + radial * hoop.right * t;
                let mut sum = hoop.left * d_3 + radial * hoop.both * t;
                for b in 0..D {
                    z += moduli.right[b][a] * g[b];
                    sum += hoop.column[b][a] * g[b];
                }
                around[i * D + a] = sum - z;
                around_bar[i * D + a] = z - radial * moduli.vp * t_bar;
            }
        }
    }

    /// Computes the factors of the rows.
    #[allow(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    pub(crate) fn linearise(&mut self, moduli: &Moduli<D>) {
        let Moduli {
            modulus,
            left,
            right,
            trace,
            vp,
        } = moduli;
        let (trace, vp) = (*trace, *vp);
        self.lanes = (self.g.len() * D).div_ceil(LANES);
        for factors in [&mut self.y, &mut self.h] {
            factors.resize(D * D * self.lanes, [0.0; LANES]);
        }
        self.columns.resize(D * self.lanes, [0.0; LANES]);
        let (y, h) = (self.y.as_flattened_mut(), self.h.as_flattened_mut());
        let stride = LANES * self.lanes;
        for (i, (g, g_bar)) in std::iter::zip(&self.g, &self.g_bar).enumerate() {
            let d_3: [f64; D] = std::array::from_fn(|a| g_bar[a] - g[a]);
            let mut z = d_3.map(|d_3| trace * d_3);
            for b in 0..D {
                for a in 0..D {
                    z[a] += right[b][a] * g[b];
                }
            }
            for c in 0..D {
                for d in 0..D {
                    let mut y_cd: [f64; D] = std::array::from_fn(|a| left[c][d] * d_3[a]);
                    for b in 0..D {
                        for a in 0..D {
                            y_cd[a] += modulus[c][d][b][a] * g[b];
                        }
                    }
                    let mut h_cd = [0.0; D];
                    h_cd[d] = -vp * g_bar[c];
                    if c == d {
                        for a in 0..D {
                            y_cd[a] -= z[a];
                            h_cd[a] += z[a];
                        }
                    }
                    let place = (c * D + d) * stride + i * D;
                    y[place..place + D].copy_from_slice(&y_cd);
                    h[place..place + D].copy_from_slice(&h_cd);
                }
            }
        }
    }

    /// The columns (j, c) over all rows, by c.
    #[allow(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    pub(crate) fn columns(&mut self, j: usize) -> [&[f64]; D] {
        // Known lengths leave nothing of the loops: supports on 2 × 2, 2 × 3 and 3 × 3 nodes.
        match self.lanes {
            2 => self.columns_of(2, j),
            3 => self.columns_of(3, j),
            5 => self.columns_of(5, j),
            lanes => self.columns_of(lanes, j),
        }
    }

    /// The columns for so many lanes: a constant where it is called, which it has to reach the loops.
    #[allow(
        clippy::inline_always,
        reason = "otherwise the lengths of the loops are not known"
    )]
    #[inline(always)]
    fn columns_of(&mut self, lanes: usize, j: usize) -> [&[f64]; D] {
        let (g, g_bar) = (self.g[j], self.g_bar[j]);
        let factors = |all: &[[f64; LANES]]| all.len() == D * D * lanes;
        assert!(factors(&self.y) && factors(&self.h) && self.columns.len() == D * lanes);
        for c in 0..D {
            let column = &mut self.columns[c * lanes..][..lanes];
            for k in 0..lanes {
                let mut sum = [0.0; LANES];
                for d in 0..D {
                    let place = (c * D + d) * lanes + k;
                    let (y, h) = (&self.y[place], &self.h[place]);
                    for lane in 0..LANES {
                        sum[lane] += y[lane] * g[d] + h[lane] * g_bar[d];
                    }
                }
                column[k] = sum;
            }
        }
        if !self.hoops.is_empty() {
            self.add_radial_column(j);
        }
        let columns = self.columns.as_flattened();
        std::array::from_fn(|c| &columns[c * LANES * lanes..][..LANES * lanes])
    }

    /// Adds stretching around the axis to the radial column of a support.
    #[inline(never)]
    fn add_radial_column(&mut self, j: usize) {
        let (hoop, [around, around_bar]) = (self.hoops[j], &self.around);
        let radial = self.columns[..self.lanes].iter_mut();
        for (column, (value, bar)) in radial.zip(around.iter().zip(around_bar)) {
            for lane in 0..LANES {
                column[lane] += value[lane] * hoop.value + bar[lane] * hoop.bar;
            }
        }
    }
}
