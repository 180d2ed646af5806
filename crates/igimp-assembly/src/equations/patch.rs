//! The tangents of particles in space, summed over a patch of nodes before they go into the matrix.
//!
//! In space a particle has some fifteen nodes, and so two thousand entries, of which its neighbours share
//! most. Particles that begin at the same node are therefore summed first. Sorted by the gradients of
//! the column, the tangent (theory, eqs. 16 to 18; [`linearised`](crate::equations::linearised) has the symbols) is
//!
//! ```math
//! K_{(ia)(jc)} = \sum_d Y^{d}_{iac}\,g_{jd} + z_{ia}\,d_{jc} - V p\,\bar g_{ic}\,\bar g_{ja},\quad
//! Y^{d}_{iac} = V\,\{g_{ib} (A_{abcd} + (p\,\delta_{ad} - \tau_{ad})\,\delta_{bc}) + d_{ia} A_{ppcd}\},
//! ```
//!
//! with factors Y, z and V p ḡ that are computed once for each particle and serve all columns. They are
//! kept as vectors over the nodes i. All particles of a patch are summed into the rows of four nodes before
//! the next four are begun, so that factors and sums stay in the nearest cache. Of a symmetric tangent the rows
//! from the node of the column on are summed; the others are [their mirror image](crate::equations::mirror).

use igimp_linear::Pattern;
use igimp_shape::{Grid, Support};

use crate::equations::blocks::BlockTable;
use crate::equations::linearised::{Linearised, Moduli};
use crate::equations::scatter::{Piece, Rows, add as add_rows};

/// Nodes that are worked on together.
const LANES: usize = 4;

/// How far from their first node particles that share a patch may reach: 4³ nodes fit into a mask.
const FURTHEST: usize = 3;

/// Numbers of as many nodes.
type Lane = [f64; LANES];

/// The tangents of some particles that begin at the same node.
#[derive(Debug, Default)]
pub(crate) struct Patch<const D: usize> {
    /// The nodes of all particles, ascending.
    nodes: Vec<usize>,
    /// The nodes that particles of the patch may have, ascending.
    allowed: Vec<usize>,
    /// The unknown rows of the nodes.
    rows: Rows,
    /// Those that the column node at hand is coupled to.
    pieces: Vec<Piece>,
    /// The particles.
    members: Vec<Member<D>>,
    /// The nodes of one particle after the other.
    nodes_of: Vec<NodeOf<D>>,
    /// By particle and lane: gradients g and ḡ, zero at nodes that the particle does not touch.
    gradients: Vec<[[Lane; D]; 2]>,
    /// By column node: the tangent in the lane of rows at hand, by c and a.
    sums: Vec<[[Lane; D]; D]>,
    /// The tangent by column, its rows filled up to full lanes.
    columns: Vec<f64>,
    /// Whether rows before the node of their column are left out.
    is_half: bool,
}

/// A particle of a patch.
#[derive(Debug)]
struct Member<const D: usize> {
    moduli: Moduli<D>,
    /// The lanes that it touches, by [`bit`].
    lanes: u64,
    /// Where its nodes end in the list of all.
    end: usize,
}

/// A node of a particle.
#[derive(Debug)]
struct NodeOf<const D: usize> {
    /// Where it is among the nodes of the patch.
    place: usize,
    /// Gradient g.
    g: [f64; D],
    /// Cell-averaged gradient ḡ.
    g_bar: [f64; D],
}

/// Factors of rows.
#[derive(Clone, Copy, Debug)]
struct Factors<const D: usize> {
    /// Y by c, a and d.
    y: [[[Lane; D]; D]; D],
    /// A third of z, by a.
    z: [Lane; D],
    /// −V p ḡ, by c.
    w: [Lane; D],
}

impl<const D: usize> Patch<D> {
    /// Begins a patch with the supports of particles in their order; how many of them it takes: those that begin
    /// at the same node and reach no further on from it than `near`, or the first alone.
    pub(crate) fn begin<'s>(
        &mut self,
        grid: &Grid<D>,
        near: usize,
        mut supports: impl Iterator<Item = &'s [Support<D>]>,
        is_half: bool,
    ) -> usize {
        let Some(first) = supports.next() else {
            return 0;
        };
        let mut count = 1;
        self.nodes.clear();
        self.allow(grid, first[0].node, near.min(FURTHEST));
        if let Some(mut mask) = self.mask(first) {
            for list in supports {
                if list[0].node != first[0].node {
                    break;
                }
                let Some(bits) = self.mask(list) else { break };
                mask |= bits;
                count += 1;
            }
            let allowed = self.allowed.iter().enumerate();
            let taken = allowed.filter(|&(k, _)| mask & (1 << k) != 0);
            self.nodes.extend(taken.map(|(_, node)| node));
        } else {
            self.nodes.extend(first.iter().map(|support| support.node));
        }
        self.members.clear();
        self.nodes_of.clear();
        self.gradients.clear();
        self.is_half = is_half;
        count
    }

    /// How many times `LANES` nodes there are.
    #[inline]
    fn lanes(&self) -> usize {
        self.nodes.len().div_ceil(LANES)
    }

    /// Allows the nodes that are not before a corner along any axis, and no further than `near`.
    fn allow(&mut self, grid: &Grid<D>, corner: usize, near: usize) {
        self.allowed.clear();
        self.allowed.push(corner);
        let place = grid.node_place(corner);
        let mut stride = 1;
        for axis in 0..D {
            let nodes = grid.axes[axis].node_count();
            let known = self.allowed.len();
            for step in 1..=near.min(nodes - 1 - place[axis]) {
                for k in 0..known {
                    self.allowed.push(self.allowed[k] + step * stride);
                }
            }
            stride *= nodes;
        }
    }

    /// The nodes of a particle among those allowed, one bit each; `None` if there are others.
    #[inline]
    fn mask(&self, supports: &[Support<D>]) -> Option<u64> {
        let (mut mask, mut k) = (0, 0);
        for support in supports {
            while *self.allowed.get(k)? != support.node {
                k += 1;
            }
            mask |= 1 << k;
        }
        Some(mask)
    }

    /// Takes one of the particles, whose gradients were pushed.
    #[allow(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    pub(crate) fn take(
        &mut self,
        supports: &[Support<D>],
        linearised: &Linearised<D>,
        moduli: Moduli<D>,
    ) {
        let first = self.gradients.len();
        let nothing = [[[0.0; LANES]; D]; 2];
        self.gradients.resize(first + self.lanes(), nothing);
        let gradients = &mut self.gradients[first..];
        let pairs = std::iter::zip(linearised.g(), linearised.g_bar());
        let (mut place, mut touched) = (0, 0);
        for (support, (&g, &g_bar)) in std::iter::zip(supports, pairs) {
            while self.nodes[place] != support.node {
                place += 1;
            }
            touched |= bit(place / LANES);
            let [to, to_bar] = &mut gradients[place / LANES];
            for a in 0..D {
                to[a][place % LANES] = g[a];
                to_bar[a][place % LANES] = g_bar[a];
            }
            self.nodes_of.push(NodeOf { place, g, g_bar });
        }
        let end = self.nodes_of.len();
        self.members.push(Member {
            moduli,
            lanes: touched,
            end,
        });
    }

    /// Sums the tangents of the particles that were taken; `fuses` products and sums.
    #[allow(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    pub(crate) fn sum(&mut self, fuses: bool) {
        let (lanes, nodes) = (self.lanes(), self.nodes.len());
        self.sums.resize(nodes, [[[0.0; LANES]; D]; D]);
        let height = lanes * LANES * D;
        self.columns.resize(nodes * D * height, 0.0);
        for lane in 0..lanes {
            let end = if self.is_half {
                nodes.min((lane + 1) * LANES)
            } else {
                nodes
            };
            let sums = &mut self.sums[..end];
            sums.fill([[[0.0; LANES]; D]; D]);
            let mut first = 0;
            let gradients = self.gradients.chunks_exact(lanes);
            for (member, gradients) in self.members.iter().zip(gradients) {
                let of_member = &self.nodes_of[first..member.end];
                first = member.end;
                if member.lanes & bit(lane) == 0 {
                    continue;
                }
                add_lane(sums, &gradients[lane], of_member, &member.moduli, fuses);
            }
            let columns = self.columns.chunks_exact_mut(height);
            for (column, sum) in columns.zip(self.sums[..end].as_flattened()) {
                let rows = column[lane * LANES * D..].as_chunks_mut::<D>().0;
                for (k, row) in rows[..LANES].iter_mut().enumerate() {
                    *row = std::array::from_fn(|a| sum[a][k]);
                }
            }
        }
    }

    /// Adds the sums to the slice of values of the matrix that begins at `start`.
    #[allow(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    pub(crate) fn scatter(
        &mut self,
        (table, pattern): (&BlockTable<D>, &Pattern),
        (start, slice): (usize, &mut [f64]),
    ) {
        self.rows.set(self.nodes.iter().copied(), table, false);
        let stride = self.lanes() * LANES * D;
        for (j, &node) in self.nodes.iter().enumerate() {
            let column = &table.nodes[node];
            if column.len == 0 {
                continue;
            }
            let stored = pattern.values_of(column.block as usize);
            let values = &mut slice[stored.start - start..stored.end - start];
            let height = pattern.height(column.block as usize);
            let first = if self.is_half { j * D } else { 0 };
            self.pieces.clear();
            let nodes = (table, &self.nodes[..]);
            self.rows.coupled(nodes, node, first, &mut self.pieces);
            let columns = &self.columns[j * D * stride..][..D * stride];
            for &Piece { first, len, offset } in &self.pieces {
                if usize::from(column.len) == D {
                    for c in 0..D {
                        let sums = &mut values[c * height + offset..];
                        add_rows(sums, &columns[c * stride + first..], len);
                    }
                } else {
                    for (rank, c) in column.components().enumerate() {
                        let sums = &mut values[rank * height + offset..];
                        add_rows(sums, &columns[c * stride + first..], len);
                    }
                }
            }
        }
    }
}

/// A bit for a lane; a particle with more lanes than bits has a patch of its own, and touches them all.
#[inline]
fn bit(lane: usize) -> u64 {
    1 << lane.min(63)
}

/// Adds the tangent of a particle in one lane of rows to the sums by column node; its `nodes` are ascending, and those beyond
/// the sums are left out.
#[allow(
    clippy::inline_always,
    reason = "compiled for the instructions of the caller"
)]
#[inline(always)]
fn add_lane<const D: usize>(
    sums: &mut [[[Lane; D]; D]],
    gradients: &[[Lane; D]; 2],
    nodes: &[NodeOf<D>],
    moduli: &Moduli<D>,
    fuses: bool,
) {
    let factors = factors(gradients, moduli, fuses);
    for c in 0..D {
        let (y, z, w) = (factors.y[c], factors.z, factors.w[c]);
        for NodeOf { place, g, g_bar } in nodes {
            let Some(sums) = sums.get_mut(*place) else {
                break;
            };
            let d_3 = g_bar[c] - g[c];
            for a in 0..D {
                let mut sum = sums[c][a];
                for d in 0..D {
                    add(&mut sum, &y[a][d], g[d], fuses);
                }
                add(&mut sum, &z[a], d_3, fuses);
                add(&mut sum, &w, g_bar[a], fuses);
                sums[c][a] = sum;
            }
        }
    }
}

/// Adds `factor` times `term`; `fuses` product and sum.
#[allow(
    clippy::inline_always,
    reason = "compiled for the instructions of the caller"
)]
#[inline(always)]
fn add(sum: &mut Lane, term: &Lane, factor: f64, fuses: bool) {
    for lane in 0..LANES {
        if fuses {
            sum[lane] = term[lane].mul_add(factor, sum[lane]);
        } else {
            sum[lane] += term[lane] * factor;
        }
    }
}

/// The factors of the rows of a lane.
#[allow(
    clippy::inline_always,
    reason = "compiled for the instructions of the caller"
)]
#[inline(always)]
fn factors<const D: usize>(
    [g, g_bar]: &[[Lane; D]; 2],
    moduli: &Moduli<D>,
    fuses: bool,
) -> Factors<D> {
    let mut factors = Factors {
        y: [[[[0.0; LANES]; D]; D]; D],
        z: [[0.0; LANES]; D],
        w: [[0.0; LANES]; D],
    };
    for a in 0..D {
        for lane in 0..LANES {
            factors.w[a][lane] = -moduli.vp * g_bar[a][lane];
        }
        let mut d_3 = g_bar[a];
        for lane in 0..LANES {
            d_3[lane] -= g[a][lane];
        }
        let mut z = [0.0; LANES];
        add(&mut z, &d_3, moduli.trace, fuses);
        for b in 0..D {
            add(&mut z, &g[b], moduli.right[b][a], fuses);
        }
        factors.z[a] = z;
        for c in 0..D {
            for d in 0..D {
                let mut y = [0.0; LANES];
                add(&mut y, &d_3, moduli.left[c][d], fuses);
                for b in 0..D {
                    add(&mut y, &g[b], moduli.modulus[c][d][b][a], fuses);
                }
                factors.y[c][a][d] = y;
            }
        }
    }
    factors
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use igimp_material::{Elasticity, HenckyElastic, MohrCoulomb, TangentKind};
    use igimp_shape::Axis;

    use crate::{
        Constraints, Method, ParticleSeed, ParticleTrial, Particles, SharedLaw, Stencils,
        StepConditions, StepLoads, System,
    };

    use super::*;

    /// A grid with a large cell at its corner, whose particle is wide, and two particles a direction in each of
    /// the other cells off its walls, off their places; the topmost make small cuts.
    fn body() -> (Grid<3>, Particles<3>) {
        let nodes = std::iter::once(0.0).chain((0..6).map(|k| 5.0 + f64::from(k)));
        let axis = Axis::from_nodes(nodes.collect()).unwrap();
        let grid = Grid::<3>::new([axis.clone(), axis.clone(), axis]);
        let seed = |x: [f64; 3], half_length: f64| ParticleSeed {
            x,
            half_length: [half_length; 3],
            volume: (2.0 * half_length).powi(3),
            density: 1.0,
            law: 0,
            centroid: [0.0; _],
        };
        let mut seeds = vec![seed([4.5; 3], 2.0)];
        for k in 0..512_usize {
            let place = [k % 8, k / 8 % 8, k / 64];
            let x = std::array::from_fn(|axis| {
                let off = (k * (axis + 3) % 7) as f64 / 7.0 - 0.5;
                5.28 + 0.5 * place[axis] as f64 + 0.2 * off
            });
            seeds.push(seed(x, 0.25));
        }
        (grid, Particles::new(&seeds).unwrap())
    }

    /// The sums over patches are those over particles, and symmetric where the law is.
    fn compare(law: SharedLaw) {
        let (grid, body) = body();
        let mut constraints = Constraints::free(&grid);
        constraints.fix_wall(&grid, 0, false, 0).unwrap();
        constraints.fix_wall(&grid, 1, true, 1).unwrap();
        constraints.fix_wall(&grid, 1, true, 2).unwrap();
        let is_symmetric = law.has_symmetric_tangent();
        let loads = StepLoads::gravity([0.0; 3]);
        let conditions = StepConditions::new(grid, constraints, loads, vec![law]).unwrap();
        let method = Method::igimp_bbar();
        let stencils = Stencils::build(&body, &method, &conditions).unwrap();
        assert!(!stencils.ties().is_empty(), "some small cuts are tied");
        let system = System::new(&body, &stencils, &conditions, &method).unwrap();
        let u: Vec<[f64; 3]> = (0..system.node_count())
            .map(|node| std::array::from_fn(|axis| 1e-3 * ((node * (axis + 5)) % 11) as f64))
            .collect();
        let kind = TangentKind::Consistent;
        let (_, matrix) = system.linearise(&u, kind).unwrap();
        let mut expected = vec![0.0; matrix.values.len()];
        let mut linearised = Linearised::default();
        let mut trial = ParticleTrial::at_rest();
        for particle in 0..body.len() {
            let supports = stencils.of(particle);
            let point = system.evaluate_particle(particle, &u, kind, &mut trial);
            let point = point.unwrap();
            linearised.push((supports, None), &point);
            let volume = system.reference_volume(particle);
            linearised.linearise_particle(&point, volume, method.kinematics);
            for (j, column) in supports.iter().enumerate() {
                let columns = linearised.columns(j);
                for (component, (c, _)) in system.unknowns().of(column.node).enumerate() {
                    for (i, row) in supports.iter().enumerate() {
                        for (rank, (a, _)) in system.unknowns().of(row.node).enumerate() {
                            let (pattern, nodes) = (system.pattern(), [column.node, row.node]);
                            let place = system.table.value(pattern, nodes[0], component, nodes[1]);
                            expected[place + rank] += columns[c][i * 3 + a];
                        }
                    }
                }
            }
        }
        let size = expected.iter().fold(0.0_f64, |size, k| size.max(k.abs()));
        for (found, expected) in matrix.values.iter().zip(&expected) {
            assert!(
                (found - expected).abs() < 1e-14 * size,
                "{found} {expected}"
            );
        }
        let (columns, rows) = (matrix.to_csc(), matrix.to_csc().transpose());
        let both = std::iter::zip(columns.values(), rows.values());
        let asymmetry = both.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        assert_eq!(asymmetry < 1e-14 * size, is_symmetric, "{asymmetry:e}");
    }

    #[test]
    fn patches_sum_contributions_of_particles() {
        let elasticity = Elasticity::new(1e3, 0.3).unwrap();
        compare(Arc::new(HenckyElastic::new(elasticity)));
        compare(Arc::new(
            MohrCoulomb::new(elasticity, 0.1, 0.5, 0.0).unwrap(),
        ));
    }
}
