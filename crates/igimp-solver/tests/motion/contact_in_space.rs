//! GOAL: rigid bodies in space do what bodies in the plane do, in any direction.
//! BODY: blocks of 2 particles per direction and unit cell on a rough floor, under plates that press, slide, tilt,
//! turn and lift.
//! ORACLE: the plane in a slice with smooth sides; balance of forces and moments; Coulomb's law along any
//! direction; the same on any number of threads.

use std::sync::Arc;

use crate::body_support::workspace;
use igimp_assembly::{
    Constraints, Drive, Interface, Method, ParticleSeed, Particles, RigidBody, RigidMotion,
    SharedLaw, StepConditions, StepLoads, Surface,
};
use igimp_material::{Elasticity, HenckyElastic};
use igimp_shape::{Axis, Grid};
use igimp_solver::{Body, NewtonSettings, NodalForces, StepReport, step};

/// Half of the width of the plate \[length\], and where its base lies.
const HALF: f64 = 2.0;
const BASE: f64 = 3.0;

fn law() -> SharedLaw {
    Arc::new(HenckyElastic::new(Elasticity::new(100.0, 0.3).unwrap()))
}

/// 2 particles per direction in every unit cell of a box of cells.
fn soil<const D: usize>(from: [usize; D], to: [usize; D]) -> Particles<D> {
    let count: [usize; D] = std::array::from_fn(|axis| 2 * (to[axis] - from[axis]));
    let seeds: Vec<_> = (0..count.iter().product())
        .map(|mut number: usize| ParticleSeed {
            x: std::array::from_fn(|axis| {
                let place = number % count[axis];
                number /= count[axis];
                from[axis] as f64 + 0.25 + 0.5 * place as f64
            }),
            half_length: [0.25; D],
            volume: 0.5_f64.powi(D as i32),
            density: 1.0,
            law: 0,
            centroid: [0.0; _],
        })
        .collect();
    Particles::new(&seeds).unwrap()
}

/// Lines of the grid sideways and upward: the sides and the surface of soil lie in the middle of cells, so that none
/// of it reaches a new row of nodes.
fn sideways(cells: usize) -> Axis {
    Axis::uniform(-0.5, 1.0, cells + 1).unwrap()
}

fn upward() -> Axis {
    Axis::from_nodes(vec![0.0, 1.0, 2.0, 3.4, 4.4, 5.4]).unwrap()
}

/// Soil on a floor that holds it, under a body.
fn on_a_floor<const D: usize>(
    axes: [Axis; D],
    soil: Particles<D>,
    mut rigid: RigidBody<D>,
    origin: [f64; D],
) -> (Body<D>, StepConditions<D>) {
    let grid = Grid::new(axes);
    rigid.pose.origin = origin;
    let mut body = Body::new(soil);
    body.rigid = vec![rigid];
    let mut constraints = Constraints::free(&grid);
    for axis in 0..D {
        constraints.fix_wall(&grid, D - 1, false, axis).unwrap();
    }
    let loads = StepLoads::gravity([0.0; D]);
    let conditions = StepConditions::new(grid, constraints, loads, vec![law()]).unwrap();
    (body, conditions)
}

fn advance<const D: usize>(
    body: &mut Body<D>,
    conditions: &StepConditions<D>,
    motion: RigidMotion<D>,
) -> (StepReport, NodalForces<D>) {
    let conditions = conditions.clone().with_motions(vec![motion]).unwrap();
    let settings = NewtonSettings {
        tolerance: 1e-12,
        ..NewtonSettings::default()
    };
    step(
        body,
        &Method::igimp_bbar(),
        &conditions,
        (0.0, 1.0),
        &settings,
        &mut workspace(),
    )
    .unwrap()
}

/// The force that acts on the body from outside along prescribed components.
fn on_the_body<const D: usize>(forces: &NodalForces<D>) -> [f64; D] {
    forces.reactions[forces.reactions.len() - 2]
}

/// Six by four cells of soil, three high, under a plate that covers part of them.
fn under_a_plate(interface: &Interface) -> (Body<3>, StepConditions<3>) {
    let surface = Surface::cuboid([HALF, 1.5, 0.5], 0.0, 1.0).unwrap();
    let plate = RigidBody::new(surface, vec![interface.clone(); 6], [0.0; 3]);
    let ground = soil([2, 2, 0], [8, 6, 3]);
    on_a_floor(
        [sideways(10), sideways(8), upward()],
        ground,
        plate,
        [5.0, 4.0, BASE + 0.5],
    )
}

/// A slice with smooth sides, two cells thick, under a bar that goes on beyond them: pressed, pushed until it slides,
/// tilted and lifted, it has the forces and stresses of the plane.
#[test]
fn a_slice_is_the_plane() {
    for interface in [
        Interface::smooth(),
        Interface::rough(),
        Interface::friction(0.3),
        Interface::rough().bonded(),
    ] {
        let corners = [[-HALF, 0.0], [HALF, 0.0], [HALF, 1.0], [-HALF, 1.0]];
        let surface = Surface::polygon(&corners, 0.3, 1.0).unwrap();
        let strip = RigidBody::new(surface, vec![interface.clone(); 4], [0.0; 2]);
        let ground = soil([2, 0], [8, 3]);
        let (mut plane, in_plane) =
            on_a_floor([sideways(10), upward()], ground, strip, [5.0, BASE - 1e-6]);
        // The axes after the second are the third and the first.
        let corners = corners.map(|[x, z]| [z, x]);
        let surface = Surface::prism(1, &corners, [-4.3, 6.3], 0.3, 1.0).unwrap();
        let bar = RigidBody::new(surface, vec![interface.clone(); 6], [0.0; 3]);
        let ground = soil([2, 0, 0], [8, 2, 3]);
        let thick = Axis::uniform(0.0, 1.0, 2).unwrap();
        let (mut space, in_space) = on_a_floor(
            [sideways(10), thick, upward()],
            ground,
            bar,
            [5.0, 0.0, BASE - 1e-6],
        );
        let (grid, mut held) = (in_space.grid.clone(), in_space.constraints.clone());
        for upper in [false, true] {
            held.fix_wall(&grid, 1, upper, 1).unwrap();
        }
        let loads = StepLoads::gravity([0.0; 3]);
        let in_space = StepConditions::new(grid, held, loads, vec![law()]).unwrap();
        for (x, z, turn) in [
            (0.0, -0.05, 0.0),
            (0.05, -0.02, 0.0),
            (0.0, -0.02, 0.02),
            (0.0, -0.02, -0.06),
            (0.0, 0.15, 0.0),
        ] {
            let mut motion = RigidMotion::displaced([x, z]);
            motion.rotation[0] = Drive::Moved(turn);
            let (_, flat) = advance(&mut plane, &in_plane, motion);
            let mut motion = RigidMotion::displaced([x, 0.0, z]);
            motion.rotation[1] = Drive::Moved(-turn);
            let (_, thick) = advance(&mut space, &in_space, motion);
            let (flat, thick) = (on_the_body(&flat), on_the_body(&thick));
            let scale = 1.0 + flat[0].hypot(flat[1]);
            for (flat, thick) in [(flat[0], thick[0]), (flat[1], thick[2])] {
                let off = (thick - 2.0 * flat).abs() / scale;
                assert!(off < 1e-6, "{interface:?} {x} {z} {turn}: {flat} {thick}");
            }
        }
        // Particles of the slice stand in the order of the plane, four for each of its own.
        let largest = |sigma: &[[[f64; 3]; 3]]| {
            let all = sigma.iter().flatten().flatten();
            all.fold(0.0, |most: f64, x| most.max(x.abs()))
        };
        let scale = largest(&plane.particles.sigma).max(1.0);
        for (k, x) in space.particles.x.iter().enumerate() {
            let near = |other: &[f64; 2]| (x[0] - other[0]).hypot(x[2] - other[1]);
            let distances = plane.particles.x.iter().map(near);
            let (twin, far) = distances
                .enumerate()
                .min_by(|a, b| a.1.total_cmp(&b.1))
                .unwrap();
            assert!(far < 1e-6, "{interface:?}: {far:e}");
            let (thick, flat) = (&space.particles.sigma[k], &plane.particles.sigma[twin]);
            for (a, b) in [(0, 0), (2, 1), (1, 2)] {
                assert!((thick[a][a] - flat[b][b]).abs() < 1e-5 * scale);
            }
        }
    }
}

/// Root mean square of the deviation of stress from the exact one, over it, below a smooth plate that is turned about all
/// axes, while all sides move towards a corner.
fn below_a_turned_plate(angle: f64, cells: usize) -> f64 {
    let (h, rises) = (1.0 / cells as f64, 0.436_f64);
    let across = || Axis::uniform(0.0, h, cells).unwrap();
    let grid = Grid::new([
        across(),
        across(),
        Axis::uniform(0.0, h, 2 * cells).unwrap(),
    ]);
    let (rise, (sin, cos)) = (angle.tan(), rises.sin_cos());
    let height = |x: f64, y: f64| 0.4 + rise * (cos * x + sin * y);
    let (part, mut seeds) = (0.5 * h, Vec::new());
    for column in 0..4 * cells * cells {
        let [x, y] = [column % (2 * cells), column / (2 * cells)].map(|k| part * (k as f64 + 0.5));
        let count = (height(x, y) / part).round();
        let size = height(x, y) / count;
        seeds.extend((0..count as usize).map(|k| ParticleSeed {
            x: [x, y, size * (k as f64 + 0.5)],
            half_length: [0.5 * part, 0.5 * part, 0.5 * size],
            volume: part * part * size,
            density: 1.0,
            law: 0,
            centroid: [0.0; _],
        }));
    }
    let normal = [-angle.sin() * cos, -angle.sin() * sin, angle.cos()];
    let middle = [0.5, 0.5, height(0.5, 0.5)];
    let surface = Surface::cuboid([2.0, 2.0, 0.25], 0.0, h).unwrap();
    let origin = std::array::from_fn(|a| middle[a] + 0.25 * normal[a]);
    let mut plate = RigidBody::new(surface, vec![Interface::smooth(); 6], origin);
    plate.pose = plate.pose.moved(&[0.0; 3], &[0.0, 0.0, 0.5]);
    let about = [angle * sin, -angle * cos, 0.0];
    plate.pose = plate.pose.moved(&[0.0; 3], &about);
    let mut body = Body::new(Particles::new(&seeds).unwrap());
    body.rigid = vec![plate];
    let strain = 1e-3;
    let mut constraints = Constraints::free(&grid);
    for axis in 0..3 {
        constraints.fix_wall(&grid, axis, false, axis).unwrap();
    }
    for node in 0..grid.node_count() {
        let place = grid.node_place(node);
        for axis in (0..2).filter(|&axis| place[axis] == cells) {
            constraints.prescribe(node, axis, -strain).unwrap();
        }
    }
    let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(100.0, 0.0).unwrap()));
    let loads = StepLoads::gravity([0.0; 3]);
    let conditions = StepConditions::new(grid, constraints, loads, vec![law]).unwrap();
    let down = RigidMotion::displaced([0.0, 0.0, -0.4 * strain]);
    advance(&mut body, &conditions, down);
    let exact = 100.0 * (1.0 - strain).ln() / (1.0 - strain).powi(3);
    let (mut square, mut volume) = (0.0, 0.0);
    for (particle, sigma) in body.particles.sigma.iter().enumerate() {
        let size = body.particles.volume0[particle];
        for a in 0..3 {
            for b in a..3 {
                let off = sigma[a][b] - if a == b { exact } else { 0.0 };
                square += size * off * off;
            }
        }
        volume += size;
    }
    (square / volume).sqrt() / exact.abs()
}

/// Below a plate that is turned about all axes the stepped edge of the particles leaves an error that falls as the root
/// of the cell.
#[test]
fn a_turned_plate_presses_evenly() {
    for degrees in [15.0_f64, 30.0, 42.0] {
        let [coarse, fine] = [4, 8].map(|cells| below_a_turned_plate(degrees.to_radians(), cells));
        let order = (coarse / fine).log2();
        assert!(order > 0.4, "{degrees} degrees: {coarse} {fine} {order}");
    }
}

/// A plate with a force and a moment about every axis, free in all six components: what the floor carries is that
/// force, and its moment about the place at which the step began.
#[test]
fn a_free_plate_hands_six_components_to_the_floor() {
    let (mut body, conditions) = under_a_plate(&Interface::rough());
    let down = RigidMotion::displaced([0.0, 0.0, -0.01]);
    advance(&mut body, &conditions, down);
    let (force, moment) = ([0.2, -0.4, -8.0], [1.2, -1.6, 0.6]);
    let motion = RigidMotion {
        displacement: force.map(Drive::Loaded),
        rotation: moment.map(Drive::Loaded),
        ..RigidMotion::held()
    };
    let before = body.rigid[0].pose.clone();
    let (report, forces) = advance(&mut body, &conditions, motion);
    assert!(report.iterations <= 9, "{} corrections", report.iterations);
    let (mut sum, mut about) = ([0.0; 3], [0.0; 3]);
    let size = body.rigid[0].surface.size();
    let nodes = conditions.grid.node_count();
    for node in 0..nodes {
        let x = conditions.grid.node_position(node);
        let reaction = forces.reactions[node];
        for axis in 0..3 {
            let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
            sum[axis] += reaction[axis];
            let arm = |k: usize| x[k] - before.origin[k];
            about[axis] += arm(a) * reaction[b] - arm(b) * reaction[a];
        }
    }
    for axis in 0..3 {
        assert!((sum[axis] + force[axis]).abs() < 1e-9, "{sum:?}");
        // Arms and normals are those of the step's start: the moment is right to the motion of a step.
        assert!((about[axis] + moment[axis]).abs() < 0.05, "{about:?}");
    }
    // Free components have no reaction.
    for node in [nodes, nodes + 1] {
        for axis in 0..3 {
            assert!(forces.reactions[node][axis].abs() < 1e-9 * size);
        }
    }
    let after = &body.rigid[0].pose;
    for axis in 0..3 {
        assert!(after.angle[axis] * moment[axis] > 0.0, "{:?}", after.angle);
    }
}

/// A plate that is pushed along any direction of its base carries μ times the force that presses it, against the
/// push.
#[test]
fn a_plate_slides_alike_in_all_directions() {
    for angle in [0.0, 0.4, 1.1, 2.6, -1.9_f64] {
        let surface = Surface::cuboid([4.0, 3.5, 0.5], 0.0, 1.0).unwrap();
        let plate = RigidBody::new(surface, vec![Interface::friction(0.3); 6], [0.0; 3]);
        let (ground, at) = (soil([2, 2, 0], [8, 6, 3]), [5.0, 4.0, BASE + 0.5]);
        let (mut body, conditions) =
            on_a_floor([sideways(10), sideways(8), upward()], ground, plate, at);
        let down = RigidMotion::displaced([0.0, 0.0, -0.05]);
        advance(&mut body, &conditions, down);
        let (sin, cos) = angle.sin_cos();
        let mut forces = None;
        for _ in 0..4 {
            let mut motion = RigidMotion::displaced([0.1 * cos, 0.1 * sin, 0.0]);
            motion.displacement[2] = Drive::Loaded(-20.0);
            forces = Some(advance(&mut body, &conditions, motion).1);
        }
        let [x, y, _] = on_the_body(&forces.unwrap());
        assert!((x.hypot(y) / 6.0 - 1.0).abs() < 5e-3, "{angle}: {x} {y}");
        let aside = (cos * y - sin * x) / 6.0;
        assert!(aside.abs() < 0.01, "{angle}: {aside}");
        let knots = body.rigid[0].contact.knots.iter();
        assert!(knots.filter(|knot| knot.is_closed).all(|knot| knot.slips));
    }
}

/// Soil lets go of a plate that is lifted, and carries as much as before when it comes back.
#[test]
fn soil_lets_go_and_carries_again() {
    let (mut body, conditions) = under_a_plate(&Interface::smooth());
    let mut vertical = |by: f64| {
        let motion = RigidMotion::displaced([0.0, 0.0, by]);
        let (_, forces) = advance(&mut body, &conditions, motion);
        let is_closed = body.rigid[0]
            .contact
            .knots
            .iter()
            .any(|knot| knot.is_closed);
        (on_the_body(&forces)[2], is_closed)
    };
    let (first, touches) = vertical(-0.1);
    assert!(first < -1.0 && touches);
    let (lifted, touches) = vertical(0.2);
    assert!(lifted.abs() < 1e-9 && !touches, "{lifted}");
    let (again, _) = vertical(-0.2);
    assert!((again / first - 1.0).abs() < 0.01, "{first} {again}");
}

/// A plate that is turned about its own axis under load drags the soil round, and ends where the sum of its turns
/// leads.
#[test]
fn a_plate_turns_about_its_axis() {
    let surface = Surface::cylinder(2, 1.5, 0.5, 0.0, 0.8).unwrap();
    let disc = RigidBody::new(surface, vec![Interface::rough(); 3], [0.0; 3]);
    let ground = soil([2, 2, 0], [8, 8, 3]);
    let (mut body, conditions) = on_a_floor(
        [sideways(10), sideways(10), upward()],
        ground,
        disc,
        [5.0, 5.0, BASE + 0.5],
    );
    advance(
        &mut body,
        &conditions,
        RigidMotion::displaced([0.0, 0.0, -0.05]),
    );
    let mut twist = 0.0;
    for _ in 0..3 {
        let mut motion = RigidMotion::held();
        motion.rotation[2] = Drive::Moved(0.03);
        let (_, forces) = advance(&mut body, &conditions, motion);
        let reaction = &forces.reactions[forces.reactions.len() - 1];
        let next = reaction[2] * body.rigid[0].surface.size();
        assert!(next > twist, "{next} {twist}");
        twist = next;
        let [x, y, _] = on_the_body(&forces);
        // Quarters are alike, but for nodes at the edge of the soil that are tied to one neighbour or another.
        assert!(x.hypot(y) < 0.02 * twist, "{x} {y} {twist}");
    }
    let turned = body.rigid[0].pose.direction(&[1.0, 0.0, 0.0]);
    assert!((turned[1].atan2(turned[0]) - 0.09).abs() < 1e-12);
}

#[test]
fn steps_have_the_same_bits_on_one_two_and_seven_threads() {
    let bits = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            let (mut body, conditions) = under_a_plate(&Interface::friction(0.3));
            advance(
                &mut body,
                &conditions,
                RigidMotion::displaced([0.0, 0.0, -0.05]),
            );
            let motion = RigidMotion {
                displacement: [Drive::Moved(0.1), Drive::Moved(0.05), Drive::Loaded(-15.0)],
                rotation: [Drive::Loaded(-4.0), Drive::Loaded(2.0), Drive::Moved(0.01)],
                ..RigidMotion::held()
            };
            let (_, forces) = advance(&mut body, &conditions, motion);
            let slips = body.rigid[0].contact.knots.iter().any(|knot| knot.slips);
            assert!(slips, "the plate slides");
            format!("{body:?} {forces:?}")
        })
    };
    let one = bits(1);
    assert_eq!(one, bits(2));
    assert_eq!(one, bits(7));
}
