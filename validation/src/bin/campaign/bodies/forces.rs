//! Forces of rigid bodies on the nodes of the grid in an accepted step, computed again from the traction
//! that the step left at the knots (theory, eqs. 45 and 48), from outlines, poses and particles: nothing
//! of the code of contact is used, but the places of the knots.

use std::collections::BTreeMap;

use igimp_assembly::{
    Drive, Interface, Particles, RigidBody, RigidMotion, Section, Shear, Stencils, StepConditions,
    Tension,
};

use super::outline::in_frame;

/// Abscissa of the rule of Gauss with two points.
const GAUSS: f64 = 0.577_350_269_189_625_8;

/// A step as it began.
pub(crate) struct Begun<'a> {
    pub(crate) particles: &'a Particles<2>,
    pub(crate) rigid: &'a [RigidBody<2>],
    pub(crate) stencils: &'a Stencils<2>,
    pub(crate) conditions: &'a StepConditions<2>,
    /// Share of its cells below which a node that none moves with has no unknowns \[-\].
    pub(crate) below: f64,
    /// Whether other nodes move with a node.
    pub(crate) is_carrier: Vec<bool>,
}

/// Whether other nodes move with a node, by node of the grid.
pub(crate) fn carriers(stencils: &Stencils<2>, nodes: usize) -> Vec<bool> {
    let mut is_carrier = vec![false; nodes];
    for node in 0..nodes {
        for carrier in stencils.carriers(node).filter(|other| other.node != node) {
            is_carrier[carrier.node] = true;
        }
    }
    is_carrier
}

/// Averages around a knot.
#[derive(Default)]
struct Around {
    area: f64,
    gap: f64,
    /// Of faces that no thin particle hides.
    area_in_front: f64,
    gap_in_front: f64,
    young: f64,
    adhesion: f64,
    cell: f64,
    /// Opening and slip by node.
    opening: BTreeMap<usize, [f64; 2]>,
    slip: BTreeMap<usize, [f64; 2]>,
    /// Moments of directions by the ways of arms that turn in the step: of opening and of slip \[length²\].
    turned: [f64; 2],
}

impl Around {
    /// The mean gap at which soil comes near (theory, eq. 45f).
    fn first_gap(&self) -> f64 {
        if self.area_in_front > 0.0 {
            self.gap_in_front / self.area_in_front
        } else {
            self.gap / self.area
        }
    }
}

/// A face that a particle turns to a side of a body.
struct Face {
    particle: usize,
    side: usize,
    height: f64,
    normal: [f64; 2],
    tangent: [f64; 2],
    /// Half of the particle across the side, and along it.
    thickness: f64,
    /// How far its soil reaches beyond its domain towards the side (theory, eq. 45i).
    beyond: f64,
    reach: f64,
    middle: [f64; 2],
    /// Share by which it counts (theory, eq. 45b).
    share: f64,
}

impl Face {
    /// Height over that up to which it counts in full.
    fn far(&self) -> f64 {
        0.5 * self.height / self.thickness
    }

    fn gap(&self) -> f64 {
        self.height - self.thickness - self.beyond
    }

    /// Whether the particle ends between the side and the middle of another face (theory, eq. 45f).
    fn hides(&self, other: &Self) -> bool {
        let along: f64 = (0..2)
            .map(|a| (other.middle[a] - self.middle[a]) * self.tangent[a])
            .sum();
        self.side == other.side
            && self.gap() + 2.0 * self.thickness <= other.gap() + 0.2 * self.thickness
            && along.abs() < self.reach
    }
}

/// A side as a segment between its first and last knot, in the frame of the body; of a circle one between
/// two knots.
struct Side {
    /// Which of the body's sides.
    number: usize,
    knots: Vec<(usize, [f64; 2])>,
    /// Out of the body; none if it is that of a circle, which points away from its centre.
    normal: Option<[f64; 2]>,
}

/// The force of bodies at each node, those that stand for bodies behind those of the grid: minus the
/// internal force of contact \[N/m\]. `after` are the bodies that the step left, `u` its displacements.
pub(crate) fn forces(begun: &Begun<'_>, after: &[RigidBody<2>], u: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let grid_nodes = begun.conditions.grid.node_count();
    let mut out = vec![[0.0; 2]; grid_nodes + 2 * after.len()];
    for (slot, body) in begun.rigid.iter().enumerate() {
        let turn = grid_nodes + 2 * slot + 1;
        // A round body shows the same surface however it turns.
        let angle = match body.surface.radius() {
            None => u[turn][0] / body.surface.size(),
            Some(_) => 0.0,
        };
        let around = around_knots(begun, slot, body, angle);
        let left = &after[slot].contact.knots;
        let tents = tents(&sides(body), left.len());
        let knots = body.surface.knots();
        for (knot, sums) in around {
            let area = sums.area.min(tents[knot]);
            let (state, side) = (&left[knot], knots[knot].1);
            let shear = if state.is_closed {
                state.shear[0]
            } else {
                let motion = &begun.conditions.motions[slot];
                shear_by_law(body, motion, (knot, side), &sums, tents[knot], u)
            };
            for (factor, by_node, turned) in [
                (state.pressure, &sums.opening, sums.turned[0]),
                (shear, &sums.slip, sums.turned[1]),
            ] {
                for (&node, share) in by_node {
                    for axis in 0..2 {
                        out[node][axis] += area * factor * share[axis] / sums.area;
                    }
                }
                out[turn][0] -= area * factor * turned / (sums.area * body.surface.size());
            }
        }
    }
    out
}

/// A side whose normal has so much of an axis of the grid is along it, and there faces fade over so much of their height \[-\].
const ALONG: f64 = 0.995;
const FADES: f64 = 0.04;

/// Soil that is no further off than so many cells adheres (theory, eq. 47a) \[-\].
const ADHESIVE_GAP: f64 = 0.1;

/// Soil that covers less of a knot than this share hands on its traction (theory, eq. 50) \[-\].
const CRUMB: f64 = 0.1;

/// Soil that is no further from a body that a force pushes has the body laid on it, in cells (theory, eq. 46) \[-\].
const LAID: f64 = 1e-6;

/// Shear at a knot that soil touched, or nearly, when the step began and has left at its end (theory, eqs. 47, 47a, 50).
fn shear_by_law(
    body: &RigidBody<2>,
    motion: &RigidMotion<2>,
    (knot, side): (usize, usize),
    sums: &Around,
    whole: f64,
    u: &[[f64; 2]],
) -> f64 {
    let before = &body.contact.knots[knot];
    let bonds = body.interfaces[side].tension != Tension::None && !before.is_broken;
    let is_pushed = |drive: &Drive| matches!(drive, Drive::Loaded(force) if force.abs() > 0.0);
    let is_laid = motion.displacement.iter().any(is_pushed)
        && sums.first_gap() < LAID * sums.cell / sums.area;
    let touches = bonds || is_laid;
    let touched = if before.area == 0.0 {
        touches || sums.first_gap() <= 0.0
    } else {
        before.is_closed
    };
    let gap = match before.area {
        0.0 if touches => 0.0,
        0.0 => sums.first_gap().max(0.0),
        area if sums.area > area => before.gap.max(sums.gap / sums.area),
        _ => before.gap,
    };
    let adheres = touched || !before.is_broken && gap <= ADHESIVE_GAP * sums.cell / sums.area;
    let limit = match &body.interfaces[side].shear {
        Shear::Rough if touched => f64::INFINITY,
        Shear::Limited { .. } if adheres => sums.adhesion / sums.area,
        _ => return 0.0,
    };
    let covered = |area: f64| area.max(CRUMB * whole);
    let growth = (covered(before.area) / covered(sums.area.min(whole))).min(2.0);
    let normal = body.penalty.stiffness * sums.young / sums.cell;
    let stiffness = body.penalty.tangential * normal;
    let taken = match &body.interfaces[side] {
        Interface {
            shear: Shear::Limited { friction, .. },
            tension: Tension::None,
        } if before.is_closed && before.slips => {
            let depth = body.penalty.smoothing * sums.cell / sums.area;
            let carried = growth * before.pressure;
            let now = slid(
                carried,
                sums.first_gap(),
                before.way * sums.area / sums.cell,
                [normal, depth],
            );
            let bound = |pressure: f64| sums.adhesion / sums.area + friction * pressure;
            if bound(carried) > 0.0 {
                bound(now) / bound(carried)
            } else {
                1.0
            }
        }
        _ => 1.0,
    };
    let slip: f64 = sums
        .slip
        .iter()
        .map(|(&node, share)| (share[0] * u[node][0] + share[1] * u[node][1]) / sums.area)
        .sum();
    (taken * growth * before.shear[0] - stiffness * slip).clamp(-limit, limit)
}

/// A pressure with the gap of a share of the soil that slid by (theory, eqs. 46 and 50a), from the stiffness and the smoothing length of contact.
fn slid(pressure: f64, measured: f64, share: f64, [stiffness, depth]: [f64; 2]) -> f64 {
    let gap = if pressure > 0.5 * stiffness * depth {
        -pressure / stiffness - 0.5 * depth
    } else {
        -(2.0 * pressure.max(0.0) * depth / stiffness).sqrt()
    };
    let gap = gap + share.min(1.0) * (measured - gap);
    if gap >= 0.0 {
        0.0
    } else if gap > -depth {
        0.5 * stiffness * gap * gap / depth
    } else {
        stiffness * (-gap - 0.5 * depth)
    }
}

/// The sides of a body between its knots.
fn sides(body: &RigidBody<2>) -> Vec<Side> {
    let all = body.surface.knots();
    let count = body.surface.side_count();
    let of = |number: usize| {
        let set = all
            .iter()
            .enumerate()
            .filter(move |(_, knot)| knot.1 == number);
        set.map(|(index, knot)| (index, knot.0)).collect::<Vec<_>>()
    };
    if count == 1 {
        let knots = of(0);
        let next = knots.iter().cycle().skip(1);
        return std::iter::zip(&knots, next)
            .map(|(a, b)| Side {
                number: 0,
                knots: vec![*a, *b],
                normal: None,
            })
            .collect();
    }
    // The sense in which the corners run.
    let ring = all.iter().map(|knot| knot.0);
    let next = all.iter().map(|knot| knot.0).cycle().skip(1);
    let area: f64 = std::iter::zip(ring, next)
        .map(|(a, b)| a[0] * b[1] - a[1] * b[0])
        .sum();
    (0..count)
        .map(|number| {
            let knots = of(number);
            let (a, b) = (knots[0].1, knots[knots.len() - 1].1);
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            let length = area.signum() * dx.hypot(dy);
            Side {
                number,
                knots,
                normal: Some([dy / length, -dx / length]),
            }
        })
        .collect()
}

/// ∫ψ dA over the sides by knot.
fn tents(sides: &[Side], count: usize) -> Vec<f64> {
    let mut out = vec![0.0; count];
    for side in sides {
        for pair in side.knots.windows(2) {
            let [(i, a), (j, b)] = [pair[0], pair[1]];
            let half = 0.5 * (b[0] - a[0]).hypot(b[1] - a[1]);
            out[i] += half;
            out[j] += half;
        }
    }
    out
}

/// Shares of knots at a place of the surface in the frame of the body; none beyond the end of the side.
fn shares(sides: &[Side], number: usize, x: [f64; 2]) -> Option<[(usize, f64); 2]> {
    let mut best: Option<(f64, [(usize, f64); 2])> = None;
    let mut is_on = false;
    for side in sides.iter().filter(|side| side.number == number) {
        for pair in side.knots.windows(2) {
            let [(i, a), (j, b)] = [pair[0], pair[1]];
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            let t = ((x[0] - a[0]) * dx + (x[1] - a[1]) * dy) / (dx * dx + dy * dy);
            is_on |= side.normal.is_none() || (-1e-9..=1.0 + 1e-9).contains(&t);
            let t = t.clamp(0.0, 1.0);
            let distance = (x[0] - a[0] - t * dx).hypot(x[1] - a[1] - t * dy);
            if best.is_none_or(|(least, _)| distance < least) {
                best = Some((distance, [(i, 1.0 - t), (j, t)]));
            }
        }
    }
    best.filter(|_| is_on).map(|(_, shares)| shares)
}

/// The sides near a place: number, height above it, and the normal as the body stands.
fn sides_near(body: &RigidBody<2>, sides: &[Side], x: [f64; 2]) -> Vec<(usize, f64, [f64; 2])> {
    let turned = |v: [f64; 2]| {
        let turn = &body.pose.turn;
        [0, 1].map(|a| turn[a][0] * v[0] + turn[a][1] * v[1])
    };
    let local = in_frame(&body.pose, x);
    // All segments of a circle are one side.
    if sides[0].normal.is_none() {
        let radius = body.surface.bounds().1[0];
        let length = local[0].hypot(local[1]);
        return vec![(0, length - radius, turned(local.map(|x| x / length)))];
    }
    let of = sides.iter().filter_map(|side| {
        let (normal, at) = (side.normal?, side.knots[0].1);
        let height = normal[0] * (local[0] - at[0]) + normal[1] * (local[1] - at[1]);
        Some((side.number, height, turned(normal)))
    });
    of.collect()
}

/// The faces that particles turn to the sides of a body.
fn faces(particles: &Particles<2>, body: &RigidBody<2>, sides: &[Side]) -> Vec<Face> {
    let mut faces = Vec::new();
    for particle in 0..particles.len() {
        let (x, half) = (particles.x[particle], particles.half_length[particle]);
        let beyond = particles.beyond_domain(particle, Section::PlaneStrain);
        for (side, height, normal) in sides_near(body, sides, x) {
            let thickness = half[0] * normal[0].abs() + half[1] * normal[1].abs();
            let far = 0.5 * height / thickness;
            let is_along = normal[0].abs().max(normal[1].abs()) >= ALONG;
            let fades = is_along && body.surface.radius().is_none();
            let share = match far <= 1.0 {
                true => 1.0,
                false if fades => ((1.0 + FADES - far) / FADES).min(1.0),
                false => 0.0,
            };
            if height <= 0.0 || share <= 0.0 {
                continue;
            }
            let tangent = [-normal[1], normal[0]];
            faces.push(Face {
                particle,
                side,
                height,
                normal,
                tangent,
                thickness,
                beyond: (0..2).map(|a| -beyond[a] * normal[a]).sum::<f64>().max(0.0),
                reach: half[0] * tangent[0].abs() + half[1] * tangent[1].abs(),
                middle: [0, 1].map(|a| x[a] - thickness * normal[a]),
                share,
            });
        }
    }
    faces
}

/// Averages around the knots of a body that turns by an angle in the step \[rad\].
fn around_knots(
    begun: &Begun<'_>,
    slot: usize,
    body: &RigidBody<2>,
    angle: f64,
) -> BTreeMap<usize, Around> {
    let Begun {
        particles,
        conditions,
        ..
    } = begun;
    let sides = sides(body);
    let first = conditions.grid.node_count() + 2 * slot;
    let mut out: BTreeMap<usize, Around> = BTreeMap::new();
    let faces = faces(particles, body, &sides);
    for face in &faces {
        let is_in_front = !faces.iter().any(|other| other.hides(face));
        if face.far() > 1.0 && !is_in_front {
            continue;
        }
        let law = particles.law[face.particle];
        let young = particles.young(face.particle, &conditions.laws);
        let adhesion = match &body.interfaces[face.side].shear {
            Shear::Limited { adhesion, .. } => adhesion.get(law).copied().unwrap_or(0.0),
            _ => 0.0,
        };
        for (at, length) in points(begun, body, face.middle, face.tangent, face.reach) {
            let Some(knots) = shares(&sides, face.side, in_frame(&body.pose, at)) else {
                continue;
            };
            let Some((nodes, place, cell)) = soil(begun, at) else {
                continue;
            };
            for (knot, tent) in knots.into_iter().filter(|(_, tent)| *tent > 0.0) {
                let weight = face.share * length * tent;
                let sums = out.entry(knot).or_default();
                sums.area += weight;
                sums.gap += weight * face.gap();
                if is_in_front {
                    sums.area_in_front += weight;
                    sums.gap_in_front += weight * face.gap();
                }
                sums.young += weight * young;
                sums.adhesion += weight * adhesion;
                sums.cell += weight * cell;
                let arm = [0, 1].map(|a| place[a] - body.pose.origin[a]);
                let way = turned_by(angle, arm);
                for (direction, by_node, turned) in [
                    (face.normal, &mut sums.opening, 0),
                    (face.tangent, &mut sums.slip, 1),
                ] {
                    add_way(by_node, &nodes, (direction, weight), (body, first, place));
                    sums.turned[turned] += weight * (way[0] * direction[1] - way[1] * direction[0]);
                }
            }
        }
    }
    out
}

/// The way of the end of an arm that turns by an angle \[rad\].
fn turned_by(angle: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [(cos - 1.0) * x - sin * y, sin * x + (cos - 1.0) * y]
}

/// Adds how far soil at a place moves away from a body in a direction, by node: those of the soil, and the two that stand for the
/// body from `first` on.
fn add_way(
    by_node: &mut BTreeMap<usize, [f64; 2]>,
    nodes: &[(usize, f64)],
    (direction, weight): ([f64; 2], f64),
    (body, first, place): (&RigidBody<2>, usize, [f64; 2]),
) {
    let mut add = |node: usize, by: [f64; 2]| {
        let sum = by_node.entry(node).or_insert([0.0; 2]);
        sum[0] += weight * by[0];
        sum[1] += weight * by[1];
    };
    for &(node, share) in nodes {
        add(node, direction.map(|n| share * n));
    }
    let arm = [0, 1].map(|a| place[a] - body.pose.origin[a]);
    let moment = arm[0] * direction[1] - arm[1] * direction[0];
    add(first, direction.map(|n| -n));
    add(first + 1, [-moment / body.surface.size(), 0.0]);
}

/// Points of integration on a face with the lengths that they stand for: two between any two lines of the
/// grid and knots.
fn points(
    begun: &Begun<'_>,
    body: &RigidBody<2>,
    middle: [f64; 2],
    tangent: [f64; 2],
    reach: f64,
) -> Vec<([f64; 2], f64)> {
    let mut cuts = vec![-reach, reach];
    for axis in (0..2).filter(|&axis| tangent[axis].abs() > 1e-6) {
        let lines = begun.conditions.grid.axes[axis].nodes().iter();
        cuts.extend(lines.map(|line| (line - middle[axis]) / tangent[axis]));
    }
    cuts.extend(body.surface.knots().iter().map(|(knot, _)| {
        let at = body.pose.into_space(knot);
        (at[0] - middle[0]) * tangent[0] + (at[1] - middle[1]) * tangent[1]
    }));
    cuts.retain(|cut| cut.abs() <= reach);
    cuts.sort_by(f64::total_cmp);
    let pieces = cuts
        .windows(2)
        .filter(|pair| pair[1] - pair[0] > 2e-9 * reach);
    pieces
        .flat_map(|pair| {
            let (centre, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
            [-GAUSS, GAUSS].map(|place| {
                let s = centre + place * half;
                ([0, 1].map(|a| middle[a] + s * tangent[a]), half)
            })
        })
        .collect()
}

/// Nodes that carry the soil at a point with their shares, the place that these stand for, and the size of
/// the cell.
type Soil = (Vec<(usize, f64)>, [f64; 2], f64);

fn soil(begun: &Begun<'_>, x: [f64; 2]) -> Option<Soil> {
    let grid = &begun.conditions.grid;
    let cell = grid.cell_at(&x)?;
    let size = grid.cell_size(cell);
    let corner = grid.node_position(grid.node_index(cell));
    let within = [0, 1].map(|a| (x[a] - corner[a]) / size[a]);
    let mut nodes = Vec::new();
    for (i, j) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let tent = |k: usize, t: f64| if k == 0 { 1.0 - t } else { t };
        let share = tent(i, within[0]) * tent(j, within[1]);
        if share <= 1e-9 {
            continue;
        }
        let node = grid.node_index([cell[0] + i, cell[1] + j]);
        for carrier in begun.stencils.carriers(node) {
            let fill = begun.stencils.node_fill(grid, carrier.node);
            if begun.is_carrier[carrier.node] || fill > 0.0 && fill >= begun.below {
                nodes.push((carrier.node, carrier.weight * share));
            }
        }
    }
    let sum: f64 = nodes.iter().map(|(_, share)| share).sum();
    if nodes.is_empty() {
        return None;
    }
    let mut place = [0.0; 2];
    for (node, share) in &mut nodes {
        *share /= sum;
        let at = grid.node_position(*node);
        place = [0, 1].map(|a| place[a] + *share * at[a]);
    }
    Some((nodes, place, size[0].min(size[1])))
}
