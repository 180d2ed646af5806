//! The equations of a flow: unknown heads, their pattern, residual and tangent (theory, eqs. 78, 82 to 84).

use std::sync::Arc;

use igimp_linear::{NodeBlock, Pattern, TangentMatrix};
use igimp_shape::Grid;
use igimp_shape::matrices::apply;

use crate::basis::{Basis, CORNERS, FOUR, HIGH, Point, TWO, dot, gauss, nodes_of};
use crate::boundary::{At, Held, held};
use crate::conditions::{Conditions, FreeWater, InGround, Soil};
use crate::curve::{Curve, Relative};
use crate::error::SeepageError;
use crate::ground::{Cell, Facet, ends_of};
use crate::layers;

/// Factor of Nitsche's method: penalty on heads over k / h \[-\].
const NITSCHE: f64 = 10.0;
/// The same in cells that the ground fills in part, over k times the area of their faces with heads by their volume \[-\]: of a cell
/// that is cut gradients are large beside their work.
const CUT: f64 = 5.0;
/// How many times as large the penalty of a cut cell is, at most \[-\]: slivers are held by their neighbours.
const CUT_MOST: f64 = 10.0;
/// The same within regions, over k / h² \[-\].
const REGION: f64 = 1e3;
/// Penalty on jumps of the gradient at cells that are cut \[-\].
const GHOST: f64 = 0.01;
/// Share of the flow that heads could drive through a cell that counts \[-\]: below it round-off would decide.
const AT_REST: f64 = 0.1;
/// Equations of a cell or of two.
struct Local<'a> {
    unknowns: &'a [usize],
    residual: [f64; 2 * CORNERS],
    tangent: [[f64; 2 * CORNERS]; 2 * CORNERS],
}

impl<'a> Local<'a> {
    fn of(unknowns: &'a [usize]) -> Self {
        Self {
            unknowns,
            residual: [0.0; 2 * CORNERS],
            tangent: [[0.0; 2 * CORNERS]; 2 * CORNERS],
        }
    }
}

/// Cells that share a side of which one is cut.
#[derive(Clone, Copy, Debug)]
struct Pair {
    cells: [usize; 2],
    axis: usize,
}

/// Water that enters a cell from outside the ground.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Source<const D: usize> {
    pub(crate) x: [f64; D],
    /// Outward normal of the face that it passes; zero within the ground.
    pub(crate) normal: [f64; D],
    /// \[m^D/s\].
    pub(crate) inflow: f64,
}

/// A flow to be solved.
#[derive(Debug)]
pub(crate) struct System<'a, const D: usize> {
    pub(crate) grid: &'a Grid<D>,
    pub(crate) cells: Vec<Cell<D>>,
    pub(crate) conditions: &'a Conditions<D>,
    /// By soil, then of cells that several soils share or whose soil varies.
    tensors: Vec<[[f64; D]; D]>,
    /// By cell: the tensor of the soils that share it, or of one that varies.
    shared: Vec<Option<usize>>,
    pub(crate) held: Vec<Held<D>>,
    /// In time, by facet: the flow that its gradient drives out as a step begins \[m/s\]; none: that of the heads sought.
    pub(crate) driven: Vec<f64>,
    pairs: Vec<Pair>,
    /// By cell: the penalty on its heads over its permeability, by how little of it is ground \[1/m\].
    steep: Vec<f64>,
    /// Unknowns of the corners of each cell.
    pub(crate) corners: Vec<[usize; CORNERS]>,
    /// Node by unknown.
    pub(crate) nodes: Vec<usize>,
    pub(crate) pattern: Arc<Pattern>,
    /// Volume in which each region acts \[m^D\].
    volumes: Vec<f64>,
}

/// Flows by the condition that lets them in \[m^D/s\]: those on faces, free water, open faces, then regions; inwards positive.
///
/// Of faces inflow and outflow are summed apart by node, for the flow at single points scatters. A region has one flow.
#[derive(Clone, Debug, Default)]
pub(crate) struct Flows {
    pub(crate) inwards: Vec<f64>,
    pub(crate) outwards: Vec<f64>,
    /// Inflow by its condition and by unknown, piece by piece.
    pieces: Vec<(usize, usize, f64)>,
}

impl Flows {
    fn of(count: usize) -> Self {
        Self {
            inwards: vec![0.0; count],
            outwards: vec![0.0; count],
            pieces: Vec::new(),
        }
    }

    /// Adds up the inflow by node, and takes it as entering or leaving.
    fn add_up(&mut self) {
        // The sort is stable: pieces of a node are added in the order of cells.
        self.pieces
            .sort_by_key(|&(owner, unknown, _)| (owner, unknown));
        let of_node = |a: &(usize, usize, f64), b: &(usize, usize, f64)| (a.0, a.1) == (b.0, b.1);
        for chunk in self.pieces.chunk_by(of_node) {
            let net: f64 = chunk.iter().map(|(_, _, inwards)| inwards).sum();
            self.inwards[chunk[0].0] += net.max(0.0);
            self.outwards[chunk[0].0] += (-net).max(0.0);
        }
        self.pieces = Vec::new();
    }

    /// Adds the inflow at an unknown; that of a region at any, the same for all of it.
    fn add(&mut self, owner: usize, unknown: usize, inwards: f64) {
        self.pieces.push((owner, unknown, inwards));
    }
}

impl<'a, const D: usize> System<'a, D> {
    pub(crate) fn new(
        grid: &'a Grid<D>,
        cells: Vec<Cell<D>>,
        conditions: &'a Conditions<D>,
        free: FreeWater<'_, D>,
    ) -> Result<Self, SeepageError> {
        if cells.is_empty() {
            return Err(SeepageError::NoGround);
        }
        let mut unknown = vec![usize::MAX; grid.node_count()];
        for cell in &cells {
            for node in nodes_of(grid, cell.place) {
                unknown[node] = 0;
            }
        }
        let nodes: Vec<usize> = (0..unknown.len()).filter(|&k| unknown[k] == 0).collect();
        for (index, &node) in nodes.iter().enumerate() {
            unknown[node] = index;
        }
        let corners: Vec<[usize; CORNERS]> = (cells.iter())
            .map(|cell| {
                let mut corners = [0; CORNERS];
                for (k, node) in nodes_of(grid, cell.place).enumerate() {
                    corners[k] = unknown[node];
                }
                corners
            })
            .collect();
        let pairs = pairs(grid, &cells);
        let pattern = Arc::new(pattern(grid, &nodes, &corners, &pairs));
        let mut volumes = vec![0.0; conditions.regions.len()];
        for point in cells.iter().flat_map(|cell| &cell.points) {
            if let Some(region) = point.region {
                volumes[region] += point.volume;
            }
        }
        let held = held(&cells, conditions, free, grid);
        let steep = steep(grid, &cells, &held, conditions);
        let mut tensors: Vec<_> = conditions.soils.iter().map(Soil::tensor).collect();
        let shared = (cells.iter())
            .map(|cell| {
                let points = if cell.whole.is_some() {
                    &cell.samples
                } else {
                    &cell.points
                };
                let tensor = layers::laminate(points, &tensors)?;
                tensors.push(tensor);
                Some(tensors.len() - 1)
            })
            .collect();
        Ok(Self {
            grid,
            cells,
            conditions,
            tensors,
            shared,
            held,
            driven: Vec::new(),
            pairs,
            steep,
            corners,
            nodes,
            pattern,
            volumes,
        })
    }

    /// Number of owners of flows.
    pub(crate) fn owners(&self) -> usize {
        self.conditions.faces.len() + 2 + self.conditions.regions.len()
    }

    /// Permeability of a soil within a cell \[m/s\].
    pub(crate) fn tensor(&self, cell: usize, soil: usize) -> &[[f64; D]; D] {
        &self.tensors[self.shared[cell].unwrap_or(soil)]
    }

    fn curve(&self, soil: usize) -> Curve {
        self.conditions.soils[soil].curve
    }

    /// The heads at the corners of a cell.
    pub(crate) fn heads(&self, cell: usize, heads: &[f64]) -> [f64; CORNERS] {
        let mut corners = [0.0; CORNERS];
        for (k, head) in corners.iter_mut().enumerate().take(1 << D) {
            *head = heads[self.corners[cell][k]];
        }
        corners
    }

    /// The points of a cell with their weights and soils: as many as the flow asks for.
    pub(crate) fn points(
        &self,
        cell: usize,
        heads: &[f64; CORNERS],
        relative: &Relative,
    ) -> Vec<Point<D>> {
        let cell = &self.cells[cell];
        match cell.whole {
            Some(soil) => {
                let ends = ends_of(self.grid, cell.place);
                self.points_of_part((ends, soil), ends, heads, relative)
            }
            None => cell.points.clone(),
        }
    }

    /// The same of a part of a cell that a soil fills.
    pub(crate) fn points_of_part(
        &self,
        ([lower, upper], soil): ([[f64; D]; 2], usize),
        part: [[f64; D]; 2],
        heads: &[f64; CORNERS],
        relative: &Relative,
    ) -> Vec<Point<D>> {
        let heads = &heads[..1 << D];
        let lowest = heads.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = heads.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let is_full = relative.confined || lowest - upper[D - 1] > 0.5 * relative.width;
        let is_dry =
            self.curve(soil) == Curve::Ramp && highest - lower[D - 1] < -0.5 * relative.width;
        let along: &[(f64, f64)] = if is_full || is_dry { &TWO } else { &FOUR };
        let mut points = gauss(part, along, soil);
        for point in &mut points {
            point.volume *= self.conditions.thickness(point.x[0]);
        }
        points
    }

    /// Darcy velocity at a point of a cell \[m/s\].
    pub(crate) fn velocity(
        &self,
        cell: usize,
        point: &Point<D>,
        heads: &[f64; CORNERS],
        relative: &Relative,
    ) -> [f64; D] {
        let basis = Basis::at(ends_of(self.grid, self.cells[cell].place), &point.x);
        let psi = basis.head(heads) - point.x[D - 1];
        let [kept, _] = self.kept(relative, (cell, point.soil), psi);
        apply(&kept, &basis.slope(heads)).map(|slope| -slope)
    }

    /// The permeability \[m/s\] that soil within a cell keeps at a pressure head, and the slope of that \[1/s\].
    fn kept(
        &self,
        relative: &Relative,
        (cell, soil): (usize, usize),
        psi: f64,
    ) -> [[[f64; D]; D]; 2] {
        let shares = relative.shares(self.curve(soil), psi);
        shares.of(self.tensor(cell, soil))
    }

    /// Residual \[m^D/s\], outflow positive; tangent where there is a matrix, and flows.
    pub(crate) fn assemble(
        &self,
        heads: &[f64],
        relative: &Relative,
        mut matrix: Option<&mut TangentMatrix>,
    ) -> (Vec<f64>, Flows) {
        let mut residual = vec![0.0; heads.len()];
        let mut flows = Flows::of(self.owners());
        if let Some(matrix) = matrix.as_deref_mut() {
            matrix.values.fill(0.0);
        }
        let mut facets = self.held.iter().enumerate().peekable();
        for cell in 0..self.cells.len() {
            let corners = self.heads(cell, heads);
            let mut local = Local::of(&self.corners[cell][..1 << D]);
            self.volume(cell, &corners, relative, (&mut local, &mut flows));
            while let Some((number, held)) = facets.next_if(|(_, held)| held.cell == cell) {
                let driven = self.driven.get(number).copied();
                self.face((held, driven), &corners, relative, (&mut local, &mut flows));
            }
            add(&local, &mut residual, matrix.as_deref_mut());
        }
        for pair in &self.pairs {
            let mut unknowns = [0; 2 * CORNERS];
            for (k, cell) in pair.cells.into_iter().enumerate() {
                unknowns[k << D..(k + 1) << D].copy_from_slice(&self.corners[cell][..1 << D]);
            }
            let mut local = Local::of(&unknowns[..2 << D]);
            self.ghost(pair, heads, &mut local);
            add(&local, &mut residual, matrix.as_deref_mut());
        }
        flows.add_up();
        (residual, flows)
    }

    /// Flow through the soil of a cell, and the inflow of regions (eqs. 78 and 84).
    fn volume(
        &self,
        cell: usize,
        heads: &[f64; CORNERS],
        relative: &Relative,
        (local, flows): (&mut Local<'_>, &mut Flows),
    ) {
        let ends = ends_of(self.grid, self.cells[cell].place);
        let corners = 1 << D;
        for point in self.points(cell, heads, relative) {
            let basis = Basis::at(ends, &point.x);
            let (head, slope) = (basis.head(heads), basis.slope(heads));
            let [kept, fall] = self.kept(relative, (cell, point.soil), head - point.x[D - 1]);
            let [flux, change] = [kept, fall].map(|k| apply(&k, &slope));
            for i in 0..corners {
                local.residual[i] += point.volume * dot(&flux, &basis.gradient[i]);
                let pull = apply(&kept, &basis.gradient[i]);
                let change = point.volume * dot(&change, &basis.gradient[i]);
                for j in 0..corners {
                    local.tangent[i][j] +=
                        point.volume * dot(&pull, &basis.gradient[j]) + change * basis.value[j];
                }
            }
            let Some(region) = point.region else { continue };
            let (outflow, stiffness) = self.of_region(cell, (&point, region), head);
            flows.add(self.conditions.faces.len() + 2 + region, 0, -outflow);
            for i in 0..corners {
                local.residual[i] += outflow * basis.value[i];
                for j in 0..corners {
                    local.tangent[i][j] += stiffness * basis.value[i] * basis.value[j];
                }
            }
        }
    }

    /// The outflow to a region at a point with this head \[m^D/s\], and its slope (eq. 84).
    fn of_region(&self, cell: usize, (point, region): (&Point<D>, usize), head: f64) -> (f64, f64) {
        let size = self.grid.cell_size(self.cells[cell].place);
        let least = size.into_iter().fold(f64::INFINITY, f64::min);
        let soil = &self.conditions.soils[point.soil];
        let rate = REGION * soil.along.max(soil.across) / (least * least) * point.volume;
        match self.conditions.regions[region].condition {
            InGround::Head(wanted) => (rate * (head - wanted), rate),
            InGround::Drain if head > point.x[D - 1] => (rate * (head - point.x[D - 1]), rate),
            InGround::Inflow(all) => (-all * point.volume / self.volumes[region], 0.0),
            InGround::Drain | InGround::Soil(_) => (0.0, 0.0),
        }
    }

    /// Outflow of a cell at its corners \[m^D/s\], and all that enters it from outside the ground.
    pub(crate) fn exchange(
        &self,
        cell: usize,
        heads: &[f64; CORNERS],
        relative: &Relative,
    ) -> ([f64; CORNERS], Vec<Source<D>>) {
        let mut flows = Flows::of(self.owners());
        let mut local = Local::of(&self.corners[cell][..1 << D]);
        self.volume(cell, heads, relative, (&mut local, &mut flows));
        let mut sources = Vec::new();
        let ends = ends_of(self.grid, self.cells[cell].place);
        for point in self.points(cell, heads, relative) {
            let Some(region) = point.region else { continue };
            let head = Basis::at(ends, &point.x).head(heads);
            sources.push(Source {
                x: point.x,
                normal: [0.0; D],
                inflow: -self.of_region(cell, (&point, region), head).0,
            });
        }
        let first = self.held.partition_point(|held| held.cell < cell);
        let rest = self.held[first..].iter().enumerate();
        for (number, held) in rest.take_while(|(_, held)| held.cell == cell) {
            let driven = self.driven.get(first + number).copied();
            let before = local.residual;
            self.face((held, driven), heads, relative, (&mut local, &mut flows));
            let pairs = std::iter::zip(&before, &local.residual);
            sources.push(Source {
                x: held.facet.x,
                normal: held.facet.normal,
                inflow: pairs.map(|(before, after)| before - after).sum(),
            });
        }
        let mut leaves = [0.0; CORNERS];
        leaves.copy_from_slice(&local.residual[..CORNERS]);
        (leaves, sources)
    }

    /// The penalty on heads at a facet over the permeability across it \[1/m\].
    fn steepness(&self, held: &Held<D>) -> f64 {
        let size = self.grid.cell_size(self.cells[held.cell].place);
        let across = std::iter::zip(held.facet.normal, size);
        let height: f64 = across.map(|(normal, size)| normal.abs() * size).sum();
        let whole = NITSCHE / height;
        self.steep[held.cell].clamp(whole, CUT_MOST * whole)
    }

    /// Flow through a facet (eqs. 82 and 83).
    fn face(
        &self,
        (held, driven): (&Held<D>, Option<f64>),
        heads: &[f64; CORNERS],
        relative: &Relative,
        (local, flows): (&mut Local<'_>, &mut Flows),
    ) {
        let Facet {
            x,
            normal,
            area,
            soil,
        } = held.facet;
        let basis = Basis::at(ends_of(self.grid, self.cells[held.cell].place), &x);
        let steepness = self.steepness(held);
        let (head, slope) = (basis.head(heads), basis.slope(heads));
        let kept = |psi: f64| self.kept(relative, (held.cell, soil), psi);
        let corners = 1 << D;
        let mut passes = |inwards: f64| {
            for (unknown, value) in std::iter::zip(local.unknowns, basis.value) {
                flows.add(held.owner, *unknown, inwards * area * value);
            }
        };
        match held.at {
            At::Closed => {}
            At::Inflow(inflow) => {
                passes(inflow);
                for i in 0..corners {
                    local.residual[i] -= inflow * area * basis.value[i];
                }
            }
            At::Head(wanted) => {
                let pull = apply(&kept(wanted - x[D - 1])[0], &normal);
                let penalty = dot(&pull, &normal) * steepness;
                if let Some(driven) = driven {
                    let outflow = penalty * (head - wanted) + driven;
                    passes(-outflow);
                    for i in 0..corners {
                        local.residual[i] += area * outflow * basis.value[i];
                        for j in 0..corners {
                            local.tangent[i][j] += area * penalty * basis.value[i] * basis.value[j];
                        }
                    }
                    return;
                }
                let outflow = penalty * (head - wanted) - dot(&pull, &slope);
                passes(-outflow);
                for i in 0..corners {
                    let flux = dot(&pull, &basis.gradient[i]);
                    local.residual[i] += area * (outflow * basis.value[i] - flux * (head - wanted));
                    for j in 0..corners {
                        let other = dot(&pull, &basis.gradient[j]);
                        local.tangent[i][j] += area
                            * ((penalty * basis.value[j] - other) * basis.value[i]
                                - flux * basis.value[j]);
                    }
                }
            }
            At::Open(rain) => {
                let whole = apply(self.tensor(held.cell, soil), &normal);
                let penalty = dot(&whole, &normal) * steepness;
                let [pull, fall] = match driven {
                    Some(_) => [[0.0; D]; 2],
                    None => kept(head - x[D - 1]).map(|k| apply(&k, &normal)),
                };
                let driven = driven.unwrap_or(-dot(&pull, &slope));
                let pressed = rain + driven + penalty * (head - x[D - 1]);
                let outflow = pressed.max(0.0) - rain;
                passes(-outflow);
                for i in 0..corners {
                    local.residual[i] += area * outflow * basis.value[i];
                    for j in (0..corners).filter(|_| pressed > 0.0) {
                        let other = dot(&pull, &basis.gradient[j]);
                        local.tangent[i][j] += area
                            * basis.value[i]
                            * ((penalty - dot(&fall, &slope)) * basis.value[j] - other);
                    }
                }
            }
        }
    }

    /// By facet: the flow that the gradient of heads drives out \[m/s\].
    pub(crate) fn driven_out(&self, heads: &[f64], relative: &Relative) -> Vec<f64> {
        let out = |held: &Held<D>| {
            let Facet {
                x, normal, soil, ..
            } = held.facet;
            let corners = self.heads(held.cell, heads);
            let basis = Basis::at(ends_of(self.grid, self.cells[held.cell].place), &x);
            let head = match held.at {
                At::Head(wanted) => wanted,
                _ => basis.head(&corners),
            };
            let [kept, _] = self.kept(relative, (held.cell, soil), head - x[D - 1]);
            -dot(&apply(&kept, &normal), &basis.slope(&corners))
        };
        self.held.iter().map(out).collect()
    }

    /// Jumps of the gradient from cell to cell where one is cut: no flow follows from them.
    fn ghost(&self, pair: &Pair, heads: &[f64], local: &mut Local<'_>) {
        let axis = pair.axis;
        let ends = pair
            .cells
            .map(|cell| ends_of(self.grid, self.cells[cell].place));
        let [lower, mut upper] = ends[1];
        upper[axis] = lower[axis];
        let side: f64 = (0..D)
            .filter(|d| *d != axis)
            .map(|d| upper[d] - lower[d])
            .product();
        let side = side * self.conditions.thickness(0.5 * (lower[0] + upper[0]));
        let height = ends[1][1][axis] - lower[axis];
        let across = (pair.cells).map(|cell| self.tensor(cell, self.some_soil(cell))[axis][axis]);
        let rate = GHOST * height * across[0].min(across[1]) * side / 2_f64.powi(D as i32 - 1);
        for corner in 0..1_usize << (D - 1) {
            let mut x = lower;
            for (bit, d) in (0..D).filter(|d| *d != axis).enumerate() {
                let share = if corner >> bit & 1 == 1 {
                    HIGH
                } else {
                    1.0 - HIGH
                };
                x[d] = lower[d] + share * (upper[d] - lower[d]);
            }
            let mut jump = [0.0; 2 * CORNERS];
            for (k, sign) in [(0, -1.0), (1, 1.0)] {
                let basis = Basis::at(ends[k], &x);
                for corner in 0..1 << D {
                    jump[(k << D) + corner] = sign * basis.gradient[corner][axis];
                }
            }
            let count = 2 << D;
            let found: f64 = (0..count).map(|k| jump[k] * heads[local.unknowns[k]]).sum();
            for i in 0..count {
                local.residual[i] += rate * found * jump[i];
                for j in 0..count {
                    local.tangent[i][j] += rate * jump[i] * jump[j];
                }
            }
        }
    }

    /// The soil of a cell that has one only.
    fn some_soil(&self, cell: usize) -> usize {
        let cell = &self.cells[cell];
        cell.whole
            .unwrap_or_else(|| cell.points.first().map_or(0, |point| point.soil))
    }

    /// The flow that an imbalance is held against \[m^D/s\]: that through the ground or into storage, or where hardly any
    /// water flows the flow that its heads would drive through a cell.
    pub(crate) fn scale(&self, heads: &[f64], flows: &Flows, moved: f64) -> f64 {
        let sum = |values: &[f64]| values.iter().sum::<f64>();
        let through = sum(&flows.inwards).max(sum(&flows.outwards)).max(moved);
        let soils = self.conditions.soils.iter();
        let permeability = soils.map(|soil| soil.along.max(soil.across));
        let size = self.grid.cell_size([0; D]);
        let size = size.into_iter().fold(f64::INFINITY, f64::min);
        let driven =
            permeability.fold(0.0, f64::max) * largest(heads).max(size) * size.powi(D as i32 - 2);
        through.max(AT_REST * driven)
    }
}

/// The largest of some values without their signs; infinite with one that is no number.
pub(crate) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| {
        if value.is_nan() {
            f64::INFINITY
        } else {
            value.abs().max(most)
        }
    })
}

fn add(local: &Local<'_>, residual: &mut [f64], matrix: Option<&mut TangentMatrix>) {
    for (i, &row) in local.unknowns.iter().enumerate() {
        residual[row] += local.residual[i];
    }
    let Some(matrix) = matrix else { return };
    let TangentMatrix {
        pattern, values, ..
    } = matrix;
    for (j, &column) in local.unknowns.iter().enumerate() {
        let rows = pattern.coupled_to(column);
        let first = pattern.first_value[column];
        for (i, &row) in local.unknowns.iter().enumerate() {
            let place = rows.partition_point(|other| (*other as usize) < row);
            values[first + place] += local.tangent[i][j];
        }
    }
}

/// Cells beside each other of which one is cut.
fn pairs<const D: usize>(grid: &Grid<D>, cells: &[Cell<D>]) -> Vec<Pair> {
    let mut number = vec![usize::MAX; grid.cell_count()];
    for (index, cell) in cells.iter().enumerate() {
        number[grid.cell_index(cell.place)] = index;
    }
    let is_cut = |cell: usize| cells[cell].filled < 1.0 - 1e-6;
    let mut pairs = Vec::new();
    for (index, cell) in cells.iter().enumerate() {
        for axis in 0..D {
            let mut place = cell.place;
            place[axis] += 1;
            if place[axis] >= grid.axes[axis].cell_count() {
                continue;
            }
            let other = number[grid.cell_index(place)];
            if other != usize::MAX && (is_cut(index) || is_cut(other)) {
                pairs.push(Pair {
                    cells: [index, other],
                    axis,
                });
            }
        }
    }
    pairs
}

/// By cell: the penalty on its heads over its permeability, by the area of the faces that have one and the volume of its ground \[1/m\].
fn steep<const D: usize>(
    grid: &Grid<D>,
    cells: &[Cell<D>],
    held: &[Held<D>],
    conditions: &Conditions<D>,
) -> Vec<f64> {
    let mut area = vec![0.0; cells.len()];
    for face in held {
        // A face on the axis of revolution has no area.
        if matches!(face.at, At::Head(_)) && face.facet.area > 0.0 {
            area[face.cell] += face.facet.area / conditions.thickness(face.facet.x[0]);
        }
    }
    let volume = |cell: &Cell<D>| cell.filled * grid.cell_size(cell.place).iter().product::<f64>();
    (std::iter::zip(cells, area))
        .map(|(cell, area)| CUT * area / volume(cell))
        .collect()
}

/// Which heads are coupled.
fn pattern<const D: usize>(
    grid: &Grid<D>,
    nodes: &[usize],
    corners: &[[usize; CORNERS]],
    pairs: &[Pair],
) -> Pattern {
    let mut lists: Vec<Vec<u32>> = vec![Vec::new(); nodes.len()];
    let mut join = |a: &[usize], b: &[usize]| {
        for &i in a {
            lists[i].extend(b.iter().map(|&j| j as u32));
        }
    };
    for cell in corners {
        join(&cell[..1 << D], &cell[..1 << D]);
    }
    for pair in pairs {
        let [a, b] = pair.cells.map(|cell| &corners[cell][..1 << D]);
        join(a, b);
        join(b, a);
    }
    let mut starts = vec![0];
    let mut coupled = Vec::new();
    for list in &mut lists {
        list.sort_unstable();
        list.dedup();
        coupled.append(list);
        starts.push(coupled.len());
    }
    let block = |(index, &node): (usize, &usize)| {
        let indices = grid.node_place(node);
        NodeBlock {
            first: index,
            len: 1,
            free: 1,
            place: std::array::from_fn(|axis| indices.get(axis).copied().unwrap_or(0)),
        }
    };
    let blocks = nodes.iter().enumerate().map(block).collect();
    Pattern::new(
        blocks,
        starts,
        coupled,
        if pairs.is_empty() { 1 } else { 2 },
    )
}
