//! Contact between soil and rigid bodies over one step: the knots that touch, and their forces
//! (theory, eqs. 45 to 48).

use std::collections::BTreeMap;

use super::mortar_integrals::{Gathering, rolling_radius};
use super::sums::Sums;
use crate::body::particles::Particles;
use crate::conditions::StepConditions;
use crate::conditions::rigid_motion::RigidMotion;
use crate::contributions::nodal_forces::{AddBlock, NodalForces};
use crate::method::{Geometry, Method};
use crate::step::stencils::Stencils;
use crate::step::unknowns::Unknowns;
use igimp_rigid::{
    ADHESIVE_GAP, ALONG_THE_GRID, ContactChange, ContactNode, ContactState, Functional, Images,
    Interface, KnotContact, NODES_PER_BODY, Penalty, Penetration, RigidBody, Tension, push_out,
    rotations, tents_within,
};
use igimp_surface::vectors::{minus, norm};

/// A knot of space that soil covers by a smaller share of the largest one has none: round-off beyond a plane of
/// symmetry \[-\].
const LEAST_COVER: f64 = 1e-10;

/// Soil that is no further from a body touches it, in cells: as drawn, but for round-off. A body that a force pushes is laid on it \[-\].
const BESIDE: f64 = 1e-6;

/// Contact of one step, with directions and weights frozen at its start.
#[derive(Debug)]
pub(crate) struct Contact<'a, const D: usize> {
    bodies: &'a [RigidBody<D>],
    rows: Vec<KnotContact<D>>,
    /// How stiff contact is, by row.
    penalties: Vec<Penalty>,
    /// The first of the nodes that stand for bodies.
    first_node: usize,
}

/// Rigid bodies and the soil near them as an accepted step leaves them.
#[derive(Clone, Debug, Default)]
pub struct AcceptedContact<const D: usize> {
    /// The bodies.
    pub bodies: Vec<RigidBody<D>>,
    /// Particles that stand too close to a body, with the way back \[length\]: contact holds the mean around
    /// a knot, and lets single particles creep across the surface.
    pub push_out: Vec<(usize, [f64; D])>,
}

impl<'a, const D: usize> Contact<'a, D> {
    /// Finds the knots that touch at the start of a step.
    pub(crate) fn find(
        bodies: &'a [RigidBody<D>],
        particles: &Particles<D>,
        stencils: &Stencils<D>,
        (conditions, method): (&StepConditions<D>, &Method),
        unknowns: &Unknowns<D>,
    ) -> Self {
        let first_node = conditions.grid.node_count();
        let mut contact = Self {
            bodies,
            rows: Vec::new(),
            penalties: Vec::new(),
            first_node,
        };
        for body in 0..bodies.len() {
            contact.find_of(body, particles, stencils, (conditions, method), unknowns);
        }
        contact
    }

    fn find_of(
        &mut self,
        index: usize,
        particles: &Particles<D>,
        stencils: &Stencils<D>,
        (conditions, method): (&StepConditions<D>, &Method),
        unknowns: &Unknowns<D>,
    ) {
        let body = &self.bodies[index];
        let surface = &*body.surface;
        let images = Images::of(body, &conditions.grid);
        let tents = match surface.space() {
            Some(space) => images.folded(&tents_within(body, space, &conditions.grid)),
            None => surface.tents(),
        };
        let least = match surface.space() {
            Some(_) => LEAST_COVER * tents.iter().copied().fold(0.0, f64::max),
            None => 0.0,
        };
        let node = self.first_node + NODES_PER_BODY * index;
        let motion = conditions.motions.get(index);
        let is_pushed = conditions.is_laid || motion.is_some_and(RigidMotion::is_pushed);
        let is_loaded = conditions.time.is_none() && is_pushed;
        let carries = body.contact.knots.iter().any(|knot| knot.pressure > 0.0);
        let rolls = rolling_radius(body, conditions).is_some();
        let of_step = (conditions, method.section);
        let knots = Gathering::new(body, node, particles, stencils, of_step, unknowns, &images);
        let knots = knots.sums();
        for (knot, sums) in knots {
            // No more of a side touches than there is of it.
            let area = if sums.length > tents[knot] {
                tents[knot] * (sums.area / sums.length)
            } else {
                sums.area
            };
            if area <= least {
                continue;
            }
            let mean = |sum: f64| sum / sums.area;
            let functional = |sum: &BTreeMap<usize, [f64; D]>| -> Functional<D> {
                let terms = sum.iter().map(|(&node, share)| (node, share.map(mean)));
                terms.collect()
            };
            let mut before = body.contact.knots[knot];
            let interface = &body.interfaces[surface.side_of(knot)];
            let is_beside = sums.gap_in_front() < BESIDE * mean(sums.cell);
            let is_new = before.area == 0.0 || !carries && before.gap <= BESIDE * mean(sums.cell);
            let is_laid = is_new && is_loaded && is_beside;
            let bonds = interface.tension != Tension::None && !before.is_broken;
            // Particles that the ground cuts stand off a side by a share of their size, and go nowhere. A round body leaves the
            // ground at a slant: small gaps beside its contact are gaps.
            let is_drawn_at = method.geometry == Geometry::Given
                && surface.radius().is_none()
                && sums.gap_in_front() < ADHESIVE_GAP * mean(sums.cell);
            let touches = bonds || is_beside || is_drawn_at;
            begin(&mut before, &sums, touches, rolls);
            let mut row = KnotContact {
                body: index,
                knot,
                area,
                gap: before.gap,
                cell: mean(sums.cell),
                young: mean(sums.young),
                adhesion: mean(sums.adhesion),
                opening: functional(&sums.opening),
                slip: [functional(&sums.slip[0]), functional(&sums.slip[1])],
                arms: turns(body, method).then(|| sums.arms_of(node + 1, surface.size())),
                before,
            };
            let penalty = penalty_of(body, &sums, (conditions, method));
            row.carry_force(interface, &penalty, tents[knot] * (sums.area / sums.length));
            if interface.tension == Tension::None && !rolls {
                let takes_time = conditions.time.is_some();
                row.take_soil_that_came((sums.gap_in_front(), takes_time), interface, &penalty);
            }
            if is_laid {
                row.seat(&penalty);
            }
            self.rows.push(row);
            self.penalties.push(penalty);
        }
    }

    /// A body.
    pub(crate) fn body(&self, index: usize) -> &RigidBody<D> {
        &self.bodies[index]
    }

    /// The bodies.
    pub(crate) fn bodies(&self) -> &'a [RigidBody<D>] {
        self.bodies
    }

    /// Whether any soil can touch a body in this step.
    pub(crate) fn may_touch(&self, index: usize) -> bool {
        self.rows.iter().any(|row| row.body == index)
    }

    /// Whether soil that a body sees in this step is around the knots beside a point in its frame.
    fn acts_near(&self, index: usize, at: &[f64; D]) -> bool {
        let surface = &*self.bodies[index].surface;
        let (knots, reach) = (surface.knots(), surface.longest_facet());
        let mut rows = self.rows.iter().filter(|row| row.body == index);
        rows.any(|row| norm(&minus(&knots[row.knot].0, at)) <= reach)
    }

    /// How far soil came near in a step by nodal displacements `u` \[length\] where a gap closed, at most, in cells \[-\].
    pub(crate) fn closing(&self, u: &[[f64; D]]) -> f64 {
        // Soil that the body did not see before may overlap it already: its gap begins at zero.
        let was_open = |row: &&KnotContact<D>| row.gap > 0.0 || row.before.area == 0.0;
        let closes = |row: &&KnotContact<D>| was_open(row) && row.gap_at(u) < 0.0;
        let ways = self.rows.iter().filter(closes);
        ways.map(|row| (row.gap - row.gap_at(u)) / row.cell)
            .fold(0.0, f64::max)
    }

    /// By body, changes of contact in a step by nodal displacements `u` \[length\]. Bodies would go on by `free` \[length\] without it,
    /// and go on by `next` \[length\].
    pub(crate) fn changes(
        &self,
        u: &[[f64; D]],
        (free, next): (&[[f64; D]], &[[f64; D]]),
    ) -> Vec<ContactChange> {
        let mut changes = vec![ContactChange::default(); self.bodies.len()];
        for (row, penalty) in std::iter::zip(&self.rows, &self.penalties) {
            let body = &self.bodies[row.body];
            let interface = &body.interfaces[body.surface.side_of(row.knot)];
            let traction = row.traction(interface, penalty, u);
            let grown = row.area * (traction.pressure - row.before.pressure);
            let (way, slip) = (row.gap - row.gap_at(free), row.slip_at(next));
            let [first, second] = traction.shear;
            let change = &mut changes[row.body];
            if grown > 0.0 && way > 0.0 {
                change.force += grown;
                change.work += grown * way;
            }
            if traction.slips {
                change.friction += row.area * first.hypot(second);
                change.driven += row.area * (first * slip[0] + second * slip[1]).max(0.0);
            }
        }
        changes
    }

    /// State of contact when nodal step displacements `u` are accepted: the bodies at their
    /// new places. On a given geometry they stay.
    pub(crate) fn accepted(
        &self,
        u: &[[f64; D]],
        particles: &Particles<D>,
        stencils: &Stencils<D>,
        (method, takes_time): (&Method, bool),
    ) -> Result<AcceptedContact<D>, Penetration> {
        let mut moved: Vec<RigidBody<D>> = self.bodies.to_vec();
        for (index, body) in moved.iter_mut().enumerate() {
            let node = self.first_node + NODES_PER_BODY * index;
            let mut rotation = [0.0; 3];
            for (k, angle) in rotation.iter_mut().enumerate().take(rotations(D)) {
                *angle = u[node + 1][k] / body.surface.size();
            }
            body.pose = body.pose.moved(&u[node], &rotation);
            let knots = body.contact.knots.len();
            body.contact = ContactState::none(knots);
            let before = &self.bodies[index].contact.knots;
            for (knot, before) in body.contact.knots.iter_mut().zip(before) {
                knot.is_broken = before.is_broken;
            }
        }
        for (row, penalty) in std::iter::zip(&self.rows, &self.penalties) {
            let body = &self.bodies[row.body];
            let side = body.surface.side_of(row.knot);
            let traction = row.traction(&body.interfaces[side], penalty, u);
            let bonded = body.interfaces[side].tension != Tension::None;
            let is_broken = row.before.is_broken || traction.breaks;
            let gap = row.gap_at(u);
            let is_closed = traction.pressure > 0.0
                || (bonded && !is_broken && (row.before.is_closed || gap <= 0.0));
            // Shear of a side that opens goes on while adhesion does.
            let holds = is_closed || row.adheres_at(gap, is_broken);
            moved[row.body].contact.knots[row.knot] = ContactNode {
                pressure: traction.pressure,
                shear: if holds { traction.shear } else { [0.0; 2] },
                area: row.area,
                gap,
                is_closed,
                slips: traction.slips && holds,
                way: match method.geometry {
                    Geometry::Moving => row.way(u),
                    Geometry::Given => 0.0,
                },
                is_broken,
            };
        }
        // On a given geometry nothing goes anywhere.
        if method.geometry == Geometry::Given {
            for (body, before) in moved.iter_mut().zip(self.bodies) {
                body.pose = before.pose.clone();
            }
            return Ok(AcceptedContact {
                bodies: moved,
                push_out: Vec::new(),
            });
        }
        let place = |particle: usize| {
            let (x, step) = (&particles.x[particle], stencils.displacement(particle, u));
            std::array::from_fn(|axis| x[axis] + step[axis])
        };
        // Soil that creeps against a drag goes a share of a cell in a step, and is pressed off bodies in the next.
        let acts = |body: usize, at: &[f64; D]| {
            !takes_time && (method.flows() || self.acts_near(body, at))
        };
        let push_out = push_out((self.bodies, &moved), particles.domains(), place, acts)?;
        Ok(AcceptedContact {
            bodies: moved,
            push_out,
        })
    }
}

/// How stiff a knot closes: at once in statics at straight sides along the grid, softly elsewhere (theory, eq. 46).
fn penalty_of<const D: usize>(
    body: &RigidBody<D>,
    sums: &Sums<D>,
    (conditions, method): (&StepConditions<D>, &Method),
) -> Penalty {
    let is_along = body.surface.radius().is_none() && sums.facing() >= ALONG_THE_GRID;
    if conditions.time.is_some() || method.flows() || !is_along {
        body.penalty.softly()
    } else {
        body.penalty
    }
}

/// Whether arms turn with a body in a step: not those of a round one, which shows the same surface however it turns.
fn turns<const D: usize>(body: &RigidBody<D>, method: &Method) -> bool {
    method.geometry == Geometry::Moving && body.surface.radius().is_none()
}

/// Sets the gap that a knot begins a step with. Soil that comes near is as far off as its part in front (theory, eq. 45f), and
/// touches if it overlaps; from then on the gap follows its motion, unless the body `rolls` and the knot is open. Where soil `touches` it does at once.
fn begin<const D: usize>(before: &mut ContactNode, sums: &Sums<D>, touches: bool, rolls: bool) {
    let gap = sums.mean_gap();
    if before.area == 0.0 {
        before.gap = if touches {
            0.0
        } else {
            sums.gap_in_front().max(0.0)
        };
        before.is_closed = before.gap == 0.0;
    } else if !before.is_closed && rolls {
        before.gap = gap.max(0.0);
    } else if !before.is_closed && sums.area > before.area {
        // More of the soil around the knot has come near, the last of it from further off.
        before.gap = before.gap.max(gap);
    }
}

impl<const D: usize> NodalForces<D> for Contact<'_, D> {
    fn pairs(&self) -> Vec<(usize, usize)> {
        let mut pairs = Vec::new();
        for row in &self.rows {
            let nodes: Vec<usize> = row
                .opening
                .iter()
                .map(|&(node, _)| node)
                .filter(|&node| node < self.first_node)
                .collect();
            for &a in &nodes {
                pairs.extend(nodes.iter().map(|&b| (a, b)));
            }
        }
        pairs
    }

    fn is_symmetric(&self) -> bool {
        let interfaces = self.bodies.iter().flat_map(|body| &body.interfaces);
        interfaces.into_iter().all(Interface::is_symmetric)
    }

    fn add(&self, u: &[[f64; D]], f: &mut [[f64; D]], mut blocks: Option<&mut AddBlock<'_, D>>) {
        for (row, penalty) in std::iter::zip(&self.rows, &self.penalties) {
            let body = &self.bodies[row.body];
            let interface = &body.interfaces[body.surface.side_of(row.knot)];
            let traction = row.traction(interface, penalty, u);
            match &mut blocks {
                Some(blocks) => row.add(&traction, u, f, Some(&mut **blocks)),
                None => row.add(&traction, u, f, None),
            }
        }
    }
}
