//! Koiter's flow rule, checked against planes and cones written out anew.

use igimp_material::{History, PointContext, Principal, Regime};

use crate::catalogue::{Planes, all};
use crate::random::Random;
use crate::returns::{dot, size};

/// GOAL: plastic strain is a sum of the flow directions of the active planes with multipliers
/// that are not negative (Koiter), associated or not. Exempt by definition: the apex without
/// dilation, which no flow reaches; there the trial mean stress is above the apex.
#[test]
fn plastic_strain_obeys_the_flow_rule() {
    for entry in all() {
        let Some(planes) = entry.planes else { continue };
        let elasticity = entry.law.stiffness_bound();
        let mut random = Random(6);
        for _ in 0..10_000 {
            let strain = entry.any(&mut random);
            let answer = entry
                .law
                .return_map(&strain, &History::default(), &PointContext::STATIC)
                .unwrap();
            if !answer.regime.is_plastic() {
                continue;
            }
            if answer.regime == Regime::Apex && planes.dilation == 0.0 {
                let mean_stress = elasticity.stress(&strain).iter().sum::<f64>() / 3.0;
                let apex = planes.cohesion / planes.friction.tan();
                assert!(mean_stress >= apex, "{}: {strain:?}", entry.label);
                continue;
            }
            let near = 1e-11 * entry.law.stress_scale(&answer.tau);
            let flows = active_flows(&planes, &answer.tau, near);
            let norm = size(&answer.delta_eps_p);
            let noise = 1e-13 * size(&strain) / norm * elasticity.bulk() / elasticity.shear();
            let direction = answer.delta_eps_p.map(|value| value / norm);
            let miss = distance_to_cone(&direction, &flows);
            assert!(
                miss <= 1e-10 + noise,
                "{}: {strain:?} {answer:?} {miss:e}",
                entry.label
            );
        }
    }
}

/// Flow directions of all planes, of any order of stresses, that a stress lies on.
fn active_flows(planes: &Planes, tau: &Principal, near: f64) -> Vec<Principal> {
    let (friction, dilation) = (planes.friction.sin(), planes.dilation.sin());
    let mut flows = Vec::new();
    for i in 0..3 {
        for j in 0..3 {
            let mut flow = [0.0; 3];
            if i != j {
                let f = (1.0 + friction) * tau[i]
                    - (1.0 - friction) * tau[j]
                    - 2.0 * planes.cohesion * planes.friction.cos();
                flow[i] = 1.0 + dilation;
                flow[j] = dilation - 1.0;
                if f.abs() <= near {
                    flows.push(flow);
                }
            } else if planes
                .cutoff
                .is_some_and(|cutoff| (tau[i] - cutoff).abs() <= near)
            {
                flow[i] = 1.0;
                flows.push(flow);
            }
        }
    }
    flows
}

/// Distance of a direction from the cone of some rays in space: the least over all simplices of
/// at most three rays (Carathéodory) that hold the projection.
fn distance_to_cone(direction: &Principal, rays: &[Principal]) -> f64 {
    let mut least = f64::INFINITY;
    for (i, p) in rays.iter().enumerate() {
        let share = (dot(p, direction) / dot(p, p)).max(0.0);
        let rest: Principal = std::array::from_fn(|a| direction[a] - share * p[a]);
        least = least.min(size(&rest));
        for (j, q) in rays.iter().enumerate().skip(i + 1) {
            let normal = cross(p, q);
            let square = dot(&normal, &normal);
            if square < 1e-12 {
                continue;
            }
            let shares = [
                dot(&cross(direction, q), &normal),
                dot(&cross(p, direction), &normal),
            ];
            if shares.iter().all(|share| *share >= -1e-9 * square) {
                least = least.min(dot(&normal, direction).abs() / square.sqrt());
            }
            for r in rays.iter().skip(j + 1) {
                let volume = dot(&normal, r);
                let inside = |x: f64| x / volume >= -1e-9;
                if volume.abs() > 1e-9
                    && inside(dot(&cross(q, r), direction))
                    && inside(dot(&cross(r, p), direction))
                    && inside(dot(&normal, direction))
                {
                    return 0.0;
                }
            }
        }
    }
    least
}

fn cross(a: &Principal, b: &Principal) -> Principal {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
