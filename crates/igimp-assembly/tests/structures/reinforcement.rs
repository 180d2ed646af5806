//! GOAL: members of reinforcement pull as bars do whose strain is that of the soil, and their tangent is
//! the derivative of their force.
//! ORACLE: a uniform stretch; central differences; balance of force and moment.

use crate::common::{Random, conditions, displacements, grid, laws, particles};
use igimp_assembly::{
    AssemblyError, Geometry, Hold, Kinematics, Method, Reinforcement, ReinforcementControl, Remedy,
    Segment, SegmentState, SmallCuts, Station, Stencils, StepConditions, Structures, System,
};
use igimp_material::TangentKind;
use igimp_shape::Grid;

/// Axial stiffness.
const STIFFNESS: f64 = 40.0;
/// Tension at most.
const TENSILE: f64 = 2.0;

/// A member along a straight line through the body, its first station beneath a plate of two points.
fn member<const D: usize>(from: [f64; D], to: [f64; D], count: usize) -> Reinforcement<D> {
    let at = |t: f64| std::array::from_fn(|axis| from[axis] + t * (to[axis] - from[axis]));
    let length = (0..D)
        .map(|a| (to[a] - from[a]).powi(2))
        .sum::<f64>()
        .sqrt();
    let mut stations: Vec<Station<D>> = (0..=count)
        .map(|k| Station {
            points: vec![at(k as f64 / count as f64)],
        })
        .collect();
    let head = stations[0].points[0];
    stations[0].points = [-0.2, 0.2]
        .map(|by| std::array::from_fn(|a| head[a] + if a == D - 1 { by } else { 0.0 }))
        .to_vec();
    let hold = Hold {
        fastened: 1e3,
        bonded: 0.0,
    };
    Reinforcement {
        name: "member".to_owned(),
        stiffness: STIFFNESS,
        stations,
        segments: vec![
            Segment {
                length: length / count as f64,
                tensile: TENSILE,
                held: [hold; 2],
                state: SegmentState::default(),
            };
            count
        ],
    }
}

/// A body on a grid, its conditions, and a member through it.
struct Scene<const D: usize> {
    grid: Grid<D>,
    conditions: StepConditions<D>,
    body: igimp_assembly::Particles<D>,
    member: Reinforcement<D>,
}

fn scene<const D: usize>() -> Scene<D> {
    let grid = grid::<D>(6);
    let (_, law) = laws().remove(0);
    let body = particles(&grid, 1.0, &mut Random(5));
    let from = std::array::from_fn(|axis| 1.6 + 0.2 * axis as f64);
    let to = std::array::from_fn(|axis| 4.4 - 0.7 * axis as f64);
    Scene {
        conditions: conditions(&grid, &law),
        body,
        member: member(from, to, 9),
        grid,
    }
}

/// Force of the member alone by node, and the tangent of all as columns of differences against what the
/// system says.
fn error_of_tangent<const D: usize>(
    scene: &Scene<D>,
    member: &Reinforcement<D>,
    method: &Method,
    u: &[[f64; D]],
) -> f64 {
    let stencils = Stencils::build(&scene.body, method, &scene.conditions).unwrap();
    let members = [member.clone()];
    let system = System::with_structures(
        &scene.body,
        &Structures {
            members: &members,
            ..Structures::default()
        },
        &stencils,
        &scene.conditions,
        method,
    )
    .unwrap();
    let (trial, matrix) = system.linearise(u, TangentKind::Consistent).unwrap();
    let largest = trial
        .f_int
        .as_flattened()
        .iter()
        .fold(0.0, |m: f64, f| m.max(f.abs()));
    let unknowns = system.unknowns();
    let mut random = Random(3);
    let direction: Vec<f64> = (0..unknowns.len()).map(|_| random.symmetric()).collect();
    let moved = |sign: f64| {
        let mut u = u.to_vec();
        let du: Vec<f64> = direction.iter().map(|d| sign * 1e-6 * d).collect();
        system.add_correction(&mut u, &du);
        system.evaluate(&u, TangentKind::Consistent).unwrap().f_int
    };
    let (after, before) = (moved(1.0), moved(-1.0));
    let mut product = vec![0.0; unknowns.len()];
    matrix.multiply(&direction, &mut product);
    let mut error = 0.0_f64;
    for unknown in 0..unknowns.len() {
        let (node, axis) = unknowns.place(unknown).unwrap();
        let slope = (after[node][axis] - before[node][axis]) / 2e-6;
        error = error.max((slope - product[unknown]).abs() / largest);
    }
    error
}

/// The member at the end of a step.
fn accepted<const D: usize>(
    scene: &Scene<D>,
    member: &Reinforcement<D>,
    method: &Method,
    control: Option<ReinforcementControl>,
    u: &[[f64; D]],
) -> (Reinforcement<D>, Vec<[f64; D]>) {
    let conditions = scene.conditions.clone();
    let conditions = conditions
        .with_reinforcement(control.into_iter().collect())
        .unwrap();
    let stencils = Stencils::build(&scene.body, method, &conditions).unwrap();
    let members = [member.clone()];
    let force = |members: &[Reinforcement<D>]| {
        let structures = Structures {
            members,
            ..Structures::default()
        };
        let system =
            System::with_structures(&scene.body, &structures, &stencils, &conditions, method);
        let system = system.unwrap();
        let trial = system.evaluate(u, TangentKind::Consistent).unwrap();
        (system.reinforcement_at(u), trial.f_int)
    };
    let (mut after, with) = force(&members);
    let (_, without) = force(&[]);
    let force = std::iter::zip(with, without)
        .map(|(a, b)| std::array::from_fn(|axis| a[axis] - b[axis]))
        .collect();
    (after.remove(0), force)
}

fn methods() -> [Method; 3] {
    [
        Method::igimp_bbar(),
        Method {
            kinematics: Kinematics::SmallStrain,
            ..Method::igimp_bbar()
        },
        Method {
            geometry: Geometry::Given,
            ..Method::shared_strain()
        },
    ]
}

/// Displacements that stretch space evenly along axis 0.
fn stretched<const D: usize>(grid: &Grid<D>, strain: f64) -> Vec<[f64; D]> {
    (0..grid.node_count())
        .map(|node| {
            let mut u = [0.0; D];
            u[0] = strain * grid.node_position(node)[0];
            u
        })
        .collect()
}

#[test]
fn the_tangent_is_the_derivative_of_the_force() {
    let scene = scene::<2>();
    for method in methods() {
        // Elastic, yielding and slack bars, and some of each.
        for (strain, size) in [(0.02, 1e-3), (0.2, 1e-3), (-0.1, 1e-3), (0.03, 0.03)] {
            let mut u = stretched(&scene.grid, strain);
            let more = displacements(&scene.grid, size, &mut Random(9));
            for (u, more) in u.iter_mut().zip(more) {
                for axis in 0..2 {
                    u[axis] += more[axis];
                }
            }
            let error = error_of_tangent(&scene, &scene.member, &method, &u);
            assert!(error < 1e-6, "{}, {strain}: {error:e}", method.label());
        }
    }
    let scene = self::scene::<3>();
    let u = stretched(&scene.grid, 0.03);
    let error = error_of_tangent(&scene, &scene.member, &Method::igimp_bbar(), &u);
    assert!(error < 1e-6, "3D: {error:e}");
}

#[test]
fn a_uniform_stretch_gives_the_force_of_a_bar() {
    let scene = scene::<2>();
    for (number, method) in methods().into_iter().enumerate() {
        for strain in [0.01, 0.03, 0.2, -0.05] {
            let u = stretched(&scene.grid, strain);
            let mut straight = scene.member.clone();
            straight.stations[0].points = vec![straight.stations[0].position()];
            let (after, force) = accepted(&scene, &straight, &method, None, &u);
            let to = straight.stations[9].points[0];
            let from = straight.stations[0].points[0];
            let d = [to[0] - from[0], to[1] - from[1]];
            let length = d[0].hypot(d[1]);
            let along = if number == 0 {
                (d[0] * (1.0 + strain)).hypot(d[1]) / length - 1.0
            } else {
                strain * (d[0] / length).powi(2)
            };
            let expected = (STIFFNESS * along).clamp(0.0, TENSILE);
            for bar in &after.segments {
                assert!((bar.state.force - expected).abs() < 1e-12, "{along}");
                assert!((bar.state.strain - along).abs() < 1e-14);
                assert_eq!(bar.state.is_at_limit, expected == TENSILE);
            }
            // Its points go with the soil, and stay on a given geometry.
            let goes = if method.geometry == Geometry::Given {
                0.0
            } else {
                strain
            };
            for (now, then) in std::iter::zip(&after.stations, &straight.stations) {
                let [x, y] = then.points[0];
                let [to_x, to_y] = now.points[0];
                assert!((to_x - x * (1.0 + goes)).abs() < 1e-12 && (to_y - y).abs() < 1e-12);
            }
            // Within the body the forces of neighbouring bars cancel.
            let sum: Vec<f64> = (0..2).map(|a| force.iter().map(|f| f[a]).sum()).collect();
            assert!(sum.iter().all(|sum: &f64| sum.abs() < 1e-12), "{sum:?}");
        }
    }
}

// GOAL: the work of a member is that of its tension, and what is elastic of it is told apart.
// CASE: a straight member in a uniform stretch, before it yields and beyond.
// ORACLE: F L ε of the step, and F L F/EA.
#[test]
fn work_is_that_of_the_tension() {
    let scene = scene::<2>();
    let method = Method {
        geometry: Geometry::Given,
        ..Method::igimp_bbar()
    };
    let mut member = scene.member.clone();
    member.stations[0].points = vec![member.stations[0].position()];
    let (from, to) = (member.stations[0].position(), member.stations[9].position());
    let d = [to[0] - from[0], to[1] - from[1]];
    let length = d[0].hypot(d[1]);
    for strain in [0.02, 0.2] {
        let u = stretched(&scene.grid, strain);
        let stencils = Stencils::build(&scene.body, &method, &scene.conditions).unwrap();
        let work = |members: &[Reinforcement<2>]| {
            let structures = Structures {
                members,
                ..Structures::default()
            };
            let conditions = &scene.conditions;
            let system =
                System::with_structures(&scene.body, &structures, &stencils, conditions, &method);
            let system = system.unwrap();
            let trial = system.evaluate(&u, TangentKind::Consistent).unwrap();
            system.work(&trial, &u).unwrap()
        };
        let (with, without) = (work(std::slice::from_ref(&member)), work(&[]));
        let along = strain * (d[0] / length).powi(2);
        let force = (STIFFNESS * along).min(TENSILE);
        let expected = [force * length * along, force * length * force / STIFFNESS];
        let found = [with.whole - without.whole, with.elastic - without.elastic];
        for (found, expected) in std::iter::zip(found, expected) {
            assert!((found - expected).abs() < 1e-11, "{found} {expected}");
        }
        let lost = expected[0] - expected[1];
        assert!((with.in_reinforcement - lost).abs() < 1e-12, "{lost}");
    }
}

#[test]
fn a_yielded_bar_is_longer_and_takes_tension_when_it_is_straight_again() {
    let scene = scene::<2>();
    let method = Method {
        geometry: Geometry::Given,
        ..Method::igimp_bbar()
    };
    let mut member = scene.member.clone();
    member.stations[0].points = vec![member.stations[0].position()];
    let cos2 = {
        let (a, b) = (member.stations[0].position(), member.stations[9].position());
        let d = [b[0] - a[0], b[1] - a[1]];
        d[0] * d[0] / (d[0] * d[0] + d[1] * d[1])
    };
    let yields = TENSILE / STIFFNESS;
    // Strains of the steps along the bar, and its tension after each.
    for (by, force) in [
        (2.0 * yields, TENSILE),
        (-0.5 * yields, 0.5 * TENSILE),
        (-2.0 * yields, 0.0),
        (1.0 * yields, 0.0),
        (0.75 * yields, 0.25 * TENSILE),
    ] {
        let u = stretched(&scene.grid, by / cos2);
        member = accepted(&scene, &member, &method, None, &u).0;
        let found = member.segments[4].state.force;
        assert!((found - force).abs() < 1e-12, "{found} for {force}");
    }
}

#[test]
fn forces_balance_in_force_and_moment_where_the_step_ends() {
    let scene = scene::<2>();
    let u = displacements(&scene.grid, 0.03, &mut Random(2));
    let (after, force) = accepted(&scene, &scene.member, &Method::igimp_bbar(), None, &u);
    assert!(after.largest_force() > 0.0);
    let mut sums = [0.0; 3];
    // Shares keep place and motion, so moments are those of the bars where they end up.
    for (node, f) in force.iter().enumerate() {
        let x = scene.grid.node_position(node);
        let x = [x[0] + u[node][0], x[1] + u[node][1]];
        sums[0] += f[0];
        sums[1] += f[1];
        sums[2] += x[0] * f[1] - x[1] * f[0];
    }
    assert!(sums.iter().all(|sum: &f64| sum.abs() < 1e-11), "{sums:?}");
}

// GOAL: a member that ends beside nodes without unknowns hands all of its force on to nodes that have some.
// ORACLE: what its two ends pull is equal and opposite.
#[test]
fn forces_balance_beside_dropped_nodes() {
    let scene = scene::<2>();
    let method = Method {
        small_cuts: SmallCuts {
            below: 0.7,
            remedy: Remedy::Drop,
            ..SmallCuts::default()
        },
        ..Method::igimp_bbar()
    };
    let member = member([1.3, 2.6], [4.4, 2.9], 9);
    let stencils = Stencils::build(&scene.body, &method, &scene.conditions).unwrap();
    let system = System::new(&scene.body, &stencils, &scene.conditions, &method).unwrap();
    let node = scene.grid.node_index([1, 2]);
    assert!(stencils.node_volume(node) > 0.0 && !system.unknowns().is_active(node));
    let u = stretched(&scene.grid, 0.01);
    let (after, force) = accepted(&scene, &member, &method, None, &u);
    assert!(after.largest_force() > 0.0);
    let mut sums = [0.0; 3];
    for (node, f) in force.iter().enumerate() {
        let x = scene.grid.node_position(node);
        sums[0] += f[0];
        sums[1] += f[1];
        assert!(f[0] == 0.0 || system.unknowns().is_active(node), "{x:?}");
    }
    assert!(sums.iter().all(|sum: &f64| sum.abs() < 1e-12), "{sums:?}");
}

#[test]
fn a_jack_holds_its_force_and_leaves_it_locked_off() {
    let scene = scene::<2>();
    let jack = ReinforcementControl {
        jack: Some(1.25),
        ..ReinforcementControl::default()
    };
    for method in methods() {
        let u = displacements(&scene.grid, 0.02, &mut Random(4));
        let (locked, _) = accepted(&scene, &scene.member, &method, Some(jack), &u);
        assert!(
            locked
                .segments
                .iter()
                .all(|bar| (bar.state.force - 1.25).abs() < 1e-13)
        );
        let still = vec![[0.0; 2]; scene.grid.node_count()];
        let (later, _) = accepted(&scene, &locked, &method, None, &still);
        assert!(
            later
                .segments
                .iter()
                .all(|bar| (bar.state.force - 1.25).abs() < 1e-13)
        );
    }
}

#[test]
fn bond_that_is_reduced_limits_the_force() {
    let scene = scene::<2>();
    let mut member = scene.member.clone();
    for (k, bar) in member.segments.iter_mut().enumerate() {
        bar.held = [k, 8 - k].map(|bars| Hold {
            fastened: 0.1,
            bonded: 0.3 * (bars as f64 + 0.5),
        });
    }
    let u = stretched(&scene.grid, 1.0);
    for reduction in [1.0, 1.5] {
        let control = ReinforcementControl {
            reduction,
            jack: None,
        };
        let method = Method::igimp_bbar();
        let (after, _) = accepted(&scene, &member, &method, Some(control), &u);
        for (k, bar) in after.segments.iter().enumerate() {
            let bars = k.min(8 - k) as f64 + 0.5;
            let limit = (0.1 + 0.3 * bars / reduction).min(TENSILE);
            assert!((bar.state.force - limit).abs() < 1e-13, "{k}");
        }
    }
}

#[test]
fn members_without_soil_are_named() {
    let scene = scene::<2>();
    let method = Method::igimp_bbar();
    let stencils = Stencils::build(&scene.body, &method, &scene.conditions).unwrap();
    let error = |member: &Reinforcement<2>| {
        let members = [member.clone()];
        let structures = Structures {
            members: &members,
            ..Structures::default()
        };
        let conditions = &scene.conditions;
        let system =
            System::with_structures(&scene.body, &structures, &stencils, conditions, &method);
        system.map(|_| ()).unwrap_err()
    };
    let mut away = scene.member.clone();
    away.stations[9].points[0] = [-3.0, 2.0];
    let printed = error(&away).to_string();
    assert_eq!(
        printed,
        "no soil carries the reinforcement \"member\" at [-3.0, 2.0, 0.0] m"
    );
    let mut broken = scene.member.clone();
    broken.segments[2].state.strain = f64::NAN;
    let quantity = "reinforcement";
    assert_eq!(
        error(&broken),
        AssemblyError::NonFinite { quantity, index: 0 }
    );
    let jack = ReinforcementControl {
        jack: Some(-1.0),
        ..ReinforcementControl::default()
    };
    let refused = scene.conditions.clone().with_reinforcement(vec![jack]);
    assert!(refused.is_err());
}

// GOAL: a member that soil has left is not held up by nodes that reach past the surface.
// CASE: the end of a member above the body, whose domains reach to a height that their places tell.
// ORACLE: half a cell from the nearest domain, less and more by a hundredth of it.
#[test]
fn soil_that_is_not_near_carries_nothing() {
    let scene = scene::<2>();
    let method = Method::igimp_bbar();
    let stencils = Stencils::build(&scene.body, &method, &scene.conditions).unwrap();
    let column = 3.0;
    let tops = std::iter::zip(&scene.body.x, &scene.body.half_length);
    let above = tops.filter(|(x, half)| (x[0] - column).abs() <= half[0] + 0.5);
    let top = above.fold(0.0, |top: f64, (x, half)| top.max(x[1] + half[1]));
    let cell = scene.grid.cell_at(&[column, top]).unwrap();
    for (height, is_carried) in [(0.1, true), (0.49, true), (0.51, false), (0.9, false)] {
        let mut member = scene.member.clone();
        member.stations[9].points[0] = [column, top + height * scene.grid.cell_size(cell)[1]];
        let members = [member];
        let structures = Structures {
            members: &members,
            ..Structures::default()
        };
        let conditions = &scene.conditions;
        let system =
            System::with_structures(&scene.body, &structures, &stencils, conditions, &method);
        let is_refused = matches!(system, Err(AssemblyError::UnsupportedReinforcement { .. }));
        assert_eq!(is_refused, !is_carried, "{height}");
    }
}

// GOAL: a station beneath a plate moves as the mean of its points, and its force spreads over them.
// CASE: a member with a head of two points, and the same with four, in a body that all moves, and that stretches.
// ORACLE: a rigid translation strains nothing; the forces of a member sum to nothing; the strain of a uniform stretch.
#[test]
fn points_beneath_a_plate_share_the_force_of_one() {
    fn compare<const D: usize>() {
        let mut scene = scene::<D>();
        for twice in [false, true] {
            if twice {
                let points = &mut scene.member.stations[0].points;
                points.extend(points.clone());
            }
            let nodes = scene.grid.node_count();
            let moved = vec![[0.05; D]; nodes];
            let method = Method {
                kinematics: Kinematics::SmallStrain,
                ..Method::igimp()
            };
            let (still, _) = accepted(&scene, &scene.member, &method, None, &moved);
            for segment in &still.segments {
                assert!(segment.state.strain.abs() < 1e-13, "{segment:?}");
            }
            let stretched: Vec<[f64; D]> = (0..nodes)
                .map(|node| scene.grid.node_position(node).map(|x| 0.01 * x))
                .collect();
            let (pulled, force) = accepted(&scene, &scene.member, &method, None, &stretched);
            for segment in &pulled.segments {
                assert!((segment.state.strain - 0.01).abs() < 1e-12, "{segment:?}");
                assert!((segment.state.force - 0.01 * STIFFNESS).abs() < 1e-10);
            }
            for axis in 0..D {
                let sum: f64 = force.iter().map(|force| force[axis]).sum();
                assert!(sum.abs() < 1e-12, "{sum:e}");
            }
        }
    }
    compare::<2>();
    compare::<3>();
}
