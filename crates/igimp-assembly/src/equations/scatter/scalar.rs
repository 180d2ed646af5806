//! From the tangent of one particle with a scalar among the unknowns into the matrix: pressure or nonlocal strain stands behind the
//! displacements of its node.

use igimp_linear::Pattern;
use igimp_shape::Support;

use super::{Rows, add};
use crate::contributions::consolidation::{PressureSupport, WaterOfParticle};
use crate::contributions::nonlocal::StrainOfParticle;
use crate::equations::blocks::BlockTable;
use crate::equations::linearised::Linearised;

/// How the scalar of a support and displacements are coupled: each derivative is a share of the scalar's support by a slope of the
/// displacement's.
#[derive(Clone, Copy, Debug)]
struct Coupling<const D: usize> {
    /// Share of ∂f/∂u where f is of the scalar, and of ∂f/∂s where s is the scalar.
    shares: [f64; 2],
    /// Slope of ∂f/∂u where u is of the support, and of ∂f/∂s where f is.
    slopes: [[f64; D]; 2],
}

/// The tangent of a particle with a scalar, column by column: a row more for each support than displacements have.
#[derive(Debug, Default)]
pub(crate) struct ScalarColumns<const D: usize> {
    /// By support.
    couplings: Vec<Coupling<D>>,
    /// By support: values of its pressure; no share where it has none.
    pressures: Vec<PressureSupport<D>>,
    /// Couplings of the scalars of pairs of supports, by column and row.
    moves: Vec<f64>,
    /// The columns of one support, those of displacement first.
    columns: Vec<f64>,
}

impl<const D: usize> ScalarColumns<D> {
    /// Sets those of a particle whose water flows, with the `supports` of its displacement.
    #[inline]
    pub(crate) fn set_water(&mut self, water: &WaterOfParticle<'_, D>, supports: &[Support<D>]) {
        let rows = &mut self.pressures;
        let mut pressures = water.pressures().iter().peekable();
        rows.clear();
        self.couplings.clear();
        for (support, slope) in supports.iter().zip(water.slopes(supports)) {
            let is_here = |pressure: &&PressureSupport<D>| pressure.node as usize == support.node;
            let pressure = pressures.next_if(is_here).copied();
            let pressure = pressure.unwrap_or(PressureSupport::nothing());
            rows.push(pressure);
            self.couplings.push(Coupling {
                shares: [water.coupling(&pressure); 2],
                slopes: [slope; 2],
            });
        }
        self.moves.clear();
        for column in rows.iter() {
            self.moves
                .extend(rows.iter().map(|row| water.moves(row, column)));
        }
    }

    /// Sets those of a particle with nonlocal strain, with the `supports` of its displacement and its pushed gradients.
    #[inline]
    pub(crate) fn set_strain(
        &mut self,
        strain: &StrainOfParticle<'_, D>,
        supports: &[Support<D>],
        linearised: &Linearised<D>,
    ) {
        let gradients = std::iter::zip(linearised.g(), linearised.g_bar());
        self.couplings.clear();
        (self.couplings).extend(supports.iter().zip(gradients).map(|(support, gradients)| {
            Coupling {
                shares: strain.shares(support),
                slopes: strain.slopes(gradients),
            }
        }));
        self.moves.clear();
        for column in supports {
            self.moves
                .extend(supports.iter().map(|row| strain.moves(row, column)));
        }
    }

    /// The columns of support `j` by component, the scalar behind those of displacement, which `own` has without it.
    #[allow(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    pub(crate) fn columns<'c>(
        &'c mut self,
        j: usize,
        of_soil: [&[f64]; D],
    ) -> impl Fn(usize) -> &'c [f64] + use<'c, D> {
        let n = self.couplings.len();
        let height = n * (D + 1);
        self.columns.resize((D + 1) * height, 0.0);
        let slope = self.couplings[j].slopes[0];
        for (c, column) in of_soil.into_iter().enumerate() {
            let into = self.columns[c * height..][..height].chunks_exact_mut(D + 1);
            let parts = into.zip(column.chunks_exact(D)).zip(&self.couplings);
            for ((into, part), row) in parts {
                into[..D].copy_from_slice(part);
                into[D] = row.shares[0] * slope[c];
            }
        }
        let into = self.columns[D * height..].chunks_exact_mut(D + 1);
        let share = self.couplings[j].shares[1];
        let moves = &self.moves[j * n..][..n];
        for ((into, row), moves) in into.zip(&self.couplings).zip(moves) {
            for a in 0..D {
                into[a] = share * row.slopes[1][a];
            }
            into[D] = *moves;
        }
        let columns = &self.columns;
        move |component| &columns[component * height..][..height]
    }
}

impl Rows {
    /// Adds the tangent of one particle with a scalar, whose rows were listed with those of scalars, to the slice of values that
    /// begins at `start`.
    #[allow(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    pub(crate) fn scatter_with_scalar<const D: usize>(
        &self,
        supports: &[Support<D>],
        (table, pattern): (&BlockTable<D>, &Pattern),
        (linearised, scalar): (&mut Linearised<D>, &mut ScalarColumns<D>),
        (start, slice): (usize, &mut [f64]),
    ) {
        for (j, support) in supports.iter().enumerate() {
            let column = &table.nodes[support.node];
            if column.len == 0 && !column.has_scalar {
                continue;
            }
            let columns = scalar.columns(j, linearised.columns(j));
            let stored = pattern.values_of(column.block as usize);
            let values = &mut slice[stored.start - start..stored.end - start];
            let offsets = table.offsets_of(support.node);
            let height = pattern.height(column.block as usize);
            for run in &self.runs {
                let offset = offsets(run.code, run.block) + run.rank as usize;
                let (first, len) = (run.first as usize, run.len as usize);
                for (rank, axis) in column.components().enumerate() {
                    let sums = &mut values[rank * height + offset..];
                    add(sums, &columns(axis)[first..], len);
                }
                if column.has_scalar {
                    let sums = &mut values[usize::from(column.len) * height + offset..];
                    add(sums, &columns(D)[first..], len);
                }
            }
        }
    }
}
