//! GOAL: contact with rigid bodies has the tangent of its force, acts on body and soil alike, and has the
//! same bits on any number of threads; poses turn rigidly.
//! BODY: particles at random places under a tilted body, in the plane and in space.
//! ORACLE: central differences, balance of force and moment.

use std::f64::consts::FRAC_PI_4;

use crate::common::{Random, displacements, grid, laws, particles};
use igimp_assembly::{
    Constraints, ContactNode, Drive, Geometry, Interface, Method, Particles, Pose, RigidBody,
    RigidMotion, SharedLaw, Shear, Stencils, StepConditions, StepLoads, Structures, Surface,
    System, Tension, TimeScheme, TimeStep,
};
use igimp_linear::TangentMatrix;
use igimp_material::TangentKind;
use igimp_shape::Grid;

/// Stiffness of contact per area on cells of unit size: ten times Young's modulus of the soil.
const STIFFNESS: f64 = 1000.0;

fn rectangle(half: [f64; 2], spacing: f64) -> Surface<2> {
    let [x, y] = half;
    Surface::polygon(&[[-x, -y], [x, -y], [x, y], [-x, y]], 0.0, spacing).unwrap()
}

fn block(half: [f64; 3]) -> Surface<3> {
    Surface::cuboid(half, 0.0, 1.3).unwrap()
}

fn with_shear(shear: Shear) -> Interface {
    Interface {
        shear,
        tension: Tension::None,
    }
}

/// Interfaces by name, with whether their tangent is symmetric.
fn interfaces() -> Vec<(&'static str, Interface, bool)> {
    let limited = |adhesion: f64, friction| {
        let adhesion = vec![adhesion];
        with_shear(Shear::Limited {
            adhesion,
            varies: false,
            friction,
        })
    };
    vec![
        ("smooth", Interface::smooth(), true),
        ("rough", Interface::rough(), true),
        ("bonded", Interface::rough().bonded(), true),
        ("adhesion", limited(1.0, 0.0), true),
        ("friction", limited(0.5, 0.4), false),
        (
            "tension up to a limit",
            Interface {
                tension: Tension::Limit(2.0),
                ..Interface::rough()
            },
            true,
        ),
    ]
}

/// A body above the upper side of the particles of [`particles`], slightly turned, with a past at every
/// knot; and how all of its components are free.
fn above<const D: usize>(
    grid: &Grid<D>,
    surface: Surface<D>,
    interface: &Interface,
    depth: f64,
    random: &mut Random,
) -> (RigidBody<D>, RigidMotion<D>) {
    let axis = &grid.axes[D - 1];
    let top = axis.nodes()[axis.cell_count() - 1];
    let lower = surface.bounds().0[D - 1];
    let mut origin: [f64; D] = std::array::from_fn(|axis| {
        let nodes = grid.axes[axis].nodes();
        0.5 * (nodes[0] + nodes[nodes.len() - 1])
    });
    origin[D - 1] = top - lower - depth;
    let sides = vec![interface.clone(); surface.side_count()];
    let mut body = RigidBody::new(surface, sides, origin);
    let turn = if D == 2 {
        [0.02, 0.0, 0.0]
    } else {
        [0.02, 0.01, 0.3]
    };
    body.penalty.smoothing = 0.03;
    body.pose = body.pose.moved(&[0.0; D], &turn);
    for knot in &mut body.contact.knots {
        let second = if D == 3 {
            0.5 * random.symmetric()
        } else {
            0.0
        };
        // Pressure that goes with a gap about so wide: contact begins with the force of the step before.
        let gap = 0.1 * random.symmetric();
        let bonded = interface.tension != Tension::None;
        *knot = ContactNode {
            pressure: if bonded || gap < 0.0 {
                -gap * STIFFNESS
            } else {
                0.0
            },
            shear: [0.5 * random.symmetric(), second],
            area: 1.0,
            gap,
            is_closed: bonded || gap < 0.0,
            ..ContactNode::default()
        };
    }
    let mut rotation = [Drive::Moved(0.0); 3];
    for drive in rotation.iter_mut().take(D * (D - 1) / 2) {
        *drive = Drive::Loaded(0.1);
    }
    let motion = RigidMotion {
        displacement: [Drive::Loaded(-0.3); D],
        rotation,
        ..RigidMotion::held()
    };
    (body, motion)
}

fn conditions<const D: usize>(
    grid: &Grid<D>,
    law: &SharedLaw,
    motion: RigidMotion<D>,
) -> StepConditions<D> {
    StepConditions::new(
        grid.clone(),
        Constraints::free(grid),
        StepLoads::gravity([0.0; D]),
        vec![law.clone()],
    )
    .and_then(|conditions| conditions.with_motions(vec![motion]))
    .unwrap()
}

/// Nodal displacements at random, those of the two nodes of the body at the end.
fn moved<const D: usize>(grid: &Grid<D>, random: &mut Random) -> Vec<[f64; D]> {
    let mut u = displacements(grid, 0.02, random);
    let rotations = D * (D - 1) / 2;
    u.push(std::array::from_fn(|_| 0.01 * random.symmetric()));
    u.push(std::array::from_fn(|axis| {
        if axis < rotations {
            0.01 * random.symmetric()
        } else {
            0.0
        }
    }));
    u
}

/// All of the tangent, border included, by rows.
fn dense(matrix: &TangentMatrix) -> Vec<Vec<f64>> {
    let of_grid = matrix.pattern.unknowns();
    let border = &matrix.border;
    let all = of_grid + border.len();
    let mut rows = vec![vec![0.0; all]; all];
    for (row, column, value) in matrix.to_csc().triplet_iter() {
        rows[row][column] = *value;
    }
    for k in 0..border.len() {
        for unknown in 0..of_grid {
            rows[unknown][of_grid + k] = border.columns[k][unknown];
            rows[of_grid + k][unknown] = border.rows[k][unknown];
        }
        rows[of_grid + k][of_grid..].copy_from_slice(&border.corner[k]);
    }
    rows
}

/// Which kinds of contact a trial met: open, closing, closed, slipping.
#[derive(Default)]
struct Met {
    open: usize,
    closing: usize,
    closed: usize,
    slips: usize,
}

/// Largest difference between tangent and differences over some columns and all of those of the body, and the asymmetry, both
/// relative to the largest entry of these columns; in space, where moments are no derivatives of work, but for its rotations.
fn tangent_error<const D: usize>(
    grid: &Grid<D>,
    soil: &Particles<D>,
    (body, motion): (RigidBody<D>, RigidMotion<D>),
    u: &[[f64; D]],
    met: &mut Met,
    every: usize,
) -> (f64, f64) {
    let (_, law) = laws().remove(0);
    let method = Method::igimp_bbar();
    let conditions = conditions(grid, &law, motion);
    let stencils = Stencils::build(soil, &method, &conditions).unwrap();
    let bodies = [body];
    let system = System::with_structures(
        soil,
        &Structures {
            bodies: &bodies,
            ..Structures::default()
        },
        &stencils,
        &conditions,
        &method,
    )
    .unwrap();
    for knot in &system.bodies_at(u).unwrap().bodies[0].contact.knots {
        if knot.area > 0.0 {
            met.open += usize::from(knot.gap >= 0.0);
            met.closing += usize::from(knot.gap < 0.0 && knot.gap > -0.03);
            met.closed += usize::from(knot.gap <= -0.045);
            met.slips += usize::from(knot.slips);
        }
    }
    let (trial, matrix) = system.linearise(u, TangentKind::Consistent).unwrap();
    let alone = system.evaluate(u, TangentKind::Consistent).unwrap();
    assert_eq!(trial.f_int, alone.f_int, "with and without the tangent");
    let rows = dense(&matrix);
    let unknowns = system.unknowns();
    assert_eq!(rows.len(), unknowns.len());
    let (mut error, mut largest) = (0.0_f64, 0.0_f64);
    for column in 0..unknowns.len() {
        if column < unknowns.of_grid() && column % every != 0 {
            continue;
        }
        let (node, axis) = unknowns.place(column).unwrap();
        let d = 1e-6;
        let force = |sign: f64| {
            let mut u = u.to_vec();
            u[node][axis] += sign * d;
            system.evaluate(&u, TangentKind::Consistent).unwrap().f_int
        };
        let (plus, minus) = (force(1.0), force(-1.0));
        for (row, entries) in rows.iter().enumerate() {
            let (node, axis) = unknowns.place(row).unwrap();
            let difference = (plus[node][axis] - minus[node][axis]) / (2.0 * d);
            largest = largest.max(difference.abs());
            error = error.max((difference - entries[column]).abs());
        }
    }
    let is_rotation = |k: usize| unknowns.place(k).unwrap().0 > grid.node_count();
    let asymmetry = (0..rows.len())
        .filter(|&i| D == 2 || !is_rotation(i))
        .flat_map(|i| (0..i).map(move |j| (i, j)))
        .map(|(i, j)| (rows[i][j] - rows[j][i]).abs())
        .fold(0.0, f64::max);
    (error / largest, asymmetry / largest)
}

fn tangent_of<const D: usize>(surface: &Surface<D>, cells: usize, every: usize) {
    let grid = grid::<D>(cells);
    let mut random = Random(31);
    let soil = particles(&grid, 0.0, &mut random);
    for (name, interface, symmetric) in interfaces() {
        let mut met = Met::default();
        for depth in (0..16).map(|k| 0.005 * f64::from(k)) {
            let body = above(&grid, surface.clone(), &interface, depth, &mut random);
            let u = moved(&grid, &mut random);
            let (error, asymmetry) = tangent_error(&grid, &soil, body, &u, &mut met, every);
            assert!(error < 1e-7, "{name}, depth {depth}: {error:e}");
            assert!(
                !symmetric || asymmetry < 1e-12,
                "{name}: asymmetry {asymmetry:e}"
            );
        }
        let Met {
            open,
            closing,
            closed,
            slips,
        } = met;
        let is_bonded = name == "bonded";
        assert!(open > 0 && closed > 0, "{name}: {open} {closed}");
        assert!(is_bonded || closing > 0, "{name}: {closing}");
        let may_slip = name == "adhesion" || name == "friction";
        assert_eq!(slips > 0, may_slip, "{name}: {slips}");
    }
}

#[test]
fn tangent_in_the_plane() {
    let half_width = 0.5 * (grid::<2>(6).bounds().1[0] - 2.5);
    tangent_of(&rectangle([half_width, 1.0], 0.7), 6, 3);
    tangent_of(&Surface::circle(6.0, 0.6).unwrap(), 6, 3);
}

#[test]
fn tangent_in_space() {
    let half = 0.5 * (grid::<3>(4).bounds().1[0] - 2.5);
    tangent_of(&block([half, half, 1.0]), 4, 40);
    tangent_of(&Surface::sphere(5.0, 1.0).unwrap(), 4, 40);
}

/// Force and moment that contact alone makes at the nodes of the grid and at those of the body.
fn balance<const D: usize>(surface: &Surface<D>, cells: usize, depth: f64) {
    let grid = grid::<D>(cells);
    let mut random = Random(5);
    let soil = particles(&grid, 0.0, &mut random);
    let (_, law) = laws().remove(0);
    let method = Method::igimp_bbar();
    for (name, interface, _) in interfaces() {
        let (body, motion) = above(&grid, surface.clone(), &interface, depth, &mut random);
        let (size, origin) = (surface.size(), body.pose.origin);
        let conditions = conditions(&grid, &law, motion);
        let stencils = Stencils::build(&soil, &method, &conditions).unwrap();
        let mut u = moved(&grid, &mut random);
        // Where the body turns in the step its arms are those of the end, those of the soil of the start (theory, eq. 48a).
        u[grid.node_count() + 1] = [0.0; D];
        let force = |bodies: &[RigidBody<D>]| {
            System::with_structures(
                &soil,
                &Structures {
                    bodies,
                    ..Structures::default()
                },
                &stencils,
                &conditions,
                &method,
            )
            .and_then(|system| system.evaluate(&u, TangentKind::Consistent))
            .unwrap()
            .f_int
        };
        let (with, without) = (force(&[body]), force(&[]));
        let nodes = grid.node_count();
        let mut sum = with[nodes];
        let mut moment: [f64; 3] = std::array::from_fn(|k| {
            let m = if k < D { with[nodes + 1][k] } else { 0.0 };
            size * m
        });
        let mut scale = 0.0_f64;
        for node in 0..nodes {
            let x = grid.node_position(node);
            let f: [f64; D] = std::array::from_fn(|a| with[node][a] - without[node][a]);
            let (mut arm, mut push) = ([0.0; 3], [0.0; 3]);
            for axis in 0..D {
                sum[axis] += f[axis];
                scale += f[axis].abs();
                (arm[axis], push[axis]) = (x[axis] - origin[axis], f[axis]);
            }
            if D == 2 {
                moment[0] += arm[0] * push[1] - arm[1] * push[0];
            } else {
                for (k, moment) in moment.iter_mut().enumerate() {
                    let (a, b) = ((k + 1) % 3, (k + 2) % 3);
                    *moment += arm[a] * push[b] - arm[b] * push[a];
                }
            }
        }
        assert!(scale > 1.0, "{name}: nothing touches");
        for left in sum {
            assert!(left.abs() < 1e-12 * scale, "{name}: force {left:e}");
        }
        for left in moment {
            assert!(left.abs() < 1e-12 * scale * size, "{name}: moment {left:e}");
        }
    }
}

/// Contact takes from the body the force that it gives to the soil, moments included.
#[test]
fn action_is_reaction() {
    let half_width = 0.5 * (grid::<2>(6).bounds().1[0] - 2.5);
    balance(&rectangle([half_width, 1.0], 0.7), 6, 0.03);
    balance(&Surface::circle(6.0, 0.6).unwrap(), 6, 0.03);
    let half = 0.5 * (grid::<3>(4).bounds().1[0] - 2.5);
    balance(&block([half, half, 1.0]), 4, 0.03);
    balance(&Surface::sphere(5.0, 1.0).unwrap(), 4, 0.03);
    balance(&Surface::cylinder(0, 3.0, half, 0.3, 0.8).unwrap(), 4, 0.03);
    balance(
        &Surface::cone(2, [2.0, 0.5, 1.0], 0.0, 0.8).unwrap(),
        4,
        0.3,
    );
}

/// All numbers that contact has a part in, on so many threads.
fn bits<const D: usize>(threads: usize, cells: usize, surface: &Surface<D>) -> Vec<u64> {
    let grid = grid::<D>(cells);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.unwrap().install(|| {
        let mut random = Random(17);
        let soil = particles(&grid, 1.0, &mut random);
        let mut bits = Vec::new();
        for (_, interface, _) in interfaces() {
            let (body, motion) = above(&grid, surface.clone(), &interface, 0.1, &mut random);
            let bodies = [body];
            let (_, law) = laws().remove(2);
            let method = Method::shared_strain();
            let conditions = conditions(&grid, &law, motion);
            let stencils = Stencils::build(&soil, &method, &conditions).unwrap();
            let system = System::with_structures(
                &soil,
                &Structures {
                    bodies: &bodies,
                    ..Structures::default()
                },
                &stencils,
                &conditions,
                &method,
            )
            .unwrap();
            let u = moved(&grid, &mut random);
            let (trial, matrix) = system.linearise(&u, TangentKind::Consistent).unwrap();
            let border = &matrix.border;
            let values = trial.f_int.as_flattened().iter().chain(&matrix.values);
            let values = values.chain(border.columns.iter().flatten());
            let values = values.chain(border.rows.iter().flatten());
            let values = values.chain(border.corner.iter().flatten());
            bits.extend(values.map(|value| value.to_bits()));
            for knot in &system.bodies_at(&u).unwrap().bodies[0].contact.knots {
                let [first, second] = knot.shear;
                bits.extend([knot.pressure, first, second, knot.gap].map(f64::to_bits));
            }
        }
        bits
    })
}

#[test]
fn bits_are_equal_for_one_two_and_seven_threads() {
    let width = 0.5 * (grid::<2>(24).bounds().1[0] - 2.5);
    let plane = rectangle([width, 1.0], 2.0);
    let one = bits(1, 24, &plane);
    assert!(one.len() > 50_000);
    assert_eq!(one, bits(2, 24, &plane));
    assert_eq!(one, bits(7, 24, &plane));
    let space = Surface::cylinder(2, 2.0, 1.0, 0.2, 0.9).unwrap();
    let one = bits(1, 5, &space);
    assert!(one.len() > 50_000);
    assert_eq!(one, bits(2, 5, &space));
    assert_eq!(one, bits(7, 5, &space));
}

/// Turning there and back, about any axis, and turning in parts about one axis.
#[test]
fn poses_turn_rigidly() {
    let start = Pose::<3>::at([1.0, -2.0, 0.5]);
    let rotation = [0.4, -0.3, 0.8];
    let once = start.moved(&[0.0; 3], &rotation);
    let half = rotation.map(|angle| 0.5 * angle);
    let twice = start.moved(&[0.0; 3], &half).moved(&[0.0; 3], &half);
    let back = once.moved(&[0.0; 3], &rotation.map(|angle| -angle));
    let points = [[1.0, 0.0, 0.0], [0.2, -0.7, 1.5]];
    for x in points {
        for axis in 0..3 {
            assert!((once.into_space(&x)[axis] - twice.into_space(&x)[axis]).abs() < 1e-14);
            assert!((back.into_space(&x)[axis] - start.into_space(&x)[axis]).abs() < 1e-14);
            assert!((once.into_body(&once.into_space(&x))[axis] - x[axis]).abs() < 1e-14);
        }
    }
    let plane = Pose::<2>::at([0.0; 2]).moved(&[1.0, 0.0], &[FRAC_PI_4, 0.0, 0.0]);
    let [x, y] = plane.direction(&[1.0, 1.0]);
    assert!(x.abs() < 1e-15 && (y - 2.0_f64.sqrt()).abs() < 1e-15);
    assert!((plane.angle[0] - FRAC_PI_4).abs() < 1e-15);
}

/// State after a step with displacements `u` of contact between soil at rest and a body that is held, by knot.
fn left_of(
    (grid, soil): (&Grid<2>, &Particles<2>),
    body: &RigidBody<2>,
    u: &[[f64; 2]],
    geometry: Geometry,
) -> Vec<ContactNode> {
    let (_, law) = laws().remove(0);
    let method = Method {
        geometry,
        ..Method::igimp_bbar()
    };
    let conditions = conditions(grid, &law, RigidMotion::held());
    let stencils = Stencils::build(soil, &method, &conditions).unwrap();
    let bodies = std::slice::from_ref(body);
    let system = System::with_structures(
        soil,
        &Structures {
            bodies,
            ..Structures::default()
        },
        &stencils,
        &conditions,
        &method,
    )
    .unwrap();
    let moved = system.bodies_at(u).unwrap();
    moved.bodies[0].contact.knots.clone()
}

/// A wide plate, parallel to the upper side of the soil and off it by a gap \[length\]; soil and grid.
fn plate(interface: &Interface, gap: f64) -> (Grid<2>, Particles<2>, RigidBody<2>) {
    let grid = grid::<2>(6);
    let soil = particles(&grid, 0.0, &mut Random(3));
    let nodes = grid.axes[1].nodes();
    let top = nodes[nodes.len() - 2];
    let surface = rectangle([6.0, 1.0], 0.7);
    let sides = vec![interface.clone(); surface.side_count()];
    let middle = 0.5 * grid.bounds().1[0];
    let body = RigidBody::new(surface, sides, [middle, top + 1.0 + gap]);
    (grid, soil, body)
}

/// Displacements of all nodes of a grid alike, and none of the body.
fn all_by(grid: &Grid<2>, by: [f64; 2]) -> Vec<[f64; 2]> {
    let mut u = vec![by; grid.node_count()];
    u.extend([[0.0; 2]; 2]);
    u
}

// GOAL: a body goes and turns as its two nodes say.
// CASE: a plate, its rotation stored times its size.
// ORACLE: the angle and the way themselves.
#[test]
fn a_body_turns_by_its_rotation() {
    let (grid, soil, body) = plate(&Interface::smooth(), 3.0);
    let (_, law) = laws().remove(0);
    let method = Method::igimp_bbar();
    let conditions = conditions(&grid, &law, RigidMotion::held());
    let stencils = Stencils::build(&soil, &method, &conditions).unwrap();
    let structures = Structures {
        bodies: std::slice::from_ref(&body),
        ..Structures::default()
    };
    let system = System::with_structures(&soil, &structures, &stencils, &conditions, &method);
    let mut u = vec![[0.0; 2]; grid.node_count()];
    u.extend([[0.3, -0.2], [0.01 * body.surface.size(), 0.0]]);
    let moved = system.unwrap().bodies_at(&u).unwrap().bodies.remove(0);
    assert!((moved.pose.angle[0] - 0.01).abs() < 1e-15);
    for (axis, way) in [0.3, -0.2].into_iter().enumerate() {
        assert!((moved.pose.origin[axis] - body.pose.origin[axis] - way).abs() < 1e-14);
    }
}

// GOAL: soil that left a rough side takes no shear along.
// CASE: a rough plate that carried shear, and soil that goes down from it.
// ORACLE: no traction across a gap.
#[test]
fn a_knot_that_let_go_keeps_no_shear() {
    let (grid, soil, mut body) = plate(&Interface::rough(), 0.0);
    for knot in &mut body.contact.knots {
        *knot = ContactNode {
            pressure: 0.1,
            shear: [0.5, 0.0],
            area: 1.0,
            is_closed: true,
            ..ContactNode::default()
        };
    }
    let stays = left_of(
        (&grid, &soil),
        &body,
        &all_by(&grid, [0.0; 2]),
        Geometry::Moving,
    );
    assert!(
        stays
            .iter()
            .any(|knot| knot.is_closed && knot.shear[0] > 0.1)
    );
    let left = left_of(
        (&grid, &soil),
        &body,
        &all_by(&grid, [0.0, -0.1]),
        Geometry::Moving,
    );
    for knot in left {
        assert!(!knot.is_closed && knot.gap >= 0.0, "{knot:?}");
        assert!(knot.shear[0].abs() < 1e-15, "{knot:?}");
    }
}

// GOAL: a bond that broke is broken for good: where soil touches, where none is near, and where it breaks in this step.
// CASE: a plate whose bonds are broken at some knots, with soil at it, far off, and torn away.
// ORACLE: a crack does not heal.
#[test]
fn broken_bonds_do_not_heal() {
    let interface = Interface {
        tension: Tension::Limit(2.0),
        ..Interface::rough()
    };
    for gap in [0.0, 3.0] {
        let (grid, soil, mut body) = plate(&interface, gap);
        for knot in body.contact.knots.iter_mut().step_by(2) {
            knot.is_broken = true;
        }
        let left = left_of(
            (&grid, &soil),
            &body,
            &all_by(&grid, [0.0; 2]),
            Geometry::Moving,
        );
        for (knot, before) in left.iter().zip(&body.contact.knots) {
            assert_eq!(knot.is_broken, before.is_broken, "{gap}: {knot:?}");
        }
    }
    let (grid, soil, body) = plate(&interface, 0.0);
    let mut torn = body;
    torn.contact.knots = left_of(
        (&grid, &soil),
        &torn,
        &all_by(&grid, [0.0, -1e-4]),
        Geometry::Moving,
    );
    assert!(
        !torn.contact.knots.iter().any(|knot| knot.is_broken),
        "held"
    );
    torn.contact.knots = left_of(
        (&grid, &soil),
        &torn,
        &all_by(&grid, [0.0, -0.1]),
        Geometry::Moving,
    );
    let touched = torn.contact.knots.iter().filter(|knot| knot.area > 0.0);
    assert!(touched.clone().count() > 2);
    assert!(touched.clone().all(|knot| knot.is_broken), "torn");
}

// GOAL: soil that comes near a knot later is as far off as it stands, whatever came near before.
// CASE: knots that a little soil had come near, closer than what is there now.
// ORACLE: the distance between a plate and a level surface.
#[test]
fn soil_that_comes_near_later_is_as_far_off_as_it_stands() {
    let (grid, soil, mut body) = plate(&Interface::smooth(), 0.06);
    let fresh = left_of(
        (&grid, &soil),
        &body,
        &all_by(&grid, [0.0; 2]),
        Geometry::Moving,
    );
    for knot in &mut body.contact.knots {
        (knot.area, knot.gap) = (1e-3, 0.01);
    }
    let later = left_of(
        (&grid, &soil),
        &body,
        &all_by(&grid, [0.0; 2]),
        Geometry::Moving,
    );
    let near = std::iter::zip(&fresh, &later).filter(|(knot, _)| knot.area > 1e-2);
    assert!(near.clone().count() > 2);
    for (fresh, later) in near {
        assert!((fresh.gap - 0.06).abs() < 1e-12, "{fresh:?}");
        assert!((later.gap - 0.06).abs() < 1e-12, "{later:?}");
    }
}

// GOAL: a body lies on soil without a gap where a force pushes it or the step says so, and in statics alone.
// CASE: a plate at no gap and at a small one, and nothing that moves.
// ORACLE: pressure needs no motion where a body is laid, and there is none elsewhere.
#[test]
fn bodies_are_laid_on_soil_in_statics() {
    let pushed = RigidMotion {
        displacement: [Drive::Moved(0.0), Drive::Loaded(-1.0)],
        ..RigidMotion::held()
    };
    let in_time = TimeStep {
        duration: 0.1,
        scheme: TimeScheme::Newmark,
        lumped: 0.0,
        is_first: true,
        must_resolve: false,
    };
    let (_, law) = laws().remove(0);
    let method = Method::igimp_bbar();
    for (gap, motion, says_so, time, presses) in [
        (0.0, RigidMotion::held(), false, None, false),
        (0.0, RigidMotion::held(), true, None, true),
        (0.0, pushed.clone(), false, None, true),
        (0.0, pushed.clone(), true, Some(in_time), false),
        (0.01, pushed.clone(), true, None, false),
    ] {
        let (grid, soil, mut body) = plate(&Interface::smooth(), gap);
        body.motion.mass = 1.0;
        let mut conditions = conditions(&grid, &law, motion).with_time(time).unwrap();
        if says_so {
            conditions = conditions.with_bodies_laid();
        }
        let stencils = Stencils::build(&soil, &method, &conditions).unwrap();
        let structures = Structures {
            bodies: std::slice::from_ref(&body),
            ..Structures::default()
        };
        let system = System::with_structures(&soil, &structures, &stencils, &conditions, &method)
            .and_then(System::in_motion)
            .unwrap();
        let moved = system.bodies_at(&all_by(&grid, [0.0; 2])).unwrap();
        let knots = &moved.bodies[0].contact.knots;
        let near = knots.iter().filter(|knot| knot.area > 1e-2);
        assert!(near.clone().count() > 2);
        for knot in near {
            assert_eq!(knot.pressure > 0.0, presses, "{gap} {says_so} {time:?}");
        }
    }
}

// GOAL: on a given geometry soil that a grid cannot tell from soil at a body touches it, as particles that the ground cuts stand off it.
// CASE: a plate 0.06 and 0.3 off the soil, on cells of 1 to 1.2.
// ORACLE: a tenth of a cell; where the geometry moves a gap is a gap.
#[test]
fn soil_as_drawn_touches_within_a_tenth_of_a_cell() {
    for (gap, geometry, touches) in [
        (0.06, Geometry::Given, true),
        (0.06, Geometry::Moving, false),
        (0.3, Geometry::Given, false),
    ] {
        let (grid, soil, body) = plate(&Interface::smooth(), gap);
        let knots = left_of((&grid, &soil), &body, &all_by(&grid, [0.0; 2]), geometry);
        let near = knots.iter().filter(|knot| knot.area > 1e-2);
        assert!(near.clone().count() > 2);
        for knot in near {
            let expected = if touches { 0.0 } else { gap };
            assert!((knot.gap - expected).abs() < 1e-12, "{knot:?}");
        }
        // Soil that is pushed against it presses at once.
        let pushed = all_by(&grid, [0.0, 0.02]);
        let knots = left_of((&grid, &soil), &body, &pushed, geometry);
        assert_eq!(knots.iter().any(|knot| knot.pressure > 0.0), touches);
    }
}
