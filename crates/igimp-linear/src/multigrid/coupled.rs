//! Soil and the water in it: a preconditioner by blocks (theory, eq. 104a).
//!
//! The displacement of drained soil and the pressure of water each have a multigrid of their own. The way that soil gives
//! under a pressure stands for the elimination of displacement, at each node alone: the diagonal of Bᵀ D⁻¹ B, with the coupling
//! B and the diagonal D of the stiffness (P. Benzi, G. H. Golub and J. Liesen, *Numerical solution of saddle point problems*,
//! Acta Numerica 14 (2005), section 10).

use std::ops::Range;
use std::sync::Arc;

use super::cycle::Cycle;
use crate::{LinearSolverError, NodeBlock, Pattern, SCALAR, TangentMatrix};

/// Weight of the diagonal of Bᵀ D⁻¹ B \[-\]. A choice: 10 to 13 iterations to a residual of 1e-4 where 1 takes 13 to 20.
const GIVES: f64 = 4.0;

/// Soil and water of a matrix with scalars.
pub(super) struct Coupled {
    soil: Part,
    water: Part,
    /// Where the rows of pressures and the columns of displacements meet.
    couplings: Vec<Coupling>,
    cycles: [Cycle; 2],
    residuals: [Vec<f64>; 2],
    changes: [Vec<f64>; 2],
}

/// An entry of Bᵀ.
struct Coupling {
    pressure: u32,
    displacement: u32,
    /// Its place among the values of the whole.
    entry: u32,
    value: f64,
}

/// Rows and columns of some unknowns.
struct Part {
    /// The unknowns in the whole.
    unknowns: Vec<u32>,
    /// Places of the values in the whole.
    entries: Vec<u32>,
    /// Places of the diagonal among the values of the part.
    on_diagonal: Vec<u32>,
    matrix: TangentMatrix,
}

/// The unknowns of a node that are displacements.
fn displacements(block: &NodeBlock) -> Range<usize> {
    0..block.len - usize::from(block.free & SCALAR != 0)
}

/// The unknown of a node that is a pressure, if there is one.
fn pressures(block: &NodeBlock) -> Range<usize> {
    displacements(block).end..block.len
}

impl Part {
    /// The unknowns that `of` has of each node, as a pattern with `free` for each.
    fn new(
        pattern: &Pattern,
        of: fn(&NodeBlock) -> Range<usize>,
        free: fn(&NodeBlock) -> u8,
    ) -> Self {
        let kept: Vec<u32> = (0..pattern.blocks.len() as u32)
            .filter(|&node| !of(&pattern.blocks[node as usize]).is_empty())
            .collect();
        let mut index = vec![u32::MAX; pattern.blocks.len()];
        let (mut blocks, mut unknowns) = (Vec::with_capacity(kept.len()), Vec::new());
        for (number, &node) in kept.iter().enumerate() {
            index[node as usize] = number as u32;
            let block = &pattern.blocks[node as usize];
            let range = of(block);
            blocks.push(NodeBlock {
                first: unknowns.len(),
                len: range.len(),
                free: free(block),
                place: block.place,
            });
            unknowns.extend(range.map(|k| (block.first + k) as u32));
        }
        let (mut starts, mut coupled) = (vec![0], Vec::new());
        let (mut entries, mut on_diagonal) = (Vec::new(), Vec::new());
        for &node in &kept {
            let node = node as usize;
            let list = pattern.coupled_to(node);
            let known = list.iter().map(|&other| index[other as usize]);
            coupled.extend(known.filter(|&number| number != u32::MAX));
            starts.push(coupled.len());
            for column in of(&pattern.blocks[node]) {
                let mut at = pattern.first_value[node] + column * pattern.height(node);
                for &other in list {
                    let block = &pattern.blocks[other as usize];
                    for row in of(block) {
                        if other as usize == node && row == column {
                            on_diagonal.push(entries.len() as u32);
                        }
                        entries.push((at + row) as u32);
                    }
                    at += block.len;
                }
            }
        }
        let pattern = Pattern::new(blocks, starts, coupled, pattern.reach);
        Self {
            unknowns,
            entries,
            on_diagonal,
            matrix: TangentMatrix::zeros(Arc::new(pattern), true),
        }
    }

    /// Takes its values from those of the whole, times a factor.
    fn take(&mut self, values: &[f64], factor: f64) {
        for (value, &entry) in self.matrix.values.iter_mut().zip(&self.entries) {
            *value = factor * values[entry as usize];
        }
    }

    fn diagonal(&self) -> Vec<f64> {
        let places = self.on_diagonal.iter();
        places
            .map(|&place| self.matrix.values[place as usize])
            .collect()
    }

    /// The part of a vector.
    fn of(&self, whole: &[f64], part: &mut Vec<f64>) {
        part.clear();
        part.extend(self.unknowns.iter().map(|&unknown| whole[unknown as usize]));
    }

    /// Puts a part of a vector in its place.
    fn put(&self, part: &[f64], whole: &mut [f64]) {
        for (&unknown, &value) in self.unknowns.iter().zip(part) {
            whole[unknown as usize] = value;
        }
    }
}

impl Coupled {
    /// Those of a pattern.
    pub(super) fn new(pattern: &Pattern) -> Result<Self, LinearSolverError> {
        if u32::try_from(pattern.stored()).is_err() {
            return Err(LinearSolverError::OutOfMemory {
                part: "couplings of water and soil",
            });
        }
        let soil = Part::new(pattern, displacements, |block| block.free & !SCALAR);
        let water = Part::new(pattern, pressures, |_| 1);
        let cycles = [
            Cycle::new(&soil.matrix.pattern)?,
            Cycle::new(&water.matrix.pattern)?,
        ];
        let mut number = vec![0; pattern.unknowns()];
        for part in [&soil, &water] {
            for (index, &unknown) in part.unknowns.iter().enumerate() {
                number[unknown as usize] = index as u32;
            }
        }
        let mut couplings = Vec::new();
        for (node, block) in pattern.blocks.iter().enumerate() {
            for column in displacements(block) {
                let mut at = pattern.first_value[node] + column * pattern.height(node);
                for &other in pattern.coupled_to(node) {
                    let other = &pattern.blocks[other as usize];
                    couplings.extend(pressures(other).map(|row| Coupling {
                        pressure: number[other.first + row],
                        displacement: number[block.first + column],
                        entry: (at + row) as u32,
                        value: 0.0,
                    }));
                    at += other.len;
                }
            }
        }
        Ok(Self {
            soil,
            water,
            couplings,
            cycles,
            residuals: Default::default(),
            changes: Default::default(),
        })
    }

    /// Takes over the values of a matrix.
    pub(super) fn set(&mut self, matrix: &TangentMatrix) {
        self.soil.matrix.symmetric = matrix.symmetric;
        self.soil.take(&matrix.values, 1.0);
        self.water.take(&matrix.values, -1.0);
        let stiffness = self.soil.diagonal();
        for c in &mut self.couplings {
            c.value = matrix.values[c.entry as usize];
            let gives = GIVES * c.value * c.value / stiffness[c.displacement as usize].abs();
            if gives.is_finite() {
                let place = self.water.on_diagonal[c.pressure as usize];
                self.water.matrix.values[place as usize] += gives;
            }
        }
        let parts = [&self.soil, &self.water];
        for (cycle, part) in self.cycles.iter_mut().zip(parts) {
            cycle.set(&part.matrix, &part.diagonal());
        }
    }

    /// z ← P⁻¹ r: displacement of soil without water, and pressure of the residual.
    pub(super) fn apply(&mut self, r: &[f64], z: &mut [f64]) {
        let Self {
            soil,
            water,
            couplings,
            cycles: [of_soil, of_water],
            residuals: [soil_residual, water_residual],
            changes: [moved, pressed],
        } = self;
        soil.of(r, soil_residual);
        water.of(r, water_residual);
        moved.resize(soil_residual.len(), 0.0);
        pressed.resize(water_residual.len(), 0.0);
        of_soil.apply(&soil.matrix, soil_residual, moved);
        for residual in &mut *water_residual {
            *residual = -*residual;
        }
        for c in &*couplings {
            water_residual[c.pressure as usize] += c.value * moved[c.displacement as usize];
        }
        of_water.apply(&water.matrix, water_residual, pressed);
        soil.put(moved, z);
        water.put(pressed, z);
    }

    /// Number of unknowns.
    pub(super) fn unknowns(&self) -> usize {
        self.soil.unknowns.len() + self.water.unknowns.len()
    }

    /// Number of grids.
    pub(super) fn levels(&self) -> usize {
        self.cycles[0].levels()
    }
}
