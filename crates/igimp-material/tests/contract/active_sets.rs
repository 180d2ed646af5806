//! Returns to planes held against an independent method: every set of up to three planes is tried,
//! and the one whose multipliers are not negative and whose stress is admissible is the answer.

use igimp_material::{
    ConstitutiveModel, Elasticity, History, MohrCoulomb, PointContext, Principal,
};

use crate::random::Random;
use crate::returns::dot;

/// A plane with its flow, in the full principal space.
#[derive(Clone, Copy)]
struct Plane {
    normal: Principal,
    flow: Principal,
    strength: f64,
}

/// All planes of Mohr–Coulomb with a cut-off: six of shear, three of tension.
fn planes(cohesion: f64, friction: f64, dilation: f64, cutoff: f64) -> Vec<Plane> {
    let mut planes = Vec::new();
    for major in 0..3 {
        for minor in (0..3).filter(|&minor| minor != major) {
            let direction = |angle: f64| {
                let mut direction = [0.0; 3];
                direction[major] = 1.0 + angle.sin();
                direction[minor] = angle.sin() - 1.0;
                direction
            };
            planes.push(Plane {
                normal: direction(friction),
                flow: direction(dilation),
                strength: 2.0 * cohesion * friction.cos(),
            });
        }
        let mut normal = [0.0; 3];
        normal[major] = 1.0;
        planes.push(Plane {
            normal,
            flow: normal,
            strength: cutoff,
        });
    }
    planes
}

/// Solves up to three equations by elimination with pivots; `None` if they are not independent.
fn solve(mut rows: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let n = rows.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs()))?;
        rows.swap(k, pivot);
        if rows[k][k].abs() < 1e-12 {
            return None;
        }
        for i in 0..n {
            if i != k {
                let factor = rows[i][k] / rows[k][k];
                for j in k..=n {
                    rows[i][j] -= factor * rows[k][j];
                }
            }
        }
    }
    Some((0..n).map(|k| rows[k][n] / rows[k][k]).collect())
}

/// The stress of the set of planes that comes nearest to meeting all conditions, and by how much
/// it misses them \[stress\].
fn projected(elasticity: &Elasticity, planes: &[Plane], trial: &Principal) -> (Principal, f64) {
    let young = elasticity.young();
    let mut best = (*trial, f64::INFINITY);
    let n = planes.len();
    let sets = (0..1_usize << n).filter(|set| set.count_ones() <= 3);
    for set in sets {
        let active: Vec<&Plane> = (0..n)
            .filter(|k| set & (1 << k) != 0)
            .map(|k| &planes[k])
            .collect();
        let rows = active
            .iter()
            .map(|p| {
                let mut row: Vec<f64> = active
                    .iter()
                    .map(|q| dot(&p.normal, &elasticity.stress(&q.flow)) / young)
                    .collect();
                row.push(dot(&p.normal, trial) - p.strength);
                row
            })
            .collect();
        let Some(multipliers) = solve(rows) else {
            continue;
        };
        let mut tau = *trial;
        for (plane, multiplier) in active.iter().zip(&multipliers) {
            let softening = elasticity.stress(&plane.flow);
            for a in 0..3 {
                tau[a] -= multiplier / young * softening[a];
            }
        }
        let mut miss = 0.0_f64;
        for plane in planes {
            miss = miss.max(dot(&plane.normal, &tau) - plane.strength);
        }
        for multiplier in multipliers {
            miss = miss.max(-multiplier);
        }
        if miss < best.1 {
            best = (tau, miss);
        }
    }
    best
}

/// GOAL: the right part of the surface, whatever the angles and the cut-off, and the flow that
/// belongs to it. Steep planes are where digits are lost.
#[test]
fn returns_agree_with_all_sets_of_planes() {
    let mut random = Random(17);
    for friction in [0.0_f64, 20.0, 45.0, 60.0, 75.0, 80.0, 85.0, 89.0, 89.9] {
        for _ in 0..200 {
            let poisson = [0.0, 0.2, 0.3, 0.45, 0.49][random.below(5)];
            let elasticity = Elasticity::new(100.0, poisson).unwrap();
            let share = [0.0, random.between(0.0, 1.0), 1.0][random.below(3)];
            let (phi, psi) = (friction.to_radians(), share * friction.to_radians());
            let apex = if friction > 0.0 { 1.0 / phi.tan() } else { 2.0 };
            let cutoff = apex * random.between(0.0, 0.99);
            let law = MohrCoulomb::new(elasticity, 1.0, phi, psi)
                .and_then(|law| law.with_tension_cutoff(cutoff))
                .unwrap();
            let planes = planes(1.0, phi, psi, cutoff);
            for _ in 0..25 {
                let size = 0.02 * 10_f64.powf(random.between(-2.0, 1.5));
                let mean = size * random.symmetric();
                let strain = random.values::<3>(size).map(|value| value + mean);
                let trial = elasticity.stress(&strain);
                let answer = law
                    .return_map(&strain, &History::default(), &PointContext::STATIC)
                    .unwrap();
                let (tau, miss) = projected(&elasticity, &planes, &trial);
                let scale = 1.0 + largest(&trial);
                assert!(miss <= 1e-9 * scale, "the oracle itself: {miss:e}");
                let error = largest(&std::array::from_fn(|a| answer.tau[a] - tau[a]));
                let of = format!("{friction} {psi} {cutoff} {strain:?} {answer:?} {tau:?}");
                assert!(error <= 1e-9 * scale, "{of}");
                let elastic = elasticity.strain(&answer.tau);
                let rest = std::array::from_fn(|a| strain[a] - elastic[a] - answer.delta_eps_p[a]);
                assert!(largest(&rest) <= 1e-11 * largest(&strain), "{of}");
            }
        }
    }
}

fn largest(values: &Principal) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}
