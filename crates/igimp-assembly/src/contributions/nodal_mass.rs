//! The mass matrix of the grid, and the values by node that come closest to those of the particles (theory, eqs. 62 and 63).

use rayon::prelude::*;

use crate::error::AssemblyError;
use crate::step::stencils::Stencils;
use crate::step::strips::split;
use crate::step::unknowns::Unknowns;

/// The share of their momentum that the velocities of the grid leave when no more iterations are made \[-\].
const FOUND: f64 = 1e-14;

/// The share that they may leave \[-\]: nodes that few particles reach keep round-off from going further.
const ACCEPTED: f64 = 1e-9;

/// Most iterations for the velocities of the grid: the scaled matrix is well conditioned, but for nodes that few particles reach.
const MOST_ITERATIONS: usize = 500;

/// The mass matrix of the grid: the same for every component, on the nodes that carry mass.
#[derive(Debug)]
pub(crate) struct NodalMass {
    /// The nodes of the grid that carry mass, ascending.
    carrying: Vec<u32>,
    /// M_ii by node of the grid \[mass\].
    pub(crate) diagonal: Vec<f64>,
    /// Where the entries of each carrying node begin; length carrying + 1.
    first: Vec<u32>,
    /// By carrying node, the nodes behind it that it shares particles with, by their place among the carrying ones, and M_ij
    /// \[mass\].
    beyond: Vec<(u32, f64)>,
}

impl NodalMass {
    /// Sums the mass matrix over the particles, strip by strip, a share of it lumped.
    pub(crate) fn of<const D: usize>(
        lumped: f64,
        mass_of: &(dyn Fn(usize) -> f64 + Sync),
        stencils: &Stencils<D>,
        nodes: usize,
    ) -> Self {
        let mut diagonal = vec![0.0; nodes];
        let mut rows: Vec<Vec<(u32, f64)>> = vec![Vec::new(); nodes];
        for parity in 0..2 {
            let strips = stencils.strips().of_parity(parity);
            let nodes = strips.clone().map(|(nodes, _)| nodes.clone());
            let diagonal = split(&mut diagonal, nodes.clone());
            let rows = split(&mut rows, nodes);
            let tasks: Vec<_> = strips.zip(diagonal).zip(rows).collect();
            tasks
                .into_par_iter()
                .for_each(|(((nodes, slots), diagonal), rows)| {
                    for &particle in &stencils.order()[slots.clone()] {
                        let supports = stencils.of(particle as usize);
                        let m = mass_of(particle as usize);
                        for (k, row) in supports.iter().enumerate() {
                            let share = m * row.value;
                            let fraction = lumped + (1.0 - lumped) * row.value;
                            diagonal[row.node - nodes.start] += share * fraction;
                            if lumped >= 1.0 {
                                continue;
                            }
                            let row = &mut rows[row.node - nodes.start];
                            for other in &supports[k + 1..] {
                                let mass = (1.0 - lumped) * share * other.value;
                                add_entry(row, other.node as u32, mass);
                            }
                        }
                    }
                });
        }
        Self::on_carrying_nodes(diagonal, &rows)
    }

    /// The matrix with these rows, on the nodes with mass.
    fn on_carrying_nodes(diagonal: Vec<f64>, rows: &[Vec<(u32, f64)>]) -> Self {
        let carries = |node: &usize| diagonal[*node] != 0.0;
        let carrying: Vec<u32> = (0..diagonal.len())
            .filter(carries)
            .map(|node| node as u32)
            .collect();
        let mut place = vec![0; diagonal.len()];
        for (slot, &node) in carrying.iter().enumerate() {
            place[node as usize] = slot as u32;
        }
        let (mut first, mut beyond) = (vec![0], Vec::new());
        for &node in &carrying {
            let row = rows[node as usize].iter();
            let row = row.filter(|(other, _)| carries(&(*other as usize)));
            beyond.extend(row.map(|&(other, mass)| (place[other as usize], mass)));
            first.push(beyond.len() as u32);
        }
        Self {
            carrying,
            diagonal,
            first,
            beyond,
        }
    }

    /// The entries M_ij above the diagonal: nodes of the grid, and mass \[mass\].
    pub(crate) fn beyond_diagonal(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        self.rows().flat_map(move |(slot, row)| {
            let node = self.carrying[slot] as usize;
            row.iter()
                .map(move |&(other, mass)| (node, self.carrying[other as usize] as usize, mass))
        })
    }

    /// The carrying nodes with their entries behind the diagonal.
    fn rows(&self) -> impl Iterator<Item = (usize, &[(u32, f64)])> {
        let bounds = self.first.windows(2).enumerate();
        bounds.map(|(slot, of)| (slot, &self.beyond[of[0] as usize..of[1] as usize]))
    }

    /// Values by node of the grid as values by carrying node.
    fn carried<const D: usize>(&self, values: &[[f64; D]]) -> Vec<[f64; D]> {
        let nodes = self.carrying.iter();
        nodes.map(|&node| values[node as usize]).collect()
    }

    /// The product with values by node of the grid, added to a product that is zero.
    pub(crate) fn multiply<const D: usize>(&self, values: &[[f64; D]], product: &mut [[f64; D]]) {
        let mut image = vec![[0.0; D]; self.carrying.len()];
        self.image(&self.carried(values), &mut image);
        for (&node, image) in self.carrying.iter().zip(image) {
            product[node as usize] = image;
        }
    }

    /// The product with values by carrying node.
    fn image<const D: usize>(&self, values: &[[f64; D]], image: &mut [[f64; D]]) {
        for ((image, value), &node) in image.iter_mut().zip(values).zip(&self.carrying) {
            *image = value.map(|value| self.diagonal[node as usize] * value);
        }
        for (slot, row) in self.rows() {
            let (value, mut sum) = (values[slot], image[slot]);
            for &(other, mass) in row {
                let other = other as usize;
                for a in 0..D {
                    sum[a] += mass * values[other][a];
                    image[other][a] += mass * value[a];
                }
            }
            image[slot] = sum;
        }
    }

    /// Values by node whose product with the mass matrix is `sums` where a component is unknown, zero where it is not: of particle
    /// velocities weighted by mass, those of the grid that come closest to them. Conjugate gradients, scaled by the diagonal, that
    /// begin with a `guess`: nodes that no particle sees keep it.
    ///
    /// # Errors
    /// [`AssemblyError::MotionNotFound`].
    pub(crate) fn solve<const D: usize>(
        &self,
        sums: &[[f64; D]],
        mut guess: Vec<[f64; D]>,
        unknowns: &Unknowns<D>,
    ) -> Result<Vec<[f64; D]>, AssemblyError> {
        mask(&mut guess, unknowns);
        let held: Vec<(usize, usize)> = (self.carrying.iter().enumerate())
            .flat_map(|(slot, &node)| (0..D).map(move |axis| (slot, node as usize, axis)))
            .filter(|&(_, node, axis)| unknowns.index(node, axis).is_none())
            .map(|(slot, _, axis)| (slot, axis))
            .collect();
        let hold = |values: &mut [[f64; D]]| {
            for &(slot, axis) in &held {
                values[slot][axis] = 0.0;
            }
        };
        let scaled = |values: &[[f64; D]]| -> Vec<[f64; D]> {
            std::iter::zip(values, &self.carrying)
                .map(|(value, node)| {
                    let mass = self.diagonal[*node as usize];
                    value.map(|v| if mass > 0.0 { v / mass } else { 0.0 })
                })
                .collect()
        };
        let mut left = self.carried(sums);
        hold(&mut left);
        let reference = product(&left, &scaled(&left));
        if reference == 0.0 {
            guess.fill([0.0; D]);
            return Ok(guess);
        }
        let mut found = self.carried(&guess);
        let mut image = vec![[0.0; D]; found.len()];
        self.image(&found, &mut image);
        hold(&mut image);
        add_scaled(&mut left, -1.0, &image);
        let mut way = scaled(&left);
        let mut size = product(&left, &way);
        for _ in 0..MOST_ITERATIONS {
            if size <= FOUND.powi(2) * reference {
                break;
            }
            self.image(&way, &mut image);
            hold(&mut image);
            let curvature = product(&way, &image);
            // In a direction that no particle sees nothing is left to be found.
            if curvature <= 0.0 {
                break;
            }
            let length = size / curvature;
            add_scaled(&mut found, length, &way);
            add_scaled(&mut left, -length, &image);
            let towards = scaled(&left);
            let next = product(&left, &towards);
            for value in way.as_flattened_mut() {
                *value *= next / size;
            }
            add_scaled(&mut way, 1.0, &towards);
            size = next;
        }
        let left = (size / reference).sqrt();
        // Not a number is none that is small enough.
        if left > ACCEPTED || left.is_nan() {
            return Err(AssemblyError::MotionNotFound { left });
        }
        for (&node, found) in self.carrying.iter().zip(found) {
            guess[node as usize] = found;
        }
        Ok(guess)
    }
}

/// Sets to zero the components that are not unknown.
pub(crate) fn mask<const D: usize>(values: &mut [[f64; D]], unknowns: &Unknowns<D>) {
    for (node, values) in values.iter_mut().enumerate() {
        for (axis, value) in values.iter_mut().enumerate() {
            if unknowns.index(node, axis).is_none() {
                *value = 0.0;
            }
        }
    }
}

/// The sum of products of values by node.
pub(crate) fn product<const D: usize>(a: &[[f64; D]], b: &[[f64; D]]) -> f64 {
    let pairs = std::iter::zip(a.as_flattened(), b.as_flattened());
    pairs.map(|(a, b)| a * b).sum()
}

/// Adds to the entry of a node in a row.
fn add_entry(row: &mut Vec<(u32, f64)>, node: u32, mass: f64) {
    match row.iter_mut().find(|(other, _)| *other == node) {
        Some((_, sum)) => *sum += mass,
        None => row.push((node, mass)),
    }
}

/// Adds `factor` times `other` to values.
pub(crate) fn add_scaled<const D: usize>(values: &mut [[f64; D]], factor: f64, other: &[[f64; D]]) {
    for (value, other) in std::iter::zip(values.as_flattened_mut(), other.as_flattened()) {
        *value += factor * other;
    }
}
