//! The spatial tangent: from principal axes to x, y, z.

use crate::spectral::principal::Tensor;

/// The derivative A of Kirchhoff stress by the velocity gradient,
/// $`d\tau_{ab} = A_{abcd}\,\bar l_{cd}`$ \[stress\].
///
/// $`\bar l`$ is the whole velocity gradient with respect to the current configuration,
/// spin included. In plane strain (`D = 2`) the components with zz appear in the traces only,
/// which is all that B-bar asks for.
#[derive(Debug, Clone, PartialEq)]
pub struct SpatialTangent<const D: usize> {
    /// The in-plane components $`A_{abcd}`$ \[stress\], by a, b, c, d.
    pub modulus: [[[[f64; D]; D]; D]; D],
    /// $`\sum_a A_{aacd}`$ over all three a \[stress\], by c, d.
    pub trace_left: [[f64; D]; D],
    /// $`\sum_c A_{abcc}`$ over all three c \[stress\], by a, b.
    pub trace_right: [[f64; D]; D],
    /// $`\sum_{ac} A_{aacc}`$ over all three a and c \[stress\].
    pub trace: f64,
}

impl<const D: usize> SpatialTangent<D> {
    /// Whether every component is a finite number.
    pub fn is_finite(&self) -> bool {
        let modulus = self.modulus.as_flattened().as_flattened().as_flattened();
        let traces = [&self.trace_left, &self.trace_right].map(|trace| trace.as_flattened());
        let values = modulus.iter().chain(traces[0]).chain(traces[1]);
        values.chain([&self.trace]).all(|value| value.is_finite())
    }

    /// From the principal axes `frame`, the normal part $`A_{aabb}`$ in `normal` and
    /// the shear part $`A_{abab}`$ off the diagonal of `shear`: in principal axes
    /// $`d\tau_{ab} = A_{abab}\,l_{ab} + A_{baba}\,l_{ba}`$.
    #[allow(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    pub(crate) fn from_principal(
        frame: &Tensor,
        normal: &[[f64; 3]; 3],
        shear: &[[f64; 3]; 3],
    ) -> Self {
        let mut tangent = Self {
            modulus: [[[[0.0; D]; D]; D]; D],
            trace_left: [[0.0; D]; D],
            trace_right: [[0.0; D]; D],
            trace: normal.iter().flatten().sum(),
        };
        let dyad = |a: usize, b: usize| -> [[f64; D]; D] {
            std::array::from_fn(|i| std::array::from_fn(|j| frame[a][i] * frame[b][j]))
        };
        for a in 0..D {
            let aa = dyad(a, a);
            let mut answer = [[0.0; D]; D];
            for b in 0..D {
                add(&mut answer, normal[a][b], &dyad(b, b));
            }
            tangent.add_product(&aa, &answer);
            add(
                &mut tangent.trace_left,
                normal[0][a] + normal[1][a] + normal[2][a],
                &aa,
            );
            add(
                &mut tangent.trace_right,
                normal[a][0] + normal[a][1] + normal[a][2],
                &aa,
            );
            for b in 0..a {
                let (ab, ba) = (dyad(a, b), dyad(b, a));
                let (mut symmetric, mut answer) = (ab, [[0.0; D]; D]);
                add(&mut symmetric, 1.0, &ba);
                add(&mut answer, shear[a][b], &ab);
                add(&mut answer, shear[b][a], &ba);
                tangent.add_product(&symmetric, &answer);
            }
        }
        tangent
    }

    /// Adds the dyadic product of two second-order tensors to the modulus.
    #[allow(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    fn add_product(&mut self, left: &[[f64; D]; D], right: &[[f64; D]; D]) {
        for a in 0..D {
            for b in 0..D {
                add(&mut self.modulus[a][b], left[a][b], right);
            }
        }
    }
}

/// Adds `factor` times `term`.
#[allow(
    clippy::inline_always,
    reason = "compiled for the instructions of the caller"
)]
#[inline(always)]
fn add<const D: usize>(sum: &mut [[f64; D]; D], factor: f64, term: &[[f64; D]; D]) {
    for i in 0..D {
        for j in 0..D {
            sum[i][j] += factor * term[i][j];
        }
    }
}
