//! The equilibrium of one particle, linearised: its nodal force and the blocks of its tangent.
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
//! not pushed and the three terms of the changing geometry are absent.

use igimp_shape::Support;

use crate::kinematics::ParticleTrial;
use crate::method::Kinematics;
use crate::small::transpose_apply;

/// One support of a linearised particle; everything that a block needs, volume included in the
/// row factors.
#[derive(Clone, Copy, Debug)]
struct Row<const D: usize> {
    g: [f64; D],
    g_bar: [f64; D],
    d: [f64; D],
    /// V (g_ib A_abcd + d_ia A_ppcd), by a, c, d.
    y: [[[f64; D]; D]; D],
    /// V (g_ib A_abqq + d_ia A_ppqq), by a.
    z: [f64; D],
    /// V (p g_ja − (τ g_j)_a); zero in small strain.
    w: [f64; D],
    /// V p ḡ_ja; zero in small strain.
    w_bar: [f64; D],
}

/// Scratch for one particle after another.
#[derive(Debug, Default)]
pub(crate) struct Linearised<const D: usize> {
    rows: Vec<Row<D>>,
}

impl<const D: usize> Linearised<D> {
    /// Prepares the blocks of a particle.
    pub(crate) fn set(
        &mut self,
        supports: &[Support<D>],
        trial: &ParticleTrial<D>,
        volume: f64,
        kinematics: Kinematics,
    ) {
        let tangent = &trial.lifted.tangent;
        let tau = &trial.lifted.tau;
        let geometric = match kinematics {
            Kinematics::FiniteStrain => volume,
            Kinematics::SmallStrain => 0.0,
        };
        let p = (tau[0][0] + tau[1][1] + tau[2][2]) / 3.0;
        self.rows.clear();
        for support in supports {
            let (g, g_bar) = pushed(support, trial);
            let mut row = Row {
                g,
                g_bar,
                d: std::array::from_fn(|a| (g_bar[a] - g[a]) / 3.0),
                y: [[[0.0; D]; D]; D],
                z: [0.0; D],
                w: [0.0; D],
                w_bar: g_bar.map(|component| geometric * p * component),
            };
            for a in 0..D {
                let mut tau_g = 0.0;
                let mut z = row.d[a] * tangent.trace;
                for b in 0..D {
                    tau_g += tau[a][b] * g[b];
                    z += g[b] * tangent.trace_right[a][b];
                }
                row.z[a] = volume * z;
                row.w[a] = geometric * (p * g[a] - tau_g);
                for c in 0..D {
                    for d in 0..D {
                        let mut y = row.d[a] * tangent.trace_left[c][d];
                        for b in 0..D {
                            y += g[b] * tangent.modulus[a][b][c][d];
                        }
                        row.y[a][c][d] = volume * y;
                    }
                }
            }
            self.rows.push(row);
        }
    }

    /// The block K_(ia)(jc) of supports i and j, by a and c.
    #[inline]
    pub(crate) fn block(&self, i: usize, j: usize) -> [[f64; D]; D] {
        let (row, column) = (&self.rows[i], &self.rows[j]);
        let mut block = [[0.0; D]; D];
        for a in 0..D {
            for c in 0..D {
                let mut value = row.z[a] * column.d[c] + column.w[a] * row.g[c]
                    - column.w_bar[a] * row.g_bar[c];
                for d in 0..D {
                    value += row.y[a][c][d] * column.g[d];
                }
                block[a][c] = value;
            }
        }
        block
    }
}

/// The internal force of one particle on one of its nodes.
#[inline]
pub(crate) fn internal_force<const D: usize>(
    support: &Support<D>,
    trial: &ParticleTrial<D>,
    volume: f64,
) -> [f64; D] {
    let tau = &trial.lifted.tau;
    let p = (tau[0][0] + tau[1][1] + tau[2][2]) / 3.0;
    let (g, g_bar) = pushed(support, trial);
    std::array::from_fn(|a| {
        let mut force = p * (g_bar[a] - g[a]);
        for b in 0..D {
            force += tau[a][b] * g[b];
        }
        volume * force
    })
}

#[inline]
fn pushed<const D: usize>(support: &Support<D>, trial: &ParticleTrial<D>) -> ([f64; D], [f64; D]) {
    (
        transpose_apply(&trial.push, &support.grad),
        transpose_apply(&trial.push_bar, &support.grad_bar),
    )
}
