//! Soil around the knots of a rigid body: sums over the faces that particles turn to it (theory,
//! eq. 45).

use std::collections::BTreeMap;

use igimp_shape::Grid;

use super::sums::Sums;
use crate::body::particles::Particles;
use crate::conditions::StepConditions;
use crate::error::padded;
use crate::method::Section;
use crate::step::stencils::Stencils;
use crate::step::unknowns::Unknowns;
use igimp_rigid::{Face, Image, Images, Piece, RigidBody, pieces};
use igimp_surface::Space;
use igimp_surface::vectors::{cross, minus};

/// A node with a smaller share of a point has none: round-off on a line of the grid \[-\].
const LEAST_SHARE: f64 = 1e-9;

/// The sums of a body while they are made.
pub(crate) struct Gathering<'a, const D: usize> {
    body: &'a RigidBody<D>,
    /// The first of the two nodes that stand for it.
    node: usize,
    particles: &'a Particles<D>,
    stencils: &'a Stencils<D>,
    conditions: &'a StepConditions<D>,
    section: Section,
    unknowns: &'a Unknowns<D>,
    images: &'a Images<D>,
    knots: BTreeMap<usize, Sums<D>>,
}

/// A face with properties of the soil behind it.
struct Soil<'f, const D: usize> {
    face: &'f Face<D>,
    young: f64,
    adhesion: f64,
    /// Whether it sees its side.
    sees: bool,
}

impl<'a, const D: usize> Gathering<'a, D> {
    pub(crate) fn new(
        body: &'a RigidBody<D>,
        node: usize,
        particles: &'a Particles<D>,
        stencils: &'a Stencils<D>,
        (conditions, section): (&'a StepConditions<D>, Section),
        unknowns: &'a Unknowns<D>,
        images: &'a Images<D>,
    ) -> Self {
        Self {
            body,
            node,
            particles,
            stencils,
            conditions,
            section,
            unknowns,
            images,
            knots: BTreeMap::new(),
        }
    }

    /// The sums by knot, over all particles.
    pub(crate) fn sums(mut self) -> BTreeMap<usize, Sums<D>> {
        let (body, particles) = (self.body, self.particles);
        let (surface, pose) = (&*body.surface, &body.pose);
        let places: Vec<[f64; D]> = match surface.space() {
            Some(space) => space.outer.iter().map(|x| pose.into_space(x)).collect(),
            None => body.knots(),
        };
        let faces = self.faces();
        let thin = thin(&faces, surface.side_count());
        for (particle, face) in &faces {
            let before = thin[face.side].iter();
            let mut hiding = before.filter(|other| other.hides(face)).peekable();
            let sees = hiding.peek().is_none();
            if face.is_far() && !sees || hiding.any(|other| other.is_cut_before(face)) {
                continue;
            }
            let law = particles.law[*particle];
            let ratios = particles.ratios[*particle];
            let soil = Soil {
                face,
                young: particles.young(*particle, &self.conditions.laws),
                adhesion: body.interfaces[face.side].adhesion(law, ratios),
                sees,
            };
            match surface.space() {
                Some(space) => {
                    self.add_pieces(&soil, &particles.half_length[*particle], space, &places);
                }
                None => self.add_points(&soil, &places),
            }
        }
        self.knots
    }

    /// The faces that particles turn to sides of the body, by particle.
    fn faces(&self) -> Vec<(usize, Face<D>)> {
        let (body, particles) = (self.body, self.particles);
        let (lower, upper) = body.surface.bounds();
        let mut faces = Vec::new();
        for particle in 0..particles.len() {
            let (x, half) = (&particles.x[particle], &particles.half_length[particle]);
            let margin = 2.0 * half.iter().sum::<f64>();
            let at = body.pose.into_body(x);
            if (0..D).any(|a| at[a] < lower[a] - margin || at[a] > upper[a] + margin) {
                continue;
            }
            let sides = 0..body.surface.side_count();
            let sides = sides.filter_map(|side| Face::of(body, side, x, half));
            let beyond = particles.beyond_domain(particle, self.section);
            let drawn = &particles.half_length0[particle];
            faces.extend(sides.map(|face| (particle, face.grown(&beyond).drawn_with(drawn))));
        }
        faces
    }

    /// Adds a face of the plane point by point.
    fn add_points(&mut self, soil: &Soil<'_, D>, places: &[[f64; D]]) {
        let grid = &self.conditions.grid;
        for point in soil.face.points(self.body, places, grid) {
            let Some(mut spot) = soil_at(grid, self.stencils, self.unknowns, &point.x) else {
                continue;
            };
            spot.gap = self.gap(soil.face, &point.x);
            for (knot, tent) in point.knots {
                self.add(soil, self.images.at(knot), point.area * tent, &spot);
            }
        }
    }

    /// Adds a face of space piece by piece: a piece lies in one cell, so that its soil is that of the same
    /// nodes.
    fn add_pieces(
        &mut self,
        soil: &Soil<'_, D>,
        half: &[f64; D],
        space: &Space<D>,
        places: &[[f64; D]],
    ) {
        let (body, face) = (self.body, soil.face);
        let grid = &self.conditions.grid;
        for piece in pieces(face, half, body, space, places, grid) {
            for (corner, (weight, mean)) in self.means(&piece, face).into_iter().enumerate() {
                for &(knot, share) in &space.shares[piece.corners[corner]] {
                    self.add(soil, self.images.at(knot), share * weight, &mean);
                }
            }
        }
    }

    /// From the body to the soil behind a face \[length\].
    fn gap(&self, face: &Face<D>, x: &[f64; D]) -> f64 {
        rolling_radius(self.body, self.conditions).map_or(face.gap, |radius| {
            face.gap_along(&self.body.pose.origin, radius, x)
        })
    }

    /// By corner of its facet the area of a piece that belongs to it, and the mean of the soil there.
    fn means(&self, piece: &Piece<D>, face: &Face<D>) -> Vec<(f64, SoilPoint<D>)> {
        let grid = &self.conditions.grid;
        let none = || SoilPoint {
            shares: Vec::new(),
            place: [0.0; D],
            gap: 0.0,
            cell: 0.0,
        };
        let mut sums: Vec<(f64, SoilPoint<D>)> = (0..3).map(|_| (0.0, none())).collect();
        for (x, area, shares) in &piece.points {
            let Some(spot) = soil_at(grid, self.stencils, self.unknowns, x) else {
                continue;
            };
            let gap = self.gap(face, x);
            for ((weight, mean), share) in sums.iter_mut().zip(shares) {
                let by = area * share;
                *weight += by;
                mean.cell += by * spot.cell;
                mean.gap += by * (gap - face.gap);
                for axis in 0..D {
                    mean.place[axis] += by * spot.place[axis];
                }
                for &(node, share) in &spot.shares {
                    match mean.shares.iter_mut().find(|(known, _)| *known == node) {
                        Some((_, sum)) => *sum += by * share,
                        None => mean.shares.push((node, by * share)),
                    }
                }
            }
        }
        for (weight, mean) in &mut sums {
            if *weight > 0.0 {
                mean.cell /= *weight;
                mean.gap = face.gap + mean.gap / *weight;
                mean.place = mean.place.map(|x| x / *weight);
                for (_, share) in &mut mean.shares {
                    *share /= *weight;
                }
            }
        }
        sums
    }

    /// Adds to a knot the soil at a place that stands for an area.
    fn add(
        &mut self,
        soil: &Soil<'_, D>,
        image: Image<D>,
        weight: f64,
        SoilPoint {
            shares,
            place,
            gap,
            cell,
        }: &SoilPoint<D>,
    ) {
        if weight <= 0.0 {
            return;
        }
        let (body, node) = (self.body, self.node);
        let tangents = soil.face.tangents_at(body, image);
        let sums = self.knots.entry(image.knot).or_default();
        let thickness = self.section.thickness(place[0]);
        let length = weight;
        let weight = thickness * weight;
        sums.length += length;
        sums.area += weight;
        sums.gap += weight * gap;
        if soil.sees {
            sums.seen_gap += weight * gap;
            sums.seen_area += weight;
        }
        sums.young += weight * soil.young;
        sums.adhesion += weight * soil.adhesion;
        sums.cell += weight * cell;
        let of_body = |direction: &[f64; D]| rigid_shares(body, place, direction, node);
        let normal = &soil.face.normal;
        sums.facing += weight * normal.iter().fold(0.0_f64, |most, n| most.max(n.abs()));
        let arm = minus(place, &body.pose.origin);
        let [first, second] = &tangents;
        sums.arms.add(weight, &arm, [normal, first, second]);
        add(&mut sums.opening, weight, normal, shares, of_body(normal));
        for (slip, tangent) in std::iter::zip(&mut sums.slip, &tangents).take(D - 1) {
            add(slip, weight, tangent, shares, of_body(tangent));
        }
    }
}

/// By side the faces whose particles end before the face of another begins.
fn thin<const D: usize>(faces: &[(usize, Face<D>)], sides: usize) -> Vec<Vec<&Face<D>>> {
    let mut furthest = vec![0.0_f64; sides];
    for (_, face) in faces {
        furthest[face.side] = furthest[face.side].max(face.gap);
    }
    let mut thin = vec![Vec::new(); sides];
    for (_, face) in faces {
        if face.may_hide(furthest[face.side]) {
            thin[face.side].push(face);
        }
    }
    thin
}

/// The radius of a body that may roll in a step \[length\]: it is round, and the step takes time. Other points of its surface
/// come near in every step, so that those that are open are measured anew (theory, eq. 45e).
pub(crate) fn rolling_radius<const D: usize>(
    body: &RigidBody<D>,
    conditions: &StepConditions<D>,
) -> Option<f64> {
    conditions.time.and(body.surface.radius())
}

/// The soil's displacement at a point, as shares of nodes that carry soil.
struct SoilPoint<const D: usize> {
    /// They sum to one.
    shares: Vec<(usize, f64)>,
    /// The place that the shares stand for, the point itself if all of its nodes carry soil. Seen from there
    /// a rotation of body and soil together opens no gap, and moments balance \[length\].
    place: [f64; D],
    /// From the body to the soil \[length\].
    gap: f64,
    /// Size of the cell \[length\].
    cell: f64,
}

/// The soil at a point by the tent functions; none where no node carries soil.
fn soil_at<const D: usize>(
    grid: &Grid<D>,
    stencils: &Stencils<D>,
    unknowns: &Unknowns<D>,
    x: &[f64; D],
) -> Option<SoilPoint<D>> {
    let cell = grid.cell_at(x)?;
    let size = grid.cell_size(cell);
    let node = grid.node_position(grid.node_index(cell));
    let within = std::array::from_fn(|a| (x[a] - node[a]) / size[a]);
    let mut shares: Vec<(usize, f64)> = Vec::with_capacity(1 << D);
    let mut sum = 0.0;
    for (node, share, _) in grid.tents(cell, within) {
        if share <= LEAST_SHARE {
            continue;
        }
        for carrier in (stencils.carriers(node)).filter(|by| unknowns.is_active(by.node)) {
            let share = carrier.weight * share;
            shares.push((carrier.node, share));
            sum += share;
        }
    }
    if shares.is_empty() {
        return None;
    }
    let mut place = [0.0; D];
    for (node, share) in &mut shares {
        *share /= sum;
        let at = grid.node_position(*node);
        for axis in 0..D {
            place[axis] += *share * at[axis];
        }
    }
    Some(SoilPoint {
        shares,
        place,
        gap: 0.0,
        cell: size.into_iter().fold(f64::INFINITY, f64::min),
    })
}

/// Minus the displacement of a body at a point in a direction: shares of its two nodes.
fn rigid_shares<const D: usize>(
    body: &RigidBody<D>,
    x: &[f64; D],
    direction: &[f64; D],
    node: usize,
) -> [(usize, [f64; D]); 2] {
    let arm: [f64; D] = std::array::from_fn(|a| x[a] - body.pose.origin[a]);
    let size = body.surface.size();
    let mut turning = [0.0; D];
    if D == 2 {
        turning[0] = -(arm[0] * direction[1] - arm[1] * direction[0]) / size;
    } else {
        let (r, n) = (padded(&arm), padded(direction));
        let moment = cross(&r, &n);
        for a in 0..D {
            turning[a] = -moment[a] / size;
        }
    }
    [(node, direction.map(|n| -n)), (node + 1, turning)]
}

/// Adds a weight times the relative displacement along a direction to a sum.
fn add<const D: usize>(
    sum: &mut BTreeMap<usize, [f64; D]>,
    weight: f64,
    direction: &[f64; D],
    shares: &[(usize, f64)],
    of_body: [(usize, [f64; D]); 2],
) {
    for &(node, share) in shares {
        let entry = sum.entry(node).or_insert([0.0; D]);
        for axis in 0..D {
            entry[axis] += weight * share * direction[axis];
        }
    }
    for (node, share) in of_body {
        let entry = sum.entry(node).or_insert([0.0; D]);
        for axis in 0..D {
            entry[axis] += weight * share[axis];
        }
    }
}
